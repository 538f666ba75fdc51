// Completion and signature help: what may stand at a place, in whole and in half-typed texts.
#include "api/language/features.h"

#include "api/language/calls.h"
#include "api/language/paths.h"

#include "lang/vocabulary.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <set>

namespace fathom::language {
namespace {

using lang::Tok;

using Item = v1::CompletionItem;
using Items = std::vector<Item>;

// What may stand before a dot, as far as methods care. A vector is of two, three or four numbers; of
// a `Number` it is not known whether it is one.
enum class Kind { Unknown, Shape, Number, Float, Vec2, Vec3, Vec4, List, Module };

Kind vector_of(std::size_t numbers) {
    switch (numbers) {
    case 2: return Kind::Vec2;
    case 3: return Kind::Vec3;
    case 4: return Kind::Vec4;
    default: return Kind::List;
    }
}

// The letters of a vector's parts; none of what is surely none.
std::string_view parts_of(Kind kind) {
    switch (kind) {
    case Kind::Vec2: return "xy";
    case Kind::Vec3: return "xyz";
    case Kind::Unknown:
    case Kind::Number:
    case Kind::Vec4: return "xyzw";
    case Kind::Shape:
    case Kind::Float:
    case Kind::List:
    case Kind::Module: break;
    }
    return "";
}

// Whether a function whose first parameter is of the one kind takes what is of the other.
bool takes(Kind first, Kind given) {
    const auto is_number = [](Kind kind) { return kind == Kind::Float || !parts_of(kind).empty(); };
    if (first == Kind::Unknown || given == Kind::Unknown || first == given) return true;
    return is_number(first) && is_number(given) && (first == Kind::Number || given == Kind::Number);
}

Kind kind_of_type(std::string_view type) {
    if (type.find("shape") != type.npos) return Kind::Shape;
    if (type.starts_with("list") || type.starts_with('[')) return Kind::List;
    if (type.starts_with("vec2")) return Kind::Vec2;
    if (type.starts_with("vec3")) return Kind::Vec3;
    if (type.starts_with("vec4") || type.starts_with("color")) return Kind::Vec4;
    for (std::string_view number : {"float", "int", "angle"})
        if (type.starts_with(number)) return Kind::Float;
    for (std::string_view number : {"mat", "_field"})
        if (type.starts_with(number)) return Kind::Number;
    return Kind::Unknown;
}

// Of a function's first parameter. The built-in functions name theirs by what they are.
Kind kind_of_first(const Signature &signature) {
    if (signature.parameters.empty()) return Kind::Unknown;
    const std::string &first = signature.parameters[0];
    const std::size_t colon = first.find(": ");
    if (colon != first.npos) return kind_of_type(std::string_view(first).substr(colon + 2));
    const std::string &name = signature.names[0];
    if (name == "s") return Kind::Shape;
    if (name == "list") return Kind::List;
    return Kind::Number;
}

struct Place {
    Workspace &workspace;
    Document &document;
    const Reading &read;
    File file;
    bool snippets;
    std::size_t offset;
    Word word;
    std::size_t before; // how many words end at or before the word's begin

