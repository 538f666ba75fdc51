// What shortening knows of a tape before it sees any box: what each step reads and writes, what it
// may become, which loops may leave iterations out.
#include "backend-cpu/prune/shorten.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <set>

namespace fathom::cpu {

namespace {

constexpr std::size_t max_steps = 1 << 20; // of a tape with its calls spliced in

class PartMaker {
  public:
    PartMaker(const Program &program, const Inputs &inputs) : program_(program) {
        made_.program = &program;
        made_.inputs = inputs;
    }

    PruneProgram run() {
        made_.table = program_.steps;
        made_.operands = program_.operands;
        made_.slot_count = slot(static_cast<std::uint32_t>(program_.cells)) + 2;
        made_.loops.resize(program_.loops.size());
        block_of_.resize(program_.blocks.size());
        const std::size_t own = program_.steps.size();
        made_.parts.resize(own);
        for (std::uint32_t b = 0; b < program_.blocks.size(); ++b) // callees and bodies first
            for (std::uint32_t i = program_.blocks[b].first; i < program_.blocks[b].last; ++i)
                made_.parts[i] = part(program_.steps[i]);
        find_choices();
        for (std::size_t l = 0; l < program_.loops.size(); ++l) find_rows(l);
        find_ranges();
        return std::move(made_);
    }

  private:
    struct Uses {
        std::set<std::uint32_t> reads, writes, surely; // slots; reads: before they are written
        float cost = 0;
        bool known = false;
    };

    std::uint32_t slot(std::uint32_t address) const {
        const auto first = static_cast<std::uint32_t>(program_.first_register);
        return address < first ? address
                               : first + (address - first) / static_cast<std::uint32_t>(batch_size);
    }

    const Uses &uses(std::uint32_t block) {
        Uses &uses = block_of_[block];
        if (uses.known) return uses;
        uses.known = true;
        for (std::uint32_t i = program_.blocks[block].first; i < program_.blocks[block].last; ++i) {
            const Part made = part(program_.steps[i]);
            const std::uint32_t *slots = made_.slots.data() + made.first_slot;
            for (std::uint32_t k = 0; k < made.reads; ++k)
                if (!uses.surely.contains(slots[made.writes + k]))
                    uses.reads.insert(slots[made.writes + k]);
            uses.writes.insert(slots, slots + made.writes);
            uses.surely.insert(slots, slots + made.surely);
            uses.cost += made.cost;
        }
        return uses;
    }

    Part part(const Step &step) {
        const std::uint32_t *operands = made_.operands.data() + step.operands;
        Part made;
        std::vector<std::uint32_t> writes, reads;
        const auto take = [&](std::size_t outs, std::size_t ins) {
            for (std::size_t k = 0; k < outs; ++k) writes.push_back(slot(operands[k]));
            for (std::size_t k = 0; k < ins; ++k) reads.push_back(slot(operands[outs + k]));
            made.surely = made.operands = static_cast<std::uint32_t>(outs);
            made.operands += static_cast<std::uint32_t>(ins);
        };
        switch (step.kind) {
        case StepKind::Run: {
            const Kernel kernel = kernel_of_variant(step.target);
            take(static_cast<std::size_t>(kernel_outputs(kernel)),
                 static_cast<std::size_t>(kernel_inputs(kernel)));
            break;
        }
        case StepKind::TableRead:
            take(static_cast<std::size_t>(program_.reads[step.target].columns), 1);
            break;
        case StepKind::Image: take(4, 2); break;
        case StepKind::Grid: take(1, 3); break;
        case StepKind::BreakUnless: take(0, 1); break;
        case StepKind::Call: {
            const Uses &inner = uses(step.target);
            writes.assign(inner.surely.begin(), inner.surely.end());
            made.surely = static_cast<std::uint32_t>(writes.size());
            for (std::uint32_t write : inner.writes)
                if (!inner.surely.contains(write)) writes.push_back(write);
            reads.assign(inner.reads.begin(), inner.reads.end());
            made.cost = 1 + inner.cost;
            break;
        }
        case StepKind::Loop: {
            const Loop &loop = program_.loops[step.target];
            const Uses &inner = uses(loop.block);
            std::set<std::uint32_t> written = inner.writes, read = inner.reads;
            for (const Loop::Carried &carried : loop.carried) {
                written.insert(slot(carried.var)); // also where no iteration is left
                read.insert(slot(carried.var));
            }
            written.insert(slot(loop.index));
            read.erase(slot(loop.index));
            read.insert(slot(loop.count));
            writes.assign(written.begin(), written.end());
            reads.assign(read.begin(), read.end());
            // balls are joined in packs: three steps of a row take less than one kernel's time
            made.cost = 1 + (loop.balls >= 0 ? 0.6f : inner.cost) *
                                static_cast<float>(std::max(loop.max_count, 1));
            break;
        }
        }
        made.first_slot = static_cast<std::uint32_t>(made_.slots.size());
        made.writes = static_cast<std::uint32_t>(writes.size());
        made.reads = static_cast<std::uint32_t>(reads.size());
        made_.slots.insert(made_.slots.end(), writes.begin(), writes.end());
        made_.slots.insert(made_.slots.end(), reads.begin(), reads.end());
        return made;
    }

