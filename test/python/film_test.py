"""Test the command `flexarm film`, on pages that are made here and on a small scene, and the commands of docs/film.md.

The frames are looked at through ffmpeg.
"""

import functools
import json
import os
import re
import shutil
import subprocess

import numpy
import pytest

from conftest import ROOT, example
from filming import HEIGHT, WIDTH, ball, film, needs_browser, place, write_page, write_page_of_ball
from flexarm.film import program
from flexarm.film.arguments import read_arguments
from flexarm.film.browser import Browser
from flexarm.film.errors import InputError


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the page of a ball, 2 s long from 1 s on."""
    write_page_of_ball(tmp_path / "ball.html")
    return tmp_path


def probe(path):
    """Return what ffprobe says of a film: codec, size, format of pixels, frames, and duration [s]."""
    text = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-of", "json", "-show_entries",
                           "stream=codec_name,width,height,pix_fmt,nb_read_frames,duration", path], check=True,
                          stdout=subprocess.PIPE).stdout
    found = json.loads(text)["streams"][0]
    return (found["codec_name"], found["width"], found["height"], found["pix_fmt"], int(found["nb_read_frames"]),
            float(found.get("duration", 0)))


@functools.lru_cache(maxsize=None)
def as_they_are():
    """Return ffmpeg's option for frames neither doubled nor dropped: new in 5.1, and the only one in 9."""
    options = subprocess.run(["ffmpeg", "-v", "error", "-h", "long"], check=True, stdout=subprocess.PIPE).stdout
    return "-fps_mode" if b"-fps_mode" in options else "-vsync"


def pixels(path, width=WIDTH, height=HEIGHT):
    """Return the frames of a film or picture, as rows of red, green and blue."""
    data = subprocess.run(["ffmpeg", "-v", "error", "-i", path, as_they_are(), "passthrough", "-f", "rawvideo",
                           "-pix_fmt", "rgb24", "-"], check=True, stdout=subprocess.PIPE).stdout
    return numpy.frombuffer(data, dtype=numpy.uint8).reshape(-1, height, width, 3).astype(int)


def centre(picture):
    """Return the middle of the magenta pixels: where the ball is."""
    red, green, blue = numpy.moveaxis(picture, -1, 0)
    rows, columns = numpy.nonzero((red - green > 60) & (blue - green > 60))
    assert len(rows) > 10
    return numpy.array([columns.mean() + 0.5, rows.mean() + 0.5])


def projected(point, camera, target, angle=35.0, width=WIDTH, height=HEIGHT):
    """Return where a camera sees a point, if z is up: pixels from the upper left corner."""
    forward = (numpy.asarray(target, dtype=float) - camera) / numpy.linalg.norm(numpy.subtract(target, camera))
    right = numpy.cross(forward, [0, 0, 1])
    right /= numpy.linalg.norm(right)
    offset = numpy.subtract(point, camera)
    scale = height / 2 / numpy.tan(numpy.radians(angle / 2)) / (offset @ forward)
    up = numpy.cross(right, forward)
    return numpy.array([width / 2 + scale * (offset @ right), height / 2 - scale * (offset @ up)])


# ---------------------------------------------------------------- films

CAMERA, TARGET = (-1.0, -4.0, 1.5), (0.1, 0.0, -0.1)
SAME_CAMERA = "--camera", "-1,-4,1.5", "--target", "0.1,0,-0.1", "--size", "%dx%d" % (WIDTH, HEIGHT)


@needs_browser
def test_a_film_has_its_frames_size_and_duration(folder):
    said = film(folder, "ball.html", "-o", "a.mp4", "--from", 1.5, "--until", 2.5, "--rate", 10, "--speed", 2,
                *SAME_CAMERA)
    assert said == "a.mp4: 6 frames, 0.6 s, 320x200\n" and sorted(os.listdir(folder)) == ["a.mp4", "ball.html"]
    codec, width, height, format_, frames, duration = probe(folder / "a.mp4")
    assert (codec, width, height, format_, frames) == ("h264", WIDTH, HEIGHT, "yuv420p", 6)
    assert duration == pytest.approx(0.6)
    data = (folder / "a.mp4").read_bytes()
    assert data.index(b"moov") < data.index(b"mdat")  # players can begin before they have it all
    for k, picture in enumerate(pixels(folder / "a.mp4")):
        expected = projected(place(1.5 + 0.2 * k), CAMERA, TARGET)
        assert numpy.abs(centre(picture) - expected).max() < 2
    background = pixels(folder / "a.mp4")[0, -1, 0]
    assert numpy.abs(background - [0xed, 0xf0, 0xf4]).max() <= 6  # the page's


