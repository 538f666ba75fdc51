// How many steps a ray takes, against plain sphere tracing of the same scene, from the same eye,
// with one bound for all of it. Counted, not timed: the same on every machine.
//
// Plain: f the whole scene's raw field, L the largest bound that any part of it needs where rays
// go; a step is f/L, from the eye to the far side of the scene's bounding sphere; a hit where f/L
// is within the tolerance that our rays have too. (Where L is large it thus hits early, at
// silhouettes too: in its favour.) Our rays begin and end at the scene's box; what remains of the
// gain when plain tracing is given that box has rows of its own.
#include "bench/measure.h"

#include "backend-cpu/trace/march.h"
#include "ir/lower/lower.h"
#include "ir/view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>

namespace fathom::bench {

namespace {

constexpr int march_side = 256;

// The largest singular value of the shear that a twist by `rate` is at `radius` from its axis: of
// [[1, s], [0, 1]].
double twist_bound(double rate, double radius) {
    const double s = std::fabs(rate) * radius;
    return (s + std::sqrt(s * s + 4)) / 2;
}

// The largest bound of any part. A twist's is taken by its Jacobian out to `radius`, as far from
// the axis as rays start: that it can be less, by what the twisted shape is, is what this project
// proves.
double global_bound(const ir::Scene &scene, double radius) {
    double largest = 0;
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const ir::Shape &shape = scene.shapes[ir::ShapeId{i}];
        largest = std::max(largest, scene.facts[i].lipschitz_sup);
        if (shape.kind == ir::ShapeKind::Map && shape.map == ir::MapKind::Twist)
            largest =
                std::max(largest, twist_bound(ir::value_of(scene, shape.args[2], 0)[0], radius) *
                                      scene.facts[shape.children[0].index].lipschitz_sup);
    }
    return largest;
}

// The same scene with every part divided by `bound`, and without what else the proof gives: no
// range shells, no boxes.
ir::Scene plainly_lowered(ir::Scene scene, double bound) {
    const ir::NodeId number = scene.graph.number(bound);
    for (ir::ShapeFact &fact : scene.facts) {
        fact.lipschitz = number;
        fact.lipschitz_sup = bound;
        fact.outward = std::numeric_limits<double>::infinity();
        fact.local = fact.guard = false;
    }
    ir::lower(scene);
    return scene;
}

struct Count {
    std::uint64_t steps = 0, hits = 0;
    std::vector<float> hit; // by ray: how far away; below 0: it misses
};

struct Way {
    float begin = 0, end = 0; // of a ray; none where the end is before the begin
};

// Between the planes of the frame's box.
Way inside(const ir::Frame &frame, const cpu::Ray &ray, Way way) {
    for (std::size_t c = 0; c < 3; ++c) {
        const float by = std::fabs(ray.direction[c]) < 1e-20f ? 1e-20f : ray.direction[c];
        const float a = (float(frame.lo[c]) - ray.origin[c]) / by,
                    b = (float(frame.hi[c]) - ray.origin[c]) / by;
        way = {std::max(way.begin, std::min(a, b)), std::min(way.end, std::max(a, b))};
    }
    return way;
}

Count trace_plainly(const ir::Scene &scene, const cpu::Stage &from, bool boxed) {
    const ir::Frame &frame = from.frame;
    const auto far =
        static_cast<float>(glm::distance(frame.center, from.view.origin) + frame.radius);
    const cpu::Program distance = cpu::compile(scene, scene.distance);
    cpu::Scratch scratch = cpu::make_scratch(distance, from.inputs);
    std::vector<cpu::Ray> rays;
    for (int y = 0; y < march_side; ++y)
        for (int x = 0; x < march_side; ++x)
            rays.push_back(cpu::eye_ray(from, float(x) + 0.5f, float(y) + 0.5f));
    std::vector<float> t, ends, points[3], d(rays.size());
    for (auto &coordinate : points) coordinate.resize(rays.size());
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Way way = boxed ? inside(frame, rays[i], {0, far}) : Way{0, far};
        t.push_back(way.begin);
        ends.push_back(way.end);
        if (way.begin <= way.end) active.push_back(i);
    }
    Count count;
    count.hit.assign(rays.size(), -1);
    for (int step = 0; step < ir::budget_of(scene) && !active.empty(); ++step) {
        for (std::size_t k = 0; k < active.size(); ++k)
            for (std::size_t c = 0; c < 3; ++c)
                points[c][k] =
                    rays[active[k]].origin[c] + t[active[k]] * rays[active[k]].direction[c];
        const float *in[] = {points[0].data(), points[1].data(), points[2].data()};
        float *out[] = {d.data()};
        cpu::evaluate(distance, scratch, in, out, active.size());
        count.steps += active.size();
        std::size_t kept = 0;
        for (std::size_t k = 0; k < active.size(); ++k) {
            const std::size_t ray = active[k];
            if (d[k] <=
                static_cast<float>(frame.tolerance_base + frame.tolerance_slope * double(t[ray]))) {
                ++count.hits;
                count.hit[ray] = t[ray];
                continue;
            }
            t[ray] += d[k];
            if (t[ray] <= ends[ray]) active[kept++] = ray;
        }
        active.resize(kept);
    }
    return count;
}

