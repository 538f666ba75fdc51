// Diagnostics as JSON, for editors and scripts; the form is fixed in diagnostic.h.
#include "base/diagnostic.h"
#include "base/text.h"

#include <nlohmann/json.hpp>

namespace fathom {

namespace {

using Json = nlohmann::ordered_json;

std::string_view severity_name(Severity severity) {
    switch (severity) {
    case Severity::Error: return "error";
    case Severity::Warning: return "warning";
    case Severity::Note: return "note";
    }
    return "";
}

template <class T, class Write> Json array_of(const std::vector<T> &items, Write write) {
    Json out = Json::array();
    for (const T &item : items) out.push_back(write(item));
    return out;
}

} // namespace

Json place_json(const Sources &sources, Span span) {
    if (!span.source)
        return {{"file", nullptr},
                {"line", nullptr},
                {"column", nullptr},
                {"end_line", nullptr},
                {"end_column", nullptr}};
    const Source &source = sources[span.source];
    const Position begin = position(source, span.begin), end = position(source, span.end);
    return {{"file", source.name},
            {"line", begin.line},
            {"column", begin.column},
            {"end_line", end.line},
            {"end_column", end.column}};
}

Json to_json(const Diagnostic &diagnostic, const Sources &sources) {
    const auto label = [&](const Label &l) {
        Json out = place_json(sources, l.span);
        out["message"] = l.message;
        return out;
    };
    const auto edit = [&](const Edit &e) {
        Json out = place_json(sources, e.span);
        out["replacement"] = e.replacement;
        return out;
    };
    Json out{{"code", code_name(diagnostic.code)},
             {"severity", severity_name(diagnostic.severity)},
             {"message", diagnostic.message}};
    out.update(place_json(sources, diagnostic.primary.span));
    out["label"] = diagnostic.primary.message;
    out["labels"] = array_of(diagnostic.related, label);
    out["notes"] = diagnostic.notes;
    out["fix"] = nullptr;
    if (diagnostic.fix)
        out["fix"] = {{"message", diagnostic.fix->message},
                      {"edits", array_of(diagnostic.fix->edits, edit)}};
    return out;
}

std::string json_text(const Json &document) {
    return document.dump(-1, ' ', true, Json::error_handler_t::replace);
}

} // namespace fathom
