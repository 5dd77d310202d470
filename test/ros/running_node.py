"""A node that a test starts and ends itself."""

import os
import subprocess
import tempfile

import rospy
from flexarm.msg import SimulatorStatus
from simulated_arm import PATIENCE

SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "two_arms.urdf")


class RunningNode:
    """Runs the node as a separate process with its output in a file, until the end of the `with` block.

    `wrapper`: a command that starts the node.
    """

    process_options = {}  # options of subprocess.Popen

    def __init__(self, *arguments, is_silent=False, wrapper=()):
        self.arguments = arguments
        self.is_silent = is_silent
        self.wrapper = wrapper

    def __enter__(self):
        if rospy.has_param("/flexarm"):  # private parameters outlive their node
            rospy.delete_param("/flexarm")
        self.log = tempfile.NamedTemporaryFile("r", suffix=".log")
        self.start()
        if not self.is_silent:
            self.status = rospy.wait_for_message("/flexarm/status", SimulatorStatus, PATIENCE)
        return self

    def start(self):
        self.process = subprocess.Popen(
            [*self.wrapper, "rosrun", "flexarm", "flexarm_node", "_scene:=" + SCENE, *self.arguments],
            stdin=subprocess.DEVNULL,
            stdout=open(self.log.name, "a", encoding="utf-8"),
            stderr=subprocess.STDOUT,
            **self.process_options,
        )

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.log.close()

    def output(self):
        self.log.seek(0)
        return self.log.read()
