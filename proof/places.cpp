// Where each shape is evaluated at all: places, from the root down. And the place in the text of
// what a field's bound fails by.
#include "proof/discontinuities.h"
#include "proof/prover.h"

#include "ir/maps.h"
#include "ir/passes/walk.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace fathom::proof {

using ir::MapKind;
using ir::NodeId;
using ir::Op;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;

namespace {

// What holds the points at which the field in a region is asked for points in `from`: the region's
// nearest to them, which may lie outside of `from`, and from holes the ways out.
Box confined(const Box &from, const Zone &zone, int dims) {
    Box out = from;
    for (std::size_t a = 0; a < std::size_t(dims); ++a) {
        const bool box = zone.kind == ir::RegionKind::Box;
        if (zone.kind == ir::RegionKind::Everywhere ||
            (zone.kind == ir::RegionKind::Tube && int(a) == zone.axis))
            continue;
        const Interval centre = zone.kind == ir::RegionKind::Tube ? Interval(0.0) : zone.center[a];
        const Interval half = zone.half[box ? a : 0];
        const Interval low = centre - half, high = centre + half;
        double lo = from.lo[a], hi = from.hi[a];
        if (!box) lo = std::min(lo, centre.lo), hi = std::max(hi, centre.hi); // on the way there
        out.lo[a] = std::min(std::max(lo, low.lo), high.lo);
        out.hi[a] = std::min(std::max(hi, low.hi), high.hi);
    }
    const Box nearest = out;
    for (const Zone &hole : zone.less) {
        const Box around = from_cell(outer_box(hole), dims);
        for (std::size_t a = 0; a < std::size_t(dims) && !disjoint(nearest, around); ++a) {
            if (hole.kind == ir::RegionKind::Tube && int(a) == hole.axis) continue;
            out.lo[a] = std::min(out.lo[a], around.lo[a]);
            out.hi[a] = std::max(out.hi[a], around.hi[a]);
        }
    }
    return out;
}

// Whether a map may be proved in its own box instead of in `here`, as the region does not limit how
// far from the axis it is asked: then its child is asked wherever that box lies.
bool asked_in_own_box(const Shape &map, const Box &here) {
    switch (map.map) {
    case MapKind::Twist:
    case MapKind::Bend: return !std::isfinite(radius_about(here, ir::turning_axis(map)));
    case MapKind::Taper: return !here.finite();
    case MapKind::Translate:
    case MapKind::Rotate:
    case MapKind::Scale:
    case MapKind::MirrorFold:
    case MapKind::Revolve:
    case MapKind::Distort: return false;
    }
    return false;
}

} // namespace

Zone Prover::zone_of(const ir::Region &region) {
    Zone zone;
    zone.kind = region.kind;
    zone.axis = region.axis;
    if (region.center) zone.center = vector(region.center);
    if (region.kind == ir::RegionKind::Box) {
        Vec size = vector(region.size);
        for (std::size_t i = 0; i < 3; ++i) zone.half[i] = abs(size[i]) * Interval(0.5);
    } else if (region.size) {
        zone.half[0] = number(region.size);
    }
    for (const ir::Region &less : region.less) zone.less.push_back(zone_of(less));
    return zone;
}

void Prover::visit(ShapeId id, const Box &box, const Zone *zone, bool reported) {
    Place &place = places[id.index];
    if (!place.reached) {
        place.box = box;
        place.zone = zone;
    } else {
        place.box = ir::hull(place.box, box);
        if (place.zone != zone) place.zone = nullptr;
        place.shared = true;
    }
    place.reached = true;
    place.reported = place.reported || reported;
}

