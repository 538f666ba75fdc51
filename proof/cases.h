// Inequalities of polynomials, as a proof by cases needs them: sums of products of atoms, their
// square roots where they are squares, and whether inequalities contradict each other. An atom is
// a number of which nothing else is known, by its index. Knows nothing of graphs.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace fathom::proof {

using Product = std::vector<std::uint32_t>; // atoms, sorted, repeats allowed
struct ByDegree {                           // the highest degree first; multiplying keeps the order
    bool operator()(const Product &a, const Product &b) const {
        return a.size() != b.size() ? a.size() > b.size() : a < b;
    }
};
using Sum = std::map<Product, double, ByDegree>;

Sum constant(double c);
Sum atom(std::uint32_t a);
Sum add(const Sum &a, const Sum &b, double times = 1);   // a + times*b
std::optional<Sum> multiply(const Sum &a, const Sum &b); // nothing where it would be very large
bool is_small(const Sum &a, const Sum &beside);          // term by term no more than float32
    // rounding of the terms of that degree in `beside`: to choose what is solved for
std::optional<double> as_constant(const Sum &a);
// s with s*s = a, or nothing. Its sign is either.
std::optional<Sum> root_of_square(const Sum &a);

// Of degree 2 at most: sums of degree 1 of whose squares, by factors above 0, it is the sum, perhaps
// with a number above 0 besides, so that it is never below 0 (Cholesky's way). What is at most
// `rounding` of all that was added up to it is nothing: where a sum is 0 its squares are, but a root turns
// an error e into sqrt(e).
// That number goes to `least`; what the square of each root is divided by, to `divisors`.
std::optional<std::vector<Sum>> squares_in(const Sum &a, double rounding, double *least = nullptr,
                                           std::vector<double> *divisors = nullptr);
bool is_sum_of_squares(const Sum &a);

// An atom that stands in one term alone and may be solved for, and what it is where sum = 0.
std::optional<std::pair<std::uint32_t, Sum>>
solved_for_atom(const Sum &sum, const std::function<bool(std::uint32_t)> &may = {});
// An atom a of which sum = 0 says (a - middle)^2 = square, a sum of squares.
struct Squared {
    std::uint32_t atom = 0;
    Sum middle, square;
};
std::optional<Squared> solved_for_square(const Sum &sum);
Sum with_atom(const Sum &sum, std::uint32_t a, const Sum &is); // as it is where that gets too large
// So that sums that are equal but for rounding have one key.
void add_to_key(std::vector<double> &key, const Sum &sum);

// a >= 0, or a > 0
struct Inequality {
    Sum sum;
    bool strict = false;
    double slack = 0; // of a strict one: what the sum may be above 0 and count as 0
    double size = 0;  // of the numbers that its own number is the sum of
};
// Is there certainly no point at which all hold? Products are taken for numbers of their own, of
// which `never_negative` are at least 0: true is a proof (of Fourier and Motzkin), false is none.
// Counts what it did in `steps`.
bool contradict(std::vector<Inequality> all, const std::vector<Product> &never_negative,
                std::size_t &steps);

} // namespace fathom::proof
