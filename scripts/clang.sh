#!/bin/sh
# Everything with clang++, warnings as errors, in build-clang/, and the whole test suite with it. Arguments go to ctest.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
cmake -G Ninja -S "$root" -B "$root/build-clang" -DCMAKE_CXX_COMPILER=clang++ || exit 3
ninja -C "$root/build-clang" || exit 3
exec ctest --test-dir "$root/build-clang" --output-on-failure "$@"
