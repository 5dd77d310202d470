"""Runs as columns over time: reads them, compares them, computes spectra, draws them."""

import importlib
import os
import typing

import numpy

from .errors import ResultsError
from .result_files import Table, matching, read_table


class Spectrum(typing.NamedTuple):
    """Amplitudes over frequency: a sine of the amplitude A has a peak of the height A."""

    frequencies: numpy.ndarray  # [Hz]
    amplitudes: numpy.ndarray  # in the unit of the column


class Run:
    """The results of a simulation: columns over time, `run["joint/elbow/position"]`.

    From a file by read_run(), or from what a simulation has recorded:

        rows = simulation.run(1000, record=record)
        run = flexarm.Run(*zip(*simulation.columns(record)), rows)

    names, units: of the columns; one of them is `time`.
    rows: shape (rows, columns).
    name: of the run, for legends.
    """

    def __init__(self, names: typing.Sequence[str], units: typing.Sequence[str], rows: numpy.ndarray,
                 name: str = "run") -> None:
        self.names, self.units, self.name = tuple(names), tuple(units), name
        self.rows = numpy.asarray(rows, dtype=float)
        if self.rows.ndim != 2 or not self.rows.shape[1] == len(self.names) == len(self.units):
            raise ResultsError("%s: expected a unit and a column of 'rows' for each of %d names, got %d units and rows "
                               "of the shape %s" % (name, len(self.names), len(self.units), self.rows.shape))
        for column in ("time", *self.names):
            if self.names.count(column) != 1:
                raise ResultsError("%s: expected one column '%s', got %d" % (name, column, self.names.count(column)))

    def __repr__(self) -> str:
        return "<flexarm.Run %s: %d rows of %d columns>" % (self.name, len(self.rows), len(self.names))

    def __getitem__(self, column: str) -> numpy.ndarray:
        """A column by its name. Raises KeyError if there is none."""
        if column not in self.names:
            raise KeyError("%s has no column '%s'" % (self.name, column))
        return self.rows[:, self.names.index(column)]

    def unit(self, column: str) -> str:
        """The unit of a column; empty: unknown."""
        return self.units[self.names.index(column)]

    @property
    def times(self) -> numpy.ndarray:
        """Times of the rows [s]."""
        return self["time"]

    def columns(self, patterns: typing.Sequence[str]) -> typing.List[str]:
        """Names of the columns that fit patterns such as `joint/*/position`, in the order of the patterns.

        Raises ResultsError if a pattern fits none.
        """
        return matching(self.names, patterns, self.name + ": ")

    def between(self, begin: float, end: float) -> "Run":
        """The rows at the times from `begin` to `end` [s]. Raises ResultsError if there are none."""
        if not len(self.rows):
            raise ResultsError("%s: there are no rows" % self.name)
        slack = 1e-9 * max(1.0, abs(self.times[-1]))  # times are sums of steps, with round-off
        chosen = (self.times >= begin - slack) & (self.times <= end + slack)
        if not chosen.any():
            raise ResultsError("%s: there are no rows between %g s and %g s; the run has %g s to %g s"
                               % (self.name, begin, end, self.times[0], self.times[-1]))
        return Run(self.names, self.units, self.rows[chosen], self.name)

    def minus(self, reference: "Run") -> "Run":
        """The difference of two runs at the times of the reference, in those columns that both have.

        This run is interpolated linearly to these times. Outside of this run's times the difference is NaN.
        """
        self._check_order()
        names = [name for name in reference.names if name in self.names]
        with numpy.errstate(invalid="ignore", over="ignore"):
            rows = [reference.times if name == "time" else
                    numpy.interp(reference.times, self.times, self[name], numpy.nan, numpy.nan) - reference[name]
                    for name in names]
        return Run(names, [reference.unit(name) for name in names], numpy.transpose(rows), self.name)

    def spectrum(self, column: str, window: str = "flattop") -> Spectrum:
        """The amplitudes of a column over frequency, without its mean.

        window: a name for scipy.signal.get_window(). `flattop` shows amplitudes to 0.2 %; the peaks of two sines are
          apart if their frequencies differ by 10 / duration. `hann` needs only 4 / duration, but shows a sine whose
          frequency is between two points by up to 16 % too low.
        Rows whose times are not evenly spaced are interpolated linearly.
        """
        try:
            import scipy.signal  # type: ignore
        except ImportError:
            raise ResultsError("spectra are computed by Debian's package python3-scipy, which is missing") from None
        values, count = self[column], len(self.rows)
        if count < 8:
            raise ResultsError("%s: expected at least 8 rows for a spectrum, got %d" % (self.name, count))
        if not numpy.isfinite(values).all():
            raise ResultsError("%s: '%s' has gaps, in which a spectrum is unknown" % (self.name, column))
        self._check_order()
        times = numpy.linspace(self.times[0], self.times[-1], count)
        if abs(times - self.times).max() > 1e-6 * (times[1] - times[0]):
            values = numpy.interp(times, self.times, values)
        try:
            frequencies, powers = scipy.signal.periodogram(
                values, 1 / (times[1] - times[0]), window, scaling="spectrum")  # without the mean
        except ValueError as error:
            raise ResultsError("window '%s': %s" % (window, error)) from None
        amplitudes = numpy.sqrt(2 * powers)
        amplitudes[0] /= numpy.sqrt(2)  # these two are not halves of a pair of frequencies of either sign
        if count % 2 == 0:
            amplitudes[-1] /= numpy.sqrt(2)
        return Spectrum(frequencies, amplitudes)

    def _check_order(self) -> None:
        if len(self.rows) < 2 or not (numpy.diff(self.times) >= 0).all() or not self.times[0] < self.times[-1]:
            raise ResultsError("%s: expected times that increase" % self.name)

    def plot(self, columns: typing.Sequence[str] = ("*",), others: typing.Sequence["Run"] = (),
             difference: bool = False, spectrum: bool = False, phase: typing.Sequence[typing.Tuple[str, str]] = (),
             log: str = "", window: str = "flattop", max_frequency: float = numpy.inf,
             title: typing.Optional[str] = None, size: typing.Optional[typing.Tuple[int, int]] = None) -> typing.Any:
        """Draws columns. Returns a figure of matplotlib, with one axes for each unit.

        columns: patterns.
        others: runs that are drawn over this one.
        difference: draws the differences of the others to this run, see minus().
        spectrum: draws amplitudes over frequency, up to `max_frequency` [Hz]; `window` as in spectrum().
        phase: pairs of patterns, instead of `columns`: the second column is drawn over the first one.
        log: axes with a logarithmic scale, `x`, `y` or `xy`.
        size: width and height in pixels.
        """
        # Programs inside of the package have no types, so checkers shall not follow these imports.
        curves, figures = map(importlib.import_module, ("flexarm.plotting.curves", "flexarm.plotting.figures"))
        plot = curves.choose([self, *others], columns, difference, spectrum, phase, log, window, max_frequency, title)
        return figures.draw(plot, size)


