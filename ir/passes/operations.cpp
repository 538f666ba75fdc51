// What an expression costs to evaluate once, counted in operations: loops by their iterations,
// calls by what they call. So that a scene that no machine could evaluate is refused before it is
// drawn.
#include "ir/passes/operations.h"

#include <unordered_set>

namespace fathom::ir {
namespace {

class Counter {
  public:
    explicit Counter(const Graph &graph) : graph_(graph) {}

    // A node that several share counts once; a loop's body once an iteration.
    double operator()(std::vector<NodeId> todo) {
        double operations = 0;
        std::unordered_set<NodeId> seen;
        while (!todo.empty()) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!id || !seen.insert(id).second) continue;
            const Node &node = graph_[id];
            operations += 1;
            if (node.op == Op::Call) operations += function(FunctionId{node.payload});
            if (node.op == Op::Cached)
                operations += function(graph_.cache(CacheId{node.payload}).field);
            if (node.op == Op::Loop) operations += loop(LoopId{node.payload});
            for (NodeId arg : graph_.args(id)) todo.push_back(arg);
        }
        return operations;
    }

    std::size_t functions() const { return functions_.size(); }

  private:
    double function(FunctionId id) {
        if (const auto known = functions_.find(id); known != functions_.end()) return known->second;
        const double operations = (*this)({graph_.function(id).result});
        functions_[id] = operations;
        return operations;
    }
    double loop(LoopId id) {
        if (const auto known = loops_.find(id); known != loops_.end()) return known->second;
        const Loop &loop = graph_.loop(id);
        std::vector<NodeId> body = loop.next;
        body.push_back(loop.condition);
        const double operations = loop.max_count * (*this)(std::move(body));
        loops_[id] = operations;
        return operations;
    }

    const Graph &graph_;
    std::unordered_map<FunctionId, double> functions_;
    std::unordered_map<LoopId, double> loops_;
};

} // namespace

double operations(const Graph &graph, NodeId root) { return Counter(graph)({root}); }

double operations(const Graph &graph, std::vector<NodeId> roots) {
    return Counter(graph)(std::move(roots));
}

std::size_t functions_called(const Graph &graph, std::vector<NodeId> roots) {
    Counter count(graph);
    count(std::move(roots));
    return count.functions();
}

} // namespace fathom::ir
