// Noise as the library gives it: within its stated range and slope, another one for each seed, and
// without the lattice and the axes that it is made of. (That a shader and the processor agree on it
// is tests/conformance's to say.)
#include "field.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Noise {
    std::string call; // with `p` and `SEED`
    double lo, hi;    // stated
    double slope;     // stated; 0: as proved
};
const std::vector<Noise> noises{
    {"noise(p, seed: SEED)", -1.04, 1.04, 3.76},
    {"simplex(p, seed: SEED)", -1.1, 1.1, 0},
    {"value_noise(p, seed: SEED)", 0, 1, 1.91},
    {"worley(p, seed: SEED)", 0, 1.8, 1},
    {"fbm(p, seed: SEED)", -2, 2, 5 * 3.76},
    {"ridged(p, seed: SEED)", 0, 1, 3.76 * 5 / (2 - 1.0 / 16)},
    {"turbulence(p, seed: SEED)", 0, 1.04, 3.76 * 5 / (2 - 1.0 / 16)},
    {"spot_noise(p, 0.6, 6, seed: SEED)", -40, 40, 0},
};

std::string seeded(const Noise &noise, int seed) {
    std::string call = noise.call;
    return call.replace(call.find("SEED"), 4, fmt::to_string(seed));
}

// The noise's own values: the marched field of {noise < 0}, times the bound that it was divided by.
class Values {
  public:
    Values(const Noise &noise, int seed)
        : field_("implicit(p => " + seeded(noise, seed) + ", within: everywhere)") {
        INFO(field_.said());
        REQUIRE(field_.good());
        bound_ = field_.scene().facts[field_.scene().root.index].lipschitz_sup;
    }
    double bound() const { return bound_; }
    std::vector<double> at(const std::vector<Point> &points) const {
        std::vector<double> values = field_.at(points);
        for (double &v : values) v *= bound_;
        return values;
    }

  private:
    Field field_;
    double bound_ = 1;
};

std::vector<Point> places(std::size_t count, std::uint64_t seed) {
    Numbers numbers(seed);
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(numbers.in(-20, 20));
    return points;
}

double variance(const std::vector<double> &values) {
    double mean = 0, sum = 0;
    for (double v : values) mean += v / static_cast<double>(values.size());
    for (double v : values) sum += (v - mean) * (v - mean) / static_cast<double>(values.size());
    return sum;
}

double correlation(const std::vector<double> &a, const std::vector<double> &b) {
    std::vector<double> sum(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) sum[i] = a[i] + b[i];
    return (variance(sum) - variance(a) - variance(b)) / (2 * std::sqrt(variance(a) * variance(b)));
}

} // namespace

TEST_CASE("noise keeps to the range and the slope that are proved of it", "[noise]") {
    for (const Noise &noise : noises) {
        INFO(noise.call);
        const Values values(noise, 3);
        if (noise.slope > 0) CHECK(values.bound() < noise.slope * 1.01 + 0.01);
        const std::vector<Point> a = places(40000, 1);
        std::vector<Point> b = a;
        Numbers numbers(2);
        for (Point &p : b) p = p + 0.01 * numbers.in(-1, 1);
        const std::vector<double> va = values.at(a), vb = values.at(b);
        double steepest = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            steepest = std::max(steepest, (std::abs(va[i] - vb[i]) - 2e-5) /
                                              std::max(norm(a[i] - b[i]), 1e-3));
        CHECK(steepest <= values.bound());
        CHECK(*std::min_element(va.begin(), va.end()) >= noise.lo - 1e-4);
        CHECK(*std::max_element(va.begin(), va.end()) <= noise.hi + 1e-4);
    }
}

TEST_CASE("each seed is another noise, and the same one each time", "[noise]") {
    const std::vector<Point> points = places(5000, 5);
    for (const Noise &noise : noises) {
        INFO(noise.call);
        const std::vector<double> zero = Values(noise, 0).at(points),
                                  one = Values(noise, 1).at(points),
                                  two = Values(noise, 2).at(points);
        CHECK(std::abs(correlation(zero, one)) < 0.1);
        CHECK(std::abs(correlation(one, two)) < 0.1);
        CHECK(one == Values(noise, 1).at(points));
    }
}

// Gradient noise is 0 at its lattice's corners, value noise goes straight along its edges: neither
// may be where a scene has its whole coordinates and its planes.
TEST_CASE("noise shows neither its lattice nor the axes", "[noise]") {
    std::vector<Point> corners, along, aslant;
    for (int i = -8; i < 8; ++i)
        for (int j = -8; j < 8; ++j)
            for (int k = -8; k < 8; ++k) {
                corners.push_back({double(i), double(j), double(k)});
                along.push_back({i + 0.5, double(j), double(k)}); // half a step along an axis
                aslant.push_back(
                    {i + 0.5 / std::sqrt(3), j + 0.5 / std::sqrt(3), k + 0.5 / std::sqrt(3)});
            }
    const std::vector<Point> anywhere = places(corners.size(), 8);
    for (const Noise &noise : noises) {
        INFO(noise.call);
        const Values values(noise, 0);
        const std::vector<double> at = values.at(corners);
        const double usual = variance(values.at(anywhere));
        CHECK(variance(at) > 0.7 * usual);
        CHECK(variance(at) < 1.4 * usual);
        // what is half a step away is as much alike along an axis as aslant
        CHECK(std::abs(correlation(at, values.at(along)) - correlation(at, values.at(aslant))) <
              0.12);
    }
}
