#!/usr/bin/python3
"""Tests that runs are recorded and replayed, and that commands are played to a node, with and without a clock."""

import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from flexarm.msg import JointForceCommand
from running_node import SCENE, RunningNode
from sensor_msgs.msg import JointState
from simulated_arm import PATIENCE, CommandTopic, SimulatedArm, force_command, wait_until

TOPICS = ["/joint_states", "/joint_force_command", "/joint_command"]


class Recorder:
    """Runs the program of `rosbag record` itself, because old versions of `rosbag` do not hand SIGINT on to it. end()
    waits for the bag."""

    def __init__(self, file, *topics):
        self.file = file
        self.process = subprocess.Popen(["rosrun", "rosbag", "record", "-O", file, "__name:=recorder", *topics],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(PATIENCE)
        wait_until(lambda: os.path.exists(self.file), "the bag")


def replay(bag, *arguments, scene=SCENE):
    """Return exit status and output of `flexarm replay`."""
    done = subprocess.run(["rosrun", "flexarm", "flexarm", "replay", bag, scene, *arguments], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=300, check=False)
    return done.returncode, done.stdout


class Bags(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.bag = os.path.join(self.folder.name, "run.bag")

    def simulated_time(self, on):
        rospy.set_param("/use_sim_time", on)

    def other_scene(self, density="2701"):
        path = os.path.join(self.folder.name, "other.urdf")
        with open(SCENE, encoding="utf-8") as scene, open(path, "w", encoding="utf-8") as other:
            other.write(scene.read().replace('density="2700"', 'density="%s"' % density))
        return path

    def record_in_lock_step(self):
        states = []
        with RunningNode("_lock_step:=true"):
            recorder = Recorder(self.bag, *TOPICS)
            force = CommandTopic("/joint_force_command", JointForceCommand)
            one_by_one = CommandTopic("/joint_command", JointState)
            subscriber = rospy.Subscriber("/joint_states", JointState, states.append, queue_size=1000)
            self.addCleanup(subscriber.unregister)
            for topic in (force, one_by_one):
                wait_until(lambda topic=topic: topic.publisher.get_num_connections() > 1, "the recorder")
            wait_until(lambda: states, "the state at the start")
            time.sleep(0.5)
            for n in range(60):
                count = len(states)
                if n % 3 == 2:
                    one_by_one.send(JointState(name=["right_shoulder"], effort=[0.3 - 0.01 * n]))
                else:
                    force.send(force_command(["left_shoulder"], [0.1 * n], 0.004 if n % 3 else 0.0))
                wait_until(lambda count=count: len(states) > count, "the step")
                # The recorder takes waiting messages of two topics in any order. So each message gets the time to be
                # recorded.
                time.sleep(0.02)
            force.send(force_command(["nobody"], [1.0]))
            time.sleep(0.5)
            recorder.end()
            subscriber.unregister()

    def test_lock_step_comes_back_to_the_bit(self):
        self.record_in_lock_step()
        status, output = replay(self.bag, "--lock-step", "--largest", "0")
        self.assertEqual(status, 0, output)
        self.assertIn("60 commands given, 61 states compared, 60 steps", output)
        self.assertIn("1 commands refused; the first: /joint_force_command: there is no joint coordinate", output)
        self.assertRegex(output, r"agrees: positions differ by at most 0")

        status, output = replay(self.bag, "--lock-step", "--largest", "1e-9", scene=self.other_scene())
        self.assertEqual(status, 1, output)
        self.assertIn("DIFFERS", output)

    def test_what_cannot_be_replayed_is_refused(self):
        with rosbag.Bag(self.bag, "w") as bag:
            bag.write("/joint_states", JointState(name=["nose"], position=[0], velocity=[0]), rospy.Time(1))
        for arguments, told in (((), "'nose', which the scene does not"), (("--namespace", "/left"), "no message on")):
            status, output = replay(self.bag, *arguments)
            self.assertEqual(status, 2, output)
            self.assertIn(told, output)
        with open(self.bag, "w", encoding="utf-8") as file:
            file.write("no bag")
        status, output = replay(self.bag)
        self.assertEqual(status, 2, output)
        self.assertIn(self.bag, output)

    def test_simulated_time(self):
        self.simulated_time(True)
        self.addCleanup(self.simulated_time, False)
        with RunningNode("_publish_clock:=true", "_paused:=true", "_publish_rate:=500"):
            arm = SimulatedArm()
            recorder = Recorder(self.bag, "/clock", *TOPICS)
            force = CommandTopic("/joint_force_command", JointForceCommand)
            wait_until(lambda: force.publisher.get_num_connections() > 1, "the recorder")
            time.sleep(0.5)
            for effort in (2.0, -1.0, 0.5):
                force.send(force_command(["left_shoulder", "right_shoulder"], [effort, -0.2], 0.05))
                time.sleep(0.3)  # both nodes receive it while the clock stands still
                self.assertTrue(arm.step(100).success)
                time.sleep(0.3)
            recorder.end()
        # Both runs use the same kept factors of the tangent, so that every bit is the same.
        status, output = replay(self.bag, "--largest", "1e-12")
        self.assertEqual(status, 0, output)
        self.assertIn("3 commands given", output)
        compared = int(re.search(r"(\d+) states compared", output).group(1))
        self.assertGreater(compared, 100)

    def record_live(self):
        """Record commands that come at any time, to a node that runs at the pace of the wall clock."""
        with RunningNode("_paused:=true", "_publish_rate:=200"):
            arm = SimulatedArm()
            recorder = Recorder(self.bag, *TOPICS)
            force = CommandTopic("/joint_force_command", JointForceCommand)
            wait_until(lambda: force.publisher.get_num_connections() > 1, "the recorder")
            time.sleep(0.5)
            arm.resume()
            for effort in (2.0, -1.0, 0.5):
                force.send(force_command(["left_shoulder", "right_shoulder"], [effort, -0.2], 0.05))
                time.sleep(0.2117)
            recorder.end()

    def test_times_of_commands_explain_a_live_run(self):
        self.record_live()
        status, output = replay(self.bag)
        self.assertEqual(status, 0, output)
        self.assertIn("3 commands given", output)
        # A joint without a command stays where it was if the steps are counted well.
        shuttle = re.search(r"^shuttle +([^ ]+)", output, re.MULTILINE)
        self.assertLess(float(shuttle.group(1)), 1e-9, output)
        status, output = replay(self.bag, scene=self.other_scene("3500"))
        self.assertEqual(status, 1, output)
        self.assertRegex(output, "DIFFERS: .* 'left_shoulder' is off by .* more than the times of commands explain")

    def test_commands_are_played_without_the_clock(self):
        self.record_in_lock_step()
        with RunningNode():
            arm = SimulatedArm()
            player = subprocess.Popen(["rosbag", "play", "--quiet", "--wait-for-subscribers", self.bag, "--topics",
                                       "/joint_force_command"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            self.addCleanup(player.kill)
            self.assertEqual(player.wait(PATIENCE), 0)
            wait_until(lambda: arm.joint("left_shoulder").velocity != 0, "the motion")

    def test_commands_are_played_with_the_clock(self):
        self.record_in_lock_step()
        self.simulated_time(True)
        self.addCleanup(self.simulated_time, False)
        with rosbag.Bag(self.bag) as bag:
            begin, end = bag.get_start_time(), bag.get_end_time()
        with RunningNode(is_silent=True):
            stamps, moved = [], []

            def receive(message):
                stamps.append(message.header.stamp.to_sec())
                moved.append(message.velocity[message.name.index("left_shoulder")] != 0)

            self.addCleanup(rospy.Subscriber("/joint_states", JointState, receive, queue_size=1000).unregister)
            # Before version 1.15, rosbag waits for subscribers by the clock that it does not publish yet.
            player = subprocess.Popen(["rosbag", "play", "--quiet", "--clock", "--delay", "1", self.bag, "--topics",
                                       "/joint_force_command"],
                                      stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            self.addCleanup(player.kill)
            self.assertEqual(player.wait(PATIENCE), 0)
            wait_until(lambda: moved and moved[-1], "the motion")
            self.assertEqual(stamps, sorted(set(stamps)))
            self.assertGreaterEqual(stamps[0], begin - 1)
            self.assertLess(stamps[-1], end + 1)


if __name__ == "__main__":
    rospy.init_node("bags_test")
    rostest.rosrun("flexarm", "bags", Bags)
