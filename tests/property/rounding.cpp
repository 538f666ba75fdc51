// The bound of rounding errors, attacked: at every example and library entry, at random points, what
// single precision computes lies as near to what is meant as proof/rounding.h says, and is what
// proof/trials.h says. Then families of fields: those that lose digits are seen, and no other.
#include "proof/rounding.h"
#include "base/single.h"
#include "driver/compile.h"
#include "proof/field.h"
#include "proof/trials.h"
#include "tests/support/library_entries.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

using namespace fathom;
using ir::Interval;

namespace {

// The largest error seen over the one that is bounded, and how many points had a bound.
struct Seen {
    double ratio = 0, tried = 0, boxed = 0; // of the evaluator, and of trials
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
    std::vector<std::array<double, 4>> numbers;
    for (const auto &param : params)
        numbers.push_back({param[0].lo, param[1].lo, param[2].lo, param[3].lo});
    proof::Trials trials(scene, scene.distance);
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
        if (scene.images.empty() && scene.grids.empty()) {
            const proof::Trial trial = trials.at(p, 0, numbers);
            const double unlike = std::max({std::fabs(trial.computed - double(values[k])) / 2,
                                            meant.lo - trial.meant, trial.meant - meant.hi});
            seen.tried = std::max(seen.tried, unlike / granted);
            if (!(unlike <= granted))
                UNSCOPED_INFO("at " << p[0] << ", " << p[1] << ", " << p[2] << ": " << values[k]
                                    << " is tried as " << trial.computed << ", meant "
                                    << trial.meant << " of " << meant.lo << ".." << meant.hi
                                    << ", bounded by " << granted);
        }
        if (!(off <= granted))
            UNSCOPED_INFO("at " << p[0] << ", " << p[1] << ", " << p[2] << ": " << values[k]
                                << " is " << off << " off, bounded by " << granted);
    }
    // Over boxes of all sizes: no point inside is further off than is bounded for all of them.
    for (int k = 0; k < count / 10; ++k) {
        const double half = reach * std::pow(2.0, -12 * dice.next());
        proof::Cell box;
        for (Interval &x : box.p) {
            const double middle = reach * (2 * dice.next() - 1);
            x = Interval(to_single(middle - half), to_single(middle + half));
        }
        const double e = machine.error(box, 0.0, params);
        if (std::isinf(e)) continue;
        for (int point = 0; point < 8; ++point) {
            test::Point3 p{};
            for (std::size_t i = 0; i < 3; ++i)
                p[i] = to_single(box.p[i].lo + box.p[i].width() * dice.next());
            const proof::Trial trial = trials.at(p, 0, numbers);
            seen.boxed = std::max(seen.boxed, trial.error() / (e + 1e-12));
        }
    }
    return seen;
}

enum Verdict { Fine, Coarse, Refused, Failed };
Verdict verdict(const std::string &text) {
    const driver::Compilation c = driver::compile_text("f.sdf", text, ".", {});
    Verdict out = c.scene.rounding.subtracted > 0 ? Coarse : Fine;
    for (const Diagnostic &d : c.diagnostics.items()) {
        if (d.severity != Severity::Error) continue;
        UNSCOPED_INFO(d.message);
        out = d.code == Code::NumberRange && out != Failed ? Refused : Failed;
    }
    return out;
}

} // namespace

TEST_CASE("no value of an example or a library entry is further off than is bounded") {
    Seen all;
    const auto ask = [&](const std::string &name, const driver::Compilation &c) {
        if (!c.good() || c.scene.top_level.empty()) return;
        INFO(name);
        const Seen seen = attack(c.scene, 2.5, 200);
        CHECK(seen.ratio <= 1);
        CHECK(seen.tried <= 1);
        CHECK(seen.boxed <= 1);
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
    const auto number = [](double x) { return std::to_string(static_cast<long long>(x)); };
    for (const double far : {1e1, 1e6, 1e10}) {
        const std::string n = number(far);
        const std::vector<std::string> fields{
            "p.y - 0.05 * sin(10 * (p.x + " + n + "))",
            "length(p) - 0.5 - 0.1 * noise(3 * p + " + n + ")",
            "p.y + 0.5 * ((p.x + " + n + ") - " + n + ")",
            "p.y + 0.2 * abs(fract(p.x + " + n + ".3) - 0.5)",
            "length(p + [" + n + ", 0, 0] - [" + n + ".5, 0, 0]) - 0.4",
        };
        for (const std::string &field : fields) {
            INFO(field);
            const Verdict found = verdict("implicit(p => " + field + ", within: ball(1))");
            if (far < 1e3)
                CHECK(found == Fine);
            else
                CHECK((found == Coarse || found == Refused));
        }
    }
    CHECK(verdict("implicit(p => 0.3 * (exp(1e-6 * p.x) - 1) * 1e6 + p.y, within: ball(1))") ==
          Coarse);
    CHECK(verdict("implicit(p => length(1e20 * p) / 1e20 - 0.5, within: ball(1))") == Refused);
    // Powers that processors have as subnormal numbers and graphics cards as 0.
    for (const std::string root : {"sqrt(sqrt(sqrt(sqrt(s))))", "pow(s, 1 / 16)"})
        for (const std::string power : {"pow(x, 16)", "pow(x, 8) * pow(x, 8)"}) {
            const auto field = [&](const std::string &radius) {
                return "fn power(x: float) -> float = " + power +
                       "\nfn f(p: vec3) -> float {\n"
                       "  let s = power(p.x) + power(p.y) + power(p.z)\n  " +
                       root + " - " + radius + "\n}\nimplicit(f, within: ball(0.1))";
            };
            INFO(field("0.003"));
            CHECK(verdict(field("0.003")) != Fine);
            CHECK(verdict(field("0.03")) == Fine);
        }
    CHECK(verdict("implicit(p => length(1e-25 * p) * 1e25 - 0.5, within: ball(1))") == Refused);
}

TEST_CASE("fields that lose their digits are warned of or refused, and no others") {
    // Where the error is not bounded and not seen, that is an axiom.
    std::ifstream in(FATHOM_SOURCE_DIR "/tests/property/rounding.sdf");
    std::vector<std::pair<std::string, std::string>>
        fields; // "keeps" or "loses" and a name, a text
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("//==== "))
            fields.emplace_back(line.substr(7), "");
        else if (!fields.empty())
            fields.back().second += line + "\n";
    CHECK(fields.size() > 80);
    for (const auto &[name, text] : fields) {
        INFO(name << ": " << text);
        const Verdict found = verdict(text);
        if (name.starts_with("keeps"))
            CHECK(found == Fine);
        else
            CHECK((found == Coarse || found == Refused));
    }
}
