"""A yo-yo despinner: speed of a drum after two masses have unwound their cords."""

import math

import numpy

from flexarm import Simulation
from flexarm.validation import MissingRecord, Row
from flexarm.validation.fits import fit_numbers

INCH, RPM = 0.0254, math.pi / 30
PUBLISHED = 0.0483  # inertia of the drum [kg m^2]
FITTED = 12  # length of the cord from which the inertia is identified [in]
CORD, SPEED = 0.125, 1.0  # of the length of a cord, with its knots [in]; of the speed before, and of the sensor [rpm]
RECORD = ["joint/spin/velocity", "probe/mass/x", "probe/mass/y"]


def unwind(case, cord_in, before_rpm, **values):
    """Times [s] and speeds [rpm] until the cords are radial, where they come off."""
    scene = case.scene("despinner.urdf", {"cord": cord_in * INCH, "rpm": before_rpm, **values})
    simulation = Simulation(scene)
    rows = simulation.run(1000, record=RECORD)
    distance = numpy.hypot(rows[:, 2], rows[:, 3])
    last = numpy.argmax(distance[1:] < distance[:-1]) + 1  # the mass is farthest from the axis then
    return rows[:last, 0], rows[:last, 1] / RPM


def ideal(case, cord_in, before_rpm):
    """Speed when the cords are radial, from conservation of energy and of angular momentum [rpm]."""
    value = {parameter.name: parameter.value for parameter in case.scene("despinner.urdf").parameters}
    masses, radius = 2 * value["mass"], value["radius"]
    free = value["free"]
    start = value["inertia"] / masses + radius ** 2 + free ** 2  # of the moment of inertia per mass
    ratio, reach = value["inertia"] / masses, radius + cord_in * INCH
    a, b, c = ratio * reach ** 2 + ratio ** 2, -2 * start * ratio, start ** 2 - start * reach ** 2
    return before_rpm * (-b - math.sqrt(b * b - 4 * a * c)) / (2 * a)


def own(case, row, inertia):
    """Uncertainty of a speed after, with that of the cord and of the speed before [rpm]."""
    speed, shorter = (unwind(case, cord, row["before_rpm"], inertia=inertia)[1][-1]
                      for cord in (row["cord_in"], row["cord_in"] - CORD))
    return math.hypot(shorter - speed, math.hypot(SPEED, SPEED * speed / row["before_rpm"]))


def compare(case):
    rows = case.table("numbers.csv")
    for cord in (8, 12):
        expected = ideal(case, cord, 100)
        yield Row("cord %g in, closed form" % cord, expected, unwind(case, cord, 100)[1][-1], 0.1, "rpm", "closed form",
                  "0.1 rpm: cords stretch and are fixed just outside the rim")
    used = next(row for row in rows if row["cord_in"] == FITTED)
    estimate = fit_numbers(lambda x: [unwind(case, FITTED, used["before_rpm"], inertia=x[0])[1][-1]], [PUBLISHED],
                           [used["after_rpm"]], [own(case, used, PUBLISHED)])
    (inertia,), (error,) = estimate.values, estimate.standard_errors
    case.identify("inertia of the drum (published: %g, without its latches)" % PUBLISHED, inertia, "kg m^2",
                  "the speed after %g in" % FITTED, error)
    curves = {}
    for row in rows:
        times, speeds = curves[row["cord_in"]] = unwind(case, row["cord_in"], row["before_rpm"], inertia=inertia)
        _, (part,) = estimate.predict(lambda x: unwind(case, row["cord_in"], row["before_rpm"], inertia=x[0])[1][-1:])
        yield Row("cord %g in: speed after" % row["cord_in"], row["after_rpm"], abs(speeds[-1]),
                  own(case, row, inertia), "rpm", note="own: 1/8 in of the cord, 1 rpm of the speeds",
                  is_fitted=row["cord_in"] == FITTED, group="speed after", propagated=part)
    case.draw(lambda axes: draw(case, axes, rows, curves), columns=2)


def draw(case, axes, rows, curves):
    cords = [row["cord_in"] for row in rows]
    axes[0].plot(cords, [row["after_rpm"] for row in rows], "o", mfc="none", color="#D55E00", label="measured")
    axes[0].plot(cords, [abs(curves[cord][1][-1]) for cord in cords], color="black",
                 label="flexarm, inertia identified")
    axes[0].plot(cords, [abs(ideal(case, cord, 100)) for cord in cords], "--", color="gray",
                 label="inertia as published")
    axes[0].set(xlabel="length of the cords [in]", ylabel="speed after [rpm]")
    axes[0].legend(fontsize=8)
    for row, colour in zip(rows[::2], ("#0072B2", "#D55E00", "#009E73", "#CC79A7")):
        times, speeds = curves[row["cord_in"]]
        axes[1].plot(times, speeds, color=colour, label="%g in" % row["cord_in"])
        try:
            record = numpy.loadtxt(case.record(row["record"]), comments="%", usecols=(0, 1))
        except MissingRecord:
            continue
        # The instant of the release is not recorded: curves meet at half of the fall.
        half = (row["before_rpm"] + row["after_rpm"]) / 2
        fall = numpy.argmax((record[:, 0] > 2) & (record[:, 1] < half))
        begin = record[fall, 0] - numpy.interp(-half, -speeds, times)
        seen = (record[:, 0] > begin - 0.1) & (record[:, 0] < begin + 0.7)
        axes[1].plot(record[seen, 0] - begin, record[seen, 1], ".", markersize=3, color=colour)
    axes[1].set(xlabel="time since the release [s]", ylabel="speed [rpm]")
    axes[1].legend(fontsize=8)
