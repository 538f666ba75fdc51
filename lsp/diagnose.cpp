// What is wrong with a text, and the places of requests.
#include "lsp/kept.h"
#include "lsp/requests.h"

#include "driver/pages.h"

namespace fathom::lsp {

using fathom::v1::Diagnostic;

namespace {

int severity_of(fathom::v1::Severity severity) {
    switch (severity) {
    case fathom::v1::Severity::Error: return 1;
    case fathom::v1::Severity::Warning: return 2;
    case fathom::v1::Severity::Note: return 3;
    }
    return 1;
}

} // namespace

Document &document_of(Workspace &workspace, const Json &params) {
    return document_at(workspace, params.at("textDocument").at("uri").get<std::string>());
}

std::size_t offset_of(const Document &document, const Json &params) {
    return offset_at(document.text, position_of(params.at("position")));
}

Json range_json(const Lines &lines, Span span) {
    return json_of(range_of(lines, span.begin, span.end));
}

Json place_of(Document &document, const fathom::v1::Place &place) {
    if (place.line == 0) return json_of(Range{});
    if (place.file == document.path)
        return json_of(range_of(reading(document).lines, place.begin, place.end));
    return json_of(range_of(place));
}

Json diagnostic_json(Document &document, const Diagnostic &diagnostic) {
    std::string message = diagnostic.message;
    for (const std::string &note : diagnostic.notes) message += "\nnote: " + note;
    if (!diagnostic.help.empty()) message += "\nhelp: " + diagnostic.help;
    Json related = Json::array();
    const std::filesystem::path folder = std::filesystem::path(document.path).parent_path();
    for (const fathom::v1::Label &label : diagnostic.related) {
        const std::string file = label.at.file == document.path
                                     ? document.path
                                     : (folder / label.at.file).lexically_normal().string();
        related.push_back(
            {{"location", {{"uri", uri_of(file)}, {"range", place_of(document, label.at)}}},
             {"message", label.message}});
    }
    Json said{{"range", place_of(document, diagnostic.at)},
              {"severity", severity_of(diagnostic.severity)},
              {"code", diagnostic.code},
              {"source", "fathom"},
              {"message", message},
              {"relatedInformation", std::move(related)}};
    for (const auto &[file, text] : driver::diagnostic_pages())
        if (file == diagnostic.code + ".md")
            if (const auto page = kept_file("diagnostics/" + std::string(file), text))
                said["codeDescription"] = {{"href", uri_of(page->string())}};
    return said;
}

Json diagnostics_of(Workspace &workspace, Document &document) {
    Json all = Json::array();
    for (const Diagnostic &diagnostic : compiled(workspace, document).diagnostics)
        if (diagnostic.at.line == 0 || diagnostic.at.file == document.path)
            all.push_back(diagnostic_json(document, diagnostic));
    return all;
}

} // namespace fathom::lsp
