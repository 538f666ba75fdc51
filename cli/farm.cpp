// fathom farm: a film or a large picture as units of work, in a folder of its own, for an engine that
// runs them (Slurm, GNU parallel); how far they are; and what they made, joined. No process of it has
// to live on: all state is in the folder.
#include "cli/delivery.h"
#include "cli/job.h"
#include "cli/option_rows.h"
#include "system/system.h"

#include <fathom/files.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fmt/format.h>
#include <sys/wait.h>

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

constexpr double unit_seconds = 60; // what a unit takes at least, by the probe

Exit refuse(Terminal &terminal, Exit exit, const std::string &why) {
    terminal.say("fathom: " + why);
    return exit;
}

// The command of a unit, or of some frames of it, in the job's folder or, with `root`, from anywhere.
RenderCommand command_of(const RenderCommand &render, const Job &job, const fs::path &root,
                         const std::vector<int> &frames, int tile) {
    RenderCommand command = render;
    command.scene.file = (root / "scene" / fs::path(render.scene.file).filename()).string();
    for (std::size_t i = 0; i < command.scene.include_folders.size(); ++i)
        command.scene.include_folders[i] = root / fmt::format("include{}", i);
    command.out = (root / tile_name(job, tile)).string();
    if (!job.single) command.only = {words_of_frames(frames), frames};
    if (job.tiles > 1) command.tile = {tile, job.tiles};
    command.skip_existing = true;
    return command;
}

std::string own_program() {
    std::error_code error;
    const fs::path program = fs::read_symlink(system::own_program(), error);
    return error ? "fathom" : program.string();
}

// A unit as a line for a shell. FATHOM in the environment names another program.
std::string line_of(const RenderCommand &command) {
    std::string line =
        fmt::format("${{FATHOM:-{}}} render {}", quoted(own_program()), quoted(command.scene.file));
    const auto add = [&](const std::string &word) { line += " " + quoted(word); };
    for (const Definition &value : command.scene.overrides)
        add("-D"), add(value.name + "=" + value.text);
    for (const fs::path &folder : command.scene.include_folders) add("-I"), add(folder.string());
    for (const std::string &limit : command.scene.limit_words) add("--limit"), add(limit);
    if (command.scene.strict_proof) add("--strict-proof");
    for (const std::string &word : words_of_pictures(command)) add(word);
    if (!command.only.numbers.empty()) add("--only"), add(command.only.word);
    if (command.tile)
        add("--tile"), add(fmt::format("{}/{}", command.tile->first, command.tile->second));
    return line + " --skip-existing --progress json -o " + quoted(command.out);
}

// Copies the scene and all that it reads into the folder.
std::string copy_scene(const v1::CompileResult &result, const SceneArguments &scene,
                       const fs::path &folder) {
    std::error_code error;
    for (std::size_t i = 0; i < scene.include_folders.size() && !error; ++i)
        fs::create_directories(folder / fmt::format("include{}", i), error);
    for (const SceneFile &file : files_of(result, scene)) {
        const fs::path to =
            folder / (file.include ? fmt::format("include{}", *file.include) : "scene") / file.name;
        if (!error) fs::create_directories(to.parent_path(), error);
        if (!error) fs::copy_file(file.path, to, fs::copy_options::overwrite_existing, error);
    }
    return error ? error.message() : "";
}

