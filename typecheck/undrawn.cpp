// A file that makes no shape: what of it would make one.
#include "typecheck/undrawn.h"

#include "lang/vocabulary.h"
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fathom::typecheck {

namespace {

bool is_flat_field(const lang::Function &f) {
    return f.parameters[0].type && f.parameters[0].type->named == lang::TypeName::Vec2;
}

// The part that vectors of the file are compared by, as `a.w < b.w`: there the distance stands.
std::string_view compared_part(const File &ast) {
    for (const lang::Expr &e : ast.exprs) {
        const auto *compares = std::get_if<lang::Binary>(&e.kind);
        if (!compares ||
            (compares->op() != lang::BinaryOp::Less && compares->op() != lang::BinaryOp::Greater))
            continue;
        std::array<std::string_view, 2> parts;
        for (std::size_t i = 0; i < 2; ++i)
            if (const auto *member =
                    std::get_if<lang::Member>(&ast.exprs[compares->operands[i].value].kind))
                parts[i] = member->name.text;
        if (parts[0] == parts[1] && (parts[0] == "x" || parts[0] == "w")) return parts[0];
    }
    return {};
}

// A function of the file that gives a distance for a point, alone or with a material behind it.
struct Field {
    const lang::Function *function = nullptr;
    int rank = 0;
    std::string distance, color; // of its result: ".x", "[0]"; `color` is empty where there is none
};

// Scenes go before what a light or a normal is found by, and what nobody calls before its parts.
int rank_of(const File &ast, const std::vector<Field> &fields, const lang::Function &f) {
    if (lang::names_a_scene(f.name->text)) return 2;
    for (const lang::Expr &e : ast.exprs) {
        const auto *name = std::get_if<lang::Name>(&e.kind);
        if (!name || name->text != f.name->text) continue;
        for (const Field &other : fields)
            if (other.function != &f && e.span.begin >= other.function->span.begin &&
                e.span.end <= other.function->span.end)
                return 0;
    }
    return 1;
}

// By what is written of it: whether it may be a field, with the part that is its distance.
std::optional<Field> may_be_field(const lang::Function &f, std::string_view compared) {
    if (f.parameters.size() != 1 || f.parameters[0].default_value) return std::nullopt;
    const lang::TypeExpr *point = f.parameters[0].type;
    if (point && point->named != lang::TypeName::Vec3 && point->named != lang::TypeName::Vec2)
        return std::nullopt;
    Field field{&f, 0, {}, {}};
    if (!f.result) return field; // its value tells
    const lang::TypeName type = f.result->named;
    if (type == lang::TypeName::Float) return point ? std::optional(field) : std::nullopt;
    if (is_flat_field(f)) return std::nullopt;
    if (type == lang::TypeName::Vec2 && (compared == "x" || lang::names_a_scene(f.name->text))) {
        field.distance = ".x";
        return field;
    }
    if (type == lang::TypeName::Vec4 && compared.empty() && lang::names_a_scene(f.name->text)) {
        field.distance = ".x"; // and what else there is has no one meaning
        return field;
    }
    if (type != lang::TypeName::Vec4 || compared.empty()) return std::nullopt;
    field.distance = "." + std::string(compared);
    field.color = compared == "x" ? ".yzw" : ".xyz";
    return field;
}

// A function whose result has no type is tried: a number, or a list of a number and a colour.
bool gives_distance(Interpreter &ev, const File &ast, std::uint32_t frame, Field &field) {
    const lang::Function &f = *field.function;
    if (f.result) return true;
    const auto found = find_name(ev, frame, symbol_of(ast, *f.name));
    if (!found) return false;
    const Value function = ev.frames[found->frame].bindings[found->slot].value;
    ir::Graph &graph = ev.scene.graph;
    const ir::NodeId point = graph.fresh_var(is_flat_field(f) ? ir::Type::Vec2 : ir::Type::Vec3);
    ++ev.quiet, ++ev.in_field;
    const std::size_t errors = std::exchange(ev.quiet_errors, 0);
    const Value value = call_with(ev, function, {from_node(ev, point)}, f.head);
    const bool failed = ev.quiet_errors > 0;
    ev.quiet_errors = errors;
    --ev.quiet, --ev.in_field;
    if (failed) return false;
    if (is_numeric(value) && ir::is_vector(numeric_type(ev, value))) { // `[distance, number]`
        field.distance = "[0]";
        return !is_flat_field(f) && lang::names_a_scene(f.name->text);
    }
    if (value.kind != ValueKind::List) return f.parameters[0].type && is_scalar(ev, value);
    for (std::size_t i = 0; i < ev.lists[value.id].size(); ++i) {
        const Value item = ev.lists[value.id][i];
        if (!is_numeric(item)) continue;
        std::string &part = is_scalar(ev, item) ? field.distance : field.color;
        const bool fits = is_scalar(ev, item) || numeric_type(ev, item) == ir::Type::Vec3;
        if (fits && part.empty()) part = fmt::format("[{}]", i);
    }
    return !field.distance.empty();
}

// The file's field that most looks like its scene; the last one of several.
std::optional<Field> field_of(Interpreter &ev, const File &ast, std::uint32_t frame) {
    constexpr std::size_t most_tried = 4, most_fields = 32; // the last ones of a long file
    const std::string_view compared = compared_part(ast);
    std::vector<Field> fields;
    const std::vector<lang::Stmt> &stmts = ast.blocks[ast.root].stmts;
    for (std::size_t i = stmts.size(); i-- > 0 && fields.size() < most_fields;)
        if (const auto *declared = std::get_if<lang::FunctionDecl>(&stmts[i].kind))
            if (auto field = may_be_field(ast.functions[declared->function], compared))
                fields.push_back(std::move(*field));
    for (Field &field : fields) field.rank = rank_of(ast, fields, *field.function);
    std::ranges::stable_sort(fields, std::greater{}, [](const Field &field) {
        return std::pair(!is_flat_field(*field.function), field.rank);
    });
    for (std::size_t i = 0; i < std::min(fields.size(), most_tried); ++i)
        if (gives_distance(ev, ast, frame, fields[i])) return fields[i];
    return std::nullopt;
}

std::string line_of(const Field &field) {
    const std::string name(field.function->name->text);
    const bool flat = is_flat_field(*field.function);
    const std::string function =
        field.distance.empty() ? name : "p => " + name + "(p)" + field.distance;
    std::string line =
        (flat ? "implicit2(" : "implicit(") + function +
        (lang::names_a_scene(name) && !flat ? ", within: everywhere)" : ", within: ball(3))");
    if (flat) line += ".extrude(1)";
    if (!field.color.empty()) line += ".paint(p => " + name + "(p)" + field.color + ")";
    return line;
}

// The last function that gives a number for a point and more behind it.
const lang::Function *field_with_sizes(const File &ast) {
    const lang::Function *out = nullptr;
    for (const lang::Stmt &s : ast.blocks[ast.root].stmts) {
        const auto *declared = std::get_if<lang::FunctionDecl>(&s.kind);
        if (!declared) continue;
        const lang::Function &f = ast.functions[declared->function];
        if (f.parameters.size() < 2 || !f.result || f.result->named != lang::TypeName::Float)
            continue;
        const lang::TypeExpr *point = f.parameters[0].type;
        if (point && (point->named == lang::TypeName::Vec3 ||
                      (point->named == lang::TypeName::Vec2 && (!out || is_flat_field(*out)))))
            out = &f;
    }
    return out;
}

} // namespace

void report_no_shape(Interpreter &ev, const File &ast, std::uint32_t frame) {
    bool declares = false, could = false; // … a shape, at other values
    std::string_view shape;
    for (const lang::Stmt &s : ast.blocks[ast.root].stmts) {
        declares = declares || std::holds_alternative<lang::FunctionDecl>(s.kind);
        const auto *value = std::get_if<lang::ExprStmt>(&s.kind);
        could = could || std::holds_alternative<lang::For>(s.kind) ||
                std::holds_alternative<lang::While>(s.kind) ||
                (value && std::holds_alternative<lang::If>(ast.exprs[value->value].kind));
        const auto *let = std::get_if<lang::Let>(&s.kind);
        if (!let) continue;
        declares = true;
        const auto found = find_name(ev, frame, symbol_of(ast, let->name));
        if (!found) continue;
        if (ev.frames[found->frame].bindings[found->slot].value.kind == ValueKind::Shape)
            shape = let->name.text;
    }
    const Span begin{ast.source, 0, 0};
    if (!declares && !could) {
        report(ev, Code::EmptyScene, begin,
               "this file makes no shape, and declares nothing that another could import")
            .help("the smallest scene is `sphere(1)`");
        return;
    }
    Diagnostic &d =
        report(ev, Code::NothingDrawn, begin, "this file makes no shape, so nothing is drawn");
    const auto size = static_cast<std::uint32_t>(ev.sources[ast.source].text.size());
    const auto add = [&](const std::string &line) {
        const bool ended = ev.sources[ast.source].text.ends_with('\n');
        d.help(fmt::format("write `{}` on a line of its own, unless another file imports it", line),
               {{{ast.source, size, size}, (ended ? "" : "\n") + line + "\n"}});
    };
    if (!shape.empty())
        add(std::string(shape));
    else if (const auto field = field_of(ev, ast, frame))
        add(line_of(*field));
    else if (const lang::Function *given = field_with_sizes(ast))
        d.help(fmt::format("`{0}(p => {1}(p, …), within: ball(3)){2}` makes a shape of `{1}`",
                           is_flat_field(*given) ? "implicit2" : "implicit", given->name->text,
                           is_flat_field(*given) ? ".extrude(1)" : ""));
}

} // namespace fathom::typecheck
