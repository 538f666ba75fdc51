// A second, small checker of slopes, of another design than proof/, with which it shares nothing:
// the compiled function is evaluated over boxes by plain intervals, each with the box of its three
// partial derivatives (forward differentiation), and the box with the greatest bound is halved, as
// often as it may. At a single point the same gives an enclosure of the gradient, whose least
// length is certainly seen. It knows no rule beyond the derivative of each op: what may jump in a
// box, or is not known here, has no bound there.
// Long: one evaluator, a case for each op.
#pragma once

#include "ir/blends.h"
#include "ir/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>
#include <vector>

// Most ops are looked at in two steps, so no switch here names all.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wswitch-enum"

namespace fathom::test::second {

constexpr double endless = std::numeric_limits<double>::infinity();

// -- intervals, rounded outward by a few units in the last place

struct Span {
    double lo = 0, hi = 0;
    bool is_number() const { return lo == hi; }
    bool holds(double x) const { return lo <= x && x <= hi; }
    double most() const { return std::max(std::fabs(lo), std::fabs(hi)); }
    double least() const { return holds(0) ? 0 : std::min(std::fabs(lo), std::fabs(hi)); }
};
constexpr Span anything{-endless, endless};

inline Span grown(double lo, double hi, double units = 1) {
    if (std::isnan(lo) || std::isnan(hi)) return anything;
    const auto by = [&](double x) {
        return units * (std::fabs(x) * std::numeric_limits<double>::epsilon() + 5e-324);
    };
    return {lo - (std::isinf(lo) ? 0 : by(lo)), hi + (std::isinf(hi) ? 0 : by(hi))};
}
inline Span both(Span a, Span b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline Span operator-(Span a) { return {-a.hi, -a.lo}; }
inline Span operator+(Span a, Span b) {
    if (a.lo == 0 && a.hi == 0) return b; // most entries of a gradient
    if (b.lo == 0 && b.hi == 0) return a;
    return grown(a.lo + b.lo, a.hi + b.hi);
}
inline Span operator-(Span a, Span b) { return a + -b; }
inline Span operator*(Span a, Span b) {
    if ((a.lo == 0 && a.hi == 0) || (b.lo == 0 && b.hi == 0)) return {};
    const auto product = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };
    const double p = product(a.lo, b.lo), q = product(a.lo, b.hi), r = product(a.hi, b.lo),
                 s = product(a.hi, b.hi);
    return grown(std::min(std::min(p, q), std::min(r, s)),
                 std::max(std::max(p, q), std::max(r, s)));
}
inline Span operator/(Span a, Span b) {
    if (b.holds(0)) return anything;
    return a * grown(1 / b.hi, 1 / b.lo);
}
template <class F> Span rising(F f, Span x) { return grown(f(x.lo), f(x.hi), 8); }
inline Span cosine(Span x) {
    if (!(x.hi - x.lo < 6)) return {-1, 1};
    constexpr double pi = 3.14159265358979323846;
    Span out = both(rising([](double t) { return std::cos(t); }, {x.lo, x.lo}),
                    rising([](double t) { return std::cos(t); }, {x.hi, x.hi}));
    for (double k = std::floor(x.lo / pi) - 1; k <= x.hi / pi + 1; ++k)
        if (k * pi >= x.lo - 1e-9 && k * pi <= x.hi + 1e-9)
            out = both(out, std::fmod(k, 2) == 0 ? Span{1, 1} : Span{-1, -1});
    return {std::max(out.lo, -1.0), std::min(out.hi, 1.0)};
}
inline Span sine(Span x) {
    constexpr double half_pi = 1.57079632679489661923;
    return cosine(grown(x.lo - half_pi, x.hi - half_pi, 4));
}

// -- a number and its partial derivatives

struct Dual {
    Span v;
    std::array<Span, 3> d{};
    Dual() = default;
    Dual(double x) : v{x, x} {} // NOLINT: numbers stand in the formulas of ir/blends.h
    Dual(Span value, const std::array<Span, 3> &slopes) : v(value), d(slopes) {}
    bool is_still() const {
        return std::ranges::all_of(d, [](Span s) { return s.lo == 0 && s.hi == 0; });
    }
};
constexpr std::array<Span, 3> any_slope{anything, anything, anything};

inline Dual chained(Span v, Span slope, const Dual &x) {
    return {v, {slope * x.d[0], slope * x.d[1], slope * x.d[2]}};
}
inline Dual combined(Span v, Span by_a, const Dual &a, Span by_b, const Dual &b) {
    Dual out{v, {}};
    for (std::size_t k = 0; k < 3; ++k) out.d[k] = by_a * a.d[k] + by_b * b.d[k];
    return out;
}
inline Dual either(const Dual &a, const Dual &b) {
    Dual out{both(a.v, b.v), {}};
    for (std::size_t k = 0; k < 3; ++k) out.d[k] = both(a.d[k], b.d[k]);
    return out;
}
inline Dual jumping(Span v) { return {v, any_slope}; }
inline Dual operator-(const Dual &a) { return chained(-a.v, {-1, -1}, a); }
inline Dual operator+(const Dual &a, const Dual &b) {
    return combined(a.v + b.v, {1, 1}, a, {1, 1}, b);
}
inline Dual operator-(const Dual &a, const Dual &b) {
    return combined(a.v - b.v, {1, 1}, a, {-1, -1}, b);
}
inline Dual operator*(const Dual &a, const Dual &b) { return combined(a.v * b.v, b.v, a, a.v, b); }
inline Dual operator/(const Dual &a, const Dual &b) {
    if (b.v.holds(0)) return jumping(anything);
    const Span v = a.v / b.v;
    return combined(v, Span{1, 1} / b.v, a, -(v / b.v), b);
}
inline Dual minimum(const Dual &a, const Dual &b) {
    if (a.v.hi < b.v.lo) return a;
    if (b.v.hi < a.v.lo) return b;
    Dual out = either(a, b);
    out.v.hi = std::min(a.v.hi, b.v.hi);
    return out;
}
inline Dual maximum(const Dual &a, const Dual &b) { return -minimum(-a, -b); }
inline Dual size(const Dual &x) { return maximum(x, -x); }
inline Dual gap(const Dual &a, const Dual &b) { return size(a - b); }
inline Dual square(const Dual &x) {
    const double most = x.v.most(), least = x.v.least();
    Span v = grown(least * least, most * most);
    v.lo = std::max(v.lo, 0.0);
    return chained(v, Span{2, 2} * x.v, x);
}
inline Dual floor(const Dual &x) {
    const Span v{std::floor(x.v.lo), std::floor(x.v.hi)};
    return v.is_number() || x.is_still() ? Dual{v, {}} : jumping(v);
}
inline Dual sqrt(const Dual &x) {
    const auto root = [](double t) { return std::sqrt(std::max(t, 0.0)); };
    const Span v = rising(root, x.v);
    if (x.v.hi < 0) return 0.0;
    if (x.is_still()) return {v, {}};
    if (x.v.lo <= 0) return jumping(v);
    return chained(v, Span{0.5, 0.5} / v, x);
}
inline Dual exponential(const Dual &x) {
    const Span v = rising([](double t) { return std::exp(t); }, x.v);
    return chained(v, v, x);
}
inline Dual logarithm(const Dual &x) {
    if (x.v.lo <= 0) return jumping(anything);
    return chained(rising([](double t) { return std::log(t); }, x.v), Span{1, 1} / x.v, x);
}
inline Dual pow(const Dual &x, const Dual &y) {
    if (x.v.lo > 0) { // exp(y log x), with the slope written so that y = 2 is x + x
        const Dual power = exponential(y * logarithm(x));
        if (!y.is_still()) return power;
        const Span less = (exponential((y - Dual(1.0)) * logarithm(x))).v;
        return chained(power.v, y.v * less, x);
    }
    if (!y.v.is_number() || !y.is_still() || y.v.lo < 1) return jumping(anything);
    const double n = y.v.lo;
    const auto power = [&](double t) {
        if (t >= 0) return std::pow(t, n);
        return std::floor(n) != n ? 0.0 : std::pow(t, n);
    };
    const auto slope = [&](double t) {
        if (t >= 0) return n * std::pow(t, n - 1);
        return std::floor(n) != n ? 0.0 : n * std::pow(t, n - 1);
    };
    const auto ends = [&](const auto &f) { // monotone on each side of 0
        Span out = both(rising(f, {x.v.lo, x.v.lo}), rising(f, {x.v.hi, x.v.hi}));
        return x.v.holds(0) ? both(out, rising(f, {0.0, 0.0})) : out;
    };
    return chained(ends(power), ends(slope), x);
}

using Value = std::vector<Dual>;

// -- a function's value over a box

class Evaluator {
  public:
    Evaluator(const ir::Scene &scene, double time)
        : scene_(scene), graph_(scene.graph), time_(time) {}

