// Transforms, repetition and the regions of `within:`: the intrinsics from which
// stdlib/transforms.sdf is written.
#include "typecheck/builtins/builtins.h"
#include "typecheck/conditions.h"
#include "typecheck/rewrite_leaves.h"

#include "ir/maps.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

using ir::Op;
using ir::ShapeKind;
using ir::Type;

// -- transforms ----------------------------------------------------------------------------------

static Value translate_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    auto by = want_vec_node(ev, args[1], args[0].size, site.arg(1), "`by`");
    if (!by || is_empty(ev, *s)) return by ? args[0] : poison();
    return added(ev, ir::translated(ev.scene.graph, *s, *by), site, args[0].size);
}

static Value rotate_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    if (!is_numeric(args[1]) || numeric_type(ev, args[1]) != ir::matrix_type(args[0].size)) {
        report(ev, Code::TypeMismatch, site.arg(1),
               fmt::format("a rotation is a mat{}", int{args[0].size}));
        return poison();
    }
    if (is_empty(ev, *s)) return args[0];
    return added(ev, ir::rotated(ev.scene.graph, *s, to_node(ev, args[1])), site, args[0].size);
}

static Value scale_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    auto by = want_vec_node(ev, args[1], args[0].size, site.arg(1), "`by`");
    if (!by || is_empty(ev, *s)) return by ? args[0] : poison();
    if (ev.scene.graph.is_constant(*by))
        for (int i = 0; i < args[0].size; ++i)
            if (ev.scene.graph.constant_of(*by).value[std::size_t(i)] == 0) {
                report(ev, Code::BadArgument, site.arg(1),
                       "a scale of 0 flattens the shape to nothing");
                return poison();
            }
    return added(ev, ir::scaled(ev.scene.graph, *s, *by), site, args[0].size);
}

static Value fold_shape_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    Type type = ir::vector_type(args[0].size);
    auto q = apply_field(ev, args[1], {ev.scene.graph.point(type)}, type, site.arg(1), "a fold");
    if (!q) return poison();
    return added(ev, ir::folded(ev.scene.graph, *s, *q), site, args[0].size);
}

// The profile with the edges that lie on the line left out of the surfaces of polygons that lie on
// the side of it that is asked: `open(corners, kept)` makes such a polygon, kept[i] whether the edge
// to corner i counts.
static ir::ShapeId opened(Interpreter &ev, ir::ShapeId profile, Line axis, const Value &open,
                          Span place_of_call) {
    return rewrite_leaves(
        ev, profile, Paints::Keep,
        [&](ir::ShapeId base, const Below &below) {
            const auto found = ev.corners.find(
                ev.scene.shapes[base].children.empty() ? base : ev.scene.shapes[base].children[0]);
            if (found == ev.corners.end() || !below.axis.known()) return base;
            // Turned and moved so that the line is the y axis and the side that is asked lies to
            // its right.
            const std::array<double, 2> at = below.axis.at, along = below.axis.along;
            const double length = std::hypot(along[0], along[1]) * (below.axis.left ? -1 : 1);
            const std::array<double, 2> up{along[0] / length, along[1] / length};
            double size = 0;
            for (const auto &c : found->second)
                size = std::max({size, std::fabs(c[0] - at[0]), std::fabs(c[1] - at[1])});
            std::vector<Value> corners, kept;
            bool all = true, before = false;
            const auto place = [&](const std::array<double, 2> &c) {
                std::array<double, 2> q{(c[0] - at[0]) * up[1] - (c[1] - at[1]) * up[0],
                                        (c[0] - at[0]) * up[0] + (c[1] - at[1]) * up[1]};
                if (std::fabs(q[0]) <= 1e-7 * size) q[0] = 0;
                return q;
            };
            before = place(found->second.back())[0] == 0;
            for (const auto &corner : found->second) {
                const auto [x, y] = place(corner);
                const bool counts = x != 0 || !before;
                before = x == 0;
                all = all && counts;
                if (x < 0) return base; // beyond an opened edge the solid would go on
                corners.push_back(vec(2, {x, y, 0, 0}));
                kept.push_back(boolean(counts));
            }
            if (all) return base;
            const Value made = call_with(
                ev, open, {list_value(ev, std::move(corners)), list_value(ev, std::move(kept))},
                place_of_call);
            if (made.kind != ValueKind::Shape) return base;
            ir::Graph &g = ev.scene.graph;
            const ir::Constant turn{Type::Mat2, {up[1], -up[0], up[0], up[1]}};
            ir::ShapeId result = shape_of(made);
            if (up != std::array{0.0, 1.0})
                result = ev.scene.shapes.add(ir::rotated(g, result, g.constant(turn)));
            if (at != std::array{0.0, 0.0})
                result = ev.scene.shapes.add(ir::translated(g, result, g.vec(at)));
            ev.scene.shapes.listed[result] = {base}; // as the scene says it
            return result;
        },
        axis);
}

