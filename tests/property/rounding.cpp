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
    CHECK(verdict("implicit(p => length(1e-25 * p) * 1e25 - 0.5, within: ball(1))") == Refused);
}

// Long: a list of fields.
TEST_CASE("fields that keep their digits are not warned of") {
    // Folds, seams, cells, loops and deep nestings: where the error is not bounded, that is an axiom.
    const std::vector<std::pair<const char *, const char *>> fields{
        {"exp small", R"(implicit(p => p.y - 0.2 * exp(-4 * dot(p, p)), within: ball(2)))"},
        {"far camera",
         R"(camera([0, 0, 500], look_at: [0, 0, 0])
sphere(10))"},
        {"fract wave", R"(implicit(p => p.y + 0.2 * abs(fract(3 * p.x) - 0.5), within: ball(1)))"},
        {"hash cells",
         R"(implicit(p => {
  let c = floor(2 * p.x)
  let f = fract(2 * p.x)
  let h = fract(sin(c * 12.9898) * 43758.5453)
  let g = fract(sin((c + 1) * 12.9898) * 43758.5453)
  p.y - 0.1 * mix(h, g, f * f * (3 - 2 * f))
}, within: ball(2)))"},
        {"huge", R"(sphere(1e6) | box(3e5).translate(x: 2e6))"},
        {"inversion",
         R"(implicit(p => length(p / dot(p, p)) - 1, within: ball(2) - ball(0.5), estimate: 8))"},
        {"log min",
         R"(implicit(p => -0.1 * log(exp(-10 * (length(p) - 0.5)) + exp(-10 * (length(p - [0.6, 0, 0]) - 0.4))), within: ball(2)))"},
        {"matrix loop",
         R"(implicit(p => {
  var q = p
  for i in 0..6 {
    q = abs(q) - 0.3
    q = [0.8 * q.x - 0.6 * q.y, 0.6 * q.x + 0.8 * q.y, q.z]
  }
  length(q) - 0.1
}))"},
        {"menger",
         R"(implicit(p => {
  var d = max(abs(p.x), max(abs(p.y), abs(p.z))) - 1
  var s = 1.0
  for i in 0..4 {
    let a = (p * s) % 2 - 1
    s *= 3
    let r = abs(1 - 3 * abs(a))
    let c = (min(max(r.x, r.y), min(max(r.y, r.z), max(r.z, r.x))) - 1) / s
    d = max(d, c)
  }
  d
}, within: ball(3)))"},
        {"mod wave", R"(implicit(p => p.y + 0.2 * abs((p.x % 0.3) - 0.15), within: ball(2)))"},
        {"nested repeat",
         R"(sphere(0.1).repeat([0.5, 0.5, 0], [2, 2, 1]).translate(x: 3).repeat_polar(5).rotate(0.3, axis: X))"},
        {"noise moved",
         R"(implicit(p => length(p) - 0.8 - 0.1 * noise(3 * p + 10 * time), within: ball(1))
render(time: 20))"},
        {"octaves",
         R"(implicit(p => {
  var d = 0
  var a = 0.1
  var q = p
  for i in 0..5 { d += a * noise(q)
   q = q * 2 + 1.7
   a *= 0.5 }
  (length(p) - 0.8 - d)
}, within: ball(1)))"},
        {"param",
         R"(param k = 3 in 1..20
implicit(p => p.y - 0.05 * sin(k * p.x), within: ball(1)))"},
        {"polar fold",
         R"(implicit(p => {
  let a = (atan(p.z, p.x) + 0.3) % (tau / 6) - tau / 12
  let r = length(p.xz)
  length([r * cos(a) - 0.6, p.y, r * sin(a)]) - 0.15
}, within: ball(1) - tube(Y, 0.1), estimate: 1))"},
        {"polar fold2",
         R"(implicit(p => length(p.xz) * 0.2 * abs((atan(p.z, p.x) + 0.3) % (tau / 6) - tau / 12) + length(p) - 0.7, within: ball(1) - tube(Y, 0.2)))"},
        {"quotient", R"(implicit(p => p.y - 0.1 / (1 + 10 * p.x * p.x), within: ball(2)))"},
        {"repeat", R"(sphere(0.3).repeat([1, 0, 1]))"},
        {"repeat big", R"(sphere(0.3).repeat([1, 1, 1], [40, 40, 40]))"},
        {"repeat polar", R"(box(0.1).translate(x: 1).repeat_polar(7))"},
        {"rotate time", R"(box(0.5).rotate(30 * time, axis: Y).translate(x: sin(100 * time)))"},
        {"smooth", R"(blend(sphere(0.5), box(0.4).translate(x: 0.5), 0.2))"},
        {"spiral time", R"(implicit(p => p.y - 0.05 * sin(10 * p.x + time), within: ball(1)))"},
        {"sqrt zero", R"(implicit(p => sqrt(dot(p, p) + 0.01) - 0.5))"},
        {"tiny", R"(sphere(1e-4))"},
        {"tiny many", R"((sphere(1e-4) | box(2e-4).translate(x: 5e-4)).scale(0.1))"},
        {"translate far seen", R"(sphere(1).translate(x: 50))"},
        {"twist", R"(box([0.3, 1, 0.3]).twist(90deg))"},
        {"waves axis",
         R"(implicit(p => length(p.xz) - 0.5 - 0.05 * sin(6 * atan(p.z, p.x)) , within: ball(1) - tube(Y, 0.2)))"},
        {"bend", R"(box([2, 0.2, 0.2]).bend(1))"},
        {"bulb", R"(mandelbulb())"},
        {"deep",
         R"(sphere(0.3).translate(x: 0.1).rotate(0.1, axis: X).translate(x: 0.2).rotate(0.2, axis: Y).translate(x: 0.3).rotate(0.3, axis: Z).translate(x: 0.4).rotate(0.4, axis: X).translate(x: 0.5).rotate(0.5, axis: Y).translate(x: 0.6).rotate(0.6, axis: Z).translate(x: 0.7).rotate(0.7, axis: X).translate(x: 0.8).rotate(0.1, axis: Y).translate(x: 0.9).rotate(0.2, axis: Z).translate(x: 0.1).rotate(0.3, axis: X).translate(x: 0.2).rotate(0.4, axis: Y).translate(x: 0.3).rotate(0.5, axis: Z).translate(x: 0.4).rotate(0.6, axis: X).translate(x: 0.5).rotate(0.7, axis: Y).translate(x: 0.6).rotate(0.1, axis: Z).translate(x: 0.7).rotate(0.2, axis: X).translate(x: 0.8).rotate(0.3, axis: Y).translate(x: 0.9).rotate(0.4, axis: Z).translate(x: 0.1).rotate(0.5, axis: X).translate(x: 0.2).rotate(0.6, axis: Y).translate(x: 0.3).rotate(0.7, axis: Z).translate(x: 0.4).rotate(0.1, axis: X).translate(x: 0.5).rotate(0.2, axis: Y).translate(x: 0.6).rotate(0.3, axis: Z).translate(x: 0.7).rotate(0.4, axis: X).translate(x: 0.8).rotate(0.5, axis: Y).translate(x: 0.9).rotate(0.6, axis: Z).translate(x: 0.1).rotate(0.7, axis: X).translate(x: 0.2).rotate(0.1, axis: Y).translate(x: 0.3).rotate(0.2, axis: Z))"},
        {"extrude", R"(star(5, 1, 0.5).extrude(0.4))"},
        {"fbm",
         R"(implicit(p => length(p) - 0.8 - 0.1 * fbm(3 * p, octaves: 5), within: ball(1.2)))"},
        {"grid cells",
         R"(implicit(p => {
  let c = round(p / 0.5)
  let h = hash(c)
  length(p - 0.5 * c) - 0.1 - 0.05 * sin(h)
}, within: ball(2), estimate: 2))"},
        {"gyroid big",
         R"(implicit(p => (sin(2*p.x)*cos(2*p.y) + sin(2*p.y)*cos(2*p.z) + sin(2*p.z)*cos(2*p.x)) / 4, within: ball(6)))"},
        {"kaleido",
         R"(implicit(p => {
  let r = length(p.xz)
  let a = atan(p.z, p.x)
  let s = abs((a + pi) % (tau / 8) - tau / 16)
  length([r * cos(s) - 0.6, p.y, r * sin(s)]) - 0.2
}, within: ball(1) - tube(Y, 0.1), estimate: 3))"},
        {"log spiral",
         R"(implicit(p => p.y - 0.05 * sin(3 * atan(p.z, p.x) + 4 * log(length(p.xz))), within: ball(1) - tube(Y, 0.15)))"},
        {"mandelbox",
         R"(implicit(p => {
  var z = p
  var dr = 1.0
  for i in 0..6 {
    z = clamp(z, -1, 1) * 2 - z
    let r2 = dot(z, z)
    let k = clamp(1 / max(r2, 0.25), 1, 4)
    z = z * k * 2 + p
    dr = dr * k * 2 + 1
  }
  length(z) / dr
}, within: ball(4), estimate: 2))"},
        {"many",
         R"(for i in 0..60 { sphere(0.1 + 0.05 * hash(i)).translate([3 * hash(i + 100), 2 * hash(i + 200), 3 * hash(i + 300)]) })"},
        {"plane scene",
         R"(plane(Y)
sphere(1).translate(y: 1)
torus(2, 0.3).rotate(90deg, axis: X))"},
        {"revolve", R"(circle(0.3).translate([0.8, 0]).revolve())"},
        {"ridged", R"(sphere(1).displace(p => 0.05 * ridged(4 * p, octaves: 4)))"},
        {"scaled big",
         R"(union { sphere(1)
 box(0.5).translate(x: 1.2) }.scale(1e4))"},
        {"scaled small",
         R"(union { sphere(1)
 box(0.5).translate(x: 1.2) }.scale(1e-3))"},
        {"sierpinski",
         R"(implicit(p => {
  var z = p
  for i in 0..8 {
    if z.x + z.y < 0 { z = [-z.y, -z.x, z.z] }
    if z.x + z.z < 0 { z = [-z.z, z.y, -z.x] }
    if z.y + z.z < 0 { z = [z.x, -z.z, -z.y] }
    z = 2 * z - 1
  }
  length(z) * 0.00390625 - 0.005
}, within: ball(2)))"},
        {"small time",
         R"(render(time: 5)
sphere(0.3).translate([sin(time), 0, cos(3 * time)]))"},
        {"smax",
         R"(implicit(p => smax(length(p) - 0.8, 0.2 - length(p.xz), 0.2), within: ball(1.2)))"},
        {"spiral",
         R"(implicit(p => p.y - 0.05 * sin(3 * atan(p.z, p.x) + 8 * length(p.xz)), within: ball(1) - tube(Y, 0.15)))"},
        {"taper", R"(box([0.5, 2, 0.5]).taper(0.5))"},
        {"terrain",
         R"(implicit(p => (p.y - 0.4 * noise(0.7 * [p.x, 0, p.z]) - 0.1 * noise(3 * p)), within: aabb([-8, -2, -8], [8, 2, 8])))"},
        {"value noise time",
         R"(render(time: 60)
implicit(p => p.y - 0.1 * value_noise(2 * p + time), within: ball(1.5)))"},
        {"warp",
         R"(implicit(p => {
  let q = p + 0.2 * [noise(3 * p), noise(3 * p + 5.2), noise(3 * p + 9.1)]
  length(q) - 0.6
}, within: ball(1.2)))"},
        {"worley", R"(implicit(p => length(p) - 0.8 - 0.1 * worley(4 * p), within: ball(1.2)))"},
    };
    for (const auto &[name, text] : fields) {
        INFO(name << ": " << text);
        CHECK(verdict(text) == Fine);
    }
}

