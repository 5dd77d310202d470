"""Tests the reference values of test/simulation/hydraulics_test.cpp: a mass on the oil of a cylinder, by solve_ivp.

Each chamber has a content u: the volume of its oil without pressure. It is closed, lets oil out at the relief pressure
while its volume shrinks, or takes oil from the tank while its volume grows and its pressure is zero. Events change
between these; within each the equations are smooth.
"""
import math

import numpy
import pytest
from scipy.integrate import solve_ivp

from stated_numbers import stated_numbers

BORE, ROD, LOWER, UPPER, START, DEAD, MASS = 0.08, 0.04, 0.2, 1.0, 0.6, 1e-4, 50.0
AREA = numpy.array([math.pi * BORE**2 / 4, -math.pi * (BORE**2 - ROD**2) / 4])  # change of volume per length
OUTSIDE = numpy.array([DEAD - AREA[0] * LOWER, DEAD - AREA[1] * UPPER])  # volumes at the length 0
TOLERANCES = dict(method="DOP853", rtol=1e-13, atol=1e-15)


class Oil:
    def __init__(self, bulk, pressure, relief=math.inf, makes_up=False, flow=lambda t: 0.0, force=lambda t: 0.0):
        self.bulk, self.relief, self.makes_up, self.flow, self.force = bulk, relief, makes_up, flow, force
        start = numpy.array([pressure, pressure * AREA[0] / -AREA[1]])
        self.content = self.volumes(START) / (1 - start / bulk)
        self.modes = ["closed", "closed"]

    def volumes(self, length):
        return OUTSIDE + AREA * length

    def pressures(self, state):
        volumes = self.volumes(state[0])
        pressures = self.bulk * numpy.maximum(1 - volumes / state[2:], 0)
        for i, mode in enumerate(self.modes):
            if mode == "relieves":
                pressures[i] = self.relief
            elif mode == "fills":
                pressures[i] = 0
        return pressures

    def rates(self, time, state):
        force = self.pressures(state) @ AREA
        out = numpy.array([state[1], (force + self.force(time)) / MASS, 0, 0])
        for i, mode in enumerate(self.modes):
            if mode == "closed":
                out[2 + i] = self.flow(time) * AREA[i] / AREA[0]
            elif mode == "fills":
                out[2 + i] = AREA[i] * state[1]
            else:
                out[2 + i] = AREA[i] * state[1] / (1 - self.relief / self.bulk)
        return out

    def events(self):
        """Functions whose zeros are events, each with the chamber whose mode changes and its new mode."""
        out = []

        def add(function, direction, chamber, mode):
            function.direction, function.terminal, function.change = direction, True, (chamber, mode)
            out.append(function)

        for i, mode in enumerate(self.modes):
            def rate(time, state, i=i):
                return AREA[i] * state[1]

            def void(time, state, i=i):
                return self.volumes(state[0])[i] / state[2 + i] - 1

            def refilled(time, state, i=i):
                return void(time, state, i)

            def excess(time, state, i=i):
                return -void(time, state, i) - self.relief / self.bulk

            if mode == "fills":
                add(rate, -1, i, "closed")
            elif mode == "relieves":
                add(rate, 1, i, "closed")
            else:
                add(void, 1, i, "fills" if self.makes_up else "closed")
                if not self.makes_up:
                    add(refilled, -1, i, "closed")
                if self.relief < math.inf:
                    add(excess, 1, i, "relieves")
        return out

    def run(self, speed, end):
        """Return the state at the end, its pressures, the number of events and the range of lengths."""
        time, state = 0.0, numpy.concatenate([[START, speed], self.content])
        count, lengths = 0, [START]
        while time < end:
            events = self.events()
            run = solve_ivp(self.rates, (time, end), state, events=events, **TOLERANCES)
            time, state = run.t[-1], run.y[:, -1]
            lengths += list(run.y[0])
            for event, times in zip(events, run.t_events):
                if len(times):
                    count += 1
                    # The piston turns back at one instant for both chambers.
                    for chamber in range(2) if event.__name__ == "rate" else [event.change[0]]:
                        # Content that is a digit away from the event, so that round-off does not repeat it.
                        state[2 + chamber] *= 1 + {"fills": 1e-13, "relieves": -1e-13}.get(self.modes[chamber], 0)
                        self.modes[chamber] = event.change[1]
            if run.status == 1:  # leave the zero of the event
                state, time = state + 1e-12 * self.rates(time, state), time + 1e-12
        return state, self.pressures(state), count, (min(lengths), max(lengths))


@pytest.mark.parametrize("name, oil, speed", [
    ("swings far", Oil(2e7, 5e6), 8),
    ("with voids", Oil(2e7, 2e5), 8),
    ("made up", Oil(2e7, 2e5, makes_up=True, force=lambda t: 2e4 * math.sin(40 * t)), 2),
    ("relieved", Oil(2e7, 1e6, relief=3e6, makes_up=True, force=lambda t: 1.1e4 * math.sin(40 * t)), 2),
    ("pumped", Oil(1e9, 2e6, flow=lambda t: 2e-3 * math.sin(20 * t), force=lambda t: -2000.0), 0)])
def test_run(name, oil, speed):
    stated = stated_numbers("simulation/hydraulics_test.cpp", '{"%s",' % name, 5)
    assert stated[0] == speed
    state, pressures, _, _ = oil.run(speed, 0.5)
    assert state[:2] == pytest.approx(stated[1:3], abs=1e-9)
    assert pressures == pytest.approx(stated[3:], rel=1e-7, abs=1e-3)
