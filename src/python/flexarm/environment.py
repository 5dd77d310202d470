"""Simulations as environments for reinforcement learning: single ones, and vectors that step in threads."""

import copy
import os
import typing

import numpy

from ._flexarm import Batch, Scene, Simulation
from .errors import StepError
from .spaces import AUTORESET, Box, Env, VectorEnv, batch_space, register

Reward = typing.Callable[[numpy.ndarray, numpy.ndarray, Simulation], float]
Terminated = typing.Callable[[numpy.ndarray, Simulation], bool]
Start = typing.Callable[[Simulation, numpy.random.Generator], None]
Info = typing.Dict[str, typing.Any]
Outcomes = typing.Tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray, numpy.ndarray, Info]
Outcome = typing.Tuple[numpy.ndarray, float, bool, bool, Info]
SimulationOrScene = typing.Union[Simulation, Scene, str, "os.PathLike[str]"]


class Environment(Env):
    """A simulation as an environment for reinforcement learning, with gymnasium's reset() and step().

    If gymnasium is installed, this class is a gymnasium.Env; it also works without gymnasium.

    simulation: a Simulation, which is copied, or a Scene, or the path of a scene's file. reset() returns to the state
      that the simulation has when the environment is made.
    reward: `reward(observation, action, simulation)`, called after each step; returns a number.
    observation: patterns of columns, as in Simulation.run(). The time is included only if a pattern asks for it.
    joints: names or indices of the joints whose efforts are an action, in this order; None: all of effort_joints.
    steps: of the simulation per action; the action is held meanwhile.
    duration: of an episode [s]; None: unlimited.
    terminated: `terminated(observation, simulation)`, called after each step; None: episodes never terminate so.
    start: `start(simulation, random)`, called by reset() with a numpy.random.Generator; None: no changes at the start.
    failure_reward: the reward if a step of the simulation fails, which ends the episode.

    observation_space: shape (columns,), unbounded. action_space: shape (joints,), bounded by effort_limits.
    observation_names, observation_units: of an observation's numbers, lists of length `columns`.
    action_joints: names of an action's joints; actions have the shape (joints,) [N m or N].
    simulation: the simulation that is stepped; only to be read.
    """

    metadata: typing.Dict[str, typing.Any] = {"render_modes": []}

    def __init__(self, simulation: SimulationOrScene, reward: Reward,
                 observation: typing.Sequence[str] = ("joint/*/position", "joint/*/velocity"), *,
                 joints: typing.Optional[typing.Sequence[typing.Union[int, str]]] = None, steps: int = 1,
                 duration: typing.Optional[float] = None, terminated: typing.Optional[Terminated] = None,
                 start: typing.Optional[Start] = None, failure_reward: float = 0.0) -> None:
        if steps < 1:
            raise ValueError("steps: expected a number >= 1, got %s" % steps)
        self.simulation = copy.copy(simulation) if isinstance(simulation, Simulation) else Simulation(simulation)
        self._reward, self._terminated, self._start = reward, terminated, start
        self._steps, self._duration, self._failure_reward = steps, duration, failure_reward
        self.action_joints = self._names_of(joints)
        limits = dict(zip(self.simulation.joint_names, self.simulation.effort_limits))
        bound = numpy.array([limits[name] for name in self.action_joints])
        self.action_space = Box(-bound, bound, bound.shape, numpy.float64)
        self._record = list(observation)
        columns = self.simulation.columns(self._record)
        self._first = 0 if "time" in self._record else 1
        self.observation_names = [name for name, _ in columns[self._first:]]
        self.observation_units = [unit for _, unit in columns[self._first:]]
        self.observation_space = Box(-numpy.inf, numpy.inf, (len(self.observation_names),), numpy.float64)
        self._initial = self.simulation.snapshot()
        self._begin = self.simulation.time

    def _names_of(self, joints: typing.Optional[typing.Sequence[typing.Union[int, str]]]) -> typing.List[str]:
        known = self.simulation.effort_joints
        if joints is None:
            return known
        names = [joint if isinstance(joint, str) else self.simulation.joint_names[joint] for joint in joints]
        for name in names:
            if name not in known:
                raise ValueError("joints: expected joints that take efforts, of [%s], got '%s'"
                                 % (", ".join(known), name))
        return names

    def _observe(self) -> numpy.ndarray:
        return self.simulation.row(self._record)[self._first:]

    def reset(self, *, seed: typing.Optional[int] = None,
              options: typing.Optional[Info] = None) -> typing.Tuple[numpy.ndarray, Info]:
        """Begins an episode. `seed`: for the generator of `start`; None: the generator goes on. Options are ignored.

        Returns the observation and an empty dictionary.
        """
        super().reset(seed=seed)
        self.simulation.restore(self._initial)
        if self._start is not None:
            self._start(self.simulation, self.np_random)
        return self._observe(), {}

    def step(self, action: typing.Any) -> Outcome:
        """Holds the action, efforts of the shape (joints,) [N m or N], for `steps` steps of the simulation.

        Returns observation, reward, terminated, truncated (whether the duration is over), and a dictionary. If a step
        of the simulation fails, the episode ends, and the dictionary's "failure" contains the reason.
        """
        action = numpy.ascontiguousarray(action, dtype=float)
        failure = None
        try:
            self.simulation.run(self._steps, action, self.action_joints)
        except StepError as error:
            failure = str(error)
        return self._judge(self._observe(), action, failure)

    def _judge(self, observation: numpy.ndarray, action: numpy.ndarray, failure: typing.Optional[str]) -> Outcome:
        if failure is not None:
            return observation, float(self._failure_reward), True, False, {"failure": failure}
        reward = float(self._reward(observation, action, self.simulation))
        terminated = self._terminated is not None and bool(self._terminated(observation, self.simulation))
        return observation, reward, terminated, self._is_over(), {}

    def _is_over(self) -> bool:
        if self._duration is None:
            return False
        return self.simulation.time - self._begin > self._duration - 0.5 * self.simulation.step_size


