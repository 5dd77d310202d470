"""A ball that bounces: times of the bounces."""

import math

import numpy

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.fits import fit_numbers

FITTED = 1  # the trial from whose first bounces the restitution is identified
NUMBERS = {"fourth_s": 4, "seventh_s": 7, "thirteenth_s": 13}  # of the bounces
FRAME = 1 / 60  # s
HIT = 0.002  # duration of a hit: ten steps of the scene [s]
# Bounces fall between frames: that of the first interval scales all later times.
FIRST = FRAME / math.sqrt(6)  # standard deviation of an interval [s]


def bounces(case, restitution, first_interval):
    """Times of the bounces after the start, which is the first one [s]."""
    speed = 9.81 * first_interval / 2
    simulation = Simulation(case.scene("ball.urdf", {"restitution": restitution, "speed": speed}))
    until = 1.1 * first_interval * (1 - restitution ** 13) / (1 - restitution)
    record = ["joint/flight/position", "joint/flight/velocity"]
    rows = simulation.run(round(until / simulation.step_size), record=record)
    time, velocity = rows[:, 0], rows[:, 2]
    at = numpy.flatnonzero((velocity[:-1] < 0) & (velocity[1:] >= 0))  # deepest between these rows
    return time[at] - velocity[at] * (time[at + 1] - time[at]) / (velocity[at + 1] - velocity[at])


def compare(case):
    rows = case.table("numbers.csv")
    used = next(row for row in rows if row["trial"] == FITTED)
    (restitution,), (error,) = fit_numbers(
        lambda x: [bounces(case, x[0], used["second_s"])[2]], [0.88], [used["fourth_s"]], [FRAME / math.sqrt(6)])
    case.identify("restitution", restitution, "", "the first four bounces of trial %d" % FITTED, error)
    ideal = used["second_s"] * (1 - restitution ** 12) / (1 - restitution)
    yield Row("trial %d, bounce 13, closed form" % FITTED, ideal, bounces(case, restitution, used["second_s"])[11],
              12 * HIT, "s", "closed form", "twelve hits that last ten steps each")
    found = {}
    for row in rows:
        found[row["trial"]] = times = bounces(case, restitution, row["second_s"])
        for key, number in NUMBERS.items():
            spread = FIRST * row[key] / row["second_s"]
            yield Row("trial %d: bounce %d" % (row["trial"], number), row[key], times[number - 2],
                      math.hypot(FRAME, 2 * spread), "s", note="a frame; twice the spread of the first interval",
                      is_fitted=row["trial"] == FITTED and number == 4, group="time of bounce %d" % number)
    case.draw(lambda axes: draw(axes, rows, found))


def draw(axes, rows, found):
    for row in rows:
        times = found[row["trial"]]
        line, = axes.plot(numpy.arange(2, 14), times[:12], linewidth=0.8)
        axes.plot([2, 4, 7, 13], [row["second_s"], *(row[key] for key in NUMBERS)], "o", mfc="none",
                  color=line.get_color(), label="trial %d" % row["trial"])
    axes.set(xlabel="number of the bounce", ylabel="time since the first one [s]", title="lines: flexarm")
    axes.legend(fontsize=8)
