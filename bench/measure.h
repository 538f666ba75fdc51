// How fathom-bench measures, and what a row of its table is. A file of rows defines `void
// measure_…(Table &)` and main calls it. Rates are ratios of two things timed in the same run, as
// near to each other as can be; what has a goal of its own (a time, a size) is held against that.
// Numbers without a goal are for the eye.
#pragma once

#include "driver/compile.h"

#include <functional>
#include <string>
#include <vector>

namespace fathom::bench {

struct Row {
    std::string what{};     // "100-sphere smooth union"
    double value = 0;       // of us, in `unit`
    std::string unit{};     // "M points/s"
    std::string baseline{}; // what it is compared with; empty: nothing
    double baseline_value = 0;
    double minimum = 0; // of the ratio, or of the value where there is no baseline: the least that
                        // will do; 0: none
    double maximum = 0; // or the most
    std::string missing{}; // why there is no value
};
using Table = std::vector<Row>;

// Times `run`, which does `amount` of work, and `other` in turn for about half a second; the best
// rates of both.
struct Rates {
    double first = 0, second = 0;
};
Rates rates(double amount, const std::function<void()> &run, double other_amount,
            const std::function<void()> &other);
double rate(double amount, const std::function<void()> &run);

double seconds(const std::function<void()> &run); // once
double processor_seconds(); // of this process so far: what others take meanwhile does not count
double seconds_now();       // of a steady clock
double median(std::vector<double> values);

void print(const Table &table);
std::string machine(); // processor, cores, compiler

// bench/scenes/NAME, compiled; where that fails, nothing, and a row that says so.
struct PhaseTimes {
    double check = 0, prove = 0, lower = 0; // milliseconds of processor
    double all() const { return check + prove + lower; }
};
std::string text_of(const std::string &path); // what the file says
std::string scene_path(const std::string &name);
driver::Compilation compiled(const std::string &name, PhaseTimes *times = nullptr);
driver::Compilation compiled_text(const std::string &name, std::string text,
                                  PhaseTimes *times = nullptr);
std::string
complaint(const driver::Compilation &compilation); // its first error in words, or an empty text

void measure_interpreter(Table &table);  // interpreter.cpp
void measure_process(Table &table);      // process.cpp
void measure_pruning(Table &table);      // pruning.cpp
void measure_front_end(Table &table);    // front_end.cpp
void measure_instances(Table &table);    // many.cpp
void measure_growth(Table &table);       // growth.cpp
void measure_reload(Table &table);       // reload.cpp
void measure_shader(Table &table);       // shader.cpp
void measure_hand_written(Table &table); // hand_written.cpp
void measure_steps(Table &table);        // steps.cpp
void measure_noise_cache(Table &table);  // noise_cache.cpp

// `fathom-bench figures`: the thesis's measures of the noise cache, of one scene.
struct FigureOptions {
    std::string scene;
    int width = 400, height = 400;
    std::string figure; // "8.2" to "8.6", which is measured alone; empty: all
    int frames = 0;     // of each measure; 0: as many as take about three minutes in all
    int cache_bits = 0; // 2^bits cells an axis; 0: 64, and 128 where a view needs more
};
int measure_figures(const FigureOptions &options); // prints; returns the exit status

// `fathom-bench meshes`: what the certificates of scenes say, and what they cost.
struct MeshFigureOptions {
    std::vector<std::string> files;
    int resolution = 96;
    unsigned threads = 0;       // 0: as many as the machine has cores
    std::vector<double> bounds; // X,Y,Z,X,Y,Z, of scenes without an end
};
int measure_meshes(const MeshFigureOptions &options); // prints; returns the exit status

// `fathom-bench frames`: what scenes' shaders take of the driver, and a frame of the card.
struct FrameOptions {
    std::vector<std::string> files; // none: all examples
    int width = 1280, height = 720, frames = 3;
};
int measure_frames(const FrameOptions &options); // prints; returns the exit status

} // namespace fathom::bench
