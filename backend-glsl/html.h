// One self-contained WebGL 2 page around GLSL ES 3.00 texts by passes (docs/web.md): web/page.html, with
// the element of web/fathom-view.js. Loads nothing: its policy forbids it.
#pragma once

#include "backend-glsl/emit.h"

namespace fathom::glsl {

// The values that a page has texts for, a list of structural params with their numbers; the first is
// what the scene has. A param counts whose values are few (a bool, a range of whole numbers), as long
// as the texts are 8 at most; params are taken in the scene's order.
std::vector<std::map<std::string, double>> page_values(const ir::Scene &scene);

// "`a` = 1, `b` = true"
std::string words_of(const ir::Scene &scene, const std::map<std::string, double> &values);

// What the page holds of a text: JSON, and the bytes of its textures.
struct PageVariant {
    std::string json;                  // without `textures`
    std::vector<std::string> textures; // JSON of each up to its data
    std::vector<std::string> data;     // of each, packed
};
PageVariant page_variant(const ir::Scene &scene, const Options &options, const Output &output,
                         const std::map<std::string, double> &values);

std::string html_page(const Options &options, const std::vector<PageVariant> &variants);

} // namespace fathom::glsl
