#!/usr/bin/env bash
# What does choosing pairs cost and save? Calibrates PHOTOS with each way of matching, and prints
# what each has placed, from how many pairs, in how much time.
# usage: matching.sh ORIEL WORK_DIR PHOTOS WAY... [-- PREPARE OPTIONS]
#   WAY: exhaustive, sequential or retrieval; needs sqlite3
set -eu
oriel=$1 work=$2 photos=$3
shift 3
ways=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    ways+=("$1")
    shift
done
[ $# -gt 0 ] && shift
mkdir -p "$work"

# COLMAP that ends prepare after calibrate, and notes the seconds of CPU time of each command.
colmap=${ORIEL_COLMAP:-colmap}
cat >"$work/colmap" <<SCRIPT
#!/usr/bin/env bash
[ "\$1" = image_undistorter ] && exit 1
TIMEFORMAT="\$1 %U"
exec 3>&2
{ time "$colmap" "\$@" 2>&3; } 2>>"\$ORIEL_TIMES"
SCRIPT
chmod +x "$work/colmap"

echo "matching | placed | median error, px | points | pairs matched | verified | choosing, s |" \
     "choosing and matching, s of CPU | calibrate, s of CPU"
for way in "${ways[@]}"; do
    scene=$work/$way
    export ORIEL_TIMES=$work/$way.times
    rm -rf "$scene" "$scene-text" "$ORIEL_TIMES"
    ORIEL_COLMAP=$work/colmap "$oriel" prepare "$photos" --out "$scene" --matching "$way" "$@" \
        >"$work/$way.log" 2>&1 || true
    model=$scene/.oriel/calibrate/model
    [ -d "$model" ] || { tail "$work/$way.log"; exit 1; }
    mkdir "$scene-text"
    "$colmap" model_converter --input_path "$model" --output_path "$scene-text" \
        --output_type TXT >/dev/null
    error=$(grep -v '^#' "$scene-text/points3D.txt" | awk '{ print $8 }' | sort -g |
        awk '{ all[NR] = $1 } END { printf "%.3f", all[int((NR + 1) / 2)] }')
    points=$(grep -vc '^#' "$scene-text/points3D.txt")
    placed=$(grep -v '^#' "$scene-text/images.txt" | awk 'NR % 2' | grep -c .)
    pairs=$(sqlite3 "$scene/.oriel/calibrate/database.db" "SELECT COUNT(*) FROM matches")
    verified=$(sqlite3 "$scene/.oriel/calibrate/database.db" \
        "SELECT COUNT(*) FROM two_view_geometries WHERE rows >= 15")
    record() {
        grep -A 40 '"calibrate": {' "$scene/.oriel/stages.json" |
            awk -v key="\"$1\":" '$1 == key { sub(",", "", $2); print $2; exit }'
    }
    choosing=$(record choosing_s)
    all=$(record cpu_s)
    others=$(awk '$1 !~ /match/ { sum += $2 } END { print sum }' "$ORIEL_TIMES")
    awk -v all="$all" -v others="$others" -v choosing="$choosing" \
        -v row="$way | $placed | $error | $points | $pairs | $verified" 'BEGIN {
        printf "%s | %s | %.0f | %.0f\n", row, choosing == "" ? "-" : sprintf("%.1f", choosing),
            all - others, all }'
done
