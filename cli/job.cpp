#include "cli/job.h"

#include "cli/film.h"
#include "cli/words.h"

#include <fathom/files.h>

#include <algorithm>
#include <fcntl.h>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <sys/file.h>
#include <unistd.h>

namespace fathom::cli {

// Made at build time (cmake/embed.cmake): ("run_unit.sh", its text).
const std::vector<std::pair<std::string_view, std::string_view>> &farm_scripts();
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int most_tries = 20;

// Whether a process has the lock of a unit.
bool is_locked(const fs::path &file) {
    const int lock = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (lock < 0) return false;
    const bool locked = ::flock(lock, LOCK_SH | LOCK_NB) != 0;
    ::close(lock);
    return locked;
}

// What a manifest says, in the ranges of the options that `farm` takes: it may come from anywhere.
struct JobReader {
    const Json &json;
    std::string wrong = ""; // the first entry that is none

    double number(const char *name, double least, double most) {
        const double value = json.at(name).get<double>();
        if (!(value >= least && value <= most)) refuse(name);
        return value;
    }
    int whole(const char *name, int least, int most) {
        return static_cast<int>(std::clamp<double>(number(name, least, most), least, most));
    }
    std::string text(const char *name) { return json.at(name).get<std::string>(); }
    void refuse(const char *name) {
        if (wrong.empty()) wrong = name;
    }
};

} // namespace

std::size_t unit_count(const Job &job) {
    const auto chunk = static_cast<std::size_t>(job.chunk);
    return (job.frames.size() + chunk - 1) / chunk * static_cast<std::size_t>(job.tiles);
}

Unit unit_of(const Job &job, std::size_t number) {
    const auto tiles = static_cast<std::size_t>(job.tiles),
               chunk = static_cast<std::size_t>(job.chunk), first = number / tiles * chunk;
    Unit unit;
    unit.tile = static_cast<int>(number % tiles);
    for (std::size_t i = first; i < std::min(first + chunk, job.frames.size()); ++i)
        unit.frames.push_back(job.frames[i]);
    return unit;
}

std::string picture_name(const Job &job) {
    return job.single ? "frames/picture.png" : "frames/frame_####.png";
}

std::string tile_name(const Job &job, int tile) {
    if (job.tiles == 1) return picture_name(job);
    return fmt::format("parts/tile{}{}.png", tile, job.single ? "" : "_####");
}

std::string name_of(const Job &job, const std::string &name, int frame) {
    return job.single ? name : frame_name(name, frame);
}

Note note_of_picture(const Job &job, int frame) {
    Note note;
    note.film = job.identity;
    if (!job.single) note.frame = frame;
    note.width = job.width;
    note.height = job.height;
    note.region = {0, 0, job.width, job.height};
    set_samples(note, job.samples);
    return note;
}

Note note_of_tile(const Job &job, int frame, int tile) {
    Note note = note_of_picture(job, frame);
    const int first = tile_row(job.height, tile, job.tiles);
    note.region[1] = first;
    note.region[3] = tile_row(job.height, tile + 1, job.tiles) - first;
    return note;
}

std::string manifest_of(const Job &job) {
    const Json json{{"fathom", FATHOM_VERSION},
                    {"engine", job.engine == Engine::Slurm ? "slurm" : "parallel"},
                    {"options", job.options},
                    {"identity", job.identity},
                    {"units", unit_count(job)},
                    {"frames", words_of_frames(job.frames)},
                    {"single", job.single},
                    {"tiles", job.tiles},
                    {"chunk", job.chunk},
                    {"threads", job.threads},
                    {"size", fmt::format("{}x{}", job.width, job.height)},
                    {"samples", job.samples},
                    {"fps", job.frame_rate},
                    {"film", job.film}};
    return json.dump(1) + "\n";
}

std::optional<Job> read_job(const fs::path &folder, std::string &error) {
    const std::optional<std::string> text =
        v1::read_file(folder / "manifest.json", 256 << 20, error);
    if (!text) return std::nullopt;
    try {
        const Json json = Json::parse(*text);
        std::error_code none;
        JobReader read{json};
        Job job;
        job.folder = fs::canonical(folder, none);
        job.engine = json.at("engine") == "slurm" ? Engine::Slurm : Engine::Parallel;
        job.options = json.at("options").get<std::vector<std::string>>();
        job.identity = read.text("identity");
        FrameList frames;
        if (!read_frames(read.text("frames"), frames).empty()) read.refuse("frames");
        job.frames = std::move(frames.numbers);
        job.single = json.at("single").get<bool>();
        if (!read_pair(read.text("size"), job.width, job.height).empty()) read.refuse("size");
        job.tiles = read.whole("tiles", 1, std::max(job.height, 1));
        job.chunk = read.whole("chunk", 1, std::numeric_limits<int>::max());
        job.threads = read.whole("threads", 1, 1024);
        job.samples = read.whole("samples", 0, 256);
        job.frame_rate = read.number("fps", 0.001, 1000);
        job.film = read.text("film");
        if (!job.film.empty() && (!is_film(job.film) || job.film.find('/') != job.film.npos))
            read.refuse("film");
        if (read.wrong.empty()) return job;
        error = fmt::format("`{}` of manifest.json is none that `fathom farm` writes", read.wrong);
    } catch (const Json::exception &wrong) {
        error = fmt::format("manifest.json is none: {}", wrong.what());
    }
    return std::nullopt;
}

UnitReport report_of(const Job &job, std::size_t number) {
    const Unit unit = unit_of(job, number);
    const std::string name = tile_name(job, unit.tile);
    UnitReport report;
    const fs::path state = job.folder / "state" / fmt::format("{}", number);
    std::string error;
    std::istringstream lines(v1::read_file(state, 1 << 20, error).value_or(""));
    for (std::string word; lines >> word;) {
        if (word == "begin") ++report.tries;
        int status = 0;
        if (word == "end" && lines >> status) report.status = status;
    }
    const bool whole = std::ranges::all_of(unit.frames, [&](int frame) {
        return note_of_file((job.folder / name_of(job, name, frame)).string()) ==
               note_of_tile(job, frame, unit.tile);
    });
    if (whole)
        report.state = UnitState::Done;
    else if (is_locked(state.string() + ".lock"))
        report.state = UnitState::AtWork;
    else if (report.status == scene_error || report.status == usage_error ||
             report.tries >= most_tries)
        report.state = UnitState::Failed;
    return report;
}

std::string quoted(const std::string &word) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,#";
    if (!word.empty() && word[0] != '#' && word.find_first_not_of(plain) == word.npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

std::string_view run_script() { return farm_scripts().front().second; }

} // namespace fathom::cli
