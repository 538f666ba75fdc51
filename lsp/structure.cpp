// What a text looks like: tokens with their meaning, what folds, what selections grow to, colours.
#include "lsp/requests.h"

#include <algorithm>

namespace fathom::lsp {
namespace {

using Meaning = v1::SemanticToken::Meaning;

// The order is that of the legend.
constexpr const char *meanings[] = {"comment",   "keyword",  "string", "number",
                                    "operator",  "function", "method", "variable",
                                    "parameter", "property", "type",   "namespace"};
constexpr int declaration_bit = 1, readonly_bit = 2, library_bit = 4;

int number_of(Meaning meaning) {
    switch (meaning) {
    case Meaning::Comment: return 0;
    case Meaning::Keyword: return 1;
    case Meaning::String: return 2;
    case Meaning::Number: return 3;
    case Meaning::Operator: return 4;
    case Meaning::Function: return 5;
    case Meaning::Method: return 6;
    case Meaning::Variable: return 7;
    case Meaning::Parameter: return 8;
    case Meaning::Property: return 9;
    case Meaning::Type: return 10;
    case Meaning::Module: return 11;
    }
    return 7;
}

Json tokens_within(Session &session, OpenText &document, v1::Stretch within) {
    const Lines &lines = lines_of(session, document);
    Json data = Json::array();
    Position last;
    const auto put = [&](std::size_t begin, std::size_t end, const v1::SemanticToken &token) {
        const auto [start, stop] = range_of(lines, begin, end);
        const int length = stop.character - start.character;
        if (length == 0) return;
        data.insert(data.end(),
                    {start.line - last.line,
                     start.line == last.line ? start.character - last.character : start.character,
                     length, number_of(token.meaning),
                     (token.declared ? declaration_bit : 0) | (token.constant ? readonly_bit : 0) |
                         (token.library ? library_bit : 0)});
        last = start;
    };
    for (const v1::SemanticToken &token : taken(session.workspace.tokens(document.path, within)))
        for (std::size_t begin = token.at.begin;
             begin < token.at.end;) { // a comment may have lines
            const std::size_t end = std::min<std::size_t>(
                lines.text.substr(0, token.at.end).find('\n', begin), token.at.end);
            put(begin, end, token);
            begin = end + 1;
        }
    return {{"data", std::move(data)}};
}

} // namespace

Json semantic_legend() {
    return {{"tokenTypes", meanings},
            {"tokenModifiers", {"declaration", "readonly", "defaultLibrary"}}};
}

Json semantic_tokens(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    return tokens_within(session, text, {0, lines_of(session, text).text.size()});
}

Json semantic_tokens_of_range(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    return tokens_within(session, text, stretch_of(session, text, params.at("range")));
}

Json folding_ranges(Session &session, const Json &params) {
    using Kind = v1::FoldingRange::Kind;
    Json all = Json::array();
    for (const v1::FoldingRange &fold :
         taken(session.workspace.folding(text_of(session, params).path))) {
        Json range{{"startLine", fold.first - 1}, {"endLine", fold.last - 1}};
        if (fold.kind != Kind::Brackets)
            range["kind"] = fold.kind == Kind::Imports ? "imports" : "comment";
        all.push_back(std::move(range));
    }
    return all;
}

Json selection_ranges(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    Json all = Json::array();
    for (const Json &position : params.at("positions")) {
        Json chain;
        for (v1::Stretch at :
             taken(session.workspace.selections(text.path, offset_of(session, text, position)))) {
            Json step{{"range", range_json(lines_of(session, text), at)}};
            if (!chain.is_null()) step["parent"] = std::move(chain);
            chain = std::move(step);
        }
        all.push_back(std::move(chain));
    }
    return all;
}

Json document_colors(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    Json all = Json::array();
    for (const auto &[at, rgba] : taken(session.workspace.colors(text.path)))
        all.push_back(
            {{"range", range_json(lines_of(session, text), at)},
             {"color",
              {{"red", rgba[0]}, {"green", rgba[1]}, {"blue", rgba[2]}, {"alpha", rgba[3]}}}});
    return all;
}

Json color_presentations(Session &, const Json &params) {
    const Json &color = params.at("color");
    const auto part = [&](const char *name) { return color.at(name).get<double>(); };
    Json all = Json::array();
    for (const std::string &label :
         v1::color_texts({part("red"), part("green"), part("blue"), part("alpha")}))
        all.push_back(
            {{"label", label}, {"textEdit", {{"range", params.at("range")}, {"newText", label}}}});
    return all;
}

} // namespace fathom::lsp
