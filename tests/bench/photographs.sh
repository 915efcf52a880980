#!/usr/bin/env bash
# Does a frame cost more with 200 photographs of a place than with 20? Makes a synthetic
# scene of N photographs with true points and measures (tests/bench/photographs.c).
# usage: photographs.sh ORIEL PHOTOGRAPHS WORK_DIR [N] [METHOD]..
#   PHOTOGRAPHS: the program bench_photographs of a build
set -eu
[ $# -ge 3 ] || { sed -n '2,5s/^# *//p' "$0"; exit 2; }
oriel=$(realpath "$1") measure=$(realpath "$2")
mkdir -p "$3"
work=$(realpath "$3") count=${4:-200}
shift $(($# < 4 ? 3 : 4))
here=$(cd "$(dirname "$0")" && pwd)
scene=$work/$count
if [ ! -e "$scene/fused.ply" ]; then
    [ -e "$work/photos-$count" ] ||
        "$oriel" synth monument --out "$work/photos-$count" --size 256x192 --count "$count" --quiet
    mkdir -p "$scene"
    cp -rlT "$work/photos-$count" "$scene/images"
    cp -rlT "$work/photos-$count-truth/sparse" "$scene/sparse"
    "$here/truth_cloud" "$work/photos-$count-truth" $((4 + count / 50)) >"$scene/fused.tmp"
    mv "$scene/fused.tmp" "$scene/fused.ply"
fi
"$measure" "$scene" 512x512 "$@"
