#!/usr/bin/env python3
"""What clusters do to a fused cloud.
usage: cluster_seams.py ONE.ply POINTS.ply CLUSTER.ply...
  ONE: .oriel/fused.ply of one fusion; POINTS: points.ply of that scene, for its median radius r
  CLUSTER: the clouds of all clusters of the same depth maps (stereo/fused)
Prints the points; doubles, which have another point within r / 4, of one fusion and of the
clusters, and those of the latter whose neighbour is another cluster's; points of one fusion
without one of the clusters' within r: all, those at a seam, which have points of two clusters
within 4 r, and the others; and points of the clusters without one of the one fusion's within r.
"""
import collections
import itertools
import math
import struct
import sys


def read(path, offset, form):
    with open(path, "rb") as stream:
        data = stream.read()
    start = data.index(b"end_header\n") + len("end_header\n")
    count = int(data[:start].split(b"element vertex ")[1].split()[0])
    size = (len(data) - start) // max(count, 1)
    return [struct.unpack_from(form, data, start + i * size + offset) for i in range(count)]


class Grid:
    """Points by cells of edge `reach`, so that all within it are in the 27 cells around."""

    def __init__(self, points, reach):
        self.points, self.reach = points, reach
        self.cells = collections.defaultdict(list)
        for i, point in enumerate(points):
            self.cells[self.cell(point)].append(i)

    def cell(self, point):
        return tuple(math.floor(x / self.reach) for x in point)

    def near(self, point):
        x, y, z = self.cell(point)
        for i, j, k in itertools.product((x - 1, x, x + 1), (y - 1, y, y + 1), (z - 1, z, z + 1)):
            for other in self.cells.get((i, j, k), ()):
                if math.dist(point, self.points[other]) < self.reach:
                    yield other


def doubles(points, reach, owners):
    grid = Grid(points, reach)
    double = across = 0
    for i, point in enumerate(points):
        near = [other for other in grid.near(point) if other != i]
        double += bool(near)
        across += any(owners[other] != owners[i] for other in near)
    return double, across


def missing(points, others, radius):
    grid = Grid(others, radius)
    return [next(grid.near(point), None) is None for point in points]


def main():
    one = read(sys.argv[1], 0, "<3f")
    radii = sorted(value for value, in read(sys.argv[2], 27, "<f"))
    radius = radii[len(radii) // 2]
    clusters = [read(path, 0, "<3f") for path in sys.argv[3:]]
    cloud = list(itertools.chain.from_iterable(clusters))
    owners = [c for c, points in enumerate(clusters) for _ in points]
    one_double, _ = doubles(one, radius / 4, [0] * len(one))
    double, across = doubles(cloud, radius / 4, owners)
    gone, wide = missing(one, cloud, radius), Grid(cloud, 4 * radius)
    seam = [len({owners[other] for other in wide.near(point)}) > 1 for point in one]
    at_seam = sum(g for g, s in zip(gone, seam) if s)
    new = sum(missing(cloud, one, radius))

    def share(part, whole):
        return f"{100 * part / max(whole, 1):.1f} %"

    print(f"points {len(one)} and {len(cloud)}; doubles {share(one_double, len(one))} and",
          f"{share(double, len(cloud))}, of two clusters {share(across, len(cloud))};",
          f"gone {share(sum(gone), len(one))}, at seams {share(at_seam, sum(seam))} of {sum(seam)},",
          f"elsewhere {share(sum(gone) - at_seam, len(one) - sum(seam))};",
          f"new {share(new, len(cloud))}")


main()
