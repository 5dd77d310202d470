#!/usr/bin/python3
"""Tests that the scene is reloaded while the node runs: joints, links and sensors come and go, and time continues."""

import tempfile
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from running_node import RunningNode
from sensor_msgs.msg import JointState
from simulated_arm import CommandTopic, SimulatedArm, wait_until
from std_msgs.msg import Float64
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

BODY = """<link name="{0}_body"> <inertial> <mass value="1"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/> </inertial> </link>
<joint name="{0}" type="continuous"> <parent link="base"/> <child link="{0}_body"/> <axis xyz="0 0 1"/> </joint>"""
BEAM = """<link name="rod"> <beam> <centerline> <line to="1 0 0"/> </centerline> <circle radius="0.01"/>
  <material young="70e9" poisson="0.3" density="2700"/> </beam> </link>
<joint name="clamp" type="fixed"> <parent link="base"/> <child link="rod"/> </joint>"""

SENSOR = '<sensor name="eye" kind="pose" link="first_body" rate="50"/>'


def scene(*joints, more="", simulation=""):
    return ("<robot name='changing'> <link name='base'/>" + "".join(map(BODY.format, joints)) + more +
            "<simulation> <gravity xyz='0 0 0'/>" + simulation + "</simulation> </robot>")


class Scene:
    """A scene file that can be rewritten."""

    def __init__(self, text):
        self.file = tempfile.NamedTemporaryFile("w", suffix=".urdf")
        self.write(text)

    def write(self, text):
        self.file.seek(0)
        self.file.truncate()
        self.file.write(text)
        self.file.flush()


class Log:
    def __init__(self, topic, message_type):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, message_type, self.messages.append, queue_size=1000)

    def names(self):
        return self.messages[-1].name if self.messages else []


