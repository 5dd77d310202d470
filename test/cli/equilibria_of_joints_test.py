#!/usr/bin/python3
"""Test equilibria of joints that `flexarm static` finds: `equilibria_of_joints_test.py PROGRAM`.

The scenes are arms whose first axis is vertical or slightly tilted, loops, and joints whose limits are equal.
Independent code is the judge: numpy computes potential and moments by forward kinematics, and scipy minimises the
potential from the position that flexarm found.
"""

import csv
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import scipy.optimize

from scene_folder import Scenes

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
    """Return a chain of four to six hinges, some with limits. The first axis is along z, tilted by `tilt` [rad]."""
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
    """Return the potential energy [J]."""
    poses, _ = robot.place(dict(zip(names, values)))
    return -sum(mass * GRAVITY @ (poses[link][0] + poses[link][1] @ centre)
                for link, (mass, centre) in robot.masses.items())


def rest(path):
    """Run `flexarm static`. Return {coordinate: position} and the messages of the program."""
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "rest.csv")
        run = subprocess.run([PROGRAM, "static", path, "--output", table], capture_output=True, text=True, check=False)
        if run.returncode:
            return None, run.stderr
        with open(table, newline="", encoding="utf-8") as file:
            row = next(csv.DictReader(file))
    return {name[len("joint/"):-len("/position")]: float(value) for name, value in row.items()
            if name.startswith("joint/") and name.endswith("/position")}, run.stderr


class Arms(Scenes):
    def expect_minimum(self, positions):
        """Check that no moment is left, and that no motion of joints away from their stops lowers the potential by more
        than round-off."""
        robot, names = Robot(self.path), list(positions)
        start = np.array(list(positions.values()))
        joints = moments(self.path, positions)
        # Stops are elastic: a coordinate beyond its limit may stay at its value.
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
                    # The moment about the pan axis is weight * lever arm * tilt * sin(pan angle). The remaining moment
                    # is judged against this small product, not against the weight.
                    moment, largest, *_ = moments(self.path, positions)["j0"]
                    self.assertLess(abs(moment), largest * max(1e-3 * tilt, 1e-13))


def body(name, mass, centre):
    return ('<link name="%s"> <inertial> <origin xyz="%.17g %.17g %.17g"/> <mass value="%.17g"/>\n'
            '  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/> </inertial> </link>\n'
            % (name, *centre, mass))


def hinge(name, parent, child, place=(0, 0, 0), axis="0 1 0", rest='type="continuous"', roll=0):
    kind, _, limit = rest.partition(" ")
    return ('<joint name="%s" %s> <parent link="%s"/> <child link="%s"/> '
            '<origin xyz="%.17g %.17g %.17g" rpy="%.17g 0 0"/>'
            ' <axis xyz="%s"/> %s </joint>\n' % (name, kind, parent, child, *place, roll, axis, limit))


def pin(name, parent, child, place, in_child):
    return ('<loop_joint name="%s" type="continuous"> <parent link="%s"/> <child link="%s"/> '
            '<origin xyz="%.17g 0 %.17g"/>'
            ' <child_origin xyz="%.17g 0 0"/> <axis xyz="0 1 0"/> </loop_joint>\n'
            % (name, parent, child, *place, in_child))


def meet(first, second, one, other, side):
    """Return the point in the x-z plane where two bars of lengths `one` and `other`, from the points `first` and
    `second`, meet."""
    way = second - first
    length = np.hypot(*way)
    along = (one**2 - other**2 + length**2) / (2 * length)
    across = np.sqrt(one**2 - along**2)
    return first + along * way / length + side * across * np.array([-way[1], way[0]]) / length


def angle(way):
    """Return the angle of a vector in the x-z plane about y, measured from x."""
    return np.arctan2(-way[1], way[0])


