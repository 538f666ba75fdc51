// Ops of known numbers, as the graph folds them and without its nodes: scenes compute with thousands
// of numbers that no field reads. Where one is not finite the graph has rules of its own.
#include "ir/passes/fold.h"
#include "typecheck/interpreter.h"

#include <algorithm>
#include <cmath>

namespace fathom::typecheck {

using ir::Op;
using ir::Type;

static std::optional<ir::Constant> known_number(const Value &v) {
    ir::Constant constant;
    std::size_t size = 1;
    if (v.kind == ValueKind::Int) {
        constant.type = Type::Int;
    } else if (v.kind == ValueKind::Vec) {
        constant.type = ir::vector_type(v.size);
        size = v.size;
    } else if (v.kind != ValueKind::Float) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < size; ++i) {
        if (!std::isfinite(v.num[i])) return std::nullopt;
        constant.value[i] = v.num[i] == 0 ? 0 : v.num[i]; // no -0, as in the graph
    }
    return constant;
}

std::optional<Value> folded(Op op, Type type, std::span<const Value> args, bool is_color) {
    std::array<ir::Constant, 3> numbers;
    if (args.size() > numbers.size()) return std::nullopt;
    for (std::size_t i = 0; i < args.size(); ++i) {
        const std::optional<ir::Constant> number = known_number(args[i]);
        if (!number) return std::nullopt;
        numbers[i] = *number;
    }
    const auto result = ir::evaluate(op, type, {numbers.data(), args.size()}, 0);
    const auto size = static_cast<std::size_t>(ir::components(type));
    if (!result || size > 4) return std::nullopt;
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < size; ++i) {
        values[i] = result->value[i] == 0 ? 0 : result->value[i]; // no -0, as in the graph
        if (!std::isfinite(values[i])) return std::nullopt;
    }
    if (type == Type::Int) return integer(values[0]);
    if (type == Type::Float) return number(values[0]);
    return ir::is_vector(type) ? std::optional(vec(static_cast<int>(size), values, is_color))
                               : std::nullopt;
}

} // namespace fathom::typecheck
