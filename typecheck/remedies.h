// What is proposed where a name, an argument or a call is one of another language: what it is here,
// and the edits that make it so. Private to typecheck.
#pragma once

#include "typecheck/binding.h"

namespace fathom::typecheck {

// What other languages and libraries call what is here; empty: nothing is known.
std::string_view name_from_elsewhere(std::string_view name);
// The same of types.
std::string_view type_from_elsewhere(std::string_view name);
// How that is done here which they have a name for and the library has not; empty: nothing is known.
std::string_view way_from_elsewhere(std::string_view name);

// For the arguments of a call, by index, whose names its function does not have.
Fix remedy_of_arguments(Interpreter &ev, std::string_view function, std::span<const Formal> formals,
                        std::span<const Argument> args, const std::vector<std::size_t> &unknown,
                        Span callee);

// For an argument that is given by its place and by its name: the name's value, in its place.
Fix remedy_of_duplicate(Interpreter &ev, std::string_view function, std::span<const Argument> args,
                        const Argument &named, Span call);

// For numbers in a row where one vector is wanted; the edits only where they are as many.
Fix remedy_of_row(std::span<const Argument> row, int vector_size);

// True, and reported, where the shape of a call stands behind what should follow it, or before what
// should lead: `translate([1, 0, 0], s)`, `smooth_union(a, b, 0.1)`.
bool shape_out_of_place(Interpreter &ev, std::string_view name, const lang::Function &function,
                        std::span<const Formal> formals, std::span<const Argument> args, Span call);

// For a value of another type than is wanted.
void help_with_value(Interpreter &ev, Diagnostic &d, const Value &v, lang::TypeName wanted,
                     Span place);

// For what is no shape, in a difference of shapes.
void help_with_cut(Diagnostic &d, const Value &cut);

// True, and reported, where a body ends with a `let`, `var` or assignment: its writer took that for
// its value.
bool report_unfinished(Interpreter &ev, const Closure &c, const lang::Function &f,
                       std::string_view name);

} // namespace fathom::typecheck
