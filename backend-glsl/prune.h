// Long loops over rows, cell by cell: in a cell of space most rows of a union are too far away to
// matter, so a list of the others has the same values there (Barbier et al. 2025, on Lipschitz
// pruning). A compute shader makes the lists for a grid of cells, level by level, each from that of
// the cell 4^3 as large; the picture's text then runs over the list of the cell that a point is in,
// and over all rows outside of the grid, where it evaluates them. So the field is the same to the
// bit.
//
// A loop: acc = start(p); for each row i: acc = joined(acc, v_i(p)). With L a bound of every v_i's
// slope, M one of acc's (the larger of L and start's), R half a cell's diagonal, c its centre:
//   least     row i is not the least anywhere in the cell, where v_i(c) - L R > least(c) + M R;
//   blended   within r: where v_i(c) - acc(c) >= (L + M) R + r, row i changes nothing in the cell;
//             where acc(c) - v_i(c) >= that, nothing before i does. (A blend of a and b is their
//             minimum, to the bit, where |a - b| >= r.)
// To each margin is added what float32 may be off. Knows expressions, not shapes; calls no GL.
//
// Far cells: no surface is nearer to a cell's centre c than sdf(c). Where that is more than R,
// one number stands for the cell: a ray in it goes on to where it leaves the ball of that radius
// about c, and evaluates no row. A shadow's ray leaves the ball made smaller by what could shade
// it. Outside of all cells the box of what has an end, and what has none (a ground), say as much.
#pragma once

#include "backend-glsl/emit.h"

#include <map>

namespace fathom::glsl {

constexpr int min_pruned = 96;         // rows
constexpr std::size_t max_grids = 16;  // of one scene
constexpr double steepest_pruned = 16; // steeper rows keep too much

struct PrunedLoop {
    ir::FunctionId value, start, joined, radius; // (p, row), (p), (acc, p, row), (p)
    double slope = 0, acc_slope = 0;
    bool blended = false;
    int rows = 0;
};

struct PrunePlan {
    ir::Scene scene; // a copy, with the loops' functions
    std::vector<PrunedLoop> grids;
    struct Use {
        int grid = 0, rows = 0;
        ir::NodeId point;
    };
    std::map<std::uint32_t, Use> loops; // by LoopId
};

// The loops of the scene's distance, hit and shaded field that can be pruned. `results`: what functions hand back
// instead of what they say (reroll.h). Nothing where there are none, or no part has an end.
std::optional<PrunePlan> plan_pruning(const ir::Scene &scene,
                                      const std::map<std::uint32_t, ir::NodeId> &results);

// The inputs and the look-up that a text with lists needs; a loop's list of rows is
// `fathom_list(p, grid, rows)`: the first entry of fathom_rows and the one after the last.
// `bounds`: Scene::bounds; `fathom_off(p)` is how far p is from it.
std::string prune_look_up(const ir::Box &bounds);

// What rays need of far cells, after that: `fathom_clear(p, direction, margin)`, how far back and
// ahead of p all is more than `margin` away from surfaces, as far as p's cell knows; no way ahead
// where that is little. `outside`: the distance from p to all surfaces, or less, as GLSL, where p
// is in no cell.
std::string far_look_up(const std::string &outside);
// Of a scene with endless parts: `sdf` and the function that hits are called by `hit`, of
// `fathom_all` and `fathom_all_hit`, and, for points outside of the cells, of `fathom_endless` and
// `fathom_endless_hit`. Unless the global `fathom_exact` is set, the field there is no more than
// the distance to the box of all that has an end; it is exact where an endless part is nearer.
std::string prune_around(const std::string &hit);
// What makes the cells' numbers, after the lists and float sdf(vec3).
std::string far_kernel(const std::string &sdf);

// What makes a grid's lists from its parents', after the functions with these names. Inputs: see
// the text.
struct PruneNames {
    std::string value, start, joined, radius;
};
std::string prune_kernel(const PrunedLoop &loop, const PruneNames &names);

} // namespace fathom::glsl
