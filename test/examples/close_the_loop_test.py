#!/usr/bin/python3
"""examples/close_the_loop.cpp: `close_the_loop_test.py PROGRAM`."""

import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SCENE = os.path.join(ROOT, "config", "examples", "flexible_two_link_arm.urdf")
SHOULDER, ELBOW = 0.8, -0.5  # rad


class CloseTheLoop(unittest.TestCase):
    def run_program(self, *arguments):
        return subprocess.run(
            [PROGRAM] + list(arguments),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            universal_newlines=True,
            check=False,
        )

    def test_holds_the_arm_where_it_is_told_to(self):
        result = self.run_program(SCENE, "shoulder", str(SHOULDER), "elbow", str(ELBOW))
        self.assertEqual(result.returncode, 0, result.stderr)
        last = result.stdout.splitlines()[-1]
        self.assertTrue(last.startswith("4.000 s"), last)
        upper, fore = (
            [float(x) for x in re.search(link + r" \((.*?)\)", last).group(1).split()]
            for link in ("upper_arm", "forearm")
        )
        # The slowest motion, the stretched arm (3 kg m^2 at most) on the shoulder's spring and damper, has decayed by
        # exp(-12 / (2 * 3) * 4) = 3e-4 of its first radian; bending by gravity shortens the 1 m of a link by its
        # square.
        self.assertAlmostEqual(math.atan2(upper[1], upper[0]), SHOULDER, delta=0.01)
        self.assertAlmostEqual(math.atan2(fore[1] - upper[1], fore[0] - upper[0]), SHOULDER + ELBOW, delta=0.01)
        kinetic, strain = (float(re.search(kind + r" (\S+) J", last).group(1)) for kind in ("kinetic", "strain"))
        self.assertGreater(strain, kinetic)  # it hangs, nearly at rest

    def test_says_what_is_wrong(self):
        result = self.run_program("missing.urdf", "shoulder", "0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("missing.urdf", result.stderr)
        with open(SCENE, encoding="utf-8") as file:
            text = file.read()
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.urdf")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text.replace('outer_radius="0.015"', 'outer_radius="-1"'))
            result = self.run_program(path, "shoulder", "0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("bad.urdf:", result.stderr)
        result = self.run_program(SCENE, "knee", "0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("knee", result.stderr)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
