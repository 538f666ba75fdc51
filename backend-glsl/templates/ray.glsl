$# Statements: the ray of `place`, and between which distances it can meet anything.
    fathom_lengths();
    float u = (2.0 * place.x / fathom_resolution.x - 1.0) * fathom_resolution.x / fathom_resolution.y;
    float v = 1.0 - 2.0 * place.y / fathom_resolution.y;
    vec3 aside = fathom_extent * (u * fathom_right + v * fathom_up);
    vec3 origin = fathom_origin;
    vec3 direction = fathom_forward;
    if (fathom_orthographic != 0) origin += aside;
    else direction = normalize(direction + aside);
    float begin = 0.0;
    float end = fathom_far;
$if BOXED
    vec2 inside = fathom_box(origin, direction);
    begin = max(begin, inside.x);
    end = min(end, inside.y);
$end
