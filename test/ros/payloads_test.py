#!/usr/bin/python3
"""Tests that links are attached and detached, and that models come and go, while the node runs."""

import math
import os
import tempfile
import unittest

import rospy
import rostest
from flexarm.msg import JointForceCommand
from flexarm.srv import AttachLink, DeleteLink, DetachLink, SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from running_node import RunningNode
from simulated_arm import PATIENCE, CommandTopic, SimulatedArm, force_command, wait_until
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage

INERTIAL = """<inertial> <mass value="{0}"/> <inertia ixx="{1}" ixy="0" ixz="0" iyy="{1}" iyz="0" izz="{1}"/>
</inertial>"""
DISC = """<link name="disc">""" + INERTIAL.format(1, 0.1) + """</link>
<joint name="turn" type="continuous"> <parent link="base"/> <child link="disc"/> <axis xyz="0 0 1"/> </joint>"""
BOX = """<link name="box">""" + INERTIAL.format(0.5, 0.01) + """</link>
<joint name="of_box" type="floating"> <parent link="base"/> <child link="box"/> <origin xyz="1 0 0"/> </joint>"""
HOOK = """<link name="hook">""" + INERTIAL.format(1, 0.1) + """</link>
<joint name="screw" type="fixed"> <parent link="base"/> <child link="hook"/> </joint>"""
BALL = """<robot name="ball"> <link name="ball">""" + INERTIAL.format(2, 0.02) + """</link> </robot>"""

ALONE, TOGETHER = 0.1, 0.1 + 0.01 + 0.5  # inertia about the axis, of the disc alone and with the box [kg m^2]
SPEED = 2.0  # of the disc alone [rad/s]
ROUND_OFF = 1e-10


def scene(*parts):
    return ("<robot name='payloads'> <link name='base'/>" + "".join(parts) +
            "<simulation> <gravity xyz='0 0 0'/> <initial joint='turn' velocity='%g'/> </simulation> </robot>" % SPEED)


