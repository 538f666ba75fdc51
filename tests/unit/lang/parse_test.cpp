// Each construct of the language and the tree that it makes.
#include "support.h"

#include <catch2/catch.hpp>

using lang_test::Parsed;
using lang_test::tree_of;

TEST_CASE("numbers") {
    CHECK(tree_of("12") == "int 12");
    CHECK(tree_of("2.5; 1e3; 1.5e-3; 2E+2") ==
          "number 2.5; number 1000; number 0.0015; number 200");
    CHECK(tree_of("0.5turn") == "number 3.141592653589793 from turn");
    CHECK(tree_of("180deg") == "number 3.141592653589793 from deg");
    CHECK(tree_of("1.25rad") == "number 1.25 from rad");
    CHECK(tree_of("0..8") == "range ..(int 0, int 8)");
    CHECK(tree_of("0.0..=2.0") == "range ..=(number 0, number 2)");
    CHECK(tree_of("2.max(3)") == "call(member max(int 2), argument(int 3))");
}

TEST_CASE("strings, truth, colours") {
    CHECK(tree_of(R"("a\n\"\\\t b")") == R"(string "a\n\"\\\t b")");
    CHECK(tree_of("\"é // no comment\"") == "string \"é // no comment\"");
    CHECK(tree_of("true; false") == "true; false");
    CHECK(tree_of("#fff") == "color 1 1 1 1");
    CHECK(tree_of("#FF0000") == "color 1 0 0 1");
    CHECK(tree_of("#00ff0033") == "color 0 1 0 0.2");
}

TEST_CASE("precedence, loosest first") {
    CHECK(tree_of("a | b & c") == "binary |(name a, binary &(name b, name c))");
    CHECK(tree_of("a & b or c") == "binary &(name a, binary or(name b, name c))");
    CHECK(tree_of("a or b and c") == "binary or(name a, binary and(name b, name c))");
    CHECK(tree_of("not a and b") == "binary and(unary not(name a), name b)");
    CHECK(tree_of("not a == b") == "unary not(binary ==(name a, name b))");
    CHECK(tree_of("a == b..c") == "binary ==(name a, range ..(name b, name c))");
    CHECK(tree_of("a..b + c") == "range ..(name a, binary +(name b, name c))");
    CHECK(tree_of("a + b * c") == "binary +(name a, binary *(name b, name c))");
    CHECK(tree_of("a * -b") == "binary *(name a, unary -(name b))");
    CHECK(tree_of("-a * b") == "binary *(unary -(name a), name b)");
    CHECK(tree_of("-2^2") == "unary -(binary ^(int 2, int 2))");
    for (const char *bound : {"let n = fold(0..3, 0, (x, y) => x + y) - 1",
                              "let n = len([for x in 0..3 { x^2 }]) + 1"}) // names of their own
        CHECK(Parsed(bound).report().empty());
    CHECK(tree_of("2^-a^3") == "binary ^(int 2, unary -(binary ^(name a, int 3)))");
    CHECK(tree_of("2^-a*3") == "binary *(binary ^(int 2, unary -(name a)), int 3)");
    CHECK(tree_of("a^b^c") == "binary ^(name a, binary ^(name b, name c))");
    CHECK(tree_of("-a.b") == "unary -(member b(name a))");
    CHECK(tree_of("a^b.c") == "binary ^(name a, member c(name b))");
    CHECK(tree_of("- - a") == "unary -(unary -(name a))");
    CHECK(tree_of("not not a") == "unary not(unary not(name a))");
}

TEST_CASE("rows of one precedence are one node") {
    CHECK(tree_of("a | b | c | d") == "binary | | |(name a, name b, name c, name d)");
    CHECK(tree_of("a - b + c - d") == "binary - + -(name a, name b, name c, name d)");
    CHECK(tree_of("a * b / c % d") == "binary * / %(name a, name b, name c, name d)");
    CHECK(tree_of("a or b or c") == "binary or or(name a, name b, name c)");
    CHECK(tree_of("a + b * c + d") == "binary + +(name a, binary *(name b, name c), name d)");
    CHECK(tree_of("(a | b) | c") == "binary |(binary |(name a, name b), name c)");
    CHECK(tree_of("a - (b - c)") == "binary -(name a, binary -(name b, name c))");
}

TEST_CASE("calls, members, indices") {
    CHECK(tree_of("f()") == "call(name f)");
    CHECK(tree_of("f(1, b: 2)") == "call(name f, argument(int 1), argument b(int 2))");
    CHECK(tree_of("f(1, 2,)") == "call(name f, argument(int 1), argument(int 2))");
    CHECK(tree_of("a.f(1).g") == "member g(call(member f(name a), argument(int 1)))");
    CHECK(tree_of("l[0][1]") == "index(index(name l, int 0), int 1)");
    CHECK(tree_of("f(1)(2)") == "call(call(name f, argument(int 1)), argument(int 2))");
    CHECK(tree_of("(a | b).paint(c)") ==
          "call(member paint(binary |(name a, name b)), argument(name c))");
}

TEST_CASE("trailing blocks") {
    CHECK(tree_of("union { a; b }") ==
          "call without parentheses(name union, block(name a, name b))");
    CHECK(tree_of("smooth(0.2) {\n a\n}") ==
          "call(name smooth, argument(number 0.2), block(name a))");
    CHECK(tree_of("union {}.f()") == "call(member f(call without parentheses(name union, block)))");
    CHECK(tree_of("arch.gate(2) { a }") ==
          "call(member gate(name arch), argument(int 2), block(name a))");
    CHECK(tree_of("let x = union { a } | b") ==
          "let x(binary |(call without parentheses(name union, block(name a)), name b))");
}

TEST_CASE("lists") {
    CHECK(tree_of("[]") == "list");
    CHECK(tree_of("[1, [2, 3],]") == "list(int 1, list(int 2, int 3))");
    CHECK(tree_of("[for i in 0..3 { i }]") ==
          "comprehension(for i(range ..(int 0, int 3), body(name i)))");
    CHECK(tree_of("[if a { 1 }]") == "comprehension(if(condition(name a), then(int 1)))");
    CHECK(tree_of("[if a { 1 } else { 2 }, 3]") ==
          "list(if(condition(name a), then(int 1), else(int 2)), int 3)");
    CHECK(tree_of("[(if a { 1 })]") == "list(if(condition(name a), then(int 1)))");
    CHECK(tree_of("[[for i in l { i }]]") == "list(comprehension(for i(name l, body(name i))))");
}

TEST_CASE("lambdas reach as far as `|`") {
    CHECK(tree_of("p => p.x | q") ==
          "lambda(parameter p, value(binary |(member x(name p), name q)))");
    CHECK(tree_of("f(p => p + 1, 2)") == "call(name f, argument(lambda(parameter p, value(binary "
                                         "+(name p, int 1)))), argument(int 2))");
    CHECK(tree_of("(a, b: int) => a") == "lambda(parameter a, parameter b: int, value(name a))");
    CHECK(tree_of("() => 1") == "lambda(value(int 1))");
    CHECK(tree_of("p => { let q = p; q }") == "lambda(parameter p, body(let q(name p), name q))");
    CHECK(tree_of("x => y => x") ==
          "lambda(parameter x, value(lambda(parameter y, value(name x))))");
    CHECK(tree_of("(a)") == "name a");
}

TEST_CASE("functions") {
    CHECK(tree_of("fn f() = 1") == "fn f(value(int 1))");
    CHECK(tree_of("fn f(a: float, b: vec3 = [0, 0]) -> shape { a }") ==
          "fn f -> shape(parameter a: float, parameter b: vec3(list(int 0, int 0)), body(name a))");
    CHECK(tree_of("fn f(s: shape<1.5>, l: [vec2], g: (int, [T]) -> () -> float) -> shape<1> = s") ==
          "fn f -> shape<1>(parameter s: shape<1.5>, parameter l: [vec2], "
          "parameter g: (int, [T]) -> () -> float, value(name s))");
    CHECK(tree_of("fn f(x) { return x; return }") ==
          "fn f(parameter x, body(return(name x), return))");
}

TEST_CASE("doc comments belong to what stands below them") {
    CHECK(tree_of("/// One.\n///\n///  two\nfn f() = 1") ==
          R"(fn f doc "One.\n\n two"(value(int 1)))");
    CHECK(tree_of("  /// a\n  let x = 1") == R"(let x doc "a"(int 1))");
    CHECK(tree_of("/// a\n\nlet x = 1") == "let x(int 1)");
    CHECK(tree_of("// a\nlet x = 1\n//// b\nlet y = 1") == "let x(int 1); let y(int 1)");
}

TEST_CASE("choice") {
    CHECK(tree_of("if a { 1 } else if b { 2 } else { 3 }") ==
          "if(condition(name a), then(int 1), condition(name b), then(int 2), else(int 3))");
    CHECK(tree_of("(if a { b } else { c }).x") ==
          "member x(if(condition(name a), then(name b), else(name c)))");
    CHECK(tree_of("if a { b } else { c }.x") ==
          "member x(if(condition(name a), then(name b), else(name c)))");
    CHECK(tree_of("1 + if a { 2 } else { 3 }") ==
          "binary +(int 1, if(condition(name a), then(int 2), else(int 3)))");
}

TEST_CASE("headers take no trailing block outside parentheses") {
    CHECK(tree_of("if f { 1 }") == "if(condition(name f), then(int 1))");
    CHECK(tree_of("for i in l { return\nbreak }") == "for i(name l, body(return, break))");
    CHECK(tree_of("for i in union { 1 }") == "for i(name union, body(int 1))");
    CHECK(tree_of("for i in g(union { a }) { i }") ==
          "for i(call(name g, argument(call without parentheses(name union, block(name a)))), "
          "body(name i))");
    CHECK(tree_of("for i in (f { a }) { i }") ==
          "for i(call without parentheses(name f, block(name a)), body(name i))");
    CHECK(tree_of("for f in [p => { p }] { f }") ==
          "for f(list(lambda(parameter p, body(name p))), body(name f))");
}

TEST_CASE("loops and assignments") {
    CHECK(tree_of("fn f(n) { var x: int = 0; while x < n limit 9 { x += 1 }; x }") ==
          "fn f(parameter n, body(var x: int(int 0), while(binary <(name x, name n), limit(int 9), "
          "body(assign +=(name x, int 1))), name x))");
    CHECK(tree_of("fn f(q) { q.xz = q.zx; q[0].x *= 2; q -= 1; q /= 2 }") ==
          "fn f(parameter q, body(assign =(member xz(name q), member zx(name q)), "
          "assign *=(member x(index(name q, int 0)), int 2), assign -=(name q, int 1), assign "
          "/=(name q, int 2)))");
    CHECK(tree_of("fn f(limit) { while limit { } }") ==
          "fn f(parameter limit, body(while(name limit, body)))");
}

TEST_CASE("parameters and imports") {
    CHECK(tree_of("param r = 1.2 in 0.5..2.0 \"label\"") ==
          R"(param r "label"(number 1.2, low(number 0.5), high(number 2)))");
    CHECK(tree_of("param on: bool = true") == "param on: bool(true)");
    CHECK(tree_of("param v = [0, 0] in [0, -1]..[1, 2 * a]") ==
          "param v(list(int 0, int 0), low(list(int 0, unary -(int 1))), "
          "high(list(int 1, binary *(int 2, name a))))");
    CHECK(tree_of("import \"a.sdf\"; import \"b.sdf\" as b") ==
          R"(import "a.sdf"; import "b.sdf" as b)");
    CHECK(tree_of("let as = 1; let limit = as") == "let as(int 1); let limit(name as)");
}

TEST_CASE("places are the words themselves, parentheses apart") {
    const Parsed parsed("let a = (b + c).f(1)\n");
    REQUIRE(parsed.codes().empty());
    const auto &let =
        std::get<fathom::lang::Let>(parsed.ast.blocks[parsed.ast.root].stmts.at(0).kind);
    const auto &call = parsed.ast.exprs[let.value];
    CHECK(text(parsed.sources, call.span) == "(b + c).f(1)");
    const auto &member = parsed.ast.exprs[std::get<fathom::lang::Call>(call.kind).callee];
    CHECK(text(parsed.sources, member.span) == "(b + c).f");
    const auto &sum = parsed.ast.exprs[std::get<fathom::lang::Member>(member.kind).object];
    CHECK(text(parsed.sources, sum.span) == "b + c");
    CHECK(sum.parenthesized);
    CHECK(text(parsed.sources, std::get<fathom::lang::Binary>(sum.kind).operands.at(1).op_span) ==
          "+");
}
