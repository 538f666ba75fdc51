// The shading model of a picture: the algorithm in prose, and its constants. The GLSL marcher
// (backend-glsl/marcher.cpp) and the CPU one (backend-cpu/trace/march.cpp) follow it line by line
// in float32. Knows no language and no back end. Where rays come from is in view.h.
//
// NAMES
//   f     Scene::distance
//   g     Scene::shaded: the same surface, and no bound divides it
//   hit   Scene::hit
//   eps   RenderSettings::epsilon
//
// LENGTHS, computed once a frame (view.h, `frame_of`)
//   slack         float_slack * |origin|: what float32 cannot tell apart
//   slack(t)      slack + float_slack*t: the same at t along a ray
//   pixel         perspective: the width of a pixel at distance 1; orthographic: everywhere
//   tolerance(t)  perspective:  min(eps, pixel/2)*t + slack
//                 orthographic: min(eps*extent/usual_extent, pixel/2) + slack: as a perspective
//                 camera of the usual angle of view that sees as much, however far off this one is
//   step(t)       arm*tolerance(t) + min(normal_slack*(slack + float_slack*radius), widest*width(t)),
//                 with the width of a pixel at t: the arm of a gradient's taps, so short that they
//                 seldom lie on both sides of an edge. What is large and near, as a ball for a ground,
//                 has a rounding of its size; but a part far away must not blur what is seen
//
// GRADIENT of g at p with arm h
//   sum of e_i * g(p + h*e_i) times 0.75/h, i = 0..3, with the corners of a tetrahedron
//   e = (1,-1,-1), (-1,-1,1), (-1,1,-1), (1,1,1), each / sqrt(3)
//   (the sum of e e^T is 4/3 of the identity). In a loop, so that the shader holds g once.
//   normal = gradient/|gradient|; where that is 0, minus the ray's direction.
//   A field of odd order, as u^3, or u^3 - v^3 where both are 0, has no gradient on its surface, and
//   the taps' differ as the corners do, not as the surface. Where slopes differ and |gradient| is below
//   `faint`, the normal is that of the surface about p: along the ray and along rays that are `beside`
//   arms away, to and fro along two axes a and b across it, a change of sign within beside_reach times
//   that is halved; r_a is how much further it is to than at the ray itself, over `beside` arms, a mean
//   of to and (negated) fro where both are found, and normal = a*r_a + b*r_b - dir, normalised. Where
//   r_a or r_b is not found it is the gradient's.
//   A field may be steeper inside the solid than outside, or less steep. Where slopes differ, a tap is
//   below 0, and slope^2 - |gradient|^2 is above kinked*slope^2 (TRUE DISTANCE), both are taken anew,
//   lift*h further out along the normal, so that no tap is inside.
//
// TRUE DISTANCE (semantics.md, 10), which knows of no bound
//   near(p, h) = g(p) where the slope of g is 1 almost everywhere (`Frame::unit_slope`),
//   else g(p) / max(slope, min_slope), slope^2 = |gradient(p, h)|^2 + crease*((m - g(p))/h)^2, where m is
//   the mean of g at the gradient's taps. Across a crease of two parts the taps' gradient is the mean
//   of both, and too small; what it lacks lies across, and lifts m: exactly so where both are as steep,
//   p is on the crease, and it is along an axis. Where the arm was longer than what is found is far
//   (a field may say many times the distance), it is found anew, with shadow_arm times that.
//
// MARCH from `begin` to `end`: enhanced sphere tracing (Balint and Valasek 2018; the fallback is
// that of Keinert et al. 2014). A ray ends in a hit (a change of sign), in a miss (all of its way is
// free) or undecided (the budget of evaluations is spent).
//   t = begin, before = 0, stride = 0, touches = 0, aims = false; while t <= end + slack:
//     the budget is spent: undecided at t
//     d = f(o + t*dir)
//     while it touches (TOUCHES), and where d <= 0 and not below -slack(t)/4, TOUCHES says what is next
//     if d < -slack(t)/4 and aims: a hit between t - stride and t (REFINED); where d is 0, that may be
//       the far side of something thin
//     if stride > before + max(d, 0): the last two spheres do not overlap, so something may lie
//       between them. Go back to the first sphere's edge: t += before - stride, stride = before,
//       aims = false, and go on with the next iteration
//     if d <= 0: a hit between t - stride and t (REFINED)
//     where Frame::estimate > 0, if d < slack(t)/4, or d < before and estimate*d < tolerance(t) for
//       the nearing-th time in a row: a hit at t - tolerance(t)/2, from where a gradient does not
//       cross the surface (ESTIMATES)
//     if d < slack(t)/4: it touches
//     next = d, aims = false
//     if stride > 0: assume that f goes on along the ray as straight as over the last stride. The
//       sphere that would touch this one has the radius d*(stride + d - before)/(stride - d +
//       before): add relaxation times that (numerator at least 0, denominator at least
//       flattest*stride). And where before > d: to = d*stride/(before - d) is the way to where that
//       line is 0. If to + tolerance(t)/4 <= jump*tolerance(t): next = max(d, to + tolerance(t)/4),
//       aims = true, so that the sign changes
//     never past the end unproved, rounding or not: proved = max(end, t + d),
//     next = min(next, proved - t), before = d, stride = next, t = min(t + next, proved)
//   Out of way: a miss.
//
//   REFINED: x is where the chord between the ends is 0. If the last step aims and x is at most
//   refined*tolerance from t - tolerance/4, where it aimed at, f(x - tolerance/4) takes the place of
//   the end with its sign, and the ray lands at x where that is above 0: else something lies before,
//   as the wall does before the floor that is under it, too. In all other cases, at most
//   `refinements` times: f(x) takes the place of the end with its sign (and where one end stays twice
//   in a row, its value counts half: the Illinois rule), x is found anew, and where it moved by at
//   most refined*tolerance, or the ends are as near, the ray lands there. So where a ray lands does not
//   depend on where its samples fell.
//
//   TOUCHES: the solid is the closure of {f < 0}. Where a cut ends in the plane of what it cuts, f is 0
//   on a film and above 0 on both sides of it: rounding alone could tell such a touch, |f| <
//   slack(t)/4, from a surface. So what lies behind it decides. The ray goes on from a touch so far
//   that d falls by probe_depth*slack(t)/4, if it falls on as over the last stride, at most by
//   probe*slack(t)/4, and by twice the step before from then on, at most graze*tolerance(t), so that
//   whatever is thicker than a few slacks is met at any angle.
//     d < -slack(t)/4, or d <= 0 for the deep-th time in a row: a hit between the last sample that was
//       above 0 and t (REFINED)
//     d >= slack(t)/4: it has passed, and marches on as from a beginning. It is counted where d is
//       above `across` times the way since the last sample that was above 0, else it grazed, and
//       above (2*slack + float_slack*t + float_slack*radius)/4: rounding of what is large is no film
//   In a scene with ESTIMATES a touch is a hit.
//
//   CLOSE: a ray whose d was below the width of a pixel and grew again, and that ends in a miss or
//   more than `behind` widths farther, may have passed what is thinner than a pixel. Where a picture
//   has more samples only where one does not do, its pixel has more.
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
// SHADING at the hit point p = o + t*dir, h = step(t), n = normal(p - lift*h*dir, h), v = -dir; in front
//   of the surface, since behind it the field is 0 where two parts meet
//   s = hit(p); the surface is s.paint (below 0: the last one); its material is evaluated at
//   (s.point, n', s.extra), where n' is the normal in the paint's space:
//   hit(p + h*n).point - s.point, normalised (n where that is 0).
//   With Lighting::skip: color = diffuse + emission. Else Phong (thesis, 2.1), with the light's
//   visibility:
//     color = ao * diffuse * (around + fill * max(n.v, 0)) + emission
//           + sum over lights of seen * light color
//             * (diffuse * max(n.l, 0) + specular_intensity * specular * gleam)
//     gleam  (1 + e)/(1 + exponent) * max(r.v, 0)^e, r being l mirrored in n. Where the taps lie on both
//            sides of an edge, n is between the faces, and would show a highlight that neither has;
//            so it is spread by how much shorter the mean of their normals is (Toksvig 2005):
//            even = |gradient| / slope / flat_from, from min_slope to 1, with the slope of TRUE DISTANCE or 1,
//            e = exponent * even/(even + exponent*(1 - even)); the exponent itself on what is flat
//     seen  1 - shadow_darkness * (1 - shadow)
//     ao    1 - ambient_occlusion * occlusion
//     around  ambient * mix(soil, sky, (1 + n.y)/2): more comes from above, and it is cooler
//   Last, highlights: a channel c above `shoulder` becomes
//   shoulder + (1 - shoulder)*(1 - exp(-(c - shoulder)/(1 - shoulder))), which stays below 1.
//   With Lighting::classic, which is the thesis's, around = ambient and no channel is changed.
//   Lights with n.l <= 0 add nothing. A sun's l is its direction; else l points from p to its
//   place. What is closed in sees less of the sky, so `ao` dims the ambient light alone; how much
//   of a light arrives is for `seen` to say, which never makes a contact black (thesis, 4.2.1 has
//   both).
//
// NEAREST: how far off a point c, or the way from q along l to a light, the solid is. The field may
//   say less than the distance, so the solid's surface is gone down to and followed, from a place p
//   on where the field says g; `fine` is as near to the surface as p has to come.
//   off(p) = p - c for a point; for a way p - q - x*l with x = (p - q).l, which counts where x is
//   on the way; it is measured in lights' sizes there, angle*x.
//   DOWN to the surface, at most descent_steps times, until |g| < fine*slope: with v = gradient(p,
//   a) and the slope of TRUE DISTANCE, by d = -g*v/(slope*|v|); a = max(fine, shadow_arm*|g|/slope)
//   with the slope of the step before, at first 1; an arm that is longer than |g|/slope by its own
//   slope makes no step, but the next arm. Where d leads to where the field is above 0 by the
//   gradient u of the step before, the field is the greater of two: the shortest d by which both
//   are 0, if the sine between them is at least sqrt(descent_apart). So the sharp edge of a cut is
//   reached in a few steps. Where not all slopes are 1 (`Frame::unit_slope`): a step is at most
//   descent_reach times what counts: where a field is flat far off (a Gaussian's, `atan`), g/slope
//   leads past the solid. Where the field is above 0 at both ends of a step, rises along it at the
//   second, and is steeper there, it led past something thin: half of it is taken. From the descent_plain-th step on, where d is r = descent_slow times the
//   one before or more, on the same side, it is divided by 1 - r, at least descent_fastest, as
//   roots of a higher order want (Aitken). Where the field had the other sign at one of the places
//   before, the last such, and d is longer than descent_across of the way there, d is where the
//   chord is 0, at least descent_least of that way from both ends. The slope is that of the last
//   step where all are 1 (`Frame::unit_slope`), else that at p itself. What is not reached is
//   nowhere.
//   ALONG the surface, n = v/|v|, from the best place so far, to p + share*((off.n)*n - off), and
//   down again, with a quarter of the share where that was not better (1 at first, least_share at
//   least), at most most_slides times (for a point occlusion_slides): until it was better by `fine`
//   at most, or the way has fine/2, or |off| - |off.n| is at most `fine`, which is as much as a
//   plane would give; and not from where |v| is below `steady` times the slope, as on a film, nor
//   for a point where |off| is below near_enough times what the first step said. What is beyond the
//   light, x > reach, is gone back from once along the surface, to x = reach.
//   FILMS: what is found may be no solid: a film, where the field is 0 (TOUCHES), or a place where
//     it is least and above 0, as between the face of a plate and the end of the tool that cuts it,
//     if that ends a little beyond. In a scene that may have some (`Frame::films`) the place that
//     counts is tried, and is nowhere if it is one: the way goes on down, at most film_steps times,
//     while g >= near = film_near*thick, thick = slack/4 there; where g does not become less than
//     film_lower of what it was, film_stalls times in a row, it is least there: a film. Where |g| <
//     near, g is looked at film_looks times on a circle about that place, of radius film_look*thick
//     divided by the slope at the surface, where that is below 1, in the plane of off and v, which
//     an edge is across (where both are one way, in some plane that holds it). If it is below
//     -thick at none of them, that is a film (or an edge sharper than an angle between two looks).
//   BESIDE: a flush tool's hole has a film across it, which hides its rim. Where a film is, or the way
//     down ended without landing, with n = v/|v| there and |g|/slope below what counts, the solid is
//     looked for beside it: on circles in the plane across n about where the way passes it (where
//     l is flatter in it than circle_across, about the foot of the place beside it), of the shares
//     1/circles … 1 of what counts across l (never more than 1/circle_across of it in the plane), at
//     circle_looks angles circle_turn apart, and at each of them |g|/slope + film_look*thick
//     before and behind the plane. The first below -thick is in the solid. Between its circle and
//     the next smaller one circle_halvings times the one halfway is looked at, at its angle and a
//     turn to each side, at first circle_turn/2, then circle_narrower of it. The last place in the
//     solid is what is found.
//
// OCCLUSION (thesis, 4.2.1: five samples along the normal)
//   for i = 1..5, x_i = reach*i/5 (Lighting's, else Frame's), c_i = p + x_i*n, g_i = g(c_i), w_i =
//   2^-i
//   closed_i = clamp(1 - d_i/(nearly*x_i), 0, 1), where d_i is how far off the solid is: g_i itself
//   where the field is the distance (`Frame::exact`) or below 0. Else x_i, if g_i >= nearly*own_i*x_i,
//   own_i the greatest of the slope at p and g_j/x_j up to j = i (1 with `Frame::unit_slope`): what
//   rises as the surface itself does is open, however steep its field is. Else what is NEAREST to
//   c_i from there on, with fine = max(h, occlusion_fine*x_i/w_i) and the slack at t.
//   occlusion = sum of w_i*closed_i, divided by the sum of the w_i
//
// SHADOW (thesis, 4.2.1: from the light towards the point, so that no ray has to leave a surface
// slowly)
//   q = p + shadow_bias*tolerance(t)*n
//   reach = the light's distance from q; for a sun, the way from q out of the box along l, or `far`
//   without a box
//   angle = max(soft_shadows, min_angle): half the light's angular size
//   closed(s) = near(q + s*l, max(h, shadow_arm*g))/(angle*s): where that is below 1, something covers
//   the light. The slope is that of as long a way as the value is of, not that of a grain of noise.
//   Where near is no less than e = shadow*angle*s, the edge below, the field is looked at e against
//   its gradient as well: g' < 0 there says that near is at most e*g/(g - g').
//   Where it is looked at are marks, which no bound moves: the multiples of gap(s) = the greatest
//   power of 2 that is not above marks*angle*s, and reach.
//   s = reach (what is left of the way), shadow = closed_from; while s > margin,
//   margin = shadow_bias*tolerance(t):
//     the budget is spent: undecided; it counts as what it is so far
//     d = f(q + s*l)
//     if d < -slack(s)/4, or estimate*d < dark*angle*s (ESTIMATES): all dark, done
//     if d < slack(s)/4: TOUCHES, as for rays from the eye, by steps of at most angle*s/2
//     edge = shadow*angle*s: what is farther changes nothing
//     if s is a mark, d < edge and s <= quiet: closed(s).
//       quiet = s - calm*(min(near, g) - edge): what is so much farther than the edge is not looked at
//       again before that (where two parts are as near, the slope is small, and near too large). Where closed(s) < shadow: shadow = max(closed(s), darkest)
//     The ball of radius d about s is free; up to s - (d - edge), with the new
//       edge, nothing in it is nearer than that. s = the greatest of s - d and the first mark that is
//       before s, not above s - (d - edge) and not above quiet
//   PENUMBRA: closed(s) is as good as the field is near to a distance. So the first mark where it
//   is below closed_from is kept, and from there on only what the way crosses is looked for, by
//   steps of d. If that is nothing, the way is gone anew from that mark on, and the place of
//   closed(s) is taken by what is NEAREST to the way between margin and reach, from there on, with
//   fine = max(h, penumbra_fine*angle*s) and the slack at s. So a penumbra depends on the solid
//   alone, not on what the field is worth as a distance, and another bound makes other steps, but
//   the same marks.
//   shadow = min(shadow, 1), at least darkest; result: shadow^2*(3 - 2*shadow), less what it is at
//   darkest and divided by 1 less that, so that what is nearly dark is dark, without a step
//
// ESTIMATES, in scenes where some shape's bound is an estimate (`Frame::estimate`, the greatest bound of
// all, by which at most a distance was divided): distances to fractals are such, and hardly anywhere
// change their sign. So a ray has hit where `nearing` samples in a row are within its tolerance, each
// nearer than the one before, which a ray that passes an edge has seldom; and a light is covered by
// what is much nearer to the way to it than the light is wide, and
// nothing is taken for a film. In all other scenes the sign alone decides.
//
// UNDECIDED: shaded where the ray came to, as what it is nearest to.
// MISS: color = background_function(dir); without one `background`.
// FADE: where rays have no box, what lies as far as `far` cannot be told from what is endless: a
//   hit's color = mix(color, that of a miss, smoothstep(fade_from*far, far, t)).
// Out: linear; samples of a pixel are averaged linear; then clamped to 0..1, sRGB-encoded, and
//   rounded to bytes by the pixel's place in a pattern (base/picture.h, `dither`).
#pragma once

