// Bytes as text that a page can carry, and the fingerprint that a page's policy asks for. Knows
// nothing of what the bytes are.
#pragma once

#include <string>
#include <string_view>

namespace fathom {

// A zlib stream (RFC 1950) of the bytes; which bytes it has depends on zlib's version.
std::string compressed(std::string_view bytes);

// Base64 with padding (RFC 4648, 4).
std::string base64(std::string_view bytes);

// SHA-256 (FIPS 180-4): 32 bytes.
std::string sha256(std::string_view bytes);

} // namespace fathom
