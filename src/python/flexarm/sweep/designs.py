"""Designs of experiments: the values of the scene's parameters in each run."""

import csv
import dataclasses
import io
import itertools
import math
import os
import typing

import numpy

from .input import InputError, read_text

MOST_RUNS = 1000000


@dataclasses.dataclass(frozen=True)
class Values:
    """A list of values, from which a sample takes one."""

    values: tuple

    def points(self):
        return self.values

    def at(self, part):
        return self.values[min(int(part * len(self.values)), len(self.values) - 1)]


@dataclasses.dataclass(frozen=True)
class Range:
    """Numbers between two ends, evenly spaced on a linear or logarithmic scale."""

    first: float
    last: float
    count: typing.Optional[int]  # for a grid only
    is_logarithmic: bool

    def points(self):
        spaced = numpy.geomspace if self.is_logarithmic else numpy.linspace
        return tuple(float(value) for value in spaced(self.first, self.last, self.count))

    def at(self, part):
        if self.is_logarithmic:
            value = self.first * (self.last / self.first) ** part
        else:
            value = self.first + (self.last - self.first) * part
        return min(max(value, min(self.first, self.last)), max(self.first, self.last))  # round-off


@dataclasses.dataclass(frozen=True)
class Design:
    names: tuple  # of the parameters
    rows: tuple  # a tuple of values for each run


def check_limits(parameter, value, error):
    """Raises error(text), as of Entry.error(), if the value is outside the parameter's limits."""
    if parameter.min is not None and value < parameter.min or parameter.max is not None and value > parameter.max:
        limits = [text % limit for text, limit in (("at least %g", parameter.min), ("at most %g", parameter.max))
                  if limit is not None]
        raise error("expected a value of %s, got %g" % (" and ".join(limits), value))


def parameter_of(name, parameters, error):
    if name not in parameters:
        raise error("expected a parameter of the scene, one of [%s], got '%s'" % (", ".join(parameters), name))
    return parameters[name]


def read_axis(entry, parameter, of_grid):
    """Reads `parameter: 3`, `parameter: [1, 2, 5]` or `parameter: {from: 1, to: 2, count: 5, scale: log}`."""
    if entry.is_list():
        entries = entry.entries()
        if not entries:
            raise entry.error("expected at least one value")
    elif not entry.is_mapping():
        entries = [entry]
    else:
        return read_range(entry, parameter, of_grid)
    for value in entries:
        check_limits(parameter, value.number(), value.error)
    return Values(tuple(value.number() for value in entries))


def read_range(entry, parameter, of_grid):
    fields = entry.fields(["from", "to"] + ["count"] * of_grid, ["scale"])
    ends = [fields[name].number() for name in ("from", "to")]
    is_logarithmic = "scale" in fields and fields["scale"].choice(["linear", "log"]) == "log"
    for name, value in zip(("from", "to"), ends):
        check_limits(parameter, value, fields[name].error)
        if is_logarithmic and value <= 0:
            raise fields[name].unexpected("a number > 0 on a logarithmic scale")
    return Range(*ends, fields["count"].count() if of_grid else None, is_logarithmic)


def latin_hypercube(dimension, runs, seed):
    return _quasi_monte_carlo().LatinHypercube(dimension, seed=seed).random(runs)


def sobol(dimension, runs, seed):
    sampler = _quasi_monte_carlo().Sobol(dimension, seed=seed)
    # The first points of a full power of two, which are less even than all. docs/sweep.md says so; scipy would warn.
    return sampler.random_base2(math.ceil(math.log2(runs)))[:runs]


def random(dimension, runs, seed):
    return numpy.random.default_rng(seed).random((runs, dimension))


SAMPLES = {"latin_hypercube": latin_hypercube, "sobol": sobol, "random": random}


def _quasi_monte_carlo():
    try:
        from scipy.stats import qmc
    except ImportError:
        raise InputError("this design needs scipy 1.7 or later (Debian's python3-scipy)") from None
    return qmc


def read_axes(entry, parameters, of_grid):
    axes = {}
    for name, axis in entry.items("a mapping of parameters"):
        axes[name] = read_axis(axis, parameter_of(name, parameters, axis.error), of_grid)
    if not axes:
        raise entry.error("expected at least one parameter")
    return axes


