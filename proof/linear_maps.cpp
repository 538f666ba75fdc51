// M v + c has slope |M| |J_v| where M and c do not vary. |M|^2 is the norm of M M^T, whose entries
// are polynomials in the sines, cosines and numbers that M is made of; for rotations they are 0 and
// 1 whatever the angles are, by sin^2 + cos^2 = 1 (continuity.h). By Gershgorin's theorem |M M^T|
// is at most the greatest sum of absolute values in a row.
#include "proof/linear_maps.h"

#include "ir/interval.h"
#include "ir/passes/inline.h"
#include "ir/passes/walk.h"
#include "proof/continuity.h"
#include "proof/polynomials.h"
#include "proof/segments.h"
#include "proof/unit_vectors.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

constexpr int max_steps = 2'000; // of one vector that is looked at

bool by_component(Op op) {
    return op == Op::Add || op == Op::Sub || op == Op::Neg || op == Op::Mul || op == Op::Div;
}

// A sum of coefficient times component of `of`, and a rest without any.
struct LinearSum {
    std::array<NodeId, 4> by{}; // invalid: 0
    NodeId rest;                // invalid: 0
    bool linear() const { return by[0] || by[1] || by[2] || by[3]; }
};

struct Reader {
    Graph &graph;
    const std::function<bool(NodeId)> *varies = nullptr;
    const std::unordered_set<NodeId> *turned = nullptr;
    NodeId self{};        // the vector that is read
    int size = 0;         // its components: smaller ones are looked into
    bool shallow = false; // sums and products of vectors are not looked into
    NodeId of{};
    std::vector<NodeId> constants{};
    std::unordered_map<NodeId, NodeId> calls{};
    std::unordered_map<NodeId, bool> bends{};
    int steps = 0;
    bool failed = false;

    NodeId plus(NodeId a, NodeId b) { return !a ? b : !b ? a : graph.add(a, b); }

    // What a call gives, with its arguments in place.
    NodeId entered(NodeId id) {
        while (graph[id].op == Op::Call && ++steps < max_steps) {
            NodeId &known = calls[id];
            if (!known) known = ir::called(graph, id);
            id = known;
        }
        return id;
    }

    // What bends on its way is no M v + c (segments.h), but no steeper than v: it may be the base.
    bool moved(NodeId id) {
        auto [known, is_new] = bends.emplace(id, false);
        if (is_new) known->second = moved_along(graph, id).has_value();
        return known->second;
    }

