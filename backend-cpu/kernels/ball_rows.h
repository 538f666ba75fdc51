// Many rows of a table at once, where each is a ball that joins what a loop carries: the commonest
// loop there is. The numbers of a row stay in registers for some points, those of the points for
// some rows. The same floats, to the bit, as the kernels MinBall and SmoothBall row by row.
#pragma once

#include "backend-cpu/tape.h"

namespace fathom::cpu {

// Points' x, y, z and what is carried, a multiple of 16; rows of 4 numbers: the centre, the radius.
struct BallPoints {
    Word *carried = nullptr; // floats' bits, as all cells
    const Word *x = nullptr, *y = nullptr, *z = nullptr;
    std::size_t count = 0;
};
struct BallLoops {
    void (*minimum)(const BallPoints &points, const float *rows, std::size_t count);
    void (*smooth)(const BallPoints &points, const float *rows, std::size_t count, float k);
    // And by how much a row was less than what was carried, at most, if it is more than `drop`.
    void (*smooth_dropping)(const BallPoints &points, const float *rows, std::size_t count, float k,
                            float *drop) = nullptr;
};
BallLoops ball_loops();                  // the fastest that this processor runs
std::vector<BallLoops> ball_loop_sets(); // in the order of point_loop_sets

// Which loops of a finished program are such: fills Loop::balls and Program::ball_loops.
void find_ball_loops(Program &program);

} // namespace fathom::cpu
