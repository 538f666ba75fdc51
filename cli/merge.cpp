// fathom merge: joins parts of a picture (tiles, ranges of samples) into the picture that one process
// would have made, to the byte; or frames into a film. What is missing is named, and nothing is
// written then.
#include "base/picture.h"
#include "cli/delivery.h"
#include "cli/interrupt.h"
#include "cli/progress.h"

#include <fathom/files.h>

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace fathom::cli {
namespace {

// A part of one picture, as it was read.
struct Part {
    std::string file;
    Note note;
    Picture picture; // of a tile
    Sums sums;       // of a range of samples; `values` is empty for a tile
};

std::optional<std::string> bytes_of(const std::string &file, Terminal &terminal) {
    std::string error;
    std::optional<std::string> bytes =
        v1::read_file(file, std::numeric_limits<std::size_t>::max() / 4, error);
    if (!bytes) terminal.say(fmt::format("fathom: cannot read `{}`: {}", file, error));
    return bytes;
}

Exit refuse(Terminal &terminal, const std::string &why) {
    terminal.say("fathom: " + why);
    return device_error;
}

// A part, whole; or the reason.
std::optional<Part> read_part(const std::string &file, Terminal &terminal) {
    const std::optional<std::string> bytes = bytes_of(file, terminal);
    if (!bytes) return std::nullopt;
    Part part;
    part.file = file;
    if (is_sums(*bytes)) {
        if (std::optional<Sums> sums = read_sums(*bytes)) {
            part.note = sums->note;
            part.sums = std::move(*sums);
            return part;
        }
        refuse(terminal, fmt::format("`{}` is not whole: render it again", file));
        return std::nullopt;
    }
    const std::optional<std::string> text = note_of_png(*bytes);
    if (!text) {
        refuse(terminal,
               fmt::format("`{}` is not a whole PNG or .sums file: render it again", file));
        return std::nullopt;
    }
    const std::optional<Note> note = note_of(*text);
    std::optional<Picture> picture = note ? decode_png(*bytes) : std::nullopt;
    if (!picture || picture->width != note->region[2] || picture->height != note->region[3]) {
        refuse(terminal, fmt::format("`{}` is no part that `fathom render` made", file));
        return std::nullopt;
    }
    part.note = *note;
    part.picture = std::move(*picture);
    return part;
}

bool is_sums_part(const Part &part) { return !part.sums.values.empty(); }

// Why two parts are not of one picture; empty where they are.
std::string differs(const Part &a, const Part &b) {
    if (is_sums_part(a) != is_sums_part(b))
        return "one is finished pixels, the other sums of samples";
    if (a.note.film != b.note.film) return "they are of different scenes, options or programs";
    if (a.note.frame != b.note.frame) return "they are of different frames";
    if (a.note.width != b.note.width || a.note.height != b.note.height)
        return "they are of pictures of different sizes";
    if (!is_sums_part(a) &&
        (a.note.rough != b.note.rough || block_of(a.note).samples != block_of(b.note).samples))
        return "their pixels have different numbers of samples";
    return "";
}

// Whether the parts are of one picture, without overlapping; says what is wrong.
bool belong_together(const std::vector<Part> &parts, Terminal &terminal) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (const std::string why = differs(parts.front(), parts[i]); !why.empty()) {
            refuse(terminal, fmt::format("`{}` and `{}` cannot be joined: {}", parts.front().file,
                                         parts[i].file, why));
            return false;
        }
        for (std::size_t k = 0; k < i; ++k)
            if (overlap(block_of(parts[k].note), block_of(parts[i].note))) {
                refuse(terminal,
                       fmt::format("`{}` and `{}` overlap: both have part of {}", parts[k].file,
                                   parts[i].file, words_of(block_of(parts[i].note))));
                return false;
            }
    }
    return true;
}

// The note of the whole picture, where no part is missing; else says which.
std::optional<Note> whole_of(const std::vector<Part> &parts, int samples, Terminal &terminal) {
    Note whole = parts.front().note;
    whole.region = {0, 0, whole.width, whole.height};
    whole.first_sample = 0;
    std::vector<Block> blocks;
    whole.samples = samples;
    for (const Part &part : parts) {
        blocks.push_back(block_of(part.note));
        if (samples == 0)
            whole.samples = std::max(whole.samples, part.note.first_sample + part.note.samples);
        else if (part.note.first_sample + part.note.samples > samples) {
            refuse(terminal, fmt::format("`{}` has samples {}..{}, and --samples says {}",
                                         part.file, part.note.first_sample,
                                         part.note.first_sample + part.note.samples, samples));
            return std::nullopt;
        }
    }
    const std::vector<Block> lacking = missing(block_of(whole), blocks);
    if (lacking.empty()) return whole;
    constexpr std::size_t most = 20;
    std::string words;
    for (std::size_t i = 0; i < std::min(lacking.size(), most); ++i)
        words += "\n  " + words_of(lacking[i]);
    if (lacking.size() > most) words += fmt::format("\n  and {} more", lacking.size() - most);
    terminal.say_text("fathom: the picture is not whole; missing are" + words);
    return std::nullopt;
}

