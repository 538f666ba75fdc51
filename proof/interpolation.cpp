// Let F be affine in each of w_1 … w_n in 0..1, with values in lo..hi where each is 0 or 1, and let
// q(v) = (v - lo) (hi - v). For v = a + t (b - a), q(v) = q(a) + t (q(b) - q(a)) + t (1 - t) (b - a)^2.
// So with |w_i'|^2 <= K w_i (1 - w_i) + c_i, weight by weight, |grad F|^2 <= K q(F) + (hi - lo)^2 sum
// c_i, where q <= (hi - lo)^2/4. K may be any number that is not below 0.
#include "proof/interpolation.h"

#include "ir/interval.h"
#include "proof/continuity.h"
#include "proof/polynomials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace fathom::proof {
namespace {

constexpr std::size_t max_axes = 3, max_nodes_of_interpolation = 400, max_degree = 8;
constexpr int weight_pieces = 32, trials = 256, max_products = 200; // pieces of 0..1, trials of K
constexpr double rounded = 1e-12;                                   // of numbers near 1

// A polynomial of one number, by powers; and by Bernstein's on a part of 0..1, where it lies between
// the least and the greatest of these.
using Powers = std::vector<double>;

Powers product(const Powers &a, const Powers &b) {
    Powers out(a.size() + b.size() - 1, 0.0);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t k = 0; k < b.size(); ++k) out[i + k] += a[i] * b[k];
    return out;
}

// a + by*b
Powers sum_of(Powers a, const Powers &b, double by) {
    a.resize(std::max(a.size(), b.size()), 0.0);
    for (std::size_t i = 0; i < b.size(); ++i) a[i] += by * b[i];
    while (a.size() > 1 && a.back() == 0) a.pop_back();
    return a;
}

double choose(std::size_t n, std::size_t k) {
    double out = 1;
    for (std::size_t i = 1; i <= k; ++i) out = out * double(n - k + i) / double(i);
    return out;
}

std::vector<double> bernstein(const Powers &a, std::size_t degree, double from, double size) {
    std::vector<double> moved(degree + 1, 0.0), out(degree + 1, 0.0); // a(from + size*s), by s
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t k = 0; k <= i; ++k)
            moved[k] +=
                a[i] * choose(i, k) * std::pow(from, double(i - k)) * std::pow(size, double(k));
    for (std::size_t j = 0; j <= degree; ++j)
        for (std::size_t i = 0; i <= j; ++i) out[j] += choose(j, i) / choose(degree, i) * moved[i];
    return out;
}

// w'^2 and w (1 - w), piece by piece.
struct WeightProfile {
    std::vector<double> slopes, spreads;
};
WeightProfile profile(const Powers &w) {
    Powers slope, rest;
    for (std::size_t i = 1; i < w.size(); ++i) slope.push_back(double(i) * w[i]);
    for (double x : w) rest.push_back(-x);
    rest[0] += 1;
    const Powers steep = product(slope, slope), spread = product(w, rest);
    WeightProfile out;
    for (int i = 0; i < weight_pieces; ++i) {
        const double size = 1.0 / weight_pieces, from = i * size;
        for (double x : bernstein(steep, spread.size() - 1, from, size)) out.slopes.push_back(x);
        for (double x : bernstein(spread, spread.size() - 1, from, size)) out.spreads.push_back(x);
    }
    return out;
}

// By one K for all values: fast, and right for any number of axes.
double steepness_by_spread(const std::vector<Powers> &weights) {
    std::vector<WeightProfile> profiles;
    double most = 0;
    for (const Powers &w : weights) {
        profiles.push_back(profile(w));
        most += std::ranges::max(profiles.back().slopes);
    }
    double least = most;
    for (int i = 1; i <= trials; ++i) {
        const double k = 4 * most * i / trials;
        double sum = k / 4;
        for (const WeightProfile &p : profiles) {
            double c = 0;
            for (std::size_t j = 0; j < p.slopes.size(); ++j)
                c = std::max(c, p.slopes[j] - k * p.spreads[j]);
            sum += c;
        }
        least = std::min(least, sum);
    }
    return std::sqrt(least) * (1 + 1e-9);
}

