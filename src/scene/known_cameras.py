"""Converts the cameras of other programs to the form of Oriel's cameras.json, for `oriel import`.

python3 known_cameras.py PATH PIXEL_CENTRE OUT reads a file or folder and writes OUT/cameras.json, and
OUT/points.txt where the file has points; the program reads these (known_json.c). PIXEL_CENTRE is the coordinate
of the centre of the first pixel, negative where the user does not state it.

Besides the keys of Oriel's own form, OUT/cameras.json has `format`, `path` (for messages), `found` (the file, which
pictures are relative to), `said` (messages), `error` and `points_file`, and each camera `place` (for messages),
`mask`, `split`, `fisheye`, `thin_prism` and what the file does not state: `no_size`, `no_centre`, `side` and `fov_x`
(struct orl_known_gap). A byte of a text is one character there, since names of files need not be UTF-8. A line of
points.txt is x y z, r g b and the indices of the cameras that see the point.

The program checks sizes, lenses and rotations; a number that is not finite reaches it as one that it refuses.
"""
import csv
import fnmatch
import json
import math
import os
import re
import struct
import sys
from xml.parsers import expat

# A folder that has several is read as the first of them. `oriel import --help` shows this table.
FORMATS = """\
  COLMAP model                                         cameras.bin cameras.txt images.bin images.txt
  Oriel's cameras.json                                 cameras.json
  OpenSfM                                              reconstruction.json opensfm/reconstruction.json
  Inria's cameras.json                                 cameras.json
  transforms.json (nerfstudio, instant-ngp, Blender)   transforms.json
  Blender's set                                        transforms_train.json
  Bundler                                              bundle/bundle.out bundle.out *.out
  LLFF                                                 poses_bounds.npy
  Record3D                                             metadata.json EXR_RGBD/metadata.json
  Polycam                                              keyframes/cameras keyframes/corrected_cameras cameras corrected_cameras
  Middlebury                                           *_par.txt
  Meshroom                                             *.sfm
  VisualSFM                                            *.nvm
  Metashape                                            *.xml
  RealityScan                                          *.csv
"""

FILE_MAX = 256 << 20  # larger files that are read at once are refused
SIDE_MAX = 65536
REFUSED = 1e300  # what a number that is not finite is written as


class Refused(Exception):
    """What ends the import: a result of the program's, and a message."""

    def __init__(self, text, result="ORL_ERR_FORMAT"):
        super().__init__(text)
        self.result = result


# --- what is written ---

def plain(text):
    return os.fsencode(text).decode("latin-1")


class Output:
    def __init__(self, folder):
        self.folder = folder
        self.root = {"pixel_centre": 0.5, "cameras": [], "said": []}
        self.points = None

    def say(self, text, warns=False):
        self.root["said"].append({"warns": warns, "text": plain(text.replace("\0", "?"))})

    def add_point(self, position, colour, seen_by=()):
        """`position` and `colour` as texts of numbers."""
        self.points = self.points or open(os.path.join(self.folder, "points.txt"), "w", encoding="ascii")
        self.points.write(" ".join([*position, *colour, *map(str, seen_by)]) + "\n")

    def write(self):
        if self.points:
            self.points.close()
        with open(os.path.join(self.folder, "cameras.json"), "w", encoding="utf-8") as file:
            json.dump(self.root, file)


def finite(value):
    return value if math.isfinite(value) else REFUSED


class Source:
    """A file of cameras, or the folder of a format of several files."""

    def __init__(self, out, path, stated_centre, custom_centre, root=None):
        self.out, self.path, self.stated_centre, self.root = out, path, stated_centre, root
        self.folder = os.path.dirname(path) or "."
        told = number(get(root, "pixel_centre"))
        centre = stated_centre if stated_centre >= 0 else custom_centre if told is None else told
        if not 0 <= centre <= 0.5:
            raise Refused(f'{path}: "pixel_centre" is not from 0 to 0.5')
        self.shift = 0.5 - centre  # from the file's pixel coordinates to those that are written

    def bad(self, place, what):
        return Refused(f"{self.path}: {place}: {what}")

    def add(self, place, path, lens, pose, size=None, **more):
        """Writes a camera. lens: fx fy cx cy and OpenCV's distortion; pose: rows of R, t; size: None: not stated."""
        if "\0" in path or "\0" in (more.get("mask") or ""):
            raise self.bad(place.replace("\0", "?"), "a name of a file has a zero byte")
        fx, fy, cx, cy, *terms = map(finite, lens)
        camera = {"name": plain(path), "place": plain(place), "K": [[fx, 0, cx], [0, fy, cy], [0, 0, 1]],
                  "R": [list(map(finite, row)) for row in pose[0]], "t": list(map(finite, pose[1])), "dist": terms}
        if size:
            camera["width"], camera["height"] = size
        else:
            camera["no_size"] = True
        camera.update({key: plain(value) if isinstance(value, str) else value
                       for key, value in more.items() if value})
        self.out.root["cameras"].append(camera)

    def say_unused(self, objects, used):
        """Names, in one line, the keys of objects that Oriel does not use."""
        most, names = 20, []
        for entry in objects:
            for key in entry if isinstance(entry, dict) else ():
                if key not in used and key not in names and len(names) < most:
                    names.append(key)
        if names:
            self.out.say(f"{self.path}: not used: " + ", ".join(name[:64] for name in sorted(names))[:511])


# --- values in JSON ---

def get(entry, key):
    return entry.get(key) if isinstance(entry, dict) else None


def number(value):
    """A finite number; None: it is something else."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        value = float(value)
    except OverflowError:
        return None
    return value if math.isfinite(value) else None


def loose_number(value):
    """The same, which may be written as a string."""
    try:
        return number(real(value.encode()) if isinstance(value, str) else value)
    except ValueError:
        return None


def numbers(value, count, read=number):
    found = [read(item) for item in value] if isinstance(value, list) and len(value) == count else [None]
    return None if None in found else found


def rows_of(value, rows, columns):
    found = [numbers(row, columns) for row in value] if isinstance(value, list) and len(value) == rows else [None]
    return None if None in found else found


def text(entry, key):
    value = get(entry, key)
    return value if isinstance(value, str) else None


def entries(value):
    """Of a list, or of an object whose keys are names."""
    return value if isinstance(value, list) else list(value.values()) if isinstance(value, dict) else []


def side(value):
    """A picture's width or height; 0: it is none."""
    return value if type(value) is int and 1 <= value <= SIDE_MAX else 0


# --- files ---

def read_bytes(path, size_max=FILE_MAX):
    if not os.path.isfile(path):
        raise Refused(f"{path}: no such file, or not a regular one", "ORL_ERR_IO")
    size = os.path.getsize(path)
    if size > size_max:
        raise Refused(f"{path}: {size} bytes, more than the {size_max} expected")
    with open(path, "rb") as file:
        return file.read()


def refuse_utf16(path, data):
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise Refused(f"{path}: is UTF-16: save it as UTF-8")


def unique(pairs):
    entry = dict(pairs)
    if len(entry) < len(pairs):
        raise ValueError("an object has a key twice")
    return entry


def no_constant(name):
    raise ValueError(f"{name} is not a number of JSON")


