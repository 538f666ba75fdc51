#include "proof/homogeneous.h"

#include "ir/passes/inline.h"
#include "proof/inner_vectors.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace fathom::proof {
namespace {

using ir::Graph;

// Of a value v with v(k p) = k^d v(p) for all k > 0: d. Zero has every degree.
struct Degree {
    enum class Kind : std::uint8_t { Zero, Known, None };
    Kind kind = Kind::None;
    double of = 0;
    bool is(double d) const { return kind == Kind::Known && of == d; }
    bool is_flat() const { return kind == Kind::Zero || is(0); }
    bool is_none() const { return kind == Kind::None; }
    friend bool operator==(const Degree &, const Degree &) = default;

    static Degree zero() { return {Kind::Zero, 0}; }
    static Degree none() { return {Kind::None, 0}; }
    static Degree known(double d) { return {Kind::Known, d}; }
    static Degree flat_if(bool is_flat) { return is_flat ? known(0) : none(); }
    // Of what is a sum, an extreme or a choice of both.
    static Degree of_both(const Degree &a, const Degree &b) {
        if (a.kind == Kind::Zero) return b;
        if (b.kind == Kind::Zero) return a;
        return a == b ? a : none();
    }
    static Degree of_product(const Degree &a, const Degree &b) {
        if (a.is_none() || b.is_none()) return none();
        if (a.kind == Kind::Zero || b.kind == Kind::Zero) return zero();
        return known(a.of + b.of);
    }
    Degree power(double by) const {
        if (kind == Kind::Zero) return by > 0 ? zero() : none();
        return kind == Kind::Known ? known(of * by) : none();
    }
};

constexpr ir::OpSet as_its_argument{Op::Neg,    Op::Abs,    Op::Splat,    Op::Swizzle,
                                    Op::Column, Op::Length, Op::Transpose},
    of_equals{Op::Add,   Op::Sub,  Op::Mod,   Op::Min,         Op::Max,
              Op::Clamp, Op::Make, Op::Union, Op::Intersection},
    of_products{Op::Mul, Op::Dot, Op::Cross, Op::MatMul},
    flat_of_equals{Op::Step, Op::Atan2,     Op::Sign,  Op::Normalize, Op::Smoothstep,
                   Op::Less, Op::LessEqual, Op::Equal, Op::NotEqual};

constexpr int turns_until_stays = 4; // of a loop, as to the degrees of what it carries

// Degrees by node; all components of a value together, but those of vectors that are made of
// others, which are looked through.
class Degrees {
  public:
    explicit Degrees(const Graph &graph) : graph_(graph) {}

    Degree of(NodeId id) {
        if (!id) return Degree::known(0);
        if (const auto it = known_.find(id); it != known_.end()) return it->second;
        if (++looked_ > max_nodes_composed) return Degree::none();
        const Degree found = found_of(id);
        return known_[id] = found;
    }

  private:
    Degree found_of(NodeId id) {
        const ir::Node node = graph_[id];
        if (node.op == Op::Const) return is_zero(id) ? Degree::zero() : Degree::known(0);
        if (node.op == Op::Point) return Degree::known(1);
        if (!graph_.reads(id).point && !graph_.reads(id).free_vars) return Degree::known(0);
        if (node.op == Op::Loop) return of_loop(id, 0);
        if (node.op == Op::LoopResult) return of_loop(graph_.arg(id, 0), node.payload);
        const auto arg = [&](int i) { return of(graph_.arg(id, i)); };
        if (as_its_argument[node.op]) return arg(0);
        if (of_equals[node.op]) return of_equal(id);
        if (of_products[node.op]) return Degree::of_product(arg(0), arg(1));
        if (flat_of_equals[node.op]) return Degree::flat_if(!of_equal(id).is_none());
        if (node.op == Op::Div) return Degree::of_product(arg(0), arg(1).power(-1));
        if (node.op == Op::Sqrt) return arg(0).power(0.5);
        if (node.op == Op::InverseSqrt) return arg(0).power(-0.5);
        if (node.op == Op::Pow) return of_power(id);
        if (node.op == Op::Mix)
            return arg(2).is_flat() ? Degree::of_both(arg(0), arg(1)) : Degree::none();
        if (node.op == Op::Select)
            return arg(0).is_flat() ? Degree::of_both(arg(1), arg(2)) : Degree::none();
        // Any other of numbers that are the same all along a ray is one.
        const auto args = graph_.args(id);
        return Degree::flat_if(!args.empty() && std::ranges::all_of(args, [&](NodeId arg) {
            return of(arg).is_flat();
        }));
    }
    bool is_zero(NodeId id) const {
        const ir::Constant c = graph_.constant_of(id);
        const auto end = c.value.begin() + ir::components(c.type);
        return std::all_of(c.value.begin(), end, [](double x) { return x == 0; });
    }
    Degree of_equal(NodeId id) {
        Degree out = Degree::zero();
        for (const NodeId arg : graph_.args(id)) out = Degree::of_both(out, of(arg));
        return out;
    }
    Degree of_power(NodeId id) {
        const Degree base = of(graph_.arg(id, 0));
        const NodeId exponent = graph_.arg(id, 1);
        if (base.is(0)) return Degree::flat_if(of(exponent).is_flat());
        if (const auto by = one_number(exponent)) return base.power(*by);
        return Degree::none();
    }
    std::optional<double> one_number(NodeId id) const {
        if (graph_[id].op == Op::Splat) return graph_.as_number(graph_.arg(id, 0));
        if (!graph_.is_constant(id)) return {};
        const ir::Constant c = graph_.constant_of(id);
        for (int i = 1; i < ir::components(c.type); ++i)
            if (c.value[std::size_t(i)] != c.value[0]) return {};
        return c.value[0];
    }

