// The rules of what mixes components: moves between vectors, lengths and products. Proofs:
// docs/lipschitz.md, 2.
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

void Step::splat() {
    for (int c = 0; c < n; ++c) set(c, value(0, 0), grad(0, 0), odd(0, 0));
    finish(up(times(std::sqrt(double(n)), norm(0)), 4), false);
    if (machine.norm_[out] != infinity) machine.cause_[out] = machine.cause_[in.args[0]];
}

// Of all arguments together: those that depend on the same coordinates by the triangle inequality,
// the greatest of those that do not (supports.h).
double Step::together() const {
    double groups[4] = {0, 0, 0, 0};
    for (int a = 0; a < int(in.args.size()); ++a) {
        double &group = groups[a < 16 ? in.groups >> (2 * a) & 3 : 0];
        group = up(std::hypot(group, norm(a)), 4);
    }
    return std::max({groups[0], groups[1], groups[2], groups[3]});
}

void Step::make() {
    int c = 0;
    const double most = together();
    NodeId wave;
    for (int a = 0; a < int(in.args.size()); ++a) {
        for (int k = 0; k < size(a) && c < n; ++k, ++c) {
            set(c, value(a, k), grad(a, k), odd(a, k));
            if (odd(a, k)) wave = machine.cause_[in.args[static_cast<std::size_t>(a)]];
        }
    }
    finish(most, false);
    if (machine.norm_[out] != infinity) machine.cause_[out] = wave;
}

// How often the component that it takes most stands in it.
int Step::repeats_of_swizzle() const {
    std::array<int, 4> used{};
    for (int c = 0; c < n; ++c) ++used[std::size_t(ir::swizzle_component(in.payload, c))];
    return *std::ranges::max_element(used);
}

void Step::swizzle() {
    for (int c = 0; c < n; ++c) {
        int k = ir::swizzle_component(in.payload, c);
        set(c, value(0, k), grad(0, k), odd(0, k));
    }
    const int repeats = repeats_of_swizzle();
    finish(repeats == 1 ? norm(0) : up(times(std::sqrt(double(repeats)), norm(0)), 4), false);
    if (machine.norm_[out] != infinity) machine.cause_[out] = machine.cause_[in.args[0]];
}

void Step::column() {
    for (int c = 0; c < n; ++c) {
        int k = int(in.payload) * n + c;
        set(c, value(0, k), grad(0, k), odd(0, k));
    }
    finish(norm(0), false);
}

void Step::transpose() {
    int side = ir::side(in.type);
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            set(i * side + j, value(0, j * side + i), grad(0, j * side + i), odd(0, j * side + i));
    finish(norm(0), false);
}

// |q|: gradient J^T q/|q|, at most |J|; at q = 0 any of slope <= |J|
// h(v) = |v+| + min(max v, 0) grows with every component, and its gradient is w on the unit sphere,
// 0 <= w, with weights only where a component is positive, or the greatest: so the slope is at most
// the norm of those rows.
// |v|_n, n >= 2: its gradient's weights w have |w|_q = 1 for the dual exponent q <= 2, so that
// |w|_2 <= 1; the value lies between the greatest |v_i| and that times k^(1/n), k the components.
void Step::p_norm() {
    const int last = int(in.args.size()) - 1;
    const Interval power = value(last, 0);
    double least = 0, most = 0;
    int components = 0;
    Row g;
    for (int a = 0; a < last; ++a)
        for (int c = 0; c < size(a); ++c, ++components) {
            least = std::max(least, value(a, c).mignitude());
            most = std::max(most, value(a, c).magnitude());
        }
    if (!(power.lo >= 1)) {
        set(0, Interval::everything(), none);
        return fail(Trouble::Singular);
    }
    const double weight = // |w|_2 of the weights w of the parts' gradients
        power.lo < 2 ? up(std::pow(double(components), 1 / power.lo - 0.5), 8) : 1;
    double longest = 0; // the weights' sum is at most a root of their number (Hölder)
    for (int a = 0; a < last; ++a) longest = std::max(longest, norm(a));
    const double sum = up(std::pow(double(components), 1 / power.lo), 8),
                 norms = std::min(times(weight, together()), times(sum, longest));
    for (std::size_t j = 0; j < 3; ++j) {
        double column = 0;
        for (int a = 0; a < last; ++a)
            for (int c = 0; c < size(a); ++c) column += std::pow(grad(a, c)[j].magnitude(), 2);
        const double m = column == 0 ? 0 : std::min(times(weight, up(std::sqrt(column), 4)), norms);
        g[j] = {-m, m};
    }
    set(0, {least, up(times(most, sum), 4)}, g);
    finish(norms, false);
}

