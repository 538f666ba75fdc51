$# What a picture writes beside its colour for the noise cache.
#ifdef FATHOM_CACHE
layout(location = 2) out ivec4 fathom_missed;
layout(location = 3) out uvec2 fathom_counted;
layout(location = 4) out vec4 fathom_started;
#elif defined(FATHOM_CACHE_LEARN)
layout(location = 2) out ivec4 fathom_wished[$WISHES];
#endif
