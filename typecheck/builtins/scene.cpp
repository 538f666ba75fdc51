// Materials, camera, lights and the other settings of a scene.
#include "typecheck/builtins/builtins.h"
#include "typecheck/textures.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

using ir::Type;

static Value setting_value(Interpreter &ev, Setting s) {
    ev.settings.push_back(std::move(s));
    return make_value(ValueKind::Setting, static_cast<std::uint32_t>(ev.settings.size() - 1));
}

static Value material_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    ir::Graph &g = ev.scene.graph;
    ir::NodeId normal = g.make(ir::Op::Normal, Type::Vec3, std::initializer_list<ir::NodeId>{});
    bool ok = true;
    // each property is a constant or a function of the point, or of the point and the normal
    auto property = [&](std::size_t i, Type type, const char *what, ir::NodeId otherwise) {
        if (!given(args[i])) return otherwise;
        if (type == Type::Vec3) args[i] = or_color(args[i]);
        if (is_function(args[i])) {
            auto node = apply_field(ev, args[i], {g.point(), normal}, type, site.arg(i), what);
            ok = ok && node;
            return node.value_or(otherwise);
        }
        auto node = type == Type::Float ? want_scalar_node(ev, args[i], site.arg(i), what)
                                        : want_color_node(ev, args[i], site.arg(i), what);
        ok = ok && node;
        return node.value_or(otherwise);
    };
    ir::Material m;
    m.diffuse = property(0, Type::Vec3, "`diffuse`",
                         g.vec3(0.2158605, 0.2158605, 0.2158605)); // CSS gray, linear
    m.specular = property(1, Type::Vec3, "`specular`", g.vec3(1, 1, 1));
    m.exponent = property(2, Type::Float, "`exponent`", g.number(32));
    m.emission = property(5, Type::Vec3, "`emission`", g.vec3(0, 0, 0));
    if (given(args[3])) {
        auto texture = want_texture(ev, args[3], site.arg(3), args[4], site.arg(4), "`texture`",
                                    "`texture_scale`");
        ok = ok && texture;
        if (texture) m.texture = *texture;
    } else if (given(args[4])) {
        report(ev, Code::BadArgument, site.arg(4), "`texture_scale` without a `texture`");
        ok = false;
    }
    if (given(args[6])) {
        auto name = want_string(ev, args[6], site.arg(6), "`name`");
        if (name) m.name = *name;
    }
    if (!ok) return poison();
    ev.materials.push_back(m);
    return make_value(ValueKind::Material, static_cast<std::uint32_t>(ev.materials.size() - 1));
}

static Value camera_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    ir::Graph &g = ev.scene.graph;
    Setting s{Setting::Kind::Camera, {}, {}, {}, {}, {}, {}};
    auto at = want_vec_node(ev, args[0], 3, site.arg(0), "`at`");
    auto look = given(args[1]) ? want_vec_node(ev, args[1], 3, site.arg(1), "`look_at`")
                               : std::optional(g.vec3(0, 0, 0));
    auto fov = given(args[2]) ? want_scalar_node(ev, args[2], site.arg(2), "`fov`")
                              : std::optional(g.number(0.78539816339744831));
    auto ortho = given(args[3]) ? want_known_bool(ev, args[3], site.arg(3), "`orthographic`")
                                : std::optional(false);
    if (!at || !look || !fov || !ortho) return poison();
    if (*at == *look) {
        report(ev, Code::BadArgument, site.arg(0), "the camera stands where it looks")
            .help(given(args[1])
                      ? "move it, or let `look_at` be another point"
                      : "move it, or say where it looks with `look_at`: the origin else");
        return poison();
    }
    s.camera = {*at, *look, *fov, *ortho, true};
    return setting_value(ev, std::move(s));
}

static std::optional<ir::NodeId> light_color(Interpreter &ev, const CallSite &site,
                                             const std::vector<Value> &args) {
    ir::Graph &g = ev.scene.graph;
    auto color = given(args[1]) ? want_color_node(ev, args[1], site.arg(1), "`color`")
                                : std::optional(g.vec3(1, 1, 1));
    auto intensity = given(args[2]) ? want_scalar_node(ev, args[2], site.arg(2), "`intensity`")
                                    : std::optional(g.number(1));
    if (!color || !intensity) return std::nullopt;
    return node_in_range(ev, g.mul(*color, *intensity), site.call);
}

