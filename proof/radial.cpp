#include "proof/radial.h"

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

// Reads factors, and finds the one vector on whose length they depend.
class Factors {
  public:
    explicit Factors(const Graph &graph) : graph_(graph) {}
    NodeId vector;

    // A number, c/|v|^q, or the least or greatest of such.
    bool falls(NodeId id, int depth = 0) {
        if (is_still(id)) return true;
        if (depth > max_depth) return false;
        const ir::Node node = graph_[id];
        const auto arg = [&](int i) { return graph_.arg(id, i); };
        if (node.op == Op::Neg) return falls(arg(0), depth + 1);
        if (node.op == Op::Min || node.op == Op::Max)
            return falls(arg(0), depth + 1) && falls(arg(1), depth + 1);
        if (node.op == Op::Clamp)
            return falls(arg(0), depth + 1) && is_still(arg(1)) && is_still(arg(2));
        if (node.op == Op::Mul)
            return is_still(arg(0))   ? falls(arg(1), depth + 1)
                   : is_still(arg(1)) ? falls(arg(0), depth + 1)
                                      : false;
        if (node.op != Op::Div) return false;
        return is_still(arg(1)) ? falls(arg(0), depth + 1)
                                : is_still(arg(0)) && grows(arg(1), depth + 1);
    }
    // |v| or |v|^2, times a number, or kept between two.
    bool grows(NodeId id, int depth = 0) {
        if (depth > max_depth) return false;
        const ir::Node node = graph_[id];
        const auto arg = [&](int i) { return graph_.arg(id, i); };
        if (node.op == Op::Length) return of(arg(0));
        if (node.op == Op::Dot) return arg(0) == arg(1) && of(arg(0));
        if (node.op == Op::Clamp)
            return grows(arg(0), depth + 1) && is_still(arg(1)) && is_still(arg(2));
        if (node.op != Op::Min && node.op != Op::Max && node.op != Op::Mul) return false;
        return is_still(arg(0))   ? grows(arg(1), depth + 1)
               : is_still(arg(1)) ? grows(arg(0), depth + 1)
                                  : false;
    }

  private:
    static constexpr int max_depth = 8;
    bool is_still(NodeId id) const {
        return !graph_.reads(id).point && !graph_.reads(id).free_vars;
    }
    bool of(NodeId v) {
        if (vector && vector != v) return false;
        vector = v;
        return true;
    }
    const Graph &graph_;
};

// The vector itself, or components of it, each once.
bool is_part(const Graph &graph, NodeId part, NodeId vector) {
    if (part == vector) return true;
    const ir::Node node = graph[part];
    if (node.op != Op::Swizzle || graph.arg(part, 0) != vector) return false;
    unsigned seen = 0;
    for (int i = 0; i < ir::swizzle_size(node.payload); ++i) {
        const unsigned one = 1u << ir::swizzle_component(node.payload, i);
        if (seen & one) return false;
        seen |= one;
    }
    return true;
}

} // namespace

std::optional<Radial> radial(Graph &graph, NodeId product) {
    const bool divides = graph[product].op == Op::Div;
    for (int i = divides ? 1 : 0; i < 2; ++i) {
        const NodeId beside = graph.arg(product, i), part = graph.arg(product, 1 - i);
        const NodeId factor = graph[beside].op == Op::Splat ? graph.arg(beside, 0) : beside;
        if (graph.type(factor) != ir::Type::Float) continue;
        Factors factors(graph);
        const bool fits = divides ? factors.grows(factor) : factors.falls(factor);
        if (fits && factors.vector && is_part(graph, part, factors.vector))
            return Radial{factors.vector, factor, divides};
    }
    return {};
}

} // namespace fathom::proof
