// Each `min`, `abs`, `clamp`, `if` that is met goes one way, the same wherever it is met again; all
// ways are tried in the order of counting. What is not affine is a part of its own, but for a
// length that stands alone in a row: |q| turns no faster than q, so q's rows stand for it.
#include "proof/pieces.h"

#include "ir/passes/inline.h"
#include "proof/continuity.h"
#include "proof/machine.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fathom::proof {
namespace {

using ir::Graph;

constexpr int max_pieces = 600, max_depth = 120, max_steps_of_one = 5'000;
constexpr std::size_t max_rows = 12, max_parts = 3;

enum class How : std::uint8_t {
    Part, // nothing is known of it
    Negative,
    Sum,
    Product,
    OneOfTwo,
    OneOfThree,
    Size,
    Chosen,
    Still, // but for jumps
    AsItself,
    Remainder,
    Dot,
    Splat,
    Swizzle,
    Make,
    Call,
};
constexpr ir::OpTable<How> how_of_op{
    {Op::Neg, How::Negative},    {Op::Add, How::Sum},          {Op::Sub, How::Sum},
    {Op::Mul, How::Product},     {Op::Div, How::Product},      {Op::Min, How::OneOfTwo},
    {Op::Max, How::OneOfTwo},    {Op::Clamp, How::OneOfThree}, {Op::Abs, How::Size},
    {Op::Select, How::Chosen},   {Op::Sign, How::Still},       {Op::Step, How::Still},
    {Op::Floor, How::Still},     {Op::Ceil, How::Still},       {Op::Round, How::Still},
    {Op::Trunc, How::Still},     {Op::ToFloat, How::Still},    {Op::Fract, How::AsItself},
    {Op::Mod, How::Remainder},   {Op::Dot, How::Dot},          {Op::Splat, How::Splat},
    {Op::Swizzle, How::Swizzle}, {Op::Make, How::Make},        {Op::Call, How::Call},
};

using Affine = std::map<NodeId, double>; // by part; numbers that are added do not count

class PieceReader {
  public:
    struct Mode {
        bool lengths = true;  // rows of q for |q|
        bool shallow = false; // vectors that are computed are parts as they are
    };
    PieceReader(Graph &graph, int &steps, Mode mode)
        : graph_(graph), steps_(steps), first_(steps), mode_(mode) {}

    std::optional<Pieces> read(const std::vector<NodeId> &of) {
        std::vector<std::vector<Affine>> pieces;
        do {
            next_ = 0;
            way_.clear();
            std::vector<Affine> rows;
            of_ = of;
            for (NodeId id : of)
                for (int i = 0; i < ir::components(graph_[id].type); ++i)
                    rows.push_back(component(id, i, 0));
            if (mode_.lengths) expand_lengths(rows);
            if (failed_ || rows.size() > max_rows || int(pieces.size()) > max_pieces) return {};
            pieces.push_back(std::move(rows));
        } while (to_next());
        return measured(pieces);
    }

  private:
    struct Decision {
        int way, many;
    };
    Graph &graph_;
    int &steps_;
    const int first_;
    const Mode mode_;
    std::vector<NodeId> of_;
    bool failed_ = false;
    std::vector<Decision> taken_;
    std::size_t next_ = 0;
    std::map<std::pair<NodeId, int>, int> way_; // of this piece
    std::map<NodeId, NodeId> called_;

    int way(NodeId id, int i, int many) {
        const auto [it, fresh] = way_.try_emplace({id, i}, 0);
        if (!fresh) return it->second;
        if (next_ == taken_.size()) taken_.push_back({0, many});
        return it->second = taken_[next_++].way;
    }
    bool to_next() {
        while (!taken_.empty() && taken_.back().way + 1 == taken_.back().many) taken_.pop_back();
        if (taken_.empty()) return false;
        ++taken_.back().way;
        return true;
    }
    bool too_much(int depth) {
        ++steps_;
        failed_ = failed_ || depth > max_depth || steps_ - first_ > max_steps_of_one ||
                  steps_ > most_steps_of_pieces;
        return failed_;
    }

    bool varies(NodeId id) const {
        const ir::Graph::Reads reads = graph_.reads(id);
        return reads.point || reads.free_vars;
    }
    static Affine add(Affine a, const Affine &b, double by) {
        for (const auto &[part, c] : b) {
            double &to = a[part];
            const double size = std::fabs(to) + std::fabs(by * c);
            to += by * c;
            if (std::fabs(to) <= 1e-15 * size) a.erase(part);
        }
        return a;
    }

