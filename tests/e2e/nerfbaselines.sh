#!/usr/bin/env bash
# contrib/nerfbaselines: the method as the benchmark calls it, on the synthetic monument.
. "$(dirname "$0")/command_lib"
/usr/bin/python3 -c 'import numpy, PIL' 2>/dev/null || { echo "numpy or PIL is missing"; exit 77; }
command -v colmap >/dev/null || { echo "colmap is not installed"; exit 77; }
"$oriel" synth monument --out photos --size 192x128 --count 9 --quiet || exit 1
cat >bench.py <<'PY'
"""NerfBaselines' calls, with cameras as it has them."""
import json, os, sys
from types import SimpleNamespace
import numpy
from PIL import Image
sys.path.insert(0, sys.argv[1])
from oriel import Oriel

class Cameras(SimpleNamespace):
    def item(self):
        return self
    def __getitem__(self, i):
        return Cameras(**{k: v[i] for k, v in vars(self).items()})
    def __iter__(self):
        return (self[i] for i in range(len(self.poses)))

entries = json.load(open("photos-truth/cameras.json"))
def cameras(rows):
    poses = [numpy.concatenate([numpy.array(e["rotation"]), numpy.array(e["position"])[:, None]], 1)
             for e in rows]
    return Cameras(poses=numpy.array(poses, numpy.float32), image_sizes=numpy.array([[e["width"], e["height"]] for e in rows]),
                   intrinsics=numpy.array([[e["fx"], e["fy"], e["width"] / 2, e["height"] / 2] for e in rows], numpy.float32))
def picture(e):
    name = [n for n in os.listdir("photos") if n.startswith(os.path.splitext(e["img_name"])[0])][0]
    return numpy.asarray(Image.open(os.path.join("photos", name)))
train, test = entries[:4] + entries[5:], entries[4]
method = Oriel(train_dataset={"cameras": cameras(train), "images": [picture(e) for e in train]},
               config_overrides={"quality": "draft"})
assert method.get_info()["num_iterations"] == 1
method.train_iteration(0)
os.makedirs("checkpoint")
method.save("checkpoint")
color = Oriel(checkpoint="checkpoint").render(cameras([test])[0])["color"]
truth = picture(test)
assert color.shape == truth.shape and color.dtype == numpy.float32, (color.shape, color.dtype)
print("PSNR", -10 * numpy.log10(numpy.mean((color - truth / 255) ** 2)))
PY
runs 0 env ORIEL="$oriel" /usr/bin/python3 -B bench.py "$source/contrib/nerfbaselines"
awk '/^PSNR/ { exit !($2 > 16) }' stdout.txt || fail "the picture is not that of the photograph"
[ $failed -eq 0 ]
