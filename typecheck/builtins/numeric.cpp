// GLSL's numeric functions by their names, constructors, and the library's noise primitives: names
// for ops of the graph.
#include "base/srgb.h"
#include "typecheck/binding.h"
#include "typecheck/interpreter.h"
#include "typecheck/remedies.h"
#include "typecheck/told_apart.h"

#include "ir/maps.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

using ir::Op;
using ir::Type;

template <Op op>
static Value componentwise(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    for (Value &a : args) {
        if (is_poison(a)) return poison();
        if (a.kind == ValueKind::List) {
            std::vector<Value> items = ev.lists[a.id];
            if (items.size() >= 2 && items.size() <= 4 && is_scalar(ev, items[0]))
                a = make_vector(ev, items, int(items.size()), site.call);
        }
    }
    for (std::size_t i = 0; i < args.size(); ++i)
        if (args[i] = or_color(args[i]);
            !is_numeric(args[i]) || numeric_type(ev, args[i]) == Type::Bool) {
            Diagnostic &d = report(ev, Code::TypeMismatch, site.arg(i),
                                   fmt::format("`{}` wants a number or a vector, this is {}",
                                               site.name, describe(ev, args[i])));
            if (args[i].kind == ValueKind::Shape) help_with_shapes(ev, d, site, args);
            return poison();
        }
    return apply_op(ev, op, args, site.call, site.name);
}

// Where GLSL leaves a function of the op table undefined.
static bool is_undefined(Op op, double x) {
#define FATHOM_FUNCTION(name, function, glsl, weight, cost, parity, trouble, undefined, doc)       \
    if (op == Op::name) return undefined;
#include "ir/ops.def"
    return false;
}

// A function of the op table; where it is undefined is an error at scene time.
template <Op op>
static Value function_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (args[0].kind == ValueKind::Int || args[0].kind == ValueKind::Float) {
        if (const double x = args[0].num[0]; is_undefined(op, x)) {
            report(ev, Code::NumberRange, site.arg(0),
                   fmt::format("`{}({})` is not a number", site.name, x));
            return poison();
        }
    }
    return componentwise<op>(ev, site, args);
}

template <Op op>
static Value extremum(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    std::vector<Value> items{args[0]};
    if (!is(args[1], ValueKind::None)) {
        auto rest = want_list(ev, args[1], site.arg(1), quoted(site.name));
        if (!rest) return poison();
        items.insert(items.end(), rest->begin(), rest->end());
    } else if (auto all = want_list(ev, args[0], site.arg(0),
                                    fmt::format("`{}` with one argument", site.name)))
        items = *all;
    else
        return poison();
    if (items.empty()) {
        report(ev, Code::BadArgument, site.arg(0), fmt::format("`{}` of an empty list", site.name));
        return poison();
    }
    Value best = items[0];
    for (std::size_t i = 1; i < items.size(); ++i) {
        std::vector<Value> pair{best, items[i]};
        best = componentwise<op>(ev, site, pair);
        if (is_poison(best)) return best;
    }
    return best;
}

static Value atan_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (is(args[1], ValueKind::None)) {
        args.pop_back();
        return componentwise<Op::Atan>(ev, site, args);
    }
    return componentwise<Op::Atan2>(ev, site, args);
}

static std::optional<Value> vector_argument(Interpreter &ev, const CallSite &site, const Value &raw,
                                            std::size_t i) {
    Value v = raw;
    if (v.kind == ValueKind::List) {
        std::vector<Value> items = ev.lists[v.id];
        if (items.size() >= 2 && items.size() <= 4 && is_scalar(ev, items[0]))
            v = make_vector(ev, items, int(items.size()), site.call);
    }
    if (is_numeric(v) && ir::is_vector(numeric_type(ev, v))) return v;
    if (is_scalar(ev, v)) return to_float(ev, v);
    if (!is_poison(v))
        report(ev, Code::TypeMismatch, site.arg(i),
               fmt::format("`{}` wants a vector, this is {}", site.name, describe(ev, v)));
    return std::nullopt;
}

