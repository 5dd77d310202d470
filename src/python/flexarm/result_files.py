"""Reads files of results: CSV, HDF5, ROS bags."""

import csv
import difflib
import fnmatch
import importlib
import io
import os
import shlex
import sys
import typing

import numpy

from . import cut_hdf5
from .errors import ResultsError

Names = typing.Sequence[str]
Choice = typing.Callable[[Names], Names]  # which of a file's columns are read
Losses = typing.Optional[typing.List[str]]  # see read_table(); None: such a file is an error

# Units of columns by the first pattern that fits, for files that do not name them. docs/results.md lists all columns.
UNITS = {
    "time": "s",
    "joint/*/position": "rad or m", "joint/*/velocity": "rad/s or m/s", "joint/*/effort": "N m or N",
    "energy/*": "J", "momentum/*": "kg m/s", "angular_momentum/*": "kg m^2/s",
    "solver/step": "s", "solver/error_estimate": "m", "solver/*": "1",
    "drag/*/f*": "N", "spring/*/length": "m", "spring/*/tension": "N",
    "tendon/*/length": "m", "tendon/*/*tension": "N", "cylinder/*/pressure_[12]": "Pa",
    "sensor/*/length": "m", "sensor/*/tension": "N",
    "contact/*/points": "1", "contact/*/gap": "m", "contact/*/f[xyz]": "N",
    "sensor/*/strain": "1", "sensor/*/f[xyz]": "N", "sensor/*/m[xyz]": "N m", "sensor/*/w[xyz]": "rad/s",
    "beam/*/e[xyz]": "1", "beam/*/k[xyz]": "1/m", "beam/*/f[xyz]": "N", "beam/*/m[xyz]": "N m",
    **{group + pattern: unit for group in ("beam", "frame", "probe", "sensor")
       for pattern, unit in (("/*/[xyz]", "m"), ("/*/q[xyzw]", "1"), ("/*/v[xyz]", "m/s"), ("/*/a[xyz]", "m/s^2"))},
}
MOST_NAMES = 12  # that an error lists


class Origin(typing.NamedTuple):
    """The scene of results, as `flexarm simulate` has read it."""

    scene: str  # absolute path
    options: typing.List[str]  # words, such as --set=mass=4


class Table(typing.NamedTuple):
    names: typing.List[str]
    units: typing.List[str]  # empty: unknown
    rows: numpy.ndarray  # shape (rows, columns)
    origin: typing.Optional[Origin] = None  # None: the file does not name it


class CsvTable(typing.NamedTuple):
    names: typing.List[str]  # of the columns that were read
    rows: numpy.ndarray  # shape (rows, columns); empty fields are NaN
    lines: typing.Sequence[int]  # of the file, for each row


def unit_of(name: str) -> str:
    return next((unit for pattern, unit in UNITS.items() if fnmatch.fnmatchcase(name, pattern)), "")


def matching(names: Names, patterns: typing.Iterable[str], place: str = "") -> typing.List[str]:
    """The names that fit patterns, in the order of the patterns, each name once. Raises ResultsError if none fits one.

    The time fits only its own name. place: with which the error's text begins.
    """
    found: typing.Dict[str, None] = {}
    for pattern in patterns:
        fitting = [pattern] if pattern in names else [
            name for name in names if name != "time" and fnmatch.fnmatchcase(name, pattern)]
        if not fitting:
            raise ResultsError("%sno column is like '%s'; there are %s" % (place, pattern, nearest(pattern, names)))
        found.update(dict.fromkeys(fitting))
    return list(found)


def nearest(pattern: str, names: Names) -> str:
    """The names as a text, the most similar ones first."""
    likeness = difflib.SequenceMatcher(None, "", pattern, autojunk=False)

    def difference(name: str) -> float:
        likeness.set_seq1(name)
        return -likeness.ratio()

    listed = sorted(names, key=difference)[:MOST_NAMES]
    return ", ".join(listed) + (" and %d others" % (len(names) - len(listed)) if len(names) > len(listed) else "")


def read_table(path: str, choose: Choice, losses: Losses = None) -> Table:
    """Reads columns of a file, of the format that its name ends in, as `flexarm simulate --output` writes it.

    losses: if the file has lost its end, sentences about that are appended, and what is left is read.
    """
    extension = os.path.splitext(path)[1]
    if extension in (".h5", ".hdf5"):
        return read_hdf5(path, choose, losses)
    if extension == ".bag":
        return read_bag(path, choose, losses)
    table = read_csv(path, choose, losses)
    return Table(table.names, list(map(unit_of, table.names)), table.rows)


def read_csv(path: str, choose: Choice = lambda names: names, losses: Losses = None) -> CsvTable:
    """Reads columns of a CSV file whose first line has their names. "-" is the standard input.

    Only the chosen columns must be numbers. Raises ResultsError.
    """
    try:
        if path == "-":
            text = sys.stdin.buffer.read().decode("utf-8-sig")
        else:
            with open(path, encoding="utf-8-sig") as file:
                text = file.read()
        end = text.rfind("\n") + 1
        if losses is not None and 0 < end < len(text):
            losses.append("%s: the last line has no end and is left out" % path)
            text = text[:end]
        names = [name.strip() for name in next(csv.reader(io.StringIO(text)), [])]
        wanted = list(choose(names))
        return _rows_of_numbers(text, names, wanted) or _rows_of_fields(path, text, names, wanted)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ResultsError("%s: cannot be read: %s" % (path, getattr(error, "strerror", None) or error)) from None


