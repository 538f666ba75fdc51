// The slowest evaluator: a plain recursion over the graph, in double, for tests to hold the quick
// ones against. It says what structure means (calls, folds, hits, tables, samples); single ops are
// ir::evaluate's.
#pragma once

#include "ir/passes/fold.h"
#include "ir/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace fathom::test {

struct ReferenceHit {
    double distance = 0;
    int paint = -1;
    std::array<double, 3> point{};
    std::array<double, 4> extra{};
};

class Reference {
  public:
    using Value = ir::Constant; // a Hit's nine numbers: distance, paint, point, extra
    using Scope = std::unordered_map<ir::NodeId, Value>;

    explicit Reference(const ir::Scene &scene) : scene_(&scene), graph_(scene.graph) {}
    explicit Reference(const ir::Graph &graph) : graph_(graph) {}

    double time = 0;
    std::array<double, 3> point{}, normal{}, direction{};
    std::vector<std::array<double, 4>> params; // by index; else the scene's `value`
    std::size_t evaluations = 0;               // nodes computed so far

    Value operator()(ir::NodeId id) {
        Scope scope;
        return eval(id, scope);
    }
    double number(ir::NodeId id) { return (*this)(id).value[0]; }
    Value evaluated(ir::NodeId id, const std::vector<std::pair<ir::NodeId, Value>> &variables) {
        Scope scope(variables.begin(), variables.end());
        return eval(id, scope);
    }

    Value call(ir::FunctionId id, const std::vector<Value> &args) {
        const ir::Function &function = graph_.function(id);
        Scope scope;
        for (std::size_t i = 0; i < args.size(); ++i) scope[function.params.at(i)] = args[i];
        return eval(function.result, scope);
    }
    static Value vec3(std::array<double, 3> v) { return {ir::Type::Vec3, {v[0], v[1], v[2]}}; }

    double distance(std::array<double, 3> p) { return call(scene_->distance, {vec3(p)}).value[0]; }
    ReferenceHit hit(std::array<double, 3> p) {
        const Value v = call(scene_->hit, {vec3(p)});
        return {v.value[0],
                static_cast<int>(v.value[1]),
                {v.value[2], v.value[3], v.value[4]},
                {v.value[5], v.value[6], v.value[7], v.value[8]}};
    }
    // The diffuse colour of what decides at p.
    std::array<double, 3> diffuse(std::array<double, 3> p, std::array<double, 3> n = {0, 1, 0}) {
        const ReferenceHit h = hit(p);
        const ir::Surface &s = h.paint < 0 ? scene_->surfaces.back()
                                           : scene_->surfaces.at(static_cast<std::size_t>(h.paint));
        Scope scope;
        scope[s.point] = vec3(h.point);
        scope[s.normal] = vec3(n);
        scope[s.extra] = {ir::Type::Vec4, {h.extra[0], h.extra[1], h.extra[2], h.extra[3]}};
        const Value v = eval(s.diffuse, scope);
        return {v.value[0], v.value[1], v.value[2]};
    }

  private:
    static Value of(ir::Type type, std::initializer_list<double> numbers) {
        Value v{type, {}};
        std::copy(numbers.begin(), numbers.end(), v.value.begin());
        return v;
    }

    Value eval(ir::NodeId id, Scope &scope) {
        if (const auto it = scope.find(id); it != scope.end()) return it->second;
        ++evaluations;
        const Value v = compute(id, scope);
        scope[id] = v;
        return v;
    }

    Value compute(ir::NodeId id, Scope &scope) {
        using ir::Op;
        const ir::Node &node = graph_[id];
        if (node.op == Op::Const) return graph_.constant_of(id);
        if (node.op == Op::Point)
            return {node.type, {point[0], point[1], node.type == ir::Type::Vec2 ? 0 : point[2]}};
        if (node.op == Op::Normal) return vec3(normal);
        if (node.op == Op::Direction) return vec3(direction);
        if (node.op == Op::Time) return of(node.type, {time});
        if (node.op == Op::Param) return param(node);
        if (node.op == Op::Var) throw std::logic_error("an unbound variable");
        if (node.op ==
            Op::Select) // only the arm that counts, so that tests may ask about the other
            return eval(graph_.arg(id, eval(graph_.arg(id, 0), scope).value[0] != 0 ? 1 : 2),
                        scope);

        std::vector<Value> args;
        for (ir::NodeId arg : graph_.args(id)) args.push_back(eval(arg, scope));
        if (node.op == Op::Call) return call(ir::FunctionId{std::size_t{node.payload}}, args);
        if (node.op == Op::Cached)
            return call(graph_.cache(ir::CacheId{std::size_t{node.payload}}).field, args);
        if (node.op == Op::Loop) return loop(node, args, scope).front();
        if (node.op == Op::LoopResult) {
            const ir::NodeId of_fold = graph_.arg(id, 0);
            std::vector<Value> start;
            for (ir::NodeId arg : graph_.args(of_fold)) start.push_back(eval(arg, scope));
            return loop(graph_[of_fold], start, scope).at(node.payload);
        }
        if (node.op == Op::TableRead) return table(node, args[0].value[0]);
        if (node.op == Op::Image) return image(node, args[0]);
        if (node.op == Op::Grid) return grid(node, args[0]);
        if (node.type == ir::Type::Hit || (graph_[graph_.arg(id, 0)].type == ir::Type::Hit))
            return hit_op(node, args);
        const auto v = ir::evaluate(node.op, node.type, args, node.payload);
        if (!v) throw std::logic_error("an op without a value");
        return *v;
    }

