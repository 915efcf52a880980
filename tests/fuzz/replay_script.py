"""Runs the script that converts other programs' cameras on every file of a folder, as it is and damaged in many ways:
replay_script.py SOURCE_DIR TARGET FOLDER [VARIANTS]. VARIANTS of each input (20) are the same in every run.

Each must end with cameras in JSON, or with an error that a reader foresaw: never with a traceback."""
import copy
import importlib.util
import json
import math
import os
import random
import sys
import tempfile

# Of each target, the name of the file that an input is, what is read (the file, or this folder), and files beside it.
TARGETS = {
    "bundler": ("bundle.out", ".", ["list.txt"]), "known_json": ("transforms.json", None, []),
    "llff": ("poses_bounds.npy", None, ["images/a.jpg", "images/b.jpg"]), "metashape": ("cameras.xml", None, []),
    "middlebury": ("a_par.txt", None, []), "polycam": ("keyframes/cameras/1.json", ".", []),
    "realityscan": ("cameras.csv", None, []), "visualsfm": ("model.nvm", None, []),
}
WORDS = [b"nan", b"-1", b"1e999", b"0", b"99999999999999999999999", b"\0", b"\xff", b"\n", b" ", b'"', b"[" * 2000, b"<a>",
         b"#", b"{}", b"1_0", b"\\ud800", b";"]
VALUES = [None, True, -1, 0, 1e300, 10**400, "", "nan", "x" * 5000, "a\0b", "\ud800", [], {}, [[]], [None, {}]]


def damaged(random_of, data):
    """The bytes with a part of them gone, doubled or replaced."""
    data = bytearray(data)
    for _ in range(random_of.choice((1, 1, 2, 4))):
        at = random_of.randrange(len(data) + 1)
        end = min(len(data), at + random_of.choice((0, 1, 1, 4, 20, 10**6)))
        data[at:end] = random_of.choice((b"", data[at:end] * 2, random_of.choice(WORDS), random_of.randbytes(1)))
    return bytes(data)


def places(value, found):
    """Every (container, key) below a value."""
    keys = value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    for key in keys:
        found.append((value, key))
        places(value[key], found)
    return found


def damaged_json(random_of, root):
    root = copy.deepcopy(root)
    for _ in range(random_of.choice((1, 1, 2))):
        found = places(root, [])
        if found:
            entry, key = random_of.choice(found)
            if isinstance(entry, dict) and random_of.random() < 0.3:
                del entry[key]
            else:
                entry[key] = copy.deepcopy(random_of.choice(VALUES))
    return json.dumps(root).encode()


def variants(name, data, count):
    """The input, then `count` damaged ones."""
    random_of = random.Random(name)
    try:
        root = json.loads(data)
    except ValueError:
        root = None
    yield data
    for i in range(count):
        yield damaged_json(random_of, root) if root is not None and i % 2 else damaged(random_of, data)


def save(folder, name, data):
    path = os.path.join(folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(data)


def no_constant(name):
    raise ValueError(f"{name} is no number of JSON")


def check(out):
    """Raises ValueError unless the script has kept its promises."""
    with open(os.path.join(out, "cameras.json"), encoding="utf-8") as file:
        root = json.load(file, parse_constant=no_constant)
    if "error" in root:
        if root["error"]["result"] not in ("ORL_ERR_FORMAT", "ORL_ERR_DATA", "ORL_ERR_NOT_FOUND", "ORL_ERR_IO"):
            raise ValueError(f"a result that there is not: {root['error']}")
        if ": damaged: " in root["error"]["text"]:
            raise ValueError(f"an error that no reader foresaw: {root['error']['text']}")
        return False
    for camera in root["cameras"]:
        values = [*sum(camera["K"], []), *sum(camera["R"], []), *camera["t"], *camera["dist"]]
        if len(values) - len(camera["dist"]) != 21 or len(camera["dist"]) > 8 or not all(map(math.isfinite, values)):
            raise ValueError(f"not a camera: {camera}")
        if not isinstance(camera["name"], str) or ("no_size" in camera) == ("width" in camera):
            raise ValueError(f"a camera without name or size: {camera}")
    points = os.path.join(out, "points.txt")
    for line in open(points, encoding="ascii") if os.path.exists(points) else ():
        if any(not 0 <= int(word) < len(root["cameras"]) for word in line.split()[6:]):
            raise ValueError("a point is seen by no camera")
    return True


def run(script, target, data, work):
    """True where the file was read."""
    points = os.path.join(work, "out/points.txt")
    if os.path.exists(points):
        os.remove(points)
    file, read, beside = TARGETS[target]
    if target == "bundler":  # a file ahead of the other, by its length in two bytes
        length = int.from_bytes(data[:2], "little")
        save(work, f"in/{beside[0]}", data[2:2 + length])
        data = data[2 + length:]
    else:
        for name in beside:
            save(work, f"in/{name}", b"")
    save(work, f"in/{file}", data)
    script.convert(os.path.join(work, "in", read or file), -1.0, os.path.join(work, "out"))
    return check(os.path.join(work, "out"))


def main(source, target, folder, count="20"):
    spec = importlib.util.spec_from_file_location("known_cameras", os.path.join(source, "src/scene/known_cameras.py"))
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    good = tried = 0
    with tempfile.TemporaryDirectory() as work:
        os.mkdir(os.path.join(work, "out"))
        for name in sorted(os.listdir(folder)):
            with open(os.path.join(folder, name), "rb") as file:
                data = file.read()
            for variant in variants(name, data, int(count)):
                try:
                    good += run(script, target, variant, work)
                except Exception:
                    print(f"{target}/{name}: {variant[:2000]!r}")
                    raise
                tried += 1
    print(f"{target}: {tried} inputs, {good} of them read")
    return 0 if 0 < good < tried else 1


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.exit(main(*sys.argv[1:]))
