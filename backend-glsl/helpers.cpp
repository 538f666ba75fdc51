// See helpers.h. The texts are line-by-line ports; the formulas are explained where they are
// defined, in ir/.
#include "backend-glsl/helpers.h"

#include "backend-glsl/template.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace fathom::glsl {

// Made from the files by cmake/embed.cmake.
const std::vector<std::pair<std::string_view, std::string_view>> &embedded_helpers();

namespace {

struct Helper {
    std::vector<HelperKey> needs;
    std::string text;
};

using Library = std::map<HelperKey, Helper>; // by name and form

// The first word of the text, which is taken off it.
std::string_view next_word(std::string_view &text) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return word;
}

// NAME:FORM, or NAME.
HelperKey key_of(std::string_view word) {
    const std::size_t colon = std::min(word.find(':'), word.size());
    return {std::string(word.substr(0, colon)),
            std::string(word.substr(std::min(colon + 1, word.size())))};
}

// Blank lines before an entry are the file's, not the entry's.
void read_helpers(std::string_view file, Library &library) {
    Helper *helper = nullptr;
    std::string blanks;
    while (!file.empty()) {
        const std::size_t end = file.find('\n') + 1;
        std::string_view words = file.substr(0, end - 1);
        const std::string_view line = file.substr(0, end);
        file.remove_prefix(end);
        if (line.starts_with("$helper ")) {
            next_word(words);
            const auto [entry, fresh] =
                library.try_emplace(key_of(next_word(words)), Helper{{}, "\n"});
            assert(fresh);
            helper = &entry->second;
            blanks.clear();
            [[maybe_unused]] const std::string_view needs = next_word(words);
            assert(needs.empty() || needs == "needs");
            while (!words.empty()) helper->needs.push_back(key_of(next_word(words)));
        } else if (words.empty()) {
            blanks += line;
        } else if (!line.starts_with("$# ")) {
            assert(helper);
            if (helper->text.size() > 1) helper->text += blanks;
            helper->text += line;
            blanks.clear();
        }
    }
}

const Library &library() {
    static const Library all = [] {
        Library made;
        for (const auto &[name, text] : embedded_helpers()) read_helpers(text, made);
        return made;
    }();
    return all;
}

// A function of floats, called for each component.
std::string lifted(const std::string &scalar_text, const std::string &name,
                   const std::string &type) {
    const std::size_t arguments = 1 + static_cast<std::size_t>(std::ranges::count(
                                          scalar_text.substr(0, scalar_text.find(')')), ','));
    const std::array<std::string, 3> letters{"a", "b", "c"};
    std::string parameters, calls;
    for (std::size_t i = 0; i < arguments; ++i)
        parameters += (i ? ", " : "") + type + " " + letters[i];
    for (char c : std::string("xyzw").substr(0, static_cast<std::size_t>(type.back() - '0'))) {
        std::string inner;
        for (std::size_t i = 0; i < arguments; ++i) inner += (i ? ", " : "") + letters[i] + "." + c;
        calls += (calls.empty() ? "" : ", ") + name + "(" + inner + ")";
    }
    return "\n" + type + " " + name + "(" + parameters + ") {\n    return " + type + "(" + calls +
           ");\n}\n";
}

class Printer {
  public:
    void need(const HelperKey &key) {
        if (!done_.insert(key).second) return;
        const auto &[name, type] = key;
        for (const std::string &form :
             {type, std::string(), std::string("T"), std::string("each")}) {
            const auto found = library().find({name, form});
            if (found == library().end()) continue;
            const Helper &helper = found->second;
            for (const HelperKey &other : helper.needs) need(other);
            if (form == "each" && type != "float") {
                need({name, "float"});
                text_ += lifted(helper.text, name, type);
            } else {
                text_ += fill(helper.text, {{"T", type}});
            }
            return;
        }
        assert(!"a helper that nobody wrote");
    }
    std::string take() { return std::move(text_); }

  private:
    std::set<HelperKey> done_;
    std::string text_;
};

} // namespace

std::string helper_text(const std::set<HelperKey> &wanted) {
    Printer printer;
    for (const HelperKey &key : wanted) printer.need(key);
    return printer.take();
}

std::vector<HelperKey> helper_forms() {
    std::vector<HelperKey> forms;
    for (const auto &[key, helper] : library()) forms.push_back(key);
    return forms;
}

} // namespace fathom::glsl
