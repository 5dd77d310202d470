"""The command `flexarm film`."""

import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile

from ..sweep.progress import ProgressBar
from . import output
from .arguments import read_arguments
from .browser import Browser, find_browser
from .errors import FilmError, InputError

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 128  # exit status, as of flexarm's other commands
SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP
SAMPLES = 24  # frames from which the palette of a GIF is made
LEAST_PAGE_RATE = 60  # instants of a simulated second in the page of a scene
SHORTEST = 1e-3  # that a scene is simulated [s]


class Interrupted(BaseException):
    """A signal has ended the program; the argument is its number."""


def _interrupt(number, _frame):
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)  # another one must not disturb the cleaning
    raise Interrupted(number)


# ---------------------------------------------------------------- the page

def _is_page(path):
    """Whether a file is a page and no scene. Raises InputError if it is a page without a run."""
    try:
        with open(path, "rb") as file:
            text = file.read()
    except OSError as error:
        raise InputError("cannot read '%s': %s" % (path, error.strerror)) from None
    if not (path.lower().endswith((".html", ".htm")) or text[:100].lstrip().lower().startswith(b"<!doctype html")):
        return False
    if b'class="flexarm-picture"' in text:
        return True
    if b'class="flexarm-live"' in text:
        raise InputError("%s: a live page has no run that could be filmed" % path)
    raise InputError("%s: the page has no run; expected a page that `flexarm show` wrote" % path)


def _program():
    """The program flexarm beside this package, which is in lib/python3/dist-packages of the same installation."""
    here = os.path.dirname(os.path.abspath(__file__))
    beside = os.path.normpath(os.path.join(here, "..", "..", "..", "..", "flexarm", "flexarm"))
    found = beside if os.access(beside, os.X_OK) else os.environ.get("FLEXARM_PROGRAM") or shutil.which("flexarm")
    if not found:
        raise InputError("the program flexarm, which simulates scenes, is not installed")
    return found


def _simulate(arguments, page):
    """Writes the page of a scene. Returns the exit status of `flexarm show`; a failed run has a page, too."""
    words = [_program(), "show", arguments.source, "--output", page, *arguments.of_show]
    given = {word.partition("=")[0] for word in arguments.of_show}
    until = arguments.until
    if until is None and arguments.is_still:
        until = max(arguments.at or 0.0, SHORTEST)
    if until is not None and "--until" not in given:
        words += ["--until", repr(until)]
    if "--rate" not in given:
        per_second = arguments.rate / arguments.speed  # so that frames are instants of the page
        words += ["--rate", repr(per_second * math.ceil(LEAST_PAGE_RATE / per_second))]
    if arguments.quiet and "--quiet" not in given:
        words.append("--quiet")
    return subprocess.run(words, check=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL).returncode


# ---------------------------------------------------------------- time

def _clip(runs, name):
    """The part of the runs that is filmed: its start and end, and whether it is a clip, which begins anew."""
    clips = next((run["clips"] for run in runs if run["clips"]), [])
    if not clips:
        if name is not None:
            raise InputError("--clip: the page has no clips, got '%s'" % name)
        return min(run["start"] for run in runs), max(run["end"] for run in runs), False
    numbers = {str(k + 1): clip for k, clip in enumerate(clips)}
    numbers.update({clip["name"]: clip for clip in clips})
    if name is not None and name not in numbers:
        raise InputError("--clip: expected a number from 1 to %d or one of '%s', got '%s'"
                         % (len(clips), "', '".join(clip["name"] for clip in clips), name))
    chosen = clips[0] if name is None else numbers[name]
    return chosen["start"], chosen["end"], True


