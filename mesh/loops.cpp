#include "mesh/loops.h"

#include "mesh/ambiguous.h"

#include <algorithm>
#include <unordered_map>

namespace fathom::mesh {
namespace {

struct Axes { // an axis and those after it
    std::size_t a, b, c;
    explicit Axes(std::size_t axis) : a(axis), b((axis + 1) % 3), c((axis + 2) % 3) {}
};

// Whether quarter k lies at the upper side of the edge along b and along c.
bool upper_b(int quarter) { return quarter == 1 || quarter == 2; }
bool upper_c(int quarter) { return quarter >= 2; }

// The crossing of a leaf's edge, where that is the leaf to name it: no leaf about it is smaller, and
// of those as large none comes before.
bool named_by(const Octree &octree, const Cell &leaf, std::size_t axis, int at, Crossing &made) {
    const Axes axes(axis);
    const std::int32_t side = octree.lattice.cells(leaf.level);
    const std::uint8_t signs = octree.nodes[static_cast<std::size_t>(leaf.node)].signs;
    const bool high_b = at & 1, high_c = at & 2;
    const int low = (high_b ? 1 << axes.b : 0) | (high_c ? 1 << axes.c : 0);
    const bool low_inside = signs >> low & 1, high_inside = signs >> (low | 1 << axes.a) & 1;
    if (low_inside == high_inside) return false;
    made = {};
    made.low = corner(leaf.at, side, low);
    made.length = side;
    made.axis = static_cast<std::uint8_t>(axis);
    made.low_inside = low_inside;
    Index inside = made.low; // a finest cell of the quarter, halfway along
    inside[axes.a] += side / 2;
    for (int quarter = 0; quarter < 4; ++quarter) {
        Cell &cell = made.cells[static_cast<std::size_t>(quarter)];
        if (upper_b(quarter) != high_b && upper_c(quarter) != high_c) {
            cell = leaf;
            continue;
        }
        Index finest = inside;
        finest[axes.b] -= upper_b(quarter) ? 0 : 1;
        finest[axes.c] -= upper_c(quarter) ? 0 : 1;
        cell = leaf_at(octree, finest);
        if (cell.node == none) continue;
        if (cell.level > leaf.level) return false;
        const bool open = octree.nodes[static_cast<std::size_t>(cell.node)].space == Space::Open;
        if (cell.level == leaf.level && open && cell.node < leaf.node) return false;
    }
    return true;
}

// One crossing's pass through a face.
struct Pass {
    std::uint64_t key = 0;                   // the face's: its owner, axis and end
    std::int32_t crossing = none, round = 0; // how far round the face it lies
    std::uint8_t face = 0;
    bool entering = false; // the solid, on the way round
    friend bool operator<(const Pass &x, const Pass &y) {
        return x.key != y.key ? x.key < y.key : x.round < y.round;
    }
};

struct Face {
    Cell owner;
    std::size_t axis = 0;
    bool high = false;
};

// The face k of a crossing: between quarters k and k + 1.
Face face_of(const Crossing &crossing, int k) {
    const Axes axes(crossing.axis);
    const Cell &x = crossing.cells[static_cast<std::size_t>(k)],
               &y = crossing.cells[static_cast<std::size_t>((k + 1) % 4)];
    const bool x_below = k == 0 || k == 1;
    const Cell &below = x_below ? x : y, &above = x_below ? y : x;
    Face face;
    face.axis = k % 2 == 0 ? axes.b : axes.c;
    face.high = below.level >= above.level;
    face.owner = face.high ? below : above;
    return face;
}

Pass pass_of(const Octree &octree, const Crossing &crossing, std::int32_t number, int k) {
    const Face face = face_of(crossing, k);
    const Axes axes(face.axis); // round the face: along b, then along c
    const std::int32_t side = octree.lattice.cells(face.owner.level);
    const bool along_b = crossing.axis == axes.b;
    const std::size_t along = crossing.axis, across = along_b ? axes.c : axes.b;
    const std::int32_t far = crossing.low[across] == face.owner.at[across] ? 0 : 1;
    // Twice, so that the middle of an edge is whole.
    const std::int32_t middle = 2 * (crossing.low[along] - face.owner.at[along]) + crossing.length;
    // b at c-, c at b+, b back at c+, c back at b-.
    const int leg = along_b ? (far ? 2 : 0) : (far ? 1 : 3);
    const bool forward = leg < 2;
    Pass pass;
    pass.key = static_cast<std::uint64_t>(face.owner.node) * 6 + face.axis * 2 + face.high;
    pass.crossing = number;
    pass.face = static_cast<std::uint8_t>(k);
    pass.round = leg * 2 * side + (forward ? middle : 2 * side - middle);
    pass.entering = forward != crossing.low_inside;
    return pass;
}

// Whether the passes of a face, more than one segment's, are through whole edges of its owner: so two
// signs are at its corners by turns, and nothing smaller is about it.
bool by_turns(const Octree &octree, const Loops &loops, std::span<const Pass> passes,
              const Cell &owner) {
    return passes.size() == 4 && std::ranges::all_of(passes, [&](const Pass &pass) {
               return loops.crossings[static_cast<std::size_t>(pass.crossing)].length ==
                      octree.lattice.cells(owner.level);
           });
}

// The segments of one face: inside, between two crossings, the solid is on one side of each; or, where
// the solid is joined over the face, what is empty.
bool join(const Octree &octree, std::span<const Pass> passes, Loops &loops) {
    const std::size_t n = passes.size();
    if (n % 2 != 0) return false;
    for (std::size_t k = 0; k < n; ++k)
        if (passes[k].entering == passes[(k + 1) % n].entering) return false;
    const Face of =
        face_of(loops.crossings[static_cast<std::size_t>(passes[0].crossing)], passes[0].face);
    const bool joined =
        of.owner.level < octree.settled && by_turns(octree, loops, passes, of.owner) &&
        octree.nodes[static_cast<std::size_t>(of.owner.node)].joins(of.axis, of.high);
    const std::size_t first = passes[0].entering != joined ? 0 : 1;
    for (std::size_t k = first; k < n + first; k += 2) {
        const Pass &from = passes[k % n], &to = passes[(k + 1) % n];
        const Face face =
            face_of(loops.crossings[static_cast<std::size_t>(from.crossing)], from.face);
        Segment segment;
        segment.crossings = {from.crossing, to.crossing};
        segment.faces = {from.face, to.face};
        segment.owner = face.owner;
        segment.axis = static_cast<std::uint8_t>(face.axis);
        segment.high = face.high;
        segment.alone = n == 2;
        const auto number = static_cast<std::int32_t>(loops.segments.size());
        loops.segments.push_back(segment);
        for (const Pass *pass : {&from, &to})
            loops.crossings[static_cast<std::size_t>(pass->crossing)].segments[pass->face] = number;
    }
    return true;
}

// What loops are looked for: all, or those about cells that were divided.
struct Scope {
    const Lattice &lattice;
    const Region *changed = nullptr;
    bool all() const { return !changed; }
    bool has(const Cell &cell) const {
        return all() || changed->beside(real(point_of(lattice, cell.at)));
    }
    bool reads(const Cell &cell) const { // its edges too
        return all() || changed->around(real(point_of(lattice, cell.at)));
    }
};

// Whether a face is one of a cell that is looked at.
bool has_any(const Scope &scope, const Loops &loops, std::span<const Pass> passes) {
    return std::ranges::any_of(passes, [&](const Pass &pass) {
        const Crossing &crossing = loops.crossings[static_cast<std::size_t>(pass.crossing)];
        return scope.has(crossing.cells[pass.face]) ||
               scope.has(crossing.cells[(std::size_t{pass.face} + 1) % 4]);
    });
}

void join_faces(const Octree &octree, const Scope &scope, Loops &loops,
                std::vector<Cell> &tangled) {
    std::vector<Pass> passes;
    passes.reserve(4 * loops.crossings.size());
    for (std::size_t c = 0; c < loops.crossings.size(); ++c) {
        const Crossing &crossing = loops.crossings[c];
        bool whole = true;
        for (const Cell &cell : crossing.cells) whole = whole && cell.node != none;
        if (!whole) { // at the border of the cube
            ++loops.torn;
            loops.torn_at = crossing.low;
            continue;
        }
        for (int k = 0; k < 4; ++k)
            if (crossing.cells[static_cast<std::size_t>(k)].node !=
                crossing.cells[static_cast<std::size_t>((k + 1) % 4)].node)
                passes.push_back(pass_of(octree, crossing, static_cast<std::int32_t>(c), k));
    }
    std::ranges::sort(passes, std::less<>());
    loops.segments.reserve(passes.size() / 2);
    for (std::size_t first = 0, last; first < passes.size(); first = last) {
        for (last = first; last < passes.size() && passes[last].key == passes[first].key;) ++last;
        const Crossing &crossing =
            loops.crossings[static_cast<std::size_t>(passes[first].crossing)];
        const Face face = face_of(crossing, passes[first].face);
        const Cell &owner = face.owner;
        const std::span<const Pass> here = std::span(passes).subspan(first, last - first);
        // Where only some are looked for the faces at the end of these lack passes.
        if (!join(octree, here, loops) && has_any(scope, loops, here)) {
            ++loops.torn;
            loops.torn_at = crossing.low;
        }
        if (here.size() > 2 && owner.level < octree.settled && scope.has(owner) &&
            (!by_turns(octree, loops, here, owner) ||
             octree.nodes[static_cast<std::size_t>(owner.node)].unclear(face.axis, face.high)))
            tangled.push_back(owner);
    }
}

// Follows one loop, from a crossing's quarter round the cell that holds it.
void follow(Loops &loops, std::int32_t crossing, int quarter) {
    const auto number = static_cast<std::int32_t>(loops.patches.size());
    Patch patch;
    patch.cell = loops.crossings[static_cast<std::size_t>(crossing)]
                     .cells[static_cast<std::size_t>(quarter)];
    patch.first = static_cast<std::uint32_t>(loops.members.size());
    while (true) {
        Crossing &at = loops.crossings[static_cast<std::size_t>(crossing)];
        // The quarters of the cell lie together; leave by the face behind the last of them.
        const auto cell_of = [&](int q) { return at.cells[static_cast<std::size_t>(q & 3)].node; };
        int last = quarter;
        while (cell_of(last + 1) == patch.cell.node) ++last;
        int first = quarter;
        while (cell_of(first - 1) == patch.cell.node) --first;
        if (at.patches[static_cast<std::size_t>(quarter)] != none) break;
        for (int q = first; q <= last; ++q) at.patches[static_cast<std::size_t>(q & 3)] = number;
        loops.members.push_back(crossing);
        ++patch.count;
        // Inside at the low end: out by the face before, in by the face behind; else the reverse. So
        // all loops have the solid on one hand.
        const int leave = (at.low_inside ? last : first - 1) & 3;
        const Segment &segment =
            loops.segments[static_cast<std::size_t>(at.segments[static_cast<std::size_t>(leave)])];
        const std::size_t other = segment.crossings[0] == crossing && segment.faces[0] == leave;
        crossing = segment.crossings[other];
        const int face = segment.faces[other];
        const Crossing &next = loops.crossings[static_cast<std::size_t>(crossing)];
        quarter = next.cells[static_cast<std::size_t>(face)].node == patch.cell.node
                      ? face
                      : (face + 1) & 3;
    }
    loops.patches.push_back(patch);
}

// Whether a patch crosses edges of its cell alone: none of a smaller one beside it.
bool whole_edges(const Octree &octree, const Loops &loops, const Patch &patch) {
    for (std::uint32_t k = patch.first; k < patch.first + patch.count; ++k)
        if (loops.crossings[static_cast<std::size_t>(loops.members[k])].length !=
            octree.lattice.cells(patch.cell.level))
            return false;
    return true;
}

// Whether several patches of one cell can be drawn apart. Above the settled level only those that a
// face tells apart may be: what else there is is looked for in parts.
bool apart(const Octree &octree, const Loops &loops, std::span<const Patch *const> patches) {
    const auto whole = [&](const Patch *patch) { return whole_edges(octree, loops, *patch); };
    if (!std::ranges::all_of(patches, whole)) return false;
    const Cell &cell = patches[0]->cell;
    if (cell.level >= octree.settled) return true;
    // The margins of vertices have to be more than what rounds them.
    constexpr double least = 4096;
    if (octree.lattice.side(cell.level) < least * octree.lattice.ulp) return false;
    for (std::size_t k = 0; k < patches.size(); ++k)
        for (std::size_t n = 0; n < k; ++n)
            if (!share_face(loops, *patches[k], *patches[n]) ||
                !plane_between(octree.lattice, loops, *patches[k], *patches[n]))
                return false;
    return true;
}

void find_patches(const Octree &octree, const Scope &scope, Loops &loops,
                  std::vector<Cell> &tangled) {
    for (std::size_t c = 0; c < loops.crossings.size(); ++c)
        for (int quarter = 0; quarter < 4; ++quarter)
            if (const auto q = static_cast<std::size_t>(quarter);
                loops.crossings[c].patches[q] == none && scope.has(loops.crossings[c].cells[q]))
                follow(loops, static_cast<std::int32_t>(c), quarter);
    std::vector<std::int32_t> only(octree.nodes.size(), none); // by node: its first patch
    auto &several = loops.several;
    for (std::size_t p = 0; p < loops.patches.size(); ++p) {
        Patch &patch = loops.patches[p];
        std::int32_t &first = only[static_cast<std::size_t>(patch.cell.node)];
        if (first == none) {
            first = static_cast<std::int32_t>(p);
            continue;
        }
        Patch &other = loops.patches[static_cast<std::size_t>(first)];
        if (other.alone) several.push_back({patch.cell.node, static_cast<std::size_t>(first)});
        patch.alone = other.alone = false;
        several.push_back({patch.cell.node, p});
    }
    std::ranges::sort(several);
    for (std::size_t from = 0, to; from < several.size(); from = to) {
        for (to = from; to < several.size() && several[to].first == several[from].first;) ++to;
        std::vector<const Patch *> patches;
        for (std::size_t k = from; k < to; ++k)
            patches.push_back(&loops.patches[several[k].second]);
        if (!apart(octree, loops, patches)) tangled.push_back(patches[0]->cell);
    }
}

Loops loops_in(const Octree &octree, const Scope &scope, unsigned threads, Progress &progress) {
    Loops loops;
    std::vector<Cell> leaves = open_leaves(octree);
    std::erase_if(leaves, [&](const Cell &leaf) { return !scope.reads(leaf); });
    constexpr std::size_t piece = 4096;
    std::vector<std::vector<Crossing>> found((leaves.size() + piece - 1) / piece);
    in_parallel(
        found.size(), threads, progress, [] { return 0; },
        [&](int, std::size_t number) {
            Crossing made;
            const std::size_t end = std::min(leaves.size(), (number + 1) * piece);
            for (std::size_t k = number * piece; k < end; ++k) {
                if (!octree.nodes[static_cast<std::size_t>(leaves[k].node)].crossed()) continue;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    for (int at = 0; at < 4; ++at)
                        if (named_by(octree, leaves[k], axis, at, made))
                            found[number].push_back(made);
            }
        });
    if (progress.cancelled) return loops;
    for (std::vector<Crossing> &some : found) {
        loops.crossings.insert(loops.crossings.end(), some.begin(), some.end());
        some = {};
    }
    join_faces(octree, scope, loops, loops.tangled);
    if (loops.torn > 0) return loops;
    find_patches(octree, scope, loops, loops.tangled);
    const auto before = [](const Cell &x, const Cell &y) { return x.node < y.node; };
    std::ranges::sort(loops.tangled, before);
    const auto same = [](const Cell &x, const Cell &y) { return x.node == y.node; };
    loops.tangled.erase(std::unique(loops.tangled.begin(), loops.tangled.end(), same),
                        loops.tangled.end());
    return loops;
}

} // namespace

Loops find_loops(const Octree &octree, unsigned threads, Progress &progress) {
    return loops_in(octree, {octree.lattice}, threads, progress);
}

Loops find_tangled(const Octree &octree, const Region &changed, unsigned threads,
                   Progress &progress) {
    return loops_in(octree, {octree.lattice, &changed}, threads, progress);
}

} // namespace fathom::mesh
