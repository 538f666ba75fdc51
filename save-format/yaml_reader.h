// YAML text as a stream of events with places, and single values of it: what the importer reads.
// The only user of libyaml (in yaml_reader.cpp). Knows nothing of what the items of a save file
// mean.
#pragma once

#include "base/diagnostic.h"
#include "base/single.h"

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace fathom::save {

// A diagnostic that is given when its words are complete, at the end of the statement that makes
// it: only then is it known how severe it is, which `Diagnostics` counts.
class Remark {
  public:
    Remark(Diagnostics &to, Diagnostic diagnostic) : to_(to), diagnostic_(std::move(diagnostic)) {}
    ~Remark() { to_.add(std::move(diagnostic_)); }
    Remark(const Remark &) = delete;
    Remark &operator=(const Remark &) = delete;

    Remark &note(std::string text) {
        diagnostic_.note(std::move(text));
        return *this;
    }
    Remark &help(std::string text) {
        diagnostic_.help(std::move(text));
        return *this;
    }

  private:
    Diagnostics &to_;
    Diagnostic diagnostic_;
};

// Where the importer's complaints go: content is a warning unless strict, structure an error.
struct Report {
    Diagnostics &diagnostics;
    bool strict = false;

    Remark content(Span span, std::string message, Code code = Code::YamlValue);
    Remark structure(Span span, std::string message);
};

// The kinds of YAML events.
enum class EventKind {
    Scalar,
    SequenceStart,
    SequenceEnd,
    MappingStart,
    MappingEnd,
    End,   // of the document
    Broken // nothing can be read any more; reported once, and given for ever
};

// One YAML event with its place.
struct Event {
    EventKind kind = EventKind::End;
    Span span;
    std::string text;   // Scalar
    bool plain = false; // Scalar: not in quotes, so that `true` and `1` are more than text
};

// Pulls events. Aliases and tags are reported and stand as an empty plain scalar or nothing;
// nesting is limited.
class YamlReader {
  public:
    YamlReader(std::string_view text, SourceId source, Report report, std::size_t max_depth);
    ~YamlReader();
    YamlReader(const YamlReader &) = delete;
    YamlReader &operator=(const YamlReader &) = delete;

    Event next();
    bool more_documents(); // after End
    bool broken() const { return broken_; }
    void break_off(Span span,
                   std::string message); // a structure that the caller cannot read on from

  private:
    struct Parser;
    Span span_of(const void *event);
    std::uint32_t byte_offset(std::size_t character);
    Event fail(Span span, std::string message);

    std::unique_ptr<Parser> parser_;
    std::string_view text_;
    SourceId source_;
    Report report_;
    std::size_t max_depth_;
    std::size_t depth_ = 0;
    std::size_t cursor_character_ = 0;
    std::uint32_t cursor_byte_ = 0;
    std::uint32_t skipped_ = 0; // bytes before the text proper
    bool broken_ = false;
    bool ended_ = false;
};

struct Entry; // of a mapping

// One value, whole. `flow` is the same in YAML's flow form on one line, so that it can be written
// anywhere.
struct Value {
    enum class Kind { Scalar, Sequence, Mapping };
    Kind kind = Kind::Scalar;
    std::string text;
    bool plain = false;
    std::vector<Value> items;   // Sequence
    std::vector<Entry> entries; // Mapping; keys that are no scalars stand as their flow form
    bool complex_key = false;   // of an entry: its key is such a one
    Span span;

    const Value *find(std::string_view key) const; // without regard to case, spaces, `-` and `_`
};

// A key and its value.
struct Entry {
    std::string first; // the key
    Value second;
    Entry(std::string key, Value value) : first(std::move(key)), second(std::move(value)) {}
};

// A value and its text in flow form.
struct TakenValue {
    Value value;
    std::string flow;
    bool whole = true; // false: more than `limit` parts; `value` is cut short (`flow` never is)
};

// Reads the value that `first` begins. `limit` bounds the parts that are kept as a tree.
TakenValue take_value(YamlReader &reader, Event first, std::size_t limit = 4096);
// The same, when only the text is wanted; appended to `flow`.
void take_flow(YamlReader &reader, Event first, std::string &flow);
void skip_value(YamlReader &reader, const Event &first);

// The scalar in flow form: plain where that reads back as the same, in quotes elsewhere.
std::string flow_scalar(std::string_view text, bool plain);

// One value given as text (what `flow` held); a null scalar with `ok` false where it does not read.
struct ParsedText {
    Value value;
    bool ok = false;
};
ParsedText parse_text(std::string_view text);

std::string spelling_key(std::string_view name); // lower case, without spaces, `-` and `_`

// A scalar as a number or as a switch, in any spelling that is read; nothing where it is neither.
std::optional<double> number_of(const Value &value, double most = longest);
// What a scalar that is none would have to be: "a number", or what about it is wrong.
std::string wanted_number(const Value &value);
// How far a map displaces, and a map's scale, {X, Y} above 0; what is neither counts as its default.
constexpr double largest_amount = 1e6;
inline std::optional<double> legal_amount(const Value &value) {
    return number_of(value, largest_amount);
}
std::optional<std::array<double, 2>> legal_scale(const Value &value);
std::optional<bool> switch_of(const Value &value);
bool is_none(std::string_view word); // "<None>", "", "~"

} // namespace fathom::save
