// Files: the embedded library, imports, the scene's parameters, and the names that are there from
// the start.
#include "typecheck/interpreter.h"
#include "typecheck/remedies.h"

#include "base/text.h"
#include "lang/parse.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace fathom::typecheck {

static void declare_constants(Interpreter &ev) {
    auto let = [&](const char *name, Value v) {
        declare(ev, ev.prelude_frame, intern(ev, name), v, false, {});
    };
    let("pi", number(std::numbers::pi));
    let("tau", number(2 * std::numbers::pi));
    let("turn", number(2 * std::numbers::pi));
    let("X", vec(3, {1, 0, 0, 0}));
    let("Y", vec(3, {0, 1, 0, 0}));
    let("Z", vec(3, {0, 0, 1, 0}));
    let("inf", number(std::numeric_limits<double>::infinity()));
    let("none", none());
    let("time", make_value(ValueKind::Field, ev.scene.graph.time().index));
    let("everywhere", region_value(ev, {}));
    declare_colors(ev);
}

const std::vector<Builtin> &builtins() {
    static const std::vector<Builtin> table = [] {
        std::vector<Builtin> t;
        add_numeric_builtins(t);
        add_list_builtins(t);
        add_shape_builtins(t);
        add_transform_builtins(t);
        add_region_builtins(t);
        add_scene_builtins(t);
        add_texture_builtins(t);
        return t;
    }();
    return table;
}

void run_module(Interpreter &ev, std::uint32_t module, std::vector<Contribution> &out) {
    std::uint32_t before = std::exchange(ev.current_module, module);
    const File &ast = *ev.modules[module].ast;
    contribute_block(ev, ast, ast.root, ev.modules[module].frame, out);
    ev.current_module = before;
}

void make_module_frame(Interpreter &ev, std::uint32_t frame) {
    ev.frames[frame].index = std::make_unique<std::unordered_map<Symbol, std::uint32_t>>();
    ev.frames[frame].captured = true;
}

static const File &add_file(Interpreter &ev, lang::Ast ast) {
    File &file = ev.files.emplace_back();
    file.place = ev.files.size() - 1;
    static_cast<lang::Ast &>(file) = std::move(ast);
    for (const std::string &word : file.words) file.symbols.push_back(intern(ev, word));
    file.formals.resize(file.functions.size());
    return file;
}

const File &parse_file(Interpreter &ev, SourceId source, Diagnostics &diagnostics) {
    const std::size_t words = room_left(ev).bytes / 2 / lang::bytes_of_a_word;
    lang::Ast ast = lang::parse(ev.sources, source, diagnostics, words);
    ev.made += ast.exprs.size() * 2 * lang::bytes_of_a_word + ev.sources[source].text.size();
    return add_file(ev, std::move(ast));
}

static std::uint32_t add_module(Interpreter &ev, Module m) {
    m.frame = push_frame(ev, ev.prelude_frame);
    make_module_frame(ev, m.frame);
    ev.modules.push_back(std::move(m));
    return static_cast<std::uint32_t>(ev.modules.size() - 1);
}

static Module library_module(Interpreter &ev, const LibraryFile &file) {
    Module m;
    m.identity = fmt::format("library:{}", file.name);
    m.name = std::string(file.name);
    m.source = ev.sources.add(std::string(file.name), std::string(file.text));
    m.library = true;
    return m;
}

// Where each declaration of a prelude file stands. The library is written so that this is easy: all
// of them begin a line with `fn ` or `let `, and nothing else does.
static void find_items(Interpreter &ev, std::uint32_t module, std::string_view text) {
    LibraryItem *open = nullptr;
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view line = text.substr(at);
        const std::size_t word = line.starts_with("fn ") ? 3 : line.starts_with("let ") ? 4 : 0;
        if (word > 0) {
            const std::string_view rest = line.substr(word);
            const std::string_view name = rest.substr(0, rest.find_first_of(" :=(\n"));
            const auto begin = static_cast<std::uint32_t>(at);
            if (open) open->end = begin;
            auto &items = ev.prelude_items[intern(ev, std::string(name))];
            open = &items.emplace_back(LibraryItem{module, begin, 0});
        }
        at = std::min(text.find('\n', at), text.size() - 1) + 1;
    }
    if (open) open->end = static_cast<std::uint32_t>(text.size());
}

