#!/usr/bin/env python3
"""Prints reference values for test/reference/static_friction_test.cpp: stick and slip with Stribeck's curve.

A mass on a rail is pulled by a spring whose end moves with constant speed. Friction is F (1 + (r - 1) exp(-(v/v_s)^2)).
While the mass sticks, everything is known in closed form; events end the slips.
"""
import math

from scipy.integrate import solve_ivp

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


def main():
    frequency, fall = math.sqrt(STIFFNESS / MASS), FRICTION * (RATIO - 1) / STIFFNESS
    print("breaks away at %.10g s" % (FRICTION * RATIO / STIFFNESS / SPEED))
    print("slip for a vanishing Stribeck speed: %.10g s" %
          (2 * (math.pi - math.atan(fall * frequency / SPEED)) / frequency))
    for stribeck in (1e-5, 1e-3, 0.01, 0.05):
        duration, stretch = slip(stribeck)
        period = duration + (FRICTION * RATIO / STIFFNESS - stretch) / SPEED
        print("Stribeck speed %g m/s: slip %.10g s, period %.10g s" % (stribeck, duration, period))


if __name__ == "__main__":
    main()