static Value length_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto v = vector_argument(ev, site, args[0], 0);
    if (!v) return poison();
    if (is_scalar(ev, *v)) return apply_op(ev, Op::Abs, {*v}, site.call, site.name);
    if (const auto known = folded(Op::Length, Type::Float, {&*v, 1}, false)) return *known;
    return from_node(ev, ev.scene.graph.make(Op::Length, {to_node(ev, *v)}));
}

static Value normalize_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto v = vector_argument(ev, site, args[0], 0);
    if (!v) return poison();
    if (is_scalar(ev, *v)) return apply_op(ev, Op::Sign, {*v}, site.call, site.name);
    return from_node(ev, ev.scene.graph.make(Op::Normalize, {to_node(ev, *v)}));
}

template <Op op>
static Value product(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto a = vector_argument(ev, site, args[0], 0), b = vector_argument(ev, site, args[1], 1);
    if (!a || !b) return poison();
    Type ta = numeric_type(ev, *a), tb = numeric_type(ev, *b);
    if (op == Op::Cross && (ta != Type::Vec3 || tb != Type::Vec3)) {
        report(ev, Code::TypeMismatch, site.call,
               fmt::format("`cross` wants two vec3, these are {} and {}", describe(ev, *a),
                           describe(ev, *b)));
        return poison();
    }
    if (op == Op::Dot && is_scalar(ev, *a) && is_scalar(ev, *b))
        return apply_op(ev, Op::Mul, {*a, *b}, site.call, site.name);
    if (is_scalar(ev, *a)) a = make_vector(ev, {*a}, ir::components(tb), site.call), ta = tb;
    if (is_scalar(ev, *b)) b = make_vector(ev, {*b}, ir::components(ta), site.call), tb = ta;
    if (ta != tb) {
        report(ev, Code::TypeMismatch, site.call,
               fmt::format("`{}` wants vectors of one size, these are {} and {}", site.name,
                           describe(ev, *a), describe(ev, *b)));
        return poison();
    }
    const Type type = op == Op::Dot ? Type::Float : ta;
    if (const auto known = folded(op, type, std::array{*a, *b}, false)) return *known;
    return from_node(ev, ev.scene.graph.make(op, {to_node(ev, *a), to_node(ev, *b)}));
}

// mix(a, b, t) where t may also be a bool: then it chooses b or a.
static Value mix_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (is_numeric(args[2]) && numeric_type(ev, args[2]) == Type::Bool) {
        if (auto v = select_value(ev, args[2], args[1], args[0])) return *v;
        report(ev, Code::TypeMismatch, site.call, "`mix` wants two values of one type");
        return poison();
    }
    return componentwise<Op::Mix>(ev, site, args);
}

// -- constructors --------------------------------------------------------------------------------

template <int size>
static Value vec_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    std::vector<Value> parts;
    for (const Value &a : args) {
        if (is(a, ValueKind::None)) continue;
        if (a.kind == ValueKind::List)
            for (const Value &item : std::vector<Value>(ev.lists[a.id])) parts.push_back(item);
        else
            parts.push_back(a);
    }
    Value v = make_vector(ev, parts, size, site.call);
    v.ints = false;
    return v;
}

// mat3(c0, c1, c2), mat3(9 numbers, by columns), mat3(s): s on the diagonal.
template <int size>
static Value mat_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto list = want_list(ev, args[0], site.arg(0), quoted(site.name));
    if (!list) return poison();
    std::vector<Value> parts = *list;
    if (parts.size() == 1 && parts[0].kind == ValueKind::List)
        parts = std::vector<Value>(ev.lists[parts[0].id]);
    std::vector<Value> numbers;
    if (parts.size() == 1 && is_scalar(ev, parts[0])) {
        for (int i = 0; i < size * size; ++i)
            numbers.push_back(i % (size + 1) == 0 ? to_float(ev, parts[0]) : number(0));
    } else {
        for (const Value &part : parts) {
            auto v = vector_argument(ev, site, part, 0);
            if (!v) return poison();
            if (is_scalar(ev, *v))
                numbers.push_back(*v);
            else
                for (int i = 0; i < ir::components(numeric_type(ev, *v)); ++i)
                    numbers.push_back(swizzle(ev, *v, std::string(1, "xyzw"[i]), site.call));
        }
    }
    if (numbers.size() != static_cast<std::size_t>(size * size)) {
        report(ev, Code::BadArgument, site.call,
               fmt::format("a mat{} has {} numbers, not {}", size, size * size, numbers.size()));
        return poison();
    }
    std::vector<ir::NodeId> columns;
    for (int c = 0; c < size; ++c)
        columns.push_back(to_node(
            ev, make_vector(ev, {numbers.begin() + c * size, numbers.begin() + (c + 1) * size},
                            size, site.call)));
    return from_node(ev, ev.scene.graph.make(Op::Make, ir::matrix_type(size), columns));
}

