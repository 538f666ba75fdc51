// Lists, randomness and what helps to look into a scene: scene time only.
#include "typecheck/conditions.h"
#include "typecheck/interpreter.h"
#include "typecheck/remedies.h"

#include "base/text.h"
#include "ir/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fathom::typecheck {

static Value len_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (args[0].kind == ValueKind::String) return integer(double(ev.strings[args[0].id].size()));
    if (args[0].kind == ValueKind::List) return integer(double(ev.lists[args[0].id].size()));
    if (args[0].kind == ValueKind::Range)
        return integer(
            std::max(0.0, std::ceil((args[0].num[1] - args[0].num[0]) / args[0].num[2])));
    auto list = want_list(ev, args[0], site.arg(0), "`len`");
    return list ? integer(double(list->size())) : poison();
}

static bool wants_function(Interpreter &ev, const CallSite &site, const Value &v, std::size_t i) {
    if (is_function(v)) return true;
    report(ev, Code::TypeMismatch, site.arg(i),
           fmt::format("`{}` wants a function, this is {}", site.name, describe(ev, v)));
    return false;
}

// `map(f, list)`, as Python has it: reported, with both in our order.
static bool list_stands_first(Interpreter &ev, const CallSite &site, const std::vector<Value> &args,
                              std::size_t f) {
    const auto is_list = [](const Value &v) {
        return v.kind == ValueKind::List || v.kind == ValueKind::Range || v.kind == ValueKind::Vec;
    };
    if (!is_function(args[0])) return true;
    const auto other = std::ranges::find_if(args, is_list);
    if (other == args.end()) return true;
    const Span a = site.arg(0), b = site.arg(static_cast<std::size_t>(other - args.begin()));
    Diagnostic &d =
        report(ev, Code::TypeMismatch, a,
               fmt::format("the list stands first in `{}`, the function last", site.name));
    if (args.size() == 2 && f == 1 && !is_library_place(ev, a) && a.source == b.source)
        d.help("change their places",
               {{a, std::string(text(ev.sources, b))}, {b, std::string(text(ev.sources, a))}});
    else
        d.help(fmt::format("as in `{}`",
                           f == 1 ? "map(list, x => 2 * x)" : "fold(list, 0, (a, b) => a + b)"));
    return false;
}

static Value map_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (!list_stands_first(ev, site, args, 1)) return poison();
    auto list = want_list(ev, args[0], site.arg(0), "`map`");
    if (!list || !wants_function(ev, site, args[1], 1)) return poison();
    std::vector<Value> out;
    for (const Value &item : *list) {
        if (!spend(ev, site.call)) return poison();
        out.push_back(call_with(ev, args[1], {item}, site.arg(1)));
        if (is_poison(out.back())) return poison();
    }
    return list_value(ev, std::move(out));
}

static Value filter_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (!list_stands_first(ev, site, args, 1)) return poison();
    auto list = want_list(ev, args[0], site.arg(0), "`filter`");
    if (!list || !wants_function(ev, site, args[1], 1)) return poison();
    std::vector<Value> out;
    for (const Value &item : *list) {
        if (!spend(ev, site.call)) return poison();
        auto keep = want_known_bool(ev, call_with(ev, args[1], {item}, site.arg(1)), site.arg(1),
                                    "`filter`'s function");
        if (!keep) return poison();
        if (*keep) out.push_back(item);
    }
    return list_value(ev, std::move(out));
}

static Value fold_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (!list_stands_first(ev, site, args, 2)) return poison();
    auto list = want_list(ev, args[0], site.arg(0), "`fold`");
    if (!list || !wants_function(ev, site, args[2], 2)) return poison();
    Value total = args[1];
    for (const Value &item : *list) {
        if (!spend(ev, site.call)) return poison();
        total = call_with(ev, args[2], {total, item}, site.arg(2));
        if (is_poison(total)) return poison();
    }
    return total;
}

