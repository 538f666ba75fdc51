// Loops in bodies. While all numbers are known a loop simply runs. As soon as an iteration assigns
// a number that is not known, the loop becomes a Loop: its body is evaluated once with variables
// for the index and for all that it assigns. Where that cannot be (the body needs the index at
// scene time, say), the iterations are written out one by one.
#include "typecheck/conditions.h"
#include "typecheck/interpreter.h"
#include "typecheck/places.h"

#include "ir/lower/lower.h"
#include "ir/passes/loop_parts.h"
#include "ir/passes/operations.h"
#include "ir/passes/walk.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

using ir::Op;
using ir::Type;

namespace {

struct Iterations {
    int count = 0;
    std::vector<Value> items;   // of a list; empty for a range
    double first = 0, step = 1; // of a range
};

Value item_at(const Iterations &iterations, int i) {
    return iterations.items.empty() ? integer(iterations.first + i * iterations.step)
                                    : iterations.items[static_cast<std::size_t>(i)];
}

bool unknown(const Value &v) { return v.kind == ValueKind::Field; }
bool never(const Value &v) { return v.kind == ValueKind::Bool && v.num[0] == 0; }
bool always(const Value &v) { return v.kind == ValueKind::Bool && v.num[0] != 0; }

bool touches_unknown(const Exit &exit, const std::vector<Change> &changes) {
    if (unknown(exit.returned) || unknown(exit.broke) || unknown(exit.value)) return true;
    for (const Change &c : changes)
        if (unknown(c.after)) return true;
    return false;
}

struct Carried {
    std::uint32_t frame, slot;
    Value initial;
    Value variable;
};

// The loop's variable in a Loop: computed from the index, or read from a table of the list's items.
std::optional<Value> symbolic_item(Interpreter &ev, const Iterations &iterations,
                                   ir::NodeId index) {
    ir::Graph &g = ev.scene.graph;
    if (iterations.items.empty()) {
        ir::NodeId i = index;
        if (iterations.step != 1) i = g.mul(i, g.integer(static_cast<int>(iterations.step)));
        if (iterations.first != 0) i = g.add(i, g.integer(static_cast<int>(iterations.first)));
        return from_node(ev, i);
    }
    const Value &first = iterations.items[0];
    if (!is_numeric(first) || unknown(first) || first.kind == ValueKind::Mat) return std::nullopt;
    Type type = numeric_type(ev, first);
    ir::Table table;
    table.rows = iterations.count;
    table.stride = ir::components(type);
    for (const Value &item : iterations.items) {
        if (!is_numeric(item) || unknown(item) || numeric_type(ev, item) != type)
            return std::nullopt;
        for (int c = 0; c < table.stride; ++c)
            table.data.push_back(static_cast<float>(item.num[static_cast<std::size_t>(c)]));
    }
    bool whole = type == Type::Int || type == Type::Bool;
    ir::TableId id = g.add_table(std::move(table));
    ir::NodeId read =
        g.make(Op::TableRead, whole ? Type::Float : type, {index}, ir::table_slot(id, 0));
    if (type == Type::Int) read = g.make(Op::ToInt, Type::Int, {read});
    if (type == Type::Bool) read = g.make(Op::NotEqual, {read, g.number(0)});
    return from_node(ev, read, first.color);
}

struct LoopInput {
    int count = 0;
    ir::NodeId index;
    Span head; // what stands before the body
    std::function<std::optional<Value>()>
        condition;              // evaluated before each iteration; none: always true
    std::function<Exit()> body; // with the index set
    bool has_limit = true;      // else only a loop whose iterations can be counted is one
};

// How many iterations a loop has whose condition depends on nothing but numbers that are known
// before it and change in a known way, as a counter does; none where it depends on more, or goes on
// for `limit`.
std::optional<int> known_iterations(Interpreter &ev, Span place, ir::NodeId condition,
                                    const std::vector<ir::NodeId> &vars,
                                    const std::vector<ir::NodeId> &next,
                                    const std::vector<ir::NodeId> &initial, int limit) {
    ir::Graph &g = ev.scene.graph;
    std::vector<std::size_t> used;
    std::vector<ir::NodeId> todo{condition};
    while (!todo.empty()) {
        const ir::NodeId node = todo.back();
        todo.pop_back();
        const ir::Graph::Reads reads = g.reads(node);
        if (reads.point || reads.normal || reads.direction || reads.time || reads.params)
            return std::nullopt;
        for (ir::NodeId var : g.free_vars(node)) {
            const auto it = std::find(vars.begin(), vars.end(), var);
            if (it == vars.end()) return std::nullopt;
            const auto k = static_cast<std::size_t>(it - vars.begin());
            if (std::find(used.begin(), used.end(), k) != used.end()) continue;
            if (!g.is_constant(initial[k])) return std::nullopt;
            used.push_back(k);
            todo.push_back(next[k]);
        }
    }
    ir::Substitution now;
    for (std::size_t k : used) now[vars[k]] = initial[k];
    std::size_t visited = used.size(); // nodes, which an iteration costs
    for (int iteration = 0; iteration < limit && spend(ev, place, 1 + visited); ++iteration) {
        visited = 0;
        const ir::NodeId go = ir::substitute(g, condition, now, visited);
        if (!g.is_constant(go)) return std::nullopt;
        if (g.constant_of(go).value[0] == 0) return iteration;
        ir::Substitution after;
        for (std::size_t k : used) {
            after[vars[k]] = ir::substitute(g, next[k], now, visited);
            if (!g.is_constant(after[vars[k]])) return std::nullopt;
        }
        now = std::move(after);
    }
    return std::nullopt;
}

// What an iteration makes of a carried value, as a number of the variable's type; an int that
// becomes a float makes the variable one, `again`. Nothing where the types do not fit.
std::optional<Value> as_carried(Interpreter &ev, Carried &k, const Value &v, bool &again,
                                Span place) {
    const Type want = numeric_type(ev, k.initial), have = numeric_type(ev, v);
    if (want == Type::Int && have == Type::Float)
        k.initial = to_float(ev, k.initial), again = true;
    else if (want == Type::Float && have == Type::Int)
        return to_float(ev, v);
    else if (ir::is_vector(want) && ir::components(have) == 1)
        return make_vector(ev, {to_float(ev, v)}, ir::components(want), place);
    else if (want != have)
        return std::nullopt;
    return v;
}

bool takes_too_long(Interpreter &ev, ir::NodeId loop, Span place) {
    const double cost = ir::operations(ev.scene.graph, loop);
    if (cost <= double(ev.options.limits.point)) return false;
    report(ev, Code::LoopLimit, place,
           fmt::format("this loop would take {:.0e} operations a point", cost))
        .note(limit_note(ev.options.limits, &Limits::point))
        .help(limit_help(ev.options.limits, &Limits::point));
    return true;
}

// Puts what the body demands of library arguments, for each turn. Written out, a turn that breaks it
// says so itself, or is seen not to be taken; what cannot be written out is refused here.
enum class Demands { Hold, WriteOut, Refused };
Demands put_demands(Interpreter &ev, const LoopInput &input, const ir::Loop &loop,
                    std::span<const ir::NodeId> initial, std::vector<ir::Condition> conditions,
                    Span place) {
    const std::size_t before = ev.scene.conditions.size();
    const auto broken = put_conditions_of_loop(ev, loop, initial, std::move(conditions), place);
    if (!broken) return Demands::Hold;
    take_conditions(ev, before);
    if (!input.condition && loop.max_count <= max_unrolled) return Demands::WriteOut;
    report(ev, Code::BadArgument, broken->at, broken->wanted)
        .note("in a turn of this loop it is not");
    return Demands::Refused;
}

// Tries the Loop, quietly. On success the assigned variables hold its results and the exit says how
// it was left.
std::optional<Exit> try_loop(Interpreter &ev, const LoopInput &input,
                             const std::vector<Change> &first_changes, Span place) {
    ir::Graph &g = ev.scene.graph;
    std::vector<Carried> carried;
    auto carry = [&](const Change &c) {
        for (const Carried &k : carried)
            if (k.frame == c.frame && k.slot == c.slot) return false;
        carried.push_back({c.frame, c.slot, c.before, {}});
        return true;
    };
    for (const Change &c : first_changes) carry(c);
    bool returns = false;
    Value returned_value; // its kind, once seen
    for (int attempt = 0; attempt < 8; ++attempt) {
        JournalMark mark = journal_mark(ev);
        const std::size_t demanded = ev.scene.conditions.size();
        std::vector<ir::NodeId> vars, next, initial;
        for (Carried &k : carried) {
            if (!is_numeric(k.initial)) {
                journal_take(ev, mark);
                return std::nullopt;
            }
            ir::NodeId var = g.fresh_var(numeric_type(ev, k.initial));
            k.variable = from_node(ev, var, k.initial.color);
            assign(ev, k.frame, k.slot, k.variable);
            vars.push_back(var);
            initial.push_back(to_node(ev, k.initial));
        }
        ++ev.quiet;
        std::size_t errors = std::exchange(ev.quiet_errors, 0);
        std::optional<Value> condition =
            input.condition ? input.condition() : std::optional(boolean(true));
        Exit exit = input.body();
        bool failed = ev.quiet_errors > 0 || !condition || is_poison(*condition);
        ev.quiet_errors = errors;
        --ev.quiet;
        std::vector<Change> changes = journal_take(ev, mark);
        std::vector<ir::Condition> conditions = take_conditions(ev, demanded);
        if (failed) return std::nullopt;

        bool again = false;
        for (const Change &c : changes) again = carry(c) || again;
        std::vector<Value> after;
        for (Carried &k : carried) {
            Value v = k.initial;
            bool changed = false;
            for (const Change &c : changes)
                if (c.frame == k.frame && c.slot == k.slot) v = c.after, changed = true;
            if (!changed && !again) v = k.variable;
            if (is_poison(v) || !is_numeric(v)) return std::nullopt;
            const std::optional<Value> converted = as_carried(ev, k, v, again, place);
            if (!converted) return std::nullopt;
            after.push_back(*converted);
        }
        if (again) continue;

        // leaving early: two more carried values, `left` and, where the loop returns, what
        bool leaves = !never(exit.returned) || !never(exit.broke);
        std::optional<std::size_t> left_at, returned_at, value_at;
        for (const Value &v : after) next.push_back(to_node(ev, v));
        auto carry_flag = [&](const Value &now) {
            ir::NodeId var = g.fresh_var(Type::Bool);
            vars.push_back(var);
            initial.push_back(g.boolean(false));
            next.push_back(to_node(ev, now));
            return vars.size() - 1;
        };
        if (leaves) left_at = carry_flag(logical_or(ev, exit.returned, exit.broke));
        returns = !never(exit.returned);
        if (returns) {
            if (!is_numeric(exit.value)) return std::nullopt;
            returned_at = carry_flag(exit.returned);
            returned_value = exit.value;
            ir::NodeId value = to_node(ev, exit.value);
            ir::NodeId var = g.fresh_var(g[value].type);
            ir::Constant zero;
            zero.type = g[value].type;
            vars.push_back(var);
            initial.push_back(g.constant(zero));
            next.push_back(value);
            value_at = vars.size() - 1;
        }
        if (vars.empty()) return Exit{};
        Value go = *condition;
        int count = input.count;
        const std::optional<int> iterations =
            always(go)
                ? std::nullopt
                : known_iterations(ev, place, to_node(ev, go), vars, next, initial, input.count);
        if (iterations) count = *iterations, go = boolean(true);
        if (!iterations && !input.has_limit) return std::nullopt;
        ir::Loop loop;
        loop.count = g.integer(count);
        loop.max_count = count;
        loop.index = input.index;
        loop.vars = vars;
        loop.next = next;
        if (left_at) go = logical_and(ev, go, logical_not(ev, from_node(ev, vars[*left_at])));
        if (!always(go)) loop.condition = to_node(ev, go);
        const Demands demands = put_demands(ev, input, loop, initial, std::move(conditions), place);
        if (demands == Demands::WriteOut) return std::nullopt;
        if (demands == Demands::Refused) return Exit{};
        ir::LoopId id = g.add_loop(std::move(loop));
        ir::NodeId node = g.make(Op::Loop, g[vars[0]].type, initial, id.index);
        if (takes_too_long(ev, node, place)) return Exit{};
        auto result = [&](std::size_t k) {
            return with_noted_loops(ev, ir::loop_result(g, node, k), input.head);
        };
        for (std::size_t k = 0; k < carried.size(); ++k)
            assign(ev, carried[k].frame, carried[k].slot,
                   from_node(ev, result(k), carried[k].variable.color));
        Exit out;
        if (returns) {
            out.returned = from_node(ev, result(*returned_at));
            out.value = from_node(ev, result(*value_at), returned_value.color);
        }
        return out;
    }
    return std::nullopt;
}

} // namespace

