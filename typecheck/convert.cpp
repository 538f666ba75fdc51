// Types as the user writes them, and the conversions that happen where one is wanted: an int
// becomes a float, a number fills a vector, a list of two to four numbers is a vector and back, a
// constant stands for a field.
#include "typecheck/remedies.h"

#include "base/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::typecheck {

using ir::Type;

std::string type_text(const lang::TypeExpr &type) {
    switch (type.kind) {
    case lang::TypeExpr::Kind::Name: // the library's own `_shape` is a shape to all others
        return type.lipschitz ? fmt::format("{}<{}>", type.name, *type.lipschitz)
                              : std::string(type.name.substr(type.name.starts_with('_') ? 1 : 0));
    case lang::TypeExpr::Kind::List: return fmt::format("[{}]", type_text(type.items[0]));
    case lang::TypeExpr::Kind::Function: {
        std::string out = "(";
        for (std::size_t i = 0; i + 1 < type.items.size(); ++i)
            out += (i ? ", " : "") + type_text(type.items[i]);
        return out + ") -> " + type_text(type.items.back());
    }
    }
    return "";
}

// Wrong wherever the function is called from, so it is said of no call.
bool check_type(Interpreter &ev, const lang::TypeExpr &type) {
    if (type.kind != lang::TypeExpr::Kind::Name) {
        bool ok = true;
        for (const lang::TypeExpr &item : type.items) ok = check_type(ev, item) && ok;
        return ok;
    }
    if (type.named != lang::TypeName::Unknown) return true;
    if (ev.quiet > 0) {
        ++ev.quiet_errors;
        return false;
    }
    if (!is_library_place(ev, type.span) && type_told_before(ev, type.name, type.span))
        return false;
    static const std::vector<std::string> names = {
        "float", "int",   "bool",  "string", "vec2",     "vec3",  "vec4",   "mat2",  "mat3",
        "mat4",  "color", "shape", "shape2", "material", "light", "region", "angle", "angles"};
    Diagnostic &d = ev.diagnostics.add(Code::UnknownName, type.span,
                                       fmt::format("there is no type `{}`", type.name));
    if (const std::string_view way = way_of_type(type.name); !way.empty()) {
        d.help(std::string(way));
        return false;
    }
    std::string near(type_from_elsewhere(type.name));
    if (near.empty()) near = nearest_name(type.name, names);
    if (!near.empty()) d.help(fmt::format("did you mean `{}`?", near), {{type.span, near}});
    if (!d.fix)
        d.help("the types are those of the language: leave it away", type_away(ev, type.span));
    return false;
}

bool is_function(const Value &v) {
    return v.kind == ValueKind::Closure || v.kind == ValueKind::Builtin ||
           v.kind == ValueKind::Overloads || v.kind == ValueKind::ConstField ||
           v.kind == ValueKind::CachedField || v.kind == ValueKind::ImageField;
}

Value list_value(Interpreter &ev, std::vector<Value> items) {
    ev.made += 64 + items.size() * sizeof(Value);
    int height = 1;
    for (const Value &item : items)
        if (item.kind == ValueKind::List) height = std::max(height, 1 + ev.list_heights[item.id]);
    ev.list_height = std::max(ev.list_height, height);
    ev.list_heights.push_back(static_cast<std::uint16_t>(std::min(height, 2 * max_list_height)));
    ev.lists.push_back(std::move(items));
    return make_value(ValueKind::List, static_cast<std::uint32_t>(ev.lists.size() - 1));
}

Value string_value(Interpreter &ev, std::string text) {
    ev.made += sizeof text + text.size();
    ev.strings.push_back(std::move(text));
    return make_value(ValueKind::String, static_cast<std::uint32_t>(ev.strings.size() - 1));
}

