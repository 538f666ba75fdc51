// Arithmetic on numbers of both stages. What is known is computed through the graph's own constant
// folding (so that an op has one meaning); the everyday operations on plain numbers have a short
// way. What is not known becomes a node.
#include "ir/passes/walk.h"
#include "ir/passes/without_waves.h"
#include "typecheck/interpreter.h"
#include "typecheck/places.h"
#include "typecheck/remedies.h"
#include "typecheck/told_apart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::typecheck {

using ir::Op;
using ir::Type;

bool is_numeric(const Value &v) {
    return v.kind == ValueKind::Bool || v.kind == ValueKind::Int || v.kind == ValueKind::Float ||
           v.kind == ValueKind::Vec || v.kind == ValueKind::Mat || v.kind == ValueKind::Field;
}

Type numeric_type(const Interpreter &ev, const Value &v) {
    switch (v.kind) {
    case ValueKind::Bool: return Type::Bool;
    case ValueKind::Int: return Type::Int;
    case ValueKind::Vec: return ir::vector_type(v.size);
    case ValueKind::Mat: return ir::matrix_type(v.size);
    case ValueKind::Field: return ev.scene.graph[node_of(v)].type;
    case ValueKind::Float:
    case ValueKind::Poison:
    case ValueKind::Unit:
    case ValueKind::None:
    case ValueKind::String:
    case ValueKind::List:
    case ValueKind::Range:
    case ValueKind::Closure:
    case ValueKind::Builtin:
    case ValueKind::Overloads:
    case ValueKind::ConstField:
    case ValueKind::CachedField:
    case ValueKind::ImageField:
    case ValueKind::Shape:
    case ValueKind::Material:
    case ValueKind::Region:
    case ValueKind::Setting:
    case ValueKind::Module: return Type::Float;
    }
    return Type::Float;
}

bool is_scalar(const Interpreter &ev, const Value &v) {
    if (!is_numeric(v)) return false;
    Type type = numeric_type(ev, v);
    return type == Type::Int || type == Type::Float;
}

ir::NodeId to_node(Interpreter &ev, const Value &v) {
    ir::Graph &graph = ev.scene.graph;
    if (v.kind == ValueKind::Field) return node_of(v);
    ir::Constant constant;
    constant.type = numeric_type(ev, v);
    if (v.kind == ValueKind::Mat)
        constant.value = ev.matrices[v.id];
    else
        std::copy(v.num.begin(), v.num.begin() + (v.kind == ValueKind::Vec ? v.size : 1),
                  constant.value.begin());
    return graph.constant(constant);
}

Value from_node(Interpreter &ev, ir::NodeId node, bool is_color) {
    const ir::Graph &graph = ev.scene.graph;
    if (!graph.is_constant(node)) {
        Value v = make_value(ValueKind::Field, node.index);
        v.color = is_color;
        return v;
    }
    const ir::Constant &c = graph.constant_of(node);
    switch (c.type) {
    case Type::Bool: return boolean(c.value[0] != 0);
    case Type::Int: return integer(c.value[0]);
    case Type::Float: return number(c.value[0]);
    case Type::Vec2:
    case Type::Vec3:
    case Type::Vec4:
        return vec(ir::components(c.type), {c.value[0], c.value[1], c.value[2], c.value[3]},
                   is_color);
    case Type::Mat2:
    case Type::Mat3:
    case Type::Mat4: {
        ev.matrices.push_back(c.value);
        Value v = make_value(ValueKind::Mat, static_cast<std::uint32_t>(ev.matrices.size() - 1));
        v.size = static_cast<std::uint8_t>(ir::side(c.type));
        return v;
    }
    case Type::Hit: break;
    }
    return poison();
}

Value to_float(Interpreter &ev, const Value &v) {
    if (v.kind == ValueKind::Int || v.kind == ValueKind::Bool) return number(v.num[0]);
    if (v.kind == ValueKind::Field &&
        (numeric_type(ev, v) == Type::Int || numeric_type(ev, v) == Type::Bool))
        return from_node(ev, ev.scene.graph.make(Op::ToFloat, Type::Float, {node_of(v)}));
    return v;
}

static bool known_scalar(const Value &v) {
    return v.kind == ValueKind::Int || v.kind == ValueKind::Float;
}

static bool any_color(const std::vector<Value> &args) {
    for (const Value &a : args)
        if (a.color) return true;
    return false;
}

