"""Test several environments as one, and the parts of gymnasium's interface that both kinds have."""

import numpy
import pytest

import flexarm
from conftest import FAILING, bits, example
from flexarm import spaces

OBSERVED = ["joint/*/position", "joint/*/velocity"]


def speed(observation, action, simulation):
    return float(abs(observation[2:]).sum()) - 1e-3 * float(action @ action)


def somewhere(simulation, random):
    simulation.set_joint_state({"shoulder": random.uniform(-1, 1), "elbow": random.uniform(-1, 1)})


OPTIONS = {"steps": 20, "duration": 0.1, "start": somewhere}


def vector(num_envs, threads):
    scene = flexarm.read_scene(example("flexible_two_link_arm"))
    return flexarm.VectorEnvironment(scene, speed, OBSERVED, num_envs=num_envs, threads=threads, **OPTIONS)


def history(environment, actions, seed):
    """Return all outputs of an environment as numbers."""
    rows = [environment.reset(seed=seed)[0].tolist()]
    for action in actions:
        observation, *outcome, _ = environment.step(action)
        rows.append([observation.tolist(), [numpy.asarray(number, dtype=float).tolist() for number in outcome]])
    return rows


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_results_have_the_bits_of_environments_one_by_one(threads):
    actions = numpy.random.default_rng(1).normal(size=(4, 3, 2))
    together = history(vector(3, threads), actions, seed=7)
    for i in range(3):
        alone = flexarm.Environment(example("flexible_two_link_arm"), speed, OBSERVED, **OPTIONS)
        rows = history(alone, actions[:, i], seed=7 + i)
        assert rows[0] == together[0][i]
        for mine, all_ in zip(rows[1:], together[1:]):
            assert mine[0] == all_[0][i] and mine[1] == [numbers[i] for numbers in all_[1]]


def test_what_has_ended_begins_anew_by_the_next_step():
    environment = vector(2, 2)
    environment.reset(seed=[3, None])
    actions = numpy.ones((2, 2))
    ends = [environment.step(actions)[3].tolist() for _ in range(5)]
    assert ends == 4 * [[False, False]] + [[True, True]]
    observations, rewards, terminated, truncated, infos = environment.step(actions)
    assert rewards.tolist() == [0, 0] and not terminated.any() and not truncated.any() and infos == {}
    assert [each.simulation.time for each in environment.environments] == [0, 0]
    assert (observations[:, 2:] == 0).all()
    assert environment.metadata["autoreset_mode"] in ("NextStep", getattr(
        getattr(getattr(spaces.gymnasium, "vector", None), "AutoresetMode", None), "NEXT_STEP", None))
    environment.close()


def test_failures_are_told_of_those_that_failed():
    scene = flexarm.read_scene_text(FAILING)
    environment = flexarm.VectorEnvironment(scene, lambda *_: 1.0, num_envs=2, failure_reward=-5)
    environment.reset()
    observations, rewards, terminated, truncated, infos = environment.step([[0.0], [1e5]])
    assert rewards.tolist() == [1, -5] and terminated.tolist() == [False, True] and not truncated.any()
    assert infos["_failure"].tolist() == [False, True]
    assert infos["failure"][0] is None and "Newton" in infos["failure"][1]
    assert observations.shape == (2, 2)
    environment.close()


def test_bad_arguments_are_refused_before_anything_moves():
    environment = vector(2, 2)
    environment.reset(seed=1)
    before = [bits(each.simulation.positions) for each in environment.environments]
    with pytest.raises(ValueError, match=r"actions: expected the shape \(2, 2\), got \(2,\)"):
        environment.step([1.0, 2.0])
    with pytest.raises(ValueError, match="actions: expected finite numbers, got nan"):
        environment.step([[1.0, 2.0], [numpy.nan, 0.0]])
    with pytest.raises(ValueError, match="seed: expected a number or 2 of them, got 3"):
        environment.reset(seed=[1, 2, 3])
    assert [bits(each.simulation.positions) for each in environment.environments] == before
    for name in ("num_envs", "threads"):
        with pytest.raises(ValueError, match=name + ": expected a number >= 1, got 0"):
            flexarm.VectorEnvironment(example("rigid_double_pendulum"), speed, **{"num_envs": 1, name: 0})
    with pytest.raises(ValueError, match=r"expected joints that take efforts, of \[shoulder, elbow\], got 'hip'"):
        flexarm.Environment(example("rigid_double_pendulum"), speed, joints=["hip"])


def test_spaces():
    environment = vector(3, 1)
    assert environment.single_observation_space.shape == (4,) and environment.observation_space.shape == (3, 4)
    assert environment.single_action_space.shape == (2,) and environment.action_space.shape == (3, 2)
    observations, _ = environment.reset(seed=0)
    assert environment.observation_space.contains(observations)
    assert environment.environments[0].observation_space.contains(observations[0])
    environment.action_space.seed(4)
    first = environment.action_space.sample()
    environment.action_space.seed(4)
    assert bits(environment.action_space.sample()) == bits(first) and environment.action_space.contains(first)
    arm = flexarm.Environment(example("six_axis_arm"), speed)
    limits = dict(zip(arm.simulation.joint_names, arm.simulation.effort_limits))
    assert arm.action_space.high.tolist() == [limits[name] for name in arm.action_joints]
    assert (arm.action_space.low == -arm.action_space.high).all()


def test_samples_keep_to_bounds():
    """Check the space that exists without gymnasium, or gymnasium's own."""
    low, high = [-1, 0, -numpy.inf, -numpy.inf], [2, numpy.inf, 0, numpy.inf]
    space = spaces.Box(numpy.array(low, dtype=float), numpy.array(high, dtype=float), (4,), numpy.float64)
    space.seed(1)
    samples = numpy.array([space.sample() for _ in range(100)])
    assert all(space.contains(sample) for sample in samples) and samples.shape == (100, 4)
    assert not space.contains(numpy.array([3.0, 1, -1, 0])) and not space.contains(numpy.zeros(3))
    assert (samples.std(axis=0) > 0.1).all()


def test_gymnasium_takes_them_for_its_own():
    gymnasium = pytest.importorskip("gymnasium")
    from gymnasium.utils.env_checker import check_env

    name = "flexarm.environment:flexarm/Environment-v0"
    arguments = {"simulation": example("flexible_two_link_arm"), "reward": speed, "observation": OBSERVED, **OPTIONS}
    check_env(gymnasium.make(name, **arguments).unwrapped)
    several = gymnasium.make_vec(name, num_envs=2, vectorization_mode="vector_entry_point", **arguments)
    assert isinstance(several.unwrapped, flexarm.VectorEnvironment)
    observations, infos = several.reset(seed=0)
    assert several.observation_space.contains(observations)
    several.step(several.action_space.sample())
    several.close()
