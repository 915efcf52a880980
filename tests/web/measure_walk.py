#!/usr/bin/python3
"""measure_walk.py BUILD SCENE [--seconds S] [--rate N] [--size WxH] [--json FILE]: a long walk, watched for faults.

Walks past all photographs of a scene, there and back, through `oriel walk`, with N views for each second of
the walk, each asked for when the one before has come. Reports pops (a frame that differs from the
one before far more than its neighbours do), black frames, and growth of the server's memory."""
import argparse
import json
import os
import subprocess
import tempfile

from client import Client, Walk
from measure_live import median, processor_ms, request

SMALL = (160, 107) # pixels that frames are compared at
AROUND = 8         # frames before and after that say what change is usual
BLACK = 8          # of 255


def resident_mib(pid):
    with open(f"/proc/{pid}/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmRSS")) / 1024


def shrunk(jpegs):
    """Grey pictures of SMALL pixels."""
    command = ["ffmpeg", "-v", "error", "-f", "mjpeg", "-i", "-", "-vf", f"scale={SMALL[0]}:{SMALL[1]}:flags=area",
               "-pix_fmt", "gray", "-f", "rawvideo", "-"]
    with tempfile.TemporaryFile() as file:
        for jpeg in jpegs:
            file.write(jpeg)
        file.seek(0)
        data = subprocess.run(command, stdin=file, check=True, capture_output=True).stdout
    size = SMALL[0] * SMALL[1]
    return [data[i:i + size] for i in range(0, len(data), size)]


def changes(pictures):
    """Mean absolute difference of each picture to the one before, of 255."""
    return [sum(abs(x - y) for x, y in zip(a, b)) / len(a) for a, b in zip(pictures, pictures[1:])]


def pops(change):
    """Each change as a multiple of the largest of those around it, next to it excepted."""
    ratios = []
    for i, value in enumerate(change):
        near = change[max(0, i - AROUND):max(0, i - 1)] + change[i + 2:i + 1 + AROUND]
        ratios.append(value / max(max(near), 0.1))
    return ratios


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("scene")
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("--rate", type=float, default=12)
    parser.add_argument("--size", default="640x427")
    parser.add_argument("--json", help="writes the figures to this file")
    options = parser.parse_args()
    size = [int(x) for x in options.size.split("x")]
    count = int(options.seconds * options.rate)
    walk = Walk(f"{options.build}/oriel", options.scene)
    try:
        photos = sorted(json.loads(walk.get("/manifest.json")[1])["photos"], key=lambda p: p["name"])
        client, jpegs, memory, pid = Client(walk), [], [], walk.process.pid
        before = processor_ms(pid)
        for n in range(count):
            share = 2 * n / max(count - 1, 1)
            at = (len(photos) - 1) * (share if share < 1 else 2 - share)
            jpegs.append(client.frame(request(photos, at, n, size, False))[1])
            memory.append(resident_mib(pid))
        used = processor_ms(pid) - before
        client.close()
    finally:
        walk.close()
    pictures = shrunk(jpegs)
    change = changes(pictures)
    ratios = pops(change)
    black = sum(sum(p) / len(p) < BLACK for p in pictures)
    half = len(memory) // 2
    print(f"{os.path.basename(os.path.abspath(options.scene))}: {count} frames, {options.seconds:g} s of walk, "
          f"{used / count:.0f} ms of processor time a frame")
    print(f"change of a frame to the next, of 255: median {median(change):.2f}, largest {max(change):.2f}")
    print(f"largest change as a multiple of the largest around it: {max(ratios):.2f} (frame {ratios.index(max(ratios)) + 1})")
    print(f"black frames: {black}")
    print(f"memory of the server, MiB: {memory[0]:.0f} at first, {max(memory[:half]):.0f} on the way there, "
          f"{max(memory[half:]):.0f} on the way back")
    if options.json:
        with open(options.json, "w") as file:
            json.dump({"scene": os.path.basename(os.path.abspath(options.scene)), "photographs": len(photos),
                       "frames": count, "processor_ms": used / count, "median": median(change), "largest": max(change),
                       "pop": max(ratios), "black": black, "there_mib": max(memory[:half]),
                       "back_mib": max(memory[half:])}, file)


if __name__ == "__main__":
    main()
