#!/usr/bin/python3
"""Test the commands of the tutorials, typed as they stand there, in one folder: `tutorials_test.py SETUP`."""

import os
import sys
import tempfile
import unittest

from typed_commands import commands_of, type_commands

TUTORIALS = "tutorial_flexible_link.md", "tutorial_servo.md"  # the second continues the first


class Tutorials(unittest.TestCase):
    def test_commands(self):
        commands = [command for name in TUTORIALS for command in commands_of(name)]
        self.assertEqual(len(commands), 8)
        with tempfile.TemporaryDirectory() as folder:
            status, printed = type_commands(commands, SETUP, folder)
            self.assertEqual(status, 0)
            self.assertGreater(os.path.getsize(os.path.join(folder, "shaped_slew.png")), 0)
        # Results that the text of the tutorials promises.
        for expected in ("mode 2: 4.56", "motor -6.105 N m", "shoulder at the end: 0.999", "swing: 4.567",
                         "unshaped: the hand swings by 31.", "shaped: the hand swings by 0.8"):
            self.assertIn(expected, printed)


if __name__ == "__main__":
    SETUP = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
