$# Statements: the next step of a ray that found d at t.
            float ahead = max(d, mix(0.25 * fathom_slack_at(t), $GRAZE * tolerance, touches < 0));
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
            if (straight)
                next += $RELAXATION * ahead * max(stride + ahead - before, 0.0) /
                        max(stride - ahead + before, $FLATTEST * stride);
            aims = false;
            if (stride > 0.0 && before > d) { // where the line through both is 0
                float to = d * stride / (before - d) + 0.25 * tolerance;
                aims = to <= $JUMP * tolerance;
                if (aims) next = max(ahead, to);
            }
            float proved = max(end, t + ahead);
            next = min(next, proved - t);
            before = ahead;
$if HAS_SAFE_RADIUS
            reached = reach;
$end
            stride = next;
            t = min(t + next, proved);
