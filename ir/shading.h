// The shading model of a picture: the algorithm in prose, and its constants. The GLSL marcher
// (backend-glsl/marcher.cpp) and the CPU one (backend-cpu/trace/march.cpp) follow it line by line
// in float32. Knows no language and no back end. Where rays come from is in view.h.
//
// NAMES
//   f     Scene::distance
//   hit   Scene::hit
//   eps   RenderSettings::epsilon
//
// LENGTHS, computed once a frame (view.h, `frame_of`)
//   slack         float_slack * (|origin| + radius): what float32 cannot tell apart
//   pixel         perspective: the width of a pixel at distance 1; orthographic: everywhere
//   tolerance(t)  perspective:  min(eps, pixel/2)*t + slack
//                 orthographic: min(eps*focus, pixel/2) + slack
//   step(t)       tolerance(t) + normal_slack*slack: the arm of a gradient's taps
//
// GRADIENT of f at p with arm h
//   g = 0.75/h * sum of e_i * f(p + h*e_i), i = 0..3, with the corners of a tetrahedron
//   e = (1,-1,-1), (-1,-1,1), (-1,1,-1), (1,1,1), each / sqrt(3)
//   (the sum of e e^T is 4/3 of the identity). In a loop, so that the shader holds f once.
//   normal = g/|g|; where |g| is 0, minus the ray's direction.
//
// TRUE DISTANCE (semantics.md, 10), so that a bound L does not change the picture
//   near(p, d, h) = d where nothing in the scene is divided by a bound (`Frame::steep` is false),
//   else d / clamp(|gradient(p, h)|, min_slope, 1).
//
// MARCH from `begin` to `end`: enhanced sphere tracing (Balint and Valasek 2018; the fallback is
// that of Keinert et al. 2014)
//   t = begin, before = 0, stride = 0; at most max_steps times while t <= end + slack:
//     d = f(o + t*dir)
//     reach = tolerance(t); in the last iteration the pixel's width there, if that is more
//     if stride > before + max(d, 0) and it is not the last iteration: the last two spheres do
//       not overlap, so something may lie between them. Go back to the first sphere's edge:
//       t += before - stride, stride = before, and go on with the next iteration
//     if d <= reach and (not steep or near(p, d, step(t)) <= reach): a hit at t + d
//     d = max(d, slack/4), never less than float32 can move
//     next = d
//     if stride > 0: assume that f goes on along the ray as straight as over the last stride. The
//       sphere that would touch this one has the radius d*(stride + d - before)/(stride - d +
//       before): add relaxation times that (numerator at least 0, denominator at least
//       flattest*stride)
//     never past the end unproved, rounding or not: proved = max(end, t + d),
//     next = min(next, proved - t), before = d, stride = next, t = min(t + next, proved)
//   Out of steps or of way: a miss.
//
//   `begin` and `end`: with a box (`Frame::boxed`) its entry and exit, clipped to 0..far;
//   else 0..far.
//
//   BY CURVATURE, where the scene has Scene::safe_radius, which gives d and a span >= d (lipschitz.md,
//   4): between two samples outside the solid nothing lies where the stride is at most the
//   sum of their spans, though the balls do not touch. `reached` is the span of `before`, 0 at
//   first.
//     where the last two spheres do not overlap:
//       d > 0 and stride <= reached + span: no matter
//       else go back to where the next sample, that in between being likely, will do:
//         d > 0:  back = reached + nearer*min(span, reached)
//         d <= 0: back = where the chord from before to d is 0, less tolerance(t)/2, never beyond
//                 `reached`
//         t += back - stride, stride = back
//     next, where span > d: span. If stride > 0, span^2 (2/M times the field) goes on as straight
//       as over the last stride, change = (span^2 - reached^2)/stride a unit: the next sample will
//       do at span + bent_relaxation*(span + change). Where change < -span the surface comes first,
//       and what leads to it is free: -span^2/change - tolerance(t)/2. Never less than d.
//     span = max(span, d); reached = span with before = d
//
// SHADING at the hit point p = o + t*dir, h = step(t), n = normal(p, h), v = -dir
//   s = hit(p); the surface is s.paint (below 0: the last one); its material is evaluated at
//   (s.point, n', s.extra), where n' is the normal in the paint's space:
//   hit(p + h*n).point - s.point, normalised (n where that is 0).
//   With Lighting::skip: color = diffuse + emission. Else Phong (thesis, 2.1), with the light's
//   visibility:
//     color = ao * diffuse * ambient + emission
//           + sum over lights of seen * light color
//             * (diffuse * max(n.l, 0) + specular_intensity * specular * max(r.v, 0)^exponent)
//     r     l mirrored in n
//     seen  1 - shadow_darkness * (1 - shadow)
//     ao    1 - ambient_occlusion * occlusion
//   Lights with n.l <= 0 add nothing. A sun's l is its direction; else l points from p to its
//   place. What is closed in sees less of the sky, so `ao` dims the ambient light alone; how much
//   of a light arrives is for `seen` to say, which never makes a contact black (thesis, 4.2.1 has
//   both).
//
// OCCLUSION (thesis, 4.2.1: five samples along the normal)
//   for i = 1..5, x = occlusion_reach*radius*i/5:
//     sum of 2^-i * clamp(1 - near(p + x*n, f(p + x*n), h)/x, 0, 1), divided by the sum of the 2^-i
//
// SHADOW (thesis, 4.2.1: from the light towards the point, so that no ray has to leave a surface
// slowly)
//   q = p + shadow_bias*tolerance(t)*n
//   reach = the light's distance from q; for a sun, the way from q out of the box along l, or `far`
//   without a box
//   angle = max(soft_shadows, min_angle): half the light's angular size
//   s = reach (what is left of the way), before = 0, shadow = 1; at most shadow_steps times while
//   s > shadow_bias*tolerance(t):
//     d = f(q + s*l); if d < shadow*angle*s: d' = near(q + s*l, d, h), else d' = d
//     y = before > 0 ? d'^2/(2*before') : 0: how far behind lies the nearest point of what two
//       spheres in a row touch (both normalised alike: before' = before*d'/d)
//     c = sqrt(max(d'^2 - y^2, 0))
//     shadow = min(shadow, c/(angle*(s + y))); if d' <= 0 or shadow < 1/256: 0, done
//     before = d, s -= max(d, slack/4)
//   result: shadow^2*(3 - 2*shadow)
//
// MISS: color = background_function(dir); without one `background`.
// Out: linear; samples of a pixel are averaged linear; then clamped to 0..1 and sRGB-encoded.
#pragma once

#include <array>

namespace fathom::ir::shading {

inline constexpr float float_slack = 1e-6f;
inline constexpr float normal_slack = 50;
inline constexpr float min_slope = 1.0f / 1024;
inline constexpr float relaxation =
    0.9f; // performance.md, 2: best of those measured on scenes with L = 1
inline constexpr float flattest = 1e-3f;
inline constexpr float bent_relaxation = 0.7f; // measured on displaced spheres, as these
inline constexpr float nearer = 0.9f;
inline constexpr int occlusion_samples = 5;
inline constexpr float occlusion_reach = 0.08f;
inline constexpr int shadow_steps = 128;
inline constexpr float shadow_bias = 4;
inline constexpr float min_angle = 0.002f; // a hard shadow's edge, soft enough not to flicker
inline constexpr std::array<float, 3> background{0.35f, 0.45f, 0.6f};

} // namespace fathom::ir::shading
