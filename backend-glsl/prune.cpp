#include "backend-glsl/prune.h"

#include "backend-glsl/fill.h"
#include "backend-glsl/module.h"
#include "backend-glsl/slope.h"
#include "ir/passes/inline.h"
#include "ir/passes/walk.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_set>

namespace fathom::glsl {

using ir::Graph;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

// The distance of a hit's expression; none where it is not plain.
NodeId distance_of(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.type == Type::Float) return id;
    const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
    if (node.op == Op::MakeHit) return args[0];
    if (node.op == Op::HitWith) return args[1];
    if (node.op == Op::FillPaint) return distance_of(graph, args[0]);
    if (node.op == Op::Select) {
        const NodeId yes = distance_of(graph, args[1]), no = distance_of(graph, args[2]);
        return yes && no ? graph.make(Op::Select, {args[0], yes, no}) : NodeId{};
    }
    return {};
}

constexpr std::size_t most_written_out = 2000; // nodes of what is differentiated

// In diagonals of a cell.
constexpr double far_from = 0.625;  // a cell is far whose centre is farther from surfaces
constexpr double least_way = 0.125; // a shorter way ahead is none

class Planner {
  public:
    Planner(const ir::Scene &scene, const std::map<std::uint32_t, NodeId> &results)
        : plan_{scene, {}, {}}, graph_(plan_.scene.graph), results_(results) {
        point_ = graph_.fresh_var(Type::Vec3);
        row_ = graph_.fresh_var(Type::Int);
        acc_ = graph_.fresh_var(Type::Float);
    }

    PrunePlan run() {
        for (ir::FunctionId id : {plan_.scene.distance, plan_.scene.hit})
            if (id) look_through(id);
        return std::move(plan_);
    }

  private:
    // The loops of a function's own body, those apart whose record two of them share.
    void look_through(ir::FunctionId id) {
        const ir::Function &function = graph_.function(id);
        const auto other = results_.find(id.index);
        std::vector<NodeId> todo{other == results_.end() ? function.result : other->second}, loops;
        const NodeId point = function.params[0];
        std::unordered_set<NodeId> seen;
        std::map<std::uint32_t, int> uses;
        while (!todo.empty()) {
            const NodeId node = todo.back();
            todo.pop_back();
            if (!seen.insert(node).second) continue;
            todo.insert(todo.end(), graph_.args(node).begin(), graph_.args(node).end());
            if (graph_[node].op != Op::Fold) continue;
            loops.push_back(node);
            ++uses[graph_[node].payload];
        }
        std::ranges::sort(loops);
        for (NodeId loop : loops)
            if (uses[graph_[loop].payload] == 1) add(loop, point);
    }

