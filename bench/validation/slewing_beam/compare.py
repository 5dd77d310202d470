"""The flexible arm of the slewing rig by itself: deflection of its tip, with the hub moved as measured."""

import os
import sys

import numpy

from flexarm import Simulation, read_scene
from flexarm.validation import Row
from flexarm.validation.fits import fit_run

RECORDS = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "slewing_arm")
sys.path.insert(0, RECORDS)
import records  # noqa: E402

DELAYS = 0.04, 0.05, 0.06, 0.07, 0.08  # of the gauge, that are tried [s]
GAUGE = "sensor/gauge/strain"
WINDOW = 51  # rows of the record over which the hub's angle is smoothed: its digits are 1 mrad
FIRST = {"bending": 0.25, "ratio": 0.02}  # values of the search
# As for the rig with its motor: 10 % of a deflection, whose scale is not known; steps of a rig differ by 30 ms.
DEFLECTION, TIME = 0.10, 0.03  # relative; s
NUMBERS = [("tip1_m", "first extremum of the tip", "m", "first swing"), ("t1_s", "its time", "s", "first swing"),
           ("tip2_m", "second extremum of the tip", "m", "second swing"), ("t2_s", "its time", "s", "second swing")]


class Arm(records.Arm):
    """The scene with the hub's motion of a step."""

    def __init__(self, case, step):
        from scipy.signal import savgol_filter
        position, rate = (savgol_filter(step.hub, WINDOW, 3, deriv=order, delta=1e-3)[::10] for order in (0, 1))
        rate[0] = rate[-1] = 0
        super().__init__(case, step, "hub.csv", {"time": step.times[::10], "position": position, "rate": rate})

    def run(self, values, delay):
        """The gauge's deflection at the times of the step."""
        simulation = Simulation(read_scene(self.path, values))
        rows = simulation.run(round(self.step.times[-10] / simulation.step_size), record=[GAUGE])
        rows = numpy.vstack([[0, 0], rows])
        return numpy.interp(self.step.times - delay, rows[:, 0], -rows[:, 1])

    def fit(self, delay):
        """An Estimate of stiffness and damping, and the mean square of what is left."""
        step = self.step
        tip = numpy.interp(step.times + delay, step.times, step.tip, right=numpy.nan)[::10]
        estimate = fit_run(self.path, FIRST, step.times[::10], {GAUGE: -tip}, step=0.002)
        return estimate, ((self.run(estimate.named, delay) - step.tip) ** 2).mean()


def identify(case, arm, delays):
    """Stiffness and damping of a rig's arm, and the best delay of the gauge. Tells them."""
    tries = {delay: arm.fit(delay) for delay in delays}
    delay = min(tries, key=lambda each: tries[each][1])
    estimate = tries[delay][0].with_chosen([delay], [DELAYS[1] - DELAYS[0]], ["delay"])
    for label, factor, unit, value, error in zip(
            ("bending stiffness", "damping ratio", "delay of the gauge"), (1, 1, 1e3), ("N m^2", "", "ms"),
            estimate.values, estimate.standard_errors):
        case.identify("%s of %s" % (label, arm.step.rig), factor * value, unit, arm.step.name, factor * error)
    return estimate


def predict(arm, estimate, row):
    """The numbers of a row and their uncertainties, and the curve of the tip."""
    def numbers(tip):
        found = records.metrics(arm.step.times, arm.step.hub, tip, row["from_rad"], row["to_rad"])
        return [found[key] for key, *_ in NUMBERS]

    return records.predict(lambda values: arm.run(values, values.pop("delay")), numbers, estimate)


def compare(case):
    curves, estimates = [], {}
    for row in case.table(os.path.join(RECORDS, "numbers.csv")):
        arm = Arm(case, records.Step(case, row))
        rig, is_fitted = arm.step.rig, row["step"] == 1
        if is_fitted:
            estimates[rig] = identify(case, arm, DELAYS)
        found, parts, tip = predict(arm, estimates[rig], row)
        curves.append((arm.step, tip))
        for (key, label, unit, group), value, part in zip(NUMBERS, found, parts):
            yield Row("%s: %s" % (arm.step.name, label), row[key], value,
                      TIME if unit == "s" else DEFLECTION * abs(row[key]), unit,
                      note="own: 10 % of a deflection, steps differ by 30 ms", is_fitted=is_fitted, group=group,
                      propagated=part)
    case.draw(lambda axes: draw(axes, curves), columns=2, rows=2)


def draw(axes, curves):
    for each, (step, tip) in zip(axes, curves):
        each.plot(step.times, 1e3 * step.tip, color="#D55E00", label="measured")
        each.plot(step.times, 1e3 * tip, color="black", linewidth=0.9, label="flexarm")
        each.set(title=step.name, xlabel="time [s]", ylabel="tip [mm]")
    axes[0].legend(fontsize=8)