class Reload(unittest.TestCase):
    def setUp(self):
        self.scene = Scene(scene("first", "second"))

    def start(self, *arguments, namespace=""):
        node = RunningNode("_scene:=" + self.scene.file.name, *arguments)
        self.node = node.__enter__()
        self.addCleanup(node.__exit__)
        self.arm = SimulatedArm()
        self.states = Log("/joint_states", JointState)
        # Otherwise the next test's subscriber would share its connection
        self.addCleanup(self.states.subscriber.unregister)
        wait_until(lambda: self.states.names() == ["first", "second"], "both joints")

    def reload(self, text):
        self.scene.write(text)
        answer = self.arm.reload()
        self.assertTrue(answer.success, answer.message)
        self.assertIn("changing", answer.message)

    def turn(self, joint):
        """Command the joint by its own topic until it turns."""
        topic = CommandTopic("/" + joint + "/command", Float64)
        topic.send(0.5)

        def turns():
            states = self.states.messages[-1]
            return states.velocity[states.name.index(joint)] > 1e-3

        wait_until(turns, joint + " to turn")

    def assert_time_goes_on(self):
        stamps = [message.header.stamp for message in self.states.messages]
        self.assertEqual(stamps, sorted(set(stamps)))

    def test_joints_come_and_go_while_it_runs(self):
        self.start()
        self.turn("first")
        self.reload(scene("second", "third"))
        wait_until(lambda: self.states.names() == ["second", "third"], "the other joints")
        self.assertEqual(max(map(abs, self.states.messages[-1].velocity)), 0)  # no earlier command acts
        self.turn("third")
        wait_until(lambda: self.states.messages[-1].velocity[0] == 0, "the second one at rest")
        # The node has no subscription for the removed joint.
        _, subscriptions, _ = rosgraph.Master("/reload_test").getSystemState()
        self.assertNotIn("/first/command", dict(subscriptions))
        self.assertIn("/third/command", dict(subscriptions))
        self.assert_time_goes_on()
        frames = rospy.wait_for_message("/tf", TFMessage)
        self.assertEqual({t.child_frame_id for t in frames.transforms}, {"second_body", "third_body"})

    def test_paused_it_stays_paused_and_each_stamp_is_sent_once(self):
        self.start("_paused:=true")
        self.reload(scene("first", "third"))
        wait_until(lambda: self.states.names() == ["first", "third"], "the other joints")
        self.assertTrue(self.arm.step(5).success)
        wait_until(lambda: len(self.states.messages) >= 3, "the state after the steps")
        self.assertTrue(self.arm.status().paused)
        self.assert_time_goes_on()

    def test_sensors_and_markers_follow(self):
        self.start()
        markers = Log("/beam_markers", MarkerArray)
        self.reload(scene("first", more=BEAM + SENSOR))
        rospy.wait_for_message("/sensors/eye", PoseStamped, 10)
        wait_until(lambda: markers.messages and markers.messages[-1].markers[0].ns == "rod", "the markers of the rod")
        self.reload(scene("first", "second"))
        wait_until(lambda: any(message.markers[0].action == Marker.DELETEALL for message in markers.messages[1:]),
                   "the markers to be taken away")
        wait_until(lambda: "/sensors/eye" not in dict(rospy.get_published_topics()), "the sensor to be gone")

    def test_a_bad_scene_leaves_the_good_one(self):
        self.start()
        self.turn("first")
        for text, told in (("<robot", self.scene.file.name),
                           (scene("first", more="<link name='nobody'/>"), "nobody"),
                           (scene("first", simulation="<integrator scheme='nonsense'/>"), "nonsense")):
            self.scene.write(text)
            answer = self.arm.reload()
            self.assertFalse(answer.success)
            self.assertIn(told, answer.message)
            self.assertEqual(self.states.names(), ["first", "second"])
        before = self.states.messages[-1]
        wait_until(lambda: self.states.messages[-1].position[0] > before.position[0], "the first one to turn on")
        self.assertIn("~reload: the scene was not changed", self.node.output())
        self.scene.file.close()
        self.assertFalse(self.arm.reload().success)

    def test_from_the_parameter_server(self):
        rospy.set_param("/robot_description", scene("first", "second"))
        self.addCleanup(rospy.delete_param, "/robot_description")
        self.start("_scene:=")
        rospy.set_param("/robot_description", scene("first", "second", "third"))
        answer = rospy.ServiceProxy("/flexarm/reload", Trigger)()
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.states.names() == ["first", "second", "third"], "the third joint")

    def test_parameters_of_the_scene_are_read_again(self):
        self.scene.write(scene("first", "second", more='<parameter name="angle" value="0.25" max="1"/>',
                               simulation='<initial joint="first" position="${angle}"/>'))
        self.start("_parameters/angle:=0.5")
        self.assertEqual(self.states.messages[-1].position[0], 0.5)
        for angle in (0.75, 1):  # integers are accepted, too
            rospy.set_param("/flexarm/parameters/angle", angle)
            self.assertTrue(self.arm.reload().success)
            wait_until(lambda: self.states.messages[-1].position[0] == angle, "the angle that is set")
        for name, value, told in (("/angle", 2, "must be at most 1, got '2'"),
                                  ("/angle", "wide", "/flexarm/parameters/angle: must be a number"),
                                  ("/angle", True, "/flexarm/parameters/angle: must be a number"),
                                  ("", {"length": 1}, "a parameter must be one of angle, got 'length'"),
                                  ("", [1], "/flexarm/parameters: must be a dictionary of numbers")):
            rospy.set_param("/flexarm/parameters" + name, value)
            answer = self.arm.reload()
            self.assertFalse(answer.success)
            self.assertIn(told, answer.message)
            rospy.delete_param("/flexarm/parameters")
        self.assertTrue(self.arm.reload().success)
        wait_until(lambda: self.states.messages[-1].position[0] == 0.25, "the scene's own angle")

    def test_after_a_failure_it_begins_anew(self):
        self.start("_max_halvings:=0")
        CommandTopic("/first/command", Float64).send(1e250)
        wait_until(lambda: self.arm.status().failed, "the failure")
        self.reload(scene("first", "second"))
        self.assertFalse(self.arm.status().failed)
        self.arm.resume()
        self.turn("second")


if __name__ == "__main__":
    rospy.init_node("reload_test")
    rostest.rosrun("flexarm", "reload", Reload)
