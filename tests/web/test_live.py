#!/usr/bin/python3
"""Live cameras in the walk. Made by tests/e2e/walk_live.sh: test_live.py ORIEL SCENE WORK, in which folders are
made."""
import hashlib
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import threading
import time
import unittest
import zlib

from client import Client, Walk

ORIEL, SCENE, WORK = sys.argv[1:4]
FRAMES = 50
WAIT_S = 60 # a limit for a busy machine


def camera_of(manifest):
    photo = manifest["photos"][0]
    rows = photo["cam_from_world"]
    return {"size": [photo["width"], photo["height"]], "focal": [photo[key] for key in ("fx", "fy", "cx", "cy")],
            "r": [value for row in rows for value in row[:3]],
            "eye": [-sum(row[k] * row[3] for row in rows) for k in range(3)]}


def picture(client, camera):
    """What tells one picture from another."""
    client.send({"number": 1, "layer": "color", "quality": 90, "rest": True, **camera})
    data = client.receive()[1]
    return hashlib.sha256(data[24 + 4 * struct.unpack("<6I", data[:24])[5]:]).hexdigest()


def settled(client, camera):
    """The picture once it stays the same."""
    shown, end = picture(client, camera), time.monotonic() + WAIT_S
    while time.monotonic() < end:
        time.sleep(1)
        before, shown = shown, picture(client, camera)
        if shown == before:
            return shown
    raise TimeoutError("the picture goes on changing")


def wait_for(client, camera, wanted):
    end = time.monotonic() + WAIT_S
    while picture(client, camera) != wanted:
        if time.monotonic() > end:
            raise TimeoutError("another picture than what the cameras show")
        time.sleep(0.2)


def feed(out, frames, live):
    """Cameras that show the walking figure, 25 pictures a second."""
    return subprocess.Popen([ORIEL, "synth", "figures", "--out", out, "--cameras", "5", "--frames", str(frames),
                             "--size", "96x72", "--live", live, "--quiet"], stdout=subprocess.DEVNULL)


def large(png):
    """The same picture in more bytes than a pipe holds by itself, which are 64 KiB."""
    text = b"tEXt" + b"Comment\0" + bytes([32]) * 200000
    return png[:-12] + struct.pack(">I", len(text) - 4) + text + struct.pack(">I", zlib.crc32(text)) + png[-12:]


class Live(unittest.TestCase):
    def test_pictures_follow_the_cameras(self):
        live, played, said = (os.path.join(WORK, name) for name in ("live", "played", "said.txt"))
        os.mkdir(live)
        with open(said, "w") as log:
            walk = Walk(ORIEL, SCENE, "--live", live, stderr=log)
        self.addCleanup(walk.process.kill)
        manifest = json.loads(walk.get("/manifest.json")[1])
        self.assertTrue(manifest["follows"])
        client, camera = Client(walk), camera_of(manifest)
        still = picture(client, camera) # before the first time step: the scene's own
        feeder = feed(played, FRAMES, live)
        seen = []
        while feeder.poll() is None:
            seen.append(picture(client, camera))
        self.assertEqual(feeder.returncode, 0)
        last = settled(client, camera)
        self.assertNotIn(last, (still, seen[0]))
        self.assertGreater(len(set(seen)), 2)
        # A time step that lacks a camera is left out and said; the next one shows.
        def copy(time_step, cameras, source=0):
            for c in cameras:
                name = os.path.join(live, f"cam{c:02d}", f"{time_step:05d}.png")
                shutil.copy(os.path.join(played, f"images/cam{c:02d}/{source:05d}.png"), name + ".part")
                os.rename(name + ".part", name)
        copy(FRAMES, (0, 1, 3, 4))
        time.sleep(0.5)
        self.assertEqual(picture(client, camera), last)
        # The first time step of the figure is the still scene's picture.
        self.assertNotEqual(still, last)
        copy(FRAMES + 1, (0, 1, 2, 3, 4))
        wait_for(client, camera, still)
        client.close()
        self.assertEqual(walk.close(), 0)
        with open(said) as log:
            text = log.read()
        self.assertIn(f"cam02: no picture {FRAMES}", text)
        steps, rate, drawn, latency = re.search(
            r"live: (\d+) time steps, ([\d.]+) a second; (\d+) drawn, a median of (\d+) ms", text).groups()
        print(f"{steps} of {FRAMES + 1} time steps, {drawn} drawn, {latency} ms after their last picture")
        self.assertGreater(int(drawn), 2)
        self.assertLessEqual(int(steps), FRAMES + 1)
        self.assertGreater(int(latency), 0)

    def test_pipes_are_read(self):
        live, played, said = (os.path.join(WORK, name) for name in ("pipes", "piped", "said_pipes.txt"))
        os.mkdir(live)
        pipes = [os.path.join(live, f"cam{c:02d}") for c in range(5)]
        for pipe in pipes:
            os.mkfifo(pipe)
        with open(said, "w") as log:
            walk = Walk(ORIEL, SCENE, "--live", live, stderr=log)
        self.addCleanup(walk.process.kill)
        client, camera = Client(walk), camera_of(json.loads(walk.get("/manifest.json")[1]))
        still = picture(client, camera)
        self.assertEqual(feed(played, 10, live).wait(), 0)
        end = time.monotonic() + WAIT_S
        while picture(client, camera) == still:
            self.assertLess(time.monotonic(), end, "no picture comes through the pipes")
        # One program writes for all cameras in turn, and no picture waits for its reader.
        def write_all():
            for c, pipe in enumerate(pipes):
                with open(os.path.join(played, f"images/cam{c:02d}/00000.png"), "rb") as source, open(pipe, "wb") as to:
                    to.write(large(source.read()))
        end = time.monotonic() + WAIT_S
        while picture(client, camera) != still:
            self.assertLess(time.monotonic(), end, "another picture than what the cameras show")
            walk.process.send_signal(signal.SIGSTOP)
            writer = threading.Thread(target=write_all, daemon=True)
            writer.start()
            writer.join(WAIT_S)
            waits = writer.is_alive()
            walk.process.send_signal(signal.SIGCONT)
            self.assertFalse(waits, "a large picture waits until the pipe is read")
            time.sleep(0.2)
        client.close()
        self.assertEqual(walk.close(), 0)
        with open(said) as log:
            steps, latency = re.search(r"live: (\d+) time steps.* of (\d+) ms after", log.read()).groups()
        print(f"{steps} time steps from pipes, {latency} ms after their last picture")
        self.assertGreater(int(latency), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
