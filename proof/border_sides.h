// One side of the borders of steps: what a field's parts are a little before, on, and a little after
// the places where steps turn, in one form, so that equal ones are one node (discontinuities.h).
#pragma once

#include "ir/graph.h"
#include "ir/interval.h"
#include "proof/border_ranges.h"
#include "proof/continuity.h"
#include "proof/work.h"

#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

namespace fathom::proof {

using ir::Graph;
using ir::Interval;
using ir::NodeId;
using ir::Op;

constexpr std::size_t max_nodes = 4'000; // of a field that is looked at

constexpr ir::OpSet is_step{Op::Floor, Op::Ceil, Op::Round, Op::Fract, Op::Mod, Op::Atan2};

struct Border;

// Rewrites an expression so that equal ones become the same node more often: sums of products,
// vectors by component, whole numbers as what they are, `mix` at its ends, lengths as roots of
// sums. Steps are what `border` says of them.
struct Canonical {
    Graph &graph;
    Border *border = nullptr;
    bool moving = false; // as the border is neared, not what is reached there
    std::map<NodeId, NodeId> known{};
    bool failed = false; // too large: nothing may be concluded

    std::optional<double> number(NodeId id) const;

    // The Int that a Float is made of, where it is whole by its making.
    std::optional<NodeId> whole(NodeId id);
    NodeId as_float(NodeId id); // of an Int: sums and products outside of the conversion
    std::optional<NodeId> whole_of(NodeId id);
    NodeId float_of(NodeId id);
    std::map<NodeId, std::optional<NodeId>> wholes{};
    std::map<NodeId, NodeId> floats{};

    NodeId scalar(NodeId id);
    NodeId under(NodeId id);
    NodeId noted(NodeId form, NodeId made); // what it was before it was in one form
    std::optional<NodeId> written_product(NodeId a, NodeId b);
    std::optional<NodeId> turned(Op op, NodeId angle);
    std::optional<NodeId> turned_by_cut(Op op, NodeId angle);

    NodeId of(NodeId id, int depth = 0);
    NodeId step(NodeId id, const ir::Node &node, int depth);
    std::optional<NodeId> decided(const ir::Node &node, const std::vector<NodeId> &args);
    std::optional<NodeId> clamped_count(const std::vector<NodeId> &args);
    std::optional<NodeId> decided_part(const ir::Node &node, const std::vector<NodeId> &args,
                                       int component);
    std::optional<NodeId> read_of(const ir::Node &node, NodeId index);

    NodeId rewritten(NodeId id, const ir::Node &node, int depth);
    NodeId loop_of_others(NodeId loop, bool exactly, int depth);
    std::map<std::pair<NodeId, bool>, NodeId> loops{};

    // One component, written as it is computed but for exact numbers: what tells numbers apart has
    // this for its arguments (exact.h).
    NodeId exact(NodeId id, int component, int depth);
    NodeId exact_argument(NodeId id, int depth); // all components
    NodeId as_computed(NodeId id, int component, int depth);
    std::map<std::pair<NodeId, int>, NodeId> exacts{};
};

// Steps of one component that turn where `turning` is a whole number (of an Atan2: where its first
// argument is 0).
struct Group {
    NodeId turning;
    int component = 0;
    std::vector<NodeId> steps;
    bool is_angle = false;
};

// What is written for each side: an expression that all uses of a group's steps go through.
struct Seen {
    NodeId through;
    const std::unordered_map<NodeId, NodeId> &next_through; // of each node: the next one
    bool all_uses_of(NodeId step) const;                    // go through it, too
};
NodeId common_through(const std::unordered_map<NodeId, NodeId> &through, NodeId a, NodeId b);

enum class Side { Before, At, After };
constexpr double sign_of(Side side) { return side == Side::Before ? -1.0 : 1.0; }

// A step's argument near a border: times K + number + slope * the infinitesimal. On the border
// itself the slope is that from after it, and rounds nothing.
struct Near {
    double times = 0, number = 0, slope = 0;
};

// Which of all whole numbers K is one of. `met`: what it would help to know of it.
struct Counts {
    std::optional<int> parity;
    Interval range = Interval::everything();
};
struct Met {
    std::vector<double> thresholds;
    bool parity = false;
};

// One side of a group's borders, where what turns is K, or K + 1/2.
struct Border {
    Graph &graph;
    const Group &group;
    const Seen &seen;
    const NodeId whole, little, little_angle, radius;      // K; how far from the border; by which
                                                           // angle; how far from an axis
    std::map<std::vector<std::uint32_t>, NodeId> &unknown; // by op and arguments, of all sides
    Notes &notes;                                          // … what is known of their ranges
    const bool half;
    const Side side;
    const Counts &counts;
    Met &met;
    Work &work;
    Expansion &forms;
    Canonical limit{graph, this, false}, moving{graph, this, true};
    SideRanges ranges{graph, notes, work, forms};

    // What is known there of coordinates, and of the group's own arguments.
    void enter(Canonical &into, bool moves);

    // What turns, and what it is on the border: of x/m, x and m times that. So m times K is what the
    // field has, too, where 1/(1/m) is not m.
    struct Turning {
        NodeId number, border;
    };
    Turning undivided(NodeId border);

    // Where an angle of two coordinates turns: these by it and their distance from the axis.
    bool by_angle = false;
    bool enter_turned(Canonical &into, NodeId border);
    NodeId of_angle(Canonical &into, Op op, NodeId angle);
    static std::vector<NodeId> down_to_angles(const Graph &graph, NodeId root);

    bool is_own(NodeId step, int component) const;

    // The argument of a step that rounds; nothing where it depends on more than the border.
    std::optional<Near> near(NodeId step, int component, int depth);
    NodeId part(Canonical &of, NodeId step, int arg, int component, int depth);

    // Numbers that are whole but for rounding are whole. Where angles are cut pi may have been
    // written with few digits, and no evaluator tells 1e-9 from 0; near 0 others do.
    double snapped(double x) const;
    // floor(number + slope * the infinitesimal)
    double floor_of(double number, double slope) const;

    // In single precision two steps turn at one number alone where the one's argument is the
    // other's, or a power of two times it.
    bool turns_with(NodeId step, int component, const Near &t) const;
    bool is_power_of_two(NodeId id) const;

    NodeId value(NodeId step, int component, bool moves, int depth);

    // The angle that is cut here; of any other nothing is known.
    NodeId angle(NodeId step, int component, bool moves, int depth);

    // Of steps that hang on other steps alone, the value is what it says; else anything, one for
    // equal arguments.
    NodeId unknown_of(NodeId step, int component, int depth);
    // Takes whole numbers out of a step's argument: by how much its value is more with them. Where
    // an angle is cut, arguments go on by whole numbers of turns.
    double whole_offset(NodeId step, std::vector<NodeId> &args);
    // (j K + n) % 2, j and n whole, by K % 2.
    std::optional<NodeId> parity_of(NodeId count, NodeId two);
    // cos(a K), where a is a whole number of half turns: 1 or -1; sin(a K) is 0 there.
    std::optional<NodeId> cosine_of_half_turns(double a);
    // The sign of j K + n, where that is known of K.
    std::optional<int> sign_of_count(NodeId count);
    bool reads_little(NodeId id) const;
};

} // namespace fathom::proof
