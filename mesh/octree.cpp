#include "mesh/octree.h"

#include "mesh/ambiguous.h"
#include "mesh/seams.h"
#include "mesh/thin.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

// How many boxes are looked at for what no corner shows: so many, or so many a crossed cell.
constexpr std::size_t least_hidden_boxes = 2'000'000, hidden_boxes_a_cell = 64;
constexpr std::size_t most_close = 4096; // cells that are looked into closely for seams
constexpr int task_levels = 4;           // of a task, down to the lattice's level

// One thread's memory for dividing.
struct Divider {
    explicit Divider(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    cpu::Boxes boxes;
    std::vector<std::uint64_t> keys;
    Points points;
    std::vector<float> values;
};

double half_diagonal(const Lattice &lattice, int level) {
    return 0.8660254037844387 * lattice.side(level);
}

// The eight parts of a cell and their middles, into boxes from `first` on.
void put_parts(const Lattice &lattice, const Index &at, int level, std::size_t first,
               cpu::Boxes &boxes) {
    const std::int32_t half = lattice.cells(level + 1);
    for (int part = 0; part < 8; ++part) {
        const Index lo = corner(at, half, part);
        const std::size_t k = first + static_cast<std::size_t>(part), middle = k + 8;
        for (std::size_t i = 0; i < 3; ++i) {
            const float a = lattice.at(i, lo[i]), b = lattice.at(i, lo[i] + half);
            boxes.lo[i][k] = a, boxes.hi[i][k] = b;
            boxes.lo[i][middle] = boxes.hi[i][middle] = 0.5f * (a + b);
        }
    }
}

struct Branch { // a node of the levels above the tasks
    Cell cell;
    TapePtr tape;
};

// The levels above the tasks, one after the other.
std::vector<Branch> divide_top(Octree &octree, const Field &field, const OctreeSettings &settings,
                               Progress &progress, int levels) {
    std::vector<Branch> branches{{{0, 0, {}}, field.whole}};
    octree.nodes.emplace_back();
    struct Parts {
        std::array<Space, 8> space{};
        std::array<TapePtr, 8> tapes;
    };
    for (int level = 0; level < levels; ++level) {
        std::vector<Parts> made(branches.size());
        const double half_way = half_diagonal(octree.lattice, level + 1);
        in_parallel(
            branches.size(), settings.threads, progress, [&] { return Divider(field); },
            [&](Divider &divider, std::size_t number) {
                const Branch &branch = branches[number];
                divider.boxes.count = 16;
                put_parts(octree.lattice, branch.cell.at, level, 0, divider.boxes);
                ranges_over(divider.evaluator, *branch.tape, divider.boxes);
                std::uint64_t open = 0;
                for (std::size_t k = 0; k < 8; ++k) {
                    made[number].space[k] =
                        space_of(divider.evaluator, k, half_way, octree.lattice.ulp,
                                 settings.trusts_bounds, true);
                    if (made[number].space[k] == Space::Open) open |= std::uint64_t{1} << k;
                }
                const auto tapes = shortened(divider.evaluator, branch.tape, open);
                std::copy_n(tapes.begin(), 8, made[number].tapes.begin());
            });
        if (progress.cancelled) return {};
        std::vector<Branch> below;
        const std::int32_t half = octree.lattice.cells(level + 1);
        for (std::size_t number = 0; number < branches.size(); ++number) {
            const auto first = static_cast<std::int32_t>(octree.nodes.size());
            octree.nodes[static_cast<std::size_t>(branches[number].cell.node)].children = first;
            for (int k = 0; k < 8; ++k) {
                const auto part = static_cast<std::size_t>(k);
                octree.nodes.push_back({none, none, made[number].space[part], 0, 0});
                if (made[number].space[part] == Space::Open)
                    below.push_back(
                        {{first + k, level + 1, corner(branches[number].cell.at, half, k)},
                         std::move(made[number].tapes[part])});
            }
        }
        branches = std::move(below);
    }
    return branches;
}

std::uint64_t corner_key(const Index &at) {
    return std::uint64_t(std::uint32_t(at[0])) << 42 | std::uint64_t(std::uint32_t(at[1])) << 21 |
           std::uint64_t(std::uint32_t(at[2]));
}
Index corner_of_key(std::uint64_t key) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
    return {static_cast<std::int32_t>(key >> 42), static_cast<std::int32_t>(key >> 21 & mask),
            static_cast<std::int32_t>(key & mask)};
}

