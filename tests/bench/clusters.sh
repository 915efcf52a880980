#!/usr/bin/env bash
# What do clusters of fusion cost and save? Prepares PHOTOS once and fuses the same depth maps in
# clusters of each SIZE; prints points, processor time, memory, accuracy, and seams
# (tests/bench/cluster_seams.py).
# usage: clusters.sh ORIEL WORK_DIR PHOTOS SIZE... [-- PREPARE OPTIONS]
#   the options hold photographs out; SIZE 400 and more fuses all photographs together
set -eu
[ $# -ge 4 ] || { sed -n '2,6s/^# *//p' "$0"; exit 2; }
oriel=$(realpath "$1") work=$2 photos=$(realpath "$3") here=$(cd "$(dirname "$0")" && pwd)
shift 3
sizes=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    sizes+=("$1")
    shift
done
[ $# -gt 0 ] && shift
mkdir -p "$work"
work=$(realpath "$work")
prepare() {
    local scene=$1
    shift
    "$oriel" prepare "$photos" --out "$work/$scene" --densifier gl --keep all --quiet "$@"
}
figure() { # figure SCENE STAGE NAME
    sed -n "/^  \"$2\": {/,/^  }/s/^ *\"$3\": \([0-9.]*\).*/\1/p" "$work/$1/.oriel/stages.json" |
        head -n 1
}
[ -e "$work/one/scene.json" ] || prepare one --fuse-cluster 100000 "$@"
for size in "${sizes[@]}"; do
    rm -rf "$work/$size"
    cp -a "$work/one" "$work/$size"
    rm "$work/$size/.oriel/fused.ply"
    prepare "$size" --resume --fuse-cluster "$size" "$@" 2>/dev/null # fused.ply is missing
    count=$(figure "$size" fuse clusters)
    echo "--fuse-cluster $size: $count clusters, $(figure "$size" radii points) points," \
        "fused in $(figure "$size" fuse cpu_s) s of CPU, at most" \
        "$(figure "$size" fuse peak_rss_mib) MiB"
    "$oriel" eval "$work/$size" --quiet | tail -n 1
    [ "$count" -gt 1 ] || continue
    rm "$work/$size/scene.json" # so that the clusters are made once more, and stay
    for part in $(seq "$count"); do
        "$oriel" job fuse "$work/$size" --photographs "$size" --part "$part/$count" --quiet
    done
    python3 "$here/cluster_seams.py" "$work/one/.oriel/fused.ply" "$work/one/points.ply" \
        "$work/$size"/stereo/fused/*/*.ply
done
