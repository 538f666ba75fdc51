// The viewer for real: a window on a display of its own (Xvfb), a file that is saved, and pictures of the window that the
// program itself takes after every reload. And its parts that need no window.
#include "driver/image.h"
#include "scratch_folder.h"
#include "viewer/camera.h"
#include "viewer/params.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fcntl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

constexpr std::chrono::seconds patience{120}; // for a loaded machine: nothing here measures time
constexpr int status_height = 32;             // its numbers differ from run to run

// A child process that ends with its owner.
class Process {
  public:
    explicit Process(const std::vector<std::string> &words, int out = -1) {
        pid_ = ::fork();
        if (pid_ == 0) {
            if (out >= 0) ::dup2(out, 3);
            int nowhere = ::open("/dev/null", O_WRONLY);
            ::dup2(nowhere, STDOUT_FILENO);
            std::vector<char *> arguments;
            for (const std::string &word : words) arguments.push_back(const_cast<char *>(word.c_str()));
            arguments.push_back(nullptr);
            ::execvp(arguments[0], arguments.data());
            ::_exit(127);
        }
    }
    Process(const Process &) = delete;
    Process &operator=(const Process &) = delete;
    ~Process() {
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
    }
    bool runs() const { return ::waitpid(pid_, nullptr, WNOHANG) == 0; }

  private:
    pid_t pid_ = -1;
};

// A display without a screen; `number` is empty where there is no Xvfb.
class Display {
  public:
    Display() {
        int ends[2];
        if (::pipe(ends) != 0) return;
        server_ = std::make_unique<Process>(
            std::vector<std::string>{"Xvfb", "-displayfd", "3", "-screen", "0", "800x600x24", "-nolisten", "tcp"}, ends[1]);
        ::close(ends[1]);
        for (char c; ::read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
        ::close(ends[0]);
        if (!number.empty()) ::setenv("DISPLAY", (":" + number).c_str(), 1);
        ::unsetenv("WAYLAND_DISPLAY");
    }
    std::string number;

  private:
    std::unique_ptr<Process> server_;
};

struct Session {
    ScratchFolder folder;
    Process *viewer = nullptr;

    // The n-th picture of the window, waited for.
    std::optional<ir::ImageData> picture(int n) const {
        std::string name = "shots/000" + std::to_string(n) + ".png";
        auto end = std::chrono::steady_clock::now() + patience;
        while (std::chrono::steady_clock::now() < end && !fs::exists(folder / name)) {
            if (!viewer->runs()) return std::nullopt;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        std::string error;
        return driver::decode_image(folder.read(name), error);
    }
};

// The share of pixels above the status line that differ, from a row on (a share of the height).
double difference(const ir::ImageData &a, const ir::ImageData &b, double from = 0) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    int differing = 0, all = 0;
    for (int y = static_cast<int>(from * a.height); y < a.height - status_height; ++y)
        for (int x = 0; x < a.width; ++x, ++all)
            for (std::size_t c = 0; c < 3; ++c) {
                std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                                      static_cast<std::size_t>(x)) + c;
                if (std::abs(a.rgba[at] - b.rgba[at]) > 0.02f) {
                    ++differing;
                    break;
                }
            }
    return static_cast<double>(differing) / all;
}

} // namespace

TEST_CASE("save and see; an error keeps the picture under its message; the next good save clears it") {
    Display display;
    INFO("this test needs Xvfb (./fathom-test installs it)");
    REQUIRE(!display.number.empty());
    Session session;
    const std::string camera = "camera(at: [0, 0, 6], look_at: [0, 0, 0])\n";
    fs::path file = session.folder.write("scene.sdf", "import \"parts/a.sdf\"\nball()\n" + camera);
    session.folder.write("parts/a.sdf", "fn ball() -> shape = sphere(1).paint(red)\n");
    fs::create_directory(session.folder / "shots");
    Process viewer({FATHOM_PROGRAM, "view", file.string(), "--size", "480x320", "--record", (session.folder / "shots").string()});
    session.viewer = &viewer;

    std::optional<ir::ImageData> first = session.picture(1);
    REQUIRE(first);
    CHECK(first->width == 480);
    std::size_t middle = 4 * (160 * 480 + 240);
    CHECK(first->rgba[middle] > 2 * first->rgba[middle + 1]); // it is red

    // An import that is saved is a save.
    session.folder.write("parts/a.sdf", "fn ball() -> shape = box(2).paint(blue)\n");
    std::optional<ir::ImageData> second = session.picture(2);
    REQUIRE(second);
    CHECK(second->rgba[middle + 2] > 2 * second->rgba[middle]); // it is blue
    CHECK(difference(*first, *second) > 0.05);

    // An error: the picture stays, the message lies over its upper left.
    session.folder.write("scene.sdf", "import \"parts/a.sdf\"\nbll()\n" + camera);
    std::optional<ir::ImageData> third = session.picture(3);
    REQUIRE(third);
    CHECK(difference(*second, *third) > 0.01);
    CHECK(difference(*second, *third, 0.6) == 0);
    CHECK(third->rgba[4 * (220 * 480 + 240) + 2] > 2 * third->rgba[4 * (220 * 480 + 240)]);

    // The mended file, by an editor's atomic rename: the very picture of before.
    fs::rename(session.folder.write("scene.tmp", "import \"parts/a.sdf\"\nball()\n" + camera), file);
    std::optional<ir::ImageData> fourth = session.picture(4);
    REQUIRE(fourth);
    CHECK(difference(*second, *fourth) == 0);
}

