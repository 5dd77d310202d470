#!/usr/bin/python3
"""Tests that the node ends with status 1 and a message if a scene or parameter cannot be used."""

import os
import subprocess
import tempfile
import unittest

import rospy
import rostest

HERE = os.path.dirname(os.path.abspath(__file__))
GOOD_SCENE = os.path.join(HERE, "two_arms.urdf")


def run_node(*arguments):
    return subprocess.run(
        ["rosrun", "flexarm", "flexarm_node", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        universal_newlines=True,
        timeout=100,
        check=False,
    )


class BadScenes(unittest.TestCase):
    def setUp(self):
        if rospy.has_param("/flexarm"):  # private parameters outlive their node
            rospy.delete_param("/flexarm")

    def assert_refused(self, arguments, *words):
        result = run_node(*arguments)
        self.assertEqual(result.returncode, 1, result.stdout)
        for word in words:
            self.assertIn(word, result.stdout)

    def test_no_scene(self):
        self.assert_refused([], "robot_description")

    def test_missing_file(self):
        self.assert_refused(["_scene:=/nowhere/scene.urdf"], "/nowhere/scene.urdf")

    def test_every_error_of_a_file_is_reported(self):
        with open(GOOD_SCENE, encoding="utf-8") as file:
            text = file.read()
        text = text.replace('outer_radius="0.02"', 'outer_radius="-0.02"').replace('young="70e9"', 'young="stiff"')
        with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
            file.write(text)
            file.flush()
            self.assert_refused(["_scene:=" + file.name], file.name, "outer_radius", "stiff")

    def test_text_that_is_no_scene(self):
        rospy.set_param("/robot_description", "hello")
        try:
            self.assert_refused([], "robot_description")
        finally:
            rospy.delete_param("/robot_description")

    def test_unknown_scheme(self):
        self.assert_refused(["_scene:=" + GOOD_SCENE, "_scheme:=bogus"], "bogus")

    def test_every_bad_parameter_is_reported(self):
        bad = ["_publish_rate:=0", "_real_time_factor:=-1", "_max_catch_up:=often"]
        self.assert_refused(["_scene:=" + GOOD_SCENE, *bad], "publish_rate", "real_time_factor", "max_catch_up")

    def test_every_bad_parameter_of_the_integrator_is_reported(self):
        self.assert_refused(["_scene:=" + GOOD_SCENE, "_step:=0", "_tolerance:=x"], "step", "tolerance")

    def test_an_option_that_the_scheme_does_not_have(self):
        options = ["_scene:=" + GOOD_SCENE, "_scheme:=newmark", "_rho_infinity:=0.5"]
        self.assert_refused(options, "rho_infinity", "edmc1")

    def test_choices(self):
        self.assert_refused(["_scene:=" + GOOD_SCENE, "_start:=lock", "_massless:=clamp"], "'clamp'", "'lock'")

    def test_parameters_of_the_scene(self):
        self.assert_refused(["_scene:=" + GOOD_SCENE, "_parameters/mass:=2"], "it has no <parameter>, got 'mass'")
        self.setUp()
        self.assert_refused(["_scene:=" + GOOD_SCENE, "_parameters/mass:=heavy", "_start:=lock"],
                            "/flexarm/parameters/mass: must be a number", "'clamp'")
        self.setUp()
        self.assert_refused(["_scene:=" + GOOD_SCENE, "_parameters:=5"], "must be a dictionary of numbers")

    def refuse_changes(self, entry, changes):
        """Check all changes in one list, since each error is reported. `changes`: pairs of a changed entry and the
        expected text of its error."""
        entries = [dict(entry, name="%s%d" % (entry["name"], i)) for i in range(1, len(changes) + 1)]
        told = ["entry %d ('%s'): " % (i, one["name"]) for i, one in enumerate(entries, 1)]
        self.refuse_controllers([dict(one, **change) for one, (change, _) in zip(entries, changes)],
                                *told, *(text for _, text in changes))

    def refuse_controllers(self, controllers, *words):
        self.setUp()
        rospy.set_param("/flexarm/controllers", controllers)
        scene = os.path.join(HERE, "controllers_bench.urdf")
        self.assert_refused(["_scene:=" + scene], "controllers that cannot be used", *words)

    def test_controllers(self):
        good = {"name": "arm", "action_ns": "follow", "type": "FollowJointTrajectory", "joints": ["lift"]}
        gripper = {"name": "hand", "action_ns": "", "type": "GripperCommand", "joints": ["left", "right"]}
        self.refuse_controllers(5, "/flexarm/controllers: must be a list of controllers")
        self.refuse_controllers({"controller_list": {}}, "/flexarm/controllers/controller_list: must be a list")
        self.refuse_controllers([good, 7], "/flexarm/controllers, entry 2: must be a dictionary with name")
        fields = "name", "action_ns", "type", "joints"
        self.refuse_controllers([{key: good[key] for key in good if key != field} for field in fields],
                                *("it has no '%s'" % field for field in fields))
        self.refuse_changes(good, (({"joints": ["nose"]}, "there is no joint coordinate 'nose'; the scene has "),
                                   ({"joints": ["turn", "turn"]}, "joint 'turn' is named twice"),
                                   ({"joints": []}, "with one at least"),
                                   ({"joints": ["lift", 5]}, "must be a list of names"),
                                   ({"joints": ["loose"]}, "'loose' has no servo"),
                                   ({"joints": ["right"]}, "right"),
                                   ({"type": "Follow"}, "or 'GripperCommand', got 'Follow'")))
        self.refuse_controllers([dict(good, name=5), dict(good, name="a b")], "its 'name' must be text",
                                "'a b/follow' is not a name of an action")
        self.refuse_controllers([good, dict(good, name="other")],
                                "entry 2 ('other'): joint 'lift' is named twice, in 'arm' as well")
        self.refuse_controllers([good, dict(good, joints=["turn"])], "another controller has the action 'arm/follow'")
        self.refuse_changes(gripper, (({"joints": ["left", "lift", "turn"]}, "one joint or two, got 3"),
                                      ({"joints": ["left"], "parallel": True}, "'parallel' is for two joints"),
                                      ({"parallel": "yes"}, "its 'parallel' must be true or false"),
                                      ({"max_effort": -1.0}, "its 'max_effort' must be a number >= 0"),
                                      ({"stall_timeout": "long"}, "its 'stall_timeout' must be a number >= 0"),
                                      ({"command_joint": "lift"},
                                       "'command_joint' is not one of its joints, got 'lift'")))

    def test_every_error_of_controllers_is_reported(self):
        self.refuse_controllers([{"name": "arm", "type": "FollowJointTrajectory"},
                                 {"name": "hand", "action_ns": "grip", "type": "GripperCommand", "joints": ["thumb"]}],
                                "entry 1 ('arm'): it has no 'joints'", "it has no 'action_ns'", "'thumb'")

    def test_a_frame_prefix_with_a_leading_slash(self):
        self.assert_refused(["_scene:=" + GOOD_SCENE, "_frame_prefix:=/left"], "frame_prefix", "/left")


if __name__ == "__main__":
    rospy.init_node("bad_scenes_test")
    rostest.rosrun("flexarm", "bad_scenes", __name__)
