#include "proof/composed.h"

#include "ir/passes/inline.h"
#include "ir/passes/walk.h"
#include "proof/read_through.h"
#include "proof/zones.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>

namespace fathom::proof {
namespace {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

constexpr std::size_t max_nodes_composed = 700; // of a field that is looked into
constexpr std::size_t max_coordinates = 28;     // expressions that a vector may be made of
constexpr std::size_t max_affine_tries = 8, max_warped = 2;
constexpr std::size_t max_parts = 64;       // of a field
constexpr std::size_t max_work = 5'000'000; // for one field that is refused
// … that reads vectors to which noise is added, and no param: else it is asked for many of its values.
constexpr std::size_t max_work_moved = 10'000'000;
constexpr std::size_t max_work_loose = 500'000; // … that is not as flat as it might be
constexpr double loose_part = 1.3; // a bound over the slope seen, above which it is looked at
constexpr double as_flat = 1e-6;   // of a slope: what is rounded
constexpr double tight = 1.1; // a bound over the slope seen, with which no other vector is tried

// A vector that an expression reads the point through alone: its components by axis, of which
// those that are none stand still.
struct Inner {
    std::vector<NodeId> replaced;       // expressions, in the order of `components`
    std::array<NodeId, 3> components{}; // by axis
};

// The vectors of at most three components that `root` reads the point through.
class Inners {
  public:
    Inners(ir::Graph &graph, ReadThrough &read, NodeId root)
        : graph_(graph), read_(read), root_(root) {
        if (!collect()) parts_.clear();
        std::ranges::sort(parts_); // what others are made of first
        parts_.resize(std::min(parts_.size(), max_coordinates));
        std::ranges::reverse(parts_);
        std::ranges::sort(warped_);
        std::ranges::reverse(warped_);
    }

    // Of moved and turned coordinates: many, what is made of others first.
    std::vector<Inner> affine() {
        std::vector<Inner> out;
        choose([&](NodeId id) { return read_.below(id).is_affine; }, max_affine_tries, out);
        return out;
    }
    // Of what is made of folded ones, too: one whose last parts are sums, and the last of all.
    std::vector<Inner> folded() {
        std::vector<Inner> out;
        choose([&](NodeId id) { return is_affine_op(graph_[id].op); }, 1, out);
        choose([](NodeId) { return true; }, 2, out);
        return out;
    }
    // Of vectors that something else is added to, as noise: the largest.
    std::vector<Inner> warped() {
        std::vector<Inner> out;
        for (const NodeId id : warped_)
            if (out.size() < max_warped) try_these({id}, out);
        return out;
    }

  private:
    // coordinates and what is not made of folds
    bool is_warped(NodeId id) {
        const ir::Node node = graph_[id];
        if (node.op != Op::Add && node.op != Op::Sub) return false;
        for (int i = 0; i < 2; ++i)
            if (read_.below(graph_.arg(id, i)).is_affine &&
                graph_.reads(graph_.arg(id, 1 - i)).point)
                return true;
        return false;
    }

    // Moved, turned and folded coordinates below the root; false where there is too much to look at.
    bool collect() {
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
            todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
            if (graph_[id].op != Op::Loop) continue;
            const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[id].payload});
            todo.insert(todo.end(), loop.next.begin(), loop.next.end());
            todo.insert(todo.end(), {loop.count, loop.condition});
        }
        return true;
    }

    // Adds vectors that are made of such parts, while there are fewer than `most`.
    void choose(const std::function<bool(NodeId)> &is_such, std::size_t most,
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

    bool try_these(const std::vector<NodeId> &chosen, std::vector<Inner> &out) {
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
            if (beside >> axis & 1)
                inner.components[std::size_t(axis)] = graph_.component(point, axis);
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

    ir::Graph &graph_;
    ReadThrough &read_;
    NodeId root_;
    std::vector<NodeId> parts_, warped_;
};

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
    return ir::substitute(graph, root, map);
}

// Where a vector of slope `slope` takes a region: a box, and a ball about what the middle becomes.
struct Image {
    Cell box;
    Zone ball;
    bool has_ball = false;
    Domain domain() const { return {box, has_ball ? &ball : nullptr}; }
};
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

// Noise, and a hash as it is written by hand.
bool is_noise(const ir::Graph &graph, NodeId id) {
    constexpr ir::OpSet noise{Op::Perlin, Op::Simplex,   Op::ValueNoise,
                              Op::Worley, Op::SpotNoise, Op::Hash};
    if (noise[graph[id].op]) return true;
    if (graph[id].op != Op::Fract || graph[graph.arg(id, 0)].op != Op::Mul) return false;
    const NodeId product = graph.arg(id, 0);
    return graph[graph.arg(product, 0)].op == Op::Sin || graph[graph.arg(product, 1)].op == Op::Sin;
}

