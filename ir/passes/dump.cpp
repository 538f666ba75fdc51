// Text forms of expressions and shapes, for goldens and for people who look inside. Stable: numbers
// count from the root, never from the arena.
#include "ir/passes/dump.h"

#include "base/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <unordered_map>

namespace fathom::ir {
namespace {

constexpr const char *axis_names[] = {"x", "y", "z"};

class Dumper {
  public:
    explicit Dumper(const Graph &graph) : graph_(graph) {}
    std::string out;

    // The short name of a node: a constant's value, an input's name, or the number of its line,
    // which is written first if it has not been.
    std::string name(NodeId id, int indent) {
        if (const auto it = names_.find(id); it != names_.end()) return it->second;
        const Node &node = graph_[id];
        if (node.op == Op::Const) return constant(graph_.constant_of(id));
        if (node.op == Op::Param) return fmt::format("param{}", node.payload);
        if (node.op == Op::Var) return names_[id] = fmt::format("v{}", variables_++);
        if (node.count == 0) return lower(info(node.op).name); // an input
        std::vector<NodeId> pending{id}; // without recursion: chains may be long
        while (!pending.empty()) {
            const NodeId at = pending.back();
            if (names_.contains(at)) {
                pending.pop_back();
                continue;
            }
            bool ready = true;
            const auto args = graph_.args(at);
            for (auto arg = args.rbegin(); arg != args.rend(); ++arg)
                if (!names_.contains(*arg) && graph_[*arg].count > 0) {
                    pending.push_back(*arg);
                    ready = false;
                }
            if (!ready) continue;
            pending.pop_back();
            line(at, indent);
        }
        return names_.at(id);
    }

    void function(FunctionId id, int indent) {
        const Function &function = graph_.function(id);
        std::string head = function.name + "(";
        for (std::size_t i = 0; i < function.params.size(); ++i)
            head += (i ? ", " : "") + name(function.params[i], indent) + ": " +
                    type_name(graph_.type(function.params[i]));
        put(indent, head + ") -> " + type_name(graph_.type(function.result)));
        put(indent + 1, "result " + name(function.result, indent + 1));
    }

    void put(int indent, const std::string &text) {
        out.append(static_cast<std::size_t>(2 * indent), ' ');
        out += text;
        out += '\n';
    }

  private:
    static std::string lower(std::string text) {
        std::transform(text.begin(), text.end(), text.begin(), [](char c) {
            return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        });
        return text;
    }

    static std::string constant(const Constant &constant) {
        if (constant.type == Type::Bool) return constant.value[0] != 0 ? "true" : "false";
        const int n = components(constant.type);
        std::string text = n > 1 ? std::string(type_name(constant.type)) + "(" : "";
        for (int i = 0; i < n; ++i)
            text += (i ? ", " : "") + format_shortest(constant.value[static_cast<std::size_t>(i)]);
        return n > 1 ? text + ")" : text;
    }

    void line(NodeId id, int indent) {
        const Node &node = graph_[id];
        std::string text = lower(info(node.op).name);
        if (node.op == Op::Swizzle) {
            text += '.';
            for (int i = 0; i < swizzle_size(node.payload); ++i)
                text += "xyzw"[swizzle_component(node.payload, i)];
        } else if (node.op == Op::Blend) {
            text += std::string(".") + profile_name(static_cast<Profile>(node.payload));
        } else if (node.op == Op::TableRead) {
            text +=
                fmt::format(" table{}[{}]", table_of(node.payload).index, column_of(node.payload));
        } else if (node.op == Op::Call) {
            text += " " + graph_.function(FunctionId{std::size_t{node.payload}}).name;
        } else if (node.op == Op::Cached) {
            const Cache &cache = graph_.cache(CacheId{std::size_t{node.payload}});
            text +=
                " " + graph_.function(cache.field).name + " cell " + format_shortest(cache.cell);
        } else if (node.op == Op::Column || node.op == Op::Image || node.op == Op::Grid ||
                   node.op == Op::LoopResult) {
            text += fmt::format(" {}", node.payload);
        }
        for (NodeId arg : graph_.args(id)) text += " " + name(arg, indent);
        const std::string own = fmt::format("%{}", lines_++);
        if (node.op == Op::Loop) text += loop(LoopId{std::size_t{node.payload}}, indent + 1);
        names_[id] = own;
        put(indent, own + ": " + type_name(node.type) + " = " + text);
    }

    // The body's lines come first; the head's end is handed back.
    std::string loop(LoopId id, int indent) {
        const Loop &loop = graph_.loop(id);
        std::string vars;
        for (NodeId var : loop.vars) vars += " " + name(var, indent);
        const std::string index = name(loop.index, indent), count = name(loop.count, indent);
        std::string next;
        for (NodeId result : loop.next) next += " " + name(result, indent);
        const std::string condition =
            loop.condition ? " while " + name(loop.condition, indent) : "";
        return fmt::format(" for {} < {} (at most {}){}:{} <-{}", index, count, loop.max_count,
                           condition, vars, next);
    }

