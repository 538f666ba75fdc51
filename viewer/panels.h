// What lies over the picture, in Dear ImGui: the status line, the sliders, the errors, the keys,
// the analysis. Reads and changes plain values; knows neither the window nor GL.
#pragma once

#include "ir/scene.h"
#include "viewer/cached.h"
#include "viewer/controls.h"
#include "viewer/frame_times.h"

#include <array>
#include <string>
#include <vector>

namespace fathom::viewer {

// What the status line says.
struct Status {
    double front_end_ms = 0, driver_ms = 0, frame_ms = 0;
    std::size_t shader_bytes = 0;
    std::string bound;     // "L 401 proved"
    std::string bound_now; // "1.25 as the params stand"; empty: that is not known
    std::string note;      // the last thing done: "camera line copied"
    std::string trouble;   // what stays wrong: saves are not followed
    double mean_steps = 0; // a ray
    std::string lists;     // how many rows a cell has, where loops are pruned
    bool linked_anew = false;
    int width = 0, height = 0; // of the viewport, in pixels
};

// A number at a line of equal distance.
struct IsolineLabel {
    float x = 0, y = 0; // in the window
    double value = 0;
};

// All that panels show and do not change.
struct Shown {
    const Status &status;
    std::string file;
    const std::vector<std::string> &errors, &remarks;
    std::string doing;             // what takes its time, in words
    bool picture = false;          // there is one to see
    std::string selected, hovered; // what was picked, in words; empty: nothing
    std::vector<std::pair<std::string, std::array<float, 2>>> view_names; // and where they stand
    const std::vector<IsolineLabel> &labels;
    const FrameTimes &frame_times, &gpu_times;
    const std::array<std::size_t, 4> &verdicts;
    const CacheFigures *cache = nullptr; // where the scene has cached fields
    int max_steps = 256;
    std::uint64_t undecided = 0; // rays of the picture
    double reach = 1;            // how far a slice can be moved
};

// What the user did in the panels this frame.
struct Asked {
    std::vector<std::size_t> changed; // params with a new value
    std::vector<std::size_t> write;   // params whose value is to stand in the text
    std::vector<std::size_t> copy;    // params whose value goes to the clipboard
    bool look = false;                // a control that the picture depends on changed
    std::array<int, 2> size{0, 0};    // a size for the window
};

// Draws all panels.
Asked show_panels(Controls &controls, const Shown &shown, std::vector<ir::Param> &params);

// analysis.cpp
void show_analysis(Controls &controls, const Shown &shown, Asked &asked);

} // namespace fathom::viewer
