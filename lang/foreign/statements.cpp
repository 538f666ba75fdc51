// Answers to statements that other languages have and this one writes as calls, or with braces:
// streams of output, settings that are assigned to, loops over pairs, bodies up to `end`, and what
// stands around the value of a `param`.
#include "base/suggest.h"
#include "lang/foreign/foreign.h"
#include "lang/lexer.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 6> settings = {"background", "camera",   "light",
                                                      "sun",        "lighting", "render"};
constexpr std::array<std::string_view, 6> range_words = {"min",     "from", "range",
                                                         "between", "low",  "limits"};

// What scripts of other programs begin with.
constexpr std::array<std::string_view, 4> modules = {"bpy", "bmesh", "THREE", "cq"};

} // namespace

// `lte r = 2`, `improt "a.sdf"`: a keyword, mistyped.
bool ForeignSyntax::mistyped_keyword(Index first) {
    constexpr std::array<std::string_view, 7> keywords = {"let",    "var", "param", "import",
                                                          "return", "for", "while"};
    const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
    const std::string_view word = text(first);
    const auto near = std::ranges::find_if(keywords, [&](std::string_view keyword) {
        return small(word[0]) == keyword[0] && edit_distance(word, keyword) <= 1;
    });
    const bool follows = kind(first + 1) == Tok::Name || kind(first + 1) == Tok::String;
    if (near == keywords.end() || !follows || token(first + 1).first_on_line ||
        is_declared(std::string(word)))
        return false;
    if (kind(first + 1) == Tok::Name) lost_.push_back(first + 1);
    const std::string meant(word == "val" ? "let" : *near); // Kotlin's and Scala's never changes
    diagnostics_.add(Code::SyntaxError, span(first), "no statement begins with " + in_code(word))
        .help("did you mean " + in_code(meant) + "?", {{span(first), meant}});
    return true;
}

// `background = black`: the call that it is here.
bool ForeignSyntax::setting_assigned(std::string_view name, Span target, Span value) {
    if (!is_one_of(name, settings)) return false;
    const std::string call =
        std::string(name) + "(" + std::string(text(value.begin, value.end)) + ")";
    foreign(target, "the scene's settings are calls")
        .help(to_write(call),
              {{{id_, target.end, value.begin}, "("}, {{id_, value.end, value.end}, ")"}});
    return true;
}

// `std::cout << "r is " << r << std::endl`.
bool ForeignSyntax::print_stream(Index first) {
    const bool qualified =
        text(first) == "std" && kind(first + 1) == Tok::Colon && kind(first + 2) == Tok::Colon;
    const Index out = qualified ? first + 3 : first;
    const auto is_sign = [&](Index i) {
        return kind(i) == Tok::Less && kind(i + 1) == Tok::Less && touch(i, i + 1);
    };
    if (kind(out) != Tok::Name || (text(out) != "cout" && text(out) != "cerr") || !is_sign(out + 1))
        return false;
    failed_ = first + 1;
    // `std::` was told, and left away, where the words were read
    constexpr std::string_view space = "std::";
    const std::string_view before = text(0, token(first).begin);
    const bool told = before.ends_with(space);
    const auto begin = static_cast<std::uint32_t>(token(first).begin - (told ? space.size() : 0));
    const std::uint32_t last = token(statement_end(first) - 1).end;
    const std::string_view all = text(0, last);
    for (std::size_t at = all.find(space, begin); at < all.size(); at = all.find(space, at + 1)) {
        const auto i = static_cast<std::uint32_t>(at);
        diagnostics_.withdraw(Code::ForeignSyntax,
                              {id_, i, i + static_cast<std::uint32_t>(space.size())});
    }
    std::string shown;
    Index end = out + 1;
    while (is_sign(end)) {
        const Index part = end + 2;
        Index past = part;
        while (!ends_statement(past) && !is_sign(past))
            past = match(past) > past ? match(past) + 1 : past + 1;
        if (past == part) break;
        const std::string value(text(token(part).begin, token(past - 1).end));
        if (!value.ends_with("endl") && value != "\"\\n\"")
            shown += (shown.empty() ? "" : " + ") + value;
        end = past;
    }
    const std::string call = "print(" + shown + ")";
    foreign({id_, begin, token(out).end}, "a value is shown by `print`")
        .help(to_write(call), {{{id_, begin, last}, call}});
    return true;
}

