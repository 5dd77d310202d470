"""Tests the reference values of test/reference/static_friction_test.cpp: stick and slip with Stribeck's curve.

A mass on a rail is pulled by a spring whose end moves with constant speed. Friction is F (1 + (r - 1) exp(-(v/v_s)^2)).
While the mass sticks, everything is known in closed form; events end the slips.
"""
import math

import pytest
from scipy.integrate import solve_ivp

from stated_numbers import stated_numbers

MASS, STIFFNESS, SPEED, FRICTION, RATIO = 2.0, 200.0, 0.1, 4.0, 1.5


def slip(stribeck):
    """Duration of a slip [s], and stretch of the spring at its end [m]. It begins where friction is largest."""
    def derivative(_, state):
        stretch, rate = state  # rate of the mass
        friction = FRICTION * (1 + (RATIO - 1) * math.exp(-(rate / stribeck) ** 2))
        return [SPEED - rate, (STIFFNESS * stretch - friction) / MASS]

    def stops(_, state):
        return state[1]

    stops.terminal, stops.direction = True, -1
    # The tiny first rate takes the integration off the event at its start; forces balance there.
    run = solve_ivp(derivative, (0, 10), [FRICTION * RATIO / STIFFNESS, 1e-9], "DOP853", events=stops, rtol=1e-12,
                    atol=1e-14)
    return run.t[-1], run.y[0, -1]


@pytest.mark.parametrize("stribeck", [0.01, 0.05])
def test_slip_and_period(stribeck):
    duration, stretch = slip(stribeck)
    period = duration + (FRICTION * RATIO / STIFFNESS - stretch) / SPEED
    assert [period, duration] == pytest.approx(
        stated_numbers("reference/static_friction_test.cpp", "Case{%g," % stribeck, 2), abs=1e-9)


def test_slip_for_a_vanishing_stribeck_speed():
    frequency, fall = math.sqrt(STIFFNESS / MASS), FRICTION * (RATIO - 1) / STIFFNESS
    limit = 2 * (math.pi - math.atan(fall * frequency / SPEED)) / frequency
    assert limit == pytest.approx(0.4712, abs=5e-5)
    assert slip(1e-5)[0] == pytest.approx(limit, abs=1e-6)
