"""oriel stress: accuracy of all methods as one thing at a time gets worse, on a scene's held-out
photographs or on the synthetic monument (docs/reference/stress.md).

A case is a scene in memory: cameras, photographs and points, which an axis changes. It is written
as files that `oriel import` makes a scene of, and measured there."""

import copy
import io
import pathlib
import shutil
import sys
import tempfile

import report
from report import FIGURES, Failure, fixed, mean

import numpy as np
from PIL import Image, ImageDraw

POINTS_MAX, POINT_STEP = 120000, 3
PHOTOS_LEFT, PHOTOS_FOR_A_VIEW = 3, 2
STEPS_APART = 8  # of the cameras that are most out of step
LOSSES_DB = [1, 3, 6]
COSTS = ["frame_ms", "cpu_ms", "device_bytes"]
ON_ORIEL = "+oriel"  # after a method's name: its weights on the proxy and the guesses of oriel
REFINED = "oriel+soft"  # oriel, once oriel refine has made soft splats of the case
BARS_DISTANCE_M, FOCAL = 9.8, 28 / 35  # of the monument's bars; focal length of the larger side


class Camera:
    """A pinhole: x = K (R X + t), y down, z forward."""

    def __init__(self, name, size, k, r, t):
        self.name, self.size = name, size
        self.k, self.r, self.t = np.array(k, float), np.array(r, float), np.array(t, float)

    def eye(self):
        return -self.r.T @ self.t

    def project(self, points):
        """Pixels and depths of points; depths at or below 0 are behind the camera."""
        local = points @ self.r.T + self.t
        z = local[:, 2]
        pixels = local @ self.k.T
        return pixels[:, :2] / np.where(z > 0, z, np.nan)[:, None], z

    def sees(self, points):
        at, z = self.project(points)
        inside = (z > 0) & (at >= 0).all(1) & (at[:, 0] < self.size[0]) & (at[:, 1] < self.size[1])
        return inside, at, z

    def json(self):
        return {"name": self.name, "width": self.size[0], "height": self.size[1],
                "K": self.k.tolist(), "R": self.r.tolist(), "t": self.t.tolist()}


class Case:
    def __init__(self):
        self.cameras, self.photos, self.masks = {}, {}, {}
        self.tests, self.left_out, self.gains = set(), set(), {}
        self.points = {key: np.zeros((0, 3)) for key in ("xyz", "normal", "rgb")}
        self.empty, self.steps = {}, {}  # of the figure: pictures without it; its time steps
        self.jpeg = self.hull = None
        self.truth = None  # where the truth of a vehicle is; stereo makes the points then

    def copy(self):
        other = copy.copy(self)
        other.cameras = copy.deepcopy(self.cameras)
        for key in ("photos", "masks", "tests", "left_out", "gains", "points"):
            setattr(other, key, getattr(self, key).copy())
        return other

    def used(self):
        return [n for n in sorted(self.cameras) if n not in self.tests and n not in self.left_out]

    def distance(self):
        """Median depth of what photographs see in their middle half."""
        found = []
        for name in self.used():
            camera = self.cameras[name]
            inside, at, z = camera.sees(self.points["xyz"])
            inside &= (abs(at / np.array(camera.size) - 0.5) < 0.25).all(1)
            found += [np.median(z[inside])] if inside.any() else []
        return float(np.median(found)) if found else 1.0

    def walk(self):
        """Neighbouring views from the first held-out one towards the next photograph in use."""
        names = sorted(self.cameras)
        start = names.index(min(self.tests))
        ring = names[start:] + names[:start]
        a, b = self.cameras[ring[0]], self.cameras[next(n for n in ring[1:] if n in self.used())]
        views = []
        for share in (0, 0.1, 0.2):
            mixed = (1 - share) * a.r + share * b.r
            u, _, v = np.linalg.svd(mixed)  # the nearest rotation
            eye = (1 - share) * a.eye() + share * b.eye()
            views.append(np.column_stack([u @ v, -u @ v @ eye]).tolist())
        fov = 2 * np.degrees(np.arctan(a.size[1] / 2 / a.k[1, 1]))
        return {"keyframes": [{"cam_from_world": view, "fov_y_deg": fov} for view in views]}

    def target(self, name):
        """What a view looks at: the point on its axis at the scene's distance."""
        camera = self.cameras[name]
        return camera.r.T @ (np.array([0, 0, self.distance()]) - camera.t)

    # --- files ---

    def write(self, run, folder):
        """The case as a scene, folder/scene. None: its silhouettes leave no hull, or stereo finds nothing."""
        shutil.rmtree(folder, ignore_errors=True)
        names = [n for n in sorted(self.cameras) if n not in self.left_out]
        for kind in ("images", *(["masks"] if self.hull else [])):
            (folder / kind).mkdir(parents=True)
        for name in names:
            picture = Image.fromarray(self.photos[name])
            if self.jpeg and name not in self.tests:
                picture.save(folder / "images" / f"{name}.jpg", quality=int(self.jpeg), subsampling=0)
            else:
                picture.save(folder / "images" / f"{name}.png")
            if self.hull:
                Image.fromarray(self.masks[name]).save(folder / "masks" / f"{name}.png")
        report.write_json(folder / "cameras.json", {
            "pixel_centre": 0.5, "cameras": [self.cameras[n].json() for n in names]})
        words = ["import", folder / "cameras.json", "--images", folder / "images",
                 "--test-list", ",".join(n for n in names if n in self.tests),
                 "--out", folder / "scene"]
        if self.hull:
            words += ["--masks", folder / "masks", "--mesh", "hull=64,5000", "--points", "none"]
        elif self.truth:
            words += ["--points", "densify"]
        else:
            write_points(folder / "points.ply", self.points)
            words += ["--points", folder / "points.ply"]
        if run.call(*words) is None:
            if self.hull or self.truth:
                return None
            raise Failure("oriel import failed")
        if self.gains:
            path = folder / "scene" / "scene.json"
            manifest = report.json.loads(path.read_text())
            for photo in manifest["photographs"]:
                stem = pathlib.Path(photo["name"]).stem
                if stem in self.gains:
                    photo["gain"] = [float(g) for g in self.gains[stem]]
            report.write_json(path, manifest)
        return folder / "scene"


