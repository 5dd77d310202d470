"""A simulation as an environment of reinforcement learning."""

import copy

import numpy

from ._flexarm import Simulation
from .errors import StepError


class Environment:
    """A simulation with the reset() and step() that reinforcement learning expects (gymnasium's, which is not needed).

    simulation: a Simulation, which is copied, or the Scene of one. reset() goes back to the state that it has now.
    reward: `reward(observation, action, simulation)`, called after each step; a number.
    observation: patterns of columns, as in Simulation.run(); the time is left out where no pattern asks for it.
    joints: whose efforts are an action, in this order; None: all of effort_joints.
    steps: of the simulation for each action, which is held over them.
    duration: of an episode [s]; None: it has no end.
    terminated: `terminated(observation, simulation)`, asked after each step; None: never.
    start: `start(simulation, random)`, called by reset() with a numpy.random.Generator; None: nothing is changed.
    failure_reward: in place of `reward` where a step of the simulation fails, which ends the episode.

    observation_names, observation_units: of the numbers of an observation, shape (columns,).
    action_joints: names of the joints of an action, shape (joints,) [N m or N].
    simulation: the one that steps, to look at.
    """

    def __init__(self, simulation, reward, observation=("joint/*/position", "joint/*/velocity"), *, joints=None,
                 steps=1, duration=None, terminated=None, start=None, failure_reward=0.0):
        if steps < 1:
            raise ValueError("steps: expected a number >= 1, got %s" % steps)
        self.simulation = copy.copy(simulation) if isinstance(simulation, Simulation) else Simulation(simulation)
        self._reward, self._terminated, self._start = reward, terminated, start
        self._steps, self._duration, self._failure_reward = steps, duration, failure_reward
        self.action_joints = list(self.simulation.effort_joints if joints is None else joints)
        self._record = list(observation)
        columns = self.simulation.columns(self._record)
        self._first = 0 if "time" in self._record else 1
        self.observation_names = [name for name, _ in columns[self._first:]]
        self.observation_units = [unit for _, unit in columns[self._first:]]
        self._initial = self.simulation.snapshot()
        self._begin = self.simulation.time
        self._random = numpy.random.default_rng()

    def _observe(self):
        return self.simulation.row(self._record)[self._first:]

    def reset(self, *, seed=None, options=None):
        """Begins an episode; `seed`: of the generator that `start` is given, None: it goes on. Options mean nothing.

        Returns the observation and an empty dictionary.
        """
        if seed is not None:
            self._random = numpy.random.default_rng(seed)
        self.simulation.restore(self._initial)
        if self._start is not None:
            self._start(self.simulation, self._random)
        return self._observe(), {}

    def step(self, action):
        """Holds efforts, shape (joints,) [N m or N], over the steps of an action.

        Returns observation, reward, terminated, truncated (the duration is over), and a dictionary: after a failed step
        of the simulation, in which the episode ends, "failure" says what it was.
        """
        action = numpy.ascontiguousarray(action, dtype=float)
        try:
            self.simulation.run(self._steps, action, self.action_joints)
        except StepError as failure:
            return self._observe(), self._failure_reward, True, False, {"failure": str(failure)}
        observation = self._observe()
        reward = float(self._reward(observation, action, self.simulation))
        terminated = self._terminated is not None and bool(self._terminated(observation, self.simulation))
        return observation, reward, terminated, self._is_over(), {}

    def _is_over(self):
        if self._duration is None:
            return False
        return self.simulation.time - self._begin > self._duration - 0.5 * self.simulation.step_size
