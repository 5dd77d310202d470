#!/usr/bin/python3
"""Test the program of examples/close_the_loop.cpp by running it: `close_the_loop_test.py PROGRAM`."""

import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
GOAL, STIFFNESS, DAMPING = 0.8, 200.0, 2.0  # rad, N m/rad, N m s/rad
MOVE = 3.0  # s


def guide_arm():
    """Return the scene of the arm in docs/guide.md."""
    with open(os.path.join(ROOT, "docs", "guide.md"), encoding="utf-8") as file:
        return re.search(r'<robot name="arm">.*?</robot>', file.read(), re.DOTALL).group(0)


class CloseTheLoop(unittest.TestCase):
    def run_program(self, scene, *arguments):
        """Run the program with a file that contains the text `scene`."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "arm.urdf")
            with open(path, "w", encoding="utf-8") as file:
                file.write(scene)
            return subprocess.run(
                [PROGRAM, path] + [str(argument) for argument in arguments],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                universal_newlines=True,
                check=False,
            )

    def test_moves_the_arm_where_it_is_told_to(self):
        result = self.run_program(guide_arm(), "shoulder", GOAL, STIFFNESS, DAMPING)
        self.assertEqual(result.returncode, 0, result.stderr)
        last = result.stdout.splitlines()[-1]
        self.assertTrue(last.startswith("5.000 s, boom "), last)
        x, y, z = (float(number) for number in re.search(r"boom \((.*?)\)", last).group(1).split())
        # The arm (payload and rod) lags behind: its inertia acts on the springs of controller and rod. The amplitude of
        # the vibration is at most the sum of the two jumps of the force that cause it, to the largest force and back
        # from it.
        mass = math.pi * 0.008**2 * 2 * 2700
        inertia = 1 * 2**2 + mass * 2**2 / 3
        rod = 3 * 70e9 * math.pi / 4 * 0.008**4 / 2
        force = inertia * 6 * GOAL / MOVE**2
        self.assertAlmostEqual(math.atan2(y, x), GOAL, delta=4 * force * (1 / STIFFNESS + 1 / rod))
        self.assertAlmostEqual(math.hypot(x, y), 2, delta=0.01)
        self.assertEqual(z, 0)

    def test_says_what_is_wrong(self):
        for scene, joint, what in (
            ("<robot", "shoulder", "arm.urdf"),
            (guide_arm().replace('radius="0.008"', 'radius="-1"'), "shoulder", "radius must be > 0"),
            (guide_arm(), "knee", "no joint 'knee'"),
        ):
            result = self.run_program(scene, joint, GOAL, STIFFNESS, DAMPING)
            self.assertEqual(result.returncode, 2, what)
            self.assertIn(what, result.stderr)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
