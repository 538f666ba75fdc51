// From the surface to the mesh: docs/meshes.md, 6, theorem 5.
#include "mesh/inquiry.h"
#include "mesh/seams.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int finest_box = 4;        // divisions of a leaf by halves
constexpr std::size_t seam_work = 3; // divisions of boxes that have to be left to look for one
constexpr int least_finest_box = 2;  // … of one that is smaller than a drawing cell
constexpr int seam_depth = 2;        // … of which seams are looked for, and in the whole

struct Box {
    Point lo, hi;
    bool far = false; // there is no mesh near its middle
};
Real3 middle_of(const Box &box) {
    Real3 m{};
    for (std::size_t i = 0; i < 3; ++i) m[i] = 0.5 * (double(box.lo[i]) + box.hi[i]);
    return m;
}
Box part_of(const Box &box, std::size_t k) {
    Box part = box;
    for (std::size_t i = 0; i < 3; ++i)
        (k >> i & 1 ? part.lo : part.hi)[i] = 0.5f * (box.lo[i] + box.hi[i]);
    return part;
}
// A box and its middle, for space_of.
void put_box(const Box &box, std::size_t at, cpu::Boxes &boxes) {
    for (std::size_t i = 0; i < 3; ++i) {
        boxes.lo[i][at] = box.lo[i], boxes.hi[i][at] = box.hi[i];
        boxes.lo[i][at + 8] = boxes.hi[i][at + 8] = 0.5f * (box.lo[i] + box.hi[i]);
    }
}
// Of a box that was put there.
bool is_open(const Inquiry &inquiry, const Evaluator &evaluator, std::size_t at, const Box &box) {
    return space_of(evaluator, at, 0.5 * distance(real(box.lo), real(box.hi)),
                    inquiry.made.octree.lattice.ulp, inquiry.trusts, true) == Space::Open;
}
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
                parts.push_back(part_of(box, k));
                put_box(parts.back(), 16 * j + k, boxes);
            }
        }
        ranges_over(evaluator, tape, boxes);
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t k = 0; k < 8; ++k)
                if (const Box &part = parts[8 * j + k];
                    is_open(inquiry, evaluator, 16 * j + k, part))
                    open.push_back(part);
    }
    return open;
}
void find_own(const Inquiry &inquiry, const Cell &leaf, Candidates &candidates) {
    candidates.own.clear();
    candidates.vertices.clear();
    if (!inquiry.own) return;
    const auto at = std::ranges::lower_bound(inquiry.patches, std::pair{leaf.node, 0u});
    for (auto p = at; p != inquiry.patches.end() && p->first == leaf.node; ++p) {
        if (inquiry.first_at[p->second] < inquiry.first_at[p->second + 1])
            candidates.vertices.push_back(p->second);
        for (std::uint32_t k = inquiry.first_at[p->second]; k < inquiry.first_at[p->second + 1];
             ++k)
            candidates.own.push_back(inquiry.at_vertex[k]);
    }
}

// The distance of a triangle that is near enough, or else of the nearest.
double first_near(const Inquiry &inquiry, const std::vector<std::uint32_t> &triangles,
                  const Real3 &to, double enough) {
    double d = 2 * inquiry.allowed;
    for (std::size_t k = 0; k < triangles.size() && d > enough; ++k)
        d = std::min(d, to_triangle(to, inquiry.triangles[triangles[k]]));
    return d;
}

// What is found of the surface in a leaf.
struct Reach {
    bool decided = true;
    bool empty = true;                  // as far as is known: there is none
    double farthest = 0;                // from the mesh at most
    std::optional<double> seam_width{}; // where parts of the leaf are left out as seams
    Point doubt{};                      // of what is not decided: about there
};

// What a piece of work may still take: divisions of boxes, and runs of tapes over boxes where planes
// that parts touch in may meet.
struct Budget {
    std::size_t divisions = 0, close_runs = 0;
};

