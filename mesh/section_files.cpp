#include "mesh/section_files.h"

#include "base/encode.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

// A unit as SVG says it: its word, and how many of that a length of 1 is.
struct SvgUnit {
    const char *word;
    double length;
};
SvgUnit svg_unit(Unit unit) {
    switch (unit) {
    case Unit::Unsaid: return {"", 1};
    case Unit::Micron: return {"mm", 0.001};
    case Unit::Millimetre: return {"mm", 1};
    case Unit::Centimetre: return {"cm", 1};
    case Unit::Metre: return {"mm", 1000};
    case Unit::Inch: return {"in", 1};
    case Unit::Foot: return {"in", 12};
    }
    return {"", 1};
}

// $INSUNITS of a DXF (AutoCAD's reference).
int dxf_unit(Unit unit) {
    switch (unit) {
    case Unit::Unsaid: return 0;
    case Unit::Micron: return 13;
    case Unit::Millimetre: return 4;
    case Unit::Centimetre: return 5;
    case Unit::Metre: return 6;
    case Unit::Inch: return 1;
    case Unit::Foot: return 2;
    }
    return 0;
}

// What a line covers to its right, as differences along the rows of pixels: areas and heights, whose
// running sums are the coverage.
void add_line(std::vector<float> &sums, int width, int height, double x0, double y0, double x1,
              double y1) {
    if (y0 == y1) return;
    const double sign = y0 < y1 ? 1 : -1;
    if (y0 > y1) std::swap(x0, x1), std::swap(y0, y1);
    const double slope = (x1 - x0) / (y1 - y0);
    const int first = std::max(0, static_cast<int>(std::floor(y0))),
              last = std::min(height - 1, static_cast<int>(std::floor(y1)));
    for (int row = first; row <= last; ++row) {
        const double top = std::max<double>(row, y0), bottom = std::min<double>(row + 1, y1);
        if (!(bottom > top)) continue;
        const double p = std::clamp<double>(x0 + (top - y0) * slope, 0, width),
                     q = std::clamp<double>(x0 + (bottom - y0) * slope, 0, width),
                     lo = std::min(p, q), hi = std::max(p, q), tall = sign * (bottom - top);
        float *const at = sums.data() + static_cast<std::ptrdiff_t>(row) * (width + 2);
        // Pixel by pixel under the line: the part of its height that falls to it, and how much of
        // the pixel lies to the right.
        const int from = static_cast<int>(std::floor(lo)), to = static_cast<int>(std::floor(hi));
        for (int k = from; k <= to; ++k) {
            const double a = std::max<double>(lo, k), b = std::min<double>(hi, k + 1);
            const double share = hi > lo ? (b - a) / (hi - lo) : 1;
            if (!(share > 0)) continue;
            const double right = k + 1 - 0.5 * (a + b);
            at[k] += static_cast<float>(tall * share * right);
            at[k + 1] += static_cast<float>(tall * share * (1 - right));
        }
    }
}

} // namespace

std::string svg_of(const Contours &contours, const Rectangle &frame, std::string_view title,
                   Unit unit) {
    const SvgUnit in = svg_unit(unit);
    const double width = double(frame.hi[0]) - frame.lo[0],
                 height = double(frame.hi[1]) - frame.lo[1];
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}{}\" height=\"{}{}\" "
        "viewBox=\"{} {} {} {}\">\n<title>{}</title>\n<path fill-rule=\"evenodd\" d=\"",
        format_shortest(width * in.length), in.word, format_shortest(height * in.length), in.word,
        format_shortest(frame.lo[0]), format_shortest(-frame.hi[1] + 0.0f), format_shortest(width),
        format_shortest(height), for_html(title));
    for (const std::vector<Flat> &contour : contours) {
        for (std::size_t k = 0; k < contour.size(); ++k)
            text +=
                fmt::format("{}{} {}",
                            k == 0   ? "M"
                            : k == 1 ? "L"
                                     : " ",
                            format_shortest(contour[k][0]), format_shortest(-contour[k][1] + 0.0f));
        text += "Z\n";
    }
    return text + "\"/>\n</svg>\n";
}

std::string dxf_of(const Contours &contours, Unit unit) {
    std::string text = fmt::format(
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n{}\n0\nENDSEC\n"
        "0\nSECTION\n2\nENTITIES\n",
        dxf_unit(unit));
    for (const std::vector<Flat> &contour : contours) {
        text += "0\nPOLYLINE\n8\n0\n66\n1\n70\n1\n10\n0\n20\n0\n30\n0\n";
        for (const Flat &p : contour)
            text += fmt::format("0\nVERTEX\n8\n0\n10\n{}\n20\n{}\n30\n0\n", format_shortest(p[0]),
                                format_shortest(p[1]));
        text += "0\nSEQEND\n8\n0\n";
    }
    return text + "0\nENDSEC\n0\nEOF\n";
}

std::vector<float> coverage_of(const Contours &contours, const Rectangle &frame, int width,
                               int height) {
    const double wide = double(frame.hi[0]) - frame.lo[0], tall = double(frame.hi[1]) - frame.lo[1];
    const double scale = std::min(width / wide, height / tall);
    const double left = 0.5 * (width - scale * wide), top = 0.5 * (height - scale * tall);
    std::vector<float> sums(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height));
    for (const std::vector<Flat> &contour : contours)
        for (std::size_t k = 0; k < contour.size(); ++k) {
            const Flat &p = contour[k], &q = contour[(k + 1) % contour.size()];
            add_line(sums, width, height, left + scale * (p[0] - double(frame.lo[0])),
                     top + scale * (frame.hi[1] - double(p[1])),
                     left + scale * (q[0] - double(frame.lo[0])),
                     top + scale * (frame.hi[1] - double(q[1])));
        }
    std::vector<float> pixels;
    pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int row = 0; row < height; ++row) {
        double sum = 0;
        for (int k = 0; k < width; ++k) {
            sum += sums[static_cast<std::size_t>(row) * static_cast<std::size_t>(width + 2) +
                        static_cast<std::size_t>(k)];
            pixels.push_back(static_cast<float>(std::clamp(std::fabs(sum), 0.0, 1.0)));
        }
    }
    return pixels;
}

double area_of(const Contours &contours) {
    double area = 0;
    for (const std::vector<Flat> &contour : contours)
        for (std::size_t k = 1; k + 1 < contour.size(); ++k) {
            const Flat &o = contour[0], &p = contour[k], &q = contour[k + 1];
            area += 0.5 * ((double(p[0]) - o[0]) * (double(q[1]) - o[1]) -
                           (double(p[1]) - o[1]) * (double(q[0]) - o[0]));
        }
    return area;
}

} // namespace fathom::mesh
