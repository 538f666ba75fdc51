// What makes shapes: the intrinsics from which the library in stdlib/*.sdf is written (their names
// begin with `_` and only the library sees them), and the few public forms that the language itself
// cannot say (`implicit`, `cached`).
#include "typecheck/builtins/builtins.h"
#include "typecheck/conditions.h"
#include "typecheck/instances.h"
#include "typecheck/textures.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

using ir::Op;
using ir::ShapeKind;
using ir::Type;

Value added(Interpreter &ev, ir::Shape shape, const CallSite &site, int dims) {
    shape.dims = static_cast<std::uint8_t>(dims);
    shape.origin = site.call;
    // inside the library the user's own call is the place to show
    for (std::size_t i = ev.calls.size(); i-- > 0;) {
        shape.origin = ev.calls[i].call;
        if (!ev.calls[i].library) {
            shape.origin = site.call;
            break;
        }
        if (i == 0 || !ev.calls[i - 1].library) break;
    }
    return shape_value(ev.scene.shapes.add(std::move(shape)), dims);
}

bool given(const Value &v) { return v.kind != ValueKind::None; }
bool is_empty(Interpreter &ev, ir::ShapeId id) {
    return ev.scene.shapes[id].kind == ShapeKind::Empty;
}

std::optional<ir::ShapeId> first_shape(Interpreter &ev, const CallSite &site,
                                       const std::vector<Value> &args, int dims) {
    std::string_view name = ev.calls.empty() ? site.name : ev.calls.back().name;
    return want_shape(ev, args[0], site.arg(0), quoted(name), dims);
}

// -- leaves --------------------------------------------------------------------------------------

// A polygon's corners are stored for those who revolve it about an axis; what is not known now is
// left.
static void note_corners(Interpreter &ev, ir::ShapeId leaf, const Value &list) {
    if (list.kind != ValueKind::List) return;
    std::vector<std::array<double, 2>> corners;
    for (const Value &item : ev.lists[list.id]) {
        if (item.kind != ValueKind::Vec || item.size != 2) return;
        corners.push_back({item.num[0], item.num[1]});
    }
    ev.corners[leaf] = std::move(corners);
}

// _solid(f, exact, lipschitz, lo, hi, symmetric, moment_arm, growth_rate) and _flat(…, corners): a
// field with the library's claims.
template <int dims>
static Value leaf_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    ir::Graph &g = ev.scene.graph;
    auto field = apply_field(ev, args[0], {g.point(ir::vector_type(dims))}, Type::Float,
                             site.arg(0), "a shape");
    if (!field) return poison();
    ir::Shape leaf;
    leaf.kind = ShapeKind::Leaf;
    leaf.args = {*field};
    Value body = added(ev, std::move(leaf), site, dims);
    if (args.size() > 8 && given(args[8])) note_corners(ev, shape_of(body), args[8]);

    ir::Library library;
    library.name = ev.calls.empty() ? site.name : ev.calls.back().name;
    library.has_claims = true;
    ir::Claims &c = library.claims;
    if (given(args[1]) &&
        args[1].kind != ValueKind::Field) { // true only for some values of a param is not true
        auto exact = want_known_bool(ev, args[1], site.arg(1), "`exact`");
        if (exact && *exact) c.kind = ir::FieldKind::Exact, c.lipschitz = g.number(1);
    }
    if (given(args[2])) {
        auto l = want_scalar_node(ev, args[2], site.arg(2), "`lipschitz`");
        if (l) c.lipschitz = *l;
    }
    if (given(args[3]) && given(args[4])) {
        auto lo = want_vec_node(ev, args[3], dims, site.arg(3), "`lo`", Limit::None),
             hi = want_vec_node(ev, args[4], dims, site.arg(4), "`hi`", Limit::None);
        if (lo && hi) c.lo = *lo, c.hi = *hi;
    }
    if (given(args[5])) {
        auto axes = want_string(ev, args[5], site.arg(5), "`symmetric`");
        for (char a : axes.value_or("")) c.symmetric[static_cast<std::size_t>(a - 'x')] = true;
    }
    if (given(args[6])) {
        auto moment_arm = want_vec_node(ev, args[6], 3, site.arg(6), "`moment_arm`", Limit::None);
        if (moment_arm)
            for (int i = 0; i < 3; ++i)
                c.moment_arm[static_cast<std::size_t>(i)] = g.component(*moment_arm, i);
    }
    if (given(args[7])) {
        auto growth_rate = want_scalar_node(ev, args[7], site.arg(7), "`growth_rate`", Limit::None);
        if (growth_rate) c.growth_rate = *growth_rate;
    }
    return library_shape(ev, std::move(library), body, ev.scene.shapes[shape_of(body)].origin);
}

