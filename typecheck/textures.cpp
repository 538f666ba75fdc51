// Images and grids of a scene: loading them, images as fields, textures and displacement maps by
// the natural parametrisation of each base shape (thesis, 4.6), and grids of distances. Files are
// read by the loader alone.
#include "typecheck/textures.h"
#include "base/srgb.h"
#include "base/text.h"
#include "typecheck/builtins/builtins.h"
#include "typecheck/rewrite_leaves.h"

#include "ir/semantics.h"
#include "ir/uv_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::typecheck {

using ir::NodeId;
using ir::Op;
using ir::ShapeId;
using ir::ShapeKind;
using ir::Type;

constexpr std::size_t pixels_a_step = 16, values_a_step = 64; // that are looked at

// -- files ---------------------------------------------------------------------------------------

static void refuse(Interpreter &ev, Span place, const char *what, const std::string &path,
                   const LoadError &error) {
    using Reason = LoadError::Reason;
    const Limits &limits = ev.options.limits;
    const Code code = error.reason == Reason::Outside    ? Code::ImportOutside
                      : error.reason == Reason::TooLarge ? Code::MemoryLimit
                      : error.reason == Reason::TooMuchWork || error.reason == Reason::TooManyPixels
                          ? Code::LoopLimit
                          : Code::FileNotFound;
    Diagnostic &d =
        report(ev, code, place, fmt::format("the {} `{}`: {}", what, short_name(path), error.why));
    if (code == Code::ImportOutside) d.help(way_inside(path));
    for (const auto &[of, limit] : {std::pair(Reason::TooLarge, &Limits::memory),
                                    std::pair(Reason::TooMuchWork, &Limits::work),
                                    std::pair(Reason::TooManyPixels, &Limits::pixels)})
        if (error.reason == of) d.note(limit_note(limits, limit)).help(limit_help(limits, limit));
}

// The file whose text names it: a path is looked up beside it, also where the library's own text
// hands the path on.
static const std::string &naming_file(const Interpreter &ev) {
    std::size_t i = ev.calls.size();
    while (i > 0 && ev.calls[i - 1].library) --i;
    if (i < ev.calls.size())
        for (const Module &module : ev.modules)
            if (module.source == ev.calls[i].call.source) return module.identity;
    return ev.modules[ev.current_module].identity;
}

// A file that is named twice is read once, however its name is spelled; of one with several grids,
// each. `more` is what the loader is told beside the path: the grid's name.
template <class Data, class Load, class... More> static std::optional<std::uint32_t>
loaded(Interpreter &ev, const Load &load, std::vector<Data> &all, const char *what,
       const std::string &path, Span place, const More &...more) {
    for (const std::string_view name : {std::string_view(path), std::string_view(more)...})
        if (const auto error = too_long(name)) {
            refuse(ev, place, what, path, *error);
            return std::nullopt;
        }
    const std::string from = naming_file(ev);
    const std::string kind = (std::string(what) + ... + fmt::format("\n{}:{}", more.size(), more));
    const std::string key = fmt::format("{}\n{}\n{}", kind, from, path);
    if (const auto known = ev.assets.absent.find(key); known != ev.assets.absent.end()) {
        refuse(ev, place, what, path, known->second);
        return std::nullopt;
    }
    const auto named = ev.assets.numbers.try_emplace(key, 0);
    std::uint32_t &index = named.first->second;
    if (!named.second) return index;
    ev.made += 2 * key.size(); // where it is remembered, here and by who looks for it
    const auto fail = [&](const LoadError &error) {
        refuse(ev, place, what, path, error);
        ev.assets.numbers.erase(named.first);
        ev.assets.absent.emplace(key, error);
        return std::nullopt;
    };
    if (!spend_on_lookup(ev, place, path)) {
        ev.assets.numbers.erase(named.first);
        return std::nullopt;
    }
    const auto identity = ev.loader.identity(path, from);
    if (auto *error = std::get_if<LoadError>(&identity)) return fail(*error);
    const auto same = ev.assets.numbers.try_emplace(
        fmt::format("{}\n{}", kind, std::get<std::string>(identity)), 0);
    if (!same.second) return index = same.first->second;
    const Room before = room_left(ev);
    Room room = before;
    auto data = load(path, from, room, more...);
    if (auto *error = std::get_if<LoadError>(&data)) {
        ev.assets.numbers.erase(same.first);
        return fail(*error);
    }
    ev.made += before.bytes - room.bytes;
    (void)spend(ev, place, before.steps - room.steps);
    index = same.first->second = static_cast<std::uint32_t>(all.size());
    all.push_back(std::move(std::get<Data>(data)));
    return index;
}

