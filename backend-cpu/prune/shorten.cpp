// What is left of a tape in each of many boxes, from what its run over ranges found.
#include "backend-cpu/prune/shorten.h"

#include <algorithm>
#include <limits>

namespace fathom::cpu {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float worth_a_cut = 0.3f; // of the rows left: a chain that was cut takes longer by row

// One box's tape, from its end: what is needed, and of a minimum's operands up to which value
// (`cutoff`): one that is above it all over the box may be left out, whatever comes in its place is
// above it too.
class Backward {
  public:
    Backward(const PruneProgram &parts, Shortener &memory, const Selection &from, std::size_t box,
             bool cuts)
        : parts_(parts), memory_(memory), from_(from), box_(box), bit_(std::uint64_t{1} << box),
          may_cut_(cuts) {}

    void run(ShortTape &tape) {
        ++memory_.epoch;
        for (const Program::Slot &result : parts_.program->results)
            need(slot_of(result.address), infinite);
        std::size_t loop = from_.loops.size();
        for (std::size_t i = from_.steps.size(); i-- > 0;) {
            const std::uint32_t id = from_.steps[i];
            if (parts_.table[id].kind == StepKind::Loop) --loop;
            const float cutoff = needed(parts_.parts[id]);
            if (cutoff == unneeded) continue;
            if (parts_.table[id].kind == StepKind::Loop)
                rows(id, loop, cutoff, tape);
            else
                step(id, memory_.chosen[i], cutoff, tape);
        }
        std::ranges::reverse(tape.steps);
        std::ranges::reverse(tape.loops);
    }

  private:
    static constexpr float unneeded = -infinite;

    std::uint32_t slot_of(std::uint32_t address) const {
        const auto first = static_cast<std::uint32_t>(parts_.program->first_register);
        return address < first ? address
                               : first + (address - first) / static_cast<std::uint32_t>(batch_size);
    }

    void need(std::uint32_t slot, float cutoff) {
        const bool fresh = memory_.live[slot] != memory_.epoch;
        memory_.live[slot] = memory_.epoch;
        memory_.cutoff[slot] = fresh ? cutoff : std::max(memory_.cutoff[slot], cutoff);
    }
    float needed(const Part &part) const {
        float cutoff = unneeded;
        for (std::uint32_t k = 0; k < part.writes; ++k) {
            const std::uint32_t slot = parts_.slots[part.first_slot + k];
            if (memory_.live[slot] == memory_.epoch)
                cutoff = std::max(cutoff, memory_.cutoff[slot]);
        }
        return cutoff;
    }

    void step(std::uint32_t id, const Shortener::Chosen &chosen, float cutoff, ShortTape &tape) {
        const Part &part = parts_.parts[id];
        int winner = -1;
        if (chosen.wins[0] & bit_) winner = 0;
        if (chosen.wins[1] & bit_) winner = 1;
        if (chosen.ends != Shortener::no_ends) {
            const float *ends = memory_.ends.data() + chosen.ends + box_;
            cutoff = std::min(cutoff, ends[0]);
            if (winner < 0 && ends[2 * memory_.boxes] > cutoff) winner = 0;
            if (winner < 0 && ends[memory_.boxes] > cutoff) winner = 1;
        }
        if (part.choice == Choice::None || winner < 0) {
            const Step &step = parts_.table[id];
            const bool copies =
                step.kind == StepKind::Run && kernel_of_variant(step.target) == Kernel::CopyF;
            keep(id, part.choice == Choice::Least || copies ? cutoff : infinite, tape);
        } else if (const std::uint32_t other = part.chosen[winner]; other != no_part) {
            const bool copies = kernel_of_variant(parts_.table[other].target) == Kernel::CopyF;
            keep(other, copies ? cutoff : infinite, tape);
        }
    }

    void keep(std::uint32_t id, float cutoff, ShortTape &tape) {
        const Part &part = parts_.parts[id];
        const bool ball = part.ball != no_part; // its point and numbers matter wholly
        tape.steps.push_back(id);
        tape.cost += part.cost;
        tape.shapes += part.choice == Choice::None ? 0 : 1;
        const std::uint32_t *slots = parts_.slots.data() + part.first_slot;
        for (std::uint32_t k = 0; k < part.surely; ++k) memory_.live[slots[k]] = 0;
        for (std::uint32_t k = 0; k < part.reads; ++k)
            need(slots[part.writes + k], ball && k > 0 ? infinite : cutoff);
    }

    void rows(std::uint32_t id, std::size_t index, float cutoff, ShortTape &tape) {
        const Step &step = parts_.table[id];
        const Part &part = parts_.parts[id];
        const Selection::Rows &from = from_.loops[index];
        const Shortener::LoopRun &run = memory_.loop_runs[index];
        const RowLoop &known = parts_.loops[step.target];
        Selection::Rows kept{static_cast<std::uint32_t>(tape.rows.size()), 0, from.all, from.cut};
        if (!from.all) {
            const bool minimum = known.minimum >= 0 && cutoff < memory_.ends[run.ends + box_];
            bool renewed = false;
            std::size_t beyond = 0;
            memory_.kept.clear();
            for (std::uint32_t at = run.listed[box_ + 1]; at-- > run.listed[box_] && !renewed;) {
                const std::uint32_t i = memory_.listed[at];
                const Shortener::Iteration &iteration = memory_.iterations[run.first_iteration + i];
                if (minimum && memory_.lows[run.first_low + i * memory_.boxes + box_] > cutoff)
                    continue;
                memory_.kept.push_back(i);
                beyond += (iteration.beyond & bit_) != 0;
                renewed = (iteration.renewed & bit_) != 0;
            }
            if (memory_.kept.empty()) return; // what it carries is what it began with
            if (renewed) kept.cut = {};
            const bool cuts = may_cut_ && static_cast<float>(beyond) >
                                              worth_a_cut * static_cast<float>(memory_.kept.size());
            if (cuts) kept.cut = memory_.cuts[run.cuts][box_], tape.cut = true;
            for (std::size_t k = memory_.kept.size(); k-- > 0;) {
                const std::uint32_t i = memory_.kept[k];
                if (cuts && memory_.iterations[run.first_iteration + i].beyond & bit_) continue;
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
        for (std::uint32_t k = 0; k < part.reads; ++k)
            need(parts_.slots[part.first_slot + part.writes + k], infinite);
    }

    const PruneProgram &parts_;
    Shortener &memory_;
    const Selection &from_;
    std::size_t box_;
    std::uint64_t bit_;
    bool may_cut_;
};

} // namespace

void shorten(const PruneProgram &parts, Shortener &shortener, const Selection &from,
             std::size_t box, bool cuts, ShortTape &tape) {
    tape.clear();
    Backward(parts, shortener, from, box, cuts).run(tape);
}

} // namespace fathom::cpu
