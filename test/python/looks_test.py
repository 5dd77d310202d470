"""Test what can be read from a simulation, and which commands it takes."""

import numpy
import pytest

import flexarm
from conftest import bits, example


def values(simulation, *patterns):
    return simulation.row(list(patterns))[1:]


def test_looks_are_the_columns_of_results(arm):
    arm.run(20)
    assert bits(arm.positions) == bits(values(arm, "joint/*/position"))
    assert bits(arm.velocities) == bits(values(arm, "joint/*/velocity"))
    assert bits(arm.efforts) == bits(values(arm, "joint/*/effort"))
    assert bits(arm.link_poses) == bits(values(arm, "frame/*"))
    assert bits(arm.probe_poses) == bits(values(arm, "probe/payload/[xyzq]*"))
    assert bits(arm.probe_velocities[:, :3]) == bits(values(arm, "probe/payload/v?"))
    assert bits(arm.probe_accelerations[:, :3]) == bits(values(arm, "probe/payload/a?"))
    assert bits(numpy.array(arm.energies)) == bits(values(arm, "energy/*"))
    assert bits(arm.momentum) == bits(values(arm, "momentum/*"))
    assert bits(arm.angular_momentum) == bits(values(arm, "angular_momentum/*"))
    assert arm.time == arm.row(["time"])[0]


def test_names_are_in_the_order_of_arrays(arm):
    assert arm.joint_names == arm.effort_joints == ["shoulder", "elbow"]
    assert arm.servo_joints == []
    assert arm.link_names == ["world", "upper_arm", "forearm", "payload"]
    assert arm.flexible_links == ["upper_arm", "forearm"]
    assert arm.probe_names == ["payload"]
    assert arm.link_poses.shape == arm.tip_poses.shape == (4, 7)
    assert "flexible_two_link_arm" in repr(arm) and "2 joints" in repr(arm)


def test_beams(arm):
    arm.run(20)
    points = arm.beam_points("upper_arm")
    assert points.shape == (9,)  # 4 elements of order 2
    assert points["pose"].shape == (9, 7) and points["strain"].shape == points["resultant"].shape == (9, 6)
    numpy.testing.assert_allclose(points["arc_length"], numpy.linspace(0, 1, 9), atol=1e-15)
    # Quaternions are computed again
    numpy.testing.assert_allclose(points["pose"][-1], arm.tip_poses[1], rtol=0, atol=4e-16)
    middle = arm.section("upper_arm", points["arc_length"][4])
    assert middle.shape == () and set(middle.dtype.names) == set(points.dtype.names)
    # The same interpolation at the same place, to within round-off of the arc length.
    numpy.testing.assert_allclose(middle["pose"], points["pose"][4], atol=1e-14)
    assert len(arm.beam_points("upper_arm", between=1)) == 17
    assert len(arm.beam_points("payload")) == 0
    with pytest.raises(ValueError, match="between"):
        arm.beam_points("upper_arm", -1)
    with pytest.raises(ValueError):
        arm.section("payload", 0)
    with pytest.raises(ValueError, match=r"name of a link, one of \[world, .*got 'nobody'"):
        arm.beam_points("nobody")


def test_arrays_are_copies(arm):
    positions = arm.positions
    before = positions.copy()
    positions += 1
    assert bits(arm.positions) == bits(before)
    arm.run(3)
    assert bits(positions) == bits(before + 1)


def test_commands_of_efforts(pendulum):
    pendulum.command_effort("elbow", 3)
    pendulum.step()
    moved = pendulum.efforts[1]
    pendulum.reset()
    pendulum.command_efforts([0, 3])
    pendulum.step()
    assert pendulum.efforts[1] == moved
    pendulum.reset()
    pendulum.command_effort(1, 3)
    pendulum.release_command("elbow")
    pendulum.step()
    still = pendulum.positions
    pendulum.reset()
    pendulum.step()
    assert bits(pendulum.positions) == bits(still)
    with pytest.raises(ValueError):
        pendulum.command_effort("elbow", numpy.inf)