TEST_CASE("a camera is kept by its view and written as a line of the scene") {
    ir::View view = ir::look_at({3, 2, 5}, {0, 1, 0}, std::tan(0.3), false);
    viewer::Camera camera = viewer::camera_of(view);
    ir::View again = viewer::view_of(camera);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(again.origin[i] == Approx(view.origin[i]).margin(1e-9));
        CHECK(again.forward[i] == Approx(view.forward[i]).margin(1e-9));
        CHECK(again.right[i] == Approx(view.right[i]).margin(1e-9));
    }
    CHECK(again.extent == Approx(view.extent));
    CHECK(viewer::camera_line(camera).starts_with("camera(at: [3, 2, 5], look_at: [0, 1, 0], fov: 34.38deg"));
}

TEST_CASE("turning keeps the distance, panning the direction, framing the whole sphere in sight") {
    viewer::Camera camera = viewer::camera_of(ir::look_at({0, 0, 5}, {0, 0, 0}, std::tan(0.4), false));
    viewer::orbit(camera, 0.25, 0.1);
    ir::View turned = viewer::view_of(camera);
    CHECK(std::hypot(turned.origin[0], turned.origin[1], turned.origin[2]) == Approx(5));
    viewer::pan(camera, 0.5, 0);
    for (std::size_t i = 0; i < 3; ++i) CHECK(viewer::view_of(camera).forward[i] == Approx(turned.forward[i]).margin(1e-9));
    for (int i = 0; i < 100; ++i) viewer::orbit(camera, 0, 1);
    CHECK(std::isfinite(viewer::view_of(camera).right[0])); // never straight up
    viewer::frame(camera, {1, 2, 3}, 2, 0.5);
    CHECK(2 / camera.distance <= Approx(std::sin(std::atan(camera.slope * 0.5))));
    CHECK(camera.target == ir::Triple{1, 2, 3});
}

TEST_CASE("a slider's value outlives a reload, unless the text's own value changed") {
    ir::Param param;
    param.name = "radius";
    param.has_range = true;
    param.lo[0] = 0;
    param.hi[0] = 2;
    param.value[0] = param.initial[0] = 1;
    std::vector<ir::Param> before{param}, fresh{param};
    before[0].value[0] = 1.5;
    viewer::carry_over(before, fresh);
    CHECK(fresh[0].value[0] == 1.5);
    fresh = {param};
    fresh[0].value[0] = fresh[0].initial[0] = 0.5; // the text was edited
    viewer::carry_over(before, fresh);
    CHECK(fresh[0].value[0] == 0.5);
    fresh = {param};
    fresh[0].hi[0] = 1.2; // no place for it any more
    viewer::carry_over(before, fresh);
    CHECK(fresh[0].value[0] == 1);
    CHECK(viewer::value_text(before[0]) == "1.5");
    before[0].structural = true;
    REQUIRE(viewer::structural_values(before).size() == 1);
    CHECK(viewer::structural_values(before)[0].text == "1.5");
    std::vector<driver::Override> values = viewer::structural_values(before);
    CHECK_FALSE(viewer::drop_outdated(before, {param}, values));
    param.initial[0] = 0.5;
    CHECK(viewer::drop_outdated(before, {param}, values));
    CHECK(values.empty());
}