// `for i in 0..3 do`, `if a then`, with the body on the lines below, up to `end`; at the word.
bool ForeignSyntax::block_until_end(Index at) {
    constexpr Index farthest = 5000; // words
    const auto is = [&](Index i, const char *word) {
        return kind(i) == Tok::Name && text(i) == word;
    };
    std::vector<Edit> edits{{span(at), "{"}};
    int open = 1;
    Index i = at + 1;
    for (; i < tokens_.tokens.size() && i < at + farthest; ++i) {
        if (is(i, "do") || is(i, "then")) {
            Index header = i;
            while (header > at && kind(header) != Tok::If && kind(header) != Tok::End) --header;
            if (kind(header) != Tok::If || kind(header - 1) != Tok::Else) ++open;
            edits.push_back({span(i), "{"});
        }
        if (is(i, "end") && token(i).first_on_line) {
            edits.push_back({span(i), "}"});
            if (--open == 0) break;
        }
        if (kind(i) == Tok::Else && token(i).first_on_line)
            edits.push_back({span(i), kind(i + 1) == Tok::If ? "} else" : "} else {"});
    }
    if (open > 0) return false;
    failed_ = i;
    foreign(span(at), "a body stands in braces").help("write `{ … }`", std::move(edits));
    return true;
}

// `for i, r in enumerate(list)`, `for a, b in zip(l, m)`, at the comma: the loop over the places.
void ForeignSyntax::loop_over_pairs(Index at) {
    Diagnostic &d = foreign(span(at), "a loop has one variable");
    const std::string help = "loop over the places: `for i in 0..len(list) { let x = list[i] … }`";
    const Index one = at - 1, two = at + 1, function = at + 3, open = function + 1,
                close = match(open), past = close + 1;
    const bool counted = text(function) == "enumerate", zipped = text(function) == "zip";
    if (kind(two) != Tok::Name || kind(at + 2) != Tok::In || (!counted && !zipped) ||
        kind(open) != Tok::Open || !is_one_of(kind(past), {Tok::Colon, Tok::Body})) {
        d.help(help);
        return;
    }
    std::vector<std::string> lists;
    for (Index begin = open + 1, i = begin; i <= close; i = match(i) > i ? match(i) + 1 : i + 1) {
        if (i < close && kind(i) != Tok::Comma) continue;
        if (i > begin) lists.emplace_back(text(token(begin).begin, token(i - 1).end));
        begin = i + 1;
    }
    Index first = past + 1;
    while (kind(first) == Tok::End && first < tokens_.tokens.size()) ++first;
    if (lists.size() != (counted ? 1u : 2u) || first >= tokens_.tokens.size()) {
        d.help(help);
        return;
    }
    const auto is_i = [&](Index name) { return text(name) == "i"; };
    const std::string place = counted                  ? std::string(text(one))
                              : is_i(one) || is_i(two) ? "place"
                                                       : "i";
    const auto let = [&](Index name, const std::string &list) {
        return "let " + std::string(text(name)) + " = " + list + "[" + place + "]; ";
    };
    const std::string lets = counted ? let(two, lists[0]) : let(one, lists[0]) + let(two, lists[1]);
    std::vector<Edit> edits{{span(one, past - 1), place + " in 0..len(" + lists[0] + ")"},
                            {{id_, token(first).begin, token(first).begin}, lets}};
    if (kind(past) == Tok::Colon)
        indented_body(past, edits);
    else
        failed_ = match(past);
    d.help(help, std::move(edits));
}

