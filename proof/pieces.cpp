// Each `min`, `abs`, `clamp`, `if` that is met goes one way, the same wherever it is met again; all
// ways are tried in the order of counting. What is not affine is a part of its own, but for a
// length that stands alone in a row: |q| turns no faster than q, so q's rows stand for it.
#include "proof/pieces.h"

#include "ir/passes/inline.h"
#include "proof/continuity.h"
#include "proof/machine.h"
#include "proof/roots.h"

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
    Turned, // by a matrix
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
    {Op::MatMul, How::Turned},
};

using Affine = std::map<NodeId, double>; // by part; numbers that are added do not count

// One way that all choices may go. `length`: the one |q| that stands in a row beside other parts, if
// there is one; `of`: q's rows.
struct Piece {
    std::vector<Affine> rows;
    NodeId length;
    std::vector<Affine> of;
};

// Row k is a_k |q| + b_k p with q = Q p: its Jacobian is J = a n^T Q + B, n of length 1, so that
// J J^T <= |Q|^2 a a^T + B B^T + 2 |a| |Q B^T|. With e_1 along a row of Q, the norm of [a |Q|, B] is at
// most that of [a |Q|, B e_2, B e_3] and |B e_1|. Both corrections are 0 where every b_k is an axis of q.
double norm_about_axis(const std::vector<double> &a, const std::vector<Row> &b,
                       const std::vector<Row> &q) {
    using Vector = std::array<double, 3>;
    const auto dot = [](const auto &x, const auto &y) {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) sum += Interval(x[i]).hi * Interval(y[i]).hi;
        return sum;
    };
    const Row &longest = *std::ranges::max_element(q, {}, [&](const Row &r) { return dot(r, r); });
    const double size = std::sqrt(dot(longest, longest));
    Vector first{1, 0, 0}, second{};
    if (size > 0)
        for (std::size_t i = 0; i < 3; ++i) first[i] = longest[i].hi / size;
    const std::size_t least = std::size_t(
        std::ranges::min_element(first, {}, [](double x) { return std::fabs(x); }) - first.begin());
    for (std::size_t i = 0; i < 3; ++i) second[i] = (i == least) - first[least] * first[i];
    const double across = std::sqrt(dot(second, second));
    for (double &x : second) x /= across;
    const Vector third{first[1] * second[2] - first[2] * second[1],
                       first[2] * second[0] - first[0] * second[2],
                       first[0] * second[1] - first[1] * second[0]};
    const double of_q = spectral_norm(q.data(), int(q.size()));
    std::vector<Row> matrix;
    double along = 0, turned = 0, sizes = 0; // |B e_1|, |Q B^T|, |a|, each squared
    for (std::size_t k = 0; k < a.size(); ++k) {
        matrix.push_back({a[k] * of_q, dot(b[k], second), dot(b[k], third)});
        along += std::pow(dot(b[k], first), 2);
        sizes += a[k] * a[k];
        for (const Row &row : q) turned += std::pow(dot(row, b[k]), 2);
    }
    const double norm = spectral_norm(matrix.data(), int(matrix.size())) + std::sqrt(along);
    return std::sqrt(norm * norm + 2 * std::sqrt(sizes) * std::sqrt(turned));
}

class PieceReader {
  public:
    struct Mode {
        bool lengths = true;  // rows of q for |q|
        bool shallow = false; // vectors that are computed are parts as they are
        bool placed = false;  // but for those whose components are rows as they are
        bool turns = false;   // so are sums of products of what varies
    };
    PieceReader(Graph &graph, int &steps, Mode mode)
        : graph_(graph), steps_(steps), first_(steps), mode_(mode) {}