    // Entry i of a vector or, column by column, of a matrix, as a scalar; invalid where a matrix is
    // not made of such.
    NodeId part(NodeId id, int i) {
        if (++steps > max_steps) failed = true;
        if (failed) return {};
        const ir::Node whole = graph[id];
        if (!ir::is_matrix(whole.type) && turned && turned->contains(id) &&
            ir::components(whole.type) >= size)
            return graph.component(id, i);
        const NodeId called = id;
        id = entered(id);
        const ir::Node node = graph[id];
        if (ir::is_vector(node.type) && node.op == Op::Sub && moved(id))
            return graph.component(called, i);
        if (shallow && ir::is_vector(node.type) && (by_component(node.op) || node.op == Op::Cross))
            return graph.component(called, i);
        if (node.op == Op::Splat) return graph.arg(id, 0);
        if (node.op == Op::Swizzle)
            return part(graph.arg(id, 0), ir::swizzle_component(node.payload, i));
        if (node.op == Op::Make)
            for (int a = 0; a < int(node.count); ++a) {
                const NodeId arg = graph.arg(id, a);
                const int n = ir::components(graph[arg].type);
                if (i < n) return n == 1 ? arg : part(arg, i);
                i -= n;
            }
        if (ir::is_vector(node.type) && by_component(node.op)) {
            std::vector<NodeId> args;
            for (int a = 0; a < int(node.count); ++a) args.push_back(part(graph.arg(id, a), i));
            for (NodeId a : args)
                if (!a) return {};
            return graph.make(node.op, ir::Type::Float, args);
        }
        if (node.op == Op::Cross) {
            const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const NodeId aj = part(a, j), ak = part(a, k), bj = part(b, j), bk = part(b, k);
            if (failed) return {};
            return graph.sub({graph.mul(aj, bk), graph.mul(ak, bj)});
        }
        if (node.op == Op::MatMul && ir::is_vector(node.type)) {
            const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
            const bool left = ir::is_matrix(graph[a].type);
            const int side = ir::components(node.type);
            NodeId sum;
            for (int k = 0; k < side; ++k) {
                const NodeId m = left ? part(a, k * side + i) : part(b, i * side + k);
                const NodeId x = part(left ? b : a, k);
                if (failed) return {};
                if (!m) return graph.component(id, i);
                sum = plus(sum, graph.mul(m, x));
            }
            return sum;
        }
        if (node.op == Op::MatMul || node.op == Op::Transpose) return matrix_entry(id, node, i);
        if (!ir::is_vector(node.type)) return node.op == Op::Const ? number(id, i) : NodeId();
        return graph.component(id, i);
    }
    NodeId number(NodeId id, int i) {
        return graph.number(graph.constant_of(id).value[static_cast<std::size_t>(i)]);
    }
    NodeId matrix_entry(NodeId id, const ir::Node &node, int i) {
        const int side = ir::side(node.type), row = i % side, column = i / side;
        if (node.op == Op::Transpose) return part(graph.arg(id, 0), row * side + column);
        NodeId sum;
        for (int k = 0; k < side; ++k) {
            const NodeId x = part(graph.arg(id, 0), k * side + row),
                         y = part(graph.arg(id, 1), column * side + k);
            if (!x || !y) return {};
            sum = plus(sum, graph.mul(x, y));
        }
        return sum;
    }

    LinearSum constant(NodeId id) {
        constants.push_back(id);
        return {{}, id};
    }

    LinearSum read(NodeId id) {
        if (++steps > max_steps) failed = true;
        if (failed) return {};
        const ir::Node node = graph[id];
        constexpr ir::OpSet sums{Op::Add, Op::Sub, Op::Neg}, products{Op::Mul, Op::Div};
        std::optional<LinearSum> sum;
        if (node.op == Op::Swizzle)
            sum = component(id, node);
        else if (sums[node.op])
            sum = combined(id, node);
        else if (products[node.op])
            sum = scaled(id, node);
        else if (node.op == Op::Dot)
            sum = dotted(id);
        else if (node.op != Op::Call)
            return constant(id);
        else if (const NodeId inner = entered(id); inner != id)
            return read(inner);
        failed = failed || !sum;
        return sum.value_or(LinearSum{});
    }
    std::optional<LinearSum> component(NodeId id, const ir::Node &node) {
        const NodeId x = part(graph.arg(id, 0), ir::swizzle_component(node.payload, 0));
        if (!x) return {};
        if (graph[x].op != Op::Swizzle) return read(x);
        const NodeId vector = graph.arg(x, 0);
        if (vector == self) return {}; // not looked into
        if (!(*varies)(vector)) return constant(x);
        if (!of) of = vector;
        if (of != vector) return {};
        LinearSum out;
        out.by[static_cast<std::size_t>(ir::swizzle_component(graph[x].payload, 0))] =
            graph.number(1);
        return out;
    }
    LinearSum combined(NodeId id, const ir::Node &node) {
        LinearSum a = read(graph.arg(id, 0)), b;
        if (node.op == Op::Neg)
            std::swap(a, b);
        else
            b = read(graph.arg(id, 1));
        for (std::size_t i = 0; i < 4; ++i) a.by[i] = joined(a.by[i], b.by[i], node.op);
        a.rest = joined(a.rest, b.rest, node.op);
        return a;
    }
    std::optional<LinearSum> scaled(NodeId id, const ir::Node &node) {
        const NodeId x = graph.arg(id, 0), y = graph.arg(id, 1);
        const LinearSum a = read(x), b = read(y);
        if (failed) return {};
        if (!a.linear() && !b.linear()) return LinearSum{{}, id};
        if (b.linear() && (a.linear() || node.op == Op::Div)) return {};
        const LinearSum &sum = a.linear() ? a : b;
        const NodeId by = a.linear() ? y : x;
        LinearSum out;
        for (std::size_t i = 0; i < 4; ++i)
            if (sum.by[i])
                out.by[i] =
                    node.op == Op::Div ? graph.div(sum.by[i], by) : graph.mul(sum.by[i], by);
        if (sum.rest) out.rest = id;
        return out;
    }
    std::optional<LinearSum> dotted(NodeId id) {
        NodeId sum;
        for (int i = 0; i < ir::components(graph[graph.arg(id, 0)].type); ++i) {
            const NodeId x = part(graph.arg(id, 0), i), y = part(graph.arg(id, 1), i);
            if (failed) return {};
            sum = plus(sum, graph.mul(x, y));
        }
        return graph[sum].op == Op::Dot ? constant(sum) : read(sum);
    }
    NodeId joined(NodeId a, NodeId b, Op op) {
        if (op == Op::Add) return plus(a, b);
        return !b ? a : !a ? graph.neg(b) : graph.sub(a, b);
    }
};