// `param "Radius" r = 1 in 0..2`, at the string: it stands last.
bool ForeignSyntax::label_of_param(Index at) {
    if (at == 0 || kind(at - 1) != Tok::Param || kind(at) != Tok::String ||
        kind(at + 1) != Tok::Name)
        return false;
    lost_.push_back(at + 1);
    failed_ = at + 1;
    const std::uint32_t end = token(statement_end(at - 1) - 1).end;
    foreign(span(at), "a param's words stand behind its range")
        .help("write them last", {{{id_, token(at).begin, token(at + 1).begin}, ""},
                                  {{id_, end, end}, " " + std::string(text(at))}});
    return true;
}

// `param r = 1 min 0.5 max 2`, `param r = 1 range(0, 2)`, at the word: two numbers as a range.
bool ForeignSyntax::words_of_range(Index first, Index at) {
    if (kind(first) != Tok::Param || kind(at) != Tok::Name || at < first + 4) return false;
    Index in = first;
    while (in < at && kind(in) != Tok::In) ++in;
    if (in < at) { // `param n = 3 in 1..10 step 1`
        lost_.push_back(first + 1);
        const Index end = statement_end(first);
        const Index kept = kind(end - 1) == Tok::String ? end - 1 : end; // its words
        foreign(span(at), "a param has a value, a range and words, and nothing more")
            .help("leave " + in_code(text(token(at).begin, token(kept - 1).end)) + " away",
                  {{{id_, token(at - 1).end, token(kept - 1).end}, ""}});
        return true;
    }
    if (!is_one_of(text(at), range_words)) return false;
    std::vector<std::string> ends;
    const Index past = statement_end(first);
    Index label = past;
    for (Index i = at; i < past; ++i) {
        if (kind(i) == Tok::String) label = std::min(label, i);
        if (kind(i) == Tok::Number)
            ends.push_back((kind(i - 1) == Tok::Minus ? "-" : "") + std::string(text(i)));
    }
    if (ends.size() != 2) return false;
    const std::string range = " in " + ends[0] + ".." + ends[1];
    foreign(span(at), "a param's range stands behind `in`")
        .help(to_write(range.substr(1)), {{{id_, token(at - 1).end, token(label - 1).end}, range}});
    lost_.push_back(first + 1);
    return true;
}

// `param r(0, 2) = 1`, `param r(1, 0, 2)`, at the parenthesis: two numbers as a range.
bool ForeignSyntax::range_in_parentheses(Index at) {
    if (at < 2 || kind(at) != Tok::Open || kind(at - 2) != Tok::Param) return false;
    const Index close = match(at), end = statement_end(at - 2);
    std::vector<std::string> numbers;
    for (Index i = at + 1; i < close; ++i)
        if (kind(i) == Tok::Number)
            numbers.push_back((kind(i - 1) == Tok::Minus ? "-" : "") + std::string(text(i)));
    const bool valued = kind(close + 1) == Tok::Assign;
    const std::string name(text(at - 1));
    lost_.push_back(at - 1);
    Diagnostic &d = foreign(span(at, close), "a param's range stands behind `in`");
    const std::size_t ends = valued ? 2 : 3; // else the value is the first
    if (numbers.size() != ends) {
        d.help("write " + in_code("param " + name + " = 1 in 0..2"));
        return true;
    }
    const std::string range = " in " + numbers[ends - 2] + ".." + numbers[ends - 1];
    const std::string value = valued ? " = …" : " = " + numbers[0];
    failed_ = end;
    if (valued)
        d.help(to_write("param " + name + value + range),
               {{span(at, close), ""}, {{id_, token(end - 1).end, token(end - 1).end}, range}});
    else
        d.help(to_write("param " + name + value + range), {{span(at, close), value + range}});
    return true;
}

