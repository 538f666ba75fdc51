#include "api/language/names.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

namespace fathom::language {
namespace {

bool is_components(std::string_view name) {
    return name.size() <= 4 && (name.find_first_not_of("xyzw") == name.npos ||
                                name.find_first_not_of("rgba") == name.npos);
}

struct Walk {
    struct Entry {
        std::size_t declaration;
        bool visible;
    };
    struct Scope {
        std::unordered_map<std::string_view, Entry> names; // texts of the tree
        bool function = false;                             // what is below runs when it is called
    };

    const lang::Ast &ast;
    Names out;
    std::vector<Scope> scopes;

    std::size_t declare(const lang::Identifier &name, Declaration declaration, bool visible) {
        declaration.name = name.text;
        declaration.at = name.span;
        declaration.top_level = scopes.size() == 1;
        out.declarations.push_back(std::move(declaration));
        const std::size_t index = out.declarations.size() - 1;
        scopes.back().names.try_emplace(name.text, Entry{index, visible});
        return index;
    }
    void show(std::string_view name) {
        const auto found = scopes.back().names.find(name);
        if (found != scopes.back().names.end()) found->second.visible = true;
    }

    void resolve(Use &use) const {
        bool deferred = false;
        std::optional<std::size_t> later;
        for (std::size_t i = scopes.size(); i-- > 0; deferred |= scopes[i].function) {
            const auto found = scopes[i].names.find(use.name);
            if (found == scopes[i].names.end()) continue;
            if (found->second.visible) {
                use.declaration = found->second.declaration;
                use.doubtful = later.has_value();
                return;
            }
            if (deferred && !later) later = found->second.declaration;
        }
        use.declaration = later;
    }
    std::size_t use(std::string_view name, Span at, UsedAs as) {
        Use made{std::string(name), at, as, {}, {}, {}, false};
        resolve(made);
        out.uses.push_back(std::move(made));
        return out.uses.size() - 1;
    }

    void type(const lang::TypeExpr &type) {
        if (type.kind == lang::TypeExpr::Kind::Name) {
            const auto length = static_cast<std::uint32_t>(type.name.size());
            out.types.push_back({type.span.source, type.span.begin, type.span.begin + length});
        }
        for (const lang::TypeExpr &item : type.items) this->type(item);
    }
    void type(const lang::TypeExpr *given) {
        if (given) type(*given);
    }

    void function(lang::FunctionId id) {
        const lang::Function &function = ast.functions[id];
        scopes.push_back({{}, true});
        for (const lang::Parameter &parameter : function.parameters) {
            type(parameter.type);
            if (parameter.default_value) expr(*parameter.default_value);
            const std::size_t index =
                declare(parameter.name,
                        {"", {}, function.span, DeclaredBy::Parameter, false, {}, {}, ""}, true);
            out.parameters.try_emplace({id.index, std::string(parameter.name.text)}, index);
        }
        type(function.result);
        block(function.body);
        scopes.pop_back();
    }

    lang::FunctionId called_as(lang::ExprId value) const {
        const auto *lambda = std::get_if<lang::Lambda>(&ast.exprs[value].kind);
        return lambda ? lambda->function : lang::FunctionId{};
    }

    // All that a block declares, so that functions see it; what is no function is shown by and by.
    void declare_all(const lang::Block &block) {
        for (const lang::Stmt &stmt : block.stmts) {
            if (auto *f = std::get_if<lang::FunctionDecl>(&stmt.kind)) {
                if (const auto &name = ast.functions[f->function].name)
                    declare(*name,
                            {"", {}, stmt.span, DeclaredBy::Function, false, f->function, {}, ""},
                            true);
            } else if (auto *let = std::get_if<lang::Let>(&stmt.kind))
                declare(let->name,
                        {"",
                         {},
                         stmt.span,
                         DeclaredBy::Let,
                         false,
                         called_as(let->value),
                         let->value,
                         ""},
                        false);
            else if (auto *var = std::get_if<lang::Var>(&stmt.kind))
                declare(var->name,
                        {"",
                         {},
                         stmt.span,
                         DeclaredBy::Var,
                         false,
                         called_as(var->value),
                         var->value,
                         ""},
                        false);
            else if (auto *param = std::get_if<lang::Param>(&stmt.kind))
                declare(param->name, {"", {}, stmt.span, DeclaredBy::Param, false, {}, {}, ""},
                        false);
            else if (auto *import = std::get_if<lang::Import>(&stmt.kind)) {
                Declaration declaration{"",    {}, stmt.span, DeclaredBy::Import,
                                        false, {}, {},        std::string(import->path)};
                if (import->as)
                    declare(*import->as, declaration, false);
                else {
                    declaration.at = import->path_span;
                    out.open_imports.push_back(out.declarations.size());
                    out.declarations.push_back(declaration);
                }
            }
        }
    }

    void block(lang::BlockId id) {
        scopes.push_back({});
        declare_all(ast.blocks[id]);
        for (const lang::Stmt &statement : ast.blocks[id].stmts) stmt(statement);
        scopes.pop_back();
    }

