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
                even = min(slope / (own * $FLAT_FROM), 1.0);
$else
                even = min(slope / $FLAT_FROM, 1.0);
$end
            }
