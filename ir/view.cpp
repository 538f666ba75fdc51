// See view.h. Values of closed expressions come from ir/passes/fold.h, which is the ops' meaning in
// double.
#include "ir/view.h"

#include "ir/passes/fold.h"
#include "ir/shading.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <unordered_map>

namespace fathom::ir {

namespace {

// Walks an expression and keeps what it has computed. Variables of functions and loops live in
// `env_`; what was computed under them is forgotten when they change.
class Evaluator {
  public:
    Evaluator(const Scene &scene, double time) : scene_(scene), graph_(scene.graph), time_(time) {}

    Constant value(NodeId id) {
        if (auto known = values_.find(id); known != values_.end()) return known->second;
        const Constant result = compute(id);
        values_.insert_or_assign(id, result);
        return result;
    }

  private:
    Constant compute(NodeId id) {
        const Node &node = graph_[id];
        if (node.op == Op::Const) return graph_.constant_of(id);
        if (node.op == Op::Time) return {node.type, {time_}};
        if (node.op == Op::Param) {
            Constant result{node.type, {}};
            std::ranges::copy(scene_.params[node.payload].value, result.value.begin());
            return result;
        }
        if (node.op == Op::Loop) return loop(id)[0];
        if (node.op == Op::LoopResult) return loop(graph_.arg(id, 0))[node.payload];
        if (node.op == Op::TableRead) return row(id);
        std::vector<Constant> args;
        for (NodeId arg : graph_.args(id)) args.push_back(value(arg));
        if (node.op == Op::Call) {
            const Function &function = graph_.function(FunctionId{node.payload});
            return in_scope(function.params, args,
                            [&](Evaluator &inner) { return inner.value(function.result); });
        }
        const std::optional<Constant> result = evaluate(node.op, node.type, args, node.payload);
        assert(result && "a closed expression is made of ops that have a value");
        return result.value_or(Constant{node.type, {}});
    }

    template <class F>
    Constant in_scope(std::span<const NodeId> vars, std::span<const Constant> args, F run) {
        Evaluator inner(scene_, time_);
        for (std::size_t i = 0; i < vars.size(); ++i) inner.values_[vars[i]] = args[i];
        return run(inner);
    }

    std::vector<Constant> loop(NodeId id) {
        const Loop &loop = graph_.loop(LoopId{graph_[id].payload});
        std::vector<Constant> now;
        for (NodeId arg : graph_.args(id)) now.push_back(value(arg));
        const int count = static_cast<int>(value(loop.count).value[0]);
        for (int i = 0; i < count; ++i) {
            Evaluator iteration(scene_, time_);
            for (NodeId var : graph_.free_vars(id))
                if (auto known = values_.find(var); known != values_.end())
                    iteration.values_[var] = known->second;
            iteration.values_[loop.index] = {Type::Int, {static_cast<double>(i)}};
            for (std::size_t k = 0; k < now.size(); ++k) iteration.values_[loop.vars[k]] = now[k];
            if (loop.condition && iteration.value(loop.condition).value[0] == 0) break;
            std::vector<Constant> next;
            for (NodeId n : loop.next) next.push_back(iteration.value(n));
            now = std::move(next);
        }
        return now;
    }

    Constant row(NodeId id) {
        const Node &node = graph_[id];
        const Table &table = graph_.table(table_of(node.payload));
        const int at = std::clamp(static_cast<int>(value(graph_.arg(id, 0)).value[0]), 0,
                                  std::max(table.rows - 1, 0));
        Constant result{node.type, {}};
        for (int i = 0; i < components(node.type); ++i)
            result.value[static_cast<std::size_t>(i)] = table.data[static_cast<std::size_t>(
                at * table.stride + column_of(node.payload) + i)];
        return result;
    }

