// Answers to declarations as other languages write them: types before names, functions without
// `fn`, names without a value, sliders and uniforms.
#include "base/text.h"
#include "lang/foreign/foreign.h"
#include "lang/vocabulary.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 22> qualifiers = {
    "const", "uniform", "static", "auto", "local",    "final",     "highp", "mediump",
    "lowp",  "varying", "inout",  "out",  "mut",      "attribute", "val",   "export",
    "my",    "set",     "dim",    "Dim",  "readonly", "constexpr"};
constexpr std::array<std::string_view, 6> function_words = {"def", "function", "func",
                                                            "fun", "module",   "void"};
constexpr std::array<std::string_view, 6> slider_words = {"slider", "knob",      "input",
                                                          "param",  "parameter", "Slider"};
constexpr std::array<std::string_view, 4> streams = {"varying", "attribute", "out", "inout"};
constexpr std::array<std::string_view, 10> screens = {
    "iResolution", "u_resolution", "uResolution", "resolution", "iMouse",
    "u_mouse",     "uMouse",       "mouse",       "iFrame",     "iTimeDelta"};
constexpr std::size_t most_uses = 40; // of a name that one edit changes

// What is known as `time` where it is used, too.
bool means_time(std::string_view name) {
    return name == "time" || name == "iTime" || name == "u_time" || name == "iGlobalTime";
}

// A type of their own making, as `Hit`, `T`: no vector of another library, whose names have digits.
bool is_their_own(std::string_view type) {
    return type_named(type) == TypeName::Unknown && !is_type_word(type) && type[0] >= 'A' &&
           type[0] <= 'Z' && type.find_first_of("0123456789") == type.npos && type != "Shape" &&
           type != "String" && type != "SDF";
}

} // namespace

bool is_clock(std::string_view name) {
    constexpr std::array<std::string_view, 9> clocks = {
        "time", "iTime", "u_time", "uTime", "iGlobalTime", "t", "seconds", "elapsed", "globalTime"};
    return is_one_of(name, clocks);
}

std::string range_around(std::string_view number, bool negative) {
    const auto value = parse_number(number);
    if (!value || *value == 0) return "-1..1";
    const bool whole = number.find_first_not_of("0123456789") == std::string_view::npos;
    const std::string half = format_shortest(whole ? std::ceil(*value / 2) : *value / 2),
                      twice = format_shortest(2 * *value);
    return negative ? "-" + twice + "..-" + half : half + ".." + twice;
}

// The parameters between two parentheses, as they would be written here.
std::string ForeignSyntax::parameters_text(Index open) const {
    const Index close = match(open);
    std::string out;
    for (Index i = open + 1; i < close;) {
        Index end = i;
        while (end < close && kind(end) != Tok::Comma)
            end = match(end) > end ? match(end) + 1 : end + 1;
        while (i + 1 < end && (is_one_of(text(i), qualifiers) || kind(i) == Tok::In)) ++i;
        if (!out.empty()) out += ", ";
        Index named = i + 1; // behind `vec3 &`, `float *`
        while (named < end &&
               (is_one_of(kind(named), {Tok::Amp, Tok::Star}) || text(named) == "const"))
            ++named;
        const bool type_first = kind(i) == Tok::Name && kind(named) == Tok::Name && named < end;
        const std::string rest(end > i ? text(token(i).begin, token(end - 1).end) : "");
        if (match(i) > i && match(i) < end && is_one_of(kind(i), {Tok::StrayBrace, Tok::Trailing}))
            out += text(token(i + 1).begin, token(match(i) - 1).end);      // `{ a, b }: Options`
        else if (!type_first && kind(i + 1) == Tok::Colon && i + 3 == end) // `x: number`
            out += std::string(text(i)) + ": " + std::string(our_type(text(i + 2)));
        else if (!type_first)
            out += rest;
        else
            out += std::string(text(named)) +
                   (is_their_own(text(i)) ? "" : ": " + std::string(our_type(text(i)))) +
                   std::string(text(token(named).end, token(end - 1).end));
        i = end + 1;
    }
    return out;
}

