#include "backend-glsl/reroll.h"

#include "ir/passes/inline.h"
#include "ir/passes/rows.h"

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

constexpr std::uint32_t min_operands = 32;
constexpr std::size_t largest_operand = 2000; // nodes of its tree
constexpr std::size_t max_kinds = 64;
constexpr std::size_t min_gain = 4; // so many times shorter, or it stays as it is
// Where kinds are mixed, a machine that takes both ways of a branch (llvmpipe) computes all kinds
// in every turn: only what else would hardly compile is worth that. Nodes of all operands.
constexpr std::size_t min_mixed = 6000;
constexpr double whole_floats = 16777216; // ints up to here are floats too

// Operands that differ in constants only: which, and where each constant stands that differs.
struct Kind {
    std::vector<std::size_t> members;
    std::vector<ir::Row> rows; // by member
    std::vector<int> column;   // by constant: in the table; -1: the same in all
    std::size_t size = 0;
};

// Gives each kind's differing constants columns from `first` on. The number of columns.
int lay_out(const Graph &graph, std::vector<Kind> &kinds, int first) {
    int columns = first;
    for (Kind &kind : kinds) {
        const std::vector<bool> all(kind.rows[0].size(), true);
        columns = std::max(columns, ir::lay_out(graph, kind.rows, all, first, kind.column));
    }
    return columns;
}

// Whether tables hold the constants: ints as floats.
bool fits(const Graph &graph, const ir::Row &row) {
    return std::ranges::all_of(row, [&](NodeId id) {
        const Constant constant = graph.constant_of(id);
        return constant.type != Type::Int || std::fabs(constant.value[0]) <= whole_floats;
    });
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
        // Functions that the lowering made of shapes used twice hold each shape's own numbers,
        // which would tell alike shapes apart.
        const ir::WithoutCalls operand = ir::without_calls(graph, args[i], largest_operand);
        args[i] = operand.root;
        ir::Skeleton skeleton;
        if (!operand.all || !ir::take_apart(graph, args[i], largest_operand, skeleton) ||
            !fits(graph, skeleton.row))
            return std::nullopt;
        const std::size_t size = skeleton.words.size();
        const auto [it, fresh] = kind_of.try_emplace(std::move(skeleton.words), kinds.size());
        all += size;
        if (fresh) {
            kinds.push_back({{}, {}, {}, size});
            few += size;
        }
        kinds[it->second].members.push_back(i - first);
        kinds[it->second].rows.push_back(std::move(skeleton.row));
    }
    const bool mixed = kinds.size() > 1;
    if (kinds.size() > max_kinds || few * min_gain > all || (mixed && all < min_mixed))
        return std::nullopt;
    ir::Table table;
    table.rows = static_cast<int>(args.size() - first);
    table.stride = lay_out(graph, kinds, mixed ? 1 : 0);
    if (table.stride == 0 || table.stride > ir::max_columns) return std::nullopt;
    table.data.assign(static_cast<std::size_t>(table.rows) * static_cast<std::size_t>(table.stride),
                      0.0f);
    for (std::size_t k = 0; k < kinds.size(); ++k)
        for (std::size_t m = 0; m < kinds[k].members.size(); ++m) {
            float *row =
                table.data.data() + kinds[k].members[m] * static_cast<std::size_t>(table.stride);
            if (mixed) row[0] = static_cast<float>(k);
            ir::fill_row(graph, kinds[k].rows[m], kinds[k].column, row);
        }
    ir::Loop loop;
    loop.count = graph.integer(table.rows);
    loop.max_count = table.rows;
    loop.index = graph.fresh_var(Type::Int);
    loop.vars = {graph.fresh_var(node.type)};
    const ir::TableId data = graph.add_table(std::move(table));
    const auto value_of = [&](std::size_t k) {
        const std::vector<int> &column = kinds[k].column;
        const auto read = [&](std::size_t c, NodeId constant) {
            return column[c] < 0 ? constant
                                 : ir::read_table(graph, graph.type(constant), loop.index,
                                                  ir::table_slot(data, column[c]));
        };
        std::size_t next = 0;
        return ir::put_together(graph, args[first + kinds[k].members[0]], read, next);
    };
    NodeId value = value_of(kinds.size() - 1);
    const NodeId which =
        mixed ? ir::read_table(graph, Type::Int, loop.index, ir::table_slot(data, 0)) : NodeId{};
    for (std::size_t k = kinds.size() - 1; k-- > 0;)
        value = graph.make(Op::Select, {graph.make(Op::Equal, {which, graph.integer(int(k))}),
                                        value_of(k), value});
    std::vector<NodeId> joined(args.begin(), args.begin() + static_cast<std::ptrdiff_t>(numbers));
    joined.push_back(loop.vars[0]);
    joined.push_back(value);
    loop.next = {graph.make(node.op, node.type, joined, node.payload)};
    const NodeId start = args[numbers];
    return graph.make(Op::Loop, node.type, {start}, graph.add_loop(std::move(loop)).index);
}

bool is_list(const ir::Node &node) {
    return (node.op == Op::Blend || node.op == Op::Union || node.op == Op::Intersection ||
            node.op == Op::NearestHit) &&
           node.count >= min_operands;
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
        if (graph[id].op != Op::Loop) continue;
        const ir::Loop &loop = graph.loop(ir::LoopId{graph[id].payload});
        todo.insert(todo.end(), loop.next.begin(), loop.next.end());
    }
    tried.insert(found);
    return found;
}

} // namespace

std::optional<Rerolled> rerolled(const ir::Scene &scene) {
    std::optional<Rerolled> result;
    for (std::size_t i = 0; i < scene.graph.function_count(); ++i) {
        std::unordered_set<NodeId> tried;
        NodeId root = scene.graph.function(ir::FunctionId{i}).result;
        while (true) {
            const Graph &graph = result ? result->scene.graph : scene.graph;
            const NodeId list = next_list(graph, root, tried);
            if (!list) break;
            if (!result) result = Rerolled{scene, {}};
            const std::optional<NodeId> loop = loop_of(result->scene.graph, list);
            if (!loop) continue;
            root = ir::substitute(result->scene.graph, root, {{list, *loop}});
            result->results[static_cast<std::uint32_t>(i)] = root;
        }
    }
    return result;
}

} // namespace fathom::glsl
