"""Finds the unknowns with which a simulation comes nearest to the measurements: bounded nonlinear least squares."""

import typing
from concurrent.futures import ThreadPoolExecutor

import numpy
from scipy.optimize import least_squares

from ..errors import SceneError, StepError
from .certainty import Certainty, certainty
from .inputs import InputError

# The search ends when the next step is expected to be shorter than this fraction of the standard errors.
NEGLIGIBLE = 0.01
MOST_ITERATIONS = 50


class Interruption(BaseException):
    """Ends the search, which keeps its best result so far. number: of the signal."""

    def __init__(self, number):
        super().__init__(number)
        self.number = number


class FitError(RuntimeError):
    """The simulation failed with the search's first values, or around its best ones."""


class Iteration(typing.NamedTuple):
    """The progress of a search."""

    number: int
    simulations: int  # since the search began
    factor: float  # root mean square of the residuals, relative to the noise
    values: numpy.ndarray  # of the unknowns


class Fit(typing.NamedTuple):
    values: numpy.ndarray  # of the unknowns, shape (unknowns,)
    certainty: Certainty
    factor: float  # estimated standard deviation of the measurement errors, relative to `noise`
    noise: numpy.ndarray  # of the columns, shape (columns,)
    predicted: numpy.ndarray  # simulated with `values`, ordered as Experiment.measured, shape (values,)
    at_limit: numpy.ndarray  # bool, shape (unknowns,)
    is_converged: bool
    ending: str  # why the search ended
    iterations: int
    simulations: int
    signal: typing.Optional[int]  # that has interrupted the search


class _Failed(typing.NamedTuple):
    """The outcome of a simulation that failed."""

    reason: str


class _Search:
    """Makes and counts the simulations of a search, and keeps the best one. Unknowns are divided by their scales."""

    def __init__(self, experiment, difference, forward, workers, show):
        self._experiment, self._difference, self._forward, self._show = experiment, difference, forward, show
        self._pool = ThreadPoolExecutor(workers)
        self._futures = []
        unknowns = experiment.unknowns
        self.scales = numpy.array([unknown.scale for unknown in unknowns])
        self.lower = numpy.array([unknown.min for unknown in unknowns]) / self.scales
        self.upper = numpy.array([unknown.max for unknown in unknowns]) / self.scales
        self.simulations = self.iterations = 0
        self.noise = numpy.ones(len(experiment.parts))
        self.weights = numpy.ones(len(experiment.measured))
        self.forget()

    def forget(self):
        """Drops the best simulation, since residuals get other weights."""
        self.best, self.cost, self.predicted, self.jacobian_at_best = None, numpy.inf, None, None

    def weigh(self, noise):
        self.noise = noise
        for part, value in zip(self._experiment.parts, noise):
            self.weights[part] = 1 / value
        self.forget()

    def close(self):
        for future in self._futures:
            future.cancel()
        self._pool.shutdown(wait=True)

    def _simulate(self, x):
        try:
            return self._experiment.simulate(x * self.scales)
        except (StepError, SceneError, InputError) as error:
            return _Failed(str(error))

    def simulate(self, points):
        """Simulates with several points at once."""
        self.simulations += len(points)
        self._futures = [self._pool.submit(self._simulate, point) for point in points]
        return [future.result() for future in self._futures]

    def residuals(self, x):
        """(simulated - measured) / noise, shape (values,); NaN if the simulation fails: then the search steps back."""
        (predicted,) = self.simulate([x])
        if isinstance(predicted, _Failed):
            if self.best is None:
                raise FitError("the scene cannot be simulated with the start values of the search: "
                               + predicted.reason)
            return numpy.full(len(self.weights), numpy.nan)
        residuals = (predicted - self._experiment.measured) * self.weights
        cost = float(residuals @ residuals)
        if cost < self.cost:
            self.best, self.cost, self.predicted, self.jacobian_at_best = x.copy(), cost, predicted, None
        return residuals

    def jacobian(self, x):
        """Derivatives of residuals() at `x`, which must be the best point."""
        assert numpy.array_equal(x, self.best)
        derivatives = self._derivatives(x) if self._forward else None
        if derivatives is None:
            derivatives = differences(self, x, self.predicted)
        jacobian = derivatives * self.weights[:, None]
        self.jacobian_at_best = jacobian
        self.iterations += 1
        self._show(Iteration(self.iterations, self.simulations, numpy.sqrt(self.cost / len(self.weights)),
                             x * self.scales))
        return jacobian

    def _derivatives(self, x):
        """Derivatives from sensitivities of one run, shape (values, unknowns); None if the run has none."""
        self.simulations += 1
        try:
            derivatives = self._experiment.derivatives(x * self.scales)
        except (StepError, SceneError, InputError):  # with a varied value
            return None
        return None if derivatives is None else derivatives * self.scales

    def lengths(self, x):
        """Differences by which unknowns are varied: fractions of their sizes, negative near the upper limit."""
        sizes = self._difference * numpy.maximum(abs(x), 0.1)
        return numpy.where(x + sizes <= self.upper, sizes, -sizes)


