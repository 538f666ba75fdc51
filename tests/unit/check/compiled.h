// A scene's text, checked, proved and lowered; its errors are for the test to see.
#pragma once

#include "driver/compile.h"

namespace fathom::test {

inline driver::Compilation compiled(const std::string &text) {
    return driver::compile_text("scene.sdf", text, ".", {});
}

} // namespace fathom::test
