#!/usr/bin/python3
"""Tests that joints follow trajectories from the topic and from the action, and that impossible trajectories are
refused."""

import math
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from flexarm.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal, FollowJointTrajectoryResult
from flexarm.msg import JointTolerance
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, release_stop, wait_until, warnings_during
from std_msgs.msg import Bool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

# Both servos are critically damped, so their impulse response is never negative. So they lag behind a set point with
# the acceleration a by at most max |a| / RATE^2.
RATE = 20.0  # 1/s
# Tolerance for positions, far above Newton's tolerance. (A message may describe an instant within a step. Then its
# position differs by up to half of the step's travel.)
SLACK = 1e-6  # m or rad
SETTLED = 1.0  # s; after this exp(-20) is left
Result = FollowJointTrajectoryResult


def point(seconds, *positions, velocities=(), accelerations=()):
    return JointTrajectoryPoint(positions=positions, velocities=velocities, accelerations=accelerations,
                                time_from_start=rospy.Duration.from_sec(seconds))


def smooth(seconds, *positions):
    """Return a point at which all joints rest. The path to it is a polynomial of degree 5."""
    rest = [0.0] * len(positions)
    return point(seconds, *positions, velocities=rest, accelerations=rest)


def largest_acceleration(way, seconds):
    """Return the largest acceleration of a polynomial of degree 5 from rest to rest."""
    return 10 / math.sqrt(3) * abs(way) / seconds**2


