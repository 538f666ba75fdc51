// Random repetitions against the plain union of their copies: the sign is the union's, the safe
// ball is the union's, and no guard takes more than half a cell leaves. Many boxes just fill their
// cells, and many points lie on cells' walls. FATHOM_EFFORT and FATHOM_SEED in the environment make
// it longer, or another.
#include "judge.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Lattice {
    std::string motif, other, text; // `other`: the copies of odd index along x, where they differ
    std::array<double, 3> cell{};   // 0: not repeated
    std::array<int, 3> count{};     // 0: without end
    bool mirrored = false;
    double unit = 1;
};

// A motif of about the unit's size; `fill` is a width that just fills the cell.
std::string motif_of(Chance &random, double unit, const std::array<double, 3> &cell) {
    const auto n = [&](double x) { return Chance::number(x * unit); };
    const auto v = [&](double x, double y, double z) {
        return "[" + n(x) + ", " + n(y) + ", " + n(z) + "]";
    };
    const auto fill = [&](std::size_t a) { return cell[a] > 0 ? cell[a] / unit : 1.0; };
    std::string ball = "sphere(" + n(0.5) + ")";
    switch (random.pick(12)) {
    case 0: return "sphere(" + n(0.3) + ")";
    case 1: return ball;
    case 2: return "ellipsoid(" + v(fill(0) / 2, 0.3, fill(2) / 2) + ")";
    case 3: return "ellipsoid(" + v(0.3, fill(1) / 2, 0.2) + ")";
    case 4: return "box(" + v(fill(0), fill(1), 0.5) + ")";
    case 5: return "box(" + v(0.4, fill(1), fill(2)) + ")";
    case 6: return "(" + ball + " - sphere(" + n(0.3) + ").translate(z: " + n(0.4) + "))";
    case 7: return "smooth_union(" + n(0.1) + ") { " + ball + "; box(" + n(0.3) + ") }";
    case 8: return "cylinder(" + n(0.3) + ", " + n(fill(1)) + ")";
    case 9: return "superquadric(" + v(0.3, 0.5, 0.3) + ", 0.5, 0.5)";
    case 10: return "torus(" + n(0.3) + ", " + n(0.2) + ")";
    default: return "(" + ball + " & box(" + v(0.6, 2, 1) + "))";
    }
}

Lattice random_lattice(Chance &random) {
    Lattice out;
    out.unit = std::array{0.01, 0.1, 1.0, 1.0, 3.0, 100.0}[random.pick(6)];
    const auto n = [&](double x) { return Chance::number(x * out.unit); };
    const auto some = [&] {
        return "[" + n(out.cell[0] / out.unit) + ", " + n(out.cell[1] / out.unit) + ", " +
               n(out.cell[2] / out.unit) + "]";
    };
    while (out.cell == std::array{0.0, 0.0, 0.0})
        for (double &c : out.cell)
            c = std::stod(n(std::array{0.0, 1.0, 1.0, 1.0, 1.5}[random.pick(5)]));
    out.motif = motif_of(random, out.unit, out.cell);
    if (random.pick(4) > 0) {
        out.motif += ".translate([";
        for (int a = 0; a < 3; ++a)
            out.motif += (a ? ", " : "") +
                         n(std::array{0.0, 0.0, 0.0, 0.2, -0.25, 0.3, 0.5, 1.3}[random.pick(8)]);
        out.motif += "])";
    }
    out.mirrored = random.often();
    if (out.mirrored) {
        out.text = out.motif + ".repeat_mirror(" + some() + ")";
        return out;
    }
    out.text = out.motif + ".repeat(" + some();
    if (random.often()) {
        out.text += ", count: [";
        for (std::size_t a = 0; a < 3; ++a) {
            out.count[a] = out.cell[a] > 0 ? 1 + int(random.pick(4)) : 1;
            out.text += (a ? ", " : "") + std::to_string(out.count[a]);
        }
        out.text += "]";
    }
    if (random.pick(4) == 0) {
        out.other = out.motif + ".scale(0.5)";
        out.text += ", copies: (s, id) => s.scale(1 - 0.5 * (id.x % 2))";
    }
    out.text += ")";
    return out;
}

// The least of the copies' fields, those near p alone.
class Union {
  public:
    Union(const Lattice &lattice, const ir::Scene &motif, const ir::Scene *other)
        : lattice_(lattice), motif_(motif), other_(other ? *other : motif) {}

    std::vector<float> values(const std::vector<Point3> &points) {
        std::vector<float> out;
        for (const Point3 &p : points) {
            std::vector<Point3> even, odd;
            for (const std::array<int, 3> &id : near(p)) {
                Point3 q = p;
                for (std::size_t a = 0; a < 3; ++a) {
                    q[a] -= (id[a] - middle(a)) * lattice_.cell[a];
                    if (lattice_.mirrored && id[a] % 2 != 0) q[a] = -q[a];
                }
                (id[0] % 2 != 0 ? odd : even).push_back(q);
            }
            float least = std::numeric_limits<float>::infinity();
            for (float d : motif_.values(even)) least = std::min(least, d);
            for (float d : other_.values(odd)) least = std::min(least, d);
            out.push_back(least);
        }
        return out;
    }

