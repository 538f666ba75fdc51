// Functions of the point as the save format writes them, labelled: a list of steps, each
// `[operation, arguments…]`, where a whole number is the result of an earlier step. The same in the
// language's text. Private to save-format.
#pragma once

#include "ir/passes/walk.h"
#include "ir/scene.h"
#include "save-format/yaml_reader.h"

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace fathom::save {

// What steps name beside earlier steps, as the text calls it.
struct Words {
    std::unordered_map<std::string, std::string> params; // by their names in the file
    std::vector<std::string> caches;                     // in the file's order
    int copies = 0; // repetitions around, whose copies differ: `id_1`, `id_2`, …
};

// What a program is a function of.
enum class Given : std::uint8_t { Point, PointAndNormal, Direction, Nothing };

// `p => …`, of the normal too `(p, n) => …`, of nothing an expression; empty, with the reason,
// where the steps make no sense.
std::string program_text(const Value &steps, const Words &words, std::string &why,
                         Given given = Given::Point);
std::string region_text(const Value &region, const Words &words);
std::string vector_text(const Value &vector); // {X, Y, Z}; empty where it is none
std::string distortion_text(const Value &map, const Value &within, const Words &words,
                            std::string &why);

std::string copy_name(int level);      // what the number of a copy is called
std::string yaml_number(double value); // shortest exact form, `.inf`

// The same for the way out. Cached fields are collected as programs use them.
struct FlowWords {
    struct Cached {
        std::string flow;
        double cell = 0;
    };
    std::vector<std::string> params; // by index
    std::vector<Cached> caches;
    std::vector<ir::NodeId> ids; // of the repetitions around, whose copies differ
};

// The steps of an expression in flow form, its loops iteration by iteration; empty where an
// operation has no words there (images, grids, long loops). `present` stands for variables, in what
// is called too. The graph grows by what the iterations are.
std::string program_flow(ir::Graph &graph, ir::NodeId root, const ir::Substitution &present,
                         FlowWords &words);

// What an Op::Blend computes, as arithmetic.
ir::NodeId blend_expression(ir::Graph &graph, ir::NodeId blend);

} // namespace fathom::save
