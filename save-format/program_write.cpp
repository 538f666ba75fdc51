// The steps of an expression of the IR: calls and caches written out where they stand, loops
// iteration by iteration. The graph does the work: what an iteration or a call leaves constant it
// folds, and what two of them share it finds again.
#include "save-format/program.h"

#include "ir/passes/inline.h"
#include "save-format/yaml_writer.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>
#include <unordered_map>

namespace fathom::save {
namespace {

using ir::NodeId;
using ir::Op;

constexpr int max_steps = 20000;
constexpr double max_iterations = 1024; // of a loop

class StepWriter {
  public:
    StepWriter(ir::Graph &graph, const ir::Substitution &present, FlowWords &words)
        : graph_(graph), present_(present), words_(words),
          max_nodes_(graph.size() + 16 * max_steps) {}

    std::string flow(NodeId root) {
        return step(ir::substitute(graph_, root, present_), 0) < 0 ? std::string()
                                                                   : "[" + text_ + "]";
    }

  private:
    int push(const std::string &text) {
        if (count_ >= max_steps) return -1;
        if (count_ > 0) text_ += ", ";
        text_ += "[" + text + "]";
        return count_++;
    }

    int number(double value) { return push("Const, " + yaml_number(value)); }

    int constant(const ir::Constant &value) {
        if (value.type == ir::Type::Bool)
            return push(value.value[0] != 0 ? "Const, true" : "Const, false");
        const int size = ir::components(value.type);
        if (size == 1) return number(value.value[0]);
        const bool matrix = ir::is_matrix(value.type);
        const int rows = matrix ? ir::side(value.type) : size;
        std::string all = std::string("Make, ") + ir::type_name(value.type);
        for (int first = 0; first < size; first += rows) {
            std::string column = std::string("Make, ") + ir::type_name(ir::vector_type(rows));
            for (int i = first; i < first + rows; ++i) {
                const int part = number(value.value[static_cast<std::size_t>(i)]);
                if (part < 0) return -1;
                column += fmt::format(", {}", part);
            }
            const int made = push(column);
            if (!matrix || made < 0) return made;
            all += fmt::format(", {}", made);
        }
        return push(all);
    }

    int step(NodeId id, int depth) {
        if (const auto found = steps_.find(id); found != steps_.end()) return found->second;
        if (depth > 2000 || graph_.size() > max_nodes_) return -1;
        const int made = make(id, depth);
        if (made >= 0) steps_.emplace(id, made);
        return made;
    }

    // A function's body where it is called.
    int call(ir::FunctionId id, const std::vector<NodeId> &args, int depth) {
        return step(ir::called(graph_, id, args, present_), depth + 1);
    }

    // A cached field is written once, among the file's others. One that reads a copy's number is
    // another field in each copy: there it is no more than what it computes.
    int cached(ir::CacheId id, const std::vector<NodeId> &args, int depth) {
        const ir::Cache cache = graph_.cache(id);
        const ir::Function function = graph_.function(cache.field);
        ir::Substitution inside = present_;
        inside[function.params[0]] = graph_.point();
        const std::string flow = StepWriter(graph_, inside, words_).flow(function.result);
        if (flow.empty()) return -1;
        if (flow.find("[Id, ") != std::string::npos) return call(cache.field, args, depth);
        std::size_t index = 0;
        while (index < words_.caches.size() &&
               (words_.caches[index].flow != flow || words_.caches[index].cell != cache.cell))
            ++index;
        if (index == words_.caches.size()) words_.caches.push_back({flow, cache.cell});
        const int at = step(args[0], depth + 1);
        return at < 0 ? -1 : push(fmt::format("Cached, {}, {}", index, at));
    }

    // What a loop's variables are after its last iteration; none where there are too many. After
    // the first iteration whose condition is false nothing changes any more.
    const std::vector<NodeId> *results(NodeId id) {
        if (const auto found = loops_.find(id); found != loops_.end()) return &found->second;
        const ir::Loop loop = graph_.loop(ir::LoopId{graph_[id].payload});
        const auto known = graph_.as_number(loop.count);
        const double iterations = known.value_or(loop.max_count);
        if (iterations > max_iterations) return nullptr;
        std::vector<NodeId> values(graph_.args(id).begin(), graph_.args(id).end());
        NodeId running = graph_.boolean(true);
        for (int iteration = 0; iteration < static_cast<int>(iterations); ++iteration) {
            if (graph_.size() > max_nodes_) return nullptr;
            if (!known)
                running = graph_.make(
                    Op::And,
                    {running, graph_.make(Op::Less, {graph_.integer(iteration), loop.count})});
            if (loop.condition)
                running = graph_.make(Op::And, {running, ir::in_iteration(graph_, loop, iteration,
                                                                          values, loop.condition)});
            const std::vector<NodeId> next = ir::after_iteration(graph_, loop, iteration, values);
            for (std::size_t k = 0; k < values.size(); ++k)
                values[k] = graph_.make(Op::Select, {running, next[k], values[k]});
        }
        return &loops_.emplace(id, std::move(values)).first->second;
    }