// Long: a list of fields.
TEST_CASE("fields that lose their digits are warned of or refused") {
    const std::vector<std::pair<const char *, const char *>> fields{
        {"add sub", R"(implicit(p => p.y + 0.5 * ((p.x + 1e5) - 1e5), within: ball(1)))"},
        {"cos cancel",
         R"(implicit(p => p.y + 0.3 * (1 - cos(1e-4 * p.x)) * 1e8 , within: ball(1), estimate: 3))"},
        {"exp cancel",
         R"(implicit(p => 0.3 * (exp(1e-6 * p.x) - 1) * 1e6 + p.y, within: ball(1)))"},
        {"fract off",
         R"(implicit(p => p.y + 0.2 * abs(fract(p.x + 1000000.3) - 0.5), within: ball(1)))"},
        {"log cancel",
         R"(implicit(p => p.y + 0.4 * (log(1 + 1e-5 * p.x)) * 1e5, within: ball(1)))"},
        {"loop grow",
         R"(implicit(p => {
  var x = p.x
  for i in 0..20 { x = x + 30000 }
  for i in 0..20 { x = x - 30000 }
  p.y + 0.5 * x
}, within: ball(1)))"},
        {"matrix far",
         R"(implicit(p => {
  let q = [0.8 * p.x - 0.6 * p.y + 2e5, 0.6 * p.x + 0.8 * p.y, p.z]
  length(q - [2e5, 0, 0]) - 0.5
}, within: ball(1)))"},
        {"mirrored mod",
         R"(implicit(p => p.y - 0.2 * abs((p.x + 654321.7) % 0.7 - 0.35), within: ball(1)))"},
        {"noise 1e6",
         R"(implicit(p => length(p) - 0.8 - 0.1 * noise(3 * p + 1e6), within: ball(1)))"},
        {"noise time",
         R"(implicit(p => length(p) - 0.8 - 0.1 * noise(4 * p + 300 * time), within: ball(1)))"},
        {"offset 1e10",
         R"(implicit(p => length(p + [1e10, 0, 0] - [1e10, 0, 0]) - 0.4, within: ball(1)))"},
        {"overflow", R"(implicit(p => length(1e20 * p) / 1e20 - 0.5, within: ball(1)))"},
        {"param far",
         R"(param k = 3 in 1..1000000
implicit(p => p.y - 0.05 * sin(3 * (p.x + k)), within: ball(1)))"},
        {"pow cancel",
         R"(implicit(p => p.y + 0.4 * (pow(1 + 1e-5 * p.x, 2) - 1) * 5e4, within: ball(1)))"},
        {"repeat 1e5",
         R"(implicit(p => length((p + [1000000.3, 0, 0]) % 1 - 0.5) - 0.3, within: ball(3)))"},
        {"repeat shape",
         R"(sphere(0.3).repeat([1, 0, 0]).translate(x: 100000.3)
camera([0, 0, 5], look_at: [0, 0, 0]))"},
        {"sin hour", R"(implicit(p => p.y - 0.05 * sin(10 * (p.x + 30 * time)), within: ball(1)))"},
        {"sqrt far",
         R"(implicit(p => 0.5 * (sqrt(1e12 + dot(p, p) * 1e6) - 1e6) + p.y, within: ball(1)))"},
        {"time scroll",
         R"(implicit(p => p.y - 0.1 * abs(fract(p.x + 1000 * time) - 0.5), within: ball(1)))"},
        {"underflow", R"(implicit(p => length(1e-25 * p) * 1e25 - 0.5, within: ball(1)))"},
        {"union part",
         R"(union {
  sphere(0.5).translate(x: -1)
  implicit(p => length(p + [1e5, 0, 0] - [1e5, 0, 0]) - 0.5, within: ball(1)).translate(x: 0.6)
})"},
        {"worley far",
         R"(implicit(p => length(p) - 0.8 - 0.1 * worley(4 * p + 3e5), within: ball(1)))"},
        {"acosh", R"(implicit(p => p.y + 0.3 * ((1 + 1e-6 * p.x) - 1) * 1e6, within: ball(1)))"},
        {"displace", R"(sphere(1).displace(p => 0.05 * sin(8 * (p.x + 5e5))))"},
        {"displace time", R"(sphere(1).displace(p => 0.05 * sin(20 * (p.y + 100 * time))))"},
        {"height",
         R"(implicit(p => p.y - 0.1 * fbm(2 * p + 4e6, octaves: 3), within: aabb([-2, -1, -2], [2, 1, 2])))"},
        {"if arm",
         R"(implicit(p => if p.y > 0 { length(p) - 0.6 } else { length(p + [3e5, 0, 0] - [3e5, 0, 0]) - 0.6 }, within: ball(1), estimate: 2))"},
        {"loop sum",
         R"(implicit(p => {
  var s = p.x
  for i in 0..12 { s = s * 3 + 7 }
  for i in 0..12 { s = (s - 7) / 3 }
  p.y + 0.5 * s + 0.0 * p.z + 0.4 * ((p.x + 2e5) - 2e5)
}, within: ball(1)))"},
        {"many one",
         R"(for i in 0..30 { sphere(0.1 + 0.05 * hash(i)).translate([3 * hash(i + 100), 2 * hash(i + 200), 3 * hash(i + 300)]) }
implicit(p => length(p) - 0.8 - 0.1 * noise(3 * p + 5e6), within: ball(1.2)).translate(x: -1))"},
        {"matrix",
         R"(implicit(p => {
  let q = rotate2(p.xy + 3e5, 0.5)
  let r = rotate2(q, -0.5) - 3e5
  length([r.x, r.y, p.z]) - 0.5
}, within: ball(1)))"},
        {"param time",
         R"(param speed = 1 in 0..500
implicit(p => p.y - 0.05 * sin(8 * (p.x + speed * time)), within: ball(1)))"},
        {"smooth far",
         R"(implicit(p => smin(length(p + [2e5, 0, 0] - [2e5, 0, 0]) - 0.5, p.y + 0.3, 0.2), within: ball(1)))"},
        {"spiral fast",
         R"(implicit(p => p.y - 0.05 * sin(3 * atan(p.z, p.x) + 8 * (length(p.xz) + 40 * time)), within: ball(1) - tube(Y, 0.15)))"},
        {"tan", R"(implicit(p => p.y + 0.3 * (tan(1e-6 * p.x) + 1 - 1) * 1e6, within: ball(1)))"},
        {"twist fast",
         R"(box([0.3, 1, 0.3]).translate(y: 100000).twist(90deg).translate(y: -100000))"},
        {"under repeat",
         R"(implicit(p => length(p) - 0.3 - 0.1 * noise(3 * p + 5e6), within: ball(0.5)).repeat([1.5, 1.5, 1.5], [2, 2, 2]))"},
        {"under rotate",
         R"(implicit(p => 0.5 * ((p.x + 3e5) - 3e5) + p.y, within: ball(1)).rotate(0.4, axis: Z).translate(z: 2))"},
    };
    for (const auto &[name, text] : fields) {
        INFO(name << ": " << text);
        const Verdict found = verdict(text);
        CHECK((found == Coarse || found == Refused));
    }
}