Outcome run_for(Interpreter &ev, const File &ast, const lang::For &node, std::uint32_t frame,
                Span place) {
    Outcome out;
    Value seq = eval(ev, ast, node.sequence, frame);
    if (is_poison(seq)) return out;
    Iterations iterations;
    if (seq.kind == ValueKind::Range) {
        iterations.count = static_cast<int>(
            std::min(2e9, std::max(0.0, std::ceil((seq.num[1] - seq.num[0]) / seq.num[2]))));
        iterations.first = seq.num[0];
        iterations.step = seq.num[2];
    } else {
        auto items = sequence_items(ev, seq, ast.exprs[node.sequence].span);
        if (!items) return out;
        iterations.items = std::move(*items);
        iterations.count = static_cast<int>(iterations.items.size());
    }
    auto iteration = [&](const Value &item) {
        std::uint32_t inner = push_frame(ev, frame);
        declare(ev, inner, symbol_of(ast, node.variable), item, false, node.variable.span);
        Outcome o = run_block(ev, ast, node.body, inner);
        pop_frame(ev, inner);
        if (o.value.kind == ValueKind::Shape)
            report(ev, Code::UnusedShape, place, "the shapes of this loop are made and dropped")
                .help("in a function's body wrap the loop: `union { for … { … } }`");
        return o.exit;
    };
    int unrolled = 0;
    for (int i = 0; i < iterations.count; ++i) {
        if (!spend(ev, place)) return out;
        JournalMark mark = journal_mark(ev);
        Exit exit = iteration(item_at(iterations, i));
        std::vector<Change> changes = journal_take(ev, mark);
        bool touched = touches_unknown(exit, changes);
        if (touched && i == 0 && iterations.count > 2 && iterations.count <= max_loop_iterations) {
            LoopInput input;
            input.count = iterations.count;
            input.index = ev.scene.graph.fresh_var(Type::Int);
            input.head = {place.source, place.begin, ast.exprs[node.sequence].span.end};
            if (auto item = symbolic_item(ev, iterations, input.index)) {
                input.body = [&] { return iteration(*item); };
                if (auto folded = try_loop(ev, input, changes, place)) {
                    out.exit = *folded;
                    return out;
                }
            }
        }
        if (touched && ++unrolled > max_unrolled) {
            report(ev, Code::LoopLimit, place,
                   fmt::format(
                       "this loop cannot stay a loop, and {} iterations are too many to write out",
                       iterations.count));
            return out;
        }
        for (const Change &c : changes) assign(ev, c.frame, c.slot, c.after);
        // how the iteration was left
        if (always(exit.broke)) return out;
        if (always(exit.returned)) {
            out.exit = exit;
            return out;
        }
        if (never(exit.broke) && never(exit.returned)) continue;
        // the further iterations happen only where this one was not left
        Value left = logical_or(ev, exit.returned, exit.broke);
        std::function<Exit(int)> run_rest = [&](int at) -> Exit {
            if (at >= iterations.count) return {};
            Exit e = iteration(item_at(iterations, at));
            Value gone = logical_or(ev, e.returned, e.broke);
            if (always(gone) || at + 1 >= iterations.count || at - i > 256) return e;
            Exit r = never(gone) ? run_rest(at + 1)
                                 : run_unless(ev, gone, place, [&] { return run_rest(at + 1); });
            Exit both;
            both.returned =
                logical_or(ev, e.returned, logical_and(ev, logical_not(ev, e.broke), r.returned));
            both.broke = boolean(false);
            both.value = never(r.returned) ? e.value
                         : never(e.returned)
                             ? r.value
                             : select_value(ev, e.returned, e.value, r.value).value_or(poison());
            return both;
        };
        Exit rest = run_unless(ev, left, place, [&] { return run_rest(i + 1); });
        out.exit.returned = logical_or(ev, exit.returned,
                                       logical_and(ev, logical_not(ev, exit.broke), rest.returned));
        out.exit.value =
            never(rest.returned) ? exit.value
            : never(exit.returned)
                ? rest.value
                : select_value(ev, exit.returned, exit.value, rest.value).value_or(poison());
        return out;
    }
    return out;
}

