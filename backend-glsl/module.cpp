// What a text needs (functions, tables, images, params), their names, and constants as text.
#include "backend-glsl/module.h"

#include "base/encode.h"
#include "base/text.h"
#include "ir/passes/cost.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unordered_set>

namespace fathom::glsl {

using ir::NodeId;
using ir::Op;
using ir::Type;

const char *glsl_type(Type type) {
    return type == Type::Hit ? "Hit" : ir::type_name(type); // the language took GLSL's names
}

// GLSL has no words for infinity and NaN; both versions that we write know the bits.
std::string float_literal(float value) {
    if (std::isnan(value)) return "uintBitsToFloat(0x7fc00000u)";
    if (std::isinf(value))
        return value > 0 ? "uintBitsToFloat(0x7f800000u)" : "uintBitsToFloat(0xff800000u)";
    std::string text = format_shortest(value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

std::string vec3_literal(const glm::dvec3 &v) {
    return "vec3(" + float_literal(v[0]) + ", " + float_literal(v[1]) + ", " + float_literal(v[2]) +
           ")";
}

std::string comment(std::string_view text) { return "// " + for_comment(text) + "\n"; }

std::string literal(const ir::Constant &constant) {
    const auto number = [&](std::size_t i) {
        return float_literal(static_cast<float>(constant.value[i]));
    };
    switch (constant.type) {
    case Type::Bool: return constant.value[0] != 0 ? "true" : "false";
    case Type::Int: {
        const auto value = static_cast<std::int64_t>(constant.value[0]);
        return value <= -2147483648 ? "(-2147483647 - 1)" : fmt::to_string(value);
    }
    case Type::Float: return number(0);
    case Type::Vec2:
    case Type::Vec3:
    case Type::Vec4:
    case Type::Mat2:
    case Type::Mat3:
    case Type::Mat4:
    case Type::Hit: break;
    }
    const std::size_t size = static_cast<std::size_t>(ir::components(constant.type));
    std::string text = std::string(glsl_type(constant.type)) + "(" + number(0);
    bool equal = ir::is_vector(constant.type);
    for (std::size_t i = 1; i < size; ++i) equal &= number(i) == number(0);
    for (std::size_t i = 1; i < size && !equal; ++i) text += ", " + number(i);
    return text + ")";
}

namespace {

class Gatherer {
  public:
    explicit Gatherer(Module &module) : module_(module), graph_(module.scene.graph) {}

    void walk(NodeId root) {
        std::vector<NodeId> todo{root};
        while (!todo.empty()) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!id || !seen_.insert(id).second) continue;
            const ir::Node &node = graph_[id];
            module_.hits |= node.type == Type::Hit;
            for (NodeId arg : graph_.args(id)) todo.push_back(arg);
            if (node.op == Op::Loop) {
                const ir::Loop &loop = graph_.loop(ir::LoopId{node.payload});
                todo.insert(todo.end(), loop.next.begin(), loop.next.end());
                todo.push_back(loop.condition);
                todo.push_back(loop.count);
            } else if (node.op == Op::Call) {
                function(node.payload, todo);
            } else if (node.op == Op::Cached) {
                function(graph_.cache(ir::CacheId{node.payload}).field.index, todo);
                caches_.insert(node.payload);
            } else if (node.op == Op::TableRead) {
                read(node.payload, todo);
            } else if (node.op == Op::Param) {
                params_.insert(node.payload);
            } else if (node.op == Op::Image) {
                images_.insert(node.payload);
            } else if (node.op == Op::Grid) {
                grids_.insert(node.payload);
            }
        }
    }

    void name() {
        for (std::uint32_t index : functions_)
            if (!module_.functions.contains(index))
                module_.functions[index] =
                    module_.names.unique(graph_.function(ir::FunctionId{index}).name);
        for (std::uint32_t index : params_)
            module_.params[index] =
                module_.names.unique("param_" + module_.scene.params[index].name);
        for (std::uint32_t index : images_)
            module_.images[index] = module_.names.unique(fmt::format("image_{}", index));
        for (std::uint32_t index : grids_)
            module_.grids[index] = module_.names.unique(fmt::format("grid_{}", index));
        for (std::uint32_t index : tables_) table(index);
        if (module_.options.noise_cache)
            for (std::uint32_t index : caches_) keep(ir::CacheId{index});
    }

  private:
    void function(std::uint32_t index, std::vector<NodeId> &todo) {
        if (functions_.insert(index).second)
            todo.push_back(module_.result_of(ir::FunctionId{index}));
    }

    void keep(ir::CacheId id) {
        if (module_.cached.size() >= max_cache_fields ||
            ir::cached(module_.scene, id) != ir::Cacheable::Yes)
            return;
        const ir::Cache &cache = graph_.cache(id);
        const std::string &name = module_.functions.at(cache.field.index);
        module_.names.unique(name + "_cached");
        module_.cached[id.index] = {name, graph_[graph_.function(cache.field).result].type,
                                    cache.cell, module_.scene.caches[id.index].slope};
    }

    void read(std::uint32_t slot, std::vector<NodeId> &todo) {
        const ir::Table &table = graph_.table(ir::table_of(slot));
        if ((module_.options.computed || !module_.options.buffers) && !is_better_read(table))
            for (const auto &[column, formula] : table.computed)
                if (column == ir::column_of(slot)) {
                    module_.computed[slot] = formula;
                    return function(formula.index, todo);
                }
        tables_.insert(ir::table_of(slot).index);
    }

    // A table of few rows of which a formula takes a sine or more: each turn of a loop that computes
    // it takes longer than one that reads it.
    bool is_better_read(const ir::Table &table) const {
        constexpr int few = 256;     // texels
        constexpr double dear = 0.4; // cost.h
        return table.rows * ((table.stride + 3) / 4) <= few &&
               std::ranges::any_of(table.computed, [&](const auto &column) {
                   return ir::cost_of(graph_, graph_.function(column.second).result) >= dear;
               });
    }

    void table(std::uint32_t index) {
        const ir::Table &data = graph_.table(ir::TableId{index});
        module_.tables[index] =
            add_table(module_, fmt::format("table_{}", index), data.rows, data.stride, data.data);
    }

    Module &module_;
    const ir::Graph &graph_;
    std::unordered_set<NodeId> seen_;
    std::set<std::uint32_t> functions_, params_, tables_, images_, grids_, caches_;
};

} // namespace

// So that reading a vector takes one or two texels.
TableUse add_table(Module &module, const std::string &name, int rows, int stride,
                   const std::vector<float> &data) {
    TableUse use;
    use.name = module.names.unique(name);
    use.rows = std::max(rows, 1);
    use.texels = std::max((stride + 3) / 4, 1);
    use.data.assign(static_cast<std::size_t>(use.rows) * static_cast<std::size_t>(use.texels) * 4,
                    0.0f);
    for (int row = 0; row < rows; ++row)
        std::copy_n(data.begin() + row * stride, stride, use.data.begin() + row * use.texels * 4);
    use.buffer = module.options.buffers && rows > module.options.table_text;
    if (use.buffer) {
        use.start = static_cast<int>(module.texels.size() / 4);
        module.texels.insert(module.texels.end(), use.data.begin(), use.data.end());
    }
    return use;
}

std::string texel(const TableUse &use, const std::string &place) {
    if (!use.buffer) return use.name + "[" + place + "]";
    return "texelFetch(fathom_tables, " + place +
           (use.start ? fmt::format(" + {}", use.start) : "") + ")";
}

void gather(Module &module, std::span<const NodeId> roots) {
    Gatherer gatherer(module);
    for (NodeId root : roots) gatherer.walk(root);
    gatherer.name();
}

} // namespace fathom::glsl
