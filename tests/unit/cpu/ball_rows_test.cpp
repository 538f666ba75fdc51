// Rows of balls in packs against the kernels row by row, in every instruction set: the same bits.
#include "scenes.h"

#include "backend-cpu/ball_rows.h"
#include "backend-cpu/kernels.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>

using namespace fathom::cpu;
using namespace fathom::cpu::test;

TEST_CASE("rows of balls in packs are the kernels' rows to the bit") {
    const auto sets = point_loop_sets();
    const auto packs = ball_loop_sets();
    REQUIRE(sets.size() == packs.size());
    constexpr std::uint32_t n = 48; // points
    const Points points = spread(n), centres = spread(23);
    for (std::size_t set = 0; set < sets.size(); ++set)
        for (const bool smooth : {false, true})
            for (std::uint32_t count = 0; count <= 23; ++count)
                for (const float k : {0.0f, 0.3f}) {
                    // cx cy cz r k, then the carried number and x, y, z of the points
                    std::vector<Word> cells(64 + 4 * n);
                    std::vector<float> rows;
                    for (std::uint32_t i = 0; i < n; ++i) {
                        cells[64 + i] = std::bit_cast<Word>(1e9f);
                        cells[64 + n + i] = std::bit_cast<Word>(points.x[i]);
                        cells[64 + 2 * n + i] = std::bit_cast<Word>(points.y[i]);
                        cells[64 + 3 * n + i] = std::bit_cast<Word>(points.z[i]);
                    }
                    cells[4] = std::bit_cast<Word>(k);
                    std::vector<Word> packed = cells;
                    const std::vector<Word> start = cells;
                    const std::uint32_t operands[] = {64, 64, 64 + n, 64 + 2 * n, 64 + 3 * n,
                                                      0,  1,  2,      3,          4};
                    const Kernel kernel = smooth ? Kernel::SmoothBall : Kernel::MinBall;
                    const Variant variant = best_variant(kernel, smooth ? 0b111110000 : 0b11110000);
                    for (std::uint32_t row = 0; row < count; ++row) {
                        const float numbers[] = {centres.x[row], centres.y[row], centres.z[row],
                                                 0.1f + 0.02f * float(row)};
                        for (std::size_t c = 0; c < 4; ++c)
                            cells[c] = std::bit_cast<Word>(numbers[c]);
                        rows.insert(rows.end(), numbers, numbers + 4);
                        sets[set].loops[variant.index](cells.data(), operands, n);
                    }
                    const Word *at = packed.data() + 64;
                    const BallPoints place{packed.data() + 64, at + n, at + 2 * n, at + 3 * n, n};
                    if (smooth)
                        packs[set].smooth(place, rows.data(), count, k);
                    else
                        packs[set].least(place, rows.data(), count);
                    CHECK(std::equal(cells.begin() + 64, cells.end(), packed.begin() + 64));
                    if (!smooth) continue;
                    // and by how much a row was less than what was there
                    std::vector<float> drop(n, -1e9f), most = drop;
                    std::copy(start.begin(), start.end(), packed.begin());
                    packs[set].smooth_dropping(place, rows.data(), count, k, drop.data());
                    CHECK(std::equal(cells.begin() + 64, cells.end(), packed.begin() + 64));
                    std::copy(start.begin(), start.end(), packed.begin());
                    for (std::uint32_t row = 0; row < count; ++row) {
                        const float *r = rows.data() + 4 * row;
                        for (std::uint32_t i = 0; i < n; ++i) {
                            const float x = points.x[i] - r[0], y = points.y[i] - r[1],
                                        z = points.z[i] - r[2];
                            const float b = std::sqrt(x * x + y * y + z * z) - r[3];
                            most[i] = std::max(most[i], std::bit_cast<float>(packed[64 + i]) - b);
                        }
                        packs[set].smooth(place, r, 1, k);
                    }
                    CHECK(drop == most);
                }
}

TEST_CASE("only loops whose turns are a ball's joining are run in packs") {
    for (int how = 0; how < 4; ++how) {
        Fields f;
        fathom::ir::Table rows{5, 4, {}};
        for (int i = 0; i < 20; ++i) rows.data.push_back(0.1f * static_cast<float>(i));
        const TableId table = f.g.add_table(rows);
        Fold fold;
        fold.count = f.g.integer(5);
        fold.max_count = 5;
        fold.index = f.g.fresh_var(Type::Int);
        const NodeId best = f.g.fresh_var(Type::Float);
        fold.vars = {best};
        const auto column = [&](Type type, int first) {
            return f.g.make(Op::TableRead, type, {fold.index}, table_slot(table, first));
        };
        const NodeId from = how == 2 ? f.g.mul(f.p, f.g.number(2)) : f.p; // a place of its own
        NodeId ball =
            f.g.sub(f.length(f.g.sub(from, column(Type::Vec3, 0))), column(Type::Float, 3));
        if (how == 3) ball = f.g.add(ball, f.g.mul(best, f.g.number(0.1)));
        fold.next = {f.g.make(how == 1 ? Op::Intersection : Op::Union, {best, ball})};
        const NodeId d =
            f.g.make(Op::Fold, Type::Float, {f.g.number(1e9)}, f.g.add_fold(fold).index);
        const Program program = compile(f.scene, f.function(d));
        INFO(how);
        CHECK((program.ball_loops.size() == 1) == (how == 0 || how == 2));
        const Points points = spread(500);
        const std::vector<float> values_of = values(program, points);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < 500; ++i) {
            double expected = 1e9;
            const double s = how == 2 ? 2 : 1;
            for (std::size_t row = 0; row < 5; ++row) {
                const float *c = rows.data.data() + 4 * row;
                double b = std::hypot(s * points.x[i] - c[0], s * points.y[i] - c[1],
                                      s * points.z[i] - c[2]) -
                           c[3];
                if (how == 3) b += 0.1 * expected;
                expected = how == 1 ? std::max(expected, b) : std::min(expected, b);
            }
            wrong += std::fabs(values_of[i] - expected) > 1e-5 * (1 + std::fabs(expected));
        }
        CHECK(wrong == 0);
    }
}
