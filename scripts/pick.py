#!/usr/bin/python3
"""Takes the block of config/examples/six_axis_pick.urdf and puts it down somewhere else.

pick.py [--to X Y Z]   # where the middle of the block shall stand [m], by default on the shelf

It uses the actions of config/controllers.yaml, which a real arm has, too, and looks at the poses on sensors/tool and
sensors/block, as by a camera. Angles of the joints are computed for a stiff arm; by how much the forearm's bending
moves the hand, the camera tells. The exit status is 0 if the block stands where it should.
"""

import argparse
import collections
import math
import sys
import threading

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from flexarm.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal
from flexarm.msg import GripperCommandAction, GripperCommandGoal
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

# The arm, as in its URDF [m]
SHOULDER = (0.025, 0.4)  # axis 2: distance from axis 1, height
UPPER_ARM = 0.455  # from axis 2 to axis 3
FOREARM = (0.42, 0.035)  # from axis 3 to the wrist's centre, along the forearm and across it
HAND = 0.22  # from there to the place between the fingers

ABOVE = 0.12  # m, how far above the block the hand arrives and leaves
GAP = 0.001  # m, how far above its place the block is let go
CLOSED = 0.05  # m, position of the fingers where they would meet
FORCE = 40.0  # N, of the gripper's motor
SPEED = 0.8  # rad/s, largest speed of a joint

ROUGH, EXACT = 0.01, 0.0005  # m, by how much the hand may miss a place on its way, and one where it grips or lets go
REST, WINDOW = 0.0001, 0.3  # m, s: what moves less than this in this time stands
FAR = 0.003  # m, by how much the block may miss its place in the end
LARGEST = 0.05  # m, offset of the hand by the forearm's bending; with a larger one, something else has happened
ATTEMPTS = 5


def joints_for(place, turn):
    """Return the joints' angles with which a stiff arm holds its fingers to a place, pointing down, parallel to a block
    that is turned by `turn` about the vertical [rad]."""
    x, y, z = place
    yaw = math.atan2(y, x)
    r, h = math.hypot(x, y) - SHOULDER[0], z + HAND - SHOULDER[1]  # the wrist's centre, seen from axis 2
    forearm, distance = math.hypot(*FOREARM), math.hypot(r, h)
    if not abs(UPPER_ARM - forearm) < distance < UPPER_ARM + forearm:
        sys.exit("pick.py: the arm does not reach %.3f %.3f %.3f" % tuple(place))
    above = math.acos((UPPER_ARM**2 + distance**2 - forearm**2) / (2 * UPPER_ARM * distance))
    inside = math.acos((UPPER_ARM**2 + forearm**2 - distance**2) / (2 * UPPER_ARM * forearm))
    axis_2 = math.pi / 2 - math.atan2(h, r) - above
    axis_3 = math.pi / 2 - inside + math.atan2(FOREARM[1], FOREARM[0])
    return [yaw, axis_2, axis_3, 0.0, math.pi / 2 - axis_2 - axis_3, yaw - turn]


def give_up():
    sys.exit("pick.py: ended before the block was where it should be")


def end_without(connection):
    if rospy.is_shutdown() or connection.get_num_connections() == 0:
        give_up()


class Pose:
    """What the camera sees of one thing: its place, and its direction about the vertical."""

    def __init__(self, topic):
        self.changed = threading.Condition()
        self.seen = collections.deque()  # (time, place) of the last WINDOW
        self.turn = None
        self.subscriber = rospy.Subscriber(topic, PoseStamped, self.receive)

    def receive(self, message):
        time, at, turn = message.header.stamp.to_sec(), message.pose.position, message.pose.orientation
        with self.changed:
            if self.seen and time < self.seen[-1][0]:  # the clock was set back
                self.seen.clear()
            self.seen.append((time, (at.x, at.y, at.z)))
            while self.seen[0][0] < time - WINDOW:
                self.seen.popleft()
            self.turn = 2 * math.atan2(turn.z, turn.w)
            self.changed.notify()

    def stands(self):
        if not self.seen or self.seen[-1][0] - self.seen[0][0] < 0.9 * WINDOW:
            return False
        return all(max(numbers) - min(numbers) < REST for numbers in zip(*(place for _, place in self.seen)))

    def at_rest(self):
        """Return the place [m], as soon as the thing stands."""
        with self.changed:
            self.seen.clear()
            while not self.stands():
                if self.turn is not None:  # it has been seen
                    end_without(self.subscriber)
                self.changed.wait(0.1)
            return self.seen[-1][1]


def client_of(name, action):
    client = actionlib.ActionClient(name, action)
    while not client.wait_for_server(rospy.Duration(5)):
        if rospy.is_shutdown():
            give_up()
        rospy.logwarn("waiting for the action %s", name)
    return client


