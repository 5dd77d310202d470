"""Test sensitivities of runs over stops and dry friction against ODE solvers with events."""

import numpy
import pytest

import flexarm
from cornered_arm import bouncing, bouncing_arm, fourth_order, rubbing, rubbing_arm


def sensitivity(text, parameter, until):
    simulation = flexarm.Simulation(flexarm.read_scene_text(text))
    run = simulation.sensitivities([parameter])
    run.run(round(until / simulation.step_size))
    assert run.lost == ""
    return run.positions[0, 0], run.events


def angle_at(motion):
    return motion[0, -1]


@pytest.mark.parametrize("until", [0.8, 1.6, 2.5, 3.5])  # before, after one reversal, after two, at rest
def test_dry_friction(until):
    exact = fourth_order(lambda way: angle_at(rubbing(1.5 + way, numpy.array([until]))[0]), 1e-4)
    for step in (1e-3, 1e-4):
        found, _ = sensitivity(rubbing_arm(step), "fc", until)
        # At each reversal a run stands still for up to one step. The derivative changes by up to 4.5 per second, and
        # the reversals themselves may add up to 5 per second.
        assert found == pytest.approx(exact, abs=2 * 5 * step)


@pytest.mark.parametrize("step", [1e-3, 1e-4])
def test_stop(step):
    exact = fourth_order(lambda way: angle_at(bouncing(1 + way, step, numpy.array([0.56]))), 1e-5)
    found, events = sensitivity(bouncing_arm(step), "angle", 0.56)
    assert [own.what for own in events] == ["touches its stop", "leaves its stop"]
    assert {own.joint for own in events} == {"h"} and not any(own.doubt for own in events)
    # The result is the sum of two opposite terms of size 1.5, and the restitution of the run is accurate to 5 %.
    assert found == pytest.approx(exact, abs=0.05 * 1.5)
    numpy.testing.assert_allclose(exact, {1e-3: -0.58524, 1e-4: -0.54070}[step], atol=1e-5)


def test_error_over_dry_friction_is_of_first_order():
    until = numpy.array([1.6])
    exact = fourth_order(lambda way: angle_at(rubbing(1.5 + way, until)[0]), 1e-4)
    # The place of a reversal within a step is random. Take the worst of some numbers of steps that share no divisor.
    worst = [max(abs(sensitivity(rubbing_arm(1.6 / steps), "fc", 1.6)[0] - exact) for steps in counts)
             for counts in ((401, 449, 503), (4001, 4507, 5003))]
    assert worst[1] < worst[0] / 5


TOUCHING = """<robot name="touching"> <parameter name="mu" value="0.3"/> <parameter name="height" value="{height}"/>
  <link name="world"/> <ground name="floor"/>
  <joint name="j" type="floating"> <parent link="world"/> <child link="block"/> </joint>
  <link name="block"> <inertial> <mass value="1"/>
    <inertia ixx="2e-3" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/> </inertial>
    <collision> <geometry> <box size="0.1 0.1 0.1"/> </geometry> </collision> </link>
  <contact first="block" second="floor" friction="${{mu}}"/>
  <simulation> <gravity xyz="4 0 -8"/> <integrator step="1e-3"/> <initial joint="j/z" position="${{height}}"/>
  </simulation> </robot>"""


def test_friction_of_what_slides():
    # The block starts in equilibrium of its weight and the contact's stiffness, m (pi / 10 h)^2 on all corners, so that
    # nothing settles.
    depth = 8 / (numpy.pi / 10e-3) ** 2
    found, events = sensitivity(TOUCHING.format(height=0.05 - depth), "mu", 0.5)
    # The block does not stick in any of the first steps, while friction builds up. The slip of a step is 4e-6 m at
    # first, and the tangential contact gives way by mu m g / k = 2.4e-5 m. So the block slides fully after some 5
    # steps.
    assert found == pytest.approx(-0.5 * 8 * 0.5**2, rel=2 * 5e-3 / 0.5)
    assert events == []


def test_hits_are_doubtful():
    _, events = sensitivity(TOUCHING.format(height=0.06), "mu", 0.3)
    assert [(own.joint, own.what) for own in events][0] == ("block and floor", "hit each other")
    assert all("depends on the time of the hit" in own.doubt for own in events)