    long work = 0; // nodes evaluated

    Value call(ir::FunctionId id, const std::vector<Value> &args) {
        const ir::Function &function = graph_.function(id);
        Scope scope;
        for (std::size_t i = 0; i < args.size(); ++i) scope.values[function.params[i]] = args[i];
        return of(scope, function.result);
    }

  private:
    struct Scope {
        std::unordered_map<ir::NodeId, Value> values;
        std::unordered_map<ir::NodeId, std::vector<Value>> loops;
        Scope *outer = nullptr; // of a loop's body
    };
    const ir::Scene &scene_;
    const ir::Graph &graph_;
    const double time_;

    Value of(Scope &scope, ir::NodeId id) {
        Scope *home = &scope;
        for (Scope *s = &scope; s; s = s->outer) {
            if (const auto it = s->values.find(id); it != s->values.end()) return it->second;
            home = s;
        }
        if (graph_.reads(id).free_vars) home = &scope;
        ++work;
        Value out = computed(*home, id);
        home->values[id] = out;
        return out;
    }

    static Value unknown(int n) { return Value(std::size_t(n), jumping(anything)); }

    Value computed(Scope &scope, ir::NodeId id) {
        const ir::Node node = graph_[id];
        const int n = ir::components(node.type);
        using ir::Op;
        switch (node.op) {
        case Op::Const: {
            Value out;
            for (int i = 0; i < n; ++i)
                out.emplace_back(graph_.constant_of(id).value[std::size_t(i)]);
            return out;
        }
        case Op::Time: return {Dual(time_)};
        case Op::Param: {
            Value out;
            for (int i = 0; i < n; ++i)
                out.emplace_back(scene_.params[node.payload].value[std::size_t(i)]);
            return out;
        }
        case Op::Loop: return loop(scope, id)[0];
        case Op::LoopResult: return loop(scope, graph_.arg(id, 0))[node.payload];
        default: break;
        }
        std::vector<Value> args;
        for (const ir::NodeId a : graph_.args(id)) args.push_back(of(scope, a));
        switch (node.op) {
        case Op::Call: return call(ir::FunctionId{node.payload}, args);
        case Op::Cached: return call(graph_.cache(ir::CacheId{node.payload}).field, args);
        case Op::Splat: return Value(std::size_t(n), args[0][0]);
        case Op::Make: {
            Value out;
            for (const Value &a : args) out.insert(out.end(), a.begin(), a.end());
            return out;
        }
        case Op::Swizzle: {
            Value out;
            for (int i = 0; i < n; ++i)
                out.push_back(args[0][std::size_t(ir::swizzle_component(node.payload, i))]);
            return out;
        }
        case Op::Column: {
            const auto first = args[0].begin() + std::ptrdiff_t(node.payload) * n;
            return {first, first + n};
        }
        case Op::Transpose: {
            const int m = ir::side(node.type);
            Value out = unknown(n);
            for (int c = 0; c < m; ++c)
                for (int r = 0; r < m; ++r)
                    out[std::size_t(c * m + r)] = args[0][std::size_t(r * m + c)];
            return out;
        }
        case Op::MatMul: return product(id, args);
        case Op::Dot: return {dot(args[0], args[1])};
        case Op::Length: return {length(args[0])};
        case Op::Normalize: {
            Value out;
            const Dual whole = length(args[0]);
            for (const Dual &x : args[0]) {
                out.push_back(x / whole);
                if (whole.v.holds(0)) out.back() = jumping({-1, 1});
            }
            return out;
        }
        case Op::Cross: {
            Value out;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
                out.push_back(args[0][j] * args[1][k] - args[0][k] * args[1][j]);
            }
            return out;
        }
        case Op::Select: return select(args);
        case Op::TableRead: return row_of(node, args[0][0]);
        case Op::Hash: {
            Dual out{Span{0, 1}, {}};
            for (const Dual &x : args[0])
                if (!x.is_still()) out = jumping(out.v);
            return {out};
        }
        case Op::Union:
        case Op::Intersection: {
            Dual out = args[0][0];
            for (const Value &a : args)
                out = node.op == Op::Union ? minimum(out, a[0]) : maximum(out, a[0]);
            return {out};
        }
        case Op::Blend: {
            Dual out = args[2][0];
            for (std::size_t i = 3; i < args.size(); ++i)
                out = blended(ir::Profile(node.payload), out, args[i][0], args[0][0], args[1][0]);
            return {out};
        }
        default: break;
        }
        Value out;
        for (int i = 0; i < n; ++i) {
            const auto arg = [&](std::size_t k) {
                return args[k][std::min(std::size_t(i), args[k].size() - 1)];
            };
            const auto result = component(node, args.size(), arg);
            if (!result) return unknown(n);
            out.push_back(*result);
        }
        return out;
    }

