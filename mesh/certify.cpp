#include "mesh/certify.h"

#include "mesh/grid.h"
#include "mesh/measure.h"
#include "mesh/nearest.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom::mesh {
namespace {

constexpr double outward = 1 + 1e-9; // what rounding in double precision may take
constexpr int finest_box = 4;        // divisions of a leaf by halves
constexpr int finest_piece = 4;      // divisions of a triangle into four

struct Box {
    Point lo, hi;
};
Real3 middle_of(const Box &box) {
    Real3 m{};
    for (std::size_t i = 0; i < 3; ++i) m[i] = 0.5 * (double(box.lo[i]) + box.hi[i]);
    return m;
}

// All that the pieces of work share.
struct Inquiry {
    const Made &made;
    const Field &field;
    bool trusts;
    double allowed;         // the side of a drawing cell
    const Earlier *earlier; // or null
    std::vector<Triangle3> triangles{};
    std::optional<TriangleTree> tree{};
    Grid by_root;
    // The triangles at vertex v: at_vertex[first_at[v]] and on, below first_at[v + 1].
    std::vector<std::uint32_t> first_at{}, at_vertex{};
    std::vector<std::pair<std::int32_t, std::uint32_t>> patches{}; // by node, sorted

    bool proved_before(const Real3 &at) const { return earlier && !earlier->changed.beside(at); }
};

// The parts of some boxes in which surface may be.
std::vector<Box> open_parts(const Inquiry &inquiry, Evaluator &evaluator, cpu::Boxes &boxes,
                            const cpu::ShortTape &tape, const std::vector<Box> &whole) {
    constexpr std::size_t at_once = cpu::max_boxes / 16;
    std::vector<Box> open;
    for (std::size_t begin = 0; begin < whole.size(); begin += at_once) {
        const std::size_t count = std::min(at_once, whole.size() - begin);
        std::vector<Box> parts;
        boxes.count = 16 * count;
        for (std::size_t j = 0; j < count; ++j) {
            const Box &box = whole[begin + j];
            for (std::size_t k = 0; k < 8; ++k) {
                Box part = box;
                for (std::size_t i = 0; i < 3; ++i) {
                    const float cut = 0.5f * (box.lo[i] + box.hi[i]);
                    (k >> i & 1 ? part.lo : part.hi)[i] = cut;
                    boxes.lo[i][16 * j + k] = part.lo[i], boxes.hi[i][16 * j + k] = part.hi[i];
                    boxes.lo[i][16 * j + 8 + k] = boxes.hi[i][16 * j + 8 + k] =
                        0.5f * (part.lo[i] + part.hi[i]);
                }
                parts.push_back(part);
            }
        }
        ranges_over(evaluator, tape, boxes);
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t k = 0; k < 8; ++k) {
                const Box &part = parts[8 * j + k];
                if (space_of(evaluator, 16 * j + k, 0.5 * distance(real(part.lo), real(part.hi)),
                             inquiry.made.octree.lattice.ulp, inquiry.trusts) == Space::Open)
                    open.push_back(part);
            }
    }
    return open;
}

// What may be near: first what belongs to the leaf or triangle itself, then, only where that does not
// do, all that is about.
struct Candidates {
    std::vector<std::uint32_t> own, near;
    bool found_near = false;
};

void find_own(const Inquiry &inquiry, const Cell &leaf, Candidates &candidates) {
    candidates.own.clear();
    const auto at = std::ranges::lower_bound(inquiry.patches, std::pair{leaf.node, 0u});
    for (auto p = at; p != inquiry.patches.end() && p->first == leaf.node; ++p)
        for (std::uint32_t k = inquiry.first_at[p->second]; k < inquiry.first_at[p->second + 1];
             ++k)
            candidates.own.push_back(inquiry.at_vertex[k]);
}

// The distance of a triangle that is near enough, or else of the nearest.
double first_near(const Inquiry &inquiry, const std::vector<std::uint32_t> &triangles,
                  const Real3 &to, double enough) {
    double d = 2 * inquiry.allowed;
    for (std::size_t k = 0; k < triangles.size() && d > enough; ++k)
        d = std::min(d, to_triangle(to, inquiry.triangles[triangles[k]]));
    return d;
}

