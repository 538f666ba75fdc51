#!/bin/sh
# Installs a build into a folder of its own and builds programs outside of the tree against it, by CMake, by pkg-config
# and as a part of their own build: installed.sh BUILD CONSUMER
set -eu
build=$1
consumer=$2
source=$(dirname "$(dirname "$(dirname "$consumer")")")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

# The folder is moved, so that nothing can depend on where it was installed.
cmake --install "$build" --prefix "$place/made" >"$place/install.log"
mv "$place/made" "$place/usr"

cmake -G Ninja -S "$consumer" -B "$place/build" -DCMAKE_PREFIX_PATH="$place/usr" >"$place/configure.log"
cmake --build "$place/build"
for program in points points_static points_c; do "$place/build/$program" "$consumer/ball.sdf"; done
grep -q 'void main' "$place/build/ball.frag"
readelf -d "$place/build/points" | grep -q 'NEEDED.*libfathom\.so\.0\]'
if readelf -d "$place/build/points_static" | grep 'NEEDED.*libfathom'; then exit 1; fi

# A component that there is not is refused, as the ones that there are were not.
if cmake -G Ninja -S "$consumer" -B "$place/none" -DCMAKE_PREFIX_PATH="$place/usr" -DCOMPONENT=Ray >"$place/none.log" 2>&1
then echo 'a component that there is not was found' >&2; exit 1; fi
grep -q 'no component of Fathom: Ray' "$place/none.log"

# As a part of the consumer's build, by either of CMake's ways. It is configured alone: to build it takes as long as the
# library does.
for fetch in OFF ON; do
    cmake -G Ninja -S "$consumer" -B "$place/part" -DFATHOM_TREE="$source" -DFETCH=$fetch >"$place/part.log"
    ninja -C "$place/part" -n points points_static points_c >"$place/part.log"
    rm -r "$place/part"
done

# Nothing but the names of the headers is exported: the C interface, as the list in the tree has it, and fathom::v1.
library=$(find "$place/usr" -name libfathom.so)
nm -D --defined-only "$library" | sed -n 's/^[0-9a-f]* . //p' | sed 's/@.*//' | LC_ALL=C sort >"$place/names"
if grep -vE '^fathom_|^_Z.*6fathom2v1|^(_init|_fini|_edata|_end|__bss_start)$' "$place/names" | head -n 5 | grep .; then
    echo 'libfathom exports names that are not its own' >&2
    exit 1
fi
grep '^fathom_' "$place/names" | diff "$source/api/c_symbols.txt" - || {
    echo 'the C interface differs from api/c_symbols.txt: what is gone or renamed breaks programs' >&2
    exit 1
}

PKG_CONFIG_PATH=$(dirname "$(find "$place/usr" -name fathom.pc)")
export PKG_CONFIG_PATH
try_c() { # NAME FLAGS…
    name=$1
    shift
    ${CC:-cc} -std=c11 "$consumer/points.c" "$@" -lm -o "$place/$name"
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir fathom) "$place/$name" "$consumer/ball.sdf"
}
# shellcheck disable=SC2046 # several words
try_c shared $(pkg-config --cflags --libs fathom)
rm "$(dirname "$library")"/libfathom.so*
# shellcheck disable=SC2046
try_c static $(pkg-config --static --cflags --libs fathom)