void read_prelude_items(Interpreter &ev, Symbol name) {
    const auto node = ev.prelude_items.extract(name);
    if (node.empty()) return;
    // what the library declares does not depend on who uses it first
    const int in_field = std::exchange(ev.in_field, 0);
    const std::uint32_t before = ev.current_module;
    for (const LibraryItem &item : node.mapped()) {
        ev.current_module = item.module;
        const File &file = add_file(ev, lang::parse_part(ev.sources, ev.modules[item.module].source,
                                                         item.begin, item.end, ev.diagnostics));
        std::vector<Contribution> dropped;
        contribute_block(ev, file, file.root, ev.prelude_frame, dropped);
    }
    ev.current_module = before;
    ev.in_field = in_field;
}

// All prelude files share one frame, the outermost, so that they see each other's private names.
void load_prelude(Interpreter &ev) {
    for (const Builtin &builtin : builtins()) intern(ev, builtin.name);
    ev.builtin_formals.resize(builtins().size());
    ev.prelude_frame = push_frame(ev, 0);
    make_module_frame(ev, ev.prelude_frame);
    Module none;
    none.name = "prelude";
    none.library = true;
    ev.modules.push_back(none);
    declare_constants(ev);
    for (const LibraryFile &file : ev.library) {
        if (!file.prelude) continue;
        Module m = library_module(ev, file);
        m.frame = ev.prelude_frame;
        m.loaded = true;
        ev.modules.push_back(std::move(m));
        find_items(ev, static_cast<std::uint32_t>(ev.modules.size() - 1), file.text);
    }
}

// -- imports -------------------------------------------------------------------------------------

static Value bring(Interpreter &ev, const lang::Import &import, std::uint32_t module,
                   std::uint32_t importer) {
    std::uint32_t frame = ev.modules[importer].frame;
    if (import.as) {
        declare(ev, frame, intern(ev, import.as->text), make_value(ValueKind::Module, module),
                false, import.as->span);
        return unit();
    }
    std::vector<Binding> all = ev.frames[ev.modules[module].frame].bindings;
    for (const Binding &b : all) {
        const std::string name = ev.symbol_names[b.name];
        if (name[0] == '_') continue;
        Frame &f = ev.frames[frame];
        auto [it, added] =
            f.index->try_emplace(b.name, static_cast<std::uint32_t>(f.bindings.size()));
        if (added) {
            f.bindings.push_back({b.name, b.value, false, import.path_span});
            continue;
        }
        if (f.bindings[it->second].value == b.value) continue; // the same thing by another way
        report(ev, Code::DuplicateName, import.path_span,
               fmt::format("`{}` is brought by this import, and there is one already", name))
            .label(f.bindings[it->second].declared, "declared here")
            .help("import one of them under a name: `import \"…\" as part`");
    }
    return unit();
}

std::string way_inside(std::string_view path) {
    const std::size_t slash = path.rfind('/');
    return fmt::format("if that file is yours, give its folder on the command line: `-I {}`",
                       slash == path.npos ? "."
                       : slash == 0       ? "/"
                                          : path.substr(0, slash));
}

static Value import_failed(Interpreter &ev, const lang::Import &import) {
    // the names it would have brought are unknown, so uses of them report nothing
    if (!import.as) ev.modules[ev.current_module].lacks_names = true;
    if (import.as)
        declare(ev, ev.modules[ev.current_module].frame, intern(ev, import.as->text), poison(),
                false, import.as->span);
    return poison();
}

