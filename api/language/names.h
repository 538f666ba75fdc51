// Which declaration each name of a text stands for, by its blocks alone: the frames of the checker
// (typecheck/names.cpp) without their values. A name that no block of the text declares is an
// imported file's or the library's.
#pragma once

#include "api/language/syntax.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fathom::language {

enum class DeclaredBy { Let, Var, Function, Param, Parameter, Loop, Import };

struct Declaration {
    std::string name;
    Span at;        // the name
    Span statement; // what declares it; of a parameter its function
    DeclaredBy by = DeclaredBy::Let;
    bool top_level = false;
    lang::FunctionId function; // what it is called as: of `fn`, and of `let f = x => …`
    lang::ExprId value;        // of `let` and `var`
    std::string path;          // of an import
};

enum class UsedAs { Value, Callee, Method, Member, Target, Argument };

struct Use {
    std::string name;
    Span at;
    UsedAs as = UsedAs::Value;
    std::optional<std::size_t> declaration;
    std::optional<std::size_t> module; // the import whose member it is
    std::optional<std::size_t> callee; // of an argument's name: the use that names what is called
    // A nearer block declares the name below the function that the use stands in: which one is meant
    // depends on when that is called.
    bool doubtful = false;
};

struct Names {
    std::vector<Declaration> declarations;
    std::vector<Use> uses;                 // by place
    std::vector<Span> types;               // names of types
    std::vector<Span> components;          // `x` of `v.x`
    std::vector<std::size_t> open_imports; // declarations without a name: `import "file"`
    std::map<std::pair<std::uint32_t, std::string>, std::size_t> parameters; // by function and name

    const Use *use_at(std::size_t offset) const; // that holds or touches a byte
    std::optional<std::size_t> declaration_at(std::size_t offset) const; // by its own name
    std::optional<std::size_t> meant_at(std::size_t offset) const;       // by its name or a use
};
Names names_of(const lang::Ast &ast);

} // namespace fathom::language
