#!/usr/bin/python3
"""Test `flexarm replay` with bags that this test writes: `replay_test.py PROGRAM`.

In most of these bags a joint stays at zero, so that the difference that `replay` reports is the motion of the replayed
joint."""

import os
import re
import subprocess
import sys
import tempfile
import unittest

import genpy
import rosbag
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "pictures"))

from page_reader import read_page  # noqa: E402

STEP = 0.001  # s
BEGIN = 1000.0  # s, the first stamp
# A body on a rail with a servo, which is critically damped at 1000/s: the body rests 20 ms after the end of a motion.
SCENE = """<robot name="cart"> <link name="base"/>
  <joint name="rail" type="prismatic"> <parent link="base"/> <child link="cart"/> <axis xyz="1 0 0"/>
    <limit lower="-10" upper="10" effort="0" velocity="0"/> </joint>
  <link name="cart"> <inertial> <mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>
  <servo joint="rail" mode="position" kp="1e6" kd="2e3"/>
  <simulation> <integrator step="0.001"/> <gravity xyz="0 0 0"/> </simulation>
</robot>"""
# The cart overshoots when it must stop at once: by less than its speed (at most 15 m/s) over 1000/s.
OVERSHOOT = 0.015  # m


def way(start, seconds, position):
    """Return a trajectory that leads to `position` in `seconds` at a constant rate, from the stamp `start` on. If
    `start` is 0, it starts at once."""
    message = JointTrajectory(joint_names=["rail"])
    message.header.stamp = genpy.Time.from_sec(start)
    message.points = [JointTrajectoryPoint(positions=[position], time_from_start=genpy.Duration.from_sec(seconds))]
    return message


# The same scene without its servo: the cart moves where it is pushed.
FREE = re.sub("<servo.*/>", "", SCENE)


