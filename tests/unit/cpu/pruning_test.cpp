// Cells' tapes against the whole one: the same floats to the bit; far cells' numbers: bounds from
// below. And that cells leave out what they can.
#include "scenes.h"

#include "backend-cpu/prune/pack.h"
#include "backend-cpu/prune/pruning.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <thread>

using namespace fathom::cpu;
using namespace fathom::cpu::test;

namespace {

constexpr std::size_t many = 6000;

struct Answers {
    std::size_t differ = 0, above = 0, far = 0;
    double kernels = 0;      // a point in a cell with a tape
    std::uint64_t bytes = 0; // of the cells
};

// Points in and round the cube -2..2, half of them near the surface.
Points some_points(const Program &program) {
    Points all = spread(many), near;
    std::vector<std::vector<float>> results(program.results.size(), std::vector<float>(many));
    std::vector<float *> to;
    for (std::vector<float> &result : results) to.push_back(result.data());
    const float *in[] = {all.x.data(), all.y.data(), all.z.data()};
    Scratch scratch = make_scratch(program, {});
    evaluate(program, scratch, in, to.data(), many);
    const std::vector<float> &d = results[0];
    for (std::size_t i = 0; i < many; ++i)
        if (std::fabs(d[i]) < 0.15f) {
            near.x.push_back(all.x[i]), near.y.push_back(all.y[i]), near.z.push_back(all.z[i]);
        }
    for (std::size_t i = 0; i < many; ++i) {
        const float grow = i % 10 == 0 ? 1.2f : 1.0f; // some outside of the cube
        near.x.push_back(grow * all.x[i]), near.y.push_back(grow * all.y[i]);
        near.z.push_back(grow * all.z[i]);
    }
    return near;
}

Answers compare(const Program &program, PruneSettings settings, float limit) {
    const Inputs inputs;
    Pruning pruning(program, inputs, {{-2, -2, -2}, 4}, settings);
    CellEvaluator evaluator(pruning, inputs);
    const Points points = some_points(program);
    const std::size_t n = points.x.size(), results = program.results.size();
    const float *in[] = {points.x.data(), points.y.data(), points.z.data()};
    std::vector<std::vector<float>> whole(results, std::vector<float>(n)), pruned = whole;
    std::vector<float *> to, pruned_to;
    for (std::size_t c = 0; c < results; ++c)
        to.push_back(whole[c].data()), pruned_to.push_back(pruned[c].data());
    Scratch scratch = make_scratch(program, inputs);
    evaluate(program, scratch, in, to.data(), n);
    const std::vector<float> limits(n, limit);
    evaluate(pruning, evaluator, in, pruned_to.data(), n, limits.data());
    Answers answers;
    for (std::size_t k = 0; k < n; ++k) {
        bool same = true;
        for (std::size_t c = 0; c < results; ++c)
            same = same && std::bit_cast<Word>(whole[c][k]) == std::bit_cast<Word>(pruned[c][k]);
        if (same) continue;
        const bool bound = pruned[0][k] >= limit && pruned[0][k] <= whole[0][k];
        (pruned[0][k] > whole[0][k] ? answers.above : answers.differ) += bound ? 0 : 1;
        answers.far += bound;
    }
    answers.bytes = evaluator.tally.bytes;
    answers.kernels = evaluator.tally.kernels / static_cast<double>(evaluator.tally.near);
    return answers;
}

// Exact everywhere, and with bounds where they will do.
Answers check(const Program &program, PruneSettings settings = {}) {
    settings.enough = 2;
    const Answers exact = compare(program, settings, std::numeric_limits<float>::infinity());
    CHECK(exact.differ + exact.above == 0);
    CHECK(exact.far == 0);
    const Answers bounds = compare(program, settings, 0.01f);
    CHECK(bounds.differ + bounds.above == 0);
    settings.asked_often = 0, settings.long_to_run = 1;
    for (const float limit : {std::numeric_limits<float>::infinity(), 0.01f}) {
        const Answers finer = compare(program, settings, limit);
        CHECK(finer.differ + finer.above == 0);
    }
    return bounds;
}

struct Shell : Fields {
    // Balls on a sphere in no order, as a table.
    TableId table(int n) {
        fathom::ir::Table made{n, 4, {}};
        const Points at = spread(static_cast<std::size_t>(n));
        for (std::size_t i = 0; i < at.x.size(); ++i) {
            const float l = std::sqrt(at.x[i] * at.x[i] + at.y[i] * at.y[i] + at.z[i] * at.z[i]);
            made.data.insert(made.data.end(), {1.3f * at.x[i] / l, 1.3f * at.y[i] / l,
                                               1.3f * at.z[i] / l, 0.04f + 0.03f * (at.x[i] > 0)});
        }
        return g.add_table(made);
    }
    NodeId row_ball(TableId id, NodeId index) {
        return g.sub(
            length(g.sub(p, g.make(Op::TableRead, Type::Vec3, {index}, table_slot(id, 0)))),
            g.make(Op::TableRead, Type::Float, {index}, table_slot(id, 3)));
    }
    template <class F> NodeId loop(int n, NodeId start, F next) {
        fathom::ir::Loop record;
        record.count = g.integer(n);
        record.max_count = n;
        record.index = g.fresh_var(Type::Int);
        const NodeId var = g.fresh_var(g.type(start));
        record.vars = {var};
        record.next = {next(var, record.index)};
        return g.make(Op::Loop, g.type(start), {start}, g.add_loop(record).index);
    }
    NodeId blended(Profile profile, double k, NodeId a, NodeId b) {
        return g.make(Op::Blend, Type::Float, {g.number(k), g.number(3), a, b},
                      static_cast<std::uint32_t>(profile));
    }
};

constexpr Profile profiles[] = {Profile::Smooth, Profile::Round, Profile::Chamfer, Profile::Stairs,
                                Profile::Columns};

} // namespace