def read_grid(entry, parameters):
    """Reads a grid: all combinations of the parameters' values; the last parameter varies fastest."""
    fields = entry.fields(["kind", "parameters"])
    axes = read_axes(fields["parameters"], parameters, of_grid=True)
    count = math.prod(axis.count if isinstance(axis, Range) else len(axis.values) for axis in axes.values())
    if count > MOST_RUNS:
        raise fields["parameters"].error("expected at most %d runs, got %d" % (MOST_RUNS, count))
    return Design(tuple(axes), tuple(itertools.product(*(axis.points() for axis in axes.values()))))


def read_samples(entry, parameters, sample):
    fields = entry.fields(["kind", "runs", "parameters"], ["seed"])
    axes = read_axes(fields["parameters"], parameters, of_grid=False)
    runs = fields["runs"].count()
    if runs > MOST_RUNS:
        raise fields["runs"].error("expected at most %d runs, got %d" % (MOST_RUNS, runs))
    seed = fields["seed"].count(0) if "seed" in fields else 0
    parts = sample(len(axes), runs, seed)
    rows = tuple(tuple(float(axis.at(part)) for axis, part in zip(axes.values(), row)) for row in parts)
    return Design(tuple(axes), rows)


def read_rows(entry, parameters):
    fields = entry.fields(["kind"], ["rows", "file"])
    if len(fields) != 2:
        raise entry.error("expected either 'rows' or 'file' in it")
    if "file" in fields:
        path = os.path.join(os.path.dirname(entry.file), fields["file"].text())
        return read_table(path, parameters)
    names, rows = None, []
    for row in fields["rows"].entries("a list of mappings of parameters"):
        values = dict(row.items("a mapping of parameters"))
        names = names or list(values)
        if set(names) != set(values):
            raise row.error("expected the parameters of the first row, [%s], got [%s]"
                            % (", ".join(names), ", ".join(values)))
        for name, value in values.items():
            check_limits(parameter_of(name, parameters, value.error), value.number(), value.error)
        rows.append(tuple(values[name].number() for name in names))
    if not names:
        raise fields["rows"].error("expected at least one row with a parameter")
    return Design(tuple(names), tuple(rows))


def read_table(path, parameters):
    """Reads a CSV file whose first line has the names of parameters. Other columns are an error."""
    lines = csv.reader(io.StringIO(read_text(path)))
    try:
        all_fields = [(lines.line_num, fields) for fields in lines]
    except csv.Error as problem:
        raise InputError("%s:%d: %s" % (path, lines.line_num, problem)) from None
    names, rows = None, []
    for line, fields in all_fields:
        def error(text):
            return InputError("%s:%d: %s" % (path, line, text))

        if not fields:
            continue
        if names is None:
            names = [name.strip() for name in fields]
            for name in names:
                parameter_of(name, parameters, error)
            if len(set(names)) != len(names):
                raise error("expected each parameter once, got '%s'" % ",".join(names))
            continue
        if len(fields) != len(names):
            raise error("expected %d numbers, got %d" % (len(names), len(fields)))
        rows.append(tuple(read_number(name, text, parameters, error) for name, text in zip(names, fields)))
    if not rows:
        raise InputError("%s: expected a line of names and at least one of numbers" % path)
    return Design(tuple(names), tuple(rows))


def read_number(name, text, parameters, error):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise error("%s: expected a finite number, got '%s'" % (name, text))
    check_limits(parameters[name], value, lambda said: error(name + ": " + said))
    return value


def read_design(entry, parameters):
    """Reads a design. `parameters`: those of the scene, by name. Raises InputError."""
    kinds = ["grid", "rows", *SAMPLES]
    kind = dict(entry.items("a mapping with 'kind'")).get("kind")
    if kind is None:
        raise entry.error("expected 'kind' in it, one of [%s]" % ", ".join(kinds))
    name = kind.choice(kinds)
    if name == "grid":
        return read_grid(entry, parameters)
    return read_rows(entry, parameters) if name == "rows" else read_samples(entry, parameters, SAMPLES[name])
