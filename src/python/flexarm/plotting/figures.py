"""Draws a Plot by matplotlib, which is imported only then."""

import os
import warnings

import numpy

from ..errors import ResultsError
from .curves import FREQUENCY, TIME, printable

# Colours of Okabe and Ito, which can be told apart by the colour-blind, without yellow, which is too faint for lines.
COLOURS = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"
STYLES = "-", (0, (5, 2)), (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5)), (0, (6, 1.5, 1, 1.5, 1, 1.5))
DOTS = 100  # per inch: fonts of 10 points have 14 pixels
WIDTH, HEIGHT, REST = 900, 260, 60  # of a figure, of a panel over time, of title and axis of time [pixels]
LEGEND_WIDTH = 210  # of a column of the legend [pixels]
LONGEST_NAME = 40  # in characters; the legend takes room from the curves
MOST_ENTRIES = 12  # of the legend in a column at the usual height of a panel
SETTINGS = {
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.xmargin": 0.01,
    "grid.alpha": 0.3, "grid.linewidth": 0.6,
    "lines.linewidth": 1.4, "font.size": 10, "axes.titlesize": 11, "legend.fontsize": 9,
}
SETTINGS_OF_FILES = {
    "svg.fonttype": "none",  # text stays text
    "agg.path.chunksize": 10000,  # without this, curves of very many points cannot be drawn
}


def has_display():
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def import_pyplot():
    """matplotlib's pyplot; without a display never with a backend that needs one."""
    try:
        import matplotlib
    except ImportError:
        raise ResultsError("pictures are drawn by Debian's package python3-matplotlib, which is missing") from None
    # Notebooks have backends of their own, which are modules.
    if not has_display() and not matplotlib.get_backend().startswith(("module://", "inline")):
        matplotlib.use("Agg")
    try:
        from matplotlib import pyplot
    except ImportError:  # matplotlib before 3.4 imports the toolkit of its windows at once, which may be missing
        matplotlib.use("Agg")
        from matplotlib import pyplot
    return pyplot


def draw(plot, size=None):
    """A figure of matplotlib. size: width and height in pixels; None: according to the number of panels."""
    pyplot = import_pyplot()
    count = len(plot.panels)
    is_phase = plot.panels[0].x_label not in (TIME, FREQUENCY)
    width, height = size or (WIDTH + LEGEND_WIDTH * (max(map(_legend_columns, plot.panels)) - 1),
                             REST + (2 if is_phase else 1) * HEIGHT * count)
    with pyplot.rc_context(SETTINGS):
        figure = pyplot.figure(figsize=(width / DOTS, height / DOTS), dpi=DOTS, constrained_layout=True)
        above = label = None
        for row, panel in enumerate(plot.panels):
            is_shared = panel.x_label == label
            axes = figure.add_subplot(count, 1, row + 1, sharex=above if is_shared else None)
            _draw_panel(axes, panel, plot, is_first=row == 0)
            if is_shared:  # one label for both, at the lower one
                above.set_xlabel("")
                above.tick_params(labelbottom=False)
            above, label = axes, panel.x_label
        figure.align_ylabels()
        if plot.title:
            figure.suptitle(_text(plot.title, width // 9), fontsize="large")
    return figure


def _draw_panel(axes, panel, plot, is_first):
    from matplotlib.lines import Line2D

    names = list(dict.fromkeys(curve.name for curve in panel.curves))
    for curve in panel.curves:
        axes.plot(curve.x, curve.y, marker=".", markevery=_between_gaps(curve.x + curve.y),
                  **_look(plot, names.index(curve.name), curve.run))
    for axis, scale in (("x", axes.set_xscale), ("y", axes.set_yscale)):
        if axis in plot.log:
            scale("log")
    if panel.is_path:
        axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(_text(panel.x_label))
    axes.set_ylabel(_text(panel.y_label))
    entries = []
    if is_first and len(plot.runs) > 1:
        grey = {} if _colours_are_runs(plot) else {"color": "0.35"}
        entries += [(name, {**_look(plot, 0, run), **grey}) for run, name in enumerate(plot.runs)]
    if len(names) > 1:
        entries += [(name, _look(plot, column, None)) for column, name in enumerate(names)]
    if entries:
        # Beside the curves, never above them. matplotlib leaves out names that begin with "_".
        axes.legend([Line2D([], [], **look) for _, look in entries], [" " + _text(name) for name, _ in entries],
                    loc="upper left", bbox_to_anchor=(1.01, 1.02), borderaxespad=0, frameon=False, handlelength=2.6,
                    ncol=_legend_columns(panel))


def _legend_columns(panel):
    return 1 + (len({curve.name for curve in panel.curves}) - 1) // MOST_ENTRIES


def _between_gaps(values):
    """Indices of the values on both sides of which are gaps. A line alone would not show them."""
    is_gap = numpy.isnan(numpy.concatenate([[numpy.nan], values, [numpy.nan]]))
    return numpy.flatnonzero(is_gap[:-2] & ~is_gap[1:-1] & is_gap[2:]).tolist()


def _colours_are_runs(plot):
    """Colours mean runs if each panel has only one column. Else they mean columns."""
    return all(len({curve.name for curve in panel.curves}) == 1 for panel in plot.panels)


def _look(plot, column, run):
    """Colour and style of a line. column: index in the panel. run: None: of a column in all runs."""
    colour = run if run is not None and _colours_are_runs(plot) else column
    # Where colours repeat, lines of one run differ by their styles, which otherwise mean runs.
    style = (run or 0) + column // len(COLOURS)
    look = {"color": COLOURS[colour % len(COLOURS)], "linestyle": STYLES[style % len(STYLES)]}
    if run == 0 and len(plot.runs) > 1:  # is seen below other runs that coincide with it
        look.update(linewidth=3.5, alpha=0.4)
    return look


def _text(text, most=LONGEST_NAME):
    """A text that matplotlib takes as it stands, not as a formula. The middle of long ones is left out."""
    if len(text) > most:
        text = text[:most // 2] + "…" + text[-(most // 2):]
    return printable(text).replace("$", r"\$").replace("^2", "²")


def save(plot, path, size=None):
    """Writes a picture of the format that the file's name ends in."""
    figure = draw(plot, size)
    with import_pyplot().rc_context(SETTINGS_OF_FILES), warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # letters that no font has; axes that are very small
        figure.savefig(path)


def show(plot, size=None):
    """Draws in a window, and waits until it is closed. Returns whether a window could be opened."""
    pyplot = import_pyplot()
    try:
        pyplot.close(pyplot.figure())
    except Exception:  # each toolkit has its own class of errors for displays that it cannot use
        return False
    if pyplot.get_backend().lower() == "agg":  # no toolkit is installed
        return False
    draw(plot, size).canvas.manager.set_window_title(printable(plot.title or "flexarm plot"))
    pyplot.show()
    return True
