#!/usr/bin/python3
"""The published page in a headless Chromium. Made by tests/e2e/publish.sh:
test_page.py ORIEL TOOL SCENE SITE SINGLE, SITE two folders below the served one."""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from browser import Browser, Server

ORIEL, TOOL, SCENE, SITE, SINGLE = sys.argv[1:6]
WIDTH, HEIGHT = 360, 240 # of the photographs' aspect, with room beside the tools
LEAST_MOVE = 0.002       # of a held key, shares of the scene's distance
# dB, least PSNR of the page to the renderer. The page's photographs and depth maps are compressed, so that a few cells
# choose another guessed depth.
AGREES = 38


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def psnr(a, b):
    return float(run(TOOL, "compare", a, b).split()[0])


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.TemporaryDirectory()
        cls.server = Server(os.path.dirname(os.path.dirname(SITE)))
        cls.path = os.path.relpath(SITE, os.path.dirname(os.path.dirname(SITE)))
        cls.address = f"{cls.server.address}/{cls.path}/"
        cls.browser = Browser(WIDTH, HEIGHT)
        cls.browser.open(cls.address)
        cls.cameras = json.loads(run(TOOL, "cameras", SCENE))
        with open(f"{SITE}/manifest.json") as file:
            cls.manifest = json.load(file)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.server.close()
        cls.work.cleanup()

    def setUp(self):
        # As a visitor finds it.
        self.browser.js("""
            const nav = oriel.navigator;
            nav.setMode("walk");
            nav.speed = [0, 0, 0];
            nav.calm = true; // no flights
            nav.flight = null;
            nav.setView(nav.home, nav.photos[oriel.manifest.start]);
            oriel.wake();""")
        self.browser.settle()

    def reopen(self, address):
        """A new document, even where only what follows the # differs."""
        self.browser.driver.get("about:blank")
        self.browser.open(address)

    def tearDown(self):
        self.assertEqual(self.browser.errors(), [])

    def view(self):
        return self.browser.js("return oriel.navigator.view")

    def file(self, name):
        return f"{self.work.name}/{name}"

    def moved(self, before):
        """Along right, down and forward of the view before, in scene units."""
        now = self.view()
        by = [b - a for a, b in zip(before["eye"], now["eye"])]
        return [sum(before["r"][3 * i + k] * by[k] for k in range(3)) for i in range(3)]

    def turned(self, before):
        """Angle between the two views' directions, radians."""
        cosine = sum(a * b for a, b in zip(before["r"][6:], self.view()["r"][6:]))
        return math.acos(max(-1.0, min(1.0, cosine)))

    def hold(self, code, key):
        """Until the view has moved by a share of the scene's distance."""
        eye = self.view()["eye"]
        self.browser.keys(code, key, f"""
            const d = oriel.navigator.view.eye.map((x, k) => x - {json.dumps(eye)}[k]);
            return Math.hypot(...d) > {LEAST_MOVE} * oriel.manifest.distance;""")
        self.browser.settle()

    def press(self, key, code):
        self.browser.keys(code, key)
        self.browser.settle()

    # --- the picture ---

    def test_agrees_with_the_renderer(self):
        test = [c for c in self.cameras if c["test"]]
        for camera in test[:1] + self.cameras[:1]:
            name = camera["name"]
            page, own = self.file("page.png"), self.file("own.png")
            self.browser.capture(page, camera)
            run(ORIEL, "render", SCENE, "--at", name, "--out", own, "--quiet")
            self.assertGreaterEqual(psnr(page, own), AGREES, name)

    def both_with(self, name, camera, change):
        """What page and renderer show once `change` has edited manifest.json of the site and scene.json."""
        scene, site = self.file(name), f"{os.path.dirname(SITE)}/{name}"
        shutil.copytree(SCENE, scene)
        shutil.copytree(SITE, site)
        for file in f"{scene}/scene.json", f"{site}/manifest.json":
            with open(file) as opened:
                content = json.load(opened)
            change(content)
            with open(file, "w") as opened:
                json.dump(content, opened)
        page, own = self.file(f"{name}.png"), self.file(f"own-{name}.png")
        try:
            self.reopen(self.address.replace(self.path, os.path.relpath(site, os.path.dirname(os.path.dirname(SITE)))))
            self.browser.capture(page, camera)
        finally:
            self.reopen(self.address)
            shutil.rmtree(site)
        run(ORIEL, "render", scene, "--at", camera["name"], "--out", own, "--quiet")
        return page, own

    def test_a_backdrop_rests_as_in_the_renderer(self):
        camera = next(c for c in self.cameras if c["test"])
        moves = self.file("moves.png")
        self.browser.capture(moves, camera)
        rests, own = self.both_with("rests", camera, lambda content: content.update(backdrop="rests"))
        self.assertGreaterEqual(psnr(rests, own), AGREES)
        self.assertGreaterEqual(psnr(rests, own), psnr(moves, own) + 3)

    def test_depths_are_tried_as_in_the_renderer(self):
        def change(content):
            content.setdefault("options", {})["guess_depths"] = 0

        camera = next(c for c in self.cameras if c["test"])
        without, _ = self.both_with("without", camera, change)
        tried, own = self.both_with("tried", camera, lambda content: None)
        self.assertGreaterEqual(psnr(tried, own), AGREES)
        self.assertGreaterEqual(psnr(tried, own), psnr(without, own) + 1)

    def test_soft_splats_correct_as_in_the_renderer(self):
        camera = next(c for c in self.cameras if c["test"])
        scene, site = self.file("soft"), f"{os.path.dirname(SITE)}/soft"
        shutil.copytree(SCENE, scene)
        run(ORIEL, "refine", scene, "--steps", "4", "--splats", "3000", "--size-divide", "2", "--quiet")
        with open(f"{scene}/scene.json") as file:
            content = json.load(file)
        content["tuned"]["oriel"]["settings"] = {"soft": 1, "soft_mix": 0.5}
        with open(f"{scene}/scene.json", "w") as file:
            json.dump(content, file)
        run(ORIEL, "publish", scene, "--out", site, "--quiet")
        shutil.copytree(f"{SITE}/js", f"{site}/js", dirs_exist_ok=True) # the page that is tested
        shutil.copy(f"{SITE}/shaders.json", site)
        soft, own = self.file("soft.png"), self.file("own-soft.png")
        try:
            self.reopen(self.address.replace(self.path, os.path.relpath(site, os.path.dirname(os.path.dirname(SITE)))))
            self.browser.capture(soft, camera)
            self.browser.js("oriel.picture.renderer.draw(arguments[0], 0, false)", camera)
            self.assertTrue(self.browser.js("""
                const {finished, frame} = oriel.picture.renderer;
                return finished === frame.composed.textures[0];""")) # while the view moves
        finally:
            self.reopen(self.address)
            shutil.rmtree(site)
        run(ORIEL, "render", scene, "--at", camera["name"], "--out", own, "--quiet")
        self.assertGreaterEqual(psnr(soft, own), 43) # 24 without splats

    def test_the_window_shows_the_picture(self):
        window, picture = self.file("window.png"), self.file("picture.png")
        style = "document.body.style.visibility = '%s'; document.getElementById('canvas').style.visibility = '%s'"
        self.browser.js(style % ("hidden", "visible")) # without what lies over it
        self.browser.screenshot(window)
        self.browser.js(style % ("", ""))
        self.browser.capture(picture, self.browser.js("return oriel.windowCamera(1)"))
        self.assertGreaterEqual(psnr(window, picture), 35)

    def test_normals_face_the_viewer(self):
        blue = self.browser.js("""
            return oriel.picture.capture(oriel.windowCamera(1), 2).then(canvas => {
                const {width, height} = canvas;
                return Array.from(canvas.getContext("2d").getImageData(0, 0, width, height).data)
                    .filter((byte, i, all) => i % 4 === 2 && all[i - 1] + all[i - 2] + byte > 0);
            });""")
        self.assertGreater(len(blue), WIDTH * HEIGHT / 4)
        self.assertLess(sorted(blue)[len(blue) // 2], 64) # 128 stands for 0

    def test_held_out_photographs_are_not_published(self):
        names = [photo["name"] for photo in self.manifest["photos"]]
        self.assertEqual(names, [c["name"] for c in self.cameras if not c["test"]])
        self.assertEqual(len(os.listdir(f"{SITE}/photos")), len(names))

    def test_draws_something_before_photographs_are_there(self):
        camera = self.cameras[0]
        points = self.file("points.png")
        self.browser.capture(points, camera, 5)
        self.assertGreaterEqual(psnr(points, f"{SCENE}/images/{camera['name']}"), 14)

    def test_unseen_surfaces_have_the_points_colours_until_all_is_loaded(self):
        camera = dict(self.cameras[0])
        r, eye, far = camera["r"], camera["eye"], 2 * self.manifest["distance"]
        # From the other side, where photographs do not show all that is seen.
        camera["eye"] = [x + far * forward for x, forward in zip(eye, r[6:])]
        camera["r"] = [-x for x in r[:3]] + r[3:6] + [-x for x in r[6:]]
        whole, loading = self.file("whole.png"), self.file("loading.png")
        self.browser.capture(whole, camera)
        self.browser.js("oriel.picture.renderer.photos.slots += 1")
        try:
            self.browser.capture(loading, camera)
        finally:
            self.browser.js("oriel.picture.renderer.photos.slots -= 1")
        self.assertLess(psnr(whole, loading), 50) # where they always have them or never, the two are the same

    def test_depth_may_be_millions_of_times_the_nearest(self):
        depths = self.browser.js("""
            const {photos: store, device} = oriel.picture.renderer, gl = device.gl, photo = store.ready[0];
            const packed = new Uint8ClampedArray(4 * photo.depth.width * photo.depth.height), codes = [1, 20001, 24001, 32767];
            for (let i = 0; i < packed.length; i += 4)
                packed.set([codes[i / 4 % 4] >> 8, codes[i / 4 % 4] & 255, 0, 255], i);
            const image = new ImageData(packed, photo.depth.width, photo.depth.height), kept = store.depth;
            store.depth = device.texture("R16F", image.width, image.height, {layers: store.slots});
            store.writeDepth(photo, image, 0);
            const read = new Float32Array(16);
            gl.readPixels(0, 0, 4, 1, gl.RGBA, gl.FLOAT, read);
            device.release(store.depth);
            store.depth = kept;
            store.describe(oriel.windowCamera(1), 1);
            const unit = store.rowData[4 * 8 + 1] / store.ready[0].depth.nearest;
            return codes.map((code, i) => [read[4 * i] * unit, Math.exp((code - 1) / photo.depth.steps_per_fold)]);""")
        for stored, said in depths:
            self.assertIsNotNone(stored, "infinite")
            self.assertAlmostEqual(stored / said, 1, delta=1e-3)

    def test_layers_differ(self):
        seen = set()
        for layer in range(6): # the points come last
            picture = self.file("layer.png")
            self.browser.capture(picture, self.cameras[0], layer)
            with open(picture, "rb") as file:
                seen.add(file.read())
        self.assertEqual(len(seen), 6)
        self.press("l", "KeyL")
        self.assertEqual(self.browser.js("return oriel.layer"), 1)
        self.browser.js("oriel.setLayer(0)")

    # --- movement ---

    def test_keys_move(self):
        for mode in ("1", "2"):
            self.press(mode, f"Digit{mode}")
            for code, key, axis, sign in (("KeyW", "w", 2, 1), ("KeyS", "s", 2, -1),
                                          ("ArrowRight", "ArrowRight", 0, 1), ("KeyA", "a", 0, -1)):
                before = self.view()
                self.hold(code, key)
                self.assertGreater(sign * self.moved(before)[axis], 0, f"mode {mode}, {key}")
        before = self.view()
        self.hold("KeyE", "e")
        self.assertLess(self.moved(before)[1], 0)

    def test_drag_looks(self):
        before = self.view()
        self.browser.drag((150, 70), (120, 70), (90, 70))
        self.browser.settle()
        # The scene follows the pointer: to the left, so the view turns right.
        now, focal = self.view(), before["frame"]["fx"] * HEIGHT
        self.assertAlmostEqual(self.turned(before), 2 * math.atan(30 / focal), delta=0.05)
        self.assertGreater(sum(before["r"][k] * now["r"][6 + k] for k in range(3)), 0)
        self.assertEqual(before["eye"], now["eye"])

    def test_wheel_moves_forward(self):
        before = self.view()
        self.browser.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {
            "type": "mouseWheel", "x": 100, "y": 75, "deltaX": 0, "deltaY": -120})
        self.browser.wait(f"return oriel.navigator.view.eye[0] !== {before['eye'][0]!r}")
        self.browser.settle()
        self.assertGreater(self.moved(before)[2], 0)

    def test_orbit_keeps_the_middle(self):
        self.browser.js("""
            const nav = oriel.navigator, {view} = nav, aside = 0.2 * nav.distance;
            nav.setMode("orbit"); // visitors of this site have no key for it
            nav.setView({...view, eye: view.eye.map((x, k) => x + aside * view.r[k])});""")
        self.browser.settle()
        before = self.browser.js("return oriel.navigator.choosePivot()")
        self.browser.drag((120, 70), (150, 70))
        self.browser.settle()
        self.assertEqual(before, self.browser.js("return oriel.navigator.pivot"))
        x = self.browser.js("""
            const c = oriel.windowCamera(1), p = oriel.navigator.pivot;
            const d = p.map((v, k) => v - c.eye[k]);
            const q = [0, 1, 2].map(i => [0, 1, 2].reduce((s, k) => s + c.r[3 * i + k] * d[k], 0));
            return c.fx * q[0] / q[2] + c.cx;""")
        self.assertAlmostEqual(x, WIDTH / 2, delta=2)

    def test_walkers_stay_near_photographs(self):
        # Up to where steps get shorter, and a good while longer: each frame moves the walker on.
        self.browser.keys("KeyS", "s", "return oriel.navigator.farOut")
        self.browser.js("""
            window.framesLeft = 12;
            oriel.onFrame = () => framesLeft--;""")
        self.browser.keys("KeyS", "s", "return framesLeft <= 0")
        self.browser.js("oriel.onFrame = null")
        self.browser.settle()
        self.assertLess(self.browser.js("return oriel.navigator.outness"), 1.0)

    def test_gamepad_moves(self):
        before = self.view()
        self.browser.js("""
            const pad = {axes: [0, -1, 0, 0], buttons: []};
            oriel.getPads = navigator.getGamepads;
            navigator.getGamepads = () => [pad];
            window.dispatchEvent(new Event("gamepadconnected"));""")
        self.browser.wait(f"return oriel.navigator.view.eye[2] !== {before['eye'][2]!r}")
        self.browser.js("navigator.getGamepads = () => []; delete oriel.getPads;")
        self.browser.settle()
        self.assertGreater(self.moved(before)[2], 0)

    # --- paths and measurements ---

    def rendered(self, path, name):
        """The first frame of a path as `oriel render` draws it."""
        with open(self.file(f"{name}.json"), "w") as file:
            json.dump(path, file)
        run(ORIEL, "render", SCENE, "--path", self.file(f"{name}.json"), "--out", self.file(name),
            "--quiet")
        return f"{self.file(name)}/00000.png"

    def test_path_is_recorded_edited_and_saved(self):
        self.press("r", "KeyR")
        self.browser.js("oriel.navigator.browse(1)")
        self.press("r", "KeyR")
        self.assertFalse(self.browser.js("return document.getElementById('path').hidden"))
        rows = "return document.querySelectorAll('#path li').length"
        self.assertEqual(self.browser.js(rows), 2)
        self.browser.js("document.querySelectorAll('#path li')[0].querySelectorAll('button')[3].click()")
        keys = self.browser.js("return oriel.path.keys.map(k => k.eye)")
        self.assertEqual(keys[1], self.browser.js("return oriel.navigator.home.eye"))
        home = self.browser.js("return oriel.manifest.photos[oriel.manifest.start].name")
        own = self.file("own.png")
        run(ORIEL, "render", SCENE, "--at", home, "--out", own, "--quiet")
        for kind in ("oriel", "nerfstudio"):
            path = self.browser.js(f"""
                return import("./js/path_files.js").then(m => m.{kind}Path([oriel.path.keys[1]], 1));""")
            if kind == "nerfstudio": # its size is that of a video
                path["render_width"], path["render_height"] = self.size(own)
            self.assertGreaterEqual(psnr(self.rendered(path, kind), own), 32, kind)
        many = self.browser.js("""
            return import("./js/path_files.js").then(m => m.orielPath(oriel.path.keys, 2));""")
        self.assertEqual((many["frames"], len(many["keyframes"])), (49, 2))
        # The time between keyframes, by the field in their row, as the program has it.
        both = self.browser.js("""
            oriel.path.add();
            const seconds = document.querySelectorAll("#path .seconds");
            seconds[0].value = 1;
            seconds[0].dispatchEvent(new Event("change"));
            return Promise.all([import("./js/path_files.js"), import("./js/keyframes.js")]).then(([f, k]) => [
                f.orielPath(oriel.path.keys, oriel.path.duration), k.viewAt(oriel.path.keys, 0.125).eye]);""")
        self.assertEqual([key["seconds"] for key in both[0]["keyframes"]], [1, 3, 3])
        self.assertEqual(both[0]["frames"], 4 * 24 + 1)
        self.assertEqual(len(both[1]), 3)
        self.browser.js("document.querySelector('#path li:last-child button:last-child').click()")
        self.browser.js("""
            const slider = document.querySelector("#path input[type=range]");
            slider.value = 1;
            slider.dispatchEvent(new Event("input"));""")
        self.browser.settle()
        for own, key in zip(self.view()["eye"], keys[1]):
            self.assertAlmostEqual(own, key, places=9)
        self.browser.js("""
            document.querySelectorAll('#path li').forEach(() =>
                document.querySelector('#path li button:last-child').click());
            document.getElementById('path').hidden = true;""")
        self.assertEqual(self.browser.js(rows), 0)

    def opened(self, name, content):
        """The keyframes of the page, and what it says, after it was given this file."""
        with open(self.file(name), "w") as file:
            file.write(content)
        self.browser.js("oriel.path.said.textContent = ''")
        self.browser.driver.find_element("css selector", "#path input[type=file]").send_keys(self.file(name))
        self.browser.wait("return oriel.path.said.textContent !== ''")
        return self.browser.js("return [oriel.path.keys, oriel.path.said.textContent]")

    def test_saved_paths_are_opened_again(self):
        self.addCleanup(self.browser.js, "oriel.path.change(keys => keys.splice(0))")
        self.browser.js("""
            for (const seconds of [2, 0.5, 3]) {
                oriel.path.add();
                oriel.path.keys[oriel.path.keys.length - 1] = {...oriel.navigator.view, seconds};
                oriel.navigator.browse(1);
            }""")
        keys = self.browser.js("return oriel.path.keys")
        for kind in ("oriel", "nerfstudio"):
            saved = self.browser.js(f"""
                return import("./js/path_files.js").then(m => JSON.stringify(m.{kind}Path(oriel.path.keys, 2.5)));""")
            self.browser.js("oriel.path.change(keys => keys.splice(0, 3))")
            again, said = self.opened(f"{kind}.json", saved)
            self.assertIn(f"{kind}.json: 3 views", said)
            self.assertEqual([key["seconds"] for key in again[:2]], [2, 0.5]) # the last leads nowhere
            for a, b in zip(keys, again):
                for x, y in zip(a["eye"] + a["r"] + [a["frame"]["fy"]], b["eye"] + b["r"] + [b["frame"]["fy"]]):
                    self.assertAlmostEqual(x, y, places=6, msg=kind) # rotations are rounded
        # Frames without keyframes, the columns of older files, photographs by name, and places.
        photo, files = self.manifest["photos"][0], json.loads(saved)
        old = {**files, "keyframes": [{"fov": k["fov"], "matrix": json.dumps([k["matrix"][4 * j + i] for i in range(4)
                                       for j in range(4)])} for k in files["keyframes"]]}
        for content, count in ((old, 3), ({**files, "keyframes": []}, 61),
                               ({"keyframes": [{"photo": photo["name"]}, {"position": [0, 0, 0], "target": [0, 0, 1]}],
                                 "frames": 49}, 2)):
            again, said = self.opened("path.json", json.dumps(content))
            self.assertEqual(len(again), count, said)
            if content is old:
                for x, y in zip(keys[0]["eye"] + keys[0]["r"], again[0]["eye"] + again[0]["r"]):
                    self.assertAlmostEqual(x, y, places=6)
        self.assertEqual(again[1]["r"], [1, 0, 0, 0, 1, 0, 0, 0, 1])
        self.assertEqual([key["seconds"] for key in again], [2, 2])
        self.assertEqual(self.browser.js("return document.querySelectorAll('#path li').length"), 2)
        # What is no path leaves the one that is there.
        for content, problem in (("{", "not opened"), ("[1]", "neither"), ('{"keyframes": []}', "neither"),
                                 ('{"keyframes": [{"photo": "none"}]}', "view 1"),
                                 ('{"keyframes": [{"cam_from_world": [[1,0,0,0],[0,2,0,0],[0,0,1,0]]}]}', "view 1"),
                                 ('{"camera_path": [{"fov": 50, "camera_to_world": [1]}]}', "view 1")):
            kept, said = self.opened("bad.json", content)
            self.assertIn(problem, said)
            self.assertEqual(kept, again, content)

    def size(self, file):
        with open(file, "rb") as png:
            head = png.read(24)
        return int.from_bytes(head[16:20], "big"), int.from_bytes(head[20:24], "big")

    def test_benchmark(self):
        before = self.view()
        figures = self.browser.js("return import('./js/benchmark.js').then(m => m.benchmark(oriel, 1))")
        self.assertGreater(figures["frames"], 0)
        self.assertGreaterEqual(figures["frame_ms"]["longest"], figures["frame_ms"]["median"])
        self.browser.settle()
        self.assertEqual(self.view()["eye"], before["eye"])

    def test_exposure(self):
        dark, bright = self.file("dark.png"), self.file("bright.png")
        self.browser.capture(dark, self.cameras[0])
        self.browser.js("oriel.change(() => oriel.picture.setExposure(1))")
        self.browser.capture(bright, self.cameras[0])
        self.browser.js("oriel.change(() => oriel.picture.setExposure(0))")
        self.assertLess(psnr(dark, bright), 25)

    # --- what its maker says ---

    def test_settings_of_the_walk(self):
        self.assertEqual(self.browser.js("return document.getElementById('attribution').textContent"),
                         "Drawn by nobody")
        self.assertEqual(self.browser.js("return oriel.navigator.modes"), ["walk", "fly"])
        self.assertIsNone(self.browser.js("return document.getElementById('tool-orbit')"))
        self.assertIsNone(self.browser.js("return document.getElementById('tool-maker')"))

    def test_annotations_are_read(self):
        self.browser.js("document.querySelector('.mark').click()")
        note = self.browser.js("return document.getElementById('note').innerText")
        self.assertIn("Far <b>ahead</b>", note) # as text
        self.assertIn("Two.", note)
        self.browser.js("document.querySelector('#note button').click()")
        self.assertTrue(self.browser.js("return document.getElementById('note').hidden"))

    # --- photographs ---

    def test_snap_lands_on_the_photograph(self):
        self.browser.drag((150, 70), (140, 70))
        self.hold("KeyD", "d")
        self.assertIsNone(self.browser.js("return oriel.navigator.at"))
        self.browser.js("oriel.navigator.calm = false")
        self.press("p", "KeyP")
        at = self.browser.js("return oriel.navigator.at.name")
        camera = next(c for c in self.cameras if c["name"] == at)
        view = self.view()
        for a, b in zip(view["eye"] + view["r"], camera["eye"] + camera["r"]):
            self.assertAlmostEqual(a, b, places=5)
        # What the window shows is that photograph: it has the photograph's aspect.
        window = self.browser.js("return oriel.windowCamera(1)")
        for key in ("fx", "fy", "cx", "cy"):
            self.assertAlmostEqual(window[key], camera[key] * WIDTH / camera["width"], places=3)
        picture = self.file("snap.png")
        self.browser.capture(picture, {**camera, **self.browser.js(
            "const {r, eye} = oriel.windowCamera(1); return {r, eye}")})
        own = self.file("own.png")
        run(ORIEL, "render", SCENE, "--at", at, "--out", own, "--quiet")
        photo = f"{SCENE}/images/{at}"
        self.assertGreaterEqual(psnr(picture, photo), max(20, psnr(own, photo) - 1.5))

    def test_next_and_previous(self):
        names = [photo["name"] for photo in self.manifest["photos"]]
        start = self.browser.js("return oriel.navigator.at.number")
        self.press(".", "Period")
        self.assertEqual(self.browser.js("return oriel.navigator.at.name"), names[(start + 1) % len(names)])
        self.press(",", "Comma")
        self.press(",", "Comma")
        self.assertEqual(self.browser.js("return oriel.navigator.at.name"), names[start - 1])
        self.press("h", "KeyH")
        self.assertEqual(self.browser.js("return oriel.navigator.at.number"), start)

    def test_comparison_shows_the_photograph(self):
        self.press("c", "KeyC")
        self.browser.wait("return document.querySelector('#compare img').naturalWidth > 0")
        box = self.browser.js("""
            const {left, top, width, height} = document.querySelector('#compare img').getBoundingClientRect();
            return [left, top, width, height]""")
        self.assertEqual([round(x) for x in box], [0, 0, WIDTH, HEIGHT])
        # Of a camera that was held upright: the file lies on its side, and fills an upright frame.
        self.browser.js("oriel.photos[1].orientation = 6; oriel.navigator.goTo(oriel.photos[1]); oriel.wake()")
        self.browser.wait(f"return document.querySelector('#compare img').src.includes('{self.manifest['photos'][1]['picture']['file']}')")
        stored, upright = self.browser.js("""
            const image = document.querySelector('#compare img'), {width, height} = image.getBoundingClientRect();
            delete oriel.photos[1].orientation;
            return [[image.offsetWidth, image.offsetHeight], [width, height].map(Math.round)];""")
        self.assertEqual((stored, upright), ([HEIGHT, HEIGHT * HEIGHT // WIDTH], [HEIGHT * HEIGHT // WIDTH, HEIGHT]))
        self.press("c", "KeyC")
        self.assertTrue(self.browser.js("return document.getElementById('compare').hidden"))

    # --- the page ---

    def test_address_keeps_the_view(self):
        self.browser.drag((150, 70), (130, 60))
        self.browser.js("""
            const nav = oriel.navigator, {eye, r, frame} = nav.view;
            nav.setView({eye, r, frame: {...frame, aspect: 0.8, fx: 1.1 * frame.fy, x: 0.1, y: -0.05}});
            oriel.wake();""")
        self.browser.settle()
        before, address = self.view(), self.browser.address()
        self.assertIn("#v=", address)
        self.reopen(address)
        now = self.view()
        for a, b in zip(before["eye"] + before["r"], now["eye"] + now["r"]):
            self.assertAlmostEqual(a, b, places=4)
        for key, value in before["frame"].items():
            self.assertAlmostEqual(now["frame"][key], value, places=4)

    def test_bad_addresses_start_at_home(self):
        self.reopen(self.address + "#v=a,b,c,d,e,f,g,h")
        self.assertEqual(self.browser.js("return oriel.navigator.at.number"), self.manifest["start"])
        for hash_ in ("#v=1,2,3", "#p=999", "#v=0,0,0,0,0,0,0,1", "#v=0,0,0,0,0,0,1,1,1,1,0,9", "#mode=x"):
            self.browser.js("history.replaceState(null, '', arguments[0]); oriel.readAddress()", hash_)
            self.assertEqual(self.browser.js("return oriel.navigator.at.number"), self.manifest["start"])

    def test_keyboard_reaches_every_tool(self):
        ids = self.browser.js("return [...document.querySelectorAll('#tools button')].map(b => b.id)")
        self.assertGreaterEqual(len(ids), 15)
        for id_ in ids:
            label = self.browser.js(f"return document.getElementById('{id_}').getAttribute('aria-label')")
            self.assertTrue(label, id_)
            self.assertGreaterEqual(self.browser.js(f"return document.getElementById('{id_}').tabIndex"), 0)
        for key, code, panel in (("t", "KeyT", "thumbs"), ("m", "KeyM", "map"), ("i", "KeyI", "panel")):
            self.press(key, code)
            self.assertFalse(self.browser.js(f"return document.getElementById('{panel}').hidden"))
            if panel == "panel":
                self.assertIn("loaded", self.browser.js(
                    "return document.getElementById('figure-photos').textContent"))
            self.press(key, code)
        self.press("?", "Slash")
        self.assertTrue(self.browser.js("return document.getElementById('help').open"))
        self.browser.js("document.getElementById('help').close()")

    def test_missing_file_is_said(self):
        self.browser.js("oriel.files.schedule(() => 0, () => oriel.files.get('photos/none.jpg'))")
        self.browser.wait("return document.getElementById('problem').textContent !== ''")
        self.assertIn("none.jpg", self.browser.js("return document.getElementById('problem').textContent"))
        self.reopen(self.address)
        said = self.browser.errors() # the console tells of it no later than of another page's load
        self.assertTrue(said)
        self.assertEqual([line for line in said if "none.jpg" not in line], [])

    def test_opens_within_another_page(self):
        """As a museum embeds it: browsers forbid some things in another site's frame."""
        os.mkdir(self.file("museum"))
        with open(self.file("museum/index.html"), "w") as file:
            file.write(f"<!DOCTYPE html><link rel=icon href='data:,'><iframe src='{self.address}' width=340 height=220></iframe>")
        museum = Server(self.file("museum"))
        self.addCleanup(museum.close)
        self.browser.driver.get(museum.address)
        self.browser.driver.switch_to.frame(0)
        self.browser.settle()
        self.assertIsNone(self.browser.js("return document.getElementById('tool-full')")) # which it is not allowed
        self.browser.js("document.getElementById('tool-help').click()")
        self.assertEqual(self.browser.js("return document.activeElement.tagName"), "H2")
        self.browser.driver.switch_to.default_content()
        self.assertEqual(self.browser.errors(), [])
        self.reopen(self.address)

    def test_single_file_opens_from_disk(self):
        camera = self.cameras[0]
        served, single = self.file("served.png"), self.file("single.png")
        self.browser.capture(served, camera)
        self.reopen(f"file://{SINGLE}")
        self.browser.capture(single, camera)
        self.assertGreaterEqual(psnr(single, served), 50)
        count = "return document.querySelectorAll('#tools button, #panel *, #help *').length"
        tools = self.browser.js(count)
        with open(self.file("saved.html"), "w") as file: # by the browser, while it ran
            file.write(re.sub('"blob:[^"]*"', '"data:,"', self.browser.js("return document.documentElement.outerHTML")))
        self.reopen(f"file://{self.file('saved.html')}")
        self.assertEqual(self.browser.js(count), tools)
        self.reopen(self.address)


class Phone(unittest.TestCase):
    def test_fingers(self):
        server, browser = Server(SITE), Browser(360, 640, touch=True)
        try:
            browser.open(server.address)

            def view():
                return browser.js("return oriel.navigator.view")

            before = view()
            browser.touch([(200, 300)], [(150, 300)])
            browser.settle()
            one = view()
            self.assertEqual(one["eye"], before["eye"])
            self.assertNotEqual(one["r"], before["r"])
            browser.touch([(150, 300), (250, 300)], [(120, 300), (280, 300)])
            browser.settle()
            two = view()
            self.assertEqual(two["r"], one["r"])
            forward = sum((b - a) * f for a, b, f in zip(one["eye"], two["eye"], one["r"][6:]))
            self.assertGreater(forward, 0)
            browser.js("oriel.navigator.calm = true; oriel.navigator.goHome(); oriel.wake()")
            browser.settle()
            start, target = view(), browser.js("return oriel.pick(200, 300)")
            browser.tap(200, 300)
            browser.settle()
            self.assertEqual(view()["eye"], start["eye"])
            time.sleep(0.5) # or else the next one is the second
            browser.tap(200, 300, times=2)
            browser.wait(f"return oriel.navigator.view.eye[0] !== {start['eye'][0]!r}", 60)
            browser.settle()
            self.assertLess(math.dist(view()["eye"], target), 0.9 * math.dist(start["eye"], target))
            browser.js("document.getElementById('tool-help').click()")
            self.assertEqual(browser.js("""
                const {text} = await import("./js/strings.js"), rows = [...document.querySelectorAll("#help dt")];
                return rows.map(row => row.textContent.toLowerCase()).join() ===
                    text.help.map(([, , fingers]) => fingers).filter(Boolean).join();"""), True)
            self.assertEqual(browser.errors(), [])
        finally:
            browser.close()
            server.close()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[6:], verbosity=2)
