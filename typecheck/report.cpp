// How the checker speaks: where an error is shown, and values in words.
#include "typecheck/interpreter.h"

#include "base/text.h"

#include <fmt/format.h>

namespace fathom::typecheck {

bool is_library_place(const Interpreter &ev, Span span) {
    if (!span.source) return true;
    for (const Module &m : ev.modules)
        if (m.library && m.source == span.source) return true;
    return false;
}

namespace {

// Where something is shown, and of which call of the user's it is true.
struct Shown {
    Span at, of_call;
    std::string_view inside, called;
};

// What is wrong inside the library is the caller's: it is shown at the innermost call that the user
// wrote.
Shown shown(const Interpreter &ev, Span place) {
    auto of_library = [&](Span span) { return is_library_place(ev, span); };
    Shown out{place, {}, {}, {}};
    const bool in_library = of_library(place);
    for (std::size_t i = ev.calls.size(); i-- > 0;) {
        const ActiveCall &call = ev.calls[i];
        if (of_library(call.call)) continue;
        if (in_library) {
            out.at = call.call, out.inside = call.name;
            break;
        }
        // a generic body is wrong only for this call: say which
        if (call.library || call.name.empty() || call.call == place) continue;
        out.of_call = call.call, out.called = call.name;
        break;
    }
    return out;
}

std::string with_place(std::string message, std::string_view inside) {
    if (!inside.empty() && message.find(fmt::format("`{}`", inside)) == std::string::npos)
        message += fmt::format(", in `{}`", inside);
    return message;
}

} // namespace

Diagnostic &report(Interpreter &ev, Code code, Span place, std::string message) {
    static thread_local Diagnostic swallowed;
    if (code_severity(code) == Severity::Error && ev.quiet > 0) {
        ++ev.quiet_errors;
        swallowed = {};
        return swallowed;
    }
    if (ev.quiet > 0) {
        swallowed = {};
        return swallowed;
    }
    const Shown where = shown(ev, place);
    // In a loop the same thing is wrong in every iteration.
    const std::array<std::uint32_t, 6> key{
        static_cast<std::uint32_t>(code), where.at.source.index, where.at.begin, where.at.end,
        where.of_call.source.index,       where.of_call.begin};
    if (code_severity(code) != Severity::Note && !ev.reported.insert(key).second) {
        swallowed = {};
        return swallowed;
    }
    Diagnostic &d =
        ev.diagnostics.add(code, where.at, with_place(std::move(message), where.inside));
    if (!where.called.empty())
        d.label(where.of_call, fmt::format("in this call of `{}`", where.called));
    return d;
}

void require(Interpreter &ev, ir::NodeId condition, Span place, std::string wanted) {
    const ir::Graph::Reads reads = ev.scene.graph.reads(condition);
    if (ev.quiet > 0 || reads.point || reads.normal || reads.direction) return;
    const Shown where = shown(ev, place);
    ev.scene.conditions.push_back(
        {condition, where.at, with_place(std::move(wanted), where.inside)});
}

static const char *vector_name(int size) {
    return size == 2 ? "vec2" : size == 3 ? "vec3" : "vec4";
}

std::string describe(const Interpreter &ev, const Value &v) {
    switch (v.kind) {
    case ValueKind::Poison: return "something wrong";
    case ValueKind::Unit: return "nothing";
    case ValueKind::None: return "nothing";
    case ValueKind::Bool: return "a bool";
    case ValueKind::Int: return "an int";
    case ValueKind::Float: return "a float";
    case ValueKind::Vec: return v.color ? "a color" : fmt::format("a {}", vector_name(v.size));
    case ValueKind::Mat: return fmt::format("a mat{}", int{v.size});
    case ValueKind::Field: {
        if (v.color) return "a color";
        ir::Type type = ev.scene.graph[node_of(v)].type;
        return fmt::format("{} {}", type == ir::Type::Int ? "an" : "a", ir::type_name(type));
    }
    case ValueKind::String: return "a string";
    case ValueKind::List: return fmt::format("a list of {}", ev.lists[v.id].size());
    case ValueKind::Range: return "a range";
    case ValueKind::Closure:
    case ValueKind::Builtin:
    case ValueKind::Overloads: return "a function";
    case ValueKind::ConstField:
    case ValueKind::CachedField:
    case ValueKind::ImageField: return "a field";
    case ValueKind::Shape: return v.size == 2 ? "a flat shape" : "a shape";
    case ValueKind::Material: return "a material";
    case ValueKind::Region: return "a region";
    case ValueKind::Setting: return "a scene setting";
    case ValueKind::Module: return "a module";
    }
    return "";
}

std::string print_value(const Interpreter &ev, const Value &v) {
    switch (v.kind) {
    case ValueKind::Bool: return v.num[0] != 0 ? "true" : "false";
    case ValueKind::Int:
    case ValueKind::Float: return format_shortest(v.num[0]);
    case ValueKind::Vec: {
        std::string out = v.color ? "rgb(" : "[";
        for (int i = 0; i < v.size; ++i)
            out += (i ? ", " : "") + format_shortest(v.num[static_cast<std::size_t>(i)]);
        return out + (v.color ? ")" : "]");
    }
    case ValueKind::Mat: {
        std::string out = fmt::format("mat{}(", int{v.size});
        for (int i = 0; i < v.size * v.size; ++i)
            out +=
                (i ? ", " : "") + format_shortest(ev.matrices[v.id][static_cast<std::size_t>(i)]);
        return out + ")";
    }
    case ValueKind::String: return ev.strings[v.id];
    case ValueKind::List: {
        std::string out = "[";
        for (std::size_t i = 0; i < ev.lists[v.id].size(); ++i) {
            if (i == 100) return out + ", …]";
            out += (i ? ", " : "") + print_value(ev, ev.lists[v.id][i]);
        }
        return out + "]";
    }
    case ValueKind::Range:
        return v.num[2] == 1 ? fmt::format("{}..{}", v.num[0], v.num[1])
                             : fmt::format("range({}, {}, {})", v.num[0], v.num[1], v.num[2]);
    case ValueKind::Field:
        return fmt::format("{} that depends on the point, a param or time", describe(ev, v));
    case ValueKind::Poison:
    case ValueKind::Unit:
    case ValueKind::None:
    case ValueKind::Closure:
    case ValueKind::Builtin:
    case ValueKind::Overloads:
    case ValueKind::ConstField:
    case ValueKind::CachedField:
    case ValueKind::ImageField:
    case ValueKind::Shape:
    case ValueKind::Material:
    case ValueKind::Region:
    case ValueKind::Setting:
    case ValueKind::Module: return describe(ev, v);
    }
    return "";
}

bool spend(Interpreter &ev, Span place, std::size_t amount) {
    ev.evaluations += amount;
    if (ev.out_of_budget) return false;
    if (ev.evaluations <= ev.options.max_evaluations &&
        ev.list_elements <= ev.options.max_list_elements)
        return true;
    ev.out_of_budget = true;
    int quiet = std::exchange(ev.quiet, 0); // the one error that no trial may hide
    report(ev, Code::LoopLimit, place, "this scene takes more work than is allowed")
        .note(fmt::format("scene time may take {} evaluations and {} list elements",
                          ev.options.max_evaluations, ev.options.max_list_elements))
        .help("look for a loop or a recursion that does not end where it should");
    ev.quiet = quiet;
    return false;
}

} // namespace fathom::typecheck