Value import_module(Interpreter &ev, const lang::Import &import, Span, std::uint32_t importer) {
    for (const LibraryFile &file : ev.library) {
        if (file.prelude || file.name != import.path) continue;
        std::string identity = fmt::format("library:{}", file.name);
        for (std::uint32_t i = 0; i < ev.modules.size(); ++i)
            if (ev.modules[i].identity == identity) return bring(ev, import, i, importer);
        Module m = library_module(ev, file);
        m.ast = &parse_file(ev, m.source, ev.diagnostics);
        std::uint32_t module = add_module(ev, std::move(m));
        std::vector<Contribution> dropped;
        run_module(ev, module, dropped);
        ev.modules[module].loaded = true;
        return bring(ev, import, module, importer);
    }
    using Loaded = std::variant<LoadedText, LoadError>;
    if (!spend_on_lookup(ev, import.path_span, import.path)) return import_failed(ev, import);
    const auto long_name = too_long(import.path);
    Loaded loaded = long_name
                        ? Loaded(*long_name)
                        : ev.loader.text(std::string(import.path), ev.modules[importer].identity);
    if (auto *error = std::get_if<LoadError>(&loaded)) {
        Code code = error->reason == LoadError::Reason::Outside ? Code::ImportOutside
                                                                : Code::ImportNotFound;
        Diagnostic &d = report(ev, code, import.path_span,
                               fmt::format("`{}`: {}", short_name(import.path), error->why));
        if (error->reason == LoadError::Reason::NotFound)
            d.note("paths are relative to the importing file, then to the -I folders");
        else if (error->reason == LoadError::Reason::Outside)
            d.help(way_inside(import.path));
        for (const LibraryFile &file : ev.library)
            if (!file.prelude && import.path == fmt::format("{}.sdf", file.name))
                d.help(fmt::format("the library's own module goes by its name: `import \"{}\"`",
                                   file.name),
                       {{import.path_span, fmt::format("\"{}\"", file.name)}});
        return import_failed(ev, import);
    }
    LoadedText text = std::get<LoadedText>(std::move(loaded));
    constexpr std::size_t bytes_a_step = 64; // that are read
    if (!spend(ev, import.path_span, text.text.size() / bytes_a_step))
        return import_failed(ev, import);
    for (std::uint32_t i = 0; i < ev.modules.size(); ++i) {
        if (ev.modules[i].identity != text.identity) continue;
        if (ev.modules[i].loaded) return bring(ev, import, i, importer);
        std::string cycle;
        bool inside = false;
        for (std::uint32_t m : ev.importing) {
            inside = inside || m == i;
            if (inside) cycle += ev.modules[m].name + " imports ";
        }
        report(ev, Code::ImportCycle, import.path_span,
               fmt::format("these files import each other: {}{}", cycle, ev.modules[i].name))
            .help("move what both need into a file of its own");
        return import_failed(ev, import);
    }
    Module m;
    m.identity = text.identity;
    m.name = text.name;
    m.source = ev.sources.add(text.name, std::move(text.text));
    m.import_place = import.path_span;
    Diagnostics own;
    m.ast = &parse_file(ev, m.source, own);
    for (Diagnostic d : own.items()) {
        d.related.push_back({import.path_span, "imported here"});
        ev.diagnostics.add(std::move(d));
    }
    std::uint32_t module = add_module(ev, std::move(m));
    ev.importing.push_back(module);
    std::vector<Contribution>
        dropped; // a module's own shapes are seen only when it is opened itself
    run_module(ev, module, dropped);
    ev.importing.pop_back();
    ev.modules[module].loaded = true;
    check_names(ev, *ev.modules[module].ast, ev.modules[module].frame);
    return bring(ev, import, module, importer);
}

// -- parameters ----------------------------------------------------------------------------------

static std::optional<Value> param_number(Interpreter &ev, const File &ast, lang::ExprId id,
                                         const ir::Param &p, std::uint32_t frame) {
    Value v = eval(ev, ast, id, frame);
    if (is_poison(v)) return std::nullopt;
    lang::TypeExpr type;
    type.name = p.is_color ? "color" : ir::type_name(p.type);
    type.named = lang::type_named(type.name);
    bool ok = true;
    Value c = convert(ev, v, type, ast.exprs[id].span, quoted(p.name), ok);
    if (!ok || is_poison(c)) return std::nullopt;
    if (c.kind == ValueKind::Field) {
        report(ev, Code::StageMismatch, ast.exprs[id].span,
               "a parameter's value and range are known when the scene is read");
        return std::nullopt;
    }
    c = sized(ev, c, ast.exprs[id].span, quoted(p.name));
    if (is_poison(c)) return std::nullopt;
    return c;
}

