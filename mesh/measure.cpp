#include "mesh/measure.h"

#include "mesh/seams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fathom::mesh {
namespace {

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
    double least_area = 0, most_area = 0;
    std::size_t open_places = 0; // boxes of which no greatest area is known, and the first of them
    Real3 open_place{};
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
    void add_open_place(const Point &lo, const Point &hi) {
        for (std::size_t i = 0; open_places == 0 && i < 3; ++i)
            open_place[i] = 0.5 * (double(lo[i]) + hi[i]);
        ++open_places;
    }
    void add(const CellSums &other) {
        inside += other.inside, open += other.open, sizes += other.sizes;
        least_area += other.least_area, most_area += other.most_area;
        if (open_places == 0) open_place = other.open_place;
        open_places += other.open_places;
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

// What a walk over open leaves goes by.
struct Walk {
    Real3 middle{};
    double ulp = 0, thin = 0;           // seam_thickness
    int by_planes = 0, by_dividing = 0; // how often leaves are divided
    int spare = 0;                      // boxes of a leaf that are divided more often
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

// What an open box adds: by a plane, if its field is all but linear in it.
void add_open(const Piece &piece, const std::optional<Linear> &linear, const Real3 &middle,
              CellSums &sums) {
    if (!linear) return sums.add(piece.lo, piece.hi, Space::Open, middle);
    const Enclosure share = share_of(piece.lo, piece.hi, *linear);
    sums.add_part(piece.lo, piece.hi, share.lo, share.hi, middle);
}

// The eight parts of each of some open boxes: those that stay open. `graph`: that they are in.
std::vector<Piece> divided(Splitter &splitter, const cpu::ShortTape &tape,
                           const std::vector<Piece> &whole, const Walk &walk, CellSums &sums,
                           Graph *graph = nullptr) {
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
                    space_of(splitter.evaluator, box, 0.5 * diagonal(part), walk.ulp, true);
                if (splitter.evaluator.ranges.result_hi[box + 8] < 0) {
                    Point at;
                    for (std::size_t i = 0; i < 3; ++i) at[i] = boxes.lo[i][box + 8];
                    sums.know(at, at);
                }
                if (space == Space::Open)
                    open.push_back(part);
                else
                    sums.add(part.lo, part.hi, space, walk.middle);
                if (space == Space::Inside && graph) graph->add_inside(part.lo, part.hi);
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

// Boxes that lie across an edge of the surface, or about a place where none of its directions is
// known, are divided so often more.
constexpr int for_edges = 2, for_places = 5;

void add_area(const Enclosure &area, CellSums &sums) {
    sums.least_area += area.lo, sums.most_area += area.hi;
}

// What an open box adds that is divided so often. `linear`: of the box.
void walk_graph(Splitter &splitter, const cpu::ShortTape &tape, const Piece &piece,
                const std::optional<Linear> &linear, const Slant &slant, int levels,
                const Walk &walk, CellSums &sums) {
    Graph graph{piece.lo, piece.hi, {}};
    std::vector<Piece> open{piece};
    for (int level = 0; level < levels && !open.empty(); ++level)
        open = divided(splitter, tape, open, walk, sums, &graph);
    for (const Piece &part : open) {
        const std::optional<Linear> of =
            levels == 0 ? linear
                        : linear_over(splitter.evaluator, tape, splitter.boxes, part.lo, part.hi);
        add_open(part, of, walk.middle, sums);
        graph.add_open(part.lo, part.hi, of);
    }
    add_area(graph.area(slant), sums);
}

// The same of a box that is not known to hold a graph. `more`: so often it may be divided beyond
// `levels`, for the area's sake, while there are boxes to spare.
void walk_piece(Splitter &splitter, const cpu::ShortTape &tape, const Piece &piece, int levels,
                int more, int &spare, const Walk &walk, CellSums &sums) {
    constexpr int of_seam = 8; // a search takes so many times what a box does, about
    constexpr double well = 1.02, across_edge = 1.05;
    const std::optional<Linear> linear =
        linear_over(splitter.evaluator, tape, splitter.boxes, piece.lo, piece.hi);
    const std::optional<Slant> slant =
        linear ? slant_in(splitter.evaluator, tape, splitter.boxes, piece.lo, piece.hi, *linear)
               : std::nullopt;
    const bool last =
        levels <= 0 && (!linear || spare <= 0 || more <= (slant ? for_places - for_edges : 0));
    if (slant && (slant->most < well || last || (levels <= 0 && slant->most < across_edge)))
        return walk_graph(splitter, tape, piece, linear, *slant, std::max(levels, 0), walk, sums);
    const bool asked = linear && !slant && spare > 0;
    if (asked) spare -= of_seam;
    const bool touches =
        asked && seam_in(splitter.evaluator, tape, splitter.boxes, piece.lo, piece.hi, walk.thin);
    if (touches || last) {
        add_open(piece, linear, walk.middle, sums);
        if (!touches) sums.add_open_place(piece.lo, piece.hi);
        return;
    }
    if (levels <= 0) --spare;
    for (const Piece &part : divided(splitter, tape, {piece}, walk, sums))
        walk_piece(splitter, tape, part, levels - 1, levels <= 0 ? more - 1 : more, spare, walk,
                   sums);
}

// What an open leaf adds.
void walk_leaf(Splitter &splitter, const Octree &octree, const Cell &leaf, const Walk &walk,
               CellSums &sums) {
    std::vector<Piece> open{piece_of(octree.lattice, leaf)};
    const TapePtr tape = tape_of(splitter, octree, leaf, open[0]);
    int spare = walk.spare;
    if (linear_over(splitter.evaluator, *tape, splitter.boxes, open[0].lo, open[0].hi))
        return walk_piece(splitter, *tape, open[0], walk.by_planes, for_places, spare, walk, sums);
    for (int level = 0; level < walk.by_dividing && !open.empty(); ++level)
        open = divided(splitter, *tape, open, walk, sums);
    for (const Piece &piece : open) {
        add_open(piece, {}, walk.middle, sums);
        sums.add_open_place(piece.lo, piece.hi);
    }
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
    constexpr std::size_t spare = 400'000, least_spare = 32, most_spare = 512; // of all; of a leaf
    const Walk walk{middle,
                    octree.lattice.ulp,
                    seam_thickness(octree.lattice),
                    levels_for(field, octree, leaves, work / of_planes),
                    levels_for(field, octree, leaves, work),
                    static_cast<int>(std::clamp(spare / std::max<std::size_t>(leaves.size(), 1),
                                                least_spare, most_spare))};
    constexpr std::size_t piece_of_work = 256; // leaves
    std::vector<CellSums> found((leaves.size() + piece_of_work - 1) / piece_of_work);
    in_parallel(
        found.size(), threads_of(settings), progress, [&] { return Splitter(field); },
        [&](Splitter &splitter, std::size_t number) {
            const std::size_t end = std::min(leaves.size(), (number + 1) * piece_of_work);
            for (std::size_t k = number * piece_of_work; k < end; ++k)
                walk_leaf(splitter, octree, leaves[k], walk, found[number]);
        });
    for (const CellSums &some : found) sums.add(some);

    Measures measures;
    measures.used_bound = field.proved;
    measures.volume = {sums.inside * (1 - rounding_share),
                       (sums.inside + sums.open) * (1 + rounding_share)};
    // No solid of that volume has less surface than a ball.
    const double ball = std::cbrt(36 * std::numbers::pi) * std::pow(measures.volume.lo, 2.0 / 3);
    measures.area = {std::max(sums.least_area, ball) * (1 - rounding_share),
                     sums.open_places > 0 ? unbounded : sums.most_area * (1 + rounding_share)};
    measures.open_places = sums.open_places;
    measures.open_place = sums.open_place;
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
