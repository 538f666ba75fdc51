// fathom mesh: the surface as triangles, in a file. The mesh is whole before its file appears.
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/solid.h"

#include <fathom/part_meshes.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

// What may be there and is not in the mesh.
void say_undecided(const v1::Mesh &mesh, const std::string &what, Terminal &terminal) {
    if (mesh.undecided_cells == 0) {
        if (!mesh.message.empty()) terminal.say(fmt::format("{}: {}", what, mesh.message));
        return;
    }
    const v1::Box &box = mesh.undecided.front();
    terminal.say(
        fmt::format("{}: {} cells may hold surface that the mesh does not show, the first "
                    "of them from [{:.6g}, {:.6g}, {:.6g}] to [{:.6g}, {:.6g}, {:.6g}]; {}",
                    what, mesh.undecided_cells, box.lo[0], box.lo[1], box.lo[2], box.hi[0],
                    box.hi[1], box.hi[2], mesh.message));
}

// The certificate as a document; distances are null where they do not hold everywhere. Without a
// certificate what is only proved with one is left out.
Json json_of(const v1::Mesh &mesh) {
    const v1::MeshCertificate *c = mesh.certificate ? &*mesh.certificate : nullptr;
    const v1::MeshNumbers of =
        c ? v1::MeshNumbers{c->components, c->genus, c->mesh_volume, c->mesh_area}
          : v1::numbers_of(mesh);
    Json json;
    json["status"] = !c ? "unproved" : c->certified ? "certified" : "partial";
    const bool near = c && mesh.undecided_cells == 0 && c->unproved_places == 0;
    if (c) { // what the status speaks of stands beside it
        json["proved"] = Json::array();
        if (near) json["proved"].push_back("distances");
        if (c->shape_proved) json["proved"].push_back("shape");
        if (std::isfinite(c->largest_area)) json["proved"].push_back("area");
        json["components"] = c->shape_proved ? Json(of.components) : Json();
        json["genus"] = c->shape_proved ? Json(of.genus) : Json();
    }
    json["triangles"] = mesh.triangles.size();
    json["vertices"] = mesh.vertices.size();
    json["watertight"] = true;
    json["self_intersections"] = 0; // both by construction
    json["mesh_components"] = of.components;
    json["mesh_genus"] = of.genus;
    if (c) {
        const auto everywhere = [&](double d) { return near ? Json(d) : Json(); };
        if (!c->shape_proved)
            json["shape_open"] = {{"cells", c->shape_open},
                                  {"near", c->shape_open > 0 ? Json(c->shape_place) : Json()},
                                  {"doubted", c->shape_doubted},
                                  {"why", c->shape_why}};
        json["mesh_to_surface"] = everywhere(c->mesh_to_surface);
        json["surface_to_mesh"] = everywhere(c->surface_to_mesh);
        json["volume"] = {c->least_volume, c->largest_volume};
        json["area"] = {c->least_area,
                        std::isfinite(c->largest_area) ? Json(c->largest_area) : Json()};
        if (c->open_places > 0)
            json["area_open"] = {{"boxes", c->open_places},
                                 {"near", c->open_place},
                                 {"looked_for", c->looked_for_area},
                                 {"why", c->area_why}};
    }
    json["mesh_volume"] = of.volume;
    json["mesh_area"] = of.area;
    json["undecided_cells"] = mesh.undecided_cells;
    if (c) {
        json["unproved_places"] = c->unproved_places;
        json["seam_cells"] = c->seam_cells;
        json["seam_width"] = c->seam_width;
    }
    if (mesh.simplification)
        json["simplified"] = {{"triangles_before", mesh.simplification->triangles_before},
                              {"colored_triangles", mesh.simplification->colored_triangles},
                              {"refused", mesh.simplification->refused},
                              {"undone", mesh.simplification->undone}};
    json["undecided"] = Json::array();
    for (const v1::Box &box : mesh.undecided) json["undecided"].push_back({box.lo, box.hi});
    if (c) json["rests_on"] = c->rests_on;
    return json;
}

