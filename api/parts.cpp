#include "api/parts.h"

#include "ir/lower/lower.h"

#include <fathom/parts.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace fathom::v1 {
namespace {

bool is_word(char c, bool first) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           (!first && c >= '0' && c <= '9');
}

std::string first_word(std::string_view text) {
    std::size_t end = 0;
    while (end < text.size() && is_word(text[end], end == 0)) ++end;
    return end == 0 ? "part" : std::string(text.substr(0, end));
}

// What is known of a union of shapes, by what is known of each.
ir::ShapeFact fact_of_union(ir::Scene &scene, const std::vector<ir::TopLevel> &shapes) {
    ir::ShapeFact fact;
    fact.lipschitz_sup = 0;
    fact.bounds = {};
    for (const ir::TopLevel &top : shapes) {
        const ir::ShapeFact &child = scene.facts[top.shape.index];
        fact.status = std::max(fact.status, child.status);
        fact.lipschitz_sup = std::max(fact.lipschitz_sup, child.lipschitz_sup);
        fact.bounds = ir::hull(fact.bounds, child.bounds);
    }
    fact.lipschitz = scene.graph.number(fact.lipschitz_sup);
    return fact;
}

// Leaves of a proved scene those shapes alone, and lowers it again. The facts of each hold as they
// are, since a union divides each of its parts by its own bound.
void keep_only(ir::Scene &scene, const std::vector<ir::TopLevel> &shapes) {
    ir::Shape all;
    std::set<ir::ShapeId> seen;
    for (const ir::TopLevel &top : shapes)
        if (seen.insert(top.shape).second) all.children.push_back(top.shape);
    if (all.children.size() == 1) {
        scene.root = all.children[0];
    } else {
        all.kind = ir::ShapeKind::Union;
        scene.root = scene.shapes.add(std::move(all));
        if (scene.facts.size() < scene.shapes.size())
            scene.facts.push_back(fact_of_union(scene, shapes));
    }
    scene.top_level = shapes;
    scene.framed = {};
    scene.framed_reach.clear();
    ir::lower(scene);
}

} // namespace

std::vector<Statement> statements_of(const Scene &scene) {
    const Sources &sources = scene.impl().compilation->sources;
    std::vector<Statement> statements;
    std::map<std::array<std::uint32_t, 3>, std::size_t> known;
    for (const ir::TopLevel &top : ir_of(scene).top_level) {
        const auto [place, fresh] = known.try_emplace(
            {top.span.source.index, top.span.begin, top.span.end}, statements.size());
        if (fresh) statements.push_back({"", top.span, {}});
        statements[place->second].shapes.push_back(top);
    }
    std::map<std::string, int> counts;
    for (Statement &statement : statements) {
        const std::string word =
            first_word(statement.span.source ? text(sources, statement.span) : std::string_view());
        const int count = ++counts[word];
        statement.name = count == 1 ? word : fmt::format("{}#{}", word, count);
    }
    return statements;
}

Scene scene_of(const Scene &whole, const Statement &statement) {
    auto impl = std::make_shared<Scene::Impl>(whole.impl());
    impl->part = statement.name;
    const auto part = std::make_shared<ir::Scene>(*whole.impl().scene);
    keep_only(*part, statement.shapes);
    impl->facts = facts_of(*part, impl->compilation->sources);
    impl->scene = part;
    return Scene(std::move(impl));
}

std::vector<Part> parts_of(const Scene &scene) noexcept {
    return guarded(
        [&] {
            std::vector<Part> parts;
            for (const Statement &statement : statements_of(scene))
                parts.push_back(
                    {statement.name, place_of(statement.span, scene.impl().compilation->sources)});
            return parts;
        },
        [](const Diagnostic &) { return std::vector<Part>(); });
}

std::optional<Scene> part_of(const Scene &scene, std::string_view name) noexcept {
    return guarded(
        [&]() -> std::optional<Scene> {
            const std::vector<Statement> statements = statements_of(scene);
            const auto found = std::ranges::find(statements, name, &Statement::name);
            if (found == statements.end()) return std::nullopt;
            return scene_of(scene, *found);
        },
        [](const Diagnostic &) { return std::optional<Scene>(); });
}

} // namespace fathom::v1
