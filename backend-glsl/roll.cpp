#include "backend-glsl/roll.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

namespace fathom::glsl {

using ir::Constant;
using ir::Graph;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

constexpr std::uint32_t least_operands = 32;
constexpr std::size_t largest_operand = 2000; // nodes of its tree
constexpr std::size_t most_kinds = 64;
constexpr std::size_t least_gain = 4; // so many times shorter, or it stays as it is
// Where kinds are mixed, a machine that takes both ways of a branch (llvmpipe) computes all kinds
// in every turn: only what else would hardly compile is worth that. Nodes of all operands.
constexpr std::size_t least_mixed = 6000;
constexpr int most_columns = 4000;
constexpr double whole_floats = 16777216; // ints up to here are floats too

// An operand's tree with its constants taken out, in the order of a walk; and these.
struct Walk {
    const Graph &graph;
    std::vector<std::uint64_t> skeleton;
    std::vector<Constant> row;
    bool fits = true;

    void node(NodeId id) {
        if (skeleton.size() > largest_operand) fits = false;
        if (!fits) return;
        const ir::Node &n = graph[id];
        skeleton.push_back(
            static_cast<std::uint64_t>(n.op) << 56 | static_cast<std::uint64_t>(n.type) << 48 |
            static_cast<std::uint64_t>(n.count) << 32 | (n.op == Op::Const ? 0 : n.payload));
        if (n.op == Op::Const) {
            const Constant &constant = graph.constant_of(id);
            for (int i = 0; i < ir::components(constant.type) && constant.type == Type::Int; ++i)
                fits &= std::fabs(constant.value[static_cast<std::size_t>(i)]) <= whole_floats;
            return row.push_back(constant);
        }
        for (NodeId arg : graph.args(id)) node(arg);
    }
};

// The expression without calls. Functions that the lowering made of shapes used twice hold each
// shape's own numbers, which would tell alike shapes apart. (Bodies of loops stay as they are.)
NodeId without_calls(Graph &graph, NodeId id, std::map<NodeId, NodeId> &done, std::size_t &left) {
    if (const auto it = done.find(id); it != done.end()) return it->second;
    if (left == 0) return id;
    --left;
    const ir::Node node = graph[id];
    std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
    for (NodeId &arg : args) arg = without_calls(graph, arg, done, left);
    NodeId result;
    if (node.op == Op::Call) {
        const ir::Function callee = graph.function(ir::FunctionId{node.payload});
        ir::Substitution given;
        for (std::size_t i = 0; i < args.size(); ++i) given[callee.params[i]] = args[i];
        result = without_calls(graph, ir::substitute(graph, callee.result, given), done, left);
    } else {
        result = node.count == 0 ? id : graph.make(node.op, node.type, args, node.payload);
    }
    return done[id] = result;
}

// Operands that differ in constants only: which, and where each constant stands that differs.
struct Kind {
    std::vector<std::size_t> members;
    std::vector<std::vector<Constant>> rows; // by member
    std::vector<int> column;                 // by constant: in the table; -1: the same in all
    std::size_t size = 0;
};

bool same(const Constant &a, const Constant &b) { return a.type == b.type && a.value == b.value; }

// Tables hold ints and bools as floats.
NodeId read_of(Graph &graph, Type type, NodeId row, std::uint32_t slot) {
    const bool whole = type == Type::Int || type == Type::Bool;
    const NodeId read = graph.make(Op::TableRead, whole ? Type::Float : type, {row}, slot);
    if (type == Type::Int) return graph.make(Op::ToInt, Type::Int, {read});
    if (type == Type::Bool) return graph.make(Op::NotEqual, {read, graph.number(0)});
    return read;
}

// The tree again, its constants in the same order replaced where a column is given for them.
struct Rebuild {
    Graph &graph;
    const Kind &kind;
    ir::TableId table;
    NodeId row;
    std::size_t next = 0;

