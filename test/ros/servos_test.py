#!/usr/bin/python3
"""Tests that set points reach the servos that they name, that invalid ones are refused as a whole, and that the
emergency stop switches servos off."""

import math
import os
import tempfile
import time
import unittest

import rospy
import rostest
from flexarm.msg import JointForceCommand
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, force_command, wait_until, warnings_of_flood
from std_msgs.msg import Bool, Float64

STEP = 0.001  # s, the scene's step
TIMEOUT = 1.0  # s, ~command_timeout
# Servos are critically damped with 20/s, or of first order with 20/s. After one second exp(-20) is left, in the former
# case times 20.
SETTLED = 5e-8
SETTLED_RATE = 1e-5  # rad/s: the tolerance of Newton's method, 1e-8 rad, over a step
START = 0.25  # m, the scene's set point of the lift


class Servos(unittest.TestCase):
    """The simulation is paused and steps are made by hand, so that nothing depends on timing."""

    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()
        cls.set_points = CommandTopic("joint_set_points", JointState)
        cls.stop = CommandTopic("/flexarm/emergency_stop", Bool)

    def setUp(self):
        self.arm.reset()
        self.good_effort = 0.0

    def tearDown(self):
        self.assertFalse(self.arm.status().failed)

    def run_for(self, seconds):
        self.assertTrue(self.arm.step(round(seconds / STEP)).success)

    def wait_for_effort(self, name, condition):
        """Make steps until the effort of a joint satisfies the condition."""

        def arrived():
            self.run_for(STEP)
            return condition(self.arm.joint(name).effort)

        wait_until(arrived, "an effort of " + name)

    def wait_for_press(self, effort):
        """Wait for an effort of the effort servo, which gives its set point at once. Then all earlier messages of its
        topic have been handled."""
        self.wait_for_effort("press", lambda value: value == effort)

    # ---- good set points

    def test_the_scenes_set_point_holds_without_any(self):
        self.run_for(1.0)
        self.assertAlmostEqual(self.arm.joint("lift").position, START, delta=SETTLED)

    def test_each_servo_takes_what_its_mode_says(self):
        self.set_points.send(
            JointState(
                name=["spindle", "lift", "press"],
                position=[9.0, 0.5, 9.0],
                velocity=[3.0, 9.0, 9.0],
                effort=[9.0, 9.0, 0.5],
            )
        )
        self.wait_for_press(0.5)
        self.run_for(TIMEOUT - 0.1)
        self.assertAlmostEqual(self.arm.joint("spindle").velocity, 3.0, delta=SETTLED_RATE)
        self.run_for(0.2)
        self.assertAlmostEqual(self.arm.joint("lift").position, 0.5, delta=SETTLED)
        self.assertEqual(self.arm.joint("loose").position, 0)

    def test_arrays_that_no_servo_takes_may_be_empty(self):
        self.set_points.send(JointState(name=["lift"], position=[0.5]))
        self.set_points.send(JointState(name=["press"], effort=[0.25]))
        self.wait_for_press(0.25)
        self.run_for(1.1)
        self.assertAlmostEqual(self.arm.joint("lift").position, 0.5, delta=SETTLED)

    def test_topic_of_one_joint(self):
        CommandTopic("press/set_point", Float64).send(-0.5)
        self.wait_for_press(-0.5)
        CommandTopic("spindle/set_point", Float64).send(-1.0)
        self.wait_for_effort("spindle", lambda effort: effort < -0.1)

    def test_efforts_add_to_those_of_the_servo(self):
        force = CommandTopic("joint_force_command", JointForceCommand)
        force.send(force_command(["press"], [0.5], 10.0))
        self.wait_for_press(0.5)
        CommandTopic("press/set_point", Float64).send(0.25)
        self.wait_for_press(0.75)

    def test_after_the_timeout_positions_hold_and_the_others_are_zero(self):
        names = ["lift", "spindle", "press"]
        self.set_points.send(JointState(name=names, position=[0.5] * 3, velocity=[1] * 3, effort=[1] * 3))
        self.wait_for_press(1.0)
        self.run_for(TIMEOUT - 2 * STEP)  # one step has been made already
        self.assertEqual(self.arm.joint("press").effort, 1.0)
        self.run_for(3 * STEP)  # times are sums, whose round-off may cost one step
        self.assertEqual(self.arm.joint("press").effort, 0.0)
        self.run_for(1.5)
        self.assertAlmostEqual(self.arm.joint("spindle").velocity, 0.0, delta=SETTLED_RATE)
        self.assertAlmostEqual(self.arm.joint("lift").position, 0.5, delta=SETTLED)

    def test_reset_forgets_set_points(self):
        self.set_points.send(JointState(name=["lift", "press"], position=[0.5, 0], effort=[0, 1.0]))
        self.wait_for_press(1.0)
        self.arm.reset()
        self.run_for(1.0)
        self.assertEqual(self.arm.joint("press").effort, 0.0)
        self.assertAlmostEqual(self.arm.joint("lift").position, START, delta=SETTLED)

    def test_joint_command_takes_positions_and_velocities_to_servos(self):
        command = CommandTopic("joint_command", JointState)
        command.send(JointState(name=["lift", "spindle"], position=[0.5, 9.0], velocity=[9.0, 3.0]))
        self.wait_for_effort("spindle", lambda effort: effort != 0)
        self.run_for(0.9)
        self.assertAlmostEqual(self.arm.joint("spindle").velocity, 3.0, delta=SETTLED_RATE)
        self.run_for(0.2)
        self.assertAlmostEqual(self.arm.joint("lift").position, 0.5, delta=SETTLED)
        # The effort acts, as it does without a servo.
        command.send(JointState(name=["press"], position=[1.0], velocity=[1.0], effort=[0.5]))
        self.wait_for_press(0.5)

    # ---- modes

    def test_modes_are_switched_and_come_back(self):
        self.run_for(2.0)  # until it is at rest, because a switch holds the present velocity
        answer = self.arm.switch_mode(names=["lift", "spindle"], modes=["velocity", "effort"])
        self.assertTrue(answer.success, answer.message)
        self.run_for(0.5)
        self.assertAlmostEqual(self.arm.joint("lift").position, START, delta=SETTLED)  # no bump
        self.set_points.send(JointState(name=["lift"], velocity=[0.1]))
        self.wait_for_effort("lift", lambda effort: effort > 0)
        self.run_for(0.9)
        self.assertAlmostEqual(self.arm.joint("lift").velocity, 0.1, delta=SETTLED_RATE)
        before = self.arm.joint("lift").effort
        self.assertTrue(self.arm.switch_mode(names=["lift"], modes=["position"]).success)
        self.run_for(STEP)  # the effort changes by kp times the displacement, not by kd times 0.1 m/s
        self.assertAlmostEqual(self.arm.joint("lift").effort, before, delta=2 * 400 * 0.1 * STEP)
        self.run_for(1.5)  # longer than the timeout of the velocity
        held = self.arm.joint("lift").position
        self.assertGreater(held, START + 0.08)
        self.run_for(0.5)
        self.assertAlmostEqual(self.arm.joint("lift").position, held, delta=SETTLED)
        self.arm.reset()
        self.set_points.send(JointState(name=["lift"], position=[0.5]))  # the scene's mode applies again
        self.wait_for_effort("lift", lambda effort: effort > 50)

    def test_modes_that_are_not_there_are_refused_whole(self):
        for told, names, modes in (("no gains of mode 'velocity'", ["lift", "press"], ["velocity", "velocity"]),
                                   ("<servo joint=\"loose\"", ["lift", "loose"], ["effort", "effort"]),
                                   ("no joint coordinate", ["nose"], ["effort"]),
                                   ("'torque'", ["lift"], ["torque"]), ("2 names", ["lift", "press"], ["effort"])):
            answer = self.arm.switch_mode(names=names, modes=modes)
            self.assertFalse(answer.success)
            self.assertIn(told, answer.message)
        self.set_points.send(JointState(name=["lift"], position=[0.5]))
        self.wait_for_effort("lift", lambda effort: effort > 50)

    # ---- the emergency stop

    def test_emergency_stop_switches_servos_off_until_released(self):
        self.set_points.send(JointState(name=["lift", "press"], position=[0.75, 0], effort=[0, 1.0]))
        self.wait_for_press(1.0)
        self.assertGreater(abs(self.arm.joint("lift").effort), 1)
        self.stop.send(True)
        self.wait_for_press(0.0)
        self.assertEqual(self.arm.joint("lift").effort, 0.0)
        self.set_points.send(JointState(name=["press"], effort=[0.5]))  # is refused
        time.sleep(0.2)
        moved = self.arm.joint("lift").position
        self.run_for(0.1)
        self.assertEqual(self.arm.joint("press").effort, 0.0)
        self.assertEqual(self.arm.joint("lift").effort, 0.0)
        self.assertGreater(self.arm.joint("lift").position, moved)  # it moves on freely
        self.arm.reset()
        self.run_for(0.1)
        self.assertEqual(self.arm.joint("lift").effort, 0.0)  # a reset does not release it
        self.stop.send(False)
        self.wait_for_effort("lift", lambda effort: effort > 1)
        self.run_for(1.2)
        self.assertAlmostEqual(self.arm.joint("lift").position, START, delta=SETTLED)  # the scene's own set point again
        self.assertEqual(self.arm.joint("press").effort, 0.0)

    def test_state_saved_during_a_stop_runs_without_it(self):
        self.set_points.send(JointState(name=["press"], effort=[1.0]))
        self.wait_for_press(1.0)
        self.stop.send(True)
        self.wait_for_press(0.0)
        with tempfile.TemporaryDirectory() as folder:
            state = os.path.join(folder, "state")
            self.assertTrue(self.arm.save_state(state).success)
            self.stop.send(False)
            self.wait_for_effort("lift", lambda effort: effort != 0)
            self.assertTrue(self.arm.load_state(state).success)
        self.run_for(STEP)
        self.assertEqual(self.arm.joint("press").effort, 1.0)  # the set point that was valid when the state was saved

    # ---- bad set points

    def assert_refused(self, bad):
        """Messages of a topic arrive in order: when the valid set point acts, the invalid one has been handled."""
        self.good_effort += 0.125
        self.set_points.send(bad)
        self.set_points.send(JointState(name=["press"], effort=[self.good_effort]))
        self.wait_for_press(self.good_effort)
        self.assertEqual(self.arm.joint("spindle").effort, 0.0)

    def test_refuses_unknown_joints_and_those_without_a_servo(self):
        for name in ("nose", "loose"):
            self.assert_refused(JointState(name=["spindle", name], velocity=[1.0, 1.0]))

    def test_refuses_arrays_of_another_size(self):
        self.assert_refused(JointState(name=["spindle"], position=[1.0], effort=[1.0]))
        self.assert_refused(JointState(name=["spindle"], velocity=[1.0, 2.0]))
        self.assert_refused(JointState(name=["spindle", "lift"], velocity=[1.0], position=[0.1, 0.1]))
        self.assert_refused(JointState(name=[], velocity=[1.0]))

    def test_refuses_numbers_that_are_not_finite(self):
        for bad in (math.nan, math.inf, -math.inf):
            self.assert_refused(JointState(name=["spindle", "lift"], velocity=[1.0, 0], position=[0, bad]))

    def test_refuses_a_joint_named_twice(self):
        self.assert_refused(JointState(name=["spindle", "spindle"], velocity=[1.0, 2.0]))

    def test_warns_without_flooding(self):
        warnings = warnings_of_flood(lambda: self.set_points.send(JointState(name=["loose"], position=[1.0])))
        self.assertEqual(len(warnings), 1)
        self.assertIn("joint_set_points", warnings[0])
        self.assertIn("'loose' has no servo: write <servo ", warnings[0])

    # ---- set points beyond limits

    def test_warns_once_of_a_burst_beyond_a_limit(self):
        send = lambda: self.set_points.send(JointState(name=["lift"], position=[1.5]))
        self.assertEqual(warnings_of_flood(send, "limit"),
                         ["joint 'lift' is sent to 1.5, beyond its upper limit 1, where its stop holds it"])
        self.run_for(1.0)
        self.assertAlmostEqual(self.arm.joint("lift").position, 1.0, delta=0.01)


if __name__ == "__main__":
    rospy.init_node("servos_test")
    rostest.rosrun("flexarm", "servos", __name__)
