// Text from outside (names of files, labels, strings, -D, names in save files) changes nothing of
// what is emitted but comments and strings: GLSL of each target has the tokens that it has with
// harmless names, pages and JSON the same skeleton and the very strings, YAML the same tree,
// diagnostics the same lines. FATHOM_EFFORT=n tries n times as many random texts.
// Long: one list of nasty texts, against each reader.
#include "backend-glsl/emit.h"
#include "base/encode.h"
#include "base/text.h"
#include "driver/compile.h"
#include "driver/verdict.h"
#include "save-format/save_format.h"
#include "save-format/yaml_reader.h"
#include "save-format/yaml_writer.h"
#include "tests/support/effort.h"
#include "tests/unit/driver/scratch_folder.h"
#include "tests/unit/save/support.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include <cstdlib>
#include <fmt/format.h>
#include <random>

using namespace fathom;

namespace {

const std::vector<std::string> pieces = {"\n",
                                         "\r",
                                         "\r\n",
                                         std::string(1, '\0'),
                                         "\\",
                                         "\\\n",
                                         "\\\\",
                                         "\v",
                                         "\f",
                                         "\t",
                                         "\x1b[31m",
                                         "\x1b]0;t\x07",
                                         "\x7f",
                                         "\u0085",
                                         "\u2028",
                                         "\u2029",
                                         "\u202e",
                                         "\u2066",
                                         "\ufeff",
                                         "\uffff",
                                         "*/",
                                         "*",
                                         "/",
                                         "/*",
                                         "//",
                                         "?",
                                         "<",
                                         ">",
                                         "<!--",
                                         "-->",
                                         "<script>",
                                         "</script>",
                                         "</title>",
                                         "]]>",
                                         "&",
                                         "&lt;",
                                         "\"",
                                         "'",
                                         "`",
                                         "${x}",
                                         "{",
                                         "}",
                                         "{line}",
                                         "{file}",
                                         "#",
                                         " #",
                                         ": ",
                                         ":",
                                         "- ",
                                         "---\n",
                                         "...\n",
                                         "!!str",
                                         "&a",
                                         "*a",
                                         "%",
                                         "@",
                                         "|",
                                         "? ",
                                         ",",
                                         "[",
                                         "]",
                                         "~",
                                         "true",
                                         "1e3",
                                         "<<",
                                         "=",
                                         " ",
                                         "  ",
                                         "+call x()|",
                                         "-",
                                         "%s%n",
                                         "##",
                                         "$TITLE",
                                         "$FRAGMENT",
                                         "\xff",
                                         "\xc3",
                                         "\xed\xa0\x80",
                                         "é",
                                         "漢",
                                         "😀",
                                         "e\u0301",
                                         "float evil();",
                                         "#version 100",
                                         "a",
                                         "name",
                                         "0"};

// Those that have to be tried, then random ones.
std::vector<std::string> nasty_texts(std::size_t count) {
    std::vector<std::string> texts = {
        "x\nfloat evil() { return 1.0; }\n",
        "x\rfloat evil() { return 1.0; }\r",
        "x\\",
        "x\\\n",
        "x\\ ",
        "*/ float evil; /*",
        "/*",
        "<!--<script>",
        "</script><script>alert(1)</script>",
        "\"onload=\"x",
        "</title><b>",
        "\x1b]0;pwned\x07",
        "a: b #c\n- d",
        "+call system('touch pwned')|q",
        std::string("a\0b", 3),
        "\u2028float evil;",
        "line\u0085end",
        "\ufeffx",
        "##hidden",
        std::string(150, '\\'),
    };
    std::mt19937 random(17);
    while (texts.size() < count) {
        std::string text;
        for (std::size_t n = 1 + random() % 8; n > 0; --n) text += pieces[random() % pieces.size()];
        texts.push_back(text);
    }
    return texts;
}

std::string as_utf8(const std::string &text) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const CodePoint c = decode_utf8(text, i);
        append_utf8(out, c.value);
        i += c.length;
    }
    return out;
}

// A string of the language.
std::string in_source(const std::string &text) {
    std::string out = "\"";
    for (const char c : as_utf8(text)) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' ? std::string("\\n") : std::string(1, c);
    }
    return out + '"';
}

