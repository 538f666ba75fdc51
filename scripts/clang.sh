#!/bin/sh
# Builds everything with clang++ and its own standard library, libc++, in build-clang/, warnings as errors, and runs the tests with it.
#   scripts/clang.sh build             only builds, the program alone, without optimization, OpenGL and OpenVDB, in half of the time
#   scripts/clang.sh [CTEST OPTIONS]   builds and tests
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages "$build_packages" "$test_packages" || exit 3
use_ccache
cd "$root" || exit 3
if [ "${1:-}" = build ]; then
    cmake --preset clang -DCMAKE_CXX_FLAGS_RELEASE=-O0 -DFATHOM_TESTS=OFF -DFATHOM_GL=OFF -DFATHOM_VIEWER=OFF -DFATHOM_VDB=OFF >&2 || exit 1
    exec cmake --build --preset clang --target fathom >&2
fi
cmake --preset clang -DCMAKE_CXX_FLAGS_RELEASE=-O1 -UFATHOM_TESTS -UFATHOM_GL -UFATHOM_VIEWER -UFATHOM_VDB >&2 || exit 1
cmake --build --preset clang >&2 || exit 1
exec ctest --preset clang "$@"