def differences(search, x, predicted):
    """Derivatives of simulated values with respect to the unknowns, shape (values, unknowns), by one-sided differences.

    predicted: simulated values at `x`.
    """
    steps = search.lengths(x)
    varied = search.simulate([x + step * row for step, row in zip(steps, numpy.eye(len(x)))])
    for i, result in enumerate(varied):
        if isinstance(result, _Failed):  # tries the other side
            (varied[i],) = search.simulate([x - steps[i] * numpy.eye(len(x))[i]])
            steps[i] = -steps[i]
            if isinstance(varied[i], _Failed):
                raise FitError("not converged: simulations fail on both sides of the best values: "
                               + result.reason)
    return numpy.column_stack([(result - predicted) / step for result, step in zip(varied, steps)])


def _first_noise(experiment):
    """The noise of each column: the plan's or, if the plan gives none, the spread of the column's values."""
    noise = []
    for measurement in experiment.measurements:
        spread = float(measurement.values.std()) or abs(float(measurement.values[0])) or 1.0
        noise.append(measurement.column.noise or spread)
    return numpy.array(noise)


def _noise_of_residuals(experiment, search):
    """The noise of each column: the plan's or, if the plan gives none, that of the residuals."""
    residuals = search.predicted - experiment.measured
    share = 1 - len(experiment.unknowns) / len(residuals)
    noise = search.noise.copy()
    for i, (part, measurement) in enumerate(zip(experiment.parts, experiment.measurements)):
        if measurement.column.noise is None:
            # Residuals that are only round-off are not noise.
            smallest = 1e-9 * search.noise[i]
            noise[i] = max(float(numpy.sqrt((residuals[part] ** 2).mean() / share)), smallest)
    return noise


def _descend(search, start):
    """Solves one least squares problem. Returns whether it converged, and why it ended."""
    count = len(search.weights)
    # At the minimum, the cost is half the number of values, if the variance is 1. A step by a fraction f of the
    # standard errors lowers the cost by f^2 / 2.
    result = least_squares(search.residuals, start, search.jacobian, bounds=(search.lower, search.upper), method="trf",
                           x_scale="jac", ftol=max(NEGLIGIBLE**2 / count, 1e-14), xtol=1e-9, gtol=1e-12,
                           max_nfev=MOST_ITERATIONS)
    if result.status > 0:
        return True, "converged"
    return False, "not converged after %d tries of values" % MOST_ITERATIONS


def fit(experiment, difference=1e-4, workers=None, show=lambda iteration: None, forward=False):
    """Finds the unknowns of an experiment.

    difference: by which unknowns are varied, relative to their size.
    forward: derivatives are sensitivities of one run, if it has them, rather than differences between runs.
    workers: number of threads that simulate; None: one per processor. The result does not depend on it.
    show: called with an Iteration after each iteration.

    The weight of a column whose noise is unknown first follows from the spread of its values. After convergence the
    search goes on with the noise of the residuals. Interruption ends the search, which returns the best values so far.
    Raises FitError if the simulation fails at the start of the search.
    """
    search = _Search(experiment, difference, forward, workers, show)
    is_converged, ending, signal = False, "", None
    try:
        x = numpy.array([unknown.start for unknown in experiment.unknowns]) / search.scales
        search.weigh(_first_noise(experiment))
        is_converged, ending = _descend(search, x)
        if is_converged and any(measurement.column.noise is None for measurement in experiment.measurements):
            x = search.best
            search.weigh(_noise_of_residuals(experiment, search))
            is_converged, ending = _descend(search, x)
    except FitError as error:
        if search.best is None:
            raise
        ending = str(error)
    except Interruption as interruption:
        if search.best is None:
            raise
        is_converged, ending, signal = False, "interrupted", interruption.number
    finally:
        search.close()
    return _result(experiment, search, difference, is_converged, ending, signal)


def _result(experiment, search, difference, is_converged, ending, signal):
    count, unknowns = search.weights.size, len(experiment.unknowns)
    variance = search.cost / max(count - unknowns, 1)
    if search.jacobian_at_best is None:  # interrupted
        sure = Certainty(numpy.full(unknowns, numpy.inf), numpy.full((unknowns, unknowns), numpy.nan), [])
    else:
        # Differences magnify the error of Newton's method in a simulation. Besides, they have an error of first order.
        signal_size = numpy.linalg.norm(search.predicted * search.weights)
        sure = certainty(search.jacobian_at_best, variance, 1e-10 / difference * signal_size, 10 * difference)
    errors = numpy.where(numpy.isfinite(sure.standard_errors), sure.standard_errors, 0.0)
    nearest = numpy.minimum(search.best - search.lower, search.upper - search.best)
    at_limit = nearest <= numpy.maximum(1e-6, 0.01 * errors)
    sure = sure._replace(standard_errors=sure.standard_errors * search.scales)
    return Fit(search.best * search.scales, sure, float(numpy.sqrt(variance)), search.noise, search.predicted, at_limit,
               is_converged, ending, search.iterations, search.simulations, signal)
