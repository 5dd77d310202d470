"""Test the environment for reinforcement learning."""

import numpy
import pytest

import flexarm
from conftest import FAILING, bits


def height(observation, action, simulation):
    return simulation.probe_poses[0, 2] - 1e-3 * float(action @ action)


def test_steps_are_runs_of_the_simulation(pendulum):
    environment = flexarm.Environment(pendulum, height, steps=5, duration=0.02)
    observation, info = environment.reset(seed=1)
    assert environment.observation_names == ["joint/shoulder/position", "joint/elbow/position",
                                             "joint/shoulder/velocity", "joint/elbow/velocity"]
    assert environment.observation_units == ["rad", "rad", "rad/s", "rad/s"]
    assert environment.action_joints == ["shoulder", "elbow"]
    assert observation.shape == (4,) and info == {}
    over = []
    for n in range(4):
        action = numpy.array([n, -n], dtype=float)
        observation, reward, terminated, truncated, info = environment.step(action)
        pendulum.run(5, action)
        assert bits(observation) == bits(pendulum.row(["joint/*/position", "joint/*/velocity"])[1:])
        assert reward == height(observation, action, pendulum)
        assert terminated is False and info == {}
        over.append(truncated)
    assert over == [False, False, False, True]


def episode(environment, seed):
    observations = [environment.reset(seed=seed)[0]]
    observations += [environment.step([0.1, 0.2])[0] for _ in range(5)]
    return bits(numpy.array(observations))


def test_seeds_make_starts(pendulum):
    def start(simulation, random):
        simulation.set_joint_state({"elbow": random.uniform(-1, 1)})

    pendulum.run(7)
    environment = flexarm.Environment(pendulum, height, start=start)
    pendulum.run(100)  # the environment has a copy, which this does not move
    first = episode(environment, 3)
    assert episode(environment, 4) != first
    assert episode(environment, 3) == first
    environment.reset(seed=3)
    after = environment.reset()[0]  # the generator continues
    assert bits(after) != first[:len(bits(after))]
    assert environment.simulation.time == pytest.approx(0.007)


def test_ends_of_episodes(pendulum):
    environment = flexarm.Environment(pendulum.scene, height, ["probe/tip/z", "time"], joints=["elbow"],
                                      terminated=lambda observation, simulation: observation[1] < -0.01)
    assert environment.observation_names == ["time", "probe/tip/z"]
    environment.reset()
    ends = [environment.step([0.0])[2] for _ in range(60)]
    assert ends[0] is False and ends[-1] is True
    assert ends == sorted(ends)
    with pytest.raises(ValueError, match=r"expected the shape \(1, 1\) or \(1,\), of the joints \[elbow\]"):
        environment.step([0.0, 0.0])
    with pytest.raises(ValueError, match="steps: expected a number >= 1, got 0"):
        flexarm.Environment(pendulum, height, steps=0)


def test_failed_steps_end_episodes():
    scene = flexarm.read_scene_text(FAILING)
    environment = flexarm.Environment(scene, lambda *_: 1.0, failure_reward=-5)
    environment.reset()
    assert environment.step([0.0])[1:] == (1, False, False, {})
    observation, reward, terminated, truncated, info = environment.step([1e5])
    assert reward == -5 and terminated is True and truncated is False
    assert "hinge" in info["failure"] or "rod" in info["failure"]
    assert observation.shape == (2,)
    assert environment.reset()[0][0] == 0
