// Let the base b have Jacobian s Q, Q orthogonal, and let parts f_i depend on different components
// of b. Their gradients are s Q^T g_i with g_i at right angles, so the vector of them all has a
// Jacobian whose norm is the greatest |s g_i|, the greatest norm of a part alone.
#include "proof/supports.h"

#include "proof/machine.h"

#include <algorithm>

namespace fathom::proof {

Supports::Support Supports::both(Support a, Support b) {
    if (a.mask == 0) return b;
    if (b.mask == 0) return a;
    if (a.base != b.base || a.base == none) return {none, 0xff};
    return {a.base, static_cast<std::uint8_t>(a.mask | b.mask)};
}
bool Supports::apart(Support a, Support b) {
    if (a.mask == 0 || b.mask == 0) return true;
    return a.base == b.base && a.base != none && (a.mask & b.mask) == 0;
}

Supports::Support Supports::at(Slot s, int component) const {
    const std::size_t i = tape_.first[s] + static_cast<std::uint32_t>(component);
    return i < known_.size() ? known_[i] : Support{none, 0xff};
}
Supports::Support Supports::all(Slot s) const {
    Support sum;
    for (int c = 0; c < int(tape_.size[s]); ++c) sum = both(sum, at(s, c));
    return sum;
}
void Supports::set(Slot s, int component, Support support) {
    const std::size_t i = tape_.first[s] + static_cast<std::uint32_t>(component);
    if (known_.size() <= i) known_.resize(tape_.components, Support{none, 0xff});
    known_[i] = support;
}

bool Supports::is_base(Slot s) const {
    for (int c = 0; c < int(tape_.size[s]); ++c)
        if (const Support a = at(s, c); a.base != s || a.mask != 1u << c) return false;
    return true;
}
void Supports::make_base(Slot s) {
    for (int c = 0; c < int(tape_.size[s]); ++c) set(s, c, {s, static_cast<std::uint8_t>(1u << c)});
}
void Supports::follow(const Instruction &in) {
    const int n = tape_.size[in.out];
    constexpr ir::OpSet rounds{Op::Floor, Op::Ceil, Op::Round, Op::Trunc};
    if (!in.varies ||
        (rounds[in.op] && in.form == Form::Plain)) { // of no slope where it does not jump
        for (int c = 0; c < n; ++c) set(in.out, c, {});
        return;
    }
    if (in.op == Op::Point) return make_base(in.out);
    const bool matrices = n > 4;
    if (in.op == Op::Make && !matrices) {
        int c = 0;
        for (Slot s : in.args)
            for (int k = 0; k < int(tape_.size[s]) && c < n; ++k) set(in.out, c++, at(s, k));
        return;
    }
    if (in.op == Op::Swizzle) {
        for (int c = 0; c < n; ++c)
            set(in.out, c, at(in.args[0], ir::swizzle_component(in.payload, c)));
        return;
    }
    const bool by_component = ir::info(in.op).rule == ir::TypeRule::Same && in.op != Op::Cross &&
                              in.op != Op::Normalize && in.op != Op::Transpose &&
                              in.form != Form::Norm && in.form != Form::PNorm &&
                              in.form != Form::Corner && !matrices;
    Support everything;
    for (Slot s : in.args) everything = both(everything, all(s));
    for (int c = 0; c < n; ++c) {
        Support own = everything;
        if (by_component) {
            own = {};
            for (Slot s : in.args) own = both(own, int(tape_.size[s]) == n ? at(s, c) : all(s));
        }
        set(in.out, c, own);
    }
}

bool Supports::apart(Slot value, Slot vector, unsigned components) const {
    bool out = true;
    for (int c = 0; c < int(tape_.size[vector]); ++c)
        out = out && (!(components >> c & 1) || apart(all(value), at(vector, c)));
    return out;
}

std::uint32_t Supports::groups(const std::vector<Slot> &args) const {
    if (args.size() > 16) return 0;
    std::vector<int> group(args.size());
    for (std::size_t i = 0; i < args.size(); ++i) group[i] = static_cast<int>(i);
    for (std::size_t i = 0; i < args.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (!apart(all(args[i]), all(args[j]))) {
                const int from = group[i], into = group[j];
                std::replace(group.begin(), group.end(), from, into);
            }
    std::uint32_t out = 0;
    std::vector<int> names;
    for (std::size_t i = 0; i < args.size(); ++i) {
        if (all(args[i]).mask == 0) continue; // of no slope: in any group
        auto found = std::find(names.begin(), names.end(), group[i]);
        const auto name = static_cast<std::uint32_t>(found - names.begin());
        if (found == names.end()) names.push_back(group[i]);
        if (name > 3) return 0;
        out |= name << (2 * i);
    }
    return out;
}

// The axes along which a value may change, a bit for each.
unsigned Machine::axes(Slot s) const {
    unsigned bits = 0;
    for (std::uint32_t c = 0; c < tape_.size[s]; ++c)
        for (unsigned j = 0; j < 3; ++j)
            if (grad_[tape_.first[s] + c][j] != Interval(0.0)) bits |= 1u << j;
    return bits;
}

// Where two arguments change along other axes, |(A + B) v| <= hypot(|A|, |B|) |v|, as each reads a
// part of v of its own; and where they read other coordinates of a vector like the point.
bool Machine::at_right_angles(const Instruction &in, int a, int b) const {
    return (axes(in.args[std::size_t(a)]) & axes(in.args[std::size_t(b)])) == 0 ||
           in_other_group(in, a, b);
}

} // namespace fathom::proof
