"""Test states as values: snapshots, pickles, copies, files."""

import copy
import pickle

import pytest

import flexarm
from conftest import bits, command_line, example


@pytest.fixture
def exact_arm():
    """Return an arm that continues bit for bit from a restored state."""
    return flexarm.Simulation(flexarm.read_scene(example("flexible_two_link_arm")), reuse_factorisation=False)


def motion(simulation, steps=20):
    return bits(simulation.run(steps, record=["*"]))


def test_back_to_a_snapshot(exact_arm):
    exact_arm.run(10, [0.5, -0.5])
    state = exact_arm.snapshot()
    first = motion(exact_arm)
    exact_arm.release_command("elbow")
    exact_arm.run(5)
    exact_arm.restore(state)
    assert exact_arm.time == pytest.approx(0.01, rel=1e-15)
    assert motion(exact_arm) == first
    exact_arm.restore(copy.deepcopy(copy.copy(state)))
    assert motion(exact_arm) == first


def test_pickles(exact_arm):
    exact_arm.run(10, [0.5, -0.5])
    state = exact_arm.snapshot()
    text = pickle.dumps(state)
    first = motion(exact_arm)
    # Another simulation of the same scene, as in another process.
    other = flexarm.Simulation(exact_arm.scene, reuse_factorisation=False)
    other.restore(pickle.loads(text))
    assert motion(other) == first
    other.restore(state)
    assert motion(other) == first
    other.restore(flexarm.State(bytes(state)))
    assert motion(other) == first
    assert bytes(pickle.loads(text)) == bytes(state)


def test_states_of_other_scenes_are_refused(exact_arm, pendulum):
    exact_arm.run(3)
    before = bits(exact_arm.row())
    for state in (pendulum.snapshot(), pickle.loads(pickle.dumps(pendulum.snapshot()))):
        with pytest.raises(ValueError, match="belongs to another scene, scheme or step"):
            exact_arm.restore(state)
    with pytest.raises(ValueError, match="checkpoint 'state'"):
        exact_arm.restore(flexarm.State(b"nonsense"))
    assert bits(exact_arm.row()) == before


def test_copies_go_their_own_way(exact_arm):
    exact_arm.run(10, [0.5, -0.5])
    for other in (copy.copy(exact_arm), copy.deepcopy(exact_arm)):
        state = exact_arm.snapshot()
        first = motion(exact_arm)
        assert other.time < exact_arm.time
        assert motion(other) == first
        # A snapshot of one simulation can be restored in the other.
        other.restore(state)
        exact_arm.restore(state)
        assert motion(other) == first


def test_a_snapshot_outlives_its_simulation(exact_arm):
    scene = exact_arm.scene
    simulation = flexarm.Simulation(scene, reuse_factorisation=False)
    simulation.run(10)
    state = simulation.snapshot()
    first = motion(simulation)
    del simulation
    exact_arm.restore(state)
    assert motion(exact_arm) == first


def test_files_are_those_of_the_command_line(tmp_path, exact_arm):
    path = tmp_path / "arm.state"
    status, said = command_line("simulate", example("flexible_two_link_arm"), "--until", "0.01", "--checkpoint", path,
                                "--quiet")
    assert status == 0, said
    other = flexarm.Simulation(exact_arm.scene, reuse_factorisation=False)
    other.read_checkpoint(path)
    exact_arm.run(10)
    assert motion(other) == motion(exact_arm)
    exact_arm.write_checkpoint(path)
    assert path.read_bytes() == bytes(exact_arm.snapshot())
    path.write_text("nonsense")
    with pytest.raises(RuntimeError, match="arm.state'"):
        exact_arm.read_checkpoint(path)


def test_reset(exact_arm):
    first = motion(exact_arm)
    exact_arm.command_effort("elbow", 1)
    exact_arm.run(3)
    exact_arm.reset()
    assert exact_arm.time == 0
    assert motion(exact_arm) == first


def test_another_scheme_takes_over(arm):
    arm.run(20)
    other = flexarm.Simulation(arm.scene, scheme="newmark")
    other.take_over(arm)
    assert other.time == arm.time
    assert bits(other.positions) == bits(arm.positions)
    with pytest.raises(ValueError):
        other.take_over(flexarm.Simulation(flexarm.read_scene(example("rigid_double_pendulum"))))
