// Texts made to break a parser: it answers them, in bounded stack and in linear work.
#include "support.h"

#include <catch2/catch.hpp>

using lang_test::Parsed;

namespace {

std::string times(std::string_view text, std::size_t count) {
    std::string out;
    out.reserve(text.size() * count);
    for (std::size_t i = 0; i < count; ++i) out += text;
    return out;
}

bool has(const Parsed &parsed, std::string_view code) {
    for (const std::string &c : parsed.codes())
        if (c == code) return true;
    return false;
}

} // namespace

TEST_CASE("256 levels are read, 257 are an error") {
    const auto nested = [](std::size_t n) {
        return "let a = " + times("(", n) + "1" + times(")", n);
    };
    CHECK(Parsed(nested(256)).codes().empty());
    CHECK(Parsed(nested(257)).codes() == std::vector<std::string>{"too-deep"});
    CHECK(Parsed(times("union { ", 256) + times("}", 256)).codes().empty());
    CHECK(Parsed(times("union { ", 258) + times("}", 258)).codes() ==
          std::vector<std::string>{"too-deep"});
    CHECK(Parsed("let l = " + times("[", 256) + times("]", 256)).codes().empty());
}

TEST_CASE("a statement that breaks off within a block that is never closed is left once") {
    for (const char *text : {"(p{if n:)", "(p { for i in l: )\nsphere(1)", "[f { while a: ]",
                             "f(g { if a then ) else b", "(f { x -> )", "let a = (f { match b: )"})
        CHECK_FALSE(Parsed(text).codes().empty());
}

TEST_CASE("a type of another language that breaks off is left once") {
    for (const char *text :
         {"f()\nstd::vector<a\xe9> rs{0.2};", "f()\nstd::vector<a b> rs;", "f()\nVec<f32 x"})
        CHECK_FALSE(Parsed(text).codes().empty());
}

TEST_CASE("endless nesting is answered once") {
    for (const auto &[open, close] :
         std::initializer_list<std::pair<const char *, const char *>>{{"(", ")"},
                                                                      {"[", "]"},
                                                                      {"f(", ")"},
                                                                      {"union {", "}"},
                                                                      {"if a {", "}"},
                                                                      {"for i in l {", "}"},
                                                                      {"fn f() {", "}"},
                                                                      {"x => (", ")"},
                                                                      {"[for i in l {", "}]"},
                                                                      {"while a {", "}"}}) {
        const Parsed closed(times(open, 100000) + times(close, 100000));
        INFO(open);
        CHECK(has(closed, "too-deep"));
        CHECK(closed.codes().size() == 1);
        CHECK(lang_test::defect(closed).empty());
        CHECK(has(Parsed(times(open, 100000)), "unclosed-bracket"));
    }
}

TEST_CASE("endless operators and chains are answered") {
    for (const char *link : {"- ", "not ", "2 ^ ", "x => ", "a ? b : "}) {
        const Parsed parsed("let a = " + times(link, 100000) + "b");
        INFO(link);
        CHECK(has(parsed, "too-deep"));
        CHECK(lang_test::defect(parsed).empty());
    }
    for (const char *link : {".f(1)", "[1]", ".x", "(1)"}) {
        const Parsed parsed("let a = b" + times(link, 100000));
        INFO(link);
        CHECK(parsed.codes() == std::vector<std::string>{"too-deep"});
        CHECK(lang_test::defect(parsed).empty());
    }
    CHECK(has(Parsed("fn f(a: " + times("(a) -> ", 100000) + "b) = 1"), "too-deep"));
}

TEST_CASE("long is not deep") {
    for (const char *row : {"a | ", "a + ", "a * ", "a and ", "a or ", "a & "}) {
        const Parsed parsed("let a = " + times(row, 250000) + "b");
        INFO(row);
        CHECK(parsed.codes().empty());
        CHECK(parsed.ast.exprs.size() == 250002);
    }
    CHECK(Parsed("let l = [" + times("1, ", 1000000) + "1]").codes().empty());
    CHECK(Parsed("if a { 1 }" + times(" else if b { 2 }", 100000)).codes().empty());
    CHECK(Parsed(times("sphere(1); ", 100000)).codes().empty());
    CHECK(Parsed("f(" + times("a: 1, ", 100000) + "b: 2)").codes().empty());
    CHECK(Parsed(times("a.f(1).g(2)\n", 10000)).codes().empty());
}

TEST_CASE("a hundred thousand errors are no flood") {
    for (const char *line :
         {"let = 3\n", "f(\n", "}\n", ")]\n", "fn f() {\n let = 3\n", "\"\n", "#\n", "\x01", "é ",
          "math.sin(1)\n", "translate(1) ", "else ", "/*", "'", "1 < ", "@", "a ", "for (", "?"}) {
        const Parsed parsed(times(line, 100000));
        INFO(line);
        CHECK(parsed.diagnostics.has_errors());
        CHECK(parsed.diagnostics.items().size() <= 200);
        CHECK(lang_test::defect(parsed).empty());
        for (const fathom::Diagnostic &d : parsed.diagnostics.items())
            CHECK(to_text(d, parsed.sources, false).size() < 4000);
    }
}

TEST_CASE("a word of another language may be the last of the text") {
    for (const std::string begin : {"", ";", "a\n"})
        for (const char *last :
             {"switch", "match", "export default", "try", "do", "import", "import (", "const [",
              "const {", "let", "for", "if a:", "elif", "else", "#define"}) {
            const Parsed parsed(begin + last);
            INFO(parsed.text());
            CHECK(lang_test::defect(parsed).empty());
            for (const fathom::Diagnostic &d : parsed.diagnostics.items())
                CHECK(d.primary.span.end <= parsed.text().size());
        }
    CHECK(Parsed(";export default").codes() == std::vector<std::string>{"foreign-syntax"});
    CHECK(Parsed(";switch").codes().empty()); // a name
}
