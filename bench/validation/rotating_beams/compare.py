"""Rotating beams: frequencies over speed and sweep of the tip, straight composite and swept aluminium."""

import math

import numpy

from flexarm import Simulation
from flexarm.validation import Row
from flexarm.validation.fits import fit_numbers

INCH, PSI = 0.0254, 6894.757
PUBLISHED_HUB = 2.5 * INCH
# Straight, 37.5 in; density 1.44e-4 lb s^2/in^4. Its torsion is not compared, so that Poisson's ratio does not matter.
COMPOSITE = {"thickness": 0.117 * INCH, "young": 2.059e7 * PSI, "density": 1.44e-4 * 4.4482216 / INCH ** 4,
             "poisson": 0.325}
# The first frequency at rest, which hardly depends on the sweep, is measured as 1.4, 1.8, 1.7 and 1.6 Hz. Thickness:
# 0.002 in.
SCATTER, RELATIVE = 0.2, 0.03  # Hz; of the frequency
NOTE = "scatter over the sweep, 3 % for the thickness"


def frequencies(case, speed_rpm, sweep_deg=0.0, **values):
    """Frequencies out of the plane of rotation, and of torsion, by size [Hz]."""
    scene = case.scene("rotor.urdf", {"speed": speed_rpm * math.pi / 30, "sweep": math.radians(sweep_deg), **values})
    model = Simulation(scene).linearise([], ["velocity:edge:z", "velocity:corner:z", "velocity:edge:y"], about="steady")
    poles, shapes = numpy.linalg.eig(model.a)
    seen = abs(model.c @ shapes)
    out_of_plane = (seen[:2].max(axis=0) > 1e-6 * seen.max(axis=0)) & (poles.imag > 0)
    return numpy.sort(poles[out_of_plane].imag) / (2 * numpy.pi)


def ritz(speed_rpm, hub, length=37.5 * INCH, thickness=0.063 * INCH, young=73.08e9, density=2682.0, terms=12):
    """Bending frequencies out of the plane of a straight thin rotating beam, by Rayleigh and Ritz [Hz]."""
    from scipy.linalg import eigh
    points, weights = numpy.polynomial.legendre.leggauss(50)
    x, weights = (points + 1) / 2, weights / 2
    shapes = [numpy.polynomial.Chebyshev.basis(k, domain=[0, 1]).convert(kind=numpy.polynomial.Polynomial)
              * numpy.polynomial.Polynomial([0, 0, 1]) for k in range(terms)]
    value, slope, bend = (numpy.array([shape.deriv(order)(x) if order else shape(x) for shape in shapes])
                          for order in (0, 1, 2))
    mass = density * thickness * INCH
    tension = mass * (speed_rpm * math.pi / 30) ** 2 * length ** 2 * (hub / length * (1 - x) + (1 - x ** 2) / 2)
    stiffness = (young * INCH * thickness ** 3 / 12 / length ** 3 * (bend * weights) @ bend.T
                 + (slope * weights * tension) @ slope.T / length)
    return numpy.sqrt(eigh(stiffness, mass * length * (value * weights) @ value.T, eigvals_only=True)) / (2 * numpy.pi)


def uncertainty(frequency):
    return math.hypot(SCATTER, RELATIVE * frequency)


def identify(case, rows):
    """The radius of the hub, from the straight aluminium beam in rotation."""
    speeds = sorted({row["speed_rpm"] for row in rows})

    def model(unknowns):
        found = {speed: frequencies(case, speed, hub=unknowns[0]) for speed in speeds}
        return [found[row["speed_rpm"]][int(row["mode"]) - 1] for row in rows]

    measured = [row["frequency_hz"] for row in rows]
    (hub,), (error,) = fit_numbers(model, [PUBLISHED_HUB], measured, [uncertainty(value) for value in measured])
    case.identify("radius of the hub", hub / INCH, "in (published: %g in)" % (PUBLISHED_HUB / INCH),
                  "the bending frequencies of the straight aluminium beam at 500 and 750 rpm", error / INCH)
    return hub


def compare(case):
    found = frequencies(case, 750, hub=PUBLISHED_HUB)
    for mode, number in enumerate(ritz(750, PUBLISHED_HUB)[:3], 1):
        yield Row("straight, 750 rpm, bending %d, by Ritz" % mode, number, found[mode - 1], 1e-3 * number, "Hz",
                  "closed form", "0.1 %: no shear and no rotary inertia there")
    swept, composite = case.table("swept_tip.csv"), case.table("composite.csv")

    def is_used(row):
        return row["sweep_deg"] == 0 and row["speed_rpm"] > 0 and row["mode"] <= 3

    hub = identify(case, [row for row in swept if is_used(row)])
    pairs = sorted({(row["speed_rpm"], row["sweep_deg"]) for row in swept})
    found = {pair: frequencies(case, *pair, hub=hub) for pair in pairs}
    for row in swept:
        frequency = found[row["speed_rpm"], row["sweep_deg"]][int(row["mode"]) - 1]
        yield Row("sweep %g deg, %g rpm, mode %g" % (row["sweep_deg"], row["speed_rpm"], row["mode"]),
                  row["frequency_hz"], frequency, uncertainty(row["frequency_hz"]), "Hz", note=NOTE,
                  is_fitted=is_used(row), group="aluminium " + ("in rotation" if row["speed_rpm"] else "at rest"))
    speeds = sorted({row["speed_rpm"] for row in composite})
    straight = {speed: frequencies(case, speed, hub=hub, **COMPOSITE) for speed in speeds}
    for row in composite:
        frequency = straight[row["speed_rpm"]][int(row["mode"]) - 1]
        yield Row("composite, %g rpm, bending %g" % (row["speed_rpm"], row["mode"]), row["frequency_hz"], frequency,
                  uncertainty(row["frequency_hz"]), "Hz", note=NOTE,
                  group="composite " + ("in rotation" if row["speed_rpm"] else "at rest"))
    case.draw(lambda axes: draw(axes, swept, found, composite, straight), columns=2)


def draw(axes, swept, found, composite, straight):
    sweeps = sorted({pair[1] for pair in found})
    for speed, colour in ((0, "#009E73"), (500, "#0072B2"), (750, "#D55E00")):
        rows = [row for row in swept if row["speed_rpm"] == speed]
        axes[0].plot([row["sweep_deg"] for row in rows], [row["frequency_hz"] for row in rows], "o", mfc="none",
                     color=colour, label="%g rpm" % speed)
        axes[0].plot(sweeps, [found[speed, sweep][:6 if speed == 750 else 3] for sweep in sweeps], color=colour,
                     linewidth=1)
    axes[0].set(title="aluminium, swept tip", xlabel="sweep of the tip [deg]", ylabel="frequency [Hz]")
    axes[1].plot([row["speed_rpm"] for row in composite], [row["frequency_hz"] for row in composite], "o", mfc="none",
                 color="#D55E00", label="measured")
    axes[1].plot(list(straight), [each[:4] for each in straight.values()], color="black", linewidth=1)
    axes[1].set(title="composite, straight", xlabel="speed [rpm]", ylabel="frequency [Hz]")
    for each in axes:
        each.legend(fontsize=8)
