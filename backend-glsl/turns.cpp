#include "backend-glsl/turns.h"

#include "ir/passes/cost.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace fathom::glsl {

using ir::NodeId;
using ir::Op;

namespace {

constexpr int grouped_from = 32; // turns of a loop; drivers may write out what is shorter
// Mesa writes a loop out up to 832 instructions in all: half of an eighth of these, as cost.h has them.
constexpr double most_of_short_body = 1.5;
// Of the helpers that look into the 27 cells around a point.
constexpr double neighbors = 3 * (1 + 3 * (1 + 3));

class Counter {
  public:
    Counter(const Module &module, bool written_out)
        : module_(module), graph_(module.scene.graph), written_out_(written_out) {}

    double of(ir::FunctionId id) {
        if (!id) return 0;
        if (const auto known = functions_.find(id.index); known != functions_.end())
            return known->second;
        functions_[id.index] = 0;
        return functions_[id.index] = below({module_.result_of(id)});
    }

  private:
    // Of what these nodes are made of.
    double below(std::vector<NodeId> todo) {
        std::unordered_set<NodeId> seen;
        double sum = 0;
        while (!todo.empty()) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!id || !seen.insert(id).second) continue;
            const ir::Node &node = graph_[id];
            todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
            if (node.op == Op::Call) sum += of(ir::FunctionId{node.payload});
            if (node.op == Op::Loop) sum += loop(node.payload);
            if (!written_out_ && (node.op == Op::Worley || node.op == Op::SpotNoise))
                sum += neighbors;
        }
        return sum;
    }

    double loop(std::uint32_t index) {
        if (const auto known = loops_.find(index); known != loops_.end()) return known->second;
        loops_[index] = 0;
        const ir::Loop &loop = graph_.loop(ir::LoopId{index});
        std::vector<NodeId> body = loop.next;
        body.push_back(loop.condition);
        const double within = below(body);
        if (written_out_ && !loop.condition && loop.max_count < grouped_from)
            return loops_[index] = loop.max_count * within;
        const int stride = turns_together(graph_, loop);
        if (stride == 1) return loops_[index] = loop.max_count * (1 + within);
        const double groups = std::ceil(loop.max_count / double(stride ? stride : most_together));
        double cost = 0;
        for (NodeId next : loop.next) cost += ir::cost_of(graph_, next);
        const bool short_body = within == 0 && cost <= most_of_short_body;
        return loops_[index] = groups + (short_body ? 0 : loop.max_count * (1 + within));
    }

    const Module &module_;
    const ir::Graph &graph_;
    const bool written_out_;
    std::unordered_map<std::uint32_t, double> functions_, loops_;
};

} // namespace

int turns_together(const ir::Graph &graph, const ir::Loop &loop) {
    const auto count = graph.as_number(loop.count);
    if (!count || loop.condition || *count < grouped_from) return 1;
    int stride = most_together;
    while (static_cast<int>(*count) % stride != 0) --stride;
    return stride < most_together / 2 && loop.vars.size() == 1 ? 0 : stride;
}

Turns turns_of(const Module &module) {
    const ir::Scene &scene = module.scene;
    const auto count = [&](bool written_out) {
        Counter counter(module, written_out);
        return std::max({counter.of(scene.distance), counter.of(scene.safe_radius),
                         counter.of(scene.shaded), counter.of(scene.hit)});
    };
    return {count(false), count(true)};
}

} // namespace fathom::glsl
