// The steps of an expression of the IR, calls and caches written out where they stand.
#include "save-format/program.h"

#include "save-format/yaml_writer.h"

#include <string_view>
#include <unordered_map>

namespace fathom::save {
namespace {

using ir::NodeId;
using ir::Op;

constexpr int most_steps = 20000;

class StepWriter {
  public:
    explicit StepWriter(const ir::Graph &graph) : graph_(graph) {}

    std::string flow(NodeId root) {
        std::unordered_map<NodeId, int> steps;
        return step(root, steps, 0) < 0 ? std::string() : "[" + text_ + "]";
    }

  private:
    using Steps = std::unordered_map<NodeId, int>;

    int push(const std::string &text) {
        if (count_ >= most_steps) return -1;
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
                column += ", " + std::to_string(part);
            }
            const int made = push(column);
            if (!matrix || made < 0) return made;
            all += ", " + std::to_string(made);
        }
        return push(all);
    }

    int step(NodeId id, Steps &steps, int depth) {
        if (const auto found = steps.find(id); found != steps.end()) return found->second;
        if (depth > 2000) return -1;
        const int made = make(id, steps, depth);
        if (made >= 0) steps.emplace(id, made);
        return made;
    }

    // A function's body where it is called: its parameters are the steps of the arguments.
    int call(const ir::Function &function, std::span<const NodeId> args, Steps &steps, int depth) {
        Steps inside;
        for (std::size_t i = 0; i < function.params.size() && i < args.size(); ++i) {
            const int argument = step(args[i], steps, depth + 1);
            if (argument < 0) return -1;
            inside.emplace(function.params[i], argument);
        }
        return step(function.result, inside, depth + 1);
    }

    int make(NodeId id, Steps &steps, int depth) {
        const ir::Node node = graph_[id];
        const std::vector<NodeId> args(graph_.args(id).begin(), graph_.args(id).end());
        switch (node.op) {
        case Op::Const: return constant(graph_.constant_of(id));
        case Op::Point: return push("Point");
        case Op::Time: return push("Time");
        case Op::Call:
            return call(graph_.function(ir::FunctionId{node.payload}), args, steps, depth);
        case Op::Cached:
            return call(graph_.function(graph_.cache(ir::CacheId{node.payload}).field), args, steps,
                        depth);
        case Op::TableRead: {
            const auto row = graph_.as_number(args[0]);
            const ir::Table &table = graph_.table(ir::table_of(node.payload));
            if (!row || table.rows == 0) return -1;
            const auto at =
                static_cast<std::size_t>(std::min(std::max(*row, 0.0), double(table.rows - 1)));
            ir::Constant value{node.type, {}};
            for (int i = 0; i < ir::components(node.type); ++i) {
                const std::size_t column =
                    static_cast<std::size_t>(ir::column_of(node.payload) + i);
                value.value[static_cast<std::size_t>(i)] =
                    table.data[at * static_cast<std::size_t>(table.stride) + column];
            }
            return constant(value);
        }
        case Op::Normal:
        case Op::Direction:
        case Op::Param:
        case Op::Var:
        case Op::Image:
        case Op::Grid:
        case Op::Fold:
        case Op::FoldResult:
        case Op::Blend:
        case Op::MakeHit:
        case Op::HitDistance:
        case Op::HitPaint:
        case Op::HitPoint:
        case Op::HitExtra:
        case Op::NearestHit:
        case Op::FarthestHit:
        case Op::HitWith:
        case Op::FillPaint: return -1;
        case Op::Neg:
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
        case Op::Mod:
        case Op::Pow:
        case Op::Min:
        case Op::Max:
        case Op::Step:
        case Op::Atan2:
        case Op::Abs:
        case Op::Sign:
        case Op::Floor:
        case Op::Ceil:
        case Op::Round:
        case Op::Trunc:
        case Op::Fract:
        case Op::Sqrt:
        case Op::InverseSqrt:
        case Op::Exp:
        case Op::Exp2:
        case Op::Log:
        case Op::Log2:
        case Op::Sin:
        case Op::Cos:
        case Op::Tan:
        case Op::Asin:
        case Op::Acos:
        case Op::Atan:
        case Op::Sinh:
        case Op::Cosh:
        case Op::Tanh:
        case Op::Clamp:
        case Op::Mix:
        case Op::Smoothstep:
        case Op::Dot:
        case Op::Length:
        case Op::Cross:
        case Op::Normalize:
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
        case Op::NotEqual:
        case Op::And:
        case Op::Or:
        case Op::Not:
        case Op::Select:
        case Op::ToFloat:
        case Op::ToInt:
        case Op::Splat:
        case Op::Make:
        case Op::Swizzle:
        case Op::Column:
        case Op::MatMul:
        case Op::Transpose:
        case Op::Hash:
        case Op::Perlin:
        case Op::Simplex:
        case Op::ValueNoise:
        case Op::Worley:
        case Op::SpotNoise:
        case Op::Union:
        case Op::Intersection: break;
        }
        if (node.op == Op::Div && node.type == ir::Type::Int)
            return -1; // truncates, unlike the language's `/`
        std::string text = ir::info(node.op).name;
        if (node.op == Op::Splat || node.op == Op::Make)
            text += std::string(", ") + ir::type_name(node.type);
        if (node.op == Op::Column) text += ", " + std::to_string(node.payload);
        if (node.op == Op::Swizzle) {
            text += ", ";
            for (int i = 0; i < ir::swizzle_size(node.payload); ++i)
                text += "xyzw"[ir::swizzle_component(node.payload, i)];
        }
        for (const NodeId argument : args) {
            const int made = step(argument, steps, depth + 1);
            if (made < 0) return -1;
            text += ", " + std::to_string(made);
        }
        return push(text);
    }

    const ir::Graph &graph_;
    std::string text_;
    int count_ = 0;
};

} // namespace

std::string program_flow(const ir::Graph &graph, NodeId root) {
    return StepWriter(graph).flow(root);
}

} // namespace fathom::save
