// Which coordinates a field repeats in, by following how each value depends on each coordinate: not
// at all, linearly, periodically, or otherwise. A period is only claimed where it is exact in the
// numbers of the program.
#include "proof/field.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {
namespace {

struct Way {
    enum Kind : std::uint8_t { None, Linear, Periodic, Other } kind = None;
    double number = 0; // slope, or period
};

// The least common period, where the ratio is a ratio of small whole numbers, exactly.
Way meet_periods(Way a, Way b) {
    if (a.kind == Way::None) return b.kind == Way::Linear ? Way{Way::Other, 0} : b;
    if (b.kind == Way::None) return a.kind == Way::Linear ? Way{Way::Other, 0} : a;
    if (a.kind != Way::Periodic || b.kind != Way::Periodic) return {Way::Other, 0};
    for (int i = 1; i <= 32; ++i)
        for (int j = 1; j <= 32; ++j)
            if (a.number * i == b.number * j) return {Way::Periodic, a.number * i};
    return {Way::Other, 0};
}
Way add(Way a, Way b, double sign) {
    if (b.kind == Way::None) return a;
    if (a.kind == Way::None) return b.kind == Way::Linear ? Way{Way::Linear, sign * b.number} : b;
    if (a.kind == Way::Linear && b.kind == Way::Linear) {
        double slope = a.number + sign * b.number;
        return slope == 0 ? Way{} : Way{Way::Linear, slope};
    }
    return meet_periods(a, b);
}
Way times(Way a, double factor) {
    if (a.kind == Way::Linear) return factor == 0 ? Way{} : Way{Way::Linear, a.number * factor};
    return a;
}
Way repeats_after(Way a, double length) { // of f(x), f with that period
    if (a.kind == Way::Linear) return {Way::Periodic, std::fabs(length / a.number)};
    return a;
}
Way blur(Way a) { return a.kind == Way::Linear ? Way{Way::Other, 0} : a; }
// Of x and m, which is a number or NaN.
Way remainder(Way x, double m, Way of_m) {
    return m > 0 ? repeats_after(x, m) : meet_periods(blur(x), blur(of_m));
}

} // namespace

Periods periods_of(const Tape &tape, const ir::Graph &graph) {
    Periods out;
    std::vector<Way> ways(tape.components);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::fill(ways.begin(), ways.end(), Way{});
        auto way = [&](const Instruction &in, std::size_t arg, std::uint32_t c) -> Way {
            Slot s = in.args[arg];
            return ways[tape.first[s] + std::min<std::uint32_t>(c, tape.size[s] - 1u)];
        };
        auto constant = [&](const Instruction &in, std::size_t arg, std::uint32_t c) -> double {
            Slot s = in.args[arg];
            for (const Instruction &other : tape.once)
                if (other.out == s) {
                    if (other.op == Op::Const) return graph.constant_of(other.node).value[c];
                    if (other.op == Op::Splat)
                        for (const Instruction &inner : tape.once)
                            if (inner.out == other.args[0] && inner.op == Op::Const)
                                return graph.constant_of(inner.node).value[0];
                }
            return NAN;
        };
        bool simple = true;
        for (const Instruction &in : tape.each) {
            std::uint32_t at = tape.first[in.out], n = tape.size[in.out];
            auto all = [&] { // any function of all components of all arguments
                Way w;
                for (Slot s : in.args)
                    for (std::uint32_t c = 0; c < tape.size[s]; ++c)
                        w = meet_periods(w, blur(ways[tape.first[s] + c]));
                return w;
            };
            if (in.form == Form::Loop) {
                simple = false;
                break;
            }
            Way everything = in.op == Op::Point ? Way{} : all();
            for (std::uint32_t c = 0; c < n; ++c) {
                Way &w = ways[at + c];
                w = everything;
                if (in.form == Form::Wave) {
                    double m = constant(in, 1, c);
                    w = remainder(way(in, 0, c), m, way(in, 1, c));
                    continue;
                }
                if (in.form == Form::Square) {
                    w = blur(way(in, 0, c));
                    continue;
                }
                if (in.form != Form::Plain) continue;
                if (in.op == Op::Point)
                    w = c == axis ? Way{Way::Linear, 1} : Way{};
                else if (in.stands_at) // of what is linear the gradient alone is left
                    w = way(in, 0, c).kind == Way::Linear ? Way{} : way(in, 0, c);
                else if (in.op == Op::Add)
                    w = add(way(in, 0, c), way(in, 1, c), 1);
                else if (in.op == Op::Sub)
                    w = add(way(in, 0, c), way(in, 1, c), -1);
                else if (in.op == Op::Neg)
                    w = times(way(in, 0, c), -1);
                else if (in.op == Op::Sin || in.op == Op::Cos)
                    w = repeats_after(way(in, 0, c), 6.283185307179586476925);
                else if (in.op == Op::Tan)
                    w = repeats_after(way(in, 0, c), 3.141592653589793238463);
                else if (in.op == Op::Swizzle)
                    w = way(in, 0,
                            static_cast<std::uint32_t>(ir::swizzle_component(in.payload, int(c))));
                else if (in.op == Op::Splat)
                    w = way(in, 0, 0);
                else if (in.op == Op::Abs || in.op == Op::Min || in.op == Op::Max ||
                         in.op == Op::Clamp || in.op == Op::Mix) {
                    w = Way{};
                    for (std::size_t a = 0; a < in.args.size(); ++a)
                        w = meet_periods(w, blur(way(in, a, c)));
                } else if (in.op == Op::Make) {
                    std::uint32_t k = c;
                    for (std::size_t a = 0; a < in.args.size(); ++a) {
                        std::uint32_t size = tape.size[in.args[a]];
                        if (k < size) {
                            w = ways[tape.first[in.args[a]] + k];
                            break;
                        }
                        k -= size;
                    }
                } else if (in.op == Op::Mul) {
                    double x = constant(in, 0, c), y = constant(in, 1, c);
                    if (!std::isnan(x))
                        w = times(way(in, 1, c), x);
                    else if (!std::isnan(y))
                        w = times(way(in, 0, c), y);
                    else
                        w = meet_periods(blur(way(in, 0, c)), blur(way(in, 1, c)));
                } else if (in.op == Op::Div) {
                    double y = constant(in, 1, c);
                    if (!std::isnan(y) && y != 0)
                        w = times(way(in, 0, c), 1 / y);
                    else
                        w = meet_periods(blur(way(in, 0, c)), blur(way(in, 1, c)));
                } else if (in.op == Op::Mod) {
                    double m = constant(in, 1, c);
                    w = remainder(way(in, 0, c), m, way(in, 1, c));
                } else if (in.op == Op::Fract)
                    w = repeats_after(way(in, 0, c), 1);
            }
        }
        if (!simple) continue;
        Way result;
        bool linear = true;
        for (std::uint32_t c = 0; c < tape.size[tape.result]; ++c) {
            const Way own = ways[tape.first[tape.result] + c];
            linear = linear && (own.kind == Way::None || own.kind == Way::Linear);
            result = meet_periods(result, blur(own));
        }
        out.linear[axis] = linear;
        if (result.kind == Way::None) out.reads[axis] = false;
        if (result.kind == Way::Periodic) out.period[axis] = result.number;
    }
    return out;
}

} // namespace fathom::proof