// The signs at the corners of cells in which a tape holds.
void sign(Divider &divider, const Lattice &lattice, const cpu::ShortTape &tape,
          const std::vector<Cell> &cells, std::vector<Node> &nodes) {
    divider.keys.clear();
    for (const Cell &cell : cells)
        for (int c = 0; c < 8; ++c)
            divider.keys.push_back(corner_key(corner(cell.at, lattice.cells(cell.level), c)));
    std::ranges::sort(divider.keys);
    divider.keys.erase(std::unique(divider.keys.begin(), divider.keys.end()), divider.keys.end());
    divider.points.clear();
    for (const std::uint64_t key : divider.keys)
        divider.points.add(point_of(lattice, corner_of_key(key)));
    values_at(divider.evaluator, tape, divider.points, divider.values);
    for (const Cell &cell : cells) {
        std::uint8_t &signs = nodes[static_cast<std::size_t>(cell.node)].signs;
        signs = 0;
        nodes[static_cast<std::size_t>(cell.node)].faces = 0;
        for (int c = 0; c < 8; ++c) {
            const auto at = std::ranges::lower_bound(
                divider.keys, corner_key(corner(cell.at, lattice.cells(cell.level), c)));
            if (divider.values[static_cast<std::size_t>(at - divider.keys.begin())] <= 0)
                signs |= static_cast<std::uint8_t>(1 << c);
        }
    }
    join_corners(divider.evaluator, tape, lattice, cells, nodes);
}

// Divides cells of one level, all with one tape; gives the open parts. A cell whose parts are all
// left out, on one side, is left out itself.
std::vector<Cell> parts_of(Divider &divider, const Lattice &lattice, const cpu::ShortTape &tape,
                           const std::vector<Cell> &cells, int level, bool trusts_bounds,
                           std::vector<Node> &nodes) {
    constexpr std::size_t at_once = cpu::max_boxes / 16;
    const double half_way = half_diagonal(lattice, level + 1);
    std::vector<Cell> open;
    for (std::size_t begin = 0; begin < cells.size(); begin += at_once) {
        const std::size_t count = std::min(at_once, cells.size() - begin);
        divider.boxes.count = 16 * count;
        for (std::size_t j = 0; j < count; ++j)
            put_parts(lattice, cells[begin + j].at, level, 16 * j, divider.boxes);
        ranges_over(divider.evaluator, tape, divider.boxes);
        for (std::size_t j = 0; j < count; ++j) {
            const Cell &cell = cells[begin + j];
            std::array<Space, 8> space;
            for (std::size_t k = 0; k < 8; ++k)
                space[k] = space_of(divider.evaluator, 16 * j + k, half_way, lattice.ulp,
                                    trusts_bounds, true);
            const bool same = std::ranges::all_of(
                space, [&](Space s) { return s == space[0] && s != Space::Open; });
            if (same) {
                nodes[static_cast<std::size_t>(cell.node)].space = space[0];
                continue;
            }
            const auto first = static_cast<std::int32_t>(nodes.size());
            nodes[static_cast<std::size_t>(cell.node)].children = first;
            for (int k = 0; k < 8; ++k) {
                const Space s = space[static_cast<std::size_t>(k)];
                nodes.push_back({none, none, s, 0, 0});
                if (s == Space::Open)
                    open.push_back(
                        {first + k, level + 1, corner(cell.at, lattice.cells(level + 1), k)});
            }
        }
    }
    return open;
}

// A tree of its own below one cell: its nodes, the first that of the cell. Down to `until`, or where
// `hidden` until cells are crossed.
std::vector<Node> subtree(Divider &divider, const Lattice &lattice, const cpu::ShortTape &tape,
                          const Cell &top, int until, bool hidden, bool trusts_bounds) {
    std::vector<Node> nodes(1);
    std::vector<Cell> cells{{0, top.level, top.at}};
    for (int level = top.level; level < until && !cells.empty(); ++level) {
        cells = parts_of(divider, lattice, tape, cells, level, trusts_bounds, nodes);
        if (!hidden) continue;
        sign(divider, lattice, tape, cells, nodes);
        std::erase_if(cells, [&](const Cell &cell) {
            return nodes[static_cast<std::size_t>(cell.node)].crossed();
        });
    }
    if (!hidden) sign(divider, lattice, tape, cells, nodes);
    return nodes;
}

