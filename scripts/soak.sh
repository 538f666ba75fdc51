#!/bin/sh
# Saves a scene many times under the viewer, and looks whether every save was shown and whether memory stays flat.
#   scripts/soak.sh [RELOADS]      2000 where nothing is said; some minutes without a graphics card
# Every tenth save is another shader, every 25th an error, the others another number. Needs Xvfb.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
reloads=${1:-2000}
folder=$(mktemp -d) || exit 1
viewer="" server=""
clean() {
    [ -n "$viewer" ] && kill "$viewer" 2>/dev/null
    [ -n "$server" ] && kill "$server" 2>/dev/null
    rm -rf "$folder"
}
trap clean EXIT
trap 'exit 1' INT TERM

mkfifo "$folder/number" || exit 1
Xvfb -displayfd 3 -screen 0 800x600x24 -nolisten tcp 3>"$folder/number" >/dev/null 2>&1 &
server=$!
read -r number <"$folder/number" || exit 1
unset WAYLAND_DISPLAY
export DISPLAY=":$number"

printf 'sphere(1)\n' >"$folder/scene.sdf"
"$root/build/fathom" view "$folder/scene.sdf" --size 160x120 --times >/dev/null 2>"$folder/said" &
viewer=$!
shown() { grep -c 'reload:' "$folder/said"; }
resident() { sed -n 's/^VmRSS:[^0-9]*\([0-9]*\).*/\1/p' "/proc/$viewer/status"; }
wait_for() { # COUNT
    tries=0
    while [ "$(shown)" -lt "$1" ]; do
        tries=$((tries + 1))
        if [ $tries -gt 3000 ] || ! kill -0 "$viewer" 2>/dev/null; then return 1; fi
        sleep 0.01
    done
}
wait_for 1 || { echo "soak: the viewer does not start" >&2; exit 1; }

missed=0 warm=0 i=1
while [ $i -le "$reloads" ]; do
    before=$(shown)
    size="0.5$(printf %04d $i)"
    case $((i % 50)) in
    0 | 25) text="sphre($size)" ;;
    10 | 30) text="box($size)" ;;
    20 | 40) text="torus(major: 1, minor: $size)" ;;
    *) text="sphere($size)" ;;
    esac
    printf '%s\n' "$text" >"$folder/scene.sdf"
    wait_for $((before + 1)) || { missed=$((missed + 1)); kill -0 "$viewer" 2>/dev/null || break; }
    # What is kept for good has been seen once by a tenth of the way.
    [ $i -eq $((reloads / 10)) ] && warm=$(resident)
    [ $((i % 500)) -eq 0 ] && echo "soak: $i reloads, $(resident) KB resident" >&2
    i=$((i + 1))
done
end=$(resident)
growth=$((${end:-0} - warm))
echo "soak: $reloads saves, $missed missed, $warm KB after a tenth, ${end:-0} KB at the end"
[ "$missed" -eq 0 ] && [ -n "$end" ] && [ "$growth" -lt 16384 ]