    // What does not vary but from piece to piece: a number, or one that a piece decides.
    std::optional<double> number(NodeId id, int i, int depth) {
        if (too_much(depth)) return {};
        const ir::Node node = graph_[id];
        if (graph_.is_constant(id))
            return graph_.constant_of(id).value[static_cast<std::size_t>(i)];
        const auto arg = [&](int k) { return number(graph_.arg(id, k), i, depth + 1); };
        const auto both = [&](auto combine) -> std::optional<double> {
            const auto x = arg(0), y = x ? arg(1) : std::nullopt;
            return y ? std::optional(combine(*x, *y)) : std::nullopt;
        };
        constexpr ir::OpSet whole{Op::Floor, Op::Round, Op::Ceil, Op::Trunc};
        if (node.op == Op::Splat) return number(graph_.arg(id, 0), 0, depth + 1);
        if (node.op == Op::Swizzle)
            return number(graph_.arg(id, 0), ir::swizzle_component(node.payload, i), depth + 1);
        if (node.op == Op::Make) {
            const auto [of, k] = made_of(id, i);
            return number(of, k, depth + 1);
        }
        if (node.op == Op::Neg) {
            const auto x = arg(0);
            return x ? std::optional(-*x) : std::nullopt;
        }
        if (node.op == Op::Add) return both([](double x, double y) { return x + y; });
        if (node.op == Op::Sub) return both([](double x, double y) { return x - y; });
        if (node.op == Op::Mul) return both([](double x, double y) { return x * y; });
        if (!varies(id)) return {};
        if (node.op == Op::Sign) return way(id, i, 3) - 1.0;
        if (node.op == Op::Step) return double(way(id, i, 2));
        if (node.op == Op::Mod && whole[graph_[graph_.arg(id, 0)].op] && arg(1) == 2.0)
            return double(way(id, i, 2));
        if (node.op == Op::Select && varies(graph_.arg(id, 0)))
            return arg(way(graph_.arg(id, 0), 0, 2) == 0 ? 1 : 2);
        return {};
    }

    std::pair<NodeId, int> made_of(NodeId make, int i) const { // an argument, and its component
        for (NodeId a : graph_.args(make)) {
            const int n = ir::components(graph_[a].type);
            if (i < n) return {a, i};
            i -= n;
        }
        return {make, i};
    }

    Affine part(NodeId id, int i) {
        if (!ir::is_vector(graph_[id].type)) return {{id, 1.0}};
        return {{graph_.component(id, i), 1.0}};
    }

    Affine scaled(NodeId id, int i, int depth) { // a product, or a quotient
        const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
        const bool divides = graph_[id].op == Op::Div;
        if (const auto by = number(b, i, depth + 1); by && (!divides || *by != 0))
            return add({}, component(a, i, depth + 1), divides ? 1 / *by : *by);
        if (const auto by = divides ? std::nullopt : number(a, i, depth + 1))
            return add({}, component(b, i, depth + 1), *by);
        return part(id, i);
    }
    Affine product_sum(NodeId id, int depth) { // of a dot product
        for (int k = 0; k < 2; ++k) {
            const NodeId fixed = graph_.arg(id, k), moves = graph_.arg(id, 1 - k);
            if (!graph_.is_constant(fixed)) continue;
            Affine sum;
            for (int c = 0; c < ir::components(graph_[fixed].type); ++c)
                sum = add(sum, component(moves, c, depth + 1),
                          graph_.constant_of(fixed).value[static_cast<std::size_t>(c)]);
            return sum;
        }
        return part(id, 0);
    }

