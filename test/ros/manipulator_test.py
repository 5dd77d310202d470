#!/usr/bin/python3
"""Tests that the cylindrical manipulator moves under commands as it does under the loads of its scene."""

import csv
import os
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from flexarm.msg import JointForceCommand
from simulated_arm import CommandTopic, SimulatedArm, force_command

COORDINATES = ["r", "guide/1", "guide/2"]
EVERY = 0.01  # s, duration of each constant effort
STEP = 0.001  # s, the scene's step

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
from demo_commands import expand  # noqa: E402


def positions_under_the_scenes_own_loads():
    scene = rospy.get_param("/flexarm/scene")
    with tempfile.NamedTemporaryFile(suffix=".csv") as output:
        subprocess.run(
            ["rosrun", "flexarm", "flexarm", "simulate", scene, "--until", "1.5", "--quiet", "--output", output.name],
            check=True,
        )
        with open(output.name, newline="", encoding="utf-8") as file:
            last = list(csv.DictReader(file))[-1]
    return [float(last["joint/%s/position" % name]) for name in COORDINATES]


class Manipulator(unittest.TestCase):
    """The simulation is paused and steps are made by hand, so that nothing depends on timing."""

    def test_commands_do_what_loads_do(self):
        arm = SimulatedArm()
        topic = CommandTopic("joint_force_command", JointForceCommand)
        commands = rospy.get_param("~commands")
        for command in commands:
            command["every"] = EVERY
        arm.reset()
        pulses = expand(commands)
        self.assertEqual(len(pulses), 150)
        late = 0
        for _, command in pulses:
            topic.send(force_command(command["names"], command["efforts"]))
            done = 0
            while arm.joint("r").effort != command["efforts"][0] or done == 0:
                self.assertLess(done, round(EVERY / STEP), "the command has not arrived")
                self.assertTrue(arm.step(1).success)
                done += 1
            late += done - 1
            self.assertTrue(arm.step(round(EVERY / STEP) - done).success)
        self.assertAlmostEqual(arm.status().time, 1.5, delta=1e-9)
        self.assertFalse(arm.status().failed)
        # The efforts are constant over pulses, with the mean of the linear efforts: an error of the square of the
        # pulse. If a command is late, the last one acts for a step more. The remaining error is far smaller than the
        # travel, 0.4 m, 0.3 m and 1.4 rad.
        self.assertLess(late, 300)
        for name, expected in zip(COORDINATES, positions_under_the_scenes_own_loads()):
            self.assertAlmostEqual(arm.joint(name).position, expected, delta=0.02, msg=name)


if __name__ == "__main__":
    rospy.init_node("manipulator_test")
    rostest.rosrun("flexarm", "manipulator", __name__)
