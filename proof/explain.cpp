// The bound's story: the tree of operations with each one's factor, and the chain of the steepest.
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::MapKind;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;

std::string operation_name(const ir::Scene &scene, ShapeId id) {
    const Shape &shape = scene.shapes[id];
    switch (shape.kind) {
    case ShapeKind::Library: return scene.shapes.libraries[shape.payload].name;
    case ShapeKind::Empty: return "empty";
    case ShapeKind::Leaf: return shape.dims == 2 ? "implicit2" : "implicit";
    case ShapeKind::Union: return "union";
    case ShapeKind::Intersection: return "intersection";
    case ShapeKind::Complement: return "complement";
    case ShapeKind::Xor: return "xor";
    case ShapeKind::Blend:
        return ir::profile_name(static_cast<ir::Profile>(shape.payload)) + std::string("_union");
    case ShapeKind::Seam: return ir::seam_name(static_cast<ir::SeamKind>(shape.payload));
    case ShapeKind::Lerp: return "blend";
    case ShapeKind::PseudoNorm: return "pseudonorm_blend";
    case ShapeKind::Map: return ir::map_name(shape.map);
    case ShapeKind::Offset: return "offset";
    case ShapeKind::Shell: return "shell";
    case ShapeKind::Displace: return "displace";
    case ShapeKind::Extrude: return "extrude";
    case ShapeKind::Repeat: return "repeat";
    case ShapeKind::Within: return "within";
    case ShapeKind::Paint: return "paint";
    case ShapeKind::Repaint: return "repaint";
    case ShapeKind::Mixed: return "mix";
    case ShapeKind::Instances: return "copies";
    case ShapeKind::Contract: return "shape<L>";
    }
    return "shape";
}

