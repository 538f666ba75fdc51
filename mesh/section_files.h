// Contours as the bytes of files, and as pixels.
#pragma once

#include "mesh/section.h"
#include "mesh/write.h"

#include <string>
#include <vector>

namespace fathom::mesh {

// One path of the contours, filled, holes left out. The picture is as large as the frame, in
// millimetres or inches where the unit is known. `title`: any words.
std::string svg_of(const Contours &contours, const Rectangle &frame, std::string_view title,
                   Unit unit);

// A closed polyline for each contour (AutoCAD R12, which all programs read), with the unit in its
// header.
std::string dxf_of(const Contours &contours, Unit unit);

// How much of each pixel the solid covers, 0 to 1, rows from the top. The frame lies in the middle,
// as large as it fits.
std::vector<float> coverage_of(const Contours &contours, const Rectangle &frame, int width,
                               int height);

double area_of(const Contours &contours);

} // namespace fathom::mesh
