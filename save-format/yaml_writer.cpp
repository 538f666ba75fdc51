// Values to block text; see yaml_writer.h.
#include "save-format/yaml_writer.h"

#include "save-format/program.h"

#include <algorithm>

namespace fathom::save {
namespace {

bool looks_like_more_than_text(std::string_view text) {
    const std::string key = spelling_key(text);
    static constexpr std::string_view words[] = {"true", "false", "yes", "no", "on",
                                                 "off",  "null",  "~",   "y",  "n",
                                                 ".nan", ".inf",  "<<",  "="};
    if (std::find(std::begin(words), std::end(words), key) != std::end(words)) return true;
    return !text.empty() && ((text[0] >= '0' && text[0] <= '9') || text[0] == '-' ||
                             text[0] == '+' || text[0] == '.');
}

// Lists of numbers, and lists of such lists, stand on one line.
bool on_one_line(const Value &value, int depth) {
    if (value.kind == Value::Kind::Scalar) return true;
    if (value.kind == Value::Kind::Mapping) return value.entries.empty();
    if (depth == 0) return value.items.empty();
    return std::all_of(value.items.begin(), value.items.end(),
                       [&](const Value &item) { return on_one_line(item, depth - 1); });
}

std::string key_text(std::string_view key) {
    std::string text = flow_scalar(key, !looks_like_more_than_text(key) && !key.empty());
    return key.size() > 200 ? "? " + text : text;
}

} // namespace

Value yaml_scalar(double number) {
    Value value;
    value.text = yaml_number(number);
    value.plain = true;
    return value;
}

Value yaml_word(std::string_view text) {
    Value value;
    value.text = text;
    value.plain = !text.empty() && !looks_like_more_than_text(text);
    return value;
}

Value yaml_switch(bool on) {
    Value value;
    value.text = on ? "True" : "False";
    value.plain = true;
    return value;
}

Value yaml_mapping(std::initializer_list<Entry> entries) {
    Value value;
    value.kind = Value::Kind::Mapping;
    value.entries = entries;
    return value;
}

Value yaml_xyz(double x, double y, double z) {
    return yaml_mapping({{"X", yaml_scalar(x)}, {"Y", yaml_scalar(y)}, {"Z", yaml_scalar(z)}});
}

Value yaml_list(std::vector<Value> items) {
    Value value;
    value.kind = Value::Kind::Sequence;
    value.items = std::move(items);
    return value;
}

std::string flow_text(const Value &value) {
    if (value.kind == Value::Kind::Scalar) return flow_scalar(value.text, value.plain);
    std::string text(1, value.kind == Value::Kind::Sequence ? '[' : '{');
    for (const Value &item : value.items) text += (text.size() > 1 ? ", " : "") + flow_text(item);
    for (const auto &[key, part] : value.entries)
        text += (text.size() > 1 ? ", " : "") + key_text(key) + ": " + flow_text(part);
    return text + (value.kind == Value::Kind::Sequence ? ']' : '}');
}

void write_item(const Value &value, std::size_t indent, std::string &out) {
    out.append(indent, ' ');
    out += "- ";
    write_value(value, indent + 2, out);
}

void write_value(const Value &value, std::size_t indent, std::string &out) {
    // The first line of a block stands where the text is now; the others at `indent`.
    if (on_one_line(value, 2)) {
        out += flow_text(value);
        out += '\n';
        return;
    }
    bool first = true;
    const auto begin_line = [&] {
        if (!first) out.append(indent, ' ');
        first = false;
    };
    for (const Value &item : value.items) {
        begin_line();
        out += "- ";
        write_value(item, indent + 2, out);
    }
    for (const auto &[key, part] : value.entries) {
        begin_line();
        out += key_text(key);
        if (on_one_line(part, 2)) {
            out += ": " + flow_text(part) + "\n";
        } else {
            out += ":\n";
            out.append(indent + 2, ' ');
            write_value(part, indent + 2, out);
        }
    }
}

} // namespace fathom::save
