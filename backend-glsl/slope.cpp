#include "backend-glsl/slope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>
#include <vector>

namespace fathom::glsl {

using ir::Graph;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// What a node is of one vector: a function of its components in `mask`, `factor` steep in these.
// `aligned`: its component i is one of that vector's component i alone.
struct Part {
    bool fixed = true; // does not depend on the point
    NodeId of;
    int mask = 0;
    double factor = 0;
    bool aligned = false;
};

class Slopes {
  public:
    Slopes(const Graph &graph, NodeId point) : graph_(graph) {
        parts_[point] = {false, point, 7, 1, true};
        total_[point] = 1;
    }

    double total(NodeId id) {
        const Part part = part_of(id);
        if (part.fixed) return 0;
        return part.factor == 0 ? 0 : part.factor * total_.at(part.of);
    }

  private:
    Part part_of(NodeId id) {
        if (const auto it = parts_.find(id); it != parts_.end()) return it->second;
        const Part part = made(id);
        parts_[id] = part;
        return part;
    }

    // A vector or number of its own, that steep in the point.
    Part own(NodeId id, double total) {
        total_[id] = total;
        return {false, id, (1 << ir::components(graph_.type(id))) - 1, 1, true};
    }

    Part scaled(NodeId id, Part part, double by) {
        if (!std::isfinite(by)) return own(id, unbounded);
        part.factor *= by;
        return part;
    }

    // Of numbers or vectors by component, the value always one of them or between.
    Part largest(NodeId id, std::span<const NodeId> args) {
        Part result;
        double total_most = 0, squares = 0;
        bool one_vector = true;
        for (NodeId arg : args) {
            const Part part = part_of(arg);
            if (part.fixed) continue;
            total_most = std::max(total_most, total(arg));
            squares += total(arg) * total(arg);
            if (result.fixed) {
                result = part;
                continue;
            }
            one_vector &= part.of == result.of;
            result.mask |= part.mask;
            result.factor = std::max(result.factor, part.factor);
            result.aligned &= part.aligned;
        }
        if (result.fixed) return result;
        const bool number = graph_.type(id) == Type::Float;
        if (one_vector && (number || result.aligned)) return result;
        return own(id, number ? total_most : std::sqrt(squares));
    }

    // A bound of the size of a fixed node: of its largest component, or of the whole vector.
    double size(NodeId id, bool whole, int depth = 0) {
        const ir::Node &node = graph_[id];
        const int n = ir::components(node.type);
        if (depth > 6) return unbounded;
        const auto of = [&](int i) { return size(graph_.arg(id, i), whole, depth + 1); };
        double sum = 0, most = 0;
        const auto add = [&](double x) {
            sum += x * x;
            most = std::max(most, std::fabs(x));
        };
        const Op op = node.op;
        if (op == Op::Const) {
            for (int i = 0; i < n; ++i) add(graph_.constant_of(id).value[std::size_t(i)]);
            return whole ? std::sqrt(sum) : most;
        }
        if (op == Op::TableRead) {
            const ir::Table &table = graph_.table(ir::table_of(node.payload));
            const int column = ir::column_of(node.payload);
            double largest = 0;
            for (int row = 0; row < table.rows; ++row) {
                sum = most = 0;
                for (int i = 0; i < n; ++i)
                    add(table.data[std::size_t(row * table.stride + column + i)]);
                largest = std::max(largest, whole ? std::sqrt(sum) : most);
            }
            return largest * 1.000001; // a formula gives the same to float precision only
        }
        if (op == Op::Make) {
            for (std::size_t i = 0; i < node.count; ++i) add(of(int(i)));
            return whole ? std::sqrt(sum) : most;
        }
        if (op == Op::Neg || op == Op::Abs) return of(0);
        if (op == Op::Add || op == Op::Sub) return of(0) + of(1);
        if (op == Op::Mul) return of(0) * of(1);
        if (op == Op::Splat || op == Op::Swizzle) return of(0) * (whole ? std::sqrt(double(n)) : 1);
        return unbounded;
    }

