// How the checker speaks: where an error is shown, and values in words.
#include "typecheck/conditions.h"
#include "typecheck/interpreter.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>

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
    if (ev.out_of_budget) { // what comes of that is no cause of its own
        swallowed = {};
        return swallowed;
    }
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
    if (reads.point || reads.normal || reads.direction) return;
    const Shown where = shown(ev, place);
    ev.scene.conditions.push_back(
        {condition, where.at, with_place(std::move(wanted), where.inside)});
}

Span users_place(const Interpreter &ev, Span place) { return shown(ev, place).at; }

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

// Appends what is printed of a value, until the text is long: a list of lists that share their parts
// may print without end.
static void print_into(const Interpreter &ev, const Value &v, std::string &out) {
    constexpr std::size_t most_items = 100, most_bytes = 10'000;
    switch (v.kind) {
    case ValueKind::Bool: out += v.num[0] != 0 ? "true" : "false"; return;
    case ValueKind::Int:
    case ValueKind::Float: out += format_shortest(v.num[0]); return;
    case ValueKind::Vec: {
        out += v.color ? "rgb(" : "[";
        for (int i = 0; i < v.size; ++i)
            out += (i ? ", " : "") + format_shortest(v.num[static_cast<std::size_t>(i)]);
        out += v.color ? ")" : "]";
        return;
    }
    case ValueKind::Mat: {
        out += fmt::format("mat{}(", int{v.size});
        for (int i = 0; i < v.size * v.size; ++i)
            out +=
                (i ? ", " : "") + format_shortest(ev.matrices[v.id][static_cast<std::size_t>(i)]);
        out += ")";
        return;
    }
    case ValueKind::String: out += ev.strings[v.id]; return;
    case ValueKind::List: {
        out += "[";
        for (std::size_t i = 0; i < ev.lists[v.id].size(); ++i) {
            if (i > 0) out += ", ";
            if (i == most_items || out.size() > most_bytes) {
                out += "…";
                break;
            }
            print_into(ev, ev.lists[v.id][i], out);
        }
        out += "]";
        return;
    }
    case ValueKind::Range:
        out += v.num[2] == 1 ? fmt::format("{}..{}", v.num[0], v.num[1])
                             : fmt::format("range({}, {}, {})", v.num[0], v.num[1], v.num[2]);
        return;
    case ValueKind::Field:
        out += fmt::format("{} that depends on the point, a param or time", describe(ev, v));
        return;
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
    case ValueKind::Module: out += describe(ev, v); return;
    }
}

std::string print_value(const Interpreter &ev, const Value &v) {
    std::string out;
    print_into(ev, v, out);
    return out;
}

// About what 1.4 million nodes of one field took, over their number: 1.6 GB.
std::size_t bytes_of_long_field(const Interpreter &ev) {
    constexpr std::size_t free = 1'000, each = 1'000; // nodes; bytes, as measured
    const std::size_t nodes = ev.field_start ? ev.scene.graph.size() - *ev.field_start : 0;
    return nodes > free ? (nodes - free) * each : 0;
}

// Bytes of all that evaluation made: of shapes with the facts that the proof will add.
static std::size_t held(const Interpreter &ev) {
    return ev.made + ev.scene.graph.bytes() + ev.scene.shapes.bytes() + bytes_of_long_field(ev) +
           ev.closures.size() * sizeof(Closure) + ev.frame_count * (sizeof(Frame) + 128) +
           ev.matrices.size() * sizeof(ev.matrices[0]) +
           ev.scene.shapes.materials.size() * sizeof(ir::Material) +
           ev.materials.size() * sizeof(ir::Material) + ev.settings.size() * sizeof(Setting) +
           ev.remembered.size() * 256 + ev.reported.size() * 64 + ev.journal.size() * 64;
}

// The one error that no trial may hide.
static bool refuse(Interpreter &ev, Code code, Span place, const char *what,
                   std::size_t Limits::*limit, const char *help) {
    if (ev.out_of_budget) return false;
    const int quiet = std::exchange(ev.quiet, 0);
    Diagnostic &d = report(ev, code, place, what);
    if (limit)
        d.note(limit_note(ev.options.limits, limit))
            .note(help)
            .help(limit_help(ev.options.limits, limit));
    else
        d.help(help);
    ev.quiet = quiet;
    ev.out_of_budget = true;
    return false;
}

bool has_room(Interpreter &ev, Span place, std::size_t bytes) {
    if (ev.out_of_budget) return false;
    const std::size_t most = ev.options.limits.memory * mebibyte, now = held(ev);
    if (now <= most && bytes <= most - now) return true;
    return refuse(ev, Code::MemoryLimit, place, "this scene takes more memory than is allowed",
                  &Limits::memory,
                  "look for a list, a string or a field that grows with every iteration");
}

Room room_left(const Interpreter &ev) {
    const auto left = [](std::size_t most, std::size_t used) {
        return most - std::min(most, used);
    };
    return {left(ev.options.limits.memory * mebibyte, held(ev)),
            left(ev.options.limits.work, ev.evaluations), ev.options.limits.pixels};
}

bool spend(Interpreter &ev, Span place, std::size_t amount) {
    const std::size_t before = ev.evaluations;
    ev.evaluations += amount;
    if (ev.out_of_budget) return false;
    if (ev.options.stop && ev.options.stop->after(amount)) { // nobody hears what would be said
        ev.out_of_budget = true;
        return false;
    }
    if (ev.evaluations > ev.options.limits.work)
        return refuse(ev, Code::LoopLimit, place, "this scene takes more work than is allowed",
                      &Limits::work,
                      "look for a loop or a recursion that does not end where it should");
    if (ev.list_height > max_list_height)
        return refuse(ev, Code::RecursionLimit, place, "lists are nested too deep here", nullptr,
                      "a list in a list in a list ends after 256; `concat` joins lists");
    if (ev.scene.shapes.tallest() > max_shape_height)
        return refuse(ev, Code::RecursionLimit, place, "shapes are nested too deep here", nullptr,
                      "a shape made of a shape, and so on, ends after 1000; `union { … }` and "
                      "`difference { … }` take many at once");
    constexpr std::size_t often = 64; // counting has a price of its own
    return before / often == ev.evaluations / often || has_room(ev, place, 0);
}

} // namespace fathom::typecheck
