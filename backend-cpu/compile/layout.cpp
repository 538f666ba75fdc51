// From values to a tape: an order that keeps few values alive at once, registers by how long each
// lives, addresses. As no function calls itself, each has its registers at one fixed place, above
// those of all that may be calling it.
#include "backend-cpu/compile/code.h"
#include "backend-cpu/kernels/ball_rows.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <unordered_set>

namespace fathom::cpu {

namespace {

constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

// A loop's or a function's instructions in order. The loops among them have blocks of their own.
struct Order {
    std::vector<InstructionId> instructions;
    std::size_t break_at = 0; // a loop's: its condition is known after this many
};

// Where a value lives: a register of its function, or a cell.
struct Layout {
    Order body;
    std::vector<Order> loops;        // by index into Code::loops
    std::vector<std::uint32_t> slot; // by Value; sources have none
    std::vector<bool> stays;         // by loop variable: its next value is made in its own place
    std::uint32_t registers = 0, cells = 0;
    std::uint32_t base = 0, first_cell = 0; // of the function, in the program's
};

class LayoutMaker {
  public:
    explicit LayoutMaker(const Code &code) : code_(code) {}

    Layout run() {
        layout_.loops.resize(code_.loops.size());
        done_.resize(code_.instructions.size());
        root_.resize(code_.values.size());
        for (std::size_t v = 0; v < root_.size(); ++v) root_[v] = Value{v};
        for (Value result : code_.results) order(result, 0, layout_.body);
        number(layout_.body);
        last_.assign(code_.values.size(), 0);
        first_.assign(code_.values.size(), nowhere);
        layout_.stays.assign(code_.values.size(), false);
        for (Value param : code_.params) first_[param.index] = 0;
        live(layout_.body);
        for (Value result : code_.results) use(result, position_ + 1); // after all
        for (Value param : code_.params) use(param, 0);
        layout_.slot.assign(code_.values.size(), nowhere);
        for (Value param : code_.params) place(param);
        allocate(layout_.body);
        for (std::size_t v = 0; v < root_.size(); ++v)
            layout_.slot[v] = layout_.slot[root_[v].index];
        return std::move(layout_);
    }

  private:
    // What a value needs, then itself; deep chains by a stack of our own.
    void order(Value root, std::uint16_t level, Order &block) {
        std::vector<Value> stack{root};
        while (!stack.empty()) {
            Value value = stack.back();
            const ValueInfo &info = code_.values[value];
            if (!info.made_by || info.level < level || done_[info.made_by.index]) {
                stack.pop_back();
                continue;
            }
            const Instruction &instruction = code_.instructions[info.made_by];
            std::size_t before = stack.size();
            for (std::size_t i = instruction.in.size(); i-- > 0;) {
                const ValueInfo &in = code_.values[instruction.in[i]];
                if (in.made_by && in.level >= level && !done_[in.made_by.index])
                    stack.push_back(instruction.in[i]);
            }
            if (stack.size() > before) continue;
            done_[info.made_by.index] = true;
            block.instructions.push_back(info.made_by);
            stack.pop_back();
            if (instruction.kind == InstructionKind::Loop) {
                const LoopCode &loop = code_.loops[instruction.payload];
                Order &body = layout_.loops[instruction.payload];
                if (loop.condition) order(loop.condition, loop.level, body);
                body.break_at = body.instructions.size();
                for (Value next : loop.next) order(next, loop.level, body);
                for (std::uint32_t k = 0; k < instruction.outs; ++k)
                    root_[instruction.out.index + k] = root_[loop.vars[k].index];
            }
        }
    }

    // Positions count instructions in the order of the tape; a loop has one before its body and one
    // after.
    struct Range {
        std::uint32_t begin = 0, end = 0;
        std::uint16_t level = 0;
    };

    void number(const Order &block) {
        for (InstructionId id : block.instructions) {
            const Instruction &instruction = code_.instructions[id];
            at_[id] = ++position_;
            if (instruction.kind != InstructionKind::Loop) continue;
            Range range{position_, 0, code_.loops[instruction.payload].level};
            number(layout_.loops[instruction.payload]);
            range.end = ++position_;
            ranges_[id] = range;
        }
    }

