// The table of node_types.h.
#include "save-format/node_types.h"

#include "base/text.h"
#include "save-format/yaml_reader.h"

#include <algorithm>
#include <string>

namespace fathom::save {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
using P = PropertyType;
using K = PropertyKind;

constexpr P size(const char *name, double fallback) {
    return {name, K::Number, fallback, "", 0, 1e9, true, false};
}
constexpr P number(const char *name, double fallback) {
    return {name, K::Number, fallback, "", -1e9, 1e9, false, false};
}
constexpr P vector(const char *name, double fallback) {
    return {name, K::Vector, fallback, "", -1e9, 1e9, false, false};
}
constexpr P sizes(const char *name, double fallback) {
    return {name, K::Vector, fallback, "", 0, 1e9, true, false};
}
constexpr P whole(const char *name, double fallback, double minimum, double maximum) {
    return {name, K::Whole, fallback, "", minimum, maximum, false, false};
}
constexpr P exponent(const char *name, double fallback) {
    return {name, K::Number, fallback, "", 1, none, false, false};
}
constexpr P word(const char *name, const char *fallback) { return {name, K::Word, 0, fallback}; }
constexpr P flag(const char *name) { return {name, K::Switch, 0, ""}; }
constexpr P tree(const char *name) { return {name, K::Tree, 0, ""}; }
constexpr P labelled(P row) {
    row.labelled = true;
    return row;
}

constexpr P material = {"Material", K::Material, 0, "<None>"};
constexpr P texture_offset = {"Offset", K::Carried, 0, "{X: 0, Y: 0}"};
constexpr P exact = labelled(flag("Exact"));

constexpr P generic[] = {labelled(tree("Paint"))};
constexpr P sphere[] = {size("Radius", 1), material, texture_offset};
constexpr P torus[] = {size("Major Radius", 1), size("Minor Radius", 0.25), material,
                       texture_offset};
constexpr P cylinder[] = {size("Radius", 0.5), size("Height", 1), material, texture_offset, exact};
constexpr P cone[] = {size("Radius", 0.5), size("Height", 1), material, texture_offset};
constexpr P box[] = {sizes("Size", 1), material, texture_offset, exact};
constexpr P menger[] = {size("Size", 1), whole("Iterations", 3, 0, 12), material, texture_offset};
constexpr P gdf[] = {
    word("Shape", "Icosahedron"),      size("Radius", 1),  exponent("Exponent", none),
    word("Second Shape", "<None>"),    number("Scale", 1), number("Second Scale", -1),
    exponent("Second Exponent", none), material,           texture_offset};
constexpr P blobby[] = {whole("Balls", 10, 1, 1000),
                        sizes("Size", 1),
                        {"Radius", K::Number, 0.1, "", 0, 1e9, true},
                        whole("Seed", 0, -2147483647, 2147483647),
                        material,
                        texture_offset};
constexpr P explicit_field[] = {word("File", ""), material, texture_offset};
constexpr P blend[] = {number("Factor", 0.5),
                       {"Center", K::Vector, 0, "", -1e9, 1e9, false, true},
                       labelled(tree("Factor Field"))};
constexpr P flat = labelled(flag("Flat"));
constexpr P translation[] = {vector("Vector", 0), flat};
constexpr P rotation[] = {vector("Angles", 0), labelled(vector("Axis", 0)),
                          labelled(number("Angle", 0)), flat};
constexpr P scaling[] = {vector("Factors", 1), flat};
constexpr P twist[] = {number("Rate", 1), labelled(word("Axis", "Z"))};
constexpr P turnaround[] = {labelled(word("Axis", "X"))};
constexpr P repetition[] = {{"Cell", K::Vector, 0, "", 0, 1e9},
                            labelled({"Count", K::Vector, none, "", 0, none}),
                            labelled(flag("Differ")),
                            flat};
constexpr P hyperize[] = {size("Exponent", 1), labelled(tree("Within"))};
constexpr P offset[] = {number("Distance", 0)};
constexpr P displacement[] = {word("Map", "<None>"), number("Amount", 0.1), sizes("Scale", 1),
                              labelled(tree("Field"))};
constexpr P library[] = {word("Function", ""), tree("Arguments"), material};
constexpr P profile_blend[] = {word("Operation", "Union"),
                               word("Profile", "Smooth"),
                               {"Radius", K::Number, 0.1, "", 0, 1e9, false, false},
                               number("Count", 4),
                               labelled(flag("Mix"))};
constexpr P pseudo_norm[] = {exponent("Exponent", 2)};
constexpr P seam[] = {word("Profile", "Pipe"), size("Radius", 0.1), size("Depth", 0.1)};
constexpr P field[] = {tree("Field"),
                       tree("Within"),
                       {"Assumed", K::Number, 0, "", 0, 1e9, false, true},
                       {"Estimate", K::Number, 0, "", 0, 1e9, false, true},
                       material};
constexpr P distortion[] = {tree("Map"), tree("Within")};
constexpr P region[] = {tree("Within")};
constexpr P deformation[] = {word("Function", ""), tree("Arguments"), labelled(flag("Differ"))};
constexpr P lighting[] = {number("Ambient R", 0),
                          number("Ambient G", 0),
                          number("Ambient B", 0),
                          number("Ambient Occlusion", 1),
                          number("Shadow Darkness", 0.5),
                          number("Soft Shadows", 0.03),
                          number("Specular Intensity", 0.4),
                          {"Specular Exponent", K::Carried, 0, "128"},
                          flag("Skip Shadows & Shading"),
                          labelled(tree("Background")),
                          labelled(size("Epsilon", 5e-4)),
                          labelled(size("Far", 0)),
                          labelled(size("Time End", 3600)),
                          labelled(flag("Orthographic")),
                          labelled({"Classic", K::Switch, 1, ""}),
                          labelled(number("Fill", 0)),
                          labelled(number("Occlusion Reach", 0))};

constexpr NodeTypeRow rows[] = {
    {NodeType::Generic, "Generic", Arity::Many, generic},
    {NodeType::Sphere, "Sphere", Arity::Leaf, sphere},
    {NodeType::Torus, "Torus", Arity::Leaf, torus},
    {NodeType::Cylinder, "Cylinder", Arity::Leaf, cylinder},
    {NodeType::Cone, "Cone", Arity::Leaf, cone},
    {NodeType::Box, "Box", Arity::Leaf, box},
    {NodeType::MengerSponge, "Menger Sponge", Arity::Leaf, menger},
    {NodeType::GeneralizedDistanceFunction, "Generalized Distance Function", Arity::Leaf, gdf},
    {NodeType::BlobbyObjects, "Blobby Objects", Arity::Leaf, blobby},
    {NodeType::ExplicitField, "Explicit Field", Arity::Leaf, explicit_field},
    {NodeType::Union, "Union", Arity::Many, {}},
    {NodeType::Intersection, "Intersection", Arity::Many, {}},
    {NodeType::Difference, "Difference", Arity::Many, {}},
    {NodeType::Blend, "Blend", Arity::Two, blend},
    {NodeType::Translation, "Translation", Arity::One, translation},
    {NodeType::Rotation, "Rotation", Arity::One, rotation},
    {NodeType::Scaling, "Scaling", Arity::One, scaling},
    {NodeType::Twist, "Twist", Arity::One, twist},
    {NodeType::Turnaround, "Turnaround", Arity::One, turnaround},
    {NodeType::Repetition, "Repetition", Arity::One, repetition},
    {NodeType::Hyperize, "Hyperize", Arity::One, hyperize},
    {NodeType::Offset, "Offset", Arity::One, offset},
    {NodeType::Displacement, "Displacement", Arity::One, displacement},
    {NodeType::LibraryShape, "Library Shape", Arity::Leaf, library},
    {NodeType::ProfileBlend, "Profile Blend", Arity::Many, profile_blend},
    {NodeType::PseudoNormBlend, "Pseudo-norm Blend", Arity::Two, pseudo_norm},
    {NodeType::Seam, "Seam", Arity::Two, seam},
    {NodeType::Field, "Field", Arity::Leaf, field},
    {NodeType::Distortion, "Distortion", Arity::One, distortion},
    {NodeType::Region, "Region", Arity::One, region},
    {NodeType::Complement, "Complement", Arity::One, {}},
    {NodeType::Deformation, "Deformation", Arity::One, deformation},
    {NodeType::Lighting, "LightingNode", Arity::Many, lighting},
};

// Other spellings, without case and spaces. The thesis prints only a few; whoever holds real files
// adds theirs here.
struct Synonym {
    const char *spelling;
    NodeType type;
};
constexpr Synonym synonyms[] = {
    {"group", NodeType::Generic},
    {"menger", NodeType::MengerSponge},
    {"cube", NodeType::Box},
    {"gdf", NodeType::GeneralizedDistanceFunction},
    {"metaballs", NodeType::BlobbyObjects},
    {"blobbyobject", NodeType::BlobbyObjects},
    {"blobs", NodeType::BlobbyObjects},
    {"explicitdistancefield", NodeType::ExplicitField},
    {"csgunion", NodeType::Union},
    {"csgintersection", NodeType::Intersection},
    {"csgdifference", NodeType::Difference},
    {"subtraction", NodeType::Difference},
    {"linearblend", NodeType::Blend},
    {"translate", NodeType::Translation},
    {"rotate", NodeType::Rotation},
    {"scale", NodeType::Scaling},
    {"repeat", NodeType::Repetition},
    {"displacementmap", NodeType::Displacement},
    {"lighting", NodeType::Lighting},
};

constexpr VectorSet sets[] = {
    {"Tetrahedron", "gdf_tetrahedron", 0},
    {"Cube", "gdf_cube", 1},
    {"Octahedron", "gdf_octahedron", 2},
    {"Dodecahedron", "gdf_ac_dodecahedron", 7},
    {"Icosahedron", "gdf_ac_icosahedron", 8},
    {"Truncated Octahedron", "gdf_truncated_octahedron", 5},
    {"Truncated Icosahedron", "gdf_ac_truncated_icosahedron", 9},
};

const NodeTypeRow *look_up(std::string_view name) {
    const std::string key = spelling_key(name);
    for (const NodeTypeRow &row : rows) {
        if (spelling_key(row.name) == key) return &row;
    }
    for (const Synonym &synonym : synonyms) {
        if (synonym.spelling == key) return &row_of(synonym.type);
    }
    return nullptr;
}

} // namespace

