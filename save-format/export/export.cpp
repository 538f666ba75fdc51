// The main list of a save file, written: version, textures, materials, tree, lighting, and the
// unlabelled rest. What was kept from an import goes back to its place; what the scene says by now
// goes before it.
#include "base/srgb.h"
#include "ir/background.h"
#include "ir/view.h"
#include "save-format/export/appearance.h"
#include "save-format/export/tree.h"
#include "save-format/node_types.h"
#include "save-format/program.h"
#include "save-format/save_format.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>

namespace fathom::save {
namespace {

Value *find(Value &mapping, std::string_view key) {
    return const_cast<Value *>(std::as_const(mapping).find(key));
}

// Adds to `varying` the program of what a setting follows; one without words is reported.
void add_program(std::string_view what, std::string_view key, ir::NodeId value, Value &varying,
                 Numbers &numbers, Diagnostics &diagnostics) {
    if (auto steps = numbers.steps(value)) {
        varying.entries.emplace_back(std::string(key), std::move(*steps));
        return;
    }
    unsaved(diagnostics, {},
            fmt::format("the save format has no words for what `{}` of {} follows: {}", key, what,
                        no_words))
        .note("its present value is written");
}

Value lights_value(const ir::Scene &scene, Numbers &numbers, std::vector<Value> kept, bool imported,
                   Diagnostics &diagnostics) {
    // A kept light without a place is the language's own; the others stand for the scene's lights,
    // in order.
    std::vector<Value> lights;
    std::size_t next = 0;
    const auto place = [](const Value &light) {
        return light.kind == Value::Kind::Sequence && light.items.size() > 2 &&
               (light.items[2].find("Position") || light.items[2].find("Direction"));
    };
    const auto refresh = [&](Value light, const ir::Light &source) {
        Value &properties = light.items[2];
        const auto set = [&](const char *key, Value value) {
            if (Value *present = find(properties, key))
                *present = std::move(value);
            else
                properties.entries.emplace(properties.entries.begin(), key, std::move(value));
        };
        const auto at = numbers.vector(source.position);
        const char *key = source.directional ? "Direction" : "Position";
        const Value *old = properties.find(key);
        bool same = old != nullptr && at.has_value();
        double old_length = 0;
        std::array<double, 3> old_at{};
        for (std::size_t i = 0; i < 3 && same; ++i) {
            static constexpr const char *axes[] = {"X", "Y", "Z"};
            const Value *part = old->find(axes[i]);
            old_at[i] = part ? number_of(*part).value_or(0) : 0;
            old_length += old_at[i] * old_at[i];
        }
        for (std::size_t i = 0; i < 3 && same; ++i)
            same = std::abs(old_at[i] / (source.directional ? std::sqrt(old_length) : 1) -
                            (*at)[i]) < 1e-12;
        if (at && !same) set(key, yaml_xyz((*at)[0], (*at)[1], (*at)[2]));
        if (const auto color = numbers.vector(source.color)) {
            const double intensity = std::max({(*color)[0], (*color)[1], (*color)[2], 1.0});
            std::array<double, 3> channels{};
            for (std::size_t i = 0; i < 3; ++i) channels[i] = channel_of((*color)[i] / intensity);
            const Value *old_color = properties.find("Color"),
                        *old_intensity = properties.find("Intensity");
            double was = old_intensity ? number_of(*old_intensity).value_or(1) : 1;
            std::array<double, 3> had{255, 255, 255};
            static constexpr const char *names[] = {"Red", "Green", "Blue"};
            for (std::size_t i = 0; i < 3 && old_color; ++i) {
                const Value *part = old_color->find(names[i]);
                had[i] = part ? number_of(*part).value_or(255) : 255;
            }
            bool unchanged = true;
            for (std::size_t i = 0; i < 3; ++i)
                unchanged = unchanged && std::abs(linear_of_srgb(had[i] / 255) * was -
                                                  (*color)[i]) < 1e-9 * std::max(1.0, was);
            if (!unchanged) {
                set("Color", color_value(channels, 255));
                set("Intensity", yaml_scalar(intensity));
            }
        }
        Value varying;
        varying.kind = Value::Kind::Mapping;
        const auto vary = [&](const char *name, ir::NodeId value) {
            if (numbers.varies(value))
                add_program("a light", name, value, varying, numbers, diagnostics);
        };
        vary(key, source.position);
        vary("Color", source.color);
        std::erase_if(properties.entries,
                      [](const Entry &entry) { return spelling_key(entry.first) == "varying"; });
        if (!varying.entries.empty()) set("Varying", std::move(varying));
        return light;
    };
    const auto fresh = [&](std::size_t number) {
        Value light;
        light.kind = Value::Kind::Sequence;
        light.items = {yaml_word("Generic"), yaml_word(fmt::format("Light {}", number)),
                       yaml_mapping({{"Children", yaml_list({})}})};
        return light;
    };
    for (Value &light : kept) {
        if (!place(light))
            lights.push_back(std::move(light));
        else if (next < scene.lights.size())
            lights.push_back(refresh(std::move(light), scene.lights[next++]));
    }
    while (next < scene.lights.size()) {
        const ir::Light &source = scene.lights[next++];
        if (numbers.vector(source.position))
            lights.push_back(refresh(fresh(lights.size() + 1), source));
        else
            unsaved(diagnostics, {},
                    "the save format has no words for where a light is: " + no_words)
                .note("it is left out of the file");
    }
    if (lights.empty() && !imported) lights.push_back(fresh(1));
    return yaml_list(std::move(lights));
}

bool gives_background(const ir::Scene &scene, Numbers &numbers) {
    return scene.background && scene.background != ir::usual_background(numbers.graph());
}

// What is round the scene and 0.3 has no place for: labelled.
void add_surroundings(const ir::Scene &scene, Numbers &numbers, Value &properties,
                      Diagnostics &diagnostics) {
    const ir::Lighting &l = scene.lighting;
    const ir::RenderSettings usual;
    const auto add = [&](const char *name, Value value) {
        properties.entries.emplace_back(name, std::move(value));
    };
    if (gives_background(scene, numbers)) {
        if (auto steps = numbers.steps(scene.background))
            add("Background", std::move(*steps));
        else
            unsaved(diagnostics, {},
                    "the save format has no words for this background: " + no_words)
                .note("it is left out of the file");
    }
    if (scene.render.epsilon != usual.epsilon) add("Epsilon", yaml_scalar(scene.render.epsilon));
    if (scene.render.far != usual.far) add("Far", yaml_scalar(scene.render.far));
    if (scene.render.time_end != usual.time_end)
        add("Time End", yaml_scalar(scene.render.time_end));
    Value varying;
    varying.kind = Value::Kind::Mapping;
    const auto vary = [&](const char *name, ir::NodeId value) {
        add_program("the scene", name, value, varying, numbers, diagnostics);
    };
    const std::pair<const char *, ir::NodeId> parts[] = {
        {"Ambient", l.ambient},
        {"Ambient Occlusion", l.ambient_occlusion},
        {"Shadow Darkness", l.shadow_darkness},
        {"Soft Shadows", l.soft_shadows},
        {"Specular Intensity", l.specular_intensity},
        {"Fill", l.fill},
        {"Occlusion Reach", l.occlusion_reach}};
    if (!l.classic) add("Classic", yaml_switch(false));
    if (const auto fill = numbers.number(l.fill); fill && *fill != 0)
        add("Fill", yaml_scalar(*fill));
    if (l.occlusion_reach)
        add("Occlusion Reach", yaml_scalar(numbers.number(l.occlusion_reach).value_or(0)));
    for (const auto &[key, value] : parts)
        if (value && numbers.varies(value)) vary(key, value);
    const ir::Camera &camera = scene.camera;
    if (camera.given && (numbers.varies(camera.at) || numbers.varies(camera.look_at) ||
                         numbers.varies(camera.fov))) {
        vary("Camera At", camera.at);
        vary("Camera Target", camera.look_at);
        vary("Field of View", camera.fov);
        if (camera.orthographic) add("Orthographic", yaml_switch(true));
    }
    if (!varying.entries.empty()) add("Varying", std::move(varying));
}

Value lighting_value(const ir::Scene &scene, Numbers &numbers, KeptItems &kept,
                     Diagnostics &diagnostics) {
    const ir::Lighting &l = scene.lighting;
    const auto ambient = numbers.vector(l.ambient).value_or(std::array<double, 3>{});
    const auto number = [&](ir::NodeId id) { return yaml_scalar(numbers.number(id).value_or(0)); };
    Value properties = yaml_mapping({{"Ambient R", yaml_scalar(ambient[0])},
                                     {"Ambient G", yaml_scalar(ambient[1])},
                                     {"Ambient B", yaml_scalar(ambient[2])},
                                     {"Ambient Occlusion", number(l.ambient_occlusion)},
                                     {"Shadow Darkness", number(l.shadow_darkness)},
                                     {"Soft Shadows", number(l.soft_shadows)},
                                     {"Specular Intensity", number(l.specular_intensity)},
                                     {"Specular Exponent", yaml_scalar(128)},
                                     {"Skip Shadows & Shading", yaml_switch(l.skip)}});
    add_surroundings(scene, numbers, properties, diagnostics);
    Value name = yaml_word("Lighting");
    if (kept.lighting && kept.lighting->items.size() == 3) {
        name = kept.lighting->items[1];
        const NodeTypeRow &row = row_of(NodeType::Lighting);
        for (const auto &[key, value] : kept.lighting->items[2].entries) {
            Value *present = find(properties, key);
            const PropertyType *type = find_property(row, key);
            if (!present)
                properties.entries.emplace_back(key, value);
            else if (type &&
                     (type->kind == PropertyKind::Carried || number_of(*present) == type->fallback))
                *present = value;
        }
    }
    properties.entries.emplace_back("Children", lights_value(scene, numbers, std::move(kept.lights),
                                                             kept.lighting || !kept.items.empty(),
                                                             diagnostics));
    return yaml_list({yaml_word("LightingNode"), std::move(name), std::move(properties)});
}

struct Pose {
    std::array<double, 3> target{};
    double yaw = 0, pitch = 0, distance = 30, fov = 50;
    bool orthographic = false;
};

Pose pose_of(const ir::Scene &scene, Numbers &numbers) {
    constexpr double degree = std::numbers::pi / 180;
    std::array<double, 3> at{}, target{};
    double fov = 45 * degree;
    Pose pose;
    if (scene.camera.given) {
        at = numbers.vector(scene.camera.at).value_or(std::array<double, 3>{0, 0, 30});
        target = numbers.vector(scene.camera.look_at).value_or(target);
        fov = numbers.number(scene.camera.fov).value_or(fov);
        pose.orthographic = scene.camera.orthographic;
    } else { // the frame that the scene is shown in
        const ir::View view = ir::view_of(scene, 0, 1.5);
        const glm::dvec3 looked_at = view.origin + view.focus * view.forward;
        at = {view.origin.x, view.origin.y, view.origin.z};
        target = {looked_at.x, looked_at.y, looked_at.z};
    }
    const std::array<double, 3> away{at[0] - target[0], at[1] - target[1], at[2] - target[2]};
    const double distance = std::sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
    pose.target = target;
    pose.distance = distance > 0 ? distance : 1;
    pose.pitch = distance > 0 ? -std::asin(std::clamp(away[1] / distance, -1.0, 1.0)) / degree : 0;
    pose.yaw = std::atan2(away[0], away[2]) / degree;
    pose.fov = fov / degree;
    for (double *value : {&pose.pitch, &pose.yaw, &pose.fov, &pose.distance})
        *value = std::round(*value * 1e9) / 1e9;
    return pose;
}

Value camera_value(const Pose &pose, const char *second, const char *third) {
    std::vector<Value> items;
    for (const double v : {pose.target[0], pose.target[1], pose.target[2], pose.yaw, pose.pitch,
                           pose.distance, pose.fov})
        items.push_back(yaml_scalar(v));
    for (const char *flag : {pose.orthographic ? "true" : "false", second, third}) {
        Value value;
        value.text = flag;
        value.plain = true;
        items.push_back(std::move(value));
    }
    return yaml_list(std::move(items));
}

bool close(const Pose &pose, const Value &camera) {
    double number[7];
    for (std::size_t i = 0; i < 7; ++i) {
        const auto part = number_of(camera.items[i]);
        if (!part) return true; // what made no sense stays
        number[i] = *part;
    }
    constexpr double degree = std::numbers::pi / 180;
    const auto at = [&](std::array<double, 3> target, double yaw, double pitch, double distance) {
        yaw *= degree, pitch *= degree;
        return std::array<double, 3>{target[0] + distance * std::cos(pitch) * std::sin(yaw),
                                     target[1] - distance * std::sin(pitch),
                                     target[2] + distance * std::cos(pitch) * std::cos(yaw)};
    };
    const auto was = at({number[0], number[1], number[2]}, number[3], number[4], number[5]),
               is = at(pose.target, pose.yaw, pose.pitch, pose.distance);
    double off = 0;
    for (std::size_t i = 0; i < 3; ++i)
        off = std::max({off, std::abs(was[i] - is[i]), std::abs(number[i] - pose.target[i])});
    return off <= 1e-5 * std::max(1.0, pose.distance) && std::abs(number[6] - pose.fov) < 1e-6 &&
           switch_of(camera.items[7]).value_or(pose.orthographic) == pose.orthographic;
}

std::vector<Value> settings_values(const ir::Scene &scene, Numbers &numbers,
                                   const KeptItems &kept) {
    std::vector<Value> values;
    const Pose pose = pose_of(scene, numbers);
    if (kept.items.empty()) { // a scene that was in no save file
        values.push_back(yaml_scalar(ir::budget_of(scene)));
        values.push_back(parse_text("false").value);
        for (const double value : {1.0, 0.5, 0.0, 0.5, 0.5}) values.push_back(yaml_scalar(value));
        Pose side = pose;
        values.push_back(camera_value(pose, "false", "false"));
        side.orthographic = true;
        side.yaw = side.pitch = 0;
        values.push_back(camera_value(side, "true", "false"));
        side.yaw = -90;
        values.push_back(camera_value(side, "false", "true"));
        side.yaw = 0, side.pitch = -90;
        values.push_back(camera_value(side, "false", "false"));
        for (int i = 0; i < 4; ++i)
            values.push_back(parse_text(fmt::format("[{}, false, false]", i)).value);
        return values;
    }
    double chosen = 0;
    for (const MainItem &item : kept.items) {
        if (item.label != "view") continue;
        if (item.value.kind == Value::Kind::Sequence && !item.value.items.empty())
            chosen = number_of(item.value.items[0]).value_or(0);
        break;
    }
    double camera = 0;
    for (const MainItem &item : kept.items) {
        Value value = item.value;
        if (item.label == "steps") {
            const auto steps = number_of(value);
            const bool legal =
                steps && *steps >= 1 && *steps <= 100000 && *steps == std::floor(*steps);
            if (legal && *steps != ir::budget_of(scene)) value = yaml_scalar(ir::budget_of(scene));
        } else if (item.label == "camera" && value.items.size() == 10) {
            if (camera++ == chosen && scene.camera.given && !close(pose, value)) {
                const Value second = value.items[8], third = value.items[9];
                value = camera_value(pose, "false", "false");
                value.items[8] = second;
                value.items[9] = third;
            }
        }
        values.push_back(std::move(value));
    }
    return values;
}

} // namespace

// Sliders, as they are: everything that follows them says so by their names.
static Value parameters_value(const ir::Scene &scene) {
    std::vector<Value> items;
    for (const ir::Param &param : scene.params) {
        const auto list = [&](const std::array<double, 4> &numbers) {
            std::vector<Value> parts;
            for (int i = 0; i < ir::components(param.type); ++i) {
                const double v = numbers[static_cast<std::size_t>(i)];
                parts.push_back(yaml_scalar(param.is_color ? channel_of(v) : v));
            }
            return parts.size() == 1 ? parts[0] : yaml_list(std::move(parts));
        };
        Value item = yaml_mapping({{"Name", yaml_word(param.name)}});
        if (param.label != param.name) item.entries.emplace_back("Label", yaml_word(param.label));
        const char *type = param.is_color                 ? "Color"
                           : param.type == ir::Type::Bool ? "Switch"
                           : param.type == ir::Type::Int  ? "Whole"
                           : param.type == ir::Type::Vec2 ? "Vec2"
                           : param.type == ir::Type::Vec3 ? "Vec3"
                           : param.type == ir::Type::Vec4 ? "Vec4"
                                                          : "Float";
        if (param.type != ir::Type::Float) item.entries.emplace_back("Type", yaml_word(type));
        item.entries.emplace_back("Value", param.type == ir::Type::Bool
                                               ? yaml_switch(param.value[0] != 0)
                                               : list(param.value));
        if (param.has_range) {
            item.entries.emplace_back("Low", list(param.lo));
            item.entries.emplace_back("High", list(param.hi));
        }
        items.push_back(std::move(item));
    }
    return yaml_list(std::move(items));
}

static Value caches_value(Numbers &numbers) {
    std::vector<Value> items;
    for (const FlowWords::Cached &cached : numbers.words().caches)
        items.push_back(yaml_mapping(
            {{"Cell", yaml_scalar(cached.cell)}, {"Field", parse_text(cached.flow).value}}));
    return yaml_list(std::move(items));
}

std::string export_yaml(const ir::Scene &scene, Diagnostics &diagnostics,
                        const ExportOptions &options) {
    KeptItems kept = read_kept(scene.kept);
    Budget budget(options.limits, diagnostics);
    const FileNames files(options, diagnostics);
    Numbers numbers(scene, budget);
    Appearances appearances(scene, numbers, files, std::move(kept.textures),
                            std::move(kept.materials));
    TreeNode root;
    root.type = "Generic";
    root.name = "Distance field";
    root.named = root.head = true;
    root.children = export_tree(scene, numbers, appearances, diagnostics);
    if (budget.spent()) return "";
    for (const TreeRecord *record : apply_records(kept.tree, root)) {
        std::string place;
        for (const std::size_t index : record->path)
            place += fmt::format("{}{}", (place.empty() ? "" : "/"), index);
        unsaved(diagnostics, {},
                "the kept `" + record->label + " " + place +
                    "` no longer has a place in the scene");
    }
    for (const std::string &statement : kept.unread) {
        unsaved(diagnostics, {}, "the kept `" + statement.substr(0, 60) + "` cannot be read");
    }

    std::string out = "---\n";
    Value version;
    version.text = written_version;
    version.plain = true;
    write_item(kept.version.value_or(version), 0, out);
    write_item(appearances.textures(), 0, out);
    write_item(yaml_list(appearances.materials()), 0, out);
    std::map<std::string, int> ordinals;
    Value lighting = lighting_value(scene, numbers, kept, diagnostics); // programs: before caches
    const Value caches = caches_value(numbers), parameters = parameters_value(scene);
    if (!caches.items.empty()) root.properties.insert(root.properties.begin(), {"Caches", caches});
    if (!parameters.items.empty())
        root.properties.insert(root.properties.begin(), {"Parameters", parameters});
    report_labelled(scene, numbers, root, lighting, diagnostics);
    Value tree = node_value(std::move(root), ordinals);
    const bool beside = kept.lighting && !kept.lighting->items.empty() &&
                        switch_of(kept.lighting->items[0]).value_or(false);
    if (beside && !tree.items[2].entries.empty()) { // as the file had it: among the root's children
        tree.items[2].entries.back().second.items.push_back(std::move(lighting));
        write_item(tree, 0, out);
    } else {
        write_item(tree, 0, out);
        write_item(lighting, 0, out);
    }
    for (const Value &value : settings_values(scene, numbers, kept)) write_item(value, 0, out);
    return budget.spent() ? "" : std::move(out.append("...\n"));
}

} // namespace fathom::save
