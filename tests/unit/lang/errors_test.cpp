// What is said about wrong texts: one report a cause, at its place, with edits that fix it.
#include "support.h"

#include <catch2/catch.hpp>

using lang_test::apply_fix;
using lang_test::Parsed;

namespace {

struct Case {
    std::string wrong, code, fixed; // `fixed` is empty where the help has no edit
};

void check(const Case &c) {
    INFO(c.wrong);
    const Parsed parsed(c.wrong);
    INFO(parsed.report());
    CHECK(lang_test::defect(parsed).empty());
    REQUIRE(parsed.codes() == std::vector<std::string>{c.code});
    const fathom::Diagnostic &d = parsed.diagnostics.items()[0];
    if (c.fixed.empty()) {
        CHECK((!d.fix || d.fix->edits.empty()));
        return;
    }
    REQUIRE(d.fix);
    CHECK(apply_fix(c.wrong, d) == c.fixed);
    CHECK(Parsed(c.fixed).report().empty());
}

} // namespace

TEST_CASE("names in the parentheses, and lines that need not be, are answered with our own") {
    const Case cases[] = {
        {"(sphere 100)", "foreign-syntax", "sphere(100)"},
        {"(box 1 2)", "foreign-syntax", "box(1, 2)"},
        {"(sphere 100 | a)", "foreign-syntax", ""},
        {"(union (sphere 1) (box [1 -2 3]))", "foreign-syntax", "sphere(1) | box([2, -4, 6])"},
        {"(box 1 | move x 2 | rotate y (* 2 a))", "foreign-syntax",
         "box(2).translate(x: 2).rotate(2 * a, axis: Y)"},
        {"(union (sphere 1) (box-exact 2))", "foreign-syntax", ""},
        {"(define (f x) (+ x (- 1)))", "foreign-syntax", "fn f(x) = x + -1"},
        {"(def r 20)", "foreign-syntax", "let r = 20"},
        {"import * from \"a.sdf\"", "foreign-syntax", "import \"a.sdf\""},
        {"import *\nsphere(1)", "foreign-syntax", "\nsphere(1)"},
        {"$fn = 64; sphere(1)", "bad-character", "sphere(1)"},
        {"sphere(1, $fn = 64)", "foreign-syntax", "sphere(1)"},
    };
    for (const Case &c : cases) check(c);
}

