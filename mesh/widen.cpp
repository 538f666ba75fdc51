#include "mesh/widen.h"

#include "mesh/exact.h"
#include "mesh/mesh.h"
#include "mesh/mover.h"
#include "mesh/qef.h"
#include "mesh/simplify_checks.h"
#include "mesh/thin.h"
#include "mesh/walk.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace fathom::mesh {
namespace {

constexpr double shows_walls = 1.8;   // cells across a wall that is seen whole at any angle
constexpr double kept_off = 1.0 / 64; // of a wall's thickness: where moved vertices end before it
constexpr std::size_t few_cells = 64; // with thin walls: they are mended by themselves,
constexpr std::size_t few_share = 32; // … as where so many times more are crossed
constexpr double most_crossing = 1.0 / 8;   // of triangles: else moved vertices are hardly a mesh
constexpr double most_nodes_of_wider = 8e6; // of an octree of smaller cells, about

// Where the field changes its sign near vertices that were moved, as the roots of a mesh.
void find_roots(const Field &field, float level, float sign, unsigned threads, Made &made,
                Progress &progress) {
    std::vector<Point> &at = made.mesh.vertices;
    std::vector<std::optional<float>> far(at.size());
    by_some(field, at, threads, progress, [&](Mover &mover, Numbers which, std::span<Point> some) {
        std::vector<std::optional<float>> here;
        mover.look_beyond(some, level, sign, here);
        for (std::size_t n = 0; n < which.size(); ++n) far[which[n]] = here[n];
    });
    if (progress.cancelled) return;
    for (std::size_t k = 0; k < at.size(); ++k)
        if (far[k]) {
            made.roots.push_back(at[k]);
            made.root_slack.push_back(*far[k]);
        }
}

// Places at the surface.
std::vector<Point> moved(const Field &field, std::vector<Point> at, float level, float sign,
                         unsigned threads, Progress &progress) {
    by_some(field, at, threads, progress,
            [&](Mover &mover, Numbers, std::span<Point> some) { mover.move(some, level, sign); });
    return at;
}

// Where hollow edges and corners of the surface are, near vertices of patches that hold them: where
// the planes meet that the surface has at the patch's crossings, when these are moved to it. (To
// others vertices come by themselves.)
void find_edges(const Field &field, const Made &drawn, float level, float sign, unsigned threads,
                std::vector<Point> &at, Progress &progress) {
    constexpr double sharp = 0.9; // of two normals: the cosine below which an edge is between them
    std::vector<Point> roots = moved(field, drawn.roots, level, sign, threads, progress);
    if (progress.cancelled) return;
    const auto slope = slopes_at(field, roots, threads, progress);
    const double reach = 0.1 * drawn.octree.lattice.side(drawn.octree.lattice.level);
    std::vector<std::uint32_t> patches;
    std::vector<Point> found;
    std::vector<Plane> planes;
    for (std::uint32_t p = 0; p < drawn.loops.patches.size(); ++p) {
        const Patch &patch = drawn.loops.patches[p];
        planes.clear();
        Real3 lo{unbounded, unbounded, unbounded}, hi{-unbounded, -unbounded, -unbounded};
        bool hollow = false;
        for (std::uint32_t k = patch.first; k < patch.first + patch.count; ++k) {
            const auto c = static_cast<std::size_t>(drawn.loops.members[k]);
            Plane plane{real(roots[c]), {slope[1][c], slope[2][c], slope[3][c]}};
            const double length = std::sqrt(inner(plane.normal, plane.normal));
            if (!(length > 1e-3) || !(std::fabs(slope[0][c]) < 8 * level)) continue;
            for (std::size_t i = 0; i < 3; ++i) {
                plane.normal[i] /= length;
                lo[i] = std::min(lo[i], plane.point[i] - reach);
                hi[i] = std::max(hi[i], plane.point[i] + reach);
            }
            for (const Plane &other : planes)
                hollow =
                    hollow || (inner(other.normal, plane.normal) < sharp &&
                               inner(plane.normal, along(other.point, plane.point, -1)) > reach);
            planes.push_back(plane);
        }
        if (!hollow) continue;
        // Along an edge the vertex stays where it was.
        const Real3 before = real(drawn.mesh.vertices[p]);
        for (Plane &plane : planes)
            plane.point =
                along(before, plane.normal, inner(plane.normal, along(plane.point, before, -1)));
        const Vector x = meeting_point(planes, lo, hi);
        patches.push_back(p);
        found.push_back(
            {static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])});
    }
    const auto values = slopes_at(field, found, threads, progress);
    const std::vector<Point> near = moved(field, found, level, sign, threads, progress);
    for (std::size_t k = 0; k < found.size(); ++k)
        if (sign * values[0][k] > 0) at[patches[k]] = near[k];
}

