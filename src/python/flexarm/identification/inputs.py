"""Reads YAML and CSV files. Error messages name file, line and key."""

import math

import numpy
import yaml

from ..errors import ResultsError
from ..result_files import read_csv


class InputError(ValueError):
    """The input cannot be used. The text names file, line or key, what was read and what was expected."""


class Entry:
    """A value in a YAML file, with its place in the file.

    name: the keys that lead to the value, such as "parameters: young: min"; empty: the whole file.
    """

    def __init__(self, file, node, name=""):
        self.file, self.name, self._node = file, name, node

    @property
    def line(self):
        return self._node.start_mark.line + 1

    @property
    def text(self):
        """A scalar as written in the file; for other nodes, their kind."""
        return self._node.value if isinstance(self._node, yaml.ScalarNode) else "a %s" % self._node.id

    @property
    def is_empty(self):
        return isinstance(self._node, yaml.ScalarNode) and self._node.tag == "tag:yaml.org,2002:null"

    @property
    def is_mapping(self):
        return isinstance(self._node, yaml.MappingNode)

    def error(self, what):
        """An InputError about this value; `what` says what is wrong."""
        return InputError("%s:%d: %s%s" % (self.file, self.line, self.name and self.name + ": ", what))

    def expected(self, what):
        """An InputError that says that `what` was expected."""
        return self.error("expected %s, got '%s'" % (what, self.text))

    def _below(self, node, key):
        return Entry(self.file, node, "%s: %s" % (self.name, key) if self.name else str(key))

    def mapping(self, *known):
        """A dictionary of entries by key. Repeated keys are errors. If `known` is given, other keys are errors, too."""
        if self.is_empty:
            return {}
        if not self.is_mapping:
            raise self.expected("a mapping" + (" with some of the keys " + ", ".join(known) if known else ""))
        entries = {}
        for key_node, value_node in self._node.value:
            key = Entry(self.file, key_node, self.name)
            if known and key.text not in known:
                raise key.expected("a key of " + ", ".join(known))
            if key.text in entries:
                raise key.error("the key '%s' comes twice" % key.text)
            entries[key.text] = self._below(value_node, key.text)
        return entries

    def items(self):
        """The entries of a list."""
        if not isinstance(self._node, yaml.SequenceNode):
            raise self.expected("a list")
        return [self._below(node, i + 1) for i, node in enumerate(self._node.value)]

    def number(self, expected="a finite number", holds=lambda value: True):
        # YAML reads numbers such as 70e9 as text.
        try:
            value = float(self.text)
        except ValueError:
            raise self.expected(expected) from None
        if not math.isfinite(value) or not holds(value):
            raise self.expected(expected)
        return value

    def positive(self):
        return self.number("a number > 0", lambda value: value > 0)

    def string(self):
        if self.is_empty or not isinstance(self._node, yaml.ScalarNode):
            raise self.expected("a text")
        return self._node.value

    def choice(self, *choices):
        if self.text not in choices:
            raise self.expected(" or ".join("'%s'" % choice for choice in choices))
        return self.text


def read_yaml(path):
    """Reads a file. Returns its whole content as an Entry."""
    try:
        with open(path, encoding="utf-8") as file:
            node = yaml.compose(file, yaml.SafeLoader)
    except (OSError, UnicodeDecodeError) as error:
        raise InputError("%s: cannot be read: %s" % (path, getattr(error, "strerror", None) or error)) from None
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise InputError("%s:%d: %s" % (path, line, error.problem)) from None
    except yaml.YAMLError as error:
        raise InputError("%s: %s" % (path, error)) from None
    if node is None:
        raise InputError("%s:1: expected a mapping, got an empty file" % path)
    return Entry(path, node)


def read_table(path, columns=None):
    """Reads a CSV file whose first line has the names of the columns. The column `time` [s] must increase.

    columns: which ones are read besides `time`; None: all.
    Returns the times, shape (rows,), and a dictionary of the other columns. Empty fields and `nan` become NaN.
    """
    try:
        table = read_csv(path, lambda names: _wanted(path, names, columns))
    except ResultsError as error:
        raise InputError(str(error)) from None
    if not len(table.rows):
        raise InputError("%s: expected rows of numbers below the names of columns, got none" % path)
    for row, column in numpy.argwhere(numpy.isinf(table.rows))[:1]:
        raise InputError("%s:%d: %s: expected a finite number, got '%g'"
                         % (path, table.lines[row], table.names[column], table.rows[row, column]))
    _check_times(path, table.rows[:, 0], table.lines)
    return table.rows[:, 0], dict(zip(table.names[1:], table.rows.T[1:]))


def _wanted(path, names, columns):
    wanted = ["time"] + [name for name in (names if columns is None else columns) if name != "time"]
    for name in wanted:
        if names.count(name) != 1:
            raise InputError("%s:1: expected one column '%s', got the columns %s" % (path, name, ", ".join(names)))
    return wanted


def _check_times(path, times, lines):
    for i, (time, line) in enumerate(zip(times, lines)):
        if not math.isfinite(time):
            raise InputError("%s:%d: time: expected a finite number, got none" % (path, line))
        if i > 0 and time <= times[i - 1]:
            raise InputError("%s:%d: time: expected more than %g, the time of the row before, got %g"
                             % (path, line, times[i - 1], time))