// Whether a function says that its point is a vector of so many numbers.
static bool takes_vec(const Interpreter &ev, const Value &f, int dims) {
    if (f.kind != ValueKind::Closure) return false;
    const Closure &closure = ev.closures[f.id];
    const auto &parameters = closure.ast->functions[closure.function].parameters;
    return parameters.size() == 1 && parameters[0].type &&
           parameters[0].type->kind == lang::TypeExpr::Kind::Name &&
           parameters[0].type->named == (dims == 2 ? lang::TypeName::Vec2 : lang::TypeName::Vec3);
}

// implicit(f, within, lipschitz, estimate) of a vec3; implicit2, of a vec2, is flat.
template <int dims>
static Value implicit_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (!is_function(args[0]) && !is_numeric(args[0])) {
        report(ev, Code::TypeMismatch, site.arg(0),
               fmt::format("`{}` wants a function of the point, this is {}", site.name,
                           describe(ev, args[0])))
            .help(fmt::format("write `{}(p => …)`", site.name));
        return poison();
    }
    if (ev.in_field > 0) {
        report(ev, Code::StageMismatch, site.call,
               "a shape cannot be made inside a function of the point");
        return poison();
    }
    constexpr int other = 5 - dims;
    if (takes_vec(ev, args[0], other)) {
        const char *name = other == 2 ? "implicit2" : "implicit";
        report(ev, Code::TypeMismatch, site.arg(0),
               fmt::format("`{}` wants a function of a vec{}, this one takes a vec{}", site.name,
                           dims, other))
            .help(fmt::format("`{}` makes a {} of it", name,
                              other == 2 ? "flat shape, to be extruded or revolved," : "solid"),
                  {{site.callee, name}});
        return poison();
    }
    auto field = apply_field(ev, args[0], {ev.scene.graph.point(ir::vector_type(dims))},
                             Type::Float, site.arg(0), quoted(site.name));
    if (!field) return poison();
    ir::Shape leaf;
    leaf.kind = ShapeKind::Leaf;
    leaf.args = {*field};
    auto positive = [&](std::size_t i, const char *name) {
        auto x = want_known_number(ev, args[i], site.arg(i), name);
        if (x && !(*x > 0)) {
            report(ev, Code::BadArgument, site.arg(i),
                   fmt::format("{} wants a number above 0", name));
            x.reset();
        }
        return x;
    };
    if (given(args[2])) {
        auto l = positive(2, "`lipschitz`");
        if (!l) return poison();
        leaf.assumed = *l;
    }
    if (given(args[3])) {
        auto e = positive(3, "`estimate`");
        if (!e) return poison();
        leaf.estimate = *e;
    }
    Value body = added(ev, std::move(leaf), site, dims);
    if (!given(args[1])) return body;
    auto region = want_region(ev, args[1], site.arg(1), "`within`", dims);
    return region ? within_shape(ev, site, body, *region) : poison();
}