    const Graph &graph_;
    std::unordered_map<NodeId, std::string> names_;
    int lines_ = 0, variables_ = 0;
};

void dump_region(Dumper &dumper, const Region &region, int indent, const char *word) {
    const auto text = [&](NodeId id) { return dumper.name(id, indent); };
    switch (region.kind) {
    case RegionKind::Everywhere: dumper.put(indent, std::string(word) + " everywhere"); break;
    case RegionKind::Ball:
        dumper.put(indent,
                   std::string(word) + " ball " + text(region.size) + " at " + text(region.center));
        break;
    case RegionKind::Box:
        dumper.put(indent,
                   std::string(word) + " box " + text(region.size) + " at " + text(region.center));
        break;
    case RegionKind::Tube:
        dumper.put(indent, std::string(word) + " tube " + axis_names[region.axis] + " " +
                               text(region.size));
        break;
    }
    for (const Region &less : region.less) dump_region(dumper, less, indent + 1, "less");
}

void dump_shape(Dumper &dumper, const Shapes &shapes, ShapeId id, int indent,
                std::unordered_map<ShapeId, int> &seen) {
    const Shape &shape = shapes[id];
    if (const auto it = seen.find(id); it != seen.end()) {
        dumper.put(indent, fmt::format("#{}", it->second));
        return;
    }
    const int number = static_cast<int>(seen.size());
    seen.emplace(id, number);
    std::string text = fmt::format("#{} {}", number, shape_kind_name(shape.kind));
    if (shape.dims == 2) text += " flat";
    switch (shape.kind) {
    case ShapeKind::Map:
        text += std::string(" ") + map_name(shape.map);
        if (shape.map == MapKind::Twist || shape.map == MapKind::Bend ||
            shape.map == MapKind::Taper)
            text += std::string(" ") + axis_names[shape.axis];
        if (shape.map == MapKind::Bend)
            text += std::string(" towards ") + axis_names[shape.towards];
        break;
    case ShapeKind::Blend:
        text += std::string(" ") + profile_name(static_cast<Profile>(shape.payload));
        break;
    case ShapeKind::Seam:
        text += std::string(" ") + seam_name(static_cast<SeamKind>(shape.payload));
        break;
    case ShapeKind::Library: {
        const Library &library = shapes.libraries[shape.payload];
        text += " " + library.name;
        for (const auto &[name, value] : library.arguments)
            text += " " + name + ": " + dumper.name(value, indent + 1);
        break;
    }
    case ShapeKind::Contract:
        text += " " + format_shortest(shapes.contracts[shape.payload].lipschitz);
        break;
    case ShapeKind::Repeat: {
        const Repetition &repetition = shapes.repetitions[shape.payload];
        if (repetition.polar)
            text += std::string(" polar ") + axis_names[repetition.axis];
        else
            for (std::size_t i = 0; i < 3; ++i)
                if (repetition.along[i]) text += std::string(" ") + axis_names[i];
        if (repetition.mirrored) text += " mirrored";
        if (repetition.id) text += " id " + dumper.name(repetition.id, indent + 1);
        break;
    }
    case ShapeKind::Instances: {
        const InstanceTable &instance_table = shapes.instance_tables[shape.payload];
        text += fmt::format(" {}{} by {}", instance_table.count,
                            (instance_table.smooth ? " smooth" : ""),
                            dumper.name(instance_table.index, indent + 1));
        break;
    }
    case ShapeKind::Empty:
    case ShapeKind::Leaf:
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Displace:
    case ShapeKind::Extrude:
    case ShapeKind::Within:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed: break;
    }
    for (NodeId arg : shape.args) text += " " + dumper.name(arg, indent + 1);
    if (shape.assumed > 0) text += " assumed " + format_shortest(shape.assumed);
    if (shape.estimate > 0) text += " estimate " + format_shortest(shape.estimate);
    dumper.put(indent, text);
    if (shape.kind == ShapeKind::Within)
        dump_region(dumper, shapes.regions[shape.payload], indent + 1, "in");
    if (shape.kind == ShapeKind::Paint || shape.kind == ShapeKind::Repaint) {
        const Material &material = shapes.materials[shape.payload];
        dumper.put(indent + 1, "diffuse " + dumper.name(material.diffuse, indent + 1) +
                                   " specular " + dumper.name(material.specular, indent + 1) +
                                   " exponent " + dumper.name(material.exponent, indent + 1) +
                                   " emission " + dumper.name(material.emission, indent + 1));
    }
    for (ShapeId child : shape.children) dump_shape(dumper, shapes, child, indent + 1, seen);
}

} // namespace

std::string dump(const Graph &graph, NodeId root) {
    Dumper dumper(graph);
    const std::string name = dumper.name(root, 0);
    if (dumper.out.empty()) dumper.put(0, name);
    return std::move(dumper.out);
}

std::string dump(const Graph &graph, FunctionId function) {
    Dumper dumper(graph);
    dumper.function(function, 0);
    return std::move(dumper.out);
}

std::string dump(const Graph &graph, const Shapes &shapes, ShapeId root) {
    Dumper dumper(graph);
    std::unordered_map<ShapeId, int> seen;
    dump_shape(dumper, shapes, root, 0, seen);
    return std::move(dumper.out);
}

} // namespace fathom::ir