// A list of numbers as a vector; everything else as it is.
static Value vector_of_list(Interpreter &ev, const Value &v) {
    if (v.kind != ValueKind::List) return v;
    if (ev.lists[v.id].size() < 2 || ev.lists[v.id].size() > 4) return v;
    const std::vector<Value> items = ev.lists[v.id];
    for (const Value &item : items)
        if (!is_scalar(ev, item)) return v;
    return make_vector(ev, items, static_cast<int>(items.size()), {});
}

static std::optional<Value> as_shape(Interpreter &ev, const Value &v, const lang::TypeExpr &type) {
    if (v.kind != ValueKind::Shape) return std::nullopt;
    if (type.named == lang::TypeName::Shape && v.size != 3) return std::nullopt;
    if (type.named == lang::TypeName::Shape2 && v.size != 2) return std::nullopt;
    if (!type.lipschitz) return v;
    ir::Shape contract;
    contract.kind = ir::ShapeKind::Contract;
    contract.dims = v.size;
    contract.payload = static_cast<std::uint32_t>(ev.scene.shapes.contracts.size());
    contract.children = {shape_of(v)};
    contract.origin = ev.scene.shapes[shape_of(v)].origin;
    ev.scene.shapes.contracts.push_back({*type.lipschitz, type.span});
    return shape_value(ev.scene.shapes.add(std::move(contract)), v.size);
}

static std::optional<Value> as_color(Interpreter &ev, Value v, Type t) {
    if (t == Type::Vec4) v = swizzle(ev, v, "xyz", {}), t = Type::Vec3;
    if (t == Type::Int || t == Type::Float)
        v = make_vector(ev, {to_float(ev, v)}, 3, {}), t = Type::Vec3;
    if (t != Type::Vec3) return std::nullopt;
    v.color = true;
    return v;
}

static std::optional<Value> as_vector(Interpreter &ev, const Value &v, Type t, int size) {
    if (t == Type::Int || t == Type::Float) return make_vector(ev, {to_float(ev, v)}, size, {});
    if (v.color && size == 4) return make_vector(ev, {v, number(1)}, 4, {});
    return t == ir::vector_type(size) ? std::optional(v) : std::nullopt;
}

static std::optional<Value> as_named(Interpreter &ev, const Value &raw,
                                     const lang::TypeExpr &type) {
    using lang::TypeName;
    const auto only_if = [](bool fits, const Value &v) {
        return fits ? std::optional(v) : std::nullopt;
    };
    switch (type.named) {
    case TypeName::Unknown: return std::nullopt;
    case TypeName::Any: return raw;
    case TypeName::Shape:
    case TypeName::Shape2:
    case TypeName::AnyShape: return as_shape(ev, raw, type);
    case TypeName::String: return only_if(raw.kind == ValueKind::String, raw);
    case TypeName::Region: return only_if(raw.kind == ValueKind::Region, raw);
    case TypeName::Light: return only_if(raw.kind == ValueKind::Setting, raw);
    case TypeName::Material:
        return only_if(raw.kind == ValueKind::Material || is_function(raw) ||
                           (is_numeric(raw) && (raw.color || numeric_type(ev, raw) == Type::Vec3)),
                       raw);
    case TypeName::AnyField:
        if (is_function(raw)) return raw;
        break;
    case TypeName::Float:
    case TypeName::Int:
    case TypeName::Bool:
    case TypeName::Vec2:
    case TypeName::Vec3:
    case TypeName::Vec4:
    case TypeName::Mat2:
    case TypeName::Mat3:
    case TypeName::Mat4:
    case TypeName::Color: break;
    }
    const Value list = vector_of_list(ev, raw);
    const Value v = type.named == TypeName::Color ? or_color(list) : list;
    if (!is_numeric(v)) return std::nullopt;
    const Type t = numeric_type(ev, v);
    if (type.named == TypeName::AnyField) return v;
    if (type.named == TypeName::Bool || t == Type::Bool)
        return only_if(type.named == TypeName::Bool && t == Type::Bool, v);
    switch (type.named) {
    case TypeName::Int: return only_if(t == Type::Int, v);
    case TypeName::Float:
        if (t == Type::Int) return to_float(ev, v);
        return only_if(t == Type::Float, v);
    case TypeName::Color: return as_color(ev, v, t);
    case TypeName::Vec2: return as_vector(ev, v, t, 2);
    case TypeName::Vec3: return as_vector(ev, v, t, 3);
    case TypeName::Vec4: return as_vector(ev, v, t, 4);
    case TypeName::Mat2: return only_if(t == Type::Mat2, v);
    case TypeName::Mat3: return only_if(t == Type::Mat3, v);
    case TypeName::Mat4: return only_if(t == Type::Mat4, v);
    case TypeName::Unknown:
    case TypeName::Bool:
    case TypeName::String:
    case TypeName::Shape:
    case TypeName::Shape2:
    case TypeName::Material:
    case TypeName::Light:
    case TypeName::Region:
    case TypeName::AnyShape:
    case TypeName::AnyField:
    case TypeName::Any: break;
    }
    return std::nullopt;
}

