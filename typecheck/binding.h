// Which argument of a call goes to which parameter. Private to typecheck.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// What binding found for a parameter.
struct Given {
    Value value;
    Span span; // of the callee where nothing was given
    bool given = false;
    bool plain_literal = false;
};

// By place, then by name; what is left over goes to a last parameter that takes it. Nothing where
// an argument is wrong, which is reported.
std::optional<std::vector<Given>> bind_arguments(Interpreter &ev, std::string_view name,
                                                 std::span<const Formal> formals,
                                                 std::span<const Argument> args, Span call,
                                                 Span callee);

// A function's parameters, made once.
std::span<const Formal> formals_of(Interpreter &ev, const Closure &c);
std::span<const Formal> formals_of(Interpreter &ev, const Builtin &builtin);

// Warns where a plain literal for an angle looks like degrees.
void warn_of_degrees(Interpreter &ev, const Formal &formal, const Given &given, const Value &v);

} // namespace fathom::typecheck