static Value light_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    Setting s{Setting::Kind::Light, {}, {}, {}, {}, {}, {}};
    auto at = want_vec_node(ev, args[0], 3, site.arg(0), "`at`");
    auto color = light_color(ev, site, args);
    if (!at || !color) return poison();
    s.light = {false, *at, *color};
    return setting_value(ev, std::move(s));
}

static Value sun_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    ir::Graph &g = ev.scene.graph;
    Setting s{Setting::Kind::Light, {}, {}, {}, {}, {}, {}};
    auto direction = want_vec_node(ev, args[0], 3, site.arg(0), "`direction`");
    auto color = light_color(ev, site, args);
    if (!direction || !color) return poison();
    if (g.is_constant(*direction) && g.constant_of(*direction).value[0] == 0 &&
        g.constant_of(*direction).value[1] == 0 && g.constant_of(*direction).value[2] == 0) {
        report(ev, Code::BadArgument, site.arg(0), "a sun's direction cannot be 0");
        return poison();
    }
    s.light = {true, g.make(ir::Op::Normalize, {*direction}), *color};
    return setting_value(ev, std::move(s));
}

ir::Lighting default_lighting(Interpreter &ev) {
    ir::Graph &g = ev.scene.graph;
    return {.ambient = g.vec3(0.18, 0.18, 0.18),
            .ambient_occlusion = g.number(0.6),
            .shadow_darkness = g.number(0.75),
            .soft_shadows = g.number(0.02),
            .specular_intensity = g.number(0.4),
            .fill = g.number(0.08),
            .occlusion_reach = {}};
}

static Value lighting_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    Setting s{Setting::Kind::Lighting, {}, {}, default_lighting(ev), {}, {}, {}};
    bool ok = true;
    auto number_at = [&](std::size_t i, const char *what, ir::NodeId &out) {
        if (!given(args[i])) return;
        auto n = want_scalar_node(ev, args[i], site.arg(i), what);
        ok = ok && n;
        if (n) out = *n;
    };
    if (given(args[0])) {
        auto ambient = want_color_node(ev, args[0], site.arg(0), "`ambient`");
        ok = ok && ambient;
        if (ambient) s.lighting.ambient = *ambient;
    }
    number_at(1, "`ambient_occlusion`", s.lighting.ambient_occlusion);
    number_at(2, "`shadow_darkness`", s.lighting.shadow_darkness);
    number_at(3, "`soft_shadows`", s.lighting.soft_shadows);
    number_at(4, "`specular_intensity`", s.lighting.specular_intensity);
    const auto switch_at = [&](std::size_t i, const char *what, bool &out) {
        if (!given(args[i])) return;
        auto on = want_known_bool(ev, args[i], site.arg(i), what);
        ok = ok && on;
        out = on.value_or(false);
    };
    switch_at(5, "`skip`", s.lighting.skip);
    switch_at(8, "`classic`", s.lighting.classic);
    if (s.lighting.classic) s.lighting.fill = ev.scene.graph.number(0);
    number_at(6, "`fill`", s.lighting.fill);
    number_at(7, "`occlusion_reach`", s.lighting.occlusion_reach);
    return ok ? setting_value(ev, std::move(s)) : poison();
}

static Value background_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    Setting s{Setting::Kind::Background, {}, {}, {}, {}, {}, {}};
    ir::Graph &g = ev.scene.graph;
    args[0] = or_color(args[0]);
    if (is_function(args[0])) {
        ir::NodeId direction =
            g.make(ir::Op::Direction, Type::Vec3, std::initializer_list<ir::NodeId>{});
        auto node = apply_field(ev, args[0], {direction}, Type::Vec3, site.arg(0), "`background`");
        if (!node) return poison();
        s.background = *node;
    } else {
        auto color = want_color_node(ev, args[0], site.arg(0), "`background`");
        if (!color) return poison();
        s.background = *color;
    }
    return setting_value(ev, std::move(s));
}

