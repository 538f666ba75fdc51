// What is known and proved, beside the text: diagnostics, hover, hints, lenses, explanations.
#include "lsp/kept.h"
#include "lsp/requests.h"

#include <fathom/reference.h>

#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace fathom::lsp {
namespace {

int severity_of(v1::Severity severity) {
    switch (severity) {
    case v1::Severity::Error: return 1;
    case v1::Severity::Warning: return 2;
    case v1::Severity::Note: return 3;
    }
    return 1;
}

Json place_json(Session &session, OpenText &text, const v1::Place &place) {
    if (place.line == 0) return json_of(Range{});
    if (place.file == text.path)
        return range_json(lines_of(session, text), {place.begin, place.end});
    return json_of(range_of(place));
}

// The page of a code as a file; nothing where it has none.
std::optional<std::filesystem::path> page_of(const std::string &code) {
    static const std::vector<v1::DiagnosticCode> codes = v1::diagnostic_codes();
    for (const v1::DiagnosticCode &one : codes)
        if (one.name == code && !one.page.empty())
            return kept_file("diagnostics/" + code + ".md", one.page);
    return std::nullopt;
}

void explain(const v1::Explanation &node, int depth, std::string &out) {
    out += std::string(static_cast<std::size_t>(depth) * 2, ' ');
    out += fmt::format("{}{}: {:.4g}", node.steepest ? "* " : "", node.operation, node.lipschitz);
    if (std::abs(node.factor - 1) > 1e-9) out += fmt::format(" (x {:.4g})", node.factor);
    if (!node.rule.empty()) out += ", " + node.rule;
    if (!node.region.empty() && node.region != "everywhere") out += ", in " + node.region;
    if (node.at.line > 0) out += fmt::format("  (line {})", node.at.line);
    out += '\n';
    for (const v1::Explanation &child : node.children) explain(child, depth + 1, out);
}

} // namespace

Json diagnostic_json(Session &session, OpenText &text, const v1::Diagnostic &diagnostic) {
    std::string message = diagnostic.message;
    for (const std::string &note : diagnostic.notes) message += "\nnote: " + note;
    if (!diagnostic.help.empty()) message += "\nhelp: " + diagnostic.help;
    Json related = Json::array();
    const std::filesystem::path folder = std::filesystem::path(text.path).parent_path();
    for (const v1::Label &label : diagnostic.related) {
        const std::string uri =
            label.at.file == text.path
                ? text.uri
                : Places(session).uri((folder / label.at.file).lexically_normal().string());
        related.push_back(
            {{"location", {{"uri", uri}, {"range", place_json(session, text, label.at)}}},
             {"message", label.message}});
    }
    Json said{{"range", place_json(session, text, diagnostic.at)},
              {"severity", severity_of(diagnostic.severity)},
              {"code", diagnostic.code},
              {"source", "fathom"},
              {"message", message},
              {"relatedInformation", std::move(related)}};
    if (const auto page = page_of(diagnostic.code))
        said["codeDescription"] = {{"href", uri_of(page->string())}};
    return said;
}

Json diagnostics_of(Session &session, OpenText &text) {
    Json all = Json::array();
    for (const v1::Diagnostic &diagnostic : taken(session.workspace.diagnostics(text.path)))
        if (diagnostic.at.line == 0 || diagnostic.at.file == text.path)
            all.push_back(diagnostic_json(session, text, diagnostic));
    return all;
}

Json hover(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const v1::Hover known =
        taken(session.workspace.hover(text.path, offset_of(session, text, params.at("position"))));
    if (known.empty()) return nullptr;
    std::string words;
    const auto add = [&words](const std::string &part) {
        words += (words.empty() ? "" : "\n\n---\n\n") + part;
    };
    for (const std::string &error : known.errors) add(error);
    if (!known.name.empty()) add(known.name);
    for (const v1::LibraryEntry &entry : known.entries)
        if (const auto picture = picture_of_entry(entry.name, entry.module, entry.doc)) {
            words += fmt::format("\n\n![{}]({})", entry.name, uri_of(picture->string()));
            break;
        }
    for (const std::string &fact : known.facts) add(fact);
    Json answer{{"contents", markdown(words)}};
    if (known.at.begin < known.at.end)
        answer["range"] = range_json(lines_of(session, text), known.at);
    return answer;
}

// Where a shape's bound is above 1, the bound, at the end of its statement; names of arguments.
Json inlay_hints(Session &session, const Json &params) {
    constexpr int of_parameter = 2;
    OpenText &text = text_of(session, params);
    const Lines &lines = lines_of(session, text);
    const v1::Stretch within = params.contains("range") ? stretch_of(session, text, params["range"])
                                                        : v1::Stretch{0, lines.text.size()};
    Json hints = Json::array();
    for (const v1::BoundAt &bound : taken(session.workspace.bounds(text.path)))
        if (bound.lipschitz > 1 && bound.at.end >= within.begin && bound.at.begin <= within.end)
            hints.push_back({{"position", json_of(position_at(lines, bound.at.end))},
                             {"label", fmt::format("bound {:.3g}", bound.lipschitz)},
                             {"tooltip", bound.words},
                             {"paddingLeft", true}});
    for (const v1::ArgumentName &argument :
         taken(session.workspace.argument_names(text.path, within)))
        hints.push_back({{"position", json_of(position_at(lines, argument.at))},
                         {"label", argument.name + ":"},
                         {"kind", of_parameter},
                         {"paddingRight", true}});
    return hints;
}

// Above each top-level shape its bound, which explains itself, and above the first one a window.
Json code_lenses(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    Json lenses = Json::array();
    const auto lens = [&](v1::Stretch at, const std::string &title, const char *command) {
        lenses.push_back(
            {{"range", range_json(lines_of(session, text), at)},
             {"command", {{"title", title}, {"command", command}, {"arguments", {text.uri}}}}});
    };
    const std::vector<v1::BoundAt> bounds = taken(session.workspace.bounds(text.path));
    if (!bounds.empty()) lens(bounds.front().at, "show", "fathom.show");
    for (const v1::BoundAt &bound : bounds)
        lens(bound.at, bound.words + ": explain", "fathom.explain");
    return lenses;
}

// `fathom.explain` [address]: why the bounds are what they are, as text, which is shown as well.
// `fathom.show` [address] is answered by who serves (preview.h).
Json execute_command(Session &session, const Json &params) {
    const std::string command = params.at("command");
    if (command == "fathom.show") throw Refusal("no window can be opened from here");
    if (command != "fathom.explain") throw Refusal("there is no command " + command);
    const std::string uri = params.at("arguments").at(0);
    const auto text = session.texts.find(uri);
    if (text == session.texts.end()) throw UnknownDocument();
    std::string words;
    explain(taken(session.workspace.explanation(text->second.path)), 0, words);
    constexpr int info = 3;
    session.said.push_back({"window/showMessage", {{"type", info}, {"message", words}}});
    return words;
}

} // namespace fathom::lsp
