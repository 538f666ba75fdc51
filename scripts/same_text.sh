#!/bin/sh
# Whether two builds of the program (by two compilers, at two levels of optimization) write the same
# bytes: each example for each target, and its field at some points.
#   scripts/same_text.sh PROGRAM PROGRAM
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
first=$(realpath -- "${1:?a program}") second=$(realpath -- "${2:?another program}") || exit 3
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 3
cd "$root/examples" || exit 3
targets=$("$first" help compile | sed -n 's/.*--target TARGET *//p' | tr -d ',' | sed 's/(unless said)//; s/ or / /')
[ -n "$targets" ] || { echo "no targets in the help of $first" >&2; exit 3; }
count=0 differ=0
same() { # WHAT ARGUMENTS…
    what=$1
    shift
    "$first" "$@" >"$work/a" 2>"$work/a.err"; a=$?
    "$second" "$@" >"$work/b" 2>"$work/b.err"; b=$?
    count=$((count + 1))
    [ $a = $b ] && cmp -s "$work/a" "$work/b" && cmp -s "$work/a.err" "$work/b.err" && return
    differ=$((differ + 1))
    echo "$what differs"
}
for scene in *.sdf; do
    for target in $targets; do same "$scene --target $target" compile "$scene" --target "$target"; done
    same "$scene, its field" eval "$scene" --at 0.3,0.4,0.5 --at 1,2,3 --at -1.1,0.2,0.7
    same "$scene, its save file" export "$scene"
done
echo "$count outputs, $differ differ"
[ $differ = 0 ]
