// A whole scene, as the checker hands it to the back ends: the shapes, what was proved of each, and
// the lowered functions that evaluators run. A verified scene always emits, and what is emitted
// always compiles.
#pragma once

#include "ir/shape.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace fathom::ir {

// How many copies of a repetition have to be evaluated, per axis, for a valid and continuous bound.
struct RepeatPlan {
    std::array<int, 3> neighbors{
        0, 0, 0};       // copies evaluated along an axis: 0 does not repeat, 1 the own cell (no
                        // other is ever nearer), 2 the nearer neighbour too, 3 both neighbours,
                        // 2n+1 more
    bool guard = false; // also the distance to the slabs of all copies not evaluated, along the
                        // axes where more than one is
    bool hold = false;  // of each copy the greater of its field and the way to its bounds: a field
                        // that is only a bound may be less than the way to copies not evaluated
    Box copy;           // the child's bounds, for both
};

// What is known of a field in each cell of a box, x first. A cell's slope and bend hold in it grown
// by `margin`.
struct CellBounds {
    Box box;
    std::array<int, 3> count{};
    double margin = 0;
    std::vector<double> lipschitz;
    std::vector<double> way;  // from any point of the cell to the surface, at least; 0 where the
                              // cell may hold surface or lies in the solid
    std::vector<double> bend; // of second derivatives along lines; empty: known of no cell
};

// Of a displacement that is a sum: what its first terms say before the others are evaluated.
struct PartialSum {
    NodeId terms;       // their sum, an expression in Point
    double slope = 0;   // of the sum
    double maximum = 0; // all other terms together, at most
    double minimum = 0; // … and at least
};

// What the analysis proved of one shape, in the shape's own space.
struct ShapeFact {
    FieldKind kind = FieldKind::Bound;
    bool exact_outside =
        false; // the distance, outside the solid: an offset or shell of it is what it says
    ProofStatus status = ProofStatus::Proved;
    NodeId lipschitz; // of the raw field: a float expression in params and time alone; >= the true
                      // constant
    double lipschitz_sup =
        1; // its largest value over all params and times; infinity where the proof failed
    Box bounds = Box::everything(); // holds the solid, for all params and times
    Box bounded; // the hull of the boxes of its parts that have an end: tells a scene's size alone
    // How steep the raw field is where the solid ends, as a power of 2, at least 1; of several parts
    // that of the least steep. Sampled; nothing that is proved rests on it.
    double surface_slope = 1;
    std::array<bool, 3> symmetric{};
    std::array<double, 3> moment_arm{}; // sup |(p x grad f)_axis| over space; infinity: unknown
    double outward = std::numeric_limits<double>::infinity(); // Displace: the most by which it
                                                              // moves the surface outward
    double inward = std::numeric_limits<double>::infinity();  // … and inward
    std::vector<PartialSum> partial; // Displace: shorter sums first, all of it last; or none
    // Displace: M, an upper bound of the raw field's second derivative along any line, down to the
    // depth that the safe radius sqrt(2 f/M) needs (shading.h); infinity: none of use. Else 0 where
    // the field is affine in the point, as a plane's.
    double curvature = std::numeric_limits<double>::infinity();
    bool local = false; // the bound holds within `bounds` alone: the raw field is evaluated at the
                        // nearest point there, and joined with the way to it as Within's is
    bool guard = false; // when marched, take the max with the distance to `bounds` (cheap far away)
    double round = std::numeric_limits<double>::infinity(); // Twist, Bend: the solid lies as near
                                                            // to the axis that it turns about; the
                                                            // guard is that cylinder in `bounds`
    RepeatPlan repeat;
    double detour =
        1; // Within: the ways round what its region leaves out, over the straight ones, at most
};

// What was proved of a cached field (Graph::caches) everywhere, for all params.
struct CacheFact {
    double slope = std::numeric_limits<double>::infinity(); // >= |grad f|; of a vector, of all
                                                            // components together
    double span = std::numeric_limits<double>::infinity();  // >= the distance of any two values
};