TEST_CASE("forms of other languages are answered with our own") {
    const Case cases[] = {
        {"a && b", "foreign-syntax", "a and b"},
        {"a || b", "foreign-syntax", "a or b"},
        {"let c = !a", "foreign-syntax", "let c = not a"},
        {"let c = a > 1 ? 2 : 3", "foreign-syntax", "let c = if a > 1 { 2 } else { 3 }"},
        {"vec2 x = vec2(1)", "foreign-syntax", "let x: vec2 = vec2(1)"},
        {"const x = 1", "foreign-syntax", "let x = 1"},
        {"fn f(a) { float d = a; d = min(d, 1); d }", "foreign-syntax",
         "fn f(a) { var d = a; d = min(d, 1); d }"},
        {"fn f(a) { vec2 q = a; q.x += 1; q }", "foreign-syntax",
         "fn f(a) { var q = a; q.x += 1; q }"},
        {"fn f(a) { float d = a; g(d: 1, d) }", "foreign-syntax",
         "fn f(a) { let d: float = a; g(d: 1, d) }"},
        {"const float x = 1;", "foreign-syntax", "let x: float = 1;"},
        {"float x;", "foreign-syntax", ""},
        {"float f(vec3 p) { return p.x; }", "foreign-syntax",
         "fn f(p: vec3) -> float { return p.x; }"},
        {"float f(in vec3 p, float r) { p.x }", "foreign-syntax",
         "fn f(p: vec3, r: float) -> float { p.x }"},
        {"sphere(1)\nvoid main() { a }", "foreign-syntax", "sphere(1)\n"},
        {"function f(x) = x * 2;", "foreign-syntax", "fn f(x) = x * 2;"},
        {"module f(r, h = 2) { sphere(r); }", "foreign-syntax", "fn f(r, h = 2) { sphere(r); }"},
        {"def f(x):\n  x", "foreign-syntax", "fn f(x) {\n  x\n}"},
        {"let f(x) = x", "foreign-syntax", "fn f(x) = x"},
        {"fn f(vec3 p) = p", "foreign-syntax", "fn f(p: vec3) = p"},
        {"fn f(p vec3) = p", "foreign-syntax", "fn f(p: vec3) = p"},
        {"fn f(p): float { p }", "foreign-syntax", "fn f(p) -> float { p }"},
        {"fn f(p) => p", "foreign-syntax", "fn f(p) = p"},
        {"f(x) => x", "foreign-syntax", "fn f(x) = x"},
        {"let f = lambda p: p.x", "foreign-syntax", "let f = p => p.x"},
        {"g(lambda p: p.x)", "foreign-syntax", "g(p => p.x)"},
        {"g(p -> p)", "foreign-syntax", "g(p => p)"},
        {"difference() { a; b }", "foreign-syntax", "difference { a; b }"},
        {"math.sin(1)", "foreign-syntax", "sin(1)"},
        {"let t = True", "foreign-syntax", "let t = true"},
        {"let t = None", "foreign-syntax", ""},
        {"for (i = [0:8]) { a }", "foreign-syntax", "for i in 0..=8 { a }"},
        {"for (i = [0:2:8]) { a }", "foreign-syntax", "for i in range(0, 9, 2) { a }"},
        {"for (i = [1, 2, 5]) { a }", "foreign-syntax", "for i in [1, 2, 5] { a }"},
        {"for (int i = 0; i < 8; i++) { a }", "foreign-syntax", "for i in 0..8 { a }"},
        {"for (int i = 0; i <= n; ++i) { a }", "foreign-syntax", "for i in 0..=n { a }"},
        {"for (let i = 0; i < 8; i += 2) { a }", "foreign-syntax", "for i in range(0, 8, 2) { a }"},
        {"for (i in 0..8) { a }", "foreign-syntax", "for i in 0..8 { a }"},
        {"for i = 0..8 { a }", "foreign-syntax", "for i in 0..8 { a }"},
        {"for i of l { a }", "foreign-syntax", "for i in l { a }"},
        {"fn f() { var i = 0; i++ }", "foreign-syntax", "fn f() { var i = 0; i += 1 }"},
        {"fn f() { var i = 0; i-- }", "foreign-syntax", "fn f() { var i = 0; i -= 1 }"},
        {"fn f() { var i = 0; ++i }", "foreign-syntax", "fn f() { var i = 0; i += 1 }"},
        {"fn f() { var i = 0; i %= 3 }", "foreign-syntax", "fn f() { var i = 0; i = i % 3 }"},
        {"a = 3", "foreign-syntax", "let a = 3"},
        {"a: int = 3", "foreign-syntax", "let a: int = 3"},
        {"let a := 3", "foreign-syntax", "let a = 3"},
        {"let a == 3", "foreign-syntax", "let a = 3"},
        {"let mut a = 3", "foreign-syntax", "let a = 3"},
        {"let a = 3, b = 4", "foreign-syntax", "let a = 3; let b = 4"},
        {"if a = 3 { b }", "foreign-syntax", "if a == 3 { b }"},
        {"if a === 3 { b }", "foreign-syntax", "if a == 3 { b }"},
        {"if a { b } elif c { d }", "foreign-syntax", "if a { b } else if c { d }"},
        {"if a { b }\nelif c { d }", "foreign-syntax", "if a { b }\nelse if c { d }"},
        {"fn f(c) { if (c) return 1; 2 }", "foreign-syntax", "fn f(c) { if (c) { return 1 }; 2 }"},
        {"if a: b", "foreign-syntax", "if a { b }"},
        {"fn f(d) { if d > 2\n return 3\nelse\n return 4 }", "foreign-syntax",
         "fn f(d) { if d > 2 {\n return 3\n}\nelse {\n return 4\n} }"},
        {"let f = |x| x + 1", "foreign-syntax", "let f = x => x + 1"},
        {"let b = a |> f", "foreign-syntax", "let b = a.f()"},
        {"sphere 1", "foreign-syntax", "sphere(1)"},
        {"print \"a\"", "foreign-syntax", "print(\"a\")"},
        {"let b = a!", "foreign-syntax", ""},
        {"let a = 2 ** 3", "foreign-syntax", "let a = 2 ^ 3"},
        {"let a = +3", "foreign-syntax", "let a = 3"},
        {"sphere(r = 1)", "foreign-syntax", "sphere(r: 1)"},
        {"translate([1, 2]) sphere(1)", "foreign-syntax", "sphere(1).translate([1, 2])"},
        {"translate(1) rotate(2) a", "foreign-syntax", "a.rotate(2deg, axis: Z).translate(1)"},
        {"let l = [f(i) for i in l]", "foreign-syntax", "let l = [for i in l { f(i) }]"},
        {"let l = [0:8]", "foreign-syntax", "let l = [0..=8]"},
        {"let x = a if b else c", "foreign-syntax", "let x = if b { a } else { c }"},
        {"let s = 'text'", "foreign-syntax", "let s = \"text\""},
        {"import foo", "foreign-syntax", "import \"foo.sdf\""},
        {"if a:\n  b\nelse:\n  c\nd", "foreign-syntax", "if a {\n  b\n}\nelse {\n  c\n}\nd"},
        {"for x in l:\n  x\n  y\nz", "foreign-syntax", "for x in l {\n  x\n  y\n}\nz"},
        {"for (i = [0:3]) f(i)", "foreign-syntax", "for i in 0..=3 { f(i) }"},
        {"for (const x of l) { x }", "foreign-syntax", "for x in l { x }"},
        {"if (a) b; else c;", "foreign-syntax", "if (a) { b } else { c };"},
        {"f(x=1, y=2)", "foreign-syntax", "f(x: 1, y: 2)"},
        {"f(x 1)", "foreign-syntax", "f(x: 1)"},
        {"f({x: 1})", "foreign-syntax", "f(x: 1)"},
        {"f{x: 1, y: 2}", "foreign-syntax", "f(x: 1, y: 2)"},
        {"let t = (1, 2, 3)", "foreign-syntax", "let t = [1, 2, 3]"},
        {"let l = a ++ b", "foreign-syntax", "let l = concat(a, b)"},
        {"let a, b = 1, 2", "foreign-syntax", ""},
        {"fn (x) = x", "foreign-syntax", ""},
        {"export default sphere(1)", "foreign-syntax", "sphere(1)"},
        {"param r in 0..2", "param-range", "param r = 0 in 0..2"},
        {"break", "wrong-place", ""},
        {"fn f() { break }", "wrong-place", ""},
        {"g(a ++ [1])", "foreign-syntax", "g(concat(a, [1]))"},
        {"f(1) >> g(2)", "foreign-syntax", "f(1).g(2)"},
        {"f(1) >> g 2", "foreign-syntax", "f(1).g(2)"},
        {"let l = [f 1, g]", "foreign-syntax", "let l = [f(1), g]"},
        {"let a = 1 in a", "foreign-syntax", "let a = 1; a"},
        {"assert a < 2", "foreign-syntax", "assert(a < 2)"},
        {"rotate([0, 45, 0]) cube(1)", "foreign-syntax",
         "box(1).translate([0.5, 0.5, 0.5]).rotate_euler([0, 45deg, 0])"},
        {"translate([1, 2, 3]) { a; b }", "foreign-syntax", "union { a; b }.translate([1, 2, 3])"},
        {"import parts/arch.sdf", "foreign-syntax", "import \"parts/arch.sdf\""},
        {"import ../arch as arch", "foreign-syntax", "import \"../arch.sdf\" as arch"},
        {"class A:\n  b\nc", "foreign-syntax", ""},
        {"const { a, b } = c\na", "foreign-syntax", "let a = c[0]; let b = c[1]\na"},
        {"let a = f\"x\"", "foreign-syntax", ""},
        {"let a = new B(1)", "foreign-syntax", "let a = B(1)"},
        {"f x = x * 2", "foreign-syntax", "fn f(x) = x * 2"},
        {"*a", "foreign-syntax", "// *a"},
        {"# remark\na", "foreign-syntax", "// remark\na"},
        {"#define A 1\na", "foreign-syntax", "let A = 1\na"},
        {"fn f() { a //= 2\n }", "foreign-syntax", ""},
    };
    for (const Case &c : cases) check(c);
}

