#!/usr/bin/python3
"""A PD controller that closes its loop on joint_states holds the guide's second arm and the demo."""

import math
import time
import unittest

import rospy
import rostest
from flexarm.msg import JointForceCommand
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, force_command, wait_until

DURATION = 10.0  # s, of each loop


class Controller:
    """Efforts stiffness (set point - position) - damping velocity on every joint, at every `every`-th message."""

    def __init__(self, namespace, stiffness, damping, offset, every):
        self.stiffness, self.damping, self.offset, self.every = stiffness, damping, offset, every
        self.commands = CommandTopic(namespace + "/joint_force_command", JointForceCommand)
        self.set_points = None
        self.received = 0
        self.states = []  # stamp [s], errors of position [rad], velocities [rad/s]
        self.subscriber = rospy.Subscriber(
            namespace + "/joint_states", JointState, self.receive, queue_size=10, tcp_nodelay=True
        )

    def receive(self, state):
        if self.set_points is None:
            self.set_points = [position + self.offset for position in state.position]
        errors = [goal - position for goal, position in zip(self.set_points, state.position)]
        self.states.append((state.header.stamp.to_sec(), errors, state.velocity))
        if self.received % self.every == 0:
            efforts = [self.stiffness * e - self.damping * v for e, v in zip(errors, state.velocity)]
            self.commands.send(force_command(list(state.name), efforts))
        self.received += 1


class Control(unittest.TestCase):
    def hold(self, namespace, stiffness, damping, offset, inertia, every):
        """`inertia`: the least that a joint moves [kg m^2]."""
        arm = SimulatedArm(namespace)
        arm.pause()
        arm.reset()
        controller = Controller(namespace, stiffness, damping, offset, every)
        wait_until(lambda: controller.states, "joint states of " + namespace)
        arm.resume()
        time.sleep(DURATION)
        arm.pause()
        controller.subscriber.unregister()
        self.assertFalse(arm.status().failed)
        states = list(controller.states)
        # Most of the messages arrive, also on a busy machine.
        self.assertGreater(len(states), 0.5 * 1000 * DURATION)
        # Spring and damper to the set points only take energy out: no swing is wider than the first one, none is faster
        # than that of a mass on the springs.
        joints = len(states[0][1])
        widest = max(math.sqrt(sum(e * e for e in errors)) for _, errors, _ in states)
        self.assertLess(widest, 1.05 * offset * math.sqrt(joints))
        fastest = max(abs(v) for stamp, _, velocities in states for v in velocities if stamp > states[-1][0] - 1)
        self.assertLess(fastest, offset * math.sqrt(joints * stiffness / inertia))

    def test_guide_at_1000_hz(self):
        self.hold("/guide", 20, 2, 0.4, inertia=4, every=1)

    def test_guide_at_100_hz(self):
        self.hold("/guide", 20, 2, 0.4, inertia=4, every=10)

    def test_demo_at_1000_hz(self):
        self.hold("/demo", 2000, 500, 0.03, inertia=100, every=1)

    def test_demo_at_100_hz(self):
        self.hold("/demo", 2000, 300, 0.03, inertia=100, every=10)


if __name__ == "__main__":
    rospy.init_node("control_test")
    rostest.rosrun("flexarm", "control", __name__)