// A number or colour that a user may change: its value, its range, where it is declared.
struct Param {
    std::string name, label;
    std::string unit; // "deg", "turn" or "rad", as the range's upper end is written, else empty
    Type type = Type::Float; // Bool, Int, Float, Vec2..Vec4; a colour is a Vec3 with is_color
    bool is_color = false;
    bool has_range = false;
    bool structural = false; // a change rebuilds the scene; else it is a uniform
    bool is_bound = false;   // not of the text: a PresentBound's number
    std::array<double, 4> value{}, initial{}, lo{}, hi{};
    Span origin;

    Constant present() const { // its value
        Constant constant{type, {}};
        std::copy(value.begin(), value.end(), constant.value.begin());
        return constant;
    }
};

// One light; colours are linear.
struct Light {
    bool directional = true;
    NodeId position; // vec3: towards the sun (unit), or the light's place
    NodeId color;    // vec3, linear, times the intensity
};

// All lights of a scene.
struct Lighting {
    NodeId ambient;           // vec3, linear
    NodeId ambient_occlusion; // 0 none … 1 full strength
    NodeId shadow_darkness;   // 0 none … 1 black
    NodeId soft_shadows;      // half the light's angular size, radians; 0 is hard
    NodeId specular_intensity;
    NodeId fill;            // of a light at the eye that casts no shadow; 0 none
    NodeId occlusion_reach; // how far occlusion looks, in units; none or 0: view.h, Frame
    bool skip = false;      // `Skip Shadows & Shading`
    bool classic = false;   // plain Phong: ambient light alike from everywhere, highlights clamped
};

// Where the picture is taken from; closed expressions, angles in radians.
struct Camera {
    NodeId at, look_at; // vec3
    NodeId fov;         // vertical, radians
    bool orthographic = false;
    bool given = false; // false: framed by the rule of semantics.md, 23, from `bounds`
};

// Limits of the sphere tracer.
struct RenderSettings {
    int max_steps = 0;      // evaluations of a ray; 0: shading.h's `budget`
    double epsilon = 5e-4;  // hit tolerance at distance 1, grows with the distance
    double far = 0;         // 0: by the rule of semantics.md, 23
    double time_end = 3600; // the span of time the proof covers starts at 0
};

// How a painted point looks: the material as a function of (point: vec3, normal: vec3, extra:
// vec4). `point` and `extra` are the hit's own; its point lies in the space where the paint stands,
// and so must `normal`. It is found from the world's normal n without knowing the transforms
// between: normalize(hit(p + e*n).point - hit(p).point), for a small e.
struct Surface {
    NodeId point, normal, extra; // Vars
    bool reads_normal = false;   // else any normal will do
    NodeId diffuse, specular, exponent, emission;
};

// What a library function demands of its arguments, where they depend on params or time: to be
// proved.
struct Condition {
    NodeId holds; // Bool
    Span at;      // the user's call
    std::string wanted;
};

// A named value of the file, for documentation and tests.
struct TopLevel {
    ShapeId shape;
    Span span;
};

// An image as linear floats, row by row from the bottom.
struct ImageData {
    std::string name;
    int width = 0, height = 0;
    std::vector<float> rgba; // linear
    std::string file{};      // where it was read, as its user would write it; may be empty
};
// Distances at the corners of a lattice: the first sample stands at `lo`, the last at `hi`, in the
// space of the shape.
struct GridData {
    std::string name; // of the file
    std::array<int, 3> size{};
    std::vector<float> values;
    std::array<double, 3> lo{-0.5, -0.5, -0.5}, hi{0.5, 0.5, 0.5};
    std::string part{}; // the grid's name in the file, where the text says one
    std::string file{}; // where it was read, as its user would write it; may be empty
};

// A whole scene: shapes and expressions, and after lowering its functions.
// Something that the proof relies on and does not prove (docs/trusted.md).
struct Axiom {
    enum class Kind : std::uint8_t { Library, Assumed, Estimated, Rounding } kind{};
    std::string says; // "sphere: exact"
    Span at;          // one place that relies on it
};

