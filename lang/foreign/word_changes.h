// What the passes share that read words of other languages as ours before layout: the words as they
// were, those that take their place, and what is said of them. Internal to this folder.
#pragma once

#include "lang/foreign/foreign.h"
#include "lang/token.h"

#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace fathom::lang {

class WordChanges {
  public:
    WordChanges(const Source &source, SourceId id, const std::vector<Token> &words,
                Diagnostics &diagnostics)
        : source_(source), id_(id), words_(words), diagnostics_(diagnostics) {}

  protected:
    Tok kind(std::size_t i) const { return i < words_.size() ? words_[i].kind : Tok::End; }
    Tok before(std::size_t i) const { return i > 0 ? kind(i - 1) : Tok::End; }
    std::string_view text(std::size_t i) const {
        return i < words_.size() ? text_of(source_, words_[i]) : std::string_view();
    }
    std::string text(std::uint32_t begin, std::uint32_t end) const {
        return source_.text.substr(begin, end - begin);
    }
    Span span(std::uint32_t begin, std::uint32_t end) const { return {id_, begin, end}; }
    Span words(std::size_t first, std::size_t last) const {
        return {id_, words_[first].begin, words_[last].end};
    }
    bool is(std::size_t i, std::string_view word) const {
        return kind(i) == Tok::Name && text(i) == word;
    }
    bool touch(std::size_t first, std::size_t second) const {
        return second < words_.size() && words_[first].end == words_[second].begin;
    }
    bool fresh(std::size_t i) const {
        return i == 0 || (i < words_.size() && words_[i].first_on_line) || before(i) == Tok::End ||
               before(i) == Tok::Body || before(i) == Tok::BraceClose;
    }

    // The bracket that closes the one at `i`, counting those of its kind; 0 where there is none.
    std::size_t close_of(std::size_t i, std::size_t most_words) const {
        const Tok open = kind(i), close = open == Tok::Open       ? Tok::Close
                                          : open == Tok::ListOpen ? Tok::ListClose
                                                                  : Tok::BraceClose;
        int depth = 0;
        for (std::size_t k = i; k < words_.size() && k < i + most_words; ++k) {
            if (kind(k) == open) ++depth;
            if (kind(k) == close && --depth == 0) return k;
        }
        return 0;
    }

    // Whether the file has such a name of its own, or may bring one by an import.
    bool may_be_declared(std::string_view name) {
        if (!declared_) {
            declared_.emplace();
            for (std::size_t i = 0; i + 1 < words_.size(); ++i) {
                imports_ = imports_ || kind(i) == Tok::Import;
                if (is_one_of(kind(i), {Tok::Let, Tok::Var, Tok::Fn, Tok::Param}) &&
                    kind(i + 1) == Tok::Name)
                    declared_->insert(text(i + 1));
            }
        }
        return imports_ || declared_->contains(name);
    }

    void begin_change(std::size_t i) {
        if (!changed_) out_.assign(words_.begin(), words_.begin() + std::ptrdiff_t(i));
        changed_ = true;
    }
    void put(Tok kind, std::uint32_t begin, std::uint32_t end, bool first_on_line = false) {
        out_.push_back({kind, first_on_line, begin, end});
    }

    const Source &source_;
    SourceId id_;
    const std::vector<Token> &words_;
    Diagnostics &diagnostics_;
    std::vector<Token> out_;
    bool changed_ = false;

  private:
    std::optional<std::unordered_set<std::string_view>> declared_; // made when first needed
    bool imports_ = false;
};

} // namespace fathom::lang
