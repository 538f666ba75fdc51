// The bytes of mesh files, read back by what their formats say.
#include "mesh/write.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <zip.h>

using namespace fathom;
using namespace fathom::mesh;

namespace {

// A tetrahedron with a right angle, its normals away from its middle.
Mesh corner_of_a_cube() {
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1f}};
    mesh.normals = {{-0.6f, -0.64f, -0.48f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return mesh;
}

std::string bytes_of(const Mesh &mesh, Format format, std::string_view name = "a") {
    const Surface surface{mesh.vertices, mesh.normals, mesh.triangles, {}, {}, {}, {}, name};
    return file_of({&surface, 1}, format);
}

// Of that tetrahedron: a colour by vertex, or one for all.
const std::vector<Point> colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2158605f, 0, 0}};
std::string bytes_of(const Mesh &mesh, Format format, const std::vector<Point> &colored,
                     Unit unit = Unit::Unsaid) {
    const Surface surface{mesh.vertices, mesh.normals, mesh.triangles, colored, {}, {}, {}, "a"};
    return file_of({&surface, 1}, format, {unit, "scene", ""});
}

// The document of a GLB.
nlohmann::json document_of(const std::string &glb) {
    std::uint32_t size = 0;
    REQUIRE(glb.size() > 20);
    std::memcpy(&size, glb.data() + 12, 4);
    return nlohmann::json::parse(glb.substr(20, size));
}

// A file of a ZIP archive.
std::string unzipped(const std::string &bytes, const char *name) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t *source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
    REQUIRE(source);
    zip_t *archive = zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error);
    REQUIRE(archive);
    zip_stat_t stat;
    REQUIRE(zip_stat(archive, name, 0, &stat) == 0);
    std::string text(stat.size, ' ');
    zip_file_t *file = zip_fopen(archive, name, 0);
    REQUIRE(file);
    CHECK(zip_fread(file, text.data(), text.size()) == static_cast<zip_int64_t>(text.size()));
    zip_fclose(file);
    zip_discard(archive);
    return text;
}

std::size_t count_of(const std::string &text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
}

template <class Number> Number read(const std::string &bytes, std::size_t at) {
    Number number;
    REQUIRE(at + sizeof number <= bytes.size());
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

} // namespace

TEST_CASE("a binary STL: a head that is no text's, a count, 50 bytes a triangle") {
    const Mesh mesh = corner_of_a_cube();
    const std::string bytes = bytes_of(mesh, Format::Stl);
    REQUIRE(bytes.size() == 84 + 4 * 50);
    CHECK_FALSE(bytes.starts_with("solid"));
    CHECK(read<std::uint32_t>(bytes, 80) == 4);
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 3; ++i)
                CHECK(read<float>(bytes, 84 + 50 * k + 12 + 12 * c + 4 * i) ==
                      mesh.vertices[mesh.triangles[k][c]][i]);
    // The first one looks down, the second to -y.
    CHECK((read<float>(bytes, 84) == 0 && read<float>(bytes, 92) == -1));
    CHECK((read<float>(bytes, 134) == 0 && read<float>(bytes, 138) == -1));
}

TEST_CASE("an OBJ counts from 1, keeps every digit, and its name is one word") {
    const Mesh mesh = corner_of_a_cube();
    std::istringstream lines(bytes_of(mesh, Format::Obj, "two words\nv 9 9 9"));
    // Read in double precision they are the very floats, else triangles in one plane may cross.
    std::vector<std::array<double, 3>> points, known;
    for (const Point &p : mesh.vertices) known.push_back({p[0], p[1], p[2]});
    std::size_t normals = 0, faces = 0, names = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("o ")) {
            ++names;
            CHECK(line == "o two_words_v_9_9_9");
        }
        if (line.starts_with("vn ")) ++normals;
        if (line.starts_with("v ")) {
            std::array<double, 3> p{};
            std::istringstream(line.substr(2)) >> p[0] >> p[1] >> p[2];
            points.push_back(p);
        }
        if (line.starts_with("f ")) {
            std::array<std::size_t, 6> index{};
            REQUIRE(std::sscanf(line.c_str(), "f %zu//%zu %zu//%zu %zu//%zu", &index[0], &index[1],
                                &index[2], &index[3], &index[4], &index[5]) == 6);
            for (std::size_t c = 0; c < 3; ++c) {
                CHECK(index[2 * c] == mesh.triangles[faces][c] + 1);
                CHECK((index[2 * c + 1] >= 1 && index[2 * c + 1] <= normals));
            }
            ++faces;
        }
    }
    CHECK(points == known);
    CHECK((faces == 4 && names == 1 && normals > 4)); // creases have normals of their own
}

