// fathom render: pictures without a window, by GL or by the CPU: one, the frames of a film, or a part
// of these. Every picture is whole before its file appears.
#include "cli/delivery.h"
#include "cli/interrupt.h"
#include "cli/painter.h"
#include "cli/progress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <sys/statvfs.h>

namespace fathom::cli {
namespace {

// Says that rays went through surfaces without an inside. A few graze something by chance.
void say_passed(const v1::Picture &painted, const std::string &out, Terminal &terminal) {
    if (painted.passed == 0 || painted.passed * 2000 < painted.rays) return;
    terminal.say(fmt::format(
        "fathom: {}: {} of {} rays pass a surface that has no inside, or one too thin for single "
        "precision from there (the field is 0, and above 0 on both sides): it is not drawn. A cut "
        "that ends in the plane of what it cuts should reach a little farther; a sheet needs a "
        "thickness, as `shell` and `- 0.01` give it",
        out, painted.passed, painted.rays));
}

// Says what was left undecided. Whether that is an error.
bool is_undecided(const v1::Picture &painted, const std::string &out, const RenderCommand &command,
                  Terminal &terminal) {
    if (painted.undecided + painted.undecided_shadows == 0) return false;
    std::string what;
    if (painted.undecided > 0)
        what = fmt::format("{} of {} rays stay undecided and show what they are nearest to",
                           painted.undecided, painted.rays);
    if (painted.undecided_shadows > 0)
        what += fmt::format("{}{} shadow rays stay undecided and darken by what they met so far",
                            what.empty() ? "" : "; ", painted.undecided_shadows);
    terminal.say(fmt::format("fathom: {}: {}; --max-steps N gives them more steps{}{}", out, what,
                             command.backend == Backend::Gl
                                 ? ", and --backend cpu has no limit on the turns of loops"
                                 : "",
                             command.strict ? ". Nothing is written (--strict)" : ""));
    return command.strict;
}

// What is drawn of the picture; nothing, with the reason, where that is not in it.
std::optional<v1::Region> region_of(const RenderCommand &command, Terminal &terminal) {
    if (command.tile) {
        const auto [i, n] = *command.tile;
        const int first = tile_row(command.height, i, n);
        if (n <= command.height)
            return v1::Region{0, first, command.width, tile_row(command.height, i + 1, n) - first};
        terminal.say(fmt::format("fathom: --tile {}/{}: a tile has a row at least, and the picture "
                                 "has {}",
                                 i, n, command.height));
        return std::nullopt;
    }
    if (!command.region) return v1::Region{0, 0, command.width, command.height};
    const auto [x, y, width, height] = *command.region;
    if (x + width <= command.width && y + height <= command.height)
        return v1::Region{x, y, width, height};
    terminal.say(fmt::format("fathom: --region {},{},{},{} is not within the picture of {}x{}", x,
                             y, width, height, command.width, command.height));
    return std::nullopt;
}

// A number of bytes, as people read it.
std::string in_bytes(double bytes) {
    constexpr std::array<const char *, 5> units = {"bytes", "kB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    for (; unit + 1 < units.size() && bytes >= 999.5; ++unit) bytes /= 1000;
    return fmt::format("{:.3g} {}", std::floor(bytes * 100) / 100, units[unit]);
}

// Room for the files is estimated: sums as they are, pictures at a fifth of three bytes a pixel,
// which most pictures of the gallery do not reach. False, with both numbers, where there is less.
bool has_room(const Delivery &delivery, const RenderCommand &command, const v1::Region &region,
              std::size_t files, Terminal &terminal) {
    if (!delivery.has_files()) return true;
    std::filesystem::path folder = std::filesystem::path(command.out).parent_path();
    struct statvfs disk {};
    if (::statvfs(folder.empty() ? "." : folder.c_str(), &disk) != 0) return true;
    if (disk.f_blocks == 0) return true; // as `/proc`, which takes no files: the write says so
    const double pixels = static_cast<double>(region.width) * region.height,
                 wanted = static_cast<double>(files) * pixels * (delivery.wants_sums() ? 24 : 0.6),
                 free = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
    if (wanted <= free) return true;
    const std::string what = files == 1 ? "a file" : fmt::format("{} files", files);
    terminal.say(fmt::format("fathom: {} of {}x{} {} about {}, and {} is free", what, region.width,
                             region.height, files == 1 ? "takes" : "take", in_bytes(wanted),
                             in_bytes(free)));
    return false;
}

// What one command makes, and the scene as it is compiled for it.
struct Work {
    const RenderCommand &command;
    Terminal &terminal;
    std::vector<int> film, frames; // all; those that are made
    v1::Region region;
    Delivery delivery;
    v1::GlPainter gl;
    v1::CompileResult compiled;
    std::string identity; // of the film
};

// The scene at one frame, where params are swept, or at all of them. What is proved is proved for
// the whole film then, whichever of its frames are made.
Exit compile(Work &work, const std::vector<int> &frames) {
    const RenderCommand &command = work.command;
    const double first = moment_of(command, frames.front()).time,
                 last = latest_time(command, frames);
    v1::CompileOptions options = library_options(command.scene, first, last);
    options.cells = cells_of_pictures;
    options.section = command.section;
    if (!command.sweeps.empty())
        for (const Definition &value : swept(command, frames.front()))
            options.definitions[value.name] = value.text;
    work.compiled = v1::compile_file(command.scene.file, options);
    // What is no error was said of the first frame.
    const bool again = !work.identity.empty() && work.compiled;
    const Exit exit = again ? done : report(work.compiled, work.terminal);
    if (exit != done) return exit;
    if (!in_proved_time(work.compiled.scene->facts(), first, last, work.terminal))
        return usage_error;
    return use(work.gl, work.compiled, command, work.terminal);
}

Note note_of(const Work &work, int frame) {
    const RenderCommand &command = work.command;
    Note note;
    note.film = work.identity;
    if (!command.frames.numbers.empty() || command.turntable > 0) note.frame = frame;
    note.width = command.width;
    note.height = command.height;
    note.region = {work.region.x, work.region.y, work.region.width, work.region.height};
    note.first_sample = command.first_sample;
    set_samples(note, samples_of(command));
    return note;
}

[[noreturn]] void obey_interrupt(Terminal &terminal) {
    terminal.finish_progress();
    terminal.flush();
    Interrupts::obey();
}

Exit make_frame(Work &work, int frame, const Note &note, Progress &progress) {
    const RenderCommand &command = work.command;
    Terminal &terminal = work.terminal;
    const std::string out = work.delivery.file_of(frame);
    if (!command.sweeps.empty() && frame != work.frames.front())
        if (const Exit exit = compile(work, {frame}); exit != done) return exit;
    v1::Picture made = paint(
        work.gl, *work.compiled.scene, command, work.region, work.delivery.wants_sums(),
        moment_of(command, frame), [&](double share) { progress.share(out, share); }, terminal);
    if (Interrupts::noticed()) obey_interrupt(terminal); // nothing of this picture is written
    if (!made.complete) {
        terminal.say(made.remark.empty()
                         ? fmt::format("fathom: there is no memory for a picture of {}x{}",
                                       command.width, command.height)
                         : fmt::format("fathom: {}: {}", out, made.remark));
        return device_error;
    }
    // `--cached` is answered by what became of it.
    if (!made.remark.empty() &&
        (terminal.interactive() || (command.cache && command.frames.numbers.empty())))
        terminal.say(out + ": " + made.remark);
    say_passed(made, out, terminal);
    if (is_undecided(made, out, command, terminal)) return scene_error;
    return work.delivery.take(frame, note, std::move(made));
}

// What can be refused before the scene is read.
Exit refused_early(const Work &work) {
    const RenderCommand &command = work.command;
    const std::string first = work.delivery.file_of(work.frames.front());
    for (const int frame : command.only.numbers)
        if (!std::ranges::binary_search(work.film, frame)) {
            work.terminal.say(fmt::format("fathom: --only {}: the film has no frame {}",
                                          command.only.word, frame));
            return usage_error;
        }
    if (overwrites(command.scene.file, first, work.terminal) ||
        misnamed(first,
                 is_film(first)        ? Content::Film
                 : is_sums_name(first) ? Content::Sums
                                       : Content::Picture,
                 work.terminal))
        return usage_error;
    if (is_film(first))
        if (const std::string why = refused_film(first, command.width, command.height);
            !why.empty()) {
            work.terminal.say("fathom: " + why);
            return device_error;
        }
    for (const int frame : work.frames) {
        if (unwritable(work.delivery.file_of(frame), work.terminal)) return device_error;
        if (!work.delivery.has_files()) break;
    }
    return has_room(work.delivery, command, work.region, work.frames.size(), work.terminal)
               ? done
               : device_error;
}

} // namespace

Exit run(const RenderCommand &command, Terminal &terminal) {
    end_by_term();
    const std::optional<v1::Region> region = region_of(command, terminal);
    if (!region) return usage_error;
    Work work{command,
              terminal,
              frames_of_film(command),
              frames_to_make(command),
              *region,
              Delivery(command, terminal),
              {},
              {},
              {}};
    Exit exit = refused_early(work);
    if (exit == done) exit = begin(work.gl, command, terminal);
    if (exit == done)
        exit = compile(work, command.sweeps.empty() ? work.film : std::vector{work.frames.front()});
    if (exit != done) return exit;
    for (const int frame : work.frames)
        if (overwrites(work.compiled.files, work.delivery.file_of(frame), terminal))
            return usage_error;
    std::string error;
    work.identity = identity_of_film(work.compiled, command, maker_of(work.gl), error);
    if (!error.empty()) {
        terminal.say("fathom: " + error);
        return device_error;
    }

    const Interrupts interrupts;
    Progress progress(command.progress, work.frames.size(), terminal);
    for (const int frame : work.frames) {
        const std::string out = work.delivery.file_of(frame);
        const Note note = note_of(work, frame);
        const bool kept = command.skip_existing && note_of_file(out) == note;
        if (!kept) exit = make_frame(work, frame, note, progress);
        if (exit != done) return exit;
        progress.finished(frame, out, kept);
        if (terminal.reader_gone()) return done;
    }
    exit = work.delivery.finish();
    terminal.finish_progress();
    return exit;
}

} // namespace fathom::cli
