// Cheap identities, applied as nodes are made. Each keeps the value for all finite arguments (x*0
// is 0, also for an infinite x: an infinity that survives to a product with 0 is no number that a
// scene means).
// Long: one function an identity, and the table that names them.
#include "ir/passes/simplify.h"

#include "ir/passes/exponential_ratios.h"

#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

namespace fathom::ir {
namespace {

// A node that is about to be made.
struct Made {
    Graph &graph;
    Op op;
    Type type;
    std::span<const NodeId> args;
    std::uint32_t payload;

    bool whole() const { return type == Type::Int; } // saturation forbids re-association
    Op op_of(std::size_t i) const { return graph[args[i]].op; }
    NodeId inside(std::size_t i) const { return graph.arg(args[i], 0); }
    // Whether an argument is a constant with this number in every component.
    bool is(std::size_t i, double value) const {
        if (!graph.is_constant(args[i])) return false;
        const Constant &constant = graph.constant_of(args[i]);
        for (int k = 0; k < components(constant.type); ++k)
            if (constant.value[static_cast<std::size_t>(k)] != value) return false;
        return true;
    }
    NodeId make(Op other, std::initializer_list<NodeId> of) const {
        return graph.make(other, type, of);
    }
    NodeId filled_with(double value) const {
        Constant constant{type, {}};
        for (int k = 0; k < components(type); ++k)
            constant.value[static_cast<std::size_t>(k)] = value;
        return graph.constant(constant);
    }
};

// A component of a vector-valued node, where it is known without computing.
NodeId part_of(Graph &graph, NodeId vector, int i) {
    const Node &node = graph[vector];
    if (node.op == Op::Make && !is_matrix(node.type)) return graph.arg(vector, i);
    if (node.op == Op::Splat && !is_matrix(node.type)) return graph.arg(vector, 0);
    return {};
}

NodeId simple_swizzle(Graph &graph, Type type, NodeId vector, std::uint32_t mask) {
    const int size = swizzle_size(mask);
    const Node node = graph[vector];
    bool identity = type == node.type;
    for (int i = 0; i < size; ++i) identity &= swizzle_component(mask, i) == i;
    if (identity) return vector;
    if (node.op == Op::Swizzle) {
        std::vector<int> parts;
        for (int i = 0; i < size; ++i)
            parts.push_back(swizzle_component(node.payload, swizzle_component(mask, i)));
        return graph.swizzle(graph.arg(vector, 0), parts);
    }
    const bool is_made = node.op == Op::Make || node.op == Op::Splat;
    if (size == 1 && !is_made && node.op != Op::Const)
        if (const auto part = graph.scalar_part(vector, swizzle_component(mask, 0))) return *part;
    if (!is_made) return {};
    std::vector<NodeId> parts;
    for (int i = 0; i < size; ++i)
        parts.push_back(part_of(graph, vector, swizzle_component(mask, i)));
    return size == 1 ? parts.front() : graph.make(Op::Make, type, parts);
}

// (v.x, v.y, v.z) is v; (s, s, s) is a splat.
NodeId simple_make(Graph &graph, Type type, std::span<const NodeId> args) {
    if (args.size() == 1) return args.front();
    if (is_matrix(type)) return {};
    bool equal = true, ordered = true;
    NodeId vector;
    std::vector<int> parts;
    for (NodeId arg : args) {
        equal &= arg == args.front();
        const Node &node = graph[arg];
        ordered &= node.op == Op::Swizzle && swizzle_size(node.payload) == 1;
        if (!ordered) continue;
        const NodeId from = graph.arg(arg, 0);
        ordered &= !vector || from == vector;
        vector = from;
        parts.push_back(swizzle_component(node.payload, 0));
    }
    if (ordered) return graph.swizzle(vector, parts);
    if (equal && !graph.is_constant(args.front()))
        return graph.make(Op::Splat, type, {args.front()});
    return {};
}

// sin(u)/u is 1 at 0, and not 0/0: u is taken no nearer to it than sin(u)/u is 1 in single
// precision.
NodeId sine_ratio(Graph &graph, NodeId u) {
    const Type type = graph[u].type;
    const NodeId minimum = graph.splat(graph.number(1e-3), type);
    if (graph[u].op == Op::Max && (graph.arg(u, 0) == minimum || graph.arg(u, 1) == minimum))
        return {};
    const NodeId off = graph.make(Op::Max, type, {graph.make(Op::Abs, type, {u}), minimum});
    return graph.make(Op::Div, type, {graph.make(Op::Sin, type, {off}), off});
}

// A number times something else; of a scalar.
struct Multiple {
    double by = 1;
    NodeId of;
};
Multiple multiple(const Graph &graph, NodeId id) {
    const Node &node = graph[id];
    if (node.type != Type::Float) return {1, id};
    if (node.op == Op::Neg) {
        const Multiple inner = multiple(graph, graph.arg(id, 0));
        return {-inner.by, inner.of};
    }
    if (node.op == Op::Mul)
        for (int i = 0; i < 2; ++i)
            if (const auto by = graph.as_number(graph.arg(id, i))) {
                const Multiple inner = multiple(graph, graph.arg(id, 1 - i));
                return {*by * inner.by, inner.of};
            }
    return {1, id};
}
// k sin(u)/v where v is a multiple of u.
NodeId scaled_sine_ratio(Graph &graph, NodeId above, NodeId below) {
    const Multiple sine = multiple(graph, above);
    if (graph[sine.of].op != Op::Sin || graph[sine.of].type != Type::Float) return {};
    const NodeId u = graph.arg(sine.of, 0);
    const Multiple mine = multiple(graph, u), other = multiple(graph, below);
    if (mine.of != other.of || mine.by == 0 || other.by == 0) return {};
    const NodeId ratio = sine_ratio(graph, u);
    return ratio ? graph.mul(graph.number(sine.by * mine.by / other.by), ratio) : NodeId{};
}

// A condition that holds, or fails, where x is no further from 0 than `within` alone.
struct NearZero {
    NodeId x;
    double within = 0;
    bool holds = true;
};
std::optional<NearZero> near_zero(const Graph &graph, NodeId condition) {
    const Node &node = graph[condition];
    if (node.op == Op::Not) {
        auto inner = near_zero(graph, graph.arg(condition, 0));
        if (inner) inner->holds = !inner->holds;
        return inner;
    }
    constexpr OpSet compares{Op::Equal, Op::NotEqual, Op::Less, Op::LessEqual};
    if (!compares[node.op]) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId x = graph.arg(condition, i);
        const auto number = graph.as_number(graph.arg(condition, 1 - i));
        if (!number || graph[x].type != Type::Float) continue;
        if (node.op == Op::Equal || node.op == Op::NotEqual)
            return *number == 0 ? std::optional(NearZero{x, 0, node.op == Op::Equal})
                                : std::nullopt;
        if (graph[x].op == Op::Abs) return NearZero{graph.arg(x, 0), *number, i == 0};
        if (multiple(graph, x).by > 0 && graph[multiple(graph, x).of].op == Op::Length)
            return NearZero{x, *number, i == 0};
    }
    return {};
}
// `if x == 0 { k } else { k sin(u)/u }`, u a multiple of x: the ratio is the k itself there.
NodeId sine_ratio_by_cases(Graph &graph, NodeId condition, NodeId yes, NodeId no) {
    const auto near = near_zero(graph, condition);
    if (!near) return {};
    const auto at_zero = graph.as_number(near->holds ? yes : no);
    const NodeId elsewhere = near->holds ? no : yes;
    const Multiple ratio = multiple(graph, elsewhere);
    if (!at_zero || graph[ratio.of].op != Op::Div) return {};
    const NodeId off = graph.arg(ratio.of, 1), sine = graph.arg(ratio.of, 0);
    if (graph[off].op != Op::Max || graph[sine].op != Op::Sin || graph.arg(sine, 0) != off)
        return {};
    constexpr double minimum = 1e-3, rounded = 1e-6;
    for (int i = 0; i < 2; ++i) {
        const NodeId size = graph.arg(off, i);
        const auto least = graph.as_number(graph.arg(off, 1 - i));
        if (!least || *least > minimum * (1 + rounded) || graph[size].op != Op::Abs) continue;
        const Multiple u = multiple(graph, graph.arg(size, 0)), x = multiple(graph, near->x);
        if (u.of != x.of || x.by == 0 ||
            near->within * std::abs(u.by / x.by) > minimum * (1 + rounded))
            continue;
        if (std::abs(*at_zero - ratio.by) <= rounded * std::abs(ratio.by)) return elsewhere;
    }
    return {};
}

bool exponents_of(const Graph &graph, NodeId sum, Op exponential, std::vector<NodeId> &out) {
    constexpr std::size_t most = 256; // a sum may stand in both parts of another, again and again
    if (graph[sum].op == exponential)
        out.push_back(graph.arg(sum, 0));
    else if (graph[sum].op != Op::Add || out.size() > most)
        return false;
    else
        return exponents_of(graph, graph.arg(sum, 0), exponential, out) &&
               exponents_of(graph, graph.arg(sum, 1), exponential, out);
    return true;
}
// log(exp(a) + exp(b) + …), two by two as max(a, b) + log(1 + exp(-|a - b|)): the exponentials of
// numbers beyond 88 have no place in single precision.
NodeId log_of_exponentials(Graph &graph, Op log, Type type, NodeId sum) {
    const Op exponential = log == Op::Log ? Op::Exp : Op::Exp2;
    std::vector<NodeId> terms;
    if (!exponents_of(graph, sum, exponential, terms)) return {};
    NodeId all = terms.front();
    const NodeId one = graph.splat(graph.number(1), type);
    for (std::size_t i = 1; i < terms.size(); ++i) {
        const NodeId way = graph.make(Op::Abs, type, {graph.sub(all, terms[i])});
        const NodeId rest = graph.make(exponential, type, {graph.neg(way)});
        all = graph.add({graph.make(Op::Max, type, {all, terms[i]}),
                         graph.make(log, type, {graph.add(one, rest)})});
    }
    return all;
}

bool is_identity(const Constant &matrix) {
    const int n = side(matrix.type);
    for (int c = 0; c < n; ++c)
        for (int r = 0; r < n; ++r)
            if (matrix.value[static_cast<std::size_t>(c * n + r)] != (c == r ? 1 : 0)) return false;
    return true;
}

NodeId simple_hit(const Made &n) {
    Graph &graph = n.graph;
    const Op op = n.op;
    const std::span<const NodeId> args = n.args;
    const NodeId hit = args.front();
    const Op made = graph[hit].op;
    if (op == Op::HitDistance) {
        if (made == Op::MakeHit) return graph.arg(hit, 0);
        if (made == Op::HitWith) return graph.arg(hit, 1);
        if (made == Op::FillPaint) return graph.make(Op::HitDistance, {graph.arg(hit, 0)});
        return {};
    }
    if (op == Op::HitPaint || op == Op::HitPoint || op == Op::HitExtra) {
        const int field = op == Op::HitPaint ? 1 : op == Op::HitPoint ? 2 : 3;
        if (made == Op::MakeHit) return graph.arg(hit, field);
        if (made == Op::HitWith) return graph.make(op, {graph.arg(hit, 0)});
        return {};
    }
    if (op == Op::HitWith) {
        if (made == Op::MakeHit)
            return graph.make(Op::MakeHit,
                              {args[1], graph.arg(hit, 1), graph.arg(hit, 2), graph.arg(hit, 3)});
        if (made == Op::HitWith) return graph.make(Op::HitWith, {graph.arg(hit, 0), args[1]});
        return {};
    }
    assert(op == Op::FillPaint);
    if (made != Op::MakeHit) return {};
    const std::optional<double> paint = graph.as_number(graph.arg(hit, 1));
    if (!paint) return {};
    if (*paint >= 0) return hit;
    return graph.make(Op::MakeHit, {graph.arg(hit, 0), args[1], args[2], args[3]});
}

// -- what a node simplifies to, by its op; none where it stays as it is

NodeId simple_neg(const Made &n) {
    return n.op_of(0) == Op::Neg && !n.whole() ? n.inside(0) : NodeId{};
}

NodeId simple_add(const Made &n) {
    if (n.is(0, 0)) return n.args[1];
    if (n.is(1, 0)) return n.args[0];
    if (n.op_of(1) == Op::Neg && !n.whole()) return n.make(Op::Sub, {n.args[0], n.inside(1)});
    if (n.op_of(0) == Op::Neg && !n.whole()) return n.make(Op::Sub, {n.args[1], n.inside(0)});
    return {};
}

NodeId simple_sub(const Made &n) {
    if (n.is(1, 0)) return n.args[0];
    if (n.args[0] == n.args[1]) return n.filled_with(0);
    if (n.is(0, 0)) return n.make(Op::Neg, {n.args[1]});
    if (n.op_of(1) == Op::Neg && !n.whole()) return n.make(Op::Add, {n.args[0], n.inside(1)});
    if (n.op_of(1) == Op::Floor && n.inside(1) == n.args[0]) return n.make(Op::Fract, {n.args[0]});
    return {};
}

// v by min(|v|, c)/|v|, c > 0, as v by c/max(|v|, c), which is a number where v is 0: `normalize(v) *
// min(length(v), c)`, `v / length(v) * clamp(length(v), 0, c)`.
NodeId shortened(const Made &n) {
    for (std::size_t i = 0; i < 2; ++i) {
        if (n.op_of(i) != Op::Splat) continue;
        const NodeId size = n.inside(i), unit = n.args[1 - i];
        const Node bounded = n.graph[size];
        const auto arg = [&](int k) { return n.graph.arg(size, k); };
        NodeId length;
        std::optional<double> most;
        if (bounded.op == Op::Min)
            for (int k = 0; k < 2; ++k)
                if (n.graph[arg(k)].op == Op::Length)
                    length = arg(k), most = n.graph.as_number(arg(1 - k));
        if (bounded.op == Op::Clamp && n.graph.as_number(arg(1)).value_or(1) <= 0)
            length = arg(0), most = n.graph.as_number(arg(2));
        if (!length || n.graph[length].op != Op::Length || !most || !(*most > 0)) continue;
        const NodeId v = n.graph.arg(length, 0);
        const Node of = n.graph[unit];
        const bool is_unit = of.op == Op::Normalize && n.graph.arg(unit, 0) == v,
                   divided = of.op == Op::Div && n.graph.arg(unit, 0) == v &&
                             n.graph[n.graph.arg(unit, 1)].op == Op::Splat &&
                             n.graph.arg(n.graph.arg(unit, 1), 0) == length;
        if (!is_unit && !divided) continue;
        const NodeId c = n.graph.number(*most);
        return n.graph.mul(v, n.graph.div(c, n.graph.make(Op::Max, {length, c})));
    }
    return {};
}

NodeId simple_mul(const Made &n) {
    if (n.is(0, 1) || n.is(1, 0)) return n.args[1];
    if (n.is(1, 1) || n.is(0, 0)) return n.args[0];
    if (n.is(0, -1)) return n.make(Op::Neg, {n.args[1]});
    if (n.is(1, -1)) return n.make(Op::Neg, {n.args[0]});
    return is_vector(n.type) ? shortened(n) : NodeId{};
}

NodeId simple_div(const Made &n) {
    if (n.is(1, 1)) return n.args[0];
    if (n.op_of(0) == Op::Sin && n.inside(0) == n.args[1]) return sine_ratio(n.graph, n.args[1]);
    if (const NodeId ratio = scaled_sine_ratio(n.graph, n.args[0], n.args[1])) return ratio;
    if (const NodeId ratio = exponential_ratio(n.graph, n.args[0], n.args[1])) return ratio;
    if (n.is(1, -1)) return n.make(Op::Neg, {n.args[0]});
    if (n.whole() || !n.graph.is_constant(n.args[1]) || n.graph.is_constant(n.args[0])) return {};
    // By a power of two exactly, else division stays: it rounds once.
    Constant inverse = n.graph.constant_of(n.args[1]);
    for (int i = 0; i < components(n.type); ++i) {
        double &value = inverse.value[static_cast<std::size_t>(i)];
        int exponent = 0;
        if (std::frexp(value, &exponent) != 0.5 || exponent <= -100 || exponent >= 100) return {};
        value = 1 / value;
    }
    return n.make(Op::Mul, {n.args[0], n.graph.constant(inverse)});
}

NodeId simple_log(const Made &n) { return log_of_exponentials(n.graph, n.op, n.type, n.args[0]); }

NodeId simple_pow(const Made &n) {
    const NodeId x = n.args[0];
    if (n.is(1, 1)) return x;
    if (n.is(1, 0)) return n.filled_with(1);
    if (n.is(1, 2)) return n.make(Op::Mul, {x, x});
    if (n.is(1, 3)) return n.make(Op::Mul, {n.make(Op::Mul, {x, x}), x});
    return {};
}

// Whatever its arguments are.
bool is_never_negative(const Graph &graph, NodeId id) {
    constexpr OpSet sizes{Op::Length, Op::Abs, Op::Exp, Op::Exp2, Op::Sqrt},
        products{Op::Dot, Op::Mul};
    const Node node = graph[id];
    if (const auto number = graph.as_number(id)) return *number >= 0;
    if (sizes[node.op]) return true;
    if (products[node.op] && graph.arg(id, 0) == graph.arg(id, 1)) return true;
    if (node.op == Op::Max)
        return is_never_negative(graph, graph.arg(id, 0)) ||
               is_never_negative(graph, graph.arg(id, 1));
    return node.op == Op::Add && is_never_negative(graph, graph.arg(id, 0)) &&
           is_never_negative(graph, graph.arg(id, 1));
}

// c/u of which no more than `most` is seen, c > 0, u >= 0, is c/max(u, c/most): the same number, and
// at u = 0, where a quotient has none, the most. Nothing where it is not of this form.
NodeId kept_off_zero(Graph &graph, NodeId id, double most) {
    const Node node = graph[id];
    if (node.type != Type::Float || node.count != 2) return {};
    const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
    if (node.op == Op::Div) {
        const auto c = graph.as_number(a);
        constexpr double smallest = 1e-30, largest = 1e30;
        if (!c || *c <= 0 || graph.is_constant(b) || !is_never_negative(graph, b)) return {};
        const double least = *c / most;
        if (!(least > smallest && least < largest)) return {};
        if (graph[b].op == Op::Max)
            for (int i = 0; i < 2; ++i)
                if (const auto limit = graph.as_number(graph.arg(b, i)); limit && *limit > 0)
                    return {};
        return graph.div(a, graph.make(Op::Max, {b, graph.number(least)}));
    }
    if (node.op != Op::Max && node.op != Op::Min) return {};
    for (int i = 0; i < 2; ++i) {
        if (!graph.is_constant(i == 0 ? b : a)) continue;
        if (const NodeId inner = kept_off_zero(graph, i == 0 ? a : b, most))
            return graph.make(node.op, {inner, i == 0 ? b : a});
    }
    return {};
}

NodeId simple_extremum(const Made &n) {
    if (n.args[0] == n.args[1]) return n.args[0];
    if (n.op != Op::Min || n.type != Type::Float) return {};
    for (std::size_t i = 0; i < 2; ++i)
        if (const auto most = n.graph.as_number(n.args[i]); most && *most > 0)
            if (const NodeId inner = kept_off_zero(n.graph, n.args[1 - i], *most))
                return n.make(Op::Min, {inner, n.args[i]});
    return {};
}

NodeId simple_clamp(const Made &n) {
    if (n.type != Type::Float) return {};
    const auto most = n.graph.as_number(n.args[2]);
    if (!most || *most <= 0) return {};
    const NodeId inner = kept_off_zero(n.graph, n.args[0], *most);
    return inner ? n.make(Op::Clamp, {inner, n.args[1], n.args[2]}) : NodeId{};
}

NodeId simple_abs(const Made &n) {
    if (n.op_of(0) == Op::Abs) return n.args[0];
    if (n.op_of(0) == Op::Neg && !n.whole()) return n.make(Op::Abs, {n.inside(0)});
    return {};
}

NodeId simple_mix(const Made &n) {
    if (n.is(2, 0)) return n.args[0];
    return n.is(2, 1) ? n.args[1] : NodeId{};
}

// x + c as x + (c - w) and w, w whole and c - w in 0..1: so that `floor(x)` and `fract(x - 1)` round
// one number, and never find themselves in different cells. Only where that is exact.
struct Shifted {
    NodeId x, whole;
};
std::optional<Shifted> shifted(const Made &n) {
    const Op op = n.op_of(0);
    if (n.whole() || (op != Op::Add && op != Op::Sub)) return {};
    const NodeId a = n.inside(0), b = n.graph.arg(n.args[0], 1);
    const bool first = op == Op::Add && n.graph.is_constant(a);
    if (!first && !n.graph.is_constant(b)) return {};
    Constant whole = n.graph.constant_of(first ? a : b), rest = whole;
    bool changes = false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(components(n.type)); ++i) {
        const double c = op == Op::Sub ? -whole.value[i] : whole.value[i];
        constexpr double exact = 1024, most = 1e6; // c in 1024ths
        if (!(std::abs(c) < most) || std::floor(c * exact) != c * exact) return {};
        whole.value[i] = std::floor(c), rest.value[i] = c - std::floor(c);
        changes = changes || whole.value[i] != 0;
    }
    if (!changes) return {};
    return Shifted{n.make(Op::Add, {first ? b : a, n.graph.constant(rest)}),
                   n.graph.constant(whole)};
}

