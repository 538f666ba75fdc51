// Keys and the mouse. Each does one thing to the app's state; drawing looks at the state
// afterwards.
#include "viewer/app.h"

#include "viewer/editor.h"
#include "viewer/params.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

namespace fathom::viewer {
namespace {

constexpr double click_radius = 4;                    // a press that moves less is a click
constexpr double fine_step = 0.01, coarse_step = 0.1; // of a param's range

} // namespace

// -- keys

void App::toggle_look(gl::Look look) {
    controls.look = controls.look == look ? gl::Look::Picture : look;
    progress.finished = progress.probed = false;
}

void App::frame_box(const ir::Box &box) {
    const glm::dvec3 lo = glm::make_vec3(box.lo.data()), hi = glm::make_vec3(box.hi.data());
    const glm::dvec3 center = (lo + hi) / 2.0;
    const double radius = std::max(glm::distance(lo, hi) / 2, 1e-4);
    for (int i = 0; i < views.count; ++i)
        if (views.count > 1 || i == views.active)
            frame(views.cameras[static_cast<std::size_t>(i)], center, radius, aspect());
}

void App::frame_all() {
    if (!scene) return;
    if (const ir::Box &framed = scene->compilation.scene.framed; !framed.empty())
        return frame_box(framed);
    const ir::Frame whole = ir::frame_of(scene->compilation.scene, view_of(views.camera()), 100);
    ir::Box box;
    for (std::size_t i = 0; i < 3; ++i) {
        const double half = whole.radius / std::sqrt(3.0); // the box whose corners the sphere meets
        box.lo[i] = whole.center[i] - half;
        box.hi[i] = whole.center[i] + half;
    }
    frame_box(box);
}

void App::step_param(double by) {
    if (controls.chosen >= params.size()) return note("this scene has no params");
    ir::Param &param = params[controls.chosen];
    if (param.type == ir::Type::Bool) {
        param.value[0] = param.value[0] == 0;
    } else {
        for (std::size_t i = 0; i < static_cast<std::size_t>(ir::components(param.type)); ++i) {
            const double range = param.has_range ? param.hi[i] - param.lo[i]
                                                 : std::max(1.0, std::abs(param.value[i]));
            double step = by * range;
            if (param.type == ir::Type::Int)
                step = std::copysign(std::max(1.0, std::round(std::abs(step))), by);
            param.value[i] += step;
            if (param.has_range)
                param.value[i] = std::clamp(param.value[i], param.lo[i], param.hi[i]);
        }
    }
    param_changed(param);
    note(param.name + " = " + text_of(param));
}

// What lies on top goes first: a menu or a colour picker, then the keys, then the selection.
void App::escape() {
    if (ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup)) {
        ImGui::SetWindowFocus(nullptr); // closes them
    } else if (controls.keys) {
        controls.keys = false;
    } else {
        selected = {};
        progress.finished = false;
        note("");
    }
}

