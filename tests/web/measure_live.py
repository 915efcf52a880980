#!/usr/bin/python3
"""measure_live.py BUILD SCENE [--size WxH] [--frames N]: how fast `oriel walk` answers.

Walks past all photographs without a pause and asks for the next frame when one has come, as the
page does. Prints the frames a second, the longest frame as a multiple of the median, and how long it
takes from standing still until the sharp picture and until the best one. A frame's time is from the
request to its last byte; the server's own time is drawing and encoding."""
import argparse
import json
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__))))
from client import Client, Walk

QUALITY_MOVING, QUALITY_STILL = 75, 90 # as web/js/live.js


def view_of(photo):
    rows = photo["cam_from_world"]
    r = [x for row in rows for x in row[:3]]
    eye = [-sum(rows[i][k] * rows[i][3] for i in range(3)) for k in range(3)]
    return r, eye


def orthonormal(r):
    """The nearest rotation of a mean of two, by Gram and Schmidt."""
    x, y = r[0:3], r[3:6]
    norm = lambda v: [c / sum(d * d for d in v) ** 0.5 for c in v]
    x = norm(x)
    y = norm([b - a * sum(p * q for p, q in zip(x, y)) for a, b in zip(x, y)])
    return x + y + [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]


def request(photos, at, number, size, rest):
    """The view between two photographs of the tour; at: in photographs."""
    i, share = int(at), at - int(at)
    a, b = photos[i], photos[min(i + 1, len(photos) - 1)]
    (r0, eye0), (r1, eye1) = view_of(a), view_of(b)
    mix = lambda a, b: [(1 - share) * x + share * y for x, y in zip(a, b)]
    focal = size[0] * mix([a["fx"] / a["width"]], [b["fx"] / b["width"]])[0]
    return {"number": number, "size": size, "focal": [focal, focal, size[0] / 2, size[1] / 2],
            "r": orthonormal(mix(r0, r1)), "eye": mix(eye0, eye1), "layer": "color", "rest": rest,
            "quality": QUALITY_STILL if rest else QUALITY_MOVING}


def processor_ms(pid):
    """Of all threads so far. Unlike time on the clock, it does not grow when other programs run."""
    total = 0
    for thread in os.listdir(f"/proc/{pid}/task"):
        try:
            with open(f"/proc/{pid}/task/{thread}/schedstat") as file:
                total += int(file.read().split()[0])
        except OSError:
            pass # the thread has ended
    return total / 1e6


def median(values):
    return sorted(values)[len(values) // 2]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("scene")
    parser.add_argument("--size", default="640x427")
    parser.add_argument("--frames", type=int, default=240)
    parser.add_argument("--json", help="writes the figures to this file")
    options = parser.parse_args()
    size = [int(x) for x in options.size.split("x")]
    started = time.monotonic()
    walk = Walk(f"{options.build}/oriel", options.scene)
    try:
        ready = time.monotonic() - started
        photos = sorted(json.loads(walk.get("/manifest.json")[1])["photos"], key=lambda p: p["name"])
        client, took, own, work, missing = Client(walk), [], [], [], []
        pid, before = walk.process.pid, processor_ms(walk.process.pid)
        for n in range(options.frames):
            at = (len(photos) - 1) * n / max(options.frames - 1, 1)
            start = time.monotonic()
            header, _ = client.frame(request(photos, at, n, size, False))
            took.append(1000 * (time.monotonic() - start))
            own.append(header[1] / 1000)
            now = processor_ms(pid)
            work.append(now - before)
            before = now
            missing.append(header[4])
        start = time.monotonic()
        sharp = best = None
        frames = 0
        while best is None:
            header, _ = client.frame(request(photos, len(photos) - 1, frames, size, True))
            now = time.monotonic() - start
            sharp = now if sharp is None else sharp
            best = now if header[4] == 0 else None
            frames += 1
        client.close()
        middle = median(took)
        figures = {
            "scene": os.path.basename(os.path.abspath(options.scene)), "photographs": len(photos),
            "size": options.size, "frames": len(took), "ready_s": ready,
            "frames_per_second": 1000 * len(took) / sum(took), "median_ms": middle,
            "server_median_ms": median(own), "first_to_median": took[0] / middle,
            "longest_to_median": max(took) / middle, "longest_frame": took.index(max(took)),
            "server_longest_to_median": max(own) / median(own),
            "above_1_5": sum(t > 1.5 * middle for t in took),
            "processor_median_ms": median(work), "processor_first_to_median": work[0] / median(work),
            "processor_longest_to_median": max(work) / median(work),
            "processor_above_1_5": sum(w > 1.5 * median(work) for w in work),
            "sharp_s": sharp, "best_s": best, "frames_until_best": frames,
        }
        for key, value in figures.items():
            print(f"{key:26} {value:.3g}" if isinstance(value, float) else f"{key:26} {value}")
        if options.json:
            figures["each"] = [{"ms": a, "server_ms": b, "processor_ms": c, "missing": d}
                               for a, b, c, d in zip(took, own, work, missing)]
            with open(options.json, "w") as file:
                json.dump(figures, file, indent=1)
    finally:
        walk.close()


if __name__ == "__main__":
    main()
