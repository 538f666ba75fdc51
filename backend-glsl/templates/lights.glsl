$# The scene's lights, each a case of STATEMENTS; without any, the default sun.

struct fathom_Light {
    bool directional;
    vec3 position;
    vec3 color;
};

fathom_Light fathom_light(int i) {
$if LIT
$CASES
$else
    return fathom_Light(true, fathom_sun, vec3(1.0));
$end
}
