// The table of shapes that one loop's body made, and formulas for its columns. Where shapes come of
// one body (iterations.cpp), what differs between them is what depends on the loops' numbers, and
// these follow from the row: of two loops, row = i*m + j. A formula stands beside the data, and a
// text may hold it in its place. It is taken only if float32 arithmetic, each inexact result pushed
// by a unit in its last place, gives every row to within `close_enough`: so no floor or comparison
// stands at an edge, and a shader shows what was proved of the data.
#include "typecheck/closed_forms.h"
#include "typecheck/instances.h"

#include "ir/passes/fold.h"
#include "ir/passes/inline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_set>

namespace fathom::typecheck {

using ir::Constant;
using ir::NodeId;
using ir::Op;
using ir::ShapeId;
using ir::Type;

namespace {

constexpr double close_enough = 2e-5;        // of the column's largest number
constexpr std::size_t max_work = 20'000'000; // operations to try all rows
constexpr std::size_t longest = 2000;        // nodes of all formulas of a instance_table

// -- what depends on the loops' numbers alone

struct Places {
    const ir::Graph &graph;
    std::vector<NodeId> found{}; // the topmost such expressions
    std::unordered_set<NodeId> seen{};
    bool fits = true;

    void node(NodeId id) {
        if (!id || !graph.reads(id).free_vars || !seen.insert(id).second) return;
        ir::Graph::Reads only;
        only.free_vars = true;
        if (graph.reads(id) == only) return found.push_back(id);
        const Op op = graph[id].op;
        if (op == Op::Loop || op == Op::LoopResult) fits = false; // its body may hold some
        for (NodeId arg : graph.args(id)) node(arg);
    }
};

// -- the loops' numbers from the row

// The iterations count through, the innermost loop's number fastest: place = row * step + first for
// the whole table of instances, and each loop's number is a digit of the place.
bool numbers_of_row(Interpreter &ev, const std::vector<const Iteration *> &iterations, NodeId row,
                    ir::Substitution &numbers) {
    const auto &at = iterations[0]->at;
    auto place_of = [&](const Iteration &iteration) {
        double place = 0, stride = 1;
        for (const auto &[variable, number] : iteration.at) {
            place += number * stride;
            stride *= ev.loop_variables[variable].count;
        }
        return place;
    };
    const double first = place_of(*iterations[0]), step = place_of(*iterations[1]) - first;
    for (std::size_t r = 0; r < iterations.size(); ++r) {
        if (iterations[r]->at.size() != at.size()) return false;
        for (std::size_t k = 0; k < at.size(); ++k)
            if (iterations[r]->at[k].first != at[k].first) return false;
        if (place_of(*iterations[r]) != first + step * static_cast<double>(r)) return false;
    }
    if (step < 1 || first + step * static_cast<double>(iterations.size()) > 1e9) return false;

    ir::Graph &g = ev.scene.graph;
    auto times = [&](NodeId a, double b) { return g.mul(a, g.integer(static_cast<int>(b))); };
    auto plus = [&](NodeId a, double b) { return g.add(a, g.integer(static_cast<int>(b))); };
    NodeId place =
        g.make(Op::Clamp, {row, g.integer(0), g.integer(static_cast<int>(iterations.size()) - 1)});
    place = plus(times(place, step), first);
    for (std::size_t k = 0; k < at.size(); ++k) {
        const LoopVariable v = ev.loop_variables[at[k].first];
        const NodeId count = g.integer(v.count);
        NodeId digit = k + 1 < at.size() ? g.make(Op::Mod, {place, count}) : place;
        numbers[v.node] = digit;
        if (k + 1 < at.size()) place = g.make(Op::Div, {place, count});
    }
    return true;
}

// -- formulas that float32 computes well

struct Formula {
    Interpreter &ev;
    ir::Substitution known; // variables and what was made of nodes so far
    bool possible = true;
    int depth = 0;

    ir::Graph &graph() { return ev.scene.graph; }