void Prover::find_places() {
    for (const ir::TopLevel &top : scene.top_level)
        visit(top.shape, Box::everything(), nullptr, true);
    if (scene.root) visit(scene.root, Box::everything(), nullptr, true);
    for (std::size_t i = scene.shapes.size(); i-- > 0;) {
        ShapeId id{i};
        const Shape &shape = scene.shapes[id];
        Place here = places[i];
        if (!here.reached) continue;
        for (ShapeId child : shape.children) {
            switch (shape.kind) {
            case ShapeKind::Within: {
                zones.push_back(zone_of(scene.shapes.regions[shape.payload]));
                visit(child, confined(here.box, zones.back(), shape.dims), &zones.back(),
                      here.reported);
                break;
            }
            case ShapeKind::Map: {
                Box box = Box::everything();
                if (!everywhere(here.box) && !asked_in_own_box(shape, here.box)) {
                    auto q = range_of(flattening, ranges, shape.args[0], to_cell(here.box));
                    box = from_cell({{q[0], q[1], q[2]}}, scene.shapes[child].dims);
                    if (shape.map == MapKind::Twist ||
                        shape.map == MapKind::Bend) { // turns about an axis keep the radius
                        const int axis = ir::turning_axis(shape);
                        double r = radius_about(here.box, axis);
                        for (std::size_t a = 0; a < 3; ++a)
                            if (int(a) != axis)
                                box.lo[a] = std::max(box.lo[a], -r),
                                box.hi[a] = std::min(box.hi[a], r);
                    }
                }
                visit(child, box, nullptr, here.reported);
                break;
            }
            case ShapeKind::Repeat: visit(child, Box::everything(), nullptr, here.reported); break;
            case ShapeKind::Extrude: visit(child, here.box, nullptr, here.reported); break;
            case ShapeKind::Library: {
                const ir::Library &library = scene.shapes.libraries[shape.payload];
                bool taken = library.has_claims && library.claims.lipschitz;
                visit(child, here.box, here.zone, here.reported && !taken);
                break;
            }
            case ShapeKind::Empty:
            case ShapeKind::Leaf:
            case ShapeKind::Union:
            case ShapeKind::Intersection:
            case ShapeKind::Complement:
            case ShapeKind::Xor:
            case ShapeKind::Blend:
            case ShapeKind::Seam:
            case ShapeKind::Lerp:
            case ShapeKind::PseudoNorm:
            case ShapeKind::Offset:
            case ShapeKind::Shell:
            case ShapeKind::Displace:
            case ShapeKind::Paint:
            case ShapeKind::Repaint:
            case ShapeKind::Mixed:
            case ShapeKind::Instances:
            case ShapeKind::Contract: visit(child, here.box, here.zone, here.reported); break;
            }
        }
    }
}

// -- what is to blame, and where it is written. For messages alone: it tries what stands near the
// place that the search ended at, and proves nothing.
namespace {

// An operation as it stands in the field, and where it may have been written: a node is one however
// often its text stands there.
struct Suspect {
    NodeId node;
    std::vector<Span> at;
};

struct Suspects {
    ir::Scene &scene;
    std::size_t left = 20'000; // nodes that are looked at
    std::vector<Suspect> found{};

    void add_places(NodeId written, std::vector<Span> &out) const {
        const auto [first, last] = scene.places.equal_range(written);
        for (auto it = first; it != last; ++it) out.push_back(it->second);
    }
    // What stands below `root`, a body in which `map` is put for the parameters.
    void look(NodeId root, const ir::Substitution &map) {
        ir::Graph &graph = scene.graph;
        std::vector<NodeId> todo{root};
        std::unordered_set<NodeId> seen;
        while (!todo.empty() && left > 0) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!id || !seen.insert(id).second) continue;
            --left;
            const ir::Node node = graph[id];
            const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
            todo.insert(todo.end(), args.begin(), args.end());
            std::vector<Span> at;
            add_places(id, at);
            if (node.op == Op::Select) add_places(args[0], at);
            if (!at.empty() || node.op == Op::Div)
                found.push_back({map.empty() ? id : ir::substitute(graph, id, map), at});
            if (node.op == Op::Loop) {
                const ir::Loop loop = graph.loop(ir::LoopId{node.payload});
                todo.insert(todo.end(), loop.next.begin(), loop.next.end());
                todo.push_back(loop.condition);
            }
            if (node.op != Op::Call) continue;
            const ir::Function called = graph.function(ir::FunctionId{node.payload});
            ir::Substitution inner;
            for (std::size_t i = 0; i < args.size(); ++i)
                inner[called.params[i]] = ir::substitute(graph, args[i], map);
            look(called.result, inner);
        }
    }
};

