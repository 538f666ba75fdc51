// A border of floor(u) is where u is a whole number K, a fresh variable that stands for all whole
// numbers at once. The field is written three times: for u a little less than K, for K, and for a
// little more; "a little" is an infinitesimal, at which every other step is evaluated, too. A step
// whose argument is then a number, a whole multiple of K and a multiple of the infinitesimal has
// one value (floor(u + 1) moves with floor(u)). Any other that the point moves is taken for
// unknown: one variable for equal arguments. Where a sum of products makes all three equal
// (continuity.h), the field does not see the jump, whatever the unknown steps are; so where steps
// turn together without our knowing, their jumps can be taken one after another
// (docs/lipschitz.md, 2). The expression that is written three times is the least that all uses of
// the group's steps go through, or a larger one (2.12).
#include "proof/discontinuities.h"

#include "ir/passes/inline.h"
#include "proof/agreement.h"
#include "proof/border_sides.h"
#include "proof/continuity.h"
#include "proof/machine.h"
#include "proof/polynomials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace fathom::proof {

NodeId common_through(const std::unordered_map<NodeId, NodeId> &through, NodeId a, NodeId b) {
    while (a != b) (a < b ? a : b) = through.at(a < b ? a : b);
    return a;
}

bool Seen::all_uses_of(NodeId step) const {
    for (NodeId id = step;;) {
        if (id == through) return true;
        const NodeId next = next_through.at(id);
        if (next == id) return false;
        id = next;
    }
}

namespace {

constexpr std::size_t max_groups = 48;

// How sides are compared: with what is known where the field is asked, and case by case (agreement.h)
// if there are `comparisons`.
struct Way {
    Expansion &forms;
    Notes notes{};
    Comparisons *comparisons = nullptr;
};

// Is the field the same on all sides of the borders with these K?
bool cancels(Graph &graph, const Seen &seen, const Group &group, bool half, const Counts &counts,
             Met &met, const Way &way, Work &work) {
    const bool one = counts.range.is_point();
    const NodeId whole = one ? graph.number(counts.range.lo)
                             : graph.make(Op::ToFloat, ir::Type::Float,
                                          {graph.fresh_var(ir::Type::Int)}),
                 little = graph.fresh_var(ir::Type::Float),
                 little_angle = graph.fresh_var(ir::Type::Float),
                 radius = graph.fresh_var(ir::Type::Float);
    std::map<std::vector<std::uint32_t>, NodeId> unknown;
    Notes notes = way.notes;
    std::vector<NodeId> sides;
    bool same_for_all = true;
    for (const Side side : {Side::Before, Side::At, Side::After}) {
        Border border{graph, group, seen, whole,  little, little_angle, radius,   unknown,
                      notes, half,  side, counts, met,    work,         way.forms};
        border.enter(border.limit, false);
        border.enter(border.moving, true);
        sides.push_back(border.limit.of(seen.through));
        if (border.limit.failed || border.moving.failed) return false;
        if (sides.size() == 3 && sides[1] == sides[2]) continue;
        same_for_all =
            same_for_all && (same(graph, sides.front(), sides.back(), &work) ||
                             same_with_mixes_as_sums(graph, sides.front(), sides.back(), &work) ||
                             (way.comparisons && sides_agree(graph, sides.front(), sides.back(),
                                                             notes, *way.comparisons, work)));
        if (!same_for_all && met.thresholds.empty() && !met.parity) return false;
    }
    return same_for_all;
}

// By cases for K: even and odd, and beside each number that it is compared with. `met` gets those
// that it is compared with in some cases alone.
bool cancels_by_cases(Graph &graph, const Seen &seen, const Group &group, bool half, Met &met,
                      const Way &way, Work &work) {
    constexpr std::size_t most_thresholds = 8;
    if (met.thresholds.empty() && !met.parity) return false;
    std::vector<double> whole;
    for (double t : met.thresholds)
        for (double k : {std::floor(t), std::ceil(t)}) whole.push_back(k);
    std::sort(whole.begin(), whole.end());
    whole.erase(std::unique(whole.begin(), whole.end()), whole.end());
    if (whole.size() > 2 * most_thresholds) return false;
    std::vector<Interval> ranges;
    double from = -ir::rounding::infinity;
    for (double k : whole) {
        if (from < k) ranges.push_back({from, k - 1});
        ranges.push_back(k);
        from = k + 1;
    }
    ranges.push_back({from, ir::rounding::infinity});
    for (const Interval &range : ranges)
        for (int parity = 0; parity < 2; ++parity) {
            const bool odd = std::fmod(std::fabs(range.lo), 2) == 1;
            if (range.is_point() && odd != (parity == 1)) continue;
            Met more;
            if (cancels(graph, seen, group, half, {parity, range}, more, way, work)) continue;
            met.parity = met.parity || more.parity;
            for (double t : more.thresholds)
                if (std::ranges::find(met.thresholds, t) == met.thresholds.end())
                    met.thresholds.push_back(t);
            return false;
        }
    return true;
}

bool cancels(Graph &graph, const Seen &seen, const Group &group, const Way &way, Work &work) {
    constexpr int most_rounds = 3; // of cases that lead to further ones
    bool halves = false, wholes = false;
    for (NodeId step : group.steps) (graph[step].op == Op::Round ? halves : wholes) = true;
    for (const bool half : {false, true}) {
        if (half ? !halves : !wholes) continue;
        Met met;
        bool is_proved = cancels(graph, seen, group, half, {}, met, way, work);
        std::size_t before = std::size_t(-1);
        for (int i = 0; i < most_rounds && !is_proved && met.thresholds.size() != before; ++i) {
            before = met.thresholds.size();
            is_proved = cancels_by_cases(graph, seen, group, half, met, way, work);
        }
        if (!is_proved) return false;
    }
    return true;
}

std::vector<NodeId> reached(const Graph &graph, NodeId root, bool enter_calls) {
    std::vector<NodeId> out, todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() <= max_nodes) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        out.push_back(id);
        if (enter_calls && graph[id].op == Op::Call)
            todo.push_back(graph.function(ir::FunctionId{graph[id].payload}).result);
        for (NodeId a : graph.args(id)) todo.push_back(a);
    }
    return out;
}

} // namespace

