// The rules of a lowered scene, checked node by node. What back ends may take for granted is what
// stands here.
#include "ir/passes/verify.h"

#include <algorithm>
#include <fmt/format.h>
#include <unordered_set>

namespace fathom::ir {
namespace {

class Verifier {
  public:
    explicit Verifier(const Scene &scene) : scene_(scene), graph_(scene.graph) {}

    std::string run() {
        for (std::size_t i = 0; i < graph_.function_count() && problem_.empty(); ++i) function(i);
        for (std::size_t i = 0; i < scene_.surfaces.size() && problem_.empty(); ++i) surface(i);
        callable_ = graph_.function_count();
        signature(scene_.distance, "distance", Type::Float);
        signature(scene_.shaded, "shaded", Type::Float);
        signature(scene_.hit, "hit", Type::Hit);
        if (scene_.safe_radius) signature(scene_.safe_radius, "reach", Type::Vec2);
        if (scene_.endless) signature(scene_.endless, "endless", Type::Float);
        if (scene_.endless_hit) signature(scene_.endless_hit, "endless_hit", Type::Hit);
        for (FunctionId part : scene_.framed_alone) signature(part, "framed_alone", Type::Float);
        signature(scene_.background_function, "background", Type::Vec3);
        if (scene_.surfaces.empty()) fail("there is no surface for what is not painted");
        for (const Light &light : scene_.lights) {
            constant_of_scene(light.position, Type::Vec3, "a light's position");
            constant_of_scene(light.color, Type::Vec3, "a light's colour");
        }
        return problem_;
    }

  private:
    void fail(const std::string &problem) {
        if (problem_.empty()) problem_ = problem;
    }
    void fail(NodeId id, const std::string &problem) {
        fail(fmt::format("node {} ({}): {}", id.index, info(graph_[id].op).name, problem));
    }
    Type type(NodeId id) const { return graph_.type(id); }

    void signature(FunctionId id, const char *name, Type result) {
        if (!id || id.index >= graph_.function_count())
            return fail(std::string("no function ") + name);
        const Function &function = graph_.function(id);
        if (function.params.size() != 1 || type(function.params[0]) != Type::Vec3 ||
            type(function.result) != result)
            fail(std::string(name) + " has another signature");
    }

    void constant_of_scene(NodeId id, Type wanted, const char *what) {
        if (!id) return fail(std::string(what) + " is missing");
        if (type(id) != wanted) fail(std::string(what) + " has type " + type_name(type(id)));
        closed(id, {}, what);
        walk(id);
    }

    void closed(NodeId root, const std::vector<NodeId> &params, const std::string &where) {
        const Graph::Reads reads = graph_.reads(root);
        if (reads.point) fail(where + " reads Point");
        if (reads.normal) fail(where + " reads Normal");
        if (reads.direction) fail(where + " reads Direction");
        if (!reads.free_vars) return;
        for (NodeId var : graph_.free_vars(root))
            if (std::find(params.begin(), params.end(), var) == params.end())
                fail(fmt::format("{} has a free variable, node {}", where, var.index));
    }

    void function(std::size_t index) {
        const Function &function = graph_.function(FunctionId{index});
        callable_ = index;
        std::vector<NodeId> sorted = function.params;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
            fail(function.name + " has a parameter twice");
        for (NodeId param : function.params)
            if (graph_[param].op != Op::Var)
                fail(function.name + " has a parameter that is no variable");
        closed(function.result, function.params, "function " + function.name);
        walk(function.result);
    }

    void surface(std::size_t index) {
        const Surface &s = scene_.surfaces[index];
        const std::string where = fmt::format("surface {}", index);
        callable_ = graph_.function_count();
        const std::pair<NodeId, Type> parts[] = {{s.diffuse, Type::Vec3},
                                                 {s.specular, Type::Vec3},
                                                 {s.exponent, Type::Float},
                                                 {s.emission, Type::Vec3}};
        for (const auto &[id, wanted] : parts) {
            if (!id) return fail(where + " lacks a part");
            if (type(id) != wanted) fail(where + " has a part of type " + type_name(type(id)));
            closed(id, {s.point, s.normal, s.extra}, where);
            walk(id);
        }
    }

