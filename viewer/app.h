// The window's state, and what is done to it: builds are taken (app.cpp), the scene is drawn
// (draw_scene.cpp, draw.cpp), keys and the mouse are heard (input.cpp). For those files and
// viewer.cpp alone.
#pragma once

#include "render-gl/timer.h"
#include "viewer/cached.h"
#include "viewer/controls.h"
#include "viewer/editor_line.h"
#include "viewer/frame_times.h"
#include "viewer/panels.h"
#include "viewer/pick.h"
#include "viewer/viewer.h"
#include "viewer/views.h"
#include "viewer/worker.h"

#include <chrono>

struct GLFWwindow;

namespace fathom::viewer {

driver::CompileOptions compile_options(const Settings &settings);

using Clock = std::chrono::steady_clock;
// Clock time since `start`.
double milliseconds_since(Clock::time_point start);

// All that a picture depends on, program and params apart: while it stays, nothing is drawn anew.
// The size is the window's.
struct Shot {
    Views views;
    double time = 0;
    int width = 0, height = 0;
    friend bool operator==(const Shot &, const Shot &) = default;
};

// What the canvas holds.
struct DrawnPicture {
    std::optional<Shot> shot;
    int width = 0, height = 0; // in pixels
    double scale = 0;          // of these to the window's
    bool cached = false;       // it came through the noise cache
};

// How far the picture in hand is.
struct Progress {
    static constexpr int samples_at_rest = 4;
    bool stale = true;      // the program or a value changed since the canvas was drawn
    bool measured = false;  // it is known what a picture by this program takes
    bool resting = false;   // the picture that is drawn is not moved
    int coarse = 1;         // then: it is drawn in every so-manieth pixel first, 1 is in full
    bool drew_now = false;  // in this iteration of the loop
    bool probed = false;    // the probe shows what is drawn
    bool finished = false;  // what is shown is what was drawn
    bool on_screen = false; // something of the newest good build was shown
    bool drawing = false;   // a sample is drawn in part: so many rows, which took so long
    int next_sample = 0, next_row = 0;
    double sample_ms = 0, gpu_ms = 0;
    std::vector<bool>
        bands_requested; // of the timer's answers to come: whether it is a sample's last
    int samples_drawn = 0, frames_drawn = 0;
};

// The pictures through the noise cache while the view is moved.
struct MovingCached {
    std::optional<Shot> shot;
    int frames = 0;                 // since it was at rest
    Clock::time_point fade_begin{}; // from the last such picture to the exact one
};

// What each pixel shows of what is shown at rest, while the next picture is drawn over it.
struct Picks {
    std::vector<float> values;
    int width = 0, height = 0;
};

// The newest build, good or not.
struct NewestBuild {
    std::vector<std::string> errors, remarks;
    std::vector<driver::Override> structural; // what the worker builds with
    driver::Stamps files;                     // that it read
    std::filesystem::path saved;              // the file whose save brought it; empty: none did
    bool told = true;
};

// The scene's time, and when something happened.
struct SceneClock {
    bool running = true; // time passes, where the scene reads it
    double time = 0;
    double held_back = 0;        // seconds that pass when the present picture is whole
    Clock::time_point noted{};   // when the note was written
    Clock::time_point touched{}; // the last time the picture was moved by hand
    Clock::time_point last_draw{};
    int frames_due = 3; // the panels settle within a few frames after an event
};

// Pictures of the window that are saved.
struct Recording {
    int pictures = 0, sequence = 0; // so far; of a sequence, 0 where none is taken
    std::filesystem::path folder;   // of the sequence
    bool next = false, requested = false;
};

// The mouse, in pixels of the window.
struct Pointer {
    double x = 0, y = 0, pressed_x = 0, pressed_y = 0;
    bool clicked = false;
    int dragged = -1; // the view in which the button went down
};

// The state of the window.
struct App {
    explicit App(const Settings &s) : settings(s) {}

    const Settings &settings;
    GLFWwindow *window = nullptr;
    std::unique_ptr<Worker> worker;
    std::unique_ptr<EditorLine> editor;  // none: the window follows the file's saves alone
    std::optional<std::uint32_t> cursor; // the editor's, a byte of the text
    Linkers linkers;                     // where the worker has no context of its own

    // The good picture: its scene, its programs, what was drawn of it.
    std::unique_ptr<Build> scene;
    std::optional<gl::Program> program, probe;
    std::vector<ir::Param> params; // the user's
    std::vector<ir::Param> sent;   // … and the present bounds, as the program takes them
    std::size_t sent_number = 0;   // of the build that they are of
    gl::Canvas canvas;
    gl::Timer timer;
    Cached cached;
    DrawnPicture drawn;
    Progress progress;
    MovingCached moving_cached;
    Picks picks;

    // What is beside it.
    NewestBuild newest;
    Views views;
    Camera scene_camera;
    bool has_camera = false;
    Controls controls;
    Status status;
    FrameTimes frame_times, gpu_times;
    std::vector<IsolineLabel> labels;
    std::array<std::size_t, 4> verdicts{}; // pixels, by the check's verdict
    Part selected, hovered;
    SceneClock clock;
    Recording recording;
    Pointer pointer;
    bool linking = false; // on this thread
    bool flies = true;    // the keys that are held move the camera
    float font_scale = 1;

    // app.cpp
    void take(std::unique_ptr<Build> build);
    bool adopt(Build &build);
    void rebuild(std::vector<driver::Override> values);
    bool animated() const { return scene && clock.running && scene->picture.reads_time; }
    void param_changed(const ir::Param &param);
    void follow_params();  // what is sent, and bounds for the present values
    void hear_editor();    // what was typed since the last time
    void outline_cursor(); // the shape that the editor's cursor stands in
    void write_param(const ir::Param &param);
    bool write_view(); // false where it could not be; the note says why
    void note(std::string words);
    double note_seconds_left() const; // at least a little
    void drop_old_note();
    std::string doing() const;                         // what takes its time now, in words
    std::string text_of(const ir::Param &param) const; // its value, as its text writes it

    // input.cpp
    void key(int key, int mods);
    void character(unsigned code);
    void move_cursor(double x, double y);
    void button(int button, bool down);
    void scroll(double steps);
    void fly_by_keys(double seconds);
    void frame_box(const ir::Box &box);
    void frame_all();
    void select(bool open);
    void open_selected();
    void escape();
    void step_param(double by);
    void toggle_look(gl::Look look);

    // draw_scene.cpp
    bool pending() const; // more samples are wanted, or something was not shown yet
    void draw_scene(int width, int height, bool moving, bool drew_before);
    void measure(int width, int height);
    int first_coarseness(bool same_view) const;
    void picture_is_whole(double scale, bool moving, bool drew_before);
    bool draw_rows(bool whole);
    void keep_picks();
    void finish_picture(double scale);
    bool draw_cached_frame(double scale);
    bool
    uses_cache(bool by_hand) const; // whether the next picture may come through the noise cache

    // draw.cpp
    void draw(double seconds);
    void draw_probe();
    bool draw_cached(int width, int height); // false where there is nothing to show
    double fading() const;                   // the share of the picture before, 0 where it is gone
    void draw_panels(int width, int height);
    void save_pictures(int width, int height, bool moving);
    bool save_window(const std::filesystem::path &file, int width, int height);
    double aspect() const; // of the first view
    std::vector<gl::TileView> tile_views(int width, int height) const;
    gl::Pick pick_at_cursor() const;
};

} // namespace fathom::viewer
