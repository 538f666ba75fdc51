// Reading and writing whole files: what stays when a write fails, and what is refused.
#include "driver/files.h"
#include "scratch_folder.h"

#include <catch2/catch.hpp>
#include <csignal>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace fathom::driver;
namespace fs = std::filesystem;

namespace {

// Lets no file grow past a size for as long as it lives: to a writer, a full disk.
class FullDisk {
  public:
    explicit FullDisk(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &old_);
        rlimit small{bytes, old_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, handler_);
    }
    FullDisk(const FullDisk &) = delete;
    FullDisk &operator=(const FullDisk &) = delete;

  private:
    rlimit old_{};
    void (*handler_)(int) = nullptr;
};

} // namespace

TEST_CASE("a written file holds all the bytes and nothing is left beside it") {
    ScratchFolder folder;
    std::string bytes(100000, 'x');
    CHECK(write_file(folder / "out.png", bytes) == "");
    CHECK(folder.read("out.png") == bytes);
    CHECK(write_file(folder / "out.png", "shorter") == "");
    CHECK(folder.read("out.png") == "shorter");
    CHECK(folder.count() == 1);
}

TEST_CASE("a full disk leaves the old file as it was") {
    ScratchFolder folder;
    folder.write("out.png", "old");
    {
        FullDisk disk(1000);
        CHECK(write_file(folder / "out.png", std::string(5000, 'x')) != "");
    }
    CHECK(folder.read("out.png") == "old");
    CHECK(folder.count() == 1);
}

TEST_CASE("a full device that is written in place is told") {
    CHECK(write_file("/dev/full", "bytes") == "no space left on device");
    CHECK(write_file("/dev/null", "bytes") == "");
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("a target's rights and a symbolic link stay") {
    ScratchFolder folder;
    folder.write("real.txt", "old");
    ::chmod((folder / "real.txt").c_str(), 0640);
    fs::create_symlink("real.txt", folder / "link.txt");
    CHECK(write_file(folder / "link.txt", "new") == "");
    CHECK(fs::is_symlink(folder / "link.txt"));
    CHECK(folder.read("real.txt") == "new");
    struct stat status {};
    ::stat((folder / "real.txt").c_str(), &status);
    CHECK((status.st_mode & 0777) == 0640);
}

TEST_CASE("a target that cannot be is told in words") {
    ScratchFolder folder;
    CHECK(write_file(folder / "none/out.png", "x") == "no such file or directory");
    CHECK(write_file(folder.path(), "x") == "is a directory");
    CHECK(folder.count() == 0);
}

TEST_CASE("reading refuses what is no file, and what is too large") {
    ScratchFolder folder;
    folder.write("scene.sdf", "sphere(1)");
    std::string error;
    CHECK(read_file(folder / "scene.sdf", 100, error) == "sphere(1)");
    CHECK_FALSE(read_file(folder / "nothing.sdf", 100, error));
    CHECK(error == "no such file");
    CHECK_FALSE(read_file(folder.path(), 100, error));
    CHECK(error == "is a directory");
    CHECK_FALSE(read_file(folder / "scene.sdf", 8, error));
    ::mkfifo((folder / "pipe").c_str(), 0600);
    CHECK_FALSE(read_file(folder / "pipe", 100, error)); // and does not wait for a writer
    CHECK(error == "is not a regular file");
}

TEST_CASE("which save brought what is read now: the newest of what changed") {
    const auto at = [](std::int64_t seconds) { return FileStamp{true, 1, 1, 1, seconds, 0}; };
    const Stamps before{{"a", at(10)}, {"b", at(20)}, {"c", at(30)}};
    CHECK(last_saved({}, before).empty());
    CHECK(last_saved(before, before).empty());
    CHECK(last_saved(before, {{"a", at(40)}, {"b", at(20)}, {"c", at(30)}}) == "a");
    CHECK(last_saved(before, {{"a", at(40)}, {"b", at(50)}, {"c", at(30)}}) == "b");
    CHECK(last_saved(before, {{"a", at(10)}, {"b", at(5)}, {"c", at(30)}}) == "b"); // set back
    CHECK(last_saved(before, {{"a", at(10)}, {"b", {}}}).empty());                  // removed
    CHECK(last_saved(before, {{"a", at(10)}, {"d", at(1)}}) == "d"); // another import
}
