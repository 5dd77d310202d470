"""Bounded nonlinear least squares: which unknowns bring a simulation nearest to what was measured?"""

import typing
from concurrent.futures import ThreadPoolExecutor

import numpy
from scipy.optimize import least_squares

from ..errors import SceneError, StepError
from .certainty import Certainty, certainty
from .inputs import InputError

# A step of the search that is expected to be shorter than this part of the standard errors is the last one.
NEGLIGIBLE = 0.01
MOST_ITERATIONS = 50


class Interruption(BaseException):
    """The search is to end now; its best so far is kept. number: of the signal."""

    def __init__(self, number):
        super().__init__(number)
        self.number = number


class FitError(RuntimeError):
    """Nothing can be simulated with some values, and so there is no result, or no better one."""


class Iteration(typing.NamedTuple):
    """How far a search is."""

    number: int
    simulations: int  # since its beginning
    factor: float  # root mean square of the residuals, of the noise
    values: numpy.ndarray  # of the unknowns


class Fit(typing.NamedTuple):
    values: numpy.ndarray  # of the unknowns, shape (unknowns,)
    certainty: Certainty
    factor: float  # estimated standard deviation of errors of measurement, of `noise`
    noise: numpy.ndarray  # of the columns, shape (columns,)
    predicted: numpy.ndarray  # with `values`, as Experiment.measured, shape (values,)
    at_limit: numpy.ndarray  # bool, shape (unknowns,)
    is_converged: bool
    ending: str  # why it ended
    iterations: int
    simulations: int
    signal: typing.Optional[int]  # that has interrupted it


class _Failed(typing.NamedTuple):
    """A simulation with unknowns for which there is none."""

    reason: str


class _Search:
    """Simulations of a search, counted, the best one kept. Unknowns are in units of their scales."""

    def __init__(self, experiment, difference, forward, workers, show):
        self._experiment, self._difference, self._forward, self._show = experiment, difference, forward, show
        self._pool = ThreadPoolExecutor(workers)
        unknowns = experiment.unknowns
        self.scales = numpy.array([unknown.scale for unknown in unknowns])
        self.lower = numpy.array([unknown.min for unknown in unknowns]) / self.scales
        self.upper = numpy.array([unknown.max for unknown in unknowns]) / self.scales
        self.simulations = self.iterations = 0
        self.noise = numpy.ones(len(experiment.parts))
        self.weights = numpy.ones(len(experiment.measured))
        self.forget()

    def forget(self):
        """Residuals are measured otherwise from now on."""
        self.best, self.cost, self.predicted, self.jacobian_at_best = None, numpy.inf, None, None

    def weigh(self, noise):
        self.noise = noise
        for part, value in zip(self._experiment.parts, noise):
            self.weights[part] = 1 / value
        self.forget()

    def close(self):
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _simulate(self, x):
        try:
            return self._experiment.simulate(x * self.scales)
        except (StepError, SceneError, InputError) as error:
            return _Failed(str(error))

    def simulate(self, points):
        """Of several points at once."""
        self.simulations += len(points)
        return list(self._pool.map(self._simulate, points))

    def residuals(self, x):
        """(simulated - measured) / noise, shape (values,); NaN where it fails: the search stays nearer."""
        (predicted,) = self.simulate([x])
        if isinstance(predicted, _Failed):
            if self.best is None:
                raise FitError("with the values that the search begins with nothing can be simulated: "
                               + predicted.reason)
            return numpy.full(len(self.weights), numpy.nan)
        residuals = (predicted - self._experiment.measured) * self.weights
        cost = float(residuals @ residuals)
        if cost < self.cost:
            self.best, self.cost, self.predicted, self.jacobian_at_best = x.copy(), cost, predicted, None
        return residuals

    def jacobian(self, x):
        """Derivatives of residuals() at the best point."""
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
        """By sensitivities of one run, shape (values, unknowns); None where it has none."""
        self.simulations += 1
        try:
            derivatives = self._experiment.derivatives(x * self.scales)
        except (StepError, SceneError, InputError):  # of a neighbour
            return None
        return None if derivatives is None else derivatives * self.scales

    def lengths(self, x):
        """By which unknowns are varied: fixed parts of their sizes, to the side where there is more room."""
        sizes = self._difference * numpy.maximum(abs(x), 0.1)
        return numpy.where(x + sizes <= self.upper, sizes, -sizes)


