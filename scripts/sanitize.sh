#!/bin/sh
# Runs the unit, golden and conformance tests under AddressSanitizer and
# UndefinedBehaviorSanitizer, in build-sanitize/. Arguments go to ctest. Takes about ten minutes.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages "$build_packages" "$test_packages" || exit 3
use_ccache
cd "$root" && cmake --preset sanitize >&2 && cmake --build --preset sanitize >&2 || exit 1
exec ctest --preset sanitize -R 'unit_|golden|conformance' "$@"
