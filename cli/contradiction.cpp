#include "cli/contradiction.h"

#include "cli/film.h"
#include "cli/outputs.h"
#include "cli/painter.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

const char *const watches_nothing = "--watch follows a file, and standard input is none";

std::string of(const CheckCommand &check, const Given &) {
    const auto streams = std::ranges::count(check.files, "-");
    if (check.watch && check.files.size() > 1) return "--watch follows one file";
    if (check.watch && streams > 0) return watches_nothing;
    if (streams > 1) return "standard input can be read once";
    if (check.json && check.explain)
        return "--explain is for people, --json for programs: give one of them";
    return "";
}

std::string of(const CompileCommand &compile, const Given &) {
    if (compile.watch && compile.scene.file == "-") return watches_nothing;
    const v1::ShaderTarget target = target_named(compile.target);
    if (compile.field_only && !target.field_target.empty())
        return fmt::format("--field-only leaves out the picture that a page shows; `--target {} "
                           "--field-only` writes the text that a page of your own can use",
                           target.field_target);
    const auto to_file = [](const std::string &out) { return !out.empty() && out != "-"; };
    if (!compile.reflect.empty() &&
        (compile.reflect == compile.out || (!to_file(compile.reflect) && !to_file(compile.out))))
        return "--reflect and -o want a place each: `--reflect OUT.json` names a file";
    if (!compile.noise_cache) return "";
    if (!target.noise_cache || compile.field_only)
        return fmt::format("--noise-cache is for whole pictures by `--target {}`",
                           targets_with(&v1::ShaderTarget::noise_cache));
    if (compile.out.empty() || compile.out == "-")
        return "--noise-cache writes several files: name the first by -o";
    return "";
}

// What only a film has, given where there is none.
std::string of_no_film(const RenderCommand &render, const Given &given) {
    if (!render.frames.numbers.empty() || render.turntable > 0) return "";
    if (is_film(render.out)) return "a film has frames: --frames A..B or --turntable N says which";
    if (given("--fps") && render.shutter == 0)
        return "--fps is for --frames: one picture has no rate";
    if (!render.sweeps.empty()) return "--sweep is for --frames: -D sets a param of one picture";
    if (!render.only.numbers.empty()) return "--only is for --frames, of which it takes some";
    if (render.sheet.first > 0) return "--contact-sheet is for --frames, of which it shows some";
    return "";
}

std::string of_moving(const RenderCommand &render) {
    if (render.shutter > 0 && render.samples <= 1 && render.first_sample == 0 &&
        !render.part_of_samples)
        return "--shutter spreads the samples of a pixel over its opening: --samples 16 gives it "
               "some";
    if (render.turntable > 0 && render.shutter > 0)
        return "--turntable stops the time, which --shutter blurs: give one of them";
    return "";
}

std::string of_parts(const RenderCommand &render) {
    if (render.tile && render.region)
        return "--tile and --region both say a part: give one of them";
    const bool sums = is_sums_name(render.out);
    if (render.part_of_samples && !sums)
        return "--samples A..B makes a part of a picture, which is a file of sums: -o OUT.sums";
    const bool cpu = needs_cpu(render);
    if (render.backend == Backend::Gl && cpu)
        return "--tile, --region, --shutter, --alpha and .sums are for the CPU, which gives the "
               "same bits for any division: --backend cpu";
    if (render.cache && (render.backend == Backend::Cpu || cpu))
        return "--cache needs GL, which --backend cpu leaves out, and so do --tile, --region, "
               "--shutter, --alpha and .sums";
    return "";
}

