#include "mesh/write.h"

#include "base/picture.h"
#include "base/srgb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

namespace fathom::mesh {
namespace {

// A corner takes the field's gradient at its vertex where it is within 30 degrees of the triangle's
// own normal, and that else: at a crease each side has its own.
constexpr double crease_cosine = 0.8660254;

template <class Number> void put(std::string &bytes, Number number) {
    static_assert(std::endian::native == std::endian::little);
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), &number, sizeof(Number));
    bytes.append(raw.data(), raw.size());
}
void put(std::string &bytes, const Point &p) {
    for (const float x : p) put(bytes, x);
}

using Triangle = std::array<std::uint32_t, 3>;

Point face_normal(const Surface &mesh, const Triangle &t) {
    std::array<double, 3> u{}, v{};
    for (std::size_t i = 0; i < 3; ++i) {
        // Rounded as readers' own differences are, so that they find the same normal.
        u[i] = mesh.vertices[t[1]][i] - mesh.vertices[t[0]][i];
        v[i] = mesh.vertices[t[2]][i] - mesh.vertices[t[0]][i];
    }
    const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                  u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    Point unit{0, 0, 1};
    for (std::size_t i = 0; i < 3 && length > 0; ++i) unit[i] = static_cast<float>(n[i] / length);
    return unit;
}

// The normals of a triangle's corners.
std::array<Point, 3> corner_normals(const Surface &mesh, const Triangle &t) {
    const Point face = face_normal(mesh, t);
    std::array<Point, 3> normals;
    for (std::size_t k = 0; k < 3; ++k) {
        const Point &own = mesh.normals[t[k]];
        const double cosine =
            double(own[0]) * face[0] + double(own[1]) * face[1] + double(own[2]) * face[2];
        normals[k] = cosine > crease_cosine ? own : face;
    }
    return normals;
}

std::string stl_of(const Surface &mesh) {
    constexpr std::size_t head = 80, triangle = 50;
    std::string bytes;
    bytes.reserve(head + 4 + triangle * mesh.triangles.size());
    bytes = "Binary STL by Fathom"; // never begins with `solid`, as texts do
    bytes.resize(head, ' ');
    put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle &t : mesh.triangles) {
        put(bytes, face_normal(mesh, t));
        for (const std::uint32_t v : t) put(bytes, mesh.vertices[v]);
        put(bytes, std::uint16_t{0});
    }
    return bytes;
}

// Normals and where each corner finds its own.
struct Corners {
    std::vector<Point> normals;
    std::vector<Triangle> indices;
};
Corners corners_of(const Surface &mesh) {
    Corners corners;
    corners.normals.assign(mesh.normals.begin(), mesh.normals.end());
    for (const Triangle &t : mesh.triangles) {
        const std::array<Point, 3> normals = corner_normals(mesh, t);
        Triangle index = t;
        std::uint32_t own = 0; // the triangle's normal, once it is there
        for (std::size_t k = 0; k < 3; ++k) {
            if (normals[k] == mesh.normals[t[k]]) continue;
            if (own == 0) {
                own = static_cast<std::uint32_t>(corners.normals.size());
                corners.normals.push_back(normals[k]);
            }
            index[k] = own;
        }
        corners.indices.push_back(index);
    }
    return corners;
}

// A name as a word of an OBJ file: one line, without blanks.
std::string word_of(std::string_view name) {
    std::string word(name);
    for (char &c : word)
        if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
    return word.empty() ? "scene" : word;
}

std::string obj_of(const Surface &mesh, std::string_view name) {
    fmt::memory_buffer text;
    const auto to = std::back_inserter(text);
    fmt::format_to(to, "# by Fathom\no {}\n", word_of(name));
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        const Point &p = mesh.vertices[k];
        fmt::format_to(to, "v {} {} {}", p[0], p[1], p[2]);
        if (!mesh.colors.empty()) // as most readers take them: after the place, sRGB
            for (const float c : mesh.colors[k]) fmt::format_to(to, " {:.4g}", srgb_of_linear(c));
        fmt::format_to(to, "\n");
    }
    const Corners corners = corners_of(mesh);
    for (const Point &n : corners.normals)
        fmt::format_to(to, "vn {:.4g} {:.4g} {:.4g}\n", n[0], n[1], n[2]);
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        const Triangle &t = mesh.triangles[k], &n = corners.indices[k];
        fmt::format_to(to, "f {}//{} {}//{} {}//{}\n", t[0] + 1, n[0] + 1, t[1] + 1, n[1] + 1,
                       t[2] + 1, n[2] + 1);
    }
    return fmt::to_string(text);
}

