"""Helpers of the tests of the identification."""

import numpy
from scipy.stats import binom

import flexarm
from conftest import hinged_rod
from flexarm.identification import Column, Experiment, Measurement, Setting, Unknown

# A rod on a hinge with viscous friction, which is quick to simulate.
ROD = hinged_rod("0 1 0", "0.5 0 0", (1e-4, 0.1, 0.1), '<integrator step="0.01"/>', mass="${mass}",
                 dynamics='<dynamics damping="${damping}"/>', parameters="""\
  <parameter name="mass" value="1.5" min="0.1" max="10"/>
  <parameter name="damping" value="0.2" min="0"/>
  <parameter name="nothing" value="1"/>
""")
TRUE = {"mass": 2.0, "damping": 0.5}
# Each statistical check fails by chance with this probability: one in ten thousand.
CHANCE = 1e-4


def column(name, noise=None):
    return Column(name, name, noise, None)


def unknown(name, start, least=-numpy.inf, most=numpy.inf, of_start=False):
    return Unknown(name, of_start, start, least, most, abs(start) or 1.0)


def rod_experiment(path, times, noise=None, unknowns=None, values=None, initial=None, efforts=None, step=0.01):
    """Return an experiment that measures the angle of the rod. The measured values are zero."""
    unknowns = unknowns or [unknown("mass", 1.5, 0.1, 10), unknown("damping", 0.2, 0)]
    measurement = Measurement(column("joint/hinge/position", noise), times, 0 * times)
    setting = Setting(str(path), values or {}, step, 1e-10)
    return Experiment(unknowns, initial or {}, [measurement], efforts or {}, setting)


def measured_with(experiment, values, random=None, noise=0.0):
    """Set the measured values to a simulation with these values, plus noise."""
    exact = experiment.simulate(values)
    experiment.measured[:] = exact + (noise * random.standard_normal(len(exact)) if random else 0)
    return experiment


def coverage_limits(count, level=0.95):
    """Return the limits for how many of `count` confidence intervals of a level cover the truth."""
    return binom.ppf([CHANCE, 1 - CHANCE], count, level)


class Formula:
    """A replacement for an experiment: a function of time and the unknowns."""

    def __init__(self, function, unknowns, truth, noise=None, times=numpy.linspace(0, 2, 201), random=None, sigma=0.0):
        self.unknowns, self._function, self._times = unknowns, function, times
        self.simulations = 0
        exact = numpy.asarray(function(times, *truth))
        self.measured = exact + (sigma * random.standard_normal(len(times)) if random else 0)
        self.measurements = [Measurement(column("y", noise), times, self.measured)]
        self.parts, self.units, self.steps, self.step = [slice(0, len(times))], ["m"], len(times) - 1, times[1]

    def simulate(self, values):
        self.simulations += 1
        return numpy.asarray(self._function(self._times, *values))


def failing_beyond(limit):
    """Return a decay that fails if its rate is beyond the limit."""

    def function(times, size, rate):
        if rate > limit:
            raise flexarm.StepError("too fast", 0.0, "too fast")
        return size * numpy.exp(-rate * times)

    return function
