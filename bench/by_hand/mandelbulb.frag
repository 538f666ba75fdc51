#define REACH 1.21

float map(vec3 p) {
    vec3 z = p;
    float dr = 1.0, r = length(z);
    for (int i = 0; i < 8 && r <= 2.0; ++i) {
        dr = 8.0 * pow(r, 7.0) * dr + 1.0;
        float latitude = 8.0 * asin(z.y / r), longitude = 8.0 * atan(z.z, z.x);
        z = pow(r, 8.0) * vec3(cos(latitude) * cos(longitude), sin(latitude), cos(latitude) * sin(longitude)) + p;
        r = length(z);
    }
    return 0.5 * (r <= 2.0 ? log(0.5 * r) : log(r)) * r / dr;
}
