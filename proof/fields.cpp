// Fields of the user's own: their bounds over the region where they are evaluated, what is assumed
// of them, and the reports that say where and why there is none.
#include "ir/passes/operations.h"
#include "ir/passes/walk.h"
#include "proof/discontinuities.h"
#include "proof/ellipsoids.h"
#include "proof/inexact.h"
#include "proof/param_bounds.h"
#include "proof/prover.h"

#include "ir/lower/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <unordered_set>

namespace fathom::proof {

using ir::FieldKind;
using ir::NodeId;
using ir::Op;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;
using ir::rounding::infinity;

Diagnostic *Prover::report(ShapeId id, Code code, std::string message) {
    if (!place(id).reported) return nullptr;
    if (work.spent()) { // what was not proved might be with more of it
        if (!std::exchange(told_of_work, true)) report_limit(id);
        return nullptr; // for the caller's own words: they are of something else
    }
    return &diagnostics.add(code, scene.shapes[id].origin, std::move(message));
}

namespace {

// A product as a number times the rest.
struct Scaled {
    double by = 1;
    NodeId rest; // invalid: 1
};
// A factor may stand in both parts of another, again and again.
constexpr int max_depth_of_product = 12;

Scaled split(ir::Graph &graph, NodeId id, int depth = 0) {
    if (auto number = graph.as_number(id)) return {*number, {}};
    const ir::Node node = graph[id];
    if (depth > max_depth_of_product) return {1, id};
    if (node.type == ir::Type::Float && node.op == Op::Neg) {
        Scaled out = split(graph, graph.arg(id, 0), depth + 1);
        return {-out.by, out.rest};
    }
    if (node.type == ir::Type::Float && node.op == Op::Mul) {
        const Scaled a = split(graph, graph.arg(id, 0), depth + 1),
                     b = split(graph, graph.arg(id, 1), depth + 1);
        return {a.by * b.by, !a.rest ? b.rest : !b.rest ? a.rest : graph.mul(a.rest, b.rest)};
    }
    return {1, id};
}

} // namespace

// Fields that differ by a factor are analysed once.
FieldBound Prover::bound_once(NodeId field, const Place &here, bool own) {
    Budget budget;
    budget.instructions = options.field_instructions;
    if (own) budget.most = leaf_instructions;
    const Scaled parts = split(graph, field);
    const double by = std::fabs(parts.by);
    if (here.zone || !parts.rest || !(by > 0) || !std::isfinite(by))
        return bound_written(field, {to_cell(here.box), here.zone}, budget);
    const auto key = std::tuple(parts.rest, here.box.lo, here.box.hi);
    auto found = bounds.find(key);
    if (found == bounds.end())
        found = bounds.emplace(key, bound_written(parts.rest, {to_cell(here.box), nullptr}, budget))
                    .first;
    FieldBound out = found->second;
    out.lipschitz = ir::rounding::up(out.lipschitz * by, 4);
    out.sampled *= by * (1 - 1e-15);
    out.value = out.value * Interval(parts.by);
    out.value_a *= parts.by, out.value_b *= parts.by;
    return out;
}

Prover::Steepness Prover::by_params(ShapeId id, NodeId field, double whole) {
    const Place &here = place(id);
    ParamBound found;
    if (here.reported && !work.spent()) {
        Budget budget;
        budget.instructions = options.field_instructions;
        found = bound_by_params(flattening, ranges, field, {to_cell(here.box), here.zone}, budget,
                                whole);
    }
    const double most = std::min(whole, found.most);
    const NodeId number = graph.number(most);
    return {found.formula ? graph.make(Op::Min, {found.formula, number}) : number, most};
}

FieldBound Prover::bound(ShapeId id, NodeId field, const std::string &what, bool report_it) {
    const Place &here = place(id);
    FieldBound out;
    if (!here.reported) { // inside a body whose claims are taken
        out.lipschitz = 1;
        out.value = Interval::everything();
        return out;
    }
    out = bound_once(field, here, scene.shapes[id].kind == ShapeKind::Leaf);
    if (!std::isfinite(out.lipschitz) && report_it) report_field(id, out, what);
    return out;
}

std::optional<NodeId> Prover::expression(ShapeId id, int depth) {
    const Shape shape = scene.shapes[id];
    // What is proved in its own box alone is another field: joined with the way to the box.
    if (depth > 16 || of(id).fact.local) return {};
    auto inner = [&](std::size_t i) { return expression(shape.children[i], depth + 1); };
    switch (shape.kind) {
    case ShapeKind::Leaf: return shape.args[0];
    case ShapeKind::Library:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Contract: return inner(0);
    case ShapeKind::Complement:
        if (auto f = inner(0)) return graph.neg(*f);
        return {};
    case ShapeKind::Union:
    case ShapeKind::Intersection: {
        auto sum = inner(0);
        for (std::size_t i = 1; sum && i < shape.children.size(); ++i) {
            auto f = inner(i);
            if (!f) return {};
            sum = graph.make(shape.kind == ShapeKind::Union ? Op::Min : Op::Max, {*sum, *f});
        }
        return sum;
    }
    case ShapeKind::Map: {
        auto f = inner(0);
        if (!f) return {};
        NodeId point = graph.point(scene.shapes[shape.children[0]].dims == 2 ? ir::Type::Vec2
                                                                             : ir::Type::Vec3);
        return graph.mul(ir::substitute(graph, *f, {{point, shape.args[0]}}), shape.args[1]);
    }
    case ShapeKind::Offset:
    case ShapeKind::Displace:
        if (auto f = inner(0)) return graph.sub(*f, shape.args[0]);
        return {};
    case ShapeKind::Extrude: { // the distance to a corner in the plane of f(p.xy) and |z| - h
        auto f = inner(0);
        if (!f) return {};
        const NodeId p = graph.point();
        const NodeId flat = ir::substitute(
            graph, *f, {{graph.point(ir::Type::Vec2), graph.swizzle(p, std::array{0, 1})}});
        const NodeId half = graph.mul(shape.args[0], graph.number(0.5));
        const NodeId cap = graph.sub(graph.make(Op::Abs, {graph.component(p, 2)}), half);
        const NodeId zero = graph.number(0);
        const NodeId both = graph.make(Op::Make, ir::Type::Vec2, {flat, cap});
        const NodeId out = graph.make(
            Op::Length, {graph.make(Op::Max, {both, graph.constant({ir::Type::Vec2, {}})})});
        return graph.add(out, graph.make(Op::Min, {graph.make(Op::Max, {flat, cap}), zero}));
    }
    case ShapeKind::Empty:
    case ShapeKind::Xor:
    case ShapeKind::Blend:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Shell:
    case ShapeKind::Repeat:
    case ShapeKind::Within:
    case ShapeKind::Instances: break;
    }
    return {};
}

namespace {

std::string cause_text(std::optional<Op> cause, Trouble trouble = Trouble::None) {
    if (!cause) return "an operation";
    if (*cause == Op::Atan2 && trouble == Trouble::Jump)
        return "`atan(y, x)` where y is 0 and x below 0";
    if (const char *trouble = ir::info(*cause).trouble; *trouble) return trouble;
    std::string name(ir::info(*cause).name);
    for (char &c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return "`" + name + "`";
}

// Smooth at every point: what has no bound by one of these has outgrown all numbers.
bool only_grows(std::optional<Op> cause) {
    if (!cause) return false;
    constexpr ir::OpSet products{Op::Mul, Op::MatMul, Op::Dot, Op::Cross};
    const ir::OpInfo &op = ir::info(*cause);
    return products[*cause] || (op.function && *op.trouble == '\0');
}

} // namespace

namespace {

// Whether one of the nodes that these are made of is of a kind.
template <class Is>
bool holds(const ir::Graph &graph, const std::vector<NodeId> &roots, const Is &is) {
    std::vector<NodeId> todo = roots;
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        if (is(id, node.op)) return true;
        if (node.op == Op::Call)
            todo.push_back(graph.function(ir::FunctionId{node.payload}).result);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return false;
}

// … a list read at a place that follows from the point.
bool reads_list_by_point(const ir::Graph &graph, const std::vector<NodeId> &roots) {
    return holds(graph, roots, [&](NodeId id, Op op) {
        if (op != Op::TableRead) return false;
        const ir::Graph::Reads reads = graph.reads(graph.arg(id, 0));
        return reads.point || reads.free_vars;
    });
}

// … an `if` that only spares work, as bounding volumes do: one arm is the other one, and more.
bool spares_work(const ir::Graph &graph, const std::vector<NodeId> &roots) {
    constexpr ir::OpSet joins{Op::Min, Op::Select, Op::Call};
    return holds(graph, roots, [&](NodeId id, Op op) {
        if (op != Op::Select || graph[id].type == ir::Type::Vec3) return false;
        for (int arm : {1, 2}) {
            const NodeId other = graph.arg(id, 3 - arm);
            std::vector<NodeId> todo{graph.arg(id, arm)};
            for (std::size_t steps = 0; !todo.empty() && steps < 100; ++steps) {
                const NodeId at = todo.back();
                todo.pop_back();
                if (at == other) return !graph.is_constant(other);
                if (!joins[graph[at].op]) continue;
                todo.insert(todo.end(), graph.args(at).begin(), graph.args(at).end());
            }
        }
        return false;
    });
}

// … a function that leaves single precision where its argument is above 88.
bool raises_e(const ir::Graph &graph, const std::vector<NodeId> &roots) {
    constexpr ir::OpSet powers{Op::Exp, Op::Exp2, Op::Sinh, Op::Cosh};
    return holds(graph, roots, [&](NodeId, Op op) { return powers[op]; });
}

constexpr ir::OpSet told_of{Op::Floor, Op::Round, Op::Ceil, Op::Fract, Op::Mod, Op::Hash};

// What makes the sides of a border agree, by what turns there.
std::string way_to_meet(const std::optional<Op> &cause, bool by_list, bool spares) {
    if (by_list)
        return "go from one entry of a list to the next without a jump, with the place limited "
               "before `floor`: `let x = clamp(…, 0, last)`, then `mix(list[int(floor(x))], "
               "list[int(floor(x)) + 1], fract(x))`; ";
    if (spares && cause == Op::Select)
        return "leave the `if` out where it only spares work, since what is far off is skipped "
               "without it, ";
    if (!cause || !told_of[*cause]) return "make both sides agree there, ";
    if (*cause == Op::Hash)
        return "give `hash` the number of the cell by `floor` or `round`, as in `hash(floor(p))`: "
               "what is left of `p - q` is another number at each point for rounding; ";
    return "where copies differ from cell to cell keep the distance below the way to the next "
           "copy, as in `min(d, 0.2)`, or let `repeat` look at the neighbours: "
           "`.repeat([1, 0, 0], (s, id) => …)`; ";
}

// How it is written so that its continuity is seen.
std::string way_without_jump(const std::optional<Op> &cause) {
    if (cause == Op::Sign)
        return "`sign(x)` has a third value, 0 at 0: write `if x < 0 { -1 } else { 1 }`, or "
               "`abs(x) - c` for `x - c*sign(x)` whose own sign does not matter, ";
    return "write it with `min`, `max`, `clamp` or `abs`, whose continuity is known, ";
}

} // namespace

// The distance from an ellipsoid to first order, which is 0/0 in the middle.
bool Prover::report_ellipsoid(ShapeId id, const FieldBound &bound, const Blamed &blamed,
                              const std::string &what) {
    if (!bound.came_near || bound.each_side || !ellipsoid(graph, blamed.node)) return false;
    Diagnostic *d = report_at(id, blamed, Code::FieldSingular,
                              what + " jumps in an ellipsoid's middle, near " +
                                  point_text(bound.where, scene.shapes[id].dims));
    if (d)
        d->note("`k0 * (k0 - 1) / k1` is 0/0 there, and has another value from each side")
            .help("give its inside apart, as in `if k0 < 1 { (k0 - 1) * least } else { k0 * (k0 - "
                  "1) / k1 }` with the least radius, or take the library's `ellipsoid`");
    return true;
}

void Prover::report_field(ShapeId id, const FieldBound &b, const std::string &what) {
    int dims = scene.shapes[id].dims;
    const bool leaf = scene.shapes[id].kind == ShapeKind::Leaf;
    const bool has_region = leaf || what == "the map"; // an argument `within:`
    const std::string assume = leaf ? std::string("or ") + state_a_bound : "or limit it";
    if (b.too_large) {
        if (Diagnostic *d =
                report(id, Code::LipschitzUnbounded, what + " is too large to be analysed"))
            d->help("make its loops shorter, " + assume);
        return;
    }
    const Blamed blamed = blame(id, b);
    const bool divides = blamed.node && graph[blamed.node].op == Op::Div;
    std::string cause = divides ? cause_text(Op::Div) : cause_text(b.cause, b.trouble);
    if (divides && report_ellipsoid(id, b, blamed, what)) return;
    if (divides && report_division(id, b, blamed, what)) return;
    const bool endless = !place(id).box.finite() && !place(id).zone;
    const bool grows = !divides && (b.trouble == Trouble::None || b.trouble == Trouble::Overflow ||
                                    (b.trouble == Trouble::Singular && only_grows(b.cause)));
    if (b.at_infinity || (grows && endless)) {
        const bool jumps = b.trouble == Trouble::Jump;
        if (Diagnostic *d = report_at(
                id, blamed, Code::LipschitzUnbounded,
                jumps ? "it cannot be proved that " + what + " does not jump"
                      : what + " grows steeper without limit, as it is evaluated everywhere"))
            d->note(jumps ? cause + " jumps, and that both sides meet is not seen"
                          : "no bound on its slope holds for all points" +
                                (b.cause ? "; far from the origin " + cause + " has none" : ""))
                .help((jumps && b.cause && told_of[*b.cause] ? way_to_meet(b.cause, false, false)
                                                             : std::string()) +
                      (has_region ? "give it a region, as in `within: ball(3)`, "
                                  : "write `.within(…)` after it, as in `.within(ball(3))`, ") +
                      assume);
        return;
    }
    if (grows) {
        const bool leaves = b.trouble == Trouble::Overflow;
        const std::string near = " near " + point_text(b.where, dims);
        if (Diagnostic *d = report_at(id, blamed, Code::LipschitzUnbounded,
                                      what + (leaves ? " leaves what single precision holds" + near
                                                     : " is too steep to be bounded" + near)))
            d->note(leaves ? "a number is above 3.4e38 there, which counts as infinite, and what "
                             "is computed of it may be no number"
                           : "its numbers grow beyond all limits there")
                .help((leaves && raises_e(graph, scene.shapes[id].args)
                           ? "take `exp` of at most 80, as in `exp(min(u, 80))`, or let it fall: "
                             "`exp(u) / (1 + exp(u))` is `1 / (1 + exp(-u))`; "
                           : "") +
                      std::string("choose a smaller region or smaller numbers, ") + assume);
        return;
    }
    switch (b.trouble) {
    case Trouble::Jump: {
        const bool by_list = reads_list_by_point(graph, scene.shapes[id].args);
        const std::string meeting =
            way_to_meet(b.cause, by_list, spares_work(graph, scene.shapes[id].args));
        const auto [one_side, other_side] = two_points(b.side_a, b.side_b, dims);
        const auto [one, other] = two_numbers(b.value_a, b.value_b);
        const auto inexact = inexact_number(graph, scene.shapes[id].args);
        const std::string few_digits = inexact ? "write `" + std::string(inexact->exact) +
                                                     "` for " + inexact->written +
                                                     ", if that is meant: sides that meet by " +
                                                     inexact->digits + " differ by fewer digits; "
                                               : "";
        const std::string held =
            std::string(b.held_params ? ", with each param in the middle of its range" : "") +
            (b.held_time ? ", at time " + number_text(ranges.time.lo) : "");
        if (b.seen_jump) {
            if (Diagnostic *d = report_at(id, blamed, Code::FieldJump,
                                          what + " jumps near " + point_text(b.where, dims)))
                d->note("it is " + one + " at " + one_side + " and " + other + " at " + other_side +
                        held + ": " + cause)
                    .help(few_digits + meeting + "keep the jump out of the region with " +
                          (has_region ? "`within:`, " : "`.within(…)`, ") + assume);
        } else if (Diagnostic *d =
                       report_at(id, blamed, Code::LipschitzUnbounded,
                                 "it cannot be proved that " + what + " does not jump near " +
                                     point_text(b.where, dims)))
            d->note(cause + " chooses there" +
                    (b.known_sides ? "; its sides meet where they were tried (" +
                                         number_text(b.value_a) + " and " + number_text(b.value_b) +
                                         held + "), but that they meet everywhere is not seen"
                                   : ", and that its sides meet is not seen"))
                .help(few_digits +
                      (by_list || (b.cause && told_of[*b.cause]) ? meeting
                                                                 : way_without_jump(b.cause)) +
                      assume);
        return;
    }
    case Trouble::Overflow: // else told above
    case Trouble::Singular:
    case Trouble::None:
        if (const auto param = divides_by_0(id)) {
            if (Diagnostic *d = report_at(id, blamed, Code::FieldSingular,
                                          what + " is divided by `" + *param + "`, which may be 0"))
                d->help("begin its range above 0, as in `in 0.001..1`");
            return;
        }
        if (!b.came_near || b.each_side) {
            report_unplaced(id, b, blamed, what, cause);
            return;
        }
        if (Diagnostic *d = report_at(id, blamed, Code::FieldSingular,
                                      what + " is undefined or infinitely steep near " +
                                          point_text(b.where, dims)))
            d->note(cause + " happens there, and the field is evaluated in all of its region")
                .help(std::string(has_region
                                      ? "choose a region that avoids it, as in `within: ball(2) - "
                                        "tube(Y, 0.1)`, "
                                      : "keep it out with a region behind it, as in "
                                        "`.within(ball(2) - tube(Y, 0.1))`, ") +
                      "keep it off with `max(…, 0.1)` (a smaller number makes it steeper), " +
                      assume);
        return;
    }
}

Derived Prover::know_leaf(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k;
    k.fact.kind = FieldKind::Bound;
    k.fact.moment_arm = {infinity, infinity, infinity};
    if (shape.dims == 2) k.fact.bounds.lo[2] = k.fact.bounds.hi[2] = 0;
    if (const auto tape = tape_of(shape.args[0]); !tape->too_large)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::array<bool, 3> across{};
            across[axis] = true;
            k.fact.symmetric[axis] = reflected(*tape, across) == Reflected::Same;
        }
    if (shape.estimate > 0) {
        set_lipschitz(k, shape.estimate);
        k.fact.status = ir::ProofStatus::Estimated;
        k.fact.kind = FieldKind::Estimate;
        test_estimate(id, shape.args[0], k.fact.lipschitz_sup);
        return k;
    }
    std::optional<FieldBound> held_bound;
    if (shape.assumed > 0) {
        held_bound = holds_stated(id, shape.args[0], shape.assumed);
        if (!held_bound) {
            set_lipschitz(k, shape.assumed);
            k.fact.status = ir::ProofStatus::Assumed;
            return k;
        }
    }
    const FieldBound b = held_bound ? *held_bound : bound(id, shape.args[0], "this field");
    if (!std::isfinite(b.lipschitz)) {
        fail(k);
        return k;
    }
    const double sup = b.lipschitz * options.rules[Rule::Field];
    if (options.rules[Rule::Field] == 1) {
        const Steepness found = by_params(id, shape.args[0], sup);
        set_lipschitz(k, found.formula, found.sup);
    } else {
        set_lipschitz(k, sup);
    }
    k.leaf = shape.args[0];
    if (b.lipschitz == 0) set_lipschitz(k, 1); // a constant
    return k;
}

} // namespace fathom::proof
