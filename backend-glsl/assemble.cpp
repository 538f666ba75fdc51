#include "backend-glsl/assemble.h"

#include "backend-glsl/helpers.h"
#include "backend-glsl/template.h"
#include "ir/shading.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::glsl {

using ir::FunctionId;
using ir::NodeId;
using ir::Type;

namespace {

constexpr std::size_t material_table_from = 5; // so many plain materials are a table

class Assembler {
  public:
    explicit Assembler(Module &module)
        : module_(module), scene_(module.scene), graph_(module.scene.graph) {}

    SceneText run(bool with_shading) {
        std::vector<NodeId> roots;
        const auto want = [&](NodeId id) {
            if (id) roots.push_back(id);
        };
        const auto want_function = [&](FunctionId id, const char *name) {
            if (!id) return;
            module_.functions[id.index] = name;
            want(module_.result_of(id));
        };
        const std::string hit =
            module_.options.part_stride > 0 ? "fathom_marked_hit" : "fathom_hit";
        want_function(scene_.distance, module_.around ? "fathom_all" : "sdf");
        if (!module_.options.field_only) want_function(scene_.safe_radius, "fathom_safe_radius");
        if (with_shading && is_shaded_apart(scene_)) want_function(scene_.shaded, "fathom_shaded");
        if (scene_.hit != scene_.distance)
            want_function(scene_.hit, module_.around ? "fathom_all_hit" : hit.c_str());
        if (module_.around) {
            want_function(scene_.endless, "fathom_endless");
            want_function(scene_.endless_hit, "fathom_endless_hit");
        }
        for (const ir::Surface &s : scene_.surfaces)
            for (NodeId id : {s.diffuse, s.specular, s.exponent, s.emission}) want(id);
        if (with_shading) {
            want_function(scene_.background_function, "fathom_background");
            const ir::Lighting &l = scene_.lighting;
            for (NodeId id : {l.ambient, l.ambient_occlusion, l.shadow_darkness, l.soft_shadows,
                              l.specular_intensity, l.fill, l.occlusion_reach})
                want(id);
            for (const ir::Light &light : scene_.lights) {
                want(light.position);
                want(light.color);
            }
        }
        module_.names.unique("sdf");
        gather(module_, roots);

        std::string functions;
        for (const auto &[index, name] : module_.functions)
            functions += function(FunctionId{index}, name) + readers(index);
        if (module_.around) functions += prune_around(hit);
        if (!scene_.distance) functions += expand("empty", {});
        std::string shading = materials();
        if (with_shading) shading += lighting() + lights();
        if (with_shading && !scene_.background_function) {
            const auto &c = ir::shading::background;
            shading += expand("background", {{"COLOR", vec3_literal({c[0], c[1], c[2]})}});
        }
        result_.functions =
            expand("hit_type", {}) + helper_text(module_.helpers) + cached_inputs() + functions;
        result_.shading = shading;
        for (const auto &[index, use] : module_.tables) result_.tables += table(use);
        for (const TableUse &use : own_tables_) result_.tables += table(use);
        return std::move(result_);
    }

    SceneText run_functions(std::span<const FunctionId> wanted) {
        std::vector<NodeId> roots;
        for (FunctionId id : wanted) {
            module_.functions[id.index] = module_.names.unique(graph_.function(id).name);
            roots.push_back(module_.result_of(id));
        }
        gather(module_, roots);
        std::string functions;
        for (const auto &[index, name] : module_.functions)
            functions += function(FunctionId{index}, name);
        result_.functions = helper_text(module_.helpers) + functions;
        for (const auto &[index, use] : module_.tables) result_.tables += table(use);
        return std::move(result_);
    }

  private:
    std::string cached_inputs() const {
        std::vector<CachedText> fields;
        for (const auto &[id, field] : module_.cached) fields.push_back(field);
        return fields.empty() ? "" : cache_look_up(fields);
    }

    // What reads the cached fields that this function computes.
    std::string readers(std::uint32_t function) const {
        std::string text;
        std::size_t number = 0;
        for (const auto &[id, field] : module_.cached) {
            if (graph_.cache(ir::CacheId{id}).field.index == function)
                text += cache_reader(field, number);
            ++number;
        }
        return text;
    }

