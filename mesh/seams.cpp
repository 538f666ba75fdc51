#include "mesh/seams.h"

#include "mesh/slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::mesh {
namespace {

constexpr std::size_t cuts = 8;        // that a slab is cut into
constexpr std::size_t most_open = 3;   // at one time, but for guesses
constexpr int most_cuttings = 24;      // floats cannot tell more cuts of cuts apart
constexpr int end_cuttings = 3;        // … of what seems to reach the end of a box
constexpr std::size_t most_runs = 400; // of the tape, for one box
constexpr double most_thinnest =
    4; // slabs beside each other that are one plane: two lie at its ends
constexpr std::size_t most_ties = 12;       // of one number
constexpr std::size_t most_thin_slabs = 16; // thin ones, of a slab that ties tell no more about
constexpr int most_strips = 2;              // planes that meet the last one: three do in a corner

// A direction that a box may be cut across: an axis, or a number that changes over it.
struct Across {
    std::size_t axis = 3; // 3: a number
    Level level;
    std::vector<std::pair<Register, Tie>> ties{}; // others that change alike
    double play = 0; // between two floats so near what is tied says no more
};

// Part of a box that may be a seam: what lies between two ends across each of its directions.
struct Place {
    std::vector<std::array<float, 2>> ends; // by direction: the axes come first
};

struct Slab {
    std::size_t across = 0; // direction
    float lo = 0, hi = 0;
};

// What a tied number lies within, by box, from what the other one is held between.
std::vector<std::array<float, 2>> ranges_tied(const Tie &tie,
                                              const std::vector<std::array<float, 2>> &ranges) {
    constexpr float far = std::numeric_limits<float>::infinity();
    std::vector<std::array<float, 2>> tied;
    for (const auto &[lo, hi] : ranges) {
        const double a = tie.share * lo, b = tie.share * hi;
        tied.push_back({std::nextafter(static_cast<float>(std::min(a, b) + tie.lo), -far),
                        std::nextafter(static_cast<float>(std::max(a, b) + tie.hi), far)});
    }
    return tied;
}

// The places in a slab where planes are guessed are thin slabs of their own; what is left beside them.
void cut_out(const Slab &slab, const std::vector<float> &planes, double thin,
             std::vector<Slab> &to) {
    float from = slab.lo;
    const auto add = [&](float until) {
        if (!(from < until)) return;
        to.push_back({slab.across, from, until});
        from = until;
    };
    for (const float plane : planes) { // from the least
        const auto lo = static_cast<float>(plane - thin), hi = static_cast<float>(plane + thin);
        if (!(lo > from && hi < slab.hi)) continue;
        add(lo);
        add(hi);
    }
    add(slab.hi);
}

// Parts of a slab. Round planes, 0 above all, are where things are put: where it lies in the slab it
// is between two of them.
void cut_up(const Slab &slab, std::vector<Slab> &to) {
    float from = slab.lo;
    bool zero = slab.lo < 0 && slab.hi > 0;
    const auto add = [&](float until) {
        if (!(from < until)) return;
        to.push_back({slab.across, from, until});
        from = until;
    };
    for (std::size_t k = 1; k < cuts; ++k) {
        const double share = double(k) / cuts;
        const auto cut = static_cast<float>(slab.lo + share * (double(slab.hi) - slab.lo));
        if (zero && cut >= 0) add(0), zero = false;
        add(std::min(cut, slab.hi));
    }
    if (zero) add(0);
    add(slab.hi);
}

float ulp_of(const Slab &slab) {
    const float size = std::max(std::fabs(slab.lo), std::fabs(slab.hi));
    return std::nextafter(size, std::numeric_limits<float>::infinity()) - size;
}

// The look for seams in one box.
struct Look {
    Evaluator &evaluator;
    const cpu::ShortTape &tape;
    cpu::Boxes &boxes;
    bool solid = false;
    double thin = 0;
    const Sighting &sighting;
    std::vector<Across> directions{};
    std::size_t runs = 0; // of the tape over boxes

