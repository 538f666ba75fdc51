// Shapes to functions. The one place that knows what each ShapeKind computes; after it a back end
// sees only expressions, functions and loops.
//
// Five readings of a shape (semantics.md, 10 and 11):
//   raw      the field itself, which offsets, blends and displacements consume
//   marched  the distance that rays use. It goes through the outermost min/max tree (Union,
//            Intersection, Complement, Xor, Paint, Repeat, Instances, Library without claims, Extrude,
//            and Maps that keep or undo lengths: rigid, uniformly scaled, MirrorFold, Revolve) down to
//            its leaves, each divided there by its own bound (facts[s].lipschitz). Within answers
//            by its region, with its child's bound, which has to hold in the region; `guard`ed
//            shapes by max with their box's distance
//   hit      marched, carrying which surface decides
//   shaded   what normals, occlusion and penumbrae look at: marched, but no bound above 1 divides it,
//            so that a looser proof changes no picture; a field of one's own is read over its slope
//            at the surface, and what is scaled by a vector as its distance (shaded.cpp). Equal to
//            marched where none of this is
//   radius   marched, and the safe radius by curvature (shading.h); only where some displacement
//            has it, and through the shapes that safe_radius.cpp names
// A shape evaluated at more than one point becomes a function of its own (named after its library
// call or place); so the lowered scene is linear in the shapes. Complete only after the analysis
// has filled `facts`.
#pragma once

#include "ir/scene.h"

namespace fathom::ir {

// Fills the functions of a scene (raw, marched, hit, shaded, safe radius) from its shapes and facts.
void lower(Scene &scene);

// By index into the surfaces of a lowered scene: what its material is called, where it has a name.
std::vector<std::string> surface_names(const Scene &scene);

// Lowered so that a hit also tells which part of the scene it is on: the innermost operand of a
// union, a blend or another combination. A hit's paint, where it is not negative, then holds two
// numbers: code + stride * part, where the code stride - 1 says that nobody painted; part 0 is
// none, part n is shapes[n - 1]. Only who decodes them (backend-glsl's Options::part_stride) may
// expression_of for it.
struct Parts {
    std::vector<ShapeId> shapes;
    int stride = 0;
};
Parts lower_with_parts(Scene &scene);

// The shapes that marching divides by bounds above `steeper_than`, each once, and what it divides:
// the raw field at Point, of a region that of what is in it. Only those for which bounds by cells
// (CellBounds) may be found: proved, with an end, and the same for all that uses them.
struct DividedField {
    ShapeId shape;
    NodeId field;
};
std::vector<DividedField> divided_fields(Scene &scene, double steeper_than);

// Signed distance of a region, exact, negative inside; and the point of the convex part nearest to
// p (p itself inside).
NodeId region_distance(Graph &graph, const Region &region, NodeId p);
NodeId region_nearest(Graph &graph, const Region &region, NodeId p);

} // namespace fathom::ir
