// What the searches of the proof share: chance, and a judge that compiles a scene and measures what
// was accepted where fields go wrong: on borders and next to them, on axes and diagonals, on
// surfaces, at params' ends and inside, over time; then closer and closer to where it is steepest.
// FATHOM_EFFORT and FATHOM_SEED in the environment make a search longer, or another; FATHOM_SHOW
// prints what each scene came to.
#pragma once

#include "driver/compile.h"
#include "ir/lower/lower.h"
#include "tests/support/effort.h"
#include "tests/support/slopes.h"

#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <initializer_list>
#include <string>

namespace fathom::test {

// Random numbers and words, the same for the same seed everywhere.
class Chance {
  public:
    // Seeds that follow each other begin far from each other in the one sequence there is.
    explicit Chance(std::uint64_t seed) : state_(seed) { state_ = next() * 0xd1342543de82ef95u; }
    double random() { return double(next() >> 11) * 0x1p-53; }                    // 0..1, without 1
    std::size_t pick(std::size_t n) { return std::size_t(random() * double(n)); } // 0..n-1
    bool often() { return pick(2) == 0; }
    std::string of(std::initializer_list<const char *> texts) {
        return texts.begin()[pick(texts.size())];
    }
    static std::string number(double x) {
        char text[32];
        std::snprintf(text, sizeof text, "%.4g", x);
        return text;
    }
    std::string between(double lo, double hi) { return number(lo + (hi - lo) * random()); }

  private:
    std::uint64_t state_;
    std::uint64_t next() { // splitmix64
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
};

struct Verdict {
    bool accepted = false;
    std::string code, wrong; // the first error; what was measured against the proof
    long pairs = 0;          // of points that were compared
    long again = 0;          // … by another evaluator, too
};

// What may be said of a scene that is well formed.
inline bool is_of_the_proof(Code code) {
    return code == Code::LipschitzUnbounded || code == Code::FieldJump ||
           code == Code::FieldSingular || code == Code::NeedsRegion || code == Code::BadArgument ||
           code == Code::RepeatLimit || code == Code::StageMismatch || code == Code::NumberRange ||
           code == Code::ProofLimit;
}

// Points next to where things turn: coordinates are often a multiple of 1/8, or off by little, but
// by more than single precision loses between two ways to write one number; or next to an axis, or
// to a plane in which two are equal.
inline Point3 near_borders(Chance &random) {
    constexpr double reach = 2;
    Point3 p;
    const auto off = [&] {
        return 0.3 * std::pow(10, -4.5 * random.random()) * (random.random() < 0.5 ? -1 : 1);
    };
    for (double &x : p) {
        const double at = std::round(8 * reach * (random.random() - 0.5) * 2) / 8;
        const double kind = random.random();
        x = kind < 0.3 ? 2 * reach * (random.random() - 0.5) : kind < 0.55 ? at : at + off();
    }
    const std::size_t axis = random.pick(3), next = (axis + 1) % 3, last = (axis + 2) % 3;
    switch (random.pick(8)) {
    case 0: p[next] = off(), p[last] = off(); break;
    case 1: p[next] = (random.often() ? 1 : -1) * p[axis] + off(); break;
    default: break;
    }
    for (double &x : p) x = float(x);
    return p;
}

inline std::string text_of(const Point3 &p) {
    char text[128];
    std::snprintf(text, sizeof text, "[%.9g, %.9g, %.9g]", p[0], p[1], p[2]);
    return text;
}

// Two points and the field there; the marched field is 1-Lipschitz, and a number.
struct Pair {
    Point3 p, q;
    float a = 0, b = 0;

    double way() const { return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]); }
    double rise() const { return std::fabs(double(a) - double(b)); }
    // `off`: what each value may be wrong by in single precision, where that is warned of.
    bool is_wrong(double off) const {
        const double rounding = 6e-5 + 2e-6 * std::fabs(double(a)) + 2 * off;
        return !std::isfinite(a) || !std::isfinite(b) || rise() > way() * 1.002 + rounding;
    }
    std::string text() const {
        return fmt::format("it is {} at {} and {} at {}", a, text_of(p), b, text_of(q));
    }
};

