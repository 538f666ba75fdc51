// Assignments: to a variable, a component, an element; and the journal of what they overwrote, so
// that a trial can be undone.
#include "typecheck/remedies.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace fathom::typecheck {

// -- the journal ---------------------------------------------------------------------------------

JournalMark journal_mark(Interpreter &ev) {
    ++ev.journaling;
    return {ev.journal.size(), ev.frame_count};
}

std::vector<Change> journal_take(Interpreter &ev, JournalMark mark) {
    std::vector<Change> changes;
    for (std::size_t i = ev.journal.size(); i-- > mark.entries;) {
        JournalEntry &entry = ev.journal[i];
        if (entry.frame >= mark.frames) continue; // a block inside: gone by now
        Binding &binding = ev.frames[entry.frame].bindings[entry.slot];
        Change *known = nullptr;
        for (Change &c : changes)
            if (c.frame == entry.frame && c.slot == entry.slot) known = &c;
        if (known)
            known->before = entry.old;
        else
            changes.push_back({entry.frame, entry.slot, entry.old, binding.value});
        binding.value = entry.old;
    }
    ev.journal.resize(mark.entries);
    --ev.journaling;
    return changes;
}

void assign(Interpreter &ev, std::uint32_t frame, std::uint32_t slot, Value value) {
    Value &stored = ev.frames[frame].bindings[slot].value;
    if (ev.journaling > 0) ev.journal.push_back({frame, slot, stored});
    stored = value;
}

// -- assignment ----------------------------------------------------------------------------------

namespace {

// One step from a variable into a part of it.
struct Accessor {
    bool is_index = false;
    std::string letters;
    Value index;
    Span span;
};

} // namespace

static Value store(Interpreter &ev, const Value &old, const std::vector<Accessor> &path,
                   std::size_t k, const Value &value, Span place);

static Value store_components(Interpreter &ev, const Value &old, const std::vector<int> &indices,
                              const Value &value, Span place) {
    int size = ir::components(numeric_type(ev, old));
    std::vector<Value> parts;
    for (int i = 0; i < size; ++i)
        parts.push_back(swizzle(ev, old, std::string(1, "xyzw"[i]), place));
    Value source = value;
    if (is_scalar(ev, value))
        source = make_vector(ev, {to_float(ev, value)},
                             static_cast<int>(std::max<std::size_t>(indices.size(), 2)), place);
    for (std::size_t i = 0; i < indices.size(); ++i)
        parts[static_cast<std::size_t>(indices[i])] =
            swizzle(ev, source, std::string(1, "xyzw"[i]), place);
    Value out = make_vector(ev, parts, size, place);
    out.color = old.color;
    return out;
}

static Value store_member(Interpreter &ev, const Value &old, const std::vector<Accessor> &path,
                          std::size_t k, const Value &value, Span place) {
    const Accessor &step = path[k];
    auto indices = is_numeric(old) && ir::is_vector(numeric_type(ev, old))
                       ? swizzle_indices(step.letters, ir::components(numeric_type(ev, old)))
                       : std::nullopt;
    if (!indices) {
        report(ev, Code::UnknownMember, step.span,
               fmt::format("{} has no component `{}`", describe(ev, old), step.letters));
        return poison();
    }
    Value part = k + 1 == path.size() ? value
                                      : store(ev, swizzle(ev, old, step.letters, step.span), path,
                                              k + 1, value, place);
    if (is_poison(part)) return part;
    bool fits =
        is_numeric(part) &&
        (is_scalar(ev, part) || (numeric_type(ev, part) == ir::vector_type(int(indices->size()))));
    if (!fits) {
        report(ev, Code::TypeMismatch, place,
               fmt::format("`.{}` holds {} numbers, this is {}", step.letters, indices->size(),
                           describe(ev, part)));
        return poison();
    }
    return store_components(ev, old, *indices, part, place);
}

static Value store_index(Interpreter &ev, const Value &old, const std::vector<Accessor> &path,
                         std::size_t k, const Value &value, Span place) {
    const Accessor &step = path[k];
    bool vector = is_numeric(old) && ir::is_vector(numeric_type(ev, old));
    if (old.kind != ValueKind::List && !vector) {
        report(ev, Code::TypeMismatch, step.span,
               fmt::format("only elements of lists and vectors can be set, this is {}",
                           describe(ev, old)));
        return poison();
    }
    auto i = want_known_int(ev, step.index, step.span, "an index that is assigned to");
    if (!i) return poison();
    int size =
        vector ? ir::components(numeric_type(ev, old)) : static_cast<int>(ev.lists[old.id].size());
    if (*i < 0 || *i >= size) {
        report(ev, Code::BadIndex, step.span, fmt::format("index {} of {} elements", *i, size));
        return poison();
    }
    if (vector) {
        Value part = k + 1 == path.size() ? value : poison();
        return store_components(ev, old, {*i}, part, place);
    }
    std::vector<Value> items = ev.lists[old.id];
    Value &item = items[static_cast<std::size_t>(*i)];
    item = k + 1 == path.size() ? value : store(ev, item, path, k + 1, value, place);
    return list_value(ev, std::move(items));
}