// -- parameters ----------------------------------------------------------------------------------

// `uniform float k = 0.5`, `slider r = 1 in 0..2`: a `param`, whose name stands at `name`.
void ForeignSyntax::foreign_param(Index first, Index name) {
    const std::string declared(text(name));
    Diagnostic &d = foreign(span(first, name), "what is set from outside is declared with `param`");
    std::vector<Edit> edits{{span(first, name), "param " + declared}};
    const bool negative = kind(name + 2) == Tok::Minus;
    const Index value = name + (negative ? 3 : 2);
    const bool number = kind(value) == Tok::Number && ends_statement(value + 1);
    if (number) {
        const std::string range = range_around(text(value), negative);
        edits.push_back({{id_, token(value).end, token(value).end}, " in " + range});
        d.help(to_write("param " + declared + " = " + (negative ? "-" : "") +
                        std::string(text(value)) + " in " + range),
               std::move(edits));
        return;
    }
    Index end = name + 2;
    while (!ends_statement(end) && kind(end) != Tok::In) ++end;
    const bool ready =
        kind(end) == Tok::In ||
        (ends_statement(value + 1) && is_one_of(kind(value), {Tok::True, Tok::False, Tok::Color}));
    d.help("write " + in_code("param " + declared + " = 1 in 0..2"),
           ready ? std::move(edits) : std::vector<Edit>{});
}

// `param r = 1 [0, 2]`, at the comma.
bool ForeignSyntax::range_of_param(Index comma) {
    const Index open = enclosing(comma), close = match(open);
    Index first = open;
    while (first > 0 && kind(first - 1) != Tok::End) --first;
    if (kind(first) != Tok::Param || !ends_statement(close + 1)) return false;
    const std::string range = std::string(text(token(open).end, token(comma).begin)) + ".." +
                              std::string(text(token(comma + 1).begin, token(close).begin));
    foreign(span(open, close), "a param's range stands behind `in`")
        .help(to_write("in " + range),
              {{{id_, token(open - 1).end, token(close).end}, " in " + range}});
    return true;
}

// `uniform float k;`, `varying vec2 uv;`: without a value.
bool ForeignSyntax::foreign_stream(Index first, Index name) {
    const std::string word(text(first)), declared(text(name)), type(text(name - 1));
    const Edit away = without_statement(first);
    const bool uniform = word == "uniform";
    const bool stream = is_one_of(word, streams) || kind(first) == Tok::In;
    if (!uniform && !stream) return false;
    if (stream) {
        foreign(span(first, name), "a scene has no inputs and outputs: a field is a function of "
                                   "the point, as in `implicit(p => length(p) - 1)`")
            .help("leave it away", {away});
        return true;
    }
    if (is_clock(declared)) {
        std::vector<Edit> edits{away}; // and its uses, where they are not known for the time
        for (Index i = name + 1;
             !means_time(declared) && may_look_far() && i < tokens_.tokens.size() && !edits.empty();
             ++i) {
            if (kind(i) != Tok::Name || text(i) != declared || kind(i - 1) == Tok::Dot) continue;
            edits.push_back({span(i, i), "time"});
            if (kind(i - 1) == Tok::Name || edits.size() > most_uses) edits.clear(); // another one
        }
        foreign(span(first, name), "the seconds are `time`")
            .help("leave the line away, and write `time`", std::move(edits));
        return true;
    }
    if (is_one_of(declared, screens)) {
        foreign(span(first, name), "a field knows no screen: it is a function of the point alone")
            .help("leave the line away", {away});
        return true;
    }
    const std::string value = type == "bool"                        ? "true"
                              : type == "int"                       ? "1 in 1..10"
                              : type == "float" || type == "double" ? "1.0 in 0.5..2"
                                                                    : "";
    Diagnostic &d = foreign(span(first, name), "what is set from outside is declared with `param`, "
                                               "together with its value");
    if (type.starts_with("sampler"))
        d.help("an image is `image(\"file.png\")`");
    else if (value.empty())
        d.help("a colour is `param " + declared +
               " = #ffffff`; other vectors are made of numbers, "
               "each a `param`");
    else
        d.help(to_write("param " + declared + " = " + value),
               {{span(first, name), "param " + declared + " = " + value}});
    return true;
}

