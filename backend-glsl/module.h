// What the functions of one emitted text share: names, and a record of what was used, so that only
// that is emitted.
#pragma once

#include "backend-glsl/cache.h"
#include "backend-glsl/emit.h"
#include "backend-glsl/names.h"
#include "backend-glsl/prune.h"

#include <glm/vec3.hpp>
#include <map>
#include <set>
#include <string>
#include <unordered_map>

namespace fathom::glsl {

// A helper function `fathom_…` and the type that it was wanted for ("" where it has one form only).
using HelperKey = std::pair<std::string, std::string>;

struct TableUse {
    std::string name;
    int rows = 0, texels = 0; // a row is that many vec4
    int start = 0;            // in the texture buffer
    bool buffer = false;
    std::vector<float> data; // padded to whole texels; where it stands in the text
};

struct Module {
    const ir::Scene &scene;
    const Options &options;
    Names names{};
    std::map<std::uint32_t, std::string> functions{}; // the needed ones, by FunctionId
    std::set<HelperKey> helpers{};
    std::map<std::uint32_t, TableUse> tables{}; // by TableId
    std::map<std::uint32_t, ir::FunctionId>
        computed{}; // by TableRead's payload: the formula instead
    std::map<std::uint32_t, std::string> params{}, images{}, grids{};
    std::vector<float> texels{};
    bool reads_time = false;
    bool hits = false; // the struct Hit is used
    std::map<std::uint32_t, CachedText>
        cached{}; // by CacheId: the fields read through the noise cache
    std::map<std::uint32_t, ir::NodeId> results{}; // by FunctionId: as loops (reroll.h)

    std::map<std::uint32_t, PrunePlan::Use> pruned{}; // by LoopId: loops over a cell's rows
    bool around = false;    // outside of the cells there are the scene's endless parts (prune.h)
    bool far_cells = false; // rays read which cells are far from all surfaces (prune.h)

    ir::NodeId result_of(ir::FunctionId id) const {
        const auto it = results.find(id.index);
        return it == results.end() ? scene.graph.function(id).result : it->second;
    }
};

// Whether points are shaded by another field than rays are marched by (ir/shading.h).
inline bool is_shaded_apart(const ir::Scene &scene) {
    return scene.shaded && scene.shaded != scene.distance;
}

const char *glsl_type(ir::Type type);
std::string comment(std::string_view text); // a line of its own: what comes from outside is encoded
std::string literal(const ir::Constant &constant); // "1.0", "vec3(0.0, 1.0, 0.0)"
std::string float_literal(float value);
inline std::string float_literal(double value) { return float_literal(static_cast<float>(value)); }
std::string vec3_literal(const glm::dvec3 &value);

// Every function, table, image and grid that the roots need gets its name here; functions by
// ascending id.
void gather(Module &module, std::span<const ir::NodeId> roots);

// Rows of floats, padded to whole vec4, as text or in the buffer.
TableUse add_table(Module &module, const std::string &name, int rows, int stride,
                   const std::vector<float> &data);
std::string texel(const TableUse &use,
                  const std::string &place); // "table_0[i * 2]", of an index from the table's start

struct Bound {
    ir::NodeId var;
    std::string name; // what it is to be called in the text; `body` makes it unique
};

// The statements of a function's body, each line indented by four: locals, loops, branches. Then,
// for each root, the expression of its value, in `values`.
struct Body {
    std::string statements;
    std::vector<std::string> values;
};
Body body(Module &module, std::span<Bound> bound, std::span<const ir::NodeId> roots);

} // namespace fathom::glsl