static Value transpose_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (!is_numeric(args[0]) || !ir::is_matrix(numeric_type(ev, args[0]))) {
        report(ev, Code::TypeMismatch, site.arg(0),
               fmt::format("`transpose` wants a matrix, this is {}", describe(ev, args[0])));
        return poison();
    }
    return from_node(ev, ev.scene.graph.make(Op::Transpose, {to_node(ev, args[0])}));
}

static Value int_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    const Value &v = args[0];
    if (is_numeric(v) && (is_scalar(ev, v) || numeric_type(ev, v) == Type::Bool)) {
        if (numeric_type(ev, v) == Type::Int) return v;
        if (v.kind == ValueKind::Float && std::abs(v.num[0]) >= 2147483648.0) {
            report(ev, Code::NumberRange, site.arg(0),
                   fmt::format("{:.0f} does not fit a whole number of 32 bits", v.num[0]))
                .help("`floor` and `trunc` cut a float off and keep it one");
            return poison();
        }
        const ir::NodeId number = told_apart(ev, to_node(ev, v), site.arg(0));
        return from_node(ev, ev.scene.graph.make(Op::ToInt, Type::Int, {number}));
    }
    report(ev, Code::TypeMismatch, site.arg(0),
           fmt::format("`int` wants a number, this is {}", describe(ev, v)));
    return poison();
}

static Value float_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    const Value &v = args[0];
    if (is_numeric(v) && (is_scalar(ev, v) || numeric_type(ev, v) == Type::Bool))
        return to_float(ev, v);
    report(ev, Code::TypeMismatch, site.arg(0),
           fmt::format("`float` wants a number, this is {}", describe(ev, v)));
    return poison();
}

static Value div_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    for (std::size_t i = 0; i < 2; ++i)
        if (!is_numeric(args[i]) || numeric_type(ev, args[i]) != Type::Int) {
            report(ev, Code::TypeMismatch, site.arg(i),
                   fmt::format("`div` divides whole numbers, this is {}", describe(ev, args[i])));
            return poison();
        }
    if (args[1].kind == ValueKind::Int && args[1].num[0] == 0) {
        report(ev, Code::NumberRange, site.arg(1), "division by zero");
        return poison();
    }
    return apply_op(ev, Op::Div, args, site.call, site.name);
}

static Value rgb_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    // sRGB in the text, linear inside (docs/language.md)
    auto linear = [&](const Value &v) {
        if (v.kind != ValueKind::Field) {
            return number(linear_of_srgb(v.num[0]));
        }
        ir::Graph &g = ev.scene.graph;
        ir::NodeId c = to_node(ev, to_float(ev, v));
        ir::NodeId low = g.div(c, g.number(12.92));
        ir::NodeId base =
            g.make(Op::Max, {g.div({g.add(c, g.number(0.055)), g.number(1.055)}), g.number(0)});
        ir::NodeId high = g.make(Op::Pow, {base, g.number(2.4)});
        return from_node(
            ev, g.make(Op::Select, {g.make(Op::LessEqual, {c, g.number(0.04045)}), low, high}));
    };
    warn_of_bytes(ev, site.call, args);
    std::vector<Value> parts;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!is_scalar(ev, args[i])) {
            report(ev, Code::TypeMismatch, site.arg(i),
                   fmt::format("`rgb` wants three numbers, this is {}", describe(ev, args[i])));
            return poison();
        }
        parts.push_back(linear(to_float(ev, args[i])));
    }
    Value v = make_vector(ev, parts, 3, site.call);
    v.color = true;
    v.ints = false;
    return v;
}

// -- noise ---------------------------------------------------------------------------------------

template <Op op>
static Value noise_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto p = want_vec_node(ev, args[0], 3, site.arg(0), quoted(site.name));
    if (!p) return poison();
    return from_node(ev, ev.scene.graph.make(op, {*p}));
}

