// A choice's border is where the two sides of one of its comparisons are equal. The smallest
// expression that all uses of the choice go through is tested there, then the next larger one
// (border_cases.h).
#include "proof/borders.h"

#include "ir/passes/walk.h"
#include "proof/border_cases.h"
#include "proof/continuity.h"
#include "proof/discontinuities.h"
#include "proof/exact.h"

#include <algorithm>
#include <optional>
#include <unordered_set>
#include <vector>

namespace fathom::proof {
namespace {

using ir::Graph;

constexpr ir::OpSet is_choice{Op::Select, Op::Sign, Op::Step};
constexpr std::size_t max_nodes_of_field = 1500, max_choices = 40;
constexpr int max_climb = 10, max_cases_of_field = 6000;
// Of the algebra, for one field: two fifths of what the proof has left, so that other ways are left.
constexpr std::size_t least_steps = 6'000'000, most_steps = 24'000'000;

struct Field {
    Graph &graph;
    std::vector<NodeId> nodes;                  // the root first, users before arguments
    std::unordered_map<NodeId, NodeId> through; // the next node that all uses go through

    // The first node that what goes through two goes through.
    NodeId joint(NodeId one, NodeId other) const {
        while (one != other) (one < other ? one : other) = through.at(one < other ? one : other);
        return one;
    }
};

void look_at(Field &field, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && seen.size() <= max_nodes_of_field) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        field.nodes.push_back(id);
        for (NodeId a : field.graph.args(id)) todo.push_back(a);
    }
    std::sort(field.nodes.begin(), field.nodes.end(), [](NodeId a, NodeId b) { return b < a; });
    field.through[root] = root;
    for (NodeId user : field.nodes)
        for (NodeId a : field.graph.args(user)) {
            const auto [it, fresh] = field.through.try_emplace(a, user);
            if (!fresh) it->second = field.joint(it->second, user);
        }
}

// The comparisons of numbers that a condition is made of; nothing where it is made of more.
std::optional<std::vector<NodeId>> comparisons_of(const Graph &graph, NodeId condition) {
    constexpr ir::OpSet of_truths{Op::And, Op::Or, Op::Not, Op::Select}; // as early returns make
    std::vector<NodeId> out, todo{condition};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!graph.reads(id).point && !graph.reads(id).free_vars) continue;
        if (!seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        if (of_truths[node.op]) {
            for (int i = int(node.count); i-- > 0;) todo.push_back(graph.arg(id, i));
        } else if ((node.op == Op::Less || node.op == Op::LessEqual) &&
                   graph[graph.arg(id, 0)].type == ir::Type::Float) {
            out.push_back(id);
        } else {
            return {};
        }
    }
    return out;
}

bool is_carried_up(const Graph &graph, NodeId field, const Granted &granted, Looked &looked) {
    const Carried to = is_carried(graph, field, granted, looked.ranges, looked.work, looked.moved);
    looked.near = looked.near || to == Carried::Near;
    return to != Carried::Nowhere;
}

// Is a claim proved, and the field moved by no more than is granted where sides count as equal that
// differ a little?
bool is_proved_of(NodeId field, Graph &graph, const Claim &claim, Looked &looked) {
    return is_proved(graph, claim, looked) &&
           (!looked.granted() ||
            is_carried_up(graph, field, {claim.of, looked.beside, looked.apart}, looked));
}

// Does `of` have one value on every border of the choice?
bool meets(NodeId field, Graph &graph, NodeId choice, NodeId of, Looked &looked) {
    const ir::Node node = graph[choice];
    std::vector<Claim> claims;
    if (node.op == Op::Select) {
        const auto comparisons = comparisons_of(graph, graph.arg(choice, 0));
        if (!comparisons || comparisons->empty() || comparisons->size() > 8) return false;
        for (NodeId c : *comparisons)
            claims.push_back({of, choice, c, graph.arg(c, 0), graph.arg(c, 1)});
    } else if (node.op == Op::Step) {
        if (node.type != ir::Type::Float) return false;
        claims.push_back({of, choice, {}, graph.arg(choice, 1), graph.arg(choice, 0)});
    } else {
        if (node.type != ir::Type::Float) return false;
        claims.push_back({of, choice, {}, graph.arg(choice, 0), graph.number(0)});
    }
    return std::all_of(claims.begin(), claims.end(), [&](const Claim &claim) {
        return is_proved_of(field, graph, claim, looked);
    });
}

