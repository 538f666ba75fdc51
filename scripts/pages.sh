#!/bin/sh
# The pages of all examples and of 20 library entries in Chromium, beside `fathom render`: writes docs/web-table.md.
# Takes about a quarter of an hour on two cores. First the hosts of examples/hosts and the module's types, by packages from npm.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages chromium nodejs || exit 3
program=$root/build/fathom
work=$root/build/pages
mkdir -p "$work" && cd "$root/tests/browser" || exit 3
npm ci --no-audit --no-fund --ignore-scripts || exit 3
node_modules/.bin/tsc --noEmit --strict --target es2022 --module nodenext --lib es2022,dom types.ts || exit 1
node hosts.mjs "$program" || exit 1
entries="torus capsule cone ellipsoid superquadric icosahedron gyroid menger mandelbulb metaballs
smooth_union stairs_union columns_difference pipe engrave extrude revolve twist repeat_polar displace"
node pages.mjs "$program" "$work" "$root"/examples/*.sdf $entries >"$work/table" 2>"$work/browser"
failed=$?
{
    printf '%s\n' "# Pages beside \`fathom render\`" "" \
        "Written by \`scripts/pages.sh\` ([web.md](web.md)): $(tail -n 1 "$work/browser") with SwiftShader, 320x180," \
        "one sample a pixel, on two cores that other work may have used at the same time. A pixel differs" \
        "where some channel does by more than 8 of 255. The names behind the examples are library entries," \
        "whose examples \`fathom doc NAME\` prints." ""
    cat "$work/table"
} >"$root/docs/web-table.md"
exit $failed
