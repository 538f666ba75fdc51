// Quotients by numbers that are the same for all points, in a proof by cases: 1/b is an atom of which
// the product with b is 1, so that sums of products stay sums of products (docs/lipschitz.md, 2.1,
// Inverses).
#include "proof/case_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom::proof {
namespace {

// The atoms that stand in every product of a sum, and what is left of it without them.
std::pair<Product, Sum> factored(const Sum &sum) {
    Product common = sum.begin()->first;
    for (const auto &[m, c] : sum) {
        Product both;
        std::ranges::set_intersection(common, m, std::back_inserter(both));
        common = std::move(both);
    }
    Sum rest;
    for (const auto &[m, c] : sum) {
        Product other;
        std::ranges::set_difference(m, common, std::back_inserter(other));
        rest[other] = c;
    }
    return {std::move(common), std::move(rest)};
}

// q with q b = a, by dividing leading terms as on paper, or nothing.
std::optional<Sum> exact_quotient(const Sum &a, const Sum &b) {
    constexpr int most_terms = 12;
    const auto &[lead, c] = *b.begin();
    Sum rest = a, out;
    for (int round = 0; round < most_terms && !rest.empty(); ++round) {
        const auto &[m, x] = *rest.begin();
        if (!std::ranges::includes(m, lead)) return {};
        Product other;
        std::ranges::set_difference(m, lead, std::back_inserter(other));
        const Sum term{{other, x / c}};
        const auto product = multiply(term, b);
        if (!product) return {};
        out = add(out, term);
        rest = add(rest, *product, -1);
    }
    return rest.empty() ? std::optional(out) : std::nullopt;
}

int sign_of(const Interval &range) { return range.lo > 0 ? 1 : range.hi < 0 ? -1 : 0; }

} // namespace

std::optional<Interval> Cases::halved_range_of(const Sum &sum) const {
    constexpr int most_halvings = 8;
    std::vector<Atom> atoms = atoms_;
    const auto within = [&](const auto &self, int halvings) -> std::optional<Interval> {
        looked_.take(4 * (sum.size() + 1));
        const auto range = range_of(sum, atoms);
        if (!range || sign_of(*range) != 0 || halvings == 0) return range;
        std::optional<std::uint32_t> widest;
        for (const auto &[m, c] : sum)
            for (std::uint32_t a : m)
                if (!widest || atoms[a].range->width() > atoms[*widest].range->width()) widest = a;
        if (!widest) return range;
        const Interval all = *atoms[*widest].range;
        const double middle = all.lo / 2 + all.hi / 2;
        atoms[*widest].range = Interval(all.lo, middle);
        const auto low = self(self, halvings - 1);
        atoms[*widest].range = Interval(middle, all.hi);
        const auto high = low ? self(self, halvings - 1) : std::nullopt;
        atoms[*widest].range = all;
        return high ? std::optional(hull(*low, *high)) : std::nullopt;
    };
    return within(within, most_halvings);
}

int Cases::held_sign(const Sum &sum) const {
    if (sum.empty() || !is_held(sum)) return 0;
    const auto range = halved_range_of(sum);
    return range ? sign_of(*range) : 0;
}

std::optional<Sum> Cases::inverse(const Sum &b) {
    if (b.empty() || !is_held(b)) return {};
    const auto [common, rest] = factored(b);
    Sum out = constant(1 / rest.begin()->second);
    const auto take = [&](const Sum &factor) { // of which the first number is 1
        const auto range = halved_range_of(factor);
        if (!range || sign_of(*range) == 0) return false;
        Atom about;
        about.held = true;
        about.range = Interval(1) / *range;
        about.never_negative = range->lo > 0;
        about.inverse_of = factor;
        AtomKey key{-7.0};
        add_to_key(key, factor);
        const auto product = times(out, atom(atom_of(std::move(key), about)));
        if (product) out = *product;
        return product.has_value();
    };
    for (std::uint32_t a : common)
        if (!take(atom(a))) return {};
    if (!as_constant(rest) && !take(add({}, rest, 1 / rest.begin()->second))) return {};
    return out;
}

