// Kernels that stand together in most scenes are run as one, which saves what lies between them a
// way through memory. Only where nothing is computed more often for it: never into a deeper loop,
// never what all points share.
#include "backend-cpu/compile/code.h"

#include <algorithm>

namespace fathom::cpu {

namespace {

class Matcher {
  public:
    Matcher(const Code &code, std::span<const Value> in) : code_(code) {
        for (Value value : in) level_ = std::max(level_, code.values[value].level);
    }
    // The inputs of what made `value`, if it was `kernel`, here, for this point alone.
    std::span<const Value> made_by(Value value, Kernel kernel) const {
        const ValueInfo &info = code_.values[value];
        if (!info.made_by || info.shared || info.level != level_) return {};
        const Instruction &instruction = code_.instructions[info.made_by];
        if (instruction.kind != InstructionKind::Kernel || instruction.kernel != kernel) return {};
        return instruction.in;
    }
    // The same of what is costly: not where the value is computed for something else already.
    std::span<const Value> alone_by(Value value, Kernel kernel) const {
        if (code_.values[value].used) return {};
        return made_by(value, kernel);
    }

  private:
    const Code &code_;
    std::uint16_t level_ = 0;
};

std::vector<Value> then(std::span<const Value> first, std::initializer_list<Value> rest) {
    std::vector<Value> all(first.begin(), first.end());
    all.insert(all.end(), rest);
    return all;
}

bool is_zero(const Builder &builder, Value value) {
    if (builder.number_of(value) == 0.0f) return true;
    const ValueInfo &info = builder.code().values[value]; // a zero that was spread
    if (!info.made_by) return false;
    const Instruction &maker = builder.code().instructions[info.made_by];
    return maker.kind == InstructionKind::Kernel && maker.kernel == Kernel::CopyF &&
           builder.number_of(maker.in[0]) == 0.0f;
}

} // namespace

std::optional<Value> simplify(const Builder &builder, Kernel kernel, std::span<const Value> in) {
    auto is = [&](Value value, float number) { return builder.number_of(value) == number; };
    if (kernel == Kernel::MulF && is(in[0], 1)) return in[1];
    if ((kernel == Kernel::MulF || kernel == Kernel::DivF) && is(in[1], 1)) return in[0];
    if ((kernel == Kernel::AddF || kernel == Kernel::SubF) && is(in[1], 0)) return in[0];
    if (kernel == Kernel::AddF && is(in[0], 0)) return in[1];
    if ((kernel == Kernel::SelectF || kernel == Kernel::SelectI) && in[1] == in[2]) return in[1];
    return {};
}

namespace {

// Solids cut out of each other.
std::optional<Fused> fuse_choices(const Matcher &match, Kernel kernel, std::span<const Value> in) {
    if (kernel == Kernel::MaxF) {
        auto below = match.made_by(in[0], Kernel::SubF), above = match.made_by(in[1], Kernel::SubF);
        if (!below.empty() && !above.empty() && below[1] == above[0])
            return Fused{Kernel::Slab, then(below, {above[1]})};
        if (auto n = match.made_by(in[1], Kernel::NegF); !n.empty())
            return Fused{Kernel::MaxNeg, {in[0], n[0]}};
        if (auto m = match.made_by(in[1], Kernel::MinF); !m.empty())
            return Fused{Kernel::MaxMin, {in[0], m[0], m[1]}};
    }
    if (kernel == Kernel::MinF)
        if (auto m = match.made_by(in[1], Kernel::MaxF); !m.empty())
            return Fused{Kernel::MinMax, {in[0], m[0], m[1]}};
    return {};
}

} // namespace

std::optional<Fused> fuse(Builder &builder, Kernel kernel, std::span<const Value> in) {
    Matcher match(builder.code(), in);
    if (builder.code().choices == Choices::Joined)
        if (auto fused = fuse_choices(match, kernel, in)) return fused;
    if (kernel == Kernel::SubF) {
        if (auto d = match.made_by(in[0], Kernel::Distance3); !d.empty())
            return Fused{Kernel::Ball, then(d, {in[1]})};
        if (auto v = match.made_by(in[0], Kernel::Length3); !v.empty()) { // a ball about the origin
            Value zero = builder.number(0);
            return Fused{Kernel::Ball, then(v, {zero, zero, zero, in[1]})};
        }
        if (auto a = match.made_by(in[0], Kernel::AbsF); !a.empty())
            return Fused{Kernel::AbsSub, then(a, {in[1]})};
    }
    if (kernel == Kernel::AddF) {
        if (auto m = match.made_by(in[0], Kernel::MulF); !m.empty())
            return Fused{Kernel::MulAdd, then(m, {in[1]})};
        if (auto m = match.made_by(in[1], Kernel::MulF); !m.empty())
            return Fused{Kernel::MulAdd, then(m, {in[0]})};
    }
    if (kernel == Kernel::AbsF)
        if (auto s = match.made_by(in[0], Kernel::SubF); !s.empty())
            return Fused{Kernel::SubAbs, then(s, {})};
    if (kernel == Kernel::MaxF) {
        auto a = match.made_by(in[0], Kernel::AbsF), b = match.made_by(in[1], Kernel::AbsF);
        if (!a.empty() && !b.empty()) return Fused{Kernel::MaxAbs, {a[0], b[0]}};
    }
    if (kernel == Kernel::Length3) {
        std::array<std::span<const Value>, 3> sub, max;
        for (std::size_t i = 0; i < 3; ++i) {
            sub[i] = match.made_by(in[i], Kernel::SubF);
            max[i] = match.made_by(in[i], Kernel::MaxF);
        }
        if (std::ranges::any_of(sub, [](auto s) {
                return !s.empty();
            })) { // a difference with 0 was simplified away
            std::vector<Value> both(6);
            for (std::size_t i = 0; i < 3; ++i) {
                both[i] = sub[i].empty() ? in[i] : sub[i][0];
                both[i + 3] = sub[i].empty() ? builder.number(0) : sub[i][1];
            }
            return Fused{Kernel::Distance3, std::move(both)};
        }
        if (std::ranges::all_of(max, [&](auto m) { return !m.empty() && is_zero(builder, m[1]); }))
            return Fused{Kernel::LengthPositive3, {max[0][0], max[1][0], max[2][0]}};
    }
    if (kernel == Kernel::MinF)
        if (auto b = match.alone_by(in[1], Kernel::Ball); !b.empty()) {
            std::vector<Value> all{in[0]};
            all.insert(all.end(), b.begin(), b.end());
            return Fused{Kernel::MinBall, std::move(all)};
        }
    if (kernel == Kernel::BlendSmooth)
        if (auto b = match.alone_by(in[1], Kernel::Ball); !b.empty()) {
            std::vector<Value> all{in[0]};
            all.insert(all.end(), b.begin(), b.end());
            all.push_back(in[2]);
            return Fused{Kernel::SmoothBall, std::move(all)};
        }
    return {};
}

} // namespace fathom::cpu
