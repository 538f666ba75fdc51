#!/bin/sh
# Makes the pictures of docs/gallery: one of each example, by the program itself. Takes some minutes without a graphics card.
#   scripts/gallery.sh [NAME…]     the examples of these names alone
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
cd "$root" || exit 1
mkdir -p docs/gallery
failed=0
[ $# -gt 0 ] || set -- $(cd examples && ls *.sdf | sed 's/\.sdf$//')
for name in "$@"; do
    ./fathom render "examples/$name.sdf" -o "docs/gallery/$name.png" --size 800x600 --samples 4 || failed=1
done
exit $failed
