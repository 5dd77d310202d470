"""How well the measurements determine the unknowns: linear statistics at the best fit."""

import typing

import numpy


class Certainty(typing.NamedTuple):
    """standard_errors: shape (unknowns,), infinite for unknowns that the measurements do not determine.
    correlations: of the estimates, shape (unknowns, unknowns), NaN for undetermined unknowns.
    undetermined: lists of indices of unknowns that can be changed together without an effect on the measured values.
    """

    standard_errors: numpy.ndarray
    correlations: numpy.ndarray
    undetermined: typing.List[typing.List[int]]


def certainty(jacobian, variance, smallest, resolution):
    """Computes the certainty from the derivatives of residuals that all have the same variance.

    jacobian: shape (values, unknowns). smallest: a column of smaller norm counts as zero.
    resolution: relative error of columns. A normalised combination of columns with norm 1 counts as zero if its norm
      is smaller.

    The covariance is variance (J^T J)^-1 (Seber and Wild, Nonlinear Regression, 2.1). It is computed from the singular
    values of J, with columns scaled to norm 1. Combinations that count as zero are left out.
    """
    lengths = numpy.linalg.norm(jacobian, axis=0)
    seen = lengths > smallest
    directions = jacobian * numpy.divide(1.0, lengths, out=numpy.zeros_like(lengths), where=seen)
    _, singular, rows = numpy.linalg.svd(directions, full_matrices=False)
    is_null = singular <= resolution
    undetermined = [[int(i)] for i in numpy.flatnonzero(~seen)]
    blurred = ~seen
    for row in rows[is_null]:
        members = numpy.flatnonzero((abs(row) > 0.1 * abs(row).max()) & seen)
        if len(members):
            undetermined.append(members.tolist())
            blurred[members] = True
    inverse = (rows[~is_null].T / singular[~is_null] ** 2) @ rows[~is_null]
    spread = numpy.sqrt(numpy.diag(inverse))
    errors, correlations = numpy.full(len(lengths), numpy.inf), numpy.full(inverse.shape, numpy.nan)
    clear = ~blurred
    errors[clear] = numpy.sqrt(variance) * spread[clear] / lengths[clear]
    both = numpy.ix_(clear, clear)
    correlations[both] = numpy.clip(inverse[both] / numpy.outer(spread[clear], spread[clear]), -1, 1)
    return Certainty(errors, correlations, undetermined)


def succession(residuals):
    """The autocorrelation of residuals at lag one. For independent residuals it is 0, give or take 1/sqrt(values)."""
    square = float(residuals @ residuals)
    return float(residuals[1:] @ residuals[:-1]) / square if square > 0 else 0.0