    const Scene &scene_;
    const Graph &graph_;
    double time_;
    std::unordered_map<NodeId, Constant> values_;
};

glm::dvec3 vec_of(const std::array<double, 3> &a) { return {a[0], a[1], a[2]}; }
// Not glm::normalize, whose last bit differs, and which has no answer for 0.
glm::dvec3 normalized(glm::dvec3 a, glm::dvec3 otherwise) {
    const double size = glm::length(a);
    return size > 0 ? a * (1 / size) : otherwise;
}

glm::dvec3 triple_of(const Scene &scene, NodeId id, double time) {
    const std::array<double, 16> v = value_of(scene, id, time);
    return {v[0], v[1], v[2]};
}

constexpr double default_fov = std::numbers::pi / 4;

// The bounding sphere of the finite parts' box; radius 1 about the origin where nothing is finite.
std::pair<glm::dvec3, double> sphere_of(const Box &box) {
    if (!box.finite()) return {{0, 0, 0}, 1};
    const glm::dvec3 lo = vec_of(box.lo), hi = vec_of(box.hi), middle = (lo + hi) * 0.5;
    const double radius = 0.5 * glm::length(hi - lo);
    return {middle, radius > 0 ? radius : 1};
}

// Without a camera the solid fills this part of the picture's height or of its width; of a picture that
// is wider than 4:3, of the middle that is 4:3. The planes through the viewer that it touches then lean
// by `square_slope` above and below, and by that times width/height at the sides. How far a solid
// reaches along `side - slope*forward` is a convex function of the slope: between two of `widths` it
// is at most what the chord has.
constexpr double filled = 0.9;
const double square_slope = filled * std::tan(default_fov / 2);
constexpr std::array<double, 3> widths{0, 1, 4.0 / 3};

View default_view() { return look_at({3, 3, 5}, {0, 0, 0}, std::tan(default_fov / 2), false); }

// At a width, of a side's reach at each of `widths`.
double on_chord(const double *reach, double width) {
    std::size_t k = 1;
    while (k + 1 < widths.size() && width > widths[k]) ++k;
    const double t = (width - widths[k - 1]) / (widths[k] - widths[k - 1]);
    return (1 - t) * reach[k - 1] + t * reach[k];
}

// As near as what reaches so far along framing_directions() fits; between those sides of the picture
// that leave it more room than it needs, in the middle.
View fitted(View view, std::span<const double> reach, const Box &box, double aspect) {
    const double width = std::min(aspect, widths.back());
    const double right = on_chord(&reach[0], width), left = on_chord(&reach[widths.size()], width),
                 up = reach[2 * widths.size()], down = reach[2 * widths.size() + 1];
    const double half = 0.5 * std::max(up + down, (right + left) / width);
    const auto [center, radius] = sphere_of(box);
    const double middle = glm::dot(center, view.forward);
    view.focus = std::max(middle + half / square_slope, 1e-3 * radius);
    view.origin = 0.5 * (right - left) * view.right + 0.5 * (up - down) * view.up +
                  (middle - view.focus) * view.forward;
    return view;
}

// The box; a cube where nothing has an end, or all of it is one point.
Box with_size(const Box &box) {
    if (box.finite() && box.lo != box.hi) return box;
    Box cube{{-1, -1, -1}, {1, 1, 1}};
    for (std::size_t i = 0; i < 3 && box.finite(); ++i)
        cube.lo[i] += box.lo[i], cube.hi[i] += box.lo[i];
    return cube;
}

// Along each of framing_directions(): of the solid, where that was looked for; else of its box.
std::vector<double> reach_of(const Scene &scene, const Box &box) {
    std::vector<double> reach;
    for (const std::array<double, 3> &way : framing_directions()) {
        const double known = reach_of(box, way);
        const bool looked_for = reach.size() < scene.framed_reach.size();
        reach.push_back(looked_for ? std::min(known, scene.framed_reach[reach.size()]) : known);
    }
    return reach;
}

} // namespace

double reach_of(const Box &box, const std::array<double, 3> &direction) {
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i)
        reach += direction[i] * (direction[i] > 0 ? box.hi[i] : box.lo[i]);
    return reach;
}

std::vector<std::array<double, 3>> framing_directions() {
    const View view = default_view();
    std::vector<std::array<double, 3>> all;
    const auto add = [&](const glm::dvec3 &way) { all.push_back({way.x, way.y, way.z}); };
    const glm::dvec3 back = -square_slope * view.forward;
    for (const glm::dvec3 &side : {view.right, -view.right})
        for (const double width : widths) add(side + width * back);
    add(view.up + back);
    add(-view.up + back);
    return all;
}

std::array<double, 16> value_of(const Scene &scene, NodeId id, double time) {
    if (!id) return {};
    return Evaluator(scene, time).value(id).value;
}

void find_extent(Scene &scene) {
    scene.bounds = scene.extent = Box{};
    for (const TopLevel &part : scene.top_level) {
        const ShapeFact &fact = scene.facts[part.shape.index];
        if (fact.bounds.finite()) scene.bounds = hull(scene.bounds, fact.bounds);
        scene.extent = hull(scene.extent, fact.bounded);
    }
    if (scene.render.far > 0) {
        scene.far = scene.render.far;
        return;
    }
    const auto [center, radius] = sphere_of(scene.extent);
    // Without a camera the framing stands where 45 degrees hold the parts.
    double distance = radius / std::sin(default_fov / 2);
    if (scene.camera.given) distance = glm::length(triple_of(scene, scene.camera.at, 0) - center);
    scene.far = 100 * std::max(radius, distance);
}

View look_at(glm::dvec3 position, glm::dvec3 target, double extent, bool orthographic) {
    View view;
    view.origin = position;
    view.extent = extent;
    view.orthographic = orthographic;
    const glm::dvec3 way = target - position;
    view.focus = glm::length(way) > 0 ? glm::length(way) : 1;
    view.forward = normalized(way, {0, 0, -1});
    const bool vertical = std::abs(view.forward[1]) > 1 - 1e-9;
    const glm::dvec3 up =
        vertical ? glm::dvec3{0, 0, view.forward[1] > 0 ? 1.0 : -1.0} : glm::dvec3{0, 1, 0};
    view.right = normalized(glm::cross(view.forward, up), {1, 0, 0});
    view.up = glm::cross(view.right, view.forward);
    return view;
}

