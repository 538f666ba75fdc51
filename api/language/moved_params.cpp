// What a slider or a wheel over a number changes of a text: nothing but params' values.
#include "api/language/syntax.h"

#include "api/impl.h"

#include <fathom/language.h>

#include <map>

namespace fathom::language {
namespace {

// The values of params that are written as one number, by where that stands.
std::map<std::uint32_t, std::pair<std::string, double>> numbers_of_params(const lang::Ast &ast) {
    std::map<std::uint32_t, std::pair<std::string, double>> all;
    for (const lang::Stmt &stmt : ast.blocks[ast.root].stmts)
        if (const auto *param = std::get_if<lang::Param>(&stmt.kind)) {
            const lang::Expr &value = ast.exprs[param->value];
            if (const auto *number = std::get_if<lang::Number>(&value.kind))
                all[value.span.begin] = {std::string(param->name.text), number->value};
        }
    return all;
}

std::vector<std::pair<std::string, double>> moved_params(const std::string &before,
                                                         const std::string &after) {
    const Syntax was = read_syntax(before), is = read_syntax(after);
    std::vector<std::pair<std::string, double>> moved;
    const std::vector<lang::Token> &old = was.words.tokens, &now = is.words.tokens;
    if (!was.whole || !is.whole || old.size() != now.size()) return moved;
    const auto old_numbers = numbers_of_params(was.ast), numbers = numbers_of_params(is.ast);
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (was.text().substr(old[i].begin, old[i].end - old[i].begin) ==
            is.text().substr(now[i].begin, now[i].end - now[i].begin))
            continue;
        const auto number = numbers.find(now[i].begin);
        if (number == numbers.end() || !old_numbers.contains(old[i].begin)) return {};
        moved.push_back(number->second);
    }
    return moved;
}

} // namespace
} // namespace fathom::language

namespace fathom::v1 {

std::vector<std::pair<std::string, double>> moved_params(std::string_view before,
                                                         std::string_view after) {
    using Moved = std::vector<std::pair<std::string, double>>;
    return guarded([&] { return language::moved_params(std::string(before), std::string(after)); },
                   [](const Diagnostic &) { return Moved(); });
}

} // namespace fathom::v1
