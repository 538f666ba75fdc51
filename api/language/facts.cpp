// What is known and proved of a text: hover, bounds, their explanation, names of arguments.
#include "api/language/features.h"

#include "api/language/calls.h"

#include "driver/verdict.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::language {
namespace {

// What a stretch of the text makes at its top level: the steepest shape, and how many there are.
struct Made {
    Span span;
    ir::ShapeId shape;
    int count = 0;
};

// By place. Only what a bound is proved of; also where other statements are wrong.
std::vector<Made> shapes_of(const Document &document, const Compiled &result) {
    const ir::Scene &scene = result.compilation.scene;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Made> made;
    for (const ir::TopLevel &top : scene.top_level) {
        if (top.shape.index >= scene.facts.size() || !top.span.source ||
            result.compilation.sources[top.span.source].name != document.path)
            continue;
        const double bound = scene.facts[top.shape.index].lipschitz_sup;
        if (!std::isfinite(bound)) continue;
        Made &here = made[{top.span.begin, top.span.end}];
        if (here.count++ == 0 || bound > scene.facts[here.shape.index].lipschitz_sup)
            here.span = top.span, here.shape = top.shape;
    }
    std::vector<Made> shapes;
    for (const auto &[span, here] : made) shapes.push_back(here);
    return shapes;
}

// The call whose function's name holds or touches a byte; an empty stretch where there is none.
Span call_named_at(Document &document, std::size_t offset) {
    const lang::Ast &ast = reading(document).syntax.ast;
    const auto at = static_cast<std::uint32_t>(offset);
    Span call{};
    for (const Step &step : path_to(ast, at, at)) {
        const auto *made =
            step.expr ? std::get_if<lang::Call>(&ast.exprs[step.expr].kind) : nullptr;
        if (!made) continue;
        const lang::Expr &callee = ast.exprs[made->callee];
        const auto *member = std::get_if<lang::Member>(&callee.kind);
        const Span name = member ? member->name.span : callee.span;
        if (name.begin <= at && at <= name.end) call = step.span(ast);
    }
    return call;
}

// Of the shapes of the scene that a call made, the steepest; none where it made none that is seen,
// or one without a bound.
ir::ShapeId steepest_made_by(const Document &document, const Compiled &result, Span call) {
    const ir::Scene &scene = result.compilation.scene;
    ir::ShapeId steepest;
    if (call.begin == call.end) return steepest;
    std::vector<bool> seen(scene.facts.size());
    std::vector<ir::ShapeId> todo;
    for (const ir::TopLevel &top : scene.top_level) todo.push_back(top.shape);
    while (!todo.empty()) {
        const ir::ShapeId id = todo.back();
        todo.pop_back();
        if (id.index >= seen.size() || seen[id.index]) continue;
        seen[id.index] = true;
        const ir::Shape &shape = scene.shapes[id];
        todo.insert(todo.end(), shape.children.begin(), shape.children.end());
        const double bound = scene.facts[id.index].lipschitz_sup;
        if (shape.origin.source && shape.origin.begin == call.begin &&
            shape.origin.end == call.end && std::isfinite(bound) &&
            result.compilation.sources[shape.origin.source].name == document.path &&
            (!steepest || bound > scene.facts[steepest.index].lipschitz_sup))
            steepest = id;
    }
    return steepest;
}

// Of what is cut to a region (`within:`) that of the field inside.
std::optional<std::string> region_of(const proof::Explanation &node, ir::ShapeId shape) {
    if (node.shape == shape)
        return node.operation == "within" && !node.children.empty() ? node.children[0].region
                                                                    : node.region;
    for (const proof::Explanation &child : node.children)
        if (auto found = region_of(child, shape)) return found;
    return std::nullopt;
}

std::string numbers(double number) { return fmt::format("{:.4g}", number); }

std::string facts_in_words(const ir::ShapeFact &fact) {
    return fmt::format(
        "bound {}, {}, {}", numbers(fact.lipschitz_sup), driver::status_name(fact.status),
        fact.kind == ir::FieldKind::Exact ? "exact" : "a lower bound of the distance");
}

// The region that a bound was proved over, what it costs a ray, and where the solid lies.
std::string more_in_words(Workspace &workspace, Document &document, ir::ShapeId shape) {
    const ir::Scene &scene = compiled(workspace, document).compilation.scene;
    const ir::ShapeFact &fact = scene.facts[shape.index];
    std::string text;
    if (const auto region = fact.kind == ir::FieldKind::Exact
                                ? std::optional<std::string>("everywhere")
                                : region_of(explanation(workspace, document), shape))
        text += *region == "everywhere" ? "; proved at all points" : "; proved in " + *region;
    if (fact.lipschitz_sup > 1)
        text += fmt::format("; a ray takes up to {} times the steps of a distance",
                            numbers(fact.lipschitz_sup));
    if (fact.bounds.finite() && !fact.bounds.empty()) {
        const auto point = [](const std::array<double, 3> &p) {
            return fmt::format("[{:.3g}, {:.3g}, {:.3g}]", p[0], p[1], p[2]);
        };
        text += fmt::format("; the solid lies in aabb({}, {})", point(fact.bounds.lo),
                            point(fact.bounds.hi));
    }
    return text;
}

std::string code(const std::string &text) { return fmt::format("```fathom\n{}\n```", text); }

// What a declaration says of itself: a function's head and doc, else the first line of its statement.
std::string declared_text(const File &home, const Declaration &declared, const std::string &type) {
    const lang::Ast &ast = home.reading->syntax.ast;
    if (declared.by == DeclaredBy::Function) {
        const lang::Function &function = ast.functions[declared.function];
        return code(
                   home.text.substr(function.head.begin, function.head.end - function.head.begin)) +
               (function.doc.empty() ? "" : "\n" + std::string(function.doc));
    }
    if (!type.empty()) return code(fmt::format("{}: {}", declared.name, type));
    if (declared.by == DeclaredBy::Parameter) return code(declared.name) + "\na parameter";
    const Span at = declared.statement;
    const std::string text = home.text.substr(at.begin, at.end - at.begin);
    return code(text.substr(0, text.find('\n')));
}

std::string type_of_name(const Compiled &compiled, const Declaration &declared) {
    for (const typecheck::NameFact &name : compiled.compilation.names)
        if (name.name == declared.name && name.declared.begin == declared.at.begin)
            return name.type;
    return "";
}

// While nothing is proved yet, by name alone.
std::string type_of_text(const std::map<std::string, std::string, std::less<>> &types,
                         const Declaration &declared) {
    const auto found = types.find(declared.name);
    return found == types.end() || !declared.top_level ? "" : found->second;
}

// What a name is: of the text's own names the type or the head, of the library's the entries.
void add_name(Workspace &workspace, Document &document, std::size_t offset, v1::Hover &hover) {
    const File file = file_of(document);
    if (const auto target = target_at(workspace, file, offset)) {
        const auto home = file_at(workspace, target->path);
        const Declaration &declared = home->reading->names.declarations[target->declaration];
        const bool own = home->path == document.path;
        hover.name =
            declared_text(*home, declared,
                          own && document.compiled ? type_of_name(*document.compiled, declared)
                          : own ? type_of_text(types_of(workspace, document, true), declared)
                                : "");
        return;
    }
    const Use *use = file.reading->names.use_at(offset);
    if (!use) return;
    const std::string module =
        use->module ? file.reading->names.declarations[*use->module].path : std::string();
    for (const v1::LibraryEntry *entry : library_forms(workspace, use->name, module)) {
        hover.name += (hover.name.empty() ? "" : "\n\n---\n\n") +
                      code((module.empty() ? "" : module + ".") + entry->signature) + "\n" +
                      entry->doc;
        hover.entries.push_back(*entry);
    }
    const Constant *constant = constant_named(workspace, use->name);
    if (hover.name.empty() && constant && use->as != UsedAs::Argument)
        hover.name =
            code(fmt::format("{}: {}{}", constant->name, constant->type,
                             constant->rgb ? fmt::format(" = #{:06x}", *constant->rgb) : ""));
}

} // namespace