// How far surface in a leaf may be from the mesh; none where that is more than is allowed, or would
// take more divisions of boxes than are left.
std::optional<double> farthest_in(const Inquiry &inquiry, Evaluator &evaluator, cpu::Boxes &boxes,
                                  Candidates &candidates, const Cell &leaf, bool searched,
                                  std::size_t &divisions) {
    const Octree &octree = inquiry.made.octree;
    const std::int32_t side = octree.lattice.cells(leaf.level);
    const Box whole{point_of(octree.lattice, leaf.at),
                    point_of(octree.lattice, corner(leaf.at, side, 7))};
    find_own(inquiry, leaf, candidates);
    const std::int32_t task = octree.nodes[static_cast<std::size_t>(leaf.node)].task;
    std::vector<Box> open{whole};
    double farthest = 0;
    for (int depth = 0; !open.empty(); ++depth) {
        std::vector<Box> left;
        for (const Box &box : open) {
            const Real3 middle = middle_of(box);
            const double half = 0.5 * distance(real(box.lo), real(box.hi));
            // The first that is near enough will do: the claim is no more than what is allowed.
            const double enough = inquiry.allowed - half;
            double d = enough < 0 ? 2 * inquiry.allowed
                                  : first_near(inquiry, candidates.own, middle, enough);
            if (d > enough && enough >= 0)
                if (const auto near = inquiry.tree->nearest(middle, inquiry.allowed, enough))
                    d = near->distance;
            if (d <= enough)
                farthest = std::max(farthest, (d + half) * outward);
            else
                left.push_back(box);
        }
        if (left.empty()) break;
        if (depth == finest_box || searched || left.size() > divisions) return std::nullopt;
        divisions -= left.size();
        open = open_parts(inquiry, evaluator, boxes, *octree.tapes[static_cast<std::size_t>(task)],
                          left);
    }
    return farthest;
}

constexpr std::size_t piece_of_work = 512;
constexpr std::size_t divisions_a_leaf = 32; // of boxes, on average over a piece of work

