#!/usr/bin/env bash
# What a cloud of many points costs to divide, to open and to draw: the
# scene's own cloud, each of whose points becomes TIMES smaller ones.
# usage: tests/bench/large_cloud.sh BUILD SCENE WORK_DIR TIMES [TIMES]..
# Needs 78 bytes of disk a point in WORK_DIR, most of which is free again at the end.
set -eu
[ $# -ge 4 ] || { sed -n '2,5s/^# *//p' "$0"; exit 2; }
oriel=$1/oriel cloud=$1/tests/bench_large_cloud scene=$2 work=$3
shift 3
mkdir -p "$work"
name=$(basename "$(find "$scene/images" -type f | sort | sed -n 3p)")

# measure COMMAND...: its processor time in seconds and its peak of memory in MiB.
measure() {
    /usr/bin/time -f "%U %S %M" -o "$work/time" "$@" >"$work/log" 2>&1 ||
        { cat "$work/log" >&2; return 1; }
    awk '{ printf "%.1f s, %d MiB", $1 + $2, $3 / 1024 }' "$work/time"
}

"$oriel" render "$scene" --at "$name" --out "$work/whole.png" --quiet
echo "| points | file | \`oriel lod\` | \`oriel info\` | one frame | PSNR to the scene's own cloud |"
echo "|---|---|---|---|---|---|"
for times in "$@"; do
    copy=$work/scene
    rm -rf "$copy"
    cp -a "$scene" "$copy"
    "$cloud" "$scene" "$times" "$work/cloud.ply"
    divide=$(measure "$oriel" lod "$copy" --points "$work/cloud.ply" --max-ram 1024)
    rm "$work/cloud.ply" "$copy/points.ply"
    open=$(measure "$oriel" info "$copy" --json)
    points=$(grep -o '"points": [0-9]*' "$work/log" | head -n 1)
    draw=$(measure "$oriel" render "$copy" --at "$name" --out "$work/$times.png")
    echo "| ${points#*: } | $(($(stat -c %s "$copy/points.lod") >> 20)) MiB | $divide | $open |" \
         "$draw | $(compare -metric PSNR "$work/whole.png" "$work/$times.png" null: 2>&1) dB |"
    rm -rf "$copy"
done
