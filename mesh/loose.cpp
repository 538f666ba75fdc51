#include "mesh/loose.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {

double shrunk_to_decide(const Field &field, const Lattice &lattice,
                        const std::vector<Cell> &cells) {
    constexpr std::size_t looks = 64;
    constexpr int halvings = 10;
    Evaluator evaluator(field);
    fathom::cpu::Boxes boxes;
    boxes.count = 16;
    std::vector<int> needed;
    for (std::size_t n = 0; n < std::min(looks, cells.size()); ++n) {
        const Cell &cell = cells[n * cells.size() / std::min(looks, cells.size())];
        const std::int32_t side = lattice.cells(cell.level);
        const Point lo = point_of(lattice, cell.at),
                    hi = point_of(lattice, corner(cell.at, side, 7));
        int level = 0;
        for (; level < halvings; ++level) {
            double squares = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const float middle = 0.5f * (lo[i] + hi[i]),
                            half = std::ldexp(0.5f * (hi[i] - lo[i]), -level);
                squares += double(half) * half;
                for (std::size_t k = 0; k < boxes.count; ++k) {
                    boxes.lo[i][k] = k < 8 ? middle - half : middle;
                    boxes.hi[i][k] = k < 8 ? middle + half : middle;
                }
            }
            ranges_over(evaluator, *field.whole, boxes);
            if (space_of(evaluator, 0, std::sqrt(squares), lattice.ulp, true, true) != Space::Open)
                break;
        }
        needed.push_back(level);
    }
    std::ranges::sort(needed);
    const int most = needed.empty() ? halvings : needed[3 * needed.size() / 4];
    return most < halvings ? std::ldexp(1.0, most) : 0;
}

} // namespace fathom::mesh
