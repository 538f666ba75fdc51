#include "mesh/write.h"

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
    for (const Point &p : mesh.vertices) fmt::format_to(to, "v {} {} {}\n", p[0], p[1], p[2]);
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
    std::string bytes =
        fmt::format("ply\nformat binary_little_endian 1.0\ncomment by Fathom\n"
                    "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                    mesh.vertices.size(), mesh.triangles.size());
    bytes.reserve(bytes.size() + 12 * mesh.vertices.size() + 13 * mesh.triangles.size());
    for (const Point &p : mesh.vertices) put(bytes, p);
    for (const Triangle &t : mesh.triangles) {
        put(bytes, std::uint8_t{3});
        for (const std::uint32_t v : t) put(bytes, v);
    }
    return bytes;
}

// A mesh whose vertices have one normal each: those with several stand there several times.
Mesh split(const Surface &mesh) {
    const Corners corners = corners_of(mesh);
    Mesh made;
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
            }
            t[c] = at->second;
        }
        made.triangles.push_back(t);
    }
    return made;
}

std::string glb_of(const Surface &mesh, std::string_view name) {
    using Json = nlohmann::ordered_json;
    constexpr int array_buffer = 34962, element_buffer = 34963, float_type = 5126,
                  unsigned_type = 5125;
    const Mesh parts = split(mesh);
    std::string data;
    data.reserve(24 * parts.vertices.size() + 12 * parts.triangles.size());
    Point lo{}, hi{};
    lo.fill(std::numeric_limits<float>::infinity());
    hi.fill(-std::numeric_limits<float>::infinity());
    for (const Point &p : parts.vertices) {
        put(data, p);
        for (std::size_t i = 0; i < 3; ++i)
            lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
    }
    const std::size_t normals = data.size();
    for (const Point &n : parts.normals) { // of length 1 to a float's precision
        const double length =
            std::sqrt(double(n[0]) * n[0] + double(n[1]) * n[1] + double(n[2]) * n[2]);
        for (const float x : n) put(data, static_cast<float>(x / length));
    }
    const std::size_t indices = data.size();
    for (const Triangle &t : parts.triangles)
        for (const std::uint32_t v : t) put(data, v);
    Json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "Fathom"}};
    json["scene"] = 0;
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    json["nodes"] = Json::array({{{"mesh", 0}, {"name", name}}});
    json["meshes"] =
        Json::array({{{"name", name},
                      {"primitives", Json::array({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}},
                                                   {"indices", 2},
                                                   {"material", 0}}})}}});
    json["materials"] = Json::array({{{"pbrMetallicRoughness",
                                       {{"baseColorFactor", {0.8, 0.8, 0.8, 1.0}},
                                        {"metallicFactor", 0.0},
                                        {"roughnessFactor", 0.6}}}}});
    json["buffers"] = Json::array({{{"byteLength", data.size()}}});
    json["bufferViews"] =
        Json::array({{{"buffer", 0}, {"byteLength", normals}, {"target", array_buffer}},
                     {{"buffer", 0},
                      {"byteOffset", normals},
                      {"byteLength", indices - normals},
                      {"target", array_buffer}},
                     {{"buffer", 0},
                      {"byteOffset", indices},
                      {"byteLength", data.size() - indices},
                      {"target", element_buffer}}});
    const auto number = [](float x) { return static_cast<double>(x); };
    json["accessors"] = Json::array({{{"bufferView", 0},
                                      {"componentType", float_type},
                                      {"count", parts.vertices.size()},
                                      {"type", "VEC3"},
                                      {"min", {number(lo[0]), number(lo[1]), number(lo[2])}},
                                      {"max", {number(hi[0]), number(hi[1]), number(hi[2])}}},
                                     {{"bufferView", 1},
                                      {"componentType", float_type},
                                      {"count", parts.normals.size()},
                                      {"type", "VEC3"}},
                                     {{"bufferView", 2},
                                      {"componentType", unsigned_type},
                                      {"count", 3 * parts.triangles.size()},
                                      {"type", "SCALAR"}}});
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() - 65536;
    if (data.size() > most) return "";
    std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    constexpr std::uint32_t head = 12, chunk = 8;
    std::string bytes = "glTF";
    put(bytes, std::uint32_t{2});
    put(bytes, static_cast<std::uint32_t>(head + chunk + text.size() + chunk + data.size()));
    put(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    put(bytes, static_cast<std::uint32_t>(data.size())); // a multiple of 4
    bytes.append("BIN\0", 4);
    return bytes + data;
}

} // namespace

std::string file_of(const Surface &mesh, Format format, std::string_view name) {
    switch (format) {
    case Format::Stl: return stl_of(mesh);
    case Format::Obj: return obj_of(mesh, name);
    case Format::Ply: return ply_of(mesh);
    case Format::Glb: return glb_of(mesh, name);
    }
    return "";
}

} // namespace fathom::mesh
