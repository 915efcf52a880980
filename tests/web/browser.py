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


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *args):
        pass


class Server:
    """Serves `folder` on a free port of this machine."""

    def __init__(self, folder):
        handler = functools.partial(QuietHandler, directory=folder)
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        self.address = f"http://127.0.0.1:{self.server.server_address[1]}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Browser:
    def __init__(self, width, height, touch=False):
        options = Options()
        self.profile = tempfile.TemporaryDirectory()
        for flag in ("--headless=new", "--no-sandbox", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--hide-scrollbars", "--mute-audio",
                     "--disable-dev-shm-usage", f"--user-data-dir={self.profile.name}"):
            options.add_argument(flag)
        if touch:
            metrics = {"width": width, "height": height, "pixelRatio": 1, "touch": True}
            options.add_experimental_option("mobileEmulation", {"deviceMetrics": metrics})
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_script_timeout(120)
        # The picture, not the window, has this size.
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch})

    def open(self, address, seconds=90):
        """Waits until everything that the view wants is there, and drawn."""
        self.driver.get(address)
        self.settle(seconds)

    def settle(self, seconds=90):
        self.wait("return !!window.oriel && oriel.settled", seconds)

    def wait(self, condition, seconds=90):
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

    def keys(self, code, key, seconds, until="return true"):
        """Holds a key down, on a slow machine until the page has seen it."""
        def send(kind):
            self.driver.execute_cdp_cmd("Input.dispatchKeyEvent", {"type": kind, "code": code, "key": key})

        send("keyDown")
        time.sleep(seconds)
        self.wait(until)
        send("keyUp")

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

CAPTURE = """
return oriel.picture.capture(arguments[0], arguments[1]).then(canvas => {
    oriel.refined = false;
    oriel.wake();
    return canvas.toDataURL("image/png");
});
"""
