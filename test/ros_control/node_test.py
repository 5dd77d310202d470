#!/usr/bin/python3
"""Tests the node for ros_control: it is the ROS clock, keeps its pace, pauses, and reports invalid parameters."""

import subprocess
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty

PATIENCE = 60  # wall time [s]


class Node(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.times = []
        cls.subscriber = rospy.Subscriber("/clock", Clock, lambda message: cls.times.append(message.clock.to_sec()))
        cls.services = {name: rospy.ServiceProxy("/arm/" + name, Empty) for name in ("pause", "resume", "reset")}
        for service in cls.services.values():
            service.wait_for_service(PATIENCE)

    def passed(self, seconds):
        """Return the simulated time that passes in this wall time."""
        before = self.times[-1]
        time.sleep(seconds)
        return self.times[-1] - before

    def wait_for_clock(self):
        end = time.monotonic() + PATIENCE
        while not self.times and time.monotonic() < end:
            time.sleep(0.01)
        self.assertTrue(self.times, "/clock")

    def test_clock_and_pause(self):
        self.wait_for_clock()
        passed = self.passed(1)
        self.assertGreater(passed, 1.2, "twice the pace of the wall clock, but for what else runs here")
        self.assertLess(passed, 2.5)
        self.services["pause"]()
        time.sleep(0.2)
        self.assertEqual(self.passed(0.3), 0)
        self.services["reset"]()
        self.services["resume"]()
        self.assertGreater(self.passed(0.5), 0.3)
        self.assertEqual(self.times, sorted(set(self.times)), "time goes on, whatever is reset")

    def refusal(self, *parameters):
        """Return the message with which the node ends."""
        command = ["rosrun", "flexarm", "test_ros_control_node", "__name:=refused", *parameters]
        result = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE, encoding="utf-8", check=False
        )
        self.assertEqual(result.returncode, 1, result.stdout)
        return result.stdout

    def test_says_what_is_wrong(self):
        scene = "_scene:=" + rospy.get_param("/arm/scene")
        self.assertIn(
            "/refused/steps_per_cycle: must be a whole number >= 1, got <value><i4>0</i4></value>",
            self.refusal(scene, "_steps_per_cycle:=0"),
        )
        rospy.delete_param("/refused")
        self.assertIn(
            "/refused/real_time_factor: must be finite and >= 0", self.refusal(scene, "_real_time_factor:=-1")
        )
        rospy.delete_param("/refused")
        self.assertIn("/nowhere.urdf", self.refusal("_scene:=/nowhere.urdf"))


if __name__ == "__main__":
    rospy.init_node("node_test")
    rostest.rosrun("flexarm", "ros_control_node", Node)