// On a shape what is proved of it; on an error its message, with the point and its witness.
v1::Hover hover(Workspace &workspace, Document &document, std::size_t offset) {
    const Word word = word_at(document.text, offset);
    v1::Hover hover;
    hover.at = {word.begin, word.end};
    const Compiled *proved_soon = compiled_soon(workspace, document);
    if (!proved_soon) {
        if (!in_comment_or_string(reading(document).syntax, offset))
            add_name(workspace, document, offset, hover);
        if (!hover.name.empty()) hover.facts.push_back("The bound is not proved yet.");
        return hover;
    }
    const Compiled &result = *proved_soon;
    for (const v1::Diagnostic &diagnostic : result.diagnostics)
        if (diagnostic.severity == v1::Severity::Error && !diagnostic.notes.empty() &&
            diagnostic.at.file == document.path && diagnostic.at.begin <= offset &&
            offset <= diagnostic.at.end)
            hover.errors.push_back(
                fmt::format("{}\n\n{}", diagnostic.message, fmt::join(diagnostic.notes, "\n\n")));
    if (!in_comment_or_string(reading(document).syntax, offset))
        add_name(workspace, document, offset, hover);
    const ir::Scene &scene = result.compilation.scene;
    std::string proved;
    if (const ir::ShapeId made =
            steepest_made_by(document, result, call_named_at(document, offset)))
        proved = facts_in_words(scene.facts[made.index]) + more_in_words(workspace, document, made);
    if (!proved.empty())
        hover.facts.push_back(fmt::format(
            "`{}` here: {}.", document.text.substr(word.begin, word.end - word.begin), proved));
    for (const Made &here : shapes_of(document, result))
        if (here.span.begin <= offset && offset <= here.span.end) {
            const std::string whole = facts_in_words(scene.facts[here.shape.index]) +
                                      more_in_words(workspace, document, here.shape);
            if (here.count > 1)
                hover.facts.push_back(
                    fmt::format("The steepest of {} shapes: {}.", here.count, whole));
            else if (whole != proved)
                hover.facts.push_back(fmt::format("This shape: {}.", whole));
        }
    return hover;
}

