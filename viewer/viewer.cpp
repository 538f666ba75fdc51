// The window and its loop: takes builds from the worker, draws when something changed, sleeps otherwise.
#include "viewer/viewer.h"

#include "base/picture.h"
#include "render-gl/canvas.h"
#include "viewer/camera.h"
#include "viewer/panels.h"
#include "viewer/params.h"
#include "viewer/worker.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <utility>

namespace fathom::viewer {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// All that the picture depends on, program and params apart: while it stays, nothing is drawn anew.
struct Shot {
    Camera camera;
    double time = 0;
    int width = 0, height = 0;
    gl::Mode mode = gl::Mode::Picture;
    friend bool operator==(const Shot &, const Shot &) = default;
};

struct Viewer {
    const Settings &settings;
    GLFWwindow *window = nullptr;
    std::unique_ptr<Worker> worker;

    // The good picture: its scene, its program, what was drawn of it.
    std::unique_ptr<Build> scene;
    std::optional<gl::Program> program;
    std::vector<ir::Param> params;
    gl::Canvas canvas;
    std::optional<Shot> drawn;
    bool stale = true; // the program or a value changed since `drawn`

    std::vector<std::string> errors, remarks; // of the newest build, good or not
    std::vector<driver::Override> structural; // what the worker builds with
    Camera camera, scene_camera;
    bool has_camera = false;
    gl::Mode mode = gl::Mode::Picture;
    PanelState panels;
    Status status;

    bool running = true; // time passes, where the scene reads it
    double time = 0;
    Clock::time_point touched{}; // the last time the picture was moved by hand
    int frames_due = 3;          // the panels settle within a few frames after an event
    int recorded = 0;
    bool record_next = false, picture_asked = false;
    double cursor_x = 0, cursor_y = 0;

    explicit Viewer(const Settings &s) : settings(s) {}

    bool animated() const { return scene && running && scene->shader.reads_time; }
    double aspect() const;
    void take(std::unique_ptr<Build> build);
    bool link(Build &build);
    void rebuild(std::vector<driver::Override> values);
    void key(int key, int mods);
    void character(unsigned code);
    void drag(double x, double y);
    void fly_by_keys(double seconds);
    void draw_scene(int width, int height, bool moving);
    void frame(double seconds);
    void save_window(const std::filesystem::path &file, int width, int height);
};

Viewer &viewer_of(GLFWwindow *window) { return *static_cast<Viewer *>(glfwGetWindowUserPointer(window)); }

double Viewer::aspect() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return height > 0 ? static_cast<double>(width) / height : 1;
}

// -- a new build -----------------------------------------------------------------------------------

// True where the build's picture can be drawn. The same text keeps the same program: only numbers go to the card.
bool Viewer::link(Build &build) {
    bool same = scene && program && scene->shader.text == build.shader.text &&
                scene->shader.tables.size() == build.shader.tables.size() && build.shader.images.empty() &&
                build.shader.grids.empty();
    status.linked_anew = !same;
    if (same) {
        if (scene->shader.tables != build.shader.tables) program->upload_tables(build.shader.tables);
        return true;
    }
    Clock::time_point start = Clock::now();
    auto built = gl::Program::build(build.shader, build.compilation.scene);
    status.link_ms = milliseconds_since(start);
    if (const auto *error = std::get_if<gl::ProgramError>(&built)) {
        build.errors.push_back(fmt::format("error[shader-invalid]: the graphics driver refuses the shader: {}\n"
                                           "  line {}: {}",
                                           error->message, error->line, error->source_line));
        return false;
    }
    program = std::move(std::get<gl::Program>(built));
    return true;
}

void Viewer::rebuild(std::vector<driver::Override> values) {
    structural = values;
    worker->rebuild(std::move(values));
}

