"""A ball that bounces: times of the bounces."""

import math

import numpy

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.fits import fit_numbers

FITTED = 1, 2, 4  # the trials from which the restitution is identified: the first three
NUMBERS = {"fourth_s": 4, "seventh_s": 7, "thirteenth_s": 13}  # of the bounces
FRAME = 1 / 60  # s
GRAVITY, FAST = 9.81, 2.5  # m/s^2; speed of the scene's second restitution [m/s]
HIT = 0.002  # duration of a hit: ten steps of the scene [s]
# Bounces fall between frames: that of the first interval scales all later times.
FIRST = FRAME / math.sqrt(6)  # standard deviation of an interval [s]


def ideal(restitution, first_interval):
    """Times of the second to thirteenth bounce if hits take no time, by recursion [s]. restitution: at 0, at FAST."""
    slow, fast = restitution
    speed, times = GRAVITY * first_interval / 2, []
    for _ in range(12):
        times.append(2 * speed / GRAVITY)
        speed *= slow + (fast - slow) * min(speed / FAST, 1)
    return numpy.cumsum(times)


def bounces(case, restitution, first_interval):
    """Times of the bounces after the start, which is the first one [s]."""
    values = {"slow": restitution[0], "fast": restitution[1], "speed": GRAVITY * first_interval / 2}
    simulation = Simulation(case.scene("ball.urdf", values))
    until = 1.1 * ideal(restitution, first_interval)[-1]
    record = ["joint/flight/position", "joint/flight/velocity"]
    rows = simulation.run(round(until / simulation.step_size), record=record)
    time, velocity = rows[:, 0], rows[:, 2]
    at = numpy.flatnonzero((velocity[:-1] < 0) & (velocity[1:] >= 0))  # deepest between these rows
    return time[at] - velocity[at] * (time[at + 1] - time[at]) / (velocity[at + 1] - velocity[at])


def uncertainty(row, key):
    """Of the time of a bounce, with that of the first interval, from which it is predicted [s]."""
    return math.hypot(FRAME, 2 * FIRST * row[key] / row["second_s"])


def fit_errors(rows):
    """Independent errors of the times of some trials: a frame each, and that of each trial's first interval [s]."""
    shared = numpy.zeros((len(rows), len(NUMBERS), len(rows)))
    for i, row in enumerate(rows):
        shared[i, :, i] = [2 * FIRST * row[key] / row["second_s"] for key in NUMBERS]
    shared = shared.reshape(-1, len(rows))
    return numpy.hstack([FRAME * numpy.eye(len(shared)), shared])


def compare(case):
    rows = case.table("numbers.csv")
    used = [row for row in rows if row["trial"] in FITTED]

    def predicted(restitution):
        found = [bounces(case, restitution, row["second_s"]) for row in used]
        return [each[number - 2] for each in found for number in NUMBERS.values()]

    estimate = fit_numbers(predicted, [0.95, 0.87], [row[key] for row in used for key in NUMBERS], fit_errors(used))
    restitution, errors = estimate.values, estimate.standard_errors
    source = "trials %d, %d and %d" % FITTED
    case.identify("restitution of slow hits", restitution[0], "", source, errors[0])
    case.identify("restitution at %g m/s" % FAST, restitution[1], "", source, errors[1])
    first = used[0]["second_s"]
    yield Row("trial %d, bounce 13, recursion" % FITTED[0], ideal(restitution, first)[-1],
              bounces(case, restitution, first)[11], 12 * HIT, "s", "closed form",
              "twelve hits that last ten steps each")
    found = {}
    for row in rows:
        times, parts = estimate.predict(lambda x: bounces(case, x, row["second_s"])[:12])
        found[row["trial"]] = times
        for key, number in NUMBERS.items():
            yield Row("trial %d: bounce %d" % (row["trial"], number), row[key], times[number - 2],
                      uncertainty(row, key), "s", note="own: a frame, twice the spread of the first interval",
                      is_fitted=row["trial"] in FITTED, group="time of bounce %d" % number,
                      propagated=parts[number - 2])
    case.draw(lambda axes: draw(axes, rows, found))


def draw(axes, rows, found):
    for row in rows:
        times = found[row["trial"]]
        line, = axes.plot(numpy.arange(2, 14), times, linewidth=0.8)
        axes.plot([2, 4, 7, 13], [row["second_s"], *(row[key] for key in NUMBERS)], "o", mfc="none",
                  color=line.get_color(), label="trial %d" % row["trial"])
    axes.set(xlabel="number of the bounce", ylabel="time since the first one [s]", title="lines: flexarm")
    axes.legend(fontsize=8)