// Whether noise is added to a vector: a slope of it that is seen is one that it may have, and so is
// what is seen of all that is made of it.
bool is_moved_by_noise(const ir::Graph &graph, NodeId root) {
    std::vector<std::pair<NodeId, bool>> todo{
        {root, false}}; // and whether a sum of vectors is above
    std::unordered_set<NodeId> seen, seen_below;
    while (!todo.empty() && seen.size() <= max_nodes_composed) {
        const auto [id, is_below] = todo.back();
        todo.pop_back();
        if (!id || !(is_below ? seen_below : seen).insert(id).second) continue;
        if (is_below && is_noise(graph, id)) return true;
        const ir::Node node = graph[id];
        const bool moves = ir::is_vector(node.type) && (node.op == Op::Add || node.op == Op::Sub);
        for (const NodeId arg : graph.args(id)) todo.emplace_back(arg, is_below || moves);
        if (node.op == Op::Call)
            todo.emplace_back(graph.function(ir::FunctionId{node.payload}).result, is_below);
        if (node.op == Op::Loop)
            for (const NodeId next : graph.loop(ir::LoopId{node.payload}).next)
                todo.emplace_back(next, is_below);
    }
    return false;
}

class Parts {
  public:
    Parts(Flattening &context, const Ranges &ranges, const Domain &domain, const Budget &budget)
        : context_(context), graph_(context.graph), ranges_(ranges), domain_(domain),
          budget_(budget), read_(context.graph) {
        --budget_.levels;
    }

    std::optional<FieldBound> of(NodeId field, bool is_moved, std::size_t allowed) {
        field = ir::without_calls(graph_, field, max_nodes_composed).root;
        if (is_moved) { // another vector in each turn
            const auto written = ir::without_loops(graph_, field, max_nodes_composed);
            if (written.all) field = written.root;
        }
        if (!is_small(field)) return {};
        const bool first = budget_.levels + 1 == Budget{}.levels;
        const std::size_t left = context_.work.left, most = std::min(left / 4, allowed);
        if (first) context_.work.left = most;
        is_moved_ = first && is_moved;
        const auto look = [&] {
            std::optional<FieldBound> found = through_vector(field);
            if (found || !first) return found;
            look_below(field);
            if (!held_.empty()) found = search(field);
            return found;
        };
        std::optional<FieldBound> out = look();
        if (!out && is_moved_) {
            is_moved_ = false;
            out = look();
        }
        if (first) context_.work.left = left - (most - context_.work.left);
        return out;
    }

