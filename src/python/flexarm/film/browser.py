"""A browser without a window, and the page of a run in it."""

import base64
import contextlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time

from .errors import FilmError, InputError

PROGRAMS = "chromium", "chromium-browser", "google-chrome"
DRIVERS = "chromedriver", "/usr/lib/chromium-browser/chromedriver", "/usr/lib/chromium/chromedriver"
# WebGL is drawn by software, so that pictures are the same on all machines; all else is drawn without it, which is
# faster.
SWITCHES = ("--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-rasterization",
            "--disable-accelerated-2d-canvas", "--disable-dev-shm-usage",
            "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run",
            "--hide-scrollbars", "--force-device-scale-factor=1", "--window-size=500,400")
PATIENCE = 600  # with a page [s]
START = 60  # of the driver [s]
LONGEST_PLACE = 40  # letters of the folder for temporary files; Chromium makes a socket in it, whose path is limited
LONGEST = 320  # side of the page's own picture [pixels]; it is drawn beside each frame, so a small one saves time

READY = """const done = arguments[0];
    if (!window.flexarm) { done({error: "the page is none of flexarm show"}); return; }
    flexarm.ready.then(() => done({errors: [...flexarm.errors], runs: flexarm.runs.map((run) => ({
        start: run.start, end: run.start + run.duration,
        clips: run.picture.clips.map(({name, first, count}) => (
            {name, start: run.store.time(first), end: run.store.time(first + count - 1)}))}))}),
        (error) => done({error: String(error)}));"""

# Gives the page's picture the film's shape: what fits into it then fits into the film, too.
SHAPE = """const [width, height, done] = arguments;
    Object.assign(document.getElementById("picture").style,
        {position: "fixed", left: 0, top: 0, width: `${width}px`, height: `${height}px`});
    requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(() => done(null))));"""

ARRANGE = """const {dark, color, show, hide, view, camera, target, zoom} = arguments[0];
    flexarm.theme = dark ? "dark" : "light";
    if (color) flexarm.color = color;
    if (show.length || hide.length)
      flexarm.shown = [...flexarm.shown, ...show].filter((thing) => !hide.includes(thing));
    const now = flexarm.camera;
    if (!now) return;
    if (view) flexarm.lookFrom(view);
    if (camera || target) flexarm.camera = {position: camera || now.position, target: target || now.target};
    if (zoom !== 1)
      flexarm.camera = {fov: 360 / Math.PI * Math.atan(Math.tan(now.fov * Math.PI / 360) / zoom)};"""

CAPTURE = """const [time, width, height, title, done] = arguments;
    const fail = (error) => done({error: String(error && error.message || error)});
    flexarm.setTime(time);
    flexarm.capture(width, height, title).then((blob) => {
      const reader = new FileReader();
      reader.onload = () => done({data: reader.result});
      reader.onerror = () => fail(reader.error);
      reader.readAsDataURL(blob);
    }, fail);"""


def find_browser():
    """Return the paths of Chromium and its driver, and Selenium's module. Raise InputError if one is missing."""
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    driver = next(filter(None, map(shutil.which, DRIVERS)), None)
    for path, package in ((program, "chromium"), (driver, "chromium-driver")):
        if not path:
            raise InputError("films need Debian's package %s, which is missing" % package)
    try:
        from selenium import webdriver
    except ImportError:
        raise InputError("films need Debian's package python3-selenium, which is missing") from None
    return program, driver, webdriver


@contextlib.contextmanager
def _failures(what):
    """Exceptions of Selenium and of its connection become errors of the film."""
    try:
        yield
    except Exception as error:
        lines = str(getattr(error, "msg", None) or error).splitlines()
        raise FilmError("%s: %s" % (what, lines[0] if lines else type(error).__name__)) from None


