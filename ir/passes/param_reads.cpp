#include "ir/passes/param_reads.h"

namespace fathom::ir {

void ParamReads::form(ShapeId id) {
    if (!id || !shapes_.insert(id.index).second) return;
    const Shape &s = scene_.shapes[id];
    for (NodeId arg : s.args) node(arg);
    if (s.kind == ShapeKind::Within) region(scene_.shapes.regions[s.payload]);
    for (ShapeId child : s.children) form(child);
}

void ParamReads::node(NodeId root) {
    std::vector<NodeId> todo{root};
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !nodes_.insert(id.index).second || !scene_.graph.reads(id).params) continue;
        const Node &n = scene_.graph[id];
        if (n.op == Op::Param) used_[n.payload] = true;
        if (n.op == Op::Call) todo.push_back(scene_.graph.function(FunctionId{n.payload}).result);
        if (n.op == Op::Cached)
            todo.push_back(
                scene_.graph.function(scene_.graph.cache(CacheId{n.payload}).field).result);
        if (n.op == Op::Loop) {
            const Loop &loop = scene_.graph.loop(LoopId{n.payload});
            todo.insert(todo.end(), loop.next.begin(), loop.next.end());
            todo.push_back(loop.condition);
            todo.push_back(loop.count);
        }
        for (NodeId arg : scene_.graph.args(id)) todo.push_back(arg);
    }
}

void ParamReads::region(const Region &region) {
    node(region.center), node(region.size);
    for (const Region &less : region.less) this->region(less);
}

} // namespace fathom::ir