    // A use inside loops that the value does not stand in is a use until the outermost of them
    // ends.
    void use(Value value, std::uint32_t position) {
        const ValueInfo &info = code_.values[value];
        for (const Range &range : open_)
            if (range.level > info.level) {
                position = std::max(position, range.end);
                break;
            }
        std::uint32_t &last = last_[root_[value.index].index];
        last = std::max(last, position);
    }

    void live(const Order &block) {
        for (InstructionId id : block.instructions) {
            const Instruction &instruction = code_.instructions[id];
            std::uint32_t here = at_.at(id);
            for (Value in : instruction.in) use(in, here);
            if (instruction.kind != InstructionKind::Loop) {
                for (std::uint32_t k = 0; k < instruction.outs; ++k) {
                    std::uint32_t out = instruction.out.index + k;
                    first_[out] = here;
                    last_[out] = std::max(last_[out], here);
                }
                continue;
            }
            const LoopCode &loop = code_.loops[instruction.payload];
            const Range range = ranges_.at(id);
            use(loop.count, range.end); // outside its range: it ends with the loop
            open_.push_back(range);
            live(layout_.loops[instruction.payload]);
            // Which variables may be overwritten by their next value as soon as that is made.
            for (std::size_t k = 0; k < loop.vars.size(); ++k) {
                Value var = loop.vars[k], next = loop.next[k];
                InstructionId maker = code_.values[next].made_by;
                bool once = std::ranges::count(loop.next, next) == 1;
                bool own = maker && code_.values[next].level == loop.level && !loop.active &&
                           once && code_.values[next].shared == code_.values[var].shared &&
                           code_.instructions[maker].kind == InstructionKind::Kernel;
                layout_.stays[var.index] = own && last_[var.index] <= first_[next.index];
            }
            for (Value next : loop.next) use(next, range.end);
            if (loop.condition) use(loop.condition, range.end);
            for (std::size_t k = 0; k < loop.vars.size(); ++k) {
                last_[loop.vars[k].index] = std::max(last_[loop.vars[k].index], range.end);
                if (layout_.stays[loop.vars[k].index]) root_[loop.next[k].index] = loop.vars[k];
            }
            last_[loop.index.index] = range.end;
            if (loop.active) last_[loop.active.index] = range.end;
            open_.pop_back();
        }
    }

    void place(Value value) {
        if (root_[value.index] != value) return;
        bool shared = code_.values[value].shared;
        std::vector<std::uint32_t> &free = shared ? free_cells_ : free_registers_;
        std::uint32_t &count = shared ? layout_.cells : layout_.registers;
        if (free.empty()) {
            layout_.slot[value.index] = count++;
        } else {
            layout_.slot[value.index] = free.back();
            free.pop_back();
        }
        ends_[last_[value.index]].push_back(value);
    }

    void release(std::uint32_t until) {
        while (!ends_.empty() && ends_.begin()->first <= until) {
            for (Value value : ends_.begin()->second)
                (code_.values[value].shared ? free_cells_ : free_registers_)
                    .push_back(layout_.slot[value.index]);
            ends_.erase(ends_.begin());
        }
    }

    // In a chain of minima or blends each link is then written where the one before it stood, and
    // is no copy where that one wins (shorten.h).
    void prefer(const Instruction &kernel) {
        if (kernel.in.empty() || code_.values[kernel.out].shared) return;
        const Value first = kernel.in[0];
        const ValueInfo &info = code_.values[first];
        if (info.source != ValueInfo::no_source || info.shared) return;
        const auto place = std::ranges::find(free_registers_.rbegin(), free_registers_.rend(),
                                             layout_.slot[root_[first.index].index]);
        if (place != free_registers_.rend()) std::swap(*place, free_registers_.back());
    }