std::vector<v1::BoundAt> bounds(Workspace &workspace, Document &document) {
    const Compiled &result = compiled(workspace, document);
    std::vector<v1::BoundAt> all;
    for (const Made &shape : shapes_of(document, result)) {
        const ir::ShapeFact &fact = result.compilation.scene.facts[shape.shape.index];
        all.push_back({stretch_of(shape.span), fact.lipschitz_sup, facts_in_words(fact)});
    }
    return all;
}

v1::Explanation why(Workspace &workspace, Document &document) {
    const Compiled &result = compiled(workspace, document);
    if (!result.good()) throw Refusal("a scene with errors has no bound");
    return v1::translated(explanation(workspace, document), result.compilation.sources);
}

// Names of arguments that stand by their place and do not say themselves what they are.
std::vector<v1::ArgumentName> argument_names(Workspace &workspace, Document &document,
                                             v1::Stretch within) {
    const File file = file_of(document);
    const Reading &read = *file.reading;
    std::vector<v1::ArgumentName> all;
    const lang::Ast &ast = read.syntax.ast;
    std::map<std::uint32_t, const Use *> uses;
    for (const Use &use : read.names.uses) uses[use.at.begin] = &use;
    for (const lang::Expr &e : ast.exprs) {
        const auto *call = std::get_if<lang::Call>(&e.kind);
        if (!call || call->arguments.empty() || e.span.end < within.begin ||
            e.span.begin > within.end)
            continue;
        const lang::Expr &callee = ast.exprs[call->callee];
        const auto *member = std::get_if<lang::Member>(&callee.kind);
        const auto use = uses.find(member ? member->name.span.begin : callee.span.begin);
        if (use == uses.end()) continue;
        const std::size_t first = member && !use->second->module ? 1 : 0;
        const std::vector<Form> forms = forms_of(workspace, file, *use->second);
        if (forms.empty() || forms[0].read.names.size() < first + 2) continue;
        const std::size_t count = first + call->arguments.size() + (call->trailing ? 1 : 0);
        for (std::size_t i = 0; i < call->arguments.size(); ++i) {
            if (call->arguments[i].name) break;
            const lang::Expr &value = ast.exprs[call->arguments[i].value];
            if (!std::holds_alternative<lang::Number>(value.kind) &&
                !std::holds_alternative<lang::Bool>(value.kind) &&
                !std::holds_alternative<lang::List>(value.kind))
                continue;
            const std::string name = parameter_at(forms, first + i, count);
            if (!name.empty()) all.push_back({value.span.begin, name});
        }
    }
    return all;
}

} // namespace fathom::language
