"""Test runs: bits equal to those of the command line, arrays that are not copied, failures."""

import pickle
import tracemalloc

import numpy
import pytest

import flexarm
from conftest import bits, command_line, example, read_csv


@pytest.mark.parametrize("name, step, steps", [
    ("rigid_double_pendulum", 1e-3, 200),
    ("flexible_two_link_arm", 1e-3, 100),
    ("six_axis_arm", 1e-3, 50),
    ("sliding_arm", None, 40),
])
def test_histories_are_those_of_the_command_line(tmp_path, name, step, steps):
    simulation = flexarm.Simulation(flexarm.read_scene(example(name)), step=step)
    path = tmp_path / "history.csv"
    status, said = command_line("simulate", example(name), "--step", repr(simulation.step_size), "--until",
                                repr(steps * simulation.step_size), "--output", path, "--quiet", "--every", "2")
    assert status == 0, said
    names, history = read_csv(path)
    assert [column for column, _ in simulation.columns()] == names
    start = simulation.row()
    rows = simulation.run(steps, record=[], every=2)
    assert bits(numpy.vstack([start, rows])) == bits(history)


def test_some_columns_of_some_steps(arm):
    other = flexarm.Simulation(arm.scene)
    wanted = ["joint/*/position", "probe/payload/[xy]"]
    columns = arm.columns(wanted)
    assert columns[0] == ("time", "s")
    assert columns[1:3] == [("joint/shoulder/position", "rad"), ("joint/elbow/position", "rad")]
    rows = arm.run(20, record=wanted, every=5)
    assert rows.shape == (4, 5) == (4, len(columns))
    for row in rows:
        other.run(5)
        assert row[0] == other.time
        assert bits(row[1:3]) == bits(other.positions)
        assert bits(row[3:]) == bits(other.probe_poses[0, :2])
        assert bits(row) == bits(other.row(wanted))
    assert arm.run(7, record=wanted, every=5).shape == (1, 5)
    assert arm.run(0, record=wanted).shape == (0, 5)
    assert arm.run(3) is None


def test_steps_one_by_one_are_a_run(arm):
    other = flexarm.Simulation(arm.scene)
    for _ in range(10):
        result = other.step()
        assert result.iterations > 0 and result.halvings == 0
    arm.run(10)
    assert bits(arm.row()) == bits(other.row())


def test_efforts_of_each_step(arm):
    other = flexarm.Simulation(arm.scene)
    efforts = numpy.random.default_rng(1).normal(size=(30, 2))
    rows = arm.run(30, efforts, record=["joint/*/effort"])
    for n in range(30):
        other.command_efforts(efforts[n])
        other.step()
        # The effort in the results includes the joint's damping. The command is the same, bit for bit.
        assert bits(rows[n, 1:]) == bits(other.efforts)
    assert bits(arm.row()) == bits(other.row())


def test_efforts_held_and_of_chosen_joints(arm):
    other = flexarm.Simulation(arm.scene)
    arm.run(10, [0.5, -0.25])
    other.run(10, numpy.tile([-0.25, 0.5], (10, 1)), joints=["elbow", 0])
    assert bits(arm.row()) == bits(other.row())
    arm.run(10, [1.0], joints=["elbow"])
    other.command_effort("elbow", 1)
    other.run(10)
    assert bits(arm.row()) == bits(other.row())


def traced_peak(work):
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_arrays_are_not_copied(pendulum):
    efforts = numpy.zeros((2000, 2))
    out = numpy.empty((2000, 3))
    record = ["joint/*/position"]
    pendulum.run(1, record=record)  # looks up the columns
    # numpy reports its memory to tracemalloc.
    assert traced_peak(lambda: pendulum.run(2000, efforts, record=record, out=out)) < efforts.nbytes / 4
    results = pendulum.run(2000, efforts, record=record, out=out)
    assert numpy.shares_memory(results, out) and results.ctypes.data == out.ctypes.data
    assert traced_peak(lambda: pendulum.run(2000, efforts, record=record)) < 1.25 * out.nbytes
    # Arrays of other types than double are converted.
    assert traced_peak(lambda: pendulum.run(2000, efforts.astype("f4"))) > efforts.nbytes


def test_columns_of_results_are_in_order(pendulum):
    rows = pendulum.run(5, record=["energy/total"])
    assert rows.flags.c_contiguous and rows.flags.owndata and rows.dtype == float


@pytest.mark.parametrize("arguments, text", [
    (dict(steps=-1), "steps: expected a number >= 0, got -1"),
    (dict(steps=1, every=0), "every: expected a number >= 1, got 0"),
    (dict(steps=3, efforts=numpy.zeros((2, 2))),
     r"efforts: expected the shape \(3, 2\) or \(2,\), of the joints \[shoulder, elbow\], got \(2, 2\)"),
    (dict(steps=3, efforts=[1.0]), r"got \(1,\)"),
    (dict(steps=2, efforts=[[0, 1], [0, numpy.nan]]), "expected finite numbers, got nan in row 1 for joint 'elbow'"),
    (dict(steps=1, efforts=[0], joints=["wrist"]),
     r"name of a joint coordinate, one of \[shoulder, elbow\], or its index, got 'wrist'"),
    (dict(steps=1, efforts=[0], joints=[2]), "or its index, got 2"),
    (dict(steps=1, record=["joint/*", "nothing"]), "nothing"),
    (dict(steps=1, out=numpy.zeros((1, 2))), "'record'"),
    (dict(steps=2, record=["energy/total"], out=numpy.zeros((1, 2))),
     r"out: expected a writeable array of the shape \(2, 2\), got \(1, 2\)"),
])
def test_bad_arguments(pendulum, arguments, text):
    before = bits(pendulum.row())
    with pytest.raises(ValueError, match=text):
        pendulum.run(**arguments)
    assert bits(pendulum.row()) == before


def test_results_need_an_array_of_their_kind(pendulum):
    with pytest.raises(TypeError):
        pendulum.run(2, record=["energy/total"], out=numpy.zeros((2, 2), dtype="f4"))
    frozen = numpy.zeros((2, 2))
    frozen.flags.writeable = False
    with pytest.raises(ValueError, match="not writeable"):
        pendulum.run(2, record=["energy/total"], out=frozen)


def test_failed_steps_say_what_the_command_line_says(tmp_path, failing_scene):
    simulation = flexarm.Simulation(flexarm.read_scene(failing_scene))
    with pytest.raises(flexarm.StepError) as caught:
        simulation.run(1000, record=["joint/hinge/position"])
    error = caught.value
    status, said = command_line("simulate", failing_scene, "--until", "100", "--quiet", folder=tmp_path)
    assert status == 1
    assert "flexarm: simulation failed after t = %.17g s: %s" % (error.time, error) in said.splitlines()
    assert error.reason and error.reason in str(error)
    assert error.time == simulation.time == error.rows[-1, 0]
    assert error.rows.shape == (round(error.time / 0.1), 2)
    copy = pickle.loads(pickle.dumps(error))
    assert (str(copy), copy.time, copy.reason) == (str(error), error.time, error.reason)
    assert bits(copy.rows) == bits(error.rows)
    # The step fails again. After a reset the simulation can be used.
    with pytest.raises(flexarm.StepError) as again:
        simulation.step()
    assert str(again.value) == str(error)
    simulation.reset()
    assert simulation.time == 0
    assert bits(simulation.run(len(error.rows), record=["joint/hinge/position"])) == bits(error.rows)