    // Takes those slabs of a place away in which there is nothing of the other sign.
    void leave_open(const Place &place, std::vector<Slab> &slabs) {
        if (slabs.empty()) return;
        ++runs;
        const std::size_t count = slabs.size();
        boxes.count = (count + 15) / 16 * 16;
        std::vector<Held> held;
        for (std::size_t d = 0; d < directions.size(); ++d) {
            std::vector<std::array<float, 2>> ranges(boxes.count, place.ends[d]);
            bool some = place.ends[d] != std::array{directions[d].level.lo, directions[d].level.hi};
            for (std::size_t k = 0; k < boxes.count; ++k)
                if (const Slab &slab = slabs[std::min(k, count - 1)]; slab.across == d)
                    ranges[k] = {slab.lo, slab.hi}, some = true;
            for (std::size_t k = 0; d < 3 && k < boxes.count; ++k)
                boxes.lo[d][k] = ranges[k][0], boxes.hi[d][k] = ranges[k][1];
            if (d < 3 || !some) continue;
            for (const auto &[where, tie] : directions[d].ties)
                held.push_back({where, ranges_tied(tie, ranges)});
            held.push_back({directions[d].level.where, std::move(ranges)});
        }
        std::ranges::stable_sort(held, {}, [](const Held &hold) { return hold.where.step; });
        if (held.empty())
            ranges_over(evaluator, tape, boxes);
        else
            ranges_where(evaluator, tape, boxes, held);
        std::vector<Slab> left;
        for (std::size_t k = 0; k < count; ++k)
            if (solid ? !(evaluator.ranges.result_hi[k] <= 0)
                      : !(evaluator.ranges.result_lo[k] > 0))
                left.push_back(slabs[k]);
        slabs = std::move(left);
    }

    // The parts of a whole place across a direction.
    std::vector<Slab> parts_across(const Place &place, std::size_t d) const {
        constexpr double about = 3; // thin slabs: what a guess may be off
        std::vector<Slab> parts, made;
        cut_up({d, place.ends[d][0], place.ends[d][1]}, parts);
        if (d >= 3) return parts;
        for (const Slab &part : parts) cut_out(part, sighting.planes[d], about * thin, made);
        return made;
    }

    // How wide at most the places are along one axis at which what was cut has the values of a slab.
    double width_of(const Slab &slab) const {
        const double width = double(slab.hi) - slab.lo;
        const Across &across = directions[slab.across];
        return slab.across < 3 ? width : (width + 2 * across.level.error) / across.level.slope;
    }
    // Where a number is held between ends so near, cutting it says no more about where that is.
    double finest(const Slab &slab) const {
        const Across &across = directions[slab.across];
        return std::max({2 * double(ulp_of(slab)), across.play, across.level.error});
    }
    // From its end to end, where cutting it has come to its end.
    double thinnest(const Slab &slab) const {
        return slab.across < 3 ? thin
                               : std::max(finest(slab), thin * directions[slab.across].level.slope);
    }
    bool is_thin(const Slab &slab) const {
        return (slab.across >= 3 && slab.hi - slab.lo <= finest(slab)) || width_of(slab) <= thin;
    }

    // So many slabs may be open at a time: a plane lies in two at most, and a guess divides one.
    std::size_t open_at_most(std::size_t d) const {
        return most_open + (d < 3 ? 2 * sighting.planes[d].size() : 0);
    }

    // Slabs of one kind, of which those are left that may have something of the other sign: how wide
    // all together are once they are thin. `planes`: these, added to what is there.
    std::optional<double> thin_out(const Place &place, std::vector<Slab> slabs,
                                   std::vector<Slab> *planes = nullptr) {
        double width = 0;
        for (int round = 0; round < most_cuttings && !slabs.empty(); ++round) {
            std::vector<Slab> next, done;
            std::size_t open_ones = 0;
            for (const Slab &slab : slabs)
                if (!is_thin(slab)) {
                    ++open_ones;
                    cut_up(slab, next);
                } else if (!done.empty() && done.back().hi == slab.lo) {
                    done.back().hi = slab.hi;
                } else {
                    done.push_back(slab);
                }
            if (open_ones > open_at_most(slabs[0].across) || slabs.size() > most_thin_slabs)
                return std::nullopt;
            for (const Slab &slab : done) {
                if (slab.hi - slab.lo > most_thinnest * thinnest(slab)) return std::nullopt;
                width += width_of(slab);
                if (planes) planes->push_back(slab);
            }
            if (width > most_thin * thin || next.size() > cpu::max_boxes) return std::nullopt;
            slabs = std::move(next);
            leave_open(place, slabs);
        }
        return slabs.empty() ? std::optional(width) : std::nullopt;
    }