// The middle of each pair takes the place of the end on its less steep side, so that what jumps is
// closed in on; or of the end with its own sign, so that the surface is.
inline void halve(std::vector<Pair> &pairs, Sampler &sampler, bool to_surface) {
    std::vector<Point3> middles;
    for (const Pair &pair : pairs) {
        Point3 m;
        for (std::size_t k = 0; k < 3; ++k) m[k] = float((pair.p[k] + pair.q[k]) / 2);
        middles.push_back(m);
    }
    const std::vector<float> at = sampler.values(middles);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        Pair first = pairs[i], second = pairs[i];
        first.q = second.p = middles[i];
        first.b = second.a = at[i];
        const bool take_first = to_surface
                                    ? (first.a < 0) != (first.b < 0)
                                    : first.rise() * second.way() > second.rise() * first.way();
        pairs[i] = take_first ? first : second;
    }
}

// The values of a scene's marched field at these points and this moment, by another evaluator than
// the processor; and what makes one of a scene.
using Values =
    std::function<std::vector<float>(const ir::Scene &, double, const std::vector<Point3> &)>;
using Evaluator = std::function<Values(const ir::Scene &)>;

// The same pairs by the other evaluator.
inline std::string measured_again(const Values &again, const ir::Scene &scene, double time,
                                  const std::vector<Pair> &pairs, Verdict &counted) {
    counted.again += long(pairs.size());
    std::vector<Point3> points;
    for (const Pair &pair : pairs) points.push_back(pair.p), points.push_back(pair.q);
    const std::vector<float> at = again(scene, time, points);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Pair pair{pairs[i].p, pairs[i].q, at[2 * i], at[2 * i + 1]};
        if (pair.is_wrong(scene.rounding.subtracted)) return "not by the processor: " + pair.text();
    }
    return "";
}

inline std::string measured(const ir::Scene &scene, double time, Chance &random, int count,
                            Verdict &counted, const Values &again = {}) {
    Sampler sampler(scene, time);
    const auto beside = [&](const Point3 &p) {
        Point3 to = p;
        const double far = std::pow(10, -5 + 5 * random.random());
        const bool along = random.random() < 0.6; // one coordinate alone, so across its borders
        const auto axis = random.pick(3);
        for (std::size_t k = 0; k < 3; ++k)
            if (!along || k == axis) to[k] = float(to[k] + far * (random.random() * 2 - 1));
        return to;
    };
    const auto valued = [&](std::vector<Pair> pairs) {
        std::vector<Point3> p, q;
        for (const Pair &pair : pairs) p.push_back(pair.p), q.push_back(pair.q);
        const std::vector<float> a = sampler.values(p), b = sampler.values(q);
        for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].a = a[i], pairs[i].b = b[i];
        return pairs;
    };
    std::string wrong;
    std::vector<Pair> all;
    const auto compare = [&](const std::vector<Pair> &pairs) {
        counted.pairs += long(pairs.size());
        if (again) all.insert(all.end(), pairs.begin(), pairs.end());
        for (const Pair &pair : pairs)
            if (wrong.empty() && pair.is_wrong(scene.rounding.subtracted)) wrong = pair.text();
        return wrong.empty();
    };
    std::vector<Pair> pairs;
    for (int i = 0; i < count; ++i) {
        const Point3 p = near_borders(random);
        pairs.push_back({p, beside(p)});
    }
    pairs = valued(std::move(pairs));
    if (!compare(pairs)) return wrong;

    // The steepest of them, halved; and what lies beside those.
    std::vector<Pair> steep = pairs, surface;
    for (const Pair &pair : pairs)
        if ((pair.a < 0) != (pair.b < 0)) surface.push_back(pair);
    const std::size_t kept = std::min(steep.size(), std::size_t(count / 12 + 1));
    std::partial_sort(steep.begin(), steep.begin() + std::ptrdiff_t(kept), steep.end(),
                      [](const Pair &x, const Pair &y) {
                          const double least = 1e-4; // nearer than that rounding is all there is
                          return x.rise() / (x.way() + least) > y.rise() / (y.way() + least);
                      });
    steep.resize(kept);
    for (int round = 0; round < 10; ++round) {
        halve(steep, sampler, false);
        if (!compare(steep)) return wrong;
    }
    for (int round = 0; round < 12; ++round) halve(surface, sampler, true);
    std::vector<Pair> around;
    for (const auto *from : {&steep, &surface})
        for (const Pair &pair : *from)
            for (int i = 0; i < 2; ++i) around.push_back({pair.p, beside(pair.p)});
    if (!compare(valued(std::move(around))) || !again) return wrong;
    return measured_again(again, scene, time, all, counted);
}

