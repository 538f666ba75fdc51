#!/bin/sh
# Adds two ops by the patches in scripts/ops/ to a copy of the tree in build-ops/, builds it, and
# runs what has to hold for any op. Fails where a patch touches more than eight files, or one that
# docs/adding-an-op.md does not name.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
cd "$root" && rm -rf build-ops && mkdir -p build-ops/tree || exit 3
git ls-files -coz --exclude-standard | tar --null -T - -cf - | tar -xf - -C build-ops/tree || exit 3
for patch in scripts/ops/*.patch; do
    files=$(sed -n 's|^+++ b/||p' "$patch")
    if [ "$(echo "$files" | wc -l)" -gt 8 ]; then
        echo "$patch touches more than eight files" >&2
        exit 1
    fi
    for file in $files; do
        case $file in tests/golden/cases/op_*) name="tests/golden/cases/" ;; *) name=$file ;; esac
        if ! grep -qF "$name" docs/adding-an-op.md; then
            echo "$patch touches $file, which docs/adding-an-op.md does not name" >&2
            exit 1
        fi
    done
    git apply --directory=build-ops/tree "$patch" || exit 1
done
tests='conformance golden docs style ir proof glsl cpu check save stdlib'
cmake -G Ninja -S build-ops/tree -B build-ops -DCMAKE_UNITY_BUILD=ON || exit 3
ninja -C build-ops fathom $(printf 'test_%s ' $tests) || exit 1
exec ctest --test-dir build-ops --output-on-failure \
    -R "^(unit_)?($(echo $tests | tr ' ' '|'))\$"
