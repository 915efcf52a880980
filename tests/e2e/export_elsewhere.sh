#!/usr/bin/env bash
# What programs that nobody here wrote say of what oriel export writes: Blender, and programs from npm
# (ORIEL_NODE_MODULES, or installed here where npm reaches a registry). 77 without these.
. "$(dirname "$0")/command_lib"
monument_scene || exit 1

at=$(jq -r '[.photographs[] | select(.split == "test") | .name][0]' made/scene.json)
runs 0 "$oriel" export made --as ply --out points.ply
runs 0 "$oriel" export made --as splats --thin --out thin.ply
runs 0 "$oriel" export made --as glb --out scene.glb
runs 0 "$oriel" export made --as nerfstudio --out nerfstudio
runs 0 "$oriel" export made --as blender --out blender
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
    # Two focal lengths, and a principal point beside the middle: a point of the world is where the photograph has it.
    cp -r blender oblong
    jq '.frames[].fl_y *= 1.25 | .frames[].cy += 20' blender/transforms.json >oblong/transforms.json
    cat >project.py <<'PY'
import json, bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector
frame, scene = json.load(open("oblong/transforms.json"))["frames"][0], bpy.context.scene
bpy.context.view_layer.update()
at = world_to_camera_view(scene, scene.camera, scene.camera.matrix_world @ Vector((0.1, 0.2, -1)))
x, y = frame["cx"] + 0.1 * frame["fl_x"], frame["cy"] - 0.2 * frame["fl_y"]
assert abs(at.x * frame["w"] - x) < 0.1 and abs((1 - at.y) * frame["h"] - y) < 0.1, (at, x, y)
PY
    runs 0 timeout 600 blender --background --python-exit-code 3 --python oblong/open_in_blender.py --python project.py
else
    echo "blender is not installed: not checked with it"
fi
[ $failed -eq 0 ] || exit 1

# --- programs of the registry ---

modules=${ORIEL_NODE_MODULES:-$work/node_modules}
if [ ! -d "$modules/gltf-validator" ]; then
    command -v npm >/dev/null || { echo "npm is not installed: not checked with other programs"; exit 77; }
    timeout 300 npm install --prefix "$work" --no-audit --no-fund --silent gltf-validator \
        @playcanvas/splat-transform playcanvas >npm.txt 2>&1 ||
        { echo "npm reaches no registry: not checked with other programs"; exit 77; }
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
exit $failed