inline Verdict judge(const std::string &text, Chance &random, int pairs,
                     const Evaluator &other = {}) {
    Verdict out;
    driver::Compilation c = driver::compile_text("adversary.sdf", text, "", {});
    if (!c.good()) {
        for (const Diagnostic &d : c.diagnostics.items())
            if (d.severity == Severity::Error) {
                if (out.code.empty()) out.code = std::string(code_name(d.code)) + ": " + d.message;
                if (!is_of_the_proof(d.code)) out.wrong = "no scene: " + d.message;
            }
        return out;
    }
    out.accepted = true;
    // Steps by cells are as long as is safe, and no slope of anything.
    c.scene.cells.clear();
    ir::lower(c.scene);
    const Values again = other ? other(c.scene) : Values{};
    for (const double part : {0.0, 1.0, 0.5, 0.37, 1.0 / 3}) {
        for (ir::Param &k : c.scene.params) // those that decide what there is are compiled in
            if (!k.structural) k.value[0] = k.lo[0] + (k.hi[0] - k.lo[0]) * part;
        const double time = std::min(c.scene.render.time_end, 10.0) * part;
        out.wrong = measured(c.scene, time, random, pairs, out, again);
        if (!out.wrong.empty()) {
            if (!c.scene.params.empty())
                out.wrong += fmt::format(", k = {}", c.scene.params[0].value[0]);
            out.wrong += fmt::format(", time = {}", time);
            return out;
        }
    }
    return out;
}

struct Judged {
    int scenes = 0, accepted = 0, wrong = 0;
    long pairs = 0, again = 0; // as a verdict counts them
};
// So many scenes that a `Random`, a Chance with a `scene()`, writes.
template <class Random> Judged judge_scenes(int scenes, int pairs, const Evaluator &other = {}) {
    Judged out{.scenes = scenes};
    const bool show = std::getenv("FATHOM_SHOW") != nullptr;
    for (int i = 0; i < scenes; ++i) {
        Random random(std::uint64_t(seed()) * 1'000'003u + std::uint64_t(i));
        const std::string text = random.scene();
        if (show) std::printf("%d:\n%s", i, text.c_str());
        std::fflush(stdout);
        const Verdict verdict = judge(text, random, pairs, other);
        out.accepted += verdict.accepted;
        out.pairs += verdict.pairs;
        out.again += verdict.again;
        out.wrong += !verdict.wrong.empty();
        if (show) std::printf("%s\n", verdict.accepted ? "taken" : verdict.code.c_str());
        if (!verdict.wrong.empty())
            std::printf("WRONG %d: %s\n%s", i, verdict.wrong.c_str(), text.c_str());
        std::fflush(stdout);
    }
    const std::string more = out.again > 0 ? fmt::format(", {} in the shader, too", out.again) : "";
    std::printf("%d of %d accepted, %ld pairs%s\n", out.accepted, scenes, out.pairs, more.c_str());
    return out;
}

} // namespace fathom::test
