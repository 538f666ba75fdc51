// What took most of the proof's work, where there was too much of it: the shape that most steps went
// on, and in its field the loop that most of the operations are in. For a message alone.
#include "ir/passes/operations.h"
#include "proof/prover.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_set>

namespace fathom::proof {
namespace {

using ir::NodeId;
using ir::Op;
using ir::ShapeId;
using ir::ShapeKind;

// The loops that expressions hold, but for those in the bodies of loops; and how many steps and
// choices there are, everywhere.
struct LoopsHeld {
    const ir::Graph &graph;
    std::vector<NodeId> loops{};
    std::size_t choices = 0;

    void look(std::vector<NodeId> todo, bool in_bodies) {
        constexpr ir::OpSet turns{Op::Select, Op::Sign,  Op::Step,  Op::Floor, Op::Ceil,
                                  Op::Round,  Op::Trunc, Op::Fract, Op::Mod,   Op::Atan2};
        std::unordered_set<NodeId> seen;
        while (!todo.empty()) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!id || !seen.insert(id).second) continue;
            const ir::Node node = graph[id];
            choices += turns[node.op];
            if (node.op == Op::Call)
                todo.push_back(graph.function(ir::FunctionId{node.payload}).result);
            if (node.op == Op::Loop) {
                loops.push_back(id);
                if (in_bodies) std::ranges::copy(body(id), std::back_inserter(todo));
            }
            std::ranges::copy(graph.args(id), std::back_inserter(todo));
        }
    }
    const ir::Loop &loop(NodeId id) const { return graph.loop(ir::LoopId{graph[id].payload}); }
    std::vector<NodeId> body(NodeId id) const {
        std::vector<NodeId> out = loop(id).next;
        out.push_back(loop(id).condition);
        return out;
    }
};

// The first place in the text: the order of equal keys is not told.
std::optional<Span> place_of_loop(const ir::Scene &scene, NodeId loop) {
    const auto [first, last] = scene.places.equal_range(loop);
    std::optional<Span> out;
    for (auto it = first; it != last; ++it) out = out ? std::min(*out, it->second) : it->second;
    return out;
}

struct DearLoop {
    Span at;
    double operations = 0, turns = 0; // of all its turns, at one point
};

// What is computed so many times at one point.
struct Repeated {
    double times = 1;
    std::vector<NodeId> roots;
};

// The innermost one in which most of the operations are, of those whose place is known. One of the
// text may be several, where an outer one was written out.
std::optional<DearLoop> dearest_loop(const ir::Scene &scene, const std::vector<NodeId> &roots) {
    struct Loops {
        double operations = 0, turns = 0;
        std::vector<Repeated> bodies{};
    };
    const double all = ir::operations(scene.graph, roots);
    std::optional<DearLoop> out;
    std::vector<Repeated> within{{1, roots}};
    for (;;) {
        std::map<std::pair<std::optional<Span>, NodeId>, Loops> loops; // by place, or else by node
        for (const Repeated &outer : within) {
            LoopsHeld held{scene.graph};
            held.look(outer.roots, false);
            for (const NodeId id : held.loops) {
                const auto at = place_of_loop(scene, id);
                Loops &own = loops[{at, at ? NodeId() : id}];
                const double times = outer.times * held.loop(id).max_count;
                own.bodies.push_back({times, held.body(id)});
                own.operations += times * ir::operations(scene.graph, held.body(id));
                own.turns += times;
            }
        }
        const auto dearest = std::ranges::max_element(
            loops, {}, [](const auto &one) { return one.second.operations; });
        if (dearest == loops.end() || dearest->second.operations < all / 2) return out;
        const Loops &found = dearest->second;
        if (dearest->first.first)
            out = DearLoop{*dearest->first.first, found.operations, found.turns};
        within = found.bodies;
    }
}

} // namespace

void Prover::report_limit(ShapeId id) {
    const auto total = double(options.work - work.left);
    ShapeId dearest = id;
    std::size_t most = spent.size() == id.index ? left_before - work.left : 0;
    for (std::size_t i = 0; i < spent.size(); ++i)
        if (spent[i] > most && place(ShapeId{i}).reported) most = spent[i], dearest = ShapeId{i};
    const ir::Shape &shape = scene.shapes[dearest];
    std::vector<NodeId> roots;
    for (const NodeId arg : shape.args)
        if (arg) roots.push_back(arg);
    const bool own = shape.kind == ShapeKind::Leaf;
    const std::string what = own ? "field" : "`" + operation_name(scene, dearest) + "`";
    const auto loop = dearest_loop(scene, roots);
    const bool alone = double(most) >= total / 2;
    std::string message = "the proof of this scene takes more work than is allowed";
    if (!alone)
        message += fmt::format(": of its shapes this {} takes most", what);
    else
        message += fmt::format(": most of it goes into this {}", loop ? "loop" : what);
    Diagnostic &d =
        diagnostics.add(Code::ProofLimit, alone && loop ? loop->at : shape.origin, message);
    if (alone && loop && d.primary.span != shape.origin) d.label(shape.origin, "of this " + what);
    d.note(fmt::format("{} of {} steps went into this {}", most, options.work - work.left, what));
    const double operations = ir::operations(graph, roots);
    LoopsHeld held{graph};
    held.look(roots, true);
    if (loop)
        d.note(fmt::format("a point takes {:.0f} operations, {:.0f} of them in this loop, whose "
                           "body runs {:.0f} times",
                           operations, loop->operations, loop->turns));
    else if (!roots.empty())
        d.note(fmt::format("a point takes {:.0f} operations, with {} steps and choices", operations,
                           held.choices));
    const std::string way_out = !alone ? "leave out shapes, or make equal ones by `repeat`"
                                : loop ? "let it run fewer times"
                                : own  ? "write it with fewer operations and choices"
                                       : "choose a smaller region by `within`";
    d.note(options.limit_note)
        .help(way_out + (own && alone ? std::string(", or ") + state_a_bound : "") + "; " +
              options.limit_help);
}

} // namespace fathom::proof
