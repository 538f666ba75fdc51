// The syntax tree: what the user wrote, as a value, with no semantic facts (those live beside it in
// the checker's side tables, keyed by id). Knows nothing of types, names' meanings or other files.
#pragma once

#include "base/ids.h"
#include "base/source.h"

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fathom::lang {

struct Expr;
struct Block;
struct Function;
using ExprId = Id<Expr>;
using BlockId = Id<Block>;
using FunctionId = Id<Function>;

// Texts that a tree's nodes read. None moves while others are added, or when the tree is moved;
// a tree is never copied.
class Texts {
  public:
    Texts() = default;
    Texts(Texts &&) = default;
    Texts &operator=(Texts &&) = default;

    std::string_view add(std::string text) { return texts_.emplace_back(std::move(text)); }
    const std::string &operator[](std::uint32_t i) const { return texts_[i]; }
    std::size_t size() const { return texts_.size(); }
    auto begin() const { return texts_.begin(); }
    auto end() const { return texts_.end(); }

  private:
    std::deque<std::string> texts_;
};

// A name and where it stands.
struct Identifier {
    std::string_view text;
    Span span;
    std::uint32_t word = 0; // index into Ast::words
};

// -- types as written ----------------------------------------------------------------------------

// The types that have a name. The last three are the library's own: `_shape` (solid or flat),
// `_field` (a field or its constant) and `_any`.
enum class TypeName : std::uint8_t {
    Unknown,
    Float,
    Int,
    Bool,
    String,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
    Color,
    Shape,
    Shape2,
    Material,
    Light,
    Region,
    AnyShape,
    AnyField,
    Any
};
TypeName type_named(std::string_view text); // builder.cpp
std::vector<std::string_view> type_names(); // all that have one, sorted

// `float`, `shape<1.5>`, `[vec3]`, `(vec3, int) -> float`.
struct TypeExpr {
    enum class Kind { Name, List, Function };
    Kind kind = Kind::Name;
    Span span;
    std::string_view name; // Name: as written, "float", "shape", …
    TypeName named = TypeName::Unknown;
    bool in_radians = false;         // Name: `angle` (a float) and `angles` (a vec3)
    std::optional<double> lipschitz; // Name, `shape<L>` only
    std::vector<TypeExpr> items;     // List: one; Function: the parameters, then the result
};

// -- expressions ---------------------------------------------------------------------------------

enum class UnaryOp { Neg, Not };
enum class BinaryOp {
    Union,
    Intersection,
    Or,
    And,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Add,
    Sub,
    Mul,
    Div,
    Mod,
    Pow
};

struct Poison {}; // a place where the parser already reported an error
// A literal number; an angle is in radians already.
struct Number {
    double value = 0; // in radians where an angle's unit stood behind it
    bool is_int = false;
    std::string_view unit; // "", "deg", "rad" or "turn"
};
struct String {
    std::string_view value;
};
struct Bool {
    bool value = false;
};
struct Color {
    double rgba[4] = {0, 0, 0, 1};
}; // sRGB, 0..1, as in the text
struct Name {
    std::string_view text;
    std::uint32_t word = 0; // index into Ast::words
};
struct List {
    std::vector<ExprId> items;
}; // [a, b, c]
struct Comprehension {
    BlockId body;
}; // [for … { … }] or [if … { … }]: a contributing body
struct Range {
    ExprId first, last;
    bool inclusive = false;
};
struct Unary {
    UnaryOp op;
    ExprId operand;
};
struct Operand {
    ExprId value;
    BinaryOp op{}; // before it; of the first one nothing
    Span op_span;
};
// `a + b - c` is one node: operands a, + b and - c. All ops of a node have one precedence.
// Comparisons and `^` have exactly two operands.
struct Binary {
    std::vector<Operand> operands;
    BinaryOp op() const { return operands[1].op; } // the first
};
struct Argument {
    std::optional<Identifier> name;
    ExprId value;
};
struct Call {
    std::vector<Argument> arguments;
    ExprId callee;                   // a Member for `a.f(b)`
    std::optional<BlockId> trailing; // `union { … }`: a contributing block
    bool has_parentheses = true;     // false for `union { … }`
};
struct Index {
    ExprId object, index;
};
struct Member {
    ExprId object;
    Identifier name;
};
struct Lambda {
    FunctionId function;
};
struct IfBranch {
    ExprId condition;
    BlockId body;
};
struct If {
    std::vector<IfBranch> branches; // `if`, then each `else if`
    std::optional<BlockId> otherwise;
};
struct BlockExpr {
    BlockId block;
}; // a block where an expression stands: a lambda's `{ … }` body

using ExprKind = std::variant<Poison, Number, String, Bool, Color, Name, List, Comprehension, Range,
                              Unary, Binary, Call, Index, Member, Lambda, If, BlockExpr>;

// An expression: its kind and its place.
struct Expr {
    ExprKind kind;
    Span span; // the whole expression, without surrounding parentheses
    bool parenthesized = false;
};

// -- statements ----------------------------------------------------------------------------------

// A parameter of a function, with its type and its default where they are given.
struct Parameter {
    Identifier name;
    const TypeExpr *type = nullptr; // or none
    std::optional<ExprId> default_value;
};

// A `fn` or a lambda. The body is always a block; `fn f(x) = e` and `x => e` give one of a single
// ExprStmt.
struct Function {
    std::optional<Identifier> name; // none for a lambda
    std::vector<Parameter> parameters;
    const TypeExpr *result = nullptr; // or none
    BlockId body;
    Span span;                       // all of it
    Span head;                       // `fn name(…) -> type`, or the lambda's parameters
    bool body_is_expression = false; // written with `=` or without braces
    std::string_view doc;            // the `///` comment lines directly above, without the slashes
};

struct ExprStmt {
    ExprId value;
};
struct Let {
    Identifier name;
    const TypeExpr *type = nullptr; // or none
    ExprId value;
    std::string_view doc;
};
struct Var {
    Identifier name;
    const TypeExpr *type = nullptr; // or none
    ExprId value;
};
// `target op= value`; op is empty for `=`. The target is a name followed by members and indices.
struct Assign {
    ExprId target;
    std::optional<BinaryOp> op;
    ExprId value;
};
struct FunctionDecl {
    FunctionId function;
};
// `param name = value in low..high "label"`; the range's ends are included.
struct Param {
    Identifier name;
    const TypeExpr *type = nullptr; // or none
    ExprId value;
    std::optional<ExprId> low, high;
    std::optional<std::string_view> label;
};
struct Import {
    std::string_view path;
    Span path_span;
    std::optional<Identifier> as;
};
struct For {
    Identifier variable;
    ExprId sequence;
    BlockId body;
};
struct While {
    ExprId condition;
    std::optional<ExprId> limit;
    BlockId body;
};
struct Break {};
struct Return {
    std::optional<ExprId> value;
};
struct Bad {}; // a statement that could not be read; already reported

using StmtKind = std::variant<Bad, ExprStmt, Let, Var, Assign, FunctionDecl, Param, Import, For,
                              While, Break, Return>;
// A statement: its kind and its place.
struct Stmt {
    StmtKind kind;
    Span span;
};

// The statements between braces, or of a whole file. Whether it *contributes* (semantics.md, 3)
// depends on where it stands: a file, a trailing block and a comprehension do, and so do the bodies
// of `for` and `if` inside them.
struct Block {
    std::vector<Stmt> stmts;
    Span span;
};

// A whole text as arrays of expressions, blocks, functions and types.
struct Ast {
    SourceId source;
    Arena<Expr> exprs;
    Arena<Block> blocks;
    Arena<Function> functions;
    BlockId root;               // the file
    Texts words;                // its names, each once
    Texts others;               // its strings and comments, as their nodes have them
    std::deque<TypeExpr> types; // as their nodes have them
};

} // namespace fathom::lang