    std::string function(FunctionId id, const std::string &name) {
        const ir::Function &f = graph_.function(id);
        std::vector<Bound> bound;
        const char *const names[] = {"p", "q", "a", "b", "c"};
        for (std::size_t i = 0; i < f.params.size(); ++i)
            bound.push_back({f.params[i], i < std::size(names) ? names[i] : fmt::format("x{}", i)});
        const NodeId root = module_.result_of(id);
        Body text = body(module_, bound, {&root, 1});
        std::string head =
            "\n" + place(f) + std::string(glsl_type(graph_[root].type)) + " " + name + "(";
        for (std::size_t i = 0; i < bound.size(); ++i)
            head += std::string(i ? ", " : "") + glsl_type(graph_[bound[i].var].type) + " " +
                    bound[i].name;
        return head + ") {\n" + text.statements + "    return " + text.values[0] + ";\n}\n";
    }

    std::string place(const ir::Function &f) const {
        if (!module_.options.place || !f.origin.source) return "";
        const std::string where = module_.options.place(f.origin);
        return where.empty() ? "" : comment(f.name + ", " + where);
    }

    // -- materials
    // ---------------------------------------------------------------------------------------------------

    static std::vector<NodeId> roots_of(const ir::Surface &s) {
        return {s.diffuse, s.specular, s.exponent, s.emission};
    }

    bool is_plain(const ir::Surface &s) const {
        return std::ranges::all_of(roots_of(s), [&](NodeId id) { return graph_.is_constant(id); });
    }

    bool reads(const ir::Surface &s, NodeId var) const {
        return var && std::ranges::any_of(roots_of(s), [&](NodeId id) {
                   return graph_.reads(id).free_vars &&
                          std::ranges::count(graph_.free_vars(id), var) > 0;
               });
    }

    std::string materials() {
        const auto &surfaces = scene_.surfaces;
        const auto plain = static_cast<std::size_t>(
            std::ranges::count_if(surfaces, [&](const ir::Surface &s) { return is_plain(s); }));
        const bool as_table = plain >= material_table_from;
        std::string functions, choices;
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            const ir::Surface &s = surfaces[i];
            if (as_table && is_plain(s)) continue;
            const bool last = i + 1 == surfaces.size() && !as_table;
            const std::string when =
                last ? "    return " : fmt::format("    if (paint == {}) return ", i);
            if (is_plain(s)) {
                std::vector<Bound> none;
                choices += when + constructor(body(module_, none, roots_of(s)).values) + ";\n";
                continue;
            }
            const std::string name = fmt::format("fathom_material_{}", i);
            std::vector<Bound> bound;
            if (s.point) bound.push_back({s.point, "point"});
            if (s.normal) bound.push_back({s.normal, "normal"});
            if (s.extra) bound.push_back({s.extra, "extra"});
            result_.local_normals |= reads(s, s.normal);
            const Body values = body(module_, bound, roots_of(s));
            functions += "\nfathom_Material " + name + "(vec3 point, vec3 normal, vec4 extra) {\n" +
                         values.statements + "    return " + constructor(values.values) + ";\n}\n";
            choices += when + name + "(s.point, normal, s.extra);\n";
        }
        if (as_table) choices += plain_materials();
        const std::size_t count = surfaces.size();
        return expand("materials", {{"VARYING", functions},
                                    {"PAINTED", count ? "1" : ""},
                                    {"COUNT", fmt::to_string(count)},
                                    {"LAST", fmt::to_string(count - 1)},
                                    {"CHOICES", choices}});
    }

    static std::string constructor(const std::vector<std::string> &v) {
        return "fathom_Material(" + v[0] + ", " + v[1] + ", " + v[2] + ", " + v[3] + ")";
    }