def read_json(path, size_max=FILE_MAX):
    data = read_bytes(path, size_max)
    refuse_utf16(path, data)
    try:
        return json.loads(data.decode("utf-8-sig"), object_pairs_hook=unique, parse_constant=no_constant)
    except UnicodeDecodeError as error:
        line, at, why = data.count(b"\n", 0, error.start) + 1, error.start, "not UTF-8"
    except json.JSONDecodeError as error:
        line, at, why = error.lineno, len(error.doc[:error.pos].encode()), error.msg
    except (ValueError, RecursionError) as error:
        raise Refused(f"{path}: {error}") from None
    raise Refused(f"{path}: line {line} (byte {at}): {why}")


def read_json_object(path):
    root = read_json(path, 64 << 20)
    if not isinstance(root, dict):
        raise Refused(f"{path}: byte 0: not a JSON object")
    return root


def real(word):
    if b"_" in word:  # of Python alone
        raise ValueError("not a number")
    return float(word)


def whole(word, most):
    if not word.isdigit() or len(word) > 20 or int(word) > most:
        raise ValueError("not a number from 0")
    return int(word)


class Lines:
    """A file of text with a record a line. '#' begins a comment."""

    def __init__(self, path):
        self.path, self.number, self.start, self.next_start, self.line = path, 0, 0, 0, b""
        if not os.path.isfile(path):
            raise Refused(f"{path}: no such file, or not a regular one", "ORL_ERR_IO")
        self.size = os.path.getsize(path)
        self.file = open(path, "rb")
        head = self.file.read(3)
        refuse_utf16(path, head)
        self.next_start = 3 if head == b"\xef\xbb\xbf" else 0
        self.file.seek(self.next_start)

    def bad(self, what, word=0):
        """`word`: index of the word of the line that is wrong."""
        starts = [match.start() for match in re.finditer(rb"\S+", self.line)]
        at = self.start + (starts[word] if word < len(starts) else len(self.line))
        return Refused(f"{self.path}: line {self.number} (byte {at}): {what}")

    def next_raw(self):
        """The next line, which may be empty. False: there is none."""
        line = self.file.readline()
        if not line:
            return False
        self.start, self.next_start = self.next_start, self.next_start + len(line)
        self.line = line.rstrip(b"\r\n \t")
        self.number += 1
        return True

    def next(self):
        while self.next_raw():
            if not self.line.lstrip(b" \t").startswith((b"#",)) and self.line:
                return True
        return False

    def words(self, count, what, first=0, exactly=False):
        """`count` numbers of the current line as texts."""
        found = self.line.split()
        for i in range(first, first + count):
            try:
                real(found[i])
            except (IndexError, ValueError):
                raise self.bad(what, i) from None
        if exactly and len(found) != first + count:
            raise self.bad(what, first + count)
        return [word.decode("ascii") for word in found[first:first + count]]

    def numbers(self, count, what, first=0, exactly=False):
        return [float(word) for word in self.words(count, what, first, exactly)]

    def next_words(self, count, what):
        if not self.next():
            raise self.bad(what)
        return self.words(count, what, exactly=True)

    def wholes(self, limits, what, exactly=False):
        """Numbers from 0 to each limit at the beginning of the current line."""
        found = self.line.split()
        if exactly and len(found) > len(limits):
            raise self.bad(what, len(limits))
        for i, most in enumerate(limits):
            try:
                found[i] = whole(found[i], most)
            except (IndexError, ValueError):
                raise self.bad(what, i) from None
        return found[:len(limits)]

    def views(self, first, camera_count):
        """The rest of a point's line from word `first`: their number; of each its camera, the feature, x and y."""
        found, what = self.line.split(), "a view needs a camera that is there, a feature, x and y"
        try:
            count = whole(found[first], 0xffffffff)
        except (IndexError, ValueError):
            raise self.bad("a point needs the number of its views", first) from None
        first += 1
        if len(found) < first + 4 * count:
            raise self.bad(what, len(found))
        for at in range(first, first + 4 * count, 4):
            try:
                if whole(found[at], 0xffffffff) >= camera_count:
                    raise ValueError("no such camera")
                whole(found[at + 1], 0xffffffff)
                real(found[at + 2]), real(found[at + 3])
            except ValueError:
                raise self.bad(what, at) from None
        return [int(word) for word in found[first:first + 4 * count:4]]


# --- poses: cam_from_world as the rows of R, and t ---

def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def from_axes(axes, centre):
    """Of the rows of world_from_cam and the camera's place. None: it is no pose."""
    r = [[axes[j][i] for j in range(3)] for i in range(3)]
    t = [-dot(row, centre) for row in r]
    straight = all(abs(dot(r[i], r[j]) - (i == j)) <= 1e-3 for i in range(3) for j in range(3))
    across = [r[0][1] * r[1][2] - r[0][2] * r[1][1], r[0][2] * r[1][0] - r[0][0] * r[1][2],
              r[0][0] * r[1][1] - r[0][1] * r[1][0]]
    return (r, t) if straight and dot(across, r[2]) > 0 and all(abs(x) <= 1e18 for x in t) else None


def from_opengl(rows):
    """Of rows of 4 of world_from_cam with OpenGL's axes: y up, z backward."""
    return from_axes([[row[0], -row[1], -row[2]] for row in rows[:3]], [row[3] for row in rows[:3]])


def from_quat(w, x, y, z):
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    if not math.isfinite(norm) or norm < 1e-12:
        return None
    w, x, y, z = w / norm, x / norm, y / norm, z / norm
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


# --- Inria's cameras.json ---

def camera_place(index, name):
    return f"camera {index}" + (f" ({name[:120]})" if name is not None else "")


def read_inria(source):
    used = {"id", "img_name", "width", "height", "position", "rotation", "fx", "fy"}
    for index, item in enumerate(source.root):
        name = text(item, "img_name")
        place = camera_place(index, name)
        if name is None:
            raise Refused(f'{source.path}: {place} has no "img_name"')
        size = side(get(item, "width")), side(get(item, "height"))
        axes, centre = rows_of(get(item, "rotation"), 3, 3), numbers(get(item, "position"), 3)
        fx, fy = number(get(item, "fx")), number(get(item, "fy"))
        pose = from_axes(axes, centre) if axes and centre else None
        focals = [1e-3 * max(size) <= f <= 1e5 * max(size) for f in (fx, fy) if f is not None]
        if not pose or not all(size) or focals != [True, True]:
            raise source.bad(place, "position, rotation, width, height, fx or fy is missing or not usable")
        source.add(place, name, (fx, fy, 0.5 * size[0], 0.5 * size[1]), pose, size)
    source.say_unused(source.root, used)


# --- nerfstudio's transforms.json ---

BROWN = ("OPENCV", "SIMPLE_RADIAL", "RADIAL", "PINHOLE", "SIMPLE_PINHOLE", "PERSPECTIVE")


def is_true(value):
    return value is True or bool(number(value)) or (isinstance(value, str) and value.lower() == "true")


class Frame:
    """A frame, whose values may be those of the whole file."""

    def __init__(self, root, frame):
        self.root, self.frame = root, frame

    def find(self, key):
        return self.frame[key] if key in self.frame else get(self.root, key)

    def number(self, key):
        return number(self.find(key))

    def all(self, keys):
        found = [self.number(key) for key in keys]
        return None if None in found else found


