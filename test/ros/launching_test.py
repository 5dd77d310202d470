#!/usr/bin/python3
"""Tests simulate.launch in a user's folder: relative paths, a parameter file, and messages at the start."""

import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
from flexarm.msg import SimulatorStatus
from simulated_arm import PATIENCE, wait_until

SCENE = """<robot name="arm"> <link name="world"/>
<parameter name="mass" value="1" min="0.5"/>
<joint name="shoulder" type="revolute"> <parent link="world"/> <child link="boom"/> <axis xyz="0 1 0"/>
  <limit lower="-2" upper="2" effort="10" velocity="1"/> </joint>
<link name="boom"> <inertial> <mass value="${mass}"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/> </inertial> </link>
<joint name="elbow" type="continuous"> <parent link="boom"/> <child link="rod"/> <origin xyz="1 0 0"/>
  <axis xyz="0 1 0"/> </joint>
<link name="rod"> <beam> <centerline> <line to="1 0 0"/> </centerline> <circle radius="0.01"/>
  <material young="70e9" poisson="0.3" density="2700"/> </beam> </link>
<servo joint="shoulder" mode="position" kp="100" kd="10"/> <servo joint="elbow" mode="position" kp="100" kd="10"/>
</robot>"""
CONFIG = """
publish_rate: 50
real_time_factor: 0.5
command_timeout: 0.25
tolerance: 1.0e-9
start: clamp
parameters: {mass: 2.5}
controllers:
  - {name: arm_controller, action_ns: follow_joint_trajectory, type: FollowJointTrajectory, joints: [shoulder]}
"""
CONTROLLERS = """
controller_list:
  - {name: elbow_controller, action_ns: follow, type: FollowJointTrajectory, joints: [elbow]}
"""
# A stand-in for xacro, which prints its arguments.
XACRO = """#!/bin/sh
echo "$@" >&2
case "$*" in *broken*) echo "undefined macro: left_arm" >&2; exit 2;; esac
sed "s/SIDE/${2#side:=}/" "$1"
"""


