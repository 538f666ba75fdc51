// What cells save on scenes of many shapes: rays from the eye with cells, made on the way, against
// the same rays with the whole tape, a sample of them where all would take minutes; on one thread.
// The whole tape twice: over batches of points, as it is always run (many points share what a row
// of a table costs, and its kernels are vectors), and point by point, which is what the
// literature's factors are of: each of the march's evaluations by itself, in a batch of one.
#include "bench/measure.h"

#include "backend-cpu/prune/pruning.h"
#include "backend-cpu/trace/march.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::bench {

namespace {

constexpr int picture_side = 1024;

// Evenly over a sphere (a Fibonacci lattice), about as wide as the gaps between them; in the order
// of its spiral, where each is blended with a neighbour, or in none.
std::string shell(int n, bool in_order) {
    return fmt::format(R"(smooth_union({0}) {{
  for i in 0..{1} {{
    let k = i * {4} % {1}
    let y = 1 - (2 * k + 1) / {1}
    let ring = sqrt(1 - y * y)
    let angle = 2.39996323 * k
    sphere({2} + {3} * (i % 20)).translate([ring * cos(angle), y, ring * sin(angle)])
  }}
}}
camera(at: [2, 1.6, 3], fov: 45deg)
)",
                       1 / std::sqrt(double(n)), n, 1 / std::sqrt(double(n)),
                       0.02 / std::sqrt(double(n)), in_order ? 1 : 6173);
}

// In no order, spread over the ground.
std::string field(int n) {
    return fmt::format(R"(for i in 0..{0} {{
  let u = fract(0.7548776662 * i)
  let v = fract(0.5698402910 * i)
  sphere(0.2 + 0.2 * fract(0.31 * i)).translate([{1} * (u - 0.5), sin({1} * 0.3 * u), {1} * (v - 0.5)])
}}
camera(at: [{2}, {2}, {2}], fov: 45deg)
)",
                       n, std::sqrt(double(n)), 0.6 * std::sqrt(double(n)));
}

std::vector<cpu::Ray> rays_of(const cpu::Stage &stage, int every) {
    std::vector<cpu::Ray> rays;
    // by tiles of 32, as pictures are drawn
    for (int tile = 0; tile < picture_side * picture_side / 1024; tile += every)
        for (int i = 0; i < 1024; ++i)
            rays.push_back(cpu::eye_ray(
                stage, static_cast<float>(tile % (picture_side / 32) * 32 + i % 32) + 0.5f,
                static_cast<float>(tile / (picture_side / 32) * 32 + i / 32) + 0.5f));
    return rays;
}

// Of one evaluation of the whole tape in a batch of one, at places that the scene's rays pass.
double seconds_a_point(const cpu::Stage &whole, const std::vector<cpu::Ray> &rays,
                       const std::vector<cpu::Landing> &landings) {
    cpu::Scratch scratch = cpu::make_scratch(whole.distance, whole.inputs);
    constexpr std::size_t count = 400;
    std::vector<std::array<float, 3>> places;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = i * rays.size() / count;
        const auto to = static_cast<float>(whole.view.focus);
        const float t = landings[k].t >= 0 ? landings[k].t : to;
        std::array<float, 3> place{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            place[axis] = rays[k].origin[axis] + t * rays[k].direction[axis];
        places.push_back(place);
    }
    float out = 0;
    float *to[] = {&out};
    const double begin = processor_seconds();
    for (const std::array<float, 3> &place : places) {
        const float *in[] = {&place[0], &place[1], &place[2]};
        cpu::evaluate(whole.distance, scratch, in, to, 1);
    }
    return (processor_seconds() - begin) / static_cast<double>(count);
}

