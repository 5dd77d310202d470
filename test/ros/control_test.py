#!/usr/bin/python3
"""A PD controller that closes its loop on joint_states holds the guide's second arm, the demo, and a six-axis robot."""

import math
import time
import unittest

import numpy
import rospy
import rostest
from flexarm.msg import JointForceCommand
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, force_command, wait_until

DURATION = 10.0  # s, of each loop


class Controller:
    """Efforts stiffness (set point - position) - damping velocity on every joint, at every `every`-th message;
    `stiffness`, `damping`: for all joints, or one for each."""

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
            gains = zip(numpy.broadcast_to(self.stiffness, len(errors)), numpy.broadcast_to(self.damping, len(errors)))
            efforts = [k * e - d * v for (k, d), e, v in zip(gains, errors, state.velocity)]
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


    # Its servos, switched to mode effort, give what holds the robot up; the controller is springs and dampers beside
    # that. It sees joints, its efforts act on motors behind elastic gears: what it takes out of a vibration of the gear
    # is less than the gear's own damping as long as it damps less than that, times (J + j)^2 / (J j), with J, j of link
    # and rotor.
    def test_robot_at_1000_hz(self):
        stiffness = numpy.array([2000, 2000, 800, 60, 60, 20])
        damping = [60, 60, 24, 1.5, 1.5, 0.5]
        force, levers = 20, numpy.array([1.3, 1.3, 1.3, 0.2, 0.2, 0.2])  # N, m
        arm = SimulatedArm("/robot")
        arm.reset()
        names = arm.joint_states().name
        self.assertTrue(arm.switch_mode(names=names, modes=["effort"] * 6).success)
        controller = Controller("/robot", stiffness, damping, 0, 1)
        wait_until(lambda: controller.states, "joint states of the robot")
        arm.resume()
        time.sleep(1)
        self.assertTrue(arm.apply_wrench("flange", force=(0, 0, force), duration=1.0).success)
        time.sleep(DURATION)
        arm.pause()
        controller.subscriber.unregister()
        self.assertFalse(arm.status().failed)
        self.assertGreater(len(controller.states), 0.5 * 1000 * DURATION)
        errors = numpy.array([errors for _, errors, _ in controller.states])
        # The springs take up at most what a sudden force does on its way: sum of k e^2 / 2 <= force * sum of lever e;
        # gravity, which changes with the pose, is a twentieth of them.
        energies = errors**2 @ stiffness
        self.assertLess(math.sqrt(energies.max()), 1.05 * 2 * force * math.sqrt((levers**2 / stiffness).sum()))
        self.assertGreater(numpy.abs(errors).max(), 1e-3)
        self.assertLess(numpy.abs(errors[-1]).max(), 1e-3)


if __name__ == "__main__":
    rospy.init_node("control_test")
    rostest.rosrun("flexarm", "control", __name__)
