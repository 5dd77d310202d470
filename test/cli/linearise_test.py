#!/usr/bin/python3
"""Test files of `flexarm linearise`, read by scipy: `linearise_test.py PROGRAM`."""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy
import scipy.io

PENDULUM = """<robot name="pendulum"> {parameters} <link name="world"/>
  <joint name="hinge" type="continuous"> <parent link="world"/> <child link="bob"/> <axis xyz="0 1 0"/>
    <dynamics damping="0.3" friction="{friction}"/> </joint>
  <link name="bob"> <inertial> <origin xyz="0 0 -0.5"/> <mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/> </inertial> </link>
  <simulation> <probe name="tip" link="bob" at="0 0 -1"/> {simulation} </simulation>
</robot>"""
BAR = """<robot name="bar"> <parameter name="speed" value="0.5"/> <link name="world"/>
  <joint name="hinge" type="revolute"> <parent link="world"/> <child link="bar"/> <axis xyz="0 0 1"/>
    <limit lower="-1" upper="0.1" effort="0" velocity="0"/> </joint>
  <link name="bar"> <inertial> <origin xyz="0.5 0 0"/> <mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/> </inertial> </link>
  <simulation> <gravity xyz="0 0 0"/> <initial joint="hinge" velocity="${speed}"/>
    <integrator scheme="em" step="0.001" tolerance="1e-10"/> </simulation> </robot>"""
INERTIA, WEIGHT = 0.1 + 2 * 0.5**2, 2 * 9.81 * 0.5  # about the hinge [kg m^2]; weight times lever arm [N m]
NAMES = ("states", "inputs", "outputs")
MATRICES = ("A", "B", "C", "D")


