// A blend of distances as arithmetic, for steps: the profiles of ir/blends.h, computed with terms
// of the graph in place of numbers.
#include "ir/blends.h"
#include "save-format/program.h"

namespace fathom::save {
namespace {

// A number of the profile's own, or an expression.
struct Term {
    Term(double number) : value(number) {} // NOLINT: as numbers stand in for T
    Term(float number) : value(double(number)) {}
    Term(int number) : value(number) {}
    Term(ir::Graph &of, ir::NodeId node) : graph(&of), id(node) {}

    ir::NodeId in(ir::Graph &other) const { return graph ? id : other.number(value); }

    ir::Graph *graph = nullptr;
    ir::NodeId id;
    double value = 0;
};

Term joined(ir::Op op, const Term &a, const Term &b) {
    if (!a.graph && !b.graph) { // T(1) + T(1): as one would compute it
        ir::Graph numbers;
        return *numbers.as_number(numbers.make(op, {a.in(numbers), b.in(numbers)}));
    }
    ir::Graph &graph = a.graph ? *a.graph : *b.graph;
    return {graph, graph.make(op, {a.in(graph), b.in(graph)})};
}
Term of_one(ir::Op op, const Term &a) {
    if (!a.graph) {
        ir::Graph numbers;
        return *numbers.as_number(numbers.make(op, {a.in(numbers)}));
    }
    return {*a.graph, a.graph->make(op, {a.id})};
}

// Found by the profiles, as those of numbers would be.
Term operator+(const Term &a, const Term &b) { return joined(ir::Op::Add, a, b); }
Term operator-(const Term &a, const Term &b) { return joined(ir::Op::Sub, a, b); }
Term operator*(const Term &a, const Term &b) { return joined(ir::Op::Mul, a, b); }
Term operator/(const Term &a, const Term &b) { return joined(ir::Op::Div, a, b); }
Term minimum(const Term &a, const Term &b) { return joined(ir::Op::Min, a, b); }
Term maximum(const Term &a, const Term &b) { return joined(ir::Op::Max, a, b); }
Term gap(const Term &a, const Term &b) { return of_one(ir::Op::Abs, a - b); }
Term floor(const Term &a) { return of_one(ir::Op::Floor, a); }
Term sqrt(const Term &a) { return of_one(ir::Op::Sqrt, a); }

Term blended(ir::Profile profile, const Term &a, const Term &b, const Term &r, const Term &n) {
    switch (profile) {
    case ir::Profile::Smooth: return ir::sem::blend_smooth(a, b, r);
    case ir::Profile::Round: return ir::sem::blend_round(a, b, r);
    case ir::Profile::Chamfer: return ir::sem::blend_chamfer(a, b, r);
    case ir::Profile::Stairs: return ir::sem::blend_stairs(a, b, r, n);
    case ir::Profile::Columns: return ir::sem::blend_columns(a, b, r, n);
    }
    return a;
}

} // namespace

ir::NodeId blend_expression(ir::Graph &graph, ir::NodeId blend) {
    const std::vector<ir::NodeId> args(graph.args(blend).begin(), graph.args(blend).end());
    const auto profile = static_cast<ir::Profile>(graph[blend].payload);
    Term result(graph, args[2]);
    for (std::size_t i = 3; i < args.size(); ++i)
        result = blended(profile, result, Term(graph, args[i]), Term(graph, args[0]),
                         Term(graph, args[1]));
    return result.in(graph);
}

} // namespace fathom::save
