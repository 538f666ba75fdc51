// The lowering's own parts, shared by the sources of this folder only. Knows shapes, not the
// language.
//
// A shape is evaluated in one of five readings (lower.h) at a frame: a point, and values for the
// variables that shapes above bind. Every answer is made once; a shape that would be written out in
// several places becomes a function.
#pragma once

#include "ir/lower/lower.h"
#include "ir/passes/walk.h"

#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace fathom::ir {

constexpr double nowhere = 1e9; // the distance to what is not there
// What a least is begun with, where there is one: no field is larger in single precision.
constexpr double beyond_all = 1e30;

// Which of the five functions of a shape is made (lower.h).
enum class Reading : std::uint8_t { Raw, Marched, Hit, SafeRadius, Shaded };

// Where a field is evaluated.
struct Where {
    NodeId p;
    std::uint32_t values = 0; // index of Lowering's environments; 0 binds nothing
};

// Where a material finds the variables that its expressions read: in the four floats of a hit.
struct Packing {
    std::vector<NodeId> vars;
    int numbers = 0; // floats in all vars
};

// One run of the lowering over a scene.
class Lowering {
  public:
    explicit Lowering(Scene &scene);
    void run();
    Parts run_with_parts();
    std::vector<DividedField> divided_fields(double steeper_than);
    std::vector<std::string> surface_names() const; // of what was run

  private:
    // -- evaluating shapes
    NodeId expression_of(Reading reading, ShapeId id, Where frame);
    NodeId answer(Reading reading, ShapeId id,
                  Where frame); // without a function of its own, unless its children's
    NodeId unmarked(Reading reading, ShapeId id,
                    Where frame); // the answer before its part is noted
    NodeId structural(Reading reading, ShapeId id,
                      Where frame);           // through the shape's own combination
    NodeId raw_only(ShapeId id, Where frame); // kinds whose field consumes raw fields
    NodeId colored(ShapeId id, Where frame); // whose surface shows on a leaf: a Hit, distance aside
    bool passes_through(ShapeId id) const;
    NodeId divided(ShapeId id, NodeId raw, double times = 1);
    NodeId displaced(Reading reading, ShapeId id, Where frame);
    NodeId guard(ShapeId id, Where frame);
    NodeId guarded(Reading reading, ShapeId id, Where frame, NodeId value);

    // -- what is looked at (shaded.cpp)
    bool has_slope_above_one(ShapeId id) const;
    bool is_stretched(ShapeId id) const;
    NodeId stretched(ShapeId id, Where frame);
    void find_shaded();
    bool may_have_films() const;
    NodeId shaded(ShapeId id, NodeId raw);

    // -- safe radius (safe_radius.cpp)
    bool passes_safe_radius_on(const Shape &shape) const;
    bool is_straight(ShapeId id) const;
    void find_curved();
    NodeId both(NodeId distance);
    NodeId safe_radius(ShapeId id, Where frame);

    // -- per kind
    NodeId within(Reading reading, ShapeId id, Where frame);
    Where inside(ShapeId id, Where frame); // where `within` evaluates its child
    Where point_of(Where frame, NodeId p);
    Region region_of(ShapeId id, Where frame);

    // -- bounds by cells (cells.cpp)
    struct InCell {
        NodeId slope, way, bend; // bend: invalid where it is not known
        NodeId wall;             // how far slope and bend hold
    };
    InCell in_cell(ShapeId id, NodeId q);
    NodeId divided_by_cells(ShapeId id, ShapeId of, NodeId field, NodeId q);
    NodeId marched_in_box(ShapeId id, Where frame);
    bool may_have_cells(ShapeId id, double steeper_than) const;
    NodeId bent_by_cells(ShapeId id, Where frame);
    NodeId blend(const Shape &shape, Where frame);
    NodeId seam(const Shape &shape, Where frame);
    NodeId pseudonorm(const Shape &shape, Where frame);
    NodeId repeated(Reading reading, ShapeId id, Where frame);
    NodeId lattice(Reading reading, ShapeId id, Where frame);
    NodeId polar(Reading reading, ShapeId id, Where frame);
    NodeId many(Reading reading, ShapeId id, Where frame);
    NodeId painted(ShapeId id, Where frame);
    NodeId mixed(ShapeId id, Where frame);

    // -- values by reading: floats, or hits
    NodeId minimum(Reading reading, std::span<const NodeId> values);
    NodeId maximum(Reading reading, std::span<const NodeId> values);
    NodeId negated(Reading reading, NodeId value);
    NodeId distance_of(Reading reading, NodeId value);
    NodeId at_distance(Reading reading, NodeId value, NodeId distance);
    NodeId far_away(Reading reading, double distance = nowhere);
    NodeId unpainted(NodeId distance);
    // A Loop of `count` iterations that begins far away: `each` says what the value so far becomes,
    // with `index` the iteration's number.
    template <class F>
    NodeId minimum_of(Reading reading, NodeId count, int max_count, NodeId index, F each);