double seconds_of(const std::function<void()> &work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Makes the first, the middle and the last frame, or one tile of the middle one, which are kept, and
// chooses how many frames a unit has.
Exit probe(const RenderCommand &render, Job &job, Terminal &terminal) {
    const std::size_t n = job.frames.size();
    std::vector<int> frames{job.frames[n / 2]};
    if (job.tiles == 1 && n > 2)
        frames = {job.frames.front(), job.frames[n / 2], job.frames.back()};
    const int tile = job.tiles / 2;
    Exit exit = done;
    const double seconds = seconds_of(
        [&] { exit = run(command_of(render, job, job.folder, frames, tile), terminal); });
    if (exit != done) return exit;
    const double each = std::max(seconds / static_cast<double>(frames.size()), 1e-3);
    // As many units as have unit_seconds each, of equal length but for the last.
    const auto frames_in = static_cast<double>(n);
    const double units = std::clamp(std::floor(frames_in * each / unit_seconds), 1.0, frames_in);
    job.chunk = static_cast<int>(std::ceil(frames_in / units));
    terminal.say(fmt::format("fathom: a {} takes {:.2f} s by a probe of {}: {} a unit",
                             job.tiles > 1 ? "tile" : "frame", each, frames.size(), job.chunk));
    return done;
}

std::string batch_script(const Job &job, const char *name, const std::string &line) {
    return fmt::format("#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --cpus-per-task={}\n"
                       "#SBATCH --output={}\n#SBATCH --open-mode=append\n"
                       "#SBATCH --requeue\n{}\n",
                       name, job.threads, quoted(job.folder.string() + "/logs/slurm-%j"), line);
}

std::string write_script(const fs::path &file, std::string_view text) {
    std::string error = v1::write_file(file, text);
    std::error_code mode;
    fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                    fs::perm_options::add, mode);
    return error.empty() && mode ? mode.message() : error;
}

std::string write_folder(const RenderCommand &render, const Job &job) {
    std::string lines;
    for (std::size_t i = 0; i < unit_count(job); ++i) {
        const Unit unit = unit_of(job, i);
        lines += line_of(command_of(render, job, "", unit.frames, unit.tile)) + "\n";
    }
    const std::string folder = quoted(job.folder.string());
    std::string error = v1::write_file(job.folder / "units", lines);
    if (error.empty()) error = write_script(job.folder / "run", run_script());
    if (error.empty() && job.engine == Engine::Slurm)
        error = write_script(
            job.folder / "array.sbatch",
            batch_script(job, "fathom-units",
                         "exec " + folder + "/run $((FATHOM_FIRST + SLURM_ARRAY_TASK_ID))"));
    if (error.empty() && job.engine == Engine::Slurm)
        error = write_script(job.folder / "join.sbatch",
                             batch_script(job, "fathom-join",
                                          fmt::format("exec ${{FATHOM:-{}}} farm collect {}",
                                                      quoted(own_program()), folder)));
    // Last: a folder with a manifest is whole.
    if (error.empty()) error = v1::write_file(job.folder / "manifest.json", manifest_of(job));
    return error;
}

// The units that are neither done nor at work nor failed for good.
std::vector<std::size_t> missing_units(const Job &job) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < unit_count(job); ++i)
        if (report_of(job, i).state == UnitState::Missing) numbers.push_back(i);
    return numbers;
}

std::string engine_words(const Job &job) {
    std::string words;
    for (const std::string &option : job.options) words += " " + quoted(option);
    return words;
}

// Runs a line by the shell; its status, or 128 and the signal that ended it.
int shell(const std::string &line) {
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool is_there(const char *program) {
    return shell(fmt::format("command -v {} >/dev/null 2>&1", program)) == 0;
}

// The first line that a command prints, or nothing where it fails.
std::optional<std::string> first_line(const std::string &line) {
    FILE *pipe = ::popen(line.c_str(), "r");
    if (!pipe) return std::nullopt;
    std::string text;
    for (int c = 0; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    if (::pclose(pipe) != 0) return std::nullopt;
    return text.substr(0, text.find('\n'));
}

// Slurm's arrays have numbers below MaxArraySize, 1001 unless its site says more: units go in blocks.
constexpr std::size_t block = 1000;

std::vector<std::string> slurm_lines(const Job &job, const std::vector<std::size_t> &units) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < units.size();) {
        const std::size_t first = units[i] / block * block;
        std::string numbers;
        while (i < units.size() && units[i] / block * block == first) {
            std::size_t end = i + 1;
            while (end < units.size() && units[end] == units[end - 1] + 1 &&
                   units[end] < first + block)
                ++end;
            numbers += numbers.empty() ? "" : ",";
            numbers += end - i > 1 ? fmt::format("{}-{}", units[i] - first, units[end - 1] - first)
                                   : fmt::format("{}", units[i] - first);
            i = end;
        }
        lines.push_back(fmt::format(
            "sbatch --parsable --export=ALL,FATHOM_FIRST={} --array={}{} {}", first, numbers,
            engine_words(job), quoted((job.folder / "array.sbatch").string())));
    }
    return lines;
}