std::string ply_of(const Surface &mesh) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment by Fathom\n"
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}"
        "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.vertices.size(),
        mesh.colors.empty() ? ""
                            : "property uchar red\nproperty uchar green\nproperty uchar blue\n",
        mesh.triangles.size());
    bytes.reserve(bytes.size() + 15 * mesh.vertices.size() + 13 * mesh.triangles.size());
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        put(bytes, mesh.vertices[k]);
        if (!mesh.colors.empty())
            for (const float c : mesh.colors[k]) put(bytes, srgb_byte(c));
    }
    for (const Triangle &t : mesh.triangles) {
        put(bytes, std::uint8_t{3});
        for (const std::uint32_t v : t) put(bytes, v);
    }
    return bytes;
}

// A mesh whose vertices have one normal each: those with several stand there several times.
struct Split {
    std::vector<Point> vertices, normals, colors;
    std::vector<Triangle> triangles;
};
Split split(const Surface &mesh) {
    const Corners corners = corners_of(mesh);
    Split made;
    made.colors.assign(mesh.colors.begin(), mesh.colors.end());
    made.vertices.assign(mesh.vertices.begin(), mesh.vertices.end());
    made.normals.assign(mesh.normals.begin(), mesh.normals.end());
    std::map<std::pair<std::uint32_t, Point>, std::uint32_t> copies;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        Triangle t = mesh.triangles[k];
        for (std::size_t c = 0; c < 3; ++c) {
            const Point &normal = corners.normals[corners.indices[k][c]];
            if (normal == mesh.normals[t[c]]) continue;
            const auto [at, fresh] = copies.try_emplace(
                {t[c], normal}, static_cast<std::uint32_t>(made.vertices.size()));
            if (fresh) {
                made.vertices.push_back(mesh.vertices[t[c]]);
                made.normals.push_back(normal);
                if (!mesh.colors.empty()) made.colors.push_back(mesh.colors[t[c]]);
            }
            t[c] = at->second;
        }
        made.triangles.push_back(t);
    }
    return made;
}

using Json = nlohmann::ordered_json;

// The parts of a GLB's buffer.
struct Buffer {
    std::string bytes;
    Json views = Json::array(), accessors = Json::array();
};
// What was put into the buffer since `begin`, a multiple of 4, is numbers of glTF's kind `component`,
// `count` times `type`. Its accessor.
Json &close_view(Buffer &to, std::size_t begin, int target, int component, std::size_t count,
                 const char *type) {
    to.accessors.push_back({{"bufferView", to.views.size()},
                            {"componentType", component},
                            {"count", count},
                            {"type", type}});
    to.views.push_back({{"buffer", 0},
                        {"byteOffset", begin},
                        {"byteLength", to.bytes.size() - begin},
                        {"target", target}});
    return to.accessors.back();
}

// Metres of a unit.
double metres_of(Unit unit) {
    switch (unit) {
    case Unit::Micron: return 1e-6;
    case Unit::Millimetre: return 1e-3;
    case Unit::Centimetre: return 1e-2;
    case Unit::Unsaid:
    case Unit::Metre: return 1;
    case Unit::Inch: return 0.0254;
    case Unit::Foot: return 0.3048;
    }
    return 1;
}

