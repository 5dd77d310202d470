#!/usr/bin/python3
"""Pause, step, resume and reset of a simulation that is the clock of everybody; time never runs backwards."""

import time
import unittest

import rospy
import rostest
from flexarm.msg import SimulatorStatus
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from simulated_arm import SimulatedArm, wait_until
from tf2_msgs.msg import TFMessage


class StampLog:
    """Every stamp of every topic since the test began, and the last messages."""

    def __init__(self):
        self.last = {}
        self.stamps = {"/clock": [], "/joint_states": [], "/tf": [], "/flexarm/status": []}
        read = {
            "/clock": (Clock, lambda message: message.clock),
            "/joint_states": (JointState, lambda message: message.header.stamp),
            "/tf": (TFMessage, lambda message: message.transforms[0].header.stamp),
            "/flexarm/status": (SimulatorStatus, lambda message: message.header.stamp),
        }
        for topic, (message_type, stamp_of) in read.items():
            rospy.Subscriber(topic, message_type, self.make_callback(topic, stamp_of), queue_size=1000)

    def make_callback(self, topic, stamp_of):
        def receive(message):
            self.stamps[topic].append(stamp_of(message).to_nsec())
            self.last[topic] = message

        return receive

    def count(self):
        return sum(len(stamps) for stamps in self.stamps.values())


class Services(unittest.TestCase):
    """Messages arrive when they arrive: hence the waiting for what a service brought about."""

    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()
        cls.log = StampLog()
        wait_until(lambda: all(cls.log.stamps.values()), "every topic")
        cls.step_size = cls.log.last["/flexarm/status"].step

    def setUp(self):
        self.arm.resume()

    def tearDown(self):
        for topic, stamps in self.log.stamps.items():
            self.assertGreater(stamps[0], 0, topic)
            for earlier, later in zip(stamps, stamps[1:]):
                self.assertLess(earlier, later, topic)

    def status(self):
        return self.log.last["/flexarm/status"]

    def pause_and_wait(self):
        self.arm.pause()
        time.sleep(0.2)  # what was sent before arrives

    def test_runs_at_the_pace_of_the_wall_clock(self):
        first, first_wall = self.status(), time.monotonic()
        time.sleep(1.0)
        last, wall_time = self.status(), time.monotonic() - first_wall
        made = (last.steps + last.overruns - first.steps - first.overruns) * self.step_size
        # Each status is up to a period (0.1 s) old, and the catch-up may hold another 0.1 s back.
        self.assertLess(abs(made - wall_time), 0.5)

    def test_pause_stops_time_and_messages(self):
        self.pause_and_wait()
        status, count = self.status(), self.log.count()
        self.assertTrue(status.paused)
        time.sleep(0.5)
        self.assertEqual(self.log.count(), count)
        self.assertEqual(self.status().time, status.time)

    def test_resume_goes_on_where_it_paused(self):
        self.pause_and_wait()
        paused_at = self.status().time
        time.sleep(0.5)
        self.arm.resume()
        wait_until(lambda: self.status().time > paused_at, "the simulation to go on")
        wait_until(lambda: not self.status().paused, "the resumption")

    def test_step_makes_as_many_steps_as_asked_for(self):
        self.pause_and_wait()
        before = self.status()
        answer = self.arm.step(37)
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.status().steps > before.steps, "the status after the last step")
        after = self.status()
        self.assertEqual(after.steps, before.steps + 37)
        self.assertAlmostEqual(after.time - before.time, 37 * self.step_size, delta=1e-9)
        self.assertTrue(after.paused)
        self.assertTrue(self.arm.step(0).success)
        self.assertEqual(self.status().steps, before.steps + 37)

    def test_step_is_refused_while_running_and_beyond_reason(self):
        answer = self.arm.step(1)
        self.assertFalse(answer.success)
        self.assertIn("pause", answer.message)
        self.pause_and_wait()
        self.assertFalse(self.arm.step(2**32 - 1).success)

    def test_reset_sets_the_state_back_and_the_clock_goes_on(self):
        wait_until(lambda: self.status().time > 0.2, "some time to pass")
        self.pause_and_wait()
        before = self.status()
        self.arm.reset()
        wait_until(lambda: self.status().time == 0, "the status after the reset")
        after = self.status()
        self.assertTrue(after.paused)
        self.assertGreater(after.header.stamp, before.header.stamp)
        wait_until(lambda: self.log.last["/joint_states"].header.stamp > before.header.stamp, "the state after the reset")

    def test_reset_while_running(self):
        wait_until(lambda: self.status().time > 0.5, "some time to pass")
        self.arm.reset()
        wait_until(lambda: self.status().time < 0.4, "the state after the reset")
        self.assertFalse(self.status().paused)

    def test_repeated_requests_do_no_harm(self):
        for _ in range(3):
            self.arm.pause()
        wait_until(lambda: self.status().paused, "the pause")
        for _ in range(3):
            self.arm.resume()
        wait_until(lambda: not self.status().paused, "the resumption")
        for _ in range(3):
            self.arm.reset()


if __name__ == "__main__":
    rospy.init_node("services_test")
    rostest.rosrun("flexarm", "services", __name__)
