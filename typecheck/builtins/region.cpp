// Regions, in which fields are evaluated: `ball`, `aabb` and `tube`.
#include "typecheck/builtins/builtins.h"
#include "typecheck/conditions.h"
#include "typecheck/remedies.h"

#include <fmt/format.h>

namespace fathom::typecheck {

using ir::Op;
using ir::Type;

static ir::Region flattened(ir::Graph &g, ir::Region region) {
    const auto plane = [&](ir::NodeId v, ir::NodeId z) {
        const ir::NodeId x = g.component(v, 0), y = g.component(v, 1);
        return g.make(ir::Op::Make, Type::Vec3, {x, y, z});
    };
    if (region.center) region.center = plane(region.center, g.number(0));
    if (region.kind == ir::RegionKind::Box) { // no wall above or below is the nearest one
        const ir::NodeId x = g.component(region.size, 0), y = g.component(region.size, 1);
        region.size = plane(region.size, g.add(x, y));
    }
    for (ir::Region &less : region.less) less = flattened(g, std::move(less));
    return region;
}

std::optional<ir::Region> want_region(Interpreter &ev, const Value &v, Span place, What what,
                                      int dims) {
    if (v.kind == ValueKind::Region && v.size == 2 && dims == 3) {
        report(ev, Code::FlatShape, place,
               fmt::format("{} wants a region of space, this one is flat", what))
            .help("give its corners or its centre three coordinates");
        return std::nullopt;
    }
    if (v.kind == ValueKind::Region)
        return dims == 2 ? flattened(ev.scene.graph, ev.regions[v.id]) : ev.regions[v.id];
    want(ev, v, place, what,
         "a region: `ball(r)`, `aabb(lo, hi)`, `tube(axis, r)` or `everywhere`");
    return std::nullopt;
}

Value region_value(Interpreter &ev, ir::Region region, int dims) {
    ev.regions.push_back(std::move(region));
    Value v = make_value(ValueKind::Region, static_cast<std::uint32_t>(ev.regions.size() - 1));
    v.size = static_cast<std::uint8_t>(dims);
    return v;
}

// A point or a corner: a vec3, of flat shapes a vec2. Its height is no matter then.
static std::optional<ir::NodeId> place_argument(Interpreter &ev, const CallSite &site,
                                                const Value &v, std::size_t i,
                                                std::string_view name, int dims, double height) {
    const auto at = want_vec_node(ev, v, dims, site.arg(i), quoted(name));
    if (!at || dims == 3) return at;
    ir::Graph &g = ev.scene.graph;
    const ir::NodeId x = g.component(*at, 0), y = g.component(*at, 1);
    return g.make(Op::Make, Type::Vec3, {x, y, g.number(height)});
}
static bool is_flat_place(Interpreter &ev, const Value &v) {
    return is_numeric(v) && numeric_type(ev, v) == Type::Vec2;
}

static bool positive_sizes(Interpreter &ev, const CallSite &site, ir::NodeId node, std::size_t i) {
    ir::Graph &g = ev.scene.graph;
    const std::string wanted = "a region needs a size above 0";
    for (int k = 0; k < ir::components(g.type(node)); ++k) {
        const ir::NodeId part = ir::components(g.type(node)) > 1 ? g.component(node, k) : node;
        const std::optional<double> number = g.as_number(part);
        if (!number) {
            require(ev, g.make(Op::Less, {g.number(0), part}), site.arg(i), wanted);
        } else if (!(*number > 0)) {
            report(ev, Code::BadArgument, site.arg(i), wanted);
            return false;
        }
    }
    return true;
}

static Value ball_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto r = want_scalar_node(ev, args[0], site.arg(0), "`r`");
    const int dims = is_flat_place(ev, args[1]) ? 2 : 3;
    auto at = given(args[1]) ? place_argument(ev, site, args[1], 1, "at", dims, 0)
                             : std::optional(ev.scene.graph.vec3(0, 0, 0));
    if (!r || !at || !positive_sizes(ev, site, *r, 0)) return poison();
    ir::Region region;
    region.kind = ir::RegionKind::Ball;
    region.center = *at;
    region.size = *r;
    return region_value(ev, region, dims);
}

static Value aabb_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    const int dims = is_flat_place(ev, args[0]) || is_flat_place(ev, args[1]) ? 2 : 3;
    auto lo = place_argument(ev, site, args[0], 0, "lo", dims, -1),
         hi = place_argument(ev, site, args[1], 1, "hi", dims, 1);
    if (!lo || !hi) return poison();
    ir::Graph &g = ev.scene.graph;
    ir::Region region;
    region.kind = ir::RegionKind::Box;
    const ir::NodeId half = g.number(0.5);
    region.center = g.add({g.mul(*lo, half), g.mul(*hi, half)});
    auto size = node_in_range(ev, g.sub(*hi, *lo), site.call);
    if (!size || !positive_sizes(ev, site, *size, 1)) return poison();
    region.size = *size;
    return region_value(ev, region, dims);
}

static Value tube_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto axis = want_vec_node(ev, args[0], 3, site.arg(0), "`axis`");
    auto r = want_scalar_node(ev, args[1], site.arg(1), "`r`");
    if (!axis || !r || !positive_sizes(ev, site, *r, 1)) return poison();
    ir::Region region;
    region.kind = ir::RegionKind::Tube;
    region.size = *r;
    region.axis = -1;
    if (ev.scene.graph.is_constant(*axis)) {
        const ir::Constant c = ev.scene.graph.constant_of(*axis);
        for (std::size_t i = 0; i < 3; ++i)
            if (c.value[i] != 0 && c.value[(i + 1) % 3] == 0 && c.value[(i + 2) % 3] == 0)
                region.axis = int(i);
    }
    if (region.axis < 0) {
        report(ev, Code::BadArgument, site.arg(0), "a tube runs along X, Y or Z");
        return poison();
    }
    return region_value(ev, region);
}

void add_region_builtins(std::vector<Builtin> &table) {
    auto add = [&](const char *name, std::vector<BuiltinParameter> parameters, auto call,
                   const char *doc) {
        table.push_back({name, std::move(parameters), false, false, call, "", doc});
    };
    add("ball", {{"r"}, {"at", true}}, ball_call, "a region: the ball of radius r");
    add("aabb", {{"lo"}, {"hi"}}, aabb_call, "a region: the box between two corners");
    add("tube", {{"axis"}, {"r"}}, tube_call, "a region: the endless cylinder round an axis");
}

} // namespace fathom::typecheck
