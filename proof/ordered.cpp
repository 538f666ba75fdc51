// A choice among numbers by comparisons of these numbers alone hangs on their order only. So a few
// numbers that stand for all orders tell what it is: each order that is possible is tried. Of two such
// choices of the same numbers it is seen so, too, whether the one is never above the other; what is
// chosen among them later has fewer orders then.
#include "proof/ordered.h"

#include "ir/passes/walk.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

namespace fathom::proof {

using ir::Graph;
using ir::NodeId;
using ir::Op;

namespace {

constexpr std::size_t most_numbers = 4, most_below = 4'000, most_beside = 12;
constexpr long most_orders = 1'000'000; // looked at for one field
constexpr ir::OpSet extremes{Op::Min, Op::Max};

using Ranks = std::array<int, most_numbers>;

// A choice, and the numbers that it compares and chooses among.
struct Choice {
    NodeId node;
    std::vector<NodeId> numbers;
};

class Orders {
  public:
    Orders(Graph &graph, const ir::Substitution &written) : graph_(graph), written_(written) {}

    // What a Select is, in terms of what the numbers are written as now; of a Min or Max it is seen
    // what it is not above or below.
    std::optional<NodeId> extreme_for(NodeId id) {
        const auto own = choice_of(id);
        if (!own || left_ < 0) return {};
        learn(*own);
        return extremes[graph_[id].op] ? std::nullopt : as_extreme(*own);
    }

  private:
    Graph &graph_;
    const ir::Substitution &written_;
    long left_ = most_orders;
    std::set<std::pair<NodeId, NodeId>> ordered_; // the first is never above the second
    std::unordered_map<NodeId, std::vector<Choice>> by_number_;

    bool is_comparison(NodeId id) const {
        const Op op = graph_[id].op;
        return (op == Op::Less || op == Op::LessEqual) &&
               graph_.type(graph_.arg(id, 0)) == ir::Type::Float;
    }

    std::optional<Choice> choice_of(NodeId choice) const {
        const bool is_extreme = extremes[graph_[choice].op];
        if (!is_extreme && !is_comparison(graph_.arg(choice, 0))) return {};
        Choice out{choice, {}};
        const auto add = [&](NodeId number) {
            if (std::ranges::find(out.numbers, number) == out.numbers.end())
                out.numbers.push_back(number);
        };
        std::vector<NodeId> todo{choice};
        while (!todo.empty()) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (std::ranges::find(out.numbers, id) != out.numbers.end()) continue;
            if (extremes[graph_[id].op]) {
                for (NodeId number : graph_.args(id)) add(number);
            } else if (graph_[id].op != Op::Select || !is_comparison(graph_.arg(id, 0))) {
                add(id);
            } else {
                for (NodeId number : graph_.args(graph_.arg(id, 0))) add(number);
                todo.push_back(graph_.arg(id, 2));
                todo.push_back(graph_.arg(id, 1));
            }
            if (out.numbers.size() > most_numbers) return {};
        }
        return out;
    }

    int rank(NodeId id, const std::vector<NodeId> &numbers, const Ranks &ranks) const {
        for (;;) {
            const auto at = std::ranges::find(numbers, id);
            if (at != numbers.end()) return ranks[std::size_t(at - numbers.begin())];
            if (const Op op = graph_[id].op; extremes[op]) {
                const int a = rank(graph_.arg(id, 0), numbers, ranks),
                          b = rank(graph_.arg(id, 1), numbers, ranks);
                return op == Op::Min ? std::min(a, b) : std::max(a, b);
            }
            const NodeId condition = graph_.arg(id, 0);
            const int a = rank(graph_.arg(condition, 0), numbers, ranks),
                      b = rank(graph_.arg(condition, 1), numbers, ranks);
            const bool holds = graph_[condition].op == Op::Less ? a < b : a <= b;
            id = graph_.arg(id, holds ? 1 : 2);
        }
    }

    bool is_possible(const std::vector<NodeId> &numbers, const Ranks &ranks) const {
        for (std::size_t i = 0; i < numbers.size(); ++i)
            for (std::size_t j = 0; j < numbers.size(); ++j) {
                if (i == j) continue;
                if (ranks[i] > ranks[j] && ordered_.contains({numbers[i], numbers[j]}))
                    return false;
                const auto a = graph_.as_number(numbers[i]), b = graph_.as_number(numbers[j]);
                if (a && b && *a < *b && ranks[i] >= ranks[j]) return false;
            }
        return true;
    }