struct Certifier {
    explicit Certifier(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    cpu::Boxes boxes;
    Candidates candidates;
};

void certify_surface(const Inquiry &inquiry, unsigned threads, Progress &progress,
                     Certificate &certificate) {
    const Lattice &lattice = inquiry.made.octree.lattice;
    std::vector<Cell> leaves = open_leaves(inquiry.made.octree);
    std::erase_if(leaves, [&](const Cell &leaf) {
        return inquiry.proved_before(real(point_of(lattice, leaf.at)));
    });
    // What was searched for in vain is not searched again.
    std::vector<std::int32_t> searched;
    for (const Cell &cell : inquiry.made.octree.undecided) searched.push_back(cell.node);
    std::ranges::sort(searched);
    struct Found {
        double farthest = 0;
        std::vector<Cell> undecided;
    };
    std::vector<Found> found((leaves.size() + piece_of_work - 1) / piece_of_work);
    in_parallel(
        found.size(), threads, progress, [&] { return Certifier(inquiry.field); },
        [&](Certifier &memory, std::size_t number) {
            const std::size_t end = std::min(leaves.size(), (number + 1) * piece_of_work);
            std::size_t divisions = divisions_a_leaf * piece_of_work;
            for (std::size_t k = number * piece_of_work; k < end; ++k) {
                const bool in_vain = std::ranges::binary_search(searched, leaves[k].node);
                const std::optional<double> far =
                    farthest_in(inquiry, memory.evaluator, memory.boxes, memory.candidates,
                                leaves[k], in_vain, divisions);
                if (far)
                    found[number].farthest = std::max(found[number].farthest, *far);
                else
                    found[number].undecided.push_back(leaves[k]);
            }
        });
    for (const Found &some : found) {
        certificate.surface_to_mesh = std::max(certificate.surface_to_mesh, some.farthest);
        certificate.undecided.insert(certificate.undecided.end(), some.undecided.begin(),
                                     some.undecided.end());
    }
}

Real3 sum_of(const Triangle3 &piece) { return along(along(piece[0], piece[1], 1), piece[2], 1); }

Real3 middle_of(const Inquiry &inquiry, std::uint32_t triangle) {
    return along({}, sum_of(inquiry.triangles[triangle]), 1.0 / 3);
}

struct Shard {
    Triangle3 corners;
    std::uint32_t triangle = 0; // whose piece it is
};

// The crossed edges of the patches that a triangle goes through.
void find_own_roots(const Inquiry &inquiry, std::uint32_t triangle,
                    std::vector<std::uint32_t> &roots) {
    roots.clear();
    const Loops &loops = inquiry.made.loops;
    for (const std::uint32_t v : inquiry.made.mesh.triangles[triangle]) {
        if (v >= loops.patches.size()) continue; // on an edge or a face
        const Patch &patch = loops.patches[v];
        for (std::uint32_t k = patch.first; k < patch.first + patch.count; ++k)
            roots.push_back(static_cast<std::uint32_t>(loops.members[k]));
    }
}

double first_root(const Inquiry &inquiry, const std::vector<std::uint32_t> &roots, const Real3 &to,
                  double enough) {
    double d = 2 * inquiry.allowed;
    for (std::size_t k = 0; k < roots.size() && d > enough; ++k)
        d = std::min(d, distance(to, real(inquiry.made.roots[roots[k]])) +
                            inquiry.made.root_slack[roots[k]]);
    return d;
}

// How far a triangle may be from the surface: its pieces from the places where it crosses edges.
// Pieces that are farther than is allowed are left over.
double farthest_on(const Inquiry &inquiry, std::uint32_t number, Candidates &candidates,
                   std::vector<Shard> &left) {
    const Triangle3 &triangle = inquiry.triangles[number];
    find_own_roots(inquiry, number, candidates.own);
    candidates.found_near = false;
    double farthest = 0;
    std::vector<Triangle3> pieces{triangle}, next;
    for (int depth = 0; !pieces.empty(); ++depth, std::swap(pieces, next)) {
        next.clear();
        for (const Triangle3 &piece : pieces) {
            const Real3 middle = along({}, sum_of(piece), 1.0 / 3);
            const double radius = std::max({distance(middle, piece[0]), distance(middle, piece[1]),
                                            distance(middle, piece[2])});
            const double enough = inquiry.allowed - radius;
            double d = first_root(inquiry, candidates.own, middle, enough);
            if (d > enough && enough >= 0) {
                if (!candidates.found_near) {
                    Real3 lo = triangle[0], hi = triangle[0];
                    for (const Real3 &p : triangle)
                        for (std::size_t i = 0; i < 3; ++i)
                            lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
                    for (std::size_t i = 0; i < 3; ++i)
                        lo[i] -= inquiry.allowed, hi[i] += inquiry.allowed;
                    inquiry.by_root.find(lo, hi, candidates.near);
                    candidates.found_near = true;
                }
                d = first_root(inquiry, candidates.near, middle, enough);
            }
            if (d <= enough) {
                farthest = std::max(farthest, (d + radius) * outward);
            } else if (depth == finest_piece) {
                left.push_back({piece, number});
            } else {
                Triangle3 m; // the middles of its sides
                for (std::size_t k = 0; k < 3; ++k)
                    for (std::size_t i = 0; i < 3; ++i)
                        m[k][i] = 0.5 * (piece[k][i] + piece[(k + 1) % 3][i]);
                next.push_back(m);
                for (std::size_t k = 0; k < 3; ++k)
                    next.push_back({piece[k], m[k], m[(k + 2) % 3]});
            }
        }
    }
    return farthest;
}

// Where a piece's signs are asked: its middle, and so many ways from it at each of some distances.
constexpr std::size_t ways = 16;
constexpr std::array<double, 3> steps{0.125, 0.25, 0.5}; // of what is allowed

// Along the piece's normal, the axes and the diagonals, both ways.
std::array<Real3, ways> ways_from(const Triangle3 &piece) {
    std::array<Real3, ways> found{};
    const Real3 n = outer(minus(piece[1], piece[0]), minus(piece[2], piece[0]));
    const double length = std::sqrt(inner(n, n));
    for (std::size_t i = 0; i < 3; ++i) {
        found[0][i] = length > 0 ? n[i] / length : 0;
        found[1][i] = -found[0][i];
        found[2 + 2 * i][i] = 1;
        found[3 + 2 * i][i] = -1;
        for (std::size_t k = 0; k < 8; ++k)
            found[8 + k][i] = (k >> i & 1 ? 1 : -1) / std::sqrt(3.0);
    }
    return found;
}

// Pieces far from all edges that the surface crosses: it lies between the middle of such a piece and
// a point with another sign.
void certify_left(const Inquiry &inquiry, const std::vector<Shard> &left,
                  Certificate &certificate) {
    constexpr std::size_t group = 256;
    Evaluator evaluator(inquiry.field);
    std::vector<float> values;
    for (std::size_t begin = 0; begin < left.size(); begin += group) {
        const std::size_t count = std::min(group, left.size() - begin);
        Points points;
        const auto add = [&](const Real3 &at) {
            points.add(
                {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])});
        };
        for (std::size_t k = 0; k < count; ++k) {
            const Triangle3 &piece = left[begin + k].corners;
            const Real3 middle = along({}, sum_of(piece), 1.0 / 3);
            add(middle);
            for (const double step : steps)
                for (const Real3 &way : ways_from(piece))
                    add(along(middle, way, step * inquiry.allowed));
        }
        values_at(evaluator, *inquiry.field.whole, points, values);
        for (std::size_t k = 0; k < count; ++k) {
            const Triangle3 &piece = left[begin + k].corners;
            const double size =
                std::max({distance(piece[0], piece[1]), distance(piece[1], piece[2]),
                          distance(piece[2], piece[0])}) +
                4 * inquiry.made.octree.lattice.ulp; // points are rounded to floats
            const std::span<const float> here =
                std::span(values).subspan(k * (1 + ways * steps.size()), 1 + ways * steps.size());
            double far = 2 * inquiry.allowed;
            for (std::size_t s = steps.size(); s-- > 0;)
                for (std::size_t w = 0; w < ways; ++w)
                    if ((here[1 + s * ways + w] < 0) != (here[0] < 0))
                        far = (steps[s] * inquiry.allowed + size) * outward;
            if (far <= inquiry.allowed)
                certificate.mesh_to_surface = std::max(certificate.mesh_to_surface, far);
            else
                certificate.unproved.push_back({points[k * (1 + ways * steps.size())],
                                                middle_of(inquiry, left[begin + k].triangle)});
        }
    }
}