    static Dual blended(ir::Profile profile, const Dual &a, const Dual &b, const Dual &r,
                        const Dual &n) {
        switch (profile) {
        case ir::Profile::Smooth: return ir::sem::blend_smooth(a, b, r);
        case ir::Profile::Round: return ir::sem::blend_round(a, b, r);
        case ir::Profile::Chamfer: return ir::sem::blend_chamfer(a, b, r);
        case ir::Profile::Stairs: return ir::sem::blend_stairs(a, b, r, n);
        case ir::Profile::Columns: return ir::sem::blend_columns(a, b, r, n);
        }
        return jumping(anything);
    }
    static Dual dot(const Value &a, const Value &b) {
        Dual sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
            sum = sum + (&a == &b ? square(a[i]) : a[i] * b[i]);
        return sum;
    }
    static Dual length(const Value &q) {
        const Dual sum = dot(q, q);
        Dual out = sqrt(sum);
        if (out.v.lo > 0) { // by the ratio, which is at most 1
            out.d = {};
            for (const Dual &x : q) {
                Span part = x.v / out.v;
                part = {std::max(part.lo, -1.0), std::min(part.hi, 1.0)};
                for (std::size_t k = 0; k < 3; ++k) out.d[k] = out.d[k] + part * x.d[k];
            }
            return out;
        }
        for (std::size_t k = 0; k < 3; ++k) { // Cauchy and Schwarz
            double most = 0;
            for (const Dual &x : q) most += x.d[k].most() * x.d[k].most();
            out.d[k] = grown(-std::sqrt(most), std::sqrt(most), 4);
        }
        out.v.lo = 0;
        return out;
    }
    Value product(ir::NodeId id, const std::vector<Value> &args) const {
        const ir::Type a = graph_[graph_.arg(id, 0)].type, b = graph_[graph_.arg(id, 1)].type;
        const int m = ir::side(ir::is_matrix(a) ? a : b), rows = ir::is_matrix(a) ? m : 1,
                  columns = ir::is_matrix(b) ? m : 1;
        Value out;
        for (int c = 0; c < columns; ++c)
            for (int r = 0; r < rows; ++r) {
                Dual sum = 0.0;
                for (int k = 0; k < m; ++k)
                    sum =
                        sum + args[0][std::size_t(k * rows + r)] * args[1][std::size_t(c * m + k)];
                out.push_back(sum);
            }
        return out;
    }
    static Value select(const std::vector<Value> &args) {
        const Dual &truth = args[0][0];
        if (truth.v.is_number()) return args[truth.v.lo != 0 ? 1 : 2];
        Value out;
        for (std::size_t i = 0; i < args[1].size(); ++i) {
            out.push_back(either(args[1][i], args[2][i]));
            if (!truth.is_still()) out.back().d = any_slope; // whether both sides meet is not asked
        }
        return out;
    }
    Value row_of(const ir::Node &node, const Dual &row) const {
        const ir::Table &table = graph_.table(ir::table_of(node.payload));
        const auto clamped = [&](double x) {
            return int(std::clamp(x, 0.0, double(table.rows - 1)));
        };
        Value out;
        for (int i = 0; i < ir::components(node.type); ++i) {
            const auto at = [&](int r) {
                return Dual(double(
                    table.data[std::size_t(r * table.stride + ir::column_of(node.payload) + i)]));
            };
            Dual all = at(clamped(row.v.lo));
            for (int r = clamped(row.v.lo); r <= clamped(row.v.hi); ++r) all = either(all, at(r));
            out.push_back(row.v.is_number() || row.is_still() ? all : jumping(all.v));
        }
        return out;
    }