    Affine component(NodeId id, int i, int depth) {
        if (too_much(depth) || !varies(id)) return {};
        const ir::Node node = graph_[id];
        if (node.type == ir::Type::Int) return {};
        const auto arg = [&](int k) { return component(graph_.arg(id, k), i, depth + 1); };
        if (ir::is_matrix(node.type) || node.type == ir::Type::Bool) {
            failed_ = true;
            return {};
        }
        constexpr ir::OpSet made{Op::Make, Op::Swizzle, Op::Splat};
        if (mode_.shallow && ir::is_vector(node.type) && !made[node.op] &&
            std::find(of_.begin(), of_.end(), id) == of_.end() && depth > 0)
            return part(id, i);
        switch (how_of_op[node.op]) {
        case How::Negative: return add({}, arg(0), -1);
        case How::Sum: {
            const Affine first = arg(0); // visits in one order: ways are counted
            return add(first, arg(1), node.op == Op::Add ? 1 : -1);
        }
        case How::Product: return scaled(id, i, depth);
        case How::OneOfTwo: return arg(way(id, i, 2));
        case How::OneOfThree: return arg(way(id, i, 3));
        case How::Size: return add({}, arg(0), way(id, i, 2) == 0 ? 1 : -1);
        case How::Chosen: {
            const NodeId condition = graph_.arg(id, 0);
            return arg(way(varies(condition) ? condition : id, 0, 2) == 0 ? 1 : 2);
        }
        case How::Still: return {};
        case How::AsItself: return arg(0);
        case How::Remainder: return varies(graph_.arg(id, 1)) ? part(id, i) : arg(0);
        case How::Dot: return product_sum(id, depth);
        case How::Splat: return component(graph_.arg(id, 0), 0, depth + 1);
        case How::Swizzle:
            return component(graph_.arg(id, 0), ir::swizzle_component(node.payload, i), depth + 1);
        case How::Make: {
            const auto [of, k] = made_of(id, i);
            return component(of, k, depth + 1);
        }
        case How::Call: {
            NodeId &inner = called_[id];
            if (!inner) inner = ir::called(graph_, id);
            return component(inner, i, depth + 1);
        }
        case How::Part: break;
        }
        return part(id, i);
    }

    void expand_lengths(std::vector<Affine> &rows) {
        for (std::size_t r = 0; r < rows.size() && !failed_; ++r) {
            if (rows[r].size() != 1) continue;
            const NodeId length = rows[r].begin()->first;
            const double by = rows[r].begin()->second;
            if (graph_[length].op != Op::Length) continue;
            const bool elsewhere = std::any_of(rows.begin(), rows.end(), [&](const Affine &row) {
                return &row != &rows[r] && row.contains(length);
            });
            if (elsewhere) continue;
            const NodeId of = graph_.arg(length, 0);
            rows.erase(rows.begin() + std::ptrdiff_t(r));
            for (int c = 0; c < ir::components(graph_[of].type); ++c)
                rows.push_back(add({}, component(of, c, 0), by));
            if (rows.size() > max_rows) failed_ = true;
            --r;
        }
    }

    std::optional<Pieces> measured(const std::vector<std::vector<Affine>> &pieces) {
        Pieces out;
        for (const auto &rows : pieces)
            for (const Affine &row : rows)
                for (const auto &[part, c] : row)
                    if (std::find(out.parts.begin(), out.parts.end(), part) == out.parts.end())
                        out.parts.push_back(part);
        if (out.parts.empty() || out.parts.size() > max_parts) return {};
        // What is a part of itself is made of nothing nearer.
        for (NodeId part : out.parts)
            if (of_.size() == 1 && (part == of_[0] || (graph_[part].op == Op::Swizzle &&
                                                       graph_.arg(part, 0) == of_[0])))
                return {};
        double longest = 0; // of a row
        for (const auto &rows : pieces) {
            std::vector<Row> matrix;
            for (const Affine &row : rows) {
                Row &to = matrix.emplace_back();
                for (const auto &[part, c] : row)
                    to[std::size_t(std::find(out.parts.begin(), out.parts.end(), part) -
                                   out.parts.begin())] = c;
            }
            out.norm = std::max(out.norm, spectral_norm(matrix.data(), int(matrix.size())));
            for (const Row &row : matrix) longest = std::max(longest, spectral_norm(&row, 1));
        }
        out.norm = ir::rounding::up(out.norm * (1 + 1e-13), 4);
        out.at_right_angles = out.norm <= longest * (1 + 1e-6);
        as_one_vector(out.parts);
        return out;
    }

    // Components of one vector: the vector, whose Jacobian has theirs as rows.
    void as_one_vector(std::vector<NodeId> &parts) const {
        NodeId vector;
        for (NodeId part : parts) {
            if (graph_[part].op != Op::Swizzle) return;
            const NodeId of = graph_.arg(part, 0);
            if (vector && of != vector) return;
            vector = of;
        }
        parts = {vector};
    }
};

} // namespace

std::optional<Pieces> by_pieces(Graph &graph, const std::vector<NodeId> &of, int &steps) {
    std::optional<Pieces> best;
    double least = 0; // the best's norm
    for (const PieceReader::Mode mode :
         {PieceReader::Mode{true, true}, {true, false}, {false, false}}) {
        const auto found = PieceReader(graph, steps, mode).read(of);
        // Parts of several vectors have a norm that is not known here.
        const double worse = found && found->parts.size() > 1 ? 1 + 1e-6 : 1;
        if (found && (!best || found->norm * worse < least))
            best = found, least = found->norm * worse;
        if (best && best->at_right_angles && best->parts.size() == 1) break;
    }
    return best;
}

} // namespace fathom::proof