TEST_CASE("names of other languages that the file declares are its own") {
    CHECK(Parsed("import \"m.sdf\" as math\nmath.sin(1)").codes().empty());
    CHECK(Parsed("fn f(np) = np.x").codes().empty());
    CHECK(Parsed("let null = 1; null").codes().empty());
}

TEST_CASE("numbers and colours that are none") {
    const Case cases[] = {
        {"let a = 1.", "bad-number", "let a = 1.0"},
        {"let a = .5", "bad-number", "let a = 0.5"},
        {"let a = 3w", "bad-number", "let a = 3 * w"},
        {"let a = 2.0f", "bad-number", "let a = 2.0"},
        {"let a = 2.f", "bad-number", "let a = 2"},
        {"let a = 1_000", "bad-number", "let a = 1000"},
        {"let a = 0xFF", "bad-number", "let a = 255"},
        {"let a = 45°", "bad-number", "let a = 45deg"},
        {"let a = b.0", "bad-number", "let a = b[0]"},
        {"f(45 deg)", "bad-number", "f(45deg)"},
        {"let a = 45 deg", "bad-number", "let a = 45deg"},
        {"let a = 1e999", "bad-number", ""},
        {"let a = 1e", "bad-number", ""},
        {"let a = #1234", "bad-color", ""},
        {"let a = #12345g", "bad-color", ""},
    };
    for (const Case &c : cases) check(c);
}

