#!/usr/bin/python3
"""Test the references of `flexarm bench accuracy` against closed forms and against equations that are derived
independently.

outside_references_test.py [PROGRAM]
"""

import cmath
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from scipy.integrate import solve_ivp

HERE = os.path.dirname(os.path.abspath(__file__))
PACKAGE = os.path.join(HERE, "..", "..", "scripts", "outside_references")
sys.path.insert(0, PACKAGE)
import scenes  # noqa: E402
import time_functions  # noqa: E402
from elements import restitution_of  # noqa: E402
from mechanism import Refused  # noqa: E402
from motion import Motion  # noqa: E402

CLOSE = 1e-10  # tolerance for the references, which have a tolerance of 1e-12


def run(text, until, intervals=20):
    times = np.linspace(0, until, intervals + 1)
    return times, Motion(text, until).run(times)


class TimeFunctions(unittest.TestCase):
    def test_derivatives(self):
        """Compare derivatives with differences, away from corners."""
        gap = 1e-4
        for text in ("2*sin(3*t) - t^2/(1 + t)", "exp(-t)*cos(_pi*t)", "sqrt(1 + t)*tanh(t)", "max(t, 0.2)^3",
                     "abs(t - 2)",
                     "0:0:1 1:0.5:-0.3 2:0:0", "0:0 2:1"):
            function = time_functions.read(text)
            for t in (0.31, 0.77, 1.3):
                jet, before, after = function(t), function(t - gap).x, function(t + gap).x
                self.assertAlmostEqual(jet.d, (after - before) / (2 * gap), delta=1e-6)
                self.assertAlmostEqual(jet.dd, (after - 2 * jet.x + before) / gap ** 2, delta=1e-5)

    def test_corners(self):
        def corners(text, until=2.0):
            return time_functions.corners(time_functions.read(text), until)
        self.assertEqual(corners("sin(t)"), [])
        self.assertEqual(corners("0:1 0.3:2 1.7:0 5:1"), [0.3, 1.7])
        np.testing.assert_allclose(corners("t < sqrt(0.1) ? 1 : 2"), [math.sqrt(0.1)], atol=1e-15)
        np.testing.assert_allclose(corners("abs(sin(3*t))"), [math.pi / 3], atol=1e-15)
        np.testing.assert_allclose(corners("min(t, 0.7) + sign(t - 1)"), [0.7, 1], atol=1e-15)
        np.testing.assert_allclose(corners("t/0.8 - rint(t/0.8)"), [0.4, 1.2], atol=1e-15)