    // As much again at each end of a thin slab: a plane between two slabs lies in both.
    float more_about(const Slab &slab) const {
        return std::max({slab.hi - slab.lo, 2 * ulp_of(slab),
                         2 * static_cast<float>(directions[slab.across].play)});
    }

    // The rest of a place beyond one of its ends across a direction, as far as nothing is there, and a
    // thin slab with it; and how wide that is. `open`: what is open across it.
    std::optional<double> strip(const Place &place, const std::vector<Slab> &open, bool high,
                                Place &rest) {
        Slab last = high ? open.back() : open.front();
        const std::size_t d = last.across;
        const auto at_end = [&] {
            return high ? last.hi == place.ends[d][1] : last.lo == place.ends[d][0];
        };
        for (int round = 0; round < most_cuttings && !is_thin(last); ++round) {
            if (round == end_cuttings && at_end()) return std::nullopt;
            std::vector<Slab> parts;
            cut_up(last, parts);
            leave_open(place, parts);
            if (parts.empty()) return std::nullopt; // the next one is where it ends
            last = high ? parts.back() : parts.front();
        }
        if (!is_thin(last) || at_end()) return std::nullopt;
        const float more = more_about(last);
        (high ? last.lo : last.hi) += high ? -more : more;
        rest = place;
        (high ? rest.ends[d][1] : rest.ends[d][0]) = high ? last.lo : last.hi;
        if (!(rest.ends[d][0] < rest.ends[d][1])) return std::nullopt;
        return width_of(last);
    }

    // The columns of a place along an axis, an eighth as wide as it, at its four edges.
    std::array<Place, 4> columns(const Place &place, std::size_t axis) const {
        std::array<Place, 4> made;
        made.fill(place);
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t n = 1; n < 3; ++n) {
                auto &[lo, hi] = made[k].ends[(axis + n) % 3];
                const auto part = static_cast<float>((double(hi) - lo) / cuts);
                if (k >> (n - 1) & 1)
                    lo = std::max(lo, hi - part);
                else
                    hi = std::min(hi, lo + part);
            }
        return made;
    }

    // The thin slabs across a direction in which there is something of the other sign, in the first
    // column of a place that has such slabs and nothing else; none: there is no such column.
    std::vector<Slab> planes_across(const Place &place, std::size_t d) {
        const std::array<double, 3> &slope = directions[d].level.gradient;
        std::size_t axis = d;
        if (d >= 3)
            axis = static_cast<std::size_t>(
                std::ranges::max_element(slope, {}, [](double x) { return std::fabs(x); }) -
                slope.begin());
        for (const Place &column : columns(place, axis)) {
            std::vector<Slab> slabs = parts_across(place, d), planes;
            leave_open(column, slabs);
            if (slabs.empty() || slabs.size() > open_at_most(d)) continue;
            if (thin_out(column, slabs, &planes) && !planes.empty()) return planes;
        }
        return {};
    }