    void add(NodeId loop, NodeId point) {
        const std::uint32_t record = graph_[loop].payload;
        const ir::Fold fold = graph_.fold(ir::FoldId{record});
        const auto count = graph_.as_number(fold.count);
        if (fold.vars.size() != 1 || fold.condition || !count || *count < least_pruned ||
            *count != fold.max_count)
            return;
        const NodeId next = fold.next[0];
        const Op op = graph_[next].op;
        const std::size_t first = op == Op::Blend ? 2 : 0;
        if (op != Op::Blend && op != Op::Union && op != Op::NearestHit) return;
        // Other profiles may be steeper than what they join.
        if (op == Op::Blend &&
            graph_[next].payload != static_cast<std::uint32_t>(ir::Profile::Smooth))
            return;
        const std::vector<NodeId> args(graph_.args(next).begin(), graph_.args(next).end());
        if (args.size() != first + 2 || args[first] != fold.vars[0]) return;

        const ir::Substitution plain{{point, point_}, {fold.index, row_}, {fold.vars[0], acc_}};
        const auto renamed = [&](NodeId id) { return id ? ir::substitute(graph_, id, plain) : id; };
        const NodeId value = renamed(distance_of(graph_, args[first + 1])),
                     start = renamed(distance_of(graph_, graph_.arg(loop, 0)));
        const NodeId radius = op == Op::Blend ? args[0] : graph_.number(0);
        if (!value || !start || !reads_only(value, {point_, row_}) ||
            !reads_only(start, {point_}) || !reads_only(radius, {}))
            return;
        NodeId joined = graph_.make(Op::Union, {acc_, value});
        if (op == Op::Blend) joined = renamed(next);
        if (!reads_only(joined, {point_, row_, acc_})) return;

        const auto key = std::make_tuple(value, start, joined);
        const auto [it, fresh] = known_.try_emplace(key, static_cast<int>(plan_.grids.size()));
        if (fresh) {
            PrunedLoop made;
            made.slope = slope(value);
            made.acc_slope = std::max(made.slope, slope(start));
            if (!(made.acc_slope <= steepest_pruned) || plan_.grids.size() >= most_grids) {
                it->second = -1;
                return;
            }
            made.blended = op == Op::Blend;
            made.rows = fold.max_count;
            made.value = graph_.add_function({"value", {}, {point_, row_}, value});
            made.start = graph_.add_function({"start", {}, {point_}, start});
            made.joined = graph_.add_function({"joined", {}, {acc_, point_, row_}, joined});
            made.radius = graph_.add_function({"radius", {}, {point_}, radius});
            plan_.grids.push_back(made);
        }
        if (it->second >= 0) plan_.loops[record] = {it->second, fold.max_count, point};
    }

    bool reads_only(NodeId id, std::initializer_list<NodeId> vars) const {
        const Graph::Reads reads = graph_.reads(id);
        if (reads.point || reads.normal || reads.direction) return false;
        return std::ranges::all_of(graph_.free_vars(id), [&](NodeId var) {
            return std::ranges::find(vars, var) != vars.end();
        });
    }

    double slope(NodeId id) {
        return slope_of(graph_, ir::without_calls(graph_, id, most_written_out).root, point_);
    }

    PrunePlan plan_;
    Graph &graph_;
    const std::map<std::uint32_t, NodeId> &results_;
    NodeId point_, row_, acc_;
    std::map<std::tuple<NodeId, NodeId, NodeId>, int> known_; // -1: cannot be pruned
};

constexpr const char *look_up_rows = R"(
// Which rows of a long loop can matter in which cell (docs/performance.md).
layout(std430, binding = 0) readonly buffer fathom_Cells { uvec2 fathom_cells[]; };
layout(std430, binding = 1) readonly buffer fathom_Rows { uint fathom_rows[]; };
uniform vec3 fathom_grid_lo, fathom_grid_size;
uniform int fathom_grid_side; // 0: no lists

vec3 fathom_place(vec3 p) {
    return (p - fathom_grid_lo) * (float(fathom_grid_side) / fathom_grid_size);
}

bool fathom_inside(vec3 place) {
    return all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(float(fathom_grid_side))));
}

// How far p is from all that has an end.
float fathom_off(vec3 p) {
    return length(max(max($LO - p, p - $HI), 0.0));
}

uvec2 fathom_list(vec3 p, int grid, uint rows) {
    vec3 place = fathom_place(p);
    if (!fathom_inside(place)) return uvec2(0u, rows);
    ivec3 c = ivec3(place);
    return fathom_cells[((grid * fathom_grid_side + c.z) * fathom_grid_side + c.y) * fathom_grid_side + c.x];
}
)";

constexpr const char *look_up_far = R"(
// How far the cells' centres are from all surfaces; 0 in a cell that holds some, or might.
layout(std430, binding = 2) readonly buffer fathom_Far { float fathom_far_cells[]; };