void Viewer::take(std::unique_ptr<Build> build) {
    frames_due = 3;
    // A slider's value that the changed text has no place for any more: the text's own counts.
    if (!build->compilation.usage_errors.empty() && !structural.empty()) return rebuild({});
    record_next = true;
    bool good = build->good() && link(*build);
    errors = build->errors;
    remarks = build->remarks;
    status.front_end_ms = build->front_end_ms;
    if (!good) return; // the last good picture stays

    std::vector<ir::Param> before = std::move(params);
    params = build->compilation.scene.params;
    carry_over(before, params);
    if (drop_outdated(before, params, structural)) rebuild(structural);
    scene = std::move(build);
    stale = true;
    const ir::Scene &s = scene->compilation.scene;
    status.shader_bytes = scene->shader.text.size();

    // The camera is the user's, until the text's own changes.
    Camera fresh = camera_of(ir::view_of(s, 0, aspect()));
    if (!std::exchange(has_camera, true) || (s.camera.given && fresh != scene_camera)) camera = fresh;
    scene_camera = fresh;

    double lipschitz = 0;
    ir::ProofStatus worst = ir::ProofStatus::Proved;
    for (const ir::TopLevel &top : s.top_level) {
        lipschitz = std::max(lipschitz, s.facts[top.shape.index].lipschitz_sup);
        worst = std::max(worst, s.facts[top.shape.index].status);
    }
    constexpr const char *words[] = {"proved", "assumed", "estimated"};
    status.bound = fmt::format("L {:.4g} {}", lipschitz, words[static_cast<int>(worst)]);
}

// -- input -----------------------------------------------------------------------------------------

void Viewer::key(int key, int mods) {
    frames_due = 3;
    touched = Clock::now();
    if ((mods & GLFW_MOD_CONTROL) != 0) {
        if (key == GLFW_KEY_Q) glfwSetWindowShouldClose(window, GLFW_TRUE);
        return;
    }
    switch (key) {
    case GLFW_KEY_F:
        if (scene) {
            ir::Frame whole = ir::frame_of(scene->compilation.scene, view_of(camera), 100);
            viewer::frame(camera, whole.center, whole.radius, aspect());
        }
        break;
    case GLFW_KEY_1: look_from(camera, Side::Front); break;
    case GLFW_KEY_3: look_from(camera, Side::Right); break;
    case GLFW_KEY_7: look_from(camera, Side::Top); break;
    case GLFW_KEY_5: camera.orthographic = !camera.orthographic; break;
    case GLFW_KEY_R: camera = scene_camera; break;
    case GLFW_KEY_C:
        glfwSetClipboardString(window, camera_line(camera).c_str());
        status.note = "copied " + camera_line(camera);
        break;
    case GLFW_KEY_TAB: panels.params = !panels.params; break;
    case GLFW_KEY_BACKSPACE: {
        for (ir::Param &param : params) param.value = param.initial;
        stale = true;
        if (!structural.empty()) rebuild({});
        break;
    }
    case GLFW_KEY_H: mode = mode == gl::Mode::Picture ? gl::Mode::Heat : gl::Mode::Picture; break;
    case GLFW_KEY_SPACE: running = !running; break;
    case GLFW_KEY_0: time = 0; break;
    case GLFW_KEY_N: panels.remarks = !panels.remarks; break;
    case GLFW_KEY_P: picture_asked = true; break;
    case GLFW_KEY_F1: panels.keys = !panels.keys; break;
    case GLFW_KEY_ESCAPE: panels.keys = false; break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD: dolly(camera, 1); break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT: dolly(camera, -1); break;
    default: break;
    }
}

void Viewer::character(unsigned code) {
    if (code == '?') panels.keys = !panels.keys;
}

void Viewer::drag(double x, double y) {
    int width = 1, height = 1;
    glfwGetWindowSize(window, &width, &height);
    double dx = (x - cursor_x) / std::max(height, 1), dy = (y - cursor_y) / std::max(height, 1);
    cursor_x = x;
    cursor_y = y;
    frames_due = std::max(frames_due, 2);
    if (ImGui::GetIO().WantCaptureMouse) return;
    bool left = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    bool other = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS ||
                 glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_MIDDLE) == GLFW_PRESS;
    bool shift = glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                 glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    if (!left && !other) return;
    touched = Clock::now();
    if (other || shift)
        pan(camera, dx, dy);
    else
        orbit(camera, dx, dy);
}

