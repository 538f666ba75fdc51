$# Ray marching by ir/shading.h (LENGTHS, TRUE DISTANCE, MARCH), which explains; the sibling of
$# backend-cpu/trace/march.cpp. The scene: float sdf(vec3), and with HAS_SAFE_RADIUS vec2 fathom_safe_radius(vec3).

// ---- how rays are marched and points are shaded ----

float fathom_slack, fathom_pixel, fathom_far, fathom_tolerance_base, fathom_tolerance_slope;
int fathom_steps = 0;
int fathom_paint = -2; // of what the ray hit

void fathom_lengths() {
    fathom_slack = $FLOAT_SLACK * (length(fathom_origin) + $RADIUS);
    fathom_pixel = 2.0 * fathom_extent / fathom_resolution.y;
    fathom_far = $FAR;
    bool parallel = fathom_orthographic != 0;
    fathom_tolerance_base = (parallel ? min($EPSILON * fathom_focus, 0.5 * fathom_pixel) : 0.0) + fathom_slack;
    fathom_tolerance_slope = parallel ? 0.0 : min($EPSILON, 0.5 * fathom_pixel);
}

float fathom_tolerance(float t) {
    return fathom_tolerance_base + fathom_tolerance_slope * t;
}

float fathom_arm(float t) {
    return fathom_tolerance(t) + $NORMAL_SLACK * fathom_slack;
}
$if HAS_SAFE_RADIUS

float fathom_span; // how far the last of the distances reaches
$end
$if STEEP
$include corner

// The field at p in d; and, where that is at most `limit`, the true distance |f| / |grad f|, since
// the field was divided by a bound; else d again.
$if APART
float fathom_near(vec3 p, float h, float limit, out float d) {
$if HAS_SAFE_RADIUS
    vec2 f = fathom_safe_radius(p);
    d = f.x;
    fathom_span = f.y;
$else
    d = sdf(p);
$end
    if (!(d <= limit)) return d;
    vec3 sum = vec3(0.0);
    for (int i = $ZERO; i < 4; ++i) {
        vec3 e = fathom_corner(i);
        sum += e * sdf(p + h * e);
    }
    return d / clamp(length(0.75 / h * sum), $MIN_SLOPE, 1.0);
}
$else
float fathom_near(vec3 p, float h, float limit, out float d) {
    vec3 sum = vec3(0.0);
    for (int i = $ZERO; i < 5$AND_PRESENT; ++i) {
        vec3 e = i == 0 ? vec3(0.0) : fathom_corner(i - 1);
$if HAS_SAFE_RADIUS
        vec2 both = fathom_safe_radius(p + h * e);
        float f = both.x;
$else
        float f = sdf(p + h * e);
$end
        if (i == 0) {
            d = f;
$if HAS_SAFE_RADIUS
            fathom_span = both.y;
$end
            if (!(d <= limit)) return d;
            continue;
        }
        sum += e * f;
    }
    return d / clamp(length(0.75 / h * sum), $MIN_SLOPE, 1.0);
}
$end
$end
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

// Enhanced sphere tracing. The distance of the hit along the ray, or -1.
float fathom_march(vec3 origin, vec3 direction, float begin, float end) {
    float t = begin;
    float before = 0.0;
    float stride = 0.0;
    float d = 0.0;
$if HAS_SAFE_RADIUS
    float reached = 0.0;
$end
    int steps = 0;
$if CACHED
$# What was reached by curvature is not remembered: 0 proves less, and costs a step.
    fathom_resume(t, before, stride, steps);
$end
    for (; steps < $MAX_STEPS && t <= end + fathom_slack; ++steps) {
$if FAR_CELLS
$# Through far cells first, all rays together; then the field is evaluated, once. A step is
$# what evaluates it.
        while (t <= end) {
            vec2 clear = fathom_clear(origin + t * direction, direction, fathom_tolerance(t));
            if (!(clear.y > 0.0 && stride <= before + clear.x)) break;
            t += clear.y;
            before = 0.0;
            stride = 0.0;
        }
        if (t > end + fathom_slack) break;
$end
        vec3 p = origin + t * direction;
        bool last = steps == $MAX_STEPS - 1;
        float reach = fathom_tolerance(t);
        if (last) reach = max(reach, fathom_orthographic != 0 ? fathom_pixel : fathom_pixel * t);
$if CACHED
        fathom_width = fathom_orthographic != 0 ? fathom_pixel : fathom_pixel * t;
        fathom_step(t, before, stride, steps);
$end
$if STEEP
        float near = fathom_near(p, fathom_arm(t), reach, d);
$else
        d = sdf(p);
$end
$if CACHED
$# Where a cached value is absent the pixel is left to the text that computes all, so that
$# what the ray sees is one field (docs/noise-cache.md): its loops end at once.
        if (fathom_absent) break;
$end
$if HAS_SAFE_RADIUS
        if (!last && stride > before + max(d, 0.0) && !(d > 0.0 && stride <= reached + fathom_span)) {
            float to = reached + $NEARER_PART * min(fathom_span, reached);
            if (!(d > 0.0)) to = min(reached, stride * before / (before - d) - 0.5 * fathom_tolerance(t));
            to = max(before, min(to, stride));
            t += to - stride;
            stride = to;
            continue;
        }
$else
        if (!last && stride > before + max(d, 0.0)) {
            t += before - stride;
            stride = before;
            continue;
        }
$end
        if ($NEAR <= reach) {
            fathom_steps = steps + 1;
            return t + d;
        }
        d = max(d, 0.25 * fathom_slack);
        float next = d;
$if HAS_SAFE_RADIUS
        float span = max(fathom_span, d);
        if (span > d) {
            next = span;
            if (stride > 0.0) {
                float change = (span * span - reached * reached) / stride;
                next = change < -span ? span * span / -change - 0.5 * fathom_tolerance(t)
                                      : span + $BENT_RELAXATION * (span + change);
                next = max(next, d);
            }
        } else
$end
        if (stride > 0.0)
            next += $RELAXATION * d * max(stride + d - before, 0.0) / max(stride - d + before, $FLATTEST * stride);
        float proved = max(end, t + d);
        next = min(next, proved - t);
        before = d;
$if HAS_SAFE_RADIUS
        reached = span;
$end
        stride = next;
        t = min(t + next, proved);
    }
    fathom_steps = steps;
    return -1.0;
}
