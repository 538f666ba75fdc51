#include "mesh/walk.h"

#include "mesh/seams.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int most_halvings = 6;
constexpr std::size_t sampled = 256; // leaves whose tapes say what dividing takes

double diagonal(const Block &part) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) squares += std::pow(double(part.hi[i]) - part.lo[i], 2);
    return std::sqrt(squares);
}

// What is known of the field in a box.
struct Known {
    std::optional<Linear> linear; // it, or what has its sign there, all but linear
    std::optional<Slant> slant;   // of that
    Zeros zeros;                  // where there is no slant, or a poor one
};

// A surface that all but follows the direction that it is a graph along: its sheets tell more, or
// nothing does.
constexpr double poor = 4, useless = 100;
constexpr double across_edge = 1.05; // more than that where it has an edge

void flatten(Linear &linear) { linear.slope[2] = linear.spread[2] = 0; }

// `fully`: with slant and zeros.
Known known_in(Splitter &splitter, const cpu::ShortTape &tape, const Block &block, const Walk &walk,
               bool fully) {
    Evaluator &evaluator = splitter.evaluator;
    cpu::Boxes &boxes = splitter.boxes;
    Known known;
    if (!splitter.by_zeros) known.linear = linear_over(evaluator, tape, boxes, block.lo, block.hi);
    if (known.linear && walk.flat) flatten(*known.linear);
    if (known.linear && fully)
        known.slant = slant_in(evaluator, tape, boxes, block.lo, block.hi, *known.linear);
    const bool jumps = known.linear && known.linear->jumps;
    if (known.slant ? known.slant->most < (jumps ? across_edge : poor)
                    : known.linear && !fully && is_steady(*known.linear))
        return known;
    Border border = border_over(evaluator, tape, boxes, block.lo, block.hi);
    known.zeros = std::move(border.zeros);
    if (walk.flat) std::ranges::for_each(known.zeros.sheets, flatten);
    if (jumps && known.slant && border.like) {
        const std::optional<Slant> other = slant_of(*border.like);
        if (other && other->most < known.slant->most)
            known.linear = border.like, known.slant = other;
    }
    if (known.slant && known.slant->most < poor) {
        known.zeros = {};
        return known;
    }
    if (known.slant) {
        if (known.zeros.known || known.slant->most > useless) known.slant.reset();
        return known;
    }
    known.linear = border.like ? border.like : border.linear;
    if (walk.flat && known.linear) flatten(*known.linear);
    if (border.like || (known.linear && fully)) known.slant = slant_of(*known.linear);
    // Not of several sheets at an angle, each of which tells more.
    const double most = known.zeros.known ? across_edge : useless;
    if (known.slant && !border.like && known.slant->most > most) known.slant.reset();
    return known;
}

// What an open box adds: by a plane, if its field is all but linear in it.
void add_open(const Block &piece, const std::optional<Linear> &linear, const Real3 &middle,
              CellSums &sums) {
    if (!linear) return sums.add(piece.lo, piece.hi, Space::Open, middle);
    const Enclosure share = share_of(piece.lo, piece.hi, *linear);
    sums.add_part(piece.lo, piece.hi, share.lo, share.hi, middle);
}

// Boxes that lie across an edge of the surface, or about a place where none of its directions is
// known, are divided so often more.
constexpr int for_edges = 2, for_places = 5;

void add_area(const Enclosure &area, CellSums &sums) {
    sums.least_area += area.lo, sums.most_area += area.hi;
}

// What an open box adds that is divided so often. `linear`: of the box.
void walk_graph(Splitter &splitter, const cpu::ShortTape &tape, const Block &piece,
                const std::optional<Linear> &linear, const Slant &slant, int levels,
                const Walk &walk, CellSums &sums) {
    Graph graph{piece.lo, piece.hi, {}};
    std::vector<Block> open{piece};
    for (int level = 0; level < levels && !open.empty(); ++level)
        open = divided(splitter, tape, open, walk, sums, &graph);
    for (const Block &part : open) {
        const std::optional<Linear> of =
            levels == 0 ? linear : known_in(splitter, tape, part, walk, false).linear;
        add_open(part, of, walk.middle, sums);
        graph.add_open(part.lo, part.hi, of);
    }
    add_area(graph.area(slant), sums);
}

// What a look into a box takes of what is to spare: more where there are loops.
int price_of(const cpu::ShortTape &tape) {
    constexpr float of_one = 4; // kernels of loops
    const float in_loops = std::max(tape.cost - static_cast<float>(tape.steps.size()), 0.0f);
    return 1 + static_cast<int>(std::min(in_loops / of_one, 1e6f));
}

