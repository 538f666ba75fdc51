#include "proof/inner_vectors.h"

#include "ir/passes/walk.h"
#include "proof/zones.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <unordered_set>

namespace fathom::proof {

using ir::rounding::times;
using ir::rounding::up;

namespace {

constexpr std::size_t max_coordinates = 28; // expressions that a vector may be made of
constexpr std::size_t max_affine_tries = 8, max_warped = 2, max_radial = 2;

// The components of a vector of which the expression is the square of the length; none where it is
// not seen to be one.
std::vector<NodeId> squared(ir::Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    const NodeId a = graph.args(id).empty() ? NodeId{} : graph.arg(id, 0);
    if (node.op == Op::Dot && a == graph.arg(id, 1)) {
        std::vector<NodeId> out;
        for (int c = 0; c < ir::components(graph[a].type); ++c)
            out.push_back(graph.component(a, c));
        return out;
    }
    if (node.type != ir::Type::Float) return {};
    if (node.op == Op::Mul && a == graph.arg(id, 1)) return {a};
    if (node.op == Op::Pow && graph.as_number(graph.arg(id, 1)) == 2.0) return {a};
    if (node.op != Op::Add) return {};
    std::vector<NodeId> out = squared(graph, a);
    if (out.empty() || out.size() > 2) return {};
    const std::vector<NodeId> more = squared(graph, graph.arg(id, 1));
    if (more.empty()) return {};
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

// … is the length.
std::vector<NodeId> measured(ir::Graph &graph, NodeId id) {
    const Op op = graph[id].op;
    if (op == Op::Sqrt) return squared(graph, graph.arg(id, 0));
    if (op != Op::Length) return {};
    const NodeId vector = graph.arg(id, 0);
    std::vector<NodeId> out;
    for (int c = 0; c < ir::components(graph[vector].type); ++c)
        out.push_back(graph.component(vector, c));
    return out;
}

} // namespace

Inners::Inners(ir::Graph &graph, ReadThrough &read, NodeId root)
    : graph_(graph), read_(read), root_(root) {
    if (!collect()) parts_.clear(), sums_.clear();
    std::ranges::sort(parts_); // what others are made of first
    parts_.resize(std::min(parts_.size(), max_coordinates));
    std::ranges::reverse(parts_);
    std::ranges::sort(warped_);
    std::ranges::reverse(warped_);
    std::ranges::sort(sums_);
}

std::vector<Inner> Inners::affine() {
    std::vector<Inner> out;
    choose([&](NodeId id) { return read_.below(id).is_affine; }, max_affine_tries, out);
    return out;
}

std::vector<Inner> Inners::folded() {
    std::vector<Inner> out;
    choose([&](NodeId id) { return is_affine_op(graph_[id].op); }, 1, out);
    choose([](NodeId) { return true; }, 2, out);
    return out;
}

std::vector<Inner> Inners::warped() {
    std::vector<Inner> out;
    for (const NodeId id : warped_)
        if (out.size() < max_warped) try_these({id}, out);
    return out;
}

// Coordinates and what is not made of folds.
bool Inners::is_warped(NodeId id) {
    const ir::Node node = graph_[id];
    if (node.op != Op::Add && node.op != Op::Sub) return false;
    for (int i = 0; i < 2; ++i)
        if (read_.below(graph_.arg(id, i)).is_affine && graph_.reads(graph_.arg(id, 1 - i)).point)
            return true;
    return false;
}

// Moved, turned and folded coordinates below the root; false where there is too much to look at.
bool Inners::collect() {
    std::vector<NodeId> todo{root_};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !graph_.reads(id).point || !seen.insert(id).second) continue;
        if (seen.size() > max_nodes_composed) return false;
        if (read_.is_coordinates(id)) continue;
        const ir::Type type = graph_[id].type;
        const bool fits =
            type == ir::Type::Float || type == ir::Type::Vec2 || type == ir::Type::Vec3;
        if (fits && id != root_ && !graph_.reads(id).free_vars && read_.below(id).is_fold) {
            parts_.push_back(id);
        } else if (ir::is_vector(type) && fits && id != root_ && !graph_.reads(id).free_vars &&
                   is_warped(id)) {
            warped_.push_back(id);
        }
        constexpr ir::OpSet distances{Op::Length, Op::Sqrt, Op::Dot, Op::Add};
        if (distances[graph_[id].op] && type == ir::Type::Float && id != root_ &&
            !graph_.reads(id).free_vars)
            sums_.push_back(id);
        todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
        if (graph_[id].op != Op::Loop) continue;
        const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[id].payload});
        todo.insert(todo.end(), loop.next.begin(), loop.next.end());
        todo.insert(todo.end(), {loop.count, loop.condition});
    }
    return true;
}

// Adds vectors that are made of such parts, while there are fewer than `most`.
void Inners::choose(const std::function<bool(NodeId)> &is_such, std::size_t most,
                    std::vector<Inner> &out) {
    std::vector<NodeId> may;
    std::ranges::copy_if(parts_, std::back_inserter(may), is_such);
    const auto size = [&](NodeId id) { return ir::components(graph_[id].type); };
    std::vector<NodeId> chosen;
    const auto add = [&](auto &&self, std::size_t from, int left) -> void {
        if (!chosen.empty() && try_these(chosen, out)) return;
        for (std::size_t i = from; i < may.size() && left > 0 && out.size() < most; ++i) {
            if (size(may[i]) > left) continue;
            chosen.push_back(may[i]);
            self(self, i + 1, left - size(may[i]));
            chosen.pop_back();
        }
    };
    add(add, 0, 3);
}