// Puts a subtree in the place of a leaf.
void graft(Octree &octree, std::int32_t leaf, std::int32_t task, const std::vector<Node> &tree) {
    const auto offset = static_cast<std::int32_t>(octree.nodes.size()) - 1;
    const auto placed = [&](Node node) {
        node.task = task;
        if (node.children != none) node.children += offset;
        return node;
    };
    octree.nodes[static_cast<std::size_t>(leaf)] = placed(tree[0]);
    for (std::size_t k = 1; k < tree.size(); ++k) octree.nodes.push_back(placed(tree[k]));
}

// Whether a crossed leaf touches an open one.
bool beside_crossed(const Octree &octree, const Cell &cell) {
    const std::int32_t side = octree.lattice.cells(cell.level);
    for (int k = 0; k < 27; ++k) {
        const Index at{cell.at[0] + (k % 3 - 1) * side, cell.at[1] + (k / 3 % 3 - 1) * side,
                       cell.at[2] + (k / 9 - 1) * side};
        const Cell near = leaf_at(octree, at);
        if (near.node != none && octree.nodes[static_cast<std::size_t>(near.node)].crossed())
            return true;
    }
    return false;
}

// `levels`: so many below each cell.
void graft_all(Octree &octree, const Field &field, const std::vector<Cell> &cells, int levels,
               bool hidden, const OctreeSettings &settings, Progress &progress) {
    std::vector<std::vector<Node>> trees(cells.size());
    std::atomic<std::size_t> nodes{octree.nodes.size()};
    in_parallel(
        cells.size(), settings.threads, progress, [&] { return Divider(field); },
        [&](Divider &divider, std::size_t k) {
            if (nodes > most_nodes) return;
            const Node &node = octree.nodes[static_cast<std::size_t>(cells[k].node)];
            trees[k] =
                subtree(divider, octree.lattice, *octree.tapes[static_cast<std::size_t>(node.task)],
                        cells[k], cells[k].level + levels, hidden, settings.trusts_bounds);
            nodes += trees[k].size();
        });
    octree.full = octree.full || nodes > most_nodes;
    if (progress.cancelled || octree.full) return;
    for (std::size_t k = 0; k < cells.size(); ++k)
        graft(octree, cells[k].node, octree.nodes[static_cast<std::size_t>(cells[k].node)].task,
              trees[k]);
}

// How wide the seams in some cells are, that have one tape; what is none is left as it is.
void measure_seams(const Octree &octree, Divider &divider, std::span<const Cell> cells,
                   bool closely, std::span<double> widths) {
    const double thin = seam_thickness(octree.lattice);
    const Node &first = octree.nodes[static_cast<std::size_t>(cells[0].node)];
    std::vector<Extent> extents;
    std::vector<std::size_t> asked;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const Cell &cell = cells[k];
        if (octree.nodes[static_cast<std::size_t>(cell.node)].crossed()) continue;
        const std::int32_t side = octree.lattice.cells(cell.level);
        extents.push_back({point_of(octree.lattice, cell.at),
                           point_of(octree.lattice, corner(cell.at, side, 7))});
        asked.push_back(k);
    }
    if (extents.empty()) return;
    Extent all = extents[0];
    for (const Extent &one : extents)
        for (std::size_t i = 0; i < 3; ++i)
            all.lo[i] = std::min(all.lo[i], one.lo[i]), all.hi[i] = std::max(all.hi[i], one.hi[i]);
    const TapePtr shorter =
        tape_in(divider.evaluator, divider.boxes,
                octree.tapes[static_cast<std::size_t>(first.task)], all.lo, all.hi);
    const cpu::ShortTape &tape = *shorter;
    const std::vector<Sighting> seen = look_for_seams(divider.evaluator, tape, extents, thin);
    for (std::size_t n = 0; n < asked.size(); ++n) {
        const Node &node = octree.nodes[static_cast<std::size_t>(cells[asked[n]].node)];
        const auto seam =
            search_seam(divider.evaluator, tape, divider.boxes, extents[n], seen[n], thin, closely)
                .seam;
        if (seam && seam->solid == (node.signs != 0)) widths[asked[n]] = seam->width;
    }
}

