#!/usr/bin/env bash
# Does radiance from three series cost accuracy on real photographs? Takes a prepared scene
# with held-out photographs (or photographs, which it prepares), re-exposes its training
# photographs by -2, 0 and +2 EV in turn (tests/bench/reexpose_photos.c), and compares the held-out
# photographs, left as they were, with renderings of the single-exposure scene and of
# radiance brought back to their exposure.
# usage: reexpose.sh ORIEL REEXPOSE SCENE|PHOTOS WORK_DIR [METHOD]
#   REEXPOSE: the program bench_reexpose_photos of a build
set -eu
oriel=$1 reexpose=$2 from=$3 work=$4 method=${5:-oriel}
noise=0.005
mkdir -p "$work"
if [ -e "$from/scene.json" ]; then
    scene=$from
    images=$from/images
else
    scene=$work/single
    [ -e "$scene/scene.json" ] || "$oriel" prepare "$from" --out "$scene" --max-size 768 --test-every 3
    images=$from
fi
# In turn over the training photographs; held-out ones keep their exposure.
exposures=()
i=0
for photo in "$images"/*; do
    name=$(basename "$photo")
    grep -A1 "\"name\": \"$name\"" "$scene/scene.json" | grep -q '"split": "train"' || continue
    set -- -2 0 2
    shift $((i % 3))
    exposures+=("$name=$1")
    i=$((i + 1))
done
rm -rf "$work/series"
if [ "$images" = "$from" ]; then
    [ -e "$work/photos" ] || "$reexpose" "$from" "$work/photos" "$noise" "${exposures[@]}"
    tests=$(grep -B1 '"split": "test"' "$scene/scene.json" | sed -n 's/.*"name": "\(.*\)",/\1/p' |
            paste -sd,)
    "$oriel" prepare "$work/photos" --out "$work/series" --max-size 768 --test-list "$tests"
else
    "$reexpose" "$scene" "$work/series" "$noise" "${exposures[@]}"
fi
echo "single exposure:"
"$oriel" eval "$scene" --method "$method" --json "$work/single.json"
for merge in fused series; do
    echo "three series, $merge:"
    "$oriel" eval "$work/series" --method "$method" --merge "$merge" --json "$work/$merge.json" \
        --images "$work/pictures"
done
