// Which functions stay functions on the tape. What is called once or is tiny is built in place; the rest is called, so
// that a tape is as long as the scene and no longer.
#include "backend-cpu/code.h"

#include <algorithm>

namespace fathom::cpu {

using namespace ir;

namespace {

constexpr std::size_t tiny = 24;         // nodes, with what is built in place in it
constexpr std::size_t deepest = 64;      // in-place functions inside each other

struct Use {
    std::size_t calls = 0; // in the texts of the functions that are reached
    std::size_t nodes = 0; // with in-place callees
    std::size_t depth = 0; // of in-place callees
    std::vector<FunctionId> callees; // one entry a call
    bool seen = false;
};

// The nodes of a function's own text.
void walk(const Graph &graph, FunctionId id, Use &use) {
    std::unordered_map<NodeId, bool> seen;
    std::vector<NodeId> stack{graph.function(id).result};
    while (!stack.empty()) {
        NodeId at = stack.back();
        stack.pop_back();
        if (!at || !seen.emplace(at, true).second) continue;
        ++use.nodes;
        const Node &node = graph[at];
        for (NodeId arg : graph.args(at)) stack.push_back(arg);
        if (node.op == Op::Call) use.callees.push_back(FunctionId{node.payload});
        if (node.op == Op::Cached) use.callees.push_back(graph.cache(CacheId{node.payload}).field);
        if (node.op == Op::Fold) {
            const Fold &fold = graph.fold(FoldId{node.payload});
            stack.push_back(fold.count);
            stack.push_back(fold.condition);
            stack.insert(stack.end(), fold.next.begin(), fold.next.end());
        }
    }
}

} // namespace

Calls plan_calls(const Scene &scene, FunctionId root) {
    const Graph &graph = scene.graph;
    std::size_t n = graph.function_count();
    std::vector<Use> uses(n);
    Calls calls;
    calls.inlined.resize(n);
    calls.code_of.resize(n);
    calls.shared.resize(n);

    std::vector<FunctionId> reached{root};
    uses[root.index].seen = true;
    for (std::size_t i = 0; i < reached.size(); ++i) {
        Use &use = uses[reached[i].index];
        walk(graph, reached[i], use);
        for (FunctionId callee : use.callees) {
            ++uses[callee.index].calls;
            if (!uses[callee.index].seen) {
                uses[callee.index].seen = true;
                reached.push_back(callee);
            }
        }
    }
    // Functions call only those before them: callees have their sizes first.
    std::ranges::sort(reached, {}, &FunctionId::index);
    for (FunctionId id : reached) {
        Use &use = uses[id.index];
        for (FunctionId callee : use.callees)
            if (calls.inlined[callee.index]) {
                use.nodes += uses[callee.index].nodes;
                use.depth = std::max(use.depth, uses[callee.index].depth + 1);
            }
        calls.inlined[id.index] = id != root && use.depth < deepest && (use.calls == 1 || use.nodes <= tiny);
        calls.shared[id.index].assign(graph.function(id).params.size(), id != root);
    }
    for (std::size_t i = reached.size(); i-- > 0;) {
        if (calls.inlined[reached[i].index]) continue;
        calls.code_of[reached[i].index] = static_cast<std::uint32_t>(calls.order.size());
        calls.order.push_back(reached[i]);
    }
    return calls;
}

Program compile(const Scene &scene, FunctionId function) {
    Calls calls = plan_calls(scene, function);
    std::vector<Code> codes;
    for (std::size_t i = 0; i < calls.order.size(); ++i) codes.push_back(build(scene, calls, calls.order[i]));
    return lay_out(scene, calls, std::move(codes));
}

} // namespace fathom::cpu
