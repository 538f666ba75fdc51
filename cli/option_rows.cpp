#include "cli/option_rows.h"

#include "base/single.h"
#include "base/text.h"
#include "cli/words.h"

#include <cmath>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

using Reader = std::function<std::string(const std::string &)>;

Reader whole(int &value, int least, int most) {
    return [&value, least, most](const std::string &word) {
        const std::optional<double> number = parse_number(word);
        if (!number || !(*number >= least && *number <= most) || *number != std::floor(*number))
            return fmt::format("wants a whole number from {} to {}, not `{}`", least, most, word);
        value = static_cast<int>(*number);
        return std::string();
    };
}

Reader real(double &value, double least, double most) {
    return [&value, least, most](const std::string &word) {
        const std::optional<double> number = parse_number(word);
        if (!number || !(*number >= least && *number <= most))
            return fmt::format("wants a number from {} to {}, not `{}`", least, most, word);
        value = *number;
        return std::string();
    };
}

template <class T> Reader one_of(T &value, std::vector<std::pair<std::string, T>> words) {
    return [&value, words](const std::string &word) {
        std::string known;
        for (const auto &[name, meaning] : words) {
            if (name == word) {
                value = meaning;
                return std::string();
            }
            const bool last = name == words.back().first;
            known += (known.empty() ? "" : last ? " or " : ", ") + name;
        }
        return fmt::format("wants {}, not `{}`", known, word);
    };
}

const std::vector<std::pair<std::string, Backend>> backends{
    {"auto", Backend::Auto}, {"gl", Backend::Gl}, {"cpu", Backend::Cpu}};

} // namespace

OptionRow frame_rate_row(double &frame_rate) {
    return {"--fps", "N", "frames in a second, 30 unless said", real(frame_rate, 0.001, 1000)};
}

OptionRow quality_row(int &quality) {
    return {"--quality", "N", "of a JPEG, 1 to 100, 90 unless said", whole(quality, 1, 100)};
}

std::vector<OptionRow> picture_rows(RenderCommand &command) {
    return {
        {"--size", "WxH", "size in pixels, 1280x720 unless said",
         [&](const std::string &word) { return read_pair(word, command.width, command.height); }},
        {"--backend", "WHICH", "gl, cpu, or auto: gl where there is a card",
         one_of(command.backend, backends)},
        {"--time", "T", "seconds; with --frames, when frame 0 is",
         [&](const std::string &word) {
             const std::optional<double> number = parse_number(word);
             if (!number || !fits_single(*number))
                 return fmt::format("wants seconds, as 2.5, not `{}`", word);
             command.time = *number;
             return std::string();
         }},
        {"--samples", "N", "rays a pixel, 1 to 256; A..B: these of them alone, to a .sums file",
         [&](const std::string &word) { return read_samples(word, command); }},
        {"--max-steps", "N",
         "evaluations that a ray may take, whatever the scene says; 65536 unless said",
         whole(command.max_steps, 1, 100'000'000)},
        {"--section", "z=A..B",
         "cut the scene open across an axis: keep what lies between; one end may be left out",
         [&](const std::string &word) { return read_section(word, command.section); }},
        {"--alpha",
         "",
         "no background: a PNG or EXR that is transparent there",
         {},
         &command.alpha},
        {"--strict",
         "",
         "no picture, and status 1, where a ray stays undecided",
         {},
         &command.strict},
        {"--jobs", "N", "threads of the CPU, as many as it has cores unless said",
         whole(command.jobs, 1, 1024)}};
}

std::vector<OptionRow> film_rows(RenderCommand &command) {
    return {
        {"--frames", "FRAMES",
         "a film of these frames: A..B leaves B out, A..=B takes it in, :N is a step; lists by "
         "commas",
         [&](const std::string &word) { return read_frames(word, command.frames); }},
        frame_rate_row(command.frame_rate),
        {"--sweep", "NAME=A..B",
         "move a param over the film: A at its first frame, B after its last; A..=B: at its last",
         [&](const std::string &word) { return read_sweep(word, command.sweeps); }},
        {"--turntable", "N", "go around what the camera looks at, in N frames",
         whole(command.turntable, 1, 1'000'000)},
        {"--shutter", "S", "motion blur: open for this share of a frame's length, 0 to 1",
         real(command.shutter, 0, 1)}};
}

std::vector<OptionRow> part_rows(RenderCommand &command) {
    return {{"--only", "FRAMES", "make these frames of the film alone",
             [&](const std::string &word) { return read_frames(word, command.only); }},
            {"--tile", "I/N", "make band I of the picture's rows, of N bands; the first is 0",
             [&](const std::string &word) { return read_tile(word, command.tile); }},
            {"--region", "X,Y,W,H", "make this part of the picture, in pixels",
             [&](const std::string &word) { return read_region(word, command.region); }},
            {"--skip-existing",
             "",
             "keep files that are whole and of this scene and these options",
             {},
             &command.skip_existing},
            {"--contact-sheet", "CxR", "one picture of C times R frames, spread over the film",
             [&](const std::string &word) {
                 return read_pair(word, command.sheet.first, command.sheet.second);
             }},
            {"--stream", "FORMAT", "what `-o -` writes: png, pam, or raw (RGB, 8 bits)",
             one_of<StreamFormat>(command.stream, {{"png", StreamFormat::Png},
                                                   {"pam", StreamFormat::Pam},
                                                   {"raw", StreamFormat::Raw}})},
            {"--progress", "HOW", "bar (on a terminal), or json: a line an event on standard error",
             one_of<ProgressFormat>(
                 command.progress, {{"bar", ProgressFormat::Bar}, {"json", ProgressFormat::Json}})},
            quality_row(command.quality),
            {"--cache",
             "",
             "read cached fields through the noise cache, as a moving view does",
             {},
             &command.cache}};
}

std::vector<std::string> words_of_pictures(const RenderCommand &command) {
    const RenderCommand usual;
    std::vector<std::string> words{"--size", fmt::format("{}x{}", command.width, command.height)};
    const auto add = [&](bool said, const char *name, const std::string &word) {
        if (!said) return;
        words.emplace_back(name);
        words.push_back(word);
    };
    for (const auto &[name, backend] : backends) add(backend == command.backend, "--backend", name);
    add(command.time != usual.time, "--time", format_shortest(command.time));
    add(command.samples != usual.samples, "--samples", fmt::format("{}", command.samples));
    add(command.max_steps != usual.max_steps, "--max-steps", fmt::format("{}", command.max_steps));
    add(command.section.has_value(), "--section",
        command.section ? word_of_section(*command.section) : "");
    if (command.alpha) words.emplace_back("--alpha");
    if (command.strict) words.emplace_back("--strict");
    add(command.jobs != usual.jobs, "--jobs", fmt::format("{}", command.jobs));
    add(!command.frames.numbers.empty(), "--frames", command.frames.word);
    add(command.frame_rate != usual.frame_rate, "--fps", format_shortest(command.frame_rate));
    for (const Sweep &sweep : command.sweeps)
        add(true, "--sweep",
            fmt::format("{}={}..{}{}", sweep.name, format_shortest(sweep.from),
                        sweep.to_last ? "=" : "", format_shortest(sweep.to)));
    add(command.turntable > 0, "--turntable", fmt::format("{}", command.turntable));
    add(command.shutter > 0, "--shutter", format_shortest(command.shutter));
    return words;
}

} // namespace fathom::cli
