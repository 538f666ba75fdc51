#include <fathom/part_meshes.h>

#include "api/mesh.h"
#include "api/parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace fathom::v1 {
namespace {

constexpr double most_evaluations = 50e6;
constexpr int least_resolution = 16; // of a part

double longest_side(const ir::Box &box) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, box.hi[i] - box.lo[i]);
    return longest;
}

PartMeshes without_meshes(MeshStatus status, std::string message) {
    PartMeshes made;
    made.status = status;
    made.message = std::move(message);
    return made;
}

// A part that has a mesh. Its scene is made anew where it is needed: a copy of the whole is in it.
struct Work {
    const Statement *statement = nullptr;
    double side = 0; // of its cells
    std::array<fathom::mesh::Point, 2> box{};
};

std::array<fathom::mesh::Point, 2> ends_of(const std::vector<Point> &vertices) {
    std::array<fathom::mesh::Point, 2> box{vertices[0], vertices[0]};
    for (const Point &p : vertices)
        for (std::size_t i = 0; i < 3; ++i)
            box[0][i] = std::min(box[0][i], p[i]), box[1][i] = std::max(box[1][i], p[i]);
    return box;
}

bool holds(const std::array<fathom::mesh::Point, 2> &box, const Point &p) {
    for (std::size_t i = 0; i < 3; ++i)
        if (!(p[i] >= box[0][i] && p[i] <= box[1][i])) return false;
    return true;
}

bool meet(const std::array<fathom::mesh::Point, 2> &a,
          const std::array<fathom::mesh::Point, 2> &b) {
    for (std::size_t i = 0; i < 3; ++i)
        if (!(a[0][i] <= b[1][i] && b[0][i] <= a[1][i])) return false;
    return true;
}

// One part's field at points.
struct Values {
    Values(const Scene &whole, const Work &part, const MeshOptions &options)
        : scene(scene_of(whole, *part.statement)),
          field(ir_of(scene), options.time, settings_of(options).bounds), evaluator(field) {}
    const std::vector<float> &at(const fathom::mesh::Points &points) {
        if (points.size() > 0)
            values_at(evaluator, *field.whole, points, out);
        else
            out.clear();
        return out;
    }
    Scene scene;
    fathom::mesh::Field field;
    fathom::mesh::Evaluator evaluator;
    std::vector<float> out;
};

// A point inside of a part's surface, and deep in another part.
struct Candidate {
    std::size_t of, in;
    Point at;
};

// Deep vertices of other parts in part j, moved below their own surface: some of each part.
void find_candidates(const Scene &scene, const std::vector<Work> &work, const PartMeshes &made,
                     std::size_t j, const MeshOptions &options, double &evaluations,
                     std::vector<Candidate> &candidates) {
    constexpr std::size_t wanted = 8; // of each pair
    std::optional<Values> values;
    for (std::size_t i = 0; i < work.size(); ++i) {
        if (i == j || !meet(work[i].box, work[j].box)) continue;
        const Mesh &mesh = made.parts[i].mesh;
        fathom::mesh::Points vertices, below;
        std::vector<std::size_t> which;
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
            if (holds(work[j].box, mesh.vertices[v]))
                vertices.add(mesh.vertices[v]), which.push_back(v);
        evaluations += static_cast<double>(which.size());
        if (which.empty() || evaluations > most_evaluations) continue;
        if (!values) values.emplace(scene, work[j], options);
        const std::vector<float> depths = values->at(vertices);
        const auto side = static_cast<float>(work[i].side);
        std::vector<std::size_t> deep;
        for (std::size_t k = 0; k < which.size(); ++k)
            if (depths[k] < -side / 4) deep.push_back(k);
        std::ranges::stable_sort(deep, {}, [&](std::size_t k) { return depths[k]; });
        if (deep.size() > wanted) deep.resize(wanted);
        for (const std::size_t k : deep) {
            Point p = mesh.vertices[which[k]];
            for (std::size_t a = 0; a < 3; ++a) p[a] -= side / 8 * mesh.normals[which[k]][a];
            below.add(p);
        }
        const std::vector<float> &there = values->at(below);
        for (std::size_t k = 0; k < there.size(); ++k)
            if (there[k] < 0) candidates.push_back({i, j, below[k]});
    }
}

