// Blocks and statements, in both places where they stand: a body, whose last expression is its
// value, and a contributing block (a file, a trailing block, a comprehension), in which every
// expression counts (semantics.md, 3).
#include "typecheck/conditions.h"
#include "typecheck/instances.h"
#include "typecheck/interpreter.h"
#include "typecheck/places.h"
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

// -- statements that are the same everywhere -----------------------------------------------------

static Value declared_value(Interpreter &ev, const File &ast, lang::ExprId value,
                            const lang::TypeExpr *type, std::string_view name,
                            std::uint32_t frame) {
    Value v = eval(ev, ast, value, frame);
    if (!type || is_poison(v)) return v;
    if (!check_type(ev, *type)) return v;
    bool ok = true;
    return convert(ev, v, *type, ast.exprs[value].span, quoted(name), ok);
}

bool run_simple(Interpreter &ev, const File &ast, const lang::Stmt &stmt, std::uint32_t frame) {
    if (auto *l = std::get_if<lang::Let>(&stmt.kind)) {
        declare(ev, frame, symbol_of(ast, l->name),
                declared_value(ev, ast, l->value, l->type, l->name.text, frame), false,
                l->name.span);
    } else if (auto *v = std::get_if<lang::Var>(&stmt.kind)) {
        if (ev.frames[frame].index) report_var_at_top(ev, ast, *v, stmt.span);
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

static Exit run_from(Interpreter &ev, const File &ast, const lang::Block &block, std::size_t at,
                     std::uint32_t frame, Value &last);

static Exit sequence(Interpreter &ev, const Exit &first, Span place,
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
                   "one type, or lists of as many");
            out.value = poison();
        }
    }
    return out;
}

static Value dropped(Interpreter &ev, const Value &v, Span place) {
    if (v.kind == ValueKind::Shape)
        report(ev, Code::UnusedShape, place, "this shape is made and dropped")
            .note("in a function's body only the last expression is its value")
            .help("unite them: `union { … }` around them, or `|` between them");
    if (v.kind == ValueKind::Setting)
        report(ev, Code::WrongPlace, place,
               "a scene setting stands at the top of the scene's file");
    return v;
}

// Whether a name is declared as an `if`, whose arms may leave the body: what they give then is for
// nobody.
static bool declares_choice(const File &ast, const lang::Stmt &stmt) {
    const auto *let = std::get_if<lang::Let>(&stmt.kind);
    const auto *var = std::get_if<lang::Var>(&stmt.kind);
    return (let || var) &&
           std::holds_alternative<lang::If>(ast.exprs[let ? let->value : var->value].kind);
}