def outcome(client, goal):
    """Send a goal, wait for its end, and return its handle. (SimpleActionClient can miss the end of a goal that ends at
    once.)"""
    changed = threading.Event()
    handle = client.send_goal(goal, lambda _: changed.set())
    while handle.get_comm_state() != actionlib.CommState.DONE:
        end_without(client.pub_goal)
        changed.wait(0.1)
        changed.clear()
    return handle


class Arm:
    def __init__(self):
        self.arm = client_of("arm_controller/follow_joint_trajectory", FollowJointTrajectoryAction)
        self.gripper = client_of("gripper_controller/gripper_cmd", GripperCommandAction)
        self.commanded = None  # place for which joints were commanded
        self.turn = 0.0

    def move(self, place):
        state = rospy.wait_for_message("joint_states", JointState)
        names = ["axis_%d" % k for k in range(1, 7)]
        ends = joints_for(place, self.turn)
        way = max(abs(end - state.position[state.name.index(name)]) for name, end in zip(names, ends))
        rest = [0.0] * len(names)
        # With velocities and accelerations, the way is a quintic, whose middle is 15/8 times as fast as its average.
        point = JointTrajectoryPoint(positions=ends, velocities=rest, accelerations=rest,
                                     time_from_start=rospy.Duration(max(0.5, 15 / 8 * way / SPEED)))
        goal = FollowJointTrajectoryGoal()
        goal.trajectory.joint_names, goal.trajectory.points = names, [point]
        end = outcome(self.arm, goal)
        if end.get_goal_status() != GoalStatus.SUCCEEDED:
            sys.exit("pick.py: the arm did not get there: " + end.get_goal_status_text())
        self.commanded = place

    def bring(self, thing, place, tolerance):
        """Move until a thing, the tool or what the gripper holds, stands at a place."""
        offset = (0, 0, 0)  # from where it stands to where it would be on a stiff arm
        if self.commanded:
            offset = [a - b for a, b in zip(self.commanded, thing.at_rest())]
        for _ in range(ATTEMPTS):
            if math.hypot(*offset) > LARGEST:
                sys.exit("pick.py: something else has moved the arm, or it has lost the block")
            self.move([a + b for a, b in zip(place, offset)])
            missing = [a - b for a, b in zip(place, thing.at_rest())]
            if math.hypot(*missing) < tolerance:
                return
            offset = [a + b for a, b in zip(offset, missing)]
        sys.exit("pick.py: after %d attempts, it is %.1f mm from its place" % (ATTEMPTS, 1e3 * math.hypot(*missing)))

    def grip(self, position):
        """Return whether the fingers got there; otherwise they have gripped something."""
        goal = GripperCommandGoal()
        goal.command.position, goal.command.max_effort = position, FORCE
        end = outcome(self.gripper, goal)
        result = end.get_result()
        if not result or not (result.reached_goal or result.stalled):
            sys.exit("pick.py: the gripper did not move: " + end.get_goal_status_text())
        return result.reached_goal


def above(place, height=ABOVE):
    return [place[0], place[1], place[2] + height]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--to", nargs=3, type=float, default=[0.5, 0.3, 0.34], metavar=("X", "Y", "Z"),
                        help="where the middle of the block shall stand [m] (on the shelf: 0.5 0.3 0.34)")
    to = parser.parse_args(rospy.myargv()[1:]).to
    rospy.init_node("pick")
    for place in (to, above(to)):
        joints_for(place, 0)  # ends the program if it is out of reach
    arm, tool, block = Arm(), Pose("sensors/tool"), Pose("sensors/block")

    start = block.at_rest()
    rospy.loginfo("the block stands at %.4f %.4f %.4f", *start)
    # The block has four equal sides: across the one to which the fingers turn least.
    side = math.atan2(start[1], start[0])
    arm.turn = side + math.remainder(block.turn - side, math.pi / 2)
    arm.grip(0.0)
    arm.bring(tool, above(start), ROUGH)
    rospy.loginfo("the hand stands %.1f mm from where a stiff arm would have it",
                  1e3 * math.dist(arm.commanded, tool.at_rest()))
    arm.bring(tool, start, EXACT)
    if arm.grip(CLOSED):
        sys.exit("pick.py: there is nothing between the fingers")
    arm.bring(tool, above(start), ROUGH)
    if block.at_rest()[2] < start[2] + ABOVE - 2 * ROUGH:
        sys.exit("pick.py: the block was not lifted")
    rospy.loginfo("the block is lifted; with it, %.1f mm", 1e3 * math.dist(arm.commanded, tool.at_rest()))
    arm.bring(block, above(to), ROUGH)
    arm.bring(block, above(to, GAP), EXACT)
    arm.grip(0.0)
    arm.bring(tool, above(to), ROUGH)
    end = block.at_rest()
    missing = math.dist(end, to)
    rospy.loginfo("the block stands at %.4f %.4f %.4f, %.1f mm from where it should be", *end, 1e3 * missing)
    if missing > FAR:
        sys.exit("pick.py: this is too far")


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        give_up()