    void allocate(const Order &block) {
        for (InstructionId id : block.instructions) {
            const Instruction &instruction = code_.instructions[id];
            std::uint32_t here = at_.at(id);
            // A kernel may write where it reads; what copies in and out may not.
            release(instruction.kind == InstructionKind::Kernel ? here : here - 1);
            if (instruction.kind == InstructionKind::Kernel) prefer(instruction);
            if (instruction.kind != InstructionKind::Loop) {
                for (std::uint32_t k = 0; k < instruction.outs; ++k)
                    place(Value{instruction.out.index + k});
                continue;
            }
            const LoopCode &loop = code_.loops[instruction.payload];
            for (Value var : loop.vars) place(var);
            place(loop.index);
            if (loop.active) place(loop.active);
            allocate(layout_.loops[instruction.payload]);
        }
    }

    const Code &code_;
    Layout layout_;
    std::vector<bool> done_;
    std::vector<Value> root_;                 // by Value: the value whose place it has
    std::vector<std::uint32_t> first_, last_; // by Value: positions
    std::unordered_map<InstructionId, std::uint32_t> at_;
    std::unordered_map<InstructionId, Range> ranges_;
    std::vector<Range> open_;
    std::uint32_t position_ = 0;
    std::vector<std::uint32_t> free_registers_, free_cells_;
    std::map<std::uint32_t, std::vector<Value>> ends_; // by last position
};

class Encoder {
  public:
    Encoder(const ir::Scene &scene, const Calls &calls, const std::vector<Code> &codes)
        : scene_(scene), calls_(calls), codes_(codes) {}

    Program run() {
        for (const Code &code : codes_) layouts_.push_back(LayoutMaker(code).run());
        std::uint32_t cells = 0, registers = 0;
        for (std::size_t i = 0; i < codes_.size(); ++i) {
            Layout &layout = layouts_[i];
            layout.first_cell = cells;
            cells += layout.cells;
            std::uint32_t top = layout.base + layout.registers;
            registers = std::max(registers, top);
            for_calls(codes_[i], [&](std::uint32_t callee) {
                layouts_[callee].base = std::max(layouts_[callee].base, top);
            });
        }
        source_cells(cells);
        yes_ = constant(1);
        first_register_ = (cells_ + 63) / 64 * 64;
        program_.first_register = first_register_;
        program_.registers = registers;
        program_.cells = first_register_ + registers * batch_size;
        blocks_.resize(codes_.size());
        for (std::size_t i = codes_.size(); i-- > 0;) { // callees first
            code_ = &codes_[i];
            layout_ = &layouts_[i];
            sources_ = &source_cells_[i];
            blocks_[i] = block(layout_->body, nullptr);
        }
        auto slots = [&](const std::vector<Value> &values) {
            std::vector<Program::Slot> made;
            for (Value v : values)
                made.push_back({address(v), code_->values[v].type, code_->values[v].shared});
            return made;
        };
        program_.params = slots(code_->params); // the root is the first code, made last
        program_.results = slots(code_->results);
        program_.steps = std::move(whole_);
        program_.images = scene_.images;
        program_.grids = scene_.grids;
        find_ball_loops(program_);
        return std::move(program_);
    }

  private:
    template <class F> void for_calls(const Code &code, F &&f) const {
        for (const Instruction &instruction : code.instructions)
            if (instruction.kind == InstructionKind::Call) f(calls_.body[instruction.payload]);
    }

    // One cell for each number known before the first point, whichever function reads it.
    void source_cells(std::uint32_t first) {
        cells_ = first;
        for (const Code &code : codes_) {
            std::vector<std::uint32_t> &own = source_cells_.emplace_back();
            for (const SourceValue &source : code.sources) own.push_back(source_cell(source.what));
        }
    }
    std::uint32_t source_cell(Program::Shared what) {
        auto key = std::make_tuple(what.kind, what.bits, what.param, what.component);
        auto [it, fresh] = known_.emplace(key, cells_);
        if (fresh) {
            what.address = cells_++;
            program_.shared.push_back(what);
        }
        return it->second;
    }
    std::uint32_t constant(std::int32_t value) {
        Program::Shared what;
        what.kind = Program::Shared::Kind::Int;
        what.bits = static_cast<Word>(value);
        return source_cell(what);
    }