class ClosedForms(unittest.TestCase):
    def test_jump(self):
        """Jump of an effort: I = 1, +3 until b, then -3. After b the angle is 3 b t - 1.5 b^2 - 1.5 (t - b)^2."""
        times, points = run(scenes.hinge(scenes.effort("h", "t < sqrt(0.1) ? 3 : -3"), inertia=1.0), 1.0)
        b = math.sqrt(0.1)
        angle = np.where(times < b, 1.5 * times ** 2, 1.5 * b ** 2 + 3 * b * (times - b) - 1.5 * (times - b) ** 2)
        np.testing.assert_allclose(points[:, 0], np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]), atol=CLOSE)

    def test_slide_comes_to_rest(self):
        """The velocity is v - 0.2 g t until it is zero."""
        times, points = run(scenes.cart(scenes.initial("s", 0.0, 2.5), scenes.coulomb(0.0, 0.2)), 2.0)
        stop = 2.5 / (0.2 * 9.81)
        t = np.minimum(times, stop)
        np.testing.assert_allclose(points[:, 0, 0], 2.5 * t - 0.1 * 9.81 * t ** 2, atol=CLOSE)

    def test_sticks_until_it_is_pushed_hard(self):
        """Effort 2 t, friction 1: the cart starts at 0.5 s with the acceleration 2 (t - 0.5)/m."""
        times, points = run(scenes.cart(scenes.effort("s", "2*t"), scenes.coulomb(1.0), mass=1.3), 1.5)
        np.testing.assert_allclose(points[:, 0, 0], np.maximum(times - 0.5, 0) ** 3 / 3.9, atol=CLOSE)

    def test_restitution_is_that_of_the_scene_at_any_speed(self):
        """Without other forces, each impact at a stop multiplies the speed by the restitution."""
        for speed in (0.1, 2.0, 20.0):
            for restitution in (0.05, 0.1, 0.2, 0.3, 0.8):
                times, points = run(scenes.cart(scenes.initial("s", 0.0, speed), scenes.limit(-9.0, 0.5, restitution)),
                                    0.5 / speed + 0.1, 200)
                x = points[:, 0, 0]
                self.assertAlmostEqual((x[-1] - x[-2]) / (times[-1] - times[-2]) / speed, -restitution, delta=1e-8)

    def test_damping_ratio_of_the_notes(self):
        self.assertAlmostEqual(restitution_of(0.497239), 0.3, delta=1e-6)

    def test_screw(self):
        """Equation of motion: (I + m p^2) u'' = effort - m g p."""
        times, points = run(scenes.screw(scenes.effort("u", "1.5")), 1.0)
        u = 0.5 * times ** 2 * (1.5 - 1.2 * 9.81 * 0.05) / (0.02 + 1.2 * 0.05 ** 2)
        np.testing.assert_allclose(points[:, 0], np.column_stack([0.1 * np.cos(u), 0.1 * np.sin(u), 0.05 * u]),
                                   atol=CLOSE)

    def test_elastic_gear(self):
        """A constant effort acts on the rotor: mean motion plus a vibration of the gear with ω² = k (1/I + 1/J)."""
        drive = '<drive joint="h" gear="60" rotor_inertia="3e-5" stiffness="2000"/>'
        times, points = run(scenes.hinge(scenes.effort("h", "2"), rest=drive), 1.0)
        inertia, rotor, k = 0.35, 3600 * 3e-5, 2000.0
        frequency = math.sqrt(k * (1 / inertia + 1 / rotor))
        twist = 2 / rotor / frequency ** 2 * (1 - np.cos(frequency * times))
        angle = (2 * times ** 2 / 2 - rotor * twist) / (inertia + rotor)
        np.testing.assert_allclose(points[:, 0, 1], np.sin(angle), atol=CLOSE)

    def test_play_is_crossed_freely(self):
        """At first the rotor moves alone, by half of the play."""
        drive = '<drive joint="h" gear="60" rotor_inertia="3e-5" stiffness="2000" damping="1" backlash="0.1"/>'
        times, points = run(scenes.hinge(scenes.effort("h", "2"), rest=drive), 0.1, 1000)
        touch = math.sqrt(2 * 0.05 * 3600 * 3e-5 / 2)
        moved = np.abs(points[:, 0, 1]) > 1e-12
        self.assertFalse(np.any(moved[times <= touch]))
        self.assertTrue(np.all(moved[times > touch + 1e-3]))

    def test_sampled_servo(self):
        """A double integrator under efforts that are held between samples: an exact recursion."""
        servo = '<servo joint="h" mode="position" kp="30" kd="3" set_point="0.5" sample_time="0.02" delay="0.007"/>'
        times, points = run(scenes.hinge("", rest=servo, inertia=0.35), 2.0, 100)
        q, v, last, held, found = 0.0, 0.0, 0.0, 0.0, [0.0]
        for _ in range(100):
            output = 30 * (0.5 - q) - 3 * (q - last) / 0.02
            last = q
            for effort, h in ((held, 0.007), (output, 0.013)):
                q, v = q + h * v + 0.5 * h * h * effort / 0.35, v + h * effort / 0.35
            held = output
            found.append(q)
        np.testing.assert_allclose(points[:, 0, 1], np.sin(found), atol=CLOSE)

    def test_kink_of_a_motion_is_a_blow(self):
        """The cart suddenly moves with speed v. The pendulum, which hangs at rest, gets the rate -m l v/(I + m l^2)."""
        text = scenes.carried_pendulum(scenes.motion("s", "0.3*max(0, t - 0.25)")).replace("-9.81", "-0.0")
        times, points = run(text, 0.5, 10)
        angle = -0.8 * 0.4 * 0.3 / (0.03 + 0.8 * 0.16) * np.maximum(times - 0.25, 0)
        cart = 0.3 * np.maximum(times - 0.25, 0)
        # Without gravity the rate is constant, and so is the speed of the cart. The angle counts about z from -y.
        np.testing.assert_allclose(points[:, 0, 0], cart + 0.8 * np.sin(angle), atol=CLOSE)


