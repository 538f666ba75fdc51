#include "mesh/simplify.h"

#include "mesh/certify.h"
#include "mesh/collapse.h"
#include "mesh/exact.h"
#include "mesh/nearest.h"
#include "mesh/simplify_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <meshoptimizer.h>
#include <utility>

namespace fathom::mesh {
namespace {

// Shares of the tolerance that are tried for a block, one after the other: what the library holds is a
// mean over planes, and how far a place really is, is measured.
constexpr std::array<double, 3> aims{0.6, 0.3, 0.15};
// Blocks of so many drawing cells a side, whose borders stay; then others, shifted by half of that.
constexpr double cells_a_block = 24;
constexpr std::array<double, 2> pass_shares{0.55, 0.35}; // of the tolerance
constexpr double last_share = 0.1;                       // … for what is done over all blocks
constexpr int most_last = 4;                             // so often that is tried
constexpr int most_mendings = 6;       // of blocks that cross each other, in a pass
constexpr float one_paint = 1.0f / 64; // colours that differ by more are two, with a border between
constexpr float same_paint = 1.0f / 64; // in each pass

float difference(const Point &a, const Point &b) {
    float most = 0;
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, std::fabs(a[i] - b[i]));
    return most;
}

// A part of a mesh with vertices of its own.
struct Piece {
    Mesh mesh;
    std::vector<std::uint32_t> from; // by vertex: which one of the whole mesh
    std::vector<Point> colors;       // or none
};

Piece piece_of(const Mesh &mesh, const std::vector<Point> &colors,
               const std::vector<std::uint32_t> &triangles) {
    Piece piece;
    for (const std::uint32_t t : triangles)
        for (const std::uint32_t v : mesh.triangles[t]) piece.from.push_back(v);
    std::ranges::sort(piece.from);
    piece.from.erase(std::unique(piece.from.begin(), piece.from.end()), piece.from.end());
    const auto number = [&](std::uint32_t v) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(piece.from, v) -
                                          piece.from.begin());
    };
    for (const std::uint32_t v : piece.from) {
        piece.mesh.vertices.push_back(mesh.vertices[v]);
        if (!colors.empty()) piece.colors.push_back(colors[v]);
    }
    for (const std::uint32_t t : triangles) {
        const auto &[a, b, c] = mesh.triangles[t];
        piece.mesh.triangles.push_back({number(a), number(b), number(c)});
    }
    return piece;
}

// The library makes triangles without an area, where vertices lie on a line. Each goes away where the
// triangle beyond its longest side is cut in two at the vertex that lies on that.
void cut_flats(Mesh &mesh) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> by_side;
    const auto enter = [&](std::uint32_t t) {
        for (std::size_t k = 0; k < 3; ++k)
            by_side[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
    };
    const auto flat = [&](std::uint32_t t) {
        const auto &[a, b, c] = mesh.triangles[t];
        return is_flat(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    };
    std::vector<std::uint32_t> todo;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        enter(t);
        if (flat(t)) todo.push_back(t);
    }
    for (std::size_t left = 8 * todo.size() + 8; !todo.empty() && left > 0; --left) {
        const std::uint32_t t = todo.back();
        todo.pop_back();
        if (!flat(t)) continue;
        const auto length = [&](std::size_t k) { // of the side opposite of corner k
            return distance(real(mesh.vertices[mesh.triangles[t][(k + 1) % 3]]),
                            real(mesh.vertices[mesh.triangles[t][(k + 2) % 3]]));
        };
        std::size_t k = 0;
        for (std::size_t j = 1; j < 3; ++j)
            if (length(j) > length(k)) k = j;
        const std::uint32_t on = mesh.triangles[t][k], from = mesh.triangles[t][(k + 1) % 3],
                            to = mesh.triangles[t][(k + 2) % 3];
        const auto beyond = by_side.find({to, from});
        if (beyond == by_side.end()) continue; // a border: the piece will be refused
        const std::uint32_t other = beyond->second;
        std::uint32_t far = on;
        for (const std::uint32_t v : mesh.triangles[other])
            if (v != from && v != to) far = v;
        if (far == on || by_side.contains({on, far}) || by_side.contains({far, on})) continue;
        by_side.erase({to, from});
        by_side.erase({from, to});
        mesh.triangles[t] = {to, on, far};
        mesh.triangles[other] = {on, from, far};
        for (const std::uint32_t changed : {t, other}) {
            enter(changed);
            if (flat(changed)) todo.push_back(changed);
        }
    }
}

