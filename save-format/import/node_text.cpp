// The language's text of each node type. The fields are the thesis's equations with the file's
// numbers put in; what the library has in the same form is called there, the rest in module
// dfmodel. Transforms of the file act on the point (2.5, 2.6, 2.9, 2.12), the language's on the
// object: hence the inverses.
#include "save-format/import/node_text.h"

#include "base/text.h"
#include "save-format/program.h"
#include "save-format/yaml_writer.h"

#include <cmath>

namespace fathom::save {
namespace {

// The properties of a row by name, with its defaults.
class Reading {
  public:
    Reading(const NodeTypeRow &row, const Properties &properties)
        : row_(row), properties_(properties) {}

    const Property &operator[](std::string_view name) const {
        return properties_.values[index(name)];
    }
    double number(std::string_view name) const {
        const std::size_t at = index(name);
        return properties_.values[at].given ? properties_.values[at].number[0]
                                            : row_.properties[at].fallback;
    }
    void vector(std::string_view name, double (&out)[3]) const {
        const std::size_t at = index(name);
        for (int axis = 0; axis < 3; ++axis) {
            out[axis] = properties_.values[at].given ? properties_.values[at].number[axis]
                                                     : row_.properties[at].fallback;
        }
    }
    std::string word(std::string_view name) const {
        const std::size_t at = index(name);
        return properties_.values[at].given ? properties_.values[at].word
                                            : std::string(row_.properties[at].word);
    }
    std::string text(std::string_view name) const { return sdf_number(number(name)); }
    std::string vector_text(std::string_view name) const {
        double value[3];
        vector(name, value);
        return value[0] == value[1] && value[1] == value[2] ? sdf_number(value[0])
                                                            : sdf_vector(value);
    }