    Value param(const ir::Node &node) const {
        Value v{node.type, {}};
        const auto &from = node.payload < params.size() ? params[node.payload]
                                                        : scene_->params.at(node.payload).value;
        std::copy(from.begin(), from.end(), v.value.begin());
        return v;
    }

    std::vector<Value> loop(const ir::Node &node, std::vector<Value> values, Scope &outer) {
        const ir::Loop &loop = graph_.loop(ir::LoopId{std::size_t{node.payload}});
        const int count = static_cast<int>(eval(loop.count, outer).value[0]);
        // Inside, only what was bound outside is kept: everything else may depend on the loop's
        // variables.
        Scope bound;
        for (const auto &[id, value] : outer)
            if (graph_[id].op == ir::Op::Var) bound[id] = value;
        for (int i = 0; i < std::min(count, loop.max_count); ++i) {
            Scope scope = bound;
            scope[loop.index] = of(ir::Type::Int, {double(i)});
            for (std::size_t k = 0; k < values.size(); ++k) scope[loop.vars[k]] = values[k];
            if (loop.condition && eval(loop.condition, scope).value[0] == 0) break;
            std::vector<Value> next;
            for (ir::NodeId id : loop.next) next.push_back(eval(id, scope));
            values = std::move(next);
        }
        return values;
    }

    Value table(const ir::Node &node, double row) const {
        const ir::Table &table = graph_.table(ir::table_of(node.payload));
        const int at = std::clamp(static_cast<int>(row), 0, table.rows - 1);
        Value v{node.type, {}};
        for (int i = 0; i < ir::components(node.type); ++i)
            v.value[static_cast<std::size_t>(i)] = table.data[static_cast<std::size_t>(
                at * table.stride + ir::column_of(node.payload) + i)];
        return v;
    }

    // Texel centres at (i + 1/2)/size, repeated; rows run downward, v upward.
    Value image(const ir::Node &node, const Value &uv) const {
        const ir::ImageData &image = scene_->images.at(node.payload);
        const double x = uv.value[0] * image.width - 0.5, y = -uv.value[1] * image.height - 0.5;
        const double fx = x - std::floor(x), fy = y - std::floor(y);
        Value v{ir::Type::Vec4, {}};
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const auto wrap = [](double a, int n) {
                    return static_cast<int>(a - n * std::floor(a / n));
                };
                const int tx = wrap(std::floor(x) + i, image.width),
                          ty = wrap(std::floor(y) + j, image.height);
                const double w = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
                for (std::size_t c = 0; c < 4; ++c)
                    v.value[c] +=
                        w * image.rgba[static_cast<std::size_t>(ty * image.width + tx) * 4 + c];
            }
        return v;
    }

    // Samples at 0, 1/(n-1), …, 1 along each axis, clamped.
    Value grid(const ir::Node &node, const Value &p) const {
        const ir::GridData &grid = scene_->grids.at(node.payload);
        std::array<int, 3> low{};
        std::array<double, 3> t{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double x = std::clamp(p.value[i], 0.0, 1.0) * (grid.size[i] - 1);
            low[i] = std::clamp(static_cast<int>(std::floor(x)), 0, std::max(grid.size[i] - 2, 0));
            t[i] = x - low[i];
        }
        Value v{ir::Type::Float, {}};
        for (int k = 0; k < 8; ++k) {
            double w = 1;
            std::array<int, 3> at{};
            for (int i = 0; i < 3; ++i) {
                const auto u = static_cast<std::size_t>(i);
                const int up = k >> i & 1;
                w *= up ? t[u] : 1 - t[u];
                at[u] = std::min(low[u] + up, grid.size[u] - 1);
            }
            v.value[0] += w * grid.values[static_cast<std::size_t>(
                                  (at[2] * grid.size[1] + at[1]) * grid.size[0] + at[0])];
        }
        return v;
    }

    static Value hit_op(const ir::Node &node, const std::vector<Value> &a) {
        using ir::Op;
        Value v = a[0];
        if (node.op == Op::HitDistance) return of(node.type, {v.value[0]});
        if (node.op == Op::HitPaint) return of(node.type, {v.value[1]});
        if (node.op == Op::HitPoint) return of(node.type, {v.value[2], v.value[3], v.value[4]});
        if (node.op == Op::HitExtra)
            return of(node.type, {v.value[5], v.value[6], v.value[7], v.value[8]});
        const auto with_paint = [&](std::size_t first) {
            v.value[1] = a[first].value[0];
            for (std::size_t i = 0; i < 3; ++i) v.value[2 + i] = a[first + 1].value[i];
            for (std::size_t i = 0; i < 4; ++i) v.value[5 + i] = a[first + 2].value[i];
        };
        v.type = ir::Type::Hit;
        if (node.op == Op::MakeHit) with_paint(1);
        if (node.op == Op::FillPaint && v.value[1] < 0) with_paint(1);
        if (node.op == Op::HitWith) v.value[0] = a[1].value[0];
        if (node.op == Op::NearestHit)
            for (const Value &other : a)
                if (other.value[0] < v.value[0]) v = other;
        if (node.op == Op::FarthestHit) {
            for (const Value &other : a)
                if (other.value[0] > v.value[0]) v = other;
            if (v.value[1] < 0) // an unpainted subtrahend shows the minuend's paint
                for (std::size_t i = 1; i < 9; ++i) v.value[i] = a[0].value[i];
        }
        return v;
    }

    const ir::Scene *scene_ = nullptr;
    const ir::Graph &graph_;
};

} // namespace fathom::test
