#!/usr/bin/python3
"""Equilibria of arms whose first axis is vertical but for a small tilt: `equilibria_test.py PROGRAM`.

Judged from outside: by the potential and the moments that forward kinematics in numpy gives, and by scipy's minimum of
that potential from where flexarm has come to rest.
"""

import csv
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import scipy.optimize

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "scripts"))
from gravity_moments import GRAVITY, Robot, left_over, moments  # noqa: E402

ARMS = 48
PAN = """<robot name="arm"> <link name="world"/>
%s</robot>
"""
LINK = """<joint name="{name}" type="{kind}"> <parent link="{parent}"/> <child link="{child}"/>
  <origin xyz="{x} {y} {z}" rpy="{roll} {pitch} 0"/> <axis xyz="{axis}"/> {limit} </joint>
<link name="{child}"> <inertial> <origin xyz="{cx} {cy} {cz}"/> <mass value="{mass}"/>
  <inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/> </inertial> </link>
"""


def arm(generator, tilt):
    """A chain of four to six hinges, some of them with limits; the first axis is along z but for `tilt` [rad]."""
    text, parent = "", "world"
    for k in range(generator.integers(4, 7)):
        place, centre = generator.uniform(-0.3, 0.3, 3), generator.uniform(-0.15, 0.15, 3)
        axis = "0 0 1" if k == 0 else ("1 0 0", "0 1 0", "0 0 1")[generator.integers(3)]
        roll, pitch = (tilt, 0) if k == 0 else generator.choice((0, np.pi / 2, 0.3), 2)
        is_limited = k > 0 and generator.random() < 0.3
        text += LINK.format(
            name=f"j{k}", kind="revolute" if is_limited else "continuous", parent=parent, child=f"l{k}", axis=axis,
            x=place[0], y=place[1], z=place[2], roll=roll, pitch=pitch, cx=centre[0], cy=centre[1], cz=centre[2],
            mass=generator.uniform(0.1, 3),
            limit='<limit lower="-1.2" upper="0.9" effort="0" velocity="0"/>' if is_limited else "")
        parent = f"l{k}"
    return PAN % text


def potential(robot, names, values):
    """[J]"""
    poses, _ = robot.place(dict(zip(names, values)))
    return -sum(mass * GRAVITY @ (poses[link][0] + poses[link][1] @ centre)
                for link, (mass, centre) in robot.masses.items())


def rest(path):
    """{coordinate: position} of `flexarm static`, and what it said."""
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "rest.csv")
        run = subprocess.run([PROGRAM, "static", path, "--output", table], capture_output=True, text=True, check=False)
        if run.returncode:
            return None, run.stderr
        with open(table, newline="", encoding="utf-8") as file:
            row = next(csv.DictReader(file))
    return {name[len("joint/"):-len("/position")]: float(value) for name, value in row.items()
            if name.startswith("joint/") and name.endswith("/position")}, run.stderr


class Arms(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "arm.urdf")

    def write(self, text):
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(text)

    def expect_minimum(self, positions):
        """No moment is left, and no motion of joints that are not at a stop goes down, but by what round-off hides."""
        robot, names = Robot(self.path), list(positions)
        start = np.array(list(positions.values()))
        joints = moments(self.path, positions)
        # Stops give way: what stands beyond its limit stays there.
        bounds = [(min(joints[name][3], value), max(joints[name][4], value)) for name, value in positions.items()]
        best = scipy.optimize.minimize(lambda q: potential(robot, names, q), start, method="L-BFGS-B", bounds=bounds,
                                       options={"ftol": 0, "gtol": 1e-12})
        weight = sum(mass for mass, _ in robot.masses.values()) * 9.81
        self.assertGreater(best.fun, potential(robot, names, start) - 1e-9 * weight)

    def test_first_axis_is_vertical_but_for_a_tilt(self):
        tilts = [0] + list(np.logspace(-9, -2, 15))
        for number in range(ARMS):
            tilt = tilts[number % len(tilts)]
            with self.subTest(arm=number, tilt=tilt):
                self.write(arm(np.random.default_rng(number), tilt))
                positions, said = rest(self.path)
                self.assertIsNotNone(positions, said)
                left, joint = left_over(self.path, positions)
                self.assertLess(left, 1e-9, joint)
                self.expect_minimum(positions)
                if tilt == 0:
                    self.assertLess(abs(positions["j0"]), 1e-9)
                    self.assertRegex(said, "nothing holds joints? 'j0'")
                else:
                    self.assertNotRegex(said, "nothing holds joints? 'j0'")
                    # The moment about the pan axis is weight times an arm times the tilt times the sine of its angle:
                    # what is left of it is left of that, not of the weight.
                    moment, largest, *_ = moments(self.path, positions)["j0"]
                    self.assertLess(abs(moment), largest * max(1e-3 * tilt, 1e-13))


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
