#!/usr/bin/python3
"""Tests two arms under one master: each has its own topics, services and frames, and both have one clock."""

import unittest

import rospy
import rostest
from flexarm.msg import BeamStateArray, JointForceCommand, SimulatorStatus
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from simulated_arm import PATIENCE, CommandTopic, SimulatedArm, force_command, wait_until
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

LINKS = ["upper_arm", "upper_arm/tip", "forearm", "forearm/tip", "payload"]


class TwoArms(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.parents = {}  # parent frames by (publisher, frame)
        cls.warnings = []
        for topic in ("/tf", "/tf_static"):
            rospy.Subscriber(topic, TFMessage, cls.receive_transforms, queue_size=100)
        rospy.Subscriber("/rosout_agg", Log, cls.receive_log)
        cls.left, cls.right = SimulatedArm("/left"), SimulatedArm("/right")

    @classmethod
    def receive_transforms(cls, message):
        publisher = message._connection_header["callerid"]
        for transform in message.transforms:
            cls.parents[publisher, transform.child_frame_id] = transform.header.frame_id

    @classmethod
    def receive_log(cls, log):
        if log.level >= Log.WARN:
            cls.warnings.append(log.msg)

    def test_frames_do_not_collide_and_hang_together(self):
        for arm in (self.left, self.right):
            self.assertTrue(arm.step(1).success)
        wanted = {
            ("/%s/flexarm" % side, "%s/%s" % (side, link)) for side in ("left", "right") for link in LINKS
        } | {("/left_place", "left/world"), ("/right_place", "right/world")}
        wait_until(lambda: wanted <= set(self.parents), "all frames")
        frames = [frame for _, frame in self.parents]
        self.assertEqual(sorted(frames), sorted(set(frames)), "a frame has two publishers")
        for (publisher, frame), parent in self.parents.items():
            if publisher.startswith("/other/"):
                continue
            if frame in ("left/world", "right/world"):
                self.assertEqual(parent, "world")
            else:
                self.assertEqual(parent.split("/")[0], frame.split("/")[0])
        self.assertEqual(self.warnings, [])

    def test_every_message_names_frames_with_the_prefix(self):
        for side in ("left", "right"):
            status = rospy.wait_for_message("/%s/flexarm/status" % side, SimulatorStatus, PATIENCE)
            beams = rospy.wait_for_message("/%s/beam_states" % side, BeamStateArray, PATIENCE)
            markers = rospy.wait_for_message("/%s/beam_markers" % side, MarkerArray, PATIENCE)
            names = {status.header.frame_id, beams.header.frame_id, *(m.header.frame_id for m in markers.markers)}
            self.assertEqual(names, {side + "/world"})
            self.assertEqual(rospy.get_param("/%s/flexarm/view/frame" % side), side + "/world")

    def test_arguments_of_the_launch_file_reach_both(self):
        for arm in (self.left, self.right):
            status = arm.status()
            self.assertEqual((status.scheme, status.step), ("m2", 0.002))
            self.assertEqual(rospy.get_param(arm.namespace + "/flexarm/status_rate"), 20)

    def test_a_command_reaches_one_arm_only(self):
        for arm in (self.left, self.right):
            arm.reset()
        force = CommandTopic("/right/joint_force_command", JointForceCommand)
        force.send(force_command(["elbow"], [7.0]))

        def arrived():
            self.assertTrue(self.left.step(1).success and self.right.step(1).success)
            return self.right.joint("elbow").effort == 7.0

        wait_until(arrived, "the effort")
        self.assertNotEqual(self.left.joint("elbow").effort, 7.0)

    def test_the_left_arm_is_the_clock_of_both(self):
        self.assertTrue(rospy.get_param("/use_sim_time"))
        self.assertTrue(self.left.step(500).success)
        stamp = self.left.joint_states().header.stamp
        self.assertGreaterEqual(stamp.to_sec(), 1)

        def right_follows():
            self.assertTrue(self.right.step(1).success)
            return self.right.joint_states().header.stamp == stamp

        wait_until(right_follows, "the right arm to take over the clock")
        self.assertEqual(rospy.get_rostime(), stamp)

    def test_another_robot_has_its_robot_state_publisher(self):
        states = CommandTopic("/other/joint_states", JointState)

        def has_frames():
            self.assertTrue(self.left.step(1).success)  # also the clock of the other robot
            message = JointState(name=["shoulder", "elbow"], position=[0.1, 0.2])
            message.header.stamp = rospy.get_rostime()
            states.send(message)
            publisher = "/other/robot_state_publisher"
            if (publisher, "upper_arm") in self.parents:
                self.skipTest("this robot_state_publisher has no tf_prefix (1.15.0 and 1.15.1 do not)")
            return {(publisher, "other/upper_arm"), (publisher, "other/forearm")} <= set(self.parents)

        wait_until(has_frames, "its frames")
        frames = [frame for _, frame in self.parents]
        self.assertEqual(sorted(frames), sorted(set(frames)), "a frame has two publishers")
        self.assertEqual(self.warnings, [])


if __name__ == "__main__":
    rospy.init_node("namespaces_test")
    rostest.rosrun("flexarm", "namespaces", __name__)
