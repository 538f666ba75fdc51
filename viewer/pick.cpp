#include "viewer/pick.h"

#include "driver/verdict.h"
#include "viewer/lines.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

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
        case ir::ShapeKind::Instances:
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

std::optional<SourceId> source_named(const Sources &sources, const std::string &name) {
    for (std::size_t i = 0; i < sources.size(); ++i)
        if (sources[SourceId{i}].name == name) return SourceId{i};
    return std::nullopt;
}

std::vector<Part> parts_in(const driver::Compilation &compilation, SourceId source) {
    std::vector<Part> parts;
    for (std::size_t i = 1; i <= compilation.parts.shapes.size(); ++i)
        if (Part part = part_of(compilation, static_cast<int>(i)); part.place.source == source)
            parts.push_back(std::move(part));
    return parts;
}

} // namespace

Part part_of(const driver::Compilation &compilation, int number) {
    Part part;
    if (number < 1 || static_cast<std::size_t>(number) > compilation.parts.shapes.size())
        return part;
    const ir::ShapeId id = compilation.parts.shapes[static_cast<std::size_t>(number) - 1];
    const Span span = written(compilation, id);
    part.number = number;
    if (span.source) {
        const Source &source = compilation.sources[span.source];
        part.words = one_line(text(compilation.sources, span));
        part.place = span;
        if (source.made_from) {
            part.file = compilation.sources[source.made_from].name;
        } else {
            const Position place = position(source, span.begin);
            part.file = source.name;
            part.line = place.line;
            part.column = place.column;
        }
    }
    const ir::ShapeFact &fact = compilation.scene.facts[id.index];
    part.lipschitz = fact.lipschitz_sup;
    part.status = fact.status;
    part.kind = fact.kind;
    return part;
}

Part part_at(const driver::Compilation &compilation, const std::string &file, std::uint32_t byte) {
    Part found;
    const std::optional<SourceId> source = source_named(compilation.sources, file);
    if (!source) return found;
    for (Part &part : parts_in(compilation, *source))
        if (part.place.begin <= byte && byte <= part.place.end &&
            (!found.number ||
             part.place.end - part.place.begin < found.place.end - found.place.begin))
            found = std::move(part);
    return found;
}

Part found_again(const driver::Compilation &before, const Part &part,
                 const driver::Compilation &now) {
    if (!part.number || !part.place.source) return {};
    const Source &old_text = before.sources[part.place.source];
    const std::optional<SourceId> source = source_named(now.sources, old_text.name);
    if (!source) return {};
    const std::vector<std::uint32_t> to = lines_after(old_text.text, now.sources[*source].text);
    const std::uint32_t old_line = position(old_text, part.place.begin).line;
    const std::vector<Part> then = parts_in(before, part.place.source),
                            all = parts_in(now, *source);
    const auto with = [](const std::vector<Part> &parts, const Sources &sources, std::uint32_t line,
                         const std::string *words) {
        std::vector<Part> found;
        for (const Part &other : parts)
            if (position(sources[other.place.source], other.place.begin).line == line &&
                (!words || other.words == *words))
                found.push_back(other);
        return found;
    };
    // The turn of the part among those before is its turn among those after.
    const auto by_turn = [&](const std::vector<Part> &old_ones,
                             const std::vector<Part> &fresh) -> Part {
        if (fresh.size() != old_ones.size()) return fresh.size() == 1 ? fresh[0] : Part{};
        for (std::size_t i = 0; i < fresh.size(); ++i)
            if (old_ones[i].number == part.number) return fresh[i];
        return {};
    };
    if (const std::uint32_t line = to[old_line]) {
        const std::vector<Part> same = with(all, now.sources, line, &part.words);
        if (!same.empty()) {
            const Part found = by_turn(with(then, before.sources, old_line, &part.words), same);
            return found.number ? found : same[0]; // copies that became more, or fewer
        }
        return by_turn(with(then, before.sources, old_line, nullptr),
                       with(all, now.sources, line, nullptr));
    }
    std::vector<Part> moved;
    for (const Part &other : all) {
        const std::uint32_t line = position(now.sources[*source], other.place.begin).line;
        if (other.words == part.words && std::find(to.begin(), to.end(), line) == to.end())
            moved.push_back(other);
    }
    return moved.size() == 1 ? moved[0] : Part{};
}

ir::Box world_box(const ir::Scene &scene, ir::ShapeId part, double time) {
    Search search{scene, part, time};
    search.visit(scene.root, identity);
    return search.found;
}

std::string place_of(const Part &part) {
    return part.line == 0 ? part.file : fmt::format("{}:{}", part.file, part.line);
}

std::string part_line(const Part &part) {
    const char *kind = part.kind == ir::FieldKind::Exact ? ", exact" : "";
    return fmt::format("{} | L {:.4g} {}{} | {}", part.words, part.lipschitz,
                       driver::status_name(part.status), kind, place_of(part));
}

} // namespace fathom::viewer
