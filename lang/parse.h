// Text to tree: the grammar of language.md with the decisions of semantics.md 1 to 8.
// Knows nothing of types or other files. PEGTL is seen in parse.cpp alone.
#pragma once

#include "base/diagnostic.h"
#include "base/limits.h"
#include "lang/ast.h"
#include "lang/token.h"

namespace fathom::lang {

constexpr std::size_t bytes_of_a_word = 128; // what the tree takes, about
constexpr std::size_t usual_words = Limits{}.memory * mebibyte / 2 / bytes_of_a_word;

// Some whole statements of the text, as if they were all of it; places are those in the text. Never
// fails: what cannot be read is reported and becomes Poison or Bad, and reading goes on at the next
// statement. Time and memory are linear in the text; a text of more than `most_words` is refused at
// that word. `words`, where given, gets the text's words, with the comments.
Ast parse_part(const Sources &sources, SourceId source, std::uint32_t begin, std::uint32_t end,
               Diagnostics &diagnostics, std::size_t most_words = usual_words,
               Words *words = nullptr);

// All of the text, likewise.
inline Ast parse(const Sources &sources, SourceId source, Diagnostics &diagnostics,
                 std::size_t most_words = usual_words, Words *words = nullptr) {
    return parse_part(sources, source, 0, static_cast<std::uint32_t>(sources[source].text.size()),
                      diagnostics, most_words, words);
}

} // namespace fathom::lang
