#!/usr/bin/env bash
# Times one fixed synthetic scene and appends a line to a file, so that commits can be
# compared: commit, device, size, method, frame ms, ms by pass.
#     tests/bench/track.sh ORIEL FILE [METHOD]...
# Compare lines of one device, made with nothing else running.
set -eu
[ $# -ge 2 ] || { sed -n '2,5s/^# *//p' "$0"; exit 2; }
oriel=$(realpath "$1")
file=$(realpath -m "$2")
shift 2
source=$(cd "$(dirname "$0")/../.." && pwd)
commit=$(git -C "$source" rev-parse --short HEAD 2>/dev/null || echo unknown)
git -C "$source" diff --quiet HEAD -- src shaders 2>/dev/null || commit=$commit+
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$oriel" synth monument --out photos --size 512x384 --count 12 --quiet
mkdir ws
"$source/tests/bench/truth_cloud" photos-truth 2 >ws/fused.ply
mv photos ws/images
mv photos-truth/sparse ws/sparse

arguments=()
for method in "$@"; do arguments+=(--method "$method"); done
"$oriel" bench ws --quiet --seconds 3 --size 512x512 --size 1024x1024 "${arguments[@]}" \
    >table.txt
device=$(sed -n 's/^device  *//p' table.txt | head -n 1)
awk -v commit="$commit" -v device="$device" '
    $1 == "method" { on = 1; next }
    on && NF { printf "%s | %s | %s | %s | %s ms |", commit, device, $2, $1, $3
               for (i = 8; i <= NF; i++) printf " %s", $i
               print "" }' table.txt | tee -a "$file"
