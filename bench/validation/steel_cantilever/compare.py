"""A steel cantilever: its first three bending frequencies."""

import math

import numpy

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.fits import fit_numbers

# The accelerometer is somewhere between 0 and 30 mm from the end; the clamp may give.
RELATIVE = 0.015
PUBLISHED = 5.14  # thickness [mm]


def frequencies(case, thickness_mm):
    """The first three frequencies of bending through the thickness [Hz]."""
    simulation = Simulation(case.scene("beam.urdf", {"thickness": 1e-3 * thickness_mm}))
    model = simulation.linearise([], ["velocity:tip:z", "velocity:tip:y"])
    poles, shapes = numpy.linalg.eig(model.a)
    across, along = abs(model.c @ shapes)
    return sorted(pole.imag / (2 * math.pi) for pole, z, y in zip(poles, across, along)
                  if pole.imag > 1 and z > 1e3 * y)[:3]


def compare(case):
    rows = case.table("numbers.csv")
    measured = [(row["first_hz"] + row["second_hz"]) / 2 for row in rows]
    estimate = fit_numbers(lambda x: frequencies(case, x[0])[:1], [PUBLISHED], measured[:1], [RELATIVE * measured[0]])
    (thickness,), (error,) = estimate.values, estimate.standard_errors
    case.identify("thickness (published: %g)" % PUBLISHED, thickness, "mm", "the first frequency", error)
    for row, value, found, part in zip(rows, measured, *estimate.predict(lambda x: frequencies(case, x[0]))):
        yield Row("bending %d" % row["mode"], value, found, RELATIVE * value, "Hz", group="frequencies",
                  note="own: 1.5 %, place of the accelerometer, clamp", is_fitted=row["mode"] == 1, propagated=part)
    case.draw(lambda axes: draw(axes, measured, frequencies(case, thickness), frequencies(case, PUBLISHED)))


def draw(axes, measured, found, published):
    numbers = [1, 2, 3]
    axes.plot(numbers, [100 * (a / b - 1) for a, b in zip(found, measured)], "s", color="black",
              label="flexarm, thickness identified")
    axes.plot(numbers, [100 * (a / b - 1) for a, b in zip(published, measured)], "^", color="gray", mfc="none",
              label="flexarm, thickness as published")
    axes.axhline(0, color="#D55E00", label="measured")
    axes.set(xlabel="mode", ylabel="difference of the frequency [%]", xticks=numbers)
    axes.legend(fontsize=8)
