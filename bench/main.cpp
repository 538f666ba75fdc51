// fathom-bench: prints the table of measures. What falls short of what the project aims at is
// marked "!". With names of groups as arguments, only those.
#include "bench/measure.h"

#include <algorithm>
#include <cstdio>

int main(int argc, char **argv) {
    using namespace fathom::bench;
    struct Group {
        const char *name;
        void (*measure)(Table &);
    };
    constexpr Group groups[] = {{"process", measure_process},
                                {"front-end", measure_front_end},
                                {"reload", measure_reload},
                                {"shader", measure_shader},
                                {"by-hand", measure_hand_written},
                                {"many", measure_instances},
                                {"steps", measure_steps},
                                {"noise-cache", measure_noise_cache},
                                {"interpreter", measure_interpreter},
                                {"pruning", measure_pruning}};
    const std::vector<std::string> wanted(argv + 1, argv + argc);
    for (const std::string &name : wanted)
        if (std::none_of(std::begin(groups), std::end(groups),
                         [&](const Group &group) { return group.name == name; })) {
            std::fprintf(
                stderr,
                "fathom-bench: no group `%s`; there are process, front-end, reload, shader, "
                "by-hand, many, steps, noise-cache, interpreter, pruning\n",
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