static Value image_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto path = want_string(ev, args[0], site.arg(0), "`image`");
    auto scale = given(args[1]) ? want_known_number(ev, args[1], site.arg(1), "`scale`")
                                : std::optional(1.0);
    if (!path || !scale) return poison();
    if (*scale == 0) {
        report(ev, Code::BadArgument, site.arg(1), "an image's scale cannot be 0");
        return poison();
    }
    auto index =
        loaded<ir::ImageData>(ev, ev.loader.image, ev.scene.images, "image", *path, site.arg(0));
    if (!index) return poison();
    Value v = make_value(ValueKind::ImageField, *index);
    v.num[0] = *scale;
    return v;
}

// -- textures ------------------------------------------------------------------------------------

// A number, or two, other than 0.
static std::optional<std::array<double, 2>> want_scale(Interpreter &ev, const Value &v, Span place,
                                                       const char *what) {
    if (!given(v)) return std::array{1.0, 1.0};
    auto node = want_vec_node(ev, v, 2, place, what);
    if (!node) return std::nullopt;
    if (!ev.scene.graph.is_constant(*node)) {
        report(ev, Code::StageMismatch, place,
               fmt::format("{} has to be known at scene time", what));
        return std::nullopt;
    }
    const ir::Constant &c = ev.scene.graph.constant_of(*node);
    if (c.value[0] == 0 || c.value[1] == 0) {
        report(ev, Code::BadArgument, place, fmt::format("{} cannot be 0", what));
        return std::nullopt;
    }
    return std::array{c.value[0], c.value[1]};
}

std::optional<ir::Texture> want_texture(Interpreter &ev, const Value &image, Span image_place,
                                        const Value &scale, Span scale_place, const char *what,
                                        const char *scale_what) {
    if (is_poison(image)) return std::nullopt;
    auto times = want_scale(ev, scale, scale_place, scale_what);
    if (image.kind != ValueKind::ImageField) {
        report(ev, Code::TypeMismatch, image_place,
               fmt::format("{} wants an image, this is {}", what, describe(ev, image)))
            .help("write `image(\"file.png\")`");
        return std::nullopt;
    }
    if (!times) return std::nullopt;
    const Value sizes = in_range(
        ev, vec(2, {(*times)[0] * image.num[0], (*times)[1] * image.num[0]}), {}, scale_place);
    if (is_poison(sizes)) return std::nullopt;
    if (sizes.num[0] == 0 || sizes.num[1] == 0) {
        report(ev, Code::NumberRange, scale_place, "the image's size is too small, it becomes 0");
        return std::nullopt;
    }
    return ir::Texture{static_cast<std::int32_t>(image.id), {sizes.num[0], sizes.num[1]}};
}

// How many images lie along a coordinate of 0..1; round what closes upon itself a whole number.
static double images_along(double scale, bool around) {
    const double count = 1 / scale;
    if (!around) return count;
    return std::copysign(std::max(1.0, std::round(std::fabs(count))), count);
}

static NodeId sampled(ir::Graph &g, const ir::UvMap &uv_map, const ir::Texture &texture,
                      std::int32_t image) {
    const NodeId counts = g.vec(std::array{images_along(texture.scale[0], uv_map.around_u),
                                           images_along(texture.scale[1], uv_map.around_v)});
    return g.make(Op::Image, Type::Vec4, {g.mul(uv_map.uv, counts)},
                  static_cast<std::uint32_t>(image));
}

