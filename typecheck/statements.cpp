// Blocks and statements, in both places where they stand: a body, whose last expression is its
// value, and a contributing block (a file, a trailing block, a comprehension), in which every
// expression counts (semantics.md, 3).
#include "typecheck/evaluator.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

// -- the journal ---------------------------------------------------------------------------------

JournalMark journal_mark(Evaluator &ev) {
    ++ev.journaling;
    return {ev.journal.size(), ev.frame_count};
}

std::vector<Change> journal_take(Evaluator &ev, JournalMark mark) {
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

void assign(Evaluator &ev, std::uint32_t frame, std::uint32_t slot, Value value) {
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

static Value store(Evaluator &ev, const Value &old, const std::vector<Accessor> &path,
                   std::size_t k, const Value &value, Span place);

static Value store_components(Evaluator &ev, const Value &old, const std::vector<int> &indices,
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

static Value store_member(Evaluator &ev, const Value &old, const std::vector<Accessor> &path,
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

static Value store_index(Evaluator &ev, const Value &old, const std::vector<Accessor> &path,
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

static Value store(Evaluator &ev, const Value &old, const std::vector<Accessor> &path,
                   std::size_t k, const Value &value, Span place) {
    if (k == path.size()) return value;
    return path[k].is_index ? store_index(ev, old, path, k, value, place)
                            : store_member(ev, old, path, k, value, place);
}

// A variable keeps its type, except that a whole number may become a float.
static bool same_type(Evaluator &ev, Value &old, Value &value) {
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

static void run_assign(Evaluator &ev, const File &ast, const lang::Assign &node, Span place,
                       std::uint32_t frame) {
    std::vector<Accessor> path;
    lang::ExprId target = node.target;
    for (;;) {
        const lang::Expr &e = ast.exprs[target];
        if (auto *m = std::get_if<lang::Member>(&e.kind)) {
            path.push_back({false, m->name.text, {}, m->name.span});
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
        Diagnostic &d = report(ev, Code::UnknownName, base.span,
                               fmt::format("nothing here is called `{}`", name->text));
        if (!node.op && path.empty())
            d.help(fmt::format("declare it: `let {} = …`, or `var {} = …` where it changes",
                               name->text, name->text));
        return;
    }
    const Binding binding = ev.frames[found->frame].bindings[found->slot];
    if (!binding.is_var) {
        Diagnostic &d =
            report(ev, Code::NotAssignable, base.span,
                   fmt::format("`{}` was declared with `let` and does not change", name->text));
        if (binding.declared.source) d.label(binding.declared, "declared here");
        if (ev.calls.empty() && ev.in_field == 0)
            d.help("a scene's names keep their value: give the new value a name of its own");
        else
            d.help("declare it with `var` inside the function");
        return;
    }
    Value old = binding.value;
    if (is_poison(value)) {
        assign(ev, found->frame, found->slot, poison());
        return;
    }
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
        if (is_poison(value)) return;
    }
    if (!path.empty()) value = store(ev, old, path, 0, value, ast.exprs[node.value].span);
    if (is_poison(value)) return;
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

// -- statements that are the same everywhere
// -------------------------------------------------------

static Value declared_value(Evaluator &ev, const File &ast, lang::ExprId value,
                            const std::optional<lang::TypeExpr> &type, std::string_view name,
                            std::uint32_t frame) {
    Value v = eval(ev, ast, value, frame);
    if (!type || is_poison(v)) return v;
    if (!check_type(ev, *type)) return v;
    bool ok = true;
    return convert(ev, v, *type, ast.exprs[value].span, quoted(name), ok);
}

bool run_simple(Evaluator &ev, const File &ast, const lang::Stmt &stmt, std::uint32_t frame) {
    if (auto *l = std::get_if<lang::Let>(&stmt.kind)) {
        declare(ev, frame, symbol_of(ast, l->name),
                declared_value(ev, ast, l->value, l->type, l->name.text, frame), false,
                l->name.span);
    } else if (auto *v = std::get_if<lang::Var>(&stmt.kind)) {
        if (ev.frames[frame].index)
            report(ev, Code::WrongPlace, stmt.span,
                   "`var` stands inside a function; at the top of a file names do not change")
                .help("write `let`");
        Value value = declared_value(ev, ast, v->value, v->type, v->name.text, frame);
        value.ints = false;
        declare(ev, frame, symbol_of(ast, v->name), value, true, v->name.span);
    } else if (auto *a = std::get_if<lang::Assign>(&stmt.kind)) {
        run_assign(ev, ast, *a, stmt.span, frame);
    } else if (std::holds_alternative<lang::Bad>(stmt.kind) ||
               std::holds_alternative<lang::FunctionDecl>(stmt.kind)) {
    } else if (auto *p = std::get_if<lang::Param>(&stmt.kind)) {
        if (ev.frames[frame].index)
            declare_param(ev, ast, *p, frame);
        else
            report(ev, Code::WrongPlace, stmt.span, "a `param` stands at the top of a file");
    } else if (auto *i = std::get_if<lang::Import>(&stmt.kind)) {
        if (ev.frames[frame].index)
            import_module(ev, *i, stmt.span, ev.current_module);
        else
            report(ev, Code::WrongPlace, stmt.span, "an `import` stands at the top of a file");
    } else
        return false;
    return true;
}

// -- bodies --------------------------------------------------------------------------------------

static Exit run_from(Evaluator &ev, const File &ast, const lang::Block &block, std::size_t at,
                     std::uint32_t frame, Value &last);

static Exit sequence(Evaluator &ev, const Exit &first, Span place,
                     const std::function<Exit()> &rest) {
    Value left = logical_or(ev, first.returned, first.broke);
    if (left.kind == ValueKind::Bool && left.num[0] != 0) return first;
    Exit second = left.kind == ValueKind::Bool ? rest() : run_unless(ev, left, place, rest);
    Exit out;
    out.returned = logical_or(ev, first.returned,
                              logical_and(ev, logical_not(ev, first.broke), second.returned));
    out.broke =
        logical_or(ev, first.broke, logical_and(ev, logical_not(ev, first.returned), second.broke));
    out.value = second.value;
    if (!is(first.returned, ValueKind::Bool)) {
        bool second_never = second.returned.kind == ValueKind::Bool && second.returned.num[0] == 0;
        if (second_never)
            out.value = first.value;
        else if (auto merged = select_value(ev, first.returned, first.value, second.value))
            out.value = *merged;
        else {
            report(ev, Code::StageMismatch, place,
                   "what this returns is chosen by the point, so both ways have to give numbers of "
                   "one type");
            out.value = poison();
        }
    }
    return out;
}

static Value dropped(Evaluator &ev, const Value &v, Span place) {
    if (v.kind == ValueKind::Shape)
        report(ev, Code::UnusedShape, place, "this shape is made and dropped")
            .note("in a function's body only the last expression is its value")
            .help("unite them: `union { … }` around them, or `|` between them");
    if (v.kind == ValueKind::Setting)
        report(ev, Code::WrongPlace, place,
               "a scene setting stands at the top of the scene's file");
    return v;
}

static Exit run_one(Evaluator &ev, const File &ast, const lang::Stmt &stmt, bool is_last,
                    std::uint32_t frame, Value &last) {
    Exit exit;
    last = unit();
    if (run_simple(ev, ast, stmt, frame)) return exit;
    if (auto *e = std::get_if<lang::ExprStmt>(&stmt.kind)) {
        if (auto *choice = std::get_if<lang::If>(&ast.exprs[e->value].kind)) {
            Outcome out = run_if(ev, ast, *choice, frame, stmt.span);
            last = out.value;
            exit = out.exit;
        } else
            last = eval(ev, ast, e->value, frame);
        // where the library refuses an argument, the call is over: one cause, one report
        if (!is_last && is_poison(last) && ev.modules[ev.current_module].library) {
            exit.returned = boolean(true);
            exit.value = poison();
        }
        if (!is_last) dropped(ev, last, stmt.span), last = unit();
    } else if (auto *f = std::get_if<lang::For>(&stmt.kind)) {
        exit = run_for(ev, ast, *f, frame, stmt.span).exit;
    } else if (auto *w = std::get_if<lang::While>(&stmt.kind)) {
        exit = run_while(ev, ast, *w, frame, stmt.span).exit;
    } else if (std::holds_alternative<lang::Break>(stmt.kind)) {
        exit.broke = boolean(true);
    } else if (auto *r = std::get_if<lang::Return>(&stmt.kind)) {
        exit.returned = boolean(true);
        exit.value = r->value ? eval(ev, ast, *r->value, frame) : unit();
    }
    return exit;
}

static Exit run_from(Evaluator &ev, const File &ast, const lang::Block &block, std::size_t at,
                     std::uint32_t frame, Value &last) {
    Exit exit;
    for (std::size_t i = at; i < block.stmts.size(); ++i) {
        exit = run_one(ev, ast, block.stmts[i], i + 1 == block.stmts.size(), frame, last);
        Value left = logical_or(ev, exit.returned, exit.broke);
        if (left.kind == ValueKind::Bool && left.num[0] == 0) continue;
        return sequence(ev, exit, block.stmts[i].span,
                        [&] { return run_from(ev, ast, block, i + 1, frame, last); });
    }
    return exit;
}

Outcome run_block(Evaluator &ev, const File &ast, lang::BlockId id, std::uint32_t parent) {
    std::uint32_t frame = push_frame(ev, parent);
    hoist_functions(ev, ast, id, frame);
    Outcome out;
    out.exit = run_from(ev, ast, ast.blocks[id], 0, frame, out.value);
    pop_frame(ev, frame);
    return out;
}

Exit run_unless(Evaluator &ev, const Value &skip, Span place, const std::function<Exit()> &rest) {
    JournalMark mark = journal_mark(ev);
    Exit exit = rest();
    for (const Change &c : journal_take(ev, mark)) {
        auto merged = select_value(ev, skip, c.before, c.after);
        if (!merged) {
            report(ev, Code::StageMismatch, place,
                   "what is assigned after this hangs on the point, so it has to be numbers of one "
                   "type");
            merged = poison();
        }
        assign(ev, c.frame, c.slot, *merged);
    }
    return exit;
}

// -- choice --------------------------------------------------------------------------------------

// nullopt: not a condition. Params alone decide now where the arms cannot be merged.
static std::optional<Value> condition_value(Evaluator &ev, const File &ast, lang::ExprId id,
                                            std::uint32_t frame) {
    Value v = eval(ev, ast, id, frame);
    if (is_poison(v)) return std::nullopt;
    if (is_numeric(v) && numeric_type(ev, v) == ir::Type::Bool) return v;
    Diagnostic &d = report(ev, Code::TypeMismatch, ast.exprs[id].span,
                           fmt::format("a condition is a bool, this is {}", describe(ev, v)));
    if (is_scalar(ev, v)) d.help("compare it: `x != 0`");
    return std::nullopt;
}

static bool params_only(Evaluator &ev, const Value &v) {
    ir::Graph::Reads r = ev.scene.graph.reads(node_of(v));
    return r.params && !r.point && !r.normal && !r.direction && !r.time && !r.free_vars;
}

static Outcome run_otherwise(Evaluator &ev, const File &ast, const lang::If &node,
                             std::size_t branch, std::uint32_t frame, Span place);

// Both arms, each on its own, merged by the condition. Fails (nullopt) where they are not numbers.
static std::optional<Outcome> run_both(Evaluator &ev, const File &ast, const lang::If &node,
                                       std::size_t branch, const Value &condition,
                                       std::uint32_t frame, Span place) {
    JournalMark mark = journal_mark(ev);
    Outcome a = run_block(ev, ast, node.branches[branch].body, frame);
    std::vector<Change> in_a = journal_take(ev, mark);
    mark = journal_mark(ev);
    Outcome b = run_otherwise(ev, ast, node, branch + 1, frame, place);
    std::vector<Change> in_b = journal_take(ev, mark);
    Outcome out;
    bool ok = true;
    auto merge = [&](const Value &x, const Value &y) {
        auto v = select_value(ev, condition, x, y);
        ok = ok && v.has_value();
        return v ? *v : poison();
    };
    auto never = [](const Value &v) { return v.kind == ValueKind::Bool && v.num[0] == 0; };
    auto always = [](const Value &v) { return v.kind == ValueKind::Bool && v.num[0] != 0; };
    bool a_leaves = always(a.exit.returned) || always(a.exit.broke),
         b_leaves = always(b.exit.returned) || always(b.exit.broke);
    if (a_leaves)
        out.value = b.value;
    else if (b_leaves)
        out.value = a.value;
    else if (a.value.kind == ValueKind::Unit || b.value.kind == ValueKind::Unit)
        out.value = unit();
    else
        out.value = merge(a.value, b.value);
    out.exit.returned = merge(a.exit.returned, b.exit.returned);
    out.exit.broke = merge(a.exit.broke, b.exit.broke);
    if (never(a.exit.returned))
        out.exit.value = b.exit.value;
    else if (never(b.exit.returned))
        out.exit.value = a.exit.value;
    else
        out.exit.value = merge(a.exit.value, b.exit.value);
    std::vector<Change> merged;
    for (const Change &c : in_a) {
        Value other = c.before;
        for (const Change &d : in_b)
            if (d.frame == c.frame && d.slot == c.slot) other = d.after;
        merged.push_back({c.frame, c.slot, c.before,
                          a_leaves   ? other
                          : b_leaves ? c.after
                                     : merge(c.after, other)});
    }
    for (const Change &d : in_b) {
        bool seen = false;
        for (const Change &c : in_a) seen = seen || (c.frame == d.frame && c.slot == d.slot);
        if (!seen)
            merged.push_back({d.frame, d.slot, d.before,
                              a_leaves   ? d.after
                              : b_leaves ? d.before
                                         : merge(d.before, d.after)});
    }
    if (!ok) return std::nullopt;
    for (const Change &c : merged) assign(ev, c.frame, c.slot, c.after);
    return out;
}

static Outcome run_branches(Evaluator &ev, const File &ast, const lang::If &node,
                            std::size_t branch, std::uint32_t frame, Span place) {
    auto condition = condition_value(ev, ast, node.branches[branch].condition, frame);
    if (!condition) {
        Outcome out;
        out.value = poison();
        return out;
    }
    if (condition->kind == ValueKind::Field && ev.in_field == 0 && params_only(ev, *condition)) {
        // outside of fields the arms are tried as numbers first, once; else the param's present
        // value decides
        if (ev.quiet == 0) {
            ++ev.quiet;
            std::size_t errors = std::exchange(ev.quiet_errors, 0);
            auto both = run_both(ev, ast, node, branch, *condition, frame, place);
            bool failed = ev.quiet_errors > 0 || !both || !is_numeric(both->value);
            ev.quiet_errors = errors;
            --ev.quiet;
            if (!failed) return *both;
        }
        auto known = element_as_known(
            ev, *condition, ast.exprs[node.branches[branch].condition].span, "this condition");
        if (known) condition = known;
    }
    if (condition->kind == ValueKind::Bool) {
        if (condition->num[0] != 0) return run_block(ev, ast, node.branches[branch].body, frame);
        return run_otherwise(ev, ast, node, branch + 1, frame, place);
    }
    if (auto both = run_both(ev, ast, node, branch, *condition, frame, place)) return *both;
    report(ev, Code::StageMismatch, ast.exprs[node.branches[branch].condition].span,
           "this condition hangs on the point or on time, so both arms have to give numbers of one "
           "type")
        .help("choose between shapes with their fields: `blend(a, b, p => …)`, or cut them with "
              "`within:` or `&`");
    Outcome out;
    out.value = poison();
    return out;
}

static Outcome run_otherwise(Evaluator &ev, const File &ast, const lang::If &node,
                             std::size_t branch, std::uint32_t frame, Span place) {
    if (branch < node.branches.size()) return run_branches(ev, ast, node, branch, frame, place);
    if (node.otherwise) return run_block(ev, ast, *node.otherwise, frame);
    return {};
}

Outcome run_if(Evaluator &ev, const File &ast, const lang::If &node, std::uint32_t frame,
               Span place) {
    return run_branches(ev, ast, node, 0, frame, place);
}

// -- contributing blocks -------------------------------------------------------------------------

static bool contribute_stmt(Evaluator &ev, const File &ast, const lang::Stmt &stmt,
                            std::uint32_t frame, std::vector<Contribution> &out);

bool contribute_block(Evaluator &ev, const File &ast, lang::BlockId block, std::uint32_t frame,
                      std::vector<Contribution> &out) {
    hoist_functions(ev, ast, block, frame);
    for (const lang::Stmt &stmt : ast.blocks[block].stmts) {
        if (!spend(ev, stmt.span)) return true;
        if (contribute_stmt(ev, ast, stmt, frame, out)) return true;
    }
    return false;
}

static bool contribute_inner(Evaluator &ev, const File &ast, lang::BlockId block,
                             std::uint32_t parent, std::vector<Contribution> &out) {
    std::uint32_t frame = push_frame(ev, parent);
    bool broke = contribute_block(ev, ast, block, frame, out);
    pop_frame(ev, frame);
    return broke;
}

static bool contribute_if(Evaluator &ev, const File &ast, const lang::If &node, std::uint32_t frame,
                          std::vector<Contribution> &out) {
    for (const lang::IfBranch &branch : node.branches) {
        auto condition = condition_value(ev, ast, branch.condition, frame);
        if (!condition) return false;
        auto known = element_as_known(ev, *condition, ast.exprs[branch.condition].span,
                                      "a condition that decides which shapes there are");
        if (!known) return false;
        if (known->num[0] != 0) return contribute_inner(ev, ast, branch.body, frame, out);
    }
    return node.otherwise ? contribute_inner(ev, ast, *node.otherwise, frame, out) : false;
}

static bool contribute_stmt(Evaluator &ev, const File &ast, const lang::Stmt &stmt,
                            std::uint32_t frame, std::vector<Contribution> &out) {
    if (std::holds_alternative<lang::Bad>(stmt.kind)) // it may have been a shape
        out.push_back({poison(), stmt.span});
    if (run_simple(ev, ast, stmt, frame)) return false;
    if (auto *e = std::get_if<lang::ExprStmt>(&stmt.kind)) {
        if (auto *choice = std::get_if<lang::If>(&ast.exprs[e->value].kind))
            return contribute_if(ev, ast, *choice, frame, out);
        Value v = eval(ev, ast, e->value, frame);
        if (v.kind != ValueKind::Unit) out.push_back({v, stmt.span});
    } else if (auto *f = std::get_if<lang::For>(&stmt.kind)) {
        Value seq = eval(ev, ast, f->sequence, frame);
        auto items = sequence_items(ev, seq, ast.exprs[f->sequence].span);
        if (!items) {
            out.push_back({poison(), stmt.span}); // what it would have given is not nothing
            return false;
        }
        auto turn = [&](const Value &item, std::vector<Contribution> &made) {
            std::uint32_t inner = push_frame(ev, frame);
            declare(ev, inner, symbol_of(ast, f->variable), item, false, f->variable.span);
            bool broke = contribute_block(ev, ast, f->body, inner, made);
            pop_frame(ev, inner);
            return broke;
        };
        std::vector<std::size_t> starts;
        for (const Value &item : *items) {
            if (!spend(ev, stmt.span)) return true;
            starts.push_back(out.size());
            if (turn(item, out)) return false;
        }
        note_turns(ev, *items, starts, out, turn);
    } else if (std::holds_alternative<lang::While>(stmt.kind)) {
        report(ev, Code::WrongPlace, stmt.span, "`while` stands inside a function")
            .help("use `for`, or a function that calls itself");
    } else if (std::holds_alternative<lang::Break>(stmt.kind)) {
        return true;
    } else if (std::holds_alternative<lang::Return>(stmt.kind)) {
        report(ev, Code::WrongPlace, stmt.span,
               "`return` stands inside a function; here every expression counts");
    }
    return false;
}

std::optional<std::vector<Value>> sequence_items(Evaluator &ev, const Value &v, Span place) {
    if (is_poison(v)) return std::nullopt;
    if (v.kind == ValueKind::List) return ev.lists[v.id];
    if (v.kind == ValueKind::Range) {
        double count = std::max(0.0, std::ceil((v.num[1] - v.num[0]) / v.num[2]));
        if (count > 10'000'000 || !spend(ev, place, static_cast<std::size_t>(count))) {
            report(ev, Code::LoopLimit, place,
                   fmt::format("a range of {:.0f} numbers is too long", count));
            return std::nullopt;
        }
        std::vector<Value> items;
        for (double i = 0; i < count; ++i) items.push_back(integer(v.num[0] + i * v.num[2]));
        return items;
    }
    if (is_numeric(v) && ir::is_vector(numeric_type(ev, v))) {
        std::vector<Value> items;
        for (int i = 0; i < ir::components(numeric_type(ev, v)); ++i)
            items.push_back(swizzle(ev, v, std::string(1, "xyzw"[i]), place));
        return items;
    }
    Diagnostic &d =
        report(ev, Code::TypeMismatch, place,
               fmt::format("a loop runs over a range or a list, this is {}", describe(ev, v)));
    if (is_scalar(ev, v)) d.help("write a range: `0..n`");
    return std::nullopt;
}

} // namespace fathom::typecheck
