// Errors of a whole scene: where rays go, and what follows where they are large.
#include "proof/rounding.h"

#include "base/single.h"
#include "ir/lower/lower.h"
#include "ir/view.h"
#include "proof/prover.h"
#include "proof/trials.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;
using ir::ShapeId;
using ir::ShapeKind;
using ir::rounding::infinity;

namespace {

// Nodes, never time: for cutting up a region, and for trying points of it.
constexpr std::size_t cutting_work = 6'000, trial_work = 30'000;
constexpr int height = 1080;
constexpr std::ptrdiff_t tried_regions = 3; // the last 16 times as large as what is looked at

// A box of space, and the tolerance with which rays arrive there.
struct Asked {
    Cell box;
    double tolerance = 0;
};

// Where rays go: the scene's box, or cubes about the camera, each four times the one in it.
std::vector<Asked> regions_of(const ir::Scene &scene) {
    const ir::View view = ir::view_of(scene, 0, 1);
    const ir::Frame frame = ir::frame_of(scene, view, height);
    const auto tolerance = [&](double t) {
        return frame.tolerance_base + frame.tolerance_slope * t;
    };
    const double near = view.focus / 4; // what lies nearer than that is not looked at
    std::vector<Asked> out;
    if (frame.boxed) {
        double squares = 0;
        Cell box;
        for (std::size_t i = 0; i < 3; ++i) {
            box.p[i] = {frame.lo[i], frame.hi[i]};
            const double out_by =
                std::max({0.0, frame.lo[i] - view.origin[i], view.origin[i] - frame.hi[i]});
            squares += out_by * out_by;
        }
        return {{box, tolerance(std::max(std::sqrt(squares), near))}};
    }
    const double far = std::min(frame.far, 100 * view.focus);
    for (double half = 4 * near;; half *= 4) {
        Cell box;
        for (std::size_t i = 0; i < 3; ++i)
            box.p[i] = Interval(view.origin[i] - half, view.origin[i] + half);
        out.push_back({box, tolerance(std::max(half / 4, near))});
        if (half >= far) return out;
    }
}

struct Inputs {
    Interval time;
    std::vector<std::array<Interval, 4>> params;
};
Inputs all_inputs(const ir::Scene &scene, const std::optional<Interval> &times) {
    Inputs out{times.value_or(Interval(0, scene.render.time_end)), {}};
    for (const ir::Param &param : scene.params) {
        std::array<Interval, 4> all;
        for (std::size_t i = 0; i < 4; ++i)
            all[i] = times || (!param.has_range && param.type != ir::Type::Bool)
                         ? Interval(to_single(param.value[i]))
                     : param.has_range ? Interval(param.lo[i], param.hi[i])
                                       : Interval(0, 1);
        out.params.push_back(all);
    }
    return out;
}
// A bound of the error in the box, no better than `enough` or the work allow.
double bound_in(RoundingMachine &machine, const Asked &asked, const Inputs &inputs) {
    using Candidate = std::pair<double, std::size_t>;
    std::priority_queue<Candidate> queue;
    std::vector<Cell> cells;
    const auto push = [&](const Cell &cell) {
        queue.emplace(machine.error(cell, inputs.time, inputs.params), cells.size());
        cells.push_back(cell);
    };
    const std::size_t before = machine.work();
    push(asked.box);
    while (queue.top().first > asked.tolerance && machine.work() - before < cutting_work) {
        const Cell cell = cells[queue.top().second];
        queue.pop();
        std::size_t axis = 0;
        for (std::size_t i = 1; i < 3; ++i)
            if (cell.p[i].width() > cell.p[axis].width()) axis = i;
        Cell left = cell, right = cell;
        left.p[axis].hi = right.p[axis].lo = cell.p[axis].middle();
        push(left);
        push(right);
    }
    return queue.top().first;
}

// -- trials

// One moment and one number for each param.
struct Moment {
    double time = 0;
    std::vector<std::array<double, 4>> params;
};
// The last ones, what the params are now at the last moment, and any.
enum class Which { Last, Now, Any };
constexpr Which moments[] = {Which::Last, Which::Now, Which::Any};

Moment moment_of(const ir::Scene &scene, const Inputs &all, Which which, Dice &dice) {
    const auto one = [&](Interval x, double now) {
        if (!x.finite()) return now;
        switch (which) {
        case Which::Last: return x.hi;
        case Which::Now: return x.contains(now) ? now : x.hi;
        case Which::Any: return x.lo + x.width() * dice.next();
        }
        return now;
    };
    Moment out{one(all.time, all.time.hi), {}};
    for (std::size_t i = 0; i < all.params.size(); ++i) {
        auto &values = out.params.emplace_back();
        for (std::size_t c = 0; c < 4; ++c) {
            values[c] = one(all.params[i][c], scene.params[i].value[c]);
            if (scene.params[i].type == ir::Type::Int || scene.params[i].type == ir::Type::Bool)
                values[c] = std::floor(values[c]);
        }
    }
    return out;
}

// What is seen where rays arrive. Each ray counts once, with its largest error near a surface.
struct SeenByRays {
    double error = 0;       // the largest number; 0 where fewer than three rays are wrong
    bool useless = false;   // most rays are wrong, and by a good part of the scene
    bool no_number = false; // a quarter of the rays meet an infinity that is not meant
};

// The error that a ray meets near a surface; nothing where it meets none. From anywhere in the box,
// towards anywhere or, `aimed`, towards the surface next to it.
std::optional<double> error_of_ray(Trials &trials, const Asked &asked, const Moment &now,
                                   double scene_size, bool aimed, Dice &dice) {
    constexpr int steps = 16;
    std::array<double, 3> p{}, way{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval &x = asked.box.p[i];
        p[i] = to_single(x.lo + x.width() * dice.next());
        way[i] = x.lo + x.width() * dice.next() - p[i];
    }
    if (aimed) { // towards the surface next to it
        const double at_p = trials.at(p, now.time, now.params).meant;
        for (std::size_t i = 0; i < 3; ++i) {
            std::array<double, 3> q = p;
            q[i] += 1e-3 * scene_size;
            way[i] = (at_p - trials.at(q, now.time, now.params).meant) * (at_p < 0 ? -1 : 1);
        }
    }
    const double length = std::hypot(way[0], way[1], way[2]);
    if (!(length > 0)) return {};
    std::optional<double> error;
    for (int step = 0; step < steps; ++step) {
        for (double &x : p) x = to_single(x);
        const Trial trial = trials.at(p, now.time, now.params);
        const double by = std::fabs(trial.meant);
        if (!(by < 1e3 * scene_size)) break;
        if (by < 0.05 * scene_size) error = std::max(error.value_or(0), trial.error());
        if (by < asked.tolerance) break;
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] += by * way[i] / length;
            inside = inside && asked.box.p[i].contains(p[i]);
        }
        if (!inside) break;
    }
    return error;
}