// Ops that keep whole numbers whole; all others take floats.
// Componentwise ops broadcast a number to the widest argument; a whole number becomes a float
// beside a float.
Value apply_op(Interpreter &ev, Op op, std::vector<Value> args, Span place, std::string_view name) {
    Type widest = Type::Int;
    for (Value &a : args) {
        if (is_poison(a)) return poison();
        a = or_color(a);
        if (a.kind == ValueKind::List || !is_numeric(a) || numeric_type(ev, a) == Type::Bool) {
            report(ev, Code::TypeMismatch, place,
                   fmt::format("`{}` wants numbers, this is {}", name, describe(ev, a)));
            return poison();
        }
        Type type = numeric_type(ev, a);
        if (type == Type::Int) continue;
        if (widest == Type::Int || widest == Type::Float)
            widest = type;
        else if (type != Type::Float && type != widest) {
            report(ev, Code::TypeMismatch, place,
                   fmt::format("`{}` wants vectors of one size, these are {} and {}", name,
                               ir::type_name(widest), ir::type_name(type)));
            return poison();
        }
    }
    if (widest == Type::Int && ir::info(op).takes != ir::Takes::Numbers) widest = Type::Float;
    for (Value &a : args) {
        if (widest != Type::Int) a = to_float(ev, a);
        if (known_scalar(a) && ir::is_vector(widest)) { // as a splat of it
            const double x = a.num[0];
            a = vec(ir::components(widest), {x, x, x, x}, a.color);
        }
    }
    const bool is_color = any_color(args) && widest == Type::Vec3;
    if (ir::info(op).rule == ir::TypeRule::Same)
        if (const auto known = folded(op, widest, args, is_color)) return *known;
    std::vector<ir::NodeId> nodes;
    for (Value &a : args) {
        ir::NodeId node = to_node(ev, a);
        if (ir::components(widest) > 1 && ir::components(ev.scene.graph[node].type) == 1)
            node = ev.scene.graph.splat(node, widest);
        nodes.push_back(ir::tells_apart[op] ? told_apart(ev, node, place) : node);
    }
    return from_node(ev, ev.scene.graph.make(op, nodes), is_color);
}

static Value overflow(Interpreter &ev, Span place, double value) {
    report(ev, Code::NumberRange, place,
           fmt::format("{:.0f} does not fit a whole number of 32 bits", value))
        .help("write one of the numbers with a decimal point, and floats are used");
    return poison();
}

static Value checked_int(Interpreter &ev, double value, Span place) {
    if (value < std::numeric_limits<std::int32_t>::min() ||
        value > std::numeric_limits<std::int32_t>::max())
        return overflow(ev, place, value);
    return integer(value);
}

static const char *operator_text(lang::BinaryOp op) {
    switch (op) {
    case lang::BinaryOp::Union: return "|";
    case lang::BinaryOp::Intersection: return "&";
    case lang::BinaryOp::Or: return "or";
    case lang::BinaryOp::And: return "and";
    case lang::BinaryOp::Equal: return "==";
    case lang::BinaryOp::NotEqual: return "!=";
    case lang::BinaryOp::Less: return "<";
    case lang::BinaryOp::LessEqual: return "<=";
    case lang::BinaryOp::Greater: return ">";
    case lang::BinaryOp::GreaterEqual: return ">=";
    case lang::BinaryOp::Add: return "+";
    case lang::BinaryOp::Sub: return "-";
    case lang::BinaryOp::Mul: return "*";
    case lang::BinaryOp::Div: return "/";
    case lang::BinaryOp::Mod: return "%";
    case lang::BinaryOp::Pow: return "^";
    }
    return "";
}

