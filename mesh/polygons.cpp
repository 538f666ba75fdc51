#include "mesh/polygons.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double slack = 1e-9; // of shares; what is nearer to a border counts as beyond it

// A point seen along an edge: how far across in both axes, and how far along.
struct SeenAlong {
    double b = 0, c = 0, a = 0;
};
double cross(const SeenAlong &x, const SeenAlong &y) { return x.b * y.c - x.c * y.b; }

struct Edge {
    std::size_t a = 0, b = 0, c = 0; // axes
    double low = 0, high = 0, at_b = 0, at_c = 0;
    SeenAlong seen(const Point &p) const { return {p[b] - at_b, p[c] - at_c, p[a]}; }
    double share(double along) const { return (along - low) / (high - low); }
};

// Whether the way from x to y goes through the triangle of the edge and z, or through the edge.
bool passes(const Edge &edge, const SeenAlong &x, const SeenAlong &y, const SeenAlong &z) {
    const double from = cross(x, z), to = cross(y, z);
    if (!(from * to < 0)) return false;
    const double t = from / (from - to);
    const SeenAlong at{x.b + t * (y.b - x.b), x.c + t * (y.c - x.c), x.a + t * (y.a - x.a)};
    const double r = (at.b * z.b + at.c * z.c) / (z.b * z.b + z.c * z.c);
    if (!(t > slack && t < 1 - slack && r >= 0 && r < 1 - slack)) return false;
    const double low = edge.low + r * (z.a - edge.low), high = edge.high + r * (z.a - edge.high);
    const double gap = slack * (edge.high - edge.low);
    return at.a > low + gap && at.a < high - gap;
}

// Whether the edge goes through a triangle, or through its side between x and y.
bool pierces(const Edge &edge, const SeenAlong &x, const SeenAlong &y, const SeenAlong &z) {
    const double whole = cross(x, y) + cross(y, z) + cross(z, x);
    if (whole == 0) return false;
    const double wx = cross(y, z) / whole, wy = cross(z, x) / whole, wz = cross(x, y) / whole;
    if (!(wx > slack && wy > slack && wz >= 0)) return false;
    const double share = edge.share(wx * x.a + wy * y.a + wz * z.a);
    return share > slack && share < 1 - slack;
}

// The cosine between the triangles (x, y, z) and (x, z, w).
double flatness(const Point &x, const Point &y, const Point &z, const Point &w) {
    const auto normal = [](const Point &p, const Point &q, const Point &r) {
        std::array<double, 3> u{}, v{};
        for (std::size_t i = 0; i < 3; ++i) u[i] = double(q[i]) - p[i], v[i] = double(r[i]) - p[i];
        return std::array<double, 3>{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                     u[0] * v[1] - u[1] * v[0]};
    };
    const auto m = normal(x, y, z), n = normal(x, z, w);
    const auto dot = [](const auto &p, const auto &q) {
        return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    };
    const double size = std::sqrt(dot(m, m) * dot(n, n));
    return size > 0 ? dot(m, n) / size : -1;
}

struct Polygons {
    const Lattice &lattice;
    const Loops &loops;
    const Vertices &vertices;
    Mesh mesh;
    std::vector<std::uint32_t> face_vertex; // by segment

    const Point &at(std::uint32_t v) const { return mesh.vertices[v]; }

    std::uint32_t add(const Point &p, const Point &normal) {
        mesh.vertices.push_back(p);
        mesh.normals.push_back(normal);
        return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    }

