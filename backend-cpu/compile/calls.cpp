// Which functions stay functions on the tape. What is called once or is tiny is built in place; the
// rest is called, so that a tape is as long as the scene and no longer.
#include "backend-cpu/compile/code.h"

#include <algorithm>

namespace fathom::cpu {

using namespace ir;

namespace {

constexpr std::size_t tiny = 24;    // nodes, with what is built in place in it
constexpr std::size_t deepest = 64; // in-place functions inside each other

struct Use {
    std::size_t calls = 0;           // in the texts of the functions that are reached
    std::size_t nodes = 0;           // with in-place callees
    std::size_t depth = 0;           // of in-place callees
    std::vector<FunctionId> callees; // one entry a call
    bool seen = false;
};

// The nodes of a body's own text.
Use walk(const Graph &graph, std::span<const NodeId> results) {
    Use use;
    std::unordered_map<NodeId, bool> seen;
    std::vector<NodeId> stack(results.begin(), results.end());
    while (!stack.empty()) {
        NodeId at = stack.back();
        stack.pop_back();
        if (!at || !seen.emplace(at, true).second) continue;
        ++use.nodes;
        const Node &node = graph[at];
        for (NodeId arg : graph.args(at)) stack.push_back(arg);
        if (node.op == Op::Call) use.callees.push_back(FunctionId{node.payload});
        if (node.op == Op::Cached) use.callees.push_back(graph.cache(CacheId{node.payload}).field);
        if (node.op == Op::Loop) {
            const ir::Loop &loop = graph.loop(LoopId{node.payload});
            stack.push_back(loop.count);
            stack.push_back(loop.condition);
            stack.insert(stack.end(), loop.next.begin(), loop.next.end());
        }
    }
    return use;
}

} // namespace

Body body_of(const Graph &graph, FunctionId function) {
    return {graph.function(function).params, {graph.function(function).result}};
}

Calls plan_calls(const Scene &scene, const Body &root) {
    const Graph &graph = scene.graph;
    std::size_t n = graph.function_count();
    std::vector<Use> uses(n);
    std::vector<FunctionId> reached;
    auto reach = [&](const Use &use) {
        for (FunctionId callee : use.callees) {
            Use &there = uses[callee.index];
            if (!there.seen) reached.push_back(callee);
            there.seen = true;
            ++there.calls;
        }
    };
    reach(walk(graph, root.results));
    for (std::size_t i = 0; i < reached.size(); ++i) {
        Use use = walk(graph, body_of(graph, reached[i]).results);
        use.seen = true;
        use.calls = uses[reached[i].index].calls;
        uses[reached[i].index] = use;
        reach(use);
    }
    // Functions call only those before them: callees have their sizes first.
    Calls calls;
    calls.inlined.resize(n);
    calls.body.resize(n);
    std::ranges::sort(reached, {}, &FunctionId::index);
    for (FunctionId id : reached) {
        Use &use = uses[id.index];
        for (FunctionId callee : use.callees)
            if (calls.inlined[callee.index]) {
                use.nodes += uses[callee.index].nodes;
                use.depth = std::max(use.depth, uses[callee.index].depth + 1);
            }
        calls.inlined[id.index] = use.depth < deepest && (use.calls == 1 || use.nodes <= tiny);
    }
    calls.bodies.push_back(root);
    calls.shared.emplace_back(root.params.size(), false);
    for (std::size_t i = reached.size(); i-- > 0;) {
        if (calls.inlined[reached[i].index]) continue;
        calls.body[reached[i].index] = static_cast<std::uint32_t>(calls.bodies.size());
        calls.bodies.push_back(body_of(graph, reached[i]));
        calls.shared.emplace_back(calls.bodies.back().params.size(), true);
    }
    return calls;
}

static Program compile_body(const Scene &scene, const Body &root, Choices choices) {
    Calls calls = plan_calls(scene, root);
    std::vector<Code> codes;
    for (std::size_t i = 0; i < calls.bodies.size(); ++i)
        codes.push_back(build(scene, calls, i, choices));
    return lay_out(scene, calls, std::move(codes));
}

Program compile(const Scene &scene, FunctionId function, Choices choices) {
    return compile_body(scene, body_of(scene.graph, function), choices);
}

Program compile(const Scene &scene, std::span<const NodeId> params,
                std::span<const NodeId> results) {
    return compile_body(scene, {{params.begin(), params.end()}, {results.begin(), results.end()}},
                        Choices::Joined);
}

} // namespace fathom::cpu
