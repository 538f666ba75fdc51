#include "proof/read_through.h"

namespace fathom::proof {

using ir::NodeId;
using ir::Op;

namespace {

constexpr ir::OpSet affine{Op::Add,     Op::Sub,   Op::Neg,    Op::Mul, Op::Div,  Op::Make,
                           Op::Swizzle, Op::Splat, Op::MatMul, Op::Dot, Op::Cross},
    folds{Op::Abs, Op::Mod, Op::Fract, Op::Floor, Op::Round, Op::Clamp};

// Is a vector's component 0, whatever the params?
bool is_zero(const ir::Graph &graph, NodeId vector, int component) {
    if (graph.is_constant(vector))
        return graph.constant_of(vector).value[std::size_t(component)] == 0;
    const bool of_numbers = graph[vector].op == Op::Make &&
                            graph[vector].count == unsigned(ir::components(graph[vector].type));
    return of_numbers && graph.as_number(graph.arg(vector, component)) == 0.0;
}

// The coordinates that a dot product of the point does not depend on: `dot(p, vec3(a, b, 0))`.
unsigned left_out(const ir::Graph &graph, NodeId dot) {
    unsigned out = 0;
    for (int i = 0; i < 2; ++i) {
        const NodeId point = graph.arg(dot, i), by = graph.arg(dot, 1 - i);
        if (graph[point].op != Op::Point || graph.reads(by).point) continue;
        for (int k = 0; k < ir::components(graph[point].type); ++k)
            if (is_zero(graph, by, k)) out |= 1u << k;
    }
    return out;
}

} // namespace

bool is_affine_op(Op op) { return affine[op]; }

bool ReadThrough::is_coordinates(NodeId id) const {
    const Op op = graph_[id].op;
    return op == Op::Point || (op == Op::Swizzle && graph_[graph_.arg(id, 0)].op == Op::Point);
}

const Below &ReadThrough::below(NodeId id) {
    if (const auto it = known_.find(id); it != known_.end()) return it->second;
    Below out;
    const ir::Node node = graph_[id];
    if (node.op == Op::Point) {
        out.coordinates = (1u << ir::components(node.type)) - 1;
    } else if (is_coordinates(id)) {
        for (int i = 0; i < ir::components(node.type); ++i)
            out.coordinates |= 1u << ir::swizzle_component(node.payload, i);
    } else if (graph_.reads(id).point) {
        out.is_fold = affine[node.op] || folds[node.op];
        out.is_affine = affine[node.op];
        int moving = 0; // arguments that read the point
        for (NodeId arg : graph_.args(id)) {
            const Below one = below(arg);
            out.coordinates |= one.coordinates;
            out.is_affine = out.is_affine && one.is_affine;
            out.is_fold = out.is_fold && one.is_fold;
            moving += graph_.reads(arg).point;
        }
        constexpr ir::OpSet products{Op::Mul, Op::Div, Op::MatMul, Op::Dot, Op::Cross};
        if (node.op == Op::Dot && moving > 1) out.is_fold = false; // a square, or a length's
        if (node.op == Op::Dot) out.coordinates &= ~left_out(graph_, id);
        if ((products[node.op] && moving > 1) ||
            (node.op == Op::Div && graph_.reads(graph_.arg(id, 1)).point))
            out.is_affine = false;
    }
    return known_[id] = out;
}

unsigned ReadThrough::beside(std::vector<NodeId> roots, const std::unordered_set<NodeId> &parts) {
    unsigned out = 0;
    std::unordered_set<NodeId> seen = parts;
    while (!roots.empty()) {
        const NodeId id = roots.back();
        roots.pop_back();
        if (!id || !seen.insert(id).second || !graph_.reads(id).point) continue;
        if (is_coordinates(id)) {
            out |= below(id).coordinates;
            continue;
        }
        roots.insert(roots.end(), graph_.args(id).begin(), graph_.args(id).end());
        if (graph_[id].op != Op::Loop) continue;
        const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[id].payload});
        roots.insert(roots.end(), loop.next.begin(), loop.next.end());
        roots.insert(roots.end(), {loop.count, loop.condition});
    }
    return out;
}

} // namespace fathom::proof