// A slope's square is convex in the values at the corners, so it is greatest where each of them is lo
// or hi. For each of these ways, but those that mirrored or swapped axes make of another, the cell is
// halved until nothing in it is steeper than `enough_`.
class SteepestCorners {
  public:
    explicit SteepestCorners(const std::vector<Powers> &weights) : axes_(weights.size()) {
        alike_ = std::ranges::all_of(weights, [&](const Powers &w) { return w == weights[0]; });
        mirrored_ = alike_ && is_mirrored(weights[0]);
        for (const Powers &w : weights) {
            tables_.push_back(table(w));
            enough_ = std::max(enough_, tables_.back()[1].slope);
        }
        enough_ *= enough_ * near_enough_to_steepest;
    }
    // Infinity where it would take too long; counts the boxes.
    double steepness(std::size_t &boxes) {
        const unsigned ways = 1u << ((1u << axes_) - 1); // with the others' signs turned
        for (unsigned way = 0; way < ways; ++way)
            if (is_first(way)) halve(way, {1, 1, 1}, boxes);
        return boxes > most_boxes ? ir::rounding::infinity : std::sqrt(enough_) * (1 + 1e-9);
    }

  private:
    static constexpr int levels = 8; // of halving
    static constexpr std::size_t most_boxes = 60'000;
    static constexpr double near_enough_to_steepest = 1.002;
    struct Part { // of 0..1: the weight, the sizes of its slope and bend; and in the middle
        double lo = 0, hi = 0, slope = 0, bend = 0, middle = 0, slope_there = 0, half = 0;
    };
    using Table = std::vector<Part>; // part 1 is all, 2i and 2i + 1 are the halves of i
    using Box = std::array<std::size_t, max_axes>;
    using Place = std::array<double, max_axes>; // a weight an axis
    const std::size_t axes_;
    bool alike_ = false, mirrored_ = false; // w(1 - f) = 1 - w(f)
    std::vector<Table> tables_;
    double enough_ = 0; // of a slope's square

    static Powers derived(const Powers &w) {
        Powers out{0};
        for (std::size_t i = 1; i < w.size(); ++i) {
            out.resize(i, 0.0);
            out[i - 1] = double(i) * w[i];
        }
        return out;
    }
    static double at(const Powers &w, double f) {
        double out = 0;
        for (std::size_t i = w.size(); i-- > 0;) out = out * f + w[i];
        return out;
    }
    static bool is_mirrored(const Powers &w) {
        Powers sum = bernstein(w, w.size() - 1, 1, -1);
        const Powers same = bernstein(w, w.size() - 1, 0, 1);
        for (std::size_t i = 0; i < sum.size(); ++i)
            if (std::fabs(sum[i] + same[i] - 1) > rounded) return false;
        return true;
    }
    static Table table(const Powers &w) {
        constexpr std::size_t leaves = std::size_t(1) << (levels - 1);
        Table out(2 * leaves);
        const Powers slope = derived(w), bend = derived(slope);
        const auto size_of = [](const Powers &of, double from, double size) {
            double most = 0;
            for (double x : bernstein(of, of.size() - 1, from, size))
                most = std::max(most, std::fabs(x) + rounded);
            return most;
        };
        for (std::size_t i = 2 * leaves - 1; i > 0; --i) {
            Part &part = out[i];
            std::size_t first = 1;
            while (2 * first <= i) first *= 2;
            const double size = 1.0 / double(first), from = double(i - first) * size;
            part.middle = at(w, from + size / 2), part.slope_there = at(slope, from + size / 2);
            part.half = size / 2;
            if (i >= leaves) {
                const auto values = bernstein(w, w.size() - 1, from, size);
                part.lo = std::ranges::min(values) - rounded;
                part.hi = std::ranges::max(values) + rounded;
                part.slope = size_of(slope, from, size), part.bend = size_of(bend, from, size);
                continue;
            }
            const Part &a = out[2 * i], &b = out[2 * i + 1];
            part.lo = std::min(a.lo, b.lo), part.hi = std::max(a.hi, b.hi);
            part.slope = std::max(a.slope, b.slope), part.bend = std::max(a.bend, b.bend);
        }
        return out;
    }

