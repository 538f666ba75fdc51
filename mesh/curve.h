// Places in the order of a curve that fills space by octants (Morton 1966): halves of it, and halves of
// these, lie together.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace fathom::mesh {

std::vector<std::uint32_t> order_along_curve(const std::vector<std::array<double, 3>> &places);

} // namespace fathom::mesh