bool encloses(Span outer, Span inner) {
    return outer.source == inner.source && outer.begin <= inner.begin && inner.end <= outer.end;
}

// The one place that is meant, where that is clear: of several the one within the shape's own text.
std::optional<Span> only_one(std::vector<Span> places, Span origin) {
    const auto single = [](const std::vector<Span> &all) {
        return !all.empty() &&
               std::ranges::all_of(all, [&](const Span &at) { return at == all[0]; });
    };
    if (single(places)) return places[0];
    std::erase_if(places, [&](const Span &at) { return !encloses(origin, at); });
    if (single(places)) return places[0];
    return std::nullopt;
}

// The points near where the search ended, those on both sides of a jump among them.
Cell about(const FieldBound &bound) {
    Cell out;
    for (std::size_t i = 0; i < 3; ++i) {
        double lo = bound.where[i], hi = lo;
        if (bound.known_sides) {
            lo = std::min({lo, bound.side_a[i], bound.side_b[i]});
            hi = std::max({hi, bound.side_a[i], bound.side_b[i]});
        }
        const double grown = 1e-6 * std::max(1.0, std::max(std::fabs(lo), std::fabs(hi)));
        out.p[i] = Interval(lo - grown, hi + grown);
    }
    return out;
}

} // namespace

Prover::Blamed Prover::blame(ShapeId id, const FieldBound &bound) {
    if (!place(id).reported || work.spent()) return {};
    Suspects suspects{scene};
    for (const NodeId arg : scene.shapes[id].args)
        if (arg) suspects.look(arg, {});
    std::ranges::sort(suspects.found, {}, &Suspect::node); // what is read comes before what reads
    // A search that went far off met no place: then 0 is looked for in all of space that is near.
    constexpr double far = 1e3;
    const bool anywhere = bound.at_infinity && bound.cause == Op::Div;
    Cell near = about(bound);
    for (std::size_t i = 0; anywhere && i < 3; ++i)
        near.p[i] =
            Interval(std::max(place(id).box.lo[i], -far), std::min(place(id).box.hi[i], far));
    // A division by 0 gives what is too large for whatever reads it.
    const bool grows = bound.trouble == Trouble::None || bound.trouble == Trouble::Overflow;
    std::vector<Span> alike;
    for (const Suspect &suspect : suspects.found) {
        const Op op = graph[suspect.node].op;
        if (op == Op::Loop && bound.cause != Op::Loop) continue; // what it holds may be to blame
        const bool alike_op = !grows && (!bound.cause || op == *bound.cause);
        if (!alike_op && (op != Op::Div || bound.trouble == Trouble::Jump)) continue;
        if (alike_op) alike.insert(alike.end(), suspect.at.begin(), suspect.at.end());
        if (graph.reads(suspect.node).free_vars) continue; // in a loop: nobody says in which turn
        if (op == Op::Div) {
            const std::array<Interval, 16> by =
                range_of(flattening, ranges, graph.arg(suspect.node, 1), near);
            const auto parts =
                static_cast<std::size_t>(ir::components(graph[graph.arg(suspect.node, 1)].type));
            if (std::none_of(by.begin(), by.begin() + std::ptrdiff_t(parts),
                             [](const Interval &part) { return part.lo <= 0 && part.hi >= 0; }))
                continue;
        }
        const Tape tape = flatten(flattening, suspect.node);
        if (tape.too_large) continue;
        Machine machine(tape, ranges);
        machine.run(near);
        if (machine.norm() == ir::rounding::infinity)
            return {suspect.node, only_one(suspect.at, scene.shapes[id].origin)};
    }
    return {{}, only_one(std::move(alike), scene.shapes[id].origin)};
}

