#include "base/limits.h"

#include "base/suggest.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace fathom {

namespace {

constexpr LimitRow rows[] = {
#define FATHOM_LIMIT(member, name, usual, most, unit, what)                                        \
    {name, &Limits::member, usual, most, unit, what},
#include "base/limits.def"
#undef FATHOM_LIMIT
};

const LimitRow &row_of(std::size_t Limits::*member) {
    return *std::ranges::find(rows, member, &LimitRow::member);
}

} // namespace

std::span<const LimitRow> limit_rows() { return rows; }

std::string limit_note(const Limits &limits, std::size_t Limits::*member) {
    const LimitRow &row = row_of(member);
    return fmt::format("the limit `{}` is {} {}: {}", row.name, limits.*member, row.unit, row.what);
}

std::string limit_help(const Limits &limits, std::size_t Limits::*member) {
    const LimitRow &row = row_of(member);
    return fmt::format("where the scene is meant so, `--limit {}={}` allows twice as much",
                       row.name, std::min(2 * (limits.*member), row.most));
}

std::string set_limit(Limits &limits, std::string_view word) {
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals);
    std::vector<std::string> names;
    for (const LimitRow &row : rows) {
        names.push_back(row.name);
        if (name != row.name || equals == word.npos) continue;
        const auto value = parse_number(word.substr(equals + 1));
        if (!value || *value < 1 || *value > double(row.most) || *value != std::floor(*value))
            return fmt::format("{} is a whole number of {} from 1 to {}, not `{}`", name, row.unit,
                               row.most, word.substr(equals + 1));
        limits.*row.member = static_cast<std::size_t>(*value);
        return {};
    }
    if (equals == word.npos) return fmt::format("a limit is NAME=VALUE, not `{}`", word);
    const std::string near = nearest_name(name, names);
    return fmt::format("there is no limit `{}`; {}", name,
                       near.empty() ? fmt::format("there are {}", fmt::join(names, ", "))
                                    : fmt::format("did you mean `{}`?", near));
}

} // namespace fathom