// _revolve(s, offset, open)
static Value revolve_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args, 2);
    auto offset = want_scalar_node(ev, args[1], site.arg(1), "`offset`");
    if (!s || !offset) return poison();
    if (auto out = ev.scene.graph.as_number(*offset))
        s = opened(ev, *s, {{-*out, 0}, {0, 1}}, args[2], site.call);
    return added(ev, ir::revolved(ev.scene.graph, *s, *offset), site, 3);
}

static Value extrude_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args, 2);
    auto height = want_scalar_node(ev, args[1], site.arg(1), "`height`");
    if (!s || !height) return poison();
    ir::Shape out;
    out.kind = ShapeKind::Extrude;
    out.children = {*s};
    out.args = {*height};
    return added(ev, std::move(out), site, 3);
}

std::optional<int> axis_argument(Interpreter &ev, const CallSite &site, const Value &v,
                                 std::size_t i) {
    auto axis = want_known_int(ev, v, site.arg(i), "an axis");
    if (axis && (*axis < 0 || *axis > 2)) {
        report(ev, Code::BadArgument, site.arg(i), "an axis is X, Y or Z here");
        return std::nullopt;
    }
    return axis;
}

static Value twist_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args, 3);
    auto rate = want_scalar_node(ev, args[1], site.arg(1), "`rate`");
    auto axis = axis_argument(ev, site, args[2], 2);
    if (!s || !rate || !axis) return poison();
    return added(ev, ir::twisted(ev.scene.graph, *s, *rate, *axis), site, 3);
}

static Value bend_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args, 3);
    auto rate = want_scalar_node(ev, args[1], site.arg(1), "`rate`");
    auto axis = axis_argument(ev, site, args[2], 2), towards = axis_argument(ev, site, args[3], 3);
    if (!s || !rate || !axis || !towards) return poison();
    if (*axis == *towards) {
        report(ev, Code::BadArgument, site.call, "`axis` and `towards` have to be different axes");
        return poison();
    }
    return added(ev, ir::bent(ev.scene.graph, *s, *rate, *axis, *towards), site, 3);
}

static Value taper_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args, 3);
    auto ratio = want_scalar_node(ev, args[1], site.arg(1), "`ratio`");
    auto axis = axis_argument(ev, site, args[2], 2);
    if (!s || !ratio || !axis) return poison();
    std::optional<ir::NodeId> ends[2];
    for (std::size_t i = 0; i < 2; ++i) {
        if (!given(args[3 + i])) continue;
        ends[i] = want_scalar_node(ev, args[3 + i], site.arg(3 + i), i == 0 ? "`from`" : "`to`");
        if (!ends[i]) return poison();
    }
    if (!ends[0] || !ends[1]) {
        auto extent = ev.options.extent ? ev.options.extent(ev.scene, *s, *axis) : std::nullopt;
        if (!extent) {
            report(ev, Code::NeedsRegion, site.call,
                   "this shape has no ends along the axis, so its taper needs them")
                .help("say where it begins and ends: `from: -1, to: 1`");
            return poison();
        }
        if (!ends[0]) ends[0] = ev.scene.graph.number(extent->first);
        if (!ends[1]) ends[1] = ev.scene.graph.number(extent->second);
    }
    if (!node_in_range(ev, ev.scene.graph.sub(*ends[1], *ends[0]), site.call)) return poison();
    return added(ev, ir::tapered(ev.scene.graph, *s, *ratio, *ends[0], *ends[1], *axis), site, 3);
}

Value within_shape(Interpreter &ev, const CallSite &site, const Value &shape,
                   const ir::Region &region) {
    if (region.kind == ir::RegionKind::Everywhere && region.less.empty()) return shape;
    ir::Shape within;
    within.kind = ShapeKind::Within;
    within.payload = intern_region(ev, region);
    within.children = {shape_of(shape)};
    return added(ev, std::move(within), site, shape.size);
}

static Value distort_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    Type type = ir::vector_type(args[0].size);
    auto q = apply_field(ev, args[1], {ev.scene.graph.point(type)}, type, site.arg(1), "`distort`");
    if (!q) return poison();
    Value out = added(ev, ir::distorted(ev.scene.graph, *s, *q), site, args[0].size);
    if (!given(args[2])) return out;
    auto region = want_region(ev, args[2], site.arg(2), "`within`", args[0].size);
    return region ? within_shape(ev, site, out, *region) : poison();
}

