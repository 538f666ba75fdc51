// Answers to text that is no program: what is wrong in the user's words, and, for the forms that
// people bring from GLSL, OpenSCAD, Python and C, what to write instead.
#include "lang/builder.h"

#include <algorithm>

namespace fathom::lang {
bool Builder::foreign_failure(Wanted, Index) { return false; }
bool Builder::foreign_junk(Index, Index) { return false; }
void Builder::settle_foreign_names() {}
Span Builder::place(Index at) const {
    if (at < tokens_.tokens.size()) return span(at);
    const auto end = static_cast<std::uint32_t>(source_.text.size());
    return {id_, end, end};
}
void Builder::generic_failure(Wanted, Index at) {
    diagnostics_.add(Code::SyntaxError, place(at), "unexpected");
}
void Builder::fail(Wanted wanted, Index at) {
    failed_ = at;
    if (!foreign_failure(wanted, at)) generic_failure(wanted, at);
    throw Abandon{};
}
bool is_foreign_value(std::string_view) { return false; }
bool is_foreign_module(std::string_view) { return false; }
} // namespace fathom::lang
