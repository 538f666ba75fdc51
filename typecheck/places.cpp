#include "typecheck/places.h"

namespace fathom::typecheck {
namespace {

bool is_noted(const Interpreter &ev) { return ev.in_field > 0 && ev.own_field; }

void note(Interpreter &ev, ir::NodeId node, Span place) {
    constexpr std::size_t most = 16'384, most_of_one = 4;
    auto &places = ev.scene.places;
    if (places.size() >= most) return;
    const Span at = users_place(ev, place);
    const auto [first, last] = places.equal_range(node);
    std::size_t there = 0;
    for (auto it = first; it != last; ++it)
        if (it->second == at || ++there == most_of_one) return;
    if (!is_library_place(ev, at)) places.emplace(node, at);
}

} // namespace

void note_place(Interpreter &ev, const Value &value, Span place) {
    using ir::Op;
    constexpr ir::OpSet kept{Op::Div,   Op::Mod,       Op::Pow,         Op::Step,       Op::Atan2,
                             Op::Sign,  Op::Floor,     Op::Ceil,        Op::Round,      Op::Trunc,
                             Op::Fract, Op::Sqrt,      Op::InverseSqrt, Op::Log,        Op::Log2,
                             Op::Tan,   Op::Asin,      Op::Acos,        Op::Smoothstep, Op::ToInt,
                             Op::Hash,  Op::Normalize, Op::TableRead};
    if (!is_noted(ev) || value.kind != ValueKind::Field) return;
    const ir::NodeId node = node_of(value);
    const ir::Node &operation = ev.scene.graph[node];
    if (!kept[operation.op] && operation.type != ir::Type::Bool) return;
    note(ev, node, place);
}

ir::NodeId with_noted_loops(Interpreter &ev, ir::NodeId last, Span head) {
    if (!is_noted(ev)) return last;
    const ir::Graph &graph = ev.scene.graph;
    std::vector<ir::NodeId> todo{last};
    while (!todo.empty()) { // parts, then results, then loops
        const ir::NodeId node = todo.back();
        todo.pop_back();
        if (graph[node].op == ir::Op::Loop)
            note(ev, node, head);
        else if (graph[node].op == ir::Op::LoopResult || graph[node].op == ir::Op::Make)
            todo.insert(todo.end(), graph.args(node).begin(), graph.args(node).end());
    }
    return last;
}

} // namespace fathom::typecheck
