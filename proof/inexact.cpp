#include "proof/inexact.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <unordered_set>

namespace fathom::proof {
namespace {

using ir::NodeId;

struct Exact {
    double value;
    const char *text;
};
const std::array<Exact, 22> exact_numbers{{
    {std::numbers::sqrt3, "sqrt(3)"},
    {std::numbers::sqrt3 / 2, "sqrt(3) / 2"},
    {std::numbers::inv_sqrt3, "1 / sqrt(3)"},
    {2 * std::numbers::inv_sqrt3, "2 / sqrt(3)"},
    {(std::numbers::sqrt3 - 1) / 2, "(sqrt(3) - 1) / 2"},
    {(3 - std::numbers::sqrt3) / 6, "(3 - sqrt(3)) / 6"},
    {std::numbers::sqrt2, "sqrt(2)"},
    {std::numbers::sqrt2 / 2, "sqrt(2) / 2"},
    {std::numbers::sqrt2 - 1, "sqrt(2) - 1"},
    {std::numbers::phi, "(1 + sqrt(5)) / 2"},
    {std::cos(std::numbers::pi / 5), "cos(pi / 5)"},
    {std::sin(std::numbers::pi / 5), "sin(pi / 5)"},
    {std::tan(std::numbers::pi / 5), "tan(pi / 5)"},
    {std::cos(2 * std::numbers::pi / 5), "cos(2 * pi / 5)"},
    {std::sin(2 * std::numbers::pi / 5), "sin(2 * pi / 5)"},
    {std::cos(std::numbers::pi / 8), "cos(pi / 8)"},
    {std::sin(std::numbers::pi / 8), "sin(pi / 8)"},
    {std::numbers::pi, "pi"},
    {2 * std::numbers::pi, "tau"},
    {std::numbers::pi / 3, "pi / 3"},
    {std::numbers::pi / 4, "pi / 4"},
    {std::numbers::pi / 6, "pi / 6"},
}};

// With three decimals or more, of which the last may be off by one.
const Exact *exact_for(double x) {
    constexpr double enough = 1e-7; // of itself: what single precision keeps
    for (const Exact &exact : exact_numbers) {
        const double off = std::fabs(x - exact.value);
        if (off <= enough * exact.value) return nullptr;
        if (off > 2e-3 * exact.value) continue;
        for (int decimals = 2; decimals <= 7; ++decimals) {
            const double unit = std::pow(10, -decimals), count = x / unit;
            if (std::fabs(count - std::round(count)) > 1e-6 * count || x < 100 * unit) continue;
            return off <= unit ? &exact : nullptr;
        }
    }
    return nullptr;
}

} // namespace

std::optional<Inexact> inexact_number(const ir::Graph &graph, const std::vector<NodeId> &roots) {
    std::optional<Inexact> out;
    double most = 0;
    std::vector<NodeId> todo = roots;
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        if (graph[id].op == ir::Op::Call)
            todo.push_back(graph.function(ir::FunctionId{graph[id].payload}).result);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        if (!graph.is_constant(id)) continue;
        for (int i = 0; i < ir::components(graph[id].type); ++i) {
            const double x = std::fabs(graph.constant_of(id).value[static_cast<std::size_t>(i)]);
            const Exact *exact = exact_for(x);
            const double off = exact ? std::fabs(x / exact->value - 1) : 0;
            if (!(off > most)) continue;
            most = off;
            out =
                Inexact{fmt::format("{:.7g}", x), fmt::format("{:.9g}", exact->value), exact->text};
        }
    }
    return out;
}

} // namespace fathom::proof