// What the look into one leaf shares.
struct LeafLook {
    const Inquiry &inquiry;
    Evaluator &evaluator;
    cpu::Boxes &boxes;
    Budget &budget;
    TapePtr tape; // holds in the leaf
    Reach reach{};
    bool hopeless = false; // it holds surface that is too far from the mesh: at the doubt

    // Whether surface between two places of different signs in a box is farther than is allowed.
    void look_between(const std::array<Point, 2> &ends) {
        constexpr int steps = 32;
        Points points;
        for (int k = 0; k <= steps; ++k) {
            Point p{};
            for (std::size_t i = 0; i < 3; ++i)
                p[i] = ends[0][i] + (ends[1][i] - ends[0][i]) * static_cast<float>(k) / steps;
            points.add(p);
        }
        std::vector<float> values;
        values_at(evaluator, *tape, points, values);
        for (std::size_t k = 1; k < values.size(); ++k) {
            if ((values[k] <= 0) == (values[0] <= 0)) continue;
            const Real3 at = real(points[k]);
            hopeless = !inquiry.tree->nearest(
                at, (inquiry.allowed + distance(at, real(points[k - 1]))) * outward,
                2 * inquiry.allowed);
            if (hopeless) reach.doubt = points[k];
            return;
        }
    }

    bool is_seam(const Box &box, const Sighting &seen, bool may_wait) {
        if (budget.divisions < seam_work) return false;
        const bool closely = budget.close_runs > 0 && !may_wait;
        const auto [seam, runs] = search_seam(evaluator, *tape, boxes, {box.lo, box.hi}, seen,
                                              seam_thickness(inquiry.made.octree.lattice), closely);
        std::size_t &left = closely ? budget.close_runs : budget.divisions;
        left -= std::min(left, runs);
        if (seam) reach.seam_width = std::max(reach.seam_width.value_or(0), seam->width);
        return seam.has_value();
    }

    // Takes boxes away that are seams, beginning with the one in the middle. `to_first`: it ends with the
    // first that is none, which alone is left. `first`: boxes that are not far are not looked into closely,
    // `far_alone`: nor asked.
    void leave_out_seams(std::vector<Box> &left, bool to_first, bool first, bool far_alone) {
        constexpr std::size_t at_once = 28; // as many as a run of the tape takes
        if (budget.divisions < seam_work) return;
        std::vector<Box> kept;
        std::ranges::rotate(left, left.begin() + static_cast<std::ptrdiff_t>(left.size() / 2));
        std::vector<Extent> extents;
        for (std::size_t from = 0; from < left.size(); from += at_once) {
            const auto some = std::span(left).subspan(from, std::min(at_once, left.size() - from));
            extents.clear();
            for (const Box &box : some)
                if (box.far || !far_alone) extents.push_back({box.lo, box.hi});
            const std::vector<Sighting> seen = look_for_seams(
                evaluator, *tape, extents, seam_thickness(inquiry.made.octree.lattice));
            std::size_t next = 0;
            for (const Box &box : some) {
                const bool asked = box.far || !far_alone;
                if (asked) {
                    const Sighting &sighting = seen[next++];
                    if (is_seam(box, sighting, first && !box.far)) continue;
                    if (box.far && sighting.ends) look_between(*sighting.ends);
                    if (hopeless) return;
                }
                kept.push_back(box);
                if (to_first) {
                    left = std::move(kept);
                    return;
                }
            }
        }
        left = std::move(kept);
    }
};

