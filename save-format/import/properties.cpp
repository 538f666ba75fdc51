// Properties of nodes: found by any spelling, checked against their row's kind and limits, and kept
// as they are where they make no sense.
#include "save-format/import/importer.h"

#include "base/suggest.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>

namespace fathom::save {
namespace {

std::string limits(const PropertyType &type) {
    const bool low = std::isfinite(type.minimum) && type.minimum > -1e9;
    const bool high = std::isfinite(type.maximum) && type.maximum < 1e9;
    if (low && high) return "from " + sdf_number(type.minimum) + " to " + sdf_number(type.maximum);
    if (low) return (type.open ? "above " : "at least ") + sdf_number(type.minimum);
    return "a number that is not too large";
}

bool within(const PropertyType &type, double value) {
    if (std::isnan(value)) return false;
    return (type.open ? value > type.minimum : value >= type.minimum) && value <= type.maximum;
}

// Reads `value` as the row wants it; false, with what was wanted, where it is something else.
bool convert(const PropertyType &type, const Value &value, Property &property,
             std::string &wanted) {
    switch (type.kind) {
    case PropertyKind::Number:
    case PropertyKind::Whole: {
        wanted = type.kind == PropertyKind::Whole ? "a whole number" : "a number";
        const auto number = number_of(value);
        if (!number && type.kind == PropertyKind::Number) wanted = wanted_number(value);
        if (!number || (type.kind == PropertyKind::Whole && *number != std::floor(*number)))
            return false;
        wanted += ", " + limits(type);
        property.number[0] = *number;
        if (type.kind == PropertyKind::Whole && !within(type, *number)) { // the nearest count
            property.number[0] = std::clamp(*number, type.minimum, type.maximum);
            property.given = true;
        }
        return within(type, *number);
    }
    case PropertyKind::Vector: {
        wanted = "a mapping of X, Y and Z to numbers";
        static constexpr const char *axes[] = {"X", "Y", "Z"};
        bool some = false;
        for (int axis = 0; axis < 3; ++axis) {
            const Value *part = &value;
            if (value.kind == Value::Kind::Mapping) {
                part = value.find(axes[axis]);
            } else if (value.kind == Value::Kind::Sequence) {
                if (value.items.size() != 3) return false;
                part = &value.items[static_cast<std::size_t>(axis)];
            }
            const std::optional<double> number = part ? number_of(*part) : type.fallback;
            some = some || part;
            if (!number) {
                if (const std::string what = wanted_number(*part); what != "a number")
                    wanted += ", each " + what;
                return false;
            }
            if (!within(type, *number)) {
                wanted = "numbers, each " + limits(type);
                return false;
            }
            property.number[axis] = *number;
        }
        return some;
    }
    case PropertyKind::Switch: {
        wanted = "`True` or `False`";
        const auto on = switch_of(value);
        if (on) property.number[0] = *on ? 1 : 0;
        return on.has_value();
    }
    case PropertyKind::Word:
    case PropertyKind::Material:
        wanted = "a name";
        property.word = value.text;
        return value.kind == Value::Kind::Scalar;
    case PropertyKind::Carried: return true;
    case PropertyKind::Tree: property.tree = value; return true;
    }
    return false;
}

} // namespace

void Properties::keep(std::string_view key, std::string_view flow) {
    if (!unknown.empty()) unknown += ", ";
    if (key.size() > 200) unknown += "? ";
    unknown += flow_scalar(key, true);
    unknown += ": ";
    unknown += flow;
}

void Importer::read_property(const NodeTypeRow &row, const Event &key, Properties &properties,
                             std::string_view of) {
    if (key.kind != EventKind::Scalar) {
        report.content(key.span, "a property's name has to be text");
        std::string flow;
        take_flow(reader, key, flow);
        if (!properties.unknown.empty()) properties.unknown += ", ";
        properties.unknown += "? " + flow + ": ";
        take_flow(reader, reader.next(), properties.unknown);
        return;
    }
    if (spelling_key(key.text) == "varying" && properties.varying.entries.empty()) {
        const TakenValue taken = take_value(reader, reader.next(), 1u << 20);
        if (taken.value.kind == Value::Kind::Mapping)
            properties.varying = taken.value;
        else
            report.content(key.span, "`Varying` has to be a mapping of properties to programs");
        return;
    }
    const PropertyType *type = find_property(row, key.text);
    if (!type) {
        std::vector<std::string> known;
        for (const PropertyType &property : row.properties) known.emplace_back(property.name);
        std::string message =
            std::string(of) + " has no property `" + std::string(cut(key.text, 80)) + "`";
        const std::string near = nearest_name(key.text, known);
        {
            Remark remark = report.content(key.span, std::move(message));
            remark.note("it is kept for an export");
            if (!near.empty()) remark.help("did you mean `" + near + "`?");
        }
        std::string flow;
        take_flow(reader, reader.next(), flow);
        properties.keep(key.text, flow);
        return;
    }
    const TakenValue taken =
        take_value(reader, reader.next(), type->kind == PropertyKind::Tree ? 1u << 22 : 64);
    if (reader.broken()) return; // reported; half a value says nothing
    Property &property = properties.values[static_cast<std::size_t>(type - row.properties.data())];
    if (property.given) {
        report.content(key.span,
                       "`" + std::string(type->name) + "` is given twice: the first one counts");
        return;
    }
    Property read;
    std::string wanted;
    if (!convert(*type, taken.value, read, wanted)) {
        const bool shown = taken.flow.size() <= 60;
        report
            .content(taken.value.span, "`" + std::string(type->name) + "` wants " + wanted +
                                           (shown ? ", not `" + taken.flow + "`" : std::string()))
            .note((read.given ? sdf_number(read.number[0]) : std::string("its default")) +
                  " stands in, and the value is kept for an export");
        properties.keep(type->name, taken.flow);
        if (read.given) property = std::move(read);
        return;
    }
    read.given = true;
    property = std::move(read);
    if (type->kind == PropertyKind::Carried && taken.flow != type->word) {
        // `{X: 0.00, Y: 0.00}` says what the row's word says
        const Value usual = parse_text(type->word).value;
        bool same =
            usual.kind == taken.value.kind && usual.entries.size() == taken.value.entries.size();
        if (same && usual.kind == Value::Kind::Scalar)
            same = number_of(usual) == number_of(taken.value);
        for (const auto &[name, part] : usual.entries) {
            const Value *other = taken.value.find(name);
            same = same && other && number_of(*other) && number_of(*other) == number_of(part);
        }
        if (!same) properties.keep(type->name, taken.flow);
    }
}

} // namespace fathom::save
