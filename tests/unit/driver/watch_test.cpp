// Every way that editors save is seen, each save once. The waits are upper limits for a loaded
// machine: no test measures time, and none passes because nothing happened yet, but where it says
// so.
#include "driver/watch.h"
#include "polled.h"
#include "scratch_folder.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <optional>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

using namespace fathom::driver;
using std::chrono::milliseconds;
namespace fs = std::filesystem;

namespace {

constexpr milliseconds patience{5000};
constexpr milliseconds calm{150}; // after which what did not come is taken not to come

struct Watched {
    ScratchFolder folder;
    Watcher watcher;
    fs::path file = folder.write("scene.sdf", "sphere(0)");

    Watched() { watch({file}); }
    void watch(const std::vector<fs::path> &files) {
        std::map<fs::path, FileStamp> states;
        for (const fs::path &each : files) states[each] = stamp_of(each);
        watcher.watch(states);
    }
};

} // namespace

TEST_CASE("each way to save is seen, 100 of 100") {
    Watched w;
    REQUIRE(w.watcher.polls_because() == "");
    auto way = GENERATE(as<std::string>{}, "in place", "rename over", "delete and create",
                        "backup dance", "append", "truncate then write", "sed -i");
    INFO(way);
    int seen = 0, once = 0;
    for (int i = 1; i <= 100; ++i) {
        std::string text =
            fmt::format("sphere({}){}", i, std::string(static_cast<std::size_t>(i), ' '));
        if (way == "in place") w.folder.write("scene.sdf", text);
        if (way == "rename over") fs::rename(w.folder.write(".scene.sdf.tmp", text), w.file);
        if (way == "delete and create") {
            fs::remove(w.file);
            w.folder.write("scene.sdf", text);
        }
        if (way == "backup dance") { // vim: the old file becomes the backup, a new one is written
            fs::rename(w.file, w.folder / "scene.sdf~");
            w.folder.write("scene.sdf", text);
            fs::remove(w.folder / "scene.sdf~");
        }
        if (way == "append") std::ofstream(w.file, std::ios::app) << "\n//";
        if (way == "truncate then write") {
            std::ofstream out(w.file, std::ios::trunc);
            out.flush();
            std::this_thread::sleep_for(milliseconds(10));
            out << text;
        }
        if (way == "sed -i") {
            const std::string command = fmt::format("sed -i 's/(.*)/({})/' {}", i, w.file.string());
            REQUIRE(std::system(command.c_str()) == 0);
        }
        seen += w.watcher.wait(patience);
        once += !w.watcher.wait(milliseconds(0)); // one save, one report
    }
    CHECK(seen == 100);
    CHECK(once == 100);
}

TEST_CASE("a burst of saves is one report, and the last state is the one that counts") {
    Watched w;
    for (int i = 0; i < 50; ++i)
        w.folder.write("scene.sdf", std::string(static_cast<std::size_t>(i), 'x'));
    CHECK(w.watcher.wait(patience));
    CHECK_FALSE(w.watcher.wait(calm));
    CHECK(w.folder.read("scene.sdf").size() == 49);
}

TEST_CASE("other files of the folder are not reported") {
    Watched w;
    w.folder.write("other.sdf", "x");
    w.folder.write("scene.sdf.swp", "x");
    CHECK_FALSE(w.watcher.wait(calm));
}

TEST_CASE("a save between reading and watching is not lost") {
    Watched w;
    FileStamp read = stamp_of(w.file);
    w.folder.write("scene.sdf", "saved meanwhile");
    w.watcher.watch({{w.file, read}});
    CHECK(w.watcher.wait(patience));
}

TEST_CASE("a file that does not exist yet is seen when it comes, its folder too") {
    Watched w;
    fs::path import = w.folder / "parts/deep/arch.sdf";
    w.watch({w.file, import});
    CHECK_FALSE(w.watcher.wait(milliseconds(0)));
    w.folder.write("parts/deep/arch.sdf", "x");
    CHECK(w.watcher.wait(patience));
    w.folder.write("parts/deep/arch.sdf", "longer");
    CHECK(w.watcher.wait(patience));
}

TEST_CASE("a folder that is replaced is watched on") {
    Watched w;
    fs::path import = w.folder.write("parts/arch.sdf", "old");
    w.watch({w.file, import});
    fs::rename(w.folder / "parts", w.folder / "parts.old");
    w.folder.write("parts/arch.sdf", "new file");
    CHECK(w.watcher.wait(patience));
    while (w.watcher.wait(calm)) {
    }
    w.folder.write("parts/arch.sdf", "saved again");
    CHECK(w.watcher.wait(patience));
}

TEST_CASE("what a symbolic link leads to is watched") {
    ScratchFolder elsewhere;
    fs::path real = elsewhere.write("real.sdf", "old");
    Watched w;
    fs::create_symlink(real, w.folder / "link.sdf");
    w.watch({w.folder / "link.sdf"});
    elsewhere.write("real.sdf", "changed");
    CHECK(w.watcher.wait(patience));
    fs::path other = elsewhere.write("other.sdf", "another file");
    fs::remove(w.folder / "link.sdf");
    fs::create_symlink(other, w.folder / "link.sdf");
    CHECK(w.watcher.wait(patience));
}

TEST_CASE("a removed file is reported once, and again when it is back") {
    Watched w;
    fs::remove(w.file);
    CHECK(w.watcher.wait(patience));
    CHECK_FALSE(w.watcher.wait(calm));
    w.folder.write("scene.sdf", "back");
    CHECK(w.watcher.wait(patience));
}

TEST_CASE("a wait is ended from another thread") {
    Watched w;
    std::thread other([&] { w.watcher.wake(); });
    CHECK_FALSE(w.watcher.wait(patience));
    other.join();
}

namespace {

// While it lives the process may open `spare` more files, so that a watcher gets its wake and no
// watches.
class FewFiles {
  public:
    explicit FewFiles(rlim_t spare) {
        ::getrlimit(RLIMIT_NOFILE, &old_);
        const int lowest = ::dup(0); // descriptors are given from the lowest on
        ::close(lowest);
        rlimit few{static_cast<rlim_t>(lowest) + spare, old_.rlim_max};
        ::setrlimit(RLIMIT_NOFILE, &few);
    }
    FewFiles(const FewFiles &) = delete;
    FewFiles &operator=(const FewFiles &) = delete;
    ~FewFiles() { ::setrlimit(RLIMIT_NOFILE, &old_); }

  private:
    rlimit old_{};
};

} // namespace

TEST_CASE("without watches the files are looked at, and it is said") {
    ScratchFolder folder;
    const fs::path file = folder.write("scene.sdf", "sphere(1)");
    std::optional<Watcher> watcher;
    {
        FewFiles few(2); // to be woken by
        watcher.emplace();
    }
    CHECK(watcher->polls_because() ==
          "the system gives no more file watches (fs.inotify.max_user_instances): files are looked "
          "at twice a second instead");
    sees_saves_by_looking(*watcher, folder, file);
}