v1::Picture joined(const std::vector<Part> &parts, const Note &whole) {
    const auto width = static_cast<std::size_t>(whole.width),
               pixels = width * static_cast<std::size_t>(whole.height);
    const bool are_sums = is_sums_part(parts.front());
    std::vector<double> sums(are_sums ? 3 * pixels : 0);
    v1::Picture picture;
    picture.width = whole.width;
    picture.height = whole.height;
    picture.rgba.resize(are_sums ? 0 : 4 * pixels);
    for (const Part &part : parts) {
        const Block block = block_of(part.note);
        const auto columns = static_cast<std::size_t>(block.width);
        for (std::size_t row = 0; row < static_cast<std::size_t>(block.height); ++row) {
            const std::size_t to = (static_cast<std::size_t>(block.y) + row) * width +
                                   static_cast<std::size_t>(block.x),
                              from = row * columns;
            if (is_sums_part(part))
                for (std::size_t i = 0; i < 3 * columns; ++i)
                    sums[3 * to + i] += part.sums.values[3 * from + i];
            else
                std::copy_n(part.picture.rgba.begin() + static_cast<std::ptrdiff_t>(4 * from),
                            4 * columns,
                            picture.rgba.begin() + static_cast<std::ptrdiff_t>(4 * to));
        }
    }
    return are_sums ? v1::picture_of_sums(whole.width, whole.height, sums, whole.samples) : picture;
}

Exit merge_picture(const MergeCommand &command, Terminal &terminal) {
    std::vector<Part> parts;
    std::uint64_t undecided = 0;
    for (const std::string &file : command.parts) {
        std::optional<Part> part = read_part(file, terminal);
        if (!part) return device_error;
        undecided += part->sums.undecided + part->sums.undecided_shadows;
        parts.push_back(std::move(*part));
    }
    if (!belong_together(parts, terminal)) return device_error;
    const std::optional<Note> whole = whole_of(parts, command.samples, terminal);
    if (!whole) return device_error;
    if (undecided > 0)
        terminal.say(
            fmt::format("fathom: {}: {} rays of its parts stay undecided", command.out, undecided));
    return write_result(
        command.out, encoded(joined(parts, *whole), command.out, command.quality, text_of(*whole)),
        terminal);
}

// Whether every frame is there, whole and of one film; says which are not.
bool is_complete(const MergeCommand &command, Terminal &terminal) {
    std::vector<int> lacking;
    std::string film;
    for (const int frame : command.frames.numbers) {
        const std::string file = frame_name(command.parts.front(), frame);
        const std::optional<Note> note = note_of_file(file);
        if (!note || note->frame != frame ||
            Block{0, 0, note->width, note->height, 0, note->samples} != block_of(*note)) {
            lacking.push_back(frame);
            continue;
        }
        if (film.empty()) film = note->film;
        if (note->film != film) {
            refuse(terminal, fmt::format("`{}` is of another scene, options or program than the "
                                         "frames before it",
                                         file));
            return false;
        }
    }
    if (lacking.empty()) return true;
    refuse(terminal, fmt::format("the film is not whole; missing are the frames {}",
                                 words_of_frames(lacking)));
    return false;
}

Exit merge_film(const MergeCommand &command, Terminal &terminal) {
    if (!is_complete(command, terminal)) return device_error;
    std::unique_ptr<Film> film;
    Progress progress(ProgressFormat::Bar, command.frames.numbers.size(), terminal);
    int width = 0, height = 0;
    for (const int frame : command.frames.numbers) {
        const std::string file = frame_name(command.parts.front(), frame);
        const std::optional<std::string> bytes = bytes_of(file, terminal);
        const std::optional<Picture> picture = bytes ? decode_png(*bytes) : std::nullopt;
        if (!picture) return refuse(terminal, fmt::format("`{}` is no picture any more", file));
        std::string error;
        if (!film) {
            width = picture->width;
            height = picture->height;
            if (error = refused_film(command.out, width, height); !error.empty())
                return refuse(terminal, error);
            film = Film::open(command.out, width, height, command.frame_rate, error);
        }
        if (picture->width != width || picture->height != height)
            return refuse(terminal,
                          fmt::format("`{}` has another size than the first frame", file));
        if (film) error = film->add(picture->rgba);
        if (!error.empty())
            return refuse(terminal, fmt::format("cannot write `{}`: {}", command.out, error));
        progress.finished(frame, file, false);
        progress.share(command.out, 0);
    }
    const std::string error = film->finish();
    terminal.finish_progress();
    return error.empty()
               ? done
               : refuse(terminal, fmt::format("cannot write `{}`: {}", command.out, error));
}

} // namespace

Exit run(const MergeCommand &command, Terminal &terminal) {
    end_by_term();
    const bool film = !command.frames.numbers.empty();
    if (misnamed(command.out, film ? Content::Film : Content::Picture, terminal))
        return usage_error;
    if (unwritable(command.out, terminal)) return device_error;
    if (!film)
        for (const std::string &file : command.parts)
            if (overwrites(file, command.out, terminal)) return usage_error;
    return film ? merge_film(command, terminal) : merge_picture(command, terminal);
}

} // namespace fathom::cli
