"""Reads measured columns, and converts their times to simulated time."""

import typing

import numpy

from . import bags
from .inputs import InputError, read_table
from .plan import Column


class Measurement(typing.NamedTuple):
    """A measured column."""

    column: Column
    times: numpy.ndarray  # simulated, not decreasing, shape (values,) [s]
    values: numpy.ndarray


def read_measurements(path, plan):
    """Reads the plan's columns from a CSV file or a bag, within the simulated time.

    Returns measurements in the plan's order, and the time of the data at which the scene starts [s].
    Raises InputError.
    """
    if bags.is_bag(path):
        series = bags.read_columns(path, plan.columns, plan.joint_states)
    else:
        times, table = read_table(path, [column.data for column in plan.columns])
        series = {column.name: (times, table[column.data]) for column in plan.columns}
    begin = min(times[0] for times, _ in series.values()) if plan.begin is None else plan.begin
    until = numpy.inf if plan.until is None else plan.until
    return [_cut(column, path, *series[column.name], begin, until) for column in plan.columns], begin


def _cut(column, path, times, values, begin, until):
    """The finite values within the simulated time, whose ends allow for round-off."""
    simulated = times - begin
    slack = 1e-9 * (1 + abs(begin))
    used = numpy.isfinite(values) & (simulated >= -slack) & (simulated <= until + slack)
    if not used.any():
        raise InputError("%s: '%s' has no value between %g s, where the scene starts ('begin' of the plan), and %g s"
                         % (path, column.data, begin, begin + until))
    return Measurement(column, numpy.maximum(simulated[used], 0.0), values[used])
