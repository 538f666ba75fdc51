#!/bin/sh
# Measures which lines of the front end the tests run: prints a row a file of lang/, ir/, proof/ and
# typecheck/ and the total, by clang's source-based coverage in build-coverage/.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages "$build_packages" "$test_packages" llvm || exit 3
use_ccache
tests='lang ir check proof stdlib golden conformance'
cd "$root" && cmake --preset coverage >&2 &&
    cmake --build --preset coverage --target $(printf 'test_%s ' $tests) >&2 || exit 1
profiles=$root/build-coverage/profiles
rm -rf "$profiles"
LLVM_PROFILE_FILE="$profiles/%p.profraw" ctest --preset coverage \
    -R "^(unit_)?($(echo $tests | tr ' ' '|'))\$" >&2 || exit 1
llvm-profdata merge -sparse "$profiles"/*.profraw -o "$profiles/all.profdata" || exit 1
objects=""
for program in "$root"/build-coverage/test_*; do
    [ -x "$program" ] && [ -f "$program" ] && objects="$objects -object $program"
done
exec llvm-cov report $objects -instr-profile "$profiles/all.profdata" \
    "$root/lang" "$root/ir" "$root/proof" "$root/typecheck"
