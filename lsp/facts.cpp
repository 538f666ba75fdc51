// What is known and proved, beside the text: hover, hints, lenses, the explanation of bounds.
#include "lsp/requests.h"

#include "lsp/calls.h"
#include "lsp/kept.h"

#include "driver/verdict.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::lsp {
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

File file_of(Workspace &workspace, const Document &document) {
    return *file_at(workspace, document.path);
}

// What a declaration says of itself: a function's head and doc, else the first line of its statement.
std::string declared_text(const File &home, const Declaration &declared, const std::string &type) {
    const lang::Ast &ast = home.reading->syntax.ast;
    if (declared.by == DeclaredBy::Function) {
        const lang::Function &function = ast.functions[declared.function];
        return code(
                   home.text.substr(function.head.begin, function.head.end - function.head.begin)) +
               (function.doc.empty() ? "" : "\n" + function.doc);
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

std::string name_text(Workspace &workspace, Document &document, std::size_t offset) {
    const File file = file_of(workspace, document);
    if (const auto target = target_at(workspace, file, offset)) {
        const auto home = file_at(workspace, target->path);
        const Declaration &declared = home->reading->names.declarations[target->declaration];
        const bool own = home->path == document.path;
        return declared_text(*home, declared,
                             own ? type_of_name(compiled(workspace, document), declared)
                                 : std::string());
    }
    const Use *use = file.reading->names.use_at(offset);
    if (!use) return "";
    const std::string module =
        use->module ? file.reading->names.declarations[*use->module].path : std::string();
    std::string text;
    for (const fathom::v1::LibraryEntry *entry : library_forms(workspace, use->name, module))
        text += (text.empty() ? "" : "\n\n---\n\n") +
                code((module.empty() ? "" : module + ".") + entry->signature) + "\n" + entry->doc;
    for (const fathom::v1::LibraryEntry *entry : library_forms(workspace, use->name, module))
        if (const auto picture = picture_of_entry(entry->name, module, entry->doc)) {
            text += fmt::format("\n\n![{}]({})", entry->name, uri_of(picture->string()));
            break;
        }
    const Constant *constant = constant_named(workspace, use->name);
    if (text.empty() && constant && use->as != UsedAs::Argument)
        text = code(fmt::format("{}: {}{}", constant->name, constant->type,
                                constant->rgb ? fmt::format(" = #{:06x}", *constant->rgb) : ""));
    return text;
}

void explain(const proof::Explanation &node, const Sources &sources, int depth, std::string &out) {
    out += std::string(static_cast<std::size_t>(depth) * 2, ' ');
    out += fmt::format("{}{}: {:.4g}", node.worst ? "* " : "", node.operation, node.lipschitz);
    if (std::abs(node.factor - 1) > 1e-9) out += fmt::format(" (x {:.4g})", node.factor);
    if (!node.rule.empty()) out += ", " + node.rule;
    if (!node.region.empty() && node.region != "everywhere") out += ", in " + node.region;
    if (node.place.source)
        out +=
            fmt::format("  (line {})", position(sources[node.place.source], node.place.begin).line);
    out += '\n';
    for (const proof::Explanation &child : node.children) explain(child, sources, depth + 1, out);
}

// Names of arguments that stand by their place and do not say themselves what they are.
void hint_arguments(Workspace &workspace, const File &file, Json &hints, std::size_t from,
                    std::size_t to) {
    const Reading &read = *file.reading;
    const lang::Ast &ast = read.syntax.ast;
    std::map<std::uint32_t, const Use *> uses;
    for (const Use &use : read.names.uses) uses[use.at.begin] = &use;
    for (const lang::Expr &e : ast.exprs) {
        const auto *call = std::get_if<lang::Call>(&e.kind);
        if (!call || call->arguments.empty() || e.span.end < from || e.span.begin > to) continue;
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
            if (!name.empty())
                hints.push_back({{"position", json_of(position_at(read.lines, value.span.begin))},
                                 {"label", name + ":"},
                                 {"kind", 2},
                                 {"paddingRight", true}});
        }
    }
}

// Why the bounds are what they are, a line a step.
std::string explanation_text(Workspace &workspace, Document &document) {
    const Compiled &result = compiled(workspace, document);
    if (!result.good()) throw Refusal("a scene with errors has no bound");
    std::string text;
    explain(explanation(workspace, document), result.compilation.sources, 0, text);
    return text;
}

} // namespace

