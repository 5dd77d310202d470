"""Test `flexarm bench validation` and the package flexarm.validation."""

import math
import os
import subprocess

import numpy
import pytest

from flexarm import Simulation, read_scene
from flexarm.validation import Case, Estimate, MissingRecord, Row, report
from flexarm.validation.fits import fit_numbers, fit_run
from flexarm.validation.rows import count
from flexarm.validation.uncertainty import coverage_factor, from_batches, from_trials

PENDULUM = """<robot name="pendulum"> <parameter name="mass" value="1"/> <parameter name="damping" value="0.05"/>
  <link name="world"/> <joint name="hinge" type="continuous"> <parent link="world"/> <child link="rod"/>
    <axis xyz="0 1 0"/> <dynamics damping="${damping}"/> </joint>
  <link name="rod"> <inertial> <origin xyz="0.3 0 0"/> <mass value="${mass}"/>
    <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/> </inertial> </link> </robot>"""


def row(published=10.0, flexarm=10.0, uncertainty=1.0, **others):
    return Row("length", published, flexarm, uncertainty, "m", **others)


@pytest.mark.parametrize("flexarm, verdict", [(10, "within"), (11, "within"), (9, "within"), (11.0001, "outside"),
                                              (8.9999, "outside"), (math.nan, "outside"), (math.inf, "outside")])
def test_a_row_is_within_up_to_its_uncertainty(flexarm, verdict):
    assert row(flexarm=flexarm).verdict == verdict


def test_the_error_has_a_sign_and_its_ratio_has_none():
    assert row(flexarm=8).error == -2 and row(flexarm=8).ratio == 2
    assert row(published=-10, flexarm=-8).error == 2 and row(published=-10, flexarm=-8).verdict == "outside"


def test_fitted_rows_are_no_predictions():
    rows = [row(), row(flexarm=20), row(flexarm=20, is_fitted=True), row(is_fitted=True)]
    assert rows[2].verdict == rows[3].verdict == "fitted"
    assert count(rows) == (1, 2)


@pytest.mark.parametrize("values, expected", [
    ({"uncertainty": 0}, "own: expected a number > 0, got 0"), ({"uncertainty": -1}, "own: "),
    ({"uncertainty": math.nan}, "own: "), ({"uncertainty": math.inf}, "own: "),
    ({"published": math.nan}, "published: expected a finite number"), ({"kind": "guessed"}, "got 'guessed'")])
def test_impossible_rows_are_refused(values, expected):
    with pytest.raises(ValueError, match="length: ") as error:
        row(**values)
    assert expected in str(error.value)


def test_the_covariance_of_a_straight_line_is_the_closed_one():
    """C = (A^T A)^-1 s^2 with s half of the expanded uncertainty, and U(a + b x) = k sqrt((1, x) C (1, x))."""
    x, uncertainty = numpy.array([0.0, 1.0, 2.0, 4.0]), 0.2
    estimate = fit_numbers(lambda unknowns: unknowns[0] + unknowns[1] * x, [2.0, 1.0], 1 + 2 * x, [uncertainty] * 4)
    design = numpy.column_stack([numpy.ones(4), x])
    covariance = numpy.linalg.inv(design.T @ design) * (uncertainty / 2) ** 2
    assert estimate.covariance == pytest.approx(covariance, rel=1e-3)  # one-sided differences
    assert estimate.freedom == math.inf and estimate.birge == 1
    at = numpy.column_stack([numpy.ones(3), [0.5, 3.0, 10.0]])
    found, expanded = estimate.predict(lambda unknowns: at @ unknowns)
    assert found == pytest.approx(at @ [1, 2], rel=1e-6)
    assert expanded == pytest.approx(2 * numpy.sqrt(numpy.einsum("ij,jk,ik->i", at, covariance, at)), rel=1e-3)