def write_points(path, points):
    columns = [("x", "xyz"), ("y", "xyz"), ("z", "xyz"), ("nx", "normal"), ("ny", "normal"),
               ("nz", "normal"), ("red", "rgb"), ("green", "rgb"), ("blue", "rgb")]
    table = np.zeros(len(points["xyz"]), [(n, "u1" if k == "rgb" else "<f4") for n, k in columns])
    for at, (name, key) in enumerate(columns):
        table[name] = points[key][:, at % 3]
    head = "".join(f"property {'uchar' if k == 'rgb' else 'float'} {n}\n" for n, k in columns)
    path.write_bytes(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(table)}\n{head}"
                     "end_header\n".encode() + table.tobytes())


def read_points(path):
    """Points of a PLY file as `oriel export --as nerfstudio` writes it."""
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "float32": "<f4"}
    data = path.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    words = [line.split() for line in head.decode().splitlines()]
    count = next(int(w[2]) for w in words if w[:2] == ["element", "vertex"])
    table = np.frombuffer(body, [(w[2], kinds[w[1]]) for w in words if w[0] == "property"], count)
    take = lambda *names: np.stack([table[n].astype(float) for n in names], 1)
    return {"xyz": take("x", "y", "z"), "normal": take("nx", "ny", "nz"),
            "rgb": take("red", "green", "blue")}


def read_map(path):
    """A map as COLMAP writes it: width, height and channels as text, then numbers."""
    *size, body = path.read_bytes().split(b"&", 3)
    width, height, channels = map(int, size)
    return np.frombuffer(body, "<f4").reshape(channels, height, width)


def read_picture(path, size, mode):
    with Image.open(path) as picture:
        return np.asarray(picture.convert(mode).resize(size, Image.Resampling.BOX
                                                       if mode == "RGB" else Image.Resampling.NEAREST))


# --- where cases come from ---

def synth(run, folder, words=(), path=None):
    """Photographs of the monument, and their cameras, as Inria's program writes them."""
    side = int(run.options["size"])
    shutil.rmtree(folder, ignore_errors=True)
    shutil.rmtree(f"{folder}-truth", ignore_errors=True)
    run.needs("synth", "monument", "--out", folder, "--truth", f"{folder}-truth",
              "--size", f"{side}x{side * 2 // 3}", "--seed", run.options["seed"], *words,
              *(["--path", path] if path else []))
    case = Case()
    for c in report.json.loads(pathlib.Path(f"{folder}-truth/cameras.json").read_text()):
        r = np.array(c["rotation"]).T
        case.cameras[c["img_name"]] = Camera(
            c["img_name"], (c["width"], c["height"]),
            [[c["fx"], 0, c["width"] / 2], [0, c["fy"], c["height"] / 2], [0, 0, 1]],
            r, -r @ np.array(c["position"]))
        case.photos[c["img_name"]] = read_picture(folder / f"{c['img_name']}.jpg",
                                                  (c["width"], c["height"]), "RGB")
    return case