// Of the scalar that a component of a vector is made of, but for numbers that are added: its norm,
// which the box of its gradient need not keep.
double Machine::component_norm(Slot s, int component) const {
    for (;;) {
        if (tape_.size[s] == 1) return norm_[s];
        const std::int32_t i = made_by_[s];
        if (i < 0) return norm_[s];
        const Instruction &in = tape_.each[std::size_t(i)];
        if (in.form != Form::Plain || in.args.empty()) return norm_[s];
        std::size_t arg = 0;
        if (in.op == Op::Swizzle)
            component = ir::swizzle_component(in.payload, component);
        else if (in.op == Op::Splat)
            component = 0;
        else if (in.op == Op::Make)
            while (component >= int(tape_.size[in.args[arg]]))
                component -= tape_.size[in.args[arg++]];
        else if (in.op == Op::Add || in.op == Op::Sub) {
            arg = norm_[in.args[0]] == 0 ? 1 : 0;
            if (norm_[in.args[1 - arg]] != 0) return norm_[s];
            const auto is_odd = [&](Slot of) {
                return odd_[tape_.first[of] + std::uint32_t(tape_.size[of] == 1 ? 0 : component)];
            };
            if (is_odd(in.args[arg]) != 0 && is_odd(s) == 0) return infinity; // it jumps now
        } else if (in.op != Op::Neg)
            return norm_[s];
        s = in.args[arg];
    }
}

// Of w_1 g_1 + w_2 g_2 + … with w of length 1: the root of the greatest eigenvalue of the matrix of
// what w_i w_j (g_i . g_j) may add, for which any positive vector gives a bound (Collatz and Wielandt).
double norm_of_weighed(const Weighed *rows, int count, double known) {
    constexpr int most_rows = 8, rounds = 12;
    double longest = 0;
    for (int i = 0; i < count; ++i) longest = std::max(longest, rows[i].norm);
    if (known == infinity) return known; // it may jump
    if (count > most_rows || !(longest * (1 + 1e-6) < known)) return known;
    double matrix[most_rows][most_rows], at[most_rows], next[most_rows], largest = 0;
    for (int i = 0; i < count; ++i) {
        matrix[i][i] = up(rows[i].norm * rows[i].norm);
        largest = std::max(largest, matrix[i][i]);
        at[i] = 1;
        for (int j = 0; j < i; ++j) {
            Interval product;
            for (std::size_t k = 0; k < 3; ++k) product += (*rows[i].grad)[k] * (*rows[j].grad)[k];
            const double most = up(rows[i].norm * rows[j].norm);
            product = meet(product, Interval(-most, most));
            const int sign = rows[i].sign * rows[j].sign;
            matrix[i][j] = matrix[j][i] = sign > 0   ? std::max(product.hi, 0.0)
                                          : sign < 0 ? std::max(-product.lo, 0.0)
                                                     : product.magnitude();
        }
    }
    if (largest == 0) return 0;
    double best = up(known * known);
    for (int round = 0; round < rounds; ++round) {
        double most = 0, sum = 0;
        for (int i = 0; i < count; ++i) {
            double row = 0;
            for (int j = 0; j < count; ++j) row = up(row + up(matrix[i][j] * at[j]));
            next[i] = row;
            most = std::max(most, up(row / at[i]));
            sum += row;
        }
        best = std::min(best, most);
        for (int i = 0; i < count; ++i) at[i] = next[i] / sum + 1e-6; // above 0
    }
    return std::min(known, up(std::sqrt(best)));
}