// The name of a file: all but `/` and NUL.
std::string as_file(std::string text) {
    std::erase(text, '/');
    std::erase(text, '\0');
    return std::string(cut(text, 200));
}

// How somebody may read a comment's end: a GLSL compiler at LF or CR, a preprocessor goes on behind
// a backslash, with blanks behind it too, JavaScript and old editors end lines at more.
struct Reading {
    bool every_line_end, joins_lines;
};
constexpr Reading readings[] = {{false, false}, {false, true}, {true, false}, {true, true}};

bool ends_line(std::string_view text, std::size_t at, Reading reading) {
    if (text[at] == '\n' || text[at] == '\r') return true;
    if (!reading.every_line_end) return false;
    const std::uint32_t c = decode_utf8(text, at).value;
    return c == '\v' || c == '\f' || c == 0 || c == 0x85 || c == 0x2028 || c == 0x2029;
}

// The text without its comments, and a line for each word.
std::string tokens(std::string_view text, Reading reading) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        if (text.substr(i, 2) == "//") {
            for (; i < text.size() && !ends_line(text, i, reading); ++i) {
                if (!reading.joins_lines || text[i] != '\\') continue;
                const std::size_t next = text.find_first_not_of(" \t", i + 1);
                if (next < text.size() && ends_line(text, next, reading)) i = next;
            }
        } else if (text.substr(i, 2) == "/*") {
            i = std::min(text.find("*/", i + 2), text.size() - 2) + 2;
        } else if (text[i] == ' ' || text[i] == '\n') {
            ++i;
            if (!out.ends_with('\n')) out += '\n';
        } else {
            out += text[i++];
        }
    }
    return out;
}

void check_same_tokens(const std::string &found, const std::string &wanted) {
    for (const Reading reading : readings) CHECK(tokens(found, reading) == tokens(wanted, reading));
    CHECK(std::ranges::count(found, '\n') == std::ranges::count(wanted, '\n'));
}

// JSON, or a script of ours: the strings, and the rest with `""` in their places. Nothing where a
// string is none.
struct Taken {
    std::string rest;
    std::vector<std::string> strings;
};
std::optional<Taken> take_strings(std::string_view text) {
    Taken taken;
    for (std::size_t i = 0; i < text.size(); ++i) {
        taken.rest += text[i];
        if (text[i] != '"') continue;
        std::string &value = taken.strings.emplace_back();
        for (++i; i < text.size() && text[i] != '"'; ++i) {
            if (static_cast<unsigned char>(text[i]) < 0x20) return std::nullopt;
            if (text[i] != '\\') {
                value += text[i];
                continue;
            }
            const std::size_t which = std::string_view("\"\\nrt").find(text[++i]);
            if (which != std::string_view::npos) {
                value += "\"\\\n\r\t"[which];
            } else if (text[i] == 'u' && i + 4 < text.size()) {
                append_utf8(value, static_cast<std::uint32_t>(std::stoul(
                                       std::string(text.substr(i + 1, 4)), nullptr, 16)));
                i += 4;
            } else {
                return std::nullopt;
            }
        }
        if (i == text.size()) return std::nullopt;
        taken.rest += '"';
    }
    return taken;
}

// Where a script element ends (HTML, 13.2.5.15 to 13.2.5.31): `<!--` and then `<script` hide the
// next
// `</script`.
std::size_t script_end(const std::string &page, std::size_t at) {
    const auto here = [&](std::string_view what) {
        return page.compare(at, what.size(), what) == 0;
    };
    bool comment = false, hidden = false;
    for (; at < page.size(); ++at) {
        if (here("<!--")) comment = true;
        if (here("-->")) comment = hidden = false;
        if (comment && here("<script")) hidden = true;
        if (!here("</script")) continue;
        if (!hidden) return at;
        hidden = false;
    }
    return page.size();
}

std::string between(const std::string &text, const std::string &begin, const std::string &end) {
    const std::size_t from = text.find(begin) + begin.size();
    REQUIRE(from != begin.size() - 1);
    return text.substr(from, text.find(end, from) - from);
}

