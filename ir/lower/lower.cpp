// Shapes to functions: the driver, functions for what is shared, and the frames in which shapes are
// evaluated.
#include "ir/lower/lowering.h"
#include "ir/passes/walk.h"
#include "ir/view.h"

#include <algorithm>
#include <cassert>
#include <unordered_set>

namespace fathom::ir {
namespace {

// A shape that is evaluated in several places becomes a function when it is more than this many
// operations.
constexpr double cheap = 8;
constexpr double plenty = 1e6; // where counts saturate

const char *suffix(Reading reading) {
    switch (reading) {
    case Reading::Raw: return "";
    case Reading::Marched: return "_marched";
    case Reading::Hit: return "_hit";
    case Reading::SafeRadius: return "_reach";
    case Reading::Shaded: return "_shaded";
    }
    return "";
}

double operations_below(const Graph &graph, std::span<const NodeId> roots) {
    std::unordered_set<NodeId> seen;
    std::vector<NodeId> stack(roots.begin(), roots.end());
    double count = 0;
    while (!stack.empty()) {
        const NodeId id = stack.back();
        stack.pop_back();
        if (graph[id].count == 0 || !seen.insert(id).second) continue;
        ++count;
        if (graph[id].op == Op::Loop) {
            const Loop &loop = graph.loop(LoopId{std::size_t{graph[id].payload}});
            stack.insert(stack.end(), loop.next.begin(), loop.next.end());
            count += 8; // a loop is never cheap
        }
        const std::span<const NodeId> args = graph.args(id);
        stack.insert(stack.end(), args.begin(), args.end());
    }
    return count;
}

} // namespace

bool is_transparent(const Shape &shape, const Shapes &shapes) {
    if (shape.kind == ShapeKind::Library) return !shapes.libraries[shape.payload].has_claims;
    return is_one_of(shape.kind,
                     {ShapeKind::Paint, ShapeKind::Repaint, ShapeKind::Mixed, ShapeKind::Contract});
}

namespace {

void region_numbers(const Region &region, std::vector<NodeId> &out) {
    if (region.center) out.push_back(region.center);
    if (region.size) out.push_back(region.size);
    for (const Region &less : region.less) region_numbers(less, out);
}

} // namespace

void lower(Scene &scene) { Lowering(scene).run(); }

Lowering::Lowering(Scene &scene) : scene_(scene), graph_(scene.graph), shapes_(scene.shapes) {
    assert(scene.facts.size() >= scene.shapes.size());
    p2_ = graph_.fresh_var(Type::Vec2);
    p3_ = graph_.fresh_var(Type::Vec3);
}

void Lowering::look_over() {
    find_parts();
    count_uses();
    find_names();
    find_free_vars();
    find_curved();
    find_shaded();
}

void Lowering::run() {
    scene_.surfaces.clear();
    look_over();
    const Where frame{p3_, 0};
    const NodeId distance = expression_of(Reading::Marched, scene_.root, frame);
    scene_.distance = graph_.add_function({"scene_distance", {}, {p3_}, distance});
    const NodeId hit = expression_of(Reading::Hit, scene_.root, frame);
    scene_.hit = graph_.add_function({"scene_hit", {}, {p3_}, hit});
    scene_.safe_radius = {};
    if (curved_[scene_.root.index]) {
        const NodeId reach = expression_of(Reading::SafeRadius, scene_.root, frame);
        scene_.safe_radius = graph_.add_function({"scene_reach", {}, {p3_}, reach});
    }

    scene_.films = may_have_films();
    scene_.exact = fact(scene_.root).exact_outside;
    scene_.unit_slope = scene_.exact || unit_slope_[scene_.root.index] != 0;
    scene_.shaded = scene_.distance;
    if (shaded_apart_[scene_.root.index]) {
        const NodeId shaded = expression_of(Reading::Shaded, scene_.root, frame);
        scene_.shaded = graph_.add_function({"scene_shaded", {}, {p3_}, shaded});
    }

    add_endless(frame);
    add_framed(frame);

    Surface plain =
        blank_surface(); // what nobody painted: the gray of sRGB 0.7, with a white highlight
    const double gray = 0.448;
    plain.diffuse = graph_.vec3(gray, gray, gray);
    plain.specular = graph_.vec3(1, 1, 1);
    plain.exponent = graph_.number(32);
    plain.emission = graph_.vec3(0, 0, 0);
    scene_.surfaces.push_back(plain);

    const NodeId direction = graph_.fresh_var(Type::Vec3);
    const NodeId background = scene_.background ? scene_.background : graph_.vec3(0.6, 0.7, 0.8);
    Substitution map{
        {graph_.make(Op::Direction, Type::Vec3, std::span<const NodeId>{}), direction}};
    scene_.background_function =
        graph_.add_function({"background", {}, {direction}, substitute(graph_, background, map)});
    find_extent(scene_);
}

// -- what is known before

// Children come before their parents in Shapes, so one pass up gives the costs, one down the uses.
void Lowering::count_uses() {
    const std::size_t n = shapes_.size();
    cost_.assign(n, 0);
    uses_.assign(n, 0);
    paint_.assign(n, 0);
    reached_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        const Shape &s = shape(ShapeId{i});
        double cost = operations_below(graph_, s.args) + (is_transparent(s, shapes_) ? 0 : 1);
        if (s.kind == ShapeKind::Repeat) cost += 8;
        if (s.kind == ShapeKind::Instances) cost += 8;
        if (s.kind == ShapeKind::Within) cost += 8;
        bool paint = s.kind == ShapeKind::Paint || s.kind == ShapeKind::Repaint;
        for (ShapeId child : s.children) {
            assert(child.index < i);
            cost += cost_[child.index];
            paint |= paint_[child.index] != 0 || part_[child.index] != 0;
        }
        cost_[i] = std::min(cost, plenty);
        paint_[i] = paint;
    }
    uses_[scene_.root.index] = 1;
    reached_[scene_.root.index] = 1;
    for (std::size_t i = scene_.root.index + 1; i-- > 0;) {
        if (!reached_[i]) continue;
        const Shape &s = shape(ShapeId{i});
        const double own = shared(ShapeId{i}) ? 1 : uses_[i];
        const double times = s.kind == ShapeKind::Repeat ? copies_evaluated(scene_, ShapeId{i}) : 1;
        for (ShapeId child : s.children) {
            uses_[child.index] = std::min(uses_[child.index] + own * times, plenty);
            reached_[child.index] = 1;
        }
    }
}

