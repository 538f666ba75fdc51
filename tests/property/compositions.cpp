// Random compositions of everything in the library: the safe ball against the scene's plain
// geometry (every copy asked, nothing guarded), the slope of what offsets, shells and blends use,
// over params at both ends of their ranges. A scene that fails is cut down before it is shown.
// FATHOM_EFFORT and FATHOM_SEED in the environment make it longer, or another.
#include "driver/compile.h"
#include "ir/lower/lower.h"
#include "random_scenes.h"
#include "tests/support/effort.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <fmt/format.h>
#include <map>

using namespace fathom;
using namespace fathom::test;

namespace {

constexpr double reach = 2.5;

// The same solid from the shapes alone: nothing of what the proof makes cheaper. (What is proved in
// its own box alone is joined with the way to it, raw too; and the distance to copies that are not
// asked is part of a raw field, so it stays unless `all` are to be asked.)
ir::Scene plain(ir::Scene scene, bool all) {
    for (std::size_t i = 0; i < scene.facts.size(); ++i) {
        ir::ShapeFact &fact = scene.facts[i];
        fact.guard = false;
        fact.outward = std::numeric_limits<double>::infinity();
        ir::RepeatPlan &plan = fact.repeat;
        const bool polar = scene.shapes[ir::ShapeId{i}].kind == ir::ShapeKind::Repeat &&
                           scene.shapes.repetitions[scene.shapes[ir::ShapeId{i}].payload].polar;
        if (plan.guard && !all) continue;
        plan.guard = false;
        for (int &n : plan.neighbors)
            if (n > 0) n = polar ? 1000 : 9;
    }
    ir::lower(scene);
    return scene;
}

struct Verdict {
    std::string wrong; // empty: sound
    std::string code;  // of the error, where the scene was refused
    double steepest = 0;
};

driver::Compilation compiled(const std::string &text, int cells) {
    driver::CompileOptions options;
    options.cells = cells;
    return driver::compile_text("random.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", options);
}

void set_params(ir::Scene &scene, int end) {
    for (ir::Param &param : scene.params)
        param.value[0] = end == 0   ? param.lo[0]
                         : end == 1 ? param.hi[0]
                                    : (param.lo[0] + param.hi[0]) / 2;
}

std::string place(const Point3 &p) { return fmt::format("[{}, {}, {}]", p[0], p[1], p[2]); }

// A marched distance d at p, against the plain solid: no point within |d| may have the other sign.
std::string against_plain(const ir::Scene &scene, const ir::Scene &truth, int count) {
    Sampler marched(scene), plain(truth);
    const double rounding = 3e-5 * reach;
    std::vector<Point3> p, q;
    for (int i = 0; i < count; ++i)
        p.push_back(marched.in_box({-reach, -reach, -reach}, {reach, reach, reach}));
    std::vector<float> d = marched.values(p);
    for (std::size_t i = 0; i < p.size(); ++i)
        q.push_back(marched.in_ball(p[i], std::min(double(std::fabs(d[i])), 4 * reach)));
    std::vector<float> e = plain.values(q), own = plain.values(p);
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (std::fabs(d[i]) < rounding) continue;
        if ((own[i] < 0) != (d[i] < 0) && std::fabs(own[i]) > rounding)
            return fmt::format("the solid is another at {}: marched {}, plain {}", place(p[i]),
                               d[i], own[i]);
        if ((e[i] < 0) != (d[i] < 0) && std::fabs(e[i]) > rounding)
            return fmt::format("the step {} at {} reaches over {}, where the field is {}", d[i],
                               place(p[i]), place(q[i]), e[i]);
    }
    return {};
}

Verdict judge(const std::string &head, const Term &tree, int count, bool cells) {
    Verdict out;
    const std::string shape = text_of(tree);
    const bool repeated = tree.text.find(".repeat") != std::string::npos;
    for (const bool raw : {false, true}) {
        // The raw reading, as an offset uses it: divided by its bound, at most 1 steep. With
        // `cells` steps as for pictures, by bounds of cells.
        driver::Compilation c = raw ? compiled(head + "(" + shape + ").offset(0.003)", 0)
                                    : compiled(head + shape, cells ? 8 : 0);
        if (!c.good()) {
            for (const Diagnostic &d : c.diagnostics.items())
                if (d.severity == Severity::Error) {
                    out.code = code_name(d.code);
                    return out;
                }
            return out;
        }
        ir::Scene truth = plain(c.scene, repeated && !raw);
        for (int end = 0; end < (c.scene.params.empty() ? 1 : 3); ++end) {
            set_params(c.scene, end);
            set_params(truth, end);
            out.wrong = against_plain(c.scene, truth, count);
            if (!out.wrong.empty()) return out;
            if (!raw) continue;
            Slopes s = measure(c.scene, {-reach, -reach, -reach}, {reach, reach, reach}, count);
            out.steepest = std::max(out.steepest, s.steepest);
            if (s.unsafe)
                out.wrong = fmt::format("the offset's step at {} is {} times the way to {}",
                                        place(s.unsafe_center), s.unsafe_by, place(s.unsafe_point));
            if (s.steepest > 1 + 5e-3)
                out.wrong = fmt::format("the raw field is {} times as steep as proved, at {}",
                                        s.steepest, place(s.where));
            if (!out.wrong.empty()) return out;
        }
    }
    return out;
}

} // namespace

TEST_CASE("random compositions are marched safely, and are no steeper than proved") {
    const int scenes = test::effort(60), seed = test::seed();
    int good = 0, wrong = 0;
    std::map<std::string, int> refused;
    for (int i = 0; i < scenes; ++i) {
        RandomScene random(std::uint64_t(seed) * 1'000'003u + std::uint64_t(i));
        TermPtr tree = random.solid(1 + i % 4);
        std::string head;
        for (const std::string &param : random.params()) head += param;
        const bool cells = i % 5 == 0; // they take four times as long
        Verdict verdict = judge(head, *tree, 4096, cells);
        if (!verdict.code.empty()) {
            ++refused[verdict.code];
            if (std::getenv("FATHOM_SHOW"))
                std::printf("refused %s: %s%s\n", verdict.code.c_str(), head.c_str(),
                            text_of(*tree).c_str());
            continue;
        }
        ++good;
        if (verdict.wrong.empty()) continue;
        for (bool smaller = true; smaller;) {
            smaller = false;
            std::vector<TermPtr> tries;
            cuts(tree, tree, tries);
            for (const TermPtr &one : tries) {
                Verdict v = judge(head, *one, 4096, cells);
                if (v.wrong.empty()) continue;
                tree = one, verdict = v, smaller = true;
                break;
            }
        }
        ++wrong;
        std::printf("%d: %s\n%s%s\n", i, verdict.wrong.c_str(), head.c_str(),
                    text_of(*tree).c_str());
        std::fflush(stdout);
    }
    for (const auto &[code, count] : refused)
        std::printf("refused %d times: %s\n", count, code.c_str());
    CHECK(wrong == 0);
    CHECK(good > scenes / 2);
}
