"""Files that people write: what is wrong with them is said by file, line and key."""

import csv
import math

import numpy
import yaml


class InputError(ValueError):
    """What was given cannot be used; the text names file, line or key, what was read and what was expected."""


class Entry:
    """A value in a YAML file, with the place where it stands.

    name: keys that lead to it, "parameters: young: min"; empty: the whole file.
    """

    def __init__(self, file, node, name=""):
        self.file, self.name, self._node = file, name, node

    @property
    def line(self):
        return self._node.start_mark.line + 1

    @property
    def text(self):
        """As it stands in the file, where it is a scalar."""
        return self._node.value if isinstance(self._node, yaml.ScalarNode) else "a %s" % self._node.id

    @property
    def is_empty(self):
        return isinstance(self._node, yaml.ScalarNode) and self._node.tag == "tag:yaml.org,2002:null"

    @property
    def is_mapping(self):
        return isinstance(self._node, yaml.MappingNode)

    def error(self, what):
        """An InputError about it: `what` is wrong."""
        return InputError("%s:%d: %s%s" % (self.file, self.line, self.name and self.name + ": ", what))

    def expected(self, what):
        """An InputError: `what` was expected."""
        return self.error("expected %s, got '%s'" % (what, self.text))

    def _below(self, node, key):
        return Entry(self.file, node, "%s: %s" % (self.name, key) if self.name else str(key))

    def mapping(self, *known):
        """Entries by their keys, none of which may come twice; `known`: no others may come."""
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
        """Entries of a list."""
        if not isinstance(self._node, yaml.SequenceNode):
            raise self.expected("a list")
        return [self._below(node, i + 1) for i, node in enumerate(self._node.value)]

    def number(self, expected="a finite number", holds=lambda value: True):
        # YAML takes 70e9 for text.
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
    """The whole file as an Entry."""
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
    """Columns of a CSV file with a line of names, among them `time` [s], which increases from row to row.

    columns: which ones are wanted beside the time; None: all.
    Returns the times, shape (rows,), and a dictionary of the other columns, NaN where a field is empty or `nan`.
    """
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file)
            names = [name.strip() for name in next(reader, [])]
            rows = [(reader.line_num, row) for row in reader if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError("%s: cannot be read: %s" % (path, getattr(error, "strerror", None) or error)) from None
    wanted = ["time"] + [name for name in (names if columns is None else columns) if name != "time"]
    for name in wanted:
        if names.count(name) != 1:
            raise InputError("%s:1: expected one column '%s', got the columns %s" % (path, name, ", ".join(names)))
    table = numpy.array([_numbers(path, line, row, names, wanted) for line, row in rows]).reshape(-1, len(wanted))
    if not len(table):
        raise InputError("%s: expected rows of numbers below the names of columns, got none" % path)
    _check_times(path, table[:, 0], [line for line, _ in rows])
    return table[:, 0], dict(zip(wanted[1:], table.T[1:]))


def _numbers(path, line, row, names, wanted):
    if len(row) != len(names):
        raise InputError("%s:%d: expected %d fields, got %d" % (path, line, len(names), len(row)))
    numbers = []
    for name in wanted:
        text = row[names.index(name)].strip()
        try:
            value = float(text or "nan")
        except ValueError:
            raise InputError("%s:%d: %s: expected a number, got '%s'" % (path, line, name, text)) from None
        if math.isinf(value):
            raise InputError("%s:%d: %s: expected a finite number, got '%s'" % (path, line, name, text))
        numbers.append(value)
    return numbers


def _check_times(path, times, lines):
    for i, (time, line) in enumerate(zip(times, lines)):
        if not math.isfinite(time):
            raise InputError("%s:%d: time: expected a finite number, got none" % (path, line))
        if i > 0 and time <= times[i - 1]:
            raise InputError("%s:%d: time: expected more than %g, the time of the row before, got %g"
                             % (path, line, times[i - 1], time))
