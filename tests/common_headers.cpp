// The file that the common headers are compiled for.
#include "common_headers.h"
