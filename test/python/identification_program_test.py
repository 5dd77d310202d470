"""Test the program `flexarm identify`: files, bags, signals, exit status."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys

import numpy
import pytest

import flexarm
from conftest import ROOT, command_line
from identification import ROD

sys.path.append(os.path.join(ROOT, "test", "examples"))
from typed_commands import commands_of, text_of, type_commands  # noqa: E402

PLAN = "parameters: {mass: , damping: }\ncolumns: {joint/hinge/position: {noise: 1e-3}}\n"
EFFORT = "commands:\n  - {time: 0.2, names: [hinge], efforts: [4], duration: 0.3}\n"


@pytest.fixture
def rod(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    comment = "<!-- <parameter name='mass' value='7'/> -->"
    (tmp_path / "rod.urdf").write_text(ROD.replace("<integrator", comment + " <integrator"))
    (tmp_path / "plan.yaml").write_text(PLAN)
    return tmp_path


def measure(output):
    assert command_line("simulate", "rod.urdf", "--set", "mass=2", "damping=0.5", "--until", "1", "--output", output,
                        "--quiet") == (0, "")


def estimates(path="rod_fitted.json"):
    with open(path, encoding="utf-8") as file:
        return {unknown["name"]: unknown["estimate"] for unknown in json.load(file)["unknowns"]}


def test_the_example_of_the_documentation(tmp_path):
    folder = os.path.join(ROOT, "config", "identification")
    for name in ("measured_arm.urdf", "plan.yaml"):
        shutil.copy(os.path.join(folder, name), tmp_path)
    with open(os.path.join(folder, "plan.yaml"), encoding="utf-8") as file:
        assert "```yaml\n" + file.read() + "```" in text_of("identify.md")
    status, printed = type_commands(commands_of("identify.md"), os.environ["FLEXARM_SETUP"], str(tmp_path))
    assert status == 0 and "warning" not in printed
    with open(tmp_path / "measured_arm_fitted.json", encoding="utf-8") as file:
        found = json.load(file)
    assert found["converged"] and found["simulations"] <= 50
    for unknown, truth in zip(found["unknowns"], (70e9, 0.1, 0.5)):
        assert unknown["estimate"] == pytest.approx(truth, rel=0.01)
        assert abs(unknown["estimate"] - truth) < 4 * unknown["standard_error"]
    (report,) = re.findall(r"^The output is:\n\n```\n(.*?)^```", text_of("identify.md"), re.DOTALL | re.MULTILINE)
    # Digits depend on the processor, so only words are compared.
    report, printed = (re.sub(r"[-0-9.e+]+", "#", text) for text in (report, printed[printed.index("unknown "):]))
    assert report.split() == printed.split()
    assert (tmp_path / "measured_arm_fitted.png").stat().st_size > 10000


def test_only_values_of_parameters_change(rod):
    measure("data.csv")
    assert command_line("identify", "rod.urdf", "data.csv", "plan.yaml", "--quiet") == (0, "")
    before, after = (rod / "rod.urdf").read_text(), (rod / "rod_fitted.urdf").read_text()
    found = estimates()
    assert after == before.replace('value="1.5"', 'value="%r"' % found["mass"]).replace(
        'value="0.2"', 'value="%r"' % found["damping"])
    assert {p.name: p.value for p in flexarm.read_scene("rod_fitted.urdf").parameters} == {**found, "nothing": 1.0}
    # Without noise, the search ends when the residuals are round-off of Newton's tolerance.
    assert found == pytest.approx({"mass": 2, "damping": 0.5}, rel=1e-6)
    assert sorted(os.listdir(rod)) == ["data.csv", "plan.yaml", "rod.urdf", "rod_fitted.csv", "rod_fitted.json",
                                       "rod_fitted.png", "rod_fitted.urdf"]


def test_a_bag_gives_what_a_table_gives(rod):
    measure("data.csv")
    measure("data.bag")
    for name in ("data.csv", "data.bag"):
        assert command_line("identify", "rod.urdf", name, "plan.yaml", "--quiet") == (0, "")
        os.rename("rod_fitted.json", name + ".json")
    # Stamps are whole nanoseconds, and the motion takes about a second.
    assert estimates("data.bag.json") == pytest.approx(estimates("data.csv.json"), rel=1e-8)


def test_commands_of_a_bag_are_those_of_files(rod):
    rosbag = pytest.importorskip("rosbag")
    import rospy
    from flexarm.msg import JointForceCommand
    from sensor_msgs.msg import JointState

    (rod / "commands.yaml").write_text(EFFORT)
    (rod / "efforts.csv").write_text("time,hinge\n0,0\n0.2,4\n0.5,0\n")
    scene = flexarm.read_scene("rod.urdf", parameters={"mass": 2, "damping": 0.5})
    simulation = flexarm.Simulation(scene, tolerance=1e-10)
    efforts = numpy.zeros((100, 1))
    efforts[20:50] = 4
    rows = simulation.run(100, efforts, record=["joint/*/position"])
    numpy.savetxt("data.csv", rows, delimiter=",", header="time,joint/hinge/position", comments="", fmt="%.17g")
    epoch = 1_700_000_000
    with rosbag.Bag("run.bag", "w") as bag:
        command = JointForceCommand(names=["hinge"], efforts=[4.0], duration=rospy.Duration(0, 300_000_000))
        bag.write("/joint_force_command", command, rospy.Time(epoch, 200_000_000))
        for time, position in rows:
            message = JointState(name=["other", "hinge"], position=[9.0, position])
            nanoseconds = int(round(time * 1e9))
            message.header.stamp = rospy.Time(epoch, nanoseconds) if time < 0.995 else rospy.Time(epoch + 1, 0)
            bag.write("/arm/joint_states", message, message.header.stamp)
    found = {}
    for name, data, commands in [
        ("schedule", "data.csv", "commands: commands.yaml\n"),
        ("table", "data.csv", "commands: {file: efforts.csv, between: hold}\n"),
        ("bag", "run.bag",
         "commands: {topic: joint_force_command}\nbegin: %d\njoint_states: arm/joint_states\n" % epoch),
    ]:
        (rod / "plan.yaml").write_text(PLAN + commands)
        assert command_line("identify", "rod.urdf", data, "plan.yaml", "--quiet") == (0, "")
        found[name] = estimates()
    assert found["schedule"] == pytest.approx({"mass": 2, "damping": 0.5}, rel=1e-6)
    assert found["table"] == pytest.approx(found["schedule"], rel=1e-8)
    # At this epoch, a double of seconds is rounded to a quarter of a microsecond, which changes the times and the
    # impulses of efforts.
    assert found["bag"] == pytest.approx(found["schedule"], rel=1e-5)


@pytest.mark.parametrize("arguments, said", [
    ("rod.urdf data.csv plan.yaml --output rod.urdf", "--output would overwrite 'rod.urdf', which is read"),
    ("rod.urdf data.csv plan.yaml --output data.urdf", "--output would overwrite 'data.csv', which is read"),
    ("rod.urdf data.csv plan.yaml --output none/a.urdf", "--output: 'none/a.urdf' cannot be written"),
    ("rod.urdf data.csv plan.yaml --set mass", "--set: must be NAME=VALUE, got 'mass'"),
    ("rod.urdf data.csv plan.yaml --set length=3", "'length'"),
    ("rod.urdf none.csv plan.yaml", "none.csv: cannot be read: No such file or directory"),
    ("rod.urdf data.csv none.yaml", "none.yaml: cannot be read: No such file or directory"),
    ("rod.urdf rod.bag plan.yaml", "rod.bag: cannot be read as a bag"),
    ("none.urdf data.csv plan.yaml", "none.urdf"),
    ("rod.urdf data.csv", "the following arguments are required: plan"),
    ("rod.urdf data.csv plan.yaml --workers 0", "must be a number >= 1, got '0'"),
])
def test_wrong_usage_is_refused(rod, arguments, said):
    measure("data.csv")
    (rod / "rod.bag").write_text("no bag\n")
    before = sorted(os.listdir(rod))
    status, printed = command_line("identify", *arguments.split())
    assert status == 2 and said in printed and "Traceback" not in printed
    assert sorted(os.listdir(rod)) == before


@pytest.mark.parametrize("plan, said", [
    ("columns: {joint/elbow/position: {data: joint/hinge/position}}", "plan.yaml:3: "),
    ("columns: {joint/hinge/*: {data: joint/hinge/position}}", "expected the name of one column, got those of"),
    ("columns: {joint/hinge/position: }\ninitial: {elbow/position: 3}", "elbow"),
    ("columns: {joint/hinge/position: }\nbegin: -1e9",
     "'begin' of the plan must be the measured time at which the scene starts"),
])
def test_what_the_scene_does_not_have_is_refused(rod, plan, said):
    measure("data.csv")
    (rod / "plan.yaml").write_text("parameters:\n  mass:\n" + plan + "\n")
    status, printed = command_line("identify", "rod.urdf", "data.csv", "plan.yaml")
    assert status == 2 and said in printed and "Traceback" not in printed


def test_a_start_that_cannot_be_simulated_is_said(rod):
    measure("data.csv")
    text = (rod / "rod.urdf").read_text().replace('step="0.01"', 'step="0.01" max_iterations="1" max_halvings="0"')
    (rod / "rod.urdf").write_text(text)
    status, printed = command_line("identify", "rod.urdf", "data.csv", "plan.yaml")
    assert status == 1 and "the scene cannot be simulated with the start values of the search: " in printed


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_keeps_the_best_so_far(rod, number):
    measure("data.csv")
    # The steps are so short that the search takes some seconds.
    (rod / "plan.yaml").write_text(PLAN + "step: 2e-5\n")
    command = [os.environ["FLEXARM_PROGRAM"], "identify", "rod.urdf", "data.csv", "plan.yaml", "--workers", "1"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, universal_newlines=True) as process:
        line = process.stderr.readline()
        process.send_signal(number)
        _, said = process.communicate(timeout=1000)
    assert line.startswith("iteration 1, 3 simulations: ")
    assert process.returncode == 128 + number and "interrupted; the best values so far are kept" in said
    assert set(estimates()) == {"mass", "damping"}
    with open("rod_fitted.json", encoding="utf-8") as file:
        assert not json.load(file)["converged"]
    flexarm.read_scene("rod_fitted.urdf")
