$# Statements at the end of a picture that writes what cache_outputs declares.
#ifdef FATHOM_CACHE
    fathom_missed = fathom_miss;
    fathom_counted =
        uvec2(fathom_hits, (fathom_miss.w >= 0 ? 1u : fathom_absent ? 2u : 0u) | uint(fathom_steps) << 2);
    fathom_started = vec4(fathom_start.xyz, fathom_began());
    gl_FragDepth = fathom_absent ? 1.0 : 0.0;
#elif defined(FATHOM_CACHE_LEARN)
    for (int i = 0; i < $WISHES; ++i)
        fathom_wished[i] = uint(i) < fathom_asks ? fathom_wishes[i] : ivec4(0, 0, 0, -1);
#endif