def frame_times(arguments, runs):
    """The times of all frames, as the page counts them."""
    start, end, is_clip = _clip(runs, arguments.clip)
    zero = start if is_clip else 0.0

    def inside(name, value):
        slack = 1e-9 * max(abs(start), abs(end))
        if not start - slack <= zero + value <= end + slack:
            raise InputError("%s: expected a time from %g s to %g s, got %g" % (name, start - zero, end - zero, value))
        return min(max(zero + value, start), end)

    if arguments.is_still:
        return [start if arguments.at is None else inside("--at", arguments.at)]
    begin = start if arguments.begin is None else inside("--from", arguments.begin)
    stop = end if arguments.until is None else inside("--until", arguments.until)
    step = arguments.speed / arguments.rate
    # The end of a clip is its start, so a clip that is played again must not have both.
    is_loop = is_clip and begin == start and stop == end
    count = max(round((stop - begin) / step), 1) if is_loop else math.floor((stop - begin) / step + 1e-6) + 1
    # Not k * step, whose factor has round-off: frame 3 of 10 per second is at 0.3 s, as the row is.
    return [min(begin + k * arguments.speed / arguments.rate, stop) for k in range(count)] * arguments.repeat


# ---------------------------------------------------------------- the film

def _frames(browser, arguments, times, samples):
    """The pictures of the film. Those of GIFs begin with samples, which are taken once."""
    bar = ProgressBar(0, len(times), not arguments.quiet)
    taken = {}
    try:
        for k in samples:
            taken[k] = browser.capture(times[k], arguments.size, arguments.title)
            bar.show(len(taken), 0)
            yield taken[k]
        for k, instant in enumerate(times):
            yield taken.pop(k, None) or browser.capture(instant, arguments.size, arguments.title)
            bar.show(k + 1 + len(taken), 0)
    finally:
        bar.clear()


def _write(browser, arguments, times):
    if arguments.kind == ".png":
        folder, name = os.path.split(arguments.output)
        for k, png in enumerate(_frames(browser, arguments, times, [])):
            output.write_picture(os.path.join(folder, name % k if arguments.is_series else name), png)
        return
    count = min(SAMPLES, len(times)) if arguments.kind == ".gif" else 0
    samples = sorted({round(k * (len(times) - 1) / max(count - 1, 1)) for k in range(count)})
    output.encode(arguments.output, arguments.kind, arguments.rate,
                  _frames(browser, arguments, times, samples), len(samples))


def _film(arguments, folder):
    is_page = _is_page(arguments.source)
    find_browser()
    if arguments.kind != ".png":
        output.find_ffmpeg()
    output.check_place(arguments.output)
    if is_page and arguments.of_show:
        raise InputError("options behind -- are for scenes, which are simulated; '%s' is a page" % arguments.source)
    page, status = arguments.source, DONE
    if not is_page:
        page = os.path.join(folder, os.path.splitext(os.path.basename(page))[0] + ".html")
        status = _simulate(arguments, page)
        if not os.path.exists(page):
            return status or FAILED
        if status:
            arguments.until = None  # the run has ended earlier
    browser = Browser()
    try:
        times = frame_times(arguments, browser.open(page))
        browser.arrange(arguments.size, **{name: getattr(arguments, name) for name in (
            "dark", "color", "show", "hide", "view", "camera", "target", "zoom")})
        _write(browser, arguments, times)
    finally:
        browser.close()
    if not arguments.quiet:
        print(_summary(arguments, len(times)))
    return status


def _summary(arguments, count):
    size = "%dx%d" % arguments.size
    if arguments.is_still:
        return "%s: %s" % (arguments.output, size)
    if arguments.is_series:
        return "%s: %d pictures, %s" % (arguments.output, count, size)
    return "%s: %d frames, %.3g s, %s" % (arguments.output, count, count / arguments.rate, size)


def main(words):
    """Runs the command line. Returns the exit status."""
    arguments = read_arguments(words)
    for number in SIGNALS:
        signal.signal(number, _interrupt)
    folder = tempfile.mkdtemp(prefix="flexarm_film_")
    try:
        return _film(arguments, folder)
    except (InputError, FilmError) as error:
        print("flexarm: film: %s" % error, file=sys.stderr)
        return BAD_INPUT if isinstance(error, InputError) else FAILED
    except OSError as error:
        print("flexarm: film: cannot write '%s': %s" % (arguments.output, error.strerror), file=sys.stderr)
        return FAILED
    except Interrupted as interruption:
        print("flexarm: film: interrupted", file=sys.stderr)
        return INTERRUPTED + interruption.args[0]
    finally:
        shutil.rmtree(folder, ignore_errors=True)