    void stmt(const lang::Stmt &stmt) {
        if (auto *f = std::get_if<lang::For>(&stmt.kind)) {
            expr(f->sequence);
            scopes.push_back({});
            declare(f->variable, {"", {}, stmt.span, DeclaredBy::Loop, false, {}, {}, ""}, true);
            block(f->body);
            scopes.pop_back();
            return;
        }
        if (auto *a = std::get_if<lang::Assign>(&stmt.kind)) {
            target(a->target);
            expr(a->value);
            return;
        }
        if (auto *let = std::get_if<lang::Let>(&stmt.kind)) type(let->type);
        if (auto *var = std::get_if<lang::Var>(&stmt.kind)) type(var->type);
        if (auto *param = std::get_if<lang::Param>(&stmt.kind)) type(param->type);
        all(inside(stmt));
        if (auto *let = std::get_if<lang::Let>(&stmt.kind)) show(let->name.text);
        if (auto *var = std::get_if<lang::Var>(&stmt.kind)) show(var->name.text);
        if (auto *param = std::get_if<lang::Param>(&stmt.kind)) show(param->name.text);
        if (auto *import = std::get_if<lang::Import>(&stmt.kind))
            if (import->as) show(import->as->text);
    }

    void all(const Inside &in) {
        for (lang::ExprId id : in.exprs) expr(id);
        for (lang::FunctionId id : in.functions) function(id);
        for (lang::BlockId id : in.blocks) block(id);
    }

    // What an assignment changes: the name at its beginning, and indices.
    void target(lang::ExprId id) {
        const lang::Expr &target = ast.exprs[id];
        if (auto *name = std::get_if<lang::Name>(&target.kind))
            use(name->text, target.span, UsedAs::Target);
        else if (auto *member = std::get_if<lang::Member>(&target.kind)) {
            this->target(member->object);
            out.components.push_back(member->name.span);
        } else if (auto *index = std::get_if<lang::Index>(&target.kind)) {
            this->target(index->object);
            expr(index->index);
        } else
            expr(id);
    }

    // The use that names the member, where it is a name of the text's: a module's, or a function.
    std::optional<std::size_t> member(const lang::Member &member, bool called) {
        expr(member.object);
        if (std::holds_alternative<lang::Name>(ast.exprs[member.object].kind) &&
            out.uses.back().declaration) {
            const std::size_t object = *out.uses.back().declaration;
            if (out.declarations[object].by == DeclaredBy::Import) {
                out.uses.push_back({std::string(member.name.text),
                                    member.name.span,
                                    UsedAs::Member,
                                    {},
                                    object,
                                    {},
                                    false});
                return out.uses.size() - 1;
            }
        }
        if (!called && is_components(member.name.text)) {
            out.components.push_back(member.name.span);
            return std::nullopt;
        }
        return use(member.name.text, member.name.span, UsedAs::Method);
    }

    void expr(lang::ExprId id) {
        const lang::Expr &e = ast.exprs[id];
        if (auto *name = std::get_if<lang::Name>(&e.kind)) {
            use(name->text, e.span, UsedAs::Value);
            return;
        }
        if (auto *m = std::get_if<lang::Member>(&e.kind)) {
            member(*m, false);
            return;
        }
        const auto *call = std::get_if<lang::Call>(&e.kind);
        if (!call) return all(inside(e));
        std::optional<std::size_t> callee;
        const lang::ExprKind &called = ast.exprs[call->callee].kind;
        if (auto *m = std::get_if<lang::Member>(&called))
            callee = member(*m, true);
        else if (auto *name = std::get_if<lang::Name>(&called))
            callee = use(name->text, ast.exprs[call->callee].span, UsedAs::Callee);
        else
            expr(call->callee);
        for (const lang::Argument &argument : call->arguments) {
            if (argument.name)
                out.uses.push_back({std::string(argument.name->text),
                                    argument.name->span,
                                    UsedAs::Argument,
                                    {},
                                    {},
                                    callee,
                                    false});
            expr(argument.value);
        }
        if (call->trailing) block(*call->trailing);
    }
};

template <class Item> bool touches(const Item &item, std::size_t offset) {
    return item.at.begin <= offset && offset <= item.at.end;
}

} // namespace

Names names_of(const lang::Ast &ast) {
    Walk walk{ast, {}, {}};
    walk.out.uses.reserve(ast.exprs.size());
    walk.block(ast.root);
    Names names = std::move(walk.out);
    for (Use &use : names.uses) {
        if (use.as != UsedAs::Argument || !use.callee) continue;
        const Use &callee = names.uses[*use.callee];
        if (!callee.declaration) continue;
        const lang::FunctionId function = names.declarations[*callee.declaration].function;
        const auto found = names.parameters.find({function.index, use.name});
        if (function && found != names.parameters.end()) use.declaration = found->second;
    }
    return names;
}

const Use *Names::use_at(std::size_t offset) const {
    const auto found =
        std::ranges::find_if(uses, [&](const Use &use) { return touches(use, offset); });
    return found == uses.end() ? nullptr : &*found;
}

std::optional<std::size_t> Names::declaration_at(std::size_t offset) const {
    for (std::size_t i = 0; i < declarations.size(); ++i)
        if (touches(declarations[i], offset) &&
            std::ranges::find(open_imports, i) == open_imports.end())
            return i;
    return std::nullopt;
}

std::optional<std::size_t> Names::meant_at(std::size_t offset) const {
    if (auto declared = declaration_at(offset)) return declared;
    const Use *use = use_at(offset);
    return use ? use->declaration : std::nullopt;
}

} // namespace fathom::language