// `for i from 0 to 5 { … }`, `for each x in list { … }`, behind the variable.
bool ForeignSyntax::foreign_for_words(Index at) {
    const std::string_view variable = text(at - 1);
    if ((variable == "each" || variable == "every") && kind(at) == Tok::Name &&
        kind(at + 1) == Tok::In) {
        foreign(span(at - 1), "a loop is written `for x in list { … }`")
            .help("leave " + in_code(variable) + " away",
                  {{{id_, token(at - 1).begin, token(at).begin}, ""}});
        return true;
    }
    if (kind(at) != Tok::Name || (text(at) != "from" && text(at) != "of")) return false;
    std::vector<Edit> edits{{span(at), "in"}};
    Index i = at + 1;
    for (; !ends_statement(i) && kind(i) != Tok::Body; i = match(i) > i ? match(i) + 1 : i + 1) {
        if (kind(i) != Tok::Name || kind(i - 1) == Tok::Dot) continue;
        const std::string_view word = text(i);
        if (word == "to" || word == "through" || word == "upto") edits.push_back({span(i), "..="});
        if (word == "until" || word == "below") edits.push_back({span(i), ".."});
    }
    failed_ = i;
    foreign(span(at), "a loop runs over what stands behind `in`")
        .help("write `for i in 0..8 { … }`", std::move(edits));
    return true;
}

// `repeat 5 times { … }`, `repeat n { … }`, `loop 5 { … }`, `5 times { … }`: a loop that counts.
bool ForeignSyntax::counted_block(Index first, Index at) {
    const bool word = text(first) == "repeat" || text(first) == "loop" || text(first) == "do";
    Index count = word ? first + 1 : first;
    if (!is_one_of(kind(count), {Tok::Number, Tok::Name}) || at < count) return false;
    const bool times = text(count + 1) == "times";
    const Index brace = count + (times ? 2 : 1);
    if ((!word && !times) || token(count).first_on_line != !word ||
        !is_one_of(kind(brace), {Tok::Body, Tok::Trailing, Tok::StrayBrace}))
        return false;
    const std::string head = "for i in 0.." + std::string(text(count));
    failed_ = match(brace) > brace ? match(brace) : brace;
    foreign(span(first, brace - 1), "a loop is written `for i in 0..8 { … }`")
        .help(to_write(head + " { … }"), {{span(first, brace - 1), head}});
    return true;
}

// `group("wheel") { … }`, as editors of models have it.
bool ForeignSyntax::named_group(Index first) {
    constexpr std::array<std::string_view, 7> words = {"group", "part",  "object",   "node",
                                                       "layer", "solid", "component"};
    const Index close = match(first + 1), open = close + 1;
    if (!is_one_of(text(first), words) || kind(first + 1) != Tok::Open ||
        kind(first + 2) != Tok::String || close != first + 3 ||
        !is_one_of(kind(open), {Tok::Body, Tok::Trailing, Tok::StrayBrace}) ||
        match(open) <= open || !ends_statement(match(open) + 1) || may_be_declared(text(first)))
        return false;
    const std::string_view quoted = text(first + 2);
    std::string name(quoted.substr(1, quoted.size() - 2));
    std::ranges::replace(name, ' ', '_');
    const bool plain = !name.empty() && !is_digit(name[0]) && !is_keyword_text(name) &&
                       std::ranges::all_of(name, is_word_char) && !may_be_declared(name);
    failed_ = match(open);
    Diagnostic &d = foreign(span(first), "a part is called by the name that it is bound to");
    if (!plain)
        d.help("write `let name = union { … }`, and `name` where it stands");
    else
        d.help("write " + in_code("let " + name + " = union { … }") + ", and " + in_code(name) +
                   " where it stands",
               {{{id_, token(first).begin, token(open).begin}, "let " + name + " = union "},
                {{id_, token(match(open)).end, token(match(open)).end}, "; " + name}});
    return true;
}