void certify_mesh(const Inquiry &inquiry, unsigned threads, Progress &progress,
                  Certificate &certificate) {
    struct Found {
        double farthest = 0;
        std::vector<Shard> left;
    };
    std::vector<Found> found((inquiry.triangles.size() + piece_of_work - 1) / piece_of_work);
    in_parallel(
        found.size(), threads, progress, [] { return Candidates(); },
        [&](Candidates &candidates, std::size_t number) {
            const std::size_t end =
                std::min(inquiry.triangles.size(), (number + 1) * piece_of_work);
            for (std::size_t k = number * piece_of_work; k < end; ++k)
                if (const auto t = static_cast<std::uint32_t>(k);
                    !inquiry.proved_before(middle_of(inquiry, t)))
                    found[number].farthest =
                        std::max(found[number].farthest,
                                 farthest_on(inquiry, t, candidates, found[number].left));
        });
    std::vector<Shard> left;
    for (const Found &some : found) {
        certificate.mesh_to_surface = std::max(certificate.mesh_to_surface, some.farthest);
        left.insert(left.end(), some.left.begin(), some.left.end());
    }
    if (!left.empty()) certify_left(inquiry, left, certificate);
}

// What is inside for sure, and what may be.
void enclose_volume(const Octree &octree, Certificate &certificate) {
    double inside = 0, open = 0;
    std::vector<std::pair<std::int32_t, int>> stack{{0, 0}};
    while (!stack.empty()) {
        const auto [number, level] = stack.back();
        stack.pop_back();
        const Node &node = octree.nodes[static_cast<std::size_t>(number)];
        const double side = octree.lattice.side(level);
        if (node.children != none)
            for (int k = 0; k < 8; ++k) stack.push_back({node.children + k, level + 1});
        else if (node.space == Space::Inside)
            inside += side * side * side;
        else if (node.space == Space::Open)
            open += side * side * side;
    }
    certificate.least_volume = inside / outward;
    certificate.largest_volume = (inside + open) * outward;
}

// What holds of the places that have not changed. Distances are the largest of all: they hold too.
Certificate kept_of(const Earlier &earlier, const Octree &octree) {
    Certificate kept;
    kept.mesh_to_surface = earlier.certificate.mesh_to_surface;
    kept.surface_to_mesh = earlier.certificate.surface_to_mesh;
    for (const Cell &cell : earlier.certificate.undecided)
        if (!earlier.changed.beside(real(point_of(octree.lattice, cell.at))))
            kept.undecided.push_back(cell);
    for (const Unproved &place : earlier.certificate.unproved)
        if (!earlier.changed.beside(place.triangle)) kept.unproved.push_back(place);
    return kept;
}

