#include "viewer/pick.h"

#include "driver/verdict.h"

#include <cmath>
#include <fmt/format.h>

namespace fathom::viewer {
namespace {

constexpr std::size_t longest_words = 60;

std::string one_line(std::string_view text) {
    std::string result;
    for (char c : text) {
        const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (space && (result.empty() || result.back() == ' ')) continue;
        result += space ? ' ' : c;
    }
    if (result.size() <= longest_words) return result;
    std::size_t end = longest_words;
    while (end > 0 && (static_cast<unsigned char>(result[end]) & 0xc0) == 0x80)
        --end;                            // no half of a letter
    return result.substr(0, end) + "..."; // the panels' font has no ellipsis
}

// The place that the user wrote: the part's own, or that of what it is made from, where the first
// lies in the library.
Span written(const driver::Compilation &compilation, ir::ShapeId id) {
    const auto in_a_file = [&](const Span &span) {
        if (!span.source || span.source.index >= compilation.sources.size()) return false;
        const Source &source = compilation.sources[span.source];
        for (const typecheck::LibraryFile &file : driver::standard_library())
            if (file.name == source.name && file.text == source.text) return false;
        return span.end > span.begin;
    };
    const ir::Scene &scene = compilation.scene;
    for (ir::ShapeId at = id;;) {
        const ir::Shape &shape = scene.shapes[at];
        // What is taken away stands where it was written, not where it is taken away.
        const bool inverted = shape.kind == ir::ShapeKind::Complement && !shape.children.empty();
        if (!inverted && in_a_file(shape.origin)) return shape.origin;
        if (shape.children.empty()) break;
        at = shape.children.front();
    }
    for (const ir::TopLevel &top : scene.top_level)
        if (in_a_file(top.span)) return top.span;
    return {};
}

using Matrix = std::array<double, 12>; // rows: x' = m[0..2].x + m[3], …
constexpr Matrix identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Matrix times(const Matrix &a, const Matrix &b) { // b first
    Matrix result{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            double sum = column == 3 ? a[row * 4 + 3] : 0;
            for (std::size_t k = 0; k < 3; ++k) sum += a[row * 4 + k] * b[k * 4 + column];
            result[row * 4 + column] = sum;
        }
    return result;
}

ir::Box moved(const ir::Box &box, const Matrix &by) {
    ir::Box result;
    for (int corner = 0; corner < 8; ++corner) {
        std::array<double, 3> p{};
        for (std::size_t i = 0; i < 3; ++i) p[i] = corner >> i & 1 ? box.hi[i] : box.lo[i];
        ir::Box point;
        for (std::size_t row = 0; row < 3; ++row) {
            double sum = by[row * 4 + 3];
            for (std::size_t k = 0; k < 3; ++k) sum += by[row * 4 + k] * p[k];
            point.lo[row] = point.hi[row] = sum;
        }
        result = ir::hull(result, point);
    }
    return result;
}

struct Search {
    const ir::Scene &scene;
    ir::ShapeId part;
    double time;
    ir::Box found{};
    int budget = 20000; // visits: a part may stand below many others in many ways

    bool contains(ir::ShapeId id) const {
        if (id == part) return true;
        for (ir::ShapeId child : scene.shapes[id].children)
            if (child.index >= part.index && contains(child))
                return true; // children come before their parents
        return false;
    }