void Step::corner() {
    const Interval zero_at(0.0);
    const int m = size(0);
    double greatest = -infinity; // some component is at least this
    for (int c = 0; c < m; ++c) greatest = std::max(greatest, value(0, c).lo);
    Interval outside, most(-infinity), squares[4];
    Row rows[4], g{};
    Weighed weighed[4];
    int used = 0, last = 0;
    for (int c = 0; c < m; ++c) {
        const Interval v = value(0, c);
        squares[c] = square(max(v, zero_at));
        outside += squares[c];
        most = c == 0 ? v : max(most, v);
    }
    // Outside, the rows are weighed by a unit vector, max(v, 0) over its length: each weight grows
    // with its component and falls with the others. Inside, one row or, where two are greatest, a
    // mean of theirs.
    for (int c = 0; c < m; ++c) {
        const Interval v = value(0, c);
        if (v.hi < std::min(greatest, 0.0)) continue; // below 0, and another is greater
        Interval weight(0, 1);
        if (greatest > 0) {
            Interval others;
            for (int o = 0; o < m; ++o)
                if (o != c) others += squares[o];
            const Interval own = squares[c];
            if (own.lo > 0)
                weight.lo = ir::rounding::down(std::sqrt(own.lo / (own.lo + others.hi)), 8);
            if (others.lo > 0) weight.hi = up(std::sqrt(own.hi / (own.hi + others.lo)), 8);
        }
        weighed[used] = {&grad(0, c), machine.component_norm(in.args[0], c), 1};
        rows[used++] = grad(0, c);
        last = c;
        g = sum(g, scaled(weight, grad(0, c)));
    }
    if (used == 1) g = rows[0];
    set(0, sqrt(outside) + min(most, zero_at), g);
    double norms = std::min(norm(0), spectral_norm(rows, used));
    if (used == 1) norms = std::min(norms, machine.component_norm(in.args[0], last));
    if (used > 1 && most.hi <= 0) { // a mean
        double longest = 0;
        for (int i = 0; i < used; ++i) longest = std::max(longest, weighed[i].norm);
        norms = std::min(norms, longest);
    }
    if (used > 1) norms = norm_of_weighed(weighed, used, norms);
    finish(norms, any_odd);
}

void Step::length() {
    Interval length;
    Row columns[16];
    Weighed weighed[16];
    int rows = 0;
    double norms = together();
    for (int a = 0; a < int(in.args.size()); ++a) {
        for (int c = 0; c < size(a); ++c) {
            const Interval v = value(a, c);
            const int sign = v.lo >= 0 ? 1 : v.hi <= 0 ? -1 : 0;
            length += square(v);
            if (rows < 16)
                weighed[rows] = {&grad(a, c), machine.component_norm(in.args[std::size_t(a)], c),
                                 sign};
            if (rows < 16)
                columns[rows++] = grad(a, c);
            else
                rows = 17;
        }
    }
    length = sqrt(length);
    if (in.args.size() == 1) length = machine.length_of(machine.coordinates(in.args[0]), length);
    if (in.args.size() == 1)
        norms = norm(0);
    else if (rows <= 16)
        norms = std::min(norms, spectral_norm(columns, rows));
    if (rows > 1 && rows <= 16) norms = norm_of_weighed(weighed, rows, norms);
    Row g;
    for (std::size_t j = 0; j < 3; ++j) {
        double column = 0;
        Interval along;
        for (int a = 0; a < int(in.args.size()); ++a)
            for (int c = 0; c < size(a); ++c) {
                column += std::pow(grad(a, c)[j].magnitude(), 2);
                along += value(a, c) * grad(a, c)[j];
            }
        double m = column == 0 ? 0 : std::min(up(std::sqrt(column), 4), norms);
        g[j] = {-m, m};
        if (length.lo > 0) g[j] = meet(g[j], along / length);
        if (along.lo >= 0) g[j].lo = std::max(g[j].lo, 0.0);
        if (along.hi <= 0) g[j].hi = std::min(g[j].hi, 0.0);
    }
    set(0, length, g);
    finish(norms, false);
}

