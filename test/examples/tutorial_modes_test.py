#!/usr/bin/python3
"""Test the commands of the tutorial about bags and modes, typed as they stand there: `tutorial_modes_test.py SETUP`."""

import math
import os
import re
import socket
import sys
import tempfile
import unittest

from typed_commands import commands_of, type_commands


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class TutorialModes(unittest.TestCase):
    def test_commands(self):
        commands = commands_of("tutorial_modes.md")
        self.assertEqual(len(commands), 3)
        with tempfile.TemporaryDirectory() as folder:
            os.environ.update(ROS_HOSTNAME="localhost", ROS_HOME=os.path.join(folder, "ros"),
                              ROS_MASTER_URI="http://localhost:%d" % free_port())
            status, printed = type_commands(commands, SETUP, folder)
            self.assertEqual(status, 0)
            self.assertGreater(os.path.getsize(os.path.join(folder, "modes.png")), 0)
        self.assertIn("missing: 0", printed)
        modes = [float(frequency) for frequency in re.findall(r"mode \d: (\S+) Hz", printed)]
        found = [float(frequency) for frequency in re.findall(r"identified: (\S+) Hz", printed)]
        self.assertGreaterEqual(len(found), 3)
        # The scheme lengthens a period by the relative amount (omega h)^2 / 12. Another 1e-3 allows for the noise of
        # the gauge.
        for frequency, mode in zip(found, modes[0::2]):
            expected = mode * (1 - (2 * math.pi * mode * 1e-3) ** 2 / 12)
            self.assertAlmostEqual(frequency, expected, delta=1e-3 * expected)


if __name__ == "__main__":
    SETUP = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