// Long: a case for each key.
void App::key(int key, int mods) {
    clock.frames_due = 3;
    const bool shift = (mods & GLFW_MOD_SHIFT) != 0;
    if ((mods & GLFW_MOD_CONTROL) != 0) {
        flies = false; // not even when Control is let go first
        if (key == GLFW_KEY_Q) glfwSetWindowShouldClose(window, GLFW_TRUE);
        if (key == GLFW_KEY_S) write_view();
        return;
    }
    const auto choose = [&](std::size_t by) {
        if (params.empty()) return note("this scene has no params");
        controls.chosen = (controls.chosen + by) % params.size();
        controls.params = true;
        note(params[controls.chosen].name + " = " + text_of(params[controls.chosen]));
    };
    const auto chosen = [&]() -> ir::Param * {
        return controls.chosen < params.size() ? &params[controls.chosen] : nullptr;
    };
    const Views before = views;
    switch (key) {
    case GLFW_KEY_F: frame_all(); break;
    case GLFW_KEY_Z:
        if (!selected.number) {
            note("nothing is selected: click a shape first");
        } else if (const ir::Box box =
                       world_box(scene->compilation.scene,
                                 scene->compilation.parts
                                     .shapes[static_cast<std::size_t>(selected.number) - 1],
                                 clock.time);
                   box.empty()) {
            note("the selected shape has no end to frame");
        } else {
            frame_box(box);
        }
        break;
    case GLFW_KEY_1: look_from(views.camera(), Side::Front); break;
    case GLFW_KEY_3: look_from(views.camera(), Side::Right); break;
    case GLFW_KEY_7: look_from(views.camera(), Side::Top); break;
    case GLFW_KEY_5: views.camera().orthographic = !views.camera().orthographic; break;
    case GLFW_KEY_R: views.camera() = scene_camera; break;
    case GLFW_KEY_V: show_views(views, views.count == 1 ? 2 : views.count == 2 ? 4 : 1); break;
    case GLFW_KEY_C:
        glfwSetClipboardString(window, camera_line(views.camera()).c_str());
        note("copied " + camera_line(views.camera()));
        break;
    case GLFW_KEY_TAB: controls.params = !controls.params; break;
    case GLFW_KEY_BACKSPACE:
        for (ir::Param &param : params) param.value = param.initial;
        note("all params stand on the text's values");
        progress.stale = true;
        if (!newest.structural.empty()) rebuild({});
        break;
    case GLFW_KEY_LEFT_BRACKET: choose(params.size() - 1); break;
    case GLFW_KEY_RIGHT_BRACKET: choose(1); break;
    case GLFW_KEY_COMMA: step_param(shift ? -coarse_step : -fine_step); break;
    case GLFW_KEY_PERIOD: step_param(shift ? coarse_step : fine_step); break;
    case GLFW_KEY_DELETE:
        if (ir::Param *param = chosen()) {
            param->value = param->initial;
            param_changed(*param);
        }
        break;
    case GLFW_KEY_Y:
        if (ir::Param *param = chosen()) {
            glfwSetClipboardString(window, text_of(*param).c_str());
            note("copied " + text_of(*param));
        }
        break;
    case GLFW_KEY_I:
        if (ir::Param *param = chosen()) write_param(*param);
        break;
    case GLFW_KEY_H: toggle_look(gl::Look::Heat); break;
    case GLFW_KEY_B: toggle_look(gl::Look::Bound); break;
    case GLFW_KEY_L: toggle_look(gl::Look::Slice); break;
    case GLFW_KEY_K: toggle_look(gl::Look::Check); break;
    case GLFW_KEY_2:
        controls.cache = !controls.cache;
        cached.view_changed();
        note("");
        break;
    case GLFW_KEY_4:
        controls.use_cache = !controls.use_cache;
        note(controls.use_cache ? "moved by the noise cache" : "moved exactly");
        break;
    case GLFW_KEY_X:
        controls.fxaa = !controls.fxaa;
        progress.finished = false;
        note(controls.fxaa ? "FXAA on" : "FXAA off");
        break;
    case GLFW_KEY_J:
        controls.accumulate = !controls.accumulate;
        progress.stale = true;
        note(controls.accumulate ? "4 samples at rest" : "1 sample at rest");
        break;
    case GLFW_KEY_T: controls.rotate = !controls.rotate; break;
    case GLFW_KEY_U:
        controls.always = !controls.always;
        glfwSwapInterval(controls.always ? 0 : 1);
        break;
    case GLFW_KEY_G: controls.analysis = !controls.analysis; break;
    case GLFW_KEY_O:
        if (selected.number)
            open_selected();
        else
            note("nothing is selected: click a shape first");
        break;
    case GLFW_KEY_SPACE: clock.running = !clock.running; break;
    case GLFW_KEY_0: clock.time = 0; break;
    case GLFW_KEY_N: controls.remarks = !controls.remarks; break;
    case GLFW_KEY_P: recording.requested = true; break;
    case GLFW_KEY_M:
        if (recording.sequence > 0) {
            note(fmt::format("{} frames in {}", recording.sequence - 1, recording.folder.string()));
            recording.sequence = 0;
        } else {
            recording.folder = settings.file.stem().string() + "-frames";
            std::error_code error;
            std::filesystem::create_directories(recording.folder, error);
            if (error) {
                note(fmt::format("cannot make the folder {}: {}", recording.folder.string(),
                                 error.message()));
            } else {
                recording.sequence = 1;
            }
        }
        break;
    case GLFW_KEY_F1: controls.keys = !controls.keys; break;
    case GLFW_KEY_ESCAPE: escape(); break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD: dolly(views.camera(), 1); break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT: dolly(views.camera(), -1); break;
    default: break;
    }
    if (views != before) clock.touched = Clock::now();
}

void App::character(unsigned code) {
    if (code == '?') controls.keys = !controls.keys;
    clock.frames_due = 3;
}

