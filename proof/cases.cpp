// Numbers are doubles. A term is left out where it is what double precision loses of its own summands
// alone: how large it is beside other terms hangs on what it multiplies, and is asked once, where a
// proof ends (enclosed.h).
#include "proof/cases.h"

#include "proof/enclosed.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom::proof {
namespace {

// granted: constants are floats, and people write 0.57735; lost_of_rows: of sums of many sums
constexpr double granted = 5e-7, lost_of_rows = 1e-12;
// written: what is left where numbers of 9 digits cancel; most_shift: … of coordinates that they are
// taken off, whatever they are
constexpr double written = 5e-9, most_shift = 2e-9;
// a root turns an error e into sqrt(e)
constexpr double lost_of_squares = 1e-11, granted_to_squares = 1e-10;
constexpr std::size_t max_terms_of_cases = 60, max_degree_of_cases = 8, max_inequalities = 160;

// Of a sum whose terms are added up from terms of these sizes.
void drop_rounding(Sum &a, const Sum &sizes, double lost) {
    std::erase_if(a, [&](const auto &term) {
        const auto size = sizes.find(term.first);
        return std::fabs(term.second) <= (size == sizes.end() ? 0 : lost * size->second);
    });
}
double slope(const Sum &a) { // the largest number that something stands beside
    double out = 0;
    for (const auto &[m, c] : a) out = std::max(out, m.empty() ? 0 : std::fabs(c));
    return out;
}
double largest(const Sum &a) {
    double out = 0;
    for (const auto &[m, c] : a) out = std::max(out, std::fabs(c));
    return out;
}

// positive*low - negative*high, in which `m` has left
Inequality without(const Inequality &low, const Inequality &high, const Product &m) {
    const double a = low.sum.at(m), b = -high.sum.at(m); // both above 0
    Inequality out{{}, low.strict || high.strict};
    Sum sizes;
    const auto take = [&](const Sum &sum, double by) {
        for (const auto &[k, c] : sum) {
            out.sum[k] += c * by;
            sizes[k] += std::fabs(c * by);
        }
    };
    take(low.sum, b);
    take(high.sum, a);
    out.sum.erase(m);
    out.size = low.size * b + high.size * a;
    out.slack = low.slack * b + high.slack * a;
    drop_rounding(out.sum, sizes, lost_of_rows);
    return out;
}

// Every coefficient at most 1, so that rounding is measured alike.
bool is_number(const Inequality &row) {
    return row.sum.empty() || (row.sum.size() == 1 && row.sum.begin()->first.empty());
}
void normalize(Inequality &row) {
    const double size = largest(row.sum);
    if (!is_number(row))
        for (auto &[m, c] : row.sum) c /= size;
    if (!is_number(row)) row.size /= size, row.slack /= size;
}
bool is_false(const Inequality &row) {
    const double c = row.sum.empty() ? 0 : row.sum.begin()->second;
    return row.strict ? c <= row.slack + lost_of_rows * row.size : c < -granted * row.size;
}

} // namespace

Sum constant(double c) { return c == 0 ? Sum{} : Sum{{{}, c}}; }
Sum atom(std::uint32_t a) { return Sum{{{a}, 1.0}}; }

Sum add(const Sum &a, const Sum &b, double times) {
    Sum out = a;
    bool shifts = false;
    for (const auto &[m, c] : b) {
        double &to = out[m];
        const double size = std::fabs(to) + std::fabs(times * c);
        to += times * c;
        shifts = shifts || (m.empty() && std::fabs(to) <= written * size);
        if (std::fabs(to) <= lost_by_doubles * size) out.erase(m);
    }
    // a corner whose coordinates are written with 9 digits
    if (shifts && out.contains({}) && std::fabs(out[{}]) <= most_shift * std::min(1.0, slope(out)))
        out.erase(Product{});
    return out;
}

std::optional<Sum> multiply(const Sum &a, const Sum &b) {
    Sum out, sizes;
    for (const auto &[m, x] : a)
        for (const auto &[k, y] : b) {
            Product product = m;
            product.insert(product.end(), k.begin(), k.end());
            std::sort(product.begin(), product.end());
            out[product] += x * y;
            sizes[product] += std::fabs(x * y);
            if (product.size() > max_degree_of_cases || out.size() > max_terms_of_cases) return {};
        }
    drop_rounding(out, sizes, lost_by_doubles);
    return out;
}

