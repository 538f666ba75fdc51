// Reflections under which a field keeps its value or only changes its sign, by following how each
// value answers to them. Its slope is then the same on both sides, and half is enough to look at.
#include "proof/field.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace fathom::proof {
namespace {

enum class Parity : std::uint8_t { Even, Odd, Neither };

Parity product(Parity a, Parity b) {
    if (a == Parity::Neither || b == Parity::Neither) return Parity::Neither;
    return a == b ? Parity::Even : Parity::Odd;
}
Parity sum(Parity a, Parity b) { return a == b ? a : Parity::Neither; }
Parity square(Parity a) { return product(a, a); }

struct Follower {
    const Tape &tape;
    std::vector<Parity> parity; // by component; what does not vary with the point is even

    Parity &of(Slot s, std::uint32_t c) {
        return parity[tape.first[s] + std::min<std::uint32_t>(c, tape.size[s] - 1u)];
    }
    // Of all components of all arguments: even together, or nothing is known.
    template <class F> Parity all(const Instruction &in, F each) {
        Parity out = Parity::Even;
        for (Slot s : in.args)
            for (std::uint32_t c = 0; c < tape.size[s]; ++c) out = sum(out, each(of(s, c)));
        return out;
    }
    static Parity plain(Parity a) { return a; }

    Parity component(const Instruction &in, std::uint32_t c) {
        const auto arg = [&](std::size_t i) { return of(in.args[i], c); };
        if (in.form == Form::Norm || in.form == Form::PNorm) return all(in, square);
        if (in.form == Form::Square || in.form == Form::Sinc || in.form == Form::Hyperbolic)
            return square(arg(0));
        const Parity even = all(in, plain) == Parity::Even ? Parity::Even : Parity::Neither;
        if (in.form == Form::Wave) return of(in.args[1], c) == Parity::Even ? arg(0) : even;
        if (in.form != Form::Plain) return even;
        switch (ir::info(in.op).parity) {
        case ir::OpParity::Odd: return arg(0);
        case ir::OpParity::Even: return square(arg(0));
        case ir::OpParity::Sum: return sum(arg(0), arg(1));
        case ir::OpParity::Product: return product(arg(0), arg(1));
        case ir::OpParity::Parts: return part(in, c).value_or(even);
        case ir::OpParity::Own: return own(in, c);
        case ir::OpParity::None: break;
        }
        return even; // of the same arguments the same value
    }
    Parity own(const Instruction &in, std::uint32_t c) {
        if (in.op == Op::Length) return all(in, square);
        if (in.op == Op::Dot) {
            Parity out = product(of(in.args[0], 0), of(in.args[1], 0));
            for (std::uint32_t i = 1; i < tape.size[in.args[0]]; ++i)
                out = sum(out, product(of(in.args[0], i), of(in.args[1], i)));
            return out;
        }
        const auto arg = [&](std::size_t i) { return of(in.args[i], c); };
        assert(in.op == Op::Mix); // a + t (b - a)
        return sum(arg(0), product(arg(2), sum(arg(0), arg(1))));
    }
    // Of the component of an argument that component c is; none of matrices' parts.
    std::optional<Parity> part(const Instruction &in, std::uint32_t c) {
        if (in.op == Op::Splat) return of(in.args[0], 0);
        if (in.op == Op::Swizzle)
            return of(in.args[0],
                      static_cast<std::uint32_t>(ir::swizzle_component(in.payload, int(c))));
        if (in.op != Op::Make) return std::nullopt;
        for (Slot s : in.args) {
            if (c < tape.size[s]) return of(s, c);
            c -= tape.size[s];
        }
        return Parity::Neither;
    }
};

} // namespace

Reflected reflected(const Tape &tape, const std::array<bool, 3> &axes) {
    Follower follower{tape, std::vector<Parity>(tape.components, Parity::Even)};
    for (const Instruction &in : tape.each) {
        if (in.form == Form::Loop) return Reflected::Unknown;
        const std::uint32_t at = tape.first[in.out];
        for (std::uint32_t c = 0; c < tape.size[in.out]; ++c)
            follower.parity[at + c] = in.op == Op::Point && in.form == Form::Plain
                                          ? (axes[c] ? Parity::Odd : Parity::Even)
                                          : follower.component(in, c);
    }
    for (std::uint32_t c = 0; c < tape.size[tape.result]; ++c)
        if (follower.of(tape.result, c) == Parity::Neither) return Reflected::Unknown;
    return follower.of(tape.result, 0) == Parity::Odd ? Reflected::Negated : Reflected::Same;
}

} // namespace fathom::proof
