#include <fathom/slice.h>

#include "api/mesh.h"
#include "base/text.h"
#include "mesh/section_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::v1 {
namespace {

Slices without_slices(Refusal why) {
    Slices slices;
    slices.status = why.status;
    slices.message = std::move(why.message);
    return slices;
}

std::size_t number_of(Axis axis) {
    switch (axis) {
    case Axis::X: return 0;
    case Axis::Y: return 1;
    case Axis::Z: return 2;
    }
    return 2;
}

PlaneBox plane_box_of(const fathom::mesh::Rectangle &r) { return {r.lo, r.hi}; }
fathom::mesh::Rectangle inner(const PlaneBox &box) { return {box.lo, box.hi}; }

Slice slice_of(fathom::mesh::Section &section, float at) {
    constexpr std::size_t listed = 1000;
    Slice slice;
    slice.at = at;
    slice.contours = std::move(section.contours);
    slice.contours_to_border = section.to_section;
    slice.border_to_contours = section.to_contour;
    slice.certified = section.undecided.empty();
    slice.undecided_squares = section.undecided.size();
    for (std::size_t k = 0; k < std::min(listed, section.undecided.size()); ++k)
        slice.undecided.push_back(plane_box_of(section.undecided[k]));
    slice.area = {section.area.lo, section.area.hi};
    slice.contours_area = fathom::mesh::area_of(slice.contours);
    return slice;
}

double width_of(const std::vector<PlanePoint> &contour) { // twice its area by its length
    double length = 0;
    for (std::size_t k = 0; k < contour.size(); ++k) {
        const PlanePoint &p = contour[k], &q = contour[(k + 1) % contour.size()];
        length += std::hypot(double(q[0]) - p[0], double(q[1]) - p[1]);
    }
    return length > 0 ? 2 * std::fabs(fathom::mesh::area_of({contour})) / length : 0;
}

// Of walls and gaps about as wide as the squares that contours are looked for in: these show them in
// pieces. Empty where there are hardly any.
std::string advice_on_pieces(const Slices &cut) {
    constexpr double narrow = 1.5;    // sides of squares
    constexpr std::size_t hardly = 3; // in one slice
    std::size_t most = 0;
    float at = 0;
    for (const Slice &slice : cut.slices) {
        const auto pieces = static_cast<std::size_t>(
            std::ranges::count_if(slice.contours, [&](const std::vector<PlanePoint> &contour) {
                return width_of(contour) < narrow * cut.side;
            }));
        if (pieces > most) most = pieces, at = slice.at;
    }
    if (most < hardly) return "";
    return fmt::format(
        "{} contours{} are about as narrow as the squares that they are looked for "
        "in, as the pieces of a thin wall or gap are: a tolerance of {:.2g} may show "
        "it whole",
        most, cut.slices.size() > 1 ? " at " + format_shortest(at) : "", cut.side / 2);
}

Slices sliced(const Scene &scene, Axis axis, std::span<const float> heights,
              const MeshOptions &options) {
    const fathom::mesh::Settings settings = settings_of(options);
    ir::Box box;
    if (Refusal why = refusal_of(fathom::mesh::box_of(ir_of(scene), settings, box)))
        return without_slices(std::move(why));
    const fathom::mesh::Cut cut(ir_of(scene), settings, box);
    std::vector<fathom::mesh::Section> sections(heights.size());
    fathom::mesh::Progress progress;
    progress.report = options.progress;
    fathom::mesh::in_parallel(
        heights.size(), threads_of(settings), progress, [] { return 0; },
        [&](int, std::size_t k) {
            sections[k] = fathom::mesh::section(cut, number_of(axis), heights[k]);
        });
    if (progress.cancelled) return without_slices(refusal_of(fathom::mesh::Failure::Cancelled));
    Slices result;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        if (Refusal why = refusal_of(sections[k].failure, sections[k].place))
            return without_slices(std::move(why));
        result.side = std::max(result.side, sections[k].side);
        result.slices.push_back(slice_of(sections[k], heights[k]));
    }
    result.frame = plane_box_of(
        fathom::mesh::outline_of(settings.bounds ? *settings.bounds : box, number_of(axis)));
    result.along = {static_cast<float>(box.lo[number_of(axis)]),
                    static_cast<float>(box.hi[number_of(axis)])};
    result.rests_on = rests_on(cut.field.proved);
    result.message = advice_on_pieces(result);
    return result;
}

} // namespace

Slices slice(const Scene &scene, Axis axis, std::span<const float> heights,
             const MeshOptions &options) noexcept {
    if (Refusal why = refusal_of(scene, options)) return without_slices(std::move(why));
    if (!std::ranges::all_of(heights, [](float z) { return std::isfinite(z); }))
        return without_slices({MeshStatus::BadOptions, "heights are finite"});
    return guarded([&] { return sliced(scene, axis, heights, options); },
                   [](const Diagnostic &why) {
                       return without_slices({MeshStatus::TooLarge, why.message});
                   });
}

std::string svg_file(const Slices &slices, std::size_t k, MeshUnit unit,
                     std::string_view title) noexcept {
    return guarded(
        [&] {
            const Slice &slice = slices.slices.at(k);
            return fathom::mesh::svg_of(slice.contours, inner(slices.frame),
                                        title.empty() ? "at " + format_shortest(slice.at)
                                                      : std::string(title),
                                        inner(unit));
        },
        [](const Diagnostic &) { return std::string(); });
}

std::string dxf_file(const Slices &slices, std::size_t k, MeshUnit unit) noexcept {
    return guarded([&] { return fathom::mesh::dxf_of(slices.slices.at(k).contours, inner(unit)); },
                   [](const Diagnostic &) { return std::string(); });
}

Picture slice_picture(const Slices &slices, std::size_t k, int width, int height) noexcept {
    constexpr int most = 65536;
    return guarded(
        [&] {
            Picture picture;
            if (width < 1 || height < 1 || width > most || height > most) return picture;
            picture.width = width;
            picture.height = height;
            for (const float share : fathom::mesh::coverage_of(
                     slices.slices.at(k).contours, inner(slices.frame), width, height)) {
                const auto gray = static_cast<std::uint8_t>(std::lround(255 * share));
                picture.rgba.insert(picture.rgba.end(), {gray, gray, gray, 255});
            }
            picture.complete = true;
            return picture;
        },
        [](const Diagnostic &) { return Picture(); });
}

} // namespace fathom::v1
