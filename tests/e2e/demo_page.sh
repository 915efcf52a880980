#!/usr/bin/env bash
# The page that demo.sh leaves, of photographs with long names: on a telephone nothing is wider than the window.
# shellcheck disable=SC2034
. "$(dirname "$0")/command_lib"
needs_browser
command -v ffmpeg >/dev/null || { echo "skipped: ffmpeg is not installed"; exit 77; }
workspace 4 || exit 1
square
long=IMG_20240607_173012345_HDR_panorama_of_the_market_square.jpg
mv "ws/images/${names[3]}" "ws/images/$long"
sed -i "s/${names[3]}/$long/" ws/sparse/images.txt
names[3]=$long
scene train train train test

# As demo.sh has them.
. "$source/datasets/demo/page.sh"
demo=$work/demo scene=$work/ws method=oriel photo_count=4 minutes=12 version=0.1 invoked='./demo.sh PHOTOS'
title='A_title_of_one_long_word_that_somebody_gave_to_the_photographs, and more words'
step_json='{"name": "a step with a long name", "seconds": 12345}'
mkdir demo
runs 0 "$oriel" eval ws --method all --json demo/eval.json --images demo/eval
runs 0 "$oriel" render ws --path photos --frames 2 --size 64x48 --out demo/walk.mp4
runs 0 "$oriel" render ws --at "${names[0]}" --layers depth --out demo/view.png
echo '<!doctype html><title>walk</title>' >demo/walk.html
write_page >stdout.txt 2>stderr.txt || fail "no page is written"
[ $failed -eq 0 ] || exit 1
timeout 300 /usr/bin/python3 -B "$source/tests/web/test_demo.py" "$work/demo" 2>&1
