// Bytes as text that a page can carry. Knows nothing of what the bytes are.
#pragma once

#include <string>
#include <string_view>

namespace fathom {

// A zlib stream (RFC 1950) of the bytes; which bytes it has depends on zlib's version.
std::string compressed(std::string_view bytes);

// Base64 with padding (RFC 4648, 4).
std::string base64(std::string_view bytes);

} // namespace fathom
