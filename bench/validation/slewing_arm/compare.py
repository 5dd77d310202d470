"""A flexible arm on a hub with a motor: steps of the hub's angle under the recorded voltage."""

import itertools
import os
import sys

import numpy

from flexarm import Simulation, read_scene
from flexarm.validation import Row
from flexarm.validation.fits import fit_run

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import records  # noqa: E402

HUB_DELAYS, GAUGE_DELAYS = (0.0, 0.01, 0.02), (0.06, 0.07, 0.08)  # that are tried [s]
GROUPS = {"t90_s": "hub", "hub_extremum_rad": "hub", "tip1_m": "first swing", "t1_s": "first swing",
          "tip2_m": "second swing", "t2_s": "second swing"}
FIRST = {"bending": 0.25, "ratio": 0.02, "inertia": 0.002, "dry": 0.05}  # values of the search
DELAYS = "hub_delay", "gauge_delay"  # names of two more numbers, which are no parameters of the scene
TOLD = [("bending stiffness", "N m^2", 1), ("damping ratio", "", 1),
        ("inertia of the hub (nominal: 0.002)", "kg m^2", 1), ("dry friction", "N m", 1),
        ("delay of the hub's angle", "ms", 1e3), ("delay of the gauge", "ms", 1e3)]
HUB, GAUGE = "joint/hub/position", "sensor/gauge/strain"
# The two steps of a rig differ by up to 10 % in the tip's deflection and 30 ms in its times; the gauge's scale is not
# known.
DEFLECTION, TIME, OVERSHOOT = 0.10, 0.03, 0.05  # relative; s; of the step, which friction may leave


class Arm(records.Arm):
    """The scene with the voltage of a step."""

    def __init__(self, case, step):
        values = {parameter.name: parameter.value for parameter in case.scene("arm.urdf").parameters}
        torque = values["gear"] * values["motor"] / values["resistance"] * step.voltage
        super().__init__(case, step, "torque.csv", {"time": step.times, "torque": torque})

    def run(self, values, delays):
        """What would be measured: hub's angle and tip's deflection at the times of the step."""
        simulation = Simulation(read_scene(self.path, {**values, "start": self.step.start}))
        rows = simulation.run(round(self.step.times[-1] / simulation.step_size), record=[HUB, GAUGE])
        rows = numpy.vstack([[0, self.step.start, 0], rows])
        return [numpy.interp(self.step.times - delay, rows[:, 0], sign * rows[:, i])
                for i, (delay, sign) in enumerate(zip(delays, (1, -1)), 1)]

    def fit(self, delays):
        """An Estimate of the unknowns, and the sum of squares relative to the record's spread."""
        step = self.step
        hub, tip = (numpy.interp(step.times + delay, step.times, column, right=numpy.nan)[::10]
                    for delay, column in zip(delays, (step.hub, step.tip)))
        estimate = fit_run(self.path, FIRST, step.times[::10], {HUB: hub, GAUGE: -tip}, {"start": step.start},
                           step=0.002)
        curves = self.run(estimate.named, delays)
        return estimate, sum(((each - column) ** 2).mean() / column.var()
                             for each, column in zip(curves, (step.hub, step.tip)))


def identify(case, arm, all_delays):
    """Values of a rig, and the delays of its signals: those of the best of several searches. Tells them."""
    tries = {delays: arm.fit(delays) for delays in all_delays}
    delays = min(tries, key=lambda each: tries[each][1])
    estimate = tries[delays][0].with_chosen(delays, [numpy.diff(each)[0] for each in (HUB_DELAYS, GAUGE_DELAYS)],
                                            DELAYS)
    for (label, unit, factor), value, error in zip(TOLD, estimate.values, estimate.standard_errors):
        case.identify("%s of %s" % (label, arm.step.rig), factor * value, unit, arm.step.name, factor * error)
    return estimate


def predict(arm, estimate, row):
    """The numbers of a row of the table and their uncertainties, and the curves of hub and tip."""
    def run(values):
        return arm.run(values, [values.pop(name) for name in DELAYS])

    def numbers(curves):
        found = records.metrics(arm.step.times, *curves, row["from_rad"], row["to_rad"])
        return [found[key] for key in GROUPS]

    # Short differences, since the inertia is hardly known.
    found, parts, curves = records.predict(run, numbers, estimate, 0.2)
    return dict(zip(GROUPS, found)), dict(zip(GROUPS, parts)), curves


def compare(case):
    curves, estimate, delays = [], None, list(itertools.product(HUB_DELAYS, GAUGE_DELAYS))
    for row in case.table("numbers.csv"):
        step = records.Step(case, row)
        arm = Arm(case, step)
        is_fitted = row["step"] == 1
        if is_fitted:
            estimate = identify(case, arm, delays)
            delays = [tuple(estimate.named[name] for name in DELAYS)]  # both rigs have the same signals
        found, parts, curve = predict(arm, estimate, row)
        curves.append((step.name, step, *curve))
        hub_range = OVERSHOOT * abs(row["to_rad"] - row["from_rad"])
        for key, label, unit, uncertainty in (
                ("t90_s", "time to 90 %", "s", TIME), ("hub_extremum_rad", "extremum of the hub", "rad", hub_range),
                ("tip1_m", "first extremum of the tip", "m", None), ("t1_s", "its time", "s", TIME),
                ("tip2_m", "second extremum of the tip", "m", None), ("t2_s", "its time", "s", TIME)):
            own = uncertainty or DEFLECTION * abs(row[key])
            yield Row("%s: %s" % (step.name, label), row[key], found[key], own, unit,
                      note="own: steps of a rig differ by this", is_fitted=is_fitted, group=GROUPS[key],
                      propagated=parts[key])
    case.draw(lambda axes: draw(axes, curves), columns=4, rows=2, width=3.2, height=2.5)


def draw(axes, curves):
    for i, (name, step, hub, tip) in enumerate(curves):
        for each, measured, found in ((axes[i], step.hub, hub), (axes[i + 4], 1e3 * step.tip, 1e3 * tip)):
            each.plot(step.times, measured, color="#D55E00", label="measured")
            each.plot(step.times, found, color="black", linewidth=0.9, label="flexarm")
            each.set(xlabel="time [s]")
        axes[i].set(title=name, ylabel="hub [rad]")
        axes[i + 4].set(ylabel="tip [mm]")
    axes[0].legend(fontsize=8)