    NodeId node(NodeId id) {
        const ir::Node n = graph[id];
        if (n.op == Op::Const) {
            const int column = kind.column[next++];
            return column < 0 ? id : read_of(graph, n.type, row, ir::table_slot(table, column));
        }
        std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        for (NodeId &arg : args) arg = node(arg);
        return graph.make(n.op, n.type, args, n.payload);
    }
};

// Gives each kind's differing constants columns from `first` on; what is equal in every row stands
// once. The number of columns.
int lay_out(std::vector<Kind> &kinds, int first) {
    int columns = first;
    for (Kind &kind : kinds) {
        int next = first;
        const auto equal = [&](std::size_t a, std::size_t b) {
            return std::ranges::all_of(kind.rows,
                                       [&](const auto &row) { return same(row[a], row[b]); });
        };
        kind.column.assign(kind.rows[0].size(), -1);
        for (std::size_t c = 0; c < kind.column.size(); ++c) {
            if (std::ranges::all_of(kind.rows,
                                    [&](const auto &row) { return same(row[c], kind.rows[0][c]); }))
                continue;
            std::size_t twin = 0;
            while (twin < c && (kind.column[twin] < 0 || !equal(twin, c))) ++twin;
            kind.column[c] = twin < c ? kind.column[twin] : next;
            if (twin == c) next += ir::components(kind.rows[0][c].type);
        }
        columns = std::max(columns, next);
    }
    return columns;
}

// The combination as a loop in the order of its operands: it begins with the first, and turn i adds
// operand i + 1, of whichever kind it is.
std::optional<NodeId> loop_of(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    const std::size_t numbers = node.op == Op::Blend ? 2 : 0;
    std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
    const std::size_t first = numbers + 1; // of those in the table
    std::map<std::vector<std::uint64_t>, std::size_t> kind_of;
    std::vector<Kind> kinds;
    std::size_t all = 0, few = 0;
    for (std::size_t i = first; i < args.size(); ++i) {
        std::map<NodeId, NodeId> done;
        std::size_t left = largest_operand;
        args[i] = without_calls(graph, args[i], done, left);
        Walk walk{graph, {}, {}};
        walk.node(args[i]);
        if (!walk.fits || left == 0) return std::nullopt;
        const auto [it, fresh] = kind_of.try_emplace(walk.skeleton, kinds.size());
        all += walk.skeleton.size();
        if (fresh) {
            kinds.push_back({{}, {}, {}, walk.skeleton.size()});
            few += walk.skeleton.size();
        }
        kinds[it->second].members.push_back(i - first);
        kinds[it->second].rows.push_back(std::move(walk.row));
    }
    const bool mixed = kinds.size() > 1;
    if (kinds.size() > most_kinds || few * least_gain > all || (mixed && all < least_mixed))
        return std::nullopt;
    ir::Table table;
    table.rows = static_cast<int>(args.size() - first);
    table.stride = lay_out(kinds, mixed ? 1 : 0);
    if (table.stride == 0 || table.stride > most_columns) return std::nullopt;
    table.data.assign(static_cast<std::size_t>(table.rows) * static_cast<std::size_t>(table.stride),
                      0.0f);
    for (std::size_t k = 0; k < kinds.size(); ++k)
        for (std::size_t m = 0; m < kinds[k].members.size(); ++m) {
            float *row =
                table.data.data() + kinds[k].members[m] * static_cast<std::size_t>(table.stride);
            if (mixed) row[0] = static_cast<float>(k);
            for (std::size_t c = 0; c < kinds[k].column.size(); ++c) {
                if (kinds[k].column[c] < 0) continue;
                const Constant &constant = kinds[k].rows[m][c];
                for (int i = 0; i < ir::components(constant.type); ++i)
                    row[kinds[k].column[c] + i] =
                        static_cast<float>(constant.value[static_cast<std::size_t>(i)]);
            }
        }
    ir::Fold fold;
    fold.count = graph.integer(table.rows);
    fold.max_count = table.rows;
    fold.index = graph.fresh_var(Type::Int);
    fold.vars = {graph.fresh_var(node.type)};
    const ir::TableId data = graph.add_table(std::move(table));
    const auto value_of = [&](std::size_t k) {
        return Rebuild{graph, kinds[k], data, fold.index}.node(args[first + kinds[k].members[0]]);
    };
    NodeId value = value_of(kinds.size() - 1);
    const NodeId which =
        mixed ? read_of(graph, Type::Int, fold.index, ir::table_slot(data, 0)) : NodeId{};
    for (std::size_t k = kinds.size() - 1; k-- > 0;)
        value = graph.make(Op::Select, {graph.make(Op::Equal, {which, graph.integer(int(k))}),
                                        value_of(k), value});
    std::vector<NodeId> joined(args.begin(), args.begin() + static_cast<std::ptrdiff_t>(numbers));
    joined.push_back(fold.vars[0]);
    joined.push_back(value);
    fold.next = {graph.make(node.op, node.type, joined, node.payload)};
    const NodeId start = args[numbers];
    return graph.make(Op::Fold, node.type, {start}, graph.add_fold(std::move(fold)).index);
}

bool is_list(const ir::Node &node) {
    return (node.op == Op::Blend || node.op == Op::Union || node.op == Op::Intersection ||
            node.op == Op::NearestHit) &&
           node.count >= least_operands;
}

// A long list below `root`, innermost first, that was not looked at yet.
NodeId next_list(const Graph &graph, NodeId root, std::unordered_set<NodeId> &tried) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    NodeId found;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        if (is_list(graph[id]) && !tried.contains(id) && (!found || id < found)) found = id;
        for (NodeId arg : graph.args(id)) todo.push_back(arg);
        if (graph[id].op != Op::Fold) continue;
        const ir::Fold &fold = graph.fold(ir::FoldId{graph[id].payload});
        todo.insert(todo.end(), fold.next.begin(), fold.next.end());
    }
    tried.insert(found);
    return found;
}

} // namespace

std::optional<Rolled> rolled(const ir::Scene &scene) {
    std::optional<Rolled> result;
    for (std::size_t i = 0; i < scene.graph.function_count(); ++i) {
        std::unordered_set<NodeId> tried;
        NodeId root = scene.graph.function(ir::FunctionId{i}).result;
        while (true) {
            const Graph &graph = result ? result->scene.graph : scene.graph;
            const NodeId list = next_list(graph, root, tried);
            if (!list) break;
            if (!result) result = Rolled{scene, {}};
            const std::optional<NodeId> loop = loop_of(result->scene.graph, list);
            if (!loop) continue;
            root = ir::substitute(result->scene.graph, root, {{list, *loop}});
            result->results[static_cast<std::uint32_t>(i)] = root;
        }
    }
    return result;
}

NodeId without_calls(Graph &graph, NodeId id) {
    std::map<NodeId, NodeId> done;
    std::size_t left = largest_operand;
    return without_calls(graph, id, done, left);
}

} // namespace fathom::glsl