    // The least size of a fixed number.
    double min_size(NodeId id) {
        const ir::Node &node = graph_[id];
        if (node.op == Op::Const) {
            double least = unbounded;
            for (int i = 0; i < ir::components(node.type); ++i)
                least = std::min(least, std::fabs(graph_.constant_of(id).value[std::size_t(i)]));
            return least;
        }
        if (node.op == Op::Splat) return min_size(graph_.arg(id, 0));
        if (node.op != Op::TableRead) return 0;
        const ir::Table &table = graph_.table(ir::table_of(node.payload));
        double least = unbounded;
        for (int row = 0; row < table.rows; ++row)
            for (int i = 0; i < ir::components(node.type); ++i)
                least =
                    std::min(least, double(std::fabs(table.data[std::size_t(
                                        row * table.stride + ir::column_of(node.payload) + i)])));
        return least * 0.999999;
    }

    // The largest norm of a fixed matrix M: |M|^2 <= 1 + |M^T M - I|, tight for rotations.
    double norm(NodeId id) {
        const ir::Node &node = graph_[id];
        const int n = ir::side(node.type);
        const auto of = [n](auto number) {
            double off = 0;
            for (int a = 0; a < n; ++a)
                for (int b = 0; b < n; ++b) {
                    double dot = a == b ? -1 : 0;
                    for (int k = 0; k < n; ++k) dot += number(a * n + k) * number(b * n + k);
                    off += dot * dot;
                }
            return std::sqrt(1 + std::sqrt(off));
        };
        if (node.op == Op::Transpose) return norm(graph_.arg(id, 0));
        if (node.op == Op::Const)
            return of([&](int i) { return graph_.constant_of(id).value[std::size_t(i)]; });
        if (node.op != Op::TableRead) return unbounded;
        const ir::Table &table = graph_.table(ir::table_of(node.payload));
        double most = 0;
        for (int row = 0; row < table.rows; ++row)
            most = std::max(most, of([&](int i) {
                                return double(table.data[std::size_t(
                                    row * table.stride + ir::column_of(node.payload) + i)]);
                            }));
        return most * 1.000001;
    }

    // The numbers below nested maxima: q.x, q.y, q.z of max(q.x, max(q.y, q.z)), by vector and
    // place.
    using Component = std::pair<NodeId, int>;
    Component component(NodeId id) const {
        const ir::Node &node = graph_[id];
        if (node.op == Op::Swizzle)
            return {graph_.arg(id, 0), ir::swizzle_component(node.payload, 0)};
        return {id, -1};
    }
    void maxima(NodeId id, std::set<Component> &found) const {
        const Op op = graph_[id].op;
        if ((op == Op::Max || op == Op::Intersection) && graph_.type(id) == Type::Float)
            for (NodeId arg : graph_.args(id)) maxima(arg, found);
        else
            found.insert(component(id));
    }
    bool is_zero(NodeId id) const {
        if (!graph_.is_constant(id)) return false;
        for (int i = 0; i < ir::components(graph_.type(id)); ++i)
            if (graph_.constant_of(id).value[std::size_t(i)] != 0) return false;
        return true;
    }
    // The argument of a node with two, the other 0.
    NodeId beside_zero(NodeId id, Op op) const {
        if (graph_[id].op != op || graph_[id].count != 2) return {};
        if (is_zero(graph_.arg(id, 1))) return graph_.arg(id, 0);
        return is_zero(graph_.arg(id, 0)) ? graph_.arg(id, 1) : NodeId{};
    }
    bool outside_and_inside(NodeId outside, NodeId inside) const {
        if (graph_[outside].op != Op::Length) return false;
        const NodeId vector = graph_.arg(outside, 0), most = beside_zero(inside, Op::Min);
        if (!most) return false;
        std::set<Component> around, within;
        maxima(most, within);
        if (const NodeId q = beside_zero(vector, Op::Max)) {
            for (int i = 0; i < ir::components(graph_.type(q)); ++i) around.insert({q, i});
        } else if (graph_[vector].op == Op::Make) {
            for (NodeId part : graph_.args(vector)) {
                const NodeId q = beside_zero(part, Op::Max);
                if (!q) return false;
                around.insert(component(q));
            }
        }
        return !around.empty() && around == within;
    }

