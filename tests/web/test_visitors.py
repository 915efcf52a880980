#!/usr/bin/python3
"""What visitors of comparable viewers report, on the published page and the live walk. Made by
tests/e2e/visitors.sh: test_visitors.py ORIEL TOOL SCENE SITE RADIANCE RADIANCE-SITE."""
import base64
import json
import math
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

from browser import Browser, CAPTURE, QuietHandler, Server, SETTLED, WAIT_S
from client import Walk as Program
import firefox

ORIEL, TOOL, SCENE, SITE, RADIANCE, RADIANCE_SITE = sys.argv[1:7]
AXE = os.environ.get("ORIEL_NODE_MODULES", "node_modules") + "/axe-core/axe.min.js"
WIDTH, HEIGHT = 360, 240
SIZES = ((320, 568), (360, 640), (390, 844), (480, 800), (600, 960), (640, 360), (768, 1024), (844, 390), (1024, 768),
         (1440, 900), (2560, 1440))


class Visitors(unittest.TestCase):
    """One browser and one server for all; each test begins with a new document."""
    @classmethod
    def setUpClass(cls):
        cls.server = Server(SITE)
        cls.browser = Browser(WIDTH, HEIGHT)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.server.close()

    def setUp(self):
        self.errors = 0 # that the console should hold

    def tearDown(self):
        if not self.errors:
            self.assertEqual(self.browser.errors(), [])
        self.browser.errors()
        self.browser.resize(WIDTH, HEIGHT)

    def open(self, query="", address=None):
        self.browser.driver.get("about:blank")
        self.browser.errors() # of a server that has ended meanwhile
        self.browser.open((address or self.server.address) + "/" + query)
        self.browser.js("oriel.navigator.calm = true")

    def js(self, script, *args):
        return self.browser.js(script, *args)

    def eye(self):
        return self.js("return oriel.navigator.view.eye")

    def moves(self, code, key):
        """Does a held key move?"""
        eye = self.eye()
        self.browser.keys(code, key)
        self.browser.settle()
        return self.eye() != eye

    def hint(self):
        return self.js("return document.getElementById('hint').textContent")

    def hidden(self, id_):
        return self.js(f"return document.getElementById('{id_}').hidden")

    def lay_out(self, *ids):
        """In windows of all sizes these panels, photographs and a note neither cover one another nor are cut."""
        self.js("""
            oriel.drawFrame = () => { oriel.refined = true; oriel.showState(); }; // where things are, without a picture
            oriel.navigator.at = null;
            oriel.compare.on = true; // for a hint""")
        for size in SIZES:
            self.browser.resize(*size)
            self.browser.wait(f"return innerWidth === {size[0]} && innerHeight === {size[1]}")
            found, columns = self.js(LAYOUTS, ids)
            self.assertEqual(found, [], size)
            self.assertLess(max(columns) - min(columns), len(columns) + 1, size) # no single one in a row
            self.assertGreaterEqual(self.js("return document.querySelector('#tools button').offsetWidth"), 24)


