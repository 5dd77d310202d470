"""One run of a job."""

import math
import os
import typing
import warnings

import numpy

import flexarm

from .commands import effort_rows
from .history import write_history


class Outcome(typing.NamedTuple):
    measures: tuple  # numbers, in the order of the job's; NaN where it failed
    failure: str  # why; empty: it did not


def perform(job, number, parameters, history_path):
    """Simulates the scene with the values of `parameters`, a dictionary, and measures.

    number: of the run. history_path: of its history, where the job has one; written whole or not at all.
    What goes wrong is in the Outcome.
    """
    warnings.simplefilter("ignore", flexarm.SceneWarning)  # the scene's own are shown when the plan is read
    try:
        return simulate(job, number, parameters, history_path)
    except (flexarm.SceneError, flexarm.StepError) as error:
        reason = str(error)
    except Exception as error:  # whatever it is, the other runs go on
        reason = "%s: %s" % (type(error).__name__, error)
    # Where the scene lies is not a part of the result.
    return failed(job, reason.replace(os.path.dirname(job.scene) + os.sep, ""))


def failed(job, reason):
    return Outcome((math.nan,) * len(job.measures), "; ".join(reason.splitlines()))


def columns_of(job):
    """Patterns of the columns that are recorded: of names that may have brackets themselves."""
    names = {name: None for measure in job.measures for name in measure.expression.used}
    if job.history:
        names.update(dict.fromkeys(job.history.columns))
    names.pop("time", None)  # is always there, and the first
    return [name.replace("[", "[[]") for name in names] or ["time"]


def simulate(job, number, parameters, history_path):
    scene = flexarm.read_scene(job.scene, parameters=parameters)
    simulation = flexarm.Simulation(scene)
    record = columns_of(job)
    columns = simulation.columns(record)
    failure = None
    try:
        rows = recorded(job, simulation, record)
    except flexarm.StepError as error:
        rows, failure = error.rows, error
    history = dict(zip((name for name, _ in columns), rows.T))
    if job.history:
        write_history(history_path, job.history, history, dict(columns), simulation, number, parameters)
    if failure:
        raise failure
    values = {parameter.name: parameter.value for parameter in scene.parameters}
    return Outcome(tuple(measure.evaluate(history, values) for measure in job.measures), "")


def recorded(job, simulation, record):
    """Rows at the start, after every `job.every` steps, and at the end. Raises StepError, with those until then."""
    steps = math.ceil(job.until / simulation.step_size - 1e-6)
    rest = steps % job.every
    joints, efforts = effort_rows(job.pulses, steps, simulation.step_size)
    parts = [simulation.row(record)[numpy.newaxis]]
    for count, first, every in ((steps - rest, 0, job.every), (rest, steps - rest, max(rest, 1))):
        try:
            parts.append(simulation.run(count, efforts[first:first + count] if joints else None, joints or None,
                                        record=record, every=every))
        except flexarm.StepError as error:
            raise flexarm.StepError(str(error), error.time, error.reason, numpy.vstack([*parts, error.rows])) from None
    return numpy.vstack(parts)