def _require_end(path):
    """Refuse a page that has lost its end, for example in a copy that was not finished."""
    try:
        with open(path, "rb") as file:
            begin = file.read(1000)
            file.seek(max(os.path.getsize(path) - 1000, 0))
            end = file.read()
    except OSError as error:
        raise InputError("%s: %s" % (path, error.strerror)) from None
    if b"<title>flexarm</title>" in begin and not end.rstrip().endswith(b"</html>"):
        raise InputError("%s: the page is incomplete: it has lost its end" % path)


class Browser:
    """Chromium without a window. It must be closed, else its processes stay."""

    def __init__(self):
        program, driver, self._webdriver = find_browser()
        self._session = self._driver = None
        is_short = len(os.fsencode(tempfile.gettempdir())) <= LONGEST_PLACE
        self._folder = tempfile.mkdtemp(prefix="flexarm_film_", dir=None if is_short else "/tmp")
        try:
            self._start(program, driver)
        except BaseException:
            self.close()
            raise

    def _start(self, program, driver):
        log = os.path.join(self._folder, "driver.log")
        with open(log, "wb") as file:
            # In a session of its own, for Ctrl-C in a terminal would end it before it has closed the browser.
            self._driver = subprocess.Popen([driver, "--port=0"], stdin=subprocess.DEVNULL, stdout=file, stderr=file,
                                            start_new_session=True, env={**os.environ, "TMPDIR": self._folder})
        address = "http://127.0.0.1:%d" % self._port(log)
        os.environ["no_proxy"] = os.environ["NO_PROXY"] = "127.0.0.1"
        options = self._webdriver.ChromeOptions()
        options.binary_location = program
        for switch in (*SWITCHES, "--user-data-dir=" + os.path.join(self._folder, "profile")):
            options.add_argument(switch)
        if os.geteuid() == 0:
            options.add_argument("--no-sandbox")  # without which Chromium refuses root
        with _failures("Chromium cannot be started"):
            self._session = self._webdriver.Remote(command_executor=address, options=options)
            self._session.set_page_load_timeout(PATIENCE)
            self._session.set_script_timeout(PATIENCE)

    def _port(self, log):
        """Return the port that the driver has chosen."""
        end = time.monotonic() + START
        while time.monotonic() < end and self._driver.poll() is None:
            with open(log, encoding="utf-8", errors="replace") as file:
                found = re.search(r"started successfully on port (\d+)", file.read())
            if found:
                return int(found.group(1))
            time.sleep(0.02)
        raise FilmError("Chromium's driver has not started")

    def open(self, path):
        """Open a page, and wait until its first picture is drawn. Return its runs, each with start, end and clips."""
        _require_end(path)
        with _failures("the browser cannot open '%s'" % path):
            self._session.get(pathlib.Path(os.path.abspath(path)).as_uri())
            answer = self._session.execute_async_script(READY)
        if "error" in answer:
            raise InputError("%s: %s" % (path, answer["error"]))
        if answer["errors"] or not answer["runs"]:
            raise InputError("%s: %s" % (path, " ".join(answer["errors"]) or "the page has no run"))
        return answer["runs"]

    def arrange(self, size, **wishes):
        """Set camera, colours and what is shown, as ARRANGE reads it."""
        factor = LONGEST / max(size)
        with _failures("the page cannot be arranged"):
            self._session.execute_async_script(SHAPE, *(max(round(factor * length), 1) for length in size))
            self._session.execute_script(ARRANGE, wishes)

    def run(self, script, *arguments):
        """Return what a script in the page returns."""
        return self._session.execute_script(script, *arguments)

    def capture(self, instant, size, title):
        """Return the picture at a time, as the bytes of a PNG file."""
        with _failures("the browser has failed"):
            answer = self._session.execute_async_script(CAPTURE, instant, *size, title)
        if "error" in answer:
            raise FilmError("the page cannot be drawn: " + answer["error"])
        return base64.b64decode(answer["data"].partition(",")[2])

    def close(self):
        try:
            if self._session:
                self._session.quit()
        except Exception:  # pylint: disable=broad-except
            pass  # it has gone already
        if self._driver:
            try:
                os.killpg(self._driver.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            self._driver.wait()
        shutil.rmtree(self._folder, ignore_errors=True)
