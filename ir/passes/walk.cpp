// What hangs below a node: what it reads, which variables are free in it, and copies with parts
// replaced.
#include "ir/passes/walk.h"

#include <algorithm>
#include <unordered_set>

namespace fathom::ir {
namespace {

std::vector<NodeId> body_of(const Loop &loop) {
    std::vector<NodeId> body{loop.count};
    if (loop.condition) body.push_back(loop.condition);
    body.insert(body.end(), loop.next.begin(), loop.next.end());
    return body;
}

// Variables are made for one binder, so the free ones are those that no fold below binds.
std::vector<NodeId> unbound(const Graph &graph, std::vector<NodeId> stack) {
    std::unordered_set<NodeId> seen, bound;
    std::vector<NodeId> found;
    while (!stack.empty()) {
        const NodeId id = stack.back();
        stack.pop_back();
        const Node &node = graph[id];
        if (!graph.reads(id).free_vars || !seen.insert(id).second) continue;
        if (node.op == Op::Var) found.push_back(id);
        if (node.op == Op::Loop) {
            const Loop &loop = graph.loop(LoopId{std::size_t{node.payload}});
            bound.insert(loop.index);
            bound.insert(loop.vars.begin(), loop.vars.end());
            for (NodeId part : body_of(loop)) stack.push_back(part);
        }
        for (NodeId arg : graph.args(id)) stack.push_back(arg);
    }
    std::erase_if(found, [&](NodeId id) { return bound.contains(id); });
    std::sort(found.begin(), found.end(),
              [&](NodeId a, NodeId b) { return graph[a].payload < graph[b].payload; });
    return found;
}

} // namespace

Graph::Reads Graph::reads_of(const Node &node) const {
    Reads reads;
    const auto join = [&](Reads other) {
        reads.point |= other.point;
        reads.normal |= other.normal;
        reads.direction |= other.direction;
        reads.time |= other.time;
        reads.params |= other.params;
        reads.free_vars |= other.free_vars;
    };
    for (std::uint32_t i = 0; i < node.count; ++i) join(reads_[args_[node.first + i].index]);
    const auto join_function = [&](FunctionId id) {
        const Reads body = reads_[function(id).result.index];
        reads.time |= body.time;
        reads.params |= body.params;
    };
    if (node.op == Op::Point) reads.point = true;
    if (node.op == Op::Normal) reads.normal = true;
    if (node.op == Op::Direction) reads.direction = true;
    if (node.op == Op::Time) reads.time = true;
    if (node.op == Op::Param) reads.params = true;
    if (node.op == Op::Var) reads.free_vars = true;
    if (node.op == Op::Call) join_function(FunctionId{std::size_t{node.payload}});
    if (node.op == Op::Cached) join_function(cache(CacheId{std::size_t{node.payload}}).field);
    if (node.op == Op::Loop) {
        const Loop &loop = loops_[LoopId{std::size_t{node.payload}}];
        const bool outside = reads.free_vars;
        const std::vector<NodeId> body = body_of(loop);
        for (NodeId part : body) join(reads_[part.index]);
        reads.free_vars = outside;
        if (!outside) {
            std::vector<NodeId> free = unbound(*this, body);
            std::erase_if(free, [&](NodeId id) {
                return id == loop.index ||
                       std::find(loop.vars.begin(), loop.vars.end(), id) != loop.vars.end();
            });
            reads.free_vars = !free.empty();
        }
    }
    return reads;
}

std::vector<NodeId> Graph::free_vars(NodeId id) const { return unbound(*this, {id}); }

// -- copying

namespace {

struct Copier {
    Graph &graph;
    const Substitution &replaced;
    bool points;             // whether a Point is among the replaced
    bool any_kind;           // something else than Points and Vars is replaced
    Substitution done;       // begins with the replaced
    Substitution of_loops{}; // copies of loops that are replaced, for their other values

    // Whether nothing below the node can have been replaced, as far as `reads` tells.
    bool untouched(NodeId id) const {
        const Graph::Reads reads = graph.reads(id);
        return !any_kind && !reads.free_vars && !(points && reads.point);
    }

