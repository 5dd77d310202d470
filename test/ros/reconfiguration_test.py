#!/usr/bin/python3
"""Tests that parameters change while the simulation runs, by Debian's client, and that impossible changes are refused
as a whole."""

import time
import unittest

import dynamic_reconfigure.client
import rospy
import rostest
from flexarm.msg import JointForceCommand, SimulatorStatus
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, force_command, wait_until

PATIENCE = 60.0  # s


class Reconfiguration(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.namespace = rospy.get_namespace().rstrip("/")
        cls.arm = SimulatedArm(cls.namespace)
        cls.client = dynamic_reconfigure.client.Client("flexarm", timeout=PATIENCE)
        cls.start = dict(cls.client.get_configuration(timeout=PATIENCE))
        cls.start.pop("groups")
        cls.warnings = []
        cls.status = cls.states = None
        rospy.Subscriber("/rosout", Log, cls.receive_log, queue_size=100)
        rospy.Subscriber("flexarm/status", SimulatorStatus, cls.receive_status)
        rospy.Subscriber("joint_states", JointState, cls.receive_states)

    @classmethod
    def receive_log(cls, log):
        if log.level >= Log.WARN and log.name == cls.namespace + "/flexarm":
            cls.warnings.append(log.msg)

    @classmethod
    def receive_status(cls, message):
        cls.status = message

    @classmethod
    def receive_states(cls, message):
        cls.states = message

    def setUp(self):
        self.client.update_configuration(self.start)
        self.arm.reset()
        self.arm.resume()
        wait_until(lambda: self.status and self.states and not self.status.paused, "the run")
        del self.warnings[:]

    def position(self, name):
        return self.states.position[self.states.name.index(name)]

    def paused_state(self):
        self.arm.pause()
        return self.latest()

    def latest(self):
        time.sleep(0.3)  # until messages that were sent before have arrived
        return self.states

    def test_there_is_what_the_scene_has(self):
        self.assertEqual(set(self.start), {
            "scheme", "step", "tolerance", "real_time_factor", "publish_rate", "marker_rate", "status_rate",
            "gravity_x", "gravity_y", "gravity_z", "lift/kp", "lift/kd", "lift/ki", "turn/kp", "turn/kd", "turn/ki",
            "spindle/kp", "spindle/ki"})
        self.assertEqual(self.start["lift/kp"], 400)
        self.assertEqual(self.start["scheme"], "auto")
        descriptions = self.client.get_parameter_descriptions(timeout=PATIENCE)
        self.assertEqual({one["name"] for one in descriptions}, set(self.start))
        self.assertIn("newmark", next(one for one in descriptions if one["name"] == "scheme")["edit_method"])

    def test_scheme_and_step_change_without_a_jump(self):
        CommandTopic("joint_force_command", JointForceCommand).send(force_command(["loose"], [0.05]))
        wait_until(lambda: self.position("loose") > 0.1, "the motion")
        before = self.paused_state()
        answer = self.client.update_configuration({"scheme": "newmark", "step": 0.0005})
        self.assertEqual((answer["scheme"], answer["step"]), ("newmark", 0.0005))
        after = self.latest()
        for one, other in zip(before.position + before.velocity, after.position + after.velocity):
            self.assertAlmostEqual(one, other, delta=1e-9)
        self.assertGreater(after.header.stamp, before.header.stamp)
        status = self.status
        self.assertEqual((status.scheme, status.step), ("newmark", 0.0005))
        self.assertEqual(rospy.get_param("flexarm/step"), 0.0005)
        # The commanded effort still acts: the rate grows by effort over inertia.
        self.assertTrue(self.arm.step(200).success)
        later = self.latest()
        index = later.name.index("loose")
        self.assertAlmostEqual(later.velocity[index] - after.velocity[index], 200 * 0.0005 * 0.05 / 0.01, delta=1e-6)
        self.assertAlmostEqual(self.status.time - status.time, 0.1, delta=1e-9)
        self.assertEqual(self.warnings, [])

    def test_gravity_acts(self):
        self.client.update_configuration({"gravity_z": -4.0})
        # The servo acts as a spring of 400 N/m on 1 kg.
        wait_until(lambda: abs(self.position("lift") + 4.0 / 400) < 1e-6, "the lift to sink")

    def test_gains_act(self):
        self.client.update_configuration({"gravity_z": -4.0, "lift/kp": 200.0})
        wait_until(lambda: abs(self.position("lift") + 4.0 / 200) < 1e-6, "the lift to sink")
        self.client.update_configuration({"lift/kp": 800.0})
        wait_until(lambda: abs(self.position("lift") + 4.0 / 800) < 1e-6, "the lift to rise")

    def test_rates_and_pace(self):
        self.client.update_configuration({"publish_rate": 20.0, "real_time_factor": 0.5})
        stamps = []
        subscriber = rospy.Subscriber("joint_states", JointState, lambda m: stamps.append(m.header.stamp.to_sec()))
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: len(stamps) > 10, "messages")
        # The rate holds for stamps. A step takes 2 ms of wall time and 1 ms of simulated time.
        for earlier, later in zip(stamps[1:], stamps[2:]):
            self.assertGreaterEqual(later - earlier, 0.05 - 0.002)
        self.client.update_configuration({"real_time_factor": 0.0})
        before = self.status.steps
        wait_until(lambda: self.status.steps > before + 5000, "steps as fast as possible")

    def test_what_cannot_be_is_refused_whole(self):
        for asked, told in (({"step": -1.0}, "'step' must be > 0 and <= 1000000000, got -1"),
                            ({"lift/kp": 10.0, "step": float("nan")}, "'step' must be"),
                            ({"lift/kd": -5.0}, "'lift/kd' must be finite and >= 0"),
                            ({"tolerance": 3.0}, "'tolerance' must be"),
                            ({"scheme": "nonsense", "publish_rate": 7.0}, "'scheme' must be one of auto"),
                            ({"marker_rate": 0.0}, "'marker_rate' must be"),
                            ({"gravity_x": float("inf")}, "'gravity_x' must be finite")):
            del self.warnings[:]
            answer = self.client.update_configuration(asked)
            answer.pop("groups", None)
            self.assertEqual(answer, self.start, asked)
            wait_until(lambda: self.warnings, "the warning")
            rospy.sleep(0.1)
            self.assertEqual(len(self.warnings), 1, self.warnings)
            self.assertIn(told, self.warnings[0])
        self.assertFalse(self.status.paused)


if __name__ == "__main__":
    rospy.init_node("reconfiguration_test")
    rostest.rosrun("flexarm", "reconfiguration", Reconfiguration)