// Moves vertices as far as triangles keep areas and do not cross. `from`: where none cross. `all`: it
// fails where one cannot be moved at all. `tangled`: it fails since too many cross.
bool move_apart(Mesh &mesh, const std::vector<Point> &from, bool all, bool &tangled,
                unsigned threads, Progress &progress) {
    constexpr std::array<double, 5> shares{1, 0.98, 0.85, 0.5, 0};
    const std::vector<Point> to = mesh.vertices;
    std::vector<std::uint8_t> back(from.size(), 0);
    std::vector<std::uint32_t> asked(mesh.triangles.size()); // that may cross others
    for (std::uint32_t t = 0; t < asked.size(); ++t) asked[t] = t;
    for (;;) { // each round moves some vertex back
        std::vector<std::uint32_t> bad;
        for (const std::uint32_t t : asked) {
            const auto &[a, b, c] = mesh.triangles[t];
            if (is_flat(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])) bad.push_back(t);
        }
        const bool flat = !bad.empty();
        if (!flat)
            for (const auto &[s, t] : crossings_with(mesh, asked, threads, progress))
                bad.push_back(s), bad.push_back(t);
        if (progress.cancelled) return false;
        if (bad.empty()) return true;
        tangled = bad.size() > most_crossing * static_cast<double>(mesh.triangles.size());
        if (tangled) return false;
        std::vector<std::uint8_t> moves(from.size(), 0);
        bool some = false;
        for (const std::uint32_t t : bad)
            for (const std::uint32_t v : mesh.triangles[t]) {
                if (moves[v] || back[v] + 1u == shares.size()) continue;
                moves[v] = 1, some = true;
                const double share = shares[++back[v]];
                if (share == 0 && all) return false;
                const Real3 here =
                    along(real(from[v]), fathom::mesh::minus(real(to[v]), real(from[v])), share);
                for (std::size_t i = 0; share > 0 && i < 3; ++i)
                    mesh.vertices[v][i] = static_cast<float>(here[i]);
                if (share == 0) mesh.vertices[v] = from[v];
            }
        if (!some) return false;
        std::vector<std::uint32_t> next;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            if (const auto &[a, b, c] = mesh.triangles[t]; moves[a] || moves[b] || moves[c])
                next.push_back(t);
        if (flat) { // the others have not been asked yet
            next.insert(next.end(), asked.begin(), asked.end());
            std::ranges::sort(next);
            next.erase(std::unique(next.begin(), next.end()), next.end());
        }
        asked = std::move(next);
    }
}

// Whether most of what a mesh does not show is walls or gaps, by samples.
ThinWalls thin_walls_of(const Field &field, const Settings &settings, const Made &made,
                        std::span<const Cell> cells, Progress &progress) {
    std::vector<double> walls, gaps;
    for (const Thin &thin :
         thin_in(field, made.octree.lattice, cells, threads_of(settings), progress))
        if (thin.thickness > 0) (thin.gap ? gaps : walls).push_back(thin.thickness);
    const bool more_gaps = gaps.size() > walls.size();
    std::vector<double> &thick = more_gaps ? gaps : walls;
    if (thick.empty() || 3 * thick.size() < 2 * std::min(cells.size(), most_places)) return {};
    std::ranges::sort(thick);
    return {thick[thick.size() / 4], more_gaps};
}

// The solid that is drawn in the scene's place, by cells that are `times` times smaller than the
// drawing cells.
struct WiderSolid {
    double side = 0;
    float by = 0; // it is grown by so much, or shrunk
    ir::Box box;
    std::optional<ir::Box> cut; // at which it ends
};

WiderSolid wider_solid(const Settings &settings, const Made &made, const ThinWalls &walls,
                       double times) {
    const Lattice &lattice = made.octree.lattice;
    WiderSolid solid{lattice.side(lattice.level) / times, 0, made.box, settings.bounds};
    const double by = 0.5 * std::max(shows_walls * solid.side - walls.thickness, 0.0);
    solid.by = static_cast<float>(walls.gaps ? -by : by);
    for (std::size_t i = 0; !walls.gaps && i < 3; ++i) {
        solid.box.lo[i] -= 1.01 * by, solid.box.hi[i] += 1.01 * by;
        if (!settings.bounds) continue;
        solid.box.lo[i] = std::max(solid.box.lo[i], settings.bounds->lo[i]);
        solid.box.hi[i] = std::min(solid.box.hi[i], settings.bounds->hi[i]);
    }
    if (!walls.gaps) solid.cut = solid.box;
    return solid;
}

