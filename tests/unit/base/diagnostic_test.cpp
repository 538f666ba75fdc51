// How diagnostics are collected and printed, as text and as JSON.
#include "base/diagnostic.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <set>

using namespace fathom;

namespace {

struct Fixture {
    Sources sources;
    SourceId id;
    Diagnostics diagnostics;

    explicit Fixture(std::string text) : id(sources.add("a.sdf", std::move(text))) {}
    Span span(std::string_view word, std::size_t from = 0) const {
        const auto begin = static_cast<std::uint32_t>(sources[id].text.find(word, from));
        return {id, begin, begin + static_cast<std::uint32_t>(word.size())};
    }
    std::string text() const { return to_text(diagnostics.items().at(0), sources, false); }
};

} // namespace

TEST_CASE("every code has one name, found again by it") {
    std::set<std::string_view> names;
    for (const Code code : all_codes()) {
        CHECK(code_by_name(code_name(code)) == code);
        CHECK_FALSE(code_summary(code).empty());
        CHECK(names.insert(code_name(code)).second);
    }
    CHECK_FALSE(code_by_name("no-such-code"));
}

TEST_CASE("a diagnostic shows its line, its labels and the line with its fix") {
    Fixture f("// two\nsphere(radius: 1, radius: 2)\n");
    f.diagnostics.add(Code::DuplicateArgument, f.span("radius", 20), "`radius` is given twice")
        .label(f.span("radius"), "first given here")
        .note("each argument has one value")
        .help("remove it", {{f.span(", radius: 2"), ""}});
    CHECK(f.text() == R"(a.sdf:2:19: error[duplicate-argument]: `radius` is given twice
  |
2 | sphere(radius: 1, radius: 2)
  |        ------     ^^^^^^
  |        |
  |        first given here
  |
  = note: each argument has one value
  = help: remove it
  |
2 | sphere(radius: 1)
)");
}

TEST_CASE("a place of several lines is marked where it begins and ends") {
    Fixture f("union {\n  1\n  2\n}\n");
    f.diagnostics.add(Code::TypeMismatch, f.span("{\n  1\n  2\n}"), "numbers").primary.message =
        "here";
    CHECK(f.text() == R"(a.sdf:1:7: error[type-mismatch]: numbers
  |
1 | union {
  |       ^
...
4 | }
  | ^ here
)");
}

TEST_CASE("tabs and wide letters keep the underline in place") {
    Fixture f("\tlet 漢 = spere(1)\n");
    f.diagnostics.add(Code::UnknownName, f.span("spere"), "no `spere`")
        .help("write `sphere`", {{f.span("spere"), "sphere"}});
    CHECK(f.text() == R"(a.sdf:1:10: error[unknown-name]: no `spere`
  |
1 |     let 漢 = spere(1)
  |              ^^^^^
  |
  = help: write `sphere`
  |
1 |     let 漢 = sphere(1)
  |              ~~~~~~
)");
}

TEST_CASE("a long line is cut around the place") {
    Fixture f(std::string(1000000, 'a') + " here " + std::string(1000000, 'b'));
    f.diagnostics.add(Code::SyntaxError, f.span("here"), "no");
    const std::string text = f.text();
    CHECK(text.size() < 500);
    CHECK(text.find("aaa here bbb") != std::string::npos);
    CHECK(text.find("a.sdf:1:1000002:") == 0);
}

TEST_CASE("any bytes can be shown") {
    std::string bytes;
    for (int i = 0; i < 256; ++i) bytes.push_back(static_cast<char>(i));
    for (std::uint32_t begin = 0; begin <= 256; ++begin) {
        for (const std::uint32_t end : {begin, begin + 1, 256u, 300u}) {
            Fixture f(bytes);
            f.diagnostics.add(Code::BadCharacter, {f.id, begin, end}, "no")
                .label({f.id, end, begin}, "\x1b")
                .help("h", {{{f.id, begin, end}, "x"}});
            const std::string text = f.text();
            CHECK(text.find('\x1b') == std::string::npos);
            CHECK_FALSE(to_json(f.diagnostics.items()[0], f.sources).empty());
        }
    }
}

TEST_CASE("a label in another file names it") {
    Fixture f("import \"b.sdf\"\n");
    const SourceId other = f.sources.add("b.sdf", "\nlet a = 1\n");
    f.diagnostics.add(Code::ImportCycle, f.span("\"b.sdf\""), "a cycle")
        .label({other, 5, 6}, "back to here");
    CHECK(f.text() == R"(a.sdf:1:8: error[import-cycle]: a cycle
  |
1 | import "b.sdf"
  |        ^^^^^^^
  ::: b.sdf:2:5
  |
2 | let a = 1
  |     - back to here
)");
}

