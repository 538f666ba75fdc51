" Syntax of Fathom. Written by editors/make.py from `fathom doc --json`; do not change it here.
if exists("b:current_syntax")
  finish
endif
syn case match
syn sync fromstart

syn match fathomName "\<\h\w*\>"
syn match fathomOperator "!=\|[-=|&<>+*/%^]\|\.\.=\|\.\."
syn match fathomNumber "\%(\w\)\@<!\%(\d\+\%(\.\d\+\)\?\|\.\d\+\)\%([eE][+-]\?\d\+\)\?\%(turn\|deg\|rad\)\?\w\@!"
syn match fathomColor "#\%(\x\{8}\|\x\{6}\|\x\{3}\)\w\@!"
syn match fathomArgument "\<\h\w*\>\ze\s*:"
syn match fathomCall "\<\h\w*\>\ze("
syn keyword fathomControl break else for if import in return while
syn keyword fathomDeclaration fn let param var
syn keyword fathomWordOperator and not or
syn keyword fathomTruth false true
syn keyword fathomConstant X Y Z empty everywhere inf none pi tau time turn
syn keyword fathomColorName aliceblue antiquewhite aqua aquamarine azure beige bisque black blanchedalmond
      \ blue blueviolet brown burlywood cadetblue chartreuse chocolate coral
      \ cornflowerblue cornsilk crimson cyan darkblue darkcyan darkgoldenrod darkgray
      \ darkgreen darkgrey darkkhaki darkmagenta darkolivegreen darkorange darkorchid
      \ darkred darksalmon darkseagreen darkslateblue darkslategray darkslategrey
      \ darkturquoise darkviolet deeppink deepskyblue dimgray dimgrey dodgerblue
      \ firebrick floralwhite forestgreen fuchsia gainsboro ghostwhite gold goldenrod
      \ gray green greenyellow grey honeydew hotpink indianred indigo ivory khaki
      \ lavender lavenderblush lawngreen lemonchiffon lightblue lightcoral lightcyan
      \ lightgoldenrodyellow lightgray lightgreen lightgrey lightpink lightsalmon
      \ lightseagreen lightskyblue lightslategray lightslategrey lightsteelblue
      \ lightyellow lime limegreen linen magenta maroon mediumaquamarine mediumblue
      \ mediumorchid mediumpurple mediumseagreen mediumslateblue mediumspringgreen
      \ mediumturquoise mediumvioletred midnightblue mintcream mistyrose moccasin
      \ navajowhite navy oldlace olive olivedrab orange orangered orchid palegoldenrod
      \ palegreen paleturquoise palevioletred papayawhip peachpuff peru pink plum
      \ powderblue purple rebeccapurple red rosybrown royalblue saddlebrown salmon
      \ sandybrown seagreen seashell sienna silver skyblue slateblue slategray
      \ slategrey snow springgreen steelblue teal thistle tomato turquoise violet wheat
      \ white whitesmoke yellow yellowgreen
" a keyword would win over an argument's name, so functions are matched
syn match fathomFunction "\<\%(gdf_truncated_icosahedron\|gdf_truncated_octahedron\|chamfer_intersection\|columns_intersection\|smooth_intersection\|stairs_intersection\|chamfer_difference\|columns_difference\|round_intersection\|rounded_rectangle\|smooth_difference\|stairs_difference\|gdf_dodecahedron\|metaballs_random\|pseudonorm_blend\|round_difference\|rounded_cylinder\|gdf_icosahedron\|gdf_tetrahedron\|regular_polygon\|gdf_octahedron\|chamfer_union\|columns_union\|distance_grid\|repeat_mirror\|capped_torus\|displace_map\|dodecahedron\|intersection\|outerProduct\|repeat_polar\|rotate_euler\|smooth_union\|stairs_union\|superquadric\|capped_cone\|determinant\|ease_bounce\|ease_in_out\|faceforward\|heightfield\|icosahedron\|inversesqrt\|round_union\|rounded_box\|tetrahedron\|value_noise\|background\|complement\|difference\|mandelbulb\|octahedron\|round_cone\|smoothstep\|spot_noise\|turbulence\|turnaround\|box_frame\|ease_back\|ellipsoid\|gdf_blend\|implicit2\|keyframes\|lipschitz\|map_range\|metaballs\|normalize\|rectangle\|schwarz_p\|translate\|transpose\|triplanar\|cylinder\|displace\|distance\|ease_out\|elongate\|gdf_cube\|hyperize\|implicit\|lighting\|material\|saturate\|capsule\|degrees\|distort\|ease_in\|ellipse\|engrave\|extrude\|inverse\|palette\|polygon\|pyramid\|radians\|reflect\|refract\|repaint\|reverse\|revolve\|rotate2\|segment\|shuffle\|simplex\|assert\|bezier\|cached\|camera\|circle\|concat\|filter\|groove\|gyroid\|length\|menger\|mirror\|offset\|orient\|random\|render\|repeat\|ridged\|rotate\|sphere\|tongue\|within\|worley\|acosh\|asinh\|atanh\|blend\|clamp\|cross\|float\|floor\|fract\|helix\|image\|light\|noise\|paint\|plane\|print\|prism\|range\|round\|scale\|shell\|taper\|torus\|trunc\|tubes\|twist\|union\|aabb\|acos\|asin\|atan\|ball\|bend\|ceil\|cone\|cosh\|exp2\|fold\|hash\|hide\|link\|log2\|mat2\|mat3\|mat4\|only\|pick\|pipe\|ring\|sign\|sinh\|slab\|smax\|smin\|sort\|sqrt\|star\|step\|tanh\|tube\|vec2\|vec3\|vec4\|abs\|arc\|box\|cos\|div\|dot\|exp\|fbm\|gdf\|hsv\|int\|len\|log\|map\|max\|min\|mix\|mod\|pow\|rgb\|sin\|sun\|tan\|xor\|zip\)\>\ze\s*[({]"
syn match fathomType "\%(:\|->\)\s*\[*\zs\%(material\|angles\|region\|shape2\|string\|angle\|color\|float\|light\|shape\|bool\|mat2\|mat3\|mat4\|vec2\|vec3\|vec4\|int\)\>\ze\s*\%([(]\)\@!"
syn match fathomControl "\.\@<!\<limit\>\ze\s\+[[:alnum:]_(]"
syn match fathomString "\"\%([^"\\]\|\\.\)*\""
syn match fathomString "\"\%([^"\\]\|\\.\)*\"\ze\s\+as\>" nextgroup=fathomAs skipwhite
syn match fathomAs "\<as\>" contained
syn match fathomComment "//.*$"
syn region fathomComment start="/\*" end="\*/"

hi def link fathomOperator Operator
hi def link fathomNumber Number
hi def link fathomColor Constant
hi def link fathomArgument Identifier
hi def link fathomCall Function
hi def link fathomControl Statement
hi def link fathomAs Statement
hi def link fathomDeclaration Keyword
hi def link fathomWordOperator Keyword
hi def link fathomTruth Boolean
hi def link fathomConstant Constant
hi def link fathomColorName Constant
hi def link fathomFunction Function
hi def link fathomType Type
hi def link fathomString String
hi def link fathomComment Comment

let b:current_syntax = "fathom"
