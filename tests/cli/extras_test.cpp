// What people expect of a command line beside its work: several files, differences, comparisons,
// reflection, completions.
#include "shell.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

namespace {

struct Extras : ScratchFolder {
    Extras() {
        write("good.sdf", "param r = 1 in 0.5..2 \"Radius\"\nsphere(r)\n");
        write("other.sdf", "box(2)\n");
        write("bad.sdf", "shpere(1)\n");
    }
};

std::size_t count(const std::string &text, const std::string &part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++found;
    return found;
}

} // namespace

TEST_CASE("several scenes are checked, and the worst decides") {
    Extras folder;
    const Result both = shell(folder, "fathom check good.sdf other.sdf");
    CHECK(both.exit == 0);
    CHECK((contains(both.err, "good.sdf: ok") && contains(both.err, "other.sdf: ok")));
    const Result bad = shell(folder, "fathom check bad.sdf good.sdf");
    CHECK(bad.exit == 1);
    CHECK(contains(bad.err, "good.sdf: ok"));
    CHECK(shell(folder, "fathom check good.sdf nowhere.sdf bad.sdf").exit == 3);
    const Result json = shell(folder, "fathom check --json good.sdf bad.sdf");
    CHECK(json.exit == 1);
    CHECK(count(json.out, "\n") == 2);
    CHECK(count(json.out, "\"ok\":") == 2);
    CHECK(shell(folder, "fathom check --watch good.sdf other.sdf").exit == 2);
    CHECK(shell(folder, "fathom check - - <good.sdf").exit == 2);
}

TEST_CASE("who asks for a document gets one, also of what cannot be read") {
    Extras folder;
    for (const char *asked : {"check --json", "measure --json", "mesh --json -o a.stl"})
        for (const char *file : {"bad.sdf", "nowhere.sdf"}) {
            const Result said = shell(folder, std::string("fathom ") + asked + " " + file);
            INFO(asked << " " << file << "\n" << said.out);
            CHECK(said.exit == (file[0] == 'b' ? 1 : 3));
            CHECK(count(said.out, "\n") == 1);
            CHECK(contains(said.out, "\"ok\":false"));
            CHECK(contains(said.out, "\"status\":null"));
        }
    folder.write("endless.sdf", "plane()\n");
    CHECK(contains(shell(folder, "fathom measure --json endless.sdf").out, "\"why\":"));
}

TEST_CASE("a misspelt option is told before what is missing") {
    Extras folder;
    CHECK(contains(shell(folder, "fathom mesh --tolerence 3 good.sdf").err,
                   "did you mean `--tolerance`?"));
    CHECK(contains(shell(folder, "fathom slice --section good.sdf").err, "`--section`"));
    CHECK(contains(shell(folder, "fathom mesh good.sdf").err, "-o"));
}

TEST_CASE("eval takes numbers as they are") {
    Extras folder;
    CHECK(shell(folder, "fathom eval other.sdf 3 0 0 -1 -.5 -2e0 --at 0,4,0").out ==
          "2 1 0 0\n1 0 0 -1\n3 0 1 0\n");
    CHECK(shell(folder, "fathom eval other.sdf 3 0").exit == 2);
    CHECK(shell(folder, "fathom eval other.sdf 3 0 x").exit == 2);
}

TEST_CASE("fmt --diff prints what `git apply` takes") {
    Extras folder;
    std::string text = "sphere( 1 )\n";
    for (int i = 0; i < 40; ++i) text += "let a" + std::to_string(i) + " = 1\n";
    text += "box( 2 )\n\n\n\n\nbox(3)";
    folder.write("long.sdf", text);
    const Result diff = shell(folder, "fathom fmt --diff long.sdf good.sdf");
    CHECK(diff.exit == 1);
    CHECK(folder.read("long.sdf") == text);
    CHECK(count(diff.out, "\n@@ ") == 2);
    CHECK_FALSE(contains(diff.out, "good.sdf"));
    shell(folder, "mkdir other; cp long.sdf other; fathom fmt --diff long.sdf >long.patch; "
                  "cd other; git apply -p0 ../long.patch; cd ..; fathom fmt long.sdf");
    CHECK(folder.read("long.sdf") != text);
    CHECK(folder.read("other/long.sdf") == folder.read("long.sdf"));
    const Result same = shell(folder, "fathom fmt --diff long.sdf");
    CHECK((same.exit == 0 && same.out.empty()));
    CHECK(shell(folder, "fathom fmt --diff --check long.sdf").exit == 2);
}

