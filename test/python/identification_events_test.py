"""Test `flexarm identify` with `derivatives: forward` for stops and dry friction, on motions by ODE solvers."""

import json

import numpy
import pytest

from conftest import command_line
from cornered_arm import LOWER, START, bouncing, bouncing_arm, fourth_order, rubbing, rubbing_arm
from identification import Column, Experiment, Measurement, Setting, unknown

NOISE, STEP = 1e-3, 1e-3  # rad, s


def identified(folder, scene, times, angles, name):
    """Return the value that the program finds for a parameter from a table of angles. Check that it used forward
    derivatives."""
    (folder / "arm.urdf").write_text(scene)
    numpy.savetxt(folder / "data.csv", numpy.column_stack([times, angles]), delimiter=",", comments="", fmt="%.17g",
                  header="time,joint/h/position")
    (folder / "plan.yaml").write_text("parameters: {%s: }\nderivatives: forward\n"
                                      "columns: {joint/h/position: {noise: %r}}\n" % (name, NOISE))
    status, said = command_line("identify", "arm.urdf", "data.csv", "plan.yaml", "--quiet", folder=folder)
    assert status == 0, said
    with open(folder / "arm_fitted.json", encoding="utf-8") as file:
        found = json.load(file)
    assert found["converged"]
    (estimate,) = found["unknowns"]
    column = Column("joint/h/position", "joint/h/position", NOISE, None)
    experiment = Experiment([unknown(name, estimate["estimate"])], {}, [Measurement(column, times, angles)], {},
                            Setting(str(folder / "arm.urdf"), {}, STEP, 1e-10))
    assert experiment.derivatives([estimate["estimate"]]) is not None, "differences stood in"
    return estimate["estimate"]


# At each reversal, a run stands still for up to one step, and is late by this time from there on. The error of the
# estimate is at most this error divided by the sensitivity of the motion to the friction, both in the norm of the fit.
@pytest.mark.parametrize("scheme", ["em", "edmc2"])
def test_coulomb_friction_is_recovered(tmp_path, scheme):
    truth, times = 1.1, numpy.linspace(0, 3, 301)
    (angles, rates), turns = rubbing(truth, times)
    assert turns >= 2
    slope = fourth_order(lambda way: rubbing(truth + way, times)[0][0], 1e-4)
    bound = turns * STEP * numpy.linalg.norm(rates) / numpy.linalg.norm(slope)
    assert bound < 0.02 * truth
    found = identified(tmp_path, rubbing_arm(STEP, friction=1.5, scheme=scheme), times, angles, "fc")
    assert found == pytest.approx(truth, abs=bound)


# The rebound speed follows the law to within 5 % of the incoming speed. The motion after the hit has this error.
def test_place_of_a_stop_is_recovered(tmp_path):
    truth, times = -0.43, numpy.linspace(0, 0.6, 301)
    angles, rates = bouncing(START, STEP, times, lower=truth)
    hit = times[numpy.argmin(angles)]
    slope = fourth_order(lambda way: bouncing(START, STEP, times, lower=truth + way)[0], 1e-5)
    off = numpy.where(times > hit, 0.05 * abs(rates).max() * (times - hit), 0)
    bound = numpy.linalg.norm(off) / numpy.linalg.norm(slope)
    assert bound < 0.5 * abs(truth - LOWER), "the search has farther to go than that"
    found = identified(tmp_path, bouncing_arm(STEP), times, angles, "lower")
    assert found == pytest.approx(truth, abs=bound)
