// WGSL's marks: `@group(0) @binding(0) var<uniform> u: Uniforms;`, `@fragment fn main(…) { … }`.
#include "lang/foreign/foreign.h"
#include "lang/lexer.h"

#include <array>

namespace fathom::lang {

namespace {

constexpr std::size_t most_bound = 40; // of what is bound, in one edit

// Behind the brace that closes the first one from `at` on; 0 where there is none.
std::size_t behind_block(std::string_view text, std::size_t at) {
    int depth = 0;
    for (; at < text.size(); ++at) {
        depth += text[at] == '{' ? 1 : text[at] == '}' ? -1 : 0;
        if (text[at] == '}' && depth <= 0) return at + 1;
    }
    return 0;
}

} // namespace

// At `@`: what it marks is left away as a whole, and the parts of what is bound are names of their
// own. False where it is another mark.
bool ForeignWords::mark_of_wgsl(std::uint32_t begin, std::uint32_t end) {
    if (begin < marked_until_) return true; // told with the first one
    if (!may_look_far()) return false;
    const std::string_view all = source_.text, mark = all.substr(begin, end - begin);
    constexpr std::array<std::string_view, 3> stages = {"@fragment", "@vertex", "@compute"};
    if (is_one_of(mark, stages)) {
        const std::size_t behind = behind_block(all, end);
        if (behind == 0) return false;
        marked_until_ = static_cast<std::uint32_t>(behind);
        diagnostics_
            .add(Code::ForeignSyntax, span(begin, end),
                 "a scene has no stages of a shader: it says what there is alone")
            .help("leave the function away", {{span(begin, marked_until_), ""}});
        return true;
    }
    if (mark != "@group" && mark != "@binding") return false;
    const std::size_t stop = all.find(';', end), var = all.find("var", end);
    const std::size_t colon = all.find(':', var);
    if (stop == std::string_view::npos || colon > stop) return false;
    std::size_t last = colon;
    while (last > var && all[last - 1] == ' ') --last;
    std::size_t first = last;
    while (first > var && is_word_char(all[first - 1])) --first;
    const std::string bound(all.substr(first, last - first));
    marked_until_ = static_cast<std::uint32_t>(stop + 1);
    std::vector<Edit> edits{{span(begin, marked_until_), ""}};
    for (std::size_t at = all.find(bound + ".", stop);
         !bound.empty() && at != std::string_view::npos && edits.size() < most_bound;
         at = all.find(bound + ".", at + 1)) {
        if (is_word_char(all[at - 1]) || all[at - 1] == '.') continue;
        const std::size_t part = at + bound.size() + 1;
        std::size_t past = part;
        while (past < all.size() && is_word_char(all[past])) ++past;
        const std::string name(all.substr(part, past - part));
        edits.push_back({span(static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(past)),
                         is_clock(name) ? "time" : name});
    }
    diagnostics_
        .add(Code::ForeignSyntax, span(begin, end),
             "nothing is bound from outside: what a slider sets is a `param`")
        .help("leave the line away, and name its parts alone", std::move(edits));
    return true;
}

} // namespace fathom::lang
