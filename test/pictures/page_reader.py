"""Reads the runs of pages, as docs/notes/page.md says, independently of the player and of the writer."""

import base64
import json
import re
import zlib

import numpy as np

SECTION = 19  # numbers of a section: pose, strain, stress resultants
ARROW = 9  # position, force, moment


class PageRun:
    """A run of a page: `picture`, `times` and, by kind, numbers of shape (instants, ...)."""

    def __init__(self, picture, motion):
        self.picture, self.size = picture, len(motion)
        self.data, self.at = zlib.decompress(motion), 0
        self.frames = picture["frames"]
        self.times = self._numbers(self.frames)
        self.links = self._tracks(len(picture["links"]), 7)
        self.beams = [self._tracks(len(beam["sections"]), SECTION) for beam in picture["beams"]]
        self.probes = self._tracks(len(picture["probes"]), 3)
        self.lines = [self._tracks(line["points"], 3) for line in picture.get("lines", [])]
        self.arrows = {kind["kind"]: self._tracks(kind["count"], ARROW) for kind in picture["arrows"]}
        self.columns = dict(zip((column["name"] for column in picture["columns"]),
                                self._tracks(len(picture["columns"]), 1)[:, :, 0].T))
        self.meshes = [self._mesh(mesh["vertices"], mesh["triangles"]) for mesh in picture["meshes"]]
        assert self.at == len(self.data)

    def _take(self, count, kind):
        values = np.frombuffer(self.data, kind, count, self.at)
        self.at += values.nbytes
        return values

    def _numbers(self, count):
        return self._take(count, "<f8")

    def _track(self):
        least, most = self._numbers(2)
        if not most > least:
            return np.full(self.frames, least)
        low, high = self._take(self.frames, "u1"), self._take(self.frames, "u1")
        steps = np.cumsum(low.astype(int) + 256 * high.astype(int)) % 65536
        return np.where(steps == 65535, np.nan, least + (most - least) * steps / 65534)

    def _tracks(self, count, width):
        tracks = [self._track() for _ in range(count * width)]
        return np.reshape(tracks, (count, width, self.frames)).transpose(2, 0, 1)

    def _mesh(self, vertices, triangles):
        least, most = self._numbers(3), self._numbers(3)
        places = least + (most - least) * self._take(3 * vertices, "<u2").reshape(-1, 3) / 65535
        return places, self._take(3 * triangles, "<u4").reshape(-1, 3)

    def link(self, name):
        """Poses of a link, shape (instants, 7)."""
        return self.links[:, [link["name"] for link in self.picture["links"]].index(name)]


def runs_of(text):
    pictures = re.findall(r'<script type="application/json" class="flexarm-picture">(.*?)</script>', text, re.DOTALL)
    motions = re.findall(r'<script type="text/plain" class="flexarm-motion">(.*?)</script>', text, re.DOTALL)
    assert len(pictures) == len(motions)
    return [PageRun(json.loads(picture), base64.b64decode(motion)) for picture, motion in zip(pictures, motions)]


def read_page(path):
    with open(path, encoding="utf-8") as file:
        return runs_of(file.read())