// Takes those cells away in which parts of the solid only touch: they are of one sign, or seams.
void find_seams(Octree &octree, const Field &field, std::vector<Cell> &cells, bool closely,
                const OctreeSettings &settings, Progress &progress) {
    constexpr std::size_t group = 64;
    std::vector<double> widths(cells.size(), -1); // -1: no seam
    const auto task = [&](std::size_t k) {
        return octree.nodes[static_cast<std::size_t>(cells[k].node)].task;
    };
    in_parallel((cells.size() + group - 1) / group, settings.threads, progress,
                [&] { return Divider(field); },
                [&](Divider &divider, std::size_t number) {
                    const std::size_t end = std::min(cells.size(), (number + 1) * group);
                    for (std::size_t k = number * group, next; k < end; k = next) {
                        for (next = k + 1; next < end && task(next) == task(k);) ++next;
                        measure_seams(octree, divider, std::span(cells).subspan(k, next - k),
                                      closely, std::span(widths).subspan(k, next - k));
                    }
                });
    if (progress.cancelled) return;
    std::vector<Cell> left;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        if (widths[k] < 0) {
            left.push_back(cells[k]);
        } else if (widths[k] == 0) {
            Node &node = octree.nodes[static_cast<std::size_t>(cells[k].node)];
            node.space = node.signs != 0 ? Space::Inside : Space::Outside;
        } else {
            octree.seams.push_back(cells[k].node);
            octree.seam_width = std::max(octree.seam_width, widths[k]);
        }
    }
    cells = std::move(left);
}

// Divides open cells without a crossed neighbour, level by level, as long as the work allows.
void search_hidden(Octree &octree, const Field &field, const OctreeSettings &settings,
                   Progress &progress) {
    std::size_t crossed = 0;
    std::vector<Cell> cells;
    for (const Cell &cell : open_leaves(octree)) {
        if (octree.nodes[static_cast<std::size_t>(cell.node)].crossed())
            ++crossed;
        else if (!beside_crossed(octree, cell))
            cells.push_back(cell);
    }
    find_seams(octree, field, cells, false, settings, progress);
    // Where planes meet in which parts touch, cells lie in lines; where walls are thin there are many.
    if (cells.size() <= most_close) find_seams(octree, field, cells, true, settings, progress);
    std::size_t boxes = std::max(least_hidden_boxes, hidden_boxes_a_cell * crossed);
    constexpr std::size_t few = 400; // that cost little
    constexpr double shows = 1.25;   // cells: a wall along their planes that is thicker is seen
    if (!settings.searches ||
        thinner_in(field, octree, cells, few, shows, settings.threads, progress))
        boxes = 0;
    for (int level = octree.lattice.level; level < octree.settled && !cells.empty(); ++level) {
        if (16 * cells.size() > boxes) break;
        boxes -= 16 * cells.size();
        graft_all(octree, field, cells, 1, true, settings, progress);
        if (progress.cancelled || octree.full) return;
        std::vector<Cell> parts;
        for (const Cell &cell : cells) {
            const std::int32_t first = octree.nodes[static_cast<std::size_t>(cell.node)].children;
            for (int k = 0; first != none && k < 8; ++k) {
                const Cell part{first + k, level + 1,
                                corner(cell.at, octree.lattice.cells(level + 1), k)};
                const Node &node = octree.nodes[static_cast<std::size_t>(part.node)];
                if (node.space == Space::Open && !node.crossed() && !beside_crossed(octree, part))
                    parts.push_back(part);
            }
        }
        cells = std::move(parts);
    }
    octree.undecided = std::move(cells);
}

} // namespace

namespace {

// How many nodes there would be so many levels below some cells, by 64 of these.
double nodes_below(const Octree &octree, const Field &field, const std::vector<Cell> &cells,
                   int levels, const OctreeSettings &settings, Progress &progress) {
    constexpr std::size_t most = 64;
    const std::size_t count = std::min(cells.size(), most);
    std::vector<std::size_t> sizes(count);
    in_parallel(
        count, settings.threads, progress, [&] { return Divider(field); },
        [&](Divider &divider, std::size_t k) {
            const std::size_t number = k * cells.size() / count;
            sizes[k] = subtree(divider, octree.lattice, *octree.tapes[number], cells[number],
                               cells[number].level + levels, false, settings.trusts_bounds)
                           .size();
        });
    double sum = 0;
    for (const std::size_t size : sizes) sum += static_cast<double>(size);
    return sum * static_cast<double>(cells.size()) /
           static_cast<double>(std::max<std::size_t>(count, 1));
}

} // namespace

