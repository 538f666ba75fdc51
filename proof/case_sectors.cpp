// Products of vectors and matrices in a proof by cases. Points that a fold turns into a sector about an
// axis: the sector's two borders are inequalities between their coordinates (docs/lipschitz.md, 2.1,
// Sectors).
#include "proof/case_search.h"
#include "proof/continuity.h"
#include "proof/forms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::proof {
namespace {

constexpr double half_turn = std::numbers::pi * (1 + 1e-7); // pi is written as a float

// Of the one step floor, ceil or round that an angle reads, and whose argument reads an angle of two
// coordinates: both.
struct Fold {
    NodeId step, whole;
};
std::optional<Fold> fold_in(const Graph &graph, NodeId angle) {
    constexpr ir::OpSet linear{Op::Add, Op::Sub, Op::Neg, Op::Mul, Op::Div},
        rounding{Op::Floor, Op::Ceil, Op::Round};
    std::optional<NodeId> step, whole;
    std::vector<NodeId> todo{angle};
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        const Op op = graph[id].op;
        std::optional<NodeId> *found = rounding[op] ? &step : op == Op::Atan2 ? &whole : nullptr;
        if (found && *found && *found != id) return {};
        if (found) *found = id;
        if (linear[op] || rounding[op])
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return step && whole ? std::optional(Fold{*step, *whole}) : std::nullopt;
}

// The angle of (x, y), or of (x, -y), and c, that a turn by c of it brings it to.
struct TurnedPoint {
    NodeId x, y;
    double mirrored = 1;
    NodeId by;
};
std::optional<TurnedPoint> turned_point(Graph &graph, NodeId product) {
    if (graph[product].op != Op::MatMul || graph[product].type != ir::Type::Vec2) return {};
    const NodeId turn = graph.arg(product, 0), point = graph.arg(product, 1);
    if (graph[turn].op != Op::Make) return {};
    const NodeId cosine = graph.arg(turn, 0), sine = graph.arg(turn, 1), back = graph.arg(turn, 2);
    if (graph[cosine].op != Op::Cos || graph[sine].op != Op::Sin || graph[back].op != Op::Neg ||
        graph.arg(back, 0) != sine || graph.arg(turn, 3) != cosine ||
        graph.arg(cosine, 0) != graph.arg(sine, 0))
        return {};
    NodeId y = component_of(graph, point, 1);
    const bool mirrored = graph[y].op == Op::Neg;
    if (mirrored) y = graph.arg(y, 0);
    return TurnedPoint{component_of(graph, point, 0), y, mirrored ? -1.0 : 1.0,
                       graph.arg(cosine, 0)};
}

} // namespace

// With A the angle of (x, y), the product lies at s A + c + k step(t), t = a A + b. Where s + k a = 0
// that is c + k (b - rest) with rest = t - step(t), in 0..1, -1..0 or -1/2..1/2.
std::optional<Interval> Cases::sector_of(NodeId product) {
    const auto point = turned_point(graph_, product);
    const auto fold = point ? fold_in(graph_, point->by) : std::nullopt;
    if (!fold || !same(graph_, graph_.arg(fold->whole, 0), point->y) ||
        !same(graph_, graph_.arg(fold->whole, 1), point->x))
        return {};
    const auto turn = linear_in(graph_, point->by, fold->step);
    const auto argument = linear_in(graph_, graph_.arg(fold->step, 0), fold->whole);
    if (!turn || !argument) return {};
    const auto c = number_of(graph_, turn->rest), b = number_of(graph_, argument->rest);
    if (!c || !b) return {};
    const double k = turn->by, a = argument->by;
    const double left = std::fabs(point->mirrored + k * a); // of A: constants are floats
    if (left > 1e-6) return {};
    const Op op = graph_[fold->step].op;
    const Interval rest = op == Op::Floor  ? Interval(0, 1)
                          : op == Op::Ceil ? Interval(-1, 0)
                                           : Interval(-0.5, 0.5);
    const Interval out = Interval(*c) + Interval(k) * (Interval(*b) - rest) +
                         Interval(left) * Interval(-std::numbers::pi, std::numbers::pi);
    return out.width() <= half_turn ? std::optional(out) : std::nullopt;
}

void Cases::add_sectors(std::vector<Inequality> &rows, const Case &c) const {
    for (std::uint32_t x = 0; x < atoms_.size(); ++x)
        for (std::uint32_t y = 0; y < atoms_.size(); ++y) {
            if (!atoms_[x].sector || !atoms_[y].sector) continue;
            const Sector &first = *atoms_[x].sector, &second = *atoms_[y].sector;
            if (first.part != Sector::X || second.part == Sector::X || first.of != second.of)
                continue;
            const auto [lo, hi] = first.angle;
            const auto at_least_0 = [&](double by_x, double by_y) {
                const Sum row = add(add({}, atom(x), by_x), atom(y), by_y);
                rows.push_back({reduced(row, c), false});
            };
            if (second.part == Sector::Y) {
                at_least_0(std::sin(hi), -std::cos(hi)); // r sin(hi - angle)
                at_least_0(-std::sin(lo), std::cos(lo)); // r sin(angle - lo)
            } else if (const double most = std::max(-lo, hi); most <= half_turn) {
                at_least_0(std::sin(most), -std::cos(most)); // r sin(most - |angle|)
            }
        }
}

// The product of a vector and a matrix of numbers; any other is a function of which nothing is known.
std::optional<Sum> Cases::turned(NodeId id, int i) {
    const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
    const bool left = ir::is_matrix(graph_[a].type);
    const NodeId matrix = left ? a : b, vector = left ? b : a;
    Sum sum;
    for (int k = 0; k < ir::side(graph_[matrix].type); ++k) {
        const auto entry = left ? entry_of(graph_, matrix, i, k) : entry_of(graph_, matrix, k, i);
        const auto m = entry ? graph_.as_number(*entry) : std::nullopt;
        if (!m || !std::isfinite(*m)) return unknown(id, i);
        met_product_ = true;
        if (!tries_.products) return unknown(id, i);
        const auto x = value(vector, k);
        if (!x) return {};
        sum = add(sum, *x, *m);
    }
    return sum;
}

std::optional<Sum> Cases::cross(NodeId id, int i) {
    const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto aj = value(a, j), ak = value(a, k), bj = value(b, j), bk = value(b, k);
    if (!aj || !ak || !bj || !bk) return {};
    const auto x = times(*aj, *bk), y = times(*ak, *bj);
    if (!x || !y) return {};
    return add(*x, *y, -1);
}

} // namespace fathom::proof
