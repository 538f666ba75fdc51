#include "mesh/vertices.h"

#include "mesh/ambiguous.h"
#include "mesh/qef.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr double share_of_margin = 1.0 / 1024;
constexpr int root_steps = 9;         // of the Illinois method
constexpr double closing = 1.0 / 256; // of an edge: how near its signs are asked about a root
constexpr double smooth_cosine = 0.9; // normals that are no farther apart are one smooth surface's
constexpr std::size_t group_size = 256;

// Things of which each lies in one task's cell, in groups of one task each, so that a tape runs over
// many points.
struct Group {
    std::int32_t task = none;
    std::vector<std::uint32_t> members;
};

template <class TaskOf> std::vector<Group> groups_of(std::size_t count, TaskOf task_of) {
    std::vector<std::uint32_t> order(count);
    for (std::size_t k = 0; k < count; ++k) order[k] = static_cast<std::uint32_t>(k);
    std::ranges::stable_sort(order, {}, task_of);
    std::vector<Group> groups;
    for (const std::uint32_t k : order) {
        const std::int32_t task = task_of(k);
        if (groups.empty() || groups.back().task != task ||
            groups.back().members.size() >= group_size)
            groups.push_back({task, {}});
        groups.back().members.push_back(k);
    }
    return groups;
}

struct Memory {
    explicit Memory(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    Points points;
    std::vector<float> values;
    std::array<std::vector<float>, 4> gradients;
    cpu::Boxes boxes;
};

// A tape that holds between some of a lattice's points.
TapePtr tape_between(Memory &memory, const Lattice &lattice, const TapePtr &tape,
                     const std::vector<std::array<Index, 2>> &ends) {
    if (is_short(*tape) || ends.empty()) return tape;
    Index low = ends[0][0], high = low;
    for (const auto &[from, to] : ends)
        for (std::size_t i = 0; i < 3; ++i)
            low[i] = std::min(low[i], from[i]), high[i] = std::max(high[i], to[i]);
    return tape_in(memory.evaluator, memory.boxes, tape, point_of(lattice, low),
                   point_of(lattice, high));
}

// The unit vector of a gradient; `fallback` where it has no direction.
Point unit(const Memory &memory, std::size_t k, const Point &fallback) {
    const double x = memory.gradients[1][k], y = memory.gradients[2][k], z = memory.gradients[3][k];
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 1e-20 && length < 1e20)) return fallback;
    return {static_cast<float>(x / length), static_cast<float>(y / length),
            static_cast<float>(z / length)};
}

double dot(const Point &a, const Point &b) {
    return double(a[0]) * b[0] + double(a[1]) * b[1] + double(a[2]) * b[2];
}

// The surface's normal at each root: the mean of the gradients a little to both sides along the edge.
// On the surface itself a field that is the root of a square has none, in floats.
void find_normals(Memory &memory, const cpu::ShortTape &tape, const Lattice &lattice,
                  const Loops &loops, const Group &group, Vertices &vertices) {
    constexpr double share = 1.0 / 128, agreeing = 0.98;
    const std::size_t n = group.members.size();
    memory.points.clear();
    std::vector<std::uint8_t> moved(2 * n);
    for (const bool up : {false, true})
        for (std::size_t k = 0; k < n; ++k) {
            const std::uint32_t number = group.members[k];
            const Crossing &crossing = loops.crossings[number];
            const std::size_t axis = crossing.axis;
            const auto step = static_cast<float>(2 * lattice.unit * crossing.length * share);
            Point at = vertices.roots[number];
            const float low = lattice.at(axis, crossing.low[axis]),
                        high = lattice.at(axis, crossing.low[axis] + crossing.length),
                        root = at[axis];
            at[axis] = std::clamp(up ? root + step : root - step, low, high);
            moved[k + (up ? n : 0)] = std::fabs(at[axis] - root) > 0.4f * step;
            memory.points.add(at);
        }
    gradients_at(memory.evaluator, tape, memory.points, memory.gradients);
    for (std::size_t k = 0; k < n; ++k) {
        const Crossing &crossing = loops.crossings[group.members[k]];
        Point along{};
        along[crossing.axis] = crossing.low_inside ? 1.0f : -1.0f;
        const Point below = unit(memory, k, along), above = unit(memory, k + n, along);
        const Point &outer = crossing.low_inside ? above : below;
        Point normal = !moved[k] ? above : !moved[k + n] ? below : outer;
        if (moved[k] && moved[k + n] && dot(below, above) > agreeing)
            for (std::size_t i = 0; i < 3; ++i) normal[i] = 0.5f * (below[i] + above[i]);
        const auto length = static_cast<float>(std::sqrt(dot(normal, normal)));
        for (float &x : normal) x /= length;
        vertices.edge_normals[group.members[k]] = normal;
    }
}