def _rows_of_numbers(text: str, names: Names, wanted: typing.List[str]) -> typing.Optional[CsvTable]:
    """The quick way for files of numbers; None: this is not such a file, or it has errors."""
    lines = text.count("\n", 0, len(text.rstrip())) + 1
    if lines < 2:
        return None
    try:
        rows = numpy.loadtxt(io.StringIO(text), delimiter=",", skiprows=1, ndmin=2, comments=None)
    except ValueError:
        return None
    if rows.shape != (lines - 1, len(names)):
        return None
    return CsvTable(wanted, rows[:, [names.index(name) for name in wanted]], range(2, lines + 1))


def _rows_of_fields(path: str, text: str, names: Names, wanted: typing.List[str]) -> CsvTable:
    reader = csv.reader(io.StringIO(text))
    next(reader, None)
    rows, lines = [], []
    for row in reader:
        if not row:
            continue
        if len(row) != len(names):
            raise ResultsError("%s:%d: expected %d fields, got %d" % (path, reader.line_num, len(names), len(row)))
        rows.append([_number(path, reader.line_num, name, row[names.index(name)].strip()) for name in wanted])
        lines.append(reader.line_num)
    return CsvTable(wanted, numpy.array(rows, dtype=float).reshape(-1, len(wanted)), lines)


def _number(path: str, line: int, name: str, text: str) -> float:
    try:
        return float(text or "nan")
    except ValueError:
        raise ResultsError("%s:%d: %s: expected a number, got '%s'" % (path, line, name, text)) from None


def read_hdf5(path: str, choose: Choice, losses: Losses = None) -> Table:
    try:
        import h5py  # type: ignore
    except ImportError:
        raise ResultsError("%s: HDF5 is read by Debian's package python3-h5py, which is missing" % path) from None
    found = {}

    def take(name: str, thing: typing.Any) -> None:
        if isinstance(thing, h5py.Dataset) and thing.ndim == 1 and thing.dtype.kind in "fiu":
            found[str(thing.attrs.get("name", name))] = thing

    try:
        with open(path, "rb"), h5py.File(path, "r") as file:
            file.visititems(take)
            wanted = list(choose(list(found)))
            columns = [found[name][:].astype(float) for name in wanted]
            units = [str(found[name].attrs.get("unit", "")) for name in wanted]
            origin = _origin(file.attrs.get("scene"), file.attrs.get("scene_options"))
    except OSError as error:
        size = cut_hdf5.whole_size(error)
        if losses is None or size is None:
            raise ResultsError("%s: cannot be read: %s" % (path, _reason(path, error, size))) from None
        return _read_cut_hdf5(path, size, choose, losses)
    if len(set(map(len, columns))) > 1:
        raise ResultsError("%s: expected columns of one length, got %s" % (path, ", ".join(
            "%d of '%s'" % (len(column), name) for name, column in zip(wanted[:MOST_NAMES], columns))))
    return Table(wanted, units, numpy.transpose(columns), origin)


def _reason(path: str, error: OSError, size: typing.Optional[int]) -> str:
    """Why HDF5 could not open a file. size: that it once had, if it is not whole."""
    if size is not None:
        return "it has lost its end: there are only %d of %d bytes" % (os.path.getsize(path), size)
    if error.strerror and error.errno:
        return error.strerror
    if not os.path.getsize(path):
        return "it is empty"
    if "signature not found" in str(error):
        return "it is not an HDF5 file, or its beginning is damaged"
    return "it is damaged (HDF5: %s)" % error


def _read_cut_hdf5(path: str, size: int, choose: Choice, losses: typing.List[str]) -> Table:
    here = os.path.getsize(path)
    arrays = cut_hdf5.read(path, size)
    names = list(map(str, arrays["names"])) if arrays else []
    if not arrays or "time" not in names:
        raise ResultsError("%s: has only %d of its %d bytes, in which there are no rows" % (path, here, size))
    losses.append("%s has only %d of its %d bytes: rows or columns are missing" % (path, here, size))
    wanted = list(choose(names))
    at = list(map(names.index, wanted))
    return Table(wanted, [str(arrays["units"][k]) for k in at], arrays["rows"][:, at], _origin(*arrays["origin"]))


def read_bag(path: str, choose: Choice, losses: Losses = None) -> Table:
    """Reads the topic /joint_states and, at the times of its messages, frames of /tf and samples of wrench sensors."""
    bags = importlib.import_module("flexarm.identification.bags")  # untyped
    if not os.path.exists(path):
        raise ResultsError("%s: cannot be read: No such file or directory" % path)
    quantities = "position", "velocity", "effort"
    names: typing.List[str] = []
    rows: typing.List[typing.List[float]] = []
    whole = path
    try:
        with bags.whole(path, losses) as whole:
            for time, message in bags.messages(whole, "/joint_states"):
                given = [quantity for quantity in quantities if len(getattr(message, quantity)) == len(message.name)]
                here = ["time"] + ["joint/%s/%s" % (joint, quantity) for quantity in given for joint in message.name]
                if rows and here != names:
                    raise ResultsError(
                        "%s: expected the same joints in each message on '/joint_states', got %s after %s"
                        % (path, ", ".join(here[1:]), ", ".join(names[1:])))
                names = here
                rows.append([time] + [value for quantity in given for value in getattr(message, quantity)])
            origin = _origin(*bags.origin(whole))
            more = bags.columns_at(whole, numpy.array(rows)[:, 0])
    except bags.InputError as error:
        raise ResultsError(str(error).replace(whole, path)) from None
    values = {**more, **dict(zip(names, numpy.transpose(rows)))}
    wanted = list(choose(list(dict.fromkeys(names + list(more)))))
    table = numpy.transpose([values[name] for name in wanted])
    return Table(wanted, list(map(unit_of, wanted)), table, origin)


def _origin(scene: typing.Any, options: typing.Any) -> typing.Optional[Origin]:
    return Origin(str(scene), shlex.split(str(options or ""))) if scene else None