    // Does it hold for all orders of the numbers that are possible?
    bool always(const std::vector<NodeId> &numbers,
                const std::function<bool(const Ranks &)> &holds) {
        const int n = int(numbers.size());
        Ranks ranks{};
        for (;;) {
            if (--left_ < 0) return false;
            if (is_possible(numbers, ranks) && !holds(ranks)) return false;
            int i = 0;
            while (i < n && ++ranks[std::size_t(i)] == n) ranks[std::size_t(i++)] = 0;
            if (i == n) return true;
        }
    }

    // What it is never above or below, of its own numbers and of other choices among them.
    void learn(const Choice &own) {
        const auto compare = [&](NodeId other, const std::vector<NodeId> &numbers) {
            const auto in_order = [&](NodeId a, NodeId b) {
                if (always(numbers, [&](const Ranks &ranks) {
                        return rank(a, numbers, ranks) <= rank(b, numbers, ranks);
                    }))
                    ordered_.insert({a, b});
            };
            in_order(own.node, other);
            in_order(other, own.node);
        };
        for (NodeId number : own.numbers) compare(number, own.numbers);
        std::set<NodeId> compared{own.node};
        for (NodeId number : own.numbers)
            for (const Choice &other : by_number_[number]) {
                std::vector<NodeId> all = own.numbers;
                for (NodeId also : other.numbers)
                    if (std::ranges::find(all, also) == all.end()) all.push_back(also);
                const bool is_number = std::ranges::find(all, own.node) != all.end() ||
                                       std::ranges::find(all, other.node) != all.end();
                if (all.size() > most_numbers || is_number || !compared.insert(other.node).second)
                    continue;
                compare(other.node, all);
            }
        for (NodeId number : own.numbers) {
            std::vector<Choice> &beside = by_number_[number];
            if (beside.size() < most_beside) beside.push_back(own);
        }
    }

    // Of the numbers one, the lesser or greater of two, or the lesser of one and the greater of two.
    std::optional<NodeId> as_extreme(const Choice &own) {
        const std::vector<NodeId> &numbers = own.numbers;
        const auto now = [&](std::size_t i) { return written_.at(numbers[i]); };
        const std::size_t n = numbers.size();
        const auto is = [&](const std::function<int(const Ranks &)> &value) {
            return always(numbers, [&](const Ranks &ranks) {
                return rank(own.node, numbers, ranks) == value(ranks);
            });
        };
        for (std::size_t i = 0; i < n; ++i)
            if (is([&](const Ranks &ranks) { return ranks[i]; })) return now(i);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                if (is([&](const Ranks &ranks) { return std::min(ranks[i], ranks[j]); }))
                    return graph_.make(Op::Min, {now(j), now(i)});
                if (is([&](const Ranks &ranks) { return std::max(ranks[i], ranks[j]); }))
                    return graph_.make(Op::Max, {now(j), now(i)});
            }
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t k = 0; k < j; ++k) {
                    if (i == j || i == k) continue;
                    if (is([&](const Ranks &ranks) {
                            return std::min(ranks[i], std::max(ranks[j], ranks[k]));
                        }))
                        return graph_.make(Op::Min,
                                           {now(i), graph_.make(Op::Max, {now(k), now(j)})});
                }
        return {};
    }
};

} // namespace

NodeId with_extremes_for_choices(Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root}, nodes;
    std::set<NodeId> seen;
    bool chooses = false;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (seen.size() > most_below) return root;
        nodes.push_back(id);
        chooses = chooses || (graph[id].op == Op::Select && graph.type(id) == ir::Type::Float);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    if (!chooses) return root;
    std::ranges::sort(nodes, {}, &NodeId::index); // a node stands after its arguments
    ir::Substitution written;
    Orders orders(graph, written);
    for (NodeId id : nodes) {
        const ir::Node node = graph[id];
        if (node.type == ir::Type::Float && (node.op == Op::Select || extremes[node.op]))
            if (const auto extreme = orders.extreme_for(id)) {
                written[id] = *extreme;
                continue;
            }
        std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        bool changed = false;
        for (NodeId &arg : args) {
            const NodeId now = written.at(arg);
            changed = changed || now != arg;
            arg = now;
        }
        written[id] = changed ? graph.make(node.op, node.type, args, node.payload) : id;
    }
    return written.at(root);
}

} // namespace fathom::proof
