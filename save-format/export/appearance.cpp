// Textures and materials of a save file; see appearance.h.
#include "save-format/export/appearance.h"
#include "base/srgb.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::save {

double channel_of(double linear) {
    const double channel = srgb_of_linear(std::clamp(linear, 0.0, 1.0)) * 255;
    return std::abs(channel - std::round(channel)) < 1e-4 ? std::round(channel)
                                                          : std::round(channel * 1e6) / 1e6;
}

Value color_value(const std::array<double, 3> &c, double alpha) {
    return yaml_mapping({{"Red", yaml_scalar(c[0])},
                         {"Green", yaml_scalar(c[1])},
                         {"Blue", yaml_scalar(c[2])},
                         {"Alpha", yaml_scalar(alpha)}});
}

namespace {

// In whichever of the material's mappings it stands.
const Value *entry(const Value &item, std::string_view key) {
    if (item.kind == Value::Kind::Mapping) return item.find(key);
    for (const Value &part : item.items) {
        if (const Value *found = part.find(key)) return found;
    }
    return nullptr;
}
Value *entry(Value &item, std::string_view key) {
    return const_cast<Value *>(entry(std::as_const(item), key));
}

Value plain(std::string_view text) {
    Value value;
    value.text = text;
    value.plain = true;
    return value;
}

Value xy(const std::array<double, 2> &v) {
    return yaml_mapping({{"X", yaml_scalar(v[0])}, {"Y", yaml_scalar(v[1])}});
}

std::string texture_of(const Value &item, std::string_view key) {
    const Value *name = entry(item, key);
    return name && name->kind == Value::Kind::Scalar && !is_none(name->text) ? name->text
                                                                             : std::string();
}

std::array<double, 2> scale_of(const Value &item, std::string_view key) {
    const Value *scale = entry(item, key);
    return scale ? legal_scale(*scale).value_or(std::array<double, 2>{1, 1})
                 : std::array<double, 2>{1, 1};
}

bool same_color(const Value *value, const std::array<double, 3> &color) {
    static constexpr const char *names[] = {"Red", "Green", "Blue"};
    for (std::size_t i = 0; i < 3; ++i) {
        const Value *part = value ? value->find(names[i]) : nullptr;
        const auto number = part ? number_of(*part) : std::nullopt;
        if (!number || std::abs(*number - color[i]) > 1e-3) return false;
    }
    return true;
}

// The last part of a path, without its ending: what a texture is called that no file named.
std::string stem(std::string_view file) {
    file.remove_prefix(file.find_last_of('/') + 1);
    return std::string(file.substr(0, file.find_last_of('.')));
}

} // namespace

Appearances::Appearances(const ir::Scene &scene, Numbers &numbers, const FileNames &files,
                         std::vector<Value> textures, std::vector<Value> materials)
    : scene_(scene), numbers_(numbers), files_(files), materials_(std::move(materials)) {
    for (Value &texture : textures) {
        for (Entry &item : texture.entries) textures_.push_back(std::move(item));
    }
    for (std::size_t i = 0; i < materials_.size(); ++i) {
        const Value *name = entry(materials_[i], "Name");
        if (name && name->kind == Value::Kind::Scalar && !name->text.empty())
            by_name_.try_emplace(name->text, i);
    }
}

// A kept texture is found by its file, to which an import may have put the way from the .sdf.
std::string Appearances::texture(std::int32_t image) {
    if (image < 0 || static_cast<std::size_t>(image) >= scene_.images.size()) return {};
    const auto index = static_cast<std::size_t>(image);
    const std::string &file = scene_.images[index].name;
    const auto is_taken = [&](const std::string &name) {
        return std::any_of(textures_.begin(), textures_.end(),
                           [&](const Entry &item) { return item.first == name; });
    };
    for (const auto &[name, value] : textures_) {
        if (value.kind == Value::Kind::Scalar && !value.text.empty() &&
            (file == value.text || file.ends_with("/" + value.text))) {
            texture_images_.try_emplace(name, index);
            return name;
        }
    }
    std::string name = stem(file);
    for (int i = 2; name.empty() || is_none(name) || is_taken(name); ++i)
        name = fmt::format("{} {}", stem(file), i);
    textures_.emplace_back(name, yaml_word(file));
    texture_images_.emplace(name, index);
    return name;
}

std::string Appearances::material(std::uint32_t index) {
    const ir::Material &material = scene_.shapes.materials[index];
    const std::optional<Appearance> appearance = appearance_of(material);
    if (!appearance) return {};
    if (const auto kept = by_name_.find(material.name); kept != by_name_.end()) {
        update(materials_[kept->second], *appearance);
        return material.name;
    }
    for (const auto &[name, i] : by_name_) {
        if (same(materials_[i], *appearance)) return name;
    }
    std::string name = material.name;
    for (int i = 1; name.empty() || by_name_.contains(name); ++i)
        name = fmt::format("Material {}", i);
    by_name_.emplace(name, materials_.size());
    Value specular = color_value(appearance->specular, 255);
    specular.entries.emplace_back("Exponent", yaml_scalar(appearance->exponent));
    Value first = yaml_mapping({{"Name", yaml_word(name)},
                                {"Diffuse", color_value(appearance->diffuse, 255)},
                                {"Specular", std::move(specular)}});
    if (appearance->emission != std::array<double, 3>{})
        first.entries.emplace_back("Emission", color_value(appearance->emission, 255));
    materials_.push_back(yaml_list(
        {std::move(first), yaml_mapping({{"Color Texture", appearance->texture.empty()
                                                               ? plain("<None>")
                                                               : yaml_word(appearance->texture)},
                                         {"Texture Scale", xy(appearance->texture_scale)},
                                         {"Displacement Map", plain("<None>")},
                                         {"Displacement Amount", yaml_scalar(0.1)},
                                         {"Displacement Scale", xy({1, 1})}})}));
    return name;
}