class FourBar:
    """A crank, a coupler and a rocker in the x-z plane of a base. The base turns about an axis that is vertical or
    slightly tilted."""

    CRANK, COUPLER, ROCKER, GROUND = 0.3, 0.7, 0.5, 0.8

    def __init__(self, crank, tilt=0.0, pan='type="continuous"'):
        _, elbow, _ = self.places(crank)
        tip = self.CRANK * np.array([np.cos(crank), -np.sin(crank)])
        coupler, rocker = angle(elbow - tip), angle(elbow - [self.GROUND, 0])
        self.text = '<robot name="four_bar"> <link name="world"/>\n' + body("base", 3, (0.2, 0.1, 0.1))
        self.text += hinge("pan", "world", "base", axis="0 0 1", rest=pan, roll=tilt)
        self.text += body("crank", 1, (0.15, 0, 0)) + body("coupler", 2, (0.35, 0, 0))
        self.text += body("rocker", 1.5, (0.25, 0, 0))
        self.text += hinge("a", "base", "crank") + hinge("b", "crank", "coupler", (self.CRANK, 0, 0))
        self.text += hinge("c", "base", "rocker", (self.GROUND, 0, 0))
        self.text += pin("pin", "coupler", "rocker", (self.COUPLER, 0), self.ROCKER)
        self.text += "<simulation>" + "".join(
            '<initial joint="%s" position="%.17g"/>' % entry
            for entry in (("a", crank), ("b", coupler - crank), ("c", rocker))) + "</simulation> </robot>"

    def places(self, crank):
        tip = self.CRANK * np.array([np.cos(crank), -np.sin(crank)])
        ground = np.array([self.GROUND, 0.0])
        return tip, meet(tip, ground, self.COUPLER, self.ROCKER, 1), ground

    def potential(self, pan, crank, tilt=0.0):
        """Return the potential energy [J]."""
        tip, elbow, ground = self.places(crank)
        centre = 1 * tip / 2 + 2 * (tip + elbow) / 2 + 1.5 * (elbow + ground) / 2 + 3 * np.array([0.2, 0.1])
        along, across, up = centre[0], 3 * 0.1, centre[1]
        return 9.81 * (np.sin(tilt) * (np.sin(pan) * along + np.cos(pan) * across) + np.cos(tilt) * up)


class Platform:
    """A plate in the x-z plane that hangs on three legs. Each leg has two bars."""

    BARS, MASSES = (0.5, 0.55), (0.5, 0.4)
    PIVOTS = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.3]])
    CORNERS = np.array([[0.35, -0.6], [0.65, -0.6], [0.5, -0.4]])  # at the start
    MASS, CENTRE = 2, np.array([0.22, 0.07])  # from the first corner

    def __init__(self):
        self.text = '<robot name="platform"> <link name="world"/>\n'
        self.text += body("plate", self.MASS, (self.CENTRE[0], 0, self.CENTRE[1]))
        self.start, loops = [], ""
        for k, (pivot, corner) in enumerate(zip(self.PIVOTS, self.CORNERS)):
            knee = meet(pivot, corner, *self.BARS, 1)
            hip = angle(knee - pivot)
            self.start += [hip, angle(corner - knee) - hip]
            for name, mass, length in zip("ul", self.MASSES, self.BARS):
                self.text += body(name + str(k), mass, (length / 2, 0, 0))
            self.text += hinge("h%d" % k, "world", "u%d" % k, (pivot[0], 0, pivot[1]))
            self.text += hinge("k%d" % k, "u%d" % k, "l%d" % k, (self.BARS[0], 0, 0))
            if k > 0:
                loops += pin("p%d" % k, "plate", "l%d" % k, corner - self.CORNERS[0], self.BARS[1])
        self.text += hinge("p0", "l0", "plate", (self.BARS[1], 0, 0))
        self.start.append(-sum(self.start[:2]))
        self.names = ["h0", "k0", "h1", "k1", "h2", "k2", "p0"]
        self.text += loops + "<simulation>" + "".join(
            '<initial joint="%s" position="%r"/>' % (name, float(value)) for name, value in zip(self.names, self.start))
        self.text += "</simulation> </robot>"

    def legs(self, values):
        """Return the positions of knees and of leg ends, each of shape (3, 2)."""
        way = lambda angles: np.stack([np.cos(angles), -np.sin(angles)], axis=1)  # noqa: E731
        hips, knees = np.array(values[0:6:2]), np.array(values[1:6:2])
        middle = self.PIVOTS + self.BARS[0] * way(hips)
        return middle, middle + self.BARS[1] * way(hips + knees)

    def potential(self, values):
        """Return the potential energy [J]."""
        middle, ends = self.legs(values)
        heights = self.MASSES[0] * (self.PIVOTS + middle)[:, 1] / 2 + self.MASSES[1] * (middle + ends)[:, 1] / 2
        return 9.81 * (heights.sum() + self.MASS * (ends[0] + self.turn(values) @ self.CENTRE)[1])

    def turn(self, values):
        turned = values[0] + values[1] + values[6]
        return np.array([[np.cos(turned), np.sin(turned)], [-np.sin(turned), np.cos(turned)]])

    def gaps(self, values):
        _, ends = self.legs(values)
        return np.concatenate([ends[0] + self.turn(values) @ (self.CORNERS[k] - self.CORNERS[0]) - ends[k]
                               for k in (1, 2)])


