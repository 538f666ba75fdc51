$# Ray marching by ir/shading.h (LENGTHS, MARCH, REFINED), which explains; the sibling of
$# backend-cpu/trace/march.cpp. The scene: float sdf(vec3), and with HAS_SAFE_RADIUS vec2 fathom_safe_radius(vec3).

// ---- how rays are marched and points are shaded ----

float fathom_slack, fathom_pixel, fathom_far, fathom_tolerance_base, fathom_tolerance_slope;
int fathom_steps = 0;
int fathom_paint = -2; // of what the ray hit
int fathom_end = 0;    // of the ray: 0 a miss, 1 a hit, 2 undecided, 3 it goes on in another pass
bool fathom_shadow_undecided = false;
$if PASSES
bool fathom_close = false;  // ir/shading.h, CLOSE
bool fathom_passed = false; // the ray has gone through what has no inside

$# A draw takes at most fathom_turns steps a ray. What a ray that goes on needs is kept, and given back to the next draw:
$#   0  the ray from the eye: t, before, stride, reached; one from a light: t of the hit, s, stride, shadow
$#   1  of that from a light: at, quiet; of one from the eye: to an estimate nearing, where it was close
$#   2  the colour without that light
$#   3  the steps, the touches (+ 16 where it aims) or the steps of the ray from the light, which light (-1: the eye's ray), 1 where the
$#      eye's ray is undecided, 2 where one from a light is, 4 where the eye's ray has gone through what has no inside, and
$#      8 where it has been close to something
uniform int fathom_turns, fathom_budget;
#ifdef FATHOM_BEGINS // the host never lets rays go on
const bool fathom_resumed = false;
#endif
#ifndef FATHOM_BEGINS
uniform bool fathom_resumed; // rays go on, else they begin
#endif
uniform sampler2D fathom_kept_0, fathom_kept_1, fathom_kept_2, fathom_kept_3;
$if FOUR_OUTPUTS
$# WebGL 2 promises no more outputs than four. Of a ray that goes on the colour is what lacks the light; 2 as its
$# alpha says that it does.
float fathom_left;
vec4 fathom_keep_2;
layout(location = 1) out vec4 fathom_keep_0;
layout(location = 2) out vec4 fathom_keep_1;
layout(location = 3) out vec4 fathom_keep_3;
$else
layout(location = 2) out float fathom_left; // 1 the ray goes on; else 0.25 it is undecided, 0.5 a ray from a light is
layout(location = 3) out vec4 fathom_keep_0;
layout(location = 4) out vec4 fathom_keep_1;
layout(location = 5) out vec4 fathom_keep_2;
layout(location = 6) out vec4 fathom_keep_3;
$end

int fathom_taken = 0;       // steps of this draw
int fathom_light_kept = -1; // whose ray goes on
bool fathom_goes_on = false;
vec4 fathom_kept(sampler2D kept) {
    return texelFetch(kept, ivec2(gl_FragCoord.xy), 0);
}
$end

void fathom_lengths() {
    fathom_slack = $FLOAT_SLACK * length(fathom_origin);
    fathom_pixel = 2.0 * fathom_extent / fathom_resolution.y;
    fathom_far = $FAR;
    bool parallel = fathom_orthographic != 0;
    fathom_tolerance_base = (parallel ? min($EPSILON * fathom_extent / $USUAL_EXTENT, 0.5 * fathom_pixel) : 0.0) + fathom_slack;
    fathom_tolerance_slope = parallel ? 0.0 : min($EPSILON, 0.5 * fathom_pixel);
}

float fathom_slack_at(float t) {
    return fathom_slack + $FLOAT_SLACK * t;
}

float fathom_tolerance(float t) {
    return fathom_tolerance_base + fathom_tolerance_slope * t;
}

float fathom_width_at(float t) {
    return fathom_orthographic != 0 ? fathom_pixel : fathom_pixel * t;
}

float fathom_arm(float t) {
    return $ARM * fathom_tolerance(t) +
           min($NORMAL_SLACK * (fathom_slack + $FLOAT_SLACK * $RADIUS), $WIDEST * fathom_width_at(t));
}
$if BOXED

// Where a ray enters and leaves the box that holds everything.
vec2 fathom_box(vec3 origin, vec3 direction) {
    vec3 safe = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 a = ($LO - origin) / safe;
    vec3 b = ($HI - origin) / safe;
    vec3 first = min(a, b);
    vec3 last = max(a, b);
    return vec2(max(first.x, max(first.y, first.z)), min(last.x, min(last.y, last.z)));
}
$end

