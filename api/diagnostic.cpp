#include "api/impl.h"

namespace fathom::v1 {
namespace {

Severity severity_of(fathom::Severity severity) {
    switch (severity) {
    case fathom::Severity::Error: return Severity::Error;
    case fathom::Severity::Warning: return Severity::Warning;
    case fathom::Severity::Note: return Severity::Note;
    }
    return Severity::Error;
}

} // namespace

Place place_of(Span span, const Sources &sources) {
    if (!span.source) return {};
    const Source &source = sources[span.source];
    const Position begin = position(source, span.begin), end = position(source, span.end);
    return {source.name,
            static_cast<int>(begin.line),
            static_cast<int>(begin.column),
            static_cast<int>(end.line),
            static_cast<int>(end.column),
            span.begin,
            span.end};
}

Diagnostic translated(const fathom::Diagnostic &from, const Sources &sources) {
    Diagnostic to;
    to.severity = severity_of(from.severity);
    to.code = code_name(from.code);
    to.message = from.message;
    to.at = place_of(from.primary.span, sources);
    for (const fathom::Label &label : from.related)
        to.related.push_back({place_of(label.span, sources), label.message});
    if (!from.primary.message.empty())
        to.related.insert(to.related.begin(), {to.at, from.primary.message});
    to.notes = from.notes;
    if (from.fix) {
        to.help = from.fix->message;
        for (const fathom::Edit &edit : from.fix->edits)
            to.edits.push_back({place_of(edit.span, sources), edit.replacement});
    }
    return to;
}

std::vector<Diagnostic> translated(const Diagnostics &diagnostics, const Sources &sources) {
    std::vector<Diagnostic> all;
    for (const fathom::Diagnostic &diagnostic : diagnostics.sorted())
        all.push_back(translated(diagnostic, sources));
    return all;
}

Diagnostic sentence(std::string code, std::string message) {
    Diagnostic diagnostic;
    diagnostic.code = std::move(code);
    diagnostic.message = std::move(message);
    return diagnostic;
}

} // namespace fathom::v1