    // What lies between thin slabs of one direction is cut up by `inner`; the slabs and all that is left in
    // them together.
    template <class Inner>
    std::optional<double> width_between(const Place &place, std::vector<Slab> planes, Inner inner) {
        const std::size_t d = planes[0].across;
        std::ranges::sort(planes, {}, &Slab::lo);
        double width = 0;
        Place rest = place;
        for (std::size_t k = 0; k <= planes.size(); ++k) {
            rest.ends[d][1] = place.ends[d][1];
            float next = place.ends[d][1]; // where the part behind the plane begins
            if (k < planes.size()) {
                rest.ends[d][1] = std::min(rest.ends[d][1], planes[k].lo);
                next = planes[k].hi;
                width += width_of(planes[k]);
            }
            if (rest.ends[d][0] < rest.ends[d][1]) {
                const auto within = inner(rest);
                if (!within) return std::nullopt;
                width += *within;
            }
            if (width > most_thin * thin) return std::nullopt;
            rest.ends[d][0] = std::max(rest.ends[d][0], next);
        }
        return width;
    }

    // Where planes cross each other: those of one direction, as columns show them, then the others.
    std::optional<double> width_crossed(const Place &place, std::size_t d, int strips) {
        std::vector<Slab> planes = planes_across(place, d);
        if (planes.empty() || planes.size() > most_open) return std::nullopt;
        for (Slab &plane : planes) {
            const float more = more_about(plane);
            plane.lo -= more, plane.hi += more;
        }
        return width_between(place, planes,
                             [&](const Place &rest) { return width_in(rest, strips - 1); });
    }

    // The same, of planes at right angles to an axis where they are guessed.
    std::optional<double> width_by_guesses(const Place &place, int strips) {
        for (std::size_t d = 0; d < 3 && strips > 0; ++d) {
            std::vector<Slab> planes;
            for (const float guess : sighting.planes[d]) {
                const auto lo = static_cast<float>(guess - thin),
                           hi = static_cast<float>(guess + thin);
                if (lo > place.ends[d][0] && hi < place.ends[d][1]) planes.push_back({d, lo, hi});
            }
            if (planes.empty()) continue;
            const auto inner = [&](const Place &rest) {
                const auto width = width_in(rest, 0);
                return width ? width : width_by_guesses(rest, strips - 1);
            };
            if (const auto width = width_between(place, planes, inner)) return width;
        }
        return std::nullopt;
    }

    // The same, where numbers are 0.
    std::optional<double> width_by_cuts(const Place &place, int strips) {
        constexpr float nothing = 0x1p-120f;
        const std::size_t most = runs + most_runs;
        const auto from = [&](auto &&self, const Place &part, std::size_t first,
                              int left) -> std::optional<double> {
            for (std::size_t d = first; d < directions.size() && left > 0; ++d) {
                if (!(part.ends[d][0] < 0 && part.ends[d][1] > 0) || runs > most) continue;
                const auto inner = [&](const Place &rest) {
                    const auto width = width_in(rest, 0);
                    return width ? width : self(self, rest, d + 1, left - 1);
                };
                if (const auto width = width_between(part, {{d, -nothing, nothing}}, inner))
                    return width;
            }
            return std::nullopt;
        };
        return from(from, place, 3, strips);
    }

    // Across each direction in turn; then where planes meet, so that one of them is stripped off first;
    // then where they cross.
    std::optional<double> width_in(const Place &place, int strips) {
        std::vector<std::vector<Slab>> open(directions.size());
        std::vector<Slab> slabs;
        for (std::size_t d = 0; d < 3; ++d)
            for (const Slab &slab : parts_across(place, d)) slabs.push_back(slab);
        leave_open(place, slabs);
        for (const Slab &slab : slabs) open[slab.across].push_back(slab);
        for (std::size_t d = 0; d < directions.size(); ++d) {
            if (d >= 3) {
                cut_up({d, place.ends[d][0], place.ends[d][1]}, open[d]);
                leave_open(place, open[d]);
            } else if (!(place.ends[d][0] < place.ends[d][1])) {
                continue;
            }
            if (const auto width = thin_out(place, open[d])) return width;
        }
        if (strips == 0) return std::nullopt;
        std::vector<std::size_t> order; // first those across which least is open
        for (std::size_t d = 0; d < directions.size(); ++d)
            if (!open[d].empty()) order.push_back(d);
        std::ranges::stable_sort(order, {}, [&](std::size_t d) { return open[d].size(); });
        for (const std::size_t d : order)
            for (const bool high : {false, true}) {
                Place rest;
                if (runs > most_runs) return std::nullopt;
                const auto stripped = strip(place, open[d], high, rest);
                if (!stripped) continue;
                if (const auto width = width_in(rest, strips - 1);
                    width && *width + *stripped <= most_thin * thin)
                    return *width + *stripped;
            }
        for (const std::size_t d : order) {
            if (runs > most_runs) return std::nullopt;
            if (const auto width = width_crossed(place, d, strips)) return width;
        }
        return std::nullopt;
    }
};