std::optional<double> as_constant(const Sum &a) {
    if (a.empty()) return 0.0;
    if (a.size() == 1 && a.begin()->first.empty()) return a.begin()->second;
    return {};
}

bool is_small(const Sum &a, const Sum &beside) {
    for (const auto &[m, c] : a) {
        double like = 0; // of the same degree: beside 1e13 y^8 a jump by 5 is one
        for (const auto &[k, x] : beside)
            if (k.size() == m.size()) like = std::max(like, std::fabs(x));
        if (std::fabs(c) > granted * like) return false;
    }
    return true;
}

// As on paper: the leading term's root, then term by term what twice that goes into the rest.
std::optional<Sum> root_of_square(const Sum &a) {
    if (a.empty()) return Sum{};
    const auto &[lead, c] = *a.begin();
    if (c < 0 || lead.size() % 2 != 0) return {};
    Product half;
    for (std::size_t i = 0; i < lead.size(); i += 2) {
        if (lead[i] != lead[i + 1]) return {};
        half.push_back(lead[i]);
    }
    const double first = std::sqrt(c);
    Sum root{{half, first}};
    for (int round = 0; round < 12; ++round) {
        const auto square = multiply(root, root);
        if (!square) return {};
        Sum rest = a, sizes;
        for (const auto &[m, x] : *square) rest[m] -= x;
        for (const auto &[m, x] : rest) sizes[m] = std::fabs(x);
        for (const auto &[m, x] : *square) sizes[m] += 2 * std::fabs(x);
        drop_rounding(rest, sizes, lost_of_squares);
        if (rest.empty()) return root;
        const auto &[m, x] = *rest.begin();
        Product term;
        std::set_difference(m.begin(), m.end(), half.begin(), half.end(), std::back_inserter(term));
        if (term.size() + half.size() != m.size() || root.contains(term)) return {};
        root[term] = x / (2 * first);
    }
    return {};
}

std::optional<std::vector<Sum>> squares_in(const Sum &a, double rounding, double *least,
                                           std::vector<double> *divisors) {
    std::vector<Sum> roots;
    Sum rest = a, sizes; // sizes: of all that was added up to each coefficient
    for (const auto &[m, c] : a) sizes[m] = std::fabs(c);
    const auto is_nothing = [&](const Product &m, double c) {
        return std::fabs(c) <= rounding * sizes[m];
    };
    for (;;) {
        std::erase_if(rest, [&](const auto &term) { return is_nothing(term.first, term.second); });
        if (rest.empty()) return roots;
        const Product lead = rest.begin()->first;
        if (lead.empty()) {
            const double number = rest.begin()->second;
            if (least) *least = number;
            return number >= 0 ? std::optional(roots) : std::nullopt;
        }
        // Some atom of the leading term has to stand as a square; where that is a product of many,
        // any atom.
        const auto is_square = [](const auto &term) {
            return term.first.size() == 2 && term.first[0] == term.first[1];
        };
        const auto other_lead = std::ranges::find_if(rest, is_square);
        if (lead.size() > 2 && other_lead == rest.end()) return {};
        const std::uint32_t x = lead.size() > 2 ? other_lead->first[0] : lead[0];
        const bool once = std::ranges::all_of(rest, [&](const auto &term) {
            return is_square(term) || std::ranges::count(term.first, x) <= 1;
        });
        if (!once) return {};
        const auto square = rest.find({x, x});
        if (square == rest.end() || square->second <= 0) return {};
        const double by = square->second;
        Sum root; // of the square to complete, times that of `by`
        for (const auto &[m, c] : rest) {
            if (std::find(m.begin(), m.end(), x) == m.end()) continue;
            Product other = m;
            other.erase(std::find(other.begin(), other.end(), x));
            root[other] = other == Product{x} ? c : c / 2;
        }
        const auto whole = multiply(root, root);
        if (!whole) return {};
        for (const auto &[m, c] : *whole) {
            rest[m] -= c / by;
            sizes[m] += std::fabs(c / by);
        }
        std::erase_if(rest, [&](const auto &term) {
            return std::find(term.first.begin(), term.first.end(), x) != term.first.end();
        });
        roots.push_back(std::move(root));
        if (divisors) divisors->push_back(by);
    }
}

bool is_sum_of_squares(const Sum &a) { return squares_in(a, granted_to_squares).has_value(); }