// The parametrisation that is natural to a base shape, by what the library calls it.
static std::optional<ir::UvMap> uv_map_of(Interpreter &ev, ShapeId id) {
    ir::Graph &g = ev.scene.graph;
    const ir::Shape shape = ev.scene.shapes[id];
    if (shape.dims == 2) return ir::flat_uv_map(g, Type::Vec2);
    if (shape.kind == ShapeKind::Extrude) return ir::flat_uv_map(g, Type::Vec3);
    if (shape.kind == ShapeKind::Map) { // revolved
        auto extent = ev.options.extent ? ev.options.extent(ev.scene, id, 0) : std::nullopt;
        const double reach =
            extent ? std::max(std::fabs(extent->first), std::fabs(extent->second)) : 1;
        return ir::rotated_uv_map(g, g.number(std::isfinite(reach) && reach > 0 ? reach : 1));
    }
    if (shape.kind != ShapeKind::Library) return std::nullopt;
    const ir::Library library = ev.scene.shapes.libraries[shape.payload];
    const auto called = [&](std::initializer_list<std::string_view> names) {
        return std::find(names.begin(), names.end(), library.name) != names.end();
    };
    const auto argument = [&](std::string_view name) {
        for (const auto &[known, node] : library.arguments)
            if (known == name) return node;
        return g.vec3(0, 1, 0);
    };
    if (called({"heightfield"})) return ir::plane_uv_map(g, g.vec3(0, 1, 0));
    if (called({"plane"})) return ir::plane_uv_map(g, argument("normal"));
    if (called({"slab"})) return ir::plane_uv_map(g, argument("axis"));
    const NodeId lo = library.claims.lo, hi = library.claims.hi;
    if (!lo || !hi) return std::nullopt;
    const auto part = [&](int i) { return g.component(hi, i); };
    if (called({"box", "rounded_box", "box_frame", "menger", "menger_sponge", "gdf_cube"}))
        return ir::box_uv_map(g, hi);
    if (called({"cylinder", "rounded_cylinder", "prism"}))
        return ir::has_uv_map(g, part(0), g.mul({part(1), g.number(2)}));
    if (called({"torus"})) return ir::ring_uv_map(g, g.sub({part(0), part(1)}), part(1));
    if (g.is_constant(lo) && g.is_constant(hi))
        for (std::size_t i = 0; i < 3; ++i)
            if (!std::isfinite(g.constant_of(hi).value[i] - g.constant_of(lo).value[i]))
                return std::nullopt;
    return ir::ball_uv_map(g, lo, hi);
}

static void report_no_uv_map(Interpreter &ev, ShapeId id, Span place, const char *what) {
    const ir::Shape &shape = ev.scene.shapes[id];
    const std::string name =
        shape.kind == ShapeKind::Library
            ? fmt::format("`{}`", ev.scene.shapes.libraries[shape.payload].name)
            : "a user-defined field";
    Diagnostic &d =
        report(ev, Code::BadArgument, place,
               fmt::format("{} lies on a shape by its natural parametrisation, and {} has none",
                           what, name));
    if (shape.origin.source && shape.origin != place) d.label(shape.origin, "this shape");
    d.help(
        "project the image yourself: `triplanar(image(…))` is a field of the point and the normal");
}

std::optional<ShapeId> painted_by_base(Interpreter &ev, ShapeId shape, const ir::Material &material,
                                       bool over, Span place) {
    ir::Graph &g = ev.scene.graph;
    bool ok = true;
    const ShapeId result = rewrite_leaves(
        ev, shape, over ? Paints::Strip : Paints::KeepWhole,
        [&](ShapeId base, const Below &) -> ShapeId {
            auto uv_map = uv_map_of(ev, base);
            if (!uv_map) {
                if (ok) report_no_uv_map(ev, base, place, "a texture");
                ok = false;
                return base;
            }
            // What is transparent shows the diffuse colour.
            ir::Material here = material;
            const NodeId texel = sampled(g, *uv_map, material.texture, material.texture.image);
            here.diffuse = g.make(Op::Mix, {material.diffuse, g.swizzle(texel, std::array{0, 1, 2}),
                                            g.splat(g.component(texel, 3), Type::Vec3)});
            const ir::Shape below = ev.scene.shapes[base];
            ir::Shape paint;
            paint.kind = ShapeKind::Paint;
            paint.dims = below.dims;
            paint.payload = intern_material(ev, here);
            paint.children = {base};
            paint.origin = below.origin;
            return ev.scene.shapes.add(std::move(paint));
        });
    return ok ? std::optional(result) : std::nullopt;
}

// -- displacement --------------------------------------------------------------------------------

