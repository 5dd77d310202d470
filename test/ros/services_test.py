#!/usr/bin/python3
"""Tests pause, step, resume, reset and failure of a simulation that is the ROS clock. Time never runs backwards."""

import math
import os
import tempfile
import threading
import time
import unittest

import rospkg
import rospy
import rostest
from flexarm.msg import JointForceCommand, SimulatorStatus
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from simulated_arm import PATIENCE, CommandTopic, Joint, SimulatedArm, force_command, wait_for_arrival, wait_until
from std_msgs.msg import Bool
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


class ClockedArm(unittest.TestCase):
    """Base class. Messages arrive at any time, so tests wait for the effects of services."""

    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm()
        cls.log = StampLog()
        cls.arm.reset()
        cls.arm.resume()
        wait_until(lambda: all(cls.log.stamps.values()), "every topic")
        cls.step_size = cls.log.last["/flexarm/status"].step

    def setUp(self):
        self.arm.reset()
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
        time.sleep(0.2)  # until messages that were sent before have arrived

    def states_when_paused(self):
        time.sleep(0.2)  # likewise
        return self.log.last["/joint_states"]


class Services(ClockedArm):
    def test_runs_at_the_pace_of_the_wall_clock(self):
        first, first_wall = self.status(), time.monotonic()
        time.sleep(1.0)
        last, wall_time = self.status(), time.monotonic() - first_wall
        made = (last.steps + last.overruns - first.steps - first.overruns) * self.step_size
        # Each status is up to a period (0.1 s) old, and the catch-up may contain another 0.1 s.
        self.assertLess(abs(made - wall_time), 0.5)
        # A measurement takes at least 50 ms, in which up to 100 ms of backlog may be made up.
        self.assertGreater(last.real_time_factor, 0)
        self.assertLessEqual(last.real_time_factor, (50 + 100) / 50)

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

    def test_everybody_is_served_while_many_steps_are_made(self):
        self.pause_and_wait()
        force = CommandTopic("/joint_force_command", JointForceCommand)
        stop = CommandTopic("/flexarm/emergency_stop", Bool)
        self.addCleanup(stop.send, False)
        answers = []
        caller = threading.Thread(target=lambda: answers.append(self.arm.step(1000000)))
        before = self.status()
        caller.start()
        wait_until(lambda: self.status().steps > before.steps, "the first steps")

        def effort():
            states = self.log.last["/joint_states"]
            return states.effort[states.name.index("left_shoulder")]

        force.send(force_command(["left_shoulder"], [0.25]))
        wait_until(lambda: effort() == 0.25, "the command")
        stop.send(True)
        wait_until(lambda: effort() == 0, "the emergency stop")
        stopped_at = self.status().time
        wait_until(lambda: self.status().time > stopped_at, "the steps to go on")
        self.assertEqual(answers, [])
        self.arm.pause()
        caller.join(PATIENCE)
        self.assertEqual(len(answers), 1)
        self.assertFalse(answers[0].success)
        self.assertIn("~pause was called, after", answers[0].message)
        self.assertGreater(answers[0].time, stopped_at)
        stopped_at = answers[0].time
        wait_until(lambda: self.status().time >= stopped_at, "the last of these steps")
        steps = self.status().steps
        self.assertTrue(self.arm.step(3).success)
        wait_until(lambda: self.status().steps == steps + 3, "the next call")

    def test_reset_sets_the_state_back_and_the_clock_goes_on(self):
        wait_until(lambda: self.status().time > 0.2, "some time to pass")
        self.pause_and_wait()
        before = self.status()
        self.arm.reset()
        wait_until(lambda: self.status().time == 0, "the status after the reset")
        after = self.status()
        self.assertTrue(after.paused)
        self.assertGreater(after.header.stamp, before.header.stamp)
        wait_until(lambda: self.log.last["/joint_states"].header.stamp > before.header.stamp,
                   "the state after the reset")

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


