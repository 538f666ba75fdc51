#!/bin/sh
# Whether two builds of the program (by two compilers, at two levels of optimization) write the same
# bytes: the text of each example, its field at some points, and its save file.
#   scripts/same_text.sh PROGRAM PROGRAM [all]
# The targets take turns: an example is compiled for every fourth of them, the next for those after; `all`: for each.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
first=$(realpath -- "${1:?a program}") second=$(realpath -- "${2:?another program}") || exit 3
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 3
cd "$root/examples" || exit 3
targets=$("$first" help compile | sed -n 's/.*--target TARGET *//p' | tr -d ',' | sed 's/(unless said)//; s/ or / /')
every=4
[ "${3:-}" = all ] && every=1
[ -n "$targets" ] || { echo "no targets in the help of $first" >&2; exit 3; }
same() { # WHAT ARGUMENTS…: a line for what differs
    what=$1
    shift
    "$first" "$@" >"$here/a" 2>"$here/a.err"; a=$?
    "$second" "$@" >"$here/b" 2>"$here/b.err"; b=$?
    count=$((count + 1))
    [ $a = $b ] && cmp -s "$here/a" "$here/b" && cmp -s "$here/a.err" "$here/b.err" && return
    echo "$what differs"
}
scene_outputs() { # SCENE NUMBER
    here=$work/$1 count=0 turn=$2
    mkdir "$here"
    for target in $targets; do
        [ $((turn % every)) = 0 ] && same "$1 --target $target" compile "$1" --target "$target"
        turn=$((turn + 1))
    done >"$here/differ"
    same "$1, its field" eval "$1" --at 0.3,0.4,0.5 --at 1,2,3 --at -1.1,0.2,0.7 >>"$here/differ"
    same "$1, its save file" export "$1" >>"$here/differ"
    echo $count >"$here/count"
}
workers=$(nproc)
for worker in $(seq 0 $((workers - 1))); do
    (
        number=0
        for scene in *.sdf; do
            [ $((number % workers)) = "$worker" ] && scene_outputs "$scene" $((number / workers))
            number=$((number + 1))
        done
    ) &
done
wait
cat "$work"/*/differ
count=$(cat "$work"/*/count | awk "{ n += \$1 } END { print n + 0 }") differ=$(cat "$work"/*/differ | wc -l)
echo "$count outputs, $differ differ"
[ "$count" -gt 0 ] && [ "$differ" = 0 ]
