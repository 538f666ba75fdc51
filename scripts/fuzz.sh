#!/bin/sh
# Builds a libFuzzer target with clang++ in build-fuzz/ and runs it for a minute: scripts/fuzz.sh TARGET [SECONDS]
# Targets: parse_fuzz (text to tree), compile_fuzz (text to shader), agree_fuzz (what a text means, by every evaluator),
# yaml_fuzz (save files), save_fuzz (save files to text and back), image_fuzz (images and grids), lsp_fuzz (messages to the
# language server). `build TARGETS…` only builds them. What it finds is left in build-fuzz/ as crash-…; what it learns is kept in
# build-fuzz/TARGET_corpus. QUICK=1 in the environment, for the tests: without optimization, in build-fuzz-quick/, in a third
# of the time; a tenth of the inputs a second.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
target=${1:?which target: parse_fuzz, compile_fuzz, agree_fuzz, yaml_fuzz, save_fuzz, image_fuzz, lsp_fuzz or build}
seconds=${2:-60}
build=$root/build-fuzz flags="-O2 -g1"
[ -n "${QUICK:-}" ] && build=$root/build-fuzz-quick flags=-O0
fuzz=$root/tests/fuzz
# LENGTH=4096 in the environment: longer inputs than the target's own, which are short, because time goes with the length.
more="" # seeds that take most of a minute to run through, and so for longer runs alone
case $target in
parse_fuzz) length=256 words=fathom.dict seeds="$fuzz/seeds $fuzz/corpus/parse_fuzz" more="$root/examples $root/stdlib" ;;
compile_fuzz) length=512 words=fathom.dict seeds="$fuzz/seeds $fuzz/corpus/agree_fuzz" more="$root/tests/golden/cases $root/examples" ;;
agree_fuzz) length=512 words=fathom.dict seeds="$fuzz/seeds $fuzz/corpus/agree_fuzz" more="$root/tests/golden/cases" ;;
yaml_fuzz) length=512 words=yaml.dict seeds="$fuzz/yaml_seeds $fuzz/corpus/yaml_fuzz" ;;
save_fuzz) length=1024 words=yaml.dict seeds="$fuzz/yaml_seeds $fuzz/corpus/save_fuzz" ;;
image_fuzz) length=4096 words=image.dict seeds="$fuzz/image_seeds $fuzz/corpus/image_fuzz" ;;
lsp_fuzz) length=512 words=fathom.dict seeds=$fuzz/lsp_seeds more=$fuzz/seeds ;;
build) ;;
*) echo "there is no target $target" >&2; exit 2 ;;
esac
. "$root/scripts/setup.sh"
use_ccache
cd "$root" || exit 3
[ -e "$build/build.ninja" ] || cmake --preset fuzz -B "$build" -DCMAKE_CXX_FLAGS_DEBUG="$flags" || exit 3
if [ "$target" = build ]; then
    shift
    exec flock "$build" ninja -C "$build" "$@"
fi
flock "$build" ninja -C "$build" "$target" || exit 3
[ "$seconds" -ge 60 ] && seeds="$seeds $more"
mkdir -p "$build/${target}_corpus"
# No stacks of allocations, a sixth of the time: a crash that needs them is run again without this.
export ASAN_OPTIONS="malloc_context_size=0:$ASAN_OPTIONS"
# -entropic=0: its weights of the corpus take three quarters of parse_fuzz's time
cd "$build" && exec "./$target" -entropic=0 -max_total_time="$seconds" -max_len="${LENGTH:-$length}" -timeout=60 -rss_limit_mb=2048 -seed=1 \
    -dict="$fuzz/$words" -print_final_stats=1 "${target}_corpus" $seeds
