#include "backend-glsl/html.h"

#include "backend-glsl/params.h"
#include "backend-glsl/template.h"
#include "base/encode.h"
#include "base/text.h"
#include "ir/view.h"

namespace fathom::glsl {

namespace {

std::string array(const double *values, std::size_t count) {
    std::string text = "[";
    for (std::size_t i = 0; i < count; ++i) text += (i ? ", " : "") + format_shortest(values[i]);
    return text + "]";
}

// {name, label, type, color, value, lo, hi}: what the page makes a control of.
std::string controls(const ir::Scene &scene, const std::vector<Uniform> &uniforms) {
    std::string text = "[";
    for (const Uniform &u : uniforms) {
        const ir::Param &p = scene.params[u.param];
        const std::size_t size = static_cast<std::size_t>(ir::components(p.type));
        if (text.size() > 1) text += ",\n  ";
        text += "{name: " + for_script(u.name) +
                ", label: " + for_script(p.label.empty() ? p.name : p.label) + ", type: \"" +
                ir::type_name(p.type) + "\", color: " + (p.is_color ? "true" : "false") +
                ", range: " + (p.has_range ? "true" : "false") +
                ", value: " + array(p.value.data(), size) + ", lo: " + array(p.lo.data(), size) +
                ", hi: " + array(p.hi.data(), size) + "}";
    }
    return text + "]";
}

// What the page has no control for: names and numbers, which hold nothing that could end a comment.
std::string fixed_params(const ir::Scene &scene) {
    std::string text;
    for (const ir::Param &p : scene.params)
        if (p.structural)
            text += (text.empty() ? "" : ", ") + p.name + " = " + value_text(p) +
                    (p.has_range ? " in " + range_text(p) : "");
    return text.empty() ? ""
                        : "\n<!-- Constants here, since they decide what there is: " + text +
                              ". `fathom compile -D NAME=VALUE` writes the page for others. -->";
}

} // namespace

std::string html_page(const ir::Scene &scene, const Options &options,
                      const std::vector<Uniform> &uniforms, const std::string &fragment) {
    const ir::View view = ir::view_of(scene, options.time, 16.0 / 9.0);
    const glm::dvec3 sun = ir::lights_of(scene, options.time, view)[0].position;
    const glm::dvec3 target = view.origin + view.focus * view.forward, back = -view.forward;
    return expand("page", {{"TITLE", for_html(options.title)},
                           {"FIXED", fixed_params(scene)},
                           {"PARAMS", controls(scene, uniforms)},
                           {"TARGET", array(&target.x, 3)},
                           {"BACK", array(&back.x, 3)},
                           {"FOCUS", format_shortest(view.focus)},
                           {"EXTENT", format_shortest(view.extent)},
                           {"ORTHOGRAPHIC", view.orthographic ? "true" : "false"},
                           {"SUN", array(&sun.x, 3)},
                           {"ANIMATED", fragment.find("fathom_time", fragment.find("fathom_time;") +
                                                                         1) != std::string::npos
                                            ? "true"
                                            : "false"},
                           {"SECONDS", format_shortest(scene.render.time_end)},
                           {"FRAGMENT", for_script(fragment)}});
}

} // namespace fathom::glsl
