// Functions of the point: a lambda, a named function, a constant or a cached field becomes one
// expression of the graph.
#include "typecheck/interpreter.h"
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <utility>

namespace fathom::typecheck {

using ir::Type;

int parameter_count(Interpreter &ev, const Value &f) {
    if (f.kind != ValueKind::Closure) return -1;
    const Closure &c = ev.closures[f.id];
    return static_cast<int>(c.ast->functions[c.function].parameters.size());
}

// The numbers that a function or a constant gives there; else reported, with what is wanted.
static std::optional<Value> numbers_at(Interpreter &ev, const Value &field,
                                       const std::vector<ir::NodeId> &inputs,
                                       std::string_view wanted, Span place, What what) {
    if (is_poison(field)) return std::nullopt;
    Value value;
    if (is_function(field)) {
        std::vector<Value> args;
        int count = parameter_count(ev, field);
        std::size_t used =
            count < 0 ? 1 : std::min<std::size_t>(static_cast<std::size_t>(count), inputs.size());
        if (count > static_cast<int>(inputs.size())) {
            Diagnostic &d = report(
                ev, Code::TypeMismatch, place,
                fmt::format("{} wants a function of {}, this one has {} parameters", what,
                            inputs.size() == 1 ? "the point" : "the point and the normal", count));
            if (count == ir::components(ev.scene.graph[inputs[0]].type))
                help_with_parts(ev, d, field, place);
            return std::nullopt;
        }
        for (std::size_t i = 0; i < std::max<std::size_t>(used, 1); ++i)
            args.push_back(from_node(ev, inputs[i]));
        if (count == 0) args.clear();
        const bool own = field.kind != ValueKind::Closure || !ev.closures[field.id].library;
        const bool outer = std::exchange(ev.own_field, ev.in_field > 0 ? ev.own_field : own);
        const bool outermost = !ev.field_start;
        if (outermost) ev.field_start = ev.scene.graph.size();
        ++ev.in_field;
        value = call_with(ev, field, args, place);
        --ev.in_field;
        if (outermost) ev.made += bytes_of_long_field(ev), ev.field_start.reset();
        ev.own_field = outer;
    } else {
        value = field;
    }
    if (is_poison(value)) return std::nullopt;
    if (value.kind == ValueKind::List) {
        std::vector<Value> items = ev.lists[value.id];
        if (items.size() >= 2 && items.size() <= 4)
            value = make_vector(ev, items, static_cast<int>(items.size()), place);
    }
    if (!is_numeric(value)) {
        Diagnostic &d = report(ev, Code::TypeMismatch, place,
                               fmt::format("{} wants a function that gives a {}, this one gives {}",
                                           what, wanted, describe(ev, value)));
        if (value.kind == ValueKind::Unit || value.kind == ValueKind::None)
            d.help("the last expression is the value; an `if` that gives one has an `else`");
        return std::nullopt;
    }
    if (!finite_number(ev, value, place, what)) return std::nullopt;
    return value;
}

std::optional<ir::NodeId> apply_field(Interpreter &ev, const Value &field,
                                      const std::vector<ir::NodeId> &inputs, Type result,
                                      Span place, What what, bool *is_color) {
    const auto found = numbers_at(ev, field, inputs, ir::type_name(result), place, what);
    if (!found) return std::nullopt;
    const Value &value = *found;
    const Type type = numeric_type(ev, value);
    if (is_color) *is_color = value.color;
    if (type == result) return to_node(ev, value);
    if (type == Type::Int || type == Type::Float) {
        ir::NodeId scalar = to_node(ev, to_float(ev, value));
        return result == Type::Float ? scalar : ev.scene.graph.splat(scalar, result);
    }
    Diagnostic &d = report(ev, Code::TypeMismatch, place,
                           fmt::format("{} wants a function that gives a {}, this one gives {}",
                                       what, ir::type_name(result), describe(ev, value)));
    if (result == Type::Float && type == Type::Bool)
        help_with_condition(ev, d, place);
    else if (result == Type::Vec3 && type == Type::Vec4)
        d.help("of four numbers, as an `image` has them, the first three are `.rgb` or `.xyz`");
    else
        d.help(result == Type::Float && ir::is_vector(type)
                   ? "one number of a vector is its length, `length(p) - 1`, or a part, `p.y`"
                   : "let the function's last expression give that");
    return std::nullopt;
}

std::optional<ir::NodeId> apply_any(Interpreter &ev, const Value &field, Span place, What what) {
    constexpr std::string_view wanted = "float or a vec3";
    const auto value = numbers_at(ev, field, {ev.scene.graph.point()}, wanted, place, what);
    if (!value) return std::nullopt;
    const Type type = numeric_type(ev, *value);
    if (type == Type::Vec3) return to_node(ev, *value);
    if (type == Type::Float || type == Type::Int) return to_node(ev, to_float(ev, *value));
    report(ev, Code::TypeMismatch, place,
           fmt::format("{} wants a function that gives a {}, this one gives {}", what, wanted,
                       describe(ev, *value)));
    return std::nullopt;
}

std::optional<ir::Material> want_material(Interpreter &ev, const Value &given, Span place,
                                          What what) {
    const Value v = or_color(given);
    if (v.kind == ValueKind::Material) return ev.materials[v.id];
    if (is_poison(v)) return std::nullopt;
    ir::Graph &g = ev.scene.graph;
    ir::Material m;
    m.specular = g.vec3(1, 1, 1);
    m.exponent = g.number(32);
    m.emission = g.vec3(0, 0, 0);
    if (is_function(v)) {
        ir::NodeId normal = g.make(ir::Op::Normal, Type::Vec3, std::initializer_list<ir::NodeId>{});
        auto diffuse = apply_field(ev, v, {g.point(), normal}, Type::Vec3, place, what);
        if (!diffuse) return std::nullopt;
        m.diffuse = *diffuse;
        return m;
    }
    auto diffuse = want_color_node(ev, v, place, what);
    if (!diffuse) return std::nullopt;
    m.diffuse = *diffuse;
    return m;
}

} // namespace fathom::typecheck