Made draw_solid(const ir::Scene &scene, const Settings &settings, const WiderSolid &solid,
                Progress &progress) {
    Settings finer = settings;
    finer.side = solid.side;
    const Field wide(scene, settings.time, solid.cut, solid.by);
    return make_mesh_of(wide, solid.box, finer, progress);
}

// The same octree with another mesh, that of a drawn solid. None: there is none, or it was cancelled.
std::optional<Made> moved_to_surface(const Field &field, const Settings &settings, const Made &made,
                                     const ThinWalls &walls, const WiderSolid &solid, Made drawn,
                                     bool &tangled, Progress &progress) {
    const Lattice &lattice = made.octree.lattice;
    const float sign = walls.gaps ? -1.0f : 1.0f;
    const auto level = static_cast<float>(kept_off * walls.thickness);
    const unsigned threads = threads_of(settings);
    std::vector<Point> at = moved(field, drawn.mesh.vertices, level, sign, threads, progress);
    if (!progress.cancelled) find_edges(field, drawn, level, sign, threads, at, progress);
    progress.phase(progress.to);
    std::swap(at, drawn.mesh.vertices);
    // Else nothing would be proved there.
    const bool all = std::fabs(solid.by) > 0.5 * lattice.side(lattice.level);
    if (progress.cancelled || !move_apart(drawn.mesh, at, all, tangled, threads, progress))
        return std::nullopt;
    Made result = made;
    result.failure = Failure::None;
    result.mesh = std::move(drawn.mesh);
    result.widened = solid.by;
    find_roots(field, level, sign, threads, result, progress);
    if (progress.cancelled) return std::nullopt;
    return result;
}

// From how many places near the surface steps of sphere tracing come to another side within a width.
std::size_t sides_near(Mover &mover, std::span<Point> at, float level, float sign, double width) {
    constexpr int most = 32; // steps
    mover.move(at, level, sign);
    mover.look_at(at);
    const std::array<std::vector<float>, 4> slope = mover.slope;
    std::vector<float> values = slope[0];
    std::vector<double> gone(at.size(), 0);
    std::size_t hits = 0;
    for (int step = 0; step < most; ++step) {
        mover.points.clear();
        for (std::size_t k = 0; k < at.size(); ++k) {
            const double value = double(sign) * values[k],
                         rate = std::hypot(slope[1][k], slope[2][k], slope[3][k]);
            if (step == 0 && !(value > 0 && value < 8 * level && rate > 1e-3)) gone[k] = unbounded;
            if (gone[k] < width && !(value > 0.5 * level)) {
                hits += gone[k] > 4 * level; // it has come to another side
                gone[k] = unbounded;
            }
            Point p = at[k];
            if (gone[k] < width) gone[k] += value;
            for (std::size_t i = 0; gone[k] < width && i < 3; ++i)
                p[i] += static_cast<float>(sign * gone[k] * slope[1 + i][k] / rate);
            mover.points.add(p);
        }
        values_at(mover.evaluator, mover.tape_at(), mover.points, values);
    }
    return hits;
}

// Whether gaps between walls, or walls between gaps, are seen that are narrower than what both sides
// are moved by: from places near the surface by steps of sphere tracing.
bool may_close(const Field &field, const Made &made, const ThinWalls &walls, double width,
               unsigned threads, Progress &progress) {
    constexpr std::size_t looks = 4096, few = 4;
    const std::vector<Cell> cells = open_leaves(made.octree);
    const Lattice &lattice = made.octree.lattice;
    const std::size_t count = std::min(cells.size(), looks);
    const float sign = walls.gaps ? -1.0f : 1.0f;
    const auto level = static_cast<float>(kept_off * walls.thickness);
    std::vector<Point> at;
    for (std::size_t k = 0; k < count; ++k) {
        const Cell &cell = cells[k * cells.size() / count];
        const Point lo = point_of(lattice, cell.at),
                    hi = point_of(lattice, corner(cell.at, lattice.cells(cell.level), 7));
        at.push_back({});
        for (std::size_t i = 0; i < 3; ++i) at.back()[i] = 0.5f * (lo[i] + hi[i]);
    }
    std::atomic<std::size_t> hits{0};
    by_some(field, at, threads, progress, [&](Mover &mover, Numbers, std::span<Point> some) {
        hits += sides_near(mover, some, level, sign, width);
    });
    return hits > few;
}

} // namespace

