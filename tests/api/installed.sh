#!/bin/sh
# Installs a build into a folder of its own and builds programs outside of the tree against it, by CMake and by
# pkg-config: installed.sh BUILD CONSUMER
set -eu
build=$1
consumer=$2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

cmake --install "$build" --prefix "$place/usr" >"$place/install.log"
cmake -G Ninja -S "$consumer" -B "$place/build" -DCMAKE_PREFIX_PATH="$place/usr" >"$place/configure.log"
cmake --build "$place/build"
"$place/build/points" "$consumer/ball.sdf"
"$place/build/points_c" "$consumer/ball.sdf"
grep -q 'void main' "$place/build/ball.frag"

PKG_CONFIG_PATH=$(dirname "$(find "$place/usr" -name fathom.pc)")
export PKG_CONFIG_PATH
# The paths in fathom.pc are those of the configured prefix.
flags=$(pkg-config --define-variable=prefix="$place/usr" --cflags --libs fathom)
# shellcheck disable=SC2086 # several words
${CC:-cc} -std=c11 "$consumer/points.c" $flags -lm -o "$place/points_c"
LD_LIBRARY_PATH=$(pkg-config --define-variable=prefix="$place/usr" --variable=libdir fathom) \
    "$place/points_c" "$consumer/ball.sdf"

# Nothing but the names of the headers is exported: the C interface and fathom::v1.
nm -D --defined-only -C "$(find "$place/usr" -name 'libfathom.so' | head -1)" | sed 's/^[0-9a-f]* . //' >"$place/names"
if grep -vE '^fathom_|fathom::v1::|^(_init|_fini|_edata|_end|__bss_start)' "$place/names" | head -5 | grep .; then
    echo 'libfathom exports names that are not its own' >&2
    exit 1
fi
