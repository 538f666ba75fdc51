// Fills the `$NAME`s of a text template, in one pass: what is filled in is not looked through
// again.
#pragma once

#include <cassert>
#include <map>
#include <string>
#include <string_view>

namespace fathom::glsl {

inline std::string fill(std::string_view form,
                        const std::map<std::string, std::string, std::less<>> &values) {
    std::string text;
    while (true) {
        const std::size_t at = form.find('$');
        text += form.substr(0, at);
        if (at == std::string_view::npos) return text;
        std::size_t end = at + 1;
        while (end < form.size() && (form[end] == '_' || (form[end] >= 'A' && form[end] <= 'Z')))
            ++end;
        const auto value = values.find(form.substr(at + 1, end - at - 1));
        assert(value != values.end());
        if (value != values.end()) text += value->second;
        form.remove_prefix(end);
    }
}

} // namespace fathom::glsl