// The square root of Gershgorin's bound of M M^T, M's rows given; whether it is a multiple of 1.
struct Norm {
    double norm = 0;
    bool even = true;
};
std::optional<Norm> rows_norm(Graph &graph, const std::vector<std::array<NodeId, 4>> &rows) {
    double greatest = 0, least = ir::rounding::infinity, across = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < rows.size(); ++j) {
            NodeId product = graph.number(0);
            for (std::size_t c = 0; c < 4; ++c)
                if (rows[i][c] && rows[j][c])
                    product = graph.add(product, graph.mul(rows[i][c], rows[j][c]));
            auto entry = number_of(graph, product);
            if (!entry) entry = number_of_units(graph, product);
            if (!entry) return {};
            sum += std::fabs(*entry);
            if (i == j)
                least = std::min(least, *entry);
            else
                across = std::max(across, std::fabs(*entry));
        }
        greatest = std::max(greatest, sum);
    }
    // The polynomials' numbers are rounded: their sums are right to some units in the last place.
    return Norm{ir::rounding::up(std::sqrt(greatest) * (1 + 1e-14), 4),
                greatest - least <= 1e-12 * greatest && across <= 1e-12 * greatest};
}

// The angle by whose sine and cosine the rows vary, and how they change with it.
std::optional<LinearMap::Turning> turning(Graph &graph, std::vector<std::array<NodeId, 4>> rows,
                                          const std::vector<NodeId> &constants,
                                          const std::function<bool(NodeId)> &varies) {
    LinearMap::Turning out;
    for (NodeId c : constants) {
        if (!varies(c)) continue;
        if (graph[c].op != Op::Sin && graph[c].op != Op::Cos) return {};
        if (out.angle && out.angle != graph.arg(c, 0)) return {};
        out.angle = graph.arg(c, 0);
    }
    if (!out.angle) return {};
    const NodeId cosine = graph.make(Op::Cos, {out.angle}), sine = graph.make(Op::Sin, {out.angle}),
                 u = graph.fresh_var(ir::Type::Float), v = graph.fresh_var(ir::Type::Float);
    for (std::array<NodeId, 4> &row : rows)
        for (std::size_t column = 0; column < 4; ++column) {
            if (!row[column]) continue;
            out.columns |= 1u << column;
            const auto entry =
                polynomial(graph, ir::substitute(graph, row[column], {{cosine, u}, {sine, v}}));
            if (!entry) return {};
            const auto hides_angle = [&](NodeId factor) { // in what is no product
                const std::vector<NodeId> vars = graph.free_vars(factor);
                return factor != u && factor != v &&
                       (std::ranges::count(vars, u) > 0 || std::ranges::count(vars, v) > 0);
            };
            for (const auto &[factors, by] : *entry)
                if (std::ranges::any_of(factors, hides_angle)) return {};
            Polynomial change;
            for (const auto &[factors, by] : *entry)
                for (std::size_t i = 0; i < factors.size(); ++i) {
                    if (factors[i] != u && factors[i] != v) continue;
                    Monomial changed = factors;
                    changed[i] = factors[i] == u ? v : u;
                    std::sort(changed.begin(), changed.end());
                    change[changed] += factors[i] == u ? -by : by;
                }
            std::erase_if(change, [](const auto &term) { return term.second == 0; });
            if (!change.empty()) out.moving |= 1u << column;
            row[column] = ir::substitute(graph, rebuilt(graph, change), {{u, cosine}, {v, sine}});
        }
    const auto norm = rows_norm(graph, rows);
    if (!norm) return {};
    out.norm = norm->norm;
    return out;
}