#include <array>

namespace fathom::ir::shading {

inline constexpr float float_slack = 1e-6f;
inline constexpr float normal_slack = 16;
inline constexpr float arm = 0.125f;  // tolerances
inline constexpr float lift = 2;      // arms
inline constexpr float widest = 0.2f; // pixels
inline constexpr float min_slope = 1.0f / 1024;
inline constexpr float kinked = 1.0f / 256; // of the slope's square
inline constexpr float faint = 1.0f / 32;
inline constexpr float beside = 4, beside_reach = 32; // arms; and times that
inline constexpr int beside_looks = 16;               // at both ends, and halvings
inline constexpr float relaxation =
    0.9f; // performance.md, 2: best of those measured on scenes with L = 1
inline constexpr float flattest = 1e-3f;
inline constexpr float bent_relaxation = 0.7f; // measured on displaced spheres, as these
inline constexpr float nearer = 0.9f;
inline constexpr int occlusion_samples = 5;
inline constexpr float occlusion_reach = 0.075f; // of half the height that is seen at the focus
inline constexpr float nearly = 0.98f;
inline constexpr float occlusion_fine = 1.0f / 256; // of the way to a sample, by its weight
inline constexpr int descent_steps = 8;             // to the surface
inline constexpr float descent_reach = 2;           // times what counts: the longest step
inline constexpr int descent_plain = 3;             // steps
inline constexpr float descent_slow = 0.3f;         // of the step before
inline constexpr float descent_fastest = 1.0f / 8;
inline constexpr float descent_across = 0.75f, descent_least = 0.1f; // of the way to the other side
inline constexpr float descent_apart =
    1.0f / 64; // the square of a sine: two faces that are not one
inline constexpr int most_slides = 6, occlusion_slides = 1; // along it
inline constexpr float near_enough = 1.01f;                 // times what the field said first
inline constexpr float steady =
    0.5f; // of the slope: where a gradient is shorter it has no direction
inline constexpr float least_share = 1.0f / 20;    // of a slide that is tried
inline constexpr float penumbra_fine = 1.0f / 512; // of what the light covers: how near that is
inline constexpr float nowhere = 1e9f;             // off the way, in lights' sizes
inline constexpr float crease = 3;
inline constexpr float flat_from = 0.98f; // rounding and slight curves are flat
inline constexpr float calm = 0.125f;
inline constexpr float dark = 1.0f / 64;     // of what the light covers at s
inline constexpr float darkest = 1.0f / 256; // of what is closed, but by what the way crosses
inline constexpr float dark_light = darkest * darkest * (3 - 2 * darkest);
inline constexpr float shadow_arm = 0.35f; // of the field's value beside a shadow ray
inline constexpr float marks = 0.5f, closed_from = 1.0625f; // of what the light covers at s
inline constexpr float jump = 2, graze = 1.0f / 16;         // tolerances
inline constexpr int refinements = 12;
inline constexpr float refined = 1.0f / 2048; // of a tolerance
inline constexpr float across = 1.0f / 32; // the slope behind a touch, from which on it is no graze
inline constexpr float probe = 8; // slack/4: the first step beyond what is touched, at most
inline constexpr float probe_depth = 2.5f;            // slack/4: how deep it leads
inline constexpr int film_steps = 8;                  // to what may be a film
inline constexpr float film_lower = 0.97f;            // of the value before
inline constexpr int film_stalls = 2;                 // steps in a row
inline constexpr float film_near = 8, film_look = 64; // slack/4
inline constexpr float film_flat = 1e-6f;       // the square of a sine: two ways that are as one
inline constexpr int film_looks = 24;           // on a circle,
inline constexpr float film_turn = 2.87979327f; // so far apart: eleven steps of the circle
inline constexpr int circles = 4, circle_looks = 8, circle_halvings = 8; // beside a film
inline constexpr float circle_turn = 0.78539816f;                        // between two looks
inline constexpr float circle_narrower = 0.7f;
inline constexpr float circle_across = 0.3f; // sine
inline constexpr int deep = 2;               // touches not above 0 that are a solid, one less
inline constexpr int nearing = 3;            // samples, by which an estimate is hit
inline constexpr int many_steps = 256;       // red in a picture of steps
inline constexpr int budget = 65536;         // evaluations a ray, where the scene does not say
// tan of half the angle of view that a camera has where nothing is said (view.cpp)
inline constexpr double usual_extent = 0.41421356237309503;
inline constexpr float shadow_bias = 4;
inline constexpr float min_angle = 0.002f; // a hard shadow's edge, soft enough not to flicker
inline constexpr std::array<float, 3> background{0.35f, 0.45f, 0.6f};
inline constexpr std::array<float, 3> sky{1.1f, 1.15f, 1.25f}, soil{0.9f, 0.85f, 0.75f};
inline constexpr float shoulder = 0.8f;
inline constexpr float fade_from = 0.3f;
inline constexpr std::array<int, 4> rough_samples{1, 2, 4, 8}; // of a pixel, by base/picture.h
inline constexpr float behind = 8; // pixels: what ends so far behind is another thing

} // namespace fathom::ir::shading
