#!/usr/bin/python3
"""Tests the example in which an arm takes a block from a table to a shelf: where the block ends, and what held it."""

import math
import subprocess
import unittest

import rospy
import rostest
from flexarm.msg import ContactArray
from geometry_msgs.msg import PoseStamped
from simulated_arm import SimulatedArm, wait_until

WEIGHT = 0.5 * 9.81  # N, of the block
HEIGHT = 0.08  # m, of the block
START = (0.5, -0.3, 0.24)  # m, middle of the block
SHELF = (0.5, 0.3, 0.34)
FINGERS = {"left_finger", "right_finger"}
# The most by which a contact gives way: a tenth of the smallest half width, which is that of the fingers [m].
PENETRATION = 0.1 * 0.005


def place_of(pose):
    return pose.position.x, pose.position.y, pose.position.z


def tilt_of(pose):
    """The angle between the vertical and the axis of a block that stood upright [rad]."""
    q = pose.orientation
    return 2 * math.asin(min(1.0, math.hypot(q.x, q.y)))


class Picking(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()
        cls.tool, cls.block, cls.contacts = {}, {}, {}  # by stamps [ns]
        subscribers = [
            rospy.Subscriber("sensors/tool", PoseStamped, cls.receive(cls.tool, lambda message: message.pose)),
            rospy.Subscriber("sensors/block", PoseStamped, cls.receive(cls.block, lambda message: message.pose)),
            rospy.Subscriber("flexarm/contacts", ContactArray, cls.receive(cls.contacts, lambda m: m.contacts)),
        ]
        wait_until(lambda: all(s.get_num_connections() > 0 for s in subscribers), "the node's topics")

    @staticmethod
    def receive(messages, content):
        return lambda message: messages.update({message.header.stamp.to_nsec(): content(message)})

    def setUp(self):
        self.arm.reset()
        for messages in (self.tool, self.block, self.contacts):
            messages.clear()
        wait_until(lambda: self.block and math.dist(self.now(), START) < 0.001, "the reset")

    def now(self):
        return place_of(self.block[max(self.block)])

    def pick(self, *arguments):
        return subprocess.run(["rosrun", "flexarm", "pick.py", *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, timeout=800, check=False)

    def assert_picked(self, to, *arguments):
        """Check a run, and return what was received while nothing but the fingers touched the block: stamps, sorted."""
        done = self.pick(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout)
        held = [stamp for stamp in sorted(self.contacts) if stamp in self.block and stamp in self.tool
                and {c.first if c.second == "block" else c.second for c in self.contacts[stamp]
                     if "block" in (c.first, c.second)} == FINGERS]
        self.assertGreater(len(held), 100, done.stdout)
        # The hand lets go when the block stands within 0.5 mm of its place. Then it falls flat about an edge of its
        # foot, and fingers that open at different instants take it along by as much as they were pressed into it.
        tilt = max(tilt_of(self.block[stamp]) for stamp in held[-10:])
        x, y, z = self.now()
        self.assertLess(math.dist((x, y), to[:2]), 0.0005 + tilt * HEIGHT / 2 + PENETRATION, done.stdout)
        # It has sunk by its weight over the stiffness of the contact, m (pi / 10 h)^2 with steps of h = 1 ms.
        sunk = 9.81 * (10 * 0.001 / math.pi)**2
        self.assertAlmostEqual(z, to[2] - sunk, delta=1e-5, msg=done.stdout)
        self.assertLess(tilt_of(self.block[max(self.block)]), 1e-4)
        return held

    def test_friction_carries_the_block_to_the_shelf(self):
        held = self.assert_picked(SHELF)
        # Lifted by 12 cm from the shelf's height at least, not pushed
        self.assertGreater(max(self.block[stamp].position.z for stamp in held), SHELF[2] + 0.1)
        # From the table to the shelf, at rest on both: the mean of all vertical forces is the weight. The block's
        # momentum changes by less than 0.1 m/s times its mass.
        seconds = (held[-1] - held[0]) * 1e-9
        forces = [sum(c.force.z if c.first == "block" else -c.force.z for c in self.contacts[stamp]) for stamp in held]
        self.assertAlmostEqual(sum(forces) / len(forces), WEIGHT, delta=0.01 * WEIGHT + 0.5 * 0.1 / seconds)
        # The fingers' faces stay vertical as long as the arm bends in its plane: all of it is friction.
        for stamp in held:
            for contact in self.contacts[stamp]:
                self.assertLess(abs(contact.normal.z), 0.02)
        # It does not slip by more than contacts give way.
        for way in zip(*([b - a for a, b in zip(place_of(self.tool[s]), place_of(self.block[s]))] for s in held)):
            self.assertLess(max(way) - min(way), 2 * PENETRATION)

    def test_it_finds_the_block_where_it_is(self):
        self.assert_picked(SHELF)
        back = (0.42, -0.38, START[2])
        self.assert_picked(back, "--to", *map(str, back))

    def test_a_place_out_of_reach_is_told_before_anything_moves(self):
        done = self.pick("--to", "1.5", "0", "0.3")
        self.assertEqual(done.returncode, 1)
        self.assertIn("pick.py: the arm does not reach 1.500 0.000 0.300", done.stdout)
        self.assertLess(math.dist(self.now(), START), 0.001)


if __name__ == "__main__":
    rospy.init_node("picking_test")
    rostest.rosrun("flexarm", "picking", __name__)