// `-D name=text`: an expression of scene time in the file's own names.
static std::optional<Value> override_value(Interpreter &ev, const Override &o, const ir::Param &p,
                                           std::uint32_t frame) {
    Diagnostics own;
    SourceId source = ev.sources.add(fmt::format("-D {}", o.name), o.text);
    const File &ast = parse_file(ev, source, own);
    const lang::Block &root = ast.blocks[ast.root];
    const lang::ExprStmt *only =
        root.stmts.size() == 1 ? std::get_if<lang::ExprStmt>(&root.stmts[0].kind) : nullptr;
    if (own.has_errors() || !only) {
        ev.usage_errors.push_back(fmt::format("-D {}={}: this is not a value", o.name, o.text));
        return std::nullopt;
    }
    ++ev.quiet;
    std::size_t errors = std::exchange(ev.quiet_errors, 0);
    auto v = param_number(ev, ast, only->value, p, frame);
    bool failed = ev.quiet_errors > 0 || !v;
    ev.quiet_errors = errors;
    --ev.quiet;
    if (!failed) return v;
    const bool sizes = !p.is_color && (p.type == ir::Type::Float || ir::is_vector(p.type));
    ev.usage_errors.push_back(fmt::format("-D {}={}: `{}` is a {}{}", o.name, o.text, p.name,
                                          p.is_color ? "color" : ir::type_name(p.type),
                                          sizes ? ", from -1e18 to 1e18" : ""));
    return std::nullopt;
}

// The range is told as it is written: in degrees where it is.
static std::string written_range(const Interpreter &ev, const File &ast, const lang::Param &param,
                                 const ir::Param &p) {
    if (!param.low || !param.high) return fmt::format("{}..{}", p.lo[0], p.hi[0]);
    return std::string(
        text(ev.sources, join(ast.exprs[*param.low].span, ast.exprs[*param.high].span)));
}
static std::string outside_range(const Interpreter &ev, const File &ast, const lang::Param &param,
                                 const ir::Param &p, const Override &o) {
    std::string message = fmt::format("-D {}={} is outside its range {}", o.name, o.text,
                                      written_range(ev, ast, param, p));
    const bool plain = o.text.find_first_not_of("+-.0123456789") == std::string::npos;
    if (p.unit == "deg" && plain)
        message +=
            fmt::format("; {0} without a unit are radians, write -D {1}={0}deg", o.text, o.name);
    return message;
}

// Whether an end of a range is a whole number; what it is is told elsewhere.
static bool is_whole(Interpreter &ev, const File &ast, lang::ExprId id, std::uint32_t frame) {
    ++ev.quiet;
    const std::size_t errors = std::exchange(ev.quiet_errors, 0);
    const ValueKind kind = eval(ev, ast, id, frame).kind;
    ev.quiet_errors = errors;
    --ev.quiet;
    return kind != ValueKind::Float && kind != ValueKind::Field;
}

