"""The command `flexarm identify`."""

import argparse
import os
import signal
import sys
import tempfile
import warnings

import numpy

from .. import read_scene
from ..errors import SceneError, SceneWarning, StepError
from . import report
from .efforts import read_efforts
from .experiment import Experiment, Setting, choose_step
from .fit import FitError, Interruption, fit
from .inputs import InputError
from .measurements import read_measurements
from .plan import read_plan

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 128


def _arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="flexarm identify",
        description="Finds the values of a scene's parameters with which its motion fits measurements.")
    parser.add_argument("scene", help="scene file with parameters")
    parser.add_argument("data", help="measurements: a CSV file with a column `time`, or a ROS bag")
    parser.add_argument("plan", help="YAML file with the unknowns and the measured columns (docs/identify.md)")
    parser.add_argument("--set", metavar="NAME=VALUE", nargs="+", action="extend", default=[],
                        help="values of the scene's parameters, which replace those of the file; for unknowns, the "
                             "search begins there")
    parser.add_argument("--output",
                        help="file for the scene with the values that were found (SCENE_fitted.urdf); a report "
                             "(.json), residuals (.csv) and a picture (.png) go beside it")
    parser.add_argument("--workers", type=_count, help="number of simultaneous simulations (one for each processor)")
    parser.add_argument("--quiet", action="store_true", help="no progress and no tables")
    return parser.parse_args(arguments)


def _count(text):
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError("must be a number >= 1, got '%s'" % text)
    return int(text)


def _settings(texts):
    values = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            values[name] = float(value)
        except ValueError:
            raise InputError("--set: must be NAME=VALUE, got '%s'" % text) from None
    return values


class _Outputs:
    """The output files. Raises InputError if one of them is an input file."""

    def __init__(self, arguments):
        stem, extension = os.path.splitext(os.path.basename(arguments.scene))
        self.scene = arguments.output or stem + "_fitted" + extension
        beside = os.path.splitext(self.scene)[0]
        self.json, self.csv, self.picture = beside + ".json", beside + ".csv", beside + ".png"
        files = [self.scene, self.json, self.csv, self.picture]
        if len(set(files)) < len(files):
            raise InputError("--output: expected the name of a scene, got '%s'" % self.scene)
        inputs = {os.path.realpath(path) for path in (arguments.scene, arguments.data, arguments.plan)}
        for path in files:
            if os.path.realpath(path) in inputs:
                raise InputError("--output would overwrite '%s', which is read" % path)
            folder = os.path.dirname(path) or "."
            if not os.access(folder, os.W_OK) or os.path.isdir(path):
                raise InputError("--output: '%s' cannot be written" % path)


def _write(path, data):
    """Writes a file. An existing file stays until the new one is complete."""
    folder, name = os.path.split(path)
    with tempfile.NamedTemporaryFile(dir=folder or ".", prefix=name, delete=False) as file:
        file.write(data)
    umask = os.umask(0)
    os.umask(umask)
    os.chmod(file.name, 0o666 & ~umask)
    os.replace(file.name, path)


def _read(arguments, values):
    """Reads the input files. Returns the experiment and its plan."""
    scene = read_scene(arguments.scene, parameters=values)
    plan = read_plan(arguments.plan, scene.parameters)
    measurements, begin = read_measurements(arguments.data, plan)
    efforts = read_efforts(plan.commands, arguments.data, begin) if plan.commands else {}
    times = numpy.concatenate([measurement.times for measurement in measurements])
    step = plan.step or choose_step(times, scene.step) or scene.step
    setting = Setting(arguments.scene, values, step, plan.tolerance)
    return Experiment(plan.unknowns, plan.initial, measurements, efforts, setting), plan


def _show(experiment):
    names = [unknown.name for unknown in experiment.unknowns]

    def show(iteration):
        values = ", ".join("%s %.6g" % pair for pair in zip(names, iteration.values))
        print("iteration %d, %d simulations: residuals %.4g times the noise, %s"
              % (iteration.number, iteration.simulations, iteration.factor, values), file=sys.stderr, flush=True)

    return show


def _interrupt(number, frame):
    raise Interruption(number)


def _keep(arguments, outputs, experiment, values, result):
    """Writes all output files. Returns their names."""
    found = {unknown.name: value for unknown, value in zip(experiment.unknowns, result.values) if not unknown.of_start}
    with open(arguments.scene, "rb") as file:
        scene = report.with_values(file.read(), arguments.scene, {**values, **found})
    files = {"scene": arguments.scene, "data": arguments.data, "plan": arguments.plan}
    _write(outputs.scene, scene)
    _write(outputs.json, report.as_json(experiment, result, files).encode())
    _write(outputs.csv, report.as_csv(experiment, result).encode())
    return [outputs.scene, outputs.json, outputs.csv]


def _identify(arguments, draw):
    values = _settings(arguments.set)
    outputs = _Outputs(arguments)
    experiment, plan = _read(arguments, values)
    warnings.simplefilter("ignore", SceneWarning)  # was already shown for the start
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    show = (lambda iteration: None) if arguments.quiet else _show(experiment)
    result = fit(experiment, plan.difference, arguments.workers, show, plan.forward)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # so that the results are written
    files = _keep(arguments, outputs, experiment, values, result)
    if not arguments.quiet:
        print(report.text(experiment, result))
    for doubt in report.doubts(experiment, result):
        print("flexarm: warning: %s" % doubt, file=sys.stderr)
    if draw(outputs.csv, outputs.picture):
        files.append(outputs.picture)
    else:
        print("flexarm: no picture: it needs python3-matplotlib", file=sys.stderr)
    if not arguments.quiet:
        print("\n".join(files))
    if result.signal:
        print("flexarm: interrupted; the best values so far are kept", file=sys.stderr)
        return INTERRUPTED + result.signal
    if not result.is_converged:
        print("flexarm: %s; the best values so far are kept" % result.ending, file=sys.stderr)
        return FAILED
    return DONE


def main(arguments, draw):
    """Runs the command line. Returns the exit status.

    draw: function `draw(data, picture)` that plots the residuals of a CSV file and returns whether it could.
    """
    arguments = _arguments(arguments)
    warnings.showwarning = lambda message, *_: print(message, file=sys.stderr)
    try:
        return _identify(arguments, draw)
    except (InputError, SceneError) as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    except (FitError, StepError) as error:
        print("flexarm: %s" % error, file=sys.stderr)
        return FAILED
    except Interruption as interruption:
        print("flexarm: interrupted before the first simulation had ended", file=sys.stderr)
        return INTERRUPTED + interruption.number
    except OSError as error:
        print("flexarm: %s" % error, file=sys.stderr)
        return FAILED