// What a film's file, a sheet or a stream cannot take.
std::string of_outputs(const RenderCommand &render, const Given &given) {
    const bool film = is_film(render.out), sheet = render.sheet.first > 0,
               stream = render.out == "-",
               part = render.tile || render.region || is_sums_name(render.out);
    if (film && sheet) return "--contact-sheet makes one picture, and -o names a film";
    if (film && (part || !render.only.numbers.empty()))
        return "a film holds whole frames, all of them: write parts as frames, -o frame_####.png, "
               "and join them by `fathom merge`";
    if (sheet && (part || !render.only.numbers.empty()))
        return "--contact-sheet chooses the frames itself, and shows whole ones";
    if (given("--stream") && !stream) return "--stream is for standard output: -o -";
    const std::optional<PictureFormat> format = picture_format(render.out);
    if (render.alpha && (film || sheet || is_sums_name(render.out) ||
                         render.stream != StreamFormat::Png || format == PictureFormat::Jpeg))
        return "--alpha is of PNG and EXR pictures: the other outputs have no transparent pixels";
    if (sheet && format == PictureFormat::Exr)
        return "--contact-sheet makes a PNG or a JPEG, which hold what a screen shows";
    if (render.skip_existing &&
        (film || sheet || stream || (format && format != PictureFormat::Png)))
        return "--skip-existing is for PNG and .sums files, which say of what they are";
    if (given("--quality") && format != PictureFormat::Jpeg)
        return "--quality is of a JPEG: -o OUT.jpg writes one";
    return "";
}

std::string of(const RenderCommand &render, const Given &given) {
    for (const std::string &why : {of_no_film(render, given), of_moving(render), of_parts(render),
                                   of_outputs(render, given)})
        if (!why.empty()) return why;
    return "";
}

std::string of(const MergeCommand &merge, const Given &given) {
    const bool film = !merge.frames.numbers.empty();
    if (film && merge.parts.size() != 1)
        return "--frames wants one name of frames, with `#`s for the number: 'frame_####.png'";
    if (given("--fps") && !film) return "--fps is for --frames: one picture has no rate";
    if (given("--samples") && film) return "--samples is of a picture, and --frames joins a film";
    if (picture_format(merge.out) == PictureFormat::Exr)
        return "parts are joined to a PNG or a JPEG; `fathom render` writes an EXR whole";
    if (given("--quality") && picture_format(merge.out) != PictureFormat::Jpeg)
        return "--quality is of a JPEG: -o OUT.jpg writes one";
    return "";
}

std::string of(const FarmCommand &farm, const Given &given) {
    if (farm.action == "status" || farm.action == "collect") {
        for (const char *option : {"--out", "--frames", "--turntable", "--tiles", "--chunk",
                                   "--film", "--size", "--samples", "--dry-run"})
            if (given(option))
                return fmt::format("`fathom farm {}` reads the job folder, and takes no {}",
                                   farm.action, option);
        return "";
    }
    if (farm.folder.empty()) return "a job folder is made: --out DIR says where";
    if (farm.render.scene.file == "-")
        return "a farm's scene is a file, and standard input is none";
    if (farm.render.part_of_samples)
        return "a farm divides by frames and --tiles: --samples is one number";
    if (!farm.film.empty() && (!is_film(farm.film) || farm.film.find('/') != farm.film.npos))
        return "--film is a name in the job folder that ends in .mp4, .webm, .gif or .apng";
    const bool frames = !farm.render.frames.numbers.empty() || farm.render.turntable > 0;
    if (!farm.film.empty() && !frames)
        return "a film has frames: --frames A..B or --turntable N says which";
    if (!farm.film.empty() && farm.render.alpha)
        return "a film has no transparent pixels: leave out --film, and the frames are PNGs";
    if (farm.tiles > 1 && farm.render.backend == Backend::Gl)
        return "--tiles are for the CPU, which gives the same bits for any division: --backend cpu";
    RenderCommand render = farm.render;
    render.out = farm.tiles > 1 ? "tile.png" : "frame.png";
    return of(render, [&](const char *option) {
        return std::string_view(option) == "--fps" && given(option);
    });
}

std::string of_cells(const Given &given) {
    return given("--tolerance") && given("--resolution")
               ? "--tolerance and --resolution both say how fine the cells are: give one of them"
               : "";
}

// Of the frames of a solid.
std::string of_frames(const SolidArguments &solid, const std::string &out, const Given &given) {
    if (solid.frames.numbers.empty()) {
        if (given("--fps")) return "--fps is for --frames: one file has no rate";
        if (!solid.sweeps.empty()) return "--sweep is for --frames: -D sets a param of one file";
        return "";
    }
    if (out == "-") return "--frames makes files: -o names them, as OUT_####.glb";
    if (solid.scene.file == "-" && !solid.sweeps.empty())
        return "--sweep reads the scene again, and standard input can be read once";
    return "";
}

