// A scene's text as a function of points, for tests that compare the library's fields with
// definitions of their own. Knows nothing of the library's text.
#pragma once

#include "backend-cpu/tape.h"
#include "driver/compile.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace fathom::test {

using Point = std::array<double, 3>;
using Inside = std::function<bool(Point)>;

double norm(Point p);
Point operator+(Point a, Point b);
Point operator-(Point a, Point b);
Point operator*(double s, Point a);
double dot(Point a, Point b);
Point cross(Point a, Point b);

// Numbers in 0..1 that every machine makes alike.
class Numbers {
  public:
    explicit Numbers(std::uint64_t seed) : state_(seed * 2 + 1) {}
    double next();
    Point in(double lo, double hi) {
        return {lo + (hi - lo) * next(), lo + (hi - lo) * next(), lo + (hi - lo) * next()};
    }

  private:
    std::uint64_t state_;
};

std::string
said(const driver::Compilation &compilation); // its diagnostics, one a line: code and message

// The marched field (divided by its bound) of a scene that has to compile.
class Field {
  public:
    explicit Field(const std::string &text, const std::string &folder = ""); // where its files lie
    bool good() const { return compilation_.good(); }
    std::string said() const { return test::said(compilation_); }
    const ir::Scene &scene() const { return compilation_.scene; }
    std::vector<double> at(const std::vector<Point> &points) const;

  private:
    driver::Compilation compilation_;
    cpu::Program program_;
};

// Points on the border of a solid, found by bisection between the corners of a grid of n^3 cells
// over -reach..reach.
std::vector<Point> border(const Inside &inside, double reach, int n);
// The way from p to the border: to the nearest of its points, then nearer ones that are found by
// trying.
double way_to_border(const Inside &inside, const std::vector<Point> &border, Point p,
                     Numbers &numbers);

} // namespace fathom::test
