#include "mesh/measure.h"

#include "mesh/slopes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace fathom::mesh {
namespace {

using Real3 = std::array<double, 3>;

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double rounding_share = 1e-9; // what rounding may take of a sum, by the size of its terms
constexpr int least_levels = 2, most_levels = 6;
constexpr std::size_t sampled = 256; // leaves whose tapes say what dividing takes

struct Piece {
    Point lo, hi;
};

// What cells add up to. Moments are about a middle; an open cell's part of the solid is anything
// from none of it to all.
struct CellSums {
    double inside = 0, open = 0;
    Real3 moment{}, least_moment{}, most_moment{}; // of what is inside; of what is open
    double sizes = 0;                              // of all moments' terms
    Real3 outer_lo{unbounded, unbounded, unbounded}, outer_hi{-unbounded, -unbounded, -unbounded};
    Real3 known_lo = outer_lo, known_hi = outer_hi; // of points that are in the solid

    void know(const Point &lo, const Point &hi) {
        for (std::size_t i = 0; i < 3; ++i) {
            known_lo[i] = std::min<double>(known_lo[i], lo[i]);
            known_hi[i] = std::max<double>(known_hi[i], hi[i]);
        }
    }
    void add(const Point &lo, const Point &hi, Space space, const Real3 &middle) {
        if (space == Space::Outside) return;
        double volume = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            volume *= double(hi[i]) - lo[i];
            outer_lo[i] = std::min<double>(outer_lo[i], lo[i]);
            outer_hi[i] = std::max<double>(outer_hi[i], hi[i]);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const double a = lo[i] - middle[i], b = hi[i] - middle[i];
            sizes += volume * std::max(std::fabs(a), std::fabs(b));
            if (space == Space::Inside) moment[i] += volume * 0.5 * (a + b);
            if (space == Space::Open) {
                least_moment[i] += volume * std::min(a, 0.0);
                most_moment[i] += volume * std::max(b, 0.0);
            }
        }
        (space == Space::Inside ? inside : open) += volume;
        if (space == Space::Inside) know(lo, hi);
    }
    // An open cell of which so much is inside, between two shares.
    void add_part(const Point &lo, const Point &hi, double least, double most,
                  const Real3 &middle) {
        double volume = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            volume *= double(hi[i]) - lo[i];
            outer_lo[i] = std::min<double>(outer_lo[i], lo[i]);
            outer_hi[i] = std::max<double>(outer_hi[i], hi[i]);
        }
        inside += least * volume, open += (most - least) * volume;
        for (std::size_t i = 0; i < 3; ++i) {
            const double a = lo[i] - middle[i], b = hi[i] - middle[i];
            sizes += volume * std::max(std::fabs(a), std::fabs(b));
            least_moment[i] += volume * a * (a < 0 ? most : least);
            most_moment[i] += volume * b * (b > 0 ? most : least);
        }
    }
    void add(const CellSums &other) {
        inside += other.inside, open += other.open, sizes += other.sizes;
        for (std::size_t i = 0; i < 3; ++i) {
            moment[i] += other.moment[i];
            least_moment[i] += other.least_moment[i];
            most_moment[i] += other.most_moment[i];
            outer_lo[i] = std::min(outer_lo[i], other.outer_lo[i]);
            outer_hi[i] = std::max(outer_hi[i], other.outer_hi[i]);
            known_lo[i] = std::min(known_lo[i], other.known_lo[i]);
            known_hi[i] = std::max(known_hi[i], other.known_hi[i]);
        }
    }
};

struct Splitter {
    explicit Splitter(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    cpu::Boxes boxes;
};

double diagonal(const Piece &part) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) squares += std::pow(double(part.hi[i]) - part.lo[i], 2);
    return std::sqrt(squares);
}