View turned(View view, double around, double above, double distance) {
    const glm::dvec3 target = view.origin + view.focus * view.forward;
    constexpr double up = std::numbers::pi / 2;
    const double from = std::asin(std::clamp(-view.forward.y, -1.0, 1.0));
    above = std::clamp(from + above, -up, up) - from;
    const double ca = std::cos(around), sa = std::sin(around);
    const auto about_y = [&](const glm::dvec3 &v) {
        return glm::dvec3{ca * v.x + sa * v.z, v.y, ca * v.z - sa * v.x};
    };
    const double cb = std::cos(above), sb = std::sin(above);
    const glm::dvec3 forward = cb * view.forward - sb * view.up;
    view.up = about_y(cb * view.up + sb * view.forward);
    view.forward = about_y(forward);
    view.right = about_y(view.right);
    view.focus *= distance;
    if (view.orthographic) view.extent *= distance;
    view.origin = target - view.focus * view.forward;
    return view;
}

View view_of(const Scene &scene, double time, double aspect) {
    const Camera &camera = scene.camera;
    if (!camera.given) {
        const Box box = with_size(scene.framed.empty() ? scene.extent : scene.framed);
        return fitted(default_view(), reach_of(scene, box), box, aspect);
    }
    const glm::dvec3 at = triple_of(scene, camera.at, time),
                     target = triple_of(scene, camera.look_at, time);
    const double fov = camera.fov ? value_of(scene, camera.fov, time)[0] : default_fov;
    const double extent = std::tan(std::clamp(fov, 1e-4, std::numbers::pi - 1e-4) / 2);
    View view = look_at(at, target, extent, camera.orthographic);
    if (view.orthographic)
        view.extent *= view.focus; // shows what the perspective camera would, at the target
    return view;
}

std::array<double, 2> sample_offset(int k) {
    // The plastic number g is the real root of g^3 = g + 1; the steps are 1/g and 1/g^2.
    constexpr double a = 0.75487766624669276, b = 0.56984029099805327;
    const double x = 0.5 + a * k, y = 0.5 + b * k;
    return {x - std::floor(x), y - std::floor(y)};
}

Frame frame_of(const Scene &scene, const View &view, int height) {
    Frame frame;
    const auto [center, radius] = sphere_of(scene.extent);
    frame.center = center;
    frame.radius = radius;
    frame.occlusion_reach =
        shading::occlusion_reach * view.extent * (view.orthographic ? 1 : view.focus);
    frame.slack = shading::float_slack * glm::length(view.origin);
    frame.pixel = 2 * view.extent / height;
    const double sharp = std::min(scene.render.epsilon *
                                      (view.orthographic ? view.extent / shading::usual_extent : 1),
                                  frame.pixel / 2);
    frame.tolerance_slope = view.orthographic ? 0 : sharp;
    frame.tolerance_base = (view.orthographic ? sharp : 0) + frame.slack;
    frame.far = scene.render.far > 0 ? scene.render.far
                                     : 100 * std::max(radius, glm::length(view.origin - center));
    const Box all = scene.root && scene.root.index < scene.facts.size()
                        ? scene.facts[scene.root.index].bounds
                        : Box::everything();
    frame.boxed = all.finite();
    if (frame.boxed) {
        frame.lo = vec_of(all.lo), frame.hi = vec_of(all.hi);
        // Not flush with flat faces, on which a ray would graze its own entry; and not so thin that
        // rays which pass a needle by less than a pixel are not found CLOSE (shading.h).
        for (int i = 0; i < 3; ++i) {
            const double half = (frame.hi[i] - frame.lo[i]) / 2,
                         margin = std::max(1e-3 * radius, 0.03 * radius - half);
            frame.lo[i] -= margin, frame.hi[i] += margin;
        }
    }
    frame.unit_slope = scene.unit_slope;
    frame.exact = scene.exact;
    double bound = 1;
    bool estimated = false;
    for (const ShapeFact &fact : scene.facts) {
        estimated = estimated || fact.status == ProofStatus::Estimated;
        if (std::isfinite(fact.lipschitz_sup)) bound = std::max(bound, fact.lipschitz_sup);
    }
    frame.estimate = estimated ? bound : 0;
    frame.films = scene.films && !estimated;
    return frame;
}

int budget_of(const Scene &scene) {
    return scene.render.max_steps > 0 ? scene.render.max_steps : shading::budget;
}

std::vector<LightValue> lights_of(const Scene &scene, double time, const View &view) {
    std::vector<LightValue> lights;
    for (const Light &light : scene.lights) {
        glm::dvec3 position = triple_of(scene, light.position, time);
        if (light.directional) position = normalized(position, {0, 1, 0});
        lights.push_back({light.directional, position, triple_of(scene, light.color, time)});
    }
    if (lights.empty()) {
        const glm::dvec3 towards = view.right * -0.5 + view.up * 0.8 + view.forward * -0.6;
        lights.push_back({true, normalized(towards, {0, 1, 0}), {1, 1, 1}});
    }
    return lights;
}

} // namespace fathom::ir