def test_servos():
    simulation = flexarm.Simulation(flexarm.read_scene(example("six_axis_arm")))
    assert simulation.servo_joints == simulation.joint_names
    assert simulation.servo_mode("axis_1") == "position"
    simulation.command_set_point("axis_1", 0.25)
    assert simulation.set_point("axis_1") == 0.25
    simulation.release_set_point("axis_1")
    assert simulation.set_point("axis_1") != 0.25
    simulation.switch_servo("axis_6", False)
    simulation.step()
    with pytest.raises(ValueError, match="mode: expected 'effort', 'velocity' or 'position', got 'sideways'"):
        simulation.switch_mode("axis_1", "sideways")
    with pytest.raises(ValueError):
        simulation.switch_mode("axis_1", "velocity")  # the scene has no gains for this mode


def test_only_servos_take_set_points(pendulum):
    with pytest.raises(ValueError):
        pendulum.command_set_point("elbow", 1)


def test_wrenches(pendulum):
    # The forces balance gravity on both rods, for a while: 1 kg each.
    pendulum.apply_wrenches([flexarm.Wrench("upper_arm", (0, 0, 9.81), at=(0.5, 0, 0)),
                             flexarm.Wrench(2, [0, 0, 9.81], at=numpy.array([0.5, 0, 0]))])
    pendulum.run(10)
    # Newton's tolerance is 1e-8, so a step leaves an error of its square.
    numpy.testing.assert_allclose(pendulum.positions, 0, atol=1e-10)
    pendulum.apply_wrenches([flexarm.Wrench("forearm", at=(1, 0, 0), target=(2, 0, 1), stiffness=1000, damping=1)])
    pendulum.run(10)
    assert pendulum.probe_poses[0, 2] > 0
    pendulum.apply_wrenches([])
    with pytest.raises(ValueError):
        pendulum.apply_wrenches([flexarm.Wrench("world", (0, 0, 1))])
    with pytest.raises(ValueError, match=r"force of a wrench: expected three numbers, got the shape \(2,\)"):
        pendulum.apply_wrenches([flexarm.Wrench("forearm", (0, 1))])


def test_joints_are_put_elsewhere(pendulum):
    pendulum.set_joint_state({"elbow": 0.5}, {"elbow": -1, "shoulder": 2})
    assert bits(pendulum.positions) == bits(numpy.array([0, 0.5]))
    numpy.testing.assert_allclose(pendulum.velocities, [2, -1], rtol=1e-12)
    with pytest.raises(ValueError, match="got 'knee'"):
        pendulum.set_joint_state({"knee": 1})


def test_settings(pendulum):
    assert pendulum.step_size == 1e-3
    pendulum.step_size = 2e-3
    pendulum.run(5)
    assert pendulum.time == pytest.approx(0.01, rel=1e-15)
    with pytest.raises(ValueError):
        pendulum.step_size = 0
    pendulum.tolerance = 1e-10
    assert pendulum.tolerance == 1e-10
    with pytest.raises(ValueError):
        pendulum.tolerance = -1
    assert pendulum.degrees_of_freedom > 0 and pendulum.node_count > 0 and pendulum.mass == pytest.approx(2)
    fine = flexarm.Simulation(pendulum.scene, scheme="newmark", step=1e-4, tolerance=1e-9)
    assert (fine.scheme, fine.step_size, fine.tolerance) == ("newmark", 1e-4, 1e-9)


def test_contacts():
    ball = flexarm.Simulation(flexarm.read_scene_text(
        '<robot name="ball"><link name="world"/><ground name="floor"/>'
        '<joint name="fall" type="floating"><parent link="world"/><child link="ball"/></joint>'
        '<link name="ball"><inertial><mass value="2"/>'
        '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'
        '<collision><geometry><sphere radius="0.1"/></geometry></collision></link>'
        '<contact first="ball" second="floor"/><sensor name="bumper" kind="contact" link="ball"/>'
        '<simulation><initial joint="fall/z" position="0.11"/></simulation></robot>'))
    assert ball.contacts == []
    ball.run(2000)
    (contact,) = ball.contacts
    assert (contact.first, contact.second) == ("ball", "floor")
    numpy.testing.assert_allclose(contact.force, [0, 0, 2 * 9.81], atol=1e-4)
    numpy.testing.assert_allclose(contact.normal, [0, 0, 1], atol=1e-12)
    numpy.testing.assert_allclose(contact.position, [0, 0, -contact.penetration], atol=1e-12)
    assert bits(contact.force) == bits(values(ball, "contact/ball/floor/f[xyz]"))
    assert values(ball, "contact/ball/floor/points", "contact/ball/floor/gap").tolist() == [1, -contact.penetration]
    numpy.testing.assert_allclose(ball.sample("bumper")[:3], contact.force, atol=1e-12)
