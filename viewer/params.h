// What the sliders hold: which values outlive a reload, and how a value is written. Knows no
// window.
#pragma once

#include "driver/edit.h"
#include "ir/scene.h"

#include <string>
#include <vector>

namespace fathom::viewer {

// Gives the values that were set by hand to the params of a freshly compiled scene: where name,
// type and the text's own value are as they were, and the value lies in the range. Where the text's
// value changed, the text wins.
void carry_over(const std::vector<ir::Param> &before, std::vector<ir::Param> &fresh);

// The structural params that stand on another value than the text's: the scene is built with these.
std::vector<driver::Override> structural_values(const std::vector<ir::Param> &params);

// Takes out of `values` what was set while the text had another value; true where something was
// taken out.
bool drop_outdated(const std::vector<ir::Param> &before, const std::vector<ir::Param> &fresh,
                   std::vector<driver::Override> &values);

bool changed(const ir::Param &param); // stands on another value than the text's
// As one would write it: `1.5`, `[1, 2, 3]`, `rgb(1, 0.5, 0)`; or as the text does: `#d08030`,
// `30deg`.
std::string value_text(const ir::Param &param, const driver::Notation &notation = {});

} // namespace fathom::viewer
