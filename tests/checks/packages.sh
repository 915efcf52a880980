#!/usr/bin/env bash
# debian/control and .ci/deps.sh, which builds from source use, name the same packages: what Oriel is
# built with, and what its program runs with.
# usage: packages.sh SOURCE_DIR [CONTROL]
set -eu
cd "$1"
control=${2:-debian/control}

# Packages of a field, one a line, without versions and substitutions. field PACKAGE NAME
field() {
    awk -v package="$1" -v name="$2:" '
        /^(Source|Package): / { within = $2 == package; wanted = 0 }
        within && /^[A-Za-z-]+:/ { wanted = $1 == name; sub(/^[^:]*:/, "") }
        within && wanted { gsub(/\([^)]*\)|\$\{[^}]*\}|[ \t]/, ""); gsub(/,/, "\n"); print }' "$control" |
        grep . | sort -u
}

made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
. .ci/deps.sh
# What Debian's own tools bring: the compiler, and the helpers of the package.
oriel_packages | tr ' ' '\n' | grep -vx build-essential | sort -u >"$made/source"
{ field oriel Build-Depends | grep -v '^debhelper'; field oriel Depends; field oriel Recommends; } |
    sort -u >"$made/control"
diff -u "$made/source" "$made/control" || { echo ".ci/deps.sh and $control differ"; exit 1; }
# Programs are linked with the static library and so need its libraries; EGL comes with epoxy.
field oriel Build-Depends | grep '^lib.*-dev$' | grep -vx libegl-dev >"$made/built"
field liboriel-dev Depends >"$made/library"
diff -u "$made/built" "$made/library" || { echo "$control: liboriel-dev lacks some, or has more"; exit 1; }