std::vector<NodeId> in_body(const Graph &graph, NodeId loop_node) {
    std::vector<NodeId> out;
    const ir::Loop loop = graph.loop(ir::LoopId{graph[loop_node].payload});
    std::vector<NodeId> roots = loop.next;
    roots.push_back(loop.count);
    if (loop.condition) roots.push_back(loop.condition);
    for (NodeId root : roots)
        for (NodeId id : reached(graph, root, true)) {
            out.push_back(id);
            if (graph[id].op != Op::Loop) continue;
            const std::vector<NodeId> inner = in_body(graph, id);
            out.insert(out.end(), inner.begin(), inner.end());
        }
    return out;
}

bool has_steps(const Graph &graph, NodeId root) {
    for (NodeId id : reached(graph, root, true))
        if (is_step[graph[id].op] && graph[id].type != ir::Type::Int) return true;
    return false;
}

NodeId written_out(Graph &graph, NodeId root) {
    const ir::WithoutCalls out = ir::without_calls(graph, root, max_nodes);
    return out.all ? out.root : root;
}

namespace {

// Does it change with the point where no step turns?
bool reads_point_bare(const Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!graph.reads(id).point || !seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        constexpr ir::OpSet rounds{Op::Floor, Op::Ceil, Op::Round};
        if (rounds[node.op]) continue;
        if (node.count == 0 || node.op == Op::Loop) return true;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return false;
}

// Of each node of a field the next that all its uses go through; users come before arguments.
std::unordered_map<NodeId, NodeId> throughs(const Graph &graph, NodeId root,
                                            std::vector<NodeId> nodes) {
    std::sort(nodes.begin(), nodes.end(), [](NodeId a, NodeId b) { return b < a; });
    std::unordered_map<NodeId, NodeId> out{{root, root}};
    for (NodeId user : nodes)
        for (NodeId a : graph.args(user)) {
            const auto [it, fresh] = out.try_emplace(a, user);
            if (!fresh) it->second = common_through(out, it->second, user);
        }
    return out;
}

// The least expression that all uses of a group's steps go through, then larger ones, up to the
// whole field.
bool cancels_somewhere(Graph &graph, NodeId root, const Group &group,
                       const std::unordered_map<NodeId, NodeId> &through, const Way &way,
                       Work &work) {
    NodeId of = through.at(group.steps.front());
    for (NodeId step : group.steps) of = common_through(through, of, through.at(step));
    for (int climb = 1;; climb *= 2) {
        if (cancels(graph, {of, through}, group, way, work)) return true;
        if (of == root || work.spent()) return false;
        for (int i = 0; i < climb; ++i) of = through.at(of);
    }
}

// Of coordinates: where the field is asked.
Notes notes_of(Graph &graph, const Cell *region) {
    Notes out;
    for (const ir::Type type : {ir::Type::Vec2, ir::Type::Vec3})
        for (int i = 0; region && i < ir::components(type); ++i)
            if (const Interval side = region->p[std::size_t(i)]; side.finite())
                out.given[graph.component(graph.point(type), i)] = side;
    return out;
}

bool is_about_an_angle(const Graph &graph, const Group &group) {
    return group.is_angle ||
           std::ranges::any_of(reached(graph, group.turning, false),
                               [&](NodeId id) { return graph[id].op == Op::Atan2; });
}

} // namespace

