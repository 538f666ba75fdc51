// From the scene's tree of shapes to nodes of a save file, at the present values of params. Private
// to save-format.
#pragma once

#include "ir/passes/walk.h"
#include "ir/scene.h"
#include "save-format/kept_items.h"
#include "save-format/yaml_writer.h"

#include <optional>

namespace fathom::save {

// Expressions as numbers: params and time stand for their values, variables for what the walk has
// put in their place.
class Numbers {
  public:
    explicit Numbers(const ir::Scene &scene);

    std::optional<ir::Constant> constant(ir::NodeId id);
    std::optional<double> number(ir::NodeId id);
    std::optional<std::array<double, 3>> vector(ir::NodeId id); // a vec2's third component is 0
    ir::NodeId reduced(ir::NodeId id);  // the expression, with those values in it
    std::string program(ir::NodeId id); // its steps in flow form; empty where there are no words
    void set(ir::NodeId variable, const ir::Constant &value);
    ir::Graph &graph() { return graph_; }

  private:
    ir::Graph graph_;
    ir::Substitution values_;
};

// What the file cannot hold: a warning, since the rest is written.
Remark unsaved(Diagnostics &diagnostics, Span place, std::string message);

class Looks;

// The nodes that unite to the scene, in the order of its text.
std::vector<TreeNode> export_tree(const ir::Scene &scene, Numbers &numbers, Looks &looks,
                                  Diagnostics &diagnostics);

} // namespace fathom::save
