#!/bin/sh
# Runs every libFuzzer target after another, each for two hours unless said, and prints how many
# inputs each has tried and what it covers:
#   scripts/fuzz_overnight.sh [SECONDS]
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
seconds=${1:-7200}
failed=0
mkdir -p "$root/build-fuzz" || exit 3
for target in parse_fuzz compile_fuzz agree_fuzz yaml_fuzz save_fuzz image_fuzz lsp_fuzz; do
    log=$root/build-fuzz/$target.log
    if "$root/scripts/fuzz.sh" $target "$seconds" >"$log" 2>&1; then result=passed; else result=FAILED failed=1; fi
    inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
    printf '%-14s %s, %s inputs, %s edges\n' "$target" "$result" "${inputs:-no}" "${edges:-no}"
done
exit $failed
