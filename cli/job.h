// The job folder of `fathom farm`: all that its units need, and their state, in files alone.
//
//   manifest.json  what is to be made (Job)
//   scene/, includeN/   the scene with all that it reads
//   units          a line each: the command line of a unit, run in the folder
//   run            a script: makes the unit of its number, and tries again where that may help
//   frames/, parts/     the frames; tiles of them
//   state/N, logs/N     begins and ends of unit N; what its processes said
#pragma once

#include "cli/identity.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom::cli {

struct Job {
    std::filesystem::path folder; // absolute
    Engine engine = Engine::Parallel;
    std::vector<std::string> options; // of the engine
    std::string identity;             // of the film (identity_of_film)
    std::vector<int> frames;
    bool single = false; // one picture, which is no frame
    int tiles = 1, chunk = 1, threads = 1;
    int width = 0, height = 0, samples = 1;
    double frame_rate = 30;
    std::string film; // its file; empty: none
};

// What one process makes.
struct Unit {
    std::vector<int> frames;
    int tile = 0;
};
std::size_t unit_count(const Job &job);
Unit unit_of(const Job &job, std::size_t number);

// Relative to the folder, with `#`s for the frame: a tile's pictures, and the whole ones.
std::string tile_name(const Job &job, int tile);
std::string picture_name(const Job &job);
std::string name_of(const Job &job, const std::string &name, int frame);
Note note_of_tile(const Job &job, int frame, int tile); // as the file has to have it
Note note_of_picture(const Job &job, int frame);

std::string manifest_of(const Job &job);
// The job of a folder, or nothing and the reason.
std::optional<Job> read_job(const std::filesystem::path &folder, std::string &error);

// How far a unit is.
enum class UnitState {
    Done,    // its files are there, whole, of this scene and these options
    AtWork,  // a process has its lock
    Failed,  // the scene or the command line is wrong, or it was tried too often
    Missing, // all others
};
struct UnitReport {
    UnitState state = UnitState::Missing;
    int tries = 0;
    std::optional<int> status; // of its last end
};
UnitReport report_of(const Job &job, std::size_t number);

// A word for a shell.
std::string quoted(const std::string &word);

// The text of `run` (run_unit.sh).
std::string_view run_script();

} // namespace fathom::cli
