#!/bin/sh
# What other programs say of the files that the program writes: meshes of all examples by admesh and
# by gltf-validator, some of them by Blender, f3d, PrusaSlicer and OpenSCAD, a volume by vdb_print.
# `scripts/judges.sh --quick` tries few scenes by admesh, gltf-validator and vdb_print alone, which takes seconds
# (a test); a judge that is not installed is left out there, and said to be (.ci/run installs all three).
# What they said last: docs/meshes.md, 10.
# Leaves its files in build-judges/. Exit status 1 where a judge finds something.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
fathom=${FATHOM:-$root/build/fathom}
quick=false
[ "${1:-}" = --quick ] && quick=true
if $quick; then
    out=$(mktemp -d) || exit 3
    trap 'rm -rf "$out"' EXIT
else
    out=$root/build-judges
    install_packages admesh libopenvdb-tools blender python3-numpy f3d prusa-slicer openscad xvfb xauth || exit 3
    fetch_gltf_validator || exit 3
fi
mkdir -p "$out" || exit 3
failed=0
say_result() { # JUDGE SUBJECT ok|WRONG WORDS
    [ "$3" = ok ] || failed=1
    printf '%-14s %-34s %-6s %s\n' "$1" "$2" "$3" "$4"
}
there() { command -v "$1" >/dev/null || { say_result "$1" - ok "is not installed: left out"; return 1; }; }

# Of a scene without an end, what is in a box.
mesh_of() { # SCENE OUT OPTIONS…
    from=$1 to=$2
    shift 2
    "$fathom" mesh "$from" -o "$to" "$@" 2>"$out/words" ||
        "$fathom" mesh "$from" -o "$to" --bounds=-4.1,-1.8,-4.2,4.3,4.1,4 "$@" 2>"$out/words" || {
        say_result fathom "$(basename "$to")" WRONG "$(tail -n 1 "$out/words")"
        return 1
    }
}

admesh_of() { # STL
    words=$(admesh "$1" 2>&1)
    found=$(printf '%s\n' "$words" | awk -F: '/Edges fixed|Facets (removed|added|reversed)|Backwards edges|Total disconnected/ {
        split($2, n, " "); sum += n[1] } END { print sum + 0 }')
    count=$(printf '%s\n' "$words" | awk -F: '/Number of facets/ { split($2, n, " "); print n[1] }')
    if [ "$found" = 0 ] && [ "${count:-0}" -gt 0 ]; then
        say_result admesh "$(basename "$1")" ok "$count triangles"
    else
        say_result admesh "$(basename "$1")" WRONG "$words"
    fi
}

vdb_of() { # VDB
    if words=$(vdb_print -l "$1" 2>&1) && printf '%s' "$words" | grep -q 'level set'; then
        say_result vdb_print "$(basename "$1")" ok "$(printf '%s\n' "$words" | grep -c '^Name') grids"
    else
        say_result vdb_print "$(basename "$1")" WRONG "$words"
    fi
}

gltf_of() { # GLB…
    if [ -d "$gltf_validator/node_modules/gltf-validator" ] && command -v node >/dev/null; then
        node "$root/scripts/judge_gltf.cjs" "$gltf_validator" "$@" || failed=1
    else
        say_result gltf-validator - ok "is not installed: left out"
    fi
}

if $quick; then
    cat >"$out/spikes.sdf" <<'END'