Octree make_octree(const Field &field, const Lattice &lattice, const OctreeSettings &settings,
                   Progress &progress) {
    Octree octree;
    octree.lattice = lattice;
    octree.settled = std::min(lattice.depth, lattice.level + settings.extra);
    const double from = progress.from, to = progress.to;
    const auto share = [&](double s) { return from + s * (to - from); };
    progress.to = share(0.05);
    const int top = std::max(0, lattice.level - task_levels);
    const std::vector<Branch> branches = divide_top(octree, field, settings, progress, top);
    std::vector<Cell> cells;
    for (const Branch &branch : branches) {
        octree.nodes[static_cast<std::size_t>(branch.cell.node)].task =
            static_cast<std::int32_t>(cells.size());
        cells.push_back(branch.cell);
        octree.tapes.push_back(branch.tape);
    }
    // Far too many are refused before they are made.
    constexpr double usual = 2, certain = 2; // nodes a cell and a fourfold; of what was estimated
    const int levels = lattice.level - top;
    const auto most = static_cast<double>(most_nodes);
    if (usual * std::ldexp(static_cast<double>(cells.size()), 2 * levels) > most) {
        octree.wanted = nodes_below(octree, field, cells, levels, settings, progress);
        octree.full = octree.wanted > certain * most;
        if (octree.full) return octree;
    }
    progress.phase(share(0.8));
    graft_all(octree, field, cells, levels, false, settings, progress);
    progress.phase(to);
    if (!progress.cancelled && !octree.full) search_hidden(octree, field, settings, progress);
    return octree;
}

void divide(Octree &octree, const Field &field, const std::vector<Cell> &leaves,
            const OctreeSettings &settings, Progress &progress) {
    struct Parts {
        std::vector<Node> nodes;
    };
    std::vector<Parts> made(leaves.size());
    in_parallel(
        leaves.size(), settings.threads, progress, [&] { return Divider(field); },
        [&](Divider &divider, std::size_t k) {
            const Cell &leaf = leaves[k];
            std::vector<Cell> parts;
            for (int c = 0; c < 8; ++c)
                parts.push_back({c + 1, leaf.level + 1,
                                 corner(leaf.at, octree.lattice.cells(leaf.level + 1), c)});
            made[k].nodes.resize(9);
            made[k].nodes[0].children = 1;
            const Node &node = octree.nodes[static_cast<std::size_t>(leaf.node)];
            sign(divider, octree.lattice, *octree.tapes[static_cast<std::size_t>(node.task)], parts,
                 made[k].nodes);
        });
    if (progress.cancelled) return;
    for (std::size_t k = 0; k < leaves.size(); ++k)
        graft(octree, leaves[k].node, octree.nodes[static_cast<std::size_t>(leaves[k].node)].task,
              made[k].nodes);
}

void refine(Octree &octree, const Field &field, const std::vector<Cell> &leaves,
            const OctreeSettings &settings, Progress &progress) {
    graft_all(octree, field, leaves, 1, true, settings, progress);
}

Space space_of(const Evaluator &evaluator, std::size_t k, double half, double ulp,
               bool trusts_bounds, bool closed) {
    const cpu::Shortener &ranges = evaluator.ranges;
    const double lo = ranges.result_lo[k], hi = ranges.result_hi[k];
    const bool trusts = trusts_bounds && evaluator.field.proved;
    const double reach = half * (1 + 1e-6) + 8 * ulp; // the middle and the value are rounded
    if (lo > 0 || (trusts && ranges.result_lo[k + 8] > reach)) return Space::Outside;
    if (hi < 0 || (closed && hi == 0) || (trusts && ranges.result_hi[k + 8] < -reach))
        return Space::Inside;
    return Space::Open;
}

std::vector<Cell> open_leaves(const Octree &octree) {
    std::vector<Cell> leaves, stack{{0, 0, {}}};
    while (!stack.empty()) {
        const Cell cell = stack.back();
        stack.pop_back();
        const Node &node = octree.nodes[static_cast<std::size_t>(cell.node)];
        if (node.children == none) {
            if (node.space == Space::Open) leaves.push_back(cell);
            continue;
        }
        for (int k = 7; k >= 0; --k)
            stack.push_back({node.children + k, cell.level + 1,
                             corner(cell.at, octree.lattice.cells(cell.level + 1), k)});
    }
    return leaves;
}

Cell leaf_at(const Octree &octree, const Index &finest) {
    const std::int32_t side = octree.lattice.cells(0);
    for (std::size_t i = 0; i < 3; ++i)
        if (finest[i] < 0 || finest[i] >= side) return {};
    Cell cell{0, 0, {}};
    while (octree.nodes[static_cast<std::size_t>(cell.node)].children != none) {
        const std::int32_t half = octree.lattice.cells(cell.level + 1);
        int part = 0;
        for (std::size_t i = 0; i < 3; ++i)
            if (finest[i] >= cell.at[i] + half) part |= 1 << i;
        cell = {octree.nodes[static_cast<std::size_t>(cell.node)].children + part, cell.level + 1,
                corner(cell.at, half, part)};
    }
    return cell;
}

} // namespace fathom::mesh
