// See closures.h.
#include "typecheck/closures.h"

#include "typecheck/conditions.h"
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace fathom::typecheck {

static bool varies(Interpreter &ev, const Value &v) {
    if (v.kind != ValueKind::Field) return false;
    ir::Graph::Reads r = ev.scene.graph.reads(node_of(v));
    return r.point || r.normal || r.direction || r.free_vars;
}

// Values that hold no number of field time, and so mean the same in every call.
static bool is_closed(Interpreter &ev, const Value &v, int depth = 0) {
    if (v.kind == ValueKind::Field || v.kind == ValueKind::Shape || v.kind == ValueKind::Material ||
        depth > 4 || !spend(ev, {}))
        return false;
    if (v.kind == ValueKind::Closure) return !ev.closures[v.id].in_field;
    if (v.kind == ValueKind::List || v.kind == ValueKind::ConstField ||
        v.kind == ValueKind::Overloads) {
        const std::vector<Value> &items = ev.lists[v.id]; // a deque's: it stays where it is
        if (!spend(ev, {}, items.size() / 8)) return false;
        if (items.size() > 64) {
            for (const Value &item : items)
                if (item.kind == ValueKind::Field || item.kind == ValueKind::Shape) return false;
            return true;
        }
        for (const Value &item : items)
            if (!is_closed(ev, item, depth + 1)) return false;
    }
    return true;
}

static bool frame_has_vars(Interpreter &ev, std::uint32_t frame) {
    for (;; frame = ev.frames[frame].parent) {
        const Frame &f = ev.frames[frame];
        if (f.index) return false;
        for (const Binding &b : f.bindings)
            if (b.is_var || b.value.kind == ValueKind::Field) return true;
        if (f.parent == frame) return false;
    }
}

void key_of(Interpreter &ev, const Value &v, std::vector<std::uint64_t> &key) {
    if (varies(ev, v)) {
        key.push_back(0x1000 + static_cast<std::uint64_t>(numeric_type(ev, v)) * 2 + v.color);
        return;
    }
    key.push_back(static_cast<std::uint64_t>(v.kind) << 8 |
                  static_cast<std::uint64_t>(v.size) << 2 |
                  static_cast<std::uint64_t>(v.ints) << 1 | static_cast<std::uint64_t>(v.color));
    key.push_back(v.id);
    for (double x : v.num) {
        std::uint64_t bits;
        std::memcpy(&bits, &x, sizeof bits);
        key.push_back(bits);
    }
}

static Outcome run_body(Interpreter &ev, const Closure &c, const lang::Function &f,
                        std::uint32_t frame) {
    return run_block(ev, *c.ast, f.body, frame);
}

// The value that a body ends with, its early returns included.
static Value result_of(Interpreter &ev, const Outcome &out, Span place) {
    const Value &returned = out.exit.returned;
    if (returned.kind == ValueKind::Bool) return returned.num[0] != 0 ? out.exit.value : out.value;
    if (auto merged = select_value(ev, returned, out.exit.value, out.value)) return *merged;
    report(
        ev, Code::StageMismatch, place,
        "what this returns is chosen by the point, so every way has to give numbers of one type, "
        "or lists of as many");
    return poison();
}

Value value_of_if(Interpreter &ev, const File &ast, const lang::If &node, Span place,
                  std::uint32_t frame) {
    Exit *leaving = std::exchange(ev.leaving, nullptr);
    const Outcome out = run_if(ev, ast, node, frame, place);
    const auto never = [](const Value &v) { return v.kind == ValueKind::Bool && v.num[0] == 0; };
    if (leaving) {
        *leaving = out.exit;
    } else if (!never(out.exit.returned) || !never(out.exit.broke)) {
        report(ev, Code::WrongPlace, place,
               fmt::format("`{}` leaves an `if` whose value is used here",
                           never(out.exit.broke) ? "return" : "break"))
            .help("declare the value as a name of its own, `let v = if … { … } else { … }`, or let "
                  "the `if` stand above as a statement");
        return poison();
    }
    return out.value;
}

static Value finish(Interpreter &ev, const Closure &c, Value v, const lang::Function &f,
                    std::string_view name) {
    Span place = f.span;
    const bool unread = std::ranges::any_of(c.ast->blocks[f.body].stmts, [&](const auto &stmt) {
        const auto *let = std::get_if<lang::Let>(&stmt.kind); // a name that stands for what was bad
        return std::holds_alternative<lang::Bad>(stmt.kind) ||
               (let && std::holds_alternative<lang::Poison>(c.ast->exprs[let->value].kind));
    });
    if (v.kind == ValueKind::Unit && unread) return poison(); // it may be what could not be read
    if (v.kind == ValueKind::Unit && !c.library && report_unfinished(ev, c, f, name))
        return poison();
    if (v.kind == ValueKind::Unit && f.result) {
        report(ev, Code::MissingValue, f.head.source ? f.head : place,
               fmt::format("`{}` promises a `{}` and ends without a value", name,
                           type_text(*f.result)));
        return poison();
    }
    if (!f.result || is_poison(v)) return v;
    bool ok = true;
    Span last = f.result->span;
    return convert(ev, v, *f.result, last, fmt::format("`{}`'s result", name), ok);
}

static bool enter(Interpreter &ev, std::string_view name, Span call, const Closure &c) {
    if (ev.calls.size() >= static_cast<std::size_t>(max_call_depth)) {
        report(ev, Code::RecursionLimit, call,
               fmt::format("calls nest deeper than {}; is there an end to this recursion?",
                           max_call_depth));
        return false;
    }
    ev.calls.push_back({name, call, c.library, c.module});
    return true;
}

Value run_closure(Interpreter &ev, const Value &callee, std::string_view name,
                  std::span<const Value> values, Span call) {
    Closure c = ev.closures[callee.id];
    const lang::Function &f = c.ast->functions[c.function];
    if (!enter(ev, name, call, c)) return poison();
    std::uint32_t module = std::exchange(ev.current_module, c.module);
    std::uint32_t frame = push_frame(ev, c.frame);
    for (std::size_t i = 0; i < values.size(); ++i)
        declare(ev, frame, symbol_of(*c.ast, f.parameters[i].name), values[i], false,
                f.parameters[i].name.span);
    Outcome out = run_body(ev, c, f, frame);
    Value v = finish(ev, c, result_of(ev, out, f.span), f, name);
    pop_frame(ev, frame);
    ev.current_module = module;
    ev.calls.pop_back();
    return v;
}

// What a function's body demands, of these arguments; gives what does not hold. A library's function
// is to blame where it is called, any other where it says so.
static std::optional<ir::Condition> demand(Interpreter &ev, const Specialization &s,
                                           std::span<const ir::NodeId> args, Span of_library) {
    if (s.conditions.empty()) return std::nullopt;
    ir::Substitution map;
    for (std::size_t i = 0; i < args.size(); ++i) map[s.params[i]] = args[i];
    std::vector<ir::Condition> conditions = s.conditions;
    if (of_library.source)
        for (ir::Condition &condition : conditions) condition.at = users_place(ev, of_library);
    return put_conditions(ev, conditions, map);
}

std::optional<Value> specialized(Interpreter &ev, const Value &callee, std::string_view name,
                                 std::span<const Value> known, Span call) {
    std::span<const Value> values = known;
    if (std::none_of(values.begin(), values.end(), [&](const Value &v) { return varies(ev, v); }))
        return std::nullopt;
    const Closure c = ev.closures[callee.id];
    const lang::Function &f = c.ast->functions[c.function];
    if (!f.name || c.in_field) return std::nullopt;
    for (const Value &v : values) {
        bool field = varies(ev, v);
        if (!field && v.kind != ValueKind::Field && !is_closed(ev, v)) return std::nullopt;
        if (!field && v.kind == ValueKind::Field && !is_numeric(v)) return std::nullopt;
    }
    if (frame_has_vars(ev, c.frame)) return std::nullopt;
    auto id = std::pair{c.ast, c.function.index};
    if (auto it = ev.never_specialize.find(id); it != ev.never_specialize.end())
        return std::nullopt;
    ir::Graph &g = ev.scene.graph;
    std::vector<Value> opened;
    const bool open = ev.specialized[id] >= max_known_sets;
    if (open) {
        opened.assign(values.begin(), values.end());
        for (Value &v : opened)
            if (v.kind == ValueKind::Float || v.kind == ValueKind::Vec)
                v = from_node(ev, g.fresh_var(numeric_type(ev, v)), v.color);
        values = opened;
    }
    std::vector<std::uint64_t> key{reinterpret_cast<std::uintptr_t>(c.ast), c.function.index,
                                   c.frame};
    for (const Value &v : values) key_of(ev, v, key);
    auto it = ev.specializations.find(key);
    if (it == ev.specializations.end()) {
        std::vector<Value> inner(values.begin(), values.end());
        ir::Function function;
        function.name = f.name->text;
        function.origin = c.library ? Span{} : f.head;
        for (Value &v : inner) {
            if (!varies(ev, v)) continue;
            ir::NodeId var = g.fresh_var(numeric_type(ev, v));
            function.params.push_back(var);
            v = from_node(ev, var, v.color);
        }
        const std::size_t demanded = ev.scene.conditions.size();
        std::size_t errors = ev.quiet > 0 ? ev.quiet_errors : ev.diagnostics.errors();
        ++ev.in_field, ev.quiet += open;
        if (open) errors = ev.quiet_errors;
        Value result = run_closure(ev, callee, name, inner, call);
        bool failed = (ev.quiet > 0 ? ev.quiet_errors : ev.diagnostics.errors()) > errors;
        --ev.in_field, ev.quiet -= open;
        std::vector<ir::Condition> conditions = take_conditions(ev, demanded);
        if (open && (is_poison(result) || failed || !is_numeric(result))) {
            ev.quiet_errors = errors;
            ev.specialized[id] = std::numeric_limits<int>::min();
            return specialized(ev, callee, name, known, call);
        }
        if (is_poison(result) || failed) return poison();
        if (!is_numeric(result)) {
            ev.never_specialize[id] = true;
            return std::nullopt;
        }
        Specialization s;
        s.shape_of_result = result;
        s.params = function.params;
        s.conditions = std::move(conditions);
        if (result.kind == ValueKind::Field) {
            for (ir::NodeId free : g.free_vars(node_of(result)))
                if (std::find(function.params.begin(), function.params.end(), free) ==
                    function.params.end())
                    return std::nullopt;
            if (g.reads(node_of(result)).point || g.reads(node_of(result)).normal)
                return std::nullopt;
            function.result = node_of(result);
            s.function = g.add_function(std::move(function));
        }
        it = ev.specializations.emplace(std::move(key), s).first;
        ++ev.specialized[id];
    }
    const Specialization &s = it->second;
    std::vector<ir::NodeId> nodes;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (varies(ev, values[i])) nodes.push_back(to_node(ev, known[i]));
    if (const auto broken = demand(ev, s, nodes, c.library ? call : Span{})) {
        if (open) { // its own numbers say what is wrong with them
            ev.specialized[id] = std::numeric_limits<int>::min();
            return specialized(ev, callee, name, known, call);
        }
        report(ev, Code::BadArgument, broken->at, broken->wanted);
        return poison();
    }
    if (!s.function) return s.shape_of_result;
    return from_node(ev, g.call(s.function, nodes), s.shape_of_result.color);
}

} // namespace fathom::typecheck
