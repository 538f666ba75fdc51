// What an error calls a value. Private to typecheck.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace fathom::typecheck {

// What an error calls a value: `text`, or "`name`", or "`name` of `of`". Put into words only when
// one is reported; views what the caller holds.
struct What {
    std::string_view text, name, of;
    What(const char *words) : text(words) {}
    What(const std::string &words) : text(words) {}
    What(std::string_view name, std::string_view of) : name(name), of(of) {}
};
inline constexpr const char *which_shapes = "a condition that decides which shapes there are";
inline What quoted(std::string_view name, std::string_view of = {}) { return {name, of}; }

} // namespace fathom::typecheck

template <> struct fmt::formatter<fathom::typecheck::What> : fmt::formatter<std::string_view> {
    template <typename Context>
    auto format(const fathom::typecheck::What &what, Context &context) const {
        if (!what.text.empty()) return fmt::format_to(context.out(), "{}", what.text);
        if (what.of.empty()) return fmt::format_to(context.out(), "`{}`", what.name);
        return fmt::format_to(context.out(), "`{}` of `{}`", what.name, what.of);
    }
};