// The param that a number of the field is divided by, and whose range has 0: the point is none of it.
std::optional<std::string> Prover::divides_by_0(ShapeId id) {
    std::vector<NodeId> todo;
    for (NodeId arg : scene.shapes[id].args)
        if (arg) todo.push_back(written_out(graph, arg));
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId at = todo.back();
        todo.pop_back();
        if (!seen.insert(at).second) continue;
        const NodeId by = graph[at].op == Op::Div ? graph.arg(at, 1) : NodeId();
        const NodeId one = by && graph[by].op == Op::Splat ? graph.arg(by, 0) : by;
        if (one && graph[one].op == Op::Param) {
            const Interval range = range_of(flattening, ranges, one)[0];
            if (range.lo <= 0 && range.hi >= 0) return scene.params[graph[one].payload].name;
        }
        todo.insert(todo.end(), graph.args(at).begin(), graph.args(at).end());
    }
    return {};
}

// A division that no region keeps off 0, as the point has no part in it; and one that is met before
// any place is told.
bool Prover::report_division(ShapeId id, const FieldBound &bound, const Blamed &blamed,
                             const std::string &what) {
    const NodeId by = graph.arg(blamed.node, 1);
    const ir::Graph::Reads reads = graph.reads(by);
    if (reads.point ? !bound.at_infinity : divides_by_0(id).has_value()) return false;
    Diagnostic *d =
        report_at(id, blamed, Code::FieldSingular, what + " is divided by what may be 0");
    if (!d) return true;
    const std::string keep = "keep it off 0, as with `max(…, 0.1)`";
    if (reads.point) {
        d->note("that it is 0 nowhere is not seen, and the field is evaluated everywhere")
            .help(keep + ", or leave those points out, as in `.within(ball(2) - tube(Y, 0.1))`");
        return true;
    }
    const Interval range = range_of(flattening, ranges, by)[0];
    d->note("at all points it is from " + number_text(range.lo) + " to " + number_text(range.hi) +
            (reads.time && reads.params ? ", by the time and by params"
             : reads.time               ? ", by the time that is covered"
                                        : ", by a param's range"));
    const NodeId size = graph[by].op == Op::Splat ? graph.arg(by, 0) : by;
    if (graph[size].op == Op::Length && graph.arg(size, 0) == graph.arg(blamed.node, 0))
        d->help("a direction is `normalize(v)`, which is 0 where `v` is");
    else
        d->help(keep + (reads.time ? "" : ", or begin the param's range further in"));
    return true;
}

// What is singular nowhere that the search came to: it may be so for intervals alone.
void Prover::report_unplaced(ShapeId id, const FieldBound &bound, const Blamed &blamed,
                             const std::string &what, const std::string &cause) {
    const bool leaf = scene.shapes[id].kind == ShapeKind::Leaf;
    Diagnostic *d = report_at(id, blamed, Code::LipschitzUnbounded,
                              "no bound on the slope of " + what + " is found near " +
                                  point_text(bound.where, scene.shapes[id].dims));
    if (!d) return;
    const std::string assume = leaf ? std::string("or ") + state_a_bound : "or limit it";
    if (bound.each_side)
        d->note("a step or a choice has a border there; each of its sides has a bound, but that " +
                cause + " does not happen on the border itself is not seen")
            .help("where it is cells that meet there let `repeat` make them, as in "
                  "`s.repeat([1, 0, 0])`, " +
                  assume);
    else
        d->note("that " + cause +
                " does not happen there is not seen: the search ended before it "
                "came down to a place")
            .help("choose a smaller region, " + assume);
}

Diagnostic *Prover::report_at(ShapeId id, const Blamed &blamed, Code code, std::string message) {
    if (!blamed.at || work.spent()) return report(id, code, std::move(message));
    if (!place(id).reported) return nullptr;
    const Span whole = scene.shapes[id].origin;
    Diagnostic &d = diagnostics.add(code, *blamed.at, std::move(message));
    if (!encloses(whole, *blamed.at)) d.label(whole, "in this field");
    return &d;
}

} // namespace fathom::proof
