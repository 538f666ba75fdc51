// A scene's marched distance as meshing reads it: values and gradients at points and ranges over
// boxes, by tapes that are shortened for the part of space at hand; cut off at a box where one is
// given. Values are the whole tape's to the bit, whichever tape that holds at a point gave them.
#pragma once

#include "backend-cpu/prune/shorten.h"
#include "ir/scene.h"

#include <memory>
#include <optional>

namespace fathom::mesh {

using Point = std::array<float, 3>;

// Points by coordinate, as tapes take them.
struct Points {
    std::array<std::vector<float>, 3> at;
    std::size_t size() const { return at[0].size(); }
    void clear() {
        for (std::vector<float> &axis : at) axis.clear();
    }
    void add(const Point &p) {
        for (std::size_t i = 0; i < 3; ++i) at[i].push_back(p[i]);
    }
    Point operator[](std::size_t k) const { return {at[0][k], at[1][k], at[2][k]}; }
};

struct Field {
    // `cut`: the solid ends there, too. `wider`: it is grown by so much, before it is cut.
    Field(const ir::Scene &scene, double time, const std::optional<ir::Box> &cut, float wider = 0);
    Field(const Field &) = delete;
    Field &operator=(const Field &) = delete;
    const cpu::Program program;
    const cpu::Inputs inputs;
    const cpu::PruneProgram parts; // refers to `program`
    const std::shared_ptr<const cpu::ShortTape> whole;
    std::optional<std::array<Point, 2>> cut; // its ends
    const float wider;                       // taken off each value
    // |value| is proved never to exceed the distance to the surface, in real arithmetic, and no
    // distance was lowered for the sake of rounding.
    bool proved = false;
};

using TapePtr = std::shared_ptr<const cpu::ShortTape>;

struct SlopeMemory; // slope_run.h

// One thread's memory.
struct Evaluator {
    explicit Evaluator(const Field &of);
    const Field &field;
    cpu::Scratch values;
    cpu::GradientScratch gradients;
    cpu::Shortener ranges;
    std::vector<cpu::ShortTape> made; // by box
    Points points;                    // of boxes that are points, and their values
    std::vector<float> point_values;
    std::shared_ptr<SlopeMemory> slopes;
    double followed = 500; // steps of loops at most, of which slopes are wanted (slope_run.h)
};

// `out`: one number a point.
void values_at(Evaluator &evaluator, const cpu::ShortTape &tape, const Points &points,
               std::vector<float> &out);
// `out`: the value and its derivatives. At a kink those of one side.
void gradients_at(Evaluator &evaluator, const cpu::ShortTape &tape, const Points &points,
                  std::array<std::vector<float>, 4> &out);
// Into evaluator.ranges.result_lo and result_hi: what the values in each box lie within. Of a box that
// is a point, the value there, which its range may be wider than.
void ranges_over(Evaluator &evaluator, const cpu::ShortTape &tape, const cpu::Boxes &boxes);
// A number that a tape computes on its way: the one that its step `step` (of those of the tape, in
// order) writes to `address`.
struct Register {
    std::size_t step = 0;
    std::uint32_t address = 0;
};
// … and what it is held between, by box.
struct Held {
    Register where;
    std::vector<std::array<float, 2>> ranges;
};
// As ranges_over, of those points alone at which these numbers, in the order of their steps, lie in
// their ranges.
void ranges_where(Evaluator &evaluator, const cpu::ShortTape &tape, const cpu::Boxes &boxes,
                  const std::vector<Held> &held);
// After ranges_over, with the same tape: a tape that holds in one of the boxes, for each of `which`, a
// bit each; the same one where a shorter one does not pay, as never where it is short.
bool is_short(const cpu::ShortTape &tape);
std::array<TapePtr, cpu::max_boxes> shortened(Evaluator &evaluator, const TapePtr &tape,
                                              std::uint64_t which);
TapePtr shortened_in_first(Evaluator &evaluator, const TapePtr &tape); // of the boxes
// A tape that holds in a box, shorter than the one that it was made of where that pays.
TapePtr tape_in(Evaluator &evaluator, cpu::Boxes &boxes, const TapePtr &tape, const Point &lo,
                const Point &hi);

} // namespace fathom::mesh
