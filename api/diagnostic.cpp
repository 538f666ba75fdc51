#include "api/impl.h"

#include "base/encode.h"
#include "base/text.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::v1 {
Severity severity_of(fathom::Severity severity) {
    switch (severity) {
    case fathom::Severity::Error: return Severity::Error;
    case fathom::Severity::Warning: return Severity::Warning;
    case fathom::Severity::Note: return Severity::Note;
    }
    return Severity::Error;
}

namespace {

fathom::Severity internal_of(Severity severity) {
    switch (severity) {
    case Severity::Error: return fathom::Severity::Error;
    case Severity::Warning: return fathom::Severity::Warning;
    case Severity::Note: return fathom::Severity::Note;
    }
    return fathom::Severity::Error;
}

// The span of a place, or none where it lies in no text: a caller may have made it.
Span span_of(const Place &at, const Sources &sources) {
    if (at.text < 0 || static_cast<std::size_t>(at.text) >= sources.size()) return {};
    const SourceId source{static_cast<std::uint32_t>(at.text)};
    const std::size_t size = sources[source].text.size(), end = std::min(at.end, size);
    return {source, static_cast<std::uint32_t>(std::min(at.begin, end)),
            static_cast<std::uint32_t>(end)};
}

// The diagnostic as the compiler has it; `known` is false where it has no such code.
fathom::Diagnostic untranslated(const Diagnostic &from, const Sources &sources, bool &known) {
    const std::optional<Code> code = code_by_name(from.code);
    known = code.has_value();
    fathom::Diagnostic to;
    to.code = code.value_or(Code{});
    to.severity = internal_of(from.severity);
    to.message = from.message;
    to.primary.span = span_of(from.at, sources);
    for (const Label &label : from.related)
        if (label.primary)
            to.primary.message = label.message;
        else
            to.related.push_back({span_of(label.at, sources), label.message});
    to.notes = from.notes;
    if (from.help.empty() && from.edits.empty()) return to;
    to.fix.emplace().message = from.help;
    for (const Edit &edit : from.edits)
        to.fix->edits.push_back({span_of(edit.at, sources), edit.replacement});
    return to;
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
            span.end,
            static_cast<int>(span.source.index)};
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
        to.related.insert(to.related.begin(), {to.at, from.primary.message, true});
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

Texts texts_of(Sources sources) {
    auto impl = std::make_shared<Texts::Impl>();
    impl->own = std::move(sources);
    return Texts(std::move(impl));
}

std::size_t Texts::count() const { return impl_ ? impl_->sources().size() : 0; }
std::string_view Texts::name(std::size_t number) const {
    if (number >= count()) return {};
    return impl_->sources()[SourceId{static_cast<std::uint32_t>(number)}].name;
}
std::string_view Texts::text(std::size_t number) const {
    if (number >= count()) return {};
    return impl_->sources()[SourceId{static_cast<std::uint32_t>(number)}].text;
}

std::string printed(const Diagnostic &diagnostic, const Texts &texts, bool color) {
    return guarded(
        [&] {
            static const Sources none;
            const Sources &sources = texts.impl() ? texts.impl()->sources() : none;
            bool known = false;
            const fathom::Diagnostic whole = untranslated(diagnostic, sources, known);
            if (known) return to_text(whole, sources, color);
            return for_terminal("fathom: " + diagnostic.message) + "\n"; // of no text: `usage`, …
        },
        [](const Diagnostic &) { return std::string(); });
}

std::string beyond_proof(const Facts &facts) {
    return fmt::format("time: the scene is proved from 0 to {} seconds",
                       format_shortest(facts.time_end));
}

Diagnostic sentence(std::string code, std::string message) {
    Diagnostic diagnostic;
    diagnostic.code = std::move(code);
    diagnostic.message = std::move(message);
    return diagnostic;
}

} // namespace fathom::v1
