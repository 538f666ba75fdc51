#!/bin/sh
# The hosts of examples/hosts that draw by OpenGL, built against an installed library: what they draw is what
# `fathom render` draws. hosts.sh BUILD HOSTS
set -eu
build=$1
hosts=$2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$build" --prefix "$place/usr" >"$place/install.log"
cmake -G Ninja -S "$hosts" -B "$place/hosts" -DCMAKE_PREFIX_PATH="$place/usr" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" >"$place/configure.log"
cmake --build "$place/hosts" >"$place/build.log" || { cat "$place/build.log" >&2; exit 1; }
cd "$place"

host() { # NAME WORDS…: in a display of its own, with what it prints in `said`
    name=$1
    shift
    xvfb-run -a "$place/hosts/$name" "$@" >"$place/said" 2>&1 || { cat "$place/said" >&2; exit 1; }
}
picture() { # OUT WORDS…: by `fathom render`, as the hosts see it
    out=$1
    shift
    "$build/fathom" render scene.sdf --size 640x360 --samples 1 --backend gl "$@" -o - --stream pam >"$out" 2>"$place/said"
}
alike() { # A B SHARE [C]: the share of all bytes of the pictures, in a thousand, which are more than 8 of 255 apart, is at most
    # that; where B is C to the byte it is not looked at
    python3 - "$@" <<'P'
import itertools, sys
a, b, *c = (open(name, "rb").read()[-640 * 360 * 3:] for name in sys.argv[1:3] + sys.argv[4:])
c = c[0] if c else itertools.repeat(None)
share = 1000 * sum(abs(x - y) > 8 and y != z for x, y, z in zip(a, b, c)) / len(a)
if len(a) != 640 * 360 * 3 or share > float(sys.argv[3]):
    sys.exit(f"{sys.argv[1]} and {sys.argv[2]} differ in {share:.2f} of 1000 bytes")
P
}

cat >scene.sdf <<'S'
param depth = 0.1 in 0.02..0.2
let bumps = cached(p => depth * fbm(2 * p, octaves: 5), cell: 0.05)
sphere(1).displace(bumps).paint(orange)
camera(at: [0, 0, 4], look_at: [0, 0, 0])
background(#203040)
S
picture exact
for target in glsl330 es300; do
    host window scene.sdf $target $target.ppm
    alike $target.ppm exact 0.1
done

# By cached values: as the program draws it by them, not as it draws it exactly; anew where a param moved.
picture cached --cache
host window scene.sdf glsl450 window.ppm # by the library's own passes
grep -qxE '(9[0-9]|100) % by cached values' said || { cat said >&2; exit 1; }
alike window.ppm cached 1 exact # the program computes the last twentieth of a still
host noise_cache scene.sdf cache.ppm
grep -q '^frame 3: ' said
alike cache.ppm cached 1 exact
if alike cached exact 20 2>/dev/null; then echo 'no cached value was drawn' >&2; exit 1; fi
if alike cache.ppm exact 20 2>/dev/null; then echo 'no cached value was drawn' >&2; exit 1; fi
picture deep --cache -D depth=0.18
picture exact -D depth=0.18
host noise_cache scene.sdf cache.ppm depth=0.18
alike cache.ppm deep 1 exact
for frames in 'frame 1: 9[0-9]* of' 'frame 5: 9[0-9]* of'; do # before the param was set, and after
    grep -q "^$frames" said || { cat said >&2; exit 1; }
done
