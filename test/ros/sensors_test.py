#!/usr/bin/python3
"""Tests the topics of sensors: each sample is sent once, at the sensor's rate, as a message of the usual type."""

import unittest

import rospy
import rostest
from flexarm.msg import StrainStamped
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import Imu
from simulated_arm import SimulatedArm, wait_until

TOPICS = {
    "force_torque": WrenchStamped,
    "unit": Imu,
    "eye": PoseStamped,
    "odometer": TwistStamped,
    "gauge": StrainStamped,
}
STEPS = 2000  # of 1 ms: the arm is at rest by then
AT_ONCE = 50  # steps: not more than a publisher's queue holds
SAMPLES = {"force_torque": STEPS // 10, "unit": STEPS, "eye": STEPS, "odometer": STEPS, "gauge": STEPS}


class Sensors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()  # paused from the start, so no message is on its way
        cls.received = {name: [] for name in TOPICS}
        subscribers = [
            rospy.Subscriber("sensors/" + name, message_type, cls.received[name].append, queue_size=10000)
            for name, message_type in TOPICS.items()
        ]
        wait_until(lambda: all(s.get_num_connections() > 0 for s in subscribers), "the node's topics")
        wait_until(lambda: all(cls.received.values()), "what is sent to who comes while paused")
        for messages in cls.received.values():
            messages.clear()
        for done in range(AT_ONCE, STEPS + 1, AT_ONCE):
            cls.arm.step(AT_ONCE)
            # Each topic has its own connection, which may lag behind the others.
            wait_until(lambda: all(len(cls.received[name]) >= count * done // STEPS for name, count in SAMPLES.items()),
                       "samples of each sensor")

    def test_each_sample_is_sent_once(self):
        self.assertEqual({name: len(messages) for name, messages in self.received.items()}, SAMPLES)
        stamps = [message.header.stamp.to_nsec() for message in self.received["force_torque"]]
        self.assertEqual({after - before for before, after in zip(stamps, stamps[1:])}, {10000000})

    def test_they_measure_the_arm_at_rest(self):
        wrench, unit = self.received["force_torque"][-1], self.received["unit"][-1]
        eye, gauge = self.received["eye"][-1], self.received["gauge"][-1]
        force, acceleration = wrench.wrench.force, unit.linear_acceleration
        self.assertAlmostEqual((force.x**2 + force.y**2 + force.z**2) ** 0.5, 2 * 9.81, delta=0.01)
        self.assertAlmostEqual((acceleration.x**2 + acceleration.z**2) ** 0.5, 9.81, delta=0.01)
        self.assertLess(eye.pose.position.z, 0)  # it hangs down
        self.assertGreater(gauge.strain, 1e-5)  # the upper side is stretched
        self.assertEqual(wrench.header.frame_id, "hand")
        twist = self.received["odometer"][-1].twist
        self.assertLess(max(abs(value) for v in (twist.linear, twist.angular) for value in (v.x, v.y, v.z)), 1e-3)
        self.assertEqual(self.received["odometer"][-1].header.frame_id, "base")
        self.assertEqual(eye.header.frame_id, "base")
        self.assertEqual(gauge.header.frame_id, "boom")


if __name__ == "__main__":
    rospy.init_node("sensors_test")
    rostest.rosrun("flexarm", "sensors", Sensors)
