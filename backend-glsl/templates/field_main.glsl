$# Calls what a field alone offers, for the check.

$if LOCATIONS
layout(location = 0) out vec4 fathom_color;
$else
out vec4 fathom_color;
$end
void main() {
    fathom_color = vec4(material(vec3(sdf(vec3(0.0))), vec3(1.0)).diffuse, 1.0);
}