// Where the field changes its sign between the ends of some edges: a share of each.
struct Roots {
    std::vector<double> low, high, low_value, high_value;
};

void find_roots(Memory &memory, const TapePtr &of_task, const Lattice &lattice, const Loops &loops,
                const Group &group, Vertices &vertices) {
    const std::size_t n = group.members.size();
    Roots roots;
    const auto crossing_of = [&](std::size_t k) -> const Crossing & {
        return loops.crossings[group.members[k]];
    };
    std::vector<std::array<Index, 2>> ends;
    for (std::size_t k = 0; k < n; ++k) {
        ends.push_back({crossing_of(k).low, crossing_of(k).low});
        ends.back()[1][crossing_of(k).axis] += crossing_of(k).length;
    }
    const TapePtr shorter = tape_between(memory, lattice, of_task, ends);
    const cpu::ShortTape &tape = *shorter;
    std::vector<float> from(n), to(n);
    memory.points.clear();
    for (const bool high : {false, true})
        for (std::size_t k = 0; k < n; ++k) {
            Index at = crossing_of(k).low;
            if (high) at[crossing_of(k).axis] += crossing_of(k).length;
            memory.points.add(point_of(lattice, at));
            (high ? to : from)[k] = memory.points.at[crossing_of(k).axis].back();
        }
    values_at(memory.evaluator, tape, memory.points, memory.values);
    for (std::size_t k = 0; k < n; ++k) {
        roots.low.push_back(from[k]), roots.high.push_back(to[k]);
        roots.low_value.push_back(memory.values[k]);
        roots.high_value.push_back(memory.values[n + k]);
    }
    Points points;
    for (std::size_t k = 0; k < n; ++k) points.add(memory.points[k]);
    std::vector<std::int8_t> last(n, 0); // which end was moved last
    const auto guess = [&](std::size_t k) {
        const double a = roots.low_value[k], b = roots.high_value[k], whole = a - b;
        double share = whole != 0 ? a / whole : 0.5;
        if (!(share >= 0 && share <= 1)) share = 0.5;
        return roots.low[k] + share * (roots.high[k] - roots.low[k]);
    };
    for (int step = 0; step < root_steps; ++step) {
        for (std::size_t k = 0; k < n; ++k)
            points.at[crossing_of(k).axis][k] = static_cast<float>(guess(k));
        values_at(memory.evaluator, tape, points, memory.values);
        for (std::size_t k = 0; k < n; ++k) {
            const double at = points.at[crossing_of(k).axis][k], value = memory.values[k];
            const bool at_low = (value <= 0) == crossing_of(k).low_inside;
            (at_low ? roots.low : roots.high)[k] = at;
            (at_low ? roots.low_value : roots.high_value)[k] = value;
            double &kept = (at_low ? roots.high_value : roots.low_value)[k];
            if (last[k] == (at_low ? 1 : 2)) kept *= 0.5;
            last[k] = at_low ? 1 : 2;
        }
    }
    std::vector<float> best(n);
    for (std::size_t k = 0; k < n; ++k)
        best[k] = std::clamp(static_cast<float>(guess(k)), from[k], to[k]);
    // On a flat face the first guess is right, and one end stays where it was: so both are brought
    // near to it, since how near they are is what is known of the root.
    for (const bool up : {false, true}) {
        for (std::size_t k = 0; k < n; ++k) {
            const double step = closing * (double(to[k]) - from[k]);
            points.at[crossing_of(k).axis][k] = std::clamp(
                static_cast<float>(up ? best[k] + step : best[k] - step), from[k], to[k]);
        }
        values_at(memory.evaluator, tape, points, memory.values);
        for (std::size_t k = 0; k < n; ++k) {
            const double at = points.at[crossing_of(k).axis][k];
            if (!(at > roots.low[k] && at < roots.high[k])) continue; // nothing new between them
            const bool at_low = (memory.values[k] <= 0) == crossing_of(k).low_inside;
            (at_low ? roots.low : roots.high)[k] = at;
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t number = group.members[k];
        const std::size_t axis = crossing_of(k).axis;
        Point root = points[k];
        root[axis] = best[k];
        vertices.roots[number] = root;
        vertices.root_slack[number] =
            static_cast<float>(std::max(root[axis] - roots.low[k], roots.high[k] - root[axis]));
        const auto margin =
            static_cast<float>(margin_of(lattice, 2 * lattice.unit * crossing_of(k).length));
        root[axis] = std::clamp(root[axis], from[k] + margin, to[k] - margin);
        vertices.on_edge[number] = root;
    }
    find_normals(memory, tape, lattice, loops, group, vertices);
}

Plane plane_at(const Vertices &vertices, std::int32_t crossing) {
    const auto c = static_cast<std::size_t>(crossing);
    Plane plane;
    for (std::size_t i = 0; i < 3; ++i) {
        plane.point[i] = vertices.roots[c][i];
        plane.normal[i] = vertices.edge_normals[c][i];
    }
    return plane;
}

// The part of a cell in which its vertices may lie.
struct Room {
    Vector lo, hi;
};
Room room_of(const Lattice &lattice, const Cell &cell) {
    const double margin = margin_of(lattice, lattice.side(cell.level));
    Room room;
    for (std::size_t i = 0; i < 3; ++i) {
        room.lo[i] = lattice.at(i, cell.at[i]) + margin;
        room.hi[i] = lattice.at(i, cell.at[i] + lattice.cells(cell.level)) - margin;
    }
    return room;
}

// Rounded to floats, and not out of the room, whose ends are floats.
Point placed(const Vector &x, const Room &room) {
    Point p;
    for (std::size_t i = 0; i < 3; ++i)
        p[i] = std::clamp(static_cast<float>(x[i]), static_cast<float>(room.lo[i]),
                          static_cast<float>(room.hi[i]));
    return p;
}

// Whether a place lies on a patch's side of the planes between it and the others of its cell.
bool on_own_side(const Lattice &lattice, const Loops &loops, const Patch &patch, const Point &at) {
    std::array<double, 3> share{};
    for (std::size_t i = 0; i < 3; ++i)
        share[i] =
            (double(at[i]) - lattice.at(i, patch.cell.at[i])) / lattice.side(patch.cell.level);
    const auto node = [](const auto &entry) { return entry.first; };
    for (const auto &[_, other] :
         std::ranges::equal_range(loops.several, patch.cell.node, {}, node)) {
        if (&loops.patches[other] == &patch) continue;
        const Patch &that = loops.patches[other];
        const bool first = &patch < &that; // of two patches both ask for the same plane
        const auto plane =
            plane_between(lattice, loops, first ? patch : that, first ? that : patch);
        if (!plane || !((first ? 1 : -1) * plane->height(share) > share_of_margin)) return false;
    }
    return true;
}

// Where the planes of a patch meet. Of a cell with several patches that has to be on its own side of
// the planes between them, or it is the middle of its crossings: so patches do not meet (docs/meshes.md,
// 4).
void place_patch(const Lattice &lattice, const Loops &loops, const Patch &patch, Vertices &vertices,
                 Point &at, Point &normal, bool &smooth) {
    const auto members = std::span(loops.members).subspan(patch.first, patch.count);
    const Room room = room_of(lattice, patch.cell);
    std::array<double, 3> sum{}, middle{};
    std::vector<Plane> planes;
    for (const std::int32_t c : members) {
        planes.push_back(plane_at(vertices, c));
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += planes.back().normal[i];
            middle[i] += vertices.on_edge[static_cast<std::size_t>(c)][i] / double(patch.count);
        }
    }
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (std::size_t i = 0; i < 3; ++i)
        normal[i] = static_cast<float>(length > 0 ? sum[i] / length : i == 2);
    smooth = patch.alone && length > 0;
    for (const std::int32_t c : members)
        smooth = smooth &&
                 dot(vertices.edge_normals[static_cast<std::size_t>(c)], normal) > smooth_cosine;
    at = placed(meeting_point(planes, room.lo, room.hi), room);
    if (!patch.alone && !on_own_side(lattice, loops, patch, at)) at = placed(middle, room);
}

