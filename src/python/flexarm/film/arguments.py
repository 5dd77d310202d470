"""The command line of `flexarm film`."""

import argparse
import math
import os
import re

LARGEST = 4096  # pixels; what browsers and players of H.264 are sure to take
LARGEST_GIF_RATE = 50  # browsers play faster ones slowly
# What a film has if nothing else is asked for: its size, and frames per second.
DEFAULTS = {".mp4": ((1280, 720), 30), ".gif": ((640, 360), 20), ".png": ((1280, 720), 30)}
VIEWS = {"x": (1, 0, 0), "y": (0, -1, 0), "z": (0, 0, 1)}
COLORS = "strain", "axial", "shear", "torsion", "bending", "velocity", "plain"
THINGS = "grid", "world", "axes", "still", "effort", "load", "reaction", "contact", "probes", "trails", "lines"


def read_arguments(words):
    """Return the options, with defaults in place. Words behind `--` are `of_show`, options of `flexarm show`."""
    own, of_show = _split(words)
    parser = _parser()
    arguments = parser.parse_args(own)
    arguments.of_show = of_show
    stem = os.path.splitext(os.path.basename(arguments.source))[0]
    arguments.output = arguments.output or stem + ".mp4"
    arguments.kind = os.path.splitext(arguments.output)[1].lower()
    if arguments.kind not in DEFAULTS:
        parser.error("--output: expected a name that ends in .mp4, .gif or .png, got '%s'" % arguments.output)
    arguments.is_series = arguments.kind == ".png" and "%" in os.path.basename(arguments.output)
    arguments.is_still = arguments.kind == ".png" and not arguments.is_series
    _check(parser, arguments)
    size, rate = DEFAULTS[arguments.kind]
    arguments.size = arguments.size or size
    arguments.rate = arguments.rate or rate
    return arguments


def _split(words):
    """Return the words before and behind `--`. Vectors may begin with a minus, which argparse takes for an option."""
    at = words.index("--") if "--" in words else len(words)
    own = []
    for word in words[:at]:
        if own and own[-1] in ("--camera", "--target", "--view", "--from", "--at"):
            own[-1] += "=" + word
        else:
            own.append(word)
    return own, words[at + 1:]


def _parser():
    parser = argparse.ArgumentParser(
        prog="flexarm film", usage="flexarm film [OPTIONS] PAGE|SCENE [-- OPTIONS OF flexarm show]",
        description="Films a run: the picture that a page of `flexarm show` plays, as MP4, GIF or PNG, without a "
                    "display (docs/film.md).")
    parser.add_argument("source", metavar="PAGE|SCENE",
                        help="page that `flexarm show` wrote (.html), or a scene, which is simulated first")
    parser.add_argument("-o", "--output", metavar="FILE",
                        help="NAME.mp4, NAME.gif, NAME.png for one picture, or NAME_%%04d.png for a picture of each "
                             "frame (the page's or scene's name, .mp4)")
    parser.add_argument("--quiet", action="store_true", help="no progress bar and no summary")

    time = parser.add_argument_group("time")
    time.add_argument("--from", dest="begin", type=_number, metavar="T", help="time where the film begins [s] (start)")
    time.add_argument("--until", type=_number, metavar="T",
                      help="time where it ends [s] (end of the run); a scene is simulated until then (10)")
    time.add_argument("--at", type=_number, metavar="T", help="time of the picture, for NAME.png [s] (start)")
    time.add_argument("--rate", type=_positive, help="frames per second (30; GIF: 20)")
    time.add_argument("--speed", type=_positive, default=1.0,
                      help="simulated seconds in a second of the film (1); 0.1: slow motion")
    time.add_argument("--clip", metavar="NAME", help="part of the run, such as a natural mode: its name, or its number "
                                                     "from 1 on (1); times count from its start")
    time.add_argument("--repeat", type=_count, default=1, metavar="N", help="plays everything N times (1)")

    picture = parser.add_argument_group("picture")
    picture.add_argument("--size", type=_size, metavar="WxH", help="in pixels (1280x720; GIF: 640x360)")
    picture.add_argument("--title", default="", metavar="TEXT", help="text above the picture")
    picture.add_argument("--camera", type=_vector, metavar="X,Y,Z", help="place of the camera [m]")
    picture.add_argument("--target", type=_vector, metavar="X,Y,Z", help="point that the camera looks at [m]")
    picture.add_argument("--view", type=_view, metavar="DIRECTION",
                         help="looks from this direction at all that moves: x, y, z (as the page's keys) or X,Y,Z")
    picture.add_argument("--zoom", type=_positive, default=1.0, help="makes everything larger by this factor (1)")
    picture.add_argument("--color", choices=COLORS, help="what the colours of beams show (the page's choice)")
    picture.add_argument("--show", type=_things, default=[], metavar="A,B", help="shows more: " + ", ".join(THINGS))
    picture.add_argument("--hide", type=_things, default=[], metavar="A,B", help="hides some of these")
    picture.add_argument("--dark", action="store_true", help="dark background")
    return parser


