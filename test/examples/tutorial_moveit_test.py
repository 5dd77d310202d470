#!/usr/bin/python3
"""Test the commands of the tutorial about MoveIt, typed as they stand there: `tutorial_moveit_test.py SETUP`."""

import os
import re
import socket
import sys
import tempfile
import unittest

from typed_commands import commands_of, type_commands


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class TutorialMoveit(unittest.TestCase):
    def test_commands(self):
        commands = commands_of("tutorial_moveit.md")
        self.assertEqual(len(commands), 3)
        with tempfile.TemporaryDirectory() as folder:
            os.environ.update(ROS_HOSTNAME="localhost", ROS_HOME=os.path.join(folder, "ros"),
                              ROS_MASTER_URI="http://localhost:%d" % free_port())
            status, printed = type_commands(commands, SETUP, folder)
            self.assertEqual(status, 0)
        for action in ("/arm_controller/follow_joint_trajectory/goal", "/gripper_controller/gripper_cmd/goal",
                       "/follow_joint_trajectory/goal", "arm: there"):
            self.assertIn(action, printed)
        # 0.5 m sin(0.5) + 0.3 m sin(0.5 + 0.3)
        self.assertAlmostEqual(float(re.search(r"block: (\S+) m aside", printed).group(1)), 0.455, delta=0.011)
        grips = re.findall(r"gripper: at (\S+) m, (\S+) N, stalled: (\w+), reached: (\w+)", printed)
        self.assertEqual([grip[2:] for grip in grips], [("False", "True"), ("True", "False"), ("False", "True")])
        self.assertAlmostEqual(float(grips[1][0]), 0.03, delta=0.001)
        self.assertAlmostEqual(float(grips[1][1]), 15.0, delta=0.2)


if __name__ == "__main__":
    SETUP = os.path.abspath(sys.argv[1])
    unittest.main(argv=sys.argv[:1])
