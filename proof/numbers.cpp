// Numbers and places as reports write them.
#include "proof/prover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::proof {

std::string number_text(double x) {
    if (std::isinf(x)) return x > 0 ? "infinity" : "-infinity";
    if (x == 0 || std::fabs(x) < 1e-12) return "0";
    return fmt::format("{:.3g}", x);
}
namespace {

// What is less than `nothing` is 0; `write` gives a number's text.
template <class Write>
std::string written_point(const std::array<double, 3> &p, int dims, double nothing, Write write) {
    std::string out = "[";
    for (std::size_t i = 0; i < static_cast<std::size_t>(dims); ++i)
        out += (i > 0 ? ", " : "") + write(std::fabs(p[i]) < nothing ? 0.0 : p[i]);
    return out + "]";
}

// What is nothing beside the others is the width of the cell where a search ended.
double width_of_cell(const std::array<double, 3> &p) {
    double largest = 0;
    for (const double x : p)
        if (std::isfinite(x)) largest = std::max(largest, std::fabs(x));
    return std::max(1e-6 * largest, 1e-7);
}

} // namespace

std::string point_text(const std::array<double, 3> &p, int dims) {
    return written_point(p, dims, width_of_cell(p), number_text);
}

std::pair<std::string, std::string> two_numbers(double a, double b) {
    constexpr int all_digits = 17;
    std::pair<std::string, std::string> out{number_text(a), number_text(b)};
    for (int digits = 4; digits <= all_digits && out.first == out.second; ++digits)
        out = {fmt::format("{:.{}g}", a, digits), fmt::format("{:.{}g}", b, digits)};
    return out;
}

std::pair<std::string, std::string> two_points(const std::array<double, 3> &a,
                                               const std::array<double, 3> &b, int dims) {
    constexpr int all_digits = 17;
    std::pair<std::string, std::string> out{point_text(a, dims), point_text(b, dims)};
    for (const double nothing : {std::min(width_of_cell(a), width_of_cell(b)), 0.0})
        for (int digits = 4; digits <= all_digits && out.first == out.second; ++digits) {
            const auto write = [&](double x) { return fmt::format("{:.{}g}", x, digits); };
            out = {written_point(a, dims, nothing, write), written_point(b, dims, nothing, write)};
        }
    return out;
}

} // namespace fathom::proof
