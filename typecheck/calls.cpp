// Calls: their arguments, builtins and closures (closures.h).
#include "typecheck/closures.h"
#include "typecheck/places.h"
#include "typecheck/remedies.h"

#include "base/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::typecheck {

using ir::Type;

static bool holds_shape(Interpreter &ev, const Value &v) {
    if (v.kind == ValueKind::Shape) return true;
    if (v.kind != ValueKind::List) return false;
    for (const Value &item : ev.lists[v.id])
        if (item.kind == ValueKind::Shape || item.kind == ValueKind::List) return true;
    return false;
}

static bool inside_library(Interpreter &ev) { return ev.modules[ev.current_module].library; }

// A call of a library function with known numbers always gives the same value, so that the bodies
// of `sphere(0.1)` and `cylinder(1, 2)` run once however often a scene has them.
static Value remembered(Interpreter &ev, const Value &callee, std::string_view name,
                        std::span<const Value> values, Span call) {
    const Closure &c = ev.closures[callee.id];
    // What stands in a body is another function each time that the body is run.
    if (!c.ast->functions[c.function].name) return run_closure(ev, callee, name, values, call);
    std::vector<std::uint64_t> key{c.ast->place, c.function.index, c.frame};
    key.reserve(3 + 6 * values.size());
    for (const Value &v : values) {
        const bool known = v.kind == ValueKind::None || v.kind == ValueKind::Bool ||
                           v.kind == ValueKind::Int || v.kind == ValueKind::Float ||
                           v.kind == ValueKind::Vec;
        if (!known) return run_closure(ev, callee, name, values, call);
        key_of(ev, v, key);
    }
    if (auto it = ev.remembered.find(key); it != ev.remembered.end()) return it->second;
    const auto said = [&] { return ev.diagnostics.items().size() + ev.diagnostics.dropped(); };
    const std::size_t before = said();
    const Value v = run_closure(ev, callee, name, values, call);
    // one that has something to say says it each time
    if (ev.quiet == 0 && said() == before && ev.remembered.size() < max_remembered)
        ev.remembered.emplace(std::move(key), v);
    return v;
}

// A parameter that takes a function of the point alone: such arguments are kept as what they give.
static bool of_a_point(const lang::Parameter &p) {
    if (!p.type || p.type->kind != lang::TypeExpr::Kind::Function || p.type->items.size() != 2)
        return false;
    const lang::TypeName from = p.type->items[0].named;
    return (from == lang::TypeName::Vec2 || from == lang::TypeName::Vec3) &&
           p.type->items[1].named == lang::TypeName::Float;
}

