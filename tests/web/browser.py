"""A headless Chromium without a graphics chip, and a web server for a folder."""
import base64
import functools
import http.server
import tempfile
import threading
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service


WAIT_S = 180 # a limit for a busy machine, not what anything is expected to take


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    headers_to_add = {}

    def log_message(self, *args):
        pass

    def end_headers(self):
        for name, value in self.headers_to_add.items():
            self.send_header(name, value)
        super().end_headers()


class Server:
    """Serves `folder` on a free port of this machine."""

    def __init__(self, folder, headers=None, handler=QuietHandler):
        kind = type("Handler", (handler,), {"headers_to_add": headers or {}})
        handler = functools.partial(kind, directory=folder)
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        self.address = f"http://127.0.0.1:{self.server.server_address[1]}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Browser:
    def __init__(self, width, height, touch=False, flags=()):
        options = Options()
        # The browser's last process may still write when it has answered that it ends.
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        for flag in ("--headless=new", "--no-sandbox", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--hide-scrollbars", "--mute-audio",
                     "--disable-dev-shm-usage", f"--user-data-dir={self.profile.name}", *flags):
            options.add_argument(flag)
        if touch:
            metrics = {"width": width, "height": height, "pixelRatio": 1, "touch": True}
            options.add_experimental_option("mobileEmulation", {"deviceMetrics": metrics})
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_script_timeout(120)
        self.touches = touch
        self.resize(width, height)

    def resize(self, width, height, ratio=1):
        """The picture, not the window, gets this size. ratio: of the screen's pixels to those of CSS."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": ratio, "mobile": self.touches})

    def open(self, address, seconds=WAIT_S):
        """Waits until everything that the view wants is there, and drawn."""
        self.driver.get(address)
        self.settle(seconds)

    def settle(self, seconds=WAIT_S):
        self.wait(SETTLED, seconds)

    def wait(self, condition, seconds=WAIT_S):
        end = time.monotonic() + seconds
        while not self.driver.execute_script(condition):
            if time.monotonic() > end:
                raise TimeoutError(f"{condition}; {self.errors()} {self.js(HINT)}")
            time.sleep(0.1)

    def js(self, script, *args):
        return self.driver.execute_script(script, *args)

    def errors(self):
        """Of the console, since the last call; not what the driver says of its own speed."""
        return [e["message"] for e in self.driver.get_log("browser")
                if e["level"] in ("SEVERE", "WARNING") and "OpenGL, Performance" not in e["message"]]

    def address(self):
        """Of the page as the page itself has it, which the driver hears of later."""
        return self.js("return location.href")

    def keys(self, code, key, until="return true"):
        """Holds a key down until the condition holds. The page has seen both events then."""
        def send(kind):
            self.js(COUNT_EVENTS, kind.lower())
            self.driver.execute_cdp_cmd("Input.dispatchKeyEvent", {"type": kind, "code": code, "key": key})
            self.wait("return seenEvents > 0")

        send("keyDown")
        self.wait(until)
        send("keyUp")

    def click(self, x, y, times=1):
        """A twentieth of a second from event to event, however slow the machine is."""
        at = time.time()
        for n in range(1, times + 1):
            for kind in ("mousePressed", "mouseReleased"):
                self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {
                    "type": kind, "x": x, "y": y, "button": "left", "clickCount": n, "timestamp": at})
                at += 0.05

    def wheel(self, x, y, by):
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {
            "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": by})

    def drag(self, *points):
        """Of the mouse, with the left button. The page has seen all of it then."""
        def send(kind, at, **more):
            self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {
                "type": kind, "x": at[0], "y": at[1], "button": "left", **more})

        self.js(COUNT_EVENTS, "pointerup")
        for kind, at in zip(["mousePressed"] + ["mouseMoved"] * (len(points) - 1), points):
            send(kind, at, buttons=1, clickCount=1)
        send("mouseReleased", points[-1])
        self.wait("return seenEvents > 0")

    def touch(self, *moments):
        """Of fingers: for each moment their places. The page has seen all of it then."""
        def send(kind, points):
            self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
                "type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})

        self.js(COUNT_EVENTS, "pointerup")
        send("touchStart", moments[0])
        for points in moments[1:]:
            send("touchMove", points)
        send("touchEnd", [])
        self.wait(f"return seenEvents >= {len(moments[0])}")

    def tap(self, x, y, times=1):
        """Of one finger, a twentieth of a second from event to event, however slow the machine is."""
        at = time.time()
        for n in range(2 * times):
            self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
                "type": "touchEnd" if n % 2 else "touchStart", "timestamp": at + 0.05 * n,
                "touchPoints": [] if n % 2 else [{"x": x, "y": y}]})

    def screenshot(self, file):
        self.driver.save_screenshot(file)

    def capture(self, file, camera, layer=0):
        """The renderer's own picture of a camera, as PNG."""
        data = self.js(CAPTURE, camera, layer)
        with open(file, "wb") as out:
            out.write(base64.b64decode(data.split(",", 1)[1]))

    def close(self):
        self.driver.quit()
        self.profile.cleanup()


HINT = "return document.getElementById('hint') ? document.getElementById('hint').textContent : ''"

# Nothing is on its way any more that would change the picture, or the album's photograph.
SETTLED = """
const {picture, refined, running, image} = window.oriel || {};
return picture ? refined && !running && picture.complete
    : !!image && image.complete && image.naturalWidth > 0 &&
      image.alt === document.getElementById('place').textContent;
"""

# Counts events of one kind from now on. The window hears of them after everything in the page.
COUNT_EVENTS = """
window.seenEvents = 0;
window.removeEventListener(window.seenKind, window.countEvent);
window.seenKind = arguments[0];
window.countEvent = window.countEvent || (() => window.seenEvents++);
window.addEventListener(window.seenKind, window.countEvent);
"""

CAPTURE = """
return oriel.picture.capture(arguments[0], arguments[1]).then(canvas => {
    oriel.refined = false;
    oriel.wake();
    return canvas.toDataURL("image/png");
});
"""
