// Errors of a whole scene: where rays go, and what follows where they are large.
#include "proof/rounding.h"

#include "base/single.h"
#include "ir/lower/lower.h"
#include "ir/view.h"
#include "proof/prover.h"

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

// Nodes, never time: for cutting up a region; and for all regions, from which on few points are tried.
constexpr std::size_t cutting_work = 6'000, all_work = 100'000;
constexpr int samples = 12, few_samples = 4, height = 1080;

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
// One moment and one number for each param: an end of its range, or one inside.
Inputs some_inputs(const Inputs &all, Dice &dice) {
    const auto one = [&](Interval x) -> Interval {
        const double at = dice.next();
        if (x.is_point() || !x.finite()) return x;
        return at < 0.3 ? x.hi : at < 0.5 ? x.lo : x.lo + x.width() * dice.next();
    };
    Inputs out{one(all.time), all.params};
    for (auto &param : out.params)
        for (Interval &x : param) x = one(x);
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

// The errors at some points, from the least on; of each the bound is nearly attained.
std::vector<double> errors_at_points(RoundingMachine &machine, const Cell &box,
                                     const Inputs &inputs) {
    Dice dice{0x0f10a7};
    std::vector<double> out;
    for (int k = 0; k < (machine.work() < all_work ? samples : few_samples); ++k) {
        Cell at;
        for (std::size_t i = 0; i < 3; ++i)
            at.p[i] = to_single(box.p[i].lo + box.p[i].width() * dice.next());
        const Inputs one = some_inputs(inputs, dice);
        out.push_back(machine.error(at, one.time, one.params));
    }
    std::sort(out.begin(), out.end());
    return out;
}
// The largest, where most points have a number.
double typical(const std::vector<double> &errors) {
    if (std::isinf(errors[errors.size() / 2])) return infinity;
    double most = 0;
    for (double e : errors)
        if (!std::isinf(e)) most = e;
    return most;
}

// The shape that the error comes from: from the top down as long as one child has half of it.
ShapeId culprit(const ir::Scene &scene, const Cell &box, const Inputs &inputs) {
    ir::Scene copy = scene;
    const auto error_of = [&](ShapeId shape) {
        copy.root = shape;
        copy.top_level = {{shape, {}}};
        ir::lower(copy);
        RoundingMachine machine(copy, copy.distance);
        return typical(errors_at_points(machine, box, inputs));
    };
    ShapeId at = scene.root;
    double error = error_of(at);
    for (;;) {
        const ir::Shape shape = scene.shapes[at];
        ShapeId worst;
        double most = 0;
        if (shape.kind != ShapeKind::Library)
            for (ShapeId child : shape.children) {
                if (scene.shapes[child].dims != 3) continue;
                const double e = error_of(child);
                if (!worst || e > most) worst = child, most = e;
            }
        if (!worst || most < error / 2) return at;
        at = worst, error = most;
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
    wrap(scene.distance, false);
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
    double bound = 0, seen = 0;
    const std::vector<Asked> regions = regions_of(scene);
    const Asked *worst = nullptr;
    bool all = true;
    for (const Asked &asked : regions) {
        const double e = bound_in(machine, asked, inputs);
        bound = std::max(bound, e);
        if (e <= asked.tolerance) continue;
        all = false;
        const double at_points = typical(errors_at_points(machine, asked.box, inputs));
        if (at_points > asked.tolerance && at_points > seen) seen = at_points, worst = &asked;
    }
    scene.rounding = {all, 0};
    const auto trust = [&](const char *says, Span at) {
        if (!scene.rounding.bounded) scene.axioms.push_back({ir::Axiom::Kind::Rounding, says, at});
    };
    constexpr const char *says = "single precision: errors are within the tolerance";
    if (!worst) return trust(says, scene.top_level.empty() ? Span{} : scene.top_level[0].span);
    const ir::Frame frame = ir::frame_of(scene, ir::view_of(scene, 0, 1), height);
    const ShapeId place = culprit(scene, worst->box, inputs);
    const std::string name = operation_name(scene, place);
    const std::string help =
        "keep large numbers out: say with `render(time: …)` for how long the scene is looked at, "
        "leave out large offsets and factors, put shapes near the origin";
    if (seen > frame.radius) {
        diagnostics
            .add(Code::NumberRange, scene.shapes[place].origin,
                 std::isinf(seen) ? name + " has numbers that single precision does not hold"
                                  : name + " is wrong by up to " + number_text(seen) +
                                        " in single precision, which is more than the scene")
            .note("the scene is computed in single precision, of 7 digits, by graphics cards")
            .help(help);
        return;
    }
    const double by = bound <= 4 * seen ? bound : 2 * seen;
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
