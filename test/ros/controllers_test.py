#!/usr/bin/python3
"""Tests the actions of groups of joints and of grippers, with a client that knows only control_msgs."""

import math
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from flexarm import msg as messages
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, release_stop, wait_until
from std_msgs.msg import Bool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

# Published with control_msgs, for example in the messages that rosserial and roslibjs generate.
CHECKSUMS = {
    "FollowJointTrajectoryAction": "bc4f9b743838566551c0390c65f1a248",
    "FollowJointTrajectoryActionGoal": "cff5c1d533bf2f82dd0138d57f4304bb",
    "FollowJointTrajectoryActionResult": "c4fb3b000dc9da4fd99699380efcc5d9",
    "FollowJointTrajectoryActionFeedback": "d8920dc4eae9fc107e00999cce4be641",
    "GripperCommandAction": "950b2a6ebe831f5d4f4ceaba3d8be01e",
    "GripperCommandActionGoal": "aa581f648a35ed681db2ec0bf7a82bea",
    "GripperCommandActionResult": "143702cb2df0f163c5283cedc5efc6b6",
    "GripperCommandActionFeedback": "653dff30c045f5e6ff3feb3409f4558d",
}
TERMINAL = (GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.REJECTED, GoalStatus.PREEMPTED)
GAP = 0.03  # m, distance of each finger from the block
TOLERANCE = 0.001  # m, of grippers


def of_control_msgs(name):
    """Return the message class as another package would have it: the same fields, but with the name in control_msgs."""
    ours = getattr(messages, name)
    return type(name, (ours,), {"_type": "control_msgs/" + name, "_md5sum": CHECKSUMS[name],
                                "__slots__": ours.__slots__})


def action_of_control_msgs(name):
    parts = {part: of_control_msgs(name + "Action" + part.capitalize()) for part in ("goal", "result", "feedback")}

    def make():
        return of_control_msgs(name + "Action")(*(parts[part]() for part in ("goal", "result", "feedback")))

    return make


class Client:
    def __init__(self, name, action):
        self.client = actionlib.SimpleActionClient(name, action_of_control_msgs(action))
        wait_until(lambda: self.client.wait_for_server(rospy.Duration(0.1)), "the action " + name)
        self.feedback = []

    def send(self, goal):
        del self.feedback[:]
        self.client.send_goal(goal, feedback_cb=self.feedback.append)

    def is_over(self):
        return self.client.get_state() in TERMINAL and self.client.get_result() is not None

    def state(self):
        return self.client.get_state()

    def result(self):
        wait_until(self.is_over, "the end of the goal")
        return self.client.get_result()


def as_moveit_sends_it(names, start, end, seconds=0.5, points=11):
    """Return a trajectory from the joints' positions as MoveIt sends it: with stamp 0, a first point at 0, all rates,
    and no tolerances."""
    trajectory = JointTrajectory(joint_names=names)
    for k in range(points):
        t = k / (points - 1)
        way = 10 * t**3 - 15 * t**4 + 6 * t**5
        rate = (30 * t**2 - 60 * t**3 + 30 * t**4) / seconds
        acceleration = (60 * t - 180 * t**2 + 120 * t**3) / seconds**2
        ways = [last - first for first, last in zip(start, end)]
        trajectory.points.append(JointTrajectoryPoint(
            positions=[first + way * d for first, d in zip(start, ways)], velocities=[rate * d for d in ways],
            accelerations=[acceleration * d for d in ways], time_from_start=rospy.Duration.from_sec(t * seconds)))
    return messages.FollowJointTrajectoryGoal(trajectory=trajectory)


def grip(position, max_effort=0.0):
    goal = messages.GripperCommandGoal()
    goal.command.position, goal.command.max_effort = position, max_effort
    return goal