static Value within_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    auto region = want_region(ev, args[1], site.arg(1), "`within`", args[0].size);
    return region ? within_shape(ev, site, args[0], *region) : poison();
}

template <ShapeKind kind>
static Value offset_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    auto r = want_scalar_node(ev, args[1], site.arg(1),
                              kind == ShapeKind::Offset ? "`r`" : "`thickness`");
    if (!s || !r) return poison();
    if (is_empty(ev, *s)) return args[0];
    ir::Shape out;
    out.kind = kind;
    out.children = {*s};
    out.args = {*r};
    return added(ev, std::move(out), site, args[0].size);
}

static Value displace_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    auto f = apply_field(ev, args[1], {ev.scene.graph.point(ir::vector_type(args[0].size))},
                         Type::Float, site.arg(1), "`displace`");
    if (!f) return poison();
    ir::Shape out;
    out.kind = ShapeKind::Displace;
    out.children = {*s};
    out.args = {*f};
    return added(ev, std::move(out), site, args[0].size);
}

// -- repetition ----------------------------------------------------------------------------------

// The copies may differ: `copies(s, id)` is called once, with a variable for the cell's id.
static std::optional<ir::ShapeId> one_copy(Interpreter &ev, const CallSite &site,
                                           const std::vector<Value> &args, std::size_t at,
                                           ir::NodeId &id) {
    ir::ShapeId child = shape_of(args[0]);
    if (!given(args[at])) return child;
    if (!is_function(args[at])) {
        report(ev, Code::TypeMismatch, site.arg(at),
               fmt::format("the copies are made by a function `(s, id) => …`, this is {}",
                           describe(ev, args[at])));
        return std::nullopt;
    }
    id = ev.scene.graph.fresh_var(Type::Vec3);
    Value v = call_with(ev, args[at], {args[0], from_node(ev, id)}, site.arg(at));
    if (is_poison(v)) return std::nullopt;
    return want_shape(ev, v, site.arg(at), "a copy", args[0].size);
}

static Value repeated(Interpreter &ev, const CallSite &site, ir::Repetition r, ir::ShapeId child,
                      std::vector<ir::NodeId> numbers, int dims) {
    std::string key = fmt::format("repeat:{}{}{}{}{}{}:{}", r.polar, r.axis, r.along[0], r.along[1],
                                  r.along[2], r.mirrored, r.id.index);
    auto [it, fresh] = ev.interned_records.try_emplace(
        key, static_cast<std::uint32_t>(ev.scene.shapes.repetitions.size()));
    if (fresh) ev.scene.shapes.repetitions.push_back(r);
    ir::Shape s;
    s.kind = ShapeKind::Repeat;
    s.payload = it->second;
    s.children = {child};
    s.args = std::move(numbers);
    return added(ev, std::move(s), site, dims);
}