def nerfstudio_lens(source, place, frame):
    """Whether it is a fisheye. instant-ngp's scripts write "is_fisheye" instead of a model."""
    model = text(frame.frame, "camera_model") or text(frame.root, "camera_model") or "OPENCV"
    upper = model.upper()
    fisheye = upper == "OPENCV_FISHEYE" or (upper == "OPENCV" and is_true(frame.find("is_fisheye")))
    if not fisheye and upper not in BROWN:
        raise source.bad(place, f"its camera_model, {model[:60]}, is not read: Oriel reads PINHOLE, OPENCV, RADIAL and "
                                "OPENCV_FISHEYE; panoramas must be cut into flat views")
    for key in ("latlong", "equirectangular", "orthographic", "ftheta_p0"):  # instant-ngp's, whatever their value
        if frame.find(key) is not None:
            raise source.bad(place, f"its lens, {key}, is not read: panoramas must be cut into flat views")
    for key in ("p1", "p2") if fisheye else ("k4",):
        if frame.number(key):
            raise source.bad(place, f"{key} of its lens is not read: undistort the pictures with the program that "
                                    "calibrated them")
    return fisheye


def nerfstudio_pose(source, place, matrix):
    # Some programs leave out the last row, which is always 0 0 0 1.
    rows = rows_of(matrix, 3 if isinstance(matrix, list) and len(matrix) == 3 else 4, 4)
    pose = from_opengl(rows) if rows else None
    if not pose:
        raise source.bad(place, '"transform_matrix" is not 4 rows of 4 numbers with a rotation')
    if len(rows) == 4 and rows[3] != [0, 0, 0, 1]:
        raise source.bad(place, 'the last row of "transform_matrix" is not 0 0 0 1')
    return pose


def add_nerfstudio(source, place, path, entry, split):
    frame, more = Frame(source.root, entry), {}
    pose = nerfstudio_pose(source, place, get(entry, "transform_matrix"))
    # nerfstudio's reader prefers the terms in a list to those of their own names.
    listed = frame.find("distortion_params")
    terms = numbers(listed, 6)
    if terms:
        frame.frame = {**entry, **dict(zip(("k1", "k2", "k3", "k4", "p1", "p2"), terms))}
    fisheye = nerfstudio_lens(source, place, frame)
    if listed is not None and not terms:
        raise source.bad(place, '"distortion_params" is not k1 k2 k3 k4 p1 p2')
    stated = frame.all(("w", "h"))
    size = [int(x) if 1 <= x <= SIDE_MAX else 0 for x in stated] if stated else None
    fx, fy, angle = frame.number("fl_x"), frame.number("fl_y"), frame.number("camera_angle_x")
    if fx is None and angle is None:
        raise source.bad(place, "neither fl_x nor camera_angle_x")
    if fx is None:
        fx, fy, more["fov_x"] = 0, 0, angle
        if not angle > 0:
            raise source.bad(place, "the focal length is absurd")
    centre = frame.all(("cx", "cy"))
    more["no_centre"] = centre is None
    lens = [fx, fx if fy is None else fy, *([x + source.shift for x in centre] if centre else (0, 0))]
    lens += [frame.number(key) or 0 for key in (("k1", "k2", "k3", "k4") if fisheye else ("k1", "k2", "p1", "p2", "k3"))]
    source.add(place, path, lens, pose, size, fisheye=fisheye, mask=text(entry, "mask_path"), split=split, **more)


def same_picture(a, b):
    """True when one of two paths ends with the other, whatever separates their parts and whether or not either has
    an extension."""
    a, b = ([part for part in re.split(r"[/\\]", path)] for path in (a, b))
    if not ("." in a[-1] and "." in b[-1]):
        a[-1], b[-1] = (name[-1].rpartition(".")[0] if "." in name[-1] else name[-1] for name in (a, b))
    a, b = sorted(([part for part in parts if part] or [""] for parts in (a, b)), key=len)
    return b[-len(a):] == a


def stem(path):
    """What all paths of the same picture have in common."""
    name = re.split(r"[/\\]", path)[-1]
    return name.rpartition(".")[0] if "." in name else name


class Lists:
    """The lists of photographs that a file has, by their stems: comparing each frame with each name takes minutes where
    they are thousands."""

    def __init__(self, root):
        self.root, self.by_stem = root, {}
        for key in ("train_filenames", "val_filenames", "test_filenames"):
            names = get(root, key)
            for name in names if isinstance(names, list) else ():
                if isinstance(name, str) and name.removeprefix("./"):
                    self.by_stem.setdefault((key, stem(name)), []).append(name.removeprefix("./"))

    def name(self, key, path):
        return any(same_picture(name, path.removeprefix("./")) for name in self.by_stem.get((key, stem(path)), ()))

    def split(self, path):
        """Where the file has lists of photographs, those on none of them are not used. Photographs for validation are
        held out where there are none for testing."""
        if self.name("test_filenames", path) or (
                not entries(get(self.root, "test_filenames")) and self.name("val_filenames", path)):
            return "test"
        return "train" if "train_filenames" not in self.root or self.name("train_filenames", path) else "unused"


def read_frames(source, split=None):
    """`split`: of all frames; None: as the file says."""
    used = {"frames", "file_path", "transform_matrix", "mask_path", "camera_model", "w", "h", "fl_x", "fl_y", "cx", "cy",
            "k1", "k2", "k3", "k4", "p1", "p2", "camera_angle_x", "camera_angle_y", "is_fisheye", "train_filenames",
            "val_filenames", "test_filenames", "ply_file_path", "distortion_params"}
    root, splits, lists = source.root, set(), Lists(source.root)
    frames = entries(get(root, "frames"))
    for index, entry in enumerate(frames):
        path = text(entry, "file_path")
        place = camera_place(index, path)
        if path is None:
            raise source.bad(place, 'no "file_path"')
        of = split or lists.split(path)
        splits.add(of)
        add_nerfstudio(source, place, path, entry, of)
    source.say_unused([root, *frames], used)
    if not split and "test" not in splits and entries(get(root, "test_filenames")):
        source.out.say(f"{source.path}: test_filenames has none of the frames: none is held out", warns=True)
    if not split and splits == {"unused"}:
        raise Refused(f"{source.path}: train_filenames has none of the frames", "ORL_ERR_DATA")


def read_transforms(source):
    read_frames(source)
    cloud = text(source.root, "ply_file_path")
    if cloud:
        source.out.root["points_file"] = plain(cloud)


def read_splits(source):
    """Blender's sets: a folder with a transforms.json for each split."""
    tests = False
    for name, split in (("train", "train"), ("test", "test"), ("val", None)):
        path = os.path.join(source.path, f"transforms_{name}.json")
        if os.path.isfile(path):
            part = Source(source.out, path, source.stated_centre, 0.5, read_json_object(path))
            # Photographs for validation are held out where there are none for testing.
            split = split or ("unused" if tests else "test")
            read_frames(part, split)
            tests = tests or split == "test"


# --- telephones: OpenGL's axes, the telephone's world, y up ---

POLYCAM = (("keyframes/corrected_cameras", "keyframes/corrected_images"), ("keyframes/cameras", "keyframes/images"),
           ("corrected_cameras", "corrected_images"), ("cameras", "images"))


def list_dir(path):
    return sorted(os.listdir(path), key=os.fsencode)