SeenByRays look(const ir::Scene &scene, const Asked &asked, const Inputs &inputs, double scene_size,
                std::size_t work) {
    constexpr int most_rays = 240, enough = 96, few = 6;
    Trials trials(scene, scene.distance);
    Dice dice{0x0f10a7};
    std::vector<double> errors;
    for (int ray = 0; ray < most_rays && errors.size() < enough && trials.work() < work; ++ray) {
        const Moment now = moment_of(scene, inputs, moments[ray % std::size(moments)], dice);
        if (const auto e = error_of_ray(trials, asked, now, scene_size, ray % 2 == 1, dice))
            errors.push_back(*e);
    }
    SeenByRays out;
    const std::size_t n = errors.size();
    if (n < few) return out; // too few to say
    std::sort(errors.begin(), errors.end());
    if (errors[n - 3] <= asked.tolerance) return out;
    for (double e : errors)
        if (std::isfinite(e)) out.error = e;
    out.no_number = std::isinf(errors[n * 3 / 4]);
    out.useless =
        out.no_number || (errors[n / 2] > asked.tolerance && 4 * errors[n - 3] > scene_size);
    return out;
}

// The shape that the error comes from: from the top down as long as one child has half of it.
ShapeId culprit(const ir::Scene &scene, const Asked &asked, const Inputs &inputs, double error,
                double scene_size) {
    constexpr std::size_t looked_at = 40; // children in all: each is lowered again
    std::size_t looks = 0;
    ir::Scene copy = scene;
    for (ShapeId at = scene.root;;) {
        const ir::Shape shape = scene.shapes[at];
        // What a repetition gives its copies has no value outside of it.
        if (shape.kind == ShapeKind::Library || shape.kind == ShapeKind::Repeat ||
            shape.kind == ShapeKind::Instances)
            return at;
        ShapeId worst;
        double most = 0;
        for (ShapeId child : shape.children) {
            if (scene.shapes[child].dims != 3 || ++looks > looked_at) continue;
            copy.root = child;
            copy.top_level = {{child, {}}};
            ir::lower(copy);
            const SeenByRays seen = look(copy, asked, inputs, scene_size, trial_work);
            const double e = seen.no_number ? infinity : seen.error;
            if (e > most) worst = child, most = e;
        }
        if (!worst || most < error / 2) return at;
        at = worst;
    }
}