// Is the choice all of an expression that may turn?
bool turns_alone(const Graph &graph, NodeId choice, NodeId of) {
    constexpr ir::OpSet others{Op::Atan2, Op::TableRead,  Op::Image, Op::Grid,
                               Op::Loop,  Op::LoopResult, Op::Call,  Op::Cached};
    std::vector<NodeId> todo{of};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second || seen.size() > max_nodes_of_field) continue;
        const ir::Node node = graph[id];
        const bool varies = graph.reads(id).point || graph.reads(id).free_vars;
        const bool turns = node.type == ir::Type::Bool || is_choice[node.op] ||
                           tells_apart[node.op] || others[node.op];
        if (id != choice && varies && turns) return false;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return seen.size() <= max_nodes_of_field;
}

// Of a sign or a `step` that turns alone: is `of` the same by each of its values, where it turns?
bool meets_as_arms(Graph &graph, NodeId choice, NodeId of, Work &work) {
    const ir::Node node = graph[choice];
    if (node.op == Op::Select || node.type != ir::Type::Float ||
        graph[of].type != ir::Type::Float || !turns_alone(graph, choice, of))
        return false;
    const bool is_sign = node.op == Op::Sign;
    const NodeId u = graph.arg(choice, is_sign ? 0 : 1),
                 v = is_sign ? graph.number(0) : graph.arg(choice, 0);
    const auto by = [&](double value) {
        return ir::substitute(graph, of, {{choice, graph.number(value)}});
    };
    const NodeId above = by(1), below = by(is_sign ? -1 : 0);
    return agree_where_equal(graph, u, v, above, below, work) &&
           (!is_sign || agree_where_equal(graph, u, v, above, by(0), work));
}

// `b <= a` of `a < b`, and `b < a` of `a <= b`: it is true where that is not.
NodeId opposite_of(Graph &graph, NodeId comparison) {
    const Op op = graph[comparison].op == Op::Less ? Op::LessEqual : Op::Less;
    return graph.make(op, {graph.arg(comparison, 1), graph.arg(comparison, 0)});
}

// A comparison turns all choices by it, and by its opposite, at once: does what all of their uses go
// through have one value whether it is true or not, where both its sides are equal?
bool turns_alike(Field &field, NodeId comparison, NodeId root, Looked &looked) {
    Graph &graph = field.graph;
    const Claim claim{root, comparison, {}, graph.arg(comparison, 0), graph.arg(comparison, 1)};
    return is_proved_alike(graph, claim, looked) &&
           std::ranges::all_of(looked.places, [&](const Granted &place) {
               return is_carried_up(graph, root, place, looked);
           });
}
bool turns_unseen(Field &field, NodeId comparison, NodeId root, Looked &looked) {
    Graph &graph = field.graph;
    Claim claim{root, comparison, {}, graph.arg(comparison, 0), graph.arg(comparison, 1)};
    claim.of = field.through.at(comparison);
    if (const auto other = field.through.find(opposite_of(graph, comparison));
        other != field.through.end())
        claim.of = field.joint(claim.of, other->second);
    for (int climb = 0; climb < max_climb && looked.cases < max_cases_of_field; ++climb) {
        if (graph[claim.of].type != ir::Type::Bool && is_proved_of(root, graph, claim, looked))
            return true;
        if (claim.of == root) return false;
        claim.of = field.through.at(claim.of);
    }
    return false;
}

// By each of a choice's comparisons, whose answers are kept.
class ByComparison {
  public:
    using Turns = bool (*)(Field &, NodeId comparison, NodeId root, Looked &);
    explicit ByComparison(Turns turns) : turns_(turns) {}

    bool prove(Field &field, NodeId choice, NodeId root, Looked &looked) {
        if (field.graph[choice].op != Op::Select) return false;
        const auto comparisons = comparisons_of(field.graph, field.graph.arg(choice, 0));
        if (!comparisons || comparisons->empty() || comparisons->size() > 8) return false;
        return std::ranges::all_of(*comparisons, [&](NodeId c) {
            if (const auto known = known_.find(opposite_of(field.graph, c)); known != known_.end())
                return known->second;
            const auto [known, fresh] = known_.try_emplace(c, false);
            if (fresh) known->second = turns_(field, c, root, looked);
            return known->second;
        });
    }

  private:
    Turns turns_;
    std::unordered_map<NodeId, bool> known_;
};

