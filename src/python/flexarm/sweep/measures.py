"""Measures of a run: numbers that are computed from an expression over time."""

import dataclasses
import math
import typing

import numpy

from .expressions import Expression, ExpressionError


def integral_mean(time, values):
    """The integral by the trapezoidal rule, divided by the duration. Rows need not be evenly spaced."""
    # (numpy's own rule has another name since version 2.)
    return ((values[1:] + values[:-1]) / 2) @ numpy.diff(time) / (time[-1] - time[0]) if len(time) > 1 else values[0]


def settling_time(time, values, band, target):
    """The time from which on all values are within the band [s]; NaN if the last value is outside."""
    outside = numpy.flatnonzero(~(abs(values - target) <= band))
    if len(outside) == 0:
        return time[0]
    return time[outside[-1] + 1] if outside[-1] + 1 < len(time) else math.nan


@dataclasses.dataclass(frozen=True)
class Measure:
    name: str
    kind: str  # of KINDS
    expression: Expression
    options: typing.Mapping[str, float]

    def evaluate(self, columns, parameters):
        """The measure; NaN: undefined. columns: arrays by name, including "time". parameters: numbers by name."""
        values = self.expression.evaluate(columns, parameters)
        time = columns["time"]
        # Times of rows are sums of steps with round-off: rows at the ends of the window shall count.
        margin = 1e-9 * time[-1]
        chosen = (time >= self.options.get("from", 0) - margin) & (time <= self.options.get("to", math.inf) + margin)
        if not chosen.any():
            return math.nan
        return float(KINDS[self.kind].reduce(time[chosen], values[chosen], self.options))


class Kind(typing.NamedTuple):
    reduce: typing.Callable  # function of times, values and options
    required: tuple = ()  # names of options
    optional: tuple = ()


WINDOW = ("from", "to")
KINDS = {
    "maximum": Kind(lambda time, values, options: values.max(), (), WINDOW),
    "minimum": Kind(lambda time, values, options: values.min(), (), WINDOW),
    "mean": Kind(lambda time, values, options: integral_mean(time, values), (), WINDOW),
    "rms": Kind(lambda time, values, options: math.sqrt(integral_mean(time, values**2)), (), WINDOW),
    "final": Kind(lambda time, values, options: values[-1]),
    "value": Kind(lambda time, values, options: numpy.interp(options["at"], time, values), ("at",)),
    "settling_time": Kind(
        lambda time, values, options: settling_time(time, values, options["band"], options.get("target", values[-1])),
        ("band",), ("target", "from")),
}


def read_measure(name, entry, until, columns, parameters):
    """Reads `name: {kind: expression, option: number, ...}`."""
    kinds = [key for key, _ in entry.items("a mapping with one of [%s]" % ", ".join(KINDS)) if key in KINDS]
    if len(kinds) != 1:
        raise entry.error("expected one of [%s] in it, got %s"
                          % (", ".join(KINDS), "%d of them" % len(kinds) if kinds else "none"))
    kind = kinds[0]
    fields = entry.fields([kind, *KINDS[kind].required], KINDS[kind].optional)
    try:
        expression = Expression(fields[kind].text("an expression"), columns, parameters)
    except ExpressionError as error:
        raise fields[kind].error(str(error)) from None
    options = {}
    for option, given in fields.items():
        if option in ("from", "to", "at"):
            options[option] = given.number("a time between 0 and %g" % until, lambda time: 0 <= time <= until)
        elif option == "band":
            options[option] = given.positive()
        elif option == "target":
            options[option] = given.number()
    if options.get("from", 0) > options.get("to", until):
        raise entry.error("expected 'from' before 'to'")
    return Measure(name, kind, expression, options)