    NodeId node(NodeId id) {
        if (auto it = known.find(id); it != known.end()) return it->second;
        if (known.size() > longest || depth > 200) possible = false;
        if (!possible) return id;
        ++depth;
        const NodeId made = rewritten(id);
        --depth;
        known[id] = made;
        return made;
    }

  private:
    NodeId rewritten(NodeId id) {
        ir::Graph &g = graph();
        const ir::Node n = g[id];
        if (n.op == Op::Const) return id;
        if (!g.reads(id).free_vars) {
            possible = possible && g.reads(id) == ir::Graph::Reads{};
            return id;
        }
        if (n.op == Op::Call) return node(ir::called(g, id)); // so that what follows sees into it
        std::vector<NodeId> args(g.args(id).begin(), g.args(id).end());
        for (NodeId &arg : args) arg = node(arg);
        if (!possible) return id;
        if (n.op == Op::Var || n.op == Op::Loop || n.op == Op::LoopResult || n.op == Op::Cached ||
            n.op == Op::TableRead) {
            possible = false;
            return id;
        }
        if (n.op == Op::ToInt || n.op == Op::Floor || n.op == Op::Fract)
            if (const NodeId whole = of_quotient(n.op, args[0])) return whole;
        if (n.op == Op::Mod && n.type == Type::Float)
            if (const NodeId a = whole_part(args[0]), b = whole_part(args[1]);
                a && b && positive(b))
                return to_float(g.make(Op::Mod, {a, b}));
        if ((n.op == Op::Sin || n.op == Op::Cos) && n.type == Type::Float)
            args[0] = small_angle(args[0]);
        return g.make(n.op, n.type, args, n.payload);
    }

    NodeId to_float(NodeId whole) { return graph().make(Op::ToFloat, Type::Float, {whole}); }
    bool positive(NodeId whole) {
        const auto number = graph().as_number(whole);
        return number && *number > 0;
    }

    // The int of which a float is the conversion.
    NodeId whole_part(NodeId id) {
        ir::Graph &g = graph();
        if (g[id].op == Op::ToFloat && g.type(g.arg(id, 0)) == Type::Int) return g.arg(id, 0);
        const auto number = g.as_number(id);
        if (!number || g.type(id) != Type::Float || *number != std::trunc(*number) ||
            std::abs(*number) > 1e9)
            return {};
        return g.integer(static_cast<int>(*number));
    }

    // int(a / b), floor(a / b) and fract(a / b) of ints, without a quotient that could fall short
    // of a whole number.
    NodeId of_quotient(Op op, NodeId quotient) {
        ir::Graph &g = graph();
        if (g[quotient].op != Op::Div || g.type(quotient) != Type::Float) return {};
        const NodeId a = whole_part(g.arg(quotient, 0)), b = whole_part(g.arg(quotient, 1));
        if (!a || !b || !positive(b)) return {};
        if (op == Op::ToInt) return g.make(Op::Div, {a, b});
        const NodeId rest = g.make(Op::Mod, {a, b});
        if (op == Op::Fract) return g.div({to_float(rest), to_float(b)});
        return to_float(g.make(Op::Div, {g.make(Op::Sub, {a, rest}), b}));
    }

    // u * step + offset with an int u and constants; u is invalid where the angle is none such.
    struct Angle {
        NodeId whole;
        double step = 0, offset = 0;
    };
    std::optional<Angle> angle_of(NodeId id) {
        ir::Graph &g = graph();
        if (auto number = g.as_number(id)) return Angle{{}, 0, *number};
        if (g[id].op == Op::ToFloat && g.type(g.arg(id, 0)) == Type::Int)
            return Angle{g.arg(id, 0), 1, 0};
        const Op op = g[id].op;
        if (op == Op::Neg) {
            auto a = angle_of(g.arg(id, 0));
            if (a) a->step = -a->step, a->offset = -a->offset;
            return a;
        }
        if (op != Op::Add && op != Op::Sub && op != Op::Mul && op != Op::Div) return std::nullopt;
        auto a = angle_of(g.arg(id, 0)), b = angle_of(g.arg(id, 1));
        if (!a || !b) return std::nullopt;
        if (op == Op::Add || op == Op::Sub) {
            if (a->whole && b->whole && a->whole != b->whole) return std::nullopt;
            const double sign = op == Op::Add ? 1 : -1;
            return Angle{a->whole ? a->whole : b->whole, a->step + sign * b->step,
                         a->offset + sign * b->offset};
        }
        if (op == Op::Mul && !a->whole) std::swap(a, b);
        if (b->whole || (op == Op::Div && b->offset == 0)) return std::nullopt;
        const double factor = op == Op::Mul ? b->offset : 1 / b->offset;
        return Angle{a->whole, a->step * factor, a->offset * factor};
    }

