"""`oriel walk` and a client of it without a browser."""
import base64
import http.client
import json
import os
import socket
import struct
import subprocess


class Walk:
    """The program, serving."""

    def __init__(self, oriel, scene, *options, env=None, stderr=None):
        self.process = subprocess.Popen([oriel, "walk", scene, "--port", "0", *options],
                                        stdout=subprocess.PIPE, stderr=stderr, text=True, env=env)
        self.address = self.process.stdout.readline().strip()
        self.host, self.port = self.address.split("/")[2].split(":")

    def get(self, path, **headers):
        answer, body = self.ask("GET", path, **headers)
        return answer.status, body

    def ask(self, method, path, **headers):
        connection = http.client.HTTPConnection(self.host, int(self.port), timeout=60)
        connection.putrequest(method, path, skip_host="Host" in headers)
        for name, value in headers.items():
            connection.putheader(name, value)
        connection.endheaders()
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer, body

    def close(self):
        self.process.terminate()
        self.process.stdout.close()
        return self.process.wait(60)


class Client:
    """A WebSocket, as little of it as the tests need."""

    def __init__(self, walk, path="/live", **headers):
        self.socket = socket.create_connection((walk.host, int(walk.port)), timeout=60)
        lines = {"Host": f"{walk.host}:{walk.port}", "Upgrade": "websocket", "Connection": "Upgrade",
                 "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(),
                 "Sec-WebSocket-Version": "13", "Sec-WebSocket-Protocol": "oriel-walk", **headers}
        request = f"GET {path} HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in lines.items())
        self.socket.sendall(request.encode() + b"\r\n")
        self.answer = b""
        while b"\r\n\r\n" not in self.answer:
            part = self.socket.recv(1)
            if not part:
                break
            self.answer += part
        self.open = b" 101 " in self.answer

    def send(self, data, opcode=1):
        self.socket.sendall(self.message(data, opcode))

    def send_all(self, messages):
        """At once, so that they arrive together."""
        self.socket.sendall(b"".join(self.message(data) for data in messages))

    def message(self, data, opcode=1):
        data = data if isinstance(data, bytes) else json.dumps(data).encode()
        mask = os.urandom(4)
        size = (bytes([0x80 | len(data)]) if len(data) < 126 else
                b"\xfe" + struct.pack(">H", len(data)) if len(data) < 65536 else
                b"\xff" + struct.pack(">Q", len(data)))
        return (bytes([0x80 | opcode]) + size + mask +
                bytes(x ^ mask[i % 4] for i, x in enumerate(data)))

    def exactly(self, size):
        data = b""
        while len(data) < size:
            part = self.socket.recv(size - len(data))
            if not part:
                raise ConnectionError
            data += part
        return data

    def receive(self):
        """Opcode and data of the next message. Answers the pings of a server that has not heard for long."""
        while True:
            opcode, data = self.any_message()
            if opcode != 9:
                return opcode, data
            self.send(data, opcode=10)

    def any_message(self):
        first, size = self.exactly(2)
        size &= 127
        if size == 126:
            size = struct.unpack(">H", self.exactly(2))[0]
        elif size == 127:
            size = struct.unpack(">Q", self.exactly(8))[0]
        return first & 15, self.exactly(size)

    def closed_for(self):
        """The reason that the server closed with; 0: none."""
        try:
            opcode, data = self.receive()
        except (ConnectionError, OSError):
            return 0
        return struct.unpack(">H", data[:2])[0] if opcode == 8 and len(data) >= 2 else 0

    def close(self):
        self.socket.close()

    def frame(self, request):
        """Asks and waits: the header's numbers and the JPEG."""
        self.send(request)
        opcode, data = self.receive()
        assert opcode == 2, data
        header = struct.unpack("<6I", data[:24])
        return header, data[24 + 4 * header[5]:]
