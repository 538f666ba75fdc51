// Text of the language, piece by piece; see sdf_text.h.
#include "save-format/sdf_text.h"

#include "base/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <unordered_set>

namespace fathom::save {
namespace {

// Words that an imported name must not hide: the language's own, and what stdlib.md and CSS name.
const std::unordered_set<std::string_view> &known_words() {
    static const std::unordered_set<std::string_view> words = {
        // keywords, constants, types
        "let", "var", "fn", "for", "in", "if", "else", "while", "limit", "break", "return",
        "import", "as", "param", "and", "or", "not", "true", "false", "pi", "tau", "turn", "inf",
        "time", "float", "int", "bool", "string", "vec2", "vec3", "vec4", "mat2", "mat3", "mat4",
        "color", "shape", "shape2", "material", "light", "region", "dfmodel", "p", "deg", "rad",
        // solids
        "sphere", "box", "rounded_box", "box_frame", "torus", "capped_torus", "link", "cylinder",
        "rounded_cylinder", "capsule", "cone", "capped_cone", "round_cone", "prism", "pyramid",
        "tetrahedron", "octahedron", "dodecahedron", "icosahedron", "plane", "slab", "ellipsoid",
        "superquadric", "gdf", "gdf_tetrahedron", "gdf_cube", "gdf_octahedron", "gdf_dodecahedron",
        "gdf_icosahedron", "gdf_truncated_octahedron", "gdf_truncated_icosahedron", "gdf_blend",
        "metaballs", "metaballs_random", "menger", "gyroid", "schwarz_p", "mandelbulb", "helix",
        "heightfield", "tubes", "distance_grid", "empty", "circle", "ellipse", "rectangle",
        "rounded_rectangle", "polygon", "regular_polygon", "star", "segment", "arc", "ring",
        "bezier", "extrude", "revolve",
        // combinations and transforms
        "union", "intersection", "difference", "xor", "complement", "smooth_union",
        "smooth_intersection", "smooth_difference", "round_union", "round_intersection",
        "round_difference", "chamfer_union", "chamfer_intersection", "chamfer_difference",
        "stairs_union", "stairs_intersection", "stairs_difference", "columns_union",
        "columns_intersection", "columns_difference", "pipe", "engrave", "groove", "tongue",
        "blend", "pseudonorm_blend", "translate", "rotate", "rotate_euler", "orient", "scale",
        "mirror", "reflect", "turnaround", "twist", "bend", "taper", "elongate", "hyperize",
        "offset", "shell", "displace", "displace_map", "distort", "repeat", "repeat_polar",
        "repeat_mirror", "hide", "only", "lipschitz", "implicit", "ball", "aabb", "tube",
        "everywhere",
        // fields, numbers, lists
        "noise", "fbm", "ridged", "turbulence", "simplex", "value_noise", "worley", "spot_noise",
        "hash", "cached", "div", "map_range", "saturate", "smin", "smax", "rotate2", "random",
        "pick", "shuffle", "concat", "len", "map", "filter", "fold", "zip", "reverse", "sort",
        "print", "assert", "range",
#define FATHOM_FUNCTION(name, function, ...) #function,
#include "ir/ops.def"
        "pow", "abs", "sign", "floor", "ceil", "round", "trunc", "fract", "mod", "min", "max",
        "clamp", "mix", "step", "smoothstep", "length", "distance", "dot", "cross", "normalize",
        "transpose", "inverse", "determinant", "any", "all",
        // looks
        "image", "paint", "repaint", "hsv", "rgb", "palette", "ease_in", "ease_out", "ease_in_out",
        "ease_back", "ease_bounce", "keyframes", "sun", "lighting", "camera", "background",
        "render", "orient",
        // CSS colours
        "aliceblue", "antiquewhite", "aqua", "aquamarine", "azure", "beige", "bisque", "black",
        "blanchedalmond", "blue", "blueviolet", "brown", "burlywood", "cadetblue", "chartreuse",
        "chocolate", "coral", "cornflowerblue", "cornsilk", "crimson", "cyan", "darkblue",
        "darkcyan", "darkgoldenrod", "darkgray", "darkgreen", "darkgrey", "darkkhaki",
        "darkmagenta", "darkolivegreen", "darkorange", "darkorchid", "darkred", "darksalmon",
        "darkseagreen", "darkslateblue", "darkslategray", "darkslategrey", "darkturquoise",
        "darkviolet", "deeppink", "deepskyblue", "dimgray", "dimgrey", "dodgerblue", "firebrick",
        "floralwhite", "forestgreen", "fuchsia", "gainsboro", "ghostwhite", "gold", "goldenrod",
        "gray", "green", "greenyellow", "grey", "honeydew", "hotpink", "indianred", "indigo",
        "ivory", "khaki", "lavender", "lavenderblush", "lawngreen", "lemonchiffon", "lightblue",
        "lightcoral", "lightcyan", "lightgoldenrodyellow", "lightgray", "lightgreen", "lightgrey",
        "lightpink", "lightsalmon", "lightseagreen", "lightskyblue", "lightslategray",
        "lightslategrey", "lightsteelblue", "lightyellow", "lime", "limegreen", "linen", "magenta",
        "maroon", "mediumaquamarine", "mediumblue", "mediumorchid", "mediumpurple",
        "mediumseagreen", "mediumslateblue", "mediumspringgreen", "mediumturquoise",
        "mediumvioletred", "midnightblue", "mintcream", "mistyrose", "moccasin", "navajowhite",
        "navy", "oldlace", "olive", "olivedrab", "orange", "orangered", "orchid", "palegoldenrod",
        "palegreen", "paleturquoise", "palevioletred", "papayawhip", "peachpuff", "peru", "pink",
        "plum", "powderblue", "purple", "rebeccapurple", "red", "rosybrown", "royalblue",
        "saddlebrown", "salmon", "sandybrown", "seagreen", "seashell", "sienna", "silver",
        "skyblue", "slateblue", "slategray", "slategrey", "snow", "springgreen", "steelblue",
        "teal", "thistle", "tomato", "transparent", "turquoise", "violet", "wheat", "white",
        "whitesmoke", "yellow", "yellowgreen"};
    return words;
}

bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); }

