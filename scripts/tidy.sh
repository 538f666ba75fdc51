#!/bin/sh
# clang-tidy over the program's sources, by .clang-tidy; needs a build in build/ (./fathom makes one) and Debian's clang-tidy.
# Takes about ten minutes on two cores. Arguments name folders or files: `scripts/tidy.sh ir typecheck`.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
cd "$root" || exit 3
[ -e build/compile_commands.json ] || { echo "build first: ./fathom --version" >&2; exit 3; }
[ $# -gt 0 ] || set -- base lang ir typecheck backend-glsl backend-cpu save-format driver cli render-gl viewer bench
find "$@" -name '*.cpp' -print0 | xargs -0 -P "$(nproc)" -n 1 clang-tidy -p build --quiet