namespace {

double steepness(const ir::Scene &scene, ShapeId id) { return scene.facts[id.index].lipschitz_sup; }

// The children whose bounds a shape's own follows from: none below claims that are taken.
bool opaque(const ir::Scene &scene, ShapeId id) {
    const Shape &shape = scene.shapes[id];
    return shape.kind == ShapeKind::Library && scene.shapes.libraries[shape.payload].has_claims &&
           (scene.shapes.libraries[shape.payload].claims.lipschitz ||
            scene.shapes.libraries[shape.payload].claims.kind == ir::FieldKind::Exact);
}
ShapeId steepest(const ir::Scene &scene, ShapeId id) {
    ShapeId worst;
    if (opaque(scene, id)) return worst;
    for (ShapeId c : scene.shapes[id].children)
        if (!worst || steepness(scene, c) > steepness(scene, worst)) worst = c;
    return worst;
}
double own_factor(const ir::Scene &scene, ShapeId id) {
    ShapeId below = steepest(scene, id);
    double l = steepness(scene, id), under = below ? steepness(scene, below) : 1;
    return std::isfinite(l) && under > 0 && std::isfinite(under) ? l / under : l;
}

std::string rule_text(const ir::Scene &scene, ShapeId id, Prover &prover) {
    const Shape shape = scene.shapes[id];
    const ir::ShapeFact &fact = scene.facts[id.index];
    auto child = [&](std::size_t i = 0) -> const ir::ShapeFact & {
        return scene.facts[shape.children[i].index];
    };
    auto span = [](Interval x) {
        return x.is_point() ? number_text(x.lo) : number_text(x.lo) + ".." + number_text(x.hi);
    };
    switch (shape.kind) {
    case ShapeKind::Map:
        switch (shape.map) {
        case MapKind::Translate:
        case MapKind::Rotate:
        case MapKind::MirrorFold:
        case MapKind::Revolve: return "a rigid map keeps the slope";
        case MapKind::Scale: return "the factor takes back what the map adds";
        case MapKind::Twist:
            return "shear by rate " + span(prover.number(shape.args[2])) + " * moment arm " +
                   number_text(child().moment_arm[shape.axis]);
        case MapKind::Bend:
            return "1 + rate " + span(prover.number(shape.args[2])) + " * moment arm " +
                   number_text(
                       child()
                           .moment_arm[static_cast<std::size_t>(3 - shape.axis - shape.towards)]);
        case MapKind::Taper:
            return "the cross-section's factor changes from 1 to " +
                   span(prover.number(shape.args[2]));
        case MapKind::Distort: return "the largest stretch of the map, over its region";
        }
        break;
    case ShapeKind::Leaf:
        if (fact.status == ir::ProofStatus::Assumed) return "assumed";
        if (shape.estimate > 0) return "estimated";
        return "the steepest slope of the field over its region";
    case ShapeKind::Displace: return "the displacement's slope is added";
    case ShapeKind::Lerp:
        return "the steeper field, and the weight's slope times how far the two differ";
    case ShapeKind::Seam:
    case ShapeKind::Blend:
    case ShapeKind::PseudoNorm:
        return own_factor(scene, id) > 1.0001 ? "both fields' slopes, weighed by this profile"
                                              : "a mean of the fields' slopes";
    case ShapeKind::Library:
        return opaque(scene, id)
                   ? "stated in the library, beside its proof, or less where its field shows it"
                   : "its body's";
    case ShapeKind::Within: {
        const auto found = scene.cells.find(id);
        if (!scene.shapes.regions[shape.payload].less.empty() && own_factor(scene, id) > 1.0001)
            return "the field inside, led on across the region's holes; the distance to the "
                   "region outside";
        if (found == scene.cells.end())
            return "the field inside, the distance to the region outside";
        const ir::CellBounds &cells = found->second;
        return "the field inside, marched by a bound for each of " +
               std::to_string(cells.count[0] * cells.count[1] * cells.count[2]) +
               (cells.bend.empty() ? " cells" : " cells, and by curvature") +
               "; the distance to the region outside";
    }
    case ShapeKind::Repeat: {
        std::string copies;
        for (int n : fact.repeat.neighbors)
            if (n > 0) copies += (copies.empty() ? "" : " * ") + std::to_string(n);
        return copies + (copies == "1" ? " copy" : " copies") + " evaluated" +
               (fact.repeat.guard ? ", and the distance to the rest" : "");
    }
    case ShapeKind::Empty:
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Extrude:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Instances:
    case ShapeKind::Contract: break;
    }
    return "the steepest part's slope";
}

std::string region_text(const ir::Scene &scene, ShapeId id, Prover &prover) {
    const Shape &shape = scene.shapes[id];
    const Place &place = prover.place(id);
    const Zone *zone = place.zone;
    if (shape.kind == ShapeKind::Within) return "everywhere";
    auto three = [](const Vec &v) {
        return point_text({v[0].middle(), v[1].middle(), v[2].middle()});
    };
    if (zone) switch (zone->kind) {
        case ir::RegionKind::Everywhere: return "everywhere";
        case ir::RegionKind::Ball:
            return "ball(" + number_text(zone->half[0].hi) +
                   (three(zone->center) == "[0, 0, 0]" ? ")"
                                                       : ", at: " + three(zone->center) + ")") +
                   (zone->less.empty() ? "" : " less others");
        case ir::RegionKind::Tube:
            return std::string("tube(") + "XYZ"[zone->axis] + ", " + number_text(zone->half[0].hi) +
                   ")";
        case ir::RegionKind::Box: break;
        }
    if (everywhere(place.box)) return "everywhere";
    return "aabb(" + point_text(place.box.lo, shape.dims) + ", " +
           point_text(place.box.hi, shape.dims) + ")";
}

Explanation explained(const ir::Scene &scene, ShapeId id, Prover &prover, double total, bool worst,
                      int depth) {
    const Shape &shape = scene.shapes[id];
    Explanation out;
    out.shape = id;
    out.operation = operation_name(scene, id);
    out.lipschitz = steepness(scene, id);
    out.factor = own_factor(scene, id);
    out.rule = rule_text(scene, id, prover);
    out.region = region_text(scene, id, prover);
    out.place = shape.origin;
    out.worst = worst;
    if (worst && total > 1 && std::isfinite(total) && out.factor > 1)
        out.share = std::log(out.factor) / std::log(total);
    ShapeId below = steepest(scene, id);
    if (below && depth < 200)
        for (ShapeId c : shape.children) {
            bool first = worst && c == below;
            out.children.push_back(explained(scene, c, prover, total, first, depth + 1));
        }
    return out;
}

} // namespace

std::vector<std::string> Prover::chain(ShapeId id) {
    std::vector<std::string> out;
    for (ShapeId at = id; at; at = steepest(scene, at)) {
        double factor = own_factor(scene, at);
        if (factor > 1 + 1e-6 || factor < 1 - 1e-6)
            out.push_back(operation_name(scene, at) + " makes it " + number_text(factor) +
                          " times as steep: " + number_text(steepness(scene, at)));
    }
    return out;
}

Explanation explain(const ir::Scene &proved) {
    ir::Scene scene = proved; // forms are recognised by making nodes
    Diagnostics silent;
    Options options;
    Prover prover(scene, silent, options);
    prover.places.assign(scene.shapes.size(), {});
    prover.find_places();
    Explanation out;
    if (!scene.root || scene.facts.size() <= scene.root.index) return out;
    return explained(scene, scene.root, prover, steepness(scene, scene.root), true, 0);
}

} // namespace fathom::proof