std::span<const NodeTypeRow> node_types() { return rows; }
const NodeTypeRow &row_of(NodeType type) { return rows[static_cast<std::size_t>(type)]; }
const NodeTypeRow *find_node_type(std::string_view name) {
    for (const NodeTypeRow &row : rows) {
        if (name == row.name) return &row; // the usual spelling, without the work
    }
    return look_up(name);
}

const PropertyType *find_property(const NodeTypeRow &row, std::string_view name) {
    for (const PropertyType &property : row.properties) {
        if (name == property.name) return &property;
    }
    const std::string key = spelling_key(name);
    for (const PropertyType &property : row.properties) {
        if (spelling_key(property.name) == key) return &property;
    }
    return nullptr;
}

std::span<const VectorSet> vector_sets() { return sets; }
int find_vector_set(std::string_view name) {
    const std::string key = spelling_key(name);
    for (std::size_t i = 0; i < std::size(sets); ++i) {
        if (spelling_key(sets[i].name) == key) return static_cast<int>(i);
    }
    return -1;
}

bool is_library_solid(std::string_view function) {
    static constexpr std::string_view solids[] = {
        "sphere", "box", "rounded_box", "box_frame", "torus", "capped_torus", "link", "cylinder",
        "rounded_cylinder", "capsule", "cone", "capped_cone", "round_cone", "prism", "pyramid",
        "tetrahedron", "octahedron", "dodecahedron", "icosahedron", "plane", "slab", "ellipsoid",
        "superquadric", "gdf", "gdf_tetrahedron", "gdf_cube", "gdf_octahedron", "gdf_dodecahedron",
        "gdf_icosahedron", "gdf_truncated_octahedron", "gdf_truncated_icosahedron", "gdf_blend",
        "metaballs", "metaballs_random", "menger", "gyroid", "schwarz_p", "mandelbulb", "helix",
        "tubes", "heightfield", "distance_grid", "gdf_pair", // the last of module dfmodel
        // flat ones, below an extrusion or a revolution
        "circle", "ellipse", "rectangle", "rounded_rectangle", "polygon", "regular_polygon", "star",
        "segment", "arc", "ring", "bezier"};
    return std::find(std::begin(solids), std::end(solids), function) != std::end(solids);
}

bool is_library_deformation(std::string_view function) {
    static constexpr std::string_view names[] = {
        "bend",     "taper",        "shell",         "mirror",  "reflect",
        "elongate", "repeat_polar", "repeat_mirror", "extrude", "revolve"};
    return std::find(std::begin(names), std::end(names), function) != std::end(names);
}

Dialect dialect_of(std::string_view version) {
    Dialect dialect;
    dialect.is_version = parse_number(version).has_value() ||
                         (!version.empty() && version[0] >= '0' && version[0] <= '9');
    const auto number = parse_number(version);
    dialect.known = number && *number == 0.3;
    return dialect;
}

} // namespace fathom::save
