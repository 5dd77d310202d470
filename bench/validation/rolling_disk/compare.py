"""A wheel that rolls down a ramp, balanced and unbalanced: times from angle to angle."""

import math

import numpy

from flexarm import Simulation
from flexarm.validation import MissingRecord, Row
from flexarm.validation.fits import fit_numbers, fit_run

FITTED = "balanced_1"
ANGLE, RATE = "joint/roll/position", "joint/roll/velocity"
# Repeats differ by up to 0.09 s, since the encoder loses counts: the rate has dips of 1 or 2 rad/s over some 0.2 s. 0.1
# of the 5.5 degrees of the ramp are 2 % of the acceleration and 1 % of a time.
REPEAT, SLOPE = 0.09, 0.01  # s; relative
USED = 0.5, 15.0  # angles of a record that count, as in the course [rad]


def roll(case, extra, rolling):
    """Times [s], angles [rad] and rates [rad/s] from rest."""
    # An unbalanced wheel starts with its mass at the top, where it would stay without a push.
    values = {"extra": extra, "rolling": rolling, "angle": 1e-3 if extra else 0.0, "rate": 0.02 if extra else 0.0}
    rows = Simulation(case.scene("disk.urdf", values)).run(1600, record=[ANGLE, RATE])
    return rows.T


def duration(case, row, rolling):
    times, angles, _ = roll(case, row["extra_kg"], rolling)
    first, second = numpy.interp([row["first_rad"], row["second_rad"]], angles, times)
    return second - first


def uncertainty(row):
    return math.hypot(REPEAT, SLOPE * row["time_s"])


def compare(case):
    rows = case.table("numbers.csv")
    used = [row for row in rows if row["record"] == FITTED]
    estimate = fit_numbers(lambda x: [duration(case, row, x[0]) for row in used], [0.007],
                           [row["time_s"] for row in used], [uncertainty(row) for row in used])
    (rolling,), (error,) = estimate.values, estimate.standard_errors
    found, parts = estimate.predict(lambda x: [duration(case, row, x[0]) for row in rows])
    case.identify("lever arm of rolling friction", 1e3 * rolling, "mm", "the times of %s" % FITTED, 1e3 * error)
    for row, value, part in zip(rows, found, parts):
        yield Row("%s: %g to %g rad" % (row["record"], row["first_rad"], row["second_rad"]), row["time_s"], value,
                  uncertainty(row), "s", note="own: repeats, 0.1 deg of the ramp",
                  is_fitted=row["record"] == FITTED, group=row["record"].rstrip("_12"), propagated=part)
    case.draw(lambda axes: draw(case, axes, rolling), columns=2)
    record = read(case, FITTED)
    search = fit_run(case.path("disk.urdf"), {"rolling": 0.007, "rate": 1.0}, record[0] - record[0][0],
                     {ANGLE: record[1]}, {"angle": record[1][0]}, step=0.005)
    case.identify("lever arm of rolling friction, by `flexarm identify`'s search", 1e3 * search.values[0], "mm",
                  "all angles of %s" % FITTED, 1e3 * search.standard_errors[0])


def read(case, name):
    """Times, angles and rates of a record, as far as they count."""
    table = numpy.loadtxt(case.record("rolling_disk_" + name), comments="%")
    stop = numpy.argmax(table[:, 1] > USED[1])
    return table[numpy.argmax(table[:, 1] > USED[0]):stop].T


def draw(case, axes, rolling):
    for each, kind, extra in ((axes[0], "balanced", 0.0), (axes[1], "unbalanced", 3.4)):
        for number, colour in ((1, "#D55E00"), (2, "#0072B2")):
            try:
                _, angles, rates = read(case, "%s_%d" % (kind, number))
            except MissingRecord:
                continue
            each.plot(angles, rates, "o", markersize=3, color=colour, label="measured, %d" % number)
        _, angles, rates = roll(case, extra, rolling)
        seen = angles < USED[1]
        each.plot(angles[seen], rates[seen], color="black", label="flexarm")
        each.set(title=kind, xlabel="angle of the wheel [rad]", ylabel="angular velocity [rad/s]")
        each.legend(fontsize=8)
