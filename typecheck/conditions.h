// What `require` was told while something was tried: in a loop's body, a function's, an arm of an
// `if`. Whoever tries takes it back, and puts it for what was found.
#pragma once

#include "typecheck/interpreter.h"

#include "ir/passes/walk.h"

namespace fathom::typecheck {

// What has to hold for all params and times; the proof says whether it does. What reads the point
// is the field's own: the proof looks at that as it is.
void require(Interpreter &ev, ir::NodeId condition, Span place, std::string wanted);
// What was added to the scene's conditions since there were `mark` of them; they are the caller's.
std::vector<ir::Condition> take_conditions(Interpreter &ev, std::size_t mark);
// What was added since then need not hold where `excuse` does.
void excuse_conditions(Interpreter &ev, std::size_t mark, const Value &excuse);
// Puts conditions over variables with what stands for these; gives the first that does not hold.
std::optional<ir::Condition> put_conditions(Interpreter &ev,
                                            std::span<const ir::Condition> conditions,
                                            const ir::Substitution &map);
// The same of a loop's body, for each turn that the loop may take.
std::optional<ir::Condition> put_conditions_of_loop(Interpreter &ev, const ir::Loop &loop,
                                                    std::span<const ir::NodeId> initial,
                                                    std::vector<ir::Condition> conditions,
                                                    Span place);

} // namespace fathom::typecheck
