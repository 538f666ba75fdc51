// Vectors by their components: swizzles, vectors of parts, and single elements as known numbers.
#include "ir/passes/param_reads.h"
#include "ir/passes/walk.h"
#include "typecheck/interpreter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::typecheck {

using ir::Op;
using ir::Type;

std::optional<std::vector<int>> swizzle_indices(std::string_view letters, int size) {
    if (letters.empty() || letters.size() > 4) return std::nullopt;
    for (const char *set : {"xyzw", "rgba", "stpq"}) {
        std::vector<int> indices;
        for (char c : letters)
            for (int i = 0; i < size; ++i)
                if (set[i] == c) indices.push_back(i);
        if (indices.size() == letters.size()) return indices;
    }
    return std::nullopt;
}

Value swizzle(Interpreter &ev, const Value &v, std::string_view letters, Span place) {
    Type type = numeric_type(ev, v);
    auto indices =
        ir::is_vector(type) ? swizzle_indices(letters, ir::components(type)) : std::nullopt;
    if (!indices) {
        Diagnostic &d = report(ev, Code::UnknownMember, place,
                               fmt::format("{} has no component `{}`", describe(ev, v), letters));
        if (ir::is_vector(type))
            d.note(ir::components(type) == 2   ? "its components are x and y"
                   : ir::components(type) == 3 ? "its components are x, y and z"
                                               : "its components are x, y, z and w");
        return poison();
    }
    bool color = v.color && indices->size() == 3;
    if (v.kind == ValueKind::Vec) {
        if (indices->size() == 1) {
            double x = v.num[static_cast<std::size_t>((*indices)[0])];
            return v.ints ? integer(x) : number(x);
        }
        Value out = vec(static_cast<int>(indices->size()), {}, color);
        for (std::size_t i = 0; i < indices->size(); ++i)
            out.num[i] = v.num[static_cast<std::size_t>((*indices)[i])];
        return out;
    }
    return from_node(ev, ev.scene.graph.swizzle(node_of(v), *indices), color);
}

// GLSL's constructors: numbers and vectors one after another; one number fills all; a longer vector
// is cut.
Value make_vector(Interpreter &ev, const std::vector<Value> &parts, int size, Span place) {
    std::vector<Value> scalars;
    bool known = true, whole = true;
    for (const Value &part : parts) {
        if (is_poison(part)) return poison();
        if (!is_numeric(part) || ir::is_matrix(numeric_type(ev, part)) ||
            numeric_type(ev, part) == Type::Bool) {
            report(ev, Code::TypeMismatch, place,
                   fmt::format("a vec{} is made of numbers, this is {}", size, describe(ev, part)));
            return poison();
        }
        int n = ir::components(numeric_type(ev, part));
        if (n == 1)
            scalars.push_back(part);
        else
            for (int i = 0; i < n; ++i)
                scalars.push_back(swizzle(ev, part, std::string(1, "xyzw"[i]), place));
    }
    if (scalars.size() == 1) scalars.resize(static_cast<std::size_t>(size), scalars[0]);
    if (parts.size() == 1 && scalars.size() > static_cast<std::size_t>(size))
        scalars.resize(static_cast<std::size_t>(size));
    if (scalars.size() != static_cast<std::size_t>(size)) {
        report(ev, Code::BadArgument, place,
               fmt::format("a vec{} has {} numbers, not {}", size, size, scalars.size()));
        return poison();
    }
    for (const Value &s : scalars) {
        known = known && s.kind != ValueKind::Field;
        whole = whole && s.kind == ValueKind::Int;
    }
    if (known) {
        Value v = vec(size, {});
        for (std::size_t i = 0; i < scalars.size(); ++i) v.num[i] = scalars[i].num[0];
        v.ints = whole;
        return v;
    }
    std::vector<ir::NodeId> nodes;
    for (const Value &s : scalars) nodes.push_back(to_node(ev, to_float(ev, s)));
    return from_node(ev, ev.scene.graph.make(Op::Make, ir::vector_type(size), nodes));
}

// A number that scene time needs. One that depends on params alone is taken at their present
// values, and those params become structural: moving them builds the scene anew (semantics.md, 25).
std::optional<Value> element_as_known(Interpreter &ev, const Value &v, Span place, What what) {
    if (v.kind != ValueKind::Field) return v;
    ir::Graph &g = ev.scene.graph;
    ir::Graph::Reads reads = g.reads(node_of(v));
    if (reads.params && !reads.point && !reads.normal && !reads.direction && !reads.time &&
        !reads.free_vars) {
        ir::Substitution values;
        for (std::size_t i = 0; i < ev.scene.params.size(); ++i)
            values[ev.param_nodes[i]] = g.constant(ev.scene.params[i].present());
        ir::NodeId known = ir::substitute(g, node_of(v), values);
        if (g.is_constant(known)) {
            ir::ParamReads reads_of(ev.scene);
            reads_of.node(node_of(v));
            for (std::size_t i = 0; i < ev.scene.params.size(); ++i)
                if (reads_of.used(i)) ev.scene.params[i].structural = true;
            return from_node(ev, known, v.color);
        }
    }
    const char *why = reads.time && !reads.point ? "`time`" : "the point";
    Diagnostic &d =
        report(ev, Code::StageMismatch, place,
               fmt::format("{} has to be known when the scene is read, and this depends on {}",
                           what, why));
    if (what.text == which_shapes && reads.time && !reads.point)
        d.help("let all shapes stand there, and their sizes, places or what they turn into follow "
               "the time: `sphere(if time > 2 { 1 } else { 0.5 })`, `blend(a, b, t)`");
    return std::nullopt;
}

} // namespace fathom::typecheck
