// What the user has switched on: plain values that keys and panels change and that drawing reads.
#pragma once

#include "render-gl/post.h"

namespace fathom::viewer {

// The switches of the window.
struct Controls {
    bool keys = false, params = true, remarks = false, analysis = false; // panels that are shown
    gl::Look look = gl::Look::Picture;
    bool fxaa = true;
    bool accumulate = true; // four samples a pixel when nothing moves
    bool always = false;    // draws as fast as the card can
    bool rotate = false;
    bool use_cache = true; // while it is moved, cached fields are read from the noise cache
    bool cache = false;    // the noise cache at work, in place of the picture
    int slice_axis = 2;
    double slice_offset = 0;
    std::size_t chosen = 0; // the param that keys change
};

} // namespace fathom::viewer
