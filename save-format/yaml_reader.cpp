// libyaml's events with byte spans. Marks count characters, spans bytes: a cursor that only moves a
// little at a time turns one into the other, so that the whole stays linear.
#include "save-format/yaml_reader.h"

#include "base/text.h"

#include <yaml.h>

#include <algorithm>
#include <fmt/format.h>

namespace fathom::save {

Remark Report::content(Span span, std::string message, Code code) {
    const Severity severity = strict ? Severity::Error : Severity::Warning;
    return {diagnostics, Diagnostic{code, severity, std::move(message), {span, {}}, {}, {}, {}}};
}

Remark Report::structure(Span span, std::string message) {
    return {diagnostics,
            Diagnostic{
                Code::YamlStructure, Severity::Error, std::move(message), {span, {}}, {}, {}, {}}};
}

struct YamlReader::Parser {
    yaml_parser_t yaml{};
    bool ready = false;
    ~Parser() {
        if (ready) yaml_parser_delete(&yaml);
    }
};

YamlReader::YamlReader(std::string_view text, SourceId source, Report report, std::size_t max_depth)
    : parser_(std::make_unique<Parser>()), text_(text), source_(source), report_(report),
      max_depth_(max_depth) {
    parser_->ready = yaml_parser_initialize(&parser_->yaml) != 0;
    if (!parser_->ready) {
        fail(Span{source_, 0, 0}, "there is not enough memory to read the file");
        return;
    }
    // The format is UTF-8; libyaml would also guess UTF-16.
    if (text_.substr(0, 3) == "\xEF\xBB\xBF")
        skipped_ = cursor_byte_ = 3; // a byte order mark says nothing here
    yaml_parser_set_encoding(&parser_->yaml, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser_->yaml,
                                 reinterpret_cast<const unsigned char *>(text_.data()) + skipped_,
                                 text_.size() - skipped_);
}

YamlReader::~YamlReader() = default;

std::uint32_t YamlReader::byte_offset(std::size_t character) {
    auto is_continuation = [&](std::uint32_t at) {
        return (static_cast<unsigned char>(text_[at]) & 0xC0) == 0x80;
    };
    while (cursor_character_ > character && cursor_byte_ > 0) {
        do --cursor_byte_;
        while (cursor_byte_ > 0 && is_continuation(cursor_byte_));
        --cursor_character_;
    }
    while (cursor_character_ < character && cursor_byte_ < text_.size()) {
        do ++cursor_byte_;
        while (cursor_byte_ < text_.size() && is_continuation(cursor_byte_));
        ++cursor_character_;
    }
    return cursor_byte_;
}

Span YamlReader::span_of(const void *event) {
    const auto &yaml = *static_cast<const yaml_event_t *>(event);
    const std::uint32_t begin = byte_offset(yaml.start_mark.index);
    return Span{source_, begin, std::max(begin, byte_offset(yaml.end_mark.index))};
}

Event YamlReader::fail(Span span, std::string message) {
    if (!broken_) report_.structure(span, std::move(message));
    broken_ = true;
    return Event{EventKind::Broken, span, {}, false};
}

void YamlReader::break_off(Span span, std::string message) { fail(span, std::move(message)); }

Event YamlReader::next() {
    if (broken_) return Event{EventKind::Broken, {}, {}, false};
    if (ended_) return Event{EventKind::End, {}, {}, false};
    for (;;) {
        yaml_event_t event;
        yaml_parser_t &yaml = parser_->yaml;
        if (!yaml_parser_parse(&yaml, &event)) {
            std::uint32_t at = 0;
            std::string why = yaml.problem ? yaml.problem : "it cannot be read";
            if (yaml.error == YAML_READER_ERROR) {
                at = static_cast<std::uint32_t>(
                    std::min(yaml.problem_offset + skipped_, text_.size()));
                return fail(
                    Span{source_, at,
                         std::min<std::uint32_t>(at + 1, static_cast<std::uint32_t>(text_.size()))},
                    "the file is not UTF-8 text: " + why);
            }
            if (yaml.error == YAML_MEMORY_ERROR)
                return fail(Span{source_, 0, 0}, "there is not enough memory to read the file");
            at = byte_offset(yaml.problem_mark.index);
            return fail(Span{source_, at, at}, "this is not YAML: " + why);
        }
        struct Release {
            yaml_event_t *event;
            ~Release() { yaml_event_delete(event); }
        } release{&event};

        auto note_marks = [&](const yaml_char_t *anchor, const yaml_char_t *tag, Span span) {
            if (anchor) {
                report_.content(span, "the anchor `&" +
                                          std::string(reinterpret_cast<const char *>(anchor)) +
                                          "` is left out: the save format has none");
            }
            if (tag) {
                report_.content(span, "the tag `" +
                                          std::string(reinterpret_cast<const char *>(tag)) +
                                          "` is left out: the save format has none");
            }
        };
        auto deeper = [&](Span span) {
            ++depth_;
            return depth_ > max_depth_
                       ? std::optional(fail(
                             span, fmt::format("this nests deeper than {} levels", max_depth_)))
                       : std::nullopt;
        };
        switch (event.type) {
        case YAML_NO_EVENT:
        case YAML_STREAM_START_EVENT:
        case YAML_DOCUMENT_START_EVENT: continue;
        case YAML_STREAM_END_EVENT:
        case YAML_DOCUMENT_END_EVENT:
            ended_ = true;
            return Event{EventKind::End, span_of(&event), {}, false};
        case YAML_ALIAS_EVENT: {
            const Span span = span_of(&event);
            report_
                .content(span,
                         "the alias `*" +
                             std::string(reinterpret_cast<const char *>(event.data.alias.anchor)) +
                             "` is left out: the save format has none")
                .help("write the value out in full");
            return Event{EventKind::Scalar, span, "~", true};
        }
        case YAML_SCALAR_EVENT: {
            const auto &scalar = event.data.scalar;
            const Span span = span_of(&event);
            note_marks(scalar.anchor, scalar.tag, span);
            return Event{EventKind::Scalar, span,
                         std::string(reinterpret_cast<const char *>(scalar.value), scalar.length),
                         scalar.style == YAML_PLAIN_SCALAR_STYLE};
        }
        case YAML_SEQUENCE_START_EVENT: {
            const Span span = span_of(&event);
            note_marks(event.data.sequence_start.anchor, event.data.sequence_start.tag, span);
            if (auto broken = deeper(span)) return *broken;
            return Event{EventKind::SequenceStart, span, {}, false};
        }
        case YAML_MAPPING_START_EVENT: {
            const Span span = span_of(&event);
            note_marks(event.data.mapping_start.anchor, event.data.mapping_start.tag, span);
            if (auto broken = deeper(span)) return *broken;
            return Event{EventKind::MappingStart, span, {}, false};
        }
        case YAML_SEQUENCE_END_EVENT:
            --depth_;
            return Event{EventKind::SequenceEnd, span_of(&event), {}, false};
        case YAML_MAPPING_END_EVENT:
            --depth_;
            return Event{EventKind::MappingEnd, span_of(&event), {}, false};
        }
    }
}

bool YamlReader::more_documents() {
    if (broken_ || !ended_) return false;
    yaml_event_t event;
    if (!yaml_parser_parse(&parser_->yaml, &event)) return true; // text that is not even YAML
    const bool more = event.type == YAML_DOCUMENT_START_EVENT;
    yaml_event_delete(&event);
    return more;
}

} // namespace fathom::save
