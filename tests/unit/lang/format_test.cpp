// The formatter: what it does to a text, and that it is idempotent, keeps every comment, and never
// changes the tree: on all the project's files and on programs made at random.
#include "programs.h"
#include "support.h"

#include <catch2/catch.hpp>

#include <algorithm>

using lang_test::Parsed;

namespace {

std::string formatted(const std::string &text) {
    const Parsed parsed(text);
    INFO(parsed.report());
    REQUIRE(parsed.codes().empty());
    return parsed.formatted();
}

std::string letters_of_comments(const std::string &text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] >= 'A' && text[i] <= 'Z') out += text[i];
    return out;
}

void check_laws(const std::string &text) {
    const Parsed parsed(text);
    REQUIRE(parsed.report() == "");
    const std::string once = parsed.formatted();
    const Parsed again(once);
    INFO(text);
    INFO(once);
    REQUIRE(again.report() == "");
    CHECK(again.tree() == parsed.tree());
    CHECK(again.formatted() == once);
    CHECK(letters_of_comments(once) == letters_of_comments(text));
    CHECK(once.find(" \n") == std::string::npos);
    CHECK(once.find("\n\n\n") == std::string::npos);
}

} // namespace

TEST_CASE("spaces") {
    CHECK(formatted("let  a=1+2*-b^c") == "let a = 1 + 2 * -b ^ c\n");
    CHECK(formatted("f( 1,b : 2 ) .g( [1,2 ] )[ 0 ] . x") == "f(1, b: 2).g([1, 2])[0].x\n");
    CHECK(formatted("fn f (a:float,b:shape< 1.5 >=c)->[ T ]{a}") ==
          "fn f(a: float, b: shape<1.5> = c) -> [T] { a }\n");
    CHECK(formatted("for i in 0 .. 8{a}") == "for i in 0..8 { a }\n");
    CHECK(formatted("let f=(a,b)=>a- -b") == "let f = (a, b) => a - -b\n");
    CHECK(formatted("a<1; not(b); - c") == "a < 1\nnot (b)\n-c\n");
    CHECK(formatted("param r=1 in 0 ..2\"x\"") == "param r = 1 in 0..2 \"x\"\n");
    CHECK(formatted("f(1,2,); [\n1,\n]") == "f(1, 2)\n[\n  1\n]\n");
    CHECK(formatted("union{}") == "union {}\n");
    CHECK(formatted("") == "");
}

TEST_CASE("statements stand on lines of their own, two levels of blank lines become one") {
    CHECK(formatted("\n\na;b\n\n\n\nc\n\n") == "a\nb\n\nc\n");
    CHECK(formatted("union {\n\n  a; b\n\n}") == "union {\n  a\n  b\n}\n");
    CHECK(formatted("f(p => { let q = p;q })") == "f(p => { let q = p; q })\n");
    CHECK(formatted("if a {\nb }\nelse { c }") == "if a {\n  b\n} else { c }\n");
}

TEST_CASE("a chain is indented, except below a closing brace") {
    CHECK(formatted("a(1)\n.b()\n.c()") == "a(1)\n  .b()\n  .c()\n");
    CHECK(formatted("union {\na\n}\n  .b()") == "union {\n  a\n}\n.b()\n");
    CHECK(formatted("let x = a\n| b\n| c") == "let x = a\n  | b\n  | c\n");
}

TEST_CASE("comments stay") {
    CHECK(formatted("// A\n\n/* B */ a // C\nunion { // D\n// E\n}\n// F") ==
          "// A\n\n/* B */ a  // C\nunion {  // D\n  // E\n}\n// F\n");
    CHECK(formatted("f(1, // A\n2 /* B */)") == "f(1,  // A\n  2 /* B */)\n");
    CHECK(formatted("a\n  // A\n  .b()") == "a\n  // A\n  .b()\n");
    CHECK(formatted("/// A\nlet a = 1") == "/// A\nlet a = 1\n");
    CHECK(formatted("a; // A\nb") == "a  // A\nb\n");
    CHECK(formatted("/* A\n     B */\na") == "/* A\n     B */\na\n");
    CHECK(formatted("// A \r\r\n// B\r \r") == "// A\n// B\n");
    check_laws("/// A\t \r\t\n/// \t\nlet a = 1\n"); // what is said of a name stays the same
    for (const char *text : {"\f\t\r/// A\f\n\v\rlet a = 1\n", "/// A\n; ;let a = 1\n",
                             "\xEF\xBB\xBF/// A\nlet a = 1\n", "a\n; /// A\nlet b = 1\n"})
        check_laws(text);
}

