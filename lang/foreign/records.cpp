// Answers to records: what declares one, makes one and reads its parts. A record of other languages
// is a list here, made by a function, or each part a name of its own.
#include "lang/foreign/foreign.h"

#include <algorithm>

namespace fathom::lang {

namespace {

constexpr std::size_t most_fields = 20, most_edits = 60;

bool is_part_of_vector(std::string_view field) {
    return field.find_first_not_of("xyzw") == std::string_view::npos ||
           field.find_first_not_of("rgba") == std::string_view::npos;
}

} // namespace

// `struct Hit { float d; int mat; };`, `struct Ball { r: f32, c: Vec3 }`: a function that makes a
// list, and its parts by their places.
bool ForeignSyntax::foreign_struct(Index first) {
    const Index name = first + 1, open = name + 1, close = match(open);
    if (kind(name) != Tok::Name || close <= open ||
        !is_one_of(kind(open), {Tok::Trailing, Tok::Body, Tok::StrayBrace}) || !may_look_far())
        return false;
    std::vector<std::string_view> fields;
    for (Index i = open + 1; i < close; ++i) {
        const bool rust = kind(i) == Tok::Name && kind(i + 1) == Tok::Colon;
        const bool further = kind(i - 1) == Tok::Comma && !fields.empty(); // `vec3 o, d;`
        const bool c = kind(i) == Tok::Name && i > open + 1 &&
                       (kind(i - 1) == Tok::Name || further) &&
                       is_one_of(kind(i + 1), {Tok::End, Tok::Comma, Tok::BraceClose});
        if (rust || c) fields.push_back(text(i));
        if (match(i) > i) i = match(i);
    }
    if (fields.empty() || fields.size() > most_fields) return false;
    std::string row;
    for (const std::string_view field : fields)
        row += (row.empty() ? "" : ", ") + std::string(field);
    const std::string maker = "fn " + std::string(text(name)) + "(" + row + ") = [" + row + "]";
    const Index end = statement_end(first);
    std::vector<Edit> edits{
        {{id_, token(first).begin, token(std::max(close, end - 1)).end}, maker}};
    // the names that hold one
    std::vector<std::string_view> holders;
    bool is_bound = false; // `var<uniform> u: Uniforms`, whose parts are told with it
    for (Index i = close + 1; i + 2 < tokens_.tokens.size(); ++i) {
        if (kind(i) != Tok::Name || text(i) != text(name)) continue;
        if (kind(i + 1) == Tok::Name) holders.push_back(text(i + 1)); // `Hit h`
        if (kind(i - 1) == Tok::Colon && kind(i - 2) == Tok::Name) holders.push_back(text(i - 2));
        is_bound = is_bound || (kind(i - 1) == Tok::Colon && text(i - 3) == ">");
        if (kind(i - 1) == Tok::Assign && kind(i - 2) == Tok::Name) holders.push_back(text(i - 2));
    }
    for (Index i = close + 1; i + 1 < tokens_.tokens.size() && edits.size() < most_edits; ++i) {
        if (kind(i) != Tok::Dot || kind(i + 1) != Tok::Name || kind(i + 2) == Tok::Open) continue;
        const auto field = std::ranges::find(fields, text(i + 1));
        const bool held =
            kind(i - 1) == Tok::Name && std::ranges::find(holders, text(i - 1)) != holders.end();
        if (field == fields.end() || (!held && is_part_of_vector(*field))) continue;
        edits.push_back({span(i, i + 1), "[" + std::to_string(field - fields.begin()) + "]"});
    }
    failed_ = close;
    lost_.push_back(name);
    if (is_bound) {
        foreign(span(first, name), "nothing is bound from outside: what a slider sets is a `param`")
            .help("leave it away", {{edits.front().span, ""}});
        return true;
    }
    foreign(span(first, name),
            "there are no records: several values are a list, made by a function")
        .help("write " + in_code(maker) + ", and " + in_code("v[0]") + " for " +
                  in_code("v." + std::string(fields[0])),
              std::move(edits));
    return true;
}

// `let cfg = {r: 1, "h": 2}`, at the brace: a name for each part, in all places.
bool ForeignSyntax::named_record(Index brace) {
    const bool call = kind(brace) == Tok::Open; // `dict(r = 1)`
    const Index close = match(brace), name = brace < 3 ? 0 : brace - (call ? 3 : 2);
    if (brace < (call ? 3u : 2u) || kind(name + 1) != Tok::Assign || kind(name) != Tok::Name ||
        close <= brace || !may_look_far())
        return false;
    const bool declared = name > 0 && is_one_of(kind(name - 1), {Tok::Let, Tok::Var, Tok::Name});
    const Index first = declared ? name - 1 : name;
    const std::string prefix = std::string(text(name)) + "_";
    std::string lets;
    std::vector<std::string_view> keys;
    const auto key_at = [&](Index i) {
        const std::string_view word = text(i);
        return kind(i) == Tok::String ? word.substr(1, word.size() - 2) : word;
    };
    for (Index i = brace + 1; i < close;) {
        if (is_one_of(kind(i), {Tok::Comma, Tok::End})) {
            ++i;
            continue;
        }
        if (!is_one_of(kind(i), {Tok::Name, Tok::String}) || keys.size() == most_fields ||
            !is_one_of(kind(i + 1), {Tok::Colon, Tok::Assign}))
            return false;
        Index end = i + 2;
        while (end < close && !is_one_of(kind(end), {Tok::Comma, Tok::End})) {
            if (kind(end) == Tok::StrayBrace) return false;
            if (call && kind(end) == Tok::Assign) return false;
            end = match(end) > end ? match(end) + 1 : end + 1;
        }
        if (end == i + 2) return false;
        keys.push_back(key_at(i));
        if (keys.back().find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_"
                                          "0123456789") != std::string_view::npos)
            return false;
        std::string_view value = text(token(i + 1).end, token(end - 1).end);
        value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
        lets += (lets.empty() ? "let " : "; let ") + prefix + std::string(keys.back()) + " = " +
                std::string(value);
        i = end;
    }
    if (keys.empty()) return false;
    std::vector<Edit> edits{{span(first, close), lets}};
    for (Index i = close + 1; i + 1 < tokens_.tokens.size() && edits.size() < most_edits; ++i) {
        if (kind(i) != Tok::Name || text(i) != text(name)) continue;
        const std::string_view ahead = text(0, token(i).begin);
        const std::uint32_t spread = ahead.ends_with("**") ? 2 : ahead.ends_with("...") ? 3 : 0;
        if (spread > 0 && kind(i + 1) != Tok::Dot) { // `f(**cfg)`
            std::string row;
            for (const std::string_view key : keys)
                row +=
                    (row.empty() ? "" : ", ") + std::string(key) + ": " + prefix + std::string(key);
            edits.push_back({{id_, token(i).begin - spread, token(i).end}, row});
            continue;
        }
        const bool part = kind(i + 1) == Tok::Dot && kind(i + 2) == Tok::Name;
        const bool index = kind(i + 1) == Tok::ListOpen && kind(i + 2) == Tok::String &&
                           kind(i + 3) == Tok::ListClose;
        if (!part && !index) continue;
        const std::string_view key = key_at(i + 2);
        if (std::ranges::find(keys, key) == keys.end()) continue;
        edits.push_back({span(i, index ? i + 3 : i + 2), prefix + std::string(key)});
    }
    failed_ = close;
    lost_.push_back(name);
    for (Index i = brace + 1; i < tokens_.tokens.size() && i < close + 2000; ++i)
        if (kind(i) == Tok::String || (call && kind(i) == Tok::Assign && i < close))
            diagnostics_.withdraw(Code::ForeignSyntax, span(i));
    foreign(call ? span(brace - 1, close) : span(brace),
            "there are no records: each part is a name of its own")
        .help(to_write(lets), std::move(edits));
    return true;
}

// `opts = dict(r = 1)`, at the call's name.
bool ForeignSyntax::called_record(Index made) {
    return kind(made) == Tok::Name && text(made) == "dict" && kind(made + 1) == Tok::Open &&
           named_record(made + 1);
}

// `({ x, z }) => …`, at the brace.
bool ForeignSyntax::parameters_in_braces(Index brace) {
    const Index close = match(brace);
    if (brace == 0 || !is_one_of(kind(brace - 1), {Tok::Open, Tok::FreshOpen, Tok::LambdaOpen}) ||
        kind(close + 1) != Tok::Close || close == brace + 1)
        return false;
    for (Index i = brace + 1; i < close; ++i)
        if (!is_one_of(kind(i), {Tok::Name, Tok::Comma, Tok::End})) return false;
    foreign(span(brace), "parameters need no braces: their names are given in the call")
        .help("leave the braces away", {{span(brace), ""}, {span(close), ""}});
    return true;
}

} // namespace fathom::lang