TEST_CASE("characters that are not of the language") {
    const Case cases[] = {
        {"let a = 2 × 3", "bad-character", "let a = 2 * 3"},
        {"let a = 2 − 3", "bad-character", "let a = 2 - 3"},
        {"let a = π", "bad-character", "let a = pi"},
        {"let a = 1\u00A0+ 2", "bad-character", "let a = 1 + 2"},
        {"let a = größe", "bad-character", "let a = groesse"},
        {"let радиус = 1", "bad-character", "let radius = 1"},
        {"let θ = 1", "bad-character", "let theta = 1"},
        {"let x₁ = 1", "bad-character", "let x1 = 1"},
        {"let 半径 = 1", "bad-character", ""},
        {"let a = $fn", "bad-character", ""},
        {"let a = \xff\xfe", "bad-character", ""},
    };
    for (const Case &c : cases) check(c);
}

TEST_CASE("brackets, strings and comments that are never closed") {
    CHECK(Parsed("let a = box([1, 2]\nsphere(1)\nlet b = 2").codes() ==
          std::vector<std::string>{"unclosed-bracket"});
    CHECK(Parsed("union {\n a\n").codes() == std::vector<std::string>{"unclosed-bracket"});
    CHECK(Parsed("let a = (1 + 2\nlet b = 3").codes() ==
          std::vector<std::string>{"unclosed-bracket"});
    CHECK(Parsed("let a = \"abc\nlet b = 3").codes() ==
          std::vector<std::string>{"unclosed-bracket"});
    CHECK(Parsed("let a = 1 /* abc\nlet b = 3").codes() ==
          std::vector<std::string>{"unclosed-bracket"});
    CHECK(Parsed("f([1, 2)").codes() == std::vector<std::string>{"unclosed-bracket"});
    check({"let a = 1)", "syntax-error", "let a = 1"});
    // The brace that the indentation accuses.
    const Parsed parsed("fn f() {\n  if a {\n    b\n}\n\nfn g() {\n  c\n}\n");
    REQUIRE(parsed.codes() == std::vector<std::string>{"unclosed-bracket"});
    CHECK(position(parsed.sources[parsed.id], parsed.diagnostics.items()[0].primary.span.begin)
              .line == 2);
}