    std::uint32_t address(Value value) const { return address(*code_, *layout_, *sources_, value); }
    std::uint32_t address(const Code &code, const Layout &layout,
                          const std::vector<std::uint32_t> &sources, Value value) const {
        const ValueInfo &info = code.values[value];
        if (info.source != ValueInfo::no_source) return sources[info.source];
        std::uint32_t slot = layout.slot[value.index];
        assert(slot != nowhere);
        if (info.shared) return layout.first_cell + slot;
        return static_cast<std::uint32_t>(first_register_ + (layout.base + slot) * batch_size);
    }

    void step(StepKind kind, std::uint32_t target, bool once,
              std::initializer_list<std::uint32_t> operands) {
        program_.steps.push_back(
            {kind, once, target, static_cast<std::uint32_t>(program_.operands.size())});
        program_.operands.insert(program_.operands.end(), operands);
    }

    struct Place {
        std::uint32_t address;
        bool shared;
    };
    Place place(Value value) const { return {address(value), code_->values[value].shared}; }

    void copy(Place to, Place from, ir::Type type) {
        if (to.address == from.address) return;
        Kernel kernel = type == ir::Type::Float ? Kernel::CopyF : Kernel::CopyI;
        Mask mask = from.shared && !to.shared ? 1 : 0;
        step(StepKind::Run, best_variant(kernel, mask).index, to.shared,
             {to.address, from.address});
    }

    void run(Kernel kernel, Place to, std::initializer_list<Place> from) {
        Mask shared = 0;
        std::size_t i = 0;
        for (Place place : from) shared |= Mask{place.shared} << i++;
        Variant variant = best_variant(kernel, shared);
        assert(variant.mask == shared);
        step(StepKind::Run, variant.index, false, {to.address});
        for (Place place : from) program_.operands.push_back(place.address);
    }

    // Loops' blocks are made while their function's is: each is kept apart until it is whole.
    std::uint32_t block(const Order &order, const LoopCode *loop) {
        std::vector<Step> outer;
        std::swap(outer, program_.steps);
        for (std::size_t i = 0; i <= order.instructions.size(); ++i) {
            if (loop && i == order.break_at) break_unless(*loop);
            if (i < order.instructions.size())
                instruction(code_->instructions[order.instructions[i]]);
        }
        if (loop) advance(*loop);
        std::swap(outer, program_.steps); // `outer` is now this block
        whole_.insert(whole_.end(), outer.begin(), outer.end());
        auto last = static_cast<std::uint32_t>(whole_.size());
        program_.blocks.push_back({last - static_cast<std::uint32_t>(outer.size()), last});
        return static_cast<std::uint32_t>(program_.blocks.size() - 1);
    }

    void break_unless(const LoopCode &loop) {
        if (!loop.condition) return;
        if (loop.active) {
            run(Kernel::And, place(loop.active), {place(loop.active), place(loop.condition)});
            step(StepKind::BreakUnless, 0, false, {address(loop.active)});
        } else {
            step(StepKind::BreakUnless, 0, true, {address(loop.condition)});
        }
    }

    void advance(const LoopCode &loop) {
        for (std::size_t k = 0; k < loop.vars.size(); ++k) {
            Value var = loop.vars[k], next = loop.next[k];
            ir::Type type = code_->values[var].type;
            if (loop.active) {
                Kernel kernel = type == ir::Type::Float ? Kernel::SelectF : Kernel::SelectI;
                if (var != next)
                    run(kernel, place(var), {place(loop.active), place(next), place(var)});
            } else {
                copy(place(var), place(next), type);
            }
        }
    }