std::optional<std::pair<std::uint32_t, Sum>>
solved_for_atom(const Sum &sum, const std::function<bool(std::uint32_t)> &may) {
    for (const auto &[m, c] : sum) {
        if (m.size() != 1 || is_small(Sum{{m, c}}, sum)) continue;
        const std::uint32_t a = m[0];
        bool elsewhere = may && !may(a);
        for (const auto &[k, x] : sum)
            elsewhere = elsewhere || (k != m && std::find(k.begin(), k.end(), a) != k.end());
        if (elsewhere) continue;
        Sum is;
        for (const auto &[k, x] : sum)
            if (k != m) is[k] = -x / c;
        return std::pair(a, is);
    }
    return {};
}

std::optional<Squared> solved_for_square(const Sum &sum) {
    for (const auto &[square, by] : sum) {
        if (square.size() != 2 || square[0] != square[1]) continue;
        const std::uint32_t a = square[0];
        Sum once, rest; // what a is multiplied with, and what is without it
        bool is_quadratic = true;
        for (const auto &[m, c] : sum) {
            if (m == square) continue;
            Product other = m;
            const auto at = std::ranges::find(other, a);
            if (at == other.end()) {
                rest[m] = c;
                continue;
            }
            other.erase(at);
            once[other] = c;
            is_quadratic = is_quadratic && std::ranges::find(other, a) == other.end();
        }
        const Sum middle = add({}, once, -0.5 / by);
        const auto middle_squared = is_quadratic ? multiply(middle, middle) : std::nullopt;
        if (!middle_squared) continue;
        const Sum is = add(*middle_squared, rest, -1 / by);
        if (is_sum_of_squares(is)) return Squared{a, middle, is};
    }
    return {};
}

Sum with_atom(const Sum &sum, std::uint32_t a, const Sum &is) {
    Sum out;
    for (const auto &[m, k] : sum) {
        Sum term = constant(k);
        for (std::uint32_t f : m) {
            const auto product = multiply(term, f == a ? is : atom(f));
            if (!product) return sum;
            term = *product;
        }
        out = add(out, term);
    }
    return out;
}

void add_to_key(std::vector<double> &key, const Sum &sum) {
    key.push_back(double(sum.size()));
    for (const auto &[m, c] : sum) {
        key.push_back(double(m.size()));
        for (std::uint32_t a : m) key.push_back(a);
        int exponent = 0;
        const double mantissa = std::frexp(c, &exponent);
        key.push_back(std::ldexp(std::round(std::ldexp(mantissa, 44)), exponent - 44));
    }
}

bool contradict(std::vector<Inequality> all, const std::vector<Product> &never_negative,
                std::size_t &steps) {
    constexpr std::size_t of_term = 8; // each is looked up in a map
    for (const Product &m : never_negative) all.push_back({Sum{{m, 1.0}}, false});
    for (Inequality &row : all)
        if (const auto it = row.sum.find({}); it != row.sum.end()) row.size = std::fabs(it->second);
    for (;;) {
        std::map<Product, std::pair<std::size_t, std::size_t>, ByDegree> uses;
        std::vector<Inequality> open;
        for (Inequality &row : all) {
            steps += of_term * (row.sum.size() + 1);
            normalize(row);
            if (is_number(row)) {
                if (is_false(row)) return true;
                continue;
            }
            for (const auto &[m, c] : row.sum)
                if (!m.empty()) (c > 0 ? uses[m].first : uses[m].second) += 1;
            open.push_back(std::move(row));
        }
        if (open.empty()) return false;
        const auto next =
            std::min_element(uses.begin(), uses.end(), [](const auto &a, const auto &b) {
                return a.second.first * a.second.second < b.second.first * b.second.second;
            });
        const Product m = next->first;
        all.clear();
        std::vector<const Inequality *> lows,
            highs; // in which it is at least, and at most, something
        for (Inequality &row : open) {
            steps += of_term;
            const auto it = row.sum.find(m);
            if (it == row.sum.end())
                all.push_back(std::move(row));
            else
                (it->second > 0 ? lows : highs).push_back(&row);
        }
        if (all.size() + lows.size() * highs.size() > max_inequalities) return false;
        for (const Inequality *low : lows)
            for (const Inequality *high : highs) {
                all.push_back(without(*low, *high, m));
                steps += of_term * all.back().sum.size();
            }
    }
}

} // namespace fathom::proof
