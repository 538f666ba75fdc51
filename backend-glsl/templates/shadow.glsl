$# How much of a light arrives, by ir/shading.h (SHADOW, PENUMBRA); the sibling of backend-cpu/trace/shadow.cpp. After `nearest`.
$# The scene: float $SHADED(vec3), float sdf(vec3).
$if !SKIP_SHADING

// The greatest power of 2 that is not above x.
float fathom_power(float x) { return intBitsToFloat(floatBitsToInt(x) & 0x7f800000); }

// The first mark before s where what the ball of radius d about s leaves free may be less than `edge`, and not before
// `quiet` is over.
float fathom_mark(float s, float d, float edge, float quiet, float angle) {
    float gap = fathom_power($MARKS * angle * s);
    return gap * min(floor(min(s - (d - edge), quiet) / gap), ceil(s / gap) - 1.0);
}

// How much of a light arrives: marched from the light towards the point (thesis, 4.2.1).
float fathom_shadow(vec3 q, vec3 l, float reach, float angle, float margin, float h) {
    float s = reach; // what is left of the way
    bool mark = true; // whether s is one of the marks
    float shadow = $CLOSED_FROM; // the least of `closed` so far
    float quiet = 1e30; // from where on marks are looked at again
    int touches = 0; // 1, and how many samples in a row of a touch were not above 0; 0: none
    int probes = 0;   // steps of the touch
    int phase = 0;     // 0: looking for what may cover the light, 1: for what it crosses, 2: measuring
    float first = 0.0; // the first mark where something may
    int turn = $ZERO;
$if PASSES
    int taken = 0;
    if (fathom_light_kept >= 0) {
        vec4 kept = fathom_kept(fathom_kept_0);
        s = kept.y;
        mark = kept.z > 0.0;
        if (kept.z < 0.0) {
            probes = int(-kept.z) / 8;
            touches = int(-kept.z) - 8 * probes;
        }
        shadow = kept.w;
        quiet = fathom_kept(fathom_kept_1).y;
        phase = int(fathom_kept(fathom_kept_1).z);
        first = fathom_kept(fathom_kept_1).w;
        taken = int(fathom_kept(fathom_kept_3).y);
        fathom_light_kept = -1;
    }
    int limit = min(fathom_turns - fathom_taken, fathom_budget - taken);
$else
    int limit = $MAX_STEPS;
$end
    float x = s, value = 0.0, next = 0.0;
    int tap = -1;    // of the gradient at x; 0: the field itself, -1: none
    vec3 sum = vec3(0.0);
$if !UNIT_SLOPE
    float arm = h, bent = 0.0; // how far the taps are above the value, all together
    bool again = false;        // whether the arm is the second
    vec3 down = vec3(0.0);     // to the edge, against the gradient
$end
    while (true) {
        float f = 0.0;
        bool ahead = tap < 0;
$if SHADED_APART
        while (ahead && turn < limit && s > margin) {
$else
        while (!ahead || (turn < limit && s > margin)) {
$end
            if (ahead) {
                x = s;
$include shadow_ahead
            }
            vec3 p = q + x * l;
$if !SHADED_APART
$if !UNIT_SLOPE
            if (tap > 0) p += tap > 4 ? down : arm * fathom_corner(tap - 1);
$end
$end
$if AROUND
            fathom_exact = true;
$end
            f = sdf(p);
$if AROUND
            fathom_exact = false;
$end
$if CACHED
            if (fathom_absent) return 1.0;
$end
            if (!ahead) break;
            float film = 0.25 * fathom_slack_at(s);
$if ESTIMATED
            if (!(f > 0.0) || f < $DARK * angle * s) return 0.0;
$else
            if (!(f >= -film) || f <= 0.0 && touches >= $DEEP) return 0.0;
$end
            ++turn;
$# What is touched is passed.
            if (f < film || touches > 0) {
                bool on = f < film;
                if (touches == 0) probes = 0;
                float least = $PROBE * film;
                float probe = max(least, min(least * exp2(float(on ? probes : probes - 1)), 0.5 * angle * s));
                touches = on ? f > 0.0 ? 1 : max(touches, 1) + 1 : 0;
                if (on) {
                    s -= probe;
                    ++probes;
                    mark = false;
                    continue;
                }
            }
            next = f;
            if (phase != 1 && mark && s <= quiet && f < shadow * angle * s) {
                tap = 0;
                ahead = false;
                break;
            }
            float to = phase == 1 ? 0.0 : fathom_mark(s, next, shadow * angle * s, quiet, angle);
            mark = phase != 1 && to >= s - next;
            s = max(s - next, to);
        }
$if SHADED_APART
        if (!ahead) {
            vec3 p = q + x * l;
$if !UNIT_SLOPE
            if (tap > 0) p += tap > 4 ? down : arm * fathom_corner(tap - 1);
$end
            f = fathom_shaded(p);
        }
$end
$if CACHED
        if (fathom_absent) return 1.0;
$end
        if (ahead) {
$if PASSES
            if (s > margin && taken + turn < fathom_budget) {
                fathom_goes_on = true;
                fathom_keep_0 = vec4(0.0, s, touches > 0 ? float(-touches - 8 * probes) : float(mark), shadow);
                fathom_keep_1 = vec4(0.0, quiet, float(phase), first);
                fathom_keep_3.y = float(taken + turn);
                return 1.0;
            }
$end
            if (s > margin) fathom_shadow_undecided = true;
            if (phase != 1 || s > margin) break;
            phase = 2;
            s = first;
            mark = true;
            quiet = 1e30;
            touches = 0;
            continue;
        }
        if (tap == 0) value = f;
$if UNIT_SLOPE
        float near = value;
$else
        if (tap == 0) {
            sum = vec3(0.0);
            bent = -4.0 * value;
            arm = max(h, $SHADOW_ARM * value);
            again = false;
        }
        if (tap > 0 && tap < 5) {
            sum += f * fathom_corner(tap - 1);
            bent += f;
        }
        if (tap < 4) {
            ++tap;
            continue;
        }
        float near = value / max(sqrt(0.5625 * dot(sum, sum) + $CREASE * 0.0625 * bent * bent) / arm, $MIN_SLOPE);
        if (!again && arm > max(h, near)) { // the arm was longer than what it measured
            again = true;
            arm = max(h, $SHADOW_ARM * near);
            sum = vec3(0.0);
            bent = -4.0 * value;
            tap = 1;
            continue;
        }
        float edge = shadow * angle * x;
        if (tap == 4 && near >= edge && edge > h) {
            down = -edge / max(length(sum), 1e-30) * sum;
            tap = 5;
            continue;
        }
        if (tap == 5 && f < 0.0) near = edge * value / (value - f);
$end
        quiet = x - $CALM * (min(near, value) - shadow * angle * x);
        if (near < shadow * angle * x) {
            if (phase == 0) first = x;
            if (phase == 2) {
                int looks = 0;
                float off = fathom_nearest(q, l, q + x * l, value, margin, reach, angle, max(h, $FINE * angle * x),
                                     0.25 * fathom_slack_at(x), shadow, looks);
$if PASSES
                limit -= looks;
                fathom_taken += looks;
$end
$if CACHED
                if (fathom_absent) return 1.0;
$end
                shadow = min(shadow, max(off, $DARKEST));
            }
            phase = max(phase, 1);
        }
        tap = -1;
        float to = phase == 1 ? 0.0 : fathom_mark(s, next, shadow * angle * s, quiet, angle);
        mark = phase != 1 && to >= s - next;
        s = max(s - next, to);
    }
$if PASSES
    fathom_taken += turn;
$end
    shadow = clamp(shadow, $DARKEST, 1.0);
    return (shadow * shadow * (3.0 - 2.0 * shadow) - $DARK_LIGHT) / (1.0 - $DARK_LIGHT);
}
$end
