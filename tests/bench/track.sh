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
mv photos ws/images
mv photos-truth/sparse ws/sparse

# The cloud: every second pixel of each true depth map, in both directions.
width=512
focal=$(awk '!/^#/ { print $5, $6, $7, $8; exit }' ws/sparse/cameras.txt)
cloud() {
    local id qw qx qy qz tx ty tz camera name points
    while read -r id qw qx qy qz tx ty tz camera name; do
        read -r points || true
        map=photos-truth/stereo/depth_maps/$name.geometric.bin
        head=$(head -c 64 "$map" | LC_ALL=C sed -n '1s/^\(\([0-9]*&\)\{3\}\).*/\1/p' | tr -d '\n')
        od -An -v -w4 -t f4 -j ${#head} "$map" |
            awk -v width=$width -v focal="$focal" -v q="$qw $qx $qy $qz" -v t="$tx $ty $tz" '
            BEGIN {
                split(focal, f); split(q, u); split(t, s)
                w = u[1]; x = u[2]; y = u[3]; z = u[4]
                r11 = 1 - 2 * (y * y + z * z); r12 = 2 * (x * y - w * z); r13 = 2 * (x * z + w * y)
                r21 = 2 * (x * y + w * z); r22 = 1 - 2 * (x * x + z * z); r23 = 2 * (y * z - w * x)
                r31 = 2 * (x * z - w * y); r32 = 2 * (y * z + w * x); r33 = 1 - 2 * (x * x + y * y)
            }
            $1 > 0 && (NR - 1) % 2 == 0 && int((NR - 1) / width) % 2 == 0 {
                a = ((NR - 1) % width + 0.5 - f[3]) / f[1] * $1 - s[1]
                b = (int((NR - 1) / width) + 0.5 - f[4]) / f[2] * $1 - s[2]
                c = $1 - s[3]
                printf "%.5f %.5f %.5f 128 128 128\n", r11 * a + r21 * b + r31 * c,
                       r12 * a + r22 * b + r32 * c, r13 * a + r23 * b + r33 * c
            }'
    done < <(grep -v '^#' ws/sparse/images.txt)
}
cloud >vertices
{
    printf 'ply\nformat ascii 1.0\nelement vertex %d\n' "$(wc -l <vertices)"
    printf 'property float %s\n' x y z
    printf 'property uchar %s\n' red green blue
    echo end_header
    cat vertices
} >ws/fused.ply

arguments=()
for method in "$@"; do arguments+=(--method "$method"); done
"$oriel" bench ws --quiet --quick --seconds 3 --size 512x512 --size 1024x1024 "${arguments[@]}" \
    >table.txt
device=$(sed -n 's/^device  *//p' table.txt | head -n 1)
awk -v commit="$commit" -v device="$device" '
    $1 == "method" { on = 1; next }
    on && NF { printf "%s | %s | %s | %s | %s ms |", commit, device, $2, $1, $3
               for (i = 8; i <= NF; i++) printf " %s", $i
               print "" }' table.txt | tee -a "$file"