class Replay(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.scene, self.bag = self.path("cart.urdf"), self.path("run.bag")
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(SCENE)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, steps, period, *trajectories, has_clock=False, lock_step=False):
        """Write a bag of states, `period` [s] apart.

        `trajectories` are pairs (number, message): each message comes half a period before the state of that number.
        With `lock_step`, all other steps are made by another command."""
        with rosbag.Bag(self.bag, "w") as bag:
            for n in range(steps + 1):
                stamp = genpy.Time.from_sec(BEGIN + n * period)
                before = genpy.Time.from_sec(BEGIN + (n - 0.5) * period)
                coming = [message for number, message in trajectories if number == n]
                for message in coming:
                    bag.write("/joint_trajectory", message, before)
                if lock_step and n > 0 and not coming:
                    bag.write("/joint_command", JointState(name=["rail"], effort=[0]), before)
                if has_clock:
                    bag.write("/clock", Clock(stamp), stamp)
                state = JointState(name=["rail"], position=[0], velocity=[0], effort=[n])
                state.header.stamp = stamp
                bag.write("/joint_states", state, stamp)

    def largest(self, *options):
        """Run `flexarm replay` and return how far the cart has moved [m]."""
        command = [PROGRAM, "replay", self.bag, self.scene] + [str(option) for option in options]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                              check=False)
        self.assertIn(done.returncode, (0, 1), done.stdout)
        self.assertNotIn("refused", done.stdout)
        return float(re.search(r"^rail +([^ ]+)", done.stdout, re.MULTILINE).group(1))

    # At a quarter of the clock's speed, 0.4 s of stamps are 0.1 s of simulated time. 200 steps are twice as many as
    # needed; 90 steps end before the motion begins.
    def test_stamps_ahead_go_at_the_pace_of_the_run(self):
        self.write(200, STEP / 0.25, (1, way(BEGIN + 0.4, 0.05, 0.3)))
        self.assertAlmostEqual(self.largest("--real-time-factor", 0.25), 0.3, delta=OVERSHOOT)
        self.write(90, STEP / 0.25, (1, way(BEGIN + 0.4, 0.05, 0.3)))
        self.assertEqual(self.largest("--real-time-factor", 0.25), 0)

    def test_stamps_ahead_of_who_is_the_clock_are_simulated_times(self):
        for steps, moved in ((200, 0.3), (90, 0)):
            self.write(steps, STEP, (1, way(BEGIN + 0.1, 0.05, 0.3)), has_clock=True)
            self.assertAlmostEqual(self.largest("--real-time-factor", 0.25), moved, delta=OVERSHOOT)

    # 40 states, 5 ms apart, come before the trajectory. It begins 0.05 s, which is 50 steps, after its stamp.
    def test_stamps_ahead_count_from_the_state_in_lock_step(self):
        for steps, moved in ((150, 0.3), (85, 0)):
            self.write(steps, 0.005, (41, way(BEGIN + 40 * 0.005 + 0.05, 0.02, 0.3)), lock_step=True)
            self.assertAlmostEqual(self.largest("--lock-step"), moved, delta=OVERSHOOT)

    # The recorded cart stays at zero, the replayed one moves.
    def test_a_page_shows_the_recorded_run_beside_its_replay(self):
        self.write(200, STEP, (1, way(BEGIN + 0.1, 0.05, 0.3)), has_clock=True)
        page = self.path("both.html")
        self.largest("--show", "--page", page)
        recorded, replayed = read_page(page)
        self.assertEqual([run.picture["title"] for run in (recorded, replayed)], ["recorded run", "replay"])
        self.assertLess(abs(recorded.link("cart")[:, 0]).max(), 1e-9)
        self.assertAlmostEqual(replayed.link("cart")[-1, 0], 0.3, delta=OVERSHOOT)
        self.assertTrue((recorded.times == replayed.times).all())
        efforts = recorded.arrows["effort"][:, 0, 3:6]
        self.assertLess(abs(efforts[:, 0] - recorded.times / STEP).max(), 0.01)
        self.assertEqual(abs(efforts[:, 1:]).max(), 0)

    # From 1 m/s it stops in half the distance that it would travel at this speed in the stopping time.
    def test_stops_take_as_long_as_those_of_the_run(self):
        self.write(400, STEP, (1, way(0, 1, 1)), (101, JointTrajectory()), has_clock=True)
        at_once, slowly = self.largest(), self.largest("--stop-duration", 0.2)
        self.assertAlmostEqual(at_once, 0.1, delta=OVERSHOOT)
        self.assertAlmostEqual(slowly, 0.2, delta=OVERSHOOT)

    # ---- when commands act

    def write_push(self, late=0, delay=0.0, scene=FREE):
        """Write a bag of a run of the cart without servo, pushed by 2 N from step 100 on.

        The bag has the command `late` steps too late. The states near the command have a `delay` [s]."""
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(scene)
        with rosbag.Bag(self.bag, "w") as bag:
            for n in range(0, 401, 10):
                if n == 110:  # before this state, and between the states of two steps
                    command = JointState(name=["rail"], effort=[2.0])
                    bag.write("/joint_command", command, genpy.Time.from_sec(BEGIN + (100.5 + late) * STEP))
                pushed = max(n - 100, 0) * STEP
                state = JointState(name=["rail"], position=[pushed**2], velocity=[2 * pushed])
                state.header.stamp = genpy.Time.from_sec(BEGIN + n * STEP)
                arrival = BEGIN + n * STEP + (delay if 90 <= n <= 110 else 0)
                bag.write("/joint_states", state, genpy.Time.from_sec(arrival))

    def replayed(self, *options):
        done = subprocess.run([PROGRAM, "replay", self.bag, self.scene] + list(options), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, check=False)
        return done.returncode, done.stdout

    def test_times_that_are_right_need_no_explanation(self):
        self.write_push()
        status, output = self.replayed()
        self.assertEqual(status, 0, output)
        self.assertIn("agrees: positions differ by at most 1e-06", output)
        self.assertNotIn("explained", output)

    def test_a_step_more_or_less_is_explained_by_times(self):
        for late in (-1, 1):
            self.write_push(late)
            status, output = self.replayed()
            self.assertEqual(status, 0, output)
            self.assertIn("commands up to 1 step earlier or later than recorded", output)
            self.assertIn("agrees, apart from differences that the times of commands explain", output)
            # One of 300 steps more or less is pushed: the speed of 2 N over 1 kg for 1 ms, over 0.3 s.
            rail = re.search(r"^rail +([^ ]+) .* ([^ ]+)$", output, re.MULTILINE)
            for number in rail.groups():
                self.assertAlmostEqual(float(number), 2 * 0.001 * 0.3, delta=1e-5)

    def test_more_than_that_is_not(self):
        self.write_push(3)
        status, output = self.replayed()
        self.assertEqual(status, 1, output)
        self.assertRegex(output, r"DIFFERS: at t = 0.4 s joint 'rail' is off by 0\.0012 more than the times")
        self.assertEqual(self.replayed("--timing", "3")[0], 0)
        self.assertIn("DIFFERS: positions differ by more than", self.replayed("--timing", "0")[1])

    def test_steps_that_were_late_explain_more(self):
        self.write_push(3, delay=0.0021)
        status, output = self.replayed()
        self.assertEqual(status, 0, output)
        self.assertIn("commands up to 4 steps earlier or 1 step later than recorded", output)

    def test_another_scene_is_not_explained(self):
        self.write_push(scene=FREE.replace('mass value="1"', 'mass value="1.05"'))
        status, output = self.replayed()
        self.assertEqual(status, 1, output)
        self.assertIn("DIFFERS: at t = 0.4 s joint 'rail' is off by", output)


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
