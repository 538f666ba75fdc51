$# How much of a light arrives, by ir/shading.h (SHADOW, FILMS); the sibling of backend-cpu/trace/shadow.cpp.
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

$if FILMS
// Whether what the field says at p tells of no solid (FILMS). What is touched is below `thick`; the circle lies across l.
bool fathom_film(vec3 p, vec3 l, float thick) {
    vec3 side = normalize(abs(l.x) < 0.6 ? vec3(0.0, l.z, -l.y) : vec3(-l.z, 0.0, l.x));
    vec3 sum = vec3(0.0), around = vec3(0.0), lowest = p;
    float g = 0.0, arm = 0.0, low = 0.0, bent = 0.0;
    int step = 0, tap = -1, look = -1; // of a gradient, -1: the field itself; of the circle, -1: not there yet
    for (int i = $ZERO; i < 5 * $FILM_STEPS + 1 + $FILM_LOOKS; ++i) {
$if AROUND
        fathom_exact = true;
$end
        float f = $SHADED(p + around);
$if AROUND
        fathom_exact = false;
$end
$if CACHED
        if (fathom_absent) return false;
$end
        if (look >= 0) {
            if (!(f >= -thick)) return false;
            ++look;
            if (look == $FILM_LOOKS) return true;
        }
        if (look < 0 && tap >= 0) {
            sum += f * fathom_corner(tap);
            bent += f;
            if (tap == 0 || f < low) {
                low = f;
                lowest = p + around;
            }
            ++tap;
            around = arm * fathom_corner(tap & 3);
            if (tap == 4) {
                sum *= 0.75 / arm;
                bent *= 0.25 / arm;
                float slope = max(sqrt(dot(sum, sum) + $CREASE * bent * bent), $MIN_SLOPE);
                p -= g / (slope * max(length(sum), $MIN_SLOPE)) * sum;
                around = vec3(0.0);
                tap = -1;
                continue;
            }
        }
        if (look < 0 && tap < 0) {
            if (step > 0) {
                if (!(f < $FILM_HALVED * g) && low < f) {
                    f = low;
                    p = lowest;
                }
                if (!(f < $FILM_LOWER * g)) return true; // a least value above 0
            }
            g = f;
            if (!(g > -$FILM_NEAR * thick)) return false;
            if (g < $FILM_NEAR * thick) look = 0;
            if (look < 0 && step == $FILM_STEPS) return false;
            if (look < 0) {
                ++step;
                tap = 0;
                arm = $SHADOW_ARM * g;
                sum = vec3(0.0);
                bent = -4.0 * g;
                around = arm * fathom_corner(0);
            }
        }
        if (look >= 0) {
            float angle = $FILM_TURN * float(look);
            around = $FILM_LOOK * thick * (cos(angle) * side + sin(angle) * cross(l, side));
        }
    }
    return false;
}

$end
// How much of a light arrives: marched from the light towards the point (thesis, 4.2.1).
float fathom_shadow(vec3 q, vec3 l, float reach, float angle, float margin, float h) {
    float s = reach; // what is left of the way
    bool mark = false; // whether s is one of the marks
    float shadow = $CLOSED_FROM, at = 0.0; // the least of `closed` at them so far, and where
    float quiet = 1e30; // from where on marks are looked at again
    int touches = 0; // 1, and how many samples in a row of a touch were not above 0; 0: none
    int probes = 0;   // steps of the touch
$if FILMS
    bool careful = false; // a film is on the way: each mark is tried for one
    bool done = false; // the least is known: what is nearest there is tried for a film
$else
    const bool done = false;
$end
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
        kept = fathom_kept(fathom_kept_1);
        at = kept.x;
        quiet = kept.y;
        taken = int(fathom_kept(fathom_kept_3).y);
$if FILMS
        careful = taken < 0;
        if (careful) taken = -1 - taken;
$end
        fathom_light_kept = -1;
    }
    int limit = min(fathom_turns - fathom_taken, fathom_budget - taken);
$else
    int limit = $MAX_STEPS;
$end
    float x = s, value = 0.0, next = 0.0;
    int tap = -1;    // of the gradient at x; 0: the field itself, -1: none
    int search = -1; // evaluations for the penumbra; -1: the way is not done yet
    float lo = 0.0, hi = 0.0, a = 0.0, b = 0.0, at_a = 0.0, at_b = 0.0;
    bool left = true;
    vec3 sum = vec3(0.0);
$if !UNIT_SLOPE
    float arm = h, bent = 0.0; // how far the taps are above the value, all together