    bool shared(std::uint32_t address) const { return address < program_.first_register; }

    std::uint32_t keep(std::initializer_list<std::uint32_t> operands) {
        const auto first = static_cast<std::uint32_t>(made_.operands.size());
        made_.operands.insert(made_.operands.end(), operands);
        return first;
    }
    std::uint32_t add(Kernel kernel, Mask mask, bool once, std::uint32_t operands) {
        const Step step{StepKind::Run, once, best_variant(kernel, once ? 0 : mask).index, operands};
        made_.table.push_back(step);
        made_.parts.push_back(part(step));
        return static_cast<std::uint32_t>(made_.table.size() - 1);
    }
    // out = from; nothing, if they are one place
    std::uint32_t copy(bool of_floats, bool once, std::uint32_t out, std::uint32_t from) {
        if (out == from) return no_part;
        return add(of_floats ? Kernel::CopyF : Kernel::CopyI, shared(from) && !shared(out) ? 1 : 0,
                   once, keep({out, from}));
    }

    // Each block's steps in their order, by which the last writers are known.
    void find_choices() {
        last_writer_.resize(made_.slot_count, no_part);
        for (const Program::Block &block : program_.blocks) {
            block_begin_ = block.first;
            for (std::uint32_t i = block.first; i < block.last; ++i) {
                find_choice(i);
                const Part &made = made_.parts[i];
                for (std::uint32_t k = 0; k < made.writes; ++k)
                    last_writer_[made_.slots[made.first_slot + k]] = i;
            }
        }
    }

    // The last step of the present block, before the one whose choice is sought, that writes there.
    std::uint32_t last_writer(std::uint32_t address) const {
        const std::uint32_t step = last_writer_[slot(address)];
        return step != no_part && step >= block_begin_ ? step : no_part; // else of another block
    }

    // less(x, y) ? x : y is the lesser, less(x, y) ? y : x the greater.
    std::optional<Kernel> lesser_or_greater(std::uint32_t id) {
        const std::uint32_t *o = made_.operands.data() + made_.table[id].operands;
        const std::uint32_t condition = last_writer(o[1]);
        if (condition == no_part || program_.steps[condition].kind != StepKind::Run ||
            kernel_of_variant(program_.steps[condition].target) != Kernel::LessF)
            return {};
        const std::uint32_t *compared =
            program_.operands.data() + program_.steps[condition].operands + 1;
        for (const std::uint32_t address : {compared[0], compared[1]}) {
            const std::uint32_t changed = last_writer(address); // not since then
            if (changed != no_part && changed >= condition) return {};
        }
        if (compared[0] == o[2] && compared[1] == o[3]) return Kernel::MinF;
        if (compared[0] == o[3] && compared[1] == o[2]) return Kernel::MaxF;
        return {};
    }