// A mean of the two gradients, or the gradient of the one that is less (greater) by k.
void Step::smooth() {
    const Interval x = value(0, 0), y = value(1, 0), given = value(2, 0);
    if ((in.payload & 2) != 0 && given.contains(0)) return fail(Trouble::Singular);
    const Interval k = (in.payload & 4) != 0 ? max(given, Interval(0.0)) : given;
    const double reach = k.magnitude();
    const bool may_be_less = k.lo < 0 ? (in.payload & 1) != 0 || k.hi > 0 : (in.payload & 1) == 0,
               may_be_greater =
                   k.lo < 0 ? (in.payload & 1) == 0 || k.hi > 0 : (in.payload & 1) != 0;
    if (may_be_less != may_be_greater)
        for (int a = 0; a < 2; ++a) { // decided for one: it is all there is
            const Interval own = value(a, 0), other = value(1 - a, 0);
            const double ahead = may_be_less ? other.lo - own.hi : own.lo - other.hi;
            if (!(ahead > reach)) continue;
            set(0, own, grad(a, 0));
            return finish(norm(a), any_odd);
        }
    Interval v = may_be_less ? min(x, y) + Interval(-reach / 4, 0) : max(x, y);
    if (may_be_greater) v = hull(v, max(x, y) + Interval(0, reach / 4));
    set(0, v, joined(grad(0, 0), grad(1, 0)));
    finish(std::max(norm(0), norm(1)), any_odd);
}

// Between the greater and log(2) more; a mean of the gradients.
void Step::log_sum() {
    const double most = up(in.op == Op::Log ? std::log(2.0) : 1.0, 4);
    set(0, max(value(0, 0), value(1, 0)) + Interval(0, most), joined(grad(0, 0), grad(1, 0)));
    finish(std::max(norm(0), norm(1)), any_odd);
}

void Step::dot() {
    Interval v;
    Row g{};
    bool same = in.args[0] == in.args[1], odd_used = any_odd;
    if (same) odd_used = false;
    for (int c = 0; c < size(0); ++c) {
        if (same) {
            v += square(value(0, c));
            g = sum(g, scaled(Interval(2.0) * value(0, c), grad(0, c)));
        } else {
            v += value(0, c) * value(1, c);
            g = sum(g, sum(scaled(value(1, c), grad(0, c)), scaled(value(0, c), grad(1, c))));
        }
    }
    double a = machine.box_length(in.args[0]).hi, b = machine.box_length(in.args[1]).hi;
    set(0, v, g);
    finish(up(times(b, norm(0)) + times(a, norm(1))), odd_used);
}

void Step::cross() {
    for (int c = 0; c < 3; ++c) {
        int i = (c + 1) % 3, j = (c + 2) % 3;
        Row g = sum(
            sum(scaled(value(1, j), grad(0, i)), scaled(value(0, i), grad(1, j))),
            scaled(-1.0, sum(scaled(value(1, i), grad(0, j)), scaled(value(0, j), grad(1, i)))));
        set(c, value(0, i) * value(1, j) - value(0, j) * value(1, i), g);
    }
    double a = machine.box_length(in.args[0]).hi, b = machine.box_length(in.args[1]).hi;
    finish(up(times(b, norm(0)) + times(a, norm(1))), any_odd);
}