static Value store(Interpreter &ev, const Value &old, const std::vector<Accessor> &path,
                   std::size_t k, const Value &value, Span place) {
    if (k == path.size()) return value;
    return path[k].is_index ? store_index(ev, old, path, k, value, place)
                            : store_member(ev, old, path, k, value, place);
}

// A variable keeps its type, except that a whole number may become a float.
static bool same_type(Interpreter &ev, Value &old, Value &value) {
    if (is_poison(old) || is_poison(value) || old.kind == ValueKind::None) return true;
    if (is_numeric(old) && is_numeric(value)) {
        ir::Type a = numeric_type(ev, old), b = numeric_type(ev, value);
        if (a == b || (a == ir::Type::Int && b == ir::Type::Float)) return true;
        if (a == ir::Type::Float && b == ir::Type::Int) {
            value = to_float(ev, value);
            return true;
        }
        if (ir::is_vector(a) && (b == ir::Type::Float || b == ir::Type::Int)) {
            value = make_vector(ev, {to_float(ev, value)}, ir::components(a), {});
            return true;
        }
        return false;
    }
    if (is_function(old) && is_function(value)) return true;
    if (old.kind == ValueKind::List || value.kind == ValueKind::List)
        return (old.kind == ValueKind::List ||
                (is_numeric(old) && ir::is_vector(numeric_type(ev, old)))) &&
               (value.kind == ValueKind::List ||
                (is_numeric(value) && ir::is_vector(numeric_type(ev, value))));
    return old.kind == value.kind;
}

// For a name of the scene that is assigned to, or a part of it.
static void help_with_let(const Interpreter &ev, const File &ast, const lang::Assign &node,
                          Diagnostic &d, std::string_view name, const std::vector<Accessor> &path,
                          const Value &value) {
    std::string fresh;
    std::vector<Edit> edits;
    if (path.empty()) edits = renamed_from(ev, ast, node, name, fresh);
    if (!fresh.empty())
        d.help(fmt::format("a scene's names keep their value: give the new value a name of its "
                           "own, `let {} = …`",
                           fresh),
               std::move(edits));
    else if (path.empty())
        d.help("a scene's names keep their value: in a loop, shapes count where they stand, a "
               "list is `[for … { … }]`, and a sum is `fold(list, 0, (a, b) => a + b)`");
    else if (value.kind != ValueKind::Shape)
        d.help(fmt::format("a scene's names keep their value: give the new value a name of its "
                           "own, `let {}2 = …`",
                           short_name(name)));
    else if (const auto way = way_of_part(path.front().letters); !way.empty())
        d.help(fmt::format("what is made does not change: {}", way));
    else
        d.help("what is made does not change: a shape is moved by `.translate(…)`, which gives a "
               "new one");
}

// The function that has its parameter declared there, or none.
static const lang::Function *function_of_parameter(const File &ast, Span declared) {
    for (const lang::Function &f : ast.functions)
        for (const lang::Parameter &p : f.parameters)
            if (p.name.span == declared) return &f;
    return nullptr;
}

bool report_undeclared(Interpreter &ev, std::string_view name, Span at, Span assignment,
                       bool in_body) {
    Diagnostic &d =
        report(ev, Code::UnknownName, at, fmt::format("nothing here is called `{}`", name));
    if (const auto way = way_from_elsewhere(name); !way.empty()) {
        d.help(std::string(way));
        return false;
    }
    if (!assignment.source) return false;
    d.help(fmt::format("declare it: `let {0} = …`, or `var {0} = …` where it changes", name),
           {{{assignment.source, assignment.begin, assignment.begin}, in_body ? "var " : "let "}});
    return true;
}

