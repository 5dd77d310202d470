#!/usr/bin/python3
"""What Python costs: `bench/python_overhead.py`, after `source devel/setup.bash`; on a quiet machine, half a minute.

Per call of step(): the time of a step by itself less that of one in run(). Threads: steps per second of two simulations
in two threads over those of one. The scenes are the smallest one, of which most is overhead, and one with beams.
"""

import os
import threading
import time

import flexarm

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "config", "examples")
REPETITIONS = 9


def simulation_of(name):
    return flexarm.Simulation(flexarm.read_scene(os.path.join(EXAMPLES, name + ".urdf")))


def seconds(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def step_overhead(name, steps):
    """Of a call of step() [s], the least of some, taken in turns."""
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
    """Of two simulations in two threads; the median of ratios, each of runs that follow each other."""
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


def main():
    for name, steps in (("rigid_double_pendulum", 50000), ("flexible_two_link_arm", 2000)):
        overhead, step = step_overhead(name, steps)
        print("%-22s step() %.2f us over the %.2f us of a step in run(); two threads %.2f times one"
              % (name, 1e6 * overhead, 1e6 * step, speedup(name, steps)))


if __name__ == "__main__":
    main()