// A step towards the surface along the gradient: planes meet beside a curved one, and where an edge's
// normal was taken next to a corner they meet beside that. It is taken only where it ends nearer to 0
// and in the cell, and at an edge or a corner only from farther than a 1,024th of the cell's side.
void approach(Memory &memory, const TapePtr &of_task, const Lattice &lattice, const Loops &loops,
              const Group &group, const std::vector<std::uint8_t> &smooth, Vertices &vertices) {
    std::vector<std::array<Index, 2>> ends;
    for (const std::uint32_t p : group.members) {
        const Cell &cell = loops.patches[p].cell;
        ends.push_back({cell.at, corner(cell.at, lattice.cells(cell.level), 7)});
    }
    const TapePtr shorter = tape_between(memory, lattice, of_task, ends);
    const cpu::ShortTape &tape = *shorter;
    memory.points.clear();
    for (const std::uint32_t p : group.members) memory.points.add(vertices.in_cell[p]);
    gradients_at(memory.evaluator, tape, memory.points, memory.gradients);
    std::vector<float> before = memory.gradients[0];
    Points moved;
    for (std::size_t k = 0; k < group.members.size(); ++k) {
        const std::uint32_t p = group.members[k];
        const Cell &cell = loops.patches[p].cell;
        double squares = 0;
        for (std::size_t i = 0; i < 3; ++i)
            squares += double(memory.gradients[1 + i][k]) * memory.gradients[1 + i][k];
        Vector x{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double step =
                squares > 0 ? -double(before[k]) * memory.gradients[1 + i][k] / squares : 0;
            x[i] = vertices.in_cell[p][i] + step;
            if (!(std::fabs(step) <= 0.25 * lattice.side(cell.level)) ||
                std::fabs(before[k]) <
                    (smooth[k] ? 1e-4 : share_of_margin) * lattice.side(cell.level))
                x[i] = vertices.in_cell[p][i];
        }
        moved.add(placed(x, room_of(lattice, cell)));
    }
    values_at(memory.evaluator, tape, moved, memory.values);
    for (std::size_t k = 0; k < group.members.size(); ++k)
        if (std::fabs(memory.values[k]) < std::fabs(before[k]))
            vertices.in_cell[group.members[k]] = moved[k];
}