  private:
    const Lattice &lattice_;
    Sampler motif_, other_;

    double middle(std::size_t a) const {
        return lattice_.count[a] > 0 ? (lattice_.count[a] - 1) / 2.0 : 0;
    }
    std::vector<std::array<int, 3>> near(const Point3 &p) const {
        std::array<int, 3> lo{}, hi{};
        for (std::size_t a = 0; a < 3; ++a) {
            if (!(lattice_.cell[a] > 0)) continue;
            const int own = int(std::lround(p[a] / lattice_.cell[a] + middle(a)));
            lo[a] = own - 4, hi[a] = own + 4;
            if (lattice_.count[a] == 0) continue;
            lo[a] = std::clamp(lo[a], 0, lattice_.count[a] - 1);
            hi[a] = std::clamp(hi[a], 0, lattice_.count[a] - 1);
        }
        std::vector<std::array<int, 3>> out;
        for (int i = lo[0]; i <= hi[0]; ++i)
            for (int j = lo[1]; j <= hi[1]; ++j)
                for (int k = lo[2]; k <= hi[2]; ++k) out.push_back({i, j, k});
        return out;
    }
};

// In some cells about the origin; half of all coordinates on a wall or in a middle, or beside it.
Point3 point_of(Chance &random, const Lattice &lattice) {
    Point3 p;
    for (std::size_t a = 0; a < 3; ++a) {
        const double cell = lattice.cell[a] > 0 ? lattice.cell[a] : lattice.unit;
        const double x = 4 * random.random() - 2;
        p[a] = cell * x;
        if (random.often()) p[a] = cell * std::round(2 * x) / 2;
        if (random.pick(4) == 0) p[a] += 1e-5 * cell * (random.random() - 0.5);
        p[a] = float(p[a]);
    }
    return p;
}

driver::Compilation compiled(const std::string &text) {
    return driver::compile_text("repeat.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
}

std::string judged(const Lattice &lattice, const ir::Scene &scene, Union &plain, Chance &random,
                   int count) {
    Sampler field(scene);
    double rounding = 2e-5 * lattice.unit, half = lattice.unit / 2;
    std::vector<Point3> p, q;
    for (int i = 0; i < count; ++i) p.push_back(point_of(random, lattice));
    const std::vector<float> d = field.values(p), truth = plain.values(p);
    for (std::size_t i = 0; i < p.size(); ++i)
        q.push_back(field.in_ball(p[i], std::fabs(double(d[i]))));
    const std::vector<float> there = plain.values(q);
    for (std::size_t i = 0; i < p.size(); ++i) {
        const std::string told =
            fmt::format("it is {} at {} and {} without guards", d[i], text_of(p[i]), truth[i]);
        if ((d[i] <= 0) != (truth[i] <= 0) && std::fabs(truth[i]) > rounding)
            return "another solid: " + told;
        if (std::fabs(d[i]) > rounding && std::fabs(there[i]) > rounding &&
            (d[i] < 0) != (there[i] < 0))
            return fmt::format("a step too far: {}; {} at {}", told, there[i], text_of(q[i]));
        // Copies that are not asked are half a cell away.
        if (truth[i] > 0 && d[i] < 0.99 * std::min(double(truth[i]), half) - rounding)
            return "a guard presses: " + told;
    }
    const double reach = 2 * lattice.unit;
    const Slopes slopes = measure(scene, {-reach, -reach, -reach}, {reach, reach, reach}, count);
    if (lattice.unit == 1 && slopes.steepest > 1 + 5e-3)
        return fmt::format("it is {} steep at {}", slopes.steepest, text_of(slopes.where));
    return {};
}

} // namespace

TEST_CASE("random repetitions have the sign and the safe ball of the union of their copies") {
    const int scenes = test::effort(250);
    int good = 0;
    for (int i = 0; i < scenes; ++i) {
        Chance random(std::uint64_t(test::seed()) * 1'000'003u + std::uint64_t(i));
        const Lattice lattice = random_lattice(random);
        INFO(lattice.text);
        const driver::Compilation all = compiled(lattice.text), one = compiled(lattice.motif);
        REQUIRE(one.good());
        if (!all.good()) continue; // too many copies
        driver::Compilation other;
        if (!lattice.other.empty()) other = compiled(lattice.other);
        Union plain(lattice, one.scene, lattice.other.empty() ? nullptr : &other.scene);
        const std::string wrong = judged(lattice, all.scene, plain, random, 1024);
        CHECK(wrong == "");
        good += wrong.empty();
    }
    std::printf("%d of %d repetitions are their unions\n", good, scenes);
    CHECK(good > scenes * 2 / 3);
}