// `let [a, b] = …`, `a, b = …`: the names stand from `from` to before `past`.
void ForeignSyntax::destructuring(Index first, Index from, Index past, Index assign) {
    constexpr std::array<std::string_view, 4> modules = {"Math", "math", "THREE", "np"};
    if (kind(assign + 1) == Tok::Name && is_one_of(text(assign + 1), modules) &&
        ends_statement(assign + 2) && !may_be_declared(text(assign + 1))) {
        const bool sign = kind(assign + 2) == Tok::End && text(assign + 2) == ";";
        foreign(span(first, assign + 1), "the mathematical functions need no module")
            .help("leave the line away", {{span(first, assign + (sign ? 2 : 1)), ""}});
        return;
    }
    std::vector<Index> names;
    bool plain = true;
    for (Index i = from; i < past; ++i) {
        if (kind(i) == Tok::Name) names.push_back(i), lost_.push_back(i);
        plain = plain && is_one_of(kind(i), {Tok::Name, Tok::Comma});
    }
    const Index end = statement_end(first), value = assign + 1;
    std::vector<std::string> values;
    const bool list = match(value) > value && match(value) + 1 == end;
    const Index to = list ? match(value) : end;
    for (Index i = list ? value + 1 : value, begin = i; i <= to;
         i = match(i) > i ? match(i) + 1 : i + 1) {
        if (i < to && kind(i) != Tok::Comma) continue;
        if (kind(begin) == Tok::Name && kind(begin + 1) == Tok::Colon) begin += 2; // `{x: 1}`
        if (i > begin) values.emplace_back(text(token(begin).begin, token(i - 1).end));
        begin = i + 1;
    }
    const bool one_name =
        values.size() == 1 && !list && kind(value) == Tok::Name && value + 1 == end;
    std::string written;
    for (std::size_t k = 0; k < names.size(); ++k) {
        const std::string item = one_name ? values[0] + "[" + std::to_string(k) + "]"
                                 : values.size() == names.size() ? values[k]
                                                                 : "";
        plain = plain && !item.empty();
        written += (k > 0 ? "; let " : "let ") + std::string(text(names[k])) + " = " + item;
    }
    Diagnostic &d = foreign(span(first, assign - 1), "each name is bound by a `let` of its own");
    if (plain && !names.empty() && written.find('\n') == std::string::npos)
        d.help(to_write(written), {{span(first, end - 1), written}});
    else
        d.help("write `let a = list[0]`, and so on");
}

// -- names without a value -----------------------------------------------------------------------

// `float d;`, `var r;`: `declared` is given its value later, or never.
void ForeignSyntax::foreign_unbound(Index first, Index name, std::string_view type) {
    const std::string declared(text(name)),
        typed = declared + (type.empty() ? "" : ": ") + std::string(type);
    const bool later = is_assigned_after(name);
    const std::string_view zero = zero_of(type);
    const std::string record = in_function_ ? zero_record(type) : std::string();
    const auto mentioned = [&] {
        for (Index i = name + 1; i < tokens_.tokens.size(); ++i)
            if (kind(i) == Tok::Name && text(i) == declared) return true;
        return false;
    };
    Diagnostic &d = foreign(span(first, name), "a name is bound together with its value");
    if (!in_function_ && later) // there the first assignment is the declaration
        d.help("leave it away: `let " + declared + " = …` declares it where it has its value",
               {without_statement(first)});
    else if (!in_function_ && !type.empty() && may_look_far() &&
             statement_end(first) + 1 < tokens_.tokens.size() && !mentioned())
        d.help("leave it away: nothing uses it", {without_statement(first)});
    else if (!record.empty())
        d.help(to_write("var " + declared + " = " + record),
               {{span(first, name), "var " + declared + " = " + record}});
    else if (in_function_ && !zero.empty())
        d.help(to_write("var " + typed + " = " + std::string(zero)),
               {{span(first, name), "var " + typed + " = " + std::string(zero)}});
    else
        d.help("write " + in_code((in_function_ ? "var " : "let ") + typed + " = …"));
}