    // Nodes are checked once; functions call only those before them, so the first visit has the
    // strictest limit only if functions come in order, as here.
    void walk(NodeId root) {
        std::vector<NodeId> stack{root};
        while (!stack.empty() && problem_.empty()) {
            const NodeId id = stack.back();
            stack.pop_back();
            if (!seen_.insert(id).second) continue;
            const Node &node = graph_[id];
            for (NodeId arg : graph_.args(id)) {
                if (!(arg < id)) fail(id, "an argument does not precede it");
                stack.push_back(arg);
            }
            if (problem_.empty()) check(id, stack);
            if (node.op == Op::Call && node.payload >= callable_)
                fail(id, "calls a function that does not precede it");
        }
    }

    bool is_float(NodeId id) const { return type(id) == Type::Float || is_vector(type(id)); }

    void want(NodeId id, bool rule, const char *what) {
        if (!rule) fail(id, what);
    }

    // Long: a case for each op.
    void check(NodeId id, std::vector<NodeId> &stack) {
        const Node &node = graph_[id];
        const std::span<const NodeId> args = graph_.args(id);
        const OpInfo &op = info(node.op);
        want(id, op.arity < 0 ? !args.empty() : args.size() == static_cast<std::size_t>(op.arity),
             "the number of arguments is wrong");
        if (!problem_.empty()) return;
        const auto all = [&](Type wanted) {
            return std::all_of(args.begin(), args.end(),
                               [&](NodeId arg) { return type(arg) == wanted; });
        };
        switch (op.rule) {
        case TypeRule::Same:
            want(id, all(node.type), "the arguments' types differ from its own");
            break;
        case TypeRule::Last:
            want(id, type(args.back()) == node.type, "its type is not its last argument's");
            break;
        case TypeRule::ToFloat: want(id, node.type == Type::Float, "it is no float"); break;
        case TypeRule::ToBool: want(id, node.type == Type::Bool, "it is no bool"); break;
        case TypeRule::Given: break;
        }
        const auto is = [&](std::size_t i, Type wanted) { return type(args[i]) == wanted; };
        switch (node.op) {
        case Op::Const: break;
        case Op::Point:
        case Op::Normal:
        case Op::Direction: fail(id, "stands in a lowered scene"); break;
        case Op::Time: want(id, node.type == Type::Float, "it is no float"); break;
        case Op::Param:
            want(id,
                 node.payload < scene_.params.size() &&
                     scene_.params[node.payload].type == node.type,
                 "there is no such parameter");
            break;
        case Op::Var:
            want(id, node.payload < graph_.var_count(), "there is no such variable");
            break;
#define FATHOM_BY_COMPONENT(name, ...) case Op::name:
#include "ir/ops.def"
            want(id,
                 is_float(id) || is_matrix(node.type) ||
                     (op.takes == Takes::Numbers && node.type == Type::Int),
                 "it does not take this type");
            break;
        case Op::Normalize: want(id, is_float(id), "its type is no float or vector"); break;
        case Op::Dot:
            want(id, is_float(args[0]) && is(1, type(args[0])), "its arguments differ in type");
            break;
        case Op::Length: want(id, is_float(args[0]), "its argument is no vector"); break;
        case Op::Cross: want(id, node.type == Type::Vec3, "it is no vec3"); break;
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
        case Op::NotEqual:
            want(id, is(1, type(args[0])) && components(type(args[0])) == 1,
                 "it compares no two numbers");
            break;
        case Op::And:
        case Op::Or:
        case Op::Not: want(id, all(Type::Bool), "an argument is no bool"); break;
        case Op::Select:
            want(id, is(0, Type::Bool) && is(1, node.type), "its arguments' types are wrong");
            break;
        case Op::ToFloat:
            want(id, node.type == Type::Float && (is(0, Type::Int) || is(0, Type::Bool)),
                 "converts no int or bool");
            break;
        case Op::ToInt:
            want(id, node.type == Type::Int && (is(0, Type::Float) || is(0, Type::Bool)),
                 "converts no float or bool");
            break;
        case Op::Splat:
            want(id, components(type(args[0])) == 1, "its argument is no number");
            break;
        case Op::Make:
            if (is_matrix(node.type))
                want(id,
                     static_cast<int>(args.size()) == side(node.type) &&
                         all(vector_type(side(node.type))),
                     "its arguments are not the matrix' columns");
            else
                want(id,
                     is_vector(node.type) &&
                         static_cast<int>(args.size()) == components(node.type) && all(Type::Float),
                     "its arguments are not the vector's components");
            break;
        case Op::Swizzle: {
            bool fits =
                is_vector(type(args[0])) && vector_type(swizzle_size(node.payload)) == node.type;
            for (int i = 0; fits && i < swizzle_size(node.payload); ++i)
                fits = swizzle_component(node.payload, i) < components(type(args[0]));
            want(id, fits, "its mask does not fit");
            break;
        }
        case Op::Column:
            want(id,
                 is_matrix(type(args[0])) && static_cast<int>(node.payload) < side(type(args[0])) &&
                     node.type == vector_type(side(type(args[0]))),
                 "there is no such column");
            break;
        case Op::MatMul: {
            const Type a = type(args[0]), b = type(args[1]);
            const bool fits = is_matrix(a) && is_matrix(b) ? a == b && node.type == a
                              : is_matrix(a)
                                  ? b == vector_type(side(a)) && node.type == b
                                  : is_matrix(b) && a == vector_type(side(b)) && node.type == a;
            want(id, fits, "the sizes do not fit");
            break;
        }
        case Op::Transpose: want(id, is_matrix(node.type), "it is no matrix"); break;
        case Op::TableRead: {
            const TableId table = table_of(node.payload);
            want(id,
                 is(0, Type::Int) && table.index < graph_.table_count() &&
                     column_of(node.payload) + components(node.type) <= graph_.table(table).stride,
                 "there is no such column");
            for (const auto &[column, formula] : graph_.table(table).computed)
                want(id,
                     graph_.function(formula).params.size() == 1 &&
                         type(graph_.function(formula).params[0]) == Type::Int &&
                         column + components(type(graph_.function(formula).result)) <=
                             graph_.table(table).stride,
                     "a column's formula does not fit");
            break;
        }
        case Op::Hash:
            want(id, is(0, Type::Int) || is_float(args[0]), "its argument cannot be hashed");
            break;
        case Op::Perlin:
        case Op::Simplex:
        case Op::ValueNoise:
        case Op::Worley: want(id, is(0, Type::Vec3), "its argument is no vec3"); break;
        case Op::SpotNoise:
            want(id, is(0, Type::Vec3) && is(1, Type::Float) && is(2, Type::Float),
                 "its arguments' types are wrong");
            break;
        case Op::Image:
            want(id,
                 node.payload < scene_.images.size() && is(0, Type::Vec2) &&
                     node.type == Type::Vec4,
                 "there is no such image");
            break;
        case Op::Grid:
            want(id,
                 node.payload < scene_.grids.size() && is(0, Type::Vec3) &&
                     node.type == Type::Float,
                 "there is no such grid");
            break;
        case Op::Call: call(id, args); break;
        case Op::Loop: loop(id, args, stack); break;
        case Op::LoopResult: {
            const Node &of = graph_[args[0]];
            const bool fits =
                of.op == Op::Loop &&
                node.payload < graph_.loop(LoopId{std::size_t{of.payload}}).vars.size() &&
                type(graph_.loop(LoopId{std::size_t{of.payload}}).vars[node.payload]) == node.type;
            want(id, fits, "the loop has no such value");
            break;
        }
        case Op::Cached:
            want(id, node.payload < graph_.cache_count() && is(0, Type::Vec3),
                 "there is no such cache");
            break;
        case Op::Union:
        case Op::Intersection: want(id, all(Type::Float), "an argument is no float"); break;
        case Op::Blend:
            want(id,
                 args.size() >= 4 && all(Type::Float) &&
                     node.payload <= static_cast<std::uint32_t>(Profile::Columns),
                 "its arguments are not a radius, a count and floats");
            break;
        case Op::MakeHit:
            want(id,
                 is(0, Type::Float) && is(1, Type::Int) && is(2, Type::Vec3) && is(3, Type::Vec4),
                 "its arguments' types are wrong");
            break;
        case Op::HitDistance: want(id, is(0, Type::Hit), "its argument is no hit"); break;
        case Op::HitPaint:
            want(id, is(0, Type::Hit) && node.type == Type::Int, "its types are wrong");
            break;
        case Op::HitPoint:
            want(id, is(0, Type::Hit) && node.type == Type::Vec3, "its types are wrong");
            break;
        case Op::HitExtra:
            want(id, is(0, Type::Hit) && node.type == Type::Vec4, "its types are wrong");
            break;
        case Op::NearestHit:
        case Op::FarthestHit:
            want(id, all(Type::Hit) && node.type == Type::Hit, "an argument is no hit");
            break;
        case Op::HitWith:
            want(id, is(0, Type::Hit) && is(1, Type::Float) && node.type == Type::Hit,
                 "its arguments' types are wrong");
            break;
        case Op::FillPaint:
            want(id,
                 is(0, Type::Hit) && is(1, Type::Int) && is(2, Type::Vec3) && is(3, Type::Vec4) &&
                     node.type == Type::Hit,
                 "its arguments' types are wrong");
            break;
        }
    }