// How far back and ahead of p all is more than `margin` away from surfaces, by one ball that p is in.
vec2 fathom_clear(vec3 p, vec3 direction, float margin) {
    vec3 size = fathom_grid_size / float(fathom_grid_side);
    vec3 place = fathom_place(p);
    vec3 away = vec3(0.0);
    float radius;
    if (fathom_inside(place)) {
        ivec3 c = ivec3(place);
        away = p - (fathom_grid_lo + (vec3(c) + 0.5) * size);
        radius = fathom_far_cells[(c.z * fathom_grid_side + c.y) * fathom_grid_side + c.x];
    } else {
        radius = $OUTSIDE;
    }
    radius -= margin;
    float inside = radius * radius - dot(away, away);
    if (!(radius > 0.0 && inside > 0.0)) return vec2(0.0);
    float along = dot(away, direction);
    float half_chord = sqrt(along * along + inside);
    vec2 both = vec2(half_chord + along, half_chord - along);
    return both.y > $LEAST_WAY * length(size) ? both : vec2(0.0);
}
)";

constexpr const char *around_cells = R"(
bool fathom_exact = false;

bool fathom_outside(vec3 p) {
    return fathom_grid_side > 0 && !fathom_inside(fathom_place(p));
}

float sdf(vec3 p) {
    if (fathom_outside(p)) {
        float endless = fathom_endless(p);
        float off = fathom_off(p);
        if (endless <= off || !fathom_exact) return min(endless, off);
    }
    return fathom_all(p);
}

Hit $HIT(vec3 p) {
    if (fathom_outside(p) && fathom_endless(p) <= fathom_off(p)) return fathom_endless_hit(p);
    return fathom_all_hit(p);
}
)";

constexpr const char *make_far = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 2) writeonly buffer fathom_Far { float fathom_far_cells[]; };

void main() {
    int side = fathom_grid_side;
    int cell = int(gl_GlobalInvocationID.x);
    if (cell >= side * side * side) return;
    vec3 size = fathom_grid_size / float(side);
    vec3 center = fathom_grid_lo + (vec3(cell % side, cell / side % side, cell / (side * side)) + 0.5) * size;
    float extent = length(max(abs(fathom_grid_lo), abs(fathom_grid_lo + fathom_grid_size)));
    float d = $SDF(center);
    d -= 1e-5 * (extent + abs(d));
    fathom_far_cells[cell] = d > $FAR_FROM * length(size) ? d : 0.0;
}
)";

constexpr const char *kernel_head = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer fathom_Parents { uvec2 fathom_parents[]; };
layout(std430, binding = 1) readonly buffer fathom_Before { uint fathom_before[]; };
layout(std430, binding = 2) writeonly buffer fathom_Cells { uvec2 fathom_cells[]; };
layout(std430, binding = 3) writeonly buffer fathom_Rows { uint fathom_rows[]; };
layout(std430, binding = 4) buffer fathom_Total { uint fathom_total; };
uniform vec3 fathom_grid_lo, fathom_grid_size;
uniform int fathom_grid; // which of the scene's
uniform int fathom_grid_side, fathom_parent_side; // cells along an axis; 0: no parents, all rows
uniform uint fathom_room; // entries of fathom_rows

void main() {
    int side = fathom_grid_side;
    int cell = int(gl_GlobalInvocationID.x);
    if (cell >= side * side * side) return;
    ivec3 c = ivec3(cell % side, cell / side % side, cell / (side * side));
    vec3 size = fathom_grid_size / float(side);
    vec3 center = fathom_grid_lo + (vec3(c) + 0.5) * size;
    float extent = length(max(abs(fathom_grid_lo), abs(fathom_grid_lo + fathom_grid_size)));
    float reach = 0.501 * length(size) + 1e-6 * extent;
    uvec2 from = uvec2(0u, uint($ROWS));
    if (fathom_parent_side > 0) {
        ivec3 b = c * fathom_parent_side / side;
        from = fathom_parents[((fathom_grid * fathom_parent_side + b.z) * fathom_parent_side + b.y) *
                                  fathom_parent_side + b.x];
    }
    float margin = $SLOPES * reach + 1e-5 * extent;
    uint count = 0u;
)";

