// From the scene's tree of shapes to nodes of a save file, at the present values of params. Private
// to save-format.
#pragma once

#include "base/limits.h"
#include "ir/passes/walk.h"
#include "ir/scene.h"
#include "save-format/kept_items.h"
#include "save-format/program.h"
#include "save-format/save_format.h"
#include "save-format/yaml_writer.h"

#include <map>
#include <optional>

namespace fathom::save {

// What an export may still take of the limits; the one error where that is not enough.
class Budget {
  public:
    Budget(const Limits &limits, Diagnostics &diagnostics);
    // Counts steps and bytes; false from there on where they are too many.
    bool take(std::size_t steps, std::size_t bytes);
    bool spent() const { return spent_; }
    Span place; // of what is being written

  private:
    const Limits limits_;
    Diagnostics &diagnostics_;
    std::size_t steps_ = 0, bytes_ = 0;
    bool spent_ = false;
};

// How the files of images and grids are called in the save file. One that does not lie in its
// folder is reported: what reads it from there has to be allowed to.
class FileNames {
  public:
    FileNames(const ExportOptions &options, Diagnostics &diagnostics)
        : options_(options), diagnostics_(diagnostics) {}
    // `name` in the scene's text, `file` where it was read.
    std::string written(const std::string &name, const std::string &file) const;

  private:
    const ExportOptions &options_;
    Diagnostics &diagnostics_;
};

// Expressions as numbers: params and time stand for their values, variables for what the walk has
// put in their place. As programs they keep what they follow.
class Numbers {
  public:
    Numbers(const ir::Scene &scene, Budget &budget);

    std::optional<ir::Constant> constant(ir::NodeId id);
    std::optional<double> number(ir::NodeId id);
    std::optional<std::array<double, 3>> vector(ir::NodeId id); // a vec2's third component is 0
    ir::NodeId reduced(ir::NodeId id);  // the expression, with variables' values in it
    ir::NodeId present(ir::NodeId id);  // … and those of params and time
    bool varies(ir::NodeId id);         // it is a number at present, and follows params or time
    std::string program(ir::NodeId id); // its steps in flow form; empty where there are no words
    std::optional<Value> steps(ir::NodeId id); // the same as a value
    void set(ir::NodeId variable, const ir::Constant &value);
    void open_copies(ir::NodeId id); // until closed, programs may read which copy it is
    void close_copies() { words_.ids.pop_back(); }
    ir::Graph &graph() { return graph_; }
    FlowWords &words() { return words_; }
    bool moves() const { return moves_; } // some program reads the time
    Budget &budget() { return budget_; }

  private:
    Budget &budget_;
    ir::Graph graph_;
    ir::Substitution values_, variables_;
    FlowWords words_;
    bool moves_ = false;
};

inline const std::string no_words = "it reads an image, or loops too often";

// What the file cannot hold: a warning, since the rest is written.
Remark unsaved(Diagnostics &diagnostics, Span place, std::string message);

class Appearances;

// The nodes that unite to the scene, in the order of its text.
std::vector<TreeNode> export_tree(const ir::Scene &scene, Numbers &numbers,
                                  Appearances &appearances, Diagnostics &diagnostics);

// Notes what stands under labelled keys; `lighting` as it is written.
void report_labelled(const ir::Scene &scene, Numbers &numbers, const TreeNode &root,
                     const Value &lighting, Diagnostics &diagnostics);

// The node as it is written; takes it apart, so that it does not stand there twice. `ordinals`: how
// many nodes of a type there are so far, which are the names of those that have none.
Value node_value(TreeNode node, std::map<std::string, int> &ordinals);

} // namespace fathom::save
