#include "programs.h"

#include <array>
#include <random>
#include <string_view>
#include <utility>

namespace lang_test {

namespace {

class Writer {
  public:
    explicit Writer(unsigned seed) : random_(seed) {}

    std::string file() {
        for (int i = pick(6); i >= 0; --i) {
            comment_line();
            top_statement();
            end_statement();
        }
        return std::move(out_);
    }

  private:
    int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    bool often() { return pick(3) > 0; }
    void put(std::string_view text) { out_ += text; }

    // Any room between two words; a line end only where it means nothing.
    void room() {
        if (loose_ > 0 && pick(8) == 0) {
            if (pick(4) == 0) put(" // " + letter());
            put("\n");
            if (pick(5) == 0) put("\n\n");
            put(std::string(static_cast<std::size_t>(pick(6)), ' '));
        } else if (pick(12) == 0) {
            put(" /* " + letter() + " */ ");
        } else {
            put(pick(4) == 0 ? "   " : " ");
        }
    }
    void gap() { // room that may be left away
        if (pick(3) == 0) room();
    }
    void behind_operator() { // where a line end means nothing anywhere
        ++loose_;
        room();
        --loose_;
    }
    std::string letter() { return std::string(1, static_cast<char>('A' + pick(26))); }
    void comment_line() {
        if (pick(4) == 0)
            put(pick(2) ? "// " + letter() + "\n" : "/* " + letter() + "\n " + letter() + " */\n");
        if (pick(6) == 0) put("\n\n");
    }
    void end_statement() {
        if (pick(6) == 0)
            put(" // " + letter());
        else if (pick(4) == 0)
            put(";");
        put("\n");
    }

    void name() {
        static constexpr std::array names = {"a",     "b",  "sphere", "radius",
                                             "limit", "as", "p",      "long_name_of_a_thing"};
        put(names[static_cast<std::size_t>(pick(names.size()))]);
    }
    void number() {
        static constexpr std::array numbers = {"0", "1", "2.5", "1e-3", "45deg", "0.25turn", "128"};
        put(numbers[static_cast<std::size_t>(pick(numbers.size()))]);
    }
    void type() {
        switch (pick(5)) {
        case 0: put("shape<1.5>"); break;
        case 1: put("[vec3]"); break;
        case 2: put("(float, [int]) -> vec2"); break;
        default: put("float");
        }
    }

    // A row of operands; `header` where no trailing block may stand outside parentheses.
    void expression(bool header = false) {
        if (++depth_ > 4) {
            number();
            --depth_;
            return;
        }
        if (pick(12) == 0) put("not ");
        operand(header);
        bool compared = false;
        for (int i = pick(4) - 1; i > 0; --i) {
            static constexpr std::array operators = {" | ", "|",   " & ", " or ", " and ", " + ",
                                                     "-",   " - ", "*",   " / ",  " % ",   "^"};
            static constexpr std::array comparisons = {" == ", "<", " <= ", " != ", " .. ", "..="};
            if (!compared && pick(8) == 0) {
                put(comparisons[static_cast<std::size_t>(pick(comparisons.size()))]);
                compared = true;
            } else {
                put(operators[static_cast<std::size_t>(pick(operators.size()))]);
            }
            if (pick(4) == 0) behind_operator();
            operand(header);
        }
        --depth_;
    }

    void inside(const char *open, const char *close, int maximum) {
        put(open);
        ++loose_;
        const int items = pick(maximum + 1);
        for (int i = items; i > 0; --i) {
            gap();
            if (*open == '(' && pick(3) == 0) put("named"), gap(), put(":"), room();
            if (pick(8) == 0)
                lambda();
            else
                expression();
            gap();
            if (i > 1 || pick(5) == 0) put(",");
        }
        if (items > 0) gap();
        --loose_;
        put(close);
    }

    void lambda() {
        const int loose = loose_;
        if (pick(2))
            name();
        else
            put("(a, b: "), type(), put(")");
        put(" =>");
        room();
        if (pick(3) == 0)
            block(true);
        else
            expression();
        loose_ = loose;
    }

    void operand(bool header) {
        if (pick(8) == 0) put("-");
        switch (pick(12)) {
        case 0: number(); break;
        case 1: put("#a1b2c3"); break;
        case 2: put("\"te xt\""); break;
        case 3: put(pick(2) ? "true" : "false"); break;
        case 4:
            put("(");
            ++loose_, gap(), expression(), gap(), --loose_;
            put(")");
            break;
        case 5: inside("[", "]", 4); break;
        case 6:
            if (header) {
                name();
                break;
            }
            put("if ");
            expression(true);
            put(" ");
            block(false);
            if (often()) put(" else "), block(false);
            break;
        case 7:
            put("[for i in ");
            expression(true);
            put(" ");
            block(false);
            put("]");
            break;
        default: name();
        }
        for (int i = pick(4) - 1; i > 0; --i) postfix(header);
    }