// The certificate in a line, for who has no document.
void say_certificate(const v1::Mesh &mesh, const std::string &what, Terminal &terminal) {
    if (!mesh.certificate) return;
    const v1::MeshCertificate &c = *mesh.certificate;
    const std::string area =
        std::isfinite(c.largest_area)
            ? fmt::format("between {:.6g} and {:.6g}", c.least_area, c.largest_area)
            : fmt::format("above {:.6g} ({})", c.least_area, c.area_why);
    const std::string volume =
        fmt::format("the solid's volume lies between {:.6g} and {:.6g}, its area {}",
                    c.least_volume, c.largest_volume, area);
    const std::string pieces =
        c.components == 1 ? "one piece" : fmt::format("{} pieces", c.components);
    const std::string near = fmt::format("all of the mesh lies within {:.3g} of the surface, and "
                                         "all of the surface within {:.3g} of the mesh",
                                         c.mesh_to_surface, c.surface_to_mesh);
    const std::string handles =
        fmt::format("{} and {} handle{}", pieces, c.genus, c.genus == 1 ? "" : "s");
    // Distances say nothing of what lies nearer than they are.
    const std::string open =
        fmt::format("whether pieces nearer than that are apart, and narrower holes open, is not "
                    "proved: {}; the mesh is in {}",
                    c.shape_why, handles);
    if (c.certified)
        terminal.say(fmt::format("{}: certified{}: {}; {}; {}", what,
                                 c.shape_proved ? "" : ", but for pieces and handles", near,
                                 c.shape_proved ? "the solid's surface is in " + handles : open,
                                 volume));
    else if (c.shape_doubted)
        terminal.say(fmt::format("{}: partial: {}; but that the solid has the mesh's pieces and "
                                 "handles is in doubt; {}; {}",
                                 what, near, open, volume));
    else
        terminal.say(fmt::format("{}: partial: of {} cells and of {} places of the mesh nothing is "
                                 "proved; {}",
                                 what, mesh.undecided_cells, c.unproved_places, volume));
}

// The same of parts, each with its name and line.
Json json_of(const v1::PartMeshes &made) {
    Json json;
    json["parts"] = Json::array();
    for (const v1::PartMesh &part : made.parts) {
        Json row{{"name", part.name}, {"line", part.at.line}};
        row.update(json_of(part.mesh));
        json["parts"].push_back(row);
    }
    json["empty"] = Json::array();
    for (const v1::Part &part : made.empty) json["empty"].push_back(part.name);
    json["overlaps"] = Json::array();
    for (const v1::PartOverlap &overlap : made.overlaps)
        json["overlaps"].push_back(
            {{"between", {made.parts[overlap.first].name, made.parts[overlap.second].name}},
             {"at", overlap.at}});
    json["all_overlaps_looked_for"] = !made.overlaps_incomplete;
    return json;
}

// What a user of the parts has to know of them.
void say_parts(const v1::PartMeshes &made, const std::string &out, Terminal &terminal) {
    for (const v1::Part &part : made.empty)
        terminal.say(fmt::format("{}: part `{}` (line {}) holds no point, and is left out", out,
                                 part.name, part.at.line));
    if (!made.overlaps.empty()) {
        const v1::PartOverlap &first = made.overlaps.front();
        terminal.say(fmt::format(
            "{}: {} overlap: `{}` and `{}`{} at [{:.6g}, {:.6g}, {:.6g}]: each "
            "object is whole, and surface of one lies inside of another; without --parts the file "
            "has the surface of all together",
            out,
            made.overlaps.size() == 1 ? "two parts"
                                      : fmt::format("{} pairs of parts", made.overlaps.size()),
            made.parts[first.first].name, made.parts[first.second].name,
            made.overlaps.size() == 1 ? "" : " first,", first.at[0], first.at[1], first.at[2]));
    }
    if (made.overlaps_incomplete)
        terminal.say(fmt::format(
            "{}: parts may overlap that are not named: too many lie near each other", out));
}

// Where a material of the file is only a mean of what the scene has.
void say_means(const v1::Mesh &mesh, const std::string &out, Terminal &terminal) {
    for (const v1::MeshMaterial &material : mesh.materials)
        if (material.varies)
            terminal.say(fmt::format("{}: highlight or emission of material `{}` differ from place "
                                     "to place; the file has their means",
                                     out, material.name));
}

