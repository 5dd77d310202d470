#!/usr/bin/python3
"""Test the commands of the tutorial about the library, typed as they stand there: `tutorial_library_test.py SETUP
BUILD`."""

import os
import re
import sys
import tempfile
import unittest

from typed_commands import commands_of, type_commands


class TutorialLibrary(unittest.TestCase):
    def test_commands(self):
        commands = commands_of("tutorial_library.md")
        self.assertEqual(len(commands), 3)
        with tempfile.TemporaryDirectory() as folder:
            os.environ.update(ROS_HOSTNAME="localhost", ROS_HOME=os.path.join(folder, "ros"), FLEXARM_BUILD=BUILD)
            status, printed = type_commands(commands, SETUP, folder)
        self.assertEqual(status, 0)
        swings = re.findall(r"^(\S+ kg: swings by \S+ mm)$", printed, re.MULTILINE)
        self.assertEqual(len(swings), 9)
        self.assertEqual(swings, 3 * swings[:3])  # the same for each of the three places of the library


if __name__ == "__main__":
    SETUP, BUILD = map(os.path.abspath, sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
