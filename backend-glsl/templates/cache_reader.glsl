$# What reads one field through the cache (cache.h).

$TYPE $READER(vec3 p) {
#ifdef FATHOM_CACHE
    vec3 at;
    if (fathom_cached(p, $CELL, fathom_cache_fields[$NUMBER], at)) return textureLod($POOL, at, 0.0)$PART;
    return $TYPE(0.0);
#else
#ifdef FATHOM_CACHE_LEARN
    fathom_ask(p, $CELL, fathom_cache_fields[$NUMBER]);
#endif
    return $FUNCTION(p);
#endif
}
