#!/usr/bin/python3
"""Tests PD controllers that close their loop on joint_states: one in roscpp at 1 kHz, one in rospy at 100 Hz.

They hold the guide's second arm, the demo, and a six-axis robot. The robot waits for its commands (lock step), because
its gears vibrate if the loop is late by some milliseconds, as on a busy machine."""

import math
import subprocess
import time
import unittest

import numpy
import rospy
import rostest
from flexarm.msg import JointForceCommand
from sensor_msgs.msg import JointState
from simulated_arm import PATIENCE, CommandTopic, SimulatedArm, force_command, wait_until

DURATION = 10.0  # s, of each loop


class Listener:
    """Receives joint_states: errors of positions and velocities relative to set points, which are `offset` from the
    first positions."""

    def __init__(self, namespace, offset):
        self.offset = offset
        self.set_points = None
        self.states = []  # stamp [s], errors of position [rad], velocities [rad/s]
        self.subscriber = rospy.Subscriber(
            namespace + "/joint_states", JointState, self.receive, queue_size=10, tcp_nodelay=True
        )

    def receive(self, state):
        if self.set_points is None:
            self.set_points = [position + self.offset for position in state.position]
        errors = [goal - position for goal, position in zip(self.set_points, state.position)]
        self.states.append((state.header.stamp.to_sec(), errors, state.velocity))

    def end(self):
        self.subscriber.unregister()


class PythonController(Listener):
    """Commands the effort stiffness (set point - position) - damping velocity on every joint, every 10 ms of stamps."""

    def __init__(self, namespace, stiffness, damping, offset):
        self.stiffness, self.damping = stiffness, damping
        self.commands = CommandTopic(namespace + "/joint_force_command", JointForceCommand)
        self.next_stamp = 0
        super().__init__(namespace, offset)
        wait_until(lambda: self.states, "joint states of " + namespace)

    def receive(self, state):
        super().receive(state)
        stamp, errors, velocities = self.states[-1]
        if stamp > self.next_stamp:
            self.next_stamp = stamp + 0.0095
            efforts = [k * e - d * v for k, d, e, v in zip(self.stiffness, self.damping, errors, velocities)]
            self.commands.send(force_command(list(state.name), efforts))


class RoscppController(Listener):
    """The same controller at every message, as a node: pd_controller.cpp."""

    def __init__(self, namespace, stiffness, damping, offset):
        rospy.set_param(namespace + "/pd_controller", dict(stiffness=stiffness, damping=damping, offset=offset))
        self.process = subprocess.Popen(
            ["rosrun", "flexarm", "test_pd_controller", "__ns:=" + namespace, "__name:=pd_controller"]
        )
        rospy.wait_for_message(namespace + "/joint_force_command", JointForceCommand, PATIENCE)
        super().__init__(namespace, offset)
        wait_until(lambda: self.states, "joint states of " + namespace)

    def end(self):
        super().end()
        self.process.terminate()
        self.process.wait()


class Control(unittest.TestCase):
    def hold(self, controller, namespace, stiffness, damping, offset, inertia):
        """Hold the same set point on every joint. `inertia`: the smallest inertia that a joint moves [kg m^2]."""
        arm = SimulatedArm(namespace)
        arm.pause()
        arm.reset()
        joints = len(arm.joint_states().name)
        controller = controller(namespace, [stiffness] * joints, [damping] * joints, offset)
        arm.resume()
        time.sleep(DURATION)
        arm.pause()
        controller.end()
        self.assertFalse(arm.status().failed)
        # On a busy machine, messages that are late by more than ten are dropped.
        states = list(controller.states)
        self.assertGreater(len(states), 100 * DURATION)
        # Springs and dampers to the set points only take energy out. So no swing is wider than the first one, and none
        # is faster than that of a mass on the springs.
        widest = max(math.sqrt(sum(e * e for e in errors)) for _, errors, _ in states)
        self.assertLess(widest, 1.05 * offset * math.sqrt(joints))
        fastest = max(abs(v) for stamp, _, velocities in states for v in velocities if stamp > states[-1][0] - 1)
        self.assertLess(fastest, offset * math.sqrt(joints * stiffness / inertia))

    def test_guide_at_1000_hz(self):
        self.hold(RoscppController, "/guide", 20.0, 2.0, 0.4, inertia=4)

    def test_guide_at_100_hz(self):
        self.hold(PythonController, "/guide", 20.0, 2.0, 0.4, inertia=4)

    def test_demo_at_1000_hz(self):
        self.hold(RoscppController, "/demo", 2000.0, 500.0, 0.03, inertia=100)

    def test_demo_at_100_hz(self):
        self.hold(PythonController, "/demo", 2000.0, 300.0, 0.03, inertia=100)

    def wait_for_steps(self, arm, steps):
        end = arm.status().steps + steps
        wait_until(lambda: arm.status().steps >= end, "step %d" % end, patience=60)

    # The robot's servos are in mode effort and hold it up. The controller adds springs and dampers. It measures joints,
    # but its efforts act on motors behind elastic gears. In a vibration of a gear, link and rotor move in opposite
    # directions, so the controller feeds energy in. The gear's own damping takes out more, if the controller's damping
    # is less than the gear's times (J + j)^2 / (J j), with the inertias J of the link and j of the rotor.
    def test_robot_at_1000_hz(self):
        stiffness = numpy.array([2000.0, 2000.0, 800.0, 60.0, 60.0, 20.0])
        damping = [60.0, 60.0, 24.0, 1.5, 1.5, 0.5]
        force, levers = 20, numpy.array([1.3, 1.3, 1.3, 0.2, 0.2, 0.2])  # N, m
        arm = SimulatedArm("/robot")
        arm.reset()
        names = arm.joint_states().name
        self.assertTrue(arm.switch_mode(names=names, modes=["effort"] * 6).success)
        controller = RoscppController("/robot", stiffness.tolist(), damping, 0.0)
        arm.resume()
        self.wait_for_steps(arm, 1000)
        self.assertTrue(arm.apply_wrench("flange", force=(0, 0, force), duration=1.0).success)
        self.wait_for_steps(arm, 1000 * DURATION)
        arm.pause()
        controller.end()
        self.assertFalse(arm.status().failed)
        errors = numpy.array([errors for _, errors, _ in controller.states])
        # The springs take up at most the work of a sudden force: sum of k e^2 / 2 <= force * sum of lever e. Gravity
        # changes with the pose; this effect is a twentieth.
        energies = errors**2 @ stiffness
        self.assertLess(math.sqrt(energies.max()), 1.05 * 2 * force * math.sqrt((levers**2 / stiffness).sum()))
        self.assertGreater(numpy.abs(errors).max(), 1e-3)
        self.assertLess(numpy.abs(errors[-1]).max(), 1e-3)


if __name__ == "__main__":
    rospy.init_node("control_test")
    rostest.rosrun("flexarm", "control", __name__)