def differences(search, x, predicted):
    """Derivatives of what is simulated by the unknowns, shape (values, unknowns), by one-sided differences.

    predicted: what is simulated with `x`.
    """
    steps = search.lengths(x)
    varied = search.simulate([x + step * row for step, row in zip(steps, numpy.eye(len(x)))])
    for i, result in enumerate(varied):
        if isinstance(result, _Failed):  # the other side may do
            (varied[i],) = search.simulate([x - steps[i] * numpy.eye(len(x))[i]])
            steps[i] = -steps[i]
            if isinstance(varied[i], _Failed):
                raise FitError("not converged: on neither side of the best values can anything be simulated: "
                               + result.reason)
    return numpy.column_stack([(result - predicted) / step for result, step in zip(varied, steps)])


def _first_noise(experiment):
    """The plan's; where there is none, how far the column's values are spread."""
    noise = []
    for measurement in experiment.measurements:
        spread = float(measurement.values.std()) or abs(float(measurement.values[0])) or 1.0
        noise.append(measurement.column.noise or spread)
    return numpy.array(noise)


def _noise_of_residuals(experiment, search):
    """The plan's; where there is none, that of the residuals."""
    residuals = search.predicted - experiment.measured
    share = 1 - len(experiment.unknowns) / len(residuals)
    noise = search.noise.copy()
    for i, (part, measurement) in enumerate(zip(experiment.parts, experiment.measurements)):
        if measurement.column.noise is None:
            # Residuals of nothing but round-off are no noise.
            smallest = 1e-9 * search.noise[i]
            noise[i] = max(float(numpy.sqrt((residuals[part] ** 2).mean() / share)), smallest)
    return noise


def _descend(search, start):
    """One least squares problem; whether it converged, and why it ended."""
    count = len(search.weights)
    # At the minimum the cost is half the number of values, in units of the variance; a step of a part of the standard
    # errors lowers it by half of the square of that part.
    result = least_squares(search.residuals, start, search.jacobian, bounds=(search.lower, search.upper), method="trf",
                           x_scale="jac", ftol=max(NEGLIGIBLE**2 / count, 1e-14), xtol=1e-9, gtol=1e-12,
                           max_nfev=MOST_ITERATIONS)
    if result.status > 0:
        return True, "converged"
    return False, "not converged after %d tries of values" % MOST_ITERATIONS


def fit(experiment, difference=1e-4, workers=None, show=lambda iteration: None, forward=False):
    """Finds the unknowns of an experiment.

    difference: by which unknowns are varied, relative to their size.
    forward: derivatives are sensitivities of one run, where it has them, in the place of differences of several.
    workers: threads for simulations; None: one for each processor. The result does not depend on it.
    show: called with an Iteration after each.

    Columns whose noise is not known count by how far their values are spread at first, then the search goes on with
    that of the residuals. Interruption ends the search with the best so far. Raises FitError where nothing can be
    simulated at its start.
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
        # Differences blow up what Newton's tolerance leaves of a simulation; beside that, they are of first order.
        signal_size = numpy.linalg.norm(search.predicted * search.weights)
        sure = certainty(search.jacobian_at_best, variance, 1e-10 / difference * signal_size, 10 * difference)
    errors = numpy.where(numpy.isfinite(sure.standard_errors), sure.standard_errors, 0.0)
    nearest = numpy.minimum(search.best - search.lower, search.upper - search.best)
    at_limit = nearest <= numpy.maximum(1e-6, 0.01 * errors)
    sure = sure._replace(standard_errors=sure.standard_errors * search.scales)
    return Fit(search.best * search.scales, sure, float(numpy.sqrt(variance)), search.noise, search.predicted, at_limit,
               is_converged, ending, search.iterations, search.simulations, signal)