    // A float32 angle of many turns has lost its fraction. Of u * step the turns are taken off in
    // ints: step is k/M of a turn and a small rest, and u*k mod M = (u mod M)*k mod M, which stays
    // below 2^30 for M = 2^15.
    NodeId small_angle(NodeId id) {
        const std::optional<Angle> angle = angle_of(id);
        if (!angle || !angle->whole) return id;
        constexpr double turn = 2 * std::numbers::pi, parts = 32768;
        const double k = std::round(angle->step / turn * parts);
        const double rest = angle->step - k * (turn / parts);
        ir::Graph &g = graph();
        const NodeId m = g.integer(static_cast<int>(parts));
        const double within = k - parts * std::floor(k / parts);
        const NodeId phase = g.make(
            Op::Mod,
            {g.mul({g.make(Op::Mod, {angle->whole, m}), g.integer(static_cast<int>(within))}), m});
        return g.add(
            {g.mul({to_float(phase), g.number(turn / parts)}),
             g.add({g.mul({to_float(angle->whole), g.number(rest)}), g.number(angle->offset)})});
    }
};

// -- whether they give the rows

// What every shader computes alike where the result is a float.
constexpr ir::OpSet is_exact{
    Op::Neg,   Op::Add,   Op::Sub,     Op::Mul,    Op::Min,       Op::Max,  Op::Abs,     Op::Sign,
    Op::Floor, Op::Ceil,  Op::Round,   Op::Trunc,  Op::Clamp,     Op::Step, Op::ToFloat, Op::Select,
    Op::Make,  Op::Splat, Op::Swizzle, Op::Column, Op::Transpose, Op::Hash};

void round_to_float(Constant &value, Op op, std::uint32_t mix) {
    if (value.type == Type::Bool || value.type == Type::Int) return;
    for (int i = 0; i < ir::components(value.type); ++i) {
        double &x = value.value[static_cast<std::size_t>(i)];
        float rounded = static_cast<float>(x);
        mix = mix * 1664525u + 1013904223u;
        if (!is_exact[op] || static_cast<double>(rounded) != x)
            rounded = std::nextafter(rounded, mix >> 31 ? 1e30f : -1e30f);
        x = static_cast<double>(rounded);
    }
}

// All expressions for each row: in double, or in float32 as a shader would. False where one has no
// value, or there is too much to do.
bool evaluate_rows(Interpreter &ev, const std::vector<NodeId> &roots, NodeId row, int count,
                   bool single, std::vector<std::vector<Constant>> &rows) {
    const ir::Graph &g = ev.scene.graph;
    std::vector<NodeId> order, todo = roots;
    std::unordered_map<NodeId, std::size_t> slot;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!slot.try_emplace(id, 0).second) continue;
        order.push_back(id);
        for (NodeId arg : g.args(id)) todo.push_back(arg);
    }
    if (order.size() > longest || order.size() * static_cast<std::size_t>(count) > max_work)
        return false;
    std::sort(order.begin(), order.end(), [](NodeId a, NodeId b) { return a.index < b.index; });
    for (std::size_t i = 0; i < order.size(); ++i) slot[order[i]] = i;
    std::vector<std::vector<std::size_t>> args(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (NodeId arg : g.args(order[i])) args[i].push_back(slot[arg]);

    std::vector<Constant> values(order.size()), of_args;
    rows.clear();
    for (int r = 0; r < count; ++r) {
        for (std::size_t i = 0; i < order.size(); ++i) {
            const ir::Node &n = g[order[i]];
            if (order[i] == row) {
                values[i] = {Type::Int, {static_cast<double>(r)}};
            } else if (n.op == Op::Const) {
                values[i] = g.constant_of(order[i]);
                if (single && n.type != Type::Int && n.type != Type::Bool)
                    for (double &x : values[i].value)
                        x = static_cast<double>(static_cast<float>(x));
            } else {
                of_args.clear();
                for (std::size_t a : args[i]) of_args.push_back(values[a]);
                const auto value = ir::evaluate(n.op, n.type, of_args, n.payload);
                if (!value) return false;
                values[i] = *value;
                if (single)
                    round_to_float(values[i], n.op,
                                   static_cast<std::uint32_t>(r) * 2654435761u +
                                       static_cast<std::uint32_t>(i) * 40503u);
            }
        }
        rows.emplace_back().reserve(roots.size());
        for (NodeId root : roots) rows.back().push_back(values[slot[root]]);
    }
    return true;
}

// Whether each column of float32 numbers is that of the true ones.
std::vector<bool> agree(const std::vector<std::vector<Constant>> &truth,
                        const std::vector<std::vector<Constant>> &single) {
    std::vector<bool> result(truth[0].size(), true);
    for (std::size_t c = 0; c < result.size(); ++c) {
        double largest = 0, worst = 0;
        for (std::size_t r = 0; r < truth.size(); ++r)
            for (std::size_t i = 0; i < 16; ++i) {
                const double want = truth[r][c].value[i], off = single[r][c].value[i] - want;
                largest = std::max(largest, std::abs(want));
                worst = std::max(worst, off == off ? std::abs(off) : 1e30);
            }
        result[c] = worst <= close_enough * largest;
    }
    return result;
}

} // namespace

