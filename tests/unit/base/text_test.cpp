// Numbers, UTF-8 and JSON text; lines and columns; near names.
#include "base/source.h"
#include "base/suggest.h"
#include "base/text.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace fathom;

TEST_CASE("numbers are written in their shortest form and read back equal") {
    CHECK(format_shortest(0.1) == "0.1");
    CHECK(format_shortest(1e30) == "1e+30");
    CHECK(format_shortest(0.1f) == "0.1");
    for (const double x :
         {0.1, 1.0 / 3, -2.5e-300, std::numeric_limits<double>::denorm_min(), 12345678.9})
        CHECK(parse_number(format_shortest(x)) == x);
}

TEST_CASE("a number is the whole text or nothing") {
    CHECK(parse_number("2.5") == 2.5);
    CHECK(parse_number("-1e-3") == -0.001);
    CHECK(parse_number("0e999") == 0);
    CHECK(parse_number("-inf") == -std::numeric_limits<double>::infinity());
    for (const char *text :
         {"", " 1", "1 ", "1,5", "1x", "+1", "0x10", "1e999", "-1e999", "1e-999"})
        CHECK_FALSE(parse_number(text));
}

TEST_CASE("decoding refuses what is not UTF-8 and always moves on") {
    CHECK(decode_utf8("é", 0).value == 0xE9);
    CHECK(decode_utf8("😀", 0).length == 4);
    for (const char *bad :
         {"\xC0\x80", "\xED\xA0\x80", "\xF5\x80\x80\x80", "\xE2\x82", "\x80", "\xFE"}) {
        const CodePoint c = decode_utf8(bad, 0);
        CHECK_FALSE(c.valid);
        CHECK(c.length == 1);
    }
}

TEST_CASE("columns of code points, and texts cut between them") {
    CHECK(display_width('a') == 1);
    CHECK(display_width(0x6F22) == 2);
    CHECK(display_width(0x0301) == 0);
    CHECK(cut("abc", 3) == "abc");
    CHECK(cut("a漢c", 3) == "a");
    CHECK(cut("漢", 2) == "");
    CHECK(cut("\x80\x80", 1) == "");
    CHECK(shortened("abcdef", 6) == "abcdef");
    CHECK(shortened("abcdefg", 6) == "abc…");
    CHECK(shortened("a漢c漢", 6) == "a…");
    CHECK(shortened("abc", 2) == "");
    std::string name;
    for (int i = 0; i < 80; ++i) name += "漢";
    CHECK(short_name(name) == name);
    CHECK(short_name(name + "x") == name + "…");
}

TEST_CASE("positions count lines and code points from 1") {
    Sources sources;
    const SourceId id = sources.add("a.sdf", "ab\r\né漢x\n\nlast");
    const Source &source = sources[id];
    const auto at = [&](std::uint32_t offset) {
        const Position p = position(source, offset);
        return std::pair(p.line, p.column);
    };
    CHECK(at(0) == std::pair(1u, 1u));
    CHECK(at(4) == std::pair(2u, 1u));
    CHECK(at(6) == std::pair(2u, 2u));  // 漢
    CHECK(at(9) == std::pair(2u, 3u));  // x
    CHECK(at(11) == std::pair(3u, 1u)); // the empty line
    CHECK(at(99) == std::pair(4u, 5u)); // behind the end
    CHECK(line_text(source, 1) == "ab");
    CHECK(line_text(source, 2) == "é漢x");
    CHECK(line_text(source, 3).empty());
    CHECK(line_text(source, 4) == "last");
    CHECK(line_text(source, 5).empty());
    CHECK(text(sources, {id, 0, 2}) == "ab");
    CHECK(text(sources, Span{}).empty());
}

TEST_CASE("a column is found without reading its line from the begin") {
    std::string long_line = "first\n";
    for (int i = 0; i < 400; ++i) long_line += "aé漢😀\xff\xe2\x82";
    Sources sources;
    const Source &source = sources[sources.add("a.sdf", long_line + "\nlast 漢")];
    std::uint32_t begin = 0, line = 1, column = 1;
    for (std::uint32_t at = 0; at < source.text.size(); ++at) {
        const std::uint32_t end = begin + decode_utf8(source.text, begin).length;
        if (at == end) {
            ++column;
            if (source.text[begin] == '\n') ++line, column = 1;
            begin = end;
        }
        const Position found = position(source, at);
        if (found.line != line || found.column != column) // a check for each would be slow
            FAIL(at << ": " << found.line << ":" << found.column);
    }
    // … and no search is long: what is decoded begins at most a milestone before
    REQUIRE(source.milestones.size() >= long_line.size() / 260);
    for (std::size_t i = 1; i < source.milestones.size(); ++i)
        CHECK(source.milestones[i].offset - source.milestones[i - 1].offset <= 259);
    CHECK(sources[sources.add("b.sdf", "short\nlines\n")].milestones.empty());
}

TEST_CASE("near names are those within a third of the word") {
    const std::vector<std::string> names = {"sphere", "cylinder", "box", "smooth_union", "x", "Y"};
    CHECK(nearest_name("spere", names) == "sphere");
    CHECK(nearest_name("shpere", names) == "sphere");
    CHECK(nearest_name("Sphere", names) == "sphere");
    CHECK(nearest_name("bx", names) == "box");
    CHECK(nearest_name("smoothunion", names) == "smooth_union");
    CHECK(nearest_name("smoo", names) == "smooth_union"); // the beginning of a name
    CHECK(nearest_name("sm", names).empty());             // two letters begin too many
    CHECK(nearest_name("y", names) == "Y");
    CHECK(nearest_name("z", names).empty());
    CHECK(nearest_name("i", {"pi"}).empty()); // a letter is no part of a word
    CHECK(nearest_name("cube", names).empty());
    CHECK(nearest_name("", names).empty());
    CHECK(nearest_name(std::string(1000000, 'a'), {std::string(1000000, 'b')}).empty());
    CHECK(edit_distance("ab", "ba") == 1);
    CHECK(edit_distance("kitten", "sitting") == 3);
}