// Enhanced sphere tracing. The distance of the hit along the ray, or of where an undecided ray came to; -1: a miss.
float fathom_march(vec3 origin, vec3 direction, float begin, float end) {
    float t = begin;
    float before = 0.0;
    float stride = 0.0;
    int touches = 0;   // 1, and how many samples in a row of a touch were not above 0; 0: none
    float passed = 0.0, pace = 0.0; // how far it has come since the last that was above 0; its last step
    bool aims = false; // the last step was to change the sign
$if HAS_SAFE_RADIUS
    float reached = 0.0;
$end
    int steps = 0;
$if ESTIMATED
    int nearing = 0; // samples in a row within the tolerance, each nearer than the one before
$end
$if PASSES
    float close = -1.0;
    if (fathom_resumed) {
        vec4 kept = fathom_kept(fathom_kept_0);
        vec4 more = fathom_kept(fathom_kept_3);
        t = kept.x;
        steps = int(more.x);
        fathom_light_kept = int(more.z);
        if (fathom_light_kept >= 0) {
            fathom_steps = steps;
            fathom_end = mod(more.w, 2.0) > 0.0 ? 2 : 1;
            fathom_shadow_undecided = mod(more.w, 4.0) > 1.0;
            fathom_passed = mod(more.w, 8.0) > 3.0;
            fathom_close = more.w > 7.0;
            return t;
        }
        before = kept.y;
        stride = kept.z;
$if HAS_SAFE_RADIUS
        reached = kept.w;
$end
        vec4 others = fathom_kept(fathom_kept_1);
        close = others.y;
$if ESTIMATED
        nearing = int(others.x);
$end
        fathom_passed = more.w > 3.0;
        aims = more.y > 15.0;
        touches = int(more.y) - (aims ? 16 : 0);
        if (touches > 0) {
            passed = kept.w;
            pace = stride;
            stride = 0.0;
        }
    }
    int begun = steps;
    int limit = min(fathom_turns, fathom_budget - steps);
$else
$if CACHED
$# What was reached by curvature is not remembered: 0 proves less, and costs a step.
    fathom_resume(t, before, stride, steps);
$end
    int limit = $MAX_STEPS - steps;
$end
    fathom_end = 3;
    int turn = $ZERO;
    int phase = 0; // 0: it marches; 1: the place of the hit is refined
    int count = 0; // of refinements
    int stays = 0; // which end of the chord stayed: 1 a, 2 b
    float aimed = -1.0; // where the ray lands if what is before it is outside
    float a = 0.0, b = 0.0, at_a = 0.0, at_b = 0.0;
    float d = 0.0;
$if HAS_SAFE_RADIUS
    float span = 0.0;
$end
$# Drivers compute both sides of a branch: what is seldom wanted stands outside of the loop that
$# marches, and comes back to it for the field's one evaluation.
    while (true) {
        bool found = false;
        for (; phase > 0 || turn < limit; ++turn) {
$if FAR_CELLS
$# Through far cells first, all rays together; then the field is evaluated, once. A step is
$# what evaluates it.
            while (phase == 0 && touches == 0 && t <= end) {
                vec2 clear = fathom_clear(origin + t * direction, direction, fathom_tolerance(t));
                if (!(clear.y > 0.0 && stride <= before + clear.x)) break;
                t += clear.y;
                before = 0.0;
                stride = 0.0;
                aims = false;
            }
$end
            if (!(t <= end + fathom_slack)) break;
            vec3 p = origin + t * direction;
$if CACHED
            fathom_width = fathom_width_at(t);
            if (phase == 0) fathom_step(t, before, stride, steps);
$end
$if HAS_SAFE_RADIUS
            vec2 both = fathom_safe_radius(p);
            d = both.x;
            span = both.y;
$else
            d = sdf(p);
$end
$if CACHED
$# Where a cached value is absent the pixel is left to the text that computes all, so that
$# what the ray sees is one field (docs/noise-cache.md): its loops end at once.
            if (fathom_absent) break;
$end
            found = phase > 0;
            if (found) break;
            ++steps;
            float tolerance = fathom_tolerance(t);
$if HAS_SAFE_RADIUS
            if (!(d $CROSSED && aims) && stride > before + max(d, 0.0) && !(d > 0.0 && stride <= reached + span)) {
                float to = reached + $NEARER_PART * min(span, reached);
                if (!(d > 0.0)) to = min(reached, stride * before / (before - d) - 0.5 * tolerance);
                to = max(before, min(to, stride));
$else
            if (!(d $CROSSED && aims) && stride > before + max(d, 0.0)) {
                float to = before;
$end
                t += to - stride;
                stride = to;
                aims = false;
                continue;
            }
            found = !(d >= 0.25 * fathom_slack_at(t)) || touches != 0;
$if ESTIMATED
            nearing = d < min(before, $SHARE * tolerance) ? nearing + 1 : 0;
            if (d < 0.25 * fathom_slack_at(t)) nearing = $NEARING;
            found = found || nearing == $NEARING;
$end
            if (found) break;
            float ahead = d;
$include march_ahead
        }
        if (!found) break;
        float tolerance = fathom_tolerance(t);
        if (phase == 0 && isnan(d)) {
            fathom_end = 2;
            break;
        }
$if ESTIMATED
        if (phase == 0 && d > 0.0 && nearing == $NEARING) {
            t -= 0.5 * tolerance;
            fathom_end = 1;
            break;
        }
$end
$# What is touched is passed, with ever longer steps, until the field says what is behind it.
        float film = 0.25 * fathom_slack_at(t);
        if (phase == 0 && !(d < -film)$NO_ESTIMATE && !(d <= 0.0 && touches >= $DEEP)) {
            if (d >= film) {
$if PASSES
                fathom_passed = fathom_passed ||
                                d > max($ACROSS * passed, film + 0.25 * (fathom_slack + $FLOAT_SLACK * $RADIUS));
$end
                touches = 0;
                before = 0.0;
                float ahead = d;
$include march_ahead
                ++turn;
                continue;
            }
            if (touches == 0) {
                passed = stride;
                float slope = stride > 0.0 ? (before - d) / stride : 0.0;
                pace = 0.5 * film * $PROBE_DEPTH / max(slope, $PROBE_DEPTH / $PROBE);
            }
            if (d > 0.0) {
                passed = 0.0;
                before = d;
            }
            touches = d > 0.0 ? 1 : max(touches, 1) + 1;
            stride = 0.0;
            pace = min(2.0 * pace, max($PROBE * film, $GRAZE * tolerance));
            float to = mix(t + pace, min(t + pace, end), t < end);
            passed += to - t;
            t = to;
            aims = false;
            ++turn;
            continue;
        }
        bool begins = phase == 0;
        if (begins) {
            phase = 1;
            count = 0;
            a = t - mix(stride, passed, touches > 0);
            b = t;
            at_a = before;
            at_b = d;
        }
        if (!begins) {
            bool inside = !(d > 0.0);
            if (inside) {
                b = t;
                at_b = d;
                if (stays == 1) at_a *= 0.5;
            }
            if (!inside) {
                a = t;
                at_a = d;
                if (stays == 2) at_b *= 0.5;
            }
            stays = inside ? 1 : 2;
            ++count;
            ++steps;
        }
        float x = mix(b, a + (b - a) * (at_a / max(at_a - at_b, 1e-30)), b > a);
        tolerance = fathom_tolerance(mix(x, t, count > 0));
        float near = $REFINED * tolerance;
        bool there = count > 0 && (count == $REFINEMENTS || abs(x - t) <= near);
        if (aimed >= 0.0) {
            there = stays == 2;
            x = mix(x, aimed, there);
            aimed = -1.0;
        }
        if (count == 0 && aims && abs(x - b + 0.25 * tolerance) <= near) {
            there = !(x - 0.25 * tolerance > a);
            aimed = mix(x, -1.0, there);
            x = mix(x - 0.25 * tolerance, x, there);
        }
        t = x;
        if (there || !(b - a > $REFINED * fathom_tolerance(x))) {
            fathom_end = 1;
            break;
        }
    }
    fathom_steps = steps;
    if (fathom_end == 3 && !(t <= end + fathom_slack)) fathom_end = 0;
$if PASSES
    fathom_taken = steps - begun;
    if (fathom_end == 3 && steps >= fathom_budget) fathom_end = 2;
    fathom_close = close >= 0.0 && !(fathom_end > 0 && t - close <= $BEHIND * fathom_width_at(close));
    if (fathom_end == 3) {
        fathom_goes_on = true;
$if HAS_SAFE_RADIUS
        fathom_keep_0 = vec4(t, before, stride + mix(0.0, pace, touches > 0), mix(reached, passed, touches > 0));
$else
        fathom_keep_0 = vec4(t, before, stride + mix(0.0, pace, touches > 0), passed);
$end
        fathom_keep_1 = vec4(0.0, close, 0.0, 0.0);
$if ESTIMATED
        fathom_keep_1.x = float(nearing);
$end
        fathom_keep_3 = vec4(float(steps), float(touches + (aims ? 16 : 0)), -1.0, fathom_passed ? 4.0 : 0.0);
    }
$else
    if (fathom_end == 3) fathom_end = 2;
$end
    return fathom_end == 0 ? -1.0 : t;
}
