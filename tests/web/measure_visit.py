#!/usr/bin/python3
"""measure_visit.py BUILD SCENE [--sizes WxH,...]: what a visit takes, as rows of docs/measured/web.md.

Opens the published page of SCENE in headless Chromium on SwiftShader in windows of several sizes, then walks through
`oriel walk` with one client and with two, and kills the server under an open page and starts it again. Times are
given on the clock and, in brackets, as processor time of all the browser's processes, which other programs on the
machine lengthen less."""
import argparse
import json
import os
import subprocess
import tempfile
import threading
import time

from browser import Browser, Server
from client import Client, Walk
from measure import browser_processes, family, frame_ms, median, resident_mib
from measure_live import processor_ms, request

EVERY_S = 0.1 # between two looks at processor time
START_S = 3 # until a browser has started
FRAMES = 20

# When the poster has given way to a picture that the graphics have finished: reading a pixel of it waits for that.
WATCH = """
document.addEventListener("DOMContentLoaded", () => {
    const poster = document.getElementById("poster"), canvas = document.getElementById("canvas");
    new MutationObserver(() => {
        if (window.shownAt || !poster.classList.contains("away"))
            return;
        const gl = canvas.getContext("webgl2");
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        window.shownAt = performance.now();
    }).observe(poster, {attributes: true});
});
"""


class Processor(threading.Thread):
    """Processor time of a browser, at times of the clock."""

    def __init__(self, browser):
        super().__init__(daemon=True)
        self.browser, self.seen, self.ends = browser, [], False
        self.start()

    def run(self):
        while not self.ends:
            pids = family(self.browser.driver.service.process.pid)
            self.seen.append((time.time(), sum(processor_ms(pid) for pid in pids if os.path.exists(f"/proc/{pid}/task"))))
            time.sleep(EVERY_S)

    def since_start(self, at):
        """Seconds, until the last look before `at`."""
        before = [used for when, used in self.seen if when <= at]
        return max((before or [self.seen[0][1]])[-1] - self.seen[0][1], 0) / 1000


def visit(address, size):
    """A row of the table."""
    browser = Browser(*size)
    try:
        browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": WATCH})
        time.sleep(START_S) # the visitor's browser runs already
        processor = Processor(browser)
        browser.open(address, 900)
        whole, processor.ends = time.time(), True
        processor.join()
        origin, paint, shown = browser.js("""
            const paint = performance.getEntriesByName("first-paint")[0];
            return [performance.timeOrigin, paint ? paint.startTime : NaN, window.shownAt];""")
        told = [f"{at / 1000:.1f} s ({processor.since_start((origin + at) / 1000):.1f} s)"
                for at in (paint, shown, 1000 * whole - origin)]
        megabytes = browser.js("return oriel.files.bytes") / 1e6
        graphics = browser.js("return oriel.picture.device.bytes + oriel.picture.cloud.bytes") / 1e6
        resident = sum(resident_mib(pids) for role, pids in browser_processes(browser).items() if role != "other")
        camera = browser.js("return oriel.windowCamera(0.35)") # as while moving
        ratio = frame_ms(browser, camera, 0) / frame_ms(browser, camera, 5)
    finally:
        browser.close()
    return (f"| {size[0]}x{size[1]} | {' | '.join(told)} | {megabytes:.1f} MB | {resident:.0f} MiB, graphics "
            f"{graphics:.0f} MB | {ratio:.1f} |")


def frame_times(walk, photos, clients):
    """Median time of a frame for each of some clients that ask at once, milliseconds."""
    took = [[] for _ in range(clients)]

    def ask(times):
        client = Client(walk)
        for n in range(FRAMES):
            start = time.monotonic()
            client.frame(request(photos, (len(photos) - 1) * n / FRAMES, n, (640, 427), False))
            times.append(1000 * (time.monotonic() - start))
        client.close()

    threads = [threading.Thread(target=ask, args=(times,)) for times in took]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return median([median(times) for times in took])


def returns(oriel, scene, walk):
    """Seconds until a page says that its server was killed, and until a server that starts has drawn for it."""
    browser = Browser(390, 844)
    try:
        browser.open(walk.address)
        walk.process.kill()
        walk.process.wait()
        killed = time.monotonic()
        browser.wait("return oriel.picture.problem !== ''")
        said = time.monotonic() - killed
        again = Walk(oriel, scene, "--port", walk.port)
        started = time.monotonic()
        try:
            browser.wait("return oriel.picture.problem === '' && oriel.picture.complete")
            drawn = time.monotonic() - started
        finally:
            again.close()
    finally:
        browser.close()
    return said, drawn


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("scene")
    parser.add_argument("--sizes", default="390x844,1440x900,2560x1440")
    options = parser.parse_args()
    oriel = f"{options.build}/oriel"
    print(f"load average {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([oriel, "publish", options.scene, "--out", f"{work}/site", "--quiet"], check=True)
        server = Server(f"{work}/site")
        for size in options.sizes.split(","):
            print(visit(server.address, tuple(map(int, size.split("x")))), flush=True)
        server.close()
    walk = Walk(oriel, options.scene)
    photos = sorted((p for p in json.loads(walk.get("/manifest.json")[1])["photos"] if not p["held_out"]),
                    key=lambda p: p["name"])
    frame_times(walk, photos, 1) # photographs are read
    print(f"two clients: a frame takes {frame_times(walk, photos, 2) / frame_times(walk, photos, 1):.2f} times as long")
    print("killed: said after {:.1f} s; drawn {:.1f} s after the new server listens".format(
        *returns(oriel, options.scene, walk)))


if __name__ == "__main__":
    main()
