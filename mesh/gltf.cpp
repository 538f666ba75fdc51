// A GLB: glTF 2.0 in one file (Khronos, glTF 2.0 Specification), with the extensions
// KHR_materials_specular and KHR_materials_emissive_strength where a material needs them. Equal meshes
// are equal bytes.
#include "mesh/bytes.h"
#include "mesh/write.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

namespace fathom::mesh {
namespace {

using Json = nlohmann::ordered_json;

// A mesh whose vertices have one normal and one colour each: those with several stand there several
// times.
struct Split {
    std::vector<Point> vertices, normals, colors;
    std::vector<Triangle> triangles;
};

// Of those triangles. `places` is memory: one a vertex, all of them unset.
constexpr std::uint32_t unset = std::numeric_limits<std::uint32_t>::max();
Split split(const Surface &mesh, const Corners &corners, std::span<const std::size_t> triangles,
            bool colored, std::vector<std::uint32_t> &places) {
    Split made;
    std::vector<std::uint32_t> touched;
    std::map<std::tuple<std::uint32_t, std::uint32_t, Point>, std::uint32_t> others;
    for (const std::size_t k : triangles) {
        Triangle t = mesh.triangles[k];
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = t[c], n = corners.indices[k][c];
            const Point color = colored ? corner_color(mesh, k, c) : Point{};
            const auto add = [&] {
                made.vertices.push_back(mesh.vertices[v]);
                made.normals.push_back(corners.normals[n]);
                if (colored) made.colors.push_back(color);
                return static_cast<std::uint32_t>(made.vertices.size() - 1);
            };
            if (n == v && (!colored || mesh.colors.empty() || color == mesh.colors[v])) {
                if (places[v] == unset) places[v] = add(), touched.push_back(v);
                t[c] = places[v];
                continue;
            }
            const auto [at, fresh] = others.try_emplace({v, n, color}, 0);
            if (fresh) at->second = add();
            t[c] = at->second;
        }
        made.triangles.push_back(t);
    }
    for (const std::uint32_t v : touched) places[v] = unset;
    return made;
}

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

Json put_vertices(Buffer &to, const Split &parts) {
    constexpr int array_buffer = 34962, short_type = 5123, float_type = 5126;
    const std::size_t count = parts.vertices.size();
    Json attributes;
    Point lo{}, hi{};
    lo.fill(std::numeric_limits<float>::infinity());
    hi.fill(-std::numeric_limits<float>::infinity());
    std::size_t begin = to.bytes.size();
    for (const Point &p : parts.vertices) {
        put(to.bytes, p);
        for (std::size_t i = 0; i < 3; ++i)
            lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
    }
    const auto numbers = [](const Point &p) {
        return Json{double(p[0]), double(p[1]), double(p[2])};
    };
    attributes["POSITION"] = to.accessors.size();
    Json &places = close_view(to, begin, array_buffer, float_type, count, "VEC3");
    places["min"] = numbers(lo);
    places["max"] = numbers(hi);
    begin = to.bytes.size();
    for (const Point &n : parts.normals) { // of length 1 to a float's precision
        const double length =
            std::sqrt(double(n[0]) * n[0] + double(n[1]) * n[1] + double(n[2]) * n[2]);
        for (const float x : n) put(to.bytes, static_cast<float>(x / length));
    }
    attributes["NORMAL"] = to.accessors.size();
    close_view(to, begin, array_buffer, float_type, count, "VEC3");
    if (parts.colors.empty()) return attributes;
    begin = to.bytes.size();
    for (const Point &color : parts.colors) { // linear, and opaque
        for (const float c : color) put(to.bytes, static_cast<std::uint16_t>(c * 65535 + 0.5f));
        put(to.bytes, std::uint16_t{65535});
    }
    attributes["COLOR_0"] = to.accessors.size();
    close_view(to, begin, array_buffer, short_type, count, "VEC4")["normalized"] = true;
    return attributes;
}

// A primitive of some triangles.
Json put_primitive(Buffer &to, const Split &parts, std::size_t material) {
    constexpr int element_buffer = 34963, unsigned_type = 5125;
    const Json attributes = put_vertices(to, parts);
    const std::size_t begin = to.bytes.size(), indices = to.accessors.size();
    for (const Triangle &t : parts.triangles)
        for (const std::uint32_t v : t) put(to.bytes, v);
    close_view(to, begin, element_buffer, unsigned_type, 3 * parts.triangles.size(), "SCALAR");
    return {{"attributes", attributes}, {"indices", indices}, {"material", material}};
}

struct Document {
    Buffer data;
    Json meshes = Json::array(), materials = Json::array();
    bool specular = false, strength = false; // extensions that are used
};

Json numbers_of(const Point &color) { return {color[0], color[1], color[2]}; }

void put_material(Document &document, const Material &material) {
    Json made;
    made["name"] = material.name;
    const Point white{1, 1, 1}, base = material.colored ? white : material.diffuse;
    made["pbrMetallicRoughness"] = {{"baseColorFactor", {base[0], base[1], base[2], 1.0}},
                                    {"metallicFactor", 0.0},
                                    {"roughnessFactor", roughness_of(material.exponent)}};
    if (material.specular != white) {
        const float most = std::ranges::max(material.specular);
        Json &specular = made["extensions"]["KHR_materials_specular"];
        specular["specularFactor"] = most;
        if (most > 0) {
            Point color = material.specular;
            for (float &c : color) c /= most;
            if (color != white) specular["specularColorFactor"] = numbers_of(color);
        }
        document.specular = true;
    }
    if (const float most = std::ranges::max(material.emission); most > 0) {
        Point color = material.emission;
        if (most > 1) {
            for (float &c : color) c /= most;
            made["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", most}};
            document.strength = true;
        }
        made["emissiveFactor"] = numbers_of(color);
    }
    document.materials.push_back(made);
}

