#!/usr/bin/env bash
# The README's picture, docs/monument.jpg: a photograph that was kept aside, and the same view drawn
# from the others.
# usage: tests/bench/readme_picture.sh ORIEL SCENE PHOTO     SCENE: demo/scene, as ./demo.sh makes it
set -eu
[ $# -eq 3 ] || { sed -n '2,4s/^# *//p' "$0"; exit 2; }
oriel=$(realpath "$1") scene=$2 photo=$3
source=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$oriel" render "$scene" --at "$photo" --method oriel --out "$work/view.png" --quiet
ffmpeg -v error -y -i "$scene/images/$photo" -i "$work/view.png" -filter_complex hstack -q:v 2 \
    "$source/docs/monument.jpg"