Value call_closure(Interpreter &ev, const Value &callee, std::string_view name,
                   std::span<const Argument> args, Span call, Span callee_span) {
    const Closure c = ev.closures[callee.id];
    const lang::Function &f = c.ast->functions[c.function];
    const std::span<const Formal> formals = formals_of(ev, c);
    if (c.library && !inside_library(ev) && shape_out_of_place(ev, name, f, formals, args, call))
        return poison();
    if (c.library && !inside_library(ev) && no_shape_before(ev, name, f, args, callee_span))
        return poison();
    auto bound = bind_arguments(ev, name, formals, args, call, callee_span);
    if (!bound) return poison();
    if (c.library && !inside_library(ev) && color_in_quotes(ev, name, formals, *bound))
        return poison();
    // defaults are evaluated where the function stands, and see the parameters before them
    std::optional<std::uint32_t> frame;
    std::vector<Value> values;
    values.reserve(formals.size());
    bool ok = true, misplaced = false;
    for (std::size_t i = 0; i < formals.size(); ++i) {
        const lang::Parameter &p = f.parameters[i];
        const Given &given = (*bound)[i];
        Value v = given.value;
        if (!given.given) {
            if (!frame) {
                frame = push_frame(ev, c.frame);
                for (std::size_t k = 0; k < i; ++k)
                    declare(ev, *frame, formals[k].symbol, values[k], false, formals[k].declared);
            }
            std::uint32_t module = std::exchange(ev.current_module, c.module);
            v = eval(ev, *c.ast, *p.default_value, *frame);
            ev.current_module = module;
        }
        if (p.type && v.kind != ValueKind::None && !misplaced) {
            if (!check_type(ev, *p.type))
                ok = false;
            else
                v = convert(ev, v, *p.type, given.span, quoted(p.name.text, name), ok);
            misplaced = !ok && given.value.kind == ValueKind::Shape; // so are those behind it
        }
        warn_of_degrees(ev, formals[i], given, v);
        if (c.library && !formals[i].no_limit && !inside_library(ev))
            v = sized(ev, v, given.span, quoted(p.name.text, name));
        ok = ok && !is_poison(v);
        values.push_back(v);
        if (frame) declare(ev, *frame, formals[i].symbol, v, false, formals[i].declared);
    }
    if (frame) pop_frame(ev, *frame);
    if (!ok) return poison();
    if (auto v = specialized(ev, callee, name, values, call)) return *v;
    Value v = c.library ? remembered(ev, callee, name, values, call)
                        : run_closure(ev, callee, name, values, call);
    if (c.library && f.name && v.kind == ValueKind::Shape && !inside_library(ev)) {
        for (const Value &value : values)
            if (holds_shape(ev, value)) return v;
        ir::Library library;
        library.name = f.name->text;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (is_numeric(values[i])) {
                library.arguments.emplace_back(formals[i].name, to_node(ev, values[i]));
            } else if (is_function(values[i]) && of_a_point(f.parameters[i])) {
                const lang::TypeName point = f.parameters[i].type->items[0].named;
                const Type type = point == lang::TypeName::Vec2 ? Type::Vec2 : Type::Vec3;
                if (auto node = apply_field(ev, values[i], {ev.scene.graph.point(type)},
                                            Type::Float, call, "a library's function"))
                    library.arguments.emplace_back(formals[i].name, *node);
            } else if (values[i].kind == ValueKind::List) {
                const std::vector<Value> items = ev.lists[values[i].id];
                std::vector<ir::NodeId> nodes;
                for (const Value &item : items)
                    if (is_numeric(item)) nodes.push_back(to_node(ev, item));
                if (nodes.size() == items.size())
                    library.lists.emplace_back(formals[i].name, std::move(nodes));
            }
        return library_shape(ev, std::move(library), v, call);
    }
    return v;
}

static Value call_builtin(Interpreter &ev, const Value &callee, std::span<const Argument> args,
                          Span call, Span callee_span) {
    const Builtin &b = builtins()[callee.id];
    const std::span<const Formal> formals = formals_of(ev, b);
    auto bound = bind_arguments(ev, b.name, formals, args, call, callee_span);
    if (!bound) return poison();
    CallSite site{b.name, call, callee_span, {}};
    std::vector<Value> values;
    values.reserve(formals.size());
    site.args.reserve(formals.size());
    for (std::size_t i = 0; i < formals.size(); ++i) {
        const Given &given = (*bound)[i];
        if (given.given && is_poison(given.value)) return poison();
        values.push_back(given.given ? given.value : none());
        site.args.push_back(given.span);
        warn_of_degrees(ev, formals[i], given, given.value);
    }
    const Value v = b.call(ev, site, values);
    note_place(ev, v, call);
    return b.computes ? computed(ev, v, values, call, quoted(b.name))
                      : in_range(ev, v, values, call);
}