    void postfix(bool header) {
        // A number would take the point for its own.
        if (out_.back() >= '0' && out_.back() <= '9') return;
        switch (pick(header ? 4 : 5)) {
        case 0: inside("(", ")", 3); break;
        case 1:
            put("[");
            ++loose_, expression(), --loose_;
            put("]");
            break;
        case 2:
            if (pick(3) == 0) behind_operator();
            put(".");
            name();
            inside("(", ")", 3);
            break;
        case 3: put(".xyz"); break;
        default:
            if (out_.back() != ')' || out_.ends_with("()")) return;
            put(" ");
            block(false);
        }
    }

    void block(bool in_function) {
        const int loose = std::exchange(loose_, 0);
        const bool function = in_function_;
        in_function_ |= in_function;
        put("{");
        const bool one_line = pick(2) == 0;
        for (int i = pick(4); i > 0; --i) {
            put(one_line ? " " : "\n");
            if (!one_line) comment_line();
            statement();
            if (one_line)
                put(i > 1 ? ";" : "");
            else
                end_statement();
        }
        put(" }");
        in_function_ = function;
        loose_ = loose;
    }

    void statement() {
        if (++depth_ > 3) {
            name();
            --depth_;
            return;
        }
        switch (pick(in_function_ ? 9 : 5)) {
        case 0:
            put("let ");
            name();
            if (pick(3) == 0) put(" : "), type();
            put(" =");
            behind_operator();
            expression();
            break;
        case 1:
            put("for i in ");
            expression(true);
            put(" ");
            block(false);
            break;
        case 2:
            put("fn ");
            name();
            put("(a: float, b = ");
            expression();
            put(")");
            if (often()) put(" -> "), type();
            if (often())
                put(" "), block(true);
            else
                put(" = "), in_body_expression();
            break;
        case 5:
            put("a.xz *= ");
            expression();
            break;
        case 6:
            put("var v = ");
            expression();
            break;
        case 7:
            put("while ");
            expression(true);
            if (often()) put(" limit 9");
            put(" ");
            block(false);
            break;
        case 8:
            put("return ");
            expression();
            break;
        default: expression();
        }
        --depth_;
    }
    void in_body_expression() {
        const bool function = std::exchange(in_function_, true);
        expression();
        in_function_ = function;
    }

    void top_statement() {
        switch (pick(8)) {
        case 0: put("import \"x.sdf\" as m"); break;
        case 1:
            put("param r = 1 in 0 .. ");
            number();
            put(" \"label\"");
            break;
        default: statement();
        }
    }

    std::minstd_rand random_;
    std::string out_;
    int depth_ = 0;
    int loose_ = 0; // brackets in which line ends mean nothing
    bool in_function_ = false;
};

} // namespace

std::string random_program(unsigned seed) { return Writer(seed * 2654435761u + 1).file(); }

std::string mutated(const std::string &text, unsigned seed) {
    static constexpr std::array words = {
        "(",          ")",       "[",        "]",           "{",      "}",        ",",
        ":",          ".",       "=",        "|",           "&",      "<",        ">",
        "+",          "-",       "*",        "/",           "^",      "?",        "!",
        "#",          "\"",      "'",        "\n",          ";",      "..",       "..=",
        "=>",         "->",      "==",       "&&",          "||",     "++",       "--",
        "+=",         "%=",      "//",       "/*",          "*/",     " let ",    " var ",
        " fn ",       " param ", " import ", " for ",       " in ",   " if ",     " else ",
        " while ",    " break ", " return ", " and ",       " or ",   " not ",    " true ",
        " limit ",    " as ",    " a ",      " vec3 ",      " elif ", " lambda ", " def ",
        " math.sin ", "1.",      ".5",       "3x",          "\xff",   "\x01",     "é",
        "×",          "\t",      "\r\n",     "\xEF\xBB\xBF"};
    std::minstd_rand random(seed * 2654435761u + 7);
    const auto pick = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
    std::string out = text;
    for (std::size_t changes = 1 + pick(8); changes > 0; --changes) {
        const std::size_t at = pick(out.size() + 1), length = pick(12);
        switch (pick(5)) {
        case 0: out.erase(at, length); break;
        case 1: out.insert(at, out.substr(pick(out.size() + 1), length)); break;
        case 2: out.resize(at); break;
        case 3:
            if (at < out.size()) out[at] = static_cast<char>(pick(256));
            break;
        default: out.insert(at, words[pick(words.size())]);
        }
    }
    return out;
}

} // namespace lang_test