bool Inners::try_these(const std::vector<NodeId> &chosen, std::vector<Inner> &out) {
    int size = 0;
    unsigned own = 0;
    for (const NodeId id : chosen) {
        size += ir::components(graph_[id].type);
        own |= read_.below(id).coordinates;
    }
    const unsigned beside = read_.beside({root_}, {chosen.begin(), chosen.end()});
    if ((own & beside) != 0 || size > std::popcount(own)) return false;
    Inner inner;
    const NodeId point = graph_.point();
    for (int axis = 0; axis < 3; ++axis)
        if (beside >> axis & 1) inner.components[std::size_t(axis)] = graph_.component(point, axis);
    std::size_t axis = 0;
    for (const NodeId id : chosen)
        for (int c = 0; c < ir::components(graph_[id].type); ++c) {
            while (inner.components[axis]) ++axis;
            inner.components[axis] =
                graph_[id].type == ir::Type::Float ? id : graph_.component(id, c);
        }
    inner.replaced = chosen;
    for (const Inner &other : out)
        if (other.components == inner.components) return true;
    out.push_back(std::move(inner));
    return true;
}

std::vector<Inner> Inners::radial() {
    struct Distance {
        std::vector<NodeId> of, lengths, squares;
    };
    std::vector<Distance> all;
    for (const NodeId id : sums_) {
        std::vector<NodeId> of = measured(graph_, id);
        const bool is_length = !of.empty();
        if (!is_length) of = squared(graph_, id);
        if (of.size() < 2 || of.size() > 3) continue;
        if (!std::ranges::all_of(of, [&](NodeId part) { return read_.below(part).is_fold; }))
            continue;
        std::ranges::sort(of);
        auto same = std::ranges::find(all, of, &Distance::of);
        if (same == all.end()) same = all.insert(all.end(), {of, {}, {}});
        (is_length ? same->lengths : same->squares).push_back(id);
    }
    std::vector<Inner> out;
    for (const Distance &distance : all) {
        std::unordered_set<NodeId> nodes(distance.lengths.begin(), distance.lengths.end());
        nodes.insert(distance.squares.begin(), distance.squares.end());
        unsigned own = 0;
        for (const NodeId part : distance.of) own |= read_.below(part).coordinates;
        const unsigned beside = read_.beside({root_}, nodes);
        if ((own & beside) != 0 || std::popcount(own) < 2 || out.size() >= max_radial) continue;
        Inner inner;
        const NodeId point = graph_.point();
        for (int axis = 0; axis < 3; ++axis)
            if (beside >> axis & 1)
                inner.components[std::size_t(axis)] = graph_.component(point, axis);
        const NodeId vector =
            graph_.make(Op::Make, ir::vector_type(int(distance.of.size())), distance.of);
        inner.distance = graph_.make(Op::Length, {vector});
        *std::ranges::find(inner.components, NodeId{}) = inner.distance;
        inner.lengths = distance.lengths, inner.squares = distance.squares;
        out.push_back(std::move(inner));
    }
    return out;
}

// `root` with the point in the place of the vector.
NodeId seen_from(ir::Graph &graph, NodeId root, const Inner &inner) {
    ir::Substitution map;
    const NodeId point = graph.point();
    for (const NodeId id : inner.replaced) {
        std::vector<NodeId> parts;
        for (int c = 0; c < ir::components(graph[id].type); ++c) {
            const NodeId part = graph[id].type == ir::Type::Float ? id : graph.component(id, c);
            for (int axis = 0; axis < 3; ++axis)
                if (inner.components[std::size_t(axis)] == part) {
                    parts.push_back(graph.component(point, axis));
                    break;
                }
        }
        map[id] = parts.size() == 1 ? parts[0] : graph.make(Op::Make, graph[id].type, parts);
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (!inner.distance || inner.components[std::size_t(axis)] != inner.distance) continue;
        const NodeId distance = graph.component(point, axis);
        for (const NodeId id : inner.lengths) map[id] = distance;
        for (const NodeId id : inner.squares) map[id] = graph.mul(distance, distance);
    }
    return ir::substitute(graph, root, map);
}

Image image_of(Flattening &context, const Ranges &ranges, NodeId vector, double slope,
               const Domain &domain) {
    Image out;
    const auto to = range_of(context, ranges, vector, domain.box);
    for (std::size_t i = 0; i < 3; ++i) out.box.p[i] = to[i];
    Cell middle;
    Interval radius;
    if (domain.zone && domain.zone->kind == ir::RegionKind::Ball) {
        for (std::size_t i = 0; i < 3; ++i) middle.p[i] = domain.zone->center[i];
        radius = domain.zone->half[0].hi;
        if (!domain.zone->less.empty()) return out; // the way around a hole is longer
    } else {
        Interval square_of;
        for (std::size_t i = 0; i < 3; ++i) {
            middle.p[i] = domain.box.p[i].middle();
            square_of += square(domain.box.p[i] - middle.p[i]);
        }
        radius = sqrt(square_of).hi;
        if (domain.zone) return out;
    }
    for (std::size_t i = 0; i < 3; ++i) // the ways from the middle lie in the region
        if (!(domain.box.p[i].lo <= middle.p[i].lo && middle.p[i].hi <= domain.box.p[i].hi))
            return out;
    if (!radius.finite()) return out;
    const auto center = range_of(context, ranges, vector, middle);
    out.ball.kind = ir::RegionKind::Ball;
    for (std::size_t i = 0; i < 3; ++i) out.ball.center[i] = center[i];
    out.ball.half[0] = Interval(up(times(radius.hi, slope), 4));
    out.has_ball = true;
    const Cell around = outer_box(out.ball);
    for (std::size_t i = 0; i < 3; ++i) out.box.p[i] = meet(out.box.p[i], around.p[i]);
    return out;
}

} // namespace fathom::proof
