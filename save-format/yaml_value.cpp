// Single values of a save file: read from the event stream into a small tree and into one line of
// flow text.
#include "save-format/yaml_reader.h"

#include "save-format/node_types.h"

#include "base/encode.h"
#include "base/single.h"
#include "base/text.h"

#include <cctype>
#include <cmath>
#include <utility>

namespace fathom::save {
namespace {

bool is_indicator(char c) {
    return std::string_view("-?:,[]{}#&*!|>'\"%@`").find(c) != std::string_view::npos;
}

// Can this text stand plain in a flow collection and read back as itself?
bool plain_in_flow(std::string_view text) {
    if (text.empty() || text.front() == ' ' || text.back() == ' ' || text.size() > 512)
        return false;
    if (text.substr(0, 3) == "---" || text.substr(0, 3) == "...") return false;
    const bool number_like =
        text.size() > 1 && text[0] == '-' && text[1] != ' ' && !is_indicator(text[1]);
    if (is_indicator(text.front()) && !number_like) return false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (c < 0x20 || c >= 0x7F) return false;
        if (std::string_view(",[]{}\"'\\`").find(text[i]) != std::string_view::npos) return false;
        if (c == ':' && (i + 1 == text.size() || text[i + 1] == ' ' || is_indicator(text[i + 1])))
            return false;
        if (c == '#' && i > 0 && text[i - 1] == ' ') return false;
    }
    return true;
}

// Walks one value's events; `visit` sees each with the text that stands before it in flow form.
template <class Visit> void walk(YamlReader &reader, Event first, std::string *flow, Visit visit) {
    struct Level {
        bool mapping = false;
        std::size_t parts = 0;
    };
    std::vector<Level> levels;
    Event event = std::move(first);
    for (;;) {
        const bool ends =
            event.kind == EventKind::SequenceEnd || event.kind == EventKind::MappingEnd;
        if (event.kind == EventKind::Broken || event.kind == EventKind::End) {
            // What was read until the break stays a legal text.
            if (flow) {
                if (!levels.empty() && levels.back().mapping && levels.back().parts % 2 == 1)
                    *flow += ": ~";
                for (; !levels.empty(); levels.pop_back()) {
                    *flow += levels.back().mapping ? '}' : ']';
                    if (levels.size() > 1 && levels[levels.size() - 2].mapping &&
                        levels[levels.size() - 2].parts % 2 == 1)
                        *flow += ": ~";
                }
            }
            visit(event, false);
            return;
        }
        bool key = false;
        if (!ends && !levels.empty()) {
            Level &level = levels.back();
            key = level.mapping && level.parts % 2 == 0;
            if (flow && level.parts > 0) *flow += level.mapping && !key ? ": " : ", ";
            // A key that is long or no scalar needs its mark: plain ones may have 1,024 characters.
            if (flow && key && (event.kind != EventKind::Scalar || event.text.size() > 200))
                *flow += "? ";
            ++level.parts;
        }
        if (flow) {
            switch (event.kind) {
            case EventKind::Scalar: *flow += flow_scalar(event.text, event.plain); break;
            case EventKind::SequenceStart: *flow += '['; break;
            case EventKind::MappingStart: *flow += '{'; break;
            case EventKind::SequenceEnd: *flow += ']'; break;
            case EventKind::MappingEnd: *flow += '}'; break;
            case EventKind::End:
            case EventKind::Broken: break;
            }
        }
        visit(event, key);
        if (event.kind == EventKind::SequenceStart || event.kind == EventKind::MappingStart) {
            levels.push_back({event.kind == EventKind::MappingStart, 0});
        } else if (ends) {
            levels.pop_back();
        }
        if (levels.empty()) return;
        event = reader.next();
    }
}

} // namespace

std::string flow_scalar(std::string_view text, bool plain) {
    if (plain && text.empty()) return "~";
    if (plain && plain_in_flow(text)) return std::string(text);
    return for_yaml(text);
}

TakenValue take_value(YamlReader &reader, Event first, std::size_t limit) {
    TakenValue taken;
    std::vector<Value *>
        open; // collections that are being filled; stable, since only the last one grows
    std::vector<std::string> keys(1); // the key that waits for its value, by level
    std::size_t parts = 0;
    std::size_t skipped = 0;    // levels of collections that are no longer kept
    std::size_t key_levels = 0; // levels inside a key that is a collection
    std::size_t key_begin = 0;  // where it begins in the flow text
    bool complex_key = false;   // the one that waits is such a one
    taken.value.span = first.span;
    walk(reader, std::move(first), &taken.flow, [&](const Event &event, bool key) {
        const bool starts =
            event.kind == EventKind::SequenceStart || event.kind == EventKind::MappingStart;
        const bool ends =
            event.kind == EventKind::SequenceEnd || event.kind == EventKind::MappingEnd;
        if (event.kind == EventKind::Broken || event.kind == EventKind::End) {
            taken.whole = false;
            return;
        }
        if (key_levels > 0 ||
            (key && starts)) { // a key that is no scalar: it counts as text that no one looks for
            if (key_levels == 0) key_begin = taken.flow.size() - 1; // its bracket
            if (starts) ++key_levels;
            if (ends) --key_levels;
            if (key_levels == 0) keys.back() = taken.flow.substr(key_begin), complex_key = true;
            taken.whole = false;
            return;
        }
        if (skipped > 0) {
            if (starts) ++skipped;
            if (ends) --skipped;
            return;
        }
        if (ends) {
            open.back()->span = join(open.back()->span, event.span);
            open.pop_back();
            keys.pop_back();
            return;
        }
        if (key) {
            keys.back() = event.text;
            return;
        }
        if (++parts > limit) {
            taken.whole = false;
            if (starts) ++skipped;
            return;
        }
        Value *slot = &taken.value;
        if (!open.empty()) {
            if (open.back()->kind == Value::Kind::Mapping) {
                open.back()->entries.emplace_back(keys.back(), Value{});
                slot = &open.back()->entries.back().second;
                slot->complex_key = std::exchange(complex_key, false);
            } else {
                slot = &open.back()->items.emplace_back();
            }
        }
        slot->span = event.span;
        if (event.kind == EventKind::Scalar) {
            slot->text = event.text;
            slot->plain = event.plain;
            return;
        }
        slot->kind =
            event.kind == EventKind::MappingStart ? Value::Kind::Mapping : Value::Kind::Sequence;
        open.push_back(slot);
        keys.emplace_back();
    });
    return taken;
}

