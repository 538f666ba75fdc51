// The ops of the graph and what is known of each: the table of ir/ops.def as data. Knows nothing of
// graphs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>

namespace fathom::ir {

// One name for each row of ops.def.
enum class Op : std::uint8_t {
#define FATHOM_OP(name, ...) name,
#include "ir/ops.def"
};

inline constexpr std::size_t op_count = 0
#define FATHOM_OP(...) +1
#include "ir/ops.def"
    ;

// How a result's type follows from the arguments'. Given: graph.cpp says how.
enum class TypeRule : std::uint8_t { Given, Same, Last, ToFloat, ToBool };

// What an op by component takes: floats, vectors and matrices, and Numbers also ints. Own: the op
// is not by component.
enum class Takes : std::uint8_t { Own, Floats, Numbers };

// What an op makes of arguments that change sign, or do not, where the point is reflected.
enum class OpParity : std::uint8_t {
    None,    // of the same arguments the same value, and no more
    Odd,     // f(-x) = -f(x)
    Even,    // f(-x) = f(x)
    Sum,     // as its arguments, where they agree
    Product, // changes sign where one of its two arguments does
    Parts,   // each component is one of the arguments'
    Own,     // a rule of its own in proof/parity.cpp
};

// One row of ops.def.
struct OpInfo {
    const char *name;
    int arity; // -1: any number
    TypeRule rule;
    Takes takes;
    bool function; // of one float, by component
    const char *glsl;
    const char *text; // in the language; empty: none
    int weight;       // in a shader
    OpParity parity;
    const char *trouble; // what messages call the place where it has no slope; empty: `name`
};
// clang-format off
inline constexpr OpInfo op_infos[] = {
#define FATHOM_OP(name, arity, rule, glsl, text, weight, cost, parity, trouble) \
    {#name, arity, TypeRule::rule, Takes::Own, false, glsl, text, weight, OpParity::parity, trouble},
#define FATHOM_BY_COMPONENT(name, arity, takes, glsl, text, weight, cost, parity, trouble) \
    {#name, arity, TypeRule::Same, Takes::takes, false, glsl, text, weight, OpParity::parity, trouble},
#define FATHOM_FUNCTION(name, function, glsl, weight, cost, parity, trouble, undefined, doc) \
    {#name, 1, TypeRule::Same, Takes::Floats, true, glsl, #function "({0})", weight, OpParity::parity, trouble},
#include "ir/ops.def"
};
// clang-format on

constexpr const OpInfo &info(Op op) { return op_infos[static_cast<std::size_t>(op)]; }

// A value for each op: T's default for those that are not named. For rules that a few ops have,
// where having none is right for an op that nobody thought of.
template <class T> class OpTable {
  public:
    consteval OpTable(std::initializer_list<std::pair<Op, T>> rows) {
        for (const auto &[op, value] : rows) {
            values_[static_cast<std::size_t>(op)] = value;
            named_[static_cast<std::size_t>(op)] = true;
        }
    }
    constexpr const T &operator[](Op op) const { return values_[static_cast<std::size_t>(op)]; }
    constexpr bool names(Op op) const { return named_[static_cast<std::size_t>(op)]; }

  private:
    std::array<T, op_count> values_{};
    std::array<bool, op_count> named_{};
};

// Some ops: whether an op is one of them.
class OpSet {
  public:
    consteval OpSet(std::initializer_list<Op> ops) {
        for (Op op : ops) has_[static_cast<std::size_t>(op)] = true;
    }
    constexpr bool operator[](Op op) const { return has_[static_cast<std::size_t>(op)]; }

  private:
    std::array<bool, op_count> has_{};
};

} // namespace fathom::ir
