$# Arithmetic made total (ir/semantics.h).

$helper fathom_mod:each
float fathom_mod(float x, float y) {
    return y == 0.0 ? x : x - y * floor(x / y);
}

$helper fathom_pow:each
float fathom_pow(float x, float y) {
    float size = abs(x);
    float power = size > 0.0 ? pow(size, y) : (y == 0.0 ? 1.0 : (y > 0.0 ? 0.0 : uintBitsToFloat(0x7f800000u)));
    if (x >= 0.0) return power;
    if (floor(y) != y) return 0.0;
    return floor(0.5 * y) == 0.5 * y ? power : -power;
}

$helper fathom_square:T
$T fathom_square($T x) {
    return x * x;
}

$helper fathom_cube:T
$T fathom_cube($T x) {
    return x * x * x;
}

$helper fathom_smoothstep:each
float fathom_smoothstep(float lo, float hi, float x) {
    if (lo == hi) return step(lo, x);
    float t = clamp((x - lo) / (hi - lo), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

$helper fathom_atan2:each
float fathom_atan2(float y, float x) {
    return y == 0.0 ? (x < 0.0 ? 3.14159274 : 0.0) : atan(y, x);
}

$helper fathom_sqrt:T
$T fathom_sqrt($T x) {
    return sqrt(max(x, 0.0));
}

$# By atan, which drivers compute to a few units in the last place; their asin and acos are often
$# cubic fits.
$helper fathom_asin:each
float fathom_asin(float x) {
    float y = clamp(x, -1.0, 1.0);
    return atan(y, sqrt((1.0 - y) * (1.0 + y)));
}

$helper fathom_acos:each
float fathom_acos(float x) {
    float y = clamp(x, -1.0, 1.0);
    return atan(sqrt((1.0 - y) * (1.0 + y)), y);
}

$helper fathom_tanh:T
$T fathom_tanh($T x) {
    return tanh(clamp(x, -20.0, 20.0));
}

$helper fathom_normalize:T
$T fathom_normalize($T x) {
    float squared = dot(x, x);
    return squared > 0.0 ? x * (1.0 / sqrt(squared)) : $T(0.0);
}