// "Left pillar (2)" -> "left_pillar_2"; what is not ASCII is left out.
std::string identifier(std::string_view text) {
    std::string name;
    for (const char raw : text.substr(0, 60)) {
        const char c = raw >= 'A' && raw <= 'Z' ? static_cast<char>(raw - 'A' + 'a') : raw;
        if (is_word(c)) {
            if (name.empty() && c >= '0' && c <= '9') name = "n";
            name += c;
        } else if (!name.empty() && name.back() != '_') {
            name += '_';
        }
    }
    while (!name.empty() && name.back() == '_') name.pop_back();
    return name;
}

std::size_t columns(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    }));
}

} // namespace

std::string sdf_number(double value) {
    if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
    if (value == 0) return "0";
    std::string text = format_shortest(value);
    if (const auto plus = text.find("e+"); plus != std::string::npos) text.erase(plus + 1, 1);
    return text;
}

std::string sdf_vector(const double (&value)[3]) {
    return "[" + sdf_number(value[0]) + ", " + sdf_number(value[1]) + ", " + sdf_number(value[2]) +
           "]";
}

std::string sdf_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (c == '\n') {
            out += "\\n";
        } else if (c == '\t') {
            out += "\\t";
        } else if (static_cast<unsigned char>(c) >= 0x20) { // others the language does not read
            out += c;
        }
    }
    return out + '"';
}

std::string sdf_color(double red, double green, double blue) {
    const std::array<double, 3> parts{red, green, blue};
    const bool whole =
        std::all_of(parts.begin(), parts.end(), [](double v) { return v == std::floor(v); });
    if (!whole)
        return "rgb(" + sdf_number(red / 255) + ", " + sdf_number(green / 255) + ", " +
               sdf_number(blue / 255) + ")";
    static const char *hex = "0123456789abcdef";
    std::string out = "#";
    for (const double part : parts) {
        const int byte = static_cast<int>(part);
        out += hex[byte >> 4];
        out += hex[byte & 15];
    }
    return out;
}

std::string Names::unique(std::string_view wanted, std::string_view suffix) {
    std::string name = identifier(wanted);
    if (name.empty()) {
        name = suffix;
    } else if (known_words().contains(name)) {
        name += '_';
        name += suffix;
    }
    // what is without a letter of ours is called by its kind, `material_1`: the kind itself is a word
    const bool known = known_words().contains(name);
    if (!known && taken_.try_emplace(name, 1).second) return name;
    for (;;) {
        std::string numbered = fmt::format("{}_{}", name, ++taken_[name]);
        if (taken_.try_emplace(numbered, 1).second) return numbered;
    }
}

std::string marked(std::uint32_t place, std::string text) {
    return fmt::format("{}{}{}{}", part_mark, place, part_end, std::move(text));
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> take_marks(std::string &text) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
    std::string plain;
    plain.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != part_mark) {
            plain += text[i];
            continue;
        }
        std::uint32_t place = 0;
        while (text[++i] != part_end)
            place = 10 * place + static_cast<std::uint32_t>(text[i] - '0');
        places.emplace_back(static_cast<std::uint32_t>(plain.size()), place);
    }
    text = std::move(plain);
    return places;
}

void print_body(const Body &body, std::string_view head, std::string &out) {
    std::size_t depth = 0;
    bool first = true;
    for (const Piece &piece : body) {
        if (piece.kind == Piece::Kind::Nothing) continue;
        if (piece.kind == Piece::Kind::Close) --depth;
        const std::string indent(2 * depth, ' ');
        std::string text = first ? std::string(head) + piece.text : piece.text;
        first = false;
        const auto marks =
            static_cast<std::size_t>(std::count(text.begin(), text.end(), chain_mark));
        std::string unmarked = text;
        take_marks(unmarked);
        const bool long_line = indent.size() + columns(unmarked) - marks > 100;
        out += indent;
        bool first_link = true;
        for (const char c : text) {
            if (c != chain_mark) {
                out += c;
                continue;
            }
            // The first call stays on the line of what it is applied to: `sphere(1).paint(…)`.
            if (long_line && !first_link) out += "\n" + indent + "  ";
            first_link = false;
        }
        if (!piece.comment.empty()) out += " // " + piece.comment;
        out += '\n';
        if (piece.kind == Piece::Kind::Open) ++depth;
    }
}

} // namespace fathom::save
