$# Shading by ir/shading.h (OCCLUSION, SHADING); the sibling of backend-cpu/trace/shade.cpp. After `shadow`.
$# The scene: float $SHADED(vec3), Hit fathom_hit(vec3), fathom_material, fathom_lighting, fathom_light (marcher.h).

vec3 fathom_shade(vec3 origin, vec3 direction, float t) {
    vec3 p = origin + t * direction;
    float h = fathom_arm(t);
    vec3 above = p - $LIFT * h * direction;
    vec3 g = vec3(0.0);
    vec3 n = -direction;
    float slope = 0.0;
    int taps = 4;
$if !SKIP_SHADING
    fathom_Lighting look = fathom_lighting();
    float open = 1.0;
    float weight = look.ambient_occlusion / $OCCLUSION_TOTAL;
    float reach = look.occlusion_reach;
    if (!(reach > 0.0)) reach = $OCCLUSION_REACH * fathom_extent * (fathom_orthographic != 0 ? 1.0 : fathom_focus);
    reach /= $OCCLUSION_SAMPLES;
    if (look.ambient_occlusion > 0.0) taps = $ALL_TAPS;
$if PASSES
    if (fathom_light_kept >= 0) taps = 4; // the colour is known
$end
$end
$if TWICE
    for (int i = $ZERO; i < 4; ++i) {
        vec3 e = fathom_corner(i);
        g += e * $SHADED(above + h * e);
    }
    g *= 0.75 / h;
    slope = length(g);
    if (slope > 0.0) n = g / slope;
    int done = 4;
$else
    int done = 0;
$end
$# The gradient's four points; along the normal that they give, the occlusion's five; and where these
$# are closed most, the gradient again.
$if !SKIP_SHADING
    vec3 sum = vec3(0.0), towards = vec3(0.0);
    float least = 1e30, x = 0.0;
    float g1 = 0.0, g2 = 0.0, g3 = 0.0, g4 = 0.0, g5 = 0.0; // over their distances from p
    for (int i = $ZERO + done; i < taps$AND_PRESENT; ++i) {
        bool outward = i > 3 && i < 9;
        float away = mix(x, reach * float(i - 3), outward);
        vec3 place = mix(p + away * n, above, float(i < 4));
        vec3 e = fathom_corner(i - 9 * int(i > 3));
        if (!outward) place += h * e;
        float f = $SHADED(place);
        if (outward) {
            f /= away;
            g1 = g2;
            g2 = g3;
            g3 = g4;
            g4 = g5;
            g5 = f;
            if (f < least) {
                least = f;
                x = away;
            }
$if CLOSEST
$if !SHADED_APART
            if (i == 8 && least >= $NEARLY) break;
$end
$end
            continue;
        }
        sum += f * e;
$if CLOSEST
        if (i == 12) towards = 0.75 / h * sum;
$end
$if !TWICE
        if (i == 3) {
            g = 0.75 / h * sum;
            slope = length(g);
            if (slope > 0.0) n = g / slope;
            sum = vec3(0.0);
        }
$end
    }
$if UNIT_SLOPE
    float rise = 1.0;
$else
    float rise = length(towards);
    rise = $FLAT ? 1.0 : max(max(rise, min(slope, 1.0)), $MIN_SLOPE);
$end
    if (taps > 4) {
        vec4 rises = vec4(g1, g2, g3, g4), slopes = vec4(rise);
        float slope5 = rise;
$if !UNIT_SLOPE
$# What rises as the surface itself does is open, whatever the slope of what closes most.
        vec4 own = max(rises, max(slope, $MIN_SLOPE));
        own.y = max(own.x, own.y);
        own.zw = max(own.zw, own.y);
        own.w = max(own.z, own.w);
        float own5 = max(own.w, g5);
        slopes += min(own - rise, 0.0) * clamp(rises / own, 0.0, 1.0);
        slope5 += min(own5 - rise, 0.0) * clamp(g5 / own5, 0.0, 1.0);
$end
        vec4 closed = clamp(1.0 - rises / slopes, 0.0, 1.0);
        float closed5 = clamp(1.0 - g5 / slope5, 0.0, 1.0);
$if FILMS
        vec3 across = abs(towards.x) < abs(towards.y) ? vec3(0.0, towards.z, -towards.y) : vec3(-towards.z, 0.0, towards.x);
        bool on_film = dot(across, across) > 0.0;
        vec3 film = p + x * n;
        if (on_film) {
            film -= least * x / (rise * length(towards)) * towards;
            on_film = fathom_film(film, normalize(across), 0.25 * fathom_slack_at(t));
        }
        if (on_film) {
            vec4 ways = reach * vec4(1.0, 2.0, 3.0, 4.0);
            float way5 = 5.0 * reach;
            float off = dot(p - film, towards), turn = dot(n, towards);
            closed *= clamp($FILM_APART * (1.0 - ways * rises / max(abs(off + turn * ways), 1e-30)), 0.0, 1.0);
            closed5 *= clamp($FILM_APART * (1.0 - way5 * g5 / max(abs(off + turn * way5), 1e-30)), 0.0, 1.0);
        }
$end
        open -= weight * (dot(closed, vec4(0.5, 0.25, 0.125, 0.0625)) + 0.03125 * closed5);
    }
$else
$if !TWICE
    for (int i = $ZERO; i < taps$AND_PRESENT; ++i) g += fathom_corner(i) * $SHADED(above + h * fathom_corner(i));
    g *= 0.75 / h;
    slope = length(g);
    if (slope > 0.0) n = g / slope;
$end
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
        if (gleam > 0.0) gleam = look.specular_intensity * pow(gleam, m.exponent);
        color += seen * light.color * (facing * m.diffuse + gleam * m.specular);
    }
    return color;
}
$end