// `try { s } catch (e) { … }`: what stands in its first braces.
bool ForeignSyntax::tried_block(Index first) {
    const Index open = first + 1, close = match(open);
    if (kind(open) == Tok::Colon) { // Python's
        std::vector<Edit> body, handler;
        if (!indented_body(open, body)) return false;
        Index begin = open + 1;
        while (kind(begin) == Tok::End) ++begin;
        const Index last = failed_;
        for (Index i = last + 1; i < tokens_.tokens.size();) {
            while (kind(i) == Tok::End && i + 1 < tokens_.tokens.size()) ++i;
            const bool goes_on =
                text(i) == "except" || text(i) == "finally" || kind(i) == Tok::Else;
            Index colon = i;
            while (!ends_statement(colon) && kind(colon) != Tok::Colon) ++colon;
            if (!goes_on || kind(colon) != Tok::Colon || !indented_body(colon, handler)) break;
            i = failed_ + 1;
        }
        foreign(span(first), "a scene catches nothing: what is wrong is told before it is drawn")
            .help("leave `try` and `except` away",
                  {{{id_, token(first).begin, token(begin).begin}, ""},
                   {{id_, token(last).end, token(failed_).end}, ""}});
        return true;
    }
    if (kind(open) != Tok::Trailing || close <= open + 1) return false;
    const Index end = statement_end(first);
    foreign(span(first), "a scene catches nothing: what is wrong is told before it is drawn")
        .help("leave `try` and `catch` away",
              {{{id_, token(first).begin, token(open + 1).begin}, ""},
               {{id_, token(close - 1).end, token(std::max(close, end - 1)).end}, ""}});
    return true;
}

// `[i, r] of list.entries()`, `[a, b] of pairs`, whose names stand in brackets that open at `open`:
// the head of a loop, and what binds the names in its body. Empty where it is none.
std::string ForeignSyntax::loop_of_parts(Index open, std::string list, std::string &lets) const {
    const Index close = match(open);
    bool counted = false;
    for (const std::string_view counts : {".entries()", ".enumerate()"})
        if (list.ends_with(counts)) {
            list.resize(list.size() - counts.size());
            counted = true;
        }
    if (constexpr std::string_view needless = ".iter()"; list.ends_with(needless))
        list.resize(list.size() - needless.size());
    if (close <= open || list.empty()) return {};
    const std::string first(text(open + 1));
    for (Index name = open + 1, part = 0; name < close; name += 2, ++part) {
        if (kind(name) != Tok::Name) return {};
        const std::string place =
            counted ? list + "[" + first + "]" : "row[" + std::to_string(part) + "]";
        if (!counted || part == 1) lets += "let " + std::string(text(name)) + " = " + place + "; ";
    }
    if (lets.empty()) return {};
    return counted ? first + " in 0..len(" + list + ")" : "row in " + list;
}

// `for (i, r) in list.enumerate() { … }`, at the parenthesis.
bool ForeignSyntax::loop_of_tuple(Index open, Diagnostic &d) {
    const Index first = match(open) + 2;
    Index body = first;
    while (!ends_statement(body) && kind(body) != Tok::Body)
        body = match(body) > body ? match(body) + 1 : body + 1;
    failed_ = std::max(body, match(body));
    if (kind(body) != Tok::Body || body == first) return true;
    std::string lets;
    const std::string list(text(token(first).begin, token(body - 1).end));
    const std::string head = loop_of_parts(open, list, lets);
    if (!head.empty())
        d.help(to_write("for " + head + " { … }"),
               {{span(open, body - 1), head},
                {{id_, token(body + 1).begin, token(body + 1).begin}, lets}});
    return true;
}

// `for x in l, z in m { … }`, at the comma; `for a in 0..360 step 30 { … }`, at the word.
bool ForeignSyntax::head_of_loop(Index at) {
    const bool next =
        kind(at) == Tok::Comma && kind(at + 1) == Tok::Name && kind(at + 2) == Tok::In;
    const bool step = kind(at) == Tok::Name && (text(at) == "step" || text(at) == "by") &&
                      is_one_of(kind(at + 1), {Tok::Number, Tok::Name});
    Index in = at, body = at, dots = 0;
    while (in > 0 && !is_one_of(kind(in), {Tok::In, Tok::End}))
        in = match(in - 1) < in - 1 ? match(in - 1) : in - 1;
    while (!ends_statement(body) && kind(body) != Tok::Body)
        body = match(body) > body ? match(body) + 1 : body + 1;
    if ((!next && !step) || kind(in) != Tok::In || in < 2 || kind(in - 2) != Tok::For ||
        kind(body) != Tok::Body)
        return false;
    if (next) {
        const Index close = match(body);
        failed_ = close;
        foreign(span(at), "a loop has one variable; another is a loop within it")
            .help("write `for x in l { for z in m { … } }`",
                  {{span(at), " { for"}, {{id_, token(close).end, token(close).end}, " }"}});
        return true;
    }
    for (Index i = in + 1; i < at; ++i)
        if (is_one_of(kind(i), {Tok::DotDot, Tok::DotDotEqual})) dots = i;
    if (dots <= in + 1) return false;
    const std::string range = "range(" +
                              std::string(text(token(in + 1).begin, token(dots - 1).end)) + ", " +
                              std::string(text(token(dots + 1).begin, token(at - 1).end)) + ", " +
                              std::string(text(token(at + 1).begin, token(body - 1).end)) + ")";
    failed_ = match(body);
    foreign(span(at), "numbers in steps are a `range`")
        .help(to_write(range), {{span(in + 1, body - 1), range}});
    return true;
}