static Exit run_one(Interpreter &ev, const File &ast, const lang::Stmt &stmt, bool is_last,
                    std::uint32_t frame, Value &last) {
    Exit exit;
    last = unit();
    ev.leaving = declares_choice(ast, stmt) ? &exit : nullptr;
    const bool done = run_simple(ev, ast, stmt, frame);
    ev.leaving = nullptr; // where the limits ended the evaluation before its `if`
    if (done) return exit;
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
        if (!is_last) {
            tell_dropped_value(ev, ast, e->value, dropped(ev, last, stmt.span));
            last = unit();
        }
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

static Exit run_from(Interpreter &ev, const File &ast, const lang::Block &block, std::size_t at,
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

Outcome run_block(Interpreter &ev, const File &ast, lang::BlockId id, std::uint32_t parent) {
    std::uint32_t frame = push_frame(ev, parent);
    hoist_functions(ev, ast, id, frame);
    Outcome out;
    out.exit = run_from(ev, ast, ast.blocks[id], 0, frame, out.value);
    pop_frame(ev, frame);
    return out;
}

Exit run_unless(Interpreter &ev, const Value &skip, Span place, const std::function<Exit()> &rest) {
    JournalMark mark = journal_mark(ev);
    const std::size_t demanded = ev.scene.conditions.size();
    Exit exit = rest();
    excuse_conditions(ev, demanded, skip);
    for (const Change &c : journal_take(ev, mark)) {
        auto merged = select_value(ev, skip, c.before, c.after);
        if (!merged) {
            report(
                ev, Code::StageMismatch, place,
                "what is assigned after this depends on the point, so it has to be numbers of one "
                "type");
            merged = poison();
        }
        assign(ev, c.frame, c.slot, *merged);
    }
    return exit;
}

// -- choice --------------------------------------------------------------------------------------

// nullopt: not a condition. Params alone decide now where the arms cannot be merged.
static std::optional<Value> condition_value(Interpreter &ev, const File &ast, lang::ExprId id,
                                            std::uint32_t frame) {
    Value v = eval(ev, ast, id, frame);
    if (is_poison(v)) return std::nullopt;
    if (is_numeric(v) && numeric_type(ev, v) == ir::Type::Bool) return v;
    Diagnostic &d = report(ev, Code::TypeMismatch, ast.exprs[id].span,
                           fmt::format("a condition is a bool, this is {}", describe(ev, v)));
    if (is_scalar(ev, v)) d.help("compare it: `x != 0`");
    if (is_function(v)) d.help("`=>` makes a function; at least is written `>=`");
    return std::nullopt;
}

static bool params_only(Interpreter &ev, const Value &v) {
    ir::Graph::Reads r = ev.scene.graph.reads(node_of(v));
    return r.params && !r.point && !r.normal && !r.direction && !r.time && !r.free_vars;
}

static Outcome run_otherwise(Interpreter &ev, const File &ast, const lang::If &node,
                             std::size_t branch, std::uint32_t frame, Span place);

// Both arms, each on its own, merged by the condition. Fails (nullopt) where they are not numbers.
static std::optional<Outcome> run_both(Interpreter &ev, const File &ast, const lang::If &node,
                                       std::size_t branch, const Value &condition,
                                       std::uint32_t frame, Span place) {
    note_place(ev, condition, ast.exprs[node.branches[branch].condition].span);
    JournalMark mark = journal_mark(ev);
    std::size_t demanded = ev.scene.conditions.size();
    Outcome a = run_block(ev, ast, node.branches[branch].body, frame);
    excuse_conditions(ev, demanded, logical_not(ev, condition));
    std::vector<Change> in_a = journal_take(ev, mark);
    mark = journal_mark(ev);
    demanded = ev.scene.conditions.size();
    Outcome b = run_otherwise(ev, ast, node, branch + 1, frame, place);
    excuse_conditions(ev, demanded, condition);
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

static Outcome run_branches(Interpreter &ev, const File &ast, const lang::If &node,
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
            const std::size_t shapes = ev.scene.shapes.size();
            const std::size_t demanded = ev.scene.conditions.size();
            std::size_t errors = std::exchange(ev.quiet_errors, 0);
            auto both = run_both(ev, ast, node, branch, *condition, frame, place);
            bool failed = ev.quiet_errors > 0 || !both || !is_numeric(both->value);
            ev.quiet_errors = errors;
            --ev.quiet;
            if (!failed) return *both;
            ev.scene.shapes.forget_origins(shapes);
            take_conditions(ev, demanded);
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
    report(
        ev, Code::StageMismatch, ast.exprs[node.branches[branch].condition].span,
        "this condition depends on the point or on time, so both arms have to give numbers of one "
        "type, or lists of as many")
        .help("choose between shapes with their fields: `blend(a, b, p => …)`, or cut them with "
              "`within:` or `&`");
    Outcome out;
    out.value = poison();
    return out;
}

static Outcome run_otherwise(Interpreter &ev, const File &ast, const lang::If &node,
                             std::size_t branch, std::uint32_t frame, Span place) {
    if (branch < node.branches.size()) return run_branches(ev, ast, node, branch, frame, place);
    if (node.otherwise) return run_block(ev, ast, *node.otherwise, frame);
    return {};
}

Outcome run_if(Interpreter &ev, const File &ast, const lang::If &node, std::uint32_t frame,
               Span place) {
    return run_branches(ev, ast, node, 0, frame, place);
}

// -- contributing blocks -------------------------------------------------------------------------

static bool contribute_stmt(Interpreter &ev, const File &ast, const lang::Stmt &stmt,
                            std::uint32_t frame, std::vector<Contribution> &out);

bool contribute_block(Interpreter &ev, const File &ast, lang::BlockId block, std::uint32_t frame,
                      std::vector<Contribution> &out) {
    hoist_functions(ev, ast, block, frame);
    for (const lang::Stmt &stmt : ast.blocks[block].stmts) {
        if (!spend(ev, stmt.span)) return true;
        if (contribute_stmt(ev, ast, stmt, frame, out)) return true;
    }
    return false;
}

static bool contribute_inner(Interpreter &ev, const File &ast, lang::BlockId block,
                             std::uint32_t parent, std::vector<Contribution> &out) {
    std::uint32_t frame = push_frame(ev, parent);
    bool broke = contribute_block(ev, ast, block, frame, out);
    pop_frame(ev, frame);
    return broke;
}

static bool contribute_if(Interpreter &ev, const File &ast, const lang::If &node,
                          std::uint32_t frame, std::vector<Contribution> &out) {
    for (const lang::IfBranch &branch : node.branches) {
        auto condition = condition_value(ev, ast, branch.condition, frame);
        if (!condition) return false;
        auto known =
            element_as_known(ev, *condition, ast.exprs[branch.condition].span, which_shapes);
        if (!known) return false;
        if (known->num[0] != 0) return contribute_inner(ev, ast, branch.body, frame, out);
    }
    return node.otherwise ? contribute_inner(ev, ast, *node.otherwise, frame, out) : false;
}

static bool contribute_stmt(Interpreter &ev, const File &ast, const lang::Stmt &stmt,
                            std::uint32_t frame, std::vector<Contribution> &out) {
    if (std::holds_alternative<lang::Bad>(stmt.kind)) // it may have been a shape
        out.push_back({poison(), stmt.span});
    if (run_simple(ev, ast, stmt, frame)) return false;
    if (auto *e = std::get_if<lang::ExprStmt>(&stmt.kind)) {
        if (auto *choice = std::get_if<lang::If>(&ast.exprs[e->value].kind))
            return contribute_if(ev, ast, *choice, frame, out);
        Value v = eval(ev, ast, e->value, frame);
        ev.made += sizeof(Contribution);
        if (v.kind != ValueKind::Unit) out.push_back({v, stmt.span});
    } else if (auto *f = std::get_if<lang::For>(&stmt.kind)) {
        Value seq = eval(ev, ast, f->sequence, frame);
        auto items = sequence_items(ev, seq, ast.exprs[f->sequence].span);
        if (!items) {
            out.push_back({poison(), stmt.span}); // what it would have given is not nothing
            return false;
        }
        auto iteration = [&](const Value &item, std::vector<Contribution> &made) {
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
            if (iteration(item, out)) return false;
        }
        note_iterations(ev, *items, starts, out, iteration);
    } else if (std::holds_alternative<lang::While>(stmt.kind)) {
        report(ev, Code::WrongPlace, stmt.span, "`while` stands inside a function")
            .help("use `for`, or a function that calls itself");
    } else if (std::holds_alternative<lang::Break>(stmt.kind)) {
        return true;
    } else if (std::holds_alternative<lang::Return>(stmt.kind)) {
        report(ev, Code::WrongPlace, stmt.span,
               "`return` stands inside a function; here every expression counts")
            .help("leave it away",
                  {{{stmt.span.source, stmt.span.begin, stmt.span.begin + 6}, ""}});
    }
    return false;
}

static std::size_t numbers_in(const Value &range) {
    return static_cast<std::size_t>(
        std::clamp(std::ceil((range.num[1] - range.num[0]) / range.num[2]), 0.0, 1e18));
}

bool may_list(Interpreter &ev, Span place, std::size_t count) {
    constexpr std::size_t copies = 4; // that stand side by side while a list is made from lists
    if (count > ev.options.limits.work) {
        report(ev, Code::LoopLimit, place, fmt::format("a range of {} numbers is too long", count))
            .note(limit_note(ev.options.limits, &Limits::work))
            .help(limit_help(ev.options.limits, &Limits::work));
        return false;
    }
    return spend(ev, place, count) && has_room(ev, place, copies * count * sizeof(Value));
}

std::optional<std::vector<Value>> sequence_items(Interpreter &ev, const Value &v, Span place) {
    if (is_poison(v)) return std::nullopt;
    if (v.kind == ValueKind::List) { // copied, which is quicker than making
        if (!spend(ev, place, ev.lists[v.id].size() / 8)) return std::nullopt;
        return ev.lists[v.id];
    }
    if (v.kind == ValueKind::Range) {
        const std::size_t count = numbers_in(v);
        if (!may_list(ev, place, count)) return std::nullopt;
        std::vector<Value> items;
        items.reserve(count);
        for (std::size_t i = 0; i < count; ++i)
            items.push_back(integer(v.num[0] + double(i) * v.num[2]));
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
    if (is_scalar(ev, v)) {
        const std::string_view text = place.source
                                          ? std::string_view(ev.sources[place.source].text)
                                                .substr(place.begin, place.end - place.begin)
                                          : std::string_view();
        const std::size_t point = text.find('.'); // `0.5`, where `0..5` was meant
        const bool literal = text.find_first_not_of("0123456789.") == text.npos;
        std::vector<Edit> edits;
        if (literal && point != text.npos)
            edits = {{{place.source, place.begin + std::uint32_t(point),
                       place.begin + std::uint32_t(point) + 1},
                      ".."}};
        else if (place.source)
            edits = {{{place.source, place.begin, place.begin}, "0.."}};
        d.help("write a range: `0..n`", std::move(edits));
    }
    return std::nullopt;
}

} // namespace fathom::typecheck
