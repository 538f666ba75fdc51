#include "cli/job.h"

#include "driver/files.h"

#include <algorithm>
#include <fcntl.h>
#include <fmt/format.h>
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
    const int lock = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (lock < 0) return false;
    const bool locked = ::flock(lock, LOCK_SH | LOCK_NB) != 0;
    ::close(lock);
    return locked;
}

std::vector<int> ints_of(const Json &list) {
    std::vector<int> numbers;
    for (const Json &number : list) numbers.push_back(number.get<int>());
    return numbers;
}

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
                    {"frames", job.frames},
                    {"single", job.single},
                    {"tiles", job.tiles},
                    {"chunk", job.chunk},
                    {"threads", job.threads},
                    {"size", {job.width, job.height}},
                    {"samples", job.samples},
                    {"fps", job.frame_rate},
                    {"film", job.film}};
    return json.dump(1) + "\n";
}

std::optional<Job> read_job(const fs::path &folder, std::string &error) {
    const std::optional<std::string> text =
        driver::read_file(folder / "manifest.json", 256 << 20, error);
    if (!text) return std::nullopt;
    try {
        const Json json = Json::parse(*text);
        std::error_code none;
        Job job;
        job.folder = fs::canonical(folder, none);
        job.engine = json.at("engine") == "slurm" ? Engine::Slurm : Engine::Parallel;
        job.options = json.at("options").get<std::vector<std::string>>();
        job.identity = json.at("identity").get<std::string>();
        job.frames = ints_of(json.at("frames"));
        job.single = json.at("single").get<bool>();
        job.tiles = json.at("tiles").get<int>();
        job.chunk = json.at("chunk").get<int>();
        job.threads = json.at("threads").get<int>();
        job.width = json.at("size").at(0).get<int>();
        job.height = json.at("size").at(1).get<int>();
        job.samples = json.at("samples").get<int>();
        job.frame_rate = json.at("fps").get<double>();
        job.film = json.at("film").get<std::string>();
        if (job.tiles >= 1 && job.chunk >= 1 && !job.frames.empty()) return job;
        error = "manifest.json says of no frames or units";
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
    std::istringstream lines(driver::read_file(state, 1 << 20, error).value_or(""));
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
