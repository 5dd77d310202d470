"""A server of a live page for tests: one page, and one WebSocket at /stream, on a free port of this machine."""

import base64
import hashlib
import json
import socket
import struct
import threading

from page_maker import SETTINGS, mesh_bytes, page

KEY = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # of every WebSocket, RFC 6455


def instant_bytes(run, k):
    return struct.pack(f"<{1 + len(run.tracks)}d", run.times[k], *(track[k] for track in run.tracks))


def picture_text(run):
    data = b"".join(mesh_bytes(*mesh) for mesh in run.meshes)
    return json.dumps(dict(run.picture, frames=0, clips=[], still=None, mesh_data=base64.b64encode(data).decode()))


class LiveServer:
    """Sends a picture to each page that connects; the test sends the instants."""

    def __init__(self, run):
        self.run, self.pages, self.lock = run, [], threading.Lock()
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self.socket.getsockname()[1]}/"
        element = '<script type="application/json" class="flexarm-live">{"stream": "/stream"}</script>'
        self.html = page([element], SETTINGS).encode()
        threading.Thread(target=self.accept, daemon=True).start()

    def close(self):
        self.socket.close()
        self.disconnect()

    def accept(self):
        while True:
            try:
                connection, _ = self.socket.accept()
            except OSError:
                return
            threading.Thread(target=self.answer, args=(connection,), daemon=True).start()

    def answer(self, connection):
        request = b""
        while b"\r\n\r\n" not in request:
            part = connection.recv(4096)
            if not part:
                connection.close()
                return
            request += part
        fields = {line.split(b":", 1)[0].strip().lower(): line.split(b":", 1)[1].strip()
                  for line in request.split(b"\r\n")[1:] if b":" in line}
        if request.startswith(b"GET /stream "):
            accepted = base64.b64encode(hashlib.sha1(fields[b"sec-websocket-key"] + KEY).digest())
            connection.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                               b"Sec-WebSocket-Accept: " + accepted + b"\r\n\r\n")
            self.send_to(connection, 1, picture_text(self.run).encode())
            with self.lock:
                self.pages.append(connection)
            return
        connection.sendall(b"HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\nConnection: close\r\n"
                           b"Content-Length: " + str(len(self.html)).encode() + b"\r\n\r\n" + self.html)
        connection.close()

    @staticmethod
    def send_to(connection, kind, data):
        """Send one message that is not split. @param kind  1: text, 2: binary"""
        size = len(data)
        head = bytes([0x80 | kind])
        if size < 126:
            head += bytes([size])
        elif size < 65536:
            head += b"\x7e" + struct.pack(">H", size)
        else:
            head += b"\x7f" + struct.pack(">Q", size)
        connection.sendall(head + data)

    def send(self, kind, data):
        with self.lock:
            for connection in self.pages:
                self.send_to(connection, kind, data)

    def send_instants(self, instants):
        for k in instants:
            self.send(2, instant_bytes(self.run, k))

    def disconnect(self):
        with self.lock:
            for connection in self.pages:
                connection.close()
            self.pages = []
