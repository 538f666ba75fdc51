// What other languages and libraries call things, and what they are called here.
#include "typecheck/remedies.h"

#include <unordered_map>
#include <unordered_set>

namespace fathom::typecheck {

bool is_needless_method(std::string_view name) {
    static const std::unordered_set<std::string_view> needless = {
        "save",      "export",   "write_stl", "show",      "render_png",   "collect",     "iter",
        "into_iter", "iter_mut", "to_vec",    "clone",     "copied",       "cloned",      "toArray",
        "tolist",    "unwrap",   "freeze",    "subdivide", "smooth_shade", "add_to_scene"};
    return needless.contains(name);
}

std::string_view name_from_elsewhere(std::string_view name) {
    static const std::unordered_map<std::string_view, std::string_view> ours = {
        {"cube", "box"},
        {"cuboid", "box"},
        {"square", "rectangle"},
        {"perlin", "noise"},
        {"snoise", "simplex"},
        {"voronoi", "worley"},
        {"cellular", "worley"},
        {"color", "rgb"},
        {"linear_extrude", "extrude"},
        {"extrudeLinear", "extrude"},
        {"pancake", "extrude"},
        {"rotate_extrude", "revolve"},
        {"extrudeRotate", "revolve"},
        {"lathe", "revolve"},
        {"move", "translate"},
        {"location", "translate"},
        {"position", "translate"},
        {"moveTo", "translate"},
        {"setPosition", "translate"},
        {"group", "union"},
        {"Group", "union"},
        {"combine", "union"},
        {"merge", "union"},
        {"symmetry", "mirror"},
        {"lerp", "mix"},
        {"ln", "log"},
        {"frac", "fract"},
        {"fabs", "abs"},
        {"fmod", "mod"},
        {"atan2", "atan"},
        {"mag", "length"},
        {"norm", "length"},
        {"rsqrt", "inversesqrt"},
        {"rand", "random"},
        {"rot", "rotate2"},
        {"rot2", "rotate2"},
        {"PI", "pi"},
        {"M_PI", "pi"},
        {"TAU", "tau"},
        {"TWO_PI", "tau"},
        {"iTime", "time"},
        {"iGlobalTime", "time"},
        {"u_time", "time"},
        {"Vector3", "vec3"},
        {"Vector2", "vec2"},
        {"count", "len"},
        {"size", "len"},
        {"nothing", "empty"},
        {"half_space", "plane"},
        {"ground", "plane"},
        {"half_plane", "plane"},
        {"frustum", "capped_cone"},
        {"cone_frustum", "capped_cone"},
        {"truncated_cone", "capped_cone"},
        {"round_box", "rounded_box"},
        {"roundedCuboid", "rounded_box"},
        {"rect", "rectangle"},
        {"ball3", "sphere"},
        {"donut", "torus"},
        {"onion", "shell"},
        {"hollow", "shell"},
        {"inflate", "offset"},
        {"dilate", "offset"},
        {"stretch", "elongate"},
        {"flip", "mirror"},
        {"array", "repeat"},
        {"polar_repeat", "repeat_polar"},
        {"radial_repeat", "repeat_polar"},
        {"smooth_min", "smin"},
        {"smooth_max", "smax"},
        {"smoothmin", "smin"},
        {"smoothmax", "smax"},
        {"smoothMin", "smin"},
        {"smoothMax", "smax"},
        {"sminCubic", "smin"},
        {"interpolate", "mix"},
        {"blobs", "metaballs"},
        {"echo", "print"},
        {"printf", "print"},
        {"parseFloat", "float"},
        {"parseInt", "int"},
        {"X_axis", "X"},
        {"Y_axis", "Y"},
        {"Z_axis", "Z"},
        {"circular_array", "repeat_polar"},
        {"tile", "repeat"},
        {"subtract", "difference"},
        {"subtraction", "difference"},
        {"intersect", "intersection"}};
    const auto it = ours.find(name);
    return it == ours.end() ? std::string_view() : it->second;
}

// What is done otherwise here than in three.js, p5, Blender and GLSL.
static std::string_view way_from_libraries(std::string_view name) {
    static const std::unordered_map<std::string_view, std::string_view> ways = {
        {"pop", "a transform holds for the shape that it stands behind, and for no other"},
        {"resize", "a shape is made larger by `.scale([1, 1, 2])`, and has its size from its call"},
        {"format", "a string shows a value where it is joined to it: `\"r = \" + r`"},
        {"times", "many are made by a loop: `for i in 0..5 { … }`"},
        {"view", "the shapes of a file are the scene, and a `camera(…)` looks at it"},
        {"discard", "a field has a value everywhere: return a distance instead"},
        {"any", "vectors are compared by their parts: `p.x > 1 or p.y > 1`"},
        {"all", "vectors are compared by their parts: `p.x > 1 and p.y > 1`"},
        {"greaterThan", "vectors are compared by their parts: `p.x > 1 or p.y > 1`"},
        {"lessThan", "vectors are compared by their parts: `p.x < 1 and p.y < 1`"},
        {"THREE", "there is no three.js here: a shape is made by a call, as `sphere(1)`"},
        {"CSG", "shapes are combined by `|`, `-` and `&`"},
        {"scene", "the shapes of a file are the scene: nothing is added to it"},
        {"renderer", "a picture is made by `fathom render scene.sdf -o scene.png`"},
        {"render", "a picture is made by `fathom render scene.sdf -o scene.png`"},
        {"document", "there is no page: the shapes of a file are the scene"},
        {"createCanvas", "the size of a picture is said where it is made: `fathom render --size`"},
        {"frameCount", "what moves is computed of the seconds: `time`"},
        {"performance", "the seconds are `time`"},
        {"Date", "the seconds are `time`"},
        {"millis", "the seconds are `time`"},
        {"requestAnimationFrame",
         "what moves is computed of the seconds: `.rotate(time, axis: Y)`"},
        {"animate", "what moves is computed of the seconds: `.translate(y: sin(time))`"},
        {"animation", "what moves is computed of the seconds: `.translate(y: sin(time))`"},
        {"keyframe", "values at times are `keyframes(…)`, of the seconds `time`"},
        {"pushMatrix", "a transform holds for the shape that it stands behind, and for no other"},
        {"popMatrix", "a transform holds for the shape that it stands behind, and for no other"},
        {"stroke", "a surface has no lines; a shape is given a colour by `.paint(…)`"},
        {"noStroke", "a surface has no lines; leave it away"},
        {"metal", "a metal is `material(diffuse: gold, specular: gold, exponent: 200)`"},
        {"plastic", "a plastic is `material(diffuse: red, specular: white, exponent: 50)`"},
        {"glass", "there is nothing that light passes through; a gloss is `exponent: 500`"},
        {"Material", "a material is `material(diffuse: red, exponent: 50)`"},
        {"__name__", "a file is run as it stands: leave the `if` away"},
        {"is_undef", "every name has a value: leave the question away"},
        {"modifiers", "edges are rounded by `rounded_box(size, r)`, or `.offset(r)` of a smaller "
                      "shape"}};
    const auto it = ways.find(name);
    return it == ways.end() ? std::string_view() : it->second;
}

std::string_view way_from_elsewhere(std::string_view name) {
    static const std::unordered_map<std::string_view, std::string_view> ways = {
        {"slider", "a slider is declared by `param r = 1 in 0..2`"},
        {"knob", "a slider is declared by `param r = 1 in 0..2`"},
        {"mm", "a length has no unit: all of a scene are in the same"},
        {"cm", "a length has no unit: all of a scene are in the same"},
        {"self", "there are no objects: a function is given what it needs as arguments"},
        {"this", "there are no objects: a function is given what it needs as arguments"},
        {"uniform",
         "a random number from 0 to 1 is `random(seed)`, a slider `param r = 1 in 0..2`"},
        {"children", "the shapes that a function is given are a parameter: "
                     "`fn ring(s) { … s … }`"},
        {"function", "a function without a name is written `p => …`"},
        {"lambda", "a function without a name is written `p => …`"},
        {"t", "the seconds are `time`"},
        {"save", "a mesh is written by `fathom mesh scene.sdf -o scene.stl`"},
        {"export", "a mesh is written by `fathom mesh scene.sdf -o scene.stl`"},
        {"require", "the library needs no import; a file is brought in by `import \"file.sdf\"`"},
        {"morph", "one shape turns into another by `blend(a, b, t)`"},
        {"sdf", "the library's names stand alone, as in `sphere(1)`"},
        {"k", "shapes flow together in `smooth_union(k) { … }`"},
        {"smooth", "shapes flow together in `smooth_union(k) { … }`"},
        {"hull", "there is no convex hull; `smooth_union(r) { … }` joins shapes, `round_cone` and "
                 "`capsule` join two balls"},
        {"minkowski", "there is no Minkowski sum; with a ball it is `.offset(r)`"},
        {"polyhedron", "a convex solid is an intersection of planes: `plane(normal, offset) & …`"},
        {"text", "there are no letters; a flat shape is made by `polygon`, `segment` and `bezier`"},
        {"text3d", "there are no letters; a flat shape is made by `polygon` and `segment`"},
        {"projection", "there is no projection; flat shapes are `circle`, `rectangle`, `polygon`"},
        {"surface", "a height field is `heightfield(f, size)`"},
        {"texture", "an image is a field: `image(\"file.png\")`, called with a vec2"},
        {"texture2D", "an image is a field: `image(\"file.png\")`, called with a vec2"},
        {"iResolution", "a field knows no screen: it is a function of the point alone"},
        {"fragCoord", "a field knows no screen: it is a function of the point alone"},
        {"gl_FragCoord", "a field knows no screen: it is a function of the point alone"},
        {"sum", "a list is summed by `fold(list, 0, (a, b) => a + b)`"},
        {"reduce", "a list is folded by `fold(list, first, (a, b) => …)`"},
        {"enumerate", "write `for i in 0..len(list) { let x = list[i] … }`"},
        {"str", "a string shows a value where it is joined to it: `\"r = \" + r`"},
        {"String", "a string shows a value where it is joined to it: `\"r = \" + r`"},
        {"deg", "the unit touches its number, `45deg`; a name is converted by `radians(x)`"},
        {"rad", "an angle is in radians as it is"},
        {"iChannel0", "an image is `image(\"file.png\")`, called with a vec2"},
        {"pass", "an empty body is `{ }`; leave the word away"},
        {"append", "a list is made by `[for i in 0..n { … }]`; `concat(list, [x])` gives a longer "
                   "one"},
        {"push", "a list is made by `[for i in 0..n { … }]`; `concat(list, [x])` gives a longer "
                 "one"},
        {"bpy", "there is no Blender here: a shape is made by a call, as `sphere(1)`"},
        {"linspace", "n numbers from a to b are `[for i in 0..n { mix(a, b, i / (n - 1)) }]`"},
        {"arange", "numbers in steps are `range(first, last, step)`"},
        {"Array", "a list is made by `[for i in 0..n { … }]`"},
        {"list", "a list needs no conversion: leave `list( … )` away"},
        {"tuple", "a list is written in brackets: `[1, 2, 3]`"},
        {"Some", "every name has a value: leave `Some( … )` away"},
        {"Ok", "every name has a value: leave `Ok( … )` away"},
        {"unwrap_or", "every name has a value: leave it away"},
        {"orient", "a shape is turned by `.rotate(90deg, axis: X)`; `cylinder`, `torus` and such "
                   "lie along Y"},
        {"bevel",
         "edges are rounded by `rounded_box(size, r)`, or `.offset(r)` of a smaller shape"},
        {"chamfer", "edges are rounded by `rounded_box(size, r)`, or `.offset(r)` of a smaller "
                    "shape"},
        {"fillet",
         "edges are rounded by `rounded_box(size, r)`, joints by `smooth_union(r) { … }`"},
        {"osc", "what swings is computed of `time`: `sin(time)`"},
        {"shade", "a shape is given a colour or a material by `.paint(…)`"},
        {"extend", "lists are joined by `concat(a, b)`, which gives a new one"},
        {"forEach", "a loop runs over a list: `for x in list { … }`"},
        {"for_each", "a loop runs over a list: `for x in list { … }`"},
        {"colorize", "a shape is given a colour or a material by `.paint(…)`"},
        {"colour", "a shape is given a colour or a material by `.paint(…)`"},
        {"hue", "a colour by its hue is `hsv(h, s, v)`"},
        {"make_shape", "a shape is made of a function of the point: `implicit(p => …)`"},
        {"NaN", "every number has a value; where there is no limit, write `inf`"},
        {"nan", "every number has a value; where there is no limit, write `inf`"},
        {"Infinity", "write `inf`"},
        {"rotateX", "write `.rotate(angle, axis: X)`"},
        {"rotateY", "write `.rotate(angle, axis: Y)`"},
        {"rotateZ", "write `.rotate(angle, axis: Z)`"},
        {"rotate_x", "write `.rotate(angle, axis: X)`"},
        {"rotate_y", "write `.rotate(angle, axis: Y)`"},
        {"rotate_z", "write `.rotate(angle, axis: Z)`"}};
    const auto it = ways.find(name);
    return it == ways.end() ? way_from_libraries(name) : it->second;
}

std::string_view way_of_type(std::string_view name) {
    static const std::unordered_map<std::string_view, std::string_view> ways = {
        {"list", "a list says what it holds: `[float]`, `[shape]`"},
        {"List", "a list says what it holds: `[float]`, `[shape]`"},
        {"array", "a list says what it holds: `[float]`, `[shape]`"},
        {"Array", "a list says what it holds: `[float]`, `[shape]`"},
        {"tuple", "a list says what it holds: `[float]`, `[shape]`"},
        {"vec", "a vector says how many numbers it has: `vec2`, `vec3`, `vec4`"},
        {"Vec", "a vector says how many numbers it has: `vec2`, `vec3`, `vec4`"},
        {"vector", "a vector says how many numbers it has: `vec2`, `vec3`, `vec4`"},
        {"Vector", "a vector says how many numbers it has: `vec2`, `vec3`, `vec4`"},
        {"function", "a function says what it takes and gives: `(vec3) -> float`"},
        {"Function", "a function says what it takes and gives: `(vec3) -> float`"},
        {"func", "a function says what it takes and gives: `(vec3) -> float`"},
        {"Callable", "a function says what it takes and gives: `(vec3) -> float`"},
        {"any", "what may be of any type has none: leave it away"},
        {"object", "what may be of any type has none: leave it away"},
        {"void", "a function without a result has no `->`"}};
    const auto it = ways.find(name);
    return it == ways.end() ? std::string_view() : it->second;
}

std::string_view type_from_elsewhere(std::string_view name) {
    static const std::unordered_map<std::string_view, std::string_view> ours = {
        {"number", "float"}, {"real", "float"},  {"double", "float"},  {"integer", "int"},
        {"boolean", "bool"}, {"str", "string"},  {"String", "string"}, {"Vector2", "vec2"},
        {"Vector3", "vec3"}, {"float2", "vec2"}, {"float3", "vec3"},   {"point", "vec3"},
        {"colour", "color"}, {"solid", "shape"}, {"SDF", "shape"},     {"matrix", "mat3"},
        {"f32", "float"},    {"f64", "float"},   {"num", "float"},     {"Number", "float"},
        {"i32", "int"},      {"u32", "int"},     {"usize", "int"},     {"Vec2", "vec2"},
        {"Vec3", "vec3"},    {"vec2f", "vec2"},  {"vec3f", "vec3"},    {"Shape", "shape"}};
    const auto it = ours.find(name);
    return it == ours.end() ? std::string_view() : it->second;
}

} // namespace fathom::typecheck