void declare_param(Interpreter &ev, const File &ast, const lang::Param &param,
                   std::uint32_t frame) {
    ir::Param p;
    p.name = param.name.text;
    p.label = param.label.value_or(param.name.text);
    p.origin = param.name.span;
    const Symbol name = symbol_of(ast, param.name);
    auto fail = [&] { declare(ev, frame, name, poison(), false, param.name.span); };
    Value value = eval(ev, ast, param.value, frame);
    if (param.type && !is_poison(value)) {
        bool ok = true;
        value = convert(ev, value, *param.type, ast.exprs[param.value].span, quoted(p.name), ok);
    }
    if (is_poison(value)) return fail();
    if (value.kind == ValueKind::List) {
        bool ok = true;
        lang::TypeExpr type;
        type.name = "vec3";
        type.named = lang::TypeName::Vec3;
        value = convert(ev, value, type, ast.exprs[param.value].span, quoted(p.name), ok);
        if (is_poison(value)) return fail();
    }
    if (!is_numeric(value) || value.kind == ValueKind::Field || value.kind == ValueKind::Mat) {
        Diagnostic &d =
            report(ev, Code::TypeMismatch, ast.exprs[param.value].span,
                   fmt::format("a parameter is a number, a bool, a vector or a color, this is {}",
                               describe(ev, value)));
        if (value.kind == ValueKind::String)
            d.help("a choice among words is one among numbers: `param kind = 0 in 0..1`, and "
                   "`if kind == 0 { … }`");
        return fail();
    }
    value = sized(ev, value, ast.exprs[param.value].span, quoted(p.name));
    if (is_poison(value)) return fail();
    p.type = numeric_type(ev, value);
    p.is_color = value.color;
    auto fill = [&](const Value &v) { return v.num; };
    for (std::size_t i = 0; i < 4; ++i)
        p.lo[i] = -std::numeric_limits<double>::infinity(), p.hi[i] = -p.lo[i];
    if (p.type == ir::Type::Bool || p.is_color) p.lo = {0, 0, 0, 0}, p.hi = {1, 1, 1, 1};
    if (param.low && param.high) {
        // a whole number with a range of floats is a float
        if (p.type == ir::Type::Int && !param.type &&
            (!is_whole(ev, ast, *param.low, frame) || !is_whole(ev, ast, *param.high, frame)))
            p.type = ir::Type::Float;
        if (p.type == ir::Type::Bool || p.is_color) {
            report_needless_range(ev, ast, param);
            return fail();
        }
        auto lo = param_number(ev, ast, *param.low, p, frame),
             hi = param_number(ev, ast, *param.high, p, frame);
        if (!lo || !hi) return fail();
        p.lo = fill(*lo), p.hi = fill(*hi);
        p.has_range = true;
        if (const auto *high = std::get_if<lang::Number>(&ast.exprs[*param.high].kind))
            p.unit = high->unit;
        for (int i = 0; i < ir::components(p.type); ++i) {
            auto k = static_cast<std::size_t>(i);
            if (p.lo[k] > p.hi[k]) {
                const Span low = ast.exprs[*param.low].span, high = ast.exprs[*param.high].span;
                const std::string ends[] = {source_text(ev, low), source_text(ev, high)};
                report(ev, Code::BadArgument, join(low, high), "this range ends before it begins")
                    .help(fmt::format("write `{}..{}`", ends[1], ends[0]),
                          {{low, ends[1]}, {high, ends[0]}});
                return fail();
            }
            if (value.num[k] < p.lo[k] || value.num[k] > p.hi[k]) {
                const bool below = value.num[k] < p.lo[k];
                const Span end = ast.exprs[below ? *param.low : *param.high].span;
                const std::string written = source_text(ev, ast.exprs[param.value].span);
                Diagnostic &d = report(
                    ev, Code::BadArgument, ast.exprs[param.value].span,
                    fmt::format("{} is outside its range {}..{}", value.num[k], p.lo[k], p.hi[k]));
                if (ir::components(p.type) == 1)
                    d.help(fmt::format("give a value within it, or let the range {} at {}",
                                       below ? "begin" : "end", written),
                           {{end, written}});
                return fail();
            }
        }
    } else if (p.type == ir::Type::Int) {
        const Span at = ast.exprs[param.value].span;
        const double n = value.num[0];
        const std::string range = n > 0 ? fmt::format("1..{}", std::max(10.0, 2 * n))
                                        : fmt::format("{}..{}", std::min(-10.0, 2 * n), 10);
        report(ev, Code::ParamRange, param.name.span, "a whole number as a parameter needs a range")
            .help(fmt::format("write `param {} = {} in {}`", p.name, value.num[0], range),
                  {{{at.source, at.end, at.end}, " in " + range}});
        return fail();
    }
    p.initial = p.value = fill(value);
    for (const Override &o : ev.options.overrides) {
        if (o.name != p.name || ev.modules[ev.current_module].library) continue;
        auto v = override_value(ev, o, p, frame);
        if (!v) continue;
        bool inside = true;
        for (int i = 0; i < ir::components(p.type); ++i)
            inside = inside && v->num[std::size_t(i)] >= p.lo[std::size_t(i)] &&
                     v->num[std::size_t(i)] <= p.hi[std::size_t(i)];
        if (!inside) {
            ev.usage_errors.push_back(outside_range(ev, ast, param, p, o));
            continue;
        }
        p.value = fill(*v);
    }
    ir::NodeId node =
        ev.scene.graph.param(static_cast<std::uint32_t>(ev.scene.params.size()), p.type);
    ev.param_nodes.push_back(node);
    Value v = make_value(ValueKind::Field, node.index);
    v.color = p.is_color;
    p.structural = std::ranges::find(ev.options.at_values, p.origin) != ev.options.at_values.end();
    if (p.structural) v = from_node(ev, ev.scene.graph.constant(p.present()), p.is_color);
    ev.scene.params.push_back(std::move(p));
    declare(ev, frame, name, v, false, param.name.span);
}

} // namespace fathom::typecheck