std::string from_html(std::string text) {
    const std::pair<const char *, const char *> entities[] = {
        {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}};
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        bool found = false;
        for (const auto &[name, letter] : entities)
            if (text.compare(i, std::string_view(name).size(), name) == 0) {
                out += letter;
                i += std::string_view(name).size();
                found = true;
                break;
            }
        if (found) continue;
        CHECK(text[i] != '&');
        out += text[i++];
    }
    return out;
}

// A text that a page holds: base64 of what zlib compressed.
std::string unpacked(const std::string &base64) {
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : base64) {
        const std::size_t digit =
            std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
                .find(c);
        if (digit == std::string_view::npos) break;
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    std::string text(std::size_t{1} << 20, ' ');
    uLongf size = text.size();
    REQUIRE(uncompress(reinterpret_cast<Bytef *>(text.data()), &size,
                       reinterpret_cast<const Bytef *>(bytes.data()), bytes.size()) == Z_OK);
    text.resize(size);
    return text;
}

void check_page(const std::string &page, const std::string &wanted, const std::string &title,
                const std::string &label) {
    const auto parts = [](const std::string &text) {
        const std::string opening = "<script type=\"application/json\" id=\"fathom-scene\">";
        const std::size_t begin = text.find(opening) + opening.size();
        const std::size_t end = script_end(text, begin);
        return std::array<std::string, 3>{text.substr(0, begin), text.substr(begin, end - begin),
                                          text.substr(end)};
    };
    const auto found = parts(page), other = parts(wanted);
    CHECK(found[2] == other[2]);
    const std::string shown_title = for_terminal(title);
    CHECK(from_html(between(found[0], "<title>", "<")) == shown_title);
    CHECK(std::ranges::count(found[0], '<') == std::ranges::count(other[0], '<'));
    CHECK(std::ranges::count(found[0], '"') == std::ranges::count(other[0], '"'));
    const auto script = take_strings(found[1]), harmless = take_strings(other[1]);
    REQUIRE(script);
    REQUIRE(harmless);
    CHECK(script->rest == harmless->rest);
    REQUIRE(script->strings.size() == harmless->strings.size());
    std::size_t labels = 0;
    for (std::size_t i = 0; i < script->strings.size(); ++i) {
        if (harmless->strings[i] == "harmless") {
            CHECK(script->strings[i] == label);
            ++labels;
        } else if (harmless->strings[i] == "harmless_title") {
            CHECK(script->strings[i] == label); // the texts of a case are one
        } else if (i > 0 && harmless->strings[i - 1] == "packed") {
            check_same_tokens(unpacked(script->strings[i]), unpacked(harmless->strings[i]));
        } else {
            CHECK(script->strings[i] == harmless->strings[i]);
        }
    }
    CHECK(labels == 1);
}

driver::Compilation compile_named(const ScratchFolder &folder, const std::string &scene_name,
                                  const std::string &module_name, const std::string &label) {
    folder.write(module_name, "fn post(r: float) -> shape { cylinder(0.1 * r, 1).translate(x: 0.1) "
                              "| cylinder(0.2 * r, 0.1) }\n");
    const std::string text = "import " + in_source(module_name) +
                             " as m\nparam r = 1.0 in 0.5..2.0 " + in_source(label) + R"(
let c = cylinder(0.2, 1).twist(0.1, axis: X)
c | c.rotate(90deg, axis: Z) | c.rotate(30deg, axis: Y)
for i in 0..9 { m.post(r).rotate(i * turn / 9, axis: X) }
for i in 0..40 { sphere(0.1 + 0.001 * i).translate(y: i) }
sphere(1).displace(cached(p => 0.03 * r * fbm(2 * p, octaves: 6), cell: 0.05))
)";
    return driver::compile_text(scene_name, text, folder.path(), {});
}

