// What is left of a tape in each of many boxes, from what its run over ranges found.
#include "backend-cpu/prune/shorten.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace fathom::cpu {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float worth_a_cut = 0.3f; // of the rows left: a chain that was cut takes longer by row

// The tapes of up to 64 boxes at once, from their end: which boxes need a value, a bit each, and of a
// minimum's operands up to which value (`cutoff`): one that is above it all over a box may be left
// out there, whatever comes in its place is above it too.
class Backward {
  public:
    Backward(const PruneProgram &parts, Shortener &memory, const Selection &from,
             std::uint64_t cuts, std::span<ShortTape> tapes)
        : parts_(parts), memory_(memory), from_(from), may_cut_(cuts), tapes_(tapes),
          first_register_(static_cast<std::uint32_t>(parts.program->first_register)) {}

    void run(std::uint64_t boxes) {
        ++memory_.epoch;
        for (const Program::Slot &result : parts_.program->results)
            need(slot_of(result.address), boxes, 0);
        std::size_t loop = from_.loops.size();
        for (std::size_t i = from_.steps.size(); i-- > 0;) {
            const std::uint32_t id = from_.steps[i];
            const bool is_loop = parts_.table[id].kind == StepKind::Loop;
            if (is_loop) --loop;
            const std::uint64_t needed = needed_in(parts_.parts[id]);
            if (needed == 0) continue;
            if (is_loop)
                rows(id, loop, needed);
            else
                step(id, memory_.chosen[i], needed);
        }
        each_box(boxes, [&](std::size_t box) {
            std::ranges::reverse(tapes_[box].steps);
            std::ranges::reverse(tapes_[box].loops);
        });
    }

  private:
    template <class F> static void each_box(std::uint64_t boxes, F &&f) {
        for (; boxes != 0; boxes &= boxes - 1) f(static_cast<std::size_t>(std::countr_zero(boxes)));
    }

    std::uint32_t slot_of(std::uint32_t address) const {
        return address < first_register_
                   ? address
                   : first_register_ +
                         (address - first_register_) / static_cast<std::uint32_t>(batch_size);
    }
    float *cutoffs_of(std::uint32_t slot) { // of a register
        return memory_.cutoff.data() + std::size_t{slot - first_register_} * max_boxes;
    }

    // In the boxes `bounded` as far as `cutoff_` says, in the others wholly.
    void need(std::uint32_t slot, std::uint64_t boxes, std::uint64_t bounded) {
        Shortener::Live &live = memory_.live[slot];
        if (live.epoch != memory_.epoch) live = {0, 0, memory_.epoch};
        if (slot < first_register_) bounded = 0;
        if (bounded != 0) {
            float *cutoffs = cutoffs_of(slot);
            each_box(bounded & ~live.boxes, [&](std::size_t box) { cutoffs[box] = cutoff_[box]; });
            each_box(bounded & live.bounded,
                     [&](std::size_t box) { cutoffs[box] = std::max(cutoffs[box], cutoff_[box]); });
        }
        live.bounded = (bounded & (live.bounded | ~live.boxes)) | (live.bounded & ~boxes);
        live.boxes |= boxes;
    }
    std::uint64_t needed_in(const Part &part) const {
        std::uint64_t boxes = 0;
        for (std::uint32_t k = 0; k < part.writes; ++k) {
            const Shortener::Live &live = memory_.live[parts_.slots[part.first_slot + k]];
            if (live.epoch == memory_.epoch) boxes |= live.boxes;
        }
        return boxes;
    }
    // The boxes in which what a step writes is needed up to a cutoff, which is put into `cutoff_`.
    std::uint64_t bounded_in(const Part &part, std::uint64_t boxes) {
        std::uint64_t bounded = boxes, some = 0;
        for (std::uint32_t k = 0; k < part.writes; ++k) {
            const std::uint32_t slot = parts_.slots[part.first_slot + k];
            const Shortener::Live &live = memory_.live[slot];
            if (live.epoch != memory_.epoch) continue;
            bounded &= ~(live.boxes & ~live.bounded);
            const std::uint64_t here = live.bounded & bounded;
            if (here == 0) continue;
            const float *cutoffs = cutoffs_of(slot);
            each_box(here & ~some, [&](std::size_t box) { cutoff_[box] = cutoffs[box]; });
            each_box(here & some,
                     [&](std::size_t box) { cutoff_[box] = std::max(cutoff_[box], cutoffs[box]); });
            some |= here;
        }
        return bounded;
    }

    bool copies(std::uint32_t id) const {
        const Step &step = parts_.table[id];
        return step.kind == StepKind::Run && kernel_of_variant(step.target) == Kernel::CopyF;
    }

    void step(std::uint32_t id, const Shortener::Chosen &chosen, std::uint64_t needed) {
        const Part &part = parts_.parts[id];
        const bool narrows = part.choice == Choice::Least || copies(id);
        std::uint64_t bounded =
            part.choice != Choice::None || narrows ? bounded_in(part, needed) : 0;
        if (part.choice == Choice::None) return keep(id, needed, narrows ? bounded : 0);
        std::uint64_t second = chosen.wins[1] & needed, first = chosen.wins[0] & needed & ~second;
        if (chosen.ends != Shortener::no_ends) {
            each_box(needed, [&](std::size_t box) {
                const float *ends = memory_.ends.data() + chosen.ends + box;
                const std::uint64_t bit = std::uint64_t{1} << box;
                cutoff_[box] = bounded & bit ? std::min(cutoff_[box], ends[0]) : ends[0];
                if ((first | second) & bit) return;
                if (ends[2 * memory_.boxes] > cutoff_[box])
                    first |= bit;
                else if (ends[memory_.boxes] > cutoff_[box])
                    second |= bit;
            });
            bounded = needed;
        }
        const std::uint64_t won[] = {first, second};
        for (std::size_t side = 0; side < 2; ++side) {
            const std::uint32_t other = part.chosen[side];
            if (won[side] == 0 || other == no_part) continue;
            keep(other, won[side], copies(other) ? bounded & won[side] : 0);
        }
        const std::uint64_t both = needed & ~(first | second);
        if (both != 0) keep(id, both, narrows ? bounded & both : 0);
    }