  private:
    // A field is looked at many times over, and the least of that costs as much as its square.
    bool is_small(NodeId field) const {
        std::vector<NodeId> todo{field};
        std::unordered_set<NodeId> seen;
        while (!todo.empty() && seen.size() <= max_nodes_composed) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (seen.insert(id).second)
                todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
        }
        return seen.size() <= max_nodes_composed;
    }

    // The bound of an expression that reads the point through one vector.
    std::optional<FieldBound> through_vector(NodeId id) {
        if (read_.below(id).is_affine) return {};
        Inners inners(graph_, read_, id);
        std::optional<FieldBound> best;
        const auto try_one = [&](const Inner &inner, double slope) {
            const auto found = through(id, inner, slope);
            if (found && (!best || found->lipschitz < best->lipschitz)) best = found;
            return best && best->lipschitz <= tight * best->sampled;
        };
        for (const Inner &inner : inners.warped())
            if (try_one(inner, slope_of(inner))) break;
        if (is_moved_) return best;
        const Inner *flattest = nullptr;
        double slope = infinity;
        const std::vector<Inner> affine = inners.affine();
        for (const Inner &inner : affine) {
            if (const double own = slope_of(inner); own < slope * (1 - as_flat))
                slope = own, flattest = &inner;
        }
        if (flattest && try_one(*flattest, slope)) return best;
        for (const Inner &inner : inners.folded())
            if (try_one(inner, slope_of(inner))) break;
        return best;
    }

    NodeId vector_of(const Inner &inner) {
        std::vector<NodeId> parts;
        for (const NodeId part : inner.components) parts.push_back(part ? part : graph_.number(0));
        return graph_.make(Op::Make, ir::Type::Vec3, parts);
    }
    // Of the components that there are: forms of a vector are seen where it has no others.
    double slope_of(const Inner &inner) {
        std::vector<NodeId> parts;
        for (const NodeId part : inner.components)
            if (part) parts.push_back(part);
        const ir::Type type = ir::vector_type(int(parts.size()));
        const NodeId vector = parts.size() == 1 ? parts[0] : graph_.make(Op::Make, type, parts);
        return bound_of_itself(vector).lipschitz;
    }

    // With `sampled` as a slope that would be right for it, not one that was seen.
    std::optional<FieldBound> through(NodeId id, const Inner &inner, double slope) {
        if (!std::isfinite(slope) || context_.work.spent()) return {};
        FieldBound out = with_part_of_work(2, [&] {
            const Image image = image_of(context_, ranges_, vector_of(inner), slope, domain_);
            return bound_field(context_, ranges_, seen_from(graph_, id, inner), image.domain(),
                               budget_);
        });
        if (!std::isfinite(out.lipschitz)) return {};
        out.lipschitz = up(times(slope, out.lipschitz), 4);
        out.sampled = times(slope, out.sampled);
        return out;
    }

    FieldBound bound_of_itself(NodeId id) {
        Budget budget = budget_;
        budget.levels = 0;
        return with_part_of_work(
            8, [&] { return bound_field(context_, ranges_, id, domain_, budget); });
    }

    // With no more of what is left than one of so many parts: others are looked at, too.
    template <class F> FieldBound with_part_of_work(std::size_t parts, F search) {
        const std::size_t left = context_.work.left, most = left / parts;
        context_.work.left = most;
        FieldBound out = search();
        context_.work.left += left - most;
        return out;
    }

    // The largest parts below `id` that can be proved so.
    void look_below(NodeId root) {
        std::vector<NodeId> todo(graph_.args(root).begin(), graph_.args(root).end());
        std::unordered_set<NodeId> seen;
        std::size_t looked = 0;
        while (!todo.empty()) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!graph_.reads(id).point || read_.below(id).is_affine || !seen.insert(id).second)
                continue;
            const bool scalar = graph_[id].type == ir::Type::Float && !graph_.reads(id).free_vars;
            const bool is_such = !is_moved_ || !Inners(graph_, read_, id).warped().empty();
            if (scalar && is_such && ++looked <= max_parts) {
                const FieldBound own = bound_of_itself(id);
                if (is_near(graph_, id, own)) continue;
                if (const auto bound = through_vector(id);
                    bound && bound->lipschitz < own.lipschitz) {
                    held_.emplace_back(id, *bound);
                    continue;
                }
            }
            todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
        }
    }

    // With the parts as fields of which their bounds alone are known.
    FieldBound search(NodeId field) {
        Ranges ranges = ranges_;
        ir::Substitution map;
        const NodeId point = graph_.point();
        for (const auto &[id, bound] : held_) {
            const NodeId place = graph_.fresh_var(ir::Type::Vec3);
            const ir::CacheId cache = graph_.add_cache(
                {graph_.add_function(
                     {"part", {}, {place}, ir::substitute(graph_, id, {{point, place}})}),
                 0});
            ranges.caches.resize(cache.index + 1);
            ranges.caches[cache.index] = {true, {bound.value}, bound.lipschitz};
            context_.cached.resize(cache.index + 1);
            context_.cached[cache.index] = true;
            map[id] = graph_.make(Op::Cached, ir::Type::Float, {point},
                                  static_cast<std::uint32_t>(cache.index));
        }
        Budget budget = budget_;
        budget.levels = 0;
        return bound_field(context_, ranges, ir::substitute(graph_, field, map), domain_, budget);
    }

    Flattening &context_;
    ir::Graph &graph_;
    const Ranges &ranges_;
    const Domain &domain_;
    Budget budget_;
    ReadThrough read_;
    bool is_moved_ = false; // by noise: such vectors alone are looked for
    std::vector<std::pair<NodeId, FieldBound>> held_;
};

} // namespace

bool is_near(const ir::Graph &graph, NodeId field, const FieldBound &bound) {
    const ir::Graph::Reads reads = graph.reads(field);
    const double most = reads.time || reads.params ? 1 : loose_part;
    return bound.lipschitz <= most * bound.sampled && !is_moved_by_noise(graph, field);
}

std::optional<FieldBound> bound_by_parts(Flattening &context, const Ranges &ranges, NodeId field,
                                         const Domain &domain, const Budget &budget, bool refused) {
    if (budget.levels <= 0 || context.graph[field].type != ir::Type::Float) return {};
    const bool is_moved = is_moved_by_noise(context.graph, field);
    std::size_t allowed = refused ? max_work : max_work_loose;
    if (is_moved && !context.graph.reads(field).params) allowed = max_work_moved;
    return Parts(context, ranges, domain, budget).of(field, is_moved, allowed);
}

} // namespace fathom::proof