// cached(f, cell): the same field; its values may come from the noise cache
static Value cached_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto cell = want_known_number(ev, args[1], site.arg(1), "`cell`");
    if (!cell) return poison();
    if (!(*cell > 0)) {
        report(ev, Code::BadArgument, site.arg(1), "`cell` is a length above 0");
        return poison();
    }
    if (!is_function(args[0])) {
        report(ev, Code::TypeMismatch, site.arg(0),
               fmt::format("`cached` wants a function of the point, this is {}",
                           describe(ev, args[0])));
        return poison();
    }
    ir::Graph &g = ev.scene.graph;
    ir::NodeId p = g.fresh_var(Type::Vec3);
    const std::size_t demanded = ev.scene.conditions.size();
    ++ev.in_field;
    Value v = call_with(ev, args[0], {from_node(ev, p)}, site.arg(0));
    --ev.in_field;
    if (const auto broken = put_conditions(ev, take_conditions(ev, demanded), {{p, g.point()}})) {
        report(ev, Code::BadArgument, broken->at, broken->wanted);
        return poison();
    }
    if (is_poison(v)) return v;
    bool vector =
        is_numeric(v) && (numeric_type(ev, v) == Type::Vec3 || numeric_type(ev, v) == Type::Vec4);
    if (!vector && !is_scalar(ev, v)) {
        report(ev, Code::TypeMismatch, site.arg(0),
               fmt::format("`cached` stores numbers, vec3 and colours, this function gives {}",
                           describe(ev, v)));
        return poison();
    }
    if (is_scalar(ev, v)) v = to_float(ev, v);
    ir::Function f;
    f.name = "cached_field";
    f.origin = site.call;
    f.params = {p};
    f.result = to_node(ev, v);
    ir::CacheId cache = g.add_cache({g.add_function(std::move(f)), *cell});
    Value out = make_value(ValueKind::CachedField, cache.index);
    out.color = v.color;
    return out;
}

// -- combination ---------------------------------------------------------------------------------

static std::optional<std::vector<ir::ShapeId>>
shapes_argument(Interpreter &ev, const CallSite &site, const Value &v, std::size_t i, int &dims) {
    return want_shapes(ev, v, site.arg(i),
                       fmt::format("`{}`", ev.calls.empty() ? site.name : ev.calls.back().name),
                       dims);
}

static Value n_ary(Interpreter &ev, const CallSite &site, ShapeKind kind,
                   std::vector<ir::ShapeId> children, int dims) {
    if (dims == 0) dims = 3;
    if (children.empty()) {
        ir::Shape empty;
        return added(ev, std::move(empty), site, dims);
    }
    if (children.size() == 1) return shape_value(children[0], dims);
    ir::Shape s;
    s.kind = kind;
    s.children = std::move(children);
    return added(ev, std::move(s), site, dims);
}

static Value union_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    int dims = 0;
    auto shapes = shapes_argument(ev, site, args[0], 0, dims);
    if (!shapes) return poison();
    if (dims == 0) dims = 3;
    return shape_value(unite(ev, std::move(*shapes), dims, site.call), dims);
}

static Value intersection_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    int dims = 0;
    auto shapes = shapes_argument(ev, site, args[0], 0, dims);
    if (!shapes) return poison();
    for (ir::ShapeId s : *shapes)
        if (is_empty(ev, s)) return shape_value(s, dims == 0 ? 3 : dims);
    return n_ary(ev, site, ShapeKind::Intersection, std::move(*shapes), dims);
}

static Value complement_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = want_shape(ev, args[0], site.arg(0), "`complement`");
    if (!s) return poison();
    const ir::Shape &shape = ev.scene.shapes[*s];
    if (shape.kind == ShapeKind::Complement) return shape_value(shape.children[0], shape.dims);
    ir::Shape out;
    out.kind = ShapeKind::Complement;
    out.children = {*s};
    return added(ev, std::move(out), site, args[0].size);
}

static Value xor_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    int dims = 0;
    auto shapes = shapes_argument(ev, site, args[0], 0, dims);
    if (!shapes) return poison();
    std::erase_if(*shapes, [&](ir::ShapeId s) { return is_empty(ev, s); });
    return n_ary(ev, site, ShapeKind::Xor, std::move(*shapes), dims);
}

// _blend(profile, r, n, shapes)
static Value blend_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto profile = want_string(ev, args[0], site.arg(0), "the profile");
    auto r = want_scalar_node(ev, args[1], site.arg(1), "the blend's size"),
         n = want_scalar_node(ev, args[2], site.arg(2), "the blend's count");
    int dims = 0;
    auto shapes = shapes_argument(ev, site, args[3], 3, dims);
    if (!profile || !r || !n || !shapes) return poison();
    std::erase_if(*shapes, [&](ir::ShapeId s) { return is_empty(ev, s); });
    if (dims == 0) dims = 3;
    ir::Profile p = *profile == "smooth"    ? ir::Profile::Smooth
                    : *profile == "round"   ? ir::Profile::Round
                    : *profile == "chamfer" ? ir::Profile::Chamfer
                    : *profile == "stairs"  ? ir::Profile::Stairs
                                            : ir::Profile::Columns;
    if (shapes->size() < 2) return n_ary(ev, site, ShapeKind::Union, std::move(*shapes), dims);
    if (p == ir::Profile::Smooth)
        if (auto instance_table = smooth_instances(ev, *shapes, *r, dims))
            return shape_value(*instance_table, dims);
    ir::Shape s;
    s.kind = ShapeKind::Blend;
    s.payload = static_cast<std::uint32_t>(p);
    s.args = {*r, *n};
    s.children = std::move(*shapes);
    return added(ev, std::move(s), site, dims);
}