// An image's brightness as it is stored (not linear), 0..1: what a height map means.
static std::optional<std::uint32_t> heights_of(Interpreter &ev, std::uint32_t image, Span place) {
    if (const auto known = ev.assets.heights.find(image); known != ev.assets.heights.end())
        return known->second;
    const std::size_t numbers = ev.scene.images[image].rgba.size();
    if (!spend(ev, place, numbers / 4 / pixels_a_step) ||
        !has_room(ev, place, numbers * sizeof(float)))
        return std::nullopt;
    ev.made += numbers * sizeof(float);
    ir::ImageData heights = ev.scene.images[image];
    for (std::size_t i = 0; i + 3 < heights.rgba.size(); i += 4) {
        const double linear = 0.2126 * heights.rgba[i] + 0.7152 * heights.rgba[i + 1] +
                              0.0722 * heights.rgba[i + 2]; // Rec. 709's weights
        std::fill_n(heights.rgba.begin() + static_cast<std::ptrdiff_t>(i), 3,
                    static_cast<float>(srgb_of_linear(linear)));
        heights.rgba[i + 3] = 1;
    }
    const auto made = static_cast<std::uint32_t>(ev.scene.images.size());
    ev.assets.heights.emplace(image, made);
    ev.scene.images.push_back(std::move(heights));
    return made;
}

// _displace_map(s, image, amount, scale): f - amount * h on each base shape, h the map's
// brightness; at seams and poles its mean, where the uv_map says.
static Value displace_map_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto s = first_shape(ev, site, args);
    auto map =
        want_texture(ev, args[1], site.arg(1), args[3], site.arg(3), "`displace_map`", "`scale`");
    auto amount = want_scalar_node(ev, args[2], site.arg(2), "`amount`");
    if (!s || !map || !amount) return poison();
    ir::Graph &g = ev.scene.graph;
    const auto made = heights_of(ev, static_cast<std::uint32_t>(map->image), site.arg(1));
    if (!made) return poison();
    const std::uint32_t image = *made;
    const ImageFacts heights = facts_of_image(ev.assets, image, ev.scene.images[image]);
    const double span = std::max(heights.maximum - heights.mean, heights.mean - heights.minimum);
    ev.scene.shapes.displacement_maps.push_back({*map, *amount, {}});
    const auto record = static_cast<std::uint32_t>(ev.scene.shapes.displacement_maps.size());
    bool ok = true;
    const ShapeId result =
        rewrite_leaves(ev, *s, Paints::Keep, [&](ShapeId base, const Below &below) -> ShapeId {
            auto uv_map = uv_map_of(ev, base);
            if (!uv_map) {
                if (ok) report_no_uv_map(ev, base, site.call, "a displacement map");
                ok = false;
                return base;
            }
            const NodeId here = g.div(below.inverted ? g.neg(*amount) : *amount, below.factor);
            const NodeId mean = g.number(heights.mean);
            const NodeId height =
                g.component(sampled(g, *uv_map, *map, static_cast<std::int32_t>(image)), 0);
            const NodeId seamless = g.add(mean, g.mul(uv_map->weight, g.sub(height, mean)));
            const double along_u =
                heights.slope_u * std::fabs(images_along(map->scale[0], uv_map->around_u));
            const double along_v =
                heights.slope_v * std::fabs(images_along(map->scale[1], uv_map->around_v));
            const NodeId slope = g.add({g.add({g.mul(uv_map->slope_u, g.number(along_u)),
                                               g.mul(uv_map->slope_v, g.number(along_v))}),
                                        g.mul(uv_map->slope_weight, g.number(span))});
            const NodeId a = g.mul(here, g.number(heights.minimum)),
                         b = g.mul(here, g.number(heights.maximum));
            const ir::Shape inner = ev.scene.shapes[base];
            ir::Shape out;
            out.kind = ShapeKind::Displace;
            out.dims = inner.dims;
            out.payload = record;
            out.children = {base};
            out.args = {g.mul(here, seamless), g.mul(g.make(Op::Abs, {here}), slope),
                        g.make(Op::Min, {a, b}), g.make(Op::Max, {a, b})};
            out.origin = inner.origin;
            return ev.scene.shapes.add(std::move(out));
        });
    ev.scene.shapes.displacement_maps[record - 1].whole = result;
    return ok ? shape_value(result, args[0].size) : poison();
}

