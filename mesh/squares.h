// The squares of a plane's lattice in which a section's border may lie, and the way of the contours
// through them (docs/slices.md, 1 and 2). Points are in the lattice's axes here.
#pragma once

#include "mesh/section.h"

namespace fathom::mesh {

struct Square {
    std::int32_t i = 0, j = 0; // its least corner, in squares of its level
    // Bit c is set where the field is not positive at corner c: (0,0), (1,0), (1,1), (0,1).
    std::uint8_t signs = 0;
    std::int32_t tile = none; // whose tape holds in it
    bool crossed() const { return signs != 0 && !solid(); }
    bool solid() const { return signs == 15; }
    bool alone() const { return signs != 5 && signs != 10; } // not two pieces of border
    friend auto operator<=>(const Square &a, const Square &b) {
        return a.j != b.j ? a.j <=> b.j : a.i <=> b.i;
    }
    friend bool operator==(const Square &a, const Square &b) { return a.i == b.i && a.j == b.j; }
};

// A plane across a lattice.
struct Plane2 {
    const Field &field;
    Lattice lattice;
    std::size_t a = 0, b = 1, across = 2; // the lattice's axes in the plane, and the other
    float at = 0;
    double side() const { return lattice.side(lattice.level); }
    std::int32_t step() const { return lattice.cells(lattice.level); }
    float place(std::size_t which, std::int32_t square) const {
        return lattice.at(which == 0 ? a : b, square * step());
    }
    Point point(float x, float y) const {
        Point p;
        p[a] = x, p[b] = y, p[across] = at;
        return p;
    }
};

// The area of squares that are left out as parts of the solid.
struct SolidArea {
    double inside = 0;  // the field is negative
    double touched = 0; // it is 0 for some points, or all: the plane may only touch the solid there
};

// Flat boxes, as ranges take them: with their middles, which are points.
struct FlatBoxes {
    FlatBoxes(const Plane2 &of, Evaluator &by);
    const Plane2 &plane;
    Evaluator &evaluator;
    cpu::Boxes boxes;
    static constexpr std::size_t at_once = cpu::max_boxes / 2;
    void put(std::size_t k, const Rectangle &r);
    // The first of them, at most at_once, by a tape that holds in all.
    void run(std::size_t count, const cpu::ShortTape &tape);
    // After a run: of the one that is this rectangle; where it is solid it is counted.
    Space space(std::size_t k, const Rectangle &r, SolidArea &solid) const;
};
double half_diagonal_of(const Rectangle &r);
double area_of(const Rectangle &r);
// The quarters of rectangles that may hold border. The area of those in the solid is added.
std::vector<Rectangle> open_quarters(FlatBoxes &boxes, const cpu::ShortTape &tape,
                                     const std::vector<Rectangle> &whole, SolidArea &solid);

struct Squares {
    std::vector<Square> open;   // sorted
    std::vector<TapePtr> tapes; // by tile
    SolidArea solid;            // what was left out
};
Squares find_squares(const Plane2 &plane, Evaluator &evaluator);
const Square *find(const Squares &squares, std::int32_t i, std::int32_t j);

// An edge of a square with a sign at each end, on the way of one contour.
struct Crossing2 {
    std::int32_t i = 0, j = 0; // its lower end
    bool upright = false;      // along the second axis
    bool low_inside = false;
    std::int32_t next = none;    // along its contour, through `through`
    std::int32_t through = none; // index of a square
    Flat root{};                 // where the field changes its sign, no farther than `slack`
    float slack = 0;
    Flat vertex{}; // the same, strictly between the edge's ends
};
// A corner of the border in the square through which a crossing's contour goes on.
struct Corner {
    bool there = false;
    Flat at{};
};
struct Ways {
    std::vector<Crossing2> crossings;
    std::vector<Corner> corners; // by crossing
    bool torn = false;           // signs contradict what was proved
    Flat torn_at{};
};
Ways find_ways(const Plane2 &plane, const Squares &squares, Evaluator &evaluator);

// A stretch of a contour, and the squares that it goes through.
struct Chord {
    Flat from{}, to{};
    std::vector<std::int32_t> squares;
};
// The contours of the ways, with what lies on straight stretches left out.
struct Lines {
    Contours contours;
    std::vector<Chord> chords;
};
Lines straightened(const Plane2 &plane, const Squares &squares, const Ways &ways);

// Fills what is proved of a section: distances, undecided squares, the area.
void certify(const Plane2 &plane, const Squares &squares, const Ways &ways, const Lines &lines,
             Evaluator &evaluator, Section &section);

} // namespace fathom::mesh
