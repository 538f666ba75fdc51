// fathom mesh: the surface as triangles, in a file. The mesh is whole before its file appears.
#include "cli/interrupt.h"
#include "cli/solid.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

// What may be there and is not in the mesh.
void say_undecided(const v1::Mesh &mesh, const MeshCommand &command, Terminal &terminal) {
    if (mesh.undecided_cells == 0) return;
    const v1::Box &box = mesh.undecided.front();
    terminal.say(fmt::format("{}: {} cells may hold surface that the mesh does not show, the first "
                             "of them from [{:.6g}, "
                             "{:.6g}, {:.6g}] to [{:.6g}, {:.6g}, {:.6g}]; a finer mesh "
                             "(`--resolution {}`) or a tighter "
                             "bound tells more",
                             command.out, mesh.undecided_cells, box.lo[0], box.lo[1], box.lo[2],
                             box.hi[0], box.hi[1], box.hi[2], 2 * command.solid.resolution));
}

// The certificate as a document; distances are null where they do not hold everywhere.
std::string json_of(const v1::Mesh &mesh) {
    using Json = nlohmann::ordered_json;
    const v1::MeshCertificate &c = *mesh.certificate;
    Json json;
    json["status"] = c.certified ? "certified" : "partial";
    json["triangles"] = mesh.triangles.size();
    json["vertices"] = mesh.vertices.size();
    json["watertight"] = true;
    json["self_intersections"] = 0; // both by construction
    json["components"] = c.components;
    json["genus"] = c.genus;
    const auto everywhere = [&](double d) { return c.certified ? Json(d) : Json(); };
    json["mesh_to_surface"] = everywhere(c.mesh_to_surface);
    json["surface_to_mesh"] = everywhere(c.surface_to_mesh);
    json["volume"] = {c.least_volume, c.largest_volume};
    json["mesh_volume"] = c.mesh_volume;
    json["mesh_area"] = c.mesh_area;
    json["undecided_cells"] = mesh.undecided_cells;
    json["unproved_places"] = c.unproved_places;
    json["undecided"] = Json::array();
    for (const v1::Box &box : mesh.undecided) json["undecided"].push_back({box.lo, box.hi});
    json["rests_on"] = c.rests_on;
    return json.dump() + "\n";
}

} // namespace

Exit run(const MeshCommand &command, Terminal &terminal) {
    const std::string &file = command.solid.scene.file;
    if (overwrites(file, command.out, terminal) || misnamed(command.out, Content::Mesh, terminal))
        return usage_error;
    const v1::MeshFormat format =
        v1::mesh_format(command.out).value_or(v1::MeshFormat::Stl); // a stream has no suffix
    if (!command.solid.units.empty() && format != v1::MeshFormat::ThreeMf &&
        format != v1::MeshFormat::Glb) {
        terminal.say(fmt::format("fathom: --units: `{}` says nothing of units; .3mf and .glb do",
                                 command.out));
        return usage_error;
    }
    if (unwritable(command.out, terminal)) return device_error;
    const Solid solid = open_solid(command.solid, terminal);
    if (!solid.scene) return solid.exit;
    if (overwrites(solid.files, command.out, terminal)) return usage_error;
    v1::MeshOptions options = options_of(command.solid);
    options.certify = command.json;
    options.colors = format != v1::MeshFormat::Stl;
    const Interrupts interrupts;
    options.progress = [&](double share) {
        terminal.progress(command.out, share);
        return !Interrupts::noticed();
    };
    const v1::Mesh mesh = v1::make_mesh(*solid.scene, options);
    terminal.finish_progress();
    if (Interrupts::noticed()) { // nothing is written
        terminal.flush();
        Interrupts::obey();
    }
    if (!mesh) return say_refusal(file, "mesh", mesh.status, mesh.message, terminal);
    say_undecided(mesh, command, terminal);
    const std::string stem = std::filesystem::path(file).stem().string();
    const std::string name = !command.solid.part.empty() ? command.solid.part
                             : stem == "-"               ? "scene"
                                                         : stem;
    const UnitRow *unit = unit_named(command.solid.units);
    const std::string bytes =
        v1::mesh_file(mesh, format, name, unit ? unit->unit : v1::MeshUnit::Unsaid);
    if (bytes.empty()) {
        terminal.say(fmt::format("fathom: {} triangles are more than `{}` can hold, or than there "
                                 "is memory for",
                                 mesh.triangles.size(), command.out));
        return device_error;
    }
    if (terminal.interactive())
        terminal.say(fmt::format("{}: {} triangles, {} vertices", command.out,
                                 mesh.triangles.size(), mesh.vertices.size()));
    const Exit exit = write_result(command.out, bytes, terminal);
    if (exit == done && command.json) terminal.put(json_of(mesh));
    return exit;
}

} // namespace fathom::cli