static Value compare(Interpreter &ev, lang::BinaryOp op, const Value &a, const Value &b,
                     Span place) {
    using lang::BinaryOp;
    bool equality = op == BinaryOp::Equal || op == BinaryOp::NotEqual;
    if (known_scalar(a) && known_scalar(b)) {
        double x = a.num[0], y = b.num[0];
        switch (op) {
        case BinaryOp::Less: return boolean(x < y);
        case BinaryOp::LessEqual: return boolean(x <= y);
        case BinaryOp::Greater: return boolean(x > y);
        case BinaryOp::GreaterEqual: return boolean(x >= y);
        case BinaryOp::Equal: return boolean(x == y);
        case BinaryOp::NotEqual: return boolean(x != y);
        case BinaryOp::Union:
        case BinaryOp::Intersection:
        case BinaryOp::Or:
        case BinaryOp::And:
        case BinaryOp::Add:
        case BinaryOp::Sub:
        case BinaryOp::Mul:
        case BinaryOp::Div:
        case BinaryOp::Mod:
        case BinaryOp::Pow: break;
        }
    }
    if (equality && a.kind == b.kind && a.kind != ValueKind::Field) {
        bool same = false;
        if (a.kind == ValueKind::String) {
            if (!spend(ev, place, ev.strings[a.id].size() / 64)) return poison();
            same = ev.strings[a.id] == ev.strings[b.id];
        } else if (a.kind == ValueKind::Bool || a.kind == ValueKind::Vec)
            same = a.size == b.size && a.num == b.num;
        else if (a.kind == ValueKind::None)
            same = true;
        else {
            Diagnostic &d = report(ev, Code::TypeMismatch, place,
                                   fmt::format("{} cannot be compared", describe(ev, a)));
            if (a.kind == ValueKind::Shape)
                d.help("to unite shapes, write `a | b`; to cut one out of another, `a - b`");
            return poison();
        }
        return boolean(same == (op == BinaryOp::Equal));
    }
    bool scalars = is_scalar(ev, a) && is_scalar(ev, b);
    bool bools = equality && is_numeric(a) && is_numeric(b) && numeric_type(ev, a) == Type::Bool &&
                 numeric_type(ev, b) == Type::Bool;
    if (!scalars && !bools) {
        report(ev, Code::TypeMismatch, place,
               fmt::format("`{}` compares two numbers, these are {} and {}", operator_text(op),
                           describe(ev, a), describe(ev, b)));
        return poison();
    }
    bool whole = !bools && numeric_type(ev, a) == Type::Int && numeric_type(ev, b) == Type::Int;
    ir::NodeId x = to_node(ev, whole || bools ? a : to_float(ev, a)),
               y = to_node(ev, whole || bools ? b : to_float(ev, b));
    ir::Graph &g = ev.scene.graph;
    x = told_apart(ev, x, place);
    y = told_apart(ev, y, place);
    switch (op) {
    case BinaryOp::Less: return from_node(ev, g.make(Op::Less, {x, y}));
    case BinaryOp::LessEqual: return from_node(ev, g.make(Op::LessEqual, {x, y}));
    case BinaryOp::Greater: return from_node(ev, g.make(Op::Less, {y, x}));
    case BinaryOp::GreaterEqual: return from_node(ev, g.make(Op::LessEqual, {y, x}));
    case BinaryOp::Equal: return from_node(ev, g.make(Op::Equal, {x, y}));
    case BinaryOp::NotEqual: return from_node(ev, g.make(Op::NotEqual, {x, y}));
    case BinaryOp::Union:
    case BinaryOp::Intersection:
    case BinaryOp::Or:
    case BinaryOp::And:
    case BinaryOp::Add:
    case BinaryOp::Sub:
    case BinaryOp::Mul:
    case BinaryOp::Div:
    case BinaryOp::Mod:
    case BinaryOp::Pow: break;
    }
    return poison();
}

static bool holds_zero(const Value &v) {
    const std::size_t size = v.kind == ValueKind::Vec ? v.size : known_scalar(v) ? 1 : 0;
    return std::ranges::count(std::span(v.num).first(size), 0.0) > 0;
}

static Value division_by_zero(Interpreter &ev, Span place, const char *what) {
    report(ev, Code::NumberRange, place, fmt::format("{} by zero", what))
        .help("divide by another number, or ask with `if` before");
    return poison();
}

// A matrix times a matrix or a vector of its side.
static std::optional<Value> matrix_product(Interpreter &ev, const Value &a, const Value &b,
                                           Span place) {
    Type ta = numeric_type(ev, a), tb = numeric_type(ev, b);
    bool ma = ir::is_matrix(ta), mb = ir::is_matrix(tb);
    if (!(ma && (mb || ir::is_vector(tb))) && !(mb && ir::is_vector(ta))) return std::nullopt;
    int side_a = ma ? ir::side(ta) : ir::components(ta),
        side_b = mb ? ir::side(tb) : ir::components(tb);
    if (side_a != side_b) {
        report(ev, Code::TypeMismatch, place,
               fmt::format("{} and {} cannot be multiplied: their sizes differ", describe(ev, a),
                           describe(ev, b)));
        return poison();
    }
    Type type = ma && mb ? ta : ma ? tb : ta;
    return from_node(ev, ev.scene.graph.make(Op::MatMul, type, {to_node(ev, a), to_node(ev, b)}));
}

