#!/bin/bash
# A photograph with something before the camera: prepare finds it, renderings do without it, and its
# mask is a result like any other. With COLMAP itself and the device.
. "$2/tests/e2e/prepare_lib"
paint=$(dirname "$oriel")/tests/paint_rectangle
[ -x "$paint" ] || { echo "skipped: paint_rectangle was not built"; exit 77; }
monument 384x256 12
"$paint" "$work/p/0005.jpg" "$work/p/0005.jpg" 150 60 90 110 250 || fail "nothing was painted"

prepare() {
    run 0 prepare "$work/p" --out "$work/s" --quality draft --test-list 0004.jpg "$@"
}
mean() { # PSNR of the held-out photograph, which stands beside the painted one
    run 0 eval "$work/s" --json "$work/mean.json"
    sed -n '/"mean"/,$ s/^ *"psnr_db": \([0-9.]*\),*$/\1/p' "$work/mean.json" | head -n 1
}

prepare
says "occluders: 1 photographs show some"
run 0 info "$work/s"
grep -q "0005.jpg .*occluders" "$work/out" || fail "info does not name the photograph"
[ "$(grep -c '"occluded": 0\.' "$work/s/scene.json")" = 1 ] || fail "scene.json tells of other photographs"
mask=$work/s/occluders/0005.jpg.png
[ -s "$mask" ] || fail "there is no mask"
grep -q '"tuned"' "$work/s/scene.json" || fail "nothing was found on the training photographs"

# A published scene has it in the depth map of that photograph, the fourth for training, and in no
# other.
cp "$work/s/scene.json" "$work/scene.json"
drop=$(mean)
run 0 publish "$work/s" --out "$work/with"
sed -i 's/"occluded": 0\.[0-9]*/"occluded": 0/' "$work/s/scene.json"
keep=$(mean)
awk -v keep="$keep" -v drop="$drop" 'BEGIN { exit !(drop > keep + 0.2) }' ||
    fail "held out, with the mask $drop dB, without $keep dB"
run 0 publish "$work/s" --out "$work/without"
cp "$work/scene.json" "$work/s/scene.json"
for depth in "$work"/with/depth/*; do
    cmp -s "$depth" "$work/without/depth/${depth##*/}" || echo "${depth##*/}"
done >"$work/changed"
[ "$(cat "$work/changed")" = 00003.png ] || fail "published depth that changes: $(cat "$work/changed")"

# A mask that is lost or damaged is noticed, and made again.
sum=$(md5sum <"$mask")
cp "$mask" "$work/mask.png"
printf x | dd of="$mask" bs=1 seek=40 conv=notrunc status=none
run 2 info "$work/s" --check
says "0005.jpg.png: "
prepare --resume
says "occluders is done again"
[ "$(md5sum <"$mask")" = "$sum" ] || fail "the mask that was made again is another"
rm "$mask"
run 2 info "$work/s"
says "0005.jpg.png: these occluders are missing"
prepare --resume
[ "$(md5sum <"$mask")" = "$sum" ] || fail "the lost mask is another"
head -c 60 "$work/mask.png" >"$mask"
run 2 eval "$work/s"
says "0005.jpg.png"
prepare --resume

# Where they are not looked for, the masks go.
prepare --resume --occluders none
[ -e "$work/s/occluders" ] && fail "--occluders none leaves masks"
grep -q '"occluded": 0\.' "$work/s/scene.json" && fail "--occluders none leaves shares"
grep -q "occluders: done already\|occluders  *started" "$work/err" && fail "--occluders none looks for them"
run 0 info "$work/s" --check
prepare --resume
[ "$(md5sum <"$mask")" = "$sum" ] || fail "the mask that is wanted again is another"

# A photograph without it: the mask goes. Options of rendering are found where they are asked for.
rm -r "$work/p" "$work/p-truth"
monument 384x256 12
prepare --resume --adapt none
grep -q '"tuned"' "$work/s/scene.json" && fail "--adapt none finds options"
says "occluders: 0 photographs show some"
[ -e "$work/s/occluders" ] && fail "the mask stays"
grep -q '"occluded": 0\.' "$work/s/scene.json" && fail "scene.json tells of an occluder"
finish