// J = (I - n n^T) J_q / |q|
void Step::normalize() {
    Interval length = machine.box_length(in.args[0]);
    const bool is_no_number = in.divides && norm(0) == 0 && length.lo < min_single;
    bool singular = is_no_number || (length.lo <= 0 && norm(0) > 0);
    Interval unit[4];
    for (int c = 0; c < n; ++c)
        unit[c] = length.lo > 0 ? meet(Interval(-1, 1), value(0, c) / length) : Interval(-1, 1);
    for (int c = 0; c < n; ++c) {
        Row g{};
        if (!singular && norm(0) > 0)
            for (std::size_t j = 0; j < 3; ++j) {
                Interval along;
                for (int k = 0; k < n; ++k) along += unit[k] * grad(0, k)[j];
                g[j] = (grad(0, c)[j] - unit[c] * along) / length;
            }
        set(c, unit[c], g);
    }
    if (singular) {
        fail(Trouble::Singular);
        if (is_no_number) machine.pole_[out] = 1;
        if (in.divides) machine.undefined_[out] = 1;
        return;
    }
    finish(norm(0) == 0 ? 0 : up(norm(0) / length.lo, 4), any_odd);
}

// matrix*vector, vector*matrix, matrix*matrix, column-major. d(Mv) = M dv + (dM) v.
void Step::multiply() {
    Slot a = in.args[0], b = in.args[1];
    int na = machine.tape_.size[a], nb = machine.tape_.size[b];
    bool left = na > nb || (na == nb && n == na),
         right = nb > na; // which is a matrix; both where sizes are equal
    bool both = na == nb;
    int side = both ? (na == 4 ? 2 : na == 9 ? 3 : 4) : left ? nb : na;
    int columns = both ? side : 1;
    auto entry = [&](Slot m, int row, int column) {
        return machine.tape_.first[m] + static_cast<std::uint32_t>(column * side + row);
    };
    for (int j = 0; j < columns; ++j)
        for (int i = 0; i < side; ++i) {
            Interval v;
            Row g{};
            for (int k = 0; k < side; ++k) {
                std::uint32_t x =
                    right ? machine.tape_.first[a] + static_cast<std::uint32_t>(k) : entry(a, i, k);
                std::uint32_t y = right  ? entry(b, k, i)
                                  : both ? entry(b, k, j)
                                         : machine.tape_.first[b] + static_cast<std::uint32_t>(k);
                v += machine.value_[x] * machine.value_[y];
                g = sum(g, sum(scaled(machine.value_[y], machine.grad_[x]),
                               scaled(machine.value_[x], machine.grad_[y])));
            }
            std::uint32_t o = at + static_cast<std::uint32_t>(j * side + i);
            machine.value_[o] = v;
            machine.grad_[o] = g;
            machine.odd_[o] = 0;
        }
    // |M dv| <= |M| |dv|, |(dM) v| <= |dM|_F |v|
    auto matrix_norm = [&](Slot m) {
        double middle[4][4], radius = 0, frobenius = 0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                Interval x = machine.value_[entry(m, i, j)];
                if (!x.finite()) return infinity;
                middle[i][j] = x.middle();
                radius += std::pow(std::max(x.hi - middle[i][j], middle[i][j] - x.lo), 2);
                frobenius += std::pow(x.magnitude(), 2);
            }
        if (side > 3) return up(std::sqrt(frobenius), 8);
        Row as_rows[3];
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < 3; ++j)
                as_rows[i][static_cast<std::size_t>(j)] =
                    j < side ? Interval(middle[i][j]) : Interval(0.0);
        return up(std::min(spectral_norm(as_rows, side) + std::sqrt(radius), std::sqrt(frobenius)),
                  8);
    };
    double rule;
    if (both)
        rule =
            up(times(matrix_norm(b), machine.norm_[a]) + times(matrix_norm(a), machine.norm_[b]));
    else {
        Slot m = left ? a : b, v = left ? b : a;
        rule = up(times(std::min(matrix_norm(m), in.norm), machine.norm_[v]) +
                  times(machine.box_length(v).hi, machine.norm_[m]));
    }
    finish(rule, any_odd);
}

} // namespace fathom::proof
