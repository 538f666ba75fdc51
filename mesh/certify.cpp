#include "mesh/certify.h"

#include "mesh/inquiry.h"
#include "mesh/measure.h"
#include "mesh/pieces.h"

#include <algorithm>

namespace fathom::mesh {
namespace {
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
    kept.seam_width = earlier.certificate.seam_width;
    const auto changed = [&](const Cell &cell) {
        return earlier.changed.beside(real(point_of(octree.lattice, cell.at)));
    };
    for (std::size_t k = 0; k < earlier.certificate.undecided.size(); ++k)
        if (!changed(earlier.certificate.undecided[k])) {
            kept.undecided.push_back(earlier.certificate.undecided[k]);
            kept.doubts.push_back(earlier.certificate.doubts[k]);
        }
    for (const std::int32_t node : earlier.certificate.empty)
        if (octree.nodes[static_cast<std::size_t>(node)].children == none)
            kept.empty.push_back(node);
    for (const Cell &cell : earlier.certificate.seams)
        if (!changed(cell)) kept.seams.push_back(cell);
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

// Both distances, into the certificate.
void certify_distances(const Field &field, const Settings &settings, const Made &made,
                       const Earlier *earlier, bool all_or_nothing, Progress &progress,
                       Certificate &certificate) {
    const unsigned threads = threads_of(settings);
    const Lattice &lattice = made.octree.lattice;
    const double side = lattice.side(lattice.level);
    const Point origin = point_of(lattice, {0, 0, 0});
    Inquiry inquiry{.made = made,
                    .field = field,
                    .trusts = true,
                    .allowed = side + made.simplified,
                    .own = made.simplified == 0 && made.widened == 0,
                    .earlier = earlier,
                    .all_or_nothing = all_or_nothing,
                    // Boxes of twice what is allowed are looked up: in no more than five a side.
                    .by_root = Grid(origin, std::max(side, 0.5 * (side + made.simplified)))};
    fill(inquiry);
    const double from = progress.from, to = progress.to;
    progress.to = 0.5 * (from + to);
    certify_surface(inquiry, threads, progress, certificate);
    if (progress.cancelled || inquiry.in_vain()) return;
    progress.phase(to);
    certify_mesh(inquiry, threads, progress, certificate);
}

// What is known by the mesh alone, and by the octree.
void complete(const Field &field, const Made &made, Certificate &certificate) {
    certificate.used_bound = field.proved;
    const Form form = form_of(made.mesh);
    certificate.components = form.components;
    certificate.genus = form.genus;
    const MeshSums sums = sums_of(made.mesh);
    certificate.mesh_volume = sums.volume;
    certificate.mesh_area = sums.area;
    enclose_volume(made.octree, certificate);
}

} // namespace

std::uint64_t volume_in_doubt(const Certificate &certificate, const Lattice &lattice) {
    std::uint64_t sum = 0;
    for (const Cell &cell : certificate.undecided)
        sum += std::uint64_t{1} << (3 * (lattice.depth - cell.level));
    return sum;
}

Form form_of(const Mesh &mesh) {
    const std::vector<std::uint32_t> pieces = pieces_of(mesh);
    Form form;
    for (std::uint32_t v = 0; v < pieces.size(); ++v) form.components += pieces[v] == v;
    // Closed: three edges for two triangles. All vertices are used.
    const long euler =
        static_cast<long>(mesh.vertices.size()) - static_cast<long>(mesh.triangles.size()) / 2;
    form.genus = static_cast<long>(form.components) - euler / 2;
    return form;
}

Certificate certify(const Field &field, const Settings &settings, const Made &made,
                    const Earlier *earlier, Progress &progress) {
    Certificate certificate = earlier ? kept_of(*earlier, made.octree) : Certificate{};
    certify_distances(field, settings, made, earlier, false, progress, certificate);
    if (!progress.cancelled) complete(field, made, certificate);
    return certificate;
}

std::optional<Certificate> certify_if_near(const Field &field, const Settings &settings,
                                           const Made &made, Progress &progress) {
    Certificate certificate;
    certify_distances(field, settings, made, nullptr, true, progress, certificate);
    if (progress.cancelled || !certificate.near()) return std::nullopt;
    complete(field, made, certificate);
    return certificate;
}

Certificate certify(const ir::Scene &scene, const Settings &settings, const Made &made,
                    Progress &progress) {
    return certify(Field(scene, settings.time, settings.bounds), settings, made, nullptr, progress);
}

void enclose_measures(const ir::Scene &scene, const Settings &settings, const Made &made,
                      Progress &progress, Certificate &certificate) {
    const Measures of = measure(scene, settings, made, progress, beside_certificate);
    if (progress.cancelled) return; // what was not looked at is not in the sums
    certificate.least_volume = std::max(certificate.least_volume, of.volume.lo);
    certificate.largest_volume = std::min(certificate.largest_volume, of.volume.hi);
    certificate.area = of.area;
    certificate.open_places = of.open_places;
    certificate.open_place = of.open_place;
    certificate.looked_for_area = of.looked;
    certificate.used_bound = certificate.used_bound || of.used_bound;
    const ShapeAnswer &shape = certificate.shape;
    if (!shape.proved) return;
    certificate.least_volume = std::max(certificate.least_volume, shape.volume.lo);
    certificate.largest_volume = std::min(certificate.largest_volume, shape.volume.hi);
    certificate.area = {std::max(of.area.lo, shape.area.lo), std::min(of.area.hi, shape.area.hi)};
    certificate.open_places = 0;
    certificate.looked_for_area = true;
}

} // namespace fathom::mesh