static Value spot_noise_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto p = want_vec_node(ev, args[0], 3, site.arg(0), "`spot_noise`");
    auto r = want_scalar_node(ev, args[1], site.arg(1), "`radius`"),
         d = want_scalar_node(ev, args[2], site.arg(2), "`density`");
    if (!p || !r || !d) return poison();
    return from_node(ev, ev.scene.graph.make(Op::SpotNoise, Type::Float, {*p, *r, *d}));
}

static Value hash_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto v = vector_argument(ev, site, args[0], 0);
    if (!v) return poison();
    if (is_scalar(ev, args[0]) && numeric_type(ev, args[0]) == Type::Int) v = args[0];
    if (const auto known = folded(Op::Hash, Type::Float, {&*v, 1}, false)) return *known;
    const ir::NodeId number = told_apart(ev, to_node(ev, *v), site.arg(0));
    return from_node(ev, ev.scene.graph.make(Op::Hash, {number}));
}

// -- matrices of rotations (library only)

static Value rotation_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto angle = want_scalar_node(ev, args[0], site.arg(0), "`angle`");
    auto axis = want_vec_node(ev, args[1], 3, site.arg(1), "`axis`");
    if (!angle || !axis) return poison();
    return from_node(ev, ir::rotation(ev.scene.graph, *axis, *angle));
}
static Value rotation2_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto angle = want_scalar_node(ev, args[0], site.arg(0), "`angle`");
    return angle ? from_node(ev, ir::rotation2(ev.scene.graph, *angle)) : poison();
}
static Value rotation_euler_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto angles = want_vec_node(ev, args[0], 3, site.arg(0), "`angles`");
    return angles ? from_node(ev, ir::rotation_euler(ev.scene.graph, *angles)) : poison();
}
static Value rotation_between_call(Interpreter &ev, const CallSite &site,
                                   std::vector<Value> &args) {
    auto from = want_vec_node(ev, args[0], 3, site.arg(0), "`from`"),
         to = want_vec_node(ev, args[1], 3, site.arg(1), "`to`");
    if (!from || !to) return poison();
    return from_node(ev, ir::rotation_between(ev.scene.graph, *from, *to));
}
static Value axis_index_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto axis = want_vec_node(ev, args[0], 3, site.arg(0), "`axis`");
    if (!axis) return poison();
    if (!ev.scene.graph.is_constant(*axis)) return integer(-1);
    const ir::Constant c = ev.scene.graph.constant_of(*axis);
    for (std::size_t i = 0; i < 3; ++i)
        if (c.value[i] > 0 && c.value[(i + 1) % 3] == 0 && c.value[(i + 2) % 3] == 0)
            return integer(double(i));
    return integer(-1);
}

static std::vector<BuiltinParameter> argument_of(Op op) {
    return {{.name = "x", .is_angle = op == Op::Sin || op == Op::Cos || op == Op::Tan}};
}

