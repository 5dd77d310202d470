#!/usr/bin/python3
"""Test HDF5 files and bags of `flexarm simulate`, read by h5py and rosbag: `recording_test.py PROGRAM`."""

import csv
import math
import os
import subprocess
import sys
import tempfile
import unittest

import h5py
import rosbag

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
DEMO = os.path.join(ROOT, "config", "demo_arm.urdf")
ARM = """<robot name="arm"> <link name="world"/>
  <joint name="shoulder" type="continuous"> <parent link="world"/> <child link="boom"/> <axis xyz="0 1 0"/> </joint>
  <link name="boom"> <beam elements="2"> <centerline> <line to="1 0 0"/> </centerline> <circle radius="0.01"/>
    <material young="70e9" poisson="0.33" density="2700"/> </beam> </link>
  <joint name="wrist" type="fixed"> <parent link="boom"/> <child link="hand"/> <origin xyz="1 0 0"/> </joint>
  <link name="hand"> <inertial> <mass value="1"/>
    <inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/> </inertial> </link>
  <joint name="bolt" type="fixed"> <parent link="hand"/> <child link="camera"/> <origin xyz="0 0 0.1"/> </joint>
  <link name="camera"/>
  <sensor name="cell" kind="wrench" link="hand" rate="500"/>
  <sensor name="gauge" kind="strain" link="boom" at="0.1 0 0.01"/>
  <sensor name="unit" kind="imu" link="hand" noise="0.1"/>
  <sensor name="eye" kind="pose" link="camera"/>
</robot>"""


class Recording(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.scene = self.path("arm.urdf")
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(ARM)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def simulate(self, output, *options, scene=None):
        command = [PROGRAM, "simulate", "--quiet", scene or self.scene, "--output", output] + list(options)
        return subprocess.run(command, stderr=subprocess.PIPE, universal_newlines=True, check=False)

    def record(self, name, *options, scene=None):
        result = self.simulate(self.path(name), *options, scene=scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.path(name)

    def test_hdf5_has_the_numbers_of_the_table(self):
        until = ("--until", "1.5", "--columns", "time,joint/*,sensor/*,solver/iterations")
        table, file = self.record("arm.csv", *until), self.record("arm.h5", *until)
        with open(table, encoding="utf-8") as lines:
            rows = list(csv.DictReader(lines))
        self.assertEqual(len(rows), 1501)  # more rows than a chunk of HDF5 has
        with h5py.File(file, "r") as results:
            self.assertEqual(results.attrs["robot"], "arm")
            self.assertEqual(results.attrs["scheme"], "em")
            self.assertEqual(results.attrs["step"], 1e-3)
            found = {}
            results.visititems(lambda name, entry: found.update({name: entry} if hasattr(entry, "shape") else {}))
            self.assertEqual(set(found), set(rows[0]))
            for name, entry in found.items():
                self.assertEqual(entry.attrs["name"], name)
                self.assertEqual(list(entry), [float(row[name]) for row in rows], name)
            units = {name: found[name].attrs["unit"] for name in found}
        self.assertEqual(units["time"], "s")
        self.assertEqual(units["joint/shoulder/effort"], "N m")
        self.assertEqual(units["sensor/unit/ax"], "m/s^2")

    def test_hdf5_is_at_most_a_third_of_the_table(self):
        until = ("--until", "5")
        table = self.record("demo.csv", *until, scene=DEMO)
        file = self.record("demo.h5", *until, scene=DEMO)
        print("HDF5 over CSV: %.3f" % (os.path.getsize(file) / os.path.getsize(table)))
        self.assertLess(os.path.getsize(file), os.path.getsize(table) / 3)

    def test_bag_has_what_the_node_publishes(self):
        with rosbag.Bag(self.record("arm.bag", "--until", "0.5", "--every", "10")) as bag:
            topics = bag.get_type_and_topic_info().topics
            self.assertEqual(
                {topic: (info.msg_type, info.message_count) for topic, info in topics.items()},
                {
                    "/joint_states": ("sensor_msgs/JointState", 51),
                    "/tf": ("tf2_msgs/TFMessage", 51),
                    "/tf_static": ("tf2_msgs/TFMessage", 1),
                    "/beam_markers": ("visualization_msgs/MarkerArray", 13),
                    "/sensors/cell": ("geometry_msgs/WrenchStamped", 251),
                    "/sensors/gauge": ("flexarm/StrainStamped", 501),
                    "/sensors/unit": ("sensor_msgs/Imu", 501),
                    "/sensors/eye": ("geometry_msgs/PoseStamped", 501),
                },
            )
            joints = [message for _, message, _ in bag.read_messages("/joint_states")]
            self.assertAlmostEqual(joints[-1].header.stamp.to_sec(), 0.5, places=8)
            self.assertEqual(joints[-1].name, ["shoulder"])
            self.assertGreater(joints[-1].position[0], 0.5)  # the arm falls
            frames = [[t.child_frame_id for t in message.transforms] for _, message, _ in bag.read_messages("/tf")]
            self.assertEqual(frames[0], ["boom", "hand", "boom/tip"])
            cells = [message for _, message, _ in bag.read_messages("/sensors/cell")]
            self.assertEqual(cells[-1].header.frame_id, "hand")
            latched = [c for c in bag._get_connections() if c.topic == "/tf_static"]
            self.assertEqual(latched[0].header.get("latching"), b"1")

    def test_bag_has_the_numbers_of_the_table(self):
        # Many rows, so that the writing thread falls behind the stepping thread.
        until = ("--until", "2")
        with open(self.record("arm.csv", *until), encoding="utf-8") as lines:
            rows = list(csv.DictReader(lines))
        with rosbag.Bag(self.record("arm.bag", *until)) as bag:
            joints = [message for _, message, _ in bag.read_messages("/joint_states")]
            frames = [message.transforms[0].transform for _, message, _ in bag.read_messages("/tf")]
        self.assertEqual(len(rows), len(joints))
        for quantity in ("position", "velocity", "effort"):
            self.assertEqual([getattr(message, quantity)[0] for message in joints],
                             [float(row["joint/shoulder/" + quantity]) for row in rows], quantity)
        # The joint is at the origin of the world and turns about the world's y axis.
        for frame, row in zip(frames, rows):
            sine = math.sin(float(row["joint/shoulder/position"]) / 2)
            self.assertAlmostEqual(abs(frame.rotation.y), abs(sine), places=12)

    def test_what_cannot_be_written_is_an_error_of_input(self):
        for name in ("none/arm.h5", "none/arm.bag"):
            result = self.simulate(self.path(name), "--until", "0.1")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("cannot write '%s'" % self.path(name), result.stderr)

    def test_links_stay_links(self):
        for name in ("arm.h5", "arm.bag"):
            self.record(name, "--until", "0.01")
            os.symlink(name, self.path("link_to_" + name))
            before = os.stat(self.path(name)).st_ino
            self.record("link_to_" + name, "--until", "0.01")
            self.assertTrue(os.path.islink(self.path("link_to_" + name)))
            self.assertNotEqual(os.stat(self.path(name)).st_ino, before)

    def test_only_files_are_replaced(self):
        for name in ("arm.h5", "arm.bag"):
            os.mkfifo(self.path(name))
            result = self.simulate(self.path(name), "--until", "0.01")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("'%s' cannot be written: it is not a regular file" % self.path(name), result.stderr)

    def test_nothing_unfinished_is_left(self):
        self.record("arm.h5", "--until", "0.01")
        self.record("arm.bag", "--until", "0.01")
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["arm.bag", "arm.h5", "arm.urdf"])


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