static bool is_vector_type(const lang::TypeExpr &type) {
    return type.kind == lang::TypeExpr::Kind::Name &&
           (type.named == lang::TypeName::Vec2 || type.named == lang::TypeName::Vec3 ||
            type.named == lang::TypeName::Vec4);
}

static std::optional<Value> as_type(Interpreter &ev, const Value &v, const lang::TypeExpr &type) {
    if (is_poison(v)) return v;
    switch (type.kind) {
    case lang::TypeExpr::Kind::Name: return as_named(ev, v, type);
    case lang::TypeExpr::Kind::Function: {
        if (is_function(v)) return v;
        const lang::TypeExpr &result = type.items.back();
        const bool of_shapes =
            result.kind == lang::TypeExpr::Kind::Name &&
            (result.named == lang::TypeName::Shape || result.named == lang::TypeName::Shape2);
        if (of_shapes) return std::nullopt;
        // a constant stands for a field
        Value constant = vector_of_list(ev, v);
        if (!is_numeric(constant)) return std::nullopt;
        Value list = list_value(ev, {constant});
        return make_value(ValueKind::ConstField, list.id);
    }
    case lang::TypeExpr::Kind::List: {
        std::vector<Value> items;
        if (v.kind == ValueKind::List)
            items = ev.lists[v.id];
        else if (v.kind == ValueKind::Range ||
                 (is_numeric(v) && ir::is_vector(numeric_type(ev, v)))) {
            auto all = sequence_items(ev, v, {});
            if (!all) return std::nullopt;
            items = std::move(*all);
        } else if (v.kind == ValueKind::Shape)
            items = {v};
        else
            return std::nullopt;
        // `polygon([0, 0, 1, 0])`: a number fills one vector, not each of a list
        const auto is_number = [&](const Value &item) { return is_scalar(ev, item); };
        if (is_vector_type(type.items[0]) && !items.empty() &&
            std::ranges::all_of(items, is_number))
            return std::nullopt;
        bool changed = v.kind != ValueKind::List;
        for (Value &item : items) {
            if (!spend(ev, {})) return std::nullopt;
            auto converted = as_type(ev, item, type.items[0]);
            if (!converted) return std::nullopt;
            changed = changed || !(*converted == item);
            item = *converted;
        }
        return changed ? list_value(ev, std::move(items)) : v;
    }
    }
    return std::nullopt;
}

bool accepts(Interpreter &ev, const Value &v, const lang::TypeExpr &type) {
    return as_type(ev, v, type).has_value();
}

