// Grows a Code: finds equal instructions, calls fuse.cpp for a shorter form, and spreads shared
// operands into registers where no variant of the kernel takes them as they are.
#include "backend-cpu/compile/code.h"

#include "base/hash.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace fathom::cpu {

namespace {

std::uint64_t hash_of(Kernel kernel, std::span<const Value> in) {
    std::uint64_t hash = static_cast<std::uint64_t>(kernel) + 1;
    for (Value value : in) hash = hash_combine(hash, value.index);
    return hash;
}

} // namespace

Value Builder::source(Program::Shared what, ir::Type type) {
    std::uint64_t key = hash_combine(static_cast<std::uint64_t>(what.kind) + 1, what.bits);
    key = hash_combine(hash_combine(key, what.param), what.component);
    for (auto [it, end] = known_sources_.equal_range(key); it != end; ++it) {
        const Program::Shared &known = code_.sources[code_.values[it->second].source].what;
        if (known.kind == what.kind && known.bits == what.bits && known.param == what.param &&
            known.component == what.component)
            return it->second;
    }
    ValueInfo info{type, true, false, 0, {}, static_cast<std::uint32_t>(code_.sources.size())};
    Value value = code_.values.add(info);
    code_.sources.push_back({what, value});
    known_sources_.emplace(key, value);
    return value;
}

Value Builder::number(float value) {
    Program::Shared what;
    what.kind = Program::Shared::Kind::Float;
    what.bits = std::bit_cast<Word>(value);
    return source(what, ir::Type::Float);
}

Value Builder::integer(std::int32_t value) {
    Program::Shared what;
    what.kind = Program::Shared::Kind::Int;
    what.bits = static_cast<Word>(value);
    return source(what, ir::Type::Int);
}

Value Builder::time() {
    Program::Shared what;
    what.kind = Program::Shared::Kind::Time;
    return source(what, ir::Type::Float);
}

Value Builder::param(std::uint32_t param, std::uint32_t component, ir::Type type) {
    Program::Shared what;
    what.kind = Program::Shared::Kind::Param;
    what.param = param;
    what.component = component;
    what.type = type;
    return source(what, type);
}

Value Builder::variable(ir::Type type, bool shared, std::uint16_t level) {
    return code_.values.add({type, shared, false, level, {}, ValueInfo::no_source});
}

std::optional<float> Builder::number_of(Value value) const {
    const ValueInfo &info = code_.values[value];
    if (info.source == ValueInfo::no_source) return {};
    const Program::Shared &what = code_.sources[info.source].what;
    if (what.kind != Program::Shared::Kind::Float) return {};
    return std::bit_cast<float>(what.bits);
}

std::vector<Value> Builder::instruction(InstructionKind kind, std::uint32_t payload,
                                        std::span<const Value> in,
                                        std::span<const ir::Type> types) {
    Instruction made;
    made.kind = kind;
    made.payload = payload;
    made.in.assign(in.begin(), in.end());
    made.once = true;
    for (Value value : in) {
        made.level = std::max(made.level, code_.values[value].level);
        made.once = made.once && code_.values[value].shared;
    }
    made.out = code_.values.next();
    made.outs = static_cast<std::uint32_t>(types.size());
    std::vector<Value> outs;
    for (ir::Type type : types)
        outs.push_back(code_.values.add(
            {type, made.once, false, made.level, code_.instructions.next(), ValueInfo::no_source}));
    code_.instructions.add(std::move(made));
    return outs;
}

Value Builder::spread(Value value) {
    const ValueInfo &info = code_.values[value];
    if (!info.shared) return value;
    Kernel copy = info.type == ir::Type::Float ? Kernel::CopyF : Kernel::CopyI;
    return emit(copy, std::span(&value, 1), true)[0];
}

std::vector<Value> Builder::outputs(Kernel kernel, std::span<const Value> in) {
    assert(in.size() == static_cast<std::size_t>(kernel_inputs(kernel)));
    if (auto known = simplify(*this, kernel, in)) return {*known};
    std::vector<Value> operands(in.begin(), in.end());
    while (auto fused = fuse(*this, kernel, operands)) {
        kernel = fused->kernel;
        operands = std::move(fused->in);
    }
    return emit(kernel, operands, false);
}

std::vector<Value> Builder::emit(Kernel kernel, std::span<const Value> in, bool to_register) {
    auto outputs_of = [&](const Instruction &instruction) {
        std::vector<Value> outs;
        for (std::uint32_t i = 0; i < instruction.outs; ++i)
            outs.push_back(Value{instruction.out.index + i});
        return outs;
    };
    std::vector<Value> operands(in.begin(), in.end());
    Instruction made;
    Mask shared = 0;
    for (std::size_t i = 0; i < operands.size(); ++i)
        if (code_.values[operands[i]].shared) shared |= Mask{1} << i;
    made.once = !to_register && shared == (Mask{1} << operands.size()) - 1;
    if (!made.once) {
        made.mask = best_variant(kernel, shared).mask;
        for (std::size_t i = 0; i < operands.size(); ++i)
            if ((shared & ~made.mask) >> i & 1) operands[i] = spread(operands[i]);
    }
    std::uint64_t key = hash_of(kernel, operands);
    for (auto [it, end] = known_.equal_range(key); it != end; ++it) {
        const Instruction &known = code_.instructions[it->second];
        if (known.kernel == kernel && known.once == made.once &&
            std::ranges::equal(known.in, operands))
            return outputs_of(known);
    }
    made.kernel = kernel;
    for (Value value : operands) {
        made.level = std::max(made.level, code_.values[value].level);
        code_.values[value].used = true;
    }
    made.out = code_.values.next();
    made.outs = static_cast<std::uint32_t>(kernel_outputs(kernel));
    made.in = std::move(operands);
    InstructionId id = code_.instructions.next();
    for (std::uint32_t i = 0; i < made.outs; ++i)
        code_.values.add(
            {kernel_output_type(kernel), made.once, false, made.level, id, ValueInfo::no_source});
    code_.instructions.add(std::move(made));
    known_.emplace(key, id);
    return outputs_of(code_.instructions[id]);
}

} // namespace fathom::cpu