TEST_CASE("a loop over a table keeps in a cell the rows that can matter") {
    Shell f;
    const TableId rows = f.table(400);
    const NodeId d = f.loop(400, f.g.number(1e9), [&](NodeId best, NodeId i) {
        return f.g.make(Op::Union, {best, f.row_ball(rows, i)});
    });
    const Answers answers = check(compile(f.scene, f.function(d), Choices::Apart));
    CHECK(answers.far > many / 4);
    CHECK(answers.kernels < 60); // of 1200
}

TEST_CASE("a blend of a table's rows is the same to the bit where rows are left out") {
    for (Profile profile : profiles) {
        Shell f;
        const TableId rows = f.table(300);
        const NodeId d = f.loop(300, f.g.number(1e9), [&](NodeId best, NodeId i) {
            return f.blended(profile, 0.08, best, f.row_ball(rows, i));
        });
        INFO(static_cast<int>(profile));
        const Answers answers = check(compile(f.scene, f.function(d), Choices::Apart));
        if (profile != Profile::Columns) CHECK(answers.kernels < 300); // of 1200
    }
}

// Each row is blended with what the rows before it left: in the order of a spiral (Fibonacci's),
// where each is a neighbour of some that came shortly before, and in no order.
TEST_CASE("of long chains of blends a part is left, and the same bits") {
    for (const bool in_order : {true, false}) {
        constexpr int n = 610;
        Shell f;
        fathom::ir::Table rows{n, 4, {}};
        for (int i = 0; i < n; ++i) {
            const double j = in_order ? i : i * 377 % n, y = 1 - (2 * j + 1) / n,
                         ring = std::sqrt(1 - y * y), angle = 2.39996323 * j;
            for (double x :
                 {1.3 * ring * std::cos(angle), 1.3 * y, 1.3 * ring * std::sin(angle), 0.05})
                rows.data.push_back(static_cast<float>(x));
        }
        const TableId table = f.g.add_table(rows);
        for (Profile profile : {Profile::Smooth, Profile::Round, Profile::Chamfer}) {
            const NodeId d = f.loop(n, f.g.number(1e9), [&](NodeId best, NodeId i) {
                return f.blended(profile, 0.03, best, f.row_ball(table, i));
            });
            const Program program = compile(f.scene, f.function(d), Choices::Apart);
            INFO(static_cast<int>(profile) << (in_order ? " in order" : ""));
            CHECK(check(program, {}).kernels < (in_order ? 600 : 200)); // of 1,830
        }
    }
}

