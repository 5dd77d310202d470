"""Test the search for settings (tuning) in Python."""

import math

import numpy
import pytest

import flexarm
from conftest import example

INTERVALS = 50


def tip(simulation, until):
    """Return the positions of the tip at the ends of intervals, shape (INTERVALS + 1, 3)."""
    record = ["probe/tip/[xyz]"]
    steps = round(until / simulation.step_size)
    assert steps % INTERVALS == 0
    rows = simulation.run(steps, record=record, every=steps // INTERVALS)
    return rows[:, 1:]


def test_the_tuned_scene_is_as_accurate_as_was_asked_for():
    scene = flexarm.read_scene(example("rigid_double_pendulum"))
    accuracy, until = 1e-2, 1.0
    tuning = flexarm.tune(scene, accuracy, until=until, intervals=INTERVALS)
    assert tuning.error <= accuracy and tuning.runs > 1 and tuning.load > 0
    assert (tuning.scene.scheme, tuning.scene.step) == (tuning.scheme, tuning.step)
    reference = flexarm.Simulation(scene).run_to_accuracy(until, 1e-3 * accuracy, intervals=INTERVALS,
                                                          record=["probe/tip/[xyz]"]).rows[:, 1:]
    simulation = flexarm.Simulation(tuning.scene)
    assert simulation.tolerance == tuning.tolerance
    positions = tip(simulation, until)
    # The root mean square by the trapezoidal rule. At the start there is no error.
    squares = ((positions - reference[1:]) ** 2).sum(axis=1)
    squares[-1] /= 2
    way = numpy.linalg.norm(reference - reference[0], axis=1).max()
    assert tuning.scale == pytest.approx(way, rel=accuracy)
    assert math.sqrt(squares.sum() / INTERVALS) / way <= accuracy * (1 + 1e-3)


def test_what_cannot_be_met():
    scene = flexarm.read_scene(example("rigid_double_pendulum"))
    with pytest.raises(flexarm.AccuracyError, match="an error of 1e-06 cannot be met: .+"):
        flexarm.tune(scene, 1e-6, until=1, budget=1e-3)


@pytest.mark.parametrize("arguments, text", [
    ({}, "expected either an accuracy or real_time"),
    (dict(accuracy=1e-3, real_time=2), "expected either an accuracy or real_time"),
    (dict(accuracy=-1), "accuracy: expected a number > 0, got -1"),
    (dict(real_time=2, margin=0), "margin: expected a number > 0, got 0"),
    (dict(accuracy=1e-3, until=0), "until: expected a time > 0, got 0"),
])
def test_bad_arguments(arguments, text):
    with pytest.raises(ValueError, match=text):
        flexarm.tune(flexarm.read_scene(example("rigid_double_pendulum")), **arguments)
