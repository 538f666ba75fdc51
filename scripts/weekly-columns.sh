#!/bin/sh
# Empties or changes one entry of each column of ir/ops.def in turn, in a copy of the tree in
# build-ops/, and demands that a test fails or the build does. A column whose entries nobody misses
# has no reader: it has to go. Arguments name the columns to try; without any, all are tried. The
# builds are not optimised: twelve are made. JOBS in the environment says how many compilers run at
# once.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
cd "$root" && rm -rf build-ops && mkdir -p build-ops/tree || exit 3
git ls-files -coz --exclude-standard | tar --null -T - -cf - | tar -xf - -C build-ops/tree || exit 3
cmake -G Ninja -S build-ops/tree -B build-ops -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 >/dev/null || exit 3
table=build-ops/tree/ir/ops.def
tests='ir docs glsl proof cpu conformance stdlib golden'
missed=0
# seen_by: the first test, of those that take the least time first, that fails or does not compile.
# Nothing where all pass.
seen_by() {
    local test
    for test in $tests; do
        ninja ${JOBS:+-j$JOBS} -C build-ops "test_$test" >build-ops/log 2>&1 || {
            echo "the build: $(grep -m1 'error:' build-ops/log)"
            return
        }
        build-ops/test_$test >build-ops/log 2>&1 || { echo "$test"; return; }
    done
}
# Where a test fails before anything is changed, the failures below say nothing.
before=$(seen_by)
[ -z "$before" ] || { tail -20 build-ops/log; echo "the tree as it is fails: $before"; exit 1; }
try() { # COLUMN PATTERN REPLACEMENT: of one row of the table
    case " $wanted " in "  " | *" $1 "*) ;; *) return ;; esac
    cp ir/ops.def "$table" && sed -i "s/$2/$3/" "$table"
    if cmp -s ir/ops.def "$table"; then
        result="NO SUCH ROW" missed=1
    else
        result=$(seen_by)
        [ -n "$result" ] && result="noticed by $result" || { result="NOT NOTICED"; missed=1; }
    fi
    printf '%-10s %s\n' "$1" "$result"
}
wanted=$*
try arity 'Smoothstep, 3,' 'Smoothstep, 2,'
try Rule 'Length, 1, ToFloat,' 'Length, 1, Same,'
try Takes 'Mod, 2, Numbers,' 'Mod, 2, Floats,'
try function 'Tanh, tanh,' 'Tanh, sinh,'
try glsl '"fathom_tanh({0})"' '"sinh({0})"'
try text '"cross({0}, {1})"' '""'
try weight '3, division, None, "a square root at 0"' '0, division, None, "a square root at 0"'
try cost '40, octave_cost, None, "`noise`"' '40, 0, None, "`noise`"'
try Parity 'curve, Odd, ""' 'curve, None, ""'
try trouble '"a square root at 0"' '""'
try undefined 'x < 0' 'false'
try doc '"hyperbolic tangent"' '""'
exit $missed