// The same functions, with all distances less by that.
void lower_distances(ir::Scene &scene, double by) {
    ir::Graph &graph = scene.graph;
    const auto wrap = [&](ir::FunctionId &id, bool is_hit) {
        if (!id) return;
        const ir::Function function = graph.function(id);
        const NodeId p = graph.fresh_var(ir::Type::Vec3), whole = graph.call(id, std::array{p});
        const NodeId less =
            graph.sub(is_hit ? graph.make(Op::HitDistance, {whole}) : whole, graph.number(by));
        id = graph.add_function({function.name + "_less_rounding",
                                 {},
                                 {p},
                                 is_hit ? graph.make(Op::HitWith, {whole, less}) : less});
    };
    const bool same = scene.shaded == scene.distance;
    wrap(scene.distance, false);
    if (same)
        scene.shaded = scene.distance;
    else
        wrap(scene.shaded, false);
    wrap(scene.hit, true);
    wrap(scene.endless, false);
    wrap(scene.endless_hit, true);
    scene.safe_radius = {}; // curvature knows nothing of errors
}

} // namespace

void bound_rounding(ir::Scene &scene, Diagnostics &diagnostics,
                    const std::optional<Interval> &times) {
    scene.rounding = {};
    const Inputs inputs = all_inputs(scene, times);
    RoundingMachine machine(scene, scene.distance);
    const ir::Frame frame = ir::frame_of(scene, ir::view_of(scene, 0, 1), height);
    double bound = 0;
    SeenByRays seen;
    const std::vector<Asked> regions = regions_of(scene);
    const Asked *worst = nullptr;
    bool all = true;
    for (const Asked &asked : regions) {
        const double e = bound_in(machine, asked, inputs);
        bound = std::max(bound, e);
        if (e <= asked.tolerance) continue;
        all = false;
        // What is wrong far away alone is no reason to lower what is near.
        if (&asked - regions.data() >= tried_regions) continue;
        const SeenByRays here = look(scene, asked, inputs, frame.radius,
                                     regions.size() == 1 ? trial_work : trial_work / tried_regions);
        if (seen.useless ? !here.useless : !here.useless && here.error <= seen.error) continue;
        seen = here, worst = &asked;
    }
    scene.rounding = {all, 0};
    const auto trust = [&](const char *says, Span at) {
        if (!scene.rounding.bounded) scene.axioms.push_back({ir::Axiom::Kind::Rounding, says, at});
    };
    constexpr const char *says = "single precision: errors are within the tolerance";
    if (!worst) return trust(says, scene.top_level.empty() ? Span{} : scene.top_level[0].span);
    const ShapeId place = culprit(scene, *worst, inputs, seen.error, frame.radius);
    const std::string name = operation_name(scene, place);
    const std::string help =
        "keep large numbers out: say with `render(time: …)` for how long the scene is looked at, "
        "leave out large offsets and factors, put shapes near the origin";
    if (seen.useless) {
        diagnostics
            .add(Code::NumberRange, scene.shapes[place].origin,
                 seen.no_number ? name + " has numbers that single precision does not hold"
                                : name + " is wrong by up to " + number_text(seen.error) +
                                      " in single precision, which is more than the scene")
            .note("the scene is computed in single precision, of 7 digits, by graphics cards")
            .help(help);
        return;
    }
    const double by = bound <= 4 * seen.error ? bound : 2 * seen.error;
    scene.rounding = {by == bound, by};
    trust("single precision: errors are within what distances are less by",
          scene.shapes[place].origin);
    diagnostics
        .add(Code::Imprecise, scene.shapes[place].origin,
             name + " is wrong by up to " + number_text(by) + " in single precision")
        .note("a pixel shows " + number_text(worst->tolerance) +
              " there; rays stop that much earlier, so that none passes a surface")
        .help(help);
    lower_distances(scene, by);
}

} // namespace fathom::proof
