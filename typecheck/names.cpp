// Names and the frames that hold them: a frame per block, call and module, each with its parent.
#include "typecheck/remedies.h"

#include "base/suggest.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace fathom::typecheck {

Symbol intern(Interpreter &ev, std::string_view text) {
    auto [it, added] =
        ev.symbols.try_emplace(std::string(text), static_cast<Symbol>(ev.symbol_names.size()));
    if (added) ev.symbol_names.emplace_back(text);
    return it->second;
}

std::uint32_t push_frame(Interpreter &ev, std::uint32_t parent) {
    if (ev.frame_count == ev.frames.size()) ev.frames.emplace_back();
    ev.frames[ev.frame_count].parent = parent;
    return ev.frame_count++;
}

// A frame that no closure refers to is given back, so that a loop of a million iterations needs
// one.
void pop_frame(Interpreter &ev, std::uint32_t frame) {
    if (frame + 1 != ev.frame_count || ev.frames[frame].captured) return;
    Frame &f = ev.frames[frame];
    f.bindings.clear();
    if (f.indexed > 0) f.last_of.clear(), f.indexed = 0;
    --ev.frame_count;
}

// The last binding of a name in a block, call or iteration; few are quicker searched than looked up.
static std::optional<std::uint32_t> slot_in_block(Frame &f, Symbol name) {
    constexpr std::size_t few = 32;
    if (f.bindings.size() > few) {
        for (; f.indexed < f.bindings.size(); ++f.indexed)
            f.last_of[f.bindings[f.indexed].name] = static_cast<std::uint32_t>(f.indexed);
        const auto it = f.last_of.find(name);
        return it == f.last_of.end() ? std::nullopt : std::optional(it->second);
    }
    for (std::size_t i = f.bindings.size(); i-- > 0;)
        if (f.bindings[i].name == name) return static_cast<std::uint32_t>(i);
    return std::nullopt;
}

bool is_builtin(Symbol name) { return name < builtins().size(); }

static void tell_hiding(Interpreter &ev, Symbol name, Span place) {
    report(ev, Code::HidesName, place,
           fmt::format("`{0}` hides the library's `{0}` in this file", ev.symbol_names[name]));
}

void tell_hiding_functions(Interpreter &ev) {
    for (const auto &[name, place] : ev.hiding) {
        const std::string quoted = fmt::format("`{}`", ev.symbol_names[name]);
        const auto &items = ev.diagnostics.items();
        const bool named = std::ranges::any_of(items, [&](const Diagnostic &d) {
            return d.severity == Severity::Error && d.message.find(quoted) != std::string::npos;
        });
        if (named) tell_hiding(ev, name, place);
    }
}

void declare(Interpreter &ev, std::uint32_t frame, Symbol name, Value value, bool is_var,
             Span place) {
    Frame &f = ev.frames[frame];
    if (!f.index) {
        const auto slot = slot_in_block(f, name);
        if (slot && f.bindings[*slot].declared.source && place.source) {
            report(ev, Code::DuplicateName, place,
                   fmt::format("`{}` is declared twice in this block", ev.symbol_names[name]))
                .label(f.bindings[*slot].declared, "first declared here");
            return;
        }
    } else {
        auto [it, added] =
            f.index->try_emplace(name, static_cast<std::uint32_t>(f.bindings.size()));
        if (!added) {
            report(ev, Code::DuplicateName, place,
                   fmt::format("`{}` is declared twice", ev.symbol_names[name]))
                .label(f.bindings[it->second].declared, "first declared here")
                .help(is_function(value)
                          ? "forms of a function differ by the types of their parameters, all of "
                            "which are "
                            "written: `fn f(a: vec2)`; else give the other a name of its own"
                          : "give one of them another name");
            return;
        }
        if (frame != ev.prelude_frame && !ev.modules[ev.current_module].library && place.source) {
            if (is_builtin(name) || ev.prelude_items.contains(name) ||
                slot_in_module(ev, ev.prelude_frame, name)) {
                if (is_function(value)) // its author wants it: told where something is wrong
                    ev.hiding.emplace_back(name, place);
                else
                    tell_hiding(ev, name, place);
            }
        }
    }
    f.bindings.push_back({name, value, is_var, place});
}

std::optional<std::uint32_t> slot_in_module(Interpreter &ev, std::uint32_t frame, Symbol name) {
    if (frame == ev.prelude_frame && ev.prelude_items.contains(name)) read_prelude_items(ev, name);
    const auto &index = *ev.frames[frame].index;
    auto it = index.find(name);
    return it == index.end() ? std::nullopt : std::optional(it->second);
}

std::optional<Found> find_name(Interpreter &ev, std::uint32_t frame, Symbol name) {
    for (;;) {
        const auto slot = ev.frames[frame].index ? slot_in_module(ev, frame, name)
                                                 : slot_in_block(ev.frames[frame], name);
        if (slot) return Found{frame, *slot};
        if (frame == ev.prelude_frame) return std::nullopt;
        frame = ev.frames[frame].parent;
    }
}

