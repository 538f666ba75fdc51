// The judge's pairs of points in the shader, too: as a card computes the field, with sines, powers and
// an order of operations of its own. Needs a GL context.
#pragma once

#include "judge.h"
#include "tests/support/shader_field.h"

#include <memory>

namespace fathom::test {

inline Values in_shader(const ir::Scene &scene) {
    const auto field = std::make_shared<ShaderField>(scene);
    return [field](const ir::Scene &now, double time, const std::vector<Point3> &points) {
        return field->values(now, time, points);
    };
}

// Of every fourth scene, as compiling a shader takes longer than all else; of each where more is
// tried than usual.
inline Evaluator some_in_shader() {
    return [count = 0](const ir::Scene &scene) mutable -> Values {
        const bool taken = effort(1) > 1 || count % 4 == 0;
        ++count;
        return taken ? in_shader(scene) : Values{};
    };
}

} // namespace fathom::test
