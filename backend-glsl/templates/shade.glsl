$# Shading by ir/shading.h (SHADOW, OCCLUSION, SHADING); the sibling of backend-cpu/trace/shade.cpp.
$# The scene: Hit fathom_hit(vec3), fathom_material, fathom_lighting, fathom_light (marcher.h).
$if !SKIP_SHADING

// How much of a light arrives: marched from the light towards the point (thesis, 4.2.1).
float fathom_shadow(vec3 q, vec3 l, float reach, float angle, float margin, float h) {
    float s = reach;
    float before = 0.0;
    float shadow = 1.0;
    for (int i = $ZERO; i < $SHADOW_STEPS && s > margin; ++i) {
$if FAR_CELLS
$# What is farther than the shadow's edge as it is now changes nothing.
        for (vec2 clear; s > margin; s -= clear.y) {
            clear = fathom_clear(q + s * l, -l, max(shadow * angle * s, margin));
            if (!(clear.y > 0.0)) break;
            before = 0.0;
        }
        if (s <= margin) break;
$end
        vec3 p = q + s * l;
$if AROUND
$# Beyond the cells a value that is not exact shades nothing.
        if (fathom_outside(p)) {
            float off = fathom_off(p);
            float edge = max(shadow * angle * s, margin);
            if (off > 2.0 * edge && off < fathom_endless(p)) {
                s -= off - edge;
                before = 0.0;
                continue;
            }
        }
        fathom_exact = true;
$end
$if STEEP
        float d, near = fathom_near(p, h, shadow * angle * s, d);
$else
        float d = sdf(p), near = d;
$end
$if AROUND
        fathom_exact = false;
$end
$if CACHED
        if (fathom_absent) break;
$end
        float y = before > 0.0 ? 0.5 * near * d / before : 0.0;
        float c = sqrt(max(near * near - y * y, 0.0));
        shadow = min(shadow, c / (angle * (s + y)));
        if (near <= 0.0 || shadow < 0.00390625) return 0.0;
        before = d;
        s -= max(d, 0.25 * fathom_slack);
    }
    return shadow * shadow * (3.0 - 2.0 * shadow);
}
$end

vec3 fathom_shade(vec3 origin, vec3 direction, float t) {
    vec3 p = origin + t * direction;
    float h = fathom_arm(t);
    vec3 g = vec3(0.0);
    vec3 n = -direction;
    float slope = 0.0;
$if !SKIP_SHADING
$# The weights of the occlusion's samples are 1/2, 1/4, ...
    fathom_Lighting look = fathom_lighting();
    int taps = look.ambient_occlusion > 0.0 ? $ALL_TAPS : 4;
    float open = 1.0;
    float weight = look.ambient_occlusion / $OCCLUSION_TOTAL;
$end
$if APART
    for (int i = $ZERO; i < 4; ++i) {
        vec3 e = fathom_corner(i);
        g += e * sdf(p + h * e);
    }
    g *= 0.75 / h;
    slope = length(g);
    if (slope > 0.0) n = g / slope;
$if !SKIP_SHADING
    for (int i = $ZERO + 4; i < taps; ++i) {
$if STEEP
        float x = $OCCLUSION_REACH * float(i - 3), d;
        float near = fathom_near(p + x * n, h, x, d);
$else
        float x = $OCCLUSION_REACH * float(i - 3);
        float near = sdf(p + x * n);
$end
        weight *= 0.5;
        open -= weight * clamp(1.0 - near / x, 0.0, 1.0);
    }
$end
$else
$# The gradient's four points and, along the normal that they give, the occlusion's five.
$if SKIP_SHADING
    for (int i = $ZERO; i < 4$AND_PRESENT; ++i) {
        vec3 e = fathom_corner(i);
        float f = sdf(p + h * e);
$else
    for (int i = $ZERO; i < taps$AND_PRESENT; ++i) {
        vec3 e = fathom_corner(i);
$if STEEP
        float x = $OCCLUSION_REACH * float(i - 3), d;
        float f = fathom_near(p + (i < 4 ? h * e : x * n), h, i < 4 ? -1e30 : x, d);
$else
        float x = $OCCLUSION_REACH * float(i - 3);
        float f = sdf(p + (i < 4 ? h * e : x * n));
$end
        if (i >= 4) {
            weight *= 0.5;
            open -= weight * clamp(1.0 - f / x, 0.0, 1.0);
            continue;
        }
$end
        g += e * f;
        if (i < 3) continue;
        g *= 0.75 / h;
        slope = length(g);
        if (slope > 0.0) n = g / slope;
    }
$end
$if LOCAL_NORMALS
$# The normal in the paint's own space.
    Hit s;
    vec3 ahead = vec3(0.0);
    for (int i = $ZERO + 1; i >= 0; --i) {
        s = fathom_hit(p + float(i) * h * n);
        if (i == 1) ahead = s.point;
    }
$else
    Hit s = fathom_hit(p);
$end
    fathom_paint = s.paint;
$if PICK
    fathom_pick.x = float(fathom_part);
    fathom_pick.w = slope;
$end
$if LOCAL_NORMALS
    vec3 turned = ahead - s.point;
    float size = length(turned);
    fathom_Material m = fathom_material(s, size > 0.0 ? turned / size : n);
$else
    fathom_Material m = fathom_material(s, n);
$end
$if SKIP_SHADING
    return m.diffuse + m.emission;
}
$else
    vec3 color = open * m.diffuse * look.ambient + m.emission;
    float margin = $SHADOW_BIAS * fathom_tolerance(t);
    vec3 q = p + margin * n;
    float angle = max(look.soft_shadows, $MIN_ANGLE);
$if ONE_LIGHT
    {
        fathom_Light light = fathom_light(0);
$else
    for (int i = $ZERO; i < $LIGHTS; ++i) {
        fathom_Light light = fathom_light(i);
$end
        vec3 way = light.directional ? light.position : light.position - q;
        float away = length(way);
        vec3 l = away > 0.0 ? way / away : n;
        float facing = dot(n, l);
        if (facing <= 0.0) $UNLIT;
        float seen = 1.0;
        if (look.shadow_darkness > 0.0) {
            float reach = light.directional ? $SUN_REACH : away;
            seen -= look.shadow_darkness * (1.0 - fathom_shadow(q, l, reach, angle, margin, h));
        }
        vec3 r = 2.0 * facing * n - l;
        float gleam = max(-dot(r, direction), 0.0);
        gleam = gleam > 0.0 ? look.specular_intensity * pow(gleam, m.exponent) : 0.0;
        color += seen * light.color * (facing * m.diffuse + gleam * m.specular);
    }
    return color;
}
$end
