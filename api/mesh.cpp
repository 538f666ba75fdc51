#include "api/mesh.h"
#include "api/mesh_advice.h"

#include "mesh/appearance.h"
#include "mesh/measure.h"
#include "mesh/mend.h"
#include "mesh/simplify.h"
#include "mesh/write.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace fathom::v1 {
namespace {

constexpr int most_cells = 8000;
constexpr float farthest_bounds = 1e9f; // the square of a square of it is a float
constexpr double simplify_from = 0.8;   // of the progress

Mesh without_mesh(MeshStatus status, std::string message) {
    Mesh mesh;
    mesh.status = status;
    mesh.message = std::move(message);
    return mesh;
}

double length_of(const ir::Box &box) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, box.hi[i] - box.lo[i]);
    return longest;
}

// Whether there is no mesh because a cell is as large as the solid.
bool is_coarse(const fathom::mesh::Made &made, const fathom::mesh::Settings &settings) {
    using fathom::mesh::Failure;
    const bool unseen = made.failure == Failure::Unseen || made.failure == Failure::Empty ||
                        made.failure == Failure::Flat;
    const double longest = length_of(made.box);
    return unseen && longest > 0 && settings.side >= longest;
}

Mesh refused(const fathom::mesh::Made &made, const ir::Scene &scene,
             const fathom::mesh::Settings &settings) {
    Refusal why = refusal_of(made, settings);
    if (made.failure == fathom::mesh::Failure::Unseen && !is_coarse(made, settings))
        why.message = "the solid is thinner than the finest cells, if there is one; " +
                      advice_of(scene, settings, made, made.octree.undecided);
    return without_mesh(why.status, std::move(why.message));
}

void list_undecided(const fathom::mesh::Octree &octree,
                    const std::vector<fathom::mesh::Cell> &cells, Mesh &mesh) {
    constexpr std::size_t listed = 1000;
    mesh.undecided_cells = cells.size();
    for (const fathom::mesh::Cell &cell : cells) {
        if (mesh.undecided.size() == listed) break;
        const std::int32_t side = octree.lattice.cells(cell.level);
        mesh.undecided.push_back(
            {point_of(octree.lattice, cell.at),
             point_of(octree.lattice, fathom::mesh::corner(cell.at, side, 7))});
    }
}

MeshCertificate certificate_of(const fathom::mesh::Made &mesh,
                               const fathom::mesh::Certificate &found) {
    MeshCertificate made;
    made.certified = found.certified();
    made.mesh_to_surface = found.mesh_to_surface;
    made.surface_to_mesh = found.surface_to_mesh;
    made.seam_cells = found.seams.size();
    made.seam_width = found.seam_width;
    made.unproved_places = found.unproved.size();
    made.components = found.components;
    made.genus = found.genus;
    made.shape_proved = found.shape.proved;
    made.shape_why = why_shape_is_open(mesh, found);
    made.shape_open = found.shape.open;
    made.shape_place = found.shape.place;
    made.shape_doubted = found.shape.doubted;
    made.least_volume = found.least_volume;
    made.largest_volume = found.largest_volume;
    made.least_area = found.area.lo;
    made.largest_area = found.area.hi;
    made.open_places = found.open_places;
    made.open_place = found.open_place;
    made.area_why = why_area_is_open(found);
    made.looked_for_area = found.looked_for_area;
    made.mesh_volume = found.mesh_volume;
    made.mesh_area = found.mesh_area;
    made.rests_on = rests_on(found.used_bound);
    return made;
}

void take_appearance(fathom::mesh::Appearance found, Mesh &mesh) {
    mesh.colors = std::move(found.colors);
    mesh.corner_colors = std::move(found.corners);
    mesh.material_of = std::move(found.material_of);
    for (fathom::mesh::Material &m : found.materials)
        mesh.materials.push_back({std::move(m.name), m.diffuse, m.specular, m.emission, m.exponent,
                                  m.colored, m.varies});
}

// Objects as the writers see them; refers to `objects`.
struct Surfaces {
    std::vector<std::vector<fathom::mesh::Material>> materials;
    std::vector<fathom::mesh::Surface> objects;
};
Surfaces surfaces_of(const std::vector<MeshObject> &objects) {
    Surfaces made;
    for (const MeshObject &object : objects) {
        std::vector<fathom::mesh::Material> &materials = made.materials.emplace_back();
        for (const MeshMaterial &m : object.mesh->materials)
            materials.push_back(
                {m.name, m.diffuse, m.specular, m.emission, m.exponent, m.colored, m.varies});
    }
    for (std::size_t k = 0; k < objects.size(); ++k) {
        const Mesh &mesh = *objects[k].mesh;
        made.objects.push_back({mesh.vertices, mesh.normals, mesh.triangles, mesh.colors,
                                mesh.corner_colors, made.materials[k], mesh.material_of,
                                objects[k].name});
    }
    return made;
}

