// libFuzzer target of what a text means: the tapes compute what the walk over the graph computes, an
// interval holds the values in its box, no sign changes within a proved step, and glslang takes the
// text of one target, which the input's length chooses.
#include "backend-cpu/prune/shorten.h"
#include "backend-cpu/tape.h"
#include "driver/verdict.h"
#include "support/agree.h"
#include "support/reference_eval.h"
#include "support/whole.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

using namespace fathom;

namespace {

using Point = std::array<double, 3>;

constexpr std::array<Point, 4> places{
    {{0.31, 0.22, -0.43}, {1.23, -0.71, 0.57}, {-2.1, 1.37, 0.9}, {0.05, 0.4, -1.9}}};
constexpr std::size_t most_evaluations = 200'000; // of nodes, by the walk; then no more is compared

[[noreturn]] void wrong(const std::string &what) {
    std::fprintf(stderr, "agree_fuzz: %s\n", what.c_str());
    std::abort();
}

std::string words(const Point &p, double value) {
    char text[200];
    std::snprintf(text, sizeof text, " at %.9g, %.9g, %.9g: %.9g", p[0], p[1], p[2], value);
    return text;
}

struct Tape {
    const cpu::Program program;
    cpu::Scratch scratch;
    explicit Tape(const ir::Scene &scene)
        : program(cpu::compile(scene, scene.distance)),
          scratch(cpu::make_scratch(program, cpu::inputs_of(scene, 0))) {}

    float at(const Point &p) {
        const std::array<float, 3> in{static_cast<float>(p[0]), static_cast<float>(p[1]),
                                      static_cast<float>(p[2])};
        const std::array<const float *, 3> from{&in[0], &in[1], &in[2]};
        float out = 0;
        float *to = &out;
        cpu::evaluate(program, scratch, from.data(), &to, 1);
        return out;
    }
};

// The values that an interval of the whole tape says for a box, by the same code as meshes use.
struct Ranges {
    const cpu::PruneProgram parts;
    const cpu::ShortTape whole;
    cpu::Shortener shortener;
    Ranges(const Tape &tape, const ir::Scene &scene)
        : parts(cpu::prune_program_of(tape.program, cpu::inputs_of(scene, 0))),
          whole(cpu::whole_tape(parts)), shortener(parts) {}

    std::array<float, 2> of(const Point &lo, const Point &hi) {
        cpu::Boxes boxes;
        boxes.count = 16; // the least
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::fill_n(boxes.lo[axis].begin(), boxes.count, static_cast<float>(lo[axis]));
            std::fill_n(boxes.hi[axis].begin(), boxes.count, static_cast<float>(hi[axis]));
        }
        cpu::run_over(parts, shortener, whole.selection(parts), boxes);
        return {shortener.result_lo[0], shortener.result_hi[0]};
    }
};

void check_interval(Tape &tape, Ranges &ranges, const Point &p, double half) {
    Point lo = p, hi = p;
    for (std::size_t axis = 0; axis < 3; ++axis) lo[axis] -= half, hi[axis] += half;
    const auto [least, most] = ranges.of(lo, hi);
    for (int corner = 0; corner < 9; ++corner) {
        Point at = p;
        for (std::size_t axis = 0; axis < 3 && corner < 8; ++axis)
            at[axis] = corner >> axis & 1 ? hi[axis] : lo[axis];
        const float value = tape.at(at);
        if (value < least || value > most) wrong("no value of its interval" + words(at, value));
    }
}

// A step of the length of the distance passes no surface (docs/lipschitz.md). Rounding: trusted.md, 2.
void check_step(Tape &tape, const Point &p, double distance) {
    if (!(distance > 0 && distance < 100)) return;
    for (int way = 0; way < 14; ++way) {
        Point to = p;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (way < 6 && static_cast<std::size_t>(way / 2) != axis) continue;
            const double share = way < 6 ? 0.999 : 0.576; // along an axis or a diagonal
            to[axis] += ((way < 6 ? way : way >> axis) & 1 ? share : -share) * distance;
        }
        const float there = tape.at(to);
        if (there < -1e-3 * (1 + distance))
            wrong("inside, within a step of " + words(p, distance) + ", and" + words(to, there));
    }
}

// Of the target's flags those that the length's higher digits say.
std::string target_fault(const ir::Scene &scene, std::size_t size) {
    const std::span<const glsl::Target> targets = glsl::all_targets();
    glsl::Options options;
    options.target = targets[size % targets.size()];
    const glsl::TargetTraits &traits = glsl::traits_of(options.target);
    const std::size_t flags = size / targets.size();
    options.field_only = flags % 2 == 0 && traits.form == glsl::Form::Text;
    options.buffers = flags / 2 % 2 == 0 && traits.buffer_file;
    options.computed = flags / 4 % 2 == 0;
    options.noise_cache = traits.noise_cache && !options.field_only && flags / 8 % 2 == 0;
    Diagnostics complaints;
    glsl::emit(scene, options, complaints);
    for (const Diagnostic &d : complaints.items())
        if (d.severity == Severity::Error)
            return "the shader: " + d.message + (d.notes.empty() ? "" : "; " + d.notes[0]);
    return "";
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    driver::CompileOptions options;
    options.limits.work = 100'000;
    options.limits.memory = 32;
    options.limits.proof = 1'000'000;
    const driver::Compilation compiled =
        driver::compile_loaded("a.sdf", std::string(reinterpret_cast<const char *>(data), size),
                               test::loader_without_files(), options);
    if (!compiled.good()) return 0; // compile_fuzz watches what is said then
    const ir::Scene &scene = compiled.scene;
    if (const std::string fault = target_fault(scene, size); !fault.empty()) wrong(fault);

    Tape tape(scene);
    test::Reference reference(scene);
    const auto truth = [&](const Point &q) { return reference.distance(q); };
    Ranges ranges(tape, scene);
    const bool proved = driver::judge(scene).status == ir::ProofStatus::Proved;
    double half = 0.01;
    for (const Point &p : places) {
        const float found = tape.at(p);
        check_interval(tape, ranges, p, half *= 4);
        if (proved) check_step(tape, p, found);
        if (!test::agree(found, p, truth)) wrong("the tape, not the walk" + words(p, found));
        if (reference.evaluations > most_evaluations) break;
    }
    return 0;
}
