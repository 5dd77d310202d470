#!/usr/bin/python3
"""Tests the topic ~contacts with each touching point at the rate of the other topics, the contact sensor of a link, and
the arrows."""

import unittest

import rospy
import rostest
from flexarm.msg import ContactArray
from geometry_msgs.msg import WrenchStamped
from simulated_arm import SimulatedArm, wait_until
from visualization_msgs.msg import MarkerArray

WEIGHT = 2 * 9.81  # N
STEPS = 1000  # of 1 ms: the block is at rest by then
RATE = 100  # Hz


class Contacts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()  # paused from the start, so no message is on its way
        cls.contacts, cls.scales, cls.markers = [], [], []
        subscribers = [
            rospy.Subscriber("flexarm/contacts", ContactArray, cls.contacts.append, queue_size=1000),
            rospy.Subscriber("sensors/scales", WrenchStamped, cls.scales.append, queue_size=1000),
            rospy.Subscriber("beam_markers", MarkerArray, cls.markers.append, queue_size=1000),
        ]
        wait_until(lambda: all(s.get_num_connections() > 0 for s in subscribers), "the node's topics")
        received = [cls.contacts, cls.scales, cls.markers]
        wait_until(lambda: all(received), "what is sent to who comes while paused")
        for messages in received:
            messages.clear()
        for done in range(50, STEPS + 1, 50):
            cls.arm.step(50)
            wait_until(lambda: len(cls.contacts) >= RATE * done // 1000 and len(cls.scales) >= RATE * done // 1000,
                       "contacts and samples")
        wait_until(lambda: len(cls.markers) >= 20, "markers")
        for subscriber in subscribers:
            subscriber.unregister()  # other scenes that a test loads are not part of the run

    def test_they_come_at_the_rate_of_states(self):
        stamps = [message.header.stamp.to_nsec() for message in self.contacts]
        self.assertEqual(len(set(stamps)), len(stamps))
        # Each call of a service publishes one more
        self.assertLessEqual(len(stamps), RATE * STEPS // 1000 + STEPS // 50)

    def test_each_point_is_told(self):
        message = self.contacts[-1]
        self.assertEqual(message.header.frame_id, "world")
        self.assertGreaterEqual(len(message.contacts), 4)  # corners
        for contact in message.contacts:
            self.assertEqual((contact.first, contact.second), ("block", "plate"))
            self.assertAlmostEqual(contact.normal.z, 1)
            self.assertGreater(contact.penetration, 0)
            self.assertAlmostEqual(contact.position.z, 0.12, delta=2e-3)
        self.assertAlmostEqual(sum(contact.force.z for contact in message.contacts), WEIGHT, delta=1e-3)

    def test_the_sensor_has_the_weight(self):
        message = self.scales[-1]
        self.assertEqual(message.header.frame_id, "plate")
        self.assertAlmostEqual(message.wrench.force.z, -WEIGHT, delta=1e-3)

    def test_the_topic_comes_and_goes_with_the_scene(self):
        scene = rospy.get_param("flexarm/scene")

        def is_there():
            return "/flexarm/contacts" in [name for name, _ in rospy.get_published_topics()]

        self.assertTrue(is_there())
        for other, has_contacts in (("sensing_arm", False), ("resting_block", True)):
            rospy.set_param("flexarm/scene", scene.replace("resting_block", other))
            self.assertTrue(self.arm.reload().success)
            wait_until(lambda: is_there() == has_contacts, "the topic in scene " + other)

    def test_arrows_show_them(self):
        arrows = [marker for marker in self.markers[-1].markers if marker.ns == "contacts"]
        self.assertEqual(len(arrows), 1)
        heights = [point.z for point in arrows[0].points]
        self.assertGreater(max(heights), 0.13)  # on the block, pointing upwards
        self.assertIn("contacts", [marker.text for marker in self.markers[-1].markers if marker.ns == "legend"])


if __name__ == "__main__":
    rospy.init_node("contacts_test")
    rostest.rosrun("flexarm", "contacts", Contacts)
