// M v + c has slope |M| |J_v| where M and c do not vary. |M|^2 is the norm of M M^T, whose entries
// are polynomials in the sines, cosines and numbers that M is made of; for rotations they are 0 and
// 1 whatever the angles are, by sin^2 + cos^2 = 1 (continuity.h). By Gershgorin's theorem |M M^T|
// is at most the greatest sum of absolute values in a row.
#include "proof/linear_maps.h"

#include "ir/interval.h"
#include "ir/passes/inline.h"
#include "proof/continuity.h"
#include "proof/segments.h"

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
            const auto entry = number_of(graph, product);
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

} // namespace

std::optional<LinearMap> turned(Graph &graph, NodeId vector,
                                const std::function<bool(NodeId)> &varies,
                                const std::unordered_set<NodeId> &known) {
    const int n = ir::components(graph[vector].type);
    std::optional<LinearMap> found; // where something else may vary, which a loop's values may
    for (const bool shallow : {false, true}) {
        Reader reader{graph, &varies, &known, vector, n};
        std::vector<std::array<NodeId, 4>> rows;
        reader.shallow = shallow;
        for (int i = 0; i < n && !reader.failed; ++i) {
            const NodeId part =
                shallow && by_component(graph[vector].op) ? NodeId() : reader.part(vector, i);
            reader.failed = reader.failed || !part;
            if (!reader.failed) rows.push_back(reader.read(part).by);
        }
        if (reader.failed || !reader.of) continue;
        const auto norm = rows_norm(graph, rows);
        if (!norm) continue;
        const bool still = std::none_of(reader.constants.begin(), reader.constants.end(), varies);
        if (still || !found)
            found = LinearMap{reader.of, norm->norm,
                              norm->even && ir::components(graph[reader.of].type) == n,
                              std::move(reader.constants)};
        if (still) break;
    }
    return found;
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
    const auto norm = rows_norm(graph, rows);
    return norm ? std::optional(norm->norm) : std::nullopt;
}

} // namespace fathom::proof
