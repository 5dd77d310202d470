"""Draws a Plot with characters, by gnuplot."""

import subprocess
import textwrap

import numpy

from ..errors import ResultsError
from .curves import printable

LEAST_WIDTH, LEAST_HEIGHT = 40, 12  # of a panel, below which nothing can be seen
CHARACTERS = "*#$%@&="  # with which gnuplot draws the first curve, the second one, ...


def draw(plot, width, height):
    """The plot as text of `width` columns; of `height` lines if its panels have room there, else of more."""
    width, height = max(LEAST_WIDTH, width), height // len(plot.panels)
    lines = [line.center(width) for line in textwrap.wrap(printable(plot.title), width)]
    for panel in plot.panels:
        legend = _legend(panel, plot) if len(panel.curves) > 1 else []
        # A title of gnuplot's would be beside the picture before version 5.4.
        lines.append(printable(panel.y_label).center(width))
        commands = _commands(panel, plot.log, width, max(LEAST_HEIGHT, height - len(legend) - 1) - 1)
        lines += _run("\n".join(commands)).strip("\n\f").split("\n") + legend
    return "".join(line.rstrip() + "\n" for line in lines)


def _legend(panel, plot):
    names = [printable(curve.name if len(plot.runs) == 1 else "%s, %s" % (curve.name, plot.runs[curve.run]))
             for curve in panel.curves]
    return ["  %s %s" % (3 * CHARACTERS[i % len(CHARACTERS)], name) for i, name in enumerate(names)]


def _commands(panel, log, width, height):
    yield "set terminal dumb noenhanced size %d, %d" % (width, height)
    yield "set encoding utf8"
    yield "set border 3; set tics nomirror; set tmargin 0; set bmargin 3; set rmargin 3"
    yield "unset key"
    yield "set xlabel '%s'" % _quoted(panel.x_label)
    for axis in "xy":
        margin = 0 if axis == "x" else 1 / (height - 5)  # one line, so that no curve lies on the axis of x
        low, high = _range([getattr(curve, axis) for curve in panel.curves], axis in log, margin)
        yield "set %srange [%r:%r]" % (axis, low, high)
    for axis in log:
        yield "set logscale " + axis
    for number, curve in enumerate(panel.curves):
        yield "$curve%d << END" % number
        yield from _lines(*_thinned(curve.x, curve.y, 4 * width))
        yield "END"
    yield "plot " + ", ".join("$curve%d with lines" % number for number in range(len(panel.curves)))


def _range(parts, is_log, margin):
    """Limits of an axis: those of the values, and a margin as a part of what is between them."""
    values = numpy.concatenate(parts)
    limits = numpy.array([numpy.nanmin(values), numpy.nanmax(values)])
    limits = numpy.log(limits) if is_log else limits
    width = limits[1] - limits[0]
    extra = margin * width if width > 0 else 0.01 * abs(limits[0]) or 1.0
    limits += [-extra, extra]
    return (numpy.exp(limits) if is_log else limits).tolist()


def _lines(x, y):
    """Pairs of numbers; an empty line is a gap."""
    for pair in zip(x.tolist(), y.tolist()):
        yield "" if numpy.isnan(pair).any() else "%r %r" % pair


def _thinned(x, y, count):
    """The ends, and of each of `count` groups of points the smallest and the largest value, or one gap."""
    if len(x) <= 2 * count:
        return x, y
    chosen = [0]
    for part in numpy.array_split(numpy.arange(len(x)), count):
        values = y[part]
        if numpy.isnan(values).all():
            chosen.append(part[0])
        else:
            chosen += sorted({part[numpy.nanargmin(values)], part[numpy.nanargmax(values)]})
    chosen.append(len(x) - 1)
    return x[chosen], y[chosen]


def _quoted(text):
    """For gnuplot, within single quotes, where nothing but these has a meaning."""
    return printable(text).replace("'", "''")


def _run(commands):
    try:
        result = subprocess.run(["gnuplot"], input=commands.encode(), check=False, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)
    except FileNotFoundError:
        raise ResultsError("plots in the terminal are drawn by Debian's package gnuplot-nox, which is missing; "
                           "--output FILE makes a picture") from None
    if result.returncode != 0:
        raise ResultsError("gnuplot: " + result.stderr.decode(errors="replace").strip())
    return result.stdout.decode(errors="replace")
