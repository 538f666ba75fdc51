// See helpers.h. Each text is a line-by-line port; the formulas are explained where they are
// defined, in ir/.
#include "backend-glsl/helpers.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace fathom::glsl {

namespace {

// How a helper becomes one for vectors.
enum class Form {
    One,    // there is only this one
    Typed,  // $T stands for float, vec2, vec3, vec4
    Lifted, // written for floats; for vectors it is called component by component
    Int     // for ints, under the same name
};

struct Helper {
    const char *name;
    Form form;
    std::vector<HelperKey> needs;
    const char *text;
};

const std::vector<Helper> &library() {
    static const std::vector<Helper> helpers = {
        // -- ints (semantics.h): 32 bits, saturating
        {"fathom_add", Form::Int, {}, R"(
int fathom_add(int x, int y) {
    int sum = x + y;
    if (y > 0 && sum < x) return 2147483647;
    return y < 0 && sum > x ? -2147483647 - 1 : sum;
}
)"},
        {"fathom_sub", Form::Int, {}, R"(
int fathom_sub(int x, int y) {
    int difference = x - y;
    if (y < 0 && difference < x) return 2147483647;
    return y > 0 && difference > x ? -2147483647 - 1 : difference;
}
)"},
        {"fathom_mul", Form::Int, {}, R"(
int fathom_mul(int x, int y) {
    int least = -2147483647 - 1;
    bool negative = (x < 0) != (y < 0);
    uint a = uint(x < 0 ? -x : x);
    uint b = uint(y < 0 ? -y : y);
    uint most = negative ? 2147483648u : 2147483647u;
    if (b != 0u && a > most / b) return negative ? least : 2147483647;
    uint product = a * b;
    return negative ? (product == 2147483648u ? least : -int(product)) : int(product);
}
)"},
        {"fathom_neg", Form::Int, {}, R"(
int fathom_neg(int x) {
    return x == -2147483647 - 1 ? 2147483647 : -x;
}
)"},
        {"fathom_div", Form::One, {}, R"(
int fathom_div(int x, int y) {
    if (y == 0) return 0;
    return y == -1 ? (x == -2147483647 - 1 ? 2147483647 : -x) : x / y;
}
)"},
        {"fathom_abs", Form::Int, {{"fathom_neg", "int"}}, R"(
int fathom_abs(int x) {
    return x < 0 ? fathom_neg(x) : x;
}
)"},
        {"fathom_mod", Form::Int, {{"fathom_div", ""}}, R"(
int fathom_mod(int x, int y) {
    if (y == 0 || y == -1) return y == 0 ? x : 0;
    int rest = x - y * (x / y);
    return rest != 0 && (rest < 0) != (y < 0) ? rest + y : rest;
}
)"},
        {"fathom_int", Form::One, {}, R"(
int fathom_int(float x) {
    if (x >= 2147483648.0) return 2147483647;
    if (x <= -2147483648.0) return -2147483647 - 1;
    return x == x ? int(x) : 0;
}
)"},
        // -- arithmetic made total (semantics.h)
        {"fathom_mod", Form::Lifted, {}, R"(
float fathom_mod(float x, float y) {
    return y == 0.0 ? x : x - y * floor(x / y);
}
)"},
        {"fathom_pow", Form::Lifted, {}, R"(
float fathom_pow(float x, float y) {
    float size = abs(x);
    float power = size > 0.0 ? pow(size, y) : (y == 0.0 ? 1.0 : (y > 0.0 ? 0.0 : uintBitsToFloat(0x7f800000u)));
    if (x >= 0.0) return power;
    if (floor(y) != y) return 0.0;
    return floor(0.5 * y) == 0.5 * y ? power : -power;
}
)"},
        {"fathom_square", Form::Typed, {}, R"(
$T fathom_square($T x) {
    return x * x;
}
)"},
        {"fathom_cube", Form::Typed, {}, R"(
$T fathom_cube($T x) {
    return x * x * x;
}
)"},
        {"fathom_smoothstep", Form::Lifted, {}, R"(
float fathom_smoothstep(float lo, float hi, float x) {
    if (lo == hi) return step(lo, x);
    float t = clamp((x - lo) / (hi - lo), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}
)"},
        {"fathom_atan2", Form::Lifted, {}, R"(
float fathom_atan2(float y, float x) {
    return y == 0.0 ? (x < 0.0 ? 3.14159274 : 0.0) : atan(y, x);
}
)"},
        {"fathom_sqrt", Form::Typed, {}, R"(
$T fathom_sqrt($T x) {
    return sqrt(max(x, 0.0));
}
)"},
        // By atan, which drivers compute to a few units in the last place; their asin and acos are
        // often cubic fits.
        {"fathom_asin", Form::Lifted, {}, R"(
float fathom_asin(float x) {
    float y = clamp(x, -1.0, 1.0);
    return atan(y, sqrt((1.0 - y) * (1.0 + y)));
}
)"},
        {"fathom_acos", Form::Lifted, {}, R"(
float fathom_acos(float x) {
    float y = clamp(x, -1.0, 1.0);
    return atan(sqrt((1.0 - y) * (1.0 + y)), y);
}
)"},
        {"fathom_tanh", Form::Typed, {}, R"(
$T fathom_tanh($T x) {
    return tanh(clamp(x, -20.0, 20.0));
}
)"},
        {"fathom_normalize", Form::Typed, {}, R"(
$T fathom_normalize($T x) {
    float squared = dot(x, x);
    return squared > 0.0 ? x * (1.0 / sqrt(squared)) : $T(0.0);
}
)"},
        // -- blends (blends.h)
        {"fathom_blend_smooth", Form::One, {}, R"(
float fathom_blend_smooth(float a, float b, float k) {
    float h = max(k - abs(a - b), 0.0);
    return min(a, b) - h * h * (0.25 / max(k, 1e-9));
}
)"},
        {"fathom_blend_round", Form::One, {}, R"(
float fathom_blend_round(float a, float b, float r) {
    float radius = max(r, 0.0);
    float d = min(abs(a - b), radius);
    float u = 0.5 * (d + sqrt(max(2.0 * radius * radius - d * d, 0.0)));
    return min(a, b) - max(radius - u, 0.0);
}
)"},
        {"fathom_blend_chamfer", Form::One, {}, R"(
float fathom_blend_chamfer(float a, float b, float r) {
    return min(a, b) - 0.5 * max(r - abs(a - b), 0.0);
}
)"},
        {"fathom_blend_stairs", Form::One, {}, R"(
float fathom_blend_stairs(float a, float b, float r, float n) {
    float s = max(r, 1e-9) / (max(floor(n + 0.5), 0.0) + 1.0);
    float d = abs(a - b);
    float x = (max(r, 0.0) - d) / (s + s);
    float turn = x - floor(x);
    float wave = (s + s) * min(turn, 1.0 - turn);
    return min(a, b) - 0.5 * max(max(r, 0.0) - d - wave, 0.0);
}
)"},
        {"fathom_blend_columns", Form::One, {}, R"(
float fathom_blend_columns(float a, float b, float r, float n) {
    float count = max(floor(n + 0.5), 1.0);
    float radius = max(r, 0.0);
    float c = radius * 1.41421356 / (2.0 * (count - 1.0) + 1.41421356);
    float line = max(radius - (c + c) - abs(a - b), 0.0);
    float across = (a + b - (radius - (c + c))) * 0.707106781;
    float along = (b - a) * 0.707106781;
    float middle = 0.5 * (count - 1.0);
    float k = floor(along / max(c + c, 1e-9) + middle + 0.5);
    float y = along - (c + c) * (min(max(k, 0.0), count - 1.0) - middle);
    float column = sqrt(across * across + y * y) - c;
    return min(min(a, b) - 0.5 * line, column);
}
)"},
        // -- hits
        {"fathom_nearest", Form::One, {}, R"(
Hit fathom_nearest(Hit a, Hit b) {
    if (b.distance < a.distance) return b;
    return a;
}
)"},
        {"fathom_farthest_of", Form::One, {}, R"(
// Of hits that are asked in a row: an unpainted one shows the first one's paint.
Hit fathom_farthest_of(Hit first, Hit best, Hit next) {
    if (next.distance <= best.distance) return best;
    if (next.paint >= 0) return next;
    return Hit(next.distance, first.paint, first.point, first.extra);
}
)"},
        {"fathom_farthest", Form::One, {{"fathom_farthest_of", ""}}, R"(
Hit fathom_farthest(Hit a, Hit b) {
    return fathom_farthest_of(a, a, b);
}
)"},
        {"fathom_hit_with", Form::One, {}, R"(
Hit fathom_hit_with(Hit hit, float distance) {
    return Hit(distance, hit.paint, hit.point, hit.extra);
}
)"},
        {"fathom_fill_paint", Form::One, {}, R"(
Hit fathom_fill_paint(Hit hit, int paint, vec3 point, vec4 extra) {
    if (hit.paint >= 0) return hit;
    return Hit(hit.distance, paint, point, extra);
}
)"},
        // -- sampled data: filtered here, because samplers filter with 8 bits
        {"fathom_image", Form::One, {}, R"(
vec4 fathom_image(sampler2D image, vec2 uv) {
    ivec2 size = textureSize(image, 0);
    vec2 turn = uv - floor(uv);
    vec2 place = vec2(turn.x, 1.0 - turn.y) * vec2(size) - 0.5;
    vec2 t = fract(place);
    ivec2 a = ivec2(floor(place));
    ivec2 b = (a + 1) % size;
    a = (a + size) % size;
    vec4 low = mix(texelFetch(image, a, 0), texelFetch(image, ivec2(b.x, a.y), 0), t.x);
    vec4 high = mix(texelFetch(image, ivec2(a.x, b.y), 0), texelFetch(image, b, 0), t.x);
    return mix(low, high, t.y);
}
)"},
        {"fathom_grid", Form::One, {}, R"(
float fathom_grid(sampler3D grid, vec3 p) {
    ivec3 last = textureSize(grid, 0) - 1;
    vec3 place = clamp(p, 0.0, 1.0) * vec3(last);
    ivec3 a = min(ivec3(place), max(last - 1, 0));
    ivec3 b = min(a + 1, last);
    vec3 t = place - vec3(a);
    float x00 = mix(texelFetch(grid, a, 0).x, texelFetch(grid, ivec3(b.x, a.y, a.z), 0).x, t.x);
    float x10 = mix(texelFetch(grid, ivec3(a.x, b.y, a.z), 0).x, texelFetch(grid, ivec3(b.x, b.y, a.z), 0).x, t.x);
    float x01 = mix(texelFetch(grid, ivec3(a.x, a.y, b.z), 0).x, texelFetch(grid, ivec3(b.x, a.y, b.z), 0).x, t.x);
    float x11 = mix(texelFetch(grid, ivec3(a.x, b.y, b.z), 0).x, texelFetch(grid, b, 0).x, t.x);
    return mix(mix(x00, x10, t.y), mix(x01, x11, t.y), t.z);
}
)"},
    };
    return helpers;
}

std::string replaced(std::string text, const std::string &what, const std::string &with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
        text.replace(at, what.size(), with);
    return text;
}

// A function of floats, called for each component.
std::string lifted(const std::string &scalar_text, const std::string &name,
                   const std::string &type) {
    const std::size_t arguments = 1 + static_cast<std::size_t>(std::ranges::count(
                                          scalar_text.substr(0, scalar_text.find(')')), ','));
    const std::array<std::string, 3> letters{"a", "b", "c"};
    std::string parameters, calls;
    for (std::size_t i = 0; i < arguments; ++i)
        parameters += (i ? ", " : "") + type + " " + letters[i];
    for (char c : std::string("xyzw").substr(0, static_cast<std::size_t>(type.back() - '0'))) {
        std::string inner;
        for (std::size_t i = 0; i < arguments; ++i) inner += (i ? ", " : "") + letters[i] + "." + c;
        calls += (calls.empty() ? "" : ", ") + name + "(" + inner + ")";
    }
    return "\n" + type + " " + name + "(" + parameters + ") {\n    return " + type + "(" + calls +
           ");\n}\n";
}

class Printer {
  public:
    void need(const HelperKey &key) {
        if (!done_.insert(key).second) return;
        const auto &[name, type] = key;
        if (name == "fathom_hash") {
            need({"fathom_hash_more", ""});
            text_ += hash_helper(type);
            return;
        }
        for (const NoiseHelper &noise : noise_library()) {
            if (noise.name != name) continue;
            for (const HelperKey &other : noise.needs) need(other);
            text_ += noise.text;
            return;
        }
        for (const Helper &helper : library()) {
            if (helper.name != name || (helper.form == Form::Int) != (type == "int")) continue;
            for (const HelperKey &other : helper.needs) need(other);
            if (helper.form == Form::Lifted && type != "float") {
                need({name, "float"});
                text_ += lifted(helper.text, name, type);
            } else {
                text_ += replaced(helper.text, "$T", type);
            }
            return;
        }
        assert(!"a helper that nobody wrote");
    }
    std::string take() { return std::move(text_); }

  private:
    std::set<HelperKey> done_;
    std::string text_;
};

} // namespace

std::string helper_text(const std::set<HelperKey> &wanted) {
    Printer printer;
    for (const HelperKey &key : wanted) printer.need(key);
    return printer.take();
}

} // namespace fathom::glsl
