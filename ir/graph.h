// What a field computes: a pure, hash-consed, folded DAG of operations. Arguments precede users and
// the array's order is a schedule. Knows nothing of syntax; says nothing of shapes (ir/shape.h
// builds on this).
//
// A *closed* expression depends on inputs alone. `Point` is the point of the space in which an
// expression stands; `Var`s are bound by functions, loops and the shapes Repeat and Instances. A
// node's value is a function of those.
#pragma once

#include "base/ids.h"
#include "base/source.h"
#include "ir/ops.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace fathom::ir {

// The type of a node. Hit is what a hit function returns: a distance and what was hit.
enum class Type : std::uint8_t { Bool, Int, Float, Vec2, Vec3, Vec4, Mat2, Mat3, Mat4, Hit };

int components(Type type);  // 1, 2, 3, 4, 4, 9, 16; of a Hit 9 (distance, paint, point 3, extra 4)
Type vector_type(int size); // 1 -> Float, 2 -> Vec2, …
Type matrix_type(int size); // 2 -> Mat2, …
int side(Type matrix);      // Mat3 -> 3
bool is_vector(Type type);  // Vec2, Vec3, Vec4
// Whether it is Mat2, Mat3 or Mat4.
bool is_matrix(Type type);
const char *type_name(Type type); // the language's and GLSL's name: "vec3"

// The blend profiles of two distances a and b within r of the seam (lipschitz.md, 3); n: steps or
// columns. Each is exactly min(a, b) outside its compact support.
enum class Profile : std::uint8_t { Smooth, Round, Chamfer, Stairs, Columns };

struct Node;
struct Function;
struct Loop;
struct Table;
struct Cache;
using NodeId = Id<Node>;
using FunctionId = Id<Function>;
using LoopId = Id<Loop>;
using TableId = Id<Table>;
using CacheId = Id<Cache>;

// One operation: its arguments stand in the graph, `payload` depends on the op.
struct Node {
    Op op = Op::Const;
    Type type = Type::Float;
    std::uint32_t payload = 0; // by op, see ops.def
    std::uint32_t first = 0;   // arguments: Graph::args(id)
    std::uint32_t count = 0;
};

// A constant has components(type) numbers (bools and ints as doubles); column-major for matrices.
struct Constant {
    Type type = Type::Float;
    std::array<double, 16> value{};
};

// A function of its parameters and of the global inputs (Time, Param) alone; its body names no
// Point. `name` is a suggestion for the emitted text, made unique there. Functions call only those
// before them.
struct Function {
    std::string name;
    Span origin;                // where the user wrote it; no source for made ones
    std::vector<NodeId> params; // Var nodes
    NodeId result;
};

// A loop. vars[k] has value args[k] before the first iteration and next[k] after each; `index`
// (Int) counts 0, 1, … The loop ends after `count` iterations (an Int node, evaluated once before),
// or before the first iteration in which `condition` (a Bool over index and vars, invalid id:
// always true) is false. Results are the vars' last values.
struct Loop {
    NodeId count;
    NodeId index;             // Var, Int
    std::vector<NodeId> vars; // Vars
    std::vector<NodeId> next; // same types
    NodeId condition;
    int max_count = 0; // a constant upper bound of `count`
};

// Scene-time data read at field time: `rows` rows of `stride` floats.
struct Table {
    int rows = 0;
    int stride = 0;
    std::vector<float> data;
    // Where the rows follow from their number: the first column of what a formula gives, and that
    // formula, a function (row: int) -> the numbers, which clamps the row itself. It gives the data
    // to float precision; the data is what is true.
    std::vector<std::pair<int, FunctionId>> computed{};
};
// TableRead's payload: which table and the first of components(type) columns.
std::uint32_t table_slot(TableId table, int column); // 20 bits table, 12 bits column
TableId table_of(std::uint32_t slot);
int column_of(std::uint32_t slot);

// A field whose values may come from the noise cache (semantics: it *is* the function).
struct Cache {
    FunctionId field; // vec3 -> float, vec3 or vec4
    double cell = 0;
};

// Up to four components, 2 bits each, and the count: zyx is {2, 1, 0}.
std::uint32_t swizzle_mask(std::span<const int> components);
int swizzle_size(std::uint32_t mask);
int swizzle_component(std::uint32_t mask, int i);

// All nodes of a scene, with the functions, loops, tables and caches that they name.
class Graph {
  public:
    const Node &operator[](NodeId id) const { return nodes_[id]; }
    std::span<const NodeId> args(NodeId id) const;
    NodeId arg(NodeId id, int i) const { return args(id)[static_cast<std::size_t>(i)]; }
    Type type(NodeId id) const { return nodes_[id].type; }
    std::size_t size() const { return nodes_.size(); }
    std::size_t bytes() const; // of memory, about