std::string slurm_join(const Job &job, const std::vector<std::string> &jobs) {
    std::string after;
    for (const std::string &id : jobs) after += ":" + id;
    return fmt::format("sbatch --parsable --dependency=afterany{}{} {}", after, engine_words(job),
                       quoted((job.folder / "join.sbatch").string()));
}

std::string parallel_line(const Job &job, bool wait) {
    return fmt::format("{}parallel --will-cite -q -a {}{} {}", wait ? "FATHOM_FARM_WAIT=1 " : "",
                       quoted((job.folder / "state" / "list").string()), engine_words(job),
                       quoted((job.folder / "run").string()));
}

// How often units were submitted: what never begins is not submitted for ever.
constexpr int most_rounds = 20;

Exit count_round(const Job &job, Terminal &terminal) {
    const fs::path file = job.folder / "state" / "rounds";
    std::string error;
    const std::string rounds = v1::read_file(file, 1 << 20, error).value_or("");
    if (std::ranges::count(rounds, '\n') >= most_rounds)
        return refuse(terminal, device_error,
                      fmt::format("the units were submitted {} times; see {}. Without {} they are "
                                  "submitted again",
                                  most_rounds, (job.folder / "logs").string(), file.string()));
    error = v1::write_file(file, rounds + "round\n");
    return error.empty() ? done : refuse(terminal, device_error, "cannot write: " + error);
}

Exit submit_slurm(const Job &job, const std::vector<std::size_t> &units, Terminal &terminal) {
    if (!is_there("sbatch"))
        return refuse(terminal, device_error, "there is no sbatch here: Slurm is not installed");
    if (const Exit exit = count_round(job, terminal); exit != done) return exit;
    std::vector<std::string> jobs;
    for (const std::string &line : slurm_lines(job, units)) {
        const std::optional<std::string> id = first_line(line);
        if (!id) return refuse(terminal, device_error, "sbatch took no units: " + line);
        jobs.push_back(id->substr(0, id->find(';')));
    }
    const std::optional<std::string> join = first_line(slurm_join(job, jobs));
    if (!join) return refuse(terminal, device_error, "sbatch took no job that joins the units");
    terminal.put(fmt::format("{} units are submitted, in {} arrays; job {} joins them\n",
                             units.size(), jobs.size(), *join));
    return done;
}

// Runs the units until all are done, or a round made none of them. In the first round units that
// another controller has at work are left to it; later ones wait for them.
Exit run_parallel(const Job &job, Terminal &terminal) {
    if (!is_there("parallel"))
        return refuse(terminal, device_error,
                      "there is no GNU parallel here (Debian's package `parallel`)");
    constexpr int idle_rounds = 3;
    std::size_t before = unit_count(job) + 1;
    int idle = 0;
    for (bool wait = false; idle < idle_rounds; wait = true) {
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < unit_count(job); ++i) {
            const UnitState state = report_of(job, i).state;
            if (state == UnitState::Missing || state == UnitState::AtWork) open.push_back(i);
        }
        if (open.empty()) break;
        idle = open.size() < before ? 0 : idle + 1;
        before = open.size();
        std::string list;
        for (const std::size_t unit : open) list += fmt::format("{}\n", unit);
        const std::string error = v1::write_file(job.folder / "state" / "list", list);
        if (!error.empty())
            return refuse(terminal, device_error, "cannot write the list: " + error);
        // How far the units are is read from their files; but who ends the engine means it.
        const int status = shell(parallel_line(job, wait));
        if (status == 255 || status == 128 + SIGINT || status == 128 + SIGTERM)
            return refuse(terminal, device_error, fmt::format("parallel ended with {}", status));
    }
    return done;
}