class States(ClockedArm):
    def setUp(self):
        super().setUp()
        self.pause_and_wait()
        self.folder = tempfile.TemporaryDirectory()
        self.file = os.path.join(self.folder.name, "state")
        self.assertTrue(self.arm.apply_wrench("left_boom", force=(0, 3, 1), at=(1, 0, 0), duration=0.05).success)
        self.assertTrue(self.arm.step(100).success)

    def tearDown(self):
        self.folder.cleanup()
        super().tearDown()

    def test_what_was_saved_comes_back_and_goes_on_the_same_way(self):
        answer = self.arm.save_state(self.file)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.message, self.file)
        saved, saved_status = self.states_when_paused(), self.status()
        self.assertTrue(self.arm.step(200).success)
        later, later_stamp = self.states_when_paused(), self.status().header.stamp

        answer = self.arm.load_state(self.file)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.time, saved_status.time)
        wait_until(lambda: self.status().header.stamp > later_stamp, "the status after the state was loaded")
        self.assertEqual(self.states_when_paused().position, saved.position)
        self.assertTrue(self.arm.step(200).success)
        # Kept factors of the tangent are not part of a state, so positions agree to within Newton's tolerance.
        for position, expected in zip(self.states_when_paused().position, later.position):
            self.assertAlmostEqual(position, expected, delta=1e-6)

    def test_files_that_are_no_states_are_refused(self):
        before = self.states_when_paused()
        for file in (self.file, self.folder.name, rospkg.RosPack().get_path("flexarm") + "/package.xml", ""):
            answer = self.arm.load_state(file)
            self.assertFalse(answer.success, file)
            self.assertIn(file, answer.message)
        self.assertEqual(self.states_when_paused().position, before.position)
        for file in (self.folder.name + "/no/such/folder", self.folder.name, ""):
            answer = self.arm.save_state(file)
            self.assertFalse(answer.success, file)
            self.assertNotEqual(answer.message, "")


class JointStates(ClockedArm):
    def setUp(self):
        super().setUp()
        self.pause_and_wait()
        self.assertTrue(self.arm.step(50).success)

    def test_joints_are_where_they_are_set_and_go_on_from_there(self):
        before, status = self.states_when_paused(), self.status()
        answer = self.arm.set_joint_state(names=["right_shoulder", "wrist/rx"], positions=[0.7, 0.2],
                                          velocities=[1.5, 0.0])
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.status().header.stamp > status.header.stamp, "the status after the joints were set")
        states = self.states_when_paused()
        self.assertEqual(Joint(states, "right_shoulder").position, 0.7)
        self.assertAlmostEqual(Joint(states, "right_shoulder").velocity, 1.5, delta=1e-12)
        self.assertAlmostEqual(Joint(states, "wrist/rx").position, 0.2, delta=1e-12)
        self.assertEqual(Joint(states, "mirror").position, -0.7)
        self.assertEqual(Joint(states, "left_shoulder").position, Joint(before, "left_shoulder").position)
        self.assertEqual(self.status().time, status.time)
        self.assertTrue(self.arm.step(10).success)
        turned = Joint(self.states_when_paused(), "right_shoulder").position - 0.7
        self.assertAlmostEqual(turned, 10 * self.step_size * 1.5, delta=1e-4)  # the effect of the hand changes slowly

    def test_what_is_not_given_stays(self):
        self.assertTrue(self.arm.set_joint_state(names=["right_shoulder"], velocities=[0.4]).success)
        self.assertTrue(self.arm.set_joint_state(names=["right_shoulder"], positions=[-0.3]).success)
        joint = Joint(self.states_when_paused(), "right_shoulder")
        self.assertEqual(joint.position, -0.3)
        self.assertAlmostEqual(joint.velocity, 0.4, delta=1e-12)

    def test_what_cannot_be_set_is_refused_whole(self):
        before = self.states_when_paused()
        for told, fields in (("no joint coordinate 'nose'", dict(names=["right_shoulder", "nose"], positions=[1, 1])),
                             ("1 positions", dict(names=["right_shoulder", "wrist/rx"], positions=[1])),
                             ("2 velocities", dict(names=["right_shoulder"], positions=[1], velocities=[1, 2])),
                             ("finite", dict(names=["right_shoulder"], positions=[math.nan])),
                             ("named twice", dict(names=["right_shoulder"] * 2, positions=[1, 2])),
                             ("follows 'right_shoulder'", dict(names=["mirror"], positions=[1]))):
            answer = self.arm.set_joint_state(**fields)
            self.assertFalse(answer.success, fields)
            self.assertIn(told, answer.message)
        self.assertEqual(self.states_when_paused().position, before.position)


