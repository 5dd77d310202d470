"""How well are unknowns determined by measurements? Linear statistics about the best fit."""

import typing

import numpy


class Certainty(typing.NamedTuple):
    """standard_errors: shape (unknowns,), infinite where the measurements do not tell.
    correlations: of the estimates, shape (unknowns, unknowns), NaN for those.
    undetermined: lists of indices of unknowns that can be changed together so that nothing is seen of it.
    """

    standard_errors: numpy.ndarray
    correlations: numpy.ndarray
    undetermined: typing.List[typing.List[int]]


def certainty(jacobian, variance, smallest, resolution):
    """From the derivatives of residuals that all have the same variance.

    jacobian: shape (values, unknowns). smallest: length of a column of it that cannot be told from zero.
    resolution: relative error of columns: a combination of columns of length one that is shorter cannot be told from
      zero.

    The covariance is variance (J^T J)^-1 (Seber and Wild, Nonlinear Regression, 2.1), by the singular values of J with
    columns of length one; combinations that cannot be told from zero are left out.
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
    """Correlation of residuals with those that follow them: of independent ones 0, give or take 1/sqrt(values)."""
    square = float(residuals @ residuals)
    return float(residuals[1:] @ residuals[:-1]) / square if square > 0 else 0.0
