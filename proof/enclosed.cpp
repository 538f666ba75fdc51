#include "proof/enclosed.h"

#include "proof/machine.h"

#include <numbers>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;

Interval Enclosed::of(NodeId id, int i) {
    constexpr int max_depth = 200;
    if (const auto it = known_.find({id, i}); it != known_.end()) return it->second;
    if (depth_ > max_depth || left_ <= 0) return Interval::everything();
    --left_;
    ++depth_;
    Interval out = found(id, i);
    --depth_;
    if (std::isnan(out.lo) || std::isnan(out.hi)) out = Interval::everything();
    return known_[{id, i}] = out;
}

// The root of the sum of its numbers' squares.
double Enclosed::size_of(NodeId matrix) {
    double squares = 0;
    const auto take = [&](double size) { squares += size * size; };
    if (graph_.is_constant(matrix)) {
        for (int n = 0; n < ir::components(graph_[matrix].type); ++n)
            take(graph_.constant_of(matrix).value[static_cast<std::size_t>(n)]);
    } else if (graph_[matrix].op == Op::Make) {
        for (const NodeId part : graph_.args(matrix)) take(of_vector(part).magnitude());
    } else {
        return ir::rounding::infinity;
    }
    return std::sqrt(squares);
}

// Its length.
Interval Enclosed::of_vector(NodeId id) {
    Interval sum;
    for (int k = 0; k < ir::components(graph_[id].type); ++k) sum += square(of(id, k));
    return sqrt(sum);
}

namespace {

// Functions of one number, by component.
using Function = Interval (*)(Interval);
constexpr ir::OpTable<Function> of_one{
    {Op::Neg, [](Interval a) { return -a; }},
    {Op::Abs, [](Interval a) { return abs(a); }},
    {Op::Sqrt, [](Interval a) { return sqrt(a); }},
    {Op::Exp, [](Interval a) { return exp(a); }},
    {Op::Exp2, [](Interval a) { return exp2(a); }},
    {Op::Sin, [](Interval a) { return sin(a); }},
    {Op::Cos, [](Interval a) { return cos(a); }},
    {Op::Asin, [](Interval a) { return asin(a); }},
    {Op::Acos, [](Interval a) { return acos(a); }},
    {Op::Atan, [](Interval a) { return atan(a); }},
    {Op::Sinh, [](Interval a) { return sinh(a); }},
    {Op::Cosh, [](Interval a) { return cosh(a); }},
    {Op::Tanh, [](Interval a) { return tanh(a); }},
    {Op::Floor, [](Interval a) { return a + Interval(-1, 1); }},
    {Op::Ceil, [](Interval a) { return a + Interval(-1, 1); }},
    {Op::Round, [](Interval a) { return a + Interval(-1, 1); }},
    {Op::Trunc, [](Interval a) { return a + Interval(-1, 1); }},
    {Op::Sign, [](Interval) { return Interval(-1, 1); }},
    {Op::Fract, [](Interval) { return Interval(0, 1); }},
};
// Whatever their arguments are.
constexpr ir::OpTable<Interval> range_of_any{
    {Op::Step, {0, 1}},
    {Op::Hash, {0, 1}},
    {Op::Smoothstep, {0, 1}},
    {Op::Normalize, {-1, 1}},
    {Op::Atan2, {-std::numbers::pi, std::numbers::pi}},
};

} // namespace

Interval Enclosed::of_two(const Op op, const Interval &a, const Interval &b) {
    if (op == Op::Add) return a + b;
    if (op == Op::Sub) return a - b;
    if (op == Op::Mul) return a * b;
    if (op == Op::Div) return b.contains(0) ? Interval::everything() : a / b;
    if (op == Op::Min) return min(a, b);
    if (op == Op::Max) return max(a, b);
    if (op == Op::Mod) return Interval(-b.magnitude(), b.magnitude());
    if (op != Op::Pow || b.lo < 0) return Interval::everything();
    if (b.is_point() && std::floor(b.lo) == b.lo) return ir::whole_power(a, b.lo);
    return hull(0.0, ir::positive_power(a, b));
}

Interval Enclosed::found(NodeId id, int i) {
    const ir::Node node = graph_[id];
    const auto k = static_cast<std::size_t>(i);
    if (graph_.is_constant(id)) return graph_.constant_of(id).value[k];
    const bool whole_division = node.op == Op::Div && node.type == ir::Type::Int;
    if (ir::is_matrix(node.type) || whole_division) return Interval::everything();
    const auto arg = [&](int n) { return graph_.arg(id, n); };
    const auto part = [&](int n) { return of(arg(n), i); };
    if (of_one.names(node.op)) return of_one[node.op](part(0));
    if (range_of_any.names(node.op)) return range_of_any[node.op];
    if (node.op == Op::Point && k < 3) return box_[k];
    if (node.op == Op::Param && ranges_) return ranges_->params[node.payload][k];
    if (node.op == Op::Time && ranges_) return ranges_->time;
    if (node.op == Op::Mul && arg(0) == arg(1)) return square(part(0));
    constexpr ir::OpSet of_both{Op::Add, Op::Sub, Op::Mul, Op::Div,
                                Op::Min, Op::Max, Op::Mod, Op::Pow};
    if (of_both[node.op]) return of_two(node.op, part(0), part(1));
    if (node.op == Op::Clamp) return min(max(part(0), part(1)), part(2));
    if (node.op == Op::Mix) {
        const Interval a = part(0), b = part(1), t = part(2);
        return t.lo >= 0 && t.hi <= 1 ? hull(a, b) : a + t * (b - a);
    }
    if (node.op == Op::Select) return hull(part(1), part(2));
    if (node.op == Op::ToFloat)
        return graph_[arg(0)].type == ir::Type::Bool ? Interval(0, 1) : of(arg(0), i);
    if (node.op == Op::Splat) return of(arg(0));
    if (node.op == Op::Make) return of(arg(i));
    if (node.op == Op::Swizzle) return of(arg(0), ir::swizzle_component(node.payload, i));
    if (node.op == Op::Dot) {
        Interval sum;
        for (int n = 0; n < ir::components(graph_[arg(0)].type); ++n)
            sum += arg(0) == arg(1) ? square(of(arg(0), n)) : of(arg(0), n) * of(arg(1), n);
        return sum;
    }
    if (node.op == Op::Length) return of_vector(arg(0));
    if (node.op == Op::MatMul && ir::is_vector(node.type)) {
        const bool left = ir::is_matrix(graph_[arg(0)].type);
        const double most = size_of(arg(left ? 0 : 1)) * of_vector(arg(left ? 1 : 0)).magnitude();
        return {-most, most};
    }
    return Interval::everything();
}

} // namespace fathom::proof