void put_vertices(Buffer &to, const Split &parts, Json &attributes) {
    constexpr int array_buffer = 34962, short_type = 5123, float_type = 5126;
    const std::size_t count = parts.vertices.size();
    Point lo{}, hi{};
    lo.fill(std::numeric_limits<float>::infinity());
    hi.fill(-std::numeric_limits<float>::infinity());
    for (const Point &p : parts.vertices) {
        put(to.bytes, p);
        for (std::size_t i = 0; i < 3; ++i)
            lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
    }
    const auto numbers = [](const Point &p) {
        return Json{double(p[0]), double(p[1]), double(p[2])};
    };
    Json &places = close_view(to, 0, array_buffer, float_type, count, "VEC3");
    places["min"] = numbers(lo);
    places["max"] = numbers(hi);
    attributes["POSITION"] = 0;
    std::size_t begin = to.bytes.size();
    for (const Point &n : parts.normals) { // of length 1 to a float's precision
        const double length =
            std::sqrt(double(n[0]) * n[0] + double(n[1]) * n[1] + double(n[2]) * n[2]);
        for (const float x : n) put(to.bytes, static_cast<float>(x / length));
    }
    close_view(to, begin, array_buffer, float_type, count, "VEC3");
    attributes["NORMAL"] = 1;
    if (parts.colors.empty()) return;
    begin = to.bytes.size();
    for (const Point &color : parts.colors) { // linear, and opaque
        for (const float c : color) put(to.bytes, static_cast<std::uint16_t>(c * 65535 + 0.5f));
        put(to.bytes, std::uint16_t{65535});
    }
    close_view(to, begin, array_buffer, short_type, count, "VEC4")["normalized"] = true;
    attributes["COLOR_0"] = 2;
}

std::string glb_of(const Surface &mesh, std::string_view name, Unit unit) {
    constexpr int element_buffer = 34963, unsigned_type = 5125;
    const std::optional<Point> color = only_color(mesh);
    Surface shown = mesh;
    if (color) shown.colors = {}; // the material says it
    const Split parts = split(shown);
    Buffer data;
    Json attributes;
    put_vertices(data, parts, attributes);
    const std::size_t begin = data.bytes.size(), indices = data.accessors.size();
    for (const Triangle &t : parts.triangles)
        for (const std::uint32_t v : t) put(data.bytes, v);
    close_view(data, begin, element_buffer, unsigned_type, 3 * parts.triangles.size(), "SCALAR");
    constexpr float grey = 0.8f;
    const Point base = color                 ? *color
                       : mesh.colors.empty() ? Point{grey, grey, grey}
                                             : Point{1, 1, 1};
    Json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "Fathom"}};
    json["scene"] = 0;
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    Json node = {{"mesh", 0}, {"name", name}};
    if (const double size = metres_of(unit); size != 1) node["scale"] = {size, size, size};
    json["nodes"] = Json::array({node});
    json["meshes"] = Json::array(
        {{{"name", name},
          {"primitives",
           Json::array({{{"attributes", attributes}, {"indices", indices}, {"material", 0}}})}}});
    json["materials"] = Json::array({{{"pbrMetallicRoughness",
                                       {{"baseColorFactor", {base[0], base[1], base[2], 1.0}},
                                        {"metallicFactor", 0.0},
                                        {"roughnessFactor", 0.6}}}}});
    json["buffers"] = Json::array({{{"byteLength", data.bytes.size()}}});
    json["bufferViews"] = data.views;
    json["accessors"] = data.accessors;
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() - 65536;
    if (data.bytes.size() > most) return "";
    std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    constexpr std::uint32_t head = 12, chunk = 8;
    std::string bytes = "glTF";
    put(bytes, std::uint32_t{2});
    put(bytes, static_cast<std::uint32_t>(head + chunk + text.size() + chunk + data.bytes.size()));
    put(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    put(bytes, static_cast<std::uint32_t>(data.bytes.size())); // a multiple of 4
    bytes.append("BIN\0", 4);
    return bytes + data.bytes;
}

} // namespace

std::optional<Point> only_color(const Surface &mesh) {
    if (mesh.colors.empty()) return std::nullopt;
    for (const Point &color : mesh.colors)
        if (color != mesh.colors[0]) return std::nullopt;
    return mesh.colors[0];
}

std::string file_of(const Surface &mesh, Format format, std::string_view name, Unit unit) {
    switch (format) {
    case Format::Stl: return stl_of(mesh);
    case Format::Obj: return obj_of(mesh, name);
    case Format::Ply: return ply_of(mesh);
    case Format::Glb: return glb_of(mesh, name, unit);
    case Format::ThreeMf: return three_mf_of(mesh, name, unit);
    }
    return "";
}

} // namespace fathom::mesh