    void call(NodeId id, std::span<const NodeId> args) {
        const std::uint32_t payload = graph_[id].payload;
        if (payload >= graph_.function_count()) return fail(id, "there is no such function");
        const Function &function = graph_.function(FunctionId{std::size_t{payload}});
        if (function.params.size() != args.size())
            return fail(id, "the number of arguments is wrong");
        for (std::size_t i = 0; i < args.size(); ++i)
            if (type(args[i]) != type(function.params[i])) fail(id, "an argument's type is wrong");
        if (type(function.result) != graph_.type(id)) fail(id, "its type is not the function's");
    }

    void loop(NodeId id, std::span<const NodeId> args, std::vector<NodeId> &stack) {
        const std::uint32_t payload = graph_[id].payload;
        if (payload >= graph_.loop_count()) return fail(id, "there is no such loop");
        const Loop &loop = graph_.loop(LoopId{std::size_t{payload}});
        if (loop.vars.empty() || loop.vars.size() != args.size() || loop.next.size() != args.size())
            return fail(id, "the carried values do not match");
        if (type(loop.vars.front()) != graph_.type(id))
            fail(id, "its type is not its first value's");
        for (std::size_t i = 0; i < args.size(); ++i)
            if (graph_[loop.vars[i]].op != Op::Var || type(args[i]) != type(loop.vars[i]) ||
                type(loop.next[i]) != type(loop.vars[i]))
                fail(id, "a carried value's type changes");
        if (graph_[loop.index].op != Op::Var || type(loop.index) != Type::Int)
            fail(id, "its index is no int variable");
        if (type(loop.count) != Type::Int) fail(id, "its count is no int");
        if (loop.condition && type(loop.condition) != Type::Bool)
            fail(id, "its condition is no bool");
        if (loop.max_count < 0) fail(id, "it has no limit");
        if (loop.count > id || (loop.condition && loop.condition > id) ||
            std::ranges::any_of(loop.next, [&](NodeId next) { return next > id; }))
            fail(id, "it precedes what it computes");
        if (const std::optional<double> count = graph_.as_number(loop.count);
            count && *count > loop.max_count)
            fail(id, "it counts past its limit");
        stack.push_back(loop.count);
        if (loop.condition) stack.push_back(loop.condition);
        stack.insert(stack.end(), loop.next.begin(), loop.next.end());
    }

    const Scene &scene_;
    const Graph &graph_;
    std::size_t callable_ = 0;
    std::unordered_set<NodeId> seen_;
    std::string problem_;
};

} // namespace

std::string verify(const Scene &scene) { return Verifier(scene).run(); }

} // namespace fathom::ir