  private:
    std::size_t index(std::string_view name) const {
        for (std::size_t i = 0; i < row_.properties.size(); ++i) {
            if (row_.properties[i].name == name) return i;
        }
        return 0;
    }
    const NodeTypeRow &row_;
    const Properties &properties_;
};

// 1/a, by a short number where that is exact, else by a division that the language does in the same
// double arithmetic.
std::string reciprocal(double a) {
    const double inverse = 1 / a;
    const std::string text = sdf_number(inverse);
    if (text.size() <= 6 && 1 / inverse == a) return text;
    return "1 / " + (a < 0 ? "(" + sdf_number(a) + ")" : sdf_number(a));
}

bool is_plain_list(const Value &value) {
    if (value.kind != Value::Kind::Sequence || value.items.empty()) return false;
    for (const Value &item : value.items) {
        if (!number_of(item)) return false;
    }
    return true;
}

// Numbers, vectors and lists of them, as an argument of a library call; empty where it is something
// else.
std::string argument_text(const Value &value) {
    if (const auto number = number_of(value)) return sdf_number(*number);
    if (value.kind == Value::Kind::Scalar) {
        const auto on = switch_of(value);
        return on && value.plain ? (*on ? "true" : "false") : std::string();
    }
    if (value.kind != Value::Kind::Sequence) return {};
    std::string text = "[";
    for (const Value &item : value.items) {
        if (!number_of(item) && !is_plain_list(item)) return {};
        if (text.size() > 1) text += ", ";
        text += argument_text(item);
    }
    return text + "]";
}

std::string library_call(Importer &in, const Reading &reading, Properties &properties, Span at) {
    const std::string function = reading.word("Function");
    if (!is_library_solid(function)) {
        in.report.content(at, "`" + std::string(cut(function, 80)) + "` is no solid of the library")
            .note("the node is left out, and kept for an export");
        return {};
    }
    std::string call = function + "(";
    for (const auto &[name, value] : reading["Arguments"].tree.entries) {
        const bool is_name =
            !name.empty() &&
            name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") == std::string::npos &&
            name[0] >= 'a';
        const std::string text = argument_text(value);
        if (!is_name || text.empty()) {
            in.report.content(value.span, "`" + std::string(cut(name, 80)) +
                                              "` is no argument of numbers, and is left out");
            properties.keep(name, "~");
            continue;
        }
        if (call.back() != '(') call += ", ";
        call += name + ": " + text;
    }
    return call + ")";
}

std::string gdf_call(Importer &in, const Reading &reading, Properties &properties, Span at) {
    const auto set_of = [&](const char *property) {
        const std::string word = reading.word(property);
        if (is_none(word)) return -1;
        const int set = find_vector_set(word);
        if (set >= 0) return set;
        in.report
            .content(at, "`" + std::string(cut(word, 80)) + "` is no set of vectors for `" +
                             property + "`")
            .help("the sets are Tetrahedron, Cube, Octahedron, Dodecahedron, Icosahedron, "
                  "Truncated Octahedron and Truncated Icosahedron");
        properties.keep(property, flow_scalar(word, true));
        return -1;
    };
    int first = set_of("Shape");
    const int second = set_of("Second Shape");
    if (first < 0) first = 4; // the table's default
    const std::string radius = "radius: " + reading.text("Radius");
    const auto exponent_text = [&](const char *property, const char *argument) {
        const double exponent = reading.number(property);
        return std::isinf(exponent) ? std::string()
                                    : std::string(", ") + argument + ": " + sdf_number(exponent);
    };
    const auto sets = vector_sets();
    if (second < 0 && reading.number("Scale") == 1) {
        return std::string(sets[static_cast<std::size_t>(first)].function) + "(" + radius +
               exponent_text("Exponent", "exponent") + ")";
    }
    const auto set_text = [&](int set) {
        return "dfmodel." + std::string(sets[static_cast<std::size_t>(set)].function + 4);
    };
    return "dfmodel.gdf_pair(" + set_text(first) + ", " + set_text(second < 0 ? first : second) +
           ", a_scale: " + reading.text("Scale") +
           ", b_scale: " + (second < 0 ? "0" : reading.text("Second Scale")) + ", " + radius +
           exponent_text("Exponent", "a_exponent") +
           exponent_text("Second Exponent", "b_exponent") + ")";
}

std::string field_call(Importer &in, const Reading &reading, Span at) {
    std::string why;
    const std::string lambda = program_text(reading["Field"].tree, why);
    if (lambda.empty()) {
        in.report.content(at, "the program of this field cannot be read: " + why)
            .note("the node is left out, and kept for an export");
        return {};
    }
    std::string call = "implicit(" + lambda;
    if (reading["Within"].given) {
        const std::string region = region_text(reading["Within"].tree);
        if (region.empty()) {
            in.report.content(at, "the region of this field cannot be read")
                .note("the node is left out, and kept for an export");
            return {};
        }
        call += ", within: " + region;
    }
    if (reading["Assumed"].given) call += ", lipschitz: " + reading.text("Assumed");
    if (reading["Estimate"].given) call += ", estimate: " + reading.text("Estimate");
    return call + ")";
}

} // namespace

std::string leaf_text(Importer &in, const NodeTypeRow &row, Properties &properties, Span at) {
    const Reading reading(row, properties);
    const auto exact = [&](std::string_view call) {
        return (reading.number("Exact") != 0 ? "" : "dfmodel.") + std::string(call);
    };
    std::string text;
    switch (row.type) {
    case NodeType::Sphere: text = "sphere(" + reading.text("Radius") + ")"; break;
    case NodeType::Torus:
        text = "torus(" + reading.text("Major Radius") + ", " + reading.text("Minor Radius") + ")";
        break;
    case NodeType::Cylinder:
        text = exact("cylinder(") + reading.text("Radius") + ", " + reading.text("Height") + ")";
        break;
    case NodeType::Cone:
        text = "dfmodel.cone(" + reading.text("Radius") + ", " + reading.text("Height") + ")";
        break;
    case NodeType::Box: text = exact("box(") + reading.vector_text("Size") + ")"; break;
    case NodeType::MengerSponge:
        text = "dfmodel.menger_sponge(" + reading.text("Size") + ", " + reading.text("Iterations") +
               ")";
        break;
    case NodeType::GeneralizedDistanceFunction: text = gdf_call(in, reading, properties, at); break;
    case NodeType::BlobbyObjects:
        text = "dfmodel.blobby(" + reading.text("Balls") +
               ", size: " + reading.vector_text("Size") + ", radius: " + reading.text("Radius") +
               ", seed: " + reading.text("Seed") + ")";
        break;
    case NodeType::ExplicitField: {
        const std::string file = reading.word("File");
        if (file.empty()) {
            in.report.content(at, "an explicit field needs its `File`")
                .note("the node is left out, and kept for an export");
            return {};
        }
        text = "distance_grid(" + sdf_string(in.text_of_asset(file)) + ")";
        break;
    }
    case NodeType::LibraryShape: text = library_call(in, reading, properties, at); break;
    case NodeType::Field: text = field_call(in, reading, at); break;
    case NodeType::Generic:
    case NodeType::Union:
    case NodeType::Intersection:
    case NodeType::Difference:
    case NodeType::Blend:
    case NodeType::Translation:
    case NodeType::Rotation:
    case NodeType::Scaling:
    case NodeType::Twist:
    case NodeType::Turnaround:
    case NodeType::Repetition:
    case NodeType::Hyperize:
    case NodeType::Offset:
    case NodeType::Displacement:
    case NodeType::ProfileBlend:
    case NodeType::PseudoNormBlend:
    case NodeType::Seam:
    case NodeType::Distortion:
    case NodeType::Complement:
    case NodeType::Deformation:
    case NodeType::Lighting: break;
    }
    if (text.empty()) return text;
    const std::string material = reading.word("Material");
    if (is_none(material)) return text;
    const auto found = in.materials.find(material);
    if (found == in.materials.end()) {
        in.report
            .content(at, "there is no material `" + std::string(cut(material, 80)) +
                             "` before this node")
            .note("the name is kept for an export");
        properties.keep("Material", flow_scalar(material, true));
        return text;
    }
    if (found->second.twin) properties.keep("Material", flow_scalar(material, true));
    if (!found->second.displacement.empty()) text += chain_mark + found->second.displacement;
    return text + chain_mark + ".paint(" + found->second.identifier + ")";
}

std::string transform_call(Importer &in, const NodeTypeRow &row, Properties &properties, Span at) {
    const Reading reading(row, properties);
    double v[3];
    switch (row.type) {
    case NodeType::Translation: {
        reading.vector("Vector", v); // 2.6: d(p + v) is the object moved by -v
        const int moved = (v[0] != 0) + (v[1] != 0) + (v[2] != 0);
        if (moved == 0) return {};
        for (double &part : v) part = part == 0 ? 0 : -part;
        if (moved > 1) return ".translate(" + sdf_vector(v) + ")";
        const int axis = v[0] != 0 ? 0 : v[1] != 0 ? 1 : 2;
        return std::string(".translate(") + "xyz"[axis] + ": " + sdf_number(v[axis]) + ")";
    }
    case NodeType::Rotation: {
        reading.vector("Angles",
                       v); // 2.5: d(R p), R = Rx Ry Rz, turns the object by Rz(-z) Ry(-y) Rx(-x)
        const int turned = (v[0] != 0) + (v[1] != 0) + (v[2] != 0);
        if (turned == 0) return {};
        if (turned == 1) {
            const int axis = v[0] != 0 ? 0 : v[1] != 0 ? 1 : 2;
            return ".rotate(" + sdf_number(-v[axis]) + "deg, axis: " + "XYZ"[axis] + ")";
        }
        std::string angles;
        for (const double part : v)
            angles += (angles.empty() ? "" : ", ") + (part == 0 ? "0" : sdf_number(-part) + "deg");
        return ".rotate_euler([" + angles + "])";
    }
    case NodeType::Scaling: {
        reading.vector("Factors", v); // 2.10, 2.12: d(S p) is the object 1/a as large
        for (const double part : v) {
            if (part == 0) {
                in.report.content(at, "a scaling factor cannot be 0")
                    .note("the node's children stand unscaled");
                return {};
            }
        }
        if (v[0] == 1 && v[1] == 1 && v[2] == 1) return {};
        if (v[0] == v[1] && v[1] == v[2]) return ".scale(" + reciprocal(v[0]) + ")";
        return ".scale([" + reciprocal(v[0]) + ", " + reciprocal(v[1]) + ", " + reciprocal(v[2]) +
               "])";
    }
    case NodeType::Twist: { // 2.9 turns the point by a z
        const double rate = reading.number("Rate");
        std::string axis = reading.word("Axis");
        if (axis != "X" && axis != "Y" && axis != "Z") {
            in.report.content(at, "an axis is X, Y or Z");
            properties.keep("Axis", flow_scalar(axis, true));
            axis = "Z";
        }
        return rate == 0 ? std::string() : ".twist(" + sdf_number(-rate) + ", axis: " + axis + ")";
    }
    case NodeType::Turnaround: {
        std::string axis = reading.word("Axis");
        if (axis != "X" && axis != "Y" && axis != "Z") {
            in.report.content(at, "an axis is X, Y or Z");
            properties.keep("Axis", flow_scalar(axis, true));
            axis = "X";
        }
        return ".turnaround(" + axis + ")";
    }
    case NodeType::Repetition: {
        reading.vector("Cell", v);
        if (v[0] == 0 && v[1] == 0 && v[2] == 0) return {};
        std::string call = ".repeat(" + sdf_vector(v);
        if (reading["Count"].given) {
            double count[3];
            reading.vector("Count", count);
            call += ", count: " + sdf_vector(count);
        }
        return call + ")";
    }
    case NodeType::Hyperize: {
        const double exponent = reading.number("Exponent");
        const std::string region =
            reading["Within"].given ? region_text(reading["Within"].tree) : std::string();
        if (exponent == 1) return {};
        return ".hyperize(" + sdf_number(exponent) + (region.empty() ? "" : ", within: " + region) +
               ")";
    }
    case NodeType::Offset: {
        const double distance = reading.number("Distance");
        return distance == 0 ? std::string() : ".offset(" + sdf_number(distance) + ")";
    }
    case NodeType::Displacement: {
        if (reading["Field"].given) {
            std::string why;
            const std::string lambda = program_text(reading["Field"].tree, why);
            if (!lambda.empty()) return ".displace(" + lambda + ")";
            in.report.content(at, "the program of this displacement cannot be read: " + why);
            return {};
        }
        const std::string map = reading.word("Map");
        if (is_none(map)) return {};
        const auto texture = in.textures.find(map);
        if (texture == in.textures.end()) {
            in.report.content(at, "there is no texture `" + std::string(cut(map, 80)) + "`");
            return {};
        }
        if (reading.number("Amount") == 0) return {};
        reading.vector("Scale", v); // of a picture: X and Y
        return ".displace_map(" + texture->second + ", " + reading.text("Amount") + ", scale: " +
               (v[0] == v[1] ? sdf_number(v[0])
                             : "[" + sdf_number(v[0]) + ", " + sdf_number(v[1]) + "]") +
               ")";
    }
    case NodeType::Complement: return ".complement()";
    case NodeType::Deformation:
    case NodeType::Distortion: {
        std::string why;
        std::string call =
            row.type == NodeType::Distortion
                ? distortion_text(reading["Map"].tree, reading["Within"].tree, why)
                : deformation_text(reading.word("Function"), reading["Arguments"].tree, why);
        if (call.empty())
            in.report.content(at, "this node cannot be read: " + why)
                .note("its children stand as they are");
        return call;
    }
    case NodeType::Generic:
    case NodeType::Sphere:
    case NodeType::Torus:
    case NodeType::Cylinder:
    case NodeType::Cone:
    case NodeType::Box:
    case NodeType::MengerSponge:
    case NodeType::GeneralizedDistanceFunction:
    case NodeType::BlobbyObjects:
    case NodeType::ExplicitField:
    case NodeType::Union:
    case NodeType::Intersection:
    case NodeType::Difference:
    case NodeType::Blend:
    case NodeType::LibraryShape:
    case NodeType::ProfileBlend:
    case NodeType::PseudoNormBlend:
    case NodeType::Seam:
    case NodeType::Field:
    case NodeType::Lighting: break;
    }
    return {};
}

void operator_text(Importer &in, const NodeTypeRow &row, Properties &properties, Body &body,
                   std::size_t begin, std::size_t first_end, std::size_t rest_mark,
                   std::size_t rest, Span at) {
    const Reading reading(row, properties);
    const auto block = [&](std::string head) {
        body[begin] = {Piece::Kind::Open, std::move(head), {}};
        body.push_back({Piece::Kind::Close, "}", {}});
    };
    if (row.type == NodeType::Difference) return block("difference {");
    if (row.type == NodeType::ProfileBlend) {
        const std::string profile = spelling_key(reading.word("Profile")),
                          operation = spelling_key(reading.word("Operation"));
        if (operation == "xor") return block("xor {");
        const bool stepped = profile == "stairs" || profile == "columns";
        const bool mixed = profile == "smooth" && reading.number("Mix") != 0;
        const bool legal =
            (stepped || profile == "smooth" || profile == "round" || profile == "chamfer") &&
            (operation == "union" || operation == "intersection" || operation == "difference");
        if (!legal) {
            in.report.content(at, "this blend has an unknown operation or profile")
                .note("its children are united");
            return block("union {");
        }
        return block(profile + "_" + operation + "(" + reading.text("Radius") +
                     (stepped ? ", " + reading.text("Count") : "") + (mixed ? ", mix: true" : "") +
                     ") {");
    }
    // blend(a, b, t), pseudonorm_blend(a, b, exponent), and the seams with their sizes
    std::string last;
    std::string call = row.type == NodeType::Blend ? "blend" : "pseudonorm_blend";
    if (row.type == NodeType::PseudoNormBlend) {
        last = reading.text("Exponent");
    } else if (row.type == NodeType::Seam) {
        call = spelling_key(reading.word("Profile"));
        last = reading.text("Radius");
        if (call == "groove" || call == "tongue") {
            last += ", " + reading.text("Depth");
        } else if (call != "pipe" && call != "engrave") {
            in.report.content(at, "a seam's profile is Pipe, Engrave, Groove or Tongue")
                .note("a pipe stands in");
            call = "pipe";
        }
    } else if (reading["Factor Field"].given) {
        std::string why;
        last = program_text(reading["Factor Field"].tree, why);
        if (last.empty()) {
            in.report.content(at, "the program of this factor cannot be read: " + why)
                .note("the factor 0.5 stands in");
            last = "0.5";
        }
    } else if (reading["Center"].given) { // 2.14
        double center[3];
        reading.vector("Center", center);
        const bool origin = center[0] == 0 && center[1] == 0 && center[2] == 0;
        last = "p => clamp(length(p" + (origin ? std::string() : " - " + sdf_vector(center)) +
               "), 0, 1)";
    } else {
        last = reading.text("Factor");
    }
    body[begin] = {Piece::Kind::Open, call + "(", {}};
    body[first_end - 1].text += ',';
    if (rest > 1) {
        body[rest_mark] = {Piece::Kind::Open, "union {", {}};
        body.push_back({Piece::Kind::Close, "}", {}});
    }
    body.back().text += ',';
    body.push_back({Piece::Kind::Line, std::move(last), {}});
    body.push_back({Piece::Kind::Close, ")", {}});
}

// {Diffuse: steps, Specular: steps, Exponent: steps, Emission: steps, Repaint: True}
std::string paint_call(Importer &in, const NodeTypeRow &row, Properties &properties, Span at) {
    const Reading reading(row, properties);
    if (row.type != NodeType::Generic || !reading["Paint"].given) return {};
    const Value &looks = reading["Paint"].tree;
    std::string arguments;
    static constexpr std::pair<const char *, const char *> parts[] = {{"Diffuse", "diffuse: "},
                                                                      {"Specular", "specular: "},
                                                                      {"Exponent", "exponent: "},
                                                                      {"Emission", "emission: "}};
    for (const auto &[key, argument] : parts) {
        const Value *steps = looks.find(key);
        if (!steps) continue;
        std::string why;
        const std::string lambda = program_text(*steps, why, true);
        if (lambda.empty()) {
            in.report.content(at,
                              std::string("`") + key + "` of this paint cannot be read: " + why);
            continue;
        }
        arguments += (arguments.empty() ? "" : ", ") + std::string(argument) + lambda;
    }
    const Value *over = looks.find("Repaint");
    const bool repaint = over && switch_of(*over).value_or(false);
    return arguments.empty()
               ? std::string()
               : std::string(repaint ? ".repaint" : ".paint") + "(material(" + arguments + "))";
}

std::string property_flow(const PropertyType &type, const Property &property) {
    switch (type.kind) {
    case PropertyKind::Number:
    case PropertyKind::Whole: return yaml_number(property.number[0]);
    case PropertyKind::Vector:
        return "{X: " + yaml_number(property.number[0]) +
               ", Y: " + yaml_number(property.number[1]) +
               ", Z: " + yaml_number(property.number[2]) + "}";
    case PropertyKind::Switch: return property.number[0] != 0 ? "True" : "False";
    case PropertyKind::Word:
    case PropertyKind::Material: return flow_scalar(property.word, true);
    case PropertyKind::Tree: return flow_text(property.tree);
    case PropertyKind::Carried: break;
    }
    return "~";
}

} // namespace fathom::save