    Part made(NodeId id) {
        const ir::Node &node = graph_[id];
        const std::span<const NodeId> args = graph_.args(id);
        if (node.op == Op::Loop) return own(id, unbounded);
        bool fixed = true;
        for (NodeId arg : args) fixed &= part_of(arg).fixed;
        if (fixed) return {};
        const Op op = node.op;
        if (op == Op::Neg || op == Op::Abs) return part_of(args[0]);
        if (op == Op::Length) {
            Part part = part_of(args[0]);
            part.aligned = false;
            return part;
        }
        if (op == Op::Add || op == Op::Sub) return sum(id, args[0], args[1]);
        if (op == Op::Min || op == Op::Max || op == Op::Union || op == Op::Intersection)
            return largest(id, args);
        if (op == Op::Clamp && part_of(args[1]).fixed && part_of(args[2]).fixed)
            return part_of(args[0]);
        // A smooth minimum's weights are not negative and add up to 1.
        if (op == Op::Blend && part_of(args[0]).fixed &&
            node.payload == static_cast<std::uint32_t>(ir::Profile::Smooth))
            return largest(id, args.subspan(2));
        if (op == Op::Select && part_of(args[0]).fixed)
            return own(id, std::max(total(args[1]), total(args[2])));
        if (op == Op::Div && part_of(args[1]).fixed)
            return scaled(id, part_of(args[0]), 1 / min_size(args[1]));
        if (op == Op::Splat)
            return own(id, std::sqrt(double(ir::components(node.type))) * total(args[0]));
        if (op == Op::Swizzle) return swizzled(node, args[0]);
        if (op == Op::Make) return joined(id, args);
        if (op == Op::Mul || op == Op::Dot || op == Op::MatMul) {
            const bool first = part_of(args[0]).fixed;
            if (first || part_of(args[1]).fixed)
                return product(id, args[first ? 0 : 1], args[first ? 1 : 0]);
        }
        return own(id, unbounded);
    }

    Part sum(NodeId id, NodeId a, NodeId b) {
        if (part_of(a).fixed) return part_of(b);
        if (part_of(b).fixed) return part_of(a);
        if (graph_[id].op == Op::Add && (outside_and_inside(a, b) || outside_and_inside(b, a)))
            return own(id, std::max(total(a), total(b)));
        return own(id, total(a) + total(b));
    }

    // Of what is fixed and what is not.
    Part product(NodeId id, NodeId by, NodeId what) {
        const Op op = graph_[id].op;
        if (op == Op::Dot) return own(id, size(by, true) * total(what));
        if (op == Op::MatMul) {
            const bool turned = ir::is_matrix(graph_.type(by)) && ir::is_vector(graph_.type(what));
            return own(id, turned ? norm(by) * total(what) : unbounded);
        }
        if (ir::is_matrix(graph_.type(id))) return own(id, unbounded);
        if (graph_[what].op == Op::Splat)
            return own(id, total(graph_.arg(what, 0)) * size(by, true));
        return scaled(id, part_of(what), size(by, false));
    }

    Part swizzled(const ir::Node &node, NodeId vector) {
        Part part = part_of(vector);
        int mask = 0, times[4] = {0, 0, 0, 0}, most = 0;
        for (int i = 0; i < ir::swizzle_size(node.payload); ++i) {
            const int c = ir::swizzle_component(node.payload, i);
            mask |= 1 << c;
            most = std::max(most, ++times[c]);
        }
        if (!part.aligned) { // a vector of its own
            total_[vector] = total(vector);
            part = {false, vector, 0, 1, true};
        }
        part.mask = mask;
        part.factor *= std::sqrt(double(most));
        part.aligned = false;
        return part;
    }

    Part joined(NodeId id, std::span<const NodeId> args) {
        Part result;
        double squares = 0;
        bool apart = true;
        for (NodeId arg : args) {
            const Part part = part_of(arg);
            if (part.fixed) continue;
            squares += total(arg) * total(arg);
            if (result.fixed) {
                result = part;
                continue;
            }
            apart &= part.of == result.of && !(part.mask & result.mask);
            result.mask |= part.mask;
            result.factor = std::max(result.factor, part.factor);
        }
        result.aligned = false;
        return apart ? result : own(id, std::sqrt(squares));
    }

    const Graph &graph_;
    std::unordered_map<NodeId, Part> parts_;
    std::unordered_map<NodeId, double> total_;
};

} // namespace

double slope_of(const Graph &graph, NodeId root, NodeId point) {
    return Slopes(graph, point).total(root);
}

} // namespace fathom::glsl
