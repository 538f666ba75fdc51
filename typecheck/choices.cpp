// The choice between two values by a condition that is known at field time alone.
#include "typecheck/interpreter.h"

#include <algorithm>

namespace fathom::typecheck {

using ir::Op;
using ir::Type;

// Lists of as many items, item by item: what GLSL has as a `struct` of a distance and a colour.
// Longer or deeper ones are no such, and every item is a node.
static std::optional<Value> select_items(Interpreter &ev, const Value &condition, const Value &a,
                                         const Value &b) {
    constexpr std::size_t most_items = 16;
    constexpr int deepest = 3;
    const std::vector<Value> &x = ev.lists[a.id], &y = ev.lists[b.id];
    if (x.size() != y.size() || x.size() > most_items ||
        std::max(ev.list_heights[a.id], ev.list_heights[b.id]) > deepest)
        return std::nullopt;
    std::vector<Value> items;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto item = select_value(ev, condition, x[i], y[i]);
        if (!item) return std::nullopt;
        items.push_back(*item);
    }
    return list_value(ev, std::move(items));
}

// Nothing where the two cannot be told apart by numbers at field time (a shape in one arm, say).
std::optional<Value> select_value(Interpreter &ev, const Value &condition, const Value &a,
                                  const Value &b) {
    if (condition.kind == ValueKind::Bool) return condition.num[0] != 0 ? a : b;
    if (is_poison(a) || is_poison(b)) return poison();
    if (a == b) return a;
    if (a.kind == ValueKind::List && b.kind == ValueKind::List)
        return select_items(ev, condition, a, b);
    if (!is_numeric(a) || !is_numeric(b)) return std::nullopt;
    Value x = a, y = b;
    Type tx = numeric_type(ev, x), ty = numeric_type(ev, y);
    if (tx != ty && (tx == Type::Int || ty == Type::Int)) {
        x = to_float(ev, x), y = to_float(ev, y);
        tx = numeric_type(ev, x), ty = numeric_type(ev, y);
    }
    ir::NodeId nx = to_node(ev, x), ny = to_node(ev, y);
    if (tx != ty) {
        if (tx == Type::Float && ir::is_vector(ty))
            nx = ev.scene.graph.splat(nx, ty);
        else if (ty == Type::Float && ir::is_vector(tx))
            ny = ev.scene.graph.splat(ny, tx);
        else
            return std::nullopt;
    }
    return from_node(ev, ev.scene.graph.make(Op::Select, {node_of(condition), nx, ny}),
                     a.color || b.color);
}

} // namespace fathom::typecheck
