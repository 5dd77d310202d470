"""Numbers that a source does not give, from a part of its measurements."""

import numpy

from ..identification import Column, Experiment, Measurement, Setting, Unknown, fit


def fit_run(scene, unknowns, times, columns, values=None, step=0.001):
    """Finds parameters of a scene with which its run fits a record, as `flexarm identify` does (docs/identify.md).

    scene: path. unknowns: first values of the parameters, all > 0. times: shape (rows,), from 0 on [s]
    columns: recorded columns by the names of `flexarm simulate --columns`, shape (rows,) each; NaN is missing.
    values: of other parameters. step: [s]
    Returns values and standard errors of the unknowns, two dictionaries. Raises FitError, flexarm.SceneError.
    """
    parts = []
    for name, column in columns.items():
        known = numpy.isfinite(column)
        parts.append(Measurement(Column(name, name, None, None), times[known], column[known]))
    wanted = [Unknown(name, False, start, 0.0, numpy.inf, start) for name, start in unknowns.items()]
    result = fit(Experiment(wanted, {}, parts, {}, Setting(scene, values or {}, step, 1e-10)), workers=1)
    return dict(zip(unknowns, result.values)), dict(zip(unknowns, result.certainty.standard_errors))


def fit_numbers(model, start, measured, uncertainties):
    """Finds unknowns with which a function fits numbers: least squares, weighted by the uncertainties.

    model: of unknowns, shape (unknowns,), to numbers, shape (numbers,). start: first values, none of them 0.
    Returns values and their standard errors, which follow from the uncertainties.
    """
    from scipy.optimize import least_squares
    start, measured, uncertainties = (numpy.asarray(each, dtype=float) for each in (start, measured, uncertainties))
    # Differences are long enough for numbers with the round-off of eigenvalues.
    result = least_squares(lambda x: (model(x * start) - measured) / uncertainties, numpy.ones(len(start)),
                           diff_step=1e-4)
    covariance = numpy.linalg.inv(result.jac.T @ result.jac)
    return result.x * start, numpy.sqrt(numpy.diag(covariance)) * abs(start)
