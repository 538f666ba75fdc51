// Diagnostics as JSON, for editors and scripts; the form is fixed in diagnostic.h.
#include "base/diagnostic.h"
#include "base/encode.h"

namespace fathom {

namespace {

std::string_view severity_name(Severity severity) {
    switch (severity) {
    case Severity::Error: return "error";
    case Severity::Warning: return "warning";
    case Severity::Note: return "note";
    }
    return "";
}

void add_field(std::string &out, std::string_view name, std::string_view json) {
    if (out.back() != '{') out += ", ";
    out += for_json(name);
    out += ": ";
    out += json;
}

void add_place(std::string &out, const Sources &sources, Span span) {
    if (!span.source) {
        for (const char *name : {"file", "line", "column", "end_line", "end_column"})
            add_field(out, name, "null");
        return;
    }
    const Source &source = sources[span.source];
    const Position begin = position(source, span.begin), end = position(source, span.end);
    add_field(out, "file", for_json(source.name));
    add_field(out, "line", std::to_string(begin.line));
    add_field(out, "column", std::to_string(begin.column));
    add_field(out, "end_line", std::to_string(end.line));
    add_field(out, "end_column", std::to_string(end.column));
}

template <class T, class Write> std::string array_of(const std::vector<T> &items, Write write) {
    std::string out = "[";
    for (const T &item : items) {
        if (out.size() > 1) out += ", ";
        out += write(item);
    }
    return out + "]";
}

} // namespace

std::string to_json(const Diagnostic &diagnostic, const Sources &sources) {
    const auto label = [&](const Label &l) {
        std::string out = "{";
        add_place(out, sources, l.span);
        add_field(out, "message", for_json(l.message));
        return out + "}";
    };
    const auto edit = [&](const Edit &e) {
        std::string out = "{";
        add_place(out, sources, e.span);
        add_field(out, "replacement", for_json(e.replacement));
        return out + "}";
    };
    const auto fix = [&](const Fix &f) {
        std::string out = "{";
        add_field(out, "message", for_json(f.message));
        add_field(out, "edits", array_of(f.edits, edit));
        return out + "}";
    };

    std::string out = "{";
    add_field(out, "code", for_json(code_name(diagnostic.code)));
    add_field(out, "severity", for_json(severity_name(diagnostic.severity)));
    add_field(out, "message", for_json(diagnostic.message));
    add_place(out, sources, diagnostic.primary.span);
    add_field(out, "label", for_json(diagnostic.primary.message));
    add_field(out, "labels", array_of(diagnostic.related, label));
    add_field(out, "notes", array_of(diagnostic.notes, for_json));
    add_field(out, "fix", diagnostic.fix ? fix(*diagnostic.fix) : "null");
    return out + "}";
}

} // namespace fathom
