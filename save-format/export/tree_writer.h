// The walk from shapes to nodes of a save file, whose parts lie by idea in tree.cpp (what unites,
// groups and materials), maps.cpp (movements, deformations, repetitions), blends.cpp
// (intersections, blends and seams), solids.cpp (the library's solids), flat.cpp (flat shapes) and
// fields.cpp (functions of the point). Private to those.
#pragma once

#include "save-format/export/appearance.h"
#include "save-format/export/tree.h"
#include "save-format/node_types.h"

#include <set>
#include <unordered_map>
#include <unordered_set>

namespace fathom::save {

using ir::NodeId;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;

// The material that paints a subtree.
struct Paint {
    std::string fill;    // of what is unpainted
    bool forced = false; // by a repaint: inner paints do not count
};

// Writes the tree of one scene.
class TreeWriter {
  public:
    TreeWriter(const ir::Scene &scene, Numbers &numbers, Appearances &appearances,
               Diagnostics &diagnostics)
        : scene_(scene), numbers_(numbers), looks_(appearances), diagnostics_(diagnostics) {
        const auto &maps = scene.shapes.displacement_maps;
        for (std::size_t i = 0; i < maps.size(); ++i)
            if (maps[i].whole) maps_.emplace(maps[i].whole, i);
    }

    // Appends the nodes whose union the shape is.
    void united(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);

  private:
    // One node, or none where nothing is there.
    std::optional<TreeNode> single(ShapeId id, const Paint &paint);
    std::optional<TreeNode> node(ShapeId id, const Paint &paint);

    void map(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);
    void rotation(const ir::Constant &matrix, TreeNode made, std::vector<TreeNode> &out);
    void repeat(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);
    void copies(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);
    std::optional<TreeNode> copied(NodeType type, ShapeId id, const Paint &paint);
    void painted(ShapeId id, Paint paint, std::vector<TreeNode> &out);
    bool displaced(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);
    std::optional<TreeNode> displaced_base(ShapeId id, const Paint &paint);
    std::optional<TreeNode> map_node(const ir::DisplacementMap &map, double amount, ShapeId child,
                                     const Paint &paint);
    std::optional<TreeNode> intersection(ShapeId id, const Paint &paint);
    std::optional<TreeNode> profile_blend(ShapeId id, bool complemented, const Paint &paint);
    std::optional<TreeNode> lerp(ShapeId id, const Paint &paint);
    std::optional<TreeNode> library(ShapeId id, const Paint &paint);
    std::optional<TreeNode> field(ShapeId id, const ir::Region *region, const Paint &paint);
    std::optional<TreeNode> one_child(NodeType type, ShapeId child, const Paint &paint);
    std::optional<TreeNode> deformed(ShapeId id, NodeType type, const Paint &paint);
    std::optional<TreeNode> seam(ShapeId id, const Paint &paint);
    // What nodes cannot say, or not with these numbers: the shape as the function of the point that
    // it is. Where that has no words either, `what` is reported.
    std::optional<TreeNode> otherwise(ShapeId id, const Paint &paint, const std::string &what);
    std::optional<TreeNode> no_field(ShapeId id, const std::string &what); // reports
    NodeId raw_field(ShapeId id);
    bool painted_within(ShapeId id);
    std::optional<Value> steps(NodeId expression) { return numbers_.steps(expression); }
    // Adds a number (a vector) as it is at present, and what it follows; false where it is none.
    bool number(TreeNode &node, const char *name, NodeId value);
    bool vector(TreeNode &node, const char *name, NodeId value);
    void vary(TreeNode &node, std::string_view name, NodeId value);
    std::optional<TreeNode> generalised(ShapeId id, const ir::Library &library,
                                        const std::string &name, const Paint &paint);
    // A library call's `Arguments`, behind those that are words: null, or what of them has no words.
    const char *add_arguments(TreeNode &result, const ir::Library &library,
                              std::vector<Entry> words);
    bool varying_turn(TreeNode &node, NodeId matrix);
    bool flat_words(ShapeId id);
    std::optional<TreeNode> flat_map(ShapeId id, const Paint &paint);
    std::optional<TreeNode> raised(ShapeId id, const char *function, const char *argument,
                                   NodeId value, const Paint &paint);
    std::array<NodeId, 2> corners(const ir::Region &box);
    std::optional<Value> region(const ir::Region &region);

    const Shape &shape(ShapeId id) const { return scene_.shapes[id]; }
    // Contracts, library wrappers of combinations and such say nothing here.
    ShapeId bare(ShapeId id) const;

    const ir::Scene &scene_;
    Numbers &numbers_;
    Appearances &looks_;
    std::unordered_map<ShapeId, std::size_t> maps_; // displacement maps, by the whole they lie on
    std::unordered_set<std::size_t> open_maps_;     // whose nodes are being written
    Diagnostics &diagnostics_;
    std::optional<ir::Scene> lowered_; // made when a function is first written
    std::unordered_map<ShapeId, NodeId> raw_;
    std::unordered_map<ShapeId, bool> painted_within_;
    std::set<Span> said_; // of the shapes that are said to be functions
    bool boxed_ = false;  // functions are written with the boxes that hold them
    int functions_ = 0;   // shapes that went out as functions, so that no one knows where they end
};

// A node without properties.
TreeNode made(NodeType type);
double shortest_near(double value); // the shortest decimal within a few units in the last place
// Sets a property.
void add(TreeNode &node, const char *name, Value value);

} // namespace fathom::save
