#include "mesh/field.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr float short_enough = 32; // kernels

// How far a coordinate is beyond the nearer end, negative between them.
float beyond(float x, float lo, float hi) { return std::max(lo - x, x - hi); }

// The ranges of the field as it is grown and cut off, from those of the scene's.
void cut_ranges(Evaluator &evaluator, const cpu::Boxes &boxes) {
    const Field &field = evaluator.field;
    for (std::size_t k = 0; field.wider != 0 && k < boxes.count; ++k) {
        evaluator.ranges.result_lo[k] -= field.wider; // rounding is monotone
        evaluator.ranges.result_hi[k] -= field.wider;
    }
    if (!field.cut) return;
    const auto &[lo, hi] = *field.cut;
    for (std::size_t k = 0; k < boxes.count; ++k)
        for (std::size_t i = 0; i < 3; ++i) {
            const float a = boxes.lo[i][k], b = boxes.hi[i][k];
            const float middle = std::clamp(0.5f * (lo[i] + hi[i]), a, b);
            float &least = evaluator.ranges.result_lo[k], &most = evaluator.ranges.result_hi[k];
            // It is least at the middle or the end next to it; rounding is monotone.
            least = std::max(least, std::min({beyond(a, lo[i], hi[i]), beyond(b, lo[i], hi[i]),
                                              beyond(middle, lo[i], hi[i])}));
            most = std::max({most, beyond(a, lo[i], hi[i]), beyond(b, lo[i], hi[i])});
        }
}

// Some steps of a tape, from `first` on, below `last`.
cpu::Selection steps_of(const Field &field, const cpu::ShortTape &tape, std::size_t first,
                        std::size_t last) {
    cpu::Selection selection = tape.selection(field.parts);
    std::size_t loops = 0; // before the first step, which have rows of their own
    for (std::size_t k = 0; k < first; ++k)
        loops += selection.table[selection.steps[k]].kind == cpu::StepKind::Loop;
    selection.steps = selection.steps.subspan(first, last - first);
    selection.loops = selection.loops.subspan(loops);
    return selection;
}

} // namespace

Field::Field(const ir::Scene &scene, double time, const std::optional<ir::Box> &box, float by)
    : program(cpu::compile(scene, scene.distance, cpu::Choices::Apart)),
      inputs(cpu::inputs_of(scene, time)), parts(cpu::prune_program_of(program, inputs)),
      whole(std::make_shared<const cpu::ShortTape>(cpu::whole_tape(parts))), wider(by),
      proved(scene.rounding.subtracted == 0) {
    for (const ir::TopLevel &top : scene.top_level)
        proved = proved && scene.facts[top.shape.index].status == ir::ProofStatus::Proved;
    if (!box) return;
    cut.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
        (*cut)[0][i] = static_cast<float>(box->lo[i]);
        (*cut)[1][i] = static_cast<float>(box->hi[i]);
    }
}

Evaluator::Evaluator(const Field &of)
    : field(of), values(cpu::make_scratch(of.program, of.inputs)),
      gradients(cpu::make_gradient_scratch(of.program, of.inputs)), ranges(of.parts),
      made(cpu::max_boxes) {}

void values_at(Evaluator &evaluator, const cpu::ShortTape &tape, const Points &points,
               std::vector<float> &out) {
    const Field &field = evaluator.field;
    out.resize(points.size());
    const float *in[] = {points.at[0].data(), points.at[1].data(), points.at[2].data()};
    float *to[] = {out.data()};
    cpu::evaluate(field.program, evaluator.values, in, to, points.size(),
                  tape.selection(field.parts), nullptr); // no tape here has a Cut
    if (field.wider != 0)
        for (float &value : out) value -= field.wider;
    if (!field.cut) return;
    const auto &[lo, hi] = *field.cut;
    for (std::size_t k = 0; k < points.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i)
            out[k] = std::max(out[k], beyond(points.at[i][k], lo[i], hi[i]));
}