@pytest.mark.parametrize("step", [1.0, 0.1])
def test_propagation_knows_correlations_and_units(step):
    """The sum of two numbers that depend on each other, whose sizes differ by 1e12: exact for a linear model."""
    covariance = numpy.array([[4e12, -1.5], [-1.5, 1e-12]])
    estimate = Estimate(numpy.array([1e6, 1e-6]), covariance)
    gradient = numpy.array([1e-6, 1e6])
    _, (expanded,) = estimate.predict(lambda x: [gradient @ x], step)
    assert expanded == pytest.approx(2 * math.sqrt(gradient @ covariance @ gradient), rel=1e-6)


def test_numbers_that_are_certain_add_nothing():
    estimate = Estimate(numpy.array([1.0, 2.0]), numpy.diag([0.0, 0.01]))
    assert estimate.predict(lambda x: [x[0], x[1]])[1] == pytest.approx([0.0, 0.2], rel=1e-12)


def test_propagation_agrees_with_monte_carlo():
    """A period 2 pi sqrt(m/k) with small errors: the spread of 20000 samples, known to 0.5 % (one in sqrt(2 n))."""
    covariance = numpy.array([[4e-4, 1e-4], [1e-4, 9e-4]])
    estimate = Estimate(numpy.array([1.0, 2.0]), covariance)
    _, (expanded,) = estimate.predict(lambda x: [2 * math.pi * math.sqrt(x[0] / x[1])])
    samples = numpy.random.RandomState(1).multivariate_normal(estimate.values, covariance, 20000)
    spread = (2 * math.pi * numpy.sqrt(samples[:, 0] / samples[:, 1])).std()
    assert expanded == pytest.approx(2 * spread, rel=4 * 0.005)


def test_scatter_beyond_the_uncertainty_enlarges_the_covariance():
    """Four values with residuals of +-0.3 where 0.05 (standard) is assumed: Birge ratio, and Student's t."""
    scattered = fit_numbers(lambda x: [x[0]] * 4, [1.0], [0.7, 1.3, 0.7, 1.3], [0.1] * 4)
    assert scattered.birge == pytest.approx(math.sqrt(4 * 36 / 3), rel=1e-6) and scattered.freedom == 3
    assert scattered.standard_errors[0] == pytest.approx(math.sqrt(0.36 / 3) / 2, rel=1e-3)  # that of the mean
    assert coverage_factor(3) == pytest.approx(3.307, abs=1e-3)  # GUM, table G.2, 95.45 %
    calm = fit_numbers(lambda x: [x[0]] * 4, [1.0], [0.99, 1.01, 0.99, 1.01], [0.1] * 4)
    assert calm.birge == 1 and calm.freedom == math.inf
    assert calm.standard_errors[0] == pytest.approx(0.05 / 2, rel=1e-3)


def test_errors_that_numbers_share_do_not_average_out():
    """Each of three values with 0.2 of its own and 0.4 of all of them: variance of the mean 0.1^2/3 + 0.2^2."""
    errors = numpy.column_stack([0.2 * numpy.eye(3), [0.4] * 3])
    estimate = fit_numbers(lambda x: [x[0]] * 3, [1.0], [1.0, 1.1, 0.9], errors)
    assert estimate.covariance[0, 0] == pytest.approx(0.1 ** 2 / 3 + 0.2 ** 2, rel=1e-3)


def test_one_more_trial_differs_as_trials_do():
    trials = numpy.array([[1.0, 10.0], [2.0, 10.0], [3.0, 13.0], [2.0, 7.0]])
    estimate = from_trials(trials, ["a", "b"])
    assert estimate.named == {"a": 2.0, "b": 10.0} and estimate.freedom == 3
    assert estimate.covariance == pytest.approx(1.25 * numpy.cov(trials.T))
    with pytest.raises(ValueError, match="more trials than the 2 unknowns, got 2"):
        from_trials(trials[:2])