class Page(Visitors):
    def test_resized_at_rest(self):
        self.open()
        for width, height in ((300, 400), (400, 300)):
            self.browser.resize(width, height)
            self.browser.wait(f"return oriel.picture.renderer.frame.width === {width} && "
                              f"oriel.picture.canvas.height === {height}", 60)

    def test_other_pixels_at_rest(self):
        """On another screen a window may keep its size: then it hears of its pixels alone. Chromium tells of an
        imitated screen together with another size, which the page does not hear of here."""
        script = self.browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
            "source": "window.addEventListener('resize', event => event.stopImmediatePropagation());"})
        self.addCleanup(self.browser.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", script)
        self.open()
        for i, ratio in enumerate((2, 1.25, 1)): # each is watched for anew
            width = WIDTH + 4 * i + 4
            self.browser.resize(width, HEIGHT, ratio)
            self.browser.wait(f"return oriel.picture.renderer.frame.width === {round(ratio * width)} && "
                              f"oriel.picture.canvas.height === {round(ratio * HEIGHT)}", 60)

    def test_other_layouts(self):
        self.open()
        for code, key in (("KeyW", "ц"), ("KeyW", ","), ("KeyW", "z")): # Cyrillic, Dvorak, AZERTY
            self.assertTrue(self.moves(code, key), key)
        for code, key, id_ in (("KeyT", "е", "thumbs"), ("KeyI", "ш", "panel"), ("KeyM", "ь", "map"),
                               ("KeyV", "k", "path")): # of Dvorak, by its letter
            self.browser.keys(code, key)
            self.assertFalse(self.hidden(id_), id_)
        for code, key, mode in (("Digit2", "é", "fly"), ("Digit1", "+", "walk")): # French, Czech
            self.browser.keys(code, key)
            self.assertEqual(self.js("return oriel.navigator.mode"), mode)
        at = "return oriel.navigator.at && oriel.navigator.at.number"
        self.browser.keys("KeyH", "h")
        start = self.js(at)
        self.browser.keys("Period", "ю")
        self.assertNotEqual(self.js(at), start)
        self.browser.keys("Comma", "б")
        self.assertEqual(self.js(at), start)
        self.browser.keys("PageDown", "PageDown")
        self.assertNotEqual(self.js(at), start)
        self.browser.keys("PageUp", "PageUp") # of Dvorak, whose comma moves
        self.assertEqual(self.js(at), start)

    def test_command_key_of_a_mac(self):
        self.open()
        self.js("""
            const send = (kind, code, key, more) => window.dispatchEvent(
                new KeyboardEvent(kind, {code, key, bubbles: true, ...more}));
            document.body.dispatchEvent(new KeyboardEvent("keydown", {code: "KeyW", key: "w", bubbles: true}));
            document.body.dispatchEvent(
                new KeyboardEvent("keydown", {code: "MetaLeft", key: "Meta", metaKey: true, bubbles: true}));
            oriel.wake();""") # and no keyup of W, which a Mac does not send
        self.browser.settle() # comes to rest

    def test_keys_after_a_click_into_a_panel(self):
        self.open()
        self.browser.keys("KeyI", "i")
        for selector in ("#panel input[type=radio]", "#panel input[type=range]"):
            self.js(f"document.querySelector('{selector}').focus()")
            self.assertTrue(self.moves("KeyW", "w"), selector)
            eye = self.eye()
            self.browser.keys("ArrowRight", "ArrowRight")
            self.browser.settle()
            self.assertEqual(self.eye(), eye) # sets the slider
        self.browser.keys("Escape", "Escape")
        self.assertTrue(self.hidden("panel"))
        self.assertEqual(self.js("return document.activeElement.id"), "canvas")
        self.js("document.querySelector('.mark').click()")
        self.browser.keys("Escape", "Escape")
        self.assertTrue(self.hidden("note"))

    def test_double_click_goes_there(self):
        self.open()
        before = self.js("return oriel.navigator.view")
        target = self.js("return oriel.pick(200, 130)")
        self.browser.click(200, 130, times=2)
        self.browser.wait(f"return oriel.navigator.view.eye[0] !== {before['eye'][0]!r}", 60)
        self.browser.settle()
        far = lambda eye: math.dist(eye, target)
        self.assertLess(far(self.eye()), 0.9 * far(before["eye"]))
        self.assertLess(self.js("return oriel.navigator.outness"), 1)

    def test_pinch_on_a_mac(self):
        """Safari's own events, as Chromium lacks them."""
        self.open()
        fy = self.js("return oriel.navigator.view.frame.fy")
        prevented = self.js("""
            return [["gesturestart", 1], ["gesturechange", 1.2], ["gesturechange", 1.5]].map(([kind, scale]) =>
                !oriel.canvas.dispatchEvent(Object.assign(new Event(kind, {cancelable: true}), {scale})));""")
        self.assertEqual(prevented, [True] * 3)
        self.assertAlmostEqual(self.js("return oriel.navigator.view.frame.fy"), 1.5 * fy)

    def test_hints_stay(self):
        self.open()
        said = self.js("""
            oriel.pick = async () => null;
            await oriel.goThere(1, 1);
            oriel.showState();
            return document.getElementById("hint").textContent;""")
        self.assertIn("Nothing is known", said)
        self.browser.wait("return document.getElementById('hint').textContent === ''")

    def test_a_frame_that_fails(self):
        self.open()
        self.errors = 1
        self.js("""
            oriel.navigator.update = () => {
                delete oriel.navigator.update;
                throw new Error("once");
            };
            oriel.wake();""")
        self.browser.wait("return document.getElementById('problem').textContent !== ''")
        self.assertTrue(self.moves("KeyW", "w"))

    def test_lost_chip(self):
        self.open()
        self.errors = 1
        self.js("window.chip = oriel.picture.device.gl.getExtension('WEBGL_lose_context'); chip.loseContext()")
        self.browser.wait("return document.getElementById('hint').textContent.includes('taken away')")
        self.assertTrue(self.moves("KeyW", "w"))
        self.assertIn("taken away", self.hint())
        self.js("chip.restoreContext()")
        self.browser.wait("return !window.chip") # loaded again
        self.browser.settle()
        self.assertEqual(self.hint(), "")

    def test_photographs_too_large_for_the_chip(self):
        script = self.browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": """
            const {getParameter, MAX_TEXTURE_SIZE} = WebGL2RenderingContext.prototype;
            WebGL2RenderingContext.prototype.getParameter = function (key) {
                return key === MAX_TEXTURE_SIZE ? 100 : getParameter.call(this, key);
            };"""})
        self.addCleanup(self.browser.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", script)
        self.browser.open(self.server.address)
        self.assertIn("large", self.hint())

    def test_languages(self):
        for lang, words, close in (("de", "Fotos", "Schließen"), ("cs", "Fotografie", "Zavřít"), ("xx", "Photographs", "Close")):
            self.open(f"?lang={lang}")
            self.assertEqual(self.js("return document.getElementById('tool-thumbs').title"), f"{words} (T)")
            self.assertEqual(self.js("return document.querySelector('#help button').textContent"), close)
            self.assertEqual(self.js("return document.documentElement.lang"), lang if lang != "xx" else "en")
            # What a language lacks is English, and nothing that English lacks is translated.
            self.assertEqual(self.js("""
                return import("./js/strings.js").then(m => [typeof m.text.benchmark, m.text.help.length]);"""),
                ["string", 24])
        keys = self.js(HELP_KEYS) # of what there is: annotations to go through, but neither lengths nor a maker
        self.assertEqual([key in keys for key in ("G", "U", "N, O", "T, M, I")], [True, False, False, True])

    def test_tour_of_the_annotations(self):
        self.open()
        self.js("document.querySelector('.mark').click()")
        title = "return document.querySelector('#note h2').textContent"
        press = lambda words: self.js("""
            [...document.querySelectorAll('#note button')].find(b => b.textContent === arguments[0]).click()""", words)
        self.assertEqual(self.js(title), "Arch")
        press("Next")
        self.assertEqual(self.js(title), "Wall")
        press("Next")
        press("Previous")
        self.assertEqual(self.js(title), "Wall")
        press("Play as a tour")
        self.browser.wait(title.replace("return", "return 'Arch' ===")) # by itself
        press("Pause")
        self.assertEqual(self.js("return oriel.notes.tour"), 0)
        self.browser.keys("Escape", "Escape")
        self.assertTrue(self.hidden("note"))

    def test_panels_do_not_overlap(self):
        self.open()
        self.lay_out("panel", "map", "path")

    def test_screen_readers(self):
        """By axe-core, which visitors.sh takes from npm."""
        if not os.path.exists(AXE):
            self.skipTest("axe-core is missing, which npm installs: screen readers are not tested")
        self.open()
        with open(AXE) as file:
            self.js(file.read())
        self.js("oriel.toggle('thumbs'); oriel.toggle('map'); document.querySelector('.mark').click()")
        for id_ in ("panel", "path", "help"):
            if id_ == "help":
                self.browser.keys("Slash", "?")
            else:
                self.js(f"oriel.toggle('{id_}')")
            found = self.js("return axe.run().then(r => r.violations.map(v => [v.id, v.nodes.map(n => n.html)]))")
            self.assertEqual(found, [], id_)

    def test_wheel_within_another_page(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(f"{folder}/index.html", "w") as file:
                file.write("<!DOCTYPE html><link rel=icon href='data:,'><body style='height: 3000px; margin: 0'>"
                           f"<iframe src='{self.server.address}/' width=340 height=200></iframe>")
            museum = Server(folder)
            self.addCleanup(museum.close)
            self.browser.driver.get(museum.address)
            self.browser.driver.switch_to.frame(0)
            self.browser.settle()
            eye = self.eye()
            self.browser.wheel(100, 75, 120)
            self.browser.wait("return document.getElementById('hint').textContent !== ''")
            self.browser.driver.switch_to.default_content()
            self.browser.wait("return scrollY > 0")
            self.js("scrollTo(0, 0)")
            self.browser.driver.switch_to.frame(0)
            self.browser.settle()
            self.assertEqual(self.eye(), eye)

    def test_address_of_who_embeds(self):
        self.open("?start=2&mode=fly&ui=none")
        self.assertEqual(self.js("return [oriel.navigator.at.number, oriel.navigator.mode]"), [1, "fly"])
        self.assertEqual(self.js("return getComputedStyle(document.getElementById('tools')).display"), "none")
        self.assertIn("?start=2&mode=fly&ui=none", self.browser.address())
        self.browser.keys("KeyM", "m") # nothing would be seen of what it opens
        self.assertTrue(self.hidden("map"))
        name = self.js("return oriel.photos[1].name")
        for said in name, name.rpartition(".")[0]:
            self.open(f"?start={said}")
            self.assertEqual(self.js("return oriel.navigator.at.number"), 1)

    def test_strict_policy(self):
        server = Server(SITE, {"Content-Security-Policy": "default-src 'self'"})
        self.addCleanup(server.close)
        self.open(address=server.address)
        self.assertEqual(self.js("return document.getElementById('unstarted').getAnimations().length"), 0)

    def test_pages_that_cannot_start_say_so(self):
        self.open()
        saved = tempfile.NamedTemporaryFile("w", suffix=".html") # by the browser, while it ran
        self.addCleanup(saved.close)
        saved.write(self.js("return document.documentElement.outerHTML").replace('"js/', '"walk_files/'))
        saved.flush()
        for address, policy in ((f"file://{SITE}/index.html", None), (f"file://{saved.name}", None),
                                (None, "script-src 'none'")):
            server = Server(SITE, {"Content-Security-Policy": policy} if policy else {})
            self.addCleanup(server.close)
            self.browser.driver.get(address or server.address)
            self.browser.wait("""
                return getComputedStyle(document.getElementById("unstarted")).visibility === "visible";""")
            self.errors = 1

    def test_first_picture(self):
        """Nothing is drawn before the photograph of the start has come, and then with that one alone."""
        with open(f"{SITE}/manifest.json") as file:
            manifest = json.load(file)
        first = manifest["photos"][manifest["start"]]["picture"]["file"]
        come, more = threading.Event(), threading.Event()

        class Handler(QuietHandler):
            def do_GET(self):
                held = come if self.path == f"/{first}" else more if re.search("^/(photos|points/0)", self.path) else None
                if held:
                    held.wait(60)
                super().do_GET()

        server = Server(SITE, handler=Handler)
        self.addCleanup(server.close)
        self.addCleanup(lambda: [event.set() for event in (come, more)])
        self.browser.driver.get(server.address)
        self.browser.wait("return !!window.oriel")
        self.assertFalse(self.js("""
            for (let i = 0; i < 20; i++)
                await new Promise(done => requestAnimationFrame(done));
            return oriel.picture.renderer.frame !== null;"""))
        come.set()
        self.browser.wait("return document.getElementById('poster').classList.contains('away')")
        self.assertEqual(self.js("return oriel.picture.renderer.used"), 1)
        more.set()
        self.browser.settle()
        self.assertGreater(self.js("return oriel.picture.renderer.used"), 1)

    def test_headset(self):
        """A frame for each eye from the pose, by an imitation of WebXR that draws into the canvas."""
        self.open()
        self.assertIsNone(self.js("return document.getElementById('tool-headset')"))
        script = self.browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": HEADSET})
        self.addCleanup(self.browser.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", script)
        self.open()
        self.browser.wait("return document.getElementById('tool-headset') !== null")
        self.js("oriel.manifest.walk.unit_m = oriel.headset.units = 0.5; document.getElementById('tool-headset').click()")
        self.browser.wait("return window.headset.frame !== undefined")
        self.assertTrue(self.js("return oriel.headset.on"))
        self.js("headset.end()")
        self.js("""
            headset.requestReferenceSpace = async () => {
                delete headset.requestReferenceSpace;
                throw new Error("no space");
            };
            document.getElementById("tool-headset").click();""")
        self.browser.wait("return document.getElementById('hint').textContent.includes('no space')")
        self.assertFalse(self.js("return oriel.headset.on")) # the walk goes on
        self.js("delete headset.frame; document.getElementById('tool-headset').click()")
        self.browser.wait("return window.headset.frame !== undefined")
        start = self.eye()
        eyes = self.js(WEAR, 0)
        self.assertEqual(self.js("return oriel.navigator.view.eye"), start)
        up = self.js("return oriel.navigator.up")
        for side, (camera, picture) in zip((-1, 1), eyes):
            right, down, ahead = (camera["r"][3 * i:3 * i + 3] for i in range(3))
            for i in range(3): # half a unit a metre, the eyes 64 mm apart, the horizon level
                self.assertAlmostEqual(camera["eye"][i], start[i] + 0.5 * side * 0.032 * right[i], places=5)
                self.assertAlmostEqual(down[i], -up[i], places=5)
            self.assertGreater(sum(a * b for a, b in zip(ahead, self.js("return oriel.navigator.view.r.slice(6)"))), 0.9)
            # Each eye sees farther to its own side.
            self.assertEqual([round(camera[k], 3) for k in ("width", "height", "fx", "fy", "cx", "cy")],
                             [180, 240, 90, 120, 90 - side * 18, 120])
            self.assertLess(picture, 3) # of 255, to that camera's frame
        # Pushed ahead for half a second, then turned by a sixth of a half turn.
        before = eyes[0][0]
        ((camera, _), _) = self.js(WEAR, 500, {"left": [0, 0, 0, -1]})
        for i in range(3): # a frame stands for a tenth of a second at most
            self.assertAlmostEqual(camera["eye"][i] - before["eye"][i], 0.5 * 0.15 * before["r"][6 + i], places=5)
        ((turned, _), (other, _)) = self.js(WEAR, 600, {"right": [0, 0, 1, 0]})
        self.assertAlmostEqual(sum(a * b for a, b in zip(turned["r"][6:], camera["r"][:3])), math.sin(math.pi / 6), places=5)
        self.js("headset.end()")
        self.assertFalse(self.js("return oriel.headset.on"))
        self.browser.settle()
        for own, left, right in zip(self.eye(), turned["eye"], other["eye"]):
            self.assertAlmostEqual(own, (left + right) / 2, places=5)

    def test_requests_are_tried_again(self):
        """Of shaders, points and photographs, each first request is reset."""
        seen = set()

        class Handler(QuietHandler):
            def do_GET(self):
                path = self.path.split("?")[0]
                if path not in seen and re.search("^/(shaders|points|photos|manifest)", path):
                    seen.add(path)
                    self.connection.shutdown(socket.SHUT_RDWR)
                    self.close_connection = True
                else:
                    super().do_GET()

        server = Server(SITE, handler=Handler)
        self.addCleanup(server.close)
        self.errors = 1 # the browser tells of each
        self.open(address=server.address)
        self.assertGreater(len(seen), 8)
        self.assertEqual(self.js("return document.getElementById('problem').textContent"), "")

    def test_address_is_refused(self):
        """Safari takes a hundred addresses in half a minute; the walk goes on without."""
        self.open()
        self.js("""
            window.replace = history.replaceState;
            history.replaceState = () => { throw new DOMException("too often", "SecurityError"); };""")
        address = self.browser.address()
        self.assertTrue(self.moves("KeyW", "w"))
        self.assertEqual((self.browser.address(), self.js("return document.getElementById('problem').textContent")), (address, ""))
        self.js("history.replaceState = window.replace")
        self.assertTrue(self.moves("KeyW", "w"))
        self.assertNotEqual(self.browser.address(), address)

    def test_lost_connections(self):
        """Of shaders, points and photographs, the first request is never answered; the page's time runs fast."""
        lost, over = set(), threading.Event()

        class Handler(QuietHandler):
            def do_GET(self):
                kind = re.match("/(shaders|points/c|photos|depth)", self.path)
                if kind and kind[1] not in lost:
                    lost.add(kind[1])
                    over.wait(WAIT_S)
                else:
                    super().do_GET()

        server = Server(SITE, handler=Handler)
        self.addCleanup(server.close)
        self.addCleanup(over.set)
        fast = self.browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": """
            const wait = window.setTimeout;
            window.setTimeout = (run, ms) => wait(run, ms >= 30000 ? ms / 10 : ms);"""})["identifier"]
        self.addCleanup(lambda: self.browser.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument",
                                                                    {"identifier": fast}))
        self.open(address=server.address)
        self.assertEqual(len(lost), 4)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Radiance(unittest.TestCase):
    """A scene of several exposures: the page shows what `oriel hdr` gives, and every command the same."""
    def psnr(self, a, b):
        return float(run(TOOL, "compare", a, b).split()[0])

    def test_published_page(self):
        server, browser, work = Server(RADIANCE_SITE), Browser(240, 160), tempfile.TemporaryDirectory()
        try:
            browser.open(server.address)
            cameras = json.loads(run(TOOL, "cameras", RADIANCE))
            page, own = f"{work.name}/page.png", f"{work.name}/own.png"
            # Dark enough to show the sky that most photographs clip, and bright enough for the shade: the
            # unmerged photographs are 10 dB farther off.
            for camera, ev, tone in ((cameras[0], -3, "filmic"), (cameras[0], 0, "srgb"), (cameras[0], 3, "reinhard")):
                browser.js("oriel.picture.setExposure(arguments[0]); oriel.picture.setTone(arguments[1])", ev, tone)
                browser.capture(page, camera)
                run(ORIEL, "hdr", RADIANCE, "--at", camera["name"], "--out", own, f"--exposure={ev}", "--tone", tone,
                    "--quiet")
                self.assertGreaterEqual(self.psnr(page, own), 38, (ev, tone))
            # The file of a photograph, through the table of the comparison, is a picture to look at.
            browser.js("oriel.compare.setExposure(0)")
            tables = browser.js("return [...document.querySelectorAll('#shown feFuncR')].map(f => f.tableValues.baseVal.numberOfItems)")
            self.assertEqual(tables, [256])
            self.assertEqual(browser.js("return document.querySelectorAll('#panel select option').length"), 3)
            self.assertEqual(browser.errors(), [])
        finally:
            browser.close()
            server.close()
            work.cleanup()

    def brightest(self, screen):
        """Of the canvas, three stops up, on a screen whose dynamic range is "high" or "standard"."""
        server, browser = Server(RADIANCE_SITE), Browser(240, 160, flags=("--enable-experimental-web-platform-features",))
        try:
            browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": f"""
                const ask = window.matchMedia;
                window.matchMedia = query => query === "(dynamic-range: high)" ? {{matches: "{screen}" === "high"}} : ask(query);"""})
            browser.open(server.address)
            self.assertEqual(browser.errors(), [])
            return browser.js("""
                const {gl} = oriel.picture.device, camera = oriel.windowCamera(1), n = camera.width * camera.height;
                oriel.picture.setExposure(3);
                oriel.picture.draw(camera, camera, 0);
                const wide = gl.drawingBufferFormat === gl.RGBA16F, kind = wide ? Float32Array : Uint8Array, pixels = new kind(4 * n);
                gl.bindFramebuffer(gl.FRAMEBUFFER, null);
                gl.readPixels(0, 0, camera.width, camera.height, gl.RGBA, wide ? gl.FLOAT : gl.UNSIGNED_BYTE, pixels);
                return pixels.reduce((a, b) => Math.max(a, b)) / (wide ? 1 : 255);""")
        finally:
            browser.close()
            server.close()

    def test_bright_screens(self):
        """The browser is asked for what Chromium 156 has behind a flag; the screen is imitated."""
        self.assertGreater(self.brightest("high"), 1.5)
        self.assertEqual(self.brightest("standard"), 1)

    def test_render(self):
        with tempfile.TemporaryDirectory() as work:
            said = subprocess.run([ORIEL, "render", RADIANCE, "--at", "0001.jpg", "--out", f"{work}/a.png"],
                                  check=True, capture_output=True, text=True).stderr
            self.assertIn("several exposures", said)
            run(ORIEL, "hdr", RADIANCE, "--at", "0001.jpg", "--out", f"{work}/b.png", "--quiet")
            self.assertEqual(run("cmp", f"{work}/a.png", f"{work}/b.png"), "")
            run(ORIEL, "render", RADIANCE, "--at", "0001.jpg", "--radiance", "off", "--out", f"{work}/c.png", "--quiet")
            self.assertLess(self.psnr(f"{work}/b.png", f"{work}/c.png"), 30)


class Live(Visitors):
    def walk(self, port=0):
        walk = Program(ORIEL, SCENE, "--port", str(port))
        self.addCleanup(lambda: walk.process.poll() is None and walk.close())
        return walk

    def test_resized_at_rest(self):
        self.open(address=self.walk().address[:-1])
        self.browser.resize(300, 400)
        self.browser.wait("return oriel.picture.shown.width === 300 && oriel.picture.shown.height === 400", 60)

    def test_server_dies_and_returns(self):
        walk = self.walk()
        self.errors = 1
        self.open(address=walk.address[:-1])
        walk.process.kill()
        walk.process.wait()
        self.browser.wait("return document.getElementById('hint').textContent.includes('does not answer')", 20)
        self.js("window.saved = oriel.picture.save({title: 'Kept'}); saved.then(ok => window.saved = ok)")
        self.js("oriel.picture.render({keyframes: []}, 'png')")
        self.assertIn("does not answer", self.js("return oriel.path.said.textContent"))
        before = self.settings()
        self.addCleanup(self.restore, before)
        self.assertNotIn("Kept", before)
        with socket.create_server(("127.0.0.1", int(walk.port))): # lets the page connect, and never answers
            self.browser.wait("return oriel.picture.socket.readyState === WebSocket.CONNECTING", 20)
            self.js("oriel.change(() => {})")
        self.walk(walk.port)
        self.browser.wait("return window.saved === true", 60)
        with open(f"{SCENE}/walk.json") as file:
            self.assertEqual(json.load(file), {"title": "Kept"})
        self.browser.wait("return document.getElementById('hint').textContent === ''")
        self.browser.settle()
        self.assertEqual(self.js("return document.getElementById('problem').textContent"), "")

    def test_panels_do_not_overlap(self):
        self.open(address=self.walk().address[:-1])
        self.js("oriel.path.add()")
        self.lay_out("panel", "map", "path", "method", "maker", "ruler")

    def test_tour_and_lengths_of_the_maker(self):
        before = self.settings()
        self.addCleanup(self.restore, before)
        self.open(address=self.walk().address[:-1])
        for i in range(2):
            self.js("""
                const nav = oriel.navigator;
                nav.setView({...nav.view, eye: nav.view.eye.map((x, k) => x + (k ? 0 : arguments[0] * nav.distance))});
                oriel.path.add();""", 0.3 * i)
        self.js("""
            oriel.path.setDuration(600);
            const [key] = oriel.path.keys, {viewToSaved} = await import("./js/view.js");
            await oriel.notes.change({notes: [{title: "Here", position: [0, 0, 0], view: viewToSaved(key)}]});
            [...document.querySelectorAll("#path button")].find(b => b.textContent.includes("visitors")).click();
            oriel.ruler.ends = [[0, 0, 0], [0, 0, 2]];
            oriel.ruler.teach(5);""")
        self.browser.wait("return document.querySelector('#maker [role=status]').textContent === 'Saved.'")
        with open(f"{SCENE}/walk.json") as file:
            saved = json.load(file)
        self.assertEqual((saved["unit_m"], len(saved["tour"]["keyframes"])), (2.5, 2))
        # What a visitor meets.
        self.browser.open(self.browser.address().split("#")[0])
        self.browser.keys("KeyG", "g")
        self.browser.wait("return !document.getElementById('note').hidden")
        self.assertEqual(self.js("return [oriel.path.plays, document.querySelector('#note h2').textContent]"), [True, "Here"])
        self.browser.keys("KeyG", "g")
        self.assertFalse(self.js("return oriel.path.plays"))
        self.browser.keys("KeyU", "u")
        for x in (150, 210):
            self.browser.click(x, 130)
            self.browser.wait(f"return oriel.ruler.ends.length === {1 + (x > 200)}")
        metres = self.js("""
            const {distance} = await import("./js/math.js");
            return 2.5 * distance(...oriel.ruler.ends);""")
        said = self.js("return document.getElementById('length').textContent")
        self.assertAlmostEqual(float(said.split()[0]) / (100 if said.endswith("cm") else 1), metres, delta=0.02 * metres)
        self.browser.wait("return document.getElementById('line').points.numberOfItems === 2")
        self.follow_published_tour()

    def follow_published_tour(self):
        """What a visitor meets of it where no server draws."""
        with tempfile.TemporaryDirectory() as work:
            run(ORIEL, "publish", SCENE, "--out", f"{work}/site", "--quiet")
            server = Server(f"{work}/site")
            self.addCleanup(server.close)
            self.open(address=server.address)
            self.assertFalse(self.hidden("tool-tour"))
            start = self.eye()
            self.browser.keys("KeyG", "g")
            self.browser.wait("return !document.getElementById('note').hidden") # that the path passes
            self.browser.wait("return oriel.path.scrubber.value > 0")
            self.assertNotEqual(self.eye(), start)
            self.assertEqual(self.js("return document.getElementById('tool-tour').getAttribute('aria-pressed')"), "true")
            self.browser.keys("KeyG", "g")
            self.browser.settle() # comes to rest
            self.assertFalse(self.js("return oriel.path.plays"))
            self.js("oriel.path.scrubber.value = 0.5")
            self.browser.keys("KeyG", "g") # goes on from there, five minutes after the start
            self.browser.wait("return oriel.path.scrubber.value > 0.5", 60)
            self.browser.keys("KeyG", "g")

    def test_held_out_photographs_are_compared(self):
        self.open(address=self.walk().address[:-1])
        self.js("oriel.navigator.goTo(oriel.photos.find(p => p.held_out)); oriel.toggleCompare()")
        self.browser.wait("return document.getElementById('right-side').textContent === 'Photograph, held out'")
        self.assertEqual(self.js("return document.getElementById('left-side').textContent"), "Drawn")
        self.assertLessEqual({"G", "U", "N, O"}, set(self.js(HELP_KEYS)))

    def settings(self):
        with open(f"{SCENE}/walk.json") as file:
            return file.read()

    def restore(self, settings):
        with open(f"{SCENE}/walk.json", "w") as file:
            file.write(settings)

    def test_the_first_connection_fails(self):
        script = self.browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": """
            let tries = 0;
            window.WebSocket = class extends WebSocket {
                constructor(address, protocol) { super(address, tries++ ? protocol : "none"); }
            };"""})
        self.addCleanup(self.browser.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", script)
        self.errors = 1
        self.open(address=self.walk().address[:-1])
        self.assertEqual(self.hint(), "")

    def test_too_much_to_save(self):
        self.errors = 1
        self.open(address=self.walk().address[:-1])
        self.assertFalse(self.js("return oriel.picture.save({title: 'x'.repeat(5e6)})"))
        self.assertIsNone(self.js("return oriel.picture.unsaved"))

    def test_server_hangs(self):
        walk = self.walk()
        self.open(address=walk.address[:-1])
        walk.process.send_signal(signal.SIGSTOP)
        self.js("oriel.change(() => {})")
        self.browser.wait("return document.getElementById('hint').textContent.includes('hangs')", 30)
        walk.process.send_signal(signal.SIGCONT)
        self.browser.settle()
        self.assertEqual(self.hint(), "")


@unittest.skipUnless(firefox.PROGRAM, "firefox-esr is missing")
class Firefox(unittest.TestCase):
    def setUp(self):
        self.browser = firefox.Firefox(WIDTH, HEIGHT)
        self.addCleanup(self.browser.close)

    def open(self, address):
        self.browser.open(address)
        self.browser.wait(SETTLED)

    def test_live(self):
        walk = Program(ORIEL, SCENE)
        self.addCleanup(walk.close)
        self.open(walk.address)
        self.assertEqual(self.browser.js("return document.getElementById('poster').className"), "away")
        frame, name = self.browser.js("return [oriel.picture.shown.number, oriel.navigator.at.name]")
        self.browser.js("oriel.navigator.calm = true; document.getElementById('tool-next').click()")
        self.browser.wait(f"return oriel.picture.shown.number > {frame}")
        self.browser.wait(SETTLED)
        self.assertNotEqual(self.browser.js("return oriel.navigator.at.name"), name)

    def test_picture_or_album(self):
        """As the renderer draws it, or photographs and annotations where Firefox offers no WebGL."""
        server, browser = Server(SITE), self.browser
        self.addCleanup(server.close)
        self.open(server.address)
        text = "return document.getElementById(arguments[0]).textContent"
        self.assertEqual(browser.js(text, "problem"), "")
        if not browser.js("return Boolean(oriel.picture)"):
            self.assertIn("WebGL 2", browser.js(text, "hint"))
            self.assertIn("Arch", browser.js(text, "note"))
            self.assertGreater(browser.js("return document.querySelector('#album img').naturalWidth"), 0)
            return
        camera = json.loads(run(TOOL, "cameras", SCENE))[0]
        with tempfile.TemporaryDirectory() as work:
            with open(f"{work}/page.png", "wb") as file:
                file.write(base64.b64decode(browser.js(CAPTURE, camera, 0).split(",", 1)[1]))
            run(ORIEL, "render", SCENE, "--at", camera["name"], "--out", f"{work}/own.png", "--quiet")
            self.assertGreater(float(run(TOOL, "compare", f"{work}/page.png", f"{work}/own.png").split()[0]), 35)


class Without3d(unittest.TestCase):
    def test_photographs_and_notes(self):
        server, browser = Server(SITE), Browser(WIDTH, HEIGHT, flags=("--disable-3d-apis",))
        self.addCleanup(server.close)
        self.addCleanup(browser.close)
        browser.resize(360, 240)
        browser.open(server.address + "/")
        self.assertEqual(browser.js("return document.getElementById('over').scrollTop"), 0)
        text = "return document.getElementById(arguments[0]).textContent"
        self.assertIn("WebGL 2", browser.js(text, "hint"))
        self.assertEqual(browser.js(text, "problem"), "")
        self.assertIn("Arch", browser.js(text, "note"))
        self.assertIn("Drawn by nobody", browser.js(text, "attribution"))
        seen, count = set(), browser.js("return oriel.photos.length")
        for _ in range(count):
            browser.settle()
            seen.add(browser.js("return oriel.photo.name"))
            browser.js("document.querySelectorAll('#tools button')[1].click()")
        self.assertEqual(len(seen), count)
        for size in ((360, 240), *SIZES):
            browser.resize(*size)
            wrong = [w for w in browser.js(OVERLAPS) if w not in SCROLLS]
            self.assertEqual(wrong, [], size)
            self.assertLessEqual(browser.js("return document.getElementById('tools').scrollWidth"), size[0])


# WebXR as far as the page uses it: two halves of the canvas, and frames that the test makes.
HEADSET = """
class Headset extends EventTarget {
    inputSources = [];
    updateRenderState({baseLayer}) { this.layer = baseLayer; }
    async requestReferenceSpace() { return "space"; }
    requestAnimationFrame(frame) { this.frame = frame; }
    async end() { this.dispatchEvent(new Event("end")); }
}
window.headset = new Headset();
Object.defineProperty(navigator, "xr", {value: {isSessionSupported: async () => true,
                                                requestSession: async () => window.headset}});
WebGL2RenderingContext.prototype.makeXRCompatible = async () => {};
window.XRWebGLLayer = class {
    framebuffer = null;
    getViewport({eye}) { return {x: eye === "left" ? 0 : 180, y: 0, width: 180, height: 240}; }
};
"""

# One frame at a time (ms) with these sticks: the camera of each eye, and how far its half of the canvas is from
# what that camera shows.
WEAR = """
const [time, sticks = {}] = arguments, {picture} = oriel, {renderer} = picture, gl = renderer.device.gl;
headset.inputSources = Object.entries(sticks).map(([handedness, axes]) => ({handedness, gamepad: {axes}}));
Object.assign(picture.canvas, {width: 360, height: 240});
const matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const views = [-1, 1].map(side => ({
    eye: side < 0 ? "left" : "right", transform: {position: {x: 0.032 * side, y: 0, z: 0}, matrix},
    projectionMatrix: [1, 0, 0, 0, 0, 1, 0, 0, 0.2 * side, 0, -1, -1, 0, 0, -0.1, 0]}));
const cameras = [], show = renderer.show;
renderer.show = (...args) => {
    cameras.push(renderer.camera);
    show.apply(renderer, args);
};
headset.frame(1000 + time, {getViewerPose: () => ({views, transform: {position: {x: 0, y: 0, z: 0}, matrix}})});
delete renderer.show;
const halves = views.map((_, i) => {
    const bytes = new Uint8Array(4 * 180 * 240);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(180 * i, 0, 180, 240, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes;
});
return cameras.map((camera, i) => {
    const {data} = renderer.capture(camera, 0);
    let sum = 0;
    for (let y = 0; y < 240; y++)
        for (let x = 0; x < 4 * 180; x++)
            sum += Math.abs(data[4 * 180 * y + x] - halves[i][4 * 180 * (239 - y) + x]);
    return [camera, sum / data.length];
});
"""

HELP_KEYS = "return [...document.querySelectorAll('#help dt')].map(row => row.textContent)"

# What the album of a small window shows when it is scrolled: all but the photograph and its buttons.
SCROLLS = [f"{name} leaves the window" for name in ("thumbs", "hint", "note", "attribution")]


# Pairs of what lies over the picture that cover one another, what leaves the window, and what is wider than its box.
OVERLAPS = """
const wide = [...document.querySelectorAll("html, #over, #over .panel, #tools, #help")]
    .filter(e => e.scrollWidth > e.clientWidth + 1).map(e => `${e.id || "page"} is wider than its box`);
const boxes = [...document.querySelectorAll("#over .panel, #tools, #thumbs, #map, #head, #hint, #album, #attribution")]
    .filter(e => e.offsetWidth && e.textContent + e.id !== "").map(e => [e.id, e.getBoundingClientRect()]);
const found = [];
boxes.forEach(([a, p], i) => {
    if (p.left < 0 || p.top < 0 || p.right > innerWidth + 0.5 || p.bottom > innerHeight + 0.5)
        found.push(`${a} leaves the window`);
    for (const [b, q] of boxes.slice(i + 1))
        if (Math.min(p.right, q.right) - Math.max(p.left, q.left) > 0.5 &&
            Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top) > 0.5)
            found.push(`${a} and ${b}`);
});
const help = document.getElementById("help"), {left, top, right, bottom} = help.getBoundingClientRect();
if (help.open && (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight))
    found.push("help leaves the window");
return [...found, ...wide];
"""

# What is wrong with each of these panels beside photographs and a note, and with the help; how many tools there are
# in each row.
LAYOUTS = """
const found = [], byId = id => document.getElementById(id);
const look = what => found.push(...(() => {%s})().map(wrong => `${what}: ${wrong}`));
oriel.resized();
for (const id of [...arguments[0], "thumbs"])
    byId(id).hidden = true;
oriel.toggle("thumbs");
document.querySelector(".mark").click();
for (const id of ["note", ...arguments[0]]) {
    oriel.reveal(id);
    oriel.showState();
    look(id);
    if (byId("hint").textContent === "")
        found.push("no hint");
}
byId("tool-help").click();
look("help");
byId("help").close();
const rows = Map.groupBy([...document.querySelectorAll("#tools button")], b => b.offsetTop);
return [found, [...rows.values()].map(row => row.length)];
""" % OVERLAPS

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[7:], verbosity=2)