// -- functions -----------------------------------------------------------------------------------

// `f x y = …`, `let f x y = …`: the names from `name` to before `past`.
void ForeignSyntax::foreign_curried(Index first, Index name, Index past) {
    std::string head = "fn " + std::string(text(name)) + "(";
    for (Index i = name + 1; i < past; ++i)
        head += (i > name + 1 ? ", " : "") + std::string(text(i));
    head += ")";
    lost_.push_back(name);
    foreign(span(first, past - 1), "a function is declared with `fn`")
        .help(to_write(head), {{span(first, past - 1), head}});
}

// `def f(x: float) -> float:`, `function f(x: number): number {`, `float f(vec3 p) {`.
void ForeignSyntax::foreign_function(Index first, Index name, bool has_type) {
    const Index open = name + 1, close = match(open);
    std::string head = "fn " + std::string(text(name)) + "(" + parameters_text(open) + ")";
    const auto begins_body = [&](Index i) {
        return is_one_of(kind(i), {Tok::Body, Tok::Trailing, Tok::StrayBrace, Tok::Assign});
    };
    Index after = close + 1; // behind the result's type
    if (kind(after) == Tok::Arrow) {
        while (!ends_statement(after) && kind(after) != Tok::Colon && !begins_body(after)) ++after;
        head += " -> " + std::string(our_type(text(token(close + 2).begin, token(after - 1).end)));
    } else if (kind(after) == Tok::Colon && kind(after + 1) == Tok::Name &&
               !token(after + 1).first_on_line && begins_body(after + 2)) {
        head += " -> " + std::string(our_type(text(after + 1)));
        after += 2;
    } else if (has_type && !is_their_own(text(name - 1)))
        head += " -> " + std::string(our_type(text(name - 1)));
    module_head(first, after, head);
    const bool below = kind(after) == Tok::End && kind(after + 1) == Tok::StrayBrace &&
                       text(after) != ";"; // the body's brace
    const std::vector<Edit> calls = returned_instead(name, below ? after + 1 : after, head);
    std::vector<Edit> edits{{span(first, after - 1), head}};
    edits.insert(edits.end(), calls.begin(), calls.end());
    if (below) {
        edits.push_back({{id_, token(after - 1).end, token(after + 1).end}, " {"});
        failed_ = after + 1;
    }
    if (kind(after) == Tok::Colon) {
        if (!indented_body(after, edits)) edits.clear();
        foreign(span(first, name),
                "a function is declared with `fn`, and its body stands in braces")
            .help("write `" + head + " { … }`", std::move(edits));
        return;
    }
    Diagnostic &d = foreign(span(first, name), "a function is declared with `fn`");
    std::string shape = kind(after) == Tok::End && failed_ <= after ? "" : shape_of_field(name);
    if (!shape.empty()) {
        const std::uint32_t end = token(match(failed_ > after ? failed_ : after)).end;
        edits.push_back({{id_, end, end}, "\n" + shape});
        shape = ", and the shape of this field, " + in_code(shape);
    }
    if (!calls.empty()) shape += ", which gives what it changed, and assign it";
    d.help("write " + in_code(head) + shape, std::move(edits));
    if (calls.empty()) note_changed(open, d);
}

// -- all -----------------------------------------------------------------------------------------