    // Is the way the first of those that are as steep?
    bool is_first(unsigned way) const {
        const unsigned corners = 1u << axes_, all = (1u << (corners - 1) << 1) - 1;
        std::array<unsigned, max_axes> order{0, 1, 2};
        do {
            for (unsigned mask = 0; mask < (mirrored_ ? corners : 1u); ++mask) {
                unsigned image = 0;
                for (unsigned corner = 0; corner < corners; ++corner) {
                    unsigned to = 0;
                    for (std::size_t i = 0; i < axes_; ++i) to |= (corner >> i & 1) << order[i];
                    image |= (way >> corner & 1) << (to ^ mask);
                }
                if (image >> (corners - 1) & 1) image = ~image & all;
                if (image < way) return false;
            }
        } while (alike_ && std::next_permutation(order.begin(), order.begin() + int(axes_)));
        return true;
    }

    // What F changes by from 0 to 1 along each of these axes, a bit each, at a place.
    double difference(unsigned way, unsigned along, const Place &place) const {
        double sum = 0;
        for (unsigned corner = 0; corner < 1u << axes_; ++corner) {
            if (!(way >> corner & 1)) continue;
            double weight = 1;
            for (std::size_t i = 0; i < axes_; ++i) {
                const bool far = corner >> i & 1;
                weight *= along >> i & 1 ? (far ? 1 : -1) : far ? place[i] : 1 - place[i];
            }
            sum += weight;
        }
        return sum;
    }
    // … its greatest size in a box: it is affine in each other weight.
    double change(unsigned way, unsigned along, const Box &box) const {
        double out = 0;
        for (unsigned end = 0; end < 1u << axes_; ++end) {
            if (end & along) continue;
            Place place{};
            for (std::size_t i = 0; i < axes_; ++i) {
                const Part &part = tables_[i][box[i]];
                place[i] = end >> i & 1 ? part.hi : part.lo;
            }
            out = std::max(out, std::fabs(difference(way, along, place)));
        }
        return out;
    }
    // The square of the slope: by the sizes of its parts, and by the mean value theorem; and the axis
    // along which it may change most, of those that can be halved.
    double square_in(unsigned way, const Box &box, std::size_t &steepest_axis) const {
        std::array<double, max_axes> most{}, slopes{};
        Place middle{};
        double square = 0;
        for (std::size_t i = 0; i < axes_; ++i) {
            const Part &part = tables_[i][box[i]];
            most[i] = change(way, 1u << i, box), slopes[i] = part.slope, middle[i] = part.middle;
            square += std::pow(slopes[i] * most[i], 2);
        }
        if (square <= enough_) return square;
        double there = 0, greatest = -1;
        for (std::size_t i = 0; i < axes_; ++i) {
            const Part &part = tables_[i][box[i]];
            there += std::pow(part.slope_there * difference(way, 1u << i, middle), 2);
            double by = 2 * part.slope * part.bend * most[i] * most[i];
            for (std::size_t k = 0; k < axes_; ++k)
                if (k != i)
                    by += 2 * slopes[k] * slopes[k] * most[k] * part.slope *
                          change(way, 1u << i | 1u << k, box);
            there += by * part.half;
            if (by * part.half > greatest && 2 * box[i] < tables_[i].size())
                greatest = by * part.half, steepest_axis = i;
        }
        return std::min(square, there * (1 + rounded) + rounded);
    }
    void halve(unsigned way, const Box &box, std::size_t &boxes) {
        if (++boxes > most_boxes) return;
        std::size_t axis = max_axes;
        const double square = square_in(way, box, axis);
        if (square <= enough_) return;
        if (axis == max_axes) {
            enough_ = square;
            return;
        }
        for (std::size_t half = 0; half < 2; ++half) {
            Box part = box;
            part[axis] = 2 * part[axis] + half;
            halve(way, part, boxes);
        }
    }
};

// A sum by the weights that its terms are multiplied with, a bit an axis.
using Terms = std::map<unsigned, Polynomial>;

class Interpolator {
  public:
    Interpolator(Graph &graph, SteepnessOfWeights &known, Work &work)
        : graph_(graph), known_(known), work_(work), expansion_(graph, &work) {}

