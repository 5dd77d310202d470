#!/usr/bin/python3
"""Test that scripts/dependencies.txt and package.xml name the same dependencies."""

import os
import unittest
import xml.etree.ElementTree

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
DEPENDENCY_TAGS = (
    "depend",
    "build_depend",
    "buildtool_depend",
    "build_export_depend",
    "exec_depend",
    "test_depend",
)


def read_list():
    """Return the lines `debian-package key...`. The key `-` marks a package that package.xml does not name."""
    with open(os.path.join(ROOT, "scripts", "dependencies.txt"), encoding="utf-8") as file:
        lines = [line.split("#")[0].split() for line in file]
    return [line for line in lines if line]


def read_package():
    package = xml.etree.ElementTree.parse(os.path.join(ROOT, "package.xml")).getroot()
    return {element.text for element in package if element.tag in DEPENDENCY_TAGS}


class Dependencies(unittest.TestCase):
    def test_every_line_has_a_package_and_a_key(self):
        for line in read_list():
            self.assertGreaterEqual(len(line), 2, " ".join(line))
            self.assertTrue("-" not in line[1:] or len(line) == 2, " ".join(line))

    def test_no_package_is_listed_twice(self):
        packages = [line[0] for line in read_list()]
        self.assertEqual(sorted(packages), sorted(set(packages)))

    def test_every_key_of_the_list_is_in_package_xml(self):
        keys = {key for line in read_list() for key in line[1:] if key != "-"}
        self.assertEqual(keys - read_package(), set())

    def test_every_dependency_of_package_xml_is_in_the_list(self):
        keys = {key for line in read_list() for key in line[1:]}
        self.assertEqual(read_package() - keys, set())


if __name__ == "__main__":
    unittest.main()
