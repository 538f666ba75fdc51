// Running the body of a function: evaluated for one call, or made once into a function of the graph
// for all calls with numbers that are known only at field time. Private to typecheck.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// Evaluates the body; `values` are bound, converted and checked.
Value run_closure(Interpreter &ev, const Value &callee, std::string_view name,
                  std::span<const Value> values, Span call);

// A call with numbers of field time: the body becomes a function of the graph, made once for each
// set of known arguments. Where these sets are many (a shape's sizes, in a loop), known floats and
// vectors are passed too, so that like shapes call one function; unless the body has to know them.
// Nothing where no number is of field time, or the body cannot be such a function.
std::optional<Value> specialized(Interpreter &ev, const Value &callee, std::string_view name,
                                 std::span<const Value> known, Span call);

// A call of a closure: binds, converts and checks the arguments first (calls.cpp).
Value call_closure(Interpreter &ev, const Value &callee, std::string_view name,
                   std::span<const Argument> args, Span call, Span callee_span);

// A call of a function of several forms: of the one that takes the arguments as they are, else of the
// first that takes them (forms.cpp).
Value call_overloads(Interpreter &ev, const Value &callee, std::string_view name,
                     std::span<const Argument> args, Span call, Span callee_span);

// Appends words that are the same for values that mean the same to a body.
void key_of(Interpreter &ev, const Value &v, std::vector<std::uint64_t> &key);

} // namespace fathom::typecheck
