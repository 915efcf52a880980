#!/usr/bin/env bash
# oriel lod: the same picture from points.lod as from points.ply, and refusals.
set -u
. "$2/tests/e2e/command_lib"

monument_scene || exit 77
name=$(basename "$(find made/images -name '*.jpg' | sort | head -n 1)")
all=(--layers depth --size 960x640 --quiet) # of less than a point a pixel no coarser level will do
runs 0 "$oriel" render made --at "$name" "${all[@]}" --out whole.png
runs 0 "$oriel" info made --json
points=$(grep -o '"points": [0-9]*' stdout.txt | head -n 1)
mv made/points.ply cloud.ply
runs 2 "$oriel" lod made
grep -q "points.ply" stderr.txt || fail "what is missing is not named"
runs 0 "$oriel" lod made --points cloud.ply
grep -q "pages of [0-9]* levels" stdout.txt || fail "no word of what was written"
grep -q "points.ply" stderr.txt && fail "a warning of points.ply, which is not read"
runs 0 "$oriel" info made --check
# Without points.ply now.
runs 0 "$oriel" render made --at "$name" "${all[@]}" --out paged.png
# Of points at equal depth, which are many on walls made by hand, another one may win.
if command -v compare >/dev/null; then
    for layer in "" .depth; do
        same=$(psnr "whole$layer.png" "paged$layer.png")
        awk -v db="$same" 'BEGIN { exit !(db > 40) }' || fail "another picture$layer: $same dB"
    done
fi
runs 0 "$oriel" info made --json
[ "$(grep -o '"points": [0-9]*' stdout.txt | head -n 1)" = "$points" ] || fail "not $points"
runs 2 "$oriel" trim made --out trimmed
grep -q "points.lod: remove it" stderr.txt || fail "trim does not say what to do"
[ -e trimmed ] && fail "trim left a folder"
# A site takes a coarser level.
runs 0 "$oriel" publish made --out site --max-points 5000
sent=$(grep -o '[0-9]* points' stdout.txt | grep -o '[0-9]*')
[ "${sent:-0}" -ge 1000 ] && [ "$sent" -le 6000 ] || fail "a site of ${sent:-no} points"
# A damaged file is named, with what to do.
cp made/points.lod sound.lod
printf '\125' | dd of=made/points.lod bs=1 seek=60000 conv=notrunc 2>/dev/null
runs 2 "$oriel" info made --check
grep -q "points.lod: a page is damaged" stderr.txt || fail "info --check does not see a changed page"
runs 2 "$oriel" render made --at "$name" --out damaged.png
mv sound.lod made/points.lod
head -c 100000 made/points.lod >cut && mv cut made/points.lod
runs 2 "$oriel" render made --at "$name" --out cut.png
grep -q "points.lod: .*oriel lod" stderr.txt || fail "a file that is cut off is not told"
exit $failed