NodeId simple_rounding(const Made &n) {
    constexpr OpSet rounds{Op::Floor, Op::Ceil, Op::Trunc, Op::Round};
    if (n.whole() || rounds[n.op_of(0)]) return n.args[0];
    if (n.op == Op::Trunc) return {};
    if (const auto sum = shifted(n)) return n.make(Op::Add, {n.make(n.op, {sum->x}), sum->whole});
    return {};
}

NodeId simple_fract(const Made &n) {
    const auto sum = shifted(n);
    return sum ? n.make(Op::Fract, {sum->x}) : NodeId{};
}

NodeId simple_and(const Made &n) {
    if (n.is(0, 1) || n.is(1, 0)) return n.args[1];
    return n.is(1, 1) || n.is(0, 0) || n.args[0] == n.args[1] ? n.args[0] : NodeId{};
}

NodeId simple_or(const Made &n) {
    if (n.is(0, 0) || n.is(1, 1)) return n.args[1];
    return n.is(1, 0) || n.is(0, 1) || n.args[0] == n.args[1] ? n.args[0] : NodeId{};
}

NodeId simple_select(const Made &n) {
    if (n.is(0, 1)) return n.args[1];
    if (n.is(0, 0)) return n.args[2];
    if (n.type == Type::Bool && n.is(1, 1) && n.is(2, 0)) return n.args[0];
    if (n.type == Type::Bool && n.is(1, 0) && n.is(2, 1)) return n.make(Op::Not, {n.args[0]});
    if (n.type == Type::Float)
        if (const NodeId ratio = sine_ratio_by_cases(n.graph, n.args[0], n.args[1], n.args[2]))
            return ratio;
    if (n.args[1] == n.args[2]) return n.args[1];
    const bool orders = n.op_of(0) == Op::Less || n.op_of(0) == Op::LessEqual;
    if (!orders || n.type != Type::Float) return {};
    const NodeId u = n.inside(0), v = n.graph.arg(n.args[0], 1);
    if (n.args[1] == u && n.args[2] == v) return n.make(Op::Min, {v, u});
    if (n.args[1] == v && n.args[2] == u) return n.make(Op::Max, {u, v});
    return {};
}