TEST_CASE("a diagnostic without a place has only its words") {
    Fixture f("");
    f.diagnostics.add(Code::EmptyScene, Span{}, "no shape").note("write `sphere(1)`");
    CHECK(f.text() == "error[empty-scene]: no shape\n  = note: write `sphere(1)`\n");
}

TEST_CASE("JSON has the fields that editors read") {
    Fixture f("é = spere(1)\n");
    f.diagnostics.add(Code::UnknownName, f.span("spere"), "no \"spere\"")
        .label(f.span("1"), "one")
        .help("write `sphere`", {{f.span("spere"), "sphere"}});
    CHECK(json_text(to_json(f.diagnostics.items()[0], f.sources)) ==
          R"({"code":"unknown-name","severity":"error","message":"no \"spere\"","file":"a.sdf",)"
          R"("line":1,"column":5,"end_line":1,"end_column":10,"label":"","labels":[)"
          R"({"file":"a.sdf","line":1,"column":11,"end_line":1,"end_column":12,"message":"one"}],)"
          R"("notes":[],"fix":{"message":"write `sphere`","edits":[{"file":"a.sdf","line":1,)"
          R"("column":5,"end_line":1,"end_column":10,"replacement":"sphere"}]}})");
}

TEST_CASE("JSON is ASCII, and what is no UTF-8 is replaced in it") {
    const std::string text =
        json_text({{"a", "\xe2\x80\xae\xc3\xa9"}, {"b", "\xff"}, {"c", "\x1b[31m\x7f"}});
    CHECK(text == R"({"a":"\u202e\u00e9","b":"\ufffd","c":"\u001b[31m\u007f"})");
}

TEST_CASE("repeats are dropped, and the number kept is bounded") {
    Fixture f(std::string(1000, 'x'));
    f.diagnostics.add(Code::SyntaxError, {f.id, 0, 1}, "same");
    f.diagnostics.add(Code::SyntaxError, {f.id, 0, 1}, "same");
    CHECK(f.diagnostics.items().size() == 1);
    for (std::uint32_t i = 0; i < 1000; ++i)
        f.diagnostics.add(Code::Costly, {f.id, i, i + 1}, "costs");
    CHECK(f.diagnostics.dropped() > 0);
    CHECK(f.diagnostics.items().size() + f.diagnostics.dropped() == 1001);
    // An error is never lost behind remarks.
    f.diagnostics.add(Code::UnknownName, {f.id, 5, 6}, "an error").note("kept");
    CHECK(f.diagnostics.errors() == 2);
    CHECK(f.diagnostics.items().back().notes.size() == 1);
}

TEST_CASE("sorted by place") {
    Fixture f("abc");
    f.diagnostics.add(Code::SyntaxError, {f.id, 2, 3}, "c");
    f.diagnostics.add(Code::SyntaxError, {f.id, 0, 1}, "a");
    CHECK(f.diagnostics.sorted()[0].message == "a");
}

TEST_CASE("what is said is cut, each text and all together") {
    Fixture f("abc\n");
    const std::string much(8 << 20, 'x');
    const auto at = [&](std::uint32_t i) { return Span{f.id, i % 3, i % 3 + 1}; };
    const auto check_text = [](const std::string &text) {
        CHECK(text.size() == 2000);
        CHECK(text.ends_with("x…"));
    };
    f.diagnostics.add(Code::Printed, at(0), much)
        .label(at(1), much)
        .note(much)
        .help(much, {{at(0), much}});
    Diagnostic whole = f.diagnostics.items()[0];
    check_text(whole.message);
    check_text(whole.related[0].message);
    check_text(whole.notes[0]);
    check_text(whole.fix->message);
    CHECK(whole.fix->edits.empty()); // half an edit would be wrong
    // … also of one that was made elsewhere
    whole.message = whole.notes[0] = whole.primary.message = "y" + much;
    f.diagnostics.add(whole);
    check_text(f.diagnostics.items()[1].message);
    check_text(f.diagnostics.items()[1].primary.message);
    check_text(f.diagnostics.items()[1].notes[0]);

    std::size_t bytes = 0;
    for (std::uint32_t i = 0; i < 190; ++i) {
        Diagnostic &d = f.diagnostics.add(Code::Printed, at(i), std::to_string(i));
        for (int note = 0; note < 20; ++note) d.note(much);
    }
    for (const Diagnostic &d : f.diagnostics.items())
        for (const std::string &note : d.notes) bytes += note.size();
    CHECK(bytes < (std::size_t{1} << 20) + 50'000);
    CHECK(f.diagnostics.dropped() > 100);
    f.diagnostics.add(Code::UnknownName, at(0), "an error takes a remark's place");
    CHECK(f.diagnostics.items().back().code == Code::UnknownName);
}