class Wrenches(ClockedArm):
    TORQUE, STEPS = 0.2, 200

    def setUp(self):
        super().setUp()
        self.pause_and_wait()
        self.arm.reset()

    def angle(self, name="right_shoulder"):
        return Joint(self.states_when_paused(), name).position

    def pull(self, **fields):
        answer = self.arm.apply_wrench("right_arm", moment=(0, 0, self.TORQUE), **fields)
        self.assertTrue(answer.success, answer.message)

    def make_steps(self, steps=STEPS):
        self.assertTrue(self.arm.step(steps).success)

    def test_moment_about_a_joint_does_what_its_effort_does(self):
        force = CommandTopic("joint_force_command", JointForceCommand)
        force.send(force_command(["right_shoulder"], [self.TORQUE]))
        wait_for_arrival(force)
        self.make_steps()
        expected = self.angle()
        self.arm.reset()  # forgets the command
        self.pull(frame="follower")
        self.make_steps()
        self.assertGreater(expected, 1e-3)
        self.assertAlmostEqual(self.angle(), expected, delta=1e-6 * expected)

    def test_they_add_up_until_they_are_cleared(self):
        self.pull()
        self.make_steps()
        once = self.angle()
        self.arm.reset()
        self.make_steps()
        self.assertEqual(self.angle(), 0)  # a reset removes wrenches
        for _ in range(2):
            self.pull()
        self.make_steps()
        # The effect of the hand changes with the angle
        self.assertAlmostEqual(self.angle(), 2 * once, delta=0.01 * once)
        self.arm.clear_wrenches()
        self.arm.reset()
        self.make_steps()
        self.assertEqual(self.angle(), 0)

    def rate_after(self, **fields):
        """Return the rate after STEPS steps from rest with this wrench."""
        self.arm.reset()
        self.pull(**fields)
        self.make_steps()
        return Joint(self.states_when_paused(), "right_shoulder").velocity

    def test_each_has_its_time(self):
        one_step = self.rate_after(duration=1e-6)
        self.assertGreater(one_step, 0)
        self.assertEqual(self.rate_after(duration=0), 0)
        for steps in (1, 2, 20):
            rate = self.rate_after(duration=steps * self.step_size)
            self.assertAlmostEqual(rate, steps * one_step, delta=0.01 * steps * one_step)
        # A wrench that begins after half of the steps acts during the other half.
        self.arm.reset()
        time.sleep(0.2)  # until the status has arrived
        self.pull(start=self.status().header.stamp + rospy.Duration.from_sec(self.STEPS / 2 * self.step_size))
        self.make_steps()
        half = Joint(self.states_when_paused(), "right_shoulder").velocity
        self.assertAlmostEqual(half, self.STEPS / 2 * one_step, delta=1.01 * one_step)

    def test_what_cannot_act_is_refused(self):
        for fields, told in ((dict(link="no_link"), "no_link"), (dict(link="base"), "fixed to the world"),
                             (dict(link="right_arm", force=(math.nan, 0, 0)), "finite"),
                             (dict(link="right_arm", frame="body"), "body")):
            answer = self.arm.apply_wrench(**fields)
            self.assertFalse(answer.success, fields)
            self.assertIn(told, answer.message)
        self.make_steps()
        self.assertEqual(self.angle(), 0)


class Failure(ClockedArm):
    def setUp(self):
        super().setUp()
        self.force = CommandTopic("joint_force_command", JointForceCommand)
        self.pause_and_wait()
        self.before = self.status()
        self.force.send(force_command(["left_shoulder"], [1e250]))
        answers = []

        def failed():
            answers.append(self.arm.step(1))
            return not answers[-1].success

        wait_until(failed, "a step to fail")
        self.answer = answers[-1]
        wait_until(lambda: self.status().failed, "the status of the failure")

    def test_last_good_state_and_reason_are_published(self):
        self.assertIn("step from t = ", self.answer.message)
        self.assertRegex(self.answer.message, " at (link|joint coordinate|element .* of link) '")
        self.assertIn("What usually helps: ", self.answer.message)
        status = self.status()
        self.assertTrue(status.paused)
        self.assertEqual(status.message, self.answer.message)
        self.assertEqual(status.time, self.answer.time)
        self.assertEqual(status.halvings - self.before.halvings, 14)  # max_halvings of the failed step
        wait_until(lambda: self.log.last["/joint_states"].header.stamp == status.header.stamp, "the last good state")
        states = self.log.last["/joint_states"]
        for number in (*states.position, *states.velocity):
            self.assertTrue(math.isfinite(number))

    def test_who_tries_again_is_told_the_reason(self):
        self.assertIn("step from t = ", self.arm.step(1).message)
        with self.assertRaisesRegex(rospy.ServiceException, "step from t = "):
            self.arm.resume()
        self.assertTrue(self.status().paused)

    def test_goes_on_from_the_last_good_state_with_a_new_command(self):
        self.force.send(force_command(["left_shoulder"], [0.0]))
        wait_for_arrival(self.force)
        failed_at = self.status()
        self.arm.resume()
        wait_until(lambda: self.status().time > failed_at.time, "the simulation to go on")
        self.assertFalse(self.status().failed or self.status().paused)
        self.assertEqual(self.status().message, "")
        self.assertGreaterEqual(self.status().steps, failed_at.steps)

    def test_reset_starts_again(self):
        self.arm.reset()
        wait_until(lambda: not self.status().failed, "the status after the reset")
        self.assertTrue(self.arm.step(5).success)


if __name__ == "__main__":
    rospy.init_node("services_test")
    rostest.rosrun("flexarm", "services", __name__)
