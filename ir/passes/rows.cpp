#include "ir/passes/rows.h"

#include <algorithm>

namespace fathom::ir {

bool take_apart(const Graph &graph, NodeId id, std::size_t maximum, Skeleton &out) {
    if (!id) {
        out.words.push_back(~0ull);
        return true;
    }
    if (out.words.size() > maximum) return false;
    const Node &node = graph[id];
    out.words.push_back(
        static_cast<std::uint64_t>(node.op) << 56 | static_cast<std::uint64_t>(node.type) << 48 |
        static_cast<std::uint64_t>(node.count) << 32 | (node.op == Op::Const ? 0 : node.payload));
    if (node.op == Op::Const) {
        out.row.push_back(id);
        return true;
    }
    return std::ranges::all_of(graph.args(id),
                               [&](NodeId arg) { return take_apart(graph, arg, maximum, out); });
}

NodeId put_together(Graph &graph, NodeId id, const OtherConstant &other, std::size_t &next) {
    if (!id) return id;
    const Node node = graph[id];
    if (node.op == Op::Const) return other(next++, id);
    std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
    for (NodeId &arg : args) arg = put_together(graph, arg, other, next);
    return graph.make(node.op, node.type, args, node.payload);
}

int lay_out(const Graph &graph, const std::vector<Row> &rows, const std::vector<bool> &wanted,
            int first, std::vector<int> &column) {
    const auto equal = [&](std::size_t a, std::size_t b) {
        return std::ranges::all_of(rows, [&](const Row &row) { return row[a] == row[b]; });
    };
    column.assign(rows[0].size(), -1);
    for (std::size_t c = 0; c < column.size(); ++c) {
        const bool differs =
            !std::ranges::all_of(rows, [&](const Row &row) { return row[c] == rows[0][c]; });
        if (!wanted[c] || !differs) continue;
        std::size_t twin = 0;
        while (twin < c && (column[twin] < 0 || !equal(twin, c))) ++twin;
        column[c] = twin < c ? column[twin] : first;
        if (twin == c) first += components(graph.type(rows[0][c]));
    }
    return first;
}

void fill_row(const Graph &graph, const Row &row, const std::vector<int> &column, float *out) {
    for (std::size_t c = 0; c < row.size(); ++c) {
        if (column[c] < 0) continue;
        const Constant constant = graph.constant_of(row[c]);
        for (int i = 0; i < components(constant.type); ++i)
            out[column[c] + i] = static_cast<float>(constant.value[static_cast<std::size_t>(i)]);
    }
}

NodeId read_table(Graph &graph, Type type, NodeId row, std::uint32_t slot) {
    const bool whole = type == Type::Int || type == Type::Bool;
    const NodeId read = graph.make(Op::TableRead, whole ? Type::Float : type, {row}, slot);
    if (type == Type::Int) return graph.make(Op::ToInt, Type::Int, {read});
    if (type == Type::Bool) return graph.make(Op::NotEqual, {read, graph.number(0)});
    return read;
}

} // namespace fathom::ir