    const std::vector<Value> &loop(Scope &scope, ir::NodeId id) {
        of(scope, graph_.loop(ir::LoopId{graph_[id].payload}).count);
        if (const auto it = scope.loops.find(id); it != scope.loops.end()) return it->second;
        const ir::Loop &plan = graph_.loop(ir::LoopId{graph_[id].payload});
        std::vector<Value> now;
        for (const ir::NodeId a : graph_.args(id)) now.push_back(of(scope, a));
        const Dual count = of(scope, plan.count)[0];
        std::vector<Value> ends; // of turns after which it may have stopped
        const auto may_end = [&](bool jumps) {
            if (ends.empty()) ends = now;
            for (std::size_t k = 0; k < now.size(); ++k)
                for (std::size_t c = 0; c < now[k].size(); ++c) {
                    ends[k][c] = either(ends[k][c], now[k][c]);
                    if (jumps) ends[k][c].d = any_slope;
                }
        };
        bool open = false, ended = false;
        for (int i = 0; i < plan.max_count && !ended; ++i) {
            if (count.v.hi <= i) break;
            if (count.v.lo <= i) open = open || !count.is_still(), may_end(open);
            Scope inner;
            inner.outer = &scope;
            inner.values[plan.index] = {Dual(double(i))};
            for (std::size_t k = 0; k < now.size(); ++k) inner.values[plan.vars[k]] = now[k];
            if (plan.condition) {
                const Dual go = of(inner, plan.condition)[0];
                if (go.v.hi == 0) break;
                if (go.v.lo == 0) open = open || !go.is_still(), may_end(open);
            }
            std::vector<Value> next;
            for (const ir::NodeId v : plan.next) next.push_back(of(inner, v));
            now = std::move(next);
        }
        may_end(open);
        return scope.loops[id] = std::move(ends);
    }

