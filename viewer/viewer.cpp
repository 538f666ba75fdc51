// The window and its loop: takes builds from the worker, draws when something changed, sleeps
// otherwise.
#include "viewer/viewer.h"

#include "base/encode.h"
#include "viewer/app.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cstdlib>
#include <ctime>
#include <fmt/format.h>
#include <sys/stat.h>
#include <utility>

namespace fathom::viewer {
namespace {

std::string glfw_error; // GLFW reports through a function without any state

void note_error(int, const char *words) { glfw_error = words; }

std::string no_window_sentence() {
    const char *x11 = std::getenv("DISPLAY");
    const char *wayland = std::getenv("WAYLAND_DISPLAY");
    if (!(x11 && *x11) && !(wayland && *wayland))
        return "there is no display to open a window on; `fathom render` makes pictures without "
               "one";
    return fmt::format("no window can be opened ({}); `fathom render` makes pictures without one",
                       glfw_error);
}

App &app_of(GLFWwindow *window) { return *static_cast<App *>(glfwGetWindowUserPointer(window)); }

void install_callbacks(GLFWwindow *window) {
    glfwSetKeyCallback(window, [](GLFWwindow *w, int key, int, int action, int mods) {
        App &app = app_of(w);
        app.clock.frames_due = 3;
        if (action != GLFW_RELEASE && !ImGui::GetIO().WantTextInput) app.key(key, mods);
    });
    glfwSetCharCallback(window, [](GLFWwindow *w, unsigned code) {
        if (!ImGui::GetIO().WantTextInput) app_of(w).character(code);
    });
    glfwSetCursorPosCallback(
        window, [](GLFWwindow *w, double x, double y) { app_of(w).move_cursor(x, y); });
    glfwSetMouseButtonCallback(window, [](GLFWwindow *w, int button, int action, int) {
        app_of(w).button(button, action == GLFW_PRESS);
    });
    glfwSetScrollCallback(window,
                          [](GLFWwindow *w, double, double steps) { app_of(w).scroll(steps); });
    glfwSetFramebufferSizeCallback(window,
                                   [](GLFWwindow *w, int, int) { app_of(w).clock.frames_due = 3; });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow *w) { app_of(w).clock.frames_due = 3; });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow *w, float scale, float) {
        App &app = app_of(w);
        ImGui::GetStyle().ScaleAllSizes(scale / app.font_scale);
        ImGui::GetIO().FontGlobalScale = app.font_scale = scale;
        app.clock.frames_due = 3;
    });
}

// One line for each build that is on the screen now: what took how long, and how long ago the file
// that brought it was saved, of all that the scene reads. A file's change of state counts, since a
// file that is moved into place keeps the time at which it was written.
void tell_reload(App &app) {
    if (app.newest.errors.empty() && !app.progress.on_screen) return;
    if (std::exchange(app.newest.told, true) || !app.settings.tell) return;
    std::string since;
    struct stat file {};
    if (!app.newest.saved.empty() && ::stat(app.newest.saved.c_str(), &file) == 0) {
        std::timespec now{};
        std::timespec_get(&now, TIME_UTC);
        const double milliseconds = static_cast<double>(now.tv_sec - file.st_ctim.tv_sec) * 1e3 +
                                    static_cast<double>(now.tv_nsec - file.st_ctim.tv_nsec) * 1e-6;
        since = fmt::format(" {:.2f} ms after the save of {}", milliseconds,
                            app.newest.saved.filename().string());
    }
    app.settings.tell(fmt::format("reload: {}, front end {:.2f} ms, {}, on the screen{}",
                                  app.newest.errors.empty() ? "good" : "error",
                                  app.status.front_end_ms,
                                  app.newest.errors.empty() && app.status.linked_anew
                                      ? fmt::format("driver {:.2f} ms", app.status.driver_ms)
                                      : std::string("driver untouched"),
                                  since));
}