static Value lattice(Interpreter &ev, const CallSite &site, std::vector<Value> &args,
                     bool mirrored) {
    auto s = first_shape(ev, site, args);
    if (!s) return poison();
    int dims = args[0].size;
    ir::Graph &g = ev.scene.graph;
    // a flat shape's cell may be a vec2; the third axis does not repeat
    auto as_cell = [&](const Value &v, std::size_t i, const char *what, double third,
                       Limit limit) -> std::optional<ir::NodeId> {
        if (dims == 3) return want_vec_node(ev, v, 3, site.arg(i), what, limit);
        auto two = want_vec_node(ev, v, 2, site.arg(i), what, limit);
        if (!two) return std::nullopt;
        return g.make(Op::Make, Type::Vec3,
                      {g.component(*two, 0), g.component(*two, 1), g.number(third)});
    };
    auto cell = as_cell(args[1], 1, "`cell`", 0, Limit::Size);
    if (!cell) return poison();
    ir::Repetition r;
    r.mirrored = mirrored;
    ir::Constant count;
    count.type = Type::Vec3;
    count.value = {1e9, 1e9, 1e9};
    if (!mirrored && given(args[2])) {
        auto c = as_cell(args[2], 2, "`count`", 1, Limit::None);
        if (!c) return poison();
        Value known = from_node(ev, *c);
        auto k = element_as_known(ev, known, site.arg(2), "`count`");
        if (!k) return poison();
        for (std::size_t i = 0; i < 3; ++i)
            count.value[i] = std::isfinite(k->num[i]) ? k->num[i] : 1e9;
    }
    // which axes repeat is structure: a param that can reach 0 decides it at its present value
    std::array<double, 3> size{};
    for (std::size_t i = 0; i < 3; ++i) {
        const ir::NodeId part = g.component(*cell, static_cast<int>(i));
        const ir::Param *param =
            g[part].op == ir::Op::Param ? &ev.scene.params[g[part].payload] : nullptr;
        if (param && param->has_range && param->lo[0] > 0) {
            size[i] = param->lo[0];
            continue;
        }
        auto present = element_as_known(ev, from_node(ev, part), site.arg(1), "`cell`");
        if (!present) return poison();
        size[i] = present->num[0];
    }
    for (std::size_t i = 0; i < 3; ++i) {
        r.along[i] = size[i] != 0 && !(dims == 2 && i == 2);
        if (size[i] < 0) {
            report(ev, Code::BadArgument, site.arg(1), "a cell's size cannot be negative");
            return poison();
        }
        if (r.along[i] && (count.value[i] < 1 || (count.value[i] < 1e9 &&
                                                  count.value[i] != std::floor(count.value[i])))) {
            report(
                ev, Code::BadArgument, site.arg(2),
                fmt::format("`count` wants whole numbers from 1 on, this has {}", count.value[i]));
            return poison();
        }
    }
    std::optional<ir::ShapeId> child = *s;
    if (!mirrored) child = one_copy(ev, site, args, 3, r.id);
    if (!child) return poison();
    if (!r.along[0] && !r.along[1] && !r.along[2]) return shape_value(*child, dims);
    return repeated(ev, site, r, *child, {*cell, g.constant(count)}, dims);
}

static Value repeat_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    // `repeat(cell, (s, id) => …)`: the copies may stand where the count would
    if (is_function(args[2]) && args[2].kind != ValueKind::ConstField && !given(args[3]))
        args[3] = args[2], args[2] = none();
    return lattice(ev, site, args, false);
}
static Value repeat_mirror_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    return lattice(ev, site, args, true);
}

static Value repeat_polar_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    auto n = want_known_int(ev, args[1], site.arg(1), "`n`");
    auto axis = axis_argument(ev, site, args[2], 2);
    if (!s || !n || !axis) return poison();
    if (*n < 1) {
        report(ev, Code::BadArgument, site.arg(1),
               fmt::format("`n` wants a whole number from 1 on, this is {}", *n));
        return poison();
    }
    ir::Repetition r;
    r.polar = true;
    r.axis = *axis;
    auto child = one_copy(ev, site, args, 3, r.id);
    if (!child) return poison();
    if (*n == 1 && !r.id) return shape_value(*child, args[0].size);
    return repeated(ev, site, r, *child, {ev.scene.graph.integer(*n)}, args[0].size);
}

void add_transform_builtins(std::vector<Builtin> &table) {
    auto add = [&](const char *name, std::vector<BuiltinParameter> parameters, auto call,
                   const char *doc = "") {
        table.push_back({name, std::move(parameters), false, name[0] == '_', call, "", doc});
    };
    add("_translate", {{"s"}, {"by"}}, translate_call);
    add("_rotate", {{"s"}, {"m"}}, rotate_call);
    add("_scale", {{"s"}, {"by"}}, scale_call);
    add("_fold", {{"s"}, {"q"}}, fold_shape_call);
    add("_revolve", {{"s"}, {"offset"}, {"open"}}, revolve_call);
    add("_extrude", {{"s"}, {"height"}}, extrude_call);
    add("_twist", {{"s"}, {"rate"}, {"axis"}}, twist_call);
    add("_bend", {{"s"}, {"rate"}, {"axis"}, {"towards"}}, bend_call);
    add("_taper", {{"s"}, {"ratio"}, {"axis"}, {"from", true}, {"to", true}}, taper_call);
    add("_distort", {{"s"}, {"m"}, {"within", true}}, distort_call);
    add("_within", {{"s"}, {"region"}}, within_call);
    add("_offset", {{"s"}, {"r"}}, offset_call<ShapeKind::Offset>);
    add("_shell", {{"s"}, {"thickness"}}, offset_call<ShapeKind::Shell>);
    add("_displace", {{"s"}, {"f"}}, displace_call);
    add("_repeat", {{"s"}, {"cell"}, {"count", true}, {"copies", true}}, repeat_call);
    add("_repeat_polar", {{"s"}, {"n"}, {"axis"}, {"copies", true}}, repeat_polar_call);
    add("_repeat_mirror", {{"s"}, {"cell"}}, repeat_mirror_call);
}

} // namespace fathom::typecheck
