#!/usr/bin/python3
"""Test the commands of docs/results.md, typed as they stand there: `results_test.py SETUP`."""

import os
import re
import sys
import tempfile
import unittest

from typed_commands import commands_of, text_of, type_commands


class Results(unittest.TestCase):
    def test_commands(self):
        arm = re.search(r'<robot name="arm">.*?</robot>', text_of("guide.md"), re.DOTALL).group(0)
        commands = commands_of("results.md")
        self.assertEqual(len(commands), 6)
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "arm.urdf"), "w", encoding="utf-8") as file:
                file.write(arm)
            status, printed = type_commands(commands, SETUP, folder)
            self.assertTrue(os.path.exists(os.path.join(folder, "arm_vtk", "run.pvd")))
        self.assertEqual(status, 0)
        for expected in ("arm em 0.001 s", "sensor/gauge/strain [1] 4001", "/sensors/cell geometry_msgs/WrenchStamped",
                         "/tf tf2_msgs/TFMessage 401", "largest pull"):
            self.assertIn(expected, printed)


if __name__ == "__main__":
    SETUP = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