    std::optional<Pieces> read(const std::vector<NodeId> &of) {
        std::vector<Piece> pieces;
        do {
            next_ = 0;
            way_.clear();
            order_.clear();
            of_ = of;
            std::vector<Affine> rows = rows_of(of);
            if (mode_.lengths) expand_lengths(rows);
            if (failed_ || rows.size() > max_rows || int(pieces.size()) > max_pieces) return {};
            pieces.push_back(with_length(std::move(rows)));
            if (failed_) return {};
        } while (to_next());
        if (std::ranges::any_of(pieces, [](const Piece &piece) { return bool(piece.length); })) {
            if (auto found = measured(pieces)) return found;
            for (Piece &piece : pieces) piece.length = {}; // a part as any other
        }
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
    int placed_ = 0; // down to this depth a row is a component as it is
    bool failed_ = false;
    std::vector<Decision> taken_;
    std::size_t next_ = 0;
    std::map<std::pair<NodeId, int>, int> way_; // of this piece
    std::map<std::pair<NodeId, NodeId>, int> order_;
    std::map<NodeId, NodeId> called_;
    std::map<NodeId, std::vector<NodeId>> measured_; // by length: what it is the length of

    int way(NodeId id, int i, int many) {
        const auto [it, fresh] = way_.try_emplace({id, i}, 0);
        if (!fresh) return it->second;
        if (next_ == taken_.size()) taken_.push_back({0, many});
        return it->second = taken_[next_++].way;
    }
    // Is a < b? The same wherever it is met.
    bool is_less(NodeId a, NodeId b) {
        const auto [it, fresh] = order_.try_emplace({a, b}, 0);
        if (fresh) {
            if (next_ == taken_.size()) taken_.push_back({0, 2});
            it->second = taken_[next_++].way;
        }
        return it->second == 0;
    }
    // Which of two numbers is the lesser: as they are compared, if they are. Where they are equal both
    // are as steep.
    int lesser(NodeId a, int ai, NodeId b, int bi) {
        a = graph_.component(a, ai), b = graph_.component(b, bi);
        if (order_.contains({b, a}) && !order_.contains({a, b})) return is_less(b, a) ? 1 : 0;
        return is_less(a, b) ? 0 : 1;
    }
    // The argument that a Select has.
    int chosen(NodeId select) {
        const NodeId condition = graph_.arg(select, 0);
        const Op op = graph_[condition].op;
        if (!varies(condition)) return way(select, 0, 2) + 1;
        if ((op == Op::Less || op == Op::LessEqual) &&
            graph_.type(graph_.arg(condition, 0)) == ir::Type::Float) {
            const NodeId a = graph_.arg(condition, 0), b = graph_.arg(condition, 1);
            return (op == Op::Less ? is_less(a, b) : !is_less(b, a)) ? 1 : 2;
        }
        return way(condition, 0, 2) + 1;
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
        if (node.op == Op::Select && varies(graph_.arg(id, 0))) return arg(chosen(id));
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
    // The components of v by every `step`th number of a constant, from the `first` one.
    Affine weighted(NodeId v, NodeId constant, int first, int step, int depth) {
        Affine sum;
        for (int k = 0; k < ir::components(graph_[v].type); ++k)
            sum = add(sum, component(v, k, depth + 1),
                      graph_.constant_of(constant).value[std::size_t(first + k * step)]);
        return sum;
    }
    Affine product_sum(NodeId id, int depth) { // of a dot product
        for (int k = 0; k < 2; ++k)
            if (graph_.is_constant(graph_.arg(id, k)))
                return weighted(graph_.arg(id, 1 - k), graph_.arg(id, k), 0, 1, depth);
        return part(id, 0);
    }
    Affine turned_sum(NodeId id, int i, int depth) { // of a vector by a matrix
        const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
        const bool left = ir::is_matrix(graph_[a].type);
        const NodeId matrix = left ? a : b, v = left ? b : a;
        if (!graph_.is_constant(matrix)) return part(id, i);
        const int side = ir::components(graph_[v].type); // matrices are stored by columns
        return weighted(v, matrix, left ? i : i * side, left ? side : 1, depth);
    }

    // Is a term of the sum a product of what varies?
    bool has_product(NodeId id, int depth) {
        constexpr ir::OpSet sums{Op::Add, Op::Sub, Op::Neg};
        const ir::Node node = graph_[id];
        if (too_much(depth)) return false;
        if (node.op == Op::Mul) return varies(graph_.arg(id, 0)) && varies(graph_.arg(id, 1));
        return sums[node.op] && std::ranges::any_of(graph_.args(id), [&](NodeId arg) {
                   return has_product(arg, depth + 1);
               });
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
            std::find(of_.begin(), of_.end(), id) == of_.end() && depth > placed_)
            return part(id, i);
        if (mode_.placed && made[node.op] && depth == placed_) ++placed_;
        switch (how_of_op[node.op]) {
        case How::Negative: return add({}, arg(0), -1);
        case How::Sum: {
            if (mode_.turns && depth > 0 && has_product(id, depth)) return part(id, i);
            const Affine first = arg(0); // visits in one order: ways are counted
            return add(first, arg(1), node.op == Op::Add ? 1 : -1);
        }
        case How::Product: return scaled(id, i, depth);
        case How::OneOfTwo: {
            const auto component_of = [&](NodeId of) {
                return ir::is_vector(graph_[of].type) ? i : 0;
            };
            const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
            const int least = lesser(a, component_of(a), b, component_of(b));
            return arg(node.op == Op::Min ? least : 1 - least);
        }
        case How::OneOfThree: return arg(way(id, i, 3));
        case How::Size: return add({}, arg(0), way(id, i, 2) == 0 ? 1 : -1);
        case How::Chosen: return arg(chosen(id));
        case How::Still: return {};
        case How::AsItself: return arg(0);
        case How::Remainder: return varies(graph_.arg(id, 1)) ? part(id, i) : arg(0);
        case How::Dot: return product_sum(id, depth);
        case How::Turned: return turned_sum(id, i, depth);
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

    // The vectors and numbers that a part is the length of together; none where it is no length.
    const std::vector<NodeId> &length_of(NodeId part) {
        const auto [at, fresh] = measured_.try_emplace(part);
        if (!fresh) return at->second;
        if (graph_[part].op == Op::Length)
            at->second = {graph_.arg(part, 0)};
        else if (graph_[part].op == Op::Sqrt)
            at->second = norm_parts(graph_, part).value_or(std::vector<NodeId>());
        return at->second;
    }
    std::vector<Affine> rows_of(const std::vector<NodeId> &of) {
        std::vector<Affine> rows;
        for (NodeId id : of)
            for (int c = 0; c < ir::components(graph_[id].type); ++c) {
                placed_ = 0;
                rows.push_back(component(id, c, 0));
            }
        return rows;
    }

    void expand_lengths(std::vector<Affine> &rows) {
        for (std::size_t r = 0; r < rows.size() && !failed_; ++r) {
            if (rows[r].size() != 1) continue;
            const NodeId length = rows[r].begin()->first;
            const double by = rows[r].begin()->second;
            const std::vector<NodeId> &of = length_of(length);
            if (of.empty()) continue;
            const bool elsewhere = std::any_of(rows.begin(), rows.end(), [&](const Affine &row) {
                return &row != &rows[r] && row.contains(length);
            });
            if (elsewhere) continue;
            rows.erase(rows.begin() + std::ptrdiff_t(r));
            for (const Affine &row : rows_of(of)) rows.push_back(add({}, row, by));
            if (rows.size() > max_rows) failed_ = true;
            --r;
        }
    }

    // What expand_lengths left: where it is one length, with the rows of its vector.
    Piece with_length(std::vector<Affine> rows) {
        Piece out{std::move(rows), {}, {}};
        if (!mode_.lengths) return out;
        for (const Affine &row : out.rows)
            for (const auto &[part, c] : row) {
                if (part == out.length || length_of(part).empty()) continue;
                if (out.length) return {std::move(out.rows), {}, {}};
                out.length = part;
            }
        if (!out.length) return out;
        out.of = rows_of(length_of(out.length));
        if (out.of.empty()) out.length = {};
        return out;
    }

    std::optional<Pieces> measured(const std::vector<Piece> &pieces) {
        Pieces out;
        for (const Piece &piece : pieces) {
            const auto add_parts = [&](const std::vector<Affine> &rows) {
                for (const Affine &row : rows)
                    for (const auto &[part, c] : row)
                        if (part != piece.length &&
                            std::ranges::find(out.parts, part) == out.parts.end())
                            out.parts.push_back(part);
            };
            add_parts(piece.rows);
            if (piece.length) add_parts(piece.of);
        }
        if (out.parts.empty() || out.parts.size() > max_parts) return {};
        // What is a part of itself is made of nothing nearer.
        for (NodeId part : out.parts)
            if (of_.size() == 1 && (part == of_[0] || (graph_[part].op == Op::Swizzle &&
                                                       graph_.arg(part, 0) == of_[0])))
                return {};
        double longest = 0; // of a row
        for (const Piece &piece : pieces) {
            std::vector<double> lengths; // what the length is multiplied with
            const auto matrix_of = [&](const std::vector<Affine> &rows) {
                std::vector<Row> matrix;
                for (const Affine &row : rows) {
                    Row &to = matrix.emplace_back();
                    for (const auto &[part, c] : row)
                        if (part != piece.length)
                            to[std::size_t(std::ranges::find(out.parts, part) -
                                           out.parts.begin())] = c;
                }
                return matrix;
            };
            const std::vector<Row> matrix = matrix_of(piece.rows);
            for (const Row &row : matrix) longest = std::max(longest, spectral_norm(&row, 1));
            double norm = 0;
            if (piece.length) {
                for (const Affine &row : piece.rows) {
                    const auto at = row.find(piece.length);
                    lengths.push_back(at == row.end() ? 0 : at->second);
                }
                norm = norm_about_axis(lengths, matrix, matrix_of(piece.of));
            } else {
                norm = spectral_norm(matrix.data(), int(matrix.size()));
            }
            out.norm = std::max(out.norm, norm);
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
    for (const PieceReader::Mode mode : {PieceReader::Mode{.shallow = true},
                                         {.shallow = true, .placed = true},
                                         {},
                                         {.lengths = false},
                                         {.shallow = true, .turns = true}}) {
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
