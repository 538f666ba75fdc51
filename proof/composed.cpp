#include "proof/composed.h"

#include "ir/passes/inline.h"
#include "ir/passes/walk.h"
#include "proof/continuity.h"
#include "proof/inner_vectors.h"
#include "proof/rescaled.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace fathom::proof {
namespace {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

constexpr std::size_t max_parts = 64;       // of a field
constexpr std::size_t max_work = 5'000'000; // for one field that is refused
// … that reads vectors to which noise is added, and no param: else it is asked for many of its values.
constexpr std::size_t max_work_moved = 10'000'000;
constexpr std::size_t max_work_loose = 500'000; // … that is not as flat as it might be
constexpr double loose_part = 1.3; // a bound over the slope seen, above which it is looked at
constexpr double near_by_distance = 1.01; // … at which a search along one or two axes stops
constexpr double not_as_steep = 0.01;
constexpr double as_flat = 1e-6; // of a slope: what is rounded
constexpr double tight = 1.1;    // a bound over the slope seen, with which no other vector is tried

constexpr ir::OpSet may_jump{Op::Select, Op::Sign,      Op::Step,  Op::Trunc,   Op::Floor, Op::Ceil,
                             Op::Round,  Op::Fract,     Op::Mod,   Op::Atan2,   Op::Loop,  Op::Hash,
                             Op::Less,   Op::LessEqual, Op::Equal, Op::NotEqual};

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
        // What may jump tells apart what rounding alone does.
        if (is_small(field, may_jump)) field = with_factors_in_order(graph_, field);
        const bool first = budget_.levels + 1 == Budget{}.levels;
        const std::size_t left = context_.work.left, most = std::min(left / 4, allowed);
        if (first) context_.work.left = most;
        is_moved_ = first && is_moved;
        const auto look = [&] {
            std::optional<FieldBound> found = through_vector(field);
            if (!first || (found && !(is_steep_ && is_sum_apart(field)))) return found;
            look_below(field);
            if (held_.empty()) return found;
            const FieldBound by_parts = search(field);
            if (!found || by_parts.lipschitz < found->lipschitz) found = by_parts;
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

    // By a distance, where that is as near to what is seen as a search in space would come. What has
    // to be shown not to jump is looked at as it is written first: that costs more than the search.
    std::optional<FieldBound> by_distance(NodeId field) {
        const ir::WithoutCalls written = ir::without_calls(graph_, field, max_nodes_composed);
        if (!written.all || !is_small(written.root, may_jump)) return {};
        const double enough = budget_.tolerance;
        budget_.tolerance = near_by_distance;
        for (const Inner &inner : Inners(graph_, read_, written.root).radial()) {
            if (!keeps_lengths(inner)) continue;
            const auto found = through(written.root, inner, slope_of(inner));
            if (found && found->lipschitz <= std::max(budget_.enough, enough * found->sampled))
                return found;
        }
        return {};
    }

  private:
    // A field is looked at many times over, and the least of that costs as much as its square.
    bool is_small(NodeId field, const ir::OpSet &without = {}) const {
        std::vector<NodeId> todo{field};
        std::unordered_set<NodeId> seen;
        while (!todo.empty() && seen.size() <= max_nodes_composed) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!id || !seen.insert(id).second) continue;
            if (without[graph_[id].op] && graph_.reads(id).point) return false;
            todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
        }
        return seen.size() <= max_nodes_composed;
    }

    // What moves, and is a number times a sum of two that read other coordinates: one vector is as
    // steep for both as for the one for which it is steepest.
    bool is_sum_apart(NodeId field) {
        const ir::Graph::Reads reads = graph_.reads(field);
        if (!reads.time && !reads.params) return false;
        while (graph_[field].op == Op::Neg || graph_[field].op == Op::Mul) {
            const NodeId last = graph_.args(field).back();
            const bool by_first = graph_[field].op == Op::Mul && !graph_.reads(last).point;
            field = by_first ? graph_.arg(field, 0) : last;
        }
        if (graph_[field].op != Op::Add && graph_[field].op != Op::Sub) return false;
        const unsigned a = read_.beside({graph_.arg(field, 0)}, {}),
                       b = read_.beside({graph_.arg(field, 1)}, {});
        return a != 0 && b != 0 && (a & b) == 0;
    }

    // The bound of an expression that reads the point through one vector.
    std::optional<FieldBound> through_vector(NodeId id) {
        if (read_.below(id).is_affine) return {};
        Inners inners(graph_, read_, id);
        std::optional<FieldBound> best;
        const auto try_one = [&](const Inner &inner, double slope) {
            const auto found = through(id, inner, slope);
            if (found && (!best || found->lipschitz < best->lipschitz)) {
                best = found;
                is_steep_ = slope > 1 + not_as_steep;
            }
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
    // Is its distance as steep as 1, whatever the params? Else the same param may stand in the field to
    // make good for it, and its slope is not as much for all directions.
    bool keeps_lengths(const Inner &inner) {
        Ranges at = ranges_;
        for (const double way : {0.0, 0.5, 1.0}) {
            for (std::size_t i = 0; i < at.params.size(); ++i)
                for (std::size_t c = 0; c < 4; ++c) {
                    const Interval &x = ranges_.params[i][c];
                    at.params[i][c] = x.finite() ? x.lo + way * x.width() : x;
                }
            const double slope =
                bound_field(context_, at, inner.distance, domain_, budget_).lipschitz;
            if (!(slope > 1 - not_as_steep && slope < 1 + as_flat)) return false;
        }
        return slope_of(inner) < 1 + as_flat;
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
        const Image image = image_of(context_, ranges_, vector_of(inner), slope, domain_);
        NodeId field = seen_from(graph_, id, inner);
        if (const auto scaled = scaled_apart(field, inner)) {
            field = scaled->field;
            slope = slope_of(scaled->rest);
        }
        FieldBound out = with_part_of_work(
            2, [&] { return bound_field(context_, ranges_, field, image.domain(), budget_); });
        if (!std::isfinite(out.lipschitz)) return {};
        out.lipschitz = up(times(slope, out.lipschitz), 4);
        out.sampled = times(slope, out.sampled);
        return out;
    }

    // Where a number k > 0 that stands still is a factor of all components: the vector without it, and
    // k times the field, where k meets its inverse in that. It is as steep as the field is by k v.
    struct Scaled {
        Inner rest;
        NodeId field;
    };
    std::optional<Scaled> scaled_apart(NodeId field, const Inner &inner) {
        if (inner.distance) return {};
        Inner by_component = inner;
        NodeId some;
        for (NodeId &part : by_component.components) {
            if (part && graph_[part].op == Op::Swizzle)
                part = component_of(graph_, graph_.arg(part, 0),
                                    ir::swizzle_component(graph_[part].payload, 0));
            if (part) some = part;
        }
        for (const Factor &factor : still_factors(some)) {
            Scaled out{by_component, {}};
            bool all = true;
            for (NodeId &part : out.rest.components)
                if (part && all) {
                    const auto rest = without_factor(part, factor);
                    all = rest.has_value();
                    if (all) part = *rest;
                }
            if (!all) continue;
            const Interval range = range_of(context_, ranges_, factor.number)[0];
            if (!(range.lo > 0) || !range.finite()) continue;
            RescaledNodes known;
            const auto met = rescaled(graph_, factor, field, known, context_.work);
            if (!met) continue;
            out.field = met->value;
            return out;
        }
        return {};
    }
    bool is_still(NodeId id) const {
        return !graph_.reads(id).point && !graph_.reads(id).free_vars;
    }
    std::vector<Factor> still_factors(NodeId part) const {
        while (graph_[part].op == Op::Add || graph_[part].op == Op::Sub)
            part = graph_.arg(part, is_still(graph_.arg(part, 0)) ? 1 : 0);
        std::vector<Factor> out = factors_of(graph_, part);
        std::erase_if(out, [&](const Factor &one) { return !is_still(one.number); });
        return out;
    }
    // What is as steep as the component over the factor, by each coordinate: what stands still and is
    // added goes, but for where the sum is `multiplied` by what does not.
    std::optional<NodeId> without_factor(NodeId id, const Factor &factor, bool multiplied = false) {
        const ir::Node node = graph_[id];
        if (node.op == Op::Add || node.op == Op::Sub) {
            const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
            if (is_still(b) && !multiplied) return without_factor(a, factor);
            const auto of_b = without_factor(b, factor, multiplied);
            if (!of_b) return {};
            if (is_still(a) && !multiplied) return node.op == Op::Sub ? graph_.neg(*of_b) : *of_b;
            const auto of_a = without_factor(a, factor, multiplied);
            if (!of_a) return {};
            return graph_.make(node.op, {*of_a, *of_b});
        }
        if (node.op == Op::Mul)
            for (int i = 0; i < 2; ++i) {
                const NodeId one = graph_.arg(id, i), other = graph_.arg(id, 1 - i);
                if (!factor.divides && one == factor.number) return other;
                if (is_still(one)) continue;
                if (const auto rest = without_factor(one, factor, multiplied || !is_still(other)))
                    return graph_.mul(*rest, other);
            }
        if (node.op == Op::Div) {
            const NodeId above = graph_.arg(id, 0), below = graph_.arg(id, 1);
            if (factor.divides && below == factor.number) return above;
            if (const auto rest = without_factor(above, factor, multiplied || !is_still(below)))
                return graph_.make(Op::Div, {*rest, below});
        }
        if (node.op == Op::Neg)
            if (const auto rest = without_factor(graph_.arg(id, 0), factor, multiplied))
                return graph_.neg(*rest);
        return {};
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

    // The point with 0 for each coordinate that the expression does not read: its gradient has no
    // part along these.
    NodeId coordinates_of(NodeId id) {
        const unsigned read = read_.beside({id}, {}); // in loops, too
        std::vector<NodeId> parts;
        for (int axis = 0; axis < 3; ++axis)
            parts.push_back(read >> axis & 1 ? graph_.component(graph_.point(), axis)
                                             : graph_.number(0));
        return graph_.make(Op::Make, ir::Type::Vec3, parts);
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
            map[id] = graph_.make(Op::Cached, ir::Type::Float, {coordinates_of(id)},
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
    bool is_steep_ = false; // the vector that a bound was found by
    std::vector<std::pair<NodeId, FieldBound>> held_;
};

} // namespace

bool is_near(const ir::Graph &graph, NodeId field, const FieldBound &bound) {
    const ir::Graph::Reads reads = graph.reads(field);
    const double most = reads.time || reads.params ? 1 : loose_part;
    return bound.lipschitz <= most * bound.sampled && !is_moved_by_noise(graph, field);
}

std::optional<FieldBound> bound_by_distance(Flattening &context, const Ranges &ranges, NodeId field,
                                            const Domain &domain, const Budget &budget) {
    if (budget.levels <= 0 || context.graph[field].type != ir::Type::Float) return {};
    return Parts(context, ranges, domain, budget).by_distance(field);
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