    int result(NodeId loop, std::size_t which, int depth) {
        const std::vector<NodeId> *values = results(loop);
        return values && which < values->size() ? step((*values)[which], depth + 1) : -1;
    }

    int table_read(const ir::Node &node, NodeId place) {
        const auto row = graph_.as_number(place);
        const ir::Table &table = graph_.table(ir::table_of(node.payload));
        if (!row || table.rows == 0) return -1;
        const auto at =
            static_cast<std::size_t>(std::min(std::max(*row, 0.0), double(table.rows - 1)));
        ir::Constant value{node.type, {}};
        for (int i = 0; i < ir::components(node.type); ++i) {
            const std::size_t column = static_cast<std::size_t>(ir::column_of(node.payload) + i);
            value.value[static_cast<std::size_t>(i)] =
                table.data[at * static_cast<std::size_t>(table.stride) + column];
        }
        return constant(value);
    }

    int make(NodeId id, int depth) {
        const ir::Node node = graph_[id];
        const std::vector<NodeId> args(graph_.args(id).begin(), graph_.args(id).end());
        if (node.op == Op::Const) return constant(graph_.constant_of(id));
        if (node.op == Op::Call) return call(ir::FunctionId{node.payload}, args, depth);
        if (node.op == Op::Cached) return cached(ir::CacheId{node.payload}, args, depth);
        if (node.op == Op::Direction) return push("Direction");
        if (node.op == Op::Param)
            return push("Param, " + flow_scalar(words_.params[node.payload], true));
        if (node.op == Op::Var) {
            const auto found = std::ranges::find(words_.ids, id);
            return found == words_.ids.end()
                       ? -1
                       : push(fmt::format("Id, {}", found - words_.ids.begin()));
        }
        if (node.op == Op::Loop) return result(id, 0, depth);
        if (node.op == Op::LoopResult) return result(args[0], node.payload, depth);
        if (node.op == Op::Blend) return step(blend_expression(graph_, id), depth + 1);
        if (node.op == Op::TableRead) return table_read(node, args[0]);
        constexpr ir::OpSet with_word{Op::Splat, Op::Make, Op::Column, Op::Swizzle};
        if (!with_word[node.op] && *ir::info(node.op).text == '\0') return -1;
        // What truncates is not the language's `/`, and what hashes a whole number not what hashes
        // a float: numbers do not say in text which of the two they are.
        const bool whole = node.op == Op::Div && node.type == ir::Type::Int;
        const bool hashed = node.op == Op::Hash && graph_.type(args[0]) == ir::Type::Float;
        std::string text = whole ? "WholeDiv" : ir::info(node.op).name;
        if (node.op == Op::Splat || node.op == Op::Make)
            text += std::string(", ") + ir::type_name(node.type);
        if (node.op == Op::Column) text += fmt::format(", {}", node.payload);
        if (node.op == Op::Swizzle) {
            text += ", ";
            for (int i = 0; i < ir::swizzle_size(node.payload); ++i)
                text += "xyzw"[ir::swizzle_component(node.payload, i)];
        }
        for (const NodeId argument : args) {
            int made = step(argument, depth + 1);
            if (made >= 0 && hashed) made = push(fmt::format("ToFloat, {}", made));
            if (made < 0) return -1;
            text += fmt::format(", {}", made);
        }
        return push(text);
    }

    ir::Graph &graph_;
    const ir::Substitution &present_;
    FlowWords &words_;
    std::size_t max_nodes_;
    std::unordered_map<NodeId, int> steps_;
    std::unordered_map<NodeId, std::vector<NodeId>> loops_;
    std::string text_;
    int count_ = 0;
};

} // namespace

std::string program_flow(ir::Graph &graph, NodeId root, const ir::Substitution &present,
                         FlowWords &words) {
    return StepWriter(graph, present, words).flow(root);
}

} // namespace fathom::save
