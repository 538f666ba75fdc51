// A graph's function as single values. Vectors fall apart into components, small functions and
// those called once are built in place. Which kernels an operation is stands in select.cpp, what
// they compute in ir/semantics.h.
#include "backend-cpu/compile/code.h"
#include "backend-cpu/compile/select.h"

#include <algorithm>
#include <cassert>
#include <unordered_set>

namespace fathom::cpu {

using namespace ir;

namespace {

using Values = std::vector<Value>;

Type scalar_type(Type type, int component) {
    switch (type) {
    case Type::Bool: return Type::Bool;
    case Type::Int: return Type::Int;
    case Type::Hit: return component == 1 ? Type::Int : Type::Float;
    case Type::Float:
    case Type::Vec2:
    case Type::Vec3:
    case Type::Vec4:
    case Type::Mat2:
    case Type::Mat3:
    case Type::Mat4: return Type::Float;
    }
    return Type::Float;
}

std::vector<Type> scalar_types(Type type) {
    std::vector<Type> types;
    for (int i = 0; i < components(type); ++i) types.push_back(scalar_type(type, i));
    return types;
}

// The values that a function's nodes have, where it is built in place once more.
struct Frame {
    std::unordered_map<NodeId, Values> values; // of a Loop: all its carried values
    std::vector<std::pair<NodeId, std::uint16_t>>
        made; // what stands in a loop, to be forgotten when it closes
};

class FunctionBuilder {
  public:
    FunctionBuilder(const Scene &scene, Calls &calls, Code &code)
        : graph_(scene.graph), calls_(calls), code_(code), builder_(code) {}

    void run(std::size_t index) {
        const Body &body = calls_.bodies[index];
        Frame frame;
        const std::vector<bool> &shared = calls_.shared[index];
        for (std::size_t k = 0; k < body.params.size(); ++k) {
            Values values;
            for (Type type : scalar_types(graph_[body.params[k]].type)) {
                values.push_back(builder_.variable(type, shared[k], 0));
                code_.params.push_back(values.back());
            }
            frame.values[body.params[k]] = std::move(values);
        }
        for (NodeId result : body.results) {
            const Values &values = value(frame, result);
            code_.results.insert(code_.results.end(), values.begin(),
                                 values.begin() + components(graph_[result].type));
        }
    }

  private:
    // Arguments first, by a stack of our own: chains may be long.
    const Values &value(Frame &frame, NodeId root) {
        std::vector<NodeId> stack{root};
        while (!stack.empty()) {
            NodeId id = stack.back();
            if (frame.values.contains(id)) {
                stack.pop_back();
                continue;
            }
            std::size_t before = stack.size();
            auto args = graph_.args(id);
            for (std::size_t i = args.size(); i-- > 0;)
                if (!frame.values.contains(args[i])) stack.push_back(args[i]);
            if (graph_[id].op == Op::Loop) {
                NodeId count = graph_.loop(LoopId{graph_[id].payload}).count;
                if (!frame.values.contains(count)) stack.push_back(count);
            }
            if (stack.size() > before) continue;
            Values made = node(frame, id);
            std::uint16_t level = 0;
            for (Value v : made) level = std::max(level, code_.values[v].level);
            if (level > 0) frame.made.emplace_back(id, level);
            frame.values.emplace(id, std::move(made));
            stack.pop_back();
        }
        return frame.values.at(root);
    }

    Values node(Frame &frame, NodeId id);
    Values call(FunctionId id, const std::vector<Values> &arguments);
    Values loop(Frame &frame, NodeId id);
    Value moved(const LoopCode &loop, Value next);
    Values outside(const LoopCode &loop) const;