static Value zip_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto a = want_list(ev, args[0], site.arg(0), "`zip`"),
         b = want_list(ev, args[1], site.arg(1), "`zip`");
    if (!a || !b || !wants_function(ev, site, args[2], 2)) return poison();
    if (a->size() != b->size()) {
        report(ev, Code::BadArgument, site.call,
               fmt::format("`zip` pairs lists of one length, these have {} and {} elements",
                           a->size(), b->size()));
        return poison();
    }
    std::vector<Value> out;
    for (std::size_t i = 0; i < a->size(); ++i) {
        if (!spend(ev, site.call)) return poison();
        out.push_back(call_with(ev, args[2], {(*a)[i], (*b)[i]}, site.arg(2)));
        if (is_poison(out.back())) return poison();
    }
    return list_value(ev, std::move(out));
}

static Value concat_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    std::vector<Value> out;
    std::vector<Value> lists{args[0]};
    if (!is(args[1], ValueKind::None)) {
        auto rest = want_list(ev, args[1], site.arg(1), "`concat`");
        if (!rest) return poison();
        lists.insert(lists.end(), rest->begin(), rest->end());
    } else {
        auto all = want_list(ev, args[0], site.arg(0), "`concat`");
        if (!all) return poison();
        lists = *all;
    }
    for (const Value &l : lists) {
        auto items = want_list(ev, l, site.call, "`concat`");
        if (!items || !spend(ev, site.call, items->size()) ||
            !has_room(ev, site.call, (out.size() + items->size()) * sizeof(Value)))
            return poison();
        out.insert(out.end(), items->begin(), items->end());
    }
    return list_value(ev, std::move(out));
}

static Value reverse_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto list = want_list(ev, args[0], site.arg(0), "`reverse`");
    if (!list) return poison();
    std::reverse(list->begin(), list->end());
    return list_value(ev, std::move(*list));
}

static Value sort_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto list = want_list(ev, args[0], site.arg(0), "`sort`");
    if (!list) return poison();
    std::vector<std::pair<double, Value>> keyed;
    for (const Value &item : *list) {
        if (!spend(ev, site.call)) return poison();
        Value key =
            is(args[1], ValueKind::None) ? item : call_with(ev, args[1], {item}, site.arg(1));
        auto k = want_known_number(
            ev, key, site.arg(0),
            is(args[1], ValueKind::None) ? "`sort` without a key" : "`sort`'s key", Limit::None);
        if (!k) return poison();
        keyed.emplace_back(*k, item);
    }
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const auto &a, const auto &b) { return a.first < b.first; });
    std::vector<Value> out;
    for (auto &[k, v] : keyed) out.push_back(v);
    return list_value(ev, std::move(out));
}

static Value range_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    bool whole = true;
    for (const Value &a : args)
        whole = whole && (a.kind == ValueKind::Int || a.kind == ValueKind::None);
    auto a = want_known_number(ev, args[0], site.arg(0), "`range`", Limit::Finite),
         b = want_known_number(ev, args[1], site.arg(1), "`range`", Limit::Finite);
    std::optional<double> step = 1.0;
    if (!is(args[2], ValueKind::None))
        step = want_known_number(ev, args[2], site.arg(2), "`range`'s step", Limit::Finite);
    if (!a || !b || !step) return poison();
    if (*step == 0) {
        report(ev, Code::BadArgument, site.arg(2), "`range` wants a step that is not 0");
        return poison();
    }
    const double count = std::clamp(std::ceil((*b - *a) / *step - 1e-9), 0.0, 1e18);
    if (!may_list(ev, site.call, static_cast<std::size_t>(count))) return poison();
    std::vector<Value> out;
    for (double i = 0; i < count; ++i)
        out.push_back(whole ? integer(*a + i * *step) : number(*a + i * *step));
    return list_value(ev, std::move(out));
}

// -- randomness: a 64-bit mix (the finalizer's form is Steele, Lea and Flood's SplitMix) of the
// seed's bits and a counter

static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}
static double random_unit(double seed, double k) {
    std::uint64_t a, b;
    if (seed == 0) seed = 0; // -0 is 0
    if (k == 0) k = 0;
    std::memcpy(&a, &seed, sizeof a);
    std::memcpy(&b, &k, sizeof b);
    return double(mixed(mixed(a) ^ (b + 0x632be59bd9b4e019ull)) >> 11) * 0x1p-53;
}