void add(Table &table, const std::string &what, const std::string &text, int every, double goal) {
    const driver::Compilation made = compiled_text("pruning.sdf", text);
    if (!made.good()) {
        table.push_back({.what = what, .missing = complaint(made)});
        return;
    }
    const ir::View view = ir::view_of(made.scene, 0, 1);
    const cpu::Stage whole =
        cpu::prepare(made.scene, view, picture_side, picture_side, 0, cpu::Prune::Never);
    double pruned_seconds = 0, whole_seconds = 0;
    {
        const double begin = processor_seconds();
        const cpu::Stage pruned =
            cpu::prepare(made.scene, view, picture_side, picture_side, 0, cpu::Prune::Always);
        cpu::cast(pruned, rays_of(pruned, 1));
        pruned_seconds = processor_seconds() - begin;
    }
    const std::vector<cpu::Ray> sample = rays_of(whole, every);
    const double begin = processor_seconds();
    const std::vector<cpu::Landing> landings = cpu::cast(whole, sample);
    whole_seconds =
        (processor_seconds() - begin) * picture_side * picture_side / double(sample.size());
    double evaluations = 0;
    for (const cpu::Landing &landing : landings) evaluations += landing.steps;
    const double point_seconds = seconds_a_point(whole, sample, landings) * evaluations *
                                 picture_side * picture_side / double(sample.size());
    table.push_back({.what = what,
                     .value = 1 / pruned_seconds,
                     .unit = "pictures/s",
                     .baseline = "the whole tape, batches",
                     .baseline_value = 1 / whole_seconds});
    table.push_back({.what = what,
                     .value = 1 / pruned_seconds,
                     .unit = "pictures/s",
                     .baseline = "the whole tape, point by point",
                     .baseline_value = 1 / point_seconds,
                     .minimum = goal});
}

// What all pictures take: rays are made and marched to one sphere.
void add_floor(Table &table) {
    const driver::Compilation made =
        compiled_text("one.sdf", "sphere(1.03)\ncamera(at: [2, 1.6, 3], fov: 45deg)\n");
    if (!made.good()) {
        table.push_back({.what = "one sphere", .missing = complaint(made)});
        return;
    }
    const double begin = processor_seconds();
    const cpu::Stage stage = cpu::prepare(made.scene, ir::view_of(made.scene, 0, 1), picture_side,
                                          picture_side, 0, cpu::Prune::Never);
    cpu::cast(stage, rays_of(stage, 1));
    table.push_back({.what = "one sphere the size of the shells, without cells: the floor",
                     .value = 1 / (processor_seconds() - begin),
                     .unit = "pictures/s"});
}

// What cells about the surface keep of a scene's kernels, 64 along an axis.
void add_share(Table &table, const std::string &name) {
    const driver::Compilation made = compiled(name);
    if (!made.good()) {
        table.push_back({.what = name, .missing = complaint(made)});
        return;
    }
    const cpu::Inputs inputs = cpu::inputs_of(made.scene, 0);
    const cpu::Program program = cpu::compile(made.scene, made.scene.distance, cpu::Choices::Apart);
    double width = 0;
    cpu::Cube cube;
    for (std::size_t i = 0; i < 3; ++i)
        width = std::max(width, made.scene.bounds.hi[i] - made.scene.bounds.lo[i]);
    cube.side = static_cast<float>(width);
    for (std::size_t i = 0; i < 3; ++i)
        cube.lo[i] =
            static_cast<float>((made.scene.bounds.hi[i] + made.scene.bounds.lo[i] - width) / 2);
    cpu::PruneSettings settings;
    settings.depth = 3;
    settings.enough = 0;
    const cpu::Pruning pruning(program, inputs, cube, settings);
    cpu::CellEvaluator evaluator(pruning, inputs);
    std::vector<float> x, y, z, out, limits;
    const float step = cube.side / 64;
    for (int i = 0; i < 64 * 64 * 64; ++i) {
        x.push_back(cube.lo[0] + step * (static_cast<float>(i % 64) + 0.5f));
        y.push_back(cube.lo[1] + step * (static_cast<float>(i / 64 % 64) + 0.5f));
        z.push_back(cube.lo[2] + step * (static_cast<float>(i / 4096) + 0.5f));
    }
    out.resize(x.size());
    limits.assign(x.size(), 0);
    const float *in[] = {x.data(), y.data(), z.data()};
    float *to[] = {out.data()};
    cpu::evaluate(pruning, evaluator, in, to, x.size(), limits.data());
    const double left = evaluator.tally.kernels / double(evaluator.tally.near) / pruning.whole.cost;
    table.push_back({.what = name + ": kernels left in a cell near the surface, of 64^3",
                     .value = 100 * left,
                     .unit = "%",
                     .maximum = 11});
}

} // namespace

void measure_pruning(Table &table) {
    add_floor(table);
    add(table, "shell of 1,000 blended spheres in a spiral's order, rays from the eye",
        shell(1000, true), 17, 50);
    add(table, "the same in no order", shell(1000, false), 17, 50);
    add(table, "shell of 10,000 blended spheres in a spiral's order", shell(10000, true), 131, 100);
    add(table, "the same in no order", shell(10000, false), 131, 100);
    add(table, "100,000 spheres in no order", field(100000), 331, 100);
    add_share(table, "spheres_100.sdf");
    add_share(table, "colored_spheres_256.sdf");
}

} // namespace fathom::bench