bool Appearances::displaces(const std::string &material, const ir::DisplacementMap &map,
                            double by) const {
    const auto found = by_name_.find(material);
    if (found == by_name_.end()) return false;
    const Value &item = materials_[found->second];
    const Value *amount = entry(item, "Displacement Amount");
    const std::string name = texture_of(item, "Displacement Map");
    const auto file = std::find_if(textures_.begin(), textures_.end(),
                                   [&](const Entry &texture) { return texture.first == name; });
    if (name.empty() || file == textures_.end()) return false;
    const std::string &image = scene_.images[static_cast<std::size_t>(map.map.image)].name;
    return image.ends_with(file->second.text) &&
           (amount ? legal_amount(*amount).value_or(0.1) : 0.1) == by &&
           scale_of(item, "Displacement Scale") == map.map.scale;
}

Value Appearances::textures() const {
    Value value;
    value.kind = Value::Kind::Mapping;
    value.entries = textures_;
    for (auto &[name, file] : value.entries)
        if (const auto image = texture_images_.find(name); image != texture_images_.end()) {
            const ir::ImageData &data = scene_.images[image->second];
            if (std::string path = files_.written(file.text, data.file); path != file.text)
                file = yaml_word(path);
        }
    return value;
}

// Of a texture `diffuse` is what shows where the image is transparent: the first of what is mixed.
std::optional<Appearances::Appearance> Appearances::appearance_of(const ir::Material &material) {
    Appearance appearance;
    const auto read = [&](ir::NodeId id, std::array<double, 3> &out) {
        const auto value = numbers_.varies(id) ? std::nullopt : numbers_.vector(id);
        if (value)
            for (std::size_t i = 0; i < 3; ++i) out[i] = channel_of((*value)[i]);
        return value.has_value();
    };
    ir::NodeId diffuse = material.diffuse;
    if (material.texture.image >= 0) {
        appearance.texture = texture(material.texture.image);
        appearance.texture_scale = material.texture.scale;
        if (scene_.graph[diffuse].op == ir::Op::Mix) diffuse = scene_.graph.arg(diffuse, 0);
    }
    const auto exponent =
        numbers_.varies(material.exponent) ? std::nullopt : numbers_.number(material.exponent);
    if (!read(diffuse, appearance.diffuse) || !read(material.specular, appearance.specular) ||
        !read(material.emission, appearance.emission) || !exponent)
        return std::nullopt;
    appearance.exponent = *exponent;
    return appearance;
}

bool Appearances::same(const Value &item, const Appearance &appearance) const {
    const Value *specular = entry(item, "Specular"), *emission = entry(item, "Emission");
    const Value *exponent = specular ? specular->find("Exponent") : nullptr;
    const bool glows = appearance.emission != std::array<double, 3>{};
    return same_color(entry(item, "Diffuse"), appearance.diffuse) &&
           same_color(specular, appearance.specular) && exponent &&
           number_of(*exponent) == appearance.exponent &&
           (glows ? same_color(emission, appearance.emission) : emission == nullptr) &&
           texture_of(item, "Color Texture") == appearance.texture &&
           (appearance.texture.empty() ||
            scale_of(item, "Texture Scale") == appearance.texture_scale) &&
           texture_of(item, "Displacement Map").empty();
}

// What the scene says by now. A value that made no sense in the file stays where its default is
// still in use.
void Appearances::update(Value &item, const Appearance &appearance) const {
    const auto channels = [&](const char *what, const std::array<double, 3> &color,
                              const std::array<double, 3> &fallback) {
        Value *value = entry(item, what);
        if (!value || value->kind != Value::Kind::Mapping) return;
        static constexpr const char *names[] = {"Red", "Green", "Blue"};
        for (std::size_t i = 0; i < 3; ++i) {
            Value *part = const_cast<Value *>(std::as_const(*value).find(names[i]));
            const auto number = part ? number_of(*part) : std::nullopt;
            const bool legal = number && *number >= 0 && *number <= 255;
            if (part && (legal ? std::abs(*number - color[i]) > 1e-3 : color[i] != fallback[i]))
                *part = yaml_scalar(color[i]);
        }
    };
    channels("Diffuse", appearance.diffuse, {128, 128, 128});
    channels("Specular", appearance.specular, {255, 255, 255});
    channels("Emission", appearance.emission, {0, 0, 0});
    const Value *specular = entry(item, "Specular");
    Value *exponent = specular ? const_cast<Value *>(specular->find("Exponent")) : nullptr;
    const auto number = exponent ? number_of(*exponent) : std::nullopt;
    if (exponent && (number ? *number != appearance.exponent : appearance.exponent != 32))
        *exponent = yaml_scalar(appearance.exponent);
    if (appearance.texture.empty()) return;
    if (Value *name = entry(item, "Color Texture"); name && name->text != appearance.texture)
        *name = yaml_word(appearance.texture);
    if (Value *scale = entry(item, "Texture Scale");
        scale && scale_of(item, "Texture Scale") != appearance.texture_scale)
        *scale = xy(appearance.texture_scale);
}

} // namespace fathom::save
