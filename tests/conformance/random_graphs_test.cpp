// Random graphs with functions and loops: the tape against a plain walk that rounds every number to
// float32. Only ops whose float32 result is the rounded true one, so that both must agree to the
// bit: what is tested is the order of things, the registers, calls and loops.
#include "backend-cpu/tape.h"
#include "tests/conformance/questions.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace fathom;
using namespace fathom::conformance;
using ir::Constant;
using ir::Graph;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

class Walker {
  public:
    explicit Walker(const Graph &graph) : g_(graph) {}
    std::unordered_map<NodeId, Constant> known;

    Constant value(NodeId id) {
        if (auto found = known.find(id); found != known.end()) return found->second;
        return known[id] = compute(id);
    }

  private:
    Constant compute(NodeId id) {
        const ir::Node &node = g_[id];
        if (node.op == Op::Const) return rounded(g_.constant_of(id));
        if (node.op == Op::Loop) return loop(id)[0];
        if (node.op == Op::LoopResult) return loop(g_.arg(id, 0))[node.payload];
        std::vector<Constant> args;
        for (NodeId arg : g_.args(id)) args.push_back(value(arg));
        if (node.op == Op::Call) {
            const ir::Function &function = g_.function(ir::FunctionId{node.payload});
            Walker inner(g_);
            for (std::size_t i = 0; i < args.size(); ++i) inner.known[function.params[i]] = args[i];
            return inner.value(function.result);
        }
        return rounded(ir::evaluate(node.op, node.type, args, node.payload).value());
    }

    static Constant rounded(Constant constant) {
        for (double &x : constant.value) x = static_cast<float>(x);
        return constant;
    }

    std::vector<Constant> loop(NodeId id) {
        const ir::Loop &loop = g_.loop(ir::LoopId{g_[id].payload});
        std::vector<Constant> now;
        for (NodeId arg : g_.args(id)) now.push_back(value(arg));
        const double count = std::min<double>(value(loop.count).value[0], loop.max_count);
        for (double i = 0; i < count; ++i) {
            Walker iteration(g_);
            for (const auto &[var, constant] : known)
                if (g_[var].op == Op::Var) iteration.known[var] = constant;
            iteration.known[loop.index] = {Type::Int, {i}};
            for (std::size_t k = 0; k < now.size(); ++k) iteration.known[loop.vars[k]] = now[k];
            if (loop.condition && iteration.value(loop.condition).value[0] == 0) break;
            std::vector<Constant> next;
            for (NodeId n : loop.next) next.push_back(iteration.value(n));
            now = std::move(next);
        }
        return now;
    }

    const Graph &g_;
};

// Grows expressions from what is at hand.
class Grower {
  public:
    Grower(Graph &graph, Random &random) : g_(graph), random_(random) {}
    std::vector<NodeId> floats, vectors;
    std::vector<ir::FunctionId> functions;

    NodeId scalar() { return floats[random_.below(floats.size())]; }
    NodeId vector() { return vectors[random_.below(vectors.size())]; }
    NodeId constant() { return g_.number(static_cast<float>(random_.between(-2, 2))); }

    void grow(int steps, int depth) {
        for (int i = 0; i < steps; ++i) {
            switch (random_.below(16)) {
            case 0: floats.push_back(g_.make(Op::Min, {scalar(), scalar()})); break;
            case 1: floats.push_back(g_.make(Op::Max, {scalar(), constant()})); break;
            case 2: floats.push_back(g_.add(g_.mul(scalar(), constant()), scalar())); break;
            case 3: floats.push_back(g_.make(Op::Sqrt, {g_.make(Op::Abs, {scalar()})})); break;
            case 4:
                floats.push_back(g_.component(vector(), static_cast<int>(random_.below(3))));
                break;
            case 5:
                vectors.push_back(g_.make(Op::Make, Type::Vec3, {scalar(), scalar(), constant()}));
                break;
            case 6:
                vectors.push_back(g_.make(Op::Max, {g_.make(Op::Abs, {vector()}), vector()}));
                break;
            case 7: vectors.push_back(g_.sub(vector(), vector())); break;
            case 8:
                floats.push_back(g_.make(
                    Op::Select, {g_.make(Op::Less, {scalar(), scalar()}), scalar(), scalar()}));
                break;
            case 9:
                vectors.push_back(g_.make(
                    Op::Select, {g_.make(Op::Less, {scalar(), scalar()}), vector(), vector()}));
                break;
            case 10:
                floats.push_back(g_.make(Op::Clamp, {scalar(), g_.number(-1), g_.number(1)}));
                break;
            case 11:
                floats.push_back(g_.make(Op::Union, Type::Float, {scalar(), scalar(), scalar()}));
                break;
            case 12:
                floats.push_back(g_.mul(g_.make(Op::Floor, {scalar()}), g_.number(0.25)));
                break;
            case 13:
            case 14: call(); break;
            case 15:
                if (depth < 3) loop(depth);
                break;
            }
        }
    }