    const Graph &graph_;
    Calls &calls_;
    Code &code_;
    Builder builder_;
    std::uint16_t depth_ = 0;
};

Values FunctionBuilder::node(Frame &frame, NodeId id) {
    const Node &node = graph_[id];
    std::vector<Values> args;
    for (NodeId arg : graph_.args(id)) args.push_back(frame.values.at(arg));
    std::vector<Type> types;
    for (NodeId arg : graph_.args(id)) types.push_back(graph_[arg].type);

    if (node.op != Op::LoopResult) // anywhere else a Loop stands for its first carried value
        for (std::size_t k = 0; k < args.size(); ++k)
            args[k].resize(static_cast<std::size_t>(components(types[k])));
    // If one coordinate differs by point, all count as differing: a read does not say which are
    // shared.
    auto data = [&](InstructionKind kind) {
        Values at = args[0];
        const auto shared = [&](Value v) { return code_.values[v].shared; };
        if (!std::ranges::all_of(at, shared))
            for (Value &v : at) v = builder_.spread(v);
        return builder_.instruction(kind, node.payload, at, scalar_types(node.type));
    };

    if (node.op == Op::Const) {
        const Constant &constant = graph_.constant_of(id);
        Values values;
        for (int i = 0; i < components(node.type); ++i) {
            double number = constant.value[static_cast<std::size_t>(i)];
            values.push_back(scalar_type(node.type, i) == Type::Float
                                 ? builder_.number(static_cast<float>(number))
                                 : builder_.integer(static_cast<std::int32_t>(number)));
        }
        return values;
    }
    if (node.op == Op::Time) return {builder_.time()};
    if (node.op == Op::Param) {
        Values values;
        std::uint32_t component = 0;
        for (Type type : scalar_types(node.type))
            values.push_back(builder_.param(node.payload, component++, type));
        return values;
    }
    if (node.op == Op::TableRead) return data(InstructionKind::TableRead);
    if (node.op == Op::Image) return data(InstructionKind::Image);
    if (node.op == Op::Grid) return data(InstructionKind::Grid);
    if (node.op == Op::Call) return call(FunctionId{node.payload}, args);
    if (node.op == Op::Cached) return call(graph_.cache(CacheId{node.payload}).field, args);
    if (node.op == Op::Loop) return loop(frame, id);
    if (node.op == Op::LoopResult) {
        const ir::Loop &record = graph_.loop(LoopId{graph_[graph_.arg(id, 0)].payload});
        std::size_t first = 0;
        for (std::uint32_t k = 0; k < node.payload; ++k)
            first += static_cast<std::size_t>(components(graph_[record.vars[k]].type));
        auto begin = args[0].begin() + static_cast<std::ptrdiff_t>(first);
        return {begin, begin + components(node.type)};
    }
    return select(builder_, node, args, types);
}

Values FunctionBuilder::call(FunctionId id, const std::vector<Values> &arguments) {
    const Function &function = graph_.function(id);
    if (calls_.inlined[id.index]) {
        Frame frame;
        for (std::size_t k = 0; k < function.params.size(); ++k)
            frame.values[function.params[k]] = arguments[k];
        Values result = value(frame, function.result);
        result.resize(static_cast<std::size_t>(components(graph_[function.result].type)));
        return result;
    }
    Values in;
    std::vector<bool> &shared = calls_.shared[calls_.body[id.index]];
    for (std::size_t k = 0; k < arguments.size(); ++k)
        for (std::size_t c = 0;
             c < static_cast<std::size_t>(components(graph_[function.params[k]].type)); ++c) {
            in.push_back(arguments[k][c]);
            if (!code_.values[in.back()].shared) shared[k] = false;
        }
    return builder_.instruction(InstructionKind::Call, id.index, in,
                                scalar_types(graph_[function.result].type));
}

Values FunctionBuilder::loop(Frame &frame, NodeId id) {
    const ir::Loop &record = graph_.loop(LoopId{graph_[id].payload});
    Values count = frame.values.at(record.count);
    LoopCode loop;
    loop.level = ++depth_;
    loop.max_count = record.max_count;
    loop.count = count[0];
    loop.index = builder_.variable(Type::Int, true, depth_);
    frame.values[record.index] = {loop.index};

    // A variable is shared if it begins so and no iteration makes it differ; whether iterations
    // happen must not differ either.
    std::size_t n = record.vars.size();
    std::vector<bool> shared(n);
    std::vector<std::vector<NodeId>> reads(n);
    std::vector<NodeId> condition_reads;
    for (std::size_t k = 0; k < n; ++k) reads[k] = graph_.free_vars(record.next[k]);
    if (record.condition) condition_reads = graph_.free_vars(record.condition);
    for (std::size_t k = 0; k < n; ++k) {
        const Values &init = frame.values.at(graph_.arg(id, static_cast<int>(k)));
        shared[k] = true;
        for (std::size_t c = 0;
             c < static_cast<std::size_t>(components(graph_[record.vars[k]].type)); ++c) {
            loop.init.push_back(init[c]);
            shared[k] = shared[k] && code_.values[init[c]].shared;
        }
    }
    bool turns_shared = code_.values[loop.count].shared;
    auto shared_var = [&](NodeId var) {
        for (std::size_t k = 0; k < n; ++k)
            if (record.vars[k] == var) return static_cast<bool>(shared[k]);
        auto found = frame.values.find(var);
        return found == frame.values.end() ||
               std::ranges::all_of(found->second, [&](Value v) { return code_.values[v].shared; });
    };
    for (bool changed = true; changed;) {
        changed = false;
        turns_shared = turns_shared && std::ranges::all_of(condition_reads, shared_var);
        for (std::size_t k = 0; k < n; ++k)
            if (shared[k] && !(turns_shared && std::ranges::all_of(reads[k], shared_var))) {
                shared[k] = false;
                changed = true;
            }
    }

    for (std::size_t k = 0; k < n; ++k) {
        Values var;
        for (Type type : scalar_types(graph_[record.vars[k]].type))
            var.push_back(builder_.variable(type, shared[k], depth_));
        loop.vars.insert(loop.vars.end(), var.begin(), var.end());
        frame.values[record.vars[k]] = std::move(var);
    }
    if (record.condition) loop.condition = value(frame, record.condition)[0];
    if (!code_.values[loop.count].shared) {
        Value more = builder_.make(Kernel::LessI, {loop.index, loop.count});
        loop.condition =
            record.condition ? builder_.make(Kernel::And, {more, loop.condition}) : more;
    }
    if (!turns_shared) loop.active = builder_.variable(Type::Bool, false, depth_);
    for (std::size_t k = 0; k < n; ++k) {
        Values next = value(frame, record.next[k]);
        for (std::size_t c = 0;
             c < static_cast<std::size_t>(components(graph_[record.vars[k]].type)); ++c)
            loop.next.push_back(moved(loop, next[c]));
    }

    // What the body made belongs to this iteration of this loop alone.
    std::erase_if(frame.made, [&](const auto &entry) {
        if (entry.second < depth_) return false;
        frame.values.erase(entry.first);
        return true;
    });
    frame.values.erase(record.index);
    for (NodeId var : record.vars) frame.values.erase(var);
    --depth_;

    std::vector<Type> types;
    for (Value var : loop.vars) types.push_back(code_.values[var].type);
    Values in = outside(loop), vars = loop.vars;
    auto payload = static_cast<std::uint32_t>(code_.loops.size());
    code_.loops.push_back(std::move(loop));
    Values outs = builder_.instruction(InstructionKind::Loop, payload, in, types);
    for (std::size_t k = 0; k < outs.size(); ++k)
        code_.values[outs[k]].shared = code_.values[vars[k]].shared;
    return outs;
}

// All variables move on at once: what takes another's value takes it from a copy.
Value FunctionBuilder::moved(const LoopCode &loop, Value next) {
    if (std::ranges::find(loop.vars, next) == loop.vars.end()) return next;
    return builder_.make(code_.values[next].type == Type::Float ? Kernel::CopyF : Kernel::CopyI,
                         {next});
}

// What a loop reads that is made before it.
Values FunctionBuilder::outside(const LoopCode &loop) const {
    Values reads = loop.init, stack = loop.next;
    reads.push_back(loop.count);
    if (loop.condition) stack.push_back(loop.condition);
    std::unordered_set<Value> seen;
    while (!stack.empty()) {
        Value value = stack.back();
        stack.pop_back();
        if (!seen.insert(value).second) continue;
        const ValueInfo &info = code_.values[value];
        if (info.level < loop.level) {
            reads.push_back(value);
        } else if (info.made_by) {
            const std::vector<Value> &in = code_.instructions[info.made_by].in;
            stack.insert(stack.end(), in.begin(), in.end());
        }
    }
    return reads;
}

} // namespace

Code build(const Scene &scene, Calls &calls, std::size_t body, Choices choices) {
    Code code;
    code.choices = choices;
    FunctionBuilder(scene, calls, code).run(body);
    return code;
}

} // namespace fathom::cpu