    void visit(ir::ShapeId id, const Matrix &to_world) {
        if (id.index < part.index || --budget < 0) return;
        const ir::Box &box = scene.facts[id.index].bounds;
        if (id == part) {
            if (box.finite() && !box.empty()) found = ir::hull(found, moved(box, to_world));
            return;
        }
        const ir::Shape &shape = scene.shapes[id];
        Matrix own = identity;
        switch (shape.kind) {
        case ir::ShapeKind::Map: {
            const bool solid = shape.dims == 3;
            const bool known = solid && shape.args.size() > 2 &&
                               scene.graph.reads(shape.args[2]).free_vars == false;
            const bool linear = shape.map == ir::MapKind::Translate ||
                                shape.map == ir::MapKind::Rotate || shape.map == ir::MapKind::Scale;
            if (!known || !linear) return whole(id, box, to_world);
            const std::array<double, 16> v = ir::value_of(scene, shape.args[2], time);
            for (std::size_t i = 0; i < 3; ++i) {
                if (shape.map == ir::MapKind::Translate) own[i * 4 + 3] = v[i];
                if (shape.map == ir::MapKind::Scale) own[i * 5] = v[i];
                if (shape.map == ir::MapKind::Rotate)
                    for (std::size_t k = 0; k < 3; ++k)
                        own[i * 4 + k] = v[k * 3 + i]; // column-major
            }
            break;
        }
        case ir::ShapeKind::Repeat:
        case ir::ShapeKind::Many:
        case ir::ShapeKind::Extrude:
            return whole(id, box, to_world); // the copies, or the solid, together
        case ir::ShapeKind::Empty:
        case ir::ShapeKind::Leaf:
        case ir::ShapeKind::Union:
        case ir::ShapeKind::Intersection:
        case ir::ShapeKind::Complement:
        case ir::ShapeKind::Xor:
        case ir::ShapeKind::Blend:
        case ir::ShapeKind::Seam:
        case ir::ShapeKind::Lerp:
        case ir::ShapeKind::PseudoNorm:
        case ir::ShapeKind::Offset:
        case ir::ShapeKind::Shell:
        case ir::ShapeKind::Displace:
        case ir::ShapeKind::Within:
        case ir::ShapeKind::Paint:
        case ir::ShapeKind::Repaint:
        case ir::ShapeKind::Mixed:
        case ir::ShapeKind::Library:
        case ir::ShapeKind::Contract: break;
        }
        const Matrix below = times(to_world, own);
        for (ir::ShapeId child : shape.children) visit(child, below);
    }

    // Where a map bends or copies space: all that it makes of the part.
    void whole(ir::ShapeId id, const ir::Box &box, const Matrix &to_world) {
        if (contains(id) && box.finite() && !box.empty())
            found = ir::hull(found, moved(box, to_world));
    }
};

} // namespace

Part part_of(const driver::Compilation &compilation, int number) {
    Part part;
    if (number < 1 || static_cast<std::size_t>(number) > compilation.parts.shapes.size())
        return part;
    const ir::ShapeId id = compilation.parts.shapes[static_cast<std::size_t>(number) - 1];
    const Span span = written(compilation, id);
    part.number = number;
    if (span.source) {
        const Position place = position(compilation.sources[span.source], span.begin);
        part.words = one_line(text(compilation.sources, span));
        part.file = compilation.sources[span.source].name;
        part.line = place.line;
        part.column = place.column;
    }
    const ir::ShapeFact &fact = compilation.scene.facts[id.index];
    part.lipschitz = fact.lipschitz_sup;
    part.status = fact.status;
    part.kind = fact.kind;
    return part;
}

Part found_again(const driver::Compilation &compilation, const Part &part) {
    Part best;
    int best_score = 0;
    for (std::size_t i = 1; part.number && i <= compilation.parts.shapes.size(); ++i) {
        Part other = part_of(compilation, static_cast<int>(i));
        if (other.file != part.file) continue;
        const int score = 2 * (other.words == part.words) + (other.line == part.line);
        if (score <= best_score) continue;
        best_score = score;
        best = std::move(other);
    }
    return best;
}

ir::Box world_box(const ir::Scene &scene, ir::ShapeId part, double time) {
    Search search{scene, part, time};
    search.visit(scene.root, identity);
    return search.found;
}

std::string part_line(const Part &part) {
    const char *kind = part.kind == ir::FieldKind::Exact ? ", exact" : "";
    return fmt::format("{} | L {:.4g} {}{} | {}:{}", part.words, part.lipschitz,
                       driver::status_name(part.status), kind, part.file, part.line);
}

} // namespace fathom::viewer