Value convert(Interpreter &ev, const Value &v, const lang::TypeExpr &type, Span place, What what,
              bool &ok) {
    if (auto converted = as_type(ev, v, type)) return *converted;
    ok = false;
    if (type.kind != lang::TypeExpr::Kind::List && told_of_block(ev, v, place, what))
        return poison();
    Diagnostic &d =
        report(ev, Code::TypeMismatch, place,
               fmt::format("{} wants {} `{}`, this is {}", what, type.in_radians ? "an" : "a",
                           type_text(type), describe(ev, v)));
    if (!is_library_place(ev, type.span) && !(type.span == place))
        d.label(type.span, "because of this type");
    if (type.kind == lang::TypeExpr::Kind::Name && type.named == lang::TypeName::Shape &&
        v.kind == ValueKind::Shape && v.size == 2)
        d.help("make it solid with `.extrude(height)` or `.revolve()`");
    if (type.kind == lang::TypeExpr::Kind::Name && type.named == lang::TypeName::Shape2 &&
        v.kind == ValueKind::Shape)
        d.help("it has its depth already; a flat shape is `circle(r)`, `rectangle([w, h])` or "
               "`polygon(points)`",
               text(ev.sources, place).starts_with("sphere(")
                   ? std::vector<Edit>{{{place.source, place.begin, place.begin + 6}, "circle"}}
                   : std::vector<Edit>{});
    if (type.kind == lang::TypeExpr::Kind::Name && type.named == lang::TypeName::Int &&
        is_numeric(v))
        help_with_whole(ev, d, v, place);
    if (type.kind == lang::TypeExpr::Kind::Name && type.named == lang::TypeName::Region)
        help_with_region(ev,
                         d.note("a region is `ball(r)`, `aabb(lo, hi)`, `tube(axis, r)` or "
                                "`everywhere`"),
                         v, place);
    if (type.kind == lang::TypeExpr::Kind::List && v.kind == ValueKind::List &&
        (type.items[0].named == lang::TypeName::Shape ||
         type.items[0].named == lang::TypeName::AnyShape)) {
        const auto &items = ev.lists[v.id];
        if (std::ranges::any_of(items, [](const Value &x) { return x.kind == ValueKind::Region; }))
            d.help("among them is a region, which only cuts: a ball that is seen is a `sphere`");
        else if (std::ranges::any_of(items, [&](const Value &x) { return is_scalar(ev, x); }))
            d.help("leave the number away; what flows together by it is `smooth_union(0.2, a, b)`");
        else if (std::ranges::any_of(items,
                                     [](const Value &x) { return x.kind == ValueKind::List; }))
            d.help("a list among the shapes is one of them as `union(list)`");
    }
    if (type.kind == lang::TypeExpr::Kind::List && is_vector_type(type.items[0]))
        d.help("each vector stands in brackets of its own: `[[0, 0], [1, 0], [1, 1]]`");
    if (type.kind == lang::TypeExpr::Kind::Name && is_vector_type(type) && is_function(v))
        d.help("a vector is what the function gives where it is called: `vec3(1, 2, 3)`");
    if (v.kind == ValueKind::Shape) help_with_shape(d, what.of);
    if (!d.fix && is_function(v)) help_with_uncalled(ev, d, v, place);
    if (type.kind == lang::TypeExpr::Kind::Name) help_with_value(ev, d, v, type.named, place);
    if (what.name == "count" && v.kind == ValueKind::Vec && d.fix && d.fix->edits.size() == 1 &&
        d.fix->edits[0].replacement == ", 0")
        d.fix->edits[0].replacement = ", 1"; // a count begins there
    if (what.of == "rotate" && what.name == "angle" && v.kind == ValueKind::Vec)
        d.help("the angle comes first: `.rotate(angle, axis)`; `.rotate_euler([x, y, z])` turns "
               "about all three axes");
    return poison();
}

// -- what builtins demand of their arguments

