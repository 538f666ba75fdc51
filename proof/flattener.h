// What makes a tape of an expression: scopes, slots, and each node's instruction (tape.h).
#pragma once

#include "proof/forms.h"
#include "proof/linear_maps.h"
#include "proof/rescaled.h"
#include "proof/supports.h"
#include "proof/tape.h"
#include "proof/winding.h"

#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace fathom::proof {

struct Scope {
    Scope *outer = nullptr;                    // a loop's surroundings; none for a function's body
    std::vector<Instruction> *block = nullptr; // where what depends on this scope's variables goes
    std::unordered_map<NodeId, Slot> slots;
    std::unordered_map<NodeId, bool> depends; // on the loop's variables
    bool loop = false;
};

struct Flattener {
    Flattening &context;
    ir::Graph &graph;
    Tape tape;
    std::vector<bool> varies; // by slot
    std::size_t count = 0;
    std::unordered_set<NodeId> cancelling; // steps and choices
    std::unordered_set<NodeId> stepped;    // angles that steps alone read
    std::unordered_set<NodeId> own;        // what the field is made of as it is given
    std::unordered_set<NodeId> indices;    // of loops

    // What a rewriting puts in the place of a step that cancels does too, where all uses of it are
    // those of that step: what the field has besides, equal and so the same node, may not.
    void cancel_like(NodeId step, NodeId made) {
        if (cancelling.contains(step) && !own.contains(made)) cancelling.insert(made);
    }
    std::unordered_set<NodeId> known_linear;
    std::map<std::pair<NodeId, bool>, RescaledNodes> met; // by factor, and whether it divides
    std::optional<Winding> winding;
    int steps_of_pieces = 0;
    Supports supports{tape};

    explicit Flattener(Flattening &c) : context(c), graph(c.graph) {}

    Slot fresh(ir::Type type, bool varying);

    // Leaves single precision for arguments as scenes have them.
    bool grows(const Instruction &instruction) const;

    Slot emit(Scope &scope, Instruction instruction);

    // Does the node read the variables of this loop?
    bool depends(Scope &scope, NodeId id);

    const Slot *find(Scope &scope, NodeId id);

    // All of `roots`, arguments first. A loop's body is walked when its Loop is met.
    void walk(Scope &scope, const std::vector<NodeId> &roots);

    Slot slot(Scope &scope, NodeId id);

    // Scalars, but those of one vector together: their norm is no more than the vector's.
    std::vector<NodeId> by_vector(std::vector<NodeId> parts);
    // What is affine by pieces, in what it is made of.
    std::optional<Pieces> pieces_of(NodeId id, const std::vector<NodeId> &of);
    Slot emit_by_pieces(Scope &scope, NodeId id, Instruction out, const std::vector<NodeId> &of);

    // A vector that may be another one turned, or moved along a direction.
    Slot emit_turned(Scope &scope, NodeId id, Instruction out);
    Instruction::Turning turning_of(Scope &scope, const LinearMap &map);
    std::vector<NodeId> args_of(NodeId id) const { // a copy: flattening may add nodes
        return {graph.args(id).begin(), graph.args(id).end()};
    }
    Slot emit(Scope &scope, Instruction out, Form form, const std::vector<NodeId> &args);
    Slot emit_plain(Scope &scope, NodeId id, Instruction out);
    // Of a sine or cosine, where points turn about an axis.
    Slot emit_unwound(Scope &scope, NodeId id, Instruction out);

    Slot flatten_node(Scope &scope, NodeId id);

    // Does the step that a wave is made with? x - m*round(x/m), held or not, x % m - m/2, …
    bool step_cancels(NodeId wave) const;

    void find_mean(Scope &scope, NodeId id, Instruction &out);
    void find_interpolation(Scope &scope, NodeId id, Instruction &out);
    Slot mix(Scope &scope, NodeId id, Instruction out);
    Slot sum(Scope &scope, NodeId id, Instruction out);

    void find_around(Scope &scope, NodeId id, Instruction &out);
    void find_beside_turn(Scope &scope, NodeId id, Instruction &out);
    void find_parallel(Scope &scope, NodeId id, Instruction &out);
    void find_radial(Scope &scope, NodeId id, Instruction &out);
    void find_ellipsoid(Scope &scope, NodeId id, Instruction &out);
    void find_univariate(Scope &scope, NodeId id, Instruction &out);
    // A product or quotient by numbers whose inverses meet them in the rest (rescaled.h).
    std::optional<NodeId> without_factors(Scope &scope, NodeId id);
    Slot product(Scope &scope, NodeId id, Instruction out);

    Slot norm_of_powers(Scope &scope, NodeId id, Instruction out, const PNormParts &found);
    NodeId in_scalar_factors(NodeId id, int depth = 0);
    Slot power(Scope &scope, NodeId id, Instruction out);
    Slot quotient(Scope &scope, NodeId id, Instruction out);

    Slot vector(Scope &scope, NodeId id, Instruction out);

    // acos(v.y / length(v))
    Slot inverse_cosine(Scope &scope, NodeId id, Instruction out);

    // A choice of vectors as a vector of choices, where components differ.
    NodeId by_component(const std::vector<NodeId> &choice);

    Slot choice(Scope &scope, NodeId id, Instruction out);

    Slot call(Scope &scope, NodeId id, ir::FunctionId which);

    std::unordered_map<NodeId, std::vector<Slot>> loop_results;

    bool counts_turns(NodeId id) const;
    Slot loop(Scope &scope, NodeId id);
};

} // namespace fathom::proof