class Launched:
    """Runs roslaunch in a folder, with the test's master, until the `with` block ends."""

    def __init__(self, folder, *arguments, path=None, display=None):
        self.log = tempfile.NamedTemporaryFile("r", suffix=".log")
        environment = dict(os.environ, PWD=folder, PATH=path or os.environ["PATH"])
        if display is not None:
            environment["DISPLAY"] = display
        with open(self.log.name, "w", encoding="utf-8") as output:
            self.process = subprocess.Popen(["roslaunch", "flexarm", "simulate.launch", *arguments], cwd=folder,
                                            env=environment, stdout=output, stderr=subprocess.STDOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.wait(30)
        self.log.close()

    def output(self):
        self.log.seek(0)
        return self.log.read()

    def output_at_end(self):
        self.process.wait(30)
        return self.output()


class Launching(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        for name, text in (("arm.urdf", SCENE), ("arm.yaml", CONFIG), ("controllers.yaml", CONTROLLERS),
                           ("arm.urdf.xacro", SCENE.replace('"arm"', '"SIDE_arm"'))):
            with open(os.path.join(self.folder.name, name), "w", encoding="utf-8") as file:
                file.write(text)
        self.addCleanup(self.folder.cleanup)

    def launch(self, *arguments, **options):
        return Launched(self.folder.name, *arguments, **options)

    def xacro_on_path(self):
        programs = os.path.join(self.folder.name, "bin")
        os.mkdir(programs)
        program = os.path.join(programs, "xacro")
        with open(program, "w", encoding="utf-8") as file:
            file.write(XACRO)
        os.chmod(program, 0o755)
        return programs + ":" + os.environ["PATH"]

    def wait_for_status(self):
        return rospy.wait_for_message("/flexarm/status", SimulatorStatus, PATIENCE)

    def test_a_file_of_parameters(self):
        rospy.set_param("/flexarm/publish_rate", 7)  # set by an earlier run; it must be cleared
        rospy.set_param("/flexarm/stop_duration", 7)
        with self.launch("scene:=arm.urdf", "config:=arm.yaml", "headless:=true", "real_time_factor:=2",
                         "status_rate:=20") as launched:
            self.wait_for_status()
            node = rospy.get_param("/flexarm")
            self.assertEqual(node["publish_rate"], 50)
            self.assertEqual(node["real_time_factor"], 2)  # the command line has priority
            self.assertEqual(node["command_timeout"], 0.25)
            self.assertEqual(node["parameters"], {"mass": 2.5})
            self.assertNotIn("stop_duration", node)
            self.assertEqual(node["scene"], os.path.join(self.folder.name, "arm.urdf"))
            wait_until(lambda: rospy.get_published_topics("/arm_controller"), "the controller")
            wait_until(lambda: "unknowns" in launched.output(), "the announcement")
            said = launched.output()
            self.assertRegex(said, r"scene 'arm' of \S+/arm.urdf: joints shoulder, elbow; \d+ unknowns")
            self.assertNotIn("does not know", said)  # neither names of the launch file nor what the node sets
            self.assertRegex(said, r"scheme \w+, step 0.001 s; topics in /, services in /flexarm")
            # As the table of `flexarm check`: the rod has no hub.
            wait_until(lambda: re.search(r"shake joints .* if they damp by more than, in N m s/rad: elbow [0-9.]+ \(",
                                         launched.output()), "the advice for controllers")

    def test_a_file_of_controllers(self):
        with self.launch("scene:=arm.urdf", "controllers:=controllers.yaml", "headless:=true"):
            self.wait_for_status()
            wait_until(lambda: rospy.get_published_topics("/elbow_controller/follow"), "the controller")

    def test_misspelt_parameters_are_told(self):
        with open(os.path.join(self.folder.name, "misspelt.yaml"), "w", encoding="utf-8") as file:
            file.write(CONFIG + "publish_rte: 500\nof_others: {a: 1}\n")
        with self.launch("scene:=arm.urdf", "config:=misspelt.yaml", "headless:=true") as launched:
            wait_until(lambda: "unknowns" in launched.output(), "the announcement")
            said = launched.output()
        self.assertEqual(said.count("does not know"), 1)
        self.assertIn("\n/flexarm/of_others\n/flexarm/publish_rte; did you mean 'publish_rate'?", said)

    def test_doubts_are_said_as_flexarm_check_says_them(self):
        scene = os.path.join(self.folder.name, "sampled.urdf")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE.replace('<servo joint="elbow"', '<servo joint="elbow" sample_time="0.001"'))
        checked = subprocess.run(["rosrun", "flexarm", "flexarm", "check", scene],
                                 stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, universal_newlines=True, check=True)
        warnings = [line.rpartition("warning: ")[2] for line in checked.stderr.splitlines()]
        self.assertTrue(any("sampled servos may shake" in line for line in warnings), checked.stderr)
        with self.launch("scene:=sampled.urdf", "headless:=true") as launched:
            for line in warnings:
                wait_until(lambda: line in launched.output(), line)

    def test_a_scene_that_is_not_there(self):
        with self.launch("scene:=none.urdf", "headless:=true") as launched:
            said = launched.output_at_end()
            self.assertIn("scene %s/none.urdf: No such file or directory" % self.folder.name, said)
            self.assertNotIn("Traceback", said)

    def test_an_error_of_the_scene_has_no_traceback(self):
        with open(os.path.join(self.folder.name, "arm.urdf"), "w", encoding="utf-8") as file:
            file.write(SCENE.replace('young="70e9"', 'young="stiff"'))
        with self.launch("scene:=arm.urdf", "rviz:=true") as launched:
            said = launched.output_at_end()
            self.assertIn(self.folder.name + "/arm.urdf:10: <material> of beam 'rod'", said)
            self.assertIn("got 'stiff'", said)
            self.assertNotIn("Traceback", said)

    def test_without_rviz_or_a_display_it_says_what_to_do(self):
        for display, fault in (("", "DISPLAY is not set"), (":987", "the display :987 cannot be opened")):
            if shutil.which("rviz") is None:
                fault = "it is not installed"
            with self.launch("scene:=arm.urdf", display=display) as launched:
                wait_until(lambda: "rviz cannot start: " in launched.output(), "the reason", 30)
                wait_until(lambda: "with web:=true" in launched.output(), "the advice")
                self.assertIn(fault, launched.output())
                self.assertIn("With headless:=true", launched.output())
                self.assertNotIn("Traceback", launched.output())
                self.wait_for_status()  # the simulation goes on

    def test_xacro(self):
        with self.launch("scene:=arm.urdf.xacro", "xacro_args:=side=left mirrored=true", "headless:=true",
                         path=self.xacro_on_path()) as launched:
            self.wait_for_status()
            self.assertIn('<robot name="left_arm">', rospy.get_param("/robot_description"))
            wait_until(lambda: "scene 'left_arm'" in launched.output(), "the announcement")
            # The stand-in prints its arguments.
            told = "xacro says: %s/arm.urdf.xacro side:=left mirrored:=true" % self.folder.name
            self.assertIn(told, launched.output())

    def test_xacro_that_fails(self):
        with self.launch("scene:=arm.urdf.xacro", "xacro_args:=broken=true", "headless:=true",
                         path=self.xacro_on_path()) as launched:
            self.assertIn("undefined macro: left_arm", launched.output_at_end())

    def test_the_command_line_runs_xacro(self):
        path, scene = self.xacro_on_path(), os.path.join(self.folder.name, "arm.urdf.xacro")

        def check(*arguments, path=path):
            program = subprocess.run(["rosrun", "flexarm", "flexarm", "check", *arguments], stderr=subprocess.STDOUT,
                                     stdout=subprocess.PIPE, universal_newlines=True, check=False,
                                     env=dict(os.environ, PATH=path))
            return program.stdout

        self.assertIn("scene 'right_arm'", check(scene, "--xacro-args", "side:=right"))
        self.assertIn(scene + ": xacro ended with status 2: ", check(scene, "--xacro-args", "broken=1"))
        self.assertIn("takes no arguments of xacro, as its name does not end with .xacro, got 'a:=1'",
                      check(os.path.join(self.folder.name, "arm.urdf"), "--xacro-args", "a:=1"))
        with open(scene, "a", encoding="utf-8") as file:
            file.write("<!-- not raw -->")
        # Without xacro, the text is read as it is
        self.assertIn("scene 'SIDE_arm'", check(scene, path=os.environ["PATH"]))
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE.replace('value="${mass}"', 'value="$(arg mass)"'))
        self.assertIn("this is xacro and must be expanded to URDF first", check(scene, path=os.environ["PATH"]))


if __name__ == "__main__":
    rospy.init_node("launching_test")
    rostest.rosrun("flexarm", "launching", __name__)
