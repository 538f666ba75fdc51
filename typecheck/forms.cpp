// Functions of several forms, which differ by the types of their parameters, as GLSL has `noise` of a
// vec2 and of a vec3: how they are declared, and which one a call means.
#include "typecheck/binding.h"
#include "typecheck/closures.h"

#include <fmt/format.h>

#include <algorithm>

namespace fathom::typecheck {

namespace {

bool same_type(const lang::TypeExpr &a, const lang::TypeExpr &b) {
    return a.kind == b.kind && a.named == b.named &&
           std::ranges::equal(a.items, b.items, same_type);
}

// Whether each call fits one of the two: a parameter has another type, or their number is another.
bool told_apart(const lang::Function &a, const lang::Function &b) {
    const auto typed = [](const lang::Function &f) {
        return std::ranges::all_of(f.parameters, [](const lang::Parameter &p) {
            return p.type != nullptr && p.type->named != lang::TypeName::Unknown;
        });
    };
    const auto needed = [](const lang::Function &f) {
        return static_cast<std::size_t>(std::ranges::count_if(
            f.parameters, [](const lang::Parameter &p) { return !p.default_value; }));
    };
    if (!typed(a) || !typed(b)) return false;
    if (a.parameters.size() < needed(b) || b.parameters.size() < needed(a)) return true;
    const std::size_t both = std::min(needed(a), needed(b));
    for (std::size_t i = 0; i < both; ++i)
        if (!same_type(*a.parameters[i].type, *b.parameters[i].type)) return true;
    return false;
}

const lang::Function &function_of(const Interpreter &ev, const Value &closure) {
    const Closure &c = ev.closures[closure.id];
    return c.ast->functions[c.function];
}

// The forms that the name has, and this one; nothing where they are not told apart.
std::optional<std::vector<Value>> with_form(Interpreter &ev, const Value &old, const Value &form) {
    std::vector<Value> all;
    if (old.kind == ValueKind::Overloads)
        all = ev.lists[old.id];
    else if (old.kind == ValueKind::Closure)
        all = {old};
    else
        return std::nullopt;
    constexpr std::size_t most_forms = 32; // each call tries them all
    if (all.size() >= most_forms) return std::nullopt;
    const bool library = ev.modules[ev.current_module].library; // whose order tells
    for (const Value &other : all)
        if (!library && !told_apart(function_of(ev, other), function_of(ev, form)))
            return std::nullopt;
    all.push_back(form);
    return all;
}

// How far an argument is from a parameter: 0 of its type, 1 an int for a float or a vec3 for a color
// and the reverse, `filled` a number for a vector.
constexpr int filled = 1000; // more than all parameters' ones together
int distance_to(const Interpreter &ev, const Value &v, const lang::TypeExpr &type) {
    using lang::TypeName;
    if (type.kind != lang::TypeExpr::Kind::Name || !is_numeric(v)) return 0;
    const bool vector = type.named == TypeName::Vec2 || type.named == TypeName::Vec3 ||
                        type.named == TypeName::Vec4 || type.named == TypeName::Color;
    switch (numeric_type(ev, v)) {
    case ir::Type::Int: return vector ? filled : type.named == TypeName::Int ? 0 : 1;
    case ir::Type::Float: return vector ? filled : 0;
    case ir::Type::Vec3: return type.named == (v.color ? TypeName::Color : TypeName::Vec3) ? 0 : 1;
    case ir::Type::Vec2:
    case ir::Type::Vec4:
    case ir::Type::Bool:
    case ir::Type::Mat2:
    case ir::Type::Mat3:
    case ir::Type::Mat4:
    case ir::Type::Hit: return 0;
    }
    return 0;
}

} // namespace

void hoist_functions(Interpreter &ev, const File &ast, lang::BlockId block, std::uint32_t frame) {
    for (const lang::Stmt &s : ast.blocks[block].stmts)
        if (auto *f = std::get_if<lang::FunctionDecl>(&s.kind)) {
            const lang::Function &fn = ast.functions[f->function];
            if (!fn.name) continue;
            const Value closure = make_closure(ev, ast, f->function, frame);
            const Symbol name = symbol_of(ast, *fn.name);
            if (ev.frames[frame].index)
                if (const auto slot = slot_in_module(ev, frame, name)) {
                    const Value old = ev.frames[frame].bindings[*slot].value;
                    if (auto all = with_form(ev, old, closure)) {
                        const Value list = list_value(ev, std::move(*all));
                        ev.frames[frame].bindings[*slot].value =
                            make_value(ValueKind::Overloads, list.id);
                        continue;
                    }
                }
            declare(ev, frame, name, closure, false, fn.name->span);
        }
}

Value call_overloads(Interpreter &ev, const Value &callee, std::string_view name,
                     std::span<const Argument> args, Span call, Span callee_span) {
    const std::vector<Value> candidates = ev.lists[callee.id];
    const Value *nearest = nullptr;
    int least = 0;
    bool several = false; // are as near as the nearest
    for (const Value &candidate : candidates) {
        const Closure &c = ev.closures[candidate.id];
        const lang::Function &f = c.ast->functions[c.function];
        ++ev.quiet;
        auto bound = bind_arguments(ev, name, formals_of(ev, c), args, call, callee_span);
        bool fits = bound.has_value();
        int distance = 0;
        for (std::size_t i = 0; fits && i < f.parameters.size(); ++i)
            if ((*bound)[i].given && f.parameters[i].type) {
                fits = accepts(ev, (*bound)[i].value, *f.parameters[i].type);
                distance += distance_to(ev, (*bound)[i].value, *f.parameters[i].type);
            }
        --ev.quiet;
        if (fits && c.library) // whose order tells
            return call_closure(ev, candidate, name, args, call, callee_span);
        if (!fits || (nearest && distance > least)) continue;
        several = nearest && distance == least;
        nearest = &candidate;
        least = distance;
    }
    if (several) {
        report(ev, Code::TypeMismatch, call, fmt::format("several forms of `{}` take this", name))
            .help("give it what one form takes as it is: `vec2(1)` or `vec3(1)`, `1.0` or `1`");
        return poison();
    }
    if (nearest) return call_closure(ev, *nearest, name, args, call, callee_span);
    // none fits: the one whose first parameter does explains best
    const Value *best = &candidates[0];
    for (const Value &candidate : candidates) {
        const Closure &c = ev.closures[candidate.id];
        const lang::Function &f = c.ast->functions[c.function];
        if (!args.empty() && !f.parameters.empty() && f.parameters[0].type &&
            accepts(ev, args[0].value, *f.parameters[0].type)) {
            best = &candidate;
            break;
        }
    }
    return call_closure(ev, *best, name, args, call, callee_span);
}

} // namespace fathom::typecheck