// `vec2 x = …`, `const x = …`, `float f(vec3 p) {`, `def f(x):`, `module f() {`.
bool ForeignSyntax::foreign_head(Index first) {
    Index name = first;
    while (kind(name + 1) == Tok::Name) ++name;
    if (name == first || kind(name) != Tok::Name) return false;
    const std::string word(text(first)), declared(text(name));
    const std::string type(our_type(text(name - 1)));
    const bool has_type = !is_one_of(type, qualifiers) && !is_one_of(type, function_words);

    if (kind(name + 1) == Tok::Open) {
        Index body = match(name + 1) + 1; // perhaps on the line below
        if (kind(body) == Tok::End && text(body) != ";") ++body;
        const bool is_function = is_one_of(word, function_words) || is_type_word(type) ||
                                 is_one_of(kind(body), {Tok::Body, Tok::Trailing, Tok::StrayBrace});
        if (!is_function) return false;
        if (declared.starts_with("main") && (word == "void" || word == "int")) {
            const Index close = match(body);
            foreign(span(first, name), "a scene has no " + in_code(declared))
                .note("the shapes that stand at top level are the scene")
                .help("leave it away", close > body ? std::vector<Edit>{{span(first, close), ""}}
                                                    : std::vector<Edit>{});
            return true;
        }
        foreign_function(first, name, has_type);
        return true;
    }
    if (word == "uniform" && hinted_param(first, name)) return true;
    const bool value = kind(name + 1) == Tok::Assign;
    if (value && (word == "uniform" || is_one_of(word, slider_words))) {
        lost_.push_back(name);
        foreign_param(first, name);
        return true;
    }
    const bool typed = name == first + 1 && is_their_own(word);
    const bool of_type = name == first + 1 && word[0] >= 'A' && word[0] <= 'Z'; // `Shape s = …`
    const bool curried = !typed && !of_type && !is_one_of(word, qualifiers) &&
                         !is_type_word(word) && !is_one_of(word, function_words);
    if (value && curried && arguments_by_space(first)) return true;
    if (value && curried) {
        foreign_curried(first, first, name + 1);
        return true;
    }
    if (value) {
        const bool changes = in_function_ && is_assigned_after(name);
        const bool known = has_type && type_named(type) != TypeName::Unknown;
        const std::string let =
            (changes ? "var " : "let ") + declared + (known && !changes ? ": " + type : "");
        Diagnostic &d = foreign(span(first, name),
                                changes    ? "a name that is assigned to later is bound with `var`"
                                : has_type ? "a type stands behind its name, after `let`"
                                           : "a name is bound with `let`");
        std::vector<Edit> edits{{span(first, name), let}};
        for (Edit &further : further_names(name + 2, name + 2)) edits.push_back(std::move(further));
        d.help(to_write(let + " = …"), std::move(edits));
        return true;
    }
    if (!ends_statement(name + 1)) return false;
    const bool stream = word == "uniform" || is_one_of(word, streams);
    if (!stream && !is_type_word(type) && !typed) return false;
    if (declared != "time") lost_.push_back(name);
    if (!foreign_stream(first, name)) foreign_unbound(first, name, type);
    return true;
}