void Viewer::fly_by_keys(double seconds) {
    if (ImGui::GetIO().WantCaptureKeyboard || glfwGetKey(window, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS) return;
    auto held = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS ? 1.0 : 0.0; };
    ir::Triple by{held(GLFW_KEY_D) - held(GLFW_KEY_A), held(GLFW_KEY_E) - held(GLFW_KEY_Q),
                  held(GLFW_KEY_W) - held(GLFW_KEY_S)};
    if (by == ir::Triple{}) return;
    for (double &part : by) part *= 0.8 * std::min(seconds, 0.1);
    fly(camera, by);
    touched = Clock::now();
    frames_due = 3; // goes on for as long as the key is held
}

// -- drawing ---------------------------------------------------------------------------------------

// While it is moved by hand, the picture is drawn as coarsely as it takes to keep up; at rest in full.
void Viewer::draw_scene(int width, int height, bool moving) {
    constexpr double wanted_ms = 30;
    double scale = 1;
    if (moving && status.frame_ms > wanted_ms)
        scale = std::clamp(std::sqrt(wanted_ms / status.frame_ms), 0.125, 1.0);
    Shot shot{camera, time, std::max(1, static_cast<int>(width * scale)), std::max(1, static_cast<int>(height * scale)),
              mode};
    if (!stale && drawn == shot) return;
    const ir::Scene &s = scene->compilation.scene;
    gl::FrameInputs inputs;
    inputs.view = view_of(camera);
    inputs.sun = ir::lights_of(s, time, ir::view_of(s, time, static_cast<double>(width) / height))[0].position;
    inputs.width = shot.width;
    inputs.height = shot.height;
    inputs.time = time;
    inputs.mode = mode;
    Clock::time_point start = Clock::now();
    if (!canvas.draw(*program, inputs, params)) {
        status.note = "the graphics card has no memory for this size";
        return;
    }
    // What a full frame would take: the measure that decides how coarse the next may be.
    status.frame_ms = milliseconds_since(start) / (scale * scale);
    drawn = shot;
    stale = false;
}

void Viewer::save_window(const std::filesystem::path &file, int width, int height) {
    std::string error = driver::write_file(file, encode_png(gl::read_window(width, height)));
    status.note = error.empty() ? "saved " + file.string() : fmt::format("cannot write {}: {}", file.string(), error);
}

std::filesystem::path free_name(const std::filesystem::path &scene) {
    for (int i = 1;; ++i) {
        std::filesystem::path name = fmt::format("{}-{}.png", scene.stem().string(), i);
        std::error_code error;
        if (!std::filesystem::exists(name, error)) return name;
    }
}

void Viewer::frame(double seconds) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    if (width == 0 || height == 0) return; // minimised
    if (animated()) time += seconds;
    fly_by_keys(seconds);
    bool moving = animated() || milliseconds_since(touched) < 150;
    if (program) draw_scene(width, height, moving);
    if (canvas.empty())
        gl::clear_window(width, height, 0.12f);
    else
        canvas.show(width, height);

    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    Asked asked = show_panels(panels, status, settings.file.string(), params, errors, remarks);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());

    if (asked.redraw || asked.rebuild) {
        stale = true;
        touched = Clock::now();
        frames_due = 3;
    }
    if (asked.rebuild) rebuild(structural_values(params));
    if (!asked.copy.empty()) glfwSetClipboardString(window, asked.copy.c_str());
    if (std::exchange(picture_asked, false)) {
        save_window(free_name(settings.file), width, height);
        frames_due = 3;
    }
    // The panels have settled and the picture is the full one: that is what a record shows.
    if (record_next && frames_due <= 1 && (!moving || animated()) && !settings.record.empty()) {
        save_window(settings.record / fmt::format("{:04}.png", ++recorded), width, height);
        record_next = false;
    }
    glfwSwapBuffers(window);
}

// -- the window ------------------------------------------------------------------------------------

std::string glfw_error; // GLFW reports through a function without any state

void note_error(int, const char *words) { glfw_error = words; }

