// The words of programs of other languages.
#include "lang/foreign/program/program.h"

namespace fathom::lang::program {

namespace {

bool begins_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}
bool is_figure(char c) { return c >= '0' && c <= '9'; }

constexpr std::string_view signs[] = {
    "...", "===", "!==", "**=", "..<", "//=", "=>", "->", "==", "!=", "<=", ">=", "&&", "||", "**",
    "++",  "--",  "+=",  "-=",  "*=",  "/=",  "|=", "&=", ">>", "<<", "//", "::", "..", "?."};

struct Scanner {
    std::string_view text;
    bool python;
    std::size_t at = 0;
    std::string comment;

    bool sees(std::string_view word) const { return text.substr(at).starts_with(word); }

    // A comment or blanks; true where there were any.
    bool skip(bool &first, std::size_t &line) {
        const char c = text[at];
        if (c == '\n') {
            first = true;
            line = ++at;
            return true;
        }
        if (c == ' ' || c == '\t' || c == '\r') return ++at, true;
        if (c == '\\' && at + 1 < text.size() && text[at + 1] == '\n') return at += 2, true;
        if (python ? c == '#' : sees("//")) {
            const std::size_t begin = at + (python ? 1 : 2);
            at = std::min(text.find('\n', at), text.size());
            std::string_view said = text.substr(begin, at - begin);
            while (!said.empty() && (said.back() == '\r' || said.back() == ' '))
                said.remove_suffix(1);
            while (!said.empty() && said.front() == ' ') said.remove_prefix(1);
            if (!said.starts_with("!")) comment += "// " + std::string(said) + "\n";
            return true;
        }
        if (!python && sees("/*")) {
            const std::size_t end = text.find("*/", at);
            if (end == std::string_view::npos) throw Unsure{};
            comment += std::string(text.substr(at, end + 2 - at)) + "\n";
            at = end + 2;
            return true;
        }
        return false;
    }

    std::size_t number_end() const {
        std::size_t i = at;
        if (sees("0x")) {
            for (i += 2; i < text.size() && std::isxdigit(static_cast<unsigned char>(text[i]));)
                ++i;
            return i;
        }
        while (i < text.size() && is_figure(text[i])) ++i;
        if (i < text.size() && text[i] == '.' && text.substr(i, 2) != "..") {
            ++i;
            while (i < text.size() && is_figure(text[i])) ++i;
        }
        if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
            std::size_t j = i + 1;
            if (j < text.size() && (text[j] == '-' || text[j] == '+')) ++j;
            if (j < text.size() && is_figure(text[j]))
                for (i = j; i < text.size() && is_figure(text[i]);) ++i;
        }
        return i;
    }

    std::size_t string_end(char quote) const {
        std::size_t i = at + 1;
        while (i < text.size() && text[i] != quote)
            if (text[i] == '\\' || text[i] == '\n')
                throw Unsure{};
            else
                ++i;
        if (i == text.size()) throw Unsure{};
        return i + 1;
    }
};

} // namespace

std::vector<Piece> read_pieces(std::string_view text, bool python) {
    constexpr std::size_t most = 20000;
    Scanner in{text, python, 0, {}};
    std::vector<Piece> out;
    bool first = true;
    std::size_t line = 0;
    while (in.at < text.size()) {
        const std::size_t before = in.at;
        if (in.skip(first, line)) continue;
        if (out.size() == most) throw Unsure{};
        Piece p;
        p.begin = static_cast<std::uint32_t>(before);
        p.column = static_cast<std::uint32_t>(before - line);
        p.first = first;
        p.spaced = before == 0 || text[before - 1] == ' ' || text[before - 1] == '\n' ||
                   text[before - 1] == '\t';
        p.comment = std::move(in.comment);
        in.comment.clear();
        first = false;
        const char c = text[before];
        std::size_t end = before + 1;
        if (begins_name(c)) {
            p.kind = Word::Name;
            while (end < text.size() && (begins_name(text[end]) || is_figure(text[end]))) ++end;
        } else if (is_figure(c) || (c == '.' && end < text.size() && is_figure(text[end]))) {
            p.kind = Word::Number;
            end = in.number_end();
        } else if (c == '"' || c == '\'') {
            if (in.sees("\"\"\"") || in.sees("'''")) { // a comment of Python
                end = text.find(text.substr(before, 3), before + 3);
                if (!python || end == std::string_view::npos || !p.first) throw Unsure{};
                in.at = end + 3;
                first = true;
                continue;
            }
            p.kind = Word::Text;
            end = in.string_end(c);
        } else {
            if (static_cast<unsigned char>(c) >= 0x80) throw Unsure{};
            p.kind = Word::Sign;
            for (const std::string_view sign : signs)
                if (in.sees(sign)) {
                    end = before + sign.size();
                    break;
                }
        }
        p.text = std::string(text.substr(before, end - before));
        in.at = end;
        out.push_back(std::move(p));
    }
    Piece last;
    last.first = true;
    last.comment = std::move(in.comment);
    last.begin = static_cast<std::uint32_t>(text.size());
    out.push_back(std::move(last));
    return out;
}

} // namespace fathom::lang::program