class Contacts(unittest.TestCase):
    def test_restitution_at_any_speed(self):
        """Without weight, a hit at any speed, with any mass and stiffness, gives back its part of the speed."""
        for speed, mass, stiffness, restitution in ((0.1, 1.0, 1e4, 0.5), (3.0, 0.2, 1e4, 0.2), (20.0, 5.0, 1e5, 0.9)):
            text = scenes.scene(scenes.ground() + scenes.ball("b", 0.1, mass) + scenes.free("b", 0.0, 0.1 + 0.1 * speed)
                                + scenes.contact("b", "floor", restitution, stiffness),
                                scenes.thrown("b", 0.0, -speed) + scenes.probe("b"), 0.0)
            times, points = run(text, 0.5, 200)
            y = points[:, 0, 1]
            self.assertAlmostEqual((y[-1] - y[-2]) / (times[-1] - times[-2]) / speed, restitution, delta=1e-8)

    def test_elastic_balls_swap_momentum(self):
        """Masses 1 and 3 at 1 and -2 m/s on one line, elastic: -3.5 and -0.5 m/s."""
        text = scenes.scene(scenes.ball("a", 0.1, 1.0) + scenes.free("a", 0.0, 0.0) + scenes.ball("b", 0.1, 3.0)
                            + scenes.free("b", 0.5, 0.0) + scenes.contact("a", "b", 1.0, 1e5),
                            scenes.thrown("a", 1.0) + scenes.thrown("b", -2.0) + scenes.probe("a") + scenes.probe("b"),
                            0.0)
        times, points = run(text, 0.3, 100)
        speeds = (points[-1, :, 0] - points[-2, :, 0]) / (times[-1] - times[-2])
        np.testing.assert_allclose(speeds, [-3.5, -0.5], atol=1e-8)

    def test_rests_where_the_weight_is_carried(self):
        """k x(p) x'(p) = m g for the hardened penetration x, and nothing moves sideways."""
        text = scenes.scene(scenes.ground() + scenes.ball("b", 0.1, 1.0) + scenes.free("b", 0.0, 0.101)
                            + scenes.contact("b", "floor", 0.1, 1e4), scenes.probe("b"))
        _, points = run(text, 1.5, 10)
        p, depth = 0.1 - points[-1, 0, 1], 0.01
        room = 1 - (p / depth) ** 2
        self.assertAlmostEqual(1e4 * p / room ** 2 * (1 + 3 * (p / depth) ** 2) / room ** 3, 9.81, delta=1e-6)
        self.assertEqual(points[-1, 0, 0], 0.0)


class OtherEquations(unittest.TestCase):
    def test_double_pendulum(self):
        """Compare with Lagrange's equations in absolute angles, measured from -y."""
        times, points = run(scenes.double_pendulum(scenes.initial("h", 0.9) + scenes.initial("k", 0.3)), 1.0)
        m, l, c, i = (1.0, 0.7), 0.6, (0.3, 0.25), (0.04, 0.02)

        def derivative(_t, y):
            a, b, u, w = y
            mass = np.array([[i[0] + m[0] * c[0] ** 2 + m[1] * l ** 2, m[1] * l * c[1] * math.cos(a - b)],
                             [m[1] * l * c[1] * math.cos(a - b), i[1] + m[1] * c[1] ** 2]])
            force = [-m[1] * l * c[1] * w * w * math.sin(a - b) - 9.81 * (m[0] * c[0] + m[1] * l) * math.sin(a),
                     m[1] * l * c[1] * u * u * math.sin(a - b) - 9.81 * m[1] * c[1] * math.sin(b)]
            return [u, w, *np.linalg.solve(mass, force)]

        a, b, _, _ = solve_ivp(derivative, (0, 1), [0.9, 1.2, 0, 0], method="Radau", t_eval=times, rtol=1e-10,
                               atol=1e-12).y
        np.testing.assert_allclose(points[:, 0, 0], 0.6 * np.sin(a), atol=1e-7)
        np.testing.assert_allclose(points[:, 1, 1], -0.6 * np.cos(a) - 0.5 * np.cos(b), atol=1e-7)

    def test_crank_by_its_one_coordinate(self):
        """Compare with m(a) a'' + m'(a) a'^2/2 = effort - dV/da. The derivative m' is computed by a complex step."""
        times, points = run(scenes.crank(scenes.effort("a", "2")), 1.0)

        def rod(a):
            return -cmath.asin(0.4 * cmath.sin(a))

        def inertia(a):
            rate = -0.4 * cmath.cos(a) / cmath.cos(rod(a))
            x = -0.2 * cmath.sin(a) - 0.25 * rate * cmath.sin(rod(a))
            y = 0.2 * cmath.cos(a) + 0.25 * rate * cmath.cos(rod(a))
            slide = -0.2 * cmath.sin(a) - 0.5 * rate * cmath.sin(rod(a))
            return 0.01 + 0.01 + 0.8 * (x * x + y * y) + 0.02 * rate ** 2 + 1.5 * slide ** 2

        def potential(a):
            return 9.81 * (0.1 * cmath.sin(a) + 0.8 * (0.2 * cmath.sin(a) + 0.25 * cmath.sin(rod(a))))

        def derivative(_t, y):
            a, rate, gap = y[0], y[1], 1e-30j
            return [rate, (2 - potential(a + gap).imag / 1e-30 - 0.5 * inertia(a + gap).imag / 1e-30 * rate ** 2)
                    / inertia(a).real]

        a = solve_ivp(derivative, (0, 1), [0.7, 0], method="Radau", t_eval=times, rtol=1e-10, atol=1e-12).y[0]
        slide = [0.2 * math.cos(x) + 0.5 * math.cos(rod(x).real) for x in a]
        np.testing.assert_allclose(points[:, 0, 0], slide, atol=1e-7)


