#!/bin/sh
# The library and the program without OpenGL and windows: nothing of either is asked for, and what stands in their place
# compiles. Nothing is built: all else is as with them. without_gl.sh SOURCE
set -eu
source=$1
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

configure() { cmake -G Ninja -S "$source" -B "$place/build" -DCMAKE_UNITY_BUILD=OFF -DFATHOM_PYTHON=OFF "$@" >"$place/log" 2>&1; }

# What cannot be had together is refused.
if configure -DFATHOM_GL=OFF; then echo 'tests were configured without what they test' >&2; exit 1; fi
grep -q 'FATHOM_TESTS needs' "$place/log"
rm -r "$place/build"
if configure -DFATHOM_GL=OFF -DFATHOM_VIEWER=ON -DFATHOM_TESTS=OFF; then echo 'a viewer was configured without OpenGL' >&2; exit 1; fi
grep -q 'FATHOM_VIEWER needs FATHOM_GL' "$place/log"
rm -r "$place/build"

for without in '-DFATHOM_VIEWER=OFF' '-DFATHOM_GL=OFF'; do
    configure "$without" -DFATHOM_TESTS=OFF || { cat "$place/log" >&2; exit 1; }
    wanted='glfw|imgui|viewer/viewer'
    [ "$without" = -DFATHOM_VIEWER=OFF ] || wanted="$wanted|epoxy|render-gl"
    if grep -E "$wanted" "$place/build/build.ninja"; then echo "wanted with $without" >&2; exit 1; fi
done
for stub in api/gl/without.cpp cli/view/without.cpp; do
    ${CXX:-c++} -std=c++20 -fsyntax-only -DFATHOM_BUILDS_ITSELF -I"$source" -I"$source/include" "$source/$stub"
done
