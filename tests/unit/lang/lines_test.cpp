// Where statements end: the innermost bracket decides, and what ends or begins a line.
#include "support.h"

#include <catch2/catch.hpp>

using lang_test::Parsed;
using lang_test::tree_of;

TEST_CASE("a line end ends a statement, but not inside parentheses or brackets") {
    CHECK(tree_of("a\nb;c") == "name a; name b; name c");
    CHECK(tree_of("f(\n1\n,\n2\n)") == "call(name f, argument(int 1), argument(int 2))");
    CHECK(tree_of("[1,\n\n2\n]") == "list(int 1, int 2)");
    CHECK(tree_of("f(p => {\n let q = p\n q\n})") ==
          "call(name f, argument(lambda(parameter p, body(let q(name p), name q))))");
    CHECK(tree_of("f(a\n + b)") == "call(name f, argument(binary +(name a, name b)))");
    CHECK(tree_of(";;a;;\n;b;") == "name a; name b");
    CHECK(tree_of("a\r\nb\r\n") == "name a; name b");
}

TEST_CASE("a line end ends a statement whose last method has the name of another language's call") {
    for (const char *method : {"offset(0.05)", "translate([1, 2, 3])", "rotate(0.5)", "scale(2)"}) {
        INFO(method);
        CHECK(tree_of("union { box(1)." + std::string(method) + "\n    sphere(1) }") ==
              tree_of("union { box(1)." + std::string(method) + "; sphere(1) }"));
    }
}

TEST_CASE("a statement goes on behind an operator") {
    for (const char *op : {"|", "&", "or", "and", "==", "<", "+", "-", "*", "/", "%", "^"}) {
        const std::string tree = "binary " + std::string(op) + "(name a, name b)";
        CHECK(tree_of("a " + std::string(op) + "\nb") == tree);
        CHECK(tree_of("a " + std::string(op) + " // why\n\n  /* and */ b") == tree);
    }
    CHECK(tree_of("let a =\n b") == "let a(name b)");
    CHECK(tree_of("a =>\n b") == "lambda(parameter a, value(name b))");
    CHECK(tree_of("fn f() ->\n float = 1") == "fn f -> float(value(int 1))");
    CHECK(tree_of("let a:\n int = 1") == "let a: int(int 1)");
    CHECK(tree_of("a..\nb") == "range ..(name a, name b)");
}

TEST_CASE("a statement goes on where the next line begins with `.`, `|`, `&` or `else`") {
    CHECK(tree_of("a\n.f()\n// remark\n\n.g()") == "call(member g(call(member f(name a))))");
    CHECK(tree_of("a\n| b\n| c") == "binary | |(name a, name b, name c)");
    CHECK(tree_of("a\n& b") == "binary &(name a, name b)");
    CHECK(tree_of("if a { b }\n\nelse { c }") ==
          "if(condition(name a), then(name b), else(name c))");
    CHECK(tree_of("union {\n a\n}\n.f()") ==
          "call(member f(call without parentheses(name union, block(name a))))");
}

TEST_CASE("a line that begins with a bracket or a minus is new") {
    CHECK(tree_of("a\n(b)") == "name a; name b");
    CHECK(tree_of("a\n[b]") == "name a; list(name b)");
    CHECK(tree_of("a\n-b") == "name a; unary -(name b)");
    // Nor does it call or index inside brackets.
    CHECK(Parsed("[a\n(b)]").codes() == std::vector<std::string>{"syntax-error"});
    CHECK(Parsed("[a\n[b]]").codes() == std::vector<std::string>{"syntax-error"});
}

TEST_CASE("an operator at a line's beginning is to move up") {
    for (const char *op : {"+", "*", "/", "%", "^", "==", "<", "and", "or", "=", "=>", ".."}) {
        const Parsed parsed("let x = a\n  " + std::string(op) + " b");
        const auto codes = parsed.codes();
        REQUIRE_FALSE(codes.empty());
        CHECK(codes[0] == "line-continues");
    }
    const Parsed parsed("let x = a // first\n  + b\nlet y = 1");
    REQUIRE(parsed.codes() == std::vector<std::string>{"line-continues"});
    const std::string fixed = lang_test::apply_fix(parsed.text(), parsed.diagnostics.items()[0]);
    CHECK(fixed == "let x = a + // first\n  b\nlet y = 1");
    CHECK(tree_of(fixed) == "let x(binary +(name a, name b)); let y(int 1)");
}

TEST_CASE("a brace on a line of its own is answered") {
    for (const char *text :
         {"fn f()\n{\n  a\n}", "union\n{\n  a\n}", "if a\n{\n  b\n}", "for i in l\n{\n  b\n}"}) {
        const Parsed parsed(text);
        REQUIRE(parsed.codes() == std::vector<std::string>{"foreign-syntax"});
        CHECK(Parsed(lang_test::apply_fix(text, parsed.diagnostics.items()[0])).codes().empty());
    }
}

TEST_CASE("comments are no text") {
    CHECK(tree_of("a /* x */ + /* \n */ b") == "binary +(name a, name b)");
    CHECK(tree_of("a /* \n */ b") == "name a; name b");
    CHECK(tree_of("/* /* */ a") == "name a");
    CHECK(tree_of("// only") == "");
    CHECK(tree_of("") == "");
    CHECK(tree_of("\xEF\xBB\xBF"
                  "a") == "name a");
}
