#!/bin/sh
# Finds calls that have nodes made in two of their arguments: compilers evaluate arguments in orders
# of their own, and so would number the nodes, and write the text of shaders, each in its own way.
# Such calls take their arguments in braces (Graph::Pair), which are evaluated in order. Needs
# clang-query; prints the places, and exits with 1 where there are any.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
cd "$root" || exit 3
command -v clang-query >/dev/null || { echo "clang-query is needed (Debian: clang-tools)" >&2; exit 3; }
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 3
cat >"$work/query" <<'QUERY'
set output diag
set bind-root false
let graph cxxMethodDecl(ofClass(hasAnyName("Graph", "Shapes", "Pen")), unless(hasAnyName("arg", "args", "type", "reads")))
let id qualType(hasCanonicalType(hasDeclaration(namedDecl(hasAnyName("Id", "Value")))))
let makes cxxMemberCallExpr(callee(graph), hasType(id))
let made callExpr(hasType(id), unless(cxxOperatorCallExpr()), unless(cxxMemberCallExpr(callee(cxxMethodDecl(isConst())))), unless(callee(functionDecl(hasAnyName("node_of", "shape_of", "number", "integer", "boolean", "vec", "color", "poison", "none", "unit", "make_value", "shape_value", "at", "arg", "front", "back", "operator[]")))))
let any expr(anyOf(makes, made, hasDescendant(makes), hasDescendant(made)))
QUERY
for pair in "0 1" "0 2" "1 2" "0 3" "1 3" "2 3"; do
    set -- $pair
    echo "match callExpr(unless(cxxOperatorCallExpr()), unless(isExpansionInSystemHeader()), hasArgument($1, any), hasArgument($2, any)).bind(\"twice\")" >>"$work/query"
done
failed=0
for folder in ir ir/passes ir/lower proof typecheck typecheck/builtins save-format/import; do
    for file in "$folder"/*.cpp; do
        clang-query -f "$work/query" "$file" -- -std=c++20 -I. >"$work/out" 2>&1
        if grep -q ' error: ' "$work/out"; then grep ' error: ' "$work/out" >&2; failed=1; fi
        grep '"twice" binds here' "$work/out" | cut -d: -f1-3 | grep -v '^/usr/' >>"$work/all"
    done
done
sort -u "$work/all" | sed 's|^\./||; s|$|: nodes are made in two arguments: write them in braces|'
[ ! -s "$work/all" ] && exit $failed
exit 1
