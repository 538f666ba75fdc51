$# Where the solid is nearest, by ir/shading.h (NEAREST, FILMS); the sibling of backend-cpu/trace/nearest.cpp.
$# The scene: float $SHADED(vec3).
$if !SKIP_SHADING
$if FILMS

vec3 fathom_perpendicular(vec3 v) {
    return abs(v.x) < abs(v.y) ? vec3(0.0, v.z, -v.y) : vec3(-v.z, 0.0, v.x);
}
$end

// How far off the solid is that is found from p on, where the field says g: from the point `from`, or, with half the
// light's angular size, in lights' sizes from the way along l. What is not below `limit` does not count. The evaluations
// are added to `looks`.
float fathom_nearest(vec3 from, vec3 l, vec3 p, float g, float first, float last, float angle, float fine,
                     float thick, float limit, inout int looks) {
    bool point = !(angle > 0.0);
    vec3 v = vec3(0.0), sum = v, best = p, along = v; // v: the gradient of the last step, by which the field is `ahead`
    float least = $UNSEEN, share = 1.0, slope = 0.0, said = 0.0, bent = -4.0 * g, ahead = 0.0;
    float arm = max(fine, $SHADOW_ARM * abs(g));
    vec3 around = arm * fathom_corner(0);
$if !UNIT_SLOPE
    vec3 last_p = p, other = p; // where the last step began; and where the field had the other sign,
    float g_last = 0.0, slope_last = 0.0, stride = 0.0; // the field there, its slope, and the step's length,
    float beyond = 0.0;                                 // and the field here; 0: none
$end
    int steps = 0, slides = 0, tap = 0; // of a gradient, -1: the field itself
    bool returned = false;
    bool found = false; // the place is: is it a film?
$if FILMS
    vec3 best_v = v, best_way = v;
    float best_g = g, best_slope = 1.0, before = g;
    int stalls = 0, look = -1; // of the circle round it
    bool none = false; // no solid is at `best`, where the field is 0 so far on; so what is beside it is looked for:
    float away_there = 0.0, fine_found = fine;
    int beside = -1; // looks on the circles about `middle`
    vec3 middle = v, side_x = v, side_y = v, behind = v;
    float across = 0.0, angle_in = 0.0, beside_turn = 0.5 * $CIRCLE_TURN, share_in = 1.0, share_out = 0.0;
$end
    for (int i = $ZERO; i < ($MOST_SLIDES + 2) * (5 * $DESCENT_STEPS + 1) + 5 * $FILM_STEPS + $FILM_LOOKS + $CIRCLES_LOOKS + 3 * $CIRCLE_HALVINGS; ++i) {
        ++looks;
$if AROUND
        fathom_exact = true;
$end
        float f = $SHADED(p + around);
$if AROUND
        fathom_exact = false;
$end
$if CACHED
        if (fathom_absent) return $UNSEEN;
$end
        bool landed = false;
        if (tap >= 0) {
            sum += f * fathom_corner(tap);
            bent += f;
            ++tap;
            around = arm * fathom_corner(tap & 3);
            if (tap < 4) continue;
            sum *= 0.75 / arm;
            bent *= 0.25 / arm;
            float steep = max(sqrt(dot(sum, sum) + $CREASE * bent * bent), $MIN_SLOPE), away = abs(g) / steep;
$if !UNIT_SLOPE
            landed = !found && slope > 0.0 && away < fine;
$end
            if (!landed) slope = steep;
            if (!landed && arm <= max(fine, away)) {
                if (!(said > 0.0)) said = away;
                vec3 by = -g / (slope * max(length(sum), $MIN_SLOPE)) * sum;
                float vv = dot(sum, sum), uu = dot(v, v), uv = dot(v, sum), det = vv * uu - uv * uv;
                if (steps > 0 && ahead + dot(v, by) > 0.0 && det > $DESCENT_APART * vv * uu)
                    by = ((ahead * uv - g * uu) * sum + (g * uv - ahead * vv) * v) / det;
$if !UNIT_SLOPE
                float size = length(by), most = $DESCENT_REACH * limit * (point ? 1.0 : angle * dot(p - from, l));
                if (steps == 0) {
                    g_last = 0.0;
                    beyond = 0.0;
                }
                if (g_last * g < 0.0) {
                    other = last_p;
                    beyond = g_last;
                }
                vec3 came = p - last_p;
                bool past = steps > 0 && g > 0.0 && g_last > 0.0 && slope > slope_last && dot(sum, came) > 0.0;
                float ratio = g_last * g > 0.0 ? size / stride : 0.0;
                bool far = most > 0.0 && size > most;
                if (far) by *= most / size;
                if (past) by = -0.5 * came;
                stride = past ? 0.5 * length(came) : size;
                if (!past) {
                    last_p = p;
                    g_last = g;
                    slope_last = slope;
                }
                if (!far && !past && steps >= $DESCENT_PLAIN && ratio > $DESCENT_SLOW && ratio < 1.0)
                    by /= max(1.0 - ratio, $DESCENT_FASTEST);
                if (beyond * g < 0.0 && length(by) > $DESCENT_ACROSS * length(other - p))
                    by = clamp(g / (g - beyond), $DESCENT_LEAST, 1.0 - $DESCENT_LEAST) * (other - p);
$end
                p += by;
                v = sum;
                ahead = g + dot(v, by);
            }
            ++steps;
            tap = -1;
            around = vec3(0.0);
            if (!landed) continue;
        }
$if FILMS
        if (beside >= 0) {
            bool inside = f < -thick, halving = beside >= $CIRCLES_LOOKS;
            if (halving) {
                int third = (beside - $CIRCLES_LOOKS) % 3;
                float share = 0.5 * (share_out + share_in);
                if (inside) share_in = share;
                if (inside) angle_in += third == 0 ? 0.0 : third == 1 ? beside_turn : -beside_turn;
                if (!inside && third == 2) share_out = share;
                if (inside || third == 2) beside_turn *= $CIRCLE_NARROWER;
                beside += inside ? 3 - third : 1;
            }
            if (!halving && inside) beside = $CIRCLES_LOOKS;
            if (!halving && inside) share_out = share_in - 1.0 / float($CIRCLES);
            if (!halving && !inside) ++beside;
            if (!halving && !inside && beside == $CIRCLES_LOOKS) return $UNSEEN;
        }
        if (look >= 0 && !none) {
            if (!(f >= -thick)) return least;
            ++look;
            none = look == $FILM_LOOKS;
            if (none) best = p;
        }
        if (look < 0 && !none && !landed) g = f;
        if (look < 0 && !none && found) {
            ++stalls;
            if (g < $FILM_LOWER * before) stalls = 0;
            none = stalls == $FILM_STALLS; // a least value above 0
            if (none) best = p;
            if (none) best_v = v;
            if (none) away_there = abs(g) / max(slope, $MIN_SLOPE);
        }
$else
        if (!landed) g = f;
$end
$if UNIT_SLOPE
        landed = abs(g) < fine * slope;
$end
$if FILMS
        if (!found && !none && (landed || steps >= $DESCENT_STEPS)) {
$else
        if (!found && (landed || steps >= $DESCENT_STEPS)) {
$end
            float x = dot(p - from, l);
            vec3 off = p - from - x * l;
            if (landed && !point && x > last && !returned) { // beyond the light: back along the surface
                vec3 n = v / max(length(v), $MIN_SLOPE);
                vec3 back = l - dot(l, n) * n;
                p += (last - x) / max(dot(back, back), $MIN_SLOPE) * back;
                returned = true;
                steps = 0;
                continue;
            }
            float size = point ? 1.0 : angle * x;
            float offset = landed && (point || x > first && x < last + fine) ? length(off) / size : $UNSEEN;
            bool slide = true, nearer = offset < least;
            if (nearer) {
                vec3 n = v / max(length(v), $MIN_SLOPE);
                float gain = (least - offset) * size;
                least = offset;
                best = p;
$if FILMS
                best_v = v;
                best_way = off;
                best_g = g;
                best_slope = min(max(slope, $MIN_SLOPE), 1.0);
$end
                along = dot(off, n) * n - off;
                slide = length(v) >= $STEADY * slope && min(gain, length(off) - abs(dot(off, n))) > fine &&
                        !(point && length(off) < $NEAR_ENOUGH * said);
            }
            if (!nearer) share *= 0.25;
            slide = slide && slides < (point ? $OCCLUSION_SLIDES : $MOST_SLIDES) && share >= $LEAST_SHARE && share * length(along) > 0.5 * fine;
            if (slide) {
                p = best + share * along;
                steps = 0;
                ++slides;
                continue;
            }
$if FILMS
            none = !landed && !(least < $UNSEEN);
            if (none) best = p;
            if (none) best_v = v;
            if (none) away_there = abs(g) / max(slope, $MIN_SLOPE);
            if (!none && !(least < limit)) return $UNSEEN;
            found = true;
            p = best;
            g = best_g;
            fine_found = fine;
            fine = $FILM_NEAR * thick;
            steps = 0;
            slope = 0.0;
$else
            return least < limit ? least : $UNSEEN;
$end
        }
$if FILMS
        if (found && !none && look < 0) {
            if (!(g > -fine)) return least;
            if (g < fine) look = 0;
            if (look < 0 && steps >= $FILM_STEPS) return least;
            before = g;
        }
        if (look >= 0 && !none) {
            vec3 edge = cross(best_v, best_way);
            if (!(dot(edge, edge) > $FILM_FLAT * dot(best_v, best_v) * dot(best_way, best_way)))
                edge = fathom_perpendicular(best_v);
            edge = normalize(edge);
            vec3 side = normalize(fathom_perpendicular(edge));
            float turn = $FILM_TURN * float(look);
            around = $FILM_LOOK * thick / best_slope * (cos(turn) * side + sin(turn) * cross(edge, side));
            continue;
        }
        if (none) {
            if (beside < 0) {
                float x = dot(best - from, l);
                across = limit * (point ? 1.0 : angle * x);
                if (!(away_there < across && (point || x > first && x < last) && dot(best_v, best_v) > 0.0)) return $UNSEEN;
                vec3 n = normalize(best_v);
                middle = from + x * l;
                float steep = dot(l, n);
                middle += dot(best - middle, n) * (abs(steep) > $CIRCLE_ACROSS ? l / steep : n);
                side_x = normalize(fathom_perpendicular(n));
                side_y = cross(n, side_x);
                behind = (away_there + $FILM_LOOK * thick) * n;
                beside = 0;
            }
            bool ended = beside == $CIRCLES_LOOKS + 3 * $CIRCLE_HALVINGS;
            int third = max(beside - $CIRCLES_LOOKS, 0) % 3;
            float share = ended ? share_in : 0.5 * (share_out + share_in), there = angle_in;
            if (!ended && beside > $CIRCLES_LOOKS) there += third == 0 ? 0.0 : third == 1 ? beside_turn : -beside_turn;
            if (beside < $CIRCLES_LOOKS) {
                share_in = float(1 + beside / (2 * $CIRCLE_LOOKS)) / float($CIRCLES);
                share = share_in;
                angle_in = $CIRCLE_TURN * float(beside % (2 * $CIRCLE_LOOKS) / 2);
                there = angle_in;
                behind = -behind;
            }
            vec3 way = cos(there) * side_x + sin(there) * side_y;
            p = middle + behind + share * across / max(length(way - dot(way, l) * l), $CIRCLE_ACROSS) * way;
            around = vec3(0.0);
            if (ended) {
                float x = dot(p - from, l);
                if (!point && !(x > first && x < last + fine_found)) return $UNSEEN;
                return length(p - from - x * l) / (point ? 1.0 : angle * x);
            }
            continue;
        }
$end
        tap = 0;
        arm = max(fine, $SHADOW_ARM * abs(g) / (slope > 0.0 ? slope : 1.0));
        sum = vec3(0.0);
        bent = -4.0 * g;
        around = arm * fathom_corner(0);
    }
    return least;
}
$end
