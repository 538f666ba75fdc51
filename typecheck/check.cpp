// The whole check: the library, the scene's file, what it contributes, and the scene put together.
#include "typecheck/check.h"

#include "base/suggest.h"
#include "lang/parse.h"
#include "typecheck/instances.h"
#include "typecheck/interpreter.h"
#include "typecheck/remedies.h"
#include "typecheck/undrawn.h"

#include "ir/background.h"
#include "ir/passes/param_reads.h"
#include "ir/passes/walk.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <new>
#include <pthread.h>
#include <set>
#include <sys/mman.h>

namespace fathom::typecheck {

ir::Lighting default_lighting(Interpreter &ev); // builtins/scene.cpp

namespace {

// Evaluation recurses with the scene's own recursion (max_depth, max_call_depth), so it gets a
// stack made for that: as large as the system grants, with as much left for what is evaluated.
// Evaluation ends in time before its end.
constexpr std::size_t most_stack = std::size_t{1} << 30; // reserved: pages come as they are touched
constexpr std::size_t least_stack = std::size_t{4} << 20;      // below, what is ours already serves
constexpr std::size_t most_of_one_step = std::size_t{1} << 18; // of a builtin, a report, the parser

// An address that evaluation on this thread's stack must not pass.
const char *end_of_stack() {
    pthread_attr_t attributes;
    void *lowest = nullptr;
    std::size_t size = 0;
    if (pthread_getattr_np(pthread_self(), &attributes) == 0) {
        pthread_attr_getstack(&attributes, &lowest, &size);
        pthread_attr_destroy(&attributes);
    }
    return static_cast<const char *>(lowest) + std::max(most_of_one_step, size / 16);
}

// Whether the system would map so many bytes of addresses.
bool is_granted(std::size_t bytes) {
    void *at = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return at != MAP_FAILED && munmap(at, bytes) == 0;
}

void with_stack(const std::function<void()> &work) {
    auto run = [](void *f) -> void * {
        (*static_cast<const std::function<void()> *>(f))();
        return nullptr;
    };
    for (std::size_t bytes = most_stack; bytes >= least_stack; bytes /= 4) {
        if (!is_granted(2 * bytes)) continue;
        pthread_attr_t attributes;
        pthread_attr_init(&attributes);
        pthread_attr_setstacksize(&attributes, bytes);
        pthread_t thread;
        const int failed =
            pthread_create(&thread, &attributes, run, const_cast<std::function<void()> *>(&work));
        pthread_attr_destroy(&attributes);
        if (failed != 0) continue;
        pthread_join(thread, nullptr);
        return;
    }
    work();
}

void apply(Interpreter &ev, const Setting &s) {
    switch (s.kind) {
    case Setting::Kind::Camera: ev.scene.camera = s.camera; break;
    case Setting::Kind::Light: ev.scene.lights.push_back(s.light); break;
    case Setting::Kind::Lighting: ev.scene.lighting = s.lighting; break;
    case Setting::Kind::Background: ev.scene.background = s.background; break;
    case Setting::Kind::Render: ev.scene.render = s.render; break;
    case Setting::Kind::Keep: ev.scene.kept.push_back(s.keep); break;
    }
}

// Of a flat scene.
void add_flat(Interpreter &ev, const Value &v, Span span, std::vector<ir::ShapeId> &shapes) {
    if (v.size != 2) {
        report(ev, Code::WrongPlace, span, "this is a solid, and a flat scene is of flat shapes")
            .help("`fathom slice --z 0` cuts solids; without a height it draws flat shapes");
        return;
    }
    ir::Shape thick;
    thick.kind = ir::ShapeKind::Extrude;
    thick.children = {shape_of(v)};
    thick.args = {ev.scene.graph.number(ev.options.flat_thickness)};
    const ir::ShapeId shape = ev.scene.shapes.add(std::move(thick));
    ev.scene.top_level.push_back({shape, span});
    shapes.push_back(shape);
}

// What stands behind an expression, which gets parentheses where operators stand in it.
static std::vector<Edit> behind(const Interpreter &ev, Span span, std::string call) {
    if (is_library_place(ev, span)) return {};
    const bool grouped = operand_source(ev, span) != source_text(ev, span);
    std::vector<Edit> edits{{{span.source, span.end, span.end}, (grouped ? ")" : "") + call}};
    if (grouped) edits.push_back({{span.source, span.begin, span.begin}, "("});
    return edits;
}

void add_top_level(Interpreter &ev, const Value &v, Span span, std::vector<ir::ShapeId> &shapes) {
    switch (v.kind) {
    case ValueKind::Poison:
    case ValueKind::Unit: return;
    case ValueKind::Setting: apply(ev, ev.settings[v.id]); return;
    case ValueKind::List:
        for (const Value &item : std::vector<Value>(ev.lists[v.id])) {
            if (!spend(ev, span)) return;
            add_top_level(ev, item, span, shapes);
        }
        return;
    case ValueKind::Shape:
        if (ev.options.flat_thickness > 0) {
            add_flat(ev, v, span, shapes);
            return;
        }
        if (v.size == 2) {
            report(ev, Code::FlatShape, span, "a flat shape has no thickness, so it cannot be seen")
                .help("make it solid: `.extrude(0.1)` or `.revolve()`",
                      behind(ev, span, ".extrude(0.1)"));
            return;
        }
        ev.scene.top_level.push_back({shape_of(v), span});
        shapes.push_back(shape_of(v));
        return;
    case ValueKind::None:
    case ValueKind::Bool:
    case ValueKind::Int:
    case ValueKind::Float:
    case ValueKind::Vec:
    case ValueKind::Mat:
    case ValueKind::Field:
    case ValueKind::String:
    case ValueKind::Range:
    case ValueKind::Closure:
    case ValueKind::Builtin:
    case ValueKind::Overloads:
    case ValueKind::ConstField:
    case ValueKind::CachedField:
    case ValueKind::ImageField:
    case ValueKind::Material:
    case ValueKind::Region:
    case ValueKind::Module: break;
    }
    Diagnostic &d =
        report(ev, Code::WrongPlace, span,
               fmt::format("the scene is made of shapes; {} does nothing here", describe(ev, v)));
    if (v.kind == ValueKind::Region && text(ev.sources, span).starts_with("ball("))
        d.help("a ball that is seen is a `sphere`",
               {{{span.source, span.begin, span.begin + 4}, "sphere"}});
    else if (v.kind == ValueKind::Closure && parameter_count(ev, v) == 1)
        d.help("a distance function becomes a shape with `implicit(…)`; any other is called");
    else if (const std::string_view name = text(ev.sources, span);
             v.kind == ValueKind::Closure && parameter_count(ev, v) == 3 &&
             name.find_first_of(" (") == name.npos)
        d.help("a function of three coordinates becomes a shape with `implicit`",
               {{span, fmt::format("implicit(p => {}(p.x, p.y, p.z), within: ball(3))", name)}});
    else if (is_function(v))
        d.help("call it: `name(…)`");
    else
        d.help("name it with `let`, or look at it with `print(…)`");
}

// A number that reaches a shape's form needs a range, since the proof holds for all its values
// (semantics.md, 18); what only paints does not.
void demand_ranges(Interpreter &ev) {
    ir::ParamReads geometry(ev.scene);
    geometry.form(ev.scene.root);
    for (std::size_t i = 0; i < ev.scene.params.size(); ++i) {
        const ir::Param p = ev.scene.params[i];
        if (p.has_range || p.is_color || p.type == ir::Type::Bool || !geometry.used(i)) continue;
        report(ev, Code::ParamRange, p.origin,
               fmt::format(
                   "`{}` shapes the scene, so it needs a range: the proof holds for all its values",
                   p.name))
            .help(
                ir::is_vector(p.type)
                    ? fmt::format("write `param {0} = … in -2..2`, one range for all its parts, or "
                                  "a vector at each end, `in {1}..{2}`",
                                  p.name, p.type == ir::Type::Vec2 ? "[0, 0]" : "[0, 0, 0]",
                                  p.type == ir::Type::Vec2 ? "[1, 2]" : "[1, 1, 2]")
                    : fmt::format("write `param {} = … in 0.5..2.0`", p.name));
    }
}

// A param of the scene's own file that neither forms, colours, lights nor frames anything. An
// imported file may have some that this scene has no use for, and a file that makes no shape is
// there to be imported. `only` leaves shapes out for a while.
void tell_unused_params(Interpreter &ev, SourceId root) {
    const ir::Scene &scene = ev.scene;
    if (ev.diagnostics.has_errors() || scene.top_level.empty() || !ev.only_shapes.empty()) return;
    ir::ParamReads reads(scene);
    reads.form(scene.root);
    for (const ir::Material &m : scene.shapes.materials)
        for (ir::NodeId id : {m.diffuse, m.specular, m.exponent, m.emission}) reads.node(id);
    for (const ir::Light &light : scene.lights) reads.node(light.position), reads.node(light.color);
    for (const ir::FunctionId field : scene.fields) reads.node(scene.graph.function(field).result);
    const ir::Lighting &l = scene.lighting;
    for (ir::NodeId id : {l.ambient, l.ambient_occlusion, l.shadow_darkness, l.soft_shadows,
                          l.specular_intensity, l.fill, l.occlusion_reach, scene.camera.at,
                          scene.camera.look_at, scene.camera.fov, scene.background})
        reads.node(id);
    for (std::size_t i = 0; i < scene.params.size(); ++i) {
        const ir::Param &p = scene.params[i];
        if (p.structural || reads.used(i) || p.origin.source != root) continue;
        report(ev, Code::UnusedParam, p.origin,
               fmt::format("nothing in the scene reads `{}`: moving it changes nothing", p.name))
            .help("use it, or leave it out");
    }
}

// What was asked for beside the solid, in the names of the scene's file.
void add_fields(Interpreter &ev, std::uint32_t frame) {
    ir::Graph &graph = ev.scene.graph;
    for (const std::string &text : ev.options.fields) {
        const SourceId source = ev.sources.add("--field", text);
        const File &ast = parse_file(ev, source, ev.diagnostics);
        const std::vector<lang::Stmt> &stmts = ast.blocks[ast.root].stmts;
        const auto *only =
            stmts.size() == 1 ? std::get_if<lang::ExprStmt>(&stmts[0].kind) : nullptr;
        const Span whole{source, 0, static_cast<std::uint32_t>(text.size())};
        const Value given = only ? eval(ev, ast, only->value, frame) : poison();
        if (is_poison(given)) {
            if (!ev.diagnostics.has_errors())
                report(ev, Code::TypeMismatch, whole, "this is no function of the point")
                    .help("name one of the scene's file, or write one: `p => noise(4 * p)`");
            continue;
        }
        const auto value = apply_any(ev, given, whole, "a volume");
        if (!value) continue;
        const ir::NodeId point = graph.fresh_var(ir::Type::Vec3);
        const ir::NodeId result = ir::substitute(graph, *value, {{graph.point(), point}});
        ev.scene.fields.push_back(graph.add_function({"field", {}, {point}, result}));
    }
}

void build_scene(Interpreter &ev, const std::vector<Contribution> &contributions, const File &ast,
                 std::uint32_t frame) {
    ir::Scene &scene = ev.scene;
    scene.lighting = default_lighting(ev);
    scene.background = ir::usual_background(scene.graph);
    std::vector<ir::ShapeId> shapes;
    for (const Contribution &c : contributions) add_top_level(ev, c.value, c.span, shapes);
    bool some_only = false;
    for (ir::ShapeId s : shapes) some_only = some_only || ev.only_shapes.count(s.index) > 0;
    if (some_only) {
        std::erase_if(shapes, [&](ir::ShapeId s) { return ev.only_shapes.count(s.index) == 0; });
        std::erase_if(scene.top_level, [&](const ir::TopLevel &t) {
            return ev.only_shapes.count(t.shape.index) == 0;
        });
    }
    if (shapes.empty() && !ev.diagnostics.has_errors()) report_no_shape(ev, ast, frame);
    scene.root = unite(ev, std::move(shapes), 3, ast.blocks[ast.root].span);
    add_fields(ev, frame);
    demand_ranges(ev);
    tell_unused_params(ev, ast.source);
}

} // namespace

Checked check(Sources &sources, SourceId root, const std::string &root_identity,
              const std::vector<LibraryFile> &library, const Loader &loader, const Options &options,
              Diagnostics &diagnostics) {
    Checked out;
    const auto run = [&] {
        Interpreter ev{sources, diagnostics, library, loader, options};
        ev.stack_end = end_of_stack();
        load_prelude(ev);
        Module m;
        m.identity = root_identity;
        m.name = sources[root].name;
        m.source = root;
        m.ast = &parse_file(ev, root, diagnostics);
        const File &ast = *m.ast;
        m.frame = push_frame(ev, ev.prelude_frame);
        make_module_frame(ev, m.frame);
        ev.modules.push_back(m);
        auto module = static_cast<std::uint32_t>(ev.modules.size() - 1);
        ev.importing.push_back(module);
        std::vector<Contribution> contributions;
        run_module(ev, module, contributions);
        ev.current_module = module;
        check_names(ev, ast, m.frame);
        build_scene(ev, contributions, ast, m.frame);
        tell_hiding_functions(ev);
        for (const Override &o : options.overrides) {
            std::vector<std::string> names;
            for (const ir::Param &p : ev.scene.params) names.push_back(p.name);
            if (std::ranges::find(names, o.name) != names.end()) continue;
            const std::string near = nearest_name(o.name, names);
            const std::string way = !near.empty() ? fmt::format("; did you mean `{}`?", near)
                                    : names.empty()
                                        ? "; it has none"
                                        : fmt::format("; it has `{}`", fmt::join(names, "`, `"));
            ev.usage_errors.push_back(
                fmt::format("-D {}: the scene has no parameter of this name{}", o.name, way));
        }
        out.names = name_facts(ev, m.frame, root);
        out.scene = std::move(ev.scene);
        out.usage_errors = std::move(ev.usage_errors);
        out.evaluations = ev.evaluations;
        out.over_limit = ev.out_of_budget;
    };
    with_stack([&] { // no exception leaves a thread
        try {
            run();
        } catch (const std::bad_alloc &) {
            out = {};
            out.no_memory = true;
        }
    });
    return out;
}

static std::string text_of(const Sources &sources, SourceId source, Span span) {
    return sources[source].text.substr(span.begin, span.end - span.begin);
}

// A function's head on one line, however it is laid out.
static std::string on_one_line(const std::string &head) {
    std::string out;
    for (char c : head) {
        const bool blank = c == ' ' || c == '\n';
        if (blank && (out.empty() || out.back() == ' ' || out.back() == '(')) continue;
        if (c == ')' && !out.empty() && out.back() == ' ') out.pop_back();
        out += blank ? ' ' : c;
    }
    return out;
}

std::vector<LibraryEntry> library_entries(const std::vector<LibraryFile> &library) {
    std::vector<LibraryEntry> out;
    Sources sources;
    Diagnostics diagnostics;
    for (const LibraryFile &file : library) {
        SourceId id = sources.add(std::string(file.name), std::string(file.text));
        const std::string module = file.prelude ? "" : std::string(file.name);
        lang::Ast ast = lang::parse(sources, id, diagnostics);
        for (const lang::Stmt &s : ast.blocks[ast.root].stmts) {
            if (auto *f = std::get_if<lang::FunctionDecl>(&s.kind)) {
                const lang::Function &fn = ast.functions[f->function];
                if (!fn.name || fn.name->text[0] == '_') continue;
                std::string head = on_one_line(text_of(sources, id, fn.head));
                out.push_back({std::string(fn.name->text),
                               head.starts_with("fn ") ? head.substr(3) : head, std::string(fn.doc),
                               std::string(file.name), module});
            } else if (auto *l = std::get_if<lang::Let>(&s.kind)) {
                if (const std::string name(l->name.text); name[0] != '_')
                    out.push_back(
                        {name, name, std::string(l->doc), std::string(file.name), module});
            }
        }
    }
    for (const Builtin &b : builtins()) {
        if (b.library_only) continue;
        std::string signature = b.name + "(";
        for (std::size_t i = 0; i < b.parameters.size(); ++i)
            signature +=
                (i ? ", " : "") + b.parameters[i].name + (b.parameters[i].optional ? " = …" : "");
        out.push_back({b.name, signature + ")", b.doc, "built in", ""});
    }
    // What is visible everywhere first: `box` means that one.
    std::stable_partition(out.begin(), out.end(),
                          [](const LibraryEntry &e) { return e.module.empty(); });
    return out;
}

} // namespace fathom::typecheck