TEST_CASE("what has no other language to blame") {
    const Case cases[] = {
        {"let a = 0 < x < 1", "syntax-error", "let a = 0 < x and x < 1"},
        {"let a = b..c..d", "syntax-error", ""},
        {"box([1, 2 3])", "syntax-error", "box([1, 2, 3])"},
        {"f(a b)", "syntax-error", "f(a, b)"},
        {"f(a\nb)", "syntax-error", "f(a,\nb)"},
        {"fn f(a: int\nb: int) = a", "syntax-error", "fn f(a: int,\nb: int) = a"},
        {"let a = b + c\n{ d }", "syntax-error", ""},
        {"{ d }", "syntax-error", ""},
        {"a b", "foreign-syntax", "a(b)"},
        {"f(1) b", "syntax-error", ""},
        {"let", "syntax-error", ""},
        {"let in = 3", "syntax-error", "let in_ = 3"},
        {"let a", "foreign-syntax", ""},
        {"fn f { a }", "syntax-error", "fn f() { a }"},
        {"a.", "syntax-error", "a"},
        {"1 +", "syntax-error", "1"},
        {"f(,)", "syntax-error", ""},
        {"[1,,2]", "syntax-error", "[1,2]"},
        {"else { a }", "syntax-error", ""},
        {"let x = { a }", "syntax-error", ""},
        {"param a = 1 in 2", "syntax-error", ""},
        {"a + not b", "syntax-error", ""},
        {"let a: = 1 + 1", "foreign-syntax", "let a = 1 + 1"},
        {"let a: shape<x> = 1", "syntax-error", ""},
        {"let s = \"\\q\"", "syntax-error", ""},
        {"fn f() { 1 = 2 }", "not-assignable", "fn f() { 1 == 2 }"},
        {"fn f() { f(1) += 2 }", "not-assignable", ""},
        {"for i in l { a }.paint(b)", "wrong-place", "union { for i in l { a } }.paint(b)"},
        {"for i in l { a } | b", "wrong-place", ""},
        {"let a = for i in l { i }", "wrong-place", ""},
    };
    for (const Case &c : cases) check(c);
}

TEST_CASE("reading goes on at the next statement") {
    const Parsed parsed("let a = \nlet b = 2\nsphere(1\nunion {\n  box(\n  let = 3\n  "
                        "cone(1)\n}\nlet c = 1 +* 2\nd(1)\n");
    CHECK(parsed.diagnostics.errors() >= 4);
    const std::string tree = parsed.tree();
    for (const char *kept : {"let b\n", "name cone", "let c\n  poison", "name d"})
        CHECK(tree.find(kept) != std::string::npos);
}

TEST_CASE("an error inside a block costs one statement of it") {
    const Parsed parsed("fn f(x) {\n  let y = * 2\n  x.z +\n}\nf(1)");
    CHECK(parsed.codes() == std::vector<std::string>{"syntax-error", "syntax-error"});
    CHECK(lang_test::defect(parsed).empty());
    CHECK(parsed.tree().find("fn f\n  parameter x\n  body\n    let y\n      poison") !=
          std::string::npos);
    CHECK(parsed.tree().find("call\n  name f") != std::string::npos);
}

TEST_CASE("a name whose value cannot be read stays declared") {
    CHECK(Parsed("let a = (1 +\nfn g(x) = 1 2\nvec2 b = 1\n").tree() ==
          "let a\n  poison\nlet g\n  poison\nlet b\n  poison\n");
}
