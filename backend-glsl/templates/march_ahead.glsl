$# Statements: the next step of a ray that found d at t, and may go `ahead`. Without branches where it can be: drivers on
$# the processor compute both sides.
$if PASSES
            close = mix(close, t - stride, stride > 0.0 && ahead > before && before < fathom_width_at(t - stride));
$end
            float next = ahead;
            bool straight = stride > 0.0;
$if HAS_SAFE_RADIUS
            float reach = max(span, ahead);
            if (reach > ahead) {
                next = reach;
                straight = false;
                if (stride > 0.0) {
                    float change = (reach * reach - reached * reached) / stride;
                    next = mix(reach + $BENT_RELAXATION * (reach + change), reach * reach / -change - 0.5 * tolerance,
                               change < -reach);
                    next = max(next, ahead);
                }
            }
$end
            float more = $RELAXATION * ahead * max(stride + ahead - before, 0.0) /
                         max(stride - ahead + before, $FLATTEST * stride);
            next += mix(0.0, more, straight);
            float line = d * stride / (before - d) + 0.25 * tolerance; // where the line through both is 0
            aims = stride > 0.0 && before > d && line <= $JUMP * tolerance;
            next = mix(next, max(ahead, line), aims);
            float proved = max(end, t + ahead);
            next = min(next, proved - t);
            before = ahead;
$if HAS_SAFE_RADIUS
            reached = reach;
$end
            stride = next;
            t = min(t + next, proved);