box([2, 0.3, 2]).paint(tan)
for i in 0..5 { cone(0.3, 1).translate(x: 0.7, y: 0.5).rotate(i * turn / 5, axis: Y).paint(red) }
END
    for scene in "$root/examples/02_csg.sdf" "$root/examples/05_twisted_tower.sdf" "$out/spikes.sdf"; do
        name=$(basename "$scene" .sdf)
        there admesh && mesh_of "$scene" "$out/$name.stl" --resolution 32 && admesh_of "$out/$name.stl"
        mesh_of "$scene" "$out/$name.glb" --resolution 32
        mesh_of "$scene" "$out/$name.parts.glb" --resolution 32 --parts
    done
    gltf_of "$out"/*.glb
    if there vdb_print; then
        if "$fathom" volume "$out/spikes.sdf" -o "$out/spikes.vdb" --resolution 32 --certify off 2>"$out/words"; then
            vdb_of "$out/spikes.vdb"
        elif grep -q OpenVDB "$out/words"; then
            say_result vdb_print spikes.vdb ok "this build writes no .vdb: left out"
        else
            say_result fathom spikes.vdb WRONG "$(cat "$out/words")"
        fi
    fi
    exit $failed
fi

for scene in "$root"/examples/*.sdf; do
    name=$(basename "$scene" .sdf)
    mesh_of "$scene" "$out/$name.stl" --resolution 64 && admesh_of "$out/$name.stl"
    mesh_of "$scene" "$out/$name.glb" --resolution 48
    mesh_of "$scene" "$out/$name.parts.glb" --resolution 48 --parts
done
gltf_of "$out"/*.glb

for scene in gears 02_csg still_life; do
    "$fathom" volume "$root/examples/$scene.sdf" -o "$out/$scene.vdb" --resolution 48 --certify off \
        --bounds=-4.1,-1.3,-4.2,4.3,4.1,4 2>"$out/words" ||
        { say_result fathom "$scene.vdb" WRONG "$(tail -n 1 "$out/words")"; continue; }
    vdb_of "$out/$scene.vdb"
done

# Blender: objects, materials and triangles of one scene in each format.
for suffix in glb obj ply stl; do
    parts=
    case $suffix in glb | obj) parts=--parts ;; esac
    mesh_of "$root/examples/gears.sdf" "$out/blender.$suffix" --resolution 64 $parts
done
if blender -b --factory-startup -P "$root/scripts/judge_blender.py" -- "$out"/blender.glb "$out"/blender.obj \
    "$out"/blender.ply "$out"/blender.stl >"$out/blender.log" 2>&1; then
    sed -n 's/^judge: //p' "$out/blender.log"
    say_result blender blender.glb,obj,ply,stl ok ""
else
    say_result blender blender.glb,obj,ply,stl WRONG "$out/blender.log"
fi

# Pictures to look at.
for name in gears.parts still_life; do
    if xvfb-run -a f3d --output="$out/$name.png" --resolution=800,600 "$out/$name.glb" >"$out/words" 2>&1 &&
        [ -s "$out/$name.png" ]; then
        say_result f3d "$name.glb" ok "look at $out/$name.png"
    else
        say_result f3d "$name.glb" WRONG "$(cat "$out/words")"
    fi
done

# A slicer: a part of 40 mm.
cat >"$out/part.sdf" <<'END'
let base = rounded_box([40, 4, 30], 1).translate(y: 2) - cylinder(3, 10).translate(x: 12)
base.paint(steelblue)
cylinder(8, 20).translate(x: -8, y: 13.9).paint(orange)
END
for file in part.stl part.3mf parts.3mf; do
    case $file in parts*) parts=--parts ;; *) parts= ;; esac
    mesh_of "$out/part.sdf" "$out/$file" --tolerance 0.4 $parts
    if prusa-slicer --export-gcode -o "$out/$file.gcode" "$out/$file" >"$out/words" 2>&1 && [ -s "$out/$file.gcode" ]; then
        say_result prusa-slicer "$file" ok "$(grep -c '^;LAYER_CHANGE' "$out/$file.gcode") layers"
    else
        say_result prusa-slicer "$file" WRONG "$(tail -n 1 "$out/words")"
    fi
done

# OpenSCAD unites the part with a cube by CGAL, which takes closed solids alone.
printf 'union() { import("part.stl"); translate([-4, 0, -4]) cube([8, 30, 8]); }\n' >"$out/with_cube.scad"
mesh_of "$out/part.sdf" "$out/part.stl" --tolerance 1
if (cd "$out" && timeout 900 openscad -o united.stl with_cube.scad) >"$out/words" 2>&1 && grep -q 'Simple: *yes' "$out/words"; then
    say_result openscad part.stl ok "$(grep Facets "$out/words" | tr -s ' ')"
else
    say_result openscad part.stl WRONG "$(tail -n 3 "$out/words")"
fi
exit $failed
