// With r = 1/|a|, an atom, r^2 |a|^2 = 1: of |a|^2 = c m + rest, m a product of the most factors, r^2 m
// is (1 - r^2 rest)/c. Each such step is an equation, in whatever order they are made.
#include "proof/unit_vectors.h"

#include "proof/continuity.h"
#include "proof/polynomials.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace fathom::proof {
namespace {

constexpr std::size_t most_nodes_of_units = 400, most_terms_of_units = 160,
                      most_factors_of_units = 16;
constexpr int most_steps_of_units = 200; // at which r^2 m is replaced

// Sums of products, each number with the sizes of all that was added up to it: where no more is left
// than double precision loses of these, nothing is.
struct Summed {
    double sum = 0, sizes = 0;
    void add(double x, double size) { sum += x, sizes += size; }
};
using Sum = std::map<Monomial, Summed>;

class Units {
  public:
    explicit Units(Graph &graph) : graph_(graph), expansion_(graph) {}

    std::optional<double> number_of(NodeId scalar) {
        const NodeId plain = written(scalar);
        if (failed_ || inverses_.empty()) return {};
        Sum sum = of(plain);
        for (std::size_t i = inverses_.size(); i-- > 0;) reduce(sum, inverses_[i]);
        without_nothing(sum);
        if (failed_ || sum.size() > 1) return {};
        if (sum.empty()) return 0;
        return sum.begin()->first.empty() ? std::optional(sum.begin()->second.sum) : std::nullopt;
    }

  private:
    struct InverseLength {
        NodeId of, var; // the square of the length, and 1 over the length
        Monomial lead;  // of that square
        double by = 0;
        Sum rest;
    };
    Graph &graph_;
    Expansion expansion_;
    std::vector<InverseLength> inverses_; // inner ones first
    std::unordered_map<NodeId, NodeId> written_;
    bool failed_ = false;

    // Lengths' inverses as atoms, and vectors' products by component.
    NodeId written(NodeId id) {
        if (const auto it = written_.find(id); it != written_.end()) return it->second;
        failed_ = failed_ || written_.size() > most_nodes_of_units;
        if (failed_) return id;
        const NodeId out = written_now(id);
        return written_[id] = out;
    }
    NodeId written_now(NodeId id) {
        const ir::Node node = graph_[id];
        if (node.count == 0 || node.op == Op::Loop || node.op == Op::LoopResult) return id;
        std::vector<NodeId> args(graph_.args(id).begin(), graph_.args(id).end());
        for (NodeId &arg : args) arg = written(arg);
        if (node.op == Op::Normalize)
            return times(args[0], inverse(graph_.make(Op::Dot, {args[0], args[0]})));
        if (node.op == Op::Cross) {
            std::vector<NodeId> parts;
            for (int i = 0; i < 3; ++i) {
                const int j = (i + 1) % 3, k = (i + 2) % 3;
                const NodeId ahead = product(args[0], j, args[1], k),
                             back = product(args[0], k, args[1], j);
                parts.push_back(graph_.sub(ahead, back));
            }
            return graph_.make(Op::Make, node.type, parts);
        }
        if (node.op == Op::Div)
            if (const NodeId square = square_of(args[1])) return times(args[0], inverse(square));
        return graph_.make(node.op, node.type, args, node.payload);
    }
    NodeId product(NodeId a, int i, NodeId b, int k) {
        const NodeId x = component_of(graph_, a, i), y = component_of(graph_, b, k);
        return graph_.mul(x, y);
    }
    NodeId times(NodeId of, NodeId by) {
        const ir::Type type = graph_[of].type;
        return graph_.mul(of, type == ir::Type::Float ? by : graph_.splat(by, type));
    }
    // Of a length, or a root.
    NodeId square_of(NodeId divisor) {
        if (graph_[divisor].op == Op::Splat) divisor = graph_.arg(divisor, 0);
        if (graph_[divisor].type != ir::Type::Float || graph_.is_constant(divisor)) return {};
        const NodeId of = graph_[divisor].op == Op::Length || graph_[divisor].op == Op::Sqrt
                              ? graph_.arg(divisor, 0)
                              : NodeId();
        if (!of || graph_[divisor].op == Op::Sqrt) return of;
        return graph_.make(Op::Dot, {of, of});
    }
    NodeId inverse(NodeId square) {
        for (const InverseLength &known : inverses_)
            if (known.of == square) return known.var;
        InverseLength out{square, graph_.fresh_var(ir::Type::Float), {}, 0, of(square)};
        without_nothing(out.rest);
        for (const auto &[factors, c] : out.rest)
            if (std::fabs(c.sum) < 1e-6 * c.sizes)
                failed_ = true; // few of its digits are right
            else if (out.by == 0 || factors.size() >= out.lead.size())
                out.lead = factors, out.by = c.sum;
        failed_ = failed_ || out.by == 0 || inverses_.size() > 8 || is_nothing(out.rest);
        out.rest.erase(out.lead);
        inverses_.push_back(out);
        return out.var;
    }