Exit start(const Job &job, Terminal &terminal) {
    const std::vector<std::size_t> units = missing_units(job);
    switch (job.engine) {
    case Engine::Slurm: return units.empty() ? done : submit_slurm(job, units, terminal);
    case Engine::Parallel: return run_parallel(job, terminal);
    }
    return done;
}

// Prints how far the units are. Whether all are done.
bool tell(const Job &job, Terminal &terminal) {
    std::size_t whole = 0, at_work = 0, failed = 0;
    std::string words;
    for (std::size_t i = 0; i < unit_count(job); ++i) {
        const UnitReport report = report_of(job, i);
        const Unit unit = unit_of(job, i);
        switch (report.state) {
        case UnitState::Done: ++whole; continue;
        case UnitState::AtWork: ++at_work; break;
        case UnitState::Failed: ++failed; break;
        case UnitState::Missing: break;
        }
        const char *state = report.state == UnitState::AtWork   ? "at work"
                            : report.state == UnitState::Failed ? "failed"
                                                                : "missing";
        words += fmt::format("unit {}: {}, {}{}{}\n", i, state,
                             job.single ? "the picture" : "frames " + words_of_frames(unit.frames),
                             job.tiles > 1 ? fmt::format(", tile {}", unit.tile) : "",
                             report.status ? fmt::format(", status {}, logs/{}", *report.status, i)
                                           : "");
    }
    terminal.put(fmt::format("{} of {} units are done, {} at work, {} failed, {} missing\n{}",
                             whole, unit_count(job), at_work, failed,
                             unit_count(job) - whole - at_work - failed, words));
    return whole == unit_count(job);
}

// Joins what the units made: tiles to frames, frames to the film.
Exit join(const Job &job, Terminal &terminal) {
    for (const int frame : job.frames) {
        MergeCommand merge;
        merge.out = (job.folder / name_of(job, picture_name(job), frame)).string();
        if (job.tiles == 1 || note_of_file(merge.out) == note_of_picture(job, frame)) continue;
        for (int tile = 0; tile < job.tiles; ++tile)
            merge.parts.push_back(
                (job.folder / name_of(job, tile_name(job, tile), frame)).string());
        if (const Exit exit = run(merge, terminal); exit != done) return exit;
    }
    if (job.film.empty()) return done;
    MergeCommand film;
    film.parts = {(job.folder / picture_name(job)).string()};
    film.frames = {words_of_frames(job.frames), job.frames};
    film.frame_rate = job.frame_rate;
    film.out = (job.folder / job.film).string();
    return run(film, terminal);
}

Exit collect(const Job &job, Terminal &terminal) {
    if (!missing_units(job).empty())
        if (const Exit exit = start(job, terminal); exit != done) return exit;
    if (!tell(job, terminal))
        return job.engine == Engine::Slurm && !missing_units(job).empty() ? done : device_error;
    const Exit exit = join(job, terminal);
    if (exit == done)
        terminal.put(fmt::format("all is in {}\n",
                                 (job.folder / (job.film.empty() ? "frames" : job.film)).string()));
    return exit;
}

// Why a folder cannot hold a job: its name has what the engine reads as its own. Empty: it can.
std::string refused_folder(const fs::path &folder, Engine engine) {
    const std::string name = folder.string(), special = engine == Engine::Slurm ? "%'\"\\" : "{}";
    for (const char c : name)
        if (special.find(c) != special.npos || static_cast<unsigned char>(c) < ' ')
            return fmt::format(
                "{} reads some characters of `{}` as its own: a job folder's path is "
                "without {} and line breaks",
                engine == Engine::Slurm ? "Slurm" : "GNU parallel", name,
                engine == Engine::Slurm ? "% ' \" \\" : "{ }");
    return "";
}

