"""Test the search of the identification and its statistics, on formulas and on a rod."""

import numpy
import pytest
from scipy.stats import chi2

import flexarm
from flexarm.identification import EffortHistory, FitError, Interruption, choose_step, fit, report
from flexarm.identification.experiment import Sampling
from identification import (CHANCE, ROD, TRUE, Formula, coverage_limits, failing_beyond, measured_with, rod_experiment,
                            unknown)


def decay(times, size, rate):
    return size * numpy.exp(-rate * times)


DECAY = [unknown("size", 1.0), unknown("rate", 1.0, 0, 10)]


@pytest.fixture
def rod(tmp_path):
    path = tmp_path / "rod.urdf"
    path.write_text(ROD)
    return path


def test_standard_errors_and_correlations_are_those_of_the_formula():
    random, sigma, truth = numpy.random.default_rng(0), 0.01, (2.0, 1.5)
    experiment = Formula(decay, DECAY, truth, sigma, random=random, sigma=sigma)
    result = fit(experiment)
    size, rate = result.values
    times = experiment.measurements[0].times
    exact = numpy.column_stack([numpy.exp(-rate * times), -size * times * numpy.exp(-rate * times)])
    covariance = result.factor**2 * sigma**2 * numpy.linalg.inv(exact.T @ exact)
    errors = numpy.sqrt(numpy.diag(covariance))
    # One-sided differences have a relative error of their length, 1e-4 of the unknowns, times curvature over slope.
    assert result.certainty.standard_errors == pytest.approx(errors, rel=1e-3)
    assert result.certainty.correlations[0, 1] == pytest.approx(covariance[0, 1] / errors.prod(), abs=1e-3)
    # The sum of squares has a chi-squared distribution.
    count = len(times) - 2
    assert chi2.ppf(CHANCE, count) < result.factor**2 * count < chi2.ppf(1 - CHANCE, count)
    assert result.is_converged and not result.at_limit.any() and not report.doubts(experiment, result)


def test_simulations_are_counted():
    experiment = Formula(decay, DECAY, (2.0, 1.5), 0.01)
    result = fit(experiment)
    assert result.simulations == experiment.simulations
    assert result.values == pytest.approx((2.0, 1.5), rel=1e-6)


def test_noise_that_is_not_known_is_found():
    sigma, count = 0.02, 2001
    times = numpy.linspace(0, 2, count)
    result = fit(Formula(decay, DECAY, (2.0, 1.5), None, times, numpy.random.default_rng(1), sigma))
    assert chi2.ppf(CHANCE, count - 2) < (count - 2) * (result.noise[0] / sigma) ** 2 < chi2.ppf(1 - CHANCE, count - 2)
    assert result.factor == pytest.approx(1, rel=1e-3)
    given = fit(Formula(decay, DECAY, (2.0, 1.5), sigma, times, numpy.random.default_rng(1), sigma))
    # With one column, its weight does not matter. A search ends within a hundredth of the standard errors.
    assert (abs(result.values - given.values) < 0.02 * given.certainty.standard_errors).all()


def test_what_cannot_be_told_apart_is_said():
    unknowns = [unknown("a", 1.2), unknown("b", 0.7), unknown("c", 1.0)]
    experiment = Formula(lambda t, a, b, c: a * b * numpy.cos(3 * t) + c, unknowns, (1.0, 1.0, 0.3), 0.01)
    result = fit(experiment)
    assert result.certainty.undetermined == [[0, 1]]
    assert numpy.isfinite(result.certainty.standard_errors).tolist() == [False, False, True]
    assert result.values[0] * result.values[1] == pytest.approx(1.0, rel=1e-6)
    assert any("cannot distinguish 'a' and 'b'" in doubt for doubt in report.doubts(experiment, result))
    report.text(experiment, result)


