/** @file
 *  Why a scene's bound is what it is, as a tree, and what evaluating the scene can leave out.
 *
 *  @code
 *  #include <fathom/explain.h>
 *  #include <cstdio>
 *
 *  static void print(const fathom::Explanation &node, int depth) {
 *      std::printf("%*s%s: %g %s\n", 2 * depth, "", node.operation.c_str(), node.lipschitz,
 *                  node.rule.c_str());
 *      for (const fathom::Explanation &child : node.children) print(child, depth + 1);
 *  }
 *
 *  int main() {
 *      const auto result =
 *          fathom::compile_text("bar.sdf", "box([1, 4, 1]).twist(30deg)\n");
 *      if (!result) return 1;
 *      const auto why = fathom::explain(*result.scene);
 *      if (!why) return 1;
 *      print(*why, 0);
 *      return why->children.empty() ? 1 : 0;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

namespace fathom::FATHOM_V1 {

/** An operation of the scene, what it does to the bound, and the operations that it is made of. */
struct Explanation {
    std::string operation; /**< "twist", "union", "sphere" */
    std::string rule;      /**< in words: "shear by rate * moment arm: sigma(2 * 0.6)" */
    double factor = 1;     /**< the operation's own: its bound over the largest of its children's */
    double lipschitz = 1;  /**< the bound of what it gives */
    double share = 0;      /**< of the whole bound, by logarithms: 0 to 1 */
    std::string region;    /**< where the bound holds: "everywhere", "ball(4)" */
    Place at;
    bool steepest = false; /**< on the chain of the steepest children */
    std::vector<Explanation> children;
};

/** The tree of the whole scene; its bound is Facts::lipschitz. Nothing without memory for it. */
FATHOM_API std::optional<Explanation> explain(const Scene &scene);

/** What a picture need not evaluate everywhere. Which cells of space need which shapes is found
 *  while it is drawn; whether that is looked for is known before. */
struct Pruning {
    double shapes = 0;     /**< how many shapes there are to choose from */
    bool by_cells = false; /**< the CPU computes for each cell of space what can matter there */
    std::vector<int> rows; /**< of each loop that GL 4.3 shortens to lists by cells: its length */
};
FATHOM_API Pruning pruning(const Scene &scene);

} // namespace fathom::FATHOM_V1