// The same of a box that is not known to hold a graph. `more`: so often it may be divided beyond
// `levels`, for the area's sake, while there are boxes to spare.
void walk_piece(Splitter &splitter, const cpu::ShortTape &tape, const Block &piece, int levels,
                int more, int &spare, const Walk &walk, CellSums &sums) {
    constexpr int of_seam = 8; // a search takes so many times what a box does, about
    constexpr double well = 1.02;
    const Known known = known_in(splitter, tape, piece, walk, true);
    const auto &[linear, slant, zeros] = known;
    const bool analysed = linear || zeros.known;
    const int price = price_of(tape);
    const bool last = levels <= 0 && (!analysed || spare < price ||
                                      more <= (slant || zeros.known ? for_places - for_edges : 0));
    if (slant && (slant->most < well || last || (levels <= 0 && slant->most < across_edge)))
        return walk_graph(splitter, tape, piece, linear, *slant, std::max(levels, 0), walk, sums);
    const bool asked = linear && !linear->jumps && !slant && spare >= price;
    if (asked) spare -= of_seam * price;
    const bool touches =
        asked && seam_in(splitter.evaluator, tape, splitter.boxes, piece.lo, piece.hi, walk.thin);
    const bool free = zeros.known && zeros.sheets.empty();
    if (touches || free || last) {
        add_open(piece, linear, walk.middle, sums);
        // The surface is part of what all sheets are together.
        for (const Linear &sheet : zeros.sheets)
            if (!touches) sums.most_area += area_of_sheet(piece.lo, piece.hi, sheet).hi;
        if (!touches && !zeros.known) sums.add_open_place(piece.lo, piece.hi);
        return;
    }
    if (levels <= 0) spare -= price;
    for (const Block &part : divided(splitter, tape, {piece}, walk, sums))
        walk_piece(splitter, tape, part, levels - 1, levels <= 0 ? more - 1 : more, spare, walk,
                   sums);
}

// What running the tapes of all open leaves takes, in kernels: by those of some.
double kernels_of(const Field &field, const std::vector<OpenBlock> &open) {
    if (open.empty()) return 0;
    Splitter splitter(field);
    const std::size_t step = std::max<std::size_t>(open.size() / sampled, 1);
    double cost = 0, count = 0;
    for (std::size_t k = 0; k < open.size(); k += step, ++count)
        cost += tape_in(splitter, open[k].tape, open[k].piece)->cost;
    return cost * static_cast<double>(open.size()) / count;
}

// How often open leaves are divided: as the work allows, by half of the parts of each that stay open,
// but a few times at least, so that smaller leaves say more, unless that takes more than `most`.
int levels_for(double kernels, bool flat, double work, int least, double most = unbounded) {
    double cost = 16 * kernels;
    int levels = 0;
    for (double all = cost; kernels > 0 && ((levels < least && all <= most) ||
                                            (levels < most_halvings && all <= work));
         all += cost) {
        ++levels;
        cost *= flat ? 2 : 4;
    }
    return levels;
}

// What an open leaf adds.
void walk_leaf(Splitter &splitter, const OpenBlock &leaf, const Walk &walk, CellSums &sums) {
    if (!walk.looks && walk.by_dividing == 0) { // as it is
        add_open(leaf.piece, {}, walk.middle, sums);
        return sums.add_open_place(leaf.piece.lo, leaf.piece.hi);
    }
    std::vector<Block> open{leaf.piece};
    const TapePtr tape = tape_in(splitter, leaf.tape, leaf.piece);
    int spare = walk.spare;
    splitter.by_zeros = false;
    splitter.evaluator.followed = walk.followed;
    const Known known = walk.looks ? known_in(splitter, *tape, leaf.piece, walk, false) : Known{};
    splitter.by_zeros = known.zeros.known;
    if (known.linear || known.zeros.known)
        return walk_piece(splitter, *tape, open[0], walk.by_planes, for_places, spare, walk, sums);
    for (int level = 0; level < walk.by_dividing && !open.empty(); ++level)
        open = divided(splitter, *tape, open, walk, sums);
    for (const Block &piece : open) {
        add_open(piece, {}, walk.middle, sums);
        sums.add_open_place(piece.lo, piece.hi);
    }
}

// a / b, b > 0.
Enclosure quotient(Enclosure a, Enclosure b) {
    return {a.lo / (a.lo < 0 ? b.lo : b.hi), a.hi / (a.hi < 0 ? b.hi : b.lo)};
}

} // namespace

