// The language's text of each node type. The fields are the thesis's equations with the file's
// numbers put in; what the library has in the same form is called there, the rest in module
// dfmodel. Transforms of the file act on the point (2.5, 2.6, 2.9, 2.12), the language's on the
// object: hence the inverses.
#include "save-format/import/node_text.h"
#include "save-format/import/reading.h"

#include "base/text.h"
#include "save-format/program.h"
#include "save-format/yaml_writer.h"

#include <cmath>

namespace fathom::save {
namespace {

// 1/a, by a short number where that is exact, else by a division that the language does in the same
// double arithmetic.
std::string reciprocal(double a) {
    const double inverse = 1 / a;
    const std::string text = sdf_number(inverse);
    if (text.size() <= 6 && 1 / inverse == a) return text;
    return "1 / " + (a < 0 ? "(" + sdf_number(a) + ")" : sdf_number(a));
}

} // namespace

std::string leaf_text(Importer &in, const NodeTypeRow &row, Properties &properties, Span at) {
    const Reading reading(in, row, properties, at);
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
    case NodeType::Region:
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

// Long: a case for each transform.
std::string transform_call(Importer &in, const NodeTypeRow &row, Properties &properties, Span at) {
    const Reading reading(in, row, properties, at);
    double v[3];
    switch (row.type) {
    case NodeType::Translation: {
        if (const std::string moved = reading.formula("Vector"); !moved.empty())
            return ".translate(-" + moved + ")";
        reading.vector("Vector", v); // 2.6: d(p + v) is the object moved by -v
        const int moved = (v[0] != 0) + (v[1] != 0) + (v[2] != 0);
        if (moved == 0) return {};
        for (double &part : v) part = part == 0 ? 0 : -part;
        if (reading.number("Flat") != 0)
            return ".translate([" + sdf_number(v[0]) + ", " + sdf_number(v[1]) + "])";
        if (moved > 1) return ".translate(" + sdf_vector(v) + ")";
        const int axis = v[0] != 0 ? 0 : v[1] != 0 ? 1 : 2;
        return std::string(".translate(") + "xyz"[axis] + ": " + sdf_number(v[axis]) + ")";
    }
    case NodeType::Rotation: {
        if (reading["Axis"].given) { // labelled: the object's own turn, in place of the angles
            reading.vector("Axis", v);
            return ".rotate(" + reading.text("Angle") + ", axis: " + sdf_vector(v) + ")";
        }
        reading.vector("Angles",
                       v); // 2.5: d(R p), R = Rx Ry Rz, turns the object by Rz(-z) Ry(-y) Rx(-x)
        const int turned = (v[0] != 0) + (v[1] != 0) + (v[2] != 0);
        if (turned == 0) return {};
        if (reading.number("Flat") != 0) return ".rotate(" + sdf_number(-v[2]) + "deg)";
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
        if (const std::string factors = reading.formula("Factors"); !factors.empty())
            return ".scale(1 / " + factors + ")";
        reading.vector("Factors", v); // 2.10, 2.12: d(S p) is the object 1/a as large
        for (const double part : v) {
            if (part == 0) {
                in.report.content(at, "a scaling factor cannot be 0")
                    .note("the node's children stand unscaled");
                return {};
            }
        }
        if (v[0] == 1 && v[1] == 1 && v[2] == 1) return {};
        if (reading.number("Flat") != 0)
            return ".scale([" + reciprocal(v[0]) + ", " + reciprocal(v[1]) + "])";
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
        const std::string varying = reading.formula("Rate");
        if (!varying.empty()) return ".twist(-" + varying + ", axis: " + axis + ")";
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
        const bool flat = reading.number("Flat") != 0;
        const auto written = [&](const double(&by)[3]) {
            return flat ? "[" + sdf_number(by[0]) + ", " + sdf_number(by[1]) + "]" : sdf_vector(by);
        };
        const std::string cell = reading.formula("Cell");
        std::string call = ".repeat(" + (cell.empty() ? written(v) : cell);
        if (reading["Count"].given) {
            double count[3];
            reading.vector("Count", count);
            call += ", count: " + written(count);
        }
        return call + ")";
    }
    case NodeType::Hyperize: {
        const double exponent = reading.number("Exponent");
        const std::string region =
            reading["Within"].given ? region_text(reading["Within"].tree, in.words) : std::string();
        if (exponent == 1 && !reading.varies("Exponent")) return {};
        return ".hyperize(" + reading.text("Exponent") +
               (region.empty() ? "" : ", within: " + region) + ")";
    }
    case NodeType::Offset: {
        const double distance = reading.number("Distance");
        const bool nothing = distance == 0 && !reading.varies("Distance");
        return nothing ? std::string() : ".offset(" + reading.text("Distance") + ")";
    }
    case NodeType::Displacement: {
        if (reading["Field"].given) {
            std::string why;
            const std::string lambda = program_text(reading["Field"].tree, in.words, why);
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
        if (reading.number("Amount") == 0 && !reading.varies("Amount")) return {};
        reading.vector("Scale", v); // of a picture: X and Y
        return ".displace_map(" + texture->second + ", " + reading.text("Amount") + ", scale: " +
               (v[0] == v[1] ? sdf_number(v[0])
                             : "[" + sdf_number(v[0]) + ", " + sdf_number(v[1]) + "]") +
               ")";
    }
    case NodeType::Complement: return ".complement()";
    case NodeType::Region: {
        const std::string region = region_text(reading["Within"].tree, in.words);
        if (!region.empty()) return ".within(" + region + ")";
        in.report.content(at, "the region of this node cannot be read")
            .note("its children stand as they are");
        return {};
    }
    case NodeType::Deformation:
    case NodeType::Distortion: {
        std::string why;
        std::string call =
            row.type == NodeType::Distortion
                ? distortion_text(reading["Map"].tree, reading["Within"].tree, in.words, why)
                : deformation_call(reading, why);
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
    const Reading reading(in, row, properties, at);
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
        last = program_text(reading["Factor Field"].tree, in.words, why);
        if (last.empty()) {
            in.report.content(at, "the program of this factor cannot be read: " + why)
                .note("the factor 0.5 stands in");
            last = "0.5";
        }
    } else if (reading["Center"].given) { // 2.14
        double center[3];
        reading.vector("Center", center);
        const std::string varying = reading.formula("Center");
        const bool origin = varying.empty() && center[0] == 0 && center[1] == 0 && center[2] == 0;
        const std::string at_center = varying.empty() ? sdf_vector(center) : varying;
        last = "p => clamp(length(p" + (origin ? std::string() : " - " + at_center) + "), 0, 1)";
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
    const Reading reading(in, row, properties, at);
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
        const std::string lambda = program_text(*steps, in.words, why, Given::PointAndNormal);
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
