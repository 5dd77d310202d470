"""Test links that are attached and detached, and models that are added and removed."""

import warnings

import numpy
import pytest

import flexarm
from conftest import hinged_rod

BALL = """
<robot name="ball"> <link name="ball"> <inertial> <mass value="0.5"/>
  <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/> </inertial> </link> </robot>"""
INERTIA, SPEED = 0.1, 2.0  # rod: about its hinge [kg m^2], speed [rad/s]
TOGETHER = INERTIA + 0.01 + 0.5  # inertia with the ball at 1 m


@pytest.fixture
def rod():
    simulation = """<gravity xyz="0 0 0"/> <initial joint="hinge" velocity="%g"/>""" % SPEED
    scene = hinged_rod("0 0 1", "0 0 0", (INERTIA, INERTIA, INERTIA), simulation)
    return flexarm.Simulation(flexarm.read_scene_text(scene, "rod"))


def spawn_ball(rod, **where):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # no warning that its root is clamped, as it floats
        ball = flexarm.read_scene_text(BALL, "ball", to_spawn=True)
    rod.spawn(ball, **where)


def pose_of(rod, link):
    return rod.link_poses[rod.link_names.index(link)]


def test_a_ball_is_taken_and_flies_on(rod):
    spawn_ball(rod, position=(1, 0, 0))
    assert rod.link_names[-1] == "ball"
    rod.attach("ball", "rod")
    assert rod.joint_names == ["hinge"]
    speed = SPEED * INERTIA / TOGETHER
    assert rod.velocities[0] == pytest.approx(speed, abs=1e-10)
    lost = 0.5 * INERTIA * SPEED**2 - 0.5 * TOGETHER * speed**2
    assert rod.energies.dissipated == pytest.approx(lost, abs=1e-10)
    rod.detach("ball")
    rod.run(1000)
    place = pose_of(rod, "ball")[:3]
    assert place == pytest.approx([1, speed, 0], abs=1e-9)


def test_models_come_at_a_pose_with_a_velocity_and_a_name(rod):
    spawn_ball(rod, position=(0, 0, 5), orientation=(0, 0, 1, 0), linear=(0, 0, 1), prefix="my_")
    rod.run(500)
    assert pose_of(rod, "my_ball")[:3] == pytest.approx([0, 0, 5.5], abs=1e-12)
    assert numpy.abs(pose_of(rod, "my_ball")[3:]) == pytest.approx([0, 0, 1, 0], abs=1e-12)
    rod.remove("my_ball")
    assert "my_ball" not in rod.link_names


def test_states_of_before_are_refused(rod):
    before, other = rod.snapshot(), flexarm.Simulation(rod.scene)
    spawn_ball(rod, position=(1, 0, 0))
    with pytest.raises(ValueError, match="links were added or removed"):
        rod.restore(before)
    after = rod.snapshot()
    rod.run(100)
    rod.restore(after)
    with pytest.raises(ValueError):
        other.restore(after)
    with pytest.raises(ValueError, match="not available after links were added"):
        rod.sensitivities([])


def test_what_cannot_be_is_said(rod):
    with pytest.raises(ValueError, match="there is no link 'nose'"):
        rod.attach("nose", "rod")
    with pytest.raises(ValueError, match="does not float"):
        rod.attach("rod", "world")
    with pytest.raises(ValueError, match="there is no link 'nose'"):
        rod.remove("nose")
    spawn_ball(rod)
    with pytest.raises(ValueError, match="ball"):
        spawn_ball(rod)  # its names are in use