std::vector<Block> divided(Splitter &splitter, const cpu::ShortTape &tape,
                           const std::vector<Block> &whole, const Walk &walk, CellSums &sums,
                           Graph *graph) {
    constexpr std::size_t at_once = cpu::max_boxes / 16;
    const std::size_t axes = walk.flat ? 2 : 3, count_of_parts = walk.flat ? 4 : 8;
    std::vector<Block> open, parts(8 * at_once);
    cpu::Boxes &boxes = splitter.boxes;
    for (std::size_t begin = 0; begin < whole.size(); begin += at_once) {
        const std::size_t count = std::min(at_once, whole.size() - begin);
        boxes.count = 16 * count;
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t k = 0; k < 8; ++k) {
                Block &part = parts[8 * j + k];
                part = whole[begin + j];
                for (std::size_t i = 0; i < 3; ++i) {
                    const float cut = 0.5f * (part.lo[i] + part.hi[i]);
                    if (i < axes) (k >> i & 1 ? part.lo : part.hi)[i] = cut;
                    boxes.lo[i][16 * j + k] = part.lo[i], boxes.hi[i][16 * j + k] = part.hi[i];
                    boxes.lo[i][16 * j + 8 + k] = boxes.hi[i][16 * j + 8 + k] =
                        0.5f * (part.lo[i] + part.hi[i]);
                }
            }
        ranges_over(splitter.evaluator, tape, boxes);
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t k = 0; k < count_of_parts; ++k) {
                const Block &part = parts[8 * j + k];
                const std::size_t box = 16 * j + k;
                const Space space =
                    space_of(splitter.evaluator, box, 0.5 * diagonal(part), walk.ulp, true);
                if (splitter.evaluator.ranges.result_hi[box + 8] < 0) {
                    Point at;
                    for (std::size_t i = 0; i < 3; ++i) at[i] = boxes.lo[i][box + 8];
                    sums.know(at, at);
                }
                if (space == Space::Open)
                    open.push_back(part);
                else
                    sums.add(part.lo, part.hi, space, walk.middle);
                if (space == Space::Inside && graph) graph->add_inside(part.lo, part.hi);
            }
    }
    return open;
}

TapePtr tape_in(Splitter &splitter, const TapePtr &tape, const Block &piece) {
    return tape_in(splitter.evaluator, splitter.boxes, tape, piece.lo, piece.hi);
}

CellSums sums_of_open(const Field &field, const std::vector<OpenBlock> &open, Walk walk,
                      unsigned threads, Progress &progress, const MeasureEffort &effort) {
    constexpr double of_planes = 16;        // a plane takes so many times what dividing does, about
    constexpr std::size_t most_spare = 512; // of a leaf
    constexpr double at_least = 0.5;        // of the work, for two levels
    const double kernels = kernels_of(field, open);
    walk.by_planes = levels_for(kernels, walk.flat, effort.work / of_planes, effort.least_halvings,
                                at_least * effort.work);
    walk.by_dividing = levels_for(kernels, walk.flat, effort.work, effort.least_halvings);
    walk.looks = kernels <= effort.looks;
    walk.followed = std::min(effort.in_loops / std::max(static_cast<double>(open.size()), 1.0),
                             static_cast<double>(longest_tape));
    walk.spare = static_cast<int>(std::clamp(effort.spare / std::max<std::size_t>(open.size(), 1),
                                             effort.least_spare, most_spare));
    constexpr std::size_t piece_of_work = 256; // leaves
    std::vector<CellSums> found((open.size() + piece_of_work - 1) / piece_of_work);
    in_parallel(
        found.size(), threads, progress, [&] { return Splitter(field); },
        [&](Splitter &splitter, std::size_t number) {
            const std::size_t end = std::min(open.size(), (number + 1) * piece_of_work);
            for (std::size_t k = number * piece_of_work; k < end; ++k)
                walk_leaf(splitter, open[k], walk, found[number]);
        });
    CellSums sums;
    for (const CellSums &some : found) sums.add(some);
    sums.looked = walk.looks || open.empty();
    return sums;
}

Measures measures_of(const CellSums &sums, const Real3 &middle) {
    Measures measures;
    measures.volume = {sums.inside * (1 - rounding_share),
                       (sums.inside + sums.open) * (1 + rounding_share)};
    measures.area = {sums.least_area * (1 - rounding_share),
                     sums.open_places > 0 ? unbounded : sums.most_area * (1 + rounding_share)};
    measures.open_places = sums.open_places;
    measures.open_place = sums.open_place;
    measures.looked = sums.looked;
    for (std::size_t i = 0; i < 3; ++i) {
        const double slack =
            rounding_share * (sums.sizes + std::fabs(middle[i]) * measures.volume.hi);
        const Enclosure way = quotient({sums.moment[i] + sums.least_moment[i] - slack,
                                        sums.moment[i] + sums.most_moment[i] + slack},
                                       measures.volume);
        // The centre lies in the solid's box, however little is known of its volume.
        measures.center[i] = {std::max(middle[i] + way.lo, sums.outer_lo[i]),
                              std::min(middle[i] + way.hi, sums.outer_hi[i])};
        measures.least[i] = {sums.outer_lo[i], sums.known_lo[i]};
        measures.greatest[i] = {sums.known_hi[i], sums.outer_hi[i]};
    }
    return measures;
}

} // namespace fathom::mesh
