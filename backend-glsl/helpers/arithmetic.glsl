$# Arithmetic made total (ir/semantics.h). Here, as in all texts, no branch has two arms: SwiftShader, which
$# browsers draw with where there is no graphics card, takes time that doubles with each such branch
$# in a loop. A choice is `mix`, which takes one of two values by a bool, or an `if` without `else`.

$helper fathom_either:T
$T fathom_either(bool choice, $T yes, $T no) {
    $T taken = no;
    if (choice) taken = yes;
    return taken;
}

$helper fathom_mod:each
float fathom_mod(float x, float y) {
    return mix(x - y * floor(x / y), x, y == 0.0);
}

$helper fathom_pow:each
float fathom_pow(float x, float y) {
    float size = abs(x);
    float of_zero = mix(mix(uintBitsToFloat(0x7f800000u), 0.0, y > 0.0), 1.0, y == 0.0);
    float power = mix(of_zero, pow(size, y), size > 0.0);
    float below = mix(-power, power, floor(0.5 * y) == 0.5 * y);
    return mix(mix(below, 0.0, floor(y) != y), power, x >= 0.0);
}

$# Whole powers, by the products of backend-cpu/kernels/kernel_rows.h.
$helper fathom_power_2:T
$T fathom_power_2($T x) {
    return x * x;
}

$helper fathom_power_3:T
$T fathom_power_3($T x) {
    return x * x * x;
}

$helper fathom_power_4:T
$T fathom_power_4($T x) {
    $T square = x * x;
    return square * square;
}

$helper fathom_power_5:T
$T fathom_power_5($T x) {
    $T square = x * x;
    return square * square * x;
}

$helper fathom_power_6:T
$T fathom_power_6($T x) {
    $T cube = x * x * x;
    return cube * cube;
}

$helper fathom_power_7:T
$T fathom_power_7($T x) {
    $T cube = x * x * x;
    return cube * cube * x;
}

$helper fathom_power_8:T
$T fathom_power_8($T x) {
    $T square = x * x;
    $T fourth = square * square;
    return fourth * fourth;
}

$helper fathom_smoothstep:each
float fathom_smoothstep(float lo, float hi, float x) {
    float t = clamp((x - lo) / (hi - lo), 0.0, 1.0);
    return mix(t * t * (3.0 - 2.0 * t), step(lo, x), lo == hi);
}

$helper fathom_atan2:each
float fathom_atan2(float y, float x) {
    return mix(atan(y, x), mix(0.0, 3.14159274, x < 0.0), y == 0.0);
}

$# The sine of x + quarters * pi/2, right to 5e-7 + 1.2e-7 |x|, which the proof relies on. Drivers' own may be wrong
$# by 2^-11 (Vulkan 1.3, A.4), and SwiftShader's are, by 1.9e-4. x is turns * pi/2 + r, with pi/2 in three parts, whose
$# products have few digits (Cody and Waite 1980); the polynomials are those of backend-cpu/kernels/trigonometry.h.
$helper fathom_sine
float fathom_sine(float x, float quarters) {
    float turns = floor(0.636619772 * x + 0.5);
    float r = x - 1.5703125 * turns - 4.83751297e-4 * turns - 7.54978995e-8 * turns;
    r = clamp(r, -0.785398185, 0.785398185);
    float u = r * r;
    float s = r + r * u * (-1.666665494e-01 + u * (8.332177916e-03 + u * -1.951726684e-04));
    float c = 1.0 - 0.5 * u + u * u * (4.166664686e-02 + u * (-1.388736721e-03 + u * 2.443841555e-05));
    float quarter = turns + quarters;
    quarter -= 4.0 * floor(0.25 * quarter);
    float size = mix(s, c, quarter == 1.0 || quarter == 3.0);
    return mix(size, -size, quarter > 1.5);
}

$helper fathom_sin:each needs fathom_sine
float fathom_sin(float x) {
    return fathom_sine(x, 0.0);
}

$helper fathom_cos:each needs fathom_sine
float fathom_cos(float x) {
    return fathom_sine(x, 1.0);
}

$helper fathom_tan:each needs fathom_sine
float fathom_tan(float x) {
    return fathom_sine(x, 0.0) / fathom_sine(x, 1.0);
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
    $T unit = $T(0.0);
    if (squared > 0.0) unit = x * (1.0 / sqrt(squared));
    return unit;
}