static std::optional<double> seed_of(Interpreter &ev, const CallSite &site, const Value &v,
                                     std::size_t i) {
    if (is_numeric(v) && ir::is_vector(numeric_type(ev, v)) && v.kind == ValueKind::Vec) {
        double total = 0;
        for (int c = 0; c < v.size; ++c)
            total = random_unit(total, v.num[std::size_t(c)]) * 4294967296.0;
        return total;
    }
    return want_known_number(ev, v, site.arg(i), "a seed", Limit::Finite);
}

// `random(0.2, 0.5)`: bounds elsewhere, a seed and its second number here.
static void warn_of_bounds(Interpreter &ev, const CallSite &site, std::span<const Value> args) {
    const Span place = site.call;
    const bool below = is(args[0], ValueKind::Int) && args[0].num[0] < 0; // no seed of a person's
    const bool two = (is(args[0], ValueKind::Float) || below) && is_scalar(ev, args[1]) &&
                     is(args[2], ValueKind::None) && is(args[3], ValueKind::None);
    if (!two || ev.quiet > 0 || is_library_place(ev, place)) return;
    const std::string_view call = text(ev.sources, place); // of numbers as they are written
    if (call.find_first_not_of("random(0123456789., )-") != call.npos || !call.ends_with(')'))
        return;
    const std::string seed = seed_text(ev, place);
    Diagnostic d{Code::ForeignSyntax,
                 Severity::Warning,
                 "of two numbers the first is a seed, and the result is from 0 to 1",
                 {place, {}},
                 {},
                 {},
                 {}};
    d.help(fmt::format("if it is meant to lie between them, write `random(lo, hi, {})`", seed),
           {{{place.source, place.end - 1, place.end - 1}, ", " + seed}});
    ev.diagnostics.add(std::move(d));
}

// random(seed), random(seed, k) in 0..1; random(lo, hi, seed)
static Value random_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    bool no_lo = is(args[0], ValueKind::None), no_seed = is(args[2], ValueKind::None);
    if (no_lo && no_seed) {
        Diagnostic &d = report(ev, Code::MissingArgument, site.call, "`random` wants a seed")
                            .note("it is `random(seed, k = 0)` or `random(lo, hi, seed)`");
        if (ev.quiet > 0 || is_library_place(ev, site.call)) return poison();
        if (const auto end = text(ev.sources, site.call).ends_with("()") ? site.call.end - 1 : 0) {
            const std::string seed = seed_text(ev, site.call);
            d.help(fmt::format("the same seed gives the same number: `random({})`", seed),
                   {{{site.call.source, end, end}, seed}});
        }
        return poison();
    }
    if (no_lo || no_seed || is(args[1], ValueKind::None)) {
        warn_of_bounds(ev, site, args);
        auto seed = seed_of(ev, site, no_lo ? args[2] : args[0], no_lo ? 2 : 0);
        std::optional<double> k = 0.0;
        for (std::size_t i : {std::size_t{1}, std::size_t{3}})
            if (!is(args[i], ValueKind::None)) k = seed_of(ev, site, args[i], i);
        return seed && k ? number(random_unit(*seed, *k)) : poison();
    }
    auto seed = seed_of(ev, site, args[2], 2);
    if (!seed) return poison();
    if (is_scalar(ev, args[0]) && is_scalar(ev, args[1])) {
        auto lo = want_known_number(ev, args[0], site.arg(0), "`lo`", Limit::Finite),
             hi = want_known_number(ev, args[1], site.arg(1), "`hi`", Limit::Finite);
        if (!lo || !hi) return poison();
        return number(*lo + (*hi - *lo) * random_unit(*seed, 0));
    }
    // vectors: each component for itself
    auto lo = want_vec_node(ev, args[0], 3, site.arg(0), "`lo`", Limit::Finite),
         hi = want_vec_node(ev, args[1], 3, site.arg(1), "`hi`", Limit::Finite);
    if (!lo || !hi) return poison();
    std::vector<double> t{random_unit(*seed, 1), random_unit(*seed, 2), random_unit(*seed, 3)};
    ir::Graph &g = ev.scene.graph;
    return from_node(ev, g.add(*lo, g.mul({g.sub(*hi, *lo), g.vec(t)})));
}

