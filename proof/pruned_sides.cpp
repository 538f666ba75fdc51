// What is decided by ranges. What stands still between steps is decided where it is certain; what
// moves also where both sides of a comparison may be equal at an end of their ranges: a choice by it
// is proved to be continuous on its own (docs/lipschitz.md, 2.32).
#include "proof/pruned_sides.h"

#include "proof/cases.h"
#include "proof/exact.h"
#include "proof/polynomials.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

void PrunedSides::enter(const Assumed &given) {
    given_ = given;
    known_.clear();
    notes_.found.clear();
    for (const auto &[id, range] : given.within) notes_.found[id] = range;
}

NodeId PrunedSides::of(NodeId id) {
    if (const auto is = given_.is.find(id); is != given_.is.end()) return is->second;
    if (const auto it = known_.find(id); it != known_.end()) return it->second;
    work_.take(1);
    const NodeId out = work_.spent() ? id : pruned(id);
    return known_[id] = out;
}

NodeId PrunedSides::pruned(NodeId id) {
    const ir::Node node = graph_[id];
    if (const auto rounded = notes_.rounded.find(id); rounded != notes_.rounded.end())
        return of(formed(NodeId(rounded->second)));
    if (node.count == 0 || halved(id) || tells_apart[node.op]) return id;
    std::vector<NodeId> args;
    bool changed = false;
    for (NodeId arg : std::vector<NodeId>(graph_.args(id).begin(), graph_.args(id).end())) {
        args.push_back(node.op == Op::LoopResult ? loop_of_others(arg) : of(arg));
        changed = changed || args.back() != arg;
    }
    if (const auto is = decided(node, args)) return *is;
    return changed ? formed(graph_.make(node.op, node.type, args, node.payload)) : id;
}

// A Loop stands for its first value; its other values are not what that is.
NodeId PrunedSides::loop_of_others(NodeId loop) {
    const ir::Node node = graph_[loop];
    std::vector<NodeId> args;
    for (NodeId arg : std::vector<NodeId>(graph_.args(loop).begin(), graph_.args(loop).end()))
        args.push_back(of(arg));
    return graph_.make(node.op, node.type, args, node.payload);
}

NodeId PrunedSides::formed(NodeId made) {
    const ir::Type type = graph_[made].type;
    if (type == ir::Type::Float) {
        const NodeId form = without_rounding(graph_, made, &work_);
        notes_.keep(form, made);
        return form;
    }
    if (!ir::is_vector(type)) return made;
    std::vector<NodeId> parts;
    for (int i = 0; i < ir::components(type); ++i) {
        const NodeId part = component_of(graph_, made, i);
        if (graph_[part].op == Op::Swizzle && graph_.arg(part, 0) == made) return made;
        parts.push_back(formed(part));
    }
    return graph_.make(Op::Make, type, parts);
}

bool PrunedSides::moves(NodeId id) const {
    if (graph_.reads(id).point) return true;
    return graph_.reads(id).free_vars && std::ranges::any_of(graph_.free_vars(id), [&](NodeId var) {
               return graph_[var].type != ir::Type::Int;
           });
}

std::optional<Interval> PrunedSides::halved(NodeId id) const {
    if (const auto it = given_.within.find(id); it != given_.within.end()) return it->second;
    const auto it = notes_.given.find(id);
    return it != notes_.given.end() && it->second.finite() ? std::optional(it->second)
                                                           : std::nullopt;
}

double PrunedSides::rounding_of(NodeId id) const {
    constexpr double lost = 1e-13;
    return lost * std::max(ranges_.size_of_terms(id), 1e-3);
}

std::optional<NodeId> PrunedSides::decided(const ir::Node &node, const std::vector<NodeId> &args) {
    const auto truth = [&](NodeId id) -> std::optional<bool> {
        if (!graph_.is_constant(id)) return {};
        return graph_.constant_of(id).value[0] != 0;
    };
    if (node.op == Op::Select) {
        if (const auto is = truth(args[0])) return args[*is ? 1 : 2];
        return args[1] == args[2] ? std::optional(args[1]) : std::nullopt;
    }
    if (node.op == Op::Not) {
        const auto is = truth(args[0]);
        return is ? std::optional(graph_.boolean(!*is)) : std::nullopt;
    }
    if (node.op == Op::And || node.op == Op::Or) {
        const bool ends = node.op == Op::Or; // what says all of it
        for (const int i : {0, 1})
            if (const auto is = truth(args[std::size_t(i)]))
                return *is == ends ? args[std::size_t(i)] : args[std::size_t(1 - i)];
        return {};
    }
    if (node.op == Op::Swizzle && node.type == ir::Type::Float)
        return formed(component_of(graph_, args[0], ir::swizzle_component(node.payload, 0)));
    if (node.type == ir::Type::Bool) return compared(node, args);
    if (node.type != ir::Type::Float) return {};
    if (node.op == Op::Length) {
        NodeId sum = graph_.number(0);
        for (int i = 0; i < ir::components(graph_[args[0]].type); ++i) {
            const NodeId part = component_of(graph_, args[0], i);
            sum = graph_.add(sum, graph_.mul(part, part));
        }
        const NodeId below = formed(sum);
        if (const auto is = root(below)) return is;
        return formed(graph_.make(Op::Sqrt, {below}));
    }
    return by_range(node, args);
}

