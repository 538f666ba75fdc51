// Changes that keep the meaning, done to every scene that is at hand: the new text compiles, and its
// field has the same values.
#include "client.h"
#include "scenes.h"

#include "api/language/refactor.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace {

using namespace fathom::language;
using fathom::Span;

struct Read {
    Syntax syntax;
    Names names;
};
Read read(const std::string &text) {
    Read out{read_syntax(text), {}};
    out.names = names_of(out.syntax.ast);
    return out;
}

struct Tally {
    int done = 0, refused = 0; // by the compiler, where it took the text before
    std::vector<std::string> first_refused;
};

// `same`: what has to hold of the values before and now.
template <class Same> void try_out(Workspace &workspace, const SceneText &scene,
                                   const Values &values, const std::optional<CodeAction> &one,
                                   Tally &tally, Same same) {
    if (!one) return;
    const std::string after = edited(scene.text, one->edits);
    const auto now = values_of(workspace, scene.path, after);
    if (!now) {
        ++tally.refused;
        if (tally.first_refused.size() < 12)
            tally.first_refused.push_back(scene.path + "\n" + after);
        return;
    }
    ++tally.done;
    INFO(scene.path << ": " << one->title << "\n" << after);
    CHECK(same(values, *now));
}

bool same_solid(const Values &a, const Values &b) {
    return std::ranges::equal(a.distances, b.distances, [](float x, float y) {
        return (x < 0) == (y < 0) || std::abs(x - y) < 1e-4f;
    });
}
bool equal(const Values &a, const Values &b) { return a == b; }
// A bound holds for all of a param's range, and is looser where a function hides what the proof knows
// of a whole expression: then distances are smaller, and the solid is the same.
bool equal_but_for_bounds(const Values &a, const Values &b) {
    return a.bound == b.bound ? a.distances == b.distances : same_solid(a, b);
}

} // namespace

TEST_CASE("every declaration of a text can have another name") {
    Workspace workspace;
    int scenes = 0, renamed = 0;
    for (const SceneText &scene : scene_texts()) {
        const auto values = values_of(workspace, scene.path, scene.text);
        if (!values) continue;
        const Read before = read(scene.text);
        std::vector<TextEdit> edits;
        std::vector<bool> doubtful(before.names.declarations.size());
        for (const Use &use : before.names.uses)
            if (use.doubtful) doubtful[*use.declaration] = true;
        const auto rename = [&](Span at, std::size_t declaration) {
            const Declaration &declared = before.names.declarations[declaration];
            // a param's name is the shader's, a function's may be what -D or another file says
            if (declared.name.empty() || doubtful[declaration]) return;
            edits.push_back(
                {{at.begin, at.end}, declared.name + "_" + std::to_string(declaration)});
        };
        for (std::size_t i = 0; i < before.names.declarations.size(); ++i)
            rename(before.names.declarations[i].at, i);
        renamed += static_cast<int>(edits.size());
        for (const Use &use : before.names.uses)
            if (use.declaration) rename(use.at, *use.declaration);
        const std::string after = edited(scene.text, edits);
        INFO(scene.path << "\n" << after);
        CHECK(values_of(workspace, scene.path, after) == values);
        ++scenes;
    }
    CHECK(scenes > 70);
    CHECK(renamed > 500);
}

TEST_CASE("what is extracted and put back in has the same field") {
    Workspace workspace;
    Tally lets, functions, params, inlined, units;
    std::mt19937 random(7);
    for (const SceneText &scene : scene_texts()) {
        if (scene.text.size() > 3000) continue; // one compilation each, so small ones
        const auto values = values_of(workspace, scene.path, scene.text);
        if (!values) continue;
        const Read before = read(scene.text);
        std::vector<Span> spans;
        for (const fathom::lang::Expr &e : before.syntax.ast.exprs) spans.push_back(e.span);
        for (int i = 0; i < fathom::test::effort(1) && !spans.empty(); ++i) {
            const Span at = spans[random() % spans.size()];
            try_out(workspace, scene, *values,
                    extract_let(before.syntax, before.names, at.begin, at.end), lets, equal);
            try_out(workspace, scene, *values,
                    extract_function(before.syntax, before.names, at.begin, at.end), functions,
                    equal_but_for_bounds);
            try_out(workspace, scene, *values,
                    extract_param(before.syntax, before.names, at.begin, at.end), params,
                    same_solid);
        }
        for (const fathom::lang::Expr &e : before.syntax.ast.exprs) {
            const std::vector<CodeAction> other = convert_units(before.syntax, e.span.begin);
            if (other.empty() || !std::holds_alternative<fathom::lang::Number>(e.kind)) continue;
            for (const CodeAction &one : other)
                try_out(workspace, scene, *values, one, units, same_solid);
            break; // one a scene
        }
        for (int i = 0; i < fathom::test::effort(1) && !before.names.declarations.empty(); ++i) {
            const std::size_t at = random() % before.names.declarations.size();
            try_out(workspace, scene, *values,
                    inline_let(before.syntax, before.names, before.names.declarations[at].at.begin),
                    inlined, equal);
        }
    }
    const auto report = [](const char *what, const Tally &tally) {
        std::string text = std::string(what) + ": " + std::to_string(tally.done) + " done, " +
                           std::to_string(tally.refused) + " refused";
        if (std::getenv("FATHOM_SHOW_REFUSED"))
            for (const std::string &one : tally.first_refused) text += "\n---- " + one;
        WARN(text);
        // what the compiler refuses is not offered (actions.cpp); it is the exception
        CHECK(tally.done > 4 * tally.refused);
    };
    report("let", lets);
    report("function", functions);
    report("inline", inlined);
    CHECK(lets.done > 50);
    CHECK(functions.done > 50);
    CHECK(inlined.done > 20);
    CHECK(units.done > 20);
    CHECK(units.refused == 0);
    CHECK(params.done > 10);
}