std::vector<std::string> emitted(const driver::Compilation &compilation, glsl::Target target,
                                 const std::string &title) {
    glsl::Options options;
    options.target = target;
    options.title = title;
    options.place = [&](Span span) {
        if (!span.source) return std::string();
        const Source &source = compilation.sources[span.source];
        return fmt::format("{}:{}", source.name, position(source, span.begin).line);
    };
    Diagnostics diagnostics;
    std::vector<std::string> texts;
    const auto add = [&](const glsl::Output &output) {
        texts.push_back(output.text);
        for (const glsl::PruneKernel &kernel : output.pruning.kernels) texts.push_back(kernel.text);
        texts.push_back(output.pruning.far.text);
    };
    add(glsl::emit(compilation.scene, options, diagnostics));
    if (glsl::traits_of(target).form == glsl::Form::Page) return texts;
    options.field_only = true;
    add(glsl::emit(compilation.scene, options, diagnostics));
    options.field_only = false;
    if (glsl::traits_of(target).noise_cache) {
        options.noise_cache = true;
        add(glsl::emit(compilation.scene, options, diagnostics));
        texts.push_back(glsl::emit_cache_passes(compilation.scene, options, diagnostics).fill.text);
        options.noise_cache = false;
    }
    if (target == glsl::Target::Glsl330) {
        options.buffers = options.pruning = true;
        add(glsl::emit(compilation.scene, options, diagnostics));
    }
    INFO((diagnostics.items().empty() ? "" : diagnostics.items()[0].message));
    CHECK_FALSE(diagnostics.has_errors());
    return texts;
}

std::vector<glsl::Target> text_targets() {
    std::vector<glsl::Target> targets;
    for (const glsl::Target target : glsl::all_targets())
        if (glsl::traits_of(target).form != glsl::Form::SpirV) targets.push_back(target);
    return targets;
}

} // namespace

TEST_CASE("what a scene, a file or a label is called changes no token of a shader or a page") {
    const ScratchFolder folder;
    const driver::Compilation plain =
        compile_named(folder, "harmless.sdf", "harmless_module.sdf", "harmless");
    REQUIRE(plain.good());
    std::vector<std::vector<std::string>> wanted;
    const std::vector<glsl::Target> targets = text_targets();
    for (const glsl::Target target : targets)
        wanted.push_back(emitted(plain, target, "harmless_title"));
    for (const char *place : {", harmless.sdf:3\n", "/harmless_module.sdf:1\n",
                              "// harmless_title: ", "\n// harmless\n"}) {
        INFO(place);
        CHECK(wanted[0][0].find(place) != std::string::npos);
    }
    std::size_t next = 0;
    for (const std::string &text : nasty_texts(static_cast<std::size_t>(test::effort(28)))) {
        INFO(for_json(text));
        const std::string module_name = as_file(as_utf8(text)) + ".sdf";
        const std::string scene_name = as_file(text) + ".sdf";
        const driver::Compilation nasty = compile_named(folder, scene_name, module_name, text);
        INFO((nasty.diagnostics.items().empty()
                  ? ""
                  : to_text(nasty.diagnostics.items()[0], nasty.sources, false)));
        REQUIRE(nasty.good());
        // Each target with the first texts, that have to be tried; then each with some.
        for (std::size_t i = 0; i < targets.size(); ++i) {
            if (next >= 8 && i != next % targets.size()) continue;
            const auto texts = emitted(nasty, targets[i], text);
            REQUIRE(texts.size() == wanted[i].size());
            if (glsl::traits_of(targets[i]).form == glsl::Form::Page) {
                check_page(texts[0], wanted[i][0], text, as_utf8(text));
                continue;
            }
            for (std::size_t k = 0; k < texts.size(); ++k)
                check_same_tokens(texts[k], wanted[i][k]);
        }
        ++next;
    }
}

TEST_CASE("diagnostics of any names and texts are lines of their own alone, and JSON reads them") {
    const ScratchFolder folder;
    const auto compile = [&](const std::string &name, const std::string &text) {
        return driver::compile_text(name,
                                    "sphere(1)\nassert(1 > 2, " + in_source(text) + ")\nimport " +
                                        in_source("d" + text + "/nowhere") + "\n" + "image(" +
                                        in_source("d" + text + "/none.png") + ")\n",
                                    folder.path(), {});
    };
    const driver::Compilation plain = compile("harmless.sdf", "harmless");
    REQUIRE(plain.diagnostics.items().size() >= 3);
    const auto said = [](const driver::Compilation &compilation) {
        std::string all;
        for (const Diagnostic &d : compilation.diagnostics.sorted())
            all += to_text(d, compilation.sources, false);
        return all;
    };
    for (const std::string &text : nasty_texts(static_cast<std::size_t>(test::effort(300)))) {
        INFO(for_json(text));
        const driver::Compilation nasty = compile(text, text);
        const std::string shown = said(nasty);
        for (std::size_t i = 0; i < shown.size();) {
            const CodePoint c = decode_utf8(shown, i);
            if (!c.valid || (c.value != '\n' && !is_printable(c.value))) FAIL(for_json(shown));
            i += c.length;
        }
        CHECK(std::ranges::count(shown, '\n') == std::ranges::count(said(plain), '\n'));
        const auto json = nlohmann::json::parse(driver::verdict_json(nasty)).flatten();
        const auto harmless = nlohmann::json::parse(driver::verdict_json(plain)).flatten();
        REQUIRE(json.size() == harmless.size());
        for (const auto &[key, value] : harmless.items()) {
            REQUIRE(json.contains(key));
            if (value == "harmless.sdf") CHECK(json[key] == as_utf8(text));
        }
    }
}

