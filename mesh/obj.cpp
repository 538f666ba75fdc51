// A Wavefront OBJ and the library of its materials (MTL), both text: shared vertices with their
// colours, normals by corner. Equal meshes are equal bytes.
#include "mesh/write.h"

#include "base/srgb.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace fathom::mesh {
namespace {

using Text = fmt::memory_buffer;

// A name as a word of the file: one line, without blanks, and without what begins a comment.
std::string word_of(std::string_view name) {
    std::string word(name);
    for (char &c : word) {
        if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f) c = '_';
        if (c == '#') c = '.';
    }
    return word.empty() ? "scene" : word;
}

// The rest of a line may hold blanks, but no line's end and no comment.
std::string line_of(std::string_view name) {
    std::string line(name);
    for (char &c : line)
        if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '_';
    std::ranges::replace(line, '#', '.');
    return line;
}

// The triangles, those of one material together.
std::vector<std::size_t> by_material(const Surface &mesh) {
    std::vector<std::size_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (mesh.material_of.empty()) return order;
    std::ranges::stable_sort(order, {}, [&](std::size_t t) { return mesh.material_of[t]; });
    return order;
}

// What was written before an object.
struct Before {
    std::size_t vertices = 1, normals = 1; // counted from 1
};

void put_object(Text &text, const Surface &mesh, const MaterialTable &table,
                const std::vector<std::uint32_t> &places, bool with_materials, Before &before) {
    const auto to = std::back_inserter(text);
    fmt::format_to(to, "o {}\n", word_of(mesh.name));
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        const Point &p = mesh.vertices[k];
        fmt::format_to(to, "v {} {} {}", double(p[0]), double(p[1]), double(p[2]));
        if (!mesh.colors.empty()) // as most readers take them: after the place, sRGB
            for (const float c : mesh.colors[k]) fmt::format_to(to, " {:.4g}", srgb_of_linear(c));
        fmt::format_to(to, "\n");
    }
    const Corners corners = corners_of(mesh);
    for (const Point &n : corners.normals)
        fmt::format_to(to, "vn {:.4g} {:.4g} {:.4g}\n", n[0], n[1], n[2]);
    std::optional<std::uint32_t> used;
    for (const std::size_t k : by_material(mesh)) {
        if (with_materials && !mesh.material_of.empty() && used != mesh.material_of[k]) {
            used = mesh.material_of[k];
            fmt::format_to(to, "usemtl {}\n", word_of(table.materials[places[*used]].name));
        }
        const Triangle &t = mesh.triangles[k], &n = corners.indices[k];
        fmt::format_to(to, "f");
        for (std::size_t c = 0; c < 3; ++c)
            fmt::format_to(to, " {}//{}", before.vertices + t[c], before.normals + n[c]);
        fmt::format_to(to, "\n");
    }
    before.vertices += mesh.vertices.size();
    before.normals += corners.normals.size();
}

void put_color(Text &text, const char *what, const Point &color) {
    fmt::format_to(std::back_inserter(text), "{}", what);
    for (const float c : color)
        fmt::format_to(std::back_inserter(text), " {:.4g}", srgb_of_linear(std::min(c, 1.0f)));
    fmt::format_to(std::back_inserter(text), "\n");
}

} // namespace

std::string obj_of(std::span<const Surface> objects, const FileOptions &options) {
    Text text;
    fmt::format_to(std::back_inserter(text), "# by Fathom\n");
    const bool with_materials = !options.library.empty();
    if (with_materials)
        fmt::format_to(std::back_inserter(text), "mtllib {}\n", line_of(options.library));
    const MaterialTable table = table_of(objects);
    Before before;
    for (std::size_t k = 0; k < objects.size(); ++k)
        put_object(text, objects[k], table, table.places[k], with_materials, before);
    return fmt::to_string(text);
}

std::string material_library_of(std::span<const Surface> objects) {
    Text text;
    const auto to = std::back_inserter(text);
    fmt::format_to(to, "# by Fathom\n");
    for (const Material &material : table_of(objects).materials) {
        fmt::format_to(to, "\nnewmtl {}\n", word_of(material.name));
        put_color(text, "Kd", material.diffuse);
        put_color(text, "Ks", material.specular);
        put_color(text, "Ke", material.emission);
        constexpr float most = 1000; // of the format
        fmt::format_to(to, "Ns {:.4g}\nillum 2\nPr {:.4g}\nPm 0\n",
                       std::min(material.exponent, most), roughness_of(material.exponent));
    }
    return fmt::to_string(text);
}

} // namespace fathom::mesh