    template <class Arg>
    static std::optional<Dual> component(const ir::Node &node, std::size_t count, const Arg &arg) {
        using ir::Op;
        const Dual a = arg(0), b = count > 1 ? arg(1) : Dual(), c = count > 2 ? arg(2) : Dual();
        const bool whole = node.type == ir::Type::Int;
        const auto truth = [&](bool surely, bool surely_not) {
            const Span v{surely ? 1.0 : 0.0, surely_not ? 0.0 : 1.0};
            return v.is_number() || (a.is_still() && b.is_still()) ? Dual(v, {}) : jumping(v);
        };
        const auto step = [&](const Dual &x, Span when_undecided) {
            if (x.v.lo >= 0) return Dual(1.0);
            if (x.v.hi < 0) return Dual(when_undecided.lo);
            return x.is_still() ? Dual(when_undecided, {}) : jumping(when_undecided);
        };
        switch (node.op) {
        case Op::Neg: return -a;
        case Op::Add: return a + b;
        case Op::Sub: return a - b;
        case Op::Mul: return a * b;
        case Op::Div: return whole ? std::optional<Dual>() : a / b;
        case Op::Mod: {
            if (b.v.holds(0)) return jumping(anything);
            const Dual turns = floor(a / b);
            if (turns.v.is_number()) return a - b * turns;
            return jumping(both({0, 0}, b.v));
        }
        case Op::Pow: return pow(a, b);
        case Op::Min: return minimum(a, b);
        case Op::Max: return maximum(a, b);
        case Op::Abs: return size(a);
        case Op::Step: return step(b - a, {0, 1});
        case Op::Sign:
            if (a.v.lo > 0) return Dual(1.0);
            return a.v.lo == 0 && a.v.hi == 0 ? Dual(0.0) : step(a, {-1, 1});
        case Op::Floor: return floor(a);
        case Op::Ceil: return -floor(-a);
        case Op::Round: return floor(a + Dual(0.5));
        case Op::Trunc:
        case Op::ToInt:
            return a.v.lo >= 0   ? floor(a)
                   : a.v.hi <= 0 ? -floor(-a)
                                 : jumping({std::trunc(a.v.lo), std::trunc(a.v.hi)});
        case Op::Fract: {
            const Dual turns = floor(a);
            return turns.v.is_number() ? a - turns : jumping({0, 1});
        }
        case Op::ToFloat: return a;
        case Op::Sqrt: return sqrt(a);
        case Op::InverseSqrt: return Dual(1.0) / sqrt(a);
        case Op::Exp: return exponential(a);
        case Op::Exp2: return exponential(a * Dual(grown(std::log(2.0), std::log(2.0)), {}));
        case Op::Log: return logarithm(a);
        case Op::Log2: return logarithm(a) / Dual(grown(std::log(2.0), std::log(2.0)), {});
        case Op::Sin: return chained(sine(a.v), cosine(a.v), a);
        case Op::Cos: return chained(cosine(a.v), -sine(a.v), a);
        case Op::Tan:
            return Dual(sine(a.v), {(chained({}, cosine(a.v), a)).d}) /
                   chained(cosine(a.v), -sine(a.v), a);
        case Op::Atan:
            return chained(rising([](double t) { return std::atan(t); }, a.v),
                           Span{1, 1} / (Span{1, 1} + square(a).v), a);
        case Op::Tanh: {
            const Span v = rising([](double t) { return std::tanh(t); }, a.v);
            return chained(v, Span{1, 1} - square(Dual(v, {})).v, a);
        }
        case Op::Sinh: return (exponential(a) - exponential(-a)) * Dual(0.5);
        case Op::Cosh: return (exponential(a) + exponential(-a)) * Dual(0.5);
        case Op::Asin:
        case Op::Acos: {
            if (a.v.lo <= -1 || a.v.hi >= 1) return jumping({-3.2, 3.2});
            const Dual slope = Dual(1.0) / sqrt(Dual(1.0) - square(Dual(a.v, {})));
            const Dual angle =
                chained(rising([](double t) { return std::asin(t); }, a.v), slope.v, a);
            return node.op == Op::Asin ? angle : Dual(std::acos(0.0)) - angle;
        }
        case Op::Atan2: return angle(a, b);
        case Op::Clamp: return minimum(maximum(a, b), c);
        case Op::Mix: return a + (b - a) * c;
        case Op::Smoothstep: {
            if ((b.v - a.v).holds(0)) return jumping({0, 1});
            const Dual t = minimum(maximum((c - a) / (b - a), Dual(0.0)), Dual(1.0));
            const auto curve = [](double x) { return x * x * (3 - 2 * x); };
            return chained(rising(curve, t.v), Span{6, 6} * t.v * (Span{1, 1} - t.v), t);
        }
        case Op::Less: return truth(a.v.hi < b.v.lo, a.v.lo >= b.v.hi);
        case Op::LessEqual: return truth(a.v.hi <= b.v.lo, a.v.lo > b.v.hi);
        case Op::Equal:
            return truth(a.v.is_number() && b.v.is_number() && a.v.lo == b.v.lo,
                         a.v.hi < b.v.lo || b.v.hi < a.v.lo);
        case Op::NotEqual:
            return truth(a.v.hi < b.v.lo || b.v.hi < a.v.lo,
                         a.v.is_number() && b.v.is_number() && a.v.lo == b.v.lo);
        case Op::And: return minimum(a, b);
        case Op::Or: return maximum(a, b);
        case Op::Not: return Dual(1.0) - a;
        default: return {}; // noise, images, grids, hits
        }
    }
    static Dual angle(const Dual &y, const Dual &x) {
        if (y.v.holds(0) && x.v.lo <= 0) // the origin, or the cut
            return jumping({-3.1415926535897936, 3.1415926535897936});
        Span v{endless, -endless};
        for (const double b : {y.v.lo, y.v.hi})
            for (const double a : {x.v.lo, x.v.hi}) {
                const double turn = std::atan2(b, a);
                v = both(v, grown(turn, turn, 8));
            }
        const Span below = square(x).v + square(y).v;
        return combined(v, x.v / below, y, -(y.v / below), x);
    }
};

