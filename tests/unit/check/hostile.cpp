// Scenes that ask for too much are answered, soon and in bounded memory.
#include "driver/compile.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>
#include <sys/resource.h>

using namespace fathom;

namespace {

std::string times(std::string_view text, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += text;
    return out;
}

// The code of the only error, "" where there is none.
std::string answer(const std::string &text) {
    driver::Compilation c = driver::compile_text("hostile.sdf", text, "", {});
    std::string code;
    for (const Diagnostic &d : c.diagnostics.items()) {
        if (d.severity != Severity::Error) continue;
        UNSCOPED_INFO(d.message);
        code += (code.empty() ? "" : " ") + std::string(code_name(d.code));
    }
    CHECK(c.evaluations < 21'000'000);
    return code;
}

} // namespace

TEST_CASE("recursion has an end") {
    CHECK(answer("fn f(n) = if n == 0 { 0 } else { 1 + f(n - 1) }\nsphere(f(1000000))") ==
          "recursion-limit");
    CHECK(answer("fn f(x) = g(x)\nfn g(x) = f(x + 1)\nsphere(f(0))") == "recursion-limit");
    CHECK(answer("fn f(x) = f(x)\nimplicit(p => f(length(p)))") == "recursion-limit");
    CHECK(answer("fn t(n) = if n == 0 { sphere(1) } else { t(n - 1) | t(n - 1).translate(x: n) "
                 "}\nt(40)") == "loop-limit");
    CHECK(answer("let f0 = p => length(p)\n" + [] {
              std::string text;
              for (int i = 1; i < 40; ++i)
                  text += fmt::format("let f{} = p => f{}(p) + f{}(p * 2)\n", i, i - 1, i - 1);
              return text;
          }() + "implicit(f39, estimate: 2)") == "loop-limit");
}

TEST_CASE("lists have an end") {
    CHECK(answer("let l = [for i in 0..1000000 { i }]\nsphere(len(l) / 1000000)") == "");
    CHECK(answer("let l = [for i in 0..1000000000 { i }]\nsphere(len(l))") == "loop-limit");
    CHECK(answer("fn d(n) = if n == 0 { [1, 1] } else { concat(d(n - 1), d(n - 1)) "
                 "}\nsphere(len(d(40)))") == "loop-limit"); // 640 MiB are nearly as soon reached
}

TEST_CASE("looking for files is work") {
    CHECK(answer("for i in 0..1000000 { image(\"a.png\") }\nsphere(1)") == "file-not-found");
    CHECK(answer("for i in 0..1000000 { image(\"a\" + i + \".png\") }\nsphere(1)") ==
          "file-not-found loop-limit");
    // Of folders in folders each is gone through for each.
    CHECK(answer("let way = fold(0..2000, \"\", (s, i) => s + \"a/\")\n"
                 "for i in 0..20 { image(way + i) }\nsphere(1)") == "file-not-found loop-limit");
    CHECK(answer("import \"" + times("a", 4097) + "\"\nsphere(1)") == "import-not-found");
    CHECK(answer("let name = fold(0..13, \"a\", (s, i) => s + s)\nimage(name)\nsphere(1)") ==
          "file-not-found");
    CHECK(answer("let name = fold(0..13, \"a\", (s, i) => s + s)\n"
                 "distance_grid(\"a.vdb\", grid: name)") == "file-not-found");
}

TEST_CASE("looking for waves in what is told apart is work") {
    std::vector<std::string> terms;
    for (int i = 1; i <= 64; ++i) terms.push_back("fract(q.x * " + std::to_string(i) + ")");
    for (; terms.size() > 1; terms.resize(terms.size() / 2))
        for (std::size_t i = 0; i < terms.size() / 2; ++i)
            terms[i] = "(" + terms[2 * i] + " + " + terms[2 * i + 1] + ")";
    const auto errors = [&](const std::string &of_sum) {
        driver::CompileOptions options;
        options.limits.work = 100'000; // the text takes less by itself
        return driver::compile_text(
                   "waves.sdf",
                   "implicit(p => length(p) - 1 + fold(0..100, 0.0, (acc, i) => {\n"
                   "  let q = p * (1 + 0.001 * i)\n  let u = " +
                       terms[0] + "\n  return acc + 0.000001 * " + of_sum +
                       "\n}), within: ball(2), estimate: 5)\n",
                   "", options)
            .diagnostics.errors();
    };
    CHECK(errors("u") == 0);
    CHECK(errors("step(i, u)") == 1);
}

TEST_CASE("texts nest so far and no further") {
    const int deep = 100'000;
    CHECK(answer("sphere(" + times("(", deep) + "1" + times(")", deep) + ")") == "too-deep");
    CHECK(answer(times("union {", deep) + "sphere(1)" + times("}", deep)) == "too-deep");
    CHECK(answer("let a = " + times("[", deep) + "1" + times("]", deep) + "\nsphere(1)") ==
          "too-deep");
    CHECK(answer(times("if true {", deep) + "sphere(1)" + times("}", deep)) == "too-deep");
    CHECK(answer("let f = " + times("p => ", deep) + "1\nsphere(1)") == "too-deep");
    CHECK(answer("sphere(" + times("-", deep) + "1)") == "too-deep");
    CHECK(answer("sphere(1)" + times(".translate(x: 1)", deep)) == "too-deep");
    CHECK(answer("sphere(1" + times(" + 0", 300'000) + ")") ==
          ""); // a line of more than a megabyte
}

TEST_CASE("loops have an end") {
    CHECK(answer("for i in 0..1000000000 { }\nsphere(1)") == "loop-limit");
    CHECK(answer("for i in 0..100000 { for j in 0..100000 { if i == j { sphere(1) } } }") ==
          "loop-limit");
    CHECK(answer("fn f() { var x = 0\n while true { x += 1 }\n x }\nsphere(f())") == "loop-limit");
    // of the point: neither the check nor the shader runs without bound
    CHECK(answer("fn f(p) {\n  var d = length(p)\n  for i in 0..1000 { for j in 0..1000 { for k in "
                 "0..1000 {\n"
                 "    d = sin(d + k)\n  } } }\n  d\n}\nimplicit(p => f(p), estimate: 3)") ==
          "loop-limit");
    CHECK(answer("sphere(1)" +
                 times(".repeat([2, 2, 2], [3, 3, 3], (s, id) => s.scale(1 + hash(id)))", 12)) ==
          "loop-limit");
    CHECK(answer("sphere(1).translate([1, 2, 3])" +
                 times(".mirror(X).mirror(Y).mirror(Z).rotate(1)", 12)) == "loop-limit");
}

TEST_CASE("a loop over shapes of many parts") {
    CHECK(answer("fn t(n) = if n == 0 { sphere(0.1) } else {\n  let s = t(n - 1).translate(y: n)\n"
                 "  s.rotate(0.3, axis: Z) | s.rotate(-0.3, axis: Z)\n}\n"
                 "for i in 0..100 { t(9).rotate(i * turn / 100) }") == "");
}

TEST_CASE("an error in each iteration of a long loop is said once") {
    CHECK(answer("for i in 0..100000 { sphere(sqrt(-1 - i)) }") == "number-range");
}

TEST_CASE("all that in bounded memory") {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    CHECK(use.ru_maxrss < 2'000'000); // kilobytes
}