std::string of(const MeshCommand &mesh, const Given &given) {
    const auto streams = std::ranges::count(mesh.files, "-");
    if (streams > 1) return "standard input can be read once";
    if (streams > 0 && !mesh.solid.sweeps.empty())
        return "--sweep reads the scene again, and standard input can be read once";
    if (mesh.out == "-" && mesh.files.size() > 1)
        return "standard output takes one mesh: name files, as -o '{}.stl'";
    if (std::string why = of_frames(mesh.solid, mesh.out, given); !why.empty()) return why;
    if (mesh.solid.json && mesh.out == "-")
        return "--json and the mesh cannot both go to standard output: name a file by -o";
    if (mesh.parts && !mesh.solid.part.empty())
        return "--part writes one part alone, --parts all of them: give one of them";
    return of_cells(given);
}

std::string of(const MeasureCommand &measure, const Given &given) {
    if (!measure.solid.part.empty() && (measure.parts || !measure.between.empty()))
        return "--part measures one part alone, --parts and --between several: give one of them";
    return of_cells(given);
}

std::string of(const SliceCommand &slice, const Given &given) {
    if (std::string why = of_frames(slice.solid, slice.out, given); !why.empty()) return why;
    if (!slice.solid.frames.numbers.empty() && slice.heights.size() > 1)
        return "--frames takes one height: a file has one number";
    if (given("--x") + given("--y") + given("--z") > 1)
        return "slices lie across one axis: give one of --x, --y and --z, as --z 0..10:0.2";
    if (slice.axis == 0 && slice.solid.scene.file == "-")
        return "flat shapes are read twice, and standard input can be read once: name the scene";
    if (slice.solid.json && slice.out == "-")
        return "--json and the slice cannot both go to standard output: name a file by -o";
    if (given("--size") && suffix_of(slice.out) != ".png")
        return "--size is of a PNG: -o OUT.png writes one";
    return of_cells(given);
}

std::string of(const VolumeCommand &volume, const Given &given) {
    if (std::string why = of_frames(volume.solid, volume.out, given); !why.empty()) return why;
    if (given("--voxel") && given("--resolution"))
        return "--voxel and --resolution both say how fine a volume is: give one of them";
    if (given("--band") && suffix_of(volume.out) != ".vdb")
        return "--band is of a .vdb: .nrrd and .npy hold all voxels";
    if (volume.solid.fields.size() > 1 && suffix_of(volume.out) != ".vdb")
        return "several fields are of a .vdb: .nrrd and .npy hold one";
    for (const char *option : {"--band", "--certify", "--part"})
        if (given("--field") && given(option))
            return fmt::format("{} is of distances, and --field writes others", option);
    if (volume.solid.json && volume.out == "-")
        return "--json and the volume cannot both go to standard output: name a file by -o";
    return "";
}

std::string of(const EvalCommand &eval, const Given &) {
    if (eval.coordinates.size() % 3 != 0)
        return fmt::format("points are three numbers each, and these are {}",
                           eval.coordinates.size());
    if (eval.at.empty() && eval.coordinates.empty() && !eval.points)
        return "eval wants points: X Y Z, --at X,Y,Z or --points -";
    if (eval.points && eval.scene.file == "-")
        return "the scene and the points cannot both come from standard input";
    return "";
}

std::string of(const ViewCommand &, const Given &) { return ""; }
std::string of(const ImportCommand &, const Given &) { return ""; }
std::string of(const ExportCommand &, const Given &) { return ""; }
std::string of(const FmtCommand &fmt, const Given &) {
    return fmt.check && fmt.diff ? "--check names files, --diff prints changes: give one of them"
                                 : "";
}
std::string of(const DocCommand &doc, const Given &) {
    if (doc.json && !doc.search.empty()) return "--json gives all, or NAME: leave out --search";
    return !doc.name.empty() && !doc.search.empty() ? "--search lists names: leave out NAME" : "";
}
std::string of(const ExplainCommand &, const Given &) { return ""; }
std::string of(const LspCommand &, const Given &) { return ""; }
std::string of(const BenchCommand &bench, const Given &) {
    return bench.json && !bench.compare.empty()
               ? "--compare is for people, --json for programs: give one of them"
               : "";
}

} // namespace

std::string contradiction(const Command &command, const Given &given) {
    return std::visit([&](const auto &one) { return of(one, given); }, command);
}

} // namespace fathom::cli