// What a name is: of the text's own names the type or the head, of the library's the entry. On a
// shape what is proved of it; on an error its message, with the point and its witness.
Json hover(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    const std::size_t offset = offset_of(document, params);
    const Word word = word_at(document.text, offset);
    std::string text;
    const auto add = [&text](const std::string &part) {
        if (!part.empty()) text += (text.empty() ? "" : "\n\n---\n\n") + part;
    };
    const Compiled &result = compiled(workspace, document);
    for (const fathom::v1::Diagnostic &diagnostic : result.diagnostics)
        if (diagnostic.severity == fathom::v1::Severity::Error && !diagnostic.notes.empty() &&
            diagnostic.at.file == document.path && diagnostic.at.begin <= offset &&
            offset <= diagnostic.at.end)
            add(fmt::format("{}\n\n{}", diagnostic.message, fmt::join(diagnostic.notes, "\n\n")));
    if (!in_comment_or_string(reading(document).syntax, offset))
        add(name_text(workspace, document, offset));
    const ir::Scene &scene = result.compilation.scene;
    std::string proved;
    if (const ir::ShapeId made =
            steepest_made_by(document, result, call_named_at(document, offset)))
        proved = facts_in_words(scene.facts[made.index]) + more_in_words(workspace, document, made);
    if (!proved.empty())
        add(fmt::format("`{}` here: {}.", document.text.substr(word.begin, word.end - word.begin),
                        proved));
    for (const Made &here : shapes_of(document, result))
        if (here.span.begin <= offset && offset <= here.span.end) {
            const std::string whole = facts_in_words(scene.facts[here.shape.index]) +
                                      more_in_words(workspace, document, here.shape);
            if (here.count > 1)
                add(fmt::format("The steepest of {} shapes: {}.", here.count, whole));
            else if (whole != proved)
                add(fmt::format("This shape: {}.", whole));
        }
    if (text.empty()) return nullptr;
    Json answer{{"contents", markdown(text)}};
    if (word.begin < word.end)
        answer["range"] = json_of(range_of(reading(document).lines, word.begin, word.end));
    return answer;
}

// Where a shape's bound is above 1, the bound, at the end of its statement; names of arguments.
Json inlay_hints(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    Json hints = Json::array();
    std::size_t from = 0, to = document.text.size();
    if (params.contains("range")) {
        from = offset_at(document.text, position_of(params["range"].at("start")));
        to = offset_at(document.text, position_of(params["range"].at("end")));
    }
    const Compiled &result = compiled(workspace, document);
    for (const Made &shape : shapes_of(document, result)) {
        const ir::ShapeFact &fact = result.compilation.scene.facts[shape.shape.index];
        if (fact.lipschitz_sup <= 1 || shape.span.end < from || shape.span.begin > to) continue;
        hints.push_back(
            {{"position", json_of(position_at(reading(document).lines, shape.span.end))},
             {"label", fmt::format("bound {:.3g}", fact.lipschitz_sup)},
             {"tooltip", facts_in_words(fact)},
             {"paddingLeft", true}});
    }
    hint_arguments(workspace, file_of(workspace, document), hints, from, to);
    return hints;
}

// Above each top-level shape its bound, which explains itself, and above the first one a window.
Json code_lenses(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    Json lenses = Json::array();
    const Compiled &result = compiled(workspace, document);
    const auto lens = [&](Span at, const std::string &title, const char *command) {
        lenses.push_back(
            {{"range", range_json(reading(document).lines, at)},
             {"command", {{"title", title}, {"command", command}, {"arguments", {document.uri}}}}});
    };
    const std::vector<Made> shapes = shapes_of(document, result);
    if (!shapes.empty()) lens(shapes.front().span, "show", "fathom.show");
    for (const Made &shape : shapes)
        lens(shape.span,
             facts_in_words(result.compilation.scene.facts[shape.shape.index]) + ": explain",
             "fathom.explain");
    return lenses;
}

// `fathom.explain` [address]: why the bounds are what they are, as text, which is shown as well.
// `fathom.show` [address] is answered by who serves (preview.h).
Json execute_command(Workspace &workspace, const Json &params) {
    const std::string command = params.at("command");
    if (command == "fathom.show") throw Refusal("no window can be opened from here");
    if (command != "fathom.explain") throw Refusal("there is no command " + command);
    const std::string uri = params.at("arguments").at(0);
    const std::string text = explanation_text(workspace, document_at(workspace, uri));
    constexpr int info = 3;
    workspace.said.push_back({"window/showMessage", {{"type", info}, {"message", text}}});
    return text;
}

} // namespace fathom::lsp
