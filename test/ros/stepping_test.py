#!/usr/bin/python3
"""Tests that every step is published once with even stamps, and that in lock step only commands make steps, with
reproducible bits."""

import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from flexarm.msg import JointForceCommand
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, force_command, wait_until
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

STEP = 1000000  # ns, of the demo scene


class Log:
    """All messages of a topic."""

    def __init__(self, topic, message_type):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, message_type, self.messages.append, tcp_nodelay=True, buff_size=2**22)
        wait_until(lambda: self.subscriber.get_num_connections() > 0, "the publisher of " + topic)


class Paced(unittest.TestCase):
    def test_a_message_of_each_step(self):
        arm = SimulatedArm("/paced")
        arm.pause()
        log = Log("/paced/joint_states", JointState)
        wait_until(lambda: log.messages, "the state while it is paused")
        before = arm.status()
        del log.messages[:]
        arm.resume()
        time.sleep(3)
        arm.pause()
        after = arm.status()
        made, dropped = after.steps - before.steps, after.overruns - before.overruns
        self.assertGreater(made, 1000)
        wait_until(lambda: len(log.messages) >= made, "a message of each step")
        self.assertEqual(len(log.messages), made)
        # Delays of steps or messages do not change stamps. Steps that are dropped on an overloaded machine leave gaps.
        stamps = [message.header.stamp.to_nsec() for message in log.messages]
        gaps = [later - earlier for earlier, later in zip(stamps, stamps[1:])]
        self.assertEqual({gap % STEP for gap in gaps}, {0})
        self.assertLessEqual(sum(gap // STEP - 1 for gap in gaps), dropped)
        self.assertEqual(after.missed, 0)
        self.assertLess(abs((log.messages[-1].header.stamp - after.header.stamp).to_sec()), 1e-6)

        for statistics, count in ((after.step_time, made), (after.lateness, made)):
            self.assertEqual(statistics.count, count)
            self.assertLessEqual(statistics.median, statistics.p99)
            self.assertLessEqual(statistics.p99, statistics.p999)
            self.assertLessEqual(statistics.p999, statistics.max)
        self.assertGreater(after.step_time.median, 0)


    def test_stamps_keep_the_pace(self):
        log = Log("/slow/joint_states", JointState)
        wait_until(lambda: len(log.messages) > 100, "a hundred messages")
        stamps = [message.header.stamp.to_nsec() for message in log.messages]
        # Steps of 1 ms at a quarter of the clock's speed. A message is sent every so many steps that stamps have a rate
        # of at most 100 Hz.
        self.assertEqual({(later - earlier) % (4 * STEP) for earlier, later in zip(stamps, stamps[1:])}, {0})
        self.assertLess(abs(log.messages[-1].header.stamp.to_sec() - time.time()), 2)

    def test_diagnostics_tell_of_times(self):
        values = {}

        def receive(message):
            for status in message.status:
                if "paced" in status.name:
                    values.update((value.key, value.value) for value in status.values)

        rospy.Subscriber("/diagnostics", DiagnosticArray, receive)
        for key in ("Wall time of a step [s]", "Lateness of its beginning [s]"):
            wait_until(lambda key=key: "99.9 %: " in values.get(key, ""), key)


class LockStep(unittest.TestCase):
    def states_of_run(self, arm, force, pause):
        """Return the states after each of several commanded steps, with these pauses between them [s]."""
        arm.reset()
        log = Log("/lock_step/joint_states", JointState)
        wait_until(lambda: log.messages, "the state that waits for a command")
        states = []
        for n in range(40):
            count = len(log.messages)
            force.send(force_command(["left_shoulder", "right_shoulder"], [0.1 * n, -0.2]))
            wait_until(lambda count=count: len(log.messages) > count, "the step")
            states.append((log.messages[-1].position, log.messages[-1].velocity, log.messages[-1].effort))
            time.sleep(pause if n % 10 == 0 else 0)
        log.subscriber.unregister()
        return states

    def test_the_same_commands_give_the_same_bits(self):
        arm = SimulatedArm("/lock_step")
        force = CommandTopic("/lock_step/joint_force_command", JointForceCommand)
        before = arm.status().steps
        time.sleep(0.3)
        self.assertEqual(arm.status().steps, before, "nobody has commanded a step")
        first = self.states_of_run(arm, force, 0)
        self.assertEqual(self.states_of_run(arm, force, 0.1), first)
        self.assertEqual([state[2][0] for state in first], [0.1 * n for n in range(40)])
        force.send(force_command(["no_such_joint"], [1.0]))
        time.sleep(0.2)
        arm.pause()
        self.assertEqual(arm.status().steps, before + 80, "a command that is refused makes no step")

    def test_a_trajectory_makes_one_step_and_goes_on_in_those_that_follow(self):
        SimulatedArm("/lock_step_servos")
        trajectory = CommandTopic("/lock_step_servos/joint_trajectory", JointTrajectory)
        force = CommandTopic("/lock_step_servos/joint_force_command", JointForceCommand)
        log = Log("/lock_step_servos/joint_states", JointState)
        wait_until(lambda: log.messages, "the state that waits for a command")

        def lift():
            states = log.messages[-1]
            return states.position[states.name.index("lift")]

        def steps_of(send, count):
            before = len(log.messages)
            send()
            wait_until(lambda: len(log.messages) >= before + count, "the step")
            time.sleep(0.2)
            self.assertEqual(len(log.messages), before + count)

        self.assertEqual(lift(), 0)
        way = JointTrajectory(joint_names=["lift"], points=[
            JointTrajectoryPoint(positions=[0.1], time_from_start=rospy.Duration.from_sec(0.02))])
        steps_of(lambda: trajectory.send(way), 1)
        self.assertGreater(lift(), 0)
        so_far = lift()
        steps_of(lambda: force.send(force_command(["loose"], [0.0])), 1)
        self.assertGreater(lift(), so_far)
        steps_of(lambda: trajectory.send(JointTrajectory(joint_names=["nose"], points=way.points)), 0)


if __name__ == "__main__":
    rospy.init_node("stepping_test")
    rostest.rosrun("flexarm", "stepping", __name__)
