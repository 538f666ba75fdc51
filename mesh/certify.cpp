#include "mesh/certify.h"

#include "mesh/measure.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace fathom::mesh {
namespace {

using Real3 = std::array<double, 3>;

constexpr double outward = 1 + 1e-9; // what rounding in double precision may take
constexpr int finest_box = 4;        // divisions of a leaf by halves
constexpr int finest_piece = 4;      // divisions of a triangle into four

Real3 real(const Point &p) { return {p[0], p[1], p[2]}; }
Real3 minus(const Real3 &a, const Real3 &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real3 along(const Real3 &a, const Real3 &d, double t) {
    return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}
double inner(const Real3 &a, const Real3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Real3 outer(const Real3 &a, const Real3 &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double distance(const Real3 &a, const Real3 &b) {
    const Real3 d = minus(a, b);
    return std::sqrt(inner(d, d));
}

double to_segment(const Real3 &p, const Real3 &a, const Real3 &b) {
    const Real3 d = minus(b, a);
    const double squares = inner(d, d);
    const double t = squares > 0 ? std::clamp(inner(minus(p, a), d) / squares, 0.0, 1.0) : 0;
    return distance(p, along(a, d, t));
}

// No less than the distance: to the foot on the plane where that is in the triangle, else to a side.
double to_triangle(const Real3 &p, const std::array<Real3, 3> &t) {
    double best =
        std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
    const Real3 u = minus(t[1], t[0]), v = minus(t[2], t[0]), w = minus(p, t[0]);
    const Real3 n = outer(u, v);
    const double squares = inner(n, n);
    if (!(squares > 0)) return best;
    const double b = inner(outer(w, v), n) / squares, c = inner(outer(u, w), n) / squares;
    if (b >= 0 && c >= 0 && b + c <= 1)
        best = std::min(best, distance(p, along(along(t[0], u, b), v, c)));
    return best;
}

// Things by the cells of a grid that they touch.
class Grid {
  public:
    Grid(const Point &origin, double side) : origin_(origin), side_(side) {}
    void add(const Real3 &lo, const Real3 &hi, std::uint32_t what) {
        each(lo, hi, [&](std::uint64_t key) { entries_.push_back({key, what}); });
    }
    void sort() {
        std::ranges::sort(entries_);
        for (std::size_t k = 0; k < entries_.size(); ++k)
            if (k == 0 || entries_[k].first != entries_[k - 1].first)
                begins_[entries_[k].first] = static_cast<std::uint32_t>(k);
    }
    // All that touch a box, each once.
    void find(const Real3 &lo, const Real3 &hi, std::vector<std::uint32_t> &found) const {
        found.clear();
        each(lo, hi, [&](std::uint64_t key) {
            const auto at = begins_.find(key);
            if (at == begins_.end()) return;
            for (std::size_t k = at->second; k < entries_.size() && entries_[k].first == key; ++k)
                found.push_back(entries_[k].second);
        });
        std::ranges::sort(found);
        found.erase(std::unique(found.begin(), found.end()), found.end());
    }

  private:
    template <class Do> void each(const Real3 &lo, const Real3 &hi, Do what) const {
        std::array<std::int64_t, 3> from{}, to{};
        for (std::size_t i = 0; i < 3; ++i) {
            from[i] = static_cast<std::int64_t>(std::floor((lo[i] - origin_[i]) / side_));
            to[i] = static_cast<std::int64_t>(std::floor((hi[i] - origin_[i]) / side_));
        }
        for (std::int64_t x = from[0]; x <= to[0]; ++x)
            for (std::int64_t y = from[1]; y <= to[1]; ++y)
                for (std::int64_t z = from[2]; z <= to[2]; ++z)
                    what(std::uint64_t(x + 8) << 42 | std::uint64_t(y + 8) << 21 |
                         std::uint64_t(z + 8));
    }
    Point origin_;
    double side_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> entries_;
    std::unordered_map<std::uint64_t, std::uint32_t> begins_;
};

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
    double allowed; // the side of a drawing cell
    std::vector<std::array<Real3, 3>> triangles;
    Grid by_triangle, by_root;
};

struct Certifier {
    explicit Certifier(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    cpu::Boxes boxes;
    std::vector<std::uint32_t> near;
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

// How far surface in a leaf may be from the mesh; none where that is more than is allowed.
std::optional<double> farthest_in(const Inquiry &inquiry, Evaluator &evaluator, cpu::Boxes &boxes,
                                  std::vector<std::uint32_t> &near, const Cell &leaf,
                                  bool searched) {
    const Octree &octree = inquiry.made.octree;
    const std::int32_t side = octree.lattice.cells(leaf.level);
    const Box whole{point_of(octree.lattice, leaf.at),
                    point_of(octree.lattice, corner(leaf.at, side, 7))};
    Real3 lo = real(whole.lo), hi = real(whole.hi);
    for (std::size_t i = 0; i < 3; ++i) lo[i] -= inquiry.allowed, hi[i] += inquiry.allowed;
    inquiry.by_triangle.find(lo, hi, near);
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
            double d = 2 * inquiry.allowed;
            for (std::size_t k = 0; k < near.size() && d > enough; ++k)
                d = to_triangle(middle, inquiry.triangles[near[k]]);
            if (d <= enough)
                farthest = std::max(farthest, (d + half) * outward);
            else
                left.push_back(box);
        }
        if (left.empty()) break;
        if (depth == finest_box || searched) return std::nullopt;
        open = open_parts(inquiry, evaluator, boxes, *octree.tapes[static_cast<std::size_t>(task)],
                          left);
    }
    return farthest;
}

constexpr std::size_t piece_of_work = 512;

void certify_surface(const Inquiry &inquiry, unsigned threads, Progress &progress,
                     Certificate &certificate) {
    const std::vector<Cell> leaves = open_leaves(inquiry.made.octree);
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
            for (std::size_t k = number * piece_of_work; k < end; ++k) {
                const std::optional<double> far =
                    farthest_in(inquiry, memory.evaluator, memory.boxes, memory.near, leaves[k],
                                std::ranges::binary_search(searched, leaves[k].node));
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

Real3 sum_of(const std::array<Real3, 3> &piece) {
    return along(along(piece[0], piece[1], 1), piece[2], 1);
}

// How far a triangle may be from the surface: its pieces from the places where it crosses edges.
// Pieces that are farther than is allowed are left over.
double farthest_on(const Inquiry &inquiry, const std::array<Real3, 3> &triangle,
                   std::vector<std::uint32_t> &near, std::vector<std::array<Real3, 3>> &left) {
    Real3 lo = triangle[0], hi = triangle[0];
    for (const Real3 &p : triangle)
        for (std::size_t i = 0; i < 3; ++i)
            lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
    for (std::size_t i = 0; i < 3; ++i) lo[i] -= inquiry.allowed, hi[i] += inquiry.allowed;
    inquiry.by_root.find(lo, hi, near);
    double farthest = 0;
    std::vector<std::array<Real3, 3>> pieces{triangle}, next;
    for (int depth = 0; !pieces.empty(); ++depth, std::swap(pieces, next)) {
        next.clear();
        for (const std::array<Real3, 3> &piece : pieces) {
            const Real3 middle = along({}, sum_of(piece), 1.0 / 3);
            const double radius = std::max({distance(middle, piece[0]), distance(middle, piece[1]),
                                            distance(middle, piece[2])});
            const double enough = inquiry.allowed - radius;
            double d = 2 * inquiry.allowed;
            for (std::size_t k = 0; k < near.size() && d > enough; ++k)
                d = distance(middle, real(inquiry.made.roots[near[k]])) +
                    inquiry.made.root_slack[near[k]];
            if (d <= enough) {
                farthest = std::max(farthest, (d + radius) * outward);
            } else if (depth == finest_piece) {
                left.push_back(piece);
            } else {
                std::array<Real3, 3> m; // the middles of its sides
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
std::array<Real3, ways> ways_from(const std::array<Real3, 3> &piece) {
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
void certify_left(const Inquiry &inquiry, const std::vector<std::array<Real3, 3>> &left,
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
            const std::array<Real3, 3> &piece = left[begin + k];
            const Real3 middle = along({}, sum_of(piece), 1.0 / 3);
            add(middle);
            for (const double step : steps)
                for (const Real3 &way : ways_from(piece))
                    add(along(middle, way, step * inquiry.allowed));
        }
        values_at(evaluator, *inquiry.field.whole, points, values);
        for (std::size_t k = 0; k < count; ++k) {
            const std::array<Real3, 3> &piece = left[begin + k];
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
                certificate.unproved.push_back(points[k * (1 + ways * steps.size())]);
        }
    }
}

void certify_mesh(const Inquiry &inquiry, unsigned threads, Progress &progress,
                  Certificate &certificate) {
    struct Found {
        double farthest = 0;
        std::vector<std::array<Real3, 3>> left;
    };
    std::vector<Found> found((inquiry.triangles.size() + piece_of_work - 1) / piece_of_work);
    in_parallel(
        found.size(), threads, progress, [] { return std::vector<std::uint32_t>(); },
        [&](std::vector<std::uint32_t> &near, std::size_t number) {
            const std::size_t end =
                std::min(inquiry.triangles.size(), (number + 1) * piece_of_work);
            for (std::size_t k = number * piece_of_work; k < end; ++k)
                found[number].farthest =
                    std::max(found[number].farthest,
                             farthest_on(inquiry, inquiry.triangles[k], near, found[number].left));
        });
    std::vector<std::array<Real3, 3>> left;
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

Certificate certify(const ir::Scene &scene, const Settings &settings, const Made &made,
                    Progress &progress) {
    const unsigned threads = threads_of(settings);
    Certificate certificate;
    const Field field(scene, settings.time, settings.bounds);
    const Lattice &lattice = made.octree.lattice;
    const double side = lattice.side(lattice.level);
    const Point origin = point_of(lattice, {0, 0, 0});
    Inquiry inquiry{made, field, true, side, {}, Grid(origin, side), Grid(origin, side)};
    certificate.used_bound = field.proved;
    for (const auto &t : made.mesh.triangles) {
        std::array<Real3, 3> triangle;
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = real(made.mesh.vertices[t[k]]);
        Real3 lo = triangle[0], hi = triangle[0];
        for (const Real3 &p : triangle)
            for (std::size_t i = 0; i < 3; ++i)
                lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
        inquiry.by_triangle.add(lo, hi, static_cast<std::uint32_t>(inquiry.triangles.size()));
        inquiry.triangles.push_back(triangle);
    }
    for (std::size_t k = 0; k < made.roots.size(); ++k)
        inquiry.by_root.add(real(made.roots[k]), real(made.roots[k]),
                            static_cast<std::uint32_t>(k));
    inquiry.by_triangle.sort();
    inquiry.by_root.sort();
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

} // namespace fathom::mesh