class VectorEnvironment(VectorEnv):
    """Several environments as one, with the reset() and step() of gymnasium's vector environments.

    num_envs: number of environments. threads: number of threads that step them; None: one per processor. All other
    arguments are those of Environment and apply to each. `reward`, `terminated` and `start` are called in the calling
    thread, for one environment after the other. Results are bitwise those of environments that are stepped one by one.

    After an episode has ended, the next step begins a new episode: it ignores the action, and its reward is 0.

    environments: the single environments; only to be read.
    single_observation_space, single_action_space: of one environment; observation_space and action_space have a row
      for each environment.
    """

    metadata: typing.Dict[str, typing.Any] = {"render_modes": [], **AUTORESET}

    def __init__(self, simulation: SimulationOrScene, reward: Reward, *arguments: typing.Any, num_envs: int,
                 threads: typing.Optional[int] = None, **options: typing.Any) -> None:
        if num_envs < 1:
            raise ValueError("num_envs: expected a number >= 1, got %s" % num_envs)
        if not isinstance(simulation, Simulation):
            simulation = Simulation(simulation)
        self.environments = [Environment(simulation, reward, *arguments, **options) for _ in range(num_envs)]
        self.num_envs = num_envs
        self.single_observation_space = self.environments[0].observation_space
        self.single_action_space = self.environments[0].action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._ended = [False] * num_envs
        self._batch = Batch([each.simulation for each in self.environments], threads)

    def reset(self, *, seed: typing.Union[None, int, typing.Sequence[typing.Optional[int]]] = None,
              options: typing.Optional[Info] = None) -> typing.Tuple[numpy.ndarray, Info]:
        """Begins an episode in each environment. `seed`: of the first one, the others count on from it; or a list.

        Returns the observations, shape (num_envs, columns), and an empty dictionary.
        """
        if seed is None:
            seeds: typing.List[typing.Optional[int]] = [None] * self.num_envs
        elif isinstance(seed, (int, numpy.integer)):
            seeds = [int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError("seed: expected a number or %s of them, got %s" % (self.num_envs, len(seeds)))
        self._ended = [False] * self.num_envs
        return numpy.array([each.reset(seed=own)[0] for each, own in zip(self.environments, seeds)]), {}

    def step(self, actions: typing.Any) -> Outcomes:
        """Makes a step in each environment, with its row of `actions`: efforts, shape (num_envs, joints) [N m or N].

        Returns arrays of observations, shape (num_envs, columns), rewards, terminated and truncated, shape (num_envs,),
        and a dictionary. If steps of simulations fail, its "failure" has the reasons and "_failure" tells for which
        environments. Raises ValueError, before any step, if an effort is not finite or the shape is wrong.
        """
        actions = numpy.ascontiguousarray(actions, dtype=float)
        if actions.shape != self.action_space.shape:
            raise ValueError("actions: expected the shape %s, got %s" % (self.action_space.shape, actions.shape))
        if not numpy.isfinite(actions).all():
            raise ValueError("actions: expected finite numbers, got %s" % actions[~numpy.isfinite(actions)][0])
        first = self.environments[0]
        moving = [not ended for ended in self._ended]
        self._batch.run(first._steps, actions, first.action_joints, which=moving, raise_failures=False)
        rows = self._batch.row(first._record)[:, first._first:]
        outcomes: typing.List[Outcome] = []
        failures = self._batch.failures
        for each, row, action, failure, ended in zip(self.environments, rows, actions, failures, self._ended):
            outcomes.append((each.reset()[0], 0.0, False, False, {}) if ended else each._judge(row, action, failure))
        observations, rewards, terminated, truncated, infos = zip(*outcomes)
        self._ended = [a or b for a, b in zip(terminated, truncated)]
        return (numpy.array(observations), numpy.array(rewards), numpy.array(terminated), numpy.array(truncated),
                _joined(infos))


def _joined(infos: typing.Sequence[Info]) -> Info:
    """Joins dictionaries in the format of gymnasium's vector environments: an array for each key, and a mask "_key"."""
    there = numpy.array(["failure" in info for info in infos])
    if not there.any():
        return {}
    return {"failure": numpy.array([info.get("failure") for info in infos], dtype=object), "_failure": there}


register("flexarm/Environment-v0", "flexarm.environment:Environment", "flexarm.environment:VectorEnvironment")
