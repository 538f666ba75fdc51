// What a scene means: a hash-consed tree of shapes over field expressions. This level keeps what
// the user said (combination, transforms, library names); `lower.h` turns it into plain functions
// for the back ends.
//
// A shape is a *raw field*, a function of a point (vec3, or vec2 for flat ones), negative inside.
// Expressions in `args` stand in the shape's own space (where `Point` is the point that the shape
// is evaluated at) unless said.
#pragma once

#include "ir/graph.h"

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace fathom::ir {

struct Shape;
using ShapeId = Id<Shape>;

// f, g: the children's raw fields. p: Point. a[i]: args.
enum class ShapeKind : std::uint8_t {
    Empty,        // nowhere: +infinity (1e9 when emitted)
    Leaf,         // a[0], a float expression in Point
    Union,        // min of the children; no child is Empty
    Intersection, // max of the children
    Complement,   // -f
    Xor,          // max(min(f, g), -max(f, g)), folded in order
    Blend, // payload Profile: (r = a[0], n = a[1]) union of the children with that profile, folded
           // in order. Intersections and differences are written with Complement: f ∩ g =
           // -blend(-f, -g)
    Seam,  // payload SeamKind: two children; (r or width = a[0], depth = a[1])
    Lerp,  // t = a[0] (a field or number): t*f + (1 - t)*g (thesis 2.13, 2.14)
    PseudoNorm, // exponent = a[0] (Hart 1996): see semantics.h
    Map,        // payload MapKind: factor*f(q), q = a[0] an expression in Point, factor = a[1] > 0;
                // a[2…]: the numbers that the kind's rule needs, see MapKind
    Offset,     // f - a[0]
    Shell,      // |f| - a[0]/2
    Displace,   // f - a[0], a[0] a field in Point; a[1..3], where given: its slope, least and most,
                // stated by the library; payload then: 1 + index into Shapes::displacement_maps
    Extrude,    // flat child along z: exact combination of f(p.xy) and |p.z| - a[0]/2
    Repeat,     // union of copies of the child: see `Repetition`
    Within,     // payload: Shapes::regions. The part of f inside the region (semantics.md, 11)
    Paint,      // payload: Shapes::materials, fills what is unpainted; f itself
    Repaint,    // the same, overriding
    Mixed,      // child is a Blend; materials are mixed by the blend's weights (`mix: true`)
    Instances, // payload: Shapes::instance_tables: the union, or the smooth union, of copies that differ by
               // their row
    Library, // one child, its body; payload: Shapes::libraries: name, arguments, claims
    Contract // f; payload: index into Shapes::contracts: `shape<L>` demanded here
};
const char *shape_kind_name(ShapeKind kind);
// Whether the kind is listed. A new kind is none of any list: where that would be wrong, a switch
// over all kinds has to name it.
constexpr bool is_one_of(ShapeKind kind, std::initializer_list<ShapeKind> kinds) {
    for (const ShapeKind one : kinds)
        if (kind == one) return true;
    return false;
}

// The profiles that stand along the line where two surfaces meet.
enum class SeamKind : std::uint8_t { Pipe, Engrave, Groove, Tongue };

// How q depends on p, so that the analysis need not rediscover it.
enum class MapKind : std::uint8_t {
    Translate, // q = p - a[2]
    Rotate, // q = transpose(R) p, any isometry that fixes the origin, reflections too; a[2] = the
            // matrix R (mat3; of flat shapes mat2)
    Scale,  // q = p / a[2] (a vector), factor = min |a[2]|
    MirrorFold, // q is continuous and 1-Lipschitz (mirror folds, elongate): no numbers
    Revolve,    // flat child: q = (length(p.xz) - a[2], p.y)
    Twist,      // rate a[2], payload2 axis: turns by rate * (p along the axis)
    Bend,       // rate a[2], axis and towards in axis/towards
    Taper,      // a[2] = ratio, a[3] = from, a[4] = to along the axis; factor is part of the rule:
                // c(y)*f(p/c(y), y)
    Distort     // any q
};

// The forms of a `within:` region.
enum class RegionKind : std::uint8_t { Everywhere, Ball, Box, Tube };

// A convex region, less others (`ball(2) - tube(Y, 0.3)`). Numbers are expressions without Point.
struct Region {
    RegionKind kind = RegionKind::Everywhere;
    NodeId center; // Ball, Box: its centre (vec3)
    NodeId size;   // Ball, Tube: the radius (float); Box: its full size (vec3)
    int axis = 1;  // Tube: 0, 1 or 2, through the origin, infinite
    std::vector<Region> less;
};

// Repetition of one child on a lattice (semantics.md, 14; thesis 2.16) or round an axis. The
// geometry is always the union of all copies; the analysis chooses how few are evaluated.
struct Repetition {
    bool polar = false;
    int axis =
        1; // polar: round this axis, a[0] = how many copies (Int, constant); copy k is turned by
           // k/a[0] of a turn. The first is taken to lie about +x (of axis x: about +y)
    std::array<bool, 3> along{}; // lattice: which axes repeat. args: a[0] cell (vec3), a[1] count
                                 // (vec3; 1e9 where infinite)
    bool mirrored = false;       // repeat_mirror: every other cell is the reflection
    NodeId id; // Var (vec3): the cell's id, whole numbers, counted from 0 where finite; read by the
               // child where copies differ (invalid when no copy reads it)
};

// `count` copies of a child that reads `index` (Int) and, through TableRead(index), its row's
// numbers.
struct InstanceTable {
    NodeId index;
    int count = 0;
    bool smooth = false; // else a plain union; a[0] = k
};

// An image as the user gave it to a material or to `displace_map`. What it does stands in the
// expressions; this is for those who read a scene back.
struct Texture {
    std::int32_t image = -1; // index into Scene::images; -1: none
    std::array<double, 2> scale{1, 1};
};
struct DisplacementMap {
    Texture map;
    NodeId amount; // as written, in the space where `displace_map` stands
    ShapeId whole; // what it made: the shape given to it, its bases displaced
};

// A colour or number of a material: an expression in Point and Normal of the space where the paint
// stands.
struct Material {
    NodeId diffuse;     // vec3, linear
    NodeId specular;    // vec3, linear
    NodeId exponent;    // float
    NodeId emission;    // vec3, linear
    Texture texture{};  // of `texture:`; it is in `diffuse` already
    std::string name{}; // of the `let` that named it, where one did: the save format's name for it
};

// What may be said of a field (lipschitz.md, 1), best first.
enum class FieldKind : std::uint8_t {
    Exact,   // E: |f| is the distance to the surface, on both sides; L = 1
    Bound,   // B: |f| never exceeds that distance
    Estimate // nothing is known
};

// How sure a bound is: proved, stated by the user, or sampled.
enum class ProofStatus : std::uint8_t { Proved, Assumed, Estimated };

// An axis-parallel box; sides may be infinite.
struct Box {
    std::array<double, 3> lo{std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity()};
    std::array<double, 3> hi{-std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()};
    bool empty() const { return lo[0] > hi[0] || lo[1] > hi[1] || lo[2] > hi[2]; }
    bool finite() const;
    static Box everything();
};
// The smallest box that holds both.
Box hull(Box a, Box b);
// What both have in common; may be empty.
Box intersect(Box a, Box b);

// What only the embedded library may state of a body (semantics.md, 12). Expressions without Point,
// in the call's numbers.
struct Claims {
    FieldKind kind = FieldKind::Bound;
    NodeId lipschitz; // invalid: to be proved
    NodeId lo, hi;    // vec3 (flat: vec2): a box that holds the solid; invalid: unknown
    NodeId
        growth_rate; // {f < t} lies in that box grown by growth_rate*t, t >= 0; invalid: 1 where exact, else
                     // unknown
    std::array<bool, 3> symmetric{}; // mirror symmetry across x = 0, y = 0, z = 0
    std::array<NodeId, 3>
        moment_arm{}; // sup |(p x grad f)_axis| (lipschitz.md, 5.1); invalid: derived from the box
};

// A call of a library shape: its name, its arguments and its claims.
struct Library {
    std::string name; // "sphere"
    std::vector<std::pair<std::string, NodeId>>
        arguments; // the call's, defaults filled in; the numbers and vectors only
    std::vector<std::pair<std::string, std::vector<NodeId>>> lists{}; // … and lists of them
    bool has_claims = false;
    Claims claims;
};

// A bound that a parameter's type demands of a shape.
struct Contract {
    double lipschitz = 1;
    Span demanded; // where the type was written
};

// One node of the tree: a kind, child shapes, and expressions.
struct Shape {
    ShapeKind kind = ShapeKind::Empty;
    std::uint8_t dims = 3;              // 2: flat
    MapKind map{};                      // Map
    std::uint8_t axis = 1, towards = 0; // Twist, Bend, Taper
    std::uint32_t payload = 0;
    std::vector<ShapeId> children;
    std::vector<NodeId> args;
    // Leaf and Map/Distort of the user's own: what he assumes (`lipschitz:`, `estimate:`); 0 is
    // nothing
    double assumed = 0, estimate = 0;
    Span origin; // the call that made it; the first one where equal shapes were merged,
                 // trials apart
};

// All shapes of a scene, hash-consed.
class Shapes {
  public:
    ShapeId add(Shape shape); // hash-consed, the origin apart
    // Shapes from that one on were made for a trial: who makes them in earnest says where.
    void forget_origins(std::size_t from);
    const Shape &operator[](ShapeId id) const { return shapes_[id]; }
    std::size_t size() const { return shapes_.size(); }
    std::size_t bytes() const; // of memory, about, with what passes keep beside each shape
    std::size_t tallest() const { return tallest_; } // the longest way from a shape down to a leaf

    std::vector<Region> regions;
    std::vector<Repetition> repetitions;
    std::vector<InstanceTable> instance_tables;
    std::vector<Material> materials;
    std::vector<DisplacementMap> displacement_maps;
    std::vector<Library> libraries;
    std::vector<Contract> contracts;
    // Unions as the scene lists them, by the shape that they became where that says less (like
    // copies gathered, doubles left out). Only what reads a scene back for people needs it: the
    // save format.
    std::unordered_map<ShapeId, std::vector<ShapeId>> listed;

  private:
    Arena<Shape> shapes_;
    std::unordered_multimap<std::uint64_t, ShapeId> interned_;
    std::size_t listed_ = 0; // children and arguments of all
    std::vector<std::uint32_t> heights_;
    std::size_t tallest_ = 0;
};

// Their names in dumps and explanations: "smooth", "twist", "pipe".
const char *profile_name(Profile profile);
const char *map_name(MapKind kind);
const char *seam_name(SeamKind kind);

} // namespace fathom::ir