    void find_choice(std::uint32_t id) {
        const Step step = made_.table[id];
        if (step.kind != StepKind::Run) return;
        const Kernel kernel = kernel_of_variant(step.target);
        const std::vector<std::uint32_t> o(made_.operands.begin() + step.operands,
                                           made_.operands.begin() + step.operands +
                                               kernel_inputs(kernel) + 1);
        Part made = made_.parts[id];
        const auto between = [&](Choice choice, std::uint32_t a, std::uint32_t b, bool floats) {
            made.choice = choice;
            made.operand[0] = a, made.operand[1] = b;
            made.chosen[0] = copy(floats, step.once, o[0], a);
            made.chosen[1] = copy(floats, step.once, o[0], b);
        };
        // out, a, ball's seven[, k]
        const auto joined = [&](Choice choice, Kernel join, bool has_k) {
            if (step.once) return;
            const Mask mask = mask_of_variant(step.target) >> 1 & 0b1111111;
            const auto temporary = static_cast<std::uint32_t>(program_.cells);
            made.choice = choice;
            made.operand[0] = o[1], made.operand[1] = temporary;
            made.chosen[0] = copy(true, false, o[0], o[1]);
            made.chosen[1] = add(Kernel::Ball, mask, false,
                                 keep({o[0], o[2], o[3], o[4], o[5], o[6], o[7], o[8]}));
            made.ball = best_variant(Kernel::Ball, mask).index;
            made.ball_operands = keep({temporary, o[2], o[3], o[4], o[5], o[6], o[7], o[8]});
            if (has_k) made.margin = o[9];
            made.join =
                best_variant(join, (shared(o[1]) ? 1u : 0u) | (has_k && shared(o[9]) ? 4u : 0u))
                    .index;
            made.join_operands =
                has_k ? keep({o[0], o[1], temporary, o[9]}) : keep({o[0], o[1], temporary});
        };
        if (kernel == Kernel::MinF) between(Choice::Least, o[1], o[2], true);
        if (kernel == Kernel::MaxF) between(Choice::Greatest, o[1], o[2], true);
        if (kernel == Kernel::SelectF || kernel == Kernel::SelectI) {
            between(Choice::Select, o[2], o[3], kernel == Kernel::SelectF), made.margin = o[1];
            if (kernel == Kernel::SelectF && !step.once)
                if (const auto join = lesser_or_greater(id)) {
                    made.join =
                        best_variant(*join, (shared(o[2]) ? 1u : 0u) | (shared(o[3]) ? 2u : 0u))
                            .index;
                    made.join_operands = keep({o[0], o[2], o[3]});
                }
        }
        if (kernel == Kernel::BlendSmooth || kernel == Kernel::BlendRound ||
            kernel == Kernel::BlendChamfer || kernel == Kernel::BlendStairs)
            between(Choice::Blend, o[1], o[2], true), made.margin = o[3];
        if (kernel == Kernel::MinBall) joined(Choice::Least, Kernel::MinF, false);
        if (kernel == Kernel::SmoothBall) joined(Choice::Blend, Kernel::BlendSmooth, true);
        made_.parts[id] = made;
    }

    bool writes_address(const Step &step, std::uint32_t address) {
        const Part made = part(step);
        const auto begin = made_.slots.begin() + made.first_slot;
        const bool found =
            std::find(begin, begin + made.writes, slot(address)) != begin + made.writes;
        made_.slots.resize(made.first_slot);
        return found;
    }

    // The last step in a block's first `end` that writes an address, and how many do.
    std::pair<std::uint32_t, int> writer(std::uint32_t block, std::uint32_t end,
                                         std::uint32_t address) {
        std::pair<std::uint32_t, int> found{no_part, 0};
        for (std::uint32_t i = program_.blocks[block].first; i < end; ++i)
            if (writes_address(program_.steps[i], address)) found = {i, found.second + 1};
        return found;
    }