// -- branch and bound

struct Result {
    double seen = 0; // a slope that the function certainly has
    std::array<double, 3> where{};
    double at_most = endless; // none is steeper; endless where that is not shown
};

class Search {
  public:
    using Point = std::array<double, 3>;
    Search(const ir::Scene &scene, ir::FunctionId function, double time, const Point &lo,
           const Point &hi)
        : evaluator_(scene, time), function_(function), lo_(lo), hi_(hi) {}

    Result run(long work) {
        bound(work);
        climb();
        halve(std::max(24L, work / 160));
        out_.at_most = std::max(out_.at_most, out_.seen);
        return out_;
    }

  private:
    using Box = std::array<Span, 3>;
    struct Cell {
        double bound;
        int depth;
        Box box;
        bool operator<(const Cell &other) const { // jumps: the least deep first, so all are met
            if (bound != other.bound) return bound < other.bound;
            return depth > other.depth;
        }
    };
    struct Steep {
        double slope;
        Point where;
    };
    Evaluator evaluator_;
    const ir::FunctionId function_;
    const Point lo_, hi_;
    Result out_;
    std::priority_queue<Cell> open_;
    std::vector<Steep> steep_; // places that were tried
    std::uint64_t state_ = 1;

    Dual at(const Box &box) {
        Value point;
        for (std::size_t k = 0; k < 3; ++k) {
            point.push_back({box[k], {}});
            point.back().d[k] = {1, 1};
        }
        return evaluator_.call(function_, {point})[0];
    }
    Dual at(const Point &p) {
        return at(Box{Span{p[0], p[0]}, Span{p[1], p[1]}, Span{p[2], p[2]}});
    }
    void saw(double slope, const Point &where) {
        if (slope > out_.seen) out_.seen = slope, out_.where = where;
    }
    double try_at(const Point &p) {
        double sum = 0;
        for (const Span d : at(p).d) sum += d.least() * d.least();
        const double slope = std::sqrt(sum) * (1 - 1e-12);
        saw(slope, p);
        return slope;
    }
    double random() { // -1..1
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return double(state_ >> 11) * 0x1p-52 - 1;
    }

