// The evaluator's state and the functions that its files share. Private to typecheck.
//
// Evaluation is partial: an expression over known numbers is computed in double; as soon as a
// point, a parameter or `time` takes part, nodes of the graph are made instead. An `if` on such a
// number runs both arms and selects; a loop over such numbers becomes a Loop; a function called
// with them becomes an ir::Function.
#pragma once

#include "typecheck/assets.h"
#include "typecheck/check.h"
#include "typecheck/value.h"
#include "typecheck/what.h"

#include <fmt/format.h>

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace fathom::typecheck {

struct Interpreter;

// A name, as a number: the builtins' first, in the order of their table.
using Symbol = std::uint32_t;

// What a call needs to know of a parameter, of a closure's and of a builtin's alike.
struct Formal {
    Symbol symbol = 0;
    std::string_view name;
    bool optional = false;
    bool takes_rest = false; // the last one, of type [shape], or a builtin's of any number
    bool opens_list = true;  // a single list among the rest is the rest
    bool is_angle = false;   // in radians, so that a plain literal beyond a turn looks like degrees
    std::uint8_t vector_size = 0; // of a vec2 or a vec3
    bool is_place = false;        // a point or a direction, which one number is not
    bool takes_function = false;  // by its type
    bool no_limit = false;        // its default is `inf`, which so has a meaning
    Span declared;
};

// A file: its tree, and beside it what the evaluator found out about it once.
struct File : lang::Ast {
    std::size_t place = 0;                                   // in Interpreter::files
    std::vector<Symbol> symbols;                             // by word
    std::vector<std::optional<std::vector<Formal>>> formals; // by function
};

// What a name stands for.
struct Binding {
    Symbol name = 0;
    Value value;
    bool is_var = false;
    Span declared;
};

// Names of one block, function call or module. Blocks have few, which are searched; modules have an
// index.
struct Frame {
    std::uint32_t parent = 0; // itself for the outermost
    std::vector<Binding> bindings;
    std::unique_ptr<std::unordered_map<Symbol, std::uint32_t>> index; // of a module
    // Of a block of many names: the last binding of each, of the first `indexed` bindings.
    std::unordered_map<Symbol, std::uint32_t> last_of;
    std::size_t indexed = 0;
    bool captured = false; // a closure refers to it
};

// A function value with the frame it was made in.
struct Closure {
    const File *ast = nullptr;
    lang::FunctionId function;
    std::uint32_t frame = 0; // where it was made
    std::uint32_t module = 0;
    bool in_field = false; // made while a field was evaluated: may hold a point's numbers
    bool library = false;
};

// A declaration of the prelude, whose text is read when its name is first used.
struct LibraryItem {
    std::uint32_t module = 0;
    std::uint32_t begin = 0, end = 0; // in the module's text
};

// A file or a part of the library that can be imported.
struct Module {
    std::string identity, name;
    SourceId source;
    const File *ast = nullptr;
    std::uint32_t frame = 0;
    bool library = false;
    bool loaded = false;
    Span import_place; // the first import of it
    bool lacks_names =
        false; // an import into it failed, so that nobody knows what it would have brought
};

// A statement about the whole scene (camera, lights, background, …).
struct Setting {
    enum class Kind { Camera, Light, Lighting, Background, Render, Keep } kind;
    ir::Camera camera;
    ir::Light light;
    ir::Lighting lighting;
    ir::NodeId background;
    ir::RenderSettings render;
    std::string keep;
};

// One call as a builtin sees it: where things stand, for its errors.
struct CallSite {
    std::string_view name;
    Span call;
    Span callee;
    std::vector<Span> args; // one per parameter; of the call where the argument was left out
    Span arg(std::size_t i) const { return i < args.size() ? args[i] : call; }
};

// A parameter of a builtin.
struct BuiltinParameter {
    std::string name;
    bool optional = false;
    bool lists = false;    // of the rest: each is a list itself
    bool is_angle = false; // in radians
};
// A function that the language cannot say itself.
struct Builtin {
    std::string name;
    std::vector<BuiltinParameter> parameters;
    bool variadic = false; // the last parameter takes a block, a list, or all further arguments
    bool library_only = false;
    Value (*call)(Interpreter &, const CallSite &, std::vector<Value> &) = nullptr;
    std::string signature, doc; // for `fathom doc`
    bool computes = false;      // with its arguments, so that at field time none may be infinite
};

// How a statement list was left before its end, as conditions that may be nodes (Bool or a Field of
// Bool).
struct Exit {
    Value returned = boolean(false);
    Value value; // where returned
    Value broke = boolean(false);
};

// How a block ended, and its value.
struct Outcome {
    Value value = unit(); // of the last expression
    Exit exit;
};

// The value that an assignment overwrote.
struct JournalEntry {
    std::uint32_t frame, slot;
    Value old;
};

// Calls in progress, for errors inside the library (shown at the user's call) and for the notes of
// others.
struct ActiveCall {
    std::string_view name;
    Span call;
    bool library = false; // the callee is the library's
    std::uint32_t module = 0;
};

// Hash of a list of words.
struct HashOfWords {
    std::size_t operator()(const std::vector<std::uint64_t> &words) const {
        std::uint64_t h = words.size();
        for (std::uint64_t word : words) {
            h = (h ^ word) * 0x9e3779b97f4a7c15ull;
            h ^= h >> 29;
        }
        return h;
    }
};

// A function called with graph nodes: the ir::Function made for it.
struct Specialization {
    ir::FunctionId function;
    Value shape_of_result; // a Field or constant: kind and colour of what it returns
    std::vector<ir::NodeId> params;
    std::vector<ir::Condition> conditions{}; // over these
};

// A shape that a loop made: what its body gives with the iteration's number left open, and that
// number, the innermost loop's first (iterations.cpp).
struct LoopVariable {
    ir::NodeId node; // Int: 0, 1, …
    int count = 0;
};
struct Iteration {
    ir::ShapeId symbolic;
    std::vector<std::pair<std::uint32_t, int>> at; // index into Interpreter::loop_variables
};

// All state of one evaluation.
struct Interpreter {
    Sources &sources;
    Diagnostics &diagnostics;
    const std::vector<LibraryFile> &library;
    const Loader &loader;
    const Options &options;
    ir::Scene scene{};

    // names
    std::unordered_map<std::string, Symbol> symbols{};
    std::vector<std::string> symbol_names{};
    std::deque<File> files{};
    std::vector<Frame> frames{}; // the first `frame_count`; the rest keep their storage
    std::uint32_t frame_count = 0;
    std::vector<std::optional<std::vector<Formal>>> builtin_formals{};
    std::uint32_t prelude_frame = 0;
    std::unordered_map<Symbol, std::vector<LibraryItem>> prelude_items{}; // not yet read
    std::vector<Module> modules{};
    std::uint32_t current_module = 0;
    std::vector<std::uint32_t> importing{}; // modules being loaded, for cycles

    // values
    std::vector<std::string> strings{};
    std::deque<std::vector<Value>> lists{};
    std::vector<std::uint16_t> list_heights{}; // by list: 1, or more than its tallest element
    int list_height = 0;                       // the tallest of all
    std::vector<std::array<double, 16>> matrices{};
    std::vector<Closure> closures{};
    std::vector<ir::Material> materials{};
    std::vector<ir::Region> regions{};
    std::vector<Setting> settings{};

    // evaluation
    std::vector<JournalEntry> journal{};
    int journaling = 0;
    std::vector<ActiveCall> calls{};
    int depth = 0;                            // nested evaluations, of any kind
    const char *stack_end = nullptr;          // evaluation goes no deeper than this address
    Exit *leaving = nullptr;                  // of the declaration whose value, an `if`, comes next
    int in_field = 0;                         // > 0 while a field's body is evaluated
    std::optional<std::size_t> field_start{}; // … and how many nodes there were before it
    bool own_field = false;                   // … and the outermost one is not the library's
    int quiet = 0; // > 0: errors are counted, not reported (overload resolution, trial loops)
    std::size_t quiet_errors = 0, evaluations = 0;
    std::size_t made = 0; // bytes of what the arenas below do not count themselves: see `held`
    bool out_of_budget = false;
    std::size_t names_compared = 0;
    std::vector<std::pair<Symbol, Span>> hiding{}; // the user's functions named as the library's
    std::map<std::pair<std::uint32_t, std::string>, Span> unknown_names{}; // by file, as first told
    std::map<std::vector<std::uint64_t>, Specialization> specializations{};
    std::unordered_map<ir::NodeId, ir::NodeId> told_apart{}; // numbers, as ops read them that do so
    std::unordered_map<std::vector<std::uint64_t>, Value, HashOfWords> remembered{};
    std::map<std::pair<const File *, std::uint32_t>, bool>
        never_specialize{}; // functions seen to give no number
    std::map<std::pair<const File *, std::uint32_t>, int>
        specialized{}; // how often; far below 0: the body has to know its numbers
    std::map<std::string, std::uint32_t> interned_records{}; // libraries, regions, … by content
    std::vector<ir::NodeId> param_nodes{};                   // by Scene::params
    std::unordered_map<std::uint32_t, bool> only_shapes{};
    std::map<ir::ShapeId, std::vector<std::array<double, 2>>>
        corners{};   // of polygons' fields, where known
    Assets assets{}; // images and grids
    std::vector<LoopVariable> loop_variables{};
    std::unordered_map<std::uint32_t, Iteration> iterations{}; // by ShapeId
    int symbolic_iterations = 0;                               // > 0 while one runs
    std::set<std::array<std::uint32_t, 6>> reported{}; // code and places, so that each is said once
    std::vector<std::string> usage_errors{};
};

// The limits that bound what a scene can make the checker do, beside those of base/limits.def, which
// a user can raise; stated in docs/limits.md.
constexpr int max_call_depth = 1000;
constexpr int max_depth = 40000; // nested evaluations, as far as the stack reaches
constexpr int max_list_height = 256;
constexpr std::size_t max_shape_height = 1000; // passes over shapes go as deep
constexpr int max_unrolled = 4096;
constexpr std::size_t max_remembered = 100'000; // calls of the library
constexpr int max_loop_iterations = 100'000;
constexpr int max_known_sets = 8; // of one function's arguments that its body is made for

// -- names.cpp
Symbol intern(Interpreter &ev, std::string_view text);
std::uint32_t push_frame(Interpreter &ev, std::uint32_t parent);
void pop_frame(Interpreter &ev, std::uint32_t frame);
// Says of those of `hiding` so that an error names.
void tell_hiding_functions(Interpreter &ev);
void declare(Interpreter &ev, std::uint32_t frame, Symbol name, Value value, bool is_var,
             Span place);
struct Found {
    std::uint32_t frame = 0, slot = 0;
};
std::optional<Found> find_name(Interpreter &ev, std::uint32_t frame, Symbol name);
std::optional<Value> look_up(Interpreter &ev, std::uint32_t frame, Symbol name);
std::optional<std::uint32_t> slot_in_module(Interpreter &ev, std::uint32_t frame, Symbol name);
bool is_builtin(Symbol name);
inline Symbol symbol_of(const File &file, const lang::Identifier &name) {
    return file.symbols[name.word];
}
inline Symbol symbol_of(const File &file, const lang::Name &name) {
    return file.symbols[name.word];
}
std::vector<std::string> visible_names(Interpreter &ev, std::uint32_t frame);
std::string way_inside(std::string_view path); // how a file elsewhere can be read
void check_names(Interpreter &ev, const File &ast, std::uint32_t module_frame);

// -- report.cpp
Diagnostic &report(Interpreter &ev, Code code, Span place, std::string message);
Span users_place(const Interpreter &ev, Span place);     // his own call, of one in the library
bool is_library_place(const Interpreter &ev, Span span); // or no place at all
std::string describe(const Interpreter &ev, const Value &value);    // "a float", "a list of 3"
std::string type_of(const Interpreter &ev, const Value &value);     // "float", "(x) -> shape"
std::string print_value(const Interpreter &ev, const Value &value); // for print(…)
// Counts steps of work; false once they or the memory are gone, which is reported once.
bool spend(Interpreter &ev, Span place, std::size_t amount = 1);
// Whether so many bytes more may be made; where not, it is reported once. Counts nothing.
bool has_room(Interpreter &ev, Span place, std::size_t bytes);
std::size_t bytes_of_long_field(const Interpreter &ev); // what proof and tapes will take of it
Room room_left(const Interpreter &ev);

// -- numeric.cpp: numbers of both stages
bool is_numeric(const Value &v); // Bool, Int, Float, Vec, Mat, Field
ir::Type numeric_type(const Interpreter &ev, const Value &v);
bool is_scalar(const Interpreter &ev, const Value &v); // Int or Float, known or not
ir::NodeId to_node(Interpreter &ev, const Value &v);   // of a numeric value
Value from_node(Interpreter &ev, ir::NodeId node,
                bool color = false); // constants come back as known numbers
// The value of an op of known numbers, of its arguments' types; nothing where one is not known.
std::optional<Value> folded(ir::Op op, ir::Type type, std::span<const Value> args, bool is_color);
Value apply_op(Interpreter &ev, ir::Op op, std::vector<Value> args, Span place,
               std::string_view name);
Value arithmetic(Interpreter &ev, lang::BinaryOp op, const Value &a, const Value &b, Span place,
                 Span a_place, Span b_place);
Value negate(Interpreter &ev, const Value &v, Span place);
Value logical_and(Interpreter &ev, const Value &a, const Value &b);
Value logical_or(Interpreter &ev, const Value &a, const Value &b);
Value logical_not(Interpreter &ev, const Value &a);
std::optional<Value> select_value(Interpreter &ev, const Value &condition, const Value &a,
                                  const Value &b);
Value swizzle(Interpreter &ev, const Value &v, std::string_view letters, Span place);
std::optional<std::vector<int>> swizzle_indices(std::string_view letters, int size);
Value make_vector(Interpreter &ev, const std::vector<Value> &parts, int size, Span place);
std::optional<Value> element_as_known(Interpreter &ev, const Value &v, Span place,
                                      What what); // scene time demanded
Value to_float(Interpreter &ev, const Value &v);

// -- range.cpp: which numbers there are
bool is_infinite(Interpreter &ev, Value v); // a known number, or one of a known vector's
// What was computed of the numbers `of`: 0 where it is smaller than single precision holds, and
// refused where it is larger or none. Infinite it may be where one of those is.
Value in_range(Interpreter &ev, Value v, std::span<const Value> of, Span place);
// The same, where `of` may not be infinite if the result is only known at field time.
Value computed(Interpreter &ev, const Value &v, std::span<const Value> of, Span place, What what);
bool finite_number(Interpreter &ev, const Value &v, Span place, What what); // else reported
// What a shape or a setting may be made of: numbers up to `longest`, 0 where they are below
// `shortest` (base/single.h). Poison after a report.
Value sized(Interpreter &ev, Value v, Span place, What what);
std::optional<ir::NodeId> node_in_range(Interpreter &ev, ir::NodeId node, Span place);

// -- facts.cpp
std::vector<NameFact> name_facts(const Interpreter &ev, std::uint32_t frame, SourceId source);

// -- convert.cpp: types as written, and conversions
Value convert(Interpreter &ev, const Value &v, const lang::TypeExpr &type, Span place, What what,
              bool &ok);
bool accepts(Interpreter &ev, const Value &v, const lang::TypeExpr &type);
std::string type_text(const lang::TypeExpr &type);
bool check_type(Interpreter &ev, const lang::TypeExpr &type); // reports a name that is none
// Which numbers are wanted: those that make shapes (`sized`), all that are finite, or `inf` too.
enum class Limit { Size, Finite, None };
std::optional<double> want_known_number(Interpreter &ev, const Value &v, Span place, What what,
                                        Limit limit = Limit::Size);
std::optional<int> want_known_int(Interpreter &ev, const Value &v, Span place, What what);
std::optional<bool> want_known_bool(Interpreter &ev, const Value &v, Span place, What what);
std::optional<std::string> want_string(Interpreter &ev, const Value &v, Span place, What what);
std::optional<ir::NodeId> want_scalar_node(Interpreter &ev, const Value &v, Span place, What what,
                                           Limit limit = Limit::Size);
std::optional<ir::NodeId> want_vec_node(Interpreter &ev, const Value &v, int size, Span place,
                                        What what, Limit limit = Limit::Size);
std::optional<ir::NodeId> want_color_node(Interpreter &ev, const Value &v, Span place, What what);
std::optional<ir::ShapeId> want_shape(Interpreter &ev, const Value &v, Span place, What what,
                                      int dims = 0);
std::optional<std::vector<Value>> want_list(Interpreter &ev, const Value &v, Span place, What what);
std::optional<std::vector<ir::ShapeId>> want_shapes(Interpreter &ev, const Value &v, Span place,
                                                    What what, int &dims);
Value region_value(Interpreter &ev, ir::Region region, int dims = 3); // 2: of flat shapes alone
std::optional<ir::Material> want_material(Interpreter &ev, const Value &v, Span place, What what);
Value list_value(Interpreter &ev, std::vector<Value> items);
Value string_value(Interpreter &ev, std::string text);
bool is_function(const Value &v);
// Where a colour is wanted: `tan` is one beside GLSL's function; every other value is itself.
Value or_color(const Value &v);

// -- expressions.cpp, statements.cpp
Value eval(Interpreter &ev, const File &ast, lang::ExprId expr, std::uint32_t frame);
Outcome run_block(Interpreter &ev, const File &ast, lang::BlockId block,
                  std::uint32_t frame); // as an expression
struct Contribution {
    Value value;
    Span span;
};
// Every expression of the block contributes; true where a `break` ended it. The frame is already
// pushed.
bool contribute_block(Interpreter &ev, const File &ast, lang::BlockId block, std::uint32_t frame,
                      std::vector<Contribution> &out);
// Statements that declare or act the same wherever they stand: let, var, assignment, fn. False for
// all others.
bool run_simple(Interpreter &ev, const File &ast, const lang::Stmt &stmt, std::uint32_t frame);
void run_assign(Interpreter &ev, const File &ast, const lang::Assign &node, Span place,
                std::uint32_t frame); // assignment.cpp, as is the journal
Outcome run_if(Interpreter &ev, const File &ast, const lang::If &node, std::uint32_t frame,
               Span place);
// The value of an `if`. Its arms leave the body only where a declaration takes what they leave by.
Value value_of_if(Interpreter &ev, const File &ast, const lang::If &node, Span place,
                  std::uint32_t frame);
// A function with the frame that its free names are read in.
Value make_closure(Interpreter &ev, const File &ast, lang::FunctionId function,
                   std::uint32_t frame);
void hoist_functions(Interpreter &ev, const File &ast, lang::BlockId block, std::uint32_t frame);
std::optional<std::vector<Value>> sequence_items(Interpreter &ev, const Value &v, Span place);
bool may_list(Interpreter &ev, Span place, std::size_t count); // so many elements; else reported
void assign(Interpreter &ev, std::uint32_t frame, std::uint32_t slot, Value value);

// -- loops.cpp: loops over numbers that are not known
Outcome run_for(Interpreter &ev, const File &ast, const lang::For &node, std::uint32_t frame,
                Span place);
Outcome run_while(Interpreter &ev, const File &ast, const lang::While &node, std::uint32_t frame,
                  Span place);
// Runs `rest` and keeps what it assigned only where `skip` is false.
Exit run_unless(Interpreter &ev, const Value &skip, Span place, const std::function<Exit()> &rest);
// The journal keeps what assignments overwrite, so that a trial can be undone and two arms can be
// merged.
struct JournalMark {
    std::size_t entries = 0, frames = 0;
};
JournalMark journal_mark(Interpreter &ev);
struct Change {
    std::uint32_t frame, slot;
    Value before, after;
};
// What changed since the mark in frames that stood then; every change is undone.
std::vector<Change> journal_take(Interpreter &ev, JournalMark mark);

// -- calls.cpp
struct Argument {
    const lang::Identifier *name = nullptr; // none: by its place
    Symbol symbol = 0;                      // of the name
    Value value;
    Span span;
    bool trailing = false;      // the block behind the call: belongs to the last parameter
    bool plain_literal = false; // a number without a unit, or a list of such
};
Value call_value(Interpreter &ev, const Value &callee, std::string_view name,
                 std::span<const Argument> args, Span call, Span callee_span);
Value call_with(Interpreter &ev, const Value &callee, const std::vector<Value> &args,
                Span place); // positional
Value eval_call(Interpreter &ev, const File &ast, lang::ExprId expr, const lang::Call &call,
                std::uint32_t frame);
int parameter_count(Interpreter &ev, const Value &function); // -1: any

// One node for a call of a library shape: its name and numbers, with the claims that its body made
// (semantics.md, 12).
Value library_shape(Interpreter &ev, ir::Library library, const Value &body, Span origin);
// Indices into Shapes::regions and Shapes::materials.
std::uint32_t intern_region(Interpreter &ev, const ir::Region &region);
std::uint32_t intern_material(Interpreter &ev, const ir::Material &material);

// -- fields.cpp: functions of the point
// The field as an expression of `point` (and `normal`), a graph node of one of `types`.
std::optional<ir::NodeId> apply_field(Interpreter &ev, const Value &field,
                                      const std::vector<ir::NodeId> &inputs, ir::Type result,
                                      Span place, What what, bool *is_color = nullptr);
// The same of the point alone, whatever it gives: a float or a vec3.
std::optional<ir::NodeId> apply_any(Interpreter &ev, const Value &field, Span place, What what);

// -- builtins: one table of all that the language itself cannot say
const std::vector<Builtin> &builtins();
void add_numeric_builtins(std::vector<Builtin> &table);
void add_list_builtins(std::vector<Builtin> &table);
void add_shape_builtins(std::vector<Builtin> &table);
void add_transform_builtins(std::vector<Builtin> &table);
void add_region_builtins(std::vector<Builtin> &table);
void add_scene_builtins(std::vector<Builtin> &table);
void add_texture_builtins(std::vector<Builtin> &table);

// -- modules.cpp
Value import_module(Interpreter &ev, const lang::Import &import, Span place,
                    std::uint32_t importer);
void load_prelude(Interpreter &ev);
void declare_colors(Interpreter &ev); // css_colors.cpp: the named ones, in the prelude
void read_prelude_items(Interpreter &ev, Symbol name); // declares what the library has of this name
void make_module_frame(Interpreter &ev, std::uint32_t frame);
const File &parse_file(Interpreter &ev, SourceId source, Diagnostics &diagnostics);
void declare_param(Interpreter &ev, const File &ast, const lang::Param &param, std::uint32_t frame);
// Every module's file: declares its names, in its frame, and gathers what it contributes.
void run_module(Interpreter &ev, std::uint32_t module, std::vector<Contribution> &out);

} // namespace fathom::typecheck