    void look_over(); // what is known before shapes are evaluated

    // -- frames
    NodeId read(NodeId expression, Where frame);
    Where at(Where frame, NodeId p) const { return {p, frame.values}; }
    Where bind(Where frame, NodeId var, NodeId value);
    NodeId value_of(NodeId var, Where frame) const;

    // -- functions
    FunctionId function(Reading reading, ShapeId id);
    void count_uses();
    void find_names();
    void find_free_vars();
    bool is_wrapper(Reading reading, ShapeId id) const;
    bool shared(ShapeId id) const;

    // -- parts (parts.cpp)
    void find_parts();
    NodeId marked(ShapeId id, NodeId hit);
    NodeId painted_part(NodeId hit, bool over, NodeId paint, NodeId point, NodeId extra);
    NodeId farthest_part(NodeId farthest, NodeId first);
    NodeId code_of(NodeId paint);   // without its part; -1 where nobody painted
    NodeId part_only(NodeId paint); // stride times the part

    // -- looks
    std::int32_t surface_of(std::uint32_t material, bool flat);
    NodeId pack(const Packing &packing, Where frame);
    NodeId unpack(const Packing &packing, std::size_t var, NodeId extra);
    Packing packing_of(std::vector<NodeId> vars) const;
    std::int32_t mixed_surface(ShapeId id);
    Surface blank_surface();
    NodeId point3(NodeId p);
    void add_endless(Where frame);
    void add_framed(Where frame); // framing.cpp
    bool has_parts(ShapeId id) const;
    // Where a part is looked for: what its distance is multiplied by, and what it is cut by; invalid: nothing.
    struct Framing {
        Where frame;
        NodeId factor, cut;
    };
    void find_framed(ShapeId id, Framing in, std::vector<NodeId> &alone);

    const Shape &shape(ShapeId id) const { return shapes_[id]; }
    const ShapeFact &fact(ShapeId id) const { return scene_.facts[id.index]; }
    bool has_cells(ShapeId id) const { return scene_.cells.contains(id); }

    Scene &scene_;
    Graph &graph_;
    const Shapes &shapes_;
    NodeId p2_, p3_; // the point parameters, one for all functions
    std::vector<Substitution> environments_{1};
    std::map<std::tuple<std::uint32_t, NodeId, NodeId>, std::uint32_t> derived_;
    std::map<std::tuple<Reading, ShapeId, NodeId, std::uint32_t>, NodeId> answers_;
    std::map<std::pair<Reading, ShapeId>, FunctionId> functions_;
    std::map<std::pair<std::uint32_t, bool>, std::int32_t> surfaces_;
    std::map<ShapeId, std::int32_t> mixed_surfaces_;
    std::map<ShapeId, TableId> cell_tables_;
    std::vector<double> cost_, uses_; // by shape; saturating
    std::vector<char> paint_, reached_;
    std::vector<char>
        curved_; // by shape: something in it has a safe radius larger than its distance
    std::vector<char> shaded_apart_; // by shape: its shaded field is not its marched one
    std::vector<char> unit_slope_;   // by shape: the shaded field's slope is 1 almost everywhere
    std::set<std::tuple<ShapeId, NodeId, NodeId>> framed_seen_; // framing.cpp: shapes, points, cuts
    std::size_t framed_opened_ = 0;                             // … of those without bounds
    Parts parts_;                                               // stride 0: nothing is marked
    std::vector<std::uint32_t> part_;                           // by shape, 0: none of its own
    std::vector<char> colored_;     // by shape: something in it is painted; with parts only
    std::vector<char> parts_below_; // by shape: each of its hits is marked further down
    std::vector<std::string> names_;
    std::vector<std::vector<NodeId>> free_vars_;
};

// lower.cpp: its field is its child's.
bool is_transparent(const Shape &shape, const Shapes &shapes);

// regions.cpp
NodeId joined_distance(Graph &graph, std::span<const NodeId> distances);
struct WayOut {
    NodeId point, part;
};
WayOut region_way_out(Graph &graph, const Region &hole, NodeId p);
std::array<NodeId, 2> region_opposites(Graph &graph, const Region &hole, NodeId p);
NodeId region_between_caps(Graph &graph, const Region &region, NodeId q);
NodeId box_distance(Graph &graph, const Box &box, NodeId p);
// To the cylinder about an axis that is as long as the box.
NodeId cylinder_distance(Graph &graph, const Box &box, int axis, double radius, NodeId p);

// repeat.cpp: how many copies are evaluated one by one, before a loop does it
constexpr int max_unrolled = 8;
int copies_evaluated(const Scene &scene, ShapeId repeat);

} // namespace fathom::ir
