// What every header of the library begins with: the mark of exported names, and the namespace.
#pragma once

#if defined(_WIN32)
#define FATHOM_API
#else
#define FATHOM_API __attribute__((visibility("default")))
#endif

// All names lie in fathom::v1 and are written fathom::NAME. A change that would break a program
// that uses them comes as v2.
#ifdef FATHOM_BUILDS_ITSELF
#define FATHOM_V1 v1
#else
#define FATHOM_V1 inline v1
#endif