    void instruction(const Instruction &instruction) {
        switch (instruction.kind) {
        case InstructionKind::Kernel:
            step(StepKind::Run, variant_of(instruction), instruction.once, {});
            break;
        case InstructionKind::TableRead:
            program_.reads.push_back(read(instruction));
            step(StepKind::TableRead, static_cast<std::uint32_t>(program_.reads.size() - 1),
                 instruction.once, {});
            break;
        case InstructionKind::Image:
            step(StepKind::Image, instruction.payload, instruction.once, {});
            break;
        case InstructionKind::Grid:
            step(StepKind::Grid, instruction.payload, instruction.once, {});
            break;
        case InstructionKind::Call: call(instruction); return;
        case InstructionKind::Loop: loop(instruction); return;
        }
        for (std::uint32_t k = 0; k < instruction.outs; ++k)
            program_.operands.push_back(address(Value{instruction.out.index + k}));
        for (Value in : instruction.in) program_.operands.push_back(address(in));
    }

    static std::uint32_t variant_of(const Instruction &instruction) {
        Variant variant = best_variant(instruction.kernel, instruction.mask);
        assert(variant.mask == instruction.mask);
        return variant.index;
    }

    Read read(const Instruction &instruction) {
        ir::TableId id = ir::table_of(instruction.payload);
        const ir::Table &table = scene_.graph.table(id);
        auto [it, fresh] =
            tables_.emplace(id, static_cast<std::uint32_t>(program_.table_data.size()));
        if (fresh)
            program_.table_data.insert(program_.table_data.end(), table.data.begin(),
                                       table.data.end());
        return {it->second + static_cast<std::uint32_t>(ir::column_of(instruction.payload)),
                table.rows, table.stride, static_cast<int>(instruction.outs)};
    }

    void call(const Instruction &instruction) {
        std::uint32_t index = calls_.body[instruction.payload];
        const Code &callee = codes_[index];
        auto there = [&](Value v) {
            return Place{address(callee, layouts_[index], source_cells_[index], v),
                         callee.values[v].shared};
        };
        for (std::size_t i = 0; i < instruction.in.size(); ++i)
            copy(there(callee.params[i]), place(instruction.in[i]),
                 callee.values[callee.params[i]].type);
        step(StepKind::Call, blocks_[index], false, {});
        for (std::uint32_t k = 0; k < instruction.outs; ++k)
            copy(place(Value{instruction.out.index + k}), there(callee.results[k]),
                 callee.values[callee.results[k]].type);
    }

    void loop(const Instruction &instruction) {
        const LoopCode &loop = code_->loops[instruction.payload];
        for (std::size_t k = 0; k < loop.vars.size(); ++k)
            copy(place(loop.vars[k]), place(loop.init[k]), code_->values[loop.vars[k]].type);
        if (loop.active) copy(place(loop.active), {yes_, true}, ir::Type::Bool);
        std::uint32_t body = block(layout_->loops[instruction.payload], &loop);
        Loop made{body,
                  address(loop.count),
                  code_->values[loop.count].shared,
                  address(loop.index),
                  loop.max_count,
                  static_cast<bool>(loop.condition),
                  {}};
        for (std::size_t k = 0; k < loop.vars.size(); ++k)
            made.carried.push_back({address(loop.vars[k]), address(loop.next[k])});
        program_.loops.push_back(std::move(made));
        step(StepKind::Loop, static_cast<std::uint32_t>(program_.loops.size() - 1), false, {});
    }

    const ir::Scene &scene_;
    const Calls &calls_;
    const std::vector<Code> &codes_;
    Program program_;
    std::vector<Step> whole_; // the blocks made so far
    std::vector<Layout> layouts_;
    std::vector<std::uint32_t> blocks_; // by code
    std::vector<std::vector<std::uint32_t>> source_cells_;
    std::map<std::tuple<Program::Shared::Kind, Word, std::uint32_t, std::uint32_t>, std::uint32_t>
        known_;
    std::unordered_map<ir::TableId, std::uint32_t> tables_;
    std::uint32_t cells_ = 0, yes_ = 0;
    std::size_t first_register_ = 0;
    const Code *code_ = nullptr;
    const Layout *layout_ = nullptr;
    const std::vector<std::uint32_t> *sources_ = nullptr;
};

} // namespace

Program lay_out(const ir::Scene &scene, const Calls &calls, std::vector<Code> codes) {
    return Encoder(scene, calls, codes).run();
}

} // namespace fathom::cpu