void compare(Table &table, const std::string &what, const std::string &file, double maximum) {
    const driver::Compilation compilation = compiled(file);
    if (!compilation.good()) {
        table.push_back({.what = what, .missing = complaint(compilation)});
        return;
    }
    const ir::Scene &scene = compilation.scene;
    const cpu::Stage stage =
        cpu::prepare(scene, ir::view_of(scene, 0, 1), march_side, march_side, 0);
    cpu::PictureOptions options;
    options.mode = cpu::PictureMode::Steps; // rays from the eye alone, without shading
    const cpu::Work work = cpu::render(stage, options).work;

    const double bound = global_bound(scene, glm::length(stage.view.origin));
    const ir::Scene divided = plainly_lowered(scene, bound);
    const Count plain = trace_plainly(divided, stage, false),
                boxed = trace_plainly(divided, stage, true);
    char global[64];
    std::snprintf(global, sizeof global, "plain tracing, L = %.3g", bound);
    auto row = [&](const std::string &of, double ours, const char *unit, const std::string &to,
                   double theirs, double goal) {
        constexpr double rays = double(march_side) * march_side;
        table.push_back({.what = of,
                         .value = ours / rays,
                         .unit = unit,
                         .baseline = to,
                         .baseline_value = theirs / rays,
                         .maximum = goal});
    };
    const std::string in_the_box = std::string(global) + ", in the box";
    row("steps a ray: " + what, double(work.steps), "steps", global, double(plain.steps), maximum);
    double proved = 0;
    for (const ir::ShapeFact &fact : scene.facts) proved = std::max(proved, fact.lipschitz_sup);
    if (proved < bound) {
        char moment[64];
        std::snprintf(moment, sizeof moment, "plain tracing, L = %.3g", proved);
        row("  which has the largest proved bound", double(work.steps), "steps", moment,
            double(trace_plainly(plainly_lowered(scene, proved), stage, false).steps), 0);
    }
    row("  which has the box too", double(work.steps), "steps", in_the_box, double(boxed.steps), 0);
    // Where a field was divided by a bound, points near the surface need the gradient too.
    row("  every evaluation counted", double(work.evaluations), "evaluations", in_the_box,
        double(boxed.steps), 0);
    row("  rays that hit", 100 * double(work.hits), "%", global, 100 * double(plain.hits), 0);
}

// Against the one constant that someone would find who tries: the least by which plain tracing,
// begun and ended at the scene's box, goes past no surface that a march at a tenth of the step
// finds, up to two rays in a thousand. (Hitting too early is in its favour.)
void compare_with_trial(Table &table, const std::string &what, const std::string &file) {
    const driver::Compilation compilation = compiled(file);
    if (!compilation.good()) {
        table.push_back({.what = what, .missing = complaint(compilation)});
        return;
    }
    const ir::Scene &scene = compilation.scene;
    const cpu::Stage stage =
        cpu::prepare(scene, ir::view_of(scene, 0, 1), march_side, march_side, 0);
    cpu::PictureOptions options;
    options.mode = cpu::PictureMode::Steps;
    const cpu::Work work = cpu::render(stage, options).work;
    double bound = 1;
    for (const ir::ShapeFact &fact : scene.facts) bound = std::max(bound, fact.lipschitz_sup);
    std::vector<cpu::Ray> rays;
    for (int y = 0; y < march_side; ++y)
        for (int x = 0; x < march_side; ++x)
            rays.push_back(cpu::eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f));
    const std::vector<cpu::Landing> truth = cpu::cast(stage, rays, true);
    constexpr float near = 0.005f; // of the distance
    Count best;
    double found = bound;
    for (double by = bound; by > 0.3; by *= 0.93) {
        Count count = trace_plainly(plainly_lowered(scene, by), stage, true);
        int lost = 0;
        for (std::size_t i = 0; i < truth.size(); ++i)
            lost += truth[i].t >= 0 && (count.hit[i] < 0 || count.hit[i] > truth[i].t * (1 + near));
        if (lost * 500 > march_side * march_side) break;
        best = std::move(count), found = by;
    }
    char constant[64];
    std::snprintf(constant, sizeof constant, "the best constant by trial, %.3g", found);
    constexpr double all = double(march_side) * march_side;
    table.push_back({.what = "steps a ray: " + what + ", nothing tuned",
                     .value = double(work.steps) / all,
                     .unit = "steps",
                     .baseline = constant,
                     .baseline_value = double(best.steps) / all,
                     .maximum = 1.25});
}

} // namespace

void measure_steps(Table &table) {
    compare(table, "100-sphere smooth union", "spheres_100.sdf", 0.80);
    compare(table, "Menger sponge, 4 levels", "menger_4.sdf", 0.73);
    compare(table, "sphere displaced by 4 octaves", "fbm_sphere.sdf", 0.38);
    compare(table, "twisted box", "twisted_box.sdf", 0.10);
    compare_with_trial(table, "twisted box", "twisted_box.sdf");
    compare_with_trial(table, "tapered box and cylinder", "tapered_box.sdf");
    compare_with_trial(table, "sphere displaced by 4 octaves", "fbm_sphere.sdf");
}

} // namespace fathom::bench