@needs_browser
def test_a_gif_moves(folder):
    film(folder, "ball.html", "--output", "a.gif", "--rate", 5, *SAME_CAMERA)
    codec, width, height, _, frames, duration = probe(folder / "a.gif")
    assert (codec, width, height, frames) == ("gif", WIDTH, HEIGHT, 11) and duration == pytest.approx(2.2)
    assert b"NETSCAPE2.0" in (folder / "a.gif").read_bytes()  # it begins anew at its end
    for k, picture in enumerate(pixels(folder / "a.gif")):
        assert numpy.abs(centre(picture) - projected(place(1 + 0.2 * k), CAMERA, TARGET)).max() < 2


@needs_browser
def test_a_picture_is_what_the_page_shows(folder):
    """The page itself says where the ball is, for a camera that it has chosen."""
    film(folder, "ball.html", "-o", "a.png", "--at", 2.2, "--size", "400x600", "--zoom", 1.5, "--view", "-1,-2,0.5")
    browser = Browser()
    try:
        browser.open(folder / "ball.html")
        browser.arrange((400, 600), dark=False, color=None, show=[], hide=[], view=[-1, -2, 0.5], camera=None,
                        target=None, zoom=1.5)
        seen = browser.run("""flexarm.setTime(2.2);
            const canvas = document.querySelector("canvas");
            const [x, y] = flexarm.project(arguments[0]);
            return [x / canvas.clientWidth * 400, y / canvas.clientHeight * 600];""", list(place(2.2)))
    finally:
        browser.close()
    picture, = pixels(folder / "a.png", 400, 600)
    assert numpy.abs(centre(picture) - seen).max() < 2
    first = probe(folder / "a.png")
    assert first[:3] == ("png", 400, 600)


@needs_browser
def test_a_series_of_pictures(folder):
    (folder / "100%").mkdir()
    said = film(folder, "ball.html", "-o", "100%/a_%03d.png", "--rate", 1, "--dark", *SAME_CAMERA, TMPDIR=str(folder))
    assert said == "100%/a_%03d.png: 3 pictures, 320x200\n"
    assert sorted(os.listdir(folder / "100%")) == ["a_000.png", "a_001.png", "a_002.png"]
    picture, = pixels(folder / "100%" / "a_001.png")
    assert numpy.abs(centre(picture) - projected(place(2), CAMERA, TARGET)).max() < 2
    assert picture[-1, 0].max() < 60  # dark


@needs_browser
def test_a_clip_begins_anew(tmp_path):
    """Two vibrations of 1 s; the last instant of each is its first one."""
    times = numpy.concatenate([numpy.linspace(0, 1, 21), numpy.linspace(1.5, 2.5, 21)])
    height = numpy.concatenate([0 * times[:21], numpy.sin(2 * numpy.pi * (times[21:] - 1.5))])
    path = numpy.stack([0 * times, 0 * times, 0.5 * height], axis=1)
    write_page(tmp_path / "modes.html", ball(path, times, clips=[
        {"name": "mode 1", "first": 0, "count": 21}, {"name": "mode 2: 1 Hz", "first": 21, "count": 21}]))
    film(tmp_path, "modes.html", "-o", "a.mp4", "--clip", "mode 2: 1 Hz", "--repeat", 2, "--rate", 8, *SAME_CAMERA)
    frames = pixels(tmp_path / "a.mp4")
    assert len(frames) == 16
    for k, picture in enumerate(frames):
        expected = projected([0, 0, 0.5 * numpy.sin(2 * numpy.pi * k / 8)], CAMERA, TARGET)
        assert numpy.abs(centre(picture) - expected).max() < 2, k


def times(runs, *words):
    """Return the times of the frames of a film, as the page counts them."""
    return program.frame_times(read_arguments(["a.html", *words]), runs)


def test_times_of_frames():
    run = {"start": 1.0, "end": 3.0, "clips": []}
    assert times([run], "--rate", "2") == [1.0, 1.5, 2.0, 2.5, 3.0]
    assert times([run], "--rate", "2", "--speed", "2", "--from", "2") == [2.0, 3.0]
    assert times([run], "--rate", "2", "--until", "1.4", "--repeat", "2") == [1.0, 1.0]
    assert times([run, {"start": 0.0, "end": 1.5, "clips": []}], "--rate", "1") == [0.0, 1.0, 2.0, 3.0]
    tenths = {"start": 0.0, "end": 2.0, "clips": []}
    assert times([tenths], "--rate", "10") == [k / 10 for k in range(21)]  # the nearest numbers: no sums of 0.1
    assert times([run], "-o", "a.png") == [1.0] and times([run], "-o", "a.png", "--at", "3.0000000001") == [3.0]
    clips = [{"name": "1st", "start": 1.0, "end": 1.9}, {"name": "2nd", "start": 2.0, "end": 3.0}]
    modes = [{"start": 0.0, "end": 9.0, "clips": []}, {"start": 1.0, "end": 3.0, "clips": clips}]
    for name in ("2", "2nd"):
        assert times(modes, "--rate", "4", "--clip", name) == [2.0, 2.25, 2.5, 2.75]
    assert times(modes, "-o", "a.png", "--at", "0.5", "--clip", "2") == [2.5]
    assert times(modes, "--rate", "4", "--from", "0.25", "--until", "0.5") == [1.25, 1.5]
    for runs, words, said in (
            ([run], ["--until", "9"], "--until: expected a time from 1 s to 3 s, got 9"),
            ([run], ["--from", "0"], "--from: expected a time from 1 s to 3 s, got 0"),
            ([run], ["--at", "-1", "-o", "a.png"], "--at: expected a time from 1 s to 3 s, got -1"),
            ([run], ["--clip", "1"], "--clip: the page has no clips, got '1'"),
            (modes, ["--clip", "2", "--until", "2"], "--until: expected a time from 0 s to 1 s, got 2"),
            (modes, ["--clip", "3"], "--clip: expected a number from 1 to 2 or one of '1st', '2nd', got '3'")):
        with pytest.raises(InputError) as caught:
            times(runs, *words)
        assert str(caught.value) == said


