"""A headless Firefox, driven by its own remote protocol (Marionette), since Debian has no geckodriver."""
import json
import shutil
import socket
import subprocess
import tempfile
import time

PROGRAM = shutil.which("firefox-esr") or shutil.which("firefox")
START_S, WAIT_S = 60, 180 # limits for a busy machine

PREFERENCES = {
    "webgl.force-enabled": True, # without a graphics chip
    "datareporting.policy.dataSubmissionEnabled": False,
    "app.update.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
}


def free_port():
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


class Firefox:
    def __init__(self, width, height):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        port = free_port()
        with open(f"{self.profile.name}/user.js", "w") as file:
            for name, value in {**PREFERENCES, "marionette.port": port}.items():
                file.write(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n")
        self.process = subprocess.Popen(
            [PROGRAM, "--headless", "--marionette", "--no-remote", "--profile", self.profile.name,
             f"--width={width}", f"--height={height}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.socket = self.connect(port)
        self.number = 0
        self.receive() # who it is
        self.ask("WebDriver:NewSession", {"capabilities": {"alwaysMatch": {"timeouts": {"script": 1000 * WAIT_S}}}})

    def connect(self, port):
        end = time.monotonic() + START_S
        while True:
            try:
                return socket.create_connection(("127.0.0.1", port), timeout=WAIT_S)
            except OSError:
                if time.monotonic() > end or self.process.poll() is not None:
                    raise
                time.sleep(0.2)

    def receive(self):
        """A message is its length in bytes, a colon, and JSON."""
        head = b""
        while not head.endswith(b":"):
            head += self.socket.recv(1)
        data = b""
        while len(data) < int(head[:-1]):
            data += self.socket.recv(int(head[:-1]) - len(data))
        return json.loads(data)

    def ask(self, command, parameters):
        self.number += 1
        data = json.dumps([0, self.number, command, parameters]).encode()
        self.socket.sendall(b"%d:%s" % (len(data), data))
        _, _, error, result = self.receive()
        if error:
            raise RuntimeError(f"{command}: {error['message']}")
        return result

    def open(self, address):
        self.ask("WebDriver:Navigate", {"url": address})

    def js(self, script, *args):
        return self.ask("WebDriver:ExecuteScript", {"script": script, "args": args})["value"]

    def wait(self, condition):
        end = time.monotonic() + WAIT_S
        while not self.js(condition):
            if time.monotonic() > end:
                raise TimeoutError(condition)
            time.sleep(0.2)

    def close(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait(60)
        self.profile.cleanup()