bool Lowering::shared(ShapeId id) const {
    return uses_[id.index] > 1 && cost_[id.index] >= cheap && !is_transparent(shape(id), shapes_);
}

// A function is called after the library shape that it is, or what was done to which:
// "twisted_box".
void Lowering::find_names() {
    const auto done = [](const Shape &s) -> const char * {
        switch (s.kind) {
        case ShapeKind::Map:
            switch (s.map) {
            case MapKind::Translate: return "moved";
            case MapKind::Rotate: return "turned";
            case MapKind::Scale: return "scaled";
            case MapKind::MirrorFold: return "folded";
            case MapKind::Revolve: return "revolved";
            case MapKind::Twist: return "twisted";
            case MapKind::Bend: return "bent";
            case MapKind::Taper: return "tapered";
            case MapKind::Distort: return "distorted";
            }
            return "";
        case ShapeKind::Complement: return "inverted";
        case ShapeKind::Offset: return "offset";
        case ShapeKind::Shell: return "hollow";
        case ShapeKind::Displace: return "displaced";
        case ShapeKind::Extrude: return "extruded";
        case ShapeKind::Repeat: return "repeated";
        case ShapeKind::Within: return "cut";
        case ShapeKind::Instances: return "many";
        case ShapeKind::Empty:
        case ShapeKind::Leaf:
        case ShapeKind::Union:
        case ShapeKind::Intersection:
        case ShapeKind::Xor:
        case ShapeKind::Blend:
        case ShapeKind::Seam:
        case ShapeKind::Lerp:
        case ShapeKind::PseudoNorm:
        case ShapeKind::Paint:
        case ShapeKind::Repaint:
        case ShapeKind::Mixed:
        case ShapeKind::Library:
        case ShapeKind::Contract: return "";
        }
        return "";
    };
    names_.assign(shapes_.size(), "");
    std::vector<std::string> nouns(shapes_.size());
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
        const Shape &s = shape(ShapeId{i});
        const std::string participle = done(s);
        const bool wraps = !participle.empty() || is_transparent(s, shapes_);
        if (s.kind == ShapeKind::Library)
            nouns[i] = shapes_.libraries[s.payload].name;
        else if (wraps && !s.children.empty())
            nouns[i] = nouns[s.children.front().index];
        else
            nouns[i] = shape_kind_name(s.kind);
        names_[i] = participle.empty() ? nouns[i] : participle + "_" + nouns[i];
    }
    // What stands for a library shape that claims nothing is called like it.
    for (std::size_t i = shapes_.size(); i-- > 0;) {
        const Shape &s = shape(ShapeId{i});
        if (s.kind == ShapeKind::Library && is_transparent(s, shapes_))
            names_[s.children.front().index] = nouns[i];
    }
}

