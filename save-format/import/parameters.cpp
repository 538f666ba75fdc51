// What stands under labelled keys of the root and of the lighting: parameters, cached fields, the
// background, the limits of the march, a camera that moves. All of this project; another 0.3 reader
// sees none of it.
#include "save-format/import/importer.h"

#include "base/text.h"

#include <cmath>

namespace fathom::save {
namespace {

struct ParameterType {
    std::string_view name; // in the file
    const char *type;      // in the language
    std::size_t components;
    bool ranged; // may have a range
};
constexpr ParameterType parameter_types[] = {
    {"float", "float", 1, true},  {"whole", "int", 1, true}, {"switch", "bool", 1, false},
    {"color", "color", 3, false}, {"vec2", "vec2", 2, true}, {"vec3", "vec3", 3, true},
    {"vec4", "vec4", 4, true},
};

// One number, or a list of them; nothing where there are others than `count`.
std::optional<std::vector<double>> numbers(const Value *value, std::size_t count) {
    std::vector<double> result;
    if (!value) return std::nullopt;
    if (value->kind == Value::Kind::Scalar) {
        const auto on = switch_of(*value);
        const auto number = number_of(*value);
        if (!number && !on) return std::nullopt;
        result.push_back(number ? *number : (*on ? 1 : 0));
    }
    for (const Value &item : value->items) {
        const auto number = number_of(item);
        if (!number) return std::nullopt;
        result.push_back(*number);
    }
    if (result.size() != count) return std::nullopt;
    return result;
}

std::string numbers_text(const std::vector<double> &values) {
    if (values.size() == 1) return sdf_number(values[0]);
    std::string text = "[";
    for (const double value : values) text += (text.size() > 1 ? ", " : "") + sdf_number(value);
    return text + "]";
}

} // namespace

void Importer::read_parameters(const Value &list) {
    for (const Value &item : list.items) {
        const Value *name = item.find("Name"), *label = item.find("Label"),
                    *type_name = item.find("Type");
        const ParameterType *type = nullptr;
        for (const ParameterType &other : parameter_types)
            if (other.name == (type_name ? spelling_key(type_name->text) : "float")) type = &other;
        const auto value = type ? numbers(item.find("Value"), type->components) : std::nullopt;
        const auto low = type ? numbers(item.find("Low"), type->components) : std::nullopt,
                   high = type ? numbers(item.find("High"), type->components) : std::nullopt;
        bool legal = name && name->kind == Value::Kind::Scalar && !name->text.empty() && value &&
                     low.has_value() == high.has_value() && (type->ranged || !low) &&
                     !words.params.contains(name->text);
        for (std::size_t i = 0; legal && low && i < value->size(); ++i)
            legal = (*low)[i] <= (*value)[i] && (*value)[i] <= (*high)[i];
        if (legal && type->components == 1 && spelling_key(type->name) == "whole")
            legal = low && (*value)[0] == std::floor((*value)[0]);
        if (!legal) {
            report
                .content(item.span, "a parameter is a mapping of its own `Name`, a `Value`, and "
                                    "`Low` and `High` around it")
                .note("it is left out, and what follows it stands at its present value");
            continue;
        }
        const std::string identifier = names.unique(name->text, "param");
        std::string text = numbers_text(*value);
        if (type->name == "switch") text = (*value)[0] != 0 ? "true" : "false";
        if (type->name == "color") text = sdf_color((*value)[0], (*value)[1], (*value)[2]);
        out += "param " + identifier + ": " + type->type + " = " + text;
        if (low) out += " in " + numbers_text(*low) + ".." + numbers_text(*high);
        if (label && label->kind == Value::Kind::Scalar && label->text != identifier)
            out += " " + sdf_string(label->text);
        out += "\n";
        words.params.emplace(name->text, identifier);
    }
    if (!words.params.empty()) out += "\n";
}

// A field that cannot be read keeps its number in the list; programs that use it cannot be read
// either.
void Importer::read_caches(const Value &list) {
    for (const Value &item : list.items) {
        std::string why = "it has to be a mapping of its `Cell` and its `Field`";
        const Value *cell = item.find("Cell"), *field = item.find("Field");
        const auto size = cell ? number_of(*cell) : std::nullopt;
        std::string lambda;
        if (field && size && *size > 0) {
            why.clear();
            lambda = program_text(*field, words, why);
        }
        if (lambda.empty()) {
            report.content(item.span, "this cached field cannot be read: " + why);
            words.caches.emplace_back();
            continue;
        }
        const std::string identifier = names.unique("kept field", "field");
        out += "let " + identifier + " = cached(" + lambda + ", cell: " + sdf_number(*size) + ")\n";
        words.caches.push_back(identifier);
    }
    if (!words.caches.empty()) out += "\n";
}

std::string Importer::formula(const Value &varying, std::string_view name, Span at) {
    const Value *steps = varying.kind == Value::Kind::Mapping ? varying.find(name) : nullptr;
    if (!steps) return {};
    std::string why;
    const std::string text = program_text(*steps, words, why, Given::Nothing);
    if (text.empty())
        report
            .content(steps->span.source ? steps->span : at,
                     "what `" + std::string(name) + "` follows cannot be read: " + why)
            .note("it stands at its present value");
    return text;
}

void Importer::read_surroundings(const Properties &properties, Span at) {
    const NodeTypeRow &row = row_of(NodeType::Lighting);
    const auto property = [&](const char *name) -> const Property & {
        return properties
            .values[static_cast<std::size_t>(find_property(row, name) - row.properties.data())];
    };
    static constexpr std::pair<const char *, const char *> numbers[] = {
        {"Epsilon", "epsilon"}, {"Far", "far"}, {"Time End", "time"}};
    for (const auto &[name, argument] : numbers)
        if (property(name).given)
            limits += std::string(", ") + argument + ": " + sdf_number(property(name).number[0]);
    if (property("Background").given) {
        std::string why;
        const std::string lambda =
            program_text(property("Background").tree, words, why, Given::Direction);
        if (lambda.empty())
            report.content(at, "the `Background` cannot be read: " + why);
        else
            settings.push_back("background(" + lambda + ")");
    }
    const std::string eye = formula(properties.varying, "Camera At", at),
                      target = formula(properties.varying, "Camera Target", at),
                      angle = formula(properties.varying, "Field of View", at);
    if (!eye.empty() && !target.empty() && !angle.empty()) {
        const bool flat = property("Orthographic").number[0] != 0;
        camera = "camera(at: " + eye + ", look_at: " + target + ", fov: " + angle +
                 (flat ? ", orthographic: true)" : ")");
    }
}

} // namespace fathom::save
