// Textures, materials, lighting and lights: statements of the language, and beside them the items
// as they stand in the file, for an export (names, alpha, what 0.3 has and the language has not).
#include "save-format/import/importer.h"

#include "base/suggest.h"
#include "base/text.h"

#include <cmath>

namespace fathom::save {
namespace {

struct Channels {
    double red, green, blue;
};

// A colour's channels, 0 to 255; what is missing or no such number is reported and takes the
// fallback.
Channels read_color(Importer &in, const Value *value, const char *what, Channels fallback,
                    Span at) {
    if (!value) {
        in.report.content(at, std::string("this material has no `") + what + "`")
            .note("its default stands in");
        return fallback;
    }
    if (value->kind != Value::Kind::Mapping) {
        in.report
            .content(value->span,
                     std::string("`") + what + "` has to be a mapping of Red, Green and Blue")
            .note("its default stands in");
        return fallback;
    }
    const auto channel = [&](const char *name, double otherwise) {
        const Value *part = value->find(name);
        if (!part) {
            in.report.content(value->span, std::string("`") + what + "` has no `" + name + "`")
                .note("its default stands in");
            return otherwise;
        }
        const auto number = number_of(*part);
        if (number && *number >= 0 && *number <= 255) return *number;
        in.report
            .content(part->span, std::string("`") + name + "` has to be a number from 0 to 255")
            .note("its default stands in, and the value is kept for an export");
        return otherwise;
    };
    Channels color{channel("Red", fallback.red), channel("Green", fallback.green),
                   channel("Blue", fallback.blue)};
    if (const Value *alpha = value->find("Alpha")) {
        const auto number = number_of(*alpha);
        if (!number || *number < 0 || *number > 255)
            in.report.content(alpha->span, "`Alpha` has to be a number from 0 to 255");
    }
    for (const auto &[name, part] : value->entries) {
        static const std::vector<std::string> known = {"Red", "Green", "Blue", "Alpha", "Exponent"};
        bool found = false;
        for (const std::string &other : known)
            found = found || spelling_key(name) == spelling_key(other);
        if (!found)
            in.report
                .content(part.span, std::string("`") + what + "` has no property `" +
                                        std::string(cut(name, 80)) + "`")
                .note("it is kept for an export");
    }
    return color;
}

std::string color_text(const Channels &color) {
    return sdf_color(color.red, color.green, color.blue);
}

double number_or(Importer &in, const Value *value, const char *what, double fallback,
                 double minimum, double maximum) {
    if (!value) return fallback;
    const auto number = number_of(*value);
    if (number && *number >= minimum && *number <= maximum) return *number;
    in.report
        .content(value->span, std::string("`") + what + "` has to be a number from " +
                                  sdf_number(minimum) + " to " + sdf_number(maximum))
        .note("its default stands in, and the value is kept for an export");
    return fallback;
}

// {X, Y}, as the language's argument: one number where both are equal.
std::string scale_text(Importer &in, const Value *value, const char *what) {
    if (!value) return "1";
    const auto legal = legal_scale(*value);
    if (!legal) {
        in.report
            .content(value->span, std::string("`") + what +
                                      "` has to be a mapping of X and Y to numbers above 0")
            .note("its default stands in, and the value is kept for an export");
        return "1";
    }
    const auto [x, y] = *legal;
    return x == y ? sdf_number(x) : "[" + sdf_number(x) + ", " + sdf_number(y) + "]";
}

constexpr std::string_view material_properties[] = {"Name",
                                                    "Diffuse",
                                                    "Specular",
                                                    "Color Texture",
                                                    "Texture Scale",
                                                    "Displacement Map",
                                                    "Displacement Amount",
                                                    "Displacement Scale",
                                                    "Emission"};

void read_material(Importer &in, const TakenValue &taken) {
    // A material is a list of mappings whose entries belong together; one mapping alone is read
    // too.
    Value all;
    all.kind = Value::Kind::Mapping;
    all.span = taken.value.span;
    bool legal = taken.value.kind != Value::Kind::Scalar;
    if (taken.value.kind == Value::Kind::Mapping) all.entries = taken.value.entries;
    for (const Value &part : taken.value.items) {
        legal = legal && part.kind == Value::Kind::Mapping;
        all.entries.insert(all.entries.end(), part.entries.begin(), part.entries.end());
    }
    in.keep("material", "", taken.flow);
    if (in.reader.broken()) return; // half a material is kept, and no more
    if (!legal) {
        in.report.content(taken.value.span, "a material has to be a list of mappings")
            .note("it is left out, and kept for an export");
        return;
    }
    for (const auto &[name, value] : all.entries) {
        bool known = false;
        std::vector<std::string> names;
        for (const std::string_view other : material_properties) {
            known = known || spelling_key(other) == spelling_key(name);
            names.emplace_back(other);
        }
        if (known) continue;
        Remark remark = in.report.content(value.span, "a material has no property `" +
                                                          std::string(cut(name, 80)) + "`");
        remark.note("it is kept for an export");
        const std::string near = nearest_name(name, names);
        if (!near.empty()) remark.help("did you mean `" + near + "`?");
    }
    const Value *name = all.find("Name");
    if (!name || name->kind != Value::Kind::Scalar || name->text.empty()) {
        in.report.content(all.span, "this material has no name, so that nothing can use it")
            .note("it is kept for an export");
        return;
    }
    if (in.materials.contains(name->text)) {
        in.report.content(name->span, "there is already a material `" +
                                          std::string(cut(name->text, 80)) +
                                          "`: the first one counts");
        return;
    }
    const Channels diffuse =
        read_color(in, all.find("Diffuse"), "Diffuse", {128, 128, 128}, all.span);
    const Value *specular_value = all.find("Specular");
    const Channels specular = read_color(in, specular_value, "Specular", {255, 255, 255}, all.span);
    const double exponent =
        number_or(in, specular_value ? specular_value->find("Exponent") : nullptr, "Exponent", 32,
                  0.001, 1e6);

    MaterialInfo info;
    info.identifier = in.names.unique(name->text, "material");
    std::string call = "material(diffuse: " + color_text(diffuse);
    const bool white = specular.red == 255 && specular.green == 255 && specular.blue == 255;
    if (!white) call += ", specular: " + color_text(specular);
    if (exponent != 32) call += ", exponent: " + sdf_number(exponent);
    const auto texture = [&](const char *property) -> std::string {
        const Value *value = all.find(property);
        if (!value || (value->kind == Value::Kind::Scalar && is_none(value->text))) return {};
        const auto found =
            value->kind == Value::Kind::Scalar ? in.textures.find(value->text) : in.textures.end();
        if (found != in.textures.end()) return found->second;
        in.report
            .content(value->span, std::string("`") + property + "` names no texture of this file")
            .note("the name is kept for an export");
        return {};
    };
    const std::string texture_scale = scale_text(in, all.find("Texture Scale"), "Texture Scale");
    if (const std::string map = texture("Color Texture"); !map.empty()) {
        call += ", texture: " + map;
        if (texture_scale != "1") call += ", texture_scale: " + texture_scale;
    }
    const double amount = number_or(in, all.find("Displacement Amount"), "Displacement Amount", 0.1,
                                    -largest_amount, largest_amount);
    const std::string displacement_scale =
        scale_text(in, all.find("Displacement Scale"), "Displacement Scale");
    if (const std::string map = texture("Displacement Map"); !map.empty() && amount != 0) {
        info.displacement = ".displace_map(" + map + ", " + sdf_number(amount) +
                            ", scale: " + displacement_scale + ")";
    }
    if (const Value *emission = all.find("Emission")) {
        call += ", emission: " +
                color_text(read_color(in, emission, "Emission", {0, 0, 0}, emission->span));
    }
    info.twin = !in.looks.emplace(call, name->text).second;
    in.out += "let " + info.identifier + " = " + call + ", name: " + sdf_string(name->text) + ")\n";
    in.materials.emplace(name->text, std::move(info));
}

void read_light(Importer &in, const TakenValue &taken) {
    in.keep("light", "", taken.flow);
    if (in.reader.broken()) return;
    const auto &items = taken.value.items;
    if (taken.value.kind != Value::Kind::Sequence || items.empty() ||
        items[0].kind != Value::Kind::Scalar) {
        in.report
            .content(taken.value.span,
                     "a light has to be a node: a list of its type, name and properties")
            .note("it is kept for an export");
        return;
    }
    const Value *properties =
        items.size() > 2 && items[2].kind == Value::Kind::Mapping ? &items[2] : nullptr;
    if (!properties) return;
    for (const auto &[name, value] : properties->entries) {
        static constexpr std::string_view known[] = {"Children", "Position",  "Direction",
                                                     "Color",    "Intensity", "Varying"};
        bool found = false;
        for (const std::string_view other : known)
            found = found || spelling_key(other) == spelling_key(name);
        if (!found)
            in.report
                .content(value.span, "a light has no property `" + std::string(cut(name, 80)) + "`")
                .note("it is kept for an export");
    }
    const auto vector = [&](const char *what) -> std::string {
        const Value *value = properties->find(what);
        if (!value) return {};
        double part[3];
        for (int i = 0; i < 3; ++i) {
            static constexpr const char *axes[] = {"X", "Y", "Z"};
            const Value *component =
                value->kind == Value::Kind::Mapping ? value->find(axes[i]) : nullptr;
            const auto number = component ? number_of(*component) : std::nullopt;
            if (!number || std::abs(*number) > 1e9) {
                in.report
                    .content(value->span, std::string("`") + what +
                                              "` has to be a mapping of X, Y and Z to numbers")
                    .note("the light is kept for an export");
                return {};
            }
            part[i] = *number;
        }
        return sdf_vector(part);
    };
    const Value *varying = properties->find("Varying");
    const auto formula = [&](const char *what) {
        return varying ? in.formula(*varying, what, taken.value.span) : std::string();
    };
    std::string position = formula("Position"), direction = formula("Direction");
    if (position.empty()) position = vector("Position");
    if (direction.empty()) direction = vector("Direction");
    if (position.empty() && direction.empty()) return; // as 0.3 has it: the language's own light
    std::string call = !position.empty() ? "light(at: " + position : "sun(direction: " + direction;
    if (const std::string glow = formula("Color"); !glow.empty()) { // its intensity is in it
        in.settings.push_back(call + ", color: " + glow + ")");
        return;
    }
    if (const Value *color = properties->find("Color")) {
        const Channels channels = read_color(in, color, "Color", {255, 255, 255}, color->span);
        if (channels.red != 255 || channels.green != 255 || channels.blue != 255)
            call += ", color: " + color_text(channels);
    }
    const double intensity = number_or(in, properties->find("Intensity"), "Intensity", 1, 0, 1e6);
    if (intensity != 1) call += ", intensity: " + sdf_number(intensity);
    in.settings.push_back(call + ")");
}

} // namespace

void Importer::read_textures(const Event &) {
    for (;;) {
        Event key = reader.next();
        if (key.kind == EventKind::MappingEnd || key.kind == EventKind::Broken ||
            key.kind == EventKind::End)
            return;
        const Span at = key.span;
        const std::string name = key.text;
        const bool named = key.kind == EventKind::Scalar && !name.empty();
        const bool plain = key.plain;
        std::string flow = "{";
        take_flow(reader, std::move(key), flow);
        const TakenValue taken = take_value(reader, reader.next(), 64);
        keep("texture", "", "{" + flow_scalar(name, plain) + ": " + taken.flow + "}");
        if (!named || taken.value.kind != Value::Kind::Scalar || taken.value.text.empty()) {
            report.content(at, "a texture has to be a name with an image's file")
                .note("it is left out, and kept for an export");
            continue;
        }
        if (textures.contains(name)) {
            report.content(at, "there is already a texture `" + std::string(cut(name, 80)) +
                                   "`: the first one counts");
            continue;
        }
        if (const auto found = options.unusable.find(at.begin); found != options.unusable.end()) {
            report.content(at, "this texture cannot be used: " + found->second)
                .note("it is left out, and kept for an export");
            continue;
        }
        const std::string identifier = names.unique(name, "texture");
        out += marked(at.begin, "let " + identifier + " = image(" +
                                    sdf_string(text_of_asset(taken.value.text)) + ")\n");
        textures.emplace(name, identifier);
    }
}

void Importer::read_materials(const Event &) {
    out += marked(no_part, "");
    for (;;) {
        Event event = reader.next();
        if (event.kind == EventKind::SequenceEnd || event.kind == EventKind::Broken ||
            event.kind == EventKind::End)
            break;
        read_material(*this, take_value(reader, std::move(event), 1 << 16));
    }
    if (!textures.empty() || !materials.empty()) out += '\n';
}

void Importer::read_lighting(bool in_tree) {
    lighting_seen = true;
    std::string name = "Lighting";
    bool plain = true;
    Event event = reader.next();
    if (event.kind == EventKind::Scalar) {
        name = event.text;
        plain = event.plain;
        event = reader.next();
    }
    const NodeTypeRow &row = row_of(NodeType::Lighting);
    Properties properties;
    properties.values.resize(row.properties.size());
    const std::size_t light_mark = settings.size();
    if (event.kind == EventKind::MappingStart) {
        for (;;) {
            event = reader.next();
            if (event.kind == EventKind::MappingEnd || event.kind == EventKind::Broken ||
                event.kind == EventKind::End)
                break;
            if (event.kind != EventKind::Scalar || spelling_key(event.text) != "children") {
                read_property(row, event, properties, "the lighting");
                continue;
            }
            Event list = reader.next();
            if (list.kind != EventKind::SequenceStart) {
                if (!(list.kind == EventKind::Scalar && list.plain && is_none(list.text)))
                    report.content(list.span, "`Children` has to be a list of lights");
                skip_value(reader, list);
                continue;
            }
            for (;;) {
                Event light = reader.next();
                if (light.kind == EventKind::SequenceEnd || light.kind == EventKind::Broken ||
                    light.kind == EventKind::End)
                    break;
                read_light(*this, take_value(reader, std::move(light), 256));
            }
        }
        event = reader.next();
    }
    if (event.kind != EventKind::SequenceEnd && event.kind != EventKind::Broken &&
        event.kind != EventKind::End) {
        report.content(
            event.span,
            "the lighting has a type, a name and one mapping of properties, and no more");
        std::string flow = "[";
        take_flow(reader, std::move(event), flow);
        rest_of_sequence(flow);
    }
    const auto place = [&](const char *key) {
        return static_cast<std::size_t>(find_property(row, key) - row.properties.data());
    };
    const auto number = [&](std::size_t i) {
        return properties.values[i].given ? properties.values[i].number[0]
                                          : row.properties[i].fallback;
    };
    const double red = number(0), green = number(1), blue = number(2);
    const double ambient[3] = {red, green, blue};
    const auto text = [&](std::size_t i) {
        const std::string varying = formula(properties.varying, row.properties[i].name, event.span);
        return varying.empty() ? sdf_number(number(i)) : varying;
    };
    const std::string sky = formula(properties.varying, "Ambient", event.span);
    std::string call = "lighting(ambient: " +
                       (!sky.empty()                    ? sky
                        : red == green && green == blue ? sdf_number(red)
                                                        : sdf_vector(ambient)) +
                       ", ambient_occlusion: " + text(3) + ", shadow_darkness: " + text(4) +
                       ", soft_shadows: " + text(5) + ", specular_intensity: " + text(6);
    if (number(8) != 0) call += ", skip: true";
    // What says nothing of it was lit as the thesis has it.
    if (number(place("Classic")) != 0) call += ", classic: true";
    for (const auto &[key, argument] :
         {std::pair("Fill", ", fill: "), std::pair("Occlusion Reach", ", occlusion_reach: ")})
        if (properties.values[place(key)].given) call += argument + text(place(key));
    settings.insert(settings.begin() + static_cast<std::ptrdiff_t>(light_mark), call + ")");
    read_surroundings(properties, event.span);
    // What the statement does not say: the name, the place, the carried exponent and all that was
    // not understood.
    if (name != "Lighting" || !properties.unknown.empty() || in_tree) {
        keep("lighting", "",
             "[" + std::string(in_tree ? "True" : "False") + ", " + flow_scalar(name, plain) +
                 ", {" + properties.unknown + "}]");
    }
}

} // namespace fathom::save
