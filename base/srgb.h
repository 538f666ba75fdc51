// The curve of sRGB (IEC 61966-2-1), channel by channel: what a file or the user says is encoded,
// what is computed with is linear. In shaders: backend-glsl/templates/picture.glsl.
#pragma once

#include <cmath>

namespace fathom {

// Linear to encoded. Both 0..1; nothing is clamped.
template <class T> T srgb_of_linear(T linear) {
    return linear <= T(0.0031308) ? T(12.92) * linear
                                  : T(1.055) * std::pow(linear, 1 / T(2.4)) - T(0.055);
}

// Encoded to linear.
template <class T> T linear_of_srgb(T encoded) {
    return encoded <= T(0.04045) ? encoded / T(12.92)
                                 : std::pow((encoded + T(0.055)) / T(1.055), T(2.4));
}

} // namespace fathom
