// What the files of shape intrinsics share. Private to typecheck.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// The shape as a value; its place is the user's own call, also where the library made it.
Value added(Interpreter &ev, ir::Shape shape, const CallSite &site, int dims);
bool given(const Value &v); // an optional argument that is there
bool is_empty(Interpreter &ev, ir::ShapeId id);
std::optional<ir::ShapeId> first_shape(Interpreter &ev, const CallSite &site,
                                       const std::vector<Value> &args, int dims = 0);
// A region; of flat shapes, dims 2, what it has in the xy plane, of whatever height.
std::optional<ir::Region> want_region(Interpreter &ev, const Value &v, Span place, What what,
                                      int dims);
// The part of a shape that lies in a region.
Value within_shape(Interpreter &ev, const CallSite &site, const Value &shape,
                   const ir::Region &region);
std::optional<int> axis_argument(Interpreter &ev, const CallSite &site, const Value &v,
                                 std::size_t i); // 0, 1, 2

} // namespace fathom::typecheck