Sum Cases::cleared(const Sum &sum) {
    constexpr int most_inverses = 8;
    if (!by_inverses_) return sum;
    const auto normal = times(sum, constant(1));
    if (!normal) return sum;
    Sum out = *normal;
    for (int round = 0; round < most_inverses; ++round) {
        std::optional<std::uint32_t> inverse; // the latest: it may be that of what holds others
        for (const auto &[m, c] : out)
            for (std::uint32_t a : m)
                if (atoms_[a].inverse_of && (!inverse || a > *inverse)) inverse = a;
        if (!inverse) break;
        const Sum by = *atoms_[*inverse].inverse_of;
        const auto product = times(out, reduced(by, case_));
        if (!product) break;
        out = atoms_[*inverse].never_negative ? *product : add({}, *product, -1);
    }
    if (out.empty()) return out;
    return without_held_factor(out);
}

Sum Cases::without_held_factor(const Sum &sum) const {
    using Parts =
        std::map<Product, Sum, ByDegree>; // by what is not held: what it is multiplied with
    Parts parts;
    for (const auto &[m, c] : sum) {
        Product held, moving;
        for (std::uint32_t a : m) (atoms_[a].held ? held : moving).push_back(a);
        parts[moving][held] = c;
    }
    if (parts.begin()->first.empty()) return sum; // held itself
    const auto without = [&](const Sum &factor) {
        Parts out;
        const int sign = as_constant(factor) ? 0 : held_sign(factor);
        if (sign == 0) return false;
        for (const auto &[moving, held] : parts) {
            const auto part = exact_quotient(held, factor);
            if (!part) return false;
            out[moving] = add({}, *part, sign);
        }
        parts = std::move(out);
        return true;
    };
    const Sum simplest = std::ranges::min_element(parts, {}, [](const auto &part) {
                             return part.second.size();
                         })->second;
    if (!without(simplest)) without(factored(simplest).second);
    Sum out;
    for (const auto &[moving, held] : parts) {
        const auto product = multiply(held, Sum{{moving, 1.0}});
        if (!product) return sum;
        out = add(out, *product);
    }
    return out;
}

bool Cases::is_square(const Sum &sum) {
    return by_inverses_ && root_by_roots(cleared(sum)).has_value();
}

std::optional<Sum> Cases::root_by_roots(const Sum &square) const {
    if (auto root = root_of_square(square)) return root;
    for (std::uint32_t a = 0; a < atoms_.size(); ++a) {
        if (!atoms_[a].square || atoms_[a].square->size() < 2) continue;
        looked_.take(16 * (square.size() + 1));
        if (auto root = root_of_square(with_square(square, a, *atoms_[a].square))) return root;
    }
    return {};
}

