#!/usr/bin/python3
"""Test the commands of the tutorial about ROS, typed as they stand there: `tutorial_ros_test.py SETUP`."""

import os
import sys
import tempfile
import unittest

from typed_commands import commands_of, type_commands


class TutorialRos(unittest.TestCase):
    def test_commands(self):
        commands = commands_of("tutorial_ros.md")
        self.assertEqual(len(commands), 4)
        with tempfile.TemporaryDirectory() as folder:
            os.environ.update(ROS_HOSTNAME="localhost", ROS_HOME=os.path.join(folder, "ros"))
            status, printed = type_commands(commands, SETUP, folder)
        self.assertEqual(status, 0)
        # Held by the C++ controller, and by the Python controller
        self.assertEqual(printed.count("RESULT: SUCCESS"), 2)


if __name__ == "__main__":
    SETUP = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
