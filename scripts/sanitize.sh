#!/bin/sh
# The unit tests under AddressSanitizer and UndefinedBehaviorSanitizer, in build-sanitize/. Takes about ten minutes.
# COMPILER=clang++ scripts/sanitize.sh takes the other compiler; arguments go to ctest.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
cmake -G Ninja -S "$root" -B "$root/build-sanitize" -DFATHOM_SANITIZE=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1" \
    ${COMPILER:+-DCMAKE_CXX_COMPILER=$COMPILER} ${CCACHE:+-DCMAKE_CXX_COMPILER_LAUNCHER=ccache} || exit 3
ninja -C "$root/build-sanitize" || exit 3
exec ctest --test-dir "$root/build-sanitize" --output-on-failure -R 'unit_|golden|conformance' "$@"