// The share of a box, by half its sides, in which value + slope · p <= 0, p from its middle: of the
// simplices that a plane cuts off at its corners, added and taken away. Between two numbers, for what
// slopes of next to nothing may take. (Barrow and Smith 1979.)
std::array<double, 2> share_below(double value, const std::array<double, 3> &slope,
                                  const Real3 &half) {
    constexpr double little = 1e-3, rounding = 1e-9; // of the greatest; of a share
    std::array<double, 3> across{};                  // what the sides add
    for (std::size_t i = 0; i < 3; ++i) across[i] = 2 * std::fabs(slope[i]) * half[i];
    const double most = *std::ranges::max_element(across);
    double slack = 0, whole = 0, product = 1;
    std::vector<double> sides;
    for (const double a : across) {
        if (a < little * most || a == 0) {
            slack += 0.5 * a;
        } else {
            sides.push_back(a);
            whole += a, product *= a * static_cast<double>(sides.size());
        }
    }
    const auto share = [&](double above) { // of value <= above
        const double t = above - value + 0.5 * whole;
        if (t <= 0) return 0.0;
        if (t >= whole) return 1.0;
        double sum = 0;
        for (unsigned set = 0; set < 1u << sides.size(); ++set) {
            double rest = t;
            for (std::size_t i = 0; i < sides.size(); ++i)
                if (set >> i & 1) rest -= sides[i];
            if (rest > 0)
                sum += (std::popcount(set) % 2 ? -1 : 1) *
                       std::pow(rest, static_cast<double>(sides.size()));
        }
        return std::clamp(sum / product, 0.0, 1.0);
    };
    return {std::max(share(-slack) - rounding, 0.0), std::min(share(slack) + rounding, 1.0)};
}

// What an open box adds: by a plane, if its field is all but linear in it.
void add_open(Splitter &splitter, const cpu::ShortTape &tape, const Piece &piece,
              const Real3 &middle, CellSums &sums) {
    const auto linear = linear_over(splitter.evaluator, tape, splitter.boxes, piece.lo, piece.hi);
    if (!linear) return sums.add(piece.lo, piece.hi, Space::Open, middle);
    const Point at = middle_point(piece.lo, piece.hi);
    Real3 half{};
    for (std::size_t i = 0; i < 3; ++i) half[i] = 0.5 * (double(piece.hi[i]) - piece.lo[i]);
    double off = linear->off; // the middle is rounded
    for (std::size_t i = 0; i < 3; ++i)
        off += std::fabs(linear->slope[i]) *
               std::fabs(at[i] - 0.5 * (double(piece.lo[i]) + piece.hi[i]));
    sums.add_part(piece.lo, piece.hi, share_below(linear->value + off, linear->slope, half)[0],
                  share_below(linear->value - off, linear->slope, half)[1], middle);
}

// The eight parts of each of some open boxes: those that stay open.
std::vector<Piece> divided(Splitter &splitter, const cpu::ShortTape &tape,
                           const std::vector<Piece> &whole, double ulp, const Real3 &middle,
                           CellSums &sums) {
    constexpr std::size_t at_once = cpu::max_boxes / 16;
    std::vector<Piece> open, parts(8 * at_once);
    cpu::Boxes &boxes = splitter.boxes;
    for (std::size_t begin = 0; begin < whole.size(); begin += at_once) {
        const std::size_t count = std::min(at_once, whole.size() - begin);
        boxes.count = 16 * count;
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t k = 0; k < 8; ++k) {
                Piece &part = parts[8 * j + k];
                part = whole[begin + j];
                for (std::size_t i = 0; i < 3; ++i) {
                    const float cut = 0.5f * (part.lo[i] + part.hi[i]);
                    (k >> i & 1 ? part.lo : part.hi)[i] = cut;
                    boxes.lo[i][16 * j + k] = part.lo[i], boxes.hi[i][16 * j + k] = part.hi[i];
                    boxes.lo[i][16 * j + 8 + k] = boxes.hi[i][16 * j + 8 + k] =
                        0.5f * (part.lo[i] + part.hi[i]);
                }
            }
        ranges_over(splitter.evaluator, tape, boxes);
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t k = 0; k < 8; ++k) {
                const Piece &part = parts[8 * j + k];
                const std::size_t box = 16 * j + k;
                const Space space =
                    space_of(splitter.evaluator, box, 0.5 * diagonal(part), ulp, true);
                if (splitter.evaluator.ranges.result_hi[box + 8] < 0) {
                    Point at;
                    for (std::size_t i = 0; i < 3; ++i) at[i] = boxes.lo[i][box + 8];
                    sums.know(at, at);
                }
                if (space == Space::Open)
                    open.push_back(part);
                else
                    sums.add(part.lo, part.hi, space, middle);
            }
    }
    return open;
}

