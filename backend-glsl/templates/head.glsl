$# A text's first lines.
$if VERSION
#version $VERSION
$end
$WRITTEN_BY
$if !OWN
// The bound of its field is $PROOF.
$end
$if FIELD_ONLY
// For a renderer of one's own: a step of sdf(p) never passes a surface.
$else
// $USE
$end
$FIXED_PARAMS
$if ES
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
$end
