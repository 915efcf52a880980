#!/usr/bin/env bash
# The seven rows of Table 5.1 of Orzan 2005 (frames a second of her methods), as ratios to the
# slowest: hers, and those of this machine by processor time. Without SCENE on her own set-up: a
# figure seen by six cameras, its visual hull of 5000 triangles, pictures of 512x512. Needs jq.
# usage: orzan_table.sh ORIEL WORK_DIR [SCENE]
set -eu
oriel=$1 work=$2
mkdir -p "$work"
scene=${3:-$work/figure}
if [ $# -lt 3 ] && [ ! -e "$scene" ]; then
    "$oriel" synth figures --out "$work/set" --cameras 6 --size 320x240 --quiet >&2
    "$oriel" import "$work/set" --masks "$work/set/masks" --mesh hull=64,5000 --out "$scene" --quiet >&2
fi
rows=(
    "42|view-dependent|orzan-view"
    "27|view-independent|orzan-surface"
    "11|view-independent, median filter|orzan-surface median=all"
    "24|shadow mapping|orzan-shadow select=all combine=mean median=off"
    "11|shadow mapping, median filter|orzan-shadow select=all combine=mean median=all"
    "17|shadow mapping, dominant colour, all cameras|orzan-shadow select=all"
    "23|shadow mapping, dominant colour, best five|orzan-shadow"
)
cpu=()
slowest=0
for row in "${rows[@]}"; do
    read -r method settings <<<"${row##*|}"
    set=(--method "$method")
    for setting in $settings; do set+=(--set "$setting"); done
    ms=$("$oriel" bench "$scene" --size 512x512 --seconds 2 --frames 12 --quiet --json - \
        "${set[@]}" | jq '.sizes[0].cpu_ms')
    cpu+=("$ms")
    slowest=$(jq -n "[$slowest, $ms] | max")
done
echo "| row | settings | speed in the paper | speed here |"
echo "|---|---|---|---|"
for i in "${!rows[@]}"; do
    IFS='|' read -r fps name settings <<<"${rows[$i]}"
    awk -v n="$name" -v s="$settings" -v f="$fps" -v c="${cpu[$i]}" -v slow="$slowest" \
        'BEGIN {printf "| %s | `%s` | %.2f | %.2f |\n", n, s, f / 11, slow / c}'
done
awk -v six="${cpu[5]}" -v five="${cpu[6]}" 'BEGIN {
    printf "\nFive cameras against all: %.2f times as fast; 1.35 in the paper.\n", six / five}'
