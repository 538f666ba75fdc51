$# The slice and the check of steps (marcher.h). The check walks the same field at a tenth of the
$# step. Where the field's slope is at most ten times what was promised, it cannot pass a surface
$# even if the promise is broken; so a march that met nothing before the point where the check
$# stands inside overstepped. Steps shorter than half the tolerance find nothing that counts.

layout(location = 0) out vec4 fathom_color;
layout(location = 1) out vec4 fathom_pick;
uniform vec4 fathom_plane;

vec4 fathom_slice(vec3 origin, vec3 direction) {
    float along = dot(fathom_plane.xyz, direction);
    if (abs(along) < 1e-6) return vec4(0.0);
    float t = (fathom_plane.w - dot(fathom_plane.xyz, origin)) / along;
    if (t <= 0.0 || t > fathom_far) return vec4(0.0);
$if AROUND
    fathom_exact = true;
$end
    return vec4(sdf(origin + t * direction), t, 0.0, 1.0);
}

vec4 fathom_check(vec3 origin, vec3 direction, float begin, float end) {
    if (end < begin) return vec4(0.0, -1.0, -1.0, 0.0);
    float t = fathom_march(origin, direction, begin, end);
    float verdict = fathom_end == 2 ? 2.0 : 0.0;
    float s = begin;
    float last = t < 0.0 ? end : t;
    int i = 0;
    for (; i < $CHECK_STEPS && s <= last; ++i) {
        float d = sdf(origin + s * direction);
        if (d < -2.0 * fathom_slack) {
            bool passed = t < 0.0 || t > s + 2.0 * fathom_tolerance(s);
            return vec4(passed && verdict == 0.0 ? 1.0 : verdict, t, s, float(fathom_steps));
        }
        s += max(0.1 * d, 0.5 * fathom_tolerance(s));
    }
    if (verdict == 0.0 && i == $CHECK_STEPS) verdict = 3.0;
    return vec4(verdict, t, -1.0, float(fathom_steps));
}

void main() {
    vec2 place = vec2(gl_FragCoord.x, fathom_resolution.y - gl_FragCoord.y) + fathom_offset - 0.5;
$include ray
    fathom_color = vec4(0.0);
    fathom_pick = fathom_mode == 4 ? fathom_slice(origin, direction) : fathom_check(origin, direction, begin, end);
}
