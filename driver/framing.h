// What a view without a camera frames (semantics.md, 23): the solid itself.
#pragma once

#include "base/diagnostic.h"
#include "ir/interval.h"
#include "ir/scene.h"
#include "ir/section.h"

#include <optional>

namespace fathom::driver {

// Narrows Scene::framed of a lowered scene whose camera is not given to the box of what has an end, and
// finds framed_reach, at the params' present values and over these times, in seconds. Where nothing has one, or there is
// no solid at all, a note says so and what to write; the view of what is endless begins outside of it. `section`: what the scene was cut open by.
void find_framing(ir::Scene &scene, ir::Interval times, const std::optional<ir::Section> &section,
                  Diagnostics &diagnostics);

// A note where the view, framed already, begins deep in the solid, at the params' present values and
// that time. Not looked for in a scene of more than `most_operations_inside` operations a point.
constexpr double most_operations_inside = 20'000;
void tell_of_view_inside(const ir::Scene &scene, double time, Diagnostics &diagnostics);

} // namespace fathom::driver
