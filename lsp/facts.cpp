// What is known and proved, beside the text: hover, hints, lenses, the explanation of bounds.
#include "lsp/requests.h"

#include "lsp/calls.h"

#include "api/impl.h"
#include "proof/prove.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::lsp {
namespace {

using fathom::v1::ShapeFacts;

const char *word_of(fathom::v1::Status status) {
    switch (status) {
    case fathom::v1::Status::Proved: return "proved";
    case fathom::v1::Status::Assumed: return "assumed";
    case fathom::v1::Status::Estimated: return "estimated";
    }
    return "";
}

std::string facts_in_words(const ShapeFacts &facts) {
    return fmt::format("bound {:.4g}, {}, {}", facts.lipschitz, word_of(facts.status),
                       facts.exact ? "exact" : "a lower bound of the distance");
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

std::string type_of_name(const std::vector<fathom::v1::Name> &names, const Declaration &declared) {
    for (const fathom::v1::Name &name : names)
        if (name.name == declared.name && name.at.begin == declared.at.begin) return name.type;
    return "";
}

std::string name_text(Workspace &workspace, Document &document, std::size_t offset) {
    const File file = file_of(workspace, document);
    if (const auto target = target_at(workspace, file, offset)) {
        const auto home = file_at(workspace, target->path);
        const Declaration &declared = home->reading->names.declarations[target->declaration];
        const bool own = home->path == document.path;
        return declared_text(*home, declared,
                             own ? type_of_name(compiled(workspace, document).names, declared)
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
                hints.push_back({{"position", json_of(range_of(file.text, value.span.begin,
                                                               value.span.begin))["start"]},
                                 {"label", name + ":"},
                                 {"kind", 2},
                                 {"paddingRight", true}});
        }
    }
}

} // namespace

// What a name is: of the text's own names the type or the head, of the library's the entry. On a
// shape at the top level also what is proved of it.
Json hover(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    const std::size_t offset = offset_of(document, params);
    const Word word = word_at(document.text, offset);
    std::string text;
    if (!in_comment_or_string(reading(document).syntax, offset))
        text = name_text(workspace, document, offset);
    const fathom::v1::CompileResult &result = compiled(workspace, document);
    if (result.scene)
        for (const ShapeFacts &shape : result.scene->facts().shapes)
            if (shape.at.file == document.path && shape.at.begin <= offset &&
                offset <= shape.at.end)
                text += fmt::format("{}This shape: {}.", text.empty() ? "" : "\n\n---\n\n",
                                    facts_in_words(shape));
    if (text.empty()) return nullptr;
    Json answer{{"contents", markdown(text)}};
    if (word.begin < word.end)
        answer["range"] = json_of(range_of(document.text, word.begin, word.end));
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
    if (compiled(workspace, document).scene)
        for (const ShapeFacts &shape : compiled(workspace, document).scene->facts().shapes) {
            if (shape.at.file != document.path || shape.lipschitz <= 1 || shape.at.end < from ||
                shape.at.begin > to)
                continue;
            const Json range = place_of(document, shape.at);
            hints.push_back({{"position", range["end"]},
                             {"label", fmt::format("bound {:.3g}", shape.lipschitz)},
                             {"tooltip", facts_in_words(shape)},
                             {"paddingLeft", true}});
        }
    hint_arguments(workspace, file_of(workspace, document), hints, from, to);
    return hints;
}

// Above each top-level shape its bound, which explains itself.
Json code_lenses(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    Json lenses = Json::array();
    if (!compiled(workspace, document).scene) return lenses;
    for (const ShapeFacts &shape : compiled(workspace, document).scene->facts().shapes)
        if (shape.at.file == document.path)
            lenses.push_back({{"range", place_of(document, shape.at)},
                              {"command",
                               {{"title", fmt::format("{}: explain", facts_in_words(shape))},
                                {"command", "fathom.explain"},
                                {"arguments", {document.uri}}}}});
    return lenses;
}

std::string explanation(Workspace &workspace, Document &document) {
    const fathom::v1::CompileResult &result = compiled(workspace, document);
    if (!result.scene) throw Refusal("a scene with errors has no bound");
    std::string text;
    explain(proof::explain(fathom::v1::ir_of(*result.scene)),
            result.scene->impl().compilation->sources, 0, text);
    return text;
}

} // namespace fathom::lsp