  private:
    void call() {
        if (functions.empty()) return;
        const ir::FunctionId f = functions[random_.below(functions.size())];
        const NodeId args[] = {vector(), random_.below(2) ? scalar() : constant()};
        const NodeId made = g_.call(f, args);
        (g_[made].type == Type::Float ? floats : vectors).push_back(made);
    }

    void loop(int depth) {
        ir::Loop record;
        record.max_count = static_cast<int>(random_.below(4)) + 1;
        // The same number of iterations for all, or each its own.
        record.count = random_.below(2)
                           ? g_.integer(record.max_count)
                           : g_.make(Op::ToInt, Type::Int,
                                     {g_.make(Op::Clamp, {scalar(), g_.number(0), g_.number(3)})});
        record.index = g_.fresh_var(Type::Int);
        record.vars = {g_.fresh_var(Type::Float), g_.fresh_var(Type::Vec3),
                       g_.fresh_var(Type::Float)};
        Grower inner(g_, random_);
        inner.functions = functions;
        inner.floats = {record.vars[0], record.vars[2], scalar(),
                        g_.make(Op::ToFloat, Type::Float, {record.index})};
        inner.vectors = {record.vars[1], vector()};
        inner.grow(static_cast<int>(random_.below(10)) + 2, depth + 1);
        // Halved and clamped, so that nothing runs away.
        auto tame = [&](NodeId v) {
            return g_.make(Op::Clamp, {g_.mul(v, g_.number(0.5)), g_.number(-8), g_.number(8)});
        };
        record.next = {tame(inner.floats.back()),
                       inner.vectors[random_.below(inner.vectors.size())],
                       random_.below(3) ? tame(inner.scalar()) : record.vars[0]};
        if (random_.below(2))
            record.condition = g_.make(Op::Less, {inner.scalar(), g_.number(1.5)});
        const NodeId start[] = {scalar(), vector(), random_.below(2) ? constant() : scalar()};
        const NodeId loop = g_.make(Op::Loop, Type::Float, start, g_.add_loop(record).index);
        floats.push_back(loop);
        vectors.push_back(g_.make(Op::LoopResult, Type::Vec3, {loop}, 1));
        floats.push_back(g_.make(Op::LoopResult, Type::Float, {loop}, 2));
    }

    Graph &g_;
    Random &random_;
};

bool equal(double a, float b) {
    return static_cast<float>(a) == b || (std::isnan(a) && std::isnan(b));
}

} // namespace

TEST_CASE("random graphs: the tape agrees with a plain walk to the bit") {
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        CAPTURE(seed);
        Random random{seed * 977};
        ir::Scene scene;
        Graph &g = scene.graph;
        std::vector<ir::FunctionId> functions;
        NodeId p, result;
        for (int f = 0; f < 4; ++f) {
            const NodeId a = g.fresh_var(Type::Vec3), b = g.fresh_var(Type::Float);
            Grower grower(g, random);
            grower.floats = {b, g.component(a, 0), grower.constant()};
            grower.vectors = {a};
            grower.functions = functions;
            grower.grow(static_cast<int>(random.below(25)) + 3, 0);
            result = random.below(2) ? grower.floats.back() : grower.vectors.back();
            functions.push_back(g.add_function({"f", {}, {a, b}, result}));
        }
        p = g.fresh_var(Type::Vec3);
        const NodeId start = g.component(p, 2);
        Grower last(g, random);
        last.floats = {start, g.component(p, 0), last.constant()};
        last.vectors = {p};
        last.functions = functions;
        last.grow(40, 0);
        std::vector<NodeId> results{last.floats.back(), last.vectors.back()};
        const cpu::Program program = cpu::compile(scene, std::span(&p, 1), results);
        cpu::Scratch scratch = cpu::make_scratch(program, {});
        constexpr std::size_t n = 37;
        std::vector<std::vector<float>> in(3, std::vector<float>(n)), out(4, std::vector<float>(n));
        for (auto &column : in)
            for (float &x : column) x = static_cast<float>(random.between(-3, 3));
        const float *from[] = {in[0].data(), in[1].data(), in[2].data()};
        float *to[] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
        cpu::evaluate(program, scratch, from, to, n);
        for (std::size_t k = 0; k < n; ++k) {
            Walker walker(g);
            walker.known[p] = {Type::Vec3, {in[0][k], in[1][k], in[2][k]}};
            CAPTURE(k);
            REQUIRE(equal(walker.value(results[0]).value[0], out[0][k]));
            for (std::size_t c = 0; c < 3; ++c)
                REQUIRE(equal(walker.value(results[1]).value[c], out[1 + c][k]));
        }
    }
}