// A mesh without materials: its colours alone.
std::size_t plain_material(Document &document, const Surface &mesh) {
    const std::optional<Point> color = only_color(mesh);
    constexpr float grey = 0.8f;
    const Point base = color                 ? *color
                       : mesh.colors.empty() ? Point{grey, grey, grey}
                                             : Point{1, 1, 1};
    document.materials.push_back({{"pbrMetallicRoughness",
                                   {{"baseColorFactor", {base[0], base[1], base[2], 1.0}},
                                    {"metallicFactor", 0.0},
                                    {"roughnessFactor", 0.6}}}});
    return document.materials.size() - 1;
}

void put_mesh(Document &document, const Surface &mesh, const std::vector<std::uint32_t> &places) {
    const Corners corners = corners_of(mesh);
    std::vector<std::uint32_t> memory(mesh.vertices.size(), unset);
    Json primitives = Json::array();
    // The triangles of each material.
    std::vector<std::vector<std::size_t>> groups(std::max<std::size_t>(mesh.materials.size(), 1));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        groups[mesh.materials.empty() ? 0 : mesh.material_of[t]].push_back(t);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        if (groups[g].empty()) continue;
        const bool plain = mesh.materials.empty();
        const bool colored =
            plain ? !mesh.colors.empty() && !only_color(mesh) : mesh.materials[g].colored;
        const std::size_t material = plain ? plain_material(document, mesh) : places[g];
        primitives.push_back(put_primitive(
            document.data, split(mesh, corners, groups[g], colored, memory), material));
    }
    document.meshes.push_back({{"name", mesh.name}, {"primitives", primitives}});
}

// Nodes: the object alone, or one for all, below which each has its own.
Json nodes_of(std::span<const Surface> objects, const FileOptions &options) {
    Json nodes = Json::array();
    if (objects.size() == 1) {
        nodes.push_back({{"mesh", 0}, {"name", objects[0].name}});
    } else {
        Json children = Json::array();
        for (std::size_t k = 0; k < objects.size(); ++k) children.push_back(k + 1);
        nodes.push_back({{"name", options.name}, {"children", children}});
        for (std::size_t k = 0; k < objects.size(); ++k)
            nodes.push_back({{"mesh", k}, {"name", objects[k].name}});
    }
    if (const double size = metres_of(options.unit); size != 1)
        nodes[0]["scale"] = {size, size, size};
    return nodes;
}

} // namespace

float roughness_of(float exponent) { return std::pow(2 * std::max(exponent, 0.0f) + 1, -0.25f); }

std::string glb_of(std::span<const Surface> objects, const FileOptions &options) {
    Document document;
    const MaterialTable table = table_of(objects);
    for (const Material &material : table.materials) put_material(document, material);
    for (std::size_t k = 0; k < objects.size(); ++k)
        put_mesh(document, objects[k], table.places[k]);
    const Buffer &data = document.data;
    Json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "Fathom"}};
    if (document.specular) json["extensionsUsed"].push_back("KHR_materials_specular");
    if (document.strength) json["extensionsUsed"].push_back("KHR_materials_emissive_strength");
    json["scene"] = 0;
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    json["nodes"] = nodes_of(objects, options);
    json["meshes"] = document.meshes;
    json["materials"] = document.materials;
    json["buffers"] = Json::array({{{"byteLength", data.bytes.size()}}});
    json["bufferViews"] = data.views;
    json["accessors"] = data.accessors;
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() - 65536;
    std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    if (data.bytes.size() + text.size() > most) return "";
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

} // namespace fathom::mesh