class Controllers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm = SimulatedArm("")
        cls.lift = Client("arm_controller/follow_joint_trajectory", "FollowJointTrajectory")
        cls.turn = Client("wheel_controller/follow_joint_trajectory", "FollowJointTrajectory")
        cls.all = Client("follow_joint_trajectory", "FollowJointTrajectory")
        cls.gripper = Client("gripper_controller/gripper_cmd", "GripperCommand")
        cls.jaws = Client("jaws/gripper_action", "GripperCommand")
        cls.topic = CommandTopic("joint_trajectory", JointTrajectory)
        cls.states = {}
        rospy.Subscriber("joint_states", JointState, cls.receive_states)

    @classmethod
    def receive_states(cls, message):
        cls.states = {name: numbers for name, *numbers in
                      zip(message.name, message.position, message.velocity, message.effort)}

    def setUp(self):
        self.arm.reset()
        moving = ("lift", "turn", "left", "upper_jaw", "lower_jaw")
        wait_until(lambda: self.states and all(abs(self.position(name)) < 1e-6 for name in moving), "the reset")

    def position(self, name):
        return self.states[name][0]

    def effort(self, name):
        return self.states[name][2]

    def assert_ends(self, client, state, **fields):
        result = client.result()
        self.assertEqual(client.state(), state, client.client.get_goal_status_text())
        for name, value in fields.items():
            self.assertEqual(getattr(result, name), value, result)
        return result

    def test_checksums_are_those_of_control_msgs(self):
        for name, checksum in CHECKSUMS.items():
            self.assertEqual(getattr(messages, name)._md5sum, checksum, name)

    # ---- trajectories

    def test_trajectories_of_groups_side_by_side(self):
        self.lift.send(as_moveit_sends_it(["lift"], [0], [0.2]))
        self.turn.send(as_moveit_sends_it(["turn"], [0], [-0.5], seconds=0.8))
        self.assert_ends(self.lift, GoalStatus.SUCCEEDED, error_code=0)
        self.assertFalse(self.turn.is_over())
        self.assert_ends(self.turn, GoalStatus.SUCCEEDED, error_code=0)
        wait_until(lambda: abs(self.position("lift") - 0.2) < 1e-6, "the end of the lift")
        wait_until(lambda: abs(self.position("turn") + 0.5) < 1e-6, "the end of the turn")
        # The servo's lag is at most the largest acceleration over 20^2/s^2.
        for client, joint, way, seconds in ((self.lift, "lift", 0.2, 0.5), (self.turn, "turn", 0.5, 0.8)):
            self.assertGreater(len(client.feedback), 5)
            for feedback in client.feedback:
                self.assertEqual(feedback.joint_names, [joint])
                self.assertLess(abs(feedback.error.positions[0]), 10 / math.sqrt(3) * way / seconds**2 / 400 + 1e-6)

    def test_a_joint_of_another_group_is_refused(self):
        self.lift.send(as_moveit_sends_it(["lift", "turn"], [0, 0], [0.2, 0.2]))
        result = self.assert_ends(self.lift, GoalStatus.REJECTED, error_code=-2)
        self.assertIn("'turn' is not a joint of this controller, which has lift", result.error_string)

    def test_tolerances_of_a_group(self):
        goal = as_moveit_sends_it(["lift"], [0], [0.5], seconds=0.3)
        goal.path_tolerance = [messages.JointTolerance(name="lift", position=1e-4)]
        self.turn.send(as_moveit_sends_it(["turn"], [0], [0.5], seconds=0.8))
        self.lift.send(goal)
        self.assert_ends(self.lift, GoalStatus.ABORTED, error_code=-4)
        self.assert_ends(self.turn, GoalStatus.SUCCEEDED)

    def test_cancel_stops_the_group_alone(self):
        self.turn.send(as_moveit_sends_it(["turn"], [0], [0.5], seconds=1.0))
        self.lift.send(as_moveit_sends_it(["lift"], [0], [0.5], seconds=1.0))
        wait_until(lambda: self.position("lift") > 0.02, "the way")
        self.lift.client.cancel_goal()
        self.assert_ends(self.lift, GoalStatus.PREEMPTED)
        self.assert_ends(self.turn, GoalStatus.SUCCEEDED)
        self.assertLess(self.position("lift"), 0.45)

    def test_without_points_the_group_stops(self):
        self.turn.send(as_moveit_sends_it(["turn"], [0], [0.5], seconds=1.0))
        self.lift.send(as_moveit_sends_it(["lift"], [0], [0.5], seconds=1.0))
        wait_until(lambda: self.position("lift") > 0.02, "the way")
        self.lift.send(messages.FollowJointTrajectoryGoal())
        self.assert_ends(self.lift, GoalStatus.SUCCEEDED)
        self.assert_ends(self.turn, GoalStatus.SUCCEEDED)
        self.assertLess(self.position("lift"), 0.45)

    def test_who_takes_a_joint_ends_the_goal_of_its_group_alone(self):
        self.turn.send(as_moveit_sends_it(["turn"], [0], [0.5], seconds=1.0))
        self.lift.send(as_moveit_sends_it(["lift"], [0], [0.5], seconds=1.0))
        wait_until(lambda: self.lift.feedback and self.turn.feedback, "both to be under way")
        self.all.send(as_moveit_sends_it(["lift"], [self.position("lift")], [-0.1]))
        result = self.assert_ends(self.lift, GoalStatus.PREEMPTED)
        self.assertIn("replaced it for 'lift'", result.error_string)
        self.assert_ends(self.all, GoalStatus.SUCCEEDED)
        self.assert_ends(self.turn, GoalStatus.SUCCEEDED)
        self.turn.send(as_moveit_sends_it(["turn"], [0.5], [1.0], seconds=1.0))
        wait_until(lambda: self.turn.feedback, "the way")
        self.topic.send(as_moveit_sends_it(["turn"], [0.5], [0.0]).trajectory)
        self.assert_ends(self.turn, GoalStatus.PREEMPTED)

    # ---- grippers

    def test_gripper_reaches_its_goal(self):
        self.gripper.send(grip(0.02, 5.0))
        result = self.assert_ends(self.gripper, GoalStatus.SUCCEEDED, reached_goal=True, stalled=False)
        self.assertAlmostEqual(result.position, 0.02, delta=TOLERANCE)
        wait_until(lambda: abs(self.position("right") - 0.02) < 1e-6, "the end of the way")
        for feedback in self.gripper.feedback:
            self.assertFalse(feedback.stalled)
            self.assertLess(feedback.effort, 5.0 + 1e-9)
        self.gripper.send(grip(0.0))
        self.assert_ends(self.gripper, GoalStatus.SUCCEEDED, reached_goal=True)

    def test_gripper_stalls_on_what_it_holds(self):
        self.gripper.send(grip(0.05, 10.0))
        self.lift.send(as_moveit_sends_it(["lift"], [0], [0.2]))
        result = self.assert_ends(self.gripper, GoalStatus.ABORTED, reached_goal=False, stalled=True)
        self.assertAlmostEqual(result.position, GAP, delta=TOLERANCE)
        self.assertAlmostEqual(result.effort, 10.0, delta=0.01)
        self.assertIn("stalled at 0.03", self.gripper.client.get_goal_status_text())
        # When the finger is thrown back, the damping adds to the effort.
        self.assertLess(max(feedback.effort for feedback in self.gripper.feedback), 10.0 * 1.05)
        self.assert_ends(self.lift, GoalStatus.SUCCEEDED)
        rospy.sleep(0.2)
        self.assertAlmostEqual(self.effort("left"), 10.0, delta=0.01)  # the gripper still holds the block
        self.gripper.send(grip(0.05, 4.0))
        result = self.assert_ends(self.gripper, GoalStatus.ABORTED, stalled=True)
        self.assertAlmostEqual(result.effort, 4.0, delta=0.01)

    def test_jaws_are_given_the_sum_of_both(self):
        self.jaws.send(grip(0.06))
        result = self.assert_ends(self.jaws, GoalStatus.SUCCEEDED, reached_goal=True)
        self.assertAlmostEqual(result.position, 0.06, delta=2 * TOLERANCE)
        wait_until(lambda: abs(self.position("upper_jaw") - 0.03) < 1e-5, "the upper jaw")
        wait_until(lambda: abs(self.position("lower_jaw") - 0.03) < 1e-5, "the lower jaw")

    def test_an_integral_does_not_wind_up(self):
        """Both jaws press against their stops at 0.05 with the controller's own effort limit."""
        self.jaws.send(grip(0.2))
        result = self.assert_ends(self.jaws, GoalStatus.ABORTED, stalled=True)
        # The stops give way by 15 N over 20 kN/m each
        self.assertAlmostEqual(result.position, 0.1, delta=2 * TOLERANCE)
        rospy.sleep(1.0)
        for joint in ("upper_jaw", "lower_jaw"):
            self.assertAlmostEqual(self.effort(joint), 15.0, delta=0.1)
        self.jaws.send(grip(0.06))
        self.assert_ends(self.jaws, GoalStatus.SUCCEEDED)

    def test_cancel_holds_the_gripper_where_it_is(self):
        self.gripper.send(grip(0.025, 0.2))
        wait_until(lambda: self.position("left") > 0.005, "the way")
        self.gripper.client.cancel_goal()
        self.assert_ends(self.gripper, GoalStatus.PREEMPTED)
        wait_until(lambda: abs(self.states["left"][1]) < 1e-6, "the stop")
        self.assertLess(self.position("left"), 0.02)

    def test_another_goal_replaces_it(self):
        self.gripper.send(grip(0.025, 0.2))
        wait_until(lambda: self.gripper.feedback, "the way")
        other = Client("gripper_controller/gripper_cmd", "GripperCommand")
        other.send(grip(0.01))
        self.assert_ends(self.gripper, GoalStatus.PREEMPTED)
        self.assert_ends(other, GoalStatus.SUCCEEDED)

    def test_others_take_the_gripper(self):
        self.gripper.send(grip(0.025, 0.2))
        wait_until(lambda: self.gripper.feedback, "the way")
        CommandTopic("joint_set_points", JointState).send(JointState(name=["left"], position=[0.001]))
        self.assert_ends(self.gripper, GoalStatus.ABORTED)
        wait_until(lambda: abs(self.position("left") - 0.001) < 1e-6, "the set point")
        self.gripper.send(grip(0.025, 0.2))
        wait_until(lambda: self.gripper.feedback, "the way")
        self.all.send(as_moveit_sends_it(["left"], [self.position("left")], [0.01]))
        self.assert_ends(self.gripper, GoalStatus.PREEMPTED)
        self.assert_ends(self.all, GoalStatus.SUCCEEDED)
        wait_until(lambda: abs(self.position("left") - 0.01) < 1e-6, "the end of the trajectory")

    def test_emergency_stop_and_reset_end_all_goals(self):
        stop = CommandTopic("flexarm/emergency_stop", Bool)
        self.addCleanup(stop.send, False)
        self.lift.send(as_moveit_sends_it(["lift"], [0], [0.5], seconds=1.0))
        self.gripper.send(grip(0.025, 0.2))
        wait_until(lambda: self.gripper.feedback and self.lift.feedback, "the way")
        stop.send(True)
        self.assert_ends(self.lift, GoalStatus.ABORTED)
        self.assert_ends(self.gripper, GoalStatus.ABORTED, stalled=False)
        self.gripper.send(grip(0.025))
        self.assert_ends(self.gripper, GoalStatus.REJECTED)
        self.assertIn("emergency stop", self.gripper.client.get_goal_status_text())
        release_stop(stop)
        self.gripper.send(grip(0.025, 0.2))
        wait_until(lambda: self.gripper.feedback, "the way")
        self.arm.reset()
        self.assert_ends(self.gripper, GoalStatus.ABORTED)

    def test_a_gripper_goal_that_is_no_number_is_rejected(self):
        self.gripper.send(grip(math.nan))
        self.assert_ends(self.gripper, GoalStatus.REJECTED)
        self.assertIn("must be numbers", self.gripper.client.get_goal_status_text())


if __name__ == "__main__":
    rospy.init_node("controllers_test")
    rostest.rosrun("flexarm", "controllers", __name__)
