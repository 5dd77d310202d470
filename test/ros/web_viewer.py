"""A browser for tests of the node's page, made of Python's standard library."""

import base64
import hashlib
import http.client
import json
import os
import re
import socket
import struct
from urllib.parse import urlsplit

KEY = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # of every WebSocket, RFC 6455
TEXT, BINARY = 1, 2


def url_in(output):
    """Return the page's address as the node prints it, or None."""
    found = re.search(r"the page is at (http://\S+:\d+/)", output)
    return found and found.group(1)


def place_of(url):
    parts = urlsplit(url)
    return parts.hostname, parts.port


def ask(url, path="/", method="GET", **headers):
    """Return status and text of an answer."""
    connection = http.client.HTTPConnection(*place_of(url), timeout=60)
    connection.request(method, path, headers=headers)
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    return answer.status, text


class Viewer:
    """Looks at the stream. `headers`: in the place of the browser's own Host and Origin."""

    def __init__(self, url, **headers):
        self.received = b""
        self.picture = None
        self.socket = socket.create_connection(place_of(url), timeout=60)
        key = base64.b64encode(os.urandom(16))
        host = urlsplit(url).netloc
        fields = dict({"Host": host, "Origin": "http://" + host}, **headers)
        request = "GET /stream HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        request += "".join("%s: %s\r\n" % field for field in fields.items())
        self.socket.sendall(request.encode() + b"Sec-WebSocket-Key: " + key + b"\r\n\r\n")
        head = self.take_until(b"\r\n\r\n")
        self.status = int(head.split()[1])
        accepted = base64.b64encode(hashlib.sha1(key + KEY).digest())
        assert self.status != 101 or accepted in head, head

    def close(self):
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def receive(self):
        part = self.socket.recv(65536)
        if not part:
            raise EOFError("the server has closed the connection")
        self.received += part

    def take(self, size):
        while len(self.received) < size:
            self.receive()
        part, self.received = self.received[:size], self.received[size:]
        return part

    def take_until(self, end):
        while end not in self.received:
            self.receive()
        return self.take(self.received.index(end) + len(end))

    def message(self):
        """Return kind and bytes of the next message."""
        first, size = self.take(2)
        assert first & 0x80, "the message is split"
        if size >= 126:
            size = int.from_bytes(self.take(2 if size == 126 else 8), "big")
        return first & 0xf, self.take(size)

    def next_picture(self):
        """Return the next picture; instants before it are left out."""
        kind, data = self.message()
        while kind != TEXT:
            kind, data = self.message()
        self.picture = json.loads(data.decode())
        return self.picture

    def next_instant(self):
        """Return time and numbers of the next instant, and the picture that it belongs to in `picture`."""
        kind, data = self.message()
        if kind == TEXT:
            self.picture = json.loads(data.decode())
            return self.next_instant()
        assert kind == BINARY, kind
        numbers = struct.unpack("<%dd" % (len(data) // 8), data)
        return numbers[0], numbers[1:]


def track_count(picture):
    """Return how many numbers docs/notes/page.md gives an instant."""
    return (7 * len(picture["links"]) + 19 * sum(len(beam["sections"]) for beam in picture["beams"])
            + 3 * len(picture["probes"]) + 9 * sum(arrows["count"] for arrows in picture["arrows"])
            + len(picture["columns"]))
