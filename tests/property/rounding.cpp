// The bound of rounding errors, attacked: at every example and library entry, at random points, what
// single precision computes lies as near to what is meant as proof/rounding.h says.
#include "proof/rounding.h"
#include "base/single.h"
#include "driver/compile.h"
#include "proof/field.h"
#include "tests/support/library_entries.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>

using namespace fathom;
using ir::Interval;

namespace {

// The largest error seen over the one that is bounded, and how many points had a bound.
struct Seen {
    double ratio = 0;
    int bounded = 0, all = 0;
};

Seen attack(const ir::Scene &scene, double reach, int count) {
    proof::RoundingMachine machine(scene, scene.distance);
    proof::Dice dice{7};
    std::vector<test::Point3> points;
    for (int k = 0; k < count; ++k) {
        test::Point3 p{};
        for (double &x : p) x = to_single(reach * (2 * dice.next() - 1));
        if (k % 4 == 0) // where cells meet
            for (double &x : p) x = std::round(2 * x) / 2 + (k % 8 == 0 ? 1e-7 * dice.next() : 0);
        for (double &x : p) x = to_single(x);
        points.push_back(p);
    }
    std::vector<std::array<Interval, 4>> params;
    for (const ir::Param &param : scene.params) {
        std::array<Interval, 4> now;
        for (std::size_t i = 0; i < 4; ++i) now[i] = to_single(param.value[i]);
        params.push_back(now);
    }
    const std::vector<float> values = test::Sampler(scene).values(points);
    Seen seen;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto &p = points[k];
        const double e =
            machine.error({{Interval(p[0]), Interval(p[1]), Interval(p[2])}}, 0.0, params);
        ++seen.all;
        if (std::isinf(e)) continue;
        ++seen.bounded;
        const Interval meant = machine.value();
        const double off =
            std::max({0.0, meant.lo - double(values[k]), double(values[k]) - meant.hi});
        // Closed numbers are what evaluators make of them, which differ from these by a unit.
        const double granted = e + 2.4e-7 * (1 + std::fabs(double(values[k])));
        seen.ratio = std::max(seen.ratio, off / granted);
        if (!(off <= granted))
            UNSCOPED_INFO("at " << p[0] << ", " << p[1] << ", " << p[2] << ": " << values[k]
                                << " is " << off << " off, bounded by " << granted);
    }
    return seen;
}

} // namespace

TEST_CASE("no value of an example or a library entry is further off than is bounded") {
    Seen all;
    const auto ask = [&](const std::string &name, const driver::Compilation &c) {
        if (!c.good() || c.scene.top_level.empty()) return;
        INFO(name);
        const Seen seen = attack(c.scene, 2.5, 200);
        CHECK(seen.ratio <= 1);
        all.ratio = std::max(all.ratio, seen.ratio);
        all.bounded += seen.bounded, all.all += seen.all;
    };
    namespace fs = std::filesystem;
    for (const fs::directory_entry &entry :
         fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "examples"))
        if (entry.path().extension() == ".sdf")
            ask(entry.path().filename().string(), driver::compile_file(entry.path(), {}));
    for (const test::LibraryExample &entry : test::library_examples())
        ask(entry.name,
            driver::compile_text("entry.sdf", entry.text, FATHOM_SOURCE_DIR "/examples/parts", {}));
    std::printf("%d of %d points have a bound; errors reach %.3f of it\n", all.bounded, all.all,
                all.ratio);
    CHECK(all.bounded > 0.9 * all.all);
    CHECK(all.ratio > 0.05); // else nothing is tested
}

TEST_CASE("families of fields that lose digits are seen") {
    // Offsets, factors and moments at which no digit, some and most are lost; each is fine, warned
    // of or refused by how many are left.
    const auto verdict = [](const std::string &text) {
        const driver::Compilation c = driver::compile_text("f.sdf", text, ".", {});
        if (!c.good()) return 2;
        if (c.scene.rounding.subtracted > 0) return 1;
        return c.scene.rounding.bounded ? 0 : 3;
    };
    const auto number = [](double x) { return std::to_string(static_cast<long long>(x)); };
    for (const double far : {1e1, 1e5, 1e6, 1e10}) {
        const std::string n = number(far);
        const int wanted = far < 1e3 ? 0 : far < 1e8 ? 1 : 2;
        const std::vector<std::string> fields{
            "p.y - 0.05 * sin(10 * (p.x + " + n + "))",
            "length(p) - 0.5 - 0.1 * noise(3 * p + " + n + ")",
            "p.y + 0.5 * ((p.x + " + n + ") - " + n + ")",
            "p.y + 0.2 * abs(fract(p.x + " + n + ".3) - 0.5)",
            "length(p + [" + n + ", 0, 0] - [" + n + ".5, 0, 0]) - 0.4",
        };
        for (const std::string &field : fields) {
            INFO(field);
            const int found = verdict("implicit(p => " + field + ", within: ball(1))");
            if (wanted == 0)
                CHECK((found == 0 || found == 3)); // no warning
            else
                CHECK((found == 1 || found == 2));
        }
    }
    CHECK(verdict("implicit(p => 0.3 * (exp(1e-6 * p.x) - 1) * 1e6 + p.y, within: ball(1))") == 1);
    CHECK(verdict("implicit(p => length(1e20 * p) / 1e20 - 0.5, within: ball(1))") == 2);
    CHECK(verdict("implicit(p => length(1e-25 * p) * 1e25 - 0.5, within: ball(1))") == 2);
}