void take_flow(YamlReader &reader, Event first, std::string &flow) {
    walk(reader, std::move(first), &flow, [](const Event &, bool) {});
}

void skip_value(YamlReader &reader, const Event &first) {
    walk(reader, first, nullptr, [](const Event &, bool) {});
}

std::string spelling_key(std::string_view name) {
    std::string key;
    for (const char c : name) {
        if (c == ' ' || c == '-' || c == '_') continue;
        key += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return key;
}

const Value *Value::find(std::string_view key) const {
    const std::string wanted = spelling_key(key);
    for (const auto &[name, value] : entries) {
        if (spelling_key(name) == wanted) return &value;
    }
    return nullptr;
}

ParsedText parse_text(std::string_view text) {
    Diagnostics discarded;
    Sources sources;
    YamlReader reader(text, SourceId{0}, Report{discarded, false}, 2000);
    ParsedText parsed;
    Event first = reader.next();
    if (first.kind == EventKind::Broken || first.kind == EventKind::End) return parsed;
    TakenValue taken = take_value(reader, std::move(first), text.size() + 1);
    parsed.ok = !reader.broken();
    parsed.value = std::move(taken.value);
    return parsed;
}

namespace {

// In YAML 1.1: `010` is 8, which nobody means who writes lengths.
bool is_octal(std::string_view text) {
    return text.size() > 1 && text[0] == '0' && text.find_first_not_of("0123456789") == text.npos &&
           text.find_first_not_of('0') != text.npos;
}

} // namespace

std::string wanted_number(const Value &value) {
    std::string_view text = value.text;
    if (value.kind != Value::Kind::Scalar || !value.plain || text.empty()) return "a number";
    if (text[0] == '-' || text[0] == '+') text.remove_prefix(1);
    if (is_octal(text)) return "a number without a 0 before it, which YAML takes for octal";
    const std::size_t digits = text.find_first_not_of("0123456789");
    const bool is_number =
        !text.empty() && digits != 0 &&
        (digits == text.npos || text.find_first_not_of("0123456789.eE+-") == text.npos);
    return is_number ? "a number up to " + format_shortest(longest) : "a number";
}

std::optional<double> number_of(const Value &value, double most) {
    if (value.kind != Value::Kind::Scalar || !value.plain || value.text.empty())
        return std::nullopt;
    std::string_view text = value.text;
    const bool negative = text[0] == '-';
    if (negative || text[0] == '+') text.remove_prefix(1);
    const std::string key = spelling_key(text);
    if (key == ".inf")
        return negative ? -std::numeric_limits<double>::infinity()
                        : std::numeric_limits<double>::infinity();
    if (text.empty() || !((text[0] >= '0' && text[0] <= '9') || text[0] == '.'))
        return std::nullopt;
    if (is_octal(text)) return std::nullopt;
    auto number = parse_number(text[0] == '.' ? "0" + std::string(text) : std::string(text));
    if (!number && text.back() == '.') number = parse_number(text.substr(0, text.size() - 1));
    if (!number || std::abs(*number) > most) return std::nullopt;
    return flushed(negative ? -*number : *number);
}

std::optional<std::array<double, 2>> legal_scale(const Value &value) {
    std::array<double, 2> parts;
    for (std::size_t i = 0; i < 2; ++i) {
        const Value *part =
            value.kind == Value::Kind::Mapping ? value.find(i == 0 ? "X" : "Y") : nullptr;
        const auto number = part ? number_of(*part) : std::nullopt;
        if (!number || *number <= 0 || *number >= 1e9) return std::nullopt;
        parts[i] = *number;
    }
    return parts;
}

std::optional<bool> switch_of(const Value &value) {
    if (value.kind != Value::Kind::Scalar) return std::nullopt;
    const std::string key = spelling_key(value.text);
    if (key == "true" || key == "yes" || key == "on" || key == "1") return true;
    if (key == "false" || key == "no" || key == "off" || key == "0") return false;
    return std::nullopt;
}

bool is_none(std::string_view word) { return word.empty() || word == "<None>" || word == "~"; }

} // namespace fathom::save
