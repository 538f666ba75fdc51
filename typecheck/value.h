// What an expression of the language is while it is evaluated. A number is either known now (scene
// time) or a node of the graph (parameter or field time): one evaluator serves both, and what is
// known is computed, the rest is lowered. Values are plain data; lists, strings, closures and the
// like live in the evaluator's arenas and are named by index.
#pragma once

#include "ir/shape.h"
#include "lang/ast.h"

#include <array>
#include <cstdint>

namespace fathom::typecheck {

// The kinds of values of the language.
enum class ValueKind : std::uint8_t {
    Poison,      // an error was reported; everything made of it is poison too
    Unit,        // nothing: a `for` run for its effect, `print(…)`
    None,        // an optional argument that was not given
    Bool,        // num[0]
    Int,         // num[0], a 32-bit whole number
    Float,       // num[0]
    Vec,         // size 2..4, num; `color`: linear rgb
    Mat,         // size 2..4 (the side); id: matrices
    Field,       // id: a graph node of type Bool, Int, Float, Vec* or Mat*
    String,      // id: strings
    List,        // id: lists
    Range,       // whole numbers num[0], num[0] + num[2], … below num[1]
    Closure,     // id: closures
    Builtin,     // id: the builtin table
    Overloads,   // id: lists, of closures with one name
    ConstField,  // id: lists, of one value: the function that always gives it
    CachedField, // id: graph caches
    ImageField,  // id: scene images; num[0] the scale
    Shape,       // id: shapes; size 2 or 3
    Material,    // id: materials
    Region,      // id: regions; size 2: of flat shapes alone, else 3
    Setting,     // id: settings (camera, light, …)
    Module       // id: modules
};

// A value: numbers that are known now, or the id of a node, shape, list or closure.
struct Value {
    ValueKind kind = ValueKind::Poison;
    std::uint8_t size = 0;
    bool color = false; // Vec of 3, or Field of Vec3, that is a colour
    bool ints = false;  // Vec from a literal of whole numbers: its elements are ints where it is
                        // used as a list
    std::uint32_t id = 0;
    std::array<double, 4> num{};

    friend bool operator==(const Value &, const Value &) = default;
};

inline Value make_value(ValueKind kind, std::uint32_t id = 0) {
    Value v;
    v.kind = kind;
    v.id = id;
    return v;
}
inline Value poison() { return {}; }
inline Value unit() { return make_value(ValueKind::Unit); }
inline Value none() { return make_value(ValueKind::None); }
inline Value boolean(bool b) {
    Value v = make_value(ValueKind::Bool);
    v.num[0] = b ? 1 : 0;
    return v;
}
inline Value integer(double i) {
    Value v = make_value(ValueKind::Int);
    v.num[0] = i;
    return v;
}
inline Value number(double x) {
    Value v = make_value(ValueKind::Float);
    v.num[0] = x;
    return v;
}
inline Value vec(int size, std::array<double, 4> num, bool color = false) {
    Value v = make_value(ValueKind::Vec);
    v.size = static_cast<std::uint8_t>(size);
    v.num = num;
    v.color = color;
    return v;
}
inline Value color(double r, double g, double b) { return vec(3, {r, g, b, 0}, true); }
inline Value shape_value(ir::ShapeId id, int dims) {
    Value v = make_value(ValueKind::Shape, id.index);
    v.size = static_cast<std::uint8_t>(dims);
    return v;
}

inline bool is(const Value &v, ValueKind kind) { return v.kind == kind; }
inline bool is_poison(const Value &v) { return v.kind == ValueKind::Poison; }
inline ir::NodeId node_of(const Value &v) { return ir::NodeId{v.id}; }
inline ir::ShapeId shape_of(const Value &v) { return ir::ShapeId{v.id}; }

} // namespace fathom::typecheck
