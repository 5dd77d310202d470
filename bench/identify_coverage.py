#!/usr/bin/python3
"""Test whether the standard errors of `flexarm identify` are right, on the example of docs/identify.md with repeated
noise.

identify_coverage.py [RUNS]: prints how many of the 95 % intervals cover the truth, how large errors are in units of
standard errors (1 is right), and the cost of a search. The default of 200 runs takes three minutes of processor time.
"""

import os
import sys
import time

import numpy
from scipy.stats import binom

import flexarm
from flexarm.identification import Experiment, Setting, fit, read_measurements, read_plan

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "config", "identification")
TRUTH = {"young": 70e9, "joint_damping": 0.1, "payload": 0.5}


def experiment_of(scene, until=1.2, every=5e-3):
    """Return the experiment of the example, its measurements without noise, and the noise of each value by the plan."""
    plan = read_plan(os.path.join(FOLDER, "plan.yaml"), flexarm.read_scene(scene).parameters)
    times = numpy.arange(round(until / every) + 1) * every
    rows = numpy.zeros((len(times), 1 + len(plan.columns)))
    rows[:, 0] = times
    path = os.path.join(os.environ.get("TMPDIR", "/tmp"), "identify_coverage_%d.csv" % os.getpid())
    names = ",".join(["time"] + [column.name for column in plan.columns])
    numpy.savetxt(path, rows, delimiter=",", header=names, comments="")
    measurements, _ = read_measurements(path, plan)
    os.remove(path)
    experiment = Experiment(plan.unknowns, plan.initial, measurements, {}, Setting(scene, {}, 1e-3, plan.tolerance))
    noise = numpy.concatenate([numpy.full(len(measurement.values), measurement.column.noise)
                               for measurement in experiment.measurements])
    return experiment, experiment.simulate(list(TRUTH.values())), noise


def main(runs):
    experiment, exact, noise = experiment_of(os.path.join(FOLDER, "measured_arm.urdf"))
    truth, random = numpy.array(list(TRUTH.values())), numpy.random.default_rng(0)
    deviations, simulations, errors = [], [], []
    begin = time.process_time()
    for _ in range(runs):
        experiment.measured[:] = exact + noise * random.standard_normal(len(exact))
        result = fit(experiment)
        deviations.append((result.values - truth) / result.certainty.standard_errors)
        errors.append(abs(result.values / truth - 1))
        simulations.append(result.simulations)
    deviations, errors = numpy.array(deviations), numpy.array(errors)
    least, most = binom.ppf([0.005, 0.995], runs, 0.95)
    print("%d runs, %.3g s of the processor each; %d to %d simulations" % (
        runs, (time.process_time() - begin) / runs, min(simulations), max(simulations)))
    print("of 99 of 100 such tables, a right one has %d to %d intervals that cover the truth" % (least, most))
    print("%-16s %12s %16s %16s %14s" % ("unknown", "cover truth", "rms of error/se", "rms error", "largest error"))
    for name, column, error in zip(TRUTH, deviations.T, errors.T):
        print("%-16s %12d %16.3f %14.3f %% %12.3f %%" % (
            name, (abs(column) < 1.96).sum(), numpy.sqrt((column**2).mean()), 100 * numpy.sqrt((error**2).mean()),
            100 * error.max()))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