class Loops(Scenes):
    def rest_of(self, text):
        self.write(text)
        positions, said = rest(self.path)
        self.assertIsNotNone(positions, said)
        return positions, said

    def test_four_bar_under_a_vertical_axis(self):
        for crank in np.linspace(-3, 3, 7):
            bars = FourBar(float(crank))
            positions, said = self.rest_of(bars.text)
            self.assertLess(abs(positions["pan"]), 1e-9, "nothing turns it")
            self.assertRegex(said, "nothing holds joint 'pan'")
            best = scipy.optimize.minimize_scalar(
                lambda q: bars.potential(0, q), bounds=(positions["a"] - 0.5, positions["a"] + 0.5), method="bounded",
                options={"xatol": 1e-12})
            # Round-off hides a minimum to within the square root of the round-off of the potential.
            self.assertAlmostEqual(best.x, positions["a"], delta=1e-6)

    def test_four_bar_under_a_tilted_axis(self):
        for tilt in (1e-6, 1e-3, 0.1):
            bars = FourBar(0.7, tilt)
            positions, _ = self.rest_of(bars.text)
            start = np.array([positions["pan"], positions["a"]])
            best = scipy.optimize.minimize(lambda q: bars.potential(*q, tilt), start, method="L-BFGS-B",
                                           options={"ftol": 0, "gtol": 1e-12})
            self.assertGreater(best.fun, bars.potential(*start, tilt) - 1e-12 * 9.81 * 7.5)
            slope = [(bars.potential(*(start + way), tilt) - bars.potential(*(start - way), tilt)) / 2e-5
                     for way in 1e-5 * np.eye(2)]
            self.assertLess(np.abs(slope).max(), 1e-9 * 9.81 * 7.5)

    def test_platform_on_three_legs(self):
        platform = Platform()
        self.assertLess(np.abs(platform.gaps(platform.start)).max(), 1e-12)
        positions, _ = self.rest_of(platform.text)
        values = np.array([positions[name] for name in platform.names])
        self.assertLess(np.abs(platform.gaps(values)).max(), 1e-9)
        best = scipy.optimize.minimize(platform.potential, values, method="SLSQP", options={"ftol": 1e-15},
                                       constraints={"type": "eq", "fun": platform.gaps})
        weight = 9.81 * (platform.MASS + 3 * sum(platform.MASSES))
        self.assertGreater(best.fun, platform.potential(values) - 1e-9 * weight)
        self.assertLess(platform.potential(values), platform.potential(platform.start))

    def test_limits_of_an_axis_above_a_loop_are_not_touched(self):
        pan = 'type="revolute" <limit lower="-1" upper="1" effort="0" velocity="0"/>'
        positions, _ = self.rest_of(FourBar(0.7, 0.0, pan).text)
        self.assertLess(abs(positions["pan"]), 1e-9)


class WithoutRange(Scenes):
    """Joints whose lower and upper limits are equal: the stops also hold a body that stands upright."""

    def test_upright(self):
        inertia, weight = 0.02 + 1 * 0.5**2, 9.81 * 0.5
        for place in (0.0, 0.3):
            self.write("""<robot name="up"> <link name="world"/> <link name="bar"> <inertial> <origin xyz="0 0 0.5"/>
              <mass value="1"/> <inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
              <joint name="a" type="revolute"> <parent link="world"/> <child link="bar"/> <axis xyz="0 1 0"/>
              <limit lower="%.17g" upper="%.17g" effort="1" velocity="1"/> </joint>
              <simulation> <integrator step="0.001"/> <initial joint="a" position="%.17g"/> </simulation> </robot>"""
                       % (place, place, place))
            positions, said = rest(self.path)
            self.assertIsNotNone(positions, said)
            self.assertNotRegex(said, "stable|nothing holds")
            # The documented law of stops (docs/notes/stops.md 2): a stop that is barely touched forms an oscillator
            # with a period of twenty steps. A stop without range gives way by at most 1e-4 rad.
            swing, give = np.pi / 0.01, 1e-4

            def left(depth, swing=swing, give=give, place=place):
                part = depth / give
                push = inertia * swing**2 * depth * (1 + 3 * part**2) / (1 - part**2) ** 5
                return push - weight * np.sin(place + depth)

            depth = scipy.optimize.brentq(left, 0, 0.9 * give, xtol=1e-15)
            self.assertAlmostEqual(positions["a"] - place, depth, delta=1e-10)
            run = subprocess.run([PROGRAM, "modes", self.path], capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            frequency = float(re.search(r"mode 1: (\S+) Hz", run.stdout).group(1))
            if place == 0:
                damping = 0.497239 * swing
                exact = np.sqrt(swing**2 - weight / inertia - damping**2) / (2 * np.pi)
                self.assertAlmostEqual(frequency, exact, delta=1e-6 * exact)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
