#!/usr/bin/python3
"""Bags written here, replayed: `replay_test.py PROGRAM`. In them a joint stays at zero: what differs is its motion."""

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

STEP = 0.001  # s
BEGIN = 1000.0  # s, of the first stamp
# A body on a rail, with a servo that is critically damped at 1000/s: it rests 20 ms after its way.
SCENE = """<robot name="cart"> <link name="base"/>
  <joint name="rail" type="prismatic"> <parent link="base"/> <child link="cart"/> <axis xyz="1 0 0"/>
    <limit lower="-10" upper="10" effort="0" velocity="0"/> </joint>
  <link name="cart"> <inertial> <mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/> </inertial> </link>
  <servo joint="rail" mode="position" kp="1e6" kd="2e3"/>
  <simulation> <integrator step="0.001"/> <gravity xyz="0 0 0"/> </simulation>
</robot>"""
# By which the cart overshoots where it has to stand at once: less than its speed, of at most 15 m/s, over 1000/s.
OVERSHOOT = 0.015  # m


def way(start, seconds, position):
    """To there at a constant rate, from the stamp `start` on; 0: at once."""
    message = JointTrajectory(joint_names=["rail"])
    message.header.stamp = genpy.Time.from_sec(start)
    message.points = [JointTrajectoryPoint(positions=[position], time_from_start=genpy.Duration.from_sec(seconds))]
    return message


# The same without its servo: it goes where it is pushed.
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
        """States so far apart by their stamps [s]; each trajectory comes half a period before the state of its number.
        In lock step another command makes each of the other steps."""
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
                state = JointState(name=["rail"], position=[0], velocity=[0])
                state.header.stamp = stamp
                bag.write("/joint_states", state, stamp)

    def largest(self, *options):
        """How far the cart has moved [m]."""
        command = [PROGRAM, "replay", self.bag, self.scene] + [str(option) for option in options]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                              check=False)
        self.assertIn(done.returncode, (0, 1), done.stdout)
        self.assertNotIn("refused", done.stdout)
        return float(re.search(r"^rail +([^ ]+)", done.stdout, re.MULTILINE).group(1))

    # At a quarter of the clock's speed 0.4 s of stamps are 0.1 s of the simulation: of the 200 steps half are left.
    def test_stamps_ahead_go_at_the_pace_of_the_run(self):
        self.write(200, STEP / 0.25, (1, way(BEGIN + 0.4, 0.05, 0.3)))
        self.assertAlmostEqual(self.largest("--real-time-factor", 0.25), 0.3, delta=OVERSHOOT)
        self.write(90, STEP / 0.25, (1, way(BEGIN + 0.4, 0.05, 0.3)))
        self.assertEqual(self.largest("--real-time-factor", 0.25), 0)

    def test_stamps_ahead_of_who_is_the_clock_are_simulated_times(self):
        for steps, moved in ((200, 0.3), (90, 0)):
            self.write(steps, STEP, (1, way(BEGIN + 0.1, 0.05, 0.3)), has_clock=True)
            self.assertAlmostEqual(self.largest("--real-time-factor", 0.25), moved, delta=OVERSHOOT)

    # 40 states of 5 ms each come before the trajectory, which begins 0.05 s, 50 steps, after its own.
    def test_stamps_ahead_count_from_the_state_in_lock_step(self):
        for steps, moved in ((150, 0.3), (85, 0)):
            self.write(steps, 0.005, (41, way(BEGIN + 40 * 0.005 + 0.05, 0.02, 0.3)), lock_step=True)
            self.assertAlmostEqual(self.largest("--lock-step"), moved, delta=OVERSHOOT)

    # At 1 m/s it stands after half as many metres as it has seconds to stop.
    def test_stops_take_as_long_as_those_of_the_run(self):
        self.write(400, STEP, (1, way(0, 1, 1)), (101, JointTrajectory()), has_clock=True)
        at_once, slowly = self.largest(), self.largest("--stop-duration", 0.2)
        self.assertAlmostEqual(at_once, 0.1, delta=OVERSHOOT)
        self.assertAlmostEqual(slowly, 0.2, delta=OVERSHOOT)

    # ---- when commands act

    def write_push(self, late=0, delay=0.0, scene=FREE):
        """A run of the cart without servo, pushed by 2 N from step 100 on. The bag has the command so many
        steps late, and states near it with a delay [s]."""
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(scene)
        with rosbag.Bag(self.bag, "w") as bag:
            for n in range(0, 401, 10):
                if n == 110:  # before this state, between those of two steps
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
            self.assertIn("acts up to 1 step earlier or later than by its time", output)
            self.assertIn("agrees within what the times of commands explain", output)
            # Pushed for one of 300 steps more or less: 2 N over 1 kg, for 1 ms, 0.3 s ago.
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
        self.assertIn("acts up to 4 steps earlier or 1 step later than by its time", output)

    def test_another_scene_is_not_explained(self):
        self.write_push(scene=FREE.replace('mass value="1"', 'mass value="1.05"'))
        status, output = self.replayed()
        self.assertEqual(status, 1, output)
        self.assertIn("DIFFERS: at t = 0.4 s joint 'rail' is off by", output)


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