// What single precision makes of the marched distance (proof/rounding.h).
struct Rounding {
    bool bounded = true;   // proved: within the tolerance with which rays arrive, or `subtracted`
    double subtracted = 0; // by which all marched distances are less
};

// A shape's bound at the params' present values, as far as it is known: `facts[shape].lipschitz` is
// at most this param (proof/present_bounds.h).
struct PresentBound {
    ShapeId shape;
    std::uint32_t param; // index into Scene::params
};

struct Scene {
    Graph graph;
    Shapes shapes;
    ShapeId root; // the union of the top-level shapes
    std::vector<TopLevel> top_level;
    std::vector<Condition> conditions;
    // Where the user's own fields say what may jump or be infinite, and loops: by node, of a choice
    // by its condition. For messages alone; the first few thousand.
    std::unordered_multimap<NodeId, Span> places;
    std::vector<ShapeFact> facts; // by ShapeId; filled by the analysis
    // Of shapes whose marched field has bounds that differ much from cell to cell: of a Within its
    // child's in the region, of what has a guard its own in its `bounds`. Filled by the analysis.
    std::map<ShapeId, CellBounds> cells;
    std::vector<CacheFact> caches;            // by CacheId; filled by the analysis
    std::vector<Param> params;                // those of bounds behind all others
    std::vector<PresentBound> present_bounds; // none, but where a host asked for them
    std::vector<Light> lights;
    Lighting lighting;
    Camera camera;
    RenderSettings render;
    NodeId background; // vec3, linear, an expression in Direction
    std::vector<ImageData> images;
    std::vector<GridData> grids;
    std::vector<std::string> kept; // given to `dfmodel.keep`, in order: items of a save file that
                                   // the language has no word for; only save-format reads them

    // (vec3) -> float or vec3: what else was asked for (typecheck::Options::fields).
    std::vector<FunctionId> fields;

    // Filled by ir::lower.
    FunctionId distance; // (vec3) -> float: marched: a step of its length never passes a surface
    FunctionId
        safe_radius; // (vec3) -> vec2, or none: the same distance, and the safe radius beside
                     // another sample (shading.h, MARCH), at least as far
    FunctionId
        shaded; // (vec3) -> float: the same surface and signs; no bound above 1 divides it, so
                // it is no safe step. `distance` itself where no bound is above 1
    bool unit_slope = false; // the slope of `shaded` is 1 almost everywhere
    bool exact = false;      // `shaded` is the distance, outside the solid
    bool films = false; // the field may be 0, or nearly, where there is no solid (shading.h, FILMS)
    FunctionId hit;     // (vec3) -> Hit: the same distance, with the surface that decides
    FunctionId endless, endless_hit; // the same of the parts without an end alone, where the scene
                                     // has others beside them
    // Where no camera is given: the parts whose bounds are known, by which their solid is looked
    // for; and each other part alone, as a function (vec3) -> float that is below 0 in the solid.
    struct Framed {
        NodeId distance; // by framed_point
        Box bounds;
    };
    NodeId framed_point; // a Var
    std::vector<Framed> framed_bounded;
    std::vector<FunctionId> framed_alone;
    std::vector<Surface> surfaces;  // by a hit's paint; the last is that of what nobody painted
    FunctionId background_function; // (vec3 direction) -> vec3
    Rounding rounding;              // filled after lowering
    std::vector<Axiom> axioms;      // each once; filled by the analysis
    Box bounds;                     // of the finite top-level parts; empty when there are none
    Box extent;                     // of all parts that have an end, those of endless shapes too
    double far = 0;                 // a far limit for rays

    // What a view without a camera frames: the box of the solid itself at the params' present
    // values (driver/framing.h), empty: `extent`; and how far it reaches along each of
    // framing_directions() (view.h), empty: as far as the box.
    Box framed;
    std::vector<double> framed_reach;
};

} // namespace fathom::ir