TEST_CASE("a PLY: what its head says, little-endian") {
    const Mesh mesh = corner_of_a_cube();
    const std::string bytes = bytes_of(mesh, Format::Ply), end = "end_header\n";
    CHECK(bytes.starts_with("ply\nformat binary_little_endian 1.0\n"));
    CHECK(bytes.find("element vertex 4\n") != bytes.npos);
    CHECK(bytes.find("element face 4\n") != bytes.npos);
    const std::size_t data = bytes.find(end) + end.size();
    REQUIRE(bytes.size() == data + 4 * 12 + 4 * 13);
    CHECK(read<float>(bytes, data + 3 * 12 + 8) == 0.1f);
    CHECK(read<std::uint8_t>(bytes, data + 48) == 3);
    CHECK(read<std::uint32_t>(bytes, data + 48 + 5) == 2);
}

TEST_CASE("a GLB: chunks, views and accessors fit their data") {
    const Mesh mesh = corner_of_a_cube();
    const std::string bytes = bytes_of(mesh, Format::Glb, "a \"name\"\xff");
    CHECK(bytes.starts_with("glTF"));
    CHECK(read<std::uint32_t>(bytes, 4) == 2);
    CHECK(read<std::uint32_t>(bytes, 8) == bytes.size());
    const std::size_t length = read<std::uint32_t>(bytes, 12);
    CHECK((length % 4 == 0 && bytes.substr(16, 4) == "JSON"));
    const auto json = nlohmann::json::parse(bytes.substr(20, length));
    const std::size_t data = 20 + length + 8;
    CHECK(read<std::uint32_t>(bytes, 20 + length) == bytes.size() - data);
    CHECK(json["buffers"][0]["byteLength"] == bytes.size() - data);
    std::size_t end = 0;
    for (const auto &view : json["bufferViews"]) {
        CHECK(view.value("byteOffset", 0u) == end);
        end += view["byteLength"].get<std::size_t>();
    }
    CHECK(end == bytes.size() - data);
    const std::size_t vertices = json["accessors"][0]["count"],
                      corners = json["accessors"][2]["count"];
    CHECK((corners == 12 && vertices > 4)); // creases are split
    CHECK(json["accessors"][1]["count"] == vertices);
    CHECK(json["accessors"][0]["max"][2].get<float>() == 0.1f);
    for (std::size_t k = 0; k < vertices; ++k) {
        double squares = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const float x = read<float>(bytes, data + 12 * (vertices + k) + 4 * i);
            squares += double(x) * x;
        }
        CHECK(squares == Approx(1));
    }
    for (std::size_t k = 0; k < corners; ++k)
        CHECK(read<std::uint32_t>(bytes, data + 24 * vertices + 4 * k) < vertices);
}

TEST_CASE("colours are bytes in a PLY, sRGB numbers in an OBJ, and none where there are none") {
    const Mesh mesh = corner_of_a_cube();
    const std::string plain = bytes_of(mesh, Format::Ply),
                      ply = bytes_of(mesh, Format::Ply, colors);
    CHECK(plain.find("red") == plain.npos);
    const std::size_t body = ply.find("end_header\n") + 11;
    CHECK(ply.size() - body == 4 * 15 + 4 * 13);
    CHECK(ply.substr(body + 12, 3) == std::string("\xff\0\0", 3));
    CHECK(static_cast<unsigned char>(ply[body + 3 * 15 + 12]) == 128); // half of 255, encoded
    CHECK(bytes_of(mesh, Format::Obj, colors).find("v 0 0 0.10000000149011612 0.502 0 0\n") !=
          std::string::npos);
    CHECK(bytes_of(mesh, Format::Stl, colors) == bytes_of(mesh, Format::Stl));
}