// The same piece with fewer triangles and the same border, by the library.
Mesh fewer(const Piece &piece, double error) {
    std::vector<unsigned int> indices;
    for (const auto &t : piece.mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    std::vector<Point> places = piece.mesh.vertices; // about their middle, where floats are finer
    const Point middle = places[places.size() / 2];
    for (Point &p : places)
        for (std::size_t i = 0; i < 3; ++i) p[i] -= middle[i];
    const float *data = places.front().data();
    const double scale = meshopt_simplifyScale(data, places.size(), sizeof(Point));
    std::vector<unsigned int> left(indices.size());
    left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), data, places.size(),
                                 sizeof(Point), 0, static_cast<float>(std::min(error / scale, 1.0)),
                                 meshopt_SimplifyLockBorder, nullptr));
    Mesh mesh;
    mesh.vertices = piece.mesh.vertices;
    for (std::size_t k = 0; k + 2 < left.size(); k += 3)
        mesh.triangles.push_back({left[k], left[k + 1], left[k + 2]});
    cut_flats(mesh);
    return mesh;
}

// Whether the place of a mesh next to a point that was left out of it has the point's colour.
// `colors`: by vertex of the mesh.
bool same_color(const TriangleTree &tree, const Mesh &mesh, const std::vector<Point> &colors,
                const Point &at, const Point &color, double tolerance) {
    const auto near = tree.nearest(at, 2 * tolerance);
    if (!near) return false;
    Point there{};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i)
            there[i] +=
                static_cast<float>(near->shares[k]) * colors[mesh.triangles[near->triangle][k]][i];
    return difference(there, color) <= same_paint;
}

bool same_colors(const Piece &piece, const Mesh &mesh, double tolerance) {
    if (piece.colors.empty()) return true;
    const TriangleTree tree(mesh);
    for (std::size_t v = 0; v < piece.colors.size(); ++v)
        if (!same_color(tree, mesh, piece.colors, piece.mesh.vertices[v], piece.colors[v],
                        tolerance))
            return false;
    return true;
}

// A block: what is in it, what became of it, and which aim that was.
struct MeshBlock {
    std::vector<std::uint32_t> triangles; // of the mesh that comes in
    std::vector<std::array<std::uint32_t, 3>> made;
    std::size_t aim = 0; // as many as there are: it stays as it was
};

struct Pass {
    const Mesh &mesh;
    const std::vector<Point> &colors;
    double tolerance; // of this pass
};

// Tries aims, from the block's own on, until all checks hold; gives how many did not.
std::size_t simplify_block(const Pass &pass, MeshBlock &block) {
    std::size_t refused = 0;
    const Piece piece = piece_of(pass.mesh, pass.colors, block.triangles);
    for (; block.aim < aims.size(); ++block.aim) {
        const Mesh mesh = fewer(piece, aims[block.aim] * pass.tolerance);
        if (is_like(piece.mesh, mesh) && same_colors(piece, mesh, pass.tolerance) &&
            !crosses_itself(mesh) && !strays(piece.mesh, mesh, pass.tolerance)) {
            block.made.clear();
            for (const auto &[a, b, c] : mesh.triangles)
                block.made.push_back({piece.from[a], piece.from[b], piece.from[c]});
            return refused;
        }
        ++refused;
    }
    block.made.clear();
    for (const std::uint32_t t : block.triangles) block.made.push_back(pass.mesh.triangles[t]);
    return refused;
}

std::vector<MeshBlock> blocks_of(const Mesh &mesh, const std::vector<std::uint8_t> &kept,
                                 double side, double shift) {
    std::map<std::array<std::int64_t, 3>, MeshBlock> blocks;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (kept[t]) continue;
        std::array<std::int64_t, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) {
            double middle = 0;
            for (const std::uint32_t v : mesh.triangles[t]) middle += mesh.vertices[v][i] / 3.0;
            at[i] = static_cast<std::int64_t>(std::floor(middle / side + shift));
        }
        blocks[at].triangles.push_back(t);
    }
    std::vector<MeshBlock> result;
    for (auto &[at, block] : blocks) result.push_back(std::move(block));
    return result;
}