static bool in_library(const Interpreter &ev) { return ev.modules[ev.current_module].library; }

std::optional<Value> look_up(Interpreter &ev, std::uint32_t frame, Symbol name) {
    if (auto found = find_name(ev, frame, name))
        return ev.frames[found->frame].bindings[found->slot].value;
    if (is_builtin(name) && (!builtins()[name].library_only || in_library(ev)))
        return make_value(ValueKind::Builtin, name);
    return std::nullopt;
}

std::vector<std::string> visible_names(Interpreter &ev, std::uint32_t frame) {
    std::vector<std::string> names;
    const auto see = [&](const std::string &name) {
        if (name[0] != '_' || in_library(ev)) names.push_back(name);
    };
    for (;;) {
        const Frame &f = ev.frames[frame];
        for (const Binding &b : f.bindings) see(ev.symbol_names[b.name]);
        if (f.parent == frame) break;
        frame = f.parent;
    }
    for (const Builtin &b : builtins()) see(b.name);
    for (const auto &[name, items] : ev.prelude_items) see(ev.symbol_names[name]);
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

// -- unknown names in bodies that nobody calls ---------------------------------------------------

namespace {

// Of all the forms that a function has; false where they are not known.
bool parameter_names(Interpreter &ev, const Value &f, std::vector<std::string> &out) {
    if (f.kind == ValueKind::Closure) {
        const Closure &c = ev.closures[f.id];
        for (const lang::Parameter &p : c.ast->functions[c.function].parameters)
            out.emplace_back(p.name.text);
        return true;
    }
    if (f.kind == ValueKind::Builtin) {
        for (const BuiltinParameter &p : builtins()[f.id].parameters) out.push_back(p.name);
        return true;
    }
    if (f.kind != ValueKind::Overloads) return false;
    for (const Value &form : ev.lists[f.id])
        if (!parameter_names(ev, form, out)) return false;
    return true;
}

// Walks a tree with the names that each block declares. Only names are judged: what they hold is
// known when they are used.
struct NameWalk {
    Interpreter &ev;
    const File &ast;
    std::uint32_t frame;
    std::vector<std::map<std::string_view, Span>> scopes;

    bool local(std::string_view name) const {
        for (const auto &scope : scopes)
            if (scope.count(name)) return true;
        return false;
    }
    bool known(std::string_view name) {
        if (local(name)) return true;
        return look_up(ev, frame, intern(ev, name)).has_value();
    }
    void declared(const lang::Identifier &name) {
        auto [it, fresh] = scopes.back().try_emplace(name.text, name.span);
        if (fresh || it->second == name.span) return;
        report(ev, Code::DuplicateName, name.span,
               fmt::format("`{}` is declared twice in this block", name.text))
            .label(it->second, "first declared here");
    }
    void parameters(const lang::Function &f) {
        scopes.emplace_back();
        for (const lang::Parameter &p : f.parameters) {
            if (p.type) check_type(ev, *p.type);
            if (p.default_value) expr(*p.default_value);
            declared(p.name);
        }
        if (f.result) check_type(ev, *f.result);
        block(f.body);
        scopes.pop_back();
    }
    void block(lang::BlockId id) {
        scopes.emplace_back();
        const lang::Block &b = ast.blocks[id];
        for (const lang::Stmt &s : b.stmts)
            if (auto *f = std::get_if<lang::FunctionDecl>(&s.kind))
                if (ast.functions[f->function].name) declared(*ast.functions[f->function].name);
        for (const lang::Stmt &s : b.stmts) stmt(s);
        scopes.pop_back();
    }
    void typed(const lang::TypeExpr *type) {
        if (type) check_type(ev, *type);
    }
    void stmt(const lang::Stmt &s) {
        if (auto *e = std::get_if<lang::ExprStmt>(&s.kind))
            expr(e->value);
        else if (auto *l = std::get_if<lang::Let>(&s.kind))
            typed(l->type), expr(l->value), declared(l->name);
        else if (auto *v = std::get_if<lang::Var>(&s.kind))
            typed(v->type), expr(v->value), declared(v->name);
        else if (auto *a = std::get_if<lang::Assign>(&s.kind))
            assign(*a, s.span);
        else if (auto *f = std::get_if<lang::FunctionDecl>(&s.kind))
            parameters(ast.functions[f->function]);
        else if (auto *p = std::get_if<lang::Param>(&s.kind))
            declared(p->name);
        else if (auto *i = std::get_if<lang::Import>(&s.kind)) {
            if (i->as) declared(*i->as);
        } else if (auto *loop = std::get_if<lang::For>(&s.kind)) {
            expr(loop->sequence);
            scopes.push_back({{loop->variable.text, loop->variable.span}});
            block(loop->body);
            scopes.pop_back();
        } else if (auto *w = std::get_if<lang::While>(&s.kind)) {
            expr(w->condition);
            if (w->limit) expr(*w->limit);
            block(w->body);
        } else if (auto *r = std::get_if<lang::Return>(&s.kind)) {
            if (r->value) expr(*r->value);
        }
    }
    void assign(const lang::Assign &a, Span place) {
        const lang::Expr &target = ast.exprs[a.target];
        const auto *n = std::get_if<lang::Name>(&target.kind);
        const bool fresh = n && !a.op && !known(n->text);
        if (!fresh) expr(a.target);
        expr(a.value);
        if (!fresh) return;
        if (report_undeclared(ev, n->text, target.span, place, true))
            scopes.back().try_emplace(n->text, target.span);
    }
    bool is_module(lang::ExprId id) {
        auto *n = std::get_if<lang::Name>(&ast.exprs[id].kind);
        if (!n || local(n->text)) return false;
        auto value = look_up(ev, frame, intern(ev, n->text));
        return value && value->kind == ValueKind::Module;
    }
    // The arguments that a call names, where the function is known and none that is local.
    void arguments(const lang::Call &call, std::string_view name) {
        auto value = local(name) ? std::nullopt : look_up(ev, frame, intern(ev, name));
        if (!value) return;
        std::vector<std::string> names;
        if (!parameter_names(ev, *value, names)) return;
        for (const lang::Argument &a : call.arguments) {
            if (!a.name || std::find(names.begin(), names.end(), a.name->text) != names.end())
                continue;
            Diagnostic &d = report(ev, Code::UnknownArgument, a.name->span,
                                   fmt::format("`{}` has no argument `{}`", name, a.name->text));
            const std::string near = nearest_name(a.name->text, names);
            if (chooses_rows(name, a.name->text) && &a != &call.arguments.front())
                d.help("a field is given one point, not rows of them: leave `axis` away",
                       {{{a.name->span.source, ast.exprs[(&a - 1)->value].span.end,
                          ast.exprs[a.value].span.end},
                         ""}});
            else if (!near.empty())
                d.help(fmt::format("did you mean `{}`?", near), {{a.name->span, near}});
        }
    }
    void expr(lang::ExprId id) {
        const lang::Expr &e = ast.exprs[id];
        if (auto *n = std::get_if<lang::Name>(&e.kind)) {
            if (!known(n->text))
                report_unknown_name(ev, frame, n->text, e.span, {Use::Value, nullptr, &ast});
        } else if (auto *l = std::get_if<lang::List>(&e.kind)) {
            for (lang::ExprId item : l->items) expr(item);
        } else if (auto *c = std::get_if<lang::Comprehension>(&e.kind))
            block(c->body);
        else if (auto *r = std::get_if<lang::Range>(&e.kind))
            expr(r->first), expr(r->last);
        else if (auto *u = std::get_if<lang::Unary>(&e.kind))
            expr(u->operand);
        else if (auto *b = std::get_if<lang::Binary>(&e.kind)) {
            for (const lang::Operand &operand : b->operands) expr(operand.value);
        } else if (auto *call = std::get_if<lang::Call>(&e.kind)) {
            // the `f` of `a.f(b)` is found when `a` is known
            if (auto *m = std::get_if<lang::Member>(&ast.exprs[call->callee].kind)) {
                expr(m->object);
                if (!is_module(m->object)) arguments(*call, m->name.text);
            } else {
                auto *n = std::get_if<lang::Name>(&ast.exprs[call->callee].kind);
                if (n && !known(n->text))
                    report_unknown_name(ev, frame, n->text, ast.exprs[call->callee].span,
                                        {Use::Called, nullptr, &ast});
                else
                    expr(call->callee);
                if (n) arguments(*call, n->text);
            }
            for (const lang::Argument &a : call->arguments) expr(a.value);
            if (call->trailing) block(*call->trailing);
        } else if (auto *i = std::get_if<lang::Index>(&e.kind))
            expr(i->object), expr(i->index);
        else if (auto *m = std::get_if<lang::Member>(&e.kind))
            expr(m->object);
        else if (auto *f = std::get_if<lang::Lambda>(&e.kind))
            parameters(ast.functions[f->function]);
        else if (auto *choice = std::get_if<lang::If>(&e.kind)) {
            for (const lang::IfBranch &branch : choice->branches)
                expr(branch.condition), block(branch.body);
            if (choice->otherwise) block(*choice->otherwise);
        } else if (auto *inner = std::get_if<lang::BlockExpr>(&e.kind))
            block(inner->block);
    }
};

} // namespace

// Called once the module's names all stand, so only function bodies can hold something not yet
// seen.
void check_names(Interpreter &ev, const File &ast, std::uint32_t module_frame) {
    NameWalk walk{ev, ast, module_frame, {}};
    for (const lang::Stmt &s : ast.blocks[ast.root].stmts)
        if (auto *f = std::get_if<lang::FunctionDecl>(&s.kind))
            walk.parameters(ast.functions[f->function]);
}

} // namespace fathom::typecheck