    // Is it 0, or nearly, by what is known of the inner vectors? Its direction is rounding then.
    bool is_nothing(Sum square) {
        for (std::size_t i = inverses_.size(); i-- > 0;) reduce(square, inverses_[i]);
        return std::ranges::all_of(square, [](const auto &term) {
            return std::fabs(term.second.sum) < 1e-6 * term.second.sizes;
        });
    }

    // A scalar as a sum of products.
    Sum of(NodeId id) {
        const ir::Node node = graph_[id];
        failed_ = failed_ || node.type != ir::Type::Float;
        if (failed_) return {};
        if (const auto c = graph_.as_number(id)) return {{{}, {*c, std::fabs(*c)}}};
        const auto arg = [&](int i) { return graph_.arg(id, i); };
        if (node.op == Op::Neg) return added({}, of(arg(0)), -1);
        if (node.op == Op::Add) return added(of(arg(0)), of(arg(1)), 1);
        if (node.op == Op::Sub) return added(of(arg(0)), of(arg(1)), -1);
        if (node.op == Op::Mul) return multiplied(of(arg(0)), of(arg(1)));
        if (node.op == Op::Dot) {
            Sum out;
            for (int i = 0; i < ir::components(graph_[arg(0)].type); ++i) {
                const NodeId a = component_of(graph_, arg(0), i),
                             b = component_of(graph_, arg(1), i);
                out = added(std::move(out), multiplied(of(a), of(b)), 1);
            }
            return out;
        }
        if (node.op == Op::Swizzle)
            if (const NodeId inner =
                    component_of(graph_, arg(0), ir::swizzle_component(node.payload, 0));
                inner != id)
                return of(inner);
        Sum out;
        const auto &atoms = expansion_.of(id); // equal functions of equal arguments are one atom
        failed_ = failed_ || !atoms;
        if (atoms)
            for (const auto &[factors, c] : *atoms) out[factors] = {c, std::fabs(c)};
        return out;
    }
    Sum added(Sum to, const Sum &more, double by) {
        for (const auto &[factors, c] : more) to[factors].add(by * c.sum, c.sizes);
        failed_ = failed_ || to.size() > most_terms_of_units;
        return to;
    }
    Sum multiplied(const Sum &a, const Sum &b) {
        Sum out;
        for (const auto &[m, x] : a)
            for (const auto &[n, y] : b) {
                Monomial factors = m;
                factors.insert(factors.end(), n.begin(), n.end());
                std::sort(factors.begin(), factors.end());
                take(out, std::move(factors), {x.sum * y.sum, x.sizes * y.sizes});
                failed_ = failed_ || out.size() > most_terms_of_units;
                if (failed_) return out;
            }
        return out;
    }
    // With the square of a cosine as 1 less that of the sine.
    void take(Sum &out, Monomial factors, Summed c) {
        failed_ = failed_ || factors.size() > most_factors_of_units;
        const auto twice = std::ranges::adjacent_find(
            factors, [&](NodeId u, NodeId v) { return u == v && graph_[u].op == Op::Cos; });
        if (twice == factors.end() || failed_) {
            out[factors].add(c.sum, c.sizes);
            return;
        }
        const NodeId sine = graph_.make(Op::Sin, {graph_.arg(*twice, 0)});
        factors.erase(twice, twice + 2);
        take(out, factors, c);
        factors.insert(factors.end(), 2, sine);
        std::sort(factors.begin(), factors.end());
        take(out, std::move(factors), {-c.sum, c.sizes});
    }
    static void without_nothing(Sum &sum) {
        std::erase_if(sum, [](const auto &term) {
            return std::fabs(term.second.sum) <= 4e-15 * term.second.sizes;
        });
    }

    // r^2 m as (1 - r^2 rest)/c, wherever it stands.
    void reduce(Sum &sum, const InverseLength &by) {
        Monomial wanted = by.lead;
        wanted.insert(wanted.end(), 2, by.var);
        std::sort(wanted.begin(), wanted.end());
        for (int step = 0; !failed_; ++step) {
            failed_ = step == most_steps_of_units;
            without_nothing(sum);
            const auto found = std::ranges::find_if(
                sum, [&](const auto &term) { return std::ranges::includes(term.first, wanted); });
            if (found == sum.end()) return;
            Monomial left;
            std::ranges::set_difference(found->first, wanted, std::back_inserter(left));
            const Summed c{found->second.sum / by.by, found->second.sizes / std::fabs(by.by)};
            sum.erase(found);
            sum[left].add(c.sum, c.sizes);
            left.insert(left.end(), 2, by.var);
            std::sort(left.begin(), left.end());
            sum = added(std::move(sum), multiplied(by.rest, {{left, c}}), -1);
        }
    }
};

} // namespace

std::optional<double> number_of_units(Graph &graph, NodeId scalar) {
    return Units(graph).number_of(scalar);
}

} // namespace fathom::proof