TEST_CASE("doc lists in groups, and searches") {
    Extras folder;
    const std::string all = shell(folder, "fathom doc").out;
    CHECK((contains(all, "\nsolids:\n") && contains(all, "  sphere ")));
    const std::string twisted = shell(folder, "fathom doc --search TWIST").out;
    CHECK((contains(twisted, "  twist ") && !contains(twisted, "  sphere ")));
    const std::string both = shell(folder, "fathom doc --search twist --search section").out;
    CHECK((!both.empty() && both.size() < twisted.size()));
    CHECK(shell(folder, "fathom doc --search qqqq").exit == 2);
    CHECK(shell(folder, "fathom doc sphere --search a").exit == 2);
}

TEST_CASE("bench writes what it can compare with") {
    Extras folder;
    CHECK(shell(folder, "fathom bench other.sdf --size 16x16 --json >old.json").exit == 0);
    CHECK(contains(folder.read("old.json"), "\"name\": \"prove\""));
    const Result compared = shell(folder, "fathom bench other.sdf --size 16x16 --compare old.json");
    CHECK(compared.exit == 0);
    CHECK(contains(compared.out, ", x 1\n")); // the steps of a ray are the same
    CHECK(shell(folder, "fathom bench other.sdf --compare good.sdf").exit == 3);
    CHECK(shell(folder, "fathom bench other.sdf --compare nowhere.json").exit == 3);
    CHECK(shell(folder, "fathom bench other.sdf --json --compare old.json").exit == 2);
}

TEST_CASE("compile --reflect says what a host binds") {
    Extras folder;
    const Result made =
        shell(folder, "fathom compile good.sdf --target es300 -o a.frag --reflect a.json");
    CHECK(made.exit == 0);
    const std::string json = folder.read("a.json"), text = folder.read("a.frag");
    CHECK(count(json, "{\"name\":") == count(text, "\nuniform "));
    CHECK(contains(json, "{\"name\": \"param_r\", \"type\": \"float\", \"default\": [1], "
                         "\"param\": \"r\", \"label\": \"Radius\", \"color\": false, "
                         "\"range\": [[0.5], [2]]}"));
    CHECK(shell(folder, "fathom compile good.sdf -o a.frag --reflect a.frag").exit == 2);
    CHECK(shell(folder, "fathom compile good.sdf --reflect -").exit == 2);
    CHECK(shell(folder, "fathom compile good.sdf -o b.frag --reflect good.sdf").exit == 2);
    const std::string out = shell(folder, "fathom compile good.sdf -o c.frag --reflect -").out;
    CHECK(out.starts_with("{"));
}

TEST_CASE("the version has a short option") {
    Extras folder;
    CHECK(shell(folder, "fathom -V").out == shell(folder, "fathom --version").out);
}

TEST_CASE("bash completes commands, options, their words and files") {
    Extras folder;
    const auto completed = [&](const std::string &words, int at) {
        return shell(folder, "fathom help --as bash >words; bash -c '. ./words; COMP_WORDS=(" +
                                 words + "); COMP_CWORD=" + std::to_string(at) +
                                 "; _fathom; echo \"${COMPREPLY[*]}\"'")
            .out;
    };
    CHECK(completed("fathom ren", 1) == "render\n");
    CHECK(completed("fathom check --expl", 2) == "--explain\n");
    CHECK(completed("fathom compile good.sdf --target es", 4) == "es300\n");
    CHECK(completed("fathom check goo", 2) == "good.sdf\n");
    CHECK(completed("fathom help che", 2) == "check\n");
}

TEST_CASE("the manual page and each completion have all commands and options") {
    Extras folder;
    const std::string check = shell(folder, "fathom help check").out;
    REQUIRE(contains(check, "--strict-proof"));
    const std::string man = shell(folder, "fathom help --as man").out;
    CHECK((contains(man, ".SS fathom check\n") && contains(man, "\\-\\-strict\\-proof")));
    CHECK(contains(shell(folder, "fathom help --as zsh").out, "'--strict-proof["));
    CHECK(contains(shell(folder, "fathom help --as fish").out, "-l strict-proof"));
    for (const char *form : {"bash", "zsh", "fish"})
        CHECK(contains(shell(folder, std::string("fathom help --as ") + form).out, "bench"));
    CHECK(shell(folder, "fathom help --as fish check").exit == 2);
    // No line is taken for a request by accident.
    std::istringstream lines(man);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(".") || line.starts_with("'"))
            CHECK((line.starts_with(".TH ") || line.starts_with(".S") || line.starts_with(".TP") ||
                   line.starts_with(".B ") || line.starts_with(".I ")));
}

TEST_CASE("a value outside its range is told with the range as it is written") {
    const ScratchFolder folder;
    folder.write("turned.sdf",
                 "param turn = 30deg in -90deg..90deg\nbox([1, 1, 2]).rotate(turn)\n");
    const auto turned = shell(folder, "fathom check turned.sdf -D turn=95");
    CHECK(turned.exit == 2);
    CHECK(contains(turned.err, "range -90deg..90deg; 95 without a unit are radians"));
    CHECK(shell(folder, "fathom check turned.sdf -D turn=85deg").exit == 0);
}