    // Makes a node, or finds the equal one; folds constants and a few identities (x+0, x*1, x*0,
    // min(x,x), swizzle of Make, Select of a constant, …; ir/passes/fold.cpp). Types of
    // componentwise arguments must be equal (asserted).
    NodeId make(Op op, std::span<const NodeId> args); // types by rule
    NodeId make(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload = 0);
    NodeId make(Op op, std::initializer_list<NodeId> args);
    NodeId make(Op op, Type type, std::initializer_list<NodeId> args, std::uint32_t payload = 0);
    // The same without folding: for copies of what another graph holds. No Const and no Var.
    NodeId make_as_is(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload) {
        return intern(op, type, args, payload);
    }

    NodeId constant(const Constant &constant);
    NodeId number(double value);
    NodeId integer(int value);
    NodeId boolean(bool value);
    NodeId vec(std::span<const double> values);
    NodeId vec3(double x, double y, double z);
    NodeId point(Type type = Type::Vec3);
    NodeId fresh_var(Type type); // a variable that no one else has
    NodeId param(std::uint32_t index, Type type);
    NodeId time();

    // Short forms that splat a float where the other argument is a vector.
    NodeId add(NodeId a, NodeId b);
    NodeId sub(NodeId a, NodeId b);
    NodeId mul(NodeId a, NodeId b);
    NodeId div(NodeId a, NodeId b);
    // The same of arguments in braces. Where both make nodes they stand so: `add({mul(a, b), mul(c,
    // d)})`. The order in which a compiler evaluates the arguments of a call is its own, that of
    // elements in braces is not; so the nodes, and the text of a shader, are the same of every
    // compiler. scripts/argument_order.sh finds calls that miss the braces.
    struct Pair {
        NodeId a, b;
    };
    NodeId add(Pair of) { return add(of.a, of.b); }
    NodeId sub(Pair of) { return sub(of.a, of.b); }
    NodeId mul(Pair of) { return mul(of.a, of.b); }
    NodeId div(Pair of) { return div(of.a, of.b); }
    NodeId neg(NodeId a);
    NodeId component(NodeId vector, int i); // Swizzle of one
    // The same as a scalar that no vector is computed for, where the vector is made of scalars by
    // what goes component by component; nothing for others. So of `if a.x < b.x { a } else { b }`
    // with a and b made of a distance and a material, the distance is a choice of distances.
    std::optional<NodeId> scalar_part(NodeId vector, int i, int depth = 0);
    NodeId swizzle(NodeId vector, std::span<const int> components);
    NodeId splat(NodeId scalar, Type type);
    NodeId call(FunctionId function, std::span<const NodeId> args);

    bool is_constant(NodeId id) const { return nodes_[id].op == Op::Const; }
    Constant constant_of(NodeId id) const;            // of a Const node
    std::optional<double> as_number(NodeId id) const; // a constant scalar's value

    FunctionId add_function(Function function);
    LoopId add_loop(Loop loop);
    void change_loop(LoopId id, Loop loop); // to one with the same values and free variables
    TableId add_table(Table table);         // or finds the equal one
    CacheId add_cache(Cache cache);
    const Function &function(FunctionId id) const { return functions_[id]; }
    const Loop &loop(LoopId id) const { return loops_[id]; }
    const Table &table(TableId id) const { return tables_[id]; }
    const Cache &cache(CacheId id) const { return caches_[id]; }
    std::size_t function_count() const { return functions_.size(); }
    std::size_t loop_count() const { return loops_.size(); }
    std::size_t table_count() const { return tables_.size(); }
    std::size_t cache_count() const { return caches_.size(); }
    std::uint32_t var_count() const { return vars_; }

    // What a node reads, transitively, through calls and loops too.
    struct Reads {
        bool point = false, normal = false, direction = false, time = false, params = false;
        bool free_vars = false; // Vars that nothing below the node binds
        friend bool operator==(Reads, Reads) = default;
    };
    Reads reads(NodeId id) const { return reads_[id.index]; }
    std::vector<NodeId>
    free_vars(NodeId id) const; // in order of payload; walks the graph, so call it once

  private:
    NodeId folded(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload); // or none
    NodeId intern(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload);
    NodeId add_node(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload);
    // Where the node that is `equal` stands in slots_, or the next one of this hash will.
    template <class Equal> NodeId &slot_of(std::uint64_t hash, const Equal &equal);
    Reads reads_of(const Node &node) const;
    bool made_of_scalars(const Node &node) const;
    Arena<Node> nodes_;
    std::vector<NodeId> args_;
    std::vector<Reads> reads_;
    std::vector<bool> of_scalars_; // by node: a vector that scalar_part takes apart
    std::unordered_map<std::uint64_t, NodeId> scalar_parts_;
    std::vector<double> numbers_; // of constants: components(type) from their payload on
    Arena<Function> functions_;
    Arena<Loop> loops_;
    Arena<Table> tables_;
    Arena<Cache> caches_;
    std::uint32_t vars_ = 0;
    std::size_t table_bytes_ = 0;
    std::vector<Constant> folding_; // the arguments of the fold in hand
    std::vector<NodeId> slots_;     // open addressing by content; a power of two, at most half full
    std::unordered_multimap<std::uint64_t, TableId> interned_tables_;
};

} // namespace fathom::ir
