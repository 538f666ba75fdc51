// How a mesh's surface looks: which material each triangle has, and the colours of its corners.
#pragma once

#include "mesh/polygons.h"

#include <string>

namespace fathom::mesh {

// Colours are linear, 0..1, emission from 0 on; of what is no number, 0.
struct Material {
    std::string name; // of `material(name:)`; else its colour, as `d94f2b`, `paint` where it has
                      // several, `unpainted` where nobody painted
    Point diffuse{}, specular{}, emission{};
    float exponent = 0; // of Phong's highlight
    // The diffuse colour differs from corner to corner; `diffuse` is its mean.
    bool colored = false;
    // So do other properties, whose means stand here.
    bool varies = false;
    friend bool operator==(const Material &, const Material &) = default;
};

struct Appearance {
    std::vector<Point> colors; // by vertex, which has one: where two paints meet, either's
    std::vector<std::array<Point, 3>> corners; // by triangle: what its own paint has there
    std::vector<Material> materials;           // in the order of the scene's surfaces
    std::vector<std::uint32_t> material_of;    // by triangle
};

// `arm` is a length that is small for the mesh. A triangle's paint is that of its vertices where they
// agree, else that of its middle.
Appearance appearance_of(const ir::Scene &scene, double time, const Mesh &mesh, double arm);

// Its `colors` alone.
std::vector<Point> colors_of(const ir::Scene &scene, double time, const Mesh &mesh, double arm);

// A corner takes the field's gradient at its vertex where it is within 30 degrees of the triangle's
// own normal, and that else: at a crease each side has its own.
inline constexpr double crease_cosine = 0.8660254;
// The normal of a triangle; (0, 0, 1) where it has none.
Point face_normal(const Point &a, const Point &b, const Point &c);
bool at_crease(const Point &vertex_normal, const Point &face);

} // namespace fathom::mesh
