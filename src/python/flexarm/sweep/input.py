"""Entries of a YAML file that know their file and line, for error messages."""

import math

import yaml


class InputError(Exception):
    """The user's input cannot be used. The text says what is wrong, where, and what was expected."""


class Entry:
    """A node of a file. Its methods return the node's value as a certain type, or raise InputError."""

    def __init__(self, node, file, key=""):
        self.node, self.file, self.key = node, file, key

    def error(self, text):
        place = "%s:%d" % (self.file, self.node.start_mark.line + 1)
        return InputError("%s: %s%s" % (place, self.key + ": " if self.key else "", text))

    def unexpected(self, expected):
        return self.error("expected %s, got %s" % (expected, self._shown()))

    def _shown(self):
        if isinstance(self.node, yaml.ScalarNode):
            return "'%s'" % self.node.value
        return "a list" if self.is_list() else "a mapping"

    def is_list(self):
        return isinstance(self.node, yaml.SequenceNode)

    def is_mapping(self):
        return isinstance(self.node, yaml.MappingNode)

    def items(self, expected="a mapping"):
        """Pairs (name, Entry) in the order of the file; an error if a name is repeated."""
        if not self.is_mapping():
            raise self.unexpected(expected)
        entries = {}
        for key, value in self.node.value:
            name = Entry(key, self.file, self.key).text("a name")
            if name in entries:
                raise Entry(key, self.file, self.key).error("'%s' is given twice" % name)
            entries[name] = Entry(value, self.file, self.key + "/" + name if self.key else name)
        return list(entries.items())

    def fields(self, required, optional=()):
        """A dictionary of entries by name. All `required` names must exist; only `optional` ones may exist besides."""
        known = list(required) + list(optional)
        entries = dict(self.items("a mapping of " + ", ".join(known)))
        for name, entry in entries.items():
            if name not in known:
                raise entry.error("expected one of [%s]" % ", ".join(known))
        for name in required:
            if name not in entries:
                raise self.error("expected '%s' in it" % name)
        return entries

    def entries(self, expected="a list"):
        if not self.is_list():
            raise self.unexpected(expected)
        return [Entry(node, self.file, "%s[%d]" % (self.key, i + 1)) for i, node in enumerate(self.node.value)]

    def text(self, expected="a text"):
        if not isinstance(self.node, yaml.ScalarNode) or not self.node.value:
            raise self.unexpected(expected)
        return self.node.value

    def number(self, expected="a finite number", accepts=lambda value: True):
        try:
            value = float(self.text(expected))
        except ValueError:
            raise self.unexpected(expected) from None
        if not math.isfinite(value) or not accepts(value):
            raise self.unexpected(expected)
        return value

    def positive(self):
        return self.number("a number > 0", lambda value: value > 0)

    def non_negative(self):
        return self.number("a number >= 0", lambda value: value >= 0)

    def count(self, least=1):
        expected = "a whole number >= %d" % least
        try:
            value = int(self.text(expected))
        except ValueError:
            raise self.unexpected(expected) from None
        if value < least:
            raise self.unexpected(expected)
        return value

    def choice(self, choices):
        expected = "one of [%s]" % ", ".join(choices)
        if self.text(expected) not in choices:
            raise self.unexpected(expected)
        return self.node.value


def read_text(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except OSError as error:
        raise InputError("cannot read '%s': %s" % (path, error.strerror)) from None
    except UnicodeDecodeError as error:
        raise InputError("%s: expected UTF-8: %s" % (path, error)) from None


def read_yaml(path):
    """Reads a file. Returns its content as an Entry."""
    try:
        node = yaml.compose(read_text(path), Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise InputError("%s:%d: %s" % (path, mark.line + 1, error.problem or error.context)) from None
    except (yaml.YAMLError, RecursionError) as error:
        raise InputError("%s: %s" % (path, error)) from None
    if node is None:
        raise InputError("%s: expected a mapping, got nothing" % path)
    return Entry(node, path)