// Until the window is closed; an empty text, or why it cannot go on.
std::string loop(App &app) {
    Clock::time_point before = Clock::now();
    while (!glfwWindowShouldClose(app.window)) {
        const bool hidden = glfwGetWindowAttrib(app.window, GLFW_ICONIFIED) != 0;
        const bool settling =
            milliseconds_since(app.clock.touched) < 200; // until the full picture is there again
        const bool busy = app.animated() || app.controls.always || app.controls.rotate ||
                          app.recording.sequence > 0 || app.clock.frames_due > 0 || app.pending() ||
                          app.fading() > 0 ||
                          (app.controls.cache && app.cached.ready() && !app.cached.settled());
        const bool working = app.worker->work().stage != Stage::Rest;
        if (busy && !hidden)
            glfwPollEvents();
        else if (settling && !hidden)
            glfwWaitEventsTimeout(0.05);
        else if (working)
            glfwWaitEventsTimeout(0.2); // its seconds are told
        else if (!app.status.note.empty())
            glfwWaitEventsTimeout(app.note_seconds_left());
        else
            glfwWaitEvents(); // a still scene costs nothing
        const double seconds = milliseconds_since(before) / 1000;
        before = Clock::now();
        if (working) app.clock.frames_due = std::max(app.clock.frames_due, 1);
        app.drop_old_note();
        app.hear_editor();
        if (std::unique_ptr<Build> build = app.worker->take()) {
            if (build->good() && !build->linked) { // by this thread: it says so before
                app.linking = true;
                app.draw(0);
                app.linking = false;
            }
            app.take(std::move(build));
        }
        if (app.scene && !app.cached.requested())
            if (auto kept = app.worker->take_cached(app.scene->number)) {
                app.cached.take(std::move(*kept));
                app.clock.frames_due = 3;
            }
        if (app.clock.frames_due > 0) --app.clock.frames_due;
        if (!hidden)
            app.draw(std::min(seconds, 0.25)); // after a sleep time goes on, it does not jump
        tell_reload(app);
        if (std::string lost = gl::lost_context(); !lost.empty())
            return lost + "; start the viewer again";
    }
    return "";
}

void start_panels(App &app) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing is written beside the user's files
    ImGui::StyleColorsDark();
    float scale_x = 1, scale_y = 1;
    glfwGetWindowContentScale(app.window, &scale_x, &scale_y);
    ImGui::GetStyle().ScaleAllSizes(scale_x);
    ImGui::GetIO().FontGlobalScale = app.font_scale = scale_x;
    ImGui_ImplGlfw_InitForOpenGL(app.window,
                                 true); // calls on to the callbacks that are there already
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

void end_panels() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void request_context(int major, int minor) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
}

// The newest core context from 4.6 down to 3.3, told of resets where the driver can; with the
// version that it took.
struct Opened {
    GLFWwindow *window = nullptr;
    int major = 3, minor = 3;
};
Opened open_window(const Settings &settings, const std::string &title) {
    for (auto [major, minor] : {std::pair{4, 6}, {4, 3}, {4, 2}, {3, 3}})
        for (bool robust : {true, false}) {
            request_context(major, minor);
            if (robust) glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
            GLFWwindow *window =
                glfwCreateWindow(settings.width, settings.height, title.c_str(), nullptr, nullptr);
            if (window) return {window, major, minor};
        }
    return {};
}

// A context for the worker: that of a window nobody sees, which shares programs and textures with
// the first.
GLFWwindow *open_second(const Opened &first, const Settings &settings) {
    if (settings.one_context) return nullptr;
    request_context(first.major, first.minor);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    if (glfwGetWindowAttrib(first.window, GLFW_CONTEXT_ROBUSTNESS) != GLFW_NO_ROBUSTNESS)
        glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
    return glfwCreateWindow(16, 16, "Fathom", nullptr, first.window);
}

} // namespace

std::string run(const Settings &settings) {
    if (!settings.record.empty()) {
        std::error_code error;
        std::filesystem::create_directories(settings.record, error);
        if (error)
            return fmt::format("cannot make the folder {}: {}", settings.record.string(),
                               error.message());
    }
    glfwSetErrorCallback(note_error);
    if (!glfwInit()) return no_window_sentence();
    const Opened opened =
        open_window(settings, for_terminal(settings.file.filename().string()) + " - Fathom");
    if (!opened.window) {
        glfwTerminate();
        return fmt::format(
            "this display gives no window with OpenGL 3.3 ({}); `fathom render` needs none",
            glfw_error);
    }
    GLFWwindow *second = open_second(opened, settings);
    glfwMakeContextCurrent(opened.window);
    glfwSwapInterval(1);
    std::string error;
    {
        App app(settings); // its programs and canvas end before their context
        app.window = opened.window;
        app.clock.running = !settings.still;
        glfwSetWindowUserPointer(opened.window, &app);
        install_callbacks(opened.window);
        start_panels(app);
        Worker::Hooks hooks{[] { glfwPostEmptyEvent(); }, {}, {}};
        if (second) {
            hooks.take_context = [second] {
                glfwMakeContextCurrent(second);
                return glfwGetCurrentContext() == second;
            };
            hooks.leave_context = [] { glfwMakeContextCurrent(nullptr); };
        }
        app.worker =
            std::make_unique<Worker>(settings.file, compile_options(settings), std::move(hooks));
        if (!settings.editor.empty()) {
            app.editor = EditorLine::to(
                settings.editor, [] { glfwPostEmptyEvent(); }, error);
            if (!app.editor) error = "cannot reach the editor: " + error;
        }
        if (error.empty()) error = loop(app);
        app.editor.reset(); // it wakes the window
        if (error.empty() && settings.save_view && app.scene) {
            if (!app.write_view()) error = app.status.note;
        }
        app.worker.reset();
        end_panels();
    }
    glfwTerminate();
    return error;
}

} // namespace fathom::viewer
