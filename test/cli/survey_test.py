#!/usr/bin/python3
"""Test scripts/survey on a folder of scenes: `survey_test.py PROGRAM`."""

import csv
import math
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
PENDULUM = """<robot name="pendulum"> <link name="world"/>
<joint name="hinge" type="revolute"> <parent link="world"/> <child link="rod"/> <axis xyz="0 1 0"/>
  <limit lower="%s" upper="3" effort="0" velocity="0"/> </joint>
<link name="rod"> %s </link> </robot>
"""
INERTIAL = """<inertial> <origin xyz="1 0 0"/> <mass value="1"/>
  <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/> </inertial>"""
SCENES = {
    "good.urdf": PENDULUM % ("-3", INERTIAL),
    "folder/outside.urdf": PENDULUM % ("1", INERTIAL),
    "massless.urdf": PENDULUM % ("-3", ""),
    "broken.urdf": "<robot>",
    "endless.urdf": (PENDULUM % ("-3", INERTIAL)).replace(
        "</robot>", "<simulation> <integrator step=\"1e-9\"/> </simulation> </robot>"),
    "no_scene.txt": "",
}


class Survey(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        for name, text in SCENES.items():
            path = os.path.join(cls.folder.name, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        cls.tables = os.path.join(cls.folder.name, "table")
        cls.finished = cls.survey(cls.tables)
        with open(cls.tables + ".csv", newline="", encoding="utf-8") as file:
            cls.rows = {row["file"]: row for row in csv.DictReader(file)}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def survey(cls, tables, *options):
        return subprocess.run(
            [os.path.join(ROOT, "scripts", "survey"), cls.folder.name, "--program", PROGRAM, "--output", tables,
             "--until", "0.05", "--timeout", "5", *options], capture_output=True, text=True, check=False)

    def test_every_scene_has_a_row_and_a_line_of_progress(self):
        self.assertEqual(self.finished.returncode, 0, self.finished.stderr)
        self.assertEqual(set(self.rows), set(SCENES) - {"no_scene.txt"})
        self.assertIn("[5/5] refused: massless.urdf", self.finished.stderr)

    def test_loaded(self):
        row = self.rows["good.urdf"]
        self.assertEqual((row["outcome"], row["links"], row["joints"], row["warned"]), ("loaded", "2", "1", ""))
        self.assertEqual(float(row["stops"]), 0)
        self.assertLess(float(row["drift"]), 1e-6)  # Newton's tolerance is 1e-8 in each of 50 steps
        self.assertGreater(float(row["speed"]), 0)

    def test_energy_in_stops(self):
        row = self.rows["folder/outside.urdf"]
        self.assertEqual((row["outcome"], row["warned"]), ("loaded", "yes"))
        # Compared with the energy in the stop, gravity adds little.
        self.assertGreater(float(row["stops"]), 0.9)

    def test_refusals_give_the_reason(self):
        self.assertIn("broken.urdf:1: must be well-formed XML", self.rows["broken.urdf"]["reason"])
        self.assertIn("massless.urdf:2: <joint>: joint coordinate 'hinge' moves nothing",
                      self.rows["massless.urdf"]["reason"])

    def test_time_limit(self):
        self.assertEqual(self.rows["endless.urdf"]["outcome"], "time out")

    def test_summary(self):
        summary = self.finished.stdout.strip()
        outcomes = "5 files: 2 loaded, 2 refused, 0 failed on the way, 1 out of time, 0 crashed"
        self.assertTrue(summary.startswith(outcomes))
        with open(self.tables + ".md", encoding="utf-8") as file:
            text = file.read()
        self.assertIn(summary, text)
        self.assertEqual(text.count("\n| "), len(SCENES))

    def test_options_of_the_program(self):
        repaired = self.survey(self.tables + "_2", "--start", "clamp", "--massless", "lock")
        self.assertIn(": 3 loaded, 1 refused", repaired.stdout)

    def test_no_directory(self):
        program = os.path.join(ROOT, "scripts", "survey")
        run = subprocess.run([program, "/no/such/folder"], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 2)
        self.assertIn("is no directory", run.stderr)


class Equilibria(unittest.TestCase):
    def test_are_found_and_checked(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("good.urdf", "massless.urdf"):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(SCENES[name])
            tables = os.path.join(folder, "table")
            run = subprocess.run([os.path.join(ROOT, "scripts", "survey"), folder, "--equilibria", "--program", PROGRAM,
                                  "--output", tables], capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn("2 files: 1 equilibria, 0 with moments left above 1e-06, 0 unchecked, 0 without, 1 refused",
                          run.stdout)
            with open(tables + ".csv", newline="", encoding="utf-8") as file:
                rows = {row["file"]: row for row in csv.DictReader(file)}
            self.assertLess(float(rows["good.urdf"]["moment"]), 1e-6)

    def test_moments_are_those_of_a_pendulum(self):
        sys.path.insert(0, os.path.join(ROOT, "scripts"))
        from gravity_moments import left_over, moments
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "pendulum.urdf")
            with open(path, "w", encoding="utf-8") as file:
                file.write(SCENES["good.urdf"])
            # 1 kg at 1 m along x, turning about y: m g l cos(angle).
            moment, largest, *_ = moments(path, {"hinge": 0.3})["hinge"]
            self.assertAlmostEqual(moment, 9.81 * math.cos(0.3), places=12)
            self.assertAlmostEqual(largest, 9.81, places=12)
            self.assertAlmostEqual(left_over(path, {"hinge": math.pi / 2})[0], 0, places=12)
            self.assertGreater(left_over(path, {"hinge": math.pi / 2 + 1e-3})[0], 9e-4)
            self.assertEqual(left_over(path, {"hinge": 0.3}, ["hinge"])[0], 0)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
