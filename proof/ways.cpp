// Ways are tried in the order of counting: of the last open choice the next side. What a side says
// of its arguments (`a <= b`) narrows their intervals at once, and, by a walk back over the tape,
// those of what they are made of; a second run then starts with that.
#include "proof/ways.h"

#include "proof/instruction_rules.h"

namespace fathom::proof {

using ir::rounding::infinity;

namespace {

constexpr int max_ways = 96;
constexpr std::size_t max_open = 12;

} // namespace

int Ways::way(bool open, int many, int only) {
    const std::uint32_t site = sites++;
    while (again && next < taken.size() && taken[next].site < site) ++next;
    if (!open) return -1;
    if (only >= 0) return only;
    if (next < taken.size() && taken[next].site == site)
        return many == taken[next].many ? taken[next++].way : -1;
    if (again) return -1; // all of it is looked at
    taken.push_back({site, 0, many});
    ++next;
    return 0;
}

void Ways::start(bool second) {
    next = 0, sites = 0;
    again = second;
    if (second) return;
    impossible = false;
    ordered.clear();
    std::ranges::fill(known, Interval::everything());
}

bool Ways::to_next() {
    while (!taken.empty() && taken.back().way + 1 == taken.back().many) taken.pop_back();
    if (taken.empty()) return false;
    ++taken.back().way;
    return true;
}

void Machine::narrow(Slot s, int component, Interval to) {
    const std::size_t at = tape_.first[s] + static_cast<std::uint32_t>(component);
    if (still_[s]) return;
    const Interval before = value_[at], now{std::max(before.lo, to.lo), std::min(before.hi, to.hi)};
    if (now.lo > now.hi) {
        ways_->impossible = true;
        return;
    }
    // Where a value is not level, it is one number on nothing that has a volume: of what rounding
    // leaves of that, a slab no thicker than this.
    constexpr double thickness = 1e-12;
    if (now.width() < before.width() && std::ranges::any_of(grad_[at], [&](const Interval &d) {
            return !d.contains(0) && now.width() <= thickness * d.mignitude();
        })) {
        ways_->impossible = true;
        return;
    }
    value_[at] = now;
    if (tape_.loops.empty()) ways_->known[at] = now;
}

// The component that this one is a copy of, by what vectors are made of.
std::uint32_t Machine::origin(Slot s, int component) const {
    for (;;) {
        const std::uint32_t at = tape_.first[s] + static_cast<std::uint32_t>(component);
        const std::int32_t i = made_by_[s];
        if (i < 0) return at;
        const Instruction &in = tape_.each[std::size_t(i)];
        if (in.form != Form::Plain || in.args.empty()) return at;
        if (in.op == Op::Swizzle) {
            component = ir::swizzle_component(in.payload, component);
            s = in.args[0];
        } else if (in.op == Op::Splat) {
            component = 0;
            s = in.args[0];
        } else if (in.op == Op::Make) {
            std::size_t a = 0;
            while (a < in.args.size() && component >= int(tape_.size[in.args[a]]))
                component -= tape_.size[in.args[a++]];
            if (a == in.args.size()) return at;
            s = in.args[a];
        } else {
            return at;
        }
    }
}

// Of a difference, what it is the difference of.
std::optional<std::pair<std::uint32_t, std::uint32_t>> Machine::difference(Slot s, int c) const {
    const std::int32_t i = made_by_[s];
    if (i < 0) return {};
    const Instruction &in = tape_.each[std::size_t(i)];
    if (in.op == Op::Swizzle) return difference(in.args[0], ir::swizzle_component(in.payload, c));
    if (in.op != Op::Sub || in.form != Form::Plain) return {};
    return std::pair(origin(in.args[0], c), origin(in.args[1], c));
}

int Machine::order(Slot a, int ac, Slot b, int bc) const {
    const std::pair ordered(origin(a, ac), origin(b, bc)), reversed(ordered.second, ordered.first);
    for (const auto &known : ways_->ordered) {
        if (known == ordered) return 0;
        if (known == reversed) return 1;
    }
    return -1;
}
void Machine::keep_order(Slot lesser, int lc, Slot greater, int gc) {
    if (!tape_.loops.empty()) return; // slots of a loop's body are many values
    ways_->ordered.emplace_back(origin(lesser, lc), origin(greater, gc));
}
int Machine::sign_of(Slot s, int c) const {
    const auto of = difference(s, c);
    if (!of) return -1;
    for (const auto &known : ways_->ordered) {
        if (known == *of) return 0;
        if (known.first == of->second && known.second == of->first) return 1;
    }
    return -1;
}
void Machine::keep_sign(Slot s, int c, bool negative) {
    if (!tape_.loops.empty()) return;
    auto of = difference(s, c);
    if (of && !negative) std::swap(of->first, of->second);
    if (of) ways_->ordered.push_back(*of);
}

// What is known of a value, once it is computed.
void Machine::settle(Slot s) {
    for (int c = 0; c < int(tape_.size[s]); ++c)
        narrow(s, c, ways_->known[tape_.first[s] + static_cast<std::uint32_t>(c)]);
}

void Machine::run_way() {
    for (const Instruction &instruction : tape_.each) {
        ++work_;
        if (instruction.form == Form::Loop)
            run_loop(instruction);
        else
            step(instruction);
        if (tape_.loops.empty()) settle(instruction.out);
        if (ways_->impossible) return;
    }
}

// From each value what it says of its arguments.
void Machine::look_back() {
    for (std::size_t i = tape_.each.size(); i-- > 0 && !ways_->impossible;) {
        const Instruction &in = tape_.each[i];
        ++work_;
        Step step(*this, in);
        for (int c = 0; c < step.n && !ways_->impossible; ++c) step.look_back(c);
    }
}

void Step::look_back(int c) {
    const Interval is = machine.value_[at + static_cast<std::uint32_t>(c)];
    const auto narrow_size = [&](int arg, int k) { narrow(arg, k, {-is.hi, is.hi}); };
    if (in.form == Form::Norm || in.form == Form::PNorm) {
        const int args = int(in.args.size()) - (in.form == Form::PNorm ? 1 : 0);
        for (int a = 0; a < args; ++a)
            for (int k = 0; k < size(a); ++k) narrow_size(a, k);
        return;
    }
    if (in.form != Form::Plain || is_int() || in.stands_at) return;
    const auto least = [&](int arg) { narrow(arg, c, {is.lo, infinity}); };
    const auto most = [&](int arg) { narrow(arg, c, {-infinity, is.hi}); };
    if (in.op == Op::Neg) narrow(0, c, -is);
    if (in.op == Op::Add) narrow(0, c, is - value(1, c)), narrow(1, c, is - value(0, c));
    if (in.op == Op::Sub) narrow(0, c, is + value(1, c)), narrow(1, c, value(0, c) - is);
    if (in.op == Op::Mul)
        for (int a = 0; a < 2; ++a)
            if (!value(1 - a, c).contains(0)) narrow(a, c, is / value(1 - a, c));
    if (in.op == Op::Min) least(0), least(1);
    if (in.op == Op::Max) most(0), most(1);
    if (in.op == Op::Abs) narrow_size(0, c);
    if (in.op == Op::Splat) narrow(0, 0, is);
    if (in.op == Op::Swizzle) narrow(0, ir::swizzle_component(in.payload, c), is);
    if (in.op == Op::Make)
        for (int a = 0; a < int(in.args.size()); c -= size(a++))
            if (c < size(a)) return narrow(a, c, is);
}

double Machine::norm_by_ways(const Cell &cell, double enough) {
    if (ranges_.work->spent()) return infinity;
    if (still_.empty()) {
        still_.assign(tape_.first.size(), true);
        for (const Instruction &in : tape_.each) still_[in.out] = false;
        for (const Loop &loop : tape_.loops)
            for (const Instruction &in : loop.body) still_[in.out] = false;
    }
    Ways ways;
    ways.known.resize(tape_.components);
    ways_ = &ways;
    reach(cell);
    const std::size_t before = work_;
    double most = 0;
    int runs = 0;
    do {
        ways.start(false);
        run_way();
        if (!ways.impossible && !ways.taken.empty() && tape_.loops.empty()) {
            look_back();
            ways.start(true);
            if (!ways.impossible) run_way();
        }
        if (!ways.impossible) most = std::max(most, norm_[tape_.result]);
        if (++runs > max_ways || ways.taken.size() > max_open) most = infinity;
    } while (most < enough && ways.to_next());
    ways_ = nullptr;
    ranges_.work->take(work_ - before);
    return most;
}

} // namespace fathom::proof
