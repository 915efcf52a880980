#!/usr/bin/python3
"""measure.py BUILD SCENE [--out DIR]: the published page of a scene beside `oriel render`.

Publishes SCENE, lets a headless Chromium on SwiftShader draw the held-out cameras, and prints PSNR
and SSIM of page and renderer against the photographs and against each other, bytes until the first
picture and in all, and the time of a frame as a ratio to points only."""
import argparse
import json
import os
import subprocess
import tempfile
import time

from browser import Browser, Server

FRAMES = 7


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def median(values):
    return sorted(values)[len(values) // 2]


# Milliseconds of one frame of a camera, finished on the device, of each of two layers.
TIME = """
const [camera, layer, frames] = arguments, renderer = oriel.picture.renderer, times = [];
for (let i = 0; i < frames; i++) {
    const start = performance.now();
    renderer.draw(camera, layer);
    renderer.depthAt(0, 0);
    times.push(performance.now() - start);
}
return times;
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("scene")
    parser.add_argument("--out", default=None, help="keeps the pictures")
    options = parser.parse_args()
    work = options.out or tempfile.mkdtemp()
    os.makedirs(work, exist_ok=True)
    oriel, tool = f"{options.build}/oriel", f"{options.build}/tests/bench_web_pictures"
    print(run(oriel, "publish", options.scene, "--out", f"{work}/site").splitlines()[0])
    cameras = json.loads(run(tool, "cameras", options.scene))
    test = [c for c in cameras if c["test"]] or cameras[:3]
    server, browser = Server(f"{work}/site"), Browser(1280, 800)
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
        print(f"graphics memory {browser.js('return oriel.picture.device.bytes + oriel.picture.cloud.bytes') / 1e6:.0f} MB")
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
        whole = median(browser.js(TIME, test[0], 0, FRAMES)[2:])
        points = median(browser.js(TIME, test[0], 5, FRAMES)[2:])
        print(f"frame of {test[0]['width']}x{test[0]['height']}: {whole:.0f} ms, points only {points:.0f} ms, "
              f"ratio {whole / points:.2f}")
        for error in browser.errors():
            print("console:", error)
    finally:
        browser.close()
        server.close()


main()
