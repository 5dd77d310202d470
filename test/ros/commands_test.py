#!/usr/bin/python3
"""Tests that joint efforts reach exactly the joints that they name, and that invalid commands are refused as a
whole."""

import math
import unittest

import rospy
import rostest
from flexarm.msg import JointForceCommand
from sensor_msgs.msg import JointState
from simulated_arm import (PATIENCE, CommandTopic, SimulatedArm, force_command, release_stop, wait_for_log, wait_until,
                           warnings_of_flood)
from std_msgs.msg import Bool, Float64
from visualization_msgs.msg import MarkerArray

ROUND_OFF = 1e-12  # rad and m: the compared joints are not coupled


class Commands(unittest.TestCase):
    """The simulation is paused and steps are made by hand, so that nothing depends on timing."""

    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()
        cls.force = CommandTopic("joint_force_command", JointForceCommand)

    def setUp(self):
        self.arm.reset()

    def tearDown(self):
        self.assertFalse(self.arm.status().failed)

    def wait_for_effort(self, name, effort):
        def arrived():
            self.assertTrue(self.arm.step(1).success)
            return self.arm.joint(name).effort == effort

        wait_until(arrived, "effort %g at %s" % (effort, name))

    def assert_at_rest(self, *names):
        states = self.arm.joint_states()
        for name, position, effort in zip(states.name, states.position, states.effort):
            if name in names:
                self.assertLessEqual(abs(position), ROUND_OFF, name)
                self.assertEqual(effort, 0, name)

    # ---- good commands

    def test_moves_the_joint_it_names_and_only_it(self):
        self.force.send(force_command(["left_shoulder"], [1.0]))
        self.wait_for_effort("left_shoulder", 1.0)
        self.assertTrue(self.arm.step(100).success)
        self.assertGreater(self.arm.joint("left_shoulder").position, 1e-3)
        self.assert_at_rest("right_shoulder", "wrist/rx", "wrist/ry", "wrist/rz")

    def test_several_joints_at_once(self):
        self.force.send(force_command(["left_shoulder", "wrist/rz"], [1.0, -0.5]))
        self.wait_for_effort("left_shoulder", 1.0)
        self.assertEqual(self.arm.joint("wrist/rz").effort, -0.5)
        self.assertTrue(self.arm.step(50).success)
        self.assertLess(self.arm.joint("wrist/rz").position, 0)

    def test_joint_state_message(self):
        topic = CommandTopic("joint_command", JointState)
        topic.send(JointState(name=["right_shoulder"], effort=[0.7]))
        self.wait_for_effort("right_shoulder", 0.7)
        self.assert_at_rest("left_shoulder")

    def test_topic_of_one_joint(self):
        CommandTopic("right_shoulder/command", Float64).send(0.4)
        self.wait_for_effort("right_shoulder", 0.4)
        CommandTopic("wrist/ry/command", Float64).send(0.3)
        self.wait_for_effort("wrist/ry", 0.3)
        self.assertEqual(self.arm.joint("right_shoulder").effort, 0.4)
        self.assert_at_rest("left_shoulder")

    def test_mimicking_joint_follows(self):
        self.force.send(force_command(["right_shoulder"], [1.0]))
        self.wait_for_effort("right_shoulder", 1.0)
        self.assertTrue(self.arm.step(100).success)
        angle = self.arm.joint("right_shoulder").position
        self.assertGreater(angle, 1e-3)
        self.assertAlmostEqual(self.arm.joint("mirror").position, -angle, delta=ROUND_OFF)

    def test_effort_ends_after_its_duration(self):
        step = self.arm.status().step
        self.force.send(force_command(["left_shoulder"], [1.0], 20 * step))
        self.wait_for_effort("left_shoulder", 1.0)
        # One of the twenty steps has been made already.
        self.assertTrue(self.arm.step(18).success)
        self.assertEqual(self.arm.joint("left_shoulder").effort, 1.0)
        self.assertTrue(self.arm.step(2).success)
        self.assertEqual(self.arm.joint("left_shoulder").effort, 0.0)

    def test_reset_forgets_commands(self):
        self.force.send(force_command(["left_shoulder"], [1.0]))
        self.wait_for_effort("left_shoulder", 1.0)
        self.arm.reset()
        self.assertTrue(self.arm.step(1).success)
        self.assert_at_rest("left_shoulder")

    def test_emergency_stop_zeroes_and_refuses_until_released(self):
        stop = CommandTopic("/flexarm/emergency_stop", Bool)
        self.force.send(force_command(["left_shoulder", "right_shoulder"], [1.0, 1.0]))
        self.wait_for_effort("left_shoulder", 1.0)
        stop.send(True)
        self.wait_for_effort("left_shoulder", 0.0)
        self.assertEqual(self.arm.joint("right_shoulder").effort, 0.0)
        wait_for_log(lambda: self.force.send(force_command(["left_shoulder"], [2.0])), "the emergency stop is on")
        self.arm.step(1)
        self.assertEqual(self.arm.joint("left_shoulder").effort, 0.0)
        release_stop(stop)
        self.force.send(force_command(["left_shoulder"], [3.0]))
        self.wait_for_effort("left_shoulder", 3.0)
        self.assertEqual(self.arm.joint("right_shoulder").effort, 0.0)  # its command was forgotten

    def test_emergency_stop_holds_back_the_scenes_efforts_and_gives_them_back(self):
        stop = CommandTopic("/flexarm/emergency_stop", Bool)
        self.wait_for_effort("winch", 0.5)
        stop.send(True)
        self.wait_for_effort("winch", 0.0)
        self.arm.reset()
        self.assertTrue(self.arm.step(1).success)
        self.assertEqual(self.arm.joint("winch").effort, 0.0)
        stop.send(False)
        self.wait_for_effort("winch", 0.5)

    def test_reset_begins_the_scale_of_the_colours_anew(self):
        def largest_strain():
            markers = rospy.wait_for_message("/beam_markers", MarkerArray, PATIENCE).markers
            return max(float(marker.text.split()[0]) for marker in markers if marker.text.endswith("%"))

        self.force.send(force_command(["left_shoulder"], [1.0]))
        self.wait_for_effort("left_shoulder", 1.0)
        self.assertTrue(self.arm.step(20).success)
        self.assertGreater(largest_strain(), 0)
        self.arm.reset()
        self.assertEqual(largest_strain(), 0)

    # ---- bad commands

    def assert_refused(self, bad):
        """Messages of a topic arrive in order: when the valid command acts, the invalid one has been handled."""
        self.force.send(bad)
        self.force.send(force_command(["right_shoulder"], [0.25]))
        self.wait_for_effort("right_shoulder", 0.25)
        self.assert_at_rest("left_shoulder", "wrist/rx")
        self.assertEqual(self.arm.joint("mirror").effort, 0)

    def test_refuses_an_unknown_joint_and_all_that_comes_with_it(self):
        self.assert_refused(force_command(["left_shoulder", "nose"], [1.0, 1.0]))

    def test_refuses_a_joint_without_coordinates_of_its_own(self):
        self.assert_refused(force_command(["left_shoulder", "wrist"], [1.0, 1.0]))

    def test_refuses_sizes_that_differ(self):
        self.assert_refused(force_command(["left_shoulder", "wrist/rx"], [1.0]))
        self.assert_refused(force_command(["left_shoulder"], [1.0, 1.0]))
        self.assert_refused(force_command([], [1.0]))

    def test_refuses_numbers_that_are_not_finite(self):
        for bad in (math.nan, math.inf, -math.inf):
            self.assert_refused(force_command(["left_shoulder", "wrist/rx"], [1.0, bad]))

    def test_refuses_prescribed_and_mimicking_joints(self):
        self.assert_refused(force_command(["left_shoulder", "shuttle"], [1.0, 1.0]))
        self.assert_refused(force_command(["left_shoulder", "mirror"], [1.0, 1.0]))

    def test_refuses_a_joint_named_twice(self):
        self.assert_refused(force_command(["left_shoulder", "left_shoulder"], [1.0, 2.0]))

    def test_refuses_a_negative_duration(self):
        self.assert_refused(force_command(["left_shoulder"], [1.0], -1.0))

    def test_warns_without_flooding(self):
        warnings = warnings_of_flood(lambda: self.force.send(force_command(["nose"], [1.0])))
        self.assertEqual(len(warnings), 1)
        self.assertIn("there is no joint coordinate 'nose'; the scene has ", warnings[0])


if __name__ == "__main__":
    rospy.init_node("commands_test")
    rostest.rosrun("flexarm", "commands", __name__)