def read_polycam(source):
    """cameras/TIME.json beside images/TIME.jpg; the corrected ones, where Polycam has closed loops."""
    cells = [f"t_{i}{j}" for i in range(3) for j in range(4)]
    keys, roots = ["fx", "fy", "cx", "cy", *cells], []
    for cameras, images in POLYCAM:
        folder = os.path.join(source.path, cameras)
        if os.path.isdir(folder):
            break
    for name in list_dir(folder):
        if name.startswith(".") or not name.endswith(".json"):
            continue
        root = read_json_object(os.path.join(folder, name))
        values = [loose_number(get(root, key)) for key in keys]
        pose = None if None in values else from_opengl([values[4:8], values[8:12], values[12:16]])
        if not pose:
            raise source.bad(name, "fx, fy, cx, cy or the rows t_00 to t_23 are missing or not a pose")
        lens = [*values[:2], values[2] + source.shift, values[3] + source.shift]
        source.add(name, f"{images}/{name[:-5]}", lens, pose, (side(get(root, "width")), side(get(root, "height"))))
        roots.append(dict.fromkeys(root))
    source.say_unused(roots, {*keys, "width", "height"})


def read_record3d(source):
    """"poses" of qx qy qz qw tx ty tz, and K column by column."""
    used = {"poses", "K", "w", "h", "perFrameIntrinsicCoeffs"}
    root = source.root
    # The folder of one or the other kind of export.
    folder = "rgb" if os.path.isdir(os.path.join(source.folder, "rgb")) else "rgbd"
    k, lenses = numbers(root["K"], 9), entries(get(root, "perFrameIntrinsicCoeffs"))
    if not k:
        raise source.bad("K", "not 9 numbers")
    for i, entry in enumerate(root["poses"]):
        v = numbers(entry, 7)
        turn = from_quat(v[3], *v[:3]) if v else None
        if not turn:
            raise source.bad(f"pose {i}", "not a quaternion and a position")
        pose = from_opengl([[*turn[r], v[4 + r]] for r in range(3)])
        if not pose:
            raise source.bad(f"pose {i}", "not a pose")
        # fx fy cx cy of each frame, where the telephone focuses anew.
        own = numbers(lenses[i], 4) if i < len(lenses) else None
        fx, fy, cx, cy = own or (k[0], k[4], k[6], k[7])
        source.add(f"pose {i}", f"{folder}/{i}", (fx, fy, cx + source.shift, cy + source.shift), pose,
                   (side(get(root, "w")), side(get(root, "h"))))
    source.say_unused([root], used)


# --- LLFF's poses_bounds.npy (Mildenhall et al. 2019, "Local light field fusion") ---

def npy_rows(source):
    """NumPy's array of 17 64-bit numbers a row (format 1.0 to 3.0)."""
    data = read_bytes(source.path)
    if len(data) < 12 or data[:6] != b"\x93NUMPY" or not 1 <= data[6] <= 3:
        raise Refused(f"{source.path}: not NumPy's array")
    start, form = (10, "<H") if data[6] == 1 else (12, "<I")
    length = struct.unpack_from(form, data, 8)[0]
    if length >= 512 or length > len(data) - start:
        raise Refused(f"{source.path}: NumPy's header is too long")
    header = data[start:start + length]
    if not re.search(rb"'descr' *: *'<f8'", header) or not re.search(rb"'fortran_order' *: *False", header):
        raise Refused(f"{source.path}: not 64-bit numbers, row by row")
    shape = re.search(rb"'shape' *: *\((\d{1,6}), 17\)", header)
    count = int(shape[1]) if shape else 0
    if not 0 < count <= 100000:
        raise Refused(f"{source.path}: not 17 numbers for each picture")
    if count * 17 * 8 != len(data) - start - length:
        raise Refused(f"{source.path}: not as many numbers as its header says")
    return list(struct.iter_unpack("<17d", data[start + length:]))


def read_llff(source):
    """17 numbers a picture, in the order of the pictures' names: 3 rows of 5, which are the camera's axes (down, right,
    backwards), its place, and height, width, focal length; then the nearest and farthest depth."""
    rows, folder = npy_rows(source), os.path.join(source.folder, "images")
    if not os.path.isdir(folder):
        raise Refused(f"{source.path}: its pictures must be in {folder}, since it does not name them", "ORL_ERR_NOT_FOUND")
    names = [name for name in list_dir(folder) if not name.startswith(".") and name != "Thumbs.db"]
    if len(names) != len(rows):
        raise Refused(f"{source.path}: {len(rows)} cameras, but images/ has {len(names)} files", "ORL_ERR_DATA")
    for n, name in zip(rows, names):
        height, width, focal = n[4], n[9], n[14]
        axes = [[n[5 * i + 1], n[5 * i], -n[5 * i + 2]] for i in range(3)]  # right, down, forward
        pose = from_axes(axes, [n[3], n[8], n[13]])
        if not pose or not (1 <= width <= SIDE_MAX and 1 <= height <= SIDE_MAX):
            raise Refused(f"{source.path}: picture images/{name}: no size, or its pose is not a rotation and a place")
        size = int(width), int(height)
        source.add(f"images/{name}", f"images/{name}", (focal, focal, 0.5 * size[0], 0.5 * size[1]), pose, size)


# --- OpenSfM: lengths are in units of the picture's larger side, measured from its centre ---

def opensfm_lens(camera):
    """fx fy cx cy and distortion, the size, whether it is a fisheye. None: its projection is not read."""
    def term(key):
        return loose_number(get(camera, key)) or 0

    kind = text(camera, "projection_type")
    fisheye = kind in ("fisheye", "fisheye_opencv")
    if not fisheye and kind not in ("perspective", "brown", "simple_radial", "radial"):
        return None
    width, height = side(get(camera, "width")), side(get(camera, "height"))
    larger, one = max(width, height), loose_number(get(camera, "focal"))
    lens = [larger * (term("focal_x") if one is None else one), larger * (term("focal_y") if one is None else one),
            0.5 * width + larger * term("c_x"), 0.5 * height + larger * term("c_y")]
    terms = {"fisheye": ("k1", "k2"), "fisheye_opencv": ("k1", "k2", "k3", "k4")}
    lens += [term(key) for key in terms.get(kind, ("k1", "k2", "p1", "p2", "k3"))]
    return lens, (width, height), fisheye


