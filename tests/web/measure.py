#!/usr/bin/python3
"""measure.py BUILD SCENE [--out DIR] [--views N] [--window WxH] [--json FILE]: the published page beside `oriel render`.

Publishes SCENE, lets a headless Chromium on SwiftShader draw the held-out cameras, and prints PSNR
and SSIM of page and renderer against the photographs and against each other, bytes until the first
picture and in all, memory, and the processor time of a frame as a ratio to points only."""
import argparse
import json
import os
import re
import subprocess
import tempfile
import time

from browser import Browser, Server
from measure_live import processor_ms

FRAMES = 7


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def median(values):
    return sorted(values)[len(values) // 2]


# One frame of a camera, finished on the device.
FRAME = """
const [camera, layer, whole] = arguments, renderer = oriel.picture.renderer;
renderer.draw(camera, layer, whole);
renderer.depthAt(0, 0);
"""


def family(pid):
    """The process and those that it has started, directly or not."""
    parents = {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat") as file:
                parents.setdefault(int(file.read().rpartition(")")[2].split()[1]), []).append(int(entry))
        except OSError:
            pass # it has ended
    found = [pid]
    for one in found:
        found += parents.get(one, [])
    return found


def frame_ms(browser, camera, layer, whole=False):
    """Processor time of a frame, of all the browser's processes: SwiftShader draws on the processor."""
    pids, times = family(browser.driver.service.process.pid), []
    for _ in range(FRAMES):
        before = sum(processor_ms(pid) for pid in pids)
        browser.js(FRAME, camera, layer, whole)
        times.append(sum(processor_ms(pid) for pid in pids) - before)
    return median(times[2:])


def browser_processes(browser):
    """Of the page, of the graphics (SwiftShader's textures are its memory), and of all else."""
    roles = {"page": [], "graphics": [], "other": []}
    for pid in family(browser.driver.service.process.pid)[1:]:
        with open(f"/proc/{pid}/cmdline") as file:
            command = file.read()
        role = "page" if "--type=renderer" in command else "graphics" if "--type=gpu-process" in command else "other"
        roles[role].append(pid)
    return roles


def resident_mib(pids):
    """Memory of processes, shared parts once."""
    total = 0
    for pid in pids:
        with open(f"/proc/{pid}/smaps_rollup") as file:
            total += next(int(line.split()[1]) for line in file if line.startswith("Pss:"))
    return total / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("scene")
    parser.add_argument("--out", default=None, help="keeps the pictures")
    parser.add_argument("--views", type=int, default=0, help="at most so many held-out cameras, evenly chosen")
    parser.add_argument("--window", default="1280x800", help="size of the page; a small one loads sooner")
    parser.add_argument("--json", help="writes the means to this file")
    options = parser.parse_args()
    work = options.out or tempfile.mkdtemp()
    os.makedirs(work, exist_ok=True)
    oriel, tool = f"{options.build}/oriel", f"{options.build}/tests/bench_web_pictures"
    published = run(oriel, "publish", options.scene, "--out", f"{work}/site").splitlines()[0]
    print(published)
    first_mb = float(re.search(r"([0-9.]+) MB until", published)[1])
    cameras = json.loads(run(tool, "cameras", options.scene))
    test = [c for c in cameras if c["test"]] or cameras[:3]
    if options.views:
        count = min(options.views, len(test))
        test = [test[i * len(test) // count] for i in range(count)]
    server, browser = Server(f"{work}/site"), Browser(*map(int, options.window.split("x")))
    try:
        start = time.monotonic()
        browser.driver.get(server.address)
        browser.wait("return document.getElementById('poster').complete")
        print(f"poster after {time.monotonic() - start:.1f} s")
        browser.wait("return !!window.oriel && oriel.picture.renderer.frame !== null")
        print(f"coarse points after {time.monotonic() - start:.1f} s, "
              f"{browser.js('return oriel.files.bytes') / 1e6:.2f} MB of data")
        browser.settle()
        print(f"everything after {time.monotonic() - start:.1f} s")
        memory = {role: resident_mib(pids) for role, pids in browser_processes(browser).items()}
        print("resident, MiB:", ", ".join(f"{role} {mib:.0f}" for role, mib in memory.items()))
        whole_mb = browser.js("return oriel.files.bytes") / 1e6
        graphics_mb = browser.js("return oriel.picture.device.bytes + oriel.picture.cloud.bytes") / 1e6
        print(f"{whole_mb:.1f} MB of data loaded")
        print(f"graphics memory {graphics_mb:.0f} MB")
        print("photograph         page: PSNR  SSIM  oriel: PSNR  SSIM  page to oriel: PSNR  SSIM")
        rows = []
        for camera in test:
            name = camera["name"]
            page, own = f"{work}/{name}.page.png", f"{work}/{name}.oriel.png"
            browser.capture(page, camera)
            run(oriel, "render", options.scene, "--at", name, "--out", own, "--quiet")
            photo = f"{options.scene}/images/{name}"
            row = [float(x) for a, b in ((page, photo), (own, photo), (page, own))
                   for x in run(tool, "compare", a, b).split()]
            rows.append(row)
            print(f"{name:20} {row[0]:8.2f} {row[1]:.4f} {row[2]:8.2f} {row[3]:.4f} {row[4]:8.2f} {row[5]:.4f}")
        mean = [sum(column) / len(rows) for column in zip(*rows)]
        print(f"{'mean':20} {mean[0]:8.2f} {mean[1]:.4f} {mean[2]:8.2f} {mean[3]:.4f} {mean[4]:8.2f} {mean[5]:.4f}")
        moving, rest = frame_ms(browser, test[0], 0), frame_ms(browser, test[0], 0, True)
        points = frame_ms(browser, test[0], 5)
        print(f"frame of {test[0]['width']}x{test[0]['height']}: {moving:.0f} ms of processor time, at rest {rest:.0f} ms, "
              f"points only {points:.0f} ms, ratio {moving / points:.2f}")
        if options.json:
            with open(options.json, "w") as file:
                json.dump({"scene": os.path.basename(os.path.abspath(options.scene)), "views": len(rows),
                           "first_mb": first_mb, "whole_mb": whole_mb, "graphics_mb": graphics_mb, "mean": mean,
                           "worst_db": min(row[4] for row in rows), "moving_ms": moving, "rest_ms": rest,
                           "points_ms": points}, file)
        for error in browser.errors():
            print("console:", error)
    finally:
        browser.close()
        server.close()


if __name__ == "__main__":
    main()
