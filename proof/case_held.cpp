// Numbers that are the same for all points, params and what is made of them, in a proof by cases: their
// ranges, quotients by them, and borders that are a line for each of their values
// (docs/lipschitz.md, 2.1).
#include "proof/case_search.h"

#include <algorithm>

namespace fathom::proof {

std::optional<Interval> Cases::range_of(const Sum &of, const std::vector<Atom> &atoms) {
    Interval sum;
    for (const auto &[m, c] : of) {
        Interval term = c;
        for (std::size_t i = 0; i < m.size(); ++i) {
            const auto &range = atoms[m[i]].range;
            if (!range) return {};
            const bool twice = i + 1 < m.size() && m[i] == m[i + 1];
            term = term * (twice ? square(*range) : *range);
            i += twice;
        }
        sum += term;
    }
    return sum;
}

bool Cases::is_held(const Sum &sum) const {
    return std::ranges::all_of(sum, [&](const auto &term) {
        return std::ranges::all_of(term.first, [&](std::uint32_t a) { return atoms_[a].held; });
    });
}

std::optional<std::pair<std::uint32_t, Sum>> Cases::solved_for_moving(const Sum &sum) const {
    if (auto found = solved_for_atom(sum, [&](std::uint32_t a) { return !atoms_[a].held; }))
        return found;
    return by_inverses_ ? std::nullopt : solved_for_atom(sum);
}

std::optional<Sum> Cases::quotient(const Sum &a, const Sum &b) {
    if (b.size() != 1 || b.begin()->first.size() != 1) return {};
    const std::uint32_t d = b.begin()->first[0];
    const auto &below = atoms_[d].range;
    if (!atoms_[d].held || !below || below->contains(0)) return {};
    if (!is_held(a)) return {};
    Atom about;
    about.held = true;
    const Sum of = add({}, a, 1 / b.begin()->second);
    about.quotient = std::pair(d, of);
    if (const auto range = range_of(of, atoms_)) {
        about.range = *range / *below;
        about.never_negative = about.range->lo >= 0;
    }
    AtomKey key{-6.0, double(d)};
    add_to_key(key, of);
    return reduced(atom(atom_of(std::move(key), about)), case_);
}

bool Cases::solve_along_line(const Sum &gap) {
    std::vector<std::pair<std::uint32_t, Sum>> parts; // by an atom that is not held: its factor
    Sum rest;
    for (const auto &[m, c] : gap) {
        Product held;
        std::optional<std::uint32_t> moving;
        for (std::uint32_t a : m) {
            if (atoms_[a].held)
                held.push_back(a);
            else if (moving)
                return false;
            else
                moving = a;
        }
        if (!moving) {
            rest[held] = c;
            continue;
        }
        auto at = std::ranges::find(parts, *moving, [](const auto &part) { return part.first; });
        if (at == parts.end()) at = parts.insert(at, {*moving, Sum{}});
        at->second[held] = c;
    }
    const auto never_0 = [&](const Sum &held) {
        const auto range = range_of(held, atoms_);
        return range && !range->contains(0);
    };
    if (parts.size() != 2 || !(never_0(parts[0].second) || never_0(parts[1].second))) return false;
    // rest = A w, for one of the two
    const auto divided = [&](const Sum &by) -> std::optional<Sum> {
        if (rest.empty()) return Sum{};
        if (by.size() != 1) return {};
        const auto &[lead, c] = *by.begin();
        Sum out;
        for (const auto &[m, x] : rest) {
            if (!std::ranges::includes(m, lead)) return {};
            Product other;
            std::ranges::set_difference(m, lead, std::back_inserter(other));
            out[other] = x / c;
        }
        return out;
    };
    for (int k = 0; k < 2; ++k) {
        const auto &[u, a] = parts[std::size_t(k)];
        const auto &[v, b] = parts[std::size_t(1 - k)];
        const auto w = divided(a);
        if (!w) continue;
        const Sum t = atom(atom_of({-5.0, double(lines_++)}, Atom{}));
        const auto along = times(b, t), across = times(a, t);
        if (!along || !across) return false;
        case_.solved.emplace_back(u, add(add({}, *w, -1), *along, -1));
        case_.solved.emplace_back(v, *across);
        return true;
    }
    return false;
}

std::vector<std::uint32_t> Cases::add_ranges(std::vector<Inequality> &rows) const {
    std::vector<std::uint32_t> held; // that stand in a product with something
    std::vector<Product> powers;     // products of what is held
    for (const Inequality &row : rows)
        for (const auto &[m, c] : row.sum)
            if (by_inverses_ && m.size() > 1 && is_held(Sum{{m, c}})) powers.push_back(m);
    std::ranges::sort(powers);
    powers.erase(std::unique(powers.begin(), powers.end()), powers.end());
    for (const Inequality &row : rows)
        for (const auto &[m, c] : row.sum)
            for (std::uint32_t a : m)
                if ((m.size() > 1 || by_inverses_) && atoms_[a].held && atoms_[a].range)
                    held.push_back(a);
    std::ranges::sort(held);
    held.erase(std::unique(held.begin(), held.end()), held.end());
    for (std::uint32_t a : held) {
        rows.push_back({add(atom(a), constant(atoms_[a].range->lo), -1), false});
        rows.push_back({add(constant(atoms_[a].range->hi), atom(a), -1), false});
    }
    for (const Product &m : powers)
        if (const auto range = range_of(Sum{{m, 1.0}}, atoms_)) {
            rows.push_back({add(Sum{{m, 1.0}}, constant(range->lo), -1), false});
            rows.push_back({add(constant(range->hi), Sum{{m, 1.0}}, -1), false});
        }
    return held;
}

void Cases::add_products(std::vector<Inequality> &rows) const {
    constexpr std::size_t most = 40;
    const std::size_t known = rows.size();
    const std::vector<std::uint32_t> held = add_ranges(rows);
    for (std::size_t i = 0; i < known; ++i) {
        const Sum sum = rows[i].sum; // a copy: rows are added
        if (sum.size() > 3 || sum.empty() || sum.begin()->first.size() != 1) continue;
        for (std::uint32_t a : held) {
            if (rows.size() >= known + most) return;
            const Interval range = *atoms_[a].range;
            const auto product = multiply(sum, atom(a));
            if (!product) continue;
            rows.push_back({add(*product, sum, -range.lo), false});
            rows.push_back({add({}, add(*product, sum, -range.hi), -1), false});
        }
    }
}

} // namespace fathom::proof
