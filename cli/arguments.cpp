// The command line, read with CLI11, which no other file includes. Long: so that none has to.
#include "base/encode.h"
#include "base/single.h"
#include "base/suggest.h"
#include "base/text.h"
#include "cli/contradiction.h"
#include "cli/help_forms.h"
#include "cli/option_rows.h"
#include "cli/outputs.h"
#include "cli/words.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <sstream>

namespace fathom::cli {
namespace {

constexpr const char *version_text = "fathom " FATHOM_VERSION "\n";

// An option whose words are read by a function that says what is wrong with them.
template <class Read>
CLI::Option *option(CLI::App *app, const std::string &name, Read read, const std::string &help) {
    return app
        ->add_option_function<std::vector<std::string>>(
            name,
            [name, read](const std::vector<std::string> &words) {
                for (const std::string &word : words) {
                    std::string error = read(word);
                    if (!error.empty()) throw CLI::ValidationError(name, error);
                }
            },
            help)
        ->expected(1)
        ->allow_extra_args(false) // the word behind it may be the scene
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

// The help says in words what is allowed, so that CLI11 need not add it in its own.
CLI::Validator quiet(CLI::Validator validator) { return validator.description(""); }

// Some commands read their file more than once, which standard input does not bear.
enum class Read { Once, Again };

void add_scene_options(CLI::App *app, SceneArguments &scene) {
    option(
        app, "-D", [&](const std::string &word) { return read_override(word, scene.overrides); },
        "set a param of the scene")
        ->type_name("NAME=VALUE");
    option(
        app, "--limit",
        [&](const std::string &word) {
            scene.limit_words.push_back(word);
            return set_limit(scene.limits, word);
        },
        "allow more of what a scene may cost, or less (docs/limits.md)")
        ->type_name("NAME=VALUE");
    app->add_option("-I", scene.include_folders, "look here too for imports, images and grids")
        ->type_name("DIR")
        ->check(CLI::Validator(
            [](std::string &word) {
                std::error_code none;
                return std::filesystem::is_directory(word, none)
                           ? std::string()
                           : fmt::format("there is no folder `{}`", word);
            },
            ""))
        ->expected(1)
        ->allow_extra_args(false) // the word behind it may be the scene
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_scene(CLI::App *app, SceneArguments &scene, Read read = Read::Once) {
    app->add_option("FILE", scene.file,
                    read == Read::Once ? "the scene, `-` for standard input" : "the scene")
        ->type_name("")
        ->required();
    add_scene_options(app, scene);
}

void add_strict_proof(CLI::App *app, SceneArguments &scene) {
    app->add_flag("--strict-proof", scene.strict_proof, "refuse what is not proved");
}

void add_proved_scene(CLI::App *app, SceneArguments &scene) {
    add_scene(app, scene);
    add_strict_proof(app, scene);
}

// An empty name is a script's variable that was never set.
CLI::Validator named() {
    return CLI::Validator(
        [](const std::string &word) { return std::string(word.empty() ? "wants a name" : ""); },
        "");
}

CLI::Option *add_out(CLI::App *app, std::string &out, const std::string &help) {
    return app->add_option("-o", out, help)->check(named());
}

void add_size(CLI::App *app, int &width, int &height) {
    option(
        app, "--size", [&](const std::string &word) { return read_pair(word, width, height); },
        fmt::format("size in pixels, {}x{} unless said", width, height))
        ->type_name("WxH");
}

template <class Time> // a double, or one that need not be given
void add_time(CLI::App *app, Time &time, const std::string &help) {
    option(
        app, "--time",
        [&time](const std::string &word) {
            const std::optional<double> number = parse_number(word);
            if (!number || !fits_single(*number))
                return fmt::format("wants seconds, as 2.5, not `{}`", word);
            time = *number;
            return std::string();
        },
        help)
        ->type_name("T");
}

struct Reader {
    CLI::App app{"Fathom: scenes as text, distance fields whose step is proved.", "fathom"};
    Invocation invocation;
    bool version = false;
    CheckCommand check;
    CompileCommand compile;
    RenderCommand render;
    MergeCommand merge;
    FarmCommand farm;
    MeshCommand mesh;
    MeasureCommand measure;
    SliceCommand slice;
    VolumeCommand volume;
    EvalCommand eval;
    ViewCommand view;
    ImportCommand import;
    ExportCommand export_;
    FmtCommand fmt;
    DocCommand doc;
    ExplainCommand explain;
    LspCommand lsp;
    BenchCommand bench;
    std::map<const CLI::Option *, std::vector<std::string>> choices; // the words that it takes
    std::string help_about;
    HelpForm help_form = HelpForm::Text;
    CLI::App *help = nullptr;

    void add_target(CLI::App *sub) {
        std::vector<std::pair<std::string, std::string>> targets;
        std::vector<std::string> names;
        for (const std::string &target : v1::shader_targets()) {
            targets.emplace_back(target, target);
            names.push_back(targets.back().first + (names.empty() ? " (unless said)" : ""));
        }
        choice<std::string>(sub, "--target", compile.target, targets, listed(names))
            ->type_name("TARGET");
    }

    // An option that takes one of a few words.
    template <class T> CLI::Option *choice(CLI::App *to, const std::string &name, T &value,
                                           std::vector<std::pair<std::string, T>> words,
                                           const std::string &what) {
        std::vector<std::string> names;
        for (const auto &[word, meaning] : words) names.push_back(word);
        const auto read = [&value, words, names](const std::string &word) {
            for (const auto &[known, meaning] : words) {
                if (known != word) continue;
                value = meaning;
                return std::string();
            }
            return fmt::format("wants {}, not `{}`", listed(names), word);
        };
        CLI::Option *made = option(to, name, read, what);
        choices[made] = names;
        return made;
    }

    template <class T> CLI::App *command(const char *name, const char *what, T &value) {
        CLI::App *sub = app.add_subcommand(name, what);
        sub->callback([this, &value] { invocation.command = value; });
        return sub;
    }

    Reader() {
        app.require_subcommand(0, 1);
        app.fallthrough();
        app.set_help_flag("-h,--help", "print this");
        app.add_flag("-V,--version", version, "print the version");
        choice<ColorChoice>(&app, "--color", invocation.color,
                            {{"auto", ColorChoice::Auto},
                             {"always", ColorChoice::Always},
                             {"never", ColorChoice::Never}},
                            "colour the words: auto, always or never")
            ->type_name("WHEN");
        app.footer(
            "`fathom help COMMAND` shows a command's options. Exit status: 0 done, 1 the scene has "
            "an error,\n"
            "2 the command line is wrong, 3 a file named on it or the device cannot be used, 4 "
            "ended by SIGTERM.");

        add_view();
        add_check();
        add_compile();
        add_render();
        add_merge();
        add_farm();
        add_mesh();
        add_measure();
        add_slice();
        add_volume();
        add_eval();
        add_import();
        add_export();
        add_fmt();
        add_doc();
        add_explain();
        add_lsp();
        add_bench();
        help = app.add_subcommand("help", "show this, or a command's options");
        help->add_option("COMMAND", help_about, "left out: list the commands")->type_name("");
        choice<HelpForm>(help, "--as", help_form,
                         {{"text", HelpForm::Text},
                          {"man", HelpForm::Man},
                          {"bash", HelpForm::Bash},
                          {"zsh", HelpForm::Zsh},
                          {"fish", HelpForm::Fish}},
                         "all of it as a manual page, or as a shell's completion")
            ->type_name("FORM");
    }

    void add_view() {
        CLI::App *sub = command("view", "open a window that follows the file", view);
        add_scene(sub, view.scene, Read::Again);
        add_size(sub, view.width, view.height);
        sub->add_option("--record", view.record,
                        "save a picture of the window here after every reload")
            ->check(named())
            ->type_name("DIR");
        sub->add_option("--editor", view.editor,
                        "show the text that an editor has, by its socket, as it is typed")
            ->type_name("SOCKET");
        sub->add_flag("--save-view", view.save_view, "write the view into FILE at the end");
        sub->add_flag("--times", view.times, "say of each reload what took how long");
        sub->add_flag("--still", view.still, "begin with the time stopped");
        sub->add_flag("--one-context", view.one_context,
                      "let the graphics driver compile on the window's thread: for drivers that "
                      "cannot share");
    }

    void add_check() {
        CLI::App *sub = command("check", "parse, type and prove scenes", check);
        sub->add_option("FILE", check.files, "the scenes, `-` for standard input")
            ->type_name("")
            ->required();
        add_scene_options(sub, check.scene);
        add_strict_proof(sub, check.scene);
        sub->add_flag("--json", check.json, "one JSON document a scene on standard output");
        sub->add_flag("--explain", check.explain, "show where the bound comes from, as a tree");
        add_time(sub, check.time, "prove that moment alone, with the params as they are");
        sub->add_flag("--watch", check.watch, "check again after every save");
    }

    void add_compile() {
        CLI::App *sub = command("compile", "write the scene's shader, validated", compile);
        add_proved_scene(sub, compile.scene);
        add_out(
            sub, compile.out,
            fmt::format("write here, not to standard output; for {}, large tables to OUT.tables",
                        targets_with(&v1::ShaderTarget::buffers)))
            ->type_name("OUT");
        add_target(sub);
        sub->add_option("--reflect", compile.reflect,
                        "write here as JSON what a host has to bind: uniforms, textures, buffers")
            ->type_name("OUT.json")
            ->check(named());
        sub->add_flag("--field-only", compile.field_only,
                      "the field functions alone, for a renderer of your own");
        sub->add_flag(
            "--noise-cache", compile.noise_cache,
            "read cached fields through the noise cache; its passes are written beside OUT");
        sub->add_flag("--watch", compile.watch, "compile again after every save");
    }

    void add_row(CLI::App *sub, const OptionRow &row) {
        if (row.flag)
            sub->add_flag(row.name, *row.flag, row.help);
        else
            option(sub, row.name, row.read, row.help)->type_name(row.type);
    }

    void add_render() {
        CLI::App *sub = command("render", "make a picture or a film, without a window", render);
        add_proved_scene(sub, render.scene);
        add_out(sub, render.out,
                "a .png, .jpg or .exr, a film (.mp4, .webm, .gif, .apng) or .sums; `-`: standard "
                "output; "
                "`#`s or %04d stand for the frame's number")
            ->type_name("OUT.png")
            ->required();
        for (const auto &rows : {picture_rows(render), film_rows(render), part_rows(render)})
            for (const OptionRow &row : rows) add_row(sub, row);
    }

    void add_merge() {
        CLI::App *sub = command("merge", "join parts of a picture, or frames into a film", merge);
        sub->add_option("PART", merge.parts,
                        "tiles, or .sums files; with --frames, the frames' name with `#`s")
            ->type_name("")
            ->required();
        add_out(sub, merge.out, "the picture or the film, by its suffix")
            ->type_name("OUT.png")
            ->required();
        option(
            sub, "--frames",
            [this](const std::string &word) { return read_frames(word, merge.frames); },
            "join these frames into a film")
            ->type_name("FRAMES");
        add_row(sub, frame_rate_row(merge.frame_rate));
        sub->add_option("--samples", merge.samples,
                        "of the whole picture; up to the last that a part has unless said")
            ->check(quiet(CLI::Range(1, 256)))
            ->type_name("N");
        add_row(sub, quality_row(merge.quality));
    }

    void add_farm() {
        CLI::App *sub = command("farm", "make a film on many machines or workers", farm);
        sub->add_option("ACTION", farm.action,
                        "slurm or parallel: make a job folder and start it; status, collect")
            ->type_name("")
            ->required()
            ->check(quiet(CLI::IsMember({"slurm", "parallel", "status", "collect"})));
        add_proved_scene(sub, farm.render.scene);
        sub->add_option("OPTIONS", farm.options, "behind `--`: options of the engine")
            ->type_name("");
        sub->add_option("--out", farm.folder, "the job folder, which is made")
            ->type_name("DIR")
            ->check(named());
        for (const auto &rows : {picture_rows(farm.render), film_rows(farm.render)})
            for (const OptionRow &row : rows) add_row(sub, row);
        sub->add_option("--film", farm.film, "join the frames into this film, in the job folder")
            ->type_name("NAME")
            ->check(named());
        sub->add_option("--tiles", farm.tiles, "units of one frame, 1 unless said")
            ->check(quiet(CLI::Range(1, 65536)))
            ->type_name("N");
        sub->add_option("--chunk", farm.chunk,
                        "frames of a unit; unless said, as many as take a minute, by a probe")
            ->check(quiet(CLI::Range(1, 1'000'000)))
            ->type_name("N");
        sub->add_flag("--dry-run", farm.dry_run, "make the folder, print the units, start nothing");
    }

    void add_solid(CLI::App *sub, SolidArguments &solid) {
        add_scene(sub, solid.scene);
        add_solid_rows(sub, solid);
    }

    void add_solid_rows(CLI::App *sub, SolidArguments &solid) {
        for (const OptionRow &row : solid_rows(solid)) add_row(sub, row);
    }

    void add_mesh() {
        CLI::App *sub = command("mesh", "write the scene's surface as triangles", mesh);
        add_out(sub, mesh.out,
                "the mesh, by its suffix: .stl, .obj, .ply, .glb or .3mf (`-`: an STL to standard "
                "output); `{}` stands for the scene's name, `#`s or %04d for the frame's number")
            ->type_name("OUT.stl")
            ->required();
        sub->add_option("FILE", mesh.files, "the scenes, `-` for standard input")
            ->type_name("")
            ->required();
        add_scene_options(sub, mesh.solid.scene);
        add_solid_rows(sub, mesh.solid);
        for (const OptionRow &row : solid_film_rows(mesh.solid)) add_row(sub, row);
        add_row(sub, units_row(mesh.solid, "for .3mf (mm unless said) and .glb (m unless said)"));
        add_row(sub, simplify_row(mesh.simplify));
        sub->add_flag("--parts", mesh.parts,
                      "each part of the scene as an object of its own: .glb, .obj and .3mf");
        choice<std::optional<bool>>(sub, "--certify", mesh.certify, {{"on", true}, {"off", false}},
                                    "prove what can be proved of the mesh, and say it: on, or off "
                                    "for speed; unless said on with --json")
            ->type_name("WHETHER");
        sub->add_flag("--json", mesh.solid.json,
                      "what is proved of the mesh: one JSON document on standard output");
    }

    void add_measure() {
        CLI::App *sub = command("measure", "print volume, area, box, mass and clearances", measure);
        add_solid(sub, measure.solid);
        for (const OptionRow &row : measure_rows(measure)) add_row(sub, row);
        add_row(sub, units_row(measure.solid, "to print numbers in it"));
        sub->add_flag("--json", measure.solid.json, "one JSON document on standard output");
    }

    void add_slice() {
        slice.solid.resolution = 512;
        CLI::App *sub = command("slice", "write where planes cut the solid, as contours", slice);
        add_solid(sub, slice.solid);
        for (const OptionRow &row : solid_film_rows(slice.solid)) add_row(sub, row);
        for (const OptionRow &row : slice_rows(slice)) add_row(sub, row);
        add_out(sub, slice.out,
                "a .svg, .dxf or .png (`-`: an SVG to standard output); `#`s or %04d stand for the "
                "slice's number")
            ->type_name("OUT.svg")
            ->required();
        add_size(sub, slice.width, slice.height);
        add_row(sub, units_row(slice.solid, "which .svg and .dxf say"));
        sub->add_flag("--json", slice.solid.json,
                      "say what is proved of each slice: one JSON document on standard output");
    }

    void add_volume() {
        CLI::App *sub = command("volume", "write true distances on a lattice", volume);
        add_scene(sub, volume.solid.scene);
        add_out(sub, volume.out, "a .vdb, .nrrd or .npy (`-`: an NRRD to standard output)")
            ->type_name("OUT.vdb")
            ->required();
        for (const auto &rows : {volume_rows(volume), solid_film_rows(volume.solid)})
            for (const OptionRow &row : rows) add_row(sub, row);
        choice<bool>(sub, "--certify", volume.certify, {{"on", true}, {"off", false}},
                     "prove how far distances are off: on, or off for speed")
            ->type_name("WHETHER");
        sub->add_flag("--json", volume.solid.json,
                      "say where it lies and what is proved: one JSON document on standard output");
    }

    void add_eval() {
        CLI::App *sub = command("eval", "print the field at points: distance gx gy gz", eval);
        add_scene(sub, eval.scene);
        sub->add_option_function<std::vector<std::string>>(
               "X Y Z",
               [this](const std::vector<std::string> &words) {
                   for (const std::string &word : words) {
                       const std::optional<double> number = read_coordinate(word);
                       if (!number)
                           throw CLI::ValidationError(
                               "X Y Z", fmt::format("a coordinate is a number, as 1.5, not "
                                                    "beyond 1e18, not `{}`",
                                                    word));
                       eval.coordinates.push_back(*number);
                   }
               },
               "points, as three numbers each")
            ->type_name("");
        option(
            sub, "--at",
            [this](const std::string &word) { return read_point(word, eval.at.emplace_back()); },
            "a point; may be given again")
            ->type_name("X,Y,Z");
        option(
            sub, "--points",
            [this](const std::string &word) {
                eval.points = true;
                return word == "-"
                           ? ""
                           : fmt::format(
                                 "points are read from standard input: --points -, not `{}`", word);
            },
            "`-`: one `X Y Z` a line on standard input")
            ->type_name("-");
        add_time(sub, eval.time, "seconds");
    }

    void add_import() {
        CLI::App *sub = command("import", "turn a YAML save file into the language", import);
        sub->add_option("IN.yaml", import.file, "the save file, `-` for standard input")
            ->type_name("")
            ->required();
        add_out(sub, import.out, "write here, not to standard output")->type_name("OUT.sdf");
        sub->add_flag("--strict", import.strict, "take nothing that is not understood");
        sub->add_flag("--partial", import.partial,
                      "write what was read of a file whose structure is broken");
    }

    void add_export() {
        CLI::App *sub = command("export", "turn a scene into a YAML save file", export_);
        add_scene(sub, export_.scene);
        add_out(sub, export_.out, "write here, not to standard output")->type_name("OUT.yaml");
    }

    void add_fmt() {
        CLI::App *sub = command("fmt", "format scenes, in place", fmt);
        sub->add_option("FILE", fmt.files, "the scenes; `-`: standard input to standard output")
            ->type_name("")
            ->required();
        sub->add_flag("--check", fmt.check,
                      "change nothing; name the files that are not formatted, and exit with 1");
        sub->add_flag("--diff", fmt.diff,
                      "change nothing; print what would change, and exit with 1 if anything would");
    }

    void add_doc() {
        CLI::App *sub = command("doc", "print the library's entry of a name", doc);
        sub->add_option("NAME", doc.name, "left out: list all names, in groups")->type_name("");
        sub->add_option("--search", doc.search,
                        "list the names whose entry holds this; may be given again")
            ->type_name("WORD")
            ->expected(1)
            ->allow_extra_args(false)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
        sub->add_flag("--json", doc.json,
                      "keywords, types, signs, constants and functions: one JSON document");
    }

    void add_explain() {
        CLI::App *sub = command("explain", "print a diagnostic's page", explain);
        sub->add_option("CODE", explain.code, "left out: list all codes")->type_name("");
    }

    void add_lsp() { command("lsp", "serve an editor over standard input and output", lsp); }

    void add_bench() {
        CLI::App *sub = command("bench", "measure the phases and a frame of a scene", bench);
        add_scene(sub, bench.scene, Read::Again);
        add_size(sub, bench.width, bench.height);
        sub->add_flag("--json", bench.json, "one JSON document on standard output");
        sub->add_flag("--one-bound", bench.one_bound,
                      "each shape by its one bound, without bounds by cells, to compare");
        sub->add_option("--compare", bench.compare,
                        "beside each number the one of an earlier run, which --json wrote")
            ->type_name("OLD.json")
            ->check(named());
    }
};

Answer wrong(const std::string &words) {
    return {usage_error, "", "fathom: " + for_terminal(words)};
}

std::string help_hint(const CLI::App &app) {
    std::vector<CLI::App *> chosen = app.get_subcommands();
    return chosen.empty()
               ? "`fathom help` lists the commands"
               : fmt::format("`fathom help {}` shows its options", chosen.front()->get_name());
}

// What CLI11 says of words that it cannot place: `… not expected: A B`, `Could not convert: NAME = A`.
std::string in_our_words(Reader &reader, const CLI::ParseError &error) {
    const std::string said = error.what();
    const std::size_t colon = said.find(": ");
    const std::string rest = colon == said.npos ? said : said.substr(colon + 2);
    if (dynamic_cast<const CLI::ConversionError *>(&error)) {
        const std::size_t equals = rest.find(" = ");
        if (equals != rest.npos)
            return fmt::format("{}: wants a number, not `{}`", rest.substr(0, equals),
                               rest.substr(equals + 3));
    }
    // Where something is missing, it may be what a misspelt option was to give.
    const bool lacks = dynamic_cast<const CLI::RequiredError *>(&error) != nullptr;
    if (!lacks && !dynamic_cast<const CLI::ExtrasError *>(&error)) return said;
    const std::vector<CLI::App *> chosen = reader.app.get_subcommands();
    CLI::App &app = chosen.empty() ? reader.app : *chosen.front();
    std::vector<std::string> left = reader.app.remaining(true);
    if (left.empty() && !lacks) { // CLI11 lists them from the last
        std::istringstream words(rest);
        for (std::string word; words >> word;) left.insert(left.begin(), word);
    }
    if (left.empty()) return said;
    std::vector<std::string> names;
    for (const CLI::Option *one : app.get_options([](CLI::Option *) { return true; })) {
        for (const std::string &name : one->get_lnames()) names.push_back("--" + name);
        for (const std::string &name : one->get_snames()) names.push_back("-" + name);
    }
    const auto name_of = [](const std::string &word) { return word.substr(0, word.find('=')); };
    const auto unknown = std::ranges::find_if(left, [&](const std::string &word) {
        return word.size() > 1 && word[0] == '-' &&
               std::ranges::find(names, name_of(word)) == names.end();
    });
    if (unknown == left.end() && lacks) return said;
    if (unknown == left.end()) return fmt::format("`{}` is a word too many", left.front());
    const std::string word = name_of(*unknown);
    const std::string near = nearest_name(word, names);
    return fmt::format("there is no option `{}`{}", word,
                       near.empty() ? "" : fmt::format("; did you mean `{}`?", near));
}

// What help knows of an app's options; positional ones have no names.
std::vector<HelpOption> options_of(const Reader &reader, CLI::App &app) {
    std::vector<HelpOption> options;
    for (const CLI::Option *from : app.get_options([](CLI::Option *) { return true; })) {
        HelpOption to;
        for (const std::string &name : from->get_snames()) to.names.push_back("-" + name);
        for (const std::string &name : from->get_lnames()) to.names.push_back("--" + name);
        to.type = to.names.empty() ? from->get_name(true) : from->get_type_name();
        if (from->get_items_expected_max() == 0) to.type.clear();
        to.what = from->get_description();
        if (const auto found = reader.choices.find(from); found != reader.choices.end())
            to.choices = found->second;
        options.push_back(std::move(to));
    }
    return options;
}

HelpTable table_of(Reader &reader) {
    HelpTable table{
        reader.app.get_description(), reader.app.get_footer(), options_of(reader, reader.app), {}};
    for (CLI::App *sub : reader.app.get_subcommands([](CLI::App *) { return true; })) {
        HelpCommand command{sub->get_name(), sub->get_description(), {}};
        for (HelpOption &one : options_of(reader, *sub))
            if (std::ranges::find(one.names, "--help") == one.names.end())
                command.options.push_back(std::move(one)); // it stands among those of everywhere
        table.commands.push_back(std::move(command));
    }
    return table;
}

std::string in_form(const HelpTable &table, HelpForm form) {
    switch (form) {
    case HelpForm::Text: return "";
    case HelpForm::Man: return man_page(table);
    case HelpForm::Bash: return bash_completion(table);
    case HelpForm::Zsh: return zsh_completion(table);
    case HelpForm::Fish: return fish_completion(table);
    }
    return "";
}

std::vector<std::string> command_names(CLI::App &app) {
    std::vector<std::string> names;
    for (const CLI::App *sub : app.get_subcommands([](CLI::App *) { return true; }))
        names.push_back(sub->get_name());
    return names;
}

CLI::App *find_command(CLI::App &app, const std::string &name) {
    std::vector<CLI::App *> found =
        app.get_subcommands([&](CLI::App *sub) { return sub->get_name() == name; });
    return found.empty() ? nullptr : found.front();
}

Answer unknown_command(CLI::App &app, const std::string &word) {
    std::string words = fmt::format("there is no command `{}`", word);
    std::string near = nearest_name(word, command_names(app));
    if (!near.empty())
        words += fmt::format("; did you mean `{}`?", near);
    else if (word.ends_with(".sdf"))
        words += fmt::format("; `fathom view {}` opens it in a window", word);
    else
        words += "; `fathom help` lists them";
    return wrong(words);
}

} // namespace

std::variant<Invocation, Answer> read_arguments(int count, const char *const *arguments) {
    Reader reader;
    CLI::App &app = reader.app;
    if (count > 1 && arguments[1][0] != '-' && !find_command(app, arguments[1]))
        return unknown_command(app, arguments[1]);
    std::vector<std::string> words; // backwards, as CLI11 takes them
    for (int i = count; i-- > 1;) {
        words.emplace_back(arguments[i]);
        if (words.back().starts_with("-.") && parse_number(words.back()))
            words.back().insert(1, "0"); // `-.5` would be taken for an option
    }
    try {
        app.parse(std::move(words));
    } catch (const CLI::CallForHelp &) {
        std::vector<CLI::App *> chosen = app.get_subcommands();
        return Answer{done, chosen.empty() ? app.help() : chosen.front()->help("fathom"), ""};
    } catch (const CLI::ParseError &error) {
        return wrong(fmt::format("{}; {}", in_our_words(reader, error), help_hint(app)));
    }
    if (reader.version) return Answer{done, version_text, ""};
    if (reader.help->parsed()) {
        // CLI11 gives the help of a command that was read, `help` itself here; a fresh reader has
        // read none.
        if (reader.help_form != HelpForm::Text) {
            if (!reader.help_about.empty())
                return wrong("--as has all commands: leave out COMMAND");
            Reader fresh;
            return Answer{done, in_form(table_of(fresh), reader.help_form), ""};
        }
        if (reader.help_about.empty()) return Answer{done, Reader().app.help(), ""};
        const CLI::App *about = find_command(app, reader.help_about);
        if (!about) return unknown_command(app, reader.help_about);
        return Answer{done, about->help("fathom"), ""};
    }
    if (app.get_subcommands().empty()) return Answer{usage_error, "", app.help()};
    const CLI::App &command = *app.get_subcommands().front();
    const std::string why = contradiction(
        reader.invocation.command, [&](const char *option) { return command.count(option) > 0; });
    if (!why.empty()) return wrong(why);
    return reader.invocation;
}

} // namespace fathom::cli