// Puts fewer triangles in the place of the mesh. Where colours are wanted, those of what comes in say
// what may go.
MeshSimplification simplified(fathom::mesh::Made &made, const ir::Scene &scene,
                              const MeshOptions &options) {
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    fathom::mesh::Paints paints;
    if (options.colors) {
        fathom::mesh::Appearance found =
            appearance_of(scene, options.time, made.mesh, lattice.unit);
        paints.colors = std::move(found.colors);
        paints.material_of = std::move(found.material_of);
    }
    fathom::mesh::Progress progress;
    if (options.progress) progress.report = [&](double) { return options.progress(simplify_from); };
    fathom::mesh::Simplified found =
        simplify(made.mesh, paints,
                 {options.simplify, lattice.side(lattice.level), threads_of(settings_of(options))},
                 progress);
    if (progress.cancelled) made.failure = fathom::mesh::Failure::Cancelled;
    made.mesh = std::move(found.mesh);
    made.simplified = found.undone ? 0 : options.simplify;
    return {found.before, found.colored, found.refused, found.undone};
}

bool good(const MeshOptions &options) {
    if (!(options.tolerance >= 0 && std::isfinite(options.tolerance))) return false;
    if (!(options.simplify >= 0 && std::isfinite(options.simplify))) return false;
    if (options.tolerance == 0 && (options.resolution < 1 || options.resolution > most_cells))
        return false;
    for (std::size_t i = 0; options.bounds && i < 3; ++i) {
        const float lo = options.bounds->lo[i], hi = options.bounds->hi[i];
        if (!(std::isfinite(lo) && std::isfinite(hi) && lo < hi)) return false;
    }
    return true;
}

bool too_far(const std::optional<Box> &bounds) {
    for (std::size_t i = 0; bounds && i < 3; ++i)
        if (!(bounds->lo[i] >= -farthest_bounds && bounds->hi[i] <= farthest_bounds)) return true;
    return false;
}

fathom::mesh::Format inner(MeshFormat format) {
    using fathom::mesh::Format;
    switch (format) {
    case MeshFormat::Stl: return Format::Stl;
    case MeshFormat::Obj: return Format::Obj;
    case MeshFormat::Ply: return Format::Ply;
    case MeshFormat::Glb: return Format::Glb;
    case MeshFormat::ThreeMf: return Format::ThreeMf;
    }
    return Format::Stl;
}

} // namespace

fathom::mesh::Unit inner(MeshUnit unit) {
    using fathom::mesh::Unit;
    switch (unit) {
    case MeshUnit::Unsaid: return Unit::Unsaid;
    case MeshUnit::Micron: return Unit::Micron;
    case MeshUnit::Millimetre: return Unit::Millimetre;
    case MeshUnit::Centimetre: return Unit::Centimetre;
    case MeshUnit::Metre: return Unit::Metre;
    case MeshUnit::Inch: return Unit::Inch;
    case MeshUnit::Foot: return Unit::Foot;
    }
    return Unit::Unsaid;
}

