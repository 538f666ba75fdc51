// Records of words, each defined before it is used: nodes, and the tables, functions, loops and
// cached fields that nodes name.
#include "ir/passes/content.h"

#include <algorithm>
#include <bit>

namespace fathom::ir {
namespace {

// The low byte of a record's first word; of a node its op and type stand above it.
enum class Record : std::uint8_t { Node, Constant, Table, Function, Loop, Cache };

// What an op's payload is the place of; of Nothing it is a number that says all itself.
enum class Names : std::uint8_t {
    Nothing,
    Param,
    Var,
    Image,
    Grid,
    Function,
    Loop,
    Cache,
    Table,
};
constexpr OpTable<Names> names_of_op{
    {Op::Param, Names::Param},  {Op::Var, Names::Var},         {Op::Image, Names::Image},
    {Op::Grid, Names::Grid},    {Op::Call, Names::Function},   {Op::Loop, Names::Loop},
    {Op::Cached, Names::Cache}, {Op::TableRead, Names::Table},
};

constexpr std::uint32_t no_node = NodeId::none;

std::uint32_t head(Record record, Op op = Op::Const, Type type = Type::Float) {
    return static_cast<std::uint32_t>(record) | static_cast<std::uint32_t>(op) << 8 |
           static_cast<std::uint32_t>(type) << 16;
}

struct Writer {
    const Graph &graph;
    Content out;
    std::unordered_map<NodeId, std::uint32_t> nodes;
    // By index in the graph: their numbers.
    using Numbers = std::unordered_map<std::uint32_t, std::uint32_t>;
    Numbers params, images, grids, caches, tables, functions, loops;

    void add(std::uint32_t word) { out.words.push_back(word); }
    void add(double number) {
        const auto bits = std::bit_cast<std::uint64_t>(number);
        add(static_cast<std::uint32_t>(bits));
        add(static_cast<std::uint32_t>(bits >> 32));
    }
    void add(NodeId id) { add(id ? nodes.at(id) : no_node); }
    void add(std::span<const NodeId> ids) {
        add(static_cast<std::uint32_t>(ids.size()));
        for (NodeId id : ids) add(id);
    }

    static std::uint32_t number(Numbers &numbers, std::vector<std::uint32_t> &names,
                                std::uint32_t name) {
        const auto [known, is_new] =
            numbers.emplace(name, static_cast<std::uint32_t>(names.size()));
        if (is_new) names.push_back(name);
        return known->second;
    }
    // Of what gets a record of its own: `write` where it is new.
    template <class Write>
    static std::uint32_t defined(Numbers &numbers, std::uint32_t name, Write write) {
        if (const auto known = numbers.find(name); known != numbers.end()) return known->second;
        write();
        const auto next = static_cast<std::uint32_t>(numbers.size());
        return numbers.emplace(name, next).first->second;
    }

    std::uint32_t table(TableId id) {
        return defined(tables, id.index, [&] {
            const Table &table = graph.table(id);
            add(head(Record::Table));
            add(static_cast<std::uint32_t>(table.rows));
            add(static_cast<std::uint32_t>(table.stride));
            for (float x : table.data) add(std::bit_cast<std::uint32_t>(x));
        });
    }
    std::uint32_t function(FunctionId id) {
        return defined(functions, id.index, [&] {
            const Function &function = graph.function(id);
            add(head(Record::Function));
            add(function.params);
            add(function.result);
        });
    }
    std::uint32_t loop(LoopId id) {
        return defined(loops, id.index, [&] {
            const Loop &loop = graph.loop(id);
            add(head(Record::Loop));
            add(static_cast<std::uint32_t>(loop.max_count));
            add(loop.count);
            add(loop.index);
            add(loop.condition);
            add(loop.vars);
            add(loop.next);
        });
    }
    std::uint32_t cache(CacheId id) {
        const std::uint32_t field = function(graph.cache(id).field);
        return defined(caches, id.index, [&] {
            out.caches.push_back(id.index);
            add(head(Record::Cache));
            add(field);
            add(graph.cache(id).cell);
        });
    }

    // What has to stand before a node.
    std::vector<NodeId> below(NodeId id) const {
        const Node &node = graph[id];
        std::vector<NodeId> out(graph.args(id).begin(), graph.args(id).end());
        const auto add_function = [&](FunctionId which) {
            if (functions.contains(which.index)) return;
            const Function &function = graph.function(which);
            out.insert(out.end(), function.params.begin(), function.params.end());
            out.push_back(function.result);
        };
        if (node.op == Op::Call) add_function(FunctionId{std::size_t{node.payload}});
        if (node.op == Op::Cached)
            add_function(graph.cache(CacheId{std::size_t{node.payload}}).field);
        if (node.op == Op::Loop) {
            const Loop &loop = graph.loop(LoopId{std::size_t{node.payload}});
            out.push_back(loop.count);
            out.push_back(loop.index);
            out.insert(out.end(), loop.vars.begin(), loop.vars.end());
            if (loop.condition) out.push_back(loop.condition);
            out.insert(out.end(), loop.next.begin(), loop.next.end());
        }
        return out;
    }

