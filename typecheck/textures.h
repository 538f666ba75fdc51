// Images on shapes, for the intrinsics that take a texture. Private to typecheck.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// An `image(…)` and its scale, a number or two; reports what is neither.
std::optional<ir::Texture> want_texture(Interpreter &ev, const Value &image, Span image_place,
                                        const Value &scale, Span scale_place, const char *what,
                                        const char *scale_what);

// The shape with the material's texture on each of its base shapes; all of the material is
// evaluated in the base shape's own space, like its texture. `over`: also where it is painted
// already. None after a report.
std::optional<ir::ShapeId> painted_by_base(Interpreter &ev, ir::ShapeId shape,
                                           const ir::Material &material, bool over, Span place);

} // namespace fathom::typecheck