std::optional<NodeId> PrunedSides::compared(const ir::Node &node, const std::vector<NodeId> &args) {
    const bool strict = node.op == Op::Less;
    if ((!strict && node.op != Op::LessEqual) || graph_[args[0]].type != ir::Type::Float) return {};
    const NodeId gap = formed(graph_.sub(args[0], args[1]));
    const Interval range = ranges_.of(gap);
    if (!moves(gap)) { // as single precision has it
        const double lost = lost_of_single(args[0], args[1]);
        if (range.hi < -lost) return graph_.boolean(true);
        if (range.lo > lost) return graph_.boolean(false);
        return {};
    }
    const double rounding = rounding_of(gap);
    if (range.hi < 0 || (range.hi <= rounding && !strict)) return graph_.boolean(true);
    if (range.lo > 0 || (range.lo >= -rounding && strict)) return graph_.boolean(false);
    if (range.hi <= rounding && ranges_.is_0_at_ends_alone(formed(graph_.neg(gap)), rounding))
        return graph_.boolean(true);
    if (range.lo >= -rounding && ranges_.is_0_at_ends_alone(gap, rounding))
        return graph_.boolean(false);
    return {};
}

double PrunedSides::lost_of_single(NodeId a, NodeId b) {
    constexpr double lost = 0x1p-20;
    const Interval x = ranges_.of(a), y = ranges_.of(b);
    const double size = std::max({x.magnitude(), y.magnitude(), 1.0});
    return std::isfinite(size) ? lost * size : ir::rounding::infinity;
}

std::optional<NodeId> PrunedSides::by_range(const ir::Node &node, const std::vector<NodeId> &args) {
    const auto number = [&](std::optional<double> x) {
        return x ? std::optional(graph_.number(*x)) : std::nullopt;
    };
    if (node.op == Op::Min || node.op == Op::Max)
        return ranges_.outermost(node.op, args[0], args[1]);
    if (node.op == Op::Clamp) {
        const Interval x = ranges_.of(args[0]);
        if (x.lo >= ranges_.of(args[1]).hi && x.hi <= ranges_.of(args[2]).lo) return args[0];
        return ranges_.beyond(args[0], args[1], args[2]);
    }
    if (node.op == Op::Smoothstep) return number(ranges_.faded(args[0], args[1], args[2]));
    if (node.op == Op::Mix) {
        const auto t = graph_.as_number(args[2]);
        return t && (*t == 0 || *t == 1) ? std::optional(args[*t == 0 ? 0 : 1]) : std::nullopt;
    }
    if (node.op == Op::Abs) return size(args[0]);
    if (node.op == Op::Sqrt) return root(args[0]);
    if (node.op == Op::Sign) return number(sign_of(args[0], -1, false));
    if (node.op == Op::Step) return number(sign_of(formed(graph_.sub(args[1], args[0])), 0, true));
    if (node.op == Op::Sin || node.op == Op::Cos)
        if (const auto angle = graph_.as_number(args[0]))
            return number(of_quarter_turns(node.op == Op::Cos, *angle));
    return {};
}

// 1 of what is above 0, `below` of what is below, where that is certain.
std::optional<double> PrunedSides::sign_of(NodeId x, double below, bool at_0) {
    const Interval range = ranges_.of(x);
    if (!moves(x)) {
        const double lost = lost_of_single(x, x);
        if (range.lo > lost) return 1.0;
        if (range.hi < -lost) return below;
        return {};
    }
    if (range.lo > 0 || (range.lo == 0 && (at_0 || ranges_.is_0_at_ends_alone(x, 0)))) return 1.0;
    if (range.hi < 0 || (range.hi == 0 && ranges_.is_0_at_ends_alone(formed(graph_.neg(x)), 0)))
        return below;
    return {};
}

std::optional<NodeId> PrunedSides::size(NodeId of) {
    const Interval range = ranges_.of(of);
    const double rounding = rounding_of(of);
    if (range.lo >= -rounding) return of;
    if (range.hi <= rounding) return formed(graph_.neg(of));
    return {};
}

// Of a square s^2 it is |s|.
std::optional<NodeId> PrunedSides::root(NodeId of) {
    const auto square = polynomial(graph_, of, &work_);
    if (!square) return {};
    Sum sum;
    for (const auto &[m, c] : *square) {
        Product product;
        for (NodeId factor : m) product.push_back(factor.index);
        if (c != 0) sum[product] += c;
    }
    const auto found = root_of_square(sum);
    if (!found) return {};
    NodeId out = graph_.number(0);
    for (const auto &[product, c] : *found) {
        NodeId term = graph_.number(c);
        for (std::uint32_t factor : product) term = graph_.mul(term, NodeId{factor});
        out = graph_.add(out, term);
    }
    const NodeId of_square = formed(out);
    const auto is = size(of_square);
    return is ? is : formed(graph_.make(Op::Abs, {of_square}));
}

} // namespace fathom::proof