def hold_out(case, views):
    names = sorted(case.cameras)
    case.tests = {names[(k + 1) * len(names) // (views + 1)] for k in range(views)}


def monument(run, words=(), name="monument"):
    """The monument with points of the true depth of its photographs."""
    views, folder = views_of(run), run.work / name
    case = synth(run, folder, ["--count", int(run.options["photographs"]) + views, *words])
    hold_out(case, views)
    found = {"xyz": [], "normal": [], "rgb": []}
    for name in case.used():
        camera, maps = case.cameras[name], pathlib.Path(f"{folder}-truth/stereo")
        depth = read_map(maps / "depth_maps" / f"{name}.jpg.geometric.bin")[0]
        normal = read_map(maps / "normal_maps" / f"{name}.jpg.geometric.bin")
        textured = maps / "texture_maps" / f"{name}.jpg.geometric.bin"
        there = depth > 0
        if textured.exists():  # where a wall has no texture, stereo finds nothing
            there &= read_map(textured)[0] > 0
        every = np.zeros_like(there)
        every[::POINT_STEP, ::POINT_STEP] = True
        y, x = np.nonzero(there & every)
        rays = np.stack([x + 0.5, y + 0.5, np.ones(len(x))], 1) @ np.linalg.inv(camera.k).T
        found["xyz"].append((rays * depth[y, x][:, None] - camera.t) @ camera.r)
        found["normal"].append(normal[:, y, x].T @ camera.r)
        found["rgb"].append(case.photos[name][y, x])
    case.points = {key: np.concatenate(parts).astype(float) for key, parts in found.items()}
    recolor(case)
    return case


def figure(run, steps=1):
    """A walking figure in a room, with silhouettes, at the middle one of so many time steps."""
    side, views, folder = int(run.options["size"]), views_of(run), run.work / "figure"
    shutil.rmtree(folder, ignore_errors=True)
    run.needs("synth", "figures", "--out", folder, "--frames", steps, "--size", f"{side}x{side * 2 // 3}",
              "--cameras", int(run.options["photographs"]) + views)
    case = Case()
    for c in report.json.loads((folder / "cameras.json").read_text())["cameras"]:
        name, size = c["name"], (c["width"], c["height"])
        files = [f"{name}/{step:05d}.png" for step in range(steps)] if steps > 1 else [f"{name}.png"]
        case.cameras[name] = Camera(name, size, c["K"], c["R"], c["t"])
        case.steps[name] = [(read_picture(folder / "images" / file, size, "RGB"),
                             read_picture(folder / "masks" / file, size, "L")) for file in files]
        case.photos[name], case.masks[name] = case.steps[name][steps // 2]
        case.empty[name] = read_picture(folder / "background" / f"{name}.png", size, "RGB")
    hold_out(case, views)
    return case


def from_scene(run, scene):
    """A scene at the size of the report, with a part of its points."""
    folder, case, side = run.work / "export", Case(), int(run.options["size"])
    shutil.rmtree(folder, ignore_errors=True)
    run.needs("export", scene, "--as", "nerfstudio", "--out", folder)
    transforms = report.json.loads((folder / "transforms.json").read_text())
    tests = transforms.get("test_filenames", [])
    for at, f in enumerate(transforms["frames"]):
        f = {**transforms, **f}
        name, scale = f"{at:04d}", side / max(f["w"], f["h"])
        size = (round(f["w"] * min(scale, 1)), round(f["h"] * min(scale, 1)))
        sx, sy = size[0] / f["w"], size[1] / f["h"]
        pose = np.array(f["transform_matrix"])[:3] @ np.diag([1, -1, -1, 1])  # from OpenGL's axes
        r = pose[:, :3].T
        case.cameras[name] = Camera(name, size, [[f["fl_x"] * sx, 0, f["cx"] * sx],
                                                 [0, f["fl_y"] * sy, f["cy"] * sy], [0, 0, 1]],
                                    r, -r @ pose[:, 3])
        case.photos[name] = read_picture(folder / f["file_path"], size, "RGB")
        if f.get("mask_path"):
            case.masks[name] = read_picture(folder / f["mask_path"], size, "L")
        case.tests |= {name} if f["file_path"] in tests else set()
    held = sorted(case.tests)
    if not held:
        raise Failure(f"{scene}: no photograph is held out to compare with; prepare the scene with "
                      "--test-every N, --test-list A,B or --test-block A:B")
    views = min(views_of(run), len(held))
    case.tests = {held[k * len(held) // views] for k in range(views)}
    case.left_out = set(held) - case.tests
    points = read_points(folder / transforms["ply_file_path"])
    step = -(-len(points["xyz"]) // POINTS_MAX) or 1
    case.points = {key: values[::step] for key, values in points.items()}
    recolor(case)
    return case


def views_of(run):
    return 1 if run.options.get("quick") else int(run.options["views"])


# --- colours of points ---

def detail_in(camera, points):
    """How finely a photograph shows points, whether or not something hides them; 0: outside."""
    inside, at, z = camera.sees(points["xyz"])
    way = camera.eye() - points["xyz"]
    distance = np.linalg.norm(way, axis=1)
    facing = (way * points["normal"]).sum(1) / np.maximum(distance, 1e-12)
    return np.where(inside, np.maximum(facing, 1e-3) * camera.k[0, 0] / np.maximum(distance, 1e-12), 0), at, z


def recolor(case):
    """Gives points the colours of the photographs in use, so that a trial knows nothing of others."""
    points, cell = case.points, 4
    best = np.zeros(len(points["xyz"]))
    points["rgb"] = points["rgb"].copy()
    for name in case.used():
        camera = case.cameras[name]
        detail, at, z = detail_in(camera, points)
        seen = np.nonzero(detail > 0)[0]
        pixel = at[seen].astype(int)
        cells = pixel[:, 1] // cell * (camera.size[0] // cell + 1) + pixel[:, 0] // cell
        nearest = np.full(cells.max() + 1 if len(cells) else 0, np.inf)
        np.minimum.at(nearest, cells, z[seen])
        slack = max(0.02, 3 * cell / camera.k[0, 0])  # of surfaces at up to some 70 degrees
        shown = (z[seen] <= (1 + slack) * nearest[cells]) & (detail[seen] > best[seen])
        best[seen[shown]] = detail[seen[shown]]
        points["rgb"][seen[shown]] = case.photos[name][pixel[shown, 1], pixel[shown, 0]]
    # What no photograph shows takes the mean colour of what is shown around it.
    hidden, size = best == 0, np.ptp(points["xyz"], 0).max() / 256 if len(best) else 0
    while hidden.any() and not hidden.all():
        _, cells = np.unique(np.floor(points["xyz"] / size).astype(int), axis=0, return_inverse=True)
        cells = cells.reshape(-1)
        counts = np.bincount(cells, ~hidden)
        for k in range(3):
            sums = np.bincount(cells, ~hidden * points["rgb"][:, k])
            found = hidden & (counts[cells] > 0)
            points["rgb"][found, k] = (sums / np.maximum(counts, 1))[cells[found]]
        hidden &= counts[cells] == 0
        size *= 2


# --- what gets worse; each returns the cases that a severity needs, or None ---

def decode(u8):
    v = np.arange(256) / 255
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)[u8]


def encode(light):
    light = np.clip(light, 0, 1)
    v = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return (255 * v + 0.5).astype(np.uint8)


def photographs(case, level, rng):
    names = case.used()
    kept = max(PHOTOS_LEFT, round(len(names) * (1 - level / 100)))
    if kept > len(names):
        return None
    case.left_out |= {n for at, n in enumerate(names)
                      if not (at + 1) * kept // len(names) > at * kept // len(names)}
    recolor(case)
    return [case]


def vehicle(source, level, rng):
    """Stereo finds what it can of a vehicle, a lamp and two wires before the monument."""
    case = source.get("vehicle", lambda: monument(source.run, ["--vehicle"], "vehicle"))
    case.truth = source.run.work / "vehicle-truth"
    return photographs(case, level, rng)


def fewer_points(case, level, rng):
    kept = rng.random(len(case.points["xyz"])) >= level / 100
    case.points = {key: values[kept] for key, values in case.points.items()}
    return [case]


def move_along_rays(case, points, factor):
    """Moves points on the rays of the photographs that show them best if nothing hid them."""
    best, eyes = np.zeros(len(points["xyz"])), points["xyz"].copy()
    for name in case.used():
        detail, _, _ = detail_in(case.cameras[name], points)
        eyes[detail > best] = case.cameras[name].eye()
        best = np.maximum(best, detail)
    points["xyz"] = eyes + factor[:, None] * (points["xyz"] - eyes)


def depth(case, level, rng):
    points = {**case.points, "xyz": case.points["xyz"].copy()}
    move_along_rays(case, points, np.maximum(0.1, 1 + level / 100 * rng.standard_normal(len(points["xyz"]))))
    case.points = points
    return [case]


def outliers(case, level, rng):
    count = len(case.points["xyz"])
    extra = int(count * level / (100 - level))
    like = rng.integers(count, size=extra)
    more = {key: values[like] for key, values in case.points.items()}
    more["rgb"] = case.points["rgb"][rng.integers(count, size=extra)]
    move_along_rays(case, more, rng.uniform(0.3, 0.95, extra))
    case.points = {key: np.concatenate([values, more[key]]) for key, values in case.points.items()}
    return [case]


def turned(camera, turn, shift):
    angle = np.linalg.norm(turn)
    axis = turn / angle if angle > 0 else turn
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    r = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross  # Rodrigues
    return Camera(camera.name, camera.size, camera.k, r @ camera.r, r @ camera.t + shift)


def pose(case, level, rng):
    """Turns and shifts each camera, by `level` pixels of reprojection."""
    some, distance = case.points["xyz"][::len(case.points["xyz"]) // 400 + 1], case.distance()
    for name in case.used():
        camera = case.cameras[name]
        turn = rng.standard_normal(3) / camera.k[0, 0]
        shift = rng.standard_normal(3) / camera.k[0, 0] * distance
        inside, at, _ = camera.sees(some)
        scale = level
        for _ in range(3):  # the error is nearly linear in its scale
            wrong, _ = turned(camera, scale * turn, scale * shift).project(some)
            found = np.sqrt(np.nanmean(((wrong - at)[inside] ** 2).sum(1))) if inside.any() else 0
            scale *= level / found if found > 0 else 1
        case.cameras[name] = turned(camera, scale * turn, scale * shift)
    return [case]


def focal(case, level, rng):
    for name in case.used():
        case.cameras[name].k[[0, 1], [0, 1]] *= 1 + rng.choice([-1, 1]) * level / 100
    return [case]


def expose(case, level, rng, colors):
    """Exposures evenly spread over `level` stops, in a random order."""
    names, ev = case.used(), {}
    for name, rank in zip(names, rng.permutation(len(names))):
        ev[name] = level * (rank / max(len(names) - 1, 1) - 0.5) * np.array(colors)
        case.photos[name] = encode(decode(case.photos[name]) * 2 ** ev[name])
    return ev


def exposure(case, level, rng):
    expose(case, level, rng, [1, 1, 1])
    recolor(case)
    return [case]


def aligned(case, level, rng):
    """The same, and the scene knows it: gains undo it, but for what is clipped or rounded."""
    case.gains = {name: 2 ** -ev for name, ev in expose(case, level, rng, [1, 1, 1]).items()}
    return [case]


def white_balance(case, level, rng):
    expose(case, level, rng, [0.5, 0, -0.5])
    recolor(case)
    return [case]


def blur(case, level, rng):
    """The camera moves by `level` pixels in another direction in each photograph."""
    for name in case.used():
        light, angle = decode(case.photos[name]), np.pi * rng.random()
        height, width, _ = light.shape
        steps = np.linspace(-0.5, 0.5, int(np.ceil(2 * level)) + 1) * level
        case.photos[name] = encode(sum(
            light[np.clip(np.arange(height) + round(s * np.sin(angle)), 0, height - 1)][
                :, np.clip(np.arange(width) + round(s * np.cos(angle)), 0, width - 1)]
            for s in steps) / len(steps))
    recolor(case)
    return [case]


def noise(case, level, rng):
    for name in case.used():
        noisy = case.photos[name] + level * rng.standard_normal(case.photos[name].shape)
        case.photos[name] = np.clip(noisy + 0.5, 0, 255).astype(np.uint8)
    recolor(case)
    return [case]


def jpeg(case, level, rng):
    for name in case.used():
        file = io.BytesIO()
        Image.fromarray(case.photos[name]).save(file, "JPEG", quality=int(level), subsampling=0)
        with Image.open(file) as picture:
            case.photos[name] = np.asarray(picture)
    return [case]


def passers_by(case, level, rng):
    """Other people stand in each photograph, over `level` percent of its area."""
    for name in case.used():
        height, width, _ = case.photos[name].shape
        picture, covered = Image.fromarray(case.photos[name]), Image.new("1", (width, height))
        for _ in range(1000):
            if np.asarray(covered).mean() >= level / 100:
                break
            tall, x = height * rng.uniform(0.25, 0.6), width * rng.random()
            top = height * rng.uniform(0.3, 0.9) - tall / 2
            head, half = tall / 14, tall / 9
            shirt, trousers, skin = (tuple(int(c) for c in rng.integers(20, 230, 3)) for _ in range(3))
            for image, colors in ((picture, (skin, shirt, trousers)), (covered, (1, 1, 1))):
                pen = ImageDraw.Draw(image)
                pen.ellipse([x - head, top, x + head, top + 2.2 * head], fill=colors[0])
                pen.rectangle([x - half, top + 2.2 * head, x + half, top + tall / 2], fill=colors[1])
                pen.rectangle([x - 0.8 * half, top + tall / 2, x + 0.8 * half, top + tall], fill=colors[2])
        case.photos[name] = np.asarray(picture)
    recolor(case)
    return [case]


def silhouettes(case, level, rng):
    """Each silhouette is `level` pixels too wide or too narrow. The subject stands on black in all
    pictures, as hulls have no surroundings. None: nothing is left of a silhouette."""
    reach = range(-int(level), int(level) + 1)
    for name in sorted(case.cameras):
        mask = case.masks[name]
        case.photos[name] = np.where(mask[..., None] > 0, case.photos[name], 0).astype(np.uint8)
        if name in case.tests:
            continue
        grown = mask if rng.random() < 0.5 else 255 - mask
        padded, wide = np.pad(grown, int(level)), grown
        for dy in reach:
            for dx in reach:
                if dx * dx + dy * dy <= level * level:
                    y, x = int(level) + dy, int(level) + dx
                    wide = np.maximum(wide, padded[y:y + mask.shape[0], x:x + mask.shape[1]])
        case.masks[name] = wide if grown is mask else 255 - wide
        if not case.masks[name].any():
            return None
    case.hull = True
    return [case]


def hull_cameras(case, level, rng):
    names = case.used()
    kept = max(PHOTOS_LEFT, round(len(names) * (1 - level / 100)))
    silhouettes(case, 0, rng)
    case.left_out |= {n for at, n in enumerate(names)
                      if not (at + 1) * kept // len(names) > at * kept // len(names)}
    return [case]


def unsynchronised(source, level, rng):
    """Each camera shows the figure up to `level` time steps before or after the views."""
    case = source.get("steps", lambda: figure(source.run, 2 * STEPS_APART + 1))
    names = case.used()
    for name, rank in zip(names, rng.permutation(len(names))):
        late = round(level * (2 * rank / max(len(names) - 1, 1) - 1))
        case.photos[name], case.masks[name] = case.steps[name][STEPS_APART + late]
    return silhouettes(case, 0, rng)


def backgrounds(source, level, rng):
    """Silhouettes are what differs from pictures of the empty room, in light of up to `level` stops
    more or less."""
    case, folder = source.get("figure", lambda: figure(source.run)), source.run.work / "difference"
    empty = case.copy()
    empty.photos = empty.empty.copy()
    expose(empty, 2 * level, rng, [1, 1, 1])
    shutil.rmtree(folder, ignore_errors=True)
    for kind, pictures in (("images", case.photos), ("background", empty.photos)):
        (folder / kind).mkdir(parents=True)
        for name in case.used():
            Image.fromarray(pictures[name]).save(folder / kind / f"{name}.png")
    report.write_json(folder / "cameras.json", {
        "pixel_centre": 0.5, "cameras": [case.cameras[n].json() for n in case.used()]})
    source.run.needs("import", folder / "cameras.json", "--images", folder / "images", "--background",
                     folder / "background", "--points", "none", "--out", folder / "scene")
    for name in case.used():
        mask = read_picture(folder / "scene" / "masks" / f"{name}.png.png", case.cameras[name].size, "L")
        case.masks[name] = np.where(mask > 0, 255, 0).astype(np.uint8)
    return silhouettes(case, 0, rng)


def angle(case, level, rng):
    """Leaves out the photographs that see a view's target from directions within `level` degrees;
    each view has a case of its own."""
    cases = []
    for view in sorted(case.tests):
        one, target = case.copy(), case.target(view)
        way = lambda name: (case.cameras[name].eye() - target) / np.linalg.norm(
            case.cameras[name].eye() - target)
        near = {n for n in case.used() if way(n) @ way(view) > np.cos(np.radians(level))}
        one.left_out |= near | (case.tests - {view})
        one.tests = {view}
        if len(one.used()) < PHOTOS_FOR_A_VIEW:
            return None
        recolor(one)
        cases.append(one)
    return cases


def moved_views(run, case, factor, zoom):
    """The viewer at `factor` times the distance from what it looks at, on the ground; the truth of
    these views is drawn anew."""
    up, entries, names = np.array([0, 1, 0]), [], sorted(case.tests)
    for name in names:
        camera, target = case.cameras[name], case.target(name)
        eye = camera.eye() + (factor - 1) * (camera.eye() - target) * (1 - up)
        ahead = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(ahead, up) / np.linalg.norm(np.cross(ahead, up))
        r = np.stack([right, np.cross(ahead, right), ahead])
        k = camera.k.copy()
        k[[0, 1], [0, 1]] *= factor if zoom else 1
        case.cameras[name] = Camera(name, camera.size, k, r, -r @ eye)
        entries.append({"img_name": name, "width": camera.size[0], "height": camera.size[1],
                        "position": eye.tolist(), "rotation": r.T.tolist(), "fx": k[0, 0], "fy": k[1, 1]})
    report.write_json(run.work / "views.json", entries)
    drawn = synth(run, run.work / "views", path=run.work / "views.json")
    case.photos.update({n: drawn.photos[d] for n, d in zip(names, sorted(drawn.photos))})
    return [case]


# --- the axes ---

class Axis:
    def __init__(self, title, unit, levels, change=None, needs="", generate=None, make=None, settings=(),
                 own_truth=False):
        self.title, self.unit, self.levels, self.change = title, unit, levels, change
        self.needs, self.generate, self.make = needs, generate, make
        self.settings, self.own_truth = settings, own_truth  # needs: "truth", "masks", "figure" or nothing
        self.on_hull = needs in ("masks", "figure")


def bars_m(run, level):
    return level * BARS_DISTANCE_M / (FOCAL * int(run.options["size"]))


EV = [0, 0.5, 1, 1.5, 2, 3]
AXES = {
    "photographs": Axis("photographs left out (three stay)", "%", [0, 25, 50, 65, 75, 100], photographs),
    "points": Axis("points left out", "%", [0, 50, 80, 90, 97, 99], fewer_points),
    "depth": Axis("noise of depth", "% of the distance", [0, 0.25, 0.5, 1, 2, 5], depth),
    "outliers": Axis("outlier points", "% of the points", [0, 1, 2, 5, 10, 20], outliers),
    "pose": Axis("wrong poses", "px of reprojection", [0, 0.5, 1, 2, 3.5, 5], pose),
    "focal": Axis("wrong focal lengths", "%", [0, 0.3, 0.6, 1, 2, 3], focal),
    "exposure": Axis("exposures apart, not aligned", "EV", EV, exposure),
    "exposure-aligned": Axis("exposures apart, aligned", "EV", EV, aligned, settings=["alignment=on"]),
    "white-balance": Axis("white balances apart, red against blue", "EV", [0, 0.2, 0.4, 0.7, 1, 1.5],
                          white_balance),
    "blur": Axis("motion blur", "px", [0, 1, 2, 3, 5, 8], blur),
    "noise": Axis("noise of the photographs", "of 255", [0, 2, 5, 10, 20, 40], noise),
    "jpeg": Axis("JPEG quality", "", [100, 75, 50, 30, 15, 5], jpeg),
    "gloss": Axis("gloss: share of a mirror's light", "", [0, 0.2, 0.4, 0.6, 0.8, 1], needs="truth",
                  generate=lambda run, level: ["--gloss", level], own_truth=True),
    "bars": Axis("width of bars before the subject", "px", [10, 5, 3, 2, 1, 0.5], needs="truth",
                 generate=lambda run, level: ["--bars", bars_m(run, level)], own_truth=True),
    "plain": Axis("walls without texture, where stereo finds nothing", "% of the walls",
                  [0, 10, 25, 50, 75, 100], needs="truth",
                  generate=lambda run, level: ["--plain", level / 100], own_truth=True),
    "passers-by": Axis("other people in each photograph", "% of the area", [0, 2, 5, 10, 15, 20], passers_by),
    "silhouettes": Axis("wrong silhouettes, methods on their hull", "px", [0, 1, 2, 3, 5, 8], silhouettes,
                        needs="masks", settings=["fill=none"]),
    "hull-cameras": Axis("cameras left out (three stay), methods on their hull", "%",
                         [0, 25, 50, 65, 75, 100], hull_cameras, needs="masks", settings=["fill=none"]),
    "unsynchronised": Axis("cameras out of step, methods on their hull", "time steps",
                           [0, 1, 2, 3, 5, STEPS_APART], make=unsynchronised, needs="figure", settings=["fill=none"]),
    "backgrounds": Axis("other light on the empty place, methods on their hull", "EV",
                        [0, 0.1, 0.2, 0.3, 0.5, 1], make=backgrounds, needs="figure", settings=["fill=none"]),
    "angle": Axis("angle to the nearest photograph used", "degrees", [0, 7, 15, 25, 40, 60], angle),
    "nearer": Axis("the viewer comes nearer", "times the distance", [1, 0.8, 0.65, 0.5, 0.35, 0.25],
                   needs="truth", own_truth=True),
    "farther": Axis("the viewer goes away, the framing kept", "times the distance",
                    [1, 1.3, 1.7, 2.2, 3, 4], needs="truth", own_truth=True),
    "vehicle": Axis("photographs left out (three stay), points by stereo, the pixels of a vehicle, a lamp and wires alone",
                    "%", [0, 25, 50, 65, 75, 100], make=vehicle, needs="truth"),
}


class Source:
    """The unchanged scene, made when a severity first needs it."""

    def __init__(self, run):
        self.run, self.scene, self.cases = run, run.inputs[0], {}
        self.synth = self.scene == "synth"
        if not self.synth:
            self.scene = pathlib.Path(self.scene).resolve()
            if not (self.scene / "scene.json").is_file():
                raise Failure(f"{self.scene}: no scene")
        self.name = "synth" if self.synth else self.scene.name

    def serves(self, axis):
        if axis.needs == "masks" and not self.synth:
            return (self.scene / "masks").is_dir()
        return self.synth or axis.needs not in ("truth", "figure")

    def get(self, kind, make):
        if kind not in self.cases:
            self.cases[kind] = make()
        return self.cases[kind].copy()

    def change(self, name, level):
        """The cases of a severity; None: the scene cannot be made as bad as this."""
        run, axis = self.run, AXES[name]
        rng = np.random.default_rng([int(run.options["seed"]), list(AXES).index(name)])
        if axis.make:
            return axis.make(self, level, rng)
        if axis.generate:
            return [monument(run, axis.generate(run, level))]
        if not self.synth:
            case = self.get("scene", lambda: from_scene(run, self.scene))
        elif axis.needs == "masks":
            case = self.get("figure", lambda: figure(run))
        else:
            case = self.get("monument", lambda: monument(run))
        if axis.change:
            return axis.change(case, level, rng)
        return moved_views(run, case, level, name == "farther") if level != 1 else [case]


# --- rows ---

def settings_of(axis, values):
    """Options of a method on an axis: those of the axis's that it reads; on a hull it stands on that."""
    keys = [s for s in axis.settings if s.split("=")[0] in values]
    if axis.on_hull and values["proxy"] == "splats":
        keys.append("proxy=mesh")
    return tuple(keys)


def figures_of(case, row):
    """What a row says of a case: of whole pictures, or of the vehicle alone."""
    return {key: row["mean"].get(f"vehicle_{key}" if case.truth else key) for key in FIGURES}


def measure_severity(run, source, name, level, methods):
    """Rows of all methods: means over the cases' views. {}: the scene cannot be made as bad."""
    cases, rows = source.change(name, level), {}
    if cases is None:
        return {}
    groups, more = {}, [] if AXES[name].on_hull else report.MORE_METHODS.intersection(run.list_of("method"))
    paired = ["paired"] if "paired" in more else []

    def take(method, case, row):
        row["mean"] = figures_of(case, row)
        rows.setdefault(method, []).append(row)

    for method, values in methods.items():
        if not (AXES[name].on_hull and values["paint"] == "points"):
            groups.setdefault(settings_of(AXES[name], values), []).append(method)
    for case in cases:
        scene, path = case.write(run, run.work / "case"), run.work / "walk.json"
        if scene is None:
            return {}
        report.write_json(path, case.walk())
        walk, truth = ["--path", path], ["--truth", case.truth] if case.truth else []
        for settings, group in groups.items():
            how = [word for s in settings for word in ("--set", s)]
            drawn = run.measure(scene, group + paired, how, truth, walk)
            for found in drawn if drawn is not None else [
                    row for method in group
                    for row in run.measure(scene, [method] + paired, how, truth, walk) or []]:
                take(found["method"] + (ON_ORIEL if found.get("setting") else ""), case, found)
        if "refined" in more and run.call("refine", scene, quiet=True) is not None:
            for found in run.measure(scene, ["oriel"], [], truth, walk) or []:
                take(REFINED, case, found)
    return {method: {"device": found[0]["device"],
                     **{key: mean([f[key] for f in found]) for key in ("flicker", *COSTS)},
                     "mean": {key: mean([f["mean"][key] for f in found]) for key in FIGURES}}
            for method, found in rows.items() if len(found) == len(cases)}


def loss_at(levels, psnr, loss):
    """The severity at which so many dB are lost, linear between severities; None: at none."""
    last = (levels[0], psnr[0])
    for level, value in zip(levels[1:], psnr[1:]):
        if value is None:
            continue
        if value <= psnr[0] - loss:
            return last[0] + (level - last[0]) * (last[1] - psnr[0] + loss) / (last[1] - value)
        last = (level, value)
    return None


def find_losses(axes, methods, rows):
    losses = []
    for axis in axes:
        for method in methods:
            found = {row["level"]: row["mean"]["psnr_db"] for row in rows
                     if row["axis"] == axis["name"] and row["method"] == method}
            psnr = [found.get(level) for level in axis["levels"]]
            if psnr[0] is None:
                continue
            worst = min(value for value in psnr if value is not None)
            losses.append({"axis": axis["name"], "unit": axis["unit"], "method": method,
                           "start_db": psnr[0], "worst_db": worst, "lost_db": psnr[0] - worst,
                           "at": [loss_at(axis["levels"], psnr, loss) for loss in LOSSES_DB]})
    return losses


# --- the report ---

def draw(axis, methods, rows, title, path):
    plot = report.pyplot()
    figure, plots = plot.subplots(1, 3, figsize=(18, 4.5))
    figure.suptitle(title)
    shown = (("PSNR of whole pictures, dB", lambda row: row["mean"]["psnr_db"]),
             ("flicker", lambda row: row["flicker"]), ("milliseconds a frame", lambda row: row["frame_ms"]))
    for one, (label, value) in zip(plots, shown):
        for method in methods:
            found = [row for row in rows if row["axis"] == axis["name"] and row["method"] == method
                     and value(row) is not None]
            one.plot([row["level"] for row in found], [value(row) for row in found], "o-", label=method)
        one.set(xlabel=f"{axis['title']}, {axis['unit']}".rstrip(", "), ylabel=label)
    plots[0].legend(fontsize=7)
    report.save(figure, path)


def write(run, source, axes, methods, rows):
    losses = find_losses(axes, methods, rows)
    parts = []
    head = ["method", "first dB", "worst dB", *(f"-{loss} dB at" for loss in LOSSES_DB)]
    for axis in axes:
        cells = [[loss["method"], fixed(loss["start_db"], 2), fixed(loss["worst_db"], 2),
                  *(fixed(at, 2) for at in loss["at"])] for loss in losses if loss["axis"] == axis["name"]]
        unit = f", {axis['unit']}" if axis["unit"] else ""
        print(f"{head[0]:14}", *(f"{word:>9}" for word in head[1:]), f" ({axis['name']}{unit})")
        for row in cells:
            print(f"{row[0]:14}", *(f"{cell:>9}" for cell in row[1:]))
        print()
        draw(axis, methods, rows, source.name, run.out / f"stress.{axis['name']}.svg")
        parts += [f"<h2>{report.html.escape(axis['title'] + unit)}</h2>",
                  report.picture(f"stress.{axis['name']}.svg", axis["name"]), report.table(head, cells)]
    report.write_json(run.out / "stress.json", {
        "version": 2, "device": rows[0]["device"] if rows else None, "scene": source.name,
        "truth": source.synth, "quick": run.options.get("quick", False), "size": int(run.options["size"]),
        "seed": int(run.options["seed"]), "methods": list(methods), "axes": axes, "rows": rows, "losses": losses})
    report.write_page(run.out / "stress.html", f"Accuracy as one thing gets worse: {source.name}", parts)


def make(run):
    names = run.list_of("axes") or list(AXES)
    for name in names:
        if name not in AXES:
            raise Failure(f"--axes {name}: must be one of {', '.join(AXES)}")
    source, methods = Source(run), run.methods()
    names = [name for name in names if source.serves(AXES[name])]
    if not names:
        raise Failure(f"no axis that is asked for suits {source.name}")
    kept = {key: run.options.get(key) for key in ("quick", "size", "photographs", "views", "seed")}
    kept["scene"] = "synth" if source.synth else report.state_of(source.scene)
    kept["methods"], kept["more"] = methods, sorted(report.MORE_METHODS.intersection(run.list_of("method")))
    axes, rows = [], []
    run.make_folder()
    with tempfile.TemporaryDirectory() as work:
        run.work = pathlib.Path(work)
        for name in names:
            axis = AXES[name]
            levels = [axis.levels[k] for k in (0, 3, 5)] if run.options.get("quick") else axis.levels
            axes.append({"name": name, "title": axis.title, "unit": axis.unit, "levels": levels,
                         "own_truth": axis.own_truth})
            for severity, level in enumerate(levels):
                found = run.kept(source.name, f"{name}-{level:g}", kept,
                                 lambda: measure_severity(run, source, name, level, methods))
                rows += [{"axis": name, "severity": severity, "level": level, "method": method, **row}
                         for method, row in (found or {}).items()]
    if "part" not in run.options:
        if not rows:
            raise Failure("no method could be measured")
        more = sorted({row["method"] for row in rows if row["method"] not in methods})
        write(run, source, axes, [*methods, *more], rows)
    print(f"{run.measured} rows measured, {run.reused} used again, {run.left_out} left out: "
          f"{run.out}/{'rows' if 'part' in run.options else 'stress.html'}")


report.run(make)
