"""Efforts that were commanded in an experiment."""

import numpy

from . import bags
from .inputs import InputError, read_table, read_yaml


class EffortHistory:
    """An effort over time [N m or N]: linear between knots, constant after the last one; it may jump at knots.

    times: of the knots, shape (knots,), not decreasing [s].
    after: effort just after each knot, shape (knots,).
    until: effort just before the next knot, shape (knots - 1,); None: the same as just after the knot.
    before: effort before the first knot.
    """

    def __init__(self, times, after, until=None, before=0.0):
        self._times, self._after, self._before = numpy.asarray(times), numpy.asarray(after), before
        until = self._after[:-1] if until is None else numpy.asarray(until)
        lengths = numpy.diff(self._times)
        self._slopes = numpy.append(numpy.divide(until - self._after[:-1], lengths, out=numpy.zeros(len(lengths)),
                                                 where=lengths > 0), 0.0)
        self._impulses = numpy.append(0.0, numpy.cumsum(lengths * (self._after[:-1] + until) / 2))

    def _impulse(self, times):
        """Integrals of the effort from the first knot to the times."""
        knots = numpy.searchsorted(self._times, times, side="right") - 1
        past = times - self._times[numpy.maximum(knots, 0)]
        inside = numpy.maximum(knots, 0)
        after = self._impulses[inside] + past * (self._after[inside] + past * self._slopes[inside] / 2)
        return numpy.where(knots < 0, self._before * past, after)

    def means(self, edges):
        """Mean efforts between edges of time, shape (edges - 1,). They give steps the impulses of the history."""
        return numpy.diff(self._impulse(edges)) / numpy.diff(edges)


def pulses(entries):
    """A history that is the sum of pulses (begin [s], end [s], effort)."""
    times = numpy.array([[begin, end] for begin, end, _ in entries]).ravel()
    jumps = numpy.array([[effort, -effort] for _, _, effort in entries]).ravel()
    order = numpy.argsort(times, kind="stable")
    return EffortHistory(times[order], numpy.cumsum(jumps[order]))


def rows(times, efforts, hold):
    """A history from rows of a table. The first effort also holds before. `hold`: each holds until the next row."""
    return EffortHistory(times, efforts, None if hold else efforts[1:], efforts[0])


def read_efforts(commands, data, begin):
    """Reads a dictionary of histories by names of joints.

    commands: those of a plan. data: path of the measurements. begin: time of the data at which the scene starts [s].
    Raises InputError.
    """
    path = commands.file or data
    if bags.is_bag(path):
        return _of_bag(path, commands, begin)
    if commands.topic:
        raise commands.entry.error("expected a bag, which has topics, got '%s'" % path)
    return _of_table(path, commands, begin) if path.endswith(".csv") else _of_schedule(path)


def _of_table(path, commands, begin):
    joints = commands.joints
    times, columns = read_table(path, joints and joints.values())
    for name, column in columns.items():
        if not numpy.isfinite(column).all():
            raise InputError("%s: %s: expected an effort in each row, got none at the time %g"
                             % (path, name, times[~numpy.isfinite(column)][0]))
    joints = joints or {name: name for name in columns}
    return {joint: rows(times - begin, columns[name], commands.hold) for joint, name in joints.items()}


def _of_schedule(path):
    """Reads a file like config/demo_commands.yaml, in simulated time."""
    found = {}
    commands = read_yaml(path).mapping("period", "commands").get("commands")
    for entry in commands.items() if commands else []:
        command = entry.mapping("time", "names", "efforts", "duration", "repeat", "every")
        for key in ("time", "names", "efforts", "duration"):
            if key not in command:
                raise entry.error("expected a key '%s'" % key)
        names = [name.string() for name in command["names"].items()]
        efforts = [effort.number() for effort in command["efforts"].items()]
        if len(names) != len(efforts):
            raise entry.error("expected one effort for each name, got %d for %d" % (len(efforts), len(names)))
        time, duration = command["time"].number(), command["duration"].positive()
        repeat = command["repeat"].number("a whole number >= 1", _is_count) if "repeat" in command else 1
        every = command["every"].positive() if "every" in command else 0.0
        for name, effort in zip(names, efforts):
            found.setdefault(name, []).extend(
                (time + k * every, time + k * every + duration, effort) for k in range(int(repeat)))
    if not found:
        raise InputError("%s: expected at least one command" % path)
    return {joint: pulses(entries) for joint, entries in found.items()}


def _is_count(value):
    return value >= 1 and value == int(value)


def _of_bag(path, commands, begin):
    topic = commands.topic or "/joint_force_command"
    found = bags.read_efforts(path, topic, commands.entry)
    histories = {}
    for joint, (times, efforts, lifetimes) in found.items():
        times = numpy.array(times) - begin
        if lifetimes is None:
            histories[joint] = rows(times, numpy.array(efforts), commands.hold)
        else:
            ends = numpy.minimum(times + lifetimes, numpy.append(times[1:], numpy.inf))
            is_last = ~numpy.isfinite(ends)
            ends[is_last] = times[is_last] + 1e9  # for ever
            histories[joint] = pulses(list(zip(times, ends, efforts)))
    return histories
