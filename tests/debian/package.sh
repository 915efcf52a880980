#!/usr/bin/env bash
# Makes Debian's packages of this commit in one fresh root, installs them in another and goes from
# photographs to a published walk there.
# usage: tests/debian/package.sh SUITE [PACKAGES]     SUITE: bookworm, trixie, sid
# The packages and what lintian says are left in the folder PACKAGES (build-debian-packages).
# Exit status 77: this machine cannot make such a root.
set -eu
suite=${1:-}
[ "$suite" ] || { sed -n '2,6s/^# *//p' "$0"; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
packages=$(realpath -m "${2:-$source/build-debian-packages}")
. "$here/root.sh"
mkdir -p "$packages"

# The roots are fresh ones, whatever is kept for other scripts.
unset ORIEL_DEBIAN_ROOTS
root_make "$suite"
root_run apt-get update -q >"$packages/build.log" 2>&1 ||
    root_skip "the package archive is not reached from a root"
git clone -q --depth 1 "file://$source" "$root/build/oriel"
root_run sh -c 'export DEBIAN_FRONTEND=noninteractive
    apt-get install -q -y --no-install-recommends build-essential lintian &&
    cd /build/oriel && apt-get build-dep -q -y --no-install-recommends ./' >>"$packages/build.log" 2>&1
# Without a network, as Debian builds.
unshare --net bash -c '. "$0"; root=$1; root_run sh -c "cd /build/oriel && dpkg-buildpackage -us -uc -b"' \
    "$here/root.sh" "$root" >>"$packages/build.log" 2>&1 || {
    tail -n 30 "$packages/build.log"
    exit 1
}
root_run sh -c 'cd /build && lintian --allow-root --fail-on error oriel_*.changes' |
    tee "$packages/lintian.txt"
[ "${PIPESTATUS[0]}" -eq 0 ] || { echo "lintian finds errors"; exit 1; }
cp "$root"/build/*.deb "$packages/"
# The packages and cmake --install put the same files: dh_missing has refused to leave one out, these
# are all that a package adds, and pages of the manual are compressed.
for deb in "$packages"/*oriel*.deb; do
    case $deb in *-dbgsym_*) continue ;; esac
    dpkg-deb -c "$deb" | awk '$1 !~ /^d/ { print substr($6, 2) }'
done | grep -v '/copyright$\|/changelog.gz$' | sed '/\/man\//s/\.gz$//' | sort >"$packages/packaged"
root_run sh -c 'cd /build/oriel && DESTDIR=/build/installed cmake --install obj-* >/dev/null &&
    cd /build/installed && find * ! -type d' | sed 's|^|/|' | sort >"$packages/installed"
diff "$packages/packaged" "$packages/installed" || { echo "these files differ"; exit 1; }
root_remove

root_make "$suite"
root_run apt-get update -q >"$packages/install.log" 2>&1
mkdir "$root/packages"
cp "$packages"/oriel_*.deb "$root/packages/"
root_run sh -c 'DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends \
    /packages/*.deb' >>"$packages/install.log" 2>&1 || { tail -n 20 "$packages/install.log"; exit 1; }
root_run sh -euc 'cd /root && export QT_QPA_PLATFORM=offscreen
    oriel synth monument --out photos --size 192x128 --count 8
    oriel prepare photos --out scene --quality draft --test-list 0005.jpg
    oriel eval scene --quiet --json eval.json
    oriel publish scene --out walk.html --single-file
    grep -q psnr_db eval.json && test -s walk.html' >>"$packages/install.log" 2>&1 ||
    { tail -n 20 "$packages/install.log"; exit 1; }
version=$(root_run oriel version)
expected=$(dpkg-deb -f "$packages"/oriel_*.deb Version)
[ "${version#oriel }" = "$expected" ] || { echo "the package $expected has $version"; exit 1; }
echo "the packages of $suite work: $(cd "$packages" && ls *.deb | tr '\n' ' ')"