def test_batches_see_that_neighbours_depend_on_each_other():
    """The mean of a record of blocks of 50 equal errors: its variance is that of as many independent ones as blocks."""
    random, count, length = numpy.random.RandomState(2), 400, 50
    blocks = random.normal(size=count)
    residuals = numpy.repeat(blocks - blocks.mean(), length)
    batches = numpy.repeat(numpy.arange(count), length)
    estimate = from_batches([0.0], numpy.ones((count * length, 1)), residuals, batches)
    assert estimate.standard_errors[0] == pytest.approx(blocks.std(ddof=1) / math.sqrt(count), rel=1e-9)
    assert estimate.freedom == count - 1


def test_chosen_numbers_join_an_estimate():
    """A number from a grid is as good as one anywhere within its spacing: variance spacing^2/12."""
    joined = Estimate(numpy.array([1.0]), numpy.array([[4.0]]), 9, ("a",)).with_chosen([0.3], [0.12], ["b"])
    assert joined.named == {"a": 1.0, "b": 0.3} and joined.freedom == 9
    assert joined.covariance == pytest.approx(numpy.diag([4.0, 0.12 ** 2 / 12]))


def test_both_parts_of_the_uncertainty_add_in_quadrature():
    both = row(flexarm=14.9, uncertainty=3.0, propagated=4.0)
    assert both.uncertainty == 5 and both.verdict == "within" and row(flexarm=15.1, uncertainty=3.0,
                                                                      propagated=4.0).verdict == "outside"
    with pytest.raises(ValueError, match="propagated: expected a number >= 0, got -1"):
        row(propagated=-1)


@pytest.mark.parametrize("trials, expected", [(2, 1), (7, 1), (12, 2), (48, 5), (100, 9)])
def test_outside_by_chance_is_the_binomial_quantile(trials, expected):
    from scipy.stats import binom
    assert report.most(trials, 0.05) == expected == binom.ppf(0.95, trials, 0.05)


def test_a_run_gives_back_its_parameters(tmp_path):
    path = tmp_path / "pendulum.urdf"
    path.write_text(PENDULUM)
    rows = Simulation(read_scene(str(path), {"damping": 0.08})).run(600, record=["joint/hinge/position"], every=10)
    column = rows[:, 1].copy()
    column[5] = math.nan  # a missing measurement
    estimate = fit_run(str(path), {"damping": 0.03}, rows[:, 0], {"joint/hinge/position": column})
    assert estimate.named["damping"] == pytest.approx(0.08, rel=1e-4)  # noise is the tolerance of Newton's method
    assert 0 <= estimate.standard_errors[0] < 1e-4