    // Two triangles in place of a quadrilateral, along the diagonal that bends it less; false where
    // neither stays among the four cells' own parts.
    bool two(const Edge &edge, const std::array<std::uint32_t, 4> &v) {
        std::array<SeenAlong, 4> s;
        for (std::size_t k = 0; k < 4; ++k) s[k] = edge.seen(at(v[k]));
        double best = -2;
        std::size_t from = 4;
        for (std::size_t k = 0; k < 2; ++k) { // the diagonal from k to k + 2
            const SeenAlong &x = s[k], &y = s[k + 1], &z = s[k + 2], &w = s[(k + 3) % 4];
            const bool by_y = passes(edge, x, z, y) && pierces(edge, z, x, w);
            const bool by_w = passes(edge, x, z, w) && pierces(edge, x, z, y);
            if (!by_y && !by_w) continue;
            const double flat = flatness(at(v[k]), at(v[k + 1]), at(v[k + 2]), at(v[(k + 3) % 4]));
            if (flat > best) best = flat, from = k;
        }
        if (from == 4) return false;
        mesh.triangles.push_back({v[from], v[from + 1], v[from + 2]});
        mesh.triangles.push_back({v[from], v[from + 2], v[(from + 3) % 4]});
        return true;
    }

    void around(std::size_t number) {
        const Crossing &crossing = loops.crossings[number];
        std::array<std::uint32_t, 4> v{}; // the cells about the edge, each once
        std::array<std::int32_t, 4> between{};
        std::size_t count = 0;
        bool plain = true;
        for (std::size_t k = 0; k < 4; ++k) {
            if (crossing.segments[k] == none) continue;
            v[count] = static_cast<std::uint32_t>(crossing.patches[k]);
            between[count] = crossing.segments[k];
            plain = plain && !vertices.has_face[static_cast<std::size_t>(crossing.segments[k])];
            ++count;
        }
        if (!crossing.low_inside) { // the surface looks down the axis
            std::reverse(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count));
            // between[k] lies between v[k] and v[k + 1]; the last one closes the round.
            std::reverse(between.begin(), between.begin() + static_cast<std::ptrdiff_t>(count) - 1);
        }
        Edge edge;
        edge.a = crossing.axis, edge.b = (edge.a + 1) % 3, edge.c = (edge.a + 2) % 3;
        edge.low = lattice.at(edge.a, crossing.low[edge.a]);
        edge.high = lattice.at(edge.a, crossing.low[edge.a] + crossing.length);
        edge.at_b = lattice.at(edge.b, crossing.low[edge.b]);
        edge.at_c = lattice.at(edge.c, crossing.low[edge.c]);
        if (plain && count == 4 && two(edge, v)) return;
        if (plain && count == 3 &&
            pierces(edge, edge.seen(at(v[0])), edge.seen(at(v[1])), edge.seen(at(v[2])))) {
            mesh.triangles.push_back({v[0], v[1], v[2]});
            return;
        }
        const std::uint32_t middle = add(vertices.on_edge[number], vertices.edge_normals[number]);
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t from = v[k], to = v[(k + 1) % count];
            const std::uint32_t face = face_vertex[static_cast<std::size_t>(between[k])];
            if (face == 0) {
                mesh.triangles.push_back({middle, from, to});
            } else {
                mesh.triangles.push_back({middle, from, face});
                mesh.triangles.push_back({middle, face, to});
            }
        }
    }
};

} // namespace

Mesh make_polygons(const Lattice &lattice, const Loops &loops, const Vertices &vertices) {
    Polygons polygons{lattice, loops, vertices, {}, {}};
    polygons.mesh.vertices = vertices.in_cell;
    polygons.mesh.normals = vertices.cell_normals;
    polygons.face_vertex.resize(loops.segments.size(), 0); // 0 is a cell's: here, none
    for (std::size_t s = 0; s < loops.segments.size(); ++s)
        if (vertices.has_face[s])
            polygons.face_vertex[s] = polygons.add(
                vertices.on_face[s],
                vertices.edge_normals[static_cast<std::size_t>(loops.segments[s].crossings[0])]);
    polygons.mesh.triangles.reserve(2 * loops.crossings.size());
    for (std::size_t c = 0; c < loops.crossings.size(); ++c) polygons.around(c);
    return std::move(polygons.mesh);
}

} // namespace fathom::mesh
