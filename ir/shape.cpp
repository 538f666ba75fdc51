// The hash-consed shapes and the boxes that bound them.
#include "ir/shape.h"

#include "base/hash.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fathom::ir {

const char *profile_name(Profile profile) {
    switch (profile) {
    case Profile::Smooth: return "smooth";
    case Profile::Round: return "round";
    case Profile::Chamfer: return "chamfer";
    case Profile::Stairs: return "stairs";
    case Profile::Columns: return "columns";
    }
    return "";
}

const char *map_name(MapKind kind) {
    switch (kind) {
    case MapKind::Translate: return "translate";
    case MapKind::Rotate: return "rotate";
    case MapKind::Scale: return "scale";
    case MapKind::MirrorFold: return "fold";
    case MapKind::Revolve: return "revolve";
    case MapKind::Twist: return "twist";
    case MapKind::Bend: return "bend";
    case MapKind::Taper: return "taper";
    case MapKind::Distort: return "distort";
    }
    return "";
}

const char *seam_name(SeamKind kind) {
    switch (kind) {
    case SeamKind::Pipe: return "pipe";
    case SeamKind::Engrave: return "engrave";
    case SeamKind::Groove: return "groove";
    case SeamKind::Tongue: return "tongue";
    }
    return "";
}

const char *shape_kind_name(ShapeKind kind) {
    switch (kind) {
    case ShapeKind::Empty: return "empty";
    case ShapeKind::Leaf: return "leaf";
    case ShapeKind::Union: return "union";
    case ShapeKind::Intersection: return "intersection";
    case ShapeKind::Complement: return "complement";
    case ShapeKind::Xor: return "xor";
    case ShapeKind::Blend: return "blend";
    case ShapeKind::Seam: return "seam";
    case ShapeKind::Lerp: return "lerp";
    case ShapeKind::PseudoNorm: return "pseudonorm";
    case ShapeKind::Map: return "map";
    case ShapeKind::Offset: return "offset";
    case ShapeKind::Shell: return "shell";
    case ShapeKind::Displace: return "displace";
    case ShapeKind::Extrude: return "extrude";
    case ShapeKind::Repeat: return "repeat";
    case ShapeKind::Within: return "within";
    case ShapeKind::Paint: return "paint";
    case ShapeKind::Repaint: return "repaint";
    case ShapeKind::Mixed: return "mixed";
    case ShapeKind::Instances: return "many";
    case ShapeKind::Library: return "library";
    case ShapeKind::Contract: return "contract";
    }
    return "";
}

bool Box::finite() const {
    for (std::size_t i = 0; i < 3; ++i)
        if (!std::isfinite(lo[i]) || !std::isfinite(hi[i])) return false;
    return true;
}

Box Box::everything() {
    constexpr double far = std::numeric_limits<double>::infinity();
    return {{-far, -far, -far}, {far, far, far}};
}

Box hull(Box a, Box b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    for (std::size_t i = 0; i < 3; ++i) {
        a.lo[i] = std::min(a.lo[i], b.lo[i]);
        a.hi[i] = std::max(a.hi[i], b.hi[i]);
    }
    return a;
}

Box intersect(Box a, Box b) {
    for (std::size_t i = 0; i < 3; ++i) {
        a.lo[i] = std::max(a.lo[i], b.lo[i]);
        a.hi[i] = std::min(a.hi[i], b.hi[i]);
    }
    return a.empty() ? Box{} : a;
}

namespace {

std::uint64_t hash_of(const Shape &shape) {
    std::uint64_t h = static_cast<std::uint64_t>(shape.kind);
    h = hash_combine(h, static_cast<std::uint64_t>(shape.map) << 24 |
                            std::uint64_t{shape.dims} << 16 | std::uint64_t{shape.axis} << 8 |
                            shape.towards);
    h = hash_combine(h, shape.payload);
    for (ShapeId child : shape.children) h = hash_combine(h, child.index);
    h = hash_combine(h, shape.children.size());
    for (NodeId arg : shape.args) h = hash_combine(h, arg.index);
    h = hash_combine(h, std::bit_cast<std::uint64_t>(shape.assumed));
    return hash_combine(h, std::bit_cast<std::uint64_t>(shape.estimate));
}

bool equal(const Shape &a, const Shape &b) {
    return a.kind == b.kind && a.dims == b.dims && a.map == b.map && a.axis == b.axis &&
           a.towards == b.towards && a.payload == b.payload && a.children == b.children &&
           a.args == b.args && a.assumed == b.assumed && a.estimate == b.estimate;
}

} // namespace

ShapeId Shapes::add(Shape shape) {
    const std::uint64_t h = hash_of(shape);
    const auto [first, last] = interned_.equal_range(h);
    for (auto it = first; it != last; ++it)
        if (equal(shapes_[it->second], shape)) {
            Span &origin = shapes_[it->second].origin;
            if (!origin.source) origin = shape.origin;
            return it->second;
        }
    listed_ += shape.children.size() + shape.args.size();
    std::uint32_t below = 0;
    for (ShapeId child : shape.children) below = std::max(below, heights_[child.index]);
    heights_.push_back(below + 1);
    tallest_ = std::max<std::size_t>(tallest_, below + 1);
    const ShapeId id = shapes_.add(std::move(shape));
    interned_.emplace(h, id);
    return id;
}

std::size_t Shapes::bytes() const {
    constexpr std::size_t beside = 900; // an entry of the hash table, and facts of the proof
    return shapes_.size() * (sizeof(Shape) + beside) + listed_ * sizeof(ShapeId) +
           libraries.size() * (sizeof(Library) + 128);
}

void Shapes::forget_origins(std::size_t from) {
    for (std::size_t i = from; i < shapes_.size(); ++i) shapes_[ShapeId{i}].origin = {};
}

} // namespace fathom::ir