// A leaf's own tape, shorter than its task's.
TapePtr tape_of(Splitter &splitter, const Octree &octree, const Cell &leaf, const Piece &piece) {
    const std::int32_t task = octree.nodes[static_cast<std::size_t>(leaf.node)].task;
    const TapePtr &tape = octree.tapes[static_cast<std::size_t>(task)];
    cpu::Boxes &boxes = splitter.boxes;
    boxes.count = 16;
    for (std::size_t k = 0; k < boxes.count; ++k)
        for (std::size_t i = 0; i < 3; ++i)
            boxes.lo[i][k] = piece.lo[i], boxes.hi[i][k] = piece.hi[i];
    ranges_over(splitter.evaluator, *tape, boxes);
    return shortened_in_first(splitter.evaluator, tape);
}

Piece piece_of(const Lattice &lattice, const Cell &leaf) {
    return {point_of(lattice, leaf.at),
            point_of(lattice, corner(leaf.at, lattice.cells(leaf.level), 7))};
}

// How often open leaves are divided: as the work allows, by four parts of each that stay open, but twice
// at least, so that smaller leaves say more.
int levels_for(const Field &field, const Octree &octree, const std::vector<Cell> &leaves,
               double most_work) {
    Splitter splitter(field);
    const std::size_t step = std::max<std::size_t>(leaves.size() / sampled, 1);
    double cost = 0, count = 0;
    for (std::size_t k = 0; k < leaves.size(); k += step, ++count)
        cost += tape_of(splitter, octree, leaves[k], piece_of(octree.lattice, leaves[k]))->cost;
    if (count == 0) return 0;
    cost *= 16 * static_cast<double>(leaves.size()) / count;
    int levels = 0;
    for (double work = cost; levels < least_levels || (levels < most_levels && work <= most_work);
         work += cost) {
        ++levels;
        cost *= 4;
    }
    return levels;
}

// What the octree left out as inside, and the corners that are in the solid.
CellSums sums_of_octree(const Octree &octree, const Real3 &middle) {
    CellSums sums;
    std::vector<Cell> stack{{0, 0, {}}};
    while (!stack.empty()) {
        const Cell cell = stack.back();
        stack.pop_back();
        const Node &node = octree.nodes[static_cast<std::size_t>(cell.node)];
        const std::int32_t side = octree.lattice.cells(cell.level);
        if (node.children != none) {
            for (int k = 0; k < 8; ++k)
                stack.push_back({node.children + k, cell.level + 1, corner(cell.at, side / 2, k)});
        } else if (node.space == Space::Inside) {
            sums.add(point_of(octree.lattice, cell.at),
                     point_of(octree.lattice, corner(cell.at, side, 7)), node.space, middle);
        } else if (node.space == Space::Open) {
            for (int c = 0; c < 8; ++c) {
                if (!(node.signs >> c & 1)) continue;
                const Point at = point_of(octree.lattice, corner(cell.at, side, c));
                sums.know(at, at);
            }
        }
    }
    return sums;
}

// a / b, b > 0.
Enclosure quotient(Enclosure a, Enclosure b) {
    return {a.lo / (a.lo < 0 ? b.lo : b.hi), a.hi / (a.hi < 0 ? b.hi : b.lo)};
}

} // namespace