TEST_CASE(
    "any text comes back from YAML, as a value, as a key, and through an import and an export") {
    for (const std::string &raw : nasty_texts(static_cast<std::size_t>(test::effort(2000)))) {
        INFO(for_json(raw));
        const std::string text = as_utf8(raw);
        const save::Value tree = save::yaml_list(
            {save::yaml_word(text),
             save::yaml_mapping({{text, save::yaml_word(text)}, {"B", save::yaml_scalar(1)}})});
        for (const std::string &written : {save::flow_text(tree), [&] {
                                               std::string block;
                                               save::write_value(tree, 0, block);
                                               return block;
                                           }()}) {
            INFO(written);
            const save::ParsedText parsed = save::parse_text(written);
            REQUIRE(parsed.ok);
            REQUIRE(parsed.value.items.size() == 2);
            CHECK(parsed.value.items[0].text == text);
            REQUIRE(parsed.value.items[1].entries.size() == 2);
            CHECK(parsed.value.items[1].entries[0].first == text);
            CHECK(parsed.value.items[1].entries[0].second.text == text);
        }
    }
}

TEST_CASE("names that YAML readers take for numbers, dates, switches or merges are quoted") {
    for (const char *name : {"12", "1_0", "0x1F", "12:30:45", "2001-01-01", "+1", ".5", "-.inf",
                             "true", "No", "NULL", "~", "<<", "=", ""}) {
        const std::string quoted = for_yaml(name);
        CHECK(save::flow_text(save::yaml_word(name)) == quoted);
        CHECK(save::flow_text(save::yaml_mapping({{name, save::yaml_scalar(1)}})) ==
              "{" + quoted + ": 1}");
    }
    CHECK(save::flow_text(save::yaml_mapping({{"Radius", save::yaml_word("<None>")}})) ==
          "{Radius: <None>}");
}

TEST_CASE("a save file of any names is imported and exported as the same tree") {
    for (const std::string &raw : nasty_texts(static_cast<std::size_t>(test::effort(60)))) {
        INFO(for_json(raw));
        const std::string name = for_yaml(raw);
        const std::string file = "- 0.3\n- {" + for_yaml("t" + raw) + ": " +
                                 for_yaml(raw + ".png") + "}\n- [[Generic, " + for_yaml("m" + raw) +
                                 ", {Color: {Red: 1, Green: 2, Blue: 3}}]]\n- [Generic, Distance "
                                 "field, {Children: [\n[Sphere, " +
                                 name + ", {Radius: 2, Material: " + for_yaml("m" + raw) + ", " +
                                 for_yaml("k" + raw) + ": " + name + "}],\n[" + name + ", " + name +
                                 ", {}]]}]\n- [LightingNode, Lighting, {}]\n- 100\n";
        const save_test::Imported imported = save_test::import_text(file);
        INFO(imported.said());
        INFO(imported.result.sdf);
        REQUIRE_FALSE(imported.result.structural_error);
        const save_test::CheckedText checked = save_test::check_text(imported.result.sdf);
        REQUIRE(checked.errors() == "");
        const std::string exported = save_test::export_text(checked.checked.scene);
        INFO(exported);
        const save::ParsedText before = save::parse_text(file);
        const save::ParsedText after = save::parse_text(exported.substr(exported.find('\n') + 1));
        REQUIRE(before.ok);
        REQUIRE(after.ok);
        CHECK(save_test::difference(before.value, after.value) == "");
    }
}
