// Point rates of the CPU tape on one thread, each against the same field written by hand where
// there is one.
#include "bench/by_hand.h"
#include "bench/measure.h"

#include "backend-cpu/tape.h"
#include "ir/noise.h"

#include <cmath>
#include <fmt/format.h>

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
    return g.add_function(
        {"blended", {}, {p}, g.make(Op::Blend, Type::Float, args, std::uint32_t(Profile::Smooth))});
}

// The sharp minimum of fields with exponentials: -k log sum exp(-f/k).
FunctionId summed(Scene &scene, const Spheres &s, double k) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3), sum = g.number(0);
    for (std::size_t i = 0; i < s.x.size(); ++i) {
        const NodeId f = ball(g, p, g.vec3(s.x[i], s.y[i], s.z[i]), g.number(s.r[i]));
        sum = g.add(sum, g.make(Op::Exp, {g.mul(f, g.number(-1 / k))}));
    }
    return g.add_function({"summed", {}, {p}, g.mul(g.make(Op::Log, {sum}), g.number(-k))});
}

// As a loop over a table.
FunctionId looped(Scene &scene, const Spheres &s, double k) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3), acc = g.fresh_var(Type::Float);
    ir::Table table{static_cast<int>(s.x.size()), 4, {}};
    for (std::size_t i = 0; i < s.x.size(); ++i)
        table.data.insert(table.data.end(), {s.x[i], s.y[i], s.z[i], s.r[i]});
    TableId id = g.add_table(table);
    ir::Loop record;
    record.count = g.integer(table.rows);
    record.max_count = table.rows;
    record.index = g.fresh_var(Type::Int);
    NodeId c = g.make(Op::TableRead, Type::Vec3, {record.index}, table_slot(id, 0));
    NodeId r = g.make(Op::TableRead, Type::Float, {record.index}, table_slot(id, 3));
    NodeId args[] = {g.number(k), g.number(0), acc, ball(g, p, c, r)};
    record.vars = {acc};
    record.next = {g.make(Op::Blend, Type::Float, args, std::uint32_t(Profile::Smooth))};
    return g.add_function(
        {"looped",
         {},
         {p},
         g.make(Op::Loop, Type::Float, {g.number(1e9)}, g.add_loop(record).index)});
}

// A Menger sponge as the difference of a cube and all its square holes, each written out: about a
// thousand operations at level 3, as libfive has them. (Folding space would need some sixty.)
struct Holes {
    Graph &g;
    NodeId u, v;
    std::vector<NodeId> all;

    NodeId between(NodeId x, double lo, double hi) {
        return g.make(Op::Max, {g.sub(g.number(lo), x), g.sub(x, g.number(hi))});
    }
    void add(double x, double y, double size, int levels) {
        if (levels == 0) return;
        const double third = size / 3;
        all.push_back(g.make(
            Op::Max, {between(u, x + third, x + 2 * third), between(v, y + third, y + 2 * third)}));
        for (int i = 0; i < 9; ++i)
            if (i != 4) add(x + (i % 3) * third, y + (i / 3) * third, third, levels - 1);
    }
};
FunctionId menger(Scene &scene, int levels) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3);
    Holes cube{g, {}, {}, {}};
    std::vector<NodeId> sides, holes;
    for (int axis = 0; axis < 3; ++axis) {
        Holes along{g, g.component(p, axis), g.component(p, (axis + 1) % 3), {}};
        along.add(-1.5, -1.5, 3, levels);
        holes.insert(holes.end(), along.all.begin(), along.all.end());
        sides.push_back(cube.between(g.component(p, axis), -1.5, 1.5));
    }
    sides.push_back(g.neg(g.make(Op::Union, Type::Float, holes)));
    return g.add_function({"menger", {}, {p}, g.make(Op::Intersection, Type::Float, sides)});
}

FunctionId noise(Scene &scene, int octaves) {
    Graph &g = scene.graph;
    NodeId p = g.fresh_var(Type::Vec3), sum = g.number(0);
    for (int i = 0; i < octaves; ++i)
        sum = g.add(sum, g.mul(g.make(Op::Perlin, {g.mul(p, g.number(1 << i))}),
                               g.number(std::ldexp(1.0, -i))));
    return g.add_function({"noise", {}, {p}, sum});
}

} // namespace

void measure_interpreter(Table &table) {
    Cloud cloud;
    const Spheres spheres = hundred_spheres();
    constexpr float k = 0.1f;
    auto by_hand = [&] {
        smooth_spheres_by_hand(spheres, k, cloud.x.data(), cloud.y.data(), cloud.z.data(),
                               cloud.out.data(), points);
    };
    auto against_hand = [&](const char *what,
                            FunctionId (*make)(Scene &, const Spheres &, double)) {
        Scene scene;
        Run run(scene, make(scene, spheres, k));
        const Rates both = rates(
            points * million, [&] { run(cloud); }, points * million, by_hand);
        table.push_back({what, both.first, "M points/s", "hand-fused loop", both.second, 0.7});
    };
    against_hand("100-sphere smooth union", blended);
    const double fused = table.back().baseline_value;
    against_hand("100-sphere smooth union, table", looped);
    // libfive's batches evaluated its own Menger 3 at 17 M points/s on a machine on which the
    // hand-fused loop above ran at 54 to 60.
    const double libfive = 17 * fused / 57;
    Scene scene;
    Run sponge(scene, menger(scene, 3));
    table.push_back({"Menger sponge, level 3, 219 holes",
                     rate(points * million, [&] { sponge(cloud); }), "M points/s",
                     "libfive as recorded, by the hand-fused loop's rate here", libfive, 3});
    {
        Run run(scene, summed(scene, spheres, k));
        const auto by_library = [&] {
            for (std::size_t i = 0; i < points; ++i) {
                float sum = 0;
                for (std::size_t j = 0; j < spheres.x.size(); ++j) {
                    const float x = cloud.x[i] - spheres.x[j], y = cloud.y[i] - spheres.y[j],
                                z = cloud.z[i] - spheres.z[j];
                    sum += std::exp((std::sqrt(x * x + y * y + z * z) - spheres.r[j]) / -k);
                }
                cloud.out[i] = -k * std::log(sum);
            }
        };
        const Rates both = rates(
            points * million, [&] { run(cloud); }, points * million, by_library);
        table.push_back({"log-sum-exp of 100 spheres", both.first, "M points/s",
                         "a loop with the C library's exp", both.second, 2});
    }
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
        const Rates both = rates(
            points * million, [&] { run(cloud); }, points * million, scalar);
        table.push_back({fmt::format("Perlin noise, octaves: {}", octaves), both.first,
                         "M points/s", "point by point", both.second, 0});
    }
}

} // namespace fathom::bench
