// The types that each op is asked with in tests. Ops that have no value of their own (inputs,
// structure, hits) have no cases.
#pragma once

#include "ir/graph.h"

#include <array>
#include <span>
#include <vector>

namespace fathom::scenes {

using ir::Op;
using ir::Type;

inline constexpr Type int_and_floats[] = {Type::Int,  Type::Float, Type::Vec2, Type::Vec3,
                                          Type::Vec4, Type::Mat2,  Type::Mat3, Type::Mat4};
inline constexpr std::span<const Type>
    with_int(int_and_floats), all = with_int.subspan(1), vectors_and_float = all.subspan(0, 4),
                              vectors = all.subspan(1, 3), matrices = all.subspan(4),
                              vec3(&int_and_floats[3], 1);

struct Case {
    Op op;
    std::vector<Type> args;
    Type result;
};

inline std::vector<Case> cases_of(Op op) {
    std::vector<Case> cases;
    const auto same = [&](std::size_t arity, std::span<const Type> types) {
        for (Type t : types) cases.push_back({op, std::vector<Type>(arity, t), t});
    };
    switch (op) {
#define FATHOM_BOUND(name, ...) case Op::name:
#include "ir/ops.def"
        break;
#define FATHOM_BY_COMPONENT(name, ...) case Op::name:
#include "ir/ops.def"
        same(static_cast<std::size_t>(ir::info(op).arity),
             ir::info(op).takes == ir::Takes::Numbers ? with_int : all);
        break;
    case Op::Dot:
        for (Type t : vectors_and_float) cases.push_back({op, {t, t}, Type::Float});
        break;
    case Op::Length:
        for (Type t : vectors_and_float) cases.push_back({op, {t}, Type::Float});
        break;
    case Op::Cross: same(2, vec3); break;
    case Op::Normalize: same(1, vectors); break;
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
        for (Type t : {Type::Float, Type::Int}) cases.push_back({op, {t, t}, Type::Bool});
        break;
    case Op::And:
    case Op::Or: cases.push_back({op, {Type::Bool, Type::Bool}, Type::Bool}); break;
    case Op::Not: cases.push_back({op, {Type::Bool}, Type::Bool}); break;
    case Op::Select:
        for (Type t : with_int) cases.push_back({op, {Type::Bool, t, t}, t});
        break;
    case Op::ToFloat:
        cases.push_back({op, {Type::Int}, Type::Float});
        cases.push_back({op, {Type::Bool}, Type::Float});
        break;
    case Op::ToInt:
        cases.push_back({op, {Type::Float}, Type::Int});
        cases.push_back({op, {Type::Bool}, Type::Int});
        break;
    case Op::Splat:
        for (Type t : all)
            if (t != Type::Float) cases.push_back({op, {Type::Float}, t});
        break;
    case Op::Make:
        for (int n = 2; n <= 4; ++n) {
            cases.push_back({op, std::vector<Type>(static_cast<std::size_t>(n), Type::Float),
                             ir::vector_type(n)});
            cases.push_back({op, std::vector<Type>(static_cast<std::size_t>(n), ir::vector_type(n)),
                             ir::matrix_type(n)});
        }
        break;
    case Op::Swizzle: cases.push_back({op, {Type::Vec4}, Type::Vec3}); break;
    case Op::Column: cases.push_back({op, {Type::Mat3}, Type::Vec3}); break;
    case Op::MatMul:
        for (int n = 2; n <= 4; ++n) {
            const Type m = ir::matrix_type(n), v = ir::vector_type(n);
            cases.push_back({op, {m, v}, v});
            cases.push_back({op, {v, m}, v});
            cases.push_back({op, {m, m}, m});
        }
        break;
    case Op::Transpose: same(1, matrices); break;
    case Op::Hash:
        for (Type t : {Type::Int, Type::Float, Type::Vec2, Type::Vec3, Type::Vec4})
            cases.push_back({op, {t}, Type::Float});
        break;
    case Op::Perlin:
    case Op::Simplex:
    case Op::ValueNoise:
    case Op::Worley: cases.push_back({op, {Type::Vec3}, Type::Float}); break;
    case Op::SpotNoise:
        cases.push_back({op, {Type::Vec3, Type::Float, Type::Float}, Type::Float});
        break;
    case Op::Union:
    case Op::Intersection:
        for (std::size_t n : {1u, 2u, 3u, 5u})
            cases.push_back({op, std::vector<Type>(n, Type::Float), Type::Float});
        break;
    case Op::Blend:
        for (std::size_t n : {3u, 4u, 6u})
            cases.push_back({op, std::vector<Type>(n, Type::Float), Type::Float});
        break;
    }
    return cases;
}

inline std::vector<std::uint32_t> payloads_of(Op op) {
    if (op == Op::Blend) return {0, 1, 2, 3, 4};
    if (op == Op::Swizzle)
        return {ir::swizzle_mask(std::array{3, 0, 1}), ir::swizzle_mask(std::array{2, 2, 0})};
    if (op == Op::Column) return {0, 2};
    return {0};
}

} // namespace fathom::scenes