// Boxes that are near enough to the mesh are taken away.
void leave_out_near(const Inquiry &inquiry, const Candidates &candidates, std::vector<Box> &boxes,
                    double &farthest) {
    std::vector<Box> left;
    for (const Box &box : boxes) {
        const Real3 middle = middle_of(box);
        const double half = 0.5 * distance(real(box.lo), real(box.hi));
        // The first that is near enough will do: the claim is no more than what is allowed.
        const double enough = inquiry.allowed - half;
        double d =
            enough < 0 ? 2 * inquiry.allowed : first_near(inquiry, candidates.own, middle, enough);
        if (d > enough && enough >= 0)
            if (const auto near = inquiry.tree->nearest(middle, inquiry.allowed, enough))
                d = near->distance;
        if (d <= enough)
            farthest = std::max(farthest, (d + half) * outward);
        else
            left.push_back({box.lo, box.hi, d >= inquiry.allowed});
    }
    boxes = std::move(left);
}

// Decided: no surface in a leaf is farther from the mesh than is allowed, but at seams. It would be
// undecided too where that took more divisions of boxes than are left.
Reach reach_in(const Inquiry &inquiry, Evaluator &evaluator, cpu::Boxes &boxes,
               Candidates &candidates, const Cell &leaf, bool searched, Budget &budget) {
    const Octree &octree = inquiry.made.octree;
    const std::int32_t side = octree.lattice.cells(leaf.level);
    const Node &node = octree.nodes[static_cast<std::size_t>(leaf.node)];
    const Box whole{point_of(octree.lattice, leaf.at),
                    point_of(octree.lattice, corner(leaf.at, side, 7)), false};
    find_own(inquiry, leaf, candidates);
    // What was divided already is divided less here: it may be divided again.
    const int deepest =
        std::max(least_finest_box, finest_box - std::max(0, leaf.level - octree.lattice.level));
    std::vector<Box> open{whole};
    LeafLook look{inquiry, evaluator, boxes, budget,
                  octree.tapes[static_cast<std::size_t>(node.task)]};
    Reach &reach = look.reach;
    for (int depth = 0; !open.empty(); ++depth) {
        const std::size_t all = open.size();
        leave_out_near(inquiry, candidates, open, reach.farthest);
        reach.empty = reach.empty && open.size() == all;
        if (open.empty()) break;
        if (depth == 0) look.tape = tape_in(evaluator, boxes, look.tape, whole.lo, whole.hi);
        const bool last = depth == deepest || searched;
        if (depth % seam_depth == 0)
            look.leave_out_seams(open, last, depth == 0 && !last, depth == 0 && node.crossed());
        if (open.empty()) break;
        if (look.hopeless) {
            reach.decided = false;
            break;
        }
        if (last || open.size() > budget.divisions) {
            reach.decided = false;
            for (std::size_t i = 0; i < 3; ++i)
                reach.doubt[i] = static_cast<float>(middle_of(open[0])[i]);
            break;
        }
        budget.divisions -= open.size();
        open = open_parts(inquiry, evaluator, boxes, *look.tape, open);
    }
    reach.empty = reach.empty && reach.decided && !reach.seam_width;
    return reach;
}

constexpr std::size_t piece_of_work = 512;
constexpr std::size_t divisions_a_leaf = 32; // of boxes, on average over a piece of work
constexpr std::size_t close_runs = 16384;    // in a piece of work

struct Certifier {
    explicit Certifier(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    cpu::Boxes boxes;
    Candidates candidates;
};

// The parts of some leaves that are next to each other, and whose they are.
struct Halves {
    std::vector<Box> boxes;
    std::vector<std::size_t> leaves;
    void keep(const auto &is_kept) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < boxes.size(); ++k) {
            if (!is_kept(k)) continue;
            boxes[kept] = boxes[k], leaves[kept] = leaves[k];
            ++kept;
        }
        boxes.resize(kept), leaves.resize(kept);
    }
};

Box around(const std::vector<Box> &boxes) {
    Box all = boxes[0];
    for (const Box &box : boxes)
        for (std::size_t i = 0; i < 3; ++i)
            all.lo[i] = std::min(all.lo[i], box.lo[i]), all.hi[i] = std::max(all.hi[i], box.hi[i]);
    return all;
}

