// Rows of balls in packs against the kernels row by row, in every instruction set: the same bits.
#include "scenes.h"

#include "backend-cpu/kernels/ball_rows.h"
#include "backend-cpu/kernels/kernels.h"

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
                        packs[set].minimum(place, rows.data(), count);
                    CHECK(std::equal(cells.begin() + 64, cells.end(), packed.begin() + 64));
                    if (!smooth) continue;
                    // and by how much a row was less than what was there
                    std::vector<float> drop(n, -1e9f), maximum = drop;
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
                            maximum[i] =
                                std::max(maximum[i], std::bit_cast<float>(packed[64 + i]) - b);
                        }
                        packs[set].smooth(place, r, 1, k);
                    }
                    CHECK(drop == maximum);
                }
}

TEST_CASE("only loops whose iterations are a ball's joining are run in packs") {
    for (int how = 0; how < 4; ++how) {
        Fields f;
        fathom::ir::Table rows{5, 4, {}};
        for (int i = 0; i < 20; ++i) rows.data.push_back(0.1f * static_cast<float>(i));
        const TableId table = f.g.add_table(rows);
        fathom::ir::Loop record;
        record.count = f.g.integer(5);
        record.max_count = 5;
        record.index = f.g.fresh_var(Type::Int);
        const NodeId best = f.g.fresh_var(Type::Float);
        record.vars = {best};
        const auto column = [&](Type type, int first) {
            return f.g.make(Op::TableRead, type, {record.index}, table_slot(table, first));
        };
        const NodeId from = how == 2 ? f.g.mul(f.p, f.g.number(2)) : f.p; // a place of its own
        NodeId ball =
            f.g.sub(f.length(f.g.sub(from, column(Type::Vec3, 0))), column(Type::Float, 3));
        if (how == 3) ball = f.g.add(ball, f.g.mul(best, f.g.number(0.1)));
        record.next = {f.g.make(how == 1 ? Op::Intersection : Op::Union, {best, ball})};
        const NodeId d =
            f.g.make(Op::Loop, Type::Float, {f.g.number(1e9)}, f.g.add_loop(record).index);
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

// The rows of balls over boxes against the range loops of the kernels row by row, in every
// instruction set: the same ranges, and what the coarse test leaves out changes nothing.
TEST_CASE("rows of balls over boxes are the kernels' ranges") {
    constexpr std::uint32_t n = 64, count = 40;
    const Points corners = spread(n), centres = spread(count);
    for (const RangeLoops &loops : range_loop_sets())
        for (const bool smooth : {false, true})
            for (const float begin : {1e9f, 0.4f, -0.3f}) {
                // cx cy cz r k, then the carried number, x, y, z, a ball
                std::vector<float> lo(5 + 5 * n), hi(5 + 5 * n), rows;
                for (std::uint32_t i = 0; i < n; ++i) {
                    const float width = i % 8 == 0 ? 1.0f : 0.05f;
                    lo[5 + i] = hi[5 + i] = begin;
                    const float at[] = {corners.x[i], corners.y[i], corners.z[i]};
                    for (std::uint32_t axis = 0; axis < 3; ++axis) {
                        lo[5 + (1 + axis) * n + i] = at[axis];
                        hi[5 + (1 + axis) * n + i] = at[axis] + width;
                    }
                }
                const float k = 0.2f;
                lo[4] = hi[4] = k;
                std::vector<float> carried_lo(n, begin), carried_hi(n, begin), lows(n * count);
                std::vector<std::uint32_t> which;
                for (std::uint32_t row = 0; row < count; ++row) {
                    which.push_back(row);
                    rows.insert(rows.end(), {centres.x[row], centres.y[row], centres.z[row],
                                             0.1f + 0.01f * static_cast<float>(row)});
                }
                std::vector<std::uint64_t> neutral(count), renewed(count);
                BallRangeRows in{};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    in.lo[axis] = lo.data() + 5 + (1 + axis) * n;
                    in.hi[axis] = hi.data() + 5 + (1 + axis) * n;
                }
                in.carried_lo = carried_lo.data(), in.carried_hi = carried_hi.data();
                in.numbers = rows.data(), in.rows = which.data();
                in.count = count, in.boxes = n, in.smooth = smooth;
                if (smooth) in.k_lo = in.k_hi = k;
                loops.balls(in, {neutral.data(), renewed.data(), 1, lows.data()});

                const RangeCells cells{lo.data(), hi.data()};
                const std::uint32_t ball[] = {5 + 4 * n, 5 + n, 5 + 2 * n, 5 + 3 * n, 0, 1, 2, 3},
                                    join[] = {5, 5, 5 + 4 * n, 4};
                const auto ball_loop = best_variant(Kernel::Ball, 0b1111000).index,
                           join_loop = best_variant(smooth ? Kernel::BlendSmooth : Kernel::MinF,
                                                    smooth ? 0b100 : 0)
                                           .index;
                const float margin = smooth ? k : 0;
                int wrong = 0, skipped = 0;
                for (std::uint32_t row = 0; row < count; ++row) {
                    std::copy_n(rows.begin() + 4 * row, 4, lo.begin());
                    std::copy_n(rows.begin() + 4 * row, 4, hi.begin());
                    loops.loops[ball_loop](cells, ball, n);
                    const auto same = loops.below(hi.data() + 5, false, lo.data() + ball[0], false,
                                                  &margin, true, n),
                               fresh = loops.below(hi.data() + ball[0], false, lo.data() + 5, false,
                                                   &margin, true, n);
                    wrong += same != neutral[row] || fresh != renewed[row];
                    skipped += same == ~std::uint64_t{0};
                    for (std::uint32_t i = 0; i < n; ++i)
                        wrong += (same >> i & 1) == 0 && lows[row * n + i] != lo[ball[0] + i];
                    loops.loops[join_loop](cells, join, n);
                }
                CHECK(wrong == 0);
                CHECK((skipped > 0) == (begin < 0));
                CHECK(std::equal(carried_lo.begin(), carried_lo.end(), lo.begin() + 5));
                CHECK(std::equal(carried_hi.begin(), carried_hi.end(), hi.begin() + 5));
            }
}
