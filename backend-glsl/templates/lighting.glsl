$# How the scene is shaded.

struct fathom_Lighting {
    vec3 ambient;
    float ambient_occlusion;
    float shadow_darkness;
    float soft_shadows;
    float specular_intensity;
    float fill;
    float occlusion_reach;
};

fathom_Lighting fathom_lighting() {
$STATEMENTS
    return fathom_Lighting($LIST);
}
