#!/usr/bin/python3
"""Tests that a simulation that is the ROS clock sets the clock back to zero on request, and only then."""

import math
import time
import unittest

import rospy
import rostest
import tf2_ros
from flexarm.msg import JointForceCommand, SimulatorStatus
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, force_command, wait_until
from tf2_msgs.msg import TFMessage


class Stamps:
    """The stamps of all messages of some topics [ns]."""

    def __init__(self):
        self.of = {}
        self.last_status = None
        for topic, message_type, stamp_of in (
                ("/clock", Clock, lambda message: message.clock),
                ("joint_states", JointState, lambda message: message.header.stamp),
                ("/tf", TFMessage, lambda message: message.transforms[0].header.stamp),
                ("/follower/joint_states", JointState, lambda message: message.header.stamp),
                ("flexarm/status", SimulatorStatus, lambda message: message.header.stamp)):
            self.of[topic] = []
            rospy.Subscriber(topic, message_type, self.receiver(topic, stamp_of), queue_size=1000)

    def receiver(self, topic, stamp_of):
        def receive(message):
            if topic == "/tf" and message.transforms[0].header.frame_id.startswith("follower"):
                return
            self.of[topic].append(stamp_of(message).to_nsec())
            if isinstance(message, SimulatorStatus):
                self.last_status = message

        return receive

    def jumps(self, topic):
        """Return the stamps of a topic to which time went back."""
        stamps = list(self.of[topic])
        return [later for earlier, later in zip(stamps, stamps[1:]) if later <= earlier]


class ClockReset(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()
        cls.stamps = Stamps()
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)

    def wait_until_it_is(self, seconds):
        wait_until(lambda: rospy.get_time() > seconds, f"{seconds} s of simulated time")

    def latest_transform(self):
        """Return the stamp of the latest transform [s]; infinite if there is none."""
        if not self.buffer.can_transform("base", "right_hand", rospy.Time()):
            return math.inf
        return self.buffer.lookup_transform("base", "right_hand", rospy.Time()).header.stamp.to_sec()

    def assert_begins_anew(self):
        for topic, stamps in self.stamps.of.items():
            wait_until(lambda topic=topic: self.stamps.jumps(topic), topic + " to jump back")
            (first,) = self.stamps.jumps(topic)
            self.assertGreater(first, 0, topic)
            self.assertLess(first, 0.5e9, topic)
            del stamps[:]

    def test_running(self):
        self.arm.resume()
        self.wait_until_it_is(1.0)
        answer = self.arm.reset_with_clock()
        self.assertTrue(answer.success, answer.message)
        self.assert_begins_anew()
        wait_until(lambda: rospy.get_time() < 1.0, "ROS time to go back")
        self.assertFalse(self.stamps.last_status.paused)
        # Listeners of frames discard the frames with later stamps.
        wait_until(lambda: self.latest_transform() < 0.9, "the frames of now only")
        # Commands and their durations count from the new time.
        CommandTopic("joint_force_command", JointForceCommand).send(force_command(["left_shoulder"], [2.0], 0.2))
        wait_until(lambda: self.arm.joint("left_shoulder").effort == 2.0, "the effort")
        wait_until(lambda: self.arm.joint("left_shoulder").effort == 0.0, "its end")

    def test_paused(self):
        self.arm.resume()
        self.wait_until_it_is(0.7)
        self.arm.pause()
        time.sleep(0.2)
        self.assertTrue(self.arm.reset_with_clock().success)
        self.assert_begins_anew()
        wait_until(lambda: self.stamps.last_status.time == 0, "the status of the beginning")
        self.assertTrue(self.stamps.last_status.paused)
        self.assertTrue(self.arm.step(20).success)
        wait_until(lambda: self.stamps.last_status.time > 0, "the status after the steps")
        self.assertLess(self.stamps.last_status.header.stamp.to_sec(), 0.1)
        for topic in self.stamps.of:
            self.assertEqual(self.stamps.jumps(topic), [], topic)
        self.arm.resume()

    def test_a_reset_as_usual_lets_time_go_on(self):
        self.arm.reset()
        time.sleep(0.3)
        for topic in self.stamps.of:
            self.assertEqual(self.stamps.jumps(topic), [], topic)

    def test_who_is_not_the_clock_refuses(self):
        other = SimulatedArm("/follower")
        answer = other.reset_with_clock()
        self.assertFalse(answer.success)
        self.assertIn("publish_clock", answer.message)


if __name__ == "__main__":
    rospy.init_node("clock_reset_test")
    rostest.rosrun("flexarm", "clock_reset", ClockReset)
