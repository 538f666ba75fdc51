#!/bin/sh
# Formats every C++ file by .clang-format; with --check it changes nothing and fails where a file
# differs from its formatted text.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages clang-format || exit 3
cd "$root" || exit 3
case ${1:-} in
--check) options="--dry-run -Werror" ;;
"") options="-i" ;;
*) echo "usage: scripts/format.sh [--check]" >&2; exit 2 ;;
esac
find . \( -path './build*' -o -path './.*' \) -prune -o \( -name '*.cpp' -o -name '*.h' \) -print0 |
    xargs -0 clang-format $options && say "formatting: all files looked at"
