#!/usr/bin/python3
"""Measure the overhead of Python: `bench/python_overhead.py`, after `source devel/setup.bash`. Takes half a minute on a
quiet machine.

Overhead of a call of step(): the time of a single step minus the time of a step in run(). Threads: the steps per second
of two simulations in two threads, relative to one simulation. Environments: the steps per second of a vector, relative
to a single one. The scenes are the smallest scene, in which overhead dominates, and a scene with beams.
"""

import os
import threading
import time

import flexarm
import numpy

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "config", "examples")
REPETITIONS = 9


def simulation_of(name):
    return flexarm.Simulation(flexarm.read_scene(os.path.join(EXAMPLES, name + ".urdf")))


def seconds(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def step_overhead(name, steps):
    """Return the overhead of a call of step() [s], by the least times of some runs, taken in turns."""
    simulation = simulation_of(name)

    def one_by_one():
        for _ in range(steps):
            simulation.step()

    alone, together = [], []
    for _ in range(REPETITIONS):
        for work, times in ((one_by_one, alone), (lambda: simulation.run(steps), together)):
            simulation.reset()
            times.append(seconds(work))
    return (min(alone) - min(together)) / steps, min(together) / steps


def speedup(name, steps):
    """Return the speed-up of two simulations in two threads: the median of ratios, each of consecutive runs."""
    simulations = [simulation_of(name), simulation_of(name)]

    def in_threads():
        threads = [threading.Thread(target=each.run, args=(steps,)) for each in simulations]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    ratios = []
    for _ in range(REPETITIONS):
        for each in simulations:
            each.reset()
        one = seconds(lambda: simulations[0].run(steps))
        simulations[0].reset()
        ratios.append(2 * one / seconds(in_threads))
    return sorted(ratios)[REPETITIONS // 2]


def vector_speedup(name, count=32, rounds=40):
    """Return the steps per second of `count` environments as one vector, over those of a single one: a median."""
    environments = [flexarm.Environment(simulation_of(name), no_reward),
                    flexarm.VectorEnvironment(simulation_of(name), no_reward, num_envs=count)]
    actions = [numpy.zeros(each.action_space.shape) for each in environments]

    def step(index, times):
        for _ in range(times):
            environments[index].step(actions[index])

    ratios = []
    for _ in range(REPETITIONS):
        for each in environments:
            each.reset()
        ratios.append(seconds(lambda: step(0, count * rounds)) / seconds(lambda: step(1, rounds)))
    return sorted(ratios)[REPETITIONS // 2]


def no_reward(observation, action, simulation):
    return 0.0


def main():
    for name, steps in (("rigid_double_pendulum", 50000), ("flexible_two_link_arm", 2000)):
        overhead, step = step_overhead(name, steps)
        print("%-22s step() %.2f us over the %.2f us of a step in run(); two threads %.2f times one"
              % (name, 1e6 * overhead, 1e6 * step, speedup(name, steps)))
    name = "flexible_two_link_arm"
    print("%-22s 32 environments as a vector: %.2f times the steps per second of one" % (name, vector_speedup(name)))


if __name__ == "__main__":
    main()
