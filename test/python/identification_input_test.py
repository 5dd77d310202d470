"""Test plans, measurements and commands of the identification: what they contain, and the messages of errors."""

import numpy
import pytest

import flexarm
from conftest import ROOT
from flexarm.identification import InputError, read_efforts, read_measurements, read_plan

PARAMETERS = [flexarm.Parameter("mass", 1.5, 0.1, 10), flexarm.Parameter("damping", 0.2, 0, None),
              flexarm.Parameter("offset", 0.0, None, None)]
COLUMNS = "columns: {joint/hinge/position: }\n"


def plan_of(tmp_path, text):
    path = tmp_path / "plan.yaml"
    path.write_text(text)
    return read_plan(str(path), PARAMETERS)


def test_a_plan_says_what_is_to_be_found(tmp_path):
    plan = plan_of(tmp_path, """
parameters:
  mass: {start: 2e0, max: 5}
  damping:
initial:
  hinge/position: 0.3
  hinge/velocity: {start: 0, min: -1, max: 1}
columns:
  joint/hinge/position: {noise: 1e-3, data: angle}
  probe/tip/x:
begin: first
until: 2
""")
    assert [tuple(unknown) for unknown in plan.unknowns] == [
        ("mass", False, 2.0, 0.1, 5.0, 2.0), ("damping", False, 0.2, 0.0, numpy.inf, 0.2),
        ("hinge/velocity", True, 0.0, -1.0, 1.0, 2.0)]
    assert plan.initial == {"hinge/position": 0.3}
    assert [column[:3] for column in plan.columns] == [("joint/hinge/position", "angle", 1e-3),
                                                       ("probe/tip/x", "probe/tip/x", None)]
    assert (plan.begin, plan.until, plan.step, plan.commands) == (None, 2.0, None, None)


@pytest.mark.parametrize("text, error", [
    ("", ":1: expected a mapping, got an empty file"),
    ("parameters: [mass]\n" + COLUMNS, ":1: parameters: expected a mapping, got 'a sequence'"),
    ("parameters:\n  mas: \n" + COLUMNS,
     ":2: parameters: mas: expected a parameter of the scene, of mass, damping, offset"),
    ("parameters:\n  mass: {start: heavy}\n" + COLUMNS,
     ":2: parameters: mass: start: expected a finite number, got 'heavy'"),
    ("parameters:\n  mass: {min: 0}\n" + COLUMNS,
     ":2: parameters: mass: min: expected a number within the scene's limits, 0.1 and 10, got '0'"),
    ("parameters:\n  mass: {start: 6, max: 5}\n" + COLUMNS,
     ":2: parameters: mass: expected a start between 0.1 and 5, got 6"),
    ("parameters:\n  mass: {min: 5, max: 5}\n" + COLUMNS, ":2: parameters: mass: expected min < max, got 5 and 5"),
    ("parameters:\n  mass:\n  mass:\n" + COLUMNS, ":3: parameters: the key 'mass' comes twice"),
    ("parameters:\n  mass: {begin: 1}\n" + COLUMNS,
     ":2: parameters: mass: expected a key of start, min, max, scale, got 'begin'"),
    ("parameters:\n  offset:\n" + COLUMNS,
     ":2: parameters: offset: expected a key 'scale', since it starts at zero: the size of a significant change"),
    ("parameters: {mass: }\ncolumns: {a: {noise: 0}}\n", ":2: columns: a: noise: expected a number > 0, got '0'"),
    ("parameters: {mass: }\n", ": expected measured columns, below 'columns'"),
    (COLUMNS, ": expected at least one unknown, below 'parameters' or 'initial'"),
    ("initial: {hinge: 3}\n" + COLUMNS, ":1: initial: hinge: expected a name like JOINT/position or JOINT/velocity"),
    ("initial: {hinge/position: {}}\n" + COLUMNS,
     ":1: initial: hinge/position: expected a key 'start': the value with which the search begins"),
    ("initial: {hinge/position: far}\n" + COLUMNS,
     ":1: initial: hinge/position: expected a number if it is known, or a mapping with start if it is unknown, "
     "got 'far'"),
    ("parameters: {mass: }\n" + COLUMNS + "begin: soon\n",
     ":3: begin: expected 'first', or the time of the data at which the scene starts [s], got 'soon'"),
    ("parameters: {mass: }\n" + COLUMNS + "commands: {between: hold}\n",
     ":3: commands: expected a key 'file' or 'topic'"),
    ("parameters: {mass: }\n" + COLUMNS + "commands: {file: a.csv, between: spline}\n",
     ":3: commands: between: expected 'hold' or 'line', got 'spline'"),
    ("parameters: {mass: }\n" + COLUMNS + "stop: 3\n",
     ":3: expected a key of parameters, initial, columns, commands, begin, until, step, tolerance, difference, "
     "derivatives, joint_states, got 'stop'"),
    ("parameters: {mass: }\n" + COLUMNS + "derivatives: complex\n",
     ":3: derivatives: expected 'differences' or 'forward', got 'complex'"),
    ("parameters: {mass: 1\n", ":2: expected ',' or '}', but got '<stream end>'"),
])
def test_errors_of_plans_say_where(tmp_path, text, error):
    with pytest.raises(InputError) as raised:
        plan_of(tmp_path, text)
    assert str(raised.value) == str(tmp_path / "plan.yaml") + error