def read_run(path: typing.Union[str, "os.PathLike[str]"],
             columns: typing.Optional[typing.Sequence[str]] = None) -> Run:
    """Reads results that `flexarm simulate --output` has written.

    path: of a CSV file, of an HDF5 file (.h5, .hdf5), or of a ROS bag (.bag), whose topics /joint_states, /tf and
      those of sensors that measure forces and moments are read, at the times of the first; "-" is
      the standard input, as CSV.
    columns: patterns of the columns that are read besides `time`; None: all.
    CSV files and bags do not have units, which then follow from the names: `rad or m` for positions of joints.
    Raises ResultsError.
    """
    table = read_columns(os.fspath(path), columns)
    return Run(table.names, table.units, table.rows, "standard input" if path == "-" else os.fspath(path))


def read_columns(file: str, columns: typing.Optional[typing.Sequence[str]] = None,
                 losses: typing.Optional[typing.List[str]] = None) -> Table:
    """Reads what read_run() reads. losses: see read_table()."""

    def choose(names: typing.Sequence[str]) -> typing.Sequence[str]:
        if not names:
            raise ResultsError("%s: expected columns, got an empty file" % file)
        for name in ("time", *names):
            if names.count(name) != 1:
                raise ResultsError("%s: expected one column '%s', got %s" % (
                    file, name, "%d" % names.count(name) if name in names else "the columns " + ", ".join(names[:12])))
        if columns is None:
            return names
        return ["time"] + [name for name in matching(names, columns, file + ": ") if name != "time"]

    return read_table(file, choose, losses)
