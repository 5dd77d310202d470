#!/usr/bin/python3
"""Measure the cost of sensitivities: `bench/sensitivities_cost.py`, after `source devel/setup.bash`, on a quiet
machine.

Prints the processor time of a run with sensitivities of one parameter and of three, relative to the run alone. Each
time is the least of some, taken in turns. This is the table of docs/notes/sensitivities.md.
"""

import os
import time

import flexarm

SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "config", "identification", "measured_arm.urdf")
PARAMETERS = ["young", "joint_damping", "payload"]
STEPS, REPETITIONS = 400, 5


def seconds(scheme, parameters):
    simulation = flexarm.Simulation(flexarm.read_scene(SCENE), scheme=scheme)
    run = simulation.sensitivities(parameters).run if parameters else simulation.run
    begin = time.process_time()
    run(STEPS)
    return time.process_time() - begin


def main():
    counts = (0, 1, len(PARAMETERS))
    for scheme in ("em", "newmark"):
        times = {count: [] for count in counts}
        for _ in range(REPETITIONS):
            for count in counts:
                times[count].append(seconds(scheme, PARAMETERS[:count]))
        alone, one, all_of_them = (min(times[count]) for count in counts)
        print("%-8s alone %.1f us a step; one parameter %.1f, %d parameters %.1f times that"
              % (scheme, 1e6 * alone / STEPS, one / alone, len(PARAMETERS), all_of_them / alone))


if __name__ == "__main__":
    main()