// What is looked up by its place, as far as the proofs will ask.
void fill(Inquiry &inquiry) {
    const Made &made = inquiry.made;
    const auto wanted = [&](const Real3 &at) {
        return !inquiry.earlier || inquiry.earlier->changed.around(at);
    };
    inquiry.first_at.resize(made.mesh.vertices.size() + 1);
    std::vector<std::uint32_t> among;
    for (const auto &t : made.mesh.triangles) {
        Triangle3 triangle;
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = real(made.mesh.vertices[t[k]]);
        if (wanted(triangle[0]))
            among.push_back(static_cast<std::uint32_t>(inquiry.triangles.size()));
        inquiry.triangles.push_back(triangle);
        for (const std::uint32_t v : t) ++inquiry.first_at[v + 1];
    }
    for (std::size_t v = 1; v < inquiry.first_at.size(); ++v)
        inquiry.first_at[v] += inquiry.first_at[v - 1];
    inquiry.at_vertex.resize(3 * made.mesh.triangles.size());
    std::vector<std::uint32_t> next = inquiry.first_at;
    for (std::size_t t = 0; t < made.mesh.triangles.size(); ++t)
        for (const std::uint32_t v : made.mesh.triangles[t])
            inquiry.at_vertex[next[v]++] = static_cast<std::uint32_t>(t);
    for (std::size_t p = 0; p < made.loops.patches.size(); ++p)
        inquiry.patches.push_back({made.loops.patches[p].cell.node, static_cast<std::uint32_t>(p)});
    std::ranges::sort(inquiry.patches);
    for (std::size_t k = 0; k < made.roots.size(); ++k)
        if (const Real3 at = real(made.roots[k]); wanted(at))
            inquiry.by_root.add(at, at, static_cast<std::uint32_t>(k));
    inquiry.tree.emplace(made.mesh, std::move(among));
    inquiry.by_root.sort();
}

} // namespace

Form form_of(const Mesh &mesh) {
    std::vector<std::uint32_t> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto &t : mesh.triangles) {
        parent[root(t[0])] = root(t[1]);
        parent[root(t[1])] = root(t[2]);
    }
    Form form;
    for (std::uint32_t v = 0; v < parent.size(); ++v) form.components += root(v) == v;
    // Closed: three edges for two triangles. All vertices are used.
    const long euler =
        static_cast<long>(mesh.vertices.size()) - static_cast<long>(mesh.triangles.size()) / 2;
    form.genus = static_cast<long>(form.components) - euler / 2;
    return form;
}

Certificate certify(const Field &field, const Settings &settings, const Made &made,
                    const Earlier *earlier, Progress &progress) {
    const unsigned threads = threads_of(settings);
    Certificate certificate = earlier ? kept_of(*earlier, made.octree) : Certificate{};
    const Lattice &lattice = made.octree.lattice;
    const double side = lattice.side(lattice.level);
    const Point origin = point_of(lattice, {0, 0, 0});
    Inquiry inquiry{.made = made,
                    .field = field,
                    .trusts = true,
                    .allowed = side,
                    .earlier = earlier,
                    .by_root = Grid(origin, side)};
    certificate.used_bound = field.proved;
    fill(inquiry);
    const double from = progress.from, to = progress.to;
    progress.to = 0.5 * (from + to);
    certify_surface(inquiry, threads, progress, certificate);
    if (progress.cancelled) return certificate;
    progress.phase(to);
    certify_mesh(inquiry, threads, progress, certificate);
    const Form form = form_of(made.mesh);
    certificate.components = form.components;
    certificate.genus = form.genus;
    const MeshSums sums = sums_of(made.mesh);
    certificate.mesh_volume = sums.volume;
    certificate.mesh_area = sums.area;
    enclose_volume(made.octree, certificate);
    return certificate;
}

Certificate certify(const ir::Scene &scene, const Settings &settings, const Made &made,
                    Progress &progress) {
    return certify(Field(scene, settings.time, settings.bounds), settings, made, nullptr, progress);
}

} // namespace fathom::mesh