// The job folder of a scene, whole. The probe's frames are in it.
Exit make(const FarmCommand &command, Job &job, Terminal &terminal) {
    std::error_code error;
    job.folder = fs::absolute(command.folder, error);
    if (fs::exists(job.folder / "manifest.json", error))
        return refuse(terminal, usage_error,
                      fmt::format("`{0}` holds a job: `fathom farm collect {0}` goes on with it",
                                  command.folder));
    RenderCommand render = command.render;
    if (render.backend == Backend::Auto) render.backend = Backend::Cpu; // the same on every machine
    render.jobs = std::max(render.jobs, 1);
    job.engine = command.action == "slurm" ? Engine::Slurm : Engine::Parallel;
    if (const std::string why = refused_folder(job.folder, job.engine); !why.empty())
        return refuse(terminal, usage_error, why);
    job.options = command.options;
    job.frames = frames_of_film(render);
    job.single = render.frames.numbers.empty() && render.turntable == 0;
    job.tiles = command.tiles;
    job.chunk = std::max(command.chunk, 1);
    job.threads = render.jobs;
    job.width = render.width;
    job.height = render.height;
    job.samples = render.samples;
    job.frame_rate = render.frame_rate;
    job.film = command.film;
    if (job.tiles > job.height)
        return refuse(terminal, usage_error,
                      fmt::format("--tiles {}: a tile has a row at least, and the picture has {}",
                                  job.tiles, job.height));
    if (!job.film.empty())
        if (const std::string why = refused_film(job.film, job.width, job.height); !why.empty())
            return refuse(terminal, device_error, why);
    const v1::CompileResult result = v1::compile_file(
        render.scene.file, library_options(render.scene, moment_of(render, job.frames.front()).time,
                                           latest_time(render, job.frames)));
    if (const Exit exit = report(result, terminal); exit != done) return exit;
    std::string why;
    job.identity =
        identity_of_film(result, render, render.backend == Backend::Gl ? "gl" : "cpu", why);
    for (const char *name : {"frames", "parts", "state", "logs", "scene"})
        if (why.empty() && !fs::is_directory(job.folder / name, error) &&
            !fs::create_directories(job.folder / name, error))
            why = error.message();
    if (why.empty()) job.folder = fs::canonical(job.folder, error);
    if (why.empty()) why = copy_scene(result, render.scene, job.folder);
    if (!why.empty())
        return refuse(terminal, device_error,
                      fmt::format("cannot make the job folder `{}`: {}", command.folder, why));
    if (command.chunk == 0)
        if (const Exit exit = probe(render, job, terminal); exit != done) return exit;
    why = write_folder(render, job);
    return why.empty() ? done
                       : refuse(terminal, device_error,
                                fmt::format("cannot write into `{}`: {}", command.folder, why));
}

Exit print_units(const Job &job, Terminal &terminal) {
    std::string error;
    terminal.put(fmt::format("# {} units, each run in {}\n", unit_count(job), job.folder.string()));
    terminal.put(v1::read_file(job.folder / "units", 1 << 30, error).value_or(""));
    terminal.put("# what would start them\n");
    if (job.engine == Engine::Parallel) {
        terminal.put(parallel_line(job, false) + "\n");
        return done;
    }
    for (const std::string &line : slurm_lines(job, missing_units(job))) terminal.put(line + "\n");
    terminal.put(slurm_join(job, {"ID"}) + "\n");
    return done;
}

} // namespace

Exit run(const FarmCommand &command, Terminal &terminal) {
    Job job;
    std::string error;
    if (command.action == "status" || command.action == "collect") {
        std::optional<Job> found = read_job(command.render.scene.file, error);
        if (!found)
            return refuse(
                terminal, device_error,
                fmt::format("`{}` is no job folder: {}", command.render.scene.file, error));
        if (command.action == "collect") return collect(*found, terminal);
        tell(*found, terminal);
        return done;
    }
    if (const Exit exit = make(command, job, terminal); exit != done) return exit;
    if (command.dry_run) return print_units(job, terminal);
    if (const Exit exit = start(job, terminal); exit != done) return exit;
    return job.engine == Engine::Slurm ? done : collect(job, terminal);
}

} // namespace fathom::cli