    NodeId copy(NodeId root) {
        std::vector<NodeId> stack{root};
        while (!stack.empty()) {
            const NodeId id = stack.back();
            if (done.contains(id)) {
                stack.pop_back();
                continue;
            }
            if (untouched(id)) {
                done.emplace(id, id);
                stack.pop_back();
                continue;
            }
            const std::size_t before = stack.size();
            for (NodeId arg : graph.args(gives_another_value(id) ? graph.arg(id, 0) : id))
                if (!done.contains(arg)) stack.push_back(arg);
            if (stack.size() > before) continue;
            stack.pop_back();
            const NodeId made = remade(id);
            done.emplace(id, made);
        }
        return done.at(root);
    }

    // A Loop stands for its first value. What replaces that says nothing of its other values, which
    // stay those of the loop.
    bool gives_another_value(NodeId id) const {
        return graph[id].op == Op::LoopResult && replaced.contains(graph.arg(id, 0));
    }

    NodeId with_other_loop(NodeId id) {
        const NodeId loop = graph.arg(id, 0);
        if (!of_loops.contains(loop)) {
            const NodeId copy = remade(loop);
            of_loops.emplace(loop, copy);
        }
        const Node node = graph[id];
        const NodeId copy = of_loops.at(loop);
        return copy == loop ? id : graph.make(node.op, node.type, {copy}, node.payload);
    }

    NodeId remade(NodeId id) {
        const Node node = graph[id];
        if (node.count == 0) return id;
        if (gives_another_value(id)) return with_other_loop(id);
        std::vector<NodeId> args;
        bool changed = false;
        for (NodeId arg : graph.args(id)) {
            args.push_back(done.at(arg));
            changed |= args.back() != arg;
        }
        std::uint32_t payload = node.payload;
        if (node.op == Op::Loop) payload = loop(LoopId{std::size_t{node.payload}}).index;
        if (!changed && payload == node.payload) return id;
        return graph.make(node.op, node.type, args, payload);
    }

    bool touches(const std::vector<NodeId> &parts) {
        if (any_kind) {
            Copier probe{graph, replaced, points, any_kind, done};
            return std::any_of(parts.begin(), parts.end(),
                               [&](NodeId id) { return probe.copy(id) != id; });
        }
        for (NodeId part : parts)
            if (points && graph.reads(part).point) return true;
        for (NodeId var : unbound(graph, parts))
            if (const auto to = done.find(var); to != done.end() && to->second != var) return true;
        return false;
    }

    // A fold whose body changes gets fresh variables: the copy may come to stand inside the
    // original.
    LoopId loop(LoopId id) {
        const Loop old = graph.loop(id);
        const std::vector<NodeId> parts = body_of(old);
        if (!touches(parts)) return id;
        Copier inside{graph, replaced, points, any_kind, done};
        Loop made = old;
        made.index = inside.done[old.index] = graph.fresh_var(Type::Int);
        for (NodeId &var : made.vars) {
            const NodeId fresh = graph.fresh_var(graph.type(var));
            inside.done[var] = fresh;
            var = fresh;
        }
        made.count = inside.copy(old.count);
        if (old.condition) made.condition = inside.copy(old.condition);
        for (NodeId &next : made.next) next = inside.copy(next);
        return graph.add_loop(std::move(made));
    }
};

} // namespace

NodeId substitute(Graph &graph, NodeId root, const Substitution &map) {
    std::size_t visited = 0;
    return substitute(graph, root, map, visited);
}

namespace {

Copier copier_of(Graph &graph, const Substitution &map) {
    Copier out{graph, map, false, false, map};
    for (const auto &[from, to] : map) {
        out.points |= graph[from].op == Op::Point;
        out.any_kind |= graph[from].op != Op::Point && graph[from].op != Op::Var;
    }
    return out;
}

} // namespace

NodeId substitute(Graph &graph, NodeId root, const Substitution &map, std::size_t &visited) {
    Copier copier = copier_of(graph, map);
    const NodeId copy = copier.copy(root);
    visited += copier.done.size();
    return copy;
}

std::vector<NodeId> substitute(Graph &graph, std::span<const NodeId> roots,
                               const Substitution &map) {
    Copier copier = copier_of(graph, map);
    std::vector<NodeId> out;
    for (const NodeId root : roots) out.push_back(copier.copy(root));
    return out;
}

} // namespace fathom::ir