Value call_value(Interpreter &ev, const Value &callee, std::string_view name,
                 std::span<const Argument> args, Span call, Span callee_span) {
    if (is_poison(callee)) return poison();
    switch (callee.kind) {
    case ValueKind::Closure: return call_closure(ev, callee, name, args, call, callee_span);
    case ValueKind::Builtin: return call_builtin(ev, callee, args, call, callee_span);
    case ValueKind::Overloads: return call_overloads(ev, callee, name, args, call, callee_span);
    case ValueKind::ConstField: return ev.lists[callee.id][0];
    case ValueKind::CachedField:
    case ValueKind::ImageField: {
        Formal point;
        point.symbol = intern(ev, "p");
        point.name = "p";
        auto bound = bind_arguments(ev, name, {&point, 1}, args, call, callee_span);
        if (!bound) return poison();
        bool image = callee.kind == ValueKind::ImageField;
        auto p =
            want_vec_node(ev, (*bound)[0].value, image ? 2 : 3, (*bound)[0].span, quoted(name));
        if (!p) return poison();
        ir::Graph &g = ev.scene.graph;
        if (image)
            return from_node(ev, g.make(ir::Op::Image, Type::Vec4,
                                        {g.div(*p, g.number(callee.num[0]))}, callee.id));
        ir::CacheId cache{callee.id};
        Type type = g[g.function(g.cache(cache).field).result].type;
        return from_node(ev, g.make(ir::Op::Cached, type, {*p}, cache.index), callee.color);
    }
    case ValueKind::Poison:
    case ValueKind::Unit:
    case ValueKind::None:
    case ValueKind::Bool:
    case ValueKind::Int:
    case ValueKind::Float:
    case ValueKind::Vec:
    case ValueKind::Mat:
    case ValueKind::Field:
    case ValueKind::String:
    case ValueKind::List:
    case ValueKind::Range:
    case ValueKind::Shape:
    case ValueKind::Material:
    case ValueKind::Region:
    case ValueKind::Setting:
    case ValueKind::Module: break;
    }
    Diagnostic &d = report(ev, Code::NotCallable, callee_span,
                           fmt::format("{} is {}, not a function",
                                       name.empty() ? "this" : fmt::format("`{}`", name),
                                       describe(ev, callee)));
    if (callee.kind == ValueKind::List ||
        (is_numeric(callee) && ir::is_vector(numeric_type(ev, callee))))
        d.help("an element is `l[i]`");
    if (help_with_hidden(ev, d, name, callee_span)) return poison();
    if (is_scalar(ev, callee))
        d.help("a product is written with `*`",
               {{{callee_span.source, callee_span.end, callee_span.end}, " * "}});
    return poison();
}

Value call_with(Interpreter &ev, const Value &callee, const std::vector<Value> &values,
                Span place) {
    std::vector<Argument> args;
    args.reserve(values.size());
    for (const Value &v : values) {
        Argument &arg = args.emplace_back();
        arg.value = v;
        arg.span = place;
    }
    std::string_view name;
    if (callee.kind == ValueKind::Closure) {
        const Closure &c = ev.closures[callee.id];
        const lang::Function &f = c.ast->functions[c.function];
        if (f.name) name = f.name->text;
    }
    return call_value(ev, callee, name, args, place, place);
}

// A number without a unit, or a list of such.
static bool is_plain_literal(const File &ast, const lang::Expr &e) {
    const auto is_number = [&](const lang::Expr &x) {
        const auto *u = std::get_if<lang::Unary>(&x.kind);
        const bool negated = u && u->op == lang::UnaryOp::Neg;
        const auto *n = std::get_if<lang::Number>(negated ? &ast.exprs[u->operand].kind : &x.kind);
        return n && n->unit.empty();
    };
    if (is_number(e)) return true;
    auto *list = std::get_if<lang::List>(&e.kind);
    return list && !list->items.empty() && std::ranges::all_of(list->items, [&](lang::ExprId id) {
               return is_number(ast.exprs[id]);
           });
}

static void read_arguments(Interpreter &ev, const File &ast, const lang::Call &call,
                           std::uint32_t frame, std::vector<Argument> &args) {
    for (const lang::Argument &a : call.arguments) {
        Argument arg;
        const lang::Expr &e = ast.exprs[a.value];
        if (a.name) arg.name = &*a.name, arg.symbol = symbol_of(ast, *a.name);
        arg.span = e.span;
        arg.value = eval(ev, ast, a.value, frame);
        arg.plain_literal = is_plain_literal(ast, e);
        args.push_back(arg);
    }
    if (call.trailing) {
        std::vector<Contribution> items;
        std::uint32_t inner = push_frame(ev, frame);
        contribute_block(ev, ast, *call.trailing, inner, items);
        pop_frame(ev, inner);
        std::vector<Value> values;
        for (const Contribution &item : items) values.push_back(item.value);
        const auto &stmts = ast.blocks[*call.trailing].stmts;
        const bool unread =
            !stmts.empty() && std::ranges::all_of(stmts, [](const lang::Stmt &stmt) {
                return std::holds_alternative<lang::Bad>(stmt.kind);
            });
        Argument arg;
        arg.value = unread ? poison() : list_value(ev, std::move(values));
        arg.span = ast.blocks[*call.trailing].span;
        arg.trailing = true;
        args.push_back(arg);
    }
}