    // With the degrees that its values have before and after each turn.
    Degree of_loop(NodeId id, std::uint32_t result) {
        const auto loops = loops_.find(id);
        if (loops != loops_.end()) return loops->second[result];
        const ir::Loop loop = graph_.loop(ir::LoopId{graph_[id].payload});
        std::vector<Degree> carried;
        for (const NodeId arg : graph_.args(id)) carried.push_back(of(arg));
        const auto before = known_;
        const auto loops_before = loops_;
        bool stays = false;
        for (int turn = 0; turn < turns_until_stays && !stays; ++turn) {
            known_ = before, loops_ = loops_before; // what is in the body hangs on what is carried
            known_[loop.index] = Degree::known(0);
            for (std::size_t i = 0; i < loop.vars.size(); ++i) known_[loop.vars[i]] = carried[i];
            stays = true;
            for (std::size_t i = 0; i < loop.vars.size(); ++i) {
                const Degree next = Degree::of_both(carried[i], of(loop.next[i]));
                stays = stays && next == carried[i];
                carried[i] = next;
            }
        }
        const bool runs_alike = of(loop.count).is_flat() && of(loop.condition).is_flat();
        known_ = before, loops_ = loops_before;
        if (!stays || !runs_alike) std::ranges::fill(carried, Degree::none());
        return loops_.emplace(id, carried).first->second[result];
    }

    const Graph &graph_;
    std::unordered_map<NodeId, Degree> known_;
    std::unordered_map<NodeId, std::vector<Degree>> loops_;
    std::size_t looked_ = 0;
};

constexpr double thickness = 1e-7;     // of the faces
constexpr double near_on_faces = 1.02; // a bound over the slope seen, at which to stop

// The part of space in which one coordinate is `sign`, or a little further out, and no other is more.
Cell face(int axis, double sign, const std::array<bool, 3> &reads) {
    Cell out;
    for (std::size_t i = 0; i < 3; ++i)
        if (reads[i]) out.p[i] = Interval(-1 - thickness, 1 + thickness);
    const Interval far(1, 1 + thickness);
    out.p[std::size_t(axis)] = sign < 0 ? -far : far;
    return out;
}

// Is it a number at the origin, and are its values of single precision where rays go?
bool holds_numbers(const Tape &tape, const Ranges &ranges) {
    constexpr double small = 1e-30;
    Machine machine(tape, ranges);
    const auto about = [](double reach) { return Interval(-reach, reach); };
    machine.run({{about(small), about(small), about(small)}});
    if (!machine.value(0).finite()) return false;
    machine.run({{about(in_reach), about(in_reach), about(in_reach)}});
    return !machine.leaves_single(true);
}

} // namespace

bool is_homogeneous(const Graph &graph, NodeId field) {
    const auto is_still = [&](NodeId id) { return !graph.reads(id).point; };
    while (true) { // what is added last
        const ir::Node node = graph[field];
        if (node.op == Op::Neg)
            field = graph.arg(field, 0);
        else if ((node.op != Op::Add && node.op != Op::Sub))
            break;
        else if (is_still(graph.arg(field, 1)))
            field = graph.arg(field, 0);
        else if (is_still(graph.arg(field, 0)))
            field = graph.arg(field, 1);
        else
            break;
    }
    return graph.reads(field).point && Degrees(graph).of(field).is(1);
}

std::optional<double> bound_along_rays(Flattening &context, const Ranges &ranges, NodeId field,
                                       const Budget &budget, double known, double seen) {
    const ir::WithoutCalls written = ir::without_calls(context.graph, field, max_nodes_composed);
    if (!written.all || !is_homogeneous(context.graph, written.root)) return {};
    const Tape tape = flatten(context, field);
    if (tape.too_large || !holds_numbers(tape, ranges)) return {};
    const Periods periods = periods_of(tape, context.graph);
    const bool is_even = reflected(tape, {true, true, true}) != Reflected::Unknown;
    Budget own = budget;
    own.levels = 0;
    own.tolerance = near_on_faces;
    own.most = 0;
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!periods.reads[std::size_t(axis)]) continue;
        for (const double sign : {1.0, -1.0}) {
            if (sign < 0 && is_even) continue;
            own.enough = std::max({budget.enough, most, seen * near_on_faces});
            const Domain domain{face(axis, sign, periods.reads), nullptr};
            most = std::max(most, bound_field(context, ranges, field, domain, own).lipschitz);
            if (!(most < known)) return {};
        }
    }
    return most;
}

} // namespace fathom::proof