    std::uint32_t payload_of(NodeId id) {
        const Node &node = graph[id];
        switch (names_of_op[node.op]) {
        case Names::Nothing: return node.payload;
        case Names::Param: return number(params, out.params, node.payload);
        case Names::Image: return number(images, out.images, node.payload);
        case Names::Grid: return number(grids, out.grids, node.payload);
        case Names::Var: // one node a variable
            out.vars.push_back(node.payload);
            return static_cast<std::uint32_t>(out.vars.size() - 1);
        case Names::Cache: return cache(CacheId{std::size_t{node.payload}});
        case Names::Function: return function(FunctionId{std::size_t{node.payload}});
        case Names::Loop: return loop(LoopId{std::size_t{node.payload}});
        case Names::Table:
            return table_slot(TableId{std::size_t{table(table_of(node.payload))}},
                              column_of(node.payload));
        }
        return node.payload;
    }

    void node(NodeId id) {
        const Node &node = graph[id];
        if (node.op == Op::Const) {
            const Constant &constant = graph.constant_of(id);
            add(head(Record::Constant, Op::Const, constant.type));
            for (int i = 0; i < components(constant.type); ++i)
                add(constant.value[static_cast<std::size_t>(i)]);
        } else {
            const std::uint32_t payload = payload_of(id); // which may write records
            add(head(Record::Node, node.op, node.type));
            add(payload);
            add(graph.args(id));
        }
        nodes.emplace(id, static_cast<std::uint32_t>(nodes.size()));
    }

    void write(NodeId root) {
        std::vector<std::pair<NodeId, bool>> todo{{root, false}}; // second: what is below stands
        while (!todo.empty()) {
            const auto [id, ready] = todo.back();
            todo.pop_back();
            if (nodes.contains(id)) continue;
            if (ready) {
                node(id);
                continue;
            }
            todo.emplace_back(id, true);
            const std::vector<NodeId> first = below(id);
            for (auto it = first.rbegin(); it != first.rend(); ++it)
                if (!nodes.contains(*it)) todo.emplace_back(*it, false);
        }
    }
};

struct Reader {
    Graph &graph;
    std::span<const std::uint32_t> words;
    std::vector<NodeId> nodes{};
    std::vector<TableId> tables{}; // equal ones are one
    std::size_t at = 0;

    std::uint32_t word() { return words[at++]; }
    double number() {
        const std::uint64_t low = word(), high = word();
        return std::bit_cast<double>(low | high << 32);
    }
    NodeId id() {
        const std::uint32_t i = word();
        return i == no_node ? NodeId() : nodes[i];
    }
    std::vector<NodeId> ids() {
        std::vector<NodeId> out(word());
        for (NodeId &one : out) one = id();
        return out;
    }

    void record() {
        const std::uint32_t first = word();
        const auto op = static_cast<Op>(first >> 8 & 0xff);
        const auto type = static_cast<Type>(first >> 16 & 0xff);
        switch (static_cast<Record>(first & 0xff)) {
        case Record::Node: {
            std::uint32_t payload = word();
            if (op == Op::TableRead)
                payload = table_slot(tables[table_of(payload).index], column_of(payload));
            const std::vector<NodeId> args = ids();
            nodes.push_back(op == Op::Var ? graph.fresh_var(type)
                                          : graph.make_as_is(op, type, args, payload));
            break;
        }
        case Record::Constant: {
            Constant constant{type, {}};
            for (int i = 0; i < components(type); ++i)
                constant.value[static_cast<std::size_t>(i)] = number();
            nodes.push_back(graph.constant(constant));
            break;
        }
        case Record::Table: {
            Table table;
            table.rows = static_cast<int>(word());
            table.stride = static_cast<int>(word());
            table.data.resize(static_cast<std::size_t>(table.rows * table.stride));
            for (float &x : table.data) x = std::bit_cast<float>(word());
            tables.push_back(graph.add_table(std::move(table)));
            break;
        }
        case Record::Function: {
            Function function;
            function.params = ids();
            function.result = id();
            graph.add_function(std::move(function));
            break;
        }
        case Record::Loop: {
            Loop loop;
            loop.max_count = static_cast<int>(word());
            loop.count = id();
            loop.index = id();
            loop.condition = id();
            loop.vars = ids();
            loop.next = ids();
            graph.add_loop(std::move(loop));
            break;
        }
        case Record::Cache: {
            const FunctionId field{std::size_t{word()}};
            graph.add_cache({field, number()});
            break;
        }
        }
    }
};

} // namespace

Content content_of(const Graph &graph, NodeId root) {
    Writer writer{graph, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    writer.write(root);
    return std::move(writer.out);
}

NodeId rebuilt(Graph &graph, std::span<const std::uint32_t> words) {
    Reader reader{graph, words};
    while (reader.at < words.size()) reader.record();
    return reader.nodes.back();
}

} // namespace fathom::ir