    void look(const Box &box, int depth) {
        double sum = 0;
        for (const Span d : at(box).d) sum += d.most() * d.most();
        open_.push({std::sqrt(sum), depth, box});
        Point beside_middle; // kinks lie in the middle
        for (std::size_t k = 0; k < 3; ++k)
            beside_middle[k] = box[k].lo + (box[k].hi - box[k].lo) * (0.5 + 0.013 * double(k + 1));
        steep_.push_back({try_at(beside_middle), beside_middle});
    }
    void bound(long work) {
        look({Span{lo_[0], hi_[0]}, Span{lo_[1], hi_[1]}, Span{lo_[2], hi_[2]}}, 0);
        while (open_.top().bound > out_.seen * 1.001 && evaluator_.work < work) {
            const Cell cell = open_.top();
            open_.pop();
            std::size_t axis = 0;
            for (std::size_t k = 1; k < 3; ++k)
                if (cell.box[k].hi - cell.box[k].lo > cell.box[axis].hi - cell.box[axis].lo)
                    axis = k;
            const double cut = (cell.box[axis].lo + cell.box[axis].hi) / 2;
            for (const bool upper : {false, true}) {
                Box half = cell.box;
                (upper ? half[axis].lo : half[axis].hi) = cut;
                look(half, cell.depth + 1);
            }
        }
        out_.at_most = open_.top().bound;
    }

