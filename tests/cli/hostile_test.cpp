// Scenes from a stranger: each is answered within 10 s of processor time and 1 GB, by a program that
// ends by itself. And honest ones that are large, which have to pass. What they cost is counted by the
// program (base/limits.h), and so the same everywhere; a machine that does other work beside takes
// several times as long for it, so every test run allows 40 s, and the weekly one 10.
#include "base/limits.h"
#include "base/picture.h"
#include "tests/cli/shell.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <functional>
#include <sys/resource.h>
#include <unistd.h>

using namespace fathom;

namespace {

double most_seconds() { return test::effort(1) == 1 ? 40 : 10; }

struct Cost {
    int exit = -1; // below 0: ended by that signal
    double seconds = 0, mebibytes = 0;
    std::string words;
};

// `fathom COMMAND` of a text, in a process of its own. The limits of the system are far off: they are
// there for a program that would not end.
Cost run_alone(std::vector<std::string> command, const std::string &text,
               std::size_t address_space = std::size_t{8} << 30, const ScratchFolder &folder = {}) {
    folder.write("scene.sdf", text);
    const std::string words = (folder.path() / "words").string();
    command.insert(command.begin(), "fathom");
    command.insert(command.begin() + 2, (folder.path() / "scene.sdf").string());
    std::vector<char *> arguments;
    for (std::string &word : command) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const rlimit processor{80, 80}, memory{address_space, address_space};
        setrlimit(RLIMIT_CPU, &processor);
        setrlimit(RLIMIT_AS, &memory);
        const int out = open(words.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(out, STDERR_FILENO);
        execv(FATHOM_PROGRAM, arguments.data());
        _exit(127);
    }
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    const auto seconds = [](const timeval &t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
            seconds(used.ru_utime) + seconds(used.ru_stime), double(used.ru_maxrss) / 1024,
            folder.read("words")};
}

Cost check_alone(const std::string &text, std::size_t address_space = std::size_t{8} << 30,
                 const ScratchFolder &folder = {}) {
    return run_alone({"check"}, text, address_space, folder);
}

std::string times(const std::string &text, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += text;
    return out;
}

std::string lines(int count, const std::function<std::string(int)> &line) {
    std::string text;
    for (int i = 0; i < count; ++i) text += line(i) + "\n";
    return text;
}

std::string field_of(const std::string &body, const char *claim) {
    return "implicit(p => {\n  var s = p.y\n" + body + "  length(p) - 1 + 0.0000001 * s\n}" +
           claim + ")\n";
}

std::string shared_lists(const std::string &leaf, const std::string &use) {
    std::string text = "let a0 = [" + leaf + ", " + leaf + "]\n";
    text +=
        lines(40, [](int i) { return fmt::format("let a{} = [a{}, a{}, a{}]", i + 1, i, i, i); });
    return text + use + "\nsphere(1)\n";
}

struct Hostile {
    const char *what, *code; // of the one error; empty: the scene is cheap after all
    std::string text;
    bool often = true; // false: one that stands beside it is nearly the same; weekly
};

std::vector<Hostile> hostile_scenes() {
    const std::string twice = "fn d(s, n) = if n == 0 { s } else { d(s + s, n - 1) }\n";
    const std::string loops = "  for i in 0..900 {\n    for j in 0..900 {\n"
                              "      s = s + sin(i * p.x + j)\n    }\n  }\n";
    const auto ifs = [](const char *otherwise) {
        return lines(3000, [&](int i) {
            return fmt::format("  if p.x > {} {{ s = s + {}.5 }} {}", i, i, otherwise);
        });
    };
    return {
        {"a string, doubled", "memory-limit",
         twice + "print(len(d(\"abcdefgh\", 40)))\nsphere(1)\n"},
        {"many long strings", "memory-limit",
         twice + "let l = map(0..1000, i => d(\"abcdefgh\", 20))\nsphere(1)\n"},
        {"a string that grows", "memory-limit",
         "print(len(fold(0..1000000, \"\", (s, i) => s + \"abcdefghijklmn\")))\nsphere(1)\n"},
        {"a list, doubled", "loop-limit",
         "fn d(l, n) = if n == 0 { l } else { d(concat(l, l), n - 1) }\n"
         "print(len(d([1, 2, 3, 4, 5], 40)))\nsphere(1)\n"},
        {"shared lists, not used", "", shared_lists("\"x\"", "")},
        {"shared lists, printed", "", shared_lists("\"x\"", "print(a40)")},
        {"shared lists, in a string", "", shared_lists("\"x\"", "print(len(\"x\" + a40))")},
        {"shared lists, given to a function", "",
         shared_lists("1.5", "fn f(l) = 1\nimplicit(p => length(p) - f(a40))")},
        {"shared lists of shapes", "loop-limit", shared_lists("sphere(1)", "a40")},
        {"lists in lists", "recursion-limit",
         "print(fold(0..1000000, [], (l, i) => [l, 0, 0, 0, 0]))\nsphere(1)\n"},
        {"a region, doubled", "memory-limit",
         "fn d(r, n) = if n == 0 { r } else { d(r - r, n - 1) }\n"
         "gyroid(1, 0.1).within(d(ball(2), 40))\n"},
        {"a million shapes", "memory-limit",
         "let l = [for i in 0..1000000 { sphere(1 + i * 0.001) }]\nsphere(1)\n"},
        {"two million functions", "memory-limit",
         "let l = map(0..2000000, i => (x => x + i))\nsphere(1)\n"},
        {"loops in loops of a field", "proof-limit", field_of(loops, ""), false},
        {"loops in loops, claimed", "", field_of(loops, ", lipschitz: 5"), false},
        {"3,000 ifs", "proof-limit", field_of(ifs("else { s = s * 1.01 }"), "")},
        {"3,000 ifs, claimed", "proof-limit",
         field_of(ifs("else { s = s * 1.01 }"), ", lipschitz: 5"), false},
        {"fbm of many octaves", "bad-argument",
         "sphere(1).displace(p => fbm(p, octaves: 100000) * 0.1)\n"},
        {"4,000 unknown names", "unknown-name",
         lines(4000, [](int i) { return fmt::format("let known{}x = 1", i); }) +
             lines(4000, [](int i) { return fmt::format("unknown{}y(1)", i); })},
        {"10,000 functions", "loop-limit",
         lines(10000, [](int i) { return fmt::format("fn f{0}(p) = sin(p.x * {0})", i); }) +
             "implicit(p => length(p) - 1 + 0.0001 * (" +
             lines(10000, [](int i) { return fmt::format("f{}(p) +", i); }) +
             "0), lipschitz: 10)\n"}, // of 4,000 functions a shader is made
        {"1.5 million lines", "memory-limit", lines(1'500'000, [](int) { return "sphere(1)"; })},
        {"a loop without end", "loop-limit",
         "fn f() {\n  var i = 0\n  while i >= 0 limit 2000000000 { i = 1 }\n  i\n}\nsphere(f())\n"},
        {"a field's loop without end", "memory-limit",
         "implicit(p => {\n  var x = p.x\n  var i = 0\n  while i < 2000000000 limit 2000000000 {\n"
         "    i = i + 1\n    x = x * 0.5\n  }\n  length(p) - 1 + 0.1 * x\n})\n"},
        {"100,000 names in one block", "",
         "fn f() {\n" + lines(100'000, [](int i) { return fmt::format("  let a{} = 1", i); }) +
             "  a9\n}\nsphere(f())\n"},
        {"shapes in shapes", "recursion-limit",
         "fn f() {\n  var s = sphere(1)\n  for i in 0..100000 {\n"
         "    s = (s & box(i + 2)).translate([0.001, 0, 0])\n  }\n  s\n}\nf()\n"},
        {"a shape moved again and again", "recursion-limit",
         "fold(0..100000, sphere(1), (s, i) => s.translate(x: 0.001))\n"},
        {"cuts in one line", "", lines(20000, [](int) { return "sphere(1) -"; }) + "sphere(1)\n"},
        {"a union that grows by one", "loop-limit",
         "fold(0..100000, sphere(1), (s, i) => s | sphere(1).translate(x: i))\n"},
        {"mirrors of mirrors", "loop-limit", "fold(0..3000, sphere(1), (s, i) => s.mirror(X))\n"},
        {"60,000 shapes in one line", "", times("sphere(1); ", 60'000) + "\n"},
        {"a million files that are not there", "file-not-found",
         "for i in 0..1000000 { image(\"a.png\") }\nsphere(1)\n"},
        {"a million files that are not there, all others", "loop-limit",
         "for i in 0..1000000 { image(\"a\" + i + \".png\") }\nsphere(1)\n"},
        {"a file's name of 32 MB", "file-not-found", twice + "image(d(\"a\", 25))\nsphere(1)\n"},
        {"70 messages of 8 MB", "",
         twice + "let s = d(\"abcdefgh\", 20)\n" + lines(70, [](int) { return "print(s)"; }) +
             "sphere(1)\n"},
        {"many arguments of many params", "proof-limit",
         lines(2000, [](int i) { return fmt::format("param a{} = 1 in 0..2", i); }) + "let r = " +
             lines(2000, [](int i) { return fmt::format("a{} +", i); }) + "1\nunion {\n" +
             lines(1500, [](int i) { return fmt::format("  sphere(r - {})", i); }) + "}\n"},
        {"a field of 700,000 terms", "memory-limit",
         "implicit(p => fold([for i in 0..8000 { i }], 0.0, (a, i) => a" +
             lines(90, [](int k) { return fmt::format(" + sin({} * p.x + i)", k); }) +
             "), lipschitz: 1e9, within: ball(1))\n"},
        {"a default that calls itself", "recursion-limit", "fn f(x = f()) = x\nsphere(f())\n"},
    };
}

} // namespace

TEST_CASE("each hostile scene is answered within a bound of processor time and 1 GB") {
    for (const Hostile &scene : hostile_scenes()) {
        if (!scene.often && test::effort(1) == 1) continue;
        const Cost cost = check_alone(scene.text);
        INFO(scene.what << ": " << cost.words.substr(0, 500));
        CHECK(cost.exit == (*scene.code ? 1 : 0));
        if (*scene.code) CHECK(contains(cost.words, fmt::format("error[{}]", scene.code)));
        CHECK(cost.seconds < most_seconds());
        CHECK(cost.mebibytes < 1000);
    }
}

TEST_CASE("what is made of a scene that is small by sharing is bounded, too") {
    const std::string shared =
        "fn d(s, n) = if n == 0 { s } else { d(s | s.translate(x: 1), n - 1) "
        "}\nd(sphere(1), 19)\n";
    const Cost exported = run_alone({"export", "-o", "/dev/null"}, shared);
    INFO(exported.words.substr(0, 500));
    CHECK(exported.exit == 1);
    CHECK(contains(exported.words, "error[memory-limit]: this export"));
    CHECK(exported.seconds < most_seconds());
    CHECK(exported.mebibytes < 1000);
}

TEST_CASE("numbers that stand twice in the next ones are looked at once") {
    // What is walked as a tree is 2^40 nodes large.
    struct Chain {
        const char *first, *next, *last;
        bool often = true; // false: weekly
    };
    const Chain chains[] = {
        {"p.x", "c - 0.5 * floor(c) + 0.2 * fract(c)", "c"},
        {"p.x", "c - round(c) + 0.1 * c * p.y", "c", false},
        {"p.x", "sign(c) * sqrt(abs(c))", "c"},
        {"p.x", "0.5 * (c % 1) + 0.5 * c", "c", false},
        {"p.x", "hash(floor(c)) * 0.1 + c * 0.3", "c", false},
        {"p", "fract(c) - 0.5 * c", "length(c)"},
        {"p", "c - 2 * round(c / 2)", "length(c)", false},
        {"p", "[length(c.xy), atan(c.y, c.x), c.z]", "length(c)", false},
        {"p", "c * c + c", "length(c)", false},
        {"p", "(-1 + 2 * fract(0.5 * c + 0.5)) / dot(c, c)", "length(c)"},
        {"int(floor(2 * p.x)) + int(round(p.y))", "c * c - c", "float(c)"},
        {"int(floor(2 * p.x)) + int(round(p.y))", "c + c", "float(c)"},
        {"atan(p.y, p.x)", "atan(sin(c), cos(c)) + 0.1 * c", "c", false},
        {"p.x > 0", "c and (p.y > 0 or c)", "float(c)"},
        {"p.x > 0", "not c or (c and p.z > 0)", "float(c)"},
        {"sign(p.x) + sign(p.y)", "c * c - c", "c"},
        {"sign(p.x) + sign(p.y)", "if c > 1 { c - 1 } else { c }", "c"},
        {"p.x", "c * (1 + c)", "c", false},
        {"abs(p.x) + 1", "sqrt(c * c + c * c)", "c", false},
        {"p.x", "max(c, max(c - 0.1, 0.5 * c))", "c", false},
    };
    for (const Chain &chain : chains) {
        if (!chain.often && test::effort(1) == 1) continue;
        const Cost cost = check_alone(
            fmt::format("implicit(p => {{\n  var c = {}\n", chain.first) +
            lines(40, [&](int) { return fmt::format("  c = {}", chain.next); }) +
            fmt::format("  length(p) - 1 + 0.1 * {}\n}}, within: ball(2))\n", chain.last));
        INFO(chain.next << ": " << cost.words.substr(0, 500));
        CHECK((cost.exit == 0 || cost.exit == 1));
        CHECK(cost.seconds < most_seconds());
        CHECK(cost.mebibytes < 1000);
    }
}

TEST_CASE("an image counts once, however its name is spelled") {
    ScratchFolder folder;
    const int side = 2048;
    folder.write("img/a.png", encode_png({side, side, std::vector<std::uint8_t>(4 * side * side)}));
    const auto spelled = [](int i) {
        std::string way = i % 2 ? "img/" : "./img/";
        for (int k = 0; k < i; ++k) way += "./";
        return way + "a.png";
    };
    const Cost cost = check_alone(
        lines(40, [&](int i) { return fmt::format("let i{} = image(\"{}\")", i, spelled(i)); }) +
            "sphere(1)\n",
        std::size_t{8} << 30, folder);
    INFO(cost.words);
    CHECK(cost.exit == 0);
    CHECK(cost.mebibytes < 300);
    CHECK(cost.seconds < most_seconds());
    // … and others are others
    for (int i = 0; i < 16; ++i)
        fs::copy_file(folder / "img/a.png", folder / ("img/" + std::to_string(i) + ".png"));
    const Cost many = check_alone(
        lines(16, [&](int i) { return fmt::format("let i{0} = image(\"img/{0}.png\")", i); }) +
            "sphere(1)\n",
        std::size_t{8} << 30, folder);
    CHECK(many.exit == 1);
    CHECK(contains(many.words, "error[memory-limit]"));
    CHECK(many.mebibytes < 1000);
}

TEST_CASE("a text of more than 16 MiB is refused with a word") {
    const Cost cost = check_alone(std::string((std::size_t{16} << 20) + 1, ' '));
    CHECK(cost.exit == 3);
    CHECK(contains(cost.words, "larger than 16 MiB"));
}

TEST_CASE("evaluation goes as deep as the stack that the system grants") {
    for (const std::size_t mebibytes : {150u, 300u, 1000u, 3000u}) {
        INFO(mebibytes);
        for (const char *text :
             {"fn f(x = f()) = x\nsphere(f())\n", "fn f(x) = f(x + 1)\nsphere(f(0))\n",
              "fn f(n) = if n == 0 { 0 } else { f(n - 1) }\nsphere(1 + f(900))\n"}) {
            const Cost cost = check_alone(text, mebibytes << 20);
            INFO(text << cost.words);
            const bool good = cost.exit == 0 || contains(cost.words, "error[recursion-limit]");
            CHECK(good);
        }
    }
}

TEST_CASE("where the system gives no memory there is an error, and no fault") {
    const Cost cost =
        check_alone("let l = map(0..2000000, i => i)\nsphere(1)\n", std::size_t{260} << 20);
    INFO(cost.words);
    CHECK(cost.exit == 1);
    CHECK(contains(cost.words, "error[memory-limit]"));
}

TEST_CASE("honest scenes pass, however large") {
    const auto passes = [](const std::string &text) {
        const Cost cost = check_alone(text);
        INFO(cost.words.substr(0, 500));
        CHECK(cost.exit == 0);
        CHECK(cost.seconds < 30);
        CHECK(cost.mebibytes < 1200);
    };
    passes(lines(10'000, [](int i) {
        const std::string at = fmt::format(".rotate({}deg).translate([{}, {}, {}])", i % 360,
                                           i % 100, i / 100, i % 13);
        switch (i % 4) {
        case 0: return fmt::format("sphere({})", 0.1 + i * 1e-5) + at;
        case 1: return fmt::format("box([{}, 0.2, {}])", 0.1 + i * 1e-5, 0.3 + i % 11 * 0.1) + at;
        case 2: return fmt::format("torus(0.4, {})", 0.05 + i * 1e-6) + at;
        case 3: return fmt::format("cylinder({}, {})", 0.1 + i % 5 * 0.01, 1 + i * 1e-4) + at;
        }
        return at;
    }));
    passes("for i in 0..100000 {\n  sphere(0.1 + random(i) * 0.2)"
           ".translate([i % 100, random(i, 2) * 100, floor(i / 1000)])\n}\n");
    // Each of another size, at a place of three random numbers.
    const std::string placed =
        "for i in 0..100000 {\n  box(0.3 + 0.2 * hash([i, 4])).translate(vec3("
        "hash([i, 1]) - 0.5, hash([i, 2]) - 0.5, hash([i, 3]) - 0.5) * 111)"
        "\n}\n";
    if (test::effort(1) > 1) passes(placed);
    passes("smooth_union(0.2) {\n" + placed + "}\n");
    // Fields of one's own whose bounds are far above what is true: more work would lower them.
    passes("fn rope(p: vec3, k: float) -> float {\n  let c = cos(k * p.y)\n  let s = sin(k * p.y)\n"
           "  length(abs(mat2([c, s], [-s, c]) * p.xz) - 0.15) - 0.14\n}\n" +
           lines(40, [](int i) {
               return fmt::format("implicit(p => rope(p, {}), within: ball(2)).translate(x: {})",
                                  3 + 0.01 * i, 5 * i);
           }));
}

TEST_CASE("an option raises each limit, and a wrong word for one is told") {
    ScratchFolder folder;
    folder.write("work.sdf", "let n = fold(0..3000, 0, (a, b) => a + b)\nsphere(1)\n");
    CHECK(shell(folder, "fathom check work.sdf").exit == 0);
    const Result little = shell(folder, "fathom check work.sdf --limit work=1000");
    CHECK(little.exit == 1);
    CHECK(contains(little.err, "the limit `work` is 1000 steps"));
    CHECK(contains(little.err, "`--limit work=2000` allows twice as much"));
    CHECK(shell(folder, "fathom check work.sdf --limit work=1000 --limit work=1000000").exit == 0);
    for (const LimitRow &row : limit_rows()) {
        INFO(row.name);
        CHECK(shell(folder, fmt::format("fathom check work.sdf --limit {}={}", row.name, row.usual))
                  .exit == 0);
        CHECK(shell(folder, fmt::format("fathom check work.sdf --limit {}=0", row.name)).exit == 2);
    }
    const Result unknown = shell(folder, "fathom check work.sdf --limit wrok=5");
    CHECK(unknown.exit == 2);
    CHECK(contains(unknown.err, "did you mean `work`?"));
    CHECK(shell(folder, "fathom check work.sdf --limit work").exit == 2);
    CHECK(shell(folder, "fathom check work.sdf --limit work=many").exit == 2);
}

TEST_CASE("texts and fields are the same of every processor") {
    const ScratchFolder folder;
    const std::string masked =
        "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX '" FATHOM_PROGRAM "'";
    int scenes = 0;
    for (const fs::directory_entry &entry : fs::directory_iterator(FATHOM_SOURCE_DIR "/examples")) {
        if (entry.path().extension() != ".sdf" || ++scenes % 4 != 0) continue; // every fourth
        const std::string scene = entry.path().string();
        for (const std::string &what :
             {"compile '" + scene + "'",
              "eval '" + scene + "' --at 0.3,0.4,0.5 --at -1.1,0.2,0.7"}) {
            INFO(what);
            const Result here = shell(folder, "fathom " + what);
            CHECK(here.exit == 0);
            CHECK(shell(folder, masked + " " + what).out == here.out);
        }
    }
    CHECK(scenes >= 40);
}