@needs_browser
def test_several_runs_are_side_by_side(tmp_path):
    times = numpy.linspace(0, 1, 11)
    still = numpy.zeros((11, 3))
    write_page(tmp_path / "two.html", ball(still, times) + ball(still, times))
    film(tmp_path, "two.html", "-o", "a.png", "--size", "640x200")
    picture, = pixels(tmp_path / "a.png", 640, 200)
    assert numpy.abs(centre(picture[:, :320]) - [160, 100]).max() < 2
    assert numpy.abs(centre(picture[:, 320:]) - [160, 100]).max() < 2


@needs_browser
def test_a_scene_is_simulated_first(tmp_path):
    (tmp_path / "a b.urdf").write_text("""<robot name="sphere">
      <parameter name="speed" value="1"/>
      <link name="world"/> <joint name="fall" type="floating"> <parent link="world"/> <child link="ball"/> </joint>
      <link name="ball"> <visual> <geometry> <sphere radius="0.05"/> </geometry>
          <material name="m"> <color rgba="1 0 1 1"/> </material> </visual>
        <inertial> <mass value="1"/> <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>
      <simulation> <gravity xyz="0 0 -1"/> <integrator step="0.01"/>
        <initial joint="fall/z" velocity="${speed}"/> </simulation> </robot>""")
    film(tmp_path, "a b.urdf", "--until", 1, "--rate", 4, *SAME_CAMERA, "--", "--set", "speed=1.2")
    assert sorted(os.listdir(tmp_path)) == ["a b.mp4", "a b.urdf"]
    frames = pixels(tmp_path / "a b.mp4")
    assert len(frames) == 5
    for k, picture in enumerate(frames):
        expected = projected([0, 0, 1.2 * k / 4 - 0.5 * (k / 4)**2], CAMERA, TARGET)
        assert numpy.abs(centre(picture) - expected).max() < 2


@needs_browser
def test_a_run_that_fails_is_filmed_until_then(failing_scene):
    said = film(failing_scene.parent, "failing.urdf", "-o", "a.mp4", "--until", 2, "--rate", 5, *SAME_CAMERA, status=1)
    assert "failed" in said and "Traceback" not in said
    assert probe(failing_scene.parent / "a.mp4")[4] == 5  # it fails at about 0.9 s


# ---------------------------------------------------------------- the page of the documentation

def test_the_page_names_all_options(tmp_path):
    with open(os.path.join(ROOT, "docs", "film.md"), encoding="utf-8") as file:
        text = file.read()
    for option in set(re.findall(r"--[a-z]+", film(tmp_path, "--help"))) - {"--help"}:
        assert "`%s" % option in text, option


@needs_browser
def test_the_commands_of_the_page(tmp_path):
    """Run the commands of docs/film.md, with short runs and small pictures."""
    with open(os.path.join(ROOT, "docs", "film.md"), encoding="utf-8") as file:
        commands = "".join(re.findall(r"^```sh\n(.*?)^```", file.read(), re.DOTALL | re.MULTILINE))
    shutil.copy(example("flexible_two_link_arm"), tmp_path / "arm.urdf")
    for long, short in (("--until 5", "--until 0.2"), ("--from 1 --until 2", "--from 0.1 --until 0.11"),
                        ("--at 3.2", "--at 0.1"), (" --size 1920x1080", ""),
                        ("flexarm film", "flexarm film --size 160x90")):
        assert long in commands
        commands = commands.replace(long, short)
    path = os.path.dirname(os.environ["FLEXARM_PROGRAM"]) + ":" + os.environ["PATH"]
    subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=tmp_path, check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "PATH": path})
    assert len(commands.splitlines()) == 7
    names = set(os.listdir(tmp_path))
    assert {"arm.html", "arm.mp4", "arm.gif", "arm.png", "slow.mp4", "fine.mp4", "arm_0000.png"} <= names, names