// `hull() { … }`: where there is no such function, only that is said, and nothing of its `()`.
static void leave_empty_parentheses(Interpreter &ev, Span callee) {
    if (!callee.source || ev.quiet > 0) return;
    const std::string_view all = ev.sources[callee.source].text;
    const std::size_t close = all.find(')', callee.end);
    if (callee.end >= all.size() || all[callee.end] != '(' || close == all.npos) return;
    ev.diagnostics.withdraw(Code::ForeignSyntax,
                            {callee.source, callee.end, static_cast<std::uint32_t>(close + 1)});
}

// For `s.color(red)`, `s.rotateX(a)` and the like, where `s` is a shape.
static void help_with_method(Diagnostic &d, const lang::Member &member, const File &ast,
                             const lang::Call &call) {
    help_with_shape(d, member.name.text);
    const std::string_view name = member.name.text;
    if (name == "color" || name == "colour" || name == "colorize")
        d.help("a shape is given a colour or a material by `.paint(…)`",
               {{member.name.span, "paint"}});
    if (name == "texture" && call.arguments.size() == 1 && !call.arguments[0].name) {
        const Span image = ast.exprs[call.arguments[0].value].span;
        d.help("a picture lies on a shape by `.paint(material(texture: image(…)))`",
               {{member.name.span, "paint"},
                {{image.source, image.begin, image.begin}, "material(texture: image("},
                {{image.source, image.end, image.end}, "))"}});
    }
    const char axis = name.empty() ? ' ' : name.back();
    const char upper = axis >= 'x' && axis <= 'z' ? static_cast<char>(axis - 'x' + 'X') : axis;
    if (upper < 'X' || upper > 'Z') return;
    if (call.arguments.size() != 1 || call.arguments[0].name) return;
    const Span angle = ast.exprs[call.arguments[0].value].span;
    const std::string_view moved = name.substr(0, name.find_last_not_of("_XYZxyz") + 1);
    if (moved == "translate" || moved == "move") {
        const std::string along = fmt::format("{}: ", static_cast<char>(upper - 'X' + 'x'));
        d.help(
            fmt::format("write `.translate({}…)`", along),
            {{member.name.span, "translate"}, {{angle.source, angle.begin, angle.begin}, along}});
        return;
    }
    if (!name.starts_with("rotate") || name.size() > 8) return;
    d.help(fmt::format("write `.rotate(angle, axis: {})`", upper),
           {{member.name.span, "rotate"},
            {{angle.source, angle.end, angle.end}, fmt::format(", axis: {}", upper)}});
}

// `cube(center: true)`: what is wrong with the arguments beside the name, which is that of another
// language.
static void check_as_ours(Interpreter &ev, std::string_view name, std::span<const Argument> args,
                          Span place, Span callee, std::uint32_t frame) {
    const std::string ours(name_from_elsewhere(name));
    if (ours.empty() || std::ranges::none_of(args, [](const Argument &a) { return a.name; }))
        return;
    const auto f = look_up(ev, frame, intern(ev, ours));
    if (f && is_function(*f)) call_value(ev, *f, ours, args, place, callee);
}