def _check(parser, arguments):
    """Refuse options that do not fit together."""
    name = os.path.basename(arguments.output)
    if arguments.is_series and not re.fullmatch(r"[^%]*%(0[1-9])?d[^%]*", name):
        parser.error("--output: expected one number such as %%04d in the name of a series, got '%s'" % name)
    if arguments.is_still and arguments.begin is not None:
        parser.error("--from: one picture has one time, --at; a series of pictures has a name such as NAME_%04d.png")
    if arguments.at is not None and not arguments.is_still:
        parser.error("--at: expected --output NAME.png, got '%s'" % arguments.output)
    if None not in (arguments.begin, arguments.until) and arguments.begin > arguments.until:
        parser.error("expected --from before --until, got %g and %g" % (arguments.begin, arguments.until))
    if arguments.view and (arguments.camera or arguments.target):
        parser.error("--view: expected no --camera or --target beside it")
    if arguments.kind == ".mp4" and arguments.size and any(length % 2 for length in arguments.size):
        parser.error("--size: expected even numbers for MP4, got %dx%d" % arguments.size)
    if arguments.kind == ".gif" and arguments.rate and arguments.rate > LARGEST_GIF_RATE:
        parser.error("--rate: expected at most %d for GIF, got %g" % (LARGEST_GIF_RATE, arguments.rate))


def _number(text):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError("expected a number, got '%s'" % text)
    return value


def _positive(text):
    value = _number(text)
    if value <= 0:
        raise argparse.ArgumentTypeError("expected a number > 0, got '%s'" % text)
    return value


def _count(text):
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError("expected a whole number >= 1, got '%s'" % text)
    return int(text)


def _size(text):
    found = re.fullmatch(r"([0-9]{1,6})x([0-9]{1,6})", text)
    size = tuple(map(int, found.groups())) if found else (0, 0)
    if not all(16 <= length <= LARGEST for length in size):
        raise argparse.ArgumentTypeError("expected WIDTHxHEIGHT, whole numbers from 16 to %d, got '%s'"
                                         % (LARGEST, text))
    return size


def _vector(text):
    words = text.split(",")
    if len(words) != 3:
        raise argparse.ArgumentTypeError("expected three numbers, X,Y,Z, got '%s'" % text)
    return [_number(word) for word in words]


def _view(text):
    if text not in VIEWS and "," not in text:
        raise argparse.ArgumentTypeError("expected x, y, z, or three numbers, X,Y,Z, got '%s'" % text)
    direction = VIEWS[text] if text in VIEWS else _vector(text)
    if not any(direction):
        raise argparse.ArgumentTypeError("expected a direction, got '%s'" % text)
    return direction


def _things(text):
    things = text.split(",")
    for thing in things:
        if thing not in THINGS:
            raise argparse.ArgumentTypeError("expected names from %s, got '%s'" % (", ".join(THINGS), thing))
    return things