static Value mixed_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = want_shape(ev, args[0], site.arg(0), "`mix`");
    if (!s) return poison();
    if (ev.scene.shapes[*s].kind != ShapeKind::Blend) return args[0];
    ir::Shape out;
    out.kind = ShapeKind::Mixed;
    out.children = {*s};
    return added(ev, std::move(out), site, args[0].size);
}

struct Pair {
    ir::ShapeId a, b;
    int dims;
};
static std::optional<Pair> pair_argument(Interpreter &ev, const CallSite &site,
                                         const std::vector<Value> &args, std::size_t at) {
    auto a = want_shape(ev, args[at], site.arg(at), quoted(site.name));
    auto b = want_shape(ev, args[at + 1], site.arg(at + 1), quoted(site.name));
    if (!a || !b) return std::nullopt;
    if (args[at].size != args[at + 1].size) {
        report(ev, Code::FlatShape, site.call, "a solid and a flat shape cannot be combined");
        return std::nullopt;
    }
    return Pair{*a, *b, args[at].size};
}

static Value seam_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto kind = want_string(ev, args[0], site.arg(0), "the seam");
    auto pair = pair_argument(ev, site, args, 1);
    auto r = want_scalar_node(ev, args[3], site.arg(3), "the seam's size");
    auto depth = given(args[4]) ? want_scalar_node(ev, args[4], site.arg(4), "`depth`")
                                : std::optional(ev.scene.graph.number(0));
    if (!kind || !pair || !r || !depth) return poison();
    ir::Shape s;
    s.kind = ShapeKind::Seam;
    s.payload = static_cast<std::uint32_t>(*kind == "pipe"      ? ir::SeamKind::Pipe
                                           : *kind == "engrave" ? ir::SeamKind::Engrave
                                           : *kind == "groove"  ? ir::SeamKind::Groove
                                                                : ir::SeamKind::Tongue);
    s.args = {*r, *depth};
    s.children = {pair->a, pair->b};
    return added(ev, std::move(s), site, pair->dims);
}

static Value lerp_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto pair = pair_argument(ev, site, args, 0);
    if (!pair) return poison();
    auto t = apply_field(ev, args[2], {ev.scene.graph.point(ir::vector_type(pair->dims))},
                         Type::Float, site.arg(2), "`t`");
    if (!t) return poison();
    ir::Shape s;
    s.kind = ShapeKind::Lerp;
    s.args = {*t};
    s.children = {pair->a, pair->b};
    return added(ev, std::move(s), site, pair->dims);
}

static Value pseudonorm_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto pair = pair_argument(ev, site, args, 0);
    auto e = want_scalar_node(ev, args[2], site.arg(2), "`exponent`", Limit::None);
    if (!pair || !e) return poison();
    ir::Shape s;
    s.kind = ShapeKind::PseudoNorm;
    s.args = {*e};
    s.children = {pair->a, pair->b};
    return added(ev, std::move(s), site, pair->dims);
}

// -- looks and looking into ----------------------------------------------------------------------

template <ShapeKind kind>
static Value paint_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    auto m = want_material(ev, args[1], site.arg(1), "`paint`");
    if (!s || !m) return poison();
    if (is_empty(ev, *s)) return args[0];
    if (m->texture.image >= 0) {
        auto painted = painted_by_base(ev, *s, *m, kind == ShapeKind::Repaint, site.arg(1));
        return painted ? shape_value(*painted, args[0].size) : poison();
    }
    ir::Shape out;
    out.kind = kind;
    out.payload = intern_material(ev, *m);
    out.children = {*s};
    return added(ev, std::move(out), site, args[0].size);
}

static Value hide_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    return added(ev, ir::Shape{}, site, args[0].size);
}

