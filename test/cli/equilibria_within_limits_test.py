#!/usr/bin/python3
"""Test equilibria of chains of joints with limits: `equilibria_within_limits_test.py PROGRAM`.

Gravity has any direction, many joints start at a limit, some follow another joint, and many axes are parallel to each
other or to gravity, so that the start is often a saddle of the potential. scipy is the judge: it minimises the
potential within the limits, from flexarm's position and from positions near it, and must find nothing lower.
"""

import csv
import io
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import scipy.optimize

CHAINS = 150
LINK = """<joint name="j{k}" type="{kind}"> <parent link="{parent}"/> <child link="l{k}"/>
  <origin xyz="{place}" rpy="{rpy}"/> <axis xyz="{axis}"/>
  <limit lower="{lower!r}" upper="{upper!r}" effort="0" velocity="9"/> {mimic} </joint>
<link name="l{k}"> {inertial} </link>
"""
INERTIAL = """<inertial> <origin xyz="{}"/> <mass value="{!r}"/>
  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/> </inertial>"""


def rotation(axis, angle):
    """Return the 3 x 3 rotation matrix about a unit axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def numbers(values):
    return " ".join(repr(float(value)) for value in values)


class Joint:
    def __init__(self, generator, style):
        aligned = style > 0
        pick = generator.random(3) < 0.5
        self.place = generator.choice([0, 0.3, -0.2, 0.1], 3) * pick if aligned else generator.uniform(-0.3, 0.3, 3)
        self.rpy = generator.choice([0, 0, np.pi / 2, -np.pi / 2, np.pi], 3) if aligned else generator.uniform(-2, 2, 3)
        roll, pitch, yaw = self.rpy
        self.turn = rotation((0, 0, 1), yaw) @ rotation((0, 1, 0), pitch) @ rotation((1, 0, 0), roll)
        axis = np.eye(3)[generator.integers(3)] * generator.choice([1, -1]) if aligned else generator.normal(size=3)
        self.axis = axis / np.linalg.norm(axis)
        self.slides = generator.random() < 0.25
        size = 0.3 if self.slides else generator.choice([1.57, 2.9, 3.1, 6.28])
        self.lower, self.upper = -size * generator.uniform(0.1, 1), size * generator.uniform(0.1, 1)
        share = 0.35 if style >= 2 else 0.1
        side = generator.random()
        if side < share:
            self.lower = 0.0
        elif side < 2 * share:
            self.upper = 0.0
        self.mass = generator.uniform(0.1, 3)
        pick = generator.random(3) < 0.5
        self.centre = generator.choice([0, 0.15, -0.1], 3) * pick if aligned else generator.uniform(-0.15, 0.15, 3)
        self.master, self.multiplier = None, 1.0


class Chain:
    """Two to seven joints. `style` 0: any directions; 1: axes along x, y and z; 2: gravity, too."""

    def __init__(self, seed):
        generator = np.random.default_rng(seed)
        style = generator.integers(3)
        self.joints = [Joint(generator, style) for _ in range(generator.integers(2, 8))]
        leaders = [k for k in range(len(self.joints)) if generator.random() > 0.15] or [0]
        for k, joint in enumerate(self.joints):
            if k not in leaders:
                joint.master = int(generator.choice(leaders))
                joint.multiplier = float(generator.choice([1, -1, 0.5, -2]))
        self.free = leaders
        self.gravity = generator.normal(size=3)
        if style == 2:
            self.gravity = np.eye(3)[generator.integers(3)] * generator.choice([1, -1])
        self.gravity *= 9.81 / np.linalg.norm(self.gravity)
        self.weight = 9.81 * sum(joint.mass for joint in self.joints)

    def potential(self, values):
        """Return the potential energy [J] and its gradient by the joints that follow no other."""
        all_values = dict(zip(self.free, values))
        position, turn, placed = np.zeros(3), np.eye(3), []
        for k, joint in enumerate(self.joints):
            value = all_values[k] if joint.master is None else joint.multiplier * all_values[joint.master]
            position, turn = position + turn @ joint.place, turn @ joint.turn
            axis = turn @ joint.axis
            if joint.slides:
                position = position + axis * value
            else:
                turn = turn @ rotation(joint.axis, value)
            placed.append((axis, position, position + turn @ joint.centre))
        energy, mass, moment, slope = 0.0, 0.0, np.zeros(3), dict.fromkeys(self.free, 0.0)
        for k in reversed(range(len(self.joints))):
            joint, (axis, anchor, centre) = self.joints[k], placed[k]
            energy -= joint.mass * self.gravity @ centre
            mass, moment = mass + joint.mass, moment + joint.mass * centre
            own = -self.gravity @ (mass * axis if joint.slides else np.cross(axis, moment - mass * anchor))
            slope[k if joint.master is None else joint.master] += joint.multiplier * own
        return energy, np.array([slope[k] for k in self.free])

    def text(self):
        text = '<robot name="chain"> <link name="world"/>\n'
        for k, joint in enumerate(self.joints):
            mimic = ""
            if joint.master is not None:
                mimic = '<mimic joint="j%d" multiplier="%r"/>' % (joint.master, joint.multiplier)
            text += LINK.format(
                k=k, kind="prismatic" if joint.slides else "revolute", parent="l%d" % (k - 1) if k else "world",
                place=numbers(joint.place), rpy=numbers(joint.rpy), axis=numbers(joint.axis), lower=float(joint.lower),
                upper=float(joint.upper), mimic=mimic,
                inertial=INERTIAL.format(numbers(joint.centre), float(joint.mass)))
        return text + '<simulation> <gravity xyz="%s"/> </simulation> </robot>' % numbers(self.gravity)

    def lowest(self, start):
        """Return the lowest potential that scipy finds within the limits, from `start` and from near it."""
        lower, upper = (np.array([getattr(self.joints[k], side) for k in self.free]) for side in ("lower", "upper"))
        # Stops are elastic: a joint beyond its limit may stay at its value.
        bounds = np.column_stack([np.minimum(lower, start), np.maximum(upper, start)])
        generator = np.random.default_rng(1)
        energies = []
        for size in (0, 1e-4, 1e-3, 1e-2, 1e-2):
            near = np.clip(start + size * generator.normal(size=len(start)), bounds[:, 0], bounds[:, 1])
            energies.append(scipy.optimize.minimize(self.potential, near, jac=True, method="L-BFGS-B", bounds=bounds,
                                                    options={"ftol": 1e-15, "gtol": 1e-12}).fun)
        return min(energies)


class WithinLimits(unittest.TestCase):
    def rest(self, text):
        """Run `flexarm static`. Return {joint: position} and the messages."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.urdf")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            run = subprocess.run([PROGRAM, "static", path, "--output", "-"], capture_output=True, text=True,
                                 check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        row = next(csv.DictReader(io.StringIO(run.stdout)))
        return {name[len("joint/"):-len("/position")]: float(value) for name, value in row.items()
                if name.startswith("joint/") and name.endswith("/position")}, run.stderr

    def test_chains(self):
        for seed in range(CHAINS):
            chain = Chain(seed)
            with self.subTest(seed=seed):
                positions, _ = self.rest(chain.text())
                values = np.array([positions["j%d" % k] for k in chain.free])
                for k, value in zip(chain.free, values):
                    # Stops are springs with a stiffness of inertia (pi / 10 ms)^2, so weak ones give way visibly.
                    self.assertGreater(value, chain.joints[k].lower - 0.05)
                    self.assertLess(value, chain.joints[k].upper + 0.05)
                self.assertGreater(chain.lowest(values), chain.potential(values)[0] - 1e-8 * chain.weight)

    def flap(self, lower, upper, mass="1"):
        return self.rest('<robot name="flap"> <link name="world"/> <joint name="hinge" type="revolute">'
                         '<parent link="world"/> <child link="flap"/> <axis xyz="0 1 0"/>'
                         '<limit lower="%s" upper="%s" effort="1" velocity="1"/> </joint> <link name="flap"> <inertial>'
                         '<origin xyz="0 0 1"/> <mass value="%s"/> <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" '
                         'izz="1"/> </inertial> </link> </robot>' % (lower, upper, mass))

    def test_flap_that_stands_upright_at_a_limit_falls_to_the_other_one(self):
        for lower, upper, end in ((-3, 0, -3), (0, 3, 3)):
            positions, said = self.flap(lower, upper)
            self.assertAlmostEqual(positions["hinge"], end, delta=1e-3)  # a stop gives way by a little
            self.assertRegex(said, "not stable: link 'flap'")

    def test_flap_without_weight_stays_where_it_is(self):
        positions, said = self.flap(0, 1.5, "0")
        self.assertEqual(positions["hinge"], 0)
        self.assertRegex(said, "nothing holds joint 'hinge'")

    def test_wrist_that_turns_almost_freely_with_the_arm_before_it(self):
        """A yaw, a pitch and a twist: at zero pitch the axes of yaw and twist coincide. Equilibria form a curve, along
        which the potential changes only because the angles of the scene are rounded."""
        joint = ('<joint name="%s" type="revolute"> <parent link="%s"/> <child link="%s"/> '
                 '<origin xyz="%s" rpy="%s 0 0"'
                 '/> <axis xyz="0 0 1"/> <limit lower="%r" upper="%r" effort="0" velocity="9"/> </joint>')
        link = ('<link name="%s"> <inertial> <origin xyz="%s"/> <mass value="%s"/> <inertia ixx="1" ixy="0" ixz="0" '
                'iyy="1" iyz="0" izz="1"/> </inertial> </link>')
        positions, _ = self.rest(
            '<robot name="wrist"> <link name="world"/> <link name="column"/>' +
            joint % ("yaw", "world", "column", "0 0 0", "0", -2.9, 2.9) +
            joint % ("pitch", "column", "upper", "0 0 0", "-1.57079632679", -1.8, 1.8) +
            joint % ("twist", "upper", "fore", "0 -0.3 0", "1.57079632679", -2.9, 2.9) +
            link % ("upper", "0 0 0", "2.5") + link % ("fore", "0.1 0 0.2", "0.3") +
            '<simulation> <gravity xyz="9.81 0 0"/> </simulation> </robot>')
        yaw, pitch, twist = (positions[name] for name in ("yaw", "pitch", "twist"))
        # The centre of mass is as low, that is, as far along x, as its distance from the shoulder allows.
        way = rotation((0, 0, 1), yaw) @ rotation((0, 1, 0), pitch) @ (
            [0, 0, 0.3] + rotation((0, 0, 1), twist) @ [0.1, 0, 0.2])
        self.assertAlmostEqual(way[0], np.hypot(0.1, 0.5), delta=1e-9)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
