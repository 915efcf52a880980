#!/bin/bash
# The whole pipeline with COLMAP itself and the device, on small photographs of the
# synthetic monument, whose cameras are known.
. "$2/tests/e2e/prepare_lib"
monument 384x288 7
head -c 5000 "$work/p/0001.jpg" >"$work/p/cut.jpg"

prepare() {
    run 0 prepare "$work/p" --out "$work/s" --quality draft --max-size 256 --test-list 0004 \
        --keep all "$@"
}
prepare
says "cut.jpg: "
prints "8 given, 7 used, 7 registered (6 train, 1 held out)"
for file in images/0004.jpg sparse/images.bin points.ply scene.json \
    stereo/depth_maps/0003.jpg.geometric.bin logs/colmap.log; do
    [ -s "$work/s/$file" ] || fail "$file is missing"
done
[ -e "$work/s/stereo/depth_maps/0004.jpg.geometric.bin" ] &&
    fail "a held-out photograph has a depth map"

# Distances between cameras in units of the first, against the true ones.
run 0 info "$work/s" --json
error=$(awk '
    { gsub(/[",]/, "") }
    $1 == "name:" || $1 == "img_name:" { sub(/\.jpg/, "", $2); id = FILENAME " " $2 }
    $1 == "position:" {
        getline x[id]; getline y[id]; getline z[id]
        files[FILENAME]
    }
    function far(a, b) {
        return sqrt((x[a] - x[b]) ^ 2 + (y[a] - y[b]) ^ 2 + (z[a] - z[b]) ^ 2)
    }
    END {
        for (file in files)
            for (i = 2; i <= 7; i++) {
                ratio = far(file " 0001", file " 000" i) / far(file " 0001", file " 0007")
                change[i] = ratio - change[i]
            }
        worst = 0
        for (i in change)
            worst = change[i] ^ 2 > worst ^ 2 ? change[i] : worst
        print worst
    }' "$work/out" "$work/p-truth/cameras.json")
awk -v e="$error" 'BEGIN { exit !(e != 0 && e < 0.03 && e > -0.03) }' ||
    fail "distances between cameras are off by $error"
points=$(sed -n 's/^  "points": \([0-9]*\),*$/\1/p' "$work/out")
[ "${points:-0}" -gt 5000 ] || fail "only ${points:-0} points"

# The same cameras, settings and seed give the same points, bit by bit.
sum=$(md5sum <"$work/s/points.ply")
grep -v '_s"\|_mib"' "$work/s/scene.json" >"$work/scene.json"
rm -r "$work/s/stereo" "$work/s/.oriel/fused.ply" "$work/s/points.ply"
prepare --resume
says "calibrate: done already"
[ "$(md5sum <"$work/s/points.ply")" = "$sum" ] || fail "a second run gives other points"
grep -v '_s"\|_mib"' "$work/s/scene.json" | diff - "$work/scene.json" >"$work/diff" ||
    fail "a second run says other things: $(head -n 5 "$work/diff")"

# Less memory than the fusion takes, of too few photographs to divide: it says so, and the points are
# the same.
rm "$work/s/.oriel/fused.ply" "$work/s/points.ply"
prepare --resume --max-ram 36
says "MiB are not enough for 6 photographs; it takes about 38 MiB"
[ "$(md5sum <"$work/s/points.ply")" = "$sum" ] || fail "fusion within less memory gives other points"

# Less memory than all points take: they are divided, and as many but for those whose isolation
# depends on neighbours beyond the margin of their part.
rm "$work/s/points.ply"
prepare --resume --max-ram 1
says "dividing them on disk"
says "MiB of disk; "
[ -s "$work/s/points.lod" ] || fail "points.lod is missing"
[ -e "$work/s/points.ply" ] && fail "points.ply is left"
run 0 info "$work/s"
awk -v whole="$points" '$1 == "points" { off = ($2 - whole) / whole; found = 1 }
    END { exit !(found && off < 0.002 && off > -0.002) }' "$work/out" ||
    fail "$(grep '^points' "$work/out") in parts, $points as a whole"
run 0 eval "$work/s"
prepare --resume --max-ram 1
says "radii: done already"

# Less device memory than it takes: smaller maps, a scene all the same.
prepare --resume --max-vram 2
says "MiB of device memory; using less"
says "undistort: done already"
[ -s "$work/s/points.ply" ] && [ ! -e "$work/s/points.lod" ] || fail "points.lod is left"
size=$(head -c 8 "$work/s/stereo/depth_maps/0003.jpg.geometric.bin")
[ "${size%%&*}" -lt 256 ] || fail "the depth maps have their full size: $size"
prepare --resume --max-vram 2
says "densify: done already"
finish