    // Points all over the box, and uphill from the steepest places of all.
    void climb() {
        for (int i = 0; i < 256; ++i) {
            Point p;
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = (lo_[k] + hi_[k]) / 2 + (hi_[k] - lo_[k]) / 2 * random();
            steep_.push_back({try_at(p), p});
        }
        const std::size_t kept = std::min<std::size_t>(steep_.size(), 8);
        std::partial_sort(steep_.begin(), steep_.begin() + std::ptrdiff_t(kept), steep_.end(),
                          [](const Steep &a, const Steep &b) { return a.slope > b.slope; });
        steep_.resize(kept);
        double reach = 0.2;
        for (int round = 0; round < 40; ++round, reach *= 0.85)
            for (Steep &from : steep_) {
                Point p = from.where;
                for (std::size_t k = 0; k < 3; ++k)
                    p[k] =
                        std::clamp(p[k] + reach * (hi_[k] - lo_[k]) / 2 * random(), lo_[k], hi_[k]);
                if (const double slope = try_at(p); slope > from.slope) from = {slope, p};
            }
    }

    // What jumps has no gradient there: the half of a way on which more changes, again and again.
    void halve(long pairs) {
        for (long i = 0; i < pairs; ++i) {
            Point a, b;
            for (std::size_t k = 0; k < 3; ++k) {
                a[k] = (lo_[k] + hi_[k]) / 2 + (hi_[k] - lo_[k]) / 2 * random();
                b[k] = (lo_[k] + hi_[k]) / 2 + (hi_[k] - lo_[k]) / 2 * random();
            }
            Span at_a = at(a).v, at_b = at(b).v;
            for (int round = 0; round < 30; ++round) {
                Point m;
                for (std::size_t k = 0; k < 3; ++k) m[k] = (a[k] + b[k]) / 2;
                const double way = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
                saw((at_a - at_b).least() / way * (1 - 1e-12), m);
                const Span at_m = at(m).v;
                if ((at_a - at_m).least() > (at_b - at_m).least())
                    b = m, at_b = at_m;
                else
                    a = m, at_a = at_m;
            }
        }
    }
};

// Of a function (vec3) -> float over a box, at the params' present values and one time; `work`
// nodes may be evaluated to bound it, and some thousand points are tried, more where `work` is more.
inline Result slopes(const ir::Scene &scene, ir::FunctionId function, double time,
                     const std::array<double, 3> &lo, const std::array<double, 3> &hi, long work) {
    return Search(scene, function, time, lo, hi).run(work);
}

} // namespace fathom::test::second

#pragma GCC diagnostic pop
