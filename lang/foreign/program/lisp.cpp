// Bauble and libfive as a tree: forms in parentheses, Bauble's pipe, and names with hyphens.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fathom::lang::program {

namespace {

class LispReader {
  public:
    explicit LispReader(std::string_view text) : text_(text) {
        constexpr std::array<std::string_view, 4> schemes{"(define", "(lambda", "(use-modules",
                                                          "#["};
        scheme_ = std::ranges::any_of(schemes, [&](std::string_view word) {
            return text.find(word) != std::string_view::npos;
        });
    }

    std::vector<TopForm> all() {
        std::vector<TopForm> out;
        while (skip()) {
            if (text_[at_] != '(') throw Unsure{};
            Node read = form();
            remark_behind();
            out.push_back({std::move(read), std::exchange(comment_, {})});
        }
        if (!comment_.empty()) out.push_back({node(Is::List, "("), std::move(comment_)});
        return out;
    }

  private:
    bool skip() { // blanks and comments; false at the end
        while (at_ < text_.size()) {
            const char c = text_[at_];
            const bool vector = c == '#' && at_ + 1 < text_.size() && text_[at_ + 1] == '[';
            if (vector) // Scheme's `#[1 2 3]`
                ++at_;
            else if ((c == ';' && !splices()) || c == '#')
                remark();
            else if (c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ',')
                ++at_;
            else
                return true;
        }
        return false;
    }

    // Janet's `;(list)`, and `;list)`, is what the list holds; a comment in Scheme.
    bool splices() const {
        if (scheme_ || depth_ == 0 || at_ + 1 >= text_.size()) return false;
        if (text_[at_ + 1] == '(' || text_[at_ + 1] == '[') return true;
        const std::size_t end = std::min(text_.find_first_of(" \n()[]|;", at_ + 1), text_.size());
        return end > at_ + 1 && end < text_.size() && text_[end] == ')';
    }

    // The comment at hand, as a line of ours.
    void remark() {
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        std::string_view said = text_.substr(at_, end - at_);
        said.remove_prefix(std::min(said.find_first_not_of(";# \t"), said.size()));
        said = said.substr(0, said.find_last_not_of(" \t\r") + 1);
        if (!said.empty()) comment_ += "// " + std::string(said) + "\n";
        at_ = end;
    }
    // A comment behind a form, on its last line, is of that form.
    void remark_behind() {
        const std::size_t next = text_.find_first_not_of(" \t", at_);
        if (next == text_.npos || (text_[next] != ';' && text_[next] != '#')) return;
        at_ = next;
        remark();
    }

    Node form() {
        constexpr int deepest = 60, most = 5000, most_pipes = 300;
        if (++depth_ > deepest || ++count_ > most) throw Unsure{};
        const char close = text_[at_++] == '(' ? ')' : ']';
        Node out = node(Is::List, close == ')' ? "(" : "[");
        bool piped = false;
        Node before;
        while (true) {
            if (!skip()) throw Unsure{};
            const char c = text_[at_];
            const bool function = c == '|' && at_ + 1 < text_.size() && text_[at_ + 1] == '(';
            if (function) { // Janet's `|(f $)`
                ++at_;
                out.parts.push_back(node(
                    Is::List, "(",
                    {node(Is::Name, "fn"), node(Is::List, "[", {node(Is::Name, "$")}), form()}));
                continue;
            }
            if (c == close || (c == '|' && close == ')')) {
                ++at_;
                if (piped) { // `(a | f x)` is `(f a x)`
                    if (out.parts.empty()) throw Unsure{};
                    out.parts.insert(out.parts.begin() + 1, std::move(before));
                }
                if (c == close) break;
                if (!piped && out.parts.size() == 1) out = Node(out.parts[0]);
                if (++pipes_ > most_pipes) throw Unsure{};
                before = std::move(out);
                out = node(Is::List, "(");
                piped = true;
                continue;
            }
            if (c == ';') {
                ++at_;
                const bool opens = text_[at_] == '(' || text_[at_] == '[';
                out.parts.push_back(node(Is::Spread, "", {opens ? form() : atom()}));
                continue;
            }
            out.parts.push_back(c == '(' || c == '[' ? form() : atom());
        }
        --depth_;
        constexpr std::array<std::string_view, 4> vectors{"list", "vec", "vec2", "vec3"};
        if (out.text == "(" && out.parts.size() > 1 && out.parts[0].is == Is::Name &&
            std::ranges::find(vectors, out.parts[0].text) != vectors.end()) {
            const std::size_t size = out.parts[0].text == "vec3"   ? 3
                                     : out.parts[0].text == "vec2" ? 2
                                                                   : 1;
            out.parts.erase(out.parts.begin());
            out.text = "[";
            if (out.parts.size() == 1) out.parts.resize(size, Node(out.parts[0])); // `(vec3 0.5)`
        }
        return out;
    }

    Node atom() {
        const std::size_t begin = at_;
        while (at_ < text_.size() &&
               std::string_view(" \n\t\r()[]|;,").find(text_[at_]) == std::string_view::npos)
            ++at_;
        const std::string_view word = text_.substr(begin, at_ - begin);
        if (word.empty() || word.find_first_of("{}\"'`@~") != std::string_view::npos)
            throw Unsure{};
        const std::size_t slash = word.find('/', 1);
        if (slash != std::string_view::npos && slash + 1 < word.size() &&
            !word.starts_with("shape/") &&
            !word.starts_with("gl/")) // `tau/4`; `shape/2d` is a name
            return node(Is::Binary, "/",
                        {plain(word.substr(0, slash)), plain(word.substr(slash + 1))});
        return plain(word);
    }

    static Node plain(std::string_view word) {
        const std::string_view figures = word.substr(word[0] == '-' ? 1 : 0);
        const bool number =
            !figures.empty() && figures.find_first_not_of("0123456789.") == std::string_view::npos;
        if (!number) return node(Is::Name, std::string(word));
        Node n = node(Is::Number, std::string(figures));
        return word[0] == '-' ? node(Is::Unary, "-", {std::move(n)}) : n;
    }

    std::string_view text_;
    bool scheme_ = false;
    std::string comment_; // those of the form at hand
    std::size_t at_ = 0;
    int depth_ = 0, count_ = 0, pipes_ = 0;
};

} // namespace

std::vector<TopForm> read_lisp(std::string_view text) { return LispReader(text).all(); }

} // namespace fathom::lang::program