// Python's `from parts.arch import arch`: a file of the user's own, by its path.
bool ForeignSyntax::python_import(Index first) {
    Index end = first + 1;
    while (is_one_of(kind(end), {Tok::Name, Tok::Dot})) ++end;
    if (text(first) != "from" || kind(end) != Tok::Import || end == first + 1) return false;
    const Index begin = kind(first + 1) == Tok::Dot ? first + 2 : first + 1;
    std::string path;
    for (Index i = begin; i < end; ++i) path += kind(i) == Tok::Dot ? "/" : text(i);
    constexpr std::array<std::string_view, 16> libraries = {
        "math",      "numpy",     "random",    "bpy",     "mathutils",   "fathom",
        "sdf",       "scipy",     "typing",    "solid",   "dataclasses", "enum",
        "functools", "itertools", "build123d", "cadquery"};
    if (path.empty() || is_one_of(text(begin), libraries)) return false;
    const std::string written = "import \"" + path + ".sdf\"";
    failed_ = end;
    const Index past = statement_end(first);
    foreign(span(first), "`import` brings all names of a file")
        .help(to_write(written), {{span(first, past - 1), written}});
    return true;
}

// `bpy.ops.mesh.primitive_cube_add(size=2)`: of all of it only that is told.
bool ForeignSyntax::of_other_program(Index first) {
    if (kind(first + 1) != Tok::Dot || !is_one_of(text(first), modules) ||
        may_be_declared(text(first)))
        return false;
    failed_ = statement_end(first);
    foreign(span(first), "there is no " + in_code(text(first)) + " here")
        .help("a shape is made by a call, as `sphere(1)`, and moved by `.translate(z: 1)`");
    return true;
}

// Is the name that is declared here given another value in the rest of its block?
bool ForeignSyntax::is_assigned_after(Index name) const {
    constexpr std::array changes{Tok::Assign,     Tok::PlusAssign,  Tok::MinusAssign,
                                 Tok::StarAssign, Tok::SlashAssign, Tok::OtherAssign,
                                 Tok::PlusPlus,   Tok::MinusMinus};
    const Index open = enclosing(name), partner = match(open),
                end = partner > open ? partner : Index(tokens_.tokens.size());
    for (Index i = name + 1; i < end; ++i) {
        if (kind(i) != Tok::Name || text(i) != text(name)) continue;
        const Tok before = kind(i - 1); // a named argument, another declaration
        if (before == Tok::Open || before == Tok::Comma || before == Tok::Name) continue;
        if (before == Tok::Let || before == Tok::Var || before == Tok::Dot) continue;
        Index at = i + 1;
        while (kind(at) == Tok::Dot && kind(at + 1) == Tok::Name) at += 2;
        if (std::ranges::find(changes, kind(at)) != changes.end()) return true;
    }
    return false;
}

// The edit that takes a statement away, with its `;`.
Edit ForeignSyntax::without_statement(Index first) const {
    const Index end = statement_end(first);
    const bool sign = kind(end) == Tok::End && text(end) == ";";
    return {{id_, token(first).begin, token(sign ? end : end - 1).end}, ""};
}

} // namespace fathom::lang
