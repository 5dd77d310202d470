#!/usr/bin/python3
"""Test equilibria of beams that `flexarm static` finds: `equilibria_of_beams_test.py PROGRAM`.

The scenes are columns, and a ball on a cantilever. The judge is Euler's elastica.
"""

import itertools
import os
import re
import subprocess
import sys
import unittest

import numpy as np
import scipy.integrate
import scipy.optimize
import scipy.special

from scene_folder import Scenes


class Columns(Scenes):
    """Clamped columns of length 1 and bending stiffness 1, beyond their buckling load. Without a load across, and with
    one that is as small as the imperfections of real columns."""

    STIFFNESS = 1e6  # against stretch and shear

    def tip(self, ratio, across, elements):
        """Return {tip's position, its distance to the side} under `ratio` times the buckling load."""
        self.write("""<robot name="column"> <link name="world"/> <link name="column"> <beam elements="%d" order="2">
          <centerline> <line to="0 0 1"/> </centerline> <orientation y="0 1 0"/>
          <section ea="%g" ga2="%g" ga3="%g" gj="1" ei2="1" ei3="1" mass="1" j1="1e-3" j2="5e-4" j3="5e-4"/> </beam>
          </link> <joint name="clamp" type="fixed"> <parent link="world"/> <child link="column"/> </joint>
          <simulation> <gravity xyz="0 0 0"/> <load link="column" at="0 0 1" force="%r 0 %r"/>
          <probe name="tip" link="column" at="0 0 1"/> </simulation> </robot>"""
                   % (elements, *3 * (self.STIFFNESS,), across, -ratio * np.pi**2 / 4))
        run = subprocess.run([PROGRAM, "static", self.path], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stderr, "not stable: link 'column'")
        return [float(value) for value in re.search(r"probe tip +(\S+) +(\S+) +(\S+)", run.stdout).groups()]

    def test_elastica(self):
        for ratio in (1.05, 1.5, 2.5, 3.5, 3.75, 4, 4.5):
            root = np.pi / 2 * np.sqrt(ratio)  # K(k) of the elastica
            modulus = scipy.optimize.brentq(lambda m: scipy.special.ellipk(m) - root, 1e-6, 1 - 1e-12, xtol=1e-15)
            height = 2 * scipy.special.ellipe(modulus) / root - 1
            side = 2 * np.sqrt(modulus) / root
            for elements in (8, 24):
                # Strains of the order of the load over the stiffness; elements of order two.
                error = 10 * ratio * np.pi**2 / 4 / self.STIFFNESS + 4 * (2 * np.pi / elements)**4 / 180
                for across in (0.0, 1e-7):
                    with self.subTest(ratio=ratio, elements=elements, across=across):
                        x, y, z = self.tip(ratio, across, elements)
                        self.assertAlmostEqual(z, height, delta=error)
                        self.assertAlmostEqual(x if across else np.hypot(x, y), side, delta=error)


class Feet(Scenes):
    """A ball on a vertical guide is pressed onto a cantilever of length 1 and bending stiffness 1, and slides along it
    without friction. The beam is stiff to the side, where the ball could fall off. The judge is the elastica, shot from
    the clamp."""

    BALL, GUIDE = 0.03, 0.7
    STIFFNESS = 1e6  # of the rod and of the contact
    ROD = float(2 * np.sqrt(100 / STIFFNESS))  # radius of a round rod with the larger one of the bending stiffnesses

    def elastica(self, load):
        """Return the tip's position, and the ball's height."""
        reach = self.BALL + self.ROD  # from the rod's line to the ball's centre

        def shot(moment, length, slope):
            """Return {x, z, slope, moment} where the ball presses, across the rod's `slope` there."""
            force = load * np.tan(slope), -load
            return scipy.integrate.solve_ivp(
                lambda _, y: (np.cos(y[2]), np.sin(y[2]), y[3], np.sin(y[2]) * force[0] - np.cos(y[2]) * force[1]),
                (0, length), (0, 0, 0, moment), rtol=1e-11, atol=1e-13).y[:, -1]

        def lacking(guess):
            x, _, slope, moment = shot(*guess)
            return moment, slope - guess[2], x - reach * np.sin(slope) - self.GUIDE

        guess = scipy.optimize.fsolve(lacking, (-load * self.GUIDE, self.GUIDE, -load * self.GUIDE**2 / 2), xtol=1e-13)
        self.assertLess(np.abs(lacking(guess)).max(), 1e-10)
        x, z, slope, _ = shot(*guess)
        free = 1 - guess[1]
        return x + free * np.cos(slope), z + free * np.sin(slope), z + reach * np.cos(slope)

    def test_ball_slides_along_a_cantilever(self):
        elements = 24
        for load, gap in itertools.product((0.3, 0.7, 1.1, 1.4), (-1e-5, 0, 1e-3)):
            self.write("""<robot name="foot"> <link name="world"/>
              <link name="arm"> <beam elements="%d" order="2"> <centerline> <line to="1 0 0"/> </centerline>
                <orientation y="0 1 0"/>
                <section ea="%g" ga2="%g" ga3="%g" gj="100" ei2="1" ei3="100" mass="1" j1="2e-4" j2="1e-4" j3="1e-4"/>
                </beam> </link>
              <joint name="clamp" type="fixed"> <parent link="world"/> <child link="arm"/> </joint>
              <link name="ball"> <inertial> <mass value="0.3"/>
                <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/> </inertial>
                <collision> <geometry> <sphere radius="%g"/> </geometry> </collision> </link>
              <joint name="guide" type="prismatic"> <parent link="world"/> <child link="ball"/>
                <origin xyz="%g 0 %r"/> <axis xyz="0 0 1"/>
                <limit lower="-10" upper="10" effort="0" velocity="0"/> </joint>
              <contact first="ball" second="arm" stiffness="%g"/>
              <simulation> <gravity xyz="0 0 0"/> <load link="ball" at="0 0 0" force="0 0 %r"/>
                <probe name="tip" link="arm" at="1 0 0"/> </simulation> </robot>"""
                       % (elements, *3 * (self.STIFFNESS,), self.BALL, self.GUIDE, self.BALL + self.ROD + gap,
                          self.STIFFNESS, -load))
            run = subprocess.run([PROGRAM, "static", self.path], capture_output=True, text=True, check=False)
            with self.subTest(load=load, gap=gap):
                self.assertEqual(run.returncode, 0, run.stderr)
                tip = [float(value) for value in re.search(r"probe tip +(\S+) +(\S+) +(\S+)", run.stdout).groups()]
                ball = float(re.search(r"link ball +\S+ +\S+ +(\S+)", run.stdout).group(1))
                # Strains and depths of the order of the load over the stiffness; elements of order two.
                error = 10 * load / self.STIFFNESS + 4 * (1 / elements)**4
                for got, exact in zip((tip[0], tip[2], ball), self.elastica(load)):
                    self.assertAlmostEqual(got, exact, delta=error)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