void want(Interpreter &ev, const Value &v, Span place, What what, std::string_view wanted) {
    if (is_poison(v)) return;
    Diagnostic &d = report(ev, Code::TypeMismatch, place,
                           fmt::format("{} wants {}, this is {}", what, wanted, describe(ev, v)));
    using lang::TypeName;
    if (wanted == "a color") help_with_value(ev, d, v, TypeName::Color, place);
    if (wanted == "a number") help_with_value(ev, d, v, TypeName::Float, place);
    if (wanted == "a vec3" && v.kind == ValueKind::Shape)
        d.help("a shape tells no place: write it as a vector, `[0, 0, 0]`");
    if (wanted == "a vec3") help_with_value(ev, d, v, TypeName::Vec3, place);
    if (v.kind == ValueKind::Shape && wanted == "a color") help_with_shape(d, "color");
    if (v.kind == ValueKind::Shape && what.text == "`max_steps`") help_with_rendered(ev, d, place);
    if (wanted.starts_with("a region")) help_with_region(ev, d, v, place);
}

// The number, or nothing after a report.
static Value limited(Interpreter &ev, const Value &v, Span place, What what, Limit limit) {
    switch (limit) {
    case Limit::Size: return sized(ev, v, place, what);
    case Limit::Finite: return finite_number(ev, v, place, what) ? v : poison();
    case Limit::None: return v;
    }
    return v;
}

std::optional<double> want_known_number(Interpreter &ev, const Value &v, Span place, What what,
                                        Limit limit) {
    if (!is_scalar(ev, v)) {
        want(ev, v, place, what, "a number");
        return std::nullopt;
    }
    auto known = element_as_known(ev, v, place, what);
    if (!known) return std::nullopt;
    const Value x = limited(ev, *known, place, what, limit);
    return is_poison(x) ? std::nullopt : std::optional(x.num[0]);
}

// `l.length` where a count is wanted: of a vector that is its length.
static void help_with_count(const Interpreter &ev, Diagnostic &d, Span place) {
    constexpr std::string_view member = ".length";
    const std::string_view written = text(ev.sources, place);
    if (!written.ends_with(member) || is_library_place(ev, place)) {
        d.help("`int(x)` cuts the fraction off, `round(x)` takes the nearest");
        return;
    }
    const auto end = static_cast<std::uint32_t>(place.end - member.size());
    d.help("how many there are is `len(…)`; this is the length of a vector",
           {{{place.source, place.begin, place.begin}, "len("},
            {{place.source, end, place.end}, ")"}});
}

std::optional<int> want_known_int(Interpreter &ev, const Value &v, Span place, What what) {
    if (!is_scalar(ev, v)) {
        want(ev, v, place, what, "a whole number");
        return std::nullopt;
    }
    auto known = element_as_known(ev, v, place, what);
    if (!known) return std::nullopt;
    if (known->num[0] != std::floor(known->num[0]) || std::abs(known->num[0]) > 2147483647.0) {
        Diagnostic &d =
            report(ev, Code::TypeMismatch, place,
                   fmt::format("{} wants a whole number, this is {}", what, known->num[0]));
        help_with_count(ev, d, place);
        return std::nullopt;
    }
    return static_cast<int>(known->num[0]);
}

std::optional<bool> want_known_bool(Interpreter &ev, const Value &v, Span place, What what) {
    if (!is_numeric(v) || numeric_type(ev, v) != Type::Bool) {
        want(ev, v, place, what, "a bool (a comparison, `true` or `false`)");
        return std::nullopt;
    }
    auto known = element_as_known(ev, v, place, what);
    return known ? std::optional(known->num[0] != 0) : std::nullopt;
}

std::optional<std::string> want_string(Interpreter &ev, const Value &v, Span place, What what) {
    if (v.kind == ValueKind::String) return ev.strings[v.id];
    want(ev, v, place, what, "a string");
    return std::nullopt;
}

std::optional<ir::NodeId> want_scalar_node(Interpreter &ev, const Value &v, Span place, What what,
                                           Limit limit) {
    if (is_scalar(ev, v)) {
        const Value x = limited(ev, to_float(ev, v), place, what, limit);
        return is_poison(x) ? std::nullopt : std::optional(to_node(ev, x));
    }
    want(ev, v, place, what, "a number");
    return std::nullopt;
}

