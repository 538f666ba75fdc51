#include "backend-glsl/html.h"

#include "backend-glsl/params.h"
#include "backend-glsl/reflection.h"
#include "backend-glsl/template.h"
#include "base/encode.h"
#include "base/pack.h"
#include "base/srgb.h"
#include "base/text.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

static_assert(std::endian::native == std::endian::little); // as the page reads floats

namespace fathom::glsl {

namespace {

constexpr std::size_t most_texts = 8;

// JSON within a script element: no `<`, so no `</script` and no `<!--`. It stands in strings alone.
std::string in_script(const std::string &json) {
    std::string out;
    for (const char c : json)
        if (c == '<')
            out += "\\u003c";
        else
            out += c;
    return out;
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

// Steps that a draw gives a ray: few, so that no draw is long, and fewer where a step runs long
// loops (turns.h).
int steps_a_draw(const Output &output) {
    return static_cast<int>(std::clamp(50000 / (1 + output.turns.written_out) - 128, 16.0, 256.0));
}

// The bytes that hexadecimal digits stand for.
std::string bytes_of_hex(std::string_view digits) {
    const auto value = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
    std::string bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes += static_cast<char>(value(digits[i]) * 16 + value(digits[i + 1]));
    return bytes;
}

// All that a param can be; empty where that is not few numbers.
std::vector<double> few_values(const ir::Param &param) {
    if (param.type == ir::Type::Bool) return {0, 1};
    std::vector<double> values;
    if (param.type != ir::Type::Int || !(param.hi[0] - param.lo[0] < most_texts)) return values;
    for (double value = param.lo[0]; value <= param.hi[0]; ++value) values.push_back(value);
    return values;
}

} // namespace

std::vector<std::map<std::string, double>> page_values(const ir::Scene &scene) {
    std::vector<std::map<std::string, double>> all(1);
    for (const ir::Param &param : scene.params) {
        if (!param.structural) continue;
        std::vector<double> values = few_values(param);
        if (values.empty() || values.size() * all.size() > most_texts) continue;
        const auto own = std::ranges::find(values, param.value[0]);
        if (own != values.end()) std::rotate(values.begin(), own, own + 1);
        std::vector<std::map<std::string, double>> more;
        for (const double value : values)
            for (std::map<std::string, double> one : all) {
                one[param.name] = value;
                more.push_back(std::move(one));
            }
        all = std::move(more);
    }
    return all;
}

std::string words_of(const ir::Scene &scene, const std::map<std::string, double> &values) {
    std::string text;
    for (ir::Param param : scene.params) {
        const auto value = values.find(param.name);
        if (value == values.end()) continue;
        param.value[0] = value->second;
        text += (text.empty() ? "`" : ", `") + param.name + "` = " + value_text(param);
    }
    return text;
}

PageVariant page_variant(const ir::Scene &scene, const Options &options, const Output &output,
                         const std::map<std::string, double> &values) {
    PageVariant variant;
    for (const Sampler &s : output.images) {
        const ir::ImageData &image = scene.images[s.index];
        const std::string bytes = bytes_of(image);
        variant.textures.push_back(
            fmt::format("{{\"name\": {}, \"bytes\": {}", for_json(s.name), !bytes.empty()));
        variant.data.push_back(bytes.empty()
                                   ? packed(image.rgba.data(), image.rgba.size() * sizeof(float))
                                   : packed(bytes.data(), bytes.size()));
    }
    for (const Sampler &s : output.grids) {
        const ir::GridData &grid = scene.grids[s.index];
        variant.textures.push_back(
            fmt::format("{{\"name\": {}, \"bytes\": false", for_json(s.name)));
        variant.data.push_back(packed(grid.values.data(), grid.values.size() * sizeof(float)));
    }
    std::string chosen;
    for (const auto &[name, value] : values)
        chosen += fmt::format("{}{}: [{}]", chosen.empty() ? "" : ", ", for_json(name),
                              format_shortest(value));
    variant.json = fmt::format(
        "\"values\": {{{}}}, \"passes\": {{\"budget\": {}, \"steps\": {}}},\n\"reflection\": "
        "{}, \"packed\": {}",
        chosen, output.budget, steps_a_draw(output), reflection_json(scene, options, output),
        packed(output.text.data(), output.text.size()));
    return variant;
}

std::string html_page(const Options &options, const std::vector<PageVariant> &variants) {
    std::vector<std::string> data; // what several variants have stands once
    std::string all;
    for (const PageVariant &variant : variants) {
        std::string textures;
        for (std::size_t i = 0; i < variant.data.size(); ++i) {
            const auto at = std::ranges::find(data, variant.data[i]);
            textures += fmt::format("{}{}, \"data\": {}}}", i ? ", " : "", variant.textures[i],
                                    at - data.begin());
            if (at == data.end()) data.push_back(variant.data[i]);
        }
        all += fmt::format("{}{{{}, \"textures\": [{}]}}", all.empty() ? "" : ",\n", variant.json,
                           textures);
    }
    const std::string scene =
        fmt::format("\n{{\"title\": {},\n\"variants\": [{}],\n\"data\": [{}]}}\n",
                    for_json(options.title), all, fmt::join(data, ",\n"));
    return expand("page", {{"TITLE", for_html(options.title)},
                           {"SCRIPT_HASH", base64(bytes_of_hex(expand("page_hash", {})))},
                           {"SCRIPT", expand("page_script", {})},
                           {"SCENE", in_script(scene)}});
}

} // namespace fathom::glsl