TEST_CASE("a GLB has a colour by vertex, linear, or one in its material; its node has the unit") {
    const Mesh mesh = corner_of_a_cube();
    const nlohmann::json many = document_of(bytes_of(mesh, Format::Glb, colors));
    const nlohmann::json &attributes = many["meshes"][0]["primitives"][0]["attributes"];
    REQUIRE(attributes.contains("COLOR_0"));
    const nlohmann::json &accessor = many["accessors"][attributes["COLOR_0"].get<std::size_t>()];
    CHECK(accessor["componentType"] == 5123);
    CHECK(accessor["normalized"] == true);
    CHECK(accessor["count"] == many["accessors"][0]["count"]);
    CHECK_FALSE(many["nodes"][0].contains("scale"));
    const nlohmann::json one =
        document_of(bytes_of(mesh, Format::Glb, {4, Point{0.5f, 0.25f, 0}}, Unit::Millimetre));
    CHECK_FALSE(one["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0"));
    const nlohmann::json wanted = {0.5, 0.25, 0.0, 1.0};
    CHECK(one["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] == wanted);
    CHECK(one["nodes"][0]["scale"] == nlohmann::json({0.001, 0.001, 0.001}));
}

TEST_CASE("a 3MF is an archive of a model with z up, its unit, and colours by corner") {
    const Mesh mesh = corner_of_a_cube();
    const std::string bytes = bytes_of(mesh, Format::ThreeMf, colors, Unit::Inch);
    CHECK(bytes == bytes_of(mesh, Format::ThreeMf, colors, Unit::Inch)); // no date
    CHECK(unzipped(bytes, "_rels/.rels").find("/3D/3dmodel.model") != std::string::npos);
    CHECK(unzipped(bytes, "[Content_Types].xml").find("\"model\"") != std::string::npos);
    const std::string model = unzipped(bytes, "3D/3dmodel.model");
    CHECK(count_of(model, "unit=\"inch\"") == 1);
    CHECK(count_of(model, "<vertex ") == 4);
    CHECK(count_of(model, "<vertex x=\"0\" y=\"0\" z=\"1\"/>") == 1); // y of the scene is up
    CHECK(count_of(model, "<triangle ") == 4);
    CHECK(count_of(model, "<m:color ") == 4);
    CHECK(count_of(model, "<m:color color=\"#800000\"/>") == 1);
    CHECK(count_of(model, "v1=\"0\" v2=\"2\" v3=\"1\" pid=\"2\" p1=\"0\" p2=\"1\" p3=\"2\"") == 1);
    const std::string plain = unzipped(bytes_of(mesh, Format::ThreeMf), "3D/3dmodel.model");
    CHECK(count_of(plain, "color") == 0);
    CHECK(count_of(plain, "unit=\"millimeter\"") == 1);
}

TEST_CASE("a name is text in a 3MF, whatever it holds") {
    const Mesh mesh = corner_of_a_cube();
    const std::string model =
        unzipped(bytes_of(mesh, Format::ThreeMf, "a\"><evil & \n"), "3D/3dmodel.model");
    CHECK(count_of(model, "name=\"a&quot;>&lt;evil &amp;  \"") == 1);
    CHECK(count_of(unzipped(bytes_of(mesh, Format::ThreeMf, "a\xff"), "3D/3dmodel.model"),
                   "name=\"a\xef\xbf\xbd\"") == 1);
}

namespace {

// That tetrahedron twice: one of two materials, one of the second alone. Equal materials are one.
struct Two {
    Mesh mesh = corner_of_a_cube();
    std::vector<Material> first{{"stone", {0.5f, 0.5f, 0.5f}, {1, 1, 1}, {}, 32},
                                {"glow #1", {1, 0, 0}, {0.5f, 0.25f, 0}, {4, 2, 0}, 0}},
        second{first[1], {"stone", {0, 0, 1}, {1, 1, 1}, {}, 32, true}};
    std::vector<std::uint32_t> of_first{1, 0, 1, 0}, of_second{0, 0, 0, 1};
    std::vector<std::array<Point, 3>> corners =
        std::vector<std::array<Point, 3>>(4, {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
    std::vector<Surface> surfaces() const {
        return {{mesh.vertices, mesh.normals, mesh.triangles, colors, {}, first, of_first, "lid"},
                {mesh.vertices, mesh.normals, mesh.triangles, colors, corners, second, of_second,
                 "lid#2"}};
    }
};

} // namespace

TEST_CASE("objects of a GLB are nodes below one, with a primitive for each material") {
    const Two two;
    const std::string bytes = file_of(two.surfaces(), Format::Glb, {Unit::Inch, "all", ""});
    const nlohmann::json json = document_of(bytes);
    CHECK(json["nodes"][0]["name"] == "all");
    CHECK(json["nodes"][0]["children"] == nlohmann::json({1, 2}));
    CHECK(json["nodes"][0]["scale"][0] == 0.0254);
    CHECK(json["nodes"][2]["name"] == "lid#2");
    REQUIRE(json["materials"].size() == 3);
    CHECK(json["materials"][2]["name"] == "stone.2");
    REQUIRE(json["meshes"][0]["primitives"].size() == 2);
    REQUIRE(json["meshes"][1]["primitives"].size() == 2);
    const auto triangles = [&](std::size_t mesh, std::size_t primitive) {
        const auto &one = json["meshes"][mesh]["primitives"][primitive];
        return json["accessors"][one["indices"].get<std::size_t>()]["count"].get<int>() / 3;
    };
    CHECK((triangles(0, 0) == 2 && triangles(0, 1) == 2));
    CHECK((triangles(1, 0) == 3 && triangles(1, 1) == 1));
    // Equal ones are one: the second's first is the first's second.
    CHECK(json["meshes"][0]["primitives"][1]["material"] == 1);
    CHECK(json["meshes"][1]["primitives"][0]["material"] == 1);
    CHECK_FALSE(json["meshes"][1]["primitives"][0]["attributes"].contains("COLOR_0"));
    const auto &colored = json["meshes"][1]["primitives"][1];
    CHECK(json["accessors"][colored["attributes"]["COLOR_0"].get<std::size_t>()]["count"] == 3);
    CHECK(json["materials"][2]["pbrMetallicRoughness"]["baseColorFactor"][0] == 1.0);

    const nlohmann::json &glow = json["materials"][1];
    CHECK(glow["extensions"]["KHR_materials_specular"]["specularFactor"] == 0.5);
    CHECK(glow["extensions"]["KHR_materials_specular"]["specularColorFactor"] ==
          nlohmann::json({1.0, 0.5, 0.0}));
    CHECK(glow["emissiveFactor"] == nlohmann::json({1.0, 0.5, 0.0}));
    CHECK(glow["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] == 4.0);
    CHECK(json["extensionsUsed"].size() == 2);
    CHECK(glow["pbrMetallicRoughness"]["roughnessFactor"] == 1.0);
    CHECK_FALSE(json["materials"][0].contains("extensions"));
}

TEST_CASE("a duller highlight is rougher") {
    CHECK(roughness_of(0) == 1);
    CHECK(roughness_of(-1) == 1);
    CHECK(roughness_of(40) == Approx(1.0 / 3)); // (2 * 40 + 1)^(1/4) = 3
    CHECK(roughness_of(1e6f) < 0.03f);
}

TEST_CASE("objects of an OBJ count on, and name materials of the library beside it") {
    const Two two;
    const std::string text =
        file_of(two.surfaces(), Format::Obj, {Unit::Unsaid, "all", "two\nwords.mtl"});
    CHECK(text.starts_with("# by Fathom\nmtllib two_words.mtl\no lid\nv "));
    CHECK(count_of(text, "\no lid.2\n") == 1);
    CHECK(count_of(text, "\nusemtl stone\n") == 1);
    CHECK(count_of(text, "\nusemtl glow_.1\n") == 2);
    CHECK(count_of(text, "\nusemtl stone.2\n") == 1);
    CHECK(count_of(text, "\nf ") == 8);
    const std::string second = text.substr(text.find("\no lid.2"));
    CHECK(count_of(second, "\nf 5//") + count_of(second, " 5//") >= 3); // its first vertex
    CHECK(count_of(second, " 4//") == 0);
    const std::string library = material_library_of(two.surfaces());
    CHECK(count_of(library, "\nnewmtl ") == 3);
    CHECK(count_of(library,
                   "\nnewmtl stone\nKd 0.7354 0.7354 0.7354\nKs 1 1 1\nKe 0 0 0\nNs 32\n") == 1);
    CHECK(count_of(library, "Ke 1 1 0\n") == 1); // no more than 1
    CHECK(file_of(two.surfaces(), Format::Obj).find("mtl") == std::string::npos);
}

TEST_CASE("objects of a 3MF are components of one, so that they stay where they are") {
    const Two two;
    const std::string model = unzipped(
        file_of(two.surfaces(), Format::ThreeMf, {Unit::Unsaid, "a<b", ""}), "3D/3dmodel.model");
    CHECK(count_of(model, "<object id=") == 3);
    CHECK(count_of(model, "<object id=\"1\" type=\"model\" name=\"lid\" pid=\"3\"") == 1);
    CHECK(count_of(model, "<object id=\"4\" type=\"model\" name=\"a&lt;b\">\n<components>\n"
                          "<component objectid=\"1\"/>\n<component objectid=\"2\"/>\n") == 1);
    CHECK(count_of(model, "<build><item objectid=\"4\"/></build>") == 1);
    CHECK(count_of(model, "<triangle ") == 8);
}

TEST_CASE("an STL and a PLY hold several objects as one") {
    const Two two;
    CHECK(file_of(two.surfaces(), Format::Stl).size() == 84 + 8 * 50);
    const std::string ply = file_of(two.surfaces(), Format::Ply);
    CHECK(count_of(ply, "element vertex 8\n") == 1);
    CHECK(read<std::uint32_t>(ply, ply.size() - 12) == 4); // the second's first vertex
}