Refusal refusal_of(fathom::mesh::Failure failure, const fathom::mesh::Point &place) {
    using fathom::mesh::Failure;
    switch (failure) {
    case Failure::None: break;
    case Failure::Cancelled: return {MeshStatus::Cancelled, "cancelled"};
    case Failure::Empty:
        return {MeshStatus::Empty, "this scene is empty: no point lies in the solid; look for an "
                                   "intersection or a difference that leaves nothing over"};
    case Failure::Unseen:
        return {MeshStatus::TooCoarse,
                "the solid is thinner than the finest cells, if there is one: take a smaller "
                "tolerance or a larger resolution"};
    case Failure::Flat:
        return {MeshStatus::Empty,
                "this scene is empty but for faces without thickness, where its parts only touch: "
                "let them overlap"};
    case Failure::Endless:
        return {MeshStatus::Endless,
                "the solid has no end: cut it off by bounds, or in the scene, as with "
                "`& box(10)`"};
    case Failure::Unbounded:
        return {MeshStatus::Endless,
                "where the solid ends was not found by the work that is spent on it: say it by "
                "bounds, or in the scene, as with `& box(10)`"};
    case Failure::TooFine:
        return {MeshStatus::TooFine,
                "that is too fine: a mesh has at most 8,192 cells a side, and single "
                "precision has to tell them apart where the solid is; take a larger "
                "tolerance, or move the solid to the origin"};
    case Failure::Outside: return {MeshStatus::Empty, "no point of the solid lies in the bounds"};
    case Failure::TooMany:
        return {MeshStatus::TooFine, "that is too fine, and takes too many cells: take a larger "
                                     "tolerance or a smaller resolution"};
    case Failure::Contradicted:
        return {MeshStatus::Contradicted,
                fmt::format("near [{}, {}, {}] the field's sign contradicts its bound; where the "
                            "bound is stated (`lipschitz:`, `estimate:`), state a larger one",
                            place[0], place[1], place[2])};
    }
    return {};
}

Refusal refusal_of(const fathom::mesh::Made &made, const fathom::mesh::Settings &settings) {
    constexpr double spare = 1.1; // what an estimate may be off
    const double longest = length_of(made.box);
    if (is_coarse(made, settings))
        return {MeshStatus::TooCoarse,
                fmt::format("cells with sides of {:.3g} are larger than the solid, which is {:.3g} "
                            "long: take a tolerance of {:.2g}, for instance",
                            settings.side, longest, longest / 100)};
    if (made.failure == fathom::mesh::Failure::TooMany && made.octree.wanted > 0) {
        const fathom::mesh::Lattice &lattice = made.octree.lattice;
        const double coarser =
            spare * std::sqrt(std::max(made.octree.wanted / double(fathom::mesh::most_nodes), 1.0));
        const double side = coarser * lattice.side(lattice.level);
        return {MeshStatus::TooFine,
                fmt::format("that is too fine, and takes too many cells: a tolerance of {:.2g} may "
                            "do, or a resolution of {:.0f}",
                            side, std::floor(longest / side))};
    }
    return refusal_of(made.failure, made.place);
}

Refusal refusal_of(const Scene &scene, const MeshOptions &options) {
    if (!good(options))
        return {MeshStatus::BadOptions,
                "a tolerance is a number above 0, a resolution 1 to 8,000, and bounds "
                "are finite, the lower ones first"};
    if (too_far(options.bounds))
        return {MeshStatus::BadOptions,
                "bounds lie within 1e9 of the origin: farther out no cells of single precision "
                "show a solid"};
    if (!hold_at(scene.facts(), options.time))
        return {MeshStatus::BadOptions, beyond_proof(scene.facts())};
    return {};
}

std::vector<std::string> rests_on(bool used_bound) {
    std::vector<std::string> names{"intervals", "single-precision"};
    if (used_bound) names.push_back("bound");
    return names;
}

fathom::mesh::Settings settings_of(const MeshOptions &options, double share) {
    fathom::mesh::Settings settings;
    settings.side = options.tolerance;
    settings.resolution = options.resolution;
    settings.time = options.time;
    settings.threads = options.threads;
    if (options.progress)
        settings.progress = [report = options.progress, share](double done) {
            return report(share * done);
        };
    if (!options.bounds) return settings;
    settings.bounds.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
        settings.bounds->lo[i] = options.bounds->lo[i];
        settings.bounds->hi[i] = options.bounds->hi[i];
    }
    return settings;
}

