// Where each shape is evaluated at all: places, from the root down.
#include "proof/prover.h"

#include "ir/maps.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::MapKind;
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

} // namespace fathom::proof