Value eval_call(Interpreter &ev, const File &ast, lang::ExprId id, const lang::Call &call,
                std::uint32_t frame) {
    Span place = ast.exprs[id].span;
    const lang::Expr &callee = ast.exprs[call.callee];
    std::vector<Argument> args;
    args.reserve(call.arguments.size() + 2); // the object before the dot, and a block
    if (auto *m = std::get_if<lang::Member>(&callee.kind)) {
        Value object = eval(ev, ast, m->object, frame);
        if (object.kind == ValueKind::Module) {
            const Module module = ev.modules[object.id];
            read_arguments(ev, ast, call, frame, args);
            auto slot = slot_in_module(ev, module.frame, symbol_of(ast, m->name));
            if (!slot || m->name.text[0] == '_') {
                std::vector<std::string> names;
                if (may_compare_names(ev, ev.frames[module.frame].bindings.size()))
                    for (const Binding &b : ev.frames[module.frame].bindings)
                        names.push_back(ev.symbol_names[b.name]);
                Diagnostic &d =
                    report(ev, Code::UnknownMember, m->name.span,
                           m->name.text[0] == '_'
                               ? fmt::format("`{}` is private to `{}`", m->name.text, module.name)
                               : fmt::format("`{}` declares no `{}`", module.name, m->name.text));
                std::string near = nearest_name(m->name.text, names);
                if (!near.empty() && near[0] != '_')
                    d.help(fmt::format("did you mean `{}`?", near), {{m->name.span, near}});
                return poison();
            }
            return call_value(ev, ev.frames[module.frame].bindings[*slot].value, m->name.text, args,
                              place, m->name.span);
        }
        auto f = look_up(ev, frame, symbol_of(ast, m->name));
        if (!f || !is_function(*f)) {
            read_arguments(ev, ast, call, frame, args); // their own errors are still worth saying
            if (is_poison(object)) return poison();
            if (f) {
                report(ev, Code::NotCallable, m->name.span,
                       fmt::format("`{}` is {}, not a function", m->name.text, describe(ev, *f)));
                return poison();
            }
            const std::string near = likely_name(ev, frame, m->name.text, {Use::Called, &object});
            if (lacking(ev, m->name.text, near) ||
                is_foreign_method(ev, object, ast, *m, call, place))
                return poison();
            Diagnostic &d = report(ev, Code::UnknownMember, m->name.span,
                                   fmt::format("there is no function `{}` for {}", m->name.text,
                                               describe(ev, object)));
            if (is_needless_method(m->name.text) && place.source) {
                const Span behind{place.source, ast.exprs[m->object].span.end, place.end};
                const auto way = way_from_elsewhere(m->name.text);
                d.help(way.empty() ? fmt::format("leave `.{}(…)` away", m->name.text)
                                   : std::string(way),
                       {{behind, ""}});
                return poison();
            }
            if (object.kind == ValueKind::Shape) help_with_method(d, *m, ast, call);
            if (const auto way = way_from_elsewhere(m->name.text); !d.fix && !way.empty())
                d.help(std::string(way), edits_of_list_method(ev, ast, *m, call, place));
            if (!d.fix && !near.empty())
                d.help(fmt::format("did you mean `{}`?", near), {{m->name.span, near}});
            if (const auto all = what_there_is(object); !d.fix && !all.empty())
                d.help(std::string(all));
            return poison();
        }
        if (f->kind == ValueKind::Builtin && is_foreign_method(ev, object, ast, *m, call, place))
            return poison();
        Argument self;
        self.value = object;
        self.span = ast.exprs[m->object].span;
        args.push_back(self);
        read_arguments(ev, ast, call, frame, args);
        if (is_poison(object)) return poison();
        return call_value(ev, *f, m->name.text, args, place, m->name.span);
    }
    std::string_view name;
    if (auto *n = std::get_if<lang::Name>(&callee.kind)) name = n->text;
    std::optional<Value> named;
    if (auto *n = std::get_if<lang::Name>(&callee.kind);
        n && !look_up(ev, frame, symbol_of(ast, *n))) {
        report_unknown_name(ev, frame, n->text, callee.span, {Use::Called, nullptr, &ast});
        if (call.trailing) leave_empty_parentheses(ev, callee.span);
        named = poison();
    }
    Value f = named ? *named : eval(ev, ast, call.callee, frame);
    read_arguments(ev, ast, call, frame, args);
    if (is_poison(f)) check_as_ours(ev, name, args, place, callee.span, frame);
    return call_value(ev, f, name, args, place, callee.span);
}

} // namespace fathom::typecheck
