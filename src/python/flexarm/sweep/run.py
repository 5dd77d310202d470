"""Makes one run of a job."""

import math
import os
import typing
import warnings

import numpy

import flexarm

from .commands import effort_rows
from .history import write_history


class Outcome(typing.NamedTuple):
    measures: tuple  # numbers, in the order of job.measures; NaN if the run failed
    failure: str  # reason of the failure; empty: the run succeeded


def perform(job, number, parameters, history_path):
    """Simulates the scene with the values of the dictionary `parameters`, and evaluates the measures.

    number: of the run. history_path: file of its history, if the job has one; written completely or not at all.
    Errors are reported in the Outcome.
    """
    warnings.simplefilter("ignore", flexarm.SceneWarning)  # were shown when the plan was read
    try:
        return simulate(job, number, parameters, history_path)
    except (flexarm.SceneError, flexarm.StepError) as error:
        reason = str(error)
    except Exception as error:  # after any error the other runs go on
        reason = "%s: %s" % (type(error).__name__, error)
    # The scene's folder must not be a part of the result.
    return failed(job, reason.replace(os.path.dirname(job.scene) + os.sep, ""))


def failed(job, reason):
    return Outcome((math.nan,) * len(job.measures), "; ".join(reason.splitlines()))


def columns_of(job):
    """Patterns for the columns that are recorded. Brackets are escaped, since names may contain them."""
    names = {name: None for measure in job.measures for name in measure.expression.used}
    if job.history:
        names.update(dict.fromkeys(job.history.columns))
    names.pop("time", None)  # always recorded, as the first column
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
    """Rows at the start, after every `job.every` steps, and at the end. Raises StepError with the rows until then."""
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