static Value pick_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto list = want_list(ev, args[0], site.arg(0), "`pick`");
    auto seed = seed_of(ev, site, args[1], 1);
    if (!list || !seed) return poison();
    if (list->empty()) {
        report(ev, Code::BadArgument, site.arg(0), "`pick` from an empty list");
        return poison();
    }
    return (*list)[std::min(
        list->size() - 1, static_cast<std::size_t>(random_unit(*seed, 0) * double(list->size())))];
}

static Value shuffle_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto list = want_list(ev, args[0], site.arg(0), "`shuffle`");
    auto seed = seed_of(ev, site, args[1], 1);
    if (!list || !seed) return poison();
    for (std::size_t i = list->size(); i > 1; --i)
        std::swap((*list)[i - 1],
                  (*list)[std::min(
                      i - 1, static_cast<std::size_t>(random_unit(*seed, double(i)) * double(i)))]);
    return list_value(ev, std::move(*list));
}

// -- looking in, and refusing

static Value print_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    if (is_poison(args[0])) return poison();
    report(ev, Code::Printed, site.call, print_value(ev, args[0]));
    return unit();
}

static Value assert_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    auto holds = want_known_bool(ev, args[0], site.arg(0), "`assert`");
    if (!holds) return poison();
    std::string why =
        args[1].kind == ValueKind::String ? ev.strings[args[1].id] : "this does not hold";
    if (!*holds) report(ev, Code::AssertFailed, site.arg(0), why);
    return unit();
}

// The library's own refusal: an error at the user's call.
static Value check_call(Interpreter &ev, const CallSite &site, std::vector<Value> &args) {
    const std::string wanted = args[1].kind == ValueKind::String ? ev.strings[args[1].id]
                                                                 : "this argument cannot be taken";
    if (is_numeric(args[0]) && args[0].kind == ValueKind::Field) {
        require(ev, to_node(ev, args[0]), site.call, wanted);
        return unit();
    }
    auto holds = want_known_bool(ev, args[0], site.arg(0), "this");
    if (!holds) return poison();
    if (!*holds) {
        report(ev, Code::BadArgument, site.call, wanted);
        return poison();
    }
    return unit();
}

static Value given_call(Interpreter &, const CallSite &, std::vector<Value> &args) {
    return boolean(!is(args[0], ValueKind::None));
}

void add_list_builtins(std::vector<Builtin> &table) {
    auto add = [&](const char *name, std::vector<BuiltinParameter> parameters, auto call,
                   const char *doc, bool variadic = false, bool library = false) {
        table.push_back({name, std::move(parameters), variadic, library, call, "", doc});
    };
    add("len", {{"list"}}, len_call, "how many elements");
    add("map", {{"list"}, {"f"}}, map_call, "f of each element");
    add("filter", {{"list"}, {"f"}}, filter_call, "the elements for which f is true");
    add("fold", {{"list"}, {"start"}, {"f"}}, fold_call,
        "f(total, element) over all elements, from `start`");
    add("zip", {{"a"}, {"b"}, {"f"}}, zip_call, "f(element of a, element of b) for each pair");
    add("concat", {{"a"}, {"b", true, true}}, concat_call, "the lists one after another", true);
    add("reverse", {{"list"}}, reverse_call, "the last element first");
    add("sort", {{"list"}, {"key", true}}, sort_call,
        "in rising order, of the numbers or of `key` of each element");
    add("range", {{"first"}, {"last"}, {"step", true}}, range_call,
        "first, first + step, … below last");
    add("random", {{"lo", true}, {"hi", true}, {"seed", true}, {"k", true}}, random_call,
        "random(seed, k = 0) in 0..1; random(lo, hi, seed)");
    add("pick", {{"list"}, {"seed"}}, pick_call, "one of the elements");
    add("shuffle", {{"list"}, {"seed"}}, shuffle_call, "the elements in another order");
    add("print", {{"x"}}, print_call, "shows a value as a note, where the call stands");
    add("assert", {{"condition"}, {"why", true}}, assert_call,
        "an error with the words `why` where the condition is false");
    add("_check", {{"condition"}, {"why"}}, check_call, "", false, true);
    add("_given", {{"x"}}, given_call, "", false, true);
}

} // namespace fathom::typecheck
