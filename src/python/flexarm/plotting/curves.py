"""Chooses what a plot shows: curves in panels, one panel for each unit. Independent of how it is drawn."""

import os
import typing

import numpy

from ..errors import ResultsError

TIME, FREQUENCY = "time [s]", "frequency [Hz]"
LARGEST = 1e300  # matplotlib and gnuplot fail at larger values


class Curve(typing.NamedTuple):
    name: str  # of the column
    run: int  # index of the run
    x: numpy.ndarray
    y: numpy.ndarray  # NaN: a gap


class Panel(typing.NamedTuple):
    """Curves with common axes."""

    x_label: str
    y_label: str
    is_path: bool  # lengths over lengths, which need the same scale
    curves: typing.List[Curve]


class Plot(typing.NamedTuple):
    title: str
    runs: typing.List[str]  # names of the runs, by Curve.run
    panels: typing.List[Panel]
    log: str  # axes with a logarithmic scale: "", "x", "y", "xy"


def choose(runs, columns, difference, spectrum, phase, log, window, max_frequency, title):
    """The Plot of some runs; arguments as of Run.plot(). Raises ResultsError."""
    if spectrum and phase:
        raise ResultsError("expected either a spectrum or a phase plot")
    for run in runs:
        if not len(run.rows):
            raise ResultsError("%s: there are no rows" % run.name)
    units = _units(runs)
    names = short_names([run.name for run in runs])
    heading = names[0] if len(runs) == 1 else ""
    if difference:
        if len(runs) < 2:
            raise ResultsError("expected at least two runs for a difference, got one")
        heading = "difference to %s, interpolated linearly to its times" % names[0]
        runs, names = [run.minus(runs[0]) for run in runs[1:]], names[1:]
        heading = "%s: %s" % (names[0], heading) if len(runs) == 1 else heading
    if phase:
        entries = _phases(runs, units, phase)
    elif spectrum:
        entries = _spectra(runs, units, columns, window, max_frequency)
    else:
        entries = _histories(runs, units, columns)
    what = [word for word, is_so in (("amplitude", spectrum), ("difference", difference)) if is_so]
    return Plot(heading if title is None else title, names, _panels(entries, " of ".join(what), log), log)


def short_names(paths):
    """Names of files without their folders, if they still differ then."""
    names = [os.path.basename(path) or path for path in paths]
    return names if len(set(names)) == len(names) else list(paths)


def _histories(runs, units, patterns):
    """Yields (label of x, unit of y, Curve)."""
    for index, run in enumerate(runs):
        for name in run.columns(patterns):
            yield TIME, units[name], Curve(name, index, run.times, run[name])


def _spectra(runs, units, patterns, window, max_frequency):
    for index, run in enumerate(runs):
        for name in run.columns(patterns):
            frequencies, amplitudes = run.spectrum(name, window)
            shown = frequencies <= max_frequency
            yield FREQUENCY, units[name], Curve(name, index, frequencies[shown], amplitudes[shown])


def _phases(runs, units, pairs):
    for index, run in enumerate(runs):
        for pair in pairs:
            across, along = (run.columns([pattern]) for pattern in pair)
            if len(across) != len(along):
                raise ResultsError("%s: expected as many columns like '%s' as like '%s', got %d and %d"
                                   % (run.name, *pair, len(across), len(along)))
            for x, y in zip(across, along):
                yield labelled(x, units[x]), units[y], Curve(y, index, run[x], run[y])


def _units(runs):
    """Units by names. That of a file without units may be one of several: then the one of another file is taken."""
    units = {}
    for run in runs:
        for name, unit in zip(run.names, run.units):
            known = units.setdefault(name, unit)
            if not known or unit in known.split(" or "):
                units[name] = unit
            elif unit not in (known, "") and known not in unit.split(" or "):
                raise ResultsError("'%s' has the unit %s in one run and %s in another one" % (name, known, unit))
    return units


def _panels(entries, what, log):
    """Panels in the order in which their units come first. what: is shown of the columns; empty: their values."""
    groups = {}
    for x_label, unit, curve in entries:
        x, y = curve.x.copy(), curve.y.copy()
        for axis, values in (("x", x), ("y", y)):
            values[~(abs(values) < LARGEST) | ((axis in log) & (values <= 0))] = numpy.nan
        groups.setdefault((x_label, unit), []).append(curve._replace(x=x, y=y))
    panels = []
    for (x_label, unit), curves in groups.items():
        if numpy.isnan(numpy.concatenate([curve.x + curve.y for curve in curves])).all():
            raise ResultsError("nothing to draw: '%s' has no finite values%s"
                               % (curves[0].name, " greater than 0, which a logarithmic scale needs" if log else ""))
        label = " of ".join(filter(None, (what, common_name([curve.name for curve in curves]))))
        panels.append(Panel(x_label, labelled(label, unit), unit == "m" and x_label.endswith("[m]"), curves))
    return panels


def common_name(names):
    """The name itself if there is only one, else the last part of names that end in the same part, else nothing."""
    if len(set(names)) == 1:
        return names[0]
    last = {name.rpartition("/")[2] for name in names}
    return last.pop() if len(last) == 1 else ""


def labelled(name, unit):
    return (name + " " if name and unit else name) + ("[%s]" % unit if unit else "")


def printable(text):
    """A text without line breaks and other characters that control terminals."""
    return "".join(c if c.isprintable() else "?" for c in text)
