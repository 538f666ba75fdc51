#include "backend-glsl/schedule.h"

#include <algorithm>
#include <functional>
#include <map>
#include <unordered_set>

namespace fathom::glsl {

using ir::NodeId;
using ir::Op;

namespace {

constexpr int long_text = 90; // an expression that would print longer than this gets a name
constexpr int cheap_arm = 6;  // what an arm may cost and still be computed before the choice

// How often the text of an argument appears in its user's. Of matrices, what is no operator is
// written column by column.
int copies(const ir::Graph &graph, NodeId user) {
    constexpr ir::OpSet operators{Op::Neg, Op::Add, Op::Sub, Op::Mul, Op::Div};
    const ir::Node &node = graph[user];
    if (node.op == Op::TableRead) return 2; // may lie in two texels
    const bool by_column = ir::is_matrix(node.type) && !operators[node.op] &&
                           (ir::info(node.op).takes != ir::Takes::Own || node.op == Op::Splat);
    return by_column ? ir::side(node.type) : 1;
}

class Scheduler {
  public:
    Scheduler(const ir::Graph &graph, std::span<const NodeId> roots)
        : graph_(graph), roots_(roots) {}

    Schedule run() {
        collect();
        // Arms that turn out cheap are computed with their surroundings; that may make others
        // cheap, once.
        for (int pass = 0; pass < 3; ++pass) {
            place();
            name();
            if (!dissolve()) break;
        }
        order();
        return std::move(result_);
    }

