// What lies over the picture, in Dear ImGui: the status line, the sliders, the errors, the keys. Reads and changes plain
// values; knows neither the window nor GL.
#pragma once

#include "ir/scene.h"

#include <string>
#include <vector>

namespace fathom::viewer {

struct Status {
    double front_end_ms = 0, link_ms = 0, frame_ms = 0;
    std::size_t shader_bytes = 0;
    std::string bound; // "L 1.25 proved"
    std::string note;  // the last thing done: "camera line copied"
    bool linked_anew = false;
};

struct PanelState {
    bool keys = false;    // the list of keys is shown
    bool params = true;   // the sliders are shown
    bool remarks = false; // warnings and notes are shown
};

struct Asked {
    bool redraw = false;      // a value changed
    bool rebuild = false;     // a structural one did
    std::string copy;         // text for the clipboard
};

Asked show_panels(PanelState &state, const Status &status, const std::string &file, std::vector<ir::Param> &params,
                  const std::vector<std::string> &errors, const std::vector<std::string> &remarks);

} // namespace fathom::viewer