void Cases::add_pairs(std::vector<Inequality> &rows) {
    constexpr std::size_t most_terms = 3, most_rows = 8;
    std::vector<Sum> simple;
    for (std::size_t i = 0, known = rows.size(); i < known; ++i) {
        const Sum sum = rows[i].sum; // a copy: rows are added
        if (sum.empty() || sum.size() > most_terms || sum.begin()->first.size() != 1) continue;
        if (simple.size() < most_rows) simple.push_back(sum);
        for (const auto &[m, c] : sum) {
            if (c <= 0 || m.size() != 1 || !atoms_[m[0]].square) continue;
            const Sum root{{m, c}}, less = add(root, sum, -1);
            if (less.empty() || !std::ranges::all_of(less, [&](const auto &term) {
                    return term.second > 0 && (term.first.empty() || never_negative(term.first));
                }))
                continue;
            const auto more = times(root, root), squared = more ? times(less, less) : std::nullopt;
            if (!squared) continue;
            rows.push_back({cleared(add(*more, *squared, -1)), rows[i].strict});
            const auto &[other, times_other] = *less.begin(); // another root, with a least number?
            double least = 0;
            if (less.size() == 1 && other.size() == 1 && atoms_[other[0]].square &&
                squares_in(*atoms_[other[0]].square, 0, &least) && least > 0) {
                const Sum number = constant(least * times_other * times_other);
                rows.push_back({cleared(add(*more, number, -1)), rows[i].strict});
            }
        }
    }
    for (std::size_t i = 0; i < simple.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (const auto product = times(simple[i], simple[k]))
                rows.push_back({cleared(*product), false});
    add_ranges(rows);
}

void Cases::add_least_roots(std::vector<Inequality> &rows, const Case &c) {
    constexpr double lost = 1e-9;
    constexpr std::size_t most_parts = 3;
    std::set<std::uint32_t> roots;
    for (const Inequality &row : rows)
        for (const auto &[m, k] : row.sum)
            if (m.size() == 1 && atoms_[m[0]].square) roots.insert(m[0]);
    for (const std::uint32_t r : roots) {
        const Sum square = reduced(*atoms_[r].square, c);
        double least = 0;
        looked_.take(16 * (square.size() + 1));
        std::vector<double> divisors;
        const auto parts = square.empty() ? std::nullopt : squares_in(square, 0, &least, &divisors);
        if (!parts || parts->size() > most_parts) continue;
        if (least > lost)
            rows.push_back({add(atom(r), constant(std::sqrt(least) * (1 - lost)), -1), false});
        if (parts->size() < 2 && !(least > lost)) continue; // it is its part's size
        for (std::size_t i = 0; i < parts->size(); ++i)
            for (const double sign : {-1.0, 1.0}) {
                const double by = sign / std::sqrt(divisors[i]);
                rows.push_back({add(atom(r), (*parts)[i], by), false});
            }
    }
}

bool Cases::solve_by_inverse(const Sum &gap) {
    struct Linear {
        std::uint32_t u;
        Sum by, rest; // by*u + rest
    };
    std::vector<Linear> found;
    for (std::uint32_t u = 0; u < atoms_.size(); ++u) {
        if (atoms_[u].held) continue;
        Linear linear{u, {}, {}};
        bool once = true;
        for (const auto &[m, c] : gap) {
            const auto uses = std::ranges::count(m, u);
            once = once && uses <= 1;
            Product other = m;
            if (uses > 0) other.erase(std::ranges::find(other, u));
            (uses > 0 ? linear.by : linear.rest)[other] = c;
        }
        if (once && !linear.by.empty() && is_held(linear.by)) found.push_back(std::move(linear));
    }
    // the simplest inverse first
    std::ranges::stable_sort(found, {}, [](const Linear &one) { return one.by.size(); });
    for (const Linear &one : found) {
        const auto over = inverse(one.by);
        auto is = over ? times(add({}, one.rest, -1), *over) : std::nullopt;
        if (!is) continue;
        case_.solved.emplace_back(one.u, std::move(*is));
        return true;
    }
    return false;
}

std::optional<Sum> Cases::root_over_inverses(const Sum &below) {
    Sum square = below, over = constant(1);
    for (const auto &[m, c] : below)
        for (std::uint32_t a : m) {
            if (!atoms_[a].inverse_of || over.begin()->first == Product{a}) continue;
            if (!as_constant(over)) return {}; // of one inverse alone
            over = atom(a);
        }
    if (as_constant(over)) return {};
    const std::uint32_t inverse = over.begin()->first[0];
    const Sum by = reduced(*atoms_[inverse].inverse_of, case_);
    for (int k = 0; k < 2; ++k) {
        const auto product = times(square, by);
        if (!product) return {};
        square = *product;
    }
    const auto root = root_by_roots(square);
    return root ? times(*root, over) : std::nullopt;
}

} // namespace fathom::proof