Mesh make_mesh(const Scene &scene, const MeshOptions &options) noexcept {
    if (Refusal why = refusal_of(scene, options))
        return without_mesh(why.status, std::move(why.message));
    return guarded(
        [&] {
            const double share = options.simplify > 0 ? simplify_from : 1;
            const fathom::mesh::Settings settings = settings_of(options, share);
            fathom::mesh::Made made;
            fathom::mesh::Certificate certificate;
            Mesh mesh;
            if (options.certify) {
                fathom::mesh::Mended mended = make_certified_mesh(ir_of(scene), settings);
                made = std::move(mended.made);
                certificate = std::move(mended.certificate);
            } else {
                made = fathom::mesh::make_mesh(ir_of(scene), settings);
            }
            if (made.failure != fathom::mesh::Failure::None)
                return refused(made, ir_of(scene), settings);
            if (options.simplify > 0) {
                mesh.simplification = simplified(made, ir_of(scene), options);
                if (made.failure != fathom::mesh::Failure::None)
                    return refused(made, ir_of(scene), settings);
                if (options.certify && made.simplified > 0) {
                    fathom::mesh::Progress progress(options.progress, 0.9);
                    const fathom::mesh::Certificate before = std::move(certificate);
                    certificate = certify(ir_of(scene), settings, made, progress);
                    // It has the pieces and handles that it had.
                    certificate.shape = before.shape;
                    if (progress.cancelled) made.failure = fathom::mesh::Failure::Cancelled;
                    if (progress.cancelled) return refused(made, ir_of(scene), settings);
                }
            }
            if (options.colors) {
                const fathom::mesh::Lattice &lattice = made.octree.lattice;
                take_appearance(appearance_of(ir_of(scene), options.time, made.mesh, lattice.unit),
                                mesh);
            }
            if (options.certify) {
                fathom::mesh::Progress progress(options.progress, 1); // it was at its end
                enclose_measures(ir_of(scene), settings, made, progress, certificate);
                if (progress.cancelled) made.failure = fathom::mesh::Failure::Cancelled;
                if (progress.cancelled) return refused(made, ir_of(scene), settings);
                mesh.certificate = certificate_of(made, certificate);
            }
            const std::vector<fathom::mesh::Cell> &undecided =
                options.certify ? certificate.undecided : made.octree.undecided;
            list_undecided(made.octree, undecided, mesh);
            if (!undecided.empty())
                mesh.message = advice_of(ir_of(scene), settings, made, undecided);
            else if (certificate.shape.finer)
                mesh.message = advice_on_shape(made, *certificate.shape.finer);
            else if (!options.certify || !certificate.shape.proved)
                mesh.message =
                    advice_on_drawn(ir_of(scene), settings, made, certificate.shape.thin);
            mesh.vertices = std::move(made.mesh.vertices);
            mesh.normals = std::move(made.mesh.normals);
            mesh.triangles = std::move(made.mesh.triangles);
            return mesh;
        },
        [](const Diagnostic &why) { return without_mesh(MeshStatus::TooLarge, why.message); });
}

MeshNumbers numbers_of(const Mesh &mesh) noexcept {
    return guarded(
        [&] {
            const fathom::mesh::Mesh inner{mesh.vertices, {}, mesh.triangles};
            const fathom::mesh::Form form = form_of(inner);
            const fathom::mesh::MeshSums sums = sums_of(inner);
            return MeshNumbers{form.components, form.genus, sums.volume, sums.area};
        },
        [](const Diagnostic &) { return MeshNumbers(); });
}

std::optional<MeshFormat> mesh_format(std::string_view file_name) noexcept {
    struct Suffix {
        std::string_view text;
        MeshFormat format;
    };
    constexpr Suffix suffixes[] = {{".stl", MeshFormat::Stl},
                                   {".obj", MeshFormat::Obj},
                                   {".ply", MeshFormat::Ply},
                                   {".glb", MeshFormat::Glb},
                                   {".3mf", MeshFormat::ThreeMf}};
    for (const auto &[text, format] : suffixes) {
        if (file_name.size() <= text.size()) continue;
        const std::string_view end = file_name.substr(file_name.size() - text.size());
        bool same = true;
        for (std::size_t k = 0; k < end.size(); ++k) {
            const char c = end[k] >= 'A' && end[k] <= 'Z' ? static_cast<char>(end[k] + 32) : end[k];
            same = same && c == text[k];
        }
        if (same) return format;
    }
    return std::nullopt;
}

std::string mesh_file(const std::vector<MeshObject> &objects, MeshFormat format,
                      const MeshFileOptions &options) noexcept {
    return guarded(
        [&] {
            return file_of(surfaces_of(objects).objects, inner(format),
                           {inner(options.unit), options.name, options.material_library});
        },
        [](const Diagnostic &) { return std::string(); });
}

std::string material_library(const std::vector<MeshObject> &objects) noexcept {
    return guarded([&] { return material_library_of(surfaces_of(objects).objects); },
                   [](const Diagnostic &) { return std::string(); });
}

std::string mesh_file(const Mesh &mesh, MeshFormat format, std::string_view name,
                      MeshUnit unit) noexcept {
    return guarded(
        [&] {
            return mesh_file({{std::string(name), &mesh}}, format,
                             MeshFileOptions{unit, std::string(name), ""});
        },
        [](const Diagnostic &) { return std::string(); });
}

} // namespace fathom::v1
