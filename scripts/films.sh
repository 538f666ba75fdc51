#!/bin/sh
# Makes the films of docs/gallery: ten seconds of each scene that moves, as an animated picture for the
# pages (docs/gallery/NAME.gif, below 3 MB) and as NAME.mp4 in build/films. Installs ffmpeg.
#   scripts/films.sh [NAME…]     the examples of these names alone
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
. "$root/scripts/setup.sh"
install_packages ffmpeg || exit 3
cd "$root" || exit 1
mkdir -p docs/gallery build/films
failed=0
[ $# -gt 0 ] || set -- orrery gears
for name in "$@"; do
    how="--backend cpu --samples 3"
    ./fathom render "examples/$name.sdf" $how --fps 12 --frames 0..120 --size 240x180 -o "docs/gallery/$name.gif" || failed=1
    [ "$(wc -c <"docs/gallery/$name.gif")" -lt 3000000 ] || { say "docs/gallery/$name.gif has 3 MB and more"; failed=1; }
    ./fathom render "examples/$name.sdf" $how --fps 24 --frames 0..240 --size 320x240 -o "build/films/$name.mp4" || failed=1
done
exit $failed
