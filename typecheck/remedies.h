// What is proposed where a name, an argument or a call is one of another language: what it is here,
// and the edits that make it so. Private to typecheck.
#pragma once

#include "typecheck/binding.h"

namespace fathom::typecheck {

// What a name stands for where it is used: a value, or what is called, perhaps of an object.
enum class Use { Value, Called };
struct Wanted {
    Use use = Use::Value;
    const Value *object = nullptr;
    const File *ast = nullptr; // whose top may bind the name further down
};

// The name that another is likely to be meant for; empty: none.
std::string likely_name(Interpreter &ev, std::uint32_t frame, std::string_view name,
                        const Wanted &wanted);
void report_unknown_name(Interpreter &ev, std::uint32_t frame, std::string_view name, Span place,
                         const Wanted &wanted);
// Whether an unknown type was told elsewhere in the file; then its edit is for this place too.
bool type_told_before(Interpreter &ev, std::string_view name, Span place);
// Whether so many names more may be compared with one that nobody declared: a text of nothing else
// has thousands of them, and only the first are worth a suggestion.
bool may_compare_names(Interpreter &ev, std::size_t count);
// Whether a name may be one that a file which could not be read would have brought. Short names are
// near to others by chance.
bool lacking(const Interpreter &ev, std::string_view name, const std::string &near);
// Adds what does to shapes what the name makes one expect, where something does: to an error about
// a shape that was given to what takes none.
void help_with_shape(Diagnostic &d, std::string_view name);
// Of `render(s)`, which some write to have a picture.
void help_with_rendered(const Interpreter &ev, Diagnostic &d, Span shape);
// The same of a call whose arguments are known: `min(a, b)` of shapes as a union.
void help_with_shapes(const Interpreter &ev, Diagnostic &d, const CallSite &site,
                      std::span<const Value> args);

// What a shape's method elsewhere does that a scene has no need of, as `.save("x.stl")`: it can be
// left away.
bool is_needless_method(std::string_view name);

// Reports a member that a value does not have: `list.length`, `shape.radius`.
void report_unknown_member(Interpreter &ev, const Value &object, const File &ast,
                           const lang::Member &member, Span place);
// How a shape is changed of which others set a part, as `s.position`; empty: nothing is known.
std::string_view way_of_part(std::string_view part);
// For `s.radius`: the number that `s` was made with as a name of its own, in all places, and in
// words. Empty where that is not plain.
std::vector<Edit> part_of_shape(Interpreter &ev, const File &ast, const lang::Member &member,
                                std::string &made_of);
// True, and reported, where a method is another library's and its name a function here:
// `s.material("gold")`, `random.uniform(0, 1)`.
// Where a value of the file hides the library's function that is called: another name for the value.
bool help_with_hidden(Interpreter &ev, Diagnostic &d, std::string_view name, Span callee);
// A value of the file that bears the name of the member, and how the shape is given it.
struct OwnValue {
    std::string message, call;
};
OwnValue own_value(Interpreter &ev, const File &ast, std::string_view name);
void report_needless_range(Interpreter &ev, const File &ast, const lang::Param &param);
bool is_vector_by_numbers(std::span<const Formal> formals, std::size_t i, std::size_t numbers);
bool is_foreign_method(Interpreter &ev, const Value &object, const File &ast,
                       const lang::Member &member, const lang::Call &call, Span place);
// For `Vector3.up`, `Vec3.ZERO` of engines; an empty message: it is not that.
Fix constant_of_vector(const Interpreter &ev, std::string_view name, Span place);
// `_Time.y` of Unity's shaders, `_SinTime.w`: by `time`, wherever the text has one.
Fix clock_of_unity(const Interpreter &ev, std::string_view name, Span place);
// For `l.push(x)` in a loop, `l.forEach(f)`, `l.sum()`: what does the same. Empty where that is not
// plain.
std::vector<Edit> edits_of_list_method(const Interpreter &ev, const File &ast,
                                       const lang::Member &member, const lang::Call &call,
                                       Span place);
// The edits that make one text of another and leave what both have in that order.
std::vector<Edit> least_edits(const Interpreter &ev, Span place, std::string_view written);
// `-s` of a shape.
void report_negated_shape(Interpreter &ev, Span place, Span operand);
// For a function that should be of the point, and has a parameter for each of its parts; and for one
// that gives a condition where a distance is wanted.
void help_with_parts(const Interpreter &ev, Diagnostic &d, const Value &field, Span place);
void help_with_condition(const Interpreter &ev, Diagnostic &d, Span place);

// A name in small letters without `_`; and that, also without what libraries put before and behind
// the names of all things of a kind, as `makeCube` and `SphereGeometry`.
std::string plain_name(std::string_view name);
std::vector<std::string> names_within(std::string_view name);
// What other languages and libraries call what is here; empty: nothing is known.
std::string_view name_from_elsewhere(std::string_view name);
// The same of types.
std::string_view type_from_elsewhere(std::string_view name);
// How such types are written here; empty: nothing is known.
std::string_view way_of_type(std::string_view name);
// How that is done here which they have a name for and the library has not; empty: nothing is known.
std::string_view way_from_elsewhere(std::string_view name);

// Where no table knows a thing (last_remedies.cpp). What there is for values of that kind; empty:
// nothing is known.
std::string_view what_there_is(const Value &object);
// For a function where its value is wanted: the call, which is the edit where it needs no argument.
void help_with_uncalled(Interpreter &ev, Diagnostic &d, const Value &v, Span place);
// `sphere {1}`: reports a block behind a call whose last parameter is no list of shapes.
bool told_of_block(Interpreter &ev, const Value &v, Span place, What what);
// A call as it should be: the one in the description of the library's function, or made up for what
// changes a shape; empty: none.
std::string example_of(Interpreter &ev, std::string_view name, std::span<const Formal> formals);
// For one argument too many, the last, that is a colour or a material; false: it is not that.
bool help_with_paint(const Interpreter &ev, Diagnostic &d, std::span<const Formal> formals,
                     std::span<const Argument> args);
// For a solid that is given its place, its corners or its ends (place_remedies.cpp): false where it is not.
bool help_with_place(Interpreter &ev, Diagnostic &d, std::string_view name,
                     std::span<const Formal> formals, std::span<const Argument> args);
// For `box(min: a, max: b)`; no edits: it is not that.
Fix remedy_of_corners(const Interpreter &ev, std::string_view name, std::span<const Formal> formals,
                      std::span<const Argument> args);
// For an argument too many: it goes, where it is the last and all are sound.
void leave_last_away(const Interpreter &ev, Diagnostic &d, std::span<const Argument> args,
                     const Argument &first);
// `union()(a, b)`: the arguments stand in the first parentheses.
void help_with_second_call(const Interpreter &ev, Diagnostic &d, Span call);
// For `x`, `y`, `z` that nobody declared: a part of the point, or half of space where it is compared
// in a call. An empty message: neither.
Fix part_of_point(const Interpreter &ev, const std::string &name, Span place);
// `translate(x, 1)`: the name of an argument, with a comma behind it.
Fix name_before_value(Interpreter &ev, std::uint32_t frame, const std::string &name, Span place);
// For `sphere(2)`, `box([4, 2, 4])` or a number in the place of a region: the region that is as large.
void help_with_region(const Interpreter &ev, Diagnostic &d, const Value &v, Span place);
// For a number with a fraction where a whole one is wanted.
void help_with_whole(const Interpreter &ev, Diagnostic &d, const Value &v, Span place);
// `union(a, b, smooth: 0.2)`, `union(r: 2) { a; b }`: the smooth form, without the edit that leaves a
// last argument away; no edits: it is not that.
Fix smooth_form(const Interpreter &ev, std::string_view function, std::span<const Argument> args,
                std::size_t at, Span callee);
// An assignment to a name that nobody declared; without a place where it is to a part of it. Whether
// it was told to be the name's declaration.
bool report_undeclared(Interpreter &ev, std::string_view name, Span at, Span assignment,
                       bool in_body);
// numpy's `axis` of functions that take one vector here.
bool chooses_rows(std::string_view function, std::string_view argument);
// For a vec3 where a vec2 is wanted.
void help_with_plane(const Interpreter &ev, Diagnostic &d, Span place);
// Reports that something else was wanted there (convert.cpp), with the way to it.
void want(Interpreter &ev, const Value &v, Span place, What what, std::string_view wanted);
// For what is no shape beside `|` or `&`.
void help_with_operand(Interpreter &ev, Diagnostic &d, const Value &v, bool united, Span place);
// The `p` of GLSL's `sdBox(p, size)`, with its comma, in a call of one of the library's shapes.
std::optional<Edit> point_of_shape(Interpreter &ev, std::uint32_t frame, Span place);
// A type with the sign before it, to be left away.
std::vector<Edit> type_away(const Interpreter &ev, Span type);
// `list(…)`, `Some(…)`, `str("r = ", r)`, `show(s)`: a call that can be left away.
Fix without_call(const Interpreter &ev, const std::string &name, Span place);
// `THREE.Vector3(1, 2, 3)`, of a module that is none: the library's function alone.
Fix without_qualifier(Interpreter &ev, std::uint32_t frame, const std::string &name, Span place);

// What stands in the text there; an operand in parentheses where operators stand in it; an argument
// with its name.
std::string source_text(const Interpreter &ev, Span span);
std::string operand_source(const Interpreter &ev, Span span);
Span whole_argument(const Argument &a);

// Where arguments have `=` behind their names, what puts that right joins the other edits of the
// call, so that they can all be applied; the report of it goes.
void join_sign_edits(Interpreter &ev, std::span<const Argument> args, Fix &fix);

// For a name of a scene that is given another value: `let f2 = …`, and `f2` from there on. Empty
// where it is not plain.
std::vector<Edit> renamed_from(const Interpreter &ev, const File &ast, const lang::Assign &node,
                               std::string_view name, std::string &fresh);

// For the arguments of a call, by index, whose names its function does not have.
Fix remedy_of_arguments(Interpreter &ev, std::string_view function, std::span<const Formal> formals,
                        std::span<const Argument> args, const std::vector<std::size_t> &unknown,
                        Span callee);

// Where the call ends whose last argument this is, behind its `)`; nothing where a block follows.
std::optional<Span> behind_call(const Interpreter &ev, Span last);
// An argument with the comma that it needs no more.
Span with_comma(std::span<const Argument> args, std::size_t at, Span callee);

// Another function in place of the one that is called: for `slab(z0: 0, z1: 1)`, for
// `cylinder(h: 2, r1: 1, r2: 0.5)`; and of the shape with round edges, empty: none.
bool slab_between(const Interpreter &ev, std::span<const Argument> args,
                  std::span<const std::size_t> unknown, Fix &fix);
bool cone_between(const Interpreter &ev, std::span<const Argument> args,
                  std::span<const std::size_t> unknown, Span callee, Fix &fix);
std::string_view rounded_form(std::string_view function, std::string_view argument);

// Shapes that lie along Y and take no axis; the names that others have for one; an axis as it is
// written here, also of `"z"`, empty: none.
bool lies_along_y(std::string_view function);
bool names_an_axis(std::string_view argument);
std::string axis_text(const Interpreter &ev, const Value &v, Span span);

// The variable of the innermost loop, or of the function without a name, around a place; empty:
// none.
std::string loop_variable(const Interpreter &ev, Span place);
// What a random number there may be made of: a loop's variable, else a number that no other has.
std::string seed_text(const Interpreter &ev, Span place);
// For the point's name in an argument where a function is wanted: `p => ` before that.
std::optional<Edit> point_edit(const Interpreter &ev, const std::string &name, Span place,
                               std::string &function);

// For an argument that is given by its place and by its name: the name's value, in its place.
Fix remedy_of_duplicate(Interpreter &ev, std::string_view function, std::span<const Argument> args,
                        const Argument &named, Span call);

// `sphere(1)..translate(x: 2)`, of which the shape stands at `from`.
Value report_two_dots(Interpreter &ev, Span from, Span to);

// For numbers in a row where one vector is wanted; the edits only where they are as many, or two
// for a place.
Fix remedy_of_row(std::span<const Argument> row, int vector_size, bool place = false);

// True, and reported, where the shape of a call stands behind what should follow it, or before what
// should lead: `translate([1, 0, 0], s)`, `smooth_union(a, b, 0.1)`.
bool shape_out_of_place(Interpreter &ev, std::string_view name, const lang::Function &function,
                        std::span<const Formal> formals, std::span<const Argument> args, Span call);

// True, and reported, where numbers alone are given to what changes a shape, `translate(1, 0, 0)`;
// or a vector of angles to `rotate`.
bool no_shape_before(Interpreter &ev, std::string_view name, const lang::Function &function,
                     std::span<const Argument> args, Span callee);

// ": `count:` or `copies:`", the names of the few formals that have no value.
std::string names_left(std::span<const Formal> formals, std::span<const Given> given);

// True, and reported, where a material is given as a string: `s.paint("red")`.
bool color_in_quotes(Interpreter &ev, std::string_view name, std::span<const Formal> formals,
                     std::span<const Given> given);

// Warns of a colour whose three parts are whole numbers up to 255.
void warn_of_bytes(Interpreter &ev, Span place, std::span<const Value> parts);

// For a value of another type than is wanted.
void help_with_value(Interpreter &ev, Diagnostic &d, const Value &v, lang::TypeName wanted,
                     Span place);

// The edit of one sign between two operands for another; none where what follows binds tighter.
std::vector<Edit> sign_edit(const Interpreter &ev, Span a, Span b, char sign,
                            std::string_view ours);

// For what is no shape, in a difference of shapes.
void help_with_cut(Diagnostic &d, const Value &cut);

// True, and reported, where a body ends with a `let`, `var` or assignment: its writer took that for
// its value.
bool report_unfinished(Interpreter &ev, const Closure &c, const lang::Function &f,
                       std::string_view name);

// Reports a `var` outside of functions.
void report_var_at_top(Interpreter &ev, const File &ast, const lang::Var &var, Span place);
// Of a statement within a user's function that is not the last: `fold(p, 2);` does nothing.
void tell_dropped_value(Interpreter &ev, const File &ast, lang::ExprId id, const Value &v);

} // namespace fathom::typecheck
