"""Test `flexarm bench validation` and the package flexarm.validation."""

import math
import os
import subprocess

import numpy
import pytest

from flexarm import Simulation, read_scene
from flexarm.validation import Case, MissingRecord, Row
from flexarm.validation.fits import fit_numbers, fit_run
from flexarm.validation.rows import count

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
    ({"uncertainty": 0}, "uncertainty: expected a number > 0, got 0"), ({"uncertainty": -1}, "uncertainty"),
    ({"uncertainty": math.nan}, "uncertainty"), ({"uncertainty": math.inf}, "uncertainty"),
    ({"published": math.nan}, "published: expected a finite number"), ({"kind": "guessed"}, "got 'guessed'")])
def test_impossible_rows_are_refused(values, expected):
    with pytest.raises(ValueError, match="length: ") as error:
        row(**values)
    assert expected in str(error.value)


def test_standard_errors_are_those_of_a_straight_line():
    """y = a x with errors of size s: the variance of a is s^2 / sum x^2."""
    x = numpy.array([1.0, 2.0, 3.0])
    (slope,), (error,) = fit_numbers(lambda unknowns: unknowns[0] * x, [2.0], [3.1, 6.0, 8.9], [0.1] * 3)
    assert slope == pytest.approx((x @ [3.1, 6.0, 8.9]) / (x @ x), rel=1e-6)
    assert error == pytest.approx(0.1 / math.sqrt(x @ x), rel=1e-3)  # one-sided differences of 1e-4


def test_a_run_gives_back_its_parameters(tmp_path):
    path = tmp_path / "pendulum.urdf"
    path.write_text(PENDULUM)
    rows = Simulation(read_scene(str(path), {"damping": 0.08})).run(600, record=["joint/hinge/position"], every=10)
    column = rows[:, 1].copy()
    column[5] = math.nan  # a missing measurement
    values, errors = fit_run(str(path), {"damping": 0.03}, rows[:, 0], {"joint/hinge/position": column})
    assert values["damping"] == pytest.approx(0.08, rel=1e-4)  # noise is the tolerance of Newton's method
    assert 0 <= errors["damping"] < 1e-4


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
                            universal_newlines=True, timeout=300)
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
    assert "[Title of good](good.md) | sizes: 0 of 1 | 1 of 1 | 2.5 | mass |" in index
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
