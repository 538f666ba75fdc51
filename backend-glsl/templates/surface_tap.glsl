$# What f at the point i about a surface adds to the gradient; after the last, the normal, and the slope.
            g += f * e;
$if MANY_SLOPES
            bent += i < 4 ? f : -4.0 * f;
            behind = behind || f < 0.0;
$end
            if (i == $SURFACE_TAPS - 1) {
                g *= 0.75 / h;
                slope = length(g);
                if (slope > 0.0) n = g / slope;
$if MANY_SLOPES
                own = max(sqrt(slope * slope + $CREASE * 0.0625 * bent * bent / (h * h)), $MIN_SLOPE);
                even = clamp(slope / (own * $FLAT_FROM), $MIN_SLOPE, 1.0);
                bool kinked = !lifted && behind && own * own - slope * slope > $KINKED * own * own;
                if (kinked) { // once more, from further in front
                    lifted = true;
                    if (slope > 0.0) above += $LIFT * h * n;
                    g = vec3(0.0);
                    bent = 0.0;
                    i = -1;
                }
                if (slope < $FAINT && !kinked) surface += 5 * $BESIDE_LOOKS;
$else
                even = clamp(slope / $FLAT_FROM, $MIN_SLOPE, 1.0);
$end
            }
$if MANY_SLOPES
            if (i >= $SURFACE_TAPS) {
                int side = (i - $SURFACE_TAPS) / $BESIDE_LOOKS, look = i - $SURFACE_TAPS - side * $BESIDE_LOOKS;
                bool free = f > 0.0;
                if (look == 0) {
                    found = free;
                    low = -$BESIDE_REACH;
                    high = $BESIDE_REACH;
                }
                if (look == 1 && free) found = false;
                if (look > 1 && free) low = here;
                if (look > 1 && !free) high = here;
                here = look == 0 ? high : 0.5 * (low + high);
                if (look == $BESIDE_LOOKS - 1) {
                    if (side == 0) middle = here;
                    vec2 axis = side < 3 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
                    if (found && side > 0) {
                        rise += float(2 * (side & 1) - 1) * (here - middle) * axis;
                        rises += axis;
                    }
                    if (side == 0 && !found) surface = i + 1;
                    here = -$BESIDE_REACH;
                    if (side == 4 && rises.x * rises.y > 0.0) {
                        even = 1.0;
                        n = normalize(rise.x / rises.x * fathom_beside(1, direction) +
                                      rise.y / rises.y * fathom_beside(3, direction) - direction);
                    }
                }
            }
$end
