// One ray's way, sample by sample: ir/shading.h's MARCH and BY CURVATURE in float32. Knows no fields:
// what is found at a sample is written into the walk by the caller.
#pragma once

#include "backend-cpu/trace/rays.h"
#include "ir/shading.h"

#include <algorithm>

namespace fathom::cpu {

struct Walk {
    float t = 0, before = 0, stride = 0, d = 0;
    float span = 0, reached = 0; // how far d reaches, and `before`; where that is more than they
    int steps = 0;
    int touches = 0;   // 1, and how many samples in a row of a touch were not above 0; 0: none
    float film = 0;    // how far it has come since the last that was above 0
    int nearing = 0;   // samples in a row within an estimate's tolerance, each nearer than the last
    bool aims = false; // the last step was to change the sign
    bool passed = false; // it has gone through what has no inside
    float close = -1;    // where it was last within a pixel's width of something, and passed it
};

// From which value on a lower bound of the distance will do: below it, whether the ray has arrived
// is decided.
inline float limit_at(float t, const Lengths &lengths) {
    return 2 * std::max(lengths.tolerance(t), lengths.width(t));
}

// The balls about the last two samples do not touch: something may lie between them.
inline bool apart(const Walk &walk) {
    if (walk.stride <= walk.before + std::max(walk.d, 0.0f)) return false;
    return !(walk.d > 0 && walk.stride <= walk.reached + walk.span);
}

// What a sample says of its ray. Touches: what lies ahead says whether there is a solid.
enum class Verdict : std::uint8_t { GoOn, GoBack, Crossed, Near, Touches, Undecided };
inline Verdict judge(Walk &walk, const Lengths &lengths) {
    if (std::isnan(walk.d)) return Verdict::Undecided;
    const float film = 0.25f * lengths.slack_at(walk.t);
    if (walk.touches > 0) {
        if (walk.d < film)
            return walk.d < -film || (walk.d <= 0 && walk.touches >= ir::shading::deep)
                       ? Verdict::Crossed
                       : Verdict::Touches;
        walk.touches = 0; // it has passed, and begins anew
        walk.passed |= walk.d > std::max(ir::shading::across * walk.film,
                                         0.25f * (lengths.slack_at(walk.t) + lengths.coarse));
        walk.before = walk.stride = walk.reached = 0;
    }
    const Verdict inside =
        walk.d < -film || lengths.estimate > 0 ? Verdict::Crossed : Verdict::Touches;
    if (walk.d <= 0 && walk.aims && inside == Verdict::Crossed) return inside;
    if (apart(walk)) return Verdict::GoBack;
    if (walk.d <= 0) return inside;
    const bool nearing = lengths.estimate > 0 && walk.d < walk.before &&
                         lengths.estimate * walk.d < lengths.tolerance(walk.t);
    walk.nearing = nearing ? walk.nearing + 1 : 0;
    const bool touch = walk.d < film;
    if (walk.nearing == ir::shading::nearing || (touch && lengths.estimate > 0))
        return Verdict::Near;
    return touch ? Verdict::Touches : Verdict::GoOn;
}
// Whether a ray that ends at t has come CLOSE to something on its way.
inline bool was_close(const Walk &walk, bool hit, float t, const Lengths &lengths) {
    return walk.close >= 0 &&
           !(hit && t - walk.close <= ir::shading::behind * lengths.width(walk.close));
}

// Of rays that have ended: which came CLOSE to something, and how many passed what has no inside.
void look_back(Worker &worker, std::span<const Walk> walks, std::span<Landing> landings);

// Where a ray that has come near lands: so far from the surface that a gradient does not cross it.
inline Landing beside(const Walk &walk, const Lengths &lengths) {
    return {walk.t - 0.5f * lengths.tolerance(walk.t), walk.steps, RayEnd::Hit};
}
inline float slope_along(const Walk &walk) {
    return walk.stride > 0 ? (walk.before - walk.d) / walk.stride : 0;
}
inline Crossing crossing(const Walk &walk, std::size_t ray) {
    const float from = walk.touches > 0 ? walk.film : walk.stride;
    return {ray, walk.t - from, walk.t, walk.before, walk.d, walk.aims};
}

// How far beyond the last sample to look next, where what lies between is not known to be free.
inline float nearer(const Walk &walk, const Lengths &lengths, bool by_curvature) {
    if (!by_curvature) return walk.before;
    const float to =
        walk.d > 0 ? walk.reached + ir::shading::nearer * std::min(walk.span, walk.reached)
                   : std::min(walk.reached, walk.stride * walk.before / (walk.before - walk.d) -
                                                0.5f * lengths.tolerance(walk.t));
    return std::max(walk.before, std::min(to, walk.stride));
}

inline void go_back(Walk &walk, const Lengths &lengths, bool by_curvature) {
    const float stride = nearer(walk, lengths, by_curvature);
    walk.t += stride - walk.stride;
    walk.stride = stride;
    walk.aims = false;
}

inline void advance(Walk &walk, float end, const Lengths &lengths, bool brute) {
    const float d = walk.d;
    if (walk.stride > 0 && d > walk.before && walk.before < lengths.width(walk.t - walk.stride))
        walk.close = walk.t - walk.stride;
    const float span = std::max(walk.span, d);
    float next = brute ? std::max(0.1f * d, 0.125f * lengths.tolerance(walk.t)) : d;
    if (!brute && span > d) {
        next = span;
        if (walk.stride > 0) {
            const float change = (span * span - walk.reached * walk.reached) / walk.stride;
            next = change < -span ? span * span / -change - 0.5f * lengths.tolerance(walk.t)
                                  : span + ir::shading::bent_relaxation * (span + change);
            next = std::max(next, d);
        }
    } else if (!brute && walk.stride > 0)
        next += ir::shading::relaxation * d * std::max(walk.stride + d - walk.before, 0.0f) /
                std::max(walk.stride - d + walk.before, ir::shading::flattest * walk.stride);
    walk.aims = false;
    if (!brute && walk.stride > 0 && walk.before > walk.d) {
        const float tolerance = lengths.tolerance(walk.t);
        const float to = walk.d / slope_along(walk) + 0.25f * tolerance;
        if (to <= ir::shading::jump * tolerance) {
            next = std::max(d, to);
            walk.aims = true;
        }
    }
    // what is not proved yet ends at the end exactly, rounding or not, so that it is still checked
    const float proved = std::max(end, walk.t + d);
    next = std::min(next, proved - walk.t);
    walk.before = d;
    walk.reached = span;
    walk.stride = next;
    walk.t = std::min(walk.t + next, proved);
}

// On from a sample that touches: a few slacks first, then ever more, so that whatever is thicker than
// these is met at any angle.
inline void pass(Walk &walk, float end, const Lengths &lengths) {
    const float film = 0.25f * lengths.slack_at(walk.t);
    if (walk.touches == 0) {
        walk.film = walk.stride;
        walk.stride = 0.5f * film * ir::shading::probe_depth /
                      std::max(slope_along(walk), ir::shading::probe_depth / ir::shading::probe);
    }
    if (walk.d > 0) {
        walk.film = 0;
        walk.before = walk.d;
    }
    walk.touches = walk.d > 0 ? 1 : std::max(walk.touches, 1) + 1;
    const float most =
        std::max(ir::shading::probe * film, ir::shading::graze * lengths.tolerance(walk.t));
    const float next = std::min(2 * walk.stride, most);
    const float to = walk.t < end ? std::min(walk.t + next, end) : walk.t + next;
    walk.stride = next;
    walk.film += to - walk.t;
    walk.t = to;
    walk.aims = false;
}

} // namespace fathom::cpu