std::optional<ir::NodeId> want_vec_node(Interpreter &ev, const Value &raw, int size, Span place,
                                        What what, Limit limit) {
    Value v = vector_of_list(ev, raw);
    if (is_numeric(v)) {
        v = limited(ev, v, place, what, limit);
        if (is_poison(v)) return std::nullopt;
        Type t = numeric_type(ev, v);
        if (t == Type::Int || t == Type::Float)
            return to_node(ev, make_vector(ev, {to_float(ev, v)}, size, place));
        if (t == ir::vector_type(size)) return to_node(ev, v);
    }
    want(ev, raw, place, what, fmt::format("a vec{}", size));
    return std::nullopt;
}

std::optional<ir::NodeId> want_color_node(Interpreter &ev, const Value &v, Span place, What what) {
    const Value c = or_color(vector_of_list(ev, v));
    if (v.kind == ValueKind::Vec && v.ints && v.size == 3 && !is_library_place(ev, place))
        warn_of_bytes(ev, place,
                      std::array{integer(v.num[0]), integer(v.num[1]), integer(v.num[2])});
    if (is_poison(sized(ev, c, place, what))) return std::nullopt;
    if (is_numeric(c) && numeric_type(ev, c) != Type::Bool)
        if (auto color = as_color(ev, c, numeric_type(ev, c))) return to_node(ev, *color);
    want(ev, v, place, what, "a color");
    return std::nullopt;
}

std::optional<ir::ShapeId> want_shape(Interpreter &ev, const Value &v, Span place, What what,
                                      int dims) {
    if (v.kind == ValueKind::Shape && (dims == 0 || v.size == dims)) return shape_of(v);
    if (v.kind == ValueKind::Shape && dims == 3) {
        report(ev, Code::FlatShape, place,
               fmt::format("{} wants a solid, this is a flat shape", what))
            .help("make it solid with `.extrude(height)` or `.revolve()`");
        return std::nullopt;
    }
    want(ev, v, place, what, dims == 2 ? "a flat shape" : "a shape");
    return std::nullopt;
}

std::optional<std::vector<Value>> want_list(Interpreter &ev, const Value &v, Span place,
                                            What what) {
    if (v.kind == ValueKind::List || v.kind == ValueKind::Range ||
        (is_numeric(v) && ir::is_vector(numeric_type(ev, v))))
        return sequence_items(ev, v, place);
    want(ev, v, place, what, "a list");
    return std::nullopt;
}

std::optional<std::vector<ir::ShapeId>> want_shapes(Interpreter &ev, const Value &v, Span place,
                                                    What what, int &dims) {
    if (is_poison(v)) return std::nullopt;
    std::vector<Value> items;
    if (v.kind == ValueKind::Shape)
        items = {v};
    else if (v.kind == ValueKind::List)
        items = ev.lists[v.id];
    else {
        want(ev, v, place, what, "shapes");
        return std::nullopt;
    }
    std::vector<ir::ShapeId> shapes;
    for (const Value &item : items) {
        if (!spend(ev, place)) return std::nullopt;
        if (is_poison(item)) continue; // reported; the others still make a picture
        if (item.kind == ValueKind::List) {
            auto inner = want_shapes(ev, item, place, what, dims);
            if (inner) shapes.insert(shapes.end(), inner->begin(), inner->end());
            continue;
        }
        if (item.kind != ValueKind::Shape) {
            want(ev, item, place, what, "shapes");
            return std::nullopt;
        }
        bool empty = ev.scene.shapes[shape_of(item)].kind == ir::ShapeKind::Empty;
        if (dims == 0 && !empty) dims = item.size;
        if (!empty && item.size != dims) {
            report(ev, Code::FlatShape, place, fmt::format("{} mixes solids and flat shapes", what))
                .help("make the flat ones solid with `.extrude(height)` or `.revolve()`");
            return std::nullopt;
        }
        shapes.push_back(shape_of(item));
    }
    return shapes;
}

} // namespace fathom::typecheck
