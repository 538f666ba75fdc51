// What the emitter writes: valid on every target, linear, readable.
#include "tests/unit/glsl/scenes.h"

#include "backend-glsl/emit.h"

#include <catch2/catch.hpp>

using namespace fathom;

namespace {

const glsl::Target all_targets[] = {glsl::Target::Glsl450, glsl::Target::Glsl330,    glsl::Target::Es300,
                                    glsl::Target::Shadertoy, glsl::Target::GlslViewer, glsl::Target::Spirv,
                                    glsl::Target::Html};

glsl::Output emitted(const ir::Scene &scene, glsl::Options options = {}) {
    Diagnostics diagnostics;
    glsl::Output output = glsl::emit(scene, options, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) {
        UNSCOPED_INFO(d.message);
        for (const std::string &note : d.notes) UNSCOPED_INFO(note);
    }
    CHECK_FALSE(diagnostics.has_errors());
    return output;
}

} // namespace

TEST_CASE("a sphere is emitted for every target") {
    for (glsl::Target target : all_targets)
        for (bool field_only : {false, true}) {
            CAPTURE(glsl::target_name(target), field_only);
            const glsl::Output out = emitted(scenes::sphere(), {.target = target, .field_only = field_only});
            CHECK(out.text.empty() == (target == glsl::Target::Spirv));
            CHECK(out.words.empty() == (target != glsl::Target::Spirv));
        }
}