// Takes halves of a leaf away that its own vertices or triangles are near enough to.
void add_halves(const Inquiry &inquiry, const Cell &leaf, std::size_t number,
                Candidates &candidates, Reach &reach, Halves &left) {
    const Lattice &lattice = inquiry.made.octree.lattice;
    const Box whole{point_of(lattice, leaf.at),
                    point_of(lattice, corner(leaf.at, lattice.cells(leaf.level), 7))};
    find_own(inquiry, leaf, candidates);
    for (std::size_t k = 0; k < 8; ++k) {
        const Box part = part_of(whole, k);
        const Real3 middle = middle_of(part);
        const double half = 0.5 * distance(real(part.lo), real(part.hi));
        const double enough = inquiry.allowed - half;
        double d = 2 * inquiry.allowed;
        for (const std::uint32_t v : candidates.vertices)
            d = std::min(d, distance(middle, real(inquiry.made.mesh.vertices[v])));
        if (d > enough) d = first_near(inquiry, candidates.own, middle, enough);
        if (d <= enough) {
            reach.farthest = std::max(reach.farthest, (d + half) * outward);
            reach.empty = false;
        } else {
            left.boxes.push_back(part);
            left.leaves.push_back(number);
        }
    }
}

// What the halves of leaves alone show: most leaves are decided by it. All have one tape, which is
// shortened once for all of them.
std::vector<Reach> reach_by_halves(const Inquiry &inquiry, Certifier &memory,
                                   std::span<const Cell> leaves) {
    std::vector<Reach> reach(leaves.size());
    Halves left;
    for (std::size_t n = 0; n < leaves.size(); ++n)
        add_halves(inquiry, leaves[n], n, memory.candidates, reach[n], left);
    if (left.boxes.empty()) return reach;
    const Octree &octree = inquiry.made.octree;
    const Node &node = octree.nodes[static_cast<std::size_t>(leaves[0].node)];
    const Box all = around(left.boxes);
    const TapePtr tape = tape_in(memory.evaluator, memory.boxes,
                                 octree.tapes[static_cast<std::size_t>(node.task)], all.lo, all.hi);
    constexpr std::size_t at_once = cpu::max_boxes / 2;
    std::vector<bool> open(left.boxes.size());
    for (std::size_t begin = 0; begin < left.boxes.size(); begin += at_once) {
        const std::size_t count = std::min(at_once, left.boxes.size() - begin);
        memory.boxes.count = 16 * ((count + 7) / 8);
        for (std::size_t k = 0; k < memory.boxes.count / 2; ++k)
            put_box(left.boxes[begin + std::min(k, count - 1)], 16 * (k / 8) + k % 8, memory.boxes);
        ranges_over(memory.evaluator, *tape, memory.boxes);
        for (std::size_t k = 0; k < count; ++k)
            open[begin + k] =
                is_open(inquiry, memory.evaluator, 16 * (k / 8) + k % 8, left.boxes[begin + k]);
    }
    left.keep([&](std::size_t k) { return open[k]; });
    for (std::size_t k = 0; k < left.boxes.size(); ++k) {
        const Box &box = left.boxes[k];
        Reach &here = reach[left.leaves[k]];
        if (!here.decided) continue;
        const double half = 0.5 * distance(real(box.lo), real(box.hi));
        const double enough = inquiry.allowed - half;
        const auto near = inquiry.tree->nearest(middle_of(box), inquiry.allowed, enough);
        here.empty = false;
        here.decided = near && near->distance <= enough;
        if (here.decided)
            here.farthest = std::max(here.farthest, (near->distance + half) * outward);
    }
    return reach;
}

