#!/usr/bin/env bash
# Measures Oriel as published tables measure: a set's own split, its own picture size, the
# photograph's own pixels, PSNR of RGB, SSIM on RGB, with the set's cameras and with Oriel's own
# calibration, beside published rows (tests/bench/published.tsv).
#     tests/bench/published.sh BUILD llff|blender|mipnerf360 DIR OUT [given|own|both] [QUALITY]
# DIR: the set of one scene, whose name chooses the published rows. llff: every 8th photograph by name,
# images_4 where it is there; cameras.json, else poses_bounds.npy. mipnerf360: every 8th, images_2 of
# the scenes that are indoors and images_4 of the others, else the first of images_8 and images; sparse/0.
# blender: transforms_train.json and transforms_test.json, over white, alpha as silhouette, always with
# the set's cameras. OUT keeps the prepared scenes, so that an interrupted run goes on. QUALITY: draft,
# standard (default), high. Prints a table in Markdown. Needs ImageMagick and jq.
set -euo pipefail
[ $# -ge 4 ] || { sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 2; }
build=$(realpath "$1") kind=$2 dir=$(realpath "$3") out=$(realpath -m "$4")
cameras=${5:-both} quality=${6:-standard}
here=$(dirname "$(realpath "$0")")
name=$(basename "$dir")
name=${name#llff-} name=${name%-400}
set=$out/set images=$out/set/images

# Copies the first of these folders of pictures that is there.
take() {
    local folder
    for folder in "$@"; do
        [ -d "$dir/$folder" ] || continue
        cp -r "$dir/$folder" "$images"
        return
    done
    echo "$dir: none of $* is there" >&2
    return 1
}
every_8th() {
    (cd "$images" && ls | LC_ALL=C sort | awk 'NR % 8 == 1' | paste -sd,) >"$set/test.txt"
}
set_llff() {
    take images_4 images
    if [ -e "$dir/cameras.json" ]; then
        cp "$dir/cameras.json" "$set"
    else
        cp "$dir/poses_bounds.npy" "$set"
    fi
    every_8th
}
set_mipnerf360() {
    case $name in
    bonsai | counter | kitchen | room) take images_2 images_4 images_8 images ;;
    *) take images_4 images_2 images_8 images ;;
    esac
    cp -r "$dir/sparse/0" "$set/sparse"
    every_8th
}
set_blender() {
    local split picture
    mkdir "$images" "$set/masks"
    for split in train test; do
        for picture in "$dir/$split"/r_*.png; do
            [[ $picture != *_depth_* && $picture != *_normal_* ]] || continue
            convert "$picture" -background white -alpha remove -alpha off \
                "$images/${split}_$(basename "$picture")"
            convert "$picture" -alpha extract -threshold 50% \
                "$set/masks/${split}_$(basename "$picture")"
        done
    done
    # Cameras whose pictures are there: some copies of a set have a part of the test views.
    (cd "$images" && ls) | jq -R . | jq -s . >"$set/names.json"
    jq -s --slurpfile names "$set/names.json" '.[0] + {frames: [.[].frames[] |
        .file_path |= (sub("^\\./"; "") | gsub("/"; "_") + ".png") |
        select(.file_path as $name | $names[0] | index($name)) | .file_path |= "images/" + .]}' \
        "$dir/transforms_train.json" "$dir/transforms_test.json" >"$set/transforms.json"
    (cd "$images" && ls test_*) | paste -sd, >"$set/test.txt"
    cameras=given
}

[ "$kind" != blender ] || cameras=given
if [ ! -s "$set/test.txt" ]; then
    rm -rf "$set"
    mkdir -p "$set"
    "set_$kind"
fi
masks=()
[ ! -d "$set/masks" ] || masks=(--masks "$set/masks")
size=$(identify -format '%[fx:max(w,h)]\n' "$(find "$images" -type f | sort | head -1)")

scene() { # given|own
    [ ! -s "$out/$1/scene.json" ] || return 0
    local from=$set
    if [ "$1" = own ]; then
        "$build/oriel" prepare "$images" --out "$out/own" --max-size "$size" \
            --test-list "$(cat "$set/test.txt")" --quality "$quality" --resume --quiet
    else
        [ ! -e "$set/cameras.json" ] || from=$set/cameras.json
        [ ! -e "$set/poses_bounds.npy" ] || from=$set/poses_bounds.npy
        [ ! -e "$set/transforms.json" ] || from=$set/transforms.json
        "$build/oriel" import "$from" --images "$images" --out "$out/given" --points densify \
            --test-list "$(cat "$set/test.txt")" --quality "$quality" "${masks[@]}" --quiet
    fi >&2
}

all=$(tr ',' '\n' <"$set/test.txt" | wc -l)
echo "| $name | PSNR RGB | SSIM on RGB | SSIM on luma | |"
echo "|---|---|---|---|---|"
for which in given own; do
    [ "$cameras" = both ] || [ "$cameras" = $which ] || continue
    scene $which
    for method in oriel points; do
        "$build/tests/bench_published_pictures" "$out/$which" "$images" $method \
            "$out/pictures/$which/$method" >"$out/$which.$method.txt"
        awk -v row="Oriel, \`$method\`" -v all="$all" \
            -v note="$which cameras, stereo $quality, longer side $size" \
            '$1 != "mean" { n++ }
             $1 == "mean" { printf "| %s | %.2f | %.3f | %.3f | %s, %d of %d views |\n", row, $2, $3,
                 $4, note, n, all }' "$out/$which.$method.txt"
    done
done
awk -F'\t' -v kind="$kind" -v name="$name" \
    '$1 == kind && $2 == name { printf "| %s | %s | %s | | %s |\n", $3, $4, $5 == "" ? "-" : $5, $6 }' \
    "$here/published.tsv"