def rotation_about(v):
    """Rodrigues' formula: a rotation by |v| about v."""
    angle = math.sqrt(dot(v, v))
    if not math.isfinite(angle):
        return [[math.nan] * 3] * 3
    s = math.sin(angle) / angle if angle > 1e-12 else 1
    c = (1 - math.cos(angle)) / (angle * angle) if angle > 1e-12 else 0.5
    cross = [[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]]
    square = [[sum(cross[i][k] * cross[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return [[(i == j) + s * cross[i][j] + c * square[i][j] for j in range(3)] for i in range(3)]


def add_shot(source, cameras, name, shot):
    key = text(shot, "camera")
    camera = get(cameras, key)
    if camera is None:
        raise source.bad(f"shot {name[:120]}", "its camera is not there")
    found = opensfm_lens(camera)
    if not found:
        raise source.bad(f"camera {key[:120]}", "its projection_type is none of perspective, brown, simple_radial, "
                                                "radial, fisheye and fisheye_opencv")
    axis, t = numbers(get(shot, "rotation"), 3), numbers(get(shot, "translation"), 3)
    if not axis or not t:
        raise source.bad(f"shot {name[:120]}", "rotation or translation is not 3 numbers")
    lens, size, fisheye = found
    source.add(name, name, lens, (rotation_about(axis), t), size, fisheye=fisheye)


def read_opensfm(source):
    used = {"cameras", "shots", "points", "projection_type", "width", "height", "focal", "focal_x", "focal_y", "c_x",
            "c_y", "k1", "k2", "k3", "k4", "p1", "p2", "camera", "rotation", "translation"}
    best = max(source.root, key=lambda part: len(get(part, "shots") if isinstance(get(part, "shots"), dict) else ()))
    shots, cameras, points = best["shots"], get(best, "cameras"), get(best, "points")
    if len(source.root) > 1:
        source.out.say(f"{source.path}: {len(source.root)} reconstructions; taking the largest, with "
                                  f"{len(shots)} photographs", warns=True)
    for name, shot in shots.items():
        add_shot(source, cameras, name, shot)
    source.say_unused([best, *entries(cameras), *shots.values()], used)
    for key, point in points.items() if isinstance(points, dict) else ():
        at = numbers(get(point, "coordinates"), 3)
        if not at:
            raise source.bad(f"point {key[:120]}", "its coordinates are not 3 numbers")
        source.out.add_point(map(repr, at), map(repr, numbers(get(point, "color"), 3) or (128, 128, 128)))


# --- Meshroom ---

# Of each distortion, the places of its terms among k1 k2 p1 p2 k3, or k1 k2 k3 k4 of a fisheye.
MESHROOM = {"pinhole": (), "none": (), "radial1": (0,), "radialk1": (0,), "radial3": (0, 1, 4), "radialk3": (0, 1, 4),
            "brown": (0, 1, 4, 2, 3), "fisheye": (0, 1, 2, 3), "fisheye4": (0, 1, 2, 3)}


def id_text(entry, key):
    """An id, which some versions write as a number."""
    value = get(entry, key)
    return value if isinstance(value, str) else str(value) if type(value) is int else ""


def meshroom_pinhole(root, lens):
    """fx fy cx cy and the size, from the versions' different fields: a focal length in pixels up to 1.2.0, for x and y
    from 1.2.0, in millimetres of the sensor later. The principal point counts from the picture's corner before 1.2.1,
    and from its centre since. Or the problem, a text."""
    width, height = loose_number(get(lens, "width")), loose_number(get(lens, "height"))
    if width is None or height is None or not (1 <= width <= SIDE_MAX and 1 <= height <= SIDE_MAX):
        return "its size is missing"
    both, one = numbers(get(lens, "pxFocalLength"), 2, loose_number), loose_number(get(lens, "pxFocalLength"))
    focal, sensor = loose_number(get(lens, "focalLength")), loose_number(get(lens, "sensorWidth"))
    major, minor, revision = numbers(get(root, "version"), 3, loose_number) or (0, 0, 0)
    version = major * 1e6 + minor * 1e3 + revision
    if both or one is not None:
        fx, fy = both or (one, one)
    elif focal is not None and sensor is not None and sensor > 0:
        told = loose_number(get(lens, "pixelRatio"))
        ratio = told if told is not None and told > 0 else 1
        # A pixel's width by its height, thus fy / fx; before 1.2.5 the inverse. Since 1.2.11 the focal length is fy.
        fx = focal / sensor * width / (ratio if version >= 1002011 else 1)
        fy = fx / ratio if version < 1002005 else fx * ratio
    else:
        return "its focal length is missing"
    of_centre = version >= 1002001
    told = numbers(get(lens, "principalPoint"), 2, loose_number)
    centre = 0.5 * width, 0.5 * height
    if told:
        centre = (centre[0] + told[0], centre[1] + told[1]) if of_centre else told
    return (fx, fy, *centre), (int(width), int(height))


def meshroom_lens(root, lens):
    """fx fy cx cy and distortion, the size, whether it is a fisheye; or the problem, a text."""
    found = meshroom_pinhole(root, lens)
    if isinstance(found, str):
        return found
    # Since 1.2.8 "type" is the projection alone, and matchmovers' distortions stand under "undistortionType".
    projection, kind = text(lens, "type"), text(lens, "distortionType")
    kind = projection if kind is None else kind
    if kind not in MESHROOM or projection not in (None, *MESHROOM) or (
            kind == "none" and text(lens, "undistortionType") not in (None, "none")):
        return "its type is none of pinhole, radial1, radial3, brown and fisheye4"
    stated, places, terms = get(lens, "distortionParams"), MESHROOM[kind], [0] * 5
    if places and isinstance(stated, list) and stated:
        given = numbers(stated, len(places), loose_number)
        if not given:
            return "its distortionParams are not as many numbers as its type has"
        for place, term in zip(places, given):
            terms[place] = term
    return [*found[0], *terms], found[1], kind.startswith("fisheye")


def add_meshroom_view(source, view, lenses, poses):
    """False: it has no pose."""
    key, pose_key, lens_key = (id_text(view, name) for name in ("viewId", "poseId", "intrinsicId"))
    if pose_key not in poses or lens_key not in lenses:
        return False
    lens, path = meshroom_lens(source.root, lenses[lens_key]), text(view, "path")
    if isinstance(lens, str):
        raise source.bad(f"intrinsic {lens_key[:120]}", lens)
    if path is None:
        raise source.bad(f"view {key[:120]}", "no path")
    if "subPoseId" in view:
        raise source.bad(f"view {key[:120]}", "rigs of cameras are not supported")
    transform = get(get(poses[pose_key], "pose"), "transform")
    cells = numbers(get(transform, "rotation"), 9, loose_number)
    centre = numbers(get(transform, "center"), 3, loose_number)
    # The rotation cam_from_world is written column by column: its rows are those of the inverse.
    pose = from_axes([cells[:3], cells[3:6], cells[6:]], centre) if cells and centre else None
    if not pose:
        raise source.bad(f"pose {pose_key[:120]}", "no rotation and center")
    source.add(key, path, lens[0], pose, lens[1], fisheye=lens[2])
    return True


def read_meshroom(source):
    used = {"version", "views", "intrinsics", "poses", "structure", "viewId", "poseId", "intrinsicId", "subPoseId", "path",
            "width", "height", "pose", "type", "distortionType", "distortionParams", "pxFocalLength", "focalLength",
            "undistortionType", "sensorWidth", "pixelRatio", "principalPoint"}
    views, lenses, poses = (entries(get(source.root, key)) for key in ("views", "intrinsics", "poses"))
    lens_of = {id_text(lens, "intrinsicId"): lens for lens in lenses}
    pose_of = {id_text(pose, "poseId"): pose for pose in poses}
    added = [view for view in views if add_meshroom_view(source, view, lens_of, pose_of)]
    image_of = {id_text(view, "viewId"): i for i, view in enumerate(added)}
    if len(added) < len(views):
        source.out.say(f"{source.path}: {len(views) - len(added)} of {len(views)} photographs have no pose: "
                                  "left out", warns=True)
    source.say_unused([source.root, *views, *lenses, *poses], used)
    for landmark in entries(get(source.root, "structure")):
        at = numbers(get(landmark, "X"), 3, loose_number)
        if not at:
            raise source.bad("landmark ", "no X of 3 numbers")
        seen = [id_text(view, "observationId") for view in entries(get(landmark, "observations"))]
        source.out.add_point(map(repr, at), map(repr, numbers(get(landmark, "color"), 3, loose_number) or (128, 128, 128)),
                             [image_of[key] for key in seen if key in image_of])


# --- Middlebury: a count, then lines NAME K R t, row by row ---

def read_middlebury(source):
    lines, what = Lines(source.path), "the first line is not the number of cameras"
    if not lines.next():
        raise lines.bad(what)
    count, done = lines.wholes([1000000], what, exactly=True)[0], 0
    while done < count and lines.next():
        name = lines.line.split()[0]
        k, r, t = (values[a:b] for values in [lines.numbers(21, "a camera needs a name and 21 numbers: K, R and t", 1)]
                   for a, b in ((0, 9), (9, 18), (18, 21)))
        if k[1] != 0:
            raise lines.bad("its K has a skew, which is not supported")
        source.add(f"line {lines.number}", os.fsdecode(name), (k[0], k[4], k[2] + source.shift, k[5] + source.shift),
                   ([r[:3], r[3:6], r[6:]], t))
        done += 1
    if done < count:
        raise Refused(f"{source.path}: line {lines.number}: the file ends after {done} cameras of {count}")


# --- Bundler (bundle.out v0.3): cameras f k1 k2, R, t with OpenGL's axes; points ---

def bundler_pictures(folder, base):
    """The list of pictures, one a line, of the file `base`. Names may have spaces: Bundler writes " 0 FOCAL" after them,
    or nothing; other programs separate them by tabs."""
    # COLMAP writes NAME.bundle.out and NAME.list.txt; the last is RealityCapture's.
    known = (base.removesuffix(".out").removesuffix(".bundle") + ".list.txt", "list.txt", "bundle/list.txt",
             "../list.txt", "imagelist.lst")
    path = next((path for path in (os.path.join(folder, name) for name in known) if os.path.isfile(path)), None)
    if not path:
        raise Refused(f"{folder}: Bundler's cameras need list.txt, the names of their pictures, beside them",
                      "ORL_ERR_NOT_FOUND")
    lines, names = Lines(path), []
    while lines.next():
        line = lines.line.lstrip(b" \t").replace(b"\t", b" ")
        head, _, focal = line.rpartition(b" ")
        try:
            stated = head.endswith(b" 0") and real(focal) >= 0
        except ValueError:
            stated = False
        names.append(os.fsdecode(head[:-2] if stated else line))
    return names


def add_bundler_camera(source, lines, index, name):
    """False: the camera was not registered."""
    f, k1, k2 = map(float, lines.next_words(3, "a camera needs f k1 k2"))
    place = f"line {lines.number}: camera {index}"
    r = [list(map(float, lines.next_words(3, "a row of R needs 3 numbers"))) for _ in range(3)]
    t = list(map(float, lines.next_words(3, "t needs 3 numbers")))
    if f == 0:
        return False
    # From OpenGL's axes (y up, z backward). The terms of radial distortion are equal in both frames.
    r, t = [r[0], [-x for x in r[1]], [-x for x in r[2]]], [t[0], -t[1], -t[2]]
    source.add(place, name, (f, f, 0, 0, k1, k2), (r, t), no_centre=True)
    return True


def read_bundler(source):
    """The principal point is always the picture's centre, so that the custom of pixel centres is of no use."""
    pictures = bundler_pictures(source.folder, os.path.basename(source.path))
    lines, image_of = Lines(source.path), []
    what = "not the numbers of cameras and points"
    if not lines.next():
        raise lines.bad(what)
    camera_count, point_count = lines.wholes([1000000, 0xfffffffe], what, exactly=True)
    # A camera takes at least 30 bytes, a point at least 14.
    if camera_count > lines.size // 30 or point_count > lines.size // 14:
        raise lines.bad("more cameras or points than the file has room for")
    if len(pictures) != camera_count:
        raise Refused(f"{source.path}: line {lines.number}: {camera_count} cameras, but list.txt names {len(pictures)} "
                      "pictures", "ORL_ERR_DATA")
    for index, name in enumerate(pictures):
        at = len(source.out.root["cameras"])
        image_of.append(at if add_bundler_camera(source, lines, index, name) else -1)
    for _ in range(point_count):
        position = lines.next_words(3, "a point's position needs 3 numbers")
        colour = lines.next_words(3, "a point's colour needs 3 numbers")
        if not lines.next():
            raise lines.bad("a point needs the list of its views")
        seen = [image_of[camera] for camera in lines.views(0, camera_count)]
        source.out.add_point(position, colour, [image for image in seen if image >= 0])


# --- VisualSFM's NVM (http://ccwu.me/vsfm/doc.html#nvm) ---

def add_nvm_camera(source, lines, fixed):
    """fixed: f cx fy cy r of all cameras, or None."""
    words = lines.line.lstrip(b" \t").rsplit(None, 10)  # names may have spaces
    try:
        v = [real(word) for word in words[1:]]
    except ValueError:
        v = []
    if len(v) != 10:
        raise lines.bad("a camera needs a name and 10 numbers")
    r = from_quat(*v[1:5])
    if not r:
        raise lines.bad("a camera's quaternion is zero or not finite")
    f, cx, fy, cy, bend = fixed or (v[0], 0, v[0], 0, v[8])
    # VisualSFM's distortion maps the picture to the undistorted one: u = d (1 + r d^2). The series of the inverse gives
    # the terms of ours, which maps the other way: d = u (1 - r u^2 + 3 r^2 u^4 - 12 r^3 u^6 + ...).
    terms = [-bend, 3 * bend * bend, 0, 0, -12 * bend * bend * bend]
    # VisualSFM writes a space as a quotation mark.
    source.add(f"line {lines.number}", os.fsdecode(words[0].replace(b'"', b" ")), [f, fy, cx, cy, *terms],
               (r, [-dot(row, v[5:8]) for row in r]), no_centre=not fixed)


def read_nvm(source):
    """The first model of the file; others are of photographs that could not be placed with it."""
    lines, fixed, count = Lines(source.path), None, 0
    if not lines.next() or not lines.line.lstrip(b" \t").startswith(b"NVM_V3"):
        raise lines.bad("not NVM_V3")
    words = lines.line.split()
    if b"FixedK" in words:
        fixed = lines.numbers(5, "FixedK needs 5 numbers", words.index(b"FixedK") + 1)
        if not fixed[0] > 0:
            raise lines.bad("FixedK needs 5 numbers")
    if not lines.next():
        raise lines.bad("not the number of cameras")
    cameras = lines.wholes([1000000], "not the number of cameras")[0]
    for _ in range(cameras):
        if not lines.next():
            raise lines.bad("fewer cameras than the file says")
        add_nvm_camera(source, lines, fixed)
    if lines.next():
        count = lines.wholes([0xfffffffe], "not the number of points")[0]
    for _ in range(count):
        if not lines.next():
            raise lines.bad("fewer points than the file says")
        words = lines.words(6, "a point needs a position and a colour")
        source.out.add_point(words[:3], words[3:], lines.views(6, cameras))


# --- RealityScan's "Internal/External camera parameters" in CSV ---

COLUMNS = ("#name", "x", "y", "alt", "heading", "pitch", "roll", "f", "px", "py", "k1", "k2", "k3", "k4", "t1", "t2")
NEEDED = 8


def csv_fields(lines, separator):
    try:
        fields = next(csv.reader([os.fsdecode(lines.line)], delimiter=separator, skipinitialspace=True), [])
    except csv.Error as error:
        raise lines.bad(str(error)) from None
    return [field.strip(" \t") for field in fields]


def csv_heads(lines):
    """The places of the columns, and what separates them: where that is a semicolon, numbers have commas."""
    while True:
        if not lines.next_raw():
            break
        if lines.line[:5].lower() == b"#name":
            break
        if lines.line and not lines.line.startswith(b"#"):
            raise lines.bad('the line of column names, "#name,x,y,alt,heading,...", is missing')
    separator = ";" if b";" in lines.line else ","
    heads = [field.lower() for field in csv_fields(lines, separator)]
    if any(column not in heads for column in COLUMNS[:NEEDED]):
        raise lines.bad('a column of name, x, y, alt, heading, pitch, roll or f is missing: export "Internal/External '
                        'camera parameters"')
    return {column: heads.index(column) for column in COLUMNS if column in heads}, separator


def csv_pose(v):
    """The axes of a camera that looks down with its top to the north (y), turned by heading (clockwise), then pitch and
    roll: Rz(-heading) Rx(pitch) Ry(roll), OpenGL's axes."""
    turns = [math.radians(angle) for angle in (-v["heading"], v["pitch"], v["roll"])]
    (ch, cp, cr), (sh, sp, sr) = map(math.cos, turns), map(math.sin, turns)
    return from_opengl([[ch * cr - sh * sp * sr, -sh * cp, ch * sr + sh * sp * cr, v["x"]],
                        [sh * cr + ch * sp * sr, ch * cp, sh * sr - ch * sp * cr, v["y"]],
                        [-cp * sr, sp, cp * cr, v["alt"]]])


def csv_number(lines, fields, at, separator):
    try:
        word = fields[at].replace(",", ".", 1) if separator == ";" else fields[at]
        value = real(word.encode("utf-8", "surrogateescape"))
    except (IndexError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise lines.bad("a camera has a value that is not a number")
    return value


def read_realityscan(source):
    """Lengths are those of a picture whose larger side is 36 mm, or 1 for the principal point, whatever its size."""
    lines = Lines(source.path)
    at, separator = csv_heads(lines)
    while lines.next():
        fields, v = csv_fields(lines, separator), dict.fromkeys(COLUMNS, 0)
        v.update({column: csv_number(lines, fields, place, separator) for column, place in at.items() if column != "#name"})
        if v["k4"] != 0:
            raise lines.bad("a lens with k4: export without it, or undistorted pictures")
        pose = csv_pose(v)
        if not pose:
            raise lines.bad("a camera's place is absurdly far")
        name = fields[at["#name"]] if at["#name"] < len(fields) else ""
        source.add(f"line {lines.number}", name,
                   [v["f"] / 36, v["f"] / 36, *(v[key] for key in ("px", "py", "k1", "k2", "t1", "t2", "k3"))], pose,
                   side=1)


# --- Agisoft Metashape's XML ("Metashape User Manual", appendix "Camera models") ---

TERMS = ("f", "cx", "cy", "b1", "b2", "k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4")
DEPTH_MAX, SENSORS_MAX = 32, 1000


class Metashape:
    """Takes the first chunk from Expat's events, so that memory is bounded."""

    def __init__(self, path):
        self.path, self.elements, self.text, self.chunks, self.adjusted = path, [], "", 0, False
        self.sensors, self.components, self.cameras = [], [], []
        self.chunk = self.component("")

    @staticmethod
    def component(key):
        """A transform to the world."""
        return {"id": key, "rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "translation": [0, 0, 0], "scale": [1]}

    def parent(self):
        return self.elements[-2] if len(self.elements) > 1 else ""

    def begin(self, name, attributes):
        if len(self.elements) == DEPTH_MAX:
            raise Refused(f"{self.path}: elements more than {DEPTH_MAX} deep")
        self.elements.append(name)
        self.text = ""
        self.chunks += name == "chunk"
        if max(len(self.sensors), len(self.components)) > SENSORS_MAX:
            raise Refused(f"{self.path}: more than {SENSORS_MAX} sensors or components")
        if self.chunks != 1:
            return
        if name == "sensor" and self.parent() == "sensors":
            self.sensors.append({"id": attributes.get("id", ""), "type": attributes.get("type", ""), "size": (0, 0),
                                 "terms": None})
        elif name == "component" and self.parent() == "components":
            self.components.append(self.component(attributes.get("id", "")))
        elif name == "camera" and "cameras" in self.elements:
            self.cameras.append({**attributes, "transform": None})
        elif self.parent() == "sensor" and self.sensors:
            self.begin_in_sensor(name, attributes, self.sensors[-1])

    def begin_in_sensor(self, name, attributes, sensor):
        if name == "resolution":
            sensor["size"] = tuple(side(int(word)) if re.fullmatch("[0-9]{1,9}", word) else 0 for word in
                                   (attributes.get(key, "") for key in ("width", "height")))
        elif name == "calibration":
            self.adjusted = attributes.get("class") != "initial"  # it was found, not given
            if self.adjusted:
                sensor["terms"] = dict.fromkeys(TERMS, 0)
                sensor["type"] = attributes.get("type") or sensor["type"]

    def take_text(self, words):
        self.text = (self.text + words)[:1023]

    def take_numbers(self, name, count):
        try:
            values = [real(word.encode()) for word in self.text.split()[:count]]
        except ValueError:
            values = []
        if len(values) < count or not all(map(math.isfinite, values)):
            raise Refused(f'{self.path}: "{self.text}" in <{name}> is not as many numbers as it needs')
        return values

    def end(self, name):
        if self.chunks == 1:
            self.take(name)
        self.text = ""
        self.elements.pop()

    def take(self, name):
        parent, counts = self.parent(), {"rotation": 9, "translation": 3, "scale": 1}
        if parent == "calibration" and self.sensors and self.adjusted and "sensors" in self.elements:
            if name in TERMS:
                self.sensors[-1]["terms"][name] = self.take_numbers(name, 1)[0]
        elif name == "transform" and parent == "camera" and self.cameras:
            self.cameras[-1]["transform"] = self.take_numbers(name, 16)
        elif parent == "transform" and "cameras" not in self.elements and name in counts:
            inside = self.components and "components" in self.elements
            (self.components[-1] if inside else self.chunk)[name] = self.take_numbers(name, counts[name])

    def lens(self, sensor):
        """fx fy cx cy and distortion, and the kind of lens; or the problem, a text."""
        fisheye, v = sensor["type"] in ("fisheye", "equidistant_fisheye"), sensor["terms"]
        width, height = sensor["size"]
        if not v:
            return "it has no calibration: export after aligning"
        if not fisheye and sensor["type"] != "frame":
            return "its type is neither frame nor fisheye: panoramas and others cannot be used"
        if abs(v["b2"]) * height > v["f"] or v["p3"] or v["p4"] or (not fisheye and v["k4"]):
            return "its calibration has b2, k4, p3 or p4: leave them out, or export undistorted pictures"
        # Metashape's p1 and p2 have the places of OpenCV's p2 and p1. Its fisheye applies all terms behind the angle,
        # as COLMAP's thin prism does.
        bent = fisheye and bool(v["p1"] or v["p2"])
        terms = (("k1", "k2", "p2", "p1", "k3", "k4") if bent else ("k1", "k2", "k3", "k4") if fisheye else
                 ("k1", "k2", "p2", "p1", "k3"))
        lens = [v["f"] + v["b1"], v["f"], 0.5 * width + v["cx"], 0.5 * height + v["cy"], *(v[key] for key in terms)]
        return lens, {"thin_prism": bent, "fisheye": fisheye}

    def pose(self, camera):
        c = next((c for c in self.components[::-1] if c["id"] == camera.get("component_id", "")), self.chunk)
        m, turn, scale = camera["transform"], c["rotation"], c["scale"][0]
        rows = [turn[:3], turn[3:6], turn[6:]]
        axes = [[sum(row[k] * m[4 * k + j] for k in range(3)) for j in range(3)] for row in rows]
        return from_axes(axes, [c["translation"][i] + sum(scale * rows[i][j] * m[4 * j + 3] for j in range(3))
                                for i in range(3)])

    def add(self, source, camera):
        label = camera.get("label", "")
        sensor = next((s for s in self.sensors if s["id"] == camera.get("sensor_id", "")), None)
        lens = self.lens(sensor) if sensor else "its sensor is not there"
        pose = self.pose(camera)
        if isinstance(lens, str) or not pose:
            raise source.bad(f"camera {label[:120]}", lens if isinstance(lens, str) else "its transform is not a pose")
        source.add(label, label, lens[0], pose, sensor["size"], **lens[1])


def read_metashape(source):
    data, reader = read_bytes(source.path), Metashape(source.path)
    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = reader.begin, reader.end
    parser.CharacterDataHandler = reader.take_text
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise Refused(f"{source.path}: line {error.lineno} (byte {parser.ErrorByteIndex}): "
                      f"{expat.ErrorString(error.code)}") from None
    if not reader.chunks:
        raise Refused(f"{source.path}: not Metashape's cameras: no <chunk>")
    total, placed = len(reader.cameras), [camera for camera in reader.cameras if camera["transform"]]
    enabled = [camera for camera in placed if camera.get("enabled") not in ("false", "0")]
    for camera in enabled:
        reader.add(source, camera)
    for count, why in ((total - len(placed), "not aligned"), (len(placed) - len(enabled), "disabled")):
        if count:
            source.out.say(f"{source.path}: {count} of {total} cameras are {why}: left out", warns=True)
    if reader.chunks > 1:
        source.out.say(f"{source.path}: {reader.chunks} chunks; taking the first", warns=True)


# --- the formats ---

# How each is read, and the coordinate of the first pixel's centre where neither the file nor the user states it.
READERS = {"Bundler": (read_bundler, 0.5), "LLFF": (read_llff, 0.5), "Middlebury": (read_middlebury, 0),
           "VisualSFM": (read_nvm, 0.5), "Metashape": (read_metashape, 0.5), "RealityScan": (read_realityscan, 0.5)}
FOLDERS = {"Blender's set": read_splits, "Polycam": read_polycam}
# JSON, whatever the names of its files, is recognised by its keys: the root has arrays of these names.
OBJECTS = (("transforms.json (nerfstudio, instant-ngp, Blender)", read_transforms, ("frames",)),
           ("Record3D", read_record3d, ("poses", "K")), ("Meshroom", read_meshroom, ("views", "intrinsics")))


def formats():
    """(name, patterns of files) of those that are read here."""
    rows = [re.fullmatch(r"  (.*?)  +(.*)", line).groups() for line in FORMATS.splitlines()]
    return [(name, files.split()) for name, files in rows][2:]


def json_format(root):
    if isinstance(root, list):
        shots = get(root[0] if root else None, "shots")
        return ("OpenSfM", read_opensfm) if isinstance(shots, dict) else ("Inria's cameras.json", read_inria)
    for name, read, arrays in OBJECTS:
        if all(isinstance(get(root, key), list) for key in arrays):
            return name, read
    return None, None


def read_file(out, path, centre):
    name, root, custom = None, None, 0.5
    base = os.path.basename(path)
    if not os.path.isfile(path):
        raise Refused(f"{path}: no such file or folder", "ORL_ERR_NOT_FOUND")
    if os.path.splitext(base)[1] in (".json", ".sfm"):
        root = read_json(path)
        if get(root, "sfm_data_version") is not None:  # it has "views" and "intrinsics", as Meshroom's has
            raise Refused(f"{path}: OpenMVG's cameras are not read: openMVG_main_openMVG2Colmap makes a COLMAP model")
        name, read = json_format(root)
    else:
        for name, files in formats():
            if name in READERS and any(fnmatch.fnmatchcase(base, os.path.basename(pattern)) for pattern in files):
                read, custom = READERS[name]
                break
        else:
            name = None
    if not name:
        raise Refused(f"{path}: not a file of cameras that is known: oriel import --help lists the formats")
    out.root.update(format=name, path=plain(path), found=plain(path))
    read(Source(out, path, centre, custom, root))


def find_pattern(folder, pattern):
    """The path of a pattern's file in a folder, or None."""
    if "*" not in pattern:
        path = os.path.join(folder, pattern)
        return path if os.path.isfile(path) or os.path.isdir(path) else None
    found = [name for name in list_dir(folder) if not name.startswith(".") and fnmatch.fnmatchcase(name, pattern)]
    if len(found) > 1:
        raise Refused(f"{folder}: several files of cameras, {found[0]} and {found[1]}: name one", "ORL_ERR_DATA")
    return os.path.join(folder, found[0]) if found else None


def read_folder(out, folder, centre):
    for name, files in [("Oriel's cameras.json", ["cameras.json"]), *formats()]:
        for pattern in files:
            found = find_pattern(folder, pattern)
            if found and name in FOLDERS:
                out.root.update(format=name, path=plain(folder), found=plain(found))
                return FOLDERS[name](Source(out, folder, centre, 0.5))
            if found:
                return read_file(out, found, centre)
    raise Refused(f"{folder}: no cameras here: oriel import --help lists the files that are searched for",
                  "ORL_ERR_NOT_FOUND")


def convert(path, centre, folder):
    """Never fails but for want of room in `folder`: what is wrong with the cameras is written there, too."""
    out = Output(folder)
    try:
        (read_folder if os.path.isdir(path) else read_file)(out, path, centre)
    except Refused as error:
        failure = error.result, str(error)
    except OSError as error:
        failure = "ORL_ERR_IO", f"{error.filename or path}: {error.strerror}"
    except MemoryError:
        failure = "ORL_ERR_MEMORY", f"{path}: no memory to read it"
    except Exception as error:  # damage that no reader has foreseen
        failure = "ORL_ERR_FORMAT", f"{path}: damaged: {type(error).__name__}: {error}"
    else:
        failure = None
    if failure:
        out.root.update(error={"result": failure[0], "text": plain(failure[1].replace("\0", "?"))})
    out.write()


if __name__ == "__main__":
    convert(sys.argv[1], float(sys.argv[2]), sys.argv[3])