// A list of 2 to 4 numbers is a vector where one is wanted.
static Value as_vector(Interpreter &ev, const Value &v) {
    if (v.kind != ValueKind::List) return v;
    const std::vector<Value> items = ev.lists[v.id];
    if (items.size() < 2 || items.size() > 4) return v;
    for (const Value &item : items)
        if (!is_scalar(ev, item)) return v;
    return make_vector(ev, items, static_cast<int>(items.size()), {});
}

static Value combined(Interpreter &ev, lang::BinaryOp op, const Value &left, const Value &right,
                      Span place, Span a_place, Span b_place) {
    using lang::BinaryOp;
    if (known_scalar(left) && known_scalar(right)) {
        double x = left.num[0], y = right.num[0];
        bool whole = left.kind == ValueKind::Int && right.kind == ValueKind::Int;
        switch (op) {
        case BinaryOp::Add: return whole ? checked_int(ev, x + y, place) : number(x + y);
        case BinaryOp::Sub: return whole ? checked_int(ev, x - y, place) : number(x - y);
        case BinaryOp::Mul: return whole ? checked_int(ev, x * y, place) : number(x * y);
        case BinaryOp::Div: return y == 0 ? division_by_zero(ev, place, "division") : number(x / y);
        case BinaryOp::Mod: {
            if (y == 0) return division_by_zero(ev, place, "remainder of a division");
            double r = x - y * std::floor(x / y);
            return whole ? integer(r) : number(r);
        }
        case BinaryOp::Pow: {
            double r = std::pow(x, y);
            return whole && y >= 0 ? checked_int(ev, r, place) : number(r);
        }
        case BinaryOp::Union:
        case BinaryOp::Intersection:
        case BinaryOp::Or:
        case BinaryOp::And:
        case BinaryOp::Equal:
        case BinaryOp::NotEqual:
        case BinaryOp::Less:
        case BinaryOp::LessEqual:
        case BinaryOp::Greater:
        case BinaryOp::GreaterEqual: break;
        }
    }
    Value a = as_vector(ev, left), b = as_vector(ev, right);
    if (op == BinaryOp::Less || op == BinaryOp::LessEqual || op == BinaryOp::Greater ||
        op == BinaryOp::GreaterEqual || op == BinaryOp::Equal || op == BinaryOp::NotEqual)
        return compare(ev, op, a, b, place);
    if (op == BinaryOp::Add && a.kind == ValueKind::String) {
        const std::size_t shown = b.kind == ValueKind::String ? ev.strings[b.id].size() : 0;
        const std::size_t size = ev.strings[a.id].size() + shown;
        if (!spend(ev, place, size / 64) || !has_room(ev, place, size)) return poison();
        return string_value(ev, ev.strings[a.id] + print_value(ev, b));
    }
    auto numeric = [&](const Value &v) {
        return is_numeric(v) && numeric_type(ev, v) != Type::Bool;
    };
    if (!numeric(a) || !numeric(b)) {
        bool left_wrong = !numeric(a);
        Diagnostic &d = report(ev, Code::TypeMismatch, left_wrong ? a_place : b_place,
                               fmt::format("`{}` wants numbers, this is {}", operator_text(op),
                                           describe(ev, left_wrong ? a : b)));
        const Value &wrong = left_wrong ? a : b;
        if (is_function(wrong))
            d.help(text(ev.sources, left_wrong ? a_place : b_place) == "degrees"
                       ? "the unit touches its number: `45deg`"
                       : "call it with a point: `f(p)`");
        if (a.kind == ValueKind::String) d.help("a value is joined to a string by `+`");
        const auto is_rows = [&](const Value &v) { // `[[1, 0], [0, 1]]`
            return v.kind == ValueKind::List && !ev.lists[v.id].empty() &&
                   (ev.lists[v.id][0].kind == ValueKind::List ||
                    ev.lists[v.id][0].kind == ValueKind::Vec);
        };
        if (op == BinaryOp::Mul && (is_rows(a) || is_rows(b)))
            d.help("a matrix is made of its columns: `mat2([1, 0], [0, 1])`");
        else if (op == BinaryOp::Mul && a.kind == ValueKind::List)
            d.help("a list is made by a loop: `[for i in 0..3 { 0 }]`");
        const auto is_list = [&](const Value &v) {
            return v.kind == ValueKind::List ||
                   (is_numeric(v) && ir::is_vector(numeric_type(ev, v)));
        };
        if (op == BinaryOp::Add && is_list(a) && is_list(b) && !is_library_place(ev, a_place))
            d.help("lists are joined by `concat(a, b)`",
                   {{{a_place.source, a_place.begin, a_place.begin}, "concat("},
                    {{a_place.source, a_place.end, b_place.begin}, ", "},
                    {{a_place.source, b_place.end, b_place.end}, ")"}});
        if (wrong.kind == ValueKind::Shape && op == BinaryOp::Add)
            d.help("shapes are united with `|`",
                   sign_edit(ev, a_place, b_place, '+', a.kind == b.kind ? "|" : ""));
        if (wrong.kind == ValueKind::Shape && op == BinaryOp::Mul)
            d.help("a shape is made larger with `.scale(2)`");
        return poison();
    }
    if (op == BinaryOp::Mul)
        if (auto product = matrix_product(ev, a, b, place)) return *product;
    const bool divides = op == BinaryOp::Div || op == BinaryOp::Mod;
    if (divides && a.kind != ValueKind::Field && holds_zero(b))
        return division_by_zero(ev, place,
                                op == BinaryOp::Div ? "division" : "remainder of a division");
    switch (op) {
    case BinaryOp::Add: return apply_op(ev, Op::Add, {a, b}, place, "+");
    case BinaryOp::Sub: return apply_op(ev, Op::Sub, {a, b}, place, "-");
    case BinaryOp::Mul: return apply_op(ev, Op::Mul, {a, b}, place, "*");
    case BinaryOp::Div:
        return apply_op(ev, Op::Div, {to_float(ev, a), to_float(ev, b)}, place, "/");
    case BinaryOp::Mod: return apply_op(ev, Op::Mod, {a, b}, place, "%");
    case BinaryOp::Pow: {
        // a small whole exponent is repeated multiplication: exact, cheap, and easy to bound
        if (b.kind == ValueKind::Int && b.num[0] >= 1 && b.num[0] <= 8) {
            Value product = a;
            for (int i = 1; i < static_cast<int>(b.num[0]); ++i)
                product = apply_op(ev, Op::Mul, {product, a}, place, "^");
            return product;
        }
        return apply_op(ev, Op::Pow, {a, b}, place, "^");
    }
    case BinaryOp::Union:
    case BinaryOp::Intersection:
    case BinaryOp::Or:
    case BinaryOp::And:
    case BinaryOp::Equal:
    case BinaryOp::NotEqual:
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual: break;
    }
    return poison();
}

