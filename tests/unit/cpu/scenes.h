// Small lowered scenes, built by hand, for the tests of the CPU back end.
#pragma once

#include "backend-cpu/tape.h"

#include <cmath>
#include <vector>

namespace fathom::cpu::test {

using namespace fathom::ir;

struct Fields {
    Scene scene;
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3);

    NodeId x() { return g.component(p, 0); }
    NodeId y() { return g.component(p, 1); }
    NodeId z() { return g.component(p, 2); }
    NodeId length(NodeId v) { return g.make(Op::Length, {v}); }
    NodeId ball(double cx, double cy, double cz, double r) {
        return g.sub(length(g.sub(p, g.vec3(cx, cy, cz))), g.number(r));
    }
    FunctionId function(NodeId result) { return g.add_function({"f", {}, {p}, result}); }
    FunctionId function(std::vector<NodeId> params, NodeId result) {
        return g.add_function({"f", {}, std::move(params), result});
    }
};

struct Points {
    std::vector<float> x, y, z;
};

// Well spread and reproducible: the fractions of multiples of three irrationals, -2 to 2.
inline Points spread(std::size_t n) {
    Points points;
    for (std::size_t i = 0; i < n; ++i) {
        auto part = [&](double by) {
            double t = static_cast<double>(i + 1) * by;
            return static_cast<float>(4 * (t - std::floor(t)) - 2);
        };
        points.x.push_back(part(0.8191725134));
        points.y.push_back(part(0.6710436067));
        points.z.push_back(part(0.5497004779));
    }
    return points;
}

// One float result.
inline std::vector<float> values(const Program &program, const Points &points,
                                 const Inputs &inputs = {}) {
    Scratch scratch = make_scratch(program, inputs);
    std::vector<float> out(points.x.size());
    const float *in[] = {points.x.data(), points.y.data(), points.z.data()};
    float *to[] = {out.data()};
    evaluate(program, scratch, in, to, out.size());
    return out;
}

// How many steps run a kernel of this name, once through the whole tape.
inline std::size_t count_steps(const Program &program, const std::string &kernel) {
    std::string text = dump(program);
    std::size_t found = 0;
    for (std::size_t at = text.find(" " + kernel + " "); at != std::string::npos;
         at = text.find(" " + kernel + " ", at + 1))
        ++found;
    return found;
}

} // namespace fathom::cpu::test
