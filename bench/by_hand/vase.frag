#define REACH 1.4
#define STEP 0.6

float map(vec3 p) {
    float profile = 0.6 + 0.2 * sin(2.5 * p.y + 0.4) + 0.05 * sin(7.0 * p.y);
    float wall = abs(length(p.xz) - profile) - 0.05;
    float pattern = 0.02 * sin(14.0 * p.x) * sin(14.0 * p.y) * sin(14.0 * p.z);
    return max(wall + pattern, abs(p.y) - 1.0);
}