Value arithmetic(Interpreter &ev, lang::BinaryOp op, const Value &left, const Value &right,
                 Span place, Span a_place, Span b_place) {
    if (is_poison(left) || is_poison(right)) return poison();
    const Value v = combined(ev, op, left, right, place, a_place, b_place);
    if (v.kind == ValueKind::Bool || v.kind == ValueKind::Int) return v;
    if (v.kind == ValueKind::Field && numeric_type(ev, v) == Type::Bool) return v; // a comparison
    note_place(ev, v, place);
    return computed(ev, v, std::array{left, right}, place, quoted(operator_text(op)));
}

Value negate(Interpreter &ev, const Value &v, Span place) {
    if (v.kind == ValueKind::Int) return checked_int(ev, -v.num[0], place);
    if (v.kind == ValueKind::Float) return number(-v.num[0]);
    return apply_op(ev, Op::Neg, {as_vector(ev, v)}, place, "-");
}

// -- truth ---------------------------------------------------------------------------------------

Value logical_not(Interpreter &ev, const Value &a) {
    if (a.kind == ValueKind::Bool) return boolean(a.num[0] == 0);
    return from_node(ev, ev.scene.graph.make(Op::Not, {to_node(ev, a)}));
}
Value logical_and(Interpreter &ev, const Value &a, const Value &b) {
    if (a.kind == ValueKind::Bool) return a.num[0] != 0 ? b : a;
    if (b.kind == ValueKind::Bool) return b.num[0] != 0 ? a : b;
    return from_node(ev, ev.scene.graph.make(Op::And, {to_node(ev, a), to_node(ev, b)}));
}
Value logical_or(Interpreter &ev, const Value &a, const Value &b) {
    if (a.kind == ValueKind::Bool) return a.num[0] != 0 ? a : b;
    if (b.kind == ValueKind::Bool) return b.num[0] != 0 ? b : a;
    return from_node(ev, ev.scene.graph.make(Op::Or, {to_node(ev, a), to_node(ev, b)}));
}

} // namespace fathom::typecheck