// Where the way between two cells' vertices goes through the plane of their face.
Vector passage(const Point &a, const Point &b, std::size_t axis, double at) {
    const double share = (at - a[axis]) / (double(b[axis]) - a[axis]);
    Vector x{};
    for (std::size_t i = 0; i < 3; ++i) x[i] = a[i] + share * (double(b[i]) - a[i]);
    x[axis] = at;
    return x;
}

void place_on_face(const Lattice &lattice, const Loops &loops, std::size_t number,
                   Vertices &vertices) {
    const Segment &segment = loops.segments[number];
    const Crossing &from = loops.crossings[static_cast<std::size_t>(segment.crossings[0])];
    const auto patch_of = [&](int quarter) {
        return static_cast<std::size_t>(from.patches[static_cast<std::size_t>(quarter & 3)]);
    };
    const std::size_t p = patch_of(segment.faces[0]), q = patch_of(segment.faces[0] + 1);
    const std::size_t axis = segment.axis;
    const std::int32_t side = lattice.cells(segment.owner.level);
    Index corner_at = segment.owner.at;
    if (segment.high) corner_at[axis] += side;
    const double at = lattice.at(axis, corner_at[axis]);
    Room room = room_of(lattice, segment.owner);
    room.lo[axis] = room.hi[axis] = at;
    // In the hull of what it joins where others may be beside it.
    const bool alone = segment.alone && loops.patches[p].alone && loops.patches[q].alone;
    if (alone) {
        const Vector x = passage(vertices.in_cell[p], vertices.in_cell[q], axis, at);
        bool through = true;
        for (std::size_t i = 0; i < 3; ++i)
            through = through && x[i] >= room.lo[i] && x[i] <= room.hi[i];
        if (through) return;
    }
    vertices.has_face[number] = 1;
    std::array<Plane, 2> planes{plane_at(vertices, segment.crossings[0]),
                                plane_at(vertices, segment.crossings[1])};
    Vector middle{};
    for (const std::int32_t c : segment.crossings)
        for (std::size_t i = 0; i < 3; ++i)
            middle[i] += 0.5 * vertices.on_edge[static_cast<std::size_t>(c)][i];
    vertices.on_face[number] =
        placed(alone ? meeting_point_on(planes, axis, at, room.lo, room.hi) : middle, room);
}

} // namespace