std::string no_window_sentence() {
    const char *x11 = std::getenv("DISPLAY");
    const char *wayland = std::getenv("WAYLAND_DISPLAY");
    if (!(x11 && *x11) && !(wayland && *wayland))
        return "there is no display to open a window on; `fathom render` makes pictures without one";
    return fmt::format("no window can be opened ({}); `fathom render` makes pictures without one", glfw_error);
}

void install_callbacks(GLFWwindow *window) {
    glfwSetKeyCallback(window, [](GLFWwindow *w, int key, int, int action, int mods) {
        Viewer &viewer = viewer_of(w);
        viewer.frames_due = 3;
        if (action != GLFW_RELEASE && !ImGui::GetIO().WantTextInput) viewer.key(key, mods);
    });
    glfwSetCharCallback(window, [](GLFWwindow *w, unsigned code) {
        if (!ImGui::GetIO().WantTextInput) viewer_of(w).character(code);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow *w, double x, double y) { viewer_of(w).drag(x, y); });
    glfwSetMouseButtonCallback(window, [](GLFWwindow *w, int, int, int) {
        Viewer &viewer = viewer_of(w);
        viewer.frames_due = 3;
        glfwGetCursorPos(w, &viewer.cursor_x, &viewer.cursor_y);
    });
    glfwSetScrollCallback(window, [](GLFWwindow *w, double, double steps) {
        Viewer &viewer = viewer_of(w);
        viewer.frames_due = 3;
        if (ImGui::GetIO().WantCaptureMouse) return;
        viewer.touched = Clock::now();
        dolly(viewer.camera, steps);
    });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow *w, int, int) { viewer_of(w).frames_due = 3; });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow *w) { viewer_of(w).frames_due = 3; });
}

void loop(Viewer &viewer) {
    Clock::time_point before = Clock::now();
    while (!glfwWindowShouldClose(viewer.window)) {
        bool settling = milliseconds_since(viewer.touched) < 200; // until the full picture is there again
        if (viewer.animated() || viewer.frames_due > 0)
            glfwPollEvents();
        else if (settling)
            glfwWaitEventsTimeout(0.05);
        else
            glfwWaitEvents(); // a still scene costs nothing
        double seconds = milliseconds_since(before) / 1000;
        before = Clock::now();
        if (std::unique_ptr<Build> build = viewer.worker->take()) viewer.take(std::move(build));
        viewer.frame(std::min(seconds, 0.25)); // after a sleep time goes on, it does not jump
        if (viewer.frames_due > 0) --viewer.frames_due;
    }
}

void start_panels(GLFWwindow *window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing is written beside the user's files
    ImGui::StyleColorsDark();
    float scale_x = 1, scale_y = 1;
    glfwGetWindowContentScale(window, &scale_x, &scale_y);
    ImGui::GetStyle().ScaleAllSizes(scale_x);
    ImGui::GetIO().FontGlobalScale = scale_x;
    ImGui_ImplGlfw_InitForOpenGL(window, true); // calls on to the callbacks that are there already
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

void end_panels() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

} // namespace

std::string run(const Settings &settings) {
    glfwSetErrorCallback(note_error);
    if (!glfwInit()) return no_window_sentence();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    std::string title = settings.file.filename().string() + " - Fathom";
    GLFWwindow *window = glfwCreateWindow(settings.width, settings.height, title.c_str(), nullptr, nullptr);
    if (!window) {
        glfwTerminate();
        return fmt::format("this display gives no window with OpenGL 3.3 ({}); `fathom render` needs none", glfw_error);
    }
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    {
        Viewer viewer(settings); // its program and canvas end before their context
        viewer.window = window;
        glfwSetWindowUserPointer(window, &viewer);
        install_callbacks(window);
        start_panels(window);
        viewer.worker = std::make_unique<Worker>(settings.file, settings.options, [] { glfwPostEmptyEvent(); });
        loop(viewer);
        viewer.worker.reset();
        end_panels();
    }
    glfwTerminate();
    return "";
}

} // namespace fathom::viewer