// Rows that are sums of sines and cosines times scalars, whatever these are, as M v: v is made of the
// scalars.
struct Scalars {
    Graph &graph;
    std::vector<NodeId> parts{}, waves{};
    std::vector<std::array<NodeId, 4>> rows{};

    bool take(NodeId id, double sign, int depth = 0) {
        constexpr int max_depth = 8;
        const ir::Node node = graph[id];
        if (depth > max_depth) return false;
        const auto inner = [&](int i, double by) {
            return take(graph.arg(id, i), sign * by, depth + 1);
        };
        if (node.op == Op::Neg) return inner(0, -1);
        if (node.op == Op::Add || node.op == Op::Sub)
            return inner(0, 1) && inner(1, node.op == Op::Add ? 1 : -1);
        if (node.op == Op::Mul)
            for (int i = 0; i < 2; ++i) {
                NodeId wave = graph.arg(id, i);
                const bool negative = graph[wave].op == Op::Neg;
                if (negative) wave = graph.arg(wave, 0);
                if (graph[wave].op != Op::Sin && graph[wave].op != Op::Cos) continue;
                waves.push_back(wave);
                return add(graph.arg(id, 1 - i),
                           graph.mul(graph.number(negative ? -sign : sign), wave));
            }
        return add(id, graph.number(sign));
    }
    bool add(NodeId part, NodeId by) {
        const auto at = std::size_t(std::ranges::find(parts, part) - parts.begin());
        if (at == parts.size()) parts.push_back(part);
        if (parts.size() > 4) return false;
        NodeId &to = rows.back()[at];
        to = to ? graph.add(to, by) : by;
        return true;
    }
};

std::optional<LinearMap> turned_scalars(Graph &graph, NodeId vector,
                                        const std::function<bool(NodeId)> &varies) {
    Reader reader{graph, &varies, nullptr, vector, ir::components(graph[vector].type)};
    Scalars scalars{graph};
    for (int i = 0; i < reader.size; ++i) {
        const NodeId part = reader.part(vector, i);
        scalars.rows.emplace_back();
        if (reader.failed || !part || !scalars.take(part, 1)) return {};
    }
    if (scalars.waves.empty() || scalars.parts.size() < 2) return {};
    const bool still = std::none_of(scalars.waves.begin(), scalars.waves.end(), varies);
    const auto change = still ? std::nullopt : turning(graph, scalars.rows, scalars.waves, varies);
    const auto norm = rows_norm(graph, scalars.rows);
    if ((!still && !change) || !norm) return {};
    const NodeId of =
        graph.make(Op::Make, ir::vector_type(int(scalars.parts.size())), scalars.parts);
    return LinearMap{of, norm->norm, false, scalars.waves, change};
}

} // namespace