// Of the candidates those that lie in both parts; the first of each pair.
void find_overlaps(const Scene &scene, const std::vector<Work> &work, const MeshOptions &options,
                   PartMeshes &made) {
    double evaluations = 0;
    std::vector<Candidate> candidates;
    for (std::size_t j = 0; j < work.size(); ++j)
        find_candidates(scene, work, made, j, options, evaluations, candidates);
    made.overlaps_incomplete = evaluations > most_evaluations;
    std::ranges::stable_sort(candidates, {}, &Candidate::of);
    std::map<std::pair<std::size_t, std::size_t>, Point> found;
    for (std::size_t k = 0; k < candidates.size();) {
        const std::size_t of = candidates[k].of;
        std::size_t end = k;
        fathom::mesh::Points points;
        while (end < candidates.size() && candidates[end].of == of)
            points.add(candidates[end++].at);
        Values values(scene, work[of], options);
        const std::vector<float> &there = values.at(points);
        for (std::size_t c = k; c < end; ++c)
            if (there[c - k] < 0)
                found.try_emplace(std::minmax(of, candidates[c].in), candidates[c].at);
        k = end;
    }
    for (const auto &[pair, at] : found) made.overlaps.push_back({pair.first, pair.second, at});
}

PartMeshes part_meshes(const Scene &scene, const MeshOptions &options) {
    ir::Box box;
    const auto failure = box_of(ir_of(scene), settings_of(options), box);
    if (failure != fathom::mesh::Failure::None) {
        Refusal why = refusal_of(failure);
        return without_meshes(why.status, std::move(why.message));
    }
    const std::vector<Statement> statements = statements_of(scene);
    const Sources &sources = scene.impl().compilation->sources;
    PartMeshes made;
    std::vector<Work> work;
    for (std::size_t k = 0; k < statements.size(); ++k) {
        const Statement &statement = statements[k];
        const Scene alone = scene_of(scene, statement);
        Work part{&statement, options.tolerance, {}};
        ir::Box own;
        const auto no_box = box_of(ir_of(alone), settings_of(options), own);
        if (no_box == fathom::mesh::Failure::None && part.side == 0)
            part.side = std::min(longest_side(box) / options.resolution,
                                 longest_side(own) / least_resolution);
        MeshOptions of_part = options;
        of_part.tolerance = part.side;
        if (options.progress)
            of_part.progress = [&](double done) {
                return options.progress((static_cast<double>(k) + done) /
                                        static_cast<double>(statements.size()));
            };
        Mesh mesh = make_mesh(alone, of_part);
        if (mesh.status == MeshStatus::Empty) {
            made.empty.push_back({statement.name, place_of(statement.span, sources)});
            continue;
        }
        if (!mesh)
            return without_meshes(mesh.status,
                                  fmt::format("part `{}`: {}", statement.name, mesh.message));
        part.box = ends_of(mesh.vertices);
        work.push_back(part);
        made.parts.push_back({statement.name, place_of(statement.span, sources), std::move(mesh)});
    }
    if (made.parts.empty()) {
        Refusal why = refusal_of(fathom::mesh::Failure::Empty);
        return without_meshes(why.status, std::move(why.message));
    }
    find_overlaps(scene, work, options, made);
    return made;
}

} // namespace

PartMeshes make_part_meshes(const Scene &scene, const MeshOptions &options) noexcept {
    if (Refusal why = refusal_of(scene, options))
        return without_meshes(why.status, std::move(why.message));
    return guarded(
        [&] { return part_meshes(scene, options); },
        [](const Diagnostic &why) { return without_meshes(MeshStatus::TooLarge, why.message); });
}

} // namespace fathom::v1
