#!/usr/bin/env bash
# tests/bench/published.sh on the layouts of published sets, made of a synthetic scene with its true
# cameras: cameras are those of the full size, pictures are there in several sizes, sides are odd.
. "$(dirname "$0")/command_lib"
build=$(dirname "$oriel")
[ -x "$build/tests/bench_published_pictures" ] || { echo "bench_published_pictures is not built"; exit 77; }
for tool in colmap convert jq python3; do
    command -v $tool >/dev/null || { echo "skipped: $tool is not here"; exit 77; }
done
runs 0 "$oriel" synth monument --out photos --size 129x87 --count 10
[ $failed -eq 0 ] || exit 1
mkdir small
for photo in photos/*; do
    convert "$photo" -resize 65x44! "small/$(basename "$photo")"
done
runs 0 python3 "$source/tests/e2e/write_layouts.py" photos-truth photos small
[ $failed -eq 0 ] || exit 1

# What true cameras give.
runs 0 "$oriel" import photos-truth/cameras.json --images photos --out truth --points densify --quality draft \
    --test-list 0001.jpg,0009.jpg
runs 0 "$build/tests/bench_published_pictures" truth photos oriel drawn
[ $failed -eq 0 ] || exit 1

# published KIND SCENE HELD: the scene's table has the published rows, if there are any, and pictures of
# the set's size at the photographs that are to be held out, as true cameras draw them.
published() {
    runs 0 "$source/tests/bench/published.sh" "$build" "$1" "$2" "out-$2" given draft
    [ "$(grep -c trained stdout.txt)" = "$(grep -c "^$1.$2.*trained" "$source/tests/bench/published.tsv")" ] ||
        fail "$2: other published rows"
    grep '^| Oriel, `oriel`' stdout.txt | grep -q 'longer side 129, 2 of 2 views' || fail "$2: another size"
    [ "$(cut -d' ' -f1 "out-$2/given.oriel.txt" | paste -sd' ')" = "${3// /.jpg }.jpg mean" ] || fail "$2: another split"
    same=$(psnr drawn/0009.png "out-$2/pictures/given/oriel/${3##* }.png")
    awk -v db="$same" 'BEGIN { exit !(db >= 22) }' || fail "$2: $same dB to the picture of true cameras"
}
published mipnerf360 garden "0001 0009"
published mipnerf360 bonsai "0001 0009"
published llff fern "image000 image008"
exit $failed