std::optional<LinearMap> turned(Graph &graph, NodeId vector,
                                const std::function<bool(NodeId)> &varies,
                                const std::unordered_set<NodeId> &known) {
    const int n = ir::components(graph[vector].type);
    std::optional<LinearMap> found; // where something else may vary, which a loop's values may
    for (const bool shallow : {false, true}) {
        Reader reader{graph, &varies, &known, vector, n};
        std::vector<std::array<NodeId, 4>> rows;
        std::vector<NodeId> rests;
        reader.shallow = shallow;
        for (int i = 0; i < n && !reader.failed; ++i) {
            const NodeId part = n == 1 ? vector
                                : shallow && by_component(graph[vector].op)
                                    ? NodeId()
                                    : reader.part(vector, i);
            reader.failed = reader.failed || !part;
            if (reader.failed) continue;
            const LinearSum sum = reader.read(part);
            rows.push_back(sum.by);
            if (sum.rest) rests.push_back(sum.rest);
        }
        if (reader.failed || !reader.of) continue;
        const auto norm = rows_norm(graph, rows);
        if (!norm) continue;
        const bool still = std::none_of(reader.constants.begin(), reader.constants.end(), varies);
        if (still || !found) {
            found = LinearMap{reader.of, norm->norm,
                              norm->even && ir::components(graph[reader.of].type) == n,
                              reader.constants};
            if (!still && std::none_of(rests.begin(), rests.end(), varies))
                found->turning = turning(graph, rows, reader.constants, varies);
        }
        if (still) return found;
    }
    if (found && found->turning) return found;
    const auto scalars = turned_scalars(graph, vector, varies);
    return scalars ? scalars : found;
}

std::optional<LinearMap> turned_part(Graph &graph, NodeId scalar) {
    constexpr ir::OpSet sums{Op::Add, Op::Sub}, waves{Op::Sin, Op::Cos};
    if (graph[scalar].type != ir::Type::Float || !sums[graph[scalar].op]) return {};
    const auto unsigned_of = [&](NodeId id) {
        while (graph[id].op == Op::Neg) id = graph.arg(id, 0);
        return id;
    };
    std::array<NodeId, 2> wave, angle, of;
    for (std::size_t i = 0; i < 2; ++i) {
        const NodeId term = unsigned_of(graph.arg(scalar, int(i)));
        if (graph[term].op != Op::Mul) return {};
        const NodeId first = unsigned_of(graph.arg(term, 0)),
                     second = unsigned_of(graph.arg(term, 1));
        const bool is_first = waves[graph[first].op];
        wave[i] = is_first ? first : second, of[i] = is_first ? second : first;
        if (!waves[graph[wave[i]].op]) return {};
        angle[i] = unsigned_of(graph.arg(wave[i], 0));
    }
    if (graph[wave[0]].op == graph[wave[1]].op || angle[0] != angle[1]) return {};
    return LinearMap{
        graph.make(Op::Make, ir::Type::Vec2, {of[0], of[1]}), 1, false, {wave[0], wave[1]}};
}

std::optional<double> matrix_norm(Graph &graph, NodeId matrix) {
    Reader reader{graph};
    const int side = ir::side(graph[matrix].type);
    std::vector<std::array<NodeId, 4>> rows(static_cast<std::size_t>(side));
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const NodeId entry = reader.part(matrix, j * side + i);
            if (!entry || reader.failed) return {};
            rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = entry;
        }
    auto norm = rows_norm(graph, rows);
    if (norm) return norm->norm;
    for (std::size_t i = 0; i < rows.size();
         ++i) // M^T has the same: of a frame, its vectors are rows
        for (std::size_t j = 0; j < i; ++j) std::swap(rows[i][j], rows[j][i]);
    norm = rows_norm(graph, rows);
    return norm ? std::optional(norm->norm) : std::nullopt;
}

} // namespace fathom::proof
