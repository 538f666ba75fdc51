$# Hits: the nearest, the farthest, and what they are painted with.

$helper fathom_nearest
Hit fathom_nearest(Hit a, Hit b) {
    Hit nearest = a;
    if (b.distance < a.distance) nearest = b;
    return nearest;
}

$helper fathom_farthest_of
// Of hits that are evaluated in a row: an unpainted one shows the first one's paint.
Hit fathom_farthest_of(Hit first, Hit best, Hit next) {
    Hit farthest = next;
    if (next.paint < 0) farthest = Hit(next.distance, first.paint, first.point, first.extra);
    if (next.distance <= best.distance) farthest = best;
    return farthest;
}

$helper fathom_farthest needs fathom_farthest_of
Hit fathom_farthest(Hit a, Hit b) {
    return fathom_farthest_of(a, a, b);
}

$helper fathom_hit_with
Hit fathom_hit_with(Hit hit, float distance) {
    return Hit(distance, hit.paint, hit.point, hit.extra);
}

$helper fathom_fill_paint
Hit fathom_fill_paint(Hit hit, int paint, vec3 point, vec4 extra) {
    Hit filled = hit;
    if (hit.paint < 0) filled = Hit(hit.distance, paint, point, extra);
    return filled;
}
