#!/usr/bin/python3
"""Tests the node's process: parameters, frames of other publishers, clocks, real-time priority, and its end."""

import os
import signal
import tempfile
import unittest

import rosgraph
import rospy
import rostest
from flexarm.msg import SimulatorStatus
from geometry_msgs.msg import TransformStamped
from running_node import RunningNode
from sensor_msgs.msg import JointState
from simulated_arm import PATIENCE, wait_until
from tf2_msgs.msg import TFMessage

LEG = """<robot name="leg"> <link name="trunk"/> <link name="foot"/>
<link name="shank"> <inertial> <origin xyz="0 0 -0.2"/> <mass value="1"/>
  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/> </inertial> </link>
<joint name="knee" type="revolute"> <parent link="trunk"/> <child link="shank"/> <axis xyz="0 1 0"/>
  <limit lower="-2.5" upper="-0.75" effort="0" velocity="0"/> </joint>
<joint name="ankle" type="continuous"> <parent link="shank"/> <child link="foot"/> <axis xyz="0 1 0"/> </joint>
</robot>"""


def registered_nodes():
    publishers, subscribers, services = rosgraph.Master("/process_test").getSystemState()
    return {name for group in (publishers, subscribers, services) for _, names in group for name in names}


class Process(unittest.TestCase):
    def test_unregisters_on_signals(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with RunningNode() as node:
                self.assertIn("/flexarm", registered_nodes())
                node.process.send_signal(number)
                self.assertEqual(node.process.wait(PATIENCE), 0)
                self.assertNotIn("/flexarm", registered_nodes())

    def test_private_parameters_override_the_integrator(self):
        with RunningNode("_step:=0.003", "_scheme:=newmark") as node:
            self.assertEqual(node.status.step, 0.003)
            self.assertEqual(node.status.scheme, "newmark")

    def test_starts_a_robot_that_lacks_inertia_outside_its_limits(self):
        with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
            file.write(LEG)
            file.flush()
            with RunningNode("_scene:=" + file.name, "_start:=clamp", "_massless:=lock", "_paused:=true") as node:
                states = rospy.wait_for_message("/joint_states", JointState, PATIENCE)
                self.assertEqual(states.position[states.name.index("knee")], -0.75)
                self.assertIn("'ankle': is held where it starts", node.output())

    def test_starts_in_equilibrium(self):
        with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
            file.write(LEG)
            file.flush()
            with RunningNode("_scene:=" + file.name, "_start:=clamp,equilibrium", "_massless:=lock"):
                for _ in range(3):
                    states = rospy.wait_for_message("/joint_states", JointState, PATIENCE)
                    # The velocity that round-off of angles of 1 rad gives in a step.
                    self.assertLess(max(map(abs, states.velocity)), 1e-12)

    def test_counts_the_steps_that_it_cannot_make(self):
        with RunningNode("_real_time_factor:=1e6"):
            statuses = []
            rospy.Subscriber("/flexarm/status", SimulatorStatus, statuses.append)
            wait_until(lambda: statuses and statuses[-1].overruns > 0, "an overrun")
            self.assertGreater(statuses[-1].real_time_factor, 0)

    def test_warns_where_the_system_refuses_to_be_real_time(self):
        wrapper = ["prlimit", "--rtprio=0:0", "--memlock=65536:65536"]
        if os.geteuid() == 0:  # root must lose its privileges
            wrapper += ["setpriv", "--bounding-set=-sys_nice,-ipc_lock"]
        with RunningNode("_realtime:=true", wrapper=wrapper) as node:
            wait_until(lambda: "~realtime: the system refuses SCHED_FIFO" in node.output(), "the warning")
            self.assertIn("; mlockall: ", node.output())
            statuses = []
            rospy.Subscriber("/flexarm/status", SimulatorStatus, statuses.append)
            wait_until(lambda: len(statuses) > 2 and statuses[-1].steps > statuses[0].steps, "steps all the same")

    def test_warns_of_a_clock_that_does_not_come(self):
        rospy.set_param("/use_sim_time", True)
        try:
            with RunningNode(is_silent=True) as node:
                wait_until(lambda: "no node publishes /clock" in node.output(), "the warning")
        finally:
            rospy.set_param("/use_sim_time", False)

    def test_warns_once_of_another_publisher_of_its_frames(self):
        publisher = rospy.Publisher("/tf", TFMessage, queue_size=10)
        message = TFMessage([TransformStamped()])
        message.transforms[0].transform.rotation.w = 1
        with RunningNode() as node:
            wait_until(lambda: publisher.get_num_connections() > 0, "the node to listen")
            message.transforms[0].child_frame_id = "foreign"
            publisher.publish(message)
            message.transforms[0].child_frame_id = "right_hand"
            wait_until(lambda: publisher.publish(message) or "right_hand" in node.output(), "the warning")
            for _ in range(20):
                publisher.publish(message)
            node.process.send_signal(signal.SIGINT)
            node.process.wait(PATIENCE)
            warnings = [line for line in node.output().splitlines() if "WARN" in line]
            self.assertEqual(len(warnings), 1, node.output())
            self.assertIn(rospy.get_name(), warnings[0])
            self.assertNotIn("foreign", warnings[0])


if __name__ == "__main__":
    rospy.init_node("process_test")
    rostest.rosrun("flexarm", "process", __name__)
