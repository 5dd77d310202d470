"""Shows runs of a sweep in a browser."""

import math
import sys
import warnings

import flexarm

from .commands import effort_rows

RATE = 60  # instants per second of simulated time


def write_page(path, plan, numbers, opens):
    """Repeats runs of the plan, by their numbers, and writes a page that plays them side by side.

    opens: whether it is opened in a browser.
    """
    page = flexarm.show(*(recorded(plan, number) for number in numbers))
    if not opens:
        page.save(path)
    elif not page.open(path):
        print("flexarm: no browser can be started: open %s yourself" % path, file=sys.stderr)


def recorded(plan, number):
    """The recording of a run; of one that fails, until then."""
    parameters = dict(zip(plan.design.names, plan.design.rows[number - 1]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", flexarm.SceneWarning)  # were shown when the plan was read
        simulation = flexarm.Simulation(flexarm.read_scene(plan.job.scene, parameters=parameters))
    title = "run %d: %s" % (number, ", ".join("%s = %g" % setting for setting in parameters.items()))
    recording = flexarm.Recording(simulation, title)
    recording.keep()
    count = math.ceil(plan.job.until / simulation.step_size - 1e-6)
    joints, efforts = effort_rows(plan.job.pulses, count, simulation.step_size)
    every = max(1, round(1 / (RATE * simulation.step_size)))
    try:
        for first in range(0, count, every):
            steps = min(every, count - first)
            simulation.run(steps, efforts[first:first + steps] if joints else None, joints or None)
            recording.keep()
    except flexarm.StepError as error:
        warnings.warn("run %d: %s" % (number, error))
        recording.keep()
    return recording