std::optional<IterationTable> table_of_iterations(Interpreter &ev,
                                                  const std::vector<ShapeId> &members) {
    if (members.size() < min_computed) return std::nullopt;
    IterationTable table;
    std::vector<const Iteration *> iterations;
    for (ShapeId member : members) {
        auto it = ev.iterations.find(member.index);
        if (it == ev.iterations.end() ||
            (!iterations.empty() && it->second.symbolic != iterations[0]->symbolic))
            return std::nullopt;
        iterations.push_back(&it->second);
    }
    table.symbolic = iterations[0]->symbolic;
    std::vector<NodeId> nodes;
    shape_nodes(ev.scene, table.symbolic, nodes);
    if (nodes.size() > longest) return std::nullopt;
    Places places{ev.scene.graph};
    for (NodeId node : nodes) places.node(node);
    if (!places.fits || places.found.empty()) return std::nullopt;

    table.places = std::move(places.found);
    table.row = ev.scene.graph.fresh_var(Type::Int);
    Formula formula{ev, {}};
    if (!numbers_of_row(ev, iterations, table.row, formula.known)) return std::nullopt;
    formula.known[table.row] = table.row;
    for (NodeId place : table.places) table.formulas.push_back(formula.node(place));
    if (!formula.possible) return std::nullopt;

    const int count = static_cast<int>(members.size());
    std::vector<std::vector<Constant>> single;
    if (!evaluate_rows(ev, table.formulas, table.row, count, false, table.rows))
        return std::nullopt;
    for (const auto &row : table.rows)
        for (const Constant &value : row)
            for (double x : value.value)
                if (!std::isfinite(x)) return std::nullopt;
    if (!evaluate_rows(ev, table.formulas, table.row, count, true, single)) return std::nullopt;
    const std::vector<bool> good = agree(table.rows, single);
    for (std::size_t c = 0; c < good.size(); ++c)
        if (!good[c]) table.formulas[c] = {};
    return table;
}

} // namespace fathom::typecheck