// The numbers that change as a direction's does, each within so little that it may tell gaps and
// sheets from what has some thickness.
void tie_alike(Across &across, const std::vector<Level> &levels, const Point &lo, const Point &hi,
               double thin) {
    constexpr double parallel = 0.999999;
    const Level &level = across.level;
    // Slabs across an axis hold what changes along it alone.
    if (std::ranges::count(level.gradient, 0.0) >= 2) return;
    for (const Level &other : levels) {
        if (across.ties.size() == most_ties) return;
        const bool same = other.where.step == level.where.step;
        if (same || cosine(level, other) < parallel) continue;
        const Tie tie = tie_of(level, other, lo, hi);
        const double play = tie.width() / std::fabs(tie.share);
        if (!(play <= most_thin * thin * level.slope)) continue;
        across.play = across.ties.empty() ? play : std::min(across.play, play);
        across.ties.push_back({other.where, tie});
    }
}

// Whether a tape takes the angle of a place, which has a cut.
bool has_angle(const Evaluator &evaluator, const cpu::ShortTape &tape) {
    return std::ranges::any_of(tape.steps, [&](std::uint32_t id) {
        const cpu::Step &step = evaluator.field.parts.table[id];
        return step.kind == cpu::StepKind::Run &&
               cpu::kernel_of_variant(step.target) == cpu::Kernel::Atan2F;
    });
}

} // namespace

std::optional<Seam> seam_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                            const Point &lo, const Point &hi, double thin, bool closely) {
    const Extent box{lo, hi};
    const Sighting seen = look_for_seams(evaluator, tape, {&box, 1}, thin)[0];
    return search_seam(evaluator, tape, boxes, box, seen, thin, closely).seam;
}

SeamSearch search_seam(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                       const Extent &box, const Sighting &sighting, double thin, bool closely) {
    if (sighting.seen == Seen::NoSeam) return {};
    const bool far = sighting.seen == Seen::AllSolid || sighting.seen == Seen::AllEmpty;
    const bool solid = sighting.seen == Seen::MaySolid || sighting.seen == Seen::AllSolid;
    const auto &[lo, hi] = box;
    Look look{evaluator, tape, boxes, solid, thin, sighting};
    Place place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        look.directions.push_back({axis, {{}, lo[axis], hi[axis], 1, 0, {}}});
        place.ends.push_back({lo[axis], hi[axis]});
    }
    const bool one_way = !far || sighting.one_way, cut = closely && has_angle(evaluator, tape);
    std::optional<double> width;
    if (one_way) width = look.width_in(place, 0);
    if (!far && !width) width = look.width_by_guesses(place, most_strips);
    if (!width && (!far || (closely && one_way) || cut)) {
        std::array<std::vector<float>, 4> slopes;
        slopes_in(evaluator, tape, box, slopes);
        ++look.runs;
        const std::vector<Level> levels = levels_in(evaluator, tape, boxes, lo, hi);
        for (const Level &level : chosen_levels(levels, slopes)) {
            look.directions.push_back({3, level});
            place.ends.push_back({level.lo, level.hi});
            tie_alike(look.directions.back(), levels, lo, hi, thin);
        }
        if (one_way && (closely || look.directions.size() > 3))
            width = look.width_in(place, closely && !far ? most_strips : 0);
        if (!width && cut) width = look.width_by_cuts(place, most_strips);
    }
    return {width ? std::optional(Seam{look.solid, *width}) : std::nullopt, look.runs};
}

} // namespace fathom::mesh