void App::fly_by_keys(double seconds) {
    if (ImGui::GetIO().WantCaptureKeyboard ||
        glfwGetKey(window, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS)
        return;
    auto held = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS ? 1.0 : 0.0; };
    glm::dvec3 by{held(GLFW_KEY_D) - held(GLFW_KEY_A), held(GLFW_KEY_E) - held(GLFW_KEY_Q),
                  held(GLFW_KEY_W) - held(GLFW_KEY_S)};
    if (by == glm::dvec3{}) flies = true;
    if (by == glm::dvec3{} || !flies) return;
    fly(views.camera(), by * (0.8 * std::min(seconds, 0.1)));
    clock.touched = Clock::now();
    clock.frames_due = 3; // goes on for as long as the key is held
}

// -- the mouse

void App::move_cursor(double x, double y) {
    int width = 1, height = 1;
    glfwGetWindowSize(window, &width, &height);
    const double dx = x - pointer.x, dy = y - pointer.y;
    pointer.x = x;
    pointer.y = y;
    clock.frames_due = std::max(clock.frames_due, 2);
    const bool over_panel = ImGui::GetIO().WantCaptureMouse;
    const bool left = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    const bool other = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS ||
                       glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_MIDDLE) == GLFW_PRESS;
    if (!left && !other) {
        const int part = over_panel || !scene ? 0 : pick_at_cursor().part;
        if (part != hovered.number) {
            hovered = scene ? part_of(scene->compilation, part) : Part{};
            progress.finished = false;
        }
        return;
    }
    if (over_panel || pointer.dragged < 0) return;
    if (std::hypot(x - pointer.pressed_x, y - pointer.pressed_y) < click_radius) return;
    const bool shift = glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                       glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    clock.touched = Clock::now();
    Camera &camera = views.cameras[static_cast<std::size_t>(pointer.dragged)];
    const double tile = std::max(
        tiles_of(views, width, height)[static_cast<std::size_t>(pointer.dragged)].height, 1);
    if (other || shift)
        pan(camera, dx / tile, dy / tile);
    else
        orbit(camera, dx / tile, dy / tile);
}

void App::button(int button, bool down) {
    clock.frames_due = 3;
    glfwGetCursorPos(window, &pointer.x, &pointer.y);
    if (down) {
        int width = 1, height = 1;
        glfwGetWindowSize(window, &width, &height);
        pointer.pressed_x = pointer.x;
        pointer.pressed_y = pointer.y;
        pointer.dragged = ImGui::GetIO().WantCaptureMouse
                              ? -1
                              : tile_at(tiles_of(views, width, height), pointer.x, pointer.y);
        if (pointer.dragged >= 0) views.active = pointer.dragged;
        return;
    }
    const bool click =
        button == GLFW_MOUSE_BUTTON_LEFT && pointer.dragged >= 0 &&
        std::hypot(pointer.x - pointer.pressed_x, pointer.y - pointer.pressed_y) < click_radius;
    pointer.dragged = -1;
    pointer.clicked |= click; // panels know only with the next frame whether it was theirs
}

void App::open_selected() {
    note(open_in_editor(users_editor(), selected.file, std::max(selected.line, 1u),
                        std::max(selected.column, 1u)));
}

// An editor with a window of its own jumps to the line at each click; one in a terminal only when
// when its key is pressed.
void App::select(bool open) {
    if (!scene) return;
    const gl::Pick pick = pick_at_cursor();
    selected = part_of(scene->compilation, pick.part);
    progress.finished = false;
    if (!selected.number) return note("");
    if (open && editor) { // it puts its cursor there
        editor->clicked(selected.file, selected.line, selected.column);
        return note(place_of(selected));
    }
    const std::string program = users_editor();
    if (open && !program.empty() && !needs_terminal(program))
        open_selected();
    else
        note(place_of(selected) + (program.empty() ? "" : " (O opens it)"));
}

void App::scroll(double steps) {
    clock.frames_due = 3;
    if (ImGui::GetIO().WantCaptureMouse) return;
    int width = 1, height = 1;
    glfwGetWindowSize(window, &width, &height);
    const int at = tile_at(tiles_of(views, width, height), pointer.x, pointer.y);
    if (at < 0) return;
    clock.touched = Clock::now();
    dolly(views.cameras[static_cast<std::size_t>(at)], steps);
}

} // namespace fathom::viewer