// -- grids ---------------------------------------------------------------------------------------

// Where the numbers of a grid leave too little room to reckon with them.
constexpr double largest_value = 1e30;

// _grid(file, isovalue, above, name): [its number, the grid's corners lo and hi, the slope of its
// trilinear field or 1 where that is 0, the corners of what is inside]
static Value grid_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto path = want_string(ev, args[0], site.arg(0), "`distance_grid`");
    auto level = want_scalar_node(ev, args[1], site.arg(1), "`isovalue`");
    auto above = want_known_bool(ev, args[2], site.arg(2), "`above`");
    auto name = want_string(ev, args[3], site.arg(3), "`grid`");
    if (!path || !level || !above || !name) return poison();
    auto index =
        loaded<ir::GridData>(ev, ev.loader.grid, ev.scene.grids, "grid", *path, site.arg(0), *name);
    if (!index) return poison();
    ev.scene.grids[*index].part = *name;
    const ir::GridData &grid = ev.scene.grids[*index];
    const GridFacts facts = facts_of_grid(ev.assets, *index, grid);
    if (!(std::max({std::fabs(facts.least), std::fabs(facts.greatest), facts.steepest}) <
          largest_value)) {
        report(ev, Code::NumberRange, site.arg(0),
               fmt::format("the grid `{}` has values from {:.6g} to {:.6g} and a slope of {:.6g}: "
                           "these are too large to reckon with",
                           *path, facts.least, facts.greatest, facts.steepest));
        return poison();
    }
    Corners inside{grid.lo, grid.hi};
    if (ev.scene.graph.is_constant(*level)) {
        const double at = ev.scene.graph.constant_of(*level).value[0];
        const double margin = 1e-6 * std::max(std::fabs(facts.least), std::fabs(facts.greatest));
        if (*above ? facts.greatest <= at : facts.least >= at) {
            report(ev, Code::BadArgument, site.call,
                   fmt::format("nothing is inside: the values of the grid `{}` go from {:.6g} to "
                               "{:.6g}, none of them is {} {:.6g}",
                               *path, facts.least, facts.greatest, *above ? "above" : "below", at))
                .help(
                    fmt::format("say which value the surface has, and on which side the solid is: "
                                "`distance_grid(\"{}\", isovalue: {:.6g}, above: true)`",
                                *path, (facts.least + facts.greatest) / 2));
            return poison();
        }
        if (!spend(ev, site.call, grid.values.size() / values_a_step)) return poison();
        inside = inside_box(grid, at, *above, margin);
    }
    const auto corner = [](const std::array<double, 3> &c) {
        return vec(3, {c[0], c[1], c[2], 0});
    };
    return list_value(ev, {integer(*index), corner(grid.lo), corner(grid.hi),
                           number(facts.steepest > 0 ? facts.steepest * (1 + 1e-6) : 1),
                           corner(inside[0]), corner(inside[1])});
}

// _grid_at(grid, p): its value at p, 0..1 from corner to corner
static Value grid_at_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto index = want_known_int(ev, args[0], site.arg(0), "a grid");
    auto p = want_vec_node(ev, args[1], 3, site.arg(1), "a grid's point");
    if (!index || !p) return poison();
    return from_node(
        ev, ev.scene.graph.make(Op::Grid, Type::Float, {*p}, static_cast<std::uint32_t>(*index)));
}

void add_texture_builtins(std::vector<Builtin> &table) {
    auto add = [&](const char *name, std::vector<BuiltinParameter> parameters, auto call,
                   const char *doc) {
        table.push_back({name, std::move(parameters), false, name[0] == '_', call, "", doc});
    };
    add("image", {{"file"}, {"scale", true}}, image_call,
        "a picture (PNG or JPEG) as a function of a vec2, repeated; 0..1 times `scale` is the "
        "whole of it, "
        "to the right and up");
    add("_displace_map", {{"s"}, {"image"}, {"amount"}, {"scale", true}}, displace_map_call, "");
    add("_grid", {{"file"}, {"isovalue"}, {"above"}, {"name"}}, grid_call, "");
    add("_grid_at", {{"grid"}, {"p"}}, grid_at_call, "");
}

} // namespace fathom::typecheck