class Trajectories(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.namespace = rospy.get_namespace().rstrip("/")
        cls.arm = SimulatedArm(cls.namespace)
        cls.topic = CommandTopic("joint_trajectory", JointTrajectory)
        cls.client = actionlib.SimpleActionClient("follow_joint_trajectory", FollowJointTrajectoryAction)
        wait_until(lambda: cls.client.wait_for_server(rospy.Duration(0.1)), "the action server")
        cls.states = {}
        rospy.Subscriber("joint_states", JointState, cls.receive_states)

    @classmethod
    def receive_states(cls, message):
        cls.states = {name: (position, velocity) for name, position, velocity in
                      zip(message.name, message.position, message.velocity)}

    def setUp(self):
        self.arm.reset()
        self.feedback = []
        wait_until(lambda: self.states and self.is_at_start("lift") and self.is_at_start("turn"), "the reset")

    def position(self, name):
        return self.states[name][0]

    def is_at_start(self, name):
        return abs(self.position(name)) < 1e-3

    def velocity(self, name):
        return self.states[name][1]

    def goal(self, names, *points, path=(), at_end=(), patience=0.0, stamp=None):
        goal = FollowJointTrajectoryGoal()
        goal.trajectory = JointTrajectory(joint_names=names, points=points)
        goal.trajectory.header.stamp = stamp or rospy.Time()
        goal.path_tolerance = [JointTolerance(name=name, position=position) for name, position in path]
        goal.goal_tolerance = [JointTolerance(name=name, position=position) for name, position in at_end]
        goal.goal_time_tolerance = rospy.Duration.from_sec(patience)
        return goal

    def send(self, *args, **fields):
        self.client.send_goal(self.goal(*args, **fields), feedback_cb=self.feedback.append)

    def wait_for_end(self, state, code=None, told=""):
        terminal = (GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.REJECTED, GoalStatus.PREEMPTED)
        wait_until(lambda: self.client.get_state() in terminal and self.client.get_result(), "the end of the goal")
        result = self.client.get_result()
        self.assertEqual(self.client.get_state(), state, self.client.get_goal_status_text())
        if code is not None:
            self.assertEqual(result.error_code, code, result.error_string)
        self.assertIn(told, result.error_string)

    def largest_error(self, joint):
        return max(abs(feedback.error.positions[joint]) for feedback in self.feedback)

    def assert_rests_at(self, **positions):
        for name, position in positions.items():
            wait_until(lambda: abs(self.position(name) - position) < SLACK, f"{name} to come to {position}")
            self.assertLess(abs(self.velocity(name)), 1e-3)

    # ---- trajectories that are followed

    def test_follows_within_the_formula(self):
        self.send(["lift", "turn"], smooth(0.5, 0.1, -0.3), smooth(1.0, 0.0, 0.5),
                  path=[("lift", largest_acceleration(0.1, 0.5) / RATE**2 + SLACK)])
        self.wait_for_end(GoalStatus.SUCCEEDED, Result.SUCCESSFUL)
        self.assertGreater(len(self.feedback), 10)
        self.assertEqual(self.feedback[-1].joint_names, ["lift", "turn"])
        self.assertLess(self.largest_error(0), largest_acceleration(0.1, 0.5) / RATE**2 + SLACK)
        self.assertLess(self.largest_error(1), largest_acceleration(0.8, 0.5) / RATE**2 + SLACK)
        self.assertGreater(self.largest_error(1), 0.01 * largest_acceleration(0.8, 0.5) / RATE**2)
        self.assert_rests_at(lift=0.0, turn=0.5)

    def test_topic(self):
        self.topic.send(JointTrajectory(joint_names=["turn"], points=[point(0.2, 0.1), point(0.4, 0.3)]))
        self.assert_rests_at(turn=0.3, lift=0.0)

    def test_another_goal_replaces_it_without_a_jump(self):
        replaced = []
        self.client.send_goal(self.goal(["lift"], smooth(1.0, 0.4)), done_cb=lambda state, _: replaced.append(state))
        wait_until(lambda: self.position("lift") > 0.05, "the way")
        other = actionlib.SimpleActionClient("follow_joint_trajectory", FollowJointTrajectoryAction)
        wait_until(lambda: other.wait_for_server(rospy.Duration(0.1)), "the action server")
        other.send_goal(self.goal(["lift"], smooth(0.5, 0.1)), feedback_cb=self.feedback.append)
        wait_until(lambda: replaced, "the end of the first goal")
        self.assertEqual(replaced, [GoalStatus.PREEMPTED])
        wait_until(lambda: other.get_state() == GoalStatus.SUCCEEDED, "the end of the second goal")
        # The polynomial leads from 0.1 to 0.4 m, with up to 0.75 m/s, then to 0.1 m. Its acceleration stays below 20
        # m/s^2.
        self.assertLess(self.largest_error(0), 20 / RATE**2)
        self.assert_rests_at(lift=0.1)

    def test_a_trajectory_on_the_topic_replaces_a_goal(self):
        self.send(["lift"], smooth(5.0, 0.4))
        wait_until(lambda: self.feedback, "the goal to be under way")
        self.topic.send(JointTrajectory(joint_names=["lift"], points=[smooth(0.3, -0.1)]))
        self.wait_for_end(GoalStatus.PREEMPTED, told="replaced")
        self.assert_rests_at(lift=-0.1)

    def test_other_joints_go_on(self):
        self.topic.send(JointTrajectory(joint_names=["turn"], points=[smooth(0.6, 1.0)]))
        wait_until(lambda: self.position("turn") > 0.01, "the way")
        self.send(["lift"], smooth(0.2, 0.2))
        self.wait_for_end(GoalStatus.SUCCEEDED)
        self.assert_rests_at(turn=1.0, lift=0.2)

    def test_begins_when_its_stamp_says(self):
        begin = rospy.Time.now() + rospy.Duration(0.5)
        self.send(["lift"], smooth(0.2, 0.2), stamp=begin)
        wait_until(lambda: abs(self.position("lift")) > 1e-4, "the beginning")
        self.assertGreater((rospy.Time.now() - begin).to_sec(), 0)
        self.wait_for_end(GoalStatus.SUCCEEDED)

    def test_a_pause_holds_it_without_ending_it(self):
        self.send(["lift"], smooth(1.0, 0.4), path=[("lift", largest_acceleration(0.4, 1.0) / RATE**2 + SLACK)])
        wait_until(lambda: self.position("lift") > 0.05, "the way")
        self.addCleanup(self.arm.resume)
        self.arm.pause()
        time.sleep(0.3)  # until messages that were sent before have arrived
        held, count = self.position("lift"), len(self.feedback)
        time.sleep(1.5)  # longer than the rest of the trajectory
        self.assertEqual(self.position("lift"), held)
        self.assertEqual(len(self.feedback), count)
        self.assertEqual(self.client.get_state(), GoalStatus.ACTIVE)
        self.arm.resume()
        self.wait_for_end(GoalStatus.SUCCEEDED, Result.SUCCESSFUL)
        self.assertGreater(len(self.feedback), count)
        self.assert_rests_at(lift=0.4)

    # ---- events that stop a trajectory

    def test_cancel_holds(self):
        self.send(["lift"], smooth(2.0, 1.0))
        wait_until(lambda: self.position("lift") > 0.1, "the way")
        self.client.cancel_goal()
        self.wait_for_end(GoalStatus.PREEMPTED)
        wait_until(lambda: abs(self.velocity("lift")) < 1e-5, "the stop")
        held = self.position("lift")
        self.assertLess(held, 0.9)
        rospy.sleep(0.3)
        self.assertAlmostEqual(self.position("lift"), held, delta=1e-5)

    def test_an_empty_trajectory_stops_all(self):
        self.send(["lift"], smooth(2.0, 1.0))
        wait_until(lambda: self.position("lift") > 0.1, "the way")
        self.topic.send(JointTrajectory())
        self.wait_for_end(GoalStatus.PREEMPTED)
        wait_until(lambda: abs(self.velocity("lift")) < 1e-5, "the stop")
        self.assertLess(self.position("lift"), 0.9)

    def test_a_goal_without_points_stops_all_whatever_it_names(self):
        self.topic.send(JointTrajectory(joint_names=["lift"], points=[smooth(2.0, 1.0)]))
        wait_until(lambda: self.position("lift") > 0.1, "the way")
        # The tolerances are those of 'turn', which does not move. While 'lift' stops, it could not satisfy them.
        self.send(["turn", "lift"], path=[("turn", 1e-9)], at_end=[("turn", 1e-9)])
        self.wait_for_end(GoalStatus.SUCCEEDED, Result.SUCCESSFUL)
        wait_until(lambda: abs(self.velocity("lift")) < 1e-5, "the stop")
        self.assertLess(self.position("lift"), 0.9)
        for feedback in self.feedback:
            self.assertEqual(feedback.joint_names, ["lift"])

    def test_off_its_path_it_is_aborted(self):
        self.send(["turn", "lift"], smooth(0.5, 0.0, 0.5), path=[("lift", 1e-3)])
        self.wait_for_end(GoalStatus.ABORTED, Result.PATH_TOLERANCE_VIOLATED, "'lift' is off its path by 0.001")
        wait_until(lambda: abs(self.velocity("lift")) < 1e-5, "the stop")
        self.assertLess(self.position("lift"), 0.4)

    def test_not_at_its_goal_it_is_aborted(self):
        # A cubic ends with an acceleration, which leaves a lag.
        end = point(0.2, 0.3, velocities=[0.0])
        self.send(["lift"], end, at_end=[("lift", 1e-4)], patience=0.01)
        self.wait_for_end(GoalStatus.ABORTED, Result.GOAL_TOLERANCE_VIOLATED, "'lift' is not at its goal")
        self.send(["lift"], point(0.2, 0.0, velocities=[0.0]), at_end=[("lift", 1e-4)], patience=SETTLED)
        self.wait_for_end(GoalStatus.SUCCEEDED, Result.SUCCESSFUL)
        self.assertLess(abs(self.position("lift")), 1e-3)

    def test_a_set_point_takes_over(self):
        self.send(["lift"], smooth(3.0, 1.0))
        wait_until(lambda: self.feedback, "the goal to be under way")
        CommandTopic("joint_set_points", JointState).send(JointState(name=["lift"], position=[-0.2]))
        self.wait_for_end(GoalStatus.ABORTED, told="set point")
        self.assert_rests_at(lift=-0.2)

    def test_emergency_stop_and_reset_abort_it(self):
        self.send(["lift"], smooth(3.0, 1.0))
        wait_until(lambda: self.feedback, "the goal to be under way")
        stop = CommandTopic("flexarm/emergency_stop", Bool)
        self.addCleanup(stop.send, False)
        stop.send(True)
        self.wait_for_end(GoalStatus.ABORTED, told="emergency stop")
        self.send(["lift"], smooth(0.1, 1.0))
        self.wait_for_end(GoalStatus.REJECTED, told="emergency stop")
        release_stop(stop)
        self.send(["lift"], smooth(3.0, 1.0))
        wait_until(lambda: self.client.get_state() == GoalStatus.ACTIVE, "the goal to be accepted")
        self.arm.reset()
        self.wait_for_end(GoalStatus.ABORTED, told="another state")

    def test_beyond_limits_it_is_followed_with_a_warning(self):
        goal = self.goal(["turn", "lift"], smooth(5.0, 0.1, -10.5), smooth(10.0, 0.0, -10.6))
        self.assertEqual(warnings_during(lambda: self.client.send_goal(goal), "limit"),
                         ["joint 'lift' is sent to -10.6, beyond its lower limit -10, where its stop holds it"])
        self.client.cancel_goal()
        wait_until(lambda: self.client.get_state() == GoalStatus.PREEMPTED, "the end of the goal")

    # ---- trajectories that are refused

    def assert_rejected(self, code, told, *args, **fields):
        self.send(*args, **fields)
        self.wait_for_end(GoalStatus.REJECTED, code, told)

    def test_joints_that_cannot_follow_are_rejected(self):
        for name, told in (("nose", "no joint coordinate 'nose'; the scene has loose, "),
                           ("loose", "no servo: write <servo joint=\"loose\" mode=\"position\""),
                           ("spindle", "not in mode")):
            self.assert_rejected(Result.INVALID_JOINTS, told, ["lift", name], smooth(0.2, 0.1, 0.1))

    def test_bad_trajectories_are_rejected(self):
        for told, points in (("1 positions for 2 joints", [point(0.2, 0.1)]),
                             ("not later", [point(0.2, 0, 0), point(0.2, 1, 1)]),
                             ("not finite", [point(0.2, 0, math.nan)])):
            self.assert_rejected(Result.INVALID_GOAL, told, ["lift", "turn"], *points)
        self.assert_rejected(Result.INVALID_GOAL, "'spindle'", ["lift"], point(0.2, 0.1), path=[("spindle", 0.1)])
        past = rospy.Time.now() - rospy.Duration(1.0)
        self.assert_rejected(Result.OLD_HEADER_TIMESTAMP, "its last point was", ["lift"], point(0.2, 0.1), stamp=past)
        self.assertLess(abs(self.position("lift")), 1e-6)


if __name__ == "__main__":
    rospy.init_node("trajectories_test")
    rostest.rosrun("flexarm", "trajectories", __name__)