void add_numeric_builtins(std::vector<Builtin> &table) {
    auto add = [&](const char *name, std::vector<BuiltinParameter> parameters, auto call,
                   const char *doc, bool variadic = false, bool library = false) {
        const std::string_view word = name; // what compares numbers may compare with `inf`
        const bool compares = word == "min" || word == "max" || word == "clamp";
        table.push_back({name, std::move(parameters), variadic, library, call, "", doc, !compares});
    };
#define FATHOM_FUNCTION(name, function, glsl, weight, cost, parity, trouble, undefined, doc)       \
    if (Op::name != Op::Atan) add(#function, argument_of(Op::name), function_call<Op::name>, doc);
#include "ir/ops.def"
    add("atan", {{"y"}, {"x", true}}, atan_call,
        "the angle whose tangent is y, or of the point (x, y); 0 at the origin");
    add("pow", {{"x"}, {"y"}}, componentwise<Op::Pow>, "x to the power of y");
    add("abs", {{"x"}}, componentwise<Op::Abs>, "without its sign");
    add("sign", {{"x"}}, componentwise<Op::Sign>, "-1, 0 or 1");
    add("floor", {{"x"}}, componentwise<Op::Floor>, "the whole number at or below x");
    add("ceil", {{"x"}}, componentwise<Op::Ceil>, "the whole number at or above x");
    add("round", {{"x"}}, componentwise<Op::Round>, "the nearest whole number, halves upward");
    add("trunc", {{"x"}}, componentwise<Op::Trunc>, "without its fraction");
    add("fract", {{"x"}}, componentwise<Op::Fract>, "x - floor(x)");
    add("mod", {{"x"}, {"y"}}, componentwise<Op::Mod>, "x - y * floor(x / y), as `%`");
    add("min", {{"a"}, {"b", true}}, extremum<Op::Min>,
        "the smallest of two, of several, or of a list");
    add("max", {{"a"}, {"b", true}}, extremum<Op::Max>,
        "the largest of two, of several, or of a list");
    table[table.size() - 1].variadic = table[table.size() - 2].variadic = true;
    add("clamp", {{"x"}, {"lo"}, {"hi"}}, componentwise<Op::Clamp>, "x, kept between lo and hi");
    add("mix", {{"a"}, {"b"}, {"t"}}, mix_call, "a * (1 - t) + b * t; t may be a bool");
    add("step", {{"edge"}, {"x"}}, componentwise<Op::Step>, "0 below the edge, else 1");
    add("smoothstep", {{"lo"}, {"hi"}, {"x"}}, componentwise<Op::Smoothstep>,
        "0 below lo, 1 above hi, smooth between");
    add("length", {{"v"}}, length_call, "the length of a vector");
    add("dot", {{"a"}, {"b"}}, product<Op::Dot>, "the dot product");
    add("cross", {{"a"}, {"b"}}, product<Op::Cross>, "the cross product");
    add("normalize", {{"v"}}, normalize_call, "the vector of length 1 with v's direction; 0 for 0");
    add("transpose", {{"m"}}, transpose_call, "the matrix with rows and columns exchanged");
    add("vec2", {{"x"}, {"y", true}}, vec_call<2>,
        "a vec2 of numbers and vectors one after another");
    add("vec3", {{"x"}, {"y", true}, {"z", true}}, vec_call<3>,
        "a vec3 of numbers and vectors one after another");
    add("vec4", {{"x"}, {"y", true}, {"z", true}, {"w", true}}, vec_call<4>,
        "a vec4 of numbers and vectors one after another");
    add("mat2", {{"columns"}}, mat_call<2>,
        "a mat2 of its columns, of 4 numbers by columns, or of its diagonal", true);
    add("mat3", {{"columns"}}, mat_call<3>,
        "a mat3 of its columns, of 9 numbers by columns, or of its diagonal", true);
    add("mat4", {{"columns"}}, mat_call<4>,
        "a mat4 of its columns, of 16 numbers by columns, or of its diagonal", true);
    add("int", {{"x"}}, int_call, "the whole number that is left when the fraction is cut off");
    add("float", {{"x"}}, float_call, "a number as a float; of a bool 0 or 1");
    add("div", {{"a"}, {"b"}}, div_call, "the whole quotient of two ints, towards 0");
    add("rgb", {{"r"}, {"g"}, {"b"}}, rgb_call, "a colour of sRGB parts in 0..1");
    add("hash", {{"x"}}, hash_call,
        "a number in 0..1 that looks random, the same on every machine");
    add("_perlin", {{"p"}}, noise_call<Op::Perlin>, "", false, true);
    add("_simplex", {{"p"}}, noise_call<Op::Simplex>, "", false, true);
    add("_value_noise", {{"p"}}, noise_call<Op::ValueNoise>, "", false, true);
    add("_worley", {{"p"}}, noise_call<Op::Worley>, "", false, true);
    add("_spot_noise", {{"p"}, {"radius"}, {"density"}}, spot_noise_call, "", false, true);
    add("_rotation", {{"angle"}, {"axis"}}, rotation_call, "", false, true);
    add("_rotation2", {{"angle"}}, rotation2_call, "", false, true);
    add("_rotation_euler", {{"angles"}}, rotation_euler_call, "", false, true);
    add("_rotation_between", {{"from"}, {"to"}}, rotation_between_call, "", false, true);
    add("_axis_index", {{"axis"}}, axis_index_call, "", false, true);
}

} // namespace fathom::typecheck
