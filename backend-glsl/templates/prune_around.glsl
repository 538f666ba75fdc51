$# The field beyond the cells: the endless parts alone, and the box of the rest (prune.h).

bool fathom_exact = false;

bool fathom_outside(vec3 p) {
    return fathom_grid_side > 0 && !fathom_inside(fathom_place(p));
}

float sdf(vec3 p) {
    if (fathom_outside(p)) {
        float endless = fathom_endless(p);
        float off = fathom_off(p);
        if (endless <= off || !fathom_exact) return min(endless, off);
    }
    return fathom_all(p);
}

Hit $HIT(vec3 p) {
    if (fathom_outside(p) && fathom_endless(p) <= fathom_off(p)) return fathom_endless_hit(p);
    return fathom_all_hit(p);
}
