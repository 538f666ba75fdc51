#!/bin/sh
# Builds the program with clang++ and clang-tidy (.clang-tidy) in build-tidy/; a finding is an error.
# Takes some tens of minutes on two cores.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages "$build_packages" clang clang-tidy || exit 3
cd "$root" && cmake --preset tidy >&2 && exec cmake --build --preset tidy --target fathom -- -k 0