def test_what_has_no_effect_is_said():
    experiment = Formula(lambda t, a, b: a * t, [unknown("a", 1.2), unknown("b", 0.7)], (1.0, 1.0), 0.01)
    result = fit(experiment)
    assert result.certainty.undetermined == [[1]] and result.values[0] == pytest.approx(1.0, rel=1e-6)
    assert "the measurements do not depend on 'b'" in report.doubts(experiment, result)


def test_high_correlations_are_said():
    unknowns = [unknown("a", 1.2), unknown("b", 0.7)]
    times = numpy.linspace(1, 1.1, 50)
    random = numpy.random.default_rng(0)
    experiment = Formula(lambda t, a, b: a * t + b, unknowns, (1.0, 1.0), 0.01, times, random, 0.01)
    result = fit(experiment)
    # The correlation for a straight line: minus the mean time over its root mean square.
    expected = -times.mean() / numpy.sqrt((times**2).mean())
    assert result.certainty.correlations[0, 1] == pytest.approx(expected, abs=1e-6)
    assert any("'a' and 'b' are hard to tell apart: their correlation is -0.99" in doubt
               for doubt in report.doubts(experiment, result))


def test_limits_are_kept_and_said():
    experiment = Formula(decay, [unknown("size", 1.0), unknown("rate", 0.5, 0, 1)], (2.0, 1.5), 0.01)
    result = fit(experiment)
    assert result.values[1] <= 1 and result.at_limit.tolist() == [False, True]
    doubts = report.doubts(experiment, result)
    assert "'rate' is at its limit: standard errors are not valid" in doubts
    assert any("residuals of 'y' are" in doubt for doubt in doubts)
    assert any("successive residuals" in doubt for doubt in doubts)


def test_the_search_goes_round_what_cannot_be_simulated():
    # From this start, the first step of the search goes beyond the limit.
    experiment = Formula(failing_beyond(1.6), [unknown("size", 1.0), unknown("rate", 0.1)], (2.0, 1.5), 0.01)
    result = fit(experiment)
    assert result.is_converged and result.values == pytest.approx((2.0, 1.5), rel=1e-6)


def test_a_first_simulation_that_fails_is_an_error():
    experiment = Formula(failing_beyond(1.6), [unknown("size", 1.0), unknown("rate", 1.7)], (2.0, 1.5), 0.01)
    with pytest.raises(FitError, match="too fast"):
        fit(experiment)


def test_the_best_is_kept_where_there_are_no_derivatives():
    truth = (2.0, 1.5)

    def function(times, size, rate):
        if (size, rate) != truth and rate != 0.5:
            raise flexarm.StepError("too far", 0.0, "too far")
        return decay(times, size, rate)

    result = fit(Formula(function, [unknown("size", 1.0), unknown("rate", 0.5)], truth, 0.01))
    assert not result.is_converged and result.ending.startswith("not converged: simulations fail on both sides")
    assert result.values.tolist() == [1.0, 0.5] and numpy.isinf(result.certainty.standard_errors).all()


@pytest.mark.parametrize("last", [0, 1, 2])
def test_an_interrupted_search_keeps_the_best(last):
    experiment = Formula(decay, DECAY, (2.0, 1.5), 0.01)

    def interrupt(iteration):
        if iteration.number > last:
            raise Interruption(2)

    result = fit(experiment, show=interrupt)
    assert (result.signal, result.is_converged, result.iterations) == (2, False, last + 1)
    assert numpy.isfinite(result.certainty.standard_errors).all()
    first, best = (numpy.linalg.norm(decay(experiment.measurements[0].times, *values) - experiment.measured)
                   for values in ((1.0, 1.0), result.values))
    assert best < first if last else best == first


def test_results_do_not_depend_on_workers(rod):
    def found(workers):
        experiment = rod_experiment(rod, numpy.arange(1, 101) * 0.01, 0.01)
        return fit(measured_with(experiment, list(TRUE.values())), workers=workers).values

    assert (found(1) == found(2)).all()


