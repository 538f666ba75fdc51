// What other languages and libraries call things, and what they are called here, or how the same is
// done. The words stand by their meaning, as they are spelled in small letters without `_`: `smoothMin`
// and `smooth_min` are one. Those with other letters are taken as they are.
#include "typecheck/remedies.h"

#include "lang/vocabulary.h"

#include <unordered_map>
#include <unordered_set>

namespace fathom::typecheck {

namespace {

struct Row {
    std::string_view ours, theirs; // words, with spaces between
};

constexpr Row names[] = {
    {"box", "cube cuboid brick block rectangularprism boundingbox"},
    {"rounded_box", "roundbox roundedcuboid roundedcube roundcube bevelbox chamferbox boxround"},
    {"box_frame", "wirebox wireframebox"},
    {"sphere", "ball3 orb globe uvsphere icosphere geosphere"},
    {"ellipsoid", "spheroid"},
    {"cylinder", "cyl rod pole cappedcylinder"},
    {"rounded_cylinder", "roundcylinder roundedcyl"},
    {"capsule", "pill stadium verticalcapsule line3"},
    {"capped_cone", "frustum conefrustum truncatedcone conicalfrustum"},
    {"torus", "donut doughnut toroid"},
    {"plane", "halfspace ground halfplane groundplane infiniteplane"},
    {"prism", "hexprism hexagonalprism triprism triangularprism ngonprism polyprism"},
    {"pyramid", "squarepyramid"},
    {"helix", "spiral coil spring"},
    {"tubes", "polyline polytube wire sweep"},
    {"menger", "mengersponge sponge"},
    {"metaballs", "blobs metaball"},
    {"circle", "disc disk"},
    {"rectangle", "square rect quad"},
    {"rounded_rectangle", "roundrect roundedrect roundedsquare"},
    {"ellipse", "oval"},
    {"segment", "line"},
    {"bezier", "curve quadraticbezier"},
    {"regular_polygon", "ngon regularngon"},
    {"extrude", "linearextrude extrudelinear extrusion pancake"},
    {"revolve", "rotateextrude extruderotate revolution lathe"},
    {"union", "group Group combine merge join unite fuse add compound opu booleanunion"},
    {"intersection", "intersect intersectionof common overlap booleanintersect"},
    {"difference", "subtract subtraction cut carve remove sub minus booleandifference "
                   "booleansubtract"},
    {"smooth_union", "smoothblend softunion smunion sunion blendunion smoothadd smoothmerge"},
    {"smooth_difference", "smoothsubtract smoothsubtraction softsubtract smoothcut smoothsub"},
    {"smooth_intersection", "smoothintersect softintersection"},
    {"round_union", "unionround"},
    {"round_difference", "differenceround"},
    {"round_intersection", "intersectionround"},
    {"chamfer_union", "unionchamfer"},
    {"stairs_union", "unionstairs"},
    {"columns_union", "unioncolumns"},
    {"xor", "symmetricdifference exclusion"},
    {"complement", "invert negate"},
    {"translate", "move location position moveto moveby setposition setlocation shift trans "
                  "translation"},
    {"rotate", "spin rotateby rotation rotate3d setrotation"},
    {"rotate_euler", "rotatexyz euler rotationeuler seteuler"},
    {"orient", "alignto"},
    {"scale", "zoom enlarge setscale scaleby"},
    {"mirror", "symmetry symmetric flip symx symy symz symxz"},
    {"repeat", "tile tiled replicate lattice rep replim repetition limitedrepetition "
               "repeatlimited mod1 mod2 mod3 domainrepetition"},
    {"repeat_polar", "polarrepeat radialrepeat circulararray polararray circularpattern "
                     "modpolar radial polar"},
    {"shell", "onion hollow thicken"},
    {"offset", "inflate dilate expand outset opround oprounding"},
    {"elongate", "stretch"},
    {"displace", "perturb"},
    {"bend", "cheapbend"},
    {"distort", "warp deform domainwarp"},
    {"within", "clip crop"},
    {"mix", "lerp interpolate"},
    {"log", "ln"},
    {"fract", "frac"},
    {"abs", "fabs absolute"},
    {"mod", "fmod"},
    {"asin", "arcsin"},
    {"acos", "arccos"},
    {"atan", "atan2 arctan arctan2"},
    {"length", "mag norm magnitude"},
    {"distance", "dist"},
    {"inversesqrt", "rsqrt invsqrt"},
    {"pow", "power"},
    {"sign", "sgn signum"},
    {"ceil", "ceiling"},
    {"trunc", "truncate"},
    {"clamp", "constrain clip"},
    {"saturate", "clamp01"},
    {"normalize", "normalise normalized unit"},
    {"dot", "dotproduct"},
    {"cross", "crossproduct"},
    {"min", "minimum"},
    {"max", "maximum"},
    {"smin", "smoothmin softmin polysmin smincubic"},
    {"smax", "smoothmax softmax polysmax"},
    {"map_range", "remap rescale mapvalue"},
    {"radians", "deg2rad degtorad toradians"},
    {"degrees", "rad2deg radtodeg todegrees"},
    {"rotate2", "rot rot2 rot2d rotate2d rotationmatrix"},
    {"noise", "perlin perlinnoise noise3 noise3d pnoise cnoise gradientnoise"},
    {"simplex", "snoise simplexnoise opensimplex"},
    {"worley", "voronoi voronoinoise cellular cellnoise"},
    {"fbm", "fractalnoise"},
    {"rgb", "color color3 rgb255"},
    {"material", "meshstandardmaterial standardmaterial meshphongmaterial meshbasicmaterial "
                 "meshlambertmaterial meshphysicalmaterial"},
    {"hsv", "hsb hsl hsv2rgb"},
    {"palette", "gradient colorramp colormap"},
    {"image", "loadimage loadtexture imread"},
    {"random", "rand randf"},
    {"hash", "hash11 hash13 hash31"},
    {"pick", "choice choose oneof randomchoice"},
    {"shuffle", "shuffled"},
    {"sort", "sorted"},
    {"reverse", "reversed"},
    {"len", "count size"},
    {"float", "parsefloat tofloat f32 f64 f16"},
    {"int", "parseint toint i32 u32 i64"},
    {"print", "echo printf println"},
    {"vec2", "vector2 float2 point2 half2 vec2f"},
    {"vec3", "vector3 float3 point3 half3 vec3f fixed3"},
    {"vec4", "vector4 float4 half4 vec4f fixed4"},
    {"mat2", "mat2x2 float2x2"},
    {"mat3", "mat3x3 float3x3 matrix3"},
    {"pi", "PI mpi"},
    {"tau", "twopi"},
    {"time", "second itime iglobaltime utime seconds elapsed elapsedtime currenttime now"},
    {"inf", "infinity"},
    {"empty", "nothing"},
    {"X", "xaxis axisx unitx right"},
    {"Y", "yaxis axisy unity up Up vertical"},
    {"Z", "zaxis axisz unitz forward"},
    {"background", "sky skycolor backgroundcolor setbackground bgcolor clearcolor"},
    {"camera", "setcamera perspectivecamera"},
    {"light", "pointlight addlight lamp"},
    {"sun", "sunlight directionallight dirlight"},
    {"lighting", "ambientlight"},
    {"implicit", "frep levelset fromsdf"},
    {"implicit2", "implicit2d implicitflat shape2 shape2d sdf2"},
    {"keyframes", "timeline"},
    {"ease_in_out", "easeinout"},
    {"smoothstep", "smootherstep"},
};

// Of a row of names that one thing has, `ours` is a sentence.
constexpr Row ways[] = {
    {"a slider is declared by `param r = 1 in 0..2`", "slider knob inputnumber"},
    {"a length has no unit: all of a scene are in the same", "mm cm"},
    {"an angle about an axis is computed of the point: `atan(p.z, p.x)`", "theta phi"},
    {"there are no objects: a function is given what it needs as arguments", "self this"},
    {"a random number from 0 to 1 is `random(seed)`, a slider `param r = 1 in 0..2`", "uniform"},
    {"a whole number at random is `int(random(lo, hi + 1, seed))`",
     "randint randrange randominteger"},
    {"the shapes that a function is given are a parameter: `fn ring(parts: [shape])`, called as "
     "`ring { sphere(1) }`",
     "children"},
    {"no matrix moves a shape: `translate`, `rotate`, `scale` and `reflect` do", "multmatrix"},
    {"a function without a name is written `p => …`", "function lambda"},
    {"the seconds are `time`", "t performance Date millis"},
    {"what moves is computed of the seconds, `time`, which no frame counts",
     "frame frames framecount"},
    {"a mesh is written by `fathom mesh scene.sdf -o scene.stl`", "save export"},
    {"the library needs no import; a file is brought in by `import \"file.sdf\"`", "require"},
    {"one shape turns into another by `blend(a, b, t)`", "morph"},
    {"the library's names stand alone, as in `sphere(1)`", "sdf"},
    {"shapes flow together in `smooth_union(k) { … }`", "k smooth"},
    {"there is no convex hull: of two balls it is a `capsule` or a `round_cone`, of equal balls in "
     "the corners of a box a `rounded_box`, of flat faces an intersection of planes; other shapes "
     "are joined by `smooth_union(r) { … }`",
     "hull"},
    {"there is no Minkowski sum; with a ball it is `.offset(r)`", "minkowski"},
    {"a convex solid is an intersection of planes: `plane(normal, offset) & …`", "polyhedron"},
    {"there are no letters; a flat shape is made by `polygon`, `segment` and `bezier`",
     "text text3d text2d letters"},
    {"there is no projection; flat shapes are `circle`, `rectangle`, `polygon`", "projection"},
    {"a height field is `heightfield(f, size)`", "surface terrain heightmap"},
    {"a regular polygon is `regular_polygon(sides, radius)`, one by its corners `polygon([…])`",
     "triangle pentagon hexagon heptagon octagon poly"},
    {"half a ball is `sphere(r) - plane(Y, 0)`", "hemisphere halfsphere dome"},
    {"a hollow cylinder is `cylinder(r, h) - cylinder(r - t, h + 1)`", "hollowcylinder pipeshape"},
    {"an image is a field: `image(\"file.png\")`, called with a vec2",
     "texture texture2d ichannel0 ichannel1"},
    {"a field knows no screen: it is a function of the point alone",
     "iresolution uresolution fragcoord glfragcoord imouse umouse vuv"},
    {"a field knows no neighbours: what changes with the point is computed of it",
     "fwidth dfdx dfdy ddx ddy"},
    {"rays are marched by the program: the shapes of a file are the scene",
     "raymarch raymarching march castray getdist getnormal calcnormal mainimage fragcolor "
     "glfragcolor scenesdf"},
    {"the size of a picture is said where it is made: `fathom render --size`",
     "createcanvas resolution setresolution canvas"},
    {"shadows are a setting: `lighting(shadow_darkness: 0.7, soft_shadows: 0.05)`",
     "shadow shadows softshadow softshadows"},
    {"what is closed in is darkened by `lighting(ambient_occlusion: 1)`",
     "ao occlusion ambientocclusion"},
    {"light from all sides is a setting: `lighting(ambient: 0.2)`",
     "ambient ambientlight hemispherelight"},
    {"there is no fog: what has no end fades into the background, towards `render(far: …)`",
     "fog mist haze"},
    {"a list is summed by `fold(list, 0, (a, b) => a + b)`", "sum total accumulate"},
    {"the rest of an iteration is left out by an `if` around it: `if i != 2 { … }`", "continue"},
    {"a light is `light(at: …)`, `sun(direction: …)`; what all of them do is set by "
     "`lighting(…)`",
     "lights"},
    {"a mean is `fold(list, 0, (a, b) => a + b) / len(list)`", "mean average avg"},
    {"a list is multiplied by `fold(list, 1, (a, b) => a * b)`", "prod product"},
    {"a list is folded by `fold(list, first, (a, b) => …)`", "reduce foldl"},
    {"write `for i in 0..len(list) { let x = list[i] … }`", "enumerate"},
    {"a string shows a value where it is joined to it: `\"r = \" + r`",
     "str String format tostring"},
    {"the unit touches its number, `45deg`; a name is converted by `radians(x)`", "deg"},
    {"an angle is in radians as it is", "rad"},
    {"an empty body is `{ }`; leave the word away", "pass"},
    {"a list is made by `[for i in 0..n { … }]`; `concat(list, [x])` gives a longer one",
     "append push pushback"},
    {"there is no Blender here: a shape is made by a call, as `sphere(1)`", "bpy"},
    {"there is no three.js here: a shape is made by a call, as `sphere(1)`", "THREE"},
    {"there is no CadQuery here: a shape is made by a call, as `box([2, 1, 1])`", "cq cadquery"},
    {"the library's names stand alone, as in `length(v)`", "linalg"},
    {"there are no records: each part is a name of its own, and a list has its values",
     "Object Map Dictionary"},
    {"Euler's number is `exp(1)`, and its power `exp(x)`", "e euler E"},
    {"it is `a * b + c`", "fma"},
    {"two values are compared by `assert(a == b)`", "asserteq assertequal"},
    {"a cut is `a - b`, a row of copies `.repeat(cell)`, and edges are rounded by "
     "`rounded_box(size, r)`",
     "modifiers modifier"},
    {"n numbers from a to b are `[for i in 0..n { mix(a, b, i / (n - 1)) }]`", "linspace"},
    {"numbers in steps are `range(first, last, step)`", "arange"},
    {"a list is made by `[for i in 0..n { … }]`", "Array Vec"},
    {"a list needs no conversion: leave `list( … )` away", "list"},
    {"a list is written in brackets: `[1, 2, 3]`", "tuple"},
    {"there are no records: give each part a name of its own with `let`", "dict"},
    {"every name has a value: leave `Some( … )` away", "Some"},
    {"every name has a value: leave `Ok( … )` away", "Ok"},
    {"every name has a value: leave it away", "unwrapor isnan isnone exists"},
    {"every name has a value: leave the question away", "isundef isnull"},
    {"every name has one type, which nobody asks for: leave the question away",
     "typeof instanceof isinstance"},
    {"a square is `x ^ 2`", "sq sqr squared"},
    {"a cube root is `x ^ (1 / 3)`", "cbrt"},
    {"it is `log(x) / log(10)`", "log10"},
    {"it is `length([x, y])`", "hypot"},
    {"a shape is turned by `.rotate(90deg, axis: X)`; `cylinder`, `torus` and such lie along Y",
     "orient"},
    {"edges are rounded by `rounded_box(size, r)`, or `.offset(r)` of a smaller shape",
     "bevel chamfer rounded roundcorners roundedges"},
    {"copies in a row are `.repeat([2, 0, 0], count: [5, 1, 1])`: first how far apart, then how "
     "many "
     "along each axis",
     "array arraymodifier lineararray linearpattern"},
    {"`a | b` unites shapes, `a - b` cuts b out of a, `a & b` is what both have in common",
     "boolean booleanmodifier booleanop"},
    {"how it shines belongs to the paint: `.paint(material(diffuse: gold, exponent: 100))`; the "
     "larger `exponent`, the smaller the highlight",
     "shiny glossy shininess gloss specular roughness metallic"},
    {"edges are rounded by `rounded_box(size, r)`, joints by `smooth_union(r) { … }`", "fillet"},
    {"what swings is computed of `time`: `sin(time)`", "osc"},
    {"a shape is given a colour or a material by `.paint(…)`",
     "shade colorize colour setcolor setcolour setmaterial withcolor tint fill"},
    {"there is nothing that light passes through: a shape is drawn whole",
     "opacity alpha transparent transparency"},
    {"a shape is left out by `hide(…)`", "visible invisible"},
    {"lists are joined by `concat(a, b)`, which gives a new one", "extend"},
    {"a loop runs over a list: `for x in list { … }`", "foreach"},
    {"a colour by its hue is `hsv(h, s, v)`", "hue"},
    {"a shape is made of a function of the point: `implicit(p => …)`", "makeshape"},
    {"every number has a value; where there is no limit, write `inf`", "nan"},
    {"write `.rotate(angle, axis: X)`", "rotatex rotx"},
    {"write `.rotate(angle, axis: Y)`", "rotatey roty"},
    {"write `.rotate(angle, axis: Z)`", "rotatez rotz"},
    {"a transform holds for the shape that it stands behind, and for no other",
     "pop pushmatrix popmatrix pushpop"},
    {"a shape has its size from its call, and `.scale([1, 1, 2])` makes it so many times as large",
     "resize"},
    {"many are made by a loop: `for i in 0..5 { … }`", "times"},
    {"the shapes of a file are the scene, and a `camera(…)` looks at it", "view"},
    {"a field has a value everywhere: return a distance instead", "discard"},
    {"vectors are compared by their parts: `p.x > 1 or p.y > 1`", "any greaterthan"},
    {"vectors are compared by their parts: `p.x > 1 and p.y > 1`", "all"},
    {"vectors are compared by their parts: `p.x < 1 and p.y < 1`", "lessthan"},
    {"shapes are combined by `|`, `-` and `&`", "CSG Csg"},
    {"the shapes of a file are the scene: nothing is added to it", "scene show display"},
    {"a picture is made by `fathom render scene.sdf -o scene.png`", "renderer render draw"},
    {"there is no page: the shapes of a file are the scene", "document window"},
    {"what moves is computed of the seconds: `.rotate(time, axis: Y)`", "requestanimationframe"},
    {"what moves is computed of the seconds: `.translate(y: sin(time))`", "animate animation"},
    {"a scene waits for nothing: what moves is computed of the seconds, `time`",
     "sleep wait delay settimeout setinterval"},
    {"a number that is set from outside is `param r = 1 in 0..2`", "input prompt readline"},
    {"values at times are `keyframes(…)`, of the seconds `time`", "keyframe"},
    {"a surface has no lines; a shape is given a colour by `.paint(…)`", "stroke"},
    {"a surface has no lines; leave it away", "nostroke"},
    {"a metal is `material(diffuse: gold, specular: gold, exponent: 200)`", "metal"},
    {"a plastic is `material(diffuse: red, specular: white, exponent: 50)`", "plastic"},
    {"there is nothing that light passes through; a gloss is `exponent: 500`", "glass"},
    {"a material is `material(diffuse: red, exponent: 50)`", "Material"},
    {"a file is run as it stands: leave the `if` away", "__name__"},
};

constexpr Row ways_of_types[] = {
    {"a list says what it holds: `[float]`, `[shape]`", "list List array Array tuple"},
    {"a vector says how many numbers it has: `vec2`, `vec3`, `vec4`", "vec Vec vector Vector"},
    {"a function says what it takes and gives: `(vec3) -> float`",
     "function Function func Callable"},
    {"what may be of any type has none: leave it away", "any object auto"},
    {"a function without a result has no `->`", "void"},
};

constexpr Row types[] = {
    // beside lang::our_type
    {"float", "real num"}, {"int", "integer usize"},  {"string", "str"},
    {"vec2", "vector2"},   {"vec3", "vector3 point"}, {"vec4", "vector4"},
    {"color", "colour"},   {"shape", "solid sdf"},    {"mat3", "matrix"},
};

// What stands before and behind a thing's name where a library has a word for all of its kind: `sdBox`,
// `createCube`, `SphereGeometry`.
constexpr std::string_view prefixes[] = {"primitive", "create", "build", "draw", "make",
                                         "sdf",       "add",    "new",   "get",  "sd",
                                         "op",        "fop",    "f",     "p"};
constexpr std::string_view suffixes[] = {"buffergeometry", "geometry", "primitive", "shape", "mesh",
                                         "node",           "sdf",      "add",       "2d",    "3d"};

using Table = std::unordered_map<std::string_view, std::string_view>;

Table table_of(std::span<const Row> rows) {
    Table table;
    for (const Row &row : rows)
        for (std::size_t at = 0; at < row.theirs.size();) {
            const std::size_t end = std::min(row.theirs.find(' ', at), row.theirs.size());
            table.try_emplace(row.theirs.substr(at, end - at), row.ours);
            at = end + 1;
        }
    return table;
}

std::string_view look_in(const Table &table, std::string_view name) {
    if (const auto it = table.find(name); it != table.end()) return it->second;
    constexpr std::size_t shortest = 3, longest = 100; // of names whose letters may differ
    if (name.size() < shortest || name.size() > longest) return {};
    const auto it = table.find(plain_name(name));
    return it == table.end() ? std::string_view() : it->second;
}

} // namespace

std::string plain_name(std::string_view name) {
    std::string plain;
    for (const char c : name)
        if (c != '_') plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return plain;
}

std::vector<std::string> names_within(std::string_view name) {
    constexpr std::size_t shortest = 3, longest = 100;
    if (name.size() > longest) return {};
    const std::string plain = plain_name(name);
    std::vector<std::string> within{plain};
    const auto add = [&](std::string_view rest) {
        if (rest.size() >= shortest) within.emplace_back(rest);
    };
    for (const std::string_view prefix : prefixes)
        if (plain.starts_with(prefix)) add(std::string_view(plain).substr(prefix.size()));
    const std::size_t heads = within.size();
    for (const std::string_view suffix : suffixes)
        for (std::size_t i = 0; i < heads; ++i) {
            const std::string whole = within[i];
            if (whole.ends_with(suffix))
                add(std::string_view(whole).substr(0, whole.size() - suffix.size()));
        }
    return within;
}

bool is_needless_method(std::string_view name) {
    static const std::unordered_set<std::string_view> needless = {
        "shade_smooth", "save",         "export",      "write_stl", "show",   "render_png",
        "collect",      "iter",         "into_iter",   "iter_mut",  "to_vec", "clone",
        "copied",       "cloned",       "toArray",     "tolist",    "unwrap", "freeze",
        "subdivide",    "smooth_shade", "add_to_scene"};
    return needless.contains(name);
}

std::string_view name_from_elsewhere(std::string_view name) {
    static const Table table = table_of(names);
    return look_in(table, name);
}

std::string_view way_from_elsewhere(std::string_view name) {
    static const Table table = table_of(ways);
    return look_in(table, name);
}

std::string_view way_of_type(std::string_view name) {
    static const Table table = table_of(ways_of_types);
    return look_in(table, name);
}

std::string_view type_from_elsewhere(std::string_view name) {
    static const Table table = table_of(types);
    const std::string plain = plain_name(name);
    for (const std::string_view spelled : {name, std::string_view(plain)})
        if (const std::string_view ours = lang::our_type(spelled); ours != spelled) return ours;
    return look_in(table, name);
}

} // namespace fathom::typecheck
