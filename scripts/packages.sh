#!/bin/sh
# Builds the Debian packages of the committed tree twice, in folders of different names, without ccache: both give equal
# bytes, and lintian finds nothing. The packages are left in build-packages/one. Takes about a quarter of an hour on two cores.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages "$build_packages" debhelper dh-python build-essential fakeroot lintian || exit 3
work=$root/build-packages
commit=$(git -C "$root" rev-parse HEAD) || exit 3
rm -rf "$work"
build() { # FOLDER NAME: the tree is build-packages/FOLDER/NAME, its packages lie beside it
    mkdir -p "$work/$1/$2" && git -C "$root" archive "$commit" | tar -x -C "$work/$1/$2" || exit 3
    (cd "$work/$1/$2" && env -u CCACHE_DIR CCACHE_DISABLE=1 dpkg-buildpackage -b -uc -us) >"$work/$1/log" 2>&1 || {
        tail -n 50 "$work/$1/log" >&2
        exit 1
    }
}
build one fathom
build two another-name
failed=0
for package in "$work"/one/*.deb; do
    name=$(basename "$package")
    if ! cmp -s "$package" "$work/two/$name"; then
        failed=1
        echo "$name differs in:"
        for side in one two; do
            mkdir -p "$work/$side/unpacked/$name" && dpkg-deb -R "$work/$side/$name" "$work/$side/unpacked/$name" || exit 3
        done
        diff -rq "$work/one/unpacked/$name" "$work/two/unpacked/$name"
    fi
done
lintian --fail-on error,warning "$work"/one/*.changes || failed=1
[ $failed = 0 ] && (cd "$work/one" && sha256sum ./*.deb)
exit $failed
