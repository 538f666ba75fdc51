// Where the vertices of a mesh lie: one for each patch of surface, in its cell, by the planes in
// which the surface crosses the cell's edges; and those on edges and faces that some polygons need.
#pragma once

#include "mesh/loops.h"

namespace fathom::mesh {

struct Vertices {
    // By crossing: the point on the edge, strictly between its ends; where the surface crosses it,
    // at one of its ends perhaps; and its normal there, of length 1.
    std::vector<Point> on_edge, roots, edge_normals;
    // By crossing: the field changes its sign on the edge no farther than this from the root.
    std::vector<float> root_slack;
    // By patch: strictly inside of its cell; the mean of its crossings' normals, of length 1.
    std::vector<Point> in_cell, cell_normals;
    // By segment: whether it has a vertex of its own on its face, and where: strictly inside of it.
    // Without one the straight way between the two cells' vertices goes through the face.
    std::vector<std::uint8_t> has_face;
    std::vector<Point> on_face;
};

Vertices place_vertices(const Octree &octree, const Field &field, const Loops &loops,
                        unsigned threads, Progress &progress);

// The least distance that a vertex keeps from the borders of a cell, edge or face of that side.
double margin_of(const Lattice &lattice, double side);

} // namespace fathom::mesh
