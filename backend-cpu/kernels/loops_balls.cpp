// Rows of balls, compiled once for every instruction set (CMakeLists.txt, FATHOM_ISA).
#include "backend-cpu/kernels/ball_rows.h"
#include "backend-cpu/kernels/loops.h"

namespace fathom::cpu::FATHOM_ISA {

namespace {

constexpr std::size_t at_once = 4; // rows
constexpr std::size_t numbers = 4; // of a row

template <std::size_t n, class Join>
[[gnu::always_inline]] inline void pass(const BallPoints &points, const float *rows, Join join) {
    Word *carried = points.carried;
    const Word *x = points.x, *y = points.y, *z = points.z;
    float row[n * numbers];
    for (std::size_t i = 0; i < n * numbers; ++i) row[i] = rows[i];
    const std::size_t count = points.count;
    FATHOM_INDEPENDENT
    for (std::size_t k = 0; k < count; ++k) {
        float a = load<float>(carried[k]);
        for (std::size_t i = 0; i < n; ++i)
            a = join(a, load<float>(x[k]), load<float>(y[k]), load<float>(z[k]), row[i * numbers],
                     row[i * numbers + 1], row[i * numbers + 2], row[i * numbers + 3]);
        store(carried[k], a);
    }
}

template <class Join> [[gnu::always_inline]] inline void
all_passes(const BallPoints &points, const float *rows, std::size_t count, Join join) {
    std::size_t i = 0;
    for (; i + at_once <= count; i += at_once) pass<at_once>(points, rows + i * numbers, join);
    for (; i < count; ++i) pass<1>(points, rows + i * numbers, join);
}

[[gnu::flatten]] void minimum(const BallPoints &points, const float *rows, std::size_t count) {
    all_passes(points, rows, count,
               [](float a, float x, float y, float z, float cx, float cy, float cz, float r) {
                   return MinBallRow<float>::run(a, x, y, z, cx, cy, cz, r);
               });
}
[[gnu::flatten]] void smooth(const BallPoints &points, const float *rows, std::size_t count,
                             float k) {
    all_passes(points, rows, count,
               [k](float a, float x, float y, float z, float cx, float cy, float cz, float r) {
                   return SmoothBallRow<float>::run(a, x, y, z, cx, cy, cz, r, k);
               });
}

template <std::size_t n> [[gnu::always_inline]] inline void
pass_dropping(const BallPoints &points, const float *rows, float k, float *drop) {
    Word *carried = points.carried;
    const Word *x = points.x, *y = points.y, *z = points.z;
    float row[n * numbers];
    for (std::size_t i = 0; i < n * numbers; ++i) row[i] = rows[i];
    const std::size_t count = points.count;
    FATHOM_INDEPENDENT
    for (std::size_t p = 0; p < count; ++p) {
        float a = load<float>(carried[p]), maximum = drop[p];
        for (std::size_t i = 0; i < n; ++i) {
            const float b = BallRow<float>::run(
                load<float>(x[p]), load<float>(y[p]), load<float>(z[p]), row[i * numbers],
                row[i * numbers + 1], row[i * numbers + 2], row[i * numbers + 3]);
            maximum = maximum < a - b ? a - b : maximum;
            a = BlendSmoothRow<float>::run(a, b, k);
        }
        store(carried[p], a);
        drop[p] = maximum;
    }
}
[[gnu::flatten]] void smooth_dropping(const BallPoints &points, const float *rows,
                                      std::size_t count, float k, float *drop) {
    std::size_t i = 0;
    for (; i + at_once <= count; i += at_once)
        pass_dropping<at_once>(points, rows + i * numbers, k, drop);
    for (; i < count; ++i) pass_dropping<1>(points, rows + i * numbers, k, drop);
}

} // namespace

BallLoops ball_loops();
BallLoops ball_loops() { return {minimum, smooth, smooth_dropping}; }

} // namespace fathom::cpu::FATHOM_ISA