// Behind the name of a `let`, `var` or `param`.
bool ForeignSyntax::foreign_binding(Index at) {
    const Tok found = kind(at);
    const Index before = at > 0 ? at - 1 : 0;
    if (found == Tok::EqualEqual) return foreign_instead(at, "a name is bound with one `=`", "=");
    if (found == Tok::Comma && kind(at + 1) == Tok::Name) {
        for (Index i = at + 1; kind(i) == Tok::Name; i += 2) lost_.push_back(i);
        foreign(span(before, at + 1), "each name is bound by a `let` of its own")
            .help("write `let " + std::string(text(before)) + " = …; let " +
                  std::string(text(at + 1)) + " = …`");
        return true;
    }
    if (found == Tok::In && kind(at - 2) == Tok::Param) {
        const std::string name(text(before));
        Diagnostic &d = diagnostics_.add(Code::ParamRange, span(before),
                                         "a param has a value beside its range");
        // of its own range the lower end, where that is a number
        if (kind(at + 1) == Tok::Number &&
            is_one_of(kind(at + 2), {Tok::DotDot, Tok::DotDotEqual})) {
            const std::string low(text(at + 1));
            d.help("write its value, " + in_code("param " + name + " = " + low + " in …") +
                       ", which may be any of the range",
                   {{{id_, token(before).end, token(before).end}, " = " + low}});
        } else
            d.help("write " + in_code("param " + name + " = 1 in 0..2"));
        return true;
    }
    if (range_in_parentheses(at)) return true;
    if (found == Tok::Open && kind(at - 2) == Tok::Let) {
        foreign(span(at - 2), "a function is declared with `fn`")
            .help("write `fn`", {{span(at - 2), "fn"}});
        return true;
    }
    if (found == Tok::ListOpen && kind(at + 1) == Tok::ListClose && kind(before) == Tok::Name &&
        kind(before - 1) == Tok::Colon) { // `l: float[]`
        const std::string type = "[" + std::string(text(before)) + "]";
        foreign(span(before, at + 1), "a list's type stands in brackets")
            .help(to_write(type), {{span(before, at + 1), type}});
        return true;
    }
    if (before > 0 && kind(before) == Tok::Name && kind(before - 1) != Tok::Colon &&
        !token(at).first_on_line &&
        is_one_of(found, {Tok::Number, Tok::String, Tok::Color, Tok::True, Tok::False})) {
        const std::uint32_t end = token(before).end;
        diagnostics_.add(Code::SyntaxError, span(at), "a `=` is missing before the value")
            .help("write `=`", {{{id_, end, end}, " ="}});
        return true;
    }
    if (found == Tok::Minus && before > 0 && kind(at + 1) == Tok::Name && touch(before, at) &&
        touch(at, at + 1)) {
        foreign_name_parts(before, at + 1);
        return true;
    }
    if (is_one_of(found, {Tok::PlusAssign, Tok::MinusAssign, Tok::StarAssign, Tok::SlashAssign})) {
        foreign(span(at), "a name is bound with `=`")
            .help("a `var` in a function is changed without `let`: " +
                  in_code(std::string(text(before)) + " " + std::string(text(at)) + " …"));
        return true;
    }
    const bool binds = kind(before - 1) == Tok::Let || kind(before - 1) == Tok::Var;
    if (binds && before > 0 && ends_statement(at)) {
        foreign_unbound(before - 1, before, {});
        return true;
    }
    if (found == Tok::Name && text(before) == "mut") {
        const bool changes = in_function_ && is_assigned_after(at);
        lost_.push_back(at);
        foreign(span(at - 2, before),
                changes ? "a name that changes is bound with `var`" : "a name is bound with `let`")
            .help(changes ? "write `var`" : "write `let`",
                  {{span(at - 2, before), changes ? "var" : "let"}});
        return true;
    }
    Index past = at;
    while (kind(past) == Tok::Name) ++past;
    if (found != Tok::Name || kind(before) != Tok::Name || kind(past) != Tok::Assign) return false;
    const bool recursive = text(before) == "rec";
    if (recursive && past == at + 1) {
        lost_.push_back(at);
        foreign(span(before), "a function calls itself without `rec`")
            .help("leave it away", {{{id_, token(before).begin, token(at).begin}, ""}});
        return true;
    }
    if (binds && past == at + 1 && !is_used_after(at) && !is_type_word(text(before)) &&
        !recursive && type_named(text(before)) == TypeName::Unknown) {
        const std::string name = std::string(text(before)) + "_" + std::string(text(at));
        lost_.push_back(at);
        std::vector<Edit> edits{{span(before, at), name}};
        constexpr std::size_t most_edits = 20;
        for (Index i = at + 1;
             may_look_far() && i + 1 < tokens_.tokens.size() && edits.size() < most_edits; ++i) {
            const bool same = kind(i) == Tok::Name && kind(i + 1) == Tok::Name &&
                              text(i) == text(before) && text(i + 1) == text(at);
            if (!same) continue;
            edits.push_back({span(i, i + 1), name});
            renamed_.insert(i + 1);
        }
        foreign(span(before, at), "a name is one word").help(to_write(name), std::move(edits));
        return true;
    }
    const bool typed = is_type_word(text(before)) || type_named(text(before)) != TypeName::Unknown;
    if (!typed && binds) {
        foreign_curried(before - 1, recursive ? at : before, past);
        return true;
    }
    if (past != at + 1) return false;
    const std::string written = std::string(text(at)) + ": " + std::string(text(before));
    lost_.push_back(at);
    foreign(span(before, at), "a type stands behind its name")
        .help(to_write(written), {{span(before, at), written}});
    return true;
}

} // namespace fathom::lang
