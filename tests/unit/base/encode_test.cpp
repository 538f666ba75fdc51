// Text from outside in each of the places that it is written to. What no text may do there:
// tests/property/outside.cpp.
#include "base/encode.h"

#include <catch2/catch.hpp>

using namespace fathom;

TEST_CASE("on a terminal nothing steers it") {
    CHECK(for_terminal("a\x1b[31mb") == "a\uFFFD[31mb");
    CHECK(for_terminal("a\u202Eb\u2066") == "a\uFFFDb\uFFFD");
    CHECK(for_terminal("a\tb\nc") == "a b c");
    CHECK(for_terminal("\u0085\u2028\x7f\xff") == "\uFFFD\uFFFD\uFFFD\uFFFD");
    CHECK(for_terminal("Säule 漢 😀") == "Säule 漢 😀");
}

TEST_CASE("a comment is neither ended nor continued") {
    CHECK(for_comment("x\nfloat evil;") == "x float evil;");
    CHECK(for_comment("x\r\u2028y") == "x\uFFFD\uFFFDy");
    CHECK(for_comment(std::string_view("a\0b", 3)) == "a\uFFFDb");
    CHECK(for_comment("at the end \\") == "at the end \uFFFD");
    CHECK(for_comment("a */ b **/ /* // c") == "a *\uFFFD b **\uFFFD /* // c");
    CHECK(for_comment("*\\/") == "*\uFFFD/");
    CHECK(for_comment("a/b.sdf:3") == "a/b.sdf:3");
}

TEST_CASE("HTML shows text as it is") {
    CHECK(for_html("<b> & \"c\" 'd'") == "&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
    CHECK(for_html(std::string_view("\0\x1b", 2)) == "\uFFFD\uFFFD");
}

TEST_CASE("JSON strings are escaped, and bad UTF-8 replaced") {
    CHECK(for_json("a\"b\\c\n\t\x01") == R"("a\"b\\c\n\t\u0001")");
    CHECK(for_json("dé漢") == "\"dé漢\"");
    CHECK(for_json("\xff\xc3") == "\"\uFFFD\uFFFD\"");
    CHECK(for_json(std::string_view("\0", 1)) == R"("\u0000")");
    CHECK(for_json("\u009b\u2028") == R"("\u009b\u2028")");
    CHECK(for_json("a < b") == R"("a < b")");
}

TEST_CASE("a script's string begins no tag and no comment") {
    CHECK(for_script("<!--<script>") == R"("\u003c!--\u003cscript>")");
    CHECK(for_script("</script>") == R"("\u003c/script>")");
    CHECK(for_script("\\\"\n") == R"("\\\"\n")");
}

TEST_CASE("a YAML scalar is quoted singly, or doubly where it needs escapes") {
    CHECK(for_yaml("it's: #1") == "'it''s: #1'");
    CHECK(for_yaml("a\nb\"\\") == R"("a\nb\"\\")");
    CHECK(for_yaml("\u0085\u2028\ufeff") == R"("\x85\u2028\uFEFF")");
    CHECK(for_yaml("") == "''");
}