def test_a_longer_memory_of_the_errors_makes_a_run_say_less(tmp_path):
    """Errors of the same size, each by itself or 100 rows long: then one damping is known 10 times worse."""
    path = tmp_path / "pendulum.urdf"
    path.write_text(PENDULUM)
    rows = Simulation(read_scene(str(path), {"damping": 0.08})).run(2000, record=["joint/hinge/position"])
    signs = numpy.random.RandomState(3).choice([-1, 1], size=2000)
    errors = {length: fit_run(str(path), {"damping": 0.05}, rows[:, 0], {"joint/hinge/position":
              rows[:, 1] + 1e-3 * numpy.repeat(signs[:2000 // length], length)}).standard_errors[0]
              for length in (1, 100)}
    assert 3 < errors[100] / errors[1] < 30  # a standard error of nine degrees of freedom is known to a quarter


@pytest.fixture
def cases(tmp_path):
    """A folder with two cases: one is complete, one needs a record and fails with it."""
    scripts = {"good": "    yield Row('length', 1.0, 1.05, 0.1, 'm', 'closed form')\n"
                       "    case.identify('mass', 2.0, 'kg', 'the first run', 0.5)\n"
                       "    yield Row('width', 1.0, 1.25, 0.1, 'm', group='sizes')\n"
                       "    case.draw(lambda axes: axes.plot([0, 1]))\n",
               "recorded": "    yield Row('length', 1.0, 1.0, 0.1, 'm')\n"
                           "    open(case.record('run.csv')).read()\n"
                           "    raise RuntimeError('bad record')\n"}
    for name, script in scripts.items():
        folder = tmp_path / "cases" / name
        folder.mkdir(parents=True)
        (folder / "compare.py").write_text("from flexarm.validation import Row\ndef compare(case):\n" + script)
        (folder / "README.md").write_text("# Title of %s\n\nText.\n" % name)
    return tmp_path


def validate(*words, folder=None):
    """Run `flexarm bench validation ...`. Return its exit status, output and error output."""
    words = [os.environ["FLEXARM_PROGRAM"], "bench", "validation", *map(str, words)]
    result = subprocess.run(words, cwd=folder, check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            universal_newlines=True, timeout=1000)
    return result.returncode, result.stdout, result.stderr


def test_the_table_has_verdicts_and_tells_missing_files(cases):
    status, output, errors = validate("--cases", "cases", "--output", "pages", folder=cases)
    assert status == 0, errors
    lines = [line.split() for line in output.splitlines()]
    assert ["length", "1", "1.05", "+0.05", "0.1", "m", "closed", "form", "within"] in lines
    assert ["width", "1", "1.25", "+0.25", "0.1", "m", "measured", "outside"] in lines
    assert "recorded: 1 of 1 within, rest not run: run.csv is not there" in output
    assert "2 of 3 predictions are within the uncertainty; 1 of 2 cases" in output
    page = (cases / "pages" / "good.md").read_text()
    assert page.startswith("# Title of good\n\nText.") and "- mass: 2 ± 0.5 kg, from the first run" in page
    assert "**outside**" in page and "(good.png)" in page
    assert (cases / "pages" / "good.png").read_bytes().startswith(b"\x89PNG")
    index = (cases / "pages" / "README.md").read_text()
    assert "[Title of good](good.md) | sizes: 0 of 1 | 1 of 1 | 2.5 | 1 of 1, by chance 0.1, at most 0 | mass" in index
    assert "[Title of recorded](recorded.md)" in index


def test_a_failure_is_told_and_leaves_the_others(cases):
    (cases / "data").mkdir()
    (cases / "data" / "run.csv").write_text("")
    status, output, errors = validate("--cases", "cases", "--data", "data", folder=cases)
    assert status == 1 and "recorded: failed: RuntimeError: bad record" in output and "within" in output
    assert "bad record" in errors and not (cases / "README.md").exists()


@pytest.mark.parametrize("words, expected", [
    (["godo"], "there is no case 'godo'; 'good'?"), (["--data", "nowhere"], "there is no folder 'nowhere'"),
    (["--workers", "0"], "must be a number >= 1, got '0'"),
    (["--cases", "cases/good"], "there are no cases in 'cases/good'")])
def test_wrong_usage(cases, words, expected):
    status, _, errors = validate("--cases", "cases", *words, folder=cases)
    assert status == 2 and expected in errors


def test_tables_and_records(tmp_path):
    (tmp_path / "numbers.csv").write_text("# where from\nname,value\na,1.5\n\nb,\n")
    (tmp_path / "odd.csv").write_text("name,value\na,1,2\n")
    case = Case(str(tmp_path), [str(tmp_path)])
    assert case.table("numbers.csv") == [{"name": "a", "value": 1.5}, {"name": "b", "value": None}]
    with pytest.raises(ValueError, match="odd.csv: row 1"):
        case.table("odd.csv")
    assert case.record("numbers.csv") == str(tmp_path / "numbers.csv")
    with pytest.raises(MissingRecord, match="^run.csv$"):
        case.record("run.csv")


def test_two_of_flexarms_own_cases(tmp_path):
    """One that is quick and complete, and one whose records are not part of flexarm."""
    status, output, errors = validate("pazy_wing", "slewing_arm", "--output", tmp_path)
    assert status == 0, errors
    assert "slewing_arm: not run: 4PM_Group37_FlexArm_Unit6 is not there" in output
    rows = [line for line in output.splitlines()
            if line.startswith(("bending, ", "torsion, ")) and " calculated " in line]
    assert len(rows) == 12 and all(line.endswith(" within") for line in rows), output
    assert (tmp_path / "pazy_wing.md").exists() and not (tmp_path / "README.md").exists()
