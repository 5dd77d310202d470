"""Helpers of the tests of films: pages that are made here, and the command `flexarm film`.

See docs/notes/page.md for what a page has in it.
"""

import base64
import json
import os
import re
import shutil
import subprocess
import tempfile
import zlib

import numpy
import pytest

from conftest import ROOT

PLAYER = os.path.join(ROOT, "src", "pictures", "player")
THREE = "/usr/share/javascript/three"
WIDTH, HEIGHT = 320, 200

PACKAGES = (shutil.which("chromium") and shutil.which("chromedriver") and shutil.which("ffmpeg")
            and os.path.exists("/usr/lib/python3/dist-packages/selenium") and os.path.exists(THREE))


def draws_by_software():
    """Return whether Chromium has WebGL without a graphics processor."""
    page = ("data:text/html,<script>document.write(Boolean(document.createElement('canvas').getContext('webgl')))"
            "</script>")
    with tempfile.TemporaryDirectory() as folder:
        shown = subprocess.run(["chromium", "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
                                "--enable-unsafe-swiftshader", "--user-data-dir=" + folder, "--dump-dom", page],
                               check=False, timeout=1000, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return b"<body>true" in shown.stdout


needs_browser = pytest.mark.skipif(
    not (PACKAGES and draws_by_software()),
    reason="needs Debian's packages chromium, with WebGL by software, chromium-driver, python3-selenium, ffmpeg and "
           "libjs-three")


def track(values):
    """Return a number over time as a page has it: smallest and largest value, and bytes of differences."""
    values = numpy.asarray(values, dtype=float)
    low, high = values.min(), values.max()
    head = numpy.array([low, high]).astype("<f8").tobytes()
    if low == high:
        return head
    steps = numpy.diff(numpy.rint((values - low) / (high - low) * 65534).astype(int), prepend=0) % 65536
    return head + (steps % 256).astype(numpy.uint8).tobytes() + (steps // 256).astype(numpy.uint8).tobytes()


def ball(path, times, **changes):
    """Return the elements of a run of a small ball that moves along a path."""
    picture = dict({
        "name": "ball", "title": "ball", "notes": [], "extent": {"center": [0, 0, 0], "radius": 1},
        "gravity": [0, 0, -9.81], "meshes": [], "beams": [], "joints": [], "probes": [], "grounds": [], "arrows": [],
        "columns": [], "frames": len(times), "clips": [], "still": None, "links": [
            {"name": "ball", "parent": -1, "beam": -1, "stick": [], "shapes": [
                {"kind": "sphere", "pose": [0, 0, 0, 0, 0, 0, 1], "color": [1, 0, 1, 1], "radius": 0.06}]}]}, **changes)
    pose = [*numpy.transpose(path), *(numpy.full(len(times), x) for x in (0, 0, 0, 1))]
    motion = numpy.asarray(times).astype("<f8").tobytes() + b"".join(map(track, pose))
    return ('<script type="application/json" class="flexarm-picture">%s</script>\n'
            '<script type="text/plain" class="flexarm-motion">%s</script>'
            % (json.dumps(picture).replace("<", "\\u003c"), base64.b64encode(zlib.compress(motion)).decode()))


def write_page(path, runs):
    """Write the player's page with these elements in the place of the runs."""
    def text_of(match):
        for folder in (PLAYER, THREE, THREE + "/examples/js/controls"):
            if os.path.exists(os.path.join(folder, match[1])):
                with open(os.path.join(folder, match[1]), encoding="utf-8") as file:
                    return file.read()
        raise FileNotFoundError(match[1])

    with open(os.path.join(PLAYER, "player.html"), encoding="utf-8") as file:
        page = file.read()
    page = re.sub(r'<link rel="stylesheet" href="(.+?)">', lambda found: "<style>%s</style>" % text_of(found), page)
    page = re.sub(r'<script src="(.+?)"></script>', lambda found: "<script>%s</script>" % text_of(found), page)
    path.write_text(page.replace("<!-- runs -->", runs), encoding="utf-8")


def place(t):
    """Return where the ball is."""
    return numpy.stack([0.8 * numpy.cos(t), 0.6 * numpy.sin(t), 0.3 * t - 0.3], axis=-1)


def write_page_of_ball(path):
    """Write the page of a ball, 2 s long from 1 s on."""
    times = numpy.linspace(1, 3, 201)
    write_page(path, ball(place(times), times))


def film(folder, *arguments, status=0, **environment):
    """Run `flexarm film ...` in the folder. Return its output, or its error output if it fails."""
    result = subprocess.run([os.environ["FLEXARM_PROGRAM"], "film", *map(str, arguments)], cwd=folder, check=False,
                            timeout=1000, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                            env={**os.environ, **environment})
    assert result.returncode == status, result.stderr.decode()
    assert (result.stderr == b"") == (status == 0), result.stderr.decode()
    return (result.stderr if status else result.stdout).decode()
