$# Statements of a loop along a ray from a light: what is certainly clear of it is passed over.
$if FAR_CELLS
$# What is farther than the shadow's edge as it is now changes nothing.
                vec2 clear = fathom_clear(q + s * l, -l, max(shadow * angle * s, margin));
                if (clear.y > 0.0) {
                    s -= clear.y;
                    mark = false;
                    continue;
                }
$end
$if AROUND
$# Beyond the cells a value that is not exact shades nothing.
                if (fathom_outside(q + s * l)) {
                    float off = fathom_off(q + s * l);
                    float edge = max(shadow * angle * s, margin);
                    if (off > 2.0 * edge && off < fathom_endless(q + s * l)) {
                        s -= off - edge;
                        mark = false;
                        continue;
                    }
                }
$end
