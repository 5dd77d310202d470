"""Test measures of sweeps, and the expressions in them."""

import math

import numpy
import pytest

from flexarm.sweep.expressions import Expression, ExpressionError
from flexarm.sweep.input import Entry
from flexarm.sweep.measures import KINDS, read_measure

COLUMNS = ["time", "a", "a/x", "a/xy", "b-1/p.q", "b[2]/x"]
PARAMETERS = {"mass": 2.0, "c_0": 3.0}
TIME = numpy.array([0, 1, 2, 4.0])
ROWS = {"time": TIME, "a": numpy.array([1, -3, 2, 2.0]), "a/x": TIME**2, "a/xy": -TIME, "b-1/p.q": TIME + 10,
        "b[2]/x": 2 * TIME}


def value(text):
    return Expression(text, COLUMNS, PARAMETERS).evaluate(ROWS, PARAMETERS).tolist()


@pytest.mark.parametrize("text, expected", [
    ("a", [1, -3, 2, 2]),
    ("a/x", [0, 1, 4, 16]),
    ("a/xy", [0, -1, -2, -4]),
    ("a/x/2", [0, 0.5, 2, 8]),
    ("1/a", [1, -1 / 3, 0.5, 0.5]),
    ("b-1/p.q - b[2]/x", [10, 9, 8, 6]),
    ("c_0*time", [0, 3, 6, 12]),
    ("mass", [2, 2, 2, 2]),
    ("-2^2 + time*0", [-4, -4, -4, -4]),
    ("2**3^time", [2, 8, 512, 2.0**81]),
    ("min(a, 0) + max(time, 2)", [2, -1, 2, 4]),
    ("a > 0 and time < 3", [1, 0, 1, 0]),
    ("not a > 0 or time >= 4", [0, 1, 0, 1]),
    ("(time > 1) - (time > 2)", [0, 0, 1, 0]),
    ("a if time <= 1 else pi", [1, -3, math.pi, math.pi]),
    ("hypot(3*time, 4*time)", [0, 5, 10, 20]),
    ("sqrt(a/x) + 0*ln(mass)*atan2(1, mass)", [0, 1, 2, 4]),
])
def test_expressions(text, expected):
    assert numpy.allclose(value(text), expected, rtol=1e-15, atol=1e-15)


def test_what_is_not_finite_is_no_error():
    assert value("1/time")[0] == math.inf
    assert math.isnan(value("sqrt(a)")[1])
    assert value("10^(1000*time)")[1] == math.inf


@pytest.mark.parametrize("text, said", [
    ("b/x", "'b/x' is neither a column nor a parameter"),
    ("2*velocity", "'velocity' is neither a column nor a parameter"),
    ("open(a)", "'open' is not one of the functions"),
    ("abs(a, a)", "abs(): expected 1 argument, got 2"),
    ("hypot(a)", "hypot(): expected 2 arguments, got 1"),
    ("a +", "expected an expression of columns, got 'a +'"),
    ("a; a", "expected an expression of columns"),
    ("", "expected an expression of columns"),
    ("a.real", "expected numbers, columns"),
    ("__import__('os')", "'__import__' is not one of the functions"),
    ("(lambda: 1)()", "expected numbers, columns"),
    ("[a for a in a]", "expected numbers, columns"),
    ("'text'", "expected numbers, columns"),
    ("abs(x=a)", "expected numbers, columns"),
    ("a if a else (a := 1)", "expected numbers, columns"),
    ("True", "expected numbers, columns"),
    ("1j", "expected numbers, columns"),
    ("a == 1", "expected numbers, columns"),
    ("1 < a < 2", "expected numbers, columns"),
    ("a @ a", "expected numbers, columns"),
    ("-" * 5000 + "1", "expected"),
    ("(" * 5000, "expected an expression of columns"),
    ("+".join(["a"] * 200), "expected at most 100 nested operations"),
    ("a\0", "expected"),
])
def test_nothing_else_is_an_expression(text, said):
    with pytest.raises(ExpressionError) as error:
        Expression(text, COLUMNS, PARAMETERS)
    assert str(error.value).startswith(said)


def measured(text, columns=None):
    import yaml

    entry = Entry(yaml.compose(text, Loader=yaml.SafeLoader), "plan.yaml")
    columns = columns or ROWS
    return read_measure("m", entry, 4, list(columns), PARAMETERS).evaluate(columns, PARAMETERS)


@pytest.mark.parametrize("text, expected", [
    ("{maximum: a}", 2),
    ("{maximum: a, to: 1}", 1),
    ("{minimum: a}", -3),
    ("{minimum: a, from: 2, to: 4}", 2),
    ("{mean: a/xy}", -2),                                       # a line: its middle value
    ("{mean: a/xy, from: 2}", -3),
    ("{mean: mass}", 2),
    ("{mean: time, from: 2, to: 2}", 2),                        # one row only
    ("{rms: mass}", 2),
    ("{rms: time, from: 0, to: 1}", math.sqrt(0.5)),            # trapezoidal rule over a row at 0 and one at 1
    ("{final: a*time}", 8),
    ("{value: time, at: 3.25}", 3.25),
    ("{value: a, at: 0.5}", -1),
    ("{settling_time: a, band: 0.5}", 2),                       # until its end
    ("{settling_time: a, band: 6}", 0),
    ("{settling_time: a, band: 6, from: 1}", 1),
    ("{settling_time: a/x, target: 16, band: 1}", 4),
    ("{settling_time: a, target: 2, band: 0.5, from: 2}", 2),
])
def test_measures(text, expected):
    assert math.isclose(measured(text), expected, rel_tol=1e-15, abs_tol=1e-15)


def test_what_there_is_not_is_nan():
    assert math.isnan(measured("{settling_time: a, target: 0, band: 1}"))
    assert math.isnan(measured("{settling_time: sqrt(a), band: 1, from: 1, target: 0}", {**ROWS, "a": -TIME}))
    assert math.isnan(measured("{maximum: a, from: 2.5, to: 3.5}"))


def test_windows_have_their_ends_whatever_round_off_does():
    time = numpy.cumsum(numpy.full(40, 0.1)) - 0.1
    assert time[30] != 3.0
    for window in ("from: 3, to: 3", "from: 3, to: 3.00000000001"):
        assert measured("{maximum: time, %s}" % window, {"time": time}) == time[30]


def test_all_kinds_are_tested():
    import sweep_measures_test

    with open(sweep_measures_test.__file__, encoding="utf-8") as file:
        text = file.read()
    for kind in KINDS:
        assert "{" + kind + ":" in text