    std::optional<Interpolation> of(NodeId scalar) {
        const unsigned read = reads(scalar);
        work_.take(reads_.size());
        if ((read & Other) || !(read & Steps) || !(read & Axes)) return {};
        const auto sum = terms(scalar);
        if (!sum) return {};
        Interpolation out;
        std::vector<Powers> weights;
        for (const Axis &axis : axes_) {
            if (axis.weight.empty()) return {};
            out.along.push_back(graph_.arg(axis.fraction, 0));
            weights.push_back(axis.weight);
        }
        for (unsigned corner = 0; corner < 1u << axes_.size(); ++corner) {
            Polynomial value, sizes; // sizes: of all that was added up to each number
            for (const auto &[weight, factor] : *sum) {
                if ((weight & ~corner) != 0) continue;
                add(value, factor, 1);
                for (const auto &[product, by] : factor) sizes[product] += std::fabs(by);
            }
            std::erase_if(value, [&](const auto &term) {
                return std::fabs(term.second) < rounded * sizes[term.first];
            });
            out.corners.push_back(rebuilt(graph_, value));
        }
        out.steepness = steepness(weights);
        return out;
    }

  private:
    // Found once for the weights that are mostly the same.
    double steepness(const std::vector<Powers> &weights) {
        const auto [known, fresh] = known_.try_emplace(weights, 0.0);
        if (fresh) {
            std::size_t boxes = 0;
            known->second =
                std::min(steepness_by_spread(weights), SteepestCorners(weights).steepness(boxes));
            work_.take(2 * boxes);
        }
        return known->second;
    }

    enum : unsigned { Axes = (1u << max_axes) - 1, Steps = 1u << max_axes, Other = 2u << max_axes };
    struct Axis {
        NodeId fraction;
        Powers weight; // 0 at 0 and 1 at 1; none before one was met
    };

    // Of a component of a function of vectors the same function of their components.
    NodeId plain(NodeId id) {
        const ir::Node node = graph_[id];
        if (node.op != Op::Swizzle || node.type != ir::Type::Float) return id;
        return component_of(graph_, graph_.arg(id, 0), ir::swizzle_component(node.payload, 0));
    }

    // How an expression changes with the point: by which fractions, by steps, or otherwise.
    unsigned reads(NodeId id) {
        if (const auto it = reads_.find(id); it != reads_.end()) return it->second;
        const ir::Graph::Reads all = graph_.reads(id);
        unsigned out = 0;
        if (all.normal || all.direction || reads_.size() > max_nodes_of_interpolation)
            out = Other;
        else if (all.point || all.free_vars)
            out = reads_of(id);
        reads_[id] = out;
        return out;
    }
    unsigned reads_of(NodeId id) {
        constexpr ir::OpSet steps{Op::Floor, Op::Ceil, Op::Round, Op::Trunc};
        constexpr ir::OpSet opaque{Op::Point, Op::Var,        Op::Loop,
                                   Op::Call,  Op::LoopResult, Op::Cached};
        const ir::Node node = graph_[id];
        if (steps[node.op]) return Steps;
        if (opaque[node.op]) return Other;
        if (const NodeId inner = plain(id); inner != id) return reads(inner);
        unsigned out = 0;
        for (NodeId arg : graph_.args(id)) out |= reads(arg);
        if (node.op != Op::Fract || !(out & (Other | Axes))) return out;
        if (node.type != ir::Type::Float || axes_.size() == max_axes) return Other;
        axes_.push_back({id, {}});
        return 1u << (axes_.size() - 1);
    }

    std::optional<Terms> terms(NodeId id) {
        if (const auto it = terms_.find(id); it != terms_.end()) return it->second;
        auto out = written(id);
        terms_[id] = out;
        return out;
    }
    std::optional<Terms> written(NodeId id) {
        const ir::Node node = graph_[id];
        if (const auto c = graph_.as_number(id)) return Terms{{0, {{{}, *c}}}};
        if (const NodeId inner = plain(id); inner != id) return terms(inner);
        const unsigned read = reads(id);
        if ((read & Other) || node.type != ir::Type::Float) return {};
        for (std::size_t axis = 0; axis < axes_.size(); ++axis)
            if (read == 1u << axis) return weight(id, axis);
        const auto arg = [&](int i) { return terms(graph_.arg(id, i)); };
        if (node.op == Op::Neg) return sum(Terms{}, arg(0), -1);
        if (node.op == Op::Add) return sum(arg(0), arg(1), 1);
        if (node.op == Op::Sub) return sum(arg(0), arg(1), -1);
        if (node.op == Op::Mul) return product_of(arg(0), arg(1));
        if (node.op == Op::Mix) {
            const auto a = arg(0);
            return sum(a, product_of(sum(arg(1), a, -1), arg(2)), 1);
        }
        if (read & Axes) return {};
        return Terms{{0, {{{id}, 1.0}}}};
    }

