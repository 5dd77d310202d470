"""Uncertainty of predictions that comes from identified numbers.

By ASME V&V 20 (2009, section 1.5) the uncertainty of a comparison is u_val^2 = u_num^2 + u_input^2 + u_D^2: numerical
error, inputs of the model, and the measurement. Numbers that were identified are inputs. They are propagated to the
first order, with their covariance (GUM, JCGM 100:2008, 5.2.2). Uncertainties of rows are expanded to about 95 %.
"""

import math
from dataclasses import dataclass
from typing import Tuple

import numpy

COVERAGE = 2.0  # expanded uncertainty per standard uncertainty, if the variance is known
LEVEL = math.erf(COVERAGE / math.sqrt(2))  # of confidence: 95.45 %


def coverage_factor(freedom):
    """Expanded per standard uncertainty if the variance has so many degrees of freedom (GUM, G.3); inf: known."""
    if math.isinf(freedom):
        return COVERAGE
    from scipy.stats import t  # only a few cases need scipy
    return float(t.ppf((1 + LEVEL) / 2, freedom))


@dataclass(frozen=True)
class Estimate:
    """Numbers that were identified.

    values: shape (unknowns,). covariance: shape (unknowns, unknowns)
    freedom: degrees of freedom of the covariance; inf if it follows from assumed uncertainties
    names: of the unknowns, or empty
    birge: by which the fitted numbers scatter more than was assumed, 1 if not more; the covariance has its square
    """

    values: numpy.ndarray
    covariance: numpy.ndarray
    freedom: float = math.inf
    names: Tuple[str, ...] = ()
    birge: float = 1.0

    @property
    def standard_errors(self):
        return numpy.sqrt(numpy.diag(self.covariance))

    @property
    def named(self):
        """The values by their names."""
        return dict(zip(self.names, self.values.tolist()))

    def predict(self, model, step=1.0):
        """What a function of the numbers gives, and its expanded uncertainty: shape (results,) each.

        model: of shape (unknowns,) to (results,). step: of the central differences, in standard errors; shorter where
        the model has bounds. If the covariance is F F^T and g the gradient of a result, its variance g^T F F^T g is the
        sum of squares of its derivatives along the columns of F.
        """
        found = numpy.asarray(model(self.values), dtype=float)
        variance = numpy.zeros_like(found)
        for column in step * self._factor().T:
            ahead, behind = (numpy.asarray(model(self.values + sign * column)) for sign in (1, -1))
            variance += ((ahead - behind) / (2 * step)) ** 2
        return found, coverage_factor(self.freedom) * numpy.sqrt(variance)

    def _factor(self):
        """F with covariance F F^T: principal axes, of the correlations, since unknowns have different units."""
        errors = self.standard_errors
        sizes = numpy.where(errors > 0, errors, 1.0)
        variances, axes = numpy.linalg.eigh(self.covariance / numpy.outer(sizes, sizes))
        return sizes[:, None] * axes * numpy.sqrt(numpy.maximum(variances, 0))

    def with_chosen(self, values, spacings, names=()):
        """With further numbers that were chosen from grids: each is anywhere within its spacing (GUM, 4.3.7)."""
        count = len(self.values)
        covariance = numpy.diag(numpy.append(numpy.zeros(count), numpy.square(spacings) / 12.0))
        covariance[:count, :count] = self.covariance
        return Estimate(numpy.append(self.values, values), covariance, self.freedom, (*self.names, *names))


def from_fit(values, covariance, squares, numbers):
    """An estimate by weighted least squares.

    covariance: that of the assumed uncertainties. squares: sum of the squares of the residuals in standard
    uncertainties. numbers: that were fitted.
    If they scatter more than was assumed, variances are larger by the reduced chi-square (the Birge ratio squared), and
    have the degrees of freedom of the fit.
    """
    freedom = numbers - len(values)
    if freedom > 0 and squares > freedom:
        return Estimate(values, covariance * (squares / freedom), freedom, birge=math.sqrt(squares / freedom))
    return Estimate(values, covariance)


def from_trials(values, names=()):
    """An estimate for one more trial, from values that were identified from each of several: shape (trials, unknowns).

    Trials differ (random effects), and their mean is uncertain, so that the covariance is (1 + 1/trials) times that
    between them. It needs more trials than unknowns.
    """
    values = numpy.asarray(values, dtype=float)
    trials, unknowns = values.shape
    if trials <= unknowns:
        raise ValueError("expected more trials than the %d unknowns, got %d" % (unknowns, trials))
    between = numpy.atleast_2d(numpy.cov(values, rowvar=False))
    return Estimate(values.mean(axis=0), (1 + 1 / trials) * between, trials - 1, tuple(names))


def from_batches(values, jacobian, residuals, batches, names=()):
    """An estimate from a record, whose residuals depend on each other: by batches (cluster-robust covariance).

    jacobian: shape (rows, unknowns), residuals: shape (rows,), both with the same weights; batches: shape (rows,), the
    number of the batch, 0 and so on, of each row. Sums over a batch, which is long against the memory of the
    residuals, are as good as independent (Liang and Zeger 1986; Cameron and Miller 2015, section II).
    """
    count = int(batches.max()) + 1
    bread = numpy.linalg.inv(jacobian.T @ jacobian)
    sums = numpy.array([jacobian[batches == i].T @ residuals[batches == i] for i in range(count)])
    covariance = count / (count - 1) * bread @ (sums.T @ sums) @ bread
    return Estimate(numpy.asarray(values, dtype=float), covariance, count - 1, tuple(names))
