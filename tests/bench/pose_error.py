#!/usr/bin/env python3
"""How far are the poses of a synthetic scene from the true ones?
usage: pose_error.py SCENE PHOTOS-TRUTH
Over all pairs of photographs, since the scene's frame and scale are its own: the angle between the
relative rotation and the true one, the angle between the directions from one photograph to the
other, and by how much their distance differs from the true one at the median scale.
"""
import itertools
import math
import os
import struct
import sys


def turned(q, v):
    """The vector v turned by the quaternion q (w, x, y, z)."""
    w, u = q[0], q[1:]
    t = [2 * x for x in cross(u, v)]
    return [a + w * b + c for a, b, c in zip(v, t, cross(u, t))]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def times(a, b):
    return [a[0] * b[0] - sum(x * y for x, y in zip(a[1:], b[1:]))] + [
        a[0] * y + b[0] * x + z for x, y, z in zip(a[1:], b[1:], cross(a[1:], b[1:]))]


def inverse(q):
    return [q[0]] + [-x for x in q[1:]]


def pose(q, t):
    """cam_from_world as its rotation and the centre of projection."""
    return list(q), [-x for x in turned(inverse(q), t)]


def read_binary(path):
    with open(path, "rb") as stream:
        data = stream.read()
    poses, at = {}, 8
    for _ in range(struct.unpack_from("<Q", data)[0]):
        values = struct.unpack_from("<I7dI", data, at)
        end = data.index(b"\0", at + 64)
        poses[data[at + 64:end].decode()] = pose(values[1:5], values[5:8])
        at = end + 9 + 24 * struct.unpack_from("<Q", data, end + 1)[0]
    return poses


def read_text(path):
    poses = {}
    with open(path) as stream:
        for words in (line.split() for line in stream if not line.startswith("#")):
            if len(words) == 10: # the other lines are points
                numbers = [float(word) for word in words[1:8]]
                poses[words[9]] = pose(numbers[:4], numbers[4:])
    return poses


def angle_deg(a, b):
    cosine = sum(x * y for x, y in zip(a, b)) / math.hypot(*a) / math.hypot(*b)
    return math.degrees(math.acos(max(-1, min(1, cosine))))


def main():
    found = read_binary(os.path.join(sys.argv[1], "sparse", "images.bin"))
    true = read_text(os.path.join(sys.argv[2], "sparse", "images.txt"))
    rotations, directions, scales = [], [], []
    for pair in itertools.combinations(sorted(set(found) & set(true)), 2):
        turns, ways = [], []
        for poses in (found, true):
            (q0, c0), (q1, c1) = (poses[name] for name in pair)
            turns.append(times(q1, inverse(q0)))
            ways.append(turned(q0, [b - a for a, b in zip(c0, c1)]))
        w, *xyz = times(turns[0], inverse(turns[1]))
        rotations.append(math.degrees(2 * math.atan2(math.hypot(*xyz), abs(w))))
        directions.append(angle_deg(*ways))
        scales.append(math.log(math.hypot(*ways[0]) / math.hypot(*ways[1])))
    middle = sorted(scales)[len(scales) // 2]
    off = [100 * abs(math.expm1(scale - middle)) for scale in scales]
    print(f"{len(found)} photographs; median and largest error:", ", ".join(
        f"{what} {sorted(errors)[len(errors) // 2]:.2f} and {max(errors):.2f} {unit}"
        for what, errors, unit in (("rotation", rotations, "degrees"),
                                   ("direction", directions, "degrees"),
                                   ("distance", off, "%"))))


main()
