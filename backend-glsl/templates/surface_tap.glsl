$# What f at the point i about a surface adds to the gradient; after the last, the normal, and the slope.
            g += f * e;
$if MANY_SLOPES
            bent += i < 4 ? f : -4.0 * f;
$end
            if (i == $SURFACE_TAPS - 1) {
                g *= 0.75 / h;
                slope = length(g);
                if (slope > 0.0) n = g / slope;
$if MANY_SLOPES
                own = max(sqrt(slope * slope + $CREASE * 0.0625 * bent * bent / (h * h)), $MIN_SLOPE);
                even = clamp(slope / (own * $FLAT_FROM), $MIN_SLOPE, 1.0);
$else
                even = clamp(slope / $FLAT_FROM, $MIN_SLOPE, 1.0);
$end
            }