NodeId of_its_type(const Made &n) {
    return n.graph.type(n.args[0]) == n.type ? n.args[0] : NodeId{};
}

NodeId twice(const Made &n) { return n.op_of(0) == n.op ? n.inside(0) : NodeId{}; }

NodeId made_of_columns(const Made &n) {
    return n.op_of(0) == Op::Make ? n.graph.arg(n.args[0], static_cast<int>(n.payload)) : NodeId{};
}

NodeId simple_product(const Made &n) {
    for (std::size_t i = 0; i < 2; ++i)
        if (n.graph.is_constant(n.args[i]) && is_matrix(n.graph.type(n.args[i])) &&
            is_identity(n.graph.constant_of(n.args[i])))
            return n.args[1 - i];
    return {};
}

NodeId only_one(const Made &n) { return n.args.size() == 1 ? n.args[0] : NodeId{}; }

NodeId length_of_number(const Made &n) {
    return n.type == n.graph.type(n.args[0]) ? n.make(Op::Abs, {n.args[0]}) : NodeId{};
}

using Rule = NodeId (*)(const Made &);
constexpr OpTable<Rule> rules{
    {Op::Neg, simple_neg},
    {Op::Add, simple_add},
    {Op::Sub, simple_sub},
    {Op::Mul, simple_mul},
    {Op::Div, simple_div},
    {Op::Pow, simple_pow},
    {Op::Min, simple_extremum},
    {Op::Clamp, simple_clamp},
    {Op::Max, simple_extremum},
    {Op::Abs, simple_abs},
    {Op::Mix, simple_mix},
    {Op::Floor, simple_rounding},
    {Op::Ceil, simple_rounding},
    {Op::Trunc, simple_rounding},
    {Op::Round, simple_rounding},
    {Op::Fract, simple_fract},
    {Op::And, simple_and},
    {Op::Or, simple_or},
    {Op::Not, twice},
    {Op::Select, simple_select},
    {Op::ToFloat, of_its_type},
    {Op::ToInt, of_its_type},
    {Op::Splat, of_its_type},
    {Op::Make, [](const Made &n) { return simple_make(n.graph, n.type, n.args); }},
    {Op::Swizzle,
     [](const Made &n) { return simple_swizzle(n.graph, n.type, n.args[0], n.payload); }},
    {Op::Column, made_of_columns},
    {Op::MatMul, simple_product},
    {Op::Transpose, twice},
    {Op::Length, length_of_number},
    {Op::Log, simple_log},
    {Op::Log2, simple_log},
    {Op::LoopResult, [](const Made &n) { return n.payload == 0 ? n.args[0] : NodeId{}; }},
    {Op::Union, only_one},
    {Op::Intersection, only_one},
    {Op::NearestHit, only_one},
    {Op::FarthestHit, only_one},
    {Op::Blend, [](const Made &n) { return n.args.size() == 3 ? n.args[2] : NodeId{}; }},
    {Op::HitDistance, simple_hit},
    {Op::HitPaint, simple_hit},
    {Op::HitPoint, simple_hit},
    {Op::HitExtra, simple_hit},
    {Op::HitWith, simple_hit},
    {Op::FillPaint, simple_hit},
};

} // namespace

NodeId simplified(Graph &graph, Op op, Type type, std::span<const NodeId> args,
                  std::uint32_t payload) {
    const Rule rule = rules[op];
    return rule ? rule({graph, op, type, args, payload}) : NodeId{};
}

} // namespace fathom::ir