// What --simplify left as it was, and why.
void say_simplified(const v1::Mesh &mesh, const std::string &what, double tolerance,
                    Terminal &terminal) {
    if (!mesh.simplification) return;
    const v1::MeshSimplification &s = *mesh.simplification;
    if (s.undone)
        terminal.say(
            fmt::format("{}: not simplified: fewer triangles would have had another shape; "
                        "a smaller tolerance than {} may do",
                        what, tolerance));
    else if (2 * s.colored_triangles > mesh.triangles.size())
        terminal.say(fmt::format("{}: {} of {} triangles stay, since paints meet there; an STL has "
                                 "no paint",
                                 what, s.colored_triangles, mesh.triangles.size()));
}

// Of an OBJ. A `#` begins a comment where the OBJ names it.
std::string library_of(const std::string &out) {
    std::filesystem::path path(out);
    std::string name = path.stem().string();
    std::ranges::replace(name, '#', '.');
    return path.replace_filename(name + ".mtl").string();
}

// What there is to write, in the order of the file.
struct Objects {
    v1::PartMeshes parts;
    v1::Mesh whole; // without --parts
    std::vector<v1::MeshObject> all;
};

Exit write_objects(const Objects &objects, const MeshCommand &command, const std::string &out,
                   v1::MeshFormat format, const std::string &name, Terminal &terminal) {
    const UnitRow *unit = unit_named(command.solid.units);
    v1::MeshFileOptions options{unit ? unit->unit : v1::MeshUnit::Unsaid, name, ""};
    const bool has_library = format == v1::MeshFormat::Obj;
    if (has_library)
        options.material_library = std::filesystem::path(library_of(out)).filename().string();
    const std::string bytes = v1::mesh_file(objects.all, format, options);
    std::size_t triangles = 0, vertices = 0;
    for (const v1::MeshObject &object : objects.all) {
        triangles += object.mesh->triangles.size();
        vertices += object.mesh->vertices.size();
    }
    if (bytes.empty()) {
        terminal.say(fmt::format("fathom: {} triangles are more than `{}` can hold, or than there "
                                 "is memory for",
                                 triangles, out));
        return device_error;
    }
    if (terminal.interactive())
        terminal.say(fmt::format("{}: {}{} triangles, {} vertices", out,
                                 command.parts ? fmt::format("{} object{}, ", objects.all.size(),
                                                             objects.all.size() == 1 ? "" : "s")
                                               : "",
                                 triangles, vertices));
    if (!has_library) return write_result(out, bytes, terminal);
    const std::string library = v1::material_library(objects.all);
    if (library.empty()) throw std::bad_alloc();
    return write_results({{out, bytes}, {library_of(out), library}}, terminal);
}

// Refused before any work is done.
Exit refused(const MeshCommand &command, v1::MeshFormat format, Terminal &terminal) {
    const std::string &file = command.solid.scene.file;
    if (overwrites(file, command.out, terminal) || misnamed(command.out, Content::Mesh, terminal))
        return usage_error;
    const bool of_lengths = // --units says what those are
        !command.solid.tolerance.unit.empty() || !command.simplify.unit.empty();
    if (!command.solid.units.empty() && !of_lengths && format != v1::MeshFormat::ThreeMf &&
        format != v1::MeshFormat::Glb) {
        terminal.say(fmt::format("fathom: --units: `{}` says nothing of units; .3mf and .glb do",
                                 command.out));
        return usage_error;
    }
    if (command.parts && (format == v1::MeshFormat::Stl || format == v1::MeshFormat::Ply)) {
        terminal.say(fmt::format("fathom: --parts: `{}` holds one object; .glb, .obj and .3mf hold "
                                 "several. `--part NAME` writes one part",
                                 command.out));
        return usage_error;
    }
    const std::vector<int> &film = command.solid.frames.numbers;
    const std::string first = film.empty() ? command.out : frame_name(command.out, film[0]);
    if (format == v1::MeshFormat::Obj && unwritable(library_of(first), terminal))
        return device_error;
    return done;
}

std::string name_of(const std::string &scene) {
    const std::string stem = std::filesystem::path(scene).stem().string();
    return stem == "-" ? "scene" : stem;
}