TEST_CASE("long lines are broken") {
    const std::string item = "some_name_of_twenty_x";
    CHECK(formatted("f(" + item + ", " + item + ", " + item + ", " + item + ", " + item + ")") ==
          "f(\n  " + item + ",\n  " + item + ",\n  " + item + ",\n  " + item + ",\n  " + item +
              "\n)\n");
    CHECK(formatted("let l = [" + item + ", " + item + ", " + item + ", " + item + ", " + item +
                    "]") == "let l = [\n  " + item + ", " + item + ", " + item + ", " + item +
                                ",\n  " + item + "\n]\n");
    CHECK(formatted("a(1)." + item + "(1)." + item + "(2)." + item + "(3)." + item + "(4)." + item +
                    "(5)") == "a(1)\n  ." + item + "(1)\n  ." + item + "(2)\n  ." + item +
                                  "(3)\n  ." + item + "(4)\n  ." + item + "(5)\n");
    CHECK(formatted("let s = " + item + " | " + item + " | " + item + " | " + item + " | " +
                    item) == "let s = " + item + "\n  | " + item + "\n  | " + item + "\n  | " +
                                 item + "\n  | " + item + "\n");
    CHECK(formatted("fn f() { let a = " + item + "; " + item + "(a, " + item + ", " + item + ", " +
                    item + ") }") == "fn f() {\n  let a = " + item + "\n  " + item + "(a, " + item +
                                         ", " + item + ", " + item + ")\n}\n");
}

TEST_CASE("a long value goes below its `=` where it fits there") {
    const std::string head = "fn some_function(a: float, b: float, shapes: [shape]) -> shape =",
                      body = "another_function(a * b, yet_another_one(b, shapes))";
    CHECK(formatted(head + " " + body) == head + "\n  " + body + "\n");
    const std::string args = "[0.25, -1.25, 0.125], [0.25, 1.25, 0.125], 0.035";
    CHECK(formatted("let some_name_of_a_shape = capsule(" + args + ").repeat_polar(some_count)") ==
          "let some_name_of_a_shape =\n  capsule(" + args + ").repeat_polar(some_count)\n");
}

TEST_CASE("calls stand a step to the right of what they are calls of") {
    CHECK(formatted("let x =\na(1)\n.b()\n.c()") == "let x =\n  a(1)\n    .b()\n    .c()\n");
    CHECK(formatted("let x =\nunion {\na\n}\n.b()") == "let x =\n  union {\n    a\n  }\n  .b()\n");
    CHECK(formatted("a(1) -\nb(2)\n.c()\n.d() -\ne\n.f()") ==
          "a(1) -\n  b(2)\n    .c()\n    .d() -\n  e\n    .f()\n");
    CHECK(formatted("f(\na,\nb\n.c()\n)") == "f(\n  a,\n  b\n    .c()\n)\n");
}

TEST_CASE("a chain, a sum and the items of a bracket are broken before a block in them") {
    const std::string long_call = "some_name_of_twenty_x(some_name_of_twenty_y)";
    CHECK(
        formatted(long_call + ".translate([1, 2, 3]).paint(if a == b { first } else { second })") ==
        long_call + "\n  .translate([1, 2, 3])\n  .paint(if a == b { first } else { second })\n");
    CHECK(formatted("box([2 * " + long_call + ", 1, 2]) - box([2 * " + long_call + ", 1, 2])") ==
          "box([2 * " + long_call + ", 1, 2]) -\n  box([2 * " + long_call + ", 1, 2])\n");
    CHECK(formatted("f(" + long_call + ", symmetric: if sides == 2 { \"xy\" } else { \"y\" }, g(" +
                    long_call + "))") ==
          "f(\n  " + long_call + ",\n  symmetric: if sides == 2 { \"xy\" } else { \"y\" },\n  g(" +
              long_call + ")\n)\n");
    CHECK(formatted("shape_of(p => { let first = " + long_call + "; let second = " + long_call +
                    "; first })") == "shape_of(p => {\n  let first = " + long_call +
                                         "\n  let second = " + long_call + "\n  first\n})\n");
}

TEST_CASE("the laws hold for all files of the project") {
    for (const lang_test::File &file : lang_test::corpus()) {
        INFO(file.path);
        const Parsed parsed(file.text);
        if (parsed.codes().empty()) check_laws(file.text);
    }
}

TEST_CASE("the laws hold for random programs, laid out at random") {
    for (unsigned seed = 0; seed < 2000; ++seed) {
        INFO("seed " << seed);
        check_laws(lang_test::random_program(seed));
    }
}