Outcome run_while(Interpreter &ev, const File &ast, const lang::While &node, std::uint32_t frame,
                  Span place) {
    Outcome out;
    int limit = 1'000'000;
    if (node.limit) {
        auto n = want_known_int(ev, eval(ev, ast, *node.limit, frame), ast.exprs[*node.limit].span,
                                "a loop's limit");
        if (!n) return out;
        limit = *n;
    }
    Span condition_place = ast.exprs[node.condition].span;
    auto condition = [&]() -> std::optional<Value> {
        Value v = eval(ev, ast, node.condition, frame);
        if (is_poison(v)) return std::nullopt;
        if (is_numeric(v) && numeric_type(ev, v) == Type::Bool) return v;
        report(ev, Code::TypeMismatch, condition_place,
               fmt::format("a condition is a bool, this is {}", describe(ev, v)));
        return std::nullopt;
    };
    auto iteration = [&] { return run_block(ev, ast, node.body, frame).exit; };
    for (int i = 0; i < limit; ++i) {
        if (!spend(ev, place)) return out;
        auto go = condition();
        if (!go || never(*go)) return out;
        std::size_t said = ev.diagnostics.items().size() + ev.quiet_errors;
        JournalMark mark = journal_mark(ev);
        Exit exit = iteration();
        std::vector<Change> changes = journal_take(ev, mark);
        if (unknown(*go) || touches_unknown(exit, changes)) {
            LoopInput input;
            input.count = node.limit ? limit - i : max_loop_iterations;
            input.has_limit = node.limit.has_value();
            input.index = ev.scene.graph.fresh_var(Type::Int);
            input.head = {place.source, place.begin, condition_place.end};
            input.condition = condition;
            input.body = iteration;
            if (auto folded = try_loop(ev, input, changes, place)) {
                out.exit = *folded;
                return out;
            }
            if (ev.diagnostics.items().size() + ev.quiet_errors > said) return out; // one cause
            if (!node.limit) {
                report(ev, Code::LoopLimit, place,
                       "a loop over numbers that depend on the point needs a limit")
                    .help("say how many iterations it takes at most: `while … limit 32 { … }`");
                return out;
            }
            report(ev, Code::StageMismatch, place,
                   "this loop's variables have to be numbers of one type, since it depends on the "
                   "point");
            return out;
        }
        for (const Change &c : changes) assign(ev, c.frame, c.slot, c.after);
        if (always(exit.broke)) return out;
        if (always(exit.returned)) {
            out.exit = exit;
            return out;
        }
    }
    if (!node.limit)
        report(ev, Code::LoopLimit, place,
               fmt::format("this loop did not end within {} iterations", limit));
    return out;
}

} // namespace fathom::typecheck