// The file of one of several scenes.
std::string out_of(const MeshCommand &command, const std::string &scene) {
    std::string out = command.out;
    const std::string name = name_of(scene), mark = "{}";
    for (std::size_t at = out.find(mark); at != out.npos; at = out.find(mark, at + name.size()))
        out.replace(at, mark.size(), name);
    return out;
}

// One frame's mesh, and its document.
Exit make(const MeshCommand &command, v1::MeshFormat format, const SolidFrame &frame,
          Terminal &terminal) {
    const std::string &file = command.solid.scene.file;
    if (format == v1::MeshFormat::Obj && overwrites(frame.files, library_of(frame.out), terminal))
        return usage_error;
    v1::MeshOptions options = options_of(frame.arguments);
    options.certify = command.certify.value_or(command.solid.json);
    options.colors = format != v1::MeshFormat::Stl;
    options.simplify = in_scene(command.simplify, frame.arguments);
    options.progress = frame.progress;
    Objects objects;
    if (command.parts)
        objects.parts = v1::make_part_meshes(frame.scene, options);
    else
        objects.whole = v1::make_mesh(frame.scene, options);
    stop_if_interrupted(terminal); // nothing is written
    const auto &[status, message] = command.parts
                                        ? std::tie(objects.parts.status, objects.parts.message)
                                        : std::tie(objects.whole.status, objects.whole.message);
    if (status != v1::MeshStatus::Done) {
        terminal.finish_progress();
        return say_refusal(command.solid, frame.number ? frame.out : file, "mesh", status, message,
                           terminal);
    }
    const std::string name = command.solid.part.empty() ? name_of(file) : command.solid.part;
    terminal.finish_progress();
    const auto take = [&](const std::string &what, const std::string &called,
                          const v1::Mesh &mesh) {
        if (!command.solid.json) say_certificate(mesh, what, terminal);
        say_undecided(mesh, what, terminal);
        say_simplified(mesh, what, options.simplify, terminal);
        objects.all.push_back({called, &mesh});
    };
    if (command.parts) {
        say_parts(objects.parts, frame.out, terminal);
        for (const v1::PartMesh &part : objects.parts.parts)
            take(fmt::format("{}: part `{}`", frame.out, part.name), part.name, part.mesh);
    } else {
        take(frame.out, name, objects.whole);
    }
    if (format == v1::MeshFormat::Glb || format == v1::MeshFormat::Obj)
        for (const v1::MeshObject &object : objects.all)
            say_means(*object.mesh, frame.out, terminal);
    const Exit exit = write_objects(objects, command, frame.out, format, name, terminal);
    if (exit == done && command.solid.json)
        terminal.put(
            frame_json(frame,
                       (command.parts ? json_of(objects.parts) : json_of(objects.whole)).dump()) +
            "\n");
    return exit;
}

Exit run_one(const MeshCommand &command, Terminal &terminal) {
    const v1::MeshFormat format =
        v1::mesh_format(command.out).value_or(v1::MeshFormat::Stl); // a stream has no suffix
    if (const Exit exit = refused(command, format, terminal); exit != done) return exit;
    return make_frames(command.solid, command.out, terminal, [&](const SolidFrame &frame) {
        return make(command, format, frame, terminal);
    });
}

} // namespace

// The exit status is the largest of the scenes'; what is wrong with one keeps no other from its file.
Exit run(const MeshCommand &command, Terminal &terminal) {
    std::map<std::string, std::string> outs;
    for (const std::string &file : command.files) {
        const auto [at, fresh] = outs.emplace(out_of(command, file), file);
        if (fresh) continue;
        terminal.say(fmt::format("fathom: -o {}: `{}` and `{}` would both be `{}`; `{{}}` in it "
                                 "stands for a scene's name",
                                 command.out, at->second, file, at->first));
        return usage_error;
    }
    Exit worst = done;
    for (const std::string &file : command.files) {
        MeshCommand one = command;
        one.solid.scene.file = file;
        one.solid.several = command.files.size() > 1;
        one.out = out_of(command, file);
        if (v1::mesh_format(one.out) == v1::MeshFormat::Glb) one.solid.unsaid = "m";
        worst = std::max(worst, run_one(one, terminal));
        if (terminal.reader_gone()) break;
    }
    return worst;
}

} // namespace fathom::cli
