#!/usr/bin/python3
"""Time in the walk: the server's time steps, and the page that plays them, from the server and from static files.
Made by tests/e2e/walk_time_steps.sh: test_time_steps.py ORIEL SCENE SITE [SCREENSHOT]."""
import json
import os
import shutil
import struct
import sys
import tempfile
import time
import unittest

from browser import Browser, Server
from client import Client, Walk

ORIEL, SCENE, SITE = sys.argv[1:4]


class TimeSteps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.walk = Walk(ORIEL, SCENE)
        manifest = json.loads(cls.walk.get("/manifest.json")[1])
        photo = manifest["photos"][0]
        rows = photo["cam_from_world"]
        cls.time_steps = manifest["time_steps"]
        cls.camera = {"size": [photo["width"], photo["height"]], "focal": [photo[key] for key in ("fx", "fy", "cx", "cy")],
                      "r": [value for row in rows for value in row[:3]],
                      "eye": [-sum(row[k] * row[3] for row in rows) for k in range(3)]}

    @classmethod
    def tearDownClass(cls):
        assert cls.walk.close() == 0, "the server does not end well"

    def picture(self, client, time_steps):
        request = {"number": 1, "layer": "color", "quality": 90, "rest": True, **self.camera}
        client.send({**request, **({"time_steps": time_steps} if time_steps else {})})
        opcode, data = client.receive()
        self.assertEqual(opcode, 2)
        missing, picks = struct.unpack("<6I", data[:24])[4:]
        self.assertEqual(missing, 0)
        return data[24 + 4 * picks:]

    def test_each_time_step_is_its_own(self):
        self.assertEqual(self.time_steps, 3)
        client = Client(self.walk)
        pictures = [self.picture(client, [i, i]) for i in range(3)]
        self.assertEqual(len(set(pictures)), 3)
        # In any order, alone or made ahead, and as the first without a wish.
        self.assertEqual(self.picture(client, [0, 2]), pictures[0])
        self.assertEqual(self.picture(client, [2, 1]), pictures[2])
        self.assertEqual(self.picture(client, [1, 1]), pictures[1])
        self.assertEqual(self.picture(client, None), pictures[0])
        self.assertEqual(self.picture(client, [99, 99]), pictures[2])
        client.close()

    def test_data_of_the_site_do_not_depend_on_what_clients_look_at(self):
        client, said = Client(self.walk), {}
        looks = {"number": 2, "layer": "color", "quality": 90, "time_steps": [1, 1], **self.camera}
        self.picture(client, [2, 2])
        client.send({"site": True})
        while "ready" not in said:
            client.send(looks)
            opcode, data = client.receive()
            said = json.loads(data).get("site", {}) if opcode == 1 else said
            self.assertNotIn("problem", said)
        for file in ("photos/00000.jpg", "photos/00003.jpg", "steps/00001/photos/00003.jpg", "steps/00002/photos/00003.jpg"):
            with open(f"{SITE}/{file}", "rb") as published:
                self.assertEqual(self.walk.get(f"/site/{file}")[1], published.read(), file)
        client.close()

    def test_no_time_step_before_the_first(self):
        for bad in ([-1, 0], [0], "now", [0, 1e300]):
            client = Client(self.walk)
            client.send({"number": 1, "layer": "color", "quality": 90, "time_steps": bad, **self.camera})
            self.assertEqual(client.receive()[0], 8)
            client.socket.close()

    def test_the_page_plays(self):
        browser = Browser(640, 480)
        self.addCleanup(browser.close)
        browser.open(self.walk.address)
        browser.settle()
        self.assertFalse(browser.js("return document.getElementById('time-steps').hidden"))
        play = "document.querySelector('#time-steps button').click()"
        browser.js("window.seen = new Set(); const {timeSteps} = oriel, tell = timeSteps.tell.bind(timeSteps); "
                   "timeSteps.tell = () => { seen.add(timeSteps.timeStep); tell(); };" + play)
        browser.wait("return seen.size === 3") # again and again
        # The viewer moves while time runs.
        browser.js("oriel.navigator.goTo(oriel.photos[1]); seen.clear(); oriel.wake()")
        browser.wait("return seen.size === 3 && oriel.navigator.at === oriel.photos[1]")
        browser.js(play + "; oriel.timeSteps.show(2)")
        browser.settle()
        self.assertEqual(browser.js("return document.querySelector('#time-steps output').textContent"), "3 / 3")
        self.assertFalse(browser.js("return oriel.timeSteps.playing"))
        # What no longer repeats goes on from where it is, however many rounds have passed.
        self.assertEqual(browser.js(
            "const {timeSteps} = oriel, loop = document.querySelector('#time-steps input[type=checkbox]'); "
            "timeSteps.show(0); timeSteps.toggle(); timeSteps.since -= 10000; loop.click(); timeSteps.advance(); "
            "const {timeStep} = timeSteps; timeSteps.show(2); loop.click(); return timeStep"), 0)
        browser.settle()
        self.assertEqual(browser.errors(), [])
        if len(sys.argv) > 4:
            browser.screenshot(sys.argv[4])

    def test_a_site_plays_from_static_files(self):
        server = Server(SITE)
        self.addCleanup(server.close)
        browser = Browser(384, 288)
        self.addCleanup(browser.close)
        browser.open(server.address)
        browser.js("oriel.navigator.setView(oriel.navigator.view, null); oriel.navigator.goTo(oriel.photos[1])")
        browser.settle()
        # The page says how much there is to load: each file once, without thumbnails.
        self.assertEqual(*browser.js(
            "const {manifest, moving, allBytes} = oriel.picture, {points} = manifest; "
            "const files = [points.coarse, ...points.files, ...moving.steps.flatMap(step => step.files)]; "
            "const bytes = new Map(files.map(file => [file.file, file.bytes])); "
            "return [allBytes, [...bytes.values()].reduce((a, b) => a + b)]"))
        # In any order, each time step at a photograph's place looks like its own photograph best.
        for shown in (2, 0, 1):
            browser.js(f"oriel.timeSteps.show({shown})")
            browser.settle()
            off = browser.driver.execute_async_script(DIFFERENCES)
            self.assertEqual(off.index(min(off)), shown, off)
            self.assertLess(off[shown], 4, off)
        browser.js("window.seen = new Set(); const {moving} = oriel.picture, put = moving.put.bind(moving); "
                   "moving.put = renderer => { put(renderer); seen.add(moving.shown); }; oriel.timeSteps.toggle()")
        browser.wait("return seen.size === 3")
        browser.js("oriel.timeSteps.toggle()")
        browser.settle()
        # A graphics chip that has room for two photographs gets those that the view wants.
        browser.js("const {photos} = oriel.picture.renderer; photos.slots = 2; "
                   "oriel.photos.forEach(photo => photo.slot = -1); oriel.timeSteps.show(0)")
        for photo in range(4):
            browser.js(f"oriel.navigator.goTo(oriel.photos[{photo}])")
            browser.settle()
            self.assertEqual(*browser.js(
                "const {wanted} = oriel.picture, here = oriel.photos.filter(photo => photo.slot >= 0), "
                "numbers = list => list.map(photo => photo.number).sort(); return [numbers(wanted), numbers(here)]"))
            self.assertEqual(browser.js("return oriel.picture.wanted[0].number"), photo)
        browser.js("oriel.timeSteps.show(1); oriel.navigator.goTo(oriel.photos[1])")
        browser.settle()
        off = browser.driver.execute_async_script(DIFFERENCES)
        self.assertEqual(off.index(min(off)), 1, off)
        self.assertEqual(browser.errors(), [])

    def test_a_time_step_that_is_missing_is_said_once(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        shutil.copytree(SITE, f"{folder.name}/site")
        os.remove(f"{folder.name}/site/steps/00001/photos/00001.jpg")
        with open(f"{folder.name}/site/steps/00002/depth/00000.png", "wb") as file:
            file.write(b"no picture")
        server = Server(f"{folder.name}/site")
        self.addCleanup(server.close)
        browser = Browser(384, 288)
        self.addCleanup(browser.close)
        browser.open(server.address)
        browser.js("window.rounds = window.said = 0; const {timeSteps} = oriel, tell = timeSteps.tell.bind(timeSteps); "
                   "timeSteps.tell = () => { rounds += timeSteps.timeStep === 0; tell(); }; "
                   "new MutationObserver(() => said++).observe(document.getElementById('problem'), {childList: true}); "
                   "timeSteps.toggle()")
        browser.wait("return said > 0 && oriel.picture.moving.steps.filter(step => step.broken).length === 2")
        browser.js("rounds = 0")
        browser.wait("return rounds > 20")
        browser.js("oriel.timeSteps.show(1)")
        browser.settle()
        self.assertEqual(browser.js("return oriel.picture.moving.shown"), 0)
        said = browser.errors()
        for what in ("photos/00001.jpg could not be loaded", "could not be decoded"):
            self.assertEqual(sum(what in error for error in said), 1, said)


# Mean differences, of 255, of the picture to the second photograph of each time step.
DIFFERENCES = """
const done = arguments[0];
(async () => {
    const pixels = async (source, width, height) => {
        const canvas = Object.assign(document.createElement("canvas"), {width, height});
        canvas.getContext("2d").drawImage(source, 0, 0, width, height);
        return canvas.getContext("2d").getImageData(0, 0, width, height).data;
    };
    const picture = await oriel.picture.capture(oriel.windowCamera(1), 0), {width, height} = picture;
    const shown = await pixels(picture, width, height), all = [];
    for (const step of oriel.picture.moving.steps) {
        const file = await fetch(step.photos[1].picture.file);
        const photo = await pixels(await createImageBitmap(await file.blob()), width, height);
        all.push(photo.reduce((sum, value, i) => sum + Math.abs(value - shown[i]), 0) / photo.length * 4 / 3);
    }
    oriel.wake();
    done(all);
})().catch(error => done([String(error)]));
"""


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
