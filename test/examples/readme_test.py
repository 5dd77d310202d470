#!/usr/bin/python3
"""Test the scene of README.md with the commands that README.md gives for it: `readme_test.py SETUP`."""

import csv
import os
import re
import sys
import tempfile
import unittest

from typed_commands import text_of, type_commands


class Readme(unittest.TestCase):
    def test_its_scene_runs(self):
        (section,) = re.findall(r"^## One scene\n(.*?)^## ", text_of("../README.md"), re.DOTALL | re.MULTILINE)
        (scene,) = re.findall(r"^```xml\n(.*?)^```", section, re.DOTALL | re.MULTILINE)
        commands = re.findall(r"^```sh\n(.*?)^```", section, re.DOTALL | re.MULTILINE)
        self.assertEqual(len(commands), 1)
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "arm.urdf"), "w", encoding="utf-8") as file:
                file.write(scene)
            status, printed = type_commands(commands, SETUP, folder)
            self.assertEqual(status, 0)
            self.assertIn("mode 4", printed)
            with open(os.path.join(folder, "arm.csv"), encoding="utf-8") as file:
                rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        self.assertAlmostEqual(rows[-1]["time"], 4)
        self.assertGreater(max(row["joint/shoulder/position"] for row in rows), 0.5)  # the motor moves the arm
        self.assertGreater(max(row["energy/strain"] for row in rows), 0.01)  # the arm bends


if __name__ == "__main__":
    SETUP = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
