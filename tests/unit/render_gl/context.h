// The one GL context of a test program.
#pragma once

#include "render-gl/context.h"

#include <iostream>

namespace fathom {

// Whether there is a context; where there is none the reason is printed once, and the tests that
// need it skip.
inline bool has_context() {
    static const std::variant<gl::Context, std::string> context = [] {
        auto made = gl::Context::make();
        if (const auto *reason = std::get_if<std::string>(&made))
            std::cerr << "skipped: no GL context: " << *reason << "\n";
        return made;
    }();
    return std::holds_alternative<gl::Context>(context);
}

} // namespace fathom