class Linearise(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_program(self, *options, simulation="", friction=0, parameters=""):
        with open(self.path("scene.urdf"), "w", encoding="utf-8") as file:
            file.write(PENDULUM.format(simulation=simulation, friction=friction, parameters=parameters))
        command = [PROGRAM, "linearise", self.path("scene.urdf")] + list(options)
        return subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, check=False
        )

    def model(self, *options, **scene):
        result = self.run_program("--output", "-", *options, **scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_pendulum_by_formula(self):
        model = self.model("--outputs", "position:hinge,velocity:tip:x,acceleration:tip:x")
        self.assertEqual(model["states"], ["hinge", "d/dt hinge"])
        self.assertEqual(model["inputs"], ["effort:hinge"])
        row = [-WEIGHT / INERTIA, -0.3 / INERTIA]
        numpy.testing.assert_allclose(model["A"], [[0, 1], row], rtol=1e-12)
        numpy.testing.assert_allclose(model["B"], [[0], [1 / INERTIA]], rtol=1e-12)
        # The tip is 1 m below the hinge; the hinge turns about y.
        expected = [[1, 0], [0, -1], [-row[0], -row[1]]]
        numpy.testing.assert_allclose(model["C"], expected, rtol=1e-12, atol=1e-12)
        numpy.testing.assert_allclose(model["D"], [[0], [0], [-1 / INERTIA]], rtol=1e-12)

    def test_driven_joint(self):
        motion = '<motion joint="hinge" position="0"/>'
        model = self.model("--inputs", "motion:hinge", "--outputs", "effort:hinge", simulation=motion)
        numpy.testing.assert_allclose(model["A"], [[0, 1], [0, 0]])
        numpy.testing.assert_allclose(model["B"], [[0], [1]])
        numpy.testing.assert_allclose(model["C"], [[WEIGHT, 0.3]], rtol=1e-12)
        numpy.testing.assert_allclose(model["D"], [[INERTIA]], rtol=1e-12)

    def test_wrench_at_a_point(self):
        model = self.model("--inputs", "wrench:tip:fx,wrench:bob:my")
        numpy.testing.assert_allclose(model["B"], [[0, 0], [-1 / INERTIA, 1 / INERTIA]], rtol=1e-12, atol=1e-15)

    def test_about_an_instant(self):
        initial = '<initial joint="hinge" position="0.4" velocity="2"/>'
        model = self.model("--time", "0", simulation=initial)
        row = [-WEIGHT * numpy.cos(0.4) / INERTIA, -0.3 / INERTIA]
        numpy.testing.assert_allclose(model["A"], [[0, 1], row], rtol=1e-10, atol=1e-10)
        acceleration = (-WEIGHT * numpy.sin(0.4) - 0.3 * 2) / INERTIA
        numpy.testing.assert_allclose(model["drift"], [2, acceleration], rtol=1e-12)

    def test_sensitivities_are_differences_of_runs(self):
        simulation = '<initial joint="hinge" position="${angle}"/> <integrator step="0.005" tolerance="1e-10"/>'
        parameters = '<parameter name="angle" value="0.4"/> <parameter name="load" value="0.2"/>'
        load = '<effort joint="hinge" history="${load}"/>'
        scene = dict(simulation=simulation + load, parameters=parameters)
        model = self.model("--time", "0.5", "--sensitivities", "angle,load", "--transition", **scene)
        self.assertEqual(model["parameters"], ["angle", "load"])
        self.assertEqual(model["initial_states"], ["hinge", "d/dt hinge"])
        by_angle = numpy.array(model["states_by_parameters"])[:, 0]
        transition = numpy.array(model["transition"])
        numpy.testing.assert_allclose(transition[:, 0], by_angle, rtol=1e-6)
        # For a small motion, steps of the trapezoidal rule preserve areas except for the damping.
        self.assertAlmostEqual(numpy.linalg.det(transition), numpy.exp(-0.3 / INERTIA * 0.5), delta=1e-3)
        output = model["outputs"].index("position:hinge")
        by_parameters = model["outputs_by_parameters"][output]
        numpy.testing.assert_allclose(by_parameters, model["states_by_parameters"][0], rtol=1e-6)
        path = self.path("model.mat")
        result = self.run_program("--time", "0.5", "--sensitivities", "angle,load", "--output", path, **scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("derivatives with respect to parameters", result.stdout)
        numpy.testing.assert_allclose(
            scipy.io.loadmat(path)["states_by_parameters"], model["states_by_parameters"], rtol=1e-9)

    def test_events_that_a_run_came_over(self):
        """Check a bar that reaches its stop: doubtful events are printed, and files list all events."""
        for scheme, is_doubtful in (("em", False), ("newmark", True)):
            command = [PROGRAM, "linearise", self.path("bar.urdf"), "--time", "0.6", "--sensitivities", "speed",
                       "--output"]
            with open(self.path("bar.urdf"), "w", encoding="utf-8") as file:
                file.write(BAR.replace('"em"', '"%s"' % scheme))
            files = {}
            for name in ("model.json", "model.mat"):
                files[name] = subprocess.run(command + [self.path(name)], stdout=subprocess.PIPE,
                                             stderr=subprocess.PIPE, universal_newlines=True, check=False)
                self.assertEqual(files[name].returncode, 0, files[name].stderr)
            warning = "sensitivities after t = 0.2"
            self.assertEqual(warning in files["model.json"].stderr, is_doubtful, files["model.json"].stderr)
            with open(self.path("model.json"), encoding="utf-8") as file:
                events = json.load(file)["events"]
            self.assertEqual([event["what"] for event in events], ["touches its stop", "leaves its stop"])
            self.assertEqual({event["joint"] for event in events}, {"hinge"})
            # It reaches the stop at 0.1 / 0.5 s.
            self.assertAlmostEqual(events[0]["time"], 0.2, delta=1e-6)
            self.assertEqual(bool(events[0]["doubt"]), is_doubtful)
            matlab = scipy.io.loadmat(self.path("model.mat"))
            self.assertEqual([event["time"] for event in events], matlab["event_times"][:, 0].tolist())
            for name, key in (("event_joints", "joint"), ("event_kinds", "what")):
                self.assertEqual([str(cell[0]) for cell in matlab[name][:, 0]], [event[key] for event in events])

    def test_sensitivities_that_there_are_not(self):
        result = self.run_program("--time", "0.5", "--sensitivities", "angle")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--sensitivities: unknown parameter 'angle': the scene has no <parameter>", result.stderr)
        result = self.run_program("--sensitivities", "angle")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("--time", result.stderr)

    def test_files_have_the_same_numbers(self):
        model = self.model()
        for name in ("model.mat", "model.csv", "model.json"):
            self.assertEqual(self.run_program("--output", self.path(name)).returncode, 0)
        with open(self.path("model.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file), model)
        matlab = scipy.io.loadmat(self.path("model.mat"))
        for name in MATRICES + ("mass", "damping", "stiffness"):
            numpy.testing.assert_array_equal(matlab[name], model[name])
        for name in NAMES:
            self.assertEqual([str(cell[0]) for cell in matlab[name][:, 0]], model[name])
        with open(self.path("model.csv"), encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        self.assertEqual(header[1:], model["states"] + model["inputs"])
        self.assertEqual([row[0] for row in rows], model["states"] + model["outputs"])
        a, b, c, d = (numpy.array(model[name]) for name in MATRICES)
        whole = numpy.block([[a, b], [c, d]])
        numpy.testing.assert_array_equal([[float(number) for number in row[1:]] for row in rows], whole)

    def gain(self, frequency):
        """Return the frequency response of the angle to the effort, by the formula."""
        rate = 2j * numpy.pi * frequency
        return 1 / (INERTIA * rate**2 + 0.3 * rate + WEIGHT)

    def test_frequency_response_by_formula(self):
        model = self.model("--outputs", "position:hinge,velocity:tip:x", "--frequencies", "0.01:100:9")
        frequencies = numpy.array(model["frequencies"])
        numpy.testing.assert_allclose(frequencies, numpy.logspace(-2, 2, 9), rtol=1e-14)
        gains = numpy.array(model["gains"]) @ [1, 1j]
        expected = self.gain(frequencies)
        numpy.testing.assert_allclose(gains[:, 0, 0], expected, rtol=1e-12)
        numpy.testing.assert_allclose(gains[:, 1, 0], -2j * numpy.pi * frequencies * expected, rtol=1e-12)
        poles = numpy.array(model["poles"]) @ [1, 1j]
        numpy.testing.assert_allclose(poles, numpy.roots([INERTIA, 0.3, WEIGHT])[:1], rtol=1e-12)

    def test_responses_in_files(self):
        options = ("--frequencies", "0.5,2,1", "--step-response", "0.7")
        model = self.model(*options)
        self.assertEqual(model["frequencies"], [0.5, 2, 1])
        gains = numpy.array(model["gains"]) @ [1, 1j]
        self.assertEqual(self.run_program("--output", self.path("model.mat"), *options).returncode, 0)
        matlab = scipy.io.loadmat(self.path("model.mat"))
        numpy.testing.assert_array_equal(matlab["frequencies"][:, 0], model["frequencies"])
        numpy.testing.assert_array_equal(matlab["gains"], numpy.moveaxis(gains, 0, 2))
        numpy.testing.assert_array_equal(matlab["times"][:, 0], model["times"])
        numpy.testing.assert_array_equal(matlab["step_response"], model["step_response"])
        rows = self.table(*options[:2])
        names = ["%s %s / effort:hinge" % (kind, name) for name in model["outputs"] for kind in ("gain", "phase")]
        self.assertEqual(rows[0], ["frequency"] + names)
        values = numpy.array(rows[1:], dtype=float)
        numpy.testing.assert_allclose(values[:, 1::2], abs(gains[:, :, 0]), rtol=1e-15)
        numpy.testing.assert_allclose(values[:, 2::2], numpy.degrees(numpy.angle(gains[:, :, 0])), rtol=1e-14)
        rows = self.table(*options[2:])
        self.assertEqual(rows[0], ["time"] + [name + " / effort:hinge" for name in model["outputs"]])
        values = numpy.array(rows[1:], dtype=float)
        numpy.testing.assert_array_equal(values[:, 0], model["times"])
        numpy.testing.assert_array_equal(values[:, 1:], numpy.array(model["step_response"])[:, :, 0])
        self.assertEqual(model["times"][-1], 0.7)
        self.assertEqual(self.run_program("--output", self.path("model.csv"), *options).returncode, 2)

    def table(self, *options):
        self.assertEqual(self.run_program("--output", self.path("model.csv"), *options).returncode, 0)
        with open(self.path("model.csv"), encoding="utf-8") as file:
            return list(csv.reader(file))

    def test_a_picture_is_drawn(self):
        result = self.run_program("--frequencies", "0.1:10:50", "--plot", self.path("bode.png"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("bode.png"), "rb") as file:
            self.assertEqual(file.read(4), b"\x89PNG")
        with open(self.path("bode.json"), encoding="utf-8") as file:
            self.assertEqual(len(json.load(file)["gains"]), 50)

    def test_a_smaller_model(self):
        result = self.run_program("--reduce", "1")
        self.assertEqual(result.returncode, 0, result.stderr)
        values = result.stdout.split("Hankel singular values: ")[1].splitlines()
        left_out = float(values[0].split("; left out: ")[1])
        # The program prints four digits.
        self.assertAlmostEqual(float(values[1].split("at most ")[1].split()[0]) / (2 * left_out), 1, delta=1e-3)
        self.assertEqual(len(self.model("--reduce", "1")["A"]), 1)
        self.assertEqual(self.run_program("--reduce", "3").returncode, 2)

    def test_poles_are_printed(self):
        text = self.run_program().stdout.splitlines()
        frequency, ratio = text[2].split()[:2]
        size = numpy.sqrt(WEIGHT / INERTIA)
        expected = 0.3 / INERTIA / 2 / size
        # The program prints seven and four digits.
        self.assertAlmostEqual(float(frequency) / (size * numpy.sqrt(1 - expected**2) / (2 * numpy.pi)), 1, delta=1e-6)
        self.assertAlmostEqual(float(ratio) / expected, 1, delta=1e-3)

    def test_errors_name_what_there_is(self):
        for options, words in (
            (("--inputs", "effort:knee"), ("effort:knee", "hinge")),
            (("--inputs", "motion:hinge"), ("motion:hinge", "there is none")),
            (("--inputs", "hinge"), ("hinge", "effort:JOINT")),
            (("--outputs", "position:bob:q"), ("position:bob:q", "hinge, bob, tip")),
            (("--outputs", "effort:hinge"), ("effort:hinge", "there is none")),
            (("--output", "model.txt"), ("model.txt", ".mat")),
            (("--outputs", "strain:gauge"), ("strain:gauge", "there is none")),
            (("--frequencies", "1:0.5:3"), ("1:0.5:3", "FROM:TO:COUNT")),
            (("--frequencies", "1:2"), ("1:2", "FROM:TO:COUNT")),
            (("--frequencies", "1,-2"), ("-2", "> 0")),
            (("--plot", "bode.png"), ("--plot", "--frequencies")),
        ):
            result = self.run_program(*options)
            self.assertEqual(result.returncode, 2, options)
            for word in words:
                self.assertIn(word, result.stderr, options)

    def test_what_is_left_out_is_said(self):
        self.assertIn("friction of joint coordinate 'hinge'", self.run_program(friction=1).stderr)


if __name__ == "__main__":
    PROGRAM = sys.argv[1]
    unittest.main(argv=sys.argv[:1])