    void keep(std::uint32_t id, std::uint64_t boxes, std::uint64_t bounded) {
        const Part &part = parts_.parts[id];
        const bool ball = part.ball != no_part; // its point and numbers matter wholly
        each_box(boxes, [&](std::size_t box) {
            ShortTape &tape = tapes_[box];
            tape.steps.push_back(id);
            tape.cost += part.cost;
            tape.shapes += part.choice == Choice::None ? 0 : 1;
        });
        const std::uint32_t *slots = parts_.slots.data() + part.first_slot;
        for (std::uint32_t k = 0; k < part.surely; ++k) {
            Shortener::Live &live = memory_.live[slots[k]];
            if (live.epoch == memory_.epoch) live.boxes &= ~boxes, live.bounded &= ~boxes;
        }
        for (std::uint32_t k = 0; k < part.reads; ++k)
            need(slots[part.writes + k], boxes, ball && k > 0 ? 0 : bounded);
    }

    void rows(std::uint32_t id, std::size_t index, std::uint64_t needed) {
        const std::uint64_t bounded = bounded_in(parts_.parts[id], needed);
        std::uint64_t kept = 0;
        each_box(needed, [&](std::size_t box) {
            const std::uint64_t bit = std::uint64_t{1} << box;
            if (rows_in(id, index, box, bounded & bit ? cutoff_[box] : infinite)) kept |= bit;
        });
        const Part &part = parts_.parts[id];
        for (std::uint32_t k = 0; k < part.reads && kept != 0; ++k)
            need(parts_.slots[part.first_slot + part.writes + k], kept, 0);
    }

    // False: no row is left, so what the loop carries is what it began with.
    bool rows_in(std::uint32_t id, std::size_t index, std::size_t box, float cutoff) {
        const Step &step = parts_.table[id];
        const Part &part = parts_.parts[id];
        const Selection::Rows &from = from_.loops[index];
        const Shortener::LoopRun &run = memory_.loop_runs[index];
        const RowLoop &known = parts_.loops[step.target];
        const std::uint64_t bit = std::uint64_t{1} << box;
        ShortTape &tape = tapes_[box];
        Selection::Rows kept{static_cast<std::uint32_t>(tape.rows.size()), 0, from.all, from.cut};
        if (!from.all) {
            const bool minimum = known.minimum >= 0 && cutoff < memory_.ends[run.ends + box];
            bool renewed = false;
            std::size_t beyond = 0;
            memory_.kept.clear();
            for (std::uint32_t at = run.listed[box + 1]; at-- > run.listed[box] && !renewed;) {
                const std::uint32_t i = memory_.listed[at];
                const Shortener::Iteration &iteration = memory_.iterations[run.first_iteration + i];
                if (minimum && memory_.lows[run.first_low + i * memory_.boxes + box] > cutoff)
                    continue;
                memory_.kept.push_back(i);
                beyond += (iteration.beyond & bit) != 0;
                renewed = (iteration.renewed & bit) != 0;
            }
            if (memory_.kept.empty()) return false;
            if (renewed) kept.cut = {};
            const bool cuts =
                (may_cut_ & bit) != 0 &&
                static_cast<float>(beyond) > worth_a_cut * static_cast<float>(memory_.kept.size());
            if (cuts) kept.cut = memory_.cuts[run.cuts][box], tape.cut = true;
            for (std::size_t k = memory_.kept.size(); k-- > 0;) {
                const std::uint32_t i = memory_.kept[k];
                if (cuts && memory_.iterations[run.first_iteration + i].beyond & bit) continue;
                tape.rows.push_back(from_.rows[from.first + i]);
            }
            kept.count = static_cast<std::uint32_t>(tape.rows.size()) - kept.first;
        }
        tape.steps.push_back(id);
        tape.loops.push_back(kept);
        tape.shapes += static_cast<float>(kept.count);
        tape.cost +=
            kept.all
                ? part.cost
                : static_cast<float>(kept.count) * part.cost /
                      static_cast<float>(std::max(parts_.program->loops[step.target].max_count, 1));
        return true;
    }

    const PruneProgram &parts_;
    Shortener &memory_;
    const Selection &from_;
    std::uint64_t may_cut_;
    std::span<ShortTape> tapes_;
    std::uint32_t first_register_;
    std::array<float, max_boxes> cutoff_{}; // of the step at hand
};

} // namespace

void shorten(const PruneProgram &parts, Shortener &shortener, const Selection &from,
             std::uint64_t boxes, std::uint64_t cuts, std::span<ShortTape> tapes) {
    for (std::uint64_t left = boxes; left != 0; left &= left - 1)
        tapes[static_cast<std::size_t>(std::countr_zero(left))].clear();
    Backward(parts, shortener, from, cuts, tapes).run(boxes);
}

} // namespace fathom::cpu
