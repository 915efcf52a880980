#!/usr/bin/env bash
# The kinds of oriel export: what is written, what is refused, the way back, and what programs that
# nobody here wrote say of it. These come from npm (ORIEL_NODE_MODULES, or installed here where npm
# reaches a registry), and COLMAP.
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
[ $failed -eq 0 ] || exit 1

# --- Blender ---

if command -v blender >/dev/null; then
    cat >draw.py <<'PY'
import sys, bpy
scene = bpy.context.scene
bpy.data.objects.remove(bpy.data.objects["Cube"])  # of every new file
scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 2, False
scene.render.filepath = sys.argv[-1]
bpy.ops.render.render(write_still=True)
PY
    runs 0 timeout 600 blender --background --python-exit-code 3 --python blender/open_in_blender.py \
        --python draw.py -- "$work/first.png"
    first=blender/$(jq -r '.frames[0].file_path' blender/transforms.json)
    same=$(psnr first.png -alpha off "$first")
    awk -v db="$same" 'BEGIN { exit !(db >= 10.5) }' || fail "Blender sees something else: $same dB"
else
    echo "blender is not installed: not checked with it"
fi
[ $failed -eq 0 ] || exit 1

# --- programs of the registry ---

modules=${ORIEL_NODE_MODULES:-$work/node_modules}
if [ ! -d "$modules/gltf-validator" ]; then
    command -v npm >/dev/null || { echo "npm is not installed: not checked with other programs"; exit 0; }
    timeout 300 npm install --prefix "$work" --no-audit --no-fund --silent gltf-validator \
        @playcanvas/splat-transform playcanvas >npm.txt 2>&1 ||
        { echo "npm reaches no registry: not checked with other programs"; exit 0; }
fi
# The validator knows no KHR_gaussian_splatting, and takes the names of its attributes for errors.
cat >validate.js <<'JS'
const validator = require(process.argv[2] + '/gltf-validator'), fs = require('fs');
const ours = m => m.pointer.includes('/KHR_gaussian_splatting:') &&
    m.code === 'MESH_PRIMITIVE_INVALID_ATTRIBUTE';
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[3])),
                        {maxIssues: 0}).then(report => {
    const left = report.issues.messages.filter(m => m.severity < 2 && !ours(m));
    console.log(JSON.stringify(left));
    process.exit(left.length || report.info.totalVertexCount != process.argv[4] ? 1 : 0);
});
JS
count=$(head -c 400 points.ply | grep -a '^element vertex' | cut -d' ' -f3)
runs 0 node validate.js "$modules" scene.glb "$count"
# splat-transform reads splats, and writes what it read in other formats.
transform=$modules/@playcanvas/splat-transform/bin/cli.mjs
for format in sog spz compressed.ply; do
    runs 0 node "$transform" --gpu cpu -w thin.ply "out.$format"
    [ -s "out.$format" ] || fail "splat-transform wrote no $format"
done
runs 0 node "$transform" thin.ply -m null
grep -q "Row Count:\*\* $count" stdout.txt || fail "splat-transform reads other points"
grep -E '^\| (opacity|scale_2|rot_0|f_dc_0) ' stdout.txt | grep -q nan && fail "a splat is not a number"
[ $failed -eq 0 ] || exit 1

# The engine of SuperSplat's viewer draws them as the format means them, and as the photograph shows.
[ -x "$tools/bench_splat_pictures" ] || { echo "bench_splat_pictures is not built"; exit 77; }
runs 0 "$tools/bench_splat_pictures" made thin.ply here
awk '/^mean/ { exit !($3 >= 16) }' stdout.txt || fail "splats are far from the photographs"
needs_browser
runs 0 timeout 600 /usr/bin/python3 -B "$source/tests/web/splat_pictures.py" "$modules" thin.ply \
    nerfstudio elsewhere
same=$(psnr "elsewhere/${at%.*}.png" -alpha off "here/${at%.*}.png")
awk -v db="$same" 'BEGIN { exit !(db >= 18) }' || fail "the viewer draws something else: $same dB"
[ $failed -eq 0 ]