    // A row is diffuse, exponent, specular, 0, emission, 0.
    std::string plain_materials() {
        std::vector<float> data;
        for (const ir::Surface &s : scene_.surfaces) {
            std::array<float, 12> row{};
            if (is_plain(s)) {
                const auto put = [&](std::size_t at, NodeId id, std::size_t size) {
                    for (std::size_t i = 0; i < size; ++i)
                        row[at + i] = static_cast<float>(graph_.constant_of(id).value[i]);
                };
                put(0, s.diffuse, 3);
                put(3, s.exponent, 1);
                put(4, s.specular, 3);
                put(8, s.emission, 3);
            }
            data.insert(data.end(), row.begin(), row.end());
        }
        own_tables_.push_back(
            add_table(module_, "materials", static_cast<int>(scene_.surfaces.size()), 12, data));
        const TableUse &use = own_tables_.back();
        return "    vec4 first = " + texel(use, "paint * 3") +
               ";\n    return fathom_Material(first.xyz, " + texel(use, "paint * 3 + 1") +
               ".xyz, first.w, " + texel(use, "paint * 3 + 2") + ".xyz);\n";
    }

    // -- light
    // -------------------------------------------------------------------------------------------------------

    std::string lighting() {
        const ir::Lighting &l = scene_.lighting;
        const std::vector<NodeId> all{l.ambient,        l.ambient_occlusion,  l.shadow_darkness,
                                      l.soft_shadows,   l.specular_intensity, l.fill,
                                      l.occlusion_reach};
        const std::array<const char *, 7> absent{"vec3(0.25)", "1.0", "0.5", "0.03",
                                                 "0.4",        "0.0", "0.0"};
        std::vector<NodeId> given;
        std::ranges::copy_if(all, std::back_inserter(given),
                             [](NodeId id) { return static_cast<bool>(id); });
        std::vector<Bound> none;
        const Body values = body(module_, none, given);
        std::string list;
        for (std::size_t i = 0, k = 0; i < all.size(); ++i)
            list += (i ? ", " : "") + (all[i] ? values.values[k++] : std::string(absent[i]));
        return expand("lighting", {{"STATEMENTS", values.statements}, {"LIST", list}});
    }

    std::string lights() {
        const std::size_t count = scene_.lights.size();
        result_.lights = static_cast<int>(std::max<std::size_t>(count, 1));
        std::string text;
        for (std::size_t i = 0; i < count; ++i) {
            const ir::Light &light = scene_.lights[i];
            std::vector<Bound> none;
            const std::vector<NodeId> roots{light.position, light.color};
            const Body values = body(module_, none, roots);
            const std::string value =
                std::string("fathom_Light(") + (light.directional ? "true" : "false") + ", " +
                (light.directional ? "normalize(" + values.values[0] + ")" : values.values[0]) +
                ", " + values.values[1] + ")";
            const bool last = i + 1 == count;
            if (!last) text += fmt::format("    if (i == {}) {{\n", i);
            text += values.statements + std::string(last ? "    " : "        ") + "return " +
                    value + ";\n";
            if (!last) text += "    }\n";
        }
        return expand("lights", {{"LIT", count ? "1" : ""}, {"CASES", text}});
    }

    // -- data
    // --------------------------------------------------------------------------------------------------------

    static std::string table(const TableUse &use) {
        if (use.buffer) return "";
        const std::size_t size = use.data.size() / 4;
        std::string text = fmt::format("\nconst vec4 {}[{}] = vec4[](\n", use.name, size);
        for (std::size_t i = 0; i < size; ++i) {
            text += "    vec4(";
            for (std::size_t k = 0; k < 4; ++k)
                text += (k ? ", " : "") + float_literal(use.data[i * 4 + k]);
            text += i + 1 < size ? "),\n" : "));\n";
        }
        return text;
    }

    Module &module_;
    const ir::Scene &scene_;
    const ir::Graph &graph_;
    SceneText result_;
    std::vector<TableUse> own_tables_;
};

} // namespace

SceneText assemble_functions(Module &module, std::span<const FunctionId> wanted) {
    return Assembler(module).run_functions(wanted);
}

SceneText assemble(Module &module, bool with_shading) {
    return Assembler(module).run(with_shading);
}

} // namespace fathom::glsl