TEST_CASE("operands that cannot matter are not computed") {
    for (int how = 0; how < 8; ++how) {
        Shell f;
        const Points at = spread(200);
        std::vector<NodeId> balls;
        for (std::size_t i = 0; i < 200; ++i)
            balls.push_back(f.ball(0.8 * at.x[i], 0.8 * at.y[i], 0.8 * at.z[i], 0.15));
        NodeId d;
        if (how < 5) {
            std::vector<NodeId> args{f.g.number(0.1), f.g.number(3)};
            args.insert(args.end(), balls.begin(), balls.end());
            d = f.g.make(Op::Blend, Type::Float, args, static_cast<std::uint32_t>(profiles[how]));
        } else {
            d = f.g.make(Op::Union, Type::Float, balls);
        }
        if (how == 6) // what is outside of it, and within a ball
            d = f.g.make(Op::Intersection, {f.g.neg(d), f.ball(0, 0, 0, 1.8)});
        if (how == 7) { // an exclusive or
            const NodeId b = f.ball(0.2, 0.1, 0, 1);
            d = f.g.make(Op::Intersection, {f.g.make(Op::Union, {d, b}),
                                            f.g.neg(f.g.make(Op::Intersection, {d, b}))});
        }
        INFO(how);
        const Answers answers = check(compile(f.scene, f.function(d), Choices::Apart));
        if (how != 4) CHECK(answers.kernels < 200); // of some 600
    }
}

TEST_CASE("a tape that is packed has no copies of what won, and gives the same bits") {
    // a union of balls, each less another and some joined by rows of a table
    Shell f;
    const Points at = spread(120);
    NodeId d = f.ball(0, 0, 0, 0.3);
    for (std::size_t i = 0; i < 120; ++i) {
        const NodeId ball = f.ball(at.x[i], at.y[i], at.z[i], 0.5),
                     other = f.ball(at.y[i], at.z[i], at.x[i], 0.4);
        d = f.g.make(Op::Union, {d, f.g.make(Op::Intersection, {ball, f.g.neg(other)})});
    }
    const TableId rows = f.table(40);
    const NodeId joined = f.loop(40, d, [&](NodeId best, NodeId i) {
        return f.g.make(Op::Union, {best, f.row_ball(rows, i)});
    });
    std::size_t before = 0, after = 0;
    for (const NodeId field : {d, joined, f.g.make(Op::Max, {f.ball(0, 0, 0, 1), joined})}) {
        const Program program = compile(f.scene, f.function(field), Choices::Apart);
        const PruneProgram parts = prune_program_of(program, {});
        const ShortTape whole = whole_tape(parts);
        Shortener shortener(parts);
        Scratch scratch = make_scratch(program, {});
        Packer packer(parts);
        Boxes boxes;
        boxes.count = max_boxes;
        for (std::size_t k = 0; k < max_boxes; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                boxes.lo[axis][k] = static_cast<float>(k >> 2 * axis & 3) - 2;
                boxes.hi[axis][k] = boxes.lo[axis][k] + 1;
            }
        run_over(parts, shortener, whole.selection(parts), boxes);
        std::vector<ShortTape> tapes(max_boxes);
        shorten(parts, shortener, whole.selection(parts), ~std::uint64_t{0}, 0, tapes);
        for (std::size_t k = 0; k < max_boxes; ++k) {
            const ShortTape &tape = tapes[k];
            std::vector<Step> steps;
            std::vector<std::uint32_t> operands;
            packer.pack(tape, steps, operands);
            const auto copies = [](const Step &step) {
                return step.kind == StepKind::Run &&
                       kernel_of_variant(step.target) == Kernel::CopyF;
            };
            if (field == d) { // loops hold registers
                for (const std::uint32_t id : tape.steps) before += copies(parts.table[id]);
                after += static_cast<std::size_t>(std::ranges::count_if(steps, copies));
            }
            constexpr std::size_t n = 48;
            float in[3][n], out[2][n];
            for (std::size_t i = 0; i < n; ++i) {
                in[0][i] = boxes.lo[0][k] + (at.x[i] + 2) / 4;
                in[1][i] = boxes.lo[1][k] + (at.y[i] + 2) / 4;
                in[2][i] = boxes.lo[2][k] + (at.z[i] + 2) / 4;
            }
            const float *from[] = {in[0], in[1], in[2]};
            Selection selection = tape.selection(parts);
            float *plain[] = {out[0]}, *packed[] = {out[1]};
            std::uint32_t unknown[n];
            evaluate(program, scratch, from, plain, n, selection, unknown);
            selection.packed = steps;
            selection.packed_operands = operands.data();
            evaluate(program, scratch, from, packed, n, selection, unknown);
            CHECK(std::memcmp(out[0], out[1], sizeof out[0]) == 0);
        }
    }
    INFO(before << " copies, " << after << " packed");
    // A chain stands in one register: copies are left where the new part wins.
    CHECK(before > 0);
    CHECK(after < before);
}

