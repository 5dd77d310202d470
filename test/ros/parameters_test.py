#!/usr/bin/python3
"""Tests that config/node_parameters.yaml has all parameters of the node with their defaults, and that simulate.launch
loads it.

Run by ctest, without a master: compares the parameters that the sources read with those in the file.
"""

import pathlib
import re
import subprocess
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILE = ROOT / "config/node_parameters.yaml"
SET_BY_NODE = {"view/frame", "view/center", "view/radius"}


def names_in_sources():
    """Return the parameters that the node reads: arguments of reader.read("name", read_choice, getParam and
    hasParam."""
    names = set()
    for source in (ROOT / "src/ros").glob("*.cpp"):
        text = source.read_text(encoding="utf-8")
        names |= set(re.findall(r'\breader\.read\("([^"]+)"', text))
        names |= set(re.findall(r'read_choice\(reader, "([^"]+)"', text))
        names |= set(re.findall(r'private_node_?\.(?:getParam|hasParam|param)\("([^"]+)"', text))
    return names - SET_BY_NODE


def defaults_in_headers():
    """Return the defaults of members that have the names of their parameters."""
    defaults = {}
    for header in ("src/ros/parameters.h", "src/messages/marker_messages.h"):
        text = (ROOT / header).read_text(encoding="utf-8")
        for kind, name, value in re.findall(r"\b(double|bool|int) (\w+) =\s*([\w.]+);", text):
            defaults[name] = {"true": True, "false": False}[value] if kind == "bool" else float(value)
        defaults.update(re.findall(r'\bstd::string (\w+) = "([^"]*)";', text))
    return defaults


def written():
    """Return all names of the file: those with defaults, and those in comments, `# name: example`."""
    text = FILE.read_text(encoding="utf-8")
    return set(yaml.safe_load(text)), set(re.findall(r"^# (\w+):", text, re.MULTILINE))


class Parameters(unittest.TestCase):
    def test_the_file_has_every_parameter(self):
        with_default, as_comment = written()
        self.assertEqual(with_default | as_comment - with_default, names_in_sources())

    def test_the_node_knows_every_parameter(self):
        text = (ROOT / "src/ros/parameters.cpp").read_text(encoding="utf-8")
        known = re.search(r"kParameterNames = \{(.*?)\};", text, re.DOTALL).group(1)
        of_node = {name.partition("/")[0] for name in SET_BY_NODE}
        self.assertEqual(set(re.findall(r'"(\w+)"', known)), names_in_sources() | of_node)

    def test_defaults_are_those_of_the_sources(self):
        defaults = defaults_in_headers()
        compared = 0
        for name, value in yaml.safe_load(FILE.read_text(encoding="utf-8")).items():
            if name in defaults:
                self.assertEqual(value, defaults[name], name)
                compared += 1
            else:
                self.assertIn(value, ("", {}, [], 1.0), name)
        self.assertGreater(compared, 15)

    def test_every_argument_of_the_launch_file_is_a_parameter_and_none_is_called_required(self):
        text = (ROOT / "launch/simulate.launch").read_text(encoding="utf-8")
        arguments = set(re.findall(r'<arg name="(\w+)" default="config"', text))
        self.assertTrue(arguments <= names_in_sources(), arguments - names_in_sources())
        for file in sorted((ROOT / "launch").glob("*.launch")):
            done = subprocess.run(["roslaunch", "--ros-args", str(file)], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, check=False, universal_newlines=True)
            if "No module named 'arg_dump'" in done.stderr:
                self.skipTest("this old roslaunch cannot list arguments with Python 3")
            self.assertEqual(done.returncode, 0, done.stderr)
            told = done.stdout
            required = told.partition("Optional Arguments:")[0]
            self.assertEqual(re.findall(r"^  (\w+):", required, re.MULTILINE),
                             ["scene"] if file.name == "simulate.launch" else [], file.name)


if __name__ == "__main__":
    unittest.main()
