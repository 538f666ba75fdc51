#include "typecheck/places.h"

namespace fathom::typecheck {

void note_place(Interpreter &ev, const Value &value, Span place) {
    using ir::Op;
    constexpr std::size_t most = 16'384, most_of_one = 4;
    constexpr ir::OpSet kept{Op::Div,   Op::Mod,       Op::Pow,         Op::Step,       Op::Atan2,
                             Op::Sign,  Op::Floor,     Op::Ceil,        Op::Round,      Op::Trunc,
                             Op::Fract, Op::Sqrt,      Op::InverseSqrt, Op::Log,        Op::Log2,
                             Op::Tan,   Op::Asin,      Op::Acos,        Op::Smoothstep, Op::ToInt,
                             Op::Hash,  Op::Normalize, Op::TableRead};
    if (ev.in_field == 0 || !ev.own_field || value.kind != ValueKind::Field) return;
    const ir::NodeId node = node_of(value);
    const ir::Node &operation = ev.scene.graph[node];
    if (!kept[operation.op] && operation.type != ir::Type::Bool) return;
    auto &places = ev.scene.places;
    if (places.size() >= most) return;
    const Span at = users_place(ev, place);
    const auto [first, last] = places.equal_range(node);
    std::size_t there = 0;
    for (auto it = first; it != last; ++it)
        if (it->second == at || ++there == most_of_one) return;
    if (!is_library_place(ev, at)) places.emplace(node, at);
}

} // namespace fathom::typecheck
