$# Shading by ir/shading.h (OCCLUSION, SHADING); the sibling of backend-cpu/trace/shade.cpp. After `shadow`.
$# The scene: float $SHADED(vec3), Hit fathom_hit(vec3), fathom_material, fathom_lighting, fathom_light (marcher.h).

vec3 fathom_shade(vec3 origin, vec3 direction, float t) {
    vec3 p = origin + t * direction;
    float h = fathom_arm(t);
    vec3 above = p - $LIFT * h * direction;
    vec3 g = vec3(0.0);
    vec3 n = -direction;
$# even: less than 1 at an edge.
    float slope = 0.0, even = 1.0;
$if MANY_SLOPES
    float bent = 0.0, own = 1.0; // what rises as the surface itself does is open
    bool behind = false, lifted = false; // the taps: in the solid; further in front of it
$# Of the surface beside the point: how far along the ray it is looked at, in BESIDE_ARMS.
    float low = 0.0, high = 0.0, here = -$BESIDE_REACH, middle = 0.0;
    bool found = false;
    vec2 rise = vec2(0.0), rises = vec2(0.0); // by axis: what was found, and how often
$end
    int surface = $SURFACE_TAPS, samples = 0; // points about it, and along the normal
$if !SKIP_SHADING
    fathom_Lighting look = fathom_lighting();
    float open = 1.0;
    float weight = look.ambient_occlusion / $OCCLUSION_TOTAL;
    float reach = look.occlusion_reach;
    if (!(reach > 0.0)) reach = $OCCLUSION_REACH * fathom_extent * (fathom_orthographic != 0 ? 1.0 : fathom_focus);
    reach /= $OCCLUSION_SAMPLES;
    if (look.ambient_occlusion > 0.0) samples = $OCCLUSION_TAPS;
$if PASSES
    if (fathom_light_kept >= 0) samples = 0; // the colour is known
$end
$end
$# The gradient's four points, their middle where slopes differ, and the surface beside where it is faint. Then,
$# along the normal, the occlusion's five.
$if APART
    for (int i = $ZERO; i < surface$AND_PRESENT; ++i) {
        vec3 e = fathom_corner(i & 3) * float(i < 4);
        vec3 place = above + h * e;
$if MANY_SLOPES
        if (i >= $SURFACE_TAPS)
            place = p + $BESIDE_ARMS * h * (fathom_beside((i - $SURFACE_TAPS) / $BESIDE_LOOKS, direction) + here * direction);
$end
        float f = $SHADED(place);
        {
$include surface_tap
        }
    }
    int done = surface;
$else
    int done = 0;
$end
$if !SKIP_SHADING
    for (int i = $ZERO + done; i < surface + samples$AND_PRESENT; ++i) {
        bool outward = i >= surface;
        float away = reach * float(i - surface + 1), free = $NEARLY * away;
        vec3 e = fathom_corner(i & 3) * float(i < 4);
        vec3 place = outward ? p + away * n : above + h * e;
$if MANY_SLOPES
        if (!outward && i >= $SURFACE_TAPS)
            place = p + $BESIDE_ARMS * h * (fathom_beside((i - $SURFACE_TAPS) / $BESIDE_LOOKS, direction) + here * direction);
$end
        float f = $SHADED(place);
        if (!outward) {
$include surface_tap
            continue;
        }
        weight *= 0.5;
$if !EXACT
$if MANY_SLOPES
        own = max(own, f / away);
        if (f >= own * free) continue;
$else
        if (f >= free) continue;
$end
        int looks = 0;
        if (f >= 0.0)
            f = fathom_nearest(place, vec3(0.0), place, f, 0.0, 0.0, 0.0, max(h, $OCCLUSION_FINE / weight * away),
                               0.25 * fathom_slack_at(t), free, looks);
$if PASSES
        fathom_taken += looks;
$end
$end
        open -= weight * clamp(1.0 - f / free, 0.0, 1.0);
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
    fathom_pick.w = fathom_end == 2 ? -1.0 : slope;
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
    vec3 around = look.ambient;
$if !CLASSIC
    around *= mix($SOIL, $SKY, 0.5 + 0.5 * n.y);
$end
    vec3 color = open * m.diffuse * (around + look.fill * max(-dot(n, direction), 0.0)) + m.emission;
    float margin = $SHADOW_BIAS * fathom_tolerance(t);
    vec3 q = p + margin * n;
    float angle = max(look.soft_shadows, $MIN_ANGLE);
$if PASSES
    if (fathom_light_kept >= 0) color = fathom_kept(fathom_kept_2).rgb;
$end
$if ONE_LIGHT
    {
        const int i = 0;
$else
$if PASSES
    for (int i = $ZERO + max(fathom_light_kept, 0); i < $LIGHTS; ++i) {
$else
    for (int i = $ZERO; i < $LIGHTS; ++i) {
$end
$end
        fathom_Light light = fathom_light(i);
        vec3 way = light.position;
        if (!light.directional) way -= q;
        float away = length(way);
        vec3 l = n;
        if (away > 0.0) l = way / away;
        float facing = dot(n, l);
        if (facing <= 0.0) $UNLIT;
        float seen = 1.0;
        if (look.shadow_darkness > 0.0) {
            float reach = mix(away, $SUN_REACH, light.directional);
            seen -= look.shadow_darkness * (1.0 - fathom_shadow(q, l, reach, angle, margin, h));
$if PASSES
            if (fathom_goes_on) {
                fathom_keep_0.x = t;
                fathom_keep_2 = vec4(color, 0.0);
                fathom_keep_3.xzw = vec3(float(fathom_steps), float(i),
                                         (fathom_end == 2 ? 1.0 : 0.0) + (fathom_shadow_undecided ? 2.0 : 0.0) +
                                             (fathom_passed ? 4.0 : 0.0) + (fathom_close ? 8.0 : 0.0));
                return color;
            }
$end
        }
        vec3 r = 2.0 * facing * n - l;
        float gleam = max(-dot(r, direction), 0.0);
        float exponent = m.exponent * even / (even + m.exponent * (1.0 - even));
        if (gleam > 0.0) gleam = look.specular_intensity * (1.0 + exponent) / (1.0 + m.exponent) * pow(gleam, exponent);
        color += seen * light.color * (facing * m.diffuse + gleam * m.specular);
    }
    return color;
}
$end
