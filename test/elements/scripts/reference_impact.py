"""A ball hits a cantilever from the side (Timoshenko's problem).

The beam has modes of Euler and Bernoulli without damping. The contact is the hardening spring of docs/notes/stops.md 2.
A test for pytest of the numbers that test/reference/line_contact_test.cpp compares with.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from stated_numbers import stated_numbers

YOUNG, DENSITY, RADIUS, LENGTH, PLACE = 2e11, 7800.0, 0.005, 1.0, 0.5
MASS, SPEED, GAP, STIFFNESS, DEPTH = 0.05, 0.2, 1e-4, 1e5, 5e-4


def modes(count):
    """Return angular frequencies, and shapes at PLACE. All modal masses are that of the beam."""
    area, inertia = np.pi * RADIUS**2, np.pi * RADIUS**4 / 4
    middles = [(i + 0.5) * np.pi for i in range(count)]
    b = np.array([brentq(lambda x: np.cos(x) + 1 / np.cosh(x), a - 0.6 + 0.5 * (a < 2), a + 0.6) for a in middles])
    ratio, x = (np.sinh(b) - np.sin(b)) / (np.cosh(b) + np.cos(b)), b * PLACE / LENGTH
    shapes = np.cosh(x) - np.cos(x) - ratio * (np.sinh(x) - np.sin(x))
    return b**2 * np.sqrt(YOUNG * inertia / (DENSITY * area * LENGTH**4)), shapes, DENSITY * area * LENGTH


def push(p):
    s2 = (p / DEPTH) ** 2
    return STIFFNESS * p / (1 - s2) ** 2 * (1 + 3 * s2) / (1 - s2) ** 3 if p > 0 else 0.0


def run(count):
    """Return the speed of the ball after the hit [m/s], and the beam's deflection there after 0.01 s [m]."""
    frequencies, shapes, beam_mass = modes(count)

    def rates(_, y):
        q, dq, z, dz = y[:count], y[count:-2], y[-2], y[-1]
        force = push(shapes @ q - z)
        return np.concatenate([dq, -(frequencies**2) * q - force * shapes / beam_mass, [dz, force / MASS]])

    start = np.zeros(2 * count + 2)
    start[-2:] = GAP, -SPEED
    result = solve_ivp(rates, (0, 0.01), start, rtol=1e-10, atol=1e-13, max_step=2e-5)
    return result.y[-1, -1], shapes @ result.y[:count, -1]


def test_speed_and_deflection():
    stated = stated_numbers("reference/line_contact_test.cpp", "reference_impact.py\n// gives", 7)
    for count, speed in zip((8, 12, 16), stated):
        assert run(count)[0] == pytest.approx(speed, abs=1e-5)
    assert run(16)[1] == pytest.approx(stated[6], rel=1e-3)