std::unordered_set<NodeId> cancelling_steps(Graph &graph, NodeId root, const Cell *region,
                                            Work &work) {
    const std::vector<NodeId> nodes = reached(graph, root, false);
    if (nodes.size() > max_nodes) return {};
    std::map<std::pair<NodeId, int>, Group> groups;
    std::unordered_set<NodeId> steps;
    for (NodeId id : nodes) {
        const ir::Node node = graph[id];
        if (!is_step[node.op] || !graph.reads(id).point || graph.reads(id).free_vars) continue;
        if (node.type != ir::Type::Float && !ir::is_vector(node.type)) continue;
        // Of steps alone: its jumps are theirs.
        if (!reads_point_bare(graph, graph.arg(id, 0)) &&
            (node.count < 2 || !reads_point_bare(graph, graph.arg(id, 1))))
            continue;
        NodeId turning = graph.arg(id, 0);
        if (node.op == Op::Mod) turning = graph.div(turning, graph.arg(id, 1));
        steps.insert(id);
        for (int i = 0; i < ir::components(node.type); ++i) {
            // an angle's border is its own; others share that of their argument's component
            Group &group = groups[{node.op == Op::Atan2 ? id : turning, i}];
            group.turning = node.op == Op::Atan2 ? graph.arg(id, 0) : turning;
            group.component = i;
            group.is_angle = node.op == Op::Atan2;
            group.steps.push_back(id);
        }
    }
    if (groups.size() > max_groups) return {};
    const std::unordered_map<NodeId, NodeId> through = throughs(graph, root, nodes);
    Expansion forms(graph, &work, Expansion::Counts::Nothing);
    const Way quickly{forms};
    std::vector<const Group *> left;
    for (const auto &[key, group] : groups)
        if (!cancels_somewhere(graph, root, group, through, quickly, work)) left.push_back(&group);
    const bool cases_may_help = !left.empty() && std::ranges::none_of(left, [&](auto *group) {
        return is_about_an_angle(graph, *group);
    });
    Comparisons comparisons;
    const Way by_cases{forms, notes_of(graph, region), &comparisons};
    for (const Group *group : left)
        if (!cases_may_help || comparisons.in_vain ||
            !cancels_somewhere(graph, root, *group, through, by_cases, work)) {
            comparisons.in_vain = true; // the field jumps there, for all that is known
            for (NodeId step : group->steps) steps.erase(step);
        }
    for (NodeId id : nodes) // in a loop's body no border is entered
        if (graph[id].op == Op::Loop)
            for (NodeId inside : in_body(graph, id)) steps.erase(inside);
    return steps;
}

} // namespace fathom::proof
