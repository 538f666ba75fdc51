#!/bin/sh
# Builds everything with clang++ and its own standard library, libc++, in build-clang/, warnings as errors, and runs the tests with it.
#   scripts/clang.sh build             only builds, and the program alone
#   scripts/clang.sh [CTEST OPTIONS]   builds and tests
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages "$build_packages" "$test_packages" || exit 3
use_ccache
cd "$root" && cmake --preset clang >&2 || exit 1
[ "${1:-}" = build ] && exec cmake --build --preset clang --target fathom >&2
cmake --build --preset clang >&2 || exit 1
exec ctest --preset clang "$@"