// One pass over all blocks; gives how many refusals there were.
std::size_t run_pass(const Pass &pass, const std::vector<std::uint8_t> &kept, double side,
                     double shift, unsigned threads, Progress &progress, Mesh &result,
                     std::vector<std::uint8_t> &result_kept) {
    std::vector<MeshBlock> blocks = blocks_of(pass.mesh, kept, side, shift);
    std::vector<std::size_t> todo(blocks.size());
    for (std::size_t b = 0; b < todo.size(); ++b) todo[b] = b;
    std::size_t refused = 0;
    for (int mending = 0; !todo.empty(); ++mending) {
        std::vector<std::size_t> refusals(todo.size());
        in_parallel(
            todo.size(), threads, progress, [] { return 0; },
            [&](int, std::size_t k) { refusals[k] = simplify_block(pass, blocks[todo[k]]); });
        if (progress.cancelled) return refused;
        for (const std::size_t count : refusals) refused += count;
        result.triangles.clear();
        result_kept.clear();
        std::vector<std::uint32_t> owner; // block, or one for all that is kept
        const auto whole = static_cast<std::uint32_t>(blocks.size());
        for (std::size_t t = 0; t < pass.mesh.triangles.size(); ++t)
            if (kept[t]) {
                result.triangles.push_back(pass.mesh.triangles[t]);
                owner.push_back(whole);
            }
        result_kept.assign(owner.size(), 1);
        for (std::uint32_t b = 0; b < blocks.size(); ++b)
            for (const auto &t : blocks[b].made) {
                result.triangles.push_back(t);
                owner.push_back(b);
            }
        result_kept.resize(owner.size(), 0);
        // Blocks may cross each other: then both are done less boldly.
        todo.clear();
        for (const auto &[s, t] : crossings_between(result, owner, threads, progress))
            for (const std::uint32_t b : {owner[s], owner[t]})
                if (b != whole && blocks[b].aim < aims.size()) todo.push_back(b);
        std::ranges::sort(todo);
        todo.erase(std::unique(todo.begin(), todo.end()), todo.end());
        refused += todo.size();
        for (const std::size_t b : todo)
            blocks[b].aim = mending < most_mendings ? blocks[b].aim + 1 : aims.size();
    }
    return refused;
}

// The vertices of the mesh that have to stay, since without them it is another: it crosses itself, is
// too far, or has another colour. True where there are none.
bool lock_more(const Mesh &fine, const Mesh &mesh, const Pass &pass, unsigned threads,
               Progress &progress, std::vector<std::uint8_t> &locked) {
    bool good = true;
    std::vector<std::uint32_t> owner(mesh.triangles.size());
    for (std::uint32_t t = 0; t < owner.size(); ++t) owner[t] = t;
    for (const auto &[s, t] : crossings_between(mesh, owner, threads, progress)) {
        good = false;
        for (const std::uint32_t crossing : {s, t}) {
            Point lo = mesh.vertices[mesh.triangles[crossing][0]], hi = lo;
            for (const std::uint32_t v : mesh.triangles[crossing])
                for (std::size_t i = 0; i < 3; ++i) {
                    lo[i] = std::min(lo[i], mesh.vertices[v][i]);
                    hi[i] = std::max(hi[i], mesh.vertices[v][i]);
                }
            for (std::size_t v = 0; v < locked.size(); ++v) {
                bool within = true;
                for (std::size_t i = 0; i < 3; ++i)
                    within = within && fine.vertices[v][i] >= lo[i] && fine.vertices[v][i] <= hi[i];
                if (within) locked[v] = 1;
            }
        }
    }
    for (const std::uint32_t t : strays_of(fine, mesh, pass.tolerance, threads, progress)) {
        good = false;
        for (const std::uint32_t v : fine.triangles[t]) locked[v] = 1;
    }
    if (pass.colors.empty()) return good;
    const TriangleTree tree(mesh);
    for (const auto &t : fine.triangles)
        for (const std::uint32_t v : t)
            if (!locked[v] && !same_color(tree, mesh, pass.colors, fine.vertices[v], pass.colors[v],
                                          pass.tolerance))
                good = false, locked[v] = 1;
    return good;
}

