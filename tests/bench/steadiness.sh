#!/usr/bin/env bash
# How steadily methods show the walking figure from a view at rest, the place of a camera that is held
# out, with and without the median filter (Orzan 2005, table 5.1), against the truth.
# Needs jq.
# usage: steadiness.sh BUILD WORK
set -eu
build=$(realpath "$1") work=$2
oriel=$build/oriel
mkdir -p "$work"
cd "$work"
if [ ! -e scene ]; then
    "$oriel" synth figures --out set --cameras 8 --frames 12 --size 240x180 --quiet >&2
    "$oriel" import set --masks set/masks --background set/background --out scene --test-list cam03 --quiet >&2
    printf '{"keyframes": [%s{"photo": "cam03"}]}\n' "$(printf '{"photo": "cam03"}, %.0s' {1..11})" >still.json
fi
echo "| method | change that the truth has not, of 255 | PSNR of the subject, dB |"
echo "|---|---|---|"
for row in "orzan-view median=off" "orzan-view median=all" "orzan-surface median=off" "orzan-surface median=all" \
    "orzan-shadow median=off" "orzan-shadow median=holes" "orzan-shadow median=all" li goldluecke oriel; do
    read -r method setting <<<"$row"
    set=(--set fill=room)
    [ -z "$setting" ] || set+=(--set proxy=hull --set "$setting")
    rm -rf shown
    "$oriel" render scene --path still.json --method "$method" "${set[@]}" --out shown --quiet
    "$build/tests/bench_steadiness" shown set/images/cam03 set/masks/cam03 | jq -r --arg row "$row" \
        '"| `\($row)` | \(.unsteady) | \(.psnr_db) |", (if $row == "oriel" then "\nThe truth itself changes by \(.moved)." else empty end)'
done
