#!/usr/bin/env bash
# The figures and tables of Airieau 2012 that compare something, on a prepared scene with held-out
# photographs: pictures in OUT, tables on stdout.
#   figure 3: a plane as proxy against the points       figure 13: time by number of photographs
#   figure 8: without and with the occlusion test       figure 15: photographs at lower resolution
#   figure 9: points with their own colours             table 1: memory
#   figure 14: a textured mesh (SCENE/mesh.ply),        table 2: time by pass, 512 and 1024
#     its colours the mean of the photographs that see it
# PHOTO, a held-out one, is the viewpoint of the pictures. Needs jq and ImageMagick.
# usage: airieau_figures.sh BUILD SCENE PHOTO OUT
set -eu
build=$1 scene=$2 photo=$3 out=$4
oriel=$build/oriel
mkdir -p "$out"

# copy NAME MESH: the scene with another mesh.
copy() {
    rm -rf "${out:?}/$1"
    mkdir "$out/$1"
    cp -r "$scene/images" "$scene/sparse" "$scene/points.ply" "$scene/scene.json" "$out/$1"
    [ -z "$2" ] || cp "$2" "$out/$1/mesh.ply"
}

# row FIGURE NAME SCENE ARGUMENTS...: a picture, and the accuracy of all held-out photographs.
row() {
    local figure=$1 name=$2 from=$3
    shift 3
    "$oriel" render "$from" --at "$photo" --out "$out/fig$figure-$name.png" --quiet "$@"
    "$oriel" eval "$from" --quiet --json - "$@" | jq -r --arg f "$figure" --arg n "$name" \
        '"| \($f) | \($n) | \(.mean.psnr_db * 100 | round / 100) | \(.mean.psnr_covered_db * 100 | round / 100) | \(.mean.ssim * 1000 | round / 1000) |"'
}

"$build/tests/bench_plane_mesh" "$scene" "$photo" "$out/plane.ply"
copy plane "$out/plane.ply"
echo "| figure | picture | PSNR, dB | covered PSNR, dB | SSIM |"
echo "|---|---|---|---|---|"
row 3 plane "$out/plane" --method airieau --set proxy=mesh
row 3 points "$scene" --method airieau
row 8 no-test "$scene" --method airieau --set visibility=none
row 8 test "$scene" --method airieau
row 9 splats "$scene" --method points
row 9 photographs "$scene" --method airieau
if [ -e "$scene/mesh.ply" ]; then
    texture=(--method orzan-surface --set proxy=mesh --set combine=mean)
    row 14 mesh-without-occlusion-test "$scene" "${texture[@]}"
    row 14 textured-mesh "$scene" "${texture[@]}" --set visibility=shadow
    row 14 photographs-on-mesh "$scene" --method airieau --set proxy=mesh
    row 14 photographs "$scene" --method airieau
fi

"$oriel" bench "$scene" --method airieau --quiet --seconds 0.3 --json "$out/bench.json"
echo
jq -r '"Table 1: \(.points) points, \(.photographs) photographs of \(.photo_size[0])x\(.photo_size[1]).",
    "", "| memory of | MiB |", "|---|---|",
    (.memory | group_by(.owner)[] | "| \(.[0].owner) | \(map(.bytes) | add / 1048576 | . * 10 | round / 10) |")' \
    "$out/bench.json"
echo
jq -r '"Table 2: ratios to the frame of 512x512.", "", "| size | splats | pull, push | photographs | frame |",
    "|---|---|---|---|---|",
    (.sizes[0].frame_ms as $unit | .sizes[] |
     def of(names): [.passes_ms | to_entries[] | select(.key | IN(names[])) | .value] | add // 0;
     def r: . / $unit * 100 | round / 100;
     "| \(.size[0])x\(.size[1]) | \(of(["splat"]) | r) | \(of(["pull-push"]) | r) | \(of(["gather"]) | r) | \(.frame_ms | r) |")' \
    "$out/bench.json"
echo
echo "Figure 13."
echo
echo "| photographs | time, ratio to the fewest |"
echo "|---|---|"
all=$(jq .photographs "$out/bench.json") unit=
copy fewer ""
for ((count = 1, last = 0; last < all; last = count, count *= 2)); do
    [ $count -lt "$all" ] || count=$all
    # Holds the others out: `count` photographs stay, evenly chosen.
    jq --argjson count $count --argjson all "$all" \
        '[.photographs | to_entries[] | select(.value.split == "train") | .key] as $used
        | reduce range($all) as $i (.; if (($i + 1) * $count / $all | floor) > ($i * $count / $all | floor) then .
              else .photographs[$used[$i]].split = "test" end)' "$scene/scene.json" >"$out/fewer/scene.json"
    ms=$("$oriel" bench "$out/fewer" --method airieau --size 512x512 --quiet --seconds 0.3 --json - | jq '.sizes[0].cpu_ms')
    [ -n "$unit" ] || unit=$ms
    jq -nr --argjson n $count --argjson ms "$ms" --argjson unit "$unit" \
        '"| \($n) | \($ms / $unit * 100 | round / 100) |"'
done
echo
echo "Figure 15."
echo
echo "| photographs at | PSNR to full size, dB | device memory, MiB |"
echo "|---|---|---|"
for divide in 1 2 4 8; do
    drawn=$out/fig15-1of$divide
    mib=$("$oriel" eval "$scene" --method airieau --views 1 --photo-divide $divide --images "$drawn" --quiet --json - |
        jq '.device_bytes | add / 1048576 | round')
    echo "| 1/$divide | $([ $divide = 1 ] && echo - || compare -metric PSNR "$out"/fig15-1of1/*.airieau.png \
        "$drawn"/*.airieau.png null: 2>&1) | $mib |"
done
