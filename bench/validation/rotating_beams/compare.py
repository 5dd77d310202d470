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
# Aluminium: absolute values are good to 5 to 10 %, as the frequencies at rest show, which no uniform beam has; 10 % is
# taken. The rise with speed hardly depends on what is wrong at rest: 3 %, and the scatter over the sweep, by which the
# first frequency hardly changes: it is measured as 1.4, 1.8, 1.7 and 1.6 Hz.
ABSOLUTE, RISE, SCATTER = 0.10, 0.03, 0.2  # of the frequency; of the rise; Hz
# Composite: read off a figure to 2 %; 0.002 in of the thickness are 1.7 % of a frequency, not of its rise.
READING, THICKNESS = 0.02, 0.002 / 0.117
NOTES = {("aluminium", "frequency"): "own: 10 %, scatter over the sweep",
         ("aluminium", "rise"): "own: scatter over the sweep, 3 %",
         ("composite", "frequency"): "own: figure 2 %, thickness 1.7 %", ("composite", "rise"): "own: figure 2 %"}


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


def rise(frequency, at_rest):
    """With speed [Hz]: centrifugal stiffening adds to the square of a frequency (Southwell)."""
    return math.sqrt(max(frequency ** 2 - at_rest ** 2, 0.0))


class Beam:
    """Measured frequencies of a beam over speed and sweep, with their uncertainties, and flexarm's beside them."""

    def __init__(self, case, name, table, values, absolute, reading, relative):
        """absolute, reading: uncertainty of a frequency by itself, and of each of the two of a rise, functions [Hz].

        relative: further uncertainty of a rise.
        """
        self.case, self.name, self.rows, self._values = case, name, case.table(table), values
        self._absolute, self._reading, self._relative = absolute, reading, relative
        self._at_rest = {self._key(row)[1:]: row["frequency_hz"] for row in self.rows if row["speed_rpm"] == 0}
        self.pairs = sorted({self._key(row)[:2] for row in self.rows})

    @staticmethod
    def _key(row):
        return row["speed_rpm"], row.get("sweep_deg", 0.0), int(row["mode"])

    def measured(self):
        """Keys, kinds of number ("frequency", "rise"), values, uncertainties. Rises that hardly show are left out."""
        found = []
        for row in self.rows:
            key, frequency = self._key(row), row["frequency_hz"]
            found.append((key, "frequency", frequency, self._absolute(frequency)))
            at_rest = self._at_rest.get(key[1:])
            if key[0] == 0 or at_rest is None:
                continue
            size = rise(frequency, at_rest)
            # By the two frequencies, df and df0: (f df, f0 df0)/rise.
            error = math.hypot(frequency * self._reading(frequency), at_rest * self._reading(at_rest)) / size
            if error < size / 2:
                found.append((key, "rise", size, math.hypot(error, self._relative * size)))
        return found

    def calculated(self, hub):
        """By speed and sweep: frequencies."""
        return {pair: frequencies(self.case, *pair, hub=hub, **self._values) for pair in self.pairs}

    @staticmethod
    def numbers(found, items):
        """Those of items of measured(), from calculated()."""
        return [found[key[:2]][key[2] - 1] if kind == "frequency" else
                rise(found[key[:2]][key[2] - 1], found[0.0, key[1]][key[2] - 1]) for key, kind, *_ in items]


def identify(case, beam, items):
    """The radius of the hub, from the rises of the straight aluminium beam."""
    used = [item for item in items if is_used(item) and item[1] == "rise"]
    estimate = fit_numbers(lambda x: beam.numbers(beam.calculated(x[0]), used), [PUBLISHED_HUB],
                           [item[2] for item in used], [item[3] for item in used])
    case.identify("radius of the hub", estimate.values[0] / INCH, "in (published: %g in)" % (PUBLISHED_HUB / INCH),
                  "the rises of the straight aluminium beam's first three frequencies to 500 and 750 rpm",
                  estimate.standard_errors[0] / INCH, estimate.birge)
    return estimate


def is_used(item):
    """Whether a number of the aluminium beam is one of those from which the radius is identified, or in one of them."""
    speed, sweep, mode = item[0]
    return sweep == 0 and speed > 0 and mode <= 3


def compare(case):
    found = frequencies(case, 750, hub=PUBLISHED_HUB)
    for mode, number in enumerate(ritz(750, PUBLISHED_HUB)[:3], 1):
        yield Row("straight, 750 rpm, bending %d, by Ritz" % mode, number, found[mode - 1], 1e-3 * number, "Hz",
                  "closed form", "0.1 %: no shear and no rotary inertia there")
    aluminium = Beam(case, "aluminium", "swept_tip.csv", {}, lambda value: math.hypot(ABSOLUTE * value, SCATTER),
                     lambda value: SCATTER, RISE)
    composite = Beam(case, "composite", "composite.csv", COMPOSITE,
                     lambda value: math.hypot(READING, THICKNESS) * value, lambda value: READING * value, 0.0)
    estimate = identify(case, aluminium, aluminium.measured())
    curves = []
    for beam in (aluminium, composite):
        items = beam.measured()
        numbers, parts = estimate.predict(lambda x, beam=beam, items=items: beam.numbers(beam.calculated(x[0]), items))
        for item, number, part in zip(items, numbers, parts):
            (speed, sweep, mode), kind, published, own = item
            where = "sweep %g deg, " % sweep if beam is aluminium else "composite, "
            group = "at rest" if speed == 0 else "in rotation" if kind == "frequency" else "rise with speed"
            yield Row("%s%g rpm, mode %d%s" % (where, speed, mode, ": rise" * (kind == "rise")), published, number, own,
                      "Hz", note=NOTES[beam.name, kind], is_fitted=beam is aluminium and is_used(item),
                      group=beam.name + " " + group, propagated=part)
        curves.append(beam.calculated(estimate.values[0]))
    case.draw(lambda axes: draw(axes, aluminium.rows, curves[0], composite.rows, curves[1]), columns=2)


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
    axes[1].plot([speed for speed, _ in straight], [each[:4] for each in straight.values()], color="black", linewidth=1)
    axes[1].set(title="composite, straight", xlabel="speed [rpm]", ylabel="frequency [Hz]")
    for each in axes:
        each.legend(fontsize=8)