    const std::vector<lang::Token> &tokens() const { return read.syntax.words.tokens; }
    std::string text(const lang::Token &token) const {
        return std::string(read.syntax.text().substr(token.begin, token.end - token.begin));
    }
};

Place place_of(Workspace &workspace, Document &document, std::size_t offset, bool snippets) {
    const Reading &read = reading(document);
    Place place{workspace,
                document,
                read,
                file_of(document),
                snippets,
                offset,
                word_at(document.text, offset),
                0};
    while (place.before < place.tokens().size() &&
           place.tokens()[place.before].end <= place.word.begin)
        ++place.before;
    return place;
}

// Of a name of the text, as the last compilation knew it: completion is asked for at every letter,
// and waits for another only where the name was not there then. Nothing where it has none.
const std::string *type_of_name(const Place &place, const std::string &name) {
    const auto *types = &types_of(place.workspace, place.document, false);
    if (!types->contains(name)) types = &types_of(place.workspace, place.document, true);
    const auto found = types->find(name);
    return found == types->end() ? nullptr : &found->second;
}

// What the point is in a function that such a call is given, as the only argument that is one.
Kind point_in(const std::optional<OpenCall> &call) {
    constexpr std::array<std::string_view, 5> of_the_point = {"implicit", "displace", "distort",
                                                              "paint", "estimate"};
    if (call && call->name == "implicit2") return Kind::Vec2;
    return call && std::ranges::find(of_the_point, call->name) != of_the_point.end()
               ? Kind::Vec3
               : Kind::Unknown;
}

Kind kind_of_parameter(const Place &place, const Declaration &declared) {
    const lang::Ast &ast = place.read.syntax.ast;
    for (const lang::Function &function : ast.functions)
        for (const lang::Parameter &parameter : function.parameters)
            if (parameter.name.span == declared.at && parameter.type)
                return parameter.type->kind == lang::TypeExpr::Kind::List
                           ? Kind::List
                           : kind_of_type(parameter.type->name);
    return point_in(call_around(place.read.syntax, declared.at.begin));
}

constexpr int most_names = 8; // that stand for each other

Kind kind_before(const Place &place, std::size_t end, int depth = 0);

// Of the nearest declaration of a name: parameters and names of blocks before those of the text.
Kind kind_of_name(const Place &place, const std::string &name, int depth) {
    const Declaration *nearest = nullptr;
    for (const Declaration &declared : place.read.names.declarations) {
        if (declared.name != name) continue;
        const bool around =
            declared.statement.begin <= place.offset && place.offset <= declared.statement.end;
        if (declared.by == DeclaredBy::Parameter ? around
            : declared.top_level                 ? !nearest
                                                 : declared.at.end <= place.offset && !around)
            nearest = &declared;
    }
    if (nearest && nearest->by == DeclaredBy::Import) return Kind::Module;
    if (nearest && nearest->by == DeclaredBy::Parameter) return kind_of_parameter(place, *nearest);
    if (nearest && nearest->top_level)
        if (const std::string *type = type_of_name(place, name)) return kind_of_type(*type);
    if (nearest && !nearest->top_level && nearest->value && depth < most_names) {
        const Span value = place.read.syntax.ast.exprs[nearest->value].span;
        std::size_t end = 0;
        while (end < place.tokens().size() && place.tokens()[end].end <= value.end) ++end;
        return kind_before(place, end, depth + 1);
    }
    if (nearest) return Kind::Unknown;
    for (std::size_t i = place.before; i-- > 1;) { // in a text that is no tree yet
        if (place.tokens()[i].kind != Tok::FatArrow || place.text(place.tokens()[i - 1]) != name)
            continue;
        const Kind point = point_in(call_around(place.read.syntax, place.tokens()[i - 1].begin));
        if (point != Kind::Unknown) return point;
        break;
    }
    if (const Constant *constant = constant_named(place.workspace, name))
        return kind_of_type(constant->type);
    return Kind::Unknown;
}

// Of what ends before the word number `end`.
Kind kind_before(const Place &place, std::size_t end, int depth) {
    if (end == 0) return Kind::Unknown;
    const lang::Token &last = place.tokens()[end - 1];
    if (last.kind == Tok::Number) return Kind::Float;
    if (last.kind == Tok::Name) return kind_of_name(place, place.text(last), depth);
    const std::string sign = place.text(last);
    if (sign != ")" && sign != "}" && sign != "]") return Kind::Unknown;
    int nesting = 0;
    std::size_t open = end, commas = 0;
    while (open-- > 0) {
        const std::string at = place.text(place.tokens()[open]);
        if (at == ")" || at == "}" || at == "]") ++nesting;
        if ((at == "(" || at == "{" || at == "[") && --nesting == 0) break;
        if (at == "," && nesting == 1) ++commas;
    }
    if (open == std::size_t(-1)) return Kind::Unknown;
    if (sign == "]") // an element of a list, or a vector
        return open > 0 && lang::ends_operand(place.tokens()[open - 1].kind)
                   ? Kind::Unknown
                   : vector_of(commas + 1);
    if (open == 0) return Kind::Unknown;
    const lang::Token &callee = place.tokens()[open - 1];
    if (callee.kind != Tok::Name) // `union(…) { … }`, `(a | b)`
        return sign == "}" && depth < most_names ? kind_before(place, open, depth + 1)
                                                 : Kind::Unknown;
    for (const Form &form : forms_named(place.workspace, place.file, place.text(callee))) {
        if (!form.read.result.empty()) return kind_of_type(form.read.result);
        if (kind_of_first(form.read) == Kind::Shape) return Kind::Shape;
    }
    return Kind::Unknown;
}

// Whether what is typed so far may go on to be the name, as clients see it, who leave letters out:
// the name has its first letter. In long texts most names are not looked at any further.
bool may_become(const Place &place, std::string_view name) {
    if (place.word.begin >= place.offset) return true;
    const auto low = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    const int first = low(place.document.text[place.word.begin]);
    return std::ranges::any_of(name, [&](char c) { return low(c) == first; });
}

Item item(std::string label, Item::Kind kind, std::string detail = "") {
    return {std::move(label), kind, std::move(detail), "", "", false, ""};
}

void add_function(const Place &place, Items &items, const std::string &name, const Form &form,
                  Item::Kind kind) {
    Item made = item(name, kind, form.signature);
    made.documentation = form.doc;
    if (place.snippets) {
        made.insert =
            name +
            (form.read.names.size() <= (kind == Item::Kind::Method ? 1u : 0u) ? "()" : "($0)");
        made.snippet = true;
    }
    items.push_back(std::move(made));
}

void add_library(const Place &place, Items &items, bool method, Kind kind) {
    std::set<std::string> seen;
    for (const v1::LibraryEntry &entry : place.workspace.library) {
        if (!entry.module.empty() || entry.signature.find('(') == std::string::npos) continue;
        if (!may_become(place, entry.name)) continue;
        const Form form{entry.signature, entry.doc, read_signature(entry.signature)};
        const Kind first = kind_of_first(form.read);
        if (method && form.read.names.empty()) continue;
        if (method && !takes(first, kind)) continue;
        if (seen.insert(entry.name).second)
            add_function(place, items, entry.name, form,
                         method ? Item::Kind::Method : Item::Kind::Function);
    }
}

Items members(const Place &place) {
    Items items;
    const std::size_t dot = place.before - 1;
    const lang::Token *object = dot > 0 ? &place.tokens()[dot - 1] : nullptr;
    const Kind kind = kind_before(place, dot);
    if (kind == Kind::Module && object) {
        for (const Declaration &import : place.read.names.declarations) {
            if (import.by != DeclaredBy::Import || import.name != place.text(*object)) continue;
            for (const v1::LibraryEntry &entry : place.workspace.library)
                if (entry.module == import.path)
                    add_function(place, items, entry.name,
                                 {entry.signature, entry.doc, read_signature(entry.signature)},
                                 Item::Kind::Function);
            const auto file = file_at(place.workspace, imported_path(place.file.path, import.path));
            if (!file) continue;
            for (const Declaration &declared : file->reading->names.declarations)
                if (declared.top_level && !declared.name.empty() && declared.name[0] != '_')
                    items.push_back(item(declared.name, declared.function ? Item::Kind::Function
                                                                          : Item::Kind::Constant));
        }
        return items;
    }
    for (const char part : parts_of(kind))
        items.push_back(item(std::string(1, part), Item::Kind::Field));
    for (const Declaration &declared : place.read.names.declarations) {
        if (!declared.function || !declared.top_level) continue;
        const Form form = form_of(place.file, declared);
        if (form.read.names.empty()) continue;
        const Kind first = form.read.parameters[0].find(": ") == std::string::npos
                               ? Kind::Unknown
                               : kind_of_first(form.read);
        if (takes(first, kind)) add_function(place, items, declared.name, form, Item::Kind::Method);
    }
    add_library(place, items, true, kind);
    return items;
}

// Names of the text that may be meant here.
void add_own(const Place &place, Items &items) {
    const auto &types = types_of(place.workspace, place.document, false);
    std::set<std::string> seen;
    const auto at = static_cast<std::uint32_t>(place.offset);
    // Where statements begin that hold the place, that stand beside one of these, and the functions.
    std::set<std::uint32_t> around, beside, functions;
    for (const Step &step : path_to(place.read.syntax.ast, at, at)) {
        if (step.function) functions.insert(step.function->span.begin);
        if (!step.block) continue;
        around.insert(step.stmt->span.begin);
        for (const lang::Stmt &stmt : step.block->stmts) beside.insert(stmt.span.begin);
    }
    const auto visible = [&](const Declaration &declared) {
        if (declared.top_level) return true;
        const std::uint32_t begin = declared.statement.begin;
        if (declared.by == DeclaredBy::Parameter) return functions.contains(begin);
        if (around.contains(begin)) return declared.by == DeclaredBy::Loop;
        return declared.at.end <= place.offset && beside.contains(begin);
    };
    const std::vector<Declaration> &all = place.read.names.declarations;
    for (std::size_t i = all.size(); i-- > 0;) { // the innermost last declared first
        const Declaration &declared = all[i];
        if (declared.name.empty() || !may_become(place, declared.name) || !visible(declared) ||
            !seen.insert(declared.name).second)
            continue;
        if (declared.at.begin <= place.offset && place.offset <= declared.at.end) continue;
        if (declared.function) {
            add_function(place, items, declared.name, form_of(place.file, declared),
                         Item::Kind::Function);
            continue;
        }
        const auto known = types.find(declared.name);
        items.push_back(
            item(declared.name,
                 declared.by == DeclaredBy::Import ? Item::Kind::Module : Item::Kind::Variable,
                 known == types.end() ? "" : known->second));
    }
    for (std::size_t import : place.read.names.open_imports)
        if (const auto file =
                file_at(place.workspace, imported_path(place.file.path, all[import].path)))
            for (const Declaration &declared : file->reading->names.declarations)
                if (declared.top_level && !declared.name.empty() && declared.name[0] != '_' &&
                    seen.insert(declared.name).second)
                    items.push_back(
                        item(declared.name,
                             declared.function ? Item::Kind::Function : Item::Kind::Constant,
                             all[import].path));
}

void add_arguments(const Place &place, Items &items) {
    const auto call = call_around(place.read.syntax, place.word.begin);
    if (!call || !call->argument_name.empty()) return;
    std::set<std::string> seen(call->named.begin(), call->named.end());
    for (const Form &form : forms_named(place.workspace, place.file, call->name))
        for (std::size_t i = call->method ? 1 : 0; i < form.read.names.size(); ++i)
            if (form.read.parameters[i].find("[_") == std::string::npos &&
                seen.insert(form.read.names[i]).second)
                items.push_back({form.read.names[i] + ":", Item::Kind::Field,
                                 form.read.parameters[i], "", form.read.names[i] + ": ", false,
                                 "0" + form.read.names[i]});
}

// Files that the string at the place may name: beside the text, in the folder begun so far.
Items files_here(const Place &place, const lang::Token &string) {
    Items items;
    const std::size_t begin = string.begin + 1;
    if (place.offset < begin) return items;
    const std::string_view before =
        std::string_view(place.document.text).substr(begin, place.offset - begin);
    const Named what = named_by(place.read.syntax, string);
    if (what == Named::Nothing) return items;
    const std::size_t slash = before.rfind('/');
    const std::string folder(slash == before.npos ? "" : before.substr(0, slash + 1));
    std::error_code error;
    const std::filesystem::path home =
        std::filesystem::path(place.document.path).parent_path() / folder;
    if (what == Named::Scene && folder.empty())
        for (const v1::LibraryEntry &entry : place.workspace.library)
            if (!entry.module.empty() && (items.empty() || items.back().label != entry.module))
                items.push_back(item(entry.module, Item::Kind::Module));
    for (const auto &entry : std::filesystem::directory_iterator(home, error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with('.') || items.size() > 500) continue;
        if (entry.is_directory(error))
            items.push_back(item(name + "/", Item::Kind::Folder));
        else if (may_be(what, entry.path().extension().string()) &&
                 entry.path() != place.document.path)
            items.push_back(item(name, Item::Kind::File));
    }
    return items;
}

void add_words(const Place &place, Items &items) {
    const std::pair<const char *, const char *> snippets[] = {
        {"let", "let ${1:name} = $0"},
        {"fn", "fn ${1:name}(${2:x}) = $0"},
        {"for", "for ${1:i} in ${2:0..8} {\n  $0\n}"},
        {"if", "if ${1:condition} {\n  $2\n} else {\n  $0\n}"},
        {"param", "param ${1:name} = ${2:1} in ${3:0..2}"},
        {"while", "while ${1:condition} limit ${2:8} {\n  $0\n}"},
        {"import", "import \"$0\""}};
    for (std::string_view keyword : lang::vocabulary().keywords) {
        Item made = item(std::string(keyword), Item::Kind::Keyword);
        for (const auto &[name, text] : snippets)
            if (keyword == name && place.snippets) made.insert = text, made.snippet = true;
        items.push_back(std::move(made));
    }
    for (const Constant &constant : place.workspace.constants) {
        if (!may_become(place, constant.name)) continue;
        items.push_back(item(constant.name, constant.rgb ? Item::Kind::Color : Item::Kind::Constant,
                             constant.type));
        if (constant.rgb) items.back().documentation = fmt::format("#{:06x}", *constant.rgb);
    }
}

bool wants_type(const Place &place) {
    if (place.before == 0) return false;
    const Tok last = place.tokens()[place.before - 1].kind;
    if (last == Tok::Arrow) return true;
    return last == Tok::Colon && !call_around(place.read.syntax, place.word.begin);
}

} // namespace

std::vector<v1::CompletionItem> completion(Workspace &workspace, Document &document,
                                           std::size_t offset, bool snippets) {
    const Place place = place_of(workspace, document, offset, snippets);
    Items items;
    for (const lang::Token &token : place.tokens()) { // also one that is not closed yet
        const bool string = token.kind == Tok::String ||
                            (token.kind == Tok::Bad && place.text(token).starts_with('"'));
        if (string && token.begin < place.offset &&
            (place.offset < token.end || (token.kind == Tok::Bad && place.offset == token.end)))
            return files_here(place, token);
    }
    if (in_comment_or_string(place.read.syntax, place.offset)) return items;
    const char first =
        place.word.begin < place.document.text.size() ? place.document.text[place.word.begin] : ' ';
    if (first >= '0' && first <= '9') { // a number: its units
        const std::string digits =
            place.document.text.substr(place.word.begin, place.word.end - place.word.begin);
        for (std::string_view unit : lang::vocabulary().units)
            items.push_back(
                item(digits.substr(0, digits.find_first_not_of("0123456789")) + std::string(unit),
                     Item::Kind::Unit));
        return items;
    }
    if (place.word.begin > 0 && place.document.text[place.word.begin - 1] == '#') return items;
    if (place.word.method && place.before > 0 && place.tokens()[place.before - 1].kind == Tok::Dot)
        return members(place);
    if (wants_type(place)) {
        for (std::string_view type : lang::vocabulary().types)
            items.push_back(item(std::string(type), Item::Kind::Type));
        return items;
    }
    add_arguments(place, items);
    add_own(place, items);
    add_library(place, items, false, Kind::Unknown);
    add_words(place, items);
    return items;
}

v1::SignatureHelp signature_help(Workspace &workspace, Document &document, std::size_t offset) {
    const Place place = place_of(workspace, document, offset, false);
    v1::SignatureHelp help;
    const auto call = call_around(place.read.syntax, place.offset);
    if (!call) return help;
    std::vector<Form> forms;
    if (const Use *use = place.read.names.use_at(call->name_begin);
        use && use->at.begin == call->name_begin)
        forms = forms_of(workspace, place.file, *use);
    if (forms.empty()) forms = forms_named(workspace, place.file, call->name);
    const std::size_t first = call->method ? 1 : 0, wanted = first + call->argument;
    bool found = false;
    for (std::size_t i = 0; i < forms.size(); ++i) {
        const Form &form = forms[i];
        std::size_t at = std::min(wanted, form.read.names.empty() ? 0 : form.read.names.size() - 1);
        const auto named = std::ranges::find(form.read.names, call->argument_name);
        if (named != form.read.names.end())
            at = static_cast<std::size_t>(named - form.read.names.begin());
        const bool fits = call->argument_name.empty() ? wanted < form.read.names.size()
                                                      : named != form.read.names.end();
        if (fits && !found) help.active = i, found = true;
        help.forms.push_back({form.signature, form.doc, form.read.parameters, at});
    }
    return help;
}

} // namespace fathom::language