double margin_of(const Lattice &lattice, double side) {
    // A whole number of ulps, so that the ends of a room are floats.
    return lattice.ulp * std::max(1.0, std::floor(side * share_of_margin / lattice.ulp));
}

Vertices place_vertices(const Octree &octree, const Field &field, const Loops &loops,
                        unsigned threads, Progress &progress) {
    Vertices vertices;
    const std::size_t edges = loops.crossings.size(), cells = loops.patches.size();
    vertices.on_edge.resize(edges), vertices.roots.resize(edges);
    vertices.edge_normals.resize(edges), vertices.root_slack.resize(edges);
    vertices.in_cell.resize(cells), vertices.cell_normals.resize(cells);
    vertices.has_face.resize(loops.segments.size()), vertices.on_face.resize(loops.segments.size());
    const double from = progress.from, to = progress.to;
    const auto task_of_cell = [&](const Cell &cell) {
        return octree.nodes[static_cast<std::size_t>(cell.node)].task;
    };
    const auto tape_of = [&](const Group &group) -> const TapePtr & {
        return octree.tapes[static_cast<std::size_t>(group.task)];
    };
    const auto owner_of = [&](std::uint32_t c) { // the smallest cell about an edge: it has the edge
        const Crossing &crossing = loops.crossings[c];
        std::size_t best = 0;
        for (std::size_t k = 1; k < 4; ++k)
            if (crossing.cells[k].level > crossing.cells[best].level) best = k;
        for (std::size_t k = 0; k < 4; ++k) // one that has a tape
            if (crossing.cells[k].level == crossing.cells[best].level &&
                task_of_cell(crossing.cells[k]) != none)
                return task_of_cell(crossing.cells[k]);
        return none;
    };
    progress.to = from + 0.6 * (to - from);
    const std::vector<Group> by_edge = groups_of(edges, owner_of);
    in_parallel(
        by_edge.size(), threads, progress, [&] { return Memory(field); },
        [&](Memory &memory, std::size_t g) {
            find_roots(memory, tape_of(by_edge[g]), octree.lattice, loops, by_edge[g], vertices);
        });
    if (progress.cancelled) return vertices;
    progress.phase(to);
    const std::vector<Group> by_cell =
        groups_of(cells, [&](std::uint32_t p) { return task_of_cell(loops.patches[p].cell); });
    in_parallel(
        by_cell.size(), threads, progress, [&] { return Memory(field); },
        [&](Memory &memory, std::size_t g) {
            Group alone{by_cell[g].task, {}};
            std::vector<std::uint8_t> smooth;
            for (const std::uint32_t p : by_cell[g].members) {
                bool is_smooth = false;
                place_patch(octree.lattice, loops, loops.patches[p], vertices, vertices.in_cell[p],
                            vertices.cell_normals[p], is_smooth);
                if (!loops.patches[p].alone || alone.task == none) continue;
                alone.members.push_back(p);
                smooth.push_back(is_smooth);
            }
            if (!alone.members.empty())
                approach(memory, tape_of(alone), octree.lattice, loops, alone, smooth, vertices);
        });
    if (progress.cancelled) return vertices;
    for (std::size_t s = 0; s < loops.segments.size(); ++s)
        place_on_face(octree.lattice, loops, s, vertices);
    return vertices;
}

} // namespace fathom::mesh
