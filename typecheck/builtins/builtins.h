// What the files of shape intrinsics share. Private to typecheck.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// The shape as a value; its place is the user's own call, also where the library made it.
Value added(Interpreter &ev, ir::Shape shape, const CallSite &site, int dims);
bool given(const Value &v);                     // an optional argument that is there
bool is_empty(Interpreter &ev, ir::ShapeId id); // nothing.cpp
bool is_everything(Interpreter &ev, ir::ShapeId id);
// Of shapes that are intersected those that say something; one that is nowhere stands for all.
void leave_out_everything(Interpreter &ev, std::vector<ir::ShapeId> &intersected);
// What a shape is that is made of nothing; none where its children are somewhere, or its kind leaves
// out those that are not.
std::optional<ir::ShapeId> made_of_nothing(Interpreter &ev, const ir::Shape &shape);
std::optional<ir::ShapeId> first_shape(Interpreter &ev, const CallSite &site,
                                       const std::vector<Value> &args, int dims = 0);
std::optional<int> axis_argument(Interpreter &ev, const CallSite &site, const Value &v,
                                 std::size_t i); // 0, 1, 2

} // namespace fathom::typecheck
