// Point rates of the CPU tape on one thread, each against the same field written by hand where there is one.
#include "bench/by_hand.h"
#include "bench/measure.h"

#include "backend-cpu/tape.h"
#include "ir/noise.h"

#include <cmath>

namespace fathom::bench {

namespace {

using namespace fathom::ir;

constexpr std::size_t points = 1 << 16;

struct Cloud {
    std::vector<float> x = std::vector<float>(points), y = x, z = x, out = x;
    Cloud() {
        for (std::size_t i = 0; i < points; ++i) {
            auto part = [&](double by) {
                const double t = double(i + 1) * by;
                return static_cast<float>(2.6 * (t - std::floor(t)) - 1.3);
            };
            x[i] = part(0.8191725134);
            y[i] = part(0.6710436067);
            z[i] = part(0.5497004779);
        }
    }
};

class Run {
  public:
    Run(const Scene &scene, FunctionId function)
        : program_(cpu::compile(scene, function)), scratch_(cpu::make_scratch(program_, {})) {}
    void operator()(Cloud &cloud) {
        const float *in[] = {cloud.x.data(), cloud.y.data(), cloud.z.data()};
        float *out[] = {cloud.out.data()};
        cpu::evaluate(program_, scratch_, in, out, points);
    }

  private:
    cpu::Program program_;
    cpu::Scratch scratch_;
};

constexpr double million = 1e-6;

NodeId ball(Graph &g, NodeId p, NodeId center, NodeId radius) {
    return g.sub(g.make(Op::Length, {g.sub(p, center)}), radius);
}

// Written as operands, each with its numbers in place.
FunctionId blended(Scene &scene, const Spheres &s, double k) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3);
    std::vector<NodeId> args{g.number(k), g.number(0)};
    for (std::size_t i = 0; i < s.x.size(); ++i)
        args.push_back(ball(g, p, g.vec3(s.x[i], s.y[i], s.z[i]), g.number(s.r[i])));
    return g.add_function({"blended", {}, {p}, g.make(Op::Blend, Type::Float, args, std::uint32_t(Profile::Smooth))});
}

// As a loop over a table.
FunctionId looped(Scene &scene, const Spheres &s, double k) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3), acc = g.fresh_var(Type::Float);
    ir::Table table{static_cast<int>(s.x.size()), 4, {}};
    for (std::size_t i = 0; i < s.x.size(); ++i) table.data.insert(table.data.end(), {s.x[i], s.y[i], s.z[i], s.r[i]});
    TableId id = g.add_table(table);
    Fold fold;
    fold.count = g.integer(table.rows);
    fold.max_count = table.rows;
    fold.index = g.fresh_var(Type::Int);
    NodeId c = g.make(Op::TableRead, Type::Vec3, {fold.index}, table_slot(id, 0));
    NodeId r = g.make(Op::TableRead, Type::Float, {fold.index}, table_slot(id, 3));
    NodeId args[] = {g.number(k), g.number(0), acc, ball(g, p, c, r)};
    fold.vars = {acc};
    fold.next = {g.make(Op::Blend, Type::Float, args, std::uint32_t(Profile::Smooth))};
    return g.add_function({"looped", {}, {p}, g.make(Op::Fold, Type::Float, {g.number(1e9)}, g.add_fold(fold).index)});
}

// A Menger sponge of level 3 as a difference of boxes' crosses: max(box, -cross at 3^i).
FunctionId menger(Scene &scene, int level) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3);
    auto part = [&](NodeId v, int i) { return g.component(v, i); };
    auto box = [&](NodeId v) {
        NodeId q = g.sub(g.make(Op::Abs, {v}), g.vec3(1, 1, 1));
        NodeId outside = g.make(Op::Length, {g.make(Op::Max, {q, g.vec3(0, 0, 0)})});
        NodeId most = g.make(Op::Max, {part(q, 0), g.make(Op::Max, {part(q, 1), part(q, 2)})});
        return g.add(outside, g.make(Op::Min, {most, g.number(0)}));
    };
    NodeId d = box(p);
    double scale = 1;
    for (int i = 0; i < level; ++i) {
        auto all = [&](double x) { return g.vec3(x, x, x); };
        NodeId a = g.sub(g.make(Op::Mod, {g.mul(p, g.number(scale)), all(2)}), all(1));
        scale *= 3;
        NodeId r = g.make(Op::Abs, {g.sub(all(1), g.mul(g.number(3), g.make(Op::Abs, {a})))});
        NodeId xy = g.make(Op::Max, {part(r, 0), part(r, 1)}), yz = g.make(Op::Max, {part(r, 1), part(r, 2)}),
               zx = g.make(Op::Max, {part(r, 2), part(r, 0)});
        NodeId cross = g.sub(g.make(Op::Min, {xy, g.make(Op::Min, {yz, zx})}), g.number(1));
        d = g.make(Op::Max, {d, g.div(cross, g.number(scale))});
    }
    return g.add_function({"menger", {}, {p}, d});
}

FunctionId noise(Scene &scene, int octaves) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3), sum = g.number(0);
    for (int i = 0; i < octaves; ++i)
        sum = g.add(sum, g.mul(g.make(Op::Perlin, {g.mul(p, g.number(1 << i))}), g.number(std::ldexp(1.0, -i))));
    return g.add_function({"noise", {}, {p}, sum});
}

} // namespace

void measure_interpreter(Table &table) {
    Cloud cloud;
    const Spheres spheres = hundred_spheres();
    constexpr float k = 0.1f;
    auto by_hand = [&] {
        smooth_spheres_by_hand(spheres, k, cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.out.data(), points);
    };
    auto against_hand = [&](const char *what, FunctionId (*make)(Scene &, const Spheres &, double)) {
        Scene scene;
        Run run(scene, make(scene, spheres, k));
        const Rates both = rates(points * million, [&] { run(cloud); }, points * million, by_hand);
        table.push_back({what, both.first, "M points/s", "hand-fused loop", both.second, 0.7});
    };
    against_hand("100-sphere smooth union", blended);
    against_hand("100-sphere smooth union, table", looped);
    // 17 M points/s is libfive's batch evaluation of its own Menger 3 on a processor of this kind.
    Scene scene;
    Run sponge(scene, menger(scene, 3));
    table.push_back({"Menger sponge, level 3", rate(points * million, [&] { sponge(cloud); }), "M points/s",
                     "libfive as recorded", 17, 3});
    for (int octaves : {1, 4}) {
        Run run(scene, noise(scene, octaves));
        auto scalar = [&] {
            for (std::size_t i = 0; i < points; ++i) {
                float sum = 0;
                for (int o = 0; o < octaves; ++o) {
                    const float f = float(1 << o);
                    sum += sem::perlin(cloud.x[i] * f, cloud.y[i] * f, cloud.z[i] * f) / f;
                }
                cloud.out[i] = sum;
            }
        };
        const Rates both = rates(points * million, [&] { run(cloud); }, points * million, scalar);
        table.push_back({"Perlin noise, octaves: " + std::to_string(octaves), both.first, "M points/s",
                         "point by point", both.second, 0});
    }
}

} // namespace fathom::bench
