#!/bin/sh
# The checks that take too long for every change: the tests by clang++, each file compiled by itself,
# the sanitizers, clang-tidy, ten minutes of each fuzzer, the coverage of the front end, the editors and
# the pages in real programs, other programs' judgement of meshes, the Debian packages built twice, two ops more, and the columns of the op
# table. Each leaves its output in build-weekly/; the last lines say what passed. Takes some hours on
# two cores.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
cd "$root" && mkdir -p build-weekly || exit 3
failed=0
try() { # NAME COMMAND…
    name=$1
    shift
    if "$@" >"build-weekly/$name.log" 2>&1; then result=passed; else result=FAILED failed=1; fi
    printf '%-16s %s\n' "$name" "$result" | tee -a build-weekly/summary
}
: >build-weekly/summary
try clang scripts/clang.sh
try apart sh -c 'cmake -G Ninja -S . -B build-apart && cmake --build build-apart -- -k 0'
try effort env FATHOM_EFFORT=12 ctest --test-dir build --output-on-failure -E fuzz
try floats env FATHOM_EFFORT=997 build/test_cpu 'exp, log and hyperbolic functions*'
try sanitize scripts/sanitize.sh
try tidy scripts/tidy.sh
try argument_order scripts/argument_order.sh
try same_text scripts/same_text.sh build/fathom build-clang/fathom all
for target in parse_fuzz compile_fuzz agree_fuzz yaml_fuzz save_fuzz image_fuzz lsp_fuzz; do try $target scripts/fuzz.sh $target 600; done
try cuts env FATHOM_CUTS=all build/test_lsp 'a text that ends early is known above its end'
try coverage scripts/coverage.sh
try editors scripts/editors.sh
try pages scripts/pages.sh
try judges scripts/judges.sh
try packages scripts/packages.sh
try ops scripts/weekly-ops.sh
try columns scripts/weekly-columns.sh
exit $failed
