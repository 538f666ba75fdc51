// What one scene may cost, as one table (limits.def): a scene from a stranger is answered, whatever
// it asks for. Limits count work and bytes, never time, so that an answer is the same everywhere.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace fathom {

struct Limits {
#define FATHOM_LIMIT(member, name, usual, most, unit, what) std::size_t member = usual;
#include "base/limits.def"
#undef FATHOM_LIMIT
};

struct LimitRow {
    const char *name;
    std::size_t Limits::*member;
    std::size_t usual, most; // unless said, and the largest that may be asked for
    const char *unit, *what;
};
std::span<const LimitRow> limit_rows();

constexpr std::size_t mebibyte = std::size_t{1} << 20;

// Of a diagnostic about a limit: what it is, and how a user raises it.
std::string limit_note(const Limits &limits, std::size_t Limits::*member);
std::string limit_help(const Limits &limits, std::size_t Limits::*member);

// Sets one by a word `name=value`. What is wrong with the word, or nothing.
std::string set_limit(Limits &limits, std::string_view word);

} // namespace fathom