void run_assign(Interpreter &ev, const File &ast, const lang::Assign &node, Span place,
                std::uint32_t frame) {
    std::vector<Accessor> path;
    lang::ExprId target = node.target;
    for (;;) {
        const lang::Expr &e = ast.exprs[target];
        if (auto *m = std::get_if<lang::Member>(&e.kind)) {
            path.push_back({false, std::string(m->name.text), {}, m->name.span});
            target = m->object;
        } else if (auto *i = std::get_if<lang::Index>(&e.kind)) {
            path.push_back({true, "", eval(ev, ast, i->index, frame), ast.exprs[i->index].span});
            target = i->object;
        } else
            break;
    }
    std::reverse(path.begin(), path.end());
    Value value = eval(ev, ast, node.value, frame);
    const lang::Expr &base = ast.exprs[target];
    auto *name = std::get_if<lang::Name>(&base.kind);
    if (!name) {
        if (!std::holds_alternative<lang::Poison>(base.kind))
            report(ev, Code::NotAssignable, base.span,
                   "only a `var`, or a part of one, can be assigned to");
        return;
    }
    auto found = find_name(ev, frame, symbol_of(ast, *name));
    if (!found) {
        const bool in_body = !ev.frames[frame].index;
        const Span whole = !node.op && path.empty() ? place : Span{};
        if (report_undeclared(ev, name->text, base.span, whole, in_body))
            declare(ev, frame, symbol_of(ast, *name), poison(), in_body, base.span);
        return;
    }
    const Binding binding = ev.frames[found->frame].bindings[found->slot];
    if (!binding.is_var && is_poison(binding.value)) return; // its declaration is in error
    if (!binding.is_var) {
        const Span declared = binding.declared;
        const bool by_let =
            declared.source && declared.begin >= 4 &&
            text(ev.sources, {declared.source, declared.begin - 4, declared.begin}) == "let ";
        const bool in_body = !ev.frames[found->frame].index;
        const lang::Function *taken_by = in_body ? function_of_parameter(ast, declared) : nullptr;
        const bool is_argument = taken_by != nullptr;
        Diagnostic &d =
            report(ev, Code::NotAssignable, base.span,
                   is_argument ? fmt::format("`{}` is an argument, and does not change", name->text)
                               : fmt::format("`{}` was declared with `let` and does not change",
                                             name->text));
        if (binding.declared.source) d.label(binding.declared, "declared here");
        if (is_argument) {
            const Span first = ast.blocks[taken_by->body].stmts.front().span;
            d.help(fmt::format("an argument is changed in a copy: `var {0} = {0}`", name->text),
                   {{{first.source, first.begin, first.begin},
                     fmt::format("var {0} = {0}; ", name->text)}});
        } else if (by_let && in_body)
            d.help(fmt::format("write `var {}` where it is declared", name->text),
                   {{{declared.source, declared.begin - 4, declared.begin - 1}, "var"}});
        else if (ev.calls.empty() && ev.in_field == 0) {
            help_with_let(ev, ast, node, d, name->text, path, binding.value);
        } else if (in_body) {
            d.help("declare it with `var` inside the function");
        } else {
            Span whole = place;
            const std::string &all = ev.sources[place.source].text;
            if (whole.end < all.size() && all[whole.end] == ';') ++whole.end;
            d.help("a function changes nothing outside of it: leave this away, or let the function "
                   "give it",
                   {{whole, ""}});
        }
        // One cause, one report: an argument goes on as the copy that it is told to be.
        if (!is_argument) return assign(ev, found->frame, found->slot, poison());
        ev.frames[found->frame].bindings[found->slot].is_var = true;
    }
    Value old = binding.value;
    if (is_poison(value)) return assign(ev, found->frame, found->slot, value);
    if (node.op) {
        Value current = old;
        for (const Accessor &step : path) {
            if (is_poison(current)) break;
            if (!step.is_index)
                current =
                    is_numeric(current) ? swizzle(ev, current, step.letters, step.span) : poison();
            else {
                auto items = want_list(ev, current, step.span, "an index");
                auto i = want_known_int(ev, step.index, step.span, "an index that is assigned to");
                current = items && i && *i >= 0 && *i < int(items->size())
                              ? (*items)[std::size_t(*i)]
                              : poison();
            }
        }
        value = arithmetic(ev, *node.op, current, value, place, ast.exprs[node.target].span,
                           ast.exprs[node.value].span);
    }
    if (!path.empty() && !is_poison(value))
        value = store(ev, old, path, 0, value, ast.exprs[node.value].span);
    if (is_poison(value)) return assign(ev, found->frame, found->slot, value);
    if (!same_type(ev, old, value)) {
        Diagnostic &d = report(ev, Code::TypeMismatch, ast.exprs[node.value].span,
                               fmt::format("`{}` holds {}, this is {}", name->text,
                                           describe(ev, old), describe(ev, value)));
        if (binding.declared.source) d.label(binding.declared, "declared here");
        return;
    }
    value.ints = false;
    assign(ev, found->frame, found->slot, value);
}

void tell_dropped_value(Interpreter &ev, const File &ast, lang::ExprId id, const Value &v) {
    const auto *call = std::get_if<lang::Call>(&ast.exprs[id].kind);
    const auto *callee = call ? std::get_if<lang::Name>(&ast.exprs[call->callee].kind) : nullptr;
    const bool counts = is_numeric(v) || v.kind == ValueKind::List;
    const bool choice = std::holds_alternative<lang::If>(ast.exprs[id].kind);
    if (!counts || choice || ev.modules[ev.current_module].library ||
        (callee && callee->text == "print"))
        return;
    Diagnostic &d = report(ev, Code::UnusedValue, ast.exprs[id].span,
                           "this value is dropped: a function changes nothing outside of it");
    if (call && !call->arguments.empty()) {
        const std::string given = source_text(ev, ast.exprs[call->arguments[0].value].span);
        const Span at = ast.exprs[id].span;
        const bool place = !given.empty() && std::isalpha(static_cast<unsigned char>(given[0])) &&
                           std::ranges::all_of(given, [](unsigned char c) {
                               return std::isalnum(c) || c == '_' || c == '.';
                           });
        if (place)
            d.help(fmt::format("assign it, as in `{} = {}`", given, source_text(ev, at)),
                   {{{at.source, at.begin, at.begin}, given + " = "}});
    }
}

} // namespace fathom::typecheck
