;;; fathom-words.el --- the words of Fathom  -*- lexical-binding: t -*-
;; Written by editors/make.py from `fathom doc --json`; do not change it here.

;;; Code:
(defconst fathom-control '("break" "else" "for" "if" "import" "in" "return" "while"))
(defconst fathom-declaring '("fn" "let" "param" "var" "and" "not" "or"))
(defconst fathom-truths '("false" "true"))
(defconst fathom-types '("angle" "angles" "bool" "color" "float" "int" "light" "mat2" "mat3" "mat4" "material" "region" "shape" "shape2" "string" "vec2" "vec3" "vec4"))
(defconst fathom-units '("deg" "rad" "turn"))
(defconst fathom-constants
  '("X" "Y" "Z" "empty" "everywhere" "inf" "none" "pi" "tau" "time" "turn"))
(defconst fathom-colors
  '("aliceblue" "antiquewhite" "aqua" "aquamarine" "azure" "beige" "bisque" "black"
    "blanchedalmond" "blue" "blueviolet" "brown" "burlywood" "cadetblue"
    "chartreuse" "chocolate" "coral" "cornflowerblue" "cornsilk" "crimson" "cyan"
    "darkblue" "darkcyan" "darkgoldenrod" "darkgray" "darkgreen" "darkgrey"
    "darkkhaki" "darkmagenta" "darkolivegreen" "darkorange" "darkorchid" "darkred"
    "darksalmon" "darkseagreen" "darkslateblue" "darkslategray" "darkslategrey"
    "darkturquoise" "darkviolet" "deeppink" "deepskyblue" "dimgray" "dimgrey"
    "dodgerblue" "firebrick" "floralwhite" "forestgreen" "fuchsia" "gainsboro"
    "ghostwhite" "gold" "goldenrod" "gray" "green" "greenyellow" "grey" "honeydew"
    "hotpink" "indianred" "indigo" "ivory" "khaki" "lavender" "lavenderblush"
    "lawngreen" "lemonchiffon" "lightblue" "lightcoral" "lightcyan"
    "lightgoldenrodyellow" "lightgray" "lightgreen" "lightgrey" "lightpink"
    "lightsalmon" "lightseagreen" "lightskyblue" "lightslategray" "lightslategrey"
    "lightsteelblue" "lightyellow" "lime" "limegreen" "linen" "magenta" "maroon"
    "mediumaquamarine" "mediumblue" "mediumorchid" "mediumpurple" "mediumseagreen"
    "mediumslateblue" "mediumspringgreen" "mediumturquoise" "mediumvioletred"
    "midnightblue" "mintcream" "mistyrose" "moccasin" "navajowhite" "navy"
    "oldlace" "olive" "olivedrab" "orange" "orangered" "orchid" "palegoldenrod"
    "palegreen" "paleturquoise" "palevioletred" "papayawhip" "peachpuff" "peru"
    "pink" "plum" "powderblue" "purple" "rebeccapurple" "red" "rosybrown"
    "royalblue" "saddlebrown" "salmon" "sandybrown" "seagreen" "seashell" "sienna"
    "silver" "skyblue" "slateblue" "slategray" "slategrey" "snow" "springgreen"
    "steelblue" "teal" "thistle" "tomato" "turquoise" "violet" "wheat" "white"
    "whitesmoke" "yellow" "yellowgreen"))
(defconst fathom-functions
  '("aabb" "abs" "acos" "acosh" "arc" "asin" "asinh" "assert" "atan" "atanh"
    "background" "ball" "bend" "bezier" "blend" "box" "box_frame" "cached" "camera"
    "capped_cone" "capped_torus" "capsule" "ceil" "chamfer_difference"
    "chamfer_intersection" "chamfer_union" "circle" "clamp" "columns_difference"
    "columns_intersection" "columns_union" "complement" "concat" "cone" "cos"
    "cosh" "cross" "cylinder" "degrees" "determinant" "difference" "displace"
    "displace_map" "distance" "distance_grid" "distort" "div" "dodecahedron" "dot"
    "ease_back" "ease_bounce" "ease_in" "ease_in_out" "ease_out" "ellipse"
    "ellipsoid" "elongate" "engrave" "exp" "exp2" "extrude" "faceforward" "fbm"
    "filter" "float" "floor" "fold" "fract" "gdf" "gdf_blend" "gdf_cube"
    "gdf_dodecahedron" "gdf_icosahedron" "gdf_octahedron" "gdf_tetrahedron"
    "gdf_truncated_icosahedron" "gdf_truncated_octahedron" "groove" "gyroid" "hash"
    "heightfield" "helix" "hide" "hsv" "hyperize" "icosahedron" "image" "implicit"
    "implicit2" "int" "intersection" "inverse" "inversesqrt" "keyframes" "len"
    "length" "light" "lighting" "link" "lipschitz" "log" "log2" "mandelbulb" "map"
    "map_range" "mat2" "mat3" "mat4" "material" "max" "menger" "metaballs"
    "metaballs_random" "min" "mirror" "mix" "mod" "noise" "normalize" "octahedron"
    "offset" "only" "orient" "outerProduct" "paint" "palette" "pick" "pipe" "plane"
    "polygon" "pow" "print" "prism" "pseudonorm_blend" "pyramid" "radians" "random"
    "range" "rectangle" "reflect" "refract" "regular_polygon" "render" "repaint"
    "repeat" "repeat_mirror" "repeat_polar" "reverse" "revolve" "rgb" "ridged"
    "ring" "rotate" "rotate2" "rotate_euler" "round" "round_cone"
    "round_difference" "round_intersection" "round_union" "rounded_box"
    "rounded_cylinder" "rounded_rectangle" "saturate" "scale" "schwarz_p" "segment"
    "shell" "shuffle" "sign" "simplex" "sin" "sinh" "slab" "smax" "smin"
    "smooth_difference" "smooth_intersection" "smooth_union" "smoothstep" "sort"
    "sphere" "spot_noise" "sqrt" "stairs_difference" "stairs_intersection"
    "stairs_union" "star" "step" "sun" "superquadric" "tan" "tanh" "taper"
    "tetrahedron" "tongue" "torus" "translate" "transpose" "triplanar" "trunc"
    "tube" "tubes" "turbulence" "turnaround" "twist" "union" "value_noise" "vec2"
    "vec3" "vec4" "within" "worley" "xor" "zip"))

(provide 'fathom-words)
;;; fathom-words.el ends here