void Lowering::find_free_vars() {
    free_vars_.assign(shapes_.size(), {});
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
        const Shape &s = shape(ShapeId{i});
        std::vector<NodeId> expressions = s.args;
        NodeId bound;
        if (s.kind == ShapeKind::Within) region_numbers(shapes_.regions[s.payload], expressions);
        if (s.kind == ShapeKind::Paint || s.kind == ShapeKind::Repaint) {
            const Material &m = shapes_.materials[s.payload];
            expressions.insert(expressions.end(), {m.diffuse, m.specular, m.exponent, m.emission});
        }
        if (s.kind == ShapeKind::Repeat) bound = shapes_.repetitions[s.payload].id;
        if (s.kind == ShapeKind::Instances) bound = shapes_.instance_tables[s.payload].index;
        std::vector<NodeId> &free = free_vars_[i];
        for (NodeId expression : expressions)
            if (graph_.reads(expression).free_vars)
                for (NodeId var : graph_.free_vars(expression)) free.push_back(var);
        for (ShapeId child : s.children)
            for (NodeId var : free_vars_[child.index])
                if (var != bound) free.push_back(var);
        std::sort(free.begin(), free.end());
        free.erase(std::unique(free.begin(), free.end()), free.end());
    }
}

// -- evaluating shapes

// Whether a reading of the shape is made from another function at once, so that one of its own
// would only call that.
bool Lowering::is_wrapper(Reading reading, ShapeId id) const {
    if (reading == Reading::Raw) return false;
    if (reading == Reading::SafeRadius) return !curved_[id.index];
    const bool distance = reading == Reading::Marched || reading == Reading::Shaded;
    if (fact(id).guard && distance) return false;
    if (reading == Reading::Hit && !paint_[id.index]) return true;
    return distance && !passes_through(id) && shape(id).kind != ShapeKind::Within;
}

NodeId Lowering::expression_of(Reading reading, ShapeId id, Where frame) {
    if (reading == Reading::Shaded && !shaded_apart_[id.index]) reading = Reading::Marched;
    const auto key = std::make_tuple(reading, id, frame.p, frame.values);
    if (const auto it = answers_.find(key); it != answers_.end()) return it->second;
    NodeId result;
    if (shared(id) && !is_wrapper(reading, id)) {
        const FunctionId callee = function(reading, id);
        std::vector<NodeId> args{frame.p};
        for (NodeId var : free_vars_[id.index]) args.push_back(value_of(var, frame));
        result = graph_.call(callee, args);
    } else {
        result = answer(reading, id, frame);
    }
    answers_.emplace(key, result);
    return result;
}

FunctionId Lowering::function(Reading reading, ShapeId id) {
    const auto key = std::make_pair(reading, id);
    if (const auto it = functions_.find(key); it != functions_.end()) return it->second;
    const NodeId p = shape(id).dims == 2 ? p2_ : p3_;
    const NodeId body = answer(reading, id, {p, 0});
    std::vector<NodeId> params{p};
    params.insert(params.end(), free_vars_[id.index].begin(), free_vars_[id.index].end());
    const FunctionId made =
        graph_.add_function({names_[id.index] + suffix(reading), shape(id).origin, params, body});
    functions_.emplace(key, made);
    return made;
}

// -- frames

NodeId Lowering::value_of(NodeId var, Where frame) const {
    const Substitution &values = environments_[frame.values];
    const auto it = values.find(var);
    return it == values.end() ? var : it->second;
}

NodeId Lowering::read(NodeId expression, Where frame) {
    const Graph::Reads reads = graph_.reads(expression);
    if (!reads.point && (!reads.free_vars || frame.values == 0)) return expression;
    Substitution map = environments_[frame.values];
    map[graph_.point(graph_.type(frame.p))] = frame.p;
    return substitute(graph_, expression, map);
}

Where Lowering::bind(Where frame, NodeId var, NodeId value) {
    if (!var) return frame;
    const auto [it, added] = derived_.try_emplace({frame.values, var, value}, 0);
    if (added) {
        it->second = static_cast<std::uint32_t>(environments_.size());
        Substitution values = environments_[frame.values];
        values[var] = value;
        environments_.push_back(std::move(values));
    }
    return {frame.p, it->second};
}

// -- what goes on beyond the rest

void Lowering::add_endless(Where frame) {
    scene_.endless = scene_.endless_hit = {};
    std::vector<NodeId> distances, hits;
    for (const TopLevel &part : scene_.top_level) {
        if (fact(part.shape).bounds.finite()) continue;
        distances.push_back(expression_of(Reading::Marched, part.shape, frame));
        hits.push_back(expression_of(Reading::Hit, part.shape, frame));
    }
    if (hits.empty() || hits.size() == scene_.top_level.size()) return;
    scene_.endless = graph_.add_function(
        {"scene_endless", {}, {p3_}, graph_.make(Op::Union, Type::Float, distances)});
    scene_.endless_hit = graph_.add_function(
        {"scene_endless_hit", {}, {p3_}, graph_.make(Op::NearestHit, Type::Hit, hits)});
}

} // namespace fathom::ir