Doubt doubt_of(const Made &made, const Certificate &certificate) {
    return {volume_in_doubt(certificate, made.octree.lattice), certificate.unproved.size()};
}

std::optional<Wider> draw_wider(const ir::Scene &scene, const Field &field,
                                const Settings &settings, const Made &made,
                                std::span<const Cell> cells, Proof proof, Progress &progress) {
    std::size_t crossed = 0;
    for (const Node &node : made.octree.nodes) crossed += node.children == none && node.crossed();
    if (cells.size() < few_cells || few_share * cells.size() < crossed) return std::nullopt;
    const ThinWalls walls = thin_walls_of(field, settings, made, cells, progress);
    if (!(walls.thickness > 0)) return std::nullopt;
    return draw_wider(scene, field, settings, made, walls, proof, progress);
}

std::optional<Wider> draw_wider(const ir::Scene &scene, const Field &field,
                                const Settings &settings, const Made &made, const ThinWalls &walls,
                                Proof proof, Progress &progress) {
    const bool certified = proof != Proof::Distances;
    std::optional<Wider> best;
    const double from = progress.from, to = progress.to;
    const auto affordable = [&](double times) {
        return times <= 1 || times * times * double(made.octree.nodes.size()) < most_nodes_of_wider;
    };
    struct Shown {
        std::optional<Form> form; // none: there is no such mesh
    };
    std::optional<Shown> coarser;                    // by cells of twice the side
    std::optional<std::pair<WiderSolid, Made>> next; // drawn to be compared
    for (const double times : {1.0, 2.0, 4.0}) {
        if (!affordable(times) || (!certified && times > 2)) break;
        progress.from = from, progress.to = from + 0.2 * (to - from);
        const auto draw = [&](double n) {
            const WiderSolid solid = wider_solid(settings, made, walls, n);
            Made drawn = draw_solid(scene, settings, solid, progress);
            return std::pair{solid, std::move(drawn)};
        };
        const auto form = [](const Made &drawn) {
            return drawn.failure == Failure::None ? std::optional(form_of(drawn.mesh))
                                                  : std::nullopt;
        };
        auto [solid, drawn] = next ? std::move(*next) : draw(times);
        next.reset();
        if (progress.cancelled) break;
        const std::optional<Form> here = form(drawn);
        const std::optional<Shown> before = std::exchange(coarser, Shown{here});
        if (!here) continue;
        progress.phase(from + 0.35 * (to - from));
        bool tangled = false;
        std::optional<Made> wide = moved_to_surface(field, settings, made, walls, solid,
                                                    std::move(drawn), tangled, progress);
        if (progress.cancelled) break;
        if (tangled && proof != Proof::AllOfBest) break; // smaller cells would take long in vain
        if (!wide) continue;
        progress.phase(to);
        Wider wider{std::move(*wide), {}};
        if (proof == Proof::AllOfBest) {
            wider.certificate = certify(field, settings, wider.made, nullptr, progress);
        } else {
            auto certificate = certify_if_near(field, settings, wider.made, progress);
            if (!certificate) continue;
            wider.certificate = std::move(*certificate);
        }
        if (progress.cancelled) break;
        if (wider.certificate.near()) {
            bool same = (before ? before->form : form(draw(0.5 * times).second)) == here;
            if (!same && certified && affordable(2 * times)) {
                next = draw(2 * times);
                same = form(next->second) == here;
            }
            if (progress.cancelled) break;
            wider.certificate.shape.doubted =
                !same || may_close(field, made, walls, 2 * std::fabs(solid.by),
                                   threads_of(settings), progress);
        }
        const Doubt doubt = doubt_of(wider.made, wider.certificate);
        const bool hopeless = best && !wider.certificate.near() && !best->certificate.near() &&
                              2 * doubt.volume > doubt_of(best->made, best->certificate).volume;
        const auto better = [&] {
            if (wider.certificate.near() != best->certificate.near())
                return wider.certificate.near();
            return wider.certificate.certified() || doubt < doubt_of(best->made, best->certificate);
        };
        if (!best || better()) best = std::move(wider);
        if (best->certificate.certified() || hopeless) break;
    }
    return best;
}

} // namespace fathom::mesh
