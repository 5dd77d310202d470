"""Numbers that a source does not give, from a part of its measurements."""

import numpy

from ..identification import Column, Experiment, Measurement, Setting, Unknown, fit
from .uncertainty import COVERAGE, from_batches, from_fit

BATCHES = 10  # of a record
DIFFERENCE = 1e-4  # relative; long enough for numbers with the round-off of eigenvalues


def fit_run(scene, unknowns, times, columns, values=None, step=0.001):
    """Finds parameters of a scene with which its run fits a record, as `flexarm identify` does (docs/identify.md).

    scene: path. unknowns: first values of the parameters, all > 0. times: shape (rows,), from 0 on [s]
    columns: recorded columns by the names of `flexarm simulate --columns`, shape (rows,) each; NaN is missing.
    values: of other parameters. step: [s]
    Returns an Estimate with the names of the unknowns. Its covariance is that of batches of the record: what a model
    lacks leaves residuals that go on for many rows, and rows that depend on each other determine less.
    Raises FitError, flexarm.SceneError.
    """
    parts = []
    for name, column in columns.items():
        known = numpy.isfinite(column)
        parts.append(Measurement(Column(name, name, None, None), times[known], column[known]))
    wanted = [Unknown(name, False, start, 0.0, numpy.inf, start) for name, start in unknowns.items()]
    experiment = Experiment(wanted, {}, parts, {}, Setting(scene, values or {}, step, 1e-10))
    result = fit(experiment, workers=1)
    weights = numpy.concatenate([numpy.full(len(part.times), 1 / noise) for part, noise in zip(parts, result.noise)])
    steps = DIFFERENCE * abs(result.values)
    slopes = [(experiment.simulate(result.values + row) - experiment.simulate(result.values - row)) / row.sum() / 2
              for row in numpy.diag(steps)]
    first, last = (function(part.times[end] for part in parts) for function, end in ((min, 0), (max, -1)))
    batches = numpy.concatenate([(part.times - first) / (last - first) * BATCHES for part in parts])
    return from_batches(result.values, (numpy.array(slopes) * weights).T,
                        (result.predicted - experiment.measured) * weights,
                        numpy.minimum(batches.astype(int), BATCHES - 1), tuple(unknowns))


def fit_numbers(model, start, measured, uncertainties):
    """Finds unknowns with which a function fits numbers: least squares, weighted by the uncertainties.

    model: of unknowns, shape (unknowns,), to numbers, shape (numbers,). start: first values, none of them 0.
    uncertainties: expanded ones, as of rows, of independent errors: shape (numbers,), one each, or (numbers, errors) if
    one error changes several numbers. Returns an Estimate.
    """
    from scipy.optimize import least_squares
    start, measured = (numpy.asarray(each, dtype=float) for each in (start, measured))
    standard = numpy.asarray(uncertainties, dtype=float) / COVERAGE
    errors = standard if standard.ndim == 2 else numpy.diag(standard)
    whiten = numpy.linalg.inv(numpy.linalg.cholesky(errors @ errors.T))
    result = least_squares(lambda x: whiten @ (model(x * start) - measured), numpy.ones(len(start)),
                           diff_step=DIFFERENCE)
    covariance = numpy.linalg.inv(result.jac.T @ result.jac) * numpy.outer(start, start)
    return from_fit(result.x * start, covariance, 2 * result.cost, len(measured))
