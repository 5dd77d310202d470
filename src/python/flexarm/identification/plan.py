"""Reads the plan, which says what should be found from which measurements (docs/identify.md)."""

import os
import typing

from .inputs import Entry, InputError, read_yaml


class Unknown(typing.NamedTuple):
    """A number that should be found: a parameter of the scene, or a coordinate at the start."""

    name: str  # of the parameter, or JOINT/position, JOINT/velocity
    of_start: bool  # whether it is a coordinate at the start
    start: float  # where the search begins
    min: float  # -inf: no limit
    max: float
    scale: float  # typical size of a change, > 0


class Column(typing.NamedTuple):
    """A measured column of `flexarm simulate`."""

    name: str
    data: str  # its name in the data
    noise: typing.Optional[float]  # standard deviation of the measurement errors; None: estimated from the residuals
    entry: Entry


class Commands(typing.NamedTuple):
    """Where the commanded efforts come from."""

    file: typing.Optional[str]  # None: the bag of the measurements
    topic: typing.Optional[str]  # of a bag
    joints: typing.Optional[typing.Dict[str, str]]  # CSV column of each joint; None: all, named as joints
    hold: bool  # whether an effort holds until the next row; else linear between rows
    entry: Entry


class Plan(typing.NamedTuple):
    unknowns: typing.List[Unknown]
    initial: typing.Dict[str, float]  # known coordinates at the start, by names as in Unknown.name
    columns: typing.List[Column]
    commands: typing.Optional[Commands]  # None: those of the scene
    begin: typing.Optional[float]  # time of the data at which the scene starts [s]; None: of the first row
    until: typing.Optional[float]  # end of the simulated time in use [s]; None: all
    step: typing.Optional[float]  # [s]; None: chosen automatically
    tolerance: float  # of Newton's method
    difference: float  # by which unknowns are varied, relative to their size
    forward: bool  # whether derivatives are sensitivities of runs, if these have them
    joint_states: str  # topic in a bag


KEYS = ("parameters", "initial", "columns", "commands", "begin", "until", "step", "tolerance", "difference",
        "derivatives", "joint_states")
SUFFIXES = ("position", "velocity")


def read_plan(path, parameters):
    """Reads a plan.

    parameters: of the scene, a list of flexarm.Parameter.
    Raises InputError.
    """
    entries = read_yaml(path).mapping(*KEYS)
    known = {parameter.name: parameter for parameter in parameters}
    unknowns = []
    if "parameters" in entries:
        unknowns += [_parameter(entry, name, known) for name, entry in entries["parameters"].mapping().items()]
    initial = {}
    if "initial" in entries:
        for name, entry in entries["initial"].mapping().items():
            _check_coordinate(entry, name)
            if entry.is_mapping:
                unknowns.append(_coordinate(entry, name))
            else:
                initial[name] = entry.number("a number if it is known, or a mapping with start if it is unknown")
    if not unknowns:
        raise InputError("%s: expected at least one unknown, below 'parameters' or 'initial'" % path)
    columns = []
    if "columns" in entries:
        columns = [_column(name, entry) for name, entry in entries["columns"].mapping().items()]
    if not columns:
        raise InputError("%s: expected measured columns, below 'columns'" % path)
    optional = _Optional(entries)
    return Plan(unknowns, initial, columns, _commands(path, entries.get("commands")),
                _begin(entries.get("begin")), optional.positive("until", None), optional.positive("step", None),
                optional.positive("tolerance", 1e-10), optional.positive("difference", 1e-4),
                "derivatives" in entries and entries["derivatives"].choice("differences", "forward") == "forward",
                entries["joint_states"].string() if "joint_states" in entries else "/joint_states")


class _Optional:
    """Reads numbers of a mapping that may be missing."""

    def __init__(self, entries):
        self._entries = entries

    def number(self, key, otherwise):
        return self._entries[key].number() if key in self._entries else otherwise

    def positive(self, key, otherwise):
        return self._entries[key].positive() if key in self._entries else otherwise


def _parameter(entry, name, known):
    if name not in known:
        raise entry.error("expected a parameter of the scene, of %s" % (", ".join(known) or "which there are none"))
    parameter = known[name]
    lower = -float("inf") if parameter.min is None else parameter.min
    upper = float("inf") if parameter.max is None else parameter.max
    return _unknown(entry, name, False, parameter.value, lower, upper)


def _check_coordinate(entry, name):
    joint, _, suffix = name.rpartition("/")
    if not joint or suffix not in SUFFIXES:
        raise entry.error("expected a name like JOINT/position or JOINT/velocity")


def _coordinate(entry, name):
    if "start" not in entry.mapping():
        raise entry.error("expected a key 'start': the value with which the search begins")
    return _unknown(entry, name, True, None, -float("inf"), float("inf"))


def _unknown(entry, name, of_start, value, lower, upper):
    """`value`: start of the search if the plan gives none; `lower`, `upper`: the widest limits that a plan may set."""
    given = entry.mapping("start", "min", "max", "scale")
    optional = _Optional(given)
    start = optional.number("start", value)
    least, most = optional.number("min", lower), optional.number("max", upper)
    for key, limit in (("min", least), ("max", most)):
        if not lower <= limit <= upper:
            raise given[key].expected("a number within the scene's limits, %g and %g" % (lower, upper))
    if not least < most:
        raise entry.error("expected min < max, got %g and %g" % (least, most))
    if not least <= start <= most:
        raise entry.error("expected a start between %g and %g, got %g" % (least, most, start))
    scale = optional.positive("scale", abs(start) or most - least)
    if not 0 < scale < float("inf"):
        raise entry.error("expected a key 'scale', since it starts at zero: the size of a significant change")
    return Unknown(name, of_start, start, least, most, scale)


def _column(name, entry):
    given = entry.mapping("data", "noise")
    return Column(name, given["data"].string() if "data" in given else name, _Optional(given).positive("noise", None),
                  entry)


def _commands(path, entry):
    if entry is None:
        return None
    if not entry.is_mapping:
        return Commands(_beside(path, entry.string()), None, None, False, entry)
    given = entry.mapping("file", "topic", "joints", "between")
    if not given.keys() & {"file", "topic"}:
        raise entry.error("expected a key 'file' or 'topic'")
    file = _beside(path, given["file"].string()) if "file" in given else None
    joints = None
    if "joints" in given:
        joints = {joint: column.string() for joint, column in given["joints"].mapping().items()}
    hold = "between" in given and given["between"].choice("hold", "line") == "hold"
    return Commands(file, given["topic"].string() if "topic" in given else None, joints, hold, entry)


def _beside(path, file):
    """The path of a file that a plan names, which is relative to the plan's folder."""
    return os.path.join(os.path.dirname(path), file)


def _begin(entry):
    if entry is None:
        return 0.0
    if entry.text == "first":
        return None
    return entry.number("'first', or the time of the data at which the scene starts [s]")
