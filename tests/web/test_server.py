#!/usr/bin/python3
"""The walk's server and its page. Made by tests/e2e/walk.sh: test_server.py ORIEL TOOL SCENE RADIANCE."""
import json
import os
import socket
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from browser import Browser
from client import Client, Walk as Program

ORIEL, TOOL, SCENE, RADIANCE = sys.argv[1:5]
TEMPORARY = tempfile.mkdtemp(dir=os.path.dirname(SCENE)) # of the server alone
WIDTH, HEIGHT = 360, 240
CLIENTS = 20


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Walk(Program):
    def __init__(self, *options, scene=SCENE):
        super().__init__(ORIEL, scene, *options, env={**os.environ, "TMPDIR": TEMPORARY})


def opens(walk, path="/live", **headers):
    client = Client(walk, path, **headers)
    client.close()
    return client.open


class Server(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.walk = Walk()
        cls.camera = json.loads(run(TOOL, "cameras", SCENE))[0]

    @classmethod
    def tearDownClass(cls):
        assert cls.walk.close() == 0, "the server does not end well"

    def request(self, number, **changes):
        c = self.camera
        return {"number": number, "size": [c["width"], c["height"]],
                "focal": [c["fx"], c["fy"], c["cx"], c["cy"]], "r": c["r"], "eye": c["eye"],
                "layer": "color", "quality": 80, **changes}

    def frame(self, client):
        opcode, data = client.receive()
        self.assertEqual(opcode, 2)
        number, _, width, height, _, picks = struct.unpack("<6I", data[:24])
        self.assertEqual(data[24 + 4 * picks:][:2], b"\xff\xd8")
        return number, width, height

    def complete(self, client, **changes):
        """Header, depths and JPEG of a frame for which all photographs are there."""
        while True:
            header, data = client.frame(self.request(1, rest=True, **changes))
            if header[4] == 0:
                return header, data

    def told(self, client, message):
        client.send(message)
        opcode, data = client.receive()
        self.assertEqual(opcode, 1)
        return json.loads(data)

    def works(self):
        client = Client(self.walk)
        client.send(self.request(7))
        self.assertEqual(self.frame(client), (7, self.camera["width"], self.camera["height"]))
        client.close()

    def test_files(self):
        for path, start in (("/", b"<!DOCTYPE"), ("/js/main.js", b"//"), ("/manifest.json", b"{"),
                            ("/photos/00000.jpg", b"\xff\xd8"), ("/thumbs/00005.jpg", b"\xff\xd8")):
            status, body = self.walk.get(path)
            self.assertEqual(status, 200, path)
            self.assertTrue(body.startswith(start), path)

    def test_no_other_files(self):
        for path in ("/../../../../../../etc/passwd", "/js/../js/main.js/..", "/%2e%2e/etc/passwd",
                     "/photos/00008.jpg", "/photos/0.jpg", "/photos/-0001.jpg", "//etc/passwd",
                     "/points.ply", "/photos/../scene.json", "/" + "a" * 900):
            self.assertIn(self.walk.get(path)[0], (400, 403, 404, 414), path)
        self.works()

    def test_other_origins_and_names_are_refused(self):
        self.assertEqual(self.walk.get("/manifest.json", Host="evil.example")[0], 403)
        self.assertEqual(self.walk.get("/manifest.json", Origin="http://evil.example")[0], 403)
        self.assertFalse(opens(self.walk, Origin="http://evil.example"))
        self.assertFalse(opens(self.walk, Host="evil.example"))
        for scheme in ("http", "https"): # the latter: of a proxy
            self.assertTrue(opens(self.walk, Origin=f"{scheme}://{self.walk.host}:{self.walk.port}"))
        self.assertFalse(opens(self.walk, Origin=f"file://{self.walk.host}:{self.walk.port}"))
        for host in ("LOCALHOST", "localhost."):
            self.assertEqual(self.walk.get("/manifest.json", Host=f"{host}:{self.walk.port}")[0], 200)

    def test_methods_that_change_nothing(self):
        for method in ("PUT", "DELETE", "OPTIONS", "POST", "PATCH"):
            answer, _ = self.walk.ask(method, "/manifest.json")
            self.assertEqual((answer.status, answer.getheader("Allow")), (405, "GET, HEAD"), method)
        answer, body = self.walk.ask("HEAD", "/js/main.js")
        self.assertEqual((answer.status, body), (200, b""))
        self.assertGreater(int(answer.getheader("Content-Length")), 1000)
        self.works()

    def test_other_sites_neither_frame_nor_show_it(self):
        for path in ("/", "/photos/00000.jpg", "/none"):
            answer, _ = self.walk.ask("GET", path)
            self.assertIn("frame-ancestors 'self'", answer.getheader("Content-Security-Policy"), path)
            self.assertEqual([answer.getheader(name) for name in (
                "X-Content-Type-Options", "Cross-Origin-Resource-Policy", "Referrer-Policy")],
                ["nosniff", "same-origin", "no-referrer"], path)
        walk = Walk("--embed-in", "https://museum.example")
        try:
            self.assertIn("frame-ancestors 'self' https://museum.example",
                          walk.ask("GET", "/")[0].getheader("Content-Security-Policy"))
        finally:
            walk.close()

    def test_frames(self):
        client = Client(self.walk)
        for number, layer in enumerate(("color", "depth", "normal", "coverage", "points")):
            client.send(self.request(number, layer=layer))
            self.assertEqual(self.frame(client)[0], number)
        client.send(self.request(9, size=[60, 40]))
        self.assertEqual(self.frame(client), (9, 60, 40))
        client.close()

    def test_the_newest_request_is_answered(self):
        client = Client(self.walk)
        # In one go: the server finds all of them, or all but a few, before it draws.
        client.send_all([self.request(number) for number in range(12)])
        numbers = []
        while not numbers or numbers[-1] != 11:
            numbers.append(self.frame(client)[0])
        self.assertEqual(numbers, sorted(numbers))
        self.assertLess(len(numbers), 12)
        client.close()

    def test_garbage_is_refused(self):
        bad = [b"", b"{", b"[]", b"\x00\xff", b'{"number": 1}', self.request(-1),
               self.request(1, size=[0, 0]), self.request(1, size=[100000, 100000]),
               self.request(1, size=[4000, 4000]), self.request(1, size=["a", 3]),
               self.request(1, focal=[0, 0, 0, 0]), self.request(1, focal=[1e308, 1, 1, 1e300]),
               self.request(1, r=[1] * 9), self.request(1, eye=[1, 2]), self.request(1, layer="x"),
               self.request(1, quality=0), self.request(1, quality=1e99),
               self.request(1, tone="x"), self.request(1, tone=1), self.request(1, ev=99),
               self.request(1, picks=[[0, 9999]]), self.request(1, picks=[[0, 0]] * 257),
               {"method": "oriel"}, {"method": "oriel", "set": [1]}, {"method": "oriel", "set": ["a=b"] * 65}]
        for message in bad:
            client = Client(self.walk)
            client.send(message)
            self.assertEqual(client.closed_for(), 1007, message)
            client.close()
        client = Client(self.walk)
        client.send(b"\x00" * 50, opcode=2)
        self.assertEqual(client.closed_for(), 1003)
        self.works()

    def test_methods_and_options_are_chosen(self):
        methods = json.loads(self.walk.get("/manifest.json")[1])["methods"]
        self.assertIn("airieau", [m["name"] for m in methods["list"]])
        tolerance = next(o for o in methods["options"] if o["key"] == "depth_tolerance")
        self.assertEqual((tolerance["least"], tolerance["most"]), (1e-5, 0.5))
        client, other = Client(self.walk), Client(self.walk)
        first, before = methods["chosen"], self.complete(client)
        told = self.told(client, {"method": "airieau", "set": ["depth_tolerance=0.02"]})
        self.assertEqual((told["choice"]["name"], told["problem"]), ("airieau", ""))
        self.assertEqual(told["choice"]["values"]["depth_tolerance"], "0.02")
        self.assertNotEqual(self.complete(client)[1], before[1])
        self.assertEqual(self.complete(other)[1], before[1]) # the choice is that of one client
        # As the command line says it, and nothing has changed.
        for settings, problem in ((["depth_tolerance=7"], "from 1e-05 to 0.5"), (["x=1"], "option x is not known"),
                                  (["photos_per_pixel=2"], "does not read it"), (["weight"], "must be KEY=VALUE")):
            wrong = self.told(client, {"method": "airieau", "set": settings})
            self.assertIn(problem, wrong["problem"])
            self.assertEqual(wrong["choice"], told["choice"])
        self.assertIn("not known", self.told(client, {"method": "none", "set": []})["problem"])
        self.assertEqual(self.told(client, {"method": first["name"], "set": []})["choice"], first)
        self.assertEqual(self.complete(client)[1], before[1])
        # What cannot be drawn in this scene, which has no mesh, ends neither client nor server.
        self.told(client, {"method": "airieau", "set": ["proxy=mesh"]})
        client.send(self.request(5))
        told = json.loads(client.receive()[1])
        self.assertTrue(told["problem"])
        self.assertEqual(told["choice"], first)
        self.assertEqual(self.frame(client)[0], 5)
        client.close()
        other.close()

    def test_frames_tell_what_is_asked(self):
        client = Client(self.walk)
        size = self.camera["width"], self.camera["height"]
        client.send(self.request(2, measure=True, picks=[[0, 0], [size[0] // 2, size[1] // 2]]))
        figures = json.loads(client.receive()[1])["figures"]
        names = [name for name, _ in figures["passes"]]
        self.assertIn("gather", names)
        self.assertTrue(all(ms >= 0 for _, ms in figures["passes"]))
        self.assertGreater(figures["memory"]["photographs"], 0)
        header = client.receive()[1]
        self.assertEqual(struct.unpack("<I", header[20:24])[0], 2)
        self.assertGreater(struct.unpack("<2f", header[24:32])[1], 0)
        plain, drago = self.complete(client)[1], self.complete(client, tone="drago")[1]
        self.assertNotEqual(plain, drago)
        self.assertNotEqual(plain, self.complete(client, ev=1.5)[1])
        client.close()
        points = self.walk.get("/map.bin")[1]
        self.assertGreater(len(points), 16 * 1000)
        self.assertEqual(len(points) % 16, 0)

    def test_data_of_the_site_are_made_when_asked_for(self):
        client, other = Client(self.walk), Client(self.walk)
        self.assertEqual(self.walk.get("/site/manifest.json")[0], 404)
        said = [self.told(client, {"site": True})["site"]]
        other.send({"site": True}) # while they are made, or after
        while "ready" not in said[-1]:
            self.assertGreater(said[-1]["total"], 0)
            said.append(json.loads(client.receive()[1])["site"])
        while "ready" not in json.loads(other.receive()[1])["site"]:
            pass
        manifest = json.loads(self.walk.get("/site/manifest.json")[1])
        own = json.loads(self.walk.get("/manifest.json")[1])
        names = [p["name"] for p in manifest["photos"]]
        self.assertEqual(names, [p["name"] for p in own["photos"] if not p["held_out"]])
        self.assertEqual(names, [p["name"] for p in own["photos"]][:len(names)])
        for file in (manifest["photos"][0]["picture"], manifest["photos"][0]["depth"], manifest["points"]["coarse"]):
            self.assertEqual(len(self.walk.get(f"/site/{file['file']}")[1]), file["bytes"])
        for path in ("/site/", "/site/index.html", "/site/js/main.js", "/site/none", "/site//etc/passwd"):
            self.assertEqual(self.walk.get(path)[0], 404, path)
        self.assertEqual(os.listdir(TEMPORARY), []) # all of it is in memory
        client.send({"site": "x"})
        self.assertEqual(client.closed_for(), 1007)
        client.close()
        other.close()
        self.works()

    def test_settings_are_saved_with_the_scene(self):
        view = {"cam_from_world": [[1, 0, 0, 0.1], [0, 1, 0, 0.2], [0, 0, 1, 0.3]], "fov_y_deg": 50}
        settings = {"title": "Arch", "tour": {"keyframes": [view] * 2000},
                    "notes": [{"title": "a", "position": [1, 2, 3], "text": "\n" * 4000}] * 200}
        client = Client(self.walk)
        client.send({"save": settings}) # as much as there may be
        self.assertEqual(json.loads(client.receive()[1])["saved"], True)
        client.send({"save": {"modes": []}})
        self.assertEqual(json.loads(client.receive()[1])["saved"], False)
        client.close()
        with open(f"{SCENE}/walk.json") as file:
            self.assertEqual(json.load(file), settings)
        manifest = json.loads(self.walk.get("/manifest.json")[1])
        self.assertEqual((manifest["title"], manifest["walk"]), ("Arch", settings))
        self.assertIn(b"<title>Arch</title>", self.walk.get("/")[1])
        os.remove(f"{SCENE}/walk.json")
        self.works()

    def test_a_path_is_rendered(self):
        client = Client(self.walk)
        client.send({"render": {"keyframes": [{"photo": self.camera["name"]}]}, "format": "png"})
        said = []
        while not said or said[-1]["done"] < said[-1]["total"]:
            said.append(json.loads(client.receive()[1])["rendering"])
        self.assertEqual(said[-1]["total"], 1)
        self.assertTrue(said[-1]["file"].endswith("renders/001"))
        with open(f"{SCENE}/renders/001/00000.png", "rb") as file:
            head = file.read(24)
        self.assertEqual((int.from_bytes(head[16:20], "big"), int.from_bytes(head[20:24], "big")), (1280, 720))
        client.send({"render": {"keyframes": [{"photo": "none"}]}, "format": "mp4"})
        self.assertTrue(json.loads(client.receive()[1])["rendering"]["problem"])
        self.assertEqual(sorted(os.listdir(f"{SCENE}/renders")), ["001", "001.path.json"])
        client.close()
        shutil.rmtree(f"{SCENE}/renders")
        self.works()

    def test_oversized_messages_are_refused(self):
        client = Client(self.walk)
        try:
            client.send(b" " * 4000000)
        except OSError:
            pass # closed while it was sent
        self.assertIn(client.closed_for(), (0, 1009))
        self.works()

    def test_many_clients_are_all_served(self):
        clients = [Client(self.walk) for _ in range(CLIENTS)]
        for number, client in enumerate(clients):
            client.send(self.request(number, size=[64, 48]))
        for number, client in enumerate(clients):
            self.assertEqual(self.frame(client)[0], number)
            client.close()

    def test_clients_that_go_or_do_not_read(self):
        for _ in range(5):
            client = Client(self.walk)
            client.send(self.request(1))
            client.close() # in the middle of a frame
        lazy = Client(self.walk)
        for number in range(50):
            lazy.send(self.request(number, quality=100))
        self.works()
        half = socket.create_connection((self.walk.host, int(self.walk.port)))
        half.sendall(b"GET / HT")
        self.works()
        half.close()
        lazy.close()


class Token(unittest.TestCase):
    def test_other_addresses_ask_for_a_token(self):
        walk = Walk("--host", "0.0.0.0")
        try:
            token = walk.address.split("token=")[1]
            self.assertEqual(len(token), 32)
            self.assertEqual(walk.get("/manifest.json")[0], 403)
            self.assertEqual(walk.get("/photos/00000.jpg?token=" + "0" * 32)[0], 403)
            self.assertEqual(walk.get("/photos/99999.jpg")[0], 403) # what there is not, either
            self.assertEqual(walk.get(f"/photos/99999.jpg?token={token}")[0], 404)
            self.assertEqual(walk.get("/js/main.js")[0], 200)
            self.assertEqual(walk.get(f"/manifest.json?token={token}", Host="any.example")[0], 200)
            client = Client(walk, f"/live?token={token}") # may not change anything
            client.send({"save": {"title": "x"}})
            self.assertEqual(client.closed_for(), 1007)
            client.close()
            self.assertFalse(os.path.exists(f"{SCENE}/walk.json"))
            client = Client(walk, f"/live?token={token}")
            client.send(b" " * 200000)
            self.assertIn(client.closed_for(), (0, 1009))
            client.close()
            self.assertFalse(opens(walk))
            self.assertTrue(opens(walk, f"/live?token={token}"))
        finally:
            self.assertEqual(walk.close(), 0)


class Radiance(unittest.TestCase):
    def test_shows_what_hdr_gives(self):
        walk, work = Walk(scene=RADIANCE), tempfile.TemporaryDirectory()
        try:
            client, c = Client(walk), json.loads(run(TOOL, "cameras", RADIANCE))[0]
            request = {"number": 1, "size": [c["width"], c["height"]], "r": c["r"], "eye": c["eye"], "rest": True,
                       "focal": [c["fx"], c["fy"], c["cx"], c["cy"]], "layer": "color", "quality": 100}
            # Dark enough to show the sky that most photographs clip, and bright enough for the shade.
            for ev, tone in ((-3, "filmic"), (0, "srgb"), (3, "drago")):
                header, jpeg = client.frame({**request, "ev": ev, "tone": tone})
                while header[4] > 0:
                    header, jpeg = client.frame({**request, "ev": ev, "tone": tone})
                shown, own = f"{work.name}/shown.jpg", f"{work.name}/own.png"
                with open(shown, "wb") as file:
                    file.write(jpeg)
                run(ORIEL, "hdr", RADIANCE, "--at", c["name"], "--out", own, f"--exposure={ev}", "--tone", tone, "--quiet")
                self.assertGreaterEqual(float(run(TOOL, "compare", shown, own).split()[0]), 40, (ev, tone))
            # A path is rendered with the exposure and tone that frames have.
            client.send({"render": {"keyframes": [{"photo": c["name"]}]}, "format": "png", "ev": -3, "tone": "filmic"})
            said = json.loads(client.receive()[1])["rendering"]
            while said["done"] < said["total"]:
                said = json.loads(client.receive()[1])["rendering"]
            run(ORIEL, "hdr", RADIANCE, "--at", c["name"], "--size", "1280x720", "--out", own, "--exposure=-3",
                "--tone", "filmic", "--quiet")
            self.assertGreaterEqual(float(run(TOOL, "compare", f"{RADIANCE}/renders/001/00000.png", own).split()[0]), 60)
            client.send({"render": {"keyframes": [{"photo": c["name"]}]}, "format": "png", "tone": "none"})
            self.assertEqual(client.closed_for(), 1007)
            client.close()
        finally:
            walk.close()
            work.cleanup()


class Page(unittest.TestCase):
    def draws_by_itself(self, browser, camera, work):
        """The switch to the published page's renderer and back, while the layer is depth."""
        server, own = f"{work}/server.png", f"{work}/browser.png"
        browser.js("document.querySelector('input[name=drawer][value=browser]').click()")
        browser.wait("return !oriel.picture.remote")
        browser.settle()
        layers = browser.js("return oriel.picture.layers")
        self.assertIn("source", layers) # which the server does not show
        self.assertEqual(layers[browser.js("return oriel.layer")], "depth")
        self.assertTrue(browser.js("return document.getElementById('tool-method').disabled"))
        browser.js("oriel.setLayer(0)")
        browser.capture(own, camera)
        browser.js("document.querySelector('input[name=drawer][value=server]').click()")
        browser.wait("return oriel.picture.remote")
        browser.settle()
        browser.capture(server, camera)
        self.assertFalse(browser.js("return document.getElementById('tool-method').disabled"))
        self.assertTrue(browser.js("return document.getElementById('own').hidden"))
        self.assertGreaterEqual(float(run(TOOL, "compare", own, server).split()[0]), 30)

    def test_page(self):
        walk, browser, work = Walk(), Browser(WIDTH, HEIGHT), tempfile.TemporaryDirectory()
        try:
            browser.open(walk.address)
            camera = json.loads(run(TOOL, "cameras", SCENE))[0]
            page, own = f"{work.name}/page.png", f"{work.name}/own.png"
            browser.capture(page, camera)
            run(ORIEL, "render", SCENE, "--at", camera["name"], "--out", own, "--quiet")
            self.assertGreaterEqual(float(run(TOOL, "compare", page, own).split()[0]), 34)
            before = browser.js("return oriel.navigator.view.eye")
            shown = browser.js("return oriel.picture.shown.number")
            browser.keys("KeyA", "a", f"return oriel.navigator.view.eye[0] !== {before[0]!r}")
            browser.settle()
            self.assertGreater(browser.js("return oriel.picture.shown.number"), shown)
            # Sharp again: as many pixels as the window has.
            self.assertEqual(browser.js("return [oriel.picture.shown.width, oriel.picture.shown.height]"),
                             [WIDTH, HEIGHT])
            browser.keys("KeyL", "l")
            browser.wait("return oriel.layer === 1")
            browser.settle()
            self.draws_by_itself(browser, camera, work.name)
            browser.js("oriel.notes.title.value = 'Here'; return oriel.notes.place(180, 120)")
            browser.wait("return oriel.notes.said.textContent === 'Saved.'")
            browser.wait("return !!document.querySelector('.mark:not([hidden])')") # the next frame places it
            x, y = browser.js("""
                const mark = document.querySelector(".mark"), box = mark.getBoundingClientRect();
                return [box.x + box.width / 2, box.y + box.height / 2];""")
            self.assertAlmostEqual(x, 180, delta=1.5)
            self.assertAlmostEqual(y, 120, delta=1.5)
            browser.js("return oriel.notes.change({start: oriel.notes.settings.notes[0].view})")
            home = browser.js("return oriel.navigator.view")
            browser.driver.get("about:blank")
            browser.open(walk.address)
            self.assertEqual(browser.js("return document.querySelectorAll('.mark').length"), 1)
            begins = browser.js("return oriel.navigator.home")
            for a, b in zip(home["eye"], begins["eye"]):
                self.assertAlmostEqual(a, b, places=5)
            for key, value in home["frame"].items():
                self.assertAlmostEqual(begins["frame"][key], value, places=5)
            os.remove(f"{SCENE}/walk.json")
            # Windows that are longer, or lower, than what the server draws: it would close the connection.
            sizes = browser.js("""
                return [[9000, 180], [20, 10], [0, 0]].map(([width, height]) => {
                    Object.assign(window, {innerWidth: width, innerHeight: height});
                    const camera = oriel.windowCamera(0.5);
                    return [camera.width, camera.height];
                });""")
            self.assertEqual(sizes, [[2048, 41], [16, 16], [16, 16]])
            self.assertEqual(browser.errors(), [])
        finally:
            browser.close()
            walk.close()
            work.cleanup()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[5:], verbosity=2)