    // The one step of a loop's body that chooses between what was carried and something new.
    std::optional<RowLoop::Decision> decision_of(const Loop &loop, const Loop::Carried &carried) {
        const std::uint32_t last = program_.blocks[loop.block].last;
        const auto [var_writer, var_writes] = writer(loop.block, last, carried.var);
        if (var_writes != 1) return {};
        std::uint32_t decision = var_writer;
        if (carried.next != carried.var) { // made elsewhere and copied at the end
            const Step &copy = program_.steps[var_writer];
            if (copy.kind != StepKind::Run || program_.operands[copy.operands + 1] != carried.next)
                return {};
            decision = writer(loop.block, var_writer, carried.next).first;
            if (decision == no_part) return {};
        }
        const Part &made = made_.parts[decision];
        if (made.choice == Choice::None) return {};
        if (made.operand[0] == carried.var) return RowLoop::Decision{decision, 0};
        if (made.operand[1] == carried.var) return RowLoop::Decision{decision, 1};
        return {};
    }

    // A running minimum or blend is never above what the loop began with, a maximum never below. Of
    // choices it is known where the condition compares the new with the carried number of a running
    // minimum itself: less(x, v), v becoming x.
    bool renewable(const Loop &loop, RowLoop &rows) {
        if (rows.decisions.size() == 1 &&
            made_.parts[rows.decisions[0].part].choice == Choice::Least)
            rows.minimum = 0;
        const Program::Block body = program_.blocks[loop.block];
        std::set<std::uint32_t> readers;
        for (const RowLoop::Decision &decision : rows.decisions) {
            const Part &made = made_.parts[decision.part];
            readers.insert(decision.part);
            if (made.choice != Choice::Select) continue;
            const std::uint32_t condition = writer(loop.block, decision.part, made.margin).first;
            if (condition == no_part || program_.steps[condition].kind != StepKind::Run ||
                kernel_of_variant(program_.steps[condition].target) != Kernel::LessF)
                return false;
            readers.insert(condition);
            const std::uint32_t *compared =
                program_.operands.data() + program_.steps[condition].operands + 1;
            bool is_minimum = false;
            for (std::size_t k = 0; k < rows.decisions.size(); ++k) {
                const Part &other = made_.parts[rows.decisions[k].part];
                if (other.choice != Choice::Select || rows.decisions[k].kept != 1 ||
                    other.margin != made.margin || compared[1] != loop.carried[k].var ||
                    compared[0] != other.operand[0])
                    continue;
                is_minimum = true;
                if (rows.minimum < 0) rows.minimum = static_cast<std::int32_t>(k);
                if (rows.minimum != static_cast<std::int32_t>(k)) return false; // of two minima
            }
            if (!is_minimum || decision.kept != 1) return false;
        }
        for (std::uint32_t i = body.first; i < body.last; ++i) {
            if (readers.contains(i)) continue;
            const Part &made = made_.parts[i];
            const auto reads = made_.slots.begin() + made.first_slot + made.writes;
            for (const Loop::Carried &carried : loop.carried)
                if (std::find(reads, reads + made.reads, slot(carried.var)) != reads + made.reads)
                    return false;
        }
        return true;
    }

