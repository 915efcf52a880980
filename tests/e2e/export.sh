#!/usr/bin/env bash
# The kinds of oriel export: what is written, what is refused, the way back, and what COLMAP reads. What
# other programs say of it is in export_elsewhere.sh.
. "$(dirname "$0")/command_lib"
monument_scene || exit 1

runs 0 "$oriel" export made --as ply --out points.ply
runs 0 "$oriel" export made --as splats --sh 2 --out discs.ply
runs 0 "$oriel" export made --as splats --thin --out thin.ply
runs 0 "$oriel" export made --as glb --out scene.glb
runs 0 "$oriel" export made --as nerfstudio --out nerfstudio
runs 0 "$oriel" export made --as blender --out blender
runs 0 "$oriel" export made --as hdri --width 128 --out around.exr
grep -aq scale_2 thin.ply || fail "--thin writes no third scale"
grep -aq scale_2 discs.ply && fail "discs have a third scale"
grep -aq f_rest_23 discs.ply || fail "--sh 2 writes no harmonics"
[ -s blender/open_in_blender.py ] || fail "no script for Blender"
python3 -m py_compile blender/open_in_blender.py || fail "the script for Blender is no Python"
# Up in the world is what is up in the photographs as their EXIF orientation turns them: 6 has its top on the left.
cp -r made turned
jq '.photographs[].orientation = 6' made/scene.json >turned/scene.json
runs 0 "$oriel" export turned --as blender --out turned-blender
python3 - <<'PY' || fail "the upward direction is not that of upright photographs"
import json, math
for folder, column, sign in ("blender", 1, 1), ("turned-blender", 0, -1):
    root = json.load(open(folder + "/transforms.json"))
    up = [sign * sum(frame["transform_matrix"][i][column] for frame in root["frames"]) for i in range(3)]
    assert all(abs(a / math.hypot(*up) - b) < 1e-5 for a, b in zip(up, root["up"])), (folder, up, root["up"])
PY
rm -r turned turned-blender
# nerfstudio wants masks of all photographs or of none.
cp -r made partly
first=$(jq -r '.photographs[0].name' made/scene.json)
last=$(jq -r '.photographs[-1].name' made/scene.json)
mkdir -p partly/masks
cp "made/images/$first" "partly/masks/$first.png"
jq '.photographs[0].mask = true' made/scene.json >partly/scene.json
runs 0 "$oriel" export partly --as nerfstudio --out masked
jq -e '[.frames[] | has("mask_path")] | all' masked/transforms.json >jq.txt || fail "masks of some photographs"
cmp -s "made/images/$first" "masked/masks/$first.png" || fail "a mask is not copied"
python3 - "masked/masks/$last.png" <<'PY' || fail "no mask of the size of a photograph without one"
import struct, sys
assert struct.unpack(">IIBB", open(sys.argv[1], "rb").read()[16:26]) == (240, 160, 8, 0)
PY
rm -r partly masked
# Cameras of survey coordinates keep their places to less than the points' doubles tell apart.
cp -r made surveyed
jq '.origin = [512345.25, 40, 5412345.5]' made/scene.json >surveyed/scene.json
runs 0 "$oriel" export surveyed --as nerfstudio --out far
python3 - <<'PY' || fail "cameras far from 0 are rounded"
import json
near, far = (json.load(open(folder + "/transforms.json"))["frames"] for folder in ("nerfstudio", "far"))
for a, b in zip(near, far):
    for row, other, origin in zip(a["transform_matrix"], b["transform_matrix"], (512345.25, 40, 5412345.5)):
        assert abs(other[3] - origin - row[3]) < 1e-6, (row, other)
PY
rm -r surveyed far
exrheader around.exr | grep -q latitude || fail "an environment map that does not say so"

# What is wrong is refused, and leaves nothing.
runs 2 "$oriel" export made --as ply
runs 2 "$oriel" export made --as ply --out other.ply --sh 1
runs 2 "$oriel" export made --as splats --at 0001.png --out other.ply
runs 2 "$oriel" export made --as hdri --at nobody.png --out other.exr
runs 2 "$oriel" export made --as nerfstudio --out nerfstudio
runs 2 "$oriel" export made --as colmap --out other
runs 2 "$oriel" export nowhere --as ply --out other.ply
ls other* >/dev/null 2>&1 && fail "something was written"

# A scene without points has no cloud to name.
runs 0 "$oriel" import made/sparse --images made/images --out bare --points none
runs 0 "$oriel" export bare --as nerfstudio --out bare-cameras
[ ! -e bare-cameras/points.ply ] && jq -e 'has("ply_file_path") | not' bare-cameras/transforms.json >jq.txt ||
    fail "a cloud of no points is written"
# Nor are there lists of a split where nothing is held out.
jq -e '[has("train_filenames", "val_filenames", "test_filenames")] | any | not' bare-cameras/transforms.json >jq.txt ||
    fail "an empty list of photographs"
runs 0 "$oriel" import bare-cameras/transforms.json --out bare-back

# All points of levels of detail, also where a scene that is opened holds a sample of them.
cp -r made paged
rm paged/points.ply
python3 - >cloud.ply <<'PY'
import struct, sys
n = 1500
names = b'x', b'y', b'z', b'nx', b'ny', b'nz', b'radius'
sys.stdout.buffer.write(b'ply\nformat binary_little_endian 1.0\nelement vertex %d\n' % n ** 2 +
                        b''.join(b'property float %s\n' % name for name in names) + b'end_header\n')
for i in range(n):
    sys.stdout.buffer.write(b''.join(struct.pack('<7f', i / 100, k / 100, 0, 0, 0, 1, 0.01)
                                     for k in range(n)))
PY
runs 0 "$oriel" lod paged --points cloud.ply
runs 0 "$oriel" export paged --as ply --out all.ply
head -c 100 all.ply | grep -aq '^element vertex 2250000$' || fail "not all points of levels of detail"
rm -r cloud.ply all.ply paged

# The scene as it is: COLMAP reads it.
runs 0 "$oriel" export made --as colmap
grep -q 'made is a COLMAP workspace' stdout.txt || fail "colmap does not say what a scene is"
if command -v colmap >/dev/null; then
    runs 0 env QT_QPA_PLATFORM=offscreen colmap model_analyzer --path made/sparse
    cat stdout.txt stderr.txt | grep -q 'Registered images: 8' || fail "COLMAP reads another model"
fi

# The way back: the same picture, to 60 dB, of cameras, photographs and points in one world.
test_list=$(jq -r '[.photographs[] | select(.split == "test") | .name] | join(",")' made/scene.json)
at=$(jq -r '[.photographs[] | select(.split == "test") | .name][0]' made/scene.json)
runs 0 "$oriel" import nerfstudio/transforms.json --out back
[ "$(jq -r '[.photographs[] | select(.split == "test") | .name] | join(",")' back/scene.json)" = \
    "$test_list" ] || fail "another split comes back"
runs 0 "$oriel" import nerfstudio/transforms.json --out flat --points discs.ply
for method in points oriel; do
    runs 0 "$oriel" render made --at "$at" --method $method --out there.png
    runs 0 "$oriel" render back --at "$at" --method $method --out back.png
    same=$(psnr there.png back.png)
    awk -v db="$same" 'BEGIN { exit !(db >= 60) }' || fail "$method: $same dB"
done
# Splats hold other colours than points, and the same surface, which `oriel` paints from photographs.
runs 0 "$oriel" render flat --at "$at" --method oriel --out back.png
same=$(psnr there.png back.png)
awk -v db="$same" 'BEGIN { exit !(db >= 60) }' || fail "splats: $same dB"
exit $failed