static Value only_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args, 3);
    if (!s) return poison();
    ev.only_shapes[s->index] = true;
    return args[0];
}

static Value lipschitz_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    auto l = ev.options.lipschitz ? ev.options.lipschitz(ev.scene, *s) : std::nullopt;
    if (!l || !std::isfinite(*l)) {
        report(ev, Code::LipschitzUnbounded, site.call,
               "no bound can be proved for this shape, so `lipschitz` has no value");
        return poison();
    }
    return number(*l);
}

// _extent(s, axis): where the shape begins and ends along an axis, as a vec2; none where it has no
// ends
static Value extent_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args, 3);
    auto axis = axis_argument(ev, site, args[1], 1);
    if (!s || !axis) return poison();
    auto extent = ev.options.extent ? ev.options.extent(ev.scene, *s, *axis) : std::nullopt;
    if (!extent || !std::isfinite(extent->first) || !std::isfinite(extent->second)) return none();
    return vec(2, {extent->first, extent->second, 0, 0});
}

// _known(x): whether a value, or all of a list, is known at scene time
static bool is_known(Interpreter &ev, const Value &v) {
    if (v.kind != ValueKind::List) return v.kind != ValueKind::Field;
    for (const Value &item : ev.lists[v.id])
        if (!spend(ev, {}) || !is_known(ev, item)) return false;
    return true;
}
static Value known_call(Interpreter &ev, const CallSite &, std::vector<Value> &args) {
    return boolean(is_known(ev, args[0]));
}

static Value is_flat_call(Interpreter &, const CallSite &, std::vector<Value> &args) {
    return boolean(args[0].kind == ValueKind::Shape && args[0].size == 2);
}

void add_shape_builtins(std::vector<Builtin> &table) {
    auto add = [&](const char *name, std::vector<BuiltinParameter> parameters, auto call,
                   const char *doc = "") {
        table.push_back({name, std::move(parameters), false, name[0] == '_', call, "", doc});
    };
    std::vector<BuiltinParameter> claims{
        {"f"},        {"exact", true},     {"lipschitz", true},  {"lo", true},
        {"hi", true}, {"symmetric", true}, {"moment_arm", true}, {"growth_rate", true}};
    add("_solid", claims, leaf_call<3>);
    claims.push_back({"corners", true});
    add("_flat", claims, leaf_call<2>);
    add("implicit", {{"f"}, {"within", true}, {"lipschitz", true}, {"estimate", true}},
        implicit_call<3>,
        "the solid where a function of the point is below 0, inside the region `within`");
    add("implicit2", {{"f"}, {"within", true}, {"lipschitz", true}, {"estimate", true}},
        implicit_call<2>,
        "the flat shape where a function of the point, a vec2, is below 0, inside `within`");
    add("cached", {{"f"}, {"cell"}}, cached_call,
        "the same field; its values may come from the noise cache with cells of that size");
    add("_union", {{"shapes"}}, union_call);
    add("_intersection", {{"shapes"}}, intersection_call);
    add("_complement", {{"s"}}, complement_call);
    add("_xor", {{"shapes"}}, xor_call);
    add("_blend", {{"profile"}, {"r"}, {"n"}, {"shapes"}}, blend_call);
    add("_mixed", {{"s"}}, mixed_call);
    add("_seam", {{"kind"}, {"a"}, {"b"}, {"r"}, {"depth", true}}, seam_call);
    add("_lerp", {{"a"}, {"b"}, {"t"}}, lerp_call);
    add("_pseudonorm", {{"a"}, {"b"}, {"exponent"}}, pseudonorm_call);
    add("_paint", {{"s"}, {"m"}}, paint_call<ShapeKind::Paint>);
    add("_repaint", {{"s"}, {"m"}}, paint_call<ShapeKind::Repaint>);
    add("_is_flat", {{"s"}}, is_flat_call);
    add("_extent", {{"s"}, {"axis"}}, extent_call);
    add("_known", {{"x"}}, known_call);
    add("hide", {{"s"}}, hide_call, "the scene without this shape");
    add("only", {{"s"}}, only_call,
        "the scene with nothing but this shape; at the top of the file");
    add("lipschitz", {{"s"}}, lipschitz_call, "the proved bound of a shape's field, as a number");
}

} // namespace fathom::typecheck
