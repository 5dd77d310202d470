"""Test simulations that are stepped together."""

import copy

import numpy
import pytest

import flexarm
from conftest import FAILING, bits, example

ALL = ["time", "joint/*", "energy/total"]


def arms(count):
    """Return different arms, and copies of them."""
    scene = example("flexible_two_link_arm")
    simulations = [flexarm.Simulation(scene) for _ in range(count)]
    for i, simulation in enumerate(simulations):
        simulation.set_joint_state({"elbow": 0.1 * i})
    return simulations, [copy.copy(simulation) for simulation in simulations]


@pytest.mark.parametrize("threads", [None, 1, 3])
def test_each_has_the_bits_of_a_single_simulation(threads):
    together, alone = arms(5)
    batch = flexarm.Batch(together, threads)
    assert len(batch) == 5 and batch[2] is together[2] and batch[-1] is together[4]
    assert threads is None or batch.threads == threads
    efforts = numpy.random.default_rng(1).normal(size=(5, 12, 2))
    rows = batch.run(12, efforts, record=ALL, every=3)
    assert rows.shape == (5, 4, len(alone[0].columns(ALL))) and batch.failures == 5 * [None]
    for i, simulation in enumerate(alone):
        assert bits(rows[i]) == bits(simulation.run(12, efforts[i], record=ALL, every=3))
    assert bits(batch.row(ALL)) == bits(numpy.array([simulation.row(ALL) for simulation in alone]))


def test_efforts_of_each_and_of_all_and_some_that_rest():
    together, alone = arms(3)
    batch = flexarm.Batch(together)
    efforts = numpy.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
    assert batch.run(4, efforts) is None
    batch.run(4, [0.5], joints=["elbow"], which=[True, False, True])
    for i, simulation in enumerate(alone):
        simulation.run(4, efforts[i])
        if i != 1:
            simulation.run(4, [0.5], joints=["elbow"])
    assert bits(batch.row(ALL)) == bits(numpy.array([simulation.row(ALL) for simulation in alone]))


def test_failures_are_told_when_all_others_have_ended():
    scene = flexarm.read_scene_text(FAILING)
    batch = flexarm.Batch([flexarm.Simulation(scene) for _ in range(3)])
    efforts = [[0.0], [1e5], [0.0]]
    with pytest.raises(flexarm.StepError, match="simulation 1: .*Newton") as failure:
        batch.run(2, efforts, record=["time"])
    assert failure.value.rows.shape == (3, 2, 1)
    assert numpy.isnan(failure.value.rows[1]).all() and not numpy.isnan(failure.value.rows[[0, 2]]).any()
    assert [text is None for text in batch.failures] == [True, False, True]
    batch.run(1, efforts, raise_failures=False)
    assert "Newton" in batch.failures[1]
    batch.run(1, which=[True, False, True])
    assert batch.failures == 3 * [None]


def test_bad_arguments_are_refused_before_anything_moves():
    together, _ = arms(2)
    batch = flexarm.Batch(together)
    before = bits(batch.row(ALL))
    for arguments, text in [
            ({"steps": -1}, "steps: expected a number >= 0, got -1"),
            ({"steps": 1, "every": 0}, "every: expected a number >= 1, got 0"),
            ({"steps": 3, "efforts": [[1.0, 2.0]]},
             r"efforts: expected the shape \(2, 3, 2\), \(2, 2\) or \(2,\), of the joints \[shoulder, elbow\], got "
             r"\(1, 2\)"),
            ({"steps": 1, "efforts": [[1.0, numpy.nan], [0, 0]]}, "efforts: expected finite numbers, got nan"),
            ({"steps": 1, "which": [True]}, "which: expected 2 truth values, got 1"),
            ({"steps": 1, "record": ["no/such"]}, "no/such")]:
        with pytest.raises(ValueError, match=text):
            batch.run(**arguments)
    assert bits(batch.row(ALL)) == before
    with pytest.raises(ValueError, match="at least one simulation"):
        flexarm.Batch([])
    with pytest.raises(ValueError, match="simulation 1 is there twice"):
        flexarm.Batch([together[0], together[0]])
    with pytest.raises(ValueError, match="threads: expected a number >= 1, got 0"):
        flexarm.Batch(together, 0)
    with pytest.raises(ValueError, match="expected the same joints in all, but not in number 1"):
        flexarm.Batch([together[0], flexarm.Simulation(example("six_axis_arm"))])
    with pytest.raises(IndexError, match="expected an index below 2, got 2"):
        batch[2]


def test_parameters_may_differ():
    """Each simulation may have a scene of its own, such as one with other parameters."""
    text = """<robot name="pendulum"><parameter name="length" value="1"/><link name="world"/>
      <link name="bob"><inertial><origin xyz="${length} 0 0"/><mass value="1"/>
        <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="hinge" type="continuous"><parent link="world"/><child link="bob"/><axis xyz="0 1 0"/></joint>
      <simulation><gravity xyz="0 0 -9.81"/></simulation></robot>"""
    lengths = [0.5, 1.0, 2.0]
    batch = flexarm.Batch([flexarm.Simulation(flexarm.read_scene_text(text, parameters={"length": length}))
                           for length in lengths])
    batch.run(10)
    rates = batch.row(["joint/hinge/velocity"])[:, 1]
    times = [batch[i].time for i in range(3)]
    for length, rate, time in zip(lengths, rates, times):
        # It falls from the horizontal; the next term is of the order of rate^2 time^2.
        assert rate == pytest.approx(9.81 * length / (length ** 2 + 1e-3) * time, rel=1e-3)