    void find_rows(std::size_t index) {
        const Loop &loop = program_.loops[index];
        RowLoop rows;
        const auto known = std::ranges::find_if(program_.shared, [&](const Program::Shared &s) {
            return s.address == loop.count && s.kind == Program::Shared::Kind::Int;
        });
        rows.droppable = !loop.breaks && known != program_.shared.end() && !loop.carried.empty();
        if (rows.droppable)
            rows.iterations = std::clamp(static_cast<std::int32_t>(known->bits), 0, loop.max_count);
        for (const Loop::Carried &carried : loop.carried) {
            if (!rows.droppable) break;
            const auto decision = decision_of(loop, carried);
            rows.droppable = decision.has_value();
            if (decision) rows.decisions.push_back(*decision);
        }
        if (!rows.droppable) rows.decisions.clear();
        for (std::size_t k = 0; k < rows.decisions.size(); ++k)
            made_.parts[rows.decisions[k].part].decision = static_cast<std::int32_t>(k);
        rows.renewable = rows.droppable && renewable(loop, rows);
        if (!rows.renewable) rows.minimum = -1;
        rows.chain = rows.renewable && loop.balls >= 0 &&
                     program_.ball_loops[static_cast<std::size_t>(loop.balls)].smooth;
        made_.loops[index] = std::move(rows);
    }

    void find_ranges() {
        constexpr float endless = std::numeric_limits<float>::infinity();
        for (const Read &read : program_.reads) {
            made_.first_read_range.push_back(static_cast<std::uint32_t>(made_.read_ranges.size()));
            for (int c = 0; c < read.columns; ++c) {
                std::array<float, 2> range{endless, -endless};
                for (int row = 0; row < read.rows; ++row) {
                    const float x = program_.table_data[read.first +
                                                        static_cast<std::size_t>(row) *
                                                            static_cast<std::size_t>(read.stride) +
                                                        static_cast<std::size_t>(c)];
                    range = {std::min(range[0], x), std::max(range[1], x)};
                }
                made_.read_ranges.push_back(range);
            }
        }
        for (const ir::ImageData &image : program_.images)
            for (std::size_t c = 0; c < 4; ++c) {
                std::array<float, 2> range{0, 0}; // what is read of an image without samples
                for (std::size_t i = c; i < image.rgba.size(); i += 4)
                    range = {std::min(range[0], image.rgba[i]), std::max(range[1], image.rgba[i])};
                made_.image_ranges.push_back(range);
            }
    }

    const Program &program_;
    PruneProgram made_;
    std::vector<Uses> block_of_;
    std::vector<std::uint32_t> last_writer_; // by slot, of all blocks so far
    std::uint32_t block_begin_ = 0;          // the first step of the present one
};

void splice(const PruneProgram &parts, std::uint32_t block, ShortTape &tape) {
    const Program &program = *parts.program;
    for (std::uint32_t i = program.blocks[block].first; i < program.blocks[block].last; ++i) {
        const Step &step = program.steps[i];
        if (step.kind == StepKind::Call && tape.steps.size() < max_steps) {
            splice(parts, step.target, tape);
            continue;
        }
        tape.steps.push_back(i);
        tape.cost += parts.parts[i].cost;
        tape.shapes += parts.parts[i].choice == Choice::None ? 0 : 1;
        if (step.kind != StepKind::Loop) continue;
        const RowLoop &loop = parts.loops[step.target];
        Selection::Rows rows{static_cast<std::uint32_t>(tape.rows.size()), 0, !loop.droppable, {}};
        if (loop.droppable) {
            rows.count = static_cast<std::uint32_t>(loop.iterations);
            for (std::uint32_t row = 0; row < rows.count; ++row) tape.rows.push_back(row);
        }
        tape.shapes += static_cast<float>(rows.count);
        tape.loops.push_back(rows);
    }
}

} // namespace

PruneProgram prune_program_of(const Program &program, const Inputs &inputs) {
    return PartMaker(program, inputs).run();
}

Selection ShortTape::selection(const PruneProgram &parts) const {
    return {parts.table.data(), parts.operands.data(), steps, loops, rows.data()};
}

void ShortTape::clear() {
    steps.clear(), rows.clear(), loops.clear();
    cost = 0, shapes = 1, cut = false;
}

ShortTape whole_tape(const PruneProgram &parts) {
    ShortTape tape;
    splice(parts, static_cast<std::uint32_t>(parts.program->blocks.size() - 1), tape);
    return tape;
}

} // namespace fathom::cpu
