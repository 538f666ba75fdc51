#!/bin/sh
# The short tests of pages in Chromium: short.sh FATHOM MODULE.js. What they need is installed by scripts/setup.sh on
# Debian, so that its absence there is a failure; on other systems they are skipped (77), and that is said.
for program in node "${FATHOM_CHROMIUM:-chromium}"; do
    command -v "$program" >/dev/null && continue
    echo "there is no $program, which the tests of pages need"
    command -v dpkg-query >/dev/null && exit 1
    exit 77
done
exec node "$(dirname -- "$0")/short.mjs" "$@"
