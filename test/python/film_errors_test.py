"""Test what `flexarm film` leaves and says when it is interrupted, or cannot do what is wanted."""

import os
import shutil
import signal
import subprocess
import tempfile
import time

import pytest

from filming import ball, film, needs_browser, write_page, write_page_of_ball


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the page of a ball, 2 s long from 1 s on."""
    write_page_of_ball(tmp_path / "ball.html")
    return tmp_path


@pytest.fixture
def short_folder():
    """Return a folder for temporary files; the path of tmp_path is too long for Chromium, which gets another one."""
    with tempfile.TemporaryDirectory(dir="/tmp") as name:
        yield name


def left_behind(folder):
    """Return the processes of the browser whose temporary files are in a folder. Without ww, ps may cut long lines."""
    processes = subprocess.run(["ps", "axww", "-o", "args"], check=True, stdout=subprocess.PIPE).stdout.decode()
    return [line for line in processes.splitlines() if folder + "/flexarm_film_" in line]


@needs_browser
@pytest.mark.parametrize("number, name", [(signal.SIGINT, "a.mp4"), (signal.SIGTERM, "a.gif")])
def test_an_interruption_leaves_nothing(folder, short_folder, number, name):
    process = subprocess.Popen([os.environ["FLEXARM_PROGRAM"], "film", "ball.html", "-o", name, "--speed", "0.001"],
                               cwd=folder, stderr=subprocess.PIPE, start_new_session=True,
                               env={**os.environ, "TMPDIR": short_folder})
    end = time.monotonic() + 60
    while not any(entry.endswith(".part") for entry in os.listdir(folder)) and time.monotonic() < end:
        time.sleep(0.05)
    assert left_behind(short_folder)
    os.killpg(process.pid, number)  # as a terminal does
    assert process.communicate(timeout=1000)[1] == b"flexarm: film: interrupted\n"
    assert process.returncode == 128 + number
    assert os.listdir(folder) == ["ball.html"] and os.listdir(short_folder) == []
    end = time.monotonic() + 10
    while left_behind(short_folder) and time.monotonic() < end:
        time.sleep(0.05)
    assert not left_behind(short_folder)


@pytest.mark.parametrize("arguments, said", [
    ([], "the following arguments are required: PAGE|SCENE"),
    (["a.html", "-o", "a.avi"], "--output: expected a name that ends in .mp4, .gif or .png, got 'a.avi'"),
    (["a.html", "-o", "%s.png"], "--output: expected one number such as %04d in the name of a series, got '%s.png'"),
    (["a.html", "-o", "%d%d.png"], "expected one number such as %04d in the name of a series, got '%d%d.png'"),
    (["a.html", "--size", "1280"], "--size: expected WIDTHxHEIGHT, whole numbers from 16 to 4096, got '1280'"),
    (["a.html", "--size", "5000x100"], "--size: expected WIDTHxHEIGHT, whole numbers from 16 to 4096, got '5000x100'"),
    (["a.html", "--size", "641x480"], "--size: expected even numbers for MP4, got 641x480"),
    (["a.html", "--rate", "0"], "--rate: expected a number > 0, got '0'"),
    (["a.html", "-o", "a.gif", "--rate", "60"], "--rate: expected at most 50 for GIF, got 60"),
    (["a.html", "--at", "1"], "--at: expected --output NAME.png, got 'a.mp4'"),
    (["a.html", "-o", "a.png", "--from", "1"], "--from: one picture has one time, --at; "),
    (["a.html", "--from", "2", "--until", "1"], "expected --from before --until, got 2 and 1"),
    (["a.html", "--camera", "1,2"], "--camera: expected three numbers, X,Y,Z, got '1,2'"),
    (["a.html", "--camera", "1,2,nan"], "--camera: expected a number, got 'nan'"),
    (["a.html", "--view", "up"], "--view: expected x, y, z, or three numbers, X,Y,Z, got 'up'"),
    (["a.html", "--view", "x", "--target", "0,0,0"], "--view: expected no --camera or --target beside it"),
    (["a.html", "--show", "loads"], "--show: expected names from grid, world, "),
])
def test_wrong_usage(tmp_path, arguments, said):
    assert said in film(tmp_path, *arguments, status=2)


@needs_browser
def test_files_that_cannot_be_used(folder):
    (folder / "text.html").write_text("<!DOCTYPE html><p>Nothing</p>")
    (folder / "live.html").write_text('<script type="application/json" class="flexarm-live">{}</script>')
    (folder / "fake.html").write_text('<script class="flexarm-picture">{}</script>')
    (folder / "bad.urdf").write_text("<robot")
    write_page(folder / "damaged.html", ball([[0, 0, 0]], [0.0]).replace("flexarm-motion\">", "flexarm-motion\">x"))
    page = (folder / "ball.html").read_text()
    for part in (0.3, 0.99):
        (folder / ("cut_%g.html" % part)).write_text(page[:int(part * len(page))])
    for words, said in ((["none.html"], "cannot read 'none.html': No such file or directory"),
                        (["text.html"], "text.html: the page has no run; expected a page that `flexarm show` wrote"),
                        (["live.html"], "live.html: a live page has no run that could be filmed"),
                        (["fake.html"], "fake.html: the page is none of flexarm show"),
                        (["cut_0.3.html"], "cut_0.3.html: the page is incomplete: it has lost its end"),
                        (["cut_0.99.html"], "cut_0.99.html: the page is incomplete: it has lost its end"),
                        (["damaged.html"], "damaged.html: "), (["bad.urdf"], "bad.urdf"),
                        (["ball.html", "-o", "no/a.mp4"], "cannot write 'no/a.mp4': there is no folder 'no'"),
                        (["ball.html", "--", "--set", "a=1"], "options behind -- are for scenes, which are simulated")):
        assert said in film(folder, *words, status=2)
    assert not [name for name in os.listdir(folder) if not name.endswith((".html", ".urdf"))]


@needs_browser
@pytest.mark.parametrize("missing, package", [("chromium", "chromium"), ("chromedriver", "chromium-driver"),
                                              ("ffmpeg", "ffmpeg"), ("selenium", "python3-selenium")])
def test_without_a_package_it_is_told_which_one(folder, missing, package):
    programs = folder / "bin"
    programs.mkdir()
    for name in {"chromium", "chromedriver", "ffmpeg"} - {missing}:
        (programs / name).symlink_to(shutil.which(name))
    # The driver is also looked for in folders outside PATH, and may be there.
    hidden = {"selenium": "import sys\nsys.modules['selenium'] = None\n",
              "chromedriver": "import shutil\nfind = shutil.which\n"
                              "shutil.which = lambda name: None if name.endswith('chromedriver') else find(name)\n"}
    (folder / "sitecustomize.py").write_text(hidden.get(missing, ""))
    said = film(folder, "ball.html", status=2, PATH=str(programs), PYTHONPATH=str(folder))
    assert said == "flexarm: film: films need Debian's package %s, which is missing\n" % package
