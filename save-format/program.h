// Functions of the point as the save format writes them, labelled: a list of steps, each
// `[operation, arguments…]`, where a whole number is the result of an earlier step. The same in the
// language's text. Private to save-format.
#pragma once

#include "ir/passes/walk.h"
#include "ir/scene.h"
#include "save-format/yaml_reader.h"

#include <string>
#include <unordered_map>

namespace fathom::save {

// `p => …`; empty, with the reason, where the steps make no sense. Looks may also read the normal:
// `(p, n) => …`.
std::string program_text(const Value &steps, std::string &why, bool with_normal = false);
std::string region_text(const Value &region);
std::string distortion_text(const Value &map, const Value &within, std::string &why);
std::string deformation_text(std::string_view function, const Value &arguments, std::string &why);

std::string yaml_number(double value); // shortest exact form, `.inf`

// The steps of an expression in flow form, its loops turn by turn; empty where an operation has no
// words there (images, grids, long loops). `present` stands for params and time, in what is called
// too. The graph grows by what the turns are.
std::string program_flow(ir::Graph &graph, ir::NodeId root, const ir::Substitution &present);

// What an Op::Blend computes, as arithmetic.
ir::NodeId blend_expression(ir::Graph &graph, ir::NodeId blend);

} // namespace fathom::save