class Program(unittest.TestCase):
    def script(self, *arguments):
        return subprocess.run([sys.executable, PACKAGE, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              check=False, universal_newlines=True)

    def test_there_are_enough_scenes(self):
        """Each scene has its own name. At least 60 scenes have corners and an outside reference, 40 have contact."""
        found = scenes.all_scenes()
        self.assertEqual(len({(scene.group, scene.name) for scene in found}), len(found))
        self.assertGreaterEqual(sum(scene.is_cornered and scene.is_rigid for scene in found), 60)
        self.assertGreaterEqual(sum(scene.group == "contacts" for scene in found), 40)

    def test_writes_what_is_chosen(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.script("--output", folder, "--only", "jump at sqrt")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(sorted(os.listdir(folder)), ["forces_jump_at_sqrt_0.1_.csv",
                                                          "forces_jump_at_sqrt_0.1_.urdf",
                                                          "index.csv"])

    def test_refuses_what_it_does_not_know(self):
        text = scenes.hinge("")
        for old, new in (("<simulation>", '<sensor name="s"/><simulation>'),
                         ('<simulation>', '<drive joint="h" efficiency="0.8"/><simulation>'),
                         ('axis xyz="0 0 1"/>', 'axis xyz="0 0 1"/><friction law="coulomb" coefficient="0.1"/>')):
            with self.assertRaises(Refused):
                Motion(text.replace(old, new), 1.0)

    def test_hits_keep_accuracies(self):
        """A fast part of `flexarm bench accuracy`: scenes of hits, in which each accuracy must be kept."""
        if len(PROGRAM) == 0:
            self.skipTest("no program")
        wanted = ("ball 0", "ball 3", "ball on a slope 1", "pendulum on a wall 0", "two balls 0")
        chosen = [scene for scene in scenes.all_scenes()
                  if scene.group == "contacts" and scene.name.split(",")[0] in wanted]
        self.assertEqual(len(chosen), len(wanted))
        for scene in chosen:
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "scene.urdf")
                with open(path, "w", encoding="utf-8") as file:
                    file.write(scene.text)
                done = self.script("--judge", path, "--until", repr(scene.until), "--accuracy", "1e-3", "1e-4",
                                   "--program", PROGRAM[0])
            ratios = re.findall(r"true error \S+, (\S+) times the requested one; accuracy \S+ requested", done.stdout)
            self.assertEqual(len(ratios), 2, f"{scene.name}: {done.stdout} {done.stderr}")
            for ratio in ratios:
                self.assertLessEqual(float(ratio), 1.0, f"{scene.name}: {done.stdout}")

    def test_judges_a_scene(self):
        if len(PROGRAM) == 0:
            self.skipTest("no program")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.urdf")
            with open(path, "w", encoding="utf-8") as file:
                file.write(scenes.pendulum(scenes.initial("h", 1.0)))
            done = self.script("--judge", path, "--until", "1", "--accuracy", "1e-3", "--program", PROGRAM[0])
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, r"--accuracy 0.001: true error \d\.\d+e-\d+, \S+ times the requested one")


PROGRAM = []

if __name__ == "__main__":
    PROGRAM += sys.argv[1:2]
    unittest.main(argv=sys.argv[:1])
