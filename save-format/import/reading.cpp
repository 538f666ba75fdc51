// See reading.h.
#include "save-format/import/reading.h"

#include "base/text.h"
#include "save-format/program.h"
#include "save-format/yaml_writer.h"

#include <cmath>

namespace fathom::save {

std::size_t Reading::index(std::string_view name) const {
    for (std::size_t i = 0; i < row_.properties.size(); ++i) {
        if (row_.properties[i].name == name) return i;
    }
    return 0;
}

double Reading::number(std::string_view name) const {
    const std::size_t at = index(name);
    return properties_.values[at].given ? properties_.values[at].number[0]
                                        : row_.properties[at].fallback;
}

void Reading::vector(std::string_view name, double (&out)[3]) const {
    const std::size_t at = index(name);
    for (int axis = 0; axis < 3; ++axis) {
        out[axis] = properties_.values[at].given ? properties_.values[at].number[axis]
                                                 : row_.properties[at].fallback;
    }
}

std::string Reading::word(std::string_view name) const {
    const std::size_t at = index(name);
    return properties_.values[at].given ? properties_.values[at].word
                                        : std::string(row_.properties[at].word);
}

std::string Reading::formula(std::string_view name) const {
    return in_.formula(properties_.varying, name, at_);
}

std::string Reading::text(std::string_view name) const {
    const std::string varying = formula(name);
    return varying.empty() ? sdf_number(number(name)) : varying;
}

std::string Reading::vector_text(std::string_view name) const {
    const std::string varying = formula(name);
    if (!varying.empty()) return varying;
    double value[3];
    vector(name, value);
    return value[0] == value[1] && value[1] == value[2] ? sdf_number(value[0]) : sdf_vector(value);
}

namespace {

bool is_plain_list(const Value &value) {
    if (value.kind != Value::Kind::Sequence || value.items.empty()) return false;
    for (const Value &item : value.items) {
        if (!number_of(item)) return false;
    }
    return true;
}

// A file's path or a text, as an argument of a library call; empty where it is something else.
std::string word_text(Importer &in, const Value &value) {
    if (value.kind != Value::Kind::Mapping) return {};
    const auto scalar = [&](std::string_view key) {
        const Value *found = value.find(key);
        return found && found->kind == Value::Kind::Scalar ? found : nullptr;
    };
    if (const Value *file = scalar("File")) return sdf_string(in.text_of_asset(file->text));
    if (const Value *text = scalar("Text")) return sdf_string(text->text);
    return {};
}

// Numbers, vectors and lists of them, as an argument of a library call; empty where it is something
// else.
std::string argument_text(const Value &value) {
    if (const auto number = number_of(value)) return sdf_number(*number);
    if (value.kind == Value::Kind::Scalar) {
        const auto on = switch_of(value);
        return on && value.plain ? (*on ? "true" : "false") : std::string();
    }
    if (value.kind != Value::Kind::Sequence) return {};
    std::string text = "[";
    for (const Value &item : value.items) {
        if (!number_of(item) && !is_plain_list(item)) return {};
        if (text.size() > 1) text += ", ";
        text += argument_text(item);
    }
    return text + "]";
}

} // namespace

std::string library_call(Importer &in, const Reading &reading, Properties &properties, Span at) {
    const std::string function = reading.word("Function");
    if (!is_library_solid(function)) {
        in.report.content(at, "`" + std::string(cut(function, 80)) + "` is no solid of the library")
            .note("the node is left out, and kept for an export");
        return {};
    }
    std::string call = (function == "gdf_pair" ? "dfmodel." : "") + function + "(";
    for (const auto &[name, value] : reading["Arguments"].tree.entries) {
        const bool is_name =
            !name.empty() &&
            name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") == std::string::npos &&
            name[0] >= 'a';
        std::string text = reading.formula(name);
        std::string why;
        const Value *program = value.kind == Value::Kind::Mapping ? value.find("Program") : nullptr;
        if (text.empty())
            text = program ? program_text(*program, in.words, why) : argument_text(value);
        if (text.empty() && !program) text = word_text(in, value);
        if (!is_name || text.empty()) {
            in.report.content(value.span,
                              "`" + std::string(cut(name, 80)) +
                                  "` is no number, list, program, file or text, and is left out");
            properties.keep(name, "~");
            continue;
        }
        if (call.back() != '(') call += ", ";
        call += name + ": " + text;
    }
    return call + ")";
}

std::string gdf_call(Importer &in, const Reading &reading, Properties &properties, Span at) {
    const auto set_of = [&](const char *property) {
        const std::string word = reading.word(property);
        if (is_none(word)) return -1;
        const int set = find_vector_set(word);
        if (set >= 0) return set;
        in.report
            .content(at, "`" + std::string(cut(word, 80)) + "` is no set of vectors for `" +
                             property + "`")
            .help("the sets are Tetrahedron, Cube, Octahedron, Dodecahedron, Icosahedron, "
                  "Truncated Octahedron and Truncated Icosahedron");
        properties.keep(property, flow_scalar(word, true));
        return -1;
    };
    int first = set_of("Shape");
    const int second = set_of("Second Shape");
    if (first < 0) first = 4; // the table's default
    const std::string radius = "radius: " + reading.text("Radius");
    const auto exponent_text = [&](const char *property, const char *argument) {
        return std::isinf(reading.number(property)) && !reading.varies(property)
                   ? std::string()
                   : std::string(", ") + argument + ": " + reading.text(property);
    };
    const auto sets = vector_sets();
    if (second < 0 && reading.number("Scale") == 1 && !reading.varies("Scale")) {
        const VectorSet &set = sets[static_cast<std::size_t>(first)];
        return (set.turned() ? "dfmodel." : "") + std::string(set.function) + "(" + radius +
               exponent_text("Exponent", "exponent") + ")";
    }
    const auto set_text = [&](int set) {
        return "dfmodel." + std::string(sets[static_cast<std::size_t>(set)].function + 4);
    };
    return "dfmodel.gdf_pair(" + set_text(first) + ", " + set_text(second < 0 ? first : second) +
           ", a_scale: " + reading.text("Scale") +
           ", b_scale: " + (second < 0 ? "0" : reading.text("Second Scale")) + ", " + radius +
           exponent_text("Exponent", "a_exponent") +
           exponent_text("Second Exponent", "b_exponent") + ")";
}

std::string field_call(Importer &in, const Reading &reading, Span at) {
    std::string why;
    const std::string lambda = program_text(reading["Field"].tree, in.words, why);
    if (lambda.empty()) {
        in.report.content(at, "the program of this field cannot be read: " + why)
            .note("the node is left out, and kept for an export");
        return {};
    }
    std::string call = "implicit(" + lambda;
    if (reading["Within"].given) {
        const std::string region = region_text(reading["Within"].tree, in.words);
        if (region.empty()) {
            in.report.content(at, "the region of this field cannot be read")
                .note("the node is left out, and kept for an export");
            return {};
        }
        call += ", within: " + region;
    }
    if (reading["Assumed"].given) call += ", lipschitz: " + reading.text("Assumed");
    if (reading["Estimate"].given) call += ", estimate: " + reading.text("Estimate");
    return call + ")";
}

// Numbers, vectors and axes by name; what follows parameters and time stands in `Varying`.
std::string deformation_call(const Reading &reading, std::string &why) {
    const std::string function = reading.word("Function");
    if (!is_library_deformation(function)) {
        why = "it is no transform of the library";
        return {};
    }
    std::string call = "." + function + "(";
    for (const auto &[name, value] : reading["Arguments"].tree.entries) {
        const bool is_name =
            !name.empty() &&
            name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos;
        std::string text = reading.formula(name);
        if (const auto number = number_of(value); text.empty() && number) {
            text = sdf_number(*number);
        } else if (text.empty() && value.kind == Value::Kind::Mapping) {
            text = vector_text(value);
        } else if (value.text == "X" || value.text == "Y" || value.text == "Z") {
            text = value.text;
        }
        if (!is_name || text.empty()) {
            why = "an argument is no number, vector or axis";
            return {};
        }
        call += (call.back() == '(' ? "" : ", ") + name + ": " + text;
    }
    return call + ")";
}

} // namespace fathom::save