def test_differences_are_derivatives(rod):
    experiment = rod_experiment(rod, numpy.arange(1, 101) * 0.01, 1.0)
    values = numpy.array(list(TRUE.values()))

    def central(i, step):
        change = step * numpy.eye(2)[i]
        return (experiment.simulate(values + change) - experiment.simulate(values - change)) / (2 * step)

    for i in range(2):
        # Halving the step quarters the error of central differences, so the limit can be extrapolated.
        step = 1e-2 * values[i]
        limit = (4 * central(i, step / 2) - central(i, step)) / 3
        errors = [abs((experiment.simulate(values + size * numpy.eye(2)[i]) - experiment.simulate(values)) / size
                      - limit).max() for size in (1e-2 * values[i], 1e-3 * values[i])]
        # The error of one-sided differences is of first order: a tenth of the length gives a tenth of the error. The
        # next order changes this ratio by about a hundredth.
        assert errors[0] / errors[1] == pytest.approx(10, rel=0.1)


def test_forward_derivatives_are_those_of_differences(rod):
    experiment = rod_experiment(rod, numpy.linspace(0, 1, 41), efforts={"hinge": EffortHistory([0.0], [1.0])})
    values = numpy.array([2.0, 0.5])

    def quotient(way):
        moves = way * numpy.eye(2)
        return numpy.column_stack([experiment.simulate(values + move) - experiment.simulate(values - move)
                                   for move in moves]) / (2 * way)

    expected = (4 * quotient(0.005) - quotient(0.01)) / 3
    found = experiment.derivatives(values)
    assert (abs(found - expected).max(axis=0) < 1e-6 * abs(expected).max(axis=0)).all()


def test_forward_derivatives_lead_to_the_same_result(rod):
    random, times = numpy.random.default_rng(2), numpy.linspace(0, 1, 101)
    experiment = measured_with(rod_experiment(rod, times, 0.01), TRUE.values(), random, 0.01)
    result, forward = fit(experiment), fit(experiment, forward=True)
    assert forward.is_converged and forward.simulations < result.simulations
    # Searches end within a hundredth of the standard errors.
    assert (abs(result.values - forward.values) < 0.02 * result.certainty.standard_errors).all()
    assert forward.certainty.standard_errors == pytest.approx(result.certainty.standard_errors, rel=1e-3)


def test_differences_stand_in_where_there_are_no_forward_derivatives(rod):
    times = numpy.linspace(0, 1, 41)
    experiment = rod_experiment(rod, times, 0.01, initial={"hinge/velocity": 0.3})
    assert experiment.derivatives([2.0, 0.5]) is None
    result = fit(measured_with(experiment, TRUE.values()), forward=True)
    assert result.is_converged and result.values == pytest.approx(list(TRUE.values()), rel=1e-6)


def test_standard_errors_cover_the_truth(rod):
    """Check that intervals of each parameter cover the truth in 95 of 100 runs, and that errors in units of standard
    errors have variance 1."""
    runs, sigma, truth = 100, 0.01, numpy.array(list(TRUE.values()))
    random = numpy.random.default_rng(2)
    experiment = rod_experiment(rod, numpy.arange(1, 76) * 0.02, sigma, step=0.02)
    exact = experiment.simulate(truth)
    deviations = []
    for _ in range(runs):
        experiment.measured[:] = exact + sigma * random.standard_normal(len(exact))
        result = fit(experiment, workers=1)
        deviations.append((result.values - truth) / result.certainty.standard_errors)
    deviations = numpy.array(deviations)
    least, most = coverage_limits(runs)
    for column in deviations.T:
        assert least <= (abs(column) < 1.96).sum() <= most
        assert chi2.ppf(CHANCE, runs) < (column**2).sum() < chi2.ppf(1 - CHANCE, runs)


