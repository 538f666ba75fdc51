// The table of codes and the collection of diagnostics. How they are printed: diagnostic_text.cpp
// and diagnostic_json.cpp.
#include "base/diagnostic.h"

#include "base/text.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace fathom {

namespace {

struct CodeRow {
    Code code;
    std::string_view name;
    Severity severity;
    std::string_view summary;
};

constexpr std::array code_rows = {
#define FATHOM_CODE(name, text, severity, summary)                                                 \
    CodeRow{Code::name, text, Severity::severity, summary},
#include "base/codes.def"
#undef FATHOM_CODE
};

const CodeRow &row_of(Code code) { return code_rows[static_cast<std::size_t>(code)]; }

// Nobody reads more; and comparing with all of them for repeats stays cheap.
constexpr std::size_t limit = 200;
constexpr std::size_t message_bytes = 2000;             // of one message, label, note, help
constexpr std::size_t all_bytes = std::size_t{1} << 20; // of all that are kept

void shorten(std::string &text) {
    if (text.size() > message_bytes) text = shortened(text, message_bytes);
}

// An edit is right as a whole or not at all.
void shorten(Fix &fix) {
    shorten(fix.message);
    std::size_t bytes = 0;
    for (const Edit &edit : fix.edits) bytes += edit.replacement.size();
    if (bytes > all_bytes / 16) fix.edits.clear();
}

void shorten(Diagnostic &diagnostic) {
    shorten(diagnostic.message);
    shorten(diagnostic.primary.message);
    for (Label &label : diagnostic.related) shorten(label.message);
    for (std::string &note : diagnostic.notes) shorten(note);
    if (diagnostic.fix) shorten(*diagnostic.fix);
}

std::size_t bytes_of(const Diagnostic &diagnostic) {
    std::size_t bytes = diagnostic.message.size() + diagnostic.primary.message.size();
    for (const Label &label : diagnostic.related) bytes += label.message.size();
    for (const std::string &note : diagnostic.notes) bytes += note.size();
    if (diagnostic.fix) {
        bytes += diagnostic.fix->message.size();
        for (const Edit &edit : diagnostic.fix->edits) bytes += edit.replacement.size();
    }
    return bytes;
}

} // namespace

std::string_view code_name(Code code) { return row_of(code).name; }
std::string_view code_summary(Code code) { return row_of(code).summary; }
Severity code_severity(Code code) { return row_of(code).severity; }

std::optional<Code> code_by_name(std::string_view name) {
    for (const CodeRow &row : code_rows)
        if (row.name == name) return row.code;
    return std::nullopt;
}

std::vector<Code> all_codes() {
    std::vector<Code> codes;
    for (const CodeRow &row : code_rows) codes.push_back(row.code);
    return codes;
}

Diagnostic &Diagnostic::label(Span span, std::string text) & {
    shorten(text);
    related.push_back({span, std::move(text)});
    return *this;
}

Diagnostic &Diagnostic::note(std::string text) & {
    shorten(text);
    notes.push_back(std::move(text));
    return *this;
}

Diagnostic &Diagnostic::help(std::string text, std::vector<Edit> edits) & {
    fix = Fix{std::move(text), std::move(edits)};
    shorten(*fix);
    return *this;
}

Diagnostic &Diagnostics::add(Code code, Span primary, std::string message) {
    shorten(message);
    Diagnostic diagnostic{code, code_severity(code), std::move(message), {primary, {}}, {}, {}, {}};
    overflow_ = diagnostic; // where it is not kept: a place for refinements that nobody will see
    Diagnostic *kept = keep(std::move(diagnostic));
    return kept ? *kept : overflow_;
}

void Diagnostics::add(Diagnostic diagnostic) { keep(std::move(diagnostic)); }

Diagnostic *Diagnostics::keep(Diagnostic diagnostic) {
    shorten(diagnostic);
    const auto same = [&](const Diagnostic &d) {
        return d.primary.span == diagnostic.primary.span && d.code == diagnostic.code &&
               d.message == diagnostic.message;
    };
    if (std::any_of(items_.begin(), items_.end(), same)) return nullptr;
    const bool error = diagnostic.severity == Severity::Error;
    errors_ += error;
    // The last one may have been refined since it came.
    std::size_t bytes = bytes_of(diagnostic);
    for (const Diagnostic &d : items_) bytes += bytes_of(d);
    if (items_.size() >= limit || bytes > all_bytes) {
        ++dropped_;
        // An error is worth more than a remark that holds its place.
        const auto lesser = std::find_if(items_.begin(), items_.end(), [](const Diagnostic &d) {
            return d.severity != Severity::Error;
        });
        if (!error || lesser == items_.end()) return nullptr;
        items_.erase(lesser);
    }
    items_.push_back(std::move(diagnostic));
    return &items_.back();
}

Diagnostic *Diagnostics::find(Code code, Span primary) {
    const auto it = std::find_if(items_.begin(), items_.end(), [&](const Diagnostic &d) {
        return d.code == code && d.primary.span == primary;
    });
    return it == items_.end() ? nullptr : &*it;
}

void Diagnostics::withdraw(Code code, Span primary) {
    const auto it = std::find_if(items_.begin(), items_.end(), [&](const Diagnostic &d) {
        return d.code == code && d.primary.span == primary;
    });
    if (it == items_.end()) return;
    errors_ -= it->severity == Severity::Error;
    items_.erase(it);
}

std::size_t Diagnostics::warnings() const {
    return static_cast<std::size_t>(
        std::count_if(items_.begin(), items_.end(),
                      [](const Diagnostic &d) { return d.severity == Severity::Warning; }));
}

std::vector<Diagnostic> Diagnostics::sorted() const {
    std::vector<Diagnostic> sorted = items_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic &a, const Diagnostic &b) {
        const auto key = [](const Diagnostic &d) {
            return std::tuple(d.primary.span.source.index, d.primary.span.begin, d.severity);
        };
        return key(a) < key(b);
    });
    return sorted;
}

} // namespace fathom