$end
    while (true) {
        float f = 0.0;
        bool ahead = tap < 0 && search < 0;
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
            if (tap > 0) p += arm * fathom_corner(tap - 1);
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
            if (mark && s <= quiet && f < shadow * angle * s) {
                tap = 0;
                ahead = false;
                break;
            }
            float to = fathom_mark(s, next, shadow * angle * s, quiet, angle);
            mark = to >= s - next;
            s = max(s - next, to);
        }
$if SHADED_APART
        if (!ahead) {
            vec3 p = q + x * l;
$if !UNIT_SLOPE
            if (tap > 0) p += arm * fathom_corner(tap - 1);
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
                fathom_keep_1 = vec4(at, quiet, 0.0, 0.0);
$if FILMS
                fathom_keep_3.y = float(careful ? -1 - taken - turn : taken + turn);
$else
                fathom_keep_3.y = float(taken + turn);
$end
                return 1.0;
            }
$end
            if (s > margin) fathom_shadow_undecided = true;
$if FILMS
            if (!(shadow < $CLOSED_FROM) || (careful && !(shadow > $DARKEST))) break;
            done = !(shadow > $DARKEST);
            if (!done) {
$else
            if (!(shadow > $DARKEST && shadow < $CLOSED_FROM)) break;
            {
$end
                search = 0;
                left = true;
                float gap = fathom_power($MARKS * angle * at);
                lo = max(at - gap, margin);
                hi = min(at + gap, reach);
                a = hi - $GOLDEN * (hi - lo);
                b = lo + $GOLDEN * (hi - lo);
                x = a;
                continue;
            }
        }
        if (tap < 0 && !done) { // golden sections
            if (left) at_a = f;
            if (!left) at_b = f;
            ++search;
            if (search == 1) {
                left = false;
                x = b;
                continue;
            }
            left = at_a * b < at_b * a;
            if (search < $SEARCHES) {
                if (left) {
                    hi = b;
                    b = a;
                    at_b = at_a;
                    a = hi - $GOLDEN * (hi - lo);
                }
                if (!left) {
                    lo = a;
                    a = b;
                    at_a = at_b;
                    b = lo + $GOLDEN * (hi - lo);
                }
                x = mix(b, a, left);
                continue;
            }
            x = mix(b, a, left);
            f = mix(at_b, at_a, left);
            tap = 0;
        }
        if (tap == 0) value = f;
$if UNIT_SLOPE
        float near = value;
$else
        if (tap == 0) {
            sum = vec3(0.0);
            bent = -4.0 * value;
            arm = max(h, $SHADOW_ARM * value);
        }
        if (tap > 0) {
            sum += f * fathom_corner(tap - 1);
            bent += f;
        }
        if (tap < 4 && !done) {
            ++tap;
            continue;
        }
        float near = value / max(sqrt(0.5625 * dot(sum, sum) + $CREASE * 0.0625 * bent * bent) / arm, $MIN_SLOPE);
$end
$if FILMS
        float closed = near / (angle * x);
        bool lowers = closed < shadow;
        if (search >= 0 && !careful) {
            done = true;
            if (lowers) {
                shadow = max(closed, $DARKEST);
                at = x;
            }
        }
        if (done || careful && lowers) {
            float way = done ? at : x;
            bool film = fathom_film(q + way * l, l, 0.25 * fathom_slack_at(way));
$if CACHED
            if (fathom_absent) return 1.0;
$end
            if (done) {
                if (!film) break;
                careful = true; // all of the way anew
                done = false;
                s = reach;
                mark = false;
                shadow = $CLOSED_FROM;
                at = 0.0;
                quiet = 1e30;
                touches = 0;
                tap = -1;
                search = -1;
                continue;
            }
            lowers = !film;
        }
        if (search >= 0) {
            if (lowers) shadow = closed;
            break;
        }
        quiet = x - $CALM * (min(near, value) - shadow * angle * x);
        if (lowers) {
$else
        float closed = near / (angle * x);
        if (search >= 0) {
            shadow = min(shadow, closed);
            break;
        }
        quiet = x - $CALM * (min(near, value) - shadow * angle * x);
        if (closed < shadow) {
$end
            shadow = max(closed, $DARKEST);
            at = x;
        }
        tap = -1;
        float to = fathom_mark(s, next, shadow * angle * s, quiet, angle);
        mark = to >= s - next;
        s = max(s - next, to);
    }
$if PASSES
    fathom_taken += turn;
$end
    shadow = clamp(shadow, $DARKEST, 1.0);
    return (shadow * shadow * (3.0 - 2.0 * shadow) - $DARK_LIGHT) / (1.0 - $DARK_LIGHT);
}
$end
