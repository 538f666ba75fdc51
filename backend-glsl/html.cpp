#include "backend-glsl/html.h"

#include "backend-glsl/params.h"
#include "backend-glsl/template.h"
#include "base/encode.h"
#include "base/pack.h"
#include "base/srgb.h"
#include "base/text.h"
#include "ir/view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

static_assert(std::endian::native == std::endian::little); // as the page reads floats

namespace fathom::glsl {

namespace {

std::string array(const double *values, std::size_t count) {
    std::string text = "[";
    for (std::size_t i = 0; i < count; ++i) text += (i ? ", " : "") + format_shortest(values[i]);
    return text + "]";
}

std::string array(const glm::dvec3 &v) { return array(&v.x, 3); }

const std::string &label_of(const ir::Param &p) { return p.label.empty() ? p.name : p.label; }

// Objects of JSON with a comma between them.
class List {
  public:
    void add(const std::string &object) { text_ += (text_.empty() ? "" : ",\n  ") + object; }
    std::string take() const { return "[" + text_ + "]"; }

  private:
    std::string text_;
};

// {name, label, type, color, range, value, lo, hi}: what the page makes a control of.
std::string controls(const ir::Scene &scene, const std::vector<Uniform> &uniforms) {
    List list;
    for (const Uniform &u : uniforms) {
        const ir::Param &p = scene.params[u.param];
        const std::size_t size = static_cast<std::size_t>(ir::components(p.type));
        list.add("{\"name\": " + for_script(u.name) + ", \"label\": " + for_script(label_of(p)) +
                 ", \"type\": \"" + ir::type_name(p.type) +
                 "\", \"color\": " + (p.is_color ? "true" : "false") + ", \"range\": " +
                 (p.has_range ? "true" : "false") + ", \"value\": " + array(p.value.data(), size) +
                 ", \"lo\": " + array(p.lo.data(), size) + ", \"hi\": " + array(p.hi.data(), size) +
                 "}");
    }
    return list.take();
}

// {label, value}: what the page shows as fixed.
std::string fixed_params(const ir::Scene &scene) {
    List list;
    for (const ir::Param &p : scene.params)
        if (p.structural)
            list.add("{\"label\": " + for_script(label_of(p)) +
                     ", \"value\": " + for_script(value_text(p)) + "}");
    return list.take();
}

std::string packed(const void *data, std::size_t size) {
    return "\"" + base64(compressed({static_cast<const char *>(data), size})) + "\"";
}

// An image's bytes as sRGB and straight alpha, where these say all of its numbers; else nothing.
std::string bytes_of(const ir::ImageData &image) {
    std::string bytes(image.rgba.size(), '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const float value = image.rgba[i];
        const bool alpha = i % 4 == 3;
        const float byte = std::round(255 * (alpha ? value : srgb_of_linear(value)));
        if (!(byte >= 0 && byte <= 255)) return "";
        const float back = alpha ? byte / 255 : linear_of_srgb(byte / 255);
        if (!(std::abs(back - value) <= 1e-6f)) return "";
        bytes[i] = static_cast<char>(static_cast<unsigned char>(byte));
    }
    return bytes;
}

// {name, size, bytes, data}: RGBA of bytes or floats, compressed; grids are floats.
std::string samplers(const ir::Scene &scene, const Output &output) {
    List list;
    for (const Sampler &s : output.images) {
        const ir::ImageData &image = scene.images[s.index];
        const std::string bytes = bytes_of(image);
        const double size[] = {static_cast<double>(image.width), static_cast<double>(image.height)};
        list.add("{\"name\": " + for_script(s.name) + ", \"size\": " + array(size, 2) +
                 ", \"bytes\": " + (bytes.empty() ? "false" : "true") + ", \"data\": " +
                 (bytes.empty() ? packed(image.rgba.data(), image.rgba.size() * sizeof(float))
                                : packed(bytes.data(), bytes.size())) +
                 "}");
    }
    for (const Sampler &s : output.grids) {
        const ir::GridData &grid = scene.grids[s.index];
        const double size[] = {static_cast<double>(grid.size[0]), static_cast<double>(grid.size[1]),
                               static_cast<double>(grid.size[2])};
        list.add("{\"name\": " + for_script(s.name) + ", \"size\": " + array(size, 3) +
                 ", \"bytes\": false, \"data\": " +
                 packed(grid.values.data(), grid.values.size() * sizeof(float)) + "}");
    }
    return list.take();
}

// Steps that a draw gives a ray: few, so that no draw is long, and fewer where a step runs long
// loops (turns.h).
int steps_a_draw(const Output &output) {
    return static_cast<int>(std::clamp(50000 / (1 + output.turns) - 128, 16.0, 256.0));
}

std::string fingerprint(const std::string &text) { return "sha256-" + base64(sha256(text)); }

} // namespace

std::string html_page(const ir::Scene &scene, const Options &options, const Output &output,
                      const std::string &fragment) {
    const ir::View view = ir::view_of(scene, options.time, 16.0 / 9.0);
    const glm::dvec3 sun = ir::lights_of(scene, options.time, view)[0].position;
    const bool animated =
        fragment.find("fathom_time", fragment.find("fathom_time;") + 1) != std::string::npos;
    const std::string style = "\n" + expand("page_style", {}),
                      script = "\n" + expand("page_shaders", {}) + expand("page_draw", {}) +
                               expand("page_controls", {});
    return expand("page", {{"TITLE", for_html(options.title)},
                           {"NAME", for_script(options.title)},
                           {"STYLE", style},
                           {"SCRIPT", script},
                           {"STYLE_HASH", fingerprint(style)},
                           {"SCRIPT_HASH", fingerprint(script)},
                           {"FIXED", fixed_params(scene)},
                           {"PARAMS", controls(scene, output.uniforms)},
                           {"SAMPLERS", samplers(scene, output)},
                           {"TARGET", array(view.origin + view.focus * view.forward)},
                           {"BACK", array(-view.forward)},
                           {"FOCUS", format_shortest(view.focus)},
                           {"EXTENT", format_shortest(view.extent)},
                           {"ORTHOGRAPHIC", view.orthographic ? "true" : "false"},
                           {"SUN", array(sun)},
                           {"ANIMATED", animated ? "true" : "false"},
                           {"START", format_shortest(options.time)},
                           {"SECONDS", format_shortest(scene.render.time_end)},
                           {"BUDGET", format_shortest(static_cast<double>(output.budget))},
                           {"STEPS", format_shortest(static_cast<double>(steps_a_draw(output)))},
                           {"FRAGMENT", for_script(fragment)}});
}

} // namespace fathom::glsl