class Payloads(unittest.TestCase):
    def start(self, text, *arguments):
        self.scene = tempfile.NamedTemporaryFile("w", suffix=".urdf")
        self.scene.write(text)
        self.scene.flush()
        node = RunningNode("_scene:=" + self.scene.name, *arguments)
        node.__enter__()
        self.addCleanup(node.__exit__)
        self.output = node.output
        self.arm = SimulatedArm()
        self.attach = rospy.ServiceProxy("/flexarm/attach", AttachLink)
        self.detach = rospy.ServiceProxy("/flexarm/detach", DetachLink)
        self.spawn = rospy.ServiceProxy("/flexarm/spawn", SpawnModel)
        self.delete = rospy.ServiceProxy("/flexarm/delete", DeleteLink)

    def expect(self, answer):
        self.assertTrue(answer.success, answer.message)

    def refusal(self, answer):
        self.assertFalse(answer.success)
        return answer.message

    def test_a_box_is_taken_and_flies_on(self):
        self.start(scene(DISC, BOX), "_paused:=true")
        self.expect(self.attach("box", "disc"))
        self.assertEqual(self.arm.joint_states().name, ["turn"])
        speed = SPEED * ALONE / TOGETHER
        # The angular momentum is the same
        self.assertAlmostEqual(self.arm.joint("turn").velocity, speed, delta=ROUND_OFF)
        self.assertIn("is attached already", self.refusal(self.attach("box", "disc")))
        self.assertTrue(self.arm.step(500).success)
        angle = speed * 0.5
        self.assertAlmostEqual(self.arm.joint("turn").position, angle, delta=1e-6)
        self.expect(self.detach("box"))
        self.assertAlmostEqual(self.arm.joint("turn").velocity, speed, delta=1e-9)
        self.assertTrue(self.arm.step(1000).success)
        for axis, place in (("x", math.cos(angle) - speed * math.sin(angle)),
                            ("y", math.sin(angle) + speed * math.cos(angle))):
            self.assertAlmostEqual(self.arm.joint("of_box/" + axis).position, place, delta=1e-6)

    def speed_with_a_command(self, *parts):
        """Return the disc's speed after 1 s with the effort for 1 rad/s^2, less its speed right after the impact."""
        self.start(scene(*parts), "_paused:=true")
        CommandTopic("/turn/command", Float64).send(TOGETHER)
        wait_until(lambda: self.arm.step(1).success and self.arm.joint("turn").effort == TOGETHER, "the command")
        before = self.arm.joint("turn").velocity
        self.expect(self.attach("box", "disc"))
        self.assertTrue(self.arm.step(1000).success)
        return self.arm.joint("turn").velocity - before * ALONE / TOGETHER

    def test_what_is_commanded_goes_on(self):
        self.assertAlmostEqual(self.speed_with_a_command(DISC, BOX), 1, delta=1e-6)

    def test_what_is_commanded_goes_on_where_joints_get_other_places(self):
        self.assertAlmostEqual(self.speed_with_a_command(BOX, DISC), 1, delta=1e-6)

    def test_models_come_and_go(self):
        self.start(scene(DISC), "_paused:=true")
        pose, twist = Pose(Point(0, 0, 5), Quaternion()), Twist(Vector3(0, 0, 1), Vector3())
        self.expect(self.spawn(model_xml=BALL, prefix="my_", pose=pose, twist=twist))
        self.assertTrue(self.arm.step(100).success)
        self.assertAlmostEqual(self.arm.joint("my_ball/z").position, 5.1, delta=1e-9)
        self.assertAlmostEqual(self.arm.joint("turn").velocity, SPEED, delta=1e-9)
        self.expect(self.attach("my_ball", "disc"))
        self.expect(self.delete("my_ball"))
        self.assertEqual(self.arm.joint_states().name, ["turn"])
        self.assertIn("there is no link 'my_ball'", self.refusal(self.delete("my_ball")))
        self.assertIn("<mass>", self.refusal(self.spawn(model_xml=BALL.replace('value="2"', 'value="heavy"'))))
        self.assertIn("not by both or none", self.refusal(self.spawn(pose=pose)))
        self.assertTrue(self.arm.step(100).success)

    def test_warnings_of_models_are_told_but_not_that_they_are_clamped(self):
        self.start(scene(DISC), "_paused:=true")
        self.expect(self.spawn(model_xml=BALL.replace('izz="0.02"', 'izz="0.2"')))
        wait_until(lambda: "no body has a principal moment" in self.output(), "the warning")
        self.assertIn("ball/z", self.arm.joint_states().name)
        self.assertNotIn("clamped", self.output())

    def test_a_wrench_on_a_link_that_becomes_fixed_ends(self):
        self.start(scene(DISC, BOX))
        self.expect(self.arm.apply_wrench("disc", moment=(0, 0, 0.2)))
        self.expect(self.arm.apply_wrench("box", force=(1, 0, 0)))
        self.expect(self.attach("box", "base"))
        before = self.arm.status().time, self.arm.joint("turn").velocity
        wait_until(lambda: self.arm.status().time > before[0] + 0.1, "time to go on")
        self.assertGreater(self.arm.joint("turn").velocity, before[1])
        self.assertIn("fixed to the world", self.arm.apply_wrench("box", force=(1, 0, 0)).message)

    def test_a_file_is_relative_to_the_folder_of_the_scene(self):
        self.start(scene(DISC), "_paused:=true")
        with tempfile.NamedTemporaryFile("w", suffix=".urdf", dir=os.path.dirname(self.scene.name)) as ball:
            ball.write(BALL)
            ball.flush()
            self.expect(self.spawn(file=os.path.basename(ball.name)))
            self.expect(self.spawn(file=ball.name, prefix="second_"))
        self.assertIn("second_ball/x", self.arm.joint_states().name)
        answer = self.refusal(self.spawn(file="nothing.urdf"))
        self.assertIn(os.path.join(os.path.dirname(self.scene.name), "nothing.urdf: cannot be read"), answer)
        self.assertIn("package 'nobody'", self.refusal(self.spawn(file="package://nobody/ball.urdf")))

    def test_a_scene_that_is_a_text_has_no_folder(self):
        rospy.set_param("/robot_description", scene(DISC))
        self.addCleanup(rospy.delete_param, "/robot_description")
        self.start(scene(DISC), "_scene:=", "_paused:=true")
        self.assertIn("'ball.urdf' is a path relative to the folder of the scene's file, but the scene is the text of "
                      "'/robot_description'", self.refusal(self.spawn(file="ball.urdf")))

    def test_static_frames_that_move_are_static_no_more(self):
        self.start(scene(DISC, HOOK), "_paused:=true")

        def static_frames():
            message = rospy.wait_for_message("/tf_static", TFMessage, PATIENCE)
            return [transform.child_frame_id for transform in message.transforms]

        self.assertEqual(static_frames(), ["hook"])
        self.expect(self.detach("hook"))
        self.assertEqual(static_frames(), [])
        frames = rospy.wait_for_message("/tf", TFMessage, PATIENCE).transforms
        self.assertIn("hook", [transform.child_frame_id for transform in frames])

    def test_in_lock_step_each_message_makes_its_step_whoever_goes(self):
        self.start(scene(DISC, BOX), "_lock_step:=true", "_paused:=true")
        force = CommandTopic("/joint_force_command", JointForceCommand)
        for effort in (0.1, 0.2):
            force.send(force_command(["of_box/x", "turn"], [1.0, effort]))
        force.send(force_command(["of_box/x"], [2.0]))
        force.send(force_command(["nobody"], [0.0]))  # the topic's messages come in order
        wait_until(lambda: "no joint coordinate 'nobody'" in self.output(), "the refusal of the last message")
        before = self.arm.status().steps
        self.expect(self.delete("box"))
        self.arm.resume()
        wait_until(lambda: self.arm.status().steps == before + 3, "the three steps")
        self.assertEqual(self.arm.joint("turn").effort, 0.2)

    def test_frames_follow_while_it_runs(self):
        self.start(scene(DISC, BOX))
        self.expect(self.spawn(model_xml=BALL, pose=Pose(Point(0, 0, 5), Quaternion())))
        frames = {}

        def receive(message):
            for transform in message.transforms:
                frames[transform.child_frame_id] = transform.header.frame_id

        subscriber = rospy.Subscriber("/tf", TFMessage, receive)
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: {"disc", "box", "ball"} <= set(frames), "all frames")
        self.expect(self.delete("ball"))
        self.expect(self.attach("box", "disc"))
        frames.clear()
        wait_until(lambda: "disc" in frames, "frames of now")
        self.assertNotIn("ball", frames)


if __name__ == "__main__":
    rospy.init_node("payloads_test")
    rostest.rosrun("flexarm", "payloads", Payloads)