def test_a_plan_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="none.yaml: cannot be read: No such file or directory"):
        read_plan(str(tmp_path / "none.yaml"), PARAMETERS)


PLAN = "parameters: {mass: }\ncolumns:\n  joint/hinge/position: {data: angle}\n  probe/tip/x:\n"
ROWS = "time,angle,other,probe/tip/x\n1.0,0.1,?,2\n1.5,,?,3\n2.0,0.3,?,nan\n2.5,0.4,?,5\n"


def measurements_of(tmp_path, text, plan=PLAN):
    path = tmp_path / "data.csv"
    path.write_text(text)
    return read_measurements(str(path), plan_of(tmp_path, plan))


def test_measurements_are_those_of_the_time_that_is_simulated(tmp_path):
    (angle, tip), begin = measurements_of(tmp_path, ROWS)
    assert begin == 0 and angle.times.tolist() == [1, 2, 2.5] and angle.values.tolist() == [0.1, 0.3, 0.4]
    assert tip.times.tolist() == [1, 1.5, 2.5] and tip.values.tolist() == [2, 3, 5]
    (angle, tip), begin = measurements_of(tmp_path, ROWS, PLAN + "begin: first\nuntil: 1\n")
    assert begin == 1 and angle.times.tolist() == [0, 1] and tip.times.tolist() == [0, 0.5]
    (angle, tip), begin = measurements_of(tmp_path, ROWS, PLAN + "begin: 1.2\n")
    assert begin == 1.2 and angle.times == pytest.approx([0.8, 1.3]) and tip.values.tolist() == [3, 5]


@pytest.mark.parametrize("text, error", [
    (ROWS.replace("angle", "phi"), ":1: expected one column 'angle', got the columns time, phi, other, probe/tip/x"),
    (ROWS.replace("other", "angle"),
     ":1: expected one column 'angle', got the columns time, angle, angle, probe/tip/x"),
    (ROWS.replace("0.3", "0,3"), ":4: expected 4 fields, got 5"),
    (ROWS.replace("0.3", "much"), ":4: angle: expected a number, got 'much'"),
    (ROWS.replace("0.3", "inf"), ":4: angle: expected a finite number, got 'inf'"),
    (ROWS.replace("2.0", "1.5"), ":4: time: expected more than 1.5, the time of the row before, got 1.5"),
    (ROWS.replace("2.0", ""), ":4: time: expected a finite number, got none"),
    ("time,angle,probe/tip/x\n", ": expected rows of numbers below the names of columns, got none"),
    ("", ":1: expected one column 'time', got the columns "),
])
def test_errors_of_measurements_say_where(tmp_path, text, error):
    with pytest.raises(InputError) as raised:
        measurements_of(tmp_path, text)
    assert str(raised.value) == str(tmp_path / "data.csv") + error