constexpr const char *kernel_least = R"(
    float least = $START(center);
    for (uint k = from.x; k < from.y; ++k) least = min(least, $VALUE(center, int(fathom_before[k])));
    float limit = least + margin + 1e-5 * abs(least);
    for (uint k = from.x; k < from.y; ++k) count += $VALUE(center, int(fathom_before[k])) > limit ? 0u : 1u;
    uint at = atomicAdd(fathom_total, count);
    fathom_cells[fathom_grid * side * side * side + cell] = uvec2(at, at + count);
    if (at + count < at || at + count > fathom_room) return;
    for (uint k = from.x; k < from.y; ++k) {
        uint row = fathom_before[k];
        if ($VALUE(center, int(row)) > limit) continue;
        fathom_rows[at] = row;
        ++at;
    }
}
)";

// The second time it begins with the last row before which nothing matters.
constexpr const char *kernel_blended = R"(
    margin += max($RADIUS(center), 0.0);
    uint begin = from.x, at = 0u, end = 0u;
    for (int turn = 0; turn < 2; ++turn) {
        float acc = $START(center);
        uint last = begin;
        for (uint k = begin; k < from.y; ++k) {
            uint row = fathom_before[k];
            float v = $VALUE(center, int(row));
            float apart = margin + 1e-5 * (abs(acc) + abs(v));
            if (v - acc >= apart) continue;
            if (turn == 0 && acc - v >= apart) {
                count = 0u;
                last = k;
            }
            acc = $JOINED(acc, center, int(row));
            if (turn == 0) {
                ++count;
                continue;
            }
            if (at < end) fathom_rows[at] = row;
            ++at;
        }
        if (turn == 1) break;
        begin = last;
        at = atomicAdd(fathom_total, count);
        end = at + count;
        fathom_cells[fathom_grid * side * side * side + cell] = uvec2(at, end);
        if (end < at || end > fathom_room) return;
    }
}
)";

} // namespace

std::optional<PrunePlan> plan_pruning(const ir::Scene &scene,
                                      const std::map<std::uint32_t, NodeId> &results) {
    if (scene.bounds.empty() || !scene.bounds.finite()) return std::nullopt;
    const auto long_loop = [&](ir::FoldId id) {
        return scene.graph.fold(id).max_count >= least_pruned;
    };
    bool any = false;
    for (std::size_t i = 0; i < scene.graph.fold_count(); ++i) any |= long_loop(ir::FoldId{i});
    if (!any) return std::nullopt;
    PrunePlan plan = Planner(scene, results).run();
    if (plan.grids.empty()) return std::nullopt;
    return plan;
}

std::string prune_look_up(const ir::Box &bounds) {
    const auto corner = [](const std::array<double, 3> &v) {
        return "vec3(" + float_literal(v[0]) + ", " + float_literal(v[1]) + ", " +
               float_literal(v[2]) + ")";
    };
    return fill(look_up_rows, {{"LO", corner(bounds.lo)}, {"HI", corner(bounds.hi)}});
}

std::string far_look_up(const std::string &outside) {
    return fill(look_up_far, {{"OUTSIDE", outside}, {"LEAST_WAY", float_literal(least_way)}});
}

std::string prune_around(const std::string &hit) { return fill(around_cells, {{"HIT", hit}}); }

std::string far_kernel(const std::string &sdf) {
    return fill(make_far, {{"SDF", sdf}, {"FAR_FROM", float_literal(far_from)}});
}

std::string prune_kernel(const PrunedLoop &loop, const PruneNames &names) {
    const std::map<std::string, std::string, std::less<>> values{
        {"ROWS", std::to_string(loop.rows)},
        {"SLOPES", float_literal(static_cast<float>((loop.slope + loop.acc_slope) * 1.000001))},
        {"VALUE", names.value},
        {"START", names.start},
        {"JOINED", names.joined},
        {"RADIUS", names.radius}};
    return fill(std::string(kernel_head) + (loop.blended ? kernel_blended : kernel_least), values);
}

} // namespace fathom::glsl