// What blocks leave along their borders, and wherever faces are flat.
void finish(const Pass &pass, const std::vector<std::uint8_t> &kept, unsigned threads,
            Progress &progress, Mesh &result, std::size_t &refused) {
    std::vector<std::uint8_t> locked(pass.mesh.vertices.size(), 0);
    for (std::size_t t = 0; t < kept.size(); ++t)
        for (const std::uint32_t v : pass.mesh.triangles[t])
            if (kept[t]) locked[v] = 1;
    for (int time = 0; time < most_last && !progress.cancelled; ++time) {
        Mesh next;
        next.vertices = pass.mesh.vertices, next.normals = pass.mesh.normals;
        next.triangles =
            collapsed(pass.mesh, locked, pass.colors, same_paint, aims[1] * pass.tolerance);
        if (lock_more(pass.mesh, next, pass, threads, progress, locked)) {
            result = std::move(next);
            return;
        }
        ++refused;
    }
    result = pass.mesh;
}

// Vertices that no triangle has go away.
void compact(Mesh &mesh) {
    std::vector<std::uint32_t> number(mesh.vertices.size(), ~0u);
    Mesh packed;
    for (auto &t : mesh.triangles)
        for (std::uint32_t &v : t) {
            if (number[v] == ~0u) {
                number[v] = static_cast<std::uint32_t>(packed.vertices.size());
                packed.vertices.push_back(mesh.vertices[v]);
                packed.normals.push_back(mesh.normals[v]);
            }
            v = number[v];
        }
    packed.triangles = std::move(mesh.triangles);
    mesh = std::move(packed);
}

// By triangle: whether it stays since paints meet in it or at one of its corners.
std::vector<std::uint8_t> meetings_of(const Mesh &mesh, const Paints &paints) {
    std::vector<std::uint8_t> kept(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < kept.size() && !paints.colors.empty(); ++t) {
        const auto &[a, b, c] = mesh.triangles[t];
        const auto differ = [&](std::uint32_t v, std::uint32_t w) {
            return difference(paints.colors[v], paints.colors[w]) > one_paint;
        };
        kept[t] = differ(a, b) || differ(b, c) || differ(c, a);
    }
    if (paints.material_of.empty()) return kept;
    constexpr std::uint32_t several = ~0u, unseen = ~0u - 1;
    std::vector<std::uint32_t> at(mesh.vertices.size(), unseen);
    for (std::size_t t = 0; t < kept.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
            at[v] =
                at[v] == unseen || at[v] == paints.material_of[t] ? paints.material_of[t] : several;
    for (std::size_t t = 0; t < kept.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) kept[t] |= at[v] == several;
    return kept;
}

} // namespace

Simplified simplify(const Mesh &fine, const Paints &paints, const SimplifySettings &settings,
                    Progress &progress) {
    Simplified result;
    result.before = fine.triangles.size();
    result.mesh = fine;
    std::vector<std::uint8_t> kept = meetings_of(fine, paints);
    result.colored = static_cast<std::size_t>(std::ranges::count(kept, std::uint8_t{1}));
    const double from = progress.from, to = progress.to;
    progress.to = from + 0.6 * (to - from);
    for (std::size_t pass = 0; pass < pass_shares.size(); ++pass) {
        Mesh next;
        next.vertices = fine.vertices, next.normals = fine.normals;
        std::vector<std::uint8_t> next_kept;
        result.refused +=
            run_pass({result.mesh, paints.colors, pass_shares[pass] * settings.tolerance}, kept,
                     cells_a_block * settings.side, pass == 0 ? 0 : 0.5, settings.threads, progress,
                     next, next_kept);
        progress.phase(to);
        if (progress.cancelled) break;
        result.mesh = std::move(next);
        kept = std::move(next_kept);
    }
    if (!progress.cancelled) {
        const Mesh blocks = std::move(result.mesh);
        finish({blocks, paints.colors, last_share * settings.tolerance}, kept, settings.threads,
               progress, result.mesh, result.refused);
    }
    compact(result.mesh);
    const Form before = form_of(fine), after = form_of(result.mesh);
    if (progress.cancelled || !flaws_of(result.mesh).empty() ||
        before.components != after.components || before.genus != after.genus) {
        result.mesh = fine;
        result.undone = !progress.cancelled;
    }
    return result;
}

} // namespace fathom::mesh
