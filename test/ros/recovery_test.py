#!/usr/bin/python3
"""Tests that a step that takes too much wall time is given up with a reason, and that the simulation can continue."""

import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from flexarm.msg import JointForceCommand, SimulatorStatus
from simulated_arm import CommandTopic, SimulatedArm, force_command, wait_until


class Recovery(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()
        cls.status = None
        cls.recoveries = ""
        rospy.Subscriber("/flexarm/status", SimulatorStatus, cls.receive_status, queue_size=10)
        rospy.Subscriber("/diagnostics", DiagnosticArray, cls.receive_diagnostics, queue_size=10)
        cls.force = CommandTopic("joint_force_command", JointForceCommand)

    @classmethod
    def receive_status(cls, message):
        cls.status = message

    @classmethod
    def receive_diagnostics(cls, message):
        for status in message.status:
            for value in status.values:
                if value.key == "Recoveries":
                    cls.recoveries = value.value

    def step_until(self, success):
        """Make single steps until one succeeds or fails, as `success` says."""
        answers = []

        def ended():
            answers.append(self.arm.step(1))
            return answers[-1].success == success

        wait_until(ended, "a step to succeed" if success else "a step to fail")
        return answers[-1]

    def test_is_bounded_by_the_clock_on_the_wall(self):
        self.force.send(force_command(["left_shoulder"], [1e6]))
        answer = self.step_until(False)
        self.assertIn("the step exceeds its limit of wall time", answer.message)
        self.assertIn("recovery_wall_time", answer.message)
        wait_until(lambda: self.status is not None and self.status.failed, "the status of the failure")
        self.assertEqual(self.status.message, answer.message)
        self.assertTrue(self.status.paused)
        self.assertGreater(self.status.halvings, 0)
        self.assertGreater(self.status.deepest_halving, 0)
        wait_until(lambda: "halvings (down to 1/" in self.recoveries, "the recoveries among the diagnostics")
        self.assertEqual(rospy.get_param("/flexarm/recovery_wall_time"), 1e-9)

        # The simulation continues from the last good sub-step, however often a step is given up.
        further = [self.arm.step(1).time for _ in range(20)]
        self.assertEqual(further, sorted(further))
        self.assertGreater(further[-1], answer.time)
        self.arm.reset()
        self.force.send(force_command(["left_shoulder"], [0.0]))
        self.step_until(True)
        wait_until(lambda: not self.status.failed, "the status of success")


if __name__ == "__main__":
    rospy.init_node("recovery_test")
    rostest.rosrun("flexarm", "recovery", Recovery)