Measures measure(const ir::Scene &scene, const Settings &settings, const Made &made,
                 Progress &progress, double work) {
    const Octree &octree = made.octree;
    const Field field(scene, settings.time, settings.bounds);
    const Real3 middle = sums_of(made.mesh).center;
    CellSums sums = sums_of_octree(octree, middle);
    const std::vector<Cell> leaves = open_leaves(octree);
    constexpr double of_planes = 16; // a plane takes so many times what dividing does, about
    const int by_planes = levels_for(field, octree, leaves, work / of_planes),
              by_dividing = levels_for(field, octree, leaves, work);
    constexpr std::size_t piece_of_work = 256; // leaves
    std::vector<CellSums> found((leaves.size() + piece_of_work - 1) / piece_of_work);
    in_parallel(
        found.size(), threads_of(settings), progress, [&] { return Splitter(field); },
        [&](Splitter &splitter, std::size_t number) {
            const std::size_t end = std::min(leaves.size(), (number + 1) * piece_of_work);
            for (std::size_t k = number * piece_of_work; k < end; ++k) {
                std::vector<Piece> open{piece_of(octree.lattice, leaves[k])};
                const TapePtr tape = tape_of(splitter, octree, leaves[k], open[0]);
                const bool flat =
                    linear_over(splitter.evaluator, *tape, splitter.boxes, open[0].lo, open[0].hi)
                        .has_value();
                const int levels = flat ? by_planes : by_dividing;
                for (int level = 0; level < levels && !open.empty(); ++level)
                    open =
                        divided(splitter, *tape, open, octree.lattice.ulp, middle, found[number]);
                for (const Piece &piece : open)
                    if (flat)
                        add_open(splitter, *tape, piece, middle, found[number]);
                    else
                        found[number].add(piece.lo, piece.hi, Space::Open, middle);
            }
        });
    for (const CellSums &some : found) sums.add(some);

    Measures measures;
    measures.used_bound = field.proved;
    measures.volume = {sums.inside * (1 - rounding_share),
                       (sums.inside + sums.open) * (1 + rounding_share)};
    for (std::size_t i = 0; i < 3; ++i) {
        const double slack =
            rounding_share * (sums.sizes + std::fabs(middle[i]) * measures.volume.hi);
        const Enclosure way = quotient({sums.moment[i] + sums.least_moment[i] - slack,
                                        sums.moment[i] + sums.most_moment[i] + slack},
                                       measures.volume);
        // The centre lies in the solid's box, however little is known of its volume.
        measures.center[i] = {std::max(middle[i] + way.lo, sums.outer_lo[i]),
                              std::min(middle[i] + way.hi, sums.outer_hi[i])};
        measures.least[i] = {sums.outer_lo[i], sums.known_lo[i]};
        measures.greatest[i] = {sums.known_hi[i], sums.outer_hi[i]};
    }
    return measures;
}

MeshSums sums_of(const Mesh &mesh) {
    MeshSums sums;
    if (mesh.vertices.empty()) return sums;
    // About one of its vertices, so that nothing is lost far from the origin.
    const Point &origin = mesh.vertices[0];
    Real3 moment{};
    for (const auto &t : mesh.triangles) {
        std::array<Real3, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i)
                p[k][i] = double(mesh.vertices[t[k]][i]) - origin[i];
        Real3 u, v;
        for (std::size_t i = 0; i < 3; ++i) u[i] = p[1][i] - p[0][i], v[i] = p[2][i] - p[0][i];
        const Real3 n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]};
        sums.area += 0.5 * std::hypot(n[0], n[1], n[2]);
        const double volume = (p[0][0] * n[0] + p[0][1] * n[1] + p[0][2] * n[2]) / 6;
        sums.volume += volume;
        for (std::size_t i = 0; i < 3; ++i) moment[i] += volume * (p[0][i] + p[1][i] + p[2][i]) / 4;
    }
    for (std::size_t i = 0; i < 3; ++i)
        sums.center[i] = origin[i] + (sums.volume != 0 ? moment[i] / sums.volume : 0);
    return sums;
}

} // namespace fathom::mesh