def test_measurements_at_other_times_are_an_error(tmp_path):
    with pytest.raises(InputError, match="'angle' has no value between 7 s, where the scene starts .* and inf s"):
        measurements_of(tmp_path, ROWS, PLAN + "begin: 7\n")


def efforts_of(tmp_path, name, text, commands="", begin=0.0):
    (tmp_path / name).write_text(text)
    plan = plan_of(tmp_path, PLAN + (commands or "commands: %s\n" % name))
    return read_efforts(plan.commands, "data.csv", begin)


EDGES = numpy.linspace(0, 4, 41)


def test_commands_of_a_schedule_are_pulses(tmp_path):
    text = """
commands:
  - {time: 0.5, names: [a, b], efforts: [1, -2], duration: 0.25, repeat: 2, every: 1}
  - {time: 1.5, names: [a], efforts: [3], duration: 0.5}
"""
    found = efforts_of(tmp_path, "commands.yaml", text)
    expected = numpy.zeros(40)
    expected[[5, 6, 15, 16]], expected[[7, 17]] = 1, 0.5
    assert found["b"].means(EDGES) == pytest.approx(-2 * expected, abs=1e-12)
    expected[15:20] += 3
    assert found["a"].means(EDGES) == pytest.approx(expected, abs=1e-12)
    demo = plan_of(tmp_path, PLAN + "commands: %s/config/demo_commands.yaml\n" % ROOT)
    joints = {"shoulder_yaw", "wrist_yaw", "shoulder_pitch", "elbow_pitch"}
    assert set(read_efforts(demo.commands, "data.csv", 0.0)) == joints


def test_commands_of_a_table_are_on_the_clock_of_the_data(tmp_path):
    text = "time,a,motor\n10,1,5\n11,3,7\n12,2,7\n"
    found = efforts_of(tmp_path, "efforts.csv", text, begin=10.0)
    assert set(found) == {"a", "motor"}
    assert found["a"].means(EDGES)[[0, 15, 30]] == pytest.approx([1.1 - 0.0, 2.45, 2], rel=1e-12)
    commands = "commands: {file: efforts.csv, joints: {elbow: motor}, between: hold}\n"
    (joint, history), = efforts_of(tmp_path, "efforts.csv", text, commands, 10.0).items()
    assert joint == "elbow" and history.means(EDGES)[[0, 15]] == pytest.approx([5, 7], rel=1e-12)


@pytest.mark.parametrize("name, text, error", [
    ("commands.yaml", "commands:\n  - {time: 0, names: [a], efforts: [1]}\n",
     "commands.yaml:2: commands: 1: expected a key 'duration'"),
    ("commands.yaml", "commands:\n  - {time: 0, names: [a], efforts: [1, 2], duration: 1}\n",
     "commands.yaml:2: commands: 1: expected one effort for each name, got 2 for 1"),
    ("commands.yaml", "commands:\n  - {time: 0, names: [a], efforts: [x], duration: 1}\n",
     "commands.yaml:2: commands: 1: efforts: 1: expected a finite number, got 'x'"),
    ("commands.yaml", "period: 3\n", "commands.yaml: expected at least one command"),
    ("efforts.csv", "time,a\n0,1\n1,\n", "efforts.csv: a: expected an effort in each row, got none at the time 1"),
])
def test_errors_of_commands_say_where(tmp_path, name, text, error):
    with pytest.raises(InputError) as raised:
        efforts_of(tmp_path, name, text)
    assert str(raised.value) == str(tmp_path / error)
