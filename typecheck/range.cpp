// The numbers that a scene may hold: those of single precision, and `inf` where it has a meaning.
#include "typecheck/interpreter.h"

#include "base/single.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::typecheck {

static std::span<double> known_numbers(Interpreter &ev, Value &v) {
    if (v.kind == ValueKind::Float) return {v.num.data(), 1};
    if (v.kind == ValueKind::Vec) return {v.num.data(), v.size};
    if (v.kind == ValueKind::Mat)
        return {ev.matrices[v.id].data(), std::size_t{v.size} * std::size_t{v.size}};
    return {};
}

bool is_infinite(Interpreter &ev, Value v) {
    if (v.kind == ValueKind::List) // as many as a matrix has, and no lists in lists of lists
        return ev.lists[v.id].size() <= 16 && ev.list_heights[v.id] <= 2 &&
               std::ranges::any_of(ev.lists[v.id],
                                   [&](const Value &item) { return is_infinite(ev, item); });
    if (v.kind == ValueKind::Field) { // a vector that was written with a known part
        const ir::Graph &g = ev.scene.graph;
        const ir::NodeId node = to_node(ev, v);
        return g[node].op == ir::Op::Make &&
               std::ranges::any_of(g.args(node), [&](ir::NodeId part) {
                   const auto number = g.as_number(part);
                   return number && std::isinf(*number);
               });
    }
    return std::ranges::any_of(known_numbers(ev, v), [](double x) { return std::isinf(x); });
}

static void report_range(Interpreter &ev, Span place, double x) {
    if (std::isnan(x)) {
        report(ev, Code::NumberRange, place, "this is not a number")
            .help("`0 / 0`, `inf - inf` and the like have no value: write the number that is "
                  "meant");
        return;
    }
    report(ev, Code::NumberRange, place,
           fmt::format("this is {}, and single precision ends at 3.4e38",
                       std::isinf(x) ? "infinite" : format_shortest(x)))
        .help("write smaller numbers, or choose a larger unit of length");
}

Value in_range(Interpreter &ev, Value v, std::span<const Value> of, Span place) {
    for (double &x : known_numbers(ev, v)) {
        const bool meant =
            std::isinf(x) && std::ranges::any_of(of, [&](Value a) { return is_infinite(ev, a); });
        if (!fits_single(x) && !meant) {
            report_range(ev, place, x);
            return poison();
        }
        x = flushed(x);
    }
    return v;
}

static void report_infinite(Interpreter &ev, Span place, std::string message) {
    report(ev, Code::NumberRange, place, std::move(message))
        .help("write a number of the size that the scene has; `inf` stands for no limit, where a "
              "default is `inf`, and in comparisons, `min`, `max` and `clamp`");
}

bool finite_number(Interpreter &ev, const Value &v, Span place, What what) {
    if (!is_infinite(ev, v)) return true;
    report_infinite(ev, place,
                    fmt::format("{} wants a finite number, this is {}", what, print_value(ev, v)));
    return false;
}

Value sized(Interpreter &ev, Value v, Span place, What what) {
    if (!finite_number(ev, v, place, what)) return poison();
    if (v.kind == ValueKind::List) {
        std::vector<Value> items = ev.lists[v.id];
        bool changed = false;
        for (Value &item : items) {
            if (!spend(ev, place)) return poison();
            if (is_poison(item)) continue; // reported
            const Value in = sized(ev, item, place, what);
            if (is_poison(in)) return in;
            changed = changed || !(in == item);
            item = in;
        }
        return changed ? list_value(ev, std::move(items)) : v;
    }
    for (double &x : known_numbers(ev, v)) {
        if (std::abs(x) > longest) {
            report(ev, Code::NumberRange, place,
                   fmt::format("{} is at most 1e18, this is {}", what, print_value(ev, v)))
                .note("fields are computed in single precision, which has to hold the squares of "
                      "lengths")
                .help("choose another unit of length, so that sizes are near to 1");
            return poison();
        }
        if (std::abs(x) < shortest) x = 0;
    }
    return v;
}

Value computed(Interpreter &ev, const Value &v, std::span<const Value> of, Span place, What what) {
    if (v.kind == ValueKind::Field)
        for (const Value &a : of)
            if (is_infinite(ev, a)) {
                report_infinite(ev, place,
                                fmt::format("{} of a field wants finite numbers, one {}", what,
                                            a.kind == ValueKind::Field
                                                ? "holds `inf`"
                                                : "is " + print_value(ev, a)));
                return poison();
            }
    return in_range(ev, v, of, place);
}

std::optional<ir::NodeId> node_in_range(Interpreter &ev, ir::NodeId node, Span place) {
    const Value v = in_range(ev, from_node(ev, node), {}, place);
    return is_poison(v) ? std::nullopt : std::optional(to_node(ev, v));
}

} // namespace fathom::typecheck
