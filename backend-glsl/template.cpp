// See template.h.
#include "backend-glsl/template.h"

#include <cassert>
#include <utility>

namespace fathom::glsl {

// Made from the files by cmake/embed.cmake.
const std::vector<std::pair<std::string_view, std::string_view>> &embedded_templates();

namespace {

std::string_view text_of(std::string_view name) {
    for (const auto &[file, text] : embedded_templates())
        if (file.substr(0, file.find('.')) == name) return text;
    assert(!"a template that is not there");
    return "";
}

const std::string &value_of(const Values &values, std::string_view name) {
    const auto value = values.find(name);
    assert(value != values.end());
    return value->second;
}

// What follows the directive's word, where the line is that directive.
bool directive(std::string_view line, std::string_view word, std::string_view &rest) {
    if (!line.starts_with(word)) return false;
    rest = line.substr(word.size());
    return true;
}

// How long the hole is that the text begins with; 0: there is none.
std::size_t hole(std::string_view text) {
    if (!text.starts_with('$')) return 0;
    std::size_t end = 1;
    while (end < text.size() && (text[end] == '_' || (text[end] >= 'A' && text[end] <= 'Z'))) ++end;
    return end;
}

void expand_into(std::string_view name, const Values &values, std::string &out) {
    std::vector<bool> taken; // of the $if around this line, outermost first
    std::string_view text = text_of(name), rest;
    const auto on = [&] {
        for (bool each : taken)
            if (!each) return false;
        return true;
    };
    while (!text.empty()) {
        const std::size_t end = text.find('\n') + 1;
        const std::string_view line = text.substr(0, end), words = line.substr(0, end - 1);
        text.remove_prefix(end);
        if (directive(words, "$# ", rest)) continue;
        if (directive(words, "$if !", rest)) {
            taken.push_back(value_of(values, rest).empty());
        } else if (directive(words, "$if ", rest)) {
            taken.push_back(!value_of(values, rest).empty());
        } else if (words == "$else") {
            taken.back() = !taken.back();
        } else if (words == "$end") {
            taken.pop_back();
        } else if (!on()) {
            continue;
        } else if (directive(words, "$include ", rest)) {
            expand_into(rest, values, out);
        } else if (!words.empty() && hole(words) == words.size()) {
            const std::string &lines = value_of(values, words.substr(1));
            assert(lines.empty() || lines.back() == '\n');
            out += lines;
        } else {
            out += fill(line, values);
        }
    }
    assert(taken.empty());
}

} // namespace

std::string fill(std::string_view form, const Values &values) {
    std::string out;
    while (true) {
        const std::size_t at = form.find('$');
        out += form.substr(0, at);
        if (at == form.npos) return out;
        form.remove_prefix(at);
        const std::size_t end = hole(form);
        out += value_of(values, form.substr(1, end - 1));
        form.remove_prefix(end);
    }
}

std::string expand(std::string_view name, const Values &values) {
    std::string out;
    expand_into(name, values, out);
    return out;
}

std::vector<std::string_view> template_names() {
    std::vector<std::string_view> names;
    for (const auto &[file, text] : embedded_templates())
        if (file.ends_with(".glsl")) names.push_back(file.substr(0, file.find('.')));
    return names;
}

} // namespace fathom::glsl
