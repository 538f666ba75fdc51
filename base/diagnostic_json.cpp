// Diagnostics as JSON, for editors and scripts; the form is fixed in diagnostic.h.
#include "base/diagnostic.h"
#include "base/text.h"

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
    out += json_string(name);
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
    add_field(out, "file", json_string(source.name));
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
        add_field(out, "message", json_string(l.message));
        return out + "}";
    };
    const auto edit = [&](const Edit &e) {
        std::string out = "{";
        add_place(out, sources, e.span);
        add_field(out, "replacement", json_string(e.replacement));
        return out + "}";
    };
    const auto fix = [&](const Fix &f) {
        std::string out = "{";
        add_field(out, "message", json_string(f.message));
        add_field(out, "edits", array_of(f.edits, edit));
        return out + "}";
    };

    std::string out = "{";
    add_field(out, "code", json_string(code_name(diagnostic.code)));
    add_field(out, "severity", json_string(severity_name(diagnostic.severity)));
    add_field(out, "message", json_string(diagnostic.message));
    add_place(out, sources, diagnostic.primary.span);
    add_field(out, "label", json_string(diagnostic.primary.message));
    add_field(out, "labels", array_of(diagnostic.related, label));
    add_field(out, "notes", array_of(diagnostic.notes, json_string));
    add_field(out, "fix", diagnostic.fix ? fix(*diagnostic.fix) : "null");
    return out + "}";
}

} // namespace fathom
