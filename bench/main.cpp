// fathom-bench: prints the table of measures. What falls short of what the project aims at is
// marked "!". With names of groups as arguments, only those. `figures SCENE` measures the noise
// cache of one scene instead, `meshes` certificates, `frames` what a card takes.
#include "bench/measure.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

int figures(int argc, char **argv) {
    fathom::bench::FigureOptions options;
    std::vector<int> size;
    int cells = 0;
    CLI::App app("what the thesis measured of its noise cache, of one scene",
                 "fathom-bench figures");
    app.add_option("SCENE", options.scene)->required();
    app.add_option("--figure", options.figure,
                   "one alone: 8.2 ages and 8.3, 8.4 difference, 8.5 edits, 8.6 turning")
        ->check(CLI::IsMember({"8.2", "8.3", "8.4", "8.5", "8.6"}));
    app.add_option("--frames", options.frames, "of each measure")->check(CLI::Range(1, 1000));
    app.add_option("--cells", cells, "of the noise cache along an axis")
        ->check(CLI::IsMember({4, 8, 16, 32, 64, 128}));
    app.add_option("--size", size, "WIDTHxHEIGHT, 400x400 unless said")
        ->delimiter('x')
        ->expected(2);
    CLI11_PARSE(app, argc, argv);
    if (cells > 0) options.cache_bits = static_cast<int>(std::log2(cells));
    if (size.size() == 2) options.width = size[0], options.height = size[1];
    return measure_figures(options);
}

int meshes(int argc, char **argv) {
    fathom::bench::MeshFigureOptions options;
    CLI::App app("what is proved of scenes' meshes, and what that costs", "fathom-bench meshes");
    app.add_option("FILE", options.files)->required();
    app.add_option("--resolution", options.resolution, "cells along the longest side, 96")
        ->check(CLI::Range(1, 8000));
    app.add_option("--threads", options.threads, "0: as many as the machine has cores");
    app.add_option("--bounds", options.bounds, "X,Y,Z,X,Y,Z, of scenes without an end")
        ->delimiter(',')
        ->expected(6);
    CLI11_PARSE(app, argc, argv);
    return measure_meshes(options);
}

int frames(int argc, char **argv) {
    fathom::bench::FrameOptions options;
    std::vector<int> size;
    CLI::App app("what a driver takes to link scenes, and a card to draw them",
                 "fathom-bench frames");
    app.add_option("FILE", options.files, "all examples unless said");
    app.add_option("--size", size, "WIDTHxHEIGHT, 1280x720 unless said")
        ->delimiter('x')
        ->expected(2);
    app.add_option("--frames", options.frames, "whose median is told")->check(CLI::Range(1, 1000));
    CLI11_PARSE(app, argc, argv);
    if (size.size() == 2) options.width = size[0], options.height = size[1];
    return measure_frames(options);
}

} // namespace

int main(int argc, char **argv) {
    using namespace fathom::bench;
    if (argc > 1 && argv[1] == std::string("figures")) return figures(argc - 1, argv + 1);
    if (argc > 1 && argv[1] == std::string("meshes")) return meshes(argc - 1, argv + 1);
    if (argc > 1 && argv[1] == std::string("frames")) return frames(argc - 1, argv + 1);
    struct Group {
        const char *name;
        void (*measure)(Table &);
    };
    constexpr Group groups[] = {
        {"process", measure_process},         {"front-end", measure_front_end},
        {"reload", measure_reload},           {"shader", measure_shader},
        {"by-hand", measure_hand_written},    {"many", measure_instances},
        {"growth", measure_growth},           {"steps", measure_steps},
        {"noise-cache", measure_noise_cache}, {"interpreter", measure_interpreter},
        {"pruning", measure_pruning}};
    const std::vector<std::string> wanted(argv + 1, argv + argc);
    for (const std::string &name : wanted)
        if (std::none_of(std::begin(groups), std::end(groups),
                         [&](const Group &group) { return group.name == name; })) {
            std::fprintf(
                stderr,
                "fathom-bench: no group `%s`; there are process, front-end, reload, shader, "
                "by-hand, many, growth, steps, noise-cache, interpreter, pruning\n",
                name.c_str());
            return 2;
        }
    std::printf("%s\n\n", machine().c_str());
    Table table;
    for (const Group &group : groups)
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), group.name) != wanted.end())
            group.measure(table);
    print(table);
    return 0;
}
