$# Blends of two fields (ir/blends.h).

$helper fathom_blend_smooth
float fathom_blend_smooth(float a, float b, float k) {
    float h = max(k - abs(a - b), 0.0);
    return min(a, b) - h * h * (0.25 / max(k, 1e-9));
}

$helper fathom_blend_round
float fathom_blend_round(float a, float b, float r) {
    float radius = max(r, 0.0);
    float d = min(abs(a - b), radius);
    float u = 0.5 * (d + sqrt(max(2.0 * radius * radius - d * d, 0.0)));
    return min(a, b) - max(radius - u, 0.0);
}

$helper fathom_blend_chamfer
float fathom_blend_chamfer(float a, float b, float r) {
    return min(a, b) - 0.5 * max(r - abs(a - b), 0.0);
}

$helper fathom_blend_stairs
float fathom_blend_stairs(float a, float b, float r, float n) {
    float s = max(r, 1e-9) / (max(floor(n + 0.5), 0.0) + 1.0);
    float d = abs(a - b);
    float x = (max(r, 0.0) - d) / (s + s);
    float turn = x - floor(x);
    float wave = (s + s) * min(turn, 1.0 - turn);
    return min(a, b) - 0.5 * max(max(r, 0.0) - d - wave, 0.0);
}

$helper fathom_blend_columns
float fathom_blend_columns(float a, float b, float r, float n) {
    float count = max(floor(n + 0.5), 1.0);
    float radius = max(r, 0.0);
    float c = radius * 1.41421356 / (2.0 * (count - 1.0) + 1.41421356);
    float line = max(radius - (c + c) - abs(a - b), 0.0);
    float across = (a + b - (radius - (c + c))) * 0.707106781;
    float along = (b - a) * 0.707106781;
    float middle = 0.5 * (count - 1.0);
    float k = floor(along / max(c + c, 1e-9) + middle + 0.5);
    float y = along - (c + c) * (min(max(k, 0.0), count - 1.0) - middle);
    float column = sqrt(across * across + y * y) - c;
    return min(min(a, b) - 0.5 * line, column);
}