void gradients_at(Evaluator &evaluator, const cpu::ShortTape &tape, const Points &points,
                  std::array<std::vector<float>, 4> &out) {
    const Field &field = evaluator.field;
    for (std::vector<float> &column : out) column.resize(points.size());
    const float *in[] = {points.at[0].data(), points.at[1].data(), points.at[2].data()};
    float *to[] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
    cpu::evaluate_gradient(field.program, evaluator.gradients, in, to, points.size(),
                           tape.selection(field.parts));
    if (field.wider != 0)
        for (float &value : out[0]) value -= field.wider;
    if (!field.cut) return;
    const auto &[lo, hi] = *field.cut;
    for (std::size_t k = 0; k < points.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i) {
            const float x = points.at[i][k], d = beyond(x, lo[i], hi[i]);
            if (!(d > out[0][k])) continue;
            out[0][k] = d;
            for (std::size_t j = 0; j < 3; ++j) out[1 + j][k] = 0;
            out[1 + i][k] = lo[i] - x > x - hi[i] ? -1.0f : 1.0f;
        }
}

void ranges_over(Evaluator &evaluator, const cpu::ShortTape &tape, const cpu::Boxes &boxes) {
    const Field &field = evaluator.field;
    cpu::run_over(field.parts, evaluator.ranges, tape.selection(field.parts), boxes);
    cut_ranges(evaluator, boxes);
    const auto is_point = [&](std::size_t k) {
        for (std::size_t i = 0; i < 3; ++i)
            if (boxes.lo[i][k] != boxes.hi[i][k]) return false;
        return true;
    };
    evaluator.points.clear();
    for (std::size_t k = 0; k < boxes.count; ++k)
        if (is_point(k)) evaluator.points.add({boxes.lo[0][k], boxes.lo[1][k], boxes.lo[2][k]});
    if (evaluator.points.size() == 0) return;
    values_at(evaluator, tape, evaluator.points, evaluator.point_values);
    for (std::size_t k = 0, n = 0; k < boxes.count; ++k)
        if (is_point(k))
            evaluator.ranges.result_lo[k] = evaluator.ranges.result_hi[k] =
                evaluator.point_values[n++];
}

void ranges_where(Evaluator &evaluator, const cpu::ShortTape &tape, const cpu::Boxes &boxes,
                  const std::vector<Held> &held) {
    const Field &field = evaluator.field;
    cpu::Shortener &memory = evaluator.ranges;
    cpu::enter_boxes(field.parts, memory, boxes);
    std::size_t done = 0;
    for (const Held &hold : held) {
        cpu::run_steps(field.parts, memory, steps_of(field, tape, done, hold.where.step + 1));
        done = hold.where.step + 1;
        for (std::size_t k = 0; k < hold.ranges.size(); ++k) {
            float &lo = memory.lo[hold.where.address + k], &hi = memory.hi[hold.where.address + k];
            // A range without a number holds nowhere: then anything may be said of it.
            lo = std::min(std::max(lo, hold.ranges[k][0]), hi);
            hi = std::max(std::min(hi, hold.ranges[k][1]), lo);
        }
    }
    cpu::run_steps(field.parts, memory, steps_of(field, tape, done, tape.steps.size()));
    cpu::take_results(field.parts, memory);
    cut_ranges(evaluator, boxes);
}

bool is_short(const cpu::ShortTape &tape) { return tape.cost <= short_enough; }

std::array<TapePtr, cpu::max_boxes> shortened(Evaluator &evaluator, const TapePtr &tape,
                                              std::uint64_t which) {
    std::array<TapePtr, cpu::max_boxes> made;
    const bool all = is_short(*tape);
    const Field &field = evaluator.field;
    if (!all)
        cpu::shorten(field.parts, evaluator.ranges, tape->selection(field.parts), which, 0,
                     evaluator.made);
    for (std::size_t box = 0; box < made.size(); ++box) {
        if ((which >> box & 1) == 0) continue;
        const bool pays = !all && !(evaluator.made[box].cost > 0.9f * tape->cost);
        made[box] = pays ? std::make_shared<const cpu::ShortTape>(evaluator.made[box]) : tape;
    }
    return made;
}

TapePtr shortened_in_first(Evaluator &evaluator, const TapePtr &tape) {
    return shortened(evaluator, tape, 1)[0];
}

TapePtr tape_in(Evaluator &evaluator, cpu::Boxes &boxes, const TapePtr &tape, const Point &lo,
                const Point &hi) {
    if (is_short(*tape)) return tape;
    boxes.count = 16;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < boxes.count; ++k)
            boxes.lo[i][k] = lo[i], boxes.hi[i][k] = hi[i];
    ranges_over(evaluator, *tape, boxes);
    return shortened_in_first(evaluator, tape);
}

} // namespace fathom::mesh
