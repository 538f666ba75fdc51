// The safe ball, asked of the shader: its marched distance neither exceeds the processor's nor
// changes its sign within it. Points lie in a table, and one pass answers for all of them. Needs a
// GL context (gl_context.h).
#pragma once

#include "ir/lower/lower.h"
#include "tests/support/slopes.h"
#include "tests/unit/render_gl/harness.h"

#include <catch2/catch.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace fathom::test {

inline std::string place(const Point3 &p) {
    std::ostringstream out;
    out.precision(9);
    out << "[" << p[0] << ", " << p[1] << ", " << p[2] << "]";
    return out.str();
}

// The distance at `points` (a multiple of `across` of them) by an emitted shader.
inline std::vector<float> in_shader(ir::Scene scene, const std::vector<Point3> &points,
                                    int across) {
    ir::Graph &g = scene.graph;
    ir::Table table{static_cast<int>(points.size()), 3, {}};
    for (const Point3 &p : points)
        for (double x : p) table.data.push_back(float(x));
    const ir::TableId id = g.add_table(std::move(table));
    const ir::NodeId at = g.fresh_var(ir::Type::Vec3);
    const ir::NodeId row =
        g.make(ir::Op::ToInt, ir::Type::Int,
               {g.add(g.component(at, 0), g.mul(g.component(at, 1), g.number(double(across))))});
    const ir::NodeId p = g.make(ir::Op::TableRead, ir::Type::Vec3, {row}, ir::table_slot(id, 0));
    const ir::NodeId d = g.make(ir::Op::Call, ir::Type::Float, {p}, scene.distance.index);
    scene.distance = g.add_function({"distance_at_row", {}, {at}, d});
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(
        scene, {.target = glsl::Target::Glsl330, .field_only = true, .buffers = true}, diagnostics);
    for (const Diagnostic &one : diagnostics.items()) UNSCOPED_INFO(one.message);
    REQUIRE_FALSE(diagnostics.has_errors());
    return run_shader(output, across, static_cast<int>(points.size()) / across, &scene);
}

struct ShaderBalls {
    int balls = 0, unsafe = 0;
    std::string worst; // the first that failed, in words
};

// `count` random balls in the box, a multiple of 1024. Rounding: 5e-5 of the box's size, which
// allows for another order of float32 operations and for another sine.
inline ShaderBalls shader_balls(const ir::Scene &scene, const Point3 &lo, const Point3 &hi,
                                int count) {
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i)
        size = std::max({size, std::fabs(lo[i]), std::fabs(hi[i]), hi[i] - lo[i]});
    const double rounding = 2e-5 * std::max(1.0, size);
    Sampler sampler(scene);
    std::vector<Point3> points;
    for (int i = 0; i < count; ++i) points.push_back(sampler.in_box(lo, hi));
    const std::vector<float> known = sampler.values(points);
    for (int i = 0; i < count; ++i)
        points.push_back(sampler.in_ball(
            points[std::size_t(i)], std::min<double>(std::fabs(known[std::size_t(i)]), 4 * size)));
    const std::vector<float> d = in_shader(scene, points, 1024);
    ShaderBalls out;
    out.balls = count;
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
        const float a = d[i], b = d[i + std::size_t(count)];
        const bool other = (a < 0) != (b < 0) && std::min(std::fabs(a), std::fabs(b)) > rounding;
        // The ball is as large as the processor's distance: it is the shader's too, or less.
        const bool longer = !(std::fabs(a) <= std::fabs(known[i]) * (1 + 1e-3) + rounding);
        if (!other && !longer) continue;
        if (out.unsafe++ > 0) continue;
        std::ostringstream words;
        words << "at " << place(points[i]) << " the shader says " << a << ", the processor "
              << known[i] << "; at " << place(points[i + std::size_t(count)]) << " " << b;
        out.worst = words.str();
    }
    return out;
}

} // namespace fathom::test