TEST_CASE("of a field of very many parts cells keep few bytes for each, and the same bits") {
    Fields f; // one ball behind the other: most cells leave none out
    NodeId least = f.ball(0, 0, 0, 1);
    for (int i = 1; i < 400; ++i)
        least = f.g.make(Op::Min, {least, f.ball(1e-4 * i, -1e-4 * i, 2e-4 * (i % 7), 1)});
    const Program program = compile(f.scene, f.function(least), Choices::Apart);
    PruneSettings settings;
    settings.depth = 2;
    const Answers usual = check(program, settings);
    settings.long_tape = 100;
    const Answers less = check(program, settings);
    CHECK(less.bytes < usual.bytes / 4);
    INFO(usual.bytes << " bytes, " << less.bytes);
    // and one that cells do take apart
    Fields far;
    least = far.ball(0, 0, 0, 0.1);
    for (int i = 1; i < 400; ++i)
        least = far.g.make(Op::Min, {least, far.ball(std::sin(i) * 1.8, std::sin(2 * i) * 1.8,
                                                     std::sin(3 * i) * 1.8, 0.1)});
    const Program apart = compile(far.scene, far.function(least), Choices::Apart);
    CHECK(check(apart, settings).kernels < 200);
}

TEST_CASE("the nearest hit of a table's rows, with its paint, keeps the rows that can be it") {
    Shell f;
    const TableId rows = f.table(300);
    const auto hit = [&](NodeId d, NodeId paint) {
        return f.g.make(Op::MakeHit, Type::Hit,
                        {d, paint, f.p, f.g.make(Op::Splat, Type::Vec4, {d})});
    };
    const NodeId start = hit(f.g.number(1e9), f.g.integer(-1));
    const NodeId d = f.loop(300, start, [&](NodeId best, NodeId i) {
        return f.g.make(Op::NearestHit, Type::Hit, {best, hit(f.row_ball(rows, i), i)});
    });
    PruneSettings settings;
    settings.far_cells = false;
    const Answers answers = check(compile(f.scene, f.function(d), Choices::Apart), settings);
    CHECK(answers.kernels < 300); // of 300 * 14
}

TEST_CASE("what an iteration makes of all before it is no row of a table") {
    Shell f;
    const TableId rows = f.table(50);
    // Each ball is grown by what was found so far: order is all.
    const NodeId d = f.loop(50, f.g.number(0.3), [&](NodeId best, NodeId i) {
        return f.g.make(Op::Union,
                        {best, f.g.add(f.row_ball(rows, i), f.g.mul(best, f.g.number(0.1)))});
    });
    check(compile(f.scene, f.function(d), Choices::Apart));
    // A maximum that begins high, a minimum that begins low.
    const NodeId maximum = f.loop(50, f.g.number(1), [&](NodeId best, NodeId i) {
        return f.g.make(Op::Max, {best, f.row_ball(rows, i)});
    });
    check(compile(f.scene, f.function(maximum), Choices::Apart));
    // A choice that nobody ordered: the last row that is near.
    const NodeId last = f.loop(50, f.g.number(0.5), [&](NodeId best, NodeId i) {
        const NodeId ball = f.row_ball(rows, i);
        return f.g.make(Op::Select, {f.g.make(Op::Less, {ball, f.g.number(0.4)}), ball, best});
    });
    check(compile(f.scene, f.function(last), Choices::Apart));
}

TEST_CASE("threads that evaluate at once find the same cells") {
    Shell f;
    const TableId rows = f.table(400);
    const NodeId d = f.loop(400, f.g.number(1e9), [&](NodeId best, NodeId i) {
        return f.g.make(Op::Union, {best, f.row_ball(rows, i)});
    });
    const Program program = compile(f.scene, f.function(d), Choices::Apart);
    const Inputs inputs;
    Pruning pruning(program, inputs, {{-2, -2, -2}, 4}, {});
    const Points points = spread(many);
    std::vector<std::vector<float>> out(4, std::vector<float>(many));
    std::vector<std::thread> threads;
    for (std::vector<float> &mine : out)
        threads.emplace_back([&] {
            CellEvaluator evaluator(pruning, inputs);
            const float *in[] = {points.x.data(), points.y.data(), points.z.data()};
            float *to[] = {mine.data()};
            const std::vector<float> limits(many, 0);
            evaluate(pruning, evaluator, in, to, many, limits.data());
        });
    for (std::thread &thread : threads) thread.join();
    for (const std::vector<float> &other : out) CHECK(other == out[0]);
}