static Value render_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    Setting s{Setting::Kind::Render, {}, {}, {}, {}, ev.scene.render, {}};
    bool ok = true;
    auto positive = [&](std::size_t i, const char *what) -> std::optional<double> {
        if (!given(args[i])) return std::nullopt;
        auto x = want_known_number(ev, args[i], site.arg(i), what);
        if (x && !(*x > 0)) {
            report(ev, Code::BadArgument, site.arg(i),
                   fmt::format("{} wants a number above 0", what));
            x.reset();
        }
        ok = ok && x;
        return x;
    };
    if (auto steps = positive(0, "`max_steps`"))
        s.render.max_steps = static_cast<int>(std::min(*steps, 100000.0));
    if (auto epsilon = positive(1, "`epsilon`")) s.render.epsilon = *epsilon;
    if (auto far = positive(2, "`far`")) s.render.far = *far;
    if (auto time = positive(3, "`time`")) s.render.time_end = *time;
    return ok ? setting_value(ev, std::move(s)) : poison();
}

static Value keep_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto text = want_string(ev, args[0], site.arg(0), "`keep`");
    if (!text) return poison();
    Setting s{Setting::Kind::Keep, {}, {}, {}, {}, {}, *text};
    return setting_value(ev, std::move(s));
}

void add_scene_builtins(std::vector<Builtin> &table) {
    auto add = [&](const char *name, std::vector<BuiltinParameter> parameters, auto call,
                   const char *doc) {
        table.push_back({name, std::move(parameters), false, name[0] == '_', call, "", doc});
    };
    add("material",
        {{"diffuse", true},
         {"specular", true},
         {"exponent", true},
         {"texture", true},
         {"texture_scale", true},
         {"emission", true},
         {"name", true}},
        material_call,
        "how a surface looks; each property a constant or a function of the point, or of the point "
        "and the normal; `texture` an image that lies on each base shape by its natural "
        "parametrisation, in the "
        "place of `diffuse`");
    add("camera",
        {{"at"},
         {"look_at", true},
         {.name = "fov", .optional = true, .is_angle = true},
         {"orthographic", true}},
        camera_call,
        "where the scene is seen from: from the point `at`, towards `look_at` (the origin); `fov` "
        "(45deg): the vertical angle of view; `orthographic: true`: without perspective, as high "
        "as "
        "the angle of view is at the distance of `look_at`");
    add("light", {{"at"}, {"color", true}, {"intensity", true}}, light_call, "a light at a place");
    add("sun", {{"direction"}, {"color", true}, {"intensity", true}}, sun_call,
        "a light from far away; the direction points towards it");
    add("lighting",
        {{"ambient", true},
         {"ambient_occlusion", true},
         {"shadow_darkness", true},
         {"soft_shadows", true},
         {"specular_intensity", true},
         {"skip", true},
         {"fill", true},
         {"occlusion_reach", true},
         {"classic", true}},
        lighting_call,
        "how the lights act. `ambient` (0.18): light from everywhere; `ambient_occlusion` (0.6): "
        "how "
        "much of it a place that is closed in loses, 0 to 1; `occlusion_reach`: how far that "
        "looks, "
        "in units; `shadow_darkness` (0.75): how much of a light a shadow takes, 0 to 1; "
        "`soft_shadows` (0.02): half the angle that a light fills as seen from the scene, in "
        "radians, "
        "so that edges are wider the farther off what casts the shadow is, and 0 is hard (what a "
        "hard shadow covers stays dark, and the soft edge lies beside it, so that thin parts cast "
        "whole shadows); "
        "`specular_intensity` (0.4): how bright highlights are; `fill` (0.08): a light at the eye "
        "that casts no shadow; `skip: true`: colours without any light; `classic: true`: plain "
        "Phong, "
        "as in the thesis, without the fill, with ambient light alike from everywhere, and "
        "highlights "
        "that are clamped");
    add("background", {{"color"}}, background_call,
        "a colour, or a function of the ray's direction");
    add("render", {{"max_steps", true}, {"epsilon", true}, {"far", true}, {"time", true}},
        render_call, "limits of the march; `time`: the seconds that the proof covers");
    add("_keep", {{"text"}}, keep_call, "");
}

} // namespace fathom::typecheck