// How many leaves from the first on are next to each other, and have its tape.
std::size_t group_of(const Octree &octree, std::span<const Cell> leaves) {
    constexpr std::size_t most = 64;
    constexpr int levels = 2; // above the drawing cells
    const int shift = octree.lattice.depth - octree.lattice.level + levels;
    const auto same = [&](const Cell &leaf) {
        for (std::size_t i = 0; i < 3; ++i)
            if (leaf.at[i] >> shift != leaves[0].at[i] >> shift) return false;
        return octree.nodes[static_cast<std::size_t>(leaf.node)].task ==
               octree.nodes[static_cast<std::size_t>(leaves[0].node)].task;
    };
    std::size_t count = 1;
    while (count < std::min(most, leaves.size()) && same(leaves[count])) ++count;
    return count;
}

} // namespace

void certify_surface(const Inquiry &inquiry, unsigned threads, Progress &progress,
                     Certificate &certificate) {
    const Lattice &lattice = inquiry.made.octree.lattice;
    std::vector<Cell> leaves = open_leaves(inquiry.made.octree);
    std::ranges::sort(certificate.empty);
    std::erase_if(leaves, [&](const Cell &leaf) {
        return inquiry.proved_before(real(point_of(lattice, leaf.at))) ||
               std::ranges::binary_search(certificate.empty, leaf.node);
    });
    // What was searched for in vain is not searched again.
    std::vector<std::int32_t> searched;
    for (const Cell &cell : inquiry.made.octree.undecided) searched.push_back(cell.node);
    std::ranges::sort(searched);
    struct Found {
        double farthest = 0, seam_width = 0;
        std::vector<Cell> undecided, seams;
        std::vector<Point> doubts;
        std::vector<std::int32_t> empty;
        std::size_t divisions = 0;
    };
    std::vector<Found> found((leaves.size() + piece_of_work - 1) / piece_of_work);
    in_parallel(
        found.size(), threads, progress, [&] { return Certifier(inquiry.field); },
        [&](Certifier &memory, std::size_t number) {
            const std::size_t end = std::min(leaves.size(), (number + 1) * piece_of_work);
            Budget budget{divisions_a_leaf * piece_of_work, close_runs};
            Found &here = found[number];
            std::vector<Reach> early;
            for (std::size_t k = number * piece_of_work, next = k; k < end; ++k) {
                if (inquiry.in_vain()) return;
                if (k == next) {
                    const auto rest = std::span(leaves).subspan(k, end - k);
                    const std::size_t count = group_of(inquiry.made.octree, rest);
                    early = reach_by_halves(inquiry, memory, rest.first(count));
                    next += count;
                }
                Reach reach = early[k + early.size() - next];
                if (!reach.decided) {
                    const bool in_vain = std::ranges::binary_search(searched, leaves[k].node);
                    reach = reach_in(inquiry, memory.evaluator, memory.boxes, memory.candidates,
                                     leaves[k], in_vain, budget);
                }
                here.divisions = divisions_a_leaf * piece_of_work - budget.divisions;
                if (!reach.decided) {
                    inquiry.doubted = true;
                    here.undecided.push_back(leaves[k]);
                    here.doubts.push_back(reach.doubt);
                    continue;
                }
                if (reach.empty) here.empty.push_back(leaves[k].node);
                here.farthest = std::max(here.farthest, reach.farthest);
                if (!(reach.seam_width > 0.0)) continue;
                here.seams.push_back(leaves[k]);
                here.seam_width = std::max(here.seam_width, *reach.seam_width);
            }
        });
    for (const Found &some : found) {
        certificate.surface_to_mesh = std::max(certificate.surface_to_mesh, some.farthest);
        certificate.seam_width = std::max(certificate.seam_width, some.seam_width);
        certificate.divisions += some.divisions;
        const auto append = [](auto &to, const auto &what) {
            to.insert(to.end(), what.begin(), what.end());
        };
        append(certificate.undecided, some.undecided);
        append(certificate.doubts, some.doubts);
        append(certificate.seams, some.seams);
        append(certificate.empty, some.empty);
    }
}

} // namespace fathom::mesh
