#!/usr/bin/env bash
# Would a scene be better if fusion left out the depths that the stereo is not sure of? Prepares
# PHOTOS once, then fuses again with depths below each CONFIDENCE taken out, and measures the
# held-out photographs.
# usage: confidence.sh ORIEL CUT_DEPTHS PHOTOS TEST_LIST WORK_DIR CONFIDENCE... [-- PREPARE OPTIONS]
#   CUT_DEPTHS: the program bench_cut_depths of a build
set -eu
oriel=$1 cut=$2 photos=$3 tests=$4 work=$5
shift 5
levels=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    levels+=("$1")
    shift
done
[ $# -gt 0 ] && shift
mkdir -p "$work"
whole=$work/whole
[ -e "$whole/scene.json" ] ||
    "$oriel" prepare "$photos" --out "$whole" --test-list "$tests" --keep all "$@" >/dev/null
echo "confidence | full frame, dB | covered, dB | SSIM | points"
for level in 0 "${levels[@]}"; do
    scene=$work/cut
    rm -rf "$scene"
    cp -a "$whole" "$scene"
    "$cut" "$scene" "$level" >"$work/cut-$level.txt"
    rm "$scene/.oriel/fused.ply"
    "$oriel" prepare "$photos" --out "$scene" --test-list "$tests" --keep all --resume --quiet "$@" >/dev/null
    "$oriel" eval "$scene" --json "$work/eval-$level.json" --quiet >/dev/null
    points=$(grep -a -m 1 "element vertex" "$scene/points.ply" | tr -dc 0-9)
    awk -v level="$level" -v points="$points" '
        /"mean"/ { inside = 1 }
        inside && /"(psnr_db|psnr_covered_db|ssim)"/ { gsub(/[",:]/, " "); value[$1] = $2 }
        inside && /}/ { inside = 0 }
        END { printf "%s | %.2f | %.2f | %.4f | %d\n", level, value["psnr_db"],
                  value["psnr_covered_db"], value["ssim"], points }' "$work/eval-$level.json"
done
