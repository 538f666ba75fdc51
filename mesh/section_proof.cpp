// What is proved of a section: how far its border and the contours are apart at most, and its area
// (docs/slices.md, 3).
#include "mesh/seams.h"
#include "mesh/squares.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr double rounded_out = 1 + 1e-9;
constexpr int halvings_of_squares = 4;
constexpr double stride = 1.0 / 16;                                   // along a contour, of a side
constexpr std::array<double, 3> sideways{1.0 / 32, 1.0 / 8, 3.0 / 8}; // from it, of a side

using Real2 = std::array<double, 2>;

double to_chord(const Real2 &p, const Chord &chord) {
    const double x = double(chord.to[0]) - chord.from[0], y = double(chord.to[1]) - chord.from[1],
                 squares = x * x + y * y;
    const double t =
        squares > 0
            ? std::clamp(((p[0] - chord.from[0]) * x + (p[1] - chord.from[1]) * y) / squares, 0.0,
                         1.0)
            : 0;
    return std::hypot(p[0] - chord.from[0] - t * x, p[1] - chord.from[1] - t * y);
}

// The chords that go through a square and those about it.
struct Nearness {
    const Squares &squares;
    std::vector<std::vector<std::int32_t>> by_square;

    Nearness(const Squares &of, const Lines &lines) : squares(of), by_square(of.open.size()) {
        for (std::size_t k = 0; k < lines.chords.size(); ++k)
            for (const std::int32_t square : lines.chords[k].squares)
                by_square[static_cast<std::size_t>(square)].push_back(static_cast<std::int32_t>(k));
    }
    std::vector<std::int32_t> about(const Square &s) const {
        std::vector<std::int32_t> near;
        for (int k = 0; k < 9; ++k) {
            const Square *beside = find(squares, s.i + k % 3 - 1, s.j + k / 3 - 1);
            if (!beside) continue;
            const auto &some = by_square[static_cast<std::size_t>(beside - squares.open.data())];
            near.insert(near.end(), some.begin(), some.end());
        }
        return near;
    }
};

Rectangle rectangle_of(const Plane2 &plane, const Square &s) {
    return {{plane.place(0, s.i), plane.place(1, s.j)},
            {plane.place(0, s.i + 1), plane.place(1, s.j + 1)}};
}

// How far a rectangle's points are from the nearest of some contours at most.
double reach_of(const Plane2 &plane, const Lines &lines, const std::vector<std::int32_t> &near,
                const Rectangle &r) {
    const Real2 middle{0.5 * (double(r.lo[0]) + r.hi[0]), 0.5 * (double(r.lo[1]) + r.hi[1])};
    double d = 2 * plane.side();
    for (const std::int32_t chord : near)
        d = std::min(d, to_chord(middle, lines.chords[static_cast<std::size_t>(chord)]));
    return (d + half_diagonal_of(r)) * rounded_out;
}

// Whether parts of the solid only touch in a rectangle.
std::optional<Seam> touching_in(const Rectangle &r, FlatBoxes &boxes, const cpu::ShortTape &tape) {
    const Plane2 &plane = boxes.plane;
    return seam_in(boxes.evaluator, tape, boxes.boxes, plane.point(r.lo[0], r.lo[1]),
                   plane.point(r.hi[0], r.hi[1]), seam_thickness(plane.lattice));
}

void certify_border(const Plane2 &plane, const Squares &squares, const Lines &lines,
                    const Nearness &nearness, Evaluator &evaluator, Section &section,
                    std::vector<bool> &undecided) {
    constexpr int seam_depth = 2; // halvings between looks for seams
    FlatBoxes boxes(plane, evaluator);
    SolidArea solid = squares.solid;
    double open_area = 0;
    for (std::size_t k = 0; k < squares.open.size(); ++k) {
        const Square &square = squares.open[k];
        const cpu::ShortTape &tape = *squares.tapes[static_cast<std::size_t>(square.tile)];
        std::vector<Rectangle> open{rectangle_of(plane, square)};
        const std::vector<std::int32_t> near = nearness.about(square);
        // Where it is not empty the field is 0, or next to that, all over: counted as open.
        const auto is_seam = [&](const Rectangle &r) {
            if (!(reach_of(plane, lines, near, r) > plane.side())) return false;
            const std::optional<Seam> seam = touching_in(r, boxes, tape);
            if (seam && (seam->width > 0 || seam->solid)) open_area += area_of(r);
            return seam.has_value();
        };
        // What is far from all contours is open to the end where the plane lies in a face.
        const int halvings = near.empty() ? halvings_of_squares / 2 : halvings_of_squares;
        for (int level = 0; !open.empty(); ++level) {
            if (level % seam_depth == 0) std::erase_if(open, is_seam);
            if (level == halvings) break;
            open = open_quarters(boxes, tape, open, solid);
        }
        double farthest = 0;
        for (const Rectangle &r : open) {
            open_area += area_of(r);
            farthest = std::max(farthest, reach_of(plane, lines, near, r));
        }
        if (farthest <= plane.side())
            section.to_contour = std::max(section.to_contour, farthest);
        else
            undecided[k] = true;
    }
    section.area = {solid.inside / rounded_out,
                    (solid.inside + solid.touched + open_area) * rounded_out};
}

