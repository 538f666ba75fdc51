#define REACH 1.0

// The sum of products is at most sqrt(3) times as steep as k.
float map(vec3 p) {
    const float k = 6.2831853 / 0.6;
    float sheet = abs(dot(sin(k * p), cos(k * p.zxy))) / (1.7320508 * k) - 0.04;
    return max(sheet, length(p) - 1.0);
}
