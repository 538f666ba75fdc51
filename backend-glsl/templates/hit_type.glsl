$# What a point is nearest to: the distance, the paint, and what the paint reads.

struct Hit {
    float distance;
    int paint;
    vec3 point;
    vec4 extra;
};
