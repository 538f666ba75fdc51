// Where the user wrote what his own fields compute, for messages of the proof (ir::Scene::places).
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// Keeps the place of an operation that may jump or be infinite, the first few thousand of them; of a
// choice it is that of its condition. Outside of fields, and of the library's, nothing is kept.
void note_place(Interpreter &ev, const Value &value, Span place);
// A variable's last value; keeps of the loops that give it the place of what stands before their
// body.
ir::NodeId with_noted_loops(Interpreter &ev, ir::NodeId last, Span head);

} // namespace fathom::typecheck