    static void add(Polynomial &to, const Polynomial &more, double by) {
        for (const auto &[factors, c] : more) to[factors] += by * c;
    }
    // a + by*b
    static std::optional<Terms> sum(std::optional<Terms> a, const std::optional<Terms> &b,
                                    double by) {
        if (!a || !b) return {};
        for (const auto &[weight, factor] : *b) add((*a)[weight], factor, by);
        return a;
    }
    std::optional<Terms> product_of(const std::optional<Terms> &a, const std::optional<Terms> &b) {
        if (!a || !b) return {};
        Terms out;
        for (const auto &[u, x] : *a)
            for (const auto &[v, y] : *b) {
                const auto factor = expansion_.multiply(x, y);
                if (!factor || (u & v)) return {};
                add(out[u | v], *factor, 1);
            }
        return out;
    }

    // What hangs on one fraction alone, as c + d w: w is the axis' weight.
    std::optional<Terms> weight(NodeId id, std::size_t index) {
        Axis &axis = axes_[index];
        auto powers = powers_of(id, axis.fraction);
        if (!powers || powers->size() < 2) return {};
        double begin = (*powers)[0], whole = 0;
        (*powers)[0] = 0;
        for (double x : *powers) whole += x;
        if (std::fabs(whole) < rounded * std::max(std::fabs(begin), 1.0)) return {};
        for (double &x : *powers) x /= whole;
        if (axis.weight.empty()) {
            for (double x : profile(*powers).spreads) // w (1 - w) is not below 0 where w is in 0..1
                if (x < -rounded) return {};
            axis.weight = *powers;
        }
        if (axis.weight.size() != powers->size()) return {};
        for (std::size_t i = 0; i < powers->size(); ++i)
            if (std::fabs(axis.weight[i] - (*powers)[i]) > rounded) return {};
        return Terms{{0, {{{}, begin}}}, {1u << index, {{{}, whole}}}};
    }
    // The polynomial of a fraction that a scalar is, which hangs on nothing else.
    std::optional<Powers> powers_of(NodeId id, NodeId fraction) {
        if (id == fraction) return Powers{0, 1};
        if (const auto c = graph_.as_number(id)) return Powers{*c};
        if (const NodeId inner = plain(id); inner != id) return powers_of(inner, fraction);
        const ir::Node node = graph_[id];
        constexpr ir::OpSet of_two{Op::Add, Op::Sub, Op::Mul};
        if (node.op == Op::Smoothstep && graph_.as_number(graph_.arg(id, 0)) == 0.0 &&
            graph_.as_number(graph_.arg(id, 1)) == 1.0) {
            const auto x = powers_of(graph_.arg(id, 2), fraction);
            return x == Powers{0, 1} ? std::optional(Powers{0, 0, 3, -2}) : std::nullopt;
        }
        if (!of_two[node.op] || ++products_ > max_products) return {};
        const auto a = powers_of(graph_.arg(id, 0), fraction),
                   b = powers_of(graph_.arg(id, 1), fraction);
        if (!a || !b || a->size() + b->size() > max_degree + 2) return {};
        if (node.op == Op::Mul) return product(*a, *b);
        return sum_of(*a, *b, node.op == Op::Add ? 1 : -1);
    }

    Graph &graph_;
    SteepnessOfWeights &known_;
    Work &work_;
    Expansion expansion_;
    std::vector<Axis> axes_;
    int products_ = 0;
    std::unordered_map<NodeId, unsigned> reads_;
    std::unordered_map<NodeId, std::optional<Terms>> terms_;
};

} // namespace

std::optional<Interpolation> interpolation(Graph &graph, NodeId scalar, SteepnessOfWeights &known,
                                           Work &work) {
    return Interpolator(graph, known, work).of(scalar);
}

} // namespace fathom::proof