def test_coordinates_at_the_start_may_be_unknown(rod):
    unknowns = [unknown("mass", 1.5, 0.1, 10), unknown("hinge/position", 0.0, of_start=True),
                unknown("hinge/velocity", 0.0, of_start=True)]
    times = numpy.arange(0, 101) * 0.01
    experiment = rod_experiment(rod, times, 1e-3, unknowns, {"damping": 0.5})
    result = fit(measured_with(experiment, [2.0, 0.3, -0.4]))
    assert result.values == pytest.approx([2.0, 0.3, -0.4], rel=1e-6)
    known = rod_experiment(rod, times, 1e-3, unknowns[:1], {"damping": 0.5},
                           {"hinge/position": 0.3, "hinge/velocity": -0.4})
    assert (known.simulate([2.0]) == experiment.measured).all()
    assert known.measured[0] == 0 and known.simulate([2.0])[0] == pytest.approx(0.3, rel=1e-12)


def test_efforts_have_the_impulse_of_their_history():
    edges = numpy.linspace(0, 2, 41)
    line = EffortHistory([0.1, 0.73, 1.9], [1.0, 3.0, -2.0], [3.0, -2.0], 1.0)
    hold = EffortHistory([0.1, 0.73, 1.9], [1.0, 3.0, -2.0], before=1.0)
    # Trapezoids and rectangles. Before the first and after the last knot, the effort is constant.
    assert line.means(edges).sum() * 0.05 == pytest.approx(0.1 + 0.63 * 2 + 1.17 * 0.5 - 0.1 * 2, rel=1e-13)
    assert hold.means(edges).sum() * 0.05 == pytest.approx(0.1 + 0.63 + 1.17 * 3 - 0.1 * 2, rel=1e-13)
    assert line.means(edges)[5] == pytest.approx(1 + 2 * (0.275 - 0.1) / 0.63, rel=1e-12)
    assert hold.means(edges)[[0, 5, 20]] == pytest.approx([1, 1, 3], rel=1e-12)


def test_efforts_are_commanded(rod):
    experiment = rod_experiment(rod, numpy.array([1.0]), efforts={"hinge": EffortHistory([0.5], [2.0])})
    simulation = flexarm.Simulation(flexarm.read_scene(rod, parameters=TRUE), tolerance=1e-10)
    simulation.run(50, numpy.array([0.0]))
    simulation.run(50, numpy.array([2.0]))
    # The remaining impulse of the effort of 0 N m is round-off of sums.
    assert experiment.simulate(list(TRUE.values()))[0] == pytest.approx(simulation.positions[0], rel=1e-12)


def test_steps_end_where_measurements_are():
    grid = numpy.arange(101) * 0.0125
    assert choose_step(grid, 1e-2) == pytest.approx(0.00625, rel=1e-12)
    assert choose_step(grid[::3], 1e-2) == pytest.approx(0.009375, rel=1e-12)
    assert choose_step(numpy.append(grid, 1.2501), 1e-2) is None  # steps of 0.1 ms would be needed
    assert choose_step(numpy.append(grid, 1.2574), 1e-2) is None
    assert choose_step(numpy.array([0.0]), 1e-2) is None
    sampling = Sampling([grid, grid[::4]], 0.00625)
    assert (sampling.is_exact, sampling.steps, sampling.every) == (True, 200, 2)
    rows = numpy.column_stack([numpy.arange(101), -numpy.arange(101)])
    assert (sampling.look(rows) == numpy.append(numpy.arange(101), -4 * numpy.arange(26))).all()


def test_between_steps_the_error_is_of_fourth_order():
    times = numpy.linspace(0, 2, 9973)

    def error(step):
        sampling = Sampling([times], step)
        assert not sampling.is_exact
        rows = numpy.sin(3 * step * numpy.arange(sampling.steps + 1))[:, None]
        return abs(sampling.look(rows) - numpy.sin(3 * times)).max()

    errors = [error(step) for step in (0.01, 0.005, 0.0025)]
    slopes = numpy.log2(numpy.divide(errors[:-1], errors[1:]))
    # The next order is a few steps of 0.03 rad compared with 1: the slope is off by some hundredths at first, and then
    # by half of this.
    assert slopes == pytest.approx(4, abs=0.1)