// A place on a contour, and where else the field's sign is asked.
struct Place2 {
    Real2 at, normal;
    std::int32_t chord = 0;
};

std::vector<Place2> places_on(const Plane2 &plane, const Lines &lines, double &half_step) {
    std::vector<Place2> places;
    half_step = 0;
    for (std::size_t k = 0; k < lines.chords.size(); ++k) {
        const Chord &c = lines.chords[k];
        const double x = double(c.to[0]) - c.from[0], y = double(c.to[1]) - c.from[1],
                     length = std::hypot(x, y);
        const auto count =
            static_cast<std::size_t>(std::ceil(length / (stride * plane.side()))) + 1;
        half_step = std::max(half_step, 0.5 * length / static_cast<double>(count));
        for (std::size_t n = 0; n < count; ++n) {
            const double t = (static_cast<double>(n) + 0.5) / static_cast<double>(count);
            places.push_back({{c.from[0] + t * x, c.from[1] + t * y},
                              length > 0 ? Real2{-y / length, x / length} : Real2{1, 0},
                              static_cast<std::int32_t>(k)});
        }
    }
    return places;
}

// The border lies between two points beside a contour where the field's signs differ; else as near
// as a place where it crosses an edge of the lattice.
void certify_contours(const Plane2 &plane, const Squares &squares, const Ways &ways,
                      const Lines &lines, Evaluator &evaluator, Section &section,
                      std::vector<bool> &undecided) {
    double half_step = 0;
    std::vector<Place2> left = places_on(plane, lines, half_step);
    const double rounding = 4 * plane.lattice.ulp;
    for (const double share : sideways) {
        if (left.empty()) break;
        const double way = share * plane.side();
        Points points;
        for (const Place2 &p : left)
            for (const double sign : {-1.0, 1.0})
                points.add(plane.point(static_cast<float>(p.at[0] + sign * way * p.normal[0]),
                                       static_cast<float>(p.at[1] + sign * way * p.normal[1])));
        std::vector<float> values;
        values_at(evaluator, *plane.field.whole, points, values);
        std::vector<Place2> still;
        for (std::size_t k = 0; k < left.size(); ++k)
            if ((values[2 * k] <= 0) == (values[2 * k + 1] <= 0)) still.push_back(left[k]);
        if (still.size() < left.size())
            section.to_section =
                std::max(section.to_section, (way + half_step + rounding) * rounded_out);
        left = std::move(still);
    }
    std::vector<std::vector<const Crossing2 *>> by_square(squares.open.size());
    if (!left.empty())
        for (const Crossing2 &c : ways.crossings) {
            by_square[static_cast<std::size_t>(c.through)].push_back(&c);
            by_square[static_cast<std::size_t>(c.through)].push_back(
                &ways.crossings[static_cast<std::size_t>(c.next)]);
        }
    for (const Place2 &p : left) {
        double d = 2 * plane.side();
        const Chord &chord = lines.chords[static_cast<std::size_t>(p.chord)];
        for (const std::int32_t square : chord.squares)
            for (const Crossing2 *c : by_square[static_cast<std::size_t>(square)])
                d = std::min(d, std::hypot(p.at[0] - c->root[0], p.at[1] - c->root[1]) + c->slack);
        const double far = (d + half_step + rounding) * rounded_out;
        if (far <= plane.side())
            section.to_section = std::max(section.to_section, far);
        else
            for (const std::int32_t square : chord.squares)
                undecided[static_cast<std::size_t>(square)] = true;
    }
}

} // namespace

void certify(const Plane2 &plane, const Squares &squares, const Ways &ways, const Lines &lines,
             Evaluator &evaluator, Section &section) {
    std::vector<bool> undecided(squares.open.size(), false);
    const Nearness nearness(squares, lines);
    certify_border(plane, squares, lines, nearness, evaluator, section, undecided);
    certify_contours(plane, squares, ways, lines, evaluator, section, undecided);
    for (std::size_t k = 0; k < squares.open.size(); ++k)
        if (undecided[k]) section.undecided.push_back(rectangle_of(plane, squares.open[k]));
}

} // namespace fathom::mesh