  private:
    // The nodes that the roots need, ascending, and the loop variables that each reads from outside
    // itself.
    void collect() {
        std::vector<NodeId> todo(roots_.begin(), roots_.end());
        std::unordered_set<NodeId> seen;
        while (!todo.empty()) {
            NodeId id = todo.back();
            todo.pop_back();
            if (!id || !seen.insert(id).second) continue;
            nodes_.push_back(id);
            for (NodeId arg : graph_.args(id)) todo.push_back(arg);
            if (graph_[id].op == Op::Loop) {
                const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[id].payload});
                todo.push_back(loop.count);
                todo.push_back(loop.condition);
                todo.insert(todo.end(), loop.next.begin(), loop.next.end());
            }
        }
        std::ranges::sort(nodes_);
        for (NodeId id : nodes_) {
            std::vector<NodeId> &free = free_[id];
            if (graph_[id].op == Op::Var) free.push_back(id);
            auto join = [&](NodeId from) {
                if (!from) return;
                std::vector<NodeId> merged;
                std::ranges::set_union(free, free_[from], std::back_inserter(merged));
                free = std::move(merged);
            };
            if (graph_[id].op == Op::Loop) {
                const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[id].payload});
                for (NodeId next : loop.next) join(next);
                join(loop.condition);
                std::erase_if(free, [&](NodeId var) { return binds(loop, var); });
                join(loop.count);
            }
            for (NodeId arg : graph_.args(id)) join(arg);
        }
    }

    static bool binds(const ir::Loop &loop, NodeId var) {
        return var == loop.index || std::ranges::find(loop.vars, var) != loop.vars.end();
    }

    BlockId open(BlockId parent, NodeId owner, bool loop) {
        BlockId id = static_cast<BlockId>(result_.blocks.size());
        result_.blocks.push_back(
            {parent, result_.blocks[static_cast<std::size_t>(parent)].depth + 1, owner, loop, {}});
        return id;
    }

    Block &block(BlockId id) { return result_.blocks[static_cast<std::size_t>(id)]; }

    BlockId common(BlockId a, BlockId b) {
        while (a != b) {
            if (block(a).depth < block(b).depth) std::swap(a, b);
            a = block(a).parent;
        }
        return a;
    }

    void use(NodeId id, BlockId at, int times) {
        if (!id) return;
        auto [entry, fresh] = result_.home.try_emplace(id, at);
        if (!fresh) entry->second = common(entry->second, at);
        uses_[id] += times;
    }

    // Users come before what they use, so that all uses of a node are known when it is its turn.
    void place() {
        result_ = {};
        result_.blocks.push_back({});
        uses_.clear();
        hoisted_.clear();
        for (NodeId root : roots_) use(root, 0, 1);
        for (auto it = nodes_.rbegin(); it != nodes_.rend(); ++it) {
            NodeId id = *it;
            const ir::Node &node = graph_[id];
            BlockId used_at = result_.home.at(id);
            BlockId home = used_at;
            if (!is_trivial(graph_, id)) home = result_.home[id] = outside_loops(id, used_at);
            if (home != used_at) hoisted_.insert(id);
            int times = is_trivial(graph_, id) ? uses_[id] : 1;
            if (node.op == Op::Select && !flat_.contains(id)) {
                BlockId yes = open(home, id, false), no = open(home, id, false);
                result_.arms[id] = {yes, no};
                use(graph_.arg(id, 0), home, 1);
                use(graph_.arg(id, 1), yes, 1);
                use(graph_.arg(id, 2), no, 1);
                continue;
            }
            if (node.op == Op::Loop) {
                const ir::Loop &loop = graph_.loop(ir::LoopId{node.payload});
                BlockId body = open(home, id, true);
                result_.loop[id] = body;
                result_.rows[loop.index] = loop.max_count;
                use(loop.count, home, 1);
                use(loop.condition, body, 1);
                for (NodeId next : loop.next) use(next, body, 1);
            }
            for (std::size_t i = 0; i < node.count; ++i)
                use(graph_.args(id)[i], home, times * copies(graph_, id));
        }
    }

    BlockId outside_loops(NodeId id, BlockId at) {
        BlockId best = at;
        for (BlockId b = at; b != 0; b = block(b).parent) {
            if (!block(b).loop) continue;
            const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[block(b).owner].payload});
            if (std::ranges::any_of(free_[id], [&](NodeId var) { return binds(loop, var); })) break;
            best = block(b).parent;
        }
        return best;
    }

    // Decides, arguments first, what gets a name.
    void name() {
        std::unordered_map<NodeId, int> length;
        for (NodeId id : nodes_) {
            const ir::Node &node = graph_[id];
            if (node.op == Op::Var || node.op == Op::Loop) {
                if (node.op == Op::Loop) set_named(id);
                length[id] = 4;
                continue;
            }
            int text = 6;
            for (std::size_t i = 0; i < node.count; ++i) text += length[graph_.args(id)[i]];
            bool many =
                (node.op == Op::Union || node.op == Op::Intersection || node.op == Op::NearestHit ||
                 node.op == Op::FarthestHit || node.op == Op::Blend) &&
                node.count > (node.op == Op::Blend ? 4u : 2u);
            const bool branches = result_.arms.contains(id);
            bool part = node.count == 1; // chains of these must end, too
            bool named = !is_trivial(graph_, id) && (uses_[id] > 1 || hoisted_.contains(id));
            named |= text > long_text && (part || !is_trivial(graph_, id)) &&
                     !(uses_[id] == 1 && is_root(id));
            if (node.op == Op::Const) text = 6 * ir::components(node.type);
            if (named || many || branches) {
                set_named(id);
                text = 4;
            }
            length[id] = text;
        }
    }

    // What a function hands back needs no name only for being long.
    bool is_root(NodeId id) const { return roots_.size() == 1 && roots_[0] == id; }

    void set_named(NodeId id) { result_.named_.insert(id); }

    // Marks the choices whose arms are cheap enough to be computed beforehand: they are expressions,
    // all others statements. Says whether there are any.
    bool dissolve() {
        std::unordered_map<BlockId, int> cost;
        for (NodeId id : nodes_)
            for (BlockId b = result_.home[id]; b != 0; b = block(b).parent)
                cost[b] += ir::info(graph_[id].op).weight;
        bool any = false;
        for (const auto &[id, arms] : result_.arms) {
            auto [yes, no] = arms;
            if (cost[yes] + cost[no] <= cheap_arm) any |= flat_.insert(id).second;
        }
        return any;
    }

    void order() {
        for (NodeId id : nodes_)
            if (result_.named(id)) block(result_.home[id]).statements.push_back(id);
    }

    const ir::Graph &graph_;
    std::span<const NodeId> roots_;
    std::vector<NodeId> nodes_;
    std::unordered_map<NodeId, std::vector<NodeId>> free_;
    std::unordered_map<NodeId, int> uses_;
    std::unordered_set<NodeId> hoisted_, flat_;
    Schedule result_;
};

} // namespace

bool is_trivial(const ir::Graph &graph, NodeId id) {
    const Op op = graph[id].op;
    return op == Op::Const || op == Op::Point || op == Op::Normal || op == Op::Direction ||
           op == Op::Time || op == Op::Param || op == Op::Var || op == Op::LoopResult ||
           // parts: what they are taken from is counted once for each place where they are written
           op == Op::Swizzle || op == Op::Column || op == Op::HitDistance || op == Op::HitPaint ||
           op == Op::HitPoint || op == Op::HitExtra;
}

Schedule schedule(const ir::Graph &graph, std::span<const NodeId> roots) {
    return Scheduler(graph, roots).run();
}

} // namespace fathom::glsl
