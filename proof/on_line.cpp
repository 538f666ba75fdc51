#include "proof/on_line.h"

#include "proof/enclosed.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace fathom::proof {
namespace {

using ir::Interval;

constexpr double granted_on_lines = 5e-7, granted_to_rows = 1e-12;
constexpr int max_intervals = 8'000;

struct Line {
    const std::vector<LineAtom> &atoms;
    std::uint32_t t = 0;
    std::map<std::uint32_t, Interval> values{};

    Interval value(std::uint32_t a) {
        if (const auto it = values.find(a); it != values.end()) return it->second;
        const Interval v = sqrt(of(*atoms[a].below));
        return values[a] = v;
    }
    Interval of(const Product &m) {
        Interval out = 1.0;
        for (std::size_t i = 0; i < m.size();) {
            std::size_t k = i; // powers of one atom as such
            while (k < m.size() && m[k] == m[i]) ++k;
            const std::size_t n = k - i;
            Interval power = n % 2 == 1 ? value(m[i]) : Interval(1.0);
            for (std::size_t j = 0; j < n / 2; ++j) power = power * square(value(m[i]));
            out = out * power;
            i = k;
        }
        return out;
    }
    Interval of(const Sum &sum) {
        Interval out;
        for (const auto &[m, c] : sum) out += Interval(c) * of(m);
        const Interval cell = values[t];
        if (cell.is_point() || !is_polynomial(sum)) return out;
        // By the mean value theorem; near a double zero that is far less.
        const double middle = cell.middle();
        Line at{atoms, t, {{t, Interval(middle)}}};
        Interval centre, slope;
        for (const auto &[m, c] : sum) {
            centre += Interval(c) * at.of(m);
            if (m.empty()) continue;
            const Product less(m.begin() + 1, m.end());
            slope += Interval(c * double(m.size())) * of(less);
        }
        return meet(out, centre + slope * (cell - Interval(middle)));
    }
    bool is_polynomial(const Sum &sum) const { // in t
        return std::ranges::all_of(sum, [&](const auto &term) {
            return std::ranges::all_of(term.first, [&](std::uint32_t a) { return a == t; });
        });
    }
    double size(const Sum &sum) { // of its terms together, at least
        double out = 0;
        for (const auto &[m, c] : sum) out += std::fabs(c) * of(m).mignitude();
        return out;
    }
    double greatest(const Sum &sum) { // … and at most
        double out = 0;
        for (const auto &[m, c] : sum) out += std::fabs(c) * of(m).magnitude();
        return out;
    }
};

void atoms_of(const Sum &sum, std::set<std::uint32_t> &out) {
    for (const auto &[m, c] : sum) out.insert(m.begin(), m.end());
}

// The atom that all others are roots in; nothing where there is none with a range.
std::optional<std::uint32_t> the_one(const std::set<std::uint32_t> &used,
                                     const std::vector<LineAtom> &atoms) {
    for (std::uint32_t t : used) {
        if (!atoms[t].range) continue;
        const bool all = std::all_of(used.begin(), used.end(), [&](std::uint32_t a) {
            if (a == t) return true;
            if (!atoms[a].below) return false;
            std::set<std::uint32_t> below;
            atoms_of(*atoms[a].below, below);
            return below.empty() || below == std::set<std::uint32_t>{t};
        });
        if (all) return t;
    }
    return {};
}

// What the lesser of both is at most up to the cell's distance from 0: their terms may be far larger.
double size_near(const Interval &cell, const Sum &a, const Sum &b,
                 const std::vector<LineAtom> &atoms, std::uint32_t t) {
    const double distance = std::max(cell.magnitude(), distance_at(least_scale));
    Line line{atoms, t, {{t, Interval(-distance, distance)}}};
    const double least = std::min(line.of(a).magnitude(), line.of(b).magnitude());
    return std::min(least, most_size_at(cell.mignitude()));
}

} // namespace

bool agree_on_line(const std::vector<Sum> &rows, const Sum &a, const Sum &b,
                   const std::vector<LineAtom> &atoms, int &work) {
    std::set<std::uint32_t> used;
    for (const Sum &row : rows) atoms_of(row, used);
    atoms_of(a, used);
    atoms_of(b, used);
    const auto t = the_one(used, atoms);
    if (!t) return false;
    const Sum gap = add(a, b, -1);
    std::vector<Interval> todo{*atoms[*t].range};
    int looked = 0;
    while (!todo.empty()) {
        const Interval cell = todo.back();
        todo.pop_back();
        if (++looked > max_intervals || ++work > most_work_on_lines) return false;
        Line line{atoms, *t, {{*t, cell}}};
        const bool excluded = std::any_of(rows.begin(), rows.end(), [&](const Sum &row) {
            return line.of(row).hi < -granted_to_rows * line.greatest(row);
        });
        if (excluded) continue;
        const double terms = line.size(a) + line.size(b);
        if (!std::isfinite(terms)) return false;
        const double apart = line.of(gap).magnitude();
        if (apart <= lost_by_doubles * terms ||
            apart <= granted_on_lines * std::min(terms, size_near(cell, a, b, atoms, *t)))
            continue;
        const double middle = cell.middle();
        Line at{atoms, *t, {{*t, Interval(middle)}}};
        const bool holds = std::all_of(rows.begin(), rows.end(),
                                       [&](const Sum &row) { return at.of(row).lo >= 0; });
        if (holds && at.of(gap).mignitude() > granted_on_lines * (at.greatest(a) + at.greatest(b)))
            return false; // there they differ
        if (!(cell.lo < middle && middle < cell.hi)) return false;
        todo.push_back({cell.lo, middle});
        todo.push_back({middle, cell.hi});
    }
    return true;
}

} // namespace fathom::proof
