// The one GL context of a test program.
#pragma once

#include "render-gl/context.h"

#include <catch2/catch.hpp>

namespace fathom {

// Makes the context at the first call and keeps it. Fails the running test where none can be made:
// Mesa's software driver needs no card, so a machine that passes the tests always has one.
inline void require_context() {
    static const std::variant<gl::Context, std::string> context = gl::Context::make();
    if (const auto *reason = std::get_if<std::string>(&context)) FAIL("no GL context: " << *reason);
}

} // namespace fathom