// A choice by comparisons of counts alone. Where no turning of what is counted is seen, neither is
// the choice's: what all uses of a sign go through lies above the choice, or in the count, which
// then does not change.
bool turns_by_counts(const Graph &graph, NodeId choice) {
    if (graph[choice].op != Op::Select) return false;
    const auto comparisons = comparisons_of(graph, graph.arg(choice, 0));
    return comparisons && !comparisons->empty() &&
           std::ranges::all_of(*comparisons, [&](NodeId c) { return is_count(graph, c); });
}

// The choices in a condition of counts.
std::vector<NodeId> counted(const Graph &graph, NodeId condition) {
    std::vector<NodeId> out, todo{condition};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        const bool of_truth =
            node.op == Op::ToFloat && graph[graph.arg(id, 0)].type == ir::Type::Bool;
        if (is_choice[node.op] || of_truth)
            out.push_back(id);
        else
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return out;
}

bool is_open(const Graph &graph, NodeId id) { // turns with the point, and is a number
    const ir::Node node = graph[id];
    return is_choice[node.op] && graph.reads(id).point &&
           (node.type == ir::Type::Float || ir::is_vector(node.type) ||
            (node.type == ir::Type::Int && node.op == Op::Select));
}

Meeting find_choices(Flattening &context, NodeId root) {
    Graph &graph = context.graph;
    Field field{graph, {}, {}};
    look_at(field, root);
    if (field.nodes.size() > max_nodes_of_field) return {};
    std::vector<NodeId> choices;
    for (NodeId id : field.nodes)
        if (is_open(graph, id)) {
            if (graph[id].op == Op::Select) {
                const auto [known, is_new] = context.joined.emplace(id, false);
                if (is_new)
                    context.joined[id] = arms_agree(graph, graph.arg(id, 0), graph.arg(id, 1),
                                                    graph.arg(id, 2), context.work);
                if (context.joined[id]) continue;
            }
            choices.push_back(id);
        }
    for (NodeId id : field.nodes) // what a loop's body reads is not followed through it
        if (graph[id].op == Op::Loop)
            for (NodeId inside : in_body(graph, id)) std::erase(choices, inside);
    if (choices.size() > max_choices) return {};
    Meeting out;
    Looked looked{context.work, context.ranges};
    looked.left = std::clamp(context.work.left / 5 * 2, least_steps, most_steps);
    ByComparison alike(turns_alike), unseen(turns_unseen);
    std::vector<NodeId> by_counts; // turn only where the choices do that they count
    for (NodeId choice : choices) {
        if (turns_by_counts(graph, choice)) {
            by_counts.push_back(choice);
            continue;
        }
        if (alike.prove(field, choice, root, looked)) {
            out.choices.insert(choice);
            continue;
        }
        NodeId of = graph[choice].op == Op::Select ? choice : field.through[choice];
        for (int climb = 0; climb < max_climb && looked.cases < max_cases_of_field; ++climb) {
            const Apart moved = looked.moved;
            if (meets_as_arms(graph, choice, of, context.work) ||
                meets(root, graph, choice, of, looked)) {
                out.choices.insert(choice);
                break;
            }
            looked.moved = moved;
            if (of == root) break;
            of = field.through[of];
        }
        if (!out.choices.contains(choice) && unseen.prove(field, choice, root, looked))
            out.choices.insert(choice);
    }
    std::reverse(by_counts.begin(), by_counts.end()); // arguments first
    for (NodeId choice : by_counts)
        if (std::ranges::all_of(counted(graph, graph.arg(choice, 0)), [&](NodeId one) {
                return !graph.reads(one).point || out.choices.contains(one);
            }))
            out.choices.insert(choice);
    out.near = looked.near;
    out.moved = looked.moved;
    return out;
}

} // namespace

bool has_choices(const Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && seen.size() <= 4 * max_nodes_of_field) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (is_choice[graph[id].op]) return true;
        if (graph[id].op == Op::Call)
            todo.push_back(graph.function(ir::FunctionId{graph[id].payload}).result);
        for (NodeId a : graph.args(id)) todo.push_back(a);
    }
    return false;
}

Meeting meeting_choices(Flattening &context, NodeId root) {
    const auto known = context.meeting.find(root);
    if (known != context.meeting.end()) return known->second;
    return context.meeting[root] = find_choices(context, root);
}

} // namespace fathom::proof
